/* A file of HDF5 changed as a text says, so that inputs are of sound HDF5 and odd contents: faults
 * of the HDF5 library itself are none of gamut's. One change a line:
 *
 *   real PATH ROWSxCOLUMNS number ...     a dataset of doubles; the last number fills the rest
 *   float, whole, byte PATH ...           the same of other types; ROWS alone: one dimension
 *   text PATH words ...                   a scalar text, "\n" a line end; string: of any length
 *   group PATH                            empty
 *   drop PATH
 *   link PATH TARGET                      another name; soft PATH TARGET: a symbolic one
 *   attribute PATH NAME real number | text words | drop | reals COUNT number | texts COUNT words
 *   swap PATH old | new                   in a text or in bytes, the first `old` becomes `new`
 *
 * What is there already is replaced; a line that makes no sense is passed over. */
#ifndef GAMUT_TESTS_HDF5_EDIT_H
#define GAMUT_TESTS_HDF5_EDIT_H

#include <stddef.h>
#include <stdint.h>

#include <hdf5.h>

void hdf5_edit(hid_t file, const uint8_t *text, size_t size);

#endif
