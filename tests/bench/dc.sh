#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Distributed clocks: an hour of a 1 kHz cycle with 100 slaves in a random tree,
# judged by the true difference of the modelled clocks. The limits are gates of
# the test itself (tests/bus/dc_figures_kunit.c), which bus.sh runs for seconds.
# usage: dc.sh [SECONDS [TREES]]	default: 3600 1

set -u
cd "$(dirname "$0")/../.." || exit 1
seconds=${1:-3600} trees=${2:-1}
[[ $seconds =~ ^[1-9][0-9]*$ && $trees =~ ^[1-9][0-9]*$ ]] ||
	{ echo "usage: dc.sh [SECONDS [TREES]]" >&2; exit 2; }
log=$(mktemp)
out=$(mktemp)
trap 'rm -f "$log" "$out"' EXIT

t0=$SECONDS
export EC_UML_TIMEOUT=${EC_UML_TIMEOUT:-3600}
EC_UML_ARGS="dc_figures_kunit.seconds=$seconds dc_figures_kunit.trees=$trees ${EC_UML_ARGS-}" \
	tests/uml/run.sh --log "$log" 'bus_dc_figures*' >"$out" 2>&1
rc=$?
[ $rc = 0 ] || cat "$out"
sed -n -e 's/^.*# figure: /# /p' -e 's/^.*# row: /# row: /p' "$log"
echo "# $((SECONDS - t0)) s of real time"
tail -n 1 "$out"
exit $rc
