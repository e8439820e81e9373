# SPDX-License-Identifier: GPL-2.0-only
# Firmware of a slave whose flash takes its time: power lost, two writers, wrong files.

load helpers

sim=/sys/kernel/debug/ec_sim/sim0

setup_file() {
	local segment=$BATS_FILE_TMPDIR/firmware.seg

	printf '%s\n' 'segment response=100us transition=1ms' 'slave coupler EK1100' \
		'slave drive drive foe=64' \
		'slave servo EL7201 foe_page=100ms foe_header=FW1 foe_boot=yes' >"$segment"
	start "$segment" 3
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	{ printf FW1; head -c 50000 /dev/urandom; } >"$BATS_FILE_TMPDIR/fw.efw"
	head -c 50000 /dev/zero >"$BATS_FILE_TMPDIR/wrong.efw"
}

teardown_file() { stop; }

in_boot() { ethercat states -p2 | grep -q BOOT; }

# the file is on its way: some of its pages are written
in_middle() { wait_for 20 in_boot; sleep 0.3; }

@test "power lost in the middle of a firmware is reported, and the next attempt recovers" {
	local f=$BATS_FILE_TMPDIR/fw.efw err=$BATS_TEST_TMPDIR/err pid rc=0

	ethercat firmware -p2 "$f" 2>"$err" &
	pid=$!
	in_middle
	echo 'off servo' >"$sim"
	wait "$pid" || rc=$?
	cat "$err"
	[ "$rc" = 1 ]
	grep -q 'slave 2' "$err"
	echo 'on servo' >"$sim"
	wait_for 20 all_slaves_are PREOP 3
	refused 'file not found' foe_read -p2 fw.efw
	ethercat firmware -p2 "$f"
	[ "$(ethercat states -p2 | grep -c PREOP)" = 1 ]
	ethercat foe_read -p2 fw.efw | cmp - "$f"
}

@test "a second writer of a firmware is refused while the first one goes on" {
	local f=$BATS_FILE_TMPDIR/fw.efw pid

	ethercat firmware -p2 "$f" &
	pid=$!
	in_middle
	refused 'another file of slave 2' foe_write -p2 -o b "$BATS_FILE_TMPDIR/wrong.efw"
	run ethercat firmware -p2 "$f"
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"another file of slave 2"* ]]
	# another slave is not concerned
	ethercat foe_write -p1 -o c - <<<c
	wait "$pid"
	[ "$(ethercat states -p2 | grep -c PREOP)" = 1 ]
	ethercat foe_read -p2 fw.efw | cmp - "$f"
}

@test "a file that is no firmware is refused with the reason of the slave" {
	local f=$BATS_FILE_TMPDIR/fw.efw

	refused '0x00008008: only possible in BOOT' foe_write -p2 "$f"
	run ethercat firmware -p2 "$BATS_FILE_TMPDIR/wrong.efw"
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"0x0000800b: program error"*"not firmware of this device"* ]]
	in_boot
	ethercat firmware -p2 "$f"
	ethercat foe_read -p2 fw.efw | cmp - "$f"
}
