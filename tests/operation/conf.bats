#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Configurations as users have them, and their errors; tests/system/operation.bats starts them.

ctl() { "$BATS_TEST_DIRNAME/../../operation/ethercatctl" "$@"; }

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

@test "a backup device is refused with the reason" {
	run ctl -c "$BATS_TEST_DIRNAME/conf/backup.conf" check
	[ "$status" = 1 ]
	[ "$output" = "$BATS_TEST_DIRNAME/conf/backup.conf:4: MASTER0_BACKUP=\"52:54:00:ec:00:01\": this version has no cable redundancy; remove the value and connect the slaves to one port" ]
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

@test "an unknown verb prints the usage" {
	local words

	for words in '' reload 'start stop' '-c'; do
		# shellcheck disable=SC2086
		run ctl $words
		[ "$status" = 1 ]
		[[ $output == "usage: ethercatctl "* ]]
	done
	run ctl --help
	[ "$status" = 0 ]
}

@test "status without a master of this computer: dead, exit code 1" {
	printf 'MASTER0_DEVICE=eth0\n' >"$BATS_TEST_TMPDIR/conf"
	run env PATH=/usr/bin:/bin "$BATS_TEST_DIRNAME/../../operation/ethercatctl" \
		-c "$BATS_TEST_TMPDIR/conf" status
	[ "$status" = 1 ]
	[ "$output" = "Master0  dead" ]
	# without a master nothing runs
	: >"$BATS_TEST_TMPDIR/conf"
	run ctl -c "$BATS_TEST_TMPDIR/conf" status
	[ "$status" != 0 ]
	[[ $output == *"names no master: set MASTER0_DEVICE "* ]]
}
