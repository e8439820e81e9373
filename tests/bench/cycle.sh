#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The cost and the reliability of a cycle, in the VM. Under -icount one guest
# instruction is one tick of the time stamp counter, so costs are exact and the
# same on every machine. Gated: 10 000 cycles without a lost frame or a wrong
# working counter, instructions and system calls per cycle. The run in real
# time depends on the host and is printed only.
#
# usage: cycle.sh [--cycles N]      N: of the long run, default 10000

set -u
cd "$(dirname "$0")/../.." || exit 1
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/system-$kernel
cycles=10000
[ "${1:-}" != --cycles ] || cycles=$2
passed=0 failed=0
declare -A v

tests/vm/kernels.sh fetch "$kernel" >&2 &&
make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir "$kernel")" MODDIR="$build/modules" >&2 &&
make -s -C lib O="$build/lib" all >&2 &&
make -s -C tests/bench/cycle O="$build/bench" LIB="$build/lib" >&2 || exit 1

# A string copy counts once per byte with ERMS and once per word without. The
# incumbent's figures grow by too little from 1 to 100 drives for the former.
icount=(--icount --qemu "-cpu max,-erms,-fsrm")

# run NAME [run.sh options] -- SEGMENT [cycle-bench options]; fills v
run() {
	local name=$1 out line opts=()

	shift
	while [ "$1" != -- ]; do opts+=("$1"); shift; done
	shift
	case $1 in *.seg) set -- "$PWD/tests/segments/$1" "${@:2}" ;; esac
	v=()
	if ! out=$(tests/vm/run.sh --kernel "$kernel" --timeout 300 ${opts[@]+"${opts[@]}"} -- \
		   tests/bench/cycle/guest.sh "$build" "$@" 2>&1); then
		echo "$out" | tail -n 30
		echo "not ok $name: the run failed"
		failed=$((failed + 1))
		[[ $out == *wc_errors* ]] || return 1
	fi
	while read -r line; do
		[[ $line =~ ^([a-z0-9_]+)\ ([0-9.]+)$ ]] && v[${BASH_REMATCH[1]}]=${BASH_REMATCH[2]}
	done <<<"$out"
	[ -n "${v[wc_errors]:-}" ]
}

# gate TEXT CONDITION: an arithmetic one
gate() {
	if (($2)); then
		echo "ok $1"
		passed=$((passed + 1))
	else
		echo "not ok $1"
		failed=$((failed + 1))
	fi
}

reliable() {
	gate "$1: ${v[cycles]} cycles, ${v[slaves]} slaves: ${v[lost]} frames lost, ${v[wc_errors]} working-counter errors" \
		"${v[lost]} == 0 && ${v[wc_errors]} == 0 && ${v[call_errors]} == 0 &&
		 ${v[operational]} == ${v[slaves]}"
}

ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", a / b }'; }

# cost DEVICE SLAVES: a row of the table
cost() {
	printf '# %-8s %4u slave(s) %5u bytes: receive %6u process %4u queue %4u send %7u = %7u (a refused ioctl: %u)\n' \
		"$1" "${v[slaves]}" "${v[image_bytes]}" "${v[receive_median]}" "${v[process_median]}" \
		"${v[queue_median]}" "${v[send_median]}" "${v[total_median]}" "${v[entry]}"
}

long_run() {
	run "long run" "${icount[@]}" -- bench --cycles "$cycles" || return
	reliable "1 kHz, icount, virtual device"
	echo "# lateness of the wake-up: median ${v[late_ns_median]} ns, 99.9 % ${v[late_ns_p999]} ns, max ${v[late_ns_max]} ns"
}

virtual_cost() {
	local seg

	echo "# instructions per cycle, virtual device: the calls contain the work of the simulator"
	for seg in drive1.seg drive10.seg drive100.seg; do
		run "$seg" "${icount[@]}" -- $seg --cycles 500 || return
		cost virtual
	done
}

system_calls() {
	local n

	for n in 1 8; do
		run "system calls" "${icount[@]}" -- drive10.seg --cycles 100 --domains $n --extras \
			--syscalls || return
		echo "# system calls per cycle, $n domain(s), state queries and application time: ${v[syscalls_max]}"
	done
}

real_time() {
	run "real time" --smp 2 -- bench --cycles 5000 || return
	echo "# real time, not gated: ${v[cycles]} cycles: ${v[lost]} frames lost, ${v[wc_errors]} working-counter errors, ${v[overruns]} overruns"
	echo "# lateness: median ${v[late_ns_median]} ns, 99.9 % ${v[late_ns_p999]} ns, max ${v[late_ns_max]} ns"
}

long_run
virtual_cost
system_calls
real_time
echo "$passed passed, $failed failed"
[ $failed = 0 ]
