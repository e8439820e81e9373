# SPDX-License-Identifier: GPL-2.0-only
# bash completion of ethercat; masters, positions, aliases and domains are
# those of the running master

_ethercat_values()
{
	# $1: kind, $2: -m option of the line, if any
	case $1 in
	master)
		local f
		for f in "${EC_DEVICE_DIR:-/dev}"/EtherCAT*; do
			[ -e "$f" ] && echo "${f##*EtherCAT}"
		done
		;;
	position)
		ethercat slaves $2 2>/dev/null | awk '$2 ~ /:/ { print $1 }'
		;;
	alias)
		ethercat slaves $2 2>/dev/null |
			awk '$2 ~ /:/ { split($2, a, ":"); if (a[1] > 0) print a[1] }' | sort -nu
		;;
	domain)
		ethercat domains $2 2>/dev/null |
			sed -n 's/^ *Domain\([0-9]*\):.*/\1/p'
		;;
	type)
		ethercat help types 2>/dev/null | awk '/ bit$| variable$/ { print $1 }'
		;;
	command)
		ethercat help 2>/dev/null |
			awk '/^Options/ { exit } /^  [a-z]/ { print $1 }'
		;;
	device)
		ethercat devices 2>/dev/null |
			awk 'NR > 1 { for (i = 1; i < 3; i++) if ($i != "-") print $i }'
		;;
	option)
		ethercat help ${2:+"$2"} 2>/dev/null |
			grep -oE '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,'
		;;
	esac
}

# Names with blanks stay whole and get their quotes from bash, a folder gets its slash.
_ethercat_files()
{
	compopt -o filenames
	mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}

_ethercat()
{
	local cur prev cmd= master= i w
	cur=${COMP_WORDS[COMP_CWORD]}
	prev=${COMP_WORDS[COMP_CWORD - 1]}
	COMPREPLY=()

	for ((i = 1; i < COMP_CWORD; i++)); do
		w=${COMP_WORDS[i]}
		case $w in
		-m|--master)
			master="-m ${COMP_WORDS[++i]}" ;;
		-a|-p|-d|-t|-o|-s|--alias|--position|--domain|--type|--output-file|--skin|--save|\
		--compare|--compare-slave|--texts|--watch|--timeout|--when|--before|--after|--time|\
		--count)
			((i++)) ;;
		-*)	;;
		*)	[ -n "$cmd" ] || cmd=$w ;;
		esac
	done

	case $prev in
	-m|--master)	w=$(_ethercat_values master) ;;
	-a|--alias)	w=$(_ethercat_values alias "$master") ;;
	-p|--position|--compare-slave)
			w=$(_ethercat_values position "$master") ;;
	-d|--domain)	w=$(_ethercat_values domain "$master") ;;
	-t|--type)	w=$(_ethercat_values type) ;;
	-s|--skin)	w="default etherlab" ;;
	-o|--output-file|--save|--compare|--texts)
		_ethercat_files
		return ;;
	*)
		case $cur in
		-*)	w=$(_ethercat_values option "$cmd") ;;
		*)
			case $cmd in
			"")	w=$(_ethercat_values command) ;;
			datagram)
				w=
				[ "$prev" != datagram ] ||
					w="NOP APRD APWR APRW FPRD FPWR FPRW BRD BWR BRW LRD LWR LRW ARMW FRMW" ;;
			states)	w="INIT PREOP BOOT SAFEOP OP" ;;
			graph)	w="DC CRC" ;;
			units)	w="take" ;;
			bus)
				case $prev in
				bus) w="save check diff show compile schema" ;;
				*) _ethercat_files
				   return ;;
				esac ;;
			why)	w=$(_ethercat_values position "$master") ;;
			crc)	w="reset" ;;
			debug)	w="0 1 2" ;;
			device)
				case $prev in
				bind|unbind|use) w=$(_ethercat_values device) ;;
				--backup)	w="$(_ethercat_values device) none" ;;
				device)		w="bind unbind use" ;;
				*)		w= ;;
				esac ;;
			help)	w="$(_ethercat_values command) types" ;;
			reg_write|foe_write|firmware|plot)
				_ethercat_files
				return ;;
			*)	w= ;;
			esac ;;
		esac ;;
	esac
	COMPREPLY=($(compgen -W "$w" -- "$cur"))
}

complete -F _ethercat ethercat
