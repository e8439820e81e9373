# SPDX-License-Identifier: GPL-2.0-only
# The object dictionary of slaves, as they describe it.

load helpers

setup_file() { start bench 22; }

teardown_file() { stop; }

@test "sdos lists objects and entries in the usual form" {
	run ethercat sdos -p4
	[ "$status" = 0 ]
	[[ "$output" == *'SDO 0x1018, "Identity'*'"'* ]]
	grep -qx '  0x1018:01, r-r-r-, uint32, 32 bit, "Vendor ID"' <<<"$output"
	# nothing but these two kinds of lines
	[ "$(grep -v '^SDO 0x[0-9a-f]\{4\}, "' <<<"$output" |
		grep -cvE '^  0x[0-9a-f]{4}:[0-9a-f]{2}, [rw-]{6}, [^,]+, [0-9]+ bit, ".*"$')" = 0 ]
	[ "$(ethercat sdos -q -p4)" = "$(grep '^SDO' <<<"$output")" ]
}

@test "sdos --verbose and --json have the values" {
	local D=$BATS_TEST_TMPDIR

	ethercat sdos -v -p16 >"$D/before"
	grep -q '^  0x1018:01, .* "Vendor ID", 0x0000ec51 60497$' "$D/before"
	ethercat download -p16 -t int16 0x2001 3 0x4321
	ethercat sdos -v -p16 >"$D/after"
	grep -q '^  0x1008:00, .*, "[ -~]*"$' "$D/after"
	# a setting has a default, whatever it is now
	[ "$(grep -A 1 '^  0x2001:03' "$D/after" | tail -n 1)" = "    default 0x0000 0" ]
	json '.masters[0].slaves[0].objects[] | select(.index == 8193).entries[] |
		select(.subindex == 3) | .default.value == 0 and (has("unit") | not)' sdos -v -p16
	# each entry that can be read in PREOP is given
	[ "$(grep '^  0x....:.., r' "$D/after" | grep -c 'abort 0x')" = 0 ]
	# one value has changed, by one line
	diff "$D/before" "$D/after" | grep '^>' >"$D/new"
	[ "$(wc -l <"$D/new")" = 1 ]
	grep -q '^>   0x2001:03, .*, 0x4321 17185$' "$D/new"
	json '.masters[0].slaves[0] | .position == 16 and (.objects | length > 10) and
		(.objects[] | select(.index == 8193).entries[] | select(.subindex == 3) |
		.value.value == 17185 and .type == "int16" and .size_bits == 16)' sdos -v -p16
	json '[.masters[].slaves[].objects[].entries[] | has("value")] | any | not' sdos -p16
}

@test "pdos --coe reads the present PDOs of a slave" {
	[ "$(ethercat pdos --coe -q -p4 | grep -c 'SII$')" = 0 ]
	[ "$(ethercat pdos --coe -p4 | grep 'PDO ')" = "$(ethercat pdos -p4 | grep 'PDO ')" ]
	ethercat pdos --coe -p16 | grep -q '^SM2: 0x1c12$'
	ethercat download -p16 -t uint8 0x1c12 0 0
	run ethercat pdos --coe -p16
	[[ $output == *'  RxPDO 0x1600 "'*'", assigned in the SII only'* ]]
	ethercat download -p16 -t uint8 0x1c12 0 1
}

@test "several slaves have a header, those without dictionary are left out" {
	run ethercat sdos -q -p0,4-5
	[ "$status" = 0 ]
	[ "$(grep -c '^===' <<<"$output")" = 2 ]
	[ "${lines[0]}" = "=== Master 0, Slave 4 ===" ]
	refused 'no selected slave has an object dictionary' sdos -p0
	refused 'the selection matches no slave' sdos -p99
	refused "unexpected argument '0x1018'" sdos -p4 0x1018
}

@test "sdos --save and --compare find a parameter that was changed" {
	cd "$BATS_TEST_TMPDIR"
	ethercat sdos -p16 --save saved.json
	[ "$(ethercat sdos -p16 --compare saved.json)" = \
		"$(gojq '[.entries[] | select(.data_hex)] | length' saved.json) equal, 0 different, 0 unreadable" ]
	ethercat download -p16 -t int16 0x2001 3 77
	run ethercat sdos -p16 --compare saved.json
	[ "$status" = 2 ]
	[[ ${lines[0]} == '  0x2001:03, rwrwrw, int16, '* ]]
	[ "${lines[1]}" = "    slave 16: 0x004d 77" ]
	[[ ${lines[3]} == *" equal, 1 different, 0 unreadable" ]]
	run ethercat sdos -p16 --compare-slave 17
	[ "$status" = 2 ]
	grep -qx '    slave 17: 0x0000 0' <<<"$output"
}
