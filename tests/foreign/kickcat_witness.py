# SPDX-License-Identifier: GPL-2.0-only
"""kickcat, a master that shares nothing with this project, on the segment "bench", then
at both ends of a ring. EC_SIM: the program that simulates it, with options. One TAP line for each case."""

import os
import shlex
import subprocess
import sys
import tempfile
import time

import kickcat
from kickcat import PARTIAL, State

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "pysoem"))
import bench  # noqa: E402
import kickcat_ring  # noqa: E402

passed = failed = 0


def case(name, run):
    global passed, failed
    try:
        run()
    except Exception as e:  # whatever a foreign library throws
        failed += 1
        print("not ok kickcat: %s\n# %s: %s" % (name, type(e).__name__, e), flush=True)
        return
    passed += 1
    print("ok kickcat:", name, flush=True)


def same(found, expected):
    if found != expected:
        raise AssertionError("%r, expected %r" % (found, expected))


class Bus:
    def __init__(self):
        link = kickcat.create_link("veth0", "")
        link.set_timeout(0.02)
        self.bus = kickcat.Bus(link)

    def scan(self):
        self.bus.init(0.5)
        self.slaves = self.bus.slaves()
        same(len(self.slaves), len(bench.SLAVES))
        same({self.bus.get_state(s) for s in self.slaves}, {State.PREOP})

    def sdo(self, pos, index, sub, size=4):
        return self.bus.read_sdo(self.slaves[pos], index, sub, PARTIAL, size, 2.0)

    def sdos(self):
        for pos in (bench.AI, bench.AXIS1, bench.WAGO_IO, bench.DRIVE1):
            name, ident, _, _ = bench.SLAVES[pos]
            same(tuple(int.from_bytes(self.sdo(pos, 0x1018, i), "little") for i in (1, 2)), ident)
            same(self.sdo(pos, 0x1008, 0, 64).rstrip(b"\0").decode(), name)

    def refused(self):
        try:
            self.bus.read_sdo(self.slaves[bench.DRIVE1], 0x5555, 0, PARTIAL, 4, 0.3)
        except (RuntimeError, kickcat.ErrorCoE):
            return self.sdos()  # it goes on as before
        raise AssertionError("0x5555 was read")

    def dictionary(self):
        name, text = self.bus.read_object_description(self.slaves[bench.AXIS1], 0x1018)
        same((name, "max subindex: 4" in text, "RECORD" in text), ("Identity", True, True))
        name, text = self.bus.read_entry_description(self.slaves[bench.AXIS1], 0x1018, 2)
        same((name, "bit length:    32" in text), ("Product code", True))

    def operation(self):
        self.bus.create_mapping(4096)
        same([(s.output_size, s.input_size) for s in self.slaves],
             [(o, i) for _, _, o, i in bench.SLAVES])
        self.bus.request_state(State.SAFE_OP)
        self.bus.wait_for_state(State.SAFE_OP, 10.0)
        for s in self.slaves:
            s.set_output_bytes(bytes(s.output_size))
        self.bus.process_data()
        self.bus.request_state(State.OPERATIONAL)
        self.bus.wait_for_state(State.OPERATIONAL, 10.0, self.bus.process_data)

    def wires(self):
        for out, bit, to, at in bench.DIGITAL_WIRES:
            for value in (1, 0, 1, 0):
                self.slaves[out].set_output_bytes(bytes([value << bit]))
                for _ in range(20):  # it throws when a working counter is wrong
                    self.bus.process_data()
                    time.sleep(0.001)
                same(self.slaves[to].input_data[0] >> at & 1, value)

    def end(self):
        self.bus.request_state(State.INIT)
        self.bus.wait_for_state(State.INIT, 10.0)


# it ends with this process, however that ends
sim = subprocess.Popen(["setpriv", "--pdeathsig", "KILL"] + shlex.split(os.environ["EC_SIM"]) +
                       ["veth1"], stdout=subprocess.PIPE, text=True)
sim.stdout.readline()
bus = Bus()
for what, method in (("scan to PREOP", bus.scan), ("SDOs", bus.sdos),
                     ("an SDO is refused", bus.refused), ("object dictionary", bus.dictionary),
                     ("mapping and OP", bus.operation),
                     ("outputs come back as inputs", bus.wires), ("INIT", bus.end)):
    case(what, method)
sim.terminate()
said = sim.communicate(timeout=10)[0]
case("no frame is lost", lambda: same((sim.returncode, " 0 lost in the segment, 0 dropped" in said),
                                      (0, True)))
with tempfile.TemporaryDirectory() as folder:
    for what, method in kickcat_ring.cases(kickcat_ring.Ring(os.environ["EC_SIM"], folder)):
        case(what, method)
print("%d passed, %d failed" % (passed, failed))
sys.exit(failed > 0)
