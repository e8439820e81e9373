#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

setup() {
	f=$BATS_TEST_TMPDIR/bus.yaml
	ethercat bus save --whole "$f"
}

@test "bus save writes the bus to stdout or to a file, which is equal to the bus" {
	golden bus_save bus save
	[ "$(ethercat bus save "$BATS_TEST_TMPDIR/short.yaml")" = \
		"$BATS_TEST_TMPDIR/short.yaml: 3 slave(s)" ]
	[ "$(ethercat bus check "$BATS_TEST_TMPDIR/short.yaml")" = "no difference, 3 slave(s)" ]
	diff -u "$HERE/golden/bus_save_whole.txt" <(sed 1d "$f")
	ethercat bus check "$f"
	ethercat bus save -j | json '"name: el7201" in d["text"]'
}

@test "bus save --whole writes PDOs and modules of the slaves themselves, and notes slaves that do not answer" {
	export FAKE_MODULES=0x119800,0,0x20192
	ethercat bus save --whole -f "$f"
	[ "$(grep -A2 ' modules:$' "$f" | tr -s ' \n' ' ')" = \
		" modules: - {slot: 1, ident: 0x00119800} - {slot: 3, ident: 0x00020192} " ]
	ethercat bus check "$f"
	FAKE_MODULES=slow run ethercat bus save --whole -f "$BATS_TEST_TMPDIR/slow"
	[ "$status" -eq 0 ]
	[[ $output == *"Master0 slave 2: its dictionary was not read: 0xf050:00: slave 2 has not answered for 1000 ms"* ]]
	grep -q 'index: 0x1a00' "$BATS_TEST_TMPDIR/slow"
	! grep -q 'modules:\|0x1602' "$BATS_TEST_TMPDIR/slow" || return 1
}

@test "bus save --whole and bus check write nothing to a slave" {
	export FAKE_MODULES=1
	local sdo='{at: safeop, sdo: 0x6060:00, type: int8, value: -1}'
	sed -i "s/^        pdos:/        startup: [$sdo]\n&/" "$f"
	[ "$(log_of bus save --whole -f "$BATS_TEST_TMPDIR/x" | grep -v slave)" = "" ]
	run ethercat bus check "$f"
	[ "$(cat "$FAKE_LOG")" = "" ]
}

@test "bus check compares modules slot by slot" {
	FAKE_MODULES=7,8,0 ethercat bus save --whole -f "$f"
	FAKE_MODULES=7,9,3 run ethercat bus check "$f"
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"slave 'el7201' module in slot 2 differs: expected ident 0x00000008, found ident 0x00000009; plug the expected module into slot 2, or change modules in the file" ]]
	[[ ${lines[1]} == *"slave 'el7201' module in slot 3 differs: expected an empty slot, found ident 0x00000003; remove it from slot 3, or add it to modules in the file" ]]
	[ "${lines[2]}" = "2 difference(s)" ]
	# not modular at all
	run ethercat bus check "$f"
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"module in slot 1 differs: expected ident 0x00000007, found an empty slot; plug"* ]]
	# what cannot be read is not compared
	FAKE_MODULES=slow run ethercat bus check "$f"
	[ "$status" -eq 2 ]
	[[ $output == *"slave 2 has not answered"*"no difference, 3 slave(s)" ]]
}

@test "bus check: a startup value that no session has written is pending, no difference" {
	local sdo='{at: safeop, sdo: 0x6060:00, type: int8, value: 8}'
	sed "/type: \"EL7201\"/a\        startup: [$sdo]" "$f" >"$BATS_TEST_TMPDIR/a"
	run ethercat bus check "$BATS_TEST_TMPDIR/a"
	[ "$status" -eq 0 ]
	[ "${lines[0]#"$BATS_TEST_TMPDIR/"}" = \
		"a:31: slave 'el7201' startup 0x6060:00 pending: expected 08, found ff; the master writes it on the way to SAFEOP when the file is applied" ]
	[ "${lines[1]}" = "no difference, 3 slave(s)" ]
	sed -i 's/value: 8/value: -1/' "$BATS_TEST_TMPDIR/a"
	[ "$(ethercat bus check "$BATS_TEST_TMPDIR/a")" = "no difference, 3 slave(s)" ]
}

@test "bus save keeps an existing file unless -f is given" {
	echo mine >"$BATS_TEST_TMPDIR/mine"
	run ethercat bus save "$BATS_TEST_TMPDIR/mine"
	[ "$status" -eq 1 ]
	[[ $output == *"mine exists; -f overwrites it" ]]
	[ "$(cat "$BATS_TEST_TMPDIR/mine")" = mine ]
	ethercat bus save -f "$BATS_TEST_TMPDIR/mine"
	ethercat bus check "$BATS_TEST_TMPDIR/mine"
	echo mine >"$BATS_TEST_TMPDIR/mine"
	ln -s mine "$BATS_TEST_TMPDIR/link"
	run ethercat bus save "$BATS_TEST_TMPDIR/link"
	[ "$status" -eq 1 ]
	[ "$(cat "$BATS_TEST_TMPDIR/mine")" = mine ]
	run ethercat bus save /dev/full
	[ "$status" -eq 1 ]
}

@test "bus save leaves the old file when the disk takes no new one" {
	unshare -m true 2>/dev/null || skip "needs a mount namespace"
	export -f ethercat
	export HERE
	mkdir "$BATS_TEST_TMPDIR/disk"
	unshare -m bash -c '
		mount -t tmpfs -o nr_inodes=2 none "$0" && echo mine >"$0/mine" &&
		! ethercat bus save -f "$0/mine" && [ "$(cat "$0/mine")" = mine ]' \
		"$BATS_TEST_TMPDIR/disk"
}

# the difference that a change of the file makes, without the name of the file
differs() {	# differs SED EXPECTED
	sed "$1" "$f" >"$BATS_TEST_TMPDIR/changed"
	run ethercat bus check "$BATS_TEST_TMPDIR/changed"
	[ "$status" -eq 1 ]
	[ "${lines[0]#"$BATS_TEST_TMPDIR/"}" = "$2" ]
	[ "${lines[1]}" = "1 difference(s)" ]
}

@test "bus check names each difference once, with cause and remedy" {
	differs 's/0x07d83052/0x07d83999/' "changed:10: slave 'el2008' exchanged: expected EL2008, vendor 0x00000002, product 0x07d83999, found EL2008, vendor 0x00000002, product 0x07d83052, at port 1 of 'ek1100'; install the expected device, or change vendor and product in the file"
	differs 's/0x00100000/0x00200000/' "changed:10: slave 'el2008' revision differs: expected 0x00200000, found 0x00100000; if this revision is right, set revision, or revision_rule: at_least, in the file"
	differs 's/alias: 1001/alias: 1002/' "changed:10: slave 'el2008' alias differs: expected 1002, found 1001; write the alias with 'ethercat alias', or change it in the file"
	differs '/parent: el2008/{n;s/1/2/}' "changed:29: slave 'el7201' moved: expected port 2 of 'el2008', found port 1 of 'el2008'; connect it to port 2 of 'el2008', or change parent and port in the file"
	differs 's/0x6000:11/0x6000:12/' "changed:52: slave 'el7201' pdos 0x1a00 entries 1 object differs: expected 0x6000:12, found 0x6000:11; change the slave, or the file"
	differs '/index: 0x1601/,/channel_2/d' "slave 'el2008' pdos 0x1601 extra: a PDO; map and assign PDOs as in the file, or change the file"
}

@test "bus check: one slave more or less is one difference" {
	sed '/name: el2008/,/channel_2.output/d; s/parent: el2008/parent: ek1100/' "$f" \
		>"$BATS_TEST_TMPDIR/less"
	run ethercat bus check "$BATS_TEST_TMPDIR/less"
	[ "$status" -eq 1 ]
	[ "${lines[0]}" = "slave 'el2008' extra: EL2008, vendor 0x00000002, product 0x07d83052, at port 1 of 'ek1100'; remove it from the bus, or add it to the file" ]
	[ "${lines[1]}" = "1 difference(s)" ]
	sed 's/parent: el2008/parent: more/' "$f" >"$BATS_TEST_TMPDIR/more"
	line='{name: more, vendor: 5, product: 6, parent: el2008, port: 1}'
	sed -i "/- name: el7201/i\\      - $line" "$BATS_TEST_TMPDIR/more"
	run ethercat bus check "$BATS_TEST_TMPDIR/more"
	[ "$status" -eq 1 ]
	[ "${lines[0]#"$BATS_TEST_TMPDIR/"}" = "more:29: slave 'more' missing: vendor 0x00000005, product 0x00000006, at port 1 of 'el2008'; connect it to port 1 of 'el2008', or remove it from the file" ]
	[ "${lines[1]}" = "1 difference(s)" ]
	ethercat bus check -j "$BATS_TEST_TMPDIR/more" |
		json '[(x["kind"], x["line"]) for x in d["differences"]] == [("missing", 29)]'
}

@test "bus diff compares two files, names included" {
	[ "$(ethercat bus diff "$f" "$f")" = "no difference, 3 slave(s)" ]
	sed 's/name: position/name: actual/' "$f" >"$BATS_TEST_TMPDIR/b"
	run ethercat bus diff "$f" "$BATS_TEST_TMPDIR/b"
	[ "$status" -eq 1 ]
	[ "${lines[0]#"$BATS_TEST_TMPDIR/"}" = \
		"bus.yaml:52: slave 'el7201' pdos 0x1a00 entries 1 name differs: expected position, found actual" ]
}

@test "bus compile writes the same bytes each time, and keeps an existing file unless -f is given" {
	local bin=$BATS_TEST_TMPDIR/bus.bin

	run ethercat bus compile "$f"
	[ "$status" -eq 2 ]
	[[ ${lines[0]} == *"bus compile needs --output-file"* ]]
	[ "$(ethercat bus compile "$f" -o "$bin")" = "$bin: $(stat -c %s "$bin") byte(s)" ]
	[ "$(head -c 7 "$bin")" = ECATBUS ]
	run ethercat bus compile "$f" -o "$bin"
	[ "$status" -eq 1 ]
	[[ $output == *"bus.bin exists; -f overwrites it" ]]
	ethercat bus compile -j "$f" -o "$bin.2" | json "d['size'] == $(stat -c %s "$bin")"
	cmp "$bin" "$bin.2"
	run ethercat bus compile "$f" -o /dev/full
	[ "$status" -eq 1 ]
	# the bus is not asked
	[ "$(log_of bus compile "$f" -f -o "$bin" | grep -v 'byte(s)$')" = "" ]
	sed -i 's/alias: 1001/identification: 3/' "$f"
	run ethercat bus compile "$f" -f -o "$bin"
	[ "$status" -eq 2 ]
	[[ $output == *"bus.yaml:10: slave 'el2008': an application does not see the identification of slaves"* ]]
	cmp "$bin" "$bin.2"
}

@test "bus compile takes the selected master of a file with several" {
	local bin=$BATS_TEST_TMPDIR/bus.bin

	printf '%s\n' 'ethercat: 1' 'masters:' '- {index: 0, slaves: [{vendor: 2, product: 3}]}' \
		'- {index: 4, slaves: [{name: other, vendor: 2, product: 3}]}' >"$BATS_TEST_TMPDIR/two"
	run ethercat bus compile "$BATS_TEST_TMPDIR/two" -o "$bin"
	[ "$status" -eq 2 ]
	[[ ${lines[0]} == *"two: 2 masters; select one with --master" ]]
	ethercat bus compile -m4 "$BATS_TEST_TMPDIR/two" -o "$bin"
	grep -q 'name: other' "$bin"
	run ethercat bus compile -m2 "$BATS_TEST_TMPDIR/two" -f -o "$bin"
	[ "$status" -eq 2 ]
	[[ $output == *"no master 2 in the file"* ]]
}

@test "bus exits with 2 when its output is lost, equal or not" {
	sed 's/alias: 1001/alias: 1002/' "$f" >"$BATS_TEST_TMPDIR/b"
	for b in "$f" "$BATS_TEST_TMPDIR/b"; do
		ret=0
		ethercat bus diff "$f" "$b" >/dev/full || ret=$?
		[ "$ret" = 2 ]
	done
}

@test "bus show shows slaves as a tree with the names of values" {
	diff -u "$HERE/golden/bus_show.txt" <(ethercat bus show "$f")
	ethercat bus show -j "$f" |
		json 'd["masters"][0]["slaves"][2]["values"][0]["name"] == "el7201.controlword"'
}

@test "bus show shows branches below a parent that stands behind them" {
	cat >"$BATS_TEST_TMPDIR/behind" <<-'END'
		ethercat: 1
		masters:
		- slaves:
		  - {name: leaf, vendor: 1, product: 1, parent: branch, port: 1}
		  - {name: branch, vendor: 1, product: 1, parent: root, port: 2}
		  - {name: root, vendor: 1, product: 1}
	END
	run ethercat bus show "$BATS_TEST_TMPDIR/behind"
	[ "$status" -eq 0 ]
	[[ ${lines[1]} == "    leaf "* && ${lines[2]} == "    branch "* && ${lines[3]} == "  root "* ]]
}

@test "bus diff and bus show name modules by slot" {
	cp "$HERE/../busfile/whole.yaml" "$BATS_TEST_TMPDIR/a"
	sed '/slot: 1,/d; s/slot: 3/slot: 2/' "$BATS_TEST_TMPDIR/a" >"$BATS_TEST_TMPDIR/b"
	run ethercat bus diff "$BATS_TEST_TMPDIR/a" "$BATS_TEST_TMPDIR/b"
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"slave 'axis1' module in slot 1 differs: expected ident 0x00119800, FSoE, found an empty slot" ]]
	[[ ${lines[1]} == *"module in slot 2 differs: expected an empty slot, found ident 0x00020192" ]]
	[[ ${lines[2]} == *"module in slot 3 differs: expected ident 0x00020192, found an empty slot" ]]
	ethercat bus show "$BATS_TEST_TMPDIR/a" | grep -q 'slot 3  module 0x00020192$'
	ethercat bus show -j "$BATS_TEST_TMPDIR/a" |
		json 'd["masters"][0]["slaves"][1]["modules"][0] == {"slot": 1, "ident": 0x119800, "name": "FSoE"}'
}

@test "bus refuses a file with its line and exits with 2" {
	sed -i 's/vendor/vender/' "$f"
	for verb in "check $f" "diff $f $f" "show $f"; do
		run ethercat bus $verb
		[ "$status" -eq 2 ]
		[[ $output == *"bus.yaml:7:9: unknown key 'vender' of a slave; did you mean 'vendor'?" ]]
	done
	run ethercat bus check /nonexistent
	[ "$status" -eq 2 ]
	[[ $output == *"/nonexistent: No such file or directory" ]]
	for verb in chek "check" "diff $f" "schema x" "" "diff a b c d" "diff --nonsense a b"; do
		run ethercat bus $verb
		[ "$status" -eq 2 ]
	done
}

@test "the JSON Schema accepts each example and the file of bus save, and refuses typos" {
	ethercat bus schema >"$BATS_TEST_TMPDIR/schema.json"
	# that of Debian, whose packages tests/install-deps.sh installs
	/usr/bin/python3 - "$BATS_TEST_TMPDIR/schema.json" "$f" "$HERE"/../busfile/*.yaml <<-'END'
		import json, sys
		import jsonschema, yaml
		schema = json.load(open(sys.argv[1]))
		jsonschema.Draft7Validator.check_schema(schema)
		v = jsonschema.Draft7Validator(schema)
		assert len(sys.argv) >= 4
		for name in sys.argv[2:]:
		    bus = yaml.safe_load(open(name))
		    assert not list(v.iter_errors(bus)), (name, list(v.iter_errors(bus)))
		    bus["masters"][0]["slaves"][0]["vender"] = 2
		    assert list(v.iter_errors(bus)), name
		    del bus["masters"][0]["slaves"][0]["vender"]
		    del bus["masters"][0]["slaves"][0]["vendor"]
		    assert list(v.iter_errors(bus)), name
	END
	for x in "$HERE"/../busfile/*.yaml; do
		ethercat bus show "$x" >/dev/null
	done
}

@test "bus save calls slaves as data does, with and without an order text" {
	export FAKE_ORDER=---
	ethercat bus save >"$BATS_TEST_TMPDIR/out"
	cat "$BATS_TEST_TMPDIR/out"
	[ "$(grep -c 'name: el2008_8_ch_output$' "$BATS_TEST_TMPDIR/out")" = 1 ]
	FAKE_BUS=run ethercat data --names | grep -q '^el2008_8_ch_output\.'
}

@test "bus check accepts the saved file of a reversed bus and of one alias for all" {
	FAKE_BUS=reversed ethercat bus save "$BATS_TEST_TMPDIR/reversed"
	cat "$BATS_TEST_TMPDIR/reversed"
	[ "$(FAKE_BUS=reversed ethercat bus check "$BATS_TEST_TMPDIR/reversed")" = \
		"no difference, 3 slave(s)" ]
	export FAKE_ALIAS=7
	run ethercat bus save "$BATS_TEST_TMPDIR/alias"
	[ "$status" -eq 0 ]
	[[ $output == *"slave 1 has alias 7, as another slave before it; the bus file omits it"* ]]
	[ "$(grep -c 'alias: 7' "$BATS_TEST_TMPDIR/alias")" = 1 ]
	[ "$(out bus check "$BATS_TEST_TMPDIR/alias")" = "no difference, 3 slave(s)" ]
}
