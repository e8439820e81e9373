#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Builds a kernel with detectors of errors from Debian's source: 6.1-kcsan reports data races
# (BUG: KCSAN), 6.1-kasan wrong accesses to memory (BUG: KASAN) and wrong use of locks, timers
# and DMA. kernels.sh calls it. The configuration is detector.config and DETECTOR.config.
#
# Only modules built for this kernel are instrumented, and of the kernel itself the copies
# from and to user space: the guest is as fast as with any kernel, and each access
# that the detector watches is one of ours. KCSAN reports a race with code that is not
# instrumented when the value changes while it is watched ("race at unknown origin"). The
# kernel's allocators mark freed memory and gaps for KASAN whether they are instrumented or not.
#
# usage: detector.sh 6.1-kcsan|6.1-kasan FOLDER   build: O= for kbuild and KDIR= of modules;
#                                                 boot, lib/modules
#        detector.sh 6.1-kcsan|6.1-kasan --key    prints what the result depends on
# EC_CACHE, EC_LINUX_TAR: see tests/uml/source.sh
set -euo pipefail

die() { echo "detector.sh: $*" >&2; exit 1; }

[ $# = 2 ] || die 'usage: detector.sh 6.1-kcsan|6.1-kasan FOLDER|--key'
case $1 in
6.1-kcsan|6.1-kasan) name=${1#6.1-} ;;
*) die "unknown flavour '$1'" ;;
esac
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
config=("$here/detector.config" "$here/$name.config")
if [ "$2" = --key ]; then
	{ "$here/../uml/source.sh" --path; gcc --version | head -n 1; cat "${config[@]}" "$0"; } |
		sha256sum | cut -c1-12
	exit
fi
dir=$2
out=$dir/build
src=$("$here/../uml/source.sh")
rm -f "$dir/.complete"

# The driver folder of this source is that of the UML kernel: nothing in it here.
mkdir -p "$out/drivers/ethercat/tests/uml"
: >"$out/drivers/ethercat/tests/uml/Makefile.uml"

# A variable of the command line overrides those of all Makefiles.
mk() {
	nice make -C "$src" O="$out" ARCH=x86_64 LOCALVERSION="-$name" \
		"${name^^}_SANITIZE=n" "${name^^}_SANITIZE_usercopy.o=y" \
		-j"${EC_JOBS:-$(nproc)}" -s "$@" </dev/null
}

log=$dir/build.log
echo "detector.sh: building in $out (15 to 30 minutes)" >&2
grep -hv '^# SPDX' "${config[@]}" >"$out/.config"
mk olddefconfig >"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }
"$here/../uml/accepted.sh" "$out/.config" "${config[@]}"
mk bzImage modules >>"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }

release=$(cat "$out/include/config/kernel.release")
rm -rf "$dir/lib" "$dir/boot"
mkdir -p "$dir/boot"
mk INSTALL_MOD_PATH="$dir" modules_install >>"$log" 2>&1 || { tail -n 20 "$log" >&2; die "see $log"; }
cp "$out/arch/x86/boot/bzImage" "$dir/boot/vmlinuz-$release"
echo "$release" >"$dir/.release"
