#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A foreign master, pysoem from PyPI, on the segment "bench" of ethercat-sim.
#
# usage: run.sh [OPTION OF ethercat-sim...]      for example --bug lrw_wkc

cd "$(dirname "$0")/../.." || exit 1
. tests/foreign/wire.sh
pysoem
simulator "$@"
on_the_wire "$python" tests/pysoem/witness.py
