#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

setup() { export FAKE_BUS=app FAKE_READONLY=1; }

# causes WHY: names of the findings, in order
causes() {
	FAKE_WHY=$1 out why --json | python3 -c '
import json, sys
print(*[f["cause"] for f in json.load(sys.stdin)["masters"][0]["findings"]])'
}

# is WHY EXPRESSION: of its only finding f
is() {
	FAKE_WHY=$1 out why --json | json "(lambda f: $2)(d['masters'][0]['findings'][0])"
}

@test "why is silent and exits with 0 when all slaves are in OP" {
	FAKE_WHY=well run ethercat why
	[ "$status" -eq 0 ]
	[ "$(wc -l <<<"$output")" = 2 ]
	[[ $output == "All is well. Checked: link, cycle, 3 slaves, 2 configurations, 2 of "* ]]
	[[ $output == *"application active."* ]]
	[[ $output == *"Not checked: error counters of the ports; reading them needs write"* ]]
	FAKE_WHY=well out why -j | json 'd["masters"][0]["well"] and not d["masters"][0]["findings"]'
}

@test "why: a master without application is well" {
	FAKE_BUS=idle FAKE_WHY=well run ethercat why
	[ "$status" -eq 0 ]
	[[ $output == "All is well."*"no application: no slave has to be in OP."* ]]
}

@test "why names each cause once and exits with 1" {
	for c in no_device link_down no_slaves no_cycle cycle_too_short cable different \
		wrong_place missing no_alias ring_place group_absent group_not_started \
		not_requested boot no_reply sdo mailbox \
		pdo al_refused watchdog al_timeout sync working_counter; do
		[ "$(causes $c)" = $c ] || { echo "$c: $(causes $c)"; false; }
		FAKE_WHY=$c run ethercat why
		[ "$status" -eq 1 ] || { echo "$c: $output"; false; }
		[[ $output == "Fault: "*"  Remedy: "*"1 fault."* ]]
	done
	[[ $(FAKE_WHY="cable overruns" out why) == *"1 fault, 1 warning. Checked: "* ]]
	[[ $(FAKE_WHY="cancelled stall_zero" out why) == *"2 faults. Checked: "* ]]
}

@test "why: under way is no fault, and exits with 1" {
	is under_way 'f["level"] == "under_way"'
	FAKE_WHY=under_way run ethercat why
	[ "$status" -eq 1 ]
	[[ $output == "Under way: AL state SAFEOP on the way to OP"*"No fault, 1 under way. "* ]]
	# a slave that cannot be read is read again and again
	[ "$(causes "eeprom scan")" = "scan eeprom" ]
	[ "$(causes "unreadable scan")" = eeprom ]
	# a link that is up again is not named as cut
	FAKE_WHY="cable scan" run ethercat why
	[ "$status" -eq 1 ]
	[[ $output == "Under way: slaves reply again, "*" behind port 1 of slave 1 (EL2008) reply as well; "* ]]
	[[ $output != *cable* && $output != *"link down"* ]]
}

@test "why says how remedies are done here" {
	is not_requested '"ethercat states OP -p 2" in f["remedy"]'
	is boot '"ethercat states PREOP -p 2" in f["remedy"]'
	is al_refused '"tries again by itself, at once with \x27ethercat states OP -p 2" in f["remedy"]'
	is stall_zero '(f["cause"], "kernel sends zeros" in f["text"]) == ("output_stall", True)'
	is stall_stop '(f["cause"], "has stopped the cycle" in f["text"]) == ("output_stall", True)'
	is unit_down '(f["cause"], f["level"]) == ("unit_failed", "fault")'
	is unit_down '"by its policy its outputs are zero and its slaves in SAFEOP" in f["text"]'
	is unit_stopped '"all slaves in SAFEOP" in f["text"]'
	is unit_lease 'f["cause"] == "unit_lease"'
	is unit_lease '"lease of 50 cycle(s); its outputs are held" in f["text"]'
	is no_authority '(f["cause"], f["level"]) == ("no_authority", "warning")'
	is no_authority '"unit axes has no authority: its outputs are zero" in f["text"]'
	is emergency '(f["slave"], f["code"]) == (2, 0x7305)'
	is emergency '"code 0x7305 (fault of encoder 1), error register" in f["text"]'
	is late_frames '"no slave or cable is at fault" in f["text"]'
	is late_frames '"cable" not in f["remedy"]'
	is lost_frames '"cable" not in f["remedy"]'
	# names, where a slave on the bus has them
	is wrong_place '"slave 2 is EL7201, 0x00000002/0x1c213052, configured is EK1100, " in f["text"]'
	# a frame that is late leaves counters incomplete, and blames no slave
	[ "$(causes "late_frames working_counter")" = late_frames ]
}

@test "why: a warning stops no slave and exits with 0" {
	for c in scan late_frames lost_frames emergency alias_twice overruns eeprom process_data \
		clock_off sync_cycle; do
		[ "$(causes $c)" = $c ] || { echo "$c: $(causes $c)"; false; }
		FAKE_WHY=$c run ethercat why
		[ "$status" -eq 0 ] || { echo "$c: $output"; false; }
		[[ $output == "Warning: "*"All is well except for the warnings."* ]]
	done
}

# drive WHY EXPRESSION: of the last finding f
drive() {
	FAKE_WHY="drive drive_error $1" out why --json |
		json "(lambda f: $2)(d['masters'][0]['findings'][-1])"
}

@test "why names drives (SoE) in error, with number and text, if it may ask them" {
	unset FAKE_READONLY
	[ "$(causes drive)" = link_errors ]
	[ "$(causes "drive drive_error")" = "link_errors drive_error" ]
	drive "" '(f["slave"], f["level"], f["code"]) == (2, "warning", 0xf00f2019)'
	drive "" '"drive 1 is in error: class 1 diagnostic (S-0-0011) 0x8080 (" in f["text"]'
	drive "" '"(overcurrent, manufacturer), number 0xf00f2019: \"F219" in f["text"]'
	drive "" '"\x1b" not in f["text"]'
	drive "" '"ethercat soe_command -p2 1 S-0-0099" in f["remedy"]'
	# one without a number
	drive old_drive 'f["code"] == 0x8080'
	drive old_drive '"0x8080 (overcurrent, manufacturer): \"" in f["text"]'
	FAKE_WHY="drive drive_error" FAKE_READONLY=1 run ethercat why
	[ "$status" -eq 0 ]
	[[ $output == *"Not checked: errors of drives (SoE) of 1 slave; asking them needs write "* ]]
}

@test "why gives place, code and the configurations that are affected" {
	is cable '(f["slave"], f["port"], f["affected"]) == (1, 1, ["0:2"])'
	is sdo '(f["slave"], f["config"], f["code"]) == (2, "0:2", 0x06020000)'
	is pdo '"SM2 configured: 0x1600(7010:01/16); SM2 of the slave: 0x1600(7010:01/16)" in f["text"]'
	is wrong_place '(f["slave"], f["config"]) == (0, "0:2")'
	is different '(f["slave"], f["config"]) == (2, "0:2")'
	is working_counter '(f["domain"], f["slave"]) == (1, None)'
	# wrong counters of two datagrams
	FAKE_WHY=cancelled run ethercat why
	[ "$status" -eq 1 ]
	[[ $output == "Fault: domain 1: working counter 3, expected 3 in sum, but not of each "* ]]
	is sync_cycle '(f["slave"], f["config"]) == (2, "0:2") and
		"SYNC0 time 1000000 ns and cycle of 1300 us" in f["text"]'
	is too_high '(f["cause"], f["domain"], f["slave"]) == ("working_counter", 1, None)'
	is too_high '"working counter 4, expected 3: more slaves answer" in f["text"]'
	is too_high '"as a user with access to registers" in f["remedy"]'
	is missing '(f["slave"], f["port"], f["config"]) == (2, 1, "0:3")'
	# another device is not meant, however similar its alias is
	is alias_other '(f["cause"], f["config"]) == ("no_alias", "11:2")'
	is alias_other '"EK1100" not in f["text"] + f["remedy"]'
	# far behind the end of the ring
	FAKE_FAR=1 is missing '(f["slave"], f["config"]) == (2, "0:9")'
	[[ $(FAKE_FAR=1 FAKE_WHY=missing out why) == "Fault: 7 slaves missing from position 3 on: the bus has 3, "* ]]
	is link_down '(f["slave"], f["affected"]) == (None, [])'
	[[ $(FAKE_WHY=cable out why) == *"  Place: slave 1 (EL2008), port 1"$'\n'"  Affected: 0:2"* ]]
}

@test "why has all PDOs of both lists, or says that there are more" {
	local one='( 0x16..\(7010:01/16\))' slave='SM2 of the slave: 0x1600\(7010:01/16\)$'
	local text='f["text"]) is not None'

	FAKE_PDOS=0 is pdo "re.search(r'SM2 configured: none; $slave', $text"
	FAKE_PDOS=16 is pdo "re.search(r'SM2 configured:$one{16}; $slave', $text"
	FAKE_PDOS=200 is pdo "re.search(r'SM2 configured:$one{30,}( 0x16..)? [.]{3}; $slave', $text"
}

@test "why: a domain that the application never queues is no fault of a slave" {
	[ "$(causes unsent)" = not_queued ]
	is unsent '(f["level"], f["domain"], f["slave"]) == ("fault", 1, None)'
	is unsent '"has not queued it in 100 cycles" in f["text"] and
		"ecrt_domain_queue()" in f["remedy"]'
	# its slaves wait for it
	[ "$(causes unsent_waits)" = not_queued ]
	is unsent_waits 'f["affected"] == ["0:2"]'
	# another fault of the slave stays
	[ "$(causes "unsent sdo")" = "not_queued sdo" ]
	# its first turn may come later, or no domain gets a frame
	[[ $(causes unsent_late) != *not_queued* ]]
	[ "$(causes "unsent no_cycle")" = no_cycle ]
	# a cycle of the kernel sends it in its turn
	[[ $(causes "unsent stall_zero") != *not_queued* ]]
}

@test "why: a SyncManager against its direction is named" {
	[ "$(causes direction)" = al_refused ]
	FAKE_SM_DIR=2 is direction '"; SM2 is configured for inputs, the slave has it for outputs" in f["text"]'
	FAKE_SM_DIR=2 is direction '"correct the direction" in f["remedy"]'
	is direction '"SM2" not in f["text"] and "manual" in f["remedy"]'
}

@test "why: some abort codes of a startup SDO have a remedy of their own" {
	is sdo '"correct or remove the startup SDO" in f["remedy"]'
	is local '"release the local control" in f["remedy"]'
	is length '"the length that the object has" in f["remedy"]'
}

@test "why reports no consequence of another cause" {
	[ "$(causes "link_down cable")" = link_down ]
	[ "$(causes "no_cycle working_counter")" = no_cycle ]
	[ "$(causes "cable working_counter")" = cable ]
	[ "$(causes "sdo working_counter")" = sdo ]
	[ "$(causes "no_reply lost_frames")" = no_reply ]
	[ "$(causes "cycle_too_short overruns")" = cycle_too_short ]
	[ "$(causes "sdo eeprom")" = "sdo eeprom" ]
}

@test "why: a slave without configuration has a cause as well" {
	[ -z "$(FAKE_BUS=idle causes id_loaded)" ]
	FAKE_BUS=idle FAKE_WHY=unreadable run ethercat why
	[ "$status" -eq 1 ]
	[[ $output == "Fault: SII read failed"*"Place: slave 0 (EK1100)"* ]]
}

@test "why SLAVE shows findings of this slave" {
	[[ $(FAKE_WHY=sdo out why 2) == "Fault: startup SDO 0x8010:03"* ]]
	[[ $(FAKE_WHY=sdo out why 0,1) == "The selection is well. 1 fault elsewhere: "* ]]
	[[ $(FAKE_WHY=sdo out why -p0) == "The selection is well. 1 fault elsewhere: "* ]]
	[[ $(FAKE_WHY=well out why 0,1) == "All is well. Checked: "* ]]
	FAKE_WHY=sdo out why 0 -j | json "d['masters'][0]['faults_elsewhere'] == 1"
	[[ $(FAKE_WHY=link_down out why 1) == "Fault: no link"* ]]
	FAKE_WHY=well run ethercat why 77
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat why: the selection matches no slave or configuration" ]
	FAKE_WHY=well out why 77 -j | json 'd["masters"][0]["well"] is None'
	FAKE_WHY=link_down out why 77 -j | json 'd["masters"][0]["well"] is False'
	[[ $(err why y) == *"invalid slave 'y': expected N, N-M, N-, -M or -"* ]]
	[[ $(err why 1 -p1) == *"SLAVE and --position exclude each other"* ]]
	# a slave that is not there is chosen by its configuration
	[[ $(FAKE_WHY=cable out why 2) == "Fault: no slave behind port 1"* ]]
}

@test "why reads error counters with write access only" {
	[ -z "$(causes well)" ]
	unset FAKE_READONLY
	[ "$(causes well)" = link_errors ]
	is well '(f["level"], f["slave"], f["port"]) == ("warning", 0, 1)'
	is both_ends '(f["slave"], f["port"]) == (0, 1) and ": 5 invalid frame(s), " in f["text"]'
	[ "$(causes both_ends)" = link_errors ]
	[[ $(FAKE_WHY=free_port out why) == *"at port 3 of slave 2 (EL7201), where nothing is connected now: 7 invalid frame(s), "*"find out what was connected there"* ]]
	FAKE_WHY=well run ethercat why
	[ "$status" -eq 0 ]
	[[ $output == *"between port 1 of slave 0 (EK1100) and slave 1 (EL2008): 3 invalid frame(s), "* ]]
	[[ $output != *"Not checked"* ]]
}

@test "why names the slave that answers in a domain without being in it" {
	unset FAKE_READONLY
	is too_high '(f["cause"], f["domain"], f["slave"]) == ("working_counter", 1, 0)'
	is too_high '"slave 0 (EK1100) answers too" in f["text"] and "states INIT" in f["remedy"]'
}

@test "why claims no check that it has not done" {
	unset FAKE_READONLY
	for c in no_device link_down no_slaves; do
		[[ $(FAKE_WHY=$c out why) == *$'\n'"1 fault. Checked: link; all else can be checked after the repair." ]]
	done
	[[ $(FAKE_BUS=mute FAKE_WHY=well out why) == *"Not checked: error counters of 1 slave without reply." ]]
	FAKE_BUS=mute FAKE_WHY=well out why -j |
		json "not d['masters'][0]['error_counters_read']"
	FAKE_WHY=well out why -j | json "d['masters'][0]['error_counters_read']"
}

@test "why names the module that a waiting master needs" {
	is no_device "'ec_generic' in f['remedy'] and 'ethercat device bind' in f['remedy']"
}

@test "why: the reason of an older module is shown as it is" {
	[ "$(causes older)" = not_in_op ]
	[[ $(FAKE_WHY=older out why) == "Fault: a reason of an older module"* ]]
}

@test "why.rst has each cause" {
	local doc=$HERE/../../Documentation/why.rst n=0

	for c in $(grep -ohE 'X\([A-Z_]+, "[a-z_]+"' "$HERE/../../lib/tools/why_texts.h" |
		cut -d'"' -f2); do
		grep -Eq '^(``[a-z]+``, )*``'"$c"'``' "$doc" || { echo "$c"; false; }
		n=$((n + 1))
	done
	[ $n -gt 30 ]
}

# what the tool shows, any program can have: the library knows it
@test "the tool speaks no ioctl, but for the size of its terminal" {
	run grep -nE 'EC_IOC_|uapi/' "$HERE"/../../tool/*.[ch]
	[ "$status" -eq 1 ]
	[ "$(grep -h '\<ioctl(' "$HERE"/../../tool/*.[ch] | grep -c TIOCGWINSZ)" = 1 ]
	[ "$(cat "$HERE"/../../tool/*.[ch] | grep -c '\<ioctl(')" = 1 ]
	[ -n "$(nm -D "$HERE/build/real/libethercat-tools.so" | grep -w ioctl)" ]
}

@test "why: absent slaves and closed ports have their place" {
	export FAKE_ABSENT=1
	run ethercat why
	[[ $output == *"Warning: behind port 2 of slave 0 (EK1100): 7 slaves disconnected, since 3.1 s, the first: slave 1 (EL2008); link "* ]]
	[[ $output == *"  Place: slave 0 (EK1100), port 2"* && $output == *"'ethercat rescan'"* ]]
	[[ $output == *"Warning: port 3 of slave 1 (EL2008) stays closed despite its link: no slave replies behind it"*"  Remedy: connect port 0 (IN) of a slave there, or remove the cable"* ]]
	FAKE_BORDER=1 run ethercat why
	[[ $output == *"Warning: port 2 of slave 1 (EL2008) stays closed despite its link: another alias or identification than the group (EL"*"3 slaves)"*"  Remedy: connect the right one, or 'ethercat slaves -p 1 --let-in 2'"* ]]
	# one finding for a port that configurations miss slaves behind
	[ "$(FAKE_WHY=cable out why | grep -c 'behind port 1 of slave 1')" = 1 ]
	[[ $(FAKE_WHY=cable out why) == *"Fault: behind port 1 of slave 1 (EL2008): 1 slave disconnected, since 5 min, the first: slave 2 (EL7201); link "* ]]
}
