#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""An application that configures a product which is not there, and another revision.

usage: wrong_app.py LIBRARY POSITION PRODUCT REVISION_POSITION REVISION_PRODUCT

Activates, prints what ecrt_slave_config_reason() says of the first, and runs until
it is killed.
"""
import ctypes as c
import sys
import time


def main():
    lib = c.CDLL(sys.argv[1])
    pos, product, rpos, rproduct = (int(a, 0) for a in sys.argv[2:])
    for name in ("ecrt_request_master", "ecrt_master_create_domain", "ecrt_master_slave_config",
                 "ecrt_domain_data"):
        getattr(lib, name).restype = c.c_void_p
    master = c.c_void_p(lib.ecrt_request_master(0))
    lib.ecrt_master_create_domain(master)
    sc = c.c_void_p(lib.ecrt_master_slave_config(master, 0, pos, 2, product))
    other = c.c_void_p(lib.ecrt_master_slave_config(master, 0, rpos, 2, rproduct))
    if lib.ecrt_slave_config_flag(other, b"ExpectedRevision", 0x4711):
        sys.exit("flag refused")
    if lib.ecrt_master_activate(master):
        sys.exit("not activated")
    time.sleep(1)
    text = c.create_string_buffer(256)
    if lib.ecrt_slave_config_reason(sc, text, c.c_size_t(len(text))) < 0:
        sys.exit("no reason")
    print("reason:", text.value.decode(), flush=True)
    while True:
        lib.ecrt_master_receive(master)
        lib.ecrt_master_send(master)
        time.sleep(0.002)


main()
