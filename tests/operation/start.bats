#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Decisions of start and restart on a computer that files and stubs imitate: which modules get
# loaded, when, and for which devices. tests/system/operation.bats does it with real modules.

NIC=52:54:00:ec:00:01
LATE=52:54:00:ec:00:02
PCI=0000:01:00.0

# stub NAME LINE...: a program that ethercatctl finds first
stub() {
	printf '%s\n' '#!/bin/sh' "root=$root" "${@:2}" >"$root/bin/$1"
	chmod +x "$root/bin/$1"
}

setup() {
	local here=$BATS_TEST_DIRNAME/../../operation

	root=$BATS_TEST_TMPDIR/root
	mkdir -p "$root"/{bin,sbin,run,dev} "$root"/sys/{module,class/net} \
		"$root"/sys/bus/pci/{devices,drivers/ec_intel}
	sed "s,/\(sys\|run\|dev/E\|etc/mod\),$root&,g" "$here/ethercatctl" >"$root/sbin/ethercatctl"
	chmod +x "$root/sbin/ethercatctl"
	sed "s,/\(sys\|run\),$root&,g" "$here/devices.sh" >"$root/sbin/devices.sh"
	cp "$here/conf.sh" "$root/sbin"
	stub id 'echo 0'
	stub ip
	stub dmesg
	stub sleep
	stub nmcli 'echo "10 (unmanaged)"'
	# what udev does meanwhile, once
	stub udevadm '[ ! -e $root/udev ] || { mv $root/udev $root/done; . $root/done; }'
	stub rmmod 'rm -r $root/sys/module/$1' '[ $1 != ec_master ] || rm -f $root/dev/EtherCAT*'
	stub modprobe 'm=$root/sys/module/$1' \
		'[ ! -e $root/broken ] || ! grep -qx $1 $root/broken || { echo broken; exit 1; }' \
		'[ $1 = ec_master ] || [ -e $root/sys/module/ec_master ] || modprobe ec_master' \
		'mkdir -p $m/parameters' \
		'[ $1 = ec_master ] || exit 0' \
		'echo ${2#main_devices=} >$m/parameters/main_devices' \
		'for d in $(echo ${2#main_devices=} | tr , " "); do' \
		'	i=$((${i:--1} + 1))' '	ln -s /dev/null $root/dev/EtherCAT$i' 'done'
	stub ethercat 'case "$1 $2" in' '"device bind") ;;' '*) exit ;;' 'esac' \
		'[ ! -e $root/unknown ] || { echo "unknown chip"; exit 1; }' \
		'pci=$(readlink -f $root/sys/class/net/$3/device)' \
		'echo ec_intel >$pci/driver_override' \
		'touch $root/sys/bus/pci/drivers/ec_intel/${pci##*/}' 'rm -r $root/sys/class/net/$3'
	export PATH=$root/bin:$PATH
}

# nic NAME ADDRESS [PCI-ADDRESS DRIVER]: an interface
nic() {
	local dir=$root/sys/class/net/$1

	mkdir -p "$dir"
	echo "$2" >"$dir/address"
	echo 2 >"$dir/ifindex"
	[ $# = 4 ] || return 0
	mkdir -p "$root/sys/bus/pci/devices/$3"
	ln -s "$root/sys/bus/pci/devices/$3" "$dir/device"
	ln -s "../drivers/$4" "$root/sys/bus/pci/devices/$3/driver"
}

# reserve PCI-ADDRESS: as 'ethercat device bind --boot' leaves the card
reserve() {
	mkdir -p "$root/sys/bus/pci/devices/$1"
	echo ec_intel >"$root/sys/bus/pci/devices/$1/driver_override"
}

conf() { printf '%s\n' "$@" >"$BATS_TEST_TMPDIR/conf"; }
ctl() {
	run "$root/sbin/ethercatctl" -c "$BATS_TEST_TMPDIR/conf" "$1"
	echo "$output"
}
loaded_are() { [ "$(cd "$root/sys/module" && echo *)" = "$1" ]; }
main_is() { [ "$(cat "$root/sys/module/ec_master/parameters/main_devices")" = "$1" ]; }

@test "a udev rule that loads ec_intel while start begins is waited for" {
	reserve $PCI
	conf "MASTER0_DEVICE=$PCI"
	echo 'modprobe ec_intel' >"$root/udev"
	ctl start
	[ "$status" = 0 ]
	main_is $PCI
	loaded_are 'ec_intel ec_master'
}

@test "the rule of a card that appears while start waits for it does no harm" {
	conf "MASTER0_DEVICE=$PCI"
	stub sleep "mkdir -p \$root/sys/bus/pci/devices/$PCI" \
		"echo ec_intel >\$root/sys/bus/pci/devices/$PCI/driver_override" \
		'modprobe ec_intel'
	ctl start
	[ "$status" = 0 ]
	main_is $PCI
	loaded_are 'ec_intel ec_master'
}

@test "a MAC address that no interface has gets ec_generic also beside a card of ec_intel" {
	reserve $PCI
	conf "MASTER0_DEVICE=$LATE" "MASTER1_DEVICE=$PCI" 'DEVICE_MODULES=generic'
	ctl start
	[ "$status" = 0 ]
	[[ ${lines[0]} == *"conf:1: MASTER0_DEVICE=\"$LATE\": no interface has this address, and "* ]]
	[[ ${lines[0]} == *"ec_intel has too few cards after 10 s; the master waits for it, "* ]]
	[ "$(grep -c -e waits -e uses <<<"$output")" = 1 ]
	main_is "$LATE,$PCI"
	loaded_are 'ec_generic ec_intel ec_master'
}

@test "a MAC address that may be that of a card of ec_intel is accepted at once, for both drivers" {
	reserve $PCI
	conf "MASTER0_DEVICE=$LATE" 'DEVICE_MODULES=intel'
	stub sleep 'touch $root/slept'
	ctl start
	[ "$status" = 0 ]
	[ "$(grep -c -e waits -e uses <<<"$output")" = 0 ]
	[ ! -e "$root/slept" ]
	loaded_are 'ec_generic ec_intel ec_master'
}

@test "restart refuses a configuration without a master before it stops anything" {
	nic eth0 $NIC
	conf 'MASTER0_DEVICE=eth0'
	ctl start
	[ "$status" = 0 ]
	conf 'MASTER0_DEVICE=""'
	ctl restart
	[ "$status" = 1 ]
	[[ $output =~ "conf names no master: set MASTER0_DEVICE to a MAC address" ]]
	loaded_are 'ec_generic ec_master'
}

# systemd_stop JOB: what systemd calls for a job of this type
systemd_stop() {
	stub systemctl "[ \"\$*\" = 'list-jobs --no-legend ethercat.service' ] && echo '7 ethercat.service $1 running'"
	run sh -c 'SYSTEMD_EXEC_PID=$$ exec "$@"' sh "$root/sbin/ethercatctl" \
		-c "$BATS_TEST_TMPDIR/conf" stop
	echo "$output"
}

@test "restart, also that of systemctl, stops nothing when the configuration is wrong" {
	local line reason

	nic eth0 $NIC
	nic lo 00:00:00:00:00:00
	echo 772 >"$root/sys/class/net/lo/type"
	conf 'MASTER0_DEVICE=eth0'
	ctl start
	[ "$status" = 0 ]
	while IFS='|' read -r line reason; do
		conf "$line"
		ctl restart
		[ "$status" = 1 ]
		[[ ${lines[0]} == *"conf:1: MASTER0_DEVICE="*"$reason"* ]]
		systemd_stop restart
		[ "$status" = 1 ]
		[[ ${lines[0]} == *"conf:1: MASTER0_DEVICE="*"$reason"* ]]
		[ "${lines[1]}" = "ethercatctl: the masters run on; mend $BATS_TEST_TMPDIR/conf, then run 'ethercatctl restart'" ]
		loaded_are 'ec_generic ec_master'
		# systemd starts all the same
		ctl start
		[ "$status" = 1 ]
	done <<-'END'
	MASTER0_DEVICE=lo|the loopback interface has no cable
	MASTER0_DEVICE=eth9|no such interface
	MASTER0_DEVICE=a/b|is neither a MAC address
	END
	rm "$BATS_TEST_TMPDIR/conf"
	systemd_stop restart
	[ "$status" = 1 ]
	[[ ${lines[0]} == *"conf: it does not exist" ]]
	loaded_are 'ec_generic ec_master'
	ctl start
	[ "$status" = 6 ]
	# a stop needs no configuration
	systemd_stop stop
	[ "$status" = 0 ]
	loaded_are '*'
}

@test "systemctl restart with a configuration that is right stops the masters" {
	nic eth0 $NIC
	conf 'MASTER0_DEVICE=eth0'
	ctl start
	systemd_stop restart
	[ "$status" = 0 ]
	loaded_are '*'
	ctl start
	[ "$status" = 0 ]
}

@test "the unit runs start also without a configuration, which then fails" {
	run grep -E '^(Condition|Assert)' "$BATS_TEST_DIRNAME/../../operation/ethercat.service"
	[ "$status" = 1 ]
}

@test "an interface that can never work is refused at once" {
	nic lo 00:00:00:00:00:00
	echo 772 >"$root/sys/class/net/lo/type"
	conf "MASTER0_DEVICE=$LATE" 'MASTER1_DEVICE="lo"'
	stub sleep 'touch $root/slept'
	ctl start
	[ "$status" = 1 ]
	[[ $output == *'conf:2: MASTER1_DEVICE="lo": the loopback interface has no cable; '* ]]
	[ ! -e "$root/slept" ]
	loaded_are '*'
}

@test "an interface that ec_generic refuses fails the start with the reason of the kernel log" {
	nic eth0 $NIC
	conf "MASTER0_DEVICE=$NIC"
	stub ethercat '[ "$1" != master ] || echo "  Main: eth0 (waiting...)"'
	stub dmesg 'echo "[ 1.0] ec_generic: eth0: MTU 1400, need 1500"' 'echo "[ 2.0] other"'
	ctl start
	[ "$status" = 1 ]
	[ "$output" = "$BATS_TEST_TMPDIR/conf:1: MASTER0_DEVICE=\"$NIC\": the master cannot use eth0: MTU 1400, need 1500" ]
	loaded_are '*'
}

@test "ec_master that is loaded with an address in capitals is the same" {
	nic eth0 $NIC
	nic ETH1 $LATE
	conf "MASTER0_DEVICE=$NIC" 'MASTER1_DEVICE=ETH1'
	modprobe ec_master "main_devices=${NIC^^},ETH1"
	ctl start
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: ec_master is already loaded" ]
	loaded_are 'ec_generic ec_master'
	# names are as they are
	ctl stop
	modprobe ec_master "main_devices=$NIC,eth1"
	ctl start
	[ "$status" = 1 ]
}

@test "a start after one that failed, or after rmmod, loads the missing drivers" {
	nic eth0 $NIC
	conf 'MASTER0_DEVICE=eth0' 'DEVICE_MODULES=intel'
	modprobe ec_master main_devices=eth0
	echo ec_generic >"$root/broken"
	ctl start
	[ "$status" = 1 ]
	ctl start
	[ "$status" = 1 ]
	[ "${lines[-1]}" = "ethercatctl: cannot load ec_generic: broken" ]
	rm "$root/broken"
	ctl start
	[ "$status" = 0 ]
	loaded_are 'ec_generic ec_master'
	rmmod ec_generic
	ctl start
	[ "$status" = 0 ]
	loaded_are 'ec_generic ec_master'
	ctl stop
	loaded_are '*'
	[ ! -e "$root/run/ethercatctl" ]
}

@test "a second start leaves each card to the driver it has" {
	local name

	for name in eth0 $NIC; do
		nic eth0 $NIC $PCI e1000e
		conf "MASTER0_DEVICE=$name" 'DEVICE_MODULES=e1000e'
		ctl start
		[ "$status" = 0 ]
		loaded_are 'ec_intel ec_master'
		ctl start
		[ "$status" = 0 ]
		loaded_are 'ec_intel ec_master'
		main_is $NIC
		ctl stop
		rm -r "$root/sys/bus/pci/devices/$PCI"
		# ec_intel refuses the card: no second attempt while ec_generic has it
		nic eth0 $NIC $PCI e1000e
		touch "$root/unknown"
		ctl start
		[ "$status" = 0 ]
		[ "${lines[0]}" = "ethercatctl: eth0 uses ec_generic: unknown chip" ]
		rm "$root/unknown"
		ctl start
		[ "$status" = 0 ]
		[ -e "$root/sys/class/net/eth0" ]
		loaded_are 'ec_generic ec_intel ec_master'
		ctl stop
		# nor when the configuration names a native driver since
		conf "MASTER0_DEVICE=$name" 'DEVICE_MODULES=generic'
		ctl start
		conf "MASTER0_DEVICE=$name" 'DEVICE_MODULES=e1000e'
		ctl start
		[ "$status" = 0 ]
		[ -e "$root/sys/class/net/eth0" ]
		loaded_are 'ec_generic ec_master'
		ctl stop
		rm -r "$root/sys/class/net/eth0" "$root/sys/bus/pci/devices/$PCI"
	done
}

@test "ff:ff:ff:ff:ff:ff is the only free card, as its address" {
	nic eth0 $NIC 0000:00:01.0 r8169
	nic eth1 $LATE $PCI e1000e
	nic docker0 02:42:00:00:00:01
	conf 'MASTER0_DEVICE=FF:FF:FF:FF:FF:FF' 'DEVICE_MODULES="r8169"'
	ctl start
	[ "$status" = 0 ]
	main_is $NIC
	loaded_are 'ec_generic ec_master'
	# the network of this computer has its address now
	stub ip 'echo 2: eth0 inet 10.0.0.1'
	ctl start
	[ "$status" = 0 ]
	[[ ${lines[0]} == "ethercatctl: warning: eth0 has an IP address; no other program can"* ]]
	ctl stop
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ conf:1:.*"no card is free (with one of the drivers r8169" ]]
	loaded_are '*'
}

@test "ff:ff:ff:ff:ff:ff gets the native driver that DEVICE_MODULES names, also at a second start" {
	nic eth0 $NIC 0000:00:01.0 r8169
	nic eth1 $LATE $PCI e1000e
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff' 'DEVICE_MODULES="e1000e generic"'
	ctl start
	[ "$status" = 0 ]
	main_is $LATE
	loaded_are 'ec_intel ec_master'
	ctl start
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: ec_master is already loaded" ]
	loaded_are 'ec_intel ec_master'
}

@test "ff:ff:ff:ff:ff:ff that may be several cards is refused, unless UPDOWN_INTERFACES names one" {
	nic eth0 $NIC 0000:00:01.0 r8169
	nic eth1 $LATE $PCI e1000e
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff'
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ conf:1:.*"may be each of: eth0 eth1; write the MAC" ]]
	loaded_are '*'
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff' 'UPDOWN_INTERFACES=eth1'
	ctl start
	[ "$status" = 0 ]
	main_is $LATE
	ctl stop
	# a card that another master has, a port of a bridge
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff' 'MASTER1_DEVICE=eth0'
	ctl start
	[ "$status" = 0 ]
	main_is "$LATE,eth0"
	ctl stop
	touch "$root/sys/class/net/eth0/master"
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff'
	ctl start
	[ "$status" = 0 ]
	main_is $LATE
}

@test "ff:ff:ff:ff:ff:ff is the card that is reserved for a master, if there is one" {
	reserve $PCI
	nic eth0 $NIC 0000:00:01.0 e1000e
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff' 'DEVICE_MODULES=intel'
	ctl start
	[ "$status" = 0 ]
	main_is ff:ff:ff:ff:ff:ff
	loaded_are 'ec_intel ec_master'
	[ -e "$root/sys/class/net/eth0" ]
}

@test "ff:ff:ff:ff:ff:ff does not mean the simulated segment that is loaded" {
	nic eth0 $NIC $PCI e1000e
	modprobe ec_master main_devices=sim0
	conf 'MASTER0_DEVICE=ff:ff:ff:ff:ff:ff'
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ "is already loaded with main_devices=sim0" ]]
}

@test "a card that a running master has already stays with its driver" {
	nic eth0 $NIC $PCI e1000e
	conf "MASTER0_DEVICE=eth0" 'DEVICE_MODULES=e1000e'
	modprobe ec_master main_devices=$NIC
	modprobe ec_generic
	stub ethercat '[ "$1" != device ] || touch $root/bound' '[ "$1" = master ] || exit 0' \
		"echo '  Main: $NIC (attached)'"
	ctl start
	[ "$status" = 0 ]
	[ ! -e "$root/bound" ]
	loaded_are 'ec_generic ec_master'
}

@test "a start after a refused stop fails once, as systemctl restart makes it" {
	nic eth0 $NIC
	conf 'MASTER0_DEVICE=eth0'
	ctl start
	[ "$status" = 0 ]
	mkdir -p "$root/sys/module/ec_master/holders/app"
	ctl stop
	[ "$status" = 1 ]
	[[ $output =~ "module app" ]]
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ "the masters are still loaded, since the last stop was refused" ]]
	ctl start
	[ "$status" = 0 ]
}

@test "other devices than those of a file in modprobe.d are refused with its name" {
	nic eth0 $NIC
	conf 'MASTER0_DEVICE=eth0'
	modprobe ec_master main_devices=$LATE
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ "has eth0; run 'ethercatctl restart'" ]]
	mkdir -p "$root/etc/modprobe.d"
	echo "options ec_master main_devices=$LATE" >"$root/etc/modprobe.d/ethercat.conf"
	ctl start
	[ "$status" = 1 ]
	[[ $output =~ "has eth0; remove 'main_devices' from $root/etc/modprobe.d, then run" ]]
}

# with_bridge: a computer whose ip(8) makes a bridge and notes what it is asked
with_bridge() {
	stub ip 'echo "$*" >>$root/ip' 'd=$root/sys/class/net' 'case "$*" in' \
		'"link add name "*) mkdir -p $d/$4/brif $d/$4/bridge ;;' \
		'"link del "*) rm -r $d/$3 ;;' 'esac'
	conf 'MASTER0_DEVICE=sim0' 'EOE_BRIDGE=br7' 'EOE_BRIDGE_ADDRESS="10.5.0.1/16 fd05::1/64"'
	bridge=$root/sys/class/net/br7 known=$root/run/ethercatctl.bridge
}

@test "start makes the bridge before the modules are loaded, and stop removes it" {
	with_bridge
	stub ethercat '[ "$1 $2" != "eoe bridge" ] || { echo "$*" >>$root/ip; }'
	ctl start
	[ "$status" = 0 ]
	[ "$(cat "$root/ip")" = "link add name br7 type bridge
link set dev br7 up
addr replace 10.5.0.1/16 dev br7
addr replace fd05::1/64 dev br7
eoe bridge br7" ]
	# what the udev rule reads
	[ "$(head -n 1 "$known")" = EOE_BRIDGE=br7 ]
	ctl start
	[ "$status" = 0 ]
	[ "$(grep -c 'link add' "$root/ip")" = 1 ]
	ctl stop
	[ "$status" = 0 ]
	[ ! -e "$bridge" ]
	[ ! -e "$known" ]
}

@test "stop leaves a bridge that was there before, and one with ports of others" {
	with_bridge
	mkdir -p "$bridge/bridge"
	ctl start
	[ "$status" = 0 ]
	ctl stop
	[ -e "$bridge" ]
	[ ! -e "$known" ]
	rm -r "$bridge"
	ctl start
	touch "$bridge/brif/eth0"
	ctl stop
	[ "$status" = 0 ]
	[ -e "$bridge" ]
	[ ! -e "$known" ]
}

@test "a bridge that cannot be made is a warning; a start that fails leaves none" {
	with_bridge
	stub ip 'echo "Error: Unknown device type." >&2' 'exit 2'
	ctl start
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: warning: cannot make the bridge br7: Error: Unknown device type." ]
	[ ! -e "$known" ]
	ctl stop
	with_bridge
	echo ec_sim >"$root/broken"
	ctl start
	[ "$status" = 1 ]
	grep -q 'link add name br7' "$root/ip"
	[ ! -e "$bridge" ]
	[ ! -e "$known" ]
}
