#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "sdos: objects and entries but those refused or cut off" {
	golden sdos sdos -p2
	golden sdos_v sdos -v -p2
	[ "$(out sdos -q -p2)" = "$(grep ^SDO "$HERE/golden/sdos.txt")" ]
}

@test "sdos: names of the slave cannot reach the terminal" {
	[ "$(out sdos -v -p2 | grep -c '[^[:print:]]')" = 0 ]
	out sdos -j -p2 | json 'd["masters"][0]["slaves"][0]["objects"][1]["name"].startswith("a?")'
}

@test "sdos --json: values, abort codes, and a slave that leaves" {
	entries='d["masters"][0]["slaves"][0]["objects"][0]["entries"]'
	out sdos -j -v -p2 | json "[e['value']['value'] for e in $entries if 'value' in e] == [2]"
	out sdos -j -v -p2 |
		json "[e['abort_code'] for e in $entries if 'abort_code' in e] == [0x06020000]"
	out sdos -j -p2 | json '"value" not in str(d)'
	export FAKE_BUS=gone
	run ethercat sdos -p2
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 2: cannot read the object dictionary: "* ]]
	[[ $output == *": No such device: no slave at ring position 2"* ]]
}

@test "sdos: default, limits and unit are shown unless their sizes are inconsistent" {
	entries='[e for o in d["masters"][0]["slaves"][0]["objects"] for e in o["entries"]]'
	out sdos -j -v -p2 |
		json "[(e['default']['value'], e['minimum']['value'], e['maximum']['value'], e['unit']) for e in $entries if 'unit' in e] == [(8, -1, 10, 0xb503)]"
	out sdos -j -v -p2 | json "len([e for e in $entries if 'default' in e]) == 1"
	out sdos -j -p2 | json '"default" not in str(d)'
}

@test "sdos: a slave without dictionary" {
	run ethercat sdos -p0
	[ "$status" -eq 1 ]
	[[ $output == *"no selected slave has an object dictionary"* ]]
	run ethercat sdos -p2 0x1018
	[ "$status" -eq 1 ]
	[[ $output == *"unexpected argument '0x1018'"* ]]
}
