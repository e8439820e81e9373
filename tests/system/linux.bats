# SPDX-License-Identifier: GPL-2.0-only
# What the rest of Linux sees of the bus: tracepoints.

load helpers

TRACING=/sys/kernel/tracing
SIM=/sys/kernel/debug/ec_sim/sim0

setup_file() { start bench 22; }
teardown_file() { stop; }
teardown() { [ ! -e $TRACING/events/ethercat ] || echo 0 >$TRACING/events/ethercat/enable; }

# traced EVENT...: the trace has one of each
traced() {
	local e

	for e; do grep -q " ec_$e: " $TRACING/trace || return; done
}

@test "tracepoints show frames, a loss, states, mailboxes and cycles" {
	[ -d $TRACING/events/ethercat ] || skip "a kernel without tracepoints"
	[ "$(ls -d $TRACING/events/ethercat/*/ | wc -l)" = 6 ]
	echo 8192 >$TRACING/buffer_size_kb
	echo >$TRACING/trace
	echo 1 >$TRACING/events/ethercat/enable
	run "$EC_BUILD/apps/demo" --cycles 200 --period-us 2000 --wired
	echo "$output"
	[ "$status" = 0 ]
	wait_for 60 all_slaves_are PREOP 22
	ethercat upload -p4 -t uint32 0x1018 1
	lost=$(lost_frames)
	echo 'lose frame=1' >$SIM
	wait_for 60 traced frame_sent frame_received frame_lost al_state mailbox cycle
	echo 0 >$TRACING/events/ethercat/enable
	python3 - $TRACING/trace $(($(lost_frames) - lost)) <<-'END'
	import re, sys
	seen = {}
	for line in open(sys.argv[1]):
	    m = re.search(r" ec_(\w+): (.*)$", line)
	    if m:
	        e = dict(re.findall(r"(\w+)=(\w+)", m[2]))
	        seen.setdefault(m[1], []).append({k: int(v, 0) if v[0].isdigit() else v
	                                          for k, v in e.items()} | {"text": m[2]})
	assert all(e["master"] == 0 for events in seen.values() for e in events)
	frame = lambda e: (e["link"], e["index"], e["seq"])
	of = {name: [frame(e) for e in seen[name]]
	      for name in ("frame_sent", "frame_received", "frame_lost")}
	sent = set(of["frame_sent"])
	assert len(sent) == len(of["frame_sent"]) > 400, "each frame is sent once"
	back, lost = set(of["frame_received"]), set(of["frame_lost"])
	assert not back & lost
	# each was sent, but for one that was in flight at the begin
	assert len((back | lost) - sent) <= 1, (back | lost) - sent
	assert len(sent - back - lost) <= 1, sent - back - lost
	assert len(lost) == int(sys.argv[2]) == 1, lost
	# the end of the session awaits no reply to its last frames
	other = [e for e in seen["frame_received"] if e["match"] != "reply"]
	assert len(other) <= 3 and all(e["match"] == "late" for e in other), other[:5]
	sizes = {e["bytes"] for e in seen["frame_received"]}
	assert min(sizes) >= 28 and max(sizes) <= 1514, sizes
	cycles = [e["number"] for e in seen["cycle"]]
	assert cycles == list(range(1, len(cycles) + 1)) and len(cycles) >= 200, cycles[-1]
	assert all(e["frames"] >= 1 and 5000 < e["wire_ns"] < 2000000 and e["domains"] == 1 and
	           e["in_flight"] >= e["frames"] for e in seen["cycle"] if e["domains"])
	assert sum(bool(e["domains"]) for e in seen["cycle"]) >= 200
	al = seen["al_state"]
	for state, value in ("OP", 8), ("SAFEOP", 4), ("PREOP", 2):
	    there = {e["station"] for e in al if e["status"] == value and f"({state})" in e["text"]}
	    assert len(there) == 22, (state, there)
	assert {e["position"] for e in al} == set(range(22))
	assert all(e["before"] and e["code"] == 0 for e in al)
	coe = [e for e in seen["mailbox"] if e["type"] == 3 and "(CoE)" in e["text"]]
	for way in "to_slave", "from_slave":
	    assert any(way in e["text"] and e["bytes"] == 10 and 0 < e["counter"] < 8 for e in coe)
	assert {e["station"] for e in coe} <= {e["station"] for e in al}
	END
}
