#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Builds a UML kernel with KUnit and the sources of this clone built in.
# Prints the path of the finished kernel as the last line of stdout.
#
#   build.sh [--debug] [--path|--objects]
#
# --path: only prints where it would be; --objects: where the objects of the kernel itself would be
#
# EC_CACHE      folder of the cache (default ~/.cache/ethercat)
# EC_LINUX_TAR  kernel source, see source.sh
# EC_UML_SKIP   more files to leave out, e.g. 'master/broken.c tests/bus/%'
# EC_UML_OUT    kernel's objects (a copy of the cache's, for builds of two clones at a time)
# EC_UML_OVER   folder with files that replace those of the clone, or come in addition
# EC_JOBS       parallel jobs (default: number of CPUs)
set -euo pipefail

die() { echo "build.sh: $*" >&2; exit 1; }

variant=plain only=
for a in "$@"; do
	case "$a" in
	--debug) variant=debug ;;
	--path|--objects) only=$a ;;
	*) die "unknown argument '$a'; usage: build.sh [--debug] [--path|--objects]" ;;
	esac
done

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
repo=$(cd "$here/../.." && pwd -P)
cache=${EC_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/ethercat}
jobs=${EC_JOBS:-$(nproc)}

for t in make gcc bc bison flex flock sha256sum; do
	command -v $t >/dev/null || die "'$t' is missing; run tests/install-deps.sh"
done

# the debug kernel has a tree of its own
tree=()
[ $variant = plain ] || tree=(--preempt)
src=$("$here/source.sh" ${tree[@]+"${tree[@]}"} --path) || exit 1
srckey=${src##*/linux-}

frags=("$here/kunit.config")
[ $variant = plain ] || frags+=("$here/debug.config")
key=$( { echo "$srckey"; gcc --version | head -n1; cat "${frags[@]}"; } |
	sha256sum | cut -c1-12)
out=${EC_UML_OUT:-$cache/uml/$variant-$key}
# Objects of one clone live apart from those of another: two clones share the
# kernel's objects but never a source of ours.
over=$(realpath -e -- "${EC_UML_OVER:-$repo}")
of=$repo
[ "$over" = "$repo" ] || of="$repo $over"
clone=$cache/uml/clone-$(echo "$of" | sha256sum | cut -c1-12)/$variant-$key
farm=$clone/ethercat
# Builds of one clone with different EC_UML_SKIP must not pass for each other.
kernel=$clone/vmlinux
[ -z "${EC_UML_SKIP-}" ] ||
	kernel=$kernel-$(echo "$EC_UML_SKIP" | sha256sum | cut -c1-8)
case $only in
--path) echo "$kernel"; exit ;;
--objects) echo "$out"; exit ;;
esac

"$here/source.sh" ${tree[@]+"${tree[@]}"} >/dev/null || exit 1

mkdir -p "$out/drivers" "$farm"

exec 9>"$out/.lock"
flock -n 9 || { echo "waiting for another build in $out" >&2; flock 9; }

mk() {
	make -C "$src" ARCH=um O="$out" -j"$jobs" -s EC_UML_SKIP="${EC_UML_SKIP-}" "$@" \
		</dev/null 9>&-
}

if [ ! -e "$out/.ec-configured" ]; then
	echo "configuring $variant kernel in $out" >&2
	grep -hv '^# SPDX' "${frags[@]}" >"$out/.config"
	mk olddefconfig >&2
	"$here/accepted.sh" "$out/.config" "${frags[@]}"
	touch "$out/.ec-configured"
fi

# Mirror the clone: folders are real, files are symlinks; make compares the
# times of the files they point to.
want=$(mktemp)
trap 'rm -f "$want"' EXIT
for top in "$repo" "$over"; do
	(cd "$top" && for d in include master lib/ecrt devices tests/unit tests/bus tests/uml; do
		[ ! -d $d ] || find $d -type f \( -name '*.[ch]' -o -name '*.inc' -o \
			-name '*.def' -o -name Makefile.uml -o -name skip.list \) \
			! -name '*.mod.c' ! -name '.*' -print
	done)
done | sort -u >"$want"
# A file that has another origin now may be older than its object.
(cd "$farm" && find . -type l -printf '%P %l\n') |
	while read -r f was; do
		is=$repo/$f
		[ ! -e "$over/$f" ] || is=$over/$f
		[ "$was" = "$is" ] || rm -f "$farm/$f" "$farm/${f%.c}.o"
	done
(cd "$farm" && find . -type l -printf '%P\n' | sort) | comm -13 "$want" - |
	while read -r f; do rm -f "$farm/$f" "$farm/${f%.c}.o"; done
(cd "$farm" && find . -type l -printf '%P\n' | sort) | comm -23 "$want" - |
	while read -r f; do
		mkdir -p "$farm/$(dirname "$f")"
		[ -e "$over/$f" ] && ln -s "$over/$f" "$farm/$f" || ln -s "$repo/$f" "$farm/$f"
	done

link=$out/drivers/ethercat
if [ "$(readlink "$link" || true)" != "$farm" ]; then
	rm -rf "$link"
	ln -s "$farm" "$link"
	# Another clone's archive may look up to date: make it anew.
	rm -f "$farm/built-in.a"
fi

start=$SECONDS
log=$clone/build.log
rc=0
mk vmlinux >"$log" 2>&1 || rc=$?
# Show paths as they are in the clone, without the linker's usual remarks.
sed -e 's#[^ :]*drivers/ethercat/##g' \
	-e '/^make\(\[[0-9]*\]\)\?: /d' \
	-e '/missing .note.GNU-stack\|NOTE: This behaviour\|RWX permissions/d' \
	"$log" >&2
[ $rc = 0 ] || die "kernel build failed (log: $log)"
cp --reflink=auto "$out/vmlinux" "$kernel.new"
mv -f "$kernel.new" "$kernel"
echo "built $variant kernel in $((SECONDS - start)) s" >&2
echo "$kernel"
