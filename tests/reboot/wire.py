#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Frames of a guest that has rebooted: the slaves were in OP, left it, and stayed out of it.

Reads a pcap file with frames in both directions. What counts are replies with the AL status of
all slaves (BRD to 0x0130 with the working counter of all): the last one before the guest ended has
neither SAFEOP nor OP, an earlier one has OP, and between these two no slave returns. Frames with
process data follow the last one with OP: the slaves left it beside the cycle, not after its end.

usage: wire.py FILE.pcap SLAVES
"""
import os
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "vm"))
from pcap import frames  # noqa: E402

BRD, LOGICAL = 7, (10, 11, 12)
OP = 8
BEYOND_PREOP = 0x0c     # bits of SAFEOP and OP


def datagrams(frame):
    """(command, register, data, working counter)"""
    if frame[12:14] != b"\x88\xa4":
        return
    end = min(len(frame), 16 + (struct.unpack_from("<H", frame, 14)[0] & 0x7ff))
    at = 16
    while at + 12 <= end:
        command, _, _, register, size = struct.unpack_from("<BBHHH", frame, at)
        more, size = size & 0x8000, size & 0x7ff
        if at + 12 + size > end:
            return
        yield (command, register, frame[at + 10:at + 10 + size],
               struct.unpack_from("<H", frame, at + 10 + size)[0])
        at += 12 + size
        if not more:
            return


def main():
    path, slaves = sys.argv[1], int(sys.argv[2])
    states, cycles = [], 0
    for _, frame in frames(path):
        for command, register, data, counter in datagrams(frame):
            if command == BRD and register == 0x130 and counter == slaves:
                state = data[0] & 0x0f
                if not states or states[-1] != state:
                    states.append(state)
                if state == OP:
                    cycles = 0
            elif command in LOGICAL:
                cycles += 1
    print(f"# AL states of all slaves, in order: {states}; {cycles} datagrams of the cycle after OP")
    if not states or states[-1] & BEYOND_PREOP:
        return "at the end the slaves are not out of SAFEOP and OP"
    if OP not in states:
        return "the slaves were never in OP"
    down = False
    for state in states[len(states) - states[::-1].index(OP):]:
        if state & BEYOND_PREOP and down:
            return "slaves returned to SAFEOP or OP"
        down = not state & BEYOND_PREOP
    return 0 if cycles else "the cycle had ended before"


sys.exit(main())
