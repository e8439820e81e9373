# SPDX-License-Identifier: GPL-2.0-only
# Every command of the tool on the bench without an application.

load helpers

setup_file() { start bench 22; }

teardown_file() { stop; }

@test "version names tool and module" {
	run ethercat version
	[ "${#lines[@]}" = 1 ]
	[[ "$output" =~ ^"EtherCAT master "[0-9]+\.[0-9]+ ]]
	json '.abi == 3 and (.version | test("^[0-9]+[.]"))' version
}

@test "master shows phase, device and clocks" {
	run ethercat master -v
	[ "$status" = 0 ]
	[ "${lines[0]}" = "Master0" ]
	[ "${lines[1]}" = "  Phase: Idle" ]
	[ "${lines[2]}" = "  Active: no" ]
	[ "${lines[3]}" = "  Slaves: 22" ]
	[[ "${lines[5]}" =~ ^"    Main: "([0-9a-f]{2}:){5}[0-9a-f]{2}" (attached)"$ ]]
	[ "${lines[6]}" = "      Link: UP" ]
	[[ "$output" == *"Lost frames: 0"* ]]
	[[ "$output" == *"Slaves responding: 22"* ]]
	json '.masters | length == 1 and (.[0] | .phase == "idle" and .slaves == 22 and
		.slaves_responding == 22 and .scan_busy == false and .scans >= 1 and
		.devices[0].attached and .devices[0].link_up and .devices[0].interface == "sim0" and
		.common.lost_frames == 0 and .common.tx_frames > 0 and
		.common.rx_frames <= .common.tx_frames and .dc.reference_clock == 0)' master
}

@test "slaves lists position, state and name" {
	run ethercat slaves
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 22 ]
	[ "${lines[0]}" = " 0     1:0  PREOP  +  EK1100 Coupler" ]
	[ "${lines[11]}" = "11  1001:0  PREOP  +  EL2008 8-ch output" ]
	[ "${lines[14]}" = "14  1001:3  PREOP  +  EL4002 2-ch analog output 0-10 V" ]
	[ "$(ethercat slaves -p4-5,1)" = "$(printf '%s\n' \
		'1  1:1  PREOP  +  EL1859 8-ch input, 8-ch output' \
		'4  1:4  PREOP  +  EL7201 servo terminal' \
		'5  1:5  PREOP  +  EL7201 servo terminal')" ]
	[ "$(ethercat slaves -a1001 | wc -l)" = 4 ]
	[ "$(ethercat slaves -a1001 -p3 | awk '{ print $1 }')" = 14 ]
	refused 'the selection matches no slave' slaves -p22-
	json '.masters[0].slaves | length == 22 and all(.[]; .state == "PREOP" and
		(.al_error | not) and (.flag_error | not)) and .[11].alias == 1001 and
		.[4].mailboxes.protocols == ["CoE", "FoE"] and .[0].ports[2].next_slave == 15' slaves
}

@test "slaves --verbose shows identity, clock and mailbox" {
	run ethercat slaves -v -p4
	[ "$status" = 0 ]
	[ "${lines[0]}" = "=== Master 0, Slave 4 ===" ]
	[ "${lines[1]}" = "Device: Main" ]
	[ "${lines[2]}" = "State: PREOP" ]
	[ "${lines[3]}" = "Flag: +" ]
	[ "${lines[5]}" = "  Vendor Id:       0x00000002" ]
	[ "${lines[6]}" = "  Product code:    0x1c213052" ]
	[[ "$output" == *"Distributed clocks: yes, 64 bit"* ]]
	[[ "$output" =~ "   0  EBUS  up    open    yes             3" ]]
	[[ "$output" == *"  Standard  RX: 0x1000/256, TX: 0x1100/256"* ]]
	[[ "$output" == *"  Device name: EL7201 servo terminal"* ]]
	[[ "$output" == *"    Enable SDO: yes"* ]]
	[ "$(ethercat slaves -v | grep -c '^=== Master 0, Slave [0-9]* ===$')" = 22 ]
	# four rows of ports each
	[ "$(ethercat slaves -v | grep -cE '^   [0-3]  (EBUS|MII |N/A |N/C )  (up  |down)  (open  |closed)')" = 88 ]
}

@test "pdos lists SyncManagers, PDOs and entries" {
	[ "$(ethercat pdos -p10)" = "$(printf '%s\n' \
		'SM0: PhysAddr 0x1000, DefaultSize    1, ControlRegister 0x00, Enable 1' \
		'  TxPDO 0x1a00 "Channel 1"' '    PDO entry 0x6000:01,  1 bit, "Input"' \
		'  TxPDO 0x1a01 "Channel 2"' '    PDO entry 0x6010:01,  1 bit, "Input"' \
		'  TxPDO 0x1a02 "Channel 3"' '    PDO entry 0x6020:01,  1 bit, "Input"' \
		'  TxPDO 0x1a03 "Channel 4"' '    PDO entry 0x6030:01,  1 bit, "Input"')" ]
	run ethercat pdos -p4
	[ "${#lines[@]}" = 12 ]
	[ "${lines[2]}" = "SM2: PhysAddr 0x1200, DefaultSize    6, ControlRegister 0x24, Enable 1" ]
	[ "${lines[3]}" = '  RxPDO 0x1600 "DRV Controlword"' ]
	[ "${lines[4]}" = '    PDO entry 0x7010:01, 16 bit, "Controlword"' ]
	[ "$(ethercat pdos -q -p4 | wc -l)" = 8 ]
	# couplers have no sync managers and get no header
	[ "$(ethercat pdos -q | grep -c '^=== Master 0, Slave')" = 18 ]
	json '.masters[0].slaves[0].sync_managers[2].pdos[0] | .index == 5632 and
		.direction == "rx" and .entries[0].size_bits == 16' pdos -p4
	ethercat pdos -s etherlab -p4 | grep -q "function rv = slave4()"
}

@test "upload reads objects of all types" {
	[ "$(ethercat upload -p4 0x1018 1)" = "0x00000002 2" ]
	[ "$(ethercat -p 4 sdo_upload --type uint32 0x1018:02)" = "0x1c213052 471937106" ]
	[ "$(ethercat upload -a1 -p4 0x1018 1)" = "0x00000002 2" ]
	[ "$(ethercat upload -p4 -t string 0x1008 0)" = "EL7201" ]
	json '.value == 2 and .data_hex == "02000000" and .position == 4' upload -p4 0x1018 1
	# complete access: the number of entries, a gap, then the entries
	[ "$(ethercat upload -p17 -t raw 0x1018 | cut -d' ' -f1-6)" = "0x04 0x00 0x51 0xec 0x00 0x00" ]
}

@test "download writes objects of all types" {
	ethercat download -p17 -t int8 0x6060 0 -1
	[ "$(ethercat upload -p17 -t int8 0x6060 0)" = "0xff -1" ]
	echo 8 | ethercat sdo_download -p17 -t int8 0x6060 0 -
	[ "$(ethercat upload -p17 0x6060 0)" = "0x08 8" ]
	[ -z "$(ethercat download -p17 -t int8 0x6060 0 0 2>&1)" ]
	json '.index == 24672 and .size_bytes == 1' download -p17 -t int8 0x6060 0 8
}

@test "a slave refuses an SDO: abort code with its text" {
	refused 'slave 17: SDO upload 0x9999:00 aborted with code 0x06020000: .*object' \
		upload -p17 0x9999 0
	refused 'aborted with code 0x06090011: .*subindex' upload -p17 0x1018 77
	refused 'SDO download 0x1018:01 aborted with code 0x06010002: .*read' \
		download -p17 -t uint32 0x1018 1 5
	refused 'aborted with code 0x0607001' download -p17 -t uint32 0x6060 0 5
	refused 'slave 0: SDO upload 0x1018:01: no CoE mailbox$' upload -p0 0x1018 1
	refused 'uint8 has 1 byte.*4 were received' upload -p4 -t uint8 0x1018 1
	ethercat states INIT -p17 --wait
	refused 'PREOP' upload -p17 0x1018 1
	ethercat states PREOP -p17 --wait
	rc=0
	ethercat upload -j -p17 0x9999 0 2>"$BATS_TEST_TMPDIR/err" >/dev/null || rc=$?
	[ "$rc" = 1 ]
	gojq -e '.error | .abort_code == 100794368 and .command == "upload"' "$BATS_TEST_TMPDIR/err"
}

@test "states requests and shows AL states" {
	run ethercat states -p3,11
	[ "$output" = "$(printf '%s\n' ' 3     1:3  PREOP' '11  1001:0  PREOP')" ]
	run ethercat states INIT -p1,4,17 --wait
	[ "$status" = 0 ]
	[ -z "$output" ]
	[ "$(ethercat slaves | grep -c INIT)" = 3 ]
	ethercat states preop
	wait_for 120 all_slaves_are PREOP 22
	json '.masters[0].slaves | length == 22 and .[0].state == "PREOP"' states
	json '.masters[0].slaves | length == 1 and .[0].state == "INIT"' states INIT -p2 --wait
	ethercat states PREOP -p2 --wait
}

@test "states fails when a slave refuses" {
	# no application has configured its process data
	refused 'slave 4: cannot reach OP, it is in SAFEOP: .*AL status code 0x[0-9a-f]{4} \(.+\)' \
		states OP -p4 --wait
	[[ "$(ethercat slaves -p4)" == "4  1:4  SAFEOP  E  EL7201"* ]]
	ethercat slaves -v -p4 | grep -q '^  Cause: OP refused: AL status code 0x'
	ethercat states -p4 | grep -q '^4  1:4  SAFEOP  .*0x00'
	json '.masters[0].slaves[0] | .flag_error and .cause != ""' states -p4
	ethercat states PREOP --wait
	[ "$(ethercat states -p4)" = "4  1:4  PREOP" ]
}

@test "sii_read writes the EEPROM image" {
	words=$(ethercat slaves -p4 -j | gojq '.masters[0].slaves[0].sii_words')
	ethercat sii_read -p4 >"$BATS_TEST_TMPDIR/sii"
	[ "$(wc -c <"$BATS_TEST_TMPDIR/sii")" = $((2 * words)) ]
	# vendor and product at word 8
	[ "$(xxd -s 16 -l 8 -p "$BATS_TEST_TMPDIR/sii")" = 020000005230211c ]
	run ethercat sii_read -p4 -v
	[ "$status" = 0 ]
	[ "${lines[0]}" = "SII Area:" ]
	[[ "$output" == *"SII Category 0x000a (STRINGS), "* ]]
	[[ "$output" == *"SII Category 0x0029 (SyncM), 16 words"* ]]
	json '.checksum_ok and .complete and .product_code == 471937106 and
		(.categories | map(.name) | contains(["General", "RXPDO"]))' sii_read -v -p4
}

@test "sii_write and alias write an EEPROM, and the master reads it again" {
	sii=$BATS_TEST_TMPDIR/sii
	ethercat sii_read -p4 >"$sii"
	json '.words_different == 0 and .words_written == 0' sii_write -p4 "$sii"
	json '.slaves[0] | .alias == 77 and .renewed' alias -p4 77
	[ "$(ethercat slaves -p4 | awk '{ print $2 }')" = 77:0 ]
	[ "$(ethercat sii_read -p4 | xxd -s 8 -l 2 -p)" = 4d00 ]
	cp "$sii" "$sii.bad"
	printf '\125' | dd of="$sii.bad" bs=1 seek=14 conv=notrunc 2>/dev/null
	refused 'checksum' sii_write -p4 "$sii.bad"
	# the alias and the checksum
	json '.words_different == 2 and .words_written == 0' sii_write -p4 --dry-run "$sii"
	json '.words_different == 2 and .words_written == 2 and .renewed' sii_write -p4 "$sii"
	[ "$(ethercat slaves -p4 | awk '{ print $2 }')" = 1:4 ]
	ethercat sii_read -p4 | cmp - "$sii"
	refused 'file' sii_write -p4 "$sii.none"
}

@test "datagram sends any command" {
	json '.working_counter == 22' datagram BRD 0x0130 2
	json '.working_counter == 1' datagram APWR 4 0x0f80 -t uint16 0x1234
	json '.working_counter == 3 and .value == 4660' datagram APRW 4 0x0f80 -t uint16 7
	json '.working_counter == 1 and .data_hex == "0700"' datagram APRD 4 0x0f80 2
	json '.working_counter == 0' datagram FPRD 0xfffe 0x0130 2
	refused 'unknown command' datagram XXRD 0x0130 2
}

@test "reg_read and reg_write access registers" {
	[ "$(ethercat reg_read -p1 -t uint16 0x0130)" = "0x0002 2" ]
	run ethercat reg_read -p1 0 4
	[[ "$output" =~ ^(0x[0-9a-f]{2} ){3}0x[0-9a-f]{2}$ ]]
	before=$(ethercat reg_read -p1 -t uint16 0x0420)
	ethercat reg_write -p1 -t uint16 0x0420 1234
	[ "$(ethercat reg_read -p1 -t uint16 0x0420)" = "0x04d2 1234" ]
	printf '\001\002' >"$BATS_TEST_TMPDIR/f"
	ethercat reg_write -p1 0x0420 "$BATS_TEST_TMPDIR/f"
	[ "$(ethercat reg_read -p1 0x0420 2)" = "0x01 0x02" ]
	printf '\003\004' | ethercat reg_write -e -p1 0x0420 -
	json '.value == 1027 and .data_hex == "0304" and .address == 1056' \
		reg_read -p1 -t uint16 0x0420
	json '.size_bytes == 2' reg_write -p1 -t uint16 0x0420 "${before#* }"
	refused 'expected 0 to 0xffff' reg_read -p1 0x10000 1
	refused 'registers end at 0xffff' reg_read -p1 0xffff 2
	refused 'cannot read register 0xfff0.*slave 1 did not execute access to 0xfff0' reg_read -p1 0xfff0 16
	refused 'refused|no slave|not there|did not' reg_write -e -p99 -t uint8 0x0420 1
}

@test "reg_rdwr writes a register and shows its old content" {
	ethercat reg_write -p1 -t uint16 0x0420 1234
	[ "$(ethercat reg_rdwr -p1 -t uint16 0x0420 77)" = "0x04d2 1234" ]
	[ "$(ethercat reg_rdwr -p1 -t octet_string 0x0420 A 2 | od -An -tx1)" = " 4d 00" ]
	[ "$(ethercat reg_read -p1 -t uint16 0x0420)" = "0x0041 65" ]
	refused 'exchange register 0xfff0.*access to 0xfff0: working counter 0, expected 3' \
		reg_rdwr -p1 -t uint8 0xfff0 1
}

@test "a wrong selection is refused with a reason" {
	refused 'matches 22 of 22 slaves' upload 0x1018 1
	refused 'matches 0 of 22 slaves' upload -p22 0x1018 1
	refused 'matches 0 of 22 slaves' reg_read -a77 0 1
	refused 'invalid list' slaves -p 1x
	refused 'no such master, there is only master 0' reg_read -m3 -p0 0 1
}

@test "rescan starts a scan and waits for its end" {
	before=$(ethercat master -j | gojq '.masters[0].scans')
	run ethercat rescan --wait
	[ "$status" = 0 ]
	[ -z "$output" ]
	after=$(ethercat master -j | gojq '.masters[0].scans')
	[ "$after" -gt "$before" ]
	wait_for 120 all_slaves_are PREOP 22
	json '.masters == [{"master": 0}]' rescan
	ethercat slaves --wait >/dev/null
	wait_for 120 all_slaves_are PREOP 22
}

@test "debug sets the log level" {
	ethercat debug 1
	json '.masters[0].debug_level == 1' master
	json '.masters == [{"master": 0, "debug_level": 0}]' debug 0
	refused 'invalid level' debug 3
}

@test "graph prints the topology" {
	for a in "" DC crc; do
		run ethercat graph $a
		[ "$status" = 0 ]
		[ "$(grep -c -- ' -- ' <<<"$output")" = 22 ]
		[ "$(grep -c '^	slave[0-9]* \[' <<<"$output")" = 22 ]
		[ "${lines[-1]}" = "}" ]
	done
	ethercat graph | grep -q '^	slave0 -- slave15 \[label="MII", weight="1", taillabel="2", headlabel="0"\]$'
	ethercat graph dc | grep -q 'DC: 64 bit'
	json '(.links | length == 21) and (.slaves | length == 22)' graph
}

@test "crc shows and clears error counters" {
	run ethercat crc
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 24 ]
	[[ "${lines[3]}" == "  1|  0   0   0   ↑|  0   0   0   ↓|               |               |EL1859 8-ch" ]]
	ethercat crc reset
	json '.slaves | length == 22 and all(.[].ports[]; .crc_errors == 0)' crc
}

@test "graph --tree prints lines of slaves and their branches" {
	run ethercat graph --tree
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 23 ]
	[[ "${lines[0]}" == "Master0: main device "*", link up" ]]
	line='0    MII   PREOP  ports 0 1 2 -  0 ns'
	[[ "${lines[1]}" =~ ^"├─  0  EK1100 Coupler "+"$line"$ ]]
	line='  1>0  EBUS  PREOP  ports 0 1 - -  '
	[[ "${lines[2]}" =~ ^"│  ├─  1  EL1859 ".*"$line"[0-9]+" ns"$ ]]
	ethercat graph --tree | grep -qE '^├─ 15  .*  2>0  MII '
	json '.slaves | length == 22 and .[15].upstream == 0 and .[15].upstream_port == 2 and
		all(.[].ports[]; .crc_errors == 0)' graph crc --tree
}

# add: errors at port 0 of axis1, which is slave 4, until the command has ended
add() {
	while kill -0 "$1" 2>/dev/null; do
		echo 'errors axis1.0 add=2' >/sys/kernel/debug/ec_sim/sim0
		sleep 0.3
	done
}

@test "crc --watch names the segment where errors grow" {
	ethercat crc reset
	run ethercat crc --watch 0.5 -q
	[[ "$output" =~ ^"No error counter of a port has grown in 0.".*" s ("[0-9]+" frames)."$ ]]
	ethercat crc --watch 2 >"$BATS_TEST_TMPDIR/out" 3>&- &
	add $!
	cat "$BATS_TEST_TMPDIR/out"
	tail -n 1 "$BATS_TEST_TMPDIR/out" |
		grep '^Errors grow between slave 3 port 1 and slave 4 port 0: '
	ethercat crc reset
}

@test "dc shows the clocks, and their registers with --verbose" {
	run ethercat dc
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 24 ]
	[[ "${lines[0]}" == "Master0: reference clock slave 0"* ]]
	[[ "${lines[2]}" =~ ^"    0  64 bit "+"0 ".*"reference clock ".*EK1100 ]]
	[ "$(ethercat dc -v -p0 | grep -c '^    registers: difference 0 ns, ')" = 1 ]
	json '.masters[0] | .reference_clock == 0 and (.slaves | length == 22) and
		.slaves[21].dc_delay_ns > .slaves[1].dc_delay_ns' dc
}

@test "without an application nothing is configured" {
	for c in config "config -v" domains "domains -v" data; do
		run ethercat $c
		[ "$status" = 0 ]
		[ -z "$output" ]
	done
	json '.masters[0].configs == []' config
	json '.masters[0].domains == []' domains
	json '.masters[0].domains == []' data
}

@test "a user without write permission may look and change nothing" {
	as_nobody() { setpriv --reuid=65534 --regid=65534 --clear-groups "$EC_BUILD/tool/ethercat" "$@"; }
	for c in slaves master pdos "cstruct -p4" config domains "sii_read -p4 -v" graph states \
		"graph --tree" dc; do
		run as_nobody $c
		[ "$status" = 0 ]
	done
	[ "$(as_nobody slaves)" = "$(ethercat slaves)" ]
	for c in "upload -p4 0x1018 1" "reg_read -p4 0 1" "reg_write -p4 -t uint8 0 1" rescan \
		"alias -p4 5" "datagram BRD 0x0130 2" "states OP" "debug 1" \
		"download -p4 -t int8 0x6060 0 1" "crc reset" "crc --watch 1" "dc -v"; do
		run as_nobody $c
		[ "$status" = 1 ]
		[[ "$output" == *"/dev/EtherCAT0: Permission denied"* ]]
	done
}

@test "no interface, no slaves" {
	rmmod ec_sim
	[ -z "$(ethercat slaves 2>/dev/null)" ]
	[[ "$(ethercat slaves 2>&1)" == *"waiting for sim0"* ]]
	ethercat master | grep -q 'Phase: Waiting for device(s)...'
	refused 'no slaves: no network interface yet, waiting for sim0' upload 0x1018 1
	for c in slaves pdos cstruct config domains data graph; do
		ethercat $c -j 2>/dev/null | gojq -e . >/dev/null
	done
}

@test "two masters, one waits for its interface" {
	stop
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0,sim1
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=thin
	wait_for 120 all_slaves_are PREOP 2
	[ "$(ethercat slaves 2>/dev/null)" = "$(printf '%s\n' Master0 \
		'  0  0:0  PREOP  +  EK1100 Coupler' '  1  0:1  PREOP  +  EL2008 8-ch output' \
		Master1)" ]
	[ "$(ethercat slaves -m0 | wc -l)" = 2 ]
	[ -z "$(ethercat slaves -m1 2>/dev/null)" ]
	[ "$(ethercat master | grep -c '^Master')" = 2 ]
	json '.masters | map(.phase) == ["idle", "waiting"]' master
	refused '2 masters found, the command needs one' reg_read -p1 0 1
	ethercat reg_read -m0 -p1 0 1
	refused 'no slaves' reg_read -m1 0 1
	ethercat pdos | grep -q '=== Master 0, Slave 1 ==='
	ethercat debug -m 0-1 0
}

@test "a thousand slaves" {
	stop
	start line1000 1000
	json '.masters[0].slaves | length == 1000' slaves -p 0-999
	# from the first system call to the last, in the guest's time
	t0=$(date +%s%N)
	[ "$(ethercat slaves | wc -l)" = 1000 ]
	[ $((($(date +%s%N) - t0) / 1000000)) -lt 2000 ]
	[ "$(ethercat slaves -p 500)" = "500  0:500  PREOP  +  $(ethercat slaves -p 500 | cut -d+ -f2 | cut -c3-)" ]
	t0=$(date +%s%N)
	ethercat bus save "$BATS_TEST_TMPDIR/bus.yaml"
	t1=$(date +%s%N)
	[ "$(ethercat bus check "$BATS_TEST_TMPDIR/bus.yaml")" = "no difference, 1000 slave(s)" ]
	t2=$(date +%s%N)
	t2=$(((t2 - t1) / 1000000)) t1=$(((t1 - t0) / 1000000))
	echo "# bus file of 1000 slaves: written in $t1 ms, compared in $t2 ms (exact time)" >&3
	[ $t1 -lt 1000 ] && [ $t2 -lt 1000 ]
}

@test "bus check names place, cause and remedy of each difference to the file" {
	stop
	printf '%s\n' 'segment seed=3' 'slave c EK1100' 'slave out EL2008 alias=1001' \
		'slave a drive in=8 out=8 serial=7' 'slave b drive in=8 out=8 serial=8' \
		'branch none' 'slave other EL7201' 'branch none' 'slave more io in=8 out=8' \
		>"$BATS_TEST_TMPDIR/segment"
	start "$BATS_TEST_TMPDIR/segment" 4
	ethercat bus save --whole "$BATS_TEST_TMPDIR/bus.yaml"
	ethercat bus check "$BATS_TEST_TMPDIR/bus.yaml"
	sim=/sys/kernel/debug/ec_sim/sim0
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	# one more in the middle: no slave downstream of it differs
	printf '%s\n' 'unplug out.1' 'plug out.1 more.0' 'plug more.1 a.0' >$sim
	wait_for 20 all_slaves_are PREOP 5
	run ethercat bus check "$BATS_TEST_TMPDIR/bus.yaml"
	printf '# %s\n' "${lines[@]}" >&3
	[ "$status" = 1 ]
	[ "${#lines[@]}" -le 3 ]
	[[ $output == *"' extra: "*"remove it from the bus, or add it to the file"* ]]
	# another device in place of the last drive
	printf '%s\n' 'unplug more.1' 'unplug out.1' 'plug out.1 a.0' 'unplug a.1' \
		'plug a.1 other.0' >$sim
	wait_for 20 all_slaves_are PREOP 4
	run ethercat bus check "$BATS_TEST_TMPDIR/bus.yaml"
	printf '# %s\n' "${lines[@]}" >&3
	[ "$status" = 1 ]
	[[ $output == *EL7201* ]]
}

@test "bus save --whole and bus check read modules, startup values and clocks of slaves" {
	stop
	printf '%s\n' 'segment seed=3' 'slave c EK1100' \
		'slave m drive in=8 out=8 modules=0x119800,0,0x20192' 'slave a EL7201' \
		>"$BATS_TEST_TMPDIR/segment"
	start "$BATS_TEST_TMPDIR/segment" 3
	f=$BATS_TEST_TMPDIR/bus.yaml
	ethercat bus save --whole "$f"
	grep -F '{slot: 3, ident: 0x00020192}' "$f"
	grep -F 'type: int32' "$f"
	[ "$(ethercat bus check "$f")" = "no difference, 3 slave(s)" ]
	# another module, and what the master has to write in PREOP
	sed -i 's/0x00020192/0x00020193/
		/type: "drive"/a\        startup: [{at: safeop, sdo: 0x10f1:02, data: "09 00"}]' "$f"
	run ethercat bus check "$f"
	printf '# %s\n' "${lines[@]}" >&3
	[ "$status" = 1 ]
	[[ $output == *"module in slot 3 differs: expected ident 0x00020193, found ident 0x00020192; "* ]]
	[[ $output == *"startup 0x10f1:02 pending: expected 09 00, found 04 00; "* ]]
	[ "${lines[2]}" = "1 difference(s)" ]
	ethercat download -p1 -t uint16 0x10f1 2 9
	# 0xF030 as the slave has it, and otherwise
	ethercat download -p1 -t uint32 0xf030 1 0x119800
	ethercat states -p1 SAFEOP
	modules_differ() { ethercat slaves -v -p1 | grep "AL status code 0x0070"; }
	wait_for 10 modules_differ
	ethercat download -p1 -t uint32 0xf030 3 0x20192
	ethercat states -p1 SAFEOP
	wait_for 10 all_slaves_are SAFEOP 1
}

@test "bus save --whole of 500 drives, with time on the wire" {
	stop
	printf '%s\n' 'segment seed=3' 'repeat 500 slave d drive' >"$BATS_TEST_TMPDIR/segment"
	start "$BATS_TEST_TMPDIR/segment" 500
	t0=$(date +%s%N)
	ethercat bus save --whole "$BATS_TEST_TMPDIR/bus.yaml"
	t1=$(date +%s%N)
	[ "$(ethercat bus check "$BATS_TEST_TMPDIR/bus.yaml")" = "no difference, 500 slave(s)" ]
	t2=$(date +%s%N)
	ethercat bus diff "$BATS_TEST_TMPDIR/bus.yaml" "$BATS_TEST_TMPDIR/bus.yaml"
	t3=$(date +%s%N)
	echo "# 500 drives: saved in $(((t1 - t0) / 1000000)) ms, compared in" \
		"$(((t2 - t1) / 1000000)) ms, files in $(((t3 - t2) / 1000000)) ms" >&3
	[ $(((t3 - t2) / 1000000)) -lt 2000 ]
}

@test "without the module the error names the remedy" {
	stop
	refused '/dev/EtherCAT0: No such file or directory: start the masters' slaves
	refused 'modprobe ec_master' upload -p1 0x1018 1
	# loaded without a master: to load it once more does nothing
	insmod "$EC_BUILD/modules/master/ec_master.ko"
	refused 'ec_master is loaded without this master: ' slaves
	rmmod ec_master
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0
	ethercat why | grep "Remedy: load the simulated segment: 'modprobe ec_sim"
	rmmod ec_master
	ethercat version
	ethercat help >/dev/null
}
