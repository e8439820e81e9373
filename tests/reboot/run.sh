#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# "reboot -f" in a guest with an application in OP, and kexec: the wire, recorded outside the
# guest, shows that all slaves leave OP and stay out of it. Suspend: an idle master sleeps with its
# computer, and works afterwards. The last line is "N passed, N failed".
#
# usage: run.sh [native|generic[+off|+kexec|+suspend]]...
#	device of the master, and what the guest does; default: native generic+off native+kexec
#	native+suspend

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
export EC_BUILD=$PWD/build/system-$kernel
passed=0 failed=0
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

tests/vm/kernels.sh fetch "$kernel" >&2 || exit 1
build() {
	make -s -j2 modules KDIR="$(tests/vm/kernels.sh kdir "$kernel")" \
		MODDIR="$EC_BUILD/modules" &&
	make -s -C lib O="$EC_BUILD/lib" all &&
	make -s -C tool O="$EC_BUILD/tool" &&
	make -s -C tests/apps O="$EC_BUILD/apps" LIB="$EC_BUILD/lib" all
}
locked "$kernel" build >&2 || exit 1

t() {	# t NAME COMMAND...
	local name=$1

	shift
	if "$@"; then
		echo "ok $name"
		passed=$((passed + 1))
	else
		echo "not ok $name"
		sed 's/^/# /' "$tmp/out" | tail -n 40
		failed=$((failed + 1))
	fi
}

# ends DEVICE HOW: -no-reboot ends QEMU there, so run.sh has no result of the command. The
# kernel that kexec starts has no root: it panics, and restarts.
ends() {
	tests/vm/run.sh --kernel "$kernel" --nics --icount --timeout 400 --append loglevel=7 \
		--qemu "-object filter-dump,id=wire,netdev=h0,file=$tmp/wire.pcap" -- \
		env EC_BUILD="$EC_BUILD" bash tests/reboot/guest.sh "$1" "$2" \
		"$(tests/vm/kernels.sh image "$kernel")" >"$tmp/out" 2>&1
	[ $? = 125 ] || return
	case $2 in
	kexec)	grep -q 'kexec_core: Starting new kernel' "$tmp/out" &&
			grep -q 'Command line: .*after=kexec' "$tmp/out" ;;
	off)	grep -q 'reboot: Power down' "$tmp/out" ;;
	*)	grep -q 'reboot: Restarting system' "$tmp/out" ;;
	esac
}

# suspends DEVICE
suspends() {
	EC_KERNEL=$kernel tests/reboot/suspend.sh "$1" >"$tmp/out" 2>&1
	grep -q 'suspend-init: works after resume 2' "$tmp/out" &&
		[ "$(grep -c 'ACPI: PM: Waking up from system sleep state S3' "$tmp/out")" = 2 ]
}

# the lines of two suspends, in this order
slept() {
	local one=$'computer sleeps\nWaking up\ncomputer resumed\nscan complete: 22 slave'

	grep -oE 'computer (sleeps|resumed)|Waking up|scan complete: 22 slave' "$tmp/out" |
		diff - <(printf '%s\n' 'scan complete: 22 slave' "$one" "$one")
}

# logged HOW
logged() {
	local name=reboot

	[ "$1" != off ] || name=power-off
	grep -qE "EtherCAT 0: $name: 22 slave\(s\) taken out of SAFEOP and OP in [0-9]+ ms" "$tmp/out"
}

for how in ${*:-native generic+off native+kexec native+suspend}; do
	device=${how%+*}
	case $how in
	native+suspend|generic+suspend)
		t "$how: a computer that sleeps twice brings 22 slaves to OP each time" suspends "$device"
		t "$how: the bus is scanned after each resume, not in between" slept
		continue ;;
	native|generic) end=reboot t=restarts ;;
	native+off|generic+off) end=off t="switches itself off" ;;
	native+kexec|generic+kexec) end=kexec t="starts another kernel" ;;
	*) echo "run.sh: $how: not native or generic, with +off, +kexec or +suspend" >&2; exit 2 ;;
	esac
	rm -f "$tmp/wire.pcap"
	t "$how: a guest with 22 slaves in OP $t" ends "$device" $end
	t "$how: the kernel log says that they left OP" logged $end
	t "$how: the wire shows that they left OP, beside the cycle of the application" \
		tests/reboot/wire.py "$tmp/wire.pcap" 22
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
