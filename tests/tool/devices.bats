#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Network cards in a tree of files that looks like sysfs.

load common

# card PCI VENDOR DEVICE DRIVER [INTERFACE MAC]
card() {
	local d=$FAKE_SYS/devices/pci0000:00/$1

	mkdir -p "$d" "$FAKE_SYS/bus/pci/drivers/$4"
	ln -s "$FAKE_SYS/bus/pci" "$d/subsystem"
	ln -s "$d" "$FAKE_SYS/bus/pci/devices/$1"
	echo 0x020000 >"$d/class"
	echo "$2" >"$d/vendor"
	echo "$3" >"$d/device"
	: >"$d/driver_override"
	: >"$FAKE_SYS/bus/pci/drivers/$4/unbind"
	ln -s "$FAKE_SYS/bus/pci/drivers/$4" "$d/driver"
	ln -s "$d" "$FAKE_SYS/bus/pci/drivers/$4/$1"
	[ -z "${5:-}" ] || interface "$5" "$6" "$d"
}

# interface NAME MAC DEVICE
interface() {
	local n=$3/net/$1

	mkdir -p "$n"
	ln -s "$3" "$n/device"
	ln -s "$n" "$FAKE_SYS/class/net/$1"
	echo "$2" >"$n/address"
	echo 1 >"$n/type"
	echo 0x1002 >"$n/flags"
}

setup() {
	export FAKE_SYS=$BATS_TEST_TMPDIR/sys FAKE_ETC=$BATS_TEST_TMPDIR/etc
	rules=$FAKE_ETC/udev/rules.d
	rule=$rules/59-ethercat-0000:01:00.0.rules
	mkdir -p "$rules"
	mkdir -p "$FAKE_SYS/class/net/lo" "$FAKE_SYS/bus/pci/devices" "$FAKE_SYS/bus/pci/drivers"
	echo 772 >"$FAKE_SYS/class/net/lo/type"
	: >"$FAKE_SYS/bus/pci/drivers_probe"
	card 0000:01:00.0 0x8086 0x10d3 e1000e enp1s0 02:00:00:00:00:01
	card 0000:02:00.0 0x8086 0x15b8 e1000e eth1 02:00:00:00:00:02
	card 0000:03:00.0 0x10ec 0x8168 r8169 eth2 02:00:00:00:00:03
	card 0000:04:00.0 0x8086 0x1533 igb
	# Master0 of fake_dev.c has it
	card 0000:06:00.0 0x8086 0x10d3 e1000e eth0 02:00:00:12:34:56
	mkdir -p "$FAKE_SYS/devices/usb/1-1"
	interface usb0 02:00:00:00:00:04 "$FAKE_SYS/devices/usb/1-1"
}

probed() { cat "$FAKE_SYS/bus/pci/drivers_probe"; }
override() { cat "$FAKE_SYS/bus/pci/devices/$1/driver_override"; }

native_driver() {
	mkdir "$FAKE_SYS/bus/pci/drivers/ec_intel"
}

@test "devices lists cards with driver, link and user" {
	echo 1 >"$FAKE_SYS/class/net/eth2/carrier"
	echo 100 >"$FAKE_SYS/class/net/eth2/speed"
	echo 0x1003 >"$FAKE_SYS/class/net/eth2/flags"
	golden devices devices
	run ethercat devices
	[ "$status" -eq 0 ]
}

@test "devices: JSON" {
	out devices -j | json 'len(d["devices"]) == 6'
	out devices -j | json 'd["devices"][0] == {
		"interface": "enp1s0", "pci": "0000:01:00.0", "mac": "02:00:00:00:00:01",
		"driver": "e1000e", "link_up": None, "speed_mbit_s": 0, "used_by": "",
		"native": True, "chip": "82574L", "tested": "QEMU", "why_not": "", "boot": False}'
}

@test "devices without a network card prints nothing" {
	rm -r "$FAKE_SYS"
	run ethercat devices
	[ "$status" -eq 0 ]
	[ -z "$output" ]
}

@test "bind gives the card to the native driver" {
	native_driver
	# what the kernel does
	ln -s x "$FAKE_SYS/bus/pci/drivers/ec_intel/0000:01:00.0"
	for name in enp1s0 02:00:00:00:00:01 0000:01:00.0 01:00.0; do
		: >"$FAKE_SYS/bus/pci/drivers_probe"
		ln -sfn "$FAKE_SYS" "$FAKE_SYS/bus/pci/drivers/ec_intel/0000:01:00.0"
		run ethercat device bind $name
		echo "$name: $output"
		[ "$status" -eq 0 ]
		[ "$(override 0000:01:00.0)" = ec_intel ]
		[ "$(cat "$FAKE_SYS/bus/pci/drivers/e1000e/unbind")" = 0000:01:00.0 ]
		[ "$(probed)" = 0000:01:00.0 ]
	done
}

@test "bind: a card that the driver refuses goes back" {
	native_driver
	run ethercat device bind enp1s0
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat device: ec_intel refused 0000:01:00.0; see 'dmesg'" ]
	# an empty line was written over it: any driver
	[ -z "$(head -n 1 "$FAKE_SYS/bus/pci/devices/0000:01:00.0/driver_override")" ]
}

refused() {
	run ethercat device "${@:2}"
	echo "$output"
	[ "$status" -eq 1 ]
	[[ $output == *"$1"* ]]
	[ -z "$(probed)" ]
	[ -z "$(override 0000:01:00.0)" ]
	[ ! -e "$rule" ]
	[ -z "$(find "$FAKE_ETC" -name '*.ethercat-*')" ]
}

@test "bind refuses cards without native driver, with the reason" {
	refused "modprobe ec_intel" bind enp1s0
	native_driver
	refused "eth1 has no native driver: its PHY is shared with the management engine" bind eth1
	refused "eth2 has no native driver: no native driver for 10ec:8168" bind eth2
	refused "usb0 has no native driver: not a PCI device" bind usb0
	refused "there is no network card eth9" bind eth9
	refused "use bind, unbind or use" bond enp1s0
	refused "missing argument" bind
}

@test "a card in use is refused, --force takes it" {
	native_driver
	echo 0x1003 >"$FAKE_SYS/class/net/enp1s0/flags"
	refused "enp1s0 is used by the system (up)" bind enp1s0
	ln -s "$FAKE_SYS/class/net/br0" "$FAKE_SYS/class/net/enp1s0/master"
	refused "enp1s0 is used by br0 (its port)" bind enp1s0
	refused "eth0 is used by Master0 main; unload ec_generic first" bind eth0
	ln -s "$FAKE_SYS" "$FAKE_SYS/bus/pci/drivers/ec_intel/0000:01:00.0"
	run ethercat device bind --force enp1s0
	[ "$status" -eq 0 ]
}

@test "use: the name by which the master knows the card" {
	card 0000:05:00.0 0x8086 0x10d3 ec_intel
	for name in enp1s0 02:00:00:00:00:01 sim1 ff:ff:ff:ff:ff:ff; do
		[ "$(log_of device use $name)" = "use 0 $name" ]
	done
	[ "$(log_of device use 05:00.0)" = "use 0 0000:05:00.0" ]
	[ "$(log_of device use 0000:05:00.0)" = "use 0 0000:05:00.0" ]
	refused "0000:01:00.0 has not its native driver; use its interface enp1s0" use 01:00.0
	rm "$FAKE_SYS/bus/pci/devices/0000:04:00.0/driver"
	refused "0000:04:00.0 has no driver; 'ethercat device bind 0000:04:00.0' first" use 04:00.0
	refused "there is no network card eth9" use eth9
	refused "/etc/modprobe.d" use --boot enp1s0
}

@test "use --backup: the device at the other end of a ring, or none" {
	card 0000:05:00.0 0x8086 0x10d3 ec_intel
	for name in enp1s0 sim0b; do
		[ "$(log_of device use --backup $name)" = "use backup 0 $name" ]
		[ "$(log_of device --backup use $name)" = "use backup 0 $name" ]
	done
	[ "$(log_of device use 05:00.0 --backup)" = "use backup 0 0000:05:00.0" ]
	[ "$(log_of device use --backup none)" = "use backup 0 " ]
	refused "there is no network card none" use none
	refused "there is no network card eth9" use --backup eth9
	refused "bind has no --backup" bind --backup enp1s0
	refused "unbind has no --backup" unbind --backup enp1s0
	refused "missing argument" use --backup
}

@test "unbind gives the card back" {
	refused "enp1s0 has no native driver" unbind enp1s0
	card 0000:05:00.0 0x8086 0x10d3 ec_intel
	run ethercat device unbind 05:00.0
	echo "$output"
	[ "$status" -eq 0 ]
	[ "$(probed)" = 0000:05:00.0 ]
	[ "$(cat "$FAKE_SYS/bus/pci/drivers/ec_intel/unbind")" = 0000:05:00.0 ]
	# without ec_intel it has no driver, and no other may have it
	rm "$FAKE_SYS/bus/pci/devices/0000:05:00.0/driver"
	: >"$FAKE_SYS/bus/pci/drivers_probe"
	echo ec_intel >"$FAKE_SYS/bus/pci/devices/0000:05:00.0/driver_override"
	run ethercat device unbind 05:00.0
	[ "$status" -eq 0 ]
	[ "$(probed)" = 0000:05:00.0 ]
	ln -s "$FAKE_SYS/bus/pci/drivers/ec_intel" "$FAKE_SYS/bus/pci/devices/0000:05:00.0/driver"
	out devices -j | json '[(x["native"], x["driver"]) for x in d["devices"]
		if x["pci"] == "0000:05:00.0"] == [(True, "ec_intel")]'
}

# the driver takes the card
accepts() {
	native_driver
	ln -s "$FAKE_SYS" "$FAKE_SYS/bus/pci/drivers/ec_intel/0000:01:00.0"
}

# what the kernel has done after bind: the card has the native driver
is_bound() {
	ln -sfn "$FAKE_SYS/bus/pci/drivers/ec_intel" "$FAKE_SYS/bus/pci/devices/0000:01:00.0/driver"
	: >"$FAKE_SYS/bus/pci/drivers/ec_intel/unbind"
	rm -rf "$FAKE_SYS/class/net/enp1s0" "$FAKE_SYS/devices/pci0000:00/0000:01:00.0/net"
	: >"$FAKE_SYS/bus/pci/drivers_probe"
}

is_silent() {
	run ethercat device "$@"
	echo "$output"
	[ "$status" -eq 0 ]
	[ -z "$output" ]
}

@test "bind --boot writes udev rule of this card" {
	accepts
	umask 077
	is_silent bind --boot enp1s0
	[ "$(override 0000:01:00.0)" = ec_intel ]
	diff -u "$HERE/golden/boot.rules.txt" "$rule"
	[ "$(stat -c %a "$rule")" = 644 ]
	[ "$(ls -A "$rules")" = 59-ethercat-0000:01:00.0.rules ]
}

@test "bind --boot keeps card that is bound already, and replaces its rule" {
	accepts
	is_bound
	echo "# Written by 'ethercat device bind --boot' of another version" >"$rule"
	run ethercat device bind --boot 01:00.0
	echo "$output"
	[ "$status" -eq 0 ]
	[ "$output" = "0000:01:00.0 has its native driver already" ]
	[ -z "$(probed)" ]
	diff -u "$HERE/golden/boot.rules.txt" "$rule"
	[ "$(ls -A "$rules")" = 59-ethercat-0000:01:00.0.rules ]
}

@test "bind --boot creates missing folder of rules, but not that of udev" {
	accepts
	rmdir "$rules"
	is_silent bind --boot enp1s0
	diff -u "$HERE/golden/boot.rules.txt" "$rule"
	: >"$FAKE_SYS/bus/pci/drivers_probe"
	: >"$FAKE_SYS/bus/pci/devices/0000:01:00.0/driver_override"
	rm -r "$FAKE_ETC/udev"
	refused "$FAKE_ETC/udev is missing: binding a card at boot needs udev" bind --boot enp1s0
}

@test "bind --boot neither binds nor writes where it must not" {
	refused "modprobe ec_intel" bind --boot enp1s0
	native_driver
	refused "eth1 has no native driver" bind --boot eth1
	refused "usb0 has no native driver: not a PCI device" bind --boot usb0
	refused "there is no network card 0000:09:00.0" bind --boot 0000:09:00.0
	[ -z "$(ls -A "$rules")" ]
	run ethercat device bind --boot enp1s0
	[ "$output" = "ethercat device: ec_intel refused 0000:01:00.0; see 'dmesg'" ]
	[ -z "$(ls -A "$rules")" ]
}

@test "rule that another program wrote stays" {
	accepts
	for how in file link pipe; do
		rm -f "$rule"
		case $how in
		file)	echo 'KERNEL=="eth0"' >"$rule" ;;
		link)	ln -s /dev/null "$rule" ;;
		pipe)	mkfifo "$rule" ;;
		esac
		for what in bind unbind; do
			run timeout 60 "$HERE/build/fake/ethercat" device $what --boot enp1s0
			echo "$output"
			[ "$status" -eq 1 ]
			[ "$output" = "ethercat device: $rule was not written by this tool; move it away first" ]
		done
		[ -z "$(probed)" ]
		[ -z "$(override 0000:01:00.0)" ]
		[ $how != file ] || [ "$(cat "$rule")" = 'KERNEL=="eth0"' ]
		[ $how != link ] || [ "$(readlink "$rule")" = /dev/null ]
		[ $how != pipe ] || [ -p "$rule" ]
	done
	out devices -j | json '[x["boot"] for x in d["devices"]] == [False] * 6'
}

# in_read_only_etc COMMAND...
in_read_only_etc() {
	local as_root=-r

	# in a chroot nobody may have a user name space of his own
	[ "$(id -u)" != 0 ] || as_root=
	# shellcheck disable=SC2086
	unshare $as_root -m sh -c 'mount --bind "$1" "$1" && mount -o remount,bind,ro "$1" || exit 9
		shift; "$@"' sh "$FAKE_ETC" "$HERE/build/fake/ethercat" "$@"
}

@test "read-only /etc refuses both directions, nothing is changed" {
	accepts
	export ASAN_OPTIONS=detect_leaks=0
	run in_read_only_etc device bind --boot enp1s0
	echo "$output"
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat device: cannot write to $rules: Read-only file system" ]
	[ -z "$(probed)" ]
	[ -z "$(override 0000:01:00.0)" ]
	[ -z "$(ls -A "$rules")" ]
	is_silent bind --boot enp1s0
	is_bound
	run in_read_only_etc device unbind --boot 01:00.0
	echo "$output"
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat device: cannot write to $rules: Read-only file system" ]
	[ -z "$(probed)" ]
	[ -e "$rule" ]
}

@test "unbind --boot gives card back and removes its rule" {
	accepts
	is_silent bind --boot enp1s0
	is_bound
	is_silent unbind --boot 01:00.0
	[ "$(probed)" = 0000:01:00.0 ]
	[ "$(cat "$FAKE_SYS/bus/pci/drivers/ec_intel/unbind")" = 0000:01:00.0 ]
	[ -z "$(ls -A "$rules")" ]
}

@test "unbind --boot removes rule of card with its stock driver, of another card, of absent card" {
	accepts
	is_silent bind --boot enp1s0
	: >"$FAKE_SYS/bus/pci/drivers_probe"
	is_silent unbind --boot enp1s0
	[ -z "$(ls -A "$rules")" ]
	[ -z "$(probed)" ]
	run ethercat device unbind --boot enp1s0
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat device: enp1s0 has no native driver and is not bound at boot" ]
	sed 's/0x10d3/0x1533/' "$HERE/golden/boot.rules.txt" >"$rule"
	is_silent unbind --boot 01:00.0
	[ -z "$(ls -A "$rules")" ]
	for name in 0000:09:0a.0 0000:09:0A.0 09:0a.0; do
		sed 's/0000:01:00.0/0000:09:0a.0/' "$HERE/golden/boot.rules.txt" \
			>"$rules/59-ethercat-0000:09:0a.0.rules"
		is_silent unbind --boot $name
		[ -z "$(ls -A "$rules")" ]
	done
	: >"$FAKE_SYS/bus/pci/devices/0000:01:00.0/driver_override"
	refused "there is no network card 0000:09:0a.0" unbind --boot 0000:09:0a.0
	refused "there is no network card eth9" unbind --boot eth9
	refused "there is no network card 9:a.0/../x" unbind --boot 9:a.0/../x
}

@test "unbind --boot leaves card in use and its rule" {
	accepts
	is_silent bind --boot enp1s0
	# Master0 of fake_dev.c has this one
	mv "$rule" "$rules/59-ethercat-0000:06:00.0.rules"
	sed -i 's/0000:01:00.0/0000:06:00.0/' "$rules/59-ethercat-0000:06:00.0.rules"
	ln -sfn "$FAKE_SYS/bus/pci/drivers/ec_intel" "$FAKE_SYS/bus/pci/devices/0000:06:00.0/driver"
	run ethercat device unbind --boot 0000:06:00.0
	echo "$output"
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat device: 0000:06:00.0 is used by Master0 main; use --force to take it" ]
	[ -e "$rules/59-ethercat-0000:06:00.0.rules" ]
}

@test "unbind without --boot names command that changes next start" {
	accepts
	is_silent bind --boot enp1s0
	is_bound
	run ethercat device unbind 01:00.0
	echo "$output"
	[ "$status" -eq 0 ]
	[ "$output" = "0000:01:00.0 is bound again when the computer starts; to change that: 'ethercat device unbind 0000:01:00.0 --boot'" ]
	[ -e "$rule" ]
}

@test "devices shows which cards are bound at boot, and rules without card" {
	accepts
	is_silent bind --boot enp1s0
	sed 's/0000:01:00.0/0000:09:00.0/' "$rule" >"$rules/59-ethercat-0000:09:00.0.rules"
	# another card at this address
	sed 's/0000:01:00.0/0000:04:00.0/' "$rule" >"$rules/59-ethercat-0000:04:00.0.rules"
	out devices -j | json '[x["pci"] for x in d["devices"] if x["boot"]] == ["0000:01:00.0"]'
	run out devices
	[[ ${lines[1]} == *"  yes: 82574L, run in QEMU only, at boot" ]]
	[[ ${lines[4]} == *"  yes: I210, never tested" ]]
	is_bound
	run out devices
	[[ ${lines[1]} == *"  in use: 82574L, run in QEMU only, at boot" ]]
	run err devices
	echo "$output"
	[ "${#lines[@]}" -eq 2 ]
	[ "${lines[0]}" = "the card that is bound at boot is absent at 0000:04:00.0; to forget it: 'ethercat device unbind 0000:04:00.0 --boot'" ]
	[[ ${lines[1]} == *" absent at 0000:09:00.0; "* ]]
}

@test "completion of device" {
	completion_of_fake
	[ "$(complete_line ethercat device "")" = "bind unbind use" ]
	[ "$(complete_line ethercat device bind en)" = enp1s0 ]
	[ "$(complete_line ethercat device unbind 0000:04)" = 0000:04:00.0 ]
	[[ " $(complete_line ethercat device bind eth1 --b) " == *" --boot "* ]]
	[ "$(complete_line ethercat device bind eth1 "")" = "" ]
}
