# SPDX-License-Identifier: GPL-2.0-only
# The kernel runs the cycle; the example application of that, in exact time.

load helpers

setup_file() {
	# the ends of each slave's outputs are wired to its inputs
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=31
	repeat 2 slave s io in=6400 out=6400 drift=90ppm
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
	kill -9 ${app:+"$app"} ${holder:+"$holder"} 2>/dev/null || true
	ethercat release 2>/dev/null || true	# most cases leave no session
	wait_for 60 all_slaves_are PREOP 3
}

kcycle() { "$EC_BUILD/apps/kcycle" "$@"; }
# background ARG...: start it, wait until all is in OP
background() {
	"$EC_BUILD/apps/kcycle" cycles=1000000 "$@" >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'slaves in OP' "$BATS_TEST_TMPDIR/out"
}
die() {
	kill -9 $app
	wait $app || true
	app=
	wait_for 60 is_detached
}
is_detached() { ethercat master | grep -q 'Session: detached'; }
cycle_is() { [ "$(ethercat cycle --json | gojq -r '.masters[0].state')" = "$1" ]; }
frames() { ethercat master --json | gojq '.masters[0].common.tx_frames'; }
sent() { [ "$(frames)" -ge "$1" ]; }

@test "10000 cycles at 1 kHz, none lost, no working counter error" {
	before=$(lost_frames)
	# the frames keep their time whatever the application does: it has no priority
	run kcycle cycles=10000 period=1000
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"3 slaves in OP"* ]]
	[[ "$output" == *"cycles: 10000, working counter errors: 0, "* ]]
	[[ "$output" == *"kernel: running, "*"overruns: 0, "* ]]
	[ "$(lost_frames)" = "$before" ]
}

@test "the same in the interrupt of the timer, its thread sleeps" {
	before=$(lost_frames)
	background flags=8
	json '.masters[0] | .interrupt and .place == "interrupt"' cycle
	[[ "$(ethercat cycle)" == *"Runs in: interrupt"* ]]
	thread=$(pgrep -x 'EtherCAT0-cyc')
	switches=$(switches)
	from=$(frames)
	wait_for 60 sent $((from + 5000))
	[ "$(switches)" = "$switches" ]
	json '.masters[0].overruns == 0' cycle
	dmesg | grep -q 'EtherCAT 0: kernel cycle runs in the interrupt of its timer'
	kill -9 $app
	wait $app || true
	app=
	wait_for 60 all_slaves_are PREOP 3
	# each way to wait; what sleeps in poll() is woken by the thread
	for spin in 0 1 2 3; do
		run kcycle cycles=1000 flags=8 spin=$spin
		echo "$output"
		[ "$status" = 0 ]
		[[ "$output" == *"cycles: 1000, working counter errors: 0, "* ]]
		[[ "$output" == *"kernel: running, "*"overruns: 0, "* ]]
	done
	[ "$(lost_frames)" = "$before" ]
}

switches() { awk '/ctxt_switches/ { n += $2 } END { print n }' "/proc/$thread/status"; }

@test "killed and taken over, stalled and stopped in the interrupt" {
	before=$(lost_frames)
	background flags=9 stall=1 stall_cycles=50 value=4711
	die
	wait_for 60 cycle_is stalled
	json '.masters[0].interrupt' cycle
	run kcycle cycles=500 flags=9 stall=1 stall_cycles=50
	echo "$output"
	[[ "$output" == *"takeovers: 1, output: 0, "* ]]
	[[ "$output" == *"cycles: 500, working counter errors: 0, "* ]]
	[ "$(lost_frames)" = "$before" ]
	ethercat release
	background flags=8 stall=2 stall_cycles=20
	json '.masters[0].interrupt' cycle
	kill -STOP $app
	wait_for 60 cycle_is stopped
	kill -CONT $app
}

quietly() { "$@" >/dev/null; }
# unit FILTER: the unit "axis" fulfils a filter of gojq
unit() {
	json ".masters[0].units[0] | .name == \"axis\" and .run == \"complete\" and $1" units
}
# the same of its domain
domain() { json ".masters[0].domains[0] | $1" domains -v; }
# unit_sends HEX OUTPUTS: so begins what is sent, and what the first slave has of it, by its wire
unit_sends() {
	domain ".unit == \"axis\" and .working_counter_state == \"complete\"" &&
		domain ".fmmus | map(select(.direction == \"output\"))[0].data_hex[:8] == \"$1\"" &&
		domain ".fmmus | map(select(.direction == \"input\"))[0].data_hex[:8] == \"$1\"" &&
		unit ".outputs == \"$2\""
}

@test "a sync unit: its authority is taken, and another program holds it and is killed" {
	for flags in 0 8; do
		background unit=2 value=0x11223344 flags=$flags
		wait_for 60 quietly unit_sends 44332211 "of the application"
		unit '.authority and (.held | not)'
		ethercat domains | grep -q 'Unit axis: policy zero, complete, outputs of the app'
		run kcycle hold=1
		echo "$output"
		[ "$status" = 1 ]
		[[ "$output" == *"unit axis: Device or resource busy"* ]]

		ethercat units take axis
		wait_for 60 quietly unit_sends 00000000 zero
		unit '.authority | not'
		ethercat units | grep -q 'complete, outputs zero, no authority$'

		"$EC_BUILD/apps/kcycle" hold=1 value=0x55667788 cycles=1000000 3>&- &
		holder=$!
		wait_for 60 quietly unit_sends 88776655 "of another application"
		unit '.authority and .held'
		kill -9 $holder
		wait $holder || true
		holder=
		wait_for 60 quietly unit_sends 00000000 zero
		unit '(.authority or .held) | not'
		json '.masters[0].overruns == 0' cycle
		kill -9 $app
		wait $app || true
		app=
		wait_for 60 all_slaves_are PREOP 3
	done
}

@test "the thread is real-time, of the priority asked for, on its CPU" {
	"$EC_BUILD/apps/kcycle" cycles=100000 priority=77 cpu=0 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	thread=$(pgrep -x 'EtherCAT0-cyc')
	[ "$(ps -o cls=,rtprio=,psr= -p "$thread" | xargs)" = "FF 77 0" ]
	kill -9 $app
	wait $app || true
	wait_for 60 no_thread
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

@test "the tool shows the outputs that are sent, also those of the application's buffer" {
	"$EC_BUILD/apps/kcycle" cycles=1000000 options=1 loop=1 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	sleep 1.5	# from then on frames are filled from there
	first=$(ethercat data | od -An -tu4 -N4)
	sleep 0.1
	[ "$(ethercat data | od -An -tu4 -N4)" -gt "$first" ]
	kill -9 $app
	wait $app || true
	wait_for 60 all_slaves_are PREOP 3
}

@test "spinning, poll() and epoll see each cycle, too" {
	for how in 1 2 3; do
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
	[[ "$output" =~ ', torn: 0 of '([0-9]+) ]]
	((BASH_REMATCH[1] > 0))
}

@test "a pause of the application: frames go on" {
	run kcycle cycles=2000 pause=200 stall=1 stall_cycles=20
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"working counter errors: 0, skipped: "* ]]
	[[ "$output" == *"kernel: running, "*"overruns: 0, missed: "* ]]
	missed=${output##*missed: }
	missed=${missed%%[!0-9]*}
	[ "$missed" -ge 190 ]
	[ "$missed" -le 300 ]
}

@test "a pause with the policy stop ends the cycle" {
	run kcycle cycles=2000 pause=200 stall=2 stall_cycles=20
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"the cycle ended: Operation canceled"* ]]
	[[ "$output" == *"kernel: stopped, "* ]]
	# also for one that makes no system call
	run timeout 60 "$EC_BUILD/apps/kcycle" cycles=2000 pause=200 stall=2 stall_cycles=20 spin=1
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"the cycle ended: Operation canceled"* ]]
}

@test "the clocks are kept in step by the kernel" {
	run kcycle cycles=2000 dc=1
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"cycles: 2000, working counter errors: 0, "* ]]
}

@test "the cycle follows the reference clock" {
	run kcycle cycles=4000 dc=2
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"cycles: 4000, working counter errors: 0, "* ]]
	[[ "$output" == *"reference clock: locked, "*", lost 0 time(s)"* ]]
	# it runs 90 ppm faster
	ppb=$(echo "$output" | sed -n 's/^reference clock: .* rate +\([0-9]*\) ppb.*/\1/p')
	[ "$ppb" -gt 80000 ]
	[ "$ppb" -lt 100000 ]
}

@test "set_cycle refuses invalid parameters with a reason" {
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

@test "killed, the cycle goes on; the same program takes it over" {
	before=$(lost_frames)
	background flags=1 value=4711
	die
	wait_for 60 sent $(($(frames) + 1000))
	all_slaves_are OP 3
	json '.masters[0].session == "detached" and .masters[0].active' master
	# it finds the image as it was, and leaves it so; its end is no end either
	for n in 1 2; do
		run kcycle cycles=500 flags=1
		echo "$output"
		[ "$status" = 0 ]
		[[ "$output" == *"takeovers: $n, output: 4711, input: 4711, all in OP"* ]]
		[[ "$output" == *"cycles: 500, working counter errors: 0, "* ]]
		[[ "$output" == *"overruns: 0, "* ]]
		is_detached
	done
	[ "$(lost_frames)" = "$before" ]
	ethercat release
	wait_for 60 all_slaves_are PREOP 3
	ethercat master | grep -q 'Active: no'
	refused 'has no session' release
}

@test "another program than the one that was killed is refused, then may" {
	background flags=1 stall=1 stall_cycles=50 value=4711
	refused 'still has its application' release
	die
	run kcycle cycles=100 period=2000
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"the period is 1000000 ns, not 2000000; "*"'ethercat release'"* ]]
	run "$EC_BUILD/apps/cyclic" 1
	[ "$status" = 1 ]
	all_slaves_are OP 3
	# then the policy has zeroed the outputs
	wait_for 60 cycle_is stalled
	run kcycle cycles=100 flags=1 stall=1 stall_cycles=50
	echo "$output"
	[[ "$output" == *"takeovers: 1, output: 0, "* ]]
	ethercat release
	run kcycle cycles=100 period=2000
	[ "$status" = 0 ]
	[[ "$output" == *"takeovers: 0, "* ]]
}

@test "stopped and continued: frames go on" {
	background flags=1 stall_cycles=10
	before=$(lost_frames)
	kill -STOP $app
	wait_for 60 sent $(($(frames) + 500))
	all_slaves_are OP 3
	wait_for 60 cycle_is stalled
	kill -CONT $app
	wait_for 60 cycle_is running
	kill -0 $app
	[ "$(lost_frames)" = "$before" ]
}

@test "the first frame waits for outputs when asked to" {
	run kcycle cycles=100 flags=2
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"cycles: 100, working counter errors: 0, "* ]]
}

@test "the device is taken away and comes back under a detached session" {
	background flags=1 value=4711
	die
	unplug
	ethercat master | grep -q 'Waiting for device'
	sleep 0.2
	load_segment "$BATS_FILE_TMPDIR/segment"
	wait_for 120 all_slaves_are OP 3
	run kcycle cycles=100 flags=1
	echo "$output"
	[[ "$output" == *"takeovers: 1, output: 4711, input: 4711, all in OP"* ]]
}

@test "the modules go although a detached session sends" {
	background flags=1
	die
	unplug
	rmmod ec_master
	run pgrep -x 'EtherCAT0-cyc'
	[ "$status" != 0 ]
	start "$BATS_FILE_TMPDIR/segment" 3
	background flags=1
	die
	# the master first, in spite of frames on their way
	run rmmod ec_master
	[ "$status" != 0 ]
	[[ "$output" == *"in use by: "*"$device_module"* ]]
}
