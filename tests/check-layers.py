#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""A layer of master/ uses itself and lower layers only: what its files include, and what
its objects reference. MODDIR: folder where the modules have been built. See check-layers.sh.

usage: check-layers.py MODDIR
"""
import glob
import os
import re
import subprocess
import sys
from collections import defaultdict

ORDER = ["wire", "base", "link", "carry", "mailbox", "bus", "clock", "config", "cycle", "session",
         "boundary", "top"]
# The first goes down to 0 with the structure of the cycle, never up.
MOST_UP_INCLUDES = 0
MOST_UP_SYMBOLS = 0
MOST_OPS = 12
MOST_IN_CIRCLE = 4

top = os.path.abspath(os.path.join(os.path.dirname(__file__), ".."))
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)


def layer(path):
    """of a file, by its path below master/"""
    if path.startswith("../lib/ecrt/"):
        return "boundary"       # the functions of ecrt.h that are the library's as well
    return path.split("/")[0] if "/" in path else "top"


def includes():
    """[(file, file)]: who includes whom, both below master/"""
    found = []
    shared = glob.glob(os.path.join(top, "lib/ecrt/*.[ch]"))
    for path in sorted(glob.glob(os.path.join(top, "master/**/*.[ch]"), recursive=True) + shared):
        name = os.path.relpath(path, os.path.join(top, "master"))
        with open(path) as f:
            for m in INCLUDE.finditer(f.read()):
                target = os.path.normpath(os.path.join(os.path.dirname(name), m.group(1)))
                if target.startswith("..") and not target.startswith("../lib/ecrt/"):
                    continue
                if os.path.exists(os.path.join(top, "master", target)):
                    found.append((name, target))
    return found


def symbols(moddir):
    """[(file, file, symbol)]: whose object needs a symbol of which other object"""
    home, needs = {}, []
    objects = glob.glob(os.path.join(moddir, "master/**/*.o"), recursive=True)
    shared = glob.glob(os.path.join(moddir, "lib/ecrt/*.o"))
    for obj in sorted(objects + shared):
        name = os.path.relpath(obj, os.path.join(moddir, "master"))[:-2] + ".c"
        if not os.path.exists(os.path.join(top, "master", name)):
            continue    # ec_master.o and what belongs to a module as a whole
        out = subprocess.run(["nm", obj], check=True, stdout=subprocess.PIPE, text=True).stdout
        for line in out.splitlines():
            kind, symbol = line.split()[-2:]
            if kind == "U":
                needs.append((name, symbol))
            elif kind in "TDBRVW":
                home[symbol] = name
    return [(a, home[s], s) for a, s in needs if home.get(s, a) != a]


def circles(edges):
    """the strongly connected sets of more than one file"""
    after = defaultdict(set)
    for a, b in edges:
        after[a].add(b)
    seen, low, stack, sets = {}, {}, [], []

    def visit(v):
        seen[v] = low[v] = len(seen)
        stack.append(v)
        for w in after[v]:
            if w not in seen:
                visit(w)
            if w in stack:
                low[v] = min(low[v], low[w])
        if low[v] == seen[v]:
            group = []
            while not group or group[-1] != v:
                group.append(stack.pop())
            if len(group) > 1:
                sets.append(sorted(group))
    sys.setrecursionlimit(10000)
    for v in list(after):
        if v not in seen:
            visit(v)
    return sorted(sets, key=len)


def members_of_ops():
    """function pointers of all structures named ..._ops, without those of the kernel"""
    count = 0
    for path in glob.glob(os.path.join(top, "master/**/*.h"), recursive=True):
        with open(path) as f:
            for m in re.finditer(r"^struct \w+_ops \{(.*?)^\};", f.read(), re.M | re.S):
                count += len(re.findall(r"\(\*\w+\)", m.group(1)))
    return count


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    inc, sym = includes(), symbols(sys.argv[1])
    if not sym:
        sys.exit("check-layers: no objects below %s/master: build the modules there first"
                 % sys.argv[1])
    level = {name: i for i, name in enumerate(ORDER)}
    unknown = {layer(f) for pair in inc for f in pair} - set(ORDER)
    if unknown:
        sys.exit("check-layers: no such layer: " + ", ".join(sorted(unknown)))
    up_inc = sorted({(a, b) for a, b in inc if level[layer(b)] > level[layer(a)]})
    up_sym = sorted({(a, b, s) for a, b, s in sym if level[layer(b)] > level[layer(a)]})
    down = sum(level[layer(b)] < level[layer(a)] for a, b, *_ in inc + sym)
    # by files: a header that composes others makes no circle of all who include it
    rings = circles({(a, b) for a, b, *_ in inc + sym})
    largest = len(rings[-1]) if rings else 0
    for a, b in up_inc:
        print("include up: %s includes %s" % (a, b))
    for a, b, s in up_sym:
        print("reference up: %s uses %s of %s" % (a, s, b))
    for ring in rings:
        print("circle of %d: %s" % (len(ring), " ".join(ring)))
    print("layers: %s" % ", ".join(ORDER))
    print("references down: %d" % down)
    results = [("includes up", len(up_inc), MOST_UP_INCLUDES),
               ("symbols up", len(up_sym), MOST_UP_SYMBOLS),
               ("members of ops", members_of_ops(), MOST_OPS),
               ("files of the largest circle", largest, MOST_IN_CIRCLE)]
    failed = 0
    for name, value, most in results:
        print("%s %s: %d (at most %d)" % ("ok" if value <= most else "not ok", name, value, most))
        failed += value > most
    print("%d passed, %d failed" % (len(results) - failed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
