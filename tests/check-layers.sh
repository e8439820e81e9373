#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Layers of master/ (Documentation/architecture.rst): nothing includes or references what is above
# it. Builds the modules if they are not there. The last line is "N passed, N failed".
#
# usage: check-layers.sh [MODDIR]

set -eu
cd "$(dirname "$0")/.."
# where tests/system/run.sh looks for them
modules=${1:-$PWD/build/system-6.1-rt/modules}
if [ $# = 0 ]; then
	tests/vm/kernels.sh fetch 6.1-rt >&2
	make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir 6.1-rt)" MODDIR="$modules" W=1 >&2
fi
exec python3 tests/check-layers.py "$modules"
