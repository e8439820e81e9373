#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""The reference of the application interface, from the kernel-doc comments of include/ecrt.h.

usage: api.py ECRT.H [KERNEL-DOC]   writes reStructuredText to stdout; KERNEL-DOC: read the comments
                                    with this script of the kernel instead of kerneldoc.py
"""
import re
import subprocess
import sys

import kerneldoc

# heading, what the names of its functions begin with; the first that fits has the function
GROUPS = (
    ("Slave configuration", "ecrt_slave_config_"),
    ("Domain", "ecrt_domain_"),
    ("SDO request", "ecrt_sdo_request_"),
    ("Request of SDO information", "ecrt_sdo_info_"),
    ("SoE request", "ecrt_soe_request_"),
    ("FoE request", "ecrt_foe_request_"),
    ("VoE handler", "ecrt_voe_handler_"),
    ("Register request", "ecrt_reg_request_"),
    ("Datagram request", "ecrt_datagram_request_"),
    ("Master", "ecrt_master_"),
    ("Opening and versions", "ecrt_"),
    ("Data", "EC_"),
    ("Types", ""),
)
ORDER = ("Opening and versions", "Master", "Slave configuration", "Domain", "SDO request",
         "Request of SDO information", "SoE request", "FoE request", "VoE handler",
         "Register request", "Datagram request", "Data", "Types")

HEAD = """.. SPDX-License-Identifier: GPL-2.0-only

=====================
Application interface
=====================

``include/ecrt.h``, in userspace (libethercat) and in the kernel. :doc:`examples` describes the life
of an application.
"""


def blocks(text):
    """(name, lines) of each function and type"""
    name, lines = None, []
    for line in text.split("\n") + [".. c:end:: end"]:
        found = re.match(r"\.\. c:(\w+):: (.*)", line)
        if not found:
            lines.append(line)
            continue
        if name:
            yield name, lines
        what = found[2].replace("EC_PUBLIC_API ", "")
        name = re.search(r"(\w+) *\(|(\w+)$", what)
        name = name and (name[1] or name[2])
        lines = [f".. c:{found[1]}:: {what}"]


def linked(lines, names):
    """Functions in the text become links."""
    def link(match):
        return f":c:func:`{match[1]}()`" if match[1] in names else match[0]

    yield lines[0]
    for line in lines[1:]:
        yield re.sub(r"(?<![\w`:*])(\w+)\(\)(?!`)", link, line)


def main():
    header, *script = sys.argv[1:]
    if script:
        text = subprocess.run(["perl", *script, "-rst", header], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
    else:
        with open(header) as file:
            text = "\n".join(kerneldoc.document(file.read()))
    found = list(blocks(text))
    if not found:
        sys.exit(f"{sys.argv[0]}: no comment in {header}")
    names = {name for name, _ in found}
    groups = {title: [] for title in ORDER}
    for name, lines in found:
        title = next(t for t, prefix in GROUPS if name.startswith(prefix))
        groups[title].extend(linked(lines, names - {name}))
    print(HEAD)
    for title in ORDER:
        if groups[title]:
            print(f"{title}\n{'=' * len(title)}\n")
            print("\n".join(groups[title]))


main()
