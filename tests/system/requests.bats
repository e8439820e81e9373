# SPDX-License-Identifier: GPL-2.0-only
# Requests and emergencies beside the cycle of a small application.

load helpers

setup_file() {
	{
		printf '%s\n' "segment seed=4" "slave coupler EK1100" "slave motor drive serial=77"
		# one each second, while the application runs
		printf 'fault at=%us emergency motor code=0x8110 register=0x11\n' $(seq 400)
	} >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 2
}
teardown_file() { stop; }

# says LINE: the application has printed exactly that
says() { grep -qxF "$1" <<<"$output" || { echo "not said: $1"; echo "$output"; return 1; }; }

@test "SDOs, a register, an absent slave, an emergency" {
	run timeout 100 "$EC_BUILD/examples/sdo_requests" 1
	[ "$status" = 0 ]
	says "slave is in OP"
	says "serial number: SUCCESS 0x0000004d, 4 bytes"
	says "write: SUCCESS"
	says "read back: SUCCESS 0x1234abcd, 4 bytes"
	says "no such object: ERROR"
	says "register: SUCCESS $(ethercat reg_read -p1 -t uint16 0x0010 | awk '{ print $1 }')"
	says "absent slave: ERROR"
	says "emergency: 0x8110 register 0x11"
	says "dropped emergencies: 0"
	says "ended: each step had the expected result"
	[ "$(ethercat upload -p1 -t uint32 0x2001 8 | awk '{ print $1 }')" = 0x1234abcd ]
}

@test "sdo_requests: a slave without mailbox is not asked, exit code 1" {
	run timeout 100 "$EC_BUILD/examples/sdo_requests" 0
	echo "$output"
	[ "$status" = 1 ]
}
