#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Every level of test; installs what is missing. Each level ends with a line of
# its own; the sums are the last line, behind that of class A (tests/class-a).
#
# usage: check.sh [LEVEL...]      default: all of $levels
#
# DATA=FOLDER	real EEPROM images and captures, for the level "data"

set -u
export LC_ALL=C
[ -z "${DATA:-}" ] || DATA=$(realpath -e -- "$DATA") || exit 1
cd "$(dirname "$0")/.." || exit 1
. tests/vm/places.sh
levels="
uml
kernels
arch
witness
build
unit
decoders
lib
abi
tool
operation
bats
fuzz
without
data
pysoem
soem
kickcat
ethercrab
system
bench
guests
reboot
demo
layers
tshark
class-a
"
# These use one CPU, build in folders of their own and measure no time: side by side, the long
# ones first.
side=" uml kernels arch witness build unit decoders lib abi tool operation bats fuzz without data "
# Of what these use, the others have built most. Their guests are in places that they share. A
# level that does not take places itself holds one.
guests=" system bench guests reboot demo layers tshark "
own_places=" system guests "
# It shows the results of the others.
last=" class-a "
passed=0 failed=0
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT

# count OUTPUT: adds what a level's closing line says
count() {
	local line p f

	line=$(grep -E '^[A-Za-z: ]*[0-9]+ passed, [0-9]+ failed' "$1" | tail -n 1)
	if [ -z "$line" ]; then
		line=$(grep -E '^# Totals: pass:[0-9]+ fail:[0-9]+' "$1" | tail -n 1 |
		       sed -E 's/.*pass:([0-9]+) fail:([0-9]+).*/\1 passed, \2 failed/')
	fi
	p=$(echo "$line" | grep -oE '[0-9]+ passed' | grep -oE '[0-9]+')
	f=$(echo "$line" | grep -oE '[0-9]+ failed' | grep -oE '[0-9]+')
	passed=$((passed + ${p:-0}))
	failed=$((failed + ${f:-0}))
	# a level that fails without saying how is one failure
	[ "$2" = 0 ] || [ "${f:-0}" != 0 ] || failed=$((failed + 1))
	# a level that ran nothing has not passed
	[ "$2" != 0 ] || [ "${p:-0}" != 0 ] || failed=$((failed + 1))
}

# failures OUTPUT [LINES [ALL]]: the failed cases of a level, each with what it said: 12 lines, or
# LINES (40) of comment; at most ALL lines (200)
failures() {
	awk -v most="${2:-40}" '
		/^[ \t]*(not ok|FAIL |FAILED:|ERROR: |KERNEL REPORT|demo: FAILED)/ {
			n = 0; max = most; print; next
		}
		/^[ \t]*(# )?ok / { max = 0 }
		max > 12 && !/^#/ { max = 12 }
		n++ < max' "$1" | head -n "${3:-200}"
}

level_unit() { make -s -C tests/unit; }
level_witness() { tests/witness/run.sh; }
level_decoders() { tests/witness/decoders.py; }
level_tshark() { tests/tshark/run.sh; }
level_uml() { EC_UML_CASES=$log/uml.cases EC_UML_TIMEOUT=900 tests/uml/run.sh; }
level_lib() { make -s -C tests/lib check; }
level_abi() { tests/abi/check.sh; }
level_tool() { make -s -C tests/tool check; }
level_operation() { tests/operation/check.sh; }
level_bats() { tests/check-bats.sh; }
# 12 of the rows; tests/check-long.sh tries all
level_without() { tests/class-a/try.sh 12; }
level_class-a() { tests/class-a/check.sh "$log"; }
level_fuzz() { make -s -C tests/fuzz check; }
level_data() { make -s -C tests/data-check check DATA="$DATA"; }
level_pysoem() { tests/pysoem/run.sh; }
level_soem() { tests/foreign/soem.sh; }
level_kickcat() { tests/foreign/kickcat.sh; }
level_ethercrab() { tests/foreign/ethercrab.sh; }
level_arch() { tests/arch/run.sh; }
level_kernels() { tests/check-kernels.sh; }
level_layers() { tests/check-layers.sh; }
level_build() { tests/build/check.sh; }
level_lintian() { tests/packages/run.sh bookworm lint; }
level_system() { tests/system/run.sh; }
level_guests() { tests/arch/guests.sh; }
level_reboot() { tests/reboot/run.sh; }
level_demo() { tests/demo/check.sh; }
# the bus figures are gates of the level uml
level_bench() { tests/bench/run.sh --gates cycle sim mailbox trip; }

# run LEVEL: keeps its output, exit status, seconds, and seconds of CPU: user and system
run() {
	local t0=$SECONDS rc TIMEFORMAT='%0U %0S'

	{ time "level_$1" >"$log/$1" 2>&1; } 2>"$log/$1.cpu"
	rc=$?
	echo "$rc $((SECONDS - t0)) $(<"$log/$1.cpu")" >"$log/$1.end"
}

# what failed, by level: the last lines, since some readers keep no others; they keep some 50, 26
# of which are the reasons of all levels together
failed_names= costs=
why=()
report() {
	local name=$1 rc seconds user sys names

	echo "=== $name"
	read -r rc seconds user sys <"$log/$name.end"
	count "$log/$name" "$rc"
	# what to shorten when the whole takes too long
	grep -E '^# .*: [0-9.]+ s, [0-9.]+ s of CPU$' "$log/$name" | sort -t: -k2 -nr | head -n 12
	[[ $last != *" $name "* ]] || sed '$d' "$log/$name"
	if [ "$rc" = 0 ]; then
		tail -n 1 "$log/$name"
	else
		failures "$log/$name"
		tail -n 20 "$log/$name"
		echo "=== $name failed (exit $rc)"
		names=$(grep -E '^[[:space:]]*(not ok|FAIL |FAILED:|ERROR: |demo: FAILED)' "$log/$name" |
			head -n 20 | sed "s/^[[:space:]]*/$name: /")
		failed_names+=${names:-"$name: ended with $rc"}$'\n'
		why+=("$(failures "$log/$name" 12 26 | sed "s/^/$name: /")")
	fi
	echo "=== $name: $seconds s, $((user + sys)) s of CPU"
	costs+="$name $seconds/$((user + sys)), "
}

tests/install-deps.sh build vm capture uml json python doc cross || {
	echo "check: packages that the tests need are missing and could not be installed (see above)"
	echo "0 passed, 1 failed"
	exit 1
}
# What was compiled before, also for another clone at this place, is taken from a cache; what was
# not costs no run of the preprocessor.
export PATH=/usr/lib/ccache:$PATH CCACHE_MAXSIZE=2G CCACHE_DEPEND=1
export CCACHE_DIR=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}/ccache
places "$log/places" 1024
together=() beside=() apart=() behind=()
for l in ${*:-$levels}; do
	if [ "$l" = data ] && [ -z "${DATA:-}" ]; then
		echo "=== data: not run: DATA= names no folder of images and captures"
	elif [[ $side == *" $l "* ]]; then
		together+=("$l")
	elif [[ $guests == *" $l "* ]]; then
		beside+=("$l")
	elif [[ $last == *" $l "* ]]; then
		behind+=("$l")
	else
		apart+=("$l")
	fi
done
for l in ${together[@]+"${together[@]}"}; do
	while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n; done
	run "$l" &
done
wait
for l in ${together[@]+"${together[@]}"}; do report "$l"; done
for l in ${apart[@]+"${apart[@]}"}; do
	run "$l"
	report "$l"
done
for l in ${beside[@]+"${beside[@]}"}; do
	in=one
	[[ $own_places != *" $l "* ]] || in=
	$in run "$l" &
	sleep 0.1	# in this order, where places are free
done
wait
for l in ${beside[@]+"${beside[@]}"}; do report "$l"; done
for l in ${behind[@]+"${behind[@]}"}; do
	run "$l"
	report "$l"
done
for text in ${why[@]+"${why[@]}"}; do head -n $((26 / ${#why[@]})) <<<"$text"; done
printf '%s' "$failed_names"
fold -s -w 100 <<<"seconds/of CPU: ${costs%, }; all: $SECONDS"
grep -hs '^class A of ETG.1500: [0-9]' "$log/class-a"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
