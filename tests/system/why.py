#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Faults at random places of a simulated segment; does 'ethercat why' name cause and place?

usage: why.py TOOL LIBRARY CONTROL SEED

Each case injects one fault, or two at different places, runs an application and compares all
findings with what was injected: a cause too many is as wrong as one too few. What is expected
is derived from the kind of fault, its place and the topology. Cases without a fault must have
no finding. Prints a TAP line for each group and the figures.
"""
import json
import random
import subprocess
import sys
import time

from why_app import Application, Slave

# name, device, options, parent, port there; in ring order
SEGMENT = [
    ("s0", "EK1100", "", None, 0),
    ("s1", "EL2008", "", "s0", 1),
    ("s2", "EL3062", "", "s1", 1),
    ("s3", "drive", "in=8 out=8 mapping=fixed", "s2", 1),
    ("s4", "EL1008", "", "s3", 1),
    ("s5", "EL4002", "", "s4", 1),
    ("s6", "drive", "in=12 out=12 mapping=fixed", "s5", 1),
    ("s7", "EL1859", "", "s6", 1),
    ("s8", "drive", "in=16 out=16 mapping=fixed", "s7", 1),
    ("s9", "EL1004", "dc=none", "s8", 1),
    ("s10", "EL2004", "dc=none", "s0", 2),
    ("s11", "drive", "in=20 out=20 mapping=fixed", "s10", 1),
]
N = len(SEGMENT)
INDEX = {s[0]: i for i, s in enumerate(SEGMENT)}
PARENT = [INDEX.get(s[3]) for s in SEGMENT]
PORT = [s[4] for s in SEGMENT]
DRIVES = [3, 6, 8, 11]
COE = DRIVES + [2, 5]
SAME_LINE = range(2, 10)        # a cut there takes slaves from the middle of the ring
SINGLE, DOUBLE, NONE = 48, 12, 10
SETTLE_S = 5
NO_OBJECT = 0x06020000


def behind(i, top):
    """Is slave i slave top or connected behind it?"""
    while i is not None and i != top:
        i = PARENT[i]
    return i is not None


class Bench:
    """Tool, simulator, application and what is configured in a case."""

    def __init__(self, tool, library, control):
        self.tool = tool
        self.control = control
        self.app = Application(library)
        self.infos = self.ethercat_json("slaves")["masters"][0]["slaves"]
        pdos = self.ethercat_json("pdos")["masters"][0]["slaves"]
        self.syncs = [[m["index"] for m in s["sync_managers"]
                       if any(e for p in m["pdos"] for e in p["entries"])] for s in pdos]
        self.slaves = []
        self.fresh()

    def fresh(self):
        """What is on the bus is configured."""
        self.slaves = [Slave(i, s) for i, s in zip(self.infos, self.syncs)]

    def sim(self, *statements):
        """Statements for the running segment."""
        for s in statements:
            with open(self.control, "w", encoding="ascii") as f:
                f.write(s + "\n")

    def ethercat(self, *args):
        """stdout of a command, whatever its exit code."""
        return subprocess.run([self.tool, *args], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              check=False, text=True)

    def ethercat_json(self, *args):
        """Its JSON."""
        r = self.ethercat(*args, "--json")
        return json.loads(r.stdout) if r.stdout else {}

    def why(self):
        """Findings as a set of (cause, place...), and whether the exit code fits."""
        r = self.ethercat("why", "--json")
        masters = json.loads(r.stdout or "{}").get("masters", [])
        if not masters or (r.returncode == 0) != masters[0]["well"]:
            return {("exit code", r.returncode, r.stderr)}
        return {key(f) for f in masters[0]["findings"]}

    def settled(self, wanted):
        """The findings once they do not change any more, or are those expected twice."""
        end = time.monotonic() + SETTLE_S
        last = None
        while time.monotonic() < end:
            found = self.why()
            if found == last and (found == wanted or not pending(found)):
                if found == wanted or time.monotonic() > end - SETTLE_S + 2:
                    return found
            last = found
            time.sleep(0.1)
        return last


def key(f):
    """What identifies a finding: its cause and the most exact place."""
    if f["domain"] is not None:
        return (f["cause"], "domain", f["domain"])
    if f["cause"] in ("different", "wrong_place", "missing", "no_alias"):
        return (f["cause"], f["config"])
    if f["port"] is not None:
        return (f["cause"], f["slave"], f["port"])
    if f["slave"] is not None:
        return (f["cause"], f["slave"]) + ((f["code"],) if f["code"] else ())
    return (f["cause"],)


def pending(found):
    """Findings that only ask for patience."""
    return any(k[0] in ("under_way", "scan", "attaching") for k in found)


class Fault:
    """One fault. slave: its place; early: injected before the application starts."""
    early = True
    alone = False               # concerns the whole bus, or moves positions beforehand
    places = range(N)
    undo = ()                   # statements for the simulator

    def __init__(self, rng):
        self.rng = rng
        self.slave = rng.choice(list(self.places))
        self.name = SEGMENT[self.slave][0]

    def gone(self):
        """The slave that vanishes with all behind it, or None."""
        return None

    def inject(self, bench):
        """Do wrong."""

    def heal(self, bench):
        """Undo it; the application has ended."""
        bench.sim(*[u.format(self.name) for u in self.undo])

    def expect(self, position):
        """Findings; position gives the ring position of a slave that is there."""
        raise NotImplementedError


class Cut(Fault):
    """A cable, from the slave's port 0 to its parent."""
    early = False
    places = range(1, N)
    undo = ("heal {}.0",)
    verb = "cut {}.0"

    def gone(self):
        return self.slave

    def inject(self, bench):
        bench.sim(self.verb.format(self.name))

    def expect(self, position):
        return {("cable", position(PARENT[self.slave]), PORT[self.slave])}


class Off(Cut):
    """Power."""
    undo = ("on {}",)
    verb = "off {}"


class Missing(Cut):
    """A cable that is cut before the application starts; branch s10 moves up."""
    early = True
    alone = True
    places = SAME_LINE

    def inject(self, bench):
        super().inject(bench)
        left = N - sum(behind(i, self.slave) for i in range(N))
        end = time.monotonic() + SETTLE_S
        while time.monotonic() < end:
            if len(bench.ethercat("slaves").stdout.splitlines()) == left:
                return
            time.sleep(0.05)

    def expect(self, position):
        return {("missing", f"0:{self.slave}")}


class Link(Cut):
    """The cable at the master."""
    alone = True
    places = [0]

    def expect(self, position):
        return {("link_down",)}


class Dead(Fault):
    """The controller passes frames and does nothing else."""
    early = False
    places = range(1, N)
    undo = ("alive {}",)

    def inject(self, bench):
        bench.sim(f"dead {self.name}")

    def expect(self, position):
        return {("no_reply", position(self.slave))}


class Refuse(Fault):
    """A state is refused with a code."""
    places = COE
    undo = ("allow {}",)

    def inject(self, bench):
        self.code = self.rng.choice([0x1d, 0x1e, 0x24, 0x2d, 0x30, 0x8001])
        bench.sim(f"refuse {self.name} {self.rng.choice(['SAFEOP', 'OP'])} code={self.code}")

    def expect(self, position):
        return {("al_refused", position(self.slave), self.code)}


class Mute(Fault):
    """The application of the slave hangs and acknowledges no state."""
    places = [5, 2]
    undo = ("unmute {}",)

    def inject(self, bench):
        bench.slaves[self.slave].timeout_ms = 300
        bench.sim(f"mute {self.name}")

    def expect(self, position):
        return {("al_timeout", position(self.slave))}


class Sdo(Fault):
    """A startup SDO of an object that does not exist."""
    places = COE

    def inject(self, bench):
        bench.slaves[self.slave].sdos.append((0x5f00 + self.rng.randrange(256), 1, 7))

    def expect(self, position):
        return {("sdo", position(self.slave), NO_OBJECT)}


class Mailbox(Fault):
    """The mailbox replies with errors."""
    places = DRIVES
    undo = ("mailbox {} good",)

    def inject(self, bench):
        bench.slaves[self.slave].sdos.append((0x60ff, 0, 0))
        bench.sim(f"mailbox {self.name} error code={self.rng.choice([3, 7])}")

    def expect(self, position):
        return {("mailbox", position(self.slave))}


class Pdo(Fault):
    """Other PDOs than the fixed ones of the slave."""
    places = DRIVES

    def inject(self, bench):
        bench.slaves[self.slave].other_pdo = True

    def expect(self, position):
        return {("pdo", position(self.slave), 0x06010002)}


class Different(Fault):
    """Another device than the configured one."""

    def inject(self, bench):
        bench.slaves[self.slave].product += 0x1000

    def expect(self, position):
        return {("different", f"0:{self.slave}")}


class Swapped(Fault):
    """Two neighbors stand in the other order."""
    alone = True
    places = range(1, N - 1)

    def inject(self, bench):
        a, b = bench.slaves[self.slave], bench.slaves[self.slave + 1]
        a.vendor, a.product, b.vendor, b.product = b.vendor, b.product, a.vendor, a.product

    def expect(self, position):
        return {("wrong_place", f"0:{self.slave + i}") for i in range(2)}


class Alias(Fault):
    """No slave has the alias of a configuration."""

    def inject(self, bench):
        bench.slaves[self.slave].alias = 700 + self.slave
        self.config = f"{700 + self.slave}:{self.slave}"

    def expect(self, position):
        return {("no_alias", self.config)}


class NoClock(Fault):
    """SYNC signals of a slave that has no clock."""
    places = [9, 10]

    def inject(self, bench):
        bench.slaves[self.slave].sync0 = (0x300, 2000000)

    def expect(self, position):
        return {("no_clock", position(self.slave))}


class Sync(Fault):
    """SYNC signals without a cycle time."""
    places = DRIVES

    def inject(self, bench):
        bench.slaves[self.slave].sync0 = (0x300, 0)

    def expect(self, position):
        return {("sync", position(self.slave))}


class Counter(Fault):
    """Working counters of a slave are wrong by one."""
    early = False
    places = [i for i in range(1, N) if i != 9]
    undo = ("wkc {} add=0",)

    def inject(self, bench):
        bench.sim(f"wkc {self.name} add=1")
        self.domain = bench.slaves[self.slave].domain

    def expect(self, position):
        return {("working_counter", "domain", self.domain)}


class Errors(Fault):
    """Frames with errors on a cable."""
    early = False
    undo = ("errors {}.0 add=0",)

    def inject(self, bench):
        bench.sim(f"errors {self.name}.0 add={self.rng.randrange(1, 100)}")

    def expect(self, position):
        return {("link_errors", position(self.slave), 0)}


class Requested(Fault):
    """Another state than OP is requested with the tool."""
    early = False
    places = range(1, N)

    def inject(self, bench):
        bench.ethercat("states", self.rng.choice(["PREOP", "SAFEOP"]), "-p", str(self.slave))

    def expect(self, position):
        return {("not_requested", position(self.slave))}


class NoCycle(Fault):
    """The application activates the master and sends nothing."""
    alone = True
    places = [0]

    def expect(self, position):
        return {("no_cycle",)}


class Eeprom(Fault):
    """The checksum of an EEPROM is wrong, found by a scan."""
    alone = True

    def inject(self, bench):
        image = subprocess.run([bench.tool, "sii_read", "-p", str(self.slave)],
                               stdout=subprocess.PIPE, check=True).stdout
        self.word = image[14] | image[15] << 8
        self.write(bench, self.word ^ 0x55)

    def write(self, bench, value):
        """Word 7, and read it again."""
        bench.sim(f"eeprom {self.name} word=7 value={value}")
        bench.ethercat("rescan", "--wait")

    def heal(self, bench):
        self.write(bench, self.word)

    def expect(self, position):
        return {("eeprom", position(self.slave))}


KINDS = [Cut, Off, Missing, Link, Dead, Refuse, Mute, Sdo, Mailbox, Pdo, Different, Swapped, Alias,
         NoClock, Sync, Counter, Errors, Requested, NoCycle, Eeprom]


def draw_double(rng):
    """Two faults that can be there at a time, at different slaves."""
    kinds = [k for k in KINDS if not k.alone]
    while True:
        a, b = rng.choice(kinds)(rng), rng.choice(kinds)(rng)
        if a.slave != b.slave and not (isinstance(a, Counter) or isinstance(b, Counter)):
            return [a, b]


def expected(faults):
    """What follows from the faults: a place that is cut off by another one says nothing."""
    cuts = [f.gone() for f in faults if f.gone() is not None and not f.early]

    def is_gone(i, but=None):
        return any(behind(i, c) for c in cuts if c != but)

    def position(i):
        return i - sum(is_gone(k) for k in range(i))

    result = set()
    for f in faults:
        own = f.gone() if not f.early else None
        if is_gone(f.slave, own) and not isinstance(f, (Different, Alias)):
            continue
        result |= f.expect(position)
    return result


def run_case(bench, faults):
    """Return: what was found and what was expected."""
    bench.fresh()
    for f in faults:
        if f.early:
            f.inject(bench)
    wanted = expected(faults) if all(f.early for f in faults) else None
    bench.app.start(bench.slaves, not any(isinstance(f, NoCycle) for f in faults))
    if wanted is None:
        # the others have done what they do before a cable is cut
        bench.settled(expected([f for f in faults if f.early]))
        for f in faults:
            if not f.early:
                f.inject(bench)
        wanted = expected(faults)
    found = bench.settled(wanted)
    bench.app.stop()
    for f in faults:
        f.heal(bench)
    return found, wanted


def recover(bench):
    """All slaves in PREOP, no counter above 0, nothing to report."""
    end = time.monotonic() + 4 * SETTLE_S
    while True:
        found = bench.why()
        if any(k[0] == "link_errors" for k in found):
            bench.ethercat("crc", "reset")
        elif not found and len(bench.ethercat("slaves").stdout.splitlines()) == N:
            return
        if time.monotonic() > end:
            raise RuntimeError(f"the bus does not recover: {found}")
        time.sleep(0.05)


def run_group(bench, title, cases):
    """A TAP line; Return: number of right answers."""
    right = 0
    for faults in cases:
        text = " and ".join(f"{type(f).__name__} {f.name}" for f in faults) or "no fault"
        found, wanted = run_case(bench, faults)
        right += found == wanted
        if found != wanted:
            print(f"# {text}: found {sorted(map(str, found))}, expected "
                  f"{sorted(map(str, wanted))}")
        recover(bench)
    print(f"# {title}: {right} of {len(cases)} right")
    return right


def main():
    """Return: the exit code."""
    tool, library, control, seed = sys.argv[1:]
    rng = random.Random(int(seed))
    singles = [KINDS[i % len(KINDS)](rng) for i in range(SINGLE)]
    rng.shuffle(singles)
    doubles = [draw_double(rng) for _ in range(DOUBLE)]
    bench = Bench(tool, library, control)
    begin = time.monotonic()
    recover(bench)
    silent = run_group(bench, "runs without a fault", [[]] * NONE)
    right = run_group(bench, "single faults", [[f] for f in singles])
    right += run_group(bench, "double faults", doubles)
    total = SINGLE + DOUBLE
    print(f"# seed {seed}: {right} of {total} faults named with cause and place, "
          f"{100 * right / total:.1f} %; {silent} of {NONE} runs without a fault silent; "
          f"{time.monotonic() - begin:.0f} s")
    for ok, text in ((silent == NONE, "without a fault all is well"),
                     (100 * right >= 95 * total, "95 % of the faults have the right cause")):
        print(f"{'ok' if ok else 'not ok'} - {text}")
    return 0 if silent == NONE and 100 * right >= 95 * total else 1


def segment():
    """The description."""
    lines = ["segment seed=4 response=100us transition=1ms"]
    for i, (name, device, options, _, port) in enumerate(SEGMENT):
        if port == 2:
            lines.append(f"branch {SEGMENT[PARENT[i]][0]} 2")
        lines.append(f"slave {name} {device} {options}".rstrip())
    return "\n".join(lines)


if __name__ == "__main__":
    if sys.argv[1:] == ["--segment"]:
        print(segment())
    else:
        sys.exit(main())
