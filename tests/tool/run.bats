#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# A bus that runs without an application, and its values by name.

load common

@test "run configures all slaves, starts the cycle and leaves it to the master" {
	log_of run >"$BATS_TEST_TMPDIR/out"
	cat "$BATS_TEST_TMPDIR/out"
	grep -qx 'Master0 runs: 3 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50' "$BATS_TEST_TMPDIR/out"
	[ "$(grep -v '^[MO]' "$BATS_TEST_TMPDIR/out")" = 'reserve
config 0: 0x00000002 0x044c2c52
config 1: 0x00000002 0x07d83052
domain: config 1 SM0
config 2: 0x00000002 0x1c213052
domain: config 2 SM2
domain: config 2 SM3
cycle 1000000 ns, stall 0, flags 0
activate
detach' ]
	out run --json | json '(d["in_op"], d["period_ns"], d["priority"]) == (3, 1000000, 50)'
	log_of run --period 250 >"$BATS_TEST_TMPDIR/said"
	grep -q 'cycle 250000 ns' "$BATS_TEST_TMPDIR/said"
}

@test "run --dry-run changes nothing and names the slaves that would run" {
	[ "$(log_of run --dry)" = \
'Master0: 3 of 3 slave(s) would go to OP with the PDOs that they have now, outputs zero, cycle 1 ms:
  0  ek1100: to OP
  1  el2008: to OP
  2  el7201: to OP' ]
	out run --dry-run --json |
		json '[(s["name"], s["kind"], s["runs"]) for s in d["slaves"]][1] == ("el2008", "io", True)'
}

@test "run leaves drives and safety devices out, unless they are named" {
	export FAKE_TYPE=402
	log_of run >"$BATS_TEST_TMPDIR/out"
	grep -q 'el7201: omitted, a drive; add it with --include el7201' "$BATS_TEST_TMPDIR/out"
	grep -q 'runs: 2 slave(s) in OP' "$BATS_TEST_TMPDIR/out"
	[ "$(grep -c '^config 2' "$BATS_TEST_TMPDIR/out")" = 0 ]
	log_of run --include el2008,el7201 >"$BATS_TEST_TMPDIR/said"
	grep -q 'runs: 3 slave(s) in OP' "$BATS_TEST_TMPDIR/said"
	FAKE_TYPE=safety out run --dry-run | grep -q 'el7201: omitted, a safety device'
	FAKE_TYPE=modular out run --dry-run | grep -q 'el7201: omitted, a drive'
	FAKE_TYPE=mute out run --dry-run | grep -q 'el7201: omitted, it does not say what it is'
	FAKE_TYPE=many out run --dry-run | grep -q 'el7201: omitted, it does not say what it is'
	run ethercat run --include el7201,el99
	[ "$status" = 1 ]
	[[ $output == *"Master0 has no slave el99; 'ethercat run --dry-run' shows their names"* ]]
}

@test "run believes that there is no object only when the slave says that" {
	local object
	for object in 1000:0 f010:0 f010:1 f010:2 f980:1; do
		export FAKE_TYPE=io FAKE_ABORT=$object:06020000
		out run --dry-run | grep -qx '  2  el7201: to OP'
		FAKE_ABORT=$object:06090011 out run --dry-run | grep -qx '  2  el7201: to OP'
		FAKE_ABORT=$object:08000022 out run --dry-run |
			grep -q 'el7201: omitted, it does not say what it is'
		FAKE_ABORT=$object:0 out run --dry-run |
			grep -q 'el7201: omitted, it does not say what it is'
	done
}

@test "run leaves nothing when a slave is not in OP, but with --force" {
	export FAKE_STUCK=2
	run log_of run --wait 0.1
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == *"1 of 3 slave(s) not in OP, so the bus does not run"* ]]
	[[ $output == *"slave 2: SAFEOP refused"* ]]
	[ "$(grep -c detach "$BATS_TEST_TMPDIR/log")" = 0 ]
	log_of run --wait 0.1 --force >"$BATS_TEST_TMPDIR/said"
	grep -q detach "$BATS_TEST_TMPDIR/said"
}

@test "run leaves the bus to the master when all is written, so that its end before ends the bus" {
	export FAKE_LOG=$BATS_TEST_TMPDIR/log
	"$HERE/build/fake/ethercat" run >/dev/full 2>"$BATS_TEST_TMPDIR/err" && return 1
	grep -q 'cannot write the output (No space left on device); the bus does not run' \
		"$BATS_TEST_TMPDIR/err"
	grep -q '^activate' "$FAKE_LOG"
	! grep -q '^detach' "$FAKE_LOG" || return 1
	FAKE_STAYS=1 err run | grep -q 'to the master; the bus does not run'
}

@test "run reports a missing right, and the owner of the bus" {
	FAKE_OTHER_SCHED=1 out run |
		grep -q 'SCHED_OTHER: no right to real-time priority (RLIMIT_RTPRIO)'
	FAKE_BUS=run err run | grep -q "runs without an application ('ethercat run'); end that with 'ethercat stop'"
	FAKE_BUS=app err run | grep -q 'reserved by process 7 (demo)'
	FAKE_READONLY=1 err run | grep -q 'Permission denied'
}

@test "data --names shows names, types and values" {
	export FAKE_BUS=run
	golden data_names data --names
	out data --names --json >"$BATS_TEST_TMPDIR/json"
	json '[v["value"] for v in d["masters"][0]["values"]] == ["0", "1", "15", "4294967294"]' \
		<"$BATS_TEST_TMPDIR/json"
	json '(lambda v: (v["bit"], v["bits"], v["index"], v["subindex"]))(d["masters"][0]["values"][3]) == (24, 32, 0x6000, 0x11)' \
		<"$BATS_TEST_TMPDIR/json"
	[ -z "$(out data --names -d 1)" ]
	FAKE_BUS=idle err data --names | grep -q "no application and no 'ethercat run'"
	# types of the EEPROM
	FAKE_SII=1 out data --names | grep -q 'el7201.controlword  *out  uint16'
}

@test "set gives a value a lease of 5 s, another one, or none" {
	export FAKE_BUS=run
	[ "$(log_of set el7201.controlword 15)" = 'el7201.controlword is 15 for 5 s, then zero
output 0: bit 8, 16 bits, 0xf, device 13, lease 5000' ]
	log_of set el2008.channel_2.output on --lease 0.25 >"$BATS_TEST_TMPDIR/said"
	grep -qx 'output 0: bit 1, 1 bits, 0x1, device 12, lease 250' "$BATS_TEST_TMPDIR/said"
	log_of set --hold el7201.controlword 0xffff >"$BATS_TEST_TMPDIR/said"
	grep -qx 'output 0: bit 8, 16 bits, 0xffff, device 13, lease 0, hold' "$BATS_TEST_TMPDIR/said"
	log_of set el7201.controlword -1 >"$BATS_TEST_TMPDIR/said"
	grep -q 'bits, 0xffff,' "$BATS_TEST_TMPDIR/said"
	out set el7201.controlword 1 --json | json '(d["bits"], d["lease_ms"]) == (1, 5000)'
}

@test "set refuses inputs, values that do not fit, and outputs of an application" {
	export FAKE_BUS=run
	refused() {
		run ethercat set "${@:2}"
		echo "$output"
		[ "$status" = 1 ] && [[ $output == *"$1"* ]]
	}
	refused 'el7201.position is an input: only outputs can be set' el7201.position 1
	refused 'no value el7201.controlwort; did you mean el7201.controlword?' el7201.controlwort 1
	refused "no value lamp; 'ethercat data --names' shows them" lamp 1
	refused "the type bool, 1 bit(s), which '2' does not fit" el2008.channel_1.output 2
	refused "which '65536' does not fit" el7201.controlword 65536
	refused "which '-32769' does not fit" el7201.controlword -32769
	refused "which 'x' does not fit" el7201.controlword x
	refused '--hold and --lease exclude each other' --hold --lease 1 el7201.controlword 1
	refused "invalid time '0' for --lease" --lease 0 el7201.controlword 1
	FAKE_OWNER=demo refused 'the outputs of master 0 are those of an application' \
		el7201.controlword 1
}

@test "watch prints a line for each value, then for each change, until the session ends" {
	export FAKE_BUS=run FAKE_CHANGES=3
	run ethercat watch --watch 0.1
	[ "$status" = 0 ]
	[ "$(echo "$output" | grep -c ' = ')" = 7 ]
	[ "$(echo "$output" | grep -c 'el7201.position = ')" = 4 ]
	[[ $output == *"Master0: the session has ended"* ]]
	run ethercat watch --watch 0.1 'el2008.*'
	[ "$(echo "$output" | grep -c ' = ')" = 2 ]
	out watch --watch 0.1 --json el7201.position |
		python3 -c 'import json, sys
assert [json.loads(l)["value"] for l in sys.stdin] == [
	"4294967294", "4294967295", "4294967040", "4294967041"]'
	run ethercat watch el7201.positio
	[ "$status" = 1 ]
	[[ $output == *"did you mean el7201.position?"* ]]
	FAKE_READONLY=1 out watch --watch 0.1 | grep -q el2008
}

@test "watch ends when another session of the same size has begun, not when statistics are reset" {
	export FAKE_BUS=run
	FAKE_ANOTHER=4 run timeout 20 "$HERE/build/fake/ethercat" watch --watch 0.1
	[ "$status" = 0 ]
	[[ $output == *"Master0: the session has ended"* ]]
	FAKE_CHANGES=5 run timeout 20 "$HERE/build/fake/ethercat" watch --watch 0.1
	[ "$(echo "$output" | grep -c 'el7201.position = ')" = 6 ]
}

@test "watch ends with the program that reads its output, also without a change" {
	export FAKE_BUS=run
	run bash -c 'timeout 20 "$0" watch --watch 0.1 > >(head -1)' "$HERE/build/fake/ethercat"
	[ "$status" -ne 124 ]
}

@test "--file gives watch, data and set the names, types, units and scaling of a bus file" {
	export FAKE_BUS=run
	cat >"$BATS_TEST_TMPDIR/bus.yaml" <<-'END'
		ethercat: 1
		masters:
		- slaves:
		  - name: lamps
		    vendor: 2
		    product: 0x07d83052
		    pdos:
		    - {index: 0x1600, sm: 0, entries: [{object: "0x7000:01", bits: 1, name: red}]}
		  - name: axis
		    vendor: 2
		    product: 0x1c213052
		    pdos:
		    - index: 0x1600
		      sm: 2
		      entries:
		      - {object: "0x7010:01", bits: 16, name: speed, type: int16, unit: mm/s,
		         scale: 0.1, offset: -5}
		    - index: 0x1a00
		      sm: 3
		      entries: [{object: "0x6000:11", bits: 32, name: position, type: int32}]
	END
	f=$BATS_TEST_TMPDIR/bus.yaml
	[ "$(out data --names --file "$f" | tr -s ' ')" = "$(printf '%s\n' \
		'lamps.red out bool 0' 'el2008.channel_2.output out bool 1' \
		'axis.speed out int16 -3.5 mm/s' 'axis.position in int32 -2')" ]
	FAKE_CHANGES=1 out watch --watch 0.1 --file "$f" 'axis.sp*' |
		grep -q 'axis.speed = -3.5 mm/s$'
	[[ $(log_of set --file "$f" axis.speed -12.5) == *"16 bits, 0xffb5,"* ]]
	[[ $(log_of set --file "$f" axis.speed 12.46) == *"16 bits, 0xaf,"* ]]
	run ethercat set --file "$f" axis.speed 4000
	[ "$status" = 1 ]
	[[ $output == *"axis.speed has the type int16, 16 bit(s), which "*" does not fit"* ]]
	run ethercat set --file "$f" el7201.controlword 1
	[[ $output == *"Master0 has no value el7201.controlword"* ]]
	# a number without sign does not become a large one
	sed -i 's/name: speed, type: int16/name: speed, type: uint16/' "$f"
	run ethercat set --file "$f" axis.speed -12.5
	[ "$status" = 1 ]
	[[ $output == *"'-75' does not fit: it has no sign"* ]]
	[[ $(log_of set --file "$f" axis.speed -5.001) == *"16 bits, 0x0,"* ]]
	# another machine
	sed -i 's/vendor: 2/vendor: 3/' "$f"
	run ethercat watch --file "$f"
	[ "$status" = 1 ]
	[[ $output == *"bus.yaml: none of its slaves is on the bus of master 0"* ]]
	run ethercat data --file "$f"
	[ "$status" = 1 ]
	[[ $output == *"--file needs --names"* ]]
}

# on_terminal ARG...: with a terminal of 80 columns and 24 lines as stdin and stdout
on_terminal() {
	python3 - "$HERE/build/fake/ethercat" "$@" <<-'END'
	import fcntl, os, pty, signal, struct, sys, termios
	pid, fd = pty.fork()
	if not pid:
	    # a shell in the background ignores them
	    for s in signal.SIGINT, signal.SIGQUIT:
	        signal.signal(s, signal.SIG_DFL)
	    fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack('HHHH', 24, 80, 0, 0))
	    os.execv(sys.argv[1], sys.argv[1:])
	keys = os.environ.get('KEYS', 'ejq').encode() if sys.argv[2] == 'top' else b''
	got = b''
	while True:
	    try:
	        part = os.read(fd, 4096)
	    except OSError:
	        break
	    if not part:
	        break
	    got += part
	    # it draws when it has the terminal
	    os.write(fd, keys)
	    keys = b''
	status = os.waitpid(pid, 0)[1]
	sys.stdout.write(got.decode())
	if sys.argv[2] == 'top' and not termios.tcgetattr(fd)[3] & termios.ECHO:
	    sys.exit('the terminal has no echo')
	sys.exit(os.waitstatus_to_exitcode(status))
	END
}

# no line is as wide as the terminal, else it would wrap
is_narrow() {
	sed 's/\x1b\[[0-9;]*[A-Za-z]//g; s/\r//g' "$1" |
		awk 'length($0) > 79 { print; bad = 1 } END { exit bad }'
}

@test "watch and top on a terminal have at most 79 columns, mark changes, and end by a key" {
	export FAKE_BUS=run FAKE_CHANGES=3
	on_terminal watch --watch 0.1 >"$BATS_TEST_TMPDIR/out"
	is_narrow "$BATS_TEST_TMPDIR/out"
	grep -q '^\* el7201.position' "$BATS_TEST_TMPDIR/out"
	! grep -q '^\* el2008' "$BATS_TEST_TMPDIR/out" || false
	unset FAKE_CHANGES
	on_terminal top --watch 0.1 >"$BATS_TEST_TMPDIR/out"
	is_narrow "$BATS_TEST_TMPDIR/out"
	grep -q "Master0  3 slave(s), 3 reply  'ethercat run'" "$BATS_TEST_TMPDIR/out"
	grep -q 'e: all' "$BATS_TEST_TMPDIR/out"
}

@test "top gives the terminal back at each key that ends or stops a program" {
	export FAKE_BUS=run
	for key in '\x1c' '\x03' '\x1a\x1c'; do
		KEYS=$(printf "$key") on_terminal top --watch 0.1 >"$BATS_TEST_TMPDIR/out" ||
			{ echo "status $?"; cat -v "$BATS_TEST_TMPDIR/out"; return 1; }
	done
}

@test "top prints its lines once in a pipe" {
	export FAKE_BUS=run
	golden top top
	out top --json | json '(d["slaves"], d["interval_ns"]) == (3, 1000000)'
	out top --json | json 'd["session"] == "\u0027ethercat run\u0027"'
	FAKE_BUS=idle out top | grep -qx 'Cycle: none'
}

@test "top calls slaves as the application does, or as the bus file of --file" {
	names_of_session
	out top >"$BATS_TEST_TMPDIR/out"
	grep -qx '    1  PREOP         lamps (EL2008)' "$BATS_TEST_TMPDIR/out"
	grep -q '^    2  PREOP+ERROR   axis (EL7201): SM2' "$BATS_TEST_TMPDIR/out"
	grep -qx '    0  PREOP         EK1100 Coupler' "$BATS_TEST_TMPDIR/out"
	sed 's/name: lamps/name: valves/; s/0x1c213052/0x1c213053/' "$FAKE_NAMES" \
		>"$BATS_TEST_TMPDIR/bus.yaml"
	out top --file "$BATS_TEST_TMPDIR/bus.yaml" >"$BATS_TEST_TMPDIR/out"
	grep -qx '    1  PREOP         valves (EL2008)' "$BATS_TEST_TMPDIR/out"
	grep -q '^    2  PREOP+ERROR   EL7201 servo' "$BATS_TEST_TMPDIR/out"
	# a text that names nothing
	echo 'ethercat: 1' >"$FAKE_NAMES"
	golden top top
	sed -i 's/vendor: 2/vendor: 3/' "$BATS_TEST_TMPDIR/bus.yaml"
	err top --file "$BATS_TEST_TMPDIR/bus.yaml" |
		grep -q 'none of its slaves is on the bus of master 0'
}

@test "stop ends a bus that run has begun, and no other session" {
	export FAKE_BUS=run
	log_of stop >"$BATS_TEST_TMPDIR/said"
	grep -qx 'release 0' "$BATS_TEST_TMPDIR/said"
	FAKE_BUS=detached err stop | grep -q "session of an application that has exited; end it with 'ethercat release'"
	FAKE_OWNER='process 7 (demo)' err stop |
		grep -q 'by process 7 (demo); stop that application'
	FAKE_BUS=idle err stop | grep -q 'Master0 does not run'
}

@test "data --names refuses PDOs that grow while they are read" {
	for reads in 1 2 3; do
		FAKE_BUS=run FAKE_GROWS=$reads run ethercat data --names
		echo "$output"
		[ "$status" -eq 1 ]
		[[ $output != *"has begun meanwhile; repeat the command"* ]] || seen=1
		[[ $output != *AddressSanitizer* ]]
	done
	[ "$seen" = 1 ]
}

# the bus file of a session, whose slaves are in the order of its configurations
names_of_session() {
	cat >"$BATS_TEST_TMPDIR/names" <<-'END'
	ethercat: 1
	masters:
	  - slaves:
	      - name: lamps
	        vendor: 2
	        product: 0x07d83052
	        pdos:
	          - {index: 0x1600, sm: 0, entries: [{object: "0x7000:01", bits: 1, name: red}]}
	      - name: axis
	        vendor: 2
	        product: 0x1c213052
	        pdos:
	          - index: 0x1600
	            sm: 2
	            entries: [{object: "0x7010:01", bits: 16, name: power, type: int16,
	                       unit: "%", scale: 0.1, offset: 1}]
	          - index: 0x1a00
	            sm: 3
	            entries: [{object: "0x6000:11", bits: 32, name: position, type: int32,
	                       unit: mm, scale: 0.5}]
	END
	export FAKE_NAMES=$BATS_TEST_TMPDIR/names FAKE_BUS=run
}

@test "the names that an application has given its session are those of data, watch and set" {
	names_of_session
	out data --names >"$BATS_TEST_TMPDIR/out"
	cat "$BATS_TEST_TMPDIR/out"
	grep -qx 'lamps.red  *out  bool  *0' "$BATS_TEST_TMPDIR/out"
	# without a name there it is called as without the file
	grep -q '^el2008.channel_2.output ' "$BATS_TEST_TMPDIR/out"
	grep -qx 'axis.power  *out  int16  *2.5 %' "$BATS_TEST_TMPDIR/out"
	grep -qx 'axis.position  *in  *int32  *-1 mm' "$BATS_TEST_TMPDIR/out"
	out data --names --json |
		json '[(v["value"], v.get("unit")) for v in d["masters"][0]["values"]][3] == ("-1", "mm")'
	FAKE_CHANGES=1 out watch --watch 0.1 'axis.p*' | grep -q 'axis.position = -1 mm' || false
	[ "$(log_of set axis.power 3)" = 'axis.power is 3 % for 5 s, then zero
output 0: bit 8, 16 bits, 0x14, device 13, lease 5000' ]
	log_of set axis.power -- -0.04 >"$BATS_TEST_TMPDIR/said"
	grep -q '16 bits, 0xfff6,' "$BATS_TEST_TMPDIR/said"
	err set axis.power 3300 | grep -q "the type int16, 16 bit(s), which '32990' does not fit"
	err set axis.power on | grep -q "axis.power is scaled: 'on' is no number"
	err set axis.power nan | grep -q 'is no number'
	err set el7201.controlword 1 | grep -q 'no value el7201.controlword'
}

@test "watch ends when a session with the same places and other names has begun" {
	names_of_session
	export FAKE_ANOTHER=4
	sed 's/name: power/name: torque/' "$FAKE_NAMES" >"$BATS_TEST_TMPDIR/other"
	FAKE_OTHER_NAMES=$BATS_TEST_TMPDIR/other run timeout 20 "$HERE/build/fake/ethercat" watch \
		--watch 0.1 axis.power
	echo "$output"
	[ "$status" = 0 ]
	[[ $output == *"Master0: the session has ended"* ]]
	# the same one again is the same machine
	FAKE_OTHER_NAMES=$FAKE_NAMES FAKE_CHANGES=8 run timeout 20 "$HERE/build/fake/ethercat" \
		watch --watch 0.1 axis.position
	[ "$(echo "$output" | grep -c 'axis.position = ')" = 9 ]
}

@test "a name that two values would have belongs to none" {
	names_of_session
	# another value, which the file does not have, is called so
	sed -i -e 's/name: axis/name: el7201/; s/name: position/name: controlword/' \
		-e 's/0x7010:01/0x7010:02/' \
		"$FAKE_NAMES"
	out data --names | awk '{ print $1 }' >"$BATS_TEST_TMPDIR/out"
	cat "$BATS_TEST_TMPDIR/out"
	[ "$(sort "$BATS_TEST_TMPDIR/out" | uniq -d | wc -l)" = 0 ]
	grep -qx el7201.controlword "$BATS_TEST_TMPDIR/out"
	grep -qx el7201.position "$BATS_TEST_TMPDIR/out"
}

@test "names of an application that are not valid, or of other slaves, change nothing" {
	names_of_session
	sed -i 's/0x1c213052/0x1c213053/' "$FAKE_NAMES"
	out data --names >"$BATS_TEST_TMPDIR/out"
	grep -q '^lamps.red ' "$BATS_TEST_TMPDIR/out"
	grep -q '^el7201.position ' "$BATS_TEST_TMPDIR/out"
	sed -i 's/slaves:/slafes:/' "$FAKE_NAMES"
	golden data_names data --names
	printf '\033[2J' >"$FAKE_NAMES"
	golden data_names data --names
}

@test "run FILE --dry-run names each difference and each omitted slave" {
	local f=$BATS_TEST_TMPDIR/bus.yaml

	ethercat bus save --whole "$f"
	[ "$(log_of run --dry "$f")" = \
		"Master0: the slaves of $f would go to OP, outputs zero, cycle 1 ms:
  ek1100  EK1100
  el2008  EL2008
  el7201  EL7201" ]
	out run --dry --json "$f" | json '[s["name"] for s in d["slaves"]] == ["ek1100", "el2008", "el7201"]'
	sed -i 's/0x07d83052/0x07d83999/' "$f"
	run ethercat run --dry "$f"
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == *"bus.yaml:10: slave 'el2008' exchanged: expected EL2008, vendor 0x00000002, product 0x07d83999, found EL2008, "* ]]
	[[ $output == *"1 difference(s) from $f, so the bus does not run; --force"* ]]
	ethercat run --dry --force "$f" | grep -q 'would go to OP'
	sed -i '/name: el2008/,/name: el7201/{/name: el7201/!d}; /parent/d; /port:/d' "$f"
	ethercat run --dry "$f" >"$BATS_TEST_TMPDIR/out"
	grep -q "  el2008: omitted, not in $f (EL2008" "$BATS_TEST_TMPDIR/out"
	chmod g+w "$f"
	err run --dry "$f" | grep -q "others may write it (mode 0664)"
	err run --dry "$f" --include el2008 | grep -q "exclude each other"
}

@test "run FILE is for the master that the file has, unless -m names another one" {
	local f=$BATS_TEST_TMPDIR/bus.yaml
	export FAKE_BUS=two

	ethercat bus save -m 1 "$f"
	out run --dry-run "$f" | grep -q '^Master1: the slaves of'
	out run --dry-run -m 1 "$f" | grep -q '^Master1: the slaves of'
	err run --dry-run -m 0 "$f" | grep -q 'has no master 0; choose one of the file with -m'
	FAKE_BUS=idle err run --dry-run "$f" | grep -q "$f is for master 1; -m chooses another one"
	ethercat bus save -f "$f"
	err run --dry-run "$f" | grep -q '2 masters found, the command needs one; select it with -m'
	out run --dry-run -m 0 "$f" | grep -q '^Master0: the slaves of'
}
