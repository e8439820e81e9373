# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --timeout 600
# The generic device: a master at any network device, slaves at the other end.

load helpers

setup_file() { modprobe veth; }

setup() {
	ip link add veth0 type veth peer name veth1
}

teardown() {
	killall -q demo tcpdump 2>/dev/null || true
	[ -z "${SIM:-}" ] || kill "$SIM" 2>/dev/null || true
	stop
	for d in veth0 eth0 br0; do ip link del $d 2>/dev/null || true; done
}

# master DEVICE
master() {
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices="$1"
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
}

# responder SEGMENT DEVICE
responder() {
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment="$1" netdev="$2"
}

demo() {
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" "$@"
}

# in the background with all slaves in OP, until it is told to end: how long the
# guest needs for what a test does to it, nobody knows
demo_runs() {
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000000 \
		>"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	app=$!
	wait_for 120 all_slaves_are OP 22
	sleep 1		# its axes are enabled then, it measures
}

# it did not end by itself, and tells what happened: process data stopped. Whether a
# frame was on its way at that moment, and is lost, is chance
demo_noticed() {
	local ended=0

	kill -TERM $app
	wait $app || ended=$?
	cat "$BATS_TEST_TMPDIR/demo"
	[ $ended = 1 ]
	grep -q 'FAILED no working counter error' "$BATS_TEST_TMPDIR/demo"
	grep -qE '^Cycles: [1-9][0-9]* of 1000000' "$BATS_TEST_TMPDIR/demo"
}

# capture DEVICE NAME ARG...: tcpdump, what it prints in the file NAME at once
capture() {
	tcpdump -i "$1" -nn --immediate-mode -l "${@:3}" \
		>"$BATS_TEST_TMPDIR/$2" 2>"$BATS_TEST_TMPDIR/$2.err" 3>&- &
	tap=$!
	wait_for 60 grep -q listening "$BATS_TEST_TMPDIR/$2.err"
}

# arp DEVICE FROM TO COUNT
arp() { python3 "$BATS_TEST_DIRNAME/arp.py" "$@"; }

main_is() { [[ "$(says Main)" == *"($1)" ]]; }
link_is() { [ "$(says Link)" = "$1" ]; }
foreign_are() { [ "$(foreign)" -ge "$1" ]; }
foreign() { ethercat master --json | gojq '[.. | .foreign_frames? // empty] | max'; }

@test "veth and ec_sim: all slaves to OP, no frame lost" {
	master veth0
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	before=$(lost_frames)
	run demo --cycles 1000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}

@test "veth and ethercat-sim: all slaves to OP, no frame lost" {
	ip link set veth1 up
	"$EC_BUILD/tool/ethercat-sim" -s bench veth1 >"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	SIM=$!
	wait_for 120 grep -q 22 "$BATS_TEST_TMPDIR/sim"
	master veth0
	wait_for 120 all_slaves_are PREOP 22
	before=$(lost_frames)
	run demo --cycles 1000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	kill $SIM
	wait $SIM
	grep -q ' 0 lost in the segment, 0 dropped' "$BATS_TEST_TMPDIR/sim"
	SIM=
}

@test "the MAC address names the device as well" {
	ip link set veth0 address 02:00:00:00:12:34
	master 02:00:00:00:12:34
	responder thin veth1
	wait_for 120 all_slaves_are PREOP 2
}

@test "the device comes after the modules, goes in OP, comes again" {
	ip link del veth0
	master veth0
	main_is waiting...
	ip link add veth0 type veth peer name veth1
	wait_for 120 main_is attached
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	demo_runs
	ip link del veth0
	demo_noticed
	main_is waiting...
	ip link add veth0 type veth peer name veth1
	wait_for 120 all_slaves_are PREOP 22
}

@test "the link goes down in OP and comes back" {
	master veth0
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	link_is UP
	demo_runs
	before=$(($(says 'Tx errors') + $(lost_frames)))
	ip link set veth1 down
	wait_for 120 link_is DOWN
	demo_noticed
	# every frame since then was not sent, or did not come back
	[ $(($(says 'Tx errors') + $(lost_frames))) -gt "$before" ]
	ip link set veth1 up
	wait_for 120 link_is UP
	wait_for 120 all_slaves_are PREOP 22
	ip link set veth0 down
	wait_for 120 link_is DOWN
	ip link set veth0 up
	wait_for 120 all_slaves_are PREOP 22
}

@test "a small MTU is refused, before and while the device is used" {
	ip link set veth0 mtu 1200
	master veth0
	main_is waiting...
	dmesg | grep -q 'veth0: MTU 1200, need 1500'
	ip link set veth0 mtu 1500
	wait_for 120 main_is attached
	run ip link set veth0 mtu 1499
	[ "$status" != 0 ]
	ip link set veth0 mtu 2000
}

@test "a device of a bridge is taken when the bridge lets it go; a claimed one is not given" {
	modprobe bridge
	ip link add br0 type bridge
	ip link set veth0 master br0
	master veth0
	main_is waiting...
	dmesg | grep -q 'veth0: in use by a bridge'
	ip link set veth0 nomaster
	wait_for 120 main_is attached
	run ip link set veth0 master br0
	[ "$status" != 0 ]
}

@test "foreign frames are counted, none of ours leaves, and all pass again afterwards" {
	master veth0
	responder thin veth1
	wait_for 120 all_slaves_are PREOP 2
	lost=$(lost_frames)
	ip addr add 10.0.0.1/24 dev veth0
	ip addr add 10.0.0.2/24 dev veth1
	before=$(foreign)
	capture veth1 seen arp
	# from the wire: counted, not answered
	arp veth1 10.0.0.2 10.0.0.1 3
	# towards the wire: refused
	run arp veth0 10.0.0.1 10.0.0.2 3
	[ "$status" != 0 ]
	wait_for 60 foreign_are $((before + 3))
	# the last one: what has left before it is in the file as well
	arp veth1 10.0.0.3 10.0.0.1 1
	wait_for 60 grep -q 'tell 10\.0\.0\.3,' "$BATS_TEST_TMPDIR/seen"
	kill $tap
	cat "$BATS_TEST_TMPDIR/seen"
	[ "$(grep -c 'tell 10\.0\.0\.2,' "$BATS_TEST_TMPDIR/seen")" = 3 ]
	run grep -E 'tell 10\.0\.0\.1,|10\.0\.0\.1 is-at' "$BATS_TEST_TMPDIR/seen"
	[ "$status" = 1 ]
	[ "$(lost_frames)" = "$lost" ]
	all_slaves_are PREOP 2
	rmmod ec_sim ec_generic
	capture veth1 seen arp
	arp veth0 10.0.0.1 10.0.0.2 3
	wait_for 60 grep -q 'tell 10\.0\.0\.1,' "$BATS_TEST_TMPDIR/seen"
	kill $tap
}

@test "a capture at the device shows both directions" {
	local direction taps=

	master veth0
	# the source address of a frame is the same there and back
	for direction in out in; do
		capture veth0 text -c 20 -Q "$direction" -w "$BATS_TEST_TMPDIR/$direction" \
			ether proto 0x88a4
		taps+=" $tap"
	done
	responder thin veth1
	wait $taps
	# With the time each was sent or received: no reply before its frame. Their order in
	# the file is another matter, as a worker hands over the frames that were sent.
	for direction in out in; do
		tcpdump -nn -tt -e -r "$BATS_TEST_TMPDIR/$direction" 2>/dev/null | sed "s/^/$direction /"
	done >"$BATS_TEST_TMPDIR/text"
	awk '$1 == "out" { sent[$3] = $2 }
		$1 == "in" { back[$3] = $2 }
		END {
			for (id in back)
				if (id in sent) {
					n++
					early += back[id] < sent[id]
				}
			print n + 0 " pairs, " early + 0 " early"
			exit !(n > 3 && !early)
		}' "$BATS_TEST_TMPDIR/text"
}

# idle_sockets DEVICE COUNT: capture programs which never read
idle_sockets() {
	python3 -c 'import signal, socket, sys
s = [socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3)) for i in range(int(sys.argv[2]))]
for x in s: x.bind((sys.argv[1], 0))
print("ready", flush=True)
signal.pause()' "$1" "$2" >"$BATS_TEST_TMPDIR/idle" 3>&- &
	idle=$!
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/idle"
}

# the bench runs undisturbed while COUNT capture programs at DEVICE do not read
idle_does_no_harm() {
	master veth0
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	idle_sockets "$1" "$2"
	before=$(lost_frames)
	run demo --cycles 1000 --wired
	echo "$output"
	kill $idle
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}

@test "a capture program at the device that does not read disturbs no cycle" {
	idle_does_no_harm veth0 3
}

@test "a capture program at the other end that does not read disturbs no cycle" {
	idle_does_no_harm veth1 3
}

@test "a renamed device stays with its master" {
	master veth0
	responder thin veth1
	wait_for 120 all_slaves_are PREOP 2
	ip link set veth0 down
	ip link set veth0 name eth0
	ip link set eth0 up
	wait_for 120 all_slaves_are PREOP 2
	ip link del eth0
	main_is waiting...
	# one that gets the name is taken
	ip link add other type veth peer name veth1
	main_is waiting...
	ip link set other name veth0
	wait_for 120 main_is attached
	wait_for 120 all_slaves_are PREOP 2
}

@test "the driver is unloaded in OP" {
	master veth0
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	demo_runs
	rmmod ec_generic
	demo_noticed
	main_is waiting...
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	wait_for 120 all_slaves_are PREOP 22
}

@test "the segment is unloaded in OP and loaded again" {
	master veth0
	responder bench veth1
	wait_for 120 all_slaves_are PREOP 22
	demo_runs
	rmmod ec_sim
	demo_noticed
	responder thin veth1
	wait_for 120 all_slaves_are PREOP 2
}

@test "a device in another namespace is not ours, even with the name" {
	ip netns add other
	ip link del veth0
	master veth0
	ip -n other link add veth0 type veth peer name veth1
	sleep 0.3
	main_is waiting...
	ip netns del other
}

@test "ec_sim refuses a device that is missing, not Ethernet, or in use" {
	master veth0
	run responder thin veth7
	[ "$status" != 0 ]
	dmesg | grep -q "ec_sim: no network device 'veth7'"
	run responder thin lo
	[ "$status" != 0 ]
	dmesg | grep -q 'ec_sim: lo is not an Ethernet device'
	run responder thin veth0
	[ "$status" != 0 ]
	dmesg | grep -q 'ec_sim: cannot claim veth0'
}

@test "modules come and go under load" {
	master veth0
	for i in 1 2 3 4 5; do
		responder three veth1
		wait_for 120 all_slaves_are PREOP 3
		rmmod ec_sim
		wait_for 120 all_slaves_are PREOP 0
	done
	for i in 1 2 3 4 5; do
		rmmod ec_generic
		insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	done
	main_is attached
}
