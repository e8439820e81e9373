#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Instructions that the model needs for the frames of one cycle: in the VM under
# -icount, where one instruction is one tick of the time stamp counter.
#
# usage: sim.sh [--gates]		the same either way

set -u
cd "$(dirname "$0")/../.." || exit 1
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/bench-sim
passed=0 failed=0

tests/vm/kernels.sh fetch "$kernel" >&2 &&
make -s -C tests/bench/sim O="$build" >&2 || exit 1
out=$(tests/vm/run.sh --kernel "$kernel" --timeout 300 --icount --qemu "-cpu max,-erms,-fsrm" -- \
	"$build/sim-bench" all 50 2>&1) || { echo "$out" | tail -n 20; echo "not ok sim-bench ran"; }

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
gate drives100 200000 "100 drives of 8 and 8 bytes, three frames with clocks"
gate drives100-overlapped 200000 "the same, one frame"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
