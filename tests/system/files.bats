# SPDX-License-Identifier: GPL-2.0-only
# Files of slaves: foe_read and foe_write, also in BOOT, interrupted, and with wrong arguments.

load helpers

setup_file() {
	local segment=$BATS_FILE_TMPDIR/files.seg

	printf '%s\n' 'segment response=100us transition=1ms' \
		'slave coupler EK1100' 'slave servo EL7201 foe_page=100ms' \
		'slave drive drive mbox=512 foe=128 foe_busy=3 foe_page=20ms' >"$segment"
	start "$segment" 3
	head -c 120000 /dev/urandom >"$BATS_FILE_TMPDIR/image.bin"
	head -c 60000 /dev/urandom >"$BATS_FILE_TMPDIR/fw.efw"
	: >"$BATS_FILE_TMPDIR/empty"
}

in_boot() { ethercat states -p"$1" | grep -q BOOT; }

teardown_file() { stop; }

@test "a file comes back as it was written" {
	local f=$BATS_FILE_TMPDIR/image.bin

	run ethercat foe_write -p2 -v "$f"
	[ "$status" = 0 ]
	[[ "$output" =~ ^"120000 bytes in " ]]
	ethercat foe_read -p2 image.bin >"$BATS_TEST_TMPDIR/back"
	cmp "$f" "$BATS_TEST_TMPDIR/back"
	ethercat foe_read -p2 image.bin -o "$BATS_TEST_TMPDIR/saved"
	cmp "$f" "$BATS_TEST_TMPDIR/saved"
	# another name, from stdin, with a password
	ethercat foe_write -p2 -o short - 0x1234 <<<hello
	[ "$(ethercat foe_read -p2 short 4660)" = hello ]
	json '.position == 2 and .name == "short" and .size_bytes == 6 and
		.data_hex == "68656c6c6f0a"' foe_read -p2 short
	# a file may be empty
	ethercat foe_write -p2 "$BATS_FILE_TMPDIR/empty"
	[ "$(ethercat foe_read -p2 empty | wc -c)" = 0 ]
	refused '0x00008001: file not found' foe_read -p2 image.bin
}

@test "firmware is written in BOOT through the bootstrap mailbox" {
	local f=$BATS_FILE_TMPDIR/fw.efw

	ethercat states --wait -p1 BOOT
	ethercat foe_write -p1 "$f"
	refused 'not in PREOP or above' upload -p1 -t uint32 0x1018 1
	ethercat states --wait -p1 PREOP
	ethercat foe_read -p1 fw.efw | cmp - "$f"
}

@test "firmware in one command, also after a kill in the middle of it" {
	local f=$BATS_FILE_TMPDIR/fw.efw

	printf x >"$BATS_TEST_TMPDIR/v1"
	json '.position == 1 and .name == "v1" and .size_bytes == 1 and .state == "PREOP"' \
		firmware -p1 "$BATS_TEST_TMPDIR/v1"
	[ "$(ethercat foe_read -p1 v1)" = x ]
	"$EC_BUILD/tool/ethercat" firmware -p1 "$f" &
	pid=$!
	wait_for 20 in_boot 1
	kill -9 "$pid"
	in_boot 1
	# the next attempt recovers
	ethercat firmware -p1 "$f"
	[ "$(ethercat states -p1 | grep -c PREOP)" = 1 ]
	ethercat foe_read -p1 fw.efw | cmp - "$f"
	refused 'slave 0: no FoE' firmware -p0 "$f"
	# process data are not ended by it, unless by force; then the state returns
	ethercat states --wait -p2 SAFEOP
	refused 'slave 2 is in SAFEOP: BOOT ends its process data' firmware -p2 "$f"
	[ "$(ethercat states -p2 | grep -c SAFEOP)" = 1 ]
	json '.state == "SAFEOP"' firmware --force -p2 "$f"
	ethercat states --wait -p2 PREOP
}

@test "wrong arguments and refusals name the cause" {
	refused 'missing argument: ethercat foe_read NAME' foe_read -p2
	refused 'no FoE mailbox' foe_read -p0 x
	refused 'the selection matches 3 of 3 slaves, the command needs one' foe_read x
	refused 'cannot open /nonexistent' foe_write -p2 /nonexistent
	refused 'stdin has no name' foe_write -p2 -
	refused "invalid password" foe_write -p2 "$BATS_FILE_TMPDIR/fw.efw" secret
	refused 'expected 1 to 64 characters' foe_read -p2 "$(printf 'x%.0s' {1..65})"
	refused 'printable characters' foe_read -p2 $'a\nb'
	refused '0x00008004: illegal request' foe_read -p2 "$(printf 'x%.0s' {1..64})"
	head -c 140000 /dev/zero >"$BATS_TEST_TMPDIR/large"
	refused '0x00008003: disk full' foe_write -p2 "$BATS_TEST_TMPDIR/large"
	refused 'cannot write' foe_read -p1 fw.efw -o "$BATS_TEST_TMPDIR/none/file"
}

@test "a reader without write permission is refused" {
	chmod 0664 /dev/EtherCAT0
	run setpriv --reuid=65534 --regid=65534 --clear-groups \
		"$EC_BUILD/tool/ethercat" foe_read -p1 fw.efw
	[ "$status" = 1 ]
	[[ "$output" == *"ermission"* ]]
}

@test "a killed writer leaves no file, and the next one works" {
	local f=$BATS_FILE_TMPDIR/image.bin i

	for i in 1 2 3; do
		timeout -s KILL "0.0$((i * 2))" "$EC_BUILD/tool/ethercat" foe_write -p2 "$f" ||
			true # killed
		wait_for 5 refused 'file not found' foe_read -p2 image.bin
	done
	ethercat foe_write -p2 "$f"
	ethercat foe_read -p2 image.bin | cmp - "$f"
}

@test "a second writer is refused while the first one goes on" {
	local f=$BATS_FILE_TMPDIR/image.bin pid

	ethercat foe_write -p2 "$f" &
	pid=$!
	# it begins first
	sleep 0.05
	refused 'another file of slave 2' foe_write -p2 -o b "$BATS_FILE_TMPDIR/fw.efw"
	wait "$pid"
	ethercat foe_read -p2 image.bin | cmp - "$f"
}

@test "a slave that loses its power ends the transfer with its reason" {
	local f=$BATS_FILE_TMPDIR/image.bin sim=/sys/kernel/debug/ec_sim/sim0 pid rc=0

	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	ethercat foe_write -p2 "$f" 2>"$BATS_TEST_TMPDIR/err" &
	pid=$!
	sleep 0.1
	echo 'off drive' >"$sim"
	wait "$pid" || rc=$?
	[ "$rc" = 1 ]
	cat "$BATS_TEST_TMPDIR/err"
	[ "$(wc -l <"$BATS_TEST_TMPDIR/err")" = 1 ]
	# the transfer ends before the master has noticed that the slave is absent
	wait_for 20 all_slaves_are PREOP 2
	echo 'on drive' >"$sim"
	wait_for 20 all_slaves_are PREOP 3
	ethercat foe_write -p2 "$f"
	ethercat foe_read -p2 image.bin | cmp - "$f"
}
