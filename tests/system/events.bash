# SPDX-License-Identifier: GPL-2.0-only
# A segment, an application, and readers of events without any rights.

sim=/sys/kernel/debug/ec_sim/sim0

start_events() {
	printf '%s\n' "segment seed=44" "slave s io in=64 out=64" "slave last drive" \
		>"$BATS_FILE_TMPDIR/segment"
	chmod 755 "$BATS_FILE_TMPDIR"
	start "$BATS_FILE_TMPDIR/segment" 2
	chmod o+r /dev/EtherCAT0
}

# follow NAME [OPTION...]: a reader as a user without any rights, its events in a file
follow() {
	local name=$1

	shift
	setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat" log --follow "$@" \
		>"$BATS_TEST_TMPDIR/$name" 2>&1 3>&- &
	readers[$name]=$!
	wait_for 60 grep -q . "$BATS_TEST_TMPDIR/$name"
}

application() {
	"$EC_BUILD/apps/readers" cycles "$1" >"$BATS_TEST_TMPDIR/app" 2>&1 3>&- &
	app=$!
	wait_for 120 grep -q 'in OP' "$BATS_TEST_TMPDIR/app"
}

end_events() {
	for p in ${readers[@]+"${readers[@]}"} ${app:-} ${busy:-}; do
		kill -9 "$p" 2>/dev/null || true
	done
}

# 100 events a second, and 5000 in 4 s or little more after each SIGUSR1
make_events() {
	cat >"$BATS_TEST_TMPDIR/events.py" <<-'END'
	import fcntl, os, signal, struct, time
	DEBUG = 1 << 30 | 8 << 16 | 0xec << 8 | 0x26	# EC_IOC_DEBUG
	fd = os.open("/dev/EtherCAT0", os.O_RDWR)
	level = 0
	def event():
	    global level
	    level ^= 1
	    fcntl.ioctl(fd, DEBUG, struct.pack("=II", 0, level))
	def many(*_):
	    for _ in range(500):
	        for _ in range(10):
	            event()
	        time.sleep(0.008)
	signal.signal(signal.SIGUSR1, many)
	print("ready", flush=True)
	while True:
	    event()
	    time.sleep(0.01)
	END
	python3 "$BATS_TEST_TMPDIR/events.py" >"$BATS_TEST_TMPDIR/ready" 3>&- &
	busy=$!
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/ready"
}

# whole NAME: the events of this reader have all numbers, but for those that are reported as missed;
# prints how many. The oldest may be overwritten while it begins: that is not printed.
whole() {
	python3 - "$BATS_TEST_TMPDIR/$1" <<-'END'
	import json, sys
	at = None
	missed = []
	for line in open(sys.argv[1]):
	    if not line.endswith("\n"):
	        break
	    e = json.loads(line)
	    first = e["number"] if at is None else first
	    assert at is None or e["number"] == at, (e, at)
	    at = e["number"] + 1
	    if e["event"] == "missed":
	        at = e["number"] + e["count"]
	        if e["count"] > 100 or e["number"] > first + 2047:
	            missed.append(e["count"])
	print(*missed)
	END
}
