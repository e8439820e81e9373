#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs in the guest of trip.sh. usage: trip-guest.sh BUILD virtual|generic|native TRIPS

set -u
build=$1 device=$2 trips=$3

{
	printf '%s\n' 'segment seed=32' 'slave s io in=32 out=32'
	for i in {1..32}; do echo "connect s.$i -> s.$i"; done
} >/tmp/segment
if [ "$device" = virtual ]; then
	insmod "$build/modules/master/ec_master.ko" main_devices=sim0 &&
	insmod "$build/modules/devices/sim/ec_sim.ko" segment=/tmp/segment || exit 1
else
	modprobe e1000e &&
	insmod "$build/modules/master/ec_master.ko" \
		main_devices="$(cat /sys/class/net/eth0/address)" &&
	insmod "$build/modules/devices/sim/ec_sim.ko" segment=/tmp/segment netdev=eth1 || exit 1
	case $device in
	generic) insmod "$build/modules/devices/ec_generic.ko" ;;
	native)
		insmod "$build/modules/devices/intel/ec_intel.ko" &&
		"$build/tool/ethercat" device bind --force eth0 ;;
	*) echo "trip-guest.sh: there is no device $device"; exit 2 ;;
	esac || exit 1
fi
for _ in {1..300}; do
	[ "$("$build/tool/ethercat" slaves | awk '$3 == "PREOP"' | wc -l)" != 1 ] || break
	sleep 0.1
done
LD_LIBRARY_PATH="$build/lib" "$build/apps/echo" --trips "$trips" 1000
