#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Configurations as users have them, and their errors; tests/system/operation.bats starts them.

# a computer with these interfaces
setup() {
	local here=$BATS_TEST_DIRNAME/../../operation name

	root=$BATS_TEST_TMPDIR/root
	mkdir -p "$root"/{sbin,sys/class/net}
	cp "$here"/{ethercatctl,conf.sh} "$root/sbin"
	sed "s,/sys/,$root&,g" "$here/devices.sh" >"$root/sbin/devices.sh"
	for name in eth0 eth1 veth0 veth1; do interface $name 1; done
	echo 52:54:00:ec:00:00 >"$root/sys/class/net/eth0/address"
	interface lo 772
}

interface() {	# interface NAME TYPE
	mkdir "$root/sys/class/net/$1"
	echo "$2" >"$root/sys/class/net/$1/type"
}

ctl() { "$root/sbin/ethercatctl" "$@"; }

# means FILE LINE...: what the configuration means, and nothing on stderr
means() {
	ctl -c "$BATS_TEST_DIRNAME/conf/$1.conf" check >"$BATS_TEST_TMPDIR/out" 2>&1
	printf '%s\n' "${@:2}" | diff - "$BATS_TEST_TMPDIR/out"
}

# refused TEXT MESSAGE...: a configuration of these lines; %s is its name
refused() {
	local rc=0 file=$BATS_TEST_TMPDIR/conf message

	printf '%b\n' "$1" >"$file"
	ctl -c "$file" check >"$BATS_TEST_TMPDIR/out" 2>"$BATS_TEST_TMPDIR/err" || rc=$?
	cat "$BATS_TEST_TMPDIR/out" "$BATS_TEST_TMPDIR/err"
	[ "$rc" = 1 ]
	[ ! -s "$BATS_TEST_TMPDIR/out" ]
	shift
	for message; do grep -qF -- "$file:$message" "$BATS_TEST_TMPDIR/err"; done
	[ "$(wc -l <"$BATS_TEST_TMPDIR/err")" = $# ]
}

# accepted TEXT DEVICE [MESSAGE]
accepted() {
	local file=$BATS_TEST_TMPDIR/conf

	printf '%b\n' "$1" >"$file"
	ctl -c "$file" check >"$BATS_TEST_TMPDIR/out" 2>"$BATS_TEST_TMPDIR/err"
	cat "$BATS_TEST_TMPDIR/out" "$BATS_TEST_TMPDIR/err"
	[ "$(head -n 1 "$BATS_TEST_TMPDIR/out")" = "Master0: $2" ]
	[ "$(cat "$BATS_TEST_TMPDIR/err")" = "${3:+$file:$3}" ]
}

@test "configurations of users have their usual meaning" {
	means mac 'Master0: 52:54:00:ec:00:00' 'Drivers: generic'
	means names 'Master0: eth0' 'Master1: veth0' 'Drivers: generic, interfaces: eth0 veth0'
	means native 'Master0: eth0' 'Drivers: e1000e'
	means sim 'Master0: sim0' 'Master1: sim1' 'Drivers: generic, segments: three,thin'
	local conf=$BATS_TEST_DIRNAME/conf/modules.conf
	means modules "$conf:8: EOE_AUTOCREATE has no effect in this version" \
		'Master0: 52:54:00:ec:00:00' 'Master1: veth0' \
		'Drivers: ccat r8169 e1000e igb generic, interfaces: veth1'
}

@test "the installed configuration is a simulated segment" {
	run ctl -c "$BATS_TEST_DIRNAME/../../operation/ethercat.conf" check
	[ "$status" = 0 ]
	[ "$output" = "$(printf 'Master0: sim0\nDrivers: generic, segments: bench')" ]
}

@test "a device that can never work, or is absent, is refused with the reason" {
	local name

	refused 'MASTER0_DEVICE="lo"' \
		"1: MASTER0_DEVICE=\"lo\": the loopback interface has no cable; 'ethercat devices' lists"
	interface can0 280
	refused 'MASTER0_DEVICE="can0"' \
		'1: MASTER0_DEVICE="can0": can0 is not an Ethernet interface;'
	mkdir "$root/sys/class/net/eth1/phy80211"
	refused 'MASTER0_DEVICE="eth1"' \
		'1: MASTER0_DEVICE="eth1": eth1 is a wireless interface, slaves need a cable;'
	mkdir "$root/sys/class/net/veth1/brport"
	ln -s ../br0 "$root/sys/class/net/veth1/master"
	refused 'MASTER0_DEVICE="veth1"' \
		"1: MASTER0_DEVICE=\"veth1\": veth1 is a port of br0; release it with 'ip link set veth1 nomaster'"
	# a bridge may have the address of its port
	mkdir "$root/sys/class/net/eth0/brport"
	accepted 'MASTER0_DEVICE="52:54:00:ec:00:00"' 52:54:00:ec:00:00
	rmdir "$root/sys/class/net/eth0/brport"
	echo 1400 >"$root/sys/class/net/veth0/mtu"
	refused 'MASTER0_DEVICE="veth0"' \
		"1: MASTER0_DEVICE=\"veth0\": veth0 has MTU 1400, frames need 1500; run 'ip link set veth0 mtu 1500'"
	refused 'MASTER0_DEVICE=sim0\nMASTER1_DEVICE="eth9"' \
		"2: MASTER1_DEVICE=\"eth9\": no such interface; 'ethercat devices' lists the cards"
	refused 'MASTER0_DEVICE="Eth1"' '1: MASTER0_DEVICE="Eth1": no such interface; write eth1'
	refused 'MASTER0_DEVICE="0000:99:00.0"' \
		'1: MASTER0_DEVICE="0000:99:00.0": no card at this PCI address;'
	refused 'MASTER0_DEVICE="ff:ff:ff:ff:ff:ff"' \
		'1: MASTER0_DEVICE="ff:ff:ff:ff:ff:ff": no card is free;'
	# the card may appear later
	name=52:54:00:ec:0f:01
	accepted "MASTER0_DEVICE=$name" $name \
		"1: MASTER0_DEVICE=\"$name\": no interface has this address yet; the master waits for it"
	accepted 'MASTER0_DEVICE=eth0\nUPDOWN_INTERFACES="eth0 eth7"' eth0 \
		"2: UPDOWN_INTERFACES: no interface eth7; 'ip link' lists the interfaces"
}

@test "a bridge of the slaves is accepted with addresses, and its mistakes are named" {
	local a one='MASTER0_DEVICE=eth0\n'

	accepted "${one}EOE_BRIDGE=br-eoe\nEOE_BRIDGE_ADDRESS='192.168.5.1/24 fd00::1/64'" eth0
	[ "$(tail -n 1 "$BATS_TEST_TMPDIR/out")" = \
		"Drivers: generic, bridge: br-eoe 192.168.5.1/24 fd00::1/64" ]
	mkdir -p "$root/sys/class/net/br7/bridge"
	accepted "${one}EOE_BRIDGE=br7" eth0
	refused "${one}EOE_BRIDGE=eth1" \
		'2: EOE_BRIDGE="eth1": this interface is no bridge; write another name'
	refused 'MASTER0_DEVICE=eth1\nEOE_BRIDGE=eth1' \
		'2: EOE_BRIDGE="eth1" is the device of MASTER0;'
	refused "${one}EOE_BRIDGE=a/b" '2: EOE_BRIDGE="a/b" is no name of a bridge:'
	refused "${one}EOE_BRIDGE='eoe%d'" '2: EOE_BRIDGE="eoe%d" is no name of a bridge:'
	refused "${one}eoe_bridge=br7" '2: unknown variable eoe_bridge; write EOE_BRIDGE'
	refused "${one}EOE_BRIDGE_ADDRESS=10.0.0.1/8" \
		'2: EOE_BRIDGE_ADDRESS="10.0.0.1/8" needs EOE_BRIDGE, the name of the bridge'
	for a in 192.168.5.1 192.168.5.1/33 192.168.5/24 192.168.5.256/24 192.168.5.1/0 \
		1.2.3.4.5/8 192.168..1/24 /24 a/24 fd00::1 fd00::1/129 192.168.5.1/24/8; do
		refused "${one}EOE_BRIDGE=br7\nEOE_BRIDGE_ADDRESS=$a" \
			"3: EOE_BRIDGE_ADDRESS: '$a' is no address with a prefix length, as"
	done
}

@test "another name of an interface is refused with the name to write" {
	printf '%s\n' '#!/bin/sh' 'echo "2: eth0@if3: <UP> mtu 1500"' >"$root/ip"
	chmod +x "$root/ip"
	PATH=$root:$PATH refused 'MASTER0_DEVICE="enp0s3"' \
		'1: MASTER0_DEVICE="enp0s3": no such interface; write eth0, which has this'
}

@test "an unknown segment is refused with the names" {
	local text='thin, three, bench, eoe, line100, line1000, and paths, which begin with /'

	refused 'MASTER0_DEVICE=sim0\n\nSIM_SEGMENT=bnech' "3: SIM_SEGMENT: no segment 'bnech'; there are $text"
	refused 'MASTER0_DEVICE=sim0\nSIM_SEGMENT=my/bus' "2: SIM_SEGMENT: no segment 'my/bus'; there"
	refused 'MASTER0_DEVICE=sim0\nSIM_SEGMENT=/no/bus' \
		'2: SIM_SEGMENT: no file /no/bus that can be read'
	echo slave >"$root/bus"
	accepted "MASTER0_DEVICE=sim0\nSIM_SEGMENT=$root/bus" sim0
	printf '%s\n' '#!/bin/sh' 'echo "$2:1: no name"' 'exit 1' >"$root/ethercat-sim"
	chmod +x "$root/ethercat-sim"
	PATH=$root:$PATH refused "MASTER0_DEVICE=sim0\nSIM_SEGMENT=$root/bus" \
		"2: SIM_SEGMENT: $root/bus:1: no name"
	# without effect
	accepted 'MASTER0_DEVICE=eth0\nSIM_SEGMENT=bnech' eth0
}

@test "typographic quotes and no-break spaces are named" {
	local text="has typographic quotes; write \" at both ends"

	refused 'MASTER0_DEVICE=\xe2\x80\x9ceth0\xe2\x80\x9d' "1: '“eth0”' $text"
	refused 'MASTER0_DEVICE=\xe2\x80\x9eeth0 eth1\xe2\x80\x9c' "1: '„eth0' $text"
	refused 'MASTER0_DEVICE="eth0\xe2\x80\x9d # card' "1: '\"eth0” # card' $text"
	refused 'DEVICE_MODULES="\xc2\xabgeneric\xc2\xbb"' "1: '«generic»' $text"
	refused 'MASTER0_DEVICE="eth0\xc2\xa0"' \
		"1: 'eth0"$'\xc2\xa0'"' has a no-break space; write a blank"
	refused 'MASTER0_DEVICE="eth0"\xc2\xa0# card' \
		"1: '"$'\xc2\xa0'"' has a no-break space; write a blank"
	refused '\xc2\xa0MASTER0_DEVICE="eth0"' \
		"1: '"$'\xc2\xa0'"MASTER0_DEVICE' has a no-break space; write a blank"
	accepted 'MASTER0_DEVICE="eth0" # the \xe2\x80\x9cleft\xe2\x80\x9d port' eth0
}

@test "a device in another notation is refused with the right one" {
	refused 'MASTER0_DEVICE="52-54-00-EC-00-00"' \
		'1: MASTER0_DEVICE="52-54-00-EC-00-00": write 52:54:00:EC:00:00'
	refused 'MASTER0_DEVICE="525400ec0000"' \
		'1: MASTER0_DEVICE="525400ec0000": write 52:54:00:ec:00:00'
	refused 'MASTER0_DEVICE="01:00.0"' '1: MASTER0_DEVICE="01:00.0": write 0000:01:00.0'
	refused 'MASTER0_DEVICE="SIM1"' '1: MASTER0_DEVICE="SIM1": write sim1'
	refused 'master0_device="eth0"\nexport SIM_SEGMENT=thin' \
		'1: unknown variable master0_device; write MASTER0_DEVICE' \
		"2: 'export SIM_SEGMENT': this file is not run as a shell script; write SIM_SEGMENT=..."
	refused 'MASTER0_DEVICE="sim"' '1: MASTER0_DEVICE="sim": write sim0'
	refused 'MASTER0_DEVICE="sim12"' '1: MASTER0_DEVICE="sim12": the simulator has sim0 to sim7'
	refused 'MASTER0_DEVICE="eth0,eth1"' \
		'1: MASTER0_DEVICE="eth0,eth1" is not one device; a second master has a variable of'
}

@test "ethercatctl, the installation guide and DKMS name the same kernels" {
	local top=$BATS_TEST_DIRNAME/../.. range

	range=$(sed -n 's/.*modules need Linux \([0-9.]* to [0-9.]*\),.*/\1/p' "$top/Documentation/install.rst")
	[ "$range" = "6.1 to 7.3" ]
	grep -qF "($range can have it)" "$top/operation/ethercatctl"
	grep -qF 'BUILD_EXCLUSIVE_KERNEL="^(6\.[1-9]|7\.[0-3]\.)"' "$top/debian/ethercat-dkms.dkms"
}

@test "a master has a backup device, with a main device and an end of its own" {
	local one='MASTER0_DEVICE=eth0\n' any=ff:ff:ff:ff:ff:ff mac=ec:00:00:00:00:02

	echo 52:54:00:ec:00:01 >"$root/sys/class/net/eth1/address"
	means backup 'Master0: 52:54:00:ec:00:00, backup 52:54:00:ec:00:01' 'Drivers: generic'
	accepted "${one}MASTER0_BACKUP=EC:00:00:00:00:02" "eth0, backup $mac" \
		"2: MASTER0_BACKUP=\"$mac\": no interface has this address yet; the master waits for it"
	accepted "${one}MASTER0_BACKUP=\"\"" eth0
	accepted "MASTER0_BACKUP=eth1\n$one" 'eth0, backup eth1'
	refused 'MASTER0_DEVICE=sim0\nMASTER1_BACKUP=eth1' \
		'2: MASTER1_BACKUP="eth1": there is no master 1; set MASTER1_DEVICE,'
	refused "${one}MASTER0_BACKUP=eth0" \
		'2: MASTER0_BACKUP="eth0" is also MASTER0_DEVICE; each end of a ring needs its own'
	refused "${one}MASTER0_BACKUP=eth1\nMASTER1_DEVICE=veth0\nMASTER1_BACKUP=eth1" \
		'4: MASTER1_BACKUP="eth1" is also MASTER0_BACKUP;'
	refused "${one}MASTER0_BACKUP=eth1\nMASTER1_DEVICE=eth1" \
		'3: MASTER1_DEVICE="eth1" is also MASTER0_BACKUP;'
	refused "${one}MASTER0_BACKUP=$any" \
		'2: MASTER0_BACKUP: with a backup device both ends of the ring'
	refused "${one}MASTER0_BACKUP=0000:0A:00" \
		'2: MASTER0_BACKUP="0000:0A:00" is neither a MAC address,'
	refused "${one}MASTER0_BACKUP=525400ec0001" \
		'2: MASTER0_BACKUP="525400ec0001": write 52:54:00:ec:00:01'
	refused "${one}MASTER0_BACKUP=lo" \
		'2: MASTER0_BACKUP="lo": the loopback interface has no cable;'
	refused "${one}MASTER0_BACKUP=eth9" '2: MASTER0_BACKUP="eth9": no such interface;'
	refused "${one}master0_backup=eth1" \
		'2: unknown variable master0_backup; write MASTER0_BACKUP'
	refused "${one}MASTER0_BACKUP=eth1\nEOE_BRIDGE=eth1" \
		'3: EOE_BRIDGE="eth1" is the device of MASTER0;'
}

@test "the second end of a simulated segment needs a ring" {
	local ring=$BATS_TEST_TMPDIR/ring.seg

	refused 'MASTER0_DEVICE=sim0\nMASTER0_BACKUP=sim0b' \
		"2: MASTER0_BACKUP=\"sim0b\": the segment bench is no ring; its description needs a line as"
	printf 'repeat 8 slave d drive\nwire d8.1 -> master.1\n' >"$ring"
	accepted "MASTER0_DEVICE=sim0\nMASTER0_BACKUP=sim0b\nSIM_SEGMENT=$ring" 'sim0, backup sim0b'
	accepted "MASTER0_DEVICE=eth0\nMASTER1_DEVICE=sim1\nMASTER1_BACKUP=sim1b\nSIM_SEGMENT=bench,$ring" \
		eth0
	refused 'MASTER0_DEVICE=sim0\nMASTER0_BACKUP=SIM0B' '2: MASTER0_BACKUP="SIM0B": write sim0b'
	refused "MASTER0_DEVICE=sim0\nMASTER0_BACKUP=sim1b\nSIM_SEGMENT=$ring" \
		'2: sim1 needs 2 segments, SIM_SEGMENT names 1'
}

@test "quotes, blanks, comments and line ends are those of a shell script" {
	accepted 'MASTER0_DEVICE=eth0' eth0
	accepted "\t MASTER0_DEVICE='eth0'  # card" eth0
	accepted 'MASTER0_DEVICE="eth0"#card\r' eth0
	accepted '\xef\xbb\xbfMASTER0_DEVICE="eth0"\r\nDEVICE_MODULES="generic"\r' eth0
	accepted 'MASTER0_DEVICE="eth0"\nMASTER0_DEVICE="eth0"' eth0
	accepted 'MASTER0_DEVICE="eth0"\nMASTER0_DEVICE="eth1"' eth1 \
		'2: MASTER0_DEVICE replaces the value "eth0" of line 1'
	printf 'MASTER0_DEVICE=eth0' >"$BATS_TEST_TMPDIR/conf"
	[ "$(ctl -c "$BATS_TEST_TMPDIR/conf" check | head -n 1)" = 'Master0: eth0' ]
}

@test "a configuration without a master is refused as start does" {
	local lines

	for lines in '' 'MASTER0_DEVICE=""' 'MASTER1_DEVICE=eth0'; do
		printf '%s\n' "$lines" >"$BATS_TEST_TMPDIR/conf"
		run ctl -c "$BATS_TEST_TMPDIR/conf" check
		[ "$status" = 1 ]
		[[ $output =~ "conf names no master: set MASTER0_DEVICE to a MAC address" ]]
	done
}

@test "a line that a shell would run is refused and not run" {
	local mark=$BATS_TEST_TMPDIR/mark

	refused "MASTER0_DEVICE=\"\$(touch $mark)\"" '1: '
	refused "MASTER0_DEVICE=\`touch $mark\`" "1: "
	refused "MASTER0_DEVICE=eth0; touch $mark" "1: 'touch $mark' follows the value"
	refused "MASTER0_DEVICE=eth0;touch" "1: 'eth0;touch': this file is not run as a shell script"
	refused "touch $mark" "1: 'touch $mark' is no line NAME=\"value\""
	refused 'MASTER0_DEVICE="$NIC"' "1: '\$NIC': this file is not run as a shell script; write the value itself"
	refused 'MASTER0[$(id)]_DEVICE=eth0' '1: '
	[ ! -e "$mark" ]
}

@test "an error names its line and the remedy" {
	refused '# x\nMASTER0_DEVICE = "eth0"' \
		"2: 'MASTER0_DEVICE ' is no name of a variable; write NAME=\"value\" without blanks beside ="
	refused 'MASTER0_DEVICE="eth0' '1: the closing quote is missing'
	refused 'MASTER0_DEVICE=eth0 eth1' "1: 'eth1' follows the value"
	refused 'MASTER0_DEVICE="00:11:22:33:44"' \
		'1: MASTER0_DEVICE="00:11:22:33:44" is neither a MAC'
	refused 'MASTER0_DEVICE="00:00:00:00:00:00"' \
		'1: MASTER0_DEVICE="00:00:00:00:00:00": no card'
	refused 'MASTER0_DEVICE="01:00:5e:00:00:01"' \
		'1: MASTER0_DEVICE="01:00:5e:00:00:01" is a multicast'
	refused 'MASTER0_DEVICE="a/b"' '1: MASTER0_DEVICE="a/b" is neither'
	refused 'MASTER32_DEVICE="eth0"\nMASTERx_BACKUP=""' '1: MASTER32_DEVICE: the masters are' \
		'2: MASTERx_BACKUP: the masters are'
	refused 'MASTER0_DEVICE=eth0\nMASTER1_DEVICE=eth0' \
		'2: MASTER1_DEVICE="eth0" is the device of MASTER0'
	refused 'DEVICE_MODULES="generic,e1000"' \
		'1: DEVICE_MODULES="generic,e1000": separate names by blanks'
	refused 'DEVICE_MODULES="generic e1000x"' "1: DEVICE_MODULES: unknown driver 'e1000x'"
	refused 'UPDOWN_INTERFACES="eth0,eth1"' "1: UPDOWN_INTERFACES: 'eth0,eth1' is not the name"
	refused 'MODPROBE_FLAGS="debug_level=1"' "1: MODPROBE_FLAGS: 'debug_level=1' is not an option"
	refused 'MASTER0_DEVICE=sim1\nSIM_SEGMENT=bench' \
		'1: sim1 needs 2 segments, SIM_SEGMENT names 1'
	refused 'SIM_SEGMENT="bench, thin"' '1: SIM_SEGMENT="bench, thin": names or paths separated'
}

@test "variables without effect are reported" {
	accepted 'MASTER0_DEVICE=eth0\nMASTR1_DEVICE=eth1' eth0 \
		"2: unknown variable MASTR1_DEVICE has no effect; see 'man ethercatctl'"
	accepted 'MASTER0_DEVICE=eth0\nMASTER2_DEVICE=eth1' eth0 \
		'2: MASTER2_DEVICE has no effect, since MASTER1_DEVICE is empty'
	accepted 'MASTER0_DEVICE=eth0\nEOE_INTERFACES="eoe0s1"' eth0 \
		'2: EOE_INTERFACES has no effect in this version'
}

@test "a configuration that cannot be read: exit code 6" {
	run ctl -c "$BATS_TEST_TMPDIR/none" status
	[ "$status" = 6 ]
	[ "$output" = "ethercatctl: cannot read the configuration $BATS_TEST_TMPDIR/none: it does not exist" ]
	run ctl -c "$BATS_TEST_TMPDIR" check
	[ "$status" = 6 ]
}

@test "an unknown command is named before the usage" {
	local words first

	while IFS='|' read -r words first; do
		# shellcheck disable=SC2086
		run ctl $words
		[ "$status" = 1 ]
		[[ ${lines[0]} == "$first"* ]]
		[[ $output == *"usage: ethercatctl "* ]]
	done <<-'END'
	|usage: ethercatctl
	reload|ethercatctl: unknown command 'reload'
	start stop|ethercatctl: unexpected argument 'stop'
	--force stop|ethercatctl: unknown option '--force'
	stop -c|ethercatctl: option -c needs a file
	-c file|usage: ethercatctl
	END
	printf 'MASTER0_DEVICE=eth0\n' >"$BATS_TEST_TMPDIR/conf"
	[ "$(ctl check -c "$BATS_TEST_TMPDIR/conf" | head -n 1)" = 'Master0: eth0' ]
	run ctl --help
	[ "$status" = 0 ]
}

@test "status without a master of this computer: dead, exit code 1" {
	printf 'MASTER0_DEVICE=eth0\n' >"$BATS_TEST_TMPDIR/conf"
	run env PATH=/usr/bin:/bin "$root/sbin/ethercatctl" \
		-c "$BATS_TEST_TMPDIR/conf" status
	[ "$status" = 1 ]
	[ "$output" = "Master0  dead" ]
	# without a master nothing runs
	: >"$BATS_TEST_TMPDIR/conf"
	run ctl -c "$BATS_TEST_TMPDIR/conf" status
	[ "$status" != 0 ]
	[[ $output == *"names no master: set MASTER0_DEVICE "* ]]
}
