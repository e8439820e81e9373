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

@test "a session is refused what is beyond its limit, and says so" {
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
	# all is free again, but for what the kernel keeps in its caches
	wait_for 20 has_free $((before - 8192))
}

@test "a memory cgroup bounds it as well: only what is in there is hit" {
	echo 16M >/sys/fs/cgroup/app/memory.max
	echo 0 >/sys/fs/cgroup/app/memory.swap.max 2>/dev/null || true	# not without swap
	run sh -c 'echo $$ >/sys/fs/cgroup/app/cgroup.procs && exec "$1"' sh "$EC_BUILD/apps/memory"
	echo "$output"
	cat /sys/fs/cgroup/app/memory.events
	if [ "$status" = 0 ]; then
		n=${output##*$'\n'}
		[ "${n%% values*}" -lt 256 ]
	else
		[ "$status" = 137 ]
		grep -q 'oom_kill [1-9]' /sys/fs/cgroup/app/memory.events
	fi
	ethercat master
}
