# SPDX-License-Identifier: GPL-2.0-only
# Places for guests that run at a time, one for each CPU. They are lock files in the folder
# EC_PLACES, so several scripts share them. To be sourced in the top folder.

# places FOLDER MB: makes them there, fewer where not all have MB of memory, unless EC_PLACES
# names some already
places() {
	if [ -z "${EC_PLACES:-}" ]; then
		export EC_PLACES=$1
		mkdir "$EC_PLACES"
		# a guest, and QEMU
		awk -v cpus="$(nproc)" -v kb=$(($2 * 1000 + 500000)) '
			/^MemAvailable:/ { n = int($2 / kb) }
			END { print n < 1 ? 1 : n < cpus ? n : cpus }' /proc/meminfo |
			xargs seq | sed "s,^,$EC_PLACES/," | xargs touch
	fi
	places=("$EC_PLACES"/*)
}

# place COMMAND...: in the first place that is free
place() {
	local p rc

	while :; do
		for p in "${places[@]}"; do
			exec 9>"$p" || exit 1	# the folder is removed when a check is ended
			flock -n 9 || continue
			"$@"
			rc=$?
			exec 9>&-
			return $rc
		done
		sleep 0.3
	done
}

gently() (
	renice -n $(($(nice) + 5)) -p "$BASHPID" >/dev/null
	"$@"
)

# one COMMAND...: in a place; its guests have exact time, and give way to those of real time
one() { place gently "$@"; }

# real_time COMMAND...: in a place, too, one at a time
real_time() {
	local rc

	exec 7>"$EC_PLACES.real_time" || exit 1
	flock 7
	place "$@"
	rc=$?
	exec 7>&-
	return $rc
}

# locked KERNEL COMMAND...: not while another script builds for this kernel
locked() {
	local lock=$PWD/build/.lock-$1

	shift
	mkdir -p build
	{
		flock 8
		"$@" 8>&-
	} 8>"$lock"
}
