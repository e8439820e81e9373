#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""A layer of master/ uses itself and lower layers only: what its files include, and what
its objects reference. MODDIR: folder where the modules have been built. See check-layers.sh.

Within a layer the rooms are counted that cannot be read alone. A room is a .c with its .h, or one
of them. It uses another one that it includes, one whose symbol its object needs, and one of which
its header declares a function. Rooms that all use one another, if by way of others, are a circle.

usage: check-layers.py MODDIR
"""
import glob
import os
import re
import subprocess
import sys
from collections import defaultdict

ORDER = ["kernel", "wire", "base", "link", "carry", "mailbox", "bus", "clock", "config", "cycle",
         "session", "eoe", "boundary", "top"]
# The first goes down to 0 with the structure of the cycle, never up.
MOST_UP_INCLUDES = 0
MOST_UP_SYMBOLS = 0
MOST_OPS = 12
MOST_IN_CIRCLE = 4
# Rooms of the largest circle of each layer: they only go down. None: printed only.
MOST_ROOMS = {"kernel": 0, "wire": 2, "base": 2, "link": 5, "carry": 5, "mailbox": 0, "bus": 6,
              "clock": 0, "config": 4, "cycle": 0, "session": 0, "eoe": 3, "boundary": None, "top": 2}
MOST_ROOMS_OF_NEW = 6

top = os.path.abspath(os.path.join(os.path.dirname(__file__), ".."))
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
PROTOTYPE = re.compile(
    r"^(?!static|return|typedef)[a-z][\w \t*]*?\b(\w+)\([^;{]*\)[^;{]*;", re.M)


def layer(path):
    """of a file, by its path below master/"""
    if path.startswith("../lib/ecrt/"):
        return "boundary"       # the functions of ecrt.h that are the library's as well
    return path.split("/")[0] if "/" in path else "top"


def files(*patterns):
    """[(path, its path below master/)]"""
    paths = [p for x in patterns for p in sorted(glob.glob(os.path.join(top, x), recursive=True))]
    return [(p, os.path.relpath(p, os.path.join(top, "master"))) for p in paths]


def includes(*patterns):
    """[(file, file)]: who includes whom, both below master/"""
    names = files(*patterns)
    known, found = {name for _, name in names}, []
    for path, name in names:
        with open(path) as f:
            for m in INCLUDE.finditer(f.read()):
                target = os.path.normpath(os.path.join(os.path.dirname(name), m.group(1)))
                if target in known:
                    found.append((name, target))
    return found


def symbols(moddir, *patterns):
    """[(file, file, symbol)]: whose object needs a symbol of which other object; {symbol: file}"""
    home, needs = {}, []
    for obj in sorted(o for x in patterns for o in glob.glob(os.path.join(moddir, x),
                                                             recursive=True)):
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
    return [(a, home[s], s) for a, s in needs if home.get(s, a) != a], home


def declares(home, *patterns):
    """[(header, file)]: who declares a function of whom"""
    found = []
    for path, name in files(*patterns):
        with open(path) as f:
            text = re.sub(r"/\*.*?\*/", "", f.read(), flags=re.S)
        found += [(name, home[s]) for s in PROTOTYPE.findall(text) if s in home]
    return found


def rooms(edges, where):
    """the circles of rooms of the files for which where() is true"""
    inside = {(os.path.splitext(a)[0], os.path.splitext(b)[0]) for a, b, *_ in edges
              if where(a) and where(b)}
    return circles({(a, b) for a, b in inside if a != b})


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


def pages():
    """pages that do not name the layers as they are"""
    with open(os.path.join(top, "CONTRIBUTING.md")) as f:
        text = f.read().split("from the bottom:")[-1].split("itself.")[0]
    with open(os.path.join(top, "Documentation/architecture.rst")) as f:
        table = f.read().split("\nlayer ", 1)[-1].split("\n\n", 1)[0]
    found = {"CONTRIBUTING.md": re.findall(r"`(\w+)`", text),
             "architecture.rst": re.findall(r"^``(\w+)``", table, re.M)}
    return ["%s has: %s" % (p, ", ".join(names)) for p, names in found.items()
            if names != ORDER[:-1]]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    ours = ("master/**/*.[ch]", "lib/ecrt/*.[ch]")
    inc, (sym, home) = includes(*ours), symbols(sys.argv[1], "master/**/*.o", "lib/ecrt/*.o")
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
    wrong = pages()
    print("".join("page: %s\n" % line for line in wrong), end="")
    print("references down: %d" % down)
    every = inc + sym + declares(home, "master/**/*.h", "lib/ecrt/*.h")
    most = {name: rooms(every, lambda f, name=name: layer(f) == name) for name in ORDER}
    sim, sim_home = symbols(sys.argv[1], "devices/sim/*.o")
    most["the simulator"] = rooms(includes("devices/sim/*.[ch]") + sim +
                                  declares(sim_home, "devices/sim/*.h"), lambda f: True)
    for name, found in most.items():
        for ring in found:
            print("%s: circle of %d rooms: %s" % (name, len(ring),
                                                  " ".join(map(os.path.basename, ring))))
    results = [("pages with other layers", len(wrong), 0),
               ("includes up", len(up_inc), MOST_UP_INCLUDES),
               ("symbols up", len(up_sym), MOST_UP_SYMBOLS),
               ("members of ops", members_of_ops(), MOST_OPS),
               ("files of the largest circle", largest, MOST_IN_CIRCLE)]
    results += [("rooms of the largest circle in %s" % name,
                 len(most[name][-1]) if most[name] else 0, limit)
                for name, limit in ((n, MOST_ROOMS.get(n, MOST_ROOMS_OF_NEW)) for n in ORDER)
                if limit is not None]
    failed = 0
    for name, value, limit in results:
        print("%s %s: %d (at most %d)" % ("ok" if value <= limit else "not ok", name, value, limit))
        failed += value > limit
        if value < limit and "rooms" in name:
            print("lower the limit: %s: %d" % (name, value))
    print("%d passed, %d failed" % (len(results) - failed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
