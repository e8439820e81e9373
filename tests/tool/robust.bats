#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Names that attack the reader, odd files at stdout, long buses, large numbers.

load common

# stdout of a command on a terminal
on_terminal() {
	python3 -c '
import os, pty, sys
out = b""
pid, fd = pty.fork()
if not pid:
    os.execv(sys.argv[1], sys.argv[1:])
try:
    while True:
        more = os.read(fd, 4096)
        if not more:
            break
        out += more
except OSError:
    pass
sys.stdout.buffer.write(out)
sys.stdout.flush()
assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
' "$HERE/build/fake/ethercat" "$@"
}

# no control character but line ends and tabs, neither UTF-8 nor Latin-1
harmless() {
	python3 -c '
import sys
text = sys.stdin.buffer.read().decode("utf-8", "surrogateescape")
bad = [c for c in text if (ord(c) < 0x20 and c not in "\n\t") or 0x7e < ord(c) < 0xa0
       or 0xdc80 <= ord(c) < 0xdca0 or ord(c) in (0x200e, 0x200f)
       or 0x2028 <= ord(c) <= 0x202e or 0x2066 <= ord(c) <= 0x2069]
assert text and not bad, bad
'
}

@test "names from an EEPROM cannot control the terminal" {
	export FAKE_BUS=evil
	for c in slaves "slaves -v" pdos cstruct crc graph states; do
		out $c | harmless || { echo "$c"; return 1; }
	done
	[[ $(out slaves -p2) == *"?[2J??H?1m??? Grö"*"e???" ]]
	out slaves -j | json '"Grö\xdfe" in d["masters"][0]["slaves"][2]["name"]'
	[[ $(out slaves -v -p2) == *"Group: $(printf 'g%.0s' {1..63})"$'\n'* ]]
}

@test "names from an EEPROM cannot leave a comment or a string" {
	export FAKE_BUS=evil
	{
		printf '#include "%s"\n' "$HERE/../../include/ecrt.h"
		out cstruct
	} >"$BATS_TEST_TMPDIR/c.c"
	cc -Wall -Wextra -Werror -Wno-unused -Wno-missing-field-initializers -c -o /dev/null \
		"$BATS_TEST_TMPDIR/c.c"
	[[ $(out graph) == *'\n*/ \"x\\ /* int"'* ]]
	! command -v dot >/dev/null || out graph | dot -Tsvg >/dev/null
}

@test "strings of a slave are raw in a pipe and harmless on a terminal" {
	[ "$(out upload -p2 -t string 0x2002 0 | xxd -p)" = 611b5b324ac29b620a0a ]
	on_terminal upload -p2 -t string 0x2002 0 >"$BATS_TEST_TMPDIR/t"
	[ "$(xxd -p "$BATS_TEST_TMPDIR/t")" = 613f5b324a3f620d0a0d0a ]
	out upload -j -p2 -t string 0x2002 0 | harmless
	out upload -j -p2 -t string 0x2002 0 | json 'd["value"] == "a\x1b[2J\x9bb\n"'
}

@test "binary data are not written to a terminal" {
	export FAKE_BUS=app
	for c in "sii_read -p1" data "data -d0"; do
		run on_terminal $c
		echo "$output"
		[ "$status" -ne 0 ]
		[[ $output == *"binary data are not written to a terminal; use "* ]]
		[ "$(out $c | wc -c)" -ge 1 ]
	done
	[[ $(on_terminal sii_read -v -p1) == "SII Area:"* ]]
	[[ $(on_terminal data --json) == "{"* ]]
}

@test "a reader that leaves early" {
	export FAKE_BUS=big
	run bash -c "set -o pipefail; '$HERE/build/fake/ethercat' slaves -v 2>&1 | head -n 1"
	[ "${#lines[@]}" -eq 1 ]
	[ "$status" -eq 141 ]
	# the signal is off: an error, not a crash
	run python3 -c '
import os, signal, subprocess, sys
r, w = os.pipe()
os.close(r)
p = subprocess.run(sys.argv[1:], stdout=w, stderr=subprocess.PIPE, restore_signals=False)
sys.stdout.write(p.stderr.decode())
sys.exit(p.returncode)
' "$HERE/build/fake/ethercat" slaves
	[ "$status" -eq 1 ]
	[ "$output" = "ethercat slaves: cannot write the output: Broken pipe" ]
}

@test "stdout is closed" {
	run bash -c "'$HERE/build/fake/ethercat' slaves >&-"
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write the output: Bad file descriptor" ]]
	run bash -c "'$HERE/build/fake/ethercat' download -p2 -t uint8 0x2001 0 1 >&-"
	[ "$status" -eq 0 ]
	run bash -c "'$HERE/build/fake/ethercat' upload -p2 0x5000 0 2>&-"
	[ "$status" -eq 1 ]
	[ -z "$output" ]
}

@test "numbers larger than any type" {
	n=99999999999999999999999999
	for c in "upload -p2 $n 0" "upload -p2 0x1018 $n" "upload -p2 0x$n:01" "debug $n" \
		"reg_read -p2 $n 1" "reg_read -p2 0 $n" "reg_read -p2 0x8000 0x8001" \
		"reg_write -p2 -t uint8 $n 1" "reg_write -p2 -t uint64 0 $n" \
		"reg_write -p2 -t int64 0 9223372036854775808" \
		"reg_write -p2 -t int64 0 -9223372036854775809" \
		"download -p2 -t float 0x2000 0 1e999" "download -p2 -t uint8 0x2000 0 256"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ $output == *"--help"* ]] || { echo "$c: $output"; return 1; }
	done
	[ "$(log_of reg_write -p2 -t uint64 0 18446744073709551615)" = "reg 2 0x0000 ffffffffffffffff" ]
	[ "$(log_of reg_write -p2 -t int64 0 -9223372036854775808)" = "reg 2 0x0000 0000000000000080" ]
	[ -z "$(ethercat slaves -p $n)" ]
	[ "$(ethercat slaves -p 0-$n | wc -l)" -eq 3 ]
	[ "$(ethercat slaves -p $n-0 | head -c1)" = 0 ]
	[ "$(ethercat slaves -a 1-$n | wc -l)" -eq 2 ]
	[ -z "$(ethercat slaves -m 7 2>/dev/null)" ]
	[ "$(ethercat slaves -p "$(seq -s, 0 500)" | wc -l)" -eq 3 ]
}

@test "a thousand slaves" {
	export FAKE_BUS=big FAKE_COUNT=$BATS_TEST_TMPDIR/n
	[ "$(out slaves | wc -l)" -eq 1000 ]
	[ "$(cat "$FAKE_COUNT")" -le 7010 ]
	[ "$(out slaves -p 999-0 | cut -c1-4 | tr -d ' ' | sort -nc && echo sorted)" = sorted ]
	[ "$(out slaves -a 1- -p 0 | wc -l)" -eq 10 ]
	[ "$(out slaves -v -p 999-0 | sed -n 1p)" = "=== Master 0, Slave 999 ===" ]
	# this is no matter of seconds, sanitizers included
	run timeout 10 "$HERE/build/fake/ethercat" slaves -a 1- -p 99-0
	[ "${#lines[@]}" -eq 1000 ]
	run timeout 10 "$HERE/build/fake/ethercat" pdos
	[ "$status" -eq 1 ]
	[[ $output == *"slave 0: cannot read the PDOs"* ]]
}

# What is typed is a position; what is resolved once is a device.
@test "a slave that takes the position of another one gets no command" {
	local c

	export FAKE_BUS=moved
	printf x >"$BATS_TEST_TMPDIR/fw"
	for c in "download -p2 -t uint16 0x8010 3 1" "upload -p2 -t uint16 0x1018 1" \
		"soe_write -p2 -t uint16 S-0-0015 1" "soe_read -p2 -t uint16 S-0-0015" \
		"reg_write -p2 -t uint8 0x10 1" "reg_read -p2 -t uint8 0x10" "states -p2 PREOP" \
		"foe_write -p2 $BATS_TEST_TMPDIR/fw" "sdos -p2" "ip -p2 addr 10.0.0.1" \
		"diag -p2" "crc -p2 reset"; do
		export FAKE_LOG=$BATS_TEST_TMPDIR/log
		: >"$FAKE_LOG"
		run "$HERE/build/fake/ethercat" $c
		[[ "$status" != 0 && "$output" == *"device 13, which was slave 2 (EL7201)"* ]] ||
			{ echo "$c: $status $output"; return 1; }
		[ ! -s "$FAKE_LOG" ] || { echo "$c reached a slave"; return 1; }
	done
	# without scan a register is written by position
	[ "$(log_of reg_write -p2 -t uint8 --emergency 0x10 1)" = "reg 2 0x0010 emergency 01" ]
}

@test "slaves --json shows the device numbers" {
	out slaves -j | json '[s["device_number"] for s in d["masters"][0]["slaves"]] == [11, 12, 13]'
}
