# SPDX-License-Identifier: GPL-2.0-only
# From the scan to OP and back, and the values of a cycle: what an architecture must do.

load helpers

setup_file() { start bench 22; }
teardown_file() { stop; }

@test "22 slaves are in PREOP with their names and identities" {
	ethercat slaves
	ethercat slaves | grep -qE '^ *0 +1:0 +PREOP +\+ +EK1100 Coupler$'
	ethercat slaves -p0 -v | grep -q 'Vendor.*0x00000002'
	[ "$(ethercat upload -p4 -t uint32 0x1018 1)" = "0x00000002 2" ]
}

@test "22 slaves run in OP for 500 cycles and each value arrives" {
	run "$EC_BUILD/apps/demo" --cycles 500 --period-us 2000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"Slaves: 22, in OP: 22"* ]]
	[[ "$output" == *"Cycles: 500 of 500"* ]]
	[[ "$output" == *"Working counter errors: 0, lost frames: 0"* ]]
	[[ "$output" == *"Analog output measured: "*" 0 of 500 values off"* ]]
	wait_for 60 all_slaves_are PREOP 22
}

@test "the kernel runs the cycle and the application reads its figures" {
	run "$EC_BUILD/apps/kcycle" cycles=500 period=2000
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"22 slaves in OP"* ]]
	[[ "$output" == *"cycles: 500, working counter errors: 0, "* ]]
	[[ "$output" == *"kernel: running, "*"overruns: 0, "* ]]
}

@test "slaves that were cut off are back in OP 300 ms after the cable is whole" {
	[ "$(uname -m)" = x86_64 ] || skip "a time for a fast machine"
	"$EC_BUILD/apps/demo" --cycles 1000000 >"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	app=$!
	wait_for 120 all_slaves_are OP 22
	# 100 ms of link without loss, and 200 ms; three slaves, one after the other
	back_in_ms /sys/kernel/debug/ec_sim/sim0 'cut coupler3.0' 'heal coupler3.0' 300 22
	kill -9 $app
	wait_for 120 all_slaves_are PREOP 22
}
