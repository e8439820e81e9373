#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs in the guest: histograms of both kinds of cycle, idle and under load.
# usage: jitter-guest.sh BUILD SEGMENT CYCLES

set -u
build=$1 segment=$2 cycles=$3
tool=$build/tool/ethercat

insmod "$build/modules/master/ec_master.ko" main_devices=sim0 &&
insmod "$build/modules/devices/sim/ec_sim.ko" segment="$segment" || exit 1
for _ in {1..100}; do
	[ -z "$("$tool" slaves)" ] || break
	sleep 0.1
done

# much to copy, many processes that come and go, on each processor
load() {
	local i

	for ((i = 0; i < $(nproc); i++)); do
		dd if=/dev/zero of=/dev/null bs=1M 2>/dev/null &
		(while :; do /bin/true; done) &
	done
}

# measure NAME [cycle-bench options]; a late wake-up is no failure here
measure() {
	echo "= $1"
	"$build/bench/cycle-bench" --cycles "$cycles" "${@:2}" >/tmp/bench || true
	"$tool" cycle
	echo "counted ${1/, /-} $("$tool" cycle --json | gojq '.masters[0].sends')"
}

measure "application, idle"
measure "kernel, idle" --kernel wait
load
measure "application, load"
measure "kernel, load" --kernel wait
kill $(jobs -p)
wait 2>/dev/null
exit 0
