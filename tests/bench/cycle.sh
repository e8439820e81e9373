#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The cost and the reliability of a cycle, in the VM. Under -icount one guest
# instruction is one tick of the time stamp counter, so costs are exact and the
# same on every machine. Gated: 10 000 cycles without a lost frame or a wrong
# working counter, instructions and system calls per cycle, and master and
# simulator together at 1 kHz. The lateness of a run in real time depends on the
# host and is printed only; the CPU time of the host that it needs is gated.
# profile.sh shows in which functions the instructions are.
#
# usage: cycle.sh [--gates|--record|--ring] [--cycles N]
#   --gates   what has a limit only, and each limit once: for make check
#   --record  only what a recording costs the cycle
#   --ring    only what a second device costs it, at the other end of a ring
#   N         cycles of the long run, default 10000

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
build=$PWD/build/system-$kernel
cycles=10000 all=1 only=
while [ $# -gt 0 ]; do
	case $1 in
	--gates) all= ;;
	--record) only=record ;;
	--ring) only=ring ;;
	--cycles) cycles=${2:-} && shift ;;
	*) echo "cycle.sh: unknown option '$1'" >&2 && exit 2 ;;
	esac
	shift
done
[[ $cycles =~ ^[1-9][0-9]*$ ]] || { echo "cycle.sh: --cycles needs a number" >&2; exit 2; }
# of the network device that is measured: msix or legacy
interrupt=${EC_INTERRUPT:-msix}
case $interrupt in
msix|legacy) ;;
*) echo "cycle.sh: EC_INTERRUPT=$interrupt: only msix and legacy" >&2 && exit 2 ;;
esac
passed=0 failed=0 lenient=
declare -A v
medians=()	# of the calls, by drives

build() {
	local kdir

	kdir=$(tests/vm/kernels.sh kdir "$kernel")
	make -s -j2 modules KDIR="$kdir" MODDIR="$build/modules" &&
	make -s -C lib O="$build/lib" all &&
	make -s -C tool O="$build/tool" &&
	make -s -C tool/sim O="$build/tool" &&
	make -s -C tests/bench/cycle O="$build/bench" LIB="$build/lib" &&
	mkdir -p "$build/split" && cp -u tests/bench/cycle/split/* "$build/split" &&
	make -s -C "$kdir" M="$build/split" CONFIG_DEBUG_INFO_BTF_MODULES= \
		CONFIG_DEBUG_INFO= modules
}
tests/vm/kernels.sh fetch "$kernel" >&2 && locked "$kernel" build >&2 || exit 1

# A string copy counts once per byte with ERMS and once per word without. The
# incumbent's figures grow by too little from 1 to 100 drives for the former.
icount=(--icount --qemu "-cpu max,-erms,-fsrm")
# QEMU 10 counts a word of it twice, 7.2 once: with 100 drives 10.1k instead of 7.8k
slack=100
[[ $(qemu-system-x86_64 --version) == *"version 7."* ]] || slack=130

# below PID: its children, theirs, and so on
below() {
	local p

	for p in $(cat "/proc/$1/task/$1/children"); do
		echo "$p"
		below "$p"
	done
}

# CPU time of each thread of the VM, ns
vm_threads() {
	local p t

	for p in $(below $$); do
		[[ $(cat "/proc/$p/comm") == qemu-system* ]] || continue
		for t in "/proc/$p/task/"*; do echo "${t##*/} $(cut -d' ' -f1 "$t/schedstat")"; done
	done 2>/dev/null | sort
}

# Between the lines mark_begin and mark_end of cycle-bench: host_cpu_ns of the VM, and
# host_thread_ns of the thread of it that used most. Time that the host gives to others is
# not in it.
host_time() {
	local line before=

	while IFS= read -r line; do
		case $line in
		*mark_begin\ 0) before=$(vm_threads) ;;
		*mark_end\ 0)
			join <(echo "$before") <(vm_threads) | awk -v name="${line%mark_end 0}" '
				{ d = $3 - $2; sum += d; if (d > most) most = d }
				END { printf "%shost_cpu_ns %.0f\n%shost_thread_ns %.0f\n", name, sum, name, most }' ;;
		*) printf '%s\n' "$line" ;;
		esac
	done
}

# run NAME [run.sh options] -- DEVICE SEGMENT [cycle-bench options]
#     [+ PREFIX options]...; fills v. $lenient: working counters are not judged.
run() {
	local name=$1 out line opts=()

	shift
	while [ "$1" != -- ]; do opts+=("$1"); shift; done
	shift
	case $2 in *.seg) set -- "$1" "$PWD/tests/segments/$2" "${@:3}" ;; esac
	v=()
	if ! out=$(set -o pipefail
		   tests/vm/run.sh --kernel "$kernel" --timeout 300 ${opts[@]+"${opts[@]}"} -- env \
			EC_INTERRUPT="$interrupt" tests/bench/cycle/guest.sh "$build" "$@" 2>&1 | host_time); then
		if [ -z "$lenient" ] || [[ $out != *wc_errors* ]]; then
			echo "$out" | tail -n 30
			echo "not ok $name: the run failed"
			failed=$((failed + 1))
		fi
		[[ $out == *wc_errors* ]] || return 1
	fi
	while read -r line; do
		[[ $line =~ ^([a-z0-9_]+)\ ([0-9.]+)$ ]] && v[${BASH_REMATCH[1]}]=${BASH_REMATCH[2]}
	done <<<"$out"
	[ -n "${v[wc_errors]:-}" ]
}

# gate TEXT CONDITION: an arithmetic one
gate() {
	if (($2)); then
		echo "ok $1"
		passed=$((passed + 1))
	else
		echo "not ok $1"
		failed=$((failed + 1))
	fi
}

# row VALUE LIMIT TEXT: of the table run.sh prints
row() { echo "# row: $*"; }

reliable() {
	gate "$1: ${v[cycles]} cycles, ${v[slaves]} slaves: ${v[lost]} frames lost, ${v[wc_errors]} working-counter errors" \
		"${v[lost]} == 0 && ${v[wc_errors]} == 0 && ${v[call_errors]} == 0 &&
		 ${v[operational]} == ${v[slaves]}"
}

ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", a / b }'; }

# the kernel's cycle: the calls, and what its thread does between two sleeps
kernel_cost() {
	printf '# %-8s %4u slave(s) %5u bytes: receive %6u process %4u queue %4u send %7u, thread %6u = %7u\n' \
		kernel "${v[kernel_slaves]}" "${v[kernel_image_bytes]}" "${v[kernel_receive_mean]}" \
		"${v[kernel_process_mean]}" "${v[kernel_queue_mean]}" "${v[kernel_send_mean]}" \
		"${v[kernel_work_mean]}" "${v[kernel_total_mean]}"
	gate "cycle of the kernel: ${v[kernel_cycles]} cycles, ${v[kernel_slaves]} slaves: ${v[kernel_lost]} frames lost, ${v[kernel_wc_errors]} working-counter errors" \
		"${v[kernel_lost]} == 0 && ${v[kernel_wc_errors]} == 0 && ${v[kernel_call_errors]} == 0 &&
		 ${v[kernel_operational]} == ${v[kernel_slaves]}"
}

# cost DEVICE SLAVES: a row of the table
cost() {
	printf '# %-8s %4u slave(s) %5u bytes: receive %6u process %4u queue %4u send %7u = %7u (a refused ioctl: %u)\n' \
		"$1" "${v[slaves]}" "${v[image_bytes]}" "${v[receive_mean]}" "${v[process_mean]}" \
		"${v[queue_mean]}" "${v[send_mean]}" "${v[total_mean]}" "${v[entry]}"
}

# What the kernel's cycle of 1 ms takes from an application that never sleeps: its thread, what
# wakes it, and both switches, without the clock tick, which comes anyway.
# spinning PREFIX PLACE INTERRUPTED LIMIT1 LIMIT100
spinning() {
	local floor least limit spins what p=$1

	what="a cycle of the kernel in $2, the application spins, native device, ${v[slaves]} drive(s)"
	floor=$((v[floor1000_spin_rest] - v[spinning_per_ms]))
	spins=$((v[${p}card_work] + v[${p}master_work] + v[${p}rest_work]))
	spins=$((spins - v[spinning_per_ms]))
	echo "# kernel's cycle in $2, the application spins: $spins"
	echo "# floor of the same: a thread that only sleeps $floor; above it: $((spins - floor))"
	gate "$what: ${v[${p}lost]} frames lost, ${v[${p}wc_errors]} working-counter errors" \
		"${v[${p}lost]} == 0 && ${v[${p}wc_errors]} == 0 && ${v[${p}call_errors]} == 0"
	# an interrupt spares the switch to a thread, which the floor contains
	least=$(($3 ? 0 : floor))
	limit=$(((v[slaves] == 1 ? $4 : $5) * slack / 100))
	row $spins $limit "all instructions of $what"
	gate "$what: $spins instructions, at most $limit" \
		"spins > least && spins <= limit && ${v[${p}interrupted]} == $3"
}

# A CPU that has other work does not idle between two cycles: what one of an application takes from
# a process that computes, without the clock tick.
beside() {
	local floor own limit what="an application's cycle beside a process that computes"

	what+=", native device, ${v[slaves]} drive(s)"
	floor=$((v[floor1000_spin_rest] - v[spinning_per_ms]))
	own=$((v[beside_application_work] + v[beside_card_work] + v[beside_master_work]))
	own=$((own + v[beside_rest_work] - v[spinning_per_ms]))
	echo "# floor of the same: a thread that only sleeps $floor; above it: $((own - floor))"
	limit=$(((v[slaves] == 1 ? 9000 : 13000) * slack / 100))
	row $own $limit "all instructions of $what"
	gate "$what: ${v[beside_lost]} frames lost, $own instructions, at most $limit" \
		"own > floor && own <= limit && ${v[beside_lost]} == 0 &&
		 ${v[beside_wc_errors]} == 0 && ${v[beside_call_errors]} == 0 &&
		 ${v[beside_other_work]} > 500000"
}

# work PREFIX US WHO: all instructions of a cycle of US microseconds in $work: application,
# interrupts, threads, monitor, wake-ups, the way of the CPU to its idle state and back; without the
# simulator, its network card and the interrupts of both, and without what this machine executes in
# such a time before there is a master. The application reads the clock only to sleep.
work() {
	local split rest

	rest=$((${v[$1rest_work]} - $2 * ${v[baseline_per_ms]} / 1000))
	work=$((${v[$1application_work]} + ${v[$1card_work]} + ${v[$1master_work]} + rest))
	printf '# all work of a cycle, %3u slave(s), %s: application %5u, network card %5u, threads of the master %5u, rest %5u = %6u; taken off: simulator %u\n' \
		"${v[slaves]}" "$3" "${v[$1application_work]}" "${v[$1card_work]}" \
		"${v[$1master_work]}" "$rest" "$work" "${v[$1simulator_work]}"
	# what bench_split.ko executes itself is not in it
	split=$((work - rest + ${v[$1rest_work]} + ${v[$1simulator_work]}))
	gate "${v[slaves]} slave(s), $3: $split of ${v[$1whole_work]} instructions are attributed, at least 93 %" \
		"split <= ${v[$1whole_work]} && split >= ${v[$1whole_work]} * 93 / 100"
}

long_run() {
	run "long run" "${icount[@]}" -- virtual bench --cycles "$cycles" || return
	reliable "1 kHz, icount, virtual device"
	row $((v[lost] + v[wc_errors])) 0 "lost frames or wrong working counters: $cycles cycles, icount"
	echo "# lateness of the wake-up: median ${v[late_ns_median]} ns, 99.9 % ${v[late_ns_p999]} ns, max ${v[late_ns_max]} ns"
}

# all_work SLAVES: who runs the cycle, compared by all that a CPU executes for it, same
# machine, same slaves, same period. The kernel's cycle has one more thread to wake up, which
# alone costs what the two floors of native_cost differ by.
all_work() {
	local own timer

	work "" 4100 "application's cycle"; own=$work
	work kernel_ 4100 "kernel's cycle, the application sleeps by itself"; timer=$work
	work wait_ 4100 "kernel's cycle, the application waits for it"
	row "$timer" $((own * 120 / 100)) "all instructions of a cycle, the kernel runs it, the application sleeps: $1 drive(s)"
	row "$work" $((own * 120 / 100)) "the same, the application waits"
	gate "$1 slave(s): all work of a cycle of the kernel is $(ratio "$timer" "$own") of that of an application's, $(ratio "$work" "$own") when the application waits for it; at most 1.20" \
		"$own > ${v[total_mean]} && $timer > ${v[kernel_total_mean]} &&
		 $timer <= own * 120 / 100 && $work <= own * 120 / 100"
}

# The receive interrupt of eth1 is the simulator's: a delay keeps it out of the calls.
# That of eth0 is ours and counts.
generic_cost() {
	local n limit median

	echo "# instructions per cycle, generic device on e1000e, interrupt: $interrupt"
	for n in 1 100; do
		run "drive$n, generic" "${icount[@]}" --nics -- generic "drive$n.seg" --cycles 500 \
			--period-us 4100 + kernel --cycles 300 --period-us 4100 --kernel timer \
			+ wait --cycles 300 --period-us 4100 --kernel wait || return
		gate "drive$n: the figures are those of the interrupt $interrupt" \
			"${v[msix]} == $([ "$interrupt" = msix ] && echo 1 || echo 0)"
		cost generic
		kernel_cost
		all_work $n
		reliable "generic device"
		# The mean has the cycles in it that send a frame of the monitor, too.
		limit=$(((n == 1 ? 4850 : 9900) * slack / 100))
		median=$(((n == 1 ? 4750 : 9700) * slack / 100))
		row "${v[total_mean]}" $limit "instructions of the calls of a cycle, mean: $n drive(s)"
		row "${v[total_median]}" $median "the same, median"
		gate "$n slave(s): ${v[total_mean]} instructions of the calls on the mean, at most $limit; median ${v[total_median]}, at most $median" \
			"${v[total_mean]} <= limit && ${v[total_median]} <= median"
	done
}

# floors US OWN WAIT: what the machine needs for a cycle of US microseconds in which nothing is
# done. A longer one has more of the clock tick in it, and idles deeper. What an application's cycle
# needs above it in $above.
floors() {
	local sleep wake idle=$(($1 * v[baseline_per_ms] / 1000))

	sleep=$((v[floor$1_sleep_own] + v[floor$1_sleep_rest] - idle))
	wake=$((v[floor$1_wake_own] + v[floor$1_wake_rest] - idle))
	above=$(($2 - sleep))
	echo "# floor of the same run: a thread that only sleeps $sleep, one that wakes another $wake"
	echo "# above it: application's cycle (its send interval is set) $above"
	echo "# above it: kernel's with a waiting application $(($3 - wake))"
}

# interrupted US OWN: the kernel's cycle in the interrupt of its timer, the application waits
interrupted() {
	local limit

	work iwait_ "$1" "kernel's cycle in an interrupt, the application waits for it"
	# above it are the clock tick and the monitor, of longer cycles
	limit=$((((v[slaves] == 1 ? 11500 : 17000) + ($1 - 1000) * 2) * slack / 100))
	row $work $limit "all instructions of the kernel's cycle in an interrupt, an application waits: ${v[slaves]} drive(s), $1 us"
	gate "${v[slaves]} drive(s), an interrupt for $1 us: $work instructions, at most $limit; $(ratio "$work" "$2") of an application's cycle" \
		"${v[iwait_interrupted]} == 1 && work > 0 && work <= limit"
	gate "the same: ${v[iwait_cycles]} cycles: ${v[iwait_lost]} frames lost, ${v[iwait_wc_errors]} working-counter errors" \
		"${v[iwait_lost]} == 0 && ${v[iwait_wc_errors]} == 0 && ${v[iwait_call_errors]} == 0"
}

# eight domains, then eight sync units of one domain each
units_cost() {
	local calls=${v[units_total_mean]} limit=$((v[eight_total_mean] * 105 / 100))

	row "$calls" $limit "instructions of the calls of a cycle with 8 sync units, and at most 1.05 of those with 8 domains: ${v[slaves]} drive(s)"
	gate "${v[slaves]} slave(s), native device: calls with 8 sync units are $(ratio "$calls" "${v[eight_total_mean]}") of those with 8 domains, ${v[eight_total_mean]} instructions; at most 1.05" \
		"$calls * 100 >= ${v[eight_total_mean]} * 95 && $calls <= limit && ${v[units_wc_errors]} == 0"
}

# The same card without interrupts. What an application waits for is its own sleep or the
# kernel's cycle.
native_cost() {
	local us=$1 n own above limit median spin=() units=()

	# what the machine does by itself varies by 100,000 instructions from one run to another
	[ "$us" != 1000 ] ||
		spin=(+ beside --cycles 50 --work 500 --period-us $us --beside
		      + spin --cycles 50 --work 500 --period-us $us --kernel spin
		      + ispin --cycles 50 --work 500 --period-us $us --kernel spin --interrupt)
	echo "# instructions per cycle of $us us, native device on e1000e"
	for n in 1 100; do
		[ "$us" = 1000 ] || [ $n = 1 ] ||
			units=(+ eight --cycles 300 --period-us $us --domains 8
			       + units --cycles 300 --period-us $us --domains 8 --units)
		run "drive$n, native" "${icount[@]}" --nics -- native "drive$n.seg" --cycles 1000 \
			--period-us $us + kernel --cycles 300 --period-us $us --kernel timer \
			+ wait --cycles 300 --period-us $us --kernel wait \
			+ iwait --cycles 300 --period-us $us --kernel wait --interrupt \
			${spin[@]+"${spin[@]}"} ${units[@]+"${units[@]}"} || return
		cost native
		kernel_cost
		work "" $us "application's cycle"; own=$work
		work kernel_ $us "kernel's cycle, the application sleeps by itself"
		work wait_ $us "kernel's cycle, the application waits for it"
		floors $us "$own" "$work"
		interrupted $us "$own"
		if [ "$us" = 1000 ]; then
			beside
			spinning spin_ "its thread" 0 7600 11500
			spinning ispin_ "an interrupt" 1 3700 8000
		fi
		limit=$(((n == 1 ? 2450 : 5700) * slack / 100))
		row "${v[total_mean]}" $limit "instructions of the calls of a cycle, native device, mean: $n drive(s)"
		gate "$n slave(s), native device: ${v[total_mean]} instructions of the calls on the mean, at most $limit" \
			"${v[total_mean]} <= limit"
		# the mean varies by 60 from run to run with what the monitor sends beside the cycle
		limit=$(((n == 1 ? 2290 : 5170) * slack / 100))
		echo "# the same, median: ${v[total_median]}"
		# in one of some 20 runs more than half of the cycles have 5 % more, with less
		# work in all; not in both of these runs
		median=${v[total_median]}
		[ $((medians[n])) = 0 ] || median=$((median < medians[n] ? median : medians[n]))
		medians[n]=${v[total_median]}
		if [ "$us" = 1000 ]; then
			row "$median" $limit "the same, median, of two periods: $n drive(s)"
			gate "$n slave(s), native device: $median instructions of the calls, median, at most $limit" \
				"$median <= limit"
		fi
		# 3364 to 4166 and 6044 to 7342 in five runs, one of them on a busy host: what the
		# monitor and the machine do from time to time differs from run to run
		limit=$((n == 1 ? 4500 : 7900))
		row "$above" $limit "of these above the floor of a sleeping thread: $n drive(s)"
		gate "$n slave(s), native device: $above instructions above the floor, at most $limit" \
			"$above > ${v[total_mean]} / 2 && $above <= limit"
		# of one tree, by what the host does beside it: up to 5 % and 20 % more
		limit=$((n == 1 ? 16000 : 24000))
		row "$own" $limit "all instructions of a cycle of an application, native device: $n drive(s)"
		gate "$n slave(s), native device: $own instructions of all work, at most $limit" \
			"$own <= limit"
		reliable "native device"
		[ ${#units[@]} = 0 ] || units_cost
	done
}

# Drives of 44 bytes: the copy of all process data is one of 8 bytes by an instruction, two where
# the outputs are sent from the buffer of an application. Ten drives have 110 values of 4 bytes.
record_cost() {
	local n who copies took limit
	local -A costs=() bytes=()

	echo "# instructions of a cycle for a reader that records all process data"
	for n in 10 100; do
		run "drive$n, recorded" "${icount[@]}" -- virtual drive$n.seg --cycles 300 \
			+ rec --cycles 300 --record + kernel --cycles 300 --kernel timer \
			+ krec --cycles 300 --kernel timer --record || return
		gate "$n drive(s): ${v[rec_recorded]} and ${v[krec_recorded]} records of ${v[rec_record_cycles]} and ${v[krec_record_cycles]} cycles, ${v[rec_lost]} and ${v[krec_lost]} frames lost" \
			"${v[rec_record_cycles]} == 350 && ${v[rec_recorded]} >= 350 &&
			 ${v[krec_record_cycles]} >= 300 &&
			 ${v[krec_recorded]} >= ${v[krec_record_cycles]} - 1 &&
			 ${v[rec_lost]} == 0 && ${v[krec_lost]} == 0"
		costs[own$n]=$((v[rec_send_median] - v[send_median]))
		costs[kernel$n]=$((v[krec_work_median] - v[kernel_work_median]))
		bytes[$n]=${v[image_bytes]}
	done
	for who in own kernel; do
		copies=$([ $who = own ] && echo 1 || echo 2)
		took=$((costs[${who}100] - costs[${who}10]))
		# a word of a copy is counted twice by some
		limit=$(((bytes[100] - bytes[10]) * copies * (slack > 100 ? 2 : 1) / 8 * 105 / 100))
		echo "# cycle of $who: ${costs[${who}10]} instructions for ${bytes[10]} bytes, ${costs[${who}100]} for ${bytes[100]}: $(ratio $took $((bytes[100] - bytes[10]))) a byte"
		row "${costs[${who}10]}" $((110 * 12)) "instructions of a recorded cycle of $who more: 110 values of 4 bytes"
		gate "cycle of $who: ${costs[${who}10]} instructions for 110 values, at most 12 each" \
			"${costs[${who}10]} > 0 && ${costs[${who}10]} <= 110 * 12"
		gate "cycle of $who: $took instructions for $((bytes[100] - bytes[10])) bytes more, at most $limit: $copies for 8 bytes" \
			"took > 0 && took <= limit"
	done
}

# The same cycle with one native device, and with one at each end of a ring, closed and open.
ring_cost() {
	local n state limit one two mean work work1
	local -A most=([closed]=140 [open]=160) mean_most=([closed]=142 [open]=160)

	echo "# a ring with two native devices, of what one device costs"
	for n in 1 100; do
		run "drive$n, native" "${icount[@]}" --nics -- native "drive$n.seg" --cycles 300 \
			--period-us 4100 || return
		one=${v[total_median]} mean=${v[total_mean]}
		echo "# one device: $one instructions of the calls, median; $mean on the mean"
		work "" 4100 "one device"; work1=$work
		for state in closed open; do
			[ $n-$state != 1-open ] || continue
			run "ring$n, $state" "${icount[@]}" --nics --more-nics e1000e -- ring \
				"ring$n$([ $state = closed ] || echo -open).seg" --cycles 300 \
				--period-us 4100 || return
			cost ring
			reliable "ring, $state"
			work "" 4100 "ring, $state"
			echo "# all work: $(ratio "$work" "$work1") of that with one device"
			limit=$((one * ${most[$state]} / 100))
			two=${v[total_median]}
			row "$two" $limit "instructions of the calls, median, ring $state: $n drive(s)"
			gate "$n drive(s), ring $state: $two instructions, median, $(ratio $two $one) of one" \
				"two > one && two <= limit"
			# with the cycles in it that carry a datagram of the monitor, and the frames
			# of one or two of its rounds that read line errors
			limit=$((mean * ${mean_most[$state]} / 100))
			two=${v[total_mean]}
			row "$two" $limit "the same, mean"
			gate "$n drive(s), ring $state: $two instructions on the mean, $(ratio $two $mean) of one" \
				"two > mean && two <= limit"
		done
	done
}

# calls DEVICE DRIVES [OPTION...]: of the application's cycle, mean, in $calls
calls() {
	run "$2 drives, $1" "${icount[@]}" --nics -- "$1" "drive$2.seg" --cycles 300 \
		--period-us 4000 "${@:3}" || return
	calls=${v[total_mean]}
}

# Differences of runs in which one thing changes. A datagram holds 1486 bytes at most, so 4400
# bytes are three, each a frame of its own, and 22000 are 15.
unit_costs() {
	local device=$1 calls c1 c10 c100 c500 apart fit byte datagram frame cycle

	calls "$device" 1 && c1=$calls && calls "$device" 10 && c10=$calls &&
		calls "$device" 100 && c100=$calls && calls "$device" 500 && c500=$calls &&
		calls "$device" 10 --domains 10 && apart=$calls || return
	fit=$(awk -v c1="$c1" -v c10="$c10" -v c100="$c100" -v apart="$apart" 'BEGIN {
		byte = (c10 - c1) / (440 - 44)
		datagram = (apart - c10) / 9
		frame = (c100 - c10 - byte * 3960 - datagram * 2) / 2
		cycle = c1 - frame - datagram - byte * 44
		printf "%.2f %.0f %.0f %.0f %.0f\n", byte, datagram, frame, cycle,
			cycle + 15 * (frame + datagram) + 22000 * byte
	}')
	read -r byte datagram frame cycle fit <<<"$fit"
	echo "# $device device: a byte (process data, 22 a direction and slave) costs $byte instructions,"
	echo "# a datagram and its domain $datagram, a frame $frame, a cycle $cycle more"
	gate "$device device: 500 drives in 15 frames cost $c500 instructions of the calls, $(ratio "$c500" "$fit") of what these make; at most 1.05" \
		"c500 > c100 && c500 * 100 <= fit * 105"
}

virtual_cost() {
	echo "# the same, virtual device: the calls contain the work of the simulator"
	run "drive1, virtual" "${icount[@]}" -- virtual drive1.seg --cycles 500 || return
	cost virtual
}

system_calls() {
	local n options

	for n in ${all:+1} 8; do
		options="--cycles 100 --domains $n --extras --syscalls"
		run "system calls" "${icount[@]}" -- virtual drive10.seg $options \
			+ wait $options --kernel wait + spin $options --kernel spin || return
		gate "$n domain(s), clocks, state queries, emergencies, requests: ${v[syscalls_max]} system calls per cycle, at most 2" \
			"${v[syscalls_max]} <= 2 && ${v[requests_done]} > 0"
		row "${v[syscalls_max]}" 2 "system calls a cycle: $n domain(s)"
		gate "the same, the kernel runs the cycle: ${v[wait_syscalls_max]} when the application waits, at most 1" \
			"${v[wait_syscalls_max]} <= 1 && ${v[wait_requests_done]} > 0"
		row "${v[wait_syscalls_max]}" 1 "the same, the kernel runs the cycle, the application waits"
		gate "and ${v[spin_syscalls_max]} when it spins" \
			"${v[spin_syscalls_max]} == 0 && ${v[spin_cycles]} == 100"
		row "${v[spin_syscalls_max]}" 0 "the same, it spins"
	done
}

# Master and simulator in one VM, as a virtual device, at 1 kHz. SEGMENT TEXT LIMIT: the
# limit is that of all instructions of a cycle.
together() {
	run "$1, 1 kHz" "${icount[@]}" -- virtual "$1" --cycles 500 || return
	reliable "1 kHz, icount, virtual device, $2"
	work=$((${v[application_work]} + ${v[card_work]} + ${v[master_work]} + ${v[rest_work]} + ${v[simulator_work]}))
	row $work "$3" "all instructions of master and simulator a cycle: $2"
	gate "$2: $work instructions of master and simulator a cycle, at most $3; ${v[overruns]} overruns" \
		"work > 0 && work <= $3 && ${v[overruns]} == 0"
}

# The same in real time. Its lateness depends on what else the host does; the CPU time that
# the VM needs for a cycle hardly does: each of its CPUs has a millisecond.
together_real_time() {
	local cycles=5050 lenient=1

	run "$1, real time" --smp 2 -- virtual "$1" --cycles 3000 --ready 100 --work 5000 || return
	echo "# real time ($accel), $2: ${v[cycles]} cycles of 1 ms: ${v[lost]} frames lost; not gated: ${v[overruns]} cycles skipped, ${v[wc_errors]} working-counter errors while the host did something else"
	row $((${v[host_thread_ns]} / cycles)) 1000000 "ns of the busiest host thread of the VM for a cycle of 1 ms: $2"
	gate "$2: a cycle of 1 ms takes $((${v[host_thread_ns]} / cycles / 1000)) us of the VM's busiest thread on the host, $((${v[host_cpu_ns]} / cycles / 1000)) us of all; less than 1000 of the busiest" \
		"${v[host_thread_ns]} < cycles * 1000000 && ${v[lost]} == 0"
}

in_real_time() {
	run "real time" --smp 2 -- virtual bench --cycles 5000 || return
	echo "# real time, not gated: ${v[cycles]} cycles: ${v[lost]} frames lost, ${v[wc_errors]} working-counter errors, ${v[overruns]} overruns"
	echo "# lateness: median ${v[late_ns_median]} ns, 99.9 % ${v[late_ns_p999]} ns, max ${v[late_ns_max]} ns"
}

if [ -n "$only" ]; then
	${only}_cost
	echo "$passed passed, $failed failed"
	[ $failed = 0 ]
	exit
fi
long_run
record_cost
generic_cost
# not 4000: the phase to the clock tick of 4 ms would count
native_cost 4100
native_cost 1000
[ -z "$all" ] || { unit_costs generic; unit_costs native; }
[ -z "$all" ] || virtual_cost
system_calls
together io1000.seg "1000 slaves of one byte, 1000 frames/s" 240000
together drive100.seg "100 drives, 3000 frames/s" 240000
if [ -n "$all" ]; then
	in_real_time
	accel=$(tests/vm/run.sh --probe)
	together_real_time io1000.seg "1000 slaves of one byte, 1000 frames/s"
	together_real_time drive100.seg "100 drives, 3000 frames/s"
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
