#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""DMA of an Intel network card that no driver has asked for.

usage: dma.py PCI-ADDRESS stale|transmit|receive INTERFACE

The card has no driver; its registers are written through resource0 of sysfs.
stale: the card continues with the descriptors of its last driver, whose memory is free.
transmit, receive: its descriptors lie in a page of this program, by the page's physical
address; receive sends a frame from INTERFACE, at the other end of the wire.
Prints "changed" or "intact" for the memory of transmit and receive, and "address 0x..."
that the card reads first.
"""
import mmap
import os
import socket
import struct
import sys
import time

PAGE = 4096
CTRL, RCTL, TCTL = 0x0000, 0x0100, 0x0400
SLU, GIO_DISABLE = 1 << 6, 1 << 2
LOW, HIGH, LEN, HEAD, TAIL, DCTL = 0x00, 0x04, 0x08, 0x10, 0x18, 0x28


class Card:
    def __init__(self, address):
        self.folder = "/sys/bus/pci/devices/" + address
        if os.path.exists(self.folder + "/driver"):
            sys.exit("dma.py: %s has a driver" % address)
        with open(self.folder + "/device") as f:
            igb = int(f.read(), 16) == 0x10c9
        self.tx, self.rx = (0xe000, 0xc000) if igb else (0x3800, 0x2800)
        with open(self.folder + "/enable") as f:
            enabled = f.read().strip() != "0"
        if not enabled:
            with open(self.folder + "/enable", "w") as f:
                f.write("1")
        fd = os.open(self.folder + "/config", os.O_RDWR)
        command = struct.unpack("<H", os.pread(fd, 2, 4))[0]
        os.pwrite(fd, struct.pack("<H", command | 6), 4)    # memory, bus master
        os.close(fd)
        fd = os.open(self.folder + "/resource0", os.O_RDWR | os.O_SYNC)
        self.registers = memoryview(mmap.mmap(fd, 0x10000)).cast("I")
        os.close(fd)
        self[CTRL] = self[CTRL] & ~GIO_DISABLE | SLU

    def __getitem__(self, register):
        return self.registers[register // 4]

    def __setitem__(self, register, value):
        self.registers[register // 4] = value

    def base(self, queue):
        return self[queue + HIGH] << 32 | self[queue + LOW]

    def set_ring(self, queue, address):
        self[queue + LOW] = address & 0xffffffff
        self[queue + HIGH] = address >> 32
        self[queue + LEN] = PAGE
        self[queue + HEAD] = 0
        self[queue + TAIL] = 0
        self[queue + DCTL] = self[queue + DCTL] | 1 << 25
        if queue == 0xc000:
            self[queue + 0x0c] = 2    # SRRCTL: legacy descriptors, 2 KiB

    def stop(self):
        self[RCTL] = 0
        self[TCTL] = 0


class Memory:
    """Two pages that stay where they are: descriptors and a buffer."""
    def __init__(self):
        self.pages = mmap.mmap(-1, 2 * PAGE, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | 0x2000)
        self.pages[:] = b"\xa5" * 2 * PAGE
        with open("/proc/self/pagemap", "rb") as f:
            f.seek(address_of(self.pages) // PAGE * 8)
            self.at = [(entry & (1 << 55) - 1) * PAGE for entry in struct.unpack("<QQ", f.read(16))]
        if 0 in self.at:
            sys.exit("dma.py: no physical address")

    def fill(self, descriptors):
        self.pages[:PAGE] = descriptors.ljust(PAGE, b"\0")
        self.before = self.pages[:]

    def verdict(self):
        return "intact" if self.pages[:] == self.before else "changed"


def address_of(pages):
    import ctypes
    return ctypes.addressof(ctypes.c_char.from_buffer(pages))


def send(interface):
    with socket.socket(socket.AF_PACKET, socket.SOCK_RAW) as s:
        s.bind((interface, 0))
        s.send(b"\xff" * 6 + b"\x02\0\0\0\0\x01" + b"\x88\xb5" + b"planted".ljust(46, b"\0"))


def main():
    address, what, interface = sys.argv[1:]
    card = Card(address)
    if what == "stale":
        print("address 0x%x" % card.base(card.tx))
        card[TCTL] = 2
        card[card.tx + TAIL] = (card[card.tx + HEAD] + 1) % 256
    else:
        memory = Memory()
        print("address 0x%x" % memory.at[0])
        if what == "transmit":
            # end of packet, add FCS, report status
            memory.fill(struct.pack("<QHBBBBH", memory.at[1], 60, 0, 0xb, 0, 0, 0))
            card.set_ring(card.tx, memory.at[0])
            card[TCTL] = 2
            card[card.tx + TAIL] = 1
        else:
            memory.fill(struct.pack("<QQ", memory.at[1], 0) * (PAGE // 16))
            card.set_ring(card.rx, memory.at[0])
            card[RCTL] = 2 | 1 << 3 | 1 << 4 | 1 << 15    # all frames
            card[card.rx + TAIL] = 255
            send(interface)
    time.sleep(1.5)    # QEMU's e1000 receives nothing for a second after RCTL is written
    card.stop()
    if what != "stale":
        print(memory.verdict())


main()
