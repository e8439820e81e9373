#!/bin/busybox sh
# SPDX-License-Identifier: GPL-2.0-only
#
# PID 1 of a test guest (see run.sh). It mounts the host's root read-only over
# 9p, lays a tmpfs over it, runs the command there and stores its exit status
# in the control directory.

/bin/busybox mkdir -p /bin /proc /sys /dev /ctl /host /rw /n
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc

# The name of this parameter is not the kernel's, so it is ours alone.
case " $(cat /proc/cmdline) " in
*" ec_probe "*)	# run.sh only asks whether a guest gets as far as this
	echo "ec-vm: probe ok" >/dev/console
	echo b >/proc/sysrq-trigger
	sleep 60 ;;
esac

mount -t sysfs sysfs /sys
[ -e /dev/null ] || mount -t devtmpfs devtmpfs /dev
mkdir -p /dev/pts /dev/shm
mount -t devpts -o ptmxmode=666,mode=620 devpts /dev/pts
mount -t tmpfs -o mode=1777 tmpfs /dev/shm
# bats and others need these names
ln -sfn /proc/self/fd /dev/fd
ln -sfn fd/0 /dev/stdin
ln -sfn fd/1 /dev/stdout
ln -sfn fd/2 /dev/stderr
stty -F /dev/console -onlcr -echo 2>/dev/null

. /guest-run.sh
fail() {
	echo "ec-vm: $*" >/dev/console
	off
}

while read -r m; do
	insmod "/mod/$m" || fail "insmod $m failed"
done </mod/order

# So far all guests with the same devices are the same: run.sh keeps one that waits here.
case " $(cat /proc/cmdline) " in
*" ec_park "*)
	echo "ec-vm: parked" >/dev/console
	read -r now </dev/console
	date -u -s "@${now##*@}" >/dev/null ;;
esac

# cache=none for what the host reads: each write goes through at once.
mount -t 9p -o trans=virtio,version=9p2000.L,msize=262144,cache=none ctl /ctl || fail "no control directory"
. /ctl/env	# release, modules, mark, init, rw (number of --rw directories), ro (likewise)
mount -t 9p -o ro,trans=virtio,version=9p2000.L,msize=512000,cache=loose host /host || fail "cannot mount the host's root"
mount -t tmpfs -o mode=755 tmpfs /rw
mkdir /rw/upper /rw/work
mount -t overlay -o lowerdir=/host,upperdir=/rw/upper,workdir=/rw/work overlay /n || fail "cannot mount the overlay"

mkdir -p /n/proc /n/sys /n/dev /n/run /n/root "/n/lib/modules/$release"
mount --rbind /proc /n/proc
mount --rbind /sys /n/sys
mount --rbind /dev /n/dev
mount -t tmpfs -o mode=755 tmpfs /n/run
mkdir -p /n/run/lock
mount -t debugfs debugfs /n/sys/kernel/debug 2>/dev/null
mount -t tracefs tracefs /n/sys/kernel/tracing 2>/dev/null
i=0
while [ "$i" -lt "$ro" ]; do
	d=$(cat "/ctl/ro$i")
	mkdir -p "/n$d"
	mount -t 9p -o "ro,trans=virtio,version=9p2000.L,msize=512000,cache=loose" "ro$i" "/n$d" || fail "cannot mount $d"
	i=$((i + 1))
done
# a root with an init of its own has its own modules
[ -n "$init" ] || mount --bind "/n$modules" "/n/lib/modules/$release" ||
	fail "no module tree at $modules"
i=0
while [ "$i" -lt "$rw" ]; do
	d=$(cat "/ctl/rw$i")
	mkdir -p "/n$d"
	mount -t 9p -o "trans=virtio,version=9p2000.L,msize=512000,cache=none" "rw$i" "/n$d" || fail "cannot mount $d"
	i=$((i + 1))
done
hostname ec-vm
ifconfig lo 127.0.0.1 up
echo "/sbin/modprobe" >/proc/sys/kernel/modprobe

cp /ctl/cmd /n/run/ec-vm-cmd
if [ -n "$init" ]; then
	# a unit runs the command when all others have started
	v=/n/run/ec-vm units=/n/run/systemd/system
	mkdir -p $v/ctl $units
	cp /bin/busybox /guest-run.sh $v/
	printf '%s\n' "mark=$mark ctl=/run/ec-vm/ctl in_root= kept=/run" \
		'. /run/ec-vm/guest-run.sh' 'guest_run' >$v/run
	printf '%s\n' '[Unit]' 'Requires=ec-vm.service' 'Wants=multi-user.target' \
		>$units/ec-vm.target
	printf '%s\n' '[Unit]' 'After=multi-user.target' '[Service]' 'Type=oneshot' \
		'ExecStart=/run/ec-vm/busybox sh /run/ec-vm/run' >$units/ec-vm.service
	mount --move /ctl $v/ctl || fail "cannot move the control directory"
	exec switch_root /n "$init" --unit=ec-vm.target
	fail "cannot start $init"
fi
ctl=/ctl in_root="chroot /n" kept=/rw
guest_run
