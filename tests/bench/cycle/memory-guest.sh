#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs in the guest of mailbox.sh: memory of the kernel that the master takes for N slaves, its
# threads included. The slaves are a program at the other end of a wire, so theirs is not in it.
# usage: memory-guest.sh BUILD N

set -u
build=$1 n=$2
segment=$(mktemp)
printf 'segment seed=3 response=100us transition=1ms\nrepeat %u slave d drive in=8 out=8\n' "$n" >"$segment"

# What a slave is made of: slabs that cannot be reclaimed, vmalloc, where stacks are, and what there
# is for each CPU. Free memory varies by more than 100 slaves take.
kernel_kb() {
	sync
	echo 3 >/proc/sys/vm/drop_caches
	awk '/^(SUnreclaim|VmallocUsed|Percpu):/ { kb += $2 } END { print kb }' /proc/meminfo
}

workers() { pgrep -c '^EtherCAT.*-slv'; }

preop() {
	"$build/tool/ethercat" slaves 2>/dev/null |
		awk -v n="$n" '$3 == "PREOP" { k++ } END { exit k != n }'
}

modprobe veth && ip link add veth0 type veth peer name veth1 && ip link set veth1 up || exit 1
chrt -f 1 "$build/tool/ethercat-sim" --segment "$segment" veth1 >/dev/null &
sleep 2
before=$(kernel_kb)
insmod "$build/modules/master/ec_master.ko" main_devices=veth0 &&
	insmod "$build/modules/devices/ec_generic.ko" || exit 1
for _ in {1..600}; do
	if preop; then break; fi
	sleep 0.5
done
preop || { "$build/tool/ethercat" master; "$build/tool/ethercat" slaves | tail -n 3; exit 1; }
sleep 2
echo "start_kb $(($(kernel_kb) - before))"
echo "start_workers $(workers)"
# idle ones end
sleep 60
echo "memory_kb $(($(kernel_kb) - before))"
echo "workers $(workers)"
