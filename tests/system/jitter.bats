# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --timeout 900
# tests/bench/jitter.sh with the simulated segment: report, verdict, and nothing is left.

load helpers

setup() { report=$BATS_TEST_TMPDIR/report; }
teardown() { stop; }

jitter() {
	run tests/bench/jitter.sh --out "$report" "$@" 3>&-
	echo "$output"
}

# no module, and no process of the load
nothing_is_left() {
	[ ! -e /sys/module/ec_master ]
	[ ! -e /sys/module/ec_sim ]
	[ -z "$(pgrep -f "jitter-load|sleep 98765")" ]
}

@test "jitter.sh passes and writes its report" {
	jitter --time 1 --cpu 0 --limit 20000
	[ "$status" -eq 0 ]
	[ "$(head -n 1 "$report")" = "Verdict: passed" ]
	for part in "worst case: " "remark: 1 s are too short" "remark: simulated segment" \
		"remark: without load" "Kernel: Linux $(uname -r)" "device sim (sim), CPU 0" \
		"Send deviation" "from \[us\]" "throttling" "^lost 0"; do
		grep "$part" "$report"
	done
	nothing_is_left
}

@test "jitter.sh fails with a verdict when the limit is impossible" {
	jitter --time 1 --limit 0
	[ "$status" -eq 1 ]
	[ "$(head -n 1 "$report")" = "Verdict: failed" ]
	grep "failed: the worst case exceeds the limit" "$report"
	nothing_is_left
}

@test "jitter.sh measures a cycle of the kernel, in its thread and in the interrupt" {
	for by in thread interrupt; do
		jitter --time 1 --cpu 0 --limit 20000 --by $by
		[ "$status" -eq 0 ]
		grep "CPU 0, by $by" "$report"
		if [ $by = thread ]; then
			grep "^interrupted 0" "$report"
		else
			grep "^interrupted 1" "$report"
		fi
		nothing_is_left
	done
}

@test "jitter.sh ends its load" {
	jitter --time 1 --limit 20000 --load command "touch $BATS_TEST_TMPDIR/began; sleep 98765; :"
	[ "$status" -eq 0 ]
	[ -e "$BATS_TEST_TMPDIR/began" ]
	grep "load command 'touch" "$report"
	nothing_is_left
}

@test "jitter.sh runs each load" {
	local l

	for l in cpu memory io net; do
		jitter --time 1 --limit 1000000 --load $l
		grep "load $l" "$report"
		grep "^worst case" "$report" || grep "  worst case" "$report"
		nothing_is_left
	done
}

@test "jitter.sh refuses wrong arguments and loads nothing" {
	while IFS='|' read -r message arguments; do
		# shellcheck disable=SC2086
		jitter $arguments
		[ "$status" -eq 2 ]
		[[ $output == *"$message"* ]]
		[ ! -e "$report" ]
	done <<-END
		a number from 1|--time 0
		a number from 50|--period x
		a number from 0|--limit -1
		none, cpu, memory|--load heavy
		needs a command|--load command
		no interface nix0|--device nix0
		application, thread|--by task
		no PCI device|--device 0000:ff:1f.7
		no interface has|--device 02:ff:ff:ff:ff:ff
		no such CPU|--cpu 4000
		needs an argument|--time
		unknown option|--quick
		are possible|--time 999999 --period 50
	END
	nothing_is_left
}

@test "jitter.sh refuses to run beside a loaded master" {
	load_master
	jitter --time 1
	[ "$status" -eq 1 ]
	[[ $output == *"ec_master is loaded"* ]]
	[ -e /sys/module/ec_master ]
}

@test "jitter.sh gives a network card back to its driver" {
	stop
	modprobe e1000e
	pci0=$(pci eth0)
	ip link set eth1 up
	# above the programs whose frames it answers: there is one CPU
	chrt -f 95 "$EC_BUILD/tool/ethercat-sim" --segment tests/segments/drive10.seg eth1 \
		>"$BATS_TEST_TMPDIR/sim" 2>&1 3>&- &
	sim=$!
	wait_for 60 grep -q 'slave(s), at ' "$BATS_TEST_TMPDIR/sim"
	for device in eth0 52:54:00:EC:00:00 "$pci0"; do
		jitter --time 1 --limit 1000000 --device "$device" --by interrupt
		[[ $(head -n 1 "$report") == "Verdict: "* ]]
		# a generic device needs the thread
		if [ "$device" = "$pci0" ]; then
			grep "^interrupted 1" "$report"
		else
			[ "$status" -eq 1 ]
			grep "failed: the cycle has run in its thread" "$report"
		fi
		grep "device $device" "$report"
		nothing_is_left
		wait_for 60 test -e /sys/class/net/eth0
		[ "$(basename "$(readlink "/sys/bus/pci/devices/$pci0/driver")")" = e1000e ]
	done
	kill $sim
}
