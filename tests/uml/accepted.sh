#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Fails for a line of a fragment that kbuild dropped because a dependency is not met.
# usage: accepted.sh .config FRAGMENT...
set -euo pipefail

config=$1
shift
while read -r line; do
	case "$line" in
	CONFIG_*=n) grep -q "^${line%=n}=" "$config" || continue ;;
	CONFIG_*) grep -qxF "$line" "$config" && continue ;;
	'# CONFIG_'*' is not set')
		o=${line#\# }; o=${o% is not set}
		grep -q "^$o=" "$config" || continue ;;
	*) continue ;;
	esac
	echo "accepted.sh: option not accepted by this kernel: $line" >&2
	exit 1
done < <(cat "$@")
