#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# For ethercat-run@.service: runs the bus of a file, and ends it. The file says which master that
# is, and may say another one at the end, so $RUNTIME_DIRECTORY keeps it.
#
# usage: busrun.sh start FILE
#        busrun.sh stop

usage() {
	echo "usage: busrun.sh start FILE, or busrun.sh stop; with RUNTIME_DIRECTORY" >&2
	exit 2
}

at=${RUNTIME_DIRECTORY:+$RUNTIME_DIRECTORY/master}
[ -n "$at" ] || usage
case $#-$1 in
2-start)
	said=$(ethercat run "$2") || exit
	echo "$said"
	echo "$said" | sed -n 's/^Master\([0-9]*\) runs: .*/\1/p' >"$at" ;;
1-stop)
	read -r master <"$at" && ethercat stop -m "$master" ;;
*)	usage ;;
esac
