#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# What takes too long for every check: 20,000 random events at ports; an hour of faults in a
# ring, and its clocks for ten minutes with a break at each cable; each function of class A
# taken away, whose tests have to fail; all suites in a UML kernel with KASAN and lockdep, and
# all of tests/system on all kernels, among them one that reports data races and one that
# reports wrong use of memory, locks and DMA; with a native network card of three models, also
# behind an IOMMU, the files that the card matters to; a million cycles of it, also while its
# cable is pulled; 600,000 cycles beside readers of events; 10,000,000 inputs of the reader of
# bus files; the packages of Debian 12 and 13; README's two commands in a fresh root of Debian
# 13; a reboot and a suspend with both kinds of device; Debian's Prometheus, which scrapes the
# metrics; Debian's numpy, which opens recordings; all benchmarks, the cycle also with the
# legacy interrupt of the card. The last line is "N passed, N failed"; results with their date
# are in Documentation/results.rst.
#
# usage: check-long.sh [ports|groups|ring|without|bus-files|uml-debug|nic-MODEL|iommu-MODEL|cycles|
#	flaps|events|packages|packages-13|check-13|reboot|prometheus|numpy|bench|bench-legacy|
#	KERNEL...]

set -u
export LC_ALL=C
cd "$(dirname "$0")/.." || exit 1
passed=0 failed=0
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# native FILE...: with 1000 times bound and unbound
native() {
	local f files=()

	for f; do files+=("tests/system/$f.bats"); done
	EC_BINDS=1000 tests/system/run.sh "${files[@]}"
}

# run NAME
run() {
	case $1 in
	nic-*) EC_NIC=${1#nic-} native thin demo faults kcycle api native ;;
	iommu-*) EC_IOMMU=1 EC_NIC=${1#iommu-} native thin kcycle native iommu ;;
	cycles|flaps|events) tests/system/run.sh "tests/system/long/$1.bats" ;;
	packages) tests/packages/run.sh ;;
	packages-13) tests/packages/run.sh trixie ;;
	check-13) tests/packages/whole.sh trixie ;;
	bench) tests/bench/run.sh ;;
	prometheus) tests/tool/prometheus.sh ;;
	numpy) tests/tool/numpy.sh ;;
	bench-legacy) EC_INTERRUPT=legacy tests/bench/cycle.sh ;;
	reboot) tests/reboot/run.sh {generic,native}{,+off,+kexec,+suspend} ;;
	without) tests/class-a/try.sh ;;
	bus-files) make -s -C tests/fuzz check names=fuzz_bus INPUTS=10000000 ;;
	ports) EC_UML_TIMEOUT=3000 EC_UML_ARGS=random_kunit.runs=80 tests/uml/run.sh bus_random ;;
	groups) EC_UML_TIMEOUT=3000 EC_UML_ARGS=groups_random_kunit.runs=100 \
		tests/uml/run.sh bus_groups_random ;;
	ring) EC_UML_TIMEOUT=3000 EC_UML_ARGS="ring_soak_kunit.minutes=60 \
		ring_clocks_long_kunit.minutes=10" tests/uml/run.sh 'bus_ring_[cs]*' ;;
	uml-debug) EC_UML_TIMEOUT=${EC_UML_TIMEOUT:-3000} tests/uml/run.sh --debug ;;
	*) EC_KERNEL=$1 tests/system/run.sh ;;
	esac
}

tests/install-deps.sh build vm capture uml json cross || exit 1
for k in ${*:-ports groups ring without bus-files uml-debug 6.1-rt 6.1 6.12-rt 6.12 \
	6.1-kcsan 6.1-kasan nic-e1000e nic-e1000 nic-igb iommu-e1000e iommu-igb cycles flaps \
	events \
	packages packages-13 check-13 reboot prometheus numpy bench bench-legacy}; do
	echo "=== $k"
	began=$SECONDS
	run "$k" >"$log" 2>&1
	rc=$?
	grep -E -A 12 '^[[:space:]#]*not ok' "$log"
	read -r p f < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$log" | tail -n 1)
	[ $rc = 0 ] || [ "${f:-0}" != 0 ] || { tail -n 20 "$log"; f=1; }
	echo "=== $k: ${p:-0} passed, ${f:-0} failed, $((SECONDS - began)) s"
	passed=$((passed + ${p:-0})) failed=$((failed + ${f:-0}))
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
