# SPDX-License-Identifier: GPL-2.0-only
# Module parameters: what can never work is refused, what is likely mistyped reported,
# each in one line of the log.

load helpers

setup_file() { modprobe -a veth bridge; }
setup() { dmesg -C; }
teardown() {
	local name

	stop
	for name in veth0 veth2 br0; do ip link del $name 2>/dev/null || true; done
}

master() { insmod "$EC_BUILD/modules/master/ec_master.ko" "$@"; }
generic() { insmod "$EC_BUILD/modules/devices/ec_generic.ko"; }
sim() { insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" "$@"; }

# the log has one line of ours, and it has PATTERN
one_line() {
	dmesg | grep -E 'EtherCAT|ec_' | grep -v 'ec_[a-z]*: .*taint' | tee "$BATS_TEST_TMPDIR/log"
	[ "$(wc -l <"$BATS_TEST_TMPDIR/log")" = 1 ]
	grep -qE -- "$1" "$BATS_TEST_TMPDIR/log"
}

# no_insmod PATTERN COMMAND...: fails, with one line
no_insmod() {
	dmesg -C
	run "${@:2}"
	echo "$output"
	[ "$status" != 0 ]
	one_line "$1"
}

@test "insmod fails for addresses and names that no device can have" {
	local no='"%s" is neither the MAC address of a device' mac

	for mac in 00:11:22:33:44 00:11:22:33:44:5 00:11:22:33:44:555 00:11:22:33:44:gg \
		00:00:00:00:00:00 01:00:5e:00:00:01 0011:22:33:44:55 eth0:1; do
		no_insmod "main_devices: ${no/\%s/$mac}" master main_devices=$mac
	done
	no_insmod '"a/b" cannot be an interface name' master main_devices=a/b
	no_insmod 'cannot be an interface name' master main_devices=abcdefghijklmnop
	[ ! -e /dev/EtherCAT0 ]
	no_insmod 'entry 1 is empty' master main_devices=sim0,
	no_insmod 'device sim0 is listed twice' master main_devices=sim0,sim0
	no_insmod 'device 0000:0A:00.0 is listed twice' \
		master main_devices=0000:0a:00.0,0000:0A:00.0
	no_insmod 'nor a PCI address, as 0000:01:00.0' master main_devices=0000:0a:00.0x
	no_insmod 'nor a PCI address, as 0000:01:00.0' master main_devices=0a:00.0
	no_insmod 'debug_level: 3 is not 0, 1 or 2' master main_devices=sim0 debug_level=3
}

@test "backup devices are refused until there is redundancy" {
	no_insmod 'backup_devices: "eth1": this version has no cable redundancy; load ec_master without' \
		master main_devices=sim0 backup_devices=eth1
	no_insmod 'backup_devices: "eth1"' master main_devices=sim0,sim1 backup_devices=,eth1
	# none, as scripts write it
	dmesg -C
	master main_devices=sim0 backup_devices=
	[ -z "$(dmesg | grep EtherCAT)" ]
}

@test "a missing interface is reported, and the master waits for it" {
	master main_devices=veth0
	generic
	one_line '"veth0" is neither the name nor the MAC address of a network interface; master 0 waits'
	# what is waited for is shown by its name
	ethercat master | grep -q 'Main: veth0 (waiting...)'
	json '.masters[0].devices[0].interface == "veth0"' master
	dmesg -C
	ip link add veth0 type veth peer name veth1
	wait_for 60 eval 'ethercat master | grep -q "(attached)"'
	one_line 'main device'
	ethercat master | grep -qE 'Main: ([0-9a-f]{2}:){5}[0-9a-f]{2} \(attached\)'
}

@test "an address that no interface has is reported; lo is not an Ethernet interface" {
	master main_devices=02:00:00:00:77:77
	generic
	one_line '"02:00:00:00:77:77" is neither the name nor the MAC address'
	ethercat master | grep -q 'Main: 02:00:00:00:77:77 (waiting...)'
	stop
	dmesg -C
	master main_devices=lo
	generic
	one_line '"lo" is not an Ethernet interface'
}

@test "the broadcast address waits for any Ethernet interface, and says so" {
	master main_devices=ff:ff:ff:ff:ff:ff
	generic
	one_line '"ff:ff:ff:ff:ff:ff" selects the first free Ethernet interface, none is present; master 0 waits'
	dmesg -C
	ip link add veth0 type veth peer name veth1
	wait_for 60 eval 'ethercat master | grep -q "(attached)"'
	one_line 'main device'
}

# neither veth1 nor the bridge is free
bridged() {
	ip link add br0 type bridge
	ip link set veth1 master br0
	ip address add 10.1.0.1/24 dev br0
}

@test "the broadcast address is no interface with an IP address, and no port of a bridge" {
	ip link add veth0 type veth peer name veth1
	ip link add veth2 type veth peer name veth3
	bridged
	ip address add 10.2.0.1/24 dev veth0
	ip address add 10.3.0.1/24 dev veth2
	master main_devices=ff:ff:ff:ff:ff:ff
	generic
	wait_for 60 eval 'ethercat master | grep -q "(attached)"'
	dmesg | grep -q 'main device .*veth3.* attached'
}

@test "an interface whose last IP address is removed is free for the broadcast address" {
	ip link add veth0 type veth peer name veth1
	bridged
	ip address add 10.2.0.1/24 dev veth0
	ip address add 10.3.0.1/24 dev veth0
	master main_devices=ff:ff:ff:ff:ff:ff
	generic
	ip address del 10.2.0.1/24 dev veth0
	sleep 1
	ethercat master | grep -q '(waiting...)'
	ip address del 10.3.0.1/24 dev veth0
	wait_for 60 eval 'ethercat master | grep -q "(attached)"'
}

@test "the broadcast address means the first device that is offered" {
	ip link add veth0 type veth peer name veth1
	ip link set veth0 address 02:00:00:00:12:01
	master main_devices=ff:ff:ff:ff:ff:ff,ff:ff:ff:ff:ff:ff
	ethercat master | grep -q 'Main: ff:ff:ff:ff:ff:ff (waiting...)'
	sim segment=thin
	wait_for 60 eval 'ethercat master -m0 | grep -q "Main: 02:00:00:ec:51:00 (attached)"'
	ethercat master -m1 | grep -q '(waiting...)'
	wait_for 60 eval '[ "$(ethercat slaves -m0 | wc -l)" = 2 ]'
	# the second device is the second master's, the third is nobody's
	generic
	wait_for 60 eval 'ethercat master -m1 | grep -q "(attached)"'
	[ "$(ip -br link | grep -c '^veth[01].*LOWER_UP\|^veth[01].*,UP')" -ge 1 ]
	dmesg
	[ "$(dmesg | grep -c 'main device .* attached')" = 2 ]
}

@test "an unknown segment: insmod fails with one line; sim1 of one segment is reported" {
	master main_devices=sim1
	no_insmod 'segment=bnech: neither a built-in segment \(thin, three, .*ENOENT' sim segment=bnech
	dmesg -C
	sim segment=thin
	one_line '"sim1" is not offered, segment= names 1 segment\(s\); master 0 waits'
}

@test "ec_sim at a missing interface: insmod fails with one line" {
	master main_devices=veth0
	no_insmod "no network device 'veth7'" sim segment=thin netdev=veth7
	no_insmod 'lo is not an Ethernet device' sim segment=thin netdev=lo
}

@test "the limit of acyclic frames is refused outside its range, and changes while the module is loaded" {
	local p=/sys/module/ec_master/parameters/max_acyclic n

	for n in 0 193 many; do
		run master main_devices=sim0 max_acyclic=$n
		[ "$status" != 0 ]
	done
	master main_devices=sim0 max_acyclic=16
	[ "$(cat $p)" = 16 ]
	echo 192 >$p
	for n in 0 193 -1; do
		run sh -c "echo $n >$p"
		[ "$status" != 0 ]
	done
	[ "$(cat $p)" = 192 ]
}
