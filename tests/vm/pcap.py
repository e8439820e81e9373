# SPDX-License-Identifier: GPL-2.0-only
"""Reads what QEMU's filter-dump has recorded of a guest's network card, both directions."""
import struct


def frames(path):
    """(time of the guest in us, frame)"""
    with open(path, "rb") as f:
        data = f.read()
    at = 24
    while at + 16 <= len(data):
        seconds, us, size = struct.unpack_from("<III", data, at)
        yield seconds * 1000000 + us, data[at + 16:at + 16 + size]
        at += 16 + size
