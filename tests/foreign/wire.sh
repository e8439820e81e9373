# SPDX-License-Identifier: GPL-2.0-only
# For the scripts that put a foreign master and ethercat-sim at the two ends of one wire
# (veth0, veth1; a second wire is veth2, veth3) in a network namespace of their own. To be
# sourced in the top folder.

set -u
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
build=$PWD/build/pysoem
san="-fsanitize=address,undefined -fno-sanitize-recover=all"

fail() {
	echo "$*"
	echo "0 passed, 1 failed"
	exit 1
}

# simulator OPTION...: builds it; EC_SIM is its command line
simulator() {
	local o

	make -s -j2 -C tool/sim O="$build" CFLAGS="-O1 -g $san" LDFLAGS="$san" >&2 ||
		fail "ethercat-sim does not build"
	EC_SIM="$build/ethercat-sim"
	for o; do EC_SIM="$EC_SIM $(printf %q "$o")"; done
	export EC_SIM
}

# venv PACKAGE VERSION: a Python with it; $python
venv() {
	local folder=$cache/$1-$2

	python=$folder/bin/python
	"$python" -c "import $1" 2>/dev/null && return
	echo "# installing $1 $2 in $folder"
	rm -rf "$folder"
	{ python3 -m venv "$folder" && "$folder/bin/pip" install -q "$1==$2"; } >&2 ||
		fail "$1 cannot be installed (tests/install-deps.sh python; PyPI reachable?)"
}

# the Python with pysoem; $python
pysoem() { venv pysoem 1.1.13; }

# on_the_wire COMMAND...: does not return
on_the_wire() {
	local inside u rt

	inside='for i in 0 2; do
		ip link add veth$i type veth peer name veth$((i + 1)) &&
		ip link set veth$i up && ip link set veth$((i + 1)) up || exit
	done'
	# such a master gives a slave milliseconds, whatever else the machine is doing
	rt=$(chrt -f 10 echo "chrt -f 10" 2>/dev/null)
	set -- env PYTHONDONTWRITEBYTECODE=1 EC_SIM="$EC_SIM" "$@"
	# a namespace where it is allowed, else a virtual machine
	for u in "unshare -n" "unshare -rn"; do
		if $u sh -c "$inside" 2>/dev/null; then
			exec $u sh -c "$inside"' && exec "$@"' sh $rt timeout -k 5 200 "$@"
		fi
	done
	# in exact time: no busy host makes these milliseconds too short, but while files are
	# read from the host that time leaps, so the only limit is the host's
	echo "# no network namespace here: in a virtual machine"
	exec tests/vm/run.sh --icount --timeout 600 -- sh -c "modprobe veth && $inside"' && exec "$@"' sh "$@"
}
