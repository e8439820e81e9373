#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Functions, commands and options of the IgH EtherCAT Master and its patch set against ours.

    igh.py functions USER KERNEL     files with a name in each line: declared and exported
    igh.py commands HELP TYPES       JSON of 'ethercat help' and 'ethercat help types'
    igh.py list                      igh.txt against the books in ../shared/reference, if they are
                                     there (exit status 0 and "not compared" otherwise)
    igh.py selftest USER KERNEL      a fact that is missing, and a reason that is not true, fail

igh.txt has a fact in each line. Each is there, or igh-reasons.txt has it with a reason.
"""
import json
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
BOOKS = os.path.join(HERE, "../../../shared/reference")
FUNCTIONS = ("user", "kernel")


def read(name):
    with open(name, encoding="utf-8") as f:
        return f.read()


def facts():
    return [line for line in read(os.path.join(HERE, "igh.txt")).splitlines()
            if line and line[0] != "#"]


def reasons():
    found = {}
    for line in read(os.path.join(HERE, "igh-reasons.txt")).splitlines():
        if not line or line[0] == "#":
            continue
        fact, _, reason = line.partition(": ")
        if len(reason) < 12 or fact in found:
            sys.exit(f"igh-reasons.txt: '{fact}' has no reason, or two")
        found[fact] = reason
    return found


def judge(wanted, there, excused):
    """Faults of the facts @wanted: what is neither there nor excused, or both."""
    for fact in wanted:
        if fact in there and fact in excused:
            yield f"{fact}: is there, so igh-reasons.txt must not have it"
        elif fact not in there and fact not in excused:
            yield f"{fact}: is missing; build it, or add a line to igh-reasons.txt"
    for fact in excused:
        if fact not in wanted:
            yield f"{fact}: igh-reasons.txt has it, igh.txt does not"


def part(of, functions):
    """The facts in @of that are functions, or those that are not."""
    return [f for f in of if (f.split()[0] in FUNCTIONS) == functions]


def named(user, kernel):
    return {f"{side} {name}" for side, file in (("user", user), ("kernel", kernel))
            for name in read(file).split()}


def tool(help_file, types_file):
    """What the tool has, in the words of igh.txt."""
    data = json.loads(read(help_file))
    there = {f"option --{o['long']}" + (f" -{o['short']}" if "short" in o else "")
             for o in data["options"]}
    for c in data["commands"]:
        letters = {o["short"] for o in c["options"] if "short" in o}
        for name in [c["name"], *c["also"]]:
            there.add(f"command {name}")
            there.update(f"command {name} -{letter}" for letter in letters)
    there.update("type " + t["name"] for t in json.loads(read(types_file))["types"])
    return there


def book_functions(text):
    own = re.findall(r"^#### `(ecrt_[a-z0-9_]+)`", text, re.M)
    summary = text[text.index("### 5.10"):text.index("## 6 ")]
    only = {}
    for side, key in (("kernel", "Kernel only"), ("user", "Userspace only")):
        items = re.search(rf"\*\*{key}\*\*(.*?)(?=^\*|\Z)", summary, re.M | re.S)[1]
        only[side] = set(re.findall(r"`(ecrt_[a-z0-9_]+)`", items))
    for name in own:
        if name not in only["kernel"]:
            yield f"user {name}"
        if name not in only["user"]:
            yield f"kernel {name}"
    patches = text[text.index("## 11 "):text.index("## 12 ")]
    for block in re.findall(r"```c\n(.*?)```", patches, re.S):
        for name in re.findall(r"\b(ecrt_[a-z0-9_]+)\(", block):
            yield f"user {name}"
            yield f"kernel {name}"
    # "which this tree also offers in userspace"
    yield "user ecrt_master_send_ext"
    tty = text[text.index("### 3.4"):text.index("## 4 ")]
    for name in re.findall(r"\b(ectty_[a-z_]+)\(", tty):
        yield f"kernel {name}"


def book_options(text):
    table = text[text.index("### 1.1"):text.index("### 1.2")]
    for short, long in re.findall(r"^\| `(-[a-z])` \| `(--[a-z-]+)` \|", table, re.M):
        yield f"option {long} {short}"
    table = text[text.index("### 1.8"):text.index("## 2. ")]
    for row in re.findall(r"^\| (`.*?) \| ", table, re.M):
        for name in re.findall(r"`([a-z_0-9]+)`", row):
            yield f"type {name}"


def book_commands(text):
    table = text[text.index("### 2.1"):text.index("### 2.2 ")]
    for row in re.findall(r"^\| (`.*?) \| ", table, re.M):
        for name in re.findall(r"`([a-z_]+)`", row):
            yield f"command {name}"
    # a heading names commands and the options that each of them uses
    for heading in re.findall(r"^### 2\.\d+ (.*)$", text, re.M):
        for item in heading.split("; "):
            names, _, uses = item.partition(" — ")
            for name in re.findall(r"`([a-z_]+)", names):
                for letter in "".join(re.findall(r"`(-[^`]*)`", uses)).replace(" ", "").split("-"):
                    if letter:
                        yield f"command {name} -{letter}"


def compare_books():
    if not os.path.isdir(BOOKS):
        print("not compared: no ../shared/reference here")
        return []
    api = read(os.path.join(BOOKS, "ecrt-api.md"))
    cli = read(os.path.join(BOOKS, "cli.md"))
    books = {*book_functions(api), *book_options(cli), *book_commands(cli)}
    listed = set(facts())
    print(f"{len(books)} facts of the books, {len(listed)} of igh.txt")
    return [f"{f}: in the books, not in igh.txt" for f in sorted(books - listed)] + \
        [f"{f}: in igh.txt, not in the books" for f in sorted(listed - books)]


def selftest(user, kernel):
    wanted, there, excused = part(facts(), True), named(user, kernel), part(reasons(), True)
    some = "user ecrt_master_send"
    trials = (
        ("a function that is missing", there - {some}, excused),
        ("a reason for what is there", there, [*excused, some]),
        ("a reason for no fact", there, [*excused, "user ecrt_no"]),
        ("a reason that is missing", there, excused[1:]),
    )
    for what, trial_there, trial_excused in trials:
        if len(list(judge(wanted, trial_there, trial_excused))) != 1:
            yield f"{what} is not noticed"


def main(what, *args):
    if what == "list":
        faults = compare_books()
    elif what == "functions":
        faults = list(judge(part(facts(), True), named(*args), part(reasons(), True)))
    elif what == "commands":
        faults = list(judge(part(facts(), False), tool(*args), part(reasons(), False)))
    else:
        faults = list(selftest(*args))
    print("\n".join(faults))
    return bool(faults)


sys.exit(main(*sys.argv[1:]))
