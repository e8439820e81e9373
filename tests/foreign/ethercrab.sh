#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A foreign master, ethercrab from crates.io, on the segment "bench" of ethercat-sim.
# What was built is kept until its sources or the compiler change; then a build takes
# minutes, and the network if cargo has not the crates yet.
#
# usage: ethercrab.sh [OPTION OF ethercat-sim...]      for example --bug lrw_wkc

cd "$(dirname "$0")/../.." || exit 1
. tests/foreign/wire.sh
crate=$PWD/tests/foreign/ethercrab
folder=$cache/ethercrab-$(cat "$crate"/Cargo.* "$crate"/src/* | sha256sum | cut -c1-12)

if [ ! -x "$folder/ethercrab-witness" ]; then
	tests/install-deps.sh rust >&2 || fail "no cargo (tests/install-deps.sh rust)"
	echo "# building ethercrab in $folder"
	build_crate() {
		CARGO_TARGET_DIR=$cache/ethercrab-target \
			cargo build -q --release --locked --manifest-path "$crate/Cargo.toml" "$@" >&2
	}
	build_crate --offline 2>/dev/null || build_crate ||
		fail "ethercrab cannot be built (crates.io reachable?)"
	mkdir -p "$folder" &&
		cp "$cache/ethercrab-target/release/ethercrab-witness" "$folder/.new" &&
		mv "$folder/.new" "$folder/ethercrab-witness" || fail "no space in $folder"
fi
simulator "$@"
on_the_wire tests/foreign/beside.sh "$folder/ethercrab-witness" veth0
