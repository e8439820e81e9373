# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --timeout 600
# The generic device at network devices which are no NICs: their drivers push
# headers, clone frames or hand them on. Each works, or is refused with the reason.

load helpers

setup_file() { modprobe veth; }

setup() {
	ip link add veth0 type veth peer name veth1
	ip link set veth0 up
	ip link set veth1 up
}

teardown() {
	stop
	[ -z "${CARD:-}" ] || kill "$CARD" 2>/dev/null || true
	for d in main0 far0 veth0; do ip link del $d 2>/dev/null || true; done
}

# master DEVICE
master() {
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices="$1"
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
}

# responder DEVICE
responder() {
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=bench netdev="$1"
}

main_is() { [[ "$(says Main)" == *"($1)" ]]; }

# runs DEVICE: a master at $main, slaves at DEVICE at the other end; to OP, no frame is lost
runs() {
	master "${main:-main0}"
	responder "$1"
	wait_for 120 all_slaves_are PREOP 22
	before=$(lost_frames)
	run env LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000 --wired
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	[ "$(says 'Tx errors')" = 0 ]
}

# refused DEVICE PATTERN: not taken, and the log says why
not_taken() {
	master "$1"
	main_is waiting...
	dmesg | grep -qE "ec_generic: $1: $2"
}

@test "a VLAN device runs the bench" {
	modprobe 8021q
	ip link add link veth0 name main0 type vlan id 5
	ip link add link veth1 name far0 type vlan id 5
	runs far0
}

@test "a macvlan device runs the bench" {
	modprobe macvlan
	ip link add link veth0 name main0 type macvlan mode bridge
	runs veth1
}

@test "a bond runs the bench, a port of a bond is refused" {
	modprobe bonding max_bonds=0
	ip link add main0 type bond mode active-backup
	ip link set veth0 down
	ip link set veth0 master main0
	not_taken veth0 "in use by a bridge, bond, team or macvlan"
	stop
	runs veth1
}

@test "a bridge device runs the bench, a port of a bridge is refused" {
	modprobe bridge
	ip link add main0 type bridge
	ip link set veth0 master main0
	not_taken veth0 "in use by a bridge, bond, team or macvlan"
	stop
	dmesg -C
	runs veth1
	dmesg | grep 'ec_generic: main0: the bridge learns the address of each frame; load ' |
		grep -q 'frame_numbers=N'
	learned=$(bridge fdb show br main0 | grep -c '02:00:')
	[ "$learned" -gt 1000 ]
	stop
	dmesg -C
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=main0 frame_numbers=N
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	main_is attached
	run grep 'the bridge learns' <(dmesg)
	[ "$status" = 1 ]
}

@test "the port of a macvlan is refused" {
	modprobe macvlan
	ip link add link veth0 name main0 type macvlan mode bridge
	not_taken veth0 "in use by a bridge, bond, team or macvlan"
}

@test "the port below a VLAN device runs the bench" {
	modprobe 8021q
	ip link add link veth0 name vlan0 type vlan id 5
	ip link set vlan0 up
	main=veth0
	runs veth1
}

@test "a team runs the bench" {
	modprobe -a team team_mode_roundrobin
	ip link add main0 type team
	# what teamd would do
	python3 "$BATS_TEST_DIRNAME/team_mode.py" main0 roundrobin
	ip link set veth0 down
	ip link set veth0 master main0
	ip link set main0 up
	runs veth1
}

@test "a port of a team is refused" {
	modprobe team
	ip link add main0 type team
	ip link set veth0 down
	ip link set veth0 master main0
	not_taken veth0 "in use by a bridge, bond, team or macvlan"
}

@test "a mesh of batman-adv is refused" {
	modprobe batman-adv
	ip link add main0 type batadv
	ip link set veth0 master main0
	not_taken main0 "batman-adv mesh"
}

# macsec DEVICE LOWER OTHER: pushes a header into the frame it is given
macsec() {
	local key=00112233445566778899aabbccddeeff

	ip link set "$2" mtu 1600
	ip link add link "$2" name "$1" type macsec port 1 encrypt on
	ip macsec add "$1" tx sa 0 pn 1 on key 01 $key
	ip macsec add "$1" rx port 1 address "$(cat "/sys/class/net/$3/address")"
	ip macsec add "$1" rx port 1 address "$(cat "/sys/class/net/$3/address")" sa 0 pn 1 on key 01 $key
	ip link set "$1" mtu 1500 up
}

@test "a device whose driver pushes headers (MACsec) runs the bench" {
	modprobe -a macsec gcm ctr ghash_generic
	macsec main0 veth0 veth1
	macsec far0 veth1 veth0
	runs far0
}

is_up() { ip link show "$1" | grep LOWER_UP >/dev/null; }

# usb_card: main0 is a USB network card, its network that of veth0
usb_card() {
	local net='/sys/bus/usb/drivers/smsc95xx/*/net/*'

	modprobe -a vhci-hcd smsc95xx
	python3 "$BATS_TEST_DIRNAME/smsc95xx.py" veth0 >"$BATS_TEST_TMPDIR/card" 2>&1 3>&- &
	CARD=$!
	wait_for 30 compgen -G "$net" || { cat "$BATS_TEST_TMPDIR/card"; return 1; }
	# shellcheck disable=SC2086
	ip link set "$(basename $net)" name main0
	ip link set main0 up
	wait_for 30 is_up main0
}

@test "a USB card whose driver pushes headers (smsc95xx) runs the bench" {
	usb_card
	runs veth1
	# it is pulled while the master uses it
	kill "$CARD"
	wait_for 30 main_is waiting...
}
