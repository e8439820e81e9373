#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Clocks, topology and error counters at a glance.

load common

# watch BUS: the conclusion of crc --watch, in a line each
watch() {
	FAKE_BUS=$1 out crc --watch 0.1 --quiet
}

@test "dc: clocks without and beside an application" {
	golden dc dc
	FAKE_BUS=dc golden dc_app dc
	FAKE_BUS=dc golden dc_v dc -v
	[[ $(FAKE_BUS=noref out dc -p1) == "Master0: no reference clock"* ]]
	[[ $(FAKE_BUS=reversed out dc) == *"delay unreliable"* ]]
	[ "$(FAKE_BUS=empty out dc)" = "Master0: reference clock slave 0" ]
	[ "$(FAKE_BUS=two out dc | grep -c '^Master[01]: ')" = 2 ]
}

@test "dc --json has numbers or null" {
	slave='d["masters"][0]["slaves"][0]'
	FAKE_BUS=dc out dc -j -p2 | json "$slave['dc_offset_ns'] == -815000000123456789"
	FAKE_BUS=dc out dc -j -p2 |
		json "$slave['sync'][0] == {'active': True, 'cycle_ns': 1000000, 'shift_ns': -500}"
	FAKE_BUS=dc out dc -j -p2 |
		json "not $slave['sync'][1]['active'] and 'registers' not in $slave"
	FAKE_BUS=dc out dc -j -v -p2 | json "$slave['registers']['dc_difference_ns'] == -12"
	FAKE_BUS=dc out dc -j -p0 |
		json "$slave['reference'] and d['masters'][0]['largest_difference_ns'] is None"
	out dc -j -p1 | json "$slave['clock'] == 'delay only' and $slave['dc_difference_ns'] is None"
}

@test "dc reads registers only with --verbose, which needs write access" {
	FAKE_READONLY=1 out dc | grep -q 'EL7201'
	FAKE_READONLY=1 run ethercat dc -v
	[ "$status" -eq 1 ]
	[[ $output == *"Permission denied"* ]]
}

@test "graph --tree: lines, branches, ports and counters" {
	golden graph_tree graph --tree
	FAKE_BUS=tree golden graph_branch graph --tree
	FAKE_READONLY=1 golden graph_tree graph --tree
	[[ $(out graph crc --tree) == *"0 ns  port 1: CRC 3, FWD 1"* ]]
	FAKE_READONLY=1 run ethercat graph crc --tree
	[ "$status" -eq 1 ]
	[ "$(FAKE_BUS=empty out graph --tree)" = "Master0: main device eth0, link up" ]
}

@test "graph --tree shows each slave once for ports that contradict each other" {
	for b in idle tree loop reversed cut evil; do
		FAKE_BUS=$b out graph --tree -j |
			json 'sorted(s["position"] for s in d["slaves"]) == [0, 1, 2]'
		[ "$(FAKE_BUS=$b out graph --tree | wc -l)" = 4 ]
	done
	FAKE_BUS=big out graph --tree -j | json 'len(d["slaves"]) == 1000'
	FAKE_BUS=reversed out graph --tree -j |
		json '[s["upstream"] for s in d["slaves"]] == [None, 2, 0]'
	FAKE_BUS=tree out graph --tree -j | json 'd["slaves"][2]["upstream_port"] == 2'
	FAKE_BUS=tree out graph --tree -j | json '"crc_errors" not in d["slaves"][0]["ports"][0]'
	FAKE_BUS=tree out graph crc --tree -j | json 'd["slaves"][0]["ports"][1]["crc_errors"] == 3'
}

@test "graph CRC draws a slave that does not reply without counters" {
	FAKE_BUS=mute run ethercat graph crc --tree
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"Master0 slave 1: cannot read register 0x0300"* ]]
	[ "${#lines[@]}" = 5 ]
	FAKE_BUS=mute out graph crc | grep -qF 'taillabel="1 [3/1]", headlabel="0"]'
	FAKE_BUS=mute out graph crc --tree -j |
		json '[len(s["ports"][0]) for s in d["slaves"]] == [8, 4, 8]'
}

@test "a lost frame does not keep error counters from being read" {
	for c in crc "crc --watch 0.1" "graph crc" "graph crc --tree"; do
		diff <(out $c | sed 's/[0-9.]* s /T /') \
			<(FAKE_BUS=lossy ethercat $c 2>&1 | sed 's/[0-9.]* s /T /')
	done
	FAKE_BUS=lossy out why -j | json "d['masters'][0]['error_counters_read']"
	# a read may change other registers
	FAKE_BUS=lossy run ethercat reg_read -p0 -t uint16 0x0130
	[ "$status" -eq 1 ]
}

@test "crc --watch names the segment where errors grow" {
	between="Errors grow between slave 1 port 1 and slave 2 port 0"
	[ "$(watch noisy)" = "$between: 5 invalid frame(s), 9 receiver error(s), 1 lost link(s)" ]
	[[ $(watch idle) == "No error counter of a port has grown in 0."* ]]
	run watch noisy2
	[[ ${lines[0]} == "Errors grow between the master and slave 0 port 0: 1 invalid "* ]]
	[[ ${lines[1]} == "$between: 4 invalid frame(s), "* ]]
	[[ ${lines[2]} == "Errors grow at slave 2 port 1, where no slave is connected: "* ]]
	[[ ${lines[3]} == "Repair the first of these 3 segments first: "* ]]
	[[ $(watch upstream) == "Only forwarded errors grow, first at slave 1 port 0: "* ]]
}

@test "crc --watch shows the counters before and after, of the selected slaves" {
	run bash -c "FAKE_BUS=noisy '$HERE/build/fake/ethercat' crc --watch 0.1 -p2"
	[ "${#lines[@]}" = 8 ]
	[[ ${lines[2]} == "  2|  0   0   0   ↑|"* ]]
	[[ ${lines[6]} == "  2|  4   9   0   ↑|"* ]]
	[[ ${lines[7]} == "Errors grow between slave 1 port 1 and slave 2 port 0: "* ]]
	watched() { FAKE_BUS=$1 out crc --watch 0.1 -j | json "$2"; }
	watched noisy 'd["segments"] == [{"slave": 1, "port": 1, "to_slave": 2, "to_port": 0,
		"invalid_frames": 5, "receiver_errors": 9, "lost_links": 1}]'
	watched noisy 'd["begin"][2]["ports"][0]["crc_errors"] == 0'
	watched noisy 'd["slaves"][2]["ports"][0]["crc_errors"] == 4'
	watched noisy2 '[s["slave"] for s in d["segments"]] == [None, 1, 2]'
	watched upstream 'd["forwarded_at"] == {"slave": 1, "port": 0} and not d["segments"]'
}

@test "crc --watch reports full and cleared counters and a changed bus" {
	FAKE_BUS=full err crc --watch 0.1 | grep -q '^Master0 slave 1: a counter is at its limit'
	FAKE_BUS=cleared err crc --watch 0.1 | grep -q '^Master0 slave 0: counters were cleared '
	FAKE_BUS=shrinks run ethercat crc --watch 0.1
	[ "$status" -eq 1 ]
	[[ $output == *"Master0: 3 slave(s) before, 2 after; repeat the command" ]]
	[[ $(FAKE_BUS=empty err crc --watch 0.1) == *"Master0: no slaves" ]]
}

@test "crc adds counts that the master has cleared, up to 255" {
	ports='d["slaves"][0]["ports"]'
	out crc -p1 -j | json "$ports[0][\"phy_errors\"] == 0 and $ports[1][\"crc_errors\"] == 0"
	FAKE_BUS=emptied out crc -p1 -j |
		json "$ports[0][\"crc_errors\"] == 255 and $ports[0][\"phy_errors\"] == 7"
	FAKE_BUS=emptied out crc -p1 -j |
		json "$ports[0][\"forwarded_errors\"] == 2 and $ports[1][\"crc_errors\"] == 0"
	[ "$(FAKE_BUS=emptied out reg_read -p1 0x300 12)" = "$(out reg_read -p1 0x300 12)" ]
}

@test "crc --watch goes on without a slave that does not reply" {
	FAKE_BUS=mute run ethercat crc --watch 0.1
	[ "$status" -eq 1 ]
	[ "$(grep -c 'Master0 slave 1: cannot read register 0x0300' <<<"$output")" = 1 ]
	[ "$(grep -c '^  [02]|' <<<"$output")" = 4 ]
	[[ ${lines[-1]} == "No error counter of a port has grown in "* ]]
}

@test "crc --watch: Ctrl-C ends it with the result" {
	FAKE_BUS=noisy "$HERE/build/fake/ethercat" crc --watch 60 >"$BATS_TEST_TMPDIR/out" 3>&- &
	pid=$!
	until [ -s "$BATS_TEST_TMPDIR/out" ]; do sleep 0.1; done
	kill -INT $pid
	wait $pid
	grep -q '^Errors grow between slave 1 port 1' "$BATS_TEST_TMPDIR/out"
}

@test "crc --watch refuses invalid times and reset" {
	for s in 0 0.05 86401 x '' 1e3 -1; do
		run ethercat crc --watch "$s"
		[ "$status" -eq 1 ]
		[[ $output == *"invalid time '$s' for --watch: expected 0.1 to 86400 seconds"* ]]
	done
	run ethercat crc reset --watch 1
	[ "$status" -eq 1 ]
	[[ $output == *"'reset' and --watch exclude each other"* ]]
}

@test "slaves, graph: absent slaves and closed ports, by port" {
	local lines

	lines="behind port 2 of slave 0 EK1100: 7 slaves disconnected, since 3.1 s: 1 (EL2008) to 7
behind port 1 of slave 1 EL2008: slave 2 (EL7201) disconnected, since 5 min
behind the main device: 2 slaves disconnected, since 0.0 s: 8 (EK1100) to 9
port 3 of slave 0 EK1100 stays closed despite its link: it has lost its link again and again"
	lines+=", opens after 4 s of link without loss; check cable and plugs"
	export FAKE_ABSENT=1
	[[ $(err slaves) == "$(sed 's/^/Master0: /' <<<"$lines")"* ]]
	[[ $(out graph --tree) == *"
$lines
"* ]]
	[ "$(out slaves)" = "$(env -u FAKE_ABSENT "$HERE/build/fake/ethercat" slaves 2>/dev/null)" ]
	# those of a selected slave, and of the main device
	[ "$(err slaves -p1 | grep -c 'behind port')" = 1 ]
	[[ $(out graph) == *'absent0 [shape="box", style="dashed", label="7 slaves disconnected\nsince 3.1 s"]
	slave0 -- absent0 [style="dashed", taillabel="2"]'* ]]
	[[ $(out graph) == *'master -- absent2 [style="dashed"]'* ]]
	for c in "slaves" "graph" "graph --tree"; do
		out $c -j >"$BATS_TEST_TMPDIR/json"
		json '(lambda m: list(m["absent"][0].values()) ==
			[0, 2, 7, 3100000000, 1, 7, "EL2008"] and
			m["absent"][2]["upstream"] is None and m["closed_ports"][0] ==
			{"slave": 0, "port": 3, "reason": "losses", "wait_s": 4, "behind": None} and
			m["closed_ports"][1]["reason"] == "no_reply")(d.get("masters", [d])[0])' \
			<"$BATS_TEST_TMPDIR/json"
	done
}

@test "slaves, graph: devices behind closed ports, and --let-in" {
	local line c

	line="port 2 of slave 1 EL2008 stays closed despite its link: another alias or identification than the group"
	line+=" (EL\"2008? 0x00000002/0x07d83052, serial number 0x0000003d, 3 slaves); connect the right one, or 'ethercat slaves -p 1 --let-in 2'"
	export FAKE_BORDER=1
	[[ $(err slaves) == "Master0: $line"* ]]
	[[ $(out graph --tree) == *"$line"* ]]
	[[ $(out graph) == *'label="EL\"2008?\nnot let in"]
	slave1 -- closed1_2 [style="dotted", taillabel="2"]'* ]]
	[[ $(FAKE_BORDER=boot err slaves) == *"a device in BOOT; switch it off and on, or 'ethercat slaves -p 1 --let-in 2'"* ]]
	[[ $(FAKE_BORDER=boot out graph) == *'label="unknown device\nnot let in"'* ]]
	for c in "slaves" "graph" "graph --tree"; do
		out $c -j | json 'd.get("masters", [d])[0]["closed_ports"] == [{"slave": 1, "port": 2,
			"reason": "other_sign", "wait_s": 0, "behind": {"vendor_id": 2,
			"product_code": 0x7d83052, "revision_number": 0x110000, "serial_number": 61,
			"alias": 7, "identification": 9, "slaves": 3, "name": "EL\"2008?"}}]'
	done
	# the identity that was shown goes with the command
	[ "$(log_of slaves -p 1 --let-in 2 2>/dev/null | grep let_in)" = "let_in 1 2 0x2 0x7d83052 0x110000 0x3d" ]
	[[ $(err slaves -p 1 --let-in 2) == *"Master0: the device behind port 2 of slave 1 is let in (EL"* ]]
}

@test "slaves --let-in refuses wrong arguments with a reason" {
	export FAKE_BORDER=1
	run ethercat slaves --let-in 2
	[ "$status" -eq 1 ]
	[[ $output == *"--let-in is for a port of one slave, not of "*": select it with --position or --alias" ]]
	run ethercat slaves -p 1 --let-in 1
	[ "$status" -eq 1 ]
	[[ $output == *"cannot let in what is behind port 1 of slave 1: no device waits there"* ]]
	for p in 0 4 -1 2x ""; do
		run ethercat slaves -p 1 --let-in "$p"
		[ "$status" -ne 0 ]
		[[ $output == *"invalid port '$p' for --let-in: expected 1 to 3"* ]]
	done
	FAKE_READONLY=1 run ethercat slaves -p 1 --let-in 2
	[ "$status" -eq 1 ]
	[ -z "$(FAKE_READONLY=1 log_of slaves -p 1 --let-in 2 2>/dev/null | grep let_in)" ]
}
