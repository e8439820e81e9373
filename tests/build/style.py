#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""House rules of CONTRIBUTING.md that a machine can decide, each with its findings.

spdx       the first lines of each file name a license, whose text is in LICENSES/
lines      no line is longer than 100 columns, except for a string, since texts are not split
kernel-doc every kernel-doc comment is complete; the script is the one of KDIR
checkpatch checkpatch.pl of the kernel reports nothing except IGNORE; CHECKPATCH is its path
names      a KUnit case is named <area>_<condition>_<expected>: in tests/unit the area is the name
           of the file; no articles, no words that texts.py replaces; bats tests likewise
globals    a function of master/ that other files call is named after its file, the first word of
           the file's name, or a structure of its layer; ec_ioc_ is followed by the command
members    a structure of the layers IN_PLACE describes each member where it is declared, not above:
           who adds one sees whether it is described
reach      a case of tests/bus reaches members of struct ec_master by access.h, and no other way
statics    no two static functions of a module have the same name: a trace shows nothing else of
           them. One that stands twice begins with the name of its file: log_take()

LIMITS has the findings that are left in each folder. They only go down; None: printed only.
usage: style.py RULE [FILE...]      default: all files of git
"""
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COLUMNS = 100

# rule, folder: findings that are left
LIMITS = {
    ("lines", "tests"): 131,
    ("lines", "master"): 2,
    ("lines", "Documentation"): 0,
    ("lines", "README.md"): 2,
    ("kernel-doc", "master"): 0,
    ("checkpatch", "master"): 8,
    ("statics", "master"): 0,
    ("statics", "devices"): None,
    ("statics", "lib"): None,
    ("statics", "tool"): None,
}

# files that cannot have a comment, and what was not written by hand
NO_SPDX = re.compile(r"^COPYING$|^LICENSES/|\.gitignore$|\.md$|\.lock$|\.seg$|\.map$|\.pc\.in$"
                     r"|^tests/tool/golden/|^tests/lib/prototypes|^tests/build/commands\.txt$"
                     r"|^tests/uml/skip\.list$|^debian/(changelog|source/format)$")
NO_WRAP = re.compile(r"^LICENSES/|\.lock$|^tests/tool/golden/|^tests/build/commands\.txt$"
                     r"|^tests/lib/prototypes|^tool/(ethercat|man/.*)\.8$")

USERSPACE = ("tool", "lib", "include", "examples")
# type of checkpatch: folders (none: all), reason
IGNORE = {
    "NEW_TYPEDEFS": (("include",), "the types of ecrt.h are a fixed interface"),
    "VOLATILE": (USERSPACE, "signal handlers, and memory shared with the module"),
    "SINGLE_STATEMENT_DO_WHILE_MACRO": (("include",), "EC_WRITE_*() are no values"),
    "ARRAY_SIZE": (USERSPACE, "a macro of the kernel"),
    "PREFER_DEFINED_ATTRIBUTE_MACRO": (USERSPACE + ("master",), "macros of the kernel; "
                                       "master/wire is compiled in userspace"),
    "USE_NEGATIVE_ERRNO": (USERSPACE, "userspace returns errno values"),
    "AVOID_EXTERNS": (("tool",), "the table of commands"),
    "SUSPECT_COMMA_SEMICOLON": (("tool",), "(void)argc, (void)argv;"),
    "MINMAX": ((), "a cast of the shorter argument cannot truncate; min_t() can"),
    "EMBEDDED_FUNCTION_NAME": ((), "a word of a message that is also a static function"),
    "COMPLEX_MACRO": ((), "initializers"),
    "MACRO_WITH_FLOW_CONTROL": (("lib",), "macros that define a function"),
    "REPEATED_WORD": ((), "slave io io"),
    "SPDX_LICENSE_TAG": (("tool",), "a line of the man page, in a string"),
    "EXPORT_SYMBOL": (("lib",), "what the macro is in userspace"),
    "LINUX_VERSION_CODE": (("master", "devices", "examples"),
                           "modules for 6.1 to 7.3 from one source"),
    "CONSTANT_COMPARISON": (("master", "devices", "examples"), "LINUX_VERSION_CODE is no constant"),
}

STRING = re.compile(r'"(?:\\.|[^"\\])*"')


def files(args, suffixes=()):
    if args:
        names = args
    else:
        names = subprocess.run(["git", "-c", "safe.directory=*", "ls-files"], cwd=ROOT, check=True,
                               stdout=subprocess.PIPE, text=True).stdout.split("\n")
    for name in filter(None, names):
        path = ROOT / name      # an absolute name stands for itself
        if path.is_file() and not path.is_symlink() and (not suffixes or path.suffix in suffixes):
            yield name, path


def spdx(args):
    texts = {p.stem for p in (ROOT / "LICENSES").iterdir()}
    for name, path in files(args):
        if NO_SPDX.search(name):
            continue
        head = "\n".join(path.read_text(errors="replace").split("\n")[:5])
        found = re.search(r"SPDX-License-Identifier: ([\w. -]+)", head)
        if not found:
            yield f"{name}:1: no SPDX-License-Identifier in the first five lines"
            continue
        for word in found[1].split():
            if word not in texts and word not in ("OR", "WITH") and word != "GPL-2.0":
                yield f"{name}:1: LICENSES/ has no text of {word}"


def lines(args):
    for name, path in files(args):
        if NO_WRAP.search(name):
            continue
        for number, line in enumerate(path.read_text(errors="replace").split("\n"), 1):
            line = line.expandtabs(8)
            if len(line) <= COLUMNS:
                continue
            if any(m.start() < COLUMNS <= m.end() + 3 for m in STRING.finditer(line)):
                continue    # 3: what follows the string
            yield f"{name}:{number}: {len(line)} columns, limit {COLUMNS}"


CODE = ("master", "devices", "include", "lib", "tool", "examples")


def code(args):
    return [n for n, _ in files(args, (".c", ".h")) if args or n.split("/")[0] in CODE]


def kernel_doc(args):
    script = Path(os.environ["KDIR"]) / "scripts/kernel-doc"
    out = subprocess.run([script, "-none"] + code(args), cwd=ROOT, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True).stdout
    for line in out.split("\n"):
        if re.search(r":\d+: (warning|error): ", line):
            yield line


def checkpatch(args):
    out = subprocess.run(["perl", os.environ["CHECKPATCH"], "--no-tree", "-f", "--terse",
                          "--show-types", "--no-summary", f"--max-line-length={COLUMNS}"] +
                         code(args), cwd=ROOT, stdout=subprocess.PIPE, text=True).stdout
    for line in out.split("\n"):
        m = re.match(r"(\S+?):\d+: (?:ERROR|WARNING):(\w+):", line)
        if m:
            folders, _ = IGNORE.get(m[2], ((None,), ""))
            if folders and m[1].split("/")[0] not in folders:
                yield line


# words of texts.py that are clear in a name
WORDS = re.compile(r"(?<![a-z])(a|an|the|told|tells?|odd|vain|who|nobody|somebody|dies|death|heir"
                   r"|lanes?|anew|shall|mess|what|whatever)(?![a-z])")


def names(args):
    for name, path in files(args, (".c", ".bats")):
        if not args and not name.startswith("tests/"):
            continue
        text = path.read_text()
        cases = re.finditer(r"^\tKUNIT_CASE\w*\((\w+)|^@test \"(.*)\" \{", text, re.M)
        for m in cases:
            number = text.count("\n", 0, m.start()) + 1
            case = m[1] or re.sub(r"\b(a|an|the)\b", "", m[2])
            bad = WORDS.search(case.lower())
            area = path.stem.removesuffix("_kunit") + "_"
            if bad:
                yield f"{name}:{number}: '{bad[1]}' in {m[1] or m[2]}"
            elif m[1] and "_" not in case:
                yield f"{name}:{number}: {case} has no condition"
            elif m[1] and name.startswith("tests/unit/") and not case.startswith(area):
                yield f"{name}:{number}: {case} does not begin with {area}"


FUNCTION = re.compile(r"^(?!static|return|else)[a-z][\w \t*]*?\b(\w+)\([^;{]*\)\n\{", re.M)
FIXED = re.compile(r"ecrt_|ecdev_|ec_ioc($|_)|ec_(command|complain|refuse)$")    # interfaces


def globals_(args):
    for name, path in files(args, (".c",)):
        if not args and not name.startswith("master/"):
            continue
        layer = "".join(h.read_text() for h in path.parent.glob("*.[ch]"))
        owners = set(re.findall(r"^(?:struct|enum|union) ec_(\w+) \{", layer, re.M))
        owners |= {path.stem, path.stem.split("_")[0]}
        for m in FUNCTION.finditer(re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S)):
            if not FIXED.match(m[1]) and not any(m[1].startswith(f"ec_{o}") for o in owners):
                yield f"{name}:1: {m[1]}() is not named after it"


IN_PLACE = ("link", "carry", "mailbox", "cycle", "session", "boundary")
ABOVE = re.compile(r"^/\*\*\n(?:(?!\*/)[^\n]*\n)*? \* @\w[^:\n]*:(?:(?!\*/).)*?\*/\n"
                   r"(struct \w+) \{", re.M | re.S)


def members(args):
    for name, path in files(args, (".c", ".h")):
        if not args and not name.startswith(tuple(f"master/{layer}/" for layer in IN_PLACE)):
            continue
        text = path.read_text()
        for m in ABOVE.finditer(text):
            number = text.count("\n", 0, m.start(1)) + 1
            yield f"{name}:{number}: members of {m[1]} are described above it, not in place"


REACH = re.compile(r"\bb->m->\w+")


def reach(args):
    for name, path in files(args, (".c", ".h")):
        if args or (name.startswith("tests/bus/") and not path.stem.startswith("access")):
            text = path.read_text()
            for m in REACH.finditer(text):
                yield f"{name}:{text.count(chr(10), 0, m.start()) + 1}: {m[0]}, not by access.h"


STATIC = re.compile(r"^static\b[^=;{}()]*\b(\w+)\((?=[^;]*?\)[^;=]*?\n\{)", re.M)
MODULES = ("master/", "devices/sim/", "devices/intel/", "devices/", "lib/", "tool/")


def statics(args):
    places = {}
    for name, path in files(args, (".c", ".h")):
        module = next((m for m in MODULES if name.startswith(m)), None)
        if not module and not args:
            continue
        text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m[0].count("\n"), path.read_text(), flags=re.S)
        for m in STATIC.finditer(text):
            number = text.count("\n", 0, m.start()) + 1
            places.setdefault((module, m[1]), []).append(f"{name}:{number}")
    for (_, function), found in sorted(places.items()):
        if len(found) > 1:
            yield f"{found[0]}: {function}() is also in {', '.join(found[1:])}"


RULES = {"globals": globals_, "statics": statics, "members": members, "names": names,
         "reach": reach, "spdx": spdx, "lines": lines, "kernel-doc": kernel_doc,
         "checkpatch": checkpatch}


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in RULES:
        print(__doc__)
        return 2
    rule, failed, by_folder = sys.argv[1], False, {}
    for found in RULES[rule](sys.argv[2:]):
        by_folder.setdefault(re.split(r"[/:]", found)[0], []).append(found)
    for folder, found in sorted(by_folder.items()):
        limit = LIMITS.get((rule, folder), 0)
        if limit is None or len(found) > limit:
            failed |= limit is not None
            print("\n".join(found))
        print(f"{folder}: {len(found)} findings of {rule}, " +
              ("no limit" if limit is None else f"limit {limit}"))
    for (a_rule, folder), limit in LIMITS.items():
        if a_rule == rule and limit and not sys.argv[2:] and len(by_folder.get(folder, ())) < limit:
            print(f"{folder}: lower the limit to {len(by_folder.get(folder, ()))}")
    return 1 if failed else 0


sys.exit(main())
