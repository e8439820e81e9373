#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Demonstrations of one thing each, on a simulated bus: called by demo.sh, in the VM or on the host.
#
# usage: scenes.sh list             names and what they show
#        scenes.sh known NAME...    are there such demonstrations?
#        scenes.sh NAME...          one after the other
#
# EC_BUILD: where things were built; DEMO_START: when demo.sh began

set -u
list() {
	cat <<-'END'
	run         save a bus as a file, run, watch, set, record and plot: no program is written
	compare     yesterday's file and today's machine: an exchanged slave is named
	syncunits   a part of the machine fails, the other one keeps running
	hotconnect  a part of the machine is unplugged and plugged in again while the other one runs
	redundancy  a cable of a ring is taken out: each value keeps moving
	cable       the same cable in a line and in a ring: what stops, what goes on, and the clocks
	END
}

case ${1:-} in
list)	echo "make demo DEMO=NAME:"
	list
	exit ;;
known)	shift
	for name; do list | grep -q "^$name " || exit 1; done
	exit 0 ;;
esac

start=${DEMO_START:-$(date +%s)}
tmp=$(mktemp -d)
sim=/sys/kernel/debug/ec_sim/sim0
step() { printf '\n[%3d s] %s\n' $(($(date +%s) - start)) "$*"; }
ethercat() { "$EC_BUILD/tool/ethercat" "$@"; }
unload() { rmmod ec_sim ec_master 2>/dev/null; }
trap 'unload; rm -rf "$tmp"' EXIT
trap 'exit 130' INT HUP TERM

# show COMMAND...: as a user types it, with what it prints
show() {
	echo "\$ $*"
	"$@"
}

# die WHAT WHAT-TO-DO
die() {
	echo "demo: FAILED: $1" >&2
	echo "demo: $2" >&2
	exit 1
}

wait_for() {	# wait_for SECONDS COMMAND...
	local end=$((SECONDS + $1))

	until "${@:2}"; do
		[ $SECONDS -lt $end ] || return 1
		sleep 0.1
	done
}

ready() { [ "$(ethercat slaves 2>/dev/null | awk '$3 == "PREOP"' | wc -l)" = "$1" ]; }

# bus SLAVES [PARAMETER...]: of ec_master; the segment on stdin
bus() {
	unload
	cat >"$tmp/segment"
	insmod "$EC_BUILD/modules/master/ec_master.ko" main_devices=sim0 "${@:2}" &&
		insmod "$EC_BUILD/modules/devices/sim/ec_sim.ko" segment="$tmp/segment" ||
		die "the modules cannot be loaded" "dmesg says why; with secure boot they must be signed"
	wait_for 60 ready "$1" || die "not all of $1 slaves reached PREOP in 60 s" "see dmesg"
}

# line OUTPUTS-NAME: a coupler, outputs and inputs that are wired to them
line() {
	cat <<-END
	segment seed=5
	slave coupler EK1100
	slave $1 EL2008
	slave in EL1008
	connect $1.1 -> in.1
	connect $1.8 -> in.8
	END
}

# is NAME VALUE: of the process data
scene_run() {
	local lamp=el2008.channel_1.output sensor=el1008.channel_1.input pid recorder

	step "run: a bus that nobody has configured; output 1 is wired to input 1"
	bus 3 < <(line out)
	step "save: what is there becomes a file"
	show ethercat bus save "$tmp/bus.yaml" || die "bus save" "see above"
	cat "$tmp/bus.yaml"
	step "run: each slave goes to OP with the PDOs that it has; the kernel runs the cycle"
	show ethercat run || die "ethercat run" "'ethercat why' names the cause"
	step "record, watch: all values of each cycle into a file, and a line for each change here"
	echo "\$ ethercat record $lamp $sensor -o record.csv --time 3 &"
	"$EC_BUILD/tool/ethercat" record "$lamp" "$sensor" -o "$tmp/record.csv" --time 3 &
	recorder=$!
	echo "\$ ethercat watch $sensor &"
	"$EC_BUILD/tool/ethercat" watch "$sensor" >"$tmp/watch" &
	pid=$!
	wait_for 20 grep -q "$sensor = 0" "$tmp/watch" || die "ethercat watch" "it shows no value"
	step "set: an output is 1 for a second, its lease, and then zero"
	show ethercat set --lease 1 "$lamp" 1 || die "ethercat set" "see above"
	wait_for 20 grep -q "$sensor = 1" "$tmp/watch" || die "the input" "it does not follow the output"
	wait_for 20 eval '[ "$(grep -c "= 0" "$tmp/watch")" = 2 ]' ||
		die "the lease" "the output is not zero when it has ended"
	kill $pid
	wait $pid 2>/dev/null
	cat "$tmp/watch"
	wait $recorder || die "ethercat record" "see above"
	step "plot: what was recorded"
	show ethercat plot "$tmp/record.csv" || die "ethercat plot" "see above"
	step "top: the bus at a glance"
	show ethercat top
	step "check: the machine is as the file says"
	show ethercat bus check "$tmp/bus.yaml" || die "bus check" "see above"
	show ethercat stop || die "ethercat stop" "see above"
}

scene_compare() {
	step "compare: the machine of yesterday is saved"
	bus 3 < <(line lamps)
	show ethercat bus save "$tmp/yesterday.yaml" || die "bus save" "see above"
	step "overnight somebody exchanges the inputs for analog ones, and adds a slave"
	line lamps | sed 's/^slave in EL1008/slave in EL3062/; /^connect/d' >"$tmp/night"
	echo "slave more EL4002" >>"$tmp/night"
	bus 4 <"$tmp/night"
	step "check: each difference with its place in the file, its cause and what to do"
	show ethercat bus check "$tmp/yesterday.yaml"
	[ $? = 1 ] || die "bus check" "it should find differences and end with 1"
	step "diff: the same from two files, without a machine"
	show ethercat bus save "$tmp/today.yaml" || die "bus save" "see above"
	show ethercat bus diff "$tmp/yesterday.yaml" "$tmp/today.yaml"
	[ $? = 1 ] || die "bus diff" "it should find differences and end with 1"
}

# two lines, the second at port 2 of the first coupler
two_lines() {
	line left
	cat <<-END
	branch coupler 2
	slave coupler2 EK1100 $1
	slave right EL2008
	slave rightin EL1008
	connect right.1 -> rightin.1
	END
}

# parts MODE FAULT REMEDY COMMAND: what the application sees, with a fault after 1 s, which COMMAND
# shows, and its end after 3 s
parts() {
	local pid

	echo "\$ parts $1 6"
	"$EC_BUILD/apps/parts" "$1" 6 >"$tmp/parts" &
	pid=$!
	wait_for 60 grep -q running "$tmp/parts" || die "the application" "see above"
	sleep 1
	echo "\$ echo '$2' >$sim"
	echo "$2" >$sim || die "the simulator" "is debugfs mounted?"
	sleep 2
	show ethercat "$4"
	echo "\$ echo '$3' >$sim"
	echo "$3" >$sim
	wait $pid || die "the application ended with $?" "see above"
	cat "$tmp/parts"
}

# The left part runs through, the right one has a gap and runs again.
judge() {
	grep -qE '^left +[#~-]{60}\|$' "$tmp/parts" || die "the left part" "it should run all the time"
	grep -qE '^right +[#~-]+ {5,}[#~-]{3,}\|$' "$tmp/parts" ||
		die "the right part" "it should have a gap and run again"
}

scene_syncunits() {
	step "syncunits: two parts of a machine, each a sync unit of its own"
	bus 6 < <(two_lines "")
	step "the coupler of the right part loses its power for 2 s; only this unit fails"
	parts units 'off coupler2' 'on coupler2' units
	judge
}

scene_hotconnect() {
	step "hotconnect: the right part is a group that comes and goes"
	bus 6 < <(two_lines alias=7)
	step "its cable is taken away for 2 s; the left part keeps all of its cycles"
	parts groups 'unplug coupler.2' 'plug coupler.2 coupler2.0' slaves
	judge
}

# two stations, each with a coupler, analog inputs and an extension; the last cable leads back
stations() {
	cat <<-END
	segment seed=6
	slave station1 EK1100
	slave level EL3062
	slave end1 EK1110
	slave station2 EK1100 cable=50
	slave pressure EL3062
	slave end2 EK1110
	wire end2.1 -> master.1 cable=50
	sine level.1 amplitude=15000 period=2s
	sine pressure.1 amplitude=15000 period=1500ms
	END
}

ring_is() { ethercat master --json | grep -q "\"state\": *\"$1\""; }

# change FAULT STATE: of the cable between the stations, and what the master says then
change() {
	echo "\$ echo '$1' >$sim"
	echo "$1" >$sim || die "the simulator" "is debugfs mounted?"
	wait_for 20 ring_is "$2" || die "the ring" "it should be $2"
	show ethercat graph --tree
	show ethercat slaves
	ethercat slaves | awk '/^ *[0-9]+ / && $3 != "OP" { bad = 1 } END { exit bad }' ||
		die "slaves" "all of them should stay in OP"
}

scene_redundancy() {
	local recorder file=$tmp/ring.csv

	step "redundancy: two stations in a ring, with a device of the master at each end"
	cat <<-END

	    main device ---- station 1 ---- station 2 ---- backup device

	Each frame is sent at both ends. While the ring is closed the slaves process the copy of one
	end; with a cable out each copy reaches the slaves up to the break and comes back.

	END
	bus 6 backup_devices=sim0b < <(stations)
	show ethercat run || die "ethercat run" "'ethercat why' names the cause"
	wait_for 20 ring_is closed || die "the ring" "it should be closed"
	show ethercat graph --tree
	step "record: both stations have an input that moves all the time"
	echo "\$ ethercat record '*channel_1.value' -o ring.csv --time 6 &"
	"$EC_BUILD/tool/ethercat" record '*channel_1.value' -o "$file" --time 6 &
	recorder=$!
	sleep 2
	step "the cable between the stations is taken out"
	change 'cut end1.1' open
	show ethercat why
	sleep 2
	step "and plugged in again"
	change 'heal end1.1' closed
	wait $recorder || die "ethercat record" "see above"
	step "plot: what was recorded; the cable was out from second 2 on, for more than 2 seconds"
	show ethercat plot "$file" || die "ethercat plot" "see above"
	step "count: cycles whose working counter was not complete"
	awk -F, '!/^#/ && NF > 5 { if (!head++) next; n++; bad += $5 != 2 }
		END { printf "cycles: %d, incomplete: %d\n", n, bad; exit !n || bad > 4 }' "$file" ||
		die "process data" "at most a frame at each event should be lost"
	show ethercat log
	show ethercat stop || die "ethercat stop" "see above"
}

# axes: the stations of a machine with clocks; what comes behind "wire" is the way back
axes() {
	cat <<-END
	segment seed=7
	slave station1 EK1100 drift=30ppm
	slave level EL3062
	slave axis1 drive drift=-20ppm clock=3s
	slave end1 EK1110
	slave station2 EK1100 cable=50 drift=-40ppm clock=7s
	slave pressure EL3062
	slave axis2 drive drift=25ppm clock=11s
	slave end2 EK1110
	$*
	sine level.1 amplitude=15000 period=2s
	sine pressure.1 amplitude=15000 period=1500ms
	END
}

# clocks FILE: registers 0x092c of both axes, until FILE.enough exists
clocks() {
	local line since t all

	read -r since _ </proc/uptime
	until [ -e "$1.enough" ]; do
		all=()
		while read -r line; do
			[[ ! $line =~ registers:\ difference\ (-?[0-9]+) ]] ||
				all+=("${BASH_REMATCH[1]}")
		done < <(ethercat dc -v)
		read -r t _ </proc/uptime
		[ ${#all[@]} != 8 ] || echo "$t,${all[2]},${all[6]}"
	done | awk -F, -v OFS=, -v since="$since" 'BEGIN { print "time_s,axis1_ns,axis2_ns" }
		{ $1 -= since; print }' >"$1"
}

# still FILE COLUMN: the longest time without a change of this value, ms
still() {
	awk -F, -v c="$2" '/^#|time_s/ { next } $c != last { last = $c; since = $1 }
		$1 - since > most { most = $1 - since } END { printf "%d", 1000 * most }' "$1"
}

apart() { ethercat graph --tree 2>/dev/null | grep -qE 'disconnected|backup device'; }
all_in_op() { [ "$(ethercat slaves 2>/dev/null | awk '$3 == "OP"' | wc -l)" = 8 ]; }

# pull NAME WAY-BACK PARAMETER...: a run whose cable between the stations is out for 2 s; the
# recording is cable-NAME.csv. More parameters: of the master
pull() {
	local file=$tmp/cable-$1.csv recorder sampler

	bus 8 "${@:3}" < <(axes "$2")
	ethercat bus save -f "$tmp/saved.yaml" >/dev/null || die "bus save" "see above"
	# both axes get SYNC0 from their clocks
	awk '{ print } /- name: drive/ {
		print "        clock: {assign_activate: 0x0300, sync0: 1 ms}" }' \
		"$tmp/saved.yaml" >"$tmp/$1.yaml"
	show ethercat run "$tmp/$1.yaml" || die "ethercat run" "'ethercat why' names the cause"
	sleep 2		# the clocks come together
	show ethercat graph --tree
	echo "\$ ethercat record '*channel_1.value' -o cable-$1.csv --time 6 &"
	"$EC_BUILD/tool/ethercat" record '*channel_1.value' -o "$file" --time 6 &
	recorder=$!
	clocks "$tmp/clocks.csv" 2>/dev/null &
	sampler=$!
	sleep 2
	echo "\$ echo 'cut end1.1' >$sim"
	echo 'cut end1.1' >$sim || die "the simulator" "is debugfs mounted?"
	wait_for 20 apart || die "the cut" "'ethercat graph' should show it"
	show ethercat graph --tree
	sleep 2
	echo "\$ echo 'heal end1.1' >$sim"
	echo 'heal end1.1' >$sim
	wait_for 20 all_in_op || die "slaves" "all of them should be in OP again"
	wait $recorder || die "ethercat record" "see above"
	touch "$tmp/clocks.csv.enough"
	wait $sampler
	rm "$tmp/clocks.csv.enough"
	show ethercat graph --tree
	show ethercat plot "$file" || die "ethercat plot" "see above"
	echo "$1: station 1 stands still for at most $(still "$file" 6) ms, station 2 for" \
		"$(still "$file" 7) ms"
	ethercat stop
}

scene_cable() {
	step "cable: two stations in a line; the cable between them is out for 2 s"
	pull line ""
	[ "$(still "$tmp/cable-line.csv" 7)" -ge 1500 ] ||
		die "the line" "station 2 should stand still while the cable is out"
	step "a cable back from the last slave to a second device makes it a ring"
	pull ring "wire end2.1 -> master.1 cable=50" backup_devices=sim0b
	[ "$(still "$tmp/cable-ring.csv" 7)" -le 50 ] ||
		die "the ring" "station 2 should go on while the cable is out"
	step "clocks of the ring: how far each axis is from the time that its frames bring, ns"
	show ethercat plot "$tmp/clocks.csv" || die "ethercat plot" "see above"
	awk -F, 'function size(x) { return x < 0 ? -x : +x }
		NR > 1 { n++; for (i = 2; i < 4; i++) if (size($i) > most) most = size($i)
			last = size($3) }
		END { printf "clocks: %d samples, at most %d ns, axis 2 at the end %d ns\n",
				n, most, last
			exit n < 10 || last > 1000 }' "$tmp/clocks.csv" ||
		die "clocks" "axis 2 should be within 1000 ns of the others when the ring is closed"
}

for name; do
	"scene_$name"
	unload
done
