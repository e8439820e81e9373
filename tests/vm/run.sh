#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Boots a kernel in QEMU with the host's files and runs one command there.
# Modules and real-time code are tested this way on any machine: a crash costs
# a guest, not the host.

set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}
case $cache in /*) ;; *) cache=$PWD/$cache ;; esac
export EC_CACHE=$cache

usage() {
	cat >&2 <<-'END'
	usage: run.sh [options] [--] COMMAND [ARG...]
	  --kernel FLAVOUR   6.1, 6.1-rt (default), 6.1-kcsan, 6.1-kasan, 6.12, 6.12-rt;
	                     6.1-i386, 6.1-arm64, 6.1-s390x with programs of that
	                     architecture (tests/vm/kernels.sh root) and from the host the
	                     current folder's repository only
	  --smp N            CPUs (default 2)
	  --mem MB           memory (default 1024)
	  --icount           exact virtual time, one CPU (-icount shift=0,sleep=off)
	  --nics             two e1000e joined by a wire (eth0 and eth1; modprobe e1000e)
	  --nic MODEL        the same with e1000 or igb (a newer QEMU, kernels.sh qemu)
	  --more-nics MODEL  two more, joined by another wire (52:54:00:ec:00:02 and 03)
	  --iommu            all NICs behind an IOMMU, which stops DMA to memory of others;
	                     e1000e and igb at ports of PCIe
	  --monitor          QEMU's monitor in the guest: the virtio port "monitor" takes its
	                     commands, for example set_link nic0 off
	  --rw DIR           DIR of the host is writable in the guest (may be repeated);
	                     all other writes are lost at the end
	  --init DIR         DIR is the root, and its systemd runs the command when all units of
	                     multi-user.target have started; only its own modules are there
	  --timeout SEC      for boot and command together (default 300)
	  --append '...'     more kernel parameters, for example loglevel=7
	  --qemu '...'       more QEMU options
	  --dmesg FILE       store the guest's kernel log
	  --allow-oops       do not fail on kernel warnings
	  --probe            run nothing, print what QEMU would use: kvm or tcg
	  -v                 print how long booting took
	exit status: the command's; 70 the kernel reported a fault, 124 timeout,
	  125 the guest died or something is missing here
	environment: EC_ACCEL=kvm or tcg (else found out), EC_CACHE; EC_KCSAN_SKIP=N: with KCSAN
	  one of up to N accesses is watched (100); EC_BEGIN=SEC: a guest whose command has not
	  begun by then, 240, is started again, once (not with --init)
	END
	exit 125
}

die() { echo "run.sh: $*" >&2; exit 125; }

kernel=6.1-rt smp=2 mem=1024 icount=0 nic= more= iommu=0 monitor=0 timeout=300
append= qemu_more= dmesg= allow_oops=0 verbose=0 probe=0 init=
rw=()
need() { [ $# -ge 2 ] || { echo "run.sh: $1 needs a value" >&2; usage; }; }
while [ $# -gt 0 ]; do
	case $1 in
	--kernel) need "$@"; kernel=$2; shift 2 ;;
	--smp) need "$@"; smp=$2; shift 2 ;;
	--mem) need "$@"; mem=$2; shift 2 ;;
	--icount) icount=1; shift ;;
	--nics) nic=e1000e; shift ;;
	--monitor) monitor=1; shift ;;
	--nic) need "$@"; nic=$2; shift 2 ;;
	--more-nics) need "$@"; more=$2; shift 2 ;;
	--iommu) iommu=1; shift ;;
	--rw) need "$@"; rw+=("$2"); shift 2 ;;
	--init) need "$@"; init=$2; shift 2 ;;
	--timeout) need "$@"; timeout=$2; shift 2 ;;
	--append) need "$@"; append="$append $2"; shift 2 ;;
	--qemu) need "$@"; qemu_more="$qemu_more $2"; shift 2 ;;
	--dmesg) need "$@"; dmesg=$2; shift 2 ;;
	--allow-oops) allow_oops=1; shift ;;
	--probe) probe=1; shift ;;
	-v) verbose=1; shift ;;
	-h|--help) usage ;;
	--) shift; break ;;
	-*) echo "run.sh: unknown option $1" >&2; usage ;;
	*) break ;;
	esac
done
[ $# -gt 0 ] || [ $probe = 1 ] || usage
[[ $timeout =~ ^[0-9]+$ && $smp =~ ^[0-9]+$ && $mem =~ ^[0-9]+$ ]] ||
	die "--timeout, --smp and --mem take a number"

for m in $nic $more; do
	case $m in
	e1000|e1000e) ;;
	igb)	PATH=$("$here/kernels.sh" qemu backports):$PATH || exit 125 ;;
	*)	die "--nic: e1000, e1000e or igb, not $m" ;;
	esac
done

root=/ dirs=() busybox=
arch=$("$here/kernels.sh" arch "$kernel") || exit 125
case $arch in
# a string instruction with ERMS is emulated byte by byte
amd64|i386) qemu=(qemu-system-x86_64) cpu=max,-erms,-fsrm console=ttyS0 ;;
arm64)	qemu=(qemu-system-aarch64 -M virt) cpu=cortex-a57 console=ttyAMA0 ;;
s390x)	qemu=(qemu-system-s390x) cpu=max console=ttysclp0 ;;
*)	die "no guest for $arch" ;;
esac
for p in "${qemu[0]}" cpio modprobe timeout awk sed stdbuf flock; do
	command -v $p >/dev/null || die "$p is missing (run tests/install-deps.sh vm)"
done
if [ "$arch" != amd64 ]; then
	root=$("$here/kernels.sh" root "$arch") || exit 125
	busybox=$root/bin/busybox
	dirs+=("$(cd "$here/../.." && pwd -P)")
fi
if [ -n "$init" ]; then
	[ -x "$init/lib/systemd/systemd" ] || die "--init: no systemd in $init"
	root=$(cd "$init" && pwd -P)
	init=/lib/systemd/systemd
fi
for p in /usr/bin/busybox /bin/busybox; do
	[ -z "$busybox" ] || break
	# One linked against libraries would not start in the initramfs.
	if [ -x $p ] && ! LC_ALL=C ldd $p >/dev/null 2>&1; then busybox=$p; break; fi
done
[ -n "$busybox" ] || die "no static busybox (run tests/install-deps.sh vm)"

image=$("$here/kernels.sh" image "$kernel") || exit 125
modules=$("$here/kernels.sh" modules "$kernel") || exit 125
release=${modules##*/}
[ "$arch" = amd64 ] || dirs+=("$modules")

tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-vm.XXXXXX")
qemu_pid= watch_pid=
cleanup() {
	[ -z "$watch_pid" ] || kill "$watch_pid" 2>/dev/null || true
	[ -z "$qemu_pid" ] || kill "$qemu_pid" 2>/dev/null || true
	rm -rf "$tmp"
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' HUP TERM

# --- initramfs: once per kernel and init script --------------------------------
hash=$({ cat "$here"/guest-{init,run}.sh "$here/run.sh" "$busybox"; stat -Lc '%s %Y' "$image"; } |
	sha256sum | cut -c1-12)
initrd=$cache/initramfs/$release-$hash.img

build_initrd() {
	local i=$tmp/initramfs m

	mkdir -p "$i/bin" "$i/mod" "$i/dev" "$i/proc"
	cp "$busybox" "$i/bin/busybox"
	install -m 755 "$here/guest-init.sh" "$i/init"
	cp "$here/guest-run.sh" "$i/"
	for m in virtio_pci virtio_console 9pnet_virtio 9p overlay; do
		modprobe -d "${modules%/lib/modules/*}" -S "$release" --show-depends "$m" ||
			die "the kernel $release has no module $m"
	done >"$tmp/depends" || exit 125
	# Builtin ones appear as "builtin NAME"; dependencies come first.
	awk '$1 == "insmod" && !seen[$2]++ { print $2 }' "$tmp/depends" | while read -r m; do
		case $m in
		*.xz) xz -dc "$m" >"$i/mod/$(basename "$m" .xz)"; basename "$m" .xz ;;
		*.zst) zstd -qdc "$m" >"$i/mod/$(basename "$m" .zst)"; basename "$m" .zst ;;
		*) cp "$m" "$i/mod/"; basename "$m" ;;
		esac
	done >"$i/mod/order"
	(cd "$i" && find . | cpio --quiet -o -H newc | gzip -1) >"$tmp/initrd"
	cp "$tmp/initrd" "$initrd.$$" && mv "$initrd.$$" "$initrd"	# never a half one
	rm -rf "$i"
	# Those of other versions of this script, which nobody uses any more.
	find "$cache/initramfs" -name "$release-*.img*" ! -name "${initrd##*/}" -mtime +0 -delete
}

# --- kernel: unpacked once, which costs a guest as much as a third of its start ----
vmlinux=$cache/initramfs/$release-$hash.vmlinux

# le BYTES OFFSET: of the boot image
le() { od -An -t "u$1" -j "$2" -N "$1" "$image" | tr -d ' '; }

# Header of the x86 boot protocol: setup_sects 0x1F1, payload 0x248, its length 0x24C;
# the last 4 bytes of the payload are its size unpacked.
build_vmlinux() {
	local at unpack

	at=$((($(le 1 497) + 1) * 512 + $(le 4 584)))
	case $(od -An -t x1 -j $at -N 4 "$image" | tr -d ' ') in
	fd377a58) unpack=xz ;;
	28b52ffd) unpack=zstd ;;
	*) return 1 ;;
	esac
	tail -c +$((at + 1)) "$image" | head -c $(($(le 4 588) - 4)) | $unpack -dc >"$vmlinux.$$" 2>/dev/null
	mv "$vmlinux.$$" "$vmlinux"
	find "$cache/initramfs" -name "$release-*.vmlinux*" ! -name "${vmlinux##*/}" -mtime +0 -delete
}

# Guests may start together: the first one builds, the others wait for it.
if [ ! -f "$initrd" ] || { [ "$arch" = amd64 ] && [ ! -f "$vmlinux" ]; }; then
	mkdir -p "$cache/initramfs"
	exec 9>"$cache/initramfs/.lock"
	flock 9
	if [ ! -f "$initrd" ]; then build_initrd; fi
	if [ "$arch" = amd64 ] && [ ! -f "$vmlinux" ]; then build_vmlinux || true; fi
	exec 9>&-
fi
touch -c "$initrd" "$vmlinux" 2>/dev/null || true	# they are in use
[ "$arch" != amd64 ] || [ ! -f "$vmlinux" ] || image=$vmlinux

base=("${qemu[@]}" -nodefaults -no-user-config -no-reboot -display none -kernel "$image")

# --- KVM only where it works: some hosts offer it and guests hang -------------
probe_kvm() {
	local key state=$cache/kvm-probe
	[ -r /dev/kvm ] && [ -w /dev/kvm ] && [ $console = ttyS0 ] || return 1
	key="$(cat /proc/sys/kernel/random/boot_id) $(qemu-system-x86_64 --version | head -n 1)"
	if [ "$(sed -n 1p "$state" 2>/dev/null)" != "$key" ]; then
		# The braces hide what the shell says when QEMU aborts.
		{ timeout -k 1 8 "${base[@]}" -initrd "$initrd" -accel kvm -cpu host -m 512 -serial stdio \
			-append "console=ttyS0 quiet panic=-1 ec_probe" </dev/null >"$tmp/probe" || true; } 2>/dev/null
		if grep -q 'ec-vm: probe ok' "$tmp/probe"; then
			printf '%s\nyes\n' "$key" >"$state.$$"
		else
			printf '%s\nno\n' "$key" >"$state.$$"
		fi
		mv "$state.$$" "$state"
	fi
	[ "$(sed -n 2p "$state")" = yes ]
}

if [ $probe = 1 ]; then
	case ${EC_ACCEL:-} in
	kvm|tcg) echo "$EC_ACCEL" ;;
	*) if probe_kvm; then echo kvm; else echo tcg; fi ;;
	esac
	exit 0
fi

if [ $icount = 1 ]; then
	smp=1
	accel=(-accel tcg -cpu $cpu -icount "shift=0,sleep=off")
	append=" tsc=reliable$append"
elif [ "${EC_ACCEL:-}" = kvm ] || { [ -z "${EC_ACCEL:-}" ] && probe_kvm; }; then
	accel=(-accel kvm -cpu host)
else
	accel=(-accel tcg -cpu $cpu)
	# All virtual CPUs of TCG share one counter, but the kernel does not know it
	# and may choose the HPET, where each look at the clock leaves the guest.
	append=" tsc=reliable$append"
fi

# KCSAN watches one of up to so many accesses of our modules
[[ $kernel != *-kcsan ]] || append=" kcsan.skip_watch=${EC_KCSAN_SKIP:-100}$append"

# --- what the guest is told ---------------------------------------------------
ctl=$tmp/ctl
mark="@ec-vm-end-$$-$RANDOM@"
mkdir "$ctl"
opts=()
n=0
for d in ${rw[@]+"${rw[@]}"}; do
	d=$(cd "$d" 2>/dev/null && pwd -P) || die "--rw: no directory ${rw[$n]}"
	printf '%s\n' "$d" >"$ctl/rw$n"
	opts+=(-virtfs "local,path=${d//,/,,},mount_tag=rw$n,security_model=none,multidevs=remap")
	n=$((n + 1))
done
rw_count=$n
n=0
for d in ${dirs[@]+"${dirs[@]}"}; do
	printf '%s\n' "$d" >"$ctl/ro$n"
	opts+=(-virtfs "local,path=${d//,/,,},mount_tag=ro$n,security_model=none,readonly=on,multidevs=remap")
	n=$((n + 1))
done
{
	printf 'release=%q\nmodules=%q\nmark=%s\ninit=%q\n' "$release" "$modules" "$mark" "$init"
	printf 'rw=%d\nro=%d\nlate=%d\n' "$rw_count" "$n" $((timeout < 60 ? 0 : timeout - 30))
} >"$ctl/env"
quote() { printf "'%s' " "${1//\'/\'\\\'\'}"; }
{
	printf 'cd '; quote "$([ -n "$init" ] && echo / || pwd -P)"; printf '|| exit 126\nexec '
	for a; do quote "$a"; done
	echo
} >"$ctl/cmd"

# nics NUMBER MODEL SLOT: number NUMBER at SLOT and its neighbour, joined by a wire.
# The virtual functions of an igb take the places behind it.
nics() {
	local i n place

	for i in 0 1; do
		n=$(($1 + i))
		place=addr=$(printf %x $(($3 + 4 * i)))
		if [ $iommu = 1 ] && [ "$2" != e1000 ]; then
			opts+=(-device "pcie-root-port,id=p$n,chassis=$((n + 1)),$place")
			place=bus=p$n
		fi
		opts+=(-netdev "hubport,id=h$n,hubid=$1"
			-device "$2,id=nic$n,$place,netdev=h$n,mac=52:54:00:ec:00:0$n")
	done
}
if [ $iommu = 1 ]; then
	base+=(-machine q35 -device "intel-iommu,intremap=off,caching-mode=on")
	append=" intel_iommu=on iommu.strict=1$append"
fi
[ -z "$nic" ] || nics 0 "$nic" 8
[ -z "$more" ] || nics 2 "$more" 16

if [ $monitor = 1 ]; then
	opts+=(-chardev "socket,id=monitor,path=$tmp/monitor,server=on,wait=off" -mon chardev=monitor
		-chardev "socket,id=port,path=$tmp/monitor,reconnect=1"
		-device virtserialport,chardev=port,name=monitor)
fi

# --- run ----------------------------------------------------------------------
# norandmaps: QEMU translates a program once, not once for each process
start=$(date +%s%N)
mkfifo "$tmp/out"

# machine OUTPUT: sets qemu_args
machine() {
	# shellcheck disable=SC2206
	qemu_args=("${base[@]}" "${accel[@]}" -smp "$smp" -m "$mem" -initrd "$initrd"
		-device virtio-serial -chardev "file,id=out,path=$1"
		-device virtserialport,chardev=out
		-virtfs "local,path=$ctl,mount_tag=ctl,security_model=none"
		-virtfs "local,path=$root,mount_tag=host,security_model=none,readonly=on,multidevs=remap"
		${opts[@]+"${opts[@]}"}
		-append "console=$console quiet panic=-1 log_buf_len=4M mitigations=off norandmaps audit=0 printk.devkmsg=on net.ifnames=0$append"
		$qemu_more)
}

# Half of what a short guest costs is its start. Until it mounts folders of the host it is the
# same each time: one with exact time is kept as it is then, and goes on from there.
parked=
if [ $icount = 1 ] && [ "$arch" = amd64 ] && [ $monitor = 0 ] && [ ${#rw[@]} = 0 ] &&
   [ -z "$qemu_more" ]; then
	append="$append ec_park"
	machine out
	parked=$cache/parked/$(printf '%s\n' "$(${qemu[0]} --version)" "${qemu_args[@]//"$tmp"/}" |
		sha256sum | cut -c1-16)
fi

park() {
	local i

	machine /dev/null
	# it is stopped then: nothing changes while it is written; a copy runs at once nevertheless
	qemu_args+=(-global migration.store-global-state=off)
	mkfifo "$tmp/monitor.in"
	"${qemu_args[@]}" -serial "file:$tmp/console" -monitor stdio <"$tmp/monitor.in" \
		>"$tmp/monitor.out" 2>&1 &
	qemu_pid=$!
	trap '' PIPE	# it may die at any moment
	exec 8>"$tmp/monitor.in"
	for ((i = 0; i < 1200; i++)); do
		kill -0 $qemu_pid 2>/dev/null || break
		if grep -q 'ec-vm: parked' "$tmp/console" 2>/dev/null; then
			printf 'stop\nmigrate "exec:cat >%s"\n' "$tmp/parked" >&8
			break
		fi
		sleep 0.1
	done
	for ((i = 0; i < 1200; i++)); do
		kill -0 $qemu_pid 2>/dev/null || break
		echo 'info migrate' >&8
		grep -qE 'Migration status: (completed|failed)' "$tmp/monitor.out" && break
		sleep 0.1
	done
	kill $qemu_pid 2>/dev/null
	wait $qemu_pid
	qemu_pid=
	exec 8>&-
	trap - PIPE
	grep -q 'Migration status: completed' "$tmp/monitor.out" || return 1
	mkdir -p "$cache/parked"
	cp "$tmp/parked" "$parked.$$" && mv "$parked.$$" "$parked"
	find "$cache/parked" ! -path "$parked" ! -name .lock -type f -mtime +0 -delete
}

if [ -n "$parked" ] && [ ! -f "$parked" ] && [ ! -f "$parked.no" ]; then
	mkdir -p "$cache/parked"
	exec 9>"$cache/parked/.lock"
	flock 9
	# a QEMU that cannot is not asked each time
	[ -f "$parked" ] || park || touch "$parked.no"
	exec 9>&-
fi
touch -c "$parked" 2>/dev/null || true	# it is in use

# where the CPUs of a guest that hangs are, three times
where() {
	python3 - "$tmp/hmp" <<-'END' || true
	import re, socket, sys, time
	s = socket.socket(socket.AF_UNIX)
	s.settimeout(10)
	s.connect(sys.argv[1])
	for _ in range(3):
	    text = b""
	    s.sendall(b"info registers -a\ninfo status\n")
	    while b"VM status" not in text:
	        text += s.recv(65536)
	    for line in re.findall(r"CPU#\d+|[ER]IP=.*|PC=.*|PSW=.*|VM status.*", text.decode("latin1")):
	        print("#  ", line.strip())
	    time.sleep(1)
	END
}

# watch PID BEGIN: ends the guest after the time it has, or when its command has not begun after
# BEGIN seconds
watch() {
	local pid=$1 end=$timeout begin=$2 tick

	[ -z "$init" ] || begin=$timeout
	mkfifo "$tmp/tick.$pid"
	exec {tick}<>"$tmp/tick.$pid"
	SECONDS=0
	while [ $SECONDS -lt "$end" ] && { [ -s "$ctl/started" ] || [ $SECONDS -lt "$begin" ]; }; do
		read -rt 1 -u "$tick" || true	# no process that would outlive this one
	done
	if [ -s "$ctl/started" ]; then
		echo "# run.sh: the guest hangs; the command began $(cat "$ctl/started") s after its kernel"
	else
		echo "# run.sh: the guest hangs, before the command began"
	fi
	where
	[ ! -s "$ctl/stuck" ] || sed 's/^/#   /' "$ctl/stuck"
	[ ! -s "$ctl/started" ] && [ $SECONDS -lt "$end" ] || : >"$tmp/late"
	kill -9 "$pid"
} >&2

# boot BEGIN: one start of the guest, as watch(); sets qemu_rc and sed_rc
boot() {
	local input=/dev/null

	machine "$tmp/out"
	if [ -n "$parked" ]; then
		# of the input of one that waits some may be lost
		input=$tmp/now
		date +@@@@%s >"$input"
	fi
	[ ! -f "$parked" ] || qemu_args+=(-incoming "exec:cat $(printf %q "$parked")")
	"${qemu_args[@]}" -serial stdio -monitor "unix:$tmp/hmp,server=on,wait=off" <"$input" \
		>"$tmp/out" 2>"$tmp/qemu.err" &
	qemu_pid=$!
	watch $qemu_pid "$1" &
	watch_pid=$!
	# The console adds a carriage return to each line of the kernel. The file tells
	# the guest that all it wrote has arrived; sed holds back what it writes to any
	# other file than stderr. (sed -u would read byte by byte.)
	{
		# When nobody reads our output any more, the command ends as in any pipe.
		stdbuf -oL sed -e '/sysrq: Resetting/d' -e 's/\r*$//' \
			-e "/$mark/{w /dev/stderr" -e "s/$mark//" -e '/^$/d' -e '}' <"$tmp/out" 2>"$ctl/drained" ||
			{ kill "$qemu_pid" 2>/dev/null; exit 1; }
	} &
	local sed_pid=$!
	qemu_rc=0
	{ wait $qemu_pid || qemu_rc=$?; } 2>/dev/null	# not that it was killed
	qemu_pid=
	kill $watch_pid 2>/dev/null || true
	wait $watch_pid 2>/dev/null || true
	watch_pid=
	sed_rc=0
	wait $sed_pid || sed_rc=$?
}

boot "${EC_BEGIN:-240}"
# Before the command nothing of ours runs in the guest: a death there is QEMU's or the
# kernel's, and rare. It is shown, and once pardoned.
if [ ! -s "$ctl/started" ] && [ ! -e "$tmp/late" ] && [ $sed_rc = 0 ]; then
	sed 's/^/# /' "$tmp/qemu.err" >&2
	rm -f "$parked"
	echo "# run.sh: the guest ended before its command began (QEMU: $qemu_rc); second start" >&2
	boot "$timeout"
fi
end=$(date +%s%N)

[ $verbose = 0 ] || [ ! -s "$ctl/started" ] ||
	echo "run.sh: ${accel[*]}: command started $(cat "$ctl/started") s after the kernel," \
		"all took $(((end - start) / 1000000)) ms" >&2

log=$tmp/dmesg
if [ -f "$ctl/kmsg" ]; then
	# Records are "prio,seq,usec,flags;text", continuation lines start with a blank.
	awk '/^ / { next }
	     { i = index($0, ";"); split($0, f, ","); printf "[%12.6f] %s\n", f[3] / 1e6, substr($0, i + 1) }' \
		"$ctl/kmsg" >"$log"
	[ -z "$dmesg" ] || cp "$log" "$dmesg"
fi

if [ ! -s "$ctl/rc" ]; then
	if [ -e "$tmp/late" ]; then
		echo "run.sh: TIMEOUT: not finished after $timeout s (--timeout)" >&2
		exit 124
	fi
	[ $sed_rc = 0 ] || exit 141	# our output was closed
	cat "$tmp/qemu.err" >&2
	die "the guest ended without a result (panic, or it could not start);" \
		"its last messages are above, --append loglevel=7 shows more"
fi
rc=$(cat "$ctl/rc")

if [ $allow_oops = 0 ]; then
	# Only what came after the command's start; the firmware and the CPU model
	# are not under test.
	faults=$(awk 'on; /ec-vm: the command starts/ { on = 1 }' "$log" |
		grep -E 'BUG:|WARNING:|Oops|general protection|INFO: task|scheduling while atomic|possible recursive locking|refcount_t:|KASAN|UBSAN:|kernel BUG at|invalid opcode:|detected stall|self-detected stall|unregister_netdevice: waiting|ODEBUG:|DMA-API:' || true)
	if [ -n "$faults" ]; then
		echo "run.sh: KERNEL FAULT (the command's status was $rc), see --dmesg FILE for all:" >&2
		printf '%s\n' "$faults" >&2
		# each report of KCSAN, KASAN and lockdep once, in full
		awk '/BUG: K[CA]SAN: |WARNING: (possible|inconsistent)|BUG: Invalid wait/ {
				title = $0; sub(/^\[[^]]*\] /, "", title)
				p = !seen[title]++; end = /K[CA]SAN/ ? "====" : "</TASK>"
			}
			p { print "# " $0 }
			$0 ~ end { p = 0 }' "$log" >&2
		exit 70
	fi
fi
exit "$rc"
