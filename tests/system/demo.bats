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

# what of it comes after building, on a segment of four slaves with $1 as well
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
	CYCLES=1000 PERIOD_US=2000 SEGMENT=$BATS_TEST_TMPDIR/some.seg SLAVES=4 \
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
