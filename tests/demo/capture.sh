#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A witness that shares no code with us: tshark dissects every captured frame.
#
# usage: capture.sh FILE FRAMES    at least so many frames are expected

set -u
file=$1 expected=$2

[ -s "$file" ] || { echo "demo: FAILED: no capture at $file; tcpdump.log beside it may say why" >&2; exit 1; }
tshark -n -r "$file" -T fields -E separator=' ' -e frame.protocols -e _ws.malformed 2>"${file%.pcap}.tshark.log" |
	awk -v file="$file" -v expected="$expected" '
	{ n++ }
	$1 ~ /:ecat(:|$)/ { ecat++ }
	$1 ~ /:ecat_mailbox/ { mailbox++ }
	NF > 1 { malformed++ }
	END {
		printf "capture: %s\n", file
		printf "tshark: %d packets, %d EtherCAT, %d of them with a mailbox; malformed: %d\n",
			n, ecat, mailbox, malformed
		if (malformed || ecat != n || ecat < expected) {
			printf "demo: FAILED: every packet should be EtherCAT, none malformed, at least %d; look at: tshark -r %s\n",
				expected, file
			exit 1
		}
	}'
