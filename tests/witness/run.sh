#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs the tests of the model once for each of its deliberate errors
# (devices/sim/bug.h). An error is caught when a test fails; which one is
# shown. An error that no test notices fails this check.
#
# usage: run.sh [BUG...]		default: all of them

cd "$(dirname "$0")/../.." || exit 1
# compares the model with itself, so it judges nothing
not_a_witness='sim_segment_shortcuts_do_not_change_results'

make -s -C tests/unit -j2 B="$PWD/build/witness" SAN= witness >/dev/null || exit 1
prog=$PWD/build/witness/witness
export prog not_a_witness

# one BUG: prints "ok or FAIL <tab> BUG <tab> number of tests that notice: two"
one() {
	local bug=$1 log rc tests n

	log=$(EC_SIM_BUG=$bug timeout 60 "$prog" 'sim_*' 2>&1)
	rc=$?
	tests=$(grep -E '^    not ok ' <<<"$log" | awk '{ print $4 }' |
		grep -vx "$not_a_witness")
	n=$(grep -c . <<<"$tests")
	if [ "$bug" = none ]; then
		[ $rc = 0 ] && printf 'ok\t%s\t%s\n' none "right model: no test fails" ||
			printf 'FAIL\t%s\t%s\n' none "right model: $(xargs <<<"$tests") (exit $rc)"
	elif [ $rc -gt 1 ]; then	# 124 hangs, others: the sanitizers
		printf 'FAIL\t%s\texit %d: %s\n' "$bug" $rc \
			"$(grep -m 1 -E 'ERROR|runtime error' <<<"$log" || echo 'no end')"
	elif [ "$n" = 0 ]; then
		printf 'FAIL\t%s\tno test notices\n' "$bug"
	else
		printf 'ok\t%s\t%d: %s\n' "$bug" "$n" "$(head -n 2 <<<"$tests" | xargs)"
	fi
}
export -f one

all=$(EC_SIM_BUG=list "$prog") || exit 1
out=$(printf '%s\n' ${*:-$all} | nice xargs -P 2 -I{} bash -c 'one {}')
printf '%s\n' "$out" | sort -t$'\t' -k2,2 | awk -F'\t' '{ printf "%-4s  %-15s %s\n", $1, $2, $3 }'
ok=$(grep -c '^ok' <<<"$out")
bad=$(grep -vc '^ok' <<<"$out")
echo "$ok passed, $bad failed"
[ "$bad" = 0 ]
