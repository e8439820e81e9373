#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs a command with $EC_SIM at veth1; both have to end well, and no frame may be lost.
# usage: beside.sh COMMAND...

set -u
log=$(mktemp)
trap 'rm -f "$log"' EXIT
eval "sim=($EC_SIM)"
"${sim[@]}" veth1 >"$log" &
pid=$!
until grep -q 'slave(s)' "$log"; do
	kill -0 $pid 2>/dev/null || { cat "$log"; echo "not ok ethercat-sim starts"; exit 1; }
	sleep 0.1
done
"$@"
rc=$?
kill $pid
wait $pid || rc=$?
cat "$log"
grep -q ' 0 lost in the segment, 0 dropped' "$log" || { echo "not ok no frame is lost"; rc=1; }
exit $rc
