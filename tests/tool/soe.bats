#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "soe_read: names, numbers, types" {
	[ "$(out soe_read -p2 S-0-15)" = "0x07 0x00" ]
	[ "$(out soe_read -p2 -t uint16 S-0-0015)" = "0x0007 7" ]
	[ "$(out soe_read -p2 -t uint16 1 P-0-150)" = "0x1234 4660" ]
	[ "$(out soe_read -p2 -t uint16 0x8096)" = "0x1234 4660" ]
	[ "$(out soe_read -p2 -t uint16 p-0-150)" = "0x1234 4660" ]
	# a text comes without its lengths, bytes with them
	[ "$(out soe_read -p2 -t string S-0-30)" = "SIM 1.0" ]
	[ "$(out soe_read -p2 S-0-30 | cut -d' ' -f1-5)" = "0x07 0x00 0x10 0x00 0x53" ]
	out soe_read -j -p2 -tuint16 1 P-0-150 |
		json 'd["value"] == 0x1234 and d["drive"] == 1 and d["idn"] == 0x8096'
	out soe_read -j -p2 -tuint16 1 P-0-150 | json 'd["name"] == "P-0-0150"'
	out soe_read -j -p2 S-0-15 |
		json 'd["data_hex"] == "0700" and d["size_bytes"] == 2 and d["position"] == 2'
}

@test "soe_write: values and texts" {
	[ "$(log_of soe_write -p2 -t uint16 S-0-15 3)" = "soe 2 0 0x000f 0300" ]
	[ "$(log_of soe_write -p2 -t int32 7 0x2f -2)" = "soe 2 7 0x002f feffffff" ]
	[ "$(log_of soe_write -p2 -t string P-0-160 abc)" = "soe 2 0 0x80a0 03000300616263" ]
	[ "$(log_of soe_write -p2 -t raw P-7-4095 "01 02")" = "soe 2 0 0xffff 0102" ]
	out soe_write -j -p2 -tuint16 P-0-150 1 |
		json 'd["idn"] == 0x8096 and d["size_bytes"] == 2 and d["drive"] == 0'
}

@test "SoE errors: code and text" {
	run ethercat soe_read -p2 S-0-92
	[ "$status" -eq 1 ]
	[[ $output == *"cannot read S-0-0092 of drive 0: 0x1001: there is no such IDN" ]]
	run ethercat soe_read -p2 2 S-0-15
	[[ $output == *": 0x800a: the drive number is not valid" ]]
	run ethercat soe_read -p2 S-0-100
	[[ $output == *": 0x7fff: unknown code" ]]
	run ethercat soe_write -p2 -tuint8 S-0-30 1
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write S-0-0030 of drive 0: 0x7004: the value can only be read" ]]
	run ethercat soe_read -p2 S-0-99
	[[ $output == *"did not answer in time" ]]
	err soe_read -j -p2 S-0-92 | json '"0x1001" in d["error"]["message"]'
}

@test "soe_read and soe_write: elements" {
	[ "$(out soe_read -p2 --element name S-0-15)" = "Telegram type!" ]
	[ "$(out soe_read -p2 --element maximum -t uint16 S-0-15)" = "0x0007 7" ]
	[ "$(out soe_read -p2 --element default S-0-15)" = "0x07 0x00" ]
	[ "$(out soe_read -p2 --element value -t uint16 S-0-15)" = "0x0007 7" ]
	[ "$(out soe_read -p2 --element attribute S-0-15)" = \
		"0x60010000  2 bytes, writable P--, format 0, 0 decimal places, factor 0" ]
	[ "$(out soe_read -p2 --element attribute -t uint32 S-0-15)" = "0x60010000 1610678272" ]
	[ "$(out soe_read -p2 --element state S-0-149)" = \
		"0x000f  as a procedure command: error" ]
	out soe_read -j -p2 --element attribute S-0-148 |
		json '(d["length"] == "command" and d["element"] == "attribute" and
			d["value"] == 0x90000)'
	out soe_read -j -p2 --element name S-0-148 |
		json 'd["value"] == "Homing" and d["name"] == "S-0-0148" and d["element"] == "name"'
	out soe_read -j -p2 S-0-15 | json '"element" not in d'
	[ "$(log_of soe_write -p2 -t uint16 --element maximum S-0-15 5)" = \
		"soe 2 0 0x000f element 0x20 0500" ]
	[ "$(log_of soe_write -p2 -t string --element name S-0-15 ab)" = \
		"soe 2 0 0x000f element 0x02 020002006162" ]
	run ethercat soe_read -p2 --element unit P-0-150
	[ "$status" -eq 1 ]
	[[ $output == *"cannot read the unit of P-0-0150 of drive 0: 0x2001: the IDN has no name" ]]
	run ethercat soe_read -p2 --element state S-0-151
	[ "$status" -eq 1 ]
	[[ $output == *"invalid data state of S-0-0151: 3 bytes, expected 2" ]]
	run ethercat soe_read -p2 --element size S-0-15
	[ "$status" -eq 1 ]
	[[ $output == *"invalid element 'size': expected state, name,"* ]]
}

@test "soe_list: names, elements, other lists" {
	golden soe_list soe_list -p2
	golden soe_list_v soe_list -p2 -v 0
	[ -z "$(out soe_list -p2 S-0-25)" ]
	out soe_list -j -p2 1 S-0-17 | json '[i["text"] for i in d["idns"]] == [
		"Telegram type!", "a?[2Jb??", "Homing", ""]'
	out soe_list -j -v -p2 | json '(d["idns"][0]["maximum_hex"] == "0700" and
		d["idns"][2]["unit"] == "s" and "state_hex" in d["idns"][2] and
		"minimum_hex" not in d["idns"][1])'
}

@test "soe_list refuses a list whose length is wrong, and other values" {
	run ethercat soe_list -p2 S-0-16
	[ "$status" -eq 1 ]
	[[ $output == *"S-0-0016 of drive 0 is no list of IDNs: 6 bytes, length 255" ]]
	run ethercat soe_list -p2 S-0-15
	[[ $output == *"is no list of IDNs: 2 bytes, length 7" ]]
	run ethercat soe_list -p2 2
	[ "$status" -eq 1 ]
	[[ $output == *"cannot read S-0-0017 of drive 2: 0x800a: the drive number is not valid" ]]
	for c in "soe_list -p2 8" "soe_list -p2 0 17" "soe_list -p2 S-0-4096" \
		"soe_list -p2 0 S-0-1 1"; do
		run ethercat $c
		echo "$c: $output"
		[ "$status" -eq 1 ]
	done
}

@test "soe_command: starts, waits, shows progress and takes the request back" {
	[ "$(log_of soe_command -p2 S-0-148)" = "S-0-0148  0x0003  executed
soe 2 0 0x0094 0300
soe 2 0 0x0094 0000" ]
	[ "$(err soe_command -v -p2 S-0-148 | sed 's/^ *[0-9.]* s  //')" = "0x0007  in process
0x0003  executed" ]
	out soe_command -j -p2 S-0-148 state | json 'd["state"] == 7 and d["text"] == "in process"'
	[ "$(log_of soe_command -p2 1 S-0-148 start)" = "S-0-0148  0x0007  in process
soe 2 1 0x0094 0300" ]
	[ "$(log_of soe_command -p2 S-0-148 cancel)" = "S-0-0148  0x0007  in process
soe 2 0 0x0094 0000" ]
}

@test "soe_command: failure, time limit and interrupt cancel it" {
	export FAKE_LOG=$BATS_TEST_TMPDIR/log
	run ethercat soe_command -p2 S-0-149
	[ "$status" -eq 1 ]
	[[ $output == *"S-0-0149 of drive 0 failed, data state 0x000f" ]]
	[ "$(tail -n1 "$FAKE_LOG")" = "soe 2 0 0x0095 0000" ]
	run ethercat soe_command --wait=0.2 -p2 S-0-150
	[ "$status" -eq 1 ]
	[[ $output == *"S-0-0150 of drive 0 not executed within 0.2 s, cancelled" ]]
	[ "$(tail -n1 "$FAKE_LOG")" = "soe 2 0 0x0096 0000" ]
	: >"$FAKE_LOG"
	"$HERE/build/fake/ethercat" soe_command -p2 S-0-150 2>"$BATS_TEST_TMPDIR/err" 3>&- &
	local pid=$!
	for ((i = 0; i < 100; i++)); do
		grep -q 0300 "$FAKE_LOG" && break
		sleep 0.1
	done
	kill -TERM $pid
	status=0
	wait $pid || status=$?
	[ "$status" -eq 1 ]
	grep -q "S-0-0150 of drive 0 cancelled after" "$BATS_TEST_TMPDIR/err"
	[ "$(tail -n1 "$FAKE_LOG")" = "soe 2 0 0x0096 0000" ]
}

@test "soe_command writes to no IDN that is no procedure command" {
	export FAKE_LOG=$BATS_TEST_TMPDIR/log
	: >"$FAKE_LOG"
	for a in run start cancel; do
		run ethercat soe_command -p2 S-0-15 $a
		[ "$status" -eq 1 ]
		[[ $output == *"S-0-0015 of drive 0 is no procedure command; S-0-0025 lists them" ]]
	done
	run ethercat soe_command -p2 0 S-0-148 stop
	[[ $output == *"invalid action 'stop': expected run, start, cancel or state"* ]]
	[ -z "$(grep soe "$FAKE_LOG")" ]
}

@test "wrong IDNs, drives and types" {
	for c in "soe_read -p2 S-8-1" "soe_read -p2 S-0-4096" "soe_read -p2 S-0-" "soe_read -p2 X-0-1" \
		"soe_read -p2 S-0-1x" "soe_read -p2 0x10000" "soe_read -p2 8 S-0-1" "soe_read" \
		"soe_write -p2 S-0-15 1" "soe_write -p2 -tuint16 S-0-15 65536" "soe_read -p2 -tnope S-0-15"; do
		run ethercat $c
		echo "$c: $output"
		[ "$status" -eq 1 ]
		[ "$(grep -c . <<<"$output")" -ge 1 ]
	done
	FAKE_READONLY=1 run ethercat soe_read -p2 S-0-15
	[ "$status" -eq 1 ]
	[[ $output == *"Permission denied"* ]]
}
