# SPDX-License-Identifier: GPL-2.0-only
"""Faults of why.py that users have reported: of time, of the application, of messages and twins."""
import subprocess
import time

from why_events import Event
from why_faults import (COE, DRIVES, N, NO_ALIAS, PARENT, PORT, REFUSED, SDO, SEGMENT, SETTLE_S,
                        Cut, Fault, behind)



def checksum(data):
    """Of the first words of an EEPROM (ETG.1000.6, 5.4)."""
    crc = 0xff
    for b in data:
        crc ^= b
        for _ in range(8):
            crc = crc << 1 ^ (0x107 if crc & 0x80 else 0)
    return crc


def write_alias(bench, alias, *slaves):
    """EEPROM words 4 and 7 of these slaves, and a scan reads them."""
    for i in slaves:
        image = bytearray(subprocess.run([bench.tool, "sii_read", "-p", str(i)],
                                         stdout=subprocess.PIPE, check=True).stdout[:14])
        image[8:10] = alias.to_bytes(2, "little")
        bench.sim(f"eeprom {SEGMENT[i][0]} word=4 value={alias}",
                  f"eeprom {SEGMENT[i][0]} word=7 value={checksum(image)}")
    bench.ethercat("rescan", "--wait")


class Whole(Fault):
    """Concerns no slave."""
    alone = True
    places = [0]
    cause = ""

    def expect(self, position):
        return {(self.cause,)}

    def events(self):
        return []


class Late(Whole):
    """Some frames return after the next cycle has begun."""
    early = False
    cause = "late_frames"

    def inject(self, bench):
        bench.sim("delay rate=60000ppm by=3ms")

    def heal(self, bench):
        bench.sim("delay rate=0ppm by=3ms")

    def events(self):
        return [Event("frames_late", many=True)]


class Lost(Whole):
    """Some frames do not return, and no port counts an error."""
    early = False
    cause = "lost_frames"

    def inject(self, bench):
        bench.sim("lose rate=60000ppm")

    def heal(self, bench):
        bench.sim("lose rate=0ppm")

    def events(self):
        return [Event("frames_lost", many=True)]


class Stall(Whole):
    """The application gives outputs no longer; the kernel runs the cycle."""
    early = False
    cause = "output_stall"

    def inject(self, bench):
        self.policy = self.rng.choice(["hold", "zero", "stop"])
        bench.app.stop()
        bench.app.start(bench.slaves, self.policy)
        bench.app.thread.join()

    def words(self):
        return [{"hold": "holds the last ones", "zero": "sends zeros", "stop": "stopped the cycle"}
                [self.policy]]

    def events(self):
        return [Event("output_stall", many=True, policy=self.policy)]

    def follows(self):
        return [Event("al_error", i, many=True) for i in range(N)] + \
            [Event("al_state_left", i, many=True) for i in range(N)] + \
            [Event("cycle_timeout", many=True)]


class Silenced(Whole):
    """An application that has sent frames stops doing so."""
    early = False
    cause = "no_cycle"

    def inject(self, bench):
        bench.app.stop()
        bench.app.start(bench.slaves, "own")
        time.sleep(1)
        bench.app.pause()

    def events(self):
        return [Event("cycle_timeout", many=True)]

    def follows(self):
        return [Event("al_error", i, many=True) for i in range(N)] + \
            [Event("al_state_left", i, many=True) for i in range(N)]


class Emergency(Fault):
    """An emergency that stands."""
    early = False
    places = DRIVES

    def inject(self, bench):
        self.code = self.rng.choice([0x2310, 0x4210, 0x7305, 0x8611])
        bench.sim(f"emergency {self.name} code={self.code} register=0x21")

    def heal(self, bench):
        bench.sim(f"emergency {self.name} code=0 register=0")

    def expect(self, position):
        return {("emergency", position(self.slave), self.code)}

    def events(self):
        return [Event("emergency", self.slave, code=self.code)]

    def follows(self):
        return [Event("emergency", self.slave, code=0)]


class Ended(Emergency):
    """One that the slave has taken back."""
    def inject(self, bench):
        super().inject(bench)
        time.sleep(0.2)
        bench.sim(f"emergency {self.name} code=0 register=0")

    def heal(self, bench):
        pass

    def expect(self, position):
        return set()


class Leftover(Fault):
    """A slave has an FMMU that no application has given it, at the inputs of another one."""
    early = False
    # not of the domain of slave 11, which counts once in a datagram
    places = [3, 6]

    def inject(self, bench):
        # the first FMMU of the domain, as one of slave 11, which has FMMUs to spare
        bench.ethercat("reg_write", "-p", "11", "-t", "raw", "0x0670", self.page(bench))
        self.domain = bench.slaves[self.slave].domain

    def page(self, bench):
        """The inputs of this slave, to be read from its status register."""
        fmmus = [f for d in bench.ethercat_json("domains", "-v")["masters"][0]["domains"]
                 for f in d["fmmus"]
                 if f["relative_position"] == self.slave and f["direction"] == "input"]
        at = fmmus[0]["logical_address"]
        return "".join(f"{b:02x}" for b in [
            *at.to_bytes(4, "little"), 1, 0, 0, 7, 0x30, 1, 0, 1, 1, 0, 0, 0])

    def heal(self, bench):
        bench.ethercat("reg_write", "-p", "11", "-t", "uint8", "0x067c", "0")

    def expect(self, position):
        return {("working_counter", "domain", self.domain)}

    def words(self):
        return ["slave 11 (drive) answers too"]

    def events(self):
        return [Event("working_counter", many=True, domain=self.domain)]


class Odd(Fault):
    """SYNC0 and cycle do not divide each other."""
    places = DRIVES

    def inject(self, bench):
        bench.slaves[self.slave].sync0 = (0x300, 1300000)

    def expect(self, position):
        return {("sync_cycle", position(self.slave))}

    def events(self):
        return []


class Sluggish(Fault):
    """Its mailbox replies so late that the way to OP takes seconds: nothing is wrong."""
    early = False
    places = DRIVES
    undo = ("mailbox {} good",)

    def inject(self, bench):
        bench.app.stop()
        bench.slaves[self.slave].sdos.append((0x60ff, 0, 0))
        bench.sim(f"mailbox {self.name} delay by=1500ms")
        bench.app.start(bench.slaves, bench.cycle)
        self.meanwhile = []
        limit = time.monotonic() + 2 * SETTLE_S
        while time.monotonic() < limit and bench.why() != set():
            self.meanwhile.append(bench.why())

    def meanwhile_wrong(self):
        """What was said on the way."""
        return [f"on the way {sorted(map(str, f))}" for f in self.meanwhile
                if any(k[0] not in ("under_way", "scan") for k in f)]

    def expect(self, position):
        return set()

    def events(self):
        return []


class Dropped(Fault):
    """A slave leaves OP with an error and is brought back."""
    early = False
    places = DRIVES
    related = ("al_state_left",)

    def inject(self, bench):
        bench.sim(f"error {self.name} code=0x1a")

    def expect(self, position):
        return set()

    def events(self):
        return [Event("al_error", self.slave, many=True, al_status_code=0x1a)]


class Twin(Cut):
    """A cable behind which all are lost, among them one that another branch has as well."""
    places = [4]


class Doubled(Fault):
    """Two slaves have the same alias."""
    alone = True
    places = range(1, N - 1)

    def inject(self, bench):
        write_alias(bench, 600 + self.slave, self.slave, self.slave + 1)

    def heal(self, bench):
        write_alias(bench, 0, self.slave, self.slave + 1)

    def expect(self, position):
        return {("alias_twice", position(self.slave + i)) for i in range(2)}

    def events(self):
        return []


class Typo(Fault):
    """The alias of a configuration has two digits exchanged."""
    alone = True

    def inject(self, bench):
        write_alias(bench, 1205, self.slave)
        bench.slaves[self.slave].alias = 1025
        bench.slaves[self.slave].offset = 0

    def heal(self, bench):
        write_alias(bench, 0, self.slave)

    def expect(self, position):
        return {("no_alias", "1025:0")}

    def words(self):
        return [f"correct the alias in the application to 1205, if slave {self.slave} "]

    def events(self):
        return [Event("configuration", alias=1025, position=0, cause=NO_ALIAS)]


class Contact(Whole):
    """The link of the master is lost for a moment, as by a card that resets."""
    early = False

    def inject(self, bench):
        bench.sim(f"cut {SEGMENT[0][0]}.0")
        time.sleep(0.3)
        bench.sim(f"heal {SEGMENT[0][0]}.0")

    def expect(self, position):
        # the port has counted it
        return {("link_errors", 0, 0)}

    def events(self):
        return [Event("link_down", device=0, many=True)]

    def follows(self):
        return [Event("all_slaves_lost", many=True)] + \
            [Event("slave_lost", i, many=True) for i in range(N)]


class Power(Fault):
    """A slave at the end of a line is powered off and on again."""
    early = False
    places = [9, 11]

    def inject(self, bench):
        bench.sim(f"off {self.name}")
        time.sleep(0.4)
        bench.sim(f"on {self.name}")

    def expect(self, position):
        # the port before it has counted it
        return {("link_errors", PARENT[self.slave], PORT[self.slave])}

    def events(self):
        return [Event("slave_lost", self.slave)]


class Repaired(Fault):
    """A slave refuses its state; a cable beside it was cut and is repaired again."""
    early = False
    alone = True
    places = DRIVES
    undo = ("allow {}",)
    related = ("al_error", "al_state_left")

    def inject(self, bench):
        self.other = 9 if self.slave == 11 else 11
        self.passing = (self.other,)
        bench.sim(f"refuse {self.name} OP code=0x1d", f"error {self.name} code=0x1a",
                  f"cut {SEGMENT[self.other][0]}.0")
        time.sleep(1)
        bench.sim(f"heal {SEGMENT[self.other][0]}.0")
        time.sleep(0.1)
        self.meanwhile = []
        limit = time.monotonic() + SETTLE_S
        while time.monotonic() < limit:
            found = bench.why()
            self.meanwhile.append(found)
            if found == self.expect(lambda i: i):
                break

    def expect(self, position):
        return {("al_refused", position(self.slave), 0x1d),
                ("link_errors", PARENT[self.other], PORT[self.other])}

    def meanwhile_wrong(self):
        """What was said while the other cable was being repaired."""
        places = {self.slave, self.slave - sum(behind(i, self.other) for i in range(self.slave))}
        return [f"during the repair {sorted(map(str, f))}" for f in self.meanwhile
                if not any(("al_refused", p, 0x1d) in f for p in places) or
                any(k[0] not in ("al_refused", "link_errors", "under_way", "scan") for k in f)]

    def events(self):
        return [self.failed(REFUSED, code=0x1d, state="OP"), Event("slave_lost", self.other)]


class Allowed(Fault):
    """A slave refuses OP for a moment and may enter it then: the master tries again by itself."""
    places = COE
    related = ("al_error",)

    early = False

    def inject(self, bench):
        bench.app.stop()
        bench.sim(f"refuse {self.name} OP code=0x1e")
        bench.app.start(bench.slaves, bench.cycle)
        limit = time.monotonic() + SETTLE_S
        while time.monotonic() < limit and ("al_refused", self.slave, 0x1e) not in bench.why():
            pass
        self.hint = f"at once with 'ethercat states OP -p {self.slave}'" in bench.texts
        bench.sim(f"allow {self.name}")
        bench.ethercat("states", "OP", "-p", str(self.slave))

    def meanwhile_wrong(self):
        """What was said while it refused."""
        return [] if self.hint else ["no remedy says how OP is tried again"]

    def expect(self, position):
        return set()

    def events(self):
        return [self.failed(REFUSED, code=0x1e, state="OP")]


class Spare(Fault):
    """A slave that no application has configured refuses PREOP."""
    alone = True
    places = COE
    undo = ("allow {}",)
    related = ("al_error",)

    def inject(self, bench):
        bench.slaves = [s for s in bench.slaves if s.position != self.slave]
        bench.sim(f"refuse {self.name} PREOP code=0x14")
        bench.ethercat("rescan", "--wait")

    def heal(self, bench):
        super().heal(bench)
        bench.ethercat("rescan", "--wait")

    def expect(self, position):
        return {("al_refused", position(self.slave), 0x14)}

    def events(self):
        return [self.failed(REFUSED, code=0x14, state="PREOP")]


class Overrun(Whole):
    """The application's own cycle is late by several periods, again and again."""
    early = False
    cause = "overruns"

    def inject(self, bench):
        bench.app.stop()
        bench.app.start(bench.slaves, "late")

    def events(self):
        return [Event("overruns", many=True)]


class Rejoined(Fault):
    """A slave is lost and comes back while its neighbor refuses its state: that one stays."""
    early = False
    alone = True
    places = [9]
    undo = ("allow s8",)

    def inject(self, bench):
        bench.sim("refuse s8 OP code=0x24", "error s8 code=0x1a", f"off {self.name}")
        time.sleep(0.5)
        bench.sim(f"on {self.name}")

    def expect(self, position):
        return {("al_refused", position(8), 0x24), ("link_errors", 8, 1)}

    def events(self):
        return [Event("slave_failed", 8, many=True, cause=REFUSED, code=0x24, state="OP"),
                Event("slave_lost", self.slave)]

    def follows(self):
        return [Event(kind, 8, many=True) for kind in ("al_error", "al_state_left")]


class Half(Cut):
    """Two cables were cut in different branches, one of them is repaired."""
    alone = True
    places = [3, 5, 9, 10, 11]
    undo = ("heal {}.0",)

    def inject(self, bench):
        self.other = self.rng.choice([2, 7, 9] if self.slave > 9 else [10, 11])
        self.passing = (self.other,)
        bench.sim(f"cut {self.name}.0", f"cut {SEGMENT[self.other][0]}.0")
        time.sleep(1)
        bench.sim(f"heal {SEGMENT[self.other][0]}.0")
        self.meanwhile = []
        limit = time.monotonic() + SETTLE_S
        while time.monotonic() < limit and len(self.meanwhile) < 20:
            self.meanwhile.append(bench.why())

    def place(self, cut, gone):
        """The port that leads to a cut, while these are cut off."""
        parent = PARENT[cut]
        return parent - sum(any(behind(i, g) for g in gone) for i in range(parent)), PORT[cut]

    def expect(self, position):
        return super().expect(position) | \
            {("link_errors", position(PARENT[self.other]), PORT[self.other])}

    def meanwhile_wrong(self):
        """What was said while the other cable was being repaired: another cable."""
        cuts = [("cable",) + self.place(c, gone) for c in (self.slave, self.other)
                for gone in ((self.slave,), (self.slave, self.other))]
        return [f"during the repair {sorted(map(str, f))}" for f in self.meanwhile
                if any(k[0] not in ("cable", "link_errors", "under_way", "scan") or
                       (k[0] == "cable" and k not in cuts) for k in f)]

    def events(self):
        # one of the other branch may be at the position of one of these
        return [Event("slave_lost", i, True, upstream=PARENT[i], port=PORT[i]) for i in range(N)
                if behind(i, self.slave) or behind(i, self.other)]


MORE = [Late, Lost, Stall, Silenced, Emergency, Ended, Leftover, Odd, Sluggish, Dropped, Twin,
        Doubled, Typo, Contact, Power, Repaired, Allowed, Spare, Overrun, Rejoined,
        Half]
