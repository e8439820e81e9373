#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# make demo in a VM does what it says, as does each DEMO=. (HOST=1 and what must make it fail:
# tests/system/demo.bats.) The last line is "N passed, N failed".

set -u
cd "$(dirname "$0")/../.." || exit 1
out=$(mktemp)
trap 'rm -f "$out" "$out.x" "$out.y"' EXIT
names="run compare syncunits hotconnect redundancy cable"
passed=0 failed=0

t() {	# t NAME COMMAND...
	local name=$1

	shift
	if "$@" >/dev/null 2>&1; then
		echo "ok: $name"
		passed=$((passed + 1))
	else
		echo "FAILED: $name"
		failed=$((failed + 1))
	fi
}

says() { grep -qE "$1" "$out"; }
refused() { ! CYCLES=$1 tests/demo/demo.sh; }

# exact guest time: a host that is busy elsewhere fails nothing
CYCLES=2000 VM_OPTIONS="--icount --timeout 400" make -s demo >"$out" 2>&1
rc=$?
[ $rc = 0 ] || sed 's/^/# /' "$out"
t "make demo ends with 0" [ $rc = 0 ]
t "22 slaves are shown in PREOP" [ "$(grep -cE '^ *[0-9]+ .* PREOP ' "$out")" = 22 ]
t "22 slaves reach OP" says '^Slaves: 22, in OP: 22,'
t "all cycles are done" says '^Cycles: 2000 of 2000, every 1000 us'
t "no working counter error, no lost frame" says '^Working counter errors: 0, lost frames: 0,'
t "the cycle time has a histogram of all cycles" \
	[ "$(awk '/^Cycle time/ { on = 1 } /^Cycle begins/ { on = 0 } on && / us .*\|/ { s += substr($0, 22, 8) } END { print s }' "$out")" = 1999 ]
t "the sine is drawn" [ "$(grep -cE '^ +[0-9]+ \|.*[*io]' "$out")" -ge 10 ]
t "the analog output is measured" says '^Analog output measured: .* 0 of 2000 values off'
t "both axes follow" [ "$(grep -cE '^Axis at slave .* correlation (1\.000|0\.9)' "$out")" = 2 ]
t "no check failed" [ "$(grep -c FAILED "$out")" = 0 ]
t "the capture has all cycles and nothing malformed" says '^tshark: [0-9]{4,} packets, .* malformed: 0$'
t "the capture is where it says" [ -s "$(sed -n 's/^capture: //p' "$out")" ]
# all of the others in one boot; each is a command of its own for a user
VM_OPTIONS="--icount --timeout 400" make -s demo DEMO="$names" >"$out.y" 2>&1
rc=$?
[ $rc = 0 ] || sed 's/^/# /' "$out.y"
shows() { grep -qE "$1" "$out.y"; }
t "DEMO=run and the others end with 0" [ $rc = 0 ]
t "DEMO=run saves the bus and shows a value that follows an output" \
	shows '^ +[0-9.]+  el1008.channel_1.input = 1$'
t "DEMO=run records each cycle and draws it" shows 'time \[s\], 0 is 2'
t "DEMO=compare names the exchanged slave" \
	shows "^[^ ]*yesterday.yaml:[0-9]+: slave 'el1008' exchanged: expected EL1008,.* found EL3062"
t "DEMO=syncunits shows the unit that has failed" shows '^  failed, outputs zero, 1 fault'
t "DEMO=syncunits and hotconnect draw a part that goes and returns, and one that stays" \
	[ "$(grep -cE '^left +[#~-]{60}\|$' "$out.y")" = 2 ]
t "DEMO=redundancy shows where the ring is open" \
	shows '^Warning: ring open between port 1 of slave 2 .* and slave 3 '
t "DEMO=redundancy shows a tree for each device" shows '^Master0: backup device sim0b, link up'
t "DEMO=redundancy has all slaves in OP and its cycles complete" \
	shows '^cycles: [0-9]{4,}, incomplete: [0-4]$'
t "DEMO=cable shows a value that stands still in a line" \
	shows '^line: station 1 .* [0-9]{1,2} ms, station 2 for [0-9]{4,} ms$'
t "DEMO=cable shows one that goes on in a ring" \
	shows '^ring: station 1 .* [0-9]{1,2} ms, station 2 for [0-9]{1,2} ms$'
t "DEMO=cable draws the clocks" \
	shows '^clocks: [0-9]{2,} samples, .* axis 2 at the end [0-9]{1,3} ns$'
for name in install kernel build:\ {modules,library,tool,application}; do
	t "the step '$name' has its seconds" says "^\[ *[0-9]+ s\] $name: done in [0-9]+ s$"
done
slow_step() {
	bash -c '. tests/demo/steps.sh; tick=1; on "build: x" sleep 3' |
		grep -qE '^\[ *[0-9]+ s\] build: x: still running, [12] s$'
}
t "a step that takes long is not silent" slow_step
failed_step() { bash -c '. tests/demo/steps.sh; on x false' >"$out.x"; [ $? = 1 ] && [ ! -s "$out.x" ]; }
t "a step that fails is not called done" failed_step
t "steps have a time" [ "$(grep -c '^\[ *[0-9]* s\]' "$out")" -ge 8 ]
t "a wrong number of cycles is refused" refused many
t "DEMO=list shows each of them" \
	[ "$(make -s demo DEMO=list | awk 'NR > 1 { print $1 }' | tr '\n' ' ')" = "$names " ]
t "an unknown DEMO is refused" [ "$(tests/demo/demo.sh runn 2>&1 | grep -c '^usage')" = 1 ]
t "the exact usage is asked for" [ "$(tests/demo/demo.sh --nonsense 2>&1 | grep -c '^usage')" = 1 ]
echo "$passed passed, $failed failed"
[ $failed = 0 ]
