#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

@test "sdos: objects and entries but those refused or cut off" {
	golden sdos sdos -p2
	golden sdos_v sdos -v -p2
	[ "$(out sdos -q -p2)" = "$(grep ^SDO "$HERE/golden/sdos.txt")" ]
}

@test "sdos: names of the slave cannot reach the terminal" {
	[ "$(out sdos -v -p2 | grep -c '[^[:print:]]')" = 0 ]
	out sdos -j -p2 | json 'd["masters"][0]["slaves"][0]["objects"][1]["name"].startswith("a?")'
}

@test "sdos --json: values, abort codes, and a slave that leaves" {
	entries='d["masters"][0]["slaves"][0]["objects"][0]["entries"]'
	out sdos -j -v -p2 | json "[e['value']['value'] for e in $entries if 'value' in e] == [2]"
	out sdos -j -v -p2 |
		json "[e['abort_code'] for e in $entries if 'abort_code' in e] == [0x06020000]"
	out sdos -j -p2 | json '"value" not in str(d)'
	export FAKE_BUS=gone
	run ethercat sdos -p2
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 2: cannot read the object dictionary: "* ]]
	[[ $output == *": no slave at ring position 2" ]]
}

@test "sdos: default, limits and unit are shown unless their sizes are inconsistent" {
	entries='[e for o in d["masters"][0]["slaves"][0]["objects"] for e in o["entries"]]'
	out sdos -j -v -p2 |
		json "[(e['default']['value'], e['minimum']['value'], e['maximum']['value'], e['unit']) for e in $entries if 'unit' in e] == [(8, -1, 10, 0xb503)]"
	out sdos -j -v -p2 | json "len([e for e in $entries if 'default' in e]) == 1"
	out sdos -j -p2 | json '"default" not in str(d)'
}

@test "sdos: a slave without dictionary" {
	run ethercat sdos -p0
	[ "$status" -eq 1 ]
	[[ $output == *"no selected slave has an object dictionary"* ]]
	run ethercat sdos -p2 0x1018
	[ "$status" -eq 1 ]
	[[ $output == *"unexpected argument '0x1018'"* ]]
}

@test "sdos --save and --compare find each difference" {
	local D=$BATS_TEST_TMPDIR

	run ethercat sdos -p2 --save "$D/a.json"
	[ "$status" -eq 0 ]
	[[ $output == "2 value(s) refused by the slave: the file has their abort codes" ]]
	json 'len(d["entries"]) == 7 and d["entries"][3]["data_hex"] == "ff"' <"$D/a.json"
	run ethercat sdos -p2 --compare "$D/a.json"
	[ "$status" -eq 0 ]
	[ "${lines[-1]}" = "4 equal, 0 different, 2 unreadable" ]
	# another value, an entry less, a value where the slave gives none
	sed '/6060:00/d; s/"data_hex": "02000000"/"data_hex": "03000000"/
		s/"abort_code": 305419896/"data_hex": "05"/' "$D/a.json" >"$D/b.json"
	cd "$D"
	run ethercat sdos -p2 --compare b.json
	[ "$status" -eq 2 ]
	diff "$HERE/golden/sdos_compare.txt" <(echo "$output")
	run bash -c "'$HERE/build/fake/ethercat' sdos -p2 --compare - <b.json"
	[ "$status" -eq 2 ]
	out sdos -p2 --compare b.json -j |
		json '[e["kind"] for e in d["entries"]] == ["unreadable"] + 3 * ["different"]'
	out sdos -p2 --compare b.json -j |
		json 'd["entries"][3]["right"] == {"missing": True} and d["different"] == 3'
	[ "$(out sdos -p2 --compare-slave 2 | tail -n 1)" = "4 equal, 0 different, 2 unreadable" ]
	sed -i 's/"vendor_id": 2/"vendor_id": 3/' a.json
	[ "$(err sdos -p2 --compare a.json)" = "slave 2 is a device 0x00000002:0x1c213052, a.json a device 0x00000003:0x1c213052" ]
}

@test "sdos --compare refuses other files and names the mistake" {
	cd "$BATS_TEST_TMPDIR"
	ethercat sdos -p2 --save a.json 2>/dev/null
	refuses() {	# CONTENT ERROR
		printf "$1" >x.json
		run ethercat sdos -p2 --compare x.json
		[ "$status" -eq 1 ]
		[[ $output == *"$2"* ]] || { echo "$1: $output"; return 1; }
	}
	refuses '' 'x.json is empty'
	refuses 'text' "'x.json' is no dictionary: line 1: value expected"
	refuses '{"a": [1,\n2' "line 2: ',' or ']' expected"
	refuses '{"a": "\\u12"}' 'unknown escape'
	refuses '{"a": "b' 'string without end'
	refuses '{} {}' 'more than one value'
	refuses '{a: 1}' 'key expected'
	refuses '\0' 'binary file'
	refuses "$(printf '[%.0s' {1..100})" 'too many levels'
	refuses '[1, -2.5e3, true, null]' "expected a file of 'ethercat sdos --save'"
	refuses '{"format": "ethercat sdos", "entries": [], "version": 2}' 'unknown version'
	for wrong in 's/0x1018:01/0x1018:1z/' 's/"data_hex": "02/"data_hex": "2/' \
		's/"data_hex": "02/"data_hex": "0g/' 's/"type_code": 7,/"type_code": 65536,/'; do
		sed "$wrong" a.json >x.json
		run ethercat sdos -p2 --compare x.json
		[ "$status" -eq 1 ]
		[ "$output" = "ethercat sdos: 'x.json': entry 2 of the list is invalid" ]
	done
	# every part of a file
	for n in $(seq 1 17 $(($(wc -c <a.json) - 3))); do
		head -c "$n" a.json >x.json
		run ethercat sdos -p2 --compare x.json
		[ "$status" -eq 1 ]
		[[ $output == "ethercat sdos: 'x.json' is no dictionary: line "* ]]
	done
	run ethercat sdos -p2 --compare none.json
	[[ $output == *"cannot open none.json"* ]]
}

@test "sdos --save keeps an older file until the new one is whole" {
	cd "$BATS_TEST_TMPDIR"
	echo old >a.json
	FAKE_BUS=gone run ethercat sdos -p2 --save a.json
	[ "$status" -eq 1 ]
	[ "$(cat a.json)" = old ]
	run ethercat sdos -p2 --save none/a.json
	[[ $output == *"cannot write 'none/a.json': No such file or directory"* ]]
	# nothing fits: the write fails with EFBIG instead of ENOSPC
	run bash -c "trap '' XFSZ; ulimit -f 0; exec '$HERE/build/fake/ethercat' sdos -p2 --save a.json"
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write 'a.json': File too large"* ]]
	[ "$(cat a.json)" = old ]
	[ "$(echo a.json*)" = a.json ]
	chmod 640 a.json
	ethercat sdos -p2 --save a.json 2>/dev/null
	[ "$(stat -c %a a.json)" = 640 ]
	grep -q '"format"' a.json
	(umask 027; ethercat sdos -p2 --save b.json 2>/dev/null)
	[ "$(stat -c %a b.json)" = 640 ]
	# neither a link nor a device is replaced by a file
	ln -s b.json link
	ethercat sdos -p2 --save link 2>/dev/null
	[ -L link ]
	[ "$(ethercat sdos -p2 --save /dev/stdout 2>/dev/null | grep -c '"format"')" = 1 ]
	[ -L /dev/stdout ]
	for wrong in "--save a --compare b" "--compare a --compare-slave 1" "--save -" \
		"--compare-slave x" "--compare-slave 65536"; do
		run ethercat sdos -p2 $wrong
		[ "$status" -eq 1 ]
	done
	[[ $output == *"invalid position '65536': expected 0 to 65535"* ]]
	run ethercat sdos --save a.json
	[[ $output == *"the selection matches 3 of 3 slaves"* ]]
	run ethercat sdos -p2 --compare-slave 0
	[[ $output == *"slave 0: no object dictionary that can be read"* ]]
}

@test "sdos with values shows progress on a terminal when it takes longer than a second" {
	local tool=$HERE/build/fake/ethercat

	export FAKE_SLOW=1
	cd "$BATS_TEST_TMPDIR"
	run script -qec "$tool sdos -p2 --save a.json" /dev/null
	[[ $output == *$'\rslave 2: ['*'] '*' of 7 objects'* ]]
	# a listing on the same terminal, -q, --json and a file of errors have none
	run script -qec "$tool sdos -v -p2" /dev/null
	[[ $output != *" of 7 objects"* ]]
	run script -qec "$tool sdos -v -p2 >list" /dev/null
	[[ $output == *" of 7 objects"* ]]
	run script -qec "$tool sdos -j -p2 --save a.json" /dev/null
	[[ $output != *" of 7 objects"* ]]
	[ "$(err sdos -p2 --save a.json | wc -l)" = 1 ]
	unset FAKE_SLOW
	run script -qec "$tool sdos -p2 --save a.json" /dev/null
	[[ $output != *" of 7 objects"* ]]
}
