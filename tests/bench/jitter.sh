#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Runs the cycle on this machine under load and writes a report: histogram, worst case,
# kernel, network card, settings, verdict. Loads the modules and unloads them at the end.
# In a VM with exact time: jitter-vm.sh.
#
# EC_BUILD: folder with modules, lib, tool and bench, built before; else they are built.

set -u
cd "$(dirname "$0")/../.." || exit 2
me=jitter.sh
time=60 period=1000 load=none command='' device=sim by=application cpu='' out='' limit=100

usage() {
	cat <<-END
	usage: jitter.sh [options]		as root
	  --time S       seconds to measure, default 60; 3600 and more for a statement
	  --period US    time between cycles, default 1000
	  --load LOAD    none, cpu, memory, io, net, or: command 'CMD'; default none
	  --device DEV   sim (the simulated segment), or the card of the slaves: interface or
	                 MAC address (generic device), PCI address (native device); default sim
	  --by WHO       who runs the cycle: application, thread (of the kernel) or interrupt
	                 (of the kernel's timer; native device or sim); default application
	  --cpu N        CPU of the cycle, default any
	  --limit US     longest deviation of a send that passes, default 100
	  --out FILE     report, default jitter-DATE.txt
	Exit code 0: passed, 1: failed or not measured, 2: wrong arguments.
	END
}

refuse() { echo "$me: $*" >&2; exit 2; }
stop() { echo "$me: $*" >&2; exit 1; }

# number NAME VALUE LEAST MOST
number() {
	[[ $2 =~ ^(0|[1-9][0-9]{0,8})$ ]] && [ "$2" -ge "$3" ] && [ "$2" -le "$4" ] ||
		refuse "$1 '$2': a number from $3 to $4 is needed"
}

while [ $# -gt 0 ]; do
	case $1 in
	--time|--period|--load|--device|--by|--cpu|--out|--limit)
		[ $# -gt 1 ] && [ -n "$2" ] || refuse "$1 needs an argument"
		declare "${1#--}=$2"
		if [ "$1 $2" = "--load command" ]; then
			[ -n "${3:-}" ] || refuse "--load command needs a command"
			command=$3
			shift
		fi
		shift 2 ;;
	-h|--help) usage; exit 0 ;;
	*) refuse "unknown option '$1'; see --help" ;;
	esac
done
number --time "$time" 1 1000000
number --period "$period" 50 1000000
number --limit "$limit" 0 1000000
case $load in
none|cpu|memory|io|command) ;;
net) command -v python3 >/dev/null || refuse "--load net needs python3" ;;
*) refuse "--load '$load': none, cpu, memory, io, net or command 'CMD' is needed" ;;
esac
case $by in
application) how=() ;;
thread) how=(--kernel wait) ;;
interrupt) how=(--kernel wait --interrupt) ;;
*) refuse "--by '$by': application, thread or interrupt is needed" ;;
esac
pci='^([0-9a-f]{4}:)?[0-9a-f]{2}:[0-9a-f]{2}\.[0-7]$'
mac='^([0-9a-f]{2}:){5}[0-9a-f]{2}$'
device_path=/sys/class/net/$device
if [[ ${device,,} =~ $pci ]]; then
	kind=native
	[[ $device == ????:??:* ]] || device=0000:$device
	device_path=/sys/bus/pci/devices/${device,,}
	[ -e "$device_path" ] || refuse "--device: no PCI device $device"
elif [ "$device" = sim ]; then
	kind=sim
elif [[ ${device,,} =~ $mac ]]; then
	kind=generic
	grep -qix "$device" /sys/class/net/*/address || refuse "--device: no interface has $device"
else
	kind=generic
	[[ $device != */* ]] && [ -e "$device_path" ] || refuse "--device: no interface $device"
fi
if [ -n "$cpu" ]; then
	number --cpu "$cpu" 0 4095
	taskset -c "$cpu" true 2>/dev/null || refuse "--cpu $cpu: no such CPU is online"
fi
cycles=$((time * 1000000 / period))
[ "$cycles" -ge 1 ] && [ "$cycles" -le 20000000 ] ||
	refuse "--time $time with --period $period: $cycles cycles, 1 to 20000000 are possible"
out=${out:-jitter-$(date +%Y%m%d-%H%M%S).txt}
[ "$(id -u)" = 0 ] || stop "run it as root: it loads kernel modules"
[ ! -e /sys/module/ec_master ] ||
	stop "ec_master is loaded; stop its application and unload it first"
: >"$out" || stop "cannot write $out"

if [ -z "${EC_BUILD:-}" ]; then
	EC_BUILD=$PWD/build/jitter-$(uname -r)
	make -s modules KDIR="/lib/modules/$(uname -r)/build" MODDIR="$EC_BUILD/modules" >&2 &&
	make -s -C lib O="$EC_BUILD/lib" all >&2 && make -s -C tool O="$EC_BUILD/tool" >&2 &&
	make -s -C tests/bench/cycle O="$EC_BUILD/bench" LIB="$EC_BUILD/lib" >&2 ||
		stop "cannot build; Documentation/install.rst lists what is needed"
fi
tool=$EC_BUILD/tool/ethercat
tmp=$(mktemp -d) || exit 1
loads=() loaded=() bound='' down=''

undo() {
	local p m

	for p in ${loads[@]+"${loads[@]}"}; do
		kill -KILL -- "-$p" 2>/dev/null
		wait "$p" 2>/dev/null
	done
	# the master still has it
	[ -z "$bound" ] || "$tool" device unbind --force "$bound" >&2
	for m in ${loaded[@]+"${loaded[@]}"}; do
		rmmod "$m" || echo "$me: cannot unload $m" >&2
	done
	# ec_generic has set it up
	[ -z "$down" ] || ip link set "$down" down
	rm -rf "$tmp"
}
trap undo EXIT
trap 'exit 1' INT TERM HUP

# insert FILE [PARAMETERS]: the last one is unloaded first
insert() {
	insmod "$EC_BUILD/modules/$1" "${@:2}" || stop "cannot load $1"
	set -- "${1##*/}"
	loaded=("${1%.ko}" ${loaded[@]+"${loaded[@]}"})
}

# is_down DEVICE: prints the name of an interface that is down
is_down() {
	local d

	for d in /sys/class/net/*; do
		[ "${d##*/}" = "$1" ] || grep -qix "$1" "$d/address" || continue
		(($(<"$d/flags") & 1)) || { echo "${d##*/}"; return; }
	done
}

load_modules() {
	case $kind in
	sim)	insert master/ec_master.ko main_devices=sim0
		insert devices/sim/ec_sim.ko segment="$PWD/tests/segments/drive10.seg" ;;
	generic) down=$(is_down "$device")
		insert master/ec_master.ko main_devices="$device"
		insert devices/ec_generic.ko ;;
	native)	insert master/ec_master.ko main_devices="$device"
		insert devices/intel/ec_intel.ko
		"$tool" device bind "$device" >&2 || stop "$device cannot have the native device"
		bound=$device ;;
	esac
	for _ in {1..300}; do
		[ -z "$("$tool" slaves 2>/dev/null)" ] || return 0
		sleep 0.1
	done
	stop "no slave at $device after 30 s"
}

# background SCRIPT: a process group of its own, to be killed as a whole
background() {
	setsid bash -c "$1" jitter-load "$tmp" >/dev/null 2>&1 &
	loads+=($!)
}

begin_load() {
	local i

	for ((i = 0; i < $(nproc); i++)); do
		case $load in
		cpu)	background 'while :; do :; done' ;;
		memory)	background 'exec dd if=/dev/zero of=/dev/null bs=64M' ;;
		io)	background "while :; do dd if=/dev/zero of=\$0$i bs=1M count=16 conv=fsync; done" ;;
		esac
	done
	case $load in
	net)	background 'exec python3 -c "
import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind((\"127.0.0.1\", 0))
while True:
    s.sendto(bytes(1400), s.getsockname())
    s.recv(2000)"' ;;
	command) background "$command" ;;
	esac
}

# figure NAME: of cycle-bench; value NAME: of ethercat cycle
figure() { awk -v n="$1" '$1 == n { print $2 }' "$tmp/bench"; }
value() { sed -n "s/^ *\"$1\": \([0-9]*\),\{0,1\}$/\1/p" "$tmp/cycle" | head -n 1; }

# failed cases and remarks, one a line
judge() {
	local sends worst late lost overruns
	sends=$(value sends) worst=$(value late_max_ns) overruns=$(value overruns)
	late=$(figure late_ns_max) lost=$(figure lost)

	[ "$rc" = 0 ] || echo "failed: the cycle ended with exit code $rc"
	[ -n "$sends" ] && [ -n "$worst" ] && [ -n "$late" ] && [ -n "$lost" ] ||
		{ echo "failed: no complete figures"; return; }
	[ "$sends" -ge "$cycles" ] || echo "failed: $sends sends, $cycles cycles"
	[ "$overruns" = 0 ] || echo "failed: $overruns skipped cycle(s)"
	[ "$lost" = 0 ] || echo "failed: $lost lost frame(s)"
	[ "$late" -le "$worst" ] || worst=$late
	echo "worst case: $worst ns, limit $((limit * 1000)) ns"
	[ "$by" != interrupt ] || [ "$(figure interrupted)" = 1 ] ||
		echo "failed: the cycle has run in its thread; the kernel log has the reason"
	[ "$worst" -le $((limit * 1000)) ] || echo "failed: the worst case exceeds the limit"
	[ "$time" -ge 3600 ] ||
		echo "remark: $time s are too short for a statement; measure 3600 s or longer"
	[ "$load" != none ] || echo "remark: without load"
	[ $kind != sim ] || echo "remark: simulated segment, no network card was measured"
	! grep -qw hypervisor /proc/cpuinfo || echo "remark: in a virtual machine"
}

load_modules
begin_load
"$tool" rtcheck >"$tmp/rtcheck" 2>&1
"$tool" devices >"$tmp/devices" 2>&1
pin=()
[ -z "$cpu" ] || pin=(taskset -c "$cpu")
[ -z "$cpu" ] || [ "$by" = application ] || how+=(--cpu "$cpu")
${pin[@]+"${pin[@]}"} "$EC_BUILD/bench/cycle-bench" --cycles "$cycles" --period-us "$period" \
	${how[@]+"${how[@]}"} >"$tmp/bench" 2>"$tmp/errors"
rc=$?
"$tool" cycle --json >"$tmp/cycle"
judge >"$tmp/verdict"
verdict=passed
! grep -q '^failed' "$tmp/verdict" || verdict=failed
{
	echo "Verdict: $verdict"
	sed 's/^/  /' "$tmp/verdict"
	printf '\nRun: %s s, period %s us, load %s, device %s, CPU %s, by %s\n' "$time" "$period" \
		"$load${command:+ '$command'}" "$device ($kind)" "${cpu:-any}" "$by"
	echo "Kernel: $(uname -srvm)"
	grep -m 1 'model name' /proc/cpuinfo
	printf '\nHistogram (since activation)\n'
	"$tool" cycle
	printf '\nNetwork cards\n'
	cat "$tmp/devices"
	printf '\nSettings (ethercat rtcheck)\n'
	cat "$tmp/rtcheck"
	printf '\nFigures (wake-up: late, ns)\n'
	cat "$tmp/bench" "$tmp/errors"
} >"$out"
sed '/^$/q' "$out"
echo "report: $out"
[ $verdict = passed ]
