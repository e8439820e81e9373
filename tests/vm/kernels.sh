#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Debian kernels and their headers for building and for booting test guests,
# unpacked into a cache. Nothing is installed on the host and the host's apt
# configuration is not changed.

set -euo pipefail

usage() {
	cat >&2 <<-END
	usage: kernels.sh fetch FLAVOUR...    download and unpack what is not cached
	       kernels.sh kdir FLAVOUR        print a directory for make KDIR=
	       kernels.sh image FLAVOUR       print the path of vmlinuz
	       kernels.sh modules FLAVOUR     print the path of lib/modules/<release>
	       kernels.sh release FLAVOUR     print what uname -r says on it
	       kernels.sh arch FLAVOUR        print the name Debian has for its architecture
	       kernels.sh cross FLAVOUR       print ARCH= and CROSS_COMPILE= for make
	       kernels.sh root ARCH           print a folder with programs of another
	                                      architecture: i386, arm64, s390x
	       kernels.sh qemu backports      print a folder with the programs of a newer QEMU,
	                                      which has the network card igb
	       kernels.sh source 6.1          print the path of the kernel's source, an archive
	       kernels.sh sources SUITE       print apt's sources of bookworm, trixie or
	                                      trixie-backports
	       kernels.sh drop FLAVOUR...     remove from the cache (the next fetch
	                                      takes the newest version)
	flavours: 6.1 6.1-rt 6.12 6.12-rt 6.1-i386 6.1-arm64 6.1-s390x
	          6.1-armhf (headers only)    cache: $cache
	          6.12-deb13-rt (of Debian 13; the others are of Debian 12)
	          6.1-kcsan 6.1-kasan (built here from Debian's source, see detector.sh)
	END
	exit 2
}

die() { echo "kernels.sh: $*" >&2; exit 1; }
say() { echo "kernels.sh: $*" >&2; }

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
case $cache in /*) ;; *) cache=$PWD/$cache ;; esac

tmp=
trap '[ -z "$tmp" ] || rm -rf "$tmp"' EXIT
trap 'exit 130' INT HUP TERM

# Raise when the layout made by unpack() changes: old copies are then replaced.
layout=1

# What Debian calls the kernel of a flavour, and its architecture.
flavour_of() {	# flavour_of FLAVOUR: sets base, arch, name
	base=${1%%-*} arch=${1#*-}
	case $1 in
	*-i386)	name=686-pae ;;
	*-armhf) name=armmp ;;
	*-arm64|*-s390x) name=$arch ;;
	*-rt)	arch=amd64 name=rt-amd64 ;;
	*-kcsan|*-kasan) arch=amd64 name= ;;	# not a package
	*)	arch=amd64 name=amd64 ;;
	esac
}

# Prints deb822 stanzas for the given suites with the addresses and keys that
# the system's own apt configuration uses for them. --------------------------
sources() {	# sources SUITE-REGEX [REPLACEMENT]
	local f
	for f in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
		[ -r "$f" ] || continue
		case $f in
		*.sources)
			awk -v re="$1" -v repl="${2:-}" '
			function flush(   n, s, i, out) {
				if (types ~ /(^|[ \t])deb([ \t]|$)/ && enabled !~ /^(no|false|0|off)$/ &&
				    (" " comps " ") ~ /[ \t]main[ \t]/) {
					n = split(suites, s, /[ \t]+/); out = ""
					for (i = 1; i <= n; i++) if (s[i] ~ re) out = out " " s[i]
					if (out != "") {
						if (repl != "") out = " " repl
						print "Types: deb\nURIs:" uris "\nSuites:" out "\nComponents: main" extra "\n"
					}
				}
				types = uris = suites = comps = extra = enabled = field = ""
			}
			/^[ \t]*$/ { flush(); next }
			/^#/ { next }
			/^[^ \t]/ {
				field = tolower($0); sub(/:.*/, "", field)
				val = $0; sub(/^[^:]*:[ \t]*/, "", val); sub(/[ \t]+$/, "", val)
				if (field == "types") types = val
				else if (field == "uris") uris = " " val
				else if (field == "suites") suites = val
				else if (field == "components") comps = val
				else if (field == "enabled") enabled = tolower(val)
				else if (field == "architectures") ;	# apt_setup says which
				else extra = extra "\n" $0
				next
			}
			{	# continuation line, for example of a key inside Signed-By
				if (field == "uris") uris = uris $0
				else if (field == "suites") suites = suites $0
				else if (field == "components") comps = comps $0
				else extra = extra "\n" $0
			}
			END { flush() }' "$f" ;;
		*.list)
			awk -v re="$1" -v repl="${2:-}" '
			$1 == "deb" {
				line = $0; sub(/#.*/, "", line); opts = ""
				sub(/^[ \t]*deb[ \t]+/, "", line)
				if (match(line, /^\[[^]]*\][ \t]*/)) {
					opts = substr(line, 2, index(line, "]") - 2)
					line = substr(line, RLENGTH + 1)
				}
				n = split(line, w, /[ \t]+/); main = 0
				for (i = 3; i <= n; i++) if (w[i] == "main") main = 1
				if (!main || w[2] !~ re) next
				print "Types: deb\nURIs: " w[1] "\nSuites: " (repl != "" ? repl : w[2]) "\nComponents: main"
				m = split(opts, o, /[ \t]+/)
				for (i = 1; i <= m; i++) {
					k = o[i]; v = o[i]; sub(/=.*/, "", k); sub(/^[^=]*=/, "", v)
					if (k == "signed-by") print "Signed-By: " v
					if (k == "trusted") print "Trusted: " v
				}
				print ""
			}' "$f" ;;
		esac
	done
}

# suite_sources SUITE: with its updates. A system of another release has no such suite, but its
# mirrors have.
suite_sources() {
	local s out

	for s in "$1" bookworm trixie; do
		out=$(sources "^$s(-updates|-security|/updates)?\$")
		[ -n "$out" ] || continue
		sed "/^Suites:/s/\<$s/$1/g" <<<"$out"
		return
	done
}

backports_sources() {	# backports_sources SUITE
	local s

	for s in bookworm trixie; do sources "^$s\$" "$1-backports"; done
}

# The lists of packages live in the cache, so this works without root and sees
# the same packages whatever suites the host itself has switched on.
apt_opts=()
apt_setup() {	# apt_setup base|backports|trixie [ARCHITECTURE]
	local arch=${2:-amd64} d
	d=$cache/apt/$1
	[ "$arch" = amd64 ] || d=$d-$arch
	mkdir -p "$d/lists/partial" "$d/cache/archives/partial"
	case $1 in
	base)	suite_sources bookworm ;;
	trixie)	suite_sources trixie ;;
	*)	backports_sources bookworm ;;
	esac >"$d/ec.sources"
	[ -s "$d/ec.sources" ] || die "no source for Debian bookworm or trixie, 'main', found in" \
		"/etc/apt/sources.list and /etc/apt/sources.list.d; add one, or copy a filled cache to $cache"
	apt_opts=(-o "Dir::Etc::SourceList=$d/ec.sources" -o Dir::Etc::SourceParts=/dev/null
		-o "Dir::State::lists=$d/lists" -o "Dir::Cache=$d/cache" -o APT::Sandbox::User=
		-o "APT::Architecture=$arch" -o "APT::Architectures::=$arch"
		-o Acquire::Languages=none -o Acquire::Retries=2 -o APT::Get::List-Cleanup=true)
	# Mirrors drop old versions, so lists older than some hours are useless.
	if [ -z "$(find "$d/stamp" -mmin -360 2>/dev/null)" ]; then
		say "reading the list of packages ($1)"
		apt-get "${apt_opts[@]}" -qq update >"$d/update.log" 2>&1 </dev/null ||
			apt-get "${apt_opts[@]}" -qq update >"$d/update.log" 2>&1 </dev/null || {
			# One bad source among several does no harm: the show decides.
			apt-cache "${apt_opts[@]}" show linux-libc-dev >/dev/null 2>&1 || {
				cat "$d/update.log" >&2
				die "apt-get update failed; check the network and the system's apt sources"
			}
		}
		touch "$d/stamp"
	fi
}

depends() {	# depends PACKAGE REGEX: the names it depends on that match
	{ apt-cache "${apt_opts[@]}" show --no-all-versions "$1" 2>/dev/null || true; } |
		sed -n 's/^Depends: //p' | tr ',' '\n' | sed 's/^ *//; s/ .*//' | { grep -E "$2" || true; }
}

check_flavour() {
	case ${1:-} in
	6.1|6.1-rt|6.1-kcsan|6.1-kasan|6.12|6.12-rt|6.12-deb13-rt) ;;
	6.1-i386|6.1-arm64|6.1-armhf|6.1-s390x) ;;
	'') usage ;;
	*) die "unknown flavour '$1' (see kernels.sh --help)" ;;
	esac
}

# The stamp holds the layout and the place: the headers contain absolute paths,
# so a cache that was moved is not usable.
stamp() {
	case $1 in
	*-kcsan|*-kasan) echo "$layout $cache $("$here/detector.sh" "$1" --key)" ;;
	*)	echo "$layout $cache" ;;
	esac
}
cached() { [ "$(cat "$cache/kernels/$1/.complete" 2>/dev/null || true)" = "$(stamp "$1")" ]; }

# Programs of this machine build modules of any other: the same scripts, unpacked
# beside the headers. Their package is called the same everywhere.
download() {	# download SUITE ARCHITECTURE PACKAGE...: to $tmp/debs
	local suite=$1 arch=$2
	shift 2
	apt_setup "$suite" "$arch"
	(cd "$tmp/debs" && apt-get "${apt_opts[@]}" -qq download "$@") >&2 </dev/null
}

unpack() {	# unpack FLAVOUR
	local fl=$1 base arch name suite=base image release headers pkgs kbuild p root final try f
	flavour_of "$fl"
	case $fl in
	6.1|6.1-*) ;;
	*-deb13-*) suite=trixie ;;
	*)	suite=backports ;;
	esac
	for p in apt-get dpkg-deb depmod flock; do
		command -v $p >/dev/null || die "$p is missing (run tests/install-deps.sh build vm)"
	done

	final=$cache/kernels/$fl
	for try in 1 2; do
		apt_setup $suite "$arch"
		image=$(depends "linux-image-$name" "^linux-image-${base//./\\.}\.[0-9].*-$name\$" | head -n 1)
		[ -n "$image" ] ||
			die "Debian has no kernel $base (linux-image-$name); see $cache/apt/$suite/update.log"
		release=${image#linux-image-}
		headers=linux-headers-$release
		kbuild=$(depends "$headers" '^linux-kbuild-')
		pkgs="$headers $(depends "$headers" '^linux-headers-.*common' | tr '\n' ' ')"
		[ "$arch" = armhf ] || pkgs="$image $pkgs"	# nobody boots it
		rm -rf "$tmp"
		tmp=$(mktemp -d "$cache/kernels/.tmp.XXXXXX")
		mkdir "$tmp/debs"
		say "downloading $pkgs $kbuild"
		# shellcheck disable=SC2086
		download $suite "$arch" $pkgs && download $suite amd64 $kbuild && break
		[ $try = 1 ] || die "download failed; check the network, then run this again"
		rm -f "$cache"/apt/$suite*/stamp
	done

	root=$tmp/root
	mkdir "$root"
	say "unpacking $release"
	for f in "$tmp"/debs/*.deb; do dpkg-deb -x "$f" "$root"; done
	rm -rf "$tmp/debs"
	# With merged /usr the modules may come as usr/lib/modules.
	[ -d "$root/lib/modules/$release" ] || {
		mkdir -p "$root/lib/modules"
		[ ! -d "$root/usr/lib/modules/$release" ] ||
			mv "$root/usr/lib/modules/$release" "$root/lib/modules/"
	}
	# Both may exist: the headers bring the links build and source only.
	[ ! -d "$root/usr/lib/modules/$release" ] ||
		cp -an "$root/usr/lib/modules/$release/." "$root/lib/modules/$release/"
	[ "$arch" = armhf ] || [ -d "$root/lib/modules/$release/kernel" ] || die "the packages hold no modules for $release"
	[ "$arch" = armhf ] || [ -f "$root/boot/vmlinuz-$release" ] || die "the packages hold no vmlinuz for $release"

	# The headers expect to lie in /usr; point them to where they will lie.
	grep -rlE --include=Makefile --include='.kernel*' '/usr/(src|lib)/linux-' \
		"$root"/usr/src/linux-headers-*/Makefile "$root"/usr/src/linux-headers-*/.kernel* 2>/dev/null |
		xargs -r sed -i -E "s,(^|[^[:alnum:]_./-])/usr/(src|lib)/linux-,\1$final/usr/\2/linux-,g"
	find "$root/usr/src" "$root/lib/modules" -type l -lname '/usr/*' -print | while read -r p; do
		ln -sfn "$final$(readlink "$p")" "$p"
	done
	ln -sfn "$final/usr/src/$headers" "$root/lib/modules/$release/build"
	[ "$arch" = armhf ] || depmod -b "$root" "$release"
	echo "$release" >"$root/.release"
	echo "$layout $cache" >"$root/.complete"
	rm -rf "$final"
	mv -T "$root" "$final"	# appears only when complete
	rm -rf "$tmp"
	tmp=
	say "$fl is $release, in $final"
}

# What guests of another architecture run: the programs of tests/system, unpacked from
# their packages and those they depend on. No script of a package runs.
root_packages="base-files base-passwd bash bats busybox-static coreutils dash diffutils findutils gawk grep hostname
	iproute2 gojq kmod libc-bin procps psmisc python3-minimal sed tcpdump util-linux xxd"

# Our programs are linked with the C library of this system's cross compiler. Those of the packages
# run with a newer one, too.
newer_libc() {	# newer_libc ARCHITECTURE: its version, when it is not that of the packages
	grep -q '^VERSION_CODENAME=bookworm' /etc/os-release ||
		dpkg-query -W -f '${Version}' "libc6-$1-cross"
}

put_libc() {	# put_libc ARCHITECTURE ROOT
	local from=$1 to=$1

	case $1 in
	i386)	from=i686 ;;
	arm64)	from=aarch64 to=aarch64 ;;
	esac
	find "/usr/$from-linux-gnu/lib" -maxdepth 1 -name '*.so.[0-9]*' \
		-exec cp -a -t "$2/usr/lib/$to-linux-gnu" {} +
}

unpack_root() {	# unpack_root ARCHITECTURE
	local arch=$1 final=$cache/roots/$1 f d
	command -v dpkg-deb >/dev/null || die "dpkg-deb is missing"
	apt_setup base "$arch"
	tmp=$(mktemp -d "$cache/roots/.tmp.XXXXXX")
	mkdir -p "$tmp/cache/archives/partial" "$tmp/root"/usr/{bin,sbin,lib}
	: >"$tmp/status"
	for d in bin sbin lib; do ln -s "usr/$d" "$tmp/root/$d"; done
	say "downloading programs for $arch"
	# shellcheck disable=SC2086
	apt-get "${apt_opts[@]}" -o "Dir::State::status=$tmp/status" -o "Dir::Cache=$tmp/cache" \
		-o Debug::NoLocking=true -qq -y --no-install-recommends --download-only \
		install $root_packages >&2 </dev/null || die "download failed; check the network, then run this again"
	# a folder of a package must not take the place of the links made above
	for f in "$tmp"/cache/archives/*.deb; do
		dpkg-deb --fsys-tarfile "$f" | tar -x --keep-directory-symlink -C "$tmp/root"
	done
	[ -z "$(newer_libc "$arch")" ] || put_libc "$arch" "$tmp/root"
	ln -sfn gawk "$tmp/root/usr/bin/awk"
	[ -e "$tmp/root/usr/bin/sh" ] || ln -sn dash "$tmp/root/usr/bin/sh"
	for f in group passwd; do cp "$tmp/root/usr/share/base-passwd/$f.master" "$tmp/root/etc/$f"; done
	mkdir -p "$tmp/root"/{dev,proc,sys,run,tmp,root}
	root_stamp "$arch" >"$tmp/root/.complete"
	rm -rf "$final"
	mv -T "$tmp/root" "$final"
	rm -rf "$tmp"
	tmp=
}

root_stamp() {	# root_stamp ARCHITECTURE
	local libc

	libc=$(newer_libc "$1")
	echo "$layout $root_packages${libc:+ $libc}"
}

root_complete() {
	[ "$(cat "$cache/roots/$1/.complete" 2>/dev/null || true)" = "$(root_stamp "$1")" ]
}

fetch_root() {
	case $1 in
	i386|arm64|s390x) ;;
	*) die "no programs for '$1', only for i386, arm64, s390x" ;;
	esac
	root_complete "$1" && return 0
	mkdir -p "$cache/roots"
	exec 9>"$cache/roots/.lock"
	flock 9
	rm -rf "$cache"/roots/.tmp.*
	root_complete "$1" || unpack_root "$1"
	exec 9>&-
}

# Firmware is found relative to the program.
fetch_qemu() {
	local final=$cache/qemu-backports f
	[ ! -e "$final/.complete" ] || return 0
	mkdir -p "$cache"
	exec 9>"$cache/qemu.lock"
	flock 9
	if [ ! -e "$final/.complete" ]; then
		tmp=$(mktemp -d "$cache/qemu.XXXXXX")
		mkdir "$tmp/debs" "$tmp/root"
		say "downloading QEMU of bookworm-backports"
		download backports amd64 qemu-system-x86 qemu-system-common qemu-system-data \
			seabios ||
			die "download failed; check the network, then run this again"
		for f in "$tmp"/debs/*.deb; do dpkg-deb -x "$f" "$tmp/root"; done
		touch "$tmp/root/.complete"
		rm -rf "$final"
		mv -T "$tmp/root" "$final"
		rm -rf "$tmp"
		tmp=
	fi
	exec 9>&-
}

fetch() {
	cached "$1" && return 0
	mkdir -p "$cache/kernels"
	exec 9>"$cache/kernels/.lock"
	flock 9		# a second caller waits and then finds it done
	rm -rf "$cache"/kernels/.tmp.*	# left by a run that was killed
	case $1 in
	*-kcsan|*-kasan) cached "$1" || {
			EC_CACHE=$cache "$here/detector.sh" "$1" "$cache/kernels/$1" 9>&-
			stamp "$1" >"$cache/kernels/$1/.complete"
		} ;;
	*)	cached "$1" || unpack "$1" ;;
	esac
	exec 9>&-
}

# What Debian 12 installs as linux-source-6.1. Newer releases do not have it.
fetch_source() {
	local final=$cache/linux-source-6.1.tar.xz
	[ ! -e "$final" ] || return 0
	mkdir -p "$cache"
	exec 9>"$final.lock"
	flock 9
	if [ ! -e "$final" ]; then
		tmp=$(mktemp -d "$cache/source.XXXXXX")
		mkdir "$tmp/debs"
		say "downloading linux-source-6.1"
		download base amd64 linux-source-6.1 ||
			die "download failed; check the network, then run this again"
		dpkg-deb --fsys-tarfile "$tmp"/debs/linux-source-6.1*.deb |
			tar -xO --wildcards '*/linux-source-6.1.tar.xz' >"$tmp/tar"
		mv "$tmp/tar" "$final"
		rm -rf "$tmp"
		tmp=
	fi
	exec 9>&-
}

cmd=${1:-}
[ $# -ge 2 ] || usage
shift
if [ "$cmd" = root ]; then
	[ $# -eq 1 ] || usage
	fetch_root "$1"
	echo "$cache/roots/$1"
	exit 0
fi
if [ "$cmd" = qemu ]; then
	[ "$*" = backports ] || usage
	fetch_qemu
	echo "$cache/qemu-backports/usr/bin"
	exit 0
fi
if [ "$cmd" = sources ]; then
	case $* in
	bookworm|trixie) suite_sources "$1" ;;
	trixie-backports) backports_sources trixie ;;
	*)	usage ;;
	esac
	exit 0
fi
if [ "$cmd" = source ]; then
	[ "$*" = 6.1 ] || usage
	f=/usr/src/linux-source-6.1.tar.xz
	[ -r $f ] || { fetch_source; f=$cache/linux-source-6.1.tar.xz; }
	echo "$f"
	exit 0
fi
for fl; do check_flavour "$fl"; done
case $cmd in
fetch|drop) ;;
*) [ $# -eq 1 ] || usage ;;
esac
case $cmd in
fetch)	for fl; do fetch "$fl"; done ;;
drop)	for fl; do rm -rf "${cache:?}/kernels/$fl"; done ;;
kdir)	fetch "$1"
	case $1 in
	*-kcsan|*-kasan) echo "$cache/kernels/$1/build" ;;
	*)	release=$(cat "$cache/kernels/$1/.release")
		echo "$cache/kernels/$1/usr/src/linux-headers-$release" ;;
	esac ;;
image)	fetch "$1"; echo "$cache/kernels/$1/boot/vmlinuz-$(cat "$cache/kernels/$1/.release")" ;;
modules) fetch "$1"; echo "$cache/kernels/$1/lib/modules/$(cat "$cache/kernels/$1/.release")" ;;
arch)	flavour_of "$1"; echo "$arch" ;;
cross)	case $1 in
	*-i386) echo ARCH=i386 CROSS_COMPILE=i686-linux-gnu- ;;
	*-arm64) echo ARCH=arm64 CROSS_COMPILE=aarch64-linux-gnu- ;;
	*-armhf) echo ARCH=arm CROSS_COMPILE=arm-linux-gnueabihf- ;;
	*-s390x) echo ARCH=s390 CROSS_COMPILE=s390x-linux-gnu- ;;
	esac ;;
release) fetch "$1"; cat "$cache/kernels/$1/.release" ;;
*)	usage ;;
esac
