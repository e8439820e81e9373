#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Other architectures: structures of the device file, programs, unit tests in QEMU's user
# mode, 64-bit values in mapped memory. (Modules: tests/check-kernels.sh; kernels that
# run: tests/arch/guests.sh.) The last line is "N passed, N failed".

set -u
cd "$(dirname "$0")/../.." || exit 1
out=$PWD/build/arch
mkdir -p "$out" || exit 1
. tests/t.sh
compilers="i686-linux-gnu arm-linux-gnueabihf aarch64-linux-gnu s390x-linux-gnu"
warn="-O2 -Wall -Wextra -Werror"

# --- structures --------------------------------------------------------------
# An object for each structure, as large as it.
sizes_source() {
	local s

	echo '#include "ethercat.h"'
	for s in $(sed -n 's/^struct \(ec_[a-z0-9_]*\) {$/\1/p' include/uapi/*.h); do
		echo "char $s[sizeof(struct $s)];"
	done
}

sizes() {	# sizes COMPILER: "size name" of each
	"$1" -Iinclude/uapi -fno-common -x c -c -o "$out/sizes.o" "$out/sizes.c" &&
		nm -S "$out/sizes.o" | awk 'NF == 4 { sub(/^0+/, "", $2); print $2, $4 }' | sort -k 2
}

# members of fixed width without padding lie at the same offsets everywhere
no_padding() { "$1" -Iinclude/uapi -Wpadded -Werror -x c -c -o /dev/null "$out/sizes.c"; }

same_sizes() { [ "$(wc -l <"$out/sizes.gcc")" -ge 60 ] && diff "$out/sizes.gcc" <(sizes "$1"); }

# else the two above could not fail
padding_is_noticed() {
	! gcc -Wpadded -Werror -x c -c -o /dev/null - <<<'struct s { int a; long long b; } s;'
}

sizes_source >"$out/sizes.c"
sizes gcc >"$out/sizes.gcc"
t "gcc notices padding" padding_is_noticed
t "no structure of the device file has padding" no_padding gcc
for c in $compilers; do
	t "structures of the device file are the same with $c" eval "no_padding $c-gcc && same_sizes $c-gcc"
done

# --- programs ----------------------------------------------------------------
programs() {	# programs COMPILER
	local vars=(CC="$1-gcc" AR="$1-ar" CFLAGS="$warn")

	make -s -C lib O="$out/$1/lib" "${vars[@]}" all &&
	make -s -C lib/tools O="$out/$1/tools" "${vars[@]}" all &&
	make -s -C tool O="$out/$1/tool" "${vars[@]}" &&
	make -s -C tool/sim O="$out/$1/tool" "${vars[@]}" &&
	make -s -C examples O="$out/$1/examples" LIB="$out/$1/lib" "${vars[@]}" all
}

# libatomic, for example, is not on each machine; libm is a part of the C library
libc_only() {
	! readelf -d "$out/$1/lib/libethercat.so" "$out/$1/tools/libethercat-tools.so" \
		"$out/$1/tool/ethercat" | grep NEEDED |
		grep -v 'libc\.so\|libm\.so\|ld-linux\|ld64\.so\|libethercat-tools\.so\.1'
}

for c in $compilers; do
	t "library, tool, simulator and examples without a warning with $c" programs "$c"
	t "they need the C library only with $c" libc_only "$c"
done

# --- 64-bit values in mapped memory ------------------------------------------
torn() {	# torn COMPILER QEMU
	"$1-gcc" -O2 -static -pthread -std=gnu11 -D_GNU_SOURCE -D_FILE_OFFSET_BITS=64 -Wall -Wextra \
		-Werror -Iinclude -Iinclude/uapi -o "$out/torn-$1" tests/arch/torn.c &&
	"$2" "$out/torn-$1" - && "$2" "$out/torn-$1"
}

t "64-bit values of the status page are read whole on i386" torn i686-linux-gnu qemu-i386-static
t "64-bit values of the status page are read whole on ARM" torn arm-linux-gnueabihf qemu-arm-static

# --- unit tests --------------------------------------------------------------
# Without the libraries of the sanitizers, which QEMU's user mode does not run.
unit() {	# unit COMPILER QEMU
	local dir=$PWD/build/unit-$1

	make -s -j2 -C tests/unit build B="$dir" CC="$1-gcc" \
		SAN="-static -fsanitize=undefined -fsanitize-undefined-trap-on-error" &&
	"$2" "$dir/unit"
}

t "unit tests on i386" unit i686-linux-gnu qemu-i386-static
t "unit tests on ARM" unit arm-linux-gnueabihf qemu-arm-static
t "unit tests on s390x, whose bytes have the other order" unit s390x-linux-gnu qemu-s390x-static

echo "$passed passed, $failed failed"
[ $failed = 0 ]
