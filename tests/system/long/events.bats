# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --timeout 7200
# EC_CYCLES cycles of the kernel, 600,000 if it is not set, in exact time, beside readers of
# events, one of which is stopped for 5 s.

load ../helpers
load ../events

CYCLES=${EC_CYCLES:-600000}
READERS=8
OTHERS=$((CYCLES / 10))		# cycles that are measured without readers

setup_file() { start_events; }
teardown_file() { stop; }
teardown() { end_events; }

has_sends() { json ".masters[0].sends >= $1" cycle; }

# measure NAME CYCLES: figures of so many cycles from now on, in a file
measure() {
	ethercat cycle --reset >/dev/null
	sleep $(($2 / 1000))
	wait_for 600 has_sends "$2"
	cp "$BATS_TEST_TMPDIR/json" "$BATS_TEST_TMPDIR/$1"
}

# figure NAME KEY: of a measurement, rounded
figure() { gojq ".masters[0].$2 | round" "$BATS_TEST_TMPDIR/$1"; }

# alike KEY PERMILLE: beside readers at most so much more than without
alike() {
	local without=$(figure without "$1") with=$(figure with "$1")

	echo "# $1: without readers $without, beside $READERS readers $with" | tee /dev/fd/3
	[ $(((with - without) * 1000)) -le $((without * $2)) ]
}

@test "event readers change no cycle, and one that is stopped for 5 s learns the exact gap" {
	declare -gA readers=()
	local i gap

	"$EC_BUILD/apps/kcycle" cycles=1000000000 period=1000 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'slaves in OP' "$BATS_TEST_TMPDIR/out"
	make_events
	measure without $OTHERS
	for ((i = 0; i < READERS; i++)); do follow "reader$i" --json; done
	sleep 1
	( sleep 10
	  kill -STOP "${readers[reader0]}"
	  kill -USR1 "$busy"
	  sleep 5
	  kill -CONT "${readers[reader0]}" ) 3>&- &
	measure with "$CYCLES"
	ethercat cycle | sed 's/^/# /' >&3
	gap=$(whole reader0)
	echo "# the stopped reader missed $gap event(s)" | tee /dev/fd/3
	# one gap: 5000 events and 5 s of the others, less those that are kept
	[ "$gap" -ge 2950 ] && [ "$gap" -le 3400 ]
	alike work_mean_ns 20
	alike late_mean_ns 20
	alike late_p999_ns 100
	[ "$(figure with overruns)" = 0 ]
	for ((i = 1; i < READERS; i++)); do [ -z "$(whole "reader$i")" ]; done
}
