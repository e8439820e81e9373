#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Builds everything, boots Debian's PREEMPT_RT kernel and runs the bats files
# of this folder in it, one boot each.
#
# The guest's time is exact (--icount), so that a busy host fails no test and as many
# run at a time as there are CPUs, those with the longest time limit first. A file with a line
# "# vm: OPTIONS" names its own options of tests/vm/run.sh instead; of those without --icount one
# runs at a time, and the others give way to it.
#
# EC_KERNEL: of tests/vm/kernels.sh, 6.1-rt if it is not set. With 6.1-kcsan each guest has
# two CPUs that run at a time and real time, and a data race in a module fails the file. With
# 6.1-kasan a wrong access to memory and wrong use of locks, timers or DMA fails the file. Cases
# of tests/kcsan/exact-time.list and tests/kasan/exact-time.list are shown but do not count there.
# EC_NIC=e1000|e1000e|igb: the segment of helpers.bash is at a network card of that model with
# its native driver, not at the virtual device
# EC_IOMMU=1: this card is behind an IOMMU
# EC_BINDS: how often native.bats binds the card, 40 if it is not set
# EC_CYCLES: of the files in long, a million if it is not set; EC_SEED: of the times of flaps.bats,
# of the faults of why.bats; EC_FAULTS: kinds of these
# EC_PROGRAMS=i386: programs of 32 bits, on a kernel of 64
# EC_PLANTED=no: the detectors themselves are not tried
# EC_PLACES: of tests/vm/places.sh
#
# usage: run.sh [FILE.bats...]

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
modules=$PWD/build/system-$kernel/modules
export EC_BUILD=$PWD/build/system-$kernel${EC_PROGRAMS:+-$EC_PROGRAMS}
passed=0 failed=0
mem=1024
[[ $kernel != *-kasan ]] || mem=2048	# freed memory is kept back
# Time of an --icount guest leaps while it waits for the host: for each file that is
# opened there, also a cached one. What the tests load and run becomes the guest's own
# before they begin; to change a time of a file copies it. Programs also run as nobody, who
# could not pass through the home of root.
preload='xargs -d "\n" touch -c -a <"$2"
	for d in "$EC_BUILD" "$PWD"; do
		while [ "$d" ]; do chmod o+rx "$d"; d=${d%/*}; done
	done
	LANG=C bats --tap "$1"	# its patterns take twice as long in UTF-8
	rc=$?
	kcsan=/sys/kernel/debug/kcsan
	[ ! -e $kcsan ] || sed -n "s/^setup_watchpoints: /# KCSAN: accesses watched: /p" $kcsan
	# after a report, or when a table of it is full, lockdep finds nothing any more
	! grep -s "debug_locks: *0$" /proc/lockdep_stats ||
		{ echo "not ok - lockdep is off"; rc=1; }
	exit $rc'

tests/vm/kernels.sh fetch "$kernel" >&2 || exit 1
# as tests/check-kernels.sh, else each would build what the other has built
warn="W=1e KCFLAGS=-include$PWD/tests/build/asserts.h"
case $kernel in
6.1-rt)	warn= ;;
*-kcsan) warn="W=1e KCFLAGS=-include$PWD/tests/kcsan/mem.h" ;;
esac
read -ra cross < <(tests/vm/kernels.sh cross "$kernel")

# compiler NAME: for all programs
compiler() { export CC=$1gcc CXX=$1g++ AR=$1ar; }
case ${EC_PROGRAMS:-} in
'')	[ "${#cross[@]}" = 0 ] || compiler "${cross[1]#*=}" ;;
i386)	compiler i686-linux-gnu-
	export LDFLAGS=-static	# there is no loader for them
	mkdir -p "$EC_BUILD"
	ln -sfn "$modules" "$EC_BUILD/modules"
	ln -sfn "${modules%/*}/mini" "$EC_BUILD/mini" ;;
*)	echo "run.sh: EC_PROGRAMS=$EC_PROGRAMS: only i386" >&2
	exit 1 ;;
esac

# modules and programs
build() {
	local kdir helper folder

	kdir=$(tests/vm/kernels.sh kdir "$kernel")
	# shellcheck disable=SC2086
	make -s -j2 mini ${cross[@]+"${cross[@]}"} $warn KDIR="$kdir" MODDIR="$modules" \
		MINIDIR="${modules%/*}/mini" &&
	for helper in suspend load; do
		# ec_fail knows x86 only
		[ $helper = suspend ] || [ "${#cross[@]}" = 0 ] || continue
		folder=${modules%/*}/mini/$helper
		mkdir -p "$folder" && cp -u tests/system/$helper/* "$folder" &&
		make -s -C "$kdir" ${cross[@]+"${cross[@]}"} M="$folder" \
			CONFIG_DEBUG_INFO_BTF_MODULES= CONFIG_DEBUG_INFO= modules || return
	done &&
	env -u LDFLAGS make -s -C lib O="$EC_BUILD/lib" all &&
	make -s -C tool O="$EC_BUILD/tool" &&
	make -s -C tool/sim O="$EC_BUILD/tool" &&
	make -s -C tests/bench/cycle O="$EC_BUILD/bench" LIB="$EC_BUILD/lib" &&
	make -s -C tests/apps O="$EC_BUILD/apps" LIB="$EC_BUILD/lib" all &&
	make -s -C examples O="$EC_BUILD/examples" LIB="$EC_BUILD/lib" BUS="$EC_BUILD/tool" all
}

# a foreign master; its programs are those of this machine
pysoem=
! grep -qs EC_PYSOEM "${@:-tests/system/device_use.bats}" || [ "${#cross[@]}" != 0 ] ||
	pysoem=$(. tests/foreign/wire.sh && pysoem >&2 && echo "$python") || exit 1

inexact=
[[ $kernel != *-k[ca]san ]] || inexact=tests/${kernel##*-}/exact-time.list
logs=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$logs"' EXIT
places "$logs/places" "$mem"
# a build beside guests takes a place as one of them
one locked "$kernel" build >&2 || exit 1

# what tests start, with the libraries of all that
needed() {
	local p

	for p in bash sh env cat ls rm mkdir cp date seq sleep timeout wc head tail od sort diff cut tr \
		grep sed awk xargs dmesg insmod rmmod modprobe lsmod kmod ps pgrep killall setpriv ip \
		tcpdump gojq python3 xxd tee chrt prlimit depmod udevadm; do
		p=$(PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin command -v "$p") &&
			readlink -f "$p"
	done >"$logs/files"
	find /etc/ld.so.cache /usr/lib/locale/C.* /usr/lib/*/gconv/gconv-modules.cache -type f \
		>>"$logs/files" 2>/dev/null
	find -L "$EC_BUILD"/{modules,lib,tool,apps,examples,bench,mini} -type f \
		\( -perm -100 -o -name '*.ko' -o -name '*.so*' \) >>"$logs/files"
	xargs -d '\n' ldd <"$logs/files" 2>/dev/null | grep -o '/[^ ):]*' |
		xargs -d '\n' readlink -f >"$logs/libraries"
	cat "$logs/libraries" >>"$logs/files"
	sort -u -o "$logs/files" "$logs/files"
}
needed

# vm_options FILE
vm_options() {
	local o

	o=$(sed -n 's/^# vm: *//p' "$1" | grep . || echo --icount)${EC_NIC:+ --nic $EC_NIC}${EC_IOMMU:+ --iommu}
	case $kernel in
	*-kcsan) echo "${o//--icount/} --smp 2 --timeout 1800" ;;
	*-kasan) echo "$o --mem $mem --timeout 3600" ;;
	*)	echo "$o" ;;
	esac
}

# run FILE: boots, writes what it prints and the status
run() {
	local f=$1 options TIMEFORMAT='%R s, %U s of CPU'

	read -ra options < <(vm_options "$f")
	{ time tests/vm/run.sh --kernel "$kernel" --timeout 600 "${options[@]}" -- \
		env EC_BUILD="$EC_BUILD" EC_NIC="${EC_NIC:-}" EC_BINDS="${EC_BINDS:-}" \
		EC_CYCLES="${EC_CYCLES:-}" EC_SEED="${EC_SEED:-}" EC_FAULTS="${EC_FAULTS:-}" \
		EC_WARN="$warn" EC_PYSOEM="$pysoem" \
		sh -c "$preload" sh "$f" "$logs/files" >"$logs/${f##*/}" 2>&1
	  echo "$?" >"$logs/${f##*/}.end"; } 2>"$logs/${f##*/}.time"
}

# pardon FILE: failed cases that need exact time become comments
pardon() {
	local file name

	while IFS='|' read -r file name _; do
		[ "$file" = "${1##*/}" ] || continue
		sed -i -E "s/^not ok (([0-9]+|-) $name)/# not counted: \\1/" "$out"
	done < <(grep -v '^#' "$inexact")
	rc=$(awk -v rc="$rc" '/^not ok/ { bad = 1 } END { print rc == 1 && !bad ? 0 : rc }' "$out")
}

# report FILE: its results, and counts them
report() {
	local f=$1 out=$logs/${1##*/} rc p n

	read -r rc <"$out.end"
	echo "# $f"
	# cases of a C program, see cases() of helpers.bash; a program's own "ok" that a failed case
	# shows is none
	sed -i -E 's/^# (ok|not ok) ([0-9]+|-) /\1 \2 /' "$out"
	[ -z "$inexact" ] || pardon "$f"
	grep -E '^(ok|not ok|#)' "$out"
	p=$(grep -c '^ok' "$out")
	n=$(grep -c '^not ok' "$out")
	# an oops, a data race, a hang, a crash of the guest
	if [ "$rc" -ge 70 ] || { [ "$rc" != 0 ] && [ "$n" = 0 ]; } ||
	   ! grep -qE '^(ok|# not counted:) ' "$out"; then
		# behind it, where tests/check.sh looks for the cause
		echo "not ok $f ended with $rc"
		tail -n 40 "$out" | sed 's/^\(# \)\?/# /'
		n=$((n + 1))
	fi
	passed=$((passed + p)) failed=$((failed + n))
	echo "# $f: $(tail -n 1 "$out.time")"
}

# planted FOLDER MODULE ARGUMENT PATTERN TEXT: the module of tests/FOLDER, loaded with ARGUMENT,
# fails a guest with a report that matches PATTERN; with an empty one the guest has no report
planted() {
	local rc=0 out=$logs/planted

	real_time tests/vm/run.sh --kernel "$kernel" --smp 2 --mem "$mem" -- \
		sh -c 'insmod "$1" "$2" && sleep 5 && rmmod "$1"' \
		sh "$EC_BUILD/$1/$2.ko" "$3" >"$out" 2>&1 </dev/null || rc=$?
	if [ -z "$4" ] && [ $rc = 0 ]; then
		echo "ok $5"
	elif [ "$4" ] && [ $rc = 70 ] && grep -qE "$4" "$out"; then
		echo "ok $5"
	else
		echo "not ok $5: $3 ended with $rc"
		tail -n 40 "$out"
	fi
}

# detector FOLDER MODULE: errors planted in a module fail a guest, each in a guest of its own
# since lockdep reports once; expects lines ARGUMENT:PATTERN:TEXT
detector() {
	local kdir what pattern text

	kdir=$(tests/vm/kernels.sh kdir "$kernel")
	mkdir -p "$EC_BUILD/$1"
	cp -u "tests/$1"/{Kbuild,"$2.c"} "$EC_BUILD/$1/"
	make -s -C "$kdir" M="$EC_BUILD/$1" modules >"$logs/planted" 2>&1 ||
		{ echo "not ok $2 does not build"; cat "$logs/planted"; return 1; }
	echo "# detectors of $kernel"
	while IFS=: read -r what pattern text; do planted "$1" "$2" "$what" "$pattern" "$text"; done
}

case ${EC_PLANTED:+none}$kernel in
none*) ;;
*-kcsan) detector kcsan ec_race <<-'END' ;;
	marked=0:KCSAN. data-race in ec_race_.* .ec_race.:a planted race is reported
	marked=1::the same accesses without a race are not
	END
*-kasan) detector kasan ec_wrong <<-'END' ;;
	what=freed:KASAN. .*use-after-free in ec_wrong_freed:a read of freed memory is reported
	what=bounds:KASAN. .*out-of-bounds in ec_wrong_bounds:a read behind the end is reported
	what=nesting:BUG. Invalid wait context:a spinlock inside a raw one is reported
	what=order:possible circular locking:locks in two orders are reported
	what=sleep:BUG. sleeping function:sleep with a spinlock is reported
	what=timer:ODEBUG. free active:a timer freed while it runs is reported
	what=dma:DMA-API. .*different size:wrong use of DMA is reported
	what=none::a module without an error is not reported
	END
esac >"$logs/detector" 2>&1
if [ -s "$logs/detector" ]; then
	cat "$logs/detector"
	passed=$(grep -c '^ok' "$logs/detector") failed=$(grep -c '^not ok' "$logs/detector")
fi

side=() alone=()
for f in ${*:-tests/system/*.bats}; do
	if [ "$inexact" ] && grep -q "^${f##*/}|not run|" "$inexact"; then
		echo "# $f: not run: $(sed -n "s/^${f##*/}|not run|//p" "$inexact")"
		continue
	fi
	if [[ $(vm_options "$f") == *--icount* ]]; then side+=("$f"); else alone+=("$f"); fi
done

# the longest time limit first: a long file that is the last keeps only one CPU busy
by_limit() {
	local f limit

	for f; do
		limit=$(vm_options "$f" | grep -oP -- '--timeout \K[0-9]+' | tail -n 1)
		echo "${limit:-600} $f"
	done | sort -s -k 1,1nr | cut -d' ' -f2-
}

for f in ${alone[@]+"${alone[@]}"}; do real_time run "$f"; done &
for f in $(by_limit ${side[@]+"${side[@]}"}); do
	while [ "$(jobs -rp | wc -l)" -ge ${#places[@]} ]; do wait -n; done
	one run "$f" &
done
wait
for f in ${side[@]+"${side[@]}"} ${alone[@]+"${alone[@]}"}; do report "$f"; done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
