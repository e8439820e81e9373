#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# A page with all that is known of a bus.

load common

setup() { page=$BATS_TEST_TMPDIR/page.html; }

report() { "$HERE/build/fake/ethercat" report -o "$page" "$@"; }

# page EXPRESSION: "text" is the text of the page, "tags" the tags with their attributes. Each tag
# is ended, nothing is outside of the page, and there are no scripts.
page() {
	python3 - "$1" "$page" <<-'END'
	import re, sys
	from html.parser import HTMLParser
	class Page(HTMLParser):
	    def __init__(self):
	        super().__init__()
	        self.open, self.tags, self.parts = [], [], []
	    def handle_starttag(self, tag, attrs):
	        self.tags.append((tag, dict(attrs)))
	        if tag != 'meta':
	            self.open.append(tag)
	    def handle_startendtag(self, tag, attrs):
	        self.tags.append((tag, dict(attrs)))
	    def handle_endtag(self, tag):
	        assert self.open and self.open[-1] == tag, (tag, self.open)
	        self.open.pop()
	    def handle_data(self, data):
	        self.parts.append(data)
	source = open(sys.argv[2], encoding='utf-8').read()
	p = Page()
	p.feed(source)
	p.close()
	text, tags = ' '.join(' '.join(p.parts).split()), p.tags
	assert not p.open, p.open
	known = set('html head meta title style body h1 h2 p table tr th td'.split() +
	            'svg g rect text tspan path'.split())
	assert {t for t, a in tags} <= known, {t for t, a in tags} - known
	outside = {k for t, a in tags for k in a
	           if k in ('src', 'href', 'data', 'action') or k[:2] == 'on'}
	assert not outside and '://' not in source
	assert 'url(' not in source and '@import' not in source
	assert not re.search('[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]', source)
	assert eval('(' + sys.argv[1] + ')'), text
	END
}

@test "report shows bus, faults, cycle, clocks, errors, settings and log without network" {
	mkdir -p "$BATS_TEST_TMPDIR/sys/module/ec_master/parameters"
	echo 64 >"$BATS_TEST_TMPDIR/sys/module/ec_master/parameters/max_acyclic"
	export FAKE_SYS=$BATS_TEST_TMPDIR/sys
	FAKE_BUS=app FAKE_UNITS=1 report
	page '"EtherCAT Master0" in text and "2 EL7201 servo terminal" in text'
	page 'len([t for t in tags if t[0] == "svg"]) == 2'
	page '[a["class"] for t, a in tags if t == "rect" and a["class"].startswith("box")] ==
		["box other", "box preop", "box preop", "box error"]'
	page '"PREOP+ERROR" in text and "Fault: " in text and "Remedy: " in text'
	page '"port 0: 300 invalid, 7 receiver" in text'
	page '"Slaves whose counters were not read: 1." in text'
	page '"ec_master max_acyclic 64" in text and "Reference clock: slave 0." in text'
	page '"scan" in text[text.index("Log Time"):]'
	page '"Sync units" in text and "axes" in text and "Domains" in text'
	page '"Module 0.1.0" in text and "Kernel Linux" in text'
	FAKE_BUS=dc report -f
	page '"outside window (1000 ns)" in text'
	FAKE_BUS=two report -f
	page '"EtherCAT Master0" in text and "EtherCAT Master1" in text'
}

@test "report causes no frame and needs no write permission" {
	# as the master has read them; from the registers it would be 3
	report
	page '"255 invalid frame(s)" in text'
	FAKE_READONLY=1 report -f
	FAKE_LOG=$BATS_TEST_TMPDIR/log report -f
	[ ! -s "$BATS_TEST_TMPDIR/log" ]
}

@test "names of slaves cannot break the page" {
	FAKE_BUS=evil report
	page '"Größe" in text'
	FAKE_ORDER=$'</td><script src="//x">\377' report -f
	page '"</td><script src=\"//x\">\u00ff" in text'
	FAKE_ORDER="\"><img onerror='x'&lt;" report -f
	page "'\"><img onerror=\\'x\\'&lt;' in text"
}

@test "report draws each bus, also a large one and ports that contradict each other" {
	for b in empty waiting idle tree loop reversed cut held big; do
		FAKE_BUS=$b report -f
		page 'text.count("EtherCAT Master0") == 1'
	done
	page 'len([t for t, a in tags if t == "rect"]) == 1001'
	FAKE_ABSENT=1 report -f
	page '"behind port 2 of slave 0 EK1100: 7 slaves disconnected, since 3.1 s" in text'
}

@test "report replaces a file with --force only, and only by a whole page" {
	echo mine >"$page"
	run report
	echo "$output"
	[ "$status" = 1 ]
	[[ $output == *"'$page' exists; replace it with --force"* ]]
	grep -qx mine "$page"
	ln -s nowhere "$BATS_TEST_TMPDIR/link"
	run "$HERE/build/fake/ethercat" report -o "$BATS_TEST_TMPDIR/link"
	[ "$status" = 1 ]
	FAKE_BUS=none run report -f
	[ "$status" = 1 ]
	grep -qx mine "$page"
	run "$HERE/build/fake/ethercat" report -f -o /dev/full
	[ "$status" = 1 ]
	[[ $output == *"cannot write '/dev/full'"* ]]
	report -f --json | json 'd["file"].endswith("page.html")'
	page 'text'
	run "$HERE/build/fake/ethercat" report
	[ "$status" = 1 ]
	[[ $output == *"missing option --output-file"* ]]
	[ "$(ls "$BATS_TEST_TMPDIR" | grep -c 'page.html')" = 1 ]
}
