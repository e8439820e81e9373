# SPDX-License-Identifier: GPL-2.0-only
# vm: --smp 2
# An application in the kernel, examples/mini, and who lives beside it.

load helpers

setup_file() {
	printf '%s\n' "segment seed=4" "slave coupler EK1100" \
		"slave motor drive in=8 out=8 serial=77" \
		>"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 2
}
teardown_file() { rmmod ec_mini ec_named 2>/dev/null; stop; }
setup() {
	dmesg -C
	wait_for 60 all_slaves_are PREOP 2
	insmod "$EC_BUILD/mini/ec_mini.ko" position=1
	wait_for 60 all_slaves_are OP 2
}
teardown() {
	rmmod ec_mini ec_named 2>/dev/null || true
	[ -z "$(dmesg | grep -E 'BUG:|WARNING:|Oops|lockup')" ]
}

said() { dmesg | grep -qF "ec_mini: $1"; }

# the first bytes of the outputs are those of the inputs, a status word; 8 bytes each
copied() {
	ethercat data | od -An -tx1 -v | awk '{ exit !($1 == $9 && $2 == $10 && $1 $2 != "0000") }'
}

@test "ec_mini cycles, copies inputs to outputs, reads an object, logs changes" {
	wait_for 60 said "slave is in state 8, operational"
	wait_for 60 said "working counter 3, complete"
	wait_for 60 said "serial number 77"
	wait_for 60 copied
}

@test "with a cycle of the kernel it does the same, and rmmod ends its wait" {
	rmmod ec_mini
	wait_for 60 all_slaves_are PREOP 2
	dmesg -C
	insmod "$EC_BUILD/mini/ec_mini.ko" position=1 kernel_cycle=1
	wait_for 60 all_slaves_are OP 2
	wait_for 60 said "working counter 3, complete"
	wait_for 60 said "serial number 77"
	wait_for 60 copied
	[[ "$(ethercat cycle)" == *"Cycle: run by the kernel"* ]]
	[ "$(ethercat upload -p1 -t uint32 0x1018 4 | awk '{ print $1 }')" = 0x0000004d ]
	run rmmod ec_master
	[ "$status" != 0 ]
	timeout 10 rmmod ec_mini
	wait_for 60 all_slaves_are PREOP 2
	insmod "$EC_BUILD/mini/ec_mini.ko" position=1 kernel_cycle=1
	wait_for 60 all_slaves_are OP 2
	# without its device the cycle of the kernel goes on
	rmmod ec_sim
	wait_for 60 json '.masters[0].phase == "waiting"' master
	rmmod ec_mini
	rmmod ec_master
	start "$BATS_FILE_TMPDIR/segment" 2
}

@test "in the interrupt of a timer it does the same" {
	rmmod ec_mini
	wait_for 60 all_slaves_are PREOP 2
	dmesg -C
	insmod "$EC_BUILD/mini/ec_mini.ko" position=1 in_interrupt=1
	wait_for 60 all_slaves_are OP 2
	wait_for 60 said "working counter 3, complete"
	wait_for 60 said "serial number 77"
	wait_for 60 copied
	# cable, mailbox and device at that moment
	[ "$(ethercat upload -p1 -t uint32 0x1018 4 | awk '{ print $1 }')" = 0x0000004d ]
	rmmod ec_sim
	wait_for 60 json '.masters[0].phase == "waiting"' master
	rmmod ec_mini
	rmmod ec_master
	start "$BATS_FILE_TMPDIR/segment" 2
}

@test "the tool works beside ec_mini, a process is refused with the reason" {
	json '.masters[0].active and .masters[0].phase == "operation"' master
	[ "$(ethercat upload -p1 -t uint32 0x1018 4 | awk '{ print $1 }')" = 0x0000004d ]
	run timeout 60 "$EC_BUILD/examples/mirror" 0 1
	[ "$status" != 0 ]
	[[ "$output" == *"reserved by an application in the kernel"*"lsmod"* ]]
	run insmod "$EC_BUILD/mini/ec_mini.ko"
	[ "$status" != 0 ]
	run rmmod ec_master
	[ "$status" != 0 ]
	all_slaves_are OP 2
}

@test "it goes while others are at work, again and again" {
	while :; do ethercat upload -p1 -t uint32 0x1018 4 || :; ethercat slaves; done >/dev/null 2>&1 3>&- &	# in INIT it is refused
	load=$!
	for i in 1 2 3; do
		rmmod ec_mini
		wait_for 60 all_slaves_are PREOP 2
		insmod "$EC_BUILD/mini/ec_mini.ko" position=1
		wait_for 60 all_slaves_are OP 2
	done
	kill "$load"
	wait "$load" || true
}

@test "its device goes first, then it, then the master" {
	rmmod ec_sim
	wait_for 60 json '.masters[0].phase == "waiting"' master
	rmmod ec_mini
	rmmod ec_master
	start "$BATS_FILE_TMPDIR/segment" 2
}

@test "without its slave or the master it is not loaded, and leaves nothing" {
	rmmod ec_mini
	run insmod "$EC_BUILD/mini/ec_mini.ko" position=5
	[ "$status" != 0 ]
	dmesg | grep -qF "kernel API: cannot get slave 5"
	run insmod "$EC_BUILD/mini/ec_mini.ko" master=3
	[ "$status" != 0 ]
	dmesg | grep -qF "no master 3; main_devices= names 1"
	[ "$(awk '$1 == "ec_master" { print $3 }' /proc/modules)" = 1 ]
	json '.masters[0].active == false' master
}

# what the master has of the configuration, without what changes while it runs
configured() {
	ethercat config -v
	ethercat domains -v | grep -Ev '^ *([0-9a-f]{2} ?)+$'
	ethercat units
}

# named BUS PARAMETER...: BUS is a file in the folder of this test, which is in a chroot
named() {
	printf %s "/n$BATS_TEST_TMPDIR" >/sys/module/firmware_class/parameters/path
	insmod "$EC_BUILD/mini/ec_named.ko" bus="$1" "${@:2}"
}

# the log has so many different values of the input
logged() { [ "$(dmesg | grep -o "ec_named: $1 = .*" | sort -u | wc -l)" -ge "$2" ]; }

# what ec_named has written, by the names that the file gave to tools; a value later than the input
pumped() { ethercat data --names | grep -E '^ao.pump .* -?[1-9][0-9]*$'; }

# the bus of "save", with a unit, a group, clocks and names of its own
describe() {
	ethercat bus save --whole "$1"
	sed -i 's/^  - slaves:/  - cycle: 2 ms\n    reference_clock: drive\n    LISTS\n    slaves:/
		s/LISTS/sync_units: [UNIT]\n    groups: [{name: tail, parent: drive, port: 1}]/
		s/UNIT/{name: analog, policy: zero, limit: 3}/
		s/name: el3062$/name: ai\n        sync_unit: analog/
		s/name: el4002$/name: ao\n        sync_unit: analog\n        group: tail/
		s/parent: el3062/parent: ai/
		s/name: ai_standard_channel_1.value/name: pressure, PA/
		s/PA/unit: Pa, scale: 0.25, offset: 1.5/
		s/name: ao_outputs_channel_1.analog_output/name: pump/
		s/^\( *\)type: "drive"/&\n\1timeouts: {safeop_op: 9 s}\n\1CLOCK\n\1startup: [SDO]/
		s/CLOCK/clock: {assign_activate: 0x0300, sync0: 2 ms}/
		s/SDO/{at: safeop, sdo: "0x6060:00", type: int8, value: 8}/' "$1"
	# the lamps keep their own PDOs
	sed -i '/name: el2008$/,/name: ai$/{/pdos:/,/channel_8.output/d}' "$1"
	cat "$1"
}

@test "ec_named: a compiled bus file configures as the file does, and has the values by name" {
	local f=$BATS_TEST_TMPDIR/bus.yaml app

	rmmod ec_mini
	stop
	printf '%s\n' "slave coupler EK1100" "slave lamps EL2008" "slave ai EL3062 alias=5" \
		"slave motor drive in=8 out=8" "slave ao EL4002" \
		"ramp ai.1 amplitude=100 period=500ms" >"$BATS_TEST_TMPDIR/segment"
	start "$BATS_TEST_TMPDIR/segment" 5
	describe "$f"
	ethercat bus compile "$f" -o "$BATS_TEST_TMPDIR/bus.bin"
	"$EC_BUILD/examples/bus_values" "$f" ai.pressure ao.pump 60 >"$f.out" 2>&1 3>&- &
	app=$!
	wait_for 60 all_slaves_are OP 5 || { cat "$f.out"; return 1; }
	configured >"$BATS_TEST_TMPDIR/process"
	cat "$BATS_TEST_TMPDIR/process"
	kill "$app"
	wait "$app" || true
	wait_for 60 all_slaves_are PREOP 5
	named bus.bin input=ai.pressure output=ao.pump
	wait_for 60 all_slaves_are OP 5
	diff "$BATS_TEST_TMPDIR/process" <(configured)
	wait_for 60 logged ai.pressure 5
	dmesg | grep 'ec_named: 5 slaves, '
	dmesg | grep -E 'ec_named: ai.pressure = -?[0-9]+\.(0|25|5|75)0* Pa'
	wait_for 60 pumped
	ethercat cycle
	[[ "$(ethercat cycle)" == *"Interval: 2000.000 us"* ]]
	rmmod ec_named
	wait_for 60 all_slaves_are PREOP 5
	stop
	start "$BATS_FILE_TMPDIR/segment" 2
}

# refused BUS TEXT: the log has the text, and nothing is configured
refused() {
	run named "$1" input=x
	[ "$status" != 0 ]
	dmesg | grep -qF "$2"
	json '.masters[0].session == "none"' master
}

explained() { ethercat config -v | tee /dev/stderr | grep -q '0x00000402'; }

@test "a compiled bus file that is not valid configures nothing, and the log has byte and reason" {
	local f=$BATS_TEST_TMPDIR/bus.yaml d=$BATS_TEST_TMPDIR bytes

	rmmod ec_mini
	ethercat bus save --whole "$f"
	ethercat bus compile "$f" -o "$d/bus.bin"
	bytes=$(stat -c %s "$d/bus.bin")
	# the log has three of them in 10 s; KUnit has the others
	head -c 700 "$d/bus.bin" >"$d/cut"
	refused cut "the compiled bus: byte 700: 700 bytes, expected $bytes by the header (-EBADMSG)"
	{ head -c 100 "$d/bus.bin"; printf '\377'; tail -c +102 "$d/bus.bin"; } >"$d/flip"
	refused flip "cannot load the compiled bus: byte 16: CRC 0x"
	refused bus.yaml "byte 0: no compiled bus file; 'ethercat bus compile' writes one"
	refused bus.bin "ec_named: no value x in the bus file"
	# of another machine: the slave is named, and stays in PREOP
	sed 's/0x00000402/0x00000403/' "$f" >"$f.2"
	ethercat bus compile "$f.2" -f -o "$d/bus.bin"
	named bus.bin input=drive.statusword
	wait_for 60 explained
	all_slaves_are PREOP 1
}
