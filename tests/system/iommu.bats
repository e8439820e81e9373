# SPDX-License-Identifier: GPL-2.0-only
# vm: --icount --nics --iommu --monitor --timeout 600
# The native device behind an IOMMU: a card reaches only memory of its driver. It is at a port of
# PCIe as well, which reports errors of the bus.

load helpers

setup_file() {
	export EC_NIC=${EC_NIC:-e1000e}
	modprobe "$EC_NIC"
	pci0=$(pci eth0)
	export pci0
	start bench 22
}

teardown_file() { stop; }

demo() { LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000 --wired; }

# faults [PATTERN]: what the IOMMU has reported
faults() { dmesg | grep "DMAR: .*Request device \[.*fault addr ${1:-}"; }

# planted WHAT: prints what dma.py says. The card has no driver meanwhile, and works afterwards.
planted() {
	local rc=0

	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/unbind
	dmesg -C
	python3 "$BATS_TEST_DIRNAME/dma.py" "$pci0" "$1" eth1 >"$BATS_TEST_TMPDIR/dma" || rc=$?
	cat "$BATS_TEST_TMPDIR/dma"
	at=$(sed -n 's/^address //p' "$BATS_TEST_TMPDIR/dma")
	faults || true	# for the reader of a failure
	echo "$pci0" >/sys/bus/pci/drivers/ec_intel/bind
	return $rc
}

@test "the card has a domain of its own, without delayed invalidation" {
	[ "$(cat "/sys/bus/pci/devices/$pci0/iommu_group/type")" = DMA ]
	run ls "/sys/bus/pci/devices/$pci0/iommu_group/devices"
	[ "$output" = "$pci0" ]
}

@test "all slaves go to OP, no frame is lost, the IOMMU reports nothing" {
	dmesg -C
	before=$(lost_frames)
	run demo
	echo "$output"
	[ "$status" = 0 ]
	[ "$(lost_frames)" = "$before" ]
	run faults
	echo "$output"
	[ "$status" = 1 ]
}

@test "descriptors of a driver that has left cannot be read" {
	planted stale
	[ "$at" != 0x0 ]
	faults "$at"
	wait_for 120 all_slaves_are PREOP 22
}

# without an IOMMU it is changed, see native.bats
@test "memory of a program is not changed" {
	for what in transmit receive; do
		planted $what
		grep -x intact "$BATS_TEST_TMPDIR/dma"
		faults "$at"
	done
	wait_for 120 all_slaves_are PREOP 22
}

# monitor COMMAND: of QEMU
monitor() {
	local port

	port=$(grep -lx monitor /sys/class/virtio-ports/*/name)
	echo "$*" >"/dev/$(basename "${port%/name}")"
}

recovered() { dmesg | grep -q 'AER: device recovery successful'; }

# QEMU's cards report none, so the port does. After a fatal one the link of its port stays down.
@test "an error of the bus that needs no reset is survived in OP" {
	local app

	LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/demo" --cycles 1000000 \
		>"$BATS_TEST_TMPDIR/demo" 2>&1 3>&- &
	app=$!
	wait_for 120 all_slaves_are OP 22
	dmesg -C
	monitor pcie_aer_inject_error p0 COMP_TIME
	wait_for 60 recovered || { kill $app; dmesg; return 1; }
	wait_for 120 all_slaves_are OP 22
	kill $app
	wait $app || true
	wait_for 120 all_slaves_are PREOP 22
}

@test "after the faults all slaves go to OP" {
	run demo
	echo "$output"
	[ "$status" = 0 ]
}
