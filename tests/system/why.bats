# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --timeout 900
# 'ethercat why' names cause and place of faults that the simulator injects.

load helpers

setup_file() {
	python3 "$BATS_TEST_DIRNAME/why.py" --segment >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 12
}
teardown_file() { stop; }
teardown() {
	[ -z "${app:-}" ] || kill "$app" 2>/dev/null || true
	echo "heal s4.0" >/sys/kernel/debug/ec_sim/sim0
}

@test "why names the cable that is cut, and the slaves behind it" {
	"$EC_BUILD/apps/cyclic" 600 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	app=$!
	wait_for 60 grep -q ': 12 of 12 in OP' "$BATS_TEST_TMPDIR/out"
	# any user may run it, without reading a register
	chmod 644 /dev/EtherCAT0
	run setpriv --reuid nobody --clear-groups "$EC_BUILD/tool/ethercat" why
	echo "$output"
	[ "$status" = 0 ]
	[[ $output == *"All is well"*"Not checked: error counters"* ]]
	echo "cut s4.0" >/sys/kernel/debug/ec_sim/sim0
	wait_for 10 cut_is_found
	run ethercat why
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == "Fault: behind port 1 of slave 3 (drive): "*", the first: slave 4 (EL1008); link down"* ]]
	[[ $output == *"Affected: 0:4, 0:5, 0:6, 0:7, 0:8, 0:9"$'\n'* ]]
	# skipped cycles of a busy guest are a warning
	[[ $output == *$'\n'"1 fault"*". Checked: "* ]]
	[[ $(ethercat why 4) == *"Place: slave 3 (drive), port 1"* ]]
	echo "heal s4.0" >/sys/kernel/debug/ec_sim/sim0
	kill $app
	wait $app || true
	app=
	wait_for 60 all_slaves_are PREOP 12
	ethercat crc reset
}
cut_is_found() { ethercat why | grep -q '0:8, 0:9$'; }

@test "why and log name cause and place of 60 faults and are silent without one" {
	cases python3 "$BATS_TEST_DIRNAME/why.py" "$EC_BUILD/tool/ethercat" \
		"$EC_BUILD/lib/libethercat.so" /sys/kernel/debug/ec_sim/sim0 "${EC_SEED:-7}" \
		"$BATS_TEST_TMPDIR" insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" \
		segment="$BATS_FILE_TMPDIR/segment"
}
