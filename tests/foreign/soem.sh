#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# A foreign master with EoE: SOEM, of which pysoem shows no EoE, from the sources that pysoem has on
# PyPI. What was built is kept until the program changes.
#
# usage: soem.sh

cd "$(dirname "$0")/../.." || exit 1
. tests/foreign/wire.sh
version=1.1.13
sources=$cache/soem-$version
program=$cache/soem-eoe-$(cat tests/foreign/soem_eoe.c | sha256sum | cut -c1-12)

# download: the sources; pip finds out what such a package needs before it stores it
download() {
	local tmp

	pysoem
	tmp=$(mktemp -d) && echo "# downloading pysoem $version" &&
		"$python" -m pip download -q --no-binary pysoem --no-deps -d "$tmp" \
			"pysoem==$version" >&2 &&
		tar -C "$tmp" -xzf "$tmp/pysoem-$version.tar.gz" &&
		mv "$tmp/pysoem-$version/soem" "$sources"
	rm -rf "$tmp"
	[ -d "$sources" ]
}

if [ ! -x "$program" ]; then
	[ -d "$sources" ] || download || fail "no sources of pysoem $version (PyPI reachable?)"
	# SOEM is built as it is; warnings are for the program only
	mkdir -p "$program.d" &&
	for f in "$sources"/soem/*.c "$sources"/osal/linux/*.c "$sources"/oshw/linux/*.c; do
		gcc -DEC_VER2 -O1 -w -I "$sources"/soem -I "$sources"/osal \
			-I "$sources"/osal/linux \
			-I "$sources"/oshw/linux -c -o "$program.d/$(basename "$f").o" "$f" ||
				fail "SOEM cannot be built"
	done &&
	gcc -DEC_VER2 -O1 -Wall -Wextra -Werror -isystem "$sources"/soem -isystem "$sources"/osal \
		-isystem "$sources"/osal/linux -isystem "$sources"/oshw/linux \
		-o "$program.new" tests/foreign/soem_eoe.c "$program.d"/*.o -lpthread -lrt &&
	mv "$program.new" "$program" || fail "SOEM cannot be built"
	rm -rf "$program.d"
fi
segment=$build/soem.segment
mkdir -p "$build"
# small and large mailboxes; one slave reads IP parameters as SOEM writes them
printf '%s\n' 'slave c EK1100' 'slave fixed drive eoe=host mbox=128' \
	'slave packed drive eoe=host mbox=512 ip=packed' 'slave large drive eoe=host mbox=1024' \
	>"$segment"
simulator --segment "$segment"
on_the_wire tests/foreign/beside.sh "$program" veth0
