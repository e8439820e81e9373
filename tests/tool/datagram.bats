#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "datagram sends any command" {
	local n=0 c

	golden datagram datagram BRD 0x0130 2
	[ "$(out datagram fprw 0x1001 0x0f80 -t uint16 0x1234)" = \
		$'Working counter: 3\n0x4140 16704' ]
	[ "$(out datagram BWR 0x0f80 -t uint8 1)" = "Working counter: 3" ]
	[ "$(out datagram LRD 0x80000000 -t uint16)" = $'Working counter: 0\n0x0000 0' ]
	# stdout has the bytes alone
	[ "$(out datagram BRD 0 3 -t octet_string)" = "@AB" ]
	[ "$(err datagram BRD 0 3 -t octet_string)" = "Working counter: 3" ]
	printf 'xyz' >"$BATS_TEST_TMPDIR/f"
	[ "$(log_of datagram LWR 0x12345678 "$BATS_TEST_TMPDIR/f" | tail -n 1)" = \
		"datagram 11 0x12345678 78797a" ]
	[ "$(log_of datagram LRW 0 -t string ab 4 | tail -n 1)" = "datagram 12 0x00000000 61620000" ]
	[ "$(log_of datagram APWR 1 0x10 -t int8 -1 | tail -n 1)" = "datagram 2 0x0010ffff ff" ]
	for c in NOP APRD APWR APRW FPRD FPWR FPRW BRD BWR BRW LRD LWR LRW ARMW FRMW; do
		case $c in
		A*|F*) set -- 0 0x0f80 ;;
		*) set -- 0x0f80 ;;
		esac
		case $c in
		*RD|NOP) ;;
		*) set -- "$@" 7 ;;
		esac
		[[ "$(log_of datagram -t uint8 $c "$@" | tail -n 1)" == "datagram $n "* ]] ||
			{ echo "$c"; return 1; }
		n=$((n + 1))
	done
	out datagram -j BRD 0x130 -t uint16 | json '(d["working_counter"] == 3 and
		d["command"] == "BRD" and d["address"] == 0x1300000 and d["value"] == 0x4140)'
	out datagram -j BWR 0x130 -t uint16 1 | json '"value" not in d and d["size_bytes"] == 2'
}

@test "datagram refuses invalid arguments" {
	refuses() {	# ERROR ARGUMENT...
		local error=$1
		shift
		run ethercat datagram "$@"
		[ "$status" -eq 1 ]
		[[ $output == *"$error"* ]] || { echo "$output"; return 1; }
	}
	refuses "unknown command 'XRD'" XRD 0 1
	refuses 'missing argument: FPRD needs the station address and the register' FPRD 0x1001
	refuses 'missing argument: APRD needs the ring position and the register' APRD 1
	refuses 'missing argument: DATA' BWR 0x10
	refuses 'missing argument: SIZE' BRD 0x10
	refuses 'a datagram has 1 to 1486 bytes' BRD 0x10 0
	refuses "invalid size '1487'" BRD 0x10 1487
	head -c 1487 /dev/zero >"$BATS_TEST_TMPDIR/long"
	refuses 'invalid size 1487' BWR 0x10 "$BATS_TEST_TMPDIR/long"
	refuses 'type uint16 has 2 byte(s), not 4' BRD 0x10 4 -t uint16
	refuses 'the value has 2 byte(s), not 1' LWR 0 -t string ab 1
	refuses "invalid address '0x10000'" BRD 0x10000 1
	refuses "invalid address '0x100000000'" LRD 0x100000000 1
	refuses "invalid station address '65536'" FPRD 65536 0 1
	refuses "unexpected argument '3'" BRD 0 1 3
	FAKE_BUS=app refuses 'process 7 (demo) runs the bus' BWR 0 -t uint8 1
}
