# SPDX-License-Identifier: GPL-2.0-only
# Cases of a script, to be sourced: their numbers are in $passed and $failed.

passed=0 failed=0

# t NAME COMMAND...: a case, in a subshell; what it prints is shown when it fails
t() {
	local t_name=$1 t_said	# a command sees these, too

	shift
	if t_said=$("$@" 2>&1); then
		echo "ok - $t_name"
		passed=$((passed + 1))
	else
		echo "not ok - $t_name"
		tail -n 40 <<<"$t_said" | sed 's/^/# /'
		failed=$((failed + 1))
	fi
}
