#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "every command gives one valid object" {
	export FAKE_BUS=app
	for c in version master slaves "slaves -v" "slaves -p7" pdos "pdos -q" "pdos -s etherlab" \
		"upload -p2 0x1018 1" "upload -p2 0x1008 0" "upload -p2 0x1018" \
		"upload -p2 -tfloat 0x2000 0" "download -p2 -tint8 0x6060 0 1" states \
		"states OP -p0 --wait" config "config -v" domains "domains -v" data cstruct \
		"sii_read -p2" "sii_read -v -p2" "reg_read -p2 0x130 2" \
		"reg_write -p2 -tuint8 0x40 1" rescan "debug 1" graph "graph dc" "graph crc" crc \
		"graph --tree" "graph crc --tree" dc "dc -v" "crc --watch 0.1" \
		"crc reset" "latch -p2" "datagram BRD 0 2" \
		"datagram BWR 0 -t uint8 1" "latch -p2 single" cycle "cycle -v" "cycle -r" "ip -p2" "ip -p2 name a"; do
		out $c --json | json 'isinstance(d, dict)' || { echo "$c"; return 1; }
	done
}

@test "a number has the same key in every command" {
	local c

	export FAKE_BUS=app
	# the ring position of the slave that an object describes
	for c in "upload -p2 0x1018 1" "download -p2 -tint8 0x6060 0 1" "reg_read -p2 0x130 2" \
		"reg_write -p2 -tuint8 0x40 1" "reg_rdwr -p2 -tuint8 0x40 1" "sii_read -p2" \
		"latch -p2" "ip -p2" "soe_read -p2 S-0-15" "foe_read -p2 fw"; do
		out $c -j | json 'd["position"] == 2 and "slave" not in d' || { echo "$c"; return 1; }
	done
	out config -j | json '[c["position"] for c in d["masters"][0]["configs"]] == [None, 1]'
	# slaves from the one with the alias on
	out config -j | json '[(c["alias"], c["relative_position"])
		for c in d["masters"][0]["configs"]] == [(0, 2), (1001, 0)]'
	out domains -v -j | json 'all("relative_position" in f and "position" not in f
		for m in d["masters"] for x in m["domains"] for f in x["fmmus"])'
	out cstruct -j | json 'all("sync_managers" in s for s in d["masters"][0]["slaves"])'
	FAKE_BUS=dc out dc -j | json 'all("dc_delay_ns" in s and "dc_offset_ns" in s
		for s in d["masters"][0]["slaves"])'
}

@test "JSON keys are unchanged" {
	out slaves -j | json 'd["masters"][0]["slaves"][2]["name"] == "EL7201 servo terminal"'
	out slaves -j | json 'd["masters"][0]["slaves"][2]["al_status_code"] == 0x1d'
	out slaves -j | json 'd["masters"][0]["slaves"][1]["ports"][1]["receive_time_diff_ns"] == -10'
	out slaves -j | json '"8 bytes" in d["masters"][0]["slaves"][2]["cause"]'
	out slaves -j | json 'd["masters"][0]["slaves"][2]["mailboxes"]["protocols"] == ["CoE", "FoE"]'
	out master -j | json 'd["masters"][0]["phase"] == "idle"'
	FAKE_BUS=detached out master -j | json 'd["masters"][0]["session"] == "detached"'
	FAKE_BUS=detached out release -j | json 'd["master"] == 0'
	out master -j | json 'd["masters"][0]["common"]["lost_frames"] == 2'
	out master -j | json 'd["masters"][0]["dc"]["cycle_lock"] is None'
	FAKE_BUS=app out master -j | json 'd["masters"][0]["dc"]["cycle_lock"] == "locked"'
	FAKE_BUS=app out master -j | json 'd["masters"][0]["dc"]["phase_error_ns"] == -12 and d["masters"][0]["dc"]["rate_ppb"] == -8700'
	FAKE_BUS=app out master | grep -q 'Cycle lock:        locked, phase error -12 ns, rate -8700 ppb, lock losses 1'
	out latch -j -p2 | json 'd["latches"][0]["rising_ns"] == 0x15 and d["latches"][0]["falling_ns"] is None'
	out latch -j -p2 | json 'd["latches"][1]["owner"] == "slave" and not d["latches"][1]["single"]'
	[ "$(out latch -p2 | head -n 1)" = "Latch 0: high, rising 21 ns, falling none; last edge counts" ]
	[ "$(out latch -p2 | tail -n 1)" = "Latch 1: low, rising none, falling none; controlled by the slave" ]
	out upload -j -p2 0x1018 1 | json 'd["value"] == 2 and d["data_hex"] == "02000000"'
	out upload -j -p2 -tstring 0x1008 0 | json 'd["value"] == "EL7201"'
	out pdos -j | json 'd["masters"][0]["slaves"][2]["sync_managers"][3]["pdos"][0]["entries"][0]["size_bits"] == 32'
	FAKE_BUS=app out config -j | json 'd["masters"][0]["configs"][0]["position"] is None'
	FAKE_BUS=app out config -j | json '"no slave at ring" in d["masters"][0]["configs"][0]["not_in_op"]'
	FAKE_BUS=app out config -j | json 'd["masters"][0]["configs"][1]["not_in_op"] is None'
	FAKE_BUS=app out config -j | json 'd["masters"][0]["configs"][0]["dc"]["sync"][0]["shift_ns"] == -500'
	FAKE_BUS=app out domains -j | json 'd["masters"][0]["domains"][1]["expected_working_counter"] == 3'
	state='d["masters"][0]["domains"][1]["working_counter_state"]'
	FAKE_BUS=app out domains -j | json "$state == 'complete'"
	FAKE_BUS=app FAKE_WHY=cancelled out domains -j | json "$state == 'incomplete'"
	FAKE_BUS=app out domains -j | json 'd["masters"][0]["domains"][1]["options"] == ["overlap", "own_frame"]'
	FAKE_BUS=app out domains -j | json 'd["masters"][0]["domains"][0]["options"] == []'
	FAKE_BUS=app out domains -j | json '[x["stale"] for x in d["masters"][0]["domains"]] == [False, True]'
	FAKE_BUS=app out domains -j | json 'd["masters"][0]["domains"][1]["age_sends"] == 3'
	out master -j | json 'd["masters"][0]["max_acyclic_frames"] == 64'
	out master -j | json 'd["masters"][0]["sii_bytes"] == 3072'
	FAKE_BUS=app out domains -j | json 'd["masters"][0]["domains"][1]["datagram_bytes"] == 30'
	FAKE_BUS=app out master -j | json 'd["masters"][0]["cycle"]["wire_ns"] == 13440 and d["masters"][0]["cycle"]["late_cycles"] == 9'
	FAKE_BUS=app out data -j | json 'd["masters"][0]["domains"][0]["data_hex"] == "a5"'
	out graph -j | json 'd["links"][0] == {"from": 0, "to": 1, "medium": "EBUS", "from_port": 1, "to_port": 0}'
	out crc -j | json 'd["slaves"][0]["ports"][1]["crc_errors"] == 3'
	FAKE_BUS=two out slaves -j | json 'len(d["masters"]) == 2'
}

@test "errors are objects on stderr" {
	err upload -j -p2 0x5000 0 | json 'd["error"]["abort_code"] == 0x06020000'
	err upload -j -p2 0x4000 0 | json '"1000 ms" in d["error"]["reason"] and d["error"]["errno"] > 0'
	err upload -j 0x1018 1 | json 'd["error"]["kind"] == "usage"'
	err slaves -j -p x | json 'd["error"]["kind"] == "usage"'
	err slaves -p x --json | json 'd["error"]["kind"] == "usage"'
	err nonsense -j | json 'd["error"]["kind"] == "usage"'
	FAKE_BUS=none err slaves -j | json 'd["error"]["errno"] == 2'
	FAKE_BUS=scanning err slaves -j | json '"scan" in d["note"]'
}

@test "stdout is whole after a failure" {
	out upload -j -p2 0x5000 0 | json 'd == {}'
	FAKE_BUS=none out slaves -j | json 'd == {"masters": []}'
}
