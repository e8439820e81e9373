#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# How far sends are from their schedule, from the master's own histogram: in the
# VM in real time, application's cycle and kernel's cycle, idle and under load.
# All times depend on the host and are printed only: a VM without KVM has no real
# time. Gated: each send was counted.
#
# usage: jitter-vm.sh [--cycles N]		default 3000

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/system-$kernel
cycles=3000
while [ $# -gt 0 ]; do
	case $1 in
	--cycles) cycles=${2:-} && shift ;;
	*) echo "jitter-vm.sh: unknown option '$1'" >&2 && exit 2 ;;
	esac
	shift
done
[[ $cycles =~ ^[1-9][0-9]*$ ]] || { echo "jitter-vm.sh: --cycles needs a number" >&2; exit 2; }

build() {
	make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir "$kernel")" \
		MODDIR="$build/modules" &&
	make -s -C lib O="$build/lib" all &&
	make -s -C tool O="$build/tool" &&
	make -s -C tests/bench/cycle O="$build/bench" LIB="$build/lib"
}
tests/vm/kernels.sh fetch "$kernel" >&2 && locked "$kernel" build >&2 || exit 1

out=$(mktemp)
trap 'rm -f "$out"' EXIT
tests/vm/run.sh --kernel "$kernel" --smp 2 --timeout 600 -- \
	tests/bench/cycle/jitter-guest.sh "$build" "$PWD/tests/segments/drive10.seg" "$cycles" >"$out" 2>&1
rc=$?
sed -n 's/^= /# == /p; s/^  /#    /p' "$out"
passed=0 failed=0
while read -r _ name sends; do
	if [ "$sends" -ge "$cycles" ]; then
		echo "ok $name: $sends sends counted, at least $cycles"
		passed=$((passed + 1))
	else
		echo "not ok $name: $sends sends counted, at least $cycles"
		failed=$((failed + 1))
	fi
done < <(grep '^counted ' "$out")
if [ $rc != 0 ] || [ $((passed + failed)) != 4 ]; then
	tail -n 30 "$out"
	echo "not ok the guest ended with $rc"
	failed=$((failed + 1))
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
