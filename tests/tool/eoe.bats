#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "eoe shows network devices, their state and traffic" {
	export FAKE_EOE=1
	golden eoe eoe
	golden eoe_v eoe -v
	out eoe -j >"$BATS_TEST_TMPDIR/json"
	json '[i["state"] for i in d["masters"][0]["interfaces"]] == ["up", "wait", "lost", "down"]' \
		<"$BATS_TEST_TMPDIR/json"
	json 'd["masters"][0]["interfaces"][3]["interface"] is None' <"$BATS_TEST_TMPDIR/json"
	json 'd["masters"][0]["interfaces"][0]["tx_waiting"] == 3' <"$BATS_TEST_TMPDIR/json"
}

@test "without EoE there is a header alone" {
	[ "$(out eoe | wc -l)" = 2 ]
	out eoe -j | json 'd["masters"][0]["interfaces"] == []'
}

@test "eoe_addif and eoe_delif name one slave" {
	[ "$(log_of eoe_addif -p 1 | tail -n 1)" = "eoe wish 1" ]
	[ "$(log_of eoe_delif -p 1 | tail -n 1)" = "eoe wish 2" ]
	run ethercat eoe_delif
	[ "$status" -eq 1 ]
	run ethercat eoe_delif -p1 extra
	[ "$status" -eq 1 ]
}

@test "eoe bridge runs ip for each device, and refuses other names" {
	mkdir "$BATS_TEST_TMPDIR/bin"
	printf '#!/bin/sh\necho "ip $*" >>%s/calls\n' "$BATS_TEST_TMPDIR" >"$BATS_TEST_TMPDIR/bin/ip"
	chmod +x "$BATS_TEST_TMPDIR/bin/ip"
	export FAKE_EOE=1
	PATH=$BATS_TEST_TMPDIR/bin:$PATH run ethercat eoe bridge brx
	[ "$status" -eq 0 ]
	[ "$output" = "eoe0a1001, eoe0n1f3c, eoe0s7" ]
	diff - "$BATS_TEST_TMPDIR/calls" <<-END
	ip link add name brx type bridge
	ip link set dev brx up
	ip link set dev eoe0a1001 master brx up
	ip link set dev eoe0n1f3c master brx up
	ip link set dev eoe0s7 master brx up
	END
	printf '#!/bin/sh\nexit 2\n' >"$BATS_TEST_TMPDIR/bin/ip"
	PATH=$BATS_TEST_TMPDIR/bin:$PATH run ethercat eoe bridge brx
	[ "$status" -eq 1 ]
	[[ $output == *"'ip link' has failed"* ]]
	for name in '' a/b 'a b' more-than-15-chars; do
		run ethercat eoe bridge "$name"
		[ "$status" -eq 1 ]
		[[ $output == *"no name of a network device"* ]]
	done
	run ethercat eoe bridge
	[ "$status" -eq 1 ]
	[[ $output == *"use no argument, or bridge and a name"* ]]
}
