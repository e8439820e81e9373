#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Network devices of slaves with EoE: a ping, a page of a slave, a bridge, unload while open. With
# the udev of this machine: the bridge of ethercat.conf, and that of systemd-networkd.

load helpers

setup() {
	modprobe bridge
	start eoe 3
	wait_for 10 eval 'ethercat eoe | grep -q eoe0a5'
}

teardown() {
	[ -z "${udevd:-}" ] || end_udev
	ip link del br7 2>/dev/null || true
	stop
}

page() {
	exec 3<>"/dev/tcp/$1/80"
	printf 'GET / HTTP/1.0\r\n\r\n' >&3
	timeout 10 cat <&3
	exec 3>&-
}

@test "a slave answers a ping and serves a page; the device follows its state" {
	ethercat eoe
	[ "$(cat /sys/class/net/eoe0a5/ifalias)" = eoe0s1 ]
	[ "$(cat /sys/class/net/eoe0a5/operstate)" = down ]
	ethercat ip -p1 ip_address 192.168.5.2/24
	ip addr add 192.168.5.1/24 dev eoe0a5
	ip link set eoe0a5 up
	wait_for 5 eval '[ "$(cat /sys/class/net/eoe0a5/carrier)" = 1 ]'
	run page 192.168.5.2
	[[ $output == *web* ]]
	ethercat eoe | grep -Eq 'eoe0a5 +1 +up +[1-9]'
	ethercat states -p1 INIT
	wait_for 5 eval '[ "$(cat /sys/class/net/eoe0a5/carrier)" = 0 ]'
	ethercat eoe | grep -Eq 'eoe0a5 +1 +wait'
	ethercat states -p1 PREOP
	wait_for 5 eval '[ "$(cat /sys/class/net/eoe0a5/carrier)" = 1 ]'
	run page 192.168.5.2
	[[ $output == *web* ]]
}

@test "a bridge joins the slaves and the host" {
	ethercat ip -p1 ip_address 192.168.5.2/24
	ethercat ip -p2 ip_address 192.168.5.3/24
	[ "$(ethercat eoe bridge br7)" = 'eoe0a5, eoe0s2' ]
	ip addr add 192.168.5.1/24 dev br7
	wait_for 40 eval 'page 192.168.5.3 | grep -q axis'
	run page 192.168.5.2
	[[ $output == *web* ]]
	# once more: nothing changes
	ethercat eoe bridge br7
	run ethercat eoe bridge 'a/b'
	[ "$status" = 1 ]
	[[ $output == *"no name of a network device"* ]]
}

@test "devices are removed and made by root only, and go with the module while they are up" {
	ip link set eoe0a5 up
	# one that may use the bus, but not change network devices
	run setpriv --bounding-set -net_admin --inh-caps -net_admin \
		"$EC_BUILD/tool/ethercat" eoe_delif -p1
	[ "$status" = 1 ]
	[[ $output == *"root only (CAP_NET_ADMIN)"* ]]
	ethercat eoe_delif -p1
	wait_for 5 eval '[ ! -e /sys/class/net/eoe0a5 ]'
	ethercat eoe_addif -p1
	wait_for 5 eval '[ -e /sys/class/net/eoe0a5 ]'
	run ethercat eoe_addif -p0
	[ "$status" = 1 ]
	[[ $output == *"slave 0 has no EoE"* ]]
	ip link set eoe0a5 name port1
	ip link set port1 up
	ethercat eoe | grep -q ' port1 '
	rmmod ec_sim
	rmmod ec_master
	[ ! -e /sys/class/net/port1 ]
}

@test "the Ethernet port of a simulated switch is a network device, for another computer" {
	local talk=$BATS_TEST_DIRNAME/eoe_talk.py server

	stop
	printf '%s\n' 'slave c EK1100' 'slave sw EL6614 alias=7 eoe=switch' \
		'slave a_name_that_is_long EL6614 alias=8 eoe=switch' >"$BATS_TEST_TMPDIR/segment"
	load_master
	load_segment "$BATS_TEST_TMPDIR/segment"
	wait_for 60 all_slaves_are PREOP 3
	[ -e /sys/class/net/sim0-p2 ]
	ip netns add outside
	ip link set sim0-sw netns outside
	ip -n outside addr add 192.168.7.2/24 dev sim0-sw
	ip -n outside link set sim0-sw up
	ip netns exec outside python3 "$talk" serve 3>&- &
	server=$!
	ip addr add 192.168.7.1/24 dev eoe0a7
	ip link set eoe0a7 up
	wait_for 20 eval '[ "$(cat /sys/class/net/eoe0a7/carrier)" = 1 ]'
	[ "$(timeout 200 python3 "$talk" echo 192.168.7.2 60000)" = '60000 bytes came back' ]
	# the port of a slave in INIT takes no frames and keeps none
	ethercat states -p1 INIT
	wait_for 5 eval '[ "$(cat /sys/class/net/eoe0a7/carrier)" = 0 ]'
	ip netns exec outside timeout 5 bash -c 'echo >/dev/tcp/192.168.7.1/9' || true
	ethercat states -p1 PREOP
	wait_for 5 eval '[ "$(cat /sys/class/net/eoe0a7/carrier)" = 1 ]'
	[ "$(timeout 200 python3 "$talk" echo 192.168.7.2 20000)" = '20000 bytes came back' ]
	# the module takes it away where it is now
	rmmod ec_sim
	run ip -n outside link show dev sim0-sw
	[ "$status" = 1 ]
	kill $server
	ip netns del outside
}

# a computer with the rules, the modules and udev; slave "late" has no power
start_udev() {
	local tree=$BATS_TEST_TMPDIR/lib/modules/$(uname -r)

	stop
	mkdir -p "$tree" /etc/udev/rules.d
	cp "$EC_BUILD"/modules/{master,devices/sim}/*.ko "$tree"
	depmod -b "$BATS_TEST_TMPDIR" "$(uname -r)"
	mount --bind "$tree" "/lib/modules/$(uname -r)"
	cp "$BATS_TEST_DIRNAME/../../master/60-ethercat.rules" /etc/udev/rules.d
	printf '%s\n' 'slave c EK1100' 'slave web drive alias=5 eoe=host' 'branch none' \
		'slave late drive alias=6 eoe=host' >"$BATS_TEST_TMPDIR/segment"
	SYSTEMD_IGNORE_CHROOT=1 /lib/systemd/systemd-udevd \
		>"$BATS_TEST_TMPDIR/udevd" 2>&1 3>&- &
	udevd=$!
	wait_for 60 env SYSTEMD_IGNORE_CHROOT=1 udevadm control --ping
}

end_udev() {
	kill "$udevd" ${networkd:-} 2>/dev/null || true
	umount "/lib/modules/$(uname -r)" || true
	cat "$BATS_TEST_TMPDIR/udevd"
	[ -z "${networkd:-}" ] || cat "$BATS_TEST_TMPDIR/networkd"
	ip link del br0 2>/dev/null || true
	rm -f /etc/systemd/network/3?-eoe*
}

ports() { (cd "/sys/class/net/$1/brif" && echo *); }
ports_are() { [ "$(ports "$1")" = "$2" ]; }
plug_late() { echo 'plug web.1 late.0' >/sys/kernel/debug/ec_sim/sim0; }

@test "udev and the bridge of ethercat.conf: also a slave that gets power later is a port" {
	local ctl=$BATS_TEST_DIRNAME/../../operation/ethercatctl

	start_udev
	printf '%s\n' 'MASTER0_DEVICE=sim0' "SIM_SEGMENT=$BATS_TEST_TMPDIR/segment" \
		'EOE_BRIDGE=br7' 'EOE_BRIDGE_ADDRESS="192.168.5.1/24"' >"$BATS_TEST_TMPDIR/conf"
	PATH=$EC_BUILD/tool:$PATH "$ctl" -c "$BATS_TEST_TMPDIR/conf" start
	wait_for 60 ports_are br7 eoe0a5
	ethercat ip -p1 ip_address 192.168.5.2/24
	wait_for 40 eval 'page 192.168.5.2 | grep -q web'
	plug_late
	wait_for 60 ports_are br7 'eoe0a5 eoe0a6'
	ethercat ip -p2 ip_address 192.168.5.3/24
	wait_for 40 eval 'page 192.168.5.3 | grep -q late'
	# the other things that the rules do
	[ "$(cat /sys/class/net/eoe0a6/ifalias)" = eoe0s2 ]
	ip link show dev eoe0s2 | grep -q 'eoe0a6'
	SYSTEMD_IGNORE_CHROOT=1 udevadm info -q property /sys/class/net/eoe0a6 |
		grep -qx NM_UNMANAGED=1
	PATH=$EC_BUILD/tool:$PATH "$ctl" -c "$BATS_TEST_TMPDIR/conf" stop
	[ ! -e /sys/class/net/br7 ]
	# without EOE_BRIDGE a device stays down
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment="$BATS_TEST_TMPDIR/segment"
	wait_for 60 eval '[ -e /sys/class/net/eoe0a5 ]'
	SYSTEMD_IGNORE_CHROOT=1 udevadm settle --timeout=60
	[ "$(cat /sys/class/net/eoe0a5/operstate)" = down ]
}

# networkd_file NAME: of the documentation
networkd_file() {
	"$BATS_TEST_DIRNAME/../build/commands.py" --block Documentation/eoe.rst "# $1" \
		>"/etc/systemd/network/$1"
}

@test "systemd-networkd has the bridge with the files of the documentation, and no device without" {
	start_udev
	mkdir -p /etc/systemd/network /run/systemd
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment="$BATS_TEST_TMPDIR/segment"
	wait_for 60 eval '[ -e /sys/class/net/eoe0a5 ]'
	/lib/systemd/systemd-networkd >"$BATS_TEST_TMPDIR/networkd" 2>&1 3>&- &
	networkd=$!
	wait_for 60 eval '[ -e "/run/systemd/netif/links/$(cat /sys/class/net/eoe0a5/ifindex)" ]'
	grep -qx ADMIN_STATE=unmanaged \
		"/run/systemd/netif/links/$(cat /sys/class/net/eoe0a5/ifindex)"
	[ "$(cat /sys/class/net/eoe0a5/operstate)" = down ]
	kill $networkd
	wait $networkd || true
	networkd_file 30-eoe.netdev
	networkd_file 30-eoe-port.network
	networkd_file 31-eoe.network
	/lib/systemd/systemd-networkd >>"$BATS_TEST_TMPDIR/networkd" 2>&1 3>&- &
	networkd=$!
	wait_for 60 ports_are br0 eoe0a5
	plug_late
	wait_for 60 ports_are br0 'eoe0a5 eoe0a6'
	wait_for 60 eval 'ip addr show dev br0 | grep -q 192.168.5.1/24'
	ethercat ip -p2 ip_address 192.168.5.3/24
	wait_for 40 eval 'page 192.168.5.3 | grep -q late'
}
