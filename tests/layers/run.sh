#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Each layer of master/ without the higher ones. A module of its objects, those of the layers
# below it and its test (NAME.c) is linked, which is one result, then loaded in a guest, where
# the test calls the layer with ops NULL. The objects are those of ec_master.ko; from "mailbox"
# on the simulator is there as well. The last line is "N passed, N failed".
#
# usage: run.sh [LAYER...]      default: all

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
# from the bottom
layers="wire base link carry mailbox bus clock config cycle session eoe boundary"
kernel=6.1-rt
modules=$PWD/build/system-$kernel/modules
out=$PWD/build/layers
passed=0 failed=0

tests/vm/kernels.sh fetch $kernel >&2 || exit 1
kdir=$(tests/vm/kernels.sh kdir $kernel)
locked $kernel make -s -j2 modules KDIR="$kdir" MODDIR="$modules" >&2 || exit 1

# into FOLDER SOURCE...: the objects of these files
into() {
	local d=$out/built/$1 o

	shift
	mkdir -p "$d"
	for o in "${@/%.c/.o}"; do
		o=$modules/$o
		[ -e "$o" ] || continue		# for programs only
		cp "$o" "$d/$(basename "$o")_shipped"
		# has the versions of exported symbols
		cp "${o%/*}/.${o##*/}.cmd" "$d/"
	done
}

rm -rf "$out/built"
for l in kernel $layers; do into "$l" "master/$l"/*.c; done
into boundary lib/ecrt/*.c
shopt -s extglob
into sim devices/sim/!(sim_module|wire_unity).c
for f in tests/layers/Kbuild tests/layers/*.[ch]; do
	cmp -s "$f" "$out/${f##*/}" || cp "$f" "$out/"
done
rm -f "$out"/*.ko
# unresolved symbols of one module keep no other from being tested
make -s -k -j2 -C "$kdir" M="$out" TOP="$PWD" LAYERS="$layers" KBUILD_MODPOST_WARN=1 \
	CONFIG_DEBUG_INFO_BTF_MODULES= CONFIG_DEBUG_INFO= W=1 modules \
	>"$out/log" 2>&1

result() {	# result ok|"not ok" TEXT
	echo "$1 $2"
	case $1 in
	ok) passed=$((passed + 1)) ;;
	*) failed=$((failed + 1)) ;;
	esac
}

# users LAYER SYMBOL: files among those of the layer and below that need it
users() {
	local l

	nm -A "$out/$1.o" "$out"/segment.o 2>/dev/null |
		sed -n "s,^$out/\(.*\)\.o: *U $2\$,tests/layers/\1.c,p"
	for l in kernel $layers; do
		nm -A "$out/built/$l"/*.o_shipped |
			sed -n "s,^$out/built/\(.*\)\.o_shipped: *U $2\$,\1.c,p"
		[ "$l" != "$1" ] || break
	done
}

good=() why=
for l in ${*:-$layers}; do
	undefined=$(sed -n "s/^.*modpost: \"\(.*\)\" \[.*\/ec_alone_$l.ko\] undefined!/\1/p" \
		"$out/log")
	if [ -f "$out/ec_alone_$l.ko" ] && [ -z "$undefined" ]; then
		result ok "$l: is linked without higher layers"
		good+=("$l")
		continue
	fi
	for s in $undefined; do
		echo "# $l: $s, used by $(users "$l" "$s" | xargs), is of no lower layer"
	done
	[ -n "$undefined" ] || why=$(tail -n 20 "$out/log")
	result 'not ok' "$l: is linked without higher layers"
done
[ -z "$why" ] || echo "$why"

# The test writes its results into the log.
load='for l; do
	insmod "$OUT/ec_alone_$l.ko" 2>&1 && rmmod "ec_alone_$l" 2>&1 || echo "alone: # $l"
	dmesg -c | grep -o "alone: .*"
done'
OUT=$out tests/vm/run.sh --kernel $kernel --icount --timeout 600 --append oops=panic -- \
	env OUT="$out" sh -c "dmesg -c >/dev/null; $load" sh \
	${good[@]+"${good[@]}"} >"$out/log" 2>&1
rc=$?
sed -n 's/^alone: # /# /p' "$out/log"
while read -r line; do
	case $line in
	'ok '*) result ok "${line#ok }" ;;
	'not ok '*) result 'not ok' "${line#not ok }" ;;
	esac
done < <(sed -n 's/^alone: //p' "$out/log")
# a module that was not loaded, an oops, a hang
for l in ${good[@]+"${good[@]}"}; do
	grep -qx "alone: end $l" "$out/log" || result 'not ok' "$l: its tests did not end"
done
if [ $rc != 0 ]; then
	grep -v '^alone:' "$out/log" | tail -n 30
	result 'not ok' "the guest ended with $rc"
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
