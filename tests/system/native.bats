# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --monitor --timeout 3600
# The native device at a network card; slaves at another one, joined by a wire.

load helpers

setup_file() {
	export EC_NIC=${EC_NIC:-e1000e}
	modprobe "$EC_NIC"
	pci0=$(pci eth0) pci1=$(pci eth1)
	export pci0 pci1
	start bench 22
}

teardown_file() { stop; }
teardown() {
	rmmod ec_mini 2>/dev/null || true
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	[ -z "${udevd:-}" ] || kill "$udevd" 2>/dev/null || true
	[ -e "/sys/bus/pci/devices/$pci0" ] || return 0
	is_bound "$pci0" ec_intel || driver "$pci0" ec_intel
	# the next case begins with a whole bus
	wait_for 120 all_slaves_are PREOP 22
}

demo() { LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" "$@"; }

# in the background, all slaves in OP
demo_runs() {
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000000 \
		>"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	app=$!
	wait_for 120 all_slaves_are OP 22
}

demo_ends() {
	kill -TERM $app
	wait $app || true
	app=
	wait_for 120 all_slaves_are PREOP 22
}

# monitor COMMAND: of QEMU
monitor() {
	local port

	port=$(grep -lx monitor /sys/class/virtio-ports/*/name)
	echo "$*" >"/dev/$(basename "${port%/name}")"
}

# slave_is POSITION STATE
slave_is() { [ "$(ethercat slaves -p "$1" | awk '{ print $3 }')" = "$2" ]; }
link_is() { [ "$(says Link)" = "$1" ]; }
waits() { [[ "$(says Main)" == *"(waiting...)" ]]; }
is_bound() { [ "$(basename "$(readlink "/sys/bus/pci/devices/$1/driver")")" = "$2" ]; }

@test "all slaves go to OP, no frame is lost" {
	is_bound "$pci0" ec_intel
	before=$(lost_frames)
	run demo --cycles 1000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}

# /proc/interrupts counts those for which there is a handler
@test "the card causes no interrupt" {
	local command status

	[ -z "$(ls "/sys/bus/pci/devices/$pci0/msi_irqs" 2>/dev/null)" ]
	read -r command status < <(od -An -t u2 -j 4 -N 4 "/sys/bus/pci/devices/$pci0/config")
	[ $((command & 1 << 10)) != 0 ]		# INTx is off,
	[ $((status & 1 << 3)) = 0 ]		# and not wanted
	run grep -E "eth0|$pci0|ec_intel" /proc/interrupts
	[ "$status" = 1 ]
}

@test "without a cycle the card is polled only while replies are awaited" {
	local t=/sys/kernel/tracing polls

	[ -e $t/events ] || mount -t tracefs tracefs $t
	echo 1 >$t/events/timer/hrtimer_expire_entry/enable
	: >$t/trace
	sleep 1
	echo 0 >$t/events/timer/hrtimer_expire_entry/enable
	polls=$(grep -c 'function=poll_idle' $t/trace)
	echo "# polls in a second, with 50 looks of the monitor: $polls" >&3
	[ "$polls" -ge 25 ]
	[ "$polls" -lt 500 ]
}

@test "the cable is unplugged and plugged in again" {
	monitor set_link nic0 off
	wait_for 60 link_is DOWN
	monitor set_link nic0 on
	wait_for 60 link_is UP
	wait_for 120 all_slaves_are PREOP 22
}

@test "the cable is unplugged and plugged in again while the application runs" {
	demo_runs
	monitor set_link nic0 off
	wait_for 60 link_is DOWN
	monitor set_link nic0 on
	wait_for 60 link_is UP
	wait_for 120 all_slaves_are OP 22
	demo_ends
}

@test "slaves that were cut off are back in OP 300 ms after the cable is whole" {
	demo_runs
	# 100 ms of link without loss, and 200 ms; three slaves, one after the other
	back_in_ms /sys/kernel/debug/ec_sim/eth1 'cut coupler3.0' 'heal coupler3.0' 300 22
	demo_ends
}

# devices KEY PCI: of the list
listed() { ethercat devices -j | gojq -r ".devices[] | select(.pci == \"$2\") | .$1"; }

# load_master and load_segment did what 'modprobe ec_intel' and 'ethercat device bind' do;
# now the commands
@test "ethercat device unbind and bind change the driver" {
	[ "$(listed driver "$pci0")" = ec_intel ]
	[ "$(listed used_by "$pci0")" = "Master0 main" ]
	[ "$(listed link_up "$pci0")" = true ]
	[ "$(listed speed_mbit_s "$pci0")" = 1000 ]
	[ "$(listed driver "$pci1")" = "$EC_NIC" ]
	[ "$(listed native "$pci1")" = true ]
	refused "$pci0 is used by Master0 main" device unbind "$pci0"
	ethercat device unbind --force "$pci0"
	wait_for 60 is_bound "$pci0" "$EC_NIC"
	wait_for 60 test -e /sys/class/net/eth0
	waits
	refused 'eth1 is used by the system \(up\)' device bind eth1
	ethercat device bind eth0
	is_bound "$pci0" ec_intel
	[ ! -e /sys/class/net/eth0 ]
	ethercat devices
	wait_for 120 all_slaves_are PREOP 22
}

@test "a PCI address chooses the card, a card without ec_intel goes back to its driver" {
	rmmod ec_sim ec_intel
	rmmod ec_master
	ethercat device unbind "$pci0"
	is_bound "$pci0" "$EC_NIC"
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices="$pci0"
	insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	ethercat device bind "${pci0#0000:}"
	[[ "$(ethercat master)" == *"Main: 52:54:00:ec:00:00 (attached)"* ]]
	load_segment bench
	wait_for 120 all_slaves_are PREOP 22
}

# udev as after the start of a computer, with our modules installed
start_udev() {
	local dir

	dir=/lib/modules/$(uname -r)/updates
	mkdir -p "$dir" /etc/modprobe.d
	cp "$EC_BUILD"/modules/master/ec_master.ko "$EC_BUILD"/modules/devices/intel/ec_intel.ko "$dir"
	depmod
	echo "options ec_master main_devices=$pci0" >/etc/modprobe.d/ethercat.conf
	# the names of the interfaces stay
	ln -s /dev/null /etc/udev/rules.d/80-net-setup-link.rules
	export SYSTEMD_IGNORE_CHROOT=1	# the guest's root is one
	/lib/systemd/systemd-udevd >"$BATS_TEST_TMPDIR/udevd" 2>&1 3>&- &
	udevd=$!
	wait_for 60 udevadm control --ping
}

# what the start of a computer does with the cards
start_event() {
	# udev notices a changed rule up to 3 s later
	udevadm control --reload
	udevadm trigger --action=add "/sys/bus/pci/devices/$pci0" "/sys/bus/pci/devices/$pci1"
	udevadm settle --timeout=120
}

has_no_driver() { [ ! -e "/sys/bus/pci/devices/$1/driver" ]; }
override() { cat "/sys/bus/pci/devices/$1/driver_override"; }

@test "udev gives card bound with --boot to ec_intel at each start, and no other" {
	local rule=/etc/udev/rules.d/59-ethercat-$pci0.rules

	ethercat device bind --boot "$pci0"
	[ "$(listed boot "$pci0") $(listed boot "$pci1")" = "true false" ]
	run ethercat device unbind --force "$pci0"
	echo "$output"
	[[ $output == *"$pci0 is bound again when the computer starts"* ]]
	is_bound "$pci0" "$EC_NIC"
	start_udev
	# the driver of the system was faster, as one of the initramfs is; ec_intel is loaded
	start_event
	is_bound "$pci0" ec_intel
	is_bound "$pci1" "$EC_NIC"
	[ "$(override "$pci1")" = "(null)" ]
	wait_for 120 all_slaves_are PREOP 22
	# again, and ec_intel is not loaded
	ethercat device unbind --force "$pci0"
	rmmod ec_sim ec_intel
	rmmod ec_master
	start_event
	is_bound "$pci0" ec_intel
	# no driver is loaded: udev loads both, the one of the system for the other card
	rmmod ec_intel
	rmmod ec_master "$EC_NIC"
	echo >"/sys/bus/pci/devices/$pci0/driver_override"
	has_no_driver "$pci0"
	has_no_driver "$pci1"
	start_event
	is_bound "$pci0" ec_intel
	is_bound "$pci1" "$EC_NIC"
	# without the other card it was the first
	ip link set eth0 name eth1
	load_segment bench
	wait_for 120 all_slaves_are PREOP 22
	# another card at this address
	ethercat device unbind --force "$pci0"
	sed -i 's/ATTR{device}=="0x..../ATTR{device}=="0xffff/' "$rule"
	start_event
	is_bound "$pci0" "$EC_NIC"
	run ethercat devices
	[[ $output == *"the card that is bound at boot is absent at $pci0"* ]]
	# and the way back
	ethercat device bind --boot "$pci0"
	ethercat device unbind --boot --force "$pci0"
	[ ! -e "$rule" ]
	start_event
	is_bound "$pci0" "$EC_NIC"
	kill $udevd
	cat "$BATS_TEST_TMPDIR/udevd"
	run grep -E "$pci0|59-ethercat" "$BATS_TEST_TMPDIR/udevd"
	[ "$status" = 1 ]
}

@test "no user but root changes the driver" {
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" \
		device unbind --force "$pci0"
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == *"Permission denied"* ]]
	is_bound "$pci0" ec_intel
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" \
		device bind --boot "$pci0"
	echo "$output"
	[ "$status" = 1 ]
	[ "$output" = "ethercat device: cannot write to /etc/udev/rules.d: Permission denied" ]
	[ ! -e "/etc/udev/rules.d/59-ethercat-$pci0.rules" ]
}

# sleeping locks of PREEMPT_RT would show there
@test "an application in the kernel runs its cycle in the interrupt of a timer" {
	insmod "$EC_BUILD/mini/ec_mini.ko" position=16 in_interrupt=1
	wait_for 60 slave_is 16 OP
	sleep 2
	dmesg | grep -q "ec_mini: working counter 3, complete"
	before=$(lost_frames)
	sleep 3
	[ "$(lost_frames)" = "$before" ]
	monitor set_link nic0 off
	wait_for 60 link_is DOWN
	monitor set_link nic0 on
	wait_for 120 slave_is 16 OP
	rmmod ec_mini
	wait_for 120 all_slaves_are PREOP 22
}

@test "the stock driver takes the card, and gives it back" {
	driver "$pci0" "$EC_NIC"
	wait_for 60 test -e /sys/class/net/eth0
	waits
	driver "$pci0" ec_intel
	wait_for 120 all_slaves_are PREOP 22
}

@test "the card is taken away while the application runs" {
	demo_runs
	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/unbind
	waits
	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/bind
	wait_for 120 all_slaves_are OP 22
	demo_ends
}

# bind_again TIMES
bind_again() {
	for ((i = 0; i < $1; i++)); do
		echo "$pci0" >/sys/bus/pci/drivers/ec_intel/unbind
		echo "$pci0" >/sys/bus/pci/drivers/ec_intel/bind
	done
	wait_for 120 all_slaves_are PREOP 22
}

# KiB that cannot be reclaimed: all of it without the pages that a CPU keeps free, and what
# kmalloc() has given out
used_kib() {
	sleep 1
	sync
	echo 3 >/proc/sys/vm/drop_caches
	awk '/^(MemFree|Buffers|Cached|SReclaimable):/ { used -= $2 }
		/^MemTotal:/ { used += $2 }
		$1 == "count:" { used -= $2 * 4 }
		/^kmalloc-[0-9]/ { allocated += $2 * $4 }
		END { print used, int(allocated / 1024) }' \
		/proc/meminfo /proc/zoneinfo /proc/slabinfo
}

@test "the card is bound and unbound many times, memory is stable" {
	times=${EC_BINDS:-40}
	bind_again 20
	read -r all allocated < <(used_kib)
	bind_again "$times"
	read -r all_now allocated_now < <(used_kib)
	echo "# memory after $times times: $((all_now - all)) KiB more," \
		"$((allocated_now - allocated)) KiB of it by kmalloc()" >&3
	# KASAN keeps freed memory back
	[[ $(uname -r) != *-kasan ]] || return 0
	# page fragments of the other card's driver come and go
	[ $((all_now - all)) -lt $((1024 + times)) ]
	[ $((allocated_now - allocated)) -lt $((times < 100 ? 64 : 128)) ]
}

@test "a reset of the function is survived" {
	# an 82540EM has none
	if [ "$EC_NIC" = e1000 ]; then
		[ ! -e "/sys/bus/pci/devices/$pci0/reset" ]
		return
	fi
	method=$(cat "/sys/bus/pci/devices/$pci0/reset_method")
	echo "# reset method: $method" >&3
	[ "$EC_NIC" != igb ] || [[ $method == *flr* ]]
	demo_runs
	echo 1 >"/sys/bus/pci/devices/$pci0/reset"
	wait_for 120 all_slaves_are OP 22
	demo_ends
}

@test "a card that sends nothing any more is started again" {
	demo_runs
	dmesg -C
	insmod "$EC_BUILD/mini/suspend/ec_hang.ko" function="$pci0"
	rmmod ec_hang
	wait_for 60 eval 'dmesg | grep -q "has sent no frame for 500 ms: started again"'
	wait_for 120 all_slaves_are OP 22
	demo_ends
	[ "$(dmesg | grep -c 'has sent no frame')" = 1 ]
}

@test "a suspend of the card is survived, idle and in OP" {
	suspend="$EC_BUILD/mini/suspend/ec_suspend.ko"
	state=D3
	[ "${EC_NIC:-}" != e1000 ] || state=D5	# unknown: QEMU's has no power management
	insmod "$suspend" function="$pci0"
	dmesg | grep -q "ec_intel $pci0: suspended (0), in $state"
	wait_for 60 link_is DOWN
	rmmod ec_suspend
	wait_for 120 all_slaves_are PREOP 22
	demo_runs
	insmod "$suspend" function="$pci0"
	wait_for 60 link_is DOWN
	rmmod ec_suspend
	wait_for 120 all_slaves_are OP 22
	demo_ends
	[ "$(dmesg | grep -c "ec_intel $pci0: resumed (0), in D0")" = 2 ]
}

# with an IOMMU, see iommu.bats; without one, this proves that dma.py would be noticed there
@test "planted DMA changes memory of a program unless an IOMMU stops it" {
	expected=changed
	[ ! -e "/sys/bus/pci/devices/$pci0/iommu_group" ] || expected=intact
	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/unbind
	for what in transmit receive; do
		run python3 "$BATS_TEST_DIRNAME/dma.py" "$pci0" $what eth1
		echo "$output"
		[ "$status" = 0 ]
		[ "${lines[-1]}" = $expected ]
	done
	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/bind
	wait_for 120 all_slaves_are PREOP 22
}

@test "a chip that is not in the list is refused with the reason" {
	local bridge=/sys/bus/pci/devices/0000:00:00.0

	dmesg -C
	echo ec_intel >$bridge/driver_override
	run sh -c 'echo 0000:00:00.0 >/sys/bus/pci/drivers/ec_intel/bind'
	[ "$status" != 0 ]
	dmesg | grep -q "ec_intel 0000:00:00.0: 8086:$(sed 's/0x//' $bridge/device) is not in the list of chips"
}

@test "the card disappears while the application runs" {
	demo_runs
	monitor device_del nic0
	wait_for 60 test ! -e "/sys/bus/pci/devices/$pci0"
	waits
	kill -0 $app
}
