# SPDX-License-Identifier: GPL-2.0-only
# vm: --smp 2 --nics --monitor --timeout 7200
# EC_CYCLES cycles of the native device in real time on two CPUs, both
# with other work, while the cable is pulled again and again. EC_SEED: of the times.

load ../helpers
load echo

setup_file() { start_echo; }
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill "$app" 2>/dev/null || true
	[ -z "${load:-}" ] || kill $load 2>/dev/null || true
}

monitor() {
	local port

	port=$(grep -lx monitor /sys/class/virtio-ports/*/name)
	echo "$*" >"/dev/$(basename "${port%/name}")"
}

link_is() { [ "$(says Link)" = "$1" ]; }

# work for both CPUs: computing, files, readers of the device
begin_load() {
	local i

	load=
	for i in 0 1; do
		taskset -c $i sh -c 'while :; do :; done' 3>&- &
		load+=" $!"
	done
	sh -c 'while :; do dd if=/dev/zero of=/tmp/load bs=64k count=256; done' 3>&- 2>/dev/null &
	load+=" $!"
	while :; do ethercat slaves; ethercat master; done >/dev/null 2>&1 3>&- &
	load+=" $!"
}

# counters of the device, in one look
look() {
	ethercat master --json | gojq -r '.masters[0].devices[0] |
		"\(.tx_frames) \(.rx_frames) \(.lost_frames) \(.tx_errors)"'
}

# where frames were lost: not by the master if the card of the segment has dropped them
frames_of_segment() {
	grep -H . /sys/class/net/eth1/statistics/rx_{packets,dropped,missed_errors,fifo_errors}
	head -n 20 /sys/kernel/debug/ec_sim/eth1
	ethercat master
}

# back COMPLETE: more cycles are complete than these
back() { [ "$(value complete)" -gt "$1" ]; }

# pause FROM TO: so many ms, by chance
pause() { sleep "$(awk -v ms=$(($1 + RANDOM % ($2 - $1))) 'BEGIN { print ms / 1000 }')"; }

@test "flaps lose frames in flight only, all values are right, the slave is back in OP each time" {
	local cycles=${EC_CYCLES:-1000000} flaps=0 most=0 quiet=0 tx rx lost errors tx2 lost2 n

	RANDOM=${EC_SEED:-1}
	begin_load
	echo_app "$cycles" 1000 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -qs operational "$BATS_TEST_TMPDIR/out"
	sleep 1
	while kill -0 $app 2>/dev/null && [ "$(value cycles)" -lt $((cycles - 20000)) ]; do
		# nothing is lost while the cable is in
		read -r tx rx lost errors < <(look)
		n=$(value incomplete)
		pause 1000 8000
		read -r tx2 rx lost2 errors < <(look)
		echo "quiet: $((tx2 - tx)) frames, $((lost2 - lost)) lost," \
			"$(($(value incomplete) - n)) incomplete"
		[ "$lost2" = "$lost" ] || { frames_of_segment; false; }
		quiet=$((quiet + tx2 - tx))
		# those that leave until the master sees that the link is down, and one before
		read -r tx rx lost errors < <(look)
		monitor set_link nic0 off
		wait_for 30 link_is DOWN
		read -r tx2 rx lost2 errors < <(look)
		pause 50 2000
		monitor set_link nic0 on
		wait_for 60 link_is UP
		n=$(value complete)
		wait_for 60 all_slaves_are OP 1
		wait_for 60 back $((n + 200))
		read -r _ rx lost2 errors < <(look)
		echo "flap: $((tx2 - tx)) frames sent into it, $((lost2 - lost)) lost"
		[ $((lost2 - lost)) -le $((tx2 - tx + 1)) ]
		[ $((lost2 - lost)) -le $most ] || most=$((lost2 - lost))
		flaps=$((flaps + 1))
	done
	wait $app
	app=
	echo "# $flaps flaps with at most $most frames lost; $quiet frames between them, none lost;" \
		"$(tail -n 1 "$BATS_TEST_TMPDIR/out")" >&3
	[ $flaps -gt 0 ]
	[ "$(value wrong)" = 0 ]
}
