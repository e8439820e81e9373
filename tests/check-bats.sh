#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Finds lines of bats files that look like an assertion and assert nothing: the shell
# never ends a test for a command behind "!", whatever its status, unless it is the last.
# Such a line ends in "|| return 1", or becomes a comparison.
#
# usage: check-bats.sh [FILE...]	default: all of tests/

set -u
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- tests/*/*.bats tests/*/*.bash
passed=0 failed=0

# inert FILE...: prints these lines, joined where they go on
inert() {
	sed -e ':a' -e '/\\$/{N;s/\\\n[[:space:]]*//;ba' -e '}' "$1" |
		grep -E '^[[:space:]]*![[:space:]]' | grep -vF '||'
}

# it finds what it has to, and no more
case $(printf '\t! a |\n\t\tb\n\t! a \\\n\t\t|| b\n\ta && ! b\n' | inert /dev/stdin) in
$'\t! a |') passed=$((passed + 1)) ;;
*) echo "not ok check-bats finds what asserts nothing"; failed=$((failed + 1)) ;;
esac

for f; do
	if found=$(inert "$f"); then
		printf 'not ok %s: asserts nothing:\n%s\n' "$f" "$found"
		failed=$((failed + 1))
	else
		passed=$((passed + 1))
	fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
