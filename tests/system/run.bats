# SPDX-License-Identifier: GPL-2.0-only
# A bus that runs without an application: run, set, watch, top, stop.

load helpers

setup_file() {
	# the outputs of the EL2008 are wired to the inputs of the EL1008
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=7
	slave c EK1100
	slave o EL2008
	slave i EL1008
	slave axis drive
	connect o.1 -> i.1
	connect o.8 -> i.8
	END
	start "$BATS_FILE_TMPDIR/segment" 4
	chmod o+r /dev/EtherCAT0
}
teardown_file() { stop; }
teardown() {
	kill -9 ${other:+"$other"} 2>/dev/null || true
	ethercat release 2>/dev/null || true	# not if nobody holds the master
	chmod o-w /dev/EtherCAT0
	wait_for 60 all_slaves_are PREOP 4
}

reader=(setpriv --reuid 65534 --regid 65534 --clear-groups "$EC_BUILD/tool/ethercat")
frames() { ethercat master --json | gojq '.masters[0].common.tx_frames'; }
sent() { [ "$(frames)" -ge "$1" ]; }
# value NAME: what is sent or received now
value() { ethercat data --names --json | gojq -r ".masters[0].values[] | select(.name == \"$1\").value"; }
is() { [ "$(value "$1")" = "$2" ]; }
lamp=el2008.channel_1.output
sensor=el1008.channel_1.input

@test "from a scanned bus to a live value with two commands, and no process stays" {
	run ethercat run --dry
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"3 of 4 slave(s) would go to OP"* ]]
	[[ "$output" == *"drive: omitted, a drive; add it with --include drive"* ]]
	all_slaves_are PREOP 4
	json '.masters[0].session == "none"' master

	run ethercat run
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"Master0 runs: 3 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50"* ]]
	before=$(lost_frames)
	timeout 0.5 "$EC_BUILD/tool/ethercat" watch $sensor | grep -q "$sensor = 0" || false
	all_slaves_are OP 3
	ethercat slaves | grep -q 'PREOP.*drive'
	! fuser /dev/EtherCAT0 2>/dev/null || false
	from=$(frames)
	wait_for 60 sent $((from + 3000))
	json '.masters[0] | .overruns == 0 and .state == "running"' cycle
	[ "$(lost_frames)" = "$before" ]
	json '.masters[0].session == "detached"' master
	ethercat data --names
	# outputs begin with zero
	ethercat data --names --json | gojq -e '.masters[0].values | all(.value == "0")'
	ethercat stop
	wait_for 60 all_slaves_are PREOP 4
}

@test "set: an output is zero when its lease is over, also when its process was killed" {
	ethercat run
	ethercat set $lamp 1
	wait_for 10 is $sensor 1
	sleep 4
	is $sensor 1
	sleep 1.2
	is $sensor 0
	ethercat set --lease 0.5 $lamp on
	wait_for 10 is $sensor 1
	sleep 0.6
	is $sensor 0
	ethercat set --hold $lamp 1
	ethercat set el2008.channel_8.output 1
	sleep 6
	is $sensor 1
	is el1008.channel_8.input 0
	json '.masters[0] | .overruns == 0 and .missed == 0' cycle
	ethercat set --lease 0.1 $lamp 1
	sleep 0.2
	is $sensor 0
	refused 'is an input' set $sensor 1
	refused 'did you mean el2008.channel_1.output' set el2008.channel_1.outputt 1
	refused 'does not fit' set $lamp 2
	refused 'no value nothing.at_all' watch nothing.at_all
}

@test "a drive takes part only when it is named" {
	refused 'has no slave dirve' run --include dirve
	run ethercat run --include drive
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"4 slave(s) in OP"* ]]
	all_slaves_are OP 4
}

@test "a user without write permission watches, and changes nothing" {
	run "${reader[@]}" run
	[ "$status" = 1 ]
	[[ "$output" == *"Permission denied"* ]]
	ethercat run
	for command in "set $lamp 1" stop run release; do
		# shellcheck disable=SC2086
		run "${reader[@]}" $command
		echo "$output"
		[ "$status" = 1 ]
		[[ "$output" == *"Permission denied"* ]]
	done
	all_slaves_are OP 3
	"${reader[@]}" data --names | grep -q "$sensor"
	timeout 0.5 "${reader[@]}" watch 'el1008.*' | grep -c ' = 0' | grep -qx 8
	"${reader[@]}" top | grep -q "'ethercat run'"
}

@test "a member of the group without RLIMIT_RTPRIO runs at SCHED_OTHER, and another one stops it" {
	chmod o+rw /dev/EtherCAT0
	run prlimit --rtprio=0 "${reader[@]}" run
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"SCHED_OTHER: no right to real-time priority (RLIMIT_RTPRIO)"* ]]
	[ "$(ps -o cls=,rtprio= -p "$(pgrep -x EtherCAT0-cyc)" | xargs)" = "TS -" ]
	prlimit --rtprio=0 "${reader[@]}" set $lamp 1
	wait_for 10 is $sensor 1
	setpriv --reuid 1234 --regid 1234 --clear-groups "$EC_BUILD/tool/ethercat" stop
	wait_for 60 all_slaves_are PREOP 4
}

@test "two users at once: one of them runs the bus, applications are refused" {
	ethercat run >"$BATS_TEST_TMPDIR/one" 2>&1 3>&- &
	other=$!
	ethercat run >"$BATS_TEST_TMPDIR/two" 2>&1 || true	# one of the two is refused
	wait $other || true
	other=
	cat "$BATS_TEST_TMPDIR/one" "$BATS_TEST_TMPDIR/two"
	[ "$(cat "$BATS_TEST_TMPDIR/one" "$BATS_TEST_TMPDIR/two" | grep -c 'slave(s) in OP')" = 1 ]
	[ "$(cat "$BATS_TEST_TMPDIR/one" "$BATS_TEST_TMPDIR/two" | grep -cE 'is reserved by|runs without')" = 1 ]
	refused "end that with 'ethercat stop'" run
	run "$EC_BUILD/apps/kcycle" cycles=10
	echo "$output"
	[ "$status" != 0 ]
	[[ "$output" == *"end that with 'ethercat stop'"* ]]
	all_slaves_are OP 3
	ethercat stop
	refused 'does not run' stop
	refused 'no application' set $lamp 1
}

@test "the outputs of an application are its own, also when it has exited" {
	"$EC_BUILD/apps/kcycle" cycles=1000000 flags=1 >"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	other=$!
	wait_for 60 grep -q 'slaves in OP' "$BATS_TEST_TMPDIR/out"
	ethercat data --names
	refused 'those of an application' set "$(ethercat data --names --json |
		gojq -r '[.masters[0].values[] | select(.direction == "output").name][0]')" 1
	refused 'stop that application' stop
	timeout 0.5 "${reader[@]}" watch 'el1008.*' | grep -q ' = '
	kill -9 $other
	wait $other || true
	other=
	refused "'ethercat release'" stop
	refused 'those of an application' set "$(ethercat data --names --json |
		gojq -r '[.masters[0].values[] | select(.direction == "output").name][0]')" 1
}

rows() { grep -v '^[#t]' "$1"; }

@test "record: each cycle has a row, also while the program is stopped and the clock steps" {
	local file=$BATS_TEST_TMPDIR/a.csv err=$BATS_TEST_TMPDIR/err

	ethercat run
	"$EC_BUILD/tool/ethercat" record $lamp $sensor -o "$file" --time 8 2>"$err" 3>&- &
	other=$!
	wait_for 10 test -s "$file"
	kill -STOP $other
	ethercat set --hold $lamp 1
	date -s '+1 hour'
	sleep 5
	kill -CONT $other
	wait $other
	other=
	date -s '-1 hour'
	cat "$err"
	grep -q 'record(s) of 2 value(s) in .* s, 0 lost' "$err"
	# cycles and times follow each other
	rows "$file" | awk -F, '
		n++ && ($3 != cycle + 1 || $1 <= time || $1 > time + 0.1) { print; bad = 1 }
		{ cycle = $3; time = $1 }
		END { print n " rows"; exit bad || n < 7900 || n > 8100 }'
	# the input has the output of one cycle before, or of two
	rows "$file" | awk -F, '$6 && !sent { sent = NR } $7 && !seen { seen = NR }
		END { print sent, seen; exit !sent || seen <= sent || seen > sent + 2 }'
	run ethercat record $lamp -o "$file"
	[ "$status" = 1 ]
	ethercat plot "$file" | grep -q '1 |'
}

rings() { grep -c ec_recorder_new /proc/vmallocinfo; }
no_ring() { [ "$(rings)" = 0 ]; }

@test "record: the session of an application, by a reader without rights, until it ends" {
	local out=$BATS_TEST_TMPDIR/out

	"$EC_BUILD/apps/kcycle" cycles=1000000 flags=1 >"$out.app" 2>&1 3>&- &
	other=$!
	wait_for 60 grep -q 'slaves in OP' "$out.app"
	"${reader[@]}" record '*' --count 500 >"$out"
	[ "$(rows "$out" | wc -l)" = 500 ]
	before=$(lost_frames)
	# killed in the middle it leaves nothing, and the cycle continues
	status=0
	timeout -s KILL 1 "${reader[@]}" record '*' >"$out" || status=$?
	[ "$status" = 137 ]
	[ "$(rows "$out" | wc -l)" -gt 100 ]
	wait_for 10 no_ring
	[ "$(lost_frames)" = "$before" ]
	"${reader[@]}" record '*' >"$out.last" 2>"$out.err" 3>&- &
	wait_for 10 test -s "$out.last"
	kill -9 $other
	wait $other || true
	other=
	[ "$(rings)" -gt 0 ]	# a table of its pages has a line as well
	ethercat release
	wait
	grep -q 'the session has ended' "$out.err"
	wait_for 10 no_ring
}

@test "killed before all is in OP it leaves nothing" {
	for after in 0.05 0.2 0.4 0.8; do
		run timeout -s KILL $after "$EC_BUILD/tool/ethercat" run 3>&-
		# it was faster: to leave the bus to the master is its last step
		! json '.masters[0].session == "detached"' master || {
			[[ $output == *"Outputs are zero"* ]]
			ethercat stop
		}
	done
	json '.masters[0].session == "none"' master
	wait_for 60 all_slaves_are PREOP 4
	ethercat run
}

@test "run FILE: all slaves of the file, by its PDOs, units and cycle" {
	local f=$BATS_FILE_TMPDIR/bus.yaml

	ethercat bus save --whole "$f"
	cat "$f"
	run ethercat run --dry-run "$f"
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"the slaves of $f would go to OP"*"  el2008  EL2008"* ]]
	json '.masters[0].session == "none"' master
	# names are those of the file
	sed -i 's/^  - slaves:/  - cycle: 2 ms\n    slaves:/
		s/name: el2008$/name: lamps/; s/parent: el2008/parent: lamps/
		s/name: channel_1.input/name: alarm, unit: Pa, scale: 20/' "$f"
	run ethercat run "$f"
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"Master0 runs: 4 slave(s) in OP, cycle 2 ms"* ]]
	all_slaves_are OP 4
	! fuser /dev/EtherCAT0 2>/dev/null || false
	"${reader[@]}" data --names
	ethercat set lamps.channel_1.output 1
	wait_for 10 is el1008.alarm 20
	"${reader[@]}" data --names | grep -q '^el1008.alarm .* 20 Pa$'
	refused 'no value el2008.channel_1.output' set $lamp 1
	refused "end that with 'ethercat stop'" run
	ethercat stop
	wait_for 60 all_slaves_are PREOP 4
}

@test "run FILE refuses a file that others may write, names twice, and units of an application" {
	local f=$BATS_TEST_TMPDIR/bus.yaml

	no() {	# no PATTERN [OPTION...]
		run ethercat run "${@:2}" "$f"
		echo "$output"
		[ "$status" = 1 ] && [[ "$output" == *"$1"* ]]
		json '.masters[0].session == "none"' master
	}
	ethercat bus save "$f"
	chmod g+w "$f"
	no "others may write it (mode 0664), so it is not used; 'chmod go-w $f'"
	chmod 0602 "$f"
	no "others may write it"
	chmod 0644 "$f"
	chown 1234 "$f"
	no "belongs to user 1234"
	chown 0 "$f"
	sed -i 's/name: el1008/name: el2008/' "$f"
	no "slave 'el2008' twice"
	ethercat bus save -f "$f"
	sed -i 's/^  - slaves:/  - sync_units: [{name: u, policy: zero}]\n    slaves:/
		s/^\( *\)- name: el1008/&\n\1  sync_unit: u/' "$f"
	no ":4: sync unit 'u' has a policy, a lease or authority, which need an application"
	f=/dev/null
	no "is not a regular file"
	mkfifo "$BATS_TEST_TMPDIR/pipe"
	f=$BATS_TEST_TMPDIR/pipe
	no "is not a regular file"
	f=$BATS_TEST_TMPDIR/none
	no "No such file"
	f=$BATS_TEST_TMPDIR/bus.yaml
	sed -i 's/^  - sync_units.*/  - index: 3/; /sync_unit/d' "$f"
	no "is for master 3; -m chooses another one"
	no "has no master 0" -m 0
}

@test "run FILE of yesterday, after one slave was exchanged for another type, names the difference" {
	local f=$BATS_FILE_TMPDIR/yesterday.yaml

	ethercat bus save --whole "$f"
	stop
	sed 's/slave i EL1008/slave i EL3062/; /^connect/d' "$BATS_FILE_TMPDIR/segment" \
		>"$BATS_TEST_TMPDIR/today"
	start "$BATS_TEST_TMPDIR/today" 4
	for option in --dry-run --wait=20; do
		run ethercat run $option "$f"
		echo "$output"
		[ "$status" = 1 ]
		[[ "$output" == *"slave 'el1008' exchanged: expected EL1008, vendor 0x00000002, product 0x03f03052, found EL3062, vendor 0x00000002, product 0x0bf63052, at port 1 of 'el2008'; install the expected device"* ]]
		[[ "$output" == *"1 difference(s) from $f, so the bus does not run"* ]]
		json '.masters[0].session == "none"' master
	done
	run ethercat run --force "$f"
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"3 slave(s) in OP"* ]]
	all_slaves_are OP 3
	ethercat slaves | grep -q 'PREOP.*EL3062'
	ethercat stop
	# one more slave is no difference
	stop
	sed '/^connect/d' "$BATS_FILE_TMPDIR/segment" >"$BATS_TEST_TMPDIR/today"
	echo slave more EL1008 >>"$BATS_TEST_TMPDIR/today"
	start "$BATS_TEST_TMPDIR/today" 5
	run ethercat run "$f"
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"el1008_2: omitted, not in $f"*"4 slave(s) in OP"* ]]
	stop
	start "$BATS_FILE_TMPDIR/segment" 4
	chmod o+r /dev/EtherCAT0
}

@test "run FILE refuses a bus that has changed since it was compared with the file" {
	local f=$BATS_TEST_TMPDIR/bus.yaml sim=/sys/kernel/debug/ec_sim/sim0

	ldd "$EC_BUILD/tool/ethercat" >/dev/null 2>&1 || skip "the program has no libraries"
	cc -D_GNU_SOURCE -shared -fPIC -Wall -Wextra -Werror -o "$BATS_TEST_TMPDIR/before.so" \
		"$BATS_TEST_DIRNAME/before_request.c"
	ethercat bus save --whole "$f"
	# one slave less, whose absence the master has seen
	cat >"$BATS_TEST_TMPDIR/cut" <<-END
		echo 'cut i.0' >$sim
		until [ "\$("$EC_BUILD/tool/ethercat" slaves | wc -l)" = 2 ]; do sleep 0.1; done
	END
	run env LD_PRELOAD="$BATS_TEST_TMPDIR/before.so" BEFORE_REQUEST="sh $BATS_TEST_TMPDIR/cut" \
		"$EC_BUILD/tool/ethercat" run "$f"
	echo "$output"
	[ "$status" = 1 ]
	[[ "$output" == *"Master0: its slaves have changed meanwhile; repeat the command"* ]]
	json '.masters[0].session == "none"' master
	all_slaves_are PREOP 2
	echo 'heal i.0' >$sim
	wait_for 60 all_slaves_are PREOP 4
	ethercat run "$f"
	all_slaves_are OP 4
}

@test "a bus file finds identical slaves by serial number, for names and for a run" {
	local f=$BATS_TEST_TMPDIR/bus.yaml

	stop
	printf '%s\n' 'segment seed=7' 'slave c EK1100' 'slave a EL2008 serial=11' \
		'slave b EL2008 serial=12' >"$BATS_TEST_TMPDIR/twins"
	start "$BATS_TEST_TMPDIR/twins" 3
	cat >"$f" <<-'END'
	ethercat: 1
	masters:
	  - slaves:
	      - {name: coupler, vendor: 2, product: 0x044c2c52}
	      - name: left
	        vendor: 2
	        product: 0x07d83052
	        serial: 12
	        pdos:
	          - {index: 0x1600, sm: 0, entries: [{object: "0x7000:01", bits: 1, name: lamp}]}
	      - name: right
	        vendor: 2
	        product: 0x07d83052
	        serial: 11
	        pdos:
	          - {index: 0x1600, sm: 0, entries: [{object: "0x7000:01", bits: 1, name: lamp}]}
	END
	ethercat run
	ethercat data --names --file "$f"
	ethercat set --file "$f" --hold left.lamp 1
	[ "$(value el2008.channel_1.output) $(value el2008_2.channel_1.output)" = "0 1" ]
	ethercat top --file "$f" | grep -qE '^ *2 .* left \(EL2008\)$'
	ethercat stop
	wait_for 60 all_slaves_are PREOP 3
	ethercat run "$f"
	ethercat top | grep -qE '^ *1 .* right \(EL2008\)$'
	ethercat stop
	# not by their order when one of them is another one
	sed -i 's/serial: 12/serial: 13/' "$f"
	run ethercat run "$f"
	echo "$output"
	[ "$status" = 1 ]
	stop
	start "$BATS_FILE_TMPDIR/segment" 4
	chmod o+r /dev/EtherCAT0
}

@test "run FILE: two at once, and killed before all is in OP" {
	local f=$BATS_TEST_TMPDIR/bus.yaml

	ethercat bus save "$f"
	ethercat run "$f" >"$BATS_TEST_TMPDIR/one" 2>&1 3>&- &
	other=$!
	ethercat run "$f" >"$BATS_TEST_TMPDIR/two" 2>&1 || true	# one of the two is refused
	wait $other || true
	other=
	cat "$BATS_TEST_TMPDIR/one" "$BATS_TEST_TMPDIR/two"
	[ "$(cat "$BATS_TEST_TMPDIR/one" "$BATS_TEST_TMPDIR/two" | grep -c 'slave(s) in OP')" = 1 ]
	ethercat stop
	wait_for 60 all_slaves_are PREOP 4
	for after in 0.05 0.2 0.4 0.8; do
		# killed, or done
		timeout -s KILL $after "$EC_BUILD/tool/ethercat" run "$f" 3>&- || status=$?
		! json '.masters[0].session == "none"' master || continue
		# it was faster
		all_slaves_are OP 4
		ethercat stop
	done
	json '.masters[0].session == "none"' master
	wait_for 60 all_slaves_are PREOP 4
}

@test "the module is removed while the bus runs and a lease has not ended" {
	ethercat run
	ethercat set $lamp 1
	wait_for 10 is $sensor 1
	stop
	[ ! -e /dev/EtherCAT0 ]
	! dmesg | grep -E 'BUG|WARNING|refcount' || false
	start "$BATS_FILE_TMPDIR/segment" 4
	chmod o+r /dev/EtherCAT0
}
