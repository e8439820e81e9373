# SPDX-License-Identifier: GPL-2.0-only
# Events of the bus and of applications, for every user.

load helpers
load events

setup_file() { start_events; }
teardown_file() { stop; }
teardown() {
	end_events
	echo 'heal s.1' >"$sim"
	wait_for 60 all_slaves_are PREOP 2
}

nobody() { setpriv --reuid 65534 --regid 65534 --clear-groups "$@"; }
log_has() {
	nobody "$EC_BUILD/tool/ethercat" log >"$BATS_TEST_TMPDIR/log" &&
		grep -q -- "$1" "$BATS_TEST_TMPDIR/log"
}

@test "log shows the start of the bus to every user" {
	log_has 'main device attached$'
	log_has 'main link up$'
	log_has 'scan complete: 2 slave(s) in '
	json '.masters[0].events[0].number == 0' log
}

@test "log --follow shows a slave that is unplugged, and its return" {
	declare -gA readers=()
	follow reader
	echo 'cut s.1' >"$sim"
	wait_for 60 grep -qE \
		'behind port 1 of slave 0: slave 1 .* disconnected, last seen [0-9]+ ms ago$' \
		"$BATS_TEST_TMPDIR/reader"
	grep -q 'slaves responding: 1, before: 2$' "$BATS_TEST_TMPDIR/reader"
	echo 'heal s.1' >"$sim"
	wait_for 60 grep -q 'behind port 1 of slave 0: slave 1 .* connected$' "$BATS_TEST_TMPDIR/reader"
	# the same as for a reader that comes later
	log_has 'behind port 1 of slave 0: slave 1 .* connected$'
}

@test "log shows an application with its process" {
	application 100
	log_has "application reserved the master, process $app\$"
	log_has 'session activated: 1 domain(s), .*, process '"$app"
	log_has 'domain 0: working counter [1-9][0-9]* of [1-9]'
	# lines of the kernel log stand in the order of events
	[[ $(dmesg) == *"reserved the master, process $app"*"session activated: "* ]]
	kill -9 "$app"
	wait_for 20 log_has "application exited or released the master, process $app\$"
}

@test "a reader that is stopped learns the exact number of events it missed" {
	declare -gA readers=()
	local gap

	make_events
	follow stopped --json
	follow other --json
	kill -STOP "${readers[stopped]}"
	kill -USR1 "$busy"
	sleep 6
	kill -CONT "${readers[stopped]}"
	wait_for 20 grep -q '"missed"' "$BATS_TEST_TMPDIR/stopped"
	gap=$(whole stopped)
	# 5000 and those of some seconds, less those that are kept
	[ "$gap" -ge 2950 ] && [ "$gap" -le 3400 ]
	[ -z "$(whole other)" ]
}

@test "a reader changes nothing and needs a buffer for a whole event" {
	nobody python3 - <<-'END'
	import errno, fcntl, os, select, struct
	fd = os.open("/dev/EtherCAT0", os.O_RDONLY | os.O_NONBLOCK)
	def fails(error, *what):
	    try:
	        what[0](*what[1:])
	    except OSError as e:
	        assert e.errno == error, e
	    else:
	        raise AssertionError(what)
	fails(errno.EINVAL, os.read, fd, 64)	# no reader of events yet
	EVENTS = 3 << 30 | 24 << 16 | 0xec << 8 | 0x1b
	fails(errno.EINVAL, fcntl.ioctl, fd, EVENTS, struct.pack("=IIQQ", 0, 63, 0, 0))
	fails(errno.EOPNOTSUPP, fcntl.ioctl, fd, EVENTS, struct.pack("=IIQQ", 2, 64, 0, 0))
	arg = fcntl.ioctl(fd, EVENTS, struct.pack("=IIQQ", 0, 64, 0, 0))
	_, _, first, head = struct.unpack("=IIQQ", arg)
	fails(errno.EINVAL, os.read, fd, 63)
	assert select.select([fd], [], [], 0)[0]
	got = 0
	while got < head - first:
	    data = os.read(fd, 1000)
	    assert len(data) % 64 == 0 and len(data) <= 960
	    got += len(data) // 64
	fails(errno.EAGAIN, os.read, fd, 64)
	assert not select.select([fd], [], [], 0)[0]
	END
}

mailbox() {	# mailbox NAME [OPTION...]: a reader of messages, its lines in a file
	local name=$1

	shift
	"$EC_BUILD/tool/ethercat" mailbox --follow "$@" >"$BATS_TEST_TMPDIR/$name" 2>&1 3>&- &
	readers[$name]=$!
}
rings() { grep -c ec_mail_tap_new /proc/vmallocinfo; }
has_rings() { [ "$(rings)" = "$1" ]; }
has_lines() { [ "$(grep -c 0x1018:01 "$BATS_TEST_TMPDIR/$1")" = "$2" ]; }

@test "mailbox --follow shows messages to every reader with the right, and leaves nothing behind" {
	declare -gA readers=()

	run nobody "$EC_BUILD/tool/ethercat" mailbox --follow
	[ "$status" = 1 ]
	[[ $output == *"mailbox messages may contain passwords"* ]]
	has_rings 0
	mailbox all
	mailbox drive -p1 --json
	mailbox coupler -p0
	wait_for 20 has_rings 1
	sleep 1		# all three have begun
	"$EC_BUILD/tool/ethercat" upload -p1 0x1018 1 -t uint32
	wait_for 20 has_lines all 2
	wait_for 20 has_lines drive 2
	[[ $(grep 0x1018:01 "$BATS_TEST_TMPDIR/all") == \
		*"  1  to    CoE    SDO upload request 0x1018:01"*"  1  from  CoE    SDO upload response 0x1018:01: 4 byte(s): "*", after "*" ms" ]]
	[ ! -s "$BATS_TEST_TMPDIR/coupler" ]
	kill -9 "${readers[all]}" "${readers[coupler]}"
	"$EC_BUILD/tool/ethercat" upload -p1 0x1018 1 -t uint32
	wait_for 20 has_lines drive 4
	has_lines all 2
	kill -9 "${readers[drive]}"
	wait_for 20 has_rings 0
	"$EC_BUILD/tool/ethercat" upload -p1 0x1018 1 -t uint32
	# one that is stopped learns how many it has missed: SDOs of 4 messages each, and more
	mailbox stopped --json
	wait_for 20 has_rings 1
	sleep 1
	kill -STOP "${readers[stopped]}"
	for _ in $(seq 600); do
		"$EC_BUILD/tool/ethercat" upload -p1 0x1018 1 -t uint32 >/dev/null
	done
	kill -CONT "${readers[stopped]}"
	wait_for 20 grep -q '"missed": [1-9]' "$BATS_TEST_TMPDIR/stopped"
	sleep 1
	kill -9 "${readers[stopped]}"
	[ "$(gojq -s 'map(.missed) + [length] | add' "$BATS_TEST_TMPDIR/stopped")" -ge 1200 ]
	wait_for 20 has_rings 0
}
