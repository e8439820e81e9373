#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Sets of tests/system on kernels and architectures besides the one that runs all of it.
# The last line is "N passed, N failed".
#
# usage: guests.sh [LINE...]	lines of the table, 1 is the first

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
passed=0 failed=0
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

# kernel, programs (- those of the kernel's architecture), files of tests/system
table="\
6.12-rt - thin kcycle api
6.12 - thin kcycle
6.1-rt i386 thin api
6.1-i386 - thin op
6.1-arm64 - op
6.1-s390x - op"

run() {	# run KERNEL PROGRAMS FILE...
	local kernel=$1 programs=${2#-} f files=()

	shift 2
	for f; do files+=("tests/system/$f.bats"); done
	EC_KERNEL=$kernel EC_PROGRAMS=$programs tests/system/run.sh "${files[@]}"
}

# All lines at a time, so that no CPU waits for the last guest of a line; they share the
# places that guests have.
places "$logs/places" 1024
n=0
while read -ra line; do
	n=$((n + 1))
	[ $# = 0 ] || [[ " $* " == *" $n "* ]] || continue
	{
		run "${line[@]}" >"$logs/$n" 2>&1 </dev/null
		echo $? >"$logs/$n.end"
	} &
done <<<"$table"
wait
n=0
while read -ra line; do
	n=$((n + 1))
	[ -f "$logs/$n.end" ] || continue
	echo "# ${line[0]}, programs: ${line[1]/#-/of the kernel\'s architecture}"
	cat "$logs/$n"
	read -r p f < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$logs/$n" | tail -n 1)
	# one that did not come as far as that
	[ "$(cat "$logs/$n.end")" = 0 ] || [ "${f:-0}" != 0 ] || f=1
	passed=$((passed + ${p:-0})) failed=$((failed + ${f:-0}))
done <<<"$table"
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
