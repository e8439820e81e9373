# SPDX-License-Identifier: GPL-2.0-only
# Application and cycle of the kernel at the same time, on two processors.
# vm: --smp 2

load helpers

setup_file() {
	cat >"$BATS_FILE_TMPDIR/segment" <<-END
	segment seed=32
	slave s io in=6400 out=6400
	connect s.1 -> s.1
	connect s.200 -> s.200
	END
	start "$BATS_FILE_TMPDIR/segment" 1
}
teardown_file() { stop; }

@test "no image is torn while both copy" {
	run "$EC_BUILD/apps/kcycle" cycles=5000 loop=1 spin=1 cpu=1
	echo "$output"
	[ "$status" = 0 ]
	[[ "$output" == *"cycles: 5000, "*", torn: 0"* ]]
}
