#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

# abbreviation -> command, as the help shows it
resolves() {
	run real help "$1"
	[ "$status" -eq 0 ]
	[[ ${lines[0]} == "Usage: ethercat $2 "* ]]
}

ambiguous() {
	run real "$1"
	[ "$status" -eq 1 ]
	[[ $output == *"'$1' is ambiguous: "* ]]
}

@test "common abbreviations select their commands" {
	resolves sl slaves
	resolves slave slaves
	resolves slv slaves
	resolves mas master
	resolves m master
	resolves ver version
	resolves v version
	resolves st states
	resolves up upload
	resolves u upload
	resolves dow download
	resolves deb debug
	resolves dom domains
	resolves da data
	resolves g graph
	resolves cr crc
	resolves cs cstruct
	resolves con config
	resolves p pdos
	resolves reg_r reg_read
	resolves res rescan
	resolves sii_r sii_read
	resolves di domains
	resolves i ip
	resolves al alias
	resolves x xml
	resolves sii_w sii_write
}

@test "new names resolve behind the historic ones" {
	resolves help help
	resolves he help
	resolves rel release
	resolves sdo_r upload
	resolves sdo_up upload
	resolves sdo_d download
	resolves sdo_write download
}

@test "several candidates are listed" {
	ambiguous s
	ambiguous d
	ambiguous re
	ambiguous sr
	run real re
	[[ $output == *"reg_read, reg_write, rescan"* ]]
}

@test "abbreviations of commands" {
	# the field's commands come first
	[[ $(real sdo 2>&1) == "ethercat sdos: "* ]]
	run real sdo_
	[ "$status" -eq 1 ]
	[[ $output == *"'sdo_' is ambiguous: sdo_download, sdo_read, sdo_upload, sdo_write"* ]]
	run real help sdo_
	[ "$status" -eq 1 ]
	[[ $output == *"'sdo_' is ambiguous: sdo_download, sdo_read, sdo_upload, sdo_write"* ]]
}

@test "unknown command, no command, help" {
	run real nonsense
	[ "$status" -eq 1 ]
	[[ ${lines[0]} == *"unknown command 'nonsense'" ]]
	for c in slvaes sdo_uplaod salves masters resacn vresion; do
		[[ $(real $c 2>&1) == "ethercat: unknown command '$c'; did you mean '"*"'?"* ]]
		[ "$(real help $c 2>&1 | head -n 1 | cut -d: -f2-)" = "$(real $c 2>&1 | head -n 1 | cut -d: -f2-)" ]
	done
	[[ $(real slvaes 2>&1) == *"did you mean 'slaves'?"* ]]
	[[ $output == *"Try 'ethercat --help'"* ]]
	run real ""
	[ "$status" -eq 1 ]
	run real
	[ "$status" -eq 1 ]
	[ -z "$(real 2>/dev/null)" ]
	run real --help
	[ "$status" -eq 0 ]
	[ -z "$(real -h 2>&1 >/dev/null)" ]
}

@test "every command has a help with its options and JSON keys" {
	for c in $(real help | awk '/^Options/ { exit } /^  [a-z]/ { print $1 }'); do
		run real "$c" --help
		[ "$status" -eq 0 ]
		[[ ${lines[0]} == "Usage: ethercat $c [OPTIONS]"* ]]
		[[ $output == *"--json"* ]]
		[[ $output == *"JSON: "* ]]
		[ "$(real help "$c")" = "$(real -h "$c")" ]
	done
}

@test "the man page is made of the same tables" {
	diff -u "$HERE/../../tool/ethercat.8" <(real help -s roff)
}

@test "each command and each other name of it has a man page, made of the same tables" {
	local dir=$HERE/../../tool/man c a n=0

	for c in $(real help | awk '/^Options/ { exit } /^  [a-z]/ { print $1 }'); do
		diff -u "$dir/ethercat-$c.8" <(real help -s roff "$c")
		grep -q "^ethercat.*-$c .- " <(sed 's/\\\\//g' "$dir/ethercat-$c.8")
		n=$((n + 1))
		for a in $(real help "$c" | sed -n '/^Also: /{s///;s/,//g;p}'); do
			[ "$(readlink "$dir/ethercat-$a.8")" = "ethercat-$c.8" ]
			grep -q "^.B ethercat $a\$" "$dir/ethercat-$a.8"
			n=$((n + 1))
		done
	done
	[ "$(ls "$dir" | wc -l)" = $n ]
	! command -v man >/dev/null || for f in "$dir"/*.8; do
		[ -z "$(man --warnings -l "$f" 2>&1 >/dev/null)" ]
	done
}

@test "the man page has every command, option and data type" {
	man=$HERE/../../tool/ethercat.8
	real help --json | python3 -c '
import json, re, sys
man = open(sys.argv[1]).read().replace("\\-", "-")
d = json.load(sys.stdin)
assert len(d["commands"]) >= 19 and len(d["options"]) >= 15
section = {}
for part in man.split(".SS ethercat ")[1:]:
    section[part.split()[0]] = part.split("\n.SH ")[0]
for c in d["commands"]:
    text = section.pop(c["name"])
    assert c["summary"] in text and c["arguments"] in text, c["name"]
    for n in c["also"]:
        assert re.search(r"\b%s\b" % n, text), n
    for o in c["options"]:
        assert "--" + o["long"] in text, (c["name"], o)
    for line in c["text"].splitlines():
        assert line in text, (c["name"], line)
assert not section, section
head = man.split(".SH OPTIONS")[1].split(".SH SELECTION")[0]
for o in d["options"]:
    assert "--" + o["long"] in head.replace(".BR ", "").replace("\" \", \" ", ""), o
    assert "short" not in o or "-" + o["short"] in head, o
    assert o["text"] in head, o
' "$man"
	for t in $(real help types | awk '/ bit$| variable$/ { print $1 }'); do
		grep -q "\b$t\b" "$man"
	done
	! command -v man >/dev/null || [ -z "$(man --warnings -l "$man" 2>&1 >/dev/null)" ]
}

@test "install and uninstall" {
	d=$BATS_TEST_TMPDIR/root
	make -s -C "$HERE/../../tool" O="$BATS_TEST_TMPDIR/b" DESTDIR="$d" prefix=/usr install
	files=$(cd "$d" && find . -type f ! -name 'ethercat-*.8' | sort | tr '\n' ' ')
	[ "$files" = "./usr/bin/ethercat \
./usr/share/bash-completion/completions/ethercat ./usr/share/man/man8/ethercat.8 " ]
	[ "$(ls "$d/usr/share/man/man8" | grep -c '^ethercat-.*[.]8$')" = \
		"$(ls "$HERE/../../tool/man" | wc -l)" ]
	[ -f "$d/usr/share/man/man8/ethercat-sdo_upload.8" ]
	# the libraries are packages of their own
	make -s -C "$HERE/../../lib/tools" O="$BATS_TEST_TMPDIR/b" DESTDIR="$d/lib" prefix= install
	make -s -C "$HERE/../../lib/bus" O="$BATS_TEST_TMPDIR/b" DESTDIR="$d/lib" prefix= install
	make -s -C "$HERE/../../lib" O="$BATS_TEST_TMPDIR/b" DESTDIR="$d/lib" prefix= install
	LD_LIBRARY_PATH=$d/lib/lib "$d/usr/bin/ethercat" version
	rm -r "$d/lib"
	[ -z "$(readelf -d "$d/usr/bin/ethercat" | grep RUNPATH)" ]
	make -s -C "$HERE/../../tool" O="$BATS_TEST_TMPDIR/b" DESTDIR="$d" prefix=/usr uninstall
	[ -z "$(find "$d" -type f)" ]
	[ -z "$(cd "$HERE/../../tool" && find . -name '*.o' -not -path './build/*' -not -path './sim-objects/*')" ]
}

@test "version needs no master" {
	run real version
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 1 ]
	[[ $(tr ' ' '\n' <<<"$output" | grep -m1 '[.]') =~ ^[0-9]+\.[0-9]+ ]]
	[ "$(real --version)" = "$output" ]
}

@test "options are accepted at any place" {
	want="0x00000002 2"
	[ "$(ethercat -p2 upload 0x1018 1)" = "$want" ]
	[ "$(ethercat upload -p 2 0x1018 1)" = "$want" ]
	[ "$(ethercat -m 0 upload -p2 -t uint32 0x1018 1)" = "$want" ]
	[ "$(ethercat upload 0x1018 --pos=2 1 --type uint32)" = "$want" ]
	[ "$(ethercat upload 0x1018 1 -vp2)" = "$want" ]
	[ "$(ethercat upload -p2 -- 0x1018 1)" = "$want" ]
	[ "$(ethercat -v slaves)" = "$(ethercat slaves -v)" ]
	[ "$(ethercat slaves -vq)" = "$(ethercat slaves)" ]
	[ "$(ethercat slaves --ver)" = "$(ethercat slaves -v)" ]
}

@test "malformed lists are usage errors" {
	for o in m a p d; do
		for l in x 1x 0x1 1-2-3 "" , "1 2" -- 1.5; do
			run ethercat slaves "-$o" "$l"
			[ "$status" -eq 1 ]
			[[ $output == *"invalid list '$l'"* ]]
			[[ $output == *"--help"* ]]
		done
	done
}

@test "wrong options and arguments are usage errors" {
	for c in "slaves --bogus" "slaves -x" "slaves -p" "slaves --position" "slaves extra" \
		"upload" "upload 1 2 3" "download 1" "slaves -vx" "slaves --verbose=1" \
		"debug 3" "debug x" "states NONE" "graph XY" "crc clear" \
		"pdos -s nope" "upload -p2 -t nope 0x1018 1" "slaves --wait=x" "slaves -v5" \
		"-5" "help nope" "reg_read 0x10000 1" "reg_read 0 0" "reg_read 0" \
		"reg_read -p0 0xffff 2" "reg_read -p0 -tuint16 0 3" "help re"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ ${lines[-1]} == "Try 'ethercat"*"--help'." ]]
		[ "${#lines[@]}" -eq 2 ]
		[ -z "$(out $c)" ]
	done
}

@test "an error in an option names the command, also an abbreviated one, and its help" {
	local words

	for words in "slaves -x" "slav -x" "-x slaves" "-m 0 slaves -p x" "slaves --wait=x"; do
		run ethercat $words
		[ "$status" -eq 1 ]
		[[ ${lines[0]} == "ethercat slaves: "* ]]
		[ "${lines[1]}" = "Try 'ethercat slaves --help'." ]
	done
	run ethercat -x
	[ "${lines[0]}" = "ethercat: unknown option '-x'" ]
	[ "${lines[1]}" = "Try 'ethercat --help'." ]
	err slaves -j -x | json 'd["error"]["command"] == "slaves"'
}

@test "an unknown long option proposes the nearest" {
	[[ $(err slaves --postion=3) == *"unknown option '--postion'; did you mean '--position'?"* ]]
	[[ $(err slaves --bogus) == *"unknown option '--bogus'"$'\n'* ]]
	[[ $(err slaves --co) == *"ambiguous option '--co'"* ]]
}

@test "help shows a letter for an option if the letter works, and only then" {
	local shown l
	shown=$(real help | sed -n 's/^  -\([a-z]\), .*/\1/pI' | tr -d '\n')
	for l in {a..z} {A..Z}; do
		run real version "-$l" 0
		if [[ $shown == *$l* ]]; then
			[[ $output != *"option '-$l'"* ]]
		else
			[ "${lines[0]}" = "ethercat version: unknown option '-$l'" ]
		fi
	done
	[[ $(err slaves --verbose=1) == *"option '--verbose=1' takes no argument"* ]]
}

@test "options without effect only warn" {
	run ethercat slaves -t int8 --force
	[ "$status" -eq 0 ]
	[[ $output == *"--type has no effect"* ]]
	[[ $output == *"--force has no effect"* ]]
	[ "$(out slaves -t int8)" = "$(out slaves)" ]
	[ -z "$(err slaves -a1001 -p0 -m0 -v)" ]
}

@test "negative numbers are values" {
	[ "$(log_of download -p2 -t int8 0x6060 0 -1)" = "sdo 2 0x6060:00 ff" ]
	[ "$(log_of download -p2 -t int8 0x6060 0 -- -1)" = "sdo 2 0x6060:00 ff" ]
	[ "$(log_of download -t int16 0x6060 0 -0x10 -p2)" = "sdo 2 0x6060:00 f0ff" ]
	[ "$(log_of download -t float 0x2000 0 -1.5 -p2)" = "sdo 2 0x2000:00 0000c0bf" ]
	[ "$(log_of download -t float 0x2000 0 -.5 -p2)" = "sdo 2 0x2000:00 000000bf" ]
}

@test "trailing garbage is refused" {
	for c in "upload -p2 2000h 0" "upload -p2 0x1018 1x" "download -p2 -tint8 0x6060 0 12abc" \
		"upload -p2 0x1018:1x" "upload -p2 0x1018:" "upload -p2 0x1018:001" \
		"upload -p2 0x1018:01 1" "upload -p2 0x10180 1" "upload -p2 0x1018 256" \
		"debug 1x"; do
		run ethercat $c
		[ "$status" -eq 1 ]
		[[ $output == *"--help"* ]]
	done
}

@test "a missing device file is reported" {
	export EC_DEVICE_DIR=$BATS_TEST_TMPDIR
	for c in slaves master pdos "upload -p0 1 1" "reg_read 0 1" states rescan "debug 1" crc \
		graph config domains data cstruct sii_read "download -tint8 1 1 1"; do
		run real $c
		[ "$status" -eq 1 ]
		[[ $output == *"$BATS_TEST_TMPDIR/EtherCAT0: No such file or directory"* ]]
		[[ $output == *"modprobe ec_master"* ]]
		[ "${#lines[@]}" -eq 1 ]
	done
	unset EC_DEVICE_DIR
	[ -e /dev/EtherCAT0 ] || [[ $(real slaves 2>&1) == *"/dev/EtherCAT0: No such file"* ]]
}

@test "another device file is refused" {
	ln -s /dev/null "$BATS_TEST_TMPDIR/EtherCAT0"
	EC_DEVICE_DIR=$BATS_TEST_TMPDIR run real slaves
	[ "$status" -eq 1 ]
	[[ $output == *"not a device of this EtherCAT master"* ]]
	FAKE_BUS=foreign run ethercat slaves
	[ "$status" -eq 1 ]
}

@test "a missing permission is reported" {
	FAKE_READONLY=1 run ethercat upload -p2 0x1018 1
	[ "$status" -eq 1 ]
	[[ $output == *"/dev/EtherCAT0: Permission denied"* ]]
	for c in slaves master pdos cstruct config domains data graph "graph dc" "sii_read -p2" \
		states cycle; do
		FAKE_READONLY=1 run ethercat $c
		[ "$status" -eq 0 ]
	done
}

@test "a full disk is an error" {
	[ -e /dev/full ] || skip "no /dev/full"
	run bash -c "'$HERE/build/fake/ethercat' slaves >/dev/full"
	[ "$status" -eq 1 ]
	[[ $output == *"cannot write the output"* ]]
}

@test "completion gives live values" {
	completion_of_fake
	[ "$(complete_line ethercat sl)" = "slaves" ]
	[ "$(complete_line ethercat upload -p "")" = "0 1 2" ]
	[ "$(complete_line ethercat slaves --alias "")" = "1001" ]
	[ "$(complete_line ethercat -p2 states S)" = "SAFEOP" ]
	[ "$(complete_line ethercat datagram FR)" = "FRMW" ]
	[ -z "$(complete_line ethercat datagram FRMW "")" ]
	[[ " $(complete_line ethercat reg_write -) " == *" --emergency "* ]]
	[[ " $(complete_line ethercat upload -t u) " == *" uint24 "* ]]
	[ "$(FAKE_BUS=app complete_line ethercat data -d "")" = "0 1" ]
}

@test "completion keeps names with blanks whole and ends a folder with a slash" {
	completion_of_fake
	# of bash only inside of a completion: it quotes the names and marks the folders
	compopt() { echo "$*" >"$BATS_TEST_TMPDIR/compopt"; }
	cd "$BATS_TEST_TMPDIR"
	mkdir "fold er"
	touch "fo o.bin"
	for line in firmware foe_write "reg_write 0x10" "sdos --save" "crc --texts"; do
		rm -f compopt
		complete_line ethercat $line fo
		[ "${#COMPREPLY[@]}" = 2 ]
		[ "$(printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort)" = "fo o.bin"$'\n'"fold er" ]
		[ "$(cat compopt)" = "-o filenames" ]
	done
}

@test "the commands, options and types of IgH are there, or have a reason" {
	real help --json >"$BATS_TEST_TMPDIR/help"
	real help types --json >"$BATS_TEST_TMPDIR/types"
	"$HERE/../lib/igh.py" commands "$BATS_TEST_TMPDIR/help" "$BATS_TEST_TMPDIR/types"
	# a command that is missing is noticed
	sed 's/"name":"alias"/"name":"other"/; s/"name": "alias"/"name": "other"/' \
		"$BATS_TEST_TMPDIR/help" >"$BATS_TEST_TMPDIR/other"
	run "$HERE/../lib/igh.py" commands "$BATS_TEST_TMPDIR/other" "$BATS_TEST_TMPDIR/types"
	[ "$status" = 1 ]
	[[ $output == "command alias: is missing; "* ]]
}
