#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# README's two commands in a fresh root of another Debian: "make demo" and "make check" of a clone,
# which install what they need there. An hour and more; nothing else of weight should run beside
# it. Needs root; downloads kernels and builds all. The last line is "N passed, N failed".
#
# usage: whole.sh [bookworm|trixie [COMMAND]]	default: trixie, both commands

set -u
export LC_ALL=C
cd "$(dirname "$0")/../.." || exit 1
suite=${1:-trixie}
command=${2:-"make demo && make check"}
case $suite in
bookworm|trixie) ;;
*) echo "usage: whole.sh [bookworm|trixie [COMMAND]]" >&2; exit 2 ;;
esac
tests/install-deps.sh packages >&2 || exit 1
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-whole.XXXXXX")
trap 'rm -rf --one-file-system "$tmp"' EXIT
root=$tmp/root

# what the host trusts beside Debian's own
trust() {
	mkdir -p "$root/usr/local/share" "$root/etc/ssl/certs"
	cp -r /usr/local/share/ca-certificates "$root/usr/local/share/" 2>/dev/null
	cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/" 2>/dev/null
	cp -L /etc/resolv.conf "$root/etc/resolv.conf"
}

tests/vm/kernels.sh sources "$suite" >"$tmp/sources" &&
	unshare -m --propagation private mmdebstrap --variant=minbase --mode=root \
		--include=ca-certificates,git,iproute2,make,procps --aptopt='Acquire::Retries "5"' \
		"$suite" "$root" - <"$tmp/sources" >"$tmp/log" 2>&1 || {
	tail -n 20 "$tmp/log" >&2
	echo "whole.sh: cannot make a root of Debian $suite" >&2
	exit 1
}
trust
# a clone: what is not committed is not tested
git -c safe.directory='*' clone -q . "$root/root/ethercat" || exit 1
mkdir "$root/data"

# A root of its own, not a chroot, in which nobody may have a user name space. What runs in it
# ends with it.
# shellcheck disable=SC2016
unshare -m -p -f --kill-child --propagation private bash -c '
	set -e
	mount --bind "$1" "$1"
	cd "$1"
	mount -t proc proc proc
	mount --rbind /sys sys
	mount --rbind /dev dev
	mount -t tmpfs tmpfs tmp
	mount -t tmpfs tmpfs run
	[ -z "$3" ] || mount --bind "$3" data
	pivot_root . mnt
	umount -l mnt
	cd /root/ethercat
	export HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
	unset TMPDIR EC_CACHE XDG_CACHE_HOME
	[ -z "$3" ] || export DATA=/data
	eval "$2"' whole "$root" "$command" "${DATA:+$(cd "$DATA" && pwd -P)}"
