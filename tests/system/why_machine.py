# SPDX-License-Identifier: GPL-2.0-only
"""Faults of why.py that concern the machine, the cycle, EEPROMs and firmware; the list of all."""
import subprocess

from why_events import Event
from why_faults import (COE, DRIVES, EEPROM, REFUSED, Alias, Counter, Cut, Dead,
                        Different, Errors, Fault, Link, Mailbox, Missing, Mute, NoClock, Off, Pdo,
                        Refuse, Requested, SERVOS, Sdo, Swapped, Sync)

NO_FIRMWARE, SM_WATCHDOG = 0x14, 0x1b           # AL status codes


class NoCycle(Fault):
    """The application activates the master and sends nothing."""
    alone = True
    places = [0]

    def inject(self, bench):
        bench.cycle = "none"

    def expect(self, position):
        return {("no_cycle",)}

    def events(self):
        return [Event("cycle_timeout", timeouts=1)]


class TooShort(Fault):
    """The configured cycle is shorter than its frames are on the wire."""
    alone = True
    places = [0]

    def inject(self, bench):
        bench.cycle = "short"

    def expect(self, position):
        return {("cycle_too_short",)}

    def events(self):
        return [Event("wire_time", short=lambda e: e["cyclic_ns"] > e["cycle_ns"])]


class Watchdog(Fault):
    """The watchdog of the process data is shorter than the cycle."""
    places = DRIVES
    related = ("al_state_left",)

    def inject(self, bench):
        bench.slaves[self.slave].watchdog = self.rng.randrange(2, 12)   # units of 100 us

    def restore(self, bench):
        # it stays in the slave; the reset value
        bench.ethercat("reg_write", "-p", str(self.slave), "-t", "uint16", "0x0420", "1000")

    def expect(self, position):
        return {("watchdog", position(self.slave), SM_WATCHDOG)}

    def events(self):
        return [Event("al_error", self.slave, many=True, al_status_code=SM_WATCHDOG)]

    def follows(self):
        return [self.failed(REFUSED, code=SM_WATCHDOG)]


class NoDevice(Fault):
    """The driver of the network device is unloaded."""
    early = False
    alone = True
    places = [0]

    def inject(self, bench):
        subprocess.run(["rmmod", "ec_sim"], check=True)

    def heal(self, bench):
        bench.load()

    def expect(self, position):
        return {("no_device",)}

    def events(self):
        return [Event("device_detached", device=0)]


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

    def events(self):
        return [Event("eeprom", self.slave, flaw=0, checksum=(self.word ^ 0x55) & 0xff,
                      expected=self.word & 0xff)]


class Scanned(Fault):
    """A command of the segment that only a scan finds; a scan ends it as well."""
    alone = True

    def inject(self, bench):
        bench.sim(self.command())
        bench.ethercat("rescan", "--wait")

    def heal(self, bench):
        super().heal(bench)
        bench.ethercat("rescan", "--wait")


class Unreadable(Scanned):
    """The EEPROM does not answer."""
    related = ("configuration",)
    undo = ("idle {}",)

    def command(self):
        return f"busy {self.name}"

    def expect(self, position):
        return {("eeprom", position(self.slave))}

    def events(self):
        return [self.failed(EEPROM)]


class NoFirmware(Scanned):
    """Without firmware a slave refuses PREOP; it was powered up before the application starts."""
    places = COE
    undo = ("allow {}",)
    related = ("al_error",)

    def command(self):
        return f"refuse {self.name} PREOP code={NO_FIRMWARE}"

    def expect(self, position):
        return {("al_refused", position(self.slave), NO_FIRMWARE)}

    def events(self):
        return [self.failed(REFUSED, code=NO_FIRMWARE, state="PREOP")]


class Boot(Fault):
    """A slave is left in BOOT, as by an update of its firmware that has not ended."""
    early = False
    places = SERVOS

    def inject(self, bench):
        bench.ethercat("states", "BOOT", "-p", str(self.slave))

    def expect(self, position):
        return {("boot", position(self.slave))}

    def events(self):
        return [Event("al_state", self.slave, state="BOOT")]


KINDS = [Cut, Off, Missing, Link, Dead, Refuse, Mute, Sdo, Mailbox, Pdo, Different, Swapped, Alias,
         NoClock, Sync, Counter, Errors, Requested, NoCycle, TooShort, Watchdog, NoDevice, Eeprom,
         Unreadable, NoFirmware, Boot]
