#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""No number and no member of include/uapi changes: the headers as they were when a version was
frozen (tests/abi/v*/uapi) are compared with those of this tree, as a compiler lays them out.

A structure may grow at its end, a command with it; everything else is as it was, with each compiler
the same. No structure of a command contains an array of structures: those could not grow.

usage: layout.py [--new FOLDER] [CC...]     default: include/uapi, cc; each CC as one argument
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent.parent
COMMENT = re.compile(r"/\*.*?\*/", re.S)
STRUCT = re.compile(r"struct (\w+) \{(.*?)\n\};", re.S)
MEMBER = re.compile(r"(\w+)(?:\[[^\]]*\])?;")
MACRO = re.compile(r"#define (EC_\w+)[ \t]+(\S.*)")


def names(folder):
    """({structure: [member]}, [constant], [command])"""
    structs, constants, commands = {}, [], []
    for path in sorted(folder.glob("*.h")):
        text = COMMENT.sub("", path.read_text())
        for m in STRUCT.finditer(text):
            structs[m[1]] = [f for line in m[2].split("\n") for f in MEMBER.findall(line)]
        for m in MACRO.finditer(text):
            (commands if re.match(r"EC_IOC_(RW?|W|N)\(", m[2]) else constants).append(m[1])
    return structs, constants, commands


def layout(folder, known, cc):
    """{name: (what, numbers)} of all that is in @known, from the headers in @folder"""
    structs, constants, commands = known
    have = names(folder)
    lines = ['#include "ethercat.h"', "#include <stddef.h>", "#include <stdio.h>",
             "int main(void) {"]
    for s, members in structs.items():
        if s not in have[0]:
            continue
        lines.append(f'printf("struct {s} size %zu\\n", sizeof(struct {s}));')
        lines += [f'printf("struct {s}.{m} at %zu\\n", offsetof(struct {s}, {m}) * 65536 + '
                  f"sizeof(((struct {s} *)0)->{m}));" for m in members if m in have[0][s]]
    lines += [f'printf("{c} is %lld\\n", (long long)({c}));' for c in constants if c in have[1]]
    lines += [f'printf("{c} number %u\\n", '
              f'(unsigned int)({c} & ~(_IOC_SIZEMASK << _IOC_SIZESHIFT)));'
              f'printf("{c} size %u\\n", (unsigned int)_IOC_SIZE({c}));'
              for c in commands if c in have[2]]
    lines.append("return 0; }")
    with tempfile.TemporaryDirectory() as tmp:
        source, program = Path(tmp, "layout.c"), Path(tmp, "layout")
        source.write_text("\n".join(lines))
        subprocess.run([*cc.split(), "-w", "-I", str(folder), "-o", str(program), str(source)],
                       check=True)
        out = subprocess.run([str(program)], check=True, stdout=subprocess.PIPE, text=True).stdout
    return {line.rsplit(" ", 1)[0]: int(line.rsplit(" ", 1)[1]) for line in out.splitlines()}


def compare(old, new, cc):
    """[finding]"""
    # a version counts what the interface has gained
    known = names(old)
    before = layout(old, known, cc)
    after = layout(new, known, cc)
    before.pop("EC_UAPI_VERSION is", None)
    found = []
    for name, value in before.items():
        if name not in after:
            found.append(f"{name} {value}: missing")
        elif name.endswith("_ALL is"):
            if after[name] & value != value:
                found.append(f"{name} {after[name]}, was {value}: bits are missing")
        elif name.endswith(" size") and after[name] < value:
            found.append(f"{name} {after[name]}, was {value}")
        elif not name.endswith(" size") and after[name] != value:
            found.append(f"{name} {after[name]}, was {value}")
    return found, before


# mapped memory, whose pages have a version of their own
MAPPED = ("ec_status", "ec_exchange_buffer")


def arrays(folder):
    """[finding]: arrays of structures in structures of commands"""
    for path in sorted(folder.glob("*.h")):
        for m in STRUCT.finditer(COMMENT.sub("", path.read_text())):
            for a in re.finditer(r"\tstruct (\w+) (\w+)\[", m[2]):
                if m[1] not in MAPPED:
                    yield f"{path.name}: {m[1]}.{a[2]} is an array of structures"


def main():
    args = sys.argv[1:]
    new = TOP / "include/uapi"
    if args[:1] == ["--new"]:
        new, args = Path(args[1]), args[2:]
    wrong = list(arrays(new))
    print("".join(f"{line}\n" for line in wrong), end="")
    findings = len(wrong)
    for old in sorted((TOP / "tests/abi").glob("v*/uapi")):
        first = None
        for cc in args or ["cc"]:
            found, here = compare(old, new, cc)
            first = first or here
            found += [f"{name} {here.get(name)}, with {(args or ['cc'])[0]} {first[name]}"
                      for name in first if here.get(name) != first[name]]
            n = len(here)
            for line in found:
                print(f"{old.parent.name}, {cc}: {line}")
            print(f"{old.parent.name}, {cc}: {n} members, numbers and sizes, {len(found)} changed")
            findings += len(found) + (not n)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
