#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Faults at random places of a simulated segment; does 'ethercat why' name cause and place?

usage: why.py TOOL LIBRARY CONTROL SEED FOLDER LOAD...    LOAD...: command that loads the segment

Each case injects one fault, or two at different places, runs an application and compares all
findings, and all events of 'ethercat log', with what was injected: a cause too many is as wrong
as one too few. What is expected is derived from the kind of fault, its place and the topology.
EC_FAULTS="Cut Late": only these kinds. Cases without a fault must have no finding and no event of
trouble. Prints TAP lines and the figures.
"""
import json
import os
import random
import subprocess
import sys
import time

from why_app import Application, Slave
from why_events import Log, judge
from why_faults import N, SETTLE_S, Alias, Counter, Different, behind, segment
from why_machine import KINDS
from why_more import MORE

SINGLE, DOUBLE, NONE = 48, 12, 10
SCAN_S = 60


class Bench:
    """Tool, simulator, application and what is configured in a case."""

    def __init__(self, tool, library, control, folder, load):
        self.tool = tool
        self.control = control
        self.load_command = load
        self.log = Log(tool, folder + "/log")
        self.app = Application(library)
        self.infos = self.ethercat_json("slaves")["masters"][0]["slaves"]
        pdos = self.ethercat_json("pdos")["masters"][0]["slaves"]
        self.syncs = [[m["index"] for m in s["sync_managers"]
                       if any(e for p in m["pdos"] for e in p["entries"])] for s in pdos]
        self.slaves = []
        self.texts = ""         # of the last findings, with their remedies
        self.fresh()

    def fresh(self):
        """What is on the bus is configured."""
        self.slaves = [Slave(i, s) for i, s in zip(self.infos, self.syncs)]
        self.cycle = "kernel"

    def load(self):
        """The segment, with new slaves."""
        subprocess.run(self.load_command, check=True)
        end = time.monotonic() + SCAN_S
        while time.monotonic() < end:
            if self.ethercat("slaves").stdout.count(" PREOP ") == N:
                return
            time.sleep(0.1)
        raise RuntimeError("the segment is not scanned")

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
        self.texts = "\n".join(f["text"] + "\n" + f["remedy"] for f in masters[0]["findings"])
        return {key(f) for f in masters[0]["findings"]}

    def settled(self, wanted):
        """The findings once they do not change any more, or are those expected twice."""
        end = time.monotonic() + SETTLE_S
        last = None
        while time.monotonic() < end:
            found = self.why()
            if found == last and (found == wanted or not pending(found)):
                if found == wanted or time.monotonic() > end - SETTLE_S + 2:
                    return self.stays(found)
            last = found
            time.sleep(0.1)
        return last

    def stays(self, found):
        """The findings if they stay the same, else the first others."""
        for _ in range(4):
            time.sleep(0.15)
            now = self.why()
            if now != found:
                return now
        return found


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


def draw_double(rng):
    """Two faults that can be there at a time, at different slaves."""
    kinds = [k for k in KINDS if not k.alone]
    while True:
        a, b = rng.choice(kinds)(rng), rng.choice(kinds)(rng)
        if a.slave != b.slave and not (isinstance(a, Counter) or isinstance(b, Counter)):
            return [a, b]


def late_cuts(faults):
    """Slaves that are cut off, with all behind them, while the application runs."""
    return [f.gone() for f in faults if f.gone() is not None and not f.early]


def position(i, cuts):
    """The ring position of slave i behind these cuts."""
    return i - sum(any(behind(k, c) for c in cuts) for k in range(i))


def is_lost(fault, faults):
    """Is the slave of a fault cut off by another fault?"""
    own = fault.gone() if not fault.early else None
    return any(behind(fault.slave, c) for c in late_cuts(faults) if c != own)


def expected(faults):
    """What follows from the faults: a place that is cut off by another one says nothing."""
    cuts = late_cuts(faults)
    result = set()
    for f in faults:
        if is_lost(f, faults) and not isinstance(f, Alias):
            continue
        # the position of its configuration means another slave then
        if isinstance(f, Different) and position(f.slave, cuts) != f.slave:
            continue
        result |= f.expect(lambda i: position(i, cuts))
    return result


def events_wrong(faults, events):
    """What the log has too much or too little."""
    cuts = late_cuts(faults)
    some = [[]] + [[c] for c in cuts] + [cuts] + [[c] for f in faults for c in f.passing]
    return judge(events, faults, lambda i: {position(i, c) for c in some},
                 lambda f: is_lost(f, faults))


def run_case(bench, faults):
    """Return: what was found, what was expected, and what is wrong with the log."""
    bench.fresh()
    begin = bench.log.next()
    for f in faults:
        if f.early:
            f.inject(bench)
    wanted = expected(faults) if all(f.early for f in faults) else None
    bench.app.start(bench.slaves, bench.cycle)
    if wanted is None:
        # the others have done what they do before a cable is cut
        bench.settled(expected([f for f in faults if f.early]))
        for f in faults:
            if not f.early:
                f.inject(bench)
        wanted = expected(faults)
    found = bench.settled(wanted)
    for f in faults:
        found |= {("no word of", w) for w in f.words() if w not in bench.texts}
        found |= {(w,) for w in f.meanwhile_wrong()}
    events = bench.log.between(begin, bench.log.next())
    bench.app.stop()
    for f in faults:
        f.heal(bench)
    return found, wanted, events_wrong(faults, events)


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
    """Return: numbers of right answers of why, of log, and of cases that the log can show."""
    why = log = shown = 0
    for faults in cases:
        text = " and ".join(f"{type(f).__name__} {f.name}" for f in faults) or "no fault"
        found, wanted, wrong = run_case(bench, faults)
        why += found == wanted
        can_show = not faults or any(f.events() for f in faults)
        shown += can_show
        log += can_show and not wrong
        if found != wanted:
            print(*(f"# {line}" for line in bench.texts.split("\n")), sep="\n")
            print(f"# {text}: why found {sorted(map(str, found))}, expected "
                  f"{sorted(map(str, wanted))}")
        for line in wrong:
            print(f"# {text}: log: {line}")
        recover(bench)
        for f in faults:
            f.restore(bench)
    print(f"# {title}: why {why} of {len(cases)}, log {log} of {shown} right")
    return why, log, shown


def main():
    """Return: the exit code."""
    tool, library, control, seed, folder, *load = sys.argv[1:]
    rng = random.Random(int(seed))
    kinds = KINDS + MORE
    only = os.environ.get("EC_FAULTS", "").split()
    if only:
        kinds = [k for k in kinds if k.__name__ in only]
    singles = [kinds[i % len(kinds)](rng) for i in range(2 * len(only) or SINGLE)]
    rng.shuffle(singles)
    doubles = [draw_double(rng) for _ in range(0 if only else DOUBLE)]
    bench = Bench(tool, library, control, folder, load)
    begin = time.monotonic()
    recover(bench)
    silent = run_group(bench, "runs without a fault", [[]] * NONE)
    groups = [run_group(bench, "single faults", [[f] for f in singles]),
              run_group(bench, "double faults", doubles)]
    bench.log.end()
    why, log, shown = (sum(g[i] for g in groups) for i in range(3))
    total = len(singles) + len(doubles)
    print(f"# seed {seed}: of {total} faults why names {why} with cause and place, "
          f"{100 * why / total:.1f} %, log {log} of the {shown} that are events, "
          f"{100 * log / max(shown, 1):.1f} %; of {NONE} runs without a fault why is silent in "
          f"{silent[0]}, log in {silent[1]}; {time.monotonic() - begin:.0f} s")
    results = ((silent[:2] == (NONE, NONE), "without a fault why and log are silent"),
               (100 * why >= 95 * total, "why names cause and place of 95 % of the faults"),
               (100 * log >= 95 * shown, "log names cause and place of 95 % of the faults"))
    for ok, text in results:
        print(f"{'ok' if ok else 'not ok'} - {text}")
    return 0 if all(ok for ok, _ in results) else 1


if __name__ == "__main__":
    if sys.argv[1:] == ["--segment"]:
        print(segment())
    else:
        sys.exit(main())
