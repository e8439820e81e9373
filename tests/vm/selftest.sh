#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Proves that run.sh can be trusted: that it passes results on, and that it
# does not report success when the guest dies, hangs or complains.
# usage: selftest.sh [FLAVOUR]    (default 6.1-rt)

set -u

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
kernel=${1:-6.1-rt}
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-selftest.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
failed=0 count=0

# check NAME WANTED-STATUS WANTED-REGEX run.sh-arguments...
check() {
	local name=$1 want=$2 re=$3 rc=0
	shift 3
	count=$((count + 1))
	"$here/run.sh" --kernel "$kernel" "$@" </dev/null >"$tmp/out" 2>&1 || rc=$?
	if [ $rc = "$want" ] && grep -qE -- "$re" "$tmp/out"; then
		echo "ok $count - $name"
	else
		echo "not ok $count - $name (status $rc, wanted $want and output matching '$re')"
		sed 's/^/# /' "$tmp/out"
		failed=1
	fi
}

# Not one of the checks: may take long when nothing is cached yet.
"$here/kernels.sh" fetch "$kernel" || exit 1

case $kernel in
*-rt)	uname='-rt-amd64' ;;
*)	uname='^[0-9.]+.*-amd64' ;;
esac
check "status 0, uname, boot time" 0 "$uname" -v -- uname -r
boot=$(grep 'command started' "$tmp/out")
if grep -q $'\r' "$tmp/out"; then echo "not ok - carriage returns in the output"; failed=1; fi

mkdir "$tmp/rw dir"
echo in >"$tmp/rw dir/in"
# shellcheck disable=SC2016
check "status 3, modules, --rw, read-only host, arguments" 3 "^args:a b|it's|\\\$x" --nics --rw "$tmp/rw dir" -- sh -ec '
	modprobe veth
	ip link add ecv0 type veth peer name ecv1
	modprobe e1000e
	ip link set eth0 up; ip link set eth1 up
	cp "$0/in" "$0/out"
	echo lost >"$0/../lost"
	[ "$(pwd)" = "$1" ]
	shift; IFS="|"; echo "args:$*"; exit 3' "$tmp/rw dir" "$(pwd -P)" "a b" "it's" '$x'
[ "$(cat "$tmp/rw dir/out" 2>/dev/null)" = in ] || { echo "not ok - file written to --rw is missing"; failed=1; }
[ ! -e "$tmp/lost" ] || { echo "not ok - a write outside --rw reached the host"; failed=1; }

check "--icount" 0 '^cpus 1' --icount --timeout 120 -- sh -c 'sleep 60; echo cpus $(nproc)'
check "a parked guest goes on at the present time" 0 "^$(date -u +%Y-%m-%d)" --icount -- date -u +%F
for p in "$cache"/parked/*; do [ ! -f "$p" ] || echo damaged >"$p"; done
check "a damaged parked guest is started anew" 0 '^well$' --icount -- echo well
check "timeout is 124" 124 'TIMEOUT' --timeout 15 -- sleep 1000
check "panic is 125" 125 'without a result' --timeout 60 -- sh -c 'echo c >/proc/sysrq-trigger'
check "no init: the guest is started twice, then 125" 125 'second start' --timeout 60 \
	--append 'rdinit=/none init=/none' -- true
qemu=$(command -v qemu-system-x86_64)
printf '#!/bin/sh\n[ -e %s ] || { : >%s; echo "died early" >&2; exit 1; }\nexec %s "$@"\n' \
	"$tmp/again" "$tmp/again" "$qemu" >"$tmp/qemu-system-x86_64"
chmod +x "$tmp/qemu-system-x86_64"
PATH=$tmp:$PATH EC_ACCEL=tcg check "the second start of a guest counts, the first one is shown" 7 \
	'^# died early$' -- sh -c 'exit 7'
printf '#!/bin/sh\n[ -e %s ] || { : >%s; exec "%s" "$@" -S; }\nexec %s "$@"\n' \
	"$tmp/hung" "$tmp/hung" "$qemu" "$qemu" >"$tmp/qemu-system-x86_64"
PATH=$tmp:$PATH EC_ACCEL=tcg EC_BEGIN=25 check "a guest that hangs at its start is started again" 7 \
	'^# run.sh: the guest hangs, before the command began' -- sh -c 'exit 7'
check "kernel warning is 70, even after dmesg -c" 70 'KERNEL FAULT' -- \
	sh -c 'echo "<4>WARNING: CPU: made up" >/dev/kmsg; dmesg -c >/dev/null'
check "--allow-oops" 5 '^$|^out' --allow-oops -- sh -c 'echo "<4>BUG: made up" >/dev/kmsg; echo out; exit 5'
check "much output arrives complete" 0 '^last$' -- sh -c 'seq 100000; echo last'
[ "$(wc -l <"$tmp/out")" = 100001 ] || { echo "not ok - output was lost"; failed=1; }
check "background process does not hang the end" 0 done -- sh -c 'sleep 1000 & echo done'

echo "# ${boot#run.sh: }"
echo "1..$count"
exit $failed
