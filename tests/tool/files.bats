#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "foe_read: content to stdout, to a file, as JSON" {
	[ "$(out foe_read -p2 fw | od -An -tx1 | tr -d ' \n')" = 010262696e6172790a ]
	[ "$(out foe_read -p2 fw 7 | wc -c)" -eq 0 ]
	ethercat foe_read -p2 -o "$BATS_TEST_TMPDIR/fw" fw
	[ "$(od -An -tx1 "$BATS_TEST_TMPDIR/fw" | tr -d ' \n')" = 010262696e6172790a ]
	out foe_read -j -p2 fw |
		json 'd["data_hex"] == "010262696e6172790a" and d["size_bytes"] == 9'
	out foe_read -j -p2 fw | json 'd["name"] == "fw" and d["position"] == 2'
	out foe_read -j -p2 -o "$BATS_TEST_TMPDIR/fw" fw |
		json '"data_hex" not in d and d["output_file"].endswith("/fw")'
	[[ "$(err foe_read -v -p2 fw)" =~ ^"9 bytes in "[0-9.]+" s"$ ]]
}

@test "foe_read: binary data do not go to a terminal, an unwritable file is an error" {
	run script -qec "$HERE/build/fake/ethercat foe_read -p2 fw" /dev/null
	[ "$status" -eq 1 ]
	[[ $output == *"binary data are not written to a terminal; use -o FILE"* ]]
	run ethercat foe_read -p2 -o "$BATS_TEST_TMPDIR/none/fw" fw
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write '$BATS_TEST_TMPDIR/none/fw': No such file or directory" ]]
	run ethercat foe_read -p2 -o /dev/full fw
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write '/dev/full': No space left on device" ]]
	cd "$BATS_TEST_TMPDIR"
	run bash -c "trap '' XFSZ; ulimit -f 0; exec '$HERE/build/fake/ethercat' foe_read -p2 -o part fw"
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write 'part': File too large" ]]
	[ "$(echo part*)" = 'part*' ]
}

@test "foe_write: name, password, stdin, empty file" {
	printf 'ab' >"$BATS_TEST_TMPDIR/fw.efw"
	: >"$BATS_TEST_TMPDIR/empty"
	[ "$(log_of foe_write -p2 "$BATS_TEST_TMPDIR/fw.efw")" = "foe 2 fw.efw 0x00000000 6162" ]
	[ "$(log_of foe_write -p2 -o other "$BATS_TEST_TMPDIR/fw.efw" 0xffffffff)" = \
		"foe 2 other 0xffffffff 6162" ]
	[ "$(log_of foe_write -p2 -o x - 10 <<<c)" = "foe 2 x 0x0000000a 630a" ]
	[ "$(log_of foe_write -p2 "$BATS_TEST_TMPDIR/empty")" = "foe 2 empty 0x00000000 " ]
	out foe_write -j -p2 "$BATS_TEST_TMPDIR/fw.efw" |
		json 'd["name"] == "fw.efw" and d["size_bytes"] == 2'
}

@test "firmware: states before and after, errors" {
	printf ab >"$BATS_TEST_TMPDIR/fw.efw"
	: >"$BATS_TEST_TMPDIR/log"
	# the slave does not return to SAFEOP, its state before
	run env FAKE_LOG="$BATS_TEST_TMPDIR/log" \
		"$HERE/build/fake/ethercat" firmware -p2 "$BATS_TEST_TMPDIR/fw.efw"
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"Master0 slave 2: cannot reach SAFEOP, it is in PREOP+ERROR"* ]]
	[[ ${lines[1]} == *"Master0 slave 2: the firmware is written; to return to SAFEOP"* ]]
	[ "$(paste -sd, "$BATS_TEST_TMPDIR/log")" = \
		"state 2 1,state 2 3,foe 2 fw.efw 0x00000000 6162,state 2 1,state 2 4" ]
	run ethercat firmware -p2 -o full "$BATS_TEST_TMPDIR/fw.efw"
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"Master0 slave 2: cannot write file 'full': 0x00008003: disk full"* ]]
	[[ ${lines[1]} == *"Master0 slave 2 stays in BOOT; repeat the command"* ]]
	run ethercat firmware -p0 "$BATS_TEST_TMPDIR/fw.efw"
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 0: no FoE, so no firmware can be written"* ]]
	run ethercat firmware -p2
	[ "$status" -eq 1 ]
	run ethercat firmware -p2 - <"$BATS_TEST_TMPDIR/fw.efw"
	[ "$status" -eq 1 ]
	[[ $output == *"stdin has no name; add -o NAME, the file name on the slave"* ]]
}

@test "FoE errors: code and text of the slave, and of the master" {
	run ethercat foe_read -p2 none
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 2: cannot read file 'none': 0x00008001: file not found" ]]
	[[ $(err foe_read -p2 boot) == *"0x00008009: not possible in BOOT; some slaves mean: only "* ]]
	run ethercat foe_read -p2 strange
	[[ $output == *"cannot read file 'strange': 0x00009999: unknown code"* ]]
	run ethercat foe_read -p2 mute
	[[ $output == *"cannot read file 'mute': "*"did not answer in time" ]]
	run ethercat foe_write -p2 -o full - <<<x
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write file 'full': 0x00008003: disk full" ]]
	# a text of the slave that says more
	[[ $(err foe_write -p2 -o own - <<<x) == *": 0x00008003: disk full: text of the slave: no room" ]]
	[[ $(err foe_write -p2 -o same - <<<x) == *": 0x00008003: disk full" ]]
	err foe_read -j -p2 none | json '"0x00008001" in d["error"]["message"]'
}

@test "wrong names, passwords and selections" {
	for c in "foe_read" "foe_read -p2 a 1 2" "foe_read -p2 a x" "foe_read -p2 a 0x100000000" \
		"foe_read -p2 $(printf 'x%.0s' {1..65})" "foe_write -p2 -" "foe_write -p2 /" \
		"foe_write -p2 /none" "foe_read a"; do
		run ethercat $c </dev/null
		echo "$c: $output"
		[ "$status" -eq 1 ]
		[ "$(grep -c . <<<"$output")" -ge 1 ]
	done
}

@test "a long transfer shows its progress on a terminal only" {
	local tool="$HERE/build/fake/ethercat"

	run script -qec "$tool foe_read -p2 -o $BATS_TEST_TMPDIR/f slow" /dev/null
	[ "$status" -eq 0 ]
	[[ $output == *$'\r5 bytes'*$'\r9 bytes'* ]]
	run script -qec "$tool foe_read -q -p2 -o $BATS_TEST_TMPDIR/f slow" /dev/null
	[ -z "$output" ]
	[ -z "$(err foe_read -p2 slow)" ]
}

@test "completion offers the files that foe_write and firmware take" {
	completion_of_fake
	cd "$BATS_TEST_TMPDIR"
	: >axis.efw
	[ "$(complete_line ethercat firmware ax)" = axis.efw ]
	[ "$(complete_line ethercat -p2 foe_write ax)" = axis.efw ]
}
