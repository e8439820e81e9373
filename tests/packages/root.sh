#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A minimal Debian with what builds and tests packages, and the headers of the kernel that guests
# boot. It is made once and kept in the cache; nobody writes to it (run.sh lays an overlay over it).
#
# usage: root.sh bookworm|trixie	prints the folder
#        root.sh bookworm|trixie kernel	prints what tests/vm calls the kernel of its guests

set -euo pipefail
cd "$(dirname "$0")/../.."
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
suite=${1:-}
case $suite in
bookworm) kernel=6.1-rt backports= ;;
trixie)	kernel=6.12-deb13-rt backports=trixie-backports ;;
*)	echo "usage: root.sh bookworm|trixie [kernel]" >&2; exit 2 ;;
esac
if [ "${2:-}" = kernel ]; then
	echo $kernel
	exit
fi
# the first kernel is the one of the guests, the second one that of an update: in Debian 13 the
# newest one of its backports
first=linux-headers-$(tests/vm/kernels.sh release $kernel)
second="${backports:+-t $backports }linux-headers-amd64"
packages="build-essential debhelper dh-dkms dkms fakeroot iproute2 kmod libyaml-dev lintian
	man-db pkg-config
	python3-sphinx systemd systemd-sysv udev $first"
root=$cache/roots/packages-$suite
layout="2 $packages $second"

mkdir -p "$cache/roots"
exec 9>"$cache/roots/.lock-$suite"
flock 9
if [ "$(cat "$root/.complete" 2>/dev/null || true)" != "$layout" ]; then
	tests/install-deps.sh packages >&2
	rm -rf --one-file-system "$root" "$root.new"
	tmp=$(mktemp -d)
	trap 'rm -rf --one-file-system "$tmp" "$root.new"' EXIT
	for s in $suite $backports; do
		tests/vm/kernels.sh sources "$s" && echo
	done >"$tmp/sources"
	# its mounts end with it, however it ends
	# shellcheck disable=SC2086
	unshare -m --propagation private \
		mmdebstrap --variant=minbase --mode=root --include="$(echo $packages | tr ' ' ,)" \
		--aptopt='Acquire::Retries "5"' \
		--customize-hook='mkdir -p "$1/srv/second/partial"' \
		--customize-hook="chroot \"\$1\" apt-get -qq -y --download-only \
			-o Dir::Cache::Archives=/srv/second install $second &&
			rm -f \"\$1\"/srv/second/linux-libc-dev_*" \
		"$suite" "$root.new" - <"$tmp/sources" >"$tmp/log" 2>&1 || {
		tail -n 20 "$tmp/log" >&2
		echo "root.sh: cannot make a root of Debian $suite" >&2
		exit 1
	}
	echo "$layout" >"$root.new/.complete"
	mv -T "$root.new" "$root"
fi
exec 9>&-
echo "$root"
