#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Instructions that the model needs for the frames of one cycle: in the VM under
# -icount, where one instruction is one tick of the time stamp counter. How much of a
# cycle of 1 ms that is in the VM's real time depends on the host and is printed only.
#
# usage: sim.sh [--gates]
#   --gates   what has a limit only: for make check

set -u
cd "$(dirname "$0")/../.." || exit 1
gates=${1:-}
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/bench-sim
passed=0 failed=0

tests/vm/kernels.sh fetch "$kernel" >&2 &&
make -s -C tests/bench/sim O="$build" >&2 || exit 1

# bench OPTION...: in the VM; $out
bench() {
	out=$(tests/vm/run.sh --kernel "$kernel" --timeout 300 --qemu "-cpu max,-erms,-fsrm" "$@" -- \
		"$build/sim-bench" all 50 2>&1) || { echo "$out" | tail -n 20; echo "not ok sim-bench ran"; }
}

bench --icount

# gate CASE LIMIT TEXT
gate() {
	local n

	n=$(sed -n "s/^$1 .*ticks_per_cycle=//p" <<<"$out")
	if [ -n "$n" ] && [ "$n" -le "$2" ]; then
		echo "ok $3: $n instructions a cycle, limit $2"
		passed=$((passed + 1))
	else
		echo "not ok $3: ${n:-no} instructions a cycle, limit $2"
		failed=$((failed + 1))
	fi
	echo "# row: ${n:-999999999} $2 instructions of the simulator a cycle: $3"
}

gate io1000 250000 "1000 slaves with a byte of outputs, one LRW"
gate io1000-both 350000 "1000 slaves with a byte each way, one LRW"
gate io1000-clocks 800000 "the same with clocks and a poll of AL states"
gate io1000-one 3000 "1000 slaves with a byte each way, an LRW that concerns one of them"
gate drives100 200000 "100 drives of 8 and 8 bytes, three frames with clocks"
gate drives100-overlapped 200000 "the same, one frame"
if [ "$gates" != --gates ]; then
	bench
	awk -v accel="$(tests/vm/run.sh --probe)" '{
		for (i = 1; i <= NF; i++)
			if (sub(/^least_ns=/, "", $i))
				printf "# real time (%s), not gated: %s: %.0f %% of a cycle of 1 ms\n",
					accel, $1, $i / 10000
	}' <<<"$out"
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
