#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Builds the kernel of the flavour 6.1-kcsan from Debian's source: it reports data races
# (BUG: KCSAN). kernels.sh calls it.
#
# Only modules built for this kernel are instrumented, and of the kernel itself the copies
# from and to user space: the guest is as fast as with any kernel, and each access
# that KCSAN watches is one of ours. A race with code that is not instrumented
# is reported when the value changes while it is watched ("race at unknown origin").
#
# usage: kcsan.sh FOLDER    build: O= for kbuild and KDIR= of modules; boot, lib/modules
#        kcsan.sh --key     prints what the result depends on
# EC_CACHE, EC_LINUX_TAR: see tests/uml/source.sh
set -euo pipefail

die() { echo "kcsan.sh: $*" >&2; exit 1; }

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
config=$here/kcsan.config
if [ "${1:-}" = --key ]; then
	{ "$here/../uml/source.sh" --path; gcc --version | head -n 1; cat "$config" "$0"; } |
		sha256sum | cut -c1-12
	exit
fi
[ $# = 1 ] || die 'usage: kcsan.sh FOLDER'
dir=$1
out=$dir/build
src=$("$here/../uml/source.sh")
rm -f "$dir/.complete"

# The driver folder of this source is that of the UML kernel: nothing in it here.
mkdir -p "$out/drivers/ethercat/tests/uml"
: >"$out/drivers/ethercat/tests/uml/Makefile.uml"

# A variable of the command line overrides those of all Makefiles.
mk() {
	nice make -C "$src" O="$out" ARCH=x86_64 LOCALVERSION=-kcsan KCSAN_SANITIZE=n \
		KCSAN_SANITIZE_usercopy.o=y -j"${EC_JOBS:-$(nproc)}" -s "$@" </dev/null
}

log=$dir/build.log
echo "kcsan.sh: building in $out (15 to 30 minutes)" >&2
grep -v '^# SPDX' "$config" >"$out/.config"
mk olddefconfig >"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }
"$here/../uml/accepted.sh" "$out/.config" "$config"
mk bzImage modules >>"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }

release=$(cat "$out/include/config/kernel.release")
rm -rf "$dir/lib" "$dir/boot"
mkdir -p "$dir/boot"
mk INSTALL_MOD_PATH="$dir" modules_install >>"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }
cp "$out/arch/x86/boot/bzImage" "$dir/boot/vmlinuz-$release"
echo "$release" >"$dir/.release"
