#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Units for systemd beside ethercat.service, as far as they show without a bus: a guest of
# tests/packages starts them.

top=$BATS_TEST_DIRNAME/../..

setup_file() {
	export root=$BATS_FILE_TMPDIR/root

	make -s -C "$top/operation" prefix=/usr DESTDIR="$root" install
	# what the units start
	mkdir -p "$root/usr/bin"
	install -m 755 /bin/true "$root/usr/bin/ethercat"
}

units="$BATS_TEST_DIRNAME/../../operation"

@test "units have no mistake that systemd finds, and start programs that are installed" {
	cd "$root/usr/lib/systemd/system"
	cp ethercat-run@.service ethercat-run@line.service
	cp ethercat-metrics@.service ethercat-metrics@1.service
	run systemd-analyze verify --man=no --root="$root" --recursive-errors=no \
		ethercat-run@line.service ethercat-metrics@1.service ethercat-metrics.socket
	echo "$output"
	[ "$status" = 0 ]
	[ -z "$output" ]
	chmod -x "$root/usr/share/ethercat/busrun.sh"
	run systemd-analyze verify --man=no --root="$root" --recursive-errors=no \
		ethercat-run@line.service
	chmod +x "$root/usr/share/ethercat/busrun.sh"
	[[ $output == *"/usr/share/ethercat/busrun.sh is not executable"* ]]
}

# exposure UNIT: of systemd, 0 to 100
exposure() {
	systemd-analyze security --offline=yes --no-pager "$root/usr/lib/systemd/system/$1" |
		sed -n 's/.*exposure level for .*: \([0-9.]*\) .*/\1/p' | tr -d .
}

@test "the programs of the units run in a sandbox" {
	cd "$root/usr/lib/systemd/system"
	cp ethercat-run@.service ethercat-run@line.service
	cp ethercat-metrics@.service ethercat-metrics@1.service
	run=$(exposure ethercat-run@line.service) metrics=$(exposure ethercat-metrics@1.service)
	echo "# exposure, of 100: ethercat-run@ $run, ethercat-metrics@ ${metrics#0}" >&3
	[ "$run" -le 20 ]
	[ "$metrics" -le 15 ]
}

# refused PATTERN FILE
refused() {
	run "$units/trusted.sh" "$2"
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == *"$1"* ]]
}

@test "a bus file that others can change is refused" {
	local d

	# the folders of a test are in one that all may write to
	d=$(mktemp -d "$HOME/.ec-units.XXXXXX")
	mkdir "$d/etc"
	echo 'cycle: 1 ms' >"$d/etc/line.yaml"
	chmod 644 "$d/etc/line.yaml"
	chmod 755 "$d" "$d/etc"
	"$units/trusted.sh" "$d/etc/line.yaml"
	chmod g+w "$d/etc/line.yaml"
	refused "others may write to $d/etc/line.yaml (mode 664)" "$d/etc/line.yaml"
	chmod g-w,o+w "$d/etc/line.yaml"
	refused "others may write to $d/etc/line.yaml (mode 646)" "$d/etc/line.yaml"
	chmod 644 "$d/etc/line.yaml"
	# an exchange of the file, or of its folder
	chmod 1777 "$d/etc"
	refused "others may write to $d/etc (mode 1777)" "$d/etc/line.yaml"
	chmod 755 "$d/etc"
	chmod 775 "$d"
	refused "others may write to $d (mode 775)" "$d/etc/line.yaml"
	chmod 755 "$d"
	# the place that a link leads to counts
	echo 'cycle: 1 ms' >"$BATS_TEST_TMPDIR/other.yaml"
	chmod 666 "$BATS_TEST_TMPDIR/other.yaml"
	ln -s "$BATS_TEST_TMPDIR/other.yaml" "$d/etc/link.yaml"
	refused "others may write to $BATS_TEST_TMPDIR/other.yaml" "$BATS_TEST_TMPDIR/other.yaml"
	# who owns a link chooses the file
	refused "is a link" "$d/etc/link.yaml"
	ln -s "$d/etc" "$d/folder"
	refused "is a link" "$d/folder/line.yaml"
	refused "there is no file" "$d/etc/none.yaml"
	refused "is no regular file" /dev/null
	refused "is no regular file" "$d/etc"
	if [ "$(id -u)" = 0 ]; then
		chown 65534 "$d/etc/line.yaml"
		refused "belongs to user 65534" "$d/etc/line.yaml"
	fi
	rm -r "$d"
}

# stub LINE...: 'ethercat', which counts its calls
stub() {
	mkdir -p "$BATS_TEST_TMPDIR/bin"
	printf '%s\n' '#!/bin/sh' "echo \"\$@\" >>$BATS_TEST_TMPDIR/calls" "$@" \
		>"$BATS_TEST_TMPDIR/bin/ethercat"
	printf '%s\n' '#!/bin/sh' >"$BATS_TEST_TMPDIR/bin/sleep"
	chmod +x "$BATS_TEST_TMPDIR"/bin/*
	rm -f "$BATS_TEST_TMPDIR/calls"
	export PATH=$BATS_TEST_TMPDIR/bin:$PATH
}

@test "the start waits for a bus that is as its file says, and names the missing slave" {
	stub "[ \$(wc -l <$BATS_TEST_TMPDIR/calls) -ge 4 ]"
	run "$units/await.sh" /etc/ethercat/line.yaml
	[ "$status" = 0 ]
	[ -z "$output" ]
	[ "$(sort "$BATS_TEST_TMPDIR/calls" | uniq -c | xargs)" = \
		"4 run --dry-run /etc/ethercat/line.yaml" ]
	stub "echo slave axis1 missing >&2" "exit 1"
	run "$units/await.sh" /etc/ethercat/line.yaml 2
	[ "$status" = 1 ]
	[ "$output" = "slave axis1 missing" ]
	[ "$(wc -l <"$BATS_TEST_TMPDIR/calls")" -ge 3 ]
}

@test "the stop ends the bus of the master that the start has run" {
	export RUNTIME_DIRECTORY=$BATS_TEST_TMPDIR
	stub 'echo "Master1 runs: 3 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50"'
	run "$units/busrun.sh" start /etc/ethercat/line.yaml
	[ "$output" = "Master1 runs: 3 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50" ]
	"$units/busrun.sh" stop
	[ "$(xargs <"$BATS_TEST_TMPDIR/calls")" = "run /etc/ethercat/line.yaml stop -m 1" ]
	# a start that fails has nothing to be ended
	rm "$BATS_TEST_TMPDIR/master"
	stub 'exit 1'
	run "$units/busrun.sh" start /etc/ethercat/line.yaml
	[ "$status" = 1 ]
	run "$units/busrun.sh" stop
	[ "$status" != 0 ]
	[ "$(xargs <"$BATS_TEST_TMPDIR/calls")" = "run /etc/ethercat/line.yaml" ]
}
