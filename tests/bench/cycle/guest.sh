#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs in the guest: a segment, one run of cycle-bench, or several.
# usage: guest.sh BUILD DEVICE SEGMENT [cycle-bench options] [+ NAME options]...
#   NAME    stands before each name of what that run prints: NAME_cycles
# EC_INTERRUPT=legacy: of eth0, instead of MSI-X
#   DEVICE  virtual: the model as sim0; generic: eth0, the model answers on
#           eth1, which is joined with it (run.sh --nics); native: the same, and
#           eth0 has the native driver; ring: native on eth0 and eth2, the model
#           answers on eth1 and eth3 (--more-nics e1000e)

set -u
build=$1 device=$2 segment=$3
shift 3

# it counts on one CPU, which -icount has
[ "$(nproc)" != 1 ] || insmod "$build/split/bench_split.ko" || exit 1

case $device in
virtual)
	insmod "$build/modules/master/ec_master.ko" main_devices=sim0 &&
	insmod "$build/modules/devices/sim/ec_sim.ko" segment="$segment" || exit 1
	;;
generic|native|ring)
	# The simulator's interrupts come late, after the calls that are measured. QEMU's
	# card cannot do MSI: the driver falls back to the legacy interrupt.
	mode=2
	[ "${EC_INTERRUPT:-msix}" = msix ] || mode=0
	if [ "$(nproc)" = 1 ]; then
		"$build/bench/cycle-bench" --baseline 1000 || exit 1
		for us in 1000 4100; do
			floor=$("$build/bench/cycle-bench" --floor --cycles 300 \
				--period-us $us) || exit 1
			echo "$floor" | sed "s/^floor/floor$us/"
		done
	fi
	[ "$device" != ring ] || mode=$mode,0,$mode,0
	modprobe e1000e IntMode=${mode%,0},0 RxIntDelay=0,200,0,200 && ip link set eth1 up || exit 1
	ends=eth1 backup=
	if [ "$device" = ring ]; then
		ends="eth1 eth3"
		ip link set eth3 up || exit 1
		backup=backup_devices=$(cat /sys/class/net/eth2/address)
	fi
	# of a real-time task the timers expire in the interrupt: no thread of the kernel
	# works for the simulator
	chrt -f 1 "$build/tool/ethercat-sim" --segment "$segment" $ends &
	main=eth0
	[ "$device" = generic ] || main=$(cat /sys/class/net/eth0/address)
	insmod "$build/modules/master/ec_master.ko" main_devices=$main $backup || exit 1
	if [ "$device" = generic ]; then
		insmod "$build/modules/devices/ec_generic.ko" || exit 1
	else
		insmod "$build/modules/devices/intel/ec_intel.ko" &&
			"$build/tool/ethercat" device bind eth0 || exit 1
		[ "$device" = native ] || "$build/tool/ethercat" device bind eth2 || exit 1
	fi
	;;
*)
	echo "guest.sh: there is no device $device"
	exit 2
	;;
esac
# its interrupts appear when it is up
[ "$device" = virtual ] || echo "msix $(grep -c 'PCI-MSI.*eth0-rx' /proc/interrupts)"
if [ "$device" = ring ]; then
	until [ "$("$build/tool/ethercat" master | grep -c 'Link: UP')" = 2 ]; do sleep 0.1; done
	# the slaves of both ends are found
	sleep 1
	"$build/tool/ethercat" slaves --wait >/dev/null || exit 1
fi
# the link of a NIC takes a moment
for _ in {1..100}; do
	[ -z "$("$build/tool/ethercat" slaves)" ] || break
	sleep 0.1
done

rc=0 name=
while :; do
	options=()
	while [ $# -gt 0 ] && [ "$1" != + ]; do options+=("$1"); shift; done
	"$build/bench/cycle-bench" ${options[@]+"${options[@]}"} | sed -u "s/^/$name/"
	[ "${PIPESTATUS[0]}" = 0 ] || rc=1
	[ $# -gt 0 ] || exit $rc
	name=$2_
	shift 2
	# the session before has ended when its slaves are back
	for _ in {1..300}; do
		"$build/tool/ethercat" slaves | awk '$3 != "PREOP" { n++ } END { exit n }' && break
		sleep 0.1
	done
done
