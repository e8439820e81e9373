#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A foreign master, kickcat from PyPI, on the segment "bench" of ethercat-sim.
#
# usage: kickcat.sh [OPTION OF ethercat-sim...]      for example --bug lrw_wkc

cd "$(dirname "$0")/../.." || exit 1
. tests/foreign/wire.sh
venv kickcat 2.5
simulator "$@"
on_the_wire "$python" tests/foreign/kickcat_witness.py
