# SPDX-License-Identifier: GPL-2.0-only
# vm: --smp 2
# The character device refuses what is wrong: malformed arguments one by one,
# then random ones. A kernel warning fails the whole file (tests/vm/run.sh).

load helpers

# "three", its axis with SoE
setup_file() {
	printf '%s\n' "segment seed=3" "slave coupler EK1100" "slave out EL2008 alias=1001" \
		"slave axis EL7201 motor=AM8121 soe=1" >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 3
}
teardown_file() { stop; }

check() {
	run "$EC_BUILD/apps/ioctl_check" "$1"
	echo "$output"
	[ "$status" = 0 ]
}

state_is() { [ "$(ethercat slaves -p"$1" | awk '{ print $3 }')" = "$2" ]; }

@test "programs of each frozen version of the interface run" {
	local p n=0

	for p in "$EC_BUILD"/apps/abi_v*; do
		run "$p" /dev/EtherCAT0
		echo "$p: $output"
		[ "$status" = 0 ] || return
		n=$((n + 1))
	done
	[ "$n" = "$(find tests/abi -maxdepth 1 -name "v*" | wc -l)" ]
}

@test "unknown numbers and directions" { check numbers; }
@test "wrong sizes in the number" { check sizes; }
@test "no memory behind a pointer" { check pointers; }
@test "unknown flags, reserved bytes, reasons" { check unknown; }
@test "a reader causes no traffic and changes nothing" { check readonly; }
@test "slaves, SyncManagers, PDOs and entries that do not exist" { check positions; }
@test "each kind of address with invalid values" { check addresses; }
@test "programs of old and of later versions" { check version; }
@test "impossible values" { check values; }
@test "commands at the wrong time" { check states; }
@test "a filter that refuses a command is not bypassed" { check policy; }
@test "too many and too much" { check limits; }
@test "wrong mappings" { check mmap; }
@test "data are copied to absent pages beside mmap" { check pages; }

@test "a user cannot flood the kernel log" {
	dmesg -C
	check flood
	dmesg | cut -c 1-160
	[ "$(dmesg | wc -l)" -le 40 ]
	dmesg | grep -q 'PDO 0x1700 is not assigned'
	# what was counted comes at the end of the ten seconds
	wait_for 30 eval 'dmesg | grep -q "not assigned.*, [0-9]*[.][0-9] s ago (.* more in the last 10 s"'
	[ "$(dmesg | wc -l)" -le 60 ]
}

@test "a user without rights reads only, one of another group nothing" {
	chmod 0664 /dev/EtherCAT0
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/apps/ioctl_check" readonly
	[ "$status" = 0 ]
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" slaves
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 3 ]
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" rescan
	[ "$status" != 0 ]
	[[ "$output" == *ermission* ]]
	chmod 0660 /dev/EtherCAT0
	run setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" slaves
	[ "$status" != 0 ]
	[[ "$output" == *ermission* ]]
}

@test "all of that left the bus as it was" {
	wait_for 120 all_slaves_are PREOP 3
}

@test "random commands from four threads, beside a tool" {
	"$EC_BUILD/apps/ioctl_fuzz" "${EC_SEED:-1}" 10 &
	fuzz=$!
	while kill -0 $fuzz 2>/dev/null; do
		timeout 60 "$EC_BUILD/tool/ethercat" master >/dev/null || [ $? != 124 ]
		timeout 60 "$EC_BUILD/tool/ethercat" slaves >/dev/null || [ $? != 124 ]
	done
	wait $fuzz
	# what it wrote to registers and objects is gone with the segment
	rmmod ec_sim
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=three
	wait_for 120 all_slaves_are PREOP 3
}

@test "debug levels show state changes and frames in the kernel log" {
	dmesg -C
	ethercat states -p1 INIT
	wait_for 120 state_is 1 INIT
	[ -z "$(dmesg | grep -E 'requested|byte.s.: ')" ]
	ethercat debug 1
	ethercat states -p1 PREOP
	wait_for 120 state_is 1 PREOP
	dmesg | grep -q 'EtherCAT 0-1: PREOP requested, is in INIT'
	[ -z "$(dmesg | grep 'byte(s): ')" ]
	ethercat debug 2
	ethercat reg_read -p1 -t uint16 0x0010
	dmesg | grep -q 'main sent, [0-9]* byte(s): '
	dmesg | grep -q 'main received, [0-9]* byte(s): '
	ethercat debug 0
	sleep 0.1
	dmesg -C
	ethercat reg_read -p1 -t uint16 0x0010
	[ -z "$(dmesg | grep 'byte(s): ')" ]
}
