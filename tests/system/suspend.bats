# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 900
# The computer suspends as far as a guest with folders of the host can (suspend/ec_suspend.c):
# notifiers, freezer, and the network card of the master in D3. tests/reboot has a whole one.

load helpers

setup_file() {
	modprobe e1000e
	pci0=$(pci eth0)
	export pci0
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=52:54:00:ec:00:00
	insmod "$EC_BUILD/modules/devices/ec_generic.ko"
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment=bench netdev=eth1
	wait_for 120 all_slaves_are PREOP 22
	echo freezer >/sys/power/pm_test
	echo 1 >/sys/module/suspend/parameters/pm_test_delay
}

teardown_file() { stop; }
teardown() {
	rmmod ec_suspend 2>/dev/null || true
	[ -z "${app:-}" ] || kill -9 "$app" 2>/dev/null || true
}

demo() { LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" "$@"; }
suspend() { echo freeze >/sys/power/state; }
logged() { dmesg | grep -qF "$1"; }

@test "a suspend is refused while an application has the master, and names it" {
	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000000 \
		>"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	app=$!
	wait_for 120 all_slaves_are OP 22
	run suspend
	[ "$status" != 0 ]
	[[ $output == *"Device or resource busy"* ]]
	logged "EtherCAT 0: suspend refused: the master is in use by process $app (demo); stop it first"
	all_slaves_are OP 22
	kill -TERM $app
	wait $app || true
	app=
	wait_for 120 all_slaves_are PREOP 22
}

@test "a suspend is refused while a bus runs without an application, and a recording has no gap" {
	local file=$BATS_TEST_TMPDIR/a.csv

	ethercat run >"$BATS_TEST_TMPDIR/run"
	cat "$BATS_TEST_TMPDIR/run"
	n=$(ethercat slaves | grep -cw OP)
	"$EC_BUILD/tool/ethercat" record 'el1008.*' -o "$file" --count 2000 \
		2>"$BATS_TEST_TMPDIR/err" 3>&- &
	app=$!
	wait_for 60 test -s "$file"
	run suspend
	[ "$status" != 0 ]
	[[ $output == *"Device or resource busy"* ]]
	logged "EtherCAT 0: suspend refused: the bus runs without an application ('ethercat run'); end that with 'ethercat stop'"
	wait $app
	app=
	grep -q '2000 record(s) of .*, 0 lost' "$BATS_TEST_TMPDIR/err"
	grep -v '^[#t]' "$file" | awk -F, 'n++ && $3 != cycle + 1 { print; bad = 1 } { cycle = $3 }
		END { exit bad || n != 2000 }'
	all_slaves_are OP "$n"
	# what it says helps
	ethercat stop
	suspend
	wait_for 120 all_slaves_are PREOP 22
}

scan="EtherCAT 0: scan complete: 22 slave(s)"

count() { cat "/sys/class/net/$1/statistics/$2_packets"; }

# eth0 sends, eth1 answers, and eth0 has received none of it
is_deaf() {
	local sent answered received

	sent=$(count eth0 tx) answered=$(count eth1 tx) received=$(count eth0 rx)
	sleep 3
	[ "$(count eth0 tx)" -gt "$sent" ] && [ "$(count eth1 tx)" -gt "$answered" ] &&
		[ "$(count eth0 rx)" = "$received" ]
}

# idle_suspend: the bus is scanned afterwards, and works
idle_suspend() {
	dmesg -C
	insmod "$EC_BUILD/mini/suspend/ec_suspend.ko" function="$pci0" whole=1
	suspend
	rmmod ec_suspend
	dmesg
	dmesg | grep -oE 'computer .*|suspended .*|resumed \(.*' >"$BATS_TEST_TMPDIR/steps"
	diff "$BATS_TEST_TMPDIR/steps" - <<-'END'
	computer sleeps: no frame until it resumes
	suspended (0), in D3
	resumed (0), in D0
	computer resumed: scanning the bus
	END
	# After D3 QEMU's e1000e with the kernel's driver may receive nothing until it starts again:
	# eth1 answers each frame, and the card itself does not count the answers.
	if [ -e /sys/class/net/eth0 ] && ! wait_for 30 logged "$scan" && is_deaf; then
		echo "# eth0 receives nothing after the resume; its driver starts again" >&3
		ip link set eth0 down
		ip link set eth0 up
	fi
	wait_for 120 logged "$scan"
	wait_for 120 all_slaves_are PREOP 22
	run demo --cycles 500 --wired
	echo "$output"
	[ "$status" = 0 ]
}

@test "an idle master at a generic device sleeps, and scans after the resume" {
	idle_suspend
}

@test "an idle master at a native device sleeps, and scans after the resume" {
	insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	ethercat device bind --force eth0
	wait_for 120 all_slaves_are PREOP 22
	idle_suspend
}

@test "a native device that was shut down does not start again" {
	insmod "$EC_BUILD/mini/suspend/ec_suspend.ko" function="$pci0" shut=1
	[ "$(says Link)" = DOWN ]
	# what gives the device back to the master, and starts it
	refused "no driver offers sim0.* waits for" device use sim0
	rmmod ec_suspend
	dmesg | grep -q "cannot start device $pci0 (-ESHUTDOWN)"
}
