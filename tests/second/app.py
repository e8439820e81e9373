# SPDX-License-Identifier: GPL-2.0-only
"""An application for the three slaves of slaves.py: takes them to OP with another mapping
of the axis, exchanges values, compares. Prints what is not as it has to be.

usage: app.py LIBETHERCAT CYCLES [INCOMPLETE]

CYCLES: values, each for four cycles; SIGTERM ends it earlier. INCOMPLETE: so many cycles may have
an incomplete working counter, none of them right after another one."""

import ctypes as c
import signal
import struct
import sys
import time

lib = c.CDLL(sys.argv[1])
P, UINT, VENDOR = c.c_void_p, c.c_uint, 0x7E57
for name in ("request_master", "master_create_domain", "master_slave_config", "domain_data"):
    getattr(lib, "ecrt_" + name).restype = P
OUTPUT, INPUT, COMPLETE, OP = 1, 2, 2, 8


class Entry(c.Structure):
    _fields_ = [("index", c.c_uint16), ("subindex", c.c_uint8), ("bits", c.c_uint8)]


class Pdo(c.Structure):
    _fields_ = [("index", c.c_uint16), ("n", UINT), ("entries", c.POINTER(Entry))]


class Sync(c.Structure):
    _fields_ = [("index", c.c_uint8), ("dir", c.c_int), ("n", UINT), ("pdos", c.POINTER(Pdo)),
                ("watchdog", c.c_int)]


class DomainState(c.Structure):
    _fields_ = [("counter", UINT), ("wc", c.c_int), ("redundancy", UINT)]


def need(ok, what):
    if not ok:
        print("not so:", what)
        sys.exit(1)


def sync(index, direction, pdo, *entries):
    pdo = Pdo(pdo, len(entries), (Entry * len(entries))(*(Entry(i, 0, b) for i, b in entries)))
    return Sync(index, direction, 1, c.pointer(pdo), 0)


master = P(lib.ecrt_request_master(0))
need(master, "the master is reserved")
domain = P(lib.ecrt_master_create_domain(master))
slaves = [P(lib.ecrt_master_slave_config(master, alias, position, UINT(VENDOR), UINT(product)))
          for alias, position, product in ((0x0BAD, 0, 0x4444), (0, 1, 0x3333), (0, 2, 0x402))]
need(domain and all(slaves), "domain and configurations")
# an entry more, and the inputs in another order
syncs = (Sync * 3)(sync(2, OUTPUT, 0x1600, (0x6040, 16), (0x607A, 32), (0x6060, 8)),
                   sync(3, INPUT, 0x1A00, (0x6064, 32), (0x6041, 16)), Sync(0xFF, 0, 0, None, 0))
need(lib.ecrt_slave_config_pdos(slaves[2], 3, syncs) == 0, "the mapping is accepted")


def at(slave, index, sub):
    bit = UINT()
    offset = lib.ecrt_slave_config_reg_pdo_entry(slaves[slave], c.c_uint16(index), c.c_uint8(sub),
                                                 domain, c.byref(bit))
    need(offset >= 0, "0x%04x of slave %u is registered" % (index, slave))
    return offset, bit.value


outs = [at(0, 0x7000 + 16 * i, 1) for i in range(4)]
ins = [at(1, 0x6000 + 16 * i, 1) for i in range(4)]
control, target, mode, status, position = (
    at(2, i, 0)[0] for i in (0x6040, 0x607A, 0x6060, 0x6041, 0x6064))
need(lib.ecrt_master_activate(master) == 0, "activated")
data = (c.c_uint8 * lib.ecrt_domain_size(domain)).from_address(lib.ecrt_domain_data(domain))


def cycle():
    lib.ecrt_master_receive(master)
    lib.ecrt_domain_process(domain)
    state = DomainState()
    lib.ecrt_domain_state(domain, c.byref(state))
    return state


def send():
    lib.ecrt_domain_queue(domain)
    lib.ecrt_master_send(master)
    time.sleep(0.02)


def states():
    state, found = (UINT * 4)(), []
    for s in slaves:
        need(lib.ecrt_slave_config_state(s, state) == 0, "states can be read")
        found.append((state[0] & 1, state[0] >> 1 & 1, state[0] >> 2 & 15))
    return found


for _ in range(1000):
    s = cycle()
    if states() == [(1, 1, OP)] * 3 and s.wc == COMPLETE:
        break
    send()
else:
    need(False, "OP with a complete working counter: %u, (online, operational, state): %s" %
         (s.counter, states()))

may_lack = int((sys.argv + ["0"])[3])
lacked = exchanged = 0
before, stop = True, []     # the last cycle was complete
signal.signal(signal.SIGTERM, lambda *_: stop.append(1))
for n in range(int(sys.argv[2])):
    if stop:
        break
    value, word, goal = n * 7 & 15, n * 12345 & 0xFFFF, (n - 20) * 1234567
    for i, (byte, bit) in enumerate(outs):
        data[byte] = data[byte] & ~(1 << bit) | (value >> i & 1) << bit
    data[control:control + 2] = struct.pack("<H", word)
    data[target:target + 4] = struct.pack("<i", goal)
    data[mode] = n & 0x7F
    for _ in range(4):      # there, through the slaves, back
        send()
        s = cycle()
        # one LRW: 2 for the outputs, 1 for the inputs, 3 for the axis
        complete = (s.wc, s.counter) == (COMPLETE, 6)
        lacked += not complete
        need(complete or before and lacked <= may_lack,
             "the working counter is 6, not %u, in cycle %u" % (s.counter, 4 * n))
        before = complete
    got = [data[byte] >> bit & 1 for byte, bit in ins]
    need(got == [value >> 3 - i & 1 for i in range(4)], "%u comes back as %s" % (value, got))
    got = struct.unpack("<H", bytes(data[status:status + 2]))[0]
    need(got == ~word & 0xFFFF, "control 0x%04x comes back as 0x%04x" % (word, got))
    got = struct.unpack("<i", bytes(data[position:position + 4]))[0]
    need(got == -goal, "target %d comes back as %d" % (goal, got))
    exchanged += 1
    if n == 5:
        print("in operation", flush=True)
lib.ecrt_release_master(master)
if lacked:
    print("incomplete:", lacked)
print("exchanged", exchanged)
