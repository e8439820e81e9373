#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# How long a frame is on its way: from ecrt_master_send() until the program has the inputs that
# came back, with one slave; an e1000e with the native device and with the generic one. Under
# -icount a ns is an instruction. The slave answers at the other card with the driver of the
# system and its interrupt, on the same CPU. What is recorded outside the guest shows how long the
# frame is out, from wire to wire: longer when interrupts of the master's card delay the slave. The
# rest is the master's: from the send to the wire, and from the wire to the program.
#
# usage: trip.sh [--gates] [TRIPS]
#   --gates   what has a limit only, with fewer frames: for make check

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt} all=1 trips=2000
[ "${1:-}" != --gates ] || { all=; trips=500; shift; }
trips=${1:-$trips}
build=$PWD/build/system-$kernel
[[ $trips =~ ^[1-9][0-9]*$ ]] || { echo "trip.sh: TRIPS must be a number" >&2; exit 2; }

build() {
	make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir "$kernel")" \
		MODDIR="$build/modules" &&
	make -s -C lib O="$build/lib" all &&
	make -s -C tool O="$build/tool" &&
	make -s -C tests/apps O="$build/apps" LIB="$build/lib"
}
tests/vm/kernels.sh fetch "$kernel" >&2 && locked "$kernel" build >&2 || exit 1

passed=0 failed=0
declare -A median own
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT

# ns NAME: a line "NAME N", whole: a message of the kernel may have come between
ns() { sed -nE "s/^$1 ([0-9]+)\r?\$/\1/p" <<<"$out" | head -n 1; }

# trips DEVICE [run.sh options]
trips() {
	local out wire=0

	out=$(tests/vm/run.sh --kernel "$kernel" --timeout 300 --icount "${@:2}" -- \
		tests/bench/cycle/trip-guest.sh "$build" "$1" "$trips" 2>&1)
	[ "$1" = virtual ] || {
		out+=$'\n'$(tests/bench/trip.py "$tmp/wire.pcap" "$trips" 2>&1)
		wire=$(ns wire_ns)
	}
	median[$1]=$(ns median_ns)
	own[$1]=$((${median[$1]:-0} - ${wire:-0}))
	if [ -n "${median[$1]}" ] && [ -n "$wire" ] && grep -qx 'lost 0' <<<"$out"; then
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

# less TEXT NATIVE GENERIC
less() {
	local text="native device: $1 $2 ns of $3 of the generic one"

	if (($2 > 0 && $2 < $3)); then
		echo "ok $text"
		passed=$((passed + 1))
	else
		echo "not ok $text"
		failed=$((failed + 1))
	fi
}

[ -z "$all" ] || trips virtual
recorded=(--nics --qemu "-object filter-dump,id=wire,netdev=h0,file=$tmp/wire.pcap")
trips generic "${recorded[@]}"
trips native "${recorded[@]}"
less "the trip of a frame takes" "${median[native]}" "${median[generic]}"
less "of these the master needs" "${own[native]}" "${own[generic]}"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
