#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Layers of master/ (Documentation/architecture.rst): nothing includes or references what is above
# it, and each layer works without what is above it (layers/run.sh). The last line is
# "N passed, N failed".
#
# usage: check-layers.sh [MODDIR]      MODDIR: only includes and references, of modules built there

set -eu
cd "$(dirname "$0")/.."
. tests/vm/places.sh
[ $# = 0 ] || exec python3 tests/check-layers.py "$1"
# where tests/system/run.sh looks for them
modules=$PWD/build/system-6.1-rt/modules
tests/vm/kernels.sh fetch 6.1-rt >&2
# without W=1, as they do: else each would build what the other has built
locked 6.1-rt make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir 6.1-rt)" MODDIR="$modules" >&2
out=$(mktemp)
trap 'rm -f "$out"' EXIT
rc=0
{
	python3 tests/check-layers.py "$modules" || rc=1
	tests/layers/run.sh || rc=1
} >"$out"
grep -v ' passed, ' "$out"
awk '/ passed, [0-9]+ failed$/ { p += $1; f += $3 } END { print p " passed, " f " failed" }' "$out"
exit $rc
