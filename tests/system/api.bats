# SPDX-License-Identifier: GPL-2.0-only
# Every function of ecrt.h, through the device, against a simulated segment.

load helpers

setup_file() {
	{
		printf '%s\n' "segment seed=6" "slave coupler EK1100" "slave out EL2008 alias=1001" \
			"slave in EL1008" "slave motor drive in=22 out=22 mapping=rewritable serial=77 drift=-100ppm soe=2 voe=0x4321 foe=64" \
			"slave servo EL7201" "slave switch EL6614" "connect out.1 -> in.1" "connect out.2 -> in.2"
		# an emergency every 0.2 s for 100 s, from its load on
		for i in $(seq 500); do
			printf 'fault at=%ums emergency motor code=0x8110 register=0x11\n' $((i * 200))
		done
	} >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 6
	export API_CALLED=$BATS_FILE_TMPDIR/called
}
teardown_file() { stop; }

# the segment from its begin: its emergencies come now
reload() {
	rmmod ec_sim
	# a card keeps its link: the master might not notice, and still know the slaves of before
	wait_for 60 responding 0
	load_segment "$BATS_FILE_TMPDIR/segment"
	[ -z "${EC_NIC:-}" ] || wait_for 60 responding 6
}

responding() { [ "$(ethercat master --json | gojq '.masters[0].slaves_responding')" = "$1" ]; }

# group NAME: all cases of it pass; each is a line of its own
group() {
	cases timeout 300 "$EC_BUILD/apps/api" "$1"
	wait_for 60 all_slaves_are PREOP 6
}

@test "open, reserve, release" { group open; }
@test "information and SDOs of an open master" { group info; }
@test "slave configurations are accepted and take effect" {
	group config
	# what it was told last
	ethercat ip -p5 | grep -q '^IP address: 192\.168\.0\.5$'
	ethercat ip -p5 | grep -q '^Hostname: a-name-of-more-than-thirty-one-$'
}
@test "PDOs and registration" { group pdo; }
@test "the cycle" { group cycle; }
@test "options of domains" { group layout; }
@test "extensions of the interface work as documented" { group extension; }
@test "configuration after activation" { group after; }
@test "distributed clocks" { group dc; }
@test "requests and emergencies" {
	reload
	wait_for 120 all_slaves_are PREOP 6
	group request
}
@test "files of slaves" { group foe; }
@test "object dictionary of slaves" { group dict; }
@test "IDNs, VoE messages, whole objects" {
	group soe
	# what it was told at startup, and by the tool
	[ "$(ethercat soe_read -p3 -t uint16 1 P-0-170)" = "0x5aa5 23205" ]
	ethercat soe_write -p3 -t string P-0-160 "a text"
	[ "$(ethercat soe_read -p3 -t string P-0-160)" = "a text" ]
	run ethercat soe_write -p3 -t uint16 P-0-170 1
	[ "$status" = 1 ]
	grep -q '0x7005: the value is write protected at this time' <<<"$output"
}
@test "the kernel's cycle" { group kcycle; }
@test "NULL handles" { group null; }
@test "floating point access keeps all bits" { group access; }

# behaviour applications rely on, by clients with the habits of real ones
@test "a machine controller" { group lcec; }
@test "a robot driver" { group ros2; }
@test "beside other processes" { group beside; }

@test "system calls of a cycle with everything in it" { group syscalls; }

@test "a request while the bus is scanned" {
	reload
	group open
}

@test "that was every function of the library" {
	diff <(sed -n 's/^\t\t\(ecrt_[a-z0-9_]*\);/\1/p' "$EC_BUILD/../../lib/libethercat.map" | sort) \
		<(sort -u "$API_CALLED")
}
