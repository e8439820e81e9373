#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

events='d["masters"][0]["events"]'

# each line is an object: lines EXPRESSION about the list d
lines() {
	python3 -c '
import json, sys
d = [json.loads(line) for line in sys.stdin]
assert eval(sys.argv[1]), d
' "$1"
}

@test "log: one line for each event that was kept, and no later one" {
	golden log log
	[ "$(out log | wc -l)" = 9 ]
	[ -z "$(FAKE_EVENTS=none out log)" ]
}

@test "log --follow also shows later events" {
	[ "$(out log --follow | wc -l)" = 11 ]
	diff <(out log) <(out log --follow | head -n 9)
	[[ $(out log --follow | tail -n 1) == *"slave 2: AL state SAFEOP with error, AL status code 0x001b"* ]]
}

@test "log: a gap has the number of events, and the rest follows" {
	export FAKE_EVENTS=gap
	[ "$(out log | wc -l)" = 6 ]
	[[ $(out log | sed -n 4p) == *"]  4 event(s) missed: the reader was too slow" ]]
	[[ $(out log | sed -n 5p) == *"behind port 1 of slave 1: 92 slaves disconnected, "*" to 93, last seen 25 ms ago" ]]
	out log -j | json "$events[3]['event'] == 'missed' and $events[3]['count'] == 4"
	out log -j | json "[e['number'] for e in $events] == [7, 8, 9, 10, 14, 15]"
	[ "$(out log --follow | wc -l)" = 8 ]
	out log --follow -j | lines 'd[3]["count"] == 4 and len(d) == 8'
}

@test "log --json has the values of each event by name" {
	out log -j | json "[e['number'] for e in $events] == list(range(7, 16))"
	out log -j | json "$events[4] == {'number': 11, 'time_ns': 1764000000150000000, 'monotonic_ns': 5150000000, 'event': 'al_state', 'slave': 2, 'state': 'OP', 'before': 'SAFEOP', 'slaves': 1, 'lowest': None, 'text': 'slave 2: AL state OP, before SAFEOP'}"
	out log -j | json "'slave' not in $events[0] and $events[7]['upstream'] == 1"
	out log -j | json "$events[8]['phase_error_ns'] == -12 and $events[8]['rate_ppb'] == -8700"
	out log -j | json "$events[8]['cycle_lock'] == 'holding' and $events[1]['duration_us'] == 4100"
	FAKE_EVENTS=none out log -j | json "$events == []"
	FAKE_BUS=two out log -j | json 'len(d["masters"]) == 2'
}

@test "help log has the values of each event" {
	python3 - <(out help log) "$HERE/../../master/wire/event.c" <<-'END'
	import re, sys
	text = " ".join(open(sys.argv[1]).read().split()).split("Values by event: ")[1]
	listed = {}
	for names, keys in re.findall(r"([a-z_, ]+) \(([^)]*)\)", text):
	    for name in names.strip(", ").split(", "):
	        listed[name] = [] if keys == "none" else keys.split(", ")
	table = re.search(r"kinds\[\] = \{(.*?)\n\};", open(sys.argv[2]).read(), re.S)[1]
	kinds = {}
	for kind in table.split("KIND(")[1:]:
	    name, *keys = re.findall(r'"(\w+)"', kind)
	    kinds[name] = [k for k in keys if k != "count_high"]
	assert len(kinds) > 40 and listed == kinds, (listed, kinds)
	END
}

@test "log --follow --json: each line is an object" {
	out log --follow --json | lines 'len(d) == 11 and d[9]["upstream"] is None'
	out log --follow --json | lines 'd[0]["event"] == "link_up" and d[0]["master"] == 0'
	FAKE_BUS=two run ethercat log --follow
	[ "$status" = 1 ]
	[[ $output == *"2 masters found, the command needs one"* ]]
	[ "$(FAKE_BUS=two out log --follow -m1 | wc -l)" = 11 ]
}

@test "log: events of a newer module are shown, an older module is named" {
	[[ $(FAKE_EVENTS=unknown out log | sed -n 5p) == *"unknown event 0xabc; a newer module has it" ]]
	FAKE_EVENTS=unknown out log -j | json "$events[4]['event'] == 'unknown'"
	FAKE_EVENTS=old run ethercat log
	[ "$status" = 1 ]
	[[ $output == "ethercat log: Master0: cannot read events"* ]]
}

@test "log reads with read access, and ends when its reader does" {
	FAKE_READONLY=1 ethercat log >/dev/null
	run bash -c "set -o pipefail; '$HERE/build/fake/ethercat' log --follow | head -n 0"
	[ "$status" = 141 ] || [ "$status" = 0 ]
	# also while nothing happens
	FAKE_EVENTS=quiet run timeout 20 bash -c "'$HERE/build/fake/ethercat' log --follow | head -n 1"
	[ "$status" = 0 ]
	[[ $output == *"main link up" ]]
	run bash -c "'$HERE/build/fake/ethercat' log --follow >/dev/full"
	[ "$status" = 1 ]
	[[ $output == *"cannot write the output: No space left on device" ]]
}

@test "log: the completion offers the command and its option" {
	completion_of_fake
	[[ " $(complete_line ethercat lo) " == *" log "* ]]
	[[ " $(complete_line ethercat log --f) " == *" --follow "* ]]
}
