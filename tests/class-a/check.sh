#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The table of class A with the results of a run of tests/check.sh; the rows are right, and so is
# the page that is made from them. The last line is "N passed, N failed".
#
# usage: check.sh [FOLDER]	of the results; default: none, so no test has run

set -u
cd "$(dirname "$0")/../.." || exit 1
export LC_ALL=C
rows=tests/class-a/rows.py
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT
. tests/t.sh

# noticed SED FINDING: the rows with this change are refused; else the check could not fail
noticed() {
	sed -E "$1" tests/class-a/rows.txt >"$tmp/rows" &&
		! cmp -s "$tmp/rows" tests/class-a/rows.txt && ! EC_ROWS=$tmp/rows $rows check >"$tmp/found" &&
		grep -F "$2" "$tmp/found"
}

same_page() { $rows page | diff Documentation/class-a.rst -; }

# another_page SED: a change of the rows is a change of the page
another_page() {
	sed -E "$1" tests/class-a/rows.txt >"$tmp/rows" &&
		! EC_ROWS=$tmp/rows $rows page | cmp -s Documentation/class-a.rst -
}

# a_failure: a test of a row fails, another one is skipped, a third one has no result
a_failure() {
	mkdir "$tmp/run" && echo "1 2 3 4" >"$tmp/run/uml.end" &&
		printf '%s\n' 'ok bus_voe.voe_echo' 'skip bus_dc.dc_window' \
			'not ok bus_soe.soe_values' >"$tmp/run/uml.cases" && ! $rows table "$tmp/run" >"$tmp/table" &&
		grep -qx 'not ok - class A: row 801: failed: bus_soe.soe_values' "$tmp/table" &&
		grep -qx 'not ok - class A: row 1103: skipped: bus_dc.dc_window' "$tmp/table" &&
		grep -qx 'not ok - class A: row 1001: no result: bus_voe.voe_handlers' "$tmp/table" &&
		! grep 'not ok.*voe_echo' "$tmp/table"
}

t "40 rows, their tests exist, their changes can be made" $rows check
t "a row that is not there is noticed" noticed '/^404 /,/^$/d' 'rows missing: [404]'
t "a row without test is noticed" noticed '/^602 /,/^$/{/^(test|also|change|[-+]) /d}' \
	'row 602: is said to be there and has no test'
t "a test that does not exist is noticed" noticed 's/^test bus_voe.voe_echo/&es/' \
	'row 1001: no test bus_voe.voe_echoes'
t "a change whose text has gone is noticed" noticed 's/^- r->irq = d.irq;/- r->irq = d->irq;/' \
	'row 102: master/carry/rider.c has 0 times: r->irq = d->irq;'
t "a test without a change is noticed" noticed '/^1001 /,/^$/{/^(change|[-+]) /d}' \
	'row 1001: tests and a change that makes them fail belong together'
t "a test that has failed is noticed" a_failure
t "Documentation/class-a.rst is made from rows.txt: $rows page" same_page
t "another page is noticed" another_page 's/^(class) may/\1 should/'
$rows table "${1:-$tmp/none}" >"$tmp/table"
sed '$d' "$tmp/table"
read -r p f < <(tail -n 1 "$tmp/table" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p')
passed=$((passed + ${p:-0})) failed=$((failed + ${f:-1}))
echo "$passed passed, $failed failed"
[ $failed = 0 ]
