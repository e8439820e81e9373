# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 7200
# EC_CYCLES cycles of the native device, a million if it is not set, in exact time.

load ../helpers
load echo

setup_file() { start_echo; }
teardown_file() { stop; }

@test "one lost frame is noticed" {
	before=$(lost_frames)
	echo_app --exact 5000 1000 >"$BATS_TEST_TMPDIR/out" 3>&- &
	app=$!
	wait_for 60 grep -qs cycles=1000 "$BATS_TEST_TMPDIR/out"
	tell 'lose rate=1000000ppm'
	sleep 0.001
	tell 'lose rate=0ppm'
	rc=0
	wait $app || rc=$?
	[ $rc != 0 ]
	cat "$BATS_TEST_TMPDIR/out"
	[ "$(value incomplete)" -ge 1 ]
	[ "$(lost_frames)" -gt "$before" ]
}

@test "each cycle is complete, each value is back when it is due, no frame is lost" {
	wait_for 60 all_slaves_are PREOP 1
	before=$(lost_frames)
	run echo_app --exact "${EC_CYCLES:-1000000}" 1000
	echo "$output" >"$BATS_TEST_TMPDIR/out"
	echo "# $(tail -n 1 "$BATS_TEST_TMPDIR/out")" >&3
	[ "$status" = 0 ]
	[ "$(value complete)" = "${EC_CYCLES:-1000000}" ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}
