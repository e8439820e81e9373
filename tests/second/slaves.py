# SPDX-License-Identifier: GPL-2.0-only
"""A second model of EtherCAT slaves, a witness against common misreadings of master and
simulator. Written only from the published descriptions of registers, state machine, SII
and mailbox protocols; it shares no line, no table and no number with the simulator.

usage: slaves.py INTERFACE FOLDER [SECOND]      (FOLDER: gets the EEPROMs, 0.bin to 2.bin)

Three slaves in a line: four digital outputs, four digital inputs (an ESC that copies AL
control to AL status without software), an axis with CoE. The inputs repeat the outputs
in reverse order; the axis answers with status = ~control, position = -target.
With a second interface the line is a ring. Its cables break and heal by "cut N" and "heal N"
in the pipe FOLDER/tell: the cable in front of slave N, 3: the one to the second interface.
At SIGTERM it says what the master did that no master may do, one line "fault: ..." each."""

import os
import select
import signal
import socket
import struct
import sys
import time

INIT, PREOP, BOOT, SAFEOP, OP = 1, 2, 3, 4, 8
PATH = [INIT, PREOP, SAFEOP, OP]
faults = {}     # what is no slave's choice to accept or not: the master is wrong
wires = [0]     # outputs of the first slave


def fault(text):
    faults[text] = faults.get(text, 0) + 1


def u16(data, at):
    return struct.unpack_from("<H", data, at)[0]


def copy_bits(to, tbit, data, fbit, n):
    for k in range(n):
        value = data[(fbit + k) // 8] >> (fbit + k) % 8 & 1
        at, bit = (tbit + k) // 8, 1 << (tbit + k) % 8
        to[at] = to[at] | bit if value else to[at] & ~bit


def crc8(data):
    crc = 0xFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1) ^ (0x107 if crc & 0x80 else 0)
    return crc


def sii(pdi, alias, ident, mailbox, strings, details, fmmus, sms, pdos):
    """@pdos: category type -> [(index, SM, [(index, sub, name, type, bits)])]"""
    img = bytearray(struct.pack("<8H", pdi, 0, 0, 0, alias, 0, 0, 0))
    img[14] = crc8(img[:14])
    img += struct.pack("<4I", *ident) + bytes(16)
    img += struct.pack("<5H", *(mailbox + (4,) if mailbox else (0,) * 5))
    img += bytes(0x7C - len(img)) + struct.pack("<HH", 15, 1)
    # group, image, order and name by string; CoE details; flags; ports
    general = bytes([0, 0, 1, 2, 0, details, 0, 0, 0, 0, 0, 4 * bool(details)]) + bytes(4)
    cats = [(10, bytes([len(strings)]) + b"".join(bytes([len(s)]) + s.encode() for s in strings)),
            (30, general + b"\x11" + bytes(15)), (40, bytes(fmmus)),
            (41, b"".join(struct.pack("<HHBBBB", *s) for s in sms))]
    for kind, some in pdos.items():
        cats.append((kind, b"".join(
            struct.pack("<HBBBBH", index, len(entries), sm, 0, 0, 0) +
            b"".join(struct.pack("<HBBBBH", *e, 0) for e in entries)
            for index, sm, entries in some)))
    for kind, data in cats:
        img += struct.pack("<HH", kind, (len(data) + 1) // 2) + data + b"\0" * (len(data) % 2)
    return img + b"\xff" * (2048 - len(img))


class Esc:
    """Registers, SyncManagers, FMMUs, EEPROM interface, and a state machine."""
    emulated = read8 = op_only = wants_eeprom = False       # the last: in INIT -> PREOP
    fmmus, sms = 3, 4
    out_sm = in_sm = None
    addresses = {}                              # of the process data, by SyncManager
    # registers that may be written, and those that may only be read
    rw = ((0x10, 0x12), (0x20, 0x22), (0x30, 0x32), (0x100, 0x104), (0x120, 0x122), (0x200, 0x202),
          (0x300, 0x314), (0x400, 0x402), (0x410, 0x412), (0x420, 0x422), (0x442, 0x444),
          (0x500, 0x510))
    ro = ((0, 10), (0x12, 0x14), (0x110, 0x112), (0x130, 0x136), (0x140, 0x142), (0x150, 0x154),
          (0x204, 0x208), (0x210, 0x214), (0x220, 0x224), (0x440, 0x442))

    def __init__(self, image):
        self.image, self.link, self.open = image, [True, False], [True, False]
        m = self.mem = bytearray(0x10000)
        # type, revision, build, FMMUs, SMs, RAM KiB, ports (two MII), features:
        # registers that do not exist give no working counter
        struct.pack_into("<BBHBBBBH", m, 0, 0x11, 0, 2, self.fmmus, self.sms, 8, 0x0F, 0x0002)
        m[0x12:0x14], m[0x100], m[0x140:0x142] = image[8:10], 1, image[0:2]
        for at, value in ((0x400, 2498), (0x410, 1000), (0x420, 1000)):
            struct.pack_into("<H", m, at, value)
        areas = self.rw + ((0x600, 0x600 + 16 * self.fmmus), (0x800, 0x800 + 8 * self.sms))
        self.readable = {a for lo, hi in areas + self.ro for a in range(lo, hi)}
        self.writable = {a for lo, hi in areas for a in range(lo, hi)} - {
            a + 8 * i for a in (0x805, 0x807) for i in range(self.sms)}
        self.requested = self.outputs_at = None     # AL control; when the last outputs came
        self.opened = set()         # mailboxes of which the first byte was accessed
        self.enter(INIT)

    def sm(self, i):
        """start, length, control, status, activate"""
        return struct.unpack_from("<HHBBB", self.mem, 0x800 + 8 * i)

    def access(self, at, n, direction):
        """May this range of the RAM be read (0) or written (4)? Hands the buffer over."""
        if at + n > 0x1000 + 8192:
            return False
        for i in range(self.sms):
            start, length, control, status, active = self.sm(i)
            if not active & 1 or not length or at >= start + length or start >= at + n:
                continue
            last = at + n == start + length
            if control & 0x0C != direction or at < start or at + n > start + length:
                return False                    # beyond it, or in the other direction
            if control & 3 == 2:                # mailbox: full to read, empty to write,
                if bool(status & 8) == bool(direction) or at != start and i not in self.opened:
                    return False                # and opened by its first byte
                self.opened.add(i)
                if last:
                    self.opened.discard(i)
                    self.mem[0x805 + 8 * i] ^= 8
            elif not direction:                 # nothing was written to it before SAFEOP
                return self.state in (SAFEOP, OP)
            elif last:
                self.outputs_at = time.monotonic()
            return True
        return True

    def read(self, at, n):
        data = bytes(self.mem[at:at + n])
        if at >= 0x1000:
            return data if self.access(at, n, 0) else None
        if at <= 0x110 < at + n:
            self.mem[0x210] &= ~4 & 0xFF        # DL status event
        if at <= 0x130 < at + n:
            self.mem[0x210] &= ~8 & 0xFF        # AL status event
        return None if self.readable.isdisjoint(range(at, at + n)) else data

    def write(self, at, data):
        m, n = self.mem, len(data)
        if at >= 0x1000 and self.access(at, n, 4):
            m[at:at + n] = data
            return True
        if 0x500 <= at < 0x510:
            return self.write_eeprom(at, data)
        mine = [k for k in range(n) if at + k in self.writable]
        for k in mine:
            m[at + k] = 0 if 0x300 <= at + k < 0x314 else data[k]
        if 0x800 <= at < 0x880:
            self.opened.clear()
            for i in range(self.sms):
                m[0x805 + 8 * i] *= m[0x806 + 8 * i] & 1
        if at <= 0x120 < at + n:
            self.requested = u16(m, 0x120)
            if self.requested & ~0x3F:
                fault("reserved bits in AL control 0x%04x" % self.requested)
        if at <= 0x101 < at + n:
            self.dl_status(written=True)
        return bool(mine)

    def write_eeprom(self, at, data):
        m = self.mem
        if at == 0x500:
            m[0x500] = data[0] & 1
            at, data = 0x502, data[2:]
        elif m[0x500] & 1:
            fault("EEPROM command while the PDI owns it")
            return False
        m[at:at + len(data)] = data
        if at == 0x502 and data:
            command, word = m[0x503] & 7, u16(m, 0x504)
            if command == 1:
                n = 8 if self.read8 else 4
                m[0x508:0x508 + n] = (self.image[2 * word:2 * word + n] + b"\xff" * n)[:n]
            m[0x503] = 0 if command in (0, 1, 4) else 0x20      # idle, read, reload
            m[0x502] = 0x40 if self.read8 else 0
        return True

    def dl_status(self, written=False):
        status = 0x5001                         # PDI; ports 2 and 3 closed
        for port in (0, 1):
            mode, link = self.mem[0x101] >> 2 * port & 3, self.link[port]
            if mode == 3 and port == 0:
                fault("port 0 closed")
            # auto, auto-close (what has closed opens by a write), open, closed
            self.open[port] = (link, link and (self.open[port] or written), True, False)[mode]
            # physical link, communication, loop closed
            status |= (0x10 << port) * link | (0x200 << 2 * port) * (link and self.open[port])
            status |= (0x100 << 2 * port) * (not self.open[port])
        if status != u16(self.mem, 0x110):
            struct.pack_into("<H", self.mem, 0x110, status)
            self.mem[0x210] |= 4

    def logical(self, cmd, at, data):
        wrote, inputs = False, []
        for i in range(self.fmmus):
            lstart, n, lbit, stop, pstart, pbit, kind, on = struct.unpack_from(
                "<IHBBHBBB", self.mem, 0x600 + 16 * i)
            first = 8 * lstart + lbit
            lo = max(first, 8 * at)
            hi = min(first + 8 * (n - 1) + stop - lbit + 1, 8 * (at + len(data)))
            if not on & 1 or not n or lo >= hi:
                continue
            phys = 8 * pstart + pbit + lo - first
            span = phys // 8, (phys + hi - lo - 1) // 8 - phys // 8 + 1
            if kind & 1 and cmd in (10, 12):
                got = self.read(*span)
                if got is not None:
                    inputs.append((lo - 8 * at, got, phys % 8, hi - lo))
            if kind & 2 and cmd in (11, 12):
                new = bytearray(self.mem[span[0]:sum(span)])
                copy_bits(new, phys % 8, data, lo - 8 * at, hi - lo)
                wrote |= self.write(span[0], bytes(new))
        for lo, got, bit, n in inputs:          # read before write, also in one slave
            copy_bits(data, lo, got, bit, n)
        return bool(inputs) + wrote * (2 if cmd == 12 else 1)

    def enter(self, state, code=0, error=None, waits=None):
        """@waits: for outputs on the way to OP, until then"""
        self.state, self.waits = state, waits
        self.error = bool(code) if error is None else error
        self.mem[0x130:0x136] = struct.pack("<HHH", state | self.error << 4, 0, code)
        self.mem[0x210] |= 8

    def work(self):
        """What the application does between two frames."""
        now, request = time.monotonic(), self.requested
        self.requested = None
        if request is not None and self.emulated:
            self.enter(request & 0xF, error=bool(request & 0x10))
        elif request is not None and (not self.error or request & 0x10 or request & 0xF == INIT):
            self.request(request & 0xF)         # else first the error is acknowledged
        if self.waits and (self.outputs_at or now > self.waits):
            self.enter(*(OP,) if self.outputs_at else (SAFEOP, 0x0019))
        if self.state == OP and not self.emulated and self.out_sm is not None:
            limit = (u16(self.mem, 0x400) + 2) * 40e-9 * u16(self.mem, 0x420)
            if limit and self.sm(self.out_sm)[2] & 0x40 and now - self.outputs_at > limit:
                self.enter(SAFEOP, 0x001B)
        self.exchange()

    def request(self, new):
        old, stay = self.state, SAFEOP if self.state == OP else self.state
        if new not in PATH + [BOOT]:
            self.enter(stay, 0x0012)
        elif new == BOOT or PATH.index(new) > PATH.index(old) + 1:
            self.enter(stay, 0x0013 if (old, new) == (INIT, BOOT) else 0x0011)
        elif new > old and self.check(old):
            self.enter(old, self.check(old))
        elif (old, new) == (SAFEOP, OP) and self.sizes()[0] and not self.op_only:
            self.outputs_at = None
            self.enter(SAFEOP, waits=time.monotonic() + 1)
        else:
            self.outputs_at = time.monotonic()
            self.enter(new)

    def sizes(self):    # bytes of outputs and of inputs
        return int(self.out_sm is not None), int(self.in_sm is not None)

    def check(self, old):
        """The AL status code that refuses to leave @old upwards."""
        if old == INIT and self.wants_eeprom and not self.mem[0x500] & 1:
            return 0x0050
        for which, direction, size, code in ((self.out_sm, 4, self.sizes()[0], 0x001D),
                                             (self.in_sm, 0, self.sizes()[1], 0x001E)):
            if which is None or old != PREOP:
                continue
            start, length, control, _, active = self.sm(which)
            on = bool(active & 1 and length)
            if on != bool(size and not self.op_only) or on and (
                    length, start) != (size, self.addresses[which]):
                return code
            if on and control & 0x0F != direction:
                return 0x001C
        return 0


class Outputs(Esc):
    out_sm, addresses, fmmus, sms, op_only = 0, {0: 0x1100}, 1, 1, True

    def __init__(self):
        entries = [(0x7000 + 16 * i, 1, 3 + i, 1, 1) for i in range(4)]
        super().__init__(sii(0x0004, 0x0BAD, (0x7E57, 0x4444, 0x10001, 44), None,
                             ["OUT4", "Four outputs", "Out 1", "Out 2", "Out 3", "Out 4"], 0, [1],
                             [(0x1100, 1, 0x44, 0, 9, 3)], {51: [(0x1600, 0, entries)]}))

    def exchange(self):
        wires[0] = self.mem[0x1100] & 0xF if self.state == OP else 0


class Inputs(Esc):
    emulated = read8 = True
    in_sm, addresses, fmmus, sms = 0, {0: 0x1000}, 2, 1

    def __init__(self):
        pdos = [(0x1A00 + i, 0, [(0x6000 + 16 * i, 1, 3 + i, 1, 1)]) for i in range(4)]
        super().__init__(sii(0x0104, 0, (0x7E57, 0x3333, 0x10002, 0), None,
                             ["IN4", "Four inputs", "In 1", "In 2", "In 3", "In 4"], 0, [2, 0],
                             [(0x1000, 1, 0x00, 0, 1, 4)], {50: pdos}))

    def exchange(self):
        self.mem[0x1000] = sum((wires[0] >> i & 1) << (3 - i) for i in range(4))


# access to an entry: bits 0-2 read, 3-5 write, each in PREOP, SAFEOP, OP; 6, 7 mappable
R, W, CONFIG, RX, TX = 7, 0x3F, 0x0F, 0x7F, 0x87
SIZE = {2: 1, 3: 2, 4: 4, 5: 1, 6: 2, 7: 4, 0x1B: 8}     # of data types
Abort = type("Abort", (Exception,), {})
I8, I16, I32, U8, U16, U32, U64, STRING, OCTETS = *SIZE, 9, 0xA


def var(kind, value, access):
    return [kind, value if kind not in SIZE else
            (value & (1 << 8 * SIZE[kind]) - 1).to_bytes(SIZE[kind], "little"), access]


def group(kind, values, access=R):
    """Subindex 0, the number of those behind it, and these."""
    return {0: var(U8, sum(v != 0 for v in values), access),
            **{i + 1: var(kind, v, access) for i, v in enumerate(values)}}


class Axis(Esc):
    wants_eeprom = True
    out_sm, in_sm, addresses = 2, 3, {2: 0x1400, 3: 0x1800}
    mailbox = (0x1000, 256, 0x1200, 192)

    def __init__(self):
        out = [(0x6040, 0, 3, U16, 16), (0x607A, 0, 4, I32, 32)]
        inp = [(0x6041, 0, 5, U16, 16), (0x6064, 0, 6, I32, 32)]
        ident = (0x7E57, 0x402, 0x20003, 0x12345678)
        super().__init__(sii(0x0080, 0, ident, self.mailbox,
                             ["AXIS", "An axis", "Control", "Target", "Status", "Position"],
                             0x0D, [1, 2, 3],
                             [(0x1000, 256, 0x26, 0, 1, 1), (0x1200, 192, 0x22, 0, 1, 2),
                              (0x1400, 0, 0x64, 0, 1, 3), (0x1800, 0, 0x20, 0, 1, 4)],
                             {51: [(0x1600, 2, out)], 50: [(0x1A00, 3, inp)]}))
        maps = [[e[0] << 16 | e[4] for e in some] + [0, 0] for some in (out, inp)]
        # index: {subindex: [type, bytes, access]}
        self.od = {
            0x1000: {0: var(U32, 0x20192, R)}, 0x1001: {0: var(U8, 0, R)},
            0x1008: {0: var(STRING, b"Second model axis", R)}, 0x1018: group(U32, ident),
            0x1600: group(U32, maps[0], CONFIG), 0x1A00: group(U32, maps[1], CONFIG),
            0x1C00: group(U8, (1, 2, 3, 4)),
            0x1C12: group(U16, (0x1600,), CONFIG), 0x1C13: group(U16, (0x1A00,), CONFIG),
            0x2000: {0: var(OCTETS, bytes(range(256)) * 3, W)},
            0x2001: {
                0: var(U8, 7, R), 1: var(U8, 0x81, W), 2: var(I16, -2, W),
                3: var(U32, 0xFEDCBA98, W), 4: var(U64, 0x0123456789ABCDEF, W),
                5: var(U16, 5, R), 6: var(U16, 6, W & ~R), 7: var(STRING, b"abc", W)},
            0x2002: {0: var(U16, 0, W)},
            0x6040: {0: var(U16, 0, RX)}, 0x6041: {0: var(U16, 0, TX)},
            0x6060: {0: var(I8, 0, RX)},
            0x6064: {0: var(I32, 0, TX)}, 0x607A: {0: var(I32, 0, RX)},
        }
        self.queue, self.seen, self.counter, self.last = [], 0, 0, b""
        self.up, self.down, self.toggle = None, None, 0

    def value(self, index, sub=0):
        return int.from_bytes(self.od[index][sub][1], "little")

    def mapped(self, assign):
        """What is mapped now: object and bytes of each entry."""
        for pdo in [self.value(assign, k + 1) for k in range(self.value(assign))]:
            for word in [self.value(pdo, e + 1) for e in range(self.value(pdo))]:
                yield word >> 16, (word & 0xFF) // 8

    def sizes(self):
        return tuple(sum(n for _, n in self.mapped(a)) for a in (0x1C12, 0x1C13))

    def exchange(self):
        at = self.addresses[2]
        for index, n in self.mapped(0x1C12):
            if self.state == OP:
                self.od[index][0][1] = bytes(self.mem[at:at + n])
            at += n
        self.od[0x6041][0] = var(U16, ~self.value(0x6040), TX)
        self.od[0x6064][0] = var(I32, -self.value(0x607A), TX)
        at = self.addresses[3]
        for index, n in self.mapped(0x1C13):
            self.mem[at:at + n] = self.od[index][0][1]
            at += n

    def check(self, old):
        for i, kind in ((0, 6), (1, 2)):
            start, length, control, _, active = self.sm(i)
            has, want = (start, length, control & 0x0F), (*self.mailbox[2 * i:2 * i + 2], kind)
            if old == INIT and (has != want or not active & 1):
                return 0x0016
        if old == INIT:
            self.queue, self.seen, self.counter = [], 0, 0
        return super().check(old)

    def work(self):
        super().work()
        m = self.mem
        if self.state == INIT:
            return
        if m[0x805] & 8:                        # the master wrote a message
            m[0x805] ^= 8
            self.message(bytes(m[0x1000:0x1100]))
        if (m[0x80E] ^ m[0x80F]) & 2:           # it wants the last answer again
            self.queue.insert(0, self.last)
            m[0x80D] &= ~8 & 0xFF
            m[0x80F] ^= 2
        if self.queue and m[0x80E] & 1 and not m[0x80D] & 8:
            self.last = self.queue.pop(0)
            m[0x1200:0x12C0] = self.last + bytes(192 - len(self.last))
            m[0x80D] |= 8

    def send(self, kind, data):
        self.counter = self.counter % 7 + 1
        self.queue.append(struct.pack("<HHBB", len(data), 0, 0, kind | self.counter << 4) + data)

    def message(self, msg):
        n, _, channel, kind = struct.unpack_from("<HHBB", msg)
        if kind & 0x80 or channel:
            fault("reserved bits in a mailbox header")
        if kind >> 4 and kind >> 4 == self.seen:
            return                              # a repetition
        self.seen = kind >> 4
        coe, d = u16(msg, 6), msg[8:6 + n]
        error = 8 if n > 250 else 2 if kind & 0xF != 3 else 6 if n < 10 else 4
        if error != 4 or coe >> 12 != 2:
            return self.send(0, struct.pack("<HH", 1, error))
        if coe & 0x0FFF:
            fault("number or reserved bits in a CoE header")
        command, index, sub = struct.unpack_from("<BHB", d)
        if command >> 5 in (0, 3):
            index, sub = (self.up or self.down or (0, 0))[:2]
        try:
            self.sdo(command, index, sub, d)
        except Abort as e:
            self.up = self.down = None
            self.send(3, struct.pack("<HBHBI", 2 << 12, 0x80, index, sub, e.args[0]))

    def reply(self, data):
        self.send(3, struct.pack("<H", 3 << 12) + data + bytes(max(0, 8 - len(data))))

    def entry(self, index, sub):
        if index not in self.od or sub not in self.od[index]:
            raise Abort(0x06090011 if index in self.od else 0x06020000)
        return self.od[index][sub]

    def sdo(self, command, index, sub, d):
        what = command >> 5
        if what == 4:
            self.up = self.down = None
        elif what > 4 or what in (0, 3) and not (self.up if what else self.down):
            raise Abort(0x05040001)
        elif what in (0, 3):
            if command & 0x10 != self.toggle:
                raise Abort(0x05030000)
            (self.upload_segment if what else self.download_segment)(command, index, sub, d)
            self.toggle ^= 0x10
        elif command & 0x10:
            raise Abort(0x06010000)             # no complete access
        else:
            e, may = self.entry(index, sub), {PREOP: 1, SAFEOP: 2, OP: 4}[self.state]
            self.toggle, self.up, self.down = 0, None, None
            (self.upload if what == 2 else self.download)(command, index, sub, d, e, may)

    def upload(self, command, index, sub, d, e, may):
        if command & 0x0F or d[4:8] != bytes(4):
            fault("reserved bits in an upload request")
        if not e[2] & may:
            raise Abort(0x06010001)
        data, room = e[1], self.mailbox[3] - 16
        if 0 < len(data) <= 4:
            return self.reply(struct.pack("<BHB", 0x43 | 4 - len(data) << 2, index, sub) + data)
        self.reply(struct.pack("<BHBI", 0x41, index, sub, len(data)) + data[:room])
        self.up = (index, sub, data[room:]) if len(data) > room else None

    def upload_segment(self, command, index, sub, d):
        room = self.mailbox[3] - 9
        part, rest = self.up[2][:room], self.up[2][room:]
        unused = max(0, 7 - len(part))
        self.reply(bytes([self.toggle | unused << 1 | (not rest)]) + part + bytes(unused))
        self.up = (index, sub, rest) if rest else None

    def download(self, command, index, sub, d, e, may):
        if not command & 1:
            fault("download without its size")
        if not e[2] & may << 3:
            raise Abort(0x08000022 if e[2] & 0x38 else 0x06010002)
        size = 4 - (command >> 2 & 3) if command & 2 else struct.unpack_from("<I", d, 4)[0]
        data = d[4:4 + size] if command & 2 else d[8:]
        if size > 1024 or len(data) > size:
            raise Abort(0x06070012)
        if len(data) == size:
            self.set(index, sub, data)
        else:
            self.down = (index, sub, size, data)
            if len(data) != self.mailbox[1] - 16:
                fault("a first download message that is not full")
        self.reply(struct.pack("<BHBI", 0x60, index, sub, 0))

    def download_segment(self, command, index, sub, d):
        size, have = self.down[2], self.down[3] + d[1:len(d) - (command >> 1 & 7)]
        if len(have) > size or (command & 1 and len(have) != size):
            raise Abort(0x06070010)
        self.down = None if command & 1 else (index, sub, size, have)
        if command & 1:
            self.set(index, sub, have)
        self.reply(bytes([0x20 | self.toggle]))

    def set(self, index, sub, data):
        e, word = self.entry(index, sub), int.from_bytes(data, "little")
        if e[0] in SIZE and len(data) != len(e[1]):
            raise Abort(0x06070012 if len(data) > len(e[1]) else 0x06070013)
        assign = {0x1600: 0x1C12, 0x1A00: 0x1C13}.get(index)
        if assign and self.value(assign):
            raise Abort(0x08000022)             # no change while it is assigned
        if assign or index in (0x1C12, 0x1C13):
            target = self.od.get(word >> 16, {0: [0, b"", 0]})[0]
            if sub and self.value(index):
                raise Abort(0x06010003)         # subindex 0 first
            if not sub and word >= len(self.od[index]):
                raise Abort(0x06090031)
            if sub and assign and not target[2] & (0x40 if index == 0x1600 else 0x80):
                raise Abort(0x06040041)
            if sub and assign and word & 0xFFFF != 8 * len(target[1]):
                raise Abort(0x06040043)
            if sub and not assign and word != (0x1600 if index == 0x1C12 else 0x1A00):
                raise Abort(0x06090030)
        e[1] = data
        if index == 0x2002:                     # before the answer
            self.send(3, struct.pack("<HHB", 1 << 12, word, 0x81) + b"mimes")


def execute(slave, cmd, adp, ado, data):
    """One datagram at one slave: the new address and what the counter gains."""
    if cmd in (10, 11, 12):
        return adp, slave.logical(cmd, ado << 16 | adp, data)
    by_address, multiple, sent, gain = cmd in (4, 5, 6, 14), cmd in (13, 14), bytes(data), 0
    names = (u16(slave.mem, 0x10), u16(slave.mem, 0x12) if slave.mem[0x103] & 1 else None)
    mine = adp in names if by_address else adp == 0 or cmd in (7, 8, 9)
    if mine and cmd not in (2, 5, 8):
        got = slave.read(ado, len(data))
        if got is not None:
            data[:] = bytes(a | b for a, b in zip(got, sent)) if cmd in (7, 9) else got
            gain = 1
    if (mine and cmd not in (1, 4, 7) and not multiple) or (multiple and not mine):
        if slave.write(ado, sent):
            gain += 2 if cmd in (3, 6, 9) else 1
    return adp if by_address else adp + 1 & 0xFFFF, gain


def plug(line, cable, whole):
    for i, port in ((cable - 1, 1), (cable, 0)):
        if 0 <= i < len(line):
            line[i].link[port] = whole
            line[i].dl_status()


def route(line, end):
    """Slaves that process a frame from this end (1: the second one), the end where it leaves
    (None: nowhere), and is it marked as circulating. The processing unit is behind port 0:
    a frame that comes in by port 1 meets it only if it cannot leave by port 0."""
    at, port, through, circulates = (len(line) - 1 if end else 0), end, [], False
    while 0 <= at < len(line):
        slave = line[at]
        if not slave.open[port]:
            return through, None, circulates
        if port and slave.open[0]:
            at -= 1
            continue
        if port and circulates:                 # twice at such a port
            return through, None, circulates
        circulates |= bool(port)
        through.append(slave)
        port = int(not slave.open[1])
        at += -1 if port else 1
    return through, int(at >= 0), circulates


def process(line, frame, circulates=False):
    """All datagrams of a frame at the slaves of its way."""
    word, at, more = u16(frame, 14), 16, True
    end = at + (word & 0x7FF)
    if word >> 11 != 2 or end > len(frame):
        return fault("EtherCAT header 0x%04x of a frame of %u bytes" % (word, len(frame)))
    while more:
        cmd, _, adp, ado, n, irq = struct.unpack_from("<BBHHHH", frame, at)
        more, size = n & 0x8000, n & 0x7FF
        if n & 0x7800 or irq or at + 12 + size > end or cmd > 14:
            return fault("datagram header: command %u, length 0x%04x, irq 0x%04x" % (cmd, n, irq))
        data, wkc = frame[at + 10:at + 10 + size], u16(frame, at + 10 + size)
        if wkc:
            fault("a working counter that is not 0")
        for slave in line:
            if cmd:
                adp, gain = execute(slave, cmd, adp, ado, data)
                wkc += gain
            irq |= u16(slave.mem, 0x210) & u16(slave.mem, 0x200)
        n |= 0x4000 * circulates
        struct.pack_into("<HHHH", frame, at + 2, adp, ado, n, irq)
        frame[at + 10:at + 12 + size] = data + struct.pack("<H", wkc)
        at += 12 + size
    if at != end or any(frame[end:]):
        fault("bytes behind the datagrams that are not 0, or a wrong length")
    frame[6] |= 2 * bool(line)                  # it went through a processing unit
    return True


def end_of(interface):
    s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x88A4))
    s.bind((interface, 0x88A4))
    return s


def receive(line, ends, end):
    """A frame at one end, which leaves at one of them."""
    try:
        data, where = ends[end].recvfrom(2048)
        if where[2] == socket.PACKET_OUTGOING:
            return 0
        frame, (through, leaves, circulates) = bytearray(data), route(line, end)
        if process(through, frame, circulates) and leaves is not None:
            ends[leaves].send(frame)
    except (OSError, IndexError):               # an interface without link, or none
        return 0
    return 1


def main():
    ends = [end_of(name) for name in (sys.argv[1], *sys.argv[3:])]
    line = [Outputs(), Inputs(), Axis()]
    for cable in range(len(line) + len(ends) - 1):
        plug(line, cable, True)
    for i, slave in enumerate(line):
        with open("%s/%d.bin" % (sys.argv[2], i), "wb") as f:
            f.write(slave.image)
    tell = "%s/tell" % sys.argv[2]
    os.mkfifo(tell)
    tell = os.open(tell, os.O_RDWR)
    stop, frames = [], 0
    signal.signal(signal.SIGTERM, lambda *_: stop.append(1))
    print("ready", flush=True)
    while not stop:
        for which in select.select([*ends, tell], [], [], 0.005)[0]:
            if which is not tell:
                frames += receive(line, ends, ends.index(which))
                continue
            for command in os.read(tell, 100).decode().splitlines():
                what, cable = command.split()
                plug(line, int(cable), what == "heal")
        for slave in line:
            slave.work()
    for text, n in sorted(faults.items()):
        print("fault: %s (%d)" % (text, n))
    print("%d frames, %d faults" % (frames, len(faults)), flush=True)


if __name__ == "__main__":
    main()
