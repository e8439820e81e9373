# SPDX-License-Identifier: GPL-2.0-only
# The kernel runs the cycle; the example application of that, in exact time.

load helpers

setup_file() {
	# the ends of each slave's outputs are wired to its inputs
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=31
	repeat 2 slave s io in=6400 out=6400
	slave d io in=8 out=8
	connect s1.1 -> s1.1
	connect s1.200 -> s1.200
	connect s2.1 -> s2.1
	connect s2.200 -> s2.200
	END
	start "$BATS_FILE_TMPDIR/segment" 3
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	wait_for 60 all_slaves_are PREOP 3
}

kcycle() { "$EC_BUILD/apps/kcycle" "$@"; }
lost() { ethercat master | sed -n 's/.*Lost frames: //p' | head -n 1; }

@test "10000 cycles at 1 kHz, none lost, no working counter error" {
	before=$(lost)
	# the frames keep their time whatever the application does: it has no priority
	run kcycle cycles=10000 period=1000
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"3 slaves in OP"* ]]
	[[ "$output" == *"cycles: 10000, working counter errors: 0, "* ]]
	[[ "$output" == *"kernel: running, "*"overruns: 0, "* ]]
	[ "$(lost)" = "$before" ]
}

@test "the thread is real-time, of the priority asked for, on its CPU" {
	"$EC_BUILD/apps/kcycle" cycles=100000 priority=77 cpu=0 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	thread=$(pgrep -x 'EtherCAT0-cyc')
	[ "$(ps -o cls=,rtprio=,psr= -p "$thread" | xargs)" = "FF 77 0" ]
	kill -9 $app
	wait $app || true
	wait_for 10 no_thread
}
no_thread() { ! pgrep -x 'EtherCAT0-cyc'; }

@test "an application is killed: the session ends, slaves go back" {
	"$EC_BUILD/apps/kcycle" cycles=1000000 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	ethercat master | grep -q 'Active: yes'
	kill -9 $app
	wait $app || true
	wait_for 60 all_slaves_are PREOP 3
	ethercat master | grep -q 'Active: no'
	kcycle cycles=100
}

@test "spinning and poll() see each cycle, too" {
	for how in 1 2; do
		run kcycle cycles=1000 spin=$how
		echo "$output"
		[ "$status" = 0 ]
		[[ "$output" == *"cycles: 1000, working counter errors: 0, "* ]]
	done
}

@test "a loop through the slaves brings whole images" {
	run kcycle cycles=2000 loop=1
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *", torn: 0"* ]]
}

@test "a pause of the application: frames go on" {
	run kcycle cycles=2000 pause=200 stall=1 stall_cycles=20
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"working counter errors: 0, skipped: "* ]]
	[[ "$output" == *"kernel: running, "*"overruns: 0, missed: "* ]]
	missed=${output##*missed: }
	missed=${missed%%[!0-9]*}
	[ "$missed" -ge 190 ] && [ "$missed" -le 300 ]
}

@test "a pause with the policy stop ends the cycle" {
	run kcycle cycles=2000 pause=200 stall=2 stall_cycles=20
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"the cycle ended: Operation canceled"* ]]
	[[ "$output" == *"kernel: stopped, "* ]]
}

@test "the clocks are kept in step by the kernel" {
	run kcycle cycles=2000 dc=1
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"cycles: 2000, working counter errors: 0, "* ]]
}

@test "what cannot be is refused with the reason" {
	run kcycle priority=99
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"a priority of 99; use 1 to 98"* ]]
	run kcycle period=5
	[ "$status" = 1 ]
	[[ "$output" == *"a period of 5000 ns; use 10000 to 1000000000"* ]]
	run kcycle cpu=4000
	[ "$status" = 1 ]
	[[ "$output" == *"there is no CPU 4000"* ]]
}
