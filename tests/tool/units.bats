#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

setup() {
	export FAKE_BUS=app FAKE_UNITS=1
}

@test "units and domains show units, their policy and state" {
	golden units units
	golden domains_units domains
	out units -j | json '[u["name"] for u in d["masters"][0]["units"]] == ["tool", "axes"]'
	out units -j >"$BATS_TEST_TMPDIR/json"
	axes() { json "(lambda u: $1)(d['masters'][0]['units'][1])" <"$BATS_TEST_TMPDIR/json"; }
	axes '(u["run"], u["outputs"]) == ("failed", "zero")'
	axes '(u["slaves_down"], u["faults"]) == (True, 2)'
	axes '(u["lease_cycles"], u["lease_holds"]) == (50, True)'
	axes '(u["repeats"], u["domains"]) == (2, [1])'
	out domains -j | json 'd["masters"][0]["domains"][1]["unit"] == "axes"'
}

@test "without units nothing is shown" {
	unset FAKE_UNITS
	[ -z "$(out units)" ]
	out units -j | json 'd["masters"][0]["units"] == []'
	out domains -j | json 'd["masters"][0]["domains"][1]["unit"] is None'
}

@test "units take takes authority, and refuses unknown names and words" {
	[ "$(log_of units take axes | tail -n 1)" = "unit 1 authority 0" ]
	run ethercat units take nothing
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 has no unit nothing; 'ethercat units' shows them"* ]]
	run ethercat units give axes
	[ "$status" -eq 1 ]
	[[ $output == *"'give': use no argument, or take and a name"* ]]
	run ethercat units take
	[ "$status" -eq 1 ]
	[[ $output == *"'take': use no argument"* ]]
	FAKE_READONLY=1 run ethercat units take axes
	[ "$status" -eq 1 ]
}
