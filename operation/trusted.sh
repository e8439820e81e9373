#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# Refuses a file that another user than root and the caller can change: its content moves a machine
# at each start of the computer. The folders above count as well: a file can be exchanged there.
#
# usage: trusted.sh FILE

refuse() {
	echo "trusted.sh: $1; $2" >&2
	exit 1
}

[ $# = 1 ] || { echo "usage: trusted.sh FILE" >&2; exit 2; }
# each folder below is one of the way
file=$(readlink -e -- "$1") || refuse "there is no file $1" "write it with 'ethercat bus save'"
[ "$file" = "$(realpath -s -- "$1")" ] ||
	refuse "a part of $1 is a link, which is not followed" "name $file"
[ -f "$file" ] || refuse "$file is no regular file" "name a bus file"
at=$file me=$(id -u)
while :; do
	uid=$(stat -c %u -- "$at") && mode=$(stat -c %a -- "$at") ||
		refuse "cannot read the permissions of $at" "run as a user that may"
	[ "$uid" = "$me" ] || [ "$uid" = 0 ] ||
		refuse "$at belongs to user $uid, who can change $file" "chown root $at"
	[ $((0$mode & 022)) = 0 ] ||
		refuse "others may write to $at (mode $mode) and so change $file" "chmod go-w $at"
	[ "$at" != / ] || exit 0
	at=$(dirname -- "$at")
done
