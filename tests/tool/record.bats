#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# Recordings, and their drawings.

load common

setup() {
	export FAKE_BUS=run
	cd "$BATS_TEST_TMPDIR"
}

# refused STATUS TEXT COMMAND...
refused() {
	run ethercat "${@:3}"
	echo "$output"
	[ "$status" = "$1" ] && [[ $output == *"$2"* ]]
}

# columns FILE: of a CSV file, without times
columns() { grep -v '^#' "$1" | cut -d, -f3-; }

# npy FILE: the rows of an array as CSV, by the description in its header alone
npy() {
	python3 - "$1" <<-'END'
	import ast, struct, sys
	d = open(sys.argv[1], 'rb').read()
	assert d[:8] == b'\x93NUMPY\x02\x00', d[:8]
	n = struct.unpack('<I', d[8:12])[0]
	assert (12 + n) % 64 == 0 and d[11 + n:12 + n] == b'\n'
	h = ast.literal_eval(d[12:12 + n].decode())
	assert list(h) == ['descr', 'fortran_order', 'shape'] and not h['fortran_order'], h
	letters = {'f8': 'd', 'f4': 'f', 'b1': '?', 'u1': 'B', 'u2': 'H', 'u4': 'I', 'u8': 'Q',
	           'i1': 'b', 'i2': 'h', 'i4': 'i', 'i8': 'q'}
	form = '<' + ''.join(letters[t[1:]] for _, t in h['descr'])
	print(','.join(i[1] if isinstance(i, tuple) else i for i, _ in h['descr']))
	rows = list(struct.iter_unpack(form, d[12 + n:]))
	assert (len(rows),) == h['shape'], (len(rows), h['shape'])
	for r in rows:
	    print(','.join('%.9f' % v if i == 0 else str(int(v)) for i, v in enumerate(r)))
	END
}

@test "record writes each cycle as a line, until the session ends" {
	run ethercat record 'el2008.*' el7201.position -o a.csv
	echo "$output"
	[ "$status" = 0 ]
	[[ $output == *"Master0: the session has ended"* ]]
	[[ $output == *"Master0: 20 record(s) of 3 value(s) in 0.019 s, 0 lost" ]]
	head -n 1 a.csv | grep -qE 'record: time 0 is [0-9]{4}-[0-9-]*T[0-9:.]*Z, master 0, wc: 2 '
	[ "$(sed -n 2p a.csv)" = time_s,app_time_ns,cycle,lost,wc,el2008.channel_1.output,\
el2008.channel_2.output,el7201.position ]
	[ "$(sed -n '3,6p' a.csv)" = '0.000000000,0,100,0,2,0,0,4294967294
0.001000000,1000000,101,0,2,0,0,4294967295
0.002000000,2000000,102,0,1,0,0,0
0.003000000,3000000,103,0,2,0,0,1' ]
	[ "$(tail -n 1 a.csv)" = 0.019000000,19000000,119,0,2,1,0,17 ]
	# stdout without a file
	[ "$(out record el7201.position | grep -vc '^#')" = 21 ]
	FAKE_READONLY=1 out record el7201.position >out
	out record el7201.position -o b.csv --json |
		json '(d["records"], d["values"], d["lost"], d["ring_records"]) == (20, 1, 0, 5000)'
	FAKE_BUS=idle refused 1 "no application and no 'ethercat run'" record '*'
	FAKE_RECORD_REFUSED=1 refused 1 'at most 16 programs record' record '*' -o c.csv
	[ ! -e c.csv ]
}

@test "record writes an array for numpy.load() with the same values" {
	out record '*' -o a.csv
	out record '*' -o a.npy
	[ "$(npy a.npy)" = "$(grep -v '^#' a.csv)" ]
	if python3 -c 'import numpy' 2>/dev/null; then
		python3 -c 'import numpy
a = numpy.load("a.npy")
assert (a["el7201.position"][3], len(a)) == (1, 20), a'
	fi
}

@test "record marks missing records and counts them" {
	run env FAKE_RECORD_GAP=5 "$HERE/build/fake/ethercat" record el7201.position -o a.csv
	[[ $output == *"17 record(s) of 1 value(s) in 0.019 s, 3 lost: this program was too slow" ]]
	columns a.csv | sed -n 6,7p >got
	[ "$(cat got)" = '104,0,2,2
108,3,2,6' ]
	# nothing is missing before the first row
	FAKE_RECORD_GAP=0 out record el7201.position --count 1 -o b.csv
	[ "$(columns b.csv | tail -n 1)" = 103,0,2,1 ]
}

@test "record fails when the end of a session was dropped, and leaves a valid file" {
	FAKE_RECORD_DROPPED=1 refused 1 'the session has ended, and what was not read was dropped' \
		record el7201.position -o a.csv
	[[ $output == *"Master0: 20 record(s) of 1 value(s) in 0.019 s, 0 lost"* ]]
	[ "$(grep -vc '^[#t]' a.csv)" = 20 ]
}

@test "record --when begins at the condition, with records before it" {
	out record el7201.position -o a.csv --when 'el7201.position == 5' --before 0.002 \
		--after 0.001
	[ "$(cut -d, -f1,6 a.csv | tail -n +3)" = '-0.002000000,3
-0.001000000,4
0.000000000,5
0.001000000,6' ]
	# a value that is in the condition only is no column
	out record el7201.position -o b.csv --when 'el2008.channel_1.output' --count 2
	[ "$(columns b.csv)" = 'cycle,lost,wc,el7201.position
105,0,2,3
106,0,2,4' ]
	refused 1 'the condition was never true: nothing is written' \
		record el7201.position -o c.csv --when 'el7201.position == 99'
	[ ! -e c.csv ]
	refused 1 '--before and --after need --when' record '*' --before 1
}

# first CONDITION: the position of the first record in which it is true
first() { out record el7201.position --count 1 --when "$1" | tail -n 1 | cut -d, -f6; }

@test "record --count counts from the condition on, and the summary is of the file" {
	run ethercat record el7201.position -o a.csv --when 'el7201.position == 5' --before 0.002 \
		--count 1
	[[ $output == *"Master0: 3 record(s) of 1 value(s) in 0.002 s, 0 lost" ]]
	[ "$(cut -d, -f1,6 a.csv | tail -n 1)" = 0.000000000,5 ]
}

@test "conditions have operators of C, with & ^ | before comparisons" {
	[ "$(first 'el7201.position & 8 == 8 && el7201.position < 1000')" = 8 ]
	[ "$(first '(el7201.position & 3) + 1 == 3 && el7201.position < 0x100')" = 2 ]
	[ "$(first 'el7201.position - 7 == -3')" = 4 ]
	[ "$(first 'el7201.position < 2.5')" = 0 ]
	[ "$(first '!el2008.channel_1.output ^ 1')" = 3 ]
	[ "$(first '~el7201.position & 0xffffffff == 0xfffffff4 || 0')" = 11 ]
	[ "$(first 'el7201.position>=4 & 5')" = 4294967294 ]
	[ "$(first 'el7201.position | 1 == 5')" = 4 ]
	[ "$(first 'el7201.position > 1e-3 && el7201.position < 1.5e+1')" = 1 ]
	[ "$(first '0x1e-3 == el7201.position + 10')" = 17 ]
	[ "$(first '~el7201.position == -6')" = 5 ]
	[ "$(first 'el7201.position == ~-5 | ~-3')" = 6 ]
	[ "$(first '(~1 & -1) + 6 == el7201.position')" = 4 ]
	[ "$(FAKE_SII=1 first 'el7201.controlword == 15')" = 4294967294 ]
}

@test "a wrong condition is refused with its column" {
	wrong() { refused 1 "--when, column $1" record '*' --when "$2"; }
	wrong '20: expected a name or a number' 'el7201.position == )'
	wrong '19: it ends too early' 'el7201.position + '
	wrong "17: expected ')'" '(el7201.position'
	wrong '17: expected an operator' 'el7201.position 5'
	wrong '1: expected a name or a number' '#'
	wrong '1: it ends too early' ''
	refused 1 'did you mean el7201.position?' record '*' --when 'el7201.positio > 1'
	wrong '65: too deep' "$(printf '(%.0s' {1..100})1"
	refused 1 'too long a condition' record '*' --when "$(printf '1+%.0s' {1..200})1"
}

@test "record refuses wrong names, numbers, and a file that exists" {
	refused 1 'did you mean el7201.position?' record el7201.positio
	refused 1 "invalid number '0' for --count" record '*' --count 0
	refused 1 "invalid time 'x' for --time" record '*' --time x
	echo before >a.csv
	refused 1 "'a.csv' exists; use another name, or --force to replace it" record '*' -o a.csv
	[ "$(cat a.csv)" = before ]
	out record el7201.position --count 3 -o a.csv --force
	[ "$(wc -l <a.csv)" = 5 ]
	[ "$(ls)" = a.csv ]
	refused 1 'No such file or directory' record '*' -o none/a.csv
	# nothing replaces a file when nothing was recorded
	refused 1 'never true' record '*' -o a.csv -f --when 0
	[ "$(wc -l <a.csv)" = 5 ]
}

@test "record --force replaces files only: devices, pipes and targets of links are written" {
	echo before >old
	chmod 600 old
	ln -s old link
	out record el7201.position --count 3 -o link --force
	[ -L link ] && [ "$(wc -l <old)" = 5 ]
	out record el7201.position --count 2 -o old -f
	[ "$(stat -c %a old) $(wc -l <old)" = '600 4' ]
	mkfifo pipe
	cat pipe >got &
	out record el7201.position --count 3 -o pipe -f
	wait $!
	[ -p pipe ] && [ "$(wc -l <got)" = 5 ]
	refused 1 'never true' record '*' -o link -f --when 0
	[ -L link ]
	mkdir dir
	refused 1 "cannot write 'dir': Is a directory" record '*' -o dir -f
	[ "$(echo *)" = 'dir got link old pipe' ]
}

@test "record into a program that does not read is ended by a signal" {
	FAKE_RECORDS=1000000000 python3 - "$HERE/build/fake/ethercat" <<-'END'
	import array, fcntl, os, subprocess, sys, termios, time
	r, w = os.pipe()
	p = subprocess.Popen([sys.argv[1], 'record', '*'], stdout=w, stderr=subprocess.PIPE)
	n, last = array.array('i', [0]), [-1]
	# full: no more bytes for a while
	while n[0] < 4096 or last.count(n[0]) < 20:
	    last.append(n[0])
	    fcntl.ioctl(r, termios.FIONREAD, n)
	    assert p.poll() is None and len(last) < 2000
	    time.sleep(0.01)
	p.terminate()
	try:
	    text = p.communicate(timeout=20)[1].decode()
	finally:
	    p.kill()
	assert p.returncode == 2 and "cannot write 'stdout': its reader does not read" in text, text
	END
}

@test "record --time ends it when no record comes" {
	mkfifo silent
	# the number of the descriptor is the one of the fake master, which is never readable
	run timeout 20 "$HERE/build/fake/ethercat" record '*' --time 0.1 100<>silent
	echo "$output"
	[ "$status" = 1 ] && [[ $output == *'no cycle was sent: nothing is written' ]]
}

@test "record writes units and scaled values of the bus file of the session" {
	cat >names <<-'END'
	ethercat: 1
	masters:
	  - slaves:
	      - {name: lamps, vendor: 2, product: 0x07d83052}
	      - name: axis
	        vendor: 2
	        product: 0x1c213052
	        pdos:
	          - index: 0x1a00
	            sm: 3
	            entries: [{object: "0x6000:11", bits: 32, name: position, type: int32, unit: "'°\"", scale: 0.1, offset: 1}]
	END
	export FAKE_NAMES=$PWD/names
	out record axis.position -o a.csv --when 'axis.position > 1.25' --count 2
	[ "$(columns a.csv)" = $'cycle,lost,wc,"axis.position [\'°""]"
105,0,2,1.3
106,0,2,1.4' ]
	LC_ALL=C.UTF-8 out plot a.csv | grep -qx "axis.position \['°\"\]"
	cp names bus.yaml
	FAKE_NAMES= out record axis.position --file bus.yaml --count 1 | tail -n 1 | grep -q ',0.8$'
	out record axis.position -o a.npy --when 'axis.position > 1.25' --count 2
	LC_ALL=C.UTF-8 out plot a.npy | grep -qx 'axis.position \[?°"\]'
	LC_ALL=C.UTF-8 out plot a.npy | grep -q '^ *1.4 |'
	if python3 -c 'import numpy' 2>/dev/null; then
		python3 -c 'import numpy
a = numpy.load("a.npy")
assert abs(a["axis.position"][1] - 1.4) < 1e-9, a'
	fi
}

@test "a full disk leaves a valid file, and record says how much" {
	# a file may have 4096 bytes
	limited() {
		(
			trap '' XFSZ
			ulimit -f 4
			FAKE_RECORDS=1000000 "$HERE/build/fake/ethercat" record el7201.position \
				-o "$1" 2>err
		)
	}
	run limited a.csv
	[ "$status" = 2 ]
	grep -q "cannot write 'a.csv': File too large; it is valid and has [0-9]* bytes" err
	[ "$(tail -c 1 a.csv | od -An -c | tr -d ' ')" = '\n' ]
	grep -q " has $(stat -c %s a.csv) bytes" err
	[ "$(grep -v '^#' a.csv | awk -F, 'NF != 6' | wc -l)" = 0 ]
	run limited a.npy
	[ "$status" = 2 ]
	npy a.npy >rows
	[ "$(wc -l <rows)" -gt 50 ]
	run bash -c "FAKE_RECORDS=100000 '$HERE/build/fake/ethercat' record '*' >/dev/full"
	[ "$status" = 2 ]
}

@test "record ends by Ctrl-C with a complete file" {
	FAKE_RECORDS=1000000000 "$HERE/build/fake/ethercat" record el7201.position -o a.npy 2>err &
	until [ "$(stat -c %s a.npy 2>/dev/null || echo 0)" -gt 100000 ]; do
		kill -0 $!
		sleep 0.05
	done
	kill -TERM $!
	wait $!
	npy a.npy >rows
	grep -q 'record(s) of 1 value(s)' err
}

@test "plot draws values one above the other, and marks gaps" {
	local i
	FAKE_RECORD_GAP=10 out record el2008.channel_1.output el7201.position -o a.csv \
		--when 'el7201.position == 0'
	LC_ALL=C out plot a.csv >text
	cat text
	[ "$(sed -n 1p text)" = el2008.channel_1.output ]
	sed -n 4p text | grep -qx el7201.position
	grep -q '^ *17 |' text
	grep -q '+-.*xxxx.*-' text
	grep -q 'time \[s\], 0 is 2.*Z; x: records missing' text
	awk 'length($0) > 79 { exit 1 }' text
	! grep -q $'\e' text || return 1
	LC_ALL=C.UTF-8 out plot a.csv | grep -q '⣀'
	[ "$(LC_ALL=C out plot a.csv 'el7201.*')" = "$(sed -n '4,$p' text)" ]
	FAKE_RECORD_GAP=10 out record el2008.channel_1.output el7201.position -o a.npy \
		--when 'el7201.position == 0'
	diff <(LC_ALL=C out plot a.npy | head -n -1) <(head -n -1 text)
	out plot a.csv -o a.svg
	python3 - a.svg <<-'END'
	import sys, xml.etree.ElementTree as e
	r = e.parse(sys.argv[1]).getroot()
	n = '{http://www.w3.org/2000/svg}'
	names = [t.text for t in r.iter(n + 'text') if t.get('class') == 'name']
	assert names == ['el2008.channel_1.output', 'el7201.position'], names
	gaps = [t for t in r.iter(n + 'rect') if t.get('class') == 'gap']
	assert len(gaps) == 2 and gaps[0][0].text == '3 records are missing', gaps
	lines = [t for t in r.iter(n + 'polyline')]
	assert len(lines) == 4, lines
	END
	out plot - <a.csv >stdin
	out plot a.csv | cmp - stdin
}

@test "plot reads other files, and names the wrong line" {
	printf 'a,"b, ""c"" [mm]"\r\n1,2\r\n3,4' >a.csv
	LC_ALL=C out plot a.csv >text
	grep -qx 'b, "c" \[mm\]' text
	grep -q row text
	wrong() { printf "$2" >b.csv; refused 1 "b.csv$1" plot b.csv; }
	wrong ': line 3 has 1 column(s), its header 2' 'a,b\n1,2\n3\n'
	wrong ': line 2 has more columns than its header, 1' 'a\n1,2\n'
	wrong ": line 2, column 2: 'x' is no number" 'a,b\n1,x\n'
	wrong ' is empty' ''
	wrong ' has no records' 'a,b\n'
	wrong ' is no array' '\x93NUMPY\x01\x00\x05\x00[1,2]'
	wrong ' is no array' '\x93NUMPY\x02\x00\xff\xff\xff\xff{}'
	refused 1 "cannot read 'none.csv'" plot none.csv
	printf 'speed,b\n1,2\n' >b.csv
	refused 1 'b.csv has no value sped; did you mean speed?' plot b.csv sped
	out record '*' -o a.npy
	truncate -s -10 a.npy
	refused 1 'a.npy ends after 19 of 20 rows' plot a.npy
}

@test "plot draws large numbers, a byte order mark, and many gaps" {
	printf 'time_s,v\n0,1.7e308\n1,-1.7e308\n' >a.csv
	LC_ALL=C out plot a.csv >text
	grep -qE '^ *4.49\S*e\+307 [|]' text
	printf 'time_s,v\n-1.7e308,1\n1.7e308,2\ninf,3\n' >a.csv
	ethercat plot a.csv -o a.svg
	! grep -qE 'nan|inf' a.svg || return 1
	printf '\xef\xbb\xbftime_s,v\n0,1\n5,2\n' >a.csv
	out plot a.csv | grep -q 'time \[s\]'
	awk 'BEGIN { print "time_s,lost,v"; for (i = 0; i < 9999; i++) print i ",1," i % 2 }' >a.csv
	ethercat plot a.csv -o a.svg --force
	[ "$(stat -c %s a.svg)" -lt 100000 ]
	grep -q '>9999 records are missing<' a.svg
}

@test "plot prints no escape sequence of a recording" {
	export LC_ALL=C
	printf '# time 0 is \x9b2J\xc2\x9b2J\e[2J,\na\x9b2J\xc2\x9b\e\n1\n2\n' >a.csv
	ethercat plot a.csv >text
	printf 'a\n\x9b2J\xc2\x9b\e[\n' >a.csv
	ethercat plot a.csv 2>>text && return 1
	printf "\x93NUMPY\1\0\x60\0%-96s12345678" "{'descr': [(('seconds since "$'\e\xc2\x9b'"2J', \
'time_s'), '<f8'), ], 'fortran_order': False, 'shape': (1,), }" >a.npy
	ethercat plot a.npy time_s >>text
	cat -v text
	! grep -q $'[\x80-\x9f\e]' text || return 1
	[ "$(grep -c '?' text)" = 4 ]
}

@test "plot replaces files only with --force, and the recording never" {
	out record el7201.position -o a.csv
	cp a.csv b.csv
	ln -s a.csv link
	refused 1 "'a.csv' is the recording; use another name" plot a.csv -o a.csv
	refused 1 "'a.csv' is the recording; use another name" plot link -o a.csv --force
	refused 1 "is the recording" plot - -o a.csv --force <a.csv
	refused 1 "'b.csv' exists; replace it with --force" plot a.csv -o b.csv
	cmp a.csv b.csv
	ethercat plot a.csv -o b.csv --force --json |
		json '(d["file"], d["values"], d["records"]) == ("b.csv", 1, 20)'
	refused 1 '--json needs --output-file' plot a.csv --json
	grep -q '<svg' b.csv
}
