#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# The group of /dev/EtherCAT*: udev leaves a group out that does not exist when it reads the rule.

top=$BATS_TEST_DIRNAME/../..

@test "make install makes the group before the rule" {
	run env -u MAKEFLAGS -u DESTDIR make -s -n -C "$top" UDEVDIR=/rules install-udev
	echo "$output"
	[ "$status" = 0 ]
	[[ ${lines[0]} =~ "groupadd --system ethercat" ]]
	[[ ${lines[1]} =~ "/rules/60-ethercat.rules" ]]
	[ ${#lines[@]} = 2 ]
}

# postinst ACTION: what it does; debhelper's part makes the group
postinst() {
	sed 's/^#DEBHELPER#$/echo group/' "$top/debian/ethercat-tools.postinst" \
		>"$BATS_TEST_TMPDIR/postinst"
	run env PATH="$BATS_TEST_TMPDIR:/usr/bin:/bin" sh "$BATS_TEST_TMPDIR/postinst" "$1"
	echo "$output"
	[ "$status" = 0 ]
}

@test "the package lets udev read its rule again when the group exists" {
	printf '%s\n' '#!/bin/sh' 'echo "$@"' 'exit 1' >"$BATS_TEST_TMPDIR/udevadm"
	chmod +x "$BATS_TEST_TMPDIR/udevadm"
	postinst configure
	[ "$output" = "$(printf 'group\ncontrol --reload')" ]
	postinst abort-upgrade
	[ "$output" = group ]
}
