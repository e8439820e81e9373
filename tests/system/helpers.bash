# SPDX-License-Identifier: GPL-2.0-only
# For the bats files that run in the VM. EC_BUILD: where things were built.

ethercat() { "$EC_BUILD/tool/ethercat" "$@"; }

# Bats 1.8 calls this before each command, to name the line of a failure. Its own takes a million
# instructions, most of the time of many tests; a failure inside a helper names the line
# that called it. A helper must not exit: the line would be that of the command before it.
if [[ $(declare -f bats_debug_trap) == *BATS_DEBUG_LASTLAST_STACK_TRACE* ]]; then
tracing=$(shopt -s extdebug; declare -F bats_error_trap) tracing=${tracing#* * }
bats_debug_trap() {
	case $1 in "$BATS_ROOT"/*|*/helpers.bash) return 0 ;; esac
	BATS_DEBUG_LASTLAST_STACK_TRACE=("${BATS_DEBUG_LAST_STACK_TRACE[@]}")
	BATS_DEBUG_LAST_LINENO=("${BASH_LINENO[@]}")
	# bats compares it with what its other functions find there
	BATS_DEBUG_LAST_SOURCE=("$tracing" "${BASH_SOURCE[@]:1}")
	bats_capture_stack_trace
}
fi

# PCI address of a network interface
pci() { basename "$(readlink -f "/sys/class/net/$1/device")"; }

# driver PCI-ADDRESS NAME: gives a PCI function to a driver; the interface goes or comes
driver() {
	local d=/sys/bus/pci/devices/$1

	[ ! -e "$d/driver" ] || echo "$1" >"$d/driver/unbind"
	echo "$2" >"$d/driver_override"
	echo "$1" >/sys/bus/pci/drivers_probe
}

# load_master [PARAMETER...]: with the virtual device; EC_NIC=MODEL: with a network card and its native driver
load_master() {
	local device=sim0

	[ -z "${EC_NIC:-}" ] || device=52:54:00:ec:00:00
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=$device "$@"
}

# load_segment SEGMENT: slaves at the device of load_master. They are at the other end of the
# cable before the master sends, so that no frame is lost.
load_segment() {
	[ -z "${EC_NIC:-}" ] || [ -e /sys/class/net/eth1 ] || modprobe "$EC_NIC"
	insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment="$1" ${EC_NIC:+netdev=eth1}
	[ -n "${EC_NIC:-}" ] || return 0
	wait_for 60 has_carrier eth1
	grep -q '^ec_intel ' /proc/modules || insmod "$EC_BUILD/modules/devices/intel/ec_intel.ko"
	[ ! -e /sys/class/net/eth0 ] || driver "$(pci eth0)" ec_intel
}

has_carrier() { [ "$(cat "/sys/class/net/$1/carrier")" = 1 ]; }

# driver of the master's device
device_module=ec_sim
[ -z "${EC_NIC:-}" ] || device_module=ec_intel

# unplug: the device vanishes and the slaves lose power; load_segment brings both back
unplug() {
	rmmod ec_sim
	[ -z "${EC_NIC:-}" ] || rmmod ec_intel
}

# start SEGMENT [SLAVES]: load the modules and wait for the scan
start() {
	load_master
	load_segment "$1"
	wait_for 120 all_slaves_are PREOP "$2"
}

stop() {
	rmmod ec_sim ec_generic ec_intel 2>/dev/null || true
	rmmod ec_master 2>/dev/null || true
}

# what a wait that timed out may have waited for
standstill() {
	local p

	for p in $(pgrep '^EtherCAT'); do
		echo "$(</proc/"$p"/comm):$(sed -n 's/^State:\t/ /p' /proc/"$p"/status)"
		cat /proc/"$p"/stack
	done
	ethercat master | sed -nE '/^ *(Link|Slaves|Phase|Active)/p'
	for p in /sys/class/net/*; do
		echo "${p##*/}: $(cat "$p/operstate" "$p/carrier" "$p"/statistics/[rt]x_packets | xargs)"
	done
	grep eth /proc/interrupts
	dmesg | tail -n 12
} 2>/dev/null

# nap SECONDS: sleep without a process
exec {nap_fd}<> <(:)
nap() {
	if read -rt "$1" -u "$nap_fd"; then return; fi	# no process writes to this pipe
}

# wait_for SECONDS COMMAND...: for so long and so often, since exact time may leap a minute while
# the host is busy, and what is waited for has done nothing
wait_for() {
	local end=$((SECONDS + $1)) times=$((2 * $1))

	shift
	until "$@"; do
		[ $SECONDS -lt $end ] || [ $times -gt 0 ] ||
			{ echo "timed out: $*"; standstill; return 1; }
		times=$((times - 1))
		nap 0.1
	done
}

# all_slaves_are STATE COUNT
all_slaves_are() {
	[ "$(ethercat slaves 2>/dev/null | awk -v s="$1" '$3 == s { n++ } END { print n + 0 }')" = "$2" ]
}

# what "ethercat master" says behind NAME
says() { ethercat master | sed -n "/^ *$1: */{s///p;q}"; }

# Frames lost since the device came. A frame that is sent before the slaves at the
# other end of the wire are there counts too: compare with what it was before.
lost_frames() { says 'Lost frames'; }

# cases COMMAND...: its TAP lines, of which there is at least one, become lines of this
# run (run.sh counts what begins with "# ok" and "# not ok"), each before its comments
cases() {
	local rc=0 out=$BATS_TEST_TMPDIR/cases

	"$@" >"$out" 2>&1 3>&- || rc=$?
	awk '/^#/ { said = said $0 "\n"; next } { printf "# %s\n%s", $0, said; said = "" }
		END { printf "%s", said }' "$out" >&3
	[ "$rc" = 0 ] || { echo "ended with $rc: $*"; tail -n 3 "$out"; return 1; }
	grep -q '^ok' "$out"
}

# json FILTER COMMAND...: the JSON of a command fulfils a filter of gojq
json() {
	local filter=$1

	shift
	ethercat "$@" --json >"$BATS_TEST_TMPDIR/json" || return
	gojq -e "$filter" "$BATS_TEST_TMPDIR/json" >/dev/null || {
		echo "not so: $filter"
		cat "$BATS_TEST_TMPDIR/json"
		return 1
	}
}

# refused PATTERN COMMAND...: exit code 1, nothing on stdout, one line of error
refused() {
	local pattern=$1 out rc=0

	shift
	out=$(ethercat "$@" 2>"$BATS_TEST_TMPDIR/err") || rc=$?
	[ "$rc" = 1 ] && [ -z "$out" ] && [ "$(grep -vc '^Try ' "$BATS_TEST_TMPDIR/err")" = 1 ] &&
		grep -qE -- "$pattern" "$BATS_TEST_TMPDIR/err" || {
		echo "exit code $rc, stdout '$out', stderr:"
		cat "$BATS_TEST_TMPDIR/err"
		return 1
	}
}

# back_in_ms FILE CUT HEAL LIMIT SLAVES: what was cut off for a second is in OP again at most LIMIT
# ms after the cable was whole, as the log says; in exact time (--icount) and with all SLAVES in OP.
# FILE takes the commands of the simulator.
back_in_ms() {
	local healed back ms

	echo "$2" >"$1"
	sleep 1
	healed=$(date +%s%N)
	echo "$3" >"$1"
	wait_for 60 all_slaves_are OP "$5"
	back=$(ethercat log --json |
		gojq '[.masters[0].events[] | select(.event == "slave_back")] | last | .time_ns')
	ms=$(((back - healed) / 1000000))
	echo "# back in OP $ms ms after the cable was whole" >&3
	[ $ms -gt 0 ]
	[ $ms -le "$4" ]
}
