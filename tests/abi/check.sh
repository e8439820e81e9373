#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# No number and no member of include/uapi changes after a version was frozen (tests/abi/v*):
# layout.py compares the headers, as compilers for 64 and 32 bits lay them out. Changes that were
# made up show that it notices them, and that it lets structures grow. The programs of tests/abi
# run beside the others of tests/system/ioctl.bats.
#
# usage: check.sh       last line: "N passed, N failed"

set -u
cd "$(dirname "$0")" || exit 1
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0
narrow="i686-linux-gnu-gcc -static"

t() {
	if "${@:2}" >"$tmp/out" 2>&1; then
		passed=$((passed + 1))
		echo "ok - $1"
	else
		failed=$((failed + 1))
		echo "not ok - $1"
		sed 's/^/# /' "$tmp/out"
	fi
}

# changed SED...: the headers of this tree, changed
changed() {
	rm -rf "$tmp/new"
	cp -r ../../include/uapi "$tmp/new"
	sed -i -E "$@" "$tmp"/new/*.h
	! diff -rq ../../include/uapi "$tmp/new" >/dev/null
}

notices() {
	changed "${@:2}" && ! ./layout.py --new "$tmp/new" >"$tmp/found" && grep -q "$1" "$tmp/found"
}
accepts() { changed "$@" && ./layout.py --new "$tmp/new"; }

# what was committed with a version is never edited
frozen() {
	local v

	for v in v*; do
		(cd "$v" && sha256sum --quiet -c SHA256SUMS) || return
	done
}

t "headers as they were, 64 and 32 bits" ./layout.py cc "$narrow"
t "frozen files are unchanged" frozen
t "a member that moves is noticed" notices "ec_ioc_sm.start at" \
	'/__u16 default_size;/d; s/(__u16) start;/\1 default_size;\n\1 start;/'
t "a member that is removed is noticed" notices "ec_ioc_master.held" '/__u32 held;/d'
t "a member of another size is noticed" notices "ec_ioc_debug.level" \
	's/__u32 level;/__u64 level;/'
t "another number of a command is noticed" notices "EC_IOC_SM number" \
	's/(EC_IOC_SM[ \t]+EC_IOC_RW\()0x04/\10x7f/'
t "another direction of a command is noticed" notices "EC_IOC_DEBUG number" \
	's/(EC_IOC_DEBUG[ \t]+)EC_IOC_W/\1EC_IOC_RW/'
t "a command that is removed is noticed" notices "EC_IOC_RESCAN" '/#define EC_IOC_RESCAN/d'
t "another value of a constant is noticed" notices "EC_CAUSE_LOST is" \
	's/(EC_CAUSE_LOST[ \t]+)3/\199/'
t "an array of structures in a command is noticed" notices "ec_ioc_debug.more is an array" \
	's/(	__u32 level;.*)/\1\n	struct ec_ioc_address more[2];/'
t "a structure may grow" accepts 's/(	__u32 level;.*)/\1\n	__u32 more;/'
t "a flag may be added" accepts 's/(EC_SEND_FLAG_ALL[ \t]+)63/\1127/'
t "a command may be added" accepts \
	's/(#define EC_IOC_SM[ \t].*)/\1\n#define EC_IOC_MORE EC_IOC_N(0x7f)/'
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
