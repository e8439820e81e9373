# SPDX-License-Identifier: GPL-2.0-only
# The tool while an application runs; programs made from its output.

load helpers

setup_file() {
	start bench 22
	export TREE=$EC_BUILD/../..
}

teardown_file() {
	stop_app
	stop
}

start_app() {
	# bats waits for what holds its descriptor 3
	"$EC_BUILD/apps/demo" --cycles 10000000 >/tmp/demo.out 2>&1 3>&- &
	echo $! >/tmp/demo.pid
	wait_for 120 all_slaves_are OP 22 && wait_for 60 all_exchanged || {
		cat /tmp/demo.out
		ethercat states
		return 1
	}
}

stop_app() {
	[ -f /tmp/demo.pid ] || return 0
	kill "$(cat /tmp/demo.pid)" || true
	rm /tmp/demo.pid
	wait_for 120 inactive
}

inactive() { ethercat master | grep -q 'Active: no'; }

all_exchanged() {
	ethercat domains | awk '{ split($NF, w, "/"); n++; if (w[1] != w[2] || w[2] == 0) exit 1 }
		END { exit n ? 0 : 1 }'
}

@test "cstruct: the arrays configure the whole bench to OP" {
	dir=$BATS_TEST_TMPDIR
	ethercat cstruct >"$dir/pdos.h"
	ethercat cstruct --json | gojq -r '.masters[].slaves[] |
		"X(\(.position), \(.vendor_id), \(.product_code))"' >"$dir/slaves.h"
	[ "$(wc -l <"$dir/slaves.h")" = 18 ]
	cc -std=gnu11 -Wall -Wextra -Werror -Wno-missing-field-initializers -I"$TREE/include" \
		-I"$dir" -o "$dir/app" "$TREE/tests/system/cstruct_app.c" -L"$EC_BUILD/lib" \
		-lethercat -Wl,-rpath,"$EC_BUILD/lib"
	run "$dir/app"
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"all 18 slaves in OP"* ]]
	wait_for 120 all_slaves_are PREOP 22
}

@test "an application runs: config, domains, data, master" {
	start_app
	run ethercat config
	[ "$status" = 0 ]
	[ "${#lines[@]}" = 22 ]
	[[ "${lines[4]}" =~ ^"0:4   0x00000002/0x1c213052  4   OP"$ ]]
	run ethercat config -v -p4
	[ "${lines[0]}" = "Alias: 0" ]
	[ "${lines[1]}" = "Position: 4" ]
	[ "${lines[4]}" = "Attached slave: 4 (OP)" ]
	[[ "$output" == *"SM2, Dir: Output, Watchdog: Default"*"  PDO 0x1600"*"    PDO entry 0x7010:01, 16 bit"* ]]
	[[ "$output" == *$'Feature flags:\n  None.'* ]]
	json '.masters[0].configs | length == 22 and all(.[]; .state == "OP") and
		.[4].sync_managers[0].pdos[0].index == 5632' config
	run ethercat domains
	[[ "$output" =~ ^"Domain0: LogBaseAddr 0x00000000, Size "[0-9]+", WorkingCounter "([0-9]+)/([0-9]+)$ ]]
	[ "${BASH_REMATCH[1]}" = "${BASH_REMATCH[2]}" ]
	ethercat domains -v | grep -q '^  SlaveConfig 0:4, SM2 (Output), LogAddr 0x[0-9a-f]\{8\}, Size 6$'
	json '.masters[0].domains[0] | .working_counter == .expected_working_counter and
		.size_bytes == (.fmmus | map(.size_bytes) | add) and
		all(.fmmus[]; (.data_hex | length) == 2 * .size_bytes)' domains -v
	size=$(ethercat domains -j | gojq '.masters[0].domains[0].size_bytes')
	[ "$(ethercat data | wc -c)" = "$size" ]
	[ "$(ethercat data -d1 | wc -c)" = 0 ]
	json ".masters[0].domains[0] | .size_bytes == $size" data
	ethercat master | grep -qE 'Phase: Operation'
	ethercat master | grep -qE 'Active: yes'
	[ "$(ethercat slaves | awk '$3 == "OP"' | wc -l)" = 22 ]
}

@test "an application runs: access to slaves" {
	[ "$(ethercat upload -p4 0x1018 1)" = "0x00000002 2" ]
	[ "$(ethercat reg_read -p4 -t uint16 0x0130)" = "0x0008 8" ]
	refused 'aborted with code 0x06020000' upload -p4 0x9999 0
	ethercat crc | grep -q '^ 21|'
	ethercat graph crc | grep -q 'taillabel="2 \[0/0\]"'
	ethercat rescan --wait
	all_exchanged
}

@test "an application runs: a slave is taken out of OP and comes back" {
	ethercat states INIT -p4 --wait
	ethercat states OP -p4 --wait 60
	wait_for 120 all_slaves_are OP 22
	wait_for 120 all_exchanged
}

@test "the application ends" {
	stop_app
	[ -z "$(ethercat config; ethercat domains; ethercat data)" ]
	wait_for 120 all_slaves_are PREOP 22
}

# not_in_op COMMAND: the reason it shows
not_in_op() { "$EC_BUILD/tool/ethercat" "$@" -v | sed -n 's/^ *Not in OP: //p'; }

@test "another product or revision than configured: marked, with one reason everywhere" {
	local product want='slave 4 is 0x00000002/0x1c213052, configured is 0x00000002/0x12345678'

	product=$(ethercat slaves -p1 --json | gojq '.masters[0].slaves[0].product_code')
	dmesg -C
	"$BATS_TEST_DIRNAME/wrong_app.py" "$EC_BUILD/lib/libethercat.so.1" 4 0x12345678 1 "$product" \
		>"$BATS_TEST_TMPDIR/out" 2>&1 3>&- &
	echo $! >/tmp/demo.pid
	wait_for 60 grep '^reason: ' "$BATS_TEST_TMPDIR/out"
	# the two, and no other
	[ "$(ethercat slaves | awk '$4 == "!" { printf "%s ", $1 }')" = "1 4 " ]
	[ "$(not_in_op slaves -p4)" = "$want" ]
	[ "$(not_in_op config -p4)" = "$want" ]
	grep -xF "reason: $want" "$BATS_TEST_TMPDIR/out"
	dmesg | grep -F "configuration 0:4: $want"
	dmesg | grep -F 'EtherCAT 0-1: revision 0x'
	dmesg | grep -F ', expected 0x00004711'
	[ "$(dmesg | grep -c 'configuration 0:')" = 1 ]
	ethercat slaves -v -p1 | grep -E '^ *Warning: slave 1 has revision 0x[0-9a-f]{8}, expected 0x00004711$'
	stop_app
	wait_for 120 all_slaves_are PREOP 22
	! ethercat slaves | grep '!' || return 1
}
