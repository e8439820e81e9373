#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# "reboot -f" in a guest with an application in OP: the wire, recorded outside the guest, shows
# that all slaves leave OP and stay out of it. The last line is "N passed, N failed".
#
# usage: run.sh [native|generic]...	device of the master; default: native

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

# reboot DEVICE: -no-reboot ends QEMU there, so run.sh has no result of the command
reboot() {
	tests/vm/run.sh --kernel "$kernel" --nics --icount --timeout 400 --append loglevel=7 \
		--qemu "-object filter-dump,id=wire,netdev=h0,file=$tmp/wire.pcap" -- \
		env EC_BUILD="$EC_BUILD" bash tests/reboot/guest.sh "$1" >"$tmp/out" 2>&1
	[ $? = 125 ] && grep -q 'reboot: Restarting system' "$tmp/out"
}

logged() { grep -qE 'EtherCAT 0: reboot: 22 slave\(s\) taken out of SAFEOP and OP in [0-9]+ ms' "$tmp/out"; }

for device in ${*:-native}; do
	rm -f "$tmp/wire.pcap"
	t "$device: a guest with 22 slaves in OP restarts" reboot "$device"
	t "$device: the kernel log says that they left OP" logged
	t "$device: the wire shows that they left OP, beside the cycle of the application" \
		tests/reboot/wire.py "$tmp/wire.pcap" 22
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
