# SPDX-License-Identifier: GPL-2.0-only
#
# make                modules, library, tool, simulator (KDIR= chooses the kernel)
# make install        all of it (DESTDIR=, PREFIX=)
# make demo           the main job in a VM
# make bench          figures: what a cycle costs
# make check          every test; the last line is "N passed, N failed"

KDIR ?= /lib/modules/$(shell uname -r)/build
PREFIX ?= /usr/local
BUILD ?= $(CURDIR)/build
MODDIR ?= $(BUILD)/modules

# pahole is not always there, and nobody needs the modules' BTF
KMAKE = $(MAKE) -C $(KDIR) M=$(MODDIR) CONFIG_DEBUG_INFO_BTF_MODULES=

all: modules lib tool

# Modules are built in a copy: several kernels side by side, a clean clone.
MODSRC = Kbuild $(wildcard master/*.[ch] master/Kbuild master/wire/*.[ch] \
	 devices/*.[ch] devices/Kbuild devices/sim/*.[ch] devices/sim/Kbuild \
	 include/*.h include/uapi/*.h)

sync:
	@mkdir -p $(MODDIR)
	@for f in $(MODSRC); do \
		case $$f in */*) mkdir -p $(MODDIR)/$${f%/*};; esac; \
		cmp -s $$f $(MODDIR)/$$f 2>/dev/null || cp -p $$f $(MODDIR)/$$f; \
	done

modules: sync
	+$(KMAKE) modules

lib:
	$(MAKE) -C lib

tool:
	$(MAKE) -C tool
	$(MAKE) -C tool/sim

clean:
	rm -rf $(BUILD)
	$(MAKE) -C lib clean
	$(MAKE) -C tool clean
	$(MAKE) -C tool/sim clean

.PHONY: all sync modules lib tool clean

# CYCLES=, PERIOD_US=; HOST=1: on this machine, not in a VM
demo:
	@tests/demo/demo.sh $(if $(HOST),--host)

check:
	tests/check.sh

check-kernels:
	tests/check-kernels.sh

# figures; gates where a figure has to be reached
bench:
	tests/bench/run.sh

# the tests of the model notice each of its deliberate errors
check-witness:
	tests/witness/run.sh

.PHONY: demo bench check check-kernels check-witness
