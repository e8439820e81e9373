#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The tests under detectors, one file at a time: tests/system on 6.1-kasan (memory, locks, DMA)
# and on 6.1-kcsan (data races), the KUnit suites in a UML kernel with KASAN, lockdep and kmemleak.
# Each result is a row of Documentation/detectors.rst with its date and tree. A file that has
# passed and has not changed since, nor what it tests, does not run again: a run that was ended
# continues with the next file.
#
# usage: check-debug.sh [--again] [NAME...]
#   NAME: a file of tests/system (thin), of tests/bus or tests/unit (oom_kunit), one of these on
#	one kernel only (kasan:thin, kcsan:thin, uml:oom_kunit), or all of a kernel (kasan:)
#   --again: also those that have a result of this tree
#   --list: what would run
# EC_PAGE: page of the results, Documentation/detectors.rst if it is not set
# EC_PRODUCT: what all files test
#
# Last line: "N passed, N failed".

set -u
export LC_ALL=C
cd "$(dirname "$0")/.." || exit 1
page=${EC_PAGE:-Documentation/detectors.rst}
product=${EC_PRODUCT:-master devices lib include Kbuild}
again= list=
# the clone may be another user's
git() { command git -c safe.directory='*' "$@"; }
while [[ ${1:-} == -* ]]; do
	case $1 in
	--again) again=1 ;;
	--list) list=1 ;;
	*) sed -n '/^# usage/,/^# EC_PAGE/s/^# //p' "$0" >&2; exit 2 ;;
	esac
	shift
done

# items: each file with the kernel that it runs on
items() {
	local f

	for f in tests/system/*.bats; do
		f=${f##*/}
		printf 'kasan:%s\nkcsan:%s\n' "${f%.bats}" "${f%.bats}"
	done
	for f in tests/bus/*_kunit.c tests/unit/*_kunit.c; do
		# programs of userspace are not in that kernel
		grep -qx "$f" tests/uml/skip.list && continue
		f=${f##*/}
		echo "uml:${f%.c}"
	done
}

unknown() {
	echo "check-debug: no test '$1': a file of tests/system, tests/bus or tests/unit," \
		"with or without kasan:, kcsan: or uml: before it" >&2
}

# chosen NAME...: the items that these names mean
chosen() {
	local n all

	all=$(items)
	[ $# -gt 0 ] || { echo "$all"; return; }
	for n; do
		n=${n%.bats}
		case $n in
		*:) grep "^$n" <<<"$all" ;;
		*:*) grep -x "$n" <<<"$all" ;;
		*) grep ":$n\$" <<<"$all" ;;
		esac || { unknown "$n"; return 2; }
	done
}

# file ITEM: the test's own file
file() {
	case $1 in
	uml:*) ls tests/bus/"${1#*:}.c" tests/unit/"${1#*:}.c" 2>/dev/null ;;
	*) echo "tests/system/${1#*:}.bats" ;;
	esac
}

# row ITEM: its row of the page, in words
row() { awk -v k="${1%%:*}" -v n="${1#*:}" '$1 == k && $2 == n' "$page"; }

# is_done ITEM: its result is one of this tree; a result with a "+" is of no tree that has a name
is_done() {
	local tree

	tree=$(row "$1" | awk '$6 == 0 { print $4 }')
	[ -n "$tree" ] && [[ $tree != *+ ]] || return 1
	# shellcheck disable=SC2046,SC2086
	git diff --quiet "$tree" -- $product $(file "$1") 2>/dev/null
}

# tree: the commit, with a "+" where files differ from it
tree() {
	git rev-parse --short=7 HEAD | tr -d '\n'
	git diff --quiet HEAD -- . ":!$page" && echo || echo +
}

# note ITEM TREE PASSED FAILED SECONDS: the rows stay sorted
note() {
	local new rule='======= ======================= ========== ======== ====== ====== ======='
	local form='%-7s %-23s %-10s %-8s %6s %6s %7s\n' k=${1%%:*} n=${1#*:}

	new=$(mktemp)
	{
		sed '/^======= /,$d' "$page"
		echo "$rule"
		# shellcheck disable=SC2059
		printf "$form" kernel file date tree passed failed seconds
		echo "$rule"
		{
			awk -v k="$k" -v n="$n" '/^======= / { t++; next }
				t == 2 && NF == 7 && !($1 == k && $2 == n)' "$page"
			# shellcheck disable=SC2059
			printf "$form" "$k" "$n" "$(date +%F)" "${@:2}"
		} | sort -k 1,1 -k 2,2
		echo "$rule"
	} >"$new"
	cat "$new" >"$page"
	rm "$new"
}

# suites FILE: the names of its KUnit suites as one pattern each
suites() { sed -n 's/^\t\.name = "\(.*\)",$/\1/p' "$1"; }

# run ITEM
run() {
	local s rc=0

	case $1 in
	uml:*)
		for s in $(suites "$(file "$1")"); do
			EC_UML_TIMEOUT=${EC_UML_TIMEOUT:-3000} tests/uml/run.sh --debug "$s" || rc=1
		done
		return $rc ;;
	*)	# the detectors are tried with the first file on each kernel
		s=${tried[${1%%:*}]-}
		tried[${1%%:*}]=no
		EC_PLANTED=$s EC_KERNEL=6.1-${1%%:*} tests/system/run.sh "$(file "$1")" ;;
	esac
}

wanted=$(chosen "$@") || exit 2
todo=()
for i in $wanted; do
	[ -z "$again" ] && is_done "$i" || todo+=("$i")
done
if [ -n "$list" ]; then
	[ ${#todo[@]} = 0 ] || printf '%s\n' "${todo[@]}"
	exit 0
fi

tests/install-deps.sh build vm capture uml json >&2 || exit 1
export PATH=/usr/lib/ccache:$PATH
log=$(mktemp)
trap 'rm -f "$log"' EXIT
declare -A tried
passed=0 failed=0
for i in ${todo[@]+"${todo[@]}"}; do
	began=$SECONDS at=$(tree)
	run "$i" >"$log" 2>&1
	rc=$?
	grep -E -A 12 '^([[:space:]#]*not ok|FAIL )' "$log"
	read -r p f < <(awk '/^[0-9]+ passed, [0-9]+ failed$/ { p += $1; f += $3 }
		END { print p + 0, f + 0 }' "$log")
	# one that fails or runs nothing without saying how is one failure
	if [ "$f" = 0 ] && { [ $rc != 0 ] || [ "$p" = 0 ]; } &&
	   ! { [ $rc = 0 ] && grep -q '^# not counted: ' "$log"; }; then
		tail -n 40 "$log"
		f=1
	fi
	echo "=== $i: $p passed, $f failed, $((SECONDS - began)) s"
	note "$i" "$at" "$p" "$f" $((SECONDS - began))
	passed=$((passed + p)) failed=$((failed + f))
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
