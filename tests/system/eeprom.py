#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""eeprom.py KIND FILE: writes an EEPROM image, good or wrong in one way.

KIND: good, large, checksum, endless, beyond, noend, zero, ones
"""
import struct
import sys

SIZE = 2048
LARGE = 132 * 1024    # words at the end have more than 16 bits


def category(kind, data):
    data += b"\0" * (len(data) % 2)
    return struct.pack("<HH", kind, len(data) // 2) + data


def strings(*texts):
    out = bytes([len(texts)])
    for t in texts:
        out += bytes([len(t)]) + t.encode()
    return out


def crc(data):
    c = 0xff
    for b in data:
        c ^= b
        for _ in range(8):
            c = (c << 1 ^ 7 if c & 0x80 else c << 1) & 0xff
    return c


def header():
    words = [0] * 64
    words[0] = 0x0104
    words[8:16] = [0x1234, 0, 0x0042, 0, 1, 0, 7, 0]
    words[62] = SIZE // 128 - 1
    words[63] = 1
    raw = bytearray(struct.pack("<64H", *words))
    raw[14] = crc(raw[:14])
    return raw


def categories():
    general = bytearray(32)
    general[3] = 1
    sm = struct.pack("<HHBBBB", 0x1000, 1, 0x20, 0, 1, 4)
    pdo = struct.pack("<HBBBBH", 0x1A00, 1, 0, 0, 0, 0) + struct.pack("<HBBBBH", 0x6000, 1, 0, 5, 8, 0)
    return (category(10, strings("Input from a file")) + category(30, bytes(general)) +
            category(40, b"\x02") + category(41, sm) + category(50, pdo))


def image(kind):
    if kind == "zero":
        return bytes(SIZE)
    if kind == "ones":
        return b"\xff" * SIZE
    head, cats = header(), categories()
    if kind == "checksum":
        head[14] ^= 0x55
    body = bytes(head) + cats
    if kind == "large":         # to be read as a whole: used up to the end marker, its last word
        struct.pack_into("<H", head, 124, LARGE // 128 - 1)
        body = bytes(head) + cats + category(0x0900, bytes(range(256)) * 256)
        return body + category(0x0901, b"\xa5" * (LARGE - len(body) - 6)) + b"\xff\xff"
    if kind == "endless":       # empty categories up to the end of the EEPROM
        return (body + category(0x0900, b"") * SIZE)[:SIZE]
    if kind == "beyond":        # the last one says it is longer than the EEPROM
        return (body + struct.pack("<HH", 0x0900, 0xfff0)).ljust(SIZE, b"\x5a")
    if kind == "noend":         # used up to the last byte
        return body + category(0x0900, b"\x5a" * (SIZE - len(body) - 4))
    return (body + b"\xff\xff").ljust(SIZE, b"\xff")


if len(sys.argv) != 3 or sys.argv[1] not in __doc__:
    sys.exit(__doc__)
with open(sys.argv[2], "wb") as f:
    f.write(image(sys.argv[1]))
