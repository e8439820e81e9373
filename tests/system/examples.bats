# SPDX-License-Identifier: GPL-2.0-only
# The applications of examples/, and what they did to the segment.

load helpers

setup_file() {
	{
		printf '%s\n' "segment seed=12" "slave coupler EK1100 drift=500ppm" "slave in EL1008" \
			"slave out EL2008" "const in.2 value=1" "const in.7 value=1" \
			"ramp in.8 amplitude=2 period=100ms" \
			"slave axis1 drive mapping=rewritable drift=40ppm" \
			"slave axis2 drive mapping=rewritable drift=-70ppm"
	} >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 5
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	wait "${app:-}" 2>/dev/null || true
	# a case that failed leaves its cycle to the kernel
	ethercat release >/dev/null 2>&1 || true	# there may be none
	wait_for 60 all_slaves_are PREOP 5
}

# example NAME [ARG...]: in the background, its output in $out
example() {
	out=$BATS_TEST_TMPDIR/out
	"$EC_BUILD/examples/$1" "${@:2}" >"$out" 2>&1 3>&- &
	app=$!
}

# refused ARG...: exit code 2, the last argument is named, then the usage
refused() {
	run "$EC_BUILD/examples/$1" "${@:2}"
	echo "$output"
	[ "$status" = 2 ]
	[[ ${lines[0]} == "$1: invalid argument '${*: -1}'" ]]
	[[ ${lines[1]} == "usage: $1 "* ]]
	[ "$("$EC_BUILD/examples/$1" "${@:2}" 2>/dev/null | wc -c)" = 0 ]
}

@test "each example has a usage, and refuses invalid arguments" {
	for f in "$EC_BUILD"/examples/*; do
		[[ $f != *.d ]] || continue
		run "$f" --help
		echo "$output"
		[ "$status" = 0 ]
		[[ ${lines[0]} == "usage: ${f##*/} "* && $output == *"exit status: 0 "* ]]
		[ "$("$f" --help 2>&1 >/dev/null | wc -c)" = 0 ]
		refused "${f##*/}" fast
		refused "${f##*/}" -1
	done
	refused mirror 1 2 0
	refused mirror 1 2x
	refused mirror 65536
	refused mirror 1 2 3 4
	refused analog 2 3 0
	refused analog 2 3 4 5
	refused kcycle 0
	refused kcycle 5 follow 6
	refused dc_motion 4
	refused dc_motion lead 4 5 0
	refused dc_motion lead 4 5 6 7
	refused sdo_requests 1 2
	run "$EC_BUILD/examples/dc_motion" lead 3 3
	[ "$status:$output" = "2:dc_motion: FIRST and SECOND are both 3" ]
	run "$EC_BUILD/examples/sdo_requests"
	[ "$status:${lines[0]}" = "2:sdo_requests: POSITION is missing" ]
	# not one of them has changed a slave
	all_slaves_are PREOP 5
	ethercat master | grep -q 'Active: no'
}

# the byte the terminal switches its outputs by
outputs() { ethercat reg_read -p2 -t uint8 0x0f00 | awk '{ print $1 }'; }

@test "mirror: inputs switch outputs, off at the end" {
	example mirror 1 2
	wait_for 60 grep -qx 'working counter: 3, complete' "$out"
	# input 8 comes and goes
	wait_for 60 grep -qx 'inputs: 0x42' "$out"
	wait_for 60 grep -qx 'inputs: 0xc2' "$out"
	wait_for 60 eval '[ "$(outputs)" = 0x42 ]'
	wait_for 60 eval '[ "$(outputs)" = 0xc2 ]'
	# real-time, in memory
	[ "$(ps -o cls=,rtprio= -p "$app" | xargs)" = "FF 80" ]
	awk '/VmLck/ { exit $2 == 0 }' "/proc/$app/status"
	kill -INT "$app"
	wait "$app"
	[ "$(outputs)" = 0x00 ]
	grep -E '^[0-9]+ cycles, 0 skipped$' "$out"
	[ "$(tail -n 1 "$out")" = "ended by a signal" ]
	app=
}

@test "mirror: an absent slave is reported" {
	example mirror 1 9 2
	! wait "$app" || return 1
	cat "$out"
	grep -qx 'working counter: 1, not complete' "$out"
	grep -E '^2000 cycles, ' "$out"
	grep -qx 'ended after 2 s' "$out"
	grep '^slave 9 is not in OP: no slave at ring position 9' "$out"
	[ "$(grep -c 'is not in OP' "$out")" = 1 ]
	app=
}

@test "why: two wrong positions are two causes, and no gap of the bus" {
	example mirror 2 99 10
	wait_for 60 eval 'ethercat slaves 2>&1 | grep -q "position 99"'
	run ethercat why
	echo "$output"
	[[ $output == *"the device configured at 0:2 is at position 1"* ]]
	[[ $output == *"no slave at ring position 99"* ]]
	[[ $output != *"slave(s) missing from"* ]]
	kill -INT "$app"
	! wait "$app" || return 1
	app=
}

@test "kcycle: values go out, the kernel keeps the cycle" {
	example kcycle 20000
	wait_for 60 grep -qx '3 slaves in OP' "$out"
	# a counter: no value comes twice in a row
	one=$(outputs)
	wait_for 60 eval '[ "$(outputs)" != "$one" ]'
	kill -0 "$app"
	# drives are named and left alone
	[ "$(grep -c ' skipped: .* is a drive$' "$out")" = 2 ]
	for p in 3 4; do
		grep -E "^slave $p skipped: " "$out"
		[ "$(ethercat upload -p$p -t uint16 0x6040 0)" = "0x0000 0" ]
	done
	all_slaves_are PREOP 2
	wait "$app"
	cat "$out"
	grep -E '^20000 cycles, [0-9]+ skipped, 0 incomplete$' "$out"
	grep -E '^kernel: [0-9]+ cycles, 0 overruns, ' "$out"
	[ "$(tail -n 1 "$out")" = "ended after 20000 cycles" ]
	app=
}

@test "kcycle: the kernel's cycle follows the reference clock" {
	example kcycle follow
	wait "$app"
	cat "$out"
	grep -E '^5000 cycles, [0-9]+ skipped, 0 incomplete$' "$out"
	grep -E '^inputs taken up to [0-9]+ ns after their cycle began$' "$out"
	# that clock is 500 ppm too fast
	ppb=$(sed -n 's/^reference clock: runs +\([0-9]*\) ppb, .* lost 0 times$/\1/p' "$out")
	[ "$ppb" -ge 450000 ]
	[ "$ppb" -le 550000 ]
	error=$(sed -n 's/.* phase error -\{0,1\}\([0-9]*\) ns.*/\1/p' "$out")
	[ "$error" -lt 15625 ]
	app=
}

@test "kcycle: the cycle runs in an interrupt, and follows the reference clock there" {
	example kcycle 10000 follow interrupt
	wait_for 60 grep -qx '3 slaves in OP' "$out"
	json '.masters[0].interrupt' cycle
	wait "$app"
	cat "$out"
	grep -E '^10000 cycles, [0-9]+ skipped, 0 incomplete$' "$out"
	grep -E '^kernel: [0-9]+ cycles, 0 overruns, ' "$out"
	grep -E '^reference clock: runs \+[0-9]+ ppb, .* lost 0 times$' "$out"
	app=
}

@test "kcycle: after a signal the kernel goes on, and the example says so" {
	example kcycle 1000000
	wait_for 60 grep -qx '3 slaves in OP' "$out"
	kill -INT "$app"
	wait "$app"
	cat "$out"
	grep -qx 'ended by a signal: the kernel continues the cycle' "$out"
	ethercat master | grep -q 'Session: detached'
	all_slaves_are OP 3
	ethercat release
	app=
}

@test "kcycle: killed, the kernel goes on, and the next one takes over" {
	example kcycle 1000000
	wait_for 60 grep -qx '3 slaves in OP' "$out"
	kill -9 "$app"
	wait "$app" || true
	ethercat master | grep -q 'Session: detached'
	one=$(outputs)
	all_slaves_are OP 3
	[ "$(outputs)" = "$one" ]
	example kcycle 500
	wait "$app"
	cat "$out"
	grep -qx '3 slaves in OP; cycle taken over' "$out"
	grep -E '^500 cycles, [0-9]+ skipped, 0 incomplete$' "$out"
	app=
}

@test "dc_motion: a drive that cannot reach OP is named, exit code 1" {
	# an input terminal is no drive
	example dc_motion lead 3 1 4
	rc=0
	wait "$app" || rc=$?
	cat "$out"
	[ "$rc" = 1 ]
	grep -E '^slave 1 is not in OP: .' "$out"
	grep -qx 'ended without OP' "$out"
	app=
}

@test "dc_motion: the reference clock follows, both axes move" {
	example dc_motion lead 3 4 8
	wait "$app"
	cat "$out"
	moved
	# a clock that is 500 ppm too fast learns our rate from frames that jitter
	error=$(sed -n 's/^reference clock [-+]\([0-9]*\) ns.*/\1/p' "$out")
	[ "$(echo "$error" | tail -n 1)" -lt 20000 ]
	[ "$(echo "$error" | sort -n | tail -n 1)" -lt 100000 ]
	app=
}

@test "dc_motion: the application follows the reference clock" {
	example dc_motion follow 3 4 8
	wait "$app"
	cat "$out"
	moved
	# it is 500 ppm too fast; late wake-ups are noise on that
	ppm=$(sed -n 's/^the reference clock runs +\([0-9]*\) ppm .*/\1/p' "$out")
	[ "$ppm" -ge 250 ]
	[ "$ppm" -le 750 ]
	apart=$(sed -n "s/.* within \([0-9]*\) ns .*/\1/p" "$out" | tail -n 1)
	[ "$apart" -lt 1000 ]
	app=
}

@test "dc_motion: one drive" {
	example dc_motion follow 4 - 4
	wait "$app"
	cat "$out"
	[ "$(grep -c '^axis' "$out")" = 1 ]
	grep -qx 'ended after the given time' "$out"
	awk '/^axis/ { exit !($NF >= 90000 && $NF <= 110000) }' "$out"
	app=
}

@test "dc_motion: a fault while it moves stops both drives, and is not reset" {
	example dc_motion follow 3 4
	wait_for 60 grep -E 'axes at [0-9]{4}' "$out"
	# any following error is a fault
	ethercat download -p4 -t uint32 0x6065 0 1
	rc=0
	wait "$app" || rc=$?
	cat "$out"
	[ "$rc" = 1 ]
	grep -E '^ended: a drive has left operation, .* words 0x[0-9a-f]+ 0x..[04]8$' "$out"
	[ $(($(ethercat upload -p3 -t uint16 0x6041 0 | cut -d ' ' -f 1) & 0x4f)) = $((0x40)) ]
	[ $(($(ethercat upload -p4 -t uint16 0x6041 0 | cut -d ' ' -f 1) & 0x4f)) = $((0x08)) ]
	ethercat download -p4 -t uint32 0x6065 0 0xffffffff
	app=
}

# both axes to 100000 counts and back, in step
moved() {
	[ "$(awk '/^axis/ && $NF >= 90000 && $NF <= 110000' "$out" | wc -l)" = 2 ]
}

# what "ethercat dc" says of the two axes while dc_motion runs
clocks_are_shown() {
	wait_for 60 json '[.masters[0].slaves[] | select(.sync[0].active)] | length == 2 and
		all(.[]; .state == "synchronized" or .state == "reference clock")' dc
	ethercat dc
	json '.masters[0] | .largest_difference_ns != null and
		all(.slaves[] | select(.sync[0].active);
			.sync[0].cycle_ns == 1000000 and .dc_offset_ns != null)' dc
	# the registers hold what is configured
	wait_for 60 json '[.masters[0].slaves[] | select(.sync[0].active) | .registers] |
		length == 2 and all(.[]; .sync0_cycle_ns == 1000000 and
			.assign_activate == 768)' dc -v -p4,5
}

# bench_moves [follow [CHECK]]: the defaults, at the built-in bench; CHECK while it runs
bench_moves() {
	stop
	start bench 22
	"$EC_BUILD/examples/dc_motion" ${1:+"$1"} >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	${2:-true}
	wait_for 120 eval '[ "$(grep -c "axes at" "$BATS_TEST_TMPDIR/out")" -ge 8 ]'
	kill -INT "$app"
	wait "$app"
	app=
	out=$BATS_TEST_TMPDIR/out
	cat "$out"
	moved
	[ -z "$(grep 'ended without OP' "$out")" ]
	# for teardown()
	stop
	start "$BATS_FILE_TMPDIR/segment" 5
}

@test "dc_motion at the bench with its defaults" { bench_moves; }
@test "dc_motion at the bench, follow: dc shows clocks and SYNC0" {
	bench_moves follow clocks_are_shown
}

# us from the last activation until the last of the two drives was in OP; the reference clock goes
# there as well, since it is not configured
op_us() {
	ethercat log --json | gojq '.masters[0].events |
		(map(.event) | rindex("activated")) as $at |
		.[$at].monotonic_ns as $began | .[$at:] |
		map(select(.event == "al_state" and .state == "OP" and .slave + .slaves > 3)) |
		if (map(.slave + .slaves - ([.slave, 3] | max)) | add) == 2
		then map(.monotonic_ns - $began) | max / 1000 | floor
		else error("not both drives in OP") end'
}

# soon WITH WITHOUT TEXT: 1.2 times the time and 0.1 s, as that of the VM may leap
soon() {
	echo "# $3: OP after $1 us with the reference clock synchronized to the application," \
		"$2 us without: $((100 * $1 / $2)) %" | tee -a /dev/stderr >&3
	[ "$1" -le $(($2 * 6 / 5 + 100000)) ]
}

@test "dc_motion: in OP as soon with lead as with follow" {
	for reference in follow lead; do
		example dc_motion $reference 3 4 3
		wait "$app"
		eval "$reference=$(op_us)"
	done
	app=
	soon "$lead" "$follow" "dc_motion, 2 drives, cycle of 1000 us"
}

# other segments: at the end of this file
@test "drives are in OP as soon with ecrt_master_sync_reference_clock() as without" {
	for drives in 1 10 100; do
		stop
		printf '%s\n' "segment seed=12" "repeat $drives slave d drive in=8 out=8 drift=100ppm" \
			>"$BATS_TEST_TMPDIR/segment"
		start "$BATS_TEST_TMPDIR/segment" $drives
		for period in 1000 4000; do
			# a millisecond is little for 100 drives of the simulator and their master
			[ "$drives $period" != "100 1000" ] || continue
			out=$("$EC_BUILD/apps/dc_start" $drives $period 2)
			soon "$(sed -n 's/^with_us //p' <<<"$out")" \
				"$(sed -n 's/^without_us //p' <<<"$out")" \
				"$drives drive(s), cycle of $period us"
			wait_for 60 all_slaves_are PREOP $drives
		done
	done
	stop
	start "$BATS_FILE_TMPDIR/segment" 5
}

@test "analog: an output follows an input, with filter and SYNC0" {
	stop
	printf '%s\n' "slave coupler EK1100" "slave ai EL3062" "slave ao EL4002" \
		"const ai.1 value=20000" "connect ao.1 -> ai.2" >"$BATS_TEST_TMPDIR/segment"
	start "$BATS_TEST_TMPDIR/segment" 3
	example analog 1 2 4
	wait_for 60 json '.masters[0].slaves[] | select(.position == 2) |
		.sync[0].active and .sync[0].cycle_ns == 1000000' dc
	[ "$(ethercat upload -p1 -t uint16 0x8000 0x15)" = "0x0002 2" ]
	ethercat upload -p1 -t int16 0x6010 0x11
	wait_for 60 eval '[ "$(ethercat upload -p1 -t int16 0x6010 0x11)" = "0x2710 10000" ]'
	wait "$app"
	cat "$out"
	grep -qx 'input 6.10 V, output 3.05 V' "$out"
	[ "$(tail -n 1 "$out")" = "ended after the given time" ]

	# the same by a bus file: values by name, in volts, with a startup command and SYNC0
	local f=$BATS_TEST_TMPDIR/bus.yaml
	ethercat bus save --whole "$f"
	sed -Ei -e '/object: "0x(6000:11|7000:01)"/s/(name: )[^,}]*/\1voltage/' \
		-e 's/(name: voltage)/\1, unit: V, scale: 0.000305185/' \
		-e 's/^( *)- name: el3062$/&\n\1  startup: [{at: safeop, sdo: "0x8000:15", X}]/' \
		-e 's/X}/type: uint16, value: 3}/' \
		-e 's/^( *)- name: el4002$/&\n\1  clock: {assign_activate: 0x0300, sync0: 1 ms}/' "$f"
	cat "$f"
	example bus_values "$f" el3062.voltage el4002.voltage 2
	wait_for 60 json '.masters[0].slaves[] | select(.position == 2) | .sync[0].active' dc
	wait "$app"
	cat "$out"
	grep -qx '6.10 V in, 6.10 V out' "$out"
	[ "$(ethercat upload -p1 -t uint16 0x8000 0x15)" = "0x0003 3" ]
	run "$EC_BUILD/examples/bus_values" "$f" el3062.voltage el4002.current 2
	[[ $status == 1 && $output == "bus_values: the file has no value el4002.current" ]]
	sed -i s/0x0fa23052/0x0fa23053/ "$f"
	run "$EC_BUILD/examples/bus_values" "$f" el3062.voltage el4002.voltage 2
	echo "$output"
	[[ $status == 1 && $output == *"slave 'el4002' exchanged: expected EL4002"*"product 0x0fa23052"* ]]

	# an output terminal is no input terminal
	run "$EC_BUILD/examples/analog" 2 1
	echo "$output"
	[ "$status" = 1 ]
	[ -n "$output" ]

	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	echo 'refuse ai OP code=0x1d' >/sys/kernel/debug/ec_sim/sim0
	run "$EC_BUILD/examples/analog" 1 2 3
	echo "$output"
	[ "$status" = 1 ]
	[[ ${lines[-1]} == "slave 1 is not in OP: "*0x001d* ]]
	run "$EC_BUILD/examples/kcycle"
	echo "$output"
	[ "$status" = 1 ]
	[ "$(grep '^kcycle: slave . is not in OP: ' <<<"$output" | cut -c 9-15)" = "slave 1" ]
	app=
	stop
	start "$BATS_FILE_TMPDIR/segment" 5
}
