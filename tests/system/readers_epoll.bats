# SPDX-License-Identifier: GPL-2.0-only
# A user who may only open the device for reading adds no work to a cycle that the
# kernel runs: instructions, as the time is exact here.

load helpers

setup_file() {
	printf '%s\n' "segment seed=42" "slave s io in=64 out=64" >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 1
	chmod o+r /dev/EtherCAT0
}
teardown_file() { stop; }
teardown() {
	[ -z "${reader:-}" ] || kill -9 "$reader" 2>/dev/null || true
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	wait_for 60 all_slaves_are PREOP 1
}

# work: mean instructions of a cycle, over 2 s
work() {
	ethercat cycle --reset >/dev/null
	sleep 2
	ethercat cycle --json | gojq '.masters[0].work_mean_ns | floor'
}

@test "1500 epoll entries of a reader take no time of the cycle" {
	local alone with

	"$EC_BUILD/apps/kcycle" cycles=1000000 period=1000 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'slaves in OP' "$BATS_TEST_TMPDIR/out"
	alone=$(work)
	setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/apps/readers" epoll 1500 \
		>"$BATS_TEST_TMPDIR/reader" 2>&1 3>&- &
	reader=$!
	wait_for 60 grep -q '1500 entries' "$BATS_TEST_TMPDIR/reader"
	with=$(work)
	echo "# a cycle takes $alone instructions, with 1500 entries $with" | tee /dev/fd/3
	[ "$with" -le $((alone + alone / 10)) ]
}
