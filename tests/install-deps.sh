#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-only
#
# Installs what building and testing need, and nothing that is there already.
# usage: tests/install-deps.sh GROUP...    (build, vm, capture, uml, python, json, doc, cmake,
# rust, cross, packages)

set -eu

usage() {
	echo "usage: ${0##*/} GROUP...   groups: build vm capture uml python json doc cmake rust" \
		"cross packages" >&2
	exit 2
}

# A dpkg query is enough to see what is missing, so that a second run costs
# nothing and needs neither root nor network.
installed() {
	[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]
}

[ $# -gt 0 ] || usage
command -v dpkg-query >/dev/null 2>&1 || {
	echo "${0##*/}: this is not a Debian system; install the packages listed in $0 by hand" >&2
	exit 1
}
# shellcheck disable=SC1091
release=$(. /etc/os-release && echo "${VERSION_ID:-}")

want=
for group; do
	case $group in
	# gcc-12 as well: the headers of Debian 12's kernels ask for it by its name
	build)	p="gcc gcc-12 g++ ccache make libc6-dev pkg-config bc bison flex libelf-dev pahole
		   sparse kmod cpio xz-utils zstd git libyaml-dev" ;;
	vm)	p="qemu-system-x86 busybox-static cpio kmod xz-utils zstd bats tcpdump
		   iproute2 ethtool tshark procps psmisc python3 xxd udev systemd" ;;
	capture) p="tcpdump iproute2 tshark" ;;
	# without the package kernels.sh fetches the source
	uml)	p="xz-utils python3"
		[ "$release" != 12 ] || p="$p linux-source-6.1" ;;
	python)	p="python3-venv" ;;
	json)	p="gojq python3-jsonschema python3-prometheus-client python3-yaml" ;;
	doc)	p="python3-sphinx" ;;
	cmake)	p="cmake" ;;
	# any cargo does that is new enough, Debian's "cargo" is not
	rust)	p="cargo-web"
		cargo --version 2>/dev/null | awk -F '[ .]' '{ ok = $2 > 1 || $3 >= 85 } END { exit !ok }' && p= ;;
	cross)	p="g++-i686-linux-gnu libc6-dev-i386-cross gcc-arm-linux-gnueabihf
		   libc6-dev-armhf-cross g++-aarch64-linux-gnu libc6-dev-arm64-cross
		   g++-s390x-linux-gnu libc6-dev-s390x-cross gcc-12-i686-linux-gnu
		   gcc-12-arm-linux-gnueabihf gcc-12-aarch64-linux-gnu gcc-12-s390x-linux-gnu
		   qemu-user-static
		   qemu-system-arm qemu-system-misc" ;;
	packages) p="mmdebstrap" ;;
	-h|--help) usage ;;
	*)	echo "${0##*/}: unknown group '$group'" >&2; usage ;;
	esac
	want="$want $p"
done

missing=
for p in $want; do
	installed "$p" && continue
	case " $missing " in *" $p "*) ;; *) missing="${missing:+$missing }$p" ;; esac
done
if [ -z "$missing" ]; then
	echo "install-deps: all there ($*)"
	exit 0
fi

if [ "$(id -u)" -eq 0 ]; then
	sudo=
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
	sudo="sudo -n"
else
	echo "install-deps: missing: $missing" >&2
	echo "install-deps: run this script as root, or: apt-get install $missing" >&2
	exit 1
fi

log=$(mktemp "${TMPDIR:-/tmp}/install-deps.XXXXXX")
trap 'rm -f "$log"' EXIT
trap 'exit 130' INT HUP TERM

# Mirrors fail now and then, so each step gets a second chance. The output is
# shown only when both fail: it is long and says little otherwise.
apt() {
	for try in 1 2; do
		# shellcheck disable=SC2086
		$sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq \
			-o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 -o Acquire::Retries=5 \
			"$@" >"$log" 2>&1 </dev/null && return 0
		[ $try = 2 ] || sleep 3
	done
	return 1
}

echo "install-deps: apt-get update"
# A broken third-party source must not stop us: the install below decides.
apt update || echo "install-deps: apt-get update had errors, going on" >&2
echo "install-deps: apt-get install $missing"
# shellcheck disable=SC2086
if ! apt install -y --no-install-recommends $missing; then
	cat "$log" >&2
	echo "install-deps: could not install: $missing (see above)" >&2
	exit 1
fi
