# SPDX-License-Identifier: GPL-2.0-only
# Slaves whose mailbox answers random bytes, or right messages with one wrong field.
# vm: --icount --timeout 900

load helpers

sim=/sys/kernel/debug/ec_sim/sim0

setup_file() {
	local segment=$BATS_FILE_TMPDIR/hostile.seg

	printf '%s\n' 'segment seed=5 response=100us transition=1ms' 'slave coupler EK1100' \
		'slave bad drive serial=5 mbox=128 foe=64 soe=1 voe=7' \
		'slave good drive serial=6 mbox=128' >"$segment"
	start "$segment" 3
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	head -c 2000 /dev/urandom >"$BATS_FILE_TMPDIR/data"
}

teardown_file() { stop; }

# ends COMMAND...: in time, with success or an error in words
ends() {
	local rc=0

	timeout 60 "$EC_BUILD/tool/ethercat" "$@" >/dev/null 2>"$BATS_TEST_TMPDIR/err" || rc=$?
	calls=$((calls + 1))
	[ "$rc" -le 1 ] && { [ "$rc" = 0 ] || [ -s "$BATS_TEST_TMPDIR/err" ]; } || {
		echo "$*: exit code $rc, $(cat "$BATS_TEST_TMPDIR/err")"
		return 1
	}
}

# hostile KIND: all commands of the mailbox, several times; then the slave works again
hostile() {
	local i calls=0 f=$BATS_FILE_TMPDIR/data

	dmesg -C
	echo "mailbox bad $1" >"$sim"
	for i in 1 2 3 4; do
		ends upload -p1 -t uint32 0x1018 4
		ends upload -p1 -t octet_string 0x2000 0
		ends download -p1 -t uint32 0x2001 8 "$i"
		ends sdos -p1
		ends foe_read -p1 data
		ends foe_write -p1 "$f"
		ends soe_read -p1 -t uint32 S-0-0047
		ends soe_write -p1 -t uint32 S-0-0047 "$i"
		[ "$(ethercat upload -p2 -t uint32 0x1018 4 | awk '{ print $2 }')" = 6 ]
	done
	echo "mailbox bad good" >"$sim"
	[ "$calls" = 32 ]
	ends upload -p1 -t uint32 0x1018 4	# what still lies there is thrown away
	[ "$(ethercat upload -p1 -t uint32 0x1018 4 | awk '{ print $2 }')" = 5 ]
	ethercat foe_write -p1 "$f"
	ethercat foe_read -p1 data | cmp - "$f"
	run dmesg
	[[ ! "$output" =~ BUG|WARNING:|Oops ]]
}

@test "random mailbox messages end each command with an error in words" {
	hostile garbage
}

@test "almost right mailbox messages end each command in time" {
	hostile almost
}

@test "why names a drive in error by its code and its text, until it is reset" {
	ethercat soe_command -p1 S-0-0099
	run ethercat why
	[[ $output != *"is in error"* ]]
	echo 'drive bad error=0x80' >"$sim"
	run ethercat why
	[ "$status" = 0 ]
	[[ $output == *'Warning: drive 0 is in error: class 1 diagnostic (S-0-0011) 0x0080 '* ]]
	[[ $output == *'(overcurrent), number 0xf0000080: "simulated error"'*'Place: slave 1 '* ]]
	ethercat soe_command -p1 S-0-0099
	run ethercat why
	[[ $output != *"is in error"* ]]
}
