#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs a command in a root of root.sh; what it writes stays in FOLDER. Mounts end with the
# command.
#
# usage: enter.sh [--mount] ROOT FOLDER COMMAND...
# --mount: on the host, where MERGED is the folder of the root

set -eu
host=
if [ "$1" = --mount ]; then
	host=1
	shift
fi
root=$1 folder=$2
shift 2
mkdir -p "$folder"/{upper,work,merged}
export ROOT=$root FOLDER=$folder MERGED=$folder/merged
# shellcheck disable=SC2016
exec unshare -m --propagation private sh -euc '
	host=$1
	shift
	mount -t overlay -o "lowerdir=$ROOT,upperdir=$FOLDER/upper,workdir=$FOLDER/work" overlay "$MERGED"
	if [ -n "$host" ]; then exec "$@"; fi
	mount -t proc proc "$MERGED/proc"
	mount --rbind /dev "$MERGED/dev"
	mount -t tmpfs tmpfs "$MERGED/run"
	exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
		DEBIAN_FRONTEND=noninteractive chroot "$MERGED" "$@"
' sh "$host" "$@"
