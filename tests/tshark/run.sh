#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The frames that the unit tests exchange with the model, seen by tshark: the
# same datagrams and mailboxes as our decoders see, nothing malformed but
# what we refuse, too.

cd "$(dirname "$0")/../.." || exit 1
# without sanitizers, as tests/witness
b=$PWD/build/witness
make -s -C tests/unit -j2 B="$b" SAN= capture >/dev/null || exit 1
suite_header=0
for suite in sim_esc sim_app sim_app_mbox sim_app_pdo; do
	CAPTURE="$b/$suite" "$b/capture" "$suite" >"$b/capture.log" ||
		{ cat "$b/capture.log"; exit 1; }
	cat "$b/$suite.txt" >&3
	# one file: the header is 24 bytes, of the first it stays
	tail -c +$((suite_header + 1)) "$b/$suite.pcap" >&4
	suite_header=24
done 3>"$b/all.txt" 4>"$b/all.pcap"
exec tests/tshark/compare.py "$b/all"
