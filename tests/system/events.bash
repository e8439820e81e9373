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
	for p in ${readers[@]+"${readers[@]}"} ${app:-}; do
		kill -9 "$p" 2>/dev/null || true
	done
}
