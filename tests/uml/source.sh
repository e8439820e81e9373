#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Unpacks the kernel source for all kernels that the tests build (UML, KCSAN, KASAN), once, with a
# driver folder for the sources of this clone. Prints its path.
#
#   source.sh [--preempt] [--path]
#
# --preempt: UML may count preempt_disable(), which DEBUG_ATOMIC_SLEEP needs. It could, but 6.1
#            does not let it: this tree is without that line.
# --path:    only prints where it would be
#
# EC_CACHE      folder of the cache (default ~/.cache/ethercat)
# EC_LINUX_TAR  kernel source (default: linux-source-6.1 of Debian 12)
set -euo pipefail

die() { echo "source.sh: $*" >&2; exit 1; }

cache=${EC_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/ethercat}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
tarball=${EC_LINUX_TAR:-$("$here/../vm/kernels.sh" source 6.1)} || exit 1
preempt= pathonly=
for a in "$@"; do
	case $a in
	--preempt) preempt=-preempt ;;
	--path) pathonly=1 ;;
	*) die "unknown argument '$a'; usage: source.sh [--preempt] [--path]" ;;
	esac
done
for t in xz flock; do
	command -v $t >/dev/null || die "'$t' is missing; run tests/install-deps.sh"
done
[ -r "$tarball" ] || die "$tarball is missing; run tests/install-deps.sh"

src=$cache/src/linux-$(stat -Lc '%s-%Y' "$tarball")$preempt
echo "$src"
[ -z "$pathonly" ] || exit 0

# An unpacked tree is never changed again, so that clones can share it.
mkdir -p "$cache/src"
exec 9>"$cache/src/.lock"
flock 9
if [ ! -e "$src/.ec-ready" ]; then
	echo "unpacking $(basename "$tarball")" >&2
	tmp=$(mktemp -d "$cache/src/tmp.XXXXXX")
	tar xf "$tarball" -C "$tmp" --strip-components=1
	[ -z "$preempt" ] || sed -i '/select ARCH_NO_PREEMPT$/d' "$tmp/arch/um/Kconfig"
	mkdir -p "$tmp/drivers/ethercat"
	echo 'include $(obj)/tests/uml/Makefile.uml' \
		>"$tmp/drivers/ethercat/Makefile"
	echo 'obj-y += ethercat/' >>"$tmp/drivers/Makefile"
	touch "$tmp/.ec-ready"
	rm -rf "$src"
	mv "$tmp" "$src"
fi
