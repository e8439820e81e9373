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
stty -F /dev/console -onlcr 2>/dev/null

# A restart by sysrq skips the drivers' shutdown hooks: a module under test
# that hangs there must not keep the result from being seen. QEMU is started
# with -no-reboot and ends.
off() {
	sync
	echo b >/proc/sysrq-trigger
	sleep 60
}

fail() {
	echo "ec-vm: $*" >/dev/console
	off
}

while read -r m; do
	insmod "/mod/$m" || fail "insmod $m failed"
done </mod/order

# cache=none for what the host reads: each write goes through at once.
mount -t 9p -o trans=virtio,version=9p2000.L,msize=262144,cache=none ctl /ctl || fail "no control directory"
. /ctl/env	# release, modules, mark, rw (number of --rw directories), ro (likewise)
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
mount --bind "/n$modules" "/n/lib/modules/$release" || fail "no module tree at $modules"
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
cut -d' ' -f1 /proc/uptime >/ctl/started
# Everything in the log from here on belongs to the command.
echo "ec-vm: the command starts" >/dev/kmsg

# The command gets a pipe, not the console: programs then behave as in any
# other log (no colours, no line editing), and /dev/stdout can be reopened.
mkfifo /out
# A virtio port, because the emulated UART is slow and its interrupt gets
# switched off by an -rt kernel when much is written.
port=/dev/console
i=0
while [ "$i" -lt 40 ]; do
	for p in /dev/vport*p1; do [ ! -c "$p" ] || port=$p; done
	[ $port = /dev/console ] || break
	usleep 50000
	i=$((i + 1))
done
cat /out >$port &
exec 7>/out	# else the reader ends with the command, before the mark
env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
	HOME=/root USER=root LOGNAME=root SHELL=/bin/sh TERM=dumb LANG=C.UTF-8 EC_VM=1 \
	chroot /n /bin/sh /run/ec-vm-cmd </dev/null >/out 2>&1 7>&-
rc=$?

# All output must have reached the host before the restart throws away what is
# queued. run.sh writes the file when the mark comes by. Waiting for the end of
# the pipe would not do: a background process may hold it open.
echo "$mark" >/out &
i=0
while [ ! -s /ctl/drained ] && [ "$i" -lt 600 ]; do
	usleep 50000
	i=$((i + 1))
done

# The raw log, because the command may have cleared what dmesg shows. The read
# ends with an error when nothing is left. The path keeps busybox from taking
# its own dd, which cannot do this.
chroot /n /bin/dd if=/dev/kmsg bs=8192 iflag=nonblock 2>/dev/null >/rw/kmsg
cp /rw/kmsg /ctl/kmsg
echo $rc >/ctl/rc.tmp
mv /ctl/rc.tmp /ctl/rc
off
