# SPDX-License-Identifier: GPL-2.0-only
"""Small masters that send raw frames to simulated slaves and print what comes back.

frames.py covers INTERFACE		a BRD direct, tagged, in UDP, in tagged UDP
frames.py ring INTERFACE INTERFACE	a BRD from each end of a ring
"""

import socket
import struct
import sys
import time

SOL_PACKET, PACKET_AUXDATA, PACKET_IGNORE_OUTGOING = 263, 8, 23
TAG = b"\x81\x00\x60\x05"
SUM = b"\x12\x34"
BRD = struct.pack("<HBBHHHHHH", 0x100e, 7, 1, 0, 0x0130, 2, 0, 0, 0)


def end(name):
    s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
    s.setsockopt(SOL_PACKET, PACKET_AUXDATA, 1)
    s.setsockopt(SOL_PACKET, PACKET_IGNORE_OUTGOING, 1)
    s.bind((name, 3))
    s.setblocking(False)
    return s


def packet(head):
    return (b"\xff" * 6 + b"\x00\x11\x22\x33\x44\x55" + head + BRD).ljust(60, b"\0")


def udp(inner):
    length = 28 + len(inner)
    ip = struct.pack("!BBHHHBBH", 0x45, 0, length, 1, 0, 64, 17, 0) + bytes([192, 168, 0, 1]) + b"\xff" * 4
    return b"\x08\x00" + ip + struct.pack("!HHH", 0x88a4, 0x88a4, length - 20) + SUM


def receive(s):
    """the frame as it was on the wire, None: none there"""
    try:
        data, more, _, _ = s.recvmsg(2048, socket.CMSG_SPACE(20))
    except BlockingIOError:
        return None
    for level, kind, aux in more:
        if (level, kind) == (SOL_PACKET, PACKET_AUXDATA):
            status, _, _, _, _, tci, tpid = struct.unpack("=IIIHHHH", aux[:20])
            if status & 0x10:
                data = data[:12] + struct.pack("!HH", tpid if status & 0x40 else 0x8100, tci) + data[12:]
    return data


def answer(ends, sent, seconds=5.0):
    """which end the frame came back to, and the frame; (None, None) if it did not"""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for i, s in enumerate(ends):
            data = receive(s)
            # others talk on these wires: ours has the addresses, but for the slave's mark
            if data and data[:6] == sent[:6] and data[7:12] == sent[7:12]:
                return i, data
        time.sleep(0.001)
    return None, None


def wkc(frame):
    return struct.unpack("<H", frame[frame.index(BRD[:4]) + 14:][:2])[0]


def covers(name):
    ends = [end(name)]
    heads = (("direct", b"\x88\xa4"), ("tagged", TAG + b"\x88\xa4"), ("udp", udp(BRD)),
             ("tagged-udp", TAG + udp(BRD)))
    for what, head in heads:
        sent = packet(head)
        ends[0].send(sent)
        _, back = answer(ends, sent)
        if back is None:
            print(what, "lost")
            continue
        same = len(back) == len(sent) and back[12:12 + len(head) - 2] == head[:-2]
        mark = (sent[6] | 2) == back[6]
        rest = back[12 + len(head) - 2:][:2]
        print(what, "wkc=%d" % wkc(back), "head=%s" % ("kept" if same else back[12:46].hex()),
              "mark=%d" % mark, "last=%s" % rest.hex())
    # another port of UDP is nothing for the slaves
    other = bytearray(packet(udp(BRD)))
    other[37] ^= 1
    ends[0].send(bytes(other))
    print("other-port", "lost" if answer(ends, other, 0.5)[1] is None else "answered")


def ring(*names):
    ends = [end(n) for n in names]
    for i, s in enumerate(ends):
        sent = packet(b"\x88\xa4")
        s.send(sent)
        at, back = answer(ends, sent)
        print("from=%d" % i, "lost" if back is None else "at=%d wkc=%d" % (at, wkc(back)))


{"covers": covers, "ring": ring}[sys.argv[1]](*sys.argv[2:])
