# SPDX-License-Identifier: GPL-2.0-only
"""Sends ARP requests: arp.py INTERFACE FROM TO COUNT."""

import socket
import struct
import sys

name, src, dst, count = sys.argv[1:]
s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW)
s.bind((name, 0))
mac = s.getsockname()[4]
frame = (b"\xff" * 6 + mac + b"\x08\x06" + struct.pack("!HHBBH", 1, 0x800, 6, 4, 1) + mac +
         socket.inet_aton(src) + bytes(6) + socket.inet_aton(dst)).ljust(60, b"\0")
for _ in range(int(count)):
    s.send(frame)
