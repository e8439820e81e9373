#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Debian's Prometheus scrapes 'ethercat metrics --http' behind a socket of systemd, and has the
# values of the fake bus. The package is unpacked, not installed: its service would start. The last
# line is "N passed, N failed".

set -u
export LC_ALL=C
cd "$(dirname "$0")" || exit 1
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}/prometheus
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-prometheus.XXXXXX")
pids=
trap 'kill $pids 2>/dev/null; wait; rm -rf "$tmp"' EXIT
passed=0 failed=0

die() { echo "$*"; echo "$passed passed, $((failed + 1)) failed"; exit 1; }

t() {	# t NAME COMMAND...
	if "${@:2}" >"$tmp/out" 2>&1; then
		echo "ok $1"
		passed=$((passed + 1))
	else
		echo "not ok $1"
		sed 's/^/# /' "$tmp/out"
		failed=$((failed + 1))
	fi
}

wait_for() {	# wait_for SECONDS COMMAND...
	local end=$((SECONDS + $1))

	until "${@:2}"; do
		[ $SECONDS -lt $end ] || return 1
		sleep 0.1
	done
}

fetch() {
	mkdir -p "$cache/new" && cd "$cache/new" &&
		apt-get -qq download prometheus >/dev/null 2>&1 &&
		dpkg -x prometheus_*.deb . && mv usr/bin/prometheus .. && cd .. && rm -r new
}

free_port() {
	python3 -c 'import socket
print(socket.create_server(("127.0.0.1", 0)).getsockname()[1])'
}

# query EXPRESSION: the values of all series, in a line
query() {
	python3 - "$1" "$port" <<-'END'
	import json, sys, urllib.parse, urllib.request
	url = 'http://127.0.0.1:%s/api/v1/query?%s' % (sys.argv[2],
	    urllib.parse.urlencode({'query': sys.argv[1]}))
	proxy = urllib.request.build_opener(urllib.request.ProxyHandler({}))
	result = json.load(proxy.open(url, timeout=5))['data']['result']
	print(*[r['value'][1] for r in result])
	END
}
is() { [ "$(query "$1" 2>/dev/null)" = "$2" ]; }

[ -x "$cache/prometheus" ] || (fetch) || die "cannot fetch Debian's prometheus"
make -s tools || die "the tool does not build"
port=$(free_port) target=$(free_port)
export FAKE_BUS=app FAKE_UNITS=1 FAKE_ORDER=$'"} 1\n# EOF\\\377'
systemd-socket-activate -a --inetd -l "127.0.0.1:$target" -E FAKE_BUS -E FAKE_UNITS -E FAKE_ORDER \
	"$PWD/build/fake/ethercat" metrics --http >"$tmp/socket" 2>&1 &
pids=$!
cat >"$tmp/prometheus.yml" <<-END
	scrape_configs:
	  - job_name: ethercat
	    scrape_interval: 1s
	    scrape_timeout: 1s
	    static_configs:
	      - targets: ["127.0.0.1:$target"]
END
"$cache/prometheus" --config.file="$tmp/prometheus.yml" --storage.tsdb.path="$tmp/data" \
	--web.listen-address="127.0.0.1:$port" >"$tmp/log" 2>&1 &
pids="$pids $!"
t "Prometheus scrapes the target" wait_for 30 is 'up{job="ethercat"}' 1
t "each slave is a series" is 'count(ethercat_slave_info)' 3
t "frames are counted" is 'sum(ethercat_sent_frames_total)' 18342
t "the histogram has a quantile" is \
	'histogram_quantile(0.999, sum by (le) (ethercat_send_deviation_seconds_bucket)) < bool 1' 1
t "working counters, units and errors of ports are there" is \
	'count(ethercat_domain_working_counter) > bool 0
	 and count(ethercat_unit_faults_total) > bool 0
	 and count(ethercat_port_invalid_frames_total) > bool 0' 1
t "a hostile name is one value of a label" is \
	'count(ethercat_slave_info{order="\"} 1?# EOF\\ÿ"})' 3
[ $failed = 0 ] || sed 's/^/# /' "$tmp/log" "$tmp/socket" | tail -n 30
echo "$passed passed, $failed failed"
[ $failed = 0 ]
