#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Finds lines of bats files that look like an assertion and assert nothing, or lose one:
#
# - "! COMMAND": the shell never ends a test for it, whatever its status, unless it is the
#   last. Such a line ends in "|| return 1", or becomes a comparison.
# - "COMMAND || true": nothing it does can fail the test. Commands that tidy up may; any
#   other says why in a comment at the end of the line.
# - "COMMAND | FILTER": bats knows only the status of the last command. A function of
#   several commands does not begin a pipe, since a failure in the middle of it is lost;
#   and tee, cat, head and tail, which never fail, end only what is printed for the reader.
#   Put the output into a file, then look at that.
#
# usage: check-bats.sh [FILE...]	default: all of tests/

set -u
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- tests/*/*.bats tests/*/*.bash tests/system/long/*.ba*
passed=0 failed=0

# the files, each command that goes on in the next line joined to one line
joined() { sed -E -e ':a' -e '/(\\|[^|]\||&&|\|\|)$/{N;s/\\?\n[[:space:]]*/ /;ba' -e '}' "$@"; }

# several FILE...: names of their functions with more than one command
several() {
	joined "$@" | awk '
		/^[a-z_0-9]+\(\) *\{ *$/ { name = $1; sub(/\(.*/, "", name); n = 0; next }
		/^\}/ { if (name && n > 1) print name; name = "" }
		name && !/^[[:space:]]*(#|local |shift|$)/ { n++ }'
}

# inert FILE HELPERS...: prints these lines
inert() {
	joined "$1" | awk -v names="$(several "$@" | tr '\n' ' ')" '
	BEGIN {
		n = split(names, a, " ")
		for (i = 1; i <= n; i++)
			function_of[a[i]] = 1
		n = split("kill killall wait rmmod ip umount mount rm", a, " ")
		for (i = 1; i <= n; i++)
			tidies[a[i]] = 1
		n = split("tee cat head tail", a, " ")
		for (i = 1; i <= n; i++)
			passes[a[i]] = 1
		n = split("echo printf dmesg", a, " ")
		for (i = 1; i <= n; i++)
			prints[a[i]] = 1
	}
	/^[[:space:]]*#/ { next }
	# a string goes on in the next lines
	{
		for (;;) {
			s = $0
			gsub(/\\./, "", s)
			gsub(/\047[^\047]*\047|"[^"]*"/, "", s)
			sub(/[[:space:]]#[[:space:]].*/, "", s)
			if (s !~ /\047/ || (getline more) <= 0)
				break
			$0 = $0 "\n" more
		}
	}
	/^[[:space:]]*![[:space:]]/ && !/\|\|/ { print; next }
	{
		s = $0
		# what is quoted or substituted has its own rules
		gsub(/\\./, "", s)
		gsub(/\047[^\047]*\047/, "Q", s)
		while (gsub(/[$<]\([^()]*\)/, "S", s))
			;
		gsub(/"[^"]*"/, "Q", s)
		why = s ~ /[[:space:]]#[[:space:]]/
		sub(/[[:space:]]#[[:space:]].*/, "", s)
		sub(/^[a-z_0-9]+\(\) *\{ */, "", s)
		gsub(/\|\|[[:space:]]*(true|:)([[:space:]]*$|[[:space:]]*;)/, "\001", s)
		n = split(s, part, /&&|\|\||;|\001/)
		k = s ~ /\001/ ? first_before(s) : ""
		if (k != "" && !(k in tidies) && !why) {
			print
			next
		}
		for (i = 1; i <= n; i++) {
			m = split(part[i], stage, /\|/)
			if (m < 2)
				continue
			split(stage[1], word)
			split(stage[m], last)
			if (word[1] in function_of || last[1] in passes && !(word[1] in prints)) {
				print
				break
			}
		}
	}
	# the first word of the command that the first "|| true" belongs to
	function first_before(s,    c, w, j) {
		c = split(substr(s, 1, index(s, "\001") - 1), w, /&&|\|\||;|[[:space:]]do[[:space:]]/)
		split(w[c], j)
		return j[1]
	}'
}

# it finds what it has to, and no more
sample=$(mktemp) || exit 1
trap 'rm -f "$sample"' EXIT
cat >"$sample" <<'END'
one() {
	local a=1
	b "$@"
}
two() {
	b
	c
}
	! a |
		b
	! a \
		|| b
	a && ! b
	a || true
	a x 2>/dev/null || :
	a || true	# why
	kill "$a" 2>/dev/null || true
	[ -z "$a" ] || kill "$a" || true
	for i in a; do ip link del "$i" || true; done
	x=$(a || true)
	two x | grep y
	two x |
		tee "$z"
	one x | grep y
	one x | tee z
	echo "a | tee" | tee z
	a "$(two | cat)" 'b | cat'
	a | b | tail -n 1
END
want='	! a | b
	a || true
	a x 2>/dev/null || :
	two x | grep y
	two x | tee "$z"
	one x | tee z
	a | b | tail -n 1'
if [ "$(inert "$sample")" = "$want" ]; then
	passed=$((passed + 1))
else
	printf 'not ok check-bats finds what asserts nothing\n%s\n' "$(inert "$sample" | diff <(echo "$want") -)"
	failed=$((failed + 1))
fi

for f; do
	found=$(inert "$f" $(ls "$(dirname "$f")"/*.bash 2>/dev/null))
	if [ -n "$found" ]; then
		printf 'not ok %s: asserts nothing:\n%s\n' "$f" "$found"
		failed=$((failed + 1))
	else
		passed=$((passed + 1))
	fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
