# SPDX-License-Identifier: GPL-2.0-only
"""The application of why.py: configures what the bus has, but for deliberate mistakes."""
import ctypes as c
import os
import threading
import time

PERIOD_NS = 2000000
SHORT_US = 10                           # shorter than the frames of a cycle
DOMAINS = 3
SYNC_REFERENCE, SYNC_SLAVES = 2, 4      # EC_CYCLE_*
STALLS = ("hold", "zero", "stop")       # in the order of EC_CYCLE_HOLD...
OWN = ("short", "own", "late")
GIVEN = 2000                            # cycles with outputs before an output stall
PREOP, SAFEOP = 2, 4
ONLINE = 1                              # of ec_slave_config_state_t


class Cycle(c.Structure):
    """ec_cycle_config_t"""
    _fields_ = [("period_ns", c.c_uint32), ("phase_ns", c.c_uint32), ("cpu", c.c_int32),
                ("priority", c.c_uint32), ("stall", c.c_int), ("stall_cycles", c.c_uint32),
                ("dc", c.c_uint32), ("flags", c.c_uint32)]


class Slave:
    """What is configured for a slave; faults change it."""

    def __init__(self, info, syncs):
        self.position = info["position"]
        self.alias = 0
        self.vendor = info["vendor_id"]
        self.product = info["product_code"]
        self.syncs = syncs              # SyncManagers with PDOs
        self.sdos = []                  # (index, subindex, value)
        self.sync0 = None               # (AssignActivate, cycle time)
        self.other_pdo = False
        self.timeout_ms = 0
        self.sdo_timeout_ms = 0
        self.offset = None              # behind the slave with the alias; None: as without
        self.watchdog = 0               # units of 100 us

    @property
    def domain(self):
        return self.position % DOMAINS


class Application:
    """The kernel runs its cycle, so that it needs no time of its own."""

    def __init__(self, library):
        self.lib = c.CDLL(library)
        for name in ("ecrt_request_master", "ecrt_master_create_domain",
                     "ecrt_master_slave_config"):
            getattr(self.lib, name).restype = c.c_void_p
        self.master = None
        self.thread = None

    def call(self, name, *args):
        """A function that returns 0 or more."""
        if getattr(self.lib, name)(*args) < 0:
            raise RuntimeError(f"{name} failed")

    def start(self, slaves, cycle):
        """Reserve, configure, activate.

        cycle: "kernel": it runs the cycle; "hold", "zero", "stop": it does, the application gives
        outputs for a moment only, and the kernel does this then; "short": the application, with an
        interval that is too short; "own": the application; "late": it misses cycles; "none": no
        cycle.
        """
        self.master = c.c_void_p(self.lib.ecrt_request_master(0))
        if not self.master:
            raise RuntimeError("master not reserved")
        self.domains = [c.c_void_p(self.lib.ecrt_master_create_domain(self.master))
                        for _ in range(DOMAINS)]
        for s in slaves:
            self.configure(s, self.domains[s.domain])
        if cycle in ("kernel", *STALLS):
            config = Cycle(period_ns=PERIOD_NS, cpu=-1, dc=SYNC_REFERENCE | SYNC_SLAVES)
            if cycle in STALLS:
                config.stall, config.stall_cycles = STALLS.index(cycle), 10
            self.call("ecrt_master_set_cycle", self.master, c.byref(config))
        if cycle in OWN:
            self.call("ecrt_master_set_send_interval", self.master,
                      c.c_size_t(SHORT_US if cycle == "short" else PERIOD_NS // 1000))
        self.call("ecrt_master_activate", self.master)
        if cycle in OWN + STALLS:
            self.running = True
            self.thread = threading.Thread(target=self.run, args=(cycle,))
            self.thread.start()

    def run(self, cycle):
        """A cycle of the application, or outputs for that of the kernel."""
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(50))
        n = 0
        due = time.clock_gettime(time.CLOCK_MONOTONIC)
        while self.running:
            self.lib.ecrt_master_receive(self.master)
            for d in self.domains:
                self.lib.ecrt_domain_process(d)
                self.lib.ecrt_domain_queue(d)
            self.lib.ecrt_master_send(self.master)
            n += 1
            if cycle in STALLS and n == GIVEN:
                break
            due += PERIOD_NS / 1e9 * (6 if cycle == "late" and not n % 20 else 1)
            time.sleep(max(0, due - time.clock_gettime(time.CLOCK_MONOTONIC)))

    def pause(self):
        """No more frames."""
        self.running = False
        self.thread.join()

    def configure(self, s, domain):
        """One slave."""
        bit, state = c.c_uint(), c.c_uint()
        config = c.c_void_p(self.lib.ecrt_master_slave_config(
            self.master, s.alias, s.position if s.offset is None else s.offset,
            c.c_uint32(s.vendor), c.c_uint32(s.product)))
        if not config:
            raise RuntimeError(f"slave {s.position} not configured")
        if s.other_pdo:
            # the fixed drive has more entries, in another order
            self.call("ecrt_slave_config_pdo_assign_clear", config, 2)
            self.call("ecrt_slave_config_pdo_assign_add", config, 2, 0x1600)
            self.call("ecrt_slave_config_pdo_mapping_clear", config, 0x1600)
            self.call("ecrt_slave_config_pdo_mapping_add", config, 0x1600, 0x60ff, 0, 32)
        # without a slave there are no PDOs to register by position
        self.call("ecrt_slave_config_state", config, c.byref(state))
        for sync in s.syncs if state.value & ONLINE else []:
            self.call("ecrt_slave_config_reg_pdo_entry_pos", config, sync, 0, 0, domain,
                      c.byref(bit))
        for index, sub, value in s.sdos:
            self.call("ecrt_slave_config_sdo32", config, index, sub, c.c_uint32(value))
        if s.sync0:
            self.call("ecrt_slave_config_dc", config, s.sync0[0], c.c_uint32(s.sync0[1]), 0, 0, 0)
        if s.watchdog:
            self.call("ecrt_slave_config_watchdog", config, 2498, s.watchdog)
        if s.sdo_timeout_ms:
            self.call("ecrt_slave_config_sdo_timeout", config, s.sdo_timeout_ms)
        if s.timeout_ms:
            self.call("ecrt_slave_config_state_timeout", config, PREOP, SAFEOP, s.timeout_ms)

    def stop(self):
        """Release the master; its slaves go back to PREOP."""
        if self.thread:
            self.running = False
            self.thread.join()
            self.thread = None
        if self.master:
            self.lib.ecrt_release_master(self.master)
        self.master = None
