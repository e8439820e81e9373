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
