/* The one header of a plugin author.
 *
 * A plugin is a folder with NAME.yaml (what it declares), NAME.c (what it computes) and
 * NAME.test.yaml (what proves it). The C file includes NAME.gamut.h, which `gamut header` generates
 * from the YAML and which includes this file, and ends in one registration line, e.g.
 *
 *   GAMUT_EOS(linear, .pressure = pressure)
 *
 * A plugin links to nothing of gamut: what it may ask of the core comes through the functions of
 * <gamut/host.h>, which call a table that the core hands over. It exports one symbol.
 */
#ifndef GAMUT_PLUGIN_H
#define GAMUT_PLUGIN_H

#include <gamut/estimator.h>
#include <gamut/host.h>
#include <gamut/kernel.h>
#include <gamut/random_field.h>
#include <gamut/solver.h>

#endif
