# SPDX-License-Identifier: GPL-2.0-only
# What the rest of Linux sees of the bus: tracepoints, devices, uevents.

load helpers

TRACING=/sys/kernel/tracing
SIM=/sys/kernel/debug/ec_sim/sim0
DEVICES=/sys/bus/ethercat/devices

setup_file() { start bench 22; }
teardown_file() { stop; }
teardown() {
	[ ! -e $TRACING/events ] || echo 0 >$TRACING/events/enable
	for p in ${helpers[@]+"${helpers[@]}"}; do kill -9 "$p" 2>/dev/null || true; done
}

# python NAME: a program on stdin that runs until the end of the case and writes "ready"
python() {
	cat >"$BATS_TEST_TMPDIR/$1.py"
	python3 "$BATS_TEST_TMPDIR/$1.py" >"$BATS_TEST_TMPDIR/$1" 2>&1 3>&- &
	helpers+=($!)
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/$1"
}

devices() { ls $DEVICES 2>/dev/null | wc -l; }
there_are() { [ "$(devices)" = "$1" ]; }

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

@test "each slave is a device with its identity and place" {
	wait_for 20 there_are 22
	ethercat slaves -v --json >"$BATS_TEST_TMPDIR/slaves"
	python3 - "$BATS_TEST_TMPDIR/slaves" <<-'END'
	import json, os, sys
	bus = "/sys/bus/ethercat/devices/"
	slaves = json.load(open(sys.argv[1]))["masters"][0]["slaves"]
	assert len(slaves) == 22
	for s in slaves:
	    d = bus + "EtherCAT0-d%u/" % s["device_number"]
	    files = {n: open(d + n).read().strip() for n in os.listdir(d) if os.path.isfile(d + n)
	             and n != "uevent"}
	    assert os.path.realpath(d + "..") == os.path.realpath("/sys/class/EtherCAT/EtherCAT0")
	    assert os.path.realpath(d + "subsystem") == "/sys/bus/ethercat"
	    want = {"position": s["position"], "device_number": s["device_number"],
	            "alias": s["own_alias"],
	            "al_state": s["state"]}
	    want |= {a: "0x%08x" % s[b] for a, b in (("vendor", "vendor_id"),
	        ("product", "product_code"), ("revision", "revision_number"),
	        ("serial", "serial_number"))}
	    assert files == {k: str(v) for k, v in want.items()}, (files, want)
	    modalias = "MODALIAS=ethercat:v%08Xp%08X\n" % (s["vendor_id"], s["product_code"])
	    assert modalias in open(d + "uevent").read()
	    assert all(os.stat(d + n).st_mode & 0o777 == 0o444 for n in files)
	END
	ethercat states SAFEOP -p4 --wait
	[ "$(cat $DEVICES/EtherCAT0-d5/al_state)" = SAFEOP ]
	ethercat states PREOP -p4 --wait
}

@test "a branch that is cut and healed has uevents, and keeps its names" {
	local before

	before=$(ls $DEVICES)
	python listener <<-'END'
	import socket
	s = socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 15)
	s.bind((0, 1))
	print("ready", flush=True)
	while True:
	    e = s.recv(8192).decode().split("\0")
	    v = dict(x.split("=", 1) for x in e if "=" in x)
	    if v["SUBSYSTEM"] in ("ethercat", "EtherCAT"):
	        print(v["SUBSYSTEM"], v["ACTION"], v["DEVPATH"].split("/")[-1], v.get("MODALIAS"),
	              flush=True)
	END
	echo "cut coupler1.2" >$SIM
	wait_for 60 eval '[ $(devices) -lt 22 ]'
	wait_for 60 all_slaves_are PREOP "$(devices)"
	echo "heal coupler1.2" >$SIM
	wait_for 60 there_are 22
	wait_for 60 all_slaves_are PREOP 22
	[ "$(ls $DEVICES)" = "$before" ]
	cat "$BATS_TEST_TMPDIR/listener"
	# each that was removed was added again
	diff <(sed -n 's/^ethercat remove //p' "$BATS_TEST_TMPDIR/listener" | sort) \
		<(sed -n 's/^ethercat add //p' "$BATS_TEST_TMPDIR/listener" | sort)
	grep -qE '^ethercat remove EtherCAT0-d[0-9]+ ethercat:v[0-9A-F]{8}p[0-9A-F]{8}$' \
		"$BATS_TEST_TMPDIR/listener"
	run grep '^EtherCAT ' "$BATS_TEST_TMPDIR/listener"
	[ "$status" = 1 ]
	# what udevadm trigger does
	echo change >$DEVICES/EtherCAT0-d1/uevent
	wait_for 20 grep -q '^ethercat change EtherCAT0-d1 ' "$BATS_TEST_TMPDIR/listener"
	# nothing of it when all is read again
	: >"$BATS_TEST_TMPDIR/listener"
	before=$(stat -c '%n %i' $DEVICES/*/)
	ethercat rescan --wait
	wait_for 60 all_slaves_are PREOP 22
	[ "$(stat -c '%n %i' $DEVICES/*/)" = "$before" ]
	[ ! -s "$BATS_TEST_TMPDIR/listener" ]
}

@test "a device takes 3 KiB of memory at most" {
	[ -d $TRACING/events/kmem ] || skip "a kernel without tracepoints"
	stop
	echo 16384 >$TRACING/buffer_size_kb
	echo >$TRACING/trace
	load_master
	for e in workqueue/workqueue_execute_start workqueue/workqueue_execute_end kmem/kmalloc \
		kmem/kfree kmem/kmem_cache_alloc kmem/kmem_cache_free; do
		echo 1 >$TRACING/events/$e/enable
	done
	load_segment bench
	wait_for 120 all_slaves_are PREOP 22
	wait_for 20 there_are 22
	echo 0 >$TRACING/events/enable
	python3 - $TRACING/trace >"$BATS_TEST_TMPDIR/memory" <<-'END'
	import re, sys
	own, size, runs = {}, {}, set()
	for line in open(sys.argv[1]):
	    m = re.match(r" *(.+)-(\d+) +\[.*?\] \S+ +[\d.]+: (\w+): (.*)", line)
	    if not m:
	        continue
	    thread, event, rest = m[2], m[3], m[4]
	    ptr = re.search(r"ptr=(\w+)", rest)
	    if event == "workqueue_execute_start":
	        own[thread] = "function follow_list" in rest
	        runs.add(thread) if own[thread] else None
	    elif event == "workqueue_execute_end":
	        own[thread] = False
	    elif "alloc" in event and own.get(thread):
	        size[ptr[1]] = int(re.search(r"bytes_alloc=(\d+)", rest)[1])
	    elif "free" in event:
	        size.pop(ptr[1], None)
	assert runs
	print(sum(size.values()) // 22, "bytes of memory of the device of a slave")
	END
	sed 's/^/# /' "$BATS_TEST_TMPDIR/memory" >&3
	n=$(cut -d' ' -f1 "$BATS_TEST_TMPDIR/memory")
	[ "$n" -gt 1500 ]
	[ "$n" -le 3072 ]
}

@test "modules unload while programs read attributes and look for drivers" {
	wait_for 20 there_are 22
	python holder <<-'END'
	import errno, os, time
	d = "/sys/bus/ethercat/devices/EtherCAT0-d3/"
	files = [open(d + n) for n in ("al_state", "position", "serial", "uevent")]
	for f in files:
	    assert f.read()
	print("ready", flush=True)
	while os.path.exists(d):
	    time.sleep(0.01)
	for f in files:
	    try:
	        f.seek(0)
	        f.read()
	    except OSError as e:
	        assert e.errno == errno.ENODEV, e
	    else:
	        raise AssertionError(f)
	print("all refused", flush=True)
	END
	python reader <<-'END'
	import glob
	print("ready", flush=True)
	while True:
	    for name in glob.glob("/sys/bus/ethercat/devices/*/*"):
	        try:
	            open(name).read()
	        except OSError:
	            pass
	END
	python prober <<-'END'
	import os
	print("ready", flush=True)
	while True:
	    try:
	        for name in os.listdir("/sys/bus/ethercat/devices"):
	            open("/sys/bus/ethercat/drivers_probe", "w").write(name)
	    except OSError:
	        pass
	END
	dmesg -C
	for _ in 1 2 3 4 5; do
		wait_for 60 there_are 22
		rmmod ec_sim
		rmmod ec_master
		[ ! -e /sys/bus/ethercat ]
		load_master
		load_segment bench
	done
	grep -q '^all refused$' "$BATS_TEST_TMPDIR/holder"
	wait_for 120 all_slaves_are PREOP 22
	wait_for 20 there_are 22
	dmesg
	run grep -E 'BUG|WARNING|Oops|kobject' < <(dmesg)
	[ "$status" = 1 ]
}
