#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A foreign master, pysoem from PyPI, on the segment "bench" of ethercat-sim,
# both on one wire (veth) in a network namespace of their own.
#
# usage: run.sh [OPTION OF ethercat-sim...]      for example --bug lrw_wkc

set -u
cd "$(dirname "$0")/../.." || exit 1
version=1.1.13
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
venv=$cache/pysoem-$version
build=$PWD/build/pysoem
san="-fsanitize=address,undefined -fno-sanitize-recover=all"

fail() {
	echo "$*"
	echo "0 passed, 1 failed"
	exit 1
}

if ! "$venv/bin/python" -c 'import pysoem' 2>/dev/null; then
	echo "# installing pysoem $version in $venv"
	rm -rf "$venv"
	{ python3 -m venv "$venv" && "$venv/bin/pip" install -q "pysoem==$version"; } >&2 ||
		fail "pysoem cannot be installed (tests/install-deps.sh python; PyPI reachable?)"
fi
make -s -j2 -C tool/sim O="$build" CFLAGS="-O1 -g $san" LDFLAGS="$san" >&2 ||
	fail "ethercat-sim does not build"

inside='ip link add veth0 type veth peer name veth1 && ip link set veth0 up && ip link set veth1 up'
sim="$build/ethercat-sim"
for o; do sim="$sim $(printf %q "$o")"; done
test=(env PYTHONDONTWRITEBYTECODE=1 EC_SIM="$sim" "$venv/bin/python" tests/pysoem/witness.py)

# SOEM gives a slave milliseconds, whatever else the machine is doing
rt=$(chrt -f 10 echo "chrt -f 10" 2>/dev/null)

# a namespace where it is allowed, else a virtual machine
for u in "unshare -n" "unshare -rn"; do
	if $u sh -c "$inside" 2>/dev/null; then
		exec $u sh -c "$inside"' && exec "$@"' sh $rt timeout -k 5 200 "${test[@]}"
	fi
done
# in exact time: no busy host makes SOEM's milliseconds too short, but while files are
# read from the host that time leaps, so the only limit is the host's
echo "# no network namespace here: in a virtual machine"
exec tests/vm/run.sh --icount --timeout 600 -- sh -c "modprobe veth && $inside"' && exec "$@"' sh "${test[@]}"
