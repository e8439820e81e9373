# SPDX-License-Identifier: GPL-2.0-only
"""A ring of five slaves at two interfaces of ethercat-sim, and kickcat as a master that
sends at both of them: cables are cut and healed while its process data run."""

import os
import random
import shlex
import subprocess
import time

import kickcat
from kickcat import State

SEGMENT = """repeat 5 slave io EL1859
wire io5.1 -> master.1
connect io1.1 -> io5.2
connect io5.1 -> io1.2
"""
# between two slaves at each place, then at the ends, where an interface hears nobody
CABLES = ("io1.1", "io2.1", "io3.1", "io4.1", "io1.0", "io5.1")


class Ring:
    def __init__(self, sim, folder):
        self.sim, self.control = sim, os.path.join(folder, "ring.sock")
        segment = os.path.join(folder, "ring.seg")
        with open(segment, "w") as f:
            f.write(SEGMENT)
        self.process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "KILL"] + shlex.split(sim) +
            ["-s", segment, "--control", self.control, "veth1", "veth3"],
            stdout=subprocess.PIPE, text=True)
        self.process.stdout.readline()

    def tell(self, *words):
        subprocess.run(shlex.split(self.sim) + ["--tell", self.control, *words], check=True)

    def cycles(self, number, strict=True):
        """how many of them had a wrong working counter or did not come back"""
        bad = 0
        for _ in range(number):
            try:
                self.bus.process_data()
            except RuntimeError as e:
                if strict:
                    raise
                bad, self.why = bad + 1, e
            time.sleep(0.001)
        return bad

    def to_op(self):
        link = kickcat.create_link("veth0", "veth2")
        link.set_timeout(0.02)
        self.bus = kickcat.Bus(link)
        self.bus.init(0.5)
        self.slaves = self.bus.slaves()
        if len(self.slaves) != 5:
            raise AssertionError("%d slaves, expected 5" % len(self.slaves))
        self.bus.create_mapping(4096)
        self.bus.request_state(State.SAFE_OP)
        self.bus.wait_for_state(State.SAFE_OP, 10.0)
        self.bus.request_state(State.OPERATIONAL)
        self.bus.wait_for_state(State.OPERATIONAL, 10.0, self.bus.process_data)
        self.exchange()

    def exchange(self):
        """outputs of both ends arrive at the other one, all working counters are right"""
        for value in (1, 0, 1):
            self.slaves[0].set_output_bytes(bytes([value]))
            self.slaves[4].set_output_bytes(bytes([1 - value]))
            self.cycles(20)
            found = self.slaves[4].input_data[0] >> 1 & 1, self.slaves[0].input_data[0] >> 1 & 1
            if found != (value, 1 - value):
                raise AssertionError("inputs %r, expected %r" % (found, (value, 1 - value)))

    def cut(self, cable):
        """frames on their way at that moment may be lost, no other"""
        for what in ("cut", "heal"):
            self.tell(what, cable)
            if self.cycles(20, strict=False) > 2:
                raise AssertionError("%s %s: %s" % (what, cable, self.why))
            self.exchange()
        if {self.bus.get_state(s) for s in self.slaves} != {State.OPERATIONAL}:
            raise AssertionError("a slave has left OP")

    def end(self):
        self.process.terminate()
        said = self.process.communicate(timeout=10)[0]
        if self.process.returncode or " 0 dropped" not in said:
            raise AssertionError(said)


def cases(ring):
    seed = int(os.environ.get("SEED") or time.time())
    yield "ring: to OP; SEED=%u" % seed, ring.to_op
    for cable in random.Random(seed).sample(2 * CABLES, 2 * len(CABLES)):
        yield "ring: %s is cut and heals" % cable, lambda c=cable: ring.cut(c)
    yield "ring: end", ring.end
