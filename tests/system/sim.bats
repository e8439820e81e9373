# SPDX-License-Identifier: GPL-2.0-only
# The simulator while it runs: faults from outside, one program per interface, frames of
# all kinds, a ring at two interfaces.

load helpers

setup_file() { modprobe veth; }

setup() {
	SOCK=$BATS_TEST_TMPDIR/sock
	SEG=$BATS_TEST_TMPDIR/two.seg
	printf 'slave io EL1008\nslave axis drive\n' >"$SEG"
}

teardown() {
	[ -z "${SIM:-}" ] || kill "$SIM" 2>/dev/null || true
	stop
	for d in veth0 veth2; do ip link del $d 2>/dev/null || true; done
}

# wire N M: a cable between vethN and vethM
wire() {
	ip link add veth$1 type veth peer name veth$2
	ip link set veth$1 up
	ip link set veth$2 up
}

frames() { python3 "$BATS_TEST_DIRNAME/frames.py" "$@"; }

# program ARGUMENTS...: ethercat-sim at veth1, behind what ARGUMENTS name
program() {
	wire 0 1
	"$EC_BUILD/tool/ethercat-sim" -s "$SEG" "$@" veth1 >"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	SIM=$!
	wait_for 60 grep -q 'slave(s), at ' "$BATS_TEST_TMPDIR/sim"
}

tell() { "$EC_BUILD/tool/ethercat-sim" --tell "$SOCK" "$@"; }

@test "ethercat-sim takes faults at its socket, which only root may use" {
	program --control "$SOCK"
	[ "$(stat -c '%a %U' "$SOCK")" = '600 root' ]
	tell off axis
	tell fault input io.3 value=1
	run tell off nobody
	[ "$status" = 1 ]
	[[ $output == *"unknown slave 'nobody'; the segment has io, axis" ]]
	run tell
	[ "$status" = 1 ]
	[[ $output == *'no fault given'* ]]
	run setpriv --reuid 65534 --clear-groups "$EC_BUILD/tool/ethercat-sim" --tell "$SOCK" on axis
	[ "$status" = 1 ]
	kill "$SIM"
	wait_for 10 test ! -e "$SOCK"
}

@test "a second ethercat-sim at one interface is refused" {
	program
	run "$EC_BUILD/tool/ethercat-sim" -s "$SEG" veth1
	[ "$status" = 1 ]
	[[ $output == *'another ethercat-sim uses veth1'* ]]
	kill "$SIM"
	wait "$SIM" || true
	ip link set veth0 down
	ip link del veth0
	program
}

@test "ec_sim takes faults at its file in debugfs and shows its segment, for root only" {
	local file=/sys/kernel/debug/ec_sim/sim0

	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	start "$SEG" 2
	[ "$(stat -c '%a %U' "$file")" = '600 root' ]
	echo 'off axis' >"$file"
	wait_for 30 all_slaves_are PREOP 1
	run cat "$file"
	echo "$output"
	[[ ${lines[0]} == "# 2 slave(s); "* ]]
	[ "${lines[1]}/${lines[2]}" = "0 io EL1008 at master.0/1 axis drive at io.1: off" ]
	echo 'fault on axis' >"$file"
	wait_for 30 all_slaves_are PREOP 2
	echo 'eeprom io word=4 value=77' >"$file"
	ethercat rescan --wait
	[ "$(ethercat sii_read -p0 | od -An -tu2 -j8 -N2 | tr -d ' ')" = 77 ]
	run bash -c "echo 'off nobody' >$file"
	[ "$status" != 0 ]
	dmesg | grep -q "ec_sim: sim0: unknown slave 'nobody'; the segment has io, axis$"
	run bash -c "printf '%600s' >$file"
	[ "$status" != 0 ]
	dmesg | grep -q 'ec_sim: sim0: fault of 600 characters, limit 512$'
	run setpriv --reuid 65534 --clear-groups bash -c "echo 'off axis' >$file"
	[ "$status" != 0 ]
	run setpriv --reuid 65534 --clear-groups cat "$file"
	[ "$status" != 0 ]
}

# covers_are_kept: each cover of EtherCAT comes back as it was sent, but for the slaves'
# mark in the source address, and without the UDP checksum
covers_are_kept() {
	run frames covers veth0
	echo "$output"
	[ "$output" = "direct wkc=2 head=kept mark=1 last=88a4
tagged wkc=2 head=kept mark=1 last=88a4
udp wkc=2 head=kept mark=1 last=0000
tagged-udp wkc=2 head=kept mark=1 last=0000
other-port lost" ]
}

@test "ethercat-sim answers direct, tagged and UDP frames as they came" {
	program
	covers_are_kept
	kill "$SIM"
	wait "$SIM" || true
	grep -q '4 frames in, 4 out, 0 lost in the segment, 0 dropped' "$BATS_TEST_TMPDIR/sim"
}

@test "ec_sim answers direct, tagged and UDP frames as they came" {
	wire 0 1
	insmod "$EC_BUILD/modules/master/ec_master.ko"
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment="$SEG" netdev=veth1
	covers_are_kept
}

# ring_is NUMBER...: from each end: at which end a frame comes back, its working counter
ring_is() {
	[ "$(frames ring veth2 veth0)" = "from=0 at=$1 wkc=$2
from=1 at=$3 wkc=$4" ] || { frames ring veth2 veth0; return 1; }
}

@test "a ring at two interfaces is cut and heals" {
	printf 'repeat 5 slave io EL2008\nwire io5.1 -> master.1\n' >"$SEG"
	wire 2 3
	program --control "$SOCK" veth3
	ring_is 1 5 0 0
	tell cut io2.1
	ring_is 0 2 1 3
	tell heal io2.1
	ring_is 1 5 0 0
	# at the ends, and a slave without power
	tell cut io1.0
	[[ $(frames ring veth2 veth0) == *lost*"from=1 at=1 wkc=5" ]]
	tell heal io1.0
	tell cut io5.1
	[[ $(frames ring veth2 veth0) == "from=0 at=0 wkc=5"*lost* ]]
	tell heal io5.1
	tell off io3
	ring_is 0 2 1 2
	tell on io3
	ring_is 1 5 0 0
}

# Effects of faults given while the segment runs, as a master sees them. First argument
# of the functions: how a fault is given.

three() { printf 'slave io EL1008\nslave o EL2008\nslave axis drive\n' >"$SEG"; }
give_socket() { tell "$@"; }
give_file() { echo "$*" >/sys/kernel/debug/ec_sim/sim0; }

logged() { dmesg | grep "$1" >/dev/null; }
al_status() { ethercat reg_read -p"$1" -t uint16 0x0130; }
responding() { [ "$(ethercat master --json | gojq '.masters[0].slaves_responding')" = "$1" ]; }

power_and_eeprom() {
	wait_for 60 all_slaves_are PREOP 3
	$1 off axis
	wait_for 30 responding 2
	wait_for 30 all_slaves_are PREOP 2
	$1 on axis
	wait_for 30 responding 3
	wait_for 30 all_slaves_are PREOP 3
	$1 eeprom io word=4 value=77
	ethercat rescan --wait
	[[ $(ethercat slaves -p0) == *' 77:0 '* ]]
}

cable_and_controller() {
	wait_for 60 all_slaves_are PREOP 3
	$1 cut axis.0
	wait_for 30 responding 2
	wait_for 30 all_slaves_are PREOP 2
	$1 heal axis.0
	wait_for 30 responding 3
	wait_for 30 all_slaves_are PREOP 3
	# the controller passes frames, so the slave behind it still answers
	al_status 1
	$1 dead o
	run al_status 1
	[ "$status" = 1 ]
	[[ $output == *'working counter 0'* ]]
	al_status 2
	$1 alive o
	al_status 1
	wait_for 30 all_slaves_are PREOP 3
}

application() {
	dmesg -C
	$1 error axis code=0x42
	wait_for 30 logged 'EtherCAT 0-2: .*0x0042'
	all_slaves_are PREOP 2
	# without an application the error stays until the user acknowledges it
	ethercat states -p2 PREOP
	wait_for 30 all_slaves_are PREOP 3
	$1 emergency axis code=0x8130 register=0x11
	wait_for 30 logged 'EtherCAT 0-2: CoE emergency: code 0x8130 (heartbeat missing), error'
	[ "$(dmesg | grep -c 'CoE emergency')" = 1 ]
	[[ $(ethercat emergencies -p2) =~ ^'   2  '20.*' UTC  0x8130  0x11  '.*missing$ ]]
	LD_LIBRARY_PATH=$EC_BUILD/lib "$EC_BUILD/examples/mirror" 0 1 5 >"$BATS_TEST_TMPDIR/mirror" 2>&1
	! grep '^inputs: 0x04' "$BATS_TEST_TMPDIR/mirror" || return 1
	$1 input io.3 value=1
	LD_LIBRARY_PATH=$EC_BUILD/lib "$EC_BUILD/examples/mirror" 0 1 5 >"$BATS_TEST_TMPDIR/mirror" 2>&1
	grep '^inputs: 0x04' "$BATS_TEST_TMPDIR/mirror"
}

@test "a master at the veth sees each fault given at the socket" {
	three
	program --control "$SOCK"
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=veth0
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	power_and_eeprom give_socket
	cable_and_controller give_socket
	application give_socket
}

@test "a master at sim0 sees each fault written to the file in debugfs" {
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	three
	start "$SEG" 3
	power_and_eeprom give_file
	cable_and_controller give_file
	application give_file
}
