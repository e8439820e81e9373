#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# Waits until a bus is as its file says, as slaves may have power later than the computer, and the
# first bus scan takes a while. After the time limit it says what is missing.
#
# usage: await.sh FILE [SECONDS]	default: 60

[ $# = 1 ] || [ $# = 2 ] || { echo "usage: await.sh FILE [SECONDS]" >&2; exit 2; }
# seconds since the computer was started, which no clock step changes
now() { cut -d. -f1 /proc/uptime; }
end=$(($(now) + ${2:-60}))
while ! said=$(ethercat run --dry-run "$1" 2>&1); do
	[ "$(now)" -lt "$end" ] || {
		echo "$said" >&2
		exit 1
	}
	sleep 1
done
