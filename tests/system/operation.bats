# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 600
# ethercatctl: the configurations of tests/operation/conf at network cards, and what goes wrong.

load helpers

CONF=$BATS_TEST_DIRNAME/../operation/conf
CTL=$BATS_TEST_DIRNAME/../../operation/ethercatctl

# a tree of our modules only: depmod of all others takes long
setup_file() {
	local tree=$BATS_FILE_TMPDIR/lib/modules/$(uname -r)

	modprobe -a veth bridge macvlan
	modprobe e1000e
	ip link set eth1 up
	mkdir -p "$tree"
	cp "$EC_BUILD"/modules/{master,devices,devices/sim,devices/intel}/*.ko "$tree"
	depmod -b "$BATS_FILE_TMPDIR" "$(uname -r)"
	mount --bind "$tree" "/lib/modules/$(uname -r)"
	printf '%s\n' 'slave c EK1100' 'slave a EL3062' 'slave m drive in=8 out=8' \
		>"$BATS_FILE_TMPDIR/segment"
	export PATH=$EC_BUILD/tool:$PATH
}

teardown_file() { umount "/lib/modules/$(uname -r)"; }

setup() {
	unset -f ethercat
	pid=
	ip link add veth0 type veth peer name veth1
	dmesg -C
}

teardown() {
	[ -z "$pid" ] || kill "$pid" 2>/dev/null || true
	rmmod ec_mini ec_sim ec_generic ec_intel ec_master 2>/dev/null || true
	rm -f /run/ethercatctl
	ip link del veth0 2>/dev/null || true
}

ctl() { "$CTL" -c "$CONF/$1.conf" "$2"; }

# conf LINE...: a configuration of these lines
conf() {
	printf '%s\n' "$@" >"$BATS_TEST_TMPDIR/conf"
}
own() { "$CTL" -c "$BATS_TEST_TMPDIR/conf" "$1"; }

none_loaded() {
	[ -z "$(lsmod | grep -o '^ec_[a-z]*')" ]
	[ ! -e /run/ethercatctl ]
}

# fails PATTERN COMMAND...: with one line
fails() {
	run "${@:2}"
	echo "$output"
	[ "$status" = 1 ]
	[[ ${#lines[@]} = 1 && $output =~ $1 ]]
}

is_up() { [[ $(cat "/sys/class/net/$1/flags") =~ [13579bdf]$ ]]; }

slaves_are() { [ "$(ethercat slaves -m "$1" | grep -c PREOP)" = "$2" ]; }

@test "sim.conf: start reports each master, status follows, stop leaves nothing" {
	run ctl sim start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ ^"Master0: sim0 (attached), link up, " ]]
	[[ ${lines[1]} =~ ^"Master1: sim1 (attached), link up, " ]]
	[ ${#lines[@]} = 2 ]
	wait_for 60 slaves_are 0 3
	wait_for 60 slaves_are 1 2
	run ctl sim status
	echo "$output"
	[ "$status" = 0 ]
	[ "${lines[0]}" = "Master0  running" ]
	[ "${lines[1]}" = "  sim0 (attached), link up, slaves: 3 (3 PREOP)" ]
	[ "${lines[2]}" = "Master1  running" ]
	# a second start changes nothing
	run ctl sim start
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: ec_master is already loaded" ]
	slaves_are 0 3
	ctl sim restart
	run ctl sim stop
	[ "$status" = 0 ]
	[ -z "$output" ]
	none_loaded
	run ctl sim status
	[ "$status" = 1 ]
	[ "$output" = "$(printf 'Master0  dead\nMaster1  dead')" ]
	run ctl sim stop
	[ "$status" = 0 ]
	[ "$output" = "ethercatctl: ec_master is not loaded" ]
}

@test "a card without native driver, by its MAC address, uses ec_generic, reported in a line" {
	ethercat-sim --segment "$BATS_FILE_TMPDIR/segment" eth1 3>&- &
	pid=$!
	conf 'MASTER0_DEVICE="52:54:00:EC:00:00"' 'DEVICE_MODULES="r8169"'
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: eth0 uses ec_generic: DEVICE_MODULES names no native driver of it" ]
	[[ ${lines[1]} =~ ^"Master0: 52:54:00:ec:00:00 (attached), link " ]]
	[ ${#lines[@]} = 2 ]
	[ "$(lsmod | grep -o '^ec_[a-z]*' | sort | tr '\n' ' ')" = "ec_generic ec_master " ]
	wait_for 60 slaves_are 0 3
	own stop
	none_loaded
}

@test "names.conf: two masters, interfaces up at start and down at stop" {
	ip link set eth0 down
	run ctl names start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ ^"Master0: eth0 (attached), " && ${lines[1]} =~ ^"Master1: veth0 (attached), " ]]
	is_up eth0
	is_up veth0
	ctl names stop
	none_loaded
	run is_up eth0
	[ "$status" = 1 ]
}

@test "native.conf: the native driver gets the card, and gives it back at stop" {
	ip addr add 192.0.2.1/24 dev eth0
	run ctl native start
	echo "$output"
	[ "$status" = 0 ]
	[ ${#lines[@]} = 2 ]
	[[ ${lines[0]} =~ "eth0 has an IP address; no other program can use it while the master does" ]]
	[[ ${lines[1]} =~ ^"Master0: eth0 (attached), link " ]]
	[ ! -e /sys/class/net/eth0 ]
	# the interface is absent now
	ctl native start
	ctl native stop
	none_loaded
	[ "$(cat /sys/class/net/eth0/address)" = 52:54:00:ec:00:00 ]
}

ring_is() { [[ $(ethercat master) == *"Ring: $1"* ]]; }

@test "MASTER0_BACKUP: a ring of the simulator, and of two cards" {
	printf 'repeat 4 slave d drive\nwire d4.1 -> master.1\n' >"$BATS_TEST_TMPDIR/ring"
	conf 'MASTER0_DEVICE=sim0' 'MASTER0_BACKUP=sim0b' "SIM_SEGMENT=$BATS_TEST_TMPDIR/ring"
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[[ $output =~ ^"Master0: sim0 (attached), link up, backup sim0b (attached), link up, ring " ]]
	wait_for 60 slaves_are 0 4
	wait_for 60 ring_is closed
	run own status
	[ "${lines[1]}" = "  sim0 (attached), link up, backup sim0b (attached), link up, ring closed, slaves: 4 (4 PREOP)" ]
	run own start
	[ "$status" = 0 ]
	[ "${lines[0]}" = "ethercatctl: ec_master is already loaded" ]
	# the same master without its ring is another configuration
	conf 'MASTER0_DEVICE=sim0' "SIM_SEGMENT=$BATS_TEST_TMPDIR/ring"
	fails 'already loaded with backup_devices=sim0b, but .* has none; run' own start
	own stop
	none_loaded
	# the second of two masters has one
	conf 'MASTER0_DEVICE=sim0' 'MASTER1_DEVICE=sim1' 'MASTER1_BACKUP=sim1b' \
		"SIM_SEGMENT=thin,$BATS_TEST_TMPDIR/ring"
	own start
	wait_for 60 slaves_are 1 4
	[ "$(cat /sys/module/ec_master/parameters/backup_devices)" = ,sim1b ]
	own start
	own stop
	none_loaded
	run ctl backup start
	echo "$output"
	[ "$status" = 0 ]
	[[ $output =~ "Master0: 52:54:00:ec:00:00 (attached), link "[a-z]*", backup 52:54:00:ec:00:01 (attached)" ]]
	ctl backup stop
	none_loaded
	conf 'MASTER0_DEVICE=eth0' 'MASTER0_BACKUP=eth1' 'DEVICE_MODULES="e1000e"'
	own start
	[ "$(ethercat devices -j | gojq -r '[.devices[] | select(.driver == "ec_intel").used_by] | join(",")')" = \
		"Master0 main,Master0 backup" ]
	own stop
	none_loaded
	[ "$(cat /sys/class/net/eth1/address)" = 52:54:00:ec:00:01 ]
}

@test "modules.conf: each master gets the driver of its card" {
	run ctl modules start
	echo "$output"
	[ "$status" = 0 ]
	[[ $output =~ "Master0: 52:54:00:ec:00:00 (attached)" && $output =~ "Master1: veth0 (attached)" ]]
	[ "$(lsmod | grep -o '^ec_[a-z]*' | sort | tr '\n' ' ')" = "ec_generic ec_intel ec_master " ]
	ctl modules stop
	none_loaded
}

@test "a start that fails names the cause and leaves nothing loaded" {
	conf 'MASTER0_DEVICE="eth0"' 'MASTER0_BACKUP="eth0"'
	fails 'conf:2: MASTER0_BACKUP="eth0" is also MASTER0_DEVICE; each end' own start
	conf 'MASTER0_DEVICE="eth0"' 'MASTER0_BACKUP="52:54:00:ec:00:00"'
	fails 'conf:2: MASTER0_BACKUP="52:54:00:ec:00:00" is eth0, which another' own start
	none_loaded
	conf '' 'MASTER0_DEVICE="eth9"'
	fails 'conf:2: MASTER0_DEVICE="eth9": no such device after 10 s' own start
	none_loaded
	conf ''
	fails 'names no master: set MASTER0_DEVICE to a MAC address' own start
	conf 'MASTER0_DEVICE="sim0"' 'SIM_SEGMENT="bnech"'
	fails "conf:2: SIM_SEGMENT: no segment 'bnech'; there are thin, three" own start
	none_loaded
	# the clone may be in a folder of root's
	install -m 755 -D -t /run/ctl "$CTL" "${CTL%/*}"/{conf,devices}.sh "$CONF/sim.conf"
	fails "'start' needs root" setpriv --reuid=65534 --clear-groups /run/ctl/ethercatctl \
		-c /run/ctl/sim.conf start
	conf 'MASTER0_DEVICE="sim0"' 'MODPROBE_FLAGS="-d/nowhere"'
	fails "cannot load ec_master: it is not installed for the kernel $(uname -r) .6.1 to 7.3 can have it.; install ethercat-dkms and linux-headers-$(uname -r), or run 'make install'" own start
	none_loaded
}

@test "start refuses an interface that can never work, and restart then stops nothing" {
	conf 'MASTER0_DEVICE="lo"'
	fails 'conf:1: MASTER0_DEVICE="lo": the loopback interface has no cable' own start
	ip link add br0 type bridge
	ip link set veth0 master br0
	conf 'MASTER0_DEVICE="veth0"'
	fails "veth0 is a port of br0; release it with 'ip link set veth0 nomaster'" own start
	ip link del br0
	ip link set veth0 mtu 1400
	fails "veth0 has MTU 1400, frames need 1500; run 'ip link set veth0 mtu 1500'" own start
	ip link set veth0 mtu 1500
	ip link add link veth0 name mac0 type macvlan
	fails 'conf:1: MASTER0_DEVICE="veth0": the master cannot use veth0: in use by a bridge,' \
		own start
	none_loaded
	ip link del mac0
	own start
	conf 'MASTER0_DEVICE="lo"'
	fails 'the loopback interface has no cable' own restart
	attached "$(cat /sys/class/net/veth0/address)"
	own stop
	none_loaded
}

# stub NAME LINE...: a program that ethercatctl finds first
stub() {
	mkdir -p "$BATS_TEST_TMPDIR/bin"
	printf '%s\n' '#!/bin/sh' "${@:2}" >"$BATS_TEST_TMPDIR/bin/$1"
	chmod +x "$BATS_TEST_TMPDIR/bin/$1"
}
stubbed() { PATH=$BATS_TEST_TMPDIR/bin:$PATH own "$1"; }

attached() { [[ $(ethercat master) =~ $1" (attached)" ]]; }

@test "a card that appears after the start is used, by its MAC address" {
	conf 'MASTER0_DEVICE="52:54:00:EC:0F:01"'
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ 'conf:1: MASTER0_DEVICE="52:54:00:ec:0f:01": no such device after 10 s' ]]
	[[ ${lines[0]} =~ '; the master waits for it' ]]
	[[ ${lines[1]} =~ ^"Master0: 52:54:00:ec:0f:01 (waiting...)" ]]
	[ ${#lines[@]} = 2 ]
	ip link del veth0
	ip link add veth0 address 52:54:00:ec:0f:01 type veth peer name veth1
	wait_for 10 attached 52:54:00:ec:0f:01
	own stop
	none_loaded
}

@test "a name is that of the interface after udev has renamed it" {
	local mac

	read -r mac </sys/class/net/veth1/address
	stub udevadm '[ ! -e /sys/class/net/veth1 ] || {' 'ip link set veth0 name lan0' \
		'ip link set veth1 name veth0' '}'
	conf 'MASTER0_DEVICE="veth0"'
	stubbed start
	attached "$mac"
	own stop
	none_loaded
}

@test "two interfaces of a master, or two masters of one interface, are reported with their line" {
	local mac

	read -r mac </sys/class/net/veth0/address
	conf "MASTER0_DEVICE=$mac" 'MASTER1_DEVICE=veth0'
	fails 'conf:2: MASTER1_DEVICE="veth0" is veth0, which another master has' own start
	none_loaded
	ip link set veth1 address "$mac"
	conf '' "MASTER0_DEVICE=$mac"
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ conf:2:.*": the address of several interfaces (veth0 veth1)," ]]
	own stop
	none_loaded
}

@test "an interface that the network configuration manages is reported" {
	local links=/run/systemd/netif/links index

	read -r index </sys/class/net/veth0/ifindex
	conf 'MASTER0_DEVICE="veth0"'
	mkdir -p $links
	echo 'ADMIN_STATE=configuring' >$links/"$index"
	run stubbed start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ ": warning: systemd-networkd configures veth0; exclude it there, see " ]]
	own stop
	echo 'ADMIN_STATE=unmanaged' >$links/"$index"
	stub nmcli '[ "$*" = "-g GENERAL.STATE device show veth0" ] && echo "30 (disconnected)"'
	run stubbed start
	echo "$output"
	[[ ${lines[0]} =~ "warning: NetworkManager configures veth0; exclude it there" ]]
	own stop
	stub nmcli 'echo "10 (unmanaged)"'
	run stubbed start
	echo "$output"
	[[ ${lines[0]} =~ ^"Master0: veth0 (attached)" ]]
	own stop
	rm -r $links
}

finished() { [[ $(cat "$BATS_TEST_TMPDIR/out") =~ ^"Master0: " ]]; }

@test "a start waits for another ethercatctl, and a start that is ended unloads the modules" {
	conf 'MASTER0_DEVICE="sim0"'
	exec 8>>/run/ethercatctl.lock
	flock 8
	own start >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- 8>&- &
	pid=$!
	sleep 2
	none_loaded
	flock -u 8
	wait_for 30 finished
	own stop
	none_loaded
	stub modprobe '[ "$1" != ec_sim ] || sleep 5' 'exec /sbin/modprobe "$@"'
	PATH=$BATS_TEST_TMPDIR/bin:$PATH "$CTL" -c "$BATS_TEST_TMPDIR/conf" start 3>&- 8>&- &
	pid=$!
	wait_for 10 test -e /sys/module/ec_master
	kill "$pid"
	wait "$pid" || true	# ended
	none_loaded
}

@test "modules that are loaded already are used only with the same devices" {
	modprobe ec_master main_devices=veth0
	fails 'ec_master is already loaded with main_devices=veth0, but .* has sim0,sim1; run' \
		ctl sim start
	[ "$(lsmod | grep -o '^ec_[a-z]*')" = ec_master ]
	conf 'MASTER0_DEVICE="veth0"'
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[1]} =~ ^"Master0: veth0 (attached)" ]]
	# the configuration may have become wrong since
	conf 'MASTER0_DEVICE="a/b"'
	run own stop
	[ "$status" = 0 ]
	none_loaded
}

# as the udev rule of 'ethercat device bind --boot' leaves it
@test "a card that ec_intel has already is used, and ec_master is loaded again for it" {
	modprobe ec_intel
	ethercat device bind eth0 --force
	conf 'MASTER0_DEVICE="52:54:00:ec:00:00"'
	run own start
	echo "$output"
	[ "$status" = 0 ]
	[ ${#lines[@]} = 1 ]
	[[ $output =~ ^"Master0: 52:54:00:ec:00:00 (attached), link " ]]
	own stop
	none_loaded
	# it is still reserved
	[ ! -e /sys/class/net/eth0 ]
	own start
	ethercat device unbind 52:54:00:ec:00:00 --force
	own stop
	[ -e /sys/class/net/eth0 ]
}

up_to_op() {	# up_to_op POSITION
	ethercat states -p"$1" SAFEOP --wait
	ethercat states -p"$1" OP --wait
}

in_state() { ethercat slaves -p"$1" | grep -E "^$1 +[^ ]+ +$2 "; }

@test "a reader keeps stop from unloading, which names it, and not slaves in OP" {
	conf 'MASTER0_DEVICE="sim0"' "SIM_SEGMENT=\"$BATS_FILE_TMPDIR/segment\""
	own start
	wait_for 60 slaves_are 0 3
	up_to_op 1
	sleep 600 3>&- 4</dev/EtherCAT0 &
	pid=$!
	run own stop
	echo "$output"
	[ "$status" = 1 ]
	[[ ${lines[0]} =~ ^"ethercatctl: slaves have left OP; to unload" ]]
	[ "${lines[1]}" = "EtherCAT0: process $pid (sleep)" ]
	[ ${#lines[@]} = 2 ]
	in_state 1 PREOP
	# the kernel refuses before the module can do anything
	up_to_op 1
	run rmmod ec_master
	echo "$output"
	[ "$status" = 1 ]
	in_state 1 OP
	# the master can be used as before, once a start has reported the refusal
	run own stop
	[ "$status" = 1 ]
	fails 'since the last stop was refused' own start
	own start
	up_to_op 1
	kill "$pid"
	wait "$pid" || true	# killed
	own stop
	none_loaded
}

@test "stop names the module that has a master" {
	conf 'MASTER0_DEVICE="sim0"' "SIM_SEGMENT=\"$BATS_FILE_TMPDIR/segment\""
	own start
	wait_for 60 slaves_are 0 3
	insmod "$EC_BUILD/mini/ec_mini.ko" position=2
	wait_for 60 in_state 2 OP
	run own stop
	echo "$output"
	[ "$status" = 1 ]
	[ "${lines[0]}" = "ethercatctl: a master is in use; end its users first:" ]
	[ "${lines[1]}" = "ec_master: module ec_mini" ]
	[ ${#lines[@]} = 2 ]
	in_state 2 OP
	rmmod ec_mini
	own stop
	none_loaded
}

@test "stop takes slaves out of OP, and fails while one stays there" {
	conf 'MASTER0_DEVICE="sim0"' "SIM_SEGMENT=\"$BATS_FILE_TMPDIR/segment\""
	own start
	wait_for 60 slaves_are 0 3
	up_to_op 1
	echo 'mute a' >/sys/kernel/debug/ec_sim/sim0
	run own stop
	echo "$output"
	[ "$status" = 1 ]
	[[ $output =~ ^"ethercatctl: Master0: slaves stay in OP: 1; nothing is unloaded" ]]
	[ -c /dev/EtherCAT0 ]
	echo 'unmute a' >/sys/kernel/debug/ec_sim/sim0
	ethercat states -p1 PREOP --wait
	up_to_op 1
	# an error in OP is OP; states that are not known may be
	mkdir "$BATS_TEST_TMPDIR/bin"
	printf '%s\n' '#!/bin/sh' '[ "$1" = slaves ] && echo "1  0:1  OP+ERROR  E  x"' \
		>"$BATS_TEST_TMPDIR/bin/ethercat"
	chmod +x "$BATS_TEST_TMPDIR/bin/ethercat"
	PATH=$BATS_TEST_TMPDIR/bin:$PATH run own stop
	echo "$output"
	[ "$status" = 1 ]
	[[ $output =~ ^"ethercatctl: Master0: slaves stay in OP: 1; nothing is unloaded" ]]
	sed -i '2s/.*/exit 1/' "$BATS_TEST_TMPDIR/bin/ethercat"
	PATH=$BATS_TEST_TMPDIR/bin:$PATH run own stop
	echo "$output"
	[ "$status" = 1 ]
	[[ $output =~ ^"ethercatctl: Master0: the states of its slaves are not known, nothing is unloaded" ]]
	[ -c /dev/EtherCAT0 ]
	own stop
	none_loaded
}
