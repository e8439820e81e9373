#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Network devices of slaves with EoE: a ping, a page of a slave, a bridge, unload while open.

load helpers

setup() {
	modprobe bridge
	start eoe 3
	wait_for 10 eval 'ethercat eoe | grep -q eoe0a5'
}

teardown() {
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
