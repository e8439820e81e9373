#!/bin/busybox sh
# SPDX-License-Identifier: GPL-2.0-only
#
# PID 1 in the guest of suspend.sh: an idle master, and the computer asleep in S3. Programs,
# modules and libraries are where the host has them.

/bin/busybox mkdir -p /bin /proc /sys /dev /tmp
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
[ -e /dev/null ] || mount -t devtmpfs devtmpfs /dev
. /env	# device, build

# a whole line among those of the kernel
say() { echo "suspend-init: $*" >/dev/kmsg; }

end() {
	echo o >/proc/sysrq-trigger
	sleep 60
}

# wait_for SECONDS COMMAND...
wait_for() {
	local n=$(($1 * 10))

	shift
	until "$@"; do
		n=$((n - 1))
		[ $n -gt 0 ] || { say "timed out: $*"; end; }
		usleep 100000
	done
}

must() { "$@" || { say "failed: $*"; end; }; }
slaves_are() {
	[ "$("$build/tool/ethercat" slaves 2>/dev/null | awk -v s="$1" '$3 == s' | wc -l)" = 22 ]
}

while read -r m; do must insmod "$m"; done </order
must insmod "$build/modules/master/ec_master.ko" main_devices=52:54:00:ec:00:00
must insmod "$build/modules/devices/sim/ec_sim.ko" segment=bench netdev=eth1
if [ "$device" = native ]; then
	must insmod "$build/modules/devices/intel/ec_intel.ko"
	must "$build/tool/ethercat" device bind --force eth0
else
	must insmod "$build/modules/devices/ec_generic.ko"
fi
# scanned TIMES: so often since the start, and the slaves are in PREOP
scanned() {
	[ "$(dmesg | grep -c 'EtherCAT 0: scan complete: 22 slave(s)')" -ge "$1" ] &&
		slaves_are PREOP
}

wait_for 120 scanned 1
for n in 1 2; do
	must sh -c 'echo deep >/sys/power/mem_sleep'
	must sh -c 'echo +5 >/sys/class/rtc/rtc0/wakealarm'
	must sh -c 'echo mem >/sys/power/state'
	wait_for 120 scanned $((n + 1))
	must env LD_LIBRARY_PATH="$build/lib" "$build/apps/demo" --cycles 500
	say "works after resume $n"
done
end
