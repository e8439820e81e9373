# SPDX-License-Identifier: GPL-2.0-only
# Two masters in one kernel, each with its segment, used at the same time.

load helpers

setup_file() {
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=61
	repeat 2 slave s io in=6400 out=6400
	slave d io in=8 out=8
	connect s1.1 -> s1.1
	connect s1.200 -> s1.200
	connect s2.1 -> s2.1
	connect s2.200 -> s2.200
	END
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0,sim1
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" \
		segment="bench,$BATS_FILE_TMPDIR/segment"
	wait_for 120 all_slaves_are PREOP 25
	export LD_LIBRARY_PATH=$EC_BUILD/lib
	# period in us, and how many times fewer cycles: two real-time threads of 1 ms take all
	# of the time of a guest with KCSAN
	export us=1000 fewer=1
	[ ! -e /sys/kernel/debug/kcsan ] || export us=20000 fewer=50
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	wait_for 60 all_slaves_are PREOP 25
}

lost() { ethercat master -m "$1" --json | gojq '.masters[0].common.lost_frames'; }

@test "each has its device and its slaves" {
	json '.masters | length == 2' master
	json '.masters[1].devices[0] | .interface == "sim1" and .mac == "02:00:00:ec:51:01"' master
	[ "$(ethercat slaves -m0 | wc -l)" = 22 ]
	[ "$(ethercat slaves -m1 | wc -l)" = 3 ]
}

@test "the kernel's cycle on one, a program's on the other, the tool on both" {
	# the domain is sent overlapped; loop: its outputs come back whole. Above the
	# program's priority of 80, which locks memory for milliseconds when it begins
	"$EC_BUILD/apps/kcycle" master=1 cycles=$((60000 / fewer)) period=$us \
		loop=1 options=1 priority=90 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	"$EC_BUILD/apps/demo" --master 0 --cycles $((15000 / fewer)) --period-us $us \
		--wired >"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	demo=$!
	wait_for 60 json '.masters | all(.active)' master
	ethercat upload -m0 -p4 0x1008 0
	[ "$(ethercat slaves -m1 | awk '$3 == "OP"' | wc -l)" = 3 ]
	ethercat domains -m1 -v | grep -q 'Options: overlap'
	json '.masters[0].domains[0] | .options == ["overlap"] and .datagrams == 2 and
		.working_counter == .expected_working_counter' domains -m1
	json '.masters[0].cycle | .frames == 2 and .wire_ns == 136400 and .late_cycles == 0' master -m1
	json '.masters[0].domains[0].options == []' domains -m0
	kill -0 $demo
	wait $demo || { cat "$BATS_TEST_TMPDIR/demo"; false; }
	kill -0 $app
	wait $app
	app=
	cat "$BATS_TEST_TMPDIR/out"
	grep -q 'working counter errors: 0, .*torn: 0' "$BATS_TEST_TMPDIR/out"
	grep -q 'overruns: 0,' "$BATS_TEST_TMPDIR/out"
	[ "$(lost 0)" = 0 ]
	[ "$(lost 1)" = 0 ]
}

@test "an application is killed: the other master does not notice" {
	"$EC_BUILD/apps/kcycle" master=1 cycles=1000000 period=$us \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q 'in OP' "$BATS_TEST_TMPDIR/out"
	"$EC_BUILD/apps/demo" --master 0 --cycles $((15000 / fewer)) --period-us $us \
		--wired >"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	demo=$!
	wait_for 60 json '.masters | all(.active)' master
	kill -9 $app
	wait $app || true
	app=
	wait_for 60 json '.masters[0].active | not' master -m1
	kill -0 $demo
	wait $demo || { cat "$BATS_TEST_TMPDIR/demo"; false; }
	[ "$(lost 0)" = 0 ]
}
