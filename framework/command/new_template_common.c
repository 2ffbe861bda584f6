/* The skeleton of every plugin: what all kinds share. @NAME@ and its like are filled in. */
#include "command/new_template.h"

static const char makefile[] =
    "# Builds @NAME@.so. Needs an installed gamut, which pkg-config finds. With a "
    "gamut that was built but\n"
    "# not installed:\n"
    "#   make GAMUT=.../build/gamut CFLAGS=-I.../framework/include\n"
    "name = @NAME@\n"
    "kind = @KIND@\n"
    "\n"
    "GAMUT ?= $(or $(shell pkg-config --variable=gamut gamut 2>/dev/null),gamut)\n"
    "gamut_cflags := $(shell pkg-config --cflags gamut 2>/dev/null)\n"
    "plugin_cflags := $(shell pkg-config --variable=plugin_cflags gamut 2>/dev/null)\n"
    "plugin_ldflags := $(shell pkg-config --variable=plugin_ldflags gamut 2>/dev/null)\n"
    "ifeq ($(plugin_cflags),)\n"
    "plugin_cflags := -std=gnu11 -O3 -fPIC -fvisibility=hidden -ffp-contract=off "
    "-fno-math-errno \\\n"
    "  -fno-trapping-math -fopenmp-simd\n"
    "plugin_ldflags := -shared -Wl,-z,now -Wl,-z,defs\n"
    "endif\n"
    "data = $(or $(XDG_DATA_HOME),$(HOME)/.local/share)\n"
    "\n"
    "$(name).so: $(name).c $(name).gamut.h\n"
    "\t$(CC) $(plugin_cflags) -Wall -Wextra $(gamut_cflags) $(CFLAGS) "
    "$(plugin_ldflags) $(LDFLAGS) \\\n"
    "\t  -o $@ $(name).c -lm\n"
    "\n"
    "$(name).gamut.h: $(name).yaml\n"
    "\t$(GAMUT) header $< > $@.new && mv $@.new $@\n"
    "\n"
    "check: $(name).so\n"
    "\t$(GAMUT) verify .\n"
    "\n"
    "install: $(name).so\n"
    "\tmkdir -p $(data)/gamut/plugins/$(kind)/$(name)\n"
    "\tcp $(name).yaml $(name).so $(data)/gamut/plugins/$(kind)/$(name)\n"
    "\n"
    "clean:\n"
    "\trm -f $(name).so $(name).gamut.h\n"
    "\n"
    ".PHONY: check install clean\n";

static const char readme[] =
    "# @KIND@/@NAME@\n"
    "\n"
    "    make                  builds @NAME@.so\n"
    "    make check            runs the checks that any plugin must pass (gamut verify .)\n"
    "    make install          puts it into your own plugin folder, where gamut finds it\n"
    "\n"
    "`@NAME@.yaml` declares the plugin: parameters with units and ranges, what it "
    "reads and writes, where\n"
    "the formula comes from. `@NAME@.gamut.h` is generated from it. `@NAME@.c` "
    "computes, and nothing else.\n"
    "`@NAME@.test.yaml` holds known answers: state your own, with their source, "
    "before you trust the code.\n"
    "\n"
    "After a change in the YAML run `make` again: a plugin that was built for "
    "another interface is refused.\n";

const struct new_file new_template_common[] = {
    {"Makefile", {makefile}},
    {"README.md", {readme}},
    {NULL, {NULL}},
};
