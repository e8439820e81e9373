#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""An emulated LAN9500 at the virtual USB host controller vhci_hcd, whose driver
smsc95xx pushes headers into the frames it gets. The network is at INTERFACE.

usage: smsc95xx.py INTERFACE
"""
import select
import socket
import struct
import sys

SUBMIT, UNLINK, RET_SUBMIT, RET_UNLINK = 1, 2, 3, 4
STALL, CONNRESET = -32, -104
SPEED_HIGH = 3
IN, OUT, STATUS = 1, 2, 3	# endpoints
PACKET_IGNORE_OUTGOING, SOL_PACKET = 23, 263

ID_REV, HW_CFG, PM_CTRL, E2P_CMD, E2P_DATA = 0x00, 0x14, 0x20, 0x30, 0x34
MII_ADDR, MII_DATA, COE_CR = 0x114, 0x118, 0x130
# bits that the chip clears when it has done what they ask for
BUSY = {HW_CFG: 0x8, PM_CTRL: 0x10, E2P_CMD: 0x80000000, MII_ADDR: 0x1}

DEVICE = struct.pack("<BBHBBBBHHHBBBB", 18, 1, 0x200, 0xff, 0, 0xff, 64, 0x0424, 0x9500, 0x100,
                     0, 0, 0, 1)
ENDPOINTS = (struct.pack("<BBBBHB", 7, 5, 0x80 | IN, 2, 512, 0) +
             struct.pack("<BBBBHB", 7, 5, OUT, 2, 512, 0) +
             struct.pack("<BBBBHB", 7, 5, 0x80 | STATUS, 3, 16, 4))
CONFIG = (struct.pack("<BBHBBBBB", 9, 2, 18 + len(ENDPOINTS), 1, 1, 0, 0x80, 50) +
          struct.pack("<BBBBBBBBB", 9, 4, 0, 0, 3, 0xff, 0, 0xff, 0) + ENDPOINTS)


class Chip:
    def __init__(self, wire):
        self.wire = wire
        self.regs = {ID_REV: 0x95000001}
        # link up at 100 Mbit/s, an identity that only the generic PHY driver takes
        self.phy = {0: 0x3100, 1: 0x782d, 2: 0x1234, 3: 0x5670, 4: 0x01e1, 5: 0x45e1, 6: 1}

    def write(self, reg, value):
        self.regs[reg] = value & ~BUSY.get(reg, 0)
        if reg == MII_ADDR and value & 2:
            number = value >> 6 & 31
            if number in (0, 4):
                self.phy[number] = self.regs[MII_DATA] & ~(0x8200 if number == 0 else 0)
        elif reg == MII_ADDR:
            self.regs[MII_DATA] = self.phy.get(value >> 6 & 31, 0)
        elif reg == E2P_CMD:
            self.regs[E2P_DATA] = 0xff	# no EEPROM

    def control(self, setup, data):
        """status and answer"""
        _, request, value, index, length = struct.unpack("<BBHHH", setup)
        if request == 0xa0:
            self.write(index, struct.unpack("<I", data)[0])
        elif request == 0xa1:
            return 0, struct.pack("<I", self.regs.get(index, 0))
        elif request == 6:
            text = {1: DEVICE, 2: CONFIG}.get(value >> 8)
            return (0, text[:length]) if text else (STALL, b"")
        elif request == 0:
            return 0, b"\0\0"
        return 0, b""

    def transmit(self, data):
        """frames, each behind its two command words"""
        while len(data) >= 8:
            length = struct.unpack_from("<I", data, 4)[0] & 0x7ff
            self.wire.send(data[8:8 + length])
            data = data[8 + (length + 3 & ~3):]

    def received(self, frame):
        """the frame as it goes to the host"""
        body = frame + bytes(4) + (bytes(2) if self.regs.get(COE_CR, 0) & 1 else b"")
        pad = bytes(self.regs.get(HW_CFG, 0) >> 9 & 3)
        return struct.pack("<I", len(body) << 16) + pad + body


def exactly(bus, count):
    data = bytearray()
    while len(data) < count:
        more = bus.recv(count - len(data))
        if not more:
            sys.exit(0)
        data += more
    return bytes(data)


def done(bus, seq, status, data=b"", actual=None):
    bus.sendall(struct.pack(">IIIIIiiIII8x", RET_SUBMIT, seq, 0, 0, 0, status,
                            len(data) if actual is None else actual, 0, 0, 0) + data)


def host(bus, chip, waiting):
    """one request of the host; waiting: reads that wait for data, by endpoint"""
    head = exactly(bus, 48)
    command, seq, _, inward, endpoint = struct.unpack_from(">IIIII", head)
    if command == UNLINK:
        victim = struct.unpack_from(">I", head, 20)[0]
        found = any(victim in reads for reads in waiting.values())
        for reads in waiting.values():
            if victim in reads:
                reads.remove(victim)
        bus.sendall(struct.pack(">IIIIIi24x", RET_UNLINK, seq, 0, 0, 0, CONNRESET if found else 0))
        return
    length = struct.unpack_from(">i", head, 24)[0]
    data = b"" if inward else exactly(bus, length)
    if endpoint == 0:
        status, answer = chip.control(head[40:48], data)
        done(bus, seq, status, answer if inward else b"", None if inward else length)
    elif inward:
        waiting[endpoint].append(seq)
    else:
        chip.transmit(data)
        done(bus, seq, 0, b"", length)


def main():
    wire = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
    wire.setsockopt(SOL_PACKET, PACKET_IGNORE_OUTGOING, 1)
    wire.bind((sys.argv[1], 3))
    bus, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
    with open("/sys/devices/platform/vhci_hcd.0/attach", "w", encoding="ascii") as f:
        f.write(f"0 {far.fileno()} 1 {SPEED_HIGH}")
    far.close()
    chip = Chip(wire)
    waiting = {IN: [], STATUS: []}
    while True:
        # what no read of the host waits for stays in the socket, as in the chip's FIFO
        ready, _, _ = select.select([bus, wire] if waiting[IN] else [bus], [], [])
        if bus in ready:
            host(bus, chip, waiting)
        elif wire in ready:
            done(bus, waiting[IN].pop(0), 0, chip.received(wire.recv(2048)))


main()
