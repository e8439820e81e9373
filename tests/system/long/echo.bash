# SPDX-License-Identifier: GPL-2.0-only
# One slave whose inputs are its outputs, behind a native device, and tests/apps/echo.

start_echo() {
	export EC_NIC=${EC_NIC:-e1000e}
	{
		printf '%s\n' 'segment seed=32' 'slave s io in=32 out=32'
		for i in {1..32}; do echo "connect s.$i -> s.$i"; done
	} >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 1
}

echo_app() { LD_LIBRARY_PATH="$EC_BUILD/lib" "$EC_BUILD/apps/echo" "$@"; }

# value NAME: of its last line
value() { tail -n 1 "$BATS_TEST_TMPDIR/out" | grep -o "\<$1=[0-9]*" | cut -d= -f2; }

# tell STATEMENT: to the segment
tell() { echo "$1" >/sys/kernel/debug/ec_sim/eth1; }
