# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --more-nics e1000 --timeout 600
# Two masters at two network cards: the native device and the generic one. ec_sim answers the
# first, the program ethercat-sim the second.

load helpers

setup_file() {
	modprobe e1000e
	modprobe e1000
	local m

	for m in 0 1 2 3; do export "card$m=$(card $m)"; done
	native=$(pci "$card0")
	export native
	insmod "$EC_BUILD/modules/master/ec_master.ko" \
		main_devices=52:54:00:ec:00:00,52:54:00:ec:00:02
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=bench netdev="$card1"
	# above the program that it answers: there is one CPU
	ip link set "$card3" up
	chrt -f 95 "$EC_BUILD/tool/ethercat-sim" -s thin "$card3" \
		>"$BATS_FILE_TMPDIR/sim" 2>&1 3>&- &
	echo $! >"$BATS_FILE_TMPDIR/sim.pid"
	wait_for 60 grep -q 'slave(s), at ' "$BATS_FILE_TMPDIR/sim"
	wait_for 60 has_carrier "$card1"
	wait_for 60 has_carrier "$card3"
	plug_native
	plug_generic
	wait_for 120 slaves_are 0 PREOP 22
	wait_for 120 slaves_are 1 PREOP 2
}

teardown_file() {
	stop
	kill "$(cat "$BATS_FILE_TMPDIR/sim.pid")"
}

teardown() {
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
}

# card NUMBER: interface of the card with that MAC address
card() { basename "$(dirname "$(grep -lx "52:54:00:ec:00:0$1" /sys/class/net/*/address)")"; }

plug_native() {
	insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	[ ! -e "/sys/class/net/$card0" ] || driver "$native" ec_intel
}

plug_generic() { insmod "$EC_BUILD/modules/devices/ec_generic.ko"; }

# slaves_are MASTER STATE COUNT
slaves_are() {
	[ "$(ethercat slaves -m "$1" 2>/dev/null | awk -v s="$2" '$3 == s' | wc -l)" = "$3" ]
}

# waits MASTER: for its device
waits() { ethercat master -m "$1" | grep -q 'Waiting for device'; }
lost() { ethercat master -m "$1" --json | gojq '.masters[0].common.lost_frames'; }
reattached() { ethercat master -m "$1" | grep -q '(attached)'; }

# runs PROGRAM ARG...: in the background
runs() {
	local name=$1

	shift
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/$name" "$@" \
		>"$BATS_TEST_TMPDIR/$name" 2>&1 3>&- &
	app=$!
}

ends() {
	kill -TERM $app
	wait $app || true
	app=
}

@test "one master has the native device, the other the generic one" {
	ethercat devices
	json '.masters[0].devices[0] | .interface == env.native and (.mac | endswith(":00:00"))' \
		master
	json '.masters[1].devices[0] | .interface == env.card2 and (.mac | endswith(":00:02"))' \
		master
	json '[.devices[] | select(.used_by == "Master0 main") | .driver] == ["ec_intel"]' devices
	json '[.devices[] | select(.used_by == "Master1 main") | .driver] == ["e1000"]' devices
}

@test "both segments are in OP at a time, no frame is lost" {
	before0=$(lost 0) before1=$(lost 1)
	runs kcycle master=1 cycles=1000000 period=4000 priority=90
	wait_for 60 slaves_are 1 OP 2
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --master 0 --cycles 2000 --wired
	slaves_are 1 OP 2
	ends
	wait_for 60 slaves_are 1 PREOP 2
	[ "$(lost 0)" = "$before0" ]
	[ "$(lost 1)" = "$before1" ]
}

@test "the native driver leaves while the generic device is in OP" {
	runs kcycle master=1 cycles=5000 period=4000 priority=90
	wait_for 60 slaves_are 1 OP 2
	before=$(lost 1)
	rmmod ec_intel
	waits 0
	sleep 2
	plug_native
	wait_for 120 slaves_are 0 PREOP 22
	slaves_are 1 OP 2
	kill -0 $app
	[ "$(lost 1)" = "$before" ]
	wait $app
	app=
	grep 'working counter errors: 0, ' "$BATS_TEST_TMPDIR/kcycle"
	wait_for 60 slaves_are 1 PREOP 2
}

@test "the generic device leaves while the native one is in OP" {
	runs demo --master 0 --cycles 1000000
	wait_for 60 slaves_are 0 OP 22
	before=$(lost 0)
	rmmod ec_generic
	waits 1
	sleep 2
	plug_generic
	wait_for 120 slaves_are 1 PREOP 2
	slaves_are 0 OP 22
	kill -0 $app
	[ "$(lost 0)" = "$before" ]
	ends
	cat "$BATS_TEST_TMPDIR/demo"
	grep 'Working counter errors: 0, ' "$BATS_TEST_TMPDIR/demo"
	wait_for 60 slaves_are 0 PREOP 22
}
