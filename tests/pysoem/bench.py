# SPDX-License-Identifier: GPL-2.0-only
"""What a foreign master must find on the segment "bench". Typed from vendor
lists and from the description of the segment, not from the model."""

BECKHOFF, WAGO, GENERIC = 0x2, 0x21, 0xec51


def ek(number):
    """Couplers: the number on the case, and 0x2c52."""
    return BECKHOFF, number << 16 | 0x2c52


def el(number):
    """Terminals: the number on the case, and 0x3052."""
    return BECKHOFF, number << 16 | 0x3052


# name, (vendor, product), bytes of outputs, of inputs
SLAVES = [
    ("EK1100", ek(1100), 0, 0),
    ("EL1859", el(1859), 1, 1),
    ("EL3062", el(3062), 0, 8),
    ("EL4002", el(4002), 4, 0),
    ("EL7201", el(7201), 6, 6),
    ("EL7201", el(7201), 6, 6),
    ("EL6614", el(6614), 0, 0),
    ("EK1110", ek(1110), 0, 0),
    ("EK1100", ek(1100), 0, 0),
    ("EL1008", el(1008), 0, 1),
    ("EL1004", el(1004), 0, 1),
    ("EL2008", el(2008), 1, 0),
    ("EL2004", el(2004), 1, 0),
    ("EL3062", el(3062), 0, 8),
    ("EL4002", el(4002), 4, 0),
    ("750-354", (WAGO, 0x07500354), 9, 9),
    ("drive", (GENERIC, 0x402), 22, 22),
    ("drive", (GENERIC, 0x402), 22, 22),
    ("io", (GENERIC, 0x104), 8, 8),
    ("EK1100", ek(1100), 0, 0),
    ("EL2008", el(2008), 1, 0),
    ("EL1008", el(1008), 0, 1),
]

DIO, AI, AO, AXIS1, AXIS2 = 1, 2, 3, 4, 5
DI1, DI2, DO1, DO2, AI2, AO2 = 9, 10, 11, 12, 13, 14
COUPLER, WAGO_IO, DRIVE1, DRIVE2, IO, DO3, DI3 = 0, 15, 16, 17, 18, 20, 21

# output, its bit, input, its bit
DIGITAL_WIRES = [(DIO, 0, DIO, 4), (DIO, 1, DIO, 1), (DO1, 0, DI1, 0), (DO1, 1, DI1, 1),
                 (DO2, 0, DI2, 0), (DO3, 0, DI3, 0)]

# LRW: a slave counts 2 for its outputs and 1 for its inputs
WKC = sum(2 * bool(o) + bool(i) for _, _, o, i in SLAVES)

ALIAS = {0: 1, 8: 2, 11: 1001, 15: 3, 19: 4}


def crc8(data):
    """Checksum of the first seven words of an EEPROM: x^8 + x^2 + x + 1, from 0xff."""
    crc = 0xff
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ (0x07 if crc & 0x80 else 0)) & 0xff
    return crc
