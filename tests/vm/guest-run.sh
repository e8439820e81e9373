# SPDX-License-Identifier: GPL-2.0-only
#
# Runs the command of run.sh in a guest, and ends the guest. Sourced by guest-init.sh, or in a
# unit of the guest's own init. Set before: ctl (control directory), in_root (command that
# enters the root), kept (folder for the log), mark, late (seconds after which it hangs, or 0).

# A restart by sysrq skips the drivers' shutdown hooks: a module under test
# that hangs there must not keep the result from being seen. QEMU is started
# with -no-reboot and ends.
off() {
	sync
	echo b >/proc/sysrq-trigger
	sleep 60
}

# Before the host ends a guest that hangs: programs, and what they and our threads wait for. With
# exact time one that hangs is idle, and its time flies: more than once.
stuck() {
	while sleep "$late"; do look; done
}

look() {
	{
		dmesg | tail -n 30
		for p in /proc/[0-9]*; do
			read -r comm <$p/comm || continue
			case $comm in
			EtherCAT*|ec_*) ;;
			*) [ "$(tr -d '\0' <$p/cmdline)" ] || continue ;;
			esac
			echo "${p#/proc/} $comm: $(tr '\0' ' ' <$p/cmdline | cut -c1-150)"
			cat $p/task/*/stack
		done
	} >$ctl/stuck.tmp 2>/dev/null
	mv $ctl/stuck.tmp $ctl/stuck
}

guest_run() {
	cut -d' ' -f1 /proc/uptime >$ctl/started
	# Everything in the log from here on belongs to the command.
	echo "ec-vm: the command starts" >/dev/kmsg

	# The command gets a pipe, not the console: programs then behave as in any
	# other log (no colours, no line editing), and /dev/stdout can be reopened.
	mkfifo $kept/out
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
	cat $kept/out >$port &
	exec 7>$kept/out	# else the reader ends with the command, before the mark
	# a child that ends would interrupt an open() of this shell
	if [ "${late:-0}" != 0 ]; then stuck & fi
	env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
		HOME=/root USER=root LOGNAME=root SHELL=/bin/sh TERM=dumb LANG=C.UTF-8 EC_VM=1 \
		$in_root /bin/sh /run/ec-vm-cmd </dev/null >$kept/out 2>&1 7>&-
	rc=$?

	# All output must have reached the host before the restart throws away what is
	# queued. run.sh writes the file when the mark comes by. Waiting for the end of
	# the pipe would not do: a background process may hold it open.
	echo "$mark" >$kept/out &
	i=0
	while [ ! -s $ctl/drained ] && [ "$i" -lt 600 ]; do
		usleep 50000
		i=$((i + 1))
	done

	# The raw log, because the command may have cleared what dmesg shows. The read
	# ends with an error when nothing is left. The path keeps busybox from taking
	# its own dd, which cannot do this.
	$in_root /bin/dd if=/dev/kmsg bs=8192 iflag=nonblock 2>/dev/null >$kept/kmsg
	cp $kept/kmsg $ctl/kmsg
	echo $rc >$ctl/rc.tmp
	mv $ctl/rc.tmp $ctl/rc
	off
}
