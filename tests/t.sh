# SPDX-License-Identifier: GPL-2.0-only
# Cases of a script, to be sourced: their numbers are in $passed and $failed.

passed=0 failed=0

# t NAME COMMAND...: a case, in a subshell; what it prints is shown when it fails
t() {
	local name=$1 out

	shift
	if out=$("$@" 2>&1); then
		echo "ok - $name"
		passed=$((passed + 1))
	else
		echo "not ok - $name"
		tail -n 40 <<<"$out" | sed 's/^/# /'
		failed=$((failed + 1))
	fi
}
