# SPDX-License-Identifier: GPL-2.0-only
# vm: --smp 2
# Applications, modules and devices that come and go at any time.

load helpers

setup_file() { start three 3; }
teardown_file() { stop; }

slaves() { echo 3; }

# background NAME ARG...: start the application, wait until all is in OP
background() {
	local out=$1

	shift
	"$EC_BUILD/apps/cyclic" "$@" >"$out" 2>&1 &
	app=$!
	wait_for 120 grep -q ": $(slaves) of $(slaves) in OP" "$out"
}

idle() {
	ethercat master | grep -q 'Phase: Idle' && ethercat master | grep -q 'Active: no'
}

# kB of the kernel's own memory; what can be had back any time is not counted
kernel_memory() {
	sync
	echo 3 >/proc/sys/vm/drop_caches
	awk '/^SUnreclaim:|^KernelStack:|^VmallocUsed:/ { s += $2 } END { print s }' /proc/meminfo
}

@test "one application at a time; a tool beside it" {
	background "$BATS_TEST_TMPDIR/out" 600
	run timeout 60 "$EC_BUILD/apps/cyclic" 1
	[ "$status" = 1 ]
	[[ "$output" == *"master 0 is reserved by process "[0-9]*" (cyclic); stop that application first"* ]]
	local pid
	pid=$(sed -n 's/.*reserved by process \([0-9]*\) .*/\1/p' <<<"$output")
	[ "$(cat "/proc/$pid/comm")" = cyclic ]
	run ethercat slaves
	[ "${#lines[@]}" = "$(slaves)" ]
	run ethercat reg_read -p1 -t uint16 0x0010
	[ "$status" = 0 ]
	run ethercat rescan
	[ "$status" = 0 ]
	kill -TERM $app
	wait $app
	grep ', 0 refused' "$BATS_TEST_TMPDIR/out"
	wait_for 120 idle
}

@test "rmmod is refused while an application runs, which goes on" {
	background "$BATS_TEST_TMPDIR/out" 600
	run rmmod ec_master
	[ "$status" != 0 ]
	[ -c /dev/EtherCAT0 ]
	ethercat master | grep -q 'Phase: Operation'
	kill -TERM $app
	wait $app
	grep ', 0 refused' "$BATS_TEST_TMPDIR/out"
}

@test "the device is removed in OP and comes back" {
	background "$BATS_TEST_TMPDIR/out" 600
	rmmod ec_sim
	ethercat master | grep -q 'Waiting for device'
	sleep 1
	kill -0 $app
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=three
	wait_for 120 all_slaves_are OP "$(slaves)"
	kill -TERM $app
	wait $app
	wait_for 120 all_slaves_are PREOP "$(slaves)"
}

@test "killed at any moment, 28 times: the bus is idle, the next one starts, nothing is lost" {
	RANDOM=7
	for i in $(seq 28); do
		"$EC_BUILD/apps/cyclic" >"$BATS_TEST_TMPDIR/out" 2>&1 &
		app=$!
		sleep "0.$((RANDOM % 90 + 10))"
		kill -KILL $app
		wait $app || true
		wait_for 120 idle
		# the first rounds fill caches
		[ "$i" != 8 ] || before=$(kernel_memory)
	done
	wait_for 120 all_slaves_are PREOP "$(slaves)"
	after=$(kernel_memory)
	echo "kernel memory: $before kB, then $after kB"
	# 20 sessions of up to 32 kB each; caches still grow by some 100 kB
	[ $((after - before)) -lt 250 ]
	background "$BATS_TEST_TMPDIR/out" 600
	kill -KILL $app
	wait $app || true
	wait_for 120 idle
	wait_for 120 all_slaves_are PREOP "$(slaves)"
}

@test "stopped for a while: process data stop, then go on" {
	background "$BATS_TEST_TMPDIR/out" 600
	dmesg -C
	kill -STOP $app
	wait_for 120 log_has 'cycle timeout: no cyclic frame'
	# the tool does not wait for the application
	run timeout 60 "$EC_BUILD/tool/ethercat" reg_read -p1 -t uint16 0x0010
	[ "$status" = 0 ]
	kill -CONT $app
	wait_for 120 all_slaves_are OP "$(slaves)"
	kill -TERM $app
	wait $app
}

log_has() { dmesg | grep -q "$1"; }

# posts TEXT: the line of rtcheck about the cycle and the thread of the posts
posts() { ethercat rtcheck | grep -E "^[a-z]+ +posts .*$1"; }

@test "rtcheck names the loser: the cycle of an application, or the thread that finds lost frames" {
	local thread=EtherCAT0-post post

	post=$(pgrep -x $thread)
	posts "no cycle runs; one with SCHED_FIFO 2 or more preempts $thread .SCHED_FIFO 1.$"
	background "$BATS_TEST_TMPDIR/out" 600
	chrt -a -o -p 0 $app
	posts "the cycle .cyclic, thread [0-9]+, SCHED_OTHER. loses: $thread .SCHED_FIFO 1. preempts it"
	chrt -a -f -p 1 $app
	posts "$thread .SCHED_FIFO 1. loses if the cycle spins.*.cyclic, thread [0-9]+, SCHED_FIFO 1."
	chrt -a -f -p 2 $app
	posts "the cycle .cyclic, thread [0-9]+, SCHED_FIFO 2. preempts $thread .SCHED_FIFO 1.$"
	taskset -p 2 "$post"
	taskset -a -p 1 $app
	posts "share no CPU$"
	taskset -p 3 "$post"
	# as with fifo_posts=N
	chrt -o -p 0 "$post"
	posts "$thread .SCHED_OTHER. loses: the cycle .cyclic, thread [0-9]+, SCHED_FIFO 2. preempts it"
	chrt -f -p 1 "$post"
	kill -TERM $app
	wait $app
	wait_for 120 idle
}

runs_as() { [ "$(cat "/proc/$1/comm")" = "$2" ]; }
revision() { ethercat upload -p2 -t uint32 0x1018 1 | grep 0x00000002; }

@test "the thread that finds lost frames reports that it gets no CPU, and goes on when it does" {
	local post spinner line='EtherCAT0-post has not run for a second'

	post=$(pgrep -x EtherCAT0-post)
	wait_for 120 all_slaves_are PREOP "$(slaves)"
	dmesg -C
	revision
	sleep 3
	[ -z "$(dmesg | grep "$line")" ]
	# on PREEMPT_RT a timer of this shell on the CPU of the spinner would wait behind it
	taskset -p 1 $BASHPID
	taskset -p 2 "$post"
	# below the threads of interrupts; for 60 s at most
	taskset 2 chrt -f 2 prlimit --rttime=60000000 sh -c 'while :; do :; done' &
	spinner=$!
	wait_for 60 runs_as $spinner sh
	# the thread has work: lost frames of this would be its own. Messages that it does not send
	# leave with frames of the monitor, which may take longer than the request
	revision || status=$?
	wait_for 30 log_has "$line: a thread of higher priority keeps its CPU, perhaps [01]; lost"
	kill -KILL $spinner
	wait $spinner || true
	dmesg -C
	revision
	sleep 3
	[ -z "$(dmesg | grep "$line")" ]
	taskset -p 3 "$post"
}

@test "modules unload and load again" {
	rmmod ec_sim
	rmmod ec_master
	[ ! -e /dev/EtherCAT0 ]
	start three 3
}
