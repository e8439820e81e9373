# SPDX-License-Identifier: GPL-2.0-only
"""The segment of why.py, and the faults that it injects with what follows from them."""
import time

from why_events import Event

# name, device, options, parent, port there; in ring order
SEGMENT = [
    ("s0", "EK1100", "", None, 0),
    ("s1", "EL7201", "motor=AM8121", "s0", 1),
    ("s2", "EL3062", "", "s1", 1),
    ("s3", "drive", "in=8 out=8 mapping=fixed", "s2", 1),
    ("s4", "EL1008", "", "s3", 1),
    ("s5", "EL4002", "", "s4", 1),
    ("s6", "drive", "in=12 out=12 mapping=fixed", "s5", 1),
    ("s7", "EL7201", "motor=AM8121", "s6", 1),
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
SERVOS = [1, 7]         # with a mailbox for BOOT
COE = DRIVES + SERVOS + [2, 5]
SAME_LINE = range(2, 10)        # a cut there takes slaves from the middle of the ring
SETTLE_S = 5
NO_OBJECT = 0x06020000
NO_ALIAS, NO_SLAVE, DIFFERENT = 4, 5, 6                         # EC_CAUSE_*
SILENT, EEPROM, SDO, PDO, SYNC, REFUSED, SLOW, AL_ERROR = 32, 34, 36, 40, 42, 43, 44, 46


def behind(i, top):
    """Is slave i slave top or connected behind it?"""
    while i is not None and i != top:
        i = PARENT[i]
    return i is not None


def segment():
    """The description."""
    lines = ["segment seed=4 response=100us transition=1ms"]
    for i, (name, device, options, _, port) in enumerate(SEGMENT):
        if port == 2:
            lines.append(f"branch {SEGMENT[PARENT[i]][0]} 2")
        lines.append(f"slave {name} {device} {options}".rstrip())
    return "\n".join(lines)


class Fault:
    """One fault. slave: its place; early: injected before the application starts."""
    early = True
    alone = False               # concerns the whole bus, or moves positions beforehand
    places = range(N)
    undo = ()                   # statements for the simulator
    related = ()                # events that may follow at its slave
    passing = ()                # slaves that were cut off for a while

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

    def restore(self, bench):
        """Undo what needs the slave at its position, once all slaves are back."""

    def expect(self, position):
        """Findings; position gives the ring position of a slave that is there."""
        raise NotImplementedError

    def events(self):
        """Events that must be in the log; none: only registers of the slave show the fault."""
        raise NotImplementedError

    def follows(self):
        """Events that may be there as well."""
        return []

    def words(self):
        """What the texts of the findings must have."""
        return []

    def meanwhile_wrong(self):
        """What was wrong before the last state."""
        return []

    def failed(self, cause, **args):
        """The event of a slave that could not be scanned or configured."""
        return Event("slave_failed", self.slave, many=True, cause=cause, **args)


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

    def events(self):
        # each slave behind it, with the place where it was connected
        return [Event("slave_lost", i, upstream=PARENT[i], port=PORT[i])
                for i in range(N) if behind(i, self.slave)]


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

    def events(self):
        # the others have moved up: where they are another device is configured, or none is there
        left = [i for i in range(N) if not behind(i, self.slave)]
        return super().events() + [
            Event("configuration", alias=0, position=i,
                  cause=DIFFERENT if i < len(left) else NO_SLAVE)
            for i in range(self.slave, N)
            if i >= len(left) or SEGMENT[left[i]][1] != SEGMENT[i][1]]


class Link(Cut):
    """The cable at the master."""
    alone = True
    places = [0]

    def expect(self, position):
        return {("link_down",)}

    def events(self):
        return [Event("link_down", device=0), Event("all_slaves_lost", slaves=N)]


class Dead(Fault):
    """The controller passes frames and does nothing else."""
    early = False
    places = range(1, N)
    undo = ("alive {}",)

    def inject(self, bench):
        bench.sim(f"dead {self.name}")

    def expect(self, position):
        return {("no_reply", position(self.slave))}

    def events(self):
        return [Event("slave_silent", self.slave), self.failed(SILENT)]


class Refuse(Fault):
    """A state is refused with a code."""
    related = ("al_error",)
    places = COE
    undo = ("allow {}",)

    def inject(self, bench):
        self.code = self.rng.choice([0x1d, 0x1e, 0x24, 0x2d, 0x30, 0x8001])
        self.state = self.rng.choice(["SAFEOP", "OP"])
        bench.sim(f"refuse {self.name} {self.state} code={self.code}")

    def expect(self, position):
        return {("al_refused", position(self.slave), self.code)}

    def events(self):
        return [self.failed(REFUSED, code=self.code, state=self.state)]


class Mute(Fault):
    """The application of the slave hangs and acknowledges no state."""
    places = [5, 2]
    undo = ("unmute {}",)

    def inject(self, bench):
        bench.slaves[self.slave].timeout_ms = 300
        bench.sim(f"mute {self.name}")

    def expect(self, position):
        return {("al_timeout", position(self.slave))}

    def events(self):
        return [self.failed(SLOW, state="SAFEOP")]


class Sdo(Fault):
    """A startup SDO of an object that does not exist."""
    places = COE

    def inject(self, bench):
        self.index = 0x5f00 + self.rng.randrange(256)
        bench.slaves[self.slave].sdos.append((self.index, 1, 7))

    def expect(self, position):
        return {("sdo", position(self.slave), NO_OBJECT)}

    def events(self):
        return [self.failed(SDO, code=NO_OBJECT, object=self.index, subindex=1)]


class Mailbox(Fault):
    """The mailbox replies with errors."""
    places = DRIVES
    undo = ("mailbox {} good",)

    def inject(self, bench):
        bench.slaves[self.slave].sdos.append((0x60ff, 0, 0))
        bench.sim(f"mailbox {self.name} error code={self.rng.choice([3, 7])}")

    def expect(self, position):
        return {("mailbox", position(self.slave))}

    def events(self):
        return [self.failed(SDO, code=0, object=0x60ff)]


class Pdo(Fault):
    """Other PDOs than the fixed ones of the slave."""
    places = DRIVES

    def inject(self, bench):
        bench.slaves[self.slave].other_pdo = True

    def expect(self, position):
        return {("pdo", position(self.slave), 0x06010002)}

    def events(self):
        return [self.failed(PDO, code=0x06010002, sync_manager=2)]


class Different(Fault):
    """Another device than the configured one."""

    def inject(self, bench):
        self.product = bench.slaves[self.slave].product
        bench.slaves[self.slave].product += 0x1000

    def expect(self, position):
        return {("different", f"0:{self.slave}")}

    def events(self):
        return [Event("configuration", self.slave, alias=0, position=self.slave, cause=DIFFERENT,
                      product_code=self.product + 0x1000, found_product_code=self.product)]


class Swapped(Fault):
    """Two neighbors stand in the other order."""
    alone = True
    places = range(1, N - 1)

    def inject(self, bench):
        a, b = bench.slaves[self.slave], bench.slaves[self.slave + 1]
        a.vendor, a.product, b.vendor, b.product = b.vendor, b.product, a.vendor, a.product

    def expect(self, position):
        return {("wrong_place", f"0:{self.slave + i}") for i in range(2)}

    def events(self):
        return [Event("configuration", i, alias=0, position=i, cause=DIFFERENT)
                for i in (self.slave, self.slave + 1)]


class Alias(Fault):
    """No slave has the alias of a configuration."""

    def inject(self, bench):
        bench.slaves[self.slave].alias = 700 + self.slave
        self.config = f"{700 + self.slave}:{self.slave}"

    def expect(self, position):
        return {("no_alias", self.config)}

    def events(self):
        return [Event("configuration", alias=700 + self.slave, position=self.slave,
                      cause=NO_ALIAS)]


class NoClock(Fault):
    """SYNC signals of a slave that has no clock."""
    places = [9, 10]

    def inject(self, bench):
        bench.slaves[self.slave].sync0 = (0x300, 2000000)

    def expect(self, position):
        return {("no_clock", position(self.slave))}

    def events(self):
        return [Event("no_clock", self.slave, many=True)]


class Sync(Fault):
    """SYNC signals without a cycle time."""
    places = DRIVES

    def inject(self, bench):
        bench.slaves[self.slave].sync0 = (0x300, 0)

    def expect(self, position):
        return {("sync", position(self.slave))}

    def events(self):
        return [self.failed(SYNC)]


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

    def events(self):
        return [Event("working_counter", many=True, domain=self.domain,
                      wrong=lambda e: e["working_counter"] != e["expected"] == e["before"])]


class Errors(Fault):
    """Frames with errors on a cable."""
    early = False
    undo = ("errors {}.0 add=0",)

    def inject(self, bench):
        bench.sim(f"errors {self.name}.0 add={self.rng.randrange(1, 100)}")

    def expect(self, position):
        return {("link_errors", position(self.slave), 0)}

    def events(self):
        return []


class Requested(Fault):
    """Another state than OP is requested with the tool."""
    early = False
    places = range(1, N)

    def inject(self, bench):
        self.state = self.rng.choice(["PREOP", "SAFEOP"])
        bench.ethercat("states", self.state, "-p", str(self.slave))

    def expect(self, position):
        return {("not_requested", position(self.slave))}

    def events(self):
        return [Event("al_state", self.slave, state=self.state, before="OP")]
