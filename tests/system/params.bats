# SPDX-License-Identifier: GPL-2.0-only
# Module parameters: what can never work is refused, what is likely mistyped reported,
# each in one line of the log. A load that fails at any step leaves nothing behind.

load helpers

setup_file() { modprobe -a veth bridge; }
setup() { dmesg -C; }
teardown() {
	local name

	[ -z "${opener:-}" ] || kill $opener 2>/dev/null || true
	stop
	rmmod ec_fail 2>/dev/null || true
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

@test "a backup device needs a master and a name of its own" {
	local any=ff:ff:ff:ff:ff:ff

	no_insmod 'backup_devices: sim0b: there is no master 0; main_devices= has 0 entries' \
		master backup_devices=sim0b
	no_insmod 'backup_devices: sim1b: there is no master 1; main_devices= has 1 entries' \
		master main_devices=sim0 backup_devices=,sim1b
	no_insmod 'backup_devices: device sim0 is listed twice; each end of a ring needs its own' \
		master main_devices=sim0 backup_devices=sim0
	no_insmod 'backup_devices: device sim1 is listed twice' \
		master main_devices=sim0,sim1 backup_devices=sim1
	no_insmod 'backup_devices: device eth1 is listed twice' \
		master main_devices=sim0,sim1 backup_devices=eth1,eth1
	no_insmod 'master 0: with a backup device both ends of the ring need the name' \
		master main_devices=sim0 backup_devices=$any
	no_insmod 'master 0: with a backup device both ends of the ring need the name' \
		master main_devices=$any backup_devices=eth1
	no_insmod 'backup_devices: "eth0:1" is neither the MAC address of a device' \
		master main_devices=sim0 backup_devices=eth0:1
	[ ! -e /dev/EtherCAT0 ]
	# none, as scripts write it
	dmesg -C
	master main_devices=sim0 backup_devices=
	[ -z "$(dmesg | grep EtherCAT)" ]
	ethercat master | grep -q 'Main: sim0'
	[[ $(ethercat master) != *Ring:* ]]
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
	dmesg | grep -q 'main device attached: veth3'
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
	[ "$(dmesg | grep -c 'main device attached')" = 2 ]
}

@test "an unknown segment: insmod fails with one line; sim1 of one segment is reported" {
	master main_devices=sim1
	no_insmod 'segment=bnech: neither a built-in segment \(thin, three, .*ENOENT' sim segment=bnech
	dmesg -C
	sim segment=thin
	one_line '"sim1" is not offered, segment= names 1 segment\(s\); master 0 waits'
}

@test "a backup device that is absent is reported: sim0b of no ring, a missing interface" {
	master main_devices=sim0 backup_devices=sim0b
	dmesg -C
	sim segment=thin
	dmesg | grep -v attached | grep ec_sim | tee "$BATS_TEST_TMPDIR/log"
	grep -q 'backup_devices: "sim0b" is not offered, that segment has no wire to master.1; master 0' \
		"$BATS_TEST_TMPDIR/log"
	stop
	ip link add veth0 type veth peer name veth1
	master main_devices=veth0 backup_devices=veth9
	dmesg -C
	generic
	dmesg | grep -q 'backup_devices: "veth9" is neither the name nor the MAC address of a network'
	ethercat master | grep -q 'Backup: veth9 (waiting...)'
}

@test "ec_sim at a missing interface: insmod fails with one line" {
	master main_devices=veth0
	no_insmod "no network device 'veth7'" sim segment=thin netdev=veth7
	no_insmod 'lo is not an Ethernet device' sim segment=thin netdev=lo
}

@test "the limit of acyclic frames is refused outside its range, and can change while loaded" {
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

@test "the time limit of AL states is refused outside its range, and can change while loaded" {
	local p=/sys/module/ec_master/parameters/state_timeout_ms n

	for n in 600001 -1 4s; do
		run master main_devices=sim0 state_timeout_ms=$n
		[ "$status" != 0 ]
	done
	master main_devices=sim0 state_timeout_ms=4000
	[ "$(cat $p)" = 4000 ]
	run sh -c "echo 600001 >$p"
	[ "$status" != 0 ]
	echo 0 >$p
	[ "$(cat $p)" = 0 ]
}

@test "the shorter entry of the cycle can be switched off" {
	master main_devices=sim0 short_entry=0
	[ "$(cat /sys/module/ec_master/parameters/short_entry)" = N ]
	wait_for 10 test -e /dev/EtherCAT0
	"$EC_BUILD/apps/ioctl_check" ioctl_only
}

# opened LETTERS: how many of these files could be opened so far
opened() { tr -cd "$1" <"$BATS_TEST_TMPDIR/opened" | wc -c; }

# open_often FILE...: a process of any user opens them all the time, more urgent than insmod
open_often() {
	chrt -f 20 setpriv --reuid=65534 --regid=65534 --clear-groups \
		"$EC_BUILD/apps/opener" "$@" >"$BATS_TEST_TMPDIR/opened" &
	opener=$!
}

# gone MODULE: its load failed; else it is removed as soon as nobody has its files open
gone() {
	local i rc=1

	grep -q "^$1 " /proc/modules || return 0
	kill -USR1 $opener
	for i in $(seq 100); do
		! rmmod "$1" 2>/dev/null || { rc=0; break; }
		sleep 0.01
	done
	kill -USR1 $opener
	return $rc
}

# fail_each MODULE COMMAND...: the load fails at one step after the other, or with stride=N at
# each N-th, the last one among them
fail_each() {
	local p=/sys/module/ec_fail/parameters steps i before loaded=0 failed=0

	insmod "$EC_BUILD/mini/load/ec_fail.ko" module="$1"
	"${@:2}"
	steps=$(cat $p/steps)
	sleep 0.01
	gone "$1"
	for i in $(seq "$steps" "-${stride:-1}" 1); do
		failed=$((failed + 1))
		echo "$i" >$p/at
		before=$(opened abcdefgh)
		if "${@:2}" 2>/dev/null; then
			loaded=$((loaded + 1))
			sleep 0.01
		else
			# also not for a moment
			[ "$(opened abcdefgh)" = "$before" ] || return 1
		fi
		sleep 0.002
		gone "$1" || { echo "$1 stays after step $i"; return 1; }
	done
	echo 0 >$p/at
	rmmod ec_fail
	echo "# ${*/*\//}: $failed of $steps step(s) failed, $loaded of them without harm" >&3
	[ "$steps" -gt 0 ]
}

# by name and by number, of one master and of the second one
open_masters() {
	local i major

	master main_devices=sim0
	major=$(awk '$2 == "EtherCAT" { print $1 }' /proc/devices)
	rmmod ec_master
	for i in 0 1; do
		rm -f /dev/number$i
		mknod -m 666 /dev/number$i c "$major" $i
	done
	open_often /dev/EtherCAT0 /dev/EtherCAT1 /dev/number0 /dev/number1
}

@test "a load of ec_master that fails at any step lets no program open a device for a moment" {
	open_masters
	fail_each ec_master master main_devices=sim0 capture=1
	fail_each ec_master master main_devices=sim0,sim1 capture=1
	# the opener can do it, each way
	for letter in a b c d; do [ "$(opened $letter)" -gt 0 ]; done
	[ ! -e /dev/EtherCAT0 ]
}

@test "a load of ec_master that fails at the second interface lets no program open the device" {
	ip link add eccap1 type veth peer name veth1
	open_masters
	dmesg -C
	for i in $(seq 10); do
		run master main_devices=sim0,sim1 capture=1
		[ "$status" != 0 ]
		sleep 0.002
	done
	ip link del eccap1
	[ "$(opened abcd)" = 0 ]
	dmesg | grep -q 'cannot make the interface eccap1'
}

@test "loads of the devices that fail at any step leave nothing behind" {
	ip link add veth0 type veth peer name veth1
	"$EC_BUILD/apps/opener" /sys/kernel/debug/ec_sim/sim0 /sys/kernel/debug/ec_sim/sim1 \
		>"$BATS_TEST_TMPDIR/opened" &
	opener=$!
	chrt -f -p 20 $opener
	master main_devices=veth0,sim0,sim1
	# nearly all steps make the model, of which nobody knows yet
	stride=5 fail_each ec_sim sim segment=thin,thin
	stride=3 fail_each ec_sim sim segment=thin netdev=veth1
	fail_each ec_generic generic
	fail_each ec_intel insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	for letter in a b; do [ "$(opened $letter)" -gt 0 ]; done
	# nothing is missing afterwards
	sim segment=thin netdev=veth1
	generic
	wait_for 60 eval '[ "$(ethercat slaves -m0 | wc -l)" = 2 ]'
}
