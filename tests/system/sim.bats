# SPDX-License-Identifier: GPL-2.0-only
# The simulator while it runs: faults from outside, one program per interface.

load helpers

setup_file() { modprobe veth; }

setup() {
	SOCK=$BATS_TEST_TMPDIR/sock
	SEG=$BATS_TEST_TMPDIR/two.seg
	printf 'slave io EL1008\nslave axis drive\n' >"$SEG"
}

teardown() {
	[ -z "${SIM:-}" ] || kill "$SIM" 2>/dev/null || true
	ip link del veth0 2>/dev/null || true
	stop
}

# program ARGUMENTS...: ethercat-sim at veth1
program() {
	ip link add veth0 type veth peer name veth1
	ip link set veth0 up
	ip link set veth1 up
	"$EC_BUILD/tool/ethercat-sim" -s "$SEG" "$@" veth1 >"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	SIM=$!
	wait_for 60 grep -q 'at veth1' "$BATS_TEST_TMPDIR/sim"
}

tell() { "$EC_BUILD/tool/ethercat-sim" --tell "$SOCK" "$@"; }

@test "ethercat-sim takes faults at its socket, which only root may use" {
	program --control "$SOCK"
	[ "$(stat -c '%a %U' "$SOCK")" = '600 root' ]
	tell off axis
	tell fault input io.3 value=1
	run tell off nobody
	[ "$status" = 1 ]
	[[ $output == *"no slave 'nobody'"* ]]
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
	[[ $output == *'another ethercat-sim is at veth1'* ]]
	kill "$SIM"
	wait "$SIM" || true
	ip link set veth0 down
	ip link del veth0
	program
}

@test "ec_sim takes faults at its file in debugfs, which only root may write" {
	local file=/sys/kernel/debug/ec_sim/sim0

	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	start "$SEG" 2
	[ "$(stat -c '%a %U' "$file")" = '200 root' ]
	echo 'off axis' >"$file"
	wait_for 30 all_slaves_are PREOP 1
	echo 'fault on axis' >"$file"
	wait_for 30 all_slaves_are PREOP 2
	echo 'eeprom io word=4 value=77' >"$file"
	ethercat rescan --wait
	[ "$(ethercat sii_read -p0 | od -An -tu2 -j8 -N2 | tr -d ' ')" = 77 ]
	run bash -c "echo 'off nobody' >$file"
	[ "$status" != 0 ]
	dmesg | grep -q "ec_sim: sim0: no slave 'nobody'"
	run setpriv --reuid 65534 --clear-groups bash -c "echo 'off axis' >$file"
	[ "$status" != 0 ]
}
