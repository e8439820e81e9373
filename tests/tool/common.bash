# SPDX-License-Identifier: GPL-2.0-only
# for the .bats files: the tool with fake_dev.c, and the one with the real way
# to the kernel

HERE=$BATS_TEST_DIRNAME
export ASAN_OPTIONS=detect_leaks=1
export FAKE_BUS=idle
unset FAKE_READONLY FAKE_LOG FAKE_COUNT

ethercat() {
	"$HERE/build/fake/ethercat" "$@"
}

real() {
	"$HERE/build/real/ethercat" "$@"
}

# stdout only, whatever the exit code
out() {
	"$HERE/build/fake/ethercat" "$@" 2>/dev/null
}

err() {
	"$HERE/build/fake/ethercat" "$@" 2>&1 >/dev/null
}

golden() {
	local file=$HERE/golden/$1.txt
	shift
	diff -u "$file" <("$HERE/build/fake/ethercat" "$@" 2>/dev/null)
}

# changes the command made
log_of() {
	export FAKE_LOG=$BATS_TEST_TMPDIR/log
	: >"$FAKE_LOG"
	"$HERE/build/fake/ethercat" "$@" || return
	cat "$FAKE_LOG"
}

json() {
	python3 -c '
import json, re, sys
d = json.load(sys.stdin)
assert eval(sys.argv[1]), d
' "$1"
}

# what the completion offers: complete_line WORD..., the last one incomplete
completion_of_fake() {
	mkdir -p "$BATS_TEST_TMPDIR/bin"
	ln -s "$HERE/build/fake/ethercat" "$BATS_TEST_TMPDIR/bin/ethercat"
	PATH=$BATS_TEST_TMPDIR/bin:$PATH
	. "$HERE/../../tool/completion/ethercat.bash"
}

complete_line() {
	COMP_WORDS=("$@")
	COMP_CWORD=$(($# - 1))
	unset -f ethercat
	_ethercat
	echo "${COMPREPLY[*]}"
}
