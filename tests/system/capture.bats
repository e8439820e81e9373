# SPDX-License-Identifier: GPL-2.0-only
# What packet sockets cost the cycle of a master with a capture interface: instructions, as the
# time is exact here.

load helpers

CYCLES=800
TRACING=/sys/kernel/tracing

setup_file() {
	load_master capture=1
	printf '%s\n' "segment seed=44" "slave s io in=64 out=64" >"$BATS_FILE_TMPDIR/segment"
	load_segment "$BATS_FILE_TMPDIR/segment"
	wait_for 120 all_slaves_are PREOP 1
	ip link set eccap0 up
	# its frame of each second would count in some of the means
	echo 0 >/sys/module/ec_master/parameters/line_errors
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	[ -z "${holder:-}" ] || kill -9 "$holder" 2>/dev/null || true
	wait_for 60 all_slaves_are PREOP 1
}

# holds ARGUMENT... -- DEVICE: a process that runs with these has a packet socket for all protocols
# and never reads; DEVICE: "" for all
holds() {
	local with=()

	while [ "$1" != -- ]; do with+=("$1"); shift; done
	${with[@]+"${with[@]}"} python3 -c 'import signal, socket, sys
s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
if sys.argv[1]: s.bind((sys.argv[1], 0))
print("ready", flush=True)
signal.pause()' "$2" >"$BATS_TEST_TMPDIR/holder" 2>&1 3>&- &
	holder=$!
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/holder"
}
holds_no_more() { kill "$holder"; wait "$holder" || true; holder=; }

application() {
	"$EC_BUILD/apps/readers" "$@" $CYCLES >"$BATS_TEST_TMPDIR/app" 2>&1 3>&- &
	app=$!
	wait_for 120 grep -q 'in OP' "$BATS_TEST_TMPDIR/app"
}

lines() { grep -c incomplete "$BATS_TEST_TMPDIR/app"; }
has_lines() { [ "$(lines)" -ge "$1" ]; }
copies() { cat /sys/class/net/eccap0/statistics/rx_packets; }

# measure PART: in $mean, instructions of PART of the next cycles; in $copied, about their copies
measure() {
	local before

	wait_for 200 has_lines $(($(lines) + 1))
	before=$(copies)
	wait_for 200 has_lines $(($(lines) + 1))
	copied=$(($(copies) - before))
	wait_for 200 has_lines $(($(lines) + 1))
	tac "$BATS_TEST_TMPDIR/app" | grep -m 1 incomplete >"$BATS_TEST_TMPDIR/last"
	grep -q 'incomplete 0$' "$BATS_TEST_TMPDIR/last"
	mean=$(grep -o "\<$1 [0-9]*" "$BATS_TEST_TMPDIR/last" | cut -d' ' -f2)
}

# In a second the work that shows the copies runs so often.
runs_of_work() {
	echo >$TRACING/trace
	echo 1 >$TRACING/events/workqueue/workqueue_execute_start/enable
	sleep 1
	echo 0 >$TRACING/events/workqueue/workqueue_execute_start/enable
	awk '/function worker.*\[ec_master\]/ { n++ } END { print n + 0 }' $TRACING/trace
}

# costs PART: a socket in another namespace nothing, one at the interface at most 350 instructions
# for each of the two copies of a frame (some are those of the simulator, in the same call), and its
# work runs by the clock
costs() {
	local nobody foreign reader runs

	measure "$1"
	nobody=$mean
	[ "$copied" = 0 ]
	# a user would need unshare -U for that, which a chroot forbids
	holds unshare -n -- ""
	measure "$1"
	foreign=$mean
	echo "# $1: no packet socket $nobody, one in another namespace $foreign" | tee /dev/fd/3
	[ "$copied" = 0 ]
	# an interrupt more or less is up to half a per cent of the mean
	[ $((foreign - nobody)) -le $((nobody / 100)) ] &&
		[ $((nobody - foreign)) -le $((nobody / 100)) ]
	holds_no_more
	holds -- eccap0
	measure "$1"
	reader=$mean
	runs=$(runs_of_work)
	echo "# $1: one at eccap0 $reader, $copied copies of $CYCLES cycles," \
		"$runs runs of the work a second" | tee /dev/fd/3
	[ "$copied" -ge $CYCLES ]
	[ $((reader - nobody)) -ge 100 ] && [ $((reader - nobody)) -le $((2 * 350)) ]
	[ "$runs" -ge 50 ] && [ "$runs" -le 250 ]
	holds_no_more
	# the work ends when nobody captures
	sleep 0.1
	[ "$(runs_of_work)" = 0 ]
}

@test "a packet socket in another namespace costs an application's cycle nothing, a capture little" {
	application cycles
	costs send
}

@test "the same for a cycle of the kernel" {
	application waits
	costs work
}
