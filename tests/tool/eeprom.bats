#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only

load common

# image NAME: a small valid one, of vendor 2
image() {
	python3 - "$BATS_TEST_TMPDIR/$1" <<'END'
import struct, sys
head = struct.pack("<7H", 0x0c05, 0, 0, 0, 5, 0, 0)
crc = 0xff
for byte in head:
    crc ^= byte
    for _ in range(8):
        crc = (crc << 1 ^ (0x07 if crc & 0x80 else 0)) & 0xff
img = bytearray(0x80)
img[:14] = head
img[14] = crc
struct.pack_into("<4I", img, 16, 2, 0x1c213052, 0x10000, 7)
struct.pack_into("<4H", img, 0x30, 0x1000, 128, 0x1080, 128)
struct.pack_into("<H", img, 0x38, 0x0c)
struct.pack_into("<2H", img, 0x7c, 15, 1)
strings = b"\x02\x06EL7201\x07Out<&\"]"
general = bytearray(32)
general[2], general[3], general[5] = 1, 2, 0x0d
sm = struct.pack("<HHBBBB", 0x1000, 128, 0x26, 0, 1, 1)
sm += struct.pack("<HHBBBB", 0x1080, 128, 0x22, 0, 1, 2)
pdo = struct.pack("<HBBBBH", 0x1600, 1, 2, 0, 2, 0)
pdo += struct.pack("<HBBBBH", 0x7010, 1, 2, 6, 16, 0)
dc = struct.pack("<IIIhHhBB4x", 0, 0, 0, 0, 0x0300, 1, 2, 0)
for kind, data in ((10, strings), (30, bytes(general)), (41, sm), (51, pdo), (60, dc)):
    data += b"\0" * (len(data) % 2)
    img += struct.pack("<2H", kind, len(data) // 2) + data
img += b"\xff\xff"
open(sys.argv[1], "wb").write(img)
END
}

@test "alias writes the alias of one slave" {
	[ "$(log_of alias -p2 7)" = "alias 2: 7, flags 0x0" ]
	[ "$(log_of alias 7 -p 2 --force --repair-checksum)" = "alias 2: 7, flags 0x5" ]
	[ "$(log_of alias -p2 0)" = "alias 2: 0, flags 0x0" ]
	[ -z "$(out alias -p2 7)" ]
	[[ $(err alias -p2 7) == *"this master uses the alias now; register 0x0012 has 0 until the slave is switched off and on"* ]]
	[ -z "$(FAKE_RELOAD=1 err alias -p2 7)" ]
	[ -z "$(err alias -q -p2 7)" ]
	[[ $(FAKE_RUNS=1 err alias -f -p2 7) == *"after the slave has left SAFEOP and OP and a rescan"* ]]
}

@test "alias: several slaves need --force, none is a failure" {
	run ethercat alias 7
	[ "$status" -eq 1 ]
	[[ $output == *"3 slaves are selected"*"--force"* ]]
	[ "$(log_of alias -f -q 7 | wc -l)" -eq 3 ]
	run ethercat alias -p9 7
	[ "$status" -eq 1 ]
	[[ $output == *"matches no slave"* ]]
	FAKE_BUS=empty run ethercat alias 7
	[ "$status" -eq 1 ]
	for v in 65536 -1 x 1x ""; do
		run ethercat alias -p2 "$v"
		[ "$status" -eq 1 ]
	done
}

@test "alias: a refusal has its reason, a reader is refused" {
	FAKE_REFUSE=1 run ethercat alias -p2 7
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 2: cannot write the alias: "*"the slave is in OP"* ]]
	FAKE_READONLY=1 run ethercat alias -p2 7
	[ "$status" -eq 1 ]
	out alias -p2 7 -j | json 'd["slaves"] == [
		{"position": 2, "alias": 7, "in_register": False, "renewed": True}]'
}

@test "sii_write writes a file or stdin" {
	image a
	local size
	size=$(stat -c %s "$BATS_TEST_TMPDIR/a")
	[[ $(log_of sii_write -p2 "$BATS_TEST_TMPDIR/a") == "sii_write 2: $size bytes, checksum 0x"*", flags 0x0" ]]
	[ -z "$(ethercat sii_write -p2 "$BATS_TEST_TMPDIR/a" 2>&1)" ]
	[[ $(log_of sii_write -p2 - <"$BATS_TEST_TMPDIR/a") == "sii_write 2: $size bytes"* ]]
	[[ $(log_of sii_write -f --allow-unreachable -p2 "$BATS_TEST_TMPDIR/a") == *"flags 0x3" ]]
	[[ $(log_of sii_write --dry-run -p2 "$BATS_TEST_TMPDIR/a") == *"flags 0x8" ]]
	[[ $(err sii_write --dry-run -p2 "$BATS_TEST_TMPDIR/a") == *"3 word(s) differ, none was written"* ]]
	[[ $(err sii_write -v -p2 "$BATS_TEST_TMPDIR/a") == *"$size byte(s) read"*"3 word(s) written and read back"* ]]
	[[ $(FAKE_RUNS=1 err sii_write -f -p2 "$BATS_TEST_TMPDIR/a") == *"after the slave has left SAFEOP and OP"* ]]
	out sii_write -j -p2 "$BATS_TEST_TMPDIR/a" | json 'd["words_written"] == 3 and d["renewed"]'
}

@test "sii_write repairs the checksum of the file on request" {
	image a
	printf '\0' | dd of="$BATS_TEST_TMPDIR/a" bs=1 seek=14 conv=notrunc status=none
	[[ $(log_of sii_write -p2 "$BATS_TEST_TMPDIR/a") == *"checksum 0x00"* ]]
	[[ $(log_of sii_write --repair-checksum -p2 "$BATS_TEST_TMPDIR/a") != *"checksum 0x00"* ]]
}

@test "sii_write refuses several slaves, an empty and an absent file, and gives the reason" {
	image a
	for c in "sii_write $BATS_TEST_TMPDIR/a" "sii_write -p2 /dev/null" "sii_write -p2 /nonexistent" \
		"sii_write -p2"; do
		run ethercat $c
		[ "$status" -eq 1 ]
	done
	FAKE_REFUSE=1 run ethercat sii_write -p2 "$BATS_TEST_TMPDIR/a"
	[ "$status" -eq 1 ]
	[[ $output == *"Master0 slave 2: cannot write the EEPROM: "*"moves the mailboxes"* ]]
}

@test "sii_read decodes a saved image without a master" {
	image a
	FAKE_BUS=none golden sii_decode sii_read --file "$BATS_TEST_TMPDIR/a"
	out sii_read --file "$BATS_TEST_TMPDIR/a" -j | json '(d["checksum_ok"] and d["complete"] and
		d["pdos"][0]["entries"][0]["size_bits"] == 16 and
		d["dc_modes"][0]["assign_activate"] == 0x300)'
	[[ $(out sii_read --file - -v <"$BATS_TEST_TMPDIR/a") == "SII Area:"*"SII Category 0x003c (DC)"* ]]
	[[ $(out sii_read -p2 --decode) == *"Vendor Id:       0x00000002"* ]]
	run ethercat sii_read -p2 --file "$BATS_TEST_TMPDIR/a"
	[ "$status" -eq 1 ]
}

@test "sii_read decodes cut and random images" {
	image a
	for n in 1 2 15 64 127 128 130 150 170 200; do
		head -c "$n" "$BATS_TEST_TMPDIR/a" >"$BATS_TEST_TMPDIR/b"
		run ethercat sii_read --file "$BATS_TEST_TMPDIR/b"
		[ "$status" -eq 0 ]
		head -c 4096 /dev/urandom >"$BATS_TEST_TMPDIR/c"
		run ethercat sii_read --file "$BATS_TEST_TMPDIR/c"
		[ "$status" -eq 0 ]
	done
}

@test "xml is well-formed, for one slave and for several" {
	golden xml xml -p2
	out xml -p2 | python3 -c '
import sys, xml.etree.ElementTree as e
r = e.parse(sys.stdin).getroot()
assert r.tag == "EtherCATInfo", r.tag
d = r.find("Descriptions/Devices/Device")
assert d.find("Type").get("ProductCode").startswith("#x")
assert [x.find("Index").text for x in d.findall("RxPdo")]
'
	out xml | python3 -c '
import sys, xml.etree.ElementTree as e
r = e.parse(sys.stdin).getroot()
assert r.tag == "EtherCATInfoList" and len(r) == 3
'
	out xml -j | json '[s["position"] for s in d["slaves"]] == [0, 1, 2]'
}
