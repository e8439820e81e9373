# SPDX-License-Identifier: LGPL-2.1-or-later
#
# What libethercat-tools and libethercat-bus have in common; included by their Makefiles, which set
# name (libethercat-x), header (ethercat-x), obj (folder below O), sources (C files,
# those of other folders with their path) and needs (libraries). O: where to build; prefix, libdir,
# includedir, DESTDIR: where to install.

O ?= build
prefix ?= /usr/local
libdir ?= $(prefix)/lib
includedir ?= $(prefix)/include

CC ?= cc
AR ?= ar
INSTALL ?= install
LDCONFIG ?= ldconfig
CFLAGS ?= -O2 -g

release := 0.1.0
soname := $(name).so.1
real := $(soname).0.0

flags := -std=gnu11 -Wall -Wextra -Wmissing-prototypes -Wstrict-prototypes -Wpointer-arith -fPIC \
	-fvisibility=hidden -I../../include -D_GNU_SOURCE -D_FILE_OFFSET_BITS=64

objs := $(addprefix $(O)/$(obj)/,$(notdir $(sources:.c=.o)))
outs := $(addprefix $(O)/,$(real) $(soname) $(name).so $(name).a $(name).pc)
# sanitizers leave symbols to the program
comma := ,
defs := $(if $(findstring -fsanitize,$(CFLAGS)),,-Wl$(comma)-z$(comma)defs)

all: $(outs)

$(O)/$(obj):
	mkdir -p $@

vpath %.c $(sort $(dir $(sources)))
$(O)/$(obj)/%.o: %.c Makefile ../library.mk | $(O)/$(obj)
	$(CC) $(CPPFLAGS) $(CFLAGS) $(flags) -MMD -MP -c -o $@ $<

$(O)/$(real): $(objs) $(name).map
	$(CC) $(CFLAGS) -shared -Wl,-soname,$(soname) -Wl,--version-script=$(name).map $(defs) \
		-Wl,-z,relro,-z,now $(LDFLAGS) -o $@ $(objs) $(needs)

$(O)/$(soname) $(O)/$(name).so: $(O)/$(real)
	ln -sf $(real) $@

$(O)/$(name).a: $(objs)
	rm -f $@
	$(AR) rcs $@ $(objs)

# always: it depends on variables
$(O)/%: %.in FORCE | $(O)/$(obj)
	@sed -e 's|@prefix@|$(prefix)|' -e 's|@libdir@|$(libdir)|' \
		-e 's|@includedir@|$(includedir)|' -e 's|@version@|$(release)|' $< >$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@

# as lib/Makefile: the dynamic linker finds a new library by its cache only
refresh_cache = $(if $(DESTDIR),,@PATH="$$PATH:/usr/sbin:/sbin"; \
	! command -v $(LDCONFIG) >/dev/null || $(LDCONFIG) || \
	echo "cache of the dynamic linker not updated: run ldconfig as root" >&2)

headers := $(notdir $(wildcard ../../include/$(header)/*.h))

install: all
	$(INSTALL) -d $(DESTDIR)$(libdir)/pkgconfig $(DESTDIR)$(includedir)/$(header)
	$(INSTALL) -m 644 ../../include/$(header).h $(DESTDIR)$(includedir)
	$(INSTALL) -m 644 $(addprefix ../../include/$(header)/,$(headers)) \
		$(DESTDIR)$(includedir)/$(header)
	$(INSTALL) -m 644 $(O)/$(name).a $(DESTDIR)$(libdir)
	$(INSTALL) -m 755 $(O)/$(real) $(DESTDIR)$(libdir)
	ln -sf $(real) $(DESTDIR)$(libdir)/$(soname)
	ln -sf $(soname) $(DESTDIR)$(libdir)/$(name).so
	$(INSTALL) -m 644 $(O)/$(name).pc $(DESTDIR)$(libdir)/pkgconfig
	$(refresh_cache)

uninstall:
	rm -f $(addprefix $(DESTDIR)$(libdir)/,$(real) $(soname) $(name).so $(name).a \
		pkgconfig/$(name).pc) $(DESTDIR)$(includedir)/$(header).h
	rm -f $(addprefix $(DESTDIR)$(includedir)/$(header)/,$(headers))
	-@rmdir $(DESTDIR)$(includedir)/$(header) 2>/dev/null || true
	$(refresh_cache)

clean:
	rm -rf $(O)/$(obj) $(outs)

FORCE:

# a header that an older build has seen may be gone or moved
%.h: ;

.PHONY: all install uninstall clean FORCE
-include $(objs:.o=.d)
