#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# A computer with the right settings, in trees of files that look like sysfs and procfs; each case
# makes one of them wrong.

load common

# put FILE TEXT
put() {
	mkdir -p "${1%/*}"
	echo "$2" >"$1"
}

# CPU 3 of 4 is reserved; Master0 of fake_dev.c has eth0
setup() {
	local c s p

	export FAKE_SYS=$BATS_TEST_TMPDIR/sys FAKE_PROC=$BATS_TEST_TMPDIR/proc FAKE_ETHTOOL="0 0 0"
	s=$FAKE_SYS/devices/system p=$FAKE_PROC
	put "$p/sys/kernel/osrelease" 6.1.0-rt
	put "$FAKE_SYS/kernel/realtime" 1
	put "$s/clocksource/clocksource0/current_clocksource" tsc
	put "$p/sys/kernel/sched_rt_runtime_us" -1
	put "$p/sys/kernel/timer_migration" 0
	put "$p/sys/kernel/nmi_watchdog" 0
	put "$FAKE_SYS/kernel/mm/transparent_hugepage/enabled" "always [madvise] never"
	put "$p/swaps" "Filename Type Size Used Priority"
	put "$s/cpu/online" 0-3
	put "$s/cpu/isolated" 3
	put "$s/cpu/nohz_full" 2-3
	for c in 0 3; do
		put "$s/cpu/cpu$c/cpufreq/scaling_governor" performance
		put "$s/cpu/cpu$c/cpuidle/state0/latency" 0
		put "$s/cpu/cpu$c/cpuidle/state1/latency" 133
		put "$s/cpu/cpu$c/cpuidle/state1/name" C6
		put "$s/cpu/cpu$c/cpuidle/state1/disable" 1
	done
	put "$s/cpu/smt/active" 0
	mkdir -p "$p/irq/9/acpi" "$p/irq/24/eth0-rx-0" "$p/irq/30"
	put "$p/irq/9/smp_affinity_list" 0-2
	put "$p/irq/24/smp_affinity_list" 3
	put "$p/irq/30/smp_affinity_list" 0-3
	put "$p/1/comm" init
	put "$p/self/status" "$(printf 'Name:\tx\nCapEff:\t000001ffffffffff')"
	c=$FAKE_SYS/devices/pci0000:00/0000:06:00.0
	mkdir -p "$FAKE_SYS/bus/pci/devices" "$FAKE_SYS/bus/pci/drivers/r8169" "$FAKE_SYS/class/net" \
		"$c/net/eth0" "$c/power"
	ln -s "$FAKE_SYS/bus/pci" "$c/subsystem"
	ln -s "$c" "$FAKE_SYS/bus/pci/devices/0000:06:00.0"
	ln -s "$FAKE_SYS/bus/pci/drivers/r8169" "$c/driver"
	ln -s "$c" "$c/net/eth0/device"
	ln -s "$c/net/eth0" "$FAKE_SYS/class/net/eth0"
	put "$c/class" 0x020000
	put "$c/vendor" 0x10ec
	put "$c/device" 0x8168
	put "$c/power/control" on
	put "$c/net/eth0/type" 1
	put "$c/net/eth0/address" 02:00:00:12:34:56
	thread 40 EtherCAT0-post 1 1 0-3
}

# thread [PID/task/]TID NAME PRIORITY POLICY CPUS: 0 is SCHED_OTHER, 1 SCHED_FIFO, 2 SCHED_RR
thread() {
	local d=$FAKE_PROC/$1

	put "$d/comm" "$2"
	# fields 40 and 41 after 37 others
	put "$d/stat" "${1##*/} ($2) S $(printf '7%.0s ' {4..39})$3 $4 0 0 0"
	put "$d/status" "$(printf 'Name:\t%s\nCpus_allowed_list:\t%s' "$2" "$5")"
}

# opened PID FLAGS: it has Master0 open
opened() {
	mkdir -p "$FAKE_PROC/$1/fd"
	ln -s /dev/null "$FAKE_PROC/$1/fd/0"
	ln -s /dev/EtherCAT0 "$FAKE_PROC/$1/fd/5"
	put "$FAKE_PROC/$1/fdinfo/0" "flags:	0100002"
	put "$FAKE_PROC/$1/fdinfo/5" "$(printf 'pos:\t0\nflags:\t%s' "$2")"
}

# application PRIORITY POLICY [CPUS]: with a cycle of its own, in a second thread
application() {
	export FAKE_BUS=app
	thread 500 "my) app" 0 0 0-3
	thread 500/task/500 "my) app" 0 0 0-3
	thread 500/task/501 "my) app" "$1" "$2" "${3:-0-3}"
	[ -e "$FAKE_PROC/500/fd" ] || opened 500 02100002
}

cpu() { echo "$FAKE_SYS/devices/system/cpu/$1"; }

# wrong LEVEL CHECK FOUND [FIX]: that alone is not fine
wrong() {
	run ethercat rtcheck
	echo "$output"
	[ "$status" = $([ "$1" != error ]; echo $?) ]
	[ "$(grep -c '^ok ' <<<"$output")" = $((all - 1)) ]
	grep -q "^$1 * $2 .*$3" <<<"$output"
	[ -z "${4:-}" ] || grep -qF "set: $4" <<<"$output"
}
all=25

@test "rtcheck finds nothing on a computer with the right settings" {
	run ethercat rtcheck
	echo "$output"
	[ "$status" = 0 ]
	[ "$(grep -c '^ok ' <<<"$output")" = $all ]
	[ "${lines[$all]}" = "0 error(s), 0 warning(s), 0 not known" ]
}

@test "rtcheck finds a kernel without PREEMPT_RT" {
	rm "$FAKE_SYS/kernel/realtime"
	wrong error kernel "6.1.0-rt without PREEMPT_RT" "boot a kernel with PREEMPT_RT"
}

@test "rtcheck finds a slow clocksource" {
	put "$FAKE_SYS/devices/system/clocksource/clocksource0/current_clocksource" hpet
	wrong error clocksource hpet "dmesg | grep -i tsc"
}

@test "rtcheck finds throttling of real-time threads" {
	put "$FAKE_PROC/sys/kernel/sched_rt_runtime_us" 950000
	wrong warning throttling "is 950000" "sysctl -w kernel.sched_rt_runtime_us=-1"
}

@test "rtcheck finds timers that move" {
	put "$FAKE_PROC/sys/kernel/timer_migration" 1
	wrong warning timers "is 1" "sysctl -w kernel.timer_migration=0"
}

@test "rtcheck finds the watchdog" {
	put "$FAKE_PROC/sys/kernel/nmi_watchdog" 1
	wrong warning watchdog "is 1" "sysctl -w kernel.nmi_watchdog=0"
}

@test "rtcheck finds a kernel that checks its locks" {
	put "$FAKE_PROC/lockdep_stats" ""
	wrong error debugging "checks its locks" "boot a kernel without CONFIG_LOCKDEP"
}

@test "rtcheck finds huge pages for all programs" {
	put "$FAKE_SYS/kernel/mm/transparent_hugepage/enabled" "[always] madvise never"
	wrong warning "huge pages" "moves pages" \
		"echo never > /sys/kernel/mm/transparent_hugepage/enabled"
}

@test "rtcheck finds swap" {
	echo "/dev/sda2 partition 999420 0 -2" >>"$FAKE_PROC/swaps"
	wrong warning swap "may be on a disk" "swapoff -a"
}

@test "rtcheck finds that the kernel accounts for pressure" {
	put "$FAKE_PROC/pressure/cpu" "some avg10=0.00 avg60=0.00 avg300=0.00 total=0"
	wrong warning pressure "each switch" "kernel parameter psi=0"
}

@test "rtcheck finds a reserved CPU with a tick" {
	put "$(cpu nohz_full)" 1-2
	wrong warning tick "1 reserved" "kernel parameter nohz_full=3"
}

@test "rtcheck finds that no CPU is reserved, and checks all of them" {
	put "$(cpu isolated)" ""
	put "$(cpu cpu0/cpufreq/scaling_governor)" powersave
	run ethercat rtcheck
	echo "$output"
	[ "$status" = 1 ]
	grep -q "^warning * isolation .*(4 online)" <<<"$output"
	grep -qF "isolcpus=managed_irq,domain,3 nohz_full=3 irqaffinity=0-2" <<<"$output"
	put "$(cpu online)" 0-1
	ethercat rtcheck | grep -F "isolcpus=managed_irq,domain,1 nohz_full=1 irqaffinity=0"
	put "$(cpu online)" 0
	ethercat rtcheck | grep -F "use a machine with 2 CPUs"
	grep -q "^unknown * interrupts .*no CPU is reserved" <<<"$output"
	grep -q "^error * frequency .*CPU 0 has the governor powersave" <<<"$output"
}

@test "rtcheck finds a governor that lowers the frequency of the reserved CPU" {
	put "$(cpu cpu0/cpufreq/scaling_governor)" powersave
	put "$(cpu cpu3/cpufreq/scaling_governor)" schedutil
	wrong error frequency "CPU 3 has the governor schedutil, and 0 more" \
		"cpupower frequency-set -g performance"
}

@test "rtcheck finds deep idle states" {
	put "$(cpu cpu3/cpuidle/state1/disable)" 0
	wrong warning "idle states" "CPU 3 may enter C6 and needs 133 us" "kernel parameter cpuidle.off=1"
}

@test "rtcheck finds two threads of a core" {
	put "$(cpu smt/active)" 1
	wrong warning threads "share" "kernel parameter nosmt"
}

@test "rtcheck finds irqbalance" {
	put "$FAKE_PROC/77/comm" irqbalance
	wrong warning irqbalance "runs" "systemctl disable --now irqbalance"
}

@test "rtcheck finds interrupts on the reserved CPU, those of the master's card are none" {
	put "$FAKE_PROC/irq/9/smp_affinity_list" 0-3
	wrong error interrupts "1 come to a reserved CPU: 9 (acpi)" "kernel parameter irqaffinity="
	put "$FAKE_PROC/irq/9/effective_affinity_list" 1
	run ethercat rtcheck
	[ "$status" = 0 ]
}

@test "rtcheck finds an interrupt of the card that comes to a CPU with other load" {
	put "$FAKE_PROC/irq/24/smp_affinity_list" 0-2
	mkdir -p "$FAKE_PROC/irq/25/eth0:tx-0"
	put "$FAKE_PROC/irq/25/smp_affinity_list" 2-3
	put "$FAKE_PROC/irq/25/effective_affinity_list" 3
	wrong warning card "1 interrupt(s) of a master.s card come to no reserved CPU.*: 24 (eth0-rx-0)" \
		"echo CPU > /proc/irq/N/smp_affinity_list"
	put "$FAKE_PROC/irq/24/effective_affinity_list" 3
	rm -r "$FAKE_PROC/irq/25"
	mv "$FAKE_PROC/irq/24/eth0-rx-0" "$FAKE_PROC/irq/24/virtio0-input.0"
	put "$FAKE_PROC/irq/24/effective_affinity_list" 0
	wrong unknown card "no interrupt has the name of a master.s card"
	mv "$FAKE_PROC/irq/24/virtio0-input.0" "$FAKE_PROC/irq/24/eth0"
	put "$FAKE_PROC/irq/24/effective_affinity_list" 3
	ethercat rtcheck | grep "^ok * card .*interrupts of the masters' cards come to CPU 3"
}

@test "rtcheck finds limits of an ordinary user" {
	put "$FAKE_PROC/self/status" "CapEff:	0"
	ulimit -l 64
	ulimit -r 0
	run ethercat rtcheck
	echo "$output"
	[ "$status" = 0 ]
	grep -q "^warning * memory .*may not lock memory (limit 65536)" <<<"$output"
	grep -q "^warning * priority .*may not run threads at priority 50 (limit 0)" <<<"$output"
	grep -q "set: .*memlock unlimited" <<<"$output"
	grep -q "set: .*rtprio 90" <<<"$output"
}

@test "rtcheck finds settings of the card that delay frames" {
	FAKE_ETHTOOL="3 0 0" wrong error coalescing "eth0: received frames wait 3 us" \
		"ethtool -C eth0 rx-usecs 0"
	FAKE_ETHTOOL="1 0 0" ethercat rtcheck
	ln -sfn "$FAKE_SYS/bus/pci/drivers/igb" "$FAKE_SYS/bus/pci/devices/0000:06:00.0/driver"
	FAKE_ETHTOOL="1 0 0" wrong error coalescing "eth0: received frames wait by load (rx-usecs 1)" \
		"ethtool -C eth0 rx-usecs 0"
	FAKE_ETHTOOL="0 1 0" wrong warning energy "eth0: the link falls asleep" \
		"ethtool --set-eee eth0 eee off"
	FAKE_ETHTOOL="0 0 1" wrong warning "pause frames" "eth0: they" \
		"ethtool -A eth0 rx off tx off autoneg off"
	put "$FAKE_SYS/bus/pci/devices/0000:06:00.0/power/control" auto
	wrong warning power "eth0: the card may be switched off (auto)" \
		"echo on > /sys/bus/pci/devices/0000:06:00.0/power/control"
}

@test "rtcheck knows a driver without such settings" {
	FAKE_ETHTOOL=- run ethercat rtcheck
	echo "$output"
	[ "$status" = 0 ]
	[ "$(grep -c "eth0: the driver r8169 has no such setting" <<<"$output")" = 3 ]
}

@test "rtcheck recommends the native driver, and needs no settings with it" {
	local d=$FAKE_SYS/bus/pci/devices/0000:06:00.0

	put "$d/vendor" 0x8086
	put "$d/device" 0x10d3
	wrong warning card "Master0 main: eth0" \
		"DEVICE_MODULES=\"r8169\" in /etc/ethercat.conf, then 'ethercatctl restart'"
	mkdir "$FAKE_SYS/bus/pci/drivers/ec_intel"
	ln -sfn "$FAKE_SYS/bus/pci/drivers/ec_intel" "$d/driver"
	run ethercat rtcheck
	echo "$output"
	grep -q "^ok * card .*0000:06:00.0 with the native driver, no interrupt" <<<"$output"
	[[ $output != *coalescing* ]]
}

@test "rtcheck: a cycle at SCHED_OTHER loses to the thread that finds lost frames" {
	application 0 0
	wrong warning posts "the cycle (my) app, thread 50[01], SCHED_OTHER) loses: EtherCAT0-post (SCHED_FIFO 1) preempts it" \
		"sched_setscheduler() in the application, or chrt -f -p 80 50"
	# with fifo_posts=N
	thread 40 EtherCAT0-post 0 0 0-3
	wrong warning posts "SCHED_OTHER) loses: each program may delay it, and EtherCAT0-post (SCHED_OTHER), too" \
		"sched_setscheduler() in the application, or chrt -f -p 80 50"
}

@test "rtcheck: a cycle at SCHED_FIFO 1 that spins delays the finding of lost frames" {
	application 1 1
	wrong warning posts "EtherCAT0-post (SCHED_FIFO 1) loses if the cycle spins.*the cycle (my) app, thread 501, SCHED_FIFO 1)" \
		"sched_setscheduler() in the application, or chrt -f -p 80 501"
	application 1 2
	wrong warning posts "loses if the cycle spins.*SCHED_RR 1)"
}

@test "rtcheck: a cycle above it wins, and starves it with fifo_posts=N" {
	application 2 1
	ethercat rtcheck | grep "^ok * posts .*the cycle (my) app, thread 501, SCHED_FIFO 2) preempts EtherCAT0-post (SCHED_FIFO 1)$"
	thread 40 EtherCAT0-post 0 0 0-3
	wrong warning posts "EtherCAT0-post (SCHED_OTHER) loses: the cycle (my) app, thread 501, SCHED_FIFO 2) preempts it" \
		"load ec_master without fifo_posts=N"
	# SCHED_DEADLINE
	application 0 6
	wrong warning posts "EtherCAT0-post (SCHED_OTHER) loses: the cycle (my) app, thread 501, SCHED_DEADLINE) preempts it"
}

@test "rtcheck: on a CPU of its own no cycle loses" {
	local p

	# 3 is reserved: the scheduler moves the thread of the module there never
	for p in "0 0" "1 1"; do
		# shellcheck disable=SC2086
		application $p 3
		thread 500/task/500 "my) app" 0 0 3
		ethercat rtcheck | grep "^ok * posts .*and EtherCAT0-post (SCHED_FIFO 1) share no CPU$"
	done
	thread 40 EtherCAT0-post 1 1 3
	wrong warning posts "EtherCAT0-post (SCHED_FIFO 1) loses if the cycle spins"
}

@test "rtcheck: a cycle of the kernel beside the thread that finds lost frames" {
	export FAKE_BUS=kcycle
	ethercat rtcheck | grep "^ok * posts .*the cycle (of the kernel, SCHED_FIFO 40) preempts EtherCAT0-post (SCHED_FIFO 1)$"
	# its CPU is 2
	thread 40 EtherCAT0-post 0 0 2-3
	wrong warning posts "EtherCAT0-post (SCHED_OTHER) loses: the cycle (of the kernel, SCHED_FIFO 40)"
	thread 40 EtherCAT0-post 0 0 0-1
	ethercat rtcheck | grep "^ok * posts .*share no CPU$"
}

@test "rtcheck names the thread that a later cycle will meet" {
	ethercat rtcheck | grep "^ok * posts .*no cycle runs; one with SCHED_FIFO 2 or more preempts EtherCAT0-post (SCHED_FIFO 1)$"
	thread 40 EtherCAT0-post 0 0 0-3
	wrong warning posts "no cycle runs; EtherCAT0-post (SCHED_OTHER) loses to one with SCHED_FIFO" \
		"load ec_master without fifo_posts=N"
}

@test "rtcheck ignores programs that only read, and reports an application it cannot see" {
	# open for reading: a command that shows something
	opened 500 02100000
	application 80 1
	wrong unknown posts "no process that has /dev/EtherCAT0 open for writing can be seen" "run it as root"
	rm -r "$FAKE_PROC/500/fd"
	wrong unknown posts "no process that has /dev/EtherCAT0 open for writing can be seen" "run it as root"
	rm -r "$FAKE_PROC/40"
	wrong unknown posts "there is no thread EtherCAT0-post" "run it as root"
}

@test "rtcheck reports unreadable settings as unknown" {
	rm -r "$FAKE_PROC" "$FAKE_SYS/devices/system" "$FAKE_SYS/class"
	run ethercat rtcheck
	echo "$output"
	for c in clocksource throttling timers watchdog isolation interrupts card posts; do
		grep -q "^unknown * $c " <<<"$output"
	done
	FAKE_ETHTOOL= run ethercat rtcheck
	[ "$status" = 0 ]
}

@test "rtcheck: JSON" {
	put "$(cpu smt/active)" 1
	out rtcheck -j | json 'len(d["checks"]) == 25 and d["warnings"] == 1 and d["errors"] == 0'
	out rtcheck -j | json 'd["checks"][0] == {"level": "ok", "check": "kernel",
		"found": "6.1.0-rt, PREEMPT_RT", "fix": ""}'
	out rtcheck -j | json '[c["fix"] for c in d["checks"] if c["level"] != "ok"] == ["kernel parameter nosmt"]'
}

@test "rtcheck refuses arguments" {
	run ethercat rtcheck eth0
	[ "$status" = 2 ] || [ "$status" = 1 ]
	[[ $output == *"rtcheck"* ]]
	[[ $output != *"isolation"* ]]
}
