#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# In the guest of run.sh: slaves in OP by an application, then a reboot that stops nothing.
#
# usage: guest.sh native|generic reboot|off|kexec KERNEL	kexec starts KERNEL

set -eu
. tests/system/helpers.bash
modprobe e1000e
if [ "$1" = native ]; then
	EC_NIC=e1000e
	start bench 22
else
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=52:54:00:ec:00:00
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=bench netdev=eth1
	wait_for 120 all_slaves_are PREOP 22
fi
LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000000 >/dev/null 2>&1 &
wait_for 120 all_slaves_are OP 22
sleep 1
case $2 in
reboot)	busybox reboot -f ;;
off)	busybox poweroff -f ;;
kexec)	tests/reboot/kexec.py "$3" "console=ttyS0 loglevel=7 panic=-1 after=kexec" ;;
esac
sleep 60
