#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

# each line is an object: lines EXPRESSION about the list d
lines() {
	python3 -c '
import json, sys
d = [json.loads(line) for line in sys.stdin]
assert eval(sys.argv[1]), d
' "$1"
}

@test "mailbox --follow: one line for each message of all protocols" {
	golden mailbox mailbox --follow
	# what a slave has sent moves no cursor
	[ -z "$(out mailbox --follow | LC_ALL=C grep '[^ -~]')" ]
	[ -z "$(out mailbox --follow | grep 4660)" ]	# the password
}

@test "mailbox --follow: -p and -a select slaves" {
	[ "$(out mailbox --follow -p1 | wc -l)" = 1 ]
	[[ $(out mailbox --follow -p1) == *"UTC    1  from  CoE    emergency 0x3210: "* ]]
	[ "$(out mailbox --follow -a1001 -p1 | wc -l)" = 24 ]
	diff <(out mailbox --follow -p2) <(out mailbox --follow -a1001 -p1)
	run ethercat mailbox --follow -p7
	[ "$status" = 1 ]
	[ "$output" = "ethercat mailbox: the selection matches no slave" ]
}

@test "mailbox --follow --json: each line is an object" {
	out mailbox --follow -j | lines 'len(d) == 25'
	out mailbox --follow -j | lines 'd[1]["since_request_ns"] == 812000 and d[1]["slave"] == 2'
	out mailbox --follow -j | lines 'd[3]["failed"] and d[3]["object"] == "0x8000:01"'
	out mailbox --follow -j |
		lines '[m["number"] for m in d if m["malformed"]] == [29, 30]'
	out mailbox --follow -j |
		lines '[m["number"] for m in d if m["frame_lost"]] == [18]'
	out mailbox --follow -j |
		lines 'd[0]["direction"] == "to_slave" and d[0]["station"] == 0x3eb'
	out mailbox --follow -j |
		lines '"since_request_ns" not in d[0] and d[0]["size_bytes"] == 16'
}

@test "mailbox --follow: a reader that is too slow gets the number of messages missed" {
	export FAKE_MAIL=gap
	[ "$(out mailbox --follow | wc -l)" = 23 ]
	[ "$(out mailbox --follow | sed -n 5p)" = "3 message(s) missed: the reader was too slow" ]
	# also if the message behind the gap is of another slave
	[ "$(out mailbox --follow -p2 | sed -n 5p)" = "3 message(s) missed: the reader was too slow" ]
	out mailbox --follow -j | lines '[m["missed"] for m in d if m["missed"]] == [3]'
}

@test "mailbox: without the right or the option it names the remedy" {
	run ethercat mailbox
	[ "$status" = 1 ]
	[[ $output == "ethercat mailbox: the command shows messages from now on: give --follow"* ]]
	FAKE_MAIL=denied run ethercat mailbox --follow
	[ "$status" = 1 ]
	[[ $output == *"cannot read mailbox messages"*"passwords"* ]]
	FAKE_MAIL=old run ethercat mailbox --follow
	[ "$status" = 1 ]
	FAKE_READONLY=1 ethercat mailbox --follow >/dev/null
	run bash -c "'$HERE/build/fake/ethercat' mailbox --follow >/dev/full"
	[ "$status" = 1 ]
	[[ $output == *"cannot write the output: No space left on device" ]]
}

@test "mailbox: 'ma' is master as before, and the completion offers the command" {
	diff <(out ma) <(out master)
	completion_of_fake
	[[ " $(complete_line ethercat mail) " == *" mailbox "* ]]
	[[ " $(complete_line ethercat mailbox --f) " == *" --follow "* ]]
}
