# SPDX-License-Identifier: GPL-2.0-only
"""The application of ring.bats: outputs that are wired to inputs, in a cycle of its own.

ring_app.py LIBRARY PERIOD_MS SLAVES: EL2008 and EL1008 by turns; prints twice a second what it has
seen since its begin. Input 1 of each EL1008 follows output 1 of an EL2008.
"""
import ctypes as c
import os
import signal
import sys
import time

BECKHOFF, EL2008, EL1008 = 2, 0x07d83052, 0x03f03052
OUTPUT, INPUT = 0x7000, 0x6000
COMPLETE = 2                            # EC_WC_COMPLETE
LEVEL = 20                              # cycles with the same outputs
DELAY = 3                               # cycles until inputs have them


class DomainState(c.Structure):
    """ec_domain_state_t"""
    _fields_ = [("wkc", c.c_uint), ("state", c.c_int), ("redundancy_active", c.c_uint)]


def main(library, period, slaves):
    """Until SIGTERM."""
    lib = c.CDLL(library)
    for name in ("ecrt_request_master", "ecrt_master_create_domain", "ecrt_master_slave_config"):
        getattr(lib, name).restype = c.c_void_p
    lib.ecrt_domain_data.restype = c.POINTER(c.c_uint8)
    master = c.c_void_p(lib.ecrt_request_master(0))
    domain = c.c_void_p(lib.ecrt_master_create_domain(master))
    places = []                         # byte, mask, is output
    for i in range(slaves):
        out = not i % 2
        config = c.c_void_p(lib.ecrt_master_slave_config(
            master, 0, i, BECKHOFF, c.c_uint32(EL2008 if out else EL1008)))
        bit = c.c_uint()
        byte = lib.ecrt_slave_config_reg_pdo_entry(config, OUTPUT if out else INPUT, 1, domain,
                                                   c.byref(bit))
        if byte < 0:
            raise RuntimeError(f"slave {i}: {byte}")
        places.append((byte, 1 << bit.value, out))
    lib.ecrt_master_set_send_interval(master, c.c_size_t(period * 1000))
    if lib.ecrt_master_activate(master):
        raise RuntimeError("not activated")
    data = lib.ecrt_domain_data(domain)
    running = [True]
    signal.signal(signal.SIGTERM, lambda *_: running.clear())
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(50))
    state = DomainState()
    cycles = incomplete = wrong = 0     # since all slaves were in OP
    steady = 0                          # complete cycles in a row
    due = time.clock_gettime(time.CLOCK_MONOTONIC)
    while running:
        lib.ecrt_master_receive(master)
        lib.ecrt_domain_process(domain)
        lib.ecrt_domain_state(domain, c.byref(state))
        level = cycles // LEVEL % 2
        if cycles or state.state == COMPLETE:
            cycles += 1
            incomplete += state.state != COMPLETE
            steady = steady + 1 if state.state == COMPLETE else 0
            if cycles % LEVEL > DELAY and steady > DELAY:
                wrong += any(bool(data[at] & mask) != level
                             for at, mask, out in places if not out)
        for at, mask, out in places:
            if out:
                data[at] = mask if cycles // LEVEL % 2 else 0
        lib.ecrt_domain_queue(domain)
        lib.ecrt_master_send(master)
        if cycles % (500 // period) == 1:
            print(f"cycles={cycles} incomplete={incomplete} wrong={wrong} "
                  f"redundancy_active={state.redundancy_active}", flush=True)
        due += period / 1000
        time.sleep(max(0, due - time.clock_gettime(time.CLOCK_MONOTONIC)))
    lib.ecrt_release_master(master)


main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
