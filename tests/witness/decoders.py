#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Every function of the codecs (master/wire, and the slave's side of the
simulator) that takes bytes is run by golden vectors (tests/unit/vectors*_kunit.c)
and by a fuzz target (tests/fuzz); measured with
gcov. With DATA= the real images and captures are measured, too.

usage: decoders.py [BUILD-FOLDER]
"""
import glob
import gzip
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

top = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
build = os.path.abspath(sys.argv[1] if len(sys.argv) > 1
                        else os.path.join(top, "build/decoders"))
CFLAGS = ["-std=gnu11", "-g", "-O1", "-fno-inline", "--coverage",
          "-I" + os.path.join(top, "tests/unit")]
# what a function gets from the wire, and what it never writes through
BYTES = re.compile(r"const u8 \*|const u8 \w+\[|struct ec_rbuf \*|"
                   r"struct ec_\w*iter \*|u8 \*frame|const struct ec_sii_pdo \*")

SIM_CODECS = ["esc_page", "mbox_encode", "sdo_server", "sdoinfo_server", "sii_build"]


def run(*args, **kw):
    return subprocess.run(args, check=True, cwd=build, **kw)


def find(*parts):
    return sorted(glob.glob(os.path.join(top, *parts)))


def codecs():
    """the files this is about"""
    return find("master/wire/*.c") + [f for name in SIM_CODECS
                                      for f in find("devices/sim", name + ".c")]


def decoders():
    """{name: file} of the functions, static ones too, that take bytes"""
    found = {}
    for path in codecs():
        with open(path) as f:
            text = f.read()
        for m in re.finditer(r"^(?:static )?[\w ]+?[ *](\w+)\(([^;{}]*?)\)\n\{", text, re.M):
            if BYTES.search(m.group(2)):
                found[m.group(1)] = os.path.basename(path)
    return found


def compile_one(path):
    # a file of the tests may have the name of one of the codecs
    obj = ("" if path in codecs() else "test_") + os.path.splitext(os.path.basename(path))[0] + ".o"
    run("gcc", *CFLAGS, "-c", path, "-o", obj)
    return obj


def link(name, *objs):
    run("gcc", "--coverage", "-fsanitize=address", "-o", name, *objs)
    return "./" + name


def counts(*commands):
    """runs programs; {function: calls} of the codecs"""
    for f in glob.glob(os.path.join(build, "*.gcda")):
        os.unlink(f)
    for c in commands:
        run(*c, stdout=subprocess.DEVNULL)
    calls = {}
    for path in codecs():
        data = os.path.splitext(os.path.basename(path))[0] + ".gcda"
        if not os.path.exists(os.path.join(build, data)):
            continue
        out = run("gcov", "--json-format", "--stdout", data, stdout=subprocess.PIPE).stdout
        if out[:2] == b"\x1f\x8b":
            out = gzip.decompress(out)
        for f in json.loads(out)["files"]:
            if os.path.basename(f["file"]) == os.path.basename(path):
                for fn in f["functions"]:
                    calls[fn["name"]] = fn["execution_count"]
    return calls


def main():
    os.makedirs(build, exist_ok=True)
    wire = find("master/wire/*.c")
    vectors = find("tests/unit/vectors*_kunit.c") + find("tests/unit/kunit_user_main.c")
    # the reader of bus files is no decoder of master/wire
    # of these two only the tools decode
    fuzz = [f for f in find("tests/fuzz/fuzz_*.c")
            if not f.endswith(("/fuzz_bus.c", "/fuzz_record.c"))]
    data = find("tests/data-check/*.c")
    driver = find("tests/fuzz/driver.c")
    # the model without what needs a kernel; wire_unity.c repeats master/wire
    sim = [f for f in find("devices/sim/*.c")
           if not re.search(r'^#include (<linux/|.*\.c")', open(f).read(), re.M)]
    with ThreadPoolExecutor(2) as pool:
        paths = wire + sim + vectors + fuzz + data + driver
        objs = dict(zip(paths, pool.map(compile_one, paths)))
    of = lambda files: [objs[f] for f in files]

    columns = {"vectors": counts([link("vectors", *of(vectors + wire + sim))])}
    columns["fuzz"] = counts(*[[link(objs[f][:-2], objs[f], *of(driver + wire + sim)), "10000"]
                               for f in fuzz])
    if os.environ.get("DATA"):
        columns["data"] = counts([link("data_check", *of(data + wire + sim)),
                                  os.path.abspath(os.environ["DATA"])])
    passed = failed = 0
    print("%-28s %-10s %s" % ("decoder", "file", "".join("%10s" % c for c in columns)))
    for name, path in sorted(decoders().items(), key=lambda d: (d[1], d[0])):
        n = {c: columns[c].get(name, 0) for c in columns}
        missing = [c for c in ("vectors", "fuzz") if not n[c]]
        print("%-28s %-10s %s%s" % (name, path, "".join("%10d" % n[c] for c in columns),
                                    "  FAIL: not run by " + " and ".join(missing)
                                    if missing else ""))
        failed += bool(missing)
        passed += not missing
    print("%d passed, %d failed" % (passed, failed))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
