# SPDX-License-Identifier: GPL-2.0-only
# The thin slice: one coupler, one output terminal.

load helpers

setup_file() {
	start thin 2
	# QEMU's e1000 keeps frames back for a second after its receiver was switched on
	export lost=0
	[ "${EC_NIC:-}" != e1000 ] || lost=$(lost_frames)
}
teardown_file() { stop; }

@test "the segment is scanned and shown" {
	run ethercat slaves
	[ "$status" = 0 ]
	[ "${lines[0]}" = "0  0:0  PREOP  +  EK1100 Coupler" ]
	[ "${lines[1]}" = "1  0:1  PREOP  +  EL2008 8-ch output" ]
	[ "${#lines[@]}" = 2 ]
}

@test "the master reports its device and no lost frame" {
	run ethercat master
	[ "$status" = 0 ]
	[[ "$output" == *"Phase: Idle"* ]]
	[[ "$output" == *"(attached)"* ]]
	[ "$(lost_frames)" = "$lost" ]
}

# what costs an ioctl or a packet here costs it at the user's
@test "the kernel runs the security modules of the distribution" {
	[ "$(cat /sys/module/apparmor/parameters/enabled)" = Y ]
	[ ! -e /sys/fs/selinux ]
}

@test "a register is read from the slave" {
	run ethercat reg_read -p1 -t uint16 0x0010
	[ "$status" = 0 ]
	[[ "$output" == "0x000"?" "? ]]
}

@test "a slave goes to SAFEOP and back" {
	ethercat states -p1 SAFEOP
	wait_for 120 state_is 1 SAFEOP
	ethercat states -p1 PREOP
	wait_for 120 state_is 1 PREOP
}

@test "a position that does not exist is an error" {
	run ethercat reg_read -p7 -t uint16 0x0010
	[ "$status" = 1 ]
}

@test "the device goes away and comes back" {
	unplug
	ethercat master | grep -q 'Waiting for device'
	load_segment thin
	wait_for 120 all_slaves_are PREOP 2
}

@test "the modules unload and load again" {
	stop
	start thin 2
}

state_is() { [ "$(ethercat slaves -p"$1" | awk '{ print $3 }')" = "$2" ]; }
