# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 600
# The generic device at a NIC with its unmodified driver, slaves at another one.

load helpers

setup_file() {
	modprobe e1000e
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=52:54:00:ec:00:00
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=bench netdev=eth1
	wait_for 120 all_slaves_are PREOP 22
}

teardown_file() { stop; }

@test "all slaves go to OP, no frame is lost" {
	before=$(lost_frames)
	run env LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}

@test "the driver of the NIC is unloaded and loaded again" {
	modprobe -r e1000e
	[[ "$(says Main)" == *"(waiting...)" ]]
	modprobe e1000e
	wait_for 120 all_slaves_are PREOP 22
}

@test "rtcheck reads the settings of the card from its driver" {
	ethtool -C eth0 rx-usecs 3
	run ethercat rtcheck
	echo "$output"
	[[ $output == *"card "*"Master0 main: eth0 with the driver e1000e and its interrupts"* ]]
	[[ $output == *"eth0: received frames wait by load (rx-usecs 3)"* ]]
	[ "$status" = 1 ]
	ethtool -C eth0 rx-usecs 0
	run ethercat rtcheck
	[[ $output == *"eth0: received frames do not wait"* ]]
}

@test "another card while the master is there: generic, native, generic" {
	local native

	native=$(pci eth0)
	modprobe veth
	ip link add veth0 type veth peer name veth1
	ip link set veth1 up
	# above the program that it answers: there is one CPU
	chrt -f 95 "$EC_BUILD/tool/ethercat-sim" -s thin veth1 >"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	sim=$!
	wait_for 60 grep -q 'slave(s), at ' "$BATS_TEST_TMPDIR/sim"
	ethercat device use veth0
	wait_for 60 all_slaves_are PREOP 2
	refused "has not its native driver; use its interface eth0" device use "$native"
	insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	ethercat device bind --force eth0
	ethercat device use "$native"
	wait_for 60 all_slaves_are PREOP 22
	ethercat devices | grep "^- .* $native .*Master0 main .*in use"
	ethercat device use veth0
	wait_for 60 all_slaves_are PREOP 2
	ethercat device unbind "$native"
	ethercat device use eth0
	wait_for 60 all_slaves_are PREOP 22
	run env LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000 --wired
	[ "$status" = 0 ]
	kill $sim
	ip link del veth0
}
