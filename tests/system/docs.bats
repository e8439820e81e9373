# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 900
# The commands of README and Documentation, as they are written there. Which test runs
# which: tests/build/commands.txt.

load helpers

# a source tree after "make", and what "make install" does with the modules
setup_file() {
	export TREE=$BATS_FILE_TMPDIR/tree
	mkdir -p "$TREE"/{build,tool,examples} "$BATS_FILE_TMPDIR/bin"
	ln -s "$(command -v busybox)" "$BATS_FILE_TMPDIR/bin/wget"
	ln -s "$EC_BUILD/modules" "$TREE/build/modules"
	ln -s "$EC_BUILD/tool" "$TREE/tool/build"
	ln -s "$EC_BUILD/examples" "$TREE/examples/build"
	ln -s "$EC_BUILD"/tool/ethercat{,-sim} "$BATS_FILE_TMPDIR/bin"
	local dir
	dir=/lib/modules/$(uname -r)/updates
	mkdir -p "$dir"
	cp "$EC_BUILD"/modules/{master,devices,devices/sim}/*.ko "$dir"
	depmod
	modprobe veth
	install_packages
}

# what ethercat-doc and libethercat-dev install
install_packages() {
	local doc=/usr/share/doc/ethercat-doc

	mkdir -p $doc
	cp -r "$BATS_TEST_DIRNAME/../../examples" $doc
	rm -rf $doc/examples/build ~/examples
	make -s -C "$BATS_TEST_DIRNAME/../../lib" O="$EC_BUILD/lib" install
}

setup() {
	cd "$TREE"
	PATH=$BATS_FILE_TMPDIR/bin:$PATH
	unset -f ethercat
}

teardown() {
	local d
	[ -z "${pid:-}" ] || kill "$pid" 2>/dev/null || true
	[ -z "${pid:-}" ] || wait "$pid" 2>/dev/null || true
	rmmod ec_sim ec_generic ec_master 2>/dev/null || true
	for d in veth0 eth1; do ip link del $d 2>/dev/null || true; done
	rm -f /tmp/segment
}

# doc FILE LINE [PID]: the commands of the block that begins with LINE, one by one; $where: what
# runs them. What does not end by itself goes on in the background.
doc() {
	local line n=0

	while IFS= read -r line; do
		n=$((n + 1))
		line=${line//PID/${3:-PID}}
		echo "$ $line"
		case $line in
		tcpdump*|ethercat-sim*|ethercat\ watch*|cat\ trace_pipe|*dc_motion*\ \&)
			line=${line%&}
			eval "$line" >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- & pid=$! ;;
		ethercat\ slaves|tool/build/ethercat\ slaves) wait_for 60 eval "$line | grep -q PREOP"; eval "$line" ;;
		# 1: a fault, a difference
		ethercat\ why|ethercat\ bus\ check*) eval "$line" || [ $? = 1 ] || return ;;
		*) eval "${where:-} $line" || return ;;
		esac
	done < <("$BATS_TEST_DIRNAME/../build/commands.py" --block "$1" "$2")
	[ $n -gt 0 ]
}

# screen FILE '$ COMMAND': it prints what the page shows
screen() { eval "${2#?}" 2>&1 | "$BATS_TEST_DIRNAME/../build/commands.py" --screen "$1" "$2"; }
# the same but for the values of numbers
like() { eval "${2#?}" 2>&1 | "$BATS_TEST_DIRNAME/../build/commands.py" --like "$1" "$2"; }

has_slaves() { wait_for 60 eval "[ \"\$(ethercat slaves | grep -c PREOP)\" = $1 ]"; }

@test "README: by hand" {
	doc README.md 'insmod build/modules/master/ec_master.ko main_devices=sim0 capture=1'
	has_slaves 22
	wait_for 60 eval '[ "$(stat -c %s frames.pcap)" -gt 1000 ]'
}

@test "ring.rst: a ring is opened and closed" {
	local f=Documentation/ring.rst

	mountpoint -q /sys/kernel/debug || mount -t debugfs none /sys/kernel/debug
	doc $f "printf 'repeat 8 slave d drive\\nwire d8.1 -> master.1\\n' >/tmp/segment"
	wait_for 60 eval 'ethercat master | grep -q "Ring: closed"'
	doc $f "echo 'cut d4.1' >/sys/kernel/debug/ec_sim/sim0" >"$BATS_TEST_TMPDIR/shown"
	cat "$BATS_TEST_TMPDIR/shown"
	grep -q 'Ring: open between port 1 of slave 3 and slave 4' "$BATS_TEST_TMPDIR/shown"
	grep -q 'xxx LINK FAILURE xxx' "$BATS_TEST_TMPDIR/shown"
	grep -q 'backup device sim0b' "$BATS_TEST_TMPDIR/shown"
	doc $f "echo 'heal d4.1' >/sys/kernel/debug/ec_sim/sim0"
	wait_for 60 eval 'ethercat master | grep -q "Ring: closed"'
}

@test "simulator.rst: virtual device" {
	doc Documentation/simulator.rst 'modprobe ec_master main_devices=sim0'
	has_slaves 22
}

@test "simulator.rst: the program at an interface" {
	doc Documentation/simulator.rst 'ip link add veth0 type veth peer name veth1'
	modprobe ec_master main_devices=veth0
	modprobe ec_generic
	has_slaves 22
	kill -0 "$pid"
}

@test "examples.rst: mirror without hardware" {
	local f=Documentation/examples.rst

	doc $f 'cp -r /usr/share/doc/ethercat-doc/examples ~'
	doc $f 'modprobe ec_master main_devices=sim0' >"$BATS_TEST_TMPDIR/mirror"
	grep -E '^inputs: 0x04' "$BATS_TEST_TMPDIR/mirror"
}

@test "install.rst: a network card" {
	ip link add eth1 type veth peer name veth0
	insmod build/modules/master/ec_master.ko
	rmmod ec_master
	doc Documentation/install.rst 'ip link'
	insmod build/modules/devices/sim/ec_sim.ko segment=bench netdev=veth0
	has_slaves 22
	doc Documentation/install.rst 'ethercat master' >"$BATS_TEST_TMPDIR/master"
	grep attached "$BATS_TEST_TMPDIR/master"
	mkdir -p /etc/modprobe.d
	rmmod ec_sim ec_generic ec_master
	echo 'options ec_master main_devices=00:11:22:33:44:55' >/etc/modprobe.d/ethercat.conf
	modprobe ec_master
	rm /etc/modprobe.d/ethercat.conf
	ethercat master | grep -q 'Main: 00:11:22:33:44:55 (waiting...)'
}

# The blocks of the tutorials are run as they are written, one after the other.
@test "machine-in-an-hour.rst: saved, run, recorded, and compared when a slave was exchanged" {
	local f=Documentation/machine-in-an-hour.rst block

	block='slave c EK1100\nslave o EL2008\nslave i EL1008\nconnect o.1 -> i.1\n'
	doc $f "printf '$block' >/tmp/segment"
	has_slaves 3
	for block in 'ethercat slaves --wait' 'ethercat bus save machine.yaml' \
		'ethercat run --dry-run' "ethercat watch 'el1008.*'" \
		'(sleep 1; ethercat set --lease 1 el2008.channel_1.output 1) &' \
		'ethercat plot lamp.csv' 'ethercat top' 'ethercat why'; do
		doc $f "$block" >"$BATS_TEST_TMPDIR/hour" ||
			{ cat "$BATS_TEST_TMPDIR/hour"; return 1; }
	done
	cat "$BATS_TEST_TMPDIR/hour"
	grep -q '^no difference, 3 slave(s)' "$BATS_TEST_TMPDIR/hour"
	grep -q '^<svg' lamp.svg
	grep -q '</html>' machine.html
	# both values of the recording, and what the watch has seen of it
	[ "$(awk -F, '$6 == 1 && $7 == 1' lamp.csv | wc -l)" -gt 500 ]
	grep -q 'el1008.channel_1.input = 1$' "$BATS_TEST_TMPDIR/out"
	kill "$pid"
	wait "$pid" || true
	pid=
	doc $f 'ethercat stop' >"$BATS_TEST_TMPDIR/tomorrow"
	cat "$BATS_TEST_TMPDIR/tomorrow"
	grep -q "slave 'el1008' exchanged: expected EL1008,.* found EL3062" "$BATS_TEST_TMPDIR/tomorrow"
	doc $f 'rmmod ec_sim ec_master'
}

@test "first-ten-minutes.rst: from the scan to a broken cable" {
	local f=Documentation/first-ten-minutes.rst

	doc $f 'modprobe ec_master main_devices=sim0'
	has_slaves 22
	screen Documentation/first-ten-minutes.rst '$ ethercat slaves'
	doc $f 'ethercat graph --tree' >"$BATS_TEST_TMPDIR/look"
	cat "$BATS_TEST_TMPDIR/look"
	grep -qx '0x00000002 2' "$BATS_TEST_TMPDIR/look"
	like Documentation/first-ten-minutes.rst '$ ethercat graph --tree'
	doc $f 'cp -r /usr/share/doc/ethercat-doc/examples ~'
	doc $f '~/examples/build/dc_motion follow 4 5 5'
	has_slaves 22
	doc $f "(sleep 1; echo 'errors axis1.0 add=5' >/sys/kernel/debug/ec_sim/sim0) &" \
		>"$BATS_TEST_TMPDIR/crc"
	cat "$BATS_TEST_TMPDIR/crc"
	# as the page shows it
	tr '\n' ' ' <"$BATS_TEST_DIRNAME/../../$f" | grep -qF "$(tail -n 1 "$BATS_TEST_TMPDIR/crc")"
	doc $f 'rmmod ec_sim ec_master'
}

@test "first-drive.rst: from the identity to a motion" {
	local f=Documentation/first-drive.rst

	doc $f 'modprobe ec_master main_devices=sim0'
	has_slaves 4
	doc $f 'ethercat slaves -v -p3' >"$BATS_TEST_TMPDIR/pdos"
	grep -q 'PDO entry 0x607a:00' "$BATS_TEST_TMPDIR/pdos"
	doc $f 'ethercat upload -p3 -t uint16 0x6041 0'
	doc $f 'ethercat download -p3 -t int8 0x6060 0 8'
	[ "$(ethercat upload -p3 -t int8 0x6060 0)" = "0x08 8" ]
	has_examples
	doc $f '~/examples/build/dc_motion follow 2 3 4' >"$BATS_TEST_TMPDIR/motion"
	cat "$BATS_TEST_TMPDIR/motion"
	[ "$(awk '/^axis/ && $NF >= 90000' "$BATS_TEST_TMPDIR/motion" | wc -l)" = 2 ]
}

# those of first-ten-minutes.rst, if its test has not run
has_examples() {
	local f=Documentation/first-ten-minutes.rst

	[ -x ~/examples/build/dc_motion ] ||
		doc $f 'cp -r /usr/share/doc/ethercat-doc/examples ~'
}

# motion SECONDS: a simulated bench whose axes move
motion() {
	has_examples
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment=bench
	has_slaves 22
	~/examples/build/dc_motion follow 4 5 "$1" >"$BATS_TEST_TMPDIR/motion" 2>&1 3>&- &
	pid=$!
	wait_for 60 eval '[ "$(ethercat slaves | grep -c " OP ")" = 3 ]'
}

@test "sizing.rst and clocks.rst: wire time and clocks of a running application" {
	motion 60
	# more clock datagrams than usual in the first seconds
	wait_for 20 eval "ethercat master -v | grep -q 'Free for acyclic frames: 889.44 us'"
	like Documentation/sizing.rst '$ ethercat domains -v'
	like Documentation/sizing.rst '$ ethercat master -v'
	like Documentation/clocks.rst '$ ethercat dc -p4,5'
	ethercat domains -v | grep -q 'Datagrams: 1, 40 bytes, 3.20 us of wire time'
	ethercat master -v | grep -q '10.56 us of wire time'
}

@test "capture.rst: frames of an SDO" {
	local f=Documentation/capture.rst filter

	tshark() { command tshark "$@" 2>/dev/null; }	# warns root
	doc $f 'modprobe ec_master main_devices=sim0 capture=1'
	wait_for 20 eval '! pidof tcpdump'
	doc $f 'tshark -r /tmp/frames.pcap -Y ecat_mailbox.coe' >"$BATS_TEST_TMPDIR/coe"
	grep -q 'Idx=0x1018 Sub=1' "$BATS_TEST_TMPDIR/coe"
	screen Documentation/capture.rst \
		"$ tshark -r /tmp/frames.pcap -Y 'ecat_mailbox.coe.sdoidx == 0x1018'"
	for filter in 'ecat.ado == 0x0120' 'ecat.ado == 0x0130' 'ecat.ado == 0x0910' ecat.lad \
		ecat_mailbox.coe.abortcode; do
		grep -qF "\`\`$filter\`\`" "$BATS_TEST_DIRNAME/../../$f"
		command tshark -r /tmp/frames.pcap -Y "$filter" -c 1
	done
	rm /tmp/frames.pcap
}

@test "several-masters.rst: two simulated buses" {
	local f=Documentation/several-masters.rst

	doc $f 'modprobe ec_master main_devices=sim0,sim1'
	wait_for 60 all_slaves_are PREOP 24
	doc $f 'ethercat slaves -m1'
	screen Documentation/several-masters.rst '$ ethercat slaves -m1'
	screen Documentation/several-masters.rst '$ ethercat upload -p4 0x1018 1'
	[ -c /dev/EtherCAT1 ]
}

@test "coming-from-twincat.rst: slaves, process data and lists" {
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment=bench
	has_slaves 22
	local f=Documentation/coming-from-twincat.rst

	doc $f 'ethercat slaves' >"$BATS_TEST_TMPDIR/first"
	grep -q 'RxPDO 0x1608 "Channel 1"' "$BATS_TEST_TMPDIR/first"
	doc $f 'ethercat cstruct -p3' >"$BATS_TEST_TMPDIR/lists"
	grep -q ec_pdo_entry_info_t "$BATS_TEST_TMPDIR/lists"
	doc $f 'ethercat why' >"$BATS_TEST_TMPDIR/why"
	grep -q '^All is well' "$BATS_TEST_TMPDIR/why"
}

@test "eoe.rst: network devices of slaves" {
	local f=Documentation/eoe.rst

	modprobe bridge
	doc $f 'modprobe ec_master main_devices=sim0'
	wait_for 10 eval 'ethercat eoe | grep -q eoe0s2'
	screen Documentation/eoe.rst '$ ethercat eoe'
	doc $f 'ethercat ip -p1 ip_address 192.168.5.2/24'
	wait_for 10 eval '[ "$(cat /sys/class/net/eoe0a5/carrier)" = 1 ]'
	ip addr flush dev eoe0a5
	doc $f 'ethercat eoe bridge br0'
	wait_for 40 eval 'wget -qO- http://192.168.5.2/ | grep -q web'
	# another computer in the office
	ip netns add office
	ip link add veth0 type veth peer name eth0 netns office
	ip addr add 192.168.1.10/24 dev veth0
	ip link set veth0 up
	ip -n office addr add 192.168.1.20/24 dev eth0
	ip -n office link set eth0 up
	local where='ip netns exec office'
	run $where timeout 10 wget -qO- http://192.168.5.2/
	[ "$status" != 0 ]
	where= doc $f 'sysctl -w net.ipv4.ip_forward=1'
	doc $f 'ip route add 192.168.5.0/24 via 192.168.1.10' >"$BATS_TEST_TMPDIR/page"
	cat "$BATS_TEST_TMPDIR/page"
	grep -q '<h1>web</h1>' "$BATS_TEST_TMPDIR/page"
	ethercat ip -p1 | grep -q 192.168.5.1
	sysctl -w net.ipv4.ip_forward=0
	run $where timeout 10 wget -qO- http://192.168.5.2/
	[ "$status" != 0 ]
	ip netns del office
	ip link del br0
}

@test "debugging.rst: an application that is stopped" {
	local f=Documentation/debugging.rst

	motion 60
	doc $f 'ethercat why' >"$BATS_TEST_TMPDIR/outside"
	grep -q '^All is well' "$BATS_TEST_TMPDIR/outside"
	grep -q '^0000001c' "$BATS_TEST_TMPDIR/outside"
	# 124: of timeout
	run doc $f 'timeout -s INT 2 strace -c -f -p $(pidof dc_motion)'
	echo "$output"
	[ "$status" = 124 ]
	[[ $output == *" fadvise64"*" clock_nanosleep"* ]]
	[[ $output != *" ioctl"* ]]
	kill "$pid"
	wait "$pid" || true
	has_slaves 22
	doc $f '~/examples/build/dc_motion follow 4 5 &' >"$BATS_TEST_TMPDIR/why"
	cat "$BATS_TEST_TMPDIR/why"
	sed -n '/^Fault/,/^1 fault/p' "$BATS_TEST_TMPDIR/why" |
		"$BATS_TEST_DIRNAME/../build/commands.py" --screen $f '$ ethercat why'
	rc=0
	wait "$pid" || rc=$?
	[ $rc = 1 ]
	ethercat log | grep -q 'cycle timeout: no cyclic frame for'
	ethercat log | grep -q 'cycle(s) skipped'
	grep -q 'a drive has left operation' "$BATS_TEST_TMPDIR/out"
}

@test "debugging.rst: tracepoints" {
	mount -t tracefs tracefs /sys/kernel/tracing 2>/dev/null || true
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment=thin
	doc Documentation/debugging.rst 'cd /sys/kernel/tracing'
	wait_for 60 grep -q ' ec_frame_sent: master=0 ' "$BATS_TEST_TMPDIR/out"
	echo 0 >events/ethercat/enable
}

@test "simulator.rst: a cable that is cut and repaired" {
	local f=Documentation/simulator.rst

	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment=bench
	has_slaves 22
	echo 'cut axis1.0' >/sys/kernel/debug/ec_sim/sim0
	has_slaves 11
	doc $f "echo 'cut axis1.0' >/sys/kernel/debug/ec_sim/sim0"
	has_slaves 22
}

# sources DEVICE: different source addresses of the next 20 EtherCAT frames that come to it
sources() {
	timeout 60 tcpdump -c 20 -i "$1" -Q in -w - ether proto 0x88a4 2>/dev/null |
		tcpdump -nn -e -r - 2>/dev/null | awk '$3 == ">" { print $2 }' | sort -u
}

@test "devices.rst: constant source address" {
	ip link add eth1 type veth peer name veth0
	ip link set veth0 up
	ip link set eth1 up
	doc Documentation/devices.rst 'modprobe ec_master main_devices=eth1 frame_numbers=N'
	insmod build/modules/devices/ec_generic.ko
	run sources veth0
	echo "$output"
	[ "$output" = 02:00:00:00:00:00 ]
	insmod build/modules/devices/sim/ec_sim.ko segment=bench netdev=veth0
	has_slaves 22
	rmmod ec_sim ec_generic ec_master
	modprobe ec_master main_devices=eth1
	modprobe ec_generic
	run sources veth0
	[ "${#lines[@]}" -gt 10 ]
	[[ $output == "02:00:"* ]]
}

# what a card cannot do its driver refuses; that is no fault of the command
@test "realtime.rst: settings of a card" {
	modprobe e1000e
	local line n=0
	while IFS= read -r line; do
		n=$((n + 1))
		run eval "$line"
		echo "$ $line: $status $output"
		[[ $output != *"bad command line"* && $output != *"Usage"* ]]
		[ "$status" = 0 ] || [[ $output == *"not supported"* || $output == *"not permitted"* ||
			$output == *"nvalid argument"* || $output == *"unmodified"* ]]
	done < <("$BATS_TEST_DIRNAME/../build/commands.py" --block Documentation/realtime.rst \
		'ethtool -C eth1 rx-usecs 0')
	[ $n = 5 ]
	modprobe -r e1000e
}

@test "realtime.rst: tracing" {
	mount -t tracefs tracefs /sys/kernel/tracing 2>/dev/null || true
	sleep 30 3>&- &
	doc Documentation/realtime.rst 'cd /sys/kernel/tracing' $!
	echo 0 >events/enable
	echo >set_event_pid
}

@test "inline commands of the tool" {
	printf '%s\n' "slave c EK1100" "slave out EL2008" "slave axis drive" >/tmp/segment
	modprobe ec_master main_devices=sim0
	modprobe ec_sim segment=/tmp/segment
	has_slaves 3
	local c
	for c in 'ethercat master' 'ethercat master -v' 'ethercat domains -v' 'ethercat slaves' \
		'ethercat slaves -v' 'ethercat crc' 'ethercat cycle' 'ethercat cycle --reset' \
		'ethercat domains' 'ethercat config' 'ethercat cstruct'; do
		echo "$ $c"
		eval "$c"
	done
	# the guest's settings are not those of a real machine
	run ethercat rtcheck
	echo "$output"
	[[ ${lines[0]} == "ok "*"$(uname -r), PREEMPT_RT" ]]
	[[ $output == *"error(s), "*"not known" ]]
	ethercat upload -p2 0x1018 1
	ethercat download -p2 -t int8 0x6060 0 8
	[ "$(ethercat upload -p2 -t int8 0x6060 0)" = "0x08 8" ]
	ethercat help upload
	ethercat latch -p 2
	ethercat latch -p 2 single
	ethercat latch -p 2 continuous
	# "make doc" has these on its page of codes
	ethercat states INIT
	wait_for 60 all_slaves_are INIT 3
	ethercat states PREOP
	wait_for 60 all_slaves_are PREOP 3
	ethercat states SAFEOP
	wait_for 60 all_slaves_are SAFEOP 3
	ethercat states PREOP
	ethercat sii_read -v -p2 | grep -q '^SII Area'
	ethercat-sim --check /tmp/segment
	# there is no session
	run ethercat release
	[[ $output == *"has no session"* ]]
}
