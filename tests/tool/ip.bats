#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "ip shows the parameters of the slave" {
	golden ip ip -p2
	out ip -p2 -j | json 'd["ip_address"] == "192.168.0.17" and d["position"] == 2'
	out ip -p2 -j | json 'd["default_gateway"] is None and d["hostname"] == "mixer"'
	FAKE_BUS=evil out ip -p2 | grep -q '^Hostname: '
	[ -z "$(FAKE_BUS=evil out ip -p2 | LC_ALL=C grep '[^ -~]')" ]
}

@test "ip sets the named parameters, in every spelling" {
	local all
	all=$(log_of ip -p2 link 02:00:00:ec:01:07 ADDR 192.168.0.17/24 default 10.0.0.1 \
		dns_address 10.0.0.53 name mixer)
	[ "$all" = "$(printf 'ip 2 0x3f mixer\n%s' "020000ec0107
c0a80011
ffffff00
0a000001
0a000035")" ]
	[ "$(log_of ip -p2 Mac_Address 02-00-00-EC-01-07 | sed -n '1p;2p')" = \
		"$(printf 'ip 2 0x01 \n020000ec0107')" ]
	[ "$(log_of ip -p2 mac_address 020000ec0107 | sed -n 2p)" = 020000ec0107 ]
	[ "$(log_of ip -p2 dns_adress 1.2.3.4 | sed -n '1p;6p')" = "$(printf 'ip 2 0x10 \n01020304')" ]
	[ "$(log_of ip -p2 subnet_mask 255.0.0.0 | sed -n '1p;4p')" = "$(printf 'ip 2 0x04 \nff000000')" ]
	[ "$(log_of ip -p2 addr 1.2.3.4/0 | sed -n 4p)" = 00000000 ]
	[ -z "$(ethercat ip -p2 name mixer 2>&1)" ]
	out ip -p2 -j name mixer | json 'd["hostname"] == "mixer" and d["ip_address"] is None'
}

@test "ip refuses invalid parameters" {
	for c in "name" "addr 1.2.3.4 name" "colour blue" "link 02:00:00:ec:01" "link 02:00:00:ec:01:0g" \
		"link 02:00:00:ec:01:07:08" "link 02:00-00:ec:01:07" "link x" "addr 1.2.3" "addr 1.2.3.256" \
		"addr 1.2.3.4/33" "addr 1.2.3.4/" "addr /8" "addr 1.2.3.4/8x" \
		"mask 255.0.255.0" "mask 0.255.255.255" "link ff:ff:ff:ff:ff:ff" "link 03:00:00:ec:01:07" \
		"link 00:00:00:00:00:00" "addr 10.0.0.1/24 mask 255.0.0.0" \
		"mask 255.0.0.0 addr 10.0.0.1/24" "name a name b" "dns 1.2.3.4 dns_adress 1.2.3.4" \
		"name a23456789b23456789c23456789d23456"; do
		run ethercat ip -p2 $c
		[ "$status" -eq 1 ]
		[[ $output == *"--help"* ]]
	done
	[[ $(err ip -p2 mask 255.0.255.0) == *"invalid subnet mask '255.0.255.0': expected ones, "* ]]
	[[ $(err ip -p2 link ff:ff:ff:ff:ff:ff) == *"broadcast or multicast, bit 0 of the first byte"* ]]
	[[ $(err ip -p2 addr 1.2.3.4/8 mask 255.0.0.0) == *"'mask': this parameter is given already"* ]]
	[[ $(err ip -p2 mask 255.0.0.0 addr 1.2.3.4/8) == *"'1.2.3.4/8' and subnet_mask exclude "* ]]
	[ "$(log_of ip -p2 mask 255.255.255.255 | sed -n 4p)" = ffffffff ]
	[ "$(log_of ip -p2 mask 0.0.0.0 | sed -n 4p)" = 00000000 ]
	run ethercat ip -p2 name ""
	[ "$status" -eq 1 ]
	run ethercat ip -p2 addr no.such.host.invalid
	[ "$status" -eq 1 ]
	[[ $output == *"cannot find the address of 'no.such.host.invalid'"* ]]
}

@test "ip says why a slave has none" {
	run ethercat ip -p1
	[ "$status" -eq 1 ]
	[[ $output == *"slave 1 has no EoE mailbox"* ]]
	run ethercat ip -p0 name a
	[ "$status" -eq 1 ]
	[[ $output == *"EoE result 0x0201"* ]]
	run ethercat ip name a
	[ "$status" -eq 1 ]
	FAKE_READONLY=1 run ethercat ip -p2
	[ "$status" -eq 1 ]
}
