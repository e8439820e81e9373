#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Does each test that rows.txt names fail without the function? The sources are changed as the rows
# say, the UML kernel is built with all changes, and each test is run with that of its row only.
# With none of them, the first test passes. The last line is "N passed, N failed".
#
# usage: try.sh [N|ROW...]	default: all rows; N below 100: so many rows, others for each commit

set -u
cd "$(dirname "$0")/../.." || exit 1
export LC_ALL=C
rows=tests/class-a/rows.py
over=$PWD/build/class-a/over
from=$(tests/uml/build.sh --objects) || exit 1
out=$PWD/build/class-a/${from##*/}
passed=0 failed=0

tests/class-a/rows.py check | grep '^not ok' && { echo "0 passed, 1 failed"; exit 1; }
case ${1:-0} in
?|??) seed=$(git rev-parse HEAD 2>/dev/null || date +%F)
	numbers=$($rows chosen "${1:-0}" "$seed") ;;
*) numbers="$*" ;;
esac
read -ra numbers <<<"$numbers"

# build: from the objects of the level "uml", so only what is changed is compiled
build() {
	local base mine

	mkdir -p "$over" "$out"
	$rows over "$over" "${numbers[@]}" || return
	base=$(tests/uml/build.sh --path) || return
	mine=$(EC_UML_OVER=$over tests/uml/build.sh --path) || return
	if [ ! -d "${mine%/*}" ] && [ -e "$base" ]; then
		mkdir -p "${mine%/*}" && cp -a "${base%/*}/ethercat" "${mine%/*}" || return
	fi
	[ -e "$out/.ec-configured" ] || seed_out || return
	EC_UML_OVER=$over EC_UML_OUT=$out tests/uml/build.sh
}

# the kernel without our sources, unless another build is changing it
seed_out() {
	[ -e "$from/.ec-configured" ] || return 0
	flock "$from/.lock" cp -a "$from/." "$out" && rm -f "$out/.lock"
}

# try ROW CASE: it fails without the function
try() {
	local log

	log=$(EC_UML_OVER=$over EC_UML_OUT=$out EC_UML_TIMEOUT=120 EC_UML_ARGS="ec_lacks=$1" \
		tests/uml/run.sh --no-build "$2" 2>&1)
	if grep -qx "FAIL $2" <<<"$log"; then
		echo "ok - row $1: $2 fails without the function"
	else
		echo "not ok - row $1: $2 does not fail without the function"
		tail -n 12 <<<"$log" | sed 's/^/# /'
	fi
}

log=$(build 2>&1) || { tail -n 30 <<<"$log"; echo "not ok - the changed sources do not build"
	echo "0 passed, 1 failed"; exit 1; }
first=$($rows cases "${numbers[0]}" | head -n 1)
if [[ $(try 0 "$first") == "not ok - row 0: "* ]]; then
	echo "ok - $first passes with the function, which is noticed"
	passed=1
else
	echo "not ok - $first fails with the function"
	failed=1
fi
for n in "${numbers[@]}"; do
	for c in $($rows cases "$n"); do
		result=$(try "$n" "$c")
		echo "$result"
		[[ $result == ok* ]] && passed=$((passed + 1)) || failed=$((failed + 1))
	done
done
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
