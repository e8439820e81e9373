#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""How long the slave and its card need for a frame, as the wire shows it.

Reads a pcap file with both directions of a card (times of the guest, in us): a frame with process
data leaves, and comes back with the same number in its source address. Prints "wire_ns N", the
median of the last TRIPS of them.

usage: trip.py FILE.pcap TRIPS
"""
import os
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "vm"))
from pcap import frames  # noqa: E402

LOGICAL = (10, 11, 12)


def main():
    path, trips = sys.argv[1], int(sys.argv[2])
    left, took = {}, []
    for time, frame in frames(path):
        if frame[12:14] != b"\x88\xa4" or frame[16] not in LOGICAL:
            continue
        number = frame[8:12]
        if number in left:
            took.append(time - left.pop(number))
        else:
            left[number] = time
    if len(took) < trips:
        sys.exit(f"trip.py: {len(took)} frames came back, not {trips}")
    print(f"wire_ns {statistics.median(took[-trips:]) * 1000:.0f}")


main()
