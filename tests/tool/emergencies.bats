#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "emergencies: one line each, and a line about older ones" {
	golden emergencies emergencies
	[ "$(out emergencies -p0)" = None. ]
	run ethercat emergencies -p7
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat emergencies: the selection matches no slave" ]
	export FAKE_BUS=two
	[ "$(out emergencies -m0 -p2 | head -1)" = "   2  the last 16 of 70000" ]
	[ "$(out emergencies -m0 -p2 | wc -l)" = 17 ]
}

@test "emergencies --json" {
	of_slave='[s for s in d["masters"][0]["slaves"] if s["position"] == 2][0]'
	out emergencies -j | json "$of_slave['total'] == 2"
	out emergencies -j | json "[e['code'] for e in $of_slave['emergencies']] == [0x8130, 0]"
	out emergencies -j | json "$of_slave['emergencies'][0]['data_hex'] == '01020304ff'"
	out emergencies -j | json "$of_slave['emergencies'][0]['time_ns'] == 1764000000012345678"
}
