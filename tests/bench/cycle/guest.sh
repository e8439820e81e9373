#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs in the guest: a segment on the virtual device, one run of cycle-bench.
# usage: guest.sh BUILD SEGMENT [cycle-bench options]

set -u
build=$1 segment=$2
shift 2

insmod "$build/modules/master/ec_master.ko" main_devices=sim0 &&
insmod "$build/modules/devices/sim/ec_sim.ko" segment="$segment" || exit 1
"$build/bench/cycle-bench" "$@"
