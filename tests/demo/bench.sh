#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The demo itself, on the machine that loads the modules: called by demo.sh, in
# the VM or on the host.
#
# usage: bench.sh FOLDER    the captured frames go there
#
# EC_BUILD: where things were built; CYCLES, PERIOD_US: length of the run;
# DEMO_START: when demo.sh began; SEGMENT, SLAVES: another segment;
# EC_NIC: see tests/system/run.sh

set -u
out=$1
here=$(cd "$(dirname "$0")" && pwd)
segment=${SEGMENT:-bench} slaves=${SLAVES:-22}
start=${DEMO_START:-$(date +%s)}
modules=$EC_BUILD/modules
tcpdump=

step() { printf '[%3d s] %s\n' $(($(date +%s) - start)) "$*"; }

cleanup() {
	[ -z "$tcpdump" ] || kill "$tcpdump" 2>/dev/null
	rmmod ec_sim 2>/dev/null
	rmmod ec_intel 2>/dev/null
	rmmod ec_master 2>/dev/null
}
trap cleanup EXIT
trap 'exit 130' INT HUP TERM

# die WHAT WHAT-TO-DO
die() {
	echo "demo: FAILED: $1" >&2
	echo "demo: $2" >&2
	exit 1
}

load() {
	local message

	message=$(insmod "$@" 2>&1) && return
	dmesg | tail -n 5 >&2
	die "$message" "the kernel's last messages are above; with secure boot, modules must be signed"
}

wait_for() {	# wait_for SECONDS COMMAND...
	local end=$((SECONDS + $1))

	shift
	until "$@"; do
		[ $SECONDS -lt $end ] || return 1
		sleep 0.1
	done
}

ethercat() { "$EC_BUILD/tool/ethercat" "$@"; }
ready() { [ "$(ethercat slaves 2>/dev/null | awk '$3 == "PREOP"' | wc -l)" = "$slaves" ]; }
capturing() { [ -s "$out/tcpdump.log" ]; }

device=sim0
if [ -n "${EC_NIC:-}" ]; then
	# shellcheck source=tests/system/helpers.bash
	. "$here/../system/helpers.bash"
	device=52:54:00:ec:00:00
fi
load "$modules/master/ec_master.ko" main_devices=$device capture=1
ip link set eccap0 up || die "the interface eccap0" "is there a message of ec_master in the kernel's log?"
tcpdump -i eccap0 -n -B 16384 -Z root -w "$out/demo.pcap" ether proto 0x88a4 2>"$out/tcpdump.log" &
tcpdump=$!
wait_for 20 capturing || die "tcpdump does not start" "see $out/tcpdump.log"
if [ -z "${EC_NIC:-}" ]; then
	load "$modules/devices/sim/ec_sim.ko" segment="$segment"
else
	load_segment "$segment" || die "the network card $EC_NIC" "see above"
fi
step "load: $(uname -r): ec_master, ec_sim with the segment $segment; capturing at eccap0"

wait_for 30 ready || {
	ethercat slaves >&2
	die "not all of $slaves slaves reached PREOP in 30 s" "is the machine busy? else the kernel's log says which slave and why"
}
step "scan: $slaves slaves in PREOP"
ethercat slaves || die "ethercat slaves" "see above"

step "run: $CYCLES cycles of $PERIOD_US us: inputs to outputs, two axes forth and back"
"$EC_BUILD/apps/demo" --cycles "$CYCLES" --period-us "$PERIOD_US" --wired --excuse
rc=$?
dropped=$(cat /sys/class/net/eccap0/statistics/rx_dropped)
sleep 1		# what is on its way to tcpdump
kill -INT $tcpdump
wait $tcpdump
tcpdump=
[ $rc = 0 ] || die "the application ended with $rc" "the lines FAILED above say which check"
step "run: done; frames that the capture missed: $dropped in the master, $(awk '/dropped by kernel/ { print $1 }' "$out/tcpdump.log") in tcpdump"
rmmod ec_sim && { [ -z "${EC_NIC:-}" ] || rmmod ec_intel; } && rmmod ec_master || die "the modules cannot be unloaded" "lsmod shows who uses them"
step "unload: done"
