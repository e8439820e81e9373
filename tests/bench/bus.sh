#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Figures in bus time, from the bus tests in UML virtual time: scan,
# activation, SDO, detection, and an hour of cycles at 1 kHz. The limits are
# gates of the tests themselves (tests/bus/figures_kunit.c, soak_kunit.c).
# usage: bus.sh [CYCLES]		default: 3600000

set -u
cd "$(dirname "$0")/../.." || exit 1
cycles=${1:-3600000}
[[ $cycles =~ ^[1-9][0-9]*$ ]] || { echo "usage: bus.sh [CYCLES]" >&2; exit 2; }
log=$(mktemp)
out=$(mktemp)
trap 'rm -f "$log" "$out"' EXIT

t0=$SECONDS
export EC_UML_TIMEOUT=${EC_UML_TIMEOUT:-3600}
EC_UML_ARGS="soak_kunit.cycles=$cycles ${EC_UML_ARGS-}" \
	tests/uml/run.sh --log "$log" 'bus_*' >"$out" 2>&1
rc=$?
[ $rc = 0 ] || cat "$out"
sed -n -e 's/^.*# figure: /# /p' -e 's/^.*# row: /# row: /p' "$log"
echo "# all bus tests in $((SECONDS - t0)) s of real time"
tail -n 1 "$out"
exit $rc
