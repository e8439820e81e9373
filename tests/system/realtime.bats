# SPDX-License-Identifier: GPL-2.0-only
# What the cycle does on PREEMPT_RT, seen by ftrace: no allocation, no sleep, no
# page fault, no print, for 1000 cycles with all that an application may do in
# one; and its histogram.
# vm: --icount --nics

load helpers

TRACING=/sys/kernel/tracing
WHO='comm == "cycle-bench" || comm == "EtherCAT0-cyc"'
SLEEP=230		# clock_nanosleep()
WAIT=16:c010ec61	# ioctl() with EC_IOC_WAIT

setup_file() {
	local e

	echo 0 >$TRACING/tracing_on
	echo 16384 >$TRACING/buffer_size_kb
	# with the names of modules
	echo 1 >$TRACING/options/sym-offset
	for e in kmem/kmalloc kmem/kmem_cache_alloc kmem/mm_page_alloc lock/contention_begin \
		lock/contention_end exceptions/page_fault_user exceptions/page_fault_kernel \
		printk/console raw_syscalls/sys_enter raw_syscalls/sys_exit sched/sched_switch; do
		echo "$WHO" >$TRACING/events/$e/filter
		case $e in
		kmem/*|*_begin) echo "stacktrace if $WHO" >$TRACING/events/$e/trigger ;;
		esac
		echo 1 >$TRACING/events/$e/enable
	done
}

teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	stop
}

virtual() { start "$PWD/tests/segments/drive1.seg" 1; }

# two network cards with a wire: e1000e as it is, slaves at the other end
generic() {
	modprobe e1000e
	ip link set eth1 up
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=eth0
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" \
		segment="$PWD/tests/segments/drive1.seg" netdev=eth1
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	wait_for 120 all_slaves_are PREOP 1
}

# traced [OPTION...]: run the benchmark's application, which loses nothing; trace its cycles
traced() {
	echo >$TRACING/trace
	"$EC_BUILD/bench/cycle-bench" --trace "$@" || return
	trace_is_whole
}

trace_is_whole() {
	[ "$(cat $TRACING/per_cpu/cpu*/stats | awk '/^overrun/ { n += $2 } END { print n }')" = 0 ]
}

# did COMM NAME CALL...: how often; as tests/system/trace.py says
judge() {
	tests/system/trace.py $TRACING/trace "$@" >"$BATS_TEST_TMPDIR/counts" || return
	cat "$BATS_TEST_TMPDIR/counts"
}
count() { sed -n "s/^$1 //p" "$BATS_TEST_TMPDIR/counts"; }

# clean COMM CYCLES CALL...: it slept where it may, and nothing else
clean() {
	local comm=$1 cycles=$2 name

	shift 2
	judge "$comm" "$@"
	[ "$(count cycles)" = "$cycles" ]
	for name in sleeps contended faults allocs prints; do
		[ "$(count $name)" = 0 ] || { echo "not so: 0 $name"; return 1; }
	done
}

@test "an application's cycle: 2 system calls, nothing that takes time" {
	virtual
	traced --cycles 1000 --extras
	clean cycle-bench 1000 $SLEEP
	# the first one ends what switched the trace on, the last one begins it
	[ "$(count syscalls)" -le 3001 ]
}

@test "a cycle of the kernel: its thread, and an application that waits" {
	virtual
	traced --cycles 1000 --extras --kernel wait
	clean cycle-bench 1000 $WAIT
	[ "$(count syscalls)" -le 1001 ]
	clean EtherCAT0-cyc 1000
	[ "$(count syscalls)" = 0 ]
}

@test "both on a network card" {
	generic
	traced --cycles 1000 --period-us 4000 --extras
	clean cycle-bench 1000 $SLEEP
	traced --cycles 1000 --period-us 4000 --extras --kernel wait
	clean cycle-bench 1000 $WAIT
	clean EtherCAT0-cyc 1000
}

# idle_socket DEVICE: a capture program that never reads; it prints at last what it had
idle_socket() {
	python3 -c 'import signal, socket, struct, sys
s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
s.bind((sys.argv[1], 0))
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
print("ready", flush=True)
signal.sigwait([signal.SIGTERM])
print("frames", struct.unpack("II", s.getsockopt(263, 6, 8))[0], flush=True)' "$1" \
		>"$BATS_TEST_TMPDIR/idle" 3>&- &
	app=$!
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/idle"
}

# captured FRAMES: the socket was offered so many, and each frame was copied for it
captured() {
	kill "$app"
	wait "$app" || return
	app=
	[ "$(sed -n 's/^frames //p' "$BATS_TEST_TMPDIR/idle")" -ge "$1" ] &&
		[ "$(ethercat master --json | gojq '.masters[0].frames_not_captured')" = 0 ]
}

@test "on a network card with a capture program: its copies cost no allocation and no wait" {
	generic
	idle_socket eth0
	traced --cycles 1000 --period-us 4000 --extras
	clean cycle-bench 1000 $SLEEP
	traced --cycles 1000 --period-us 4000 --extras --kernel wait
	clean cycle-bench 1000 $WAIT
	clean EtherCAT0-cyc 1000
	captured 4000
}

@test "control: the trace detects forbidden actions of a cycle" {
	local name

	virtual
	echo >$TRACING/trace
	"$EC_BUILD/bench/cycle-bench" --trace --cycles 200 --violate || true	# late, so frames may be lost
	trace_is_whole
	judge cycle-bench $SLEEP
	[ "$(count cycles)" = 200 ]
	for name in sleeps faults allocs prints; do
		[ "$(count $name)" -ge 2 ] || return
	done
}

@test "ethercat cycle shows the histogram while an application runs" {
	local sends

	virtual
	"$EC_BUILD/bench/cycle-bench" --cycles 1000000 >/dev/null 2>&1 3>&- &
	app=$!
	wait_for 60 json '.masters[0].sends > 500' cycle
	json '.masters[0] | .by == "application" and .state == "running" and
		.interval_configured and
		.interval_ns == 1000000' cycle
	json '.masters[0] | .late_min_ns <= .late_mean_ns and .late_p999_ns <= .late_max_ns and
		([.histogram[].sends] | add) == .sends' cycle
	ethercat cycle
	[[ "$(ethercat cycle)" == *"Cycle: run by the application, running"* ]]
	[[ "$(ethercat cycle)" == *"Interval: 1000.000 us (configured)"* ]]
	# forgotten after it was shown, by a command that may write; the next one takes its time
	wait_for 120 json '.masters[0].sends > 15000' cycle
	ethercat cycle --reset >/dev/null
	json '.masters[0].sends < 15000' cycle
	sends=$(ethercat cycle --json | gojq '.masters[0].sends')
	wait_for 60 json ".masters[0].sends > $sends" cycle
	kill -9 $app
	wait $app || true
	app=
	wait_for 60 json '.masters[0].state == "ended"' cycle
	json '.masters[0].sends > 0' cycle
}
