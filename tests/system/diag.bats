# SPDX-License-Identifier: GPL-2.0-only
# The diagnosis history of a slave, object 0x10F3.

load helpers

setup_file() {
	printf 'segment seed=3\nslave axis drive mbox=128 diag=3\nslave axis2 drive\n' \
		>"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 2
}

teardown_file() { stop; }

@test "diag shows, acknowledges and clears messages of a slave" {
	run ethercat diag
	[ "$status" = 0 ]
	[[ $output =~ ^'   0  0x10f3:06 *  '.*' info     0x0000e001  text 0x0001'$ ]]
	# a fault adds one, which the master reports as AL error
	echo 'error axis code=0x42' >/sys/kernel/debug/ec_sim/sim0
	wait_for 30 eval 'ethercat diag | grep -q "error    0x0000e010  text 0x0010, 0x0042 66, .*, \"axis\"$"'
	[ "$(ethercat diag | wc -l)" = 2 ]
	ethercat diag --acknowledge
	json '[.masters[0].slaves[0].messages[].new] == [false, false]' diag
	ethercat diag --reset
	[ "$(ethercat diag)" = "   0  no messages" ]
	refused 'no selected slave has a diagnosis history' diag -p1
}
