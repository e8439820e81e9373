#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs all tests of the tool; last line: N passed, N failed.

cd "$(dirname "$0")" || exit 1
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT

command -v bats >/dev/null || apt-get install -y bats >/dev/null 2>&1 || {
	echo "bats is missing: apt-get install bats"
	echo "0 passed, 1 failed"
	exit 1
}

build/value_test >"$tmp/value"
sed '$d' "$tmp/value"
set -- $(tail -n 1 "$tmp/value")
passed=${1:-0} failed=${2:-1}

for f in *.bats; do
	bats --tap "$f" >"$tmp/tap" 2>&1
	rc=$?
	grep -v '^ok\|^1\.\.' "$tmp/tap"
	ok=$(grep -c '^ok' "$tmp/tap")
	bad=$(grep -c '^not ok' "$tmp/tap")
	[ "$rc" -eq 0 ] || [ "$bad" -gt 0 ] || bad=1
	passed=$((passed + ok)) failed=$((failed + bad))
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
