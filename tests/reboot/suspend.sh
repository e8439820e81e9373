#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Boots a guest that sleeps (S3) and is woken by its clock, twice; prints its console. A guest of
# tests/vm/run.sh cannot: its folders of the host have no resume, so this one has an initramfs with
# all it needs.
#
# usage: suspend.sh native|generic	EC_BUILD, EC_KERNEL as in run.sh

set -eu
cd "$(dirname "$0")/../.."
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
vm=tests/vm/kernels.sh
modules=$($vm modules "$EC_KERNEL")

mkdir -p "$tmp/root/bin"
cp "$(command -v busybox)" "$tmp/root/bin/"
install -m 755 tests/reboot/suspend-init.sh "$tmp/root/init"
printf 'device=%q\nbuild=%q\n' "$1" "$EC_BUILD" >"$tmp/root/env"
modprobe -d "${modules%/lib/modules/*}" -S "${modules##*/}" --show-depends e1000e |
	awk '$1 == "insmod" { print $2 }' >"$tmp/root/order"
{
	cat "$tmp/root/order"
	ldd "$EC_BUILD/tool/ethercat" "$EC_BUILD/apps/demo" | grep -oE '/[^ ):]+( |$)' | tr -d ' '
	find "$EC_BUILD"/{modules/{master,devices},tool/ethercat,apps/demo,lib} \
		-name '*.ko' -o -name '*.so*' -o -name ethercat -type f -o -name demo
} | sort -u | tar -ch -T - 2>/dev/null | tar -x -C "$tmp/root"
(cd "$tmp/root" && find . | cpio --quiet -o -H newc | gzip -1) >"$tmp/initrd"
timeout 300 qemu-system-x86_64 -nodefaults -no-user-config -no-reboot -display none \
	-kernel "$($vm image "$EC_KERNEL")" -initrd "$tmp/initrd" -accel tcg -cpu max \
	-icount shift=0,sleep=off -m 768 -serial stdio \
	-netdev hubport,id=h0,hubid=0 -device e1000e,netdev=h0,mac=52:54:00:ec:00:00 \
	-netdev hubport,id=h1,hubid=0 -device e1000e,netdev=h1,mac=52:54:00:ec:00:01 \
	-append "console=ttyS0 loglevel=7 panic=-1 mitigations=off tsc=reliable net.ifnames=0" \
	</dev/null
