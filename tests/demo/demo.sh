#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The main job, shown: installs what is missing, builds, boots Debian's
# PREEMPT_RT kernel in a VM and runs bench.sh there; then tshark reads the
# captured frames.
#
# usage: demo.sh [NAME...]           in a VM
#        demo.sh --host [NAME...]    on this machine, with the headers of its kernel
#
# NAME: list shows them; without one, the main job
#
# CYCLES=10000 PERIOD_US=1000   length of the run
# KDIR=DIR                      headers, for --host
# EC_KERNEL=6.1-rt              kernel of the VM
# VM_OPTIONS=                   more options of tests/vm/run.sh

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
. tests/demo/steps.sh
export CYCLES=${CYCLES:-10000} PERIOD_US=${PERIOD_US:-1000}
kernel=${EC_KERNEL:-6.1-rt}
host=0
if [ "${1:-}" = --host ]; then
	host=1
	shift
fi
if [ "$*" = list ]; then
	exec tests/demo/scenes.sh list
fi
scenes=("$@")
tests/demo/scenes.sh known ${scenes[@]+"${scenes[@]}"} || {
	sed -n 's/^# \{0,1\}//p' "$0" | sed -n '/^usage/,/^$/p' >&2
	exit 2
}
out=$PWD/build/demo
DEMO_START=$(date +%s)
export DEMO_START

# die WHAT WHAT-TO-DO
die() {
	echo "demo: FAILED: $1" >&2
	echo "demo: $2" >&2
	exit 1
}

number() {
	[[ $2 =~ ^[1-9][0-9]{0,7}$ ]] || die "$1=$2 is no number of 1 to 8 digits" "give for example $1=$3"
}

number CYCLES "$CYCLES" 10000
number PERIOD_US "$PERIOD_US" 1000

if [ $host = 1 ]; then
	KDIR=${KDIR:-/lib/modules/$(uname -r)/build}
	EC_BUILD=${EC_BUILD:-$PWD/build/host-$(uname -r)}
	groups="build capture"
else
	EC_BUILD=${EC_BUILD:-$PWD/build/system-$kernel}
	groups="build capture vm"
fi
export EC_BUILD

# --- install -------------------------------------------------------------------
# shellcheck disable=SC2086
on install tests/install-deps.sh $groups ||
	die "the installation" "install the packages named above, then run this again"
if [ $host = 1 ]; then
	[ "$(id -u)" = 0 ] || die "HOST=1 loads modules" "run it as root, or without HOST=1 for a VM"
	[ -e "$KDIR/Makefile" ] || die "no kernel headers at $KDIR" \
		"apt-get install linux-headers-$(uname -r), or name them with KDIR="
	lsmod | grep -qE '^ec_(master|sim) ' && die "ec_master is loaded already" \
		"stop what uses it, then: rmmod ec_sim ec_generic ec_master"
else
	on kernel tests/vm/kernels.sh fetch "$kernel" ||
		die "no kernel $kernel" "see above; a network with Debian packages is needed the first time"
	KDIR=$(tests/vm/kernels.sh kdir "$kernel")
	step "kernel: $(tests/vm/kernels.sh release "$kernel")"
fi

# --- build -----------------------------------------------------------------------
mkdir -p "$out" "$EC_BUILD"
rm -f "$out"/demo.pcap "$out"/*.log
logged() { "$@" >>"$out/build.log" 2>&1; }
build() {
	on "build: modules" logged make -s -j"$(nproc)" modules KDIR="$KDIR" \
		MODDIR="$EC_BUILD/modules" &&
	on "build: library" logged make -s -C lib O="$EC_BUILD/lib" all &&
	on "build: tool" logged make -s -C tool O="$EC_BUILD/tool" &&
	on "build: application" logged make -s -C tests/apps O="$EC_BUILD/apps" \
		LIB="$EC_BUILD/lib" "$EC_BUILD/apps/demo" "$EC_BUILD/apps/parts"
}
locked "$kernel" build || {
	grep -E 'error|Error' "$out/build.log" | head -n 20 >&2
	die "the build" "see $out/build.log"
}
step "build: all of it is in $EC_BUILD"

# --- run -------------------------------------------------------------------------
job=(tests/demo/bench.sh "$out")
[ ${#scenes[@]} = 0 ] || job=(tests/demo/scenes.sh "${scenes[@]}")
if [ $host = 1 ]; then
	step "run: on this machine, $(uname -r)"
	"${job[@]}"
	rc=$?
else
	accel=$(tests/vm/run.sh --kernel "$kernel" --probe) ||
		die "QEMU cannot be started" "see above"
	case $accel in
	kvm) step "boot: QEMU with KVM" ;;
	*)   step "boot: QEMU without KVM (no guest starts with it here): cycles will be late at times" ;;
	esac
	# shellcheck disable=SC2086
	tests/vm/run.sh --kernel "$kernel" --rw "$out" --dmesg "$out/kernel.log" \
		--timeout $((120 + CYCLES * PERIOD_US / 200000)) ${VM_OPTIONS:-} -- \
		env EC_BUILD="$EC_BUILD" CYCLES="$CYCLES" PERIOD_US="$PERIOD_US" \
		DEMO_START="$DEMO_START" "${job[@]}"
	rc=$?
	case $rc in
	70)	die "the kernel reported a fault" "that is a bug of ours; its log is $out/kernel.log" ;;
	124)	die "the VM did not finish in time" "is the machine busy? try again, or with CYCLES=2000" ;;
	125)	die "the VM" "see above; $out/kernel.log may say more" ;;
	esac
fi
[ $rc = 0 ] || die "see above" "the kernel's log: $([ $host = 1 ] && echo dmesg || echo "$out/kernel.log")"

if [ ${#scenes[@]} != 0 ]; then
	step "demo: passed"
	exit
fi

# --- capture ---------------------------------------------------------------------
tests/demo/capture.sh "$out/demo.pcap" "$CYCLES" || exit 1
step "demo: passed"
