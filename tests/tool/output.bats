#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "output for an idle bus equals the golden files" {
	golden slaves slaves
	golden slaves_v slaves -v
	golden master master
	golden pdos pdos
	golden pdos_p2_q pdos -p2 -q
	golden cstruct cstruct
	golden upload upload -p2 0x1018 1
	golden crc crc
	golden graph graph
	golden sii_v sii_read -v -p2
}

@test "output beside an application equals the golden files" {
	export FAKE_BUS=app
	golden config config
	golden config_v config -v
	golden domains domains
	golden domains_v domains -v
	golden cycle cycle
	golden cycle_v cycle -v
	FAKE_BUS=kcycle golden cycle_kernel cycle
}

@test "cycle: 99.9 % of the sends, a reset on demand only" {
	[[ $(out cycle) == *"Cycle: none yet"* ]]
	FAKE_BUS=app out cycle -j | json 'd["masters"][0]["late_p999_ns"] == 5119'
	FAKE_BUS=app out cycle -j | json 'sum(b["sends"] for b in d["masters"][0]["histogram"]) == d["masters"][0]["sends"] == 10000'
	FAKE_BUS=app out cycle -j | json 'd["masters"][0]["histogram"][1] == {"from_ns": 1024, "to_ns": 1151, "sends": 5000}'
	FAKE_BUS=kcycle out cycle -j | json '(lambda m: (m["by"], m["state"], m["overruns"], m["missed"]) == ("kernel", "stalled", 2, 3))(d["masters"][0])'
	[ -z "$(FAKE_BUS=app log_of cycle | grep reset)" ]
	[[ $(FAKE_BUS=app log_of cycle --reset) == *"cycle reset" ]]
	FAKE_READONLY=1 run ethercat cycle --reset
	[ "$status" -eq 1 ]
	[[ $output == *"Permission denied"* ]]
}

@test "golden: cut ring, two masters" {
	FAKE_BUS=cut golden slaves_cut slaves
	FAKE_BUS=two golden slaves_two slaves
	FAKE_BUS=two golden slaves_two slaves -m 0,1
}

@test "slaves: list held, by which process, lost slave, slaves outside of the list" {
	local held="Master0: the list of slaves is held until process 123 (demo) activates or"

	FAKE_BUS=held golden slaves_held slaves
	[ "$(FAKE_BUS=held err slaves)" = \
		"$held releases the master; slaves responding: 4, in the list: 3" ]
	[ "$(FAKE_BUS=held_same err slaves)" = "$held releases the master" ]
	FAKE_BUS=held out slaves -j >"$BATS_TEST_TMPDIR/json"
	json '(lambda m: m["list_held"] and not m["scan_busy"])(d["masters"][0])' \
		<"$BATS_TEST_TMPDIR/json"
	json 'd["masters"][0]["slaves_responding"] == 4' <"$BATS_TEST_TMPDIR/json"
	json 'd["masters"][0]["slaves"][1]["state"] == "LOST"' <"$BATS_TEST_TMPDIR/json"
	FAKE_BUS=held out master -j | json 'd["masters"][0]["list_held"]'
	FAKE_BUS=held out master -j | json 'd["masters"][0]["owner"] == "process 123 (demo)"'
	out master -j | json '[d["masters"][0][k] for k in ("list_held", "owner")] == [False, None]'
}

@test "commands without data print nothing" {
	for c in slaves "slaves -v" pdos cstruct crc config domains data; do
		FAKE_BUS=empty run ethercat $c
		[ "$status" -eq 0 ]
		[ "$c" = crc ] || [ -z "$output" ]
	done
}

@test "a selection that matches nothing is an error" {
	for c in "slaves -p7" "slaves -a5" "slaves -a0" "pdos -p9-12" "slaves -v -p7" "states -p77" \
		"states OP -p77" "cstruct -p7" "crc -p7" "crc reset -p7" "slaves --json -p7"; do
		run ethercat $c
		echo "$c: $output"
		[ "$status" -eq 1 ]
		[[ $output == *"the selection matches no slave"* ]]
	done
	export FAKE_BUS=app
	[[ $(err config -p77) == *"the selection matches no configuration" ]]
	[[ $(err domains -d77) == *"the selection matches no domain" ]]
	[[ $(err data -d77) == *"the selection matches no domain" ]]
	for c in slaves states pdos domains rescan master; do
		run ethercat $c -m5
		[ "$status" -eq 1 ]
		[[ $output == *"no such master, there is only master 0"* ]]
	done
	# a list with masters that exist
	[ "$(err master -m0,7)" = "warning: no master 7, the last one is master 0" ]
	[ -z "$(err master -m0-7)" ]
	# one match on one of two masters is enough
	FAKE_BUS=two run ethercat slaves -m0,1 -p1
	[ "$status" -eq 0 ]
}

@test "positions that the ring does not have are named beside others" {
	run ethercat slaves -p 1,99
	[ "$status" = 0 ]
	[[ $output == *" EL2008"* ]]
	[ "${lines[0]}" = "Master0: no slave at position 99, the last one is 2" ]
	[ "$(ethercat slaves -p 1-99 2>&1 | wc -l)" = 2 ]
}

@test "without slaves or device nothing is requested, and that is an error" {
	export FAKE_BUS=empty
	for c in "states OP" "crc reset"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ $output == *"no slaves" ]]
	done
	export FAKE_BUS=waiting
	for c in rescan "rescan --wait" "states OP"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ $output == *"no network interface yet, waiting for eth0" ]]
	done
	[ -z "$(log_of rescan)" ]
}

@test "options select masters and slaves" {
	[ "$(out slaves -p1 | cut -c1)" = 1 ]
	[ "$(out slaves -p2,0,2 | cut -c1 | tr -d '\n')" = 02 ]
	[ "$(out slaves -p1- | wc -l)" -eq 2 ]
	[ "$(out slaves -p-1 | wc -l)" -eq 2 ]
	[ "$(out slaves -a1001 | wc -l)" -eq 2 ]
	[ "$(out slaves -a1001 -p1 | awk '{ print $2 }')" = 1001:1 ]
	# as it stands in that column, for each slave of the list
	out slaves | while read -r position name _; do
		[ "$(out slaves -p"$name" | cut -d' ' -f1)" = "$position" ]
	done
	[ "$(out slaves -p1001:0- | wc -l)" = "$(out slaves -a1001 | wc -l)" ]
	[[ $(ethercat slaves -p70000:1 2>&1) == *"invalid list '70000:1' for --position: an alias is at most 65535"* ]]
	[ "$(out slaves -a- -p- | wc -l)" -eq 3 ]
	[ "$(out slaves -v -p2,1,2 | grep -c ===)" -eq 3 ]
	[ "$(out pdos -p2 | head -c3)" = SM0 ]
	[ "$(FAKE_BUS=app out config -p0)" = "" ]
	[[ $(FAKE_BUS=app out config -p2) == "0:2 "* ]]
	[[ $(FAKE_BUS=app out config -a1001 -p0) == "1001:0 "* ]]
	[ "$(FAKE_BUS=app out domains -d1)" = "$(sed -n 2,3p "$HERE/golden/domains.txt")" ]
}

@test "commands for one slave refuse any other number" {
	for c in "upload 0x1018 1" "reg_read 0 1" "sii_read" "download -tint8 0x6060 0 1"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ $output == *"selection matches 3 of "* ]]
		run ethercat $c -p7
		[ "$status" -eq 1 ]
		[[ $output == *"selection matches 0 of "* ]]
	done
}

@test "commands for one master refuse several" {
	export FAKE_BUS=two
	run ethercat upload -p2 0x1018 1
	[ "$status" -eq 1 ]
	[[ $output == *"select it with -m"* ]]
	[ "$(out upload -m1 -p2 0x1018 1)" = "0x00000002 2" ]
	run ethercat upload -m5 -p2 0x1018 1
	[ "$status" -eq 1 ]
	[ "$(out slaves -m1)" = "$(cat "$HERE/golden/slaves.txt")" ]
	[ "$(out pdos -p2 | grep -c '=== Master')" -eq 2 ]
}

@test "output has the form that public scripts expect" {
	# shell
	[ "$(out slaves | grep -c '^')" -eq 3 ]
	[ "$(out slaves | awk '{ print $3, $5 }' | head -1)" = "PREOP EK1100" ]
	out slaves | grep -q '^ *2 .*EL7201'
	# python wrappers
	out slaves | python3 -c '
import sys
for i, l in enumerate(sys.stdin):
    w = l.split()
    assert w[0] == str(i) and ":" in w[1] and w[3] in "+E" and w[4].startswith("E")
'
	out slaves -v | python3 -c '
import sys
rows = [l.split() for l in sys.stdin if l[:4].strip().isdigit()]
assert len(rows) == 12 and sum(r[3] == "closed" for r in rows) == 7
'
	# service scripts
	out master | grep -qE 'Phase:\s*(Idle|Operation)'
	FAKE_BUS=app out master | grep -qE 'Phase:\s*Operation'
	out master | grep -qE 'Active:\s*no'
	out master | grep -qE 'Link:\s*UP'
	out master | grep -qE 'Slaves:\s*3'
	out master | grep -q attached
	FAKE_BUS=app out master -v | grep -q 'All domains: 3 datagram(s), 2 frame(s), 13.44 us'
	FAKE_BUS=app out master -v | grep -q 'Free for acyclic frames: 5.00 us, minimum 6.72 us (not enough)'
	FAKE_BUS=app out master -v | grep -q 'Cycles delayed by acyclic frames: 9 (limit 100/s)'
	FAKE_BUS=app out master -v | grep -q 'Last send:   1 frame(s), 6.72 us'
	out master | grep -q 'Lost frames'
	# first token, and awk '{print $2}'
	[ $(($(out upload -p2 0x1018 1 | awk '{ print $1 }'))) -eq 2 ]
	[ "$(out upload -p2 -t int16 0x6041 0 | awk '{ print $2 }')" = -32672 ]
	# a configuration generator
	out -v slaves | python3 -c '
import re, sys
n = 0
for l in sys.stdin:
    if re.match(r"=== Master (\d+), Slave (\d+) ===$", l): n += 1
    m = re.match(r"  (Vendor Id|Product code|Revision number|Device name):\s+(.*)$", l)
    if m: n += 10
assert n == 123, n
'
	out -m 0 pdos -p 2 | python3 -c '
import re, sys
sm = r"SM(\d+): PhysAddr 0x([0-9a-f]{4}), DefaultSize +(\d+), ControlRegister 0x([0-9a-f]{2}), Enable (\d+)$"
pdo = r"  ([RT])xPDO 0x([0-9a-f]{4}) \"(.*)\"$"
entry = r"    PDO entry 0x([0-9a-f]{4}):([0-9a-f]{2}), +(\d+) bit, \"(.*)\"$"
for l in sys.stdin:
    assert re.match(sm, l) or re.match(pdo, l) or re.match(entry, l), l
'
}

@test "cstruct compiles" {
	command -v cc >/dev/null || skip "no C compiler"
	{
		cat <<'END'
#include <stdint.h>
#include <stddef.h>
typedef struct { uint16_t index; uint8_t subindex; uint8_t bit_length; } ec_pdo_entry_info_t;
typedef struct { uint16_t index; unsigned n; ec_pdo_entry_info_t *e; } ec_pdo_info_t;
enum { EC_DIR_OUTPUT = 1, EC_DIR_INPUT, EC_WD_ENABLE = 1, EC_WD_DISABLE };
typedef struct { uint8_t i; int dir; unsigned n; ec_pdo_info_t *p; int wd; } ec_sync_info_t;
END
		out cstruct
	} >"$BATS_TEST_TMPDIR/c.c"
	cc -Wall -Werror -c -o /dev/null "$BATS_TEST_TMPDIR/c.c"
}

@test "upload prints values of all types" {
	[ "$(out upload -p2 -t int16 0x6041 0)" = "0x8060 -32672" ]
	[ "$(out upload -p2 -t int8 0x6060 0)" = "0xff -1" ]
	[ "$(out upload -p2 -t float 0x2000 0)" = "1.5" ]
	[ "$(out upload -p2 0x1018:01)" = "0x00000002 2" ]
	[ "$(out upload -p2 0x1018:02)" = "0x01 0x02 0x03" ]
	[ "$(out sdo_upload -p2 0x1018 1)" = "0x00000002 2" ]
	[ "$(out sdo_read -p2 0x1018 1)" = "0x00000002 2" ]
	[ "$(out upload -p2 0x1018 | xxd -p)" = 04000200 ]
	[ "$(out upload -p2 -t string 0x1008 0 | tr -d '\0')" = EL7201 ]
	[ "$(out upload -p2 -t octet_string 0x1008 0 | wc -c)" -eq 8 ]
	[ "$(out upload -p2 -t octet_string 0x3000 0 | wc -c)" -eq 65536 ]
	# on a terminal each byte can be read
	local tool=$HERE/build/fake/ethercat

	[[ $(script -qec "$tool upload -p2 0x1018" /dev/null) == "0x04 0x00 0x02 0x00"* ]]
	[[ $(script -qec "$tool upload -p2 -toctet_string 0x2000 0" /dev/null) == "0x00 0x00 0xc0"* ]]
	[[ $(script -qec "$tool upload -p2 -toctet_string 0x2003 0" /dev/null) == "0x61 0x0a 0x62"* ]]
	[[ $(script -qec "$tool upload -p2 -toctet_string 0x2003 1" /dev/null) == "0xe4 0xf6"* ]]
	[[ $(script -qec "$tool upload -p2 -toctet_string 0x2003 2" /dev/null) == "text" ]]
	[[ $(script -qec "$tool upload -p2 -tstring 0x2003 1" /dev/null) == "äö"* ]]
	# half of a pair, a control character
	[[ $(script -qec "$tool upload -p2 -tunicode_string 0x2004 0" /dev/null) == "EÄ€😀??L"* ]]
	[ "$(out upload -p2 -tunicode_string 0x2004 0 | wc -c)" -eq 19 ]
}

@test "upload failures name cause and slave" {
	# an index that looks as if typed without 0x
	[[ $(err upload -p2 5000 0) == *", in decimal 5000 (did you mean 0x5000?)"* ]]
	[[ $(err upload -p2 0x5000 0) != *"did you mean"* ]]
	[[ $(err upload -p2 1019 1) == *"upload 0x03fb:01, in decimal 1019 (did you mean 0x1019?)"* ]]
	[[ $(err upload -p2 0x3fb 1) != *"did you mean"* ]]
	run ethercat upload -p2 0x5000 0
	[ "$status" -eq 1 ]
	[[ $output == *"aborted with code 0x06020000: "* ]]
	[ "${#lines[@]}" -eq 1 ]
	run ethercat upload -p2 0x5001 0
	[ "$status" -eq 1 ]
	[[ $output == *"aborted with code 0x12345678: unknown code" ]]
	err upload -j -p2 0x5001 0 | json 'd["error"]["abort_text"] == "unknown code"'
	run ethercat upload -p2 0x4000 0
	[ "$status" -eq 1 ]
	[[ $output == *"SDO upload 0x4000:00: slave 2 has not answered for 1000 ms" ]]
	# neither the SDO nor the slave twice, also if the kernel names both
	run ethercat upload -p2 0x4001 0
	[ "$output" = "ethercat upload: Master0 slave 2: SDO upload 0x4001:00: no CoE mailbox" ]
	err upload -j -p2 0x4001 0 | json 'd["error"]["reason"] == "SDO 0x4001:00 of slave 2: no CoE mailbox" and d["error"]["errno"] == 93'
	run ethercat upload -p2 -t uint8 0x1018 1
	[ "$status" -eq 1 ]
	[[ $output == *"uint8 has 1 byte(s), but 4 were received"* ]]
}

@test "hex for a type of characters is reported with the type that takes it" {
	export FAKE_LOG=$BATS_TEST_TMPDIR/log
	run ethercat download -p2 -t octet_string 0x2001 0 '0x12 0x34'
	[ "$status" -eq 0 ]
	[ "$output" = "warning: octet_string writes the characters '0x12 0x34'; --type raw writes these bytes" ]
	[ -z "$(err download -p2 -t octet_string 0x2001 0 '0x1g')" ]
	[ -z "$(err download -p2 -t string 0x2001 0 '0x12')" ]
	[ -z "$(printf 0x12 | err download -p2 -t octet_string 0x2001 0 -)" ]
}

@test "a number out of range is refused with the limits" {
	[[ $(err reg_write -p2 0x120 -t uint16 70000) == *"'70000' for type uint16: expected 0 to 65535"* ]]
	[[ $(err reg_write -p2 0x120 -t uint64 -1) == *": expected 0 to 18446744073709551615"* ]]
	[[ $(err reg_write -p2 0x120 -t int8 200) == *"'200' for type int8: expected -128 to 127"* ]]
	[[ $(err reg_write -p2 0x120 -t int64 99999999999999999999) == \
		*": expected -9223372036854775808 to 9223372036854775807"* ]]
	[[ $(err reg_write -p2 0x120 -t sm16 40000) == *": expected -32767 to 32767"* ]]
	[[ $(err debug 5) == *"invalid level '5': expected 0 to 2"* ]]
}

@test "download sends values of all types" {
	[ "$(log_of download -p2 -t uint32 0x1010 1 0x65766173)" = "sdo 2 0x1010:01 73617665" ]
	[ "$(log_of download -p2 -t string 0x2001 0 "ab cd")" = "sdo 2 0x2001:00 6162206364" ]
	[ "$(log_of download -p2 -t raw 0x2001 0 "0x12 0x34")" = "sdo 2 0x2001:00 1234" ]
	[ "$(log_of download -p2 -t int24 0x2001 0 -2)" = "sdo 2 0x2001:00 feffff" ]
	[ "$(log_of download -p2 -t sm16 0x2001 0 -1)" = "sdo 2 0x2001:00 0180" ]
	[ "$(log_of download -p2 -t string 0x2001 abc)" = "sdo 2 0x2001:00 C 616263" ]
	[ "$(printf abc | log_of download -p2 0x2001 -)" = "sdo 2 0x2001:00 C 616263" ]
	[ "$(log_of sdo_write -p2 -t uint8 0x2001:0a 7)" = "sdo 2 0x2001:0a 07" ]
	[ "$(printf 'a b\nc\0' | log_of download -p2 -t octet_string 0x2001 0 -)" = \
		"sdo 2 0x2001:00 6120620a6300" ]
	[ "$(echo 5 | log_of download -p2 -t uint16 0x2001 0 -)" = "sdo 2 0x2001:00 0500" ]
	[ -z "$(ethercat download -p2 -t uint8 0x2001 0 1 2>&1)" ]
	run ethercat download -p2 0x2001 0 1
	[ "$status" -eq 1 ]
	[[ $output == *"--type"* ]]
	run ethercat download -p2 -t uint32 0x1018 1 1
	[ "$status" -eq 1 ]
	[[ $output == *"aborted with code 0x06010002"* ]]
	run ethercat download -p2 -t uint8 0x2001 0 - </dev/null
	[ "$status" -eq 1 ]
}

@test "download without subindex and type writes nothing" {
	run log_of download -p2 0x1010 0x65766173
	[ "$status" -eq 1 ]
	[[ $output == *"without a subindex all of 0x1010 is written: give the subindex, or --type"* ]]
	[ ! -s "$BATS_TEST_TMPDIR/log" ]
}

@test "download without type makes two requests, and --timeout is the limit of each" {
	calls() {
		rm -f "$BATS_TEST_TMPDIR/calls"
		FAKE_CALLS=$BATS_TEST_TMPDIR/calls ethercat "$@" >/dev/null
		tr '\n' ' ' <"$BATS_TEST_TMPDIR/calls"
	}
	[ "$(calls download -p2 0x6060 0 -1)" = "info 1000 download 0 " ]
	[ "$(calls download -p2 -t int8 0x6060 0 -1)" = "download 0 " ]
	[ "$(calls sdo_download -p2 --timeout=20 0x6060 0 -1)" = "info 20000 download 20000 " ]
	[ "$(calls download -p2 -t int8 --timeout 0.25 0x6060 0 -1)" = "download 250 " ]
	[ "$(calls sdo_upload -p2 --timeout 60 -t uint32 0x1018 1)" = "upload 60000 " ]
	[ "$(calls upload -p2 0x1018 1 --timeout 2)" = "upload 2000 info 2000 " ]
	[ "$(calls soe_read -p2 --timeout 3 S-0-15)" = "soe 3000 " ]
	for s in 0 61 x 1s -1; do
		run ethercat upload -p2 "--timeout=$s" 0x1018 1
		[ "$status" -eq 1 ]
		[[ $output == *"--timeout"* ]]
	done
}

@test "upload and download take the type of the slave's dictionary" {
	[ "$(out upload -p2 0x6060 0)" = "0xff -1" ]
	out upload -j -p2 0x6060 0 | json 'd["type"] == "int8" and not d["type_guessed"]'
	[ "$(log_of download -p2 0x6060 0 -1)" = "sdo 2 0x6060:00 ff" ]
	run ethercat download -p2 0x6060 0 200
	[[ $output == *"invalid value '200' for type int8"* ]]
	# the entry is refused or of a type without name, or has another size than its value
	out upload -j -p2 0x6041 0 | json 'd["type"] == "uint16" and d["type_guessed"]'
	out upload -j -p2 0x1018 2 | json 'd["type"] == "raw" and d["type_guessed"]'
	run ethercat download -p2 0x5001 0 1
	[ "$status" -eq 1 ]
	[[ $output == *"the data type of 0x5001:00 is not known; give it with --type"* ]]
	run ethercat download -p2 0x6041 0 1
	[ "$status" -eq 1 ]
	[[ $output == *"0x6041:00 is absent in the dictionary of slave 2; "*"give --type"* ]]
	# one more transfer, and none where the EEPROM announces no SDO information
	transfers() {
		FAKE_COUNT=$BATS_TEST_TMPDIR/n out "$@" >/dev/null
		cat "$BATS_TEST_TMPDIR/n"
	}
	[ "$(transfers upload -p2 0x6060 0)" = $(($(transfers upload -p2 -tint8 0x6060 0) + 1)) ]
	[ "$(transfers upload -p1 0x6060 0)" = "$(transfers upload -p1 -tint8 0x6060 0)" ]
	[ "$(out upload -p1 0x6060 0)" = "0xff 255" ]
	out upload -j -p1 0x6060 0 | json 'd["type_guessed"]'
	run ethercat download -p1 0x6060 0 1
	[[ $output == *"the data type of 0x6060:00 is not known; give it with --type"* ]]
	[ "${#lines[@]}" = 2 ]
}

@test "latch sets the mode of the master's inputs only" {
	[ "$(log_of latch -p0 single)" = "$(printf 'reg 0 0x09a8 03\nreg 0 0x09a9 03')" ]
	[ "$(log_of latch -p2 single 2>/dev/null)" = "reg 2 0x09a8 03" ]
	[ "$(log_of latch -p2 continuous 2>/dev/null)" = "reg 2 0x09a8 00" ]
	[ "$(err latch -p2 single)" = "slave 2: latch 1 is controlled by the slave; mode unchanged" ]
	FAKE_LATCHES=slave run log_of latch -p2 single
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat latch: slave 2 controls both latch inputs itself; use its objects" ]
	[ ! -s "$BATS_TEST_TMPDIR/log" ]
}

@test "reg_rdwr writes a register and prints its old content" {
	[ "$(out reg_rdwr -p2 -t uint16 0x130 0x4321)" = "0x0012 18" ]
	[ "$(log_of reg_rdwr -p2 -t uint16 0x130 0x4321 | tail -n 1)" = "reg 2 0x0130 2143" ]
	[ "$(log_of reg_rdwr -p2 -t string 0x10 ab 4 | tail -n 1)" = "reg 2 0x0010 61620000" ]
	[ "$(log_of reg_rdwr -p2 -t int8 0x10 -1 | tail -n 1)" = "reg 2 0x0010 ff" ]
	out reg_rdwr -j -p2 -t uint8 0x130 0 | json 'd["value"] == 18 and d["address"] == 0x130'
	refuses() {	# ERROR ARGUMENT...
		local error=$1
		shift
		run ethercat reg_rdwr "$@"
		[ "$status" -eq 1 ]
		[[ $output == *"$error"* ]] || { echo "$output"; return 1; }
	}
	refuses 'missing option: --type' -p2 0 1
	refuses 'the value has 2 byte(s), not 1' -p2 -t string 0 ab 1
	refuses 'the value has 2 byte(s), not 4' -p2 -t uint16 0 1 4
	refuses '2 bytes at 0xffff are too many' -p2 -t uint16 0xffff 1
	refuses 'one datagram takes 1 to 1024 bytes' -p2 -t string 0 a 1025
	refuses 'the selection matches 3 of 3 slaves' -t uint8 0 1
}

@test "reg_read and reg_write print registers" {
	[ "$(out reg_read -p2 0x130 2)" = "0x12 0x00" ]
	[ "$(out reg_read -p2 -t uint16 0x130)" = "0x0012 18" ]
	[ "$(out reg_read -p2 0xffff 1)" = "0x77" ]
	[ "$(out reg_read -p2 -t octet_string 0 4096 | wc -c)" -eq 4096 ]
	[ "$(log_of reg_write -p1 -t uint16 0x10 0x1234)" = "reg 1 0x0010 3412" ]
	printf 'xyz' >"$BATS_TEST_TMPDIR/f"
	[ "$(log_of reg_write -p1 0x1000 "$BATS_TEST_TMPDIR/f")" = "reg 1 0x1000 78797a" ]
	[ "$(log_of reg_write -e -p7 -t uint8 0x40 1)" = "reg 7 0x0040 emergency 01" ]
	run ethercat reg_write -e -t uint8 0x40 1
	[ "$status" -eq 1 ]
	run ethercat reg_write -p1 0x1000 "$BATS_TEST_TMPDIR/none"
	[ "$status" -eq 1 ]
	cd "$BATS_TEST_TMPDIR"
	[[ $(err reg_write -p1 0x120 2) == *"cannot open 2: No such file or directory; DATA without "* ]]
	[ "$(log_of crc reset | wc -l)" -eq 3 ]
	[ "$(log_of crc RESET -p1)" = "reg 1 0x0300 $(printf '0%.0s' {1..40})" ]
}

@test "states prints AL states" {
	[ "$(log_of states SAFEOP -p0,1)" = $'state 0 4\nstate 1 4' ]
	[ "$(log_of states preop | wc -l)" -eq 3 ]
	run ethercat states OP -p0 --wait
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	run ethercat states SAFEOP -p2 --wait 2
	[ "$status" -eq 1 ]
	[[ $output == *"slave 2: cannot reach SAFEOP, it is in PREOP+ERROR: SAFEOP refused: AL"*"0x001e (inputs)" ]]
	run ethercat states OP -p2 --wait=0.05
	[ "$status" -eq 1 ]
	[[ $output == *"has not reached OP"* ]]
	run ethercat states
	[ "$status" -eq 0 ]
	[ "${lines[0]}" = "0     0:0  PREOP" ]
	[ "${lines[1]}" = "1  1001:0  PREOP" ]
	[[ ${lines[2]} == "2  1001:1  PREOP+ERROR  AL status code 0x001d: "*": SM2 has 8 bytes"* ]]
	FAKE_BUS=two run ethercat states -p1
	[ "$output" = $'Master0\n  1  1001:0  PREOP\nMaster1\n  1  1001:0  PREOP' ]
}

@test "startup IDNs are shown; an older module without them is shown as unknown" {
	export FAKE_BUS=app
	out config -j | json '["S-0-0015", "P-0-0150"] in [[i["name"] for i in c["idns"]] for c in d["masters"][0]["configs"]]'
	out config -v | grep -q 'Drive 1, P-0-0150, 2 byte, in SAFEOP$'
	[ -z "$(FAKE_NO_IDN=1 out config -v | grep 'IDN configuration')" ]
	FAKE_NO_IDN=1 out config -j | json 'd["masters"][0]["configs"][0]["idns"] is None'
}

@test "commands for steps are shown; an older module without them is shown as unknown" {
	export FAKE_BUS=app
	out config -v | grep -A2 'Commands for transitions:$' |
		grep -qx '  INIT to PREOP: register 0x0f80, 2 byte'
	out config -v | grep -qx '  PREOP to SAFEOP: SDO 0x8000:03, 4 byte, time limit 250 ms'
	out config -v | grep -qx '  SAFEOP to OP: IDN of drive 1, 0x005b, 4 byte, time limit 0 ms'
	out config -v | grep -qx '  OP to SAFEOP: SDO 0x2000 C, 1040 byte'
	out config -j | json '[(x["step"], x["write_hex"] or x["mask_hex"]) for x in
		d["masters"][0]["configs"][0]["commands"]][:3] == [("INIT to PREOP", "0102"),
		("PREOP to SAFEOP", "01020304"), ("SAFEOP to OP", "05060708")]'
	out config -j | json '[(x["timeout_ms"], x["expect_hex"], x["mask_hex"]) for x in
		d["masters"][0]["configs"][0]["commands"]][:2] == [(None, None, None),
		(250, "05060708", "090a0b0c")]'
	out config -j | json 'd["masters"][0]["configs"][1]["commands"] == []'
	[ -z "$(FAKE_NO_COMMAND=1 out config -v | grep 'Commands')" ]
	FAKE_NO_COMMAND=1 out config -j |
		json 'd["masters"][0]["configs"][0]["commands"] is None'
}

@test "writes of the application are shown, with the reason why one is not replayed" {
	export FAKE_BUS=app
	out config -v | grep -A5 'Writes of the application:$' | grep -qx '  SDO 0x8000:02, 2 byte'
	out config -v | grep -qx '  3 older ones, not listed'
	out config -v | grep -qx '  SDO 0x6040:00, 2 byte, not replayed: control word'
	out config -v | grep -qx '  SDO 0x2000 C, 0 byte, not replayed: unknown reason'
	out config -v | grep -qx '  IDN of drive 1, 0x005b, 4 byte'
	out config -v | grep -qx '  register 0x0420, 2 byte'
	out config -j | json '[w["not_replayed"] for w in
		d["masters"][0]["configs"][0]["writes"]] == [None, "control word", "unknown reason",
		None, None]'
	out config -j | json 'd["masters"][0]["configs"][1]["writes"] == []'
	[ -z "$(FAKE_NO_WRITE=1 out config -v | grep 'Writes')" ]
	FAKE_NO_WRITE=1 out config -j | json 'd["masters"][0]["configs"][0]["writes"] is None'
}

@test "a running scan is noted on stderr" {
	[[ $(FAKE_BUS=scanning err slaves) == *"scan is running"* ]]
	# on a terminal at most 2 s for the first one
	[ -z "$(FAKE_BUS=fresh out slaves)" ]
	FAKE_BUS=fresh run script -qec "$HERE/build/fake/ethercat slaves" /dev/null
	[ "$status" -eq 0 ]
	[ "$(tr -d '\r' <<<"$output")" = "$(out slaves)" ]
	SECONDS=0
	FAKE_BUS=unread run script -qec "$HERE/build/fake/ethercat slaves" /dev/null
	[ "$status" -eq 0 ]
	[ "$SECONDS" -ge 1 ]
	[ "$SECONDS" -le 20 ]
	SECONDS=0
	FAKE_BUS=waiting run script -qec "$HERE/build/fake/ethercat slaves" /dev/null
	[ "$SECONDS" -le 1 ]
	[ "$(FAKE_BUS=scanning out slaves | wc -l)" -eq 1 ]
	[ "$(FAKE_BUS=scanning out slaves --wait | wc -l)" -eq 3 ]
	[ -z "$(FAKE_BUS=scanning err slaves --wait 5)" ]
	run env FAKE_BUS=scanning "$HERE/build/fake/ethercat" slaves --wait 0
	[ "$status" -eq 1 ]
}

@test "a missing interface or slave is reported" {
	[ -z "$(FAKE_BUS=waiting out slaves)" ]
	[[ $(FAKE_BUS=waiting err slaves) == *"waiting for eth0"* ]]
	FAKE_BUS=waiting run ethercat upload 0x1018 1
	[ "$status" -eq 1 ]
	[[ $output == *"no slaves: no network interface yet, waiting for eth0" ]]
	[[ $(FAKE_BUS=waiting out master) == *"Waiting for device(s)..."* ]]
	FAKE_BUS=empty run ethercat sii_read
	[ "$status" -eq 1 ]
	[[ $output == *"no slaves" ]]
}

@test "debug, rescan and release report their result" {
	[ "$(log_of rescan)" = "rescan 0" ]
	[ "$(log_of rescan --wait)" = "rescan 0" ]
	[ "$(log_of slaves --retry 2>/dev/null | grep rescan)" = "rescan 0" ]
	[ -z "$(log_of slaves | grep rescan)" ]
	run ethercat slaves --retry
	[ "$status" -eq 0 ]
	run ethercat rescan --wait=0
	[ "$status" -eq 1 ]
	[[ $output == *"has not finished after 0 s"* ]]
	[ "$(FAKE_BUS=two log_of debug 2)" = $'debug 0 2\ndebug 1 2' ]
	[ "$(out debug)" = "Master0: debug level 0" ]
	FAKE_READONLY=1 out debug --json | json 'd["masters"] == [{"master": 0, "debug_level": 0}]'
	FAKE_READONLY=1 run ethercat rescan
	[ "$status" -eq 1 ]
	[ "$(FAKE_BUS=detached log_of release)" = "release 0" ]
	run ethercat release
	[ "$status" -eq 1 ]
	[[ $output == *"Master0: cannot end the session: "*"master 0 has no session"* ]]
	FAKE_BUS=two run ethercat release
	[ "$status" -eq 1 ]
}

@test "a session without its application" {
	[[ $(FAKE_BUS=detached out master) == *$'Active: yes\n  Session: detached'* ]]
	[ -z "$(out master | grep Session:)" ]
}

@test "binary output is refused on a terminal" {
	[ "$(FAKE_BUS=app out data | xxd -p)" = a501020304 ] || \
		[ "$(FAKE_BUS=app out data | xxd -p)" = a50102030405ff ]
	[ "$(FAKE_BUS=app out data -d1 | xxd -p)" = 0102030405ff ]
	[ "$(out sii_read -p2 | wc -c)" -eq 160 ]
}

@test "a slave that is connected by another port than 0" {
	export FAKE_BUS=reversed
	local g
	g=$(out graph dc)
	[[ $g == *'master -- slave2 [label="MII", weight="1", headlabel="1 [0]"]'* ]]
	[[ $g == *'slave0 -- slave2 ['*'taillabel="0 [0]", headlabel="0 [145]"]'* ]]
	[[ $g == *'slave0 -- slave1 ['* ]]
	[[ $g != *'slave1 -- slave2'* ]]
	out graph -j | json '[(l["from"], l["to"]) for l in d["links"]] == [(0, 2), (0, 1)]'
	[[ $(out slaves -v -p2) == *"DC state: delay unreliable, receive times"* ]]
	out slaves -j -p2 | json 'd["masters"][0]["slaves"][0]["dc_state"] == "delay_uncertain"'
}

@test "graph prints nodes and links" {
	command -v dot >/dev/null || skip "no graphviz"
	for a in "" dc crc; do
		out graph $a | dot -Tsvg >/dev/null
	done
}

@test "the etherlab skin prints MATLAB functions" {
	golden pdos_etherlab pdos -p2 -s etherlab
}

@test "a slave that differs from its configuration is marked" {
	[ "$(FAKE_BUS=differs out slaves | awk '{ print $4 }' | tr -d '\n')" = '+!E' ]
	FAKE_BUS=differs out slaves -v -p1 | grep -qx "  Not in OP: no slave at ring position 2: 2 slave(s) connected"
	FAKE_BUS=differs out slaves -v -p1 | grep -qx "  Warning: process data of SM2 may belong to other objects"
	FAKE_BUS=differs out --json slaves | python3 -c '
import json, sys
s = json.load(sys.stdin)["masters"][0]["slaves"]
assert [x["differs"] for x in s] == [False, True, False], s
assert s[1]["not_in_op"].startswith("no slave at ring") and s[0]["not_in_op"] is None
assert s[1]["warning"].startswith("process data") and s[0]["warning"] == ""
'
}

@test "configured slaves that are missing are named beside the list" {
	[ "$(FAKE_BUS=app err slaves)" = "Master0: configuration 0:2: no slave at ring position 2: 2 slave(s) connected" ]
}
