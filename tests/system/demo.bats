# SPDX-License-Identifier: GPL-2.0-only
# make demo HOST=1 on the running kernel: here the guest's, in exact guest time.
# vm: --icount --mem 1536 --timeout 900

bats_require_minimum_version 1.5.0

setup() { cd "$BATS_TEST_DIRNAME/../.." || return; }
teardown() { rmmod ec_sim ec_intel ec_master 2>/dev/null || true; }

# with the variables that the modules were built with, else they are built again here
demo() {
	# shellcheck disable=SC2086
	make -s demo HOST=1 EC_BUILD="$EC_BUILD" ${EC_WARN:-} "$@"
}

# on_segment LINES [SLAVES]: what of it comes after building, on a segment of four slaves, or more
# in LINES
on_segment() {
	cat >"$BATS_TEST_TMPDIR/some.seg" <<-END
	segment seed=1
	slave coupler EK1100
	slave dio EL1859
	slave ai EL3062
	slave ao EL4002
	ramp dio.1 amplitude=2 period=200ms
	connect dio.1 -> dio.5
	sine ai.1 amplitude=10000 period=1s
	$1
	END
	CYCLES=1000 PERIOD_US=2000 SEGMENT=$BATS_TEST_TMPDIR/some.seg SLAVES=${2:-4} \
		run tests/demo/bench.sh "$BATS_TEST_TMPDIR"
	echo "$output"
}

@test "make demo HOST=1 passes and its capture is valid for tshark" {
	run demo CYCLES=2000 PERIOD_US=2000
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"22 slaves in PREOP"* ]]
	[[ "$output" == *"Slaves: 22, in OP: 22"* ]]
	[[ "$output" == *"Cycles: 2000 of 2000, every 2000 us"* ]]
	[[ "$output" == *"Working counter errors: 0, lost frames: 0"* ]]
	[[ "$output" == *"Analog output measured: "*" 0 of 2000 values off"* ]]
	[[ "$output" != *"FAILED"* ]]
	[[ "$output" == *"malformed: 0"* ]]
	[[ "${lines[-1]}" == *"demo: passed" ]]
	run ! grep -q '^ec_' /proc/modules
}

@test "loaded modules are not changed" {
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0
	run demo
	echo "$output"
	[ "$status" != 0 ]
	[[ "$output" == *"ec_master is loaded already"*"rmmod"* ]]
	grep -q '^ec_master ' /proc/modules
}

@test "without headers make demo names the package to install" {
	run demo KDIR=/nowhere
	[ "$status" != 0 ]
	[[ "$output" == *"no kernel headers at /nowhere"*"apt-get install linux-headers-"* ]]
}

@test "a run of no cycles is refused" {
	run demo CYCLES=0
	[ "$status" != 0 ]
	[[ "$output" == *"CYCLES=0 is no number"* ]]
}

@test "lost frames fail the demo" {
	on_segment "connect ao.1 -> ai.2
	fault lose rate=20000ppm"
	[ "$status" = 1 ]
	[[ "$output" == *"FAILED no frame lost, no call failed"* ]]
}

@test "an output that is not wired fails the demo" {
	on_segment "# no connect"
	[ "$status" = 1 ]
	[[ "$output" == *"ok     digital input comes back from the output"* ]]
	[[ "$output" == *"FAILED analog input comes back from the output"* ]]
}

# in_op SLAVES COMMAND...: in the background, half a second after all of them are in OP
in_op() {
	(
		set +e
		until [ "$("$EC_BUILD/tool/ethercat" slaves 2>/dev/null | grep -c ' OP ')" = "$1" ]; do
			sleep 0.1
		done
		sleep 0.5
		"${@:2}"
	) >"$BATS_TEST_TMPDIR/in_op" 2>&1 3>&- &
}

still() { insmod "$EC_BUILD/mini/load/ec_still.ko"; }

fault() {
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	# sim0, or an interface with EC_NIC
	echo "$*" | tee /sys/kernel/debug/ec_sim/*
}

# above the priority of the cycle, for 0.3 s
hog() {
	chrt -f 90 bash -c 'e=$((${EPOCHREALTIME/./} + 300000))
		while [ ${EPOCHREALTIME/./} -lt $e ]; do :; done'
}

# some cycles with a wrong working counter
wrong_counter() {
	fault wkc dio add=1
	sleep 0.05
	fault wkc dio add=0
}

still_then_off() { still; fault lose frame=1; fault off axis; }
wrong_then_still() { wrong_counter; sleep 0.1; still; }
hog_then_wrong() { hog; wrong_counter; }

# a frame is lost meanwhile, and a drive leaves OP and is not back yet
@test "a machine that stands still is no failure of the master, and the text says so" {
	in_op 5 still_then_off
	on_segment "connect ao.1 -> ai.2
	slave axis EL7201 motor=AM8121" 5
	rmmod ec_still
	[ "$status" = 0 ]
	local check
	for check in "all slaves in OP" "no frame lost, no call failed" "no working counter error"; do
		grep -qx "still  $check" <<<"$output" || { echo "not said: $check"; return 1; }
	done
	[[ "$output" =~ "The machine stood still "[0-9]+" time(s), for up to 1"[67][0-9]" ms:" ]]
	[[ "$output" == *" check(s), marked 'still', missed"*"no failure"*"of the master"* ]]
	[[ "$output" != *FAILED* ]]
}

@test "an error before the machine stands still is a failure" {
	in_op 4 wrong_then_still
	on_segment "connect ao.1 -> ai.2"
	rmmod ec_still
	[ "$status" = 1 ]
	[[ "$output" == *$'\nFAILED no working counter error\n'* ]]
	[[ "$output" == *"The machine stood still "* && "$output" != *$'\nstill '* ]]
}

@test "a program that keeps the CPU is no machine that stands still" {
	in_op 4 hog_then_wrong
	on_segment "connect ao.1 -> ai.2"
	[ "$status" = 1 ]
	[[ "$output" == *$'\nFAILED no working counter error\n'* ]]
	[[ "$output" != *"stood still"* && "$output" != *$'\nstill '* ]]
}

@test "a capture with a mangled frame is noticed" {
	# one LRD of 1000 bytes in a frame that has 46
	{
		printf '\xd4\xc3\xb2\xa1\x02\x00\x04\x00\x00\x00\x00\x00\x00\x00\x00\x00\xff\xff\x00\x00\x01\x00\x00\x00'
		printf '\x00\x00\x00\x00\x00\x00\x00\x00\x3c\x00\x00\x00\x3c\x00\x00\x00'
		printf '\xff\xff\xff\xff\xff\xff\x02\x00\x00\x00\x00\x01\x88\xa4\x2c\x10\x0a\x00\x00\x00\x00\x00\xe8\x03\x00\x00'
		head -c 34 /dev/zero
	} >"$BATS_TEST_TMPDIR/bad.pcap"
	run tests/demo/capture.sh "$BATS_TEST_TMPDIR/bad.pcap" 1
	echo "$output"
	[ "$status" != 0 ]
	[[ "$output" == *"malformed: 1"* ]]
}

@test "a segment without those terminals is refused" {
	CYCLES=10 PERIOD_US=2000 SEGMENT=thin SLAVES=2 run tests/demo/bench.sh "$BATS_TEST_TMPDIR"
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"--wired needs an EL3062, an EL4002 and an EL1859"* ]]
	run ! grep -q '^ec_' /proc/modules
}
