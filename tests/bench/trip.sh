#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# How long a frame is on its way: from ecrt_master_send() until the program has the inputs that
# came back, with one slave; an e1000e with the native device and with the generic one. Under
# -icount a ns is an instruction. The slave answers at the other card with the driver of the
# system and its interrupt: the same for both.
#
# usage: trip.sh [--gates] [TRIPS]
#   --gates   what has a limit only, with fewer frames: for make check

set -u
cd "$(dirname "$0")/../.." || exit 1
kernel=${EC_KERNEL:-6.1-rt} all=1 trips=2000
[ "${1:-}" != --gates ] || { all=; trips=500; shift; }
trips=${1:-$trips}
build=$PWD/build/system-$kernel
[[ $trips =~ ^[1-9][0-9]*$ ]] || { echo "trip.sh: TRIPS must be a number" >&2; exit 2; }

tests/vm/kernels.sh fetch "$kernel" >&2 &&
make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir "$kernel")" MODDIR="$build/modules" >&2 &&
make -s -C lib O="$build/lib" all >&2 &&
make -s -C tool O="$build/tool" >&2 &&
make -s -C tests/apps O="$build/apps" LIB="$build/lib" >&2 || exit 1

passed=0 failed=0
declare -A median

# trips DEVICE [run.sh options]
trips() {
	local out

	out=$(tests/vm/run.sh --kernel "$kernel" --timeout 300 --icount "${@:2}" -- \
		tests/bench/cycle/trip-guest.sh "$build" "$1" "$trips" 2>&1)
	median[$1]=$(awk '$1 == "median_ns" { print $2 }' <<<"$out")
	if [ -n "${median[$1]}" ] && grep -qx 'lost 0' <<<"$out"; then
		echo "# $1: $(grep _ns <<<"$out" | tr '\n' ' ')"
		echo "ok $1: $trips frames came back"
		passed=$((passed + 1))
	else
		tail -n 20 <<<"$out"
		echo "not ok $1: $trips frames come back"
		failed=$((failed + 1))
		median[$1]=0
	fi
}

[ -z "$all" ] || trips virtual
trips generic --nics
trips native --nics
text="native device: the trip of a frame takes ${median[native]} ns of ${median[generic]} of the generic one"
if ((median[native] && median[native] < median[generic])); then
	echo "ok $text"
	passed=$((passed + 1))
else
	echo "not ok $text"
	failed=$((failed + 1))
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
