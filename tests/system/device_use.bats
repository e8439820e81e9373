# SPDX-License-Identifier: GPL-2.0-only
# vm: --smp 2
# 'ethercat device use': a master gets another device while programs read, ask and die.

load helpers

setup_file() {
	printf 'slave a EK1100\nslave b EL1008\n' >"$BATS_FILE_TMPDIR/inputs"
	printf 'slave a EK1100\nslave b EL2008\n' >"$BATS_FILE_TMPDIR/outputs"
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0,sim2
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" \
		segment="$BATS_FILE_TMPDIR/inputs,$BATS_FILE_TMPDIR/outputs,three"
	# the interface of the generic device
	modprobe veth
	ip link add veth0 type veth peer name veth1
	ip link set veth1 up
	"$EC_BUILD/tool/ethercat-sim" -s thin veth1 >"$BATS_FILE_TMPDIR/sim" 2>&1 3>&- &
	echo $! >"$BATS_FILE_TMPDIR/sim.pid"
	wait_for 120 slaves_are EL1008
}
teardown_file() {
	stop
	kill "$(cat "$BATS_FILE_TMPDIR/sim.pid")"
}
teardown() {
	rmmod ec_generic 2>/dev/null || true
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
	[ -z "${readers:-}" ] || kill $readers 2>/dev/null || true
}

use() { ethercat device use -m0 "$@"; }
gone() { ! pgrep -x "$1" >/dev/null; }
device() { ethercat master -m0 --json | gojq -r '.masters[0].devices[0].interface'; }
# slaves_are NAME: of the second one of two, both in PREOP
slaves_are() {
	[ "$(ethercat slaves -m0 | awk '$3 == "PREOP"' | wc -l)" = 2 ] &&
		ethercat slaves -m0 | grep -q "^ *1 .*$1"
}

@test "another virtual device: its slaves, and none of the other's" {
	use sim1
	[ "$(device)" = sim1 ]
	wait_for 60 slaves_are EL2008
	# with nothing in between
	use sim0
	ethercat slaves -m0 | grep -q EL1008
	[ "$(ethercat slaves -m0 | grep -c EL2008)" = 0 ]
	[ "$(ethercat slaves -m1 | wc -l)" = 3 ]
}

@test "an interface with the generic device, and back" {
	refused 'no driver offers veth0.*load ec_generic.*keeps sim0' device use -m0 veth0
	wait_for 60 slaves_are EL1008
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	for i in 1 2 3; do
		use veth0
		wait_for 60 slaves_are EL2008
		[ "$(device)" = veth0 ]
		use sim0
		wait_for 60 slaves_are EL1008
	done
	# a bridge can have it again, and then the master cannot
	modprobe bridge
	ip link add br0 type bridge
	ip link set veth0 master br0
	refused 'or it cannot be used .*dmesg.*keeps sim0' device use -m0 veth0
	dmesg | tail -n 5 | grep -q 'veth0: in use by a bridge'
	ip link del br0
	wait_for 60 slaves_are EL1008
	use veth0
	rmmod ec_generic
	ethercat master -m0 | grep -q 'veth0 (waiting'
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	wait_for 60 slaves_are EL2008
	use sim0
	rmmod ec_generic
}

@test "an interface with an address is taken with --force only" {
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	ip address add 192.0.2.7/24 dev veth0
	refused "veth0 has the address 192.0.2.7; 'ip address flush dev veth0' first, or use --force" \
		device use -m0 veth0
	use --force veth0
	[ "$(device)" = veth0 ]
	use sim0
	ip address flush dev veth0
	use veth0
	use sim0
	rmmod ec_generic
}

@test "devices that are absent, invalid or of others are refused, and nothing changes" {
	refused 'sim2 is the device of master 1' device use -m0 sim2
	refused 'sim2 is the device of master 1' device use -m0 --backup sim2
	refused 'there is no network card eth9' device use -m0 eth9
	refused 'no driver offers sim9' device use -m0 sim9
	refused 'neither a MAC address' device use -m0 'sim/9'
	refused '2 masters found, the command needs one' device use sim1
	refused '/etc/modprobe.d' device use -m0 --boot sim1
	refused 'missing argument' device use -m0
	[ "$(device)" = sim0 ]
	wait_for 60 slaves_are EL1008
}

# may_not WORDS COMMAND...: it is refused with these words, with each kind of device
may_not() {
	local words=$1 to

	shift
	for to in sim1 "--backup sim2" "--backup none"; do
		# shellcheck disable=SC2086
		run "$@" "$EC_BUILD/tool/ethercat" device use -m0 $to
		echo "$to: $output"
		[ "$status" = 1 ] || return
		[[ $output == *"$words"* ]] || return
	done
	[ "$(device)" = sim0 ]
}

@test "a member of the group may not, root without the device's permission neither" {
	local nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)

	chmod 666 /dev/EtherCAT0
	may_not 'needs root (CAP_NET_ADMIN)' "${nobody[@]}"
	may_not 'needs root (CAP_NET_ADMIN)' \
		setpriv --bounding-set -net_admin --inh-caps -net_admin
	# not the one of a namespace of one's own either
	may_not 'needs root (CAP_NET_ADMIN)' python3 "$BATS_TEST_DIRNAME/unchroot.py" \
		"${nobody[@]}" unshare -Ur
	chmod 664 /dev/EtherCAT0
	may_not 'ermission' "${nobody[@]}"
	chmod 660 /dev/EtherCAT0
}

@test "an application keeps its device" {
	"$EC_BUILD/apps/cyclic" >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 120 grep -q ': 2 of 2 in OP' "$BATS_TEST_TMPDIR/out"
	before=$(lost_frames)
	refused 'reserved by process .* \(cyclic\); stop that application first' device use -m0 sim1
	kill -0 $app
	[ "$(lost_frames)" = "$before" ]
	[ "$(device)" = sim0 ]
	kill $app
	wait $app
	app=
	use sim1
	wait_for 60 slaves_are EL2008
	use sim0
}

# found: how many slaves SOEM finds at veth2
found() {
	"$EC_PYSOEM" -c 'import pysoem; m = pysoem.Master()
m.open("veth2"); print(m.config_init())'
}

@test "SOEM after this master finds a slave that is connected where a session had closed a port" {
	[ -n "$EC_PYSOEM" ] || skip "pysoem is for the programs of the host only"
	printf 'slave a EK1100\nslave b EL2008\nbranch none\nslave x EL1008\n' \
		>"$BATS_TEST_TMPDIR/segment"
	tell=$BATS_TEST_TMPDIR/control
	ip link add veth2 type veth peer name veth3
	ip link set veth2 up
	ip link set veth3 up
	"$EC_BUILD/tool/ethercat-sim" -s "$BATS_TEST_TMPDIR/segment" --control "$tell" veth3 \
		>"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	readers=$!
	wait_for 60 test -S "$tell"
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	for end in death release; do
		use veth2
		wait_for 60 slaves_are EL2008
		"$EC_BUILD/apps/cyclic" >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
		app=$!
		wait_for 120 grep -q ': 2 of 2 in OP' "$BATS_TEST_TMPDIR/out"
		[[ $(ethercat reg_read -m0 -p1 -t uint8 0x101) == 0x?c* ]]
		[ $end = release ] || kill -9 $app
		kill $app || true	# it may have gone
		wait $app || true
		app=
		wait_for 30 use sim0
		"$EC_BUILD/tool/ethercat-sim" --tell "$tell" plug b.1 x.0
		[ "$(found)" = 3 ]
		"$EC_BUILD/tool/ethercat-sim" --tell "$tell" unplug b.1
	done
	rmmod ec_generic
	kill $readers
	readers=
}

@test "to and fro 12 times beside readers, requests and other callers that are killed" {
	readers=
	while :; do
		ethercat slaves -v && ethercat master && ethercat pdos || true	# may be refused now
		ethercat upload -p1 0x1018 1 || true	# likewise
	done >/dev/null 2>&1 3>&- &
	readers+=" $!"
	while :; do
		timeout -s KILL 0.0$((RANDOM % 9 + 1)) \
			"$EC_BUILD/tool/ethercat" device use -m0 sim1 || true	# is killed
	done >/dev/null 2>&1 3>&- &
	readers+=" $!"
	while :; do
		ethercat rescan || true	# likewise
		timeout 1 "$EC_BUILD/apps/cyclic" || true	# is killed
	done >/dev/null 2>&1 3>&- &
	readers+=" $!"
	done=0
	for i in {1..500}; do
		[ $done -lt 12 ] || break
		! use sim$((i & 1)) 2>"$BATS_TEST_TMPDIR/err" || done=$((done + 1))
		[ ! -s "$BATS_TEST_TMPDIR/err" ] ||
			grep -qE 'reserved by|try again|keeps sim|waits for sim' "$BATS_TEST_TMPDIR/err"
	done
	kill $readers
	wait $readers 2>/dev/null || true
	readers=
	# the last application of a loop may outlive it for a second
	pkill -KILL -x cyclic || true	# there may be none
	wait_for 30 gone cyclic
	echo "# $done of $i changes beside them" >&3
	[ $done = 12 ]
	wait_for 60 use sim1
	wait_for 60 slaves_are EL2008
	use sim0
	wait_for 60 slaves_are EL1008
}

@test "modules leave while the device is changed" {
	(for i in {1..20}; do ethercat device use -m0 sim$((i & 1)); done) \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	sleep 0.3
	wait_for 30 rmmod ec_sim
	wait $app || true
	app=
	ethercat master -m0 | grep -q waiting
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" \
		segment="$BATS_FILE_TMPDIR/inputs,$BATS_FILE_TMPDIR/outputs,three"
	wait_for 60 use sim1
	wait_for 60 slaves_are EL2008
}
