#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# All benchmarks: "ok" lines are gates, lines with # are figures.
# usage: run.sh [--gates] [NAME...]      default: every NAME.sh of this folder
#   --gates   what has a limit only

set -u
cd "$(dirname "$0")" || exit 1
gates=()
[ "${1:-}" != --gates ] || { gates=(--gates); shift; }
passed=0 failed=0
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT

for f in ${*:-*.sh}; do
	f=${f%.sh}
	# jitter measures the machine itself
	[[ " run jitter " != *" $f "* ]] || continue
	echo "== $f"
	out=$(mktemp)
	"./$f.sh" ${gates[@]+"${gates[@]}"} 2>&1 | tee "$out"
	rc=${PIPESTATUS[0]}
	sed -n 's/^# row: //p' "$out" >>"$rows"
	last=$(tail -n 1 "$out")
	if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
		passed=$((passed + BASH_REMATCH[1])) failed=$((failed + BASH_REMATCH[2]))
	else
		# with what it said last, as a report shows what follows "not ok" only
		echo "not ok $f ended with $rc"
		tail -n 10 "$out" | sed 's/^/    /'
		failed=$((failed + 1))
	fi
	rm -f "$out"
done
echo "== figures and their limits"
awk '{
	verdict = $1 <= $2 ? "reached" : "MISSED"; value = $1; limit = $2
	sub(/^[^ ]+ [^ ]+ /, "")
	printf "%-68s %10s  at most %8s  %s\n", $0, value, limit, verdict
}' "$rows"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
