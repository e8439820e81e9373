# SPDX-License-Identifier: GPL-2.0-only
# Application and cycle of the kernel at the same time, on two processors.
# vm: --smp 2

load helpers

setup_file() {
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=32
	slave s io in=6400 out=6400
	connect s.1 -> s.1
	connect s.200 -> s.200
	END
	start "$BATS_FILE_TMPDIR/segment" 1
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	ethercat release 2>/dev/null || true	# most cases leave no session
	echo 1 >/sys/devices/system/cpu/cpu1/online
	wait_for 60 all_slaves_are PREOP 1
}

# run_as [COMMAND...] -- [ARG...]: kcycle in the background, until all slaves are in OP
run_as() {
	local as=()

	while [ "$1" != -- ]; do as+=("$1"); shift; done
	shift
	dmesg -C
	${as[@]+"${as[@]}"} "$EC_BUILD/apps/kcycle" cycles=1000000 period=2000 "$@" \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	thread=$(pgrep -x EtherCAT0-cyc)
}
scheduling() { ps -o cls=,rtprio= -p "$thread" | xargs; }
allowed() { sed -n 's/^Cpus_allowed_list:\t//p' "/proc/$thread/status"; }
on_cpu() { [ "$(allowed)" = "$1" ]; }
group=(setpriv --reuid 65534 --regid 65534 --clear-groups)

@test "no image is torn while both copy" {
	run "$EC_BUILD/apps/kcycle" cycles=5000 loop=1 spin=1 cpu=1
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" =~ 'cycles: 5000, '.*', torn: 0 of '([0-9]+) ]]
	((BASH_REMATCH[1] > 1000))
}

@test "a member of the group without RLIMIT_RTPRIO gets a cycle without real-time priority" {
	chmod o+rw /dev/EtherCAT0
	run_as prlimit --rtprio=0 "${group[@]}" -- priority=98
	[ "$(scheduling)" = "TS -" ]
	json '.masters[0] | .priority == 0 and .priority_wanted == 98 and .cpu == -1' cycle
	[[ "$(ethercat cycle)" == *"Thread: SCHED_OTHER (SCHED_FIFO 98 not permitted), any CPU"* ]]
	dmesg | grep 'SCHED_OTHER: SCHED_FIFO 98 needs CAP_SYS_NICE or RLIMIT_RTPRIO 98'
}

@test "with RLIMIT_RTPRIO the group gets the allowed priority" {
	chmod o+rw /dev/EtherCAT0
	run_as prlimit --rtprio=60 "${group[@]}" -- priority=98
	[ "$(scheduling)" = "FF 60" ]
	dmesg | grep 'SCHED_FIFO 60: 98 exceeds RLIMIT_RTPRIO'
	kill -9 "$app"
	wait_for 60 all_slaves_are PREOP 1
	run_as prlimit --rtprio=60 "${group[@]}" -- priority=55
	[ "$(scheduling)" = "FF 55" ]
	! dmesg | grep RLIMIT || false
}

# the detached session of the application before, as another user
killed() {
	kill -9 "$app"
	wait "$app" || true
	app=
	wait_for 60 eval 'ethercat master | grep -q "Session: detached"'
}

@test "a takeover gives the cycle the priority that its new owner may use" {
	chmod o+rw /dev/EtherCAT0
	run_as -- priority=97 flags=1
	[ "$(scheduling)" = "FF 97" ]
	before=$thread
	killed
	run_as prlimit --rtprio=0 "${group[@]}" -- priority=97 flags=1
	[ "$thread" = "$before" ]
	[ "$(scheduling)" = "TS -" ]
	dmesg | grep 'SCHED_OTHER: SCHED_FIFO 97 needs CAP_SYS_NICE or RLIMIT_RTPRIO 97'
	json '.masters[0] | .priority == 0 and .priority_wanted == 97' cycle
	killed
	run_as -- priority=97 flags=1
	[ "$thread" = "$before" ]
	[ "$(scheduling)" = "FF 97" ]
	dmesg | grep 'cycle thread runs SCHED_FIFO 97, as the new application permits'
	json '.masters[0] | .priority == 97' cycle
	killed
	ethercat release
}

# What the log says once is seen, where a look may not: when the host stops this guest for a
# millisecond, the thread has the next 1000 cycles.
@test "only an application that may have priority 99 gets the interrupt, also by a takeover" {
	chmod o+rw /dev/EtherCAT0
	run_as prlimit --rtprio=98 "${group[@]}" -- flags=9
	json '.masters[0].place == "thread; interrupt not permitted"' cycle
	wait_for 10 logged 'EC_CYCLE_INTERRUPT needs CAP_SYS_NICE or RLIMIT_RTPRIO 99'
	killed
	run_as prlimit --rtprio=99 "${group[@]}" -- flags=9
	wait_for 60 logged 'runs in the interrupt of its timer, as the new application permits'
	killed
	run_as prlimit --rtprio=98 "${group[@]}" -- flags=9
	wait_for 10 json '.masters[0].place == "thread; interrupt not permitted"' cycle
	killed
	ethercat release
	run_as prlimit --rtprio=99 "${group[@]}" -- flags=8
	wait_for 60 logged 'kernel cycle runs in the interrupt of its timer'
}
logged() { dmesg | grep -qF "$1"; }

@test "no image is torn while the interrupt copies" {
	dmesg -C
	run "$EC_BUILD/apps/kcycle" cycles=5000 loop=1 spin=1 cpu=1 flags=8
	echo "$output"
	[ "$status" = 0 ]
	logged 'kernel cycle runs in the interrupt of its timer'
	[[ "$output" =~ 'cycles: 5000, '.*', torn: 0 of '([0-9]+) ]]
	((BASH_REMATCH[1] > 1000))
}

@test "the thread returns to its CPU after that was offline" {
	run_as -- cpu=1
	[ "$(allowed)" = 1 ]
	for losses in 1 2; do
		echo 0 >/sys/devices/system/cpu/cpu1/online
		wait_for 10 json ".masters[0] | .cpu == 1 and .cpu_losses == $losses" cycle
		sleep 1
		# the log repeats a text after 10 s only
		[ $losses = 2 ] || [ "$(dmesg | grep -c 'CPU 1 of the cycle thread went offline')" = 1 ]
		[ "$(allowed)" != 1 ]
		echo 1 >/sys/devices/system/cpu/cpu1/online
		wait_for 10 on_cpu 1
	done
	[[ "$(ethercat cycle)" == *"Thread: SCHED_FIFO 50, CPU 1, offline 2 time(s)"* ]]
	json '.masters[0].state == "running"' cycle
}

@test "an interrupt moves to the thread and back when its CPU goes offline" {
	run_as -- cpu=1 flags=8
	wait_for 60 logged 'kernel cycle runs in the interrupt of its timer'
	for _ in 1 2; do
		echo 0 >/sys/devices/system/cpu/cpu1/online
		wait_for 10 json '.masters[0].place == "thread; the CPU is offline"' cycle
		json '.masters[0].state == "running"' cycle
		[ "$(says 'Active')" = yes ]
		echo 1 >/sys/devices/system/cpu/cpu1/online
		wait_for 10 json '.masters[0].place != "thread; the CPU is offline"' cycle
	done
	json '.masters[0].state == "running"' cycle
}

@test "a cycle that needs its whole period leaves time to the threads of its CPU" {
	# in this guest a cycle takes more than that
	"$EC_BUILD/apps/kcycle" cycles=1000000 period=20 cpu=1 flags=8 >/dev/null 2>&1 3>&- &
	app=$!
	wait_for 60 logged 'the interrupt left too little time to other threads of its CPU'
	json '.masters[0] | .state == "running" and .overruns > 0' cycle
	for _ in {1..5}; do timeout 20 taskset -c 1 true; done
}
