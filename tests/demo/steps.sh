# SPDX-License-Identifier: GPL-2.0-only
# Steps of the demo as lines with the seconds since its begin. To be sourced.

tick=30		# seconds without a line

step() { printf '[%3d s] %s\n' $SECONDS "$*"; }

# lines NAME: what a step prints, with the time; a line for each $tick seconds of silence, since
# a step may take minutes on a slow machine
lines() {
	local line begin=$SECONDS rc

	while :; do
		IFS= read -r -t "$tick" line
		rc=$?
		if [ $rc = 0 ]; then
			line=${line#install-deps: }
			[ -z "$line" ] || step "$1: ${line#kernels.sh: }"
		elif [ $rc -gt 128 ]; then
			step "$1: still running, $((SECONDS - begin)) s"
		else
			break
		fi
	done
}

# on NAME COMMAND...: what the command prints, and one line with its seconds when it is done
on() {
	local name=$1 begin=$SECONDS rc

	shift
	"$@" 2>&1 | lines "$name"
	rc=${PIPESTATUS[0]}
	[ "$rc" != 0 ] || step "$name: done in $((SECONDS - begin)) s"
	return "$rc"
}
