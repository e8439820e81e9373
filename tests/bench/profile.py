#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Count what profile.sh has recorded: system calls of the cycle, by function or by line.

usage: profile.py FOLDER MODULES [receive|send FUNCTION]
"""
import bisect
import collections
import pathlib
import re
import subprocess
import sys

CALLS = {"ec_cycle_do_receive": "receive", "ec_cycle_do_send": "send"}
MODULES = {"ec_master": "master/ec_master.ko", "ec_intel": "devices/intel/ec_intel.ko"}


def symbols(folder):
    """Sorted addresses, and name and module of each."""
    found = []
    for line in open(folder / "symbols"):
        address, kind, name, *module = line.split()
        if kind in "tTwW":
            found.append((int(address, 16), name, module[0].strip("[]") if module else ""))
    found.sort()
    return [f[0] for f in found], found


def calls(folder, addresses, names):
    """Addresses of each system call that is one of the cycle."""
    entry = next(a for a, name, _ in names if name == "entry_SYSCALL_64")
    pattern = re.compile(r"/([0-9a-f]{16})/")
    known, steps = {}, None
    for line in open(folder / "steps"):
        match = pattern.search(line)
        if not match:
            continue
        pc = int(match[1], 16)
        if pc == entry:
            steps, what = [], None
        if steps is None:
            continue
        if pc < 1 << 47:
            if what:
                yield what, steps
            steps = None
            continue
        if pc not in known:
            known[pc] = names[bisect.bisect_right(addresses, pc) - 1]
        what = CALLS.get(known[pc][1], what)
        steps.append((pc, known[pc]))


def by_function(what, steps):
    """In the order in which they are called."""
    count = collections.Counter(symbol[1] for _, symbol in steps)
    print(f"{what}: {len(steps)} instructions")
    for name in dict.fromkeys(symbol[1] for _, symbol in steps):
        print(f"{count[name]:6} {name}")


def by_line(steps, modules, function):
    """In the order in which they are executed; of inlined functions with their callers."""
    mine = [(pc, symbol) for pc, symbol in steps if symbol[1] == function]
    if not mine:
        sys.exit(f"profile.py: {function} is not called")
    address, _, module = mine[0][1]
    if module not in MODULES:
        sys.exit(f"profile.py: {function} is not of a module")
    file = modules / MODULES[module]
    nm = subprocess.check_output(["nm", file], text=True).splitlines()
    offset = next(int(n.split()[0], 16) for n in nm if n.split()[-1] == function)
    where = ["%x" % (pc - address + offset) for pc, _ in mine]
    out = subprocess.check_output(["addr2line", "-a", "-i", "-s", "-j", ".text", "-e", file]
                                  + where, text=True)
    lines = [" < ".join(line.split(" (")[0] for line in block.splitlines()[1:])
             for block in re.split(r"^(?=0x)", out, flags=re.M)[1:]]
    last, n = None, 0
    for line in lines + [None]:
        if line != last and last is not None:
            print(f"{n:6} {last}")
            n = 0
        last, n = line, n + 1


def main():
    folder, modules = map(pathlib.Path, sys.argv[1:3])
    kinds = collections.defaultdict(list)
    addresses, names = symbols(folder)
    for what, steps in calls(folder, addresses, names):
        kinds[what].append(steps)
    if set(kinds) != set(CALLS.values()):
        sys.exit("profile.py: no whole cycle was recorded")
    for what, all_steps in sorted(kinds.items()):
        steps = sorted(all_steps, key=len)[len(all_steps) // 2]
        if len(sys.argv) < 5:
            by_function(what, steps)
        elif what == sys.argv[3]:
            by_line(steps, modules, sys.argv[4])


main()
