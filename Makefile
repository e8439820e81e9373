# SPDX-License-Identifier: GPL-2.0-only
#
# make                modules, library, tool, simulator, examples (KDIR= chooses the kernel)
# make install        all of it (DESTDIR=, PREFIX=); make uninstall
# make demo           the main job in a VM; DEMO=list: others
# make doc            documentation as HTML, with the reference of ecrt.h (build/doc/html)
# make bench          figures: what a cycle costs
# make check          every test; the last line is "N passed, N failed"
# make check-long     all system tests on all kernels (hours)
# make check-debug    all tests under detectors, file by file (hours; FILES=thin)

KDIR ?= /lib/modules/$(shell uname -r)/build
PREFIX ?= /usr/local
BUILD ?= $(CURDIR)/build
MODDIR ?= $(BUILD)/modules

# pahole is not installed everywhere, and nothing reads the BTF of these modules. Debug information
# is 37 of 38 MB of ec_master.ko, which each load reads; DEBUG_INFO=y for addr2line and crash.
DEBUG_INFO ?=
KFLAGS = CONFIG_DEBUG_INFO_BTF_MODULES= CONFIG_DEBUG_INFO=$(DEBUG_INFO)
KMAKE = $(MAKE) -C $(KDIR) M=$(MODDIR) $(KFLAGS)

all: modules lib tool examples mini

# libethercat-bus and 'ethercat bus' need libyaml; all the rest builds without it
hash := \#
YAML := $(shell printf '$(hash)include <yaml.h>\nint main(void) { yaml_get_version_string(); }' | \
	$(CC) $(LDFLAGS) -x c -o /dev/null - -lyaml 2>/dev/null && echo y)
NO_YAML = no yaml.h: built without libethercat-bus; install libyaml-dev for it

# Modules are built in a copy: several kernels side by side, a clean clone.
MODSRC = Kbuild $(wildcard master/*.[ch] master/Kbuild master/*/*.[ch] \
	 devices/*.[ch] devices/Kbuild devices/sim/*.[ch] devices/sim/Kbuild \
	 devices/intel/*.[ch] devices/intel/Kbuild include/*.h include/uapi/*.h lib/ecrt/*.[ch])

# A changed file gets the current time: the object of its last version may be newer than the
# file. A file deleted here is deleted there.
sync:
	@mkdir -p $(MODDIR)
	@for f in $(MODSRC); do \
		case $$f in */*) mkdir -p $(MODDIR)/$${f%/*};; esac; \
		cmp -s $$f $(MODDIR)/$$f 2>/dev/null || cp $$f $(MODDIR)/$$f; \
	done
	@cd $(MODDIR) && for f in $$(find . -name '*.[ch]' ! -name '*.mod.c'); do \
		[ -e $(CURDIR)/$$f ] || rm $$f; \
	done

NO_HEADERS = no kernel headers at $(KDIR): install linux-headers-$(shell uname -r) or set KDIR=

headers:
	@[ -e $(KDIR)/Makefile ] || { echo "$(NO_HEADERS)" >&2; exit 1; }

modules: headers sync
	+$(KMAKE) modules

lib:
	$(MAKE) -C lib
	$(MAKE) -C lib/tools
	$(if $(YAML),$(MAKE) -C lib/bus,@echo "$(NO_YAML)" >&2)

tool:
	$(MAKE) -C tool
	$(MAKE) -C tool/sim

examples: lib
	$(MAKE) -C examples

# the examples that are kernel modules, built as modules of an application
MINIDIR ?= $(BUILD)/mini

# kbuild does not notice that symbols of other modules have changed
mini: modules
	@mkdir -p $(MINIDIR)
	@[ ! $(MODDIR)/Module.symvers -nt $(MINIDIR)/Module.symvers ] || \
		rm -f $(MINIDIR)/Module.symvers
	@for f in Kbuild ec_mini.c ec_named.c; do \
		cmp -s examples/mini/$$f $(MINIDIR)/$$f || cp examples/mini/$$f $(MINIDIR)/$$f; \
	done
	+$(MAKE) -C $(KDIR) M=$(MINIDIR) $(KFLAGS) ECRT=$(CURDIR)/include \
		KBUILD_EXTRA_SYMBOLS=$(MODDIR)/Module.symvers modules

# --- documentation -----------------------------------------------------------

DOCDIR ?= $(BUILD)/doc
SPHINXFLAGS ?= -W --keep-going
NO_SPHINX = no sphinx-build: install python3-sphinx

# in a copy, beside the pages that are generated
doc:
	@command -v sphinx-build >/dev/null || { echo "$(NO_SPHINX)" >&2; exit 1; }
	@rm -rf $(DOCDIR)/source && mkdir -p $(DOCDIR)/source
	@cp -r Documentation/*.rst Documentation/pictures $(DOCDIR)/source
	@PYTHONDONTWRITEBYTECODE=1 Documentation/sphinx/api.py include/ecrt.h \
		>$(DOCDIR)/source/api.rst
	@Documentation/sphinx/codes.py . >$(DOCDIR)/source/codes.rst
	sphinx-build -q $(SPHINXFLAGS) -b html -d $(DOCDIR)/doctrees -c Documentation/sphinx \
		$(DOCDIR)/source $(DOCDIR)/html

.PHONY: doc

# --- install -----------------------------------------------------------------

# what uname -r prints on the kernel of these headers
UTSRELEASE = $(KDIR)/include/generated/utsrelease.h
KREL = $(or $(shell sed -n 's/.*UTS_RELEASE "\(.*\)"/\1/p' $(UTSRELEASE) 2>/dev/null), \
	$(error $(NO_HEADERS)))
MODINST = $(DESTDIR)/lib/modules/$(KREL)/updates
# systemd, udev and modprobe look nowhere else
SYSLIB = $(if $(filter /usr,$(PREFIX)),/usr,/usr/local)/lib
UDEVDIR ?= $(SYSLIB)/udev/rules.d

install: install-modules install-lib install-tool install-operation install-udev

# Debian's headers request signed modules but have no key. They have no System.map either,
# without which kbuild skips depmod.
NOSIGN = $(if $(wildcard $(KDIR)/certs/signing_key.pem),,CONFIG_MODULE_SIG_ALL=)

install-modules: modules
	+$(KMAKE) INSTALL_MOD_PATH=$(DESTDIR) INSTALL_MOD_DIR=updates/ethercat \
		$(NOSIGN) $(if $(DESTDIR),DEPMOD=true) modules_install
	install -D -m 644 $(MODDIR)/Module.symvers $(MODINST)/ethercat/Module.symvers
	$(if $(DESTDIR),,depmod $(KREL))

install-lib:
	$(MAKE) -C lib prefix=$(PREFIX) install
	$(MAKE) -C lib/tools prefix=$(PREFIX) install
	$(if $(YAML),$(MAKE) -C lib/bus prefix=$(PREFIX) install)

install-tool:
	$(MAKE) -C tool prefix=$(PREFIX) install
	$(MAKE) -C tool/sim prefix=$(PREFIX) install

# ethercatctl, its configuration and its unit
install-operation:
	$(MAKE) -C operation prefix=$(PREFIX) install

# udev reads a rule at once, and a group that does not exist yet would be left out
install-udev:
	$(if $(DESTDIR),,getent group ethercat >/dev/null || groupadd --system ethercat)
	install -D -m 644 master/60-ethercat.rules $(DESTDIR)$(UDEVDIR)/60-ethercat.rules

# all kernels; the group remains, since files may belong to it. Rules of 'ethercat device bind
# --boot' would leave their cards without driver.
uninstall:
	@for d in $(DESTDIR)/lib/modules/*/updates/ethercat; do \
		[ -d $$d ] || continue; \
		k=$${d%/updates/ethercat}; \
		echo "rm -rf $$d"; rm -rf $$d; rmdir $$k/updates 2>/dev/null; \
		$(if $(DESTDIR),:,depmod $${k##*/}); \
	done
	$(MAKE) -C lib prefix=$(PREFIX) uninstall
	$(MAKE) -C lib/tools prefix=$(PREFIX) uninstall
	$(MAKE) -C lib/bus prefix=$(PREFIX) uninstall
	$(MAKE) -C tool prefix=$(PREFIX) uninstall
	$(MAKE) -C tool/sim prefix=$(PREFIX) uninstall
	$(MAKE) -C operation prefix=$(PREFIX) uninstall
	rm -f $(DESTDIR)$(UDEVDIR)/60-ethercat.rules
	@for f in $(DESTDIR)/etc/udev/rules.d/59-ethercat-*.rules; do \
		grep -qs "'ethercat device bind --boot'" $$f || continue; \
		echo "rm -f $$f"; rm -f $$f; \
	done
	-@cd $(DESTDIR)$(SYSLIB) 2>/dev/null && rmdir udev/rules.d udev modprobe.d \
		systemd/system systemd 2>/dev/null || true
	-@cd $(DESTDIR)$(PREFIX) 2>/dev/null && rmdir share/bash-completion/completions \
		share/bash-completion share/ethercat lib/cmake/ethercat lib/cmake \
		lib/pkgconfig 2>/dev/null || true

.PHONY: install install-modules install-lib install-tool install-operation install-udev uninstall

clean:
	rm -rf $(BUILD)
	$(MAKE) -C lib clean
	$(MAKE) -C lib/tools clean
	$(MAKE) -C lib/bus clean
	$(MAKE) -C tool clean
	$(MAKE) -C tool/sim clean
	$(MAKE) -C examples clean

.PHONY: all headers sync modules lib tool examples mini clean

# CYCLES=, PERIOD_US=; HOST=1: on this machine, not in a VM; DEMO=list shows others
demo:
	@tests/demo/demo.sh $(if $(HOST),--host) $(DEMO)

check:
	tests/check.sh

check-kernels:
	tests/check-kernels.sh

# hours: all of tests/system on all kernels
check-long:
	tests/check-long.sh

# hours; continues where it was ended, results in Documentation/detectors.rst
check-debug:
	tests/check-debug.sh $(FILES)

# figures, some with a limit
bench:
	tests/bench/run.sh

# the tests of the model detect each of its deliberate errors
check-witness:
	tests/witness/run.sh

.PHONY: demo bench check check-kernels check-long check-debug check-witness
