#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

setup() {
	export FAKE_DIAG=good
	ESI=$BATS_TEST_TMPDIR/esi.xml
	cat >"$ESI" <<-'END'
	<Device><DiagMessages>
	<DiagMessage><TextId>#x0010</TextId>
	<MessageText LcId="1031"><![CDATA[Fehler %x]]></MessageText>
	<MessageText LcId="1033">
	<![CDATA[AL code 0x%04x &amp; %d%%, in <%s>: %s, %s, none %d]]></MessageText>
	</DiagMessage>
	<DiagMessage><TextId>17</TextId>
	<MessageText>over@[2Jtemperature</MessageText></DiagMessage>
	<DiagMessage><TextId>#x0012</TextId><MessageText LcId="1033">%s %s %</MessageText>
	</DiagMessage>
	</DiagMessages></Device>
	END
	sed -i $'s/@/\033/' "$ESI"
}

@test "diag: messages of a ring, the oldest first" {
	golden diag diag
	[ "$(FAKE_DIAG=empty out diag -p2 | tail -n 1)" = "   2  no messages" ]
}

@test "diag --texts puts the parameters into the texts of the device description" {
	golden diag_texts diag -p2 --texts "$ESI"
	run bash -c "'$HERE/build/fake/ethercat' diag -p2 --texts - <'$ESI'"
	[[ $output == *"AL code 0x142"* ]]
}

@test "diag --json" {
	messages='d["masters"][0]["slaves"][0]["messages"]'
	out diag -j --texts "$ESI" | json "[m['subindex'] for m in $messages] == [8, 9, 6, 7]"
	out diag -j | json "[m['new'] for m in $messages] == [False, False, False, True]"
	out diag -j | json "[m['severity'] for m in $messages] == ['error', 'info', 'unknown', 'warning']"
	out diag -j | json "[p['type'] for p in $messages[0]['parameters']] == ['uint16', 'int8', 'text', 'text', 'bytes']"
	out diag -j | json "$messages[0]['code'] == 0x1234e800 and $messages[2]['invalid_parameters']"
	out diag -j | json "'text' not in $messages[0]"
}

@test "diag --acknowledge and --reset write to the slave after the messages were shown" {
	[ "$(log_of diag --acknowledge | tail -n 1)" = "sdo 2 0x10f3:03 07" ]
	[ "$(log_of diag --reset | tail -n 1)" = "sdo 2 0x10f3:03 00" ]
	[ -z "$(log_of diag | grep sdo)" ]
	[ -z "$(FAKE_DIAG=empty log_of diag --reset | grep sdo)" ]
	export FAKE_LOG=$BATS_TEST_TMPDIR/refused FAKE_DIAG=refuse
	: >"$FAKE_LOG"
	run ethercat diag --reset
	[ "$status" -eq 1 ]
	[ ! -s "$FAKE_LOG" ]
	unset FAKE_DIAG
	run ethercat diag --acknowledge --reset
	[[ $output == *"exclude each other"* ]]
}

@test "diag: messages of any length" {
	for n in $(seq 0 45); do
		FAKE_DIAG=short$n
		out diag -j --texts "$ESI" | json 'isinstance(d, dict)'
		run ethercat diag
		[ "$status" -eq 0 ]
	done
	[ "$(FAKE_DIAG=short15 out diag | grep -c 'invalid message of 15 byte(s), expected at least 16$')" = 4 ]
}

@test "diag: a slave without history, a wrong one, and a failure" {
	unset FAKE_DIAG
	run ethercat diag
	[ "$status" -eq 1 ]
	[[ $output == *"Master0: no selected slave has a diagnosis history (object 0x10f3)" ]]
	# only master 0 has one
	FAKE_DIAG=good FAKE_BUS=two run ethercat diag
	[ "$status" -eq 1 ]
	[[ ${lines[-1]} == *"Master1: no selected slave has a diagnosis history (object 0x10f3)" ]]
	export FAKE_DIAG=newest
	run ethercat diag
	[ "$status" -eq 1 ]
	[[ $output == *"newest diagnosis message 0x10f3:0a is inconsistent with a history of 4 message(s)" ]]
	export FAKE_DIAG=refuse
	run ethercat diag
	[ "$status" -eq 1 ]
	[[ $output == *"slave 2: SDO upload 0x10f3:07 aborted with code 0x08000020"* ]]
}

@test "diag --texts refuses a file without texts" {
	for content in '' 'text' '<DiagMessage>' \
		'<DiagMessage><TextId>#x10</TextId></DiagMessage>' \
		'<DiagMessage><TextId>x</TextId><MessageText>a</MessageText></DiagMessage>' \
		'<DiagMessage><TextId>65536</TextId><MessageText>a</MessageText></DiagMessage>'; do
		printf '%s' "$content" >"$BATS_TEST_TMPDIR/x.xml"
		run ethercat diag --texts "$BATS_TEST_TMPDIR/x.xml"
		[ "$status" -eq 1 ]
		[[ $output == *"x.xml' has no texts of diagnosis messages"* || $output == *"is empty"* ]]
	done
	# every part of a file
	for n in $(seq 1 7 "$(wc -c <"$ESI")"); do
		head -c "$n" "$ESI" >"$BATS_TEST_TMPDIR/x.xml"
		run ethercat diag --texts "$BATS_TEST_TMPDIR/x.xml"
		[[ $output != *Sanitizer* ]]
	done
}
