# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --more-nics e1000e --monitor --timeout 1200
# A ring with a device at each end: virtual, generic, native and mixed. Each cable is cut while
# process data are exchanged.

load helpers

sim=/sys/kernel/debug/ec_sim/sim0
slaves=8

setup_file() {
	# outputs and inputs by turns; each input is wired to an output at the other end of the ring
	for i in 1 2 3 4; do printf 'slave o%s EL2008\nslave i%s EL1008\n' $i $i; done \
		>"$BATS_FILE_TMPDIR/segment"
	cat >>"$BATS_FILE_TMPDIR/segment" <<-'END'
	connect o1.1 -> i4.1
	connect o2.1 -> i3.1
	connect o3.1 -> i2.1
	connect o4.1 -> i1.1
	wire i4.1 -> master.1 cable=50
	END
	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	modprobe -a veth e1000e
}

setup() { segment=$BATS_FILE_TMPDIR/segment; }

teardown() {
	[ -z "${app:-}" ] || kill -9 $app 2>/dev/null || true
	ethercat stop 2>/dev/null || true	# mostly nothing runs
	stop
	for d in veth0 veth2; do ip link del $d 2>/dev/null || true; done
	[ ! -e "$BATS_TEST_TMPDIR/native" ] || driver "$(cat "$BATS_TEST_TMPDIR/native")" e1000e
}

master() { insmod "$EC_BUILD/modules/master/ec_master.ko" "$@"; }
simulator() { insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment="$segment" "$@"; }
generic() { insmod "$EC_BUILD/modules/devices/ec_generic.ko"; }

# virtual: the ring at sim0 and sim0b
virtual() {
	master main_devices=sim0 backup_devices=sim0b
	simulator
	wait_for 60 all_slaves_are PREOP $slaves
}

# ring STATE: what 'ethercat master' says behind "Ring:"
ring() { [ "$(says Ring)" = "$1" ] || { echo "ring: $(says Ring)"; return 1; }; }

# tell FAULT...: of the simulator
tell() { echo "$*" >$sim; }

# how often slaves have changed their state
changes() {
	ethercat log --json |
		gojq '[.masters[0].events[] | select(.event == "al_state")] | length'
}

# in the background, all slaves in OP
app_runs() {
	python3 "$BATS_TEST_DIRNAME/ring_app.py" "$EC_BUILD/lib/libethercat.so" 5 $slaves \
		>"$BATS_TEST_TMPDIR/app" 2>&1 3>&- &
	app=$!
	wait_for 60 all_slaves_are OP $slaves
	wait_for 60 grep -q cycles= "$BATS_TEST_TMPDIR/app"
}

# seen NAME: the newest number of the application
seen() { tail -n 1 "$BATS_TEST_TMPDIR/app" | grep -o "$1=[0-9]*" | cut -d= -f2; }
seen_is() { [ "$(seen "$1")" = "$2" ]; }
seen_from() { [ "$(seen cycles)" -ge "$1" ]; }

# goes_on CYCLES: the application has done so many more, and as before all slaves are in OP
goes_on() {
	wait_for 60 seen_from $(($(seen cycles) + $1))
	all_slaves_are OP $slaves
}

# app_ends LIMIT: no value was wrong, and at most LIMIT cycles were incomplete
app_ends() {
	kill -TERM $app
	wait $app
	app=
	tail -n 1 "$BATS_TEST_TMPDIR/app"
	[ "$(seen wrong)" = 0 ]
	[ "$(seen incomplete)" -le "$1" ]
}

@test "each cable of a ring is cut and healed: slaves stay in OP, values and working counter" {
	local i

	virtual
	ring closed
	json '.masters[0].ring.state == "closed"' master
	app_runs
	ring closed
	seen_is redundancy_active 0
	before=$(changes)
	for i in 1 2 3 4; do
		tell cut o$i.1
		wait_for 20 ring "open between port 1 of slave $((2 * i - 2)) and slave $((2 * i - 1))"
		wait_for 20 seen_is redundancy_active 1
		goes_on 100
		tell heal o$i.1
		wait_for 20 ring closed
		wait_for 20 seen_is redundancy_active 0
		goes_on 100
	done
	# both ends
	tell cut o1.0
	wait_for 20 ring "open between the main device and slave 0"
	goes_on 100
	json '.masters[0].devices | .[0].link_up == false and .[1].link_up' master
	tell heal o1.0
	wait_for 20 ring closed
	tell cut i4.1
	wait_for 20 ring "open between port 1 of slave 7 and the backup device"
	goes_on 100
	json '.masters[0].devices | .[0].link_up and .[1].link_up == false' master
	tell heal i4.1
	wait_for 20 ring closed
	goes_on 100
	[ "$(changes)" = "$before" ]
	app_ends 12
}

@test "master, slaves, graph, why and log name the place of a break" {
	virtual
	tell cut i2.1
	wait_for 20 ring "open between port 1 of slave 3 and slave 4"
	json '.masters[0].ring == {"state": "open", "slave": 3, "port": 1, "next": 4,
		"exchanged": false, "turned": null}' master
	run ethercat slaves
	echo "$output"
	[ "${lines[4]}" = "xxx LINK FAILURE xxx" ]
	[ "${#lines[@]}" = 9 ]
	run ethercat graph --tree
	echo "$output"
	[[ $output == *"Master0: main device sim0, link up"* ]]
	[[ $output == *"Master0: backup device sim0b, link up"* ]]
	run ethercat why
	echo "$output"
	[ "$status" = 0 ] || [ "$status" = 1 ]
	[[ $output == *"ring open between port 1 of slave 3 (EL1008) and slave 4 (EL2008)"* ]]
	json '.masters[0].findings[] | select(.cause == "ring_open") | .level == "warning"' why
	ethercat log
	ethercat log | grep -q 'ring open between port 1 of slave 3 and slave 4'
	json '[.masters[0].events[] | select(.event == "ring_open")] | length == 1' log
	# the first scan has reported it once
	json '[.masters[0].events[] | select(.event == "ring_closed")] | length == 1' log
	tell heal i2.1
	wait_for 20 ring closed
	json '.masters[0].ring | .state == "closed" and .slave == null and .next == null' master
	json '[.masters[0].events[] | select(.event == "ring_closed")] | length == 2' log
	run ethercat slaves
	[[ $output != *FAILURE* ]]
	run ethercat graph --tree
	[[ $output != *backup* ]]
}

@test "both ends are pulled and back; the bus comes back to OP" {
	virtual
	app_runs
	tell cut o1.0
	wait_for 20 ring "open between the main device and slave 0"
	tell cut i4.1
	wait_for 20 all_slaves_are OP 0
	tell heal i4.1
	wait_for 60 all_slaves_are OP $slaves
	ring "open between the main device and slave 0"
	tell heal o1.0
	wait_for 60 ring closed
	goes_on 100
	kill -TERM $app
	wait $app
	app=
	# values are not judged: a slave in SAFEOP counts, and does not take outputs
	tail -n 1 "$BATS_TEST_TMPDIR/app"
}

@test "the ring is open at the start: all slaves are found in their order and run" {
	master main_devices=sim0 backup_devices=sim0b
	echo 'fault at=0s cut i3.1' | cat "$segment" - >"$BATS_TEST_TMPDIR/open"
	segment=$BATS_TEST_TMPDIR/open
	simulator
	wait_for 60 all_slaves_are PREOP $slaves
	[ "$(ethercat slaves | grep -o 'EL[0-9]*' | tr '\n' ' ')" = \
		"EL2008 EL1008 EL2008 EL1008 EL2008 EL1008 EL2008 EL1008 " ]
	ring "open between slave 5 and slave 6"
	app_runs
	goes_on 100
	tell heal i3.1
	wait_for 20 ring closed
	goes_on 100
	app_ends 2
}

@test "modules are removed while the ring is open and the application sends" {
	virtual
	app_runs
	tell cut o3.1
	wait_for 20 ring "open between port 1 of slave 4 and slave 5"
	rmmod ec_sim
	[[ "$(says Main)" == *"(waiting...)" ]]
	[[ "$(says Backup)" == *"(waiting...)" ]]
	kill -9 $app
	wait $app || true
	app=
	simulator
	wait_for 60 all_slaves_are PREOP $slaves
	ring closed
	stop
	[ ! -e /dev/EtherCAT0 ]
}

@test "a master whose backup device is absent works with the main device, and names the absent one" {
	segment=three
	master main_devices=sim0 backup_devices=veth9
	simulator
	generic
	wait_for 60 all_slaves_are PREOP 3
	[[ "$(says Backup)" == *"(waiting...)" ]]
	dmesg | grep -q '"veth9" is neither the name nor the MAC address of a network interface'
	ring "open between slave 2 and the backup device"
	ethercat run
	wait_for 60 all_slaves_are OP 3
}

@test "the main device of a ring can be another one, but not the backup device" {
	virtual
	refused 'sim0b is the device of master 0' device use sim0b
	refused 'no driver offers sim5.*keeps sim0' device use sim5
	wait_for 60 ring closed
	wait_for 60 all_slaves_are PREOP $slaves
}

# line_is N: all of them in PREOP, at the main device alone
line_is() {
	wait_for 60 all_slaves_are PREOP "$1"
	json '.masters[0] | (.devices | length) == 1 and .ring.state == "none"' master
}

@test "device use --backup makes a ring of a line, which runs, and --backup none a line again" {
	local i to

	master main_devices=sim0
	simulator
	line_is $slaves
	refused 'sim0 is the device of master 0' device use --backup sim0
	refused 'no driver offers sim9.*keeps no backup device' device use --backup sim9
	line_is $slaves
	ethercat device use --backup sim0b
	# it has waited for the scan
	ring closed
	all_slaves_are PREOP $slaves
	app_runs
	refused 'stop that application first' device use --backup none
	tell cut o3.1
	wait_for 20 ring "open between port 1 of slave 4 and slave 5"
	goes_on 100
	tell heal o3.1
	wait_for 20 ring closed
	goes_on 100
	app_ends 4
	# it changes while callers are killed
	for i in 1 2 3 4 5 6 7 8; do
		for to in none sim0b; do
			timeout -s KILL 0.0$i "$EC_BUILD/tool/ethercat" device use --backup $to ||
				true	# it is killed
		done
	done
	wait_for 60 ethercat device use --backup sim0b
	wait_for 60 all_slaves_are PREOP $slaves
	wait_for 20 ring closed
	ethercat device use --backup none
	line_is $slaves
	ethercat run
	wait_for 60 all_slaves_are OP $slaves
}

@test "the names of the two devices are exchanged: the ring works, and says so" {
	master main_devices=sim0b backup_devices=sim0
	simulator
	wait_for 60 all_slaves_are PREOP $slaves
	ring closed
	ethercat master | grep -q '^  Devices exchanged: .* exchange the cables or the two names'
	json '[.masters[0].devices[].interface] == ["sim0", "sim0b"]' master
	json '.masters[0].ring.exchanged' master
	json '.masters[0].findings[] | select(.cause == "ring_exchanged") | .level == "warning"' why
	json '[.masters[0].events[] | select(.event == "ring_exchanged")] | length == 1' log
	app_runs
	tell cut o3.1
	wait_for 20 ring "open between port 1 of slave 4 and slave 5"
	goes_on 100
	tell heal o3.1
	wait_for 20 ring closed
	goes_on 100
	app_ends 4
	refused 'sim0 is the device of master 0' device use sim0
}

@test "a slave is connected the wrong way round: no application is activated, and why says so" {
	virtual
	tell swap o3.0 o3.1
	wait_for 20 json '.masters[0].ring.turned == 7' master
	wait_for 60 all_slaves_are PREOP $slaves
	ethercat master | grep -q '^  Wrong way round: slave 7; '
	run ethercat why
	[ "$status" = 1 ]
	[[ $output == *"slave 7 (EL2008) is connected the wrong way round in the ring"* ]]
	refused 'slave 7 .* is connected the wrong way round in the ring' run
	tell swap o3.0 o3.1
	wait_for 20 json '.masters[0].ring.turned == null' master
	wait_for 20 ring closed
	ethercat run
	wait_for 60 all_slaves_are OP $slaves
}

# value NAME: of the running bus
value() { ethercat data --names | awk -v n="$1" '$0 ~ "(^| )" n " " { print $NF }'; }

@test "a slave of the ring has no power: the others run, each with its own values" {
	virtual
	ring closed
	tell off i2
	wait_for 60 ring "open between port 1 of slave 2 and slave 3"
	wait_for 60 all_slaves_are PREOP $((slaves - 1))
	ethercat run
	wait_for 60 all_slaves_are OP $((slaves - 1))
	# of the last slave but one, wired to the second one
	ethercat config
	ethercat config | grep -q '^0:6 '
	run ethercat config
	[[ $output != *0:3* ]]
	ethercat data --names
	ethercat set --hold el2008_4.channel_1.output 1
	wait_for 20 grep -qx 1 <(value el1008.channel_1.input)
	ethercat stop
	tell on i2
	wait_for 60 ring closed
}

# wire N M: a cable between vethN and vethM
wire() {
	ip link add veth$1 type veth peer name veth$2
	ip link set veth$1 up
	ip link set veth$2 up
}

# cut_and_heal FILE: with the commands of a simulator at two interfaces
cut_and_heal() {
	sim=$1
	ring closed
	app_runs
	for i in 1 3; do
		tell cut o$i.1
		wait_for 20 ring "open between port 1 of slave $((2 * i - 2)) and slave $((2 * i - 1))"
		goes_on 100
		tell heal o$i.1
		wait_for 20 ring closed
		goes_on 100
	done
}

@test "generic devices at two pairs of veth" {
	wire 0 1
	wire 2 3
	master main_devices=veth0 backup_devices=veth2
	simulator netdev=veth1,veth3
	generic
	wait_for 60 all_slaves_are PREOP $slaves
	cut_and_heal /sys/kernel/debug/ec_sim/veth1
	# a device goes, and the slaves are reached by the other one
	tell cut i4.1
	ip link set veth3 down
	wait_for 20 ring "open between port 1 of slave 7 and the backup device"
	goes_on 100
	ip link set veth3 up
	tell heal i4.1
	wait_for 20 ring closed
	goes_on 100
	app_ends 40
	# without the ring, while the interface keeps its link, and again
	ethercat device use --backup none
	line_is $slaves
	ethercat run
	wait_for 60 all_slaves_are OP $slaves
	ethercat stop
	ethercat device use --backup veth2
	wait_for 20 ring closed
	# with the cable out; not while a bridge has it
	tell cut i4.1
	ip link set veth2 down
	ethercat device use --backup none
	line_is $slaves
	modprobe bridge
	ip link add br0 type bridge
	ip link set veth2 master br0
	refused 'or it cannot be used .*keeps no backup device' device use --backup veth2
	ip link del br0
	ip link set veth2 up
	tell heal i4.1
	ethercat device use --backup veth2
	wait_for 60 all_slaves_are PREOP $slaves
	wait_for 20 ring closed
}

# monitor COMMAND: of QEMU
monitor() {
	local port

	port=$(grep -lx monitor /sys/class/virtio-ports/*/name)
	echo "$*" >"/dev/$(basename "${port%/name}")"
}

# pull NIC FAULT: the cable of a card, at both of its ends
pull() {
	tell "cut $2"
	monitor set_link "$1" off
}
plug() {
	monitor set_link "$1" on
	wait_for 20 links_are_up
	tell "heal $2"
}
links_are_up() { json '.masters[0].devices | all(.link_up)' master; }

@test "generic devices at two network cards" {
	master main_devices=52:54:00:ec:00:00 backup_devices=52:54:00:ec:00:02
	simulator netdev=eth1,eth3
	generic
	wait_for 60 all_slaves_are PREOP $slaves
	cut_and_heal /sys/kernel/debug/ec_sim/eth1
	app_ends 40
}

@test "a native main device and a generic backup device; the link of each is lost and back" {
	pci eth0 >"$BATS_TEST_TMPDIR/native"
	master main_devices=52:54:00:ec:00:00 backup_devices=52:54:00:ec:00:02
	simulator netdev=eth1,eth3
	insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	driver "$(cat "$BATS_TEST_TMPDIR/native")" ec_intel
	generic
	wait_for 60 all_slaves_are PREOP $slaves
	ethercat devices
	cut_and_heal /sys/kernel/debug/ec_sim/eth1
	pull nic0 o1.0
	wait_for 20 ring "open between the main device and slave 0"
	goes_on 100
	json '.masters[0].devices[0].link_up == false' master
	plug nic0 o1.0
	wait_for 20 ring closed
	goes_on 100
	pull nic2 i4.1
	wait_for 20 ring "open between port 1 of slave 7 and the backup device"
	goes_on 100
	plug nic2 i4.1
	wait_for 20 ring closed
	goes_on 100
	app_ends 100
	# each of them as the other one
	ethercat device use --backup none
	ethercat device use 52:54:00:ec:00:02
	ethercat device use --backup "$(cat "$BATS_TEST_TMPDIR/native")"
	wait_for 60 all_slaves_are PREOP $slaves
	wait_for 20 ring closed
	ethercat master | grep -q '^  Devices exchanged: '
}
