#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

setup() { export FAKE_SII=1; }

@test "pdos --coe shows the PDOs of the slave beside those of its SII" {
	golden pdos_coe pdos --coe
	[ "$(out pdos --coe -q -p2)" = "$(grep -v 'PDO entry\|===' "$HERE/golden/pdos_coe.txt")" ]
	pdos='[p for m in d["masters"][0]["slaves"][0]["sync_managers"] for p in m["pdos"]]'
	out pdos --coe -j |
		json "[p['sii'] for p in $pdos] == ['same', 'not_assigned', 'only', 'other_mapping', 'unknown']"
	out pdos --coe -j | json "$pdos[1]['entries'][1]['size_bits'] == 8"
}

@test "pdos --coe: an assigned PDO that does not exist, and an entry that is not in use" {
	[[ $(FAKE_FIRST_TX=0x1a77 out pdos --coe -p2) == \
		*'TxPDO 0x1a77 "", the slave does not have it'* ]]
	[[ $(FAKE_FIRST_TX=0 out pdos --coe -p2) == *'TxPDO 0x0000 "", entry not in use'* ]]
}

@test "pdos --coe: without SII, without CoE, with wrong lists" {
	unset FAKE_SII
	[ "$(out pdos --coe -p2 | grep -c 'not in the SII$')" = 4 ]
	run ethercat pdos --coe -p0
	[ "$status" -eq 1 ]
	[[ $output == *"Master0: no selected slave has CoE" ]]
	for object in 0x1c12 0x1600 0x1a00; do
		FAKE_COUNT_OF=$object run ethercat pdos --coe -p2
		[ "$status" -eq 1 ]
		[[ $output == *"$object:00 is 4294967295, expected at most 255"* ]]
	done
	run ethercat pdos --coe -s etherlab
	[[ $output == *"--coe and --skin exclude each other"* ]]
}
