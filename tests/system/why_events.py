# SPDX-License-Identifier: GPL-2.0-only
"""What 'ethercat log' tells of a case of why.py, and what it has to tell.

A fault names the events that must follow from it (Fault.events()), those that may
(Fault.follows()), and the kinds of other events that its own slave may cause (Fault.related). An
event that reports something wrong and belongs to no fault is as wrong as one that is absent.
"""
import fcntl
import json
import os
import struct
import subprocess
import time

EVENTS = 3 << 30 | 24 << 16 | 0xec << 8 | 0x1b      # EC_IOC_EVENTS
WAIT_S = 5

# events that blame a place; others are what follows, and what the application does
BLAMING = {"device_detached", "link_down", "slave_lost", "all_slaves_lost", "slave_silent",
           "al_state_left", "al_error", "slave_failed", "eeprom", "no_clock",
           "revision", "configuration", "configurations", "emergency", "cycle_timeout",
           "wire_time", "stale_data", "missed"}
# without a fault neither these
TROUBLE = BLAMING | {"no_answer", "frames_lost", "frames_late", "slaves_responding",
                     "reference_clock", "overruns", "sync_window", "clocks_not_synchronized"}


class Event:
    """An expected event; slave: its index in the segment, args: values of its JSON."""

    def __init__(self, event, slave=None, many=False, **args):
        self.event = event
        self.slave = slave
        self.many = many            # it may come again, as attempts fail
        self.args = args

    def __str__(self):
        return f"{self.event} slave={self.slave} {self.args}"

    def matches(self, e, positions):
        """positions: the ring positions that a slave has had in this case."""
        if e["event"] != self.event:
            return False
        if self.slave is None:
            if "slave" in e and self.event != "configuration":
                return False
        elif e.get("slave") not in positions(self.slave):
            return False
        for key, want in self.args.items():
            have = e.get(key)
            # the event says that only of the first of several slaves
            if e.get("behind") and key in ("upstream", "port"):
                continue
            if key == "upstream":
                if have not in positions(want):
                    return False
            elif callable(want):
                if not want(e):
                    return False
            elif have != want:
                return False
        return True


def each_slave(e):
    """An event of several neighbours as one of each: in a case these are slaves of their own."""
    yield e
    for i in range(1, e.get("slaves", 1) if "slave" in e else 1):
        yield e | {"slave": e["slave"] + i, "behind": True}


class Log:
    """'ethercat log --follow --json' beside all cases: what has come since a number."""

    def __init__(self, tool, path):
        self.fd = os.open("/dev/EtherCAT0", os.O_RDONLY)
        with open(path, "w", encoding="ascii") as out:
            # pylint: disable-next=consider-using-with
            self.process = subprocess.Popen([tool, "log", "--follow", "--json"], stdout=out)
        self.file = open(path, encoding="ascii")    # pylint: disable=consider-using-with
        self.part = ""
        self.events = []

    def end(self):
        """No more events are needed."""
        self.process.terminate()
        self.process.wait()

    def next(self):
        """Number of the event that comes next."""
        arg = fcntl.ioctl(self.fd, EVENTS, struct.pack("=IIQQ", 0, 64, 0, 0))
        return struct.unpack("=IIQQ", arg)[3]

    def between(self, begin, end):
        """The events with numbers from @begin to before @end, once the command has shown them."""
        limit = time.monotonic() + WAIT_S
        while True:
            self.part += self.file.read()
            *lines, self.part = self.part.split("\n")
            self.events += [json.loads(line) for line in lines]
            if begin == end or (self.events and self.events[-1]["number"] >= end - 1):
                break
            if time.monotonic() > limit:
                raise RuntimeError(f"ethercat log does not show event {end - 1}")
            time.sleep(0.01)
        self.events = [e for e in self.events if e["number"] >= begin]
        return [one for e in self.events if e["number"] < end for one in each_slave(e)]


def judge(events, faults, positions, lost):
    """
    What is wrong with the events of a case, as lines of text; nothing: all is named.
    lost(fault): its slave is cut off, so that what happens to it may be seen or not.
    """
    if not faults:
        return [f"false alarm: {e['text']}" for e in events if e["event"] in TROUBLE]
    wrong = []
    expected = [(f, x) for f in faults for x in f.events()]
    right = [x for _, x in expected] + [x for f in faults for x in f.follows()]
    for fault, x in expected:
        n = sum(x.matches(e, positions) for e in events)
        if not n and not (lost(fault) and not fault.early):
            wrong.append(f"absent: {x}")
        if n > 1 and not x.many:
            wrong.append(f"{n} times: {x}")
    for e in events:
        if e["event"] not in BLAMING or any(x.matches(e, positions) for x in right):
            continue
        if any(e["event"] in f.related and e.get("slave") in positions(f.slave) for f in faults):
            continue
        wrong.append(f"blames: {e['text']}")
    return wrong
