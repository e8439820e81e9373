#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Where the instructions of a cycle are: QEMU executes some cycles of an application step by step
# (native device, 6.1-rt, as cycle.sh measures them) and lists each address. profile.py counts the
# receive and the send of the cycle by function; with a function it counts that one by line.
# It takes what DEBUG_INFO=y tests/bench/cycle.sh --gates has built.
#
# usage: profile.sh [DRIVES [receive|send FUNCTION]]	default: 1; 1, 100, or ring1, ring100,
#						ring100-open: a device at each end

set -u
cd "$(dirname "$0")/../.." || exit 1
build=$PWD/build/system-${EC_KERNEL:-6.1-rt}

# in the guest: the steps of 20 cycles go to DIR/steps
guest() {
	local segment=drive$1 device=native drives dir=$2 port

	[[ $1 != ring* ]] || segment=$1 device=ring
	drives=${1//[^0-9]/}
	tests/bench/cycle/guest.sh "$build" $device "$PWD/tests/segments/$segment.seg" \
		--cycles 6000 >/tmp/bench 2>&1 &
	for _ in {1..600}; do
		"$build/tool/ethercat" slaves 2>/dev/null |
			awk -v n="$drives" '$3 == "OP" { n-- } END { exit n }' && break
		sleep 0.1
	done
	sleep 3	# the cycle is measured from its 1100th on
	port=$(grep -lx monitor /sys/class/virtio-ports/*/name)
	exec 7<>"/dev/$(basename "$(dirname "$port")")"
	cp /proc/kallsyms "$dir/symbols"
	printf '%s\n' "logfile $dir/steps" "singlestep on" >&7
	sleep 0.005
	echo "log exec,nochain" >&7
	sleep 0.02
	printf '%s\n' "log none" "singlestep off" >&7
	wait
	grep -E '^(receive|process|queue|send|total)_mean ' /tmp/bench
}

if [ "${1:-}" = guest ]; then
	guest "$2" "$3"
	exit
fi
case ${1:-1} in
1|100|ring1|ring100|ring100-open) ;;
*) sed -n '/^# usage: /,/^#[^u]*open/s/^# //p' "$0" >&2; exit 2 ;;
esac
more=()
[[ ${1:-1} != ring* ]] || more=(--more-nics e1000e)
[ -e "$build/bench/cycle-bench" ] || {
	echo "profile.sh: run DEBUG_INFO=y tests/bench/cycle.sh --gates first"
	exit 1
}
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT
tests/vm/run.sh --kernel "${EC_KERNEL:-6.1-rt}" --icount --nics ${more[@]+"${more[@]}"} \
	--monitor --rw "$tmp" \
	--qemu "-cpu max,-erms,-fsrm" -- "$0" guest "${1:-1}" "$tmp" &&
	tests/bench/profile.py "$tmp" "$build/modules" "${@:2}"
