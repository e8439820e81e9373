# SPDX-License-Identifier: GPL-2.0-only
"""A small master that connects a tap to a slave by Ethernet over EoE, apart from ours.

eoe_station.py INTERFACE TAP SIZE [IP]: for the first slave, with mailboxes of SIZE bytes; sets its
IP address. Prints "up" when the tap is there, and runs until it is killed.
"""

import fcntl
import os
import socket
import struct
import sys
import time

TUNSETIFF, IFF_TAP_NO_PI = 0x400454ca, 0x1002
APRD, APWR = 1, 2
RX, SM, AL_CONTROL, AL_STATUS = 0x1000, 0x0800, 0x0120, 0x0130
EOE = 2
ETHERNET = b"\xff" * 6 + b"\x02\0\0\0\0\x77\x88\xa4"


class Slave:
    def __init__(self, interface, size):
        self.s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x88a4))
        self.s.bind((interface, 0))
        self.s.settimeout(5)
        self.size, self.index, self.counter = size, 0, 0
        for n, (start, control) in enumerate(((RX, 0x26), (RX + size, 0x22))):
            page = struct.pack("<HHBBBB", start, size, control, 0, 1, 0)
            assert self.access(APWR, SM + 8 * n, page)[1] == 1
        self.access(APWR, AL_CONTROL, b"\2\0")
        while self.access(APRD, AL_STATUS, bytes(2))[0][0] != 2:
            time.sleep(0.01)

    def access(self, command, register, data):
        self.index = self.index + 1 & 255
        head = struct.pack("<BBHHHH", command, self.index, 0, register, len(data), 0)
        body = head + data + b"\0\0"
        frame = ETHERNET + struct.pack("<H", len(body) | 0x1000) + body
        self.s.send(frame.ljust(60, b"\0"))
        while True:
            r = self.s.recv(2000)
            if r[17] == self.index and r[6] & 2:	# back from the segment
                return r[26:26 + len(data)], struct.unpack_from("<H", r, 26 + len(data))[0]

    def send(self, body):
        """False: the mailbox is full"""
        counter = self.counter % 7 + 1
        head = struct.pack("<HHBB", len(body), 0, 0, EOE | counter << 4)
        if self.access(APWR, RX, (head + body).ljust(self.size, b"\0"))[1] != 1:
            return False
        self.counter = counter
        return True

    def receive(self):
        """an EoE message, or None"""
        data, count = self.access(APRD, RX + self.size, bytes(self.size))
        if count != 1 or data[5] & 15 != EOE:
            return None
        return data[6:6 + struct.unpack_from("<H", data)[0]]


def cut(frame, number, size):
    """the fragments of a frame"""
    room, at, n = (size - 10) // 32 * 32, 0, 0
    while at < len(frame):
        last = len(frame) - at <= size - 10
        part = frame[at:] if last else frame[at:at + room]
        units = at // 32 if n else (len(frame) + 31) // 32
        yield struct.pack("<HH", last << 8, n | units << 6 | number << 12) + part
        at, n = at + len(part), n + 1


def join(parts, message):
    """a frame that is whole, or None"""
    first, second = struct.unpack_from("<HH", message)
    if first & 15:
        return None
    key, number, units, data = second >> 12, second & 63, second >> 6 & 63, message[4:]
    if first & 0x300 == 0x300:
        data = data[:-4]
    n, before = parts.pop(key, (0, b"")) if number else (0, b"")
    if number != n or (number and units * 32 != len(before)):
        return None
    if first & 0x100:
        return before + data
    parts[key] = (n + 1, before + data)
    return None


def main():
    slave, parts, out, number = Slave(sys.argv[1], int(sys.argv[3])), {}, [], 0
    if len(sys.argv) > 4:
        ip = bytes(int(x) for x in reversed(sys.argv[4].split(".")))
        slave.send(struct.pack("<HHI6s4s", 0x102, 0, 2, bytes(6), ip))
        while slave.receive() is None:
            pass
    tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH", sys.argv[2].encode(), IFF_TAP_NO_PI))
    print("up", flush=True)
    while True:
        try:
            if not out:
                out = list(cut(os.read(tap, 2000), number, slave.size))
                number = number + 1 & 15
        except BlockingIOError:
            pass
        if out and slave.send(out[0]):
            out.pop(0)
        message = slave.receive()
        frame = join(parts, message) if message else None
        if frame:
            try:
                os.write(tap, frame)
            except OSError:		# it is down
                pass
        if not message and not out:
            time.sleep(0.0005)


main()
