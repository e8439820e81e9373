# SPDX-License-Identifier: GPL-2.0-only
# Memory that an application causes in the kernel has a limit, and belongs to the
# memory cgroup of the application.
# vm: --smp 2

load helpers

setup_file() {
	printf '%s\n' "segment seed=43" "slave s io in=8 out=8" >"$BATS_FILE_TMPDIR/segment"
	start "$BATS_FILE_TMPDIR/segment" 1
	mountpoint -q /sys/fs/cgroup || mount -t cgroup2 none /sys/fs/cgroup
	echo +memory >/sys/fs/cgroup/cgroup.subtree_control
	mkdir /sys/fs/cgroup/app
}
teardown_file() { stop; }

free_kib() { awk '/^MemAvailable:/ { print $2 }' /proc/meminfo; }
has_free() { [ "$(free_kib)" -ge "$1" ]; }

@test "a session beyond its memory limit is refused with a reason" {
	local before

	before=$(free_kib)
	run "$EC_BUILD/apps/memory"
	echo "$output"
	[ "$status" = 0 ]
	# 64 MiB, 64 KiB each
	n=${output##*$'\n'}
	n=${n%% values*}
	[ "$n" -ge 1000 ]
	[ "$n" -lt 1024 ]
	[[ "$output" == *"limit of 64 MiB for the sessions of master 0"* ]]
	# all is free again, but for what the kernel keeps in its caches (more than 8 MiB once)
	wait_for 20 has_free $((before - 16384))
}

# in_group COMMAND...: by a process of the group
in_group() { sh -c 'echo $$ >/sys/fs/cgroup/app/cgroup.procs && exec "$@"' sh "$@"; }
charged() { cat /sys/fs/cgroup/app/memory.current; }
kills() { sed -n 's/^oom_kill //p' /sys/fs/cgroup/app/memory.events; }
charged_at_most() { [ "$(charged)" -le "$1" ]; }
no_session() { json '.masters[0].session == "none"' master; }

# part NAME LEAST MOST: KiB charged for it; nearly all of that is given back, but for 64
# pages that each CPU keeps charged for the next one who needs some
part() {
	awk -v name="$1" -v least="$2" -v most="$3" '$1 == name {
		found = $2 >= least * 1024 && $2 <= most * 1024 && $3 <= $2 / 20 + 2 * 64 * 4096 } END { exit !found }' \
		"$BATS_TEST_TMPDIR/out"
}

@test "memory of an application is charged to its cgroup until release" {
	in_group "$EC_BUILD/apps/memory" charge /sys/fs/cgroup/app/memory.current >"$BATS_TEST_TMPDIR/out"
	sed 's/^/# bytes charged and left: /' "$BATS_TEST_TMPDIR/out" >&3
	# 256 values of 64 KiB
	part SDOs 16384 18432
	part configurations 1000 4096
	# 64 values of 64 KiB, mapped and copied
	part requests 8192 14336
}

@test "beyond memory.max an application is killed, and nothing outside of its group" {
	local before outside

	echo 16M >/sys/fs/cgroup/app/memory.max
	echo 0 >/sys/fs/cgroup/app/memory.swap.max 2>/dev/null || true	# not without swap
	before=$(charged)
	# what the kernel would choose if it looked outside of the group
	python3 -c 'import os, time
x = b"x" * (128 << 20)
open("/proc/self/oom_score_adj", "w").write("1000")
print("ready", flush=True)
time.sleep(1000)' >"$BATS_TEST_TMPDIR/outside" 3>&- &
	outside=$!
	wait_for 60 grep -q ready "$BATS_TEST_TMPDIR/outside"
	run in_group "$EC_BUILD/apps/memory"
	echo "$output"
	cat /sys/fs/cgroup/app/memory.events
	[ "$status" = 137 ]
	[ "$(kills)" = 1 ]
	kill -0 $outside
	kill $outside
	no_session
	wait_for 20 charged_at_most $((before + 1048576))
}

@test "beyond memory.max an application that must not be killed is refused" {
	local before n

	echo 16M >/sys/fs/cgroup/app/memory.max
	before=$(charged)
	run in_group sh -c 'echo -1000 >/proc/self/oom_score_adj && exec "$1"' sh "$EC_BUILD/apps/memory"
	echo "$output"
	[ "$status" = 0 ]
	n=${output##*$'\n'}
	n=${n%% values*}
	[ "$n" -ge 200 ] && [ "$n" -lt 256 ]
	[[ "$output" == *"values, then: Cannot allocate memory" ]]
	no_session
	wait_for 20 charged_at_most $((before + 1048576))
	# and the next one is welcome
	echo max >/sys/fs/cgroup/app/memory.max
	in_group "$EC_BUILD/apps/memory" charge /sys/fs/cgroup/app/memory.current
}
