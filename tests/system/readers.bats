# SPDX-License-Identifier: GPL-2.0-only
# A user who may only open the device for reading changes no timing of the master or
# of an application.
# vm: --smp 2

load helpers

UPDATES=40

setup_file() {
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=41
	slave s io in=64 out=64 transition=1ms
	END
	chmod 755 "$BATS_FILE_TMPDIR"
	start "$BATS_FILE_TMPDIR/segment" 1
	chmod o+r /dev/EtherCAT0
}
teardown_file() { stop; }
teardown() {
	[ -z "${reader:-}" ] || kill -9 "$reader" 2>/dev/null || true
	wait_for 60 all_slaves_are PREOP 1
}

# nobody COMMAND...: in the background, as a user without any rights
nobody() {
	setpriv --reuid 65534 --regid 65534 --clear-groups "$@" \
		>"$BATS_TEST_TMPDIR/reader" 2>&1 3>&- &
	reader=$!
}
reads() { wait_for 60 grep -q . "$BATS_TEST_TMPDIR/reader"; }

@test "six threads that show everything: each update reaches the status page" {
	nobody "$EC_BUILD/apps/readers" show 6
	reads
	run "$EC_BUILD/apps/readers" updates $UPDATES
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"updates: $UPDATES of $UPDATES"* ]]
}
