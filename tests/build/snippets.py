#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Every example and every C snippet of the documentation compiles, as C99 and as C++20.

A snippet is a literal block whose row of commands.txt begins with "- : C"; a block with lines of
C that has another row is a finding. Rows "- : C of the kernel" are compiled as C of a kernel
module only: --kernel writes them, with a Kbuild, to FOLDER.
usage: snippets.py [--kernel FOLDER] [PAGE.rst...]
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import commands

ROOT = commands.ROOT
WARN = ["-Wall", "-Wextra", "-Wno-missing-field-initializers", "-Werror", "-fsyntax-only", f"-I{ROOT}/include"]
LANGUAGES = {
    "C99": [os.environ.get("CC", "gcc"), "-x", "c", "-std=c99", "-Wpedantic",
            "-D_POSIX_C_SOURCE=200809L"],
    "C++20": [os.environ.get("CXX", "g++"), "-x", "c++", "-std=c++20"],
}
C_LINE = re.compile(r"^\s*(\w+ \w+|\w+\(.*\)|for \(;;\)|[\w>.-]+ = .*);?\s*[;{]\s*(/\*.*)?$")
# what the text around a snippet presumes
PROGRAM = """#include <ecrt.h>
#include <ethercat-bus/load.h>
#include <ethercat-tools.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
extern ec_master_t *master;
extern ec_domain_t *domain;
extern ec_slave_config_t *config;
extern struct sched_param param;
"""
MODULE = """#include <linux/delay.h>
#include <linux/firmware.h>
#include <linux/kthread.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <ecrt.h>
static DEFINE_MUTEX(lock);
static ec_master_t *master;
static ec_domain_t *domain;
MODULE_LICENSE("GPL");
"""


def whole(block, number):
    """Functions stay as they are, statements become the body of one."""
    text = "\n".join(block)
    if re.match(r"static \w+ \w+\(", text):
        return text + "\n"
    return f"void snippet_{number}(void);\nvoid snippet_{number}(void)\n{{\n{text}\n}}\n"


def snippets(pages):
    """(place, block, of the kernel) of each snippet; a block that lacks its row as a finding."""
    rows = commands.table()
    for path in pages:
        for block in commands.blocks(path):
            test, text = rows.get(block[0].strip(), ("", ""))
            where = f"{path.name}: {block[0].strip()}"
            if test == "-" and re.match(r"C(,| of the kernel|$)", text):
                yield where, block, text.startswith("C of the kernel")
            elif sum(bool(C_LINE.match(line)) for line in block) > 1:
                yield where, None, False


def compiles(where, language, text):
    with tempfile.NamedTemporaryFile("w", suffix=".c") as file:
        file.write(text)
        file.flush()
        done = subprocess.run([*LANGUAGES[language], *WARN, "-Wno-unused", file.name],
                              capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"{where}: no {language}:\n{done.stderr}")
    return not done.returncode


def main(args):
    folder = None
    if args[:1] == ["--kernel"]:
        folder, args = Path(args[1]), args[2:]
    pages = [Path(a) for a in args] or [ROOT / "README.md", ROOT / "CONTRIBUTING.md",
                                        *sorted((ROOT / "Documentation").glob("*.rst"))]
    good, count, module = True, 0, MODULE
    for number, (where, block, kernel) in enumerate(snippets(pages)):
        if block is None:
            print(f"{where}: looks like C, and its row of commands.txt says something else")
            good = False
        elif kernel == bool(folder):
            count += 1
            if folder:
                module += whole(block, number)
                continue
            good &= all([compiles(where, lang, PROGRAM + whole(block, number))
                         for lang in LANGUAGES])
    if folder:
        (folder / "snippets.c").write_text(module)
        (folder / "Kbuild").write_text("ccflags-y += -I$(ECRT)\nobj-m += snippets.o\n")
    elif not args:
        for path in sorted((ROOT / "examples").glob("*.c")):
            count += 1
            good &= all([compiles(path.name, lang, path.read_text()) for lang in LANGUAGES])
    print(f"{count} texts")
    return 0 if good and count else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
