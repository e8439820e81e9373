#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# What a cycle notices of 100 slaves that upload meanwhile, and the memory of a slave, in the VM
# under -icount. A row has the goal, a gate what is reached today. Latency and throughput are
# figures in bus time: bus.sh, tests/bus/mailbox_figures_kunit.c.
#
# usage: mailbox.sh [--gates]
#   --gates   for make check: without 1000 slaves

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/system-$kernel
passed=0 failed=0 all=1
[ "${1:-}" != --gates ] || all=
declare -A v

build() {
	local kdir

	kdir=$(tests/vm/kernels.sh kdir "$kernel")
	make -s -j2 modules KDIR="$kdir" MODDIR="$build/modules" &&
	make -s -C lib O="$build/lib" all &&
	make -s -C tool O="$build/tool" &&
	make -s -C tool/sim O="$build/tool" &&
	make -s -C tests/bench/cycle O="$build/bench" LIB="$build/lib" &&
	mkdir -p "$build/split" && cp -u tests/bench/cycle/split/* "$build/split" &&
	make -s -C "$kdir" M="$build/split" CONFIG_DEBUG_INFO_BTF_MODULES= \
		CONFIG_DEBUG_INFO= modules
}
tests/vm/kernels.sh fetch "$kernel" >&2 && locked "$kernel" build >&2 || exit 1

# guest TEXT OPTION... -- COMMAND...: in the VM; adds its lines "name value" to v
guest() {
	local text=$1 opts=() out line

	shift
	while [ "$1" != -- ]; do opts+=("$1"); shift; done
	shift
	if ! out=$(tests/vm/run.sh --kernel "$kernel" --timeout 600 --icount \
			--qemu "-cpu max,-erms,-fsrm" ${opts[@]+"${opts[@]}"} -- "$@" 2>&1); then
		tail -n 20 <<<"$out" | sed 's/^/# /'
		gate "$text: the guest runs" 0
		return 1
	fi
	while read -r line; do
		[[ $line =~ ^([a-z0-9_]+)\ ([0-9]+)$ ]] && v[${BASH_REMATCH[1]}]=${BASH_REMATCH[2]}
	done <<<"$out"
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

# row VALUE GOAL TEXT: of the table run.sh prints
row() { echo "# row: $*"; }

# percent NAME: with uploads, of without
percent() { echo $(((100 * ${v[busy_$1]} + ${v[$1]} - 1) / ${v[$1]})); }

# unchanged LIMIT NAME TEXT: the row has the ratio and its goal; the gate is the value, since what
# the CPU did before has an influence on the one without uploads
unchanged() {
	local p

	p=$(percent "$2")
	row "$p" 110 "% of it without uploads: $3 of a cycle beside 100 slaves that upload"
	gate "100 slaves upload: $3 of a cycle ${v[busy_$2]}, at most $1; $p % of it without, goal 110" \
		"v[busy_$2] <= $1"
}

cycle() {
	local bad options="--cycles 500 --period-us 4000 --work 1"

	guest "a cycle beside uploads" --nics -- tests/bench/cycle/guest.sh "$build" native \
		"$PWD/tests/segments/drive100.seg" $options + busy $options --uploads 100 || return
	bad=$((v[busy_lost] + v[busy_wc_errors] + v[busy_upload_errors]))
	gate "${v[busy_uploads_done]} uploads beside 500 cycles, $bad of them or of the frames failed" \
		"v[busy_uploads_done] > 100 && bad == 0"
	# the call that sends carries the acyclic frames of 4 ms
	unchanged 185000 total_mean "mean instructions of the calls"
	unchanged 230000 total_max "most instructions of the calls"
	unchanged 6000 late_ns_mean "mean lateness in ns"
	unchanged 9000 late_ns_max "largest lateness in ns"
}

# memory_of N: KiB with N slaves in kb, 2 s after all are in PREOP in start_kb; 1 if the guest does
# not run
memory_of() {
	guest "memory, $1 slaves" --timeout 1200 -- tests/bench/cycle/memory-guest.sh \
		"$build" "$1" || return
	kb=${v[memory_kb]}
	start_kb=${v[start_kb]}
	echo "# with $1 slave(s): $start_kb KiB of the kernel and ${v[start_workers]} threads of slaves" \
		"after the start, $kb KiB and ${v[workers]} threads a minute later"
}

# The module, a device and the rest are in the memory with one slave.
memory() {
	local n one start_one bytes most

	memory_of 1 || return
	one=$kb start_one=$start_kb
	for n in 100 ${all:+1000}; do
		memory_of "$n" || return
		bytes=$(((kb - one) * 1024 / (n - 1)))
		most=$(((start_kb - start_one) * 1024 / (n - 1)))
		row "$bytes" 20000 "bytes of memory of each of $n slaves, stacks of threads included"
		gate "each of $n slaves takes $bytes bytes, at most 20000" \
			"bytes > 0 && bytes <= 20000"
		gate "each of $n slaves takes $most bytes after the start, at most 30000" \
			"most > 0 && most <= 30000"
		gate "${v[workers]} threads stay for $n slaves, one for 16 of them" \
			"v[workers] == (n + 15) / 16"
	done
}

cycle
memory
echo "$passed passed, $failed failed"
[ $failed = 0 ]
