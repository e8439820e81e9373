# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --timeout 600
# The master, and slaves that have no line in common with it or the simulator:
# tests/second/slaves.py, at the other end of a wire.

load helpers

SECOND=$BATS_TEST_DIRNAME/../second
export PYTHONDONTWRITEBYTECODE=1

# model FOLDER INTERFACE...: its slaves; what it says is in FOLDER
model() {
	# a slave answers at once, whoever else has something to do
	chrt -f 60 python3 "$SECOND/slaves.py" "$2" "$1" "${@:3}" >"$1/said" 3>&- &
	echo $! >"$1/pid"
	wait_for 60 grep -q ready "$1/said"
}

# no_faults FOLDER: the model ends, and the master did nothing that no master may do
no_faults() {
	kill "$(cat "$1/pid")"
	wait_for 20 grep -q frames "$1/said"
	cat "$1/said"
	grep -qE '^[0-9]+ frames, 0 faults$' "$1/said"
}

# master PARAMETER...: at veth0
master() {
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=veth0 "$@"
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	wait_for 60 all_slaves_are PREOP 3
}

setup_file() {
	local i

	modprobe veth
	for i in 0 2; do
		ip link add veth$i type veth peer name veth$((i + 1))
		ip link set veth$i up
		ip link set veth$((i + 1)) up
	done
	model "$BATS_FILE_TMPDIR" veth1
	master
}

teardown_file() {
	stop
	kill "$(cat "$BATS_FILE_TMPDIR/pid")" 2>/dev/null || true
	ip link del veth0
	ip link del veth2
}

# value SUBINDEX OPTION...
value() { ethercat upload -p2 "${@:2}" 0x2001 "$1"; }

@test "scan: identity, names, alias, states" {
	[ "$(ethercat slaves | tr -s ' ')" = "$(printf '%s\n' '0 2989:0 PREOP + Four outputs' \
		'1 2989:1 PREOP + Four inputs' '2 2989:2 PREOP + An axis')" ]
	json '[.masters[0].slaves[]] | map([.vendor_id, .product_code, .revision_number, .serial_number])
		== [[32343, 17476, 65537, 44], [32343, 13107, 65538, 0], [32343, 1026, 131075, 305419896]]' \
		slaves -v
}

@test "EEPROMs, byte by byte" {
	for i in 0 1 2; do
		ethercat sii_read -p$i >"$BATS_TEST_TMPDIR/sii"
		cmp -n "$(stat -c %s "$BATS_TEST_TMPDIR/sii")" "$BATS_TEST_TMPDIR/sii" "$BATS_FILE_TMPDIR/$i.bin"
	done
}

@test "registers" {
	[ "$(ethercat reg_read -p2 -t uint16 0x1000 2>&1 | wc -l)" = 1 ]
	[ "$(ethercat reg_read -p2 -t uint8 0x0000)" = "0x11 17" ]
	[ "$(ethercat reg_read -p0 -t uint8 0x0004)" = "0x01 1" ]
	# no such register: no working counter
	run ethercat reg_read -p1 -t uint32 0x0910
	[ "$status" != 0 ]
}

@test "SDO: values of all sizes, both ways" {
	[ "$(value 1 -t uint8)" = "0x81 129" ]
	[ "$(value 2 -t int16)" = "0xfffe -2" ]
	[ "$(value 3 -t uint32)" = "0xfedcba98 4275878552" ]
	[ "$(value 4 -t uint64)" = "0x0123456789abcdef 81985529216486895" ]
	[ "$(value 7 -t string)" = abc ]
	[ "$(ethercat upload -p2 -t string 0x1008 0)" = "Second model axis" ]
	ethercat download -p2 -t int16 0x2001 2 -- -1234
	[ "$(value 2 -t int16)" = "0xfb2e -1234" ]
	ethercat download -p2 -t uint64 0x2001 4 0xfedcba9876543210
	[ "$(value 4 -t uint64 | cut -d' ' -f1)" = 0xfedcba9876543210 ]
	# one byte to one that fills a message and one that does not, in segments
	for n in 1 4 5 7 8 166 176 177 240 241 247 248 249 486 487 488 1000 1024; do
		head -c "$n" /dev/urandom >"$BATS_TEST_TMPDIR/in"
		ethercat download -p2 -t octet_string 0x2000 0 - <"$BATS_TEST_TMPDIR/in"
		ethercat upload -p2 -t octet_string 0x2000 0 >"$BATS_TEST_TMPDIR/out"
		cmp "$BATS_TEST_TMPDIR/in" "$BATS_TEST_TMPDIR/out"
	done
}

@test "SDO: refusals, and an emergency before the answer" {
	refused 'abort(ed)?.* 0x06020000' upload -p2 0x5555 0
	refused 'abort(ed)?.* 0x06090011' upload -p2 -t uint8 0x2001 99
	refused 'abort(ed)?.* 0x06010001' upload -p2 -t uint16 0x2001 6
	refused 'abort(ed)?.* 0x06010002' download -p2 -t uint16 0x2001 5 1
	refused 'abort(ed)?.* 0x06070012' download -p2 -t uint32 0x2001 1 1
	ethercat download -p2 -t uint16 0x2002 0 0x8130
	dmesg | grep -i 'emergency' | grep -q 8130
}

# code_is CODE: AL status code of the axis
code_is() { [ "$(ethercat reg_read -p2 -t uint16 0x0134 | cut -d' ' -f1)" = "$1" ]; }

@test "state requests are executed or refused as ETG.1000 requires" {
	ethercat states INIT -p2 --wait
	ethercat states PREOP -p2 --wait
	# with what the EEPROM says of its SyncManagers
	ethercat states SAFEOP -p2 --wait
	ethercat states PREOP -p2 --wait
	# no way from PREOP to OP, and no such state: 0x0011, 0x0012
	ethercat reg_write -p2 -t uint16 0x0120 8
	wait_for 20 code_is 0x0011
	ethercat states PREOP -p2 --wait
	ethercat reg_write -p2 -t uint16 0x0120 7
	wait_for 20 code_is 0x0012
	ethercat states PREOP -p2 --wait
	wait_for 60 all_slaves_are PREOP 3
}

@test "OP exchanges process data beside an SDO and ends with the application" {
	timeout 120 chrt -f 50 python3 "$SECOND/app.py" "$EC_BUILD/lib/libethercat.so.1" 40 \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 100 grep -q -e 'in operation' -e 'not so' "$BATS_TEST_TMPDIR/out"
	cat "$BATS_TEST_TMPDIR/out"
	ethercat slaves
	dmesg | tail -n 20
	[ "$(ethercat upload -p2 -t string 0x1008 0)" = "Second model axis" ]
	refused 'abort(ed)?.* 0x08000022' download -p2 -t uint8 0x1c12 0 0
	rc=0
	wait $app || rc=$?
	cat "$BATS_TEST_TMPDIR/out"
	[ "$rc" = 0 ]
	grep -q '^exchanged 40$' "$BATS_TEST_TMPDIR/out"
	wait_for 60 all_slaves_are PREOP 3
	# what was mapped before is mapped again for the next one
	timeout 120 chrt -f 50 python3 "$SECOND/app.py" "$EC_BUILD/lib/libethercat.so.1" 8
}

@test "the master did nothing that no master may do" { no_faults "$BATS_FILE_TMPDIR"; }

# ring STATE: what "ethercat master" says of it
ring() { [ "$(says Ring)" = "$1" ] || { echo "ring: $(says Ring)"; return 1; }; }

# cable cut|heal N: in front of slave N; those at the ends with the links of both computers
cable() {
	local end=(veth1 "" "" veth3) link=down

	[ "$1" = cut ] || link=up
	echo "$1 $2" >"$BATS_TEST_TMPDIR/tell"
	[ -z "${end[$2]}" ] || ip link set "${end[$2]}" $link
}

# how many times slaves have changed their state
changes() {
	ethercat log --json | gojq '[.masters[0].events[] | select(.event == "al_state")] | length'
}

@test "in a ring each cable is cut and healed: slaves stay in OP, with their values" {
	local i open app before

	stop
	model "$BATS_TEST_TMPDIR" veth1 veth3
	master backup_devices=veth2
	wait_for 20 ring closed
	timeout 240 chrt -f 50 python3 "$SECOND/app.py" "$EC_BUILD/lib/libethercat.so.1" 100000 16 \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 100 grep -q -e 'in operation' -e 'not so' "$BATS_TEST_TMPDIR/out"
	before=$(changes)
	open=("the main device and slave 0" "port 1 of slave 0 and slave 1"
		"port 1 of slave 1 and slave 2" "port 1 of slave 2 and the backup device")
	for i in 0 1 2 3; do
		cable cut $i
		wait_for 20 ring "open between ${open[i]}"
		[ "$(ethercat upload -p2 -t string 0x1008 0)" = "Second model axis" ]
		cable heal $i
		wait_for 20 ring closed
		[ "$(ethercat upload -p2 -t string 0x1008 0)" = "Second model axis" ]
	done
	all_slaves_are OP 3
	[ "$(changes)" = "$before" ]
	kill $app
	rc=0
	wait $app || rc=$?
	cat "$BATS_TEST_TMPDIR/out"
	[ "$rc" = 0 ]
	[ "$(sed -n 's/^exchanged //p' "$BATS_TEST_TMPDIR/out")" -ge 20 ]
	no_faults "$BATS_TEST_TMPDIR"
}
