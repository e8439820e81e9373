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
from why_faults import (KINDS, N, SETTLE_S, Alias, Counter, Different, NoCycle, behind,
                        segment)

SINGLE, DOUBLE, NONE = 48, 12, 10


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
        if is_gone(f.slave, own) and not isinstance(f, Alias):
            continue
        # the position of its configuration means another slave then
        if isinstance(f, Different) and any(is_gone(k) for k in range(f.slave)):
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


if __name__ == "__main__":
    if sys.argv[1:] == ["--segment"]:
        print(segment())
    else:
        sys.exit(main())
