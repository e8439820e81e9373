#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The modules build, without a warning, for every supported kernel and architecture;
# 6.1-rt is built by tests/build/check.sh. A warning is an error, else what has been built would
# not show it again. kernel-doc is for tests/build/style.py, once.

set -u
cd "$(dirname "$0")/.." || exit 1
. tests/vm/places.sh
passed=0 failed=0
out=$(mktemp)
trap 'rm -f "$out"' EXIT

for k in ${*:-6.1 6.12 6.12-rt 6.1-i386 6.1-armhf 6.1-arm64 6.1-s390x}; do
	# where tests/system/run.sh looks for them
	dir=$PWD/build/system-$k/modules
	read -ra cross < <(tests/vm/kernels.sh cross "$k")
	if tests/vm/kernels.sh fetch "$k" >&2 && kdir=$(tests/vm/kernels.sh kdir "$k") &&
	   locked "$k" make -j2 modules ${cross[@]+"${cross[@]}"} KDIR="$kdir" MODDIR="$dir" \
		W=1e KCFLAGS="-include$PWD/tests/build/asserts.h" cmd_checkdoc= >"$out" 2>&1 &&
	   ! grep -E 'warning:|WARNING:' "$out"; then
		echo "ok: modules for $k"
		passed=$((passed + 1))
	else
		grep -E 'warning|WARNING|error|ERROR|Error' "$out" | head -n 40
		echo "FAILED: modules for $k"
		failed=$((failed + 1))
	fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
