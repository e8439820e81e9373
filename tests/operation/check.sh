#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# The configuration of ethercatctl; needs neither root nor a module. Last line: N passed, N failed.

cd "$(dirname "$0")" || exit 1
tmp=$(mktemp) || exit 1
trap 'rm -f "$tmp"' EXIT
bats --tap ./*.bats >"$tmp" 2>&1
rc=$?
grep -v '^ok\|^1\.\.' "$tmp"
passed=$(grep -c '^ok' "$tmp")
failed=$(grep -c '^not ok' "$tmp")
[ $rc = 0 ] || [ "$failed" -gt 0 ] || failed=1
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
