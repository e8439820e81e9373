#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# The Debian packages: built, checked by lintian, installed into a minimal Debian, with modules for
# the kernel that is there and for one that comes later, started by systemd in a guest, upgraded,
# removed, purged. Minutes; needs root. The last line is "N passed, N failed".
#
# usage: run.sh [bookworm|trixie [lint]]	default: bookworm; lint: builds and checks them only

set -u
export LC_ALL=C
cd "$(dirname "$0")/../.." || exit 1
packages="ethercat-tools ethercat-dkms libethercat1 libethercat-dev libethercat-tools1 libethercat-tools-dev ethercat-doc"
packages="$packages libethercat-bus1 libethercat-bus-dev"
passed=0 failed=0
suite=${1:-bookworm}
root=$(tests/packages/root.sh "$suite") || exit 1
kernel=$(tests/packages/root.sh "$suite" kernel)
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-packages.XXXXXX")
trap 'rm -rf "$tmp"' EXIT

t() {	# t NAME COMMAND...
	local name=$1

	shift
	if "$@" >"$tmp/out" 2>&1; then
		echo "ok $name"
		passed=$((passed + 1))
	else
		echo "not ok $name"
		tail -n 40 "$tmp/out" | sed 's/^/# /'
		failed=$((failed + 1))
	fi
}

# in_root SCRIPT: in the root, with what the scripts before have changed
in_root() { tests/packages/enter.sh "$root" "$tmp/root" sh -euc "$1"; }

# source VERSION: the clone at /src in the root
source() {
	local dir=$tmp/root/upper/src/ethercat-$1

	mkdir -p "$dir"
	# the clone may be another user's
	git -c safe.directory='*' ls-files -z | xargs -0 cp --parents -t "$dir" &&
		sed -i "1s/([^)]*)/($1)/" "$dir/debian/changelog"
}

build() {
	source "$1" && in_root "cd /src/ethercat-$1 && dpkg-buildpackage -us -uc -b" &&
		[ "$(cd "$tmp/root/upper/src" && ls ./*_"$1"_*.deb | grep -vc dbgsym)" = 9 ]
}

# warnings have to be read, too
lint() {
	in_root 'cd /src && lintian --allow-root --fail-on error,warning ethercat_0.1.0_*.changes'
}

install() {
	in_root "cd /src && apt-get -y install \$(ls ./*_$1_*.deb | grep -v dbgsym)"
}

# has_modules VERSION: for all kernels whose headers are installed
has_modules() {
	in_root "
		dkms status
		n=0
		for d in /lib/modules/*/build; do
			k=\${d%/build} n=\$((n + 1))
			dkms status | grep -q \"^ethercat/$1, \${k##*/}, .*: installed\"
			# by file: without the kernel itself DKMS runs no depmod
			for m in ec_master ec_generic ec_intel ec_sim; do
				modinfo \$(find \$k/updates -name \$m.ko\*) >/dev/null
			done
		done
		[ \$n = $2 ]
		[ \$(ls /lib/modules/*/updates/ethercat/Module.symvers | wc -l) = $2 ]
		[ \$(dkms status | grep -c ethercat) = $2 ]"
}

# everything but what each installation of packages changes, and the key that DKMS makes once
list() {
	in_root 'find / -xdev \( -path /src -o -path /proc -o -path /tmp -o -path /var/log -o \
		-path /var/cache -o -path /usr/lib/modules -o -path /var/lib/apt -o \
		-path /var/lib/dpkg -o -path "/var/lib/dkms/mok.*" -o -path /root \) \
		-prune -o -print' | sort
}

# what Documentation/install.rst has for secure boot
signed() {
	in_root '
		k=$(ls /lib/modules | tail -n 1) d=/tmp/sign
		modinfo -k $k -F signer ec_master | grep "DKMS module signing key"
		[ -s /var/lib/dkms/mok.pub ]
		mkdir $d
		f=$(modinfo -k $k -n ec_sim)
		case $f in
		*.xz) xz -dc $f >$d/ec_sim.ko ;;
		*) cp $f $d ;;
		esac
		openssl req -new -x509 -nodes -days 36500 -subj "/CN=EtherCAT modules" \
			-newkey rsa:2048 -keyout $d/mok.key -outform DER -out $d/mok.pub
		/lib/modules/$k/build/scripts/sign-file sha256 $d/mok.key $d/mok.pub $d/ec_sim.ko
		modinfo -F signer $d/ec_sim.ko | grep "EtherCAT modules"
		rm -r $d'
}

program_builds() {
	in_root 'printf "%s\n" "#include <ecrt.h>" "int main(void) { return !ecrt_version_magic(); }" \
		>/tmp/app.c
		gcc -o /tmp/app /tmp/app.c $(pkg-config --cflags --libs libethercat)
		/tmp/app
		printf "%s\n" "#include <ethercat-tools.h>" "int main(void) { return !ect_new(); }" \
			>/tmp/app.c
		gcc -o /tmp/app /tmp/app.c $(pkg-config --cflags --libs libethercat-tools)
		/tmp/app
		rm /tmp/app /tmp/app.c'
}

# what Documentation/kernel-api.rst has; the guest loads it
module_builds() {
	in_root '
		k=$(ls /lib/modules)
		cp -r /usr/share/doc/ethercat-doc/examples/mini /srv/mini
		cd /srv/mini
		make -s -C /lib/modules/$k/build M=$PWD CONFIG_DEBUG_INFO_BTF_MODULES= W=1 \
			ECRT=/usr/include \
			KBUILD_EXTRA_SYMBOLS=/lib/modules/$k/updates/ethercat/Module.symvers \
			modules >log 2>&1 || { cat log; exit 1; }
		cat log
		! grep -E "warning:|WARNING:" log'
}

# The pages, and the tutorial that the guest runs
pages() {
	local page=Documentation/first-ten-minutes.rst block

	in_root 'cd /usr/share/doc/ethercat-doc/html
		grep -q "AL status codes" codes.html
		grep -q c.ecrt_master_activate api.html
		for f in $(sed -n "s/.*href=\"\([a-z-]*\.html\)\".*/\1/p" index.html); do
			[ -s $f ]
		done' &&
	for block in 'modprobe ec_master main_devices=sim0' 'ethercat graph --tree' \
		'cp -r /usr/share/doc/ethercat-doc/examples ~' \
		'~/examples/build/dc_motion follow 4 5 5'; do
		tests/build/commands.py --block "$page" "$block" || return
		echo sleep 5	# a scan
	done >"$tmp/root/upper/srv/tutorial"
}

# The service starts with the guest, which has systemd as its init; an application with the unit
# of Documentation/install.rst; stops that are refused; removal while masters run.
boots() {
	in_root 'systemctl enable ethercat
		gcc -o /srv/mirror /usr/share/doc/ethercat-doc/examples/mirror.c \
			$(pkg-config --cflags --libs libethercat) -pthread' &&
	cp tests/packages/run-unit.sh "$tmp/root/upper/srv" &&
	sed -n '/^    \[Unit\]/,/^    Restart/s/^    //p' Documentation/install.rst \
		>"$tmp/root/upper/srv/app.service" &&
	tests/packages/enter.sh --mount "$root" "$tmp/root" sh -c \
		'exec tests/vm/run.sh --kernel "$2" --init "$MERGED" --timeout 900 -- \
			sh -euxc "$1"' sh '
		wait_until() {
			n=0
			until eval "$1"; do
				n=$((n + 1))
				[ $n -lt 100 ] || return
				sleep 1
			done
		}
		slaves() { [ "$(ethercat slaves | grep -cw $1)" = $2 ]; }
		position() { ethercat slaves | grep -m 1 $1 | { read -r n rest; echo $n; }; }
		unloaded() { [ ! -e /dev/EtherCAT0 ] && [ ! -e /sys/module/ec_master ]; }
		refused() { if "$@"; then exit 1; fi; }
		# the journal has it some time after the end of the program that wrote it
		said() {
			wait_until "journalctl -u ethercat | grep \"$1\"" ||
				{ journalctl -n 30; return 1; }
		}
		systemctl is-active ethercat
		wait_until "slaves PREOP 22"
		ethercat slaves | head -n 3
		ethercatctl status
		# from the package to a live value with two commands
		ethercat run
		timeout 2 ethercat watch "el1008.*" | grep -m 1 "el1008.channel_1.input = "
		ethercat stop
		wait_until "slaves PREOP 22"
		sh -eux /srv/run-unit.sh
		systemctl start ethercat-metrics.socket
		python3 -c "import urllib.request as u
print(u.urlopen(\"http://127.0.0.1:9488/metrics\", timeout=20).read().decode())" >/tmp/metrics
		grep -x "ethercat_slaves{master=.0.} 22" /tmp/metrics
		grep -x "# EOF" /tmp/metrics
		systemctl stop ethercat-metrics.socket
		insmod /srv/mini/ec_mini.ko position=16
		rmmod ec_mini
		[ "$(stat -c "%G %a" /dev/EtherCAT0)" = "ethercat 664" ]
		in=$(position EL1008) out=$(position EL2008)
		{ cat /srv/app.service; echo "ExecStart=/srv/mirror $in $out"; } \
			>/etc/systemd/system/app.service
		systemctl daemon-reload
		systemctl start app
		wait_until "slaves OP 3"
		systemctl restart ethercat
		wait_until "systemctl is-active app && slaves OP 3"
		systemctl disable --now ethercat
		refused systemctl is-active app
		unloaded
		systemctl enable --now ethercat
		wait_until "slaves PREOP 22"
		/srv/mirror $in $out &
		app=$!
		wait_until "slaves OP 3"
		systemctl stop ethercat || true
		systemctl is-failed ethercat
		refused systemctl restart ethercat
		slaves OP 3
		kill $app
		wait $app || true
		ethercatctl stop
		unloaded
		HOME=/root sh -eux /srv/tutorial
		ethercatctl stop
		unloaded
		systemctl restart ethercat
		systemctl stop ethercat
		unloaded
		cp /etc/ethercat.conf /tmp/conf
		systemctl start ethercat
		wait_until "slaves PREOP 22"
		echo "MASTER0_DEVICE=lo" >/etc/ethercat.conf
		refused systemctl restart ethercat
		slaves PREOP 22
		said "the masters run on; mend /etc/ethercat.conf"
		cp /tmp/conf /etc/ethercat.conf
		systemctl start ethercat
		rm /etc/ethercat.conf
		refused systemctl restart ethercat
		slaves PREOP 22
		ethercatctl stop
		unloaded
		refused systemctl restart ethercat
		echo "MASTER0_DEVICE=eth9" >/etc/ethercat.conf
		refused systemctl start ethercat
		said "ethercat.conf:1: .*no such device after 10 s"
		cp /tmp/conf /etc/ethercat.conf
		ethercatctl start
		refused unloaded
		dpkg --remove --no-triggers --force-depends ethercat-tools
		unloaded' \
		"$kernel" >"$tmp/guest" 2>&1 &&
	grep -q 'Master0  running' "$tmp/guest"
	local rc=$?

	tail -n 40 "$tmp/guest"
	return $rc
}

enabled() { in_root 'systemctl is-enabled ethercat && grep -q mine /etc/ethercat.conf'; }
removed() {
	in_root "apt-get -y remove $packages"'
		[ -z "$(find /lib/modules -name "ec_*")" ]
		[ -z "$(find /lib/modules -path "*/updates*")" ]
		[ ! -e /etc/udev/rules.d/59-ethercat-0000:01:00.0.rules ]
		[ -z "$(dkms status)" ]
		[ ! -e /usr/bin/ethercat ]
		grep -q mine /etc/ethercat.conf'
}

purged() {
	in_root "dpkg --purge $packages" &&
		list >"$tmp/after" && diff "$tmp/before" "$tmp/after"
}

t "dpkg-buildpackage builds nine packages" build 0.1.0
[ $failed = 0 ] || { echo "$passed passed, $failed failed"; exit 1; }
t "lintian reports neither an error nor a warning" lint
if [ "${2:-}" = lint ]; then
	echo "$passed passed, $failed failed"
	exit $((failed > 0))
fi
list >"$tmp/before"
t "apt installs the packages" install 0.1.0
t "DKMS has built the modules for the installed kernel" has_modules 0.1.0 1
t "the modules are signed by DKMS, and can be signed by hand" signed
t "programs build against libethercat-dev and libethercat-tools-dev" program_builds
t "a kernel module builds against the modules that are installed" module_builds
t "the pages are HTML, with the codes and the reference of ecrt.h" pages
t "systemd starts the simulated bus and an application in a guest, and stops them" boots
in_root 'rm -rf /srv/mini /srv/mirror /srv/app.service /srv/tutorial /srv/run-unit.sh \
	/root/examples'
t "the headers of another kernel are installed" in_root 'dpkg -i /srv/second/*.deb'
t "DKMS has built the modules for the new kernel" has_modules 0.1.0 2
in_root 'echo "# mine" >>/etc/ethercat.conf; systemctl enable ethercat
	echo "# Written by '\''ethercat device bind --boot'\''." \
		>/etc/udev/rules.d/59-ethercat-0000:01:00.0.rules' 2>/dev/null
t "a newer version builds" build 0.1.1
t "apt upgrades to it" install 0.1.1
t "DKMS has the modules of the newer version only" has_modules 0.1.1 2
t "an upgrade keeps the configuration, and whether the service is enabled" enabled
t "remove leaves the configuration, no module and no rule" removed
# the headers are not ours
t "the headers of the other kernel are purged" in_root '
	for f in /srv/second/*.deb; do dpkg-deb -f "$f" Package; done | xargs dpkg --purge'
t "purge leaves nothing" purged
echo "$passed passed, $failed failed"
[ $failed = 0 ]
