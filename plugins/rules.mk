# How plugins are built: read by GNU make, not by automake. A plugin is compiled as a stranger would
# do it, without libtool and with nothing of gamut but its public headers. Each is built once for
# every instruction-set level into a shared object of its own: NAME.so, NAME.v3.so, NAME.v4.so.

level_flags_ =
level_flags_.v3 = -march=x86-64-v3
level_flags_.v4 = -march=x86-64-v4 -mprefer-vector-width=512
suffixes = $(LEVELS:%=.%)
all_levels = v3 v4

# Functions of a plugin KIND/NAME: its files without ending, its variables, its objects at a level.
stem = plugins/$(1)/$(notdir $(1))
variable = $($(subst /,_,$(1))_$(2))
objects = $(patsubst %.c,%$(2).o,$(call variable,$(1),sources))
headers = $(foreach plugin,$(gamut_plugins),$(call stem,$(plugin)).gamut.h)
shared_objects = $(foreach plugin,$(gamut_plugins),\
  $(call stem,$(plugin)).so $(suffixes:%=$(call stem,$(plugin))%.so))
all_objects = $(foreach plugin,$(gamut_plugins),\
  $(call objects,$(plugin),) $(foreach suffix,$(suffixes),$(call objects,$(plugin),$(suffix))))

plugin_compile = $(CC) -I$(srcdir)/framework/include $(PLUGIN_OPTIMISE_FLAGS) $(PLUGIN_FLAGS) \
  $(WARNING_FLAGS) -Werror=switch $(SANITIZER_FLAGS)
plugin_link = $(CC) -shared $(PLUGIN_LINK_FLAGS) $(SANITIZER_FLAGS)

# Solvers thread; everything else only vectorises.
openmp_flags = $(if $(filter solver/%,$(1)),$(OPENMP_CFLAGS),$(OPENMP_SIMD_FLAGS))

# --- gamut-header --------------------------------------------------------------------------------
header_rooms = base unit tree expression descriptor
header_objects = $(patsubst %.c,%.lo,$(filter \
  $(foreach room,$(header_rooms),framework/$(room)/%.c) framework/catalogue/catalogue.c,\
  $(libgamut_sources)))
gamut-header$(EXEEXT): $(header_objects)

# A cross build cannot run gamut-header: it takes the headers that came in the tarball, unless it
# is given a native gamut-header.
ifneq ($(GAMUT_HEADER),)
header_tool =
write_header = '$(GAMUT_HEADER)' $(1)
else
ifeq ($(cross_compiling),yes)
header_tool =
write_header = cat $(srcdir)/generated/$(2)
else
header_tool = gamut-header$(EXEEXT)
write_header = ./gamut-header$(EXEEXT) $(1)
endif
endif

# --- Rules of one plugin, and of one plugin at one level -----------------------------------------
# A header is replaced only when its text changes, so that a new gamut-header compiles nothing anew.
define plugin_rules
$(call stem,$(1)).gamut.stamp: $(call stem,$(1)).yaml $$(header_tool)
	@$$(MKDIR_P) $$(@D)
	$$(AM_V_GEN)$$(call write_header,$$<,$(call stem,$(1)).gamut.h) > $$@.new
	@if cmp -s $$@.new $(call stem,$(1)).gamut.h; then rm -f $$@.new; \
	else mv -f $$@.new $(call stem,$(1)).gamut.h; fi
	@echo > $$@
$(call stem,$(1)).gamut.h: $(call stem,$(1)).gamut.stamp
	@test -f $$@ || { rm -f $$<; $$(MAKE) $$(AM_MAKEFLAGS) $$<; }
$(foreach suffix,_ $(suffixes:%=_%),$(eval $(call level_rules,$(1),$(suffix:_%=%))))
endef

define level_rules
$(call stem,$(1))$(2).so: $(call objects,$(1),$(2))
	$$(AM_V_CCLD)$$(plugin_link) $(call openmp_flags,$(1)) $$(LDFLAGS) -o $$@ $$^ \
	  $(call variable,$(1),libraries) -lm
$(call objects,$(1),$(2)): plugins/$(1)/%$(2).o: plugins/$(1)/%.c $(call stem,$(1)).gamut.h
	@$$(MKDIR_P) $$(@D)
	$$(AM_V_CC)$$(plugin_compile) $(call openmp_flags,$(1)) $(level_flags_$(2)) \
	  $(call variable,$(1),flags) -Iplugins/$(1) -I$$(srcdir)/plugins/$(1) \
	  $$(CPPFLAGS) $$(CFLAGS) -MMD -MP -c -o $$@ $$<
endef

$(foreach plugin,$(gamut_plugins),$(eval $(call plugin_rules,$(plugin))))
-include $(all_objects:.o=.d)

# --- What the Makefile calls ---------------------------------------------------------------------
# What another configuration left would be picked before NAME.so, and refused.
stale_objects = $(wildcard $(foreach plugin,$(gamut_plugins),\
  $(foreach level,$(filter-out $(LEVELS),$(all_levels)),$(call stem,$(plugin)).$(level).so)))
build-plugins: $(shared_objects)
	$(if $(stale_objects),@rm -f $(stale_objects))

# The digest is that of the installed file, which may be stripped; registry/digest.c checks it.
install-plugins: $(shared_objects)
	@for plugin in $(gamut_plugins); do \
	  name=$${plugin##*/}; folder="$(DESTDIR)$(plugindir)/$$plugin"; \
	  echo "installing plugin $$plugin"; $(MKDIR_P) "$$folder" || exit 1; \
	  for suffix in '' $(suffixes); do \
	    object=$$name$$suffix.so; rm -f "$$folder/$$object.sha256" && \
	      $(INSTALL_PROGRAM) "plugins/$$plugin/$$object" "$$folder" && \
	      (cd "$$folder" && sha256sum "$$object" >"$$object.sha256" && \
	      chmod 644 "$$object.sha256") || exit 1; \
	  done; \
	  for file in $$name.yaml $$name.test.yaml $$name.scene.yaml; do \
	    test ! -f "$(srcdir)/plugins/$$plugin/$$file" || \
	      $(INSTALL_DATA) "$(srcdir)/plugins/$$plugin/$$file" "$$folder" || exit 1; \
	  done; \
	done

uninstall-plugins:
	@for plugin in $(gamut_plugins); do rm -rf "$(DESTDIR)$(plugindir)/$$plugin"; done

clean-plugins:
	rm -f $(shared_objects) $(all_objects) $(all_objects:.o=.d) $(headers) $(headers:.h=.stamp)

dist-headers: $(headers)
	@for header in $(headers); do \
	  $(MKDIR_P) "$(distdir)/generated/$$(dirname $$header)" && \
	  cp -p $$header "$(distdir)/generated/$$header" || exit 1; \
	done
