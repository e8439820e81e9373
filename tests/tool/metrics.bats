#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-2.0-only
# OpenMetrics text, and its reply to HTTP.

load common

# families EXPRESSION [FILE]: of the parser of Debian's python3-prometheus-client; f(NAME) has the
# samples of a family as {labels: value}, without the label "master" if it is 0
families() {
	/usr/bin/python3 - "$1" "${2:-$BATS_TEST_TMPDIR/metrics}" <<-'END'
	import sys
	from prometheus_client.openmetrics.parser import text_string_to_metric_families as parse
	text = open(sys.argv[2], 'rb').read().decode()
	all = {m.name: m for m in parse(text)}
	def f(name):
	    return {tuple(v for k, v in s.labels.items() if (k, v) != ('master', '0')): s.value
	            for s in all[name].samples}
	assert eval('(' + sys.argv[1] + ')'), {n: f(n) for n in all}
	END
}

metrics() { out metrics "$@" >"$BATS_TEST_TMPDIR/metrics"; }

@test "metrics are OpenMetrics with the values of the other commands" {
	FAKE_BUS=run metrics
	families 'f("ethercat_slaves") == {(): 3} and f("ethercat_cycle_active") == {(): 1}'
	families 'f("ethercat_sent_frames") == {("main", "eth0"): 18342}'
	families 'f("ethercat_sent_bytes") == {("main", "eth0"): 1100520}'
	families 'f("ethercat_lost_frames") == {("main", "eth0"): 2}'
	families 'f("ethercat_cycle_interval_seconds") == {(): 0.001}'
	families 'f("ethercat_cycle_wire_seconds") == {(): 13.44e-6}'
	families 'f("ethercat_domain_working_counter") == {("0",): 5}'
	families 'f("ethercat_domain_expected_working_counter") == {("0",): 5}'
	families 'f("ethercat_slave_al_state")[("2", "PREOP")] == 1'
	families 'sum(f("ethercat_slave_al_state").values()) == 3'
	families 'f("ethercat_slave_al_error") == {("0",): 0, ("1",): 0, ("2",): 1}'
	families 'f("ethercat_session")[("detached",)] == 1'
	families 'all["ethercat_sent_bytes"].unit == "bytes" and all["ethercat_slave"].type == "info"'
	# each name has its help, its type, and the unit at its end
	families 'not [m for m in all.values() if not m.documentation or m.type == "unknown" or
		not m.name.startswith("ethercat_") or not m.name.endswith(m.unit)]'
	[ "$(tail -n 1 "$BATS_TEST_TMPDIR/metrics")" = "# EOF" ]
}

@test "metrics have the send deviation as a histogram, clocks, sync units and emergencies" {
	FAKE_BUS=app metrics
	families 'f("ethercat_send_deviation_seconds")[("+Inf",)] > 0'
	families '[n for n in all if n.startswith("ethercat_cycle_lock")] ==
		["ethercat_cycle_lock", "ethercat_cycle_lock_losses"]'
	families 'f("ethercat_cycle_lock")[("locked",)] == 1'
	families 'f("ethercat_cycle_phase_error_seconds") == {(): -12e-9}'
	families 'f("ethercat_slave_emergencies")[("2",)] > 0'
	FAKE_BUS=dc metrics
	families 'f("ethercat_slave_dc_difference_seconds") == {("0",): 3e-9, ("2",): -1.2e-6}'
	FAKE_BUS=app FAKE_UNITS=1 metrics
	families 'len(f("ethercat_unit")) == len(f("ethercat_unit_faults")) > 1'
	families 'sum(f("ethercat_unit_state").values()) >= 1'
}

@test "metrics count the errors of ports beyond a register, and only those that were read" {
	metrics
	families 'f("ethercat_port_invalid_frames")[("1", "0")] == 300'
	families 'f("ethercat_port_forwarded_errors")[("1", "1")] == 1'
	families '{k[0] for k in f("ethercat_port_invalid_frames")} == {"1", "2"}'
	families '{k[0] for k in f("ethercat_port_lost_links")} == {"2"}'
}

@test "metrics of several masters are one text, and need no write permission" {
	FAKE_BUS=two FAKE_READONLY=1 metrics
	families 'len(f("ethercat_slaves")) == 2'
	families 'len(f("ethercat_slave")) == 6'
	FAKE_BUS=two metrics -m1
	families 'list(f("ethercat_slaves")) == [("1",)]'
	for b in empty waiting big cut loop held; do
		FAKE_BUS=$b metrics
		families 'len(all) > 40'
	done
}

@test "names of slaves cannot break the text" {
	local evil

	FAKE_BUS=evil metrics
	families 'len(f("ethercat_slave")) == 3'
	evil=$(printf 'a"} 1\n# EOF\nb\\\377\303\266\033[2J')
	FAKE_ORDER=$evil metrics
	families 'len(f("ethercat_slave")) == 3'
	families '[s.labels["order"] for s in all["ethercat_slave"].samples] ==
		3 * ["a\"} 1?# EOF?b\\\u00ff\u00f6?[2J"]'
	grep -qF 'order="a\"} 1?# EOF?b\\' "$BATS_TEST_TMPDIR/metrics"
	out metrics -j | json '"ethercat_slaves{master" in d["openmetrics"]'
}

# http REQUEST: the reply
http() { printf "$1" | "$HERE/build/fake/ethercat" metrics --http; }

@test "metrics --http replies to GET and HEAD of /metrics, and refuses all else" {
	http 'GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n' >"$BATS_TEST_TMPDIR/reply"
	[ "$(head -n 1 "$BATS_TEST_TMPDIR/reply")" = $'HTTP/1.1 200 OK\r' ]
	grep -q $'^Content-Type: application/openmetrics-text; version=1.0.0; charset=utf-8\r$' \
		"$BATS_TEST_TMPDIR/reply"
	sed '1,/^\r$/d' "$BATS_TEST_TMPDIR/reply" >"$BATS_TEST_TMPDIR/body"
	families 'f("ethercat_slaves") == {(): 3}' "$BATS_TEST_TMPDIR/body"
	grep -q "^Content-Length: $(stat -c %s "$BATS_TEST_TMPDIR/body")"$'\r$' \
		"$BATS_TEST_TMPDIR/reply"
	http 'GET /metrics?x=1 HTTP/1.0\n\n' | head -n 1 | grep -q ' 200 '
	[ -z "$(http 'HEAD /metrics HTTP/1.1\r\n\r\n' | sed '1,/^\r$/d')" ]
	http 'GET / HTTP/1.1\r\n\r\n' | head -n 1 | grep -q ' 404 '
	http 'POST /metrics HTTP/1.1\r\n\r\n' | head -n 1 | grep -q ' 405 '
	http 'GET /metrics HTTP/2.0\r\n\r\n' | head -n 1 | grep -q ' 400 '
	http 'GET /metrics HTTP/1.1\r\n' | head -n 1 | grep -q ' 400 '
	http 'GET /metrics\0HTTP/1.1\r\n\r\n' | head -n 1 | grep -q ' 400 '
	http "GET /$(printf %9000s | tr ' ' x) HTTP/1.1\r\n\r\n" | head -n 1 | grep -q ' 400 '
	http '' | head -n 1 | grep -q ' 400 '
	FAKE_BUS=none http 'GET /metrics HTTP/1.1\r\n\r\n' 2>/dev/null | head -n 1 | grep -q ' 503 '
}
