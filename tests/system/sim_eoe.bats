# SPDX-License-Identifier: GPL-2.0-only
# Ethernet of simulated slaves, with the kernel's own IP as the other station. A small master
# (eoe_station.py) carries the frames between the slave and a tap.

load helpers

setup_file() {
	modprobe veth
	modprobe tun
}

setup() {
	SEG=$BATS_TEST_TMPDIR/seg
	SOCK=$BATS_TEST_TMPDIR/sock
	ip link add veth0 type veth peer name veth1
	ip link set veth0 up
	ip link set veth1 up
}

teardown() {
	for p in ${SIM:-} ${STATION:-} ${SERVER:-}; do kill "$p" 2>/dev/null || true; done
	ip netns del outside 2>/dev/null || true
	ip link del veth0
}

# program OPTION...: ethercat-sim at veth1
program() {
	"$EC_BUILD/tool/ethercat-sim" -s "$SEG" --control "$SOCK" "$@" veth1 \
		>"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	SIM=$!
	wait_for 60 grep -q 'slave(s), at ' "$BATS_TEST_TMPDIR/sim"
}

# station SIZE [IP]: the tap eoe0 with 192.168.7.1, mailboxes of SIZE bytes
station() {
	python3 "$BATS_TEST_DIRNAME/eoe_station.py" veth0 eoe0 "$@" \
		>"$BATS_TEST_TMPDIR/station" 2>&1 3>&- &
	STATION=$!
	wait_for 60 grep -q up "$BATS_TEST_TMPDIR/station"
	ip addr add 192.168.7.1/24 dev eoe0
	ip link set eoe0 up
}

talk() { timeout 120 python3 "$BATS_TEST_DIRNAME/eoe_talk.py" "$@"; }

@test "the kernel reads the page of a simulated slave and gets its echo, through EoE" {
	echo 'slave web drive eoe=host mbox=256' >"$SEG"
	program
	station 256 192.168.7.2
	run talk page 192.168.7.2
	echo "$output"
	[[ $output == 'HTTP/1.0 200 OK'*'<h1>web</h1>'*'(drive), state PREOP.'*'</html>' ]]
	[ "$(talk echo 192.168.7.2 60000)" = '60000 bytes came back' ]
}

@test "a simulated slave repeats lost data" {
	echo 'slave web drive eoe=host mbox=256' >"$SEG"
	program
	station 256 192.168.7.2
	"$EC_BUILD/tool/ethercat-sim" --tell "$SOCK" eoe web lost every=9
	[ "$(talk echo 192.168.7.2 20000)" = '20000 bytes came back' ]
}

# outside NAME: this interface is that of another computer with 192.168.7.2 and fd07::2
outside() {
	ip netns add outside
	ip link set "$1" netns outside
	ip -n outside addr add 192.168.7.2/24 dev "$1"
	ip -n outside addr add fd07::2/64 dev "$1" nodad
	ip -n outside link set "$1" up
	ip netns exec outside python3 "$BATS_TEST_DIRNAME/eoe_talk.py" serve 3>&- &
	SERVER=$!
}

# a veth pair leaves checksums and segments of TCP to a card that it has not
@test "a simulated switch ends in one end of a veth pair, with the offloads of the other end" {
	ip link add port0 type veth peer name port1
	ip link set port0 up
	echo 'slave sw EL6614 eoe=switch' >"$SEG"
	program --port sw=port0
	outside port1
	[[ $(ip netns exec outside ethtool -k port1) == *"tcp-segmentation-offload: on"* ]]
	station 1024
	ip addr add fd07::1/64 dev eoe0 nodad
	[ "$(talk echo 192.168.7.2 200000)" = '200000 bytes came back' ]
	[ "$(talk echo fd07::2 200000)" = '200000 bytes came back' ]
	ip netns exec outside ethtool -K port1 tx off tso off gso off
	[ "$(talk echo 192.168.7.2 60000)" = '60000 bytes came back' ]
	# a tag that the kernel takes out of a frame passes
	modprobe 8021q
	ip link add link eoe0 name eoe0.5 type vlan id 5
	ip addr add 192.168.8.1/24 dev eoe0.5
	ip link set eoe0.5 mtu 1496 up
	ip netns exec outside ethtool -K port1 tx on tso on gso on
	ip -n outside link add link port1 name port1.5 type vlan id 5
	ip -n outside addr add 192.168.8.2/24 dev port1.5
	ip -n outside link set port1.5 mtu 1496 up
	[ "$(talk echo 192.168.8.2 60000)" = '60000 bytes came back' ]
}

@test "a simulated switch carries frames to a computer behind its Ethernet port" {
	echo 'slave sw EL6614 eoe=switch' >"$SEG"
	run "$EC_BUILD/tool/ethercat-sim" -s "$SEG" --port hub=port0 veth1
	[ "$status" = 1 ]
	[[ $output == *'no slave of this name with eoe=switch'* ]]
	program --port sw=port0
	outside port0
	station 1024
	[ "$(talk echo 192.168.7.2 60000)" = '60000 bytes came back' ]
}
