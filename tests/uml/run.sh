#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Builds the UML kernel and runs its KUnit suites in virtual time.
#
#   run.sh [--debug] [--no-build] [--log FILE] [FILTER]
#
# FILTER: glob of suites, or suite.case, e.g. 'bus_*' or '*.mailbox_*'.
# The raw console log is kept; its path is printed on failure.
# EC_UML_TIMEOUT: seconds of real time until a run counts as hung (300).
# EC_UML_ARGS: more kernel parameters.
# EC_UML_CASES: file for the result of each case, "ok SUITE.CASE" in a line.
# More variables: see build.sh.
#
# Last line: "N passed, N failed".  Exit 0 only if all is well: 1 for failures,
# crashes, hangs, kernel warnings or no test at all; 2 if it does not build.
set -uo pipefail

die() { echo "run.sh: $*" >&2; exit 2; }

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
debug= log= filter="*" path=
while [ $# -gt 0 ]; do
	case "$1" in
	--debug) debug=--debug ;;
	--no-build) path=--path ;;
	--log) shift; log=${1-}; [ -n "$log" ] || die "--log needs a file" ;;
	-*) die "unknown option '$1'" ;;
	*) filter=$1 ;;
	esac
	shift
done

kernel=$("$here/build.sh" $debug $path) || exit 2
[ -x "$kernel" ] || die "no kernel built yet: $kernel"
command -v python3 >/dev/null || die "python3 is missing"

dir=$(mktemp -d "${TMPDIR:-/tmp}/ec-uml.XXXXXX") || exit 2
keep=
trap '[ -n "$keep" ] || rm -rf "$dir"' EXIT
log=${log:-$dir/log}
# The kernel may be replaced by a build while this run goes on.
cp "$kernel" "$dir/vmlinux" || exit 2

limit=${EC_UML_TIMEOUT:-300}
start=$(date +%s.%N)
# uml_dir keeps UML's sockets out of the home folder.  timeout kills the whole
# process group: UML has several host processes. They also end when this shell is killed.
# Bash's remark on how they ended is swallowed.
ulimit -c 0
exec 4>&2 2>/dev/null
(
	exec setpriv --pdeathsig KILL timeout -s KILL "$limit" \
		setpriv --pdeathsig KILL setarch -R "$dir/vmlinux" mem=512M log_buf_len=4M \
		time-travel=inf-cpu time-travel-start=1800000000 kunit.filter_glob="$filter" \
		kunit_shutdown=halt kmemleak.verbose=1 uml_dir="$dir/" \
		con=null con0=fd:0,fd:1 panic=-1 loglevel=8 \
		${EC_UML_ARGS-} </dev/null >"$log" 2>&1
)
rc=$?
exec 2>&4 4>&-
[ $rc != 137 ] || echo "EC-UML-HANG" >>"$log"
took=$(echo "$(date +%s.%N) - $start" | bc)

python3 "$here/ktap.py" --seconds "$took" --limit "$limit" \
	${EC_UML_CASES:+--cases "$EC_UML_CASES"} \
	"$log"
rc=$?
if [ $rc != 0 ]; then
	keep=1
	rm -f "$dir/vmlinux"
	echo "raw log: $log" >&2
fi
exit $rc
