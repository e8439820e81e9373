# SPDX-License-Identifier: GPL-2.0-only
# For ethercatctl: the configuration file. Its lines are read, never run.
#
# parse FILE sets: masters (their number), device_N and at_N (the line of it), device_Nb and at_Nb
# (its backup device, if it has one), modules, up and at_up (interfaces), modprobe_flags, segments
# and at_segments, bridge and at_bridge, addresses and at_addresses (of the bridge)

native_drivers="e1000 e1000e igb intel"
other_drivers="generic sim igc r8169 e100 8139too r8152 cx2100 ccat genet dwmac-intel stmmac-pci"

say() { echo "ethercatctl: $*"; }
err() { echo "ethercatctl: $*" >&2; }
die() {
	err "$@"
	exit 1
}

# of the present line
bad() {
	echo "$conf:$number: $*" >&2
	wrong=1
}
warn() { echo "$conf:$number: $*" >&2; }

# has WORD WORD...: one of the others is the first
has() {
	local w first=$1

	shift
	for w; do [ "$w" != "$first" ] || return 0; done
	return 1
}

is_number() { case $1 in ''|*[!0-9]*|0?*) return 1 ;; esac; }

hex='[0-9a-f]'
is_mac() {
	! is_any "$1" || return 1
	case $1 in $hex$hex:$hex$hex:$hex$hex:$hex$hex:$hex$hex:$hex$hex) ;; *) return 1 ;; esac
}
is_any() { [ "$1" = ff:ff:ff:ff:ff:ff ]; }
is_pci() { case $1 in $hex$hex$hex$hex:$hex$hex:$hex$hex.[0-7]) ;; *) return 1 ;; esac; }
is_sim() { case $1 in sim[0-9]|sim[0-9]b) ;; *) return 1 ;; esac; }
is_interface() {
	case $1 in ''|.|..|-*|*[:/,]*|*[[:space:]]*) return 1 ;; esac
	[ ${#1} -le 15 ]
}

# lower DEVICES: addresses in lower case, names as they are
lower() { echo "$1" | tr , '\n' | sed '/:/y/ABCDEF/abcdef/' | paste -sd,; }

# proposal VALUE: how a device that looks like this one is written
proposal() {
	local d=[0-9a-fA-F]

	case $1 in
	$d$d[.-]$d$d[.-]$d$d[.-]$d$d[.-]$d$d[.-]$d$d) echo "$1" | tr .- :: ;;
	$d$d$d$d$d$d$d$d$d$d$d$d) echo "$1" | sed 's/..\B/&:/g' ;;
	$d$d:$d$d.[0-7]) echo "0000:$1" ;;
	[sS][iI][mM]|[sS][iI][mM]0) echo sim0 ;;
	[sS][iI][mM][1-7]) echo "sim${1#???}" ;;
	[sS][iI][mM][0-7][bB]) echo "sim$(echo "${1#???}" | tr B b)" ;;
	*) return 1 ;;
	esac
}

# not_a_device NAME VALUE: the error
not_a_device() {
	local what="is neither a MAC address, as 00:11:22:33:44:55, nor an interface, a PCI address, as 0000:01:00.0, or sim0"

	case $2 in
	*[,\ ]*)	what="is not one device; a second master has a variable of its own, MASTER1_DEVICE" ;;
	esac
	bad "$1=\"$2\" $what; 'ethercat devices' lists the cards"
}

# variable DEVICE-ID: its name; a device has the number of its master, with b: the backup device
variable() {
	case $1 in
	*b)	echo "MASTER${1%b}_BACKUP" ;;
	*)	echo "MASTER$1_DEVICE" ;;
	esac
}

# set_device DEVICE-ID VALUE
set_device() {
	local value old was name

	name=$(variable "$1") value=$(lower "$2")
	if ! is_sim "$value" && old=$(proposal "$2"); then
		bad "$name=\"$2\": write $old"
		return
	fi
	case $value in
	sim[1-9][0-9]*) bad "$name=\"$2\": the simulator has sim0 to sim7" ;;
	00:00:00:00:00:00) bad "$name=\"$2\": no card has this address; 'ethercat devices' lists the cards" ;;
	ff:ff:ff:ff:ff:ff|'') ;;
	?[13579bdf]:*:*:*:*:*) bad "$name=\"$2\" is a multicast address; 'ethercat devices' lists the cards" ;;
	*)	is_mac "$value" || is_pci "$value" || is_interface "$value" ||
			not_a_device "$name" "$2" ;;
	esac
	eval "old=\${device_$1:-} was=\${at_$1:-}"
	[ -z "$old" ] || [ "$old" = "$value" ] ||
		warn "$name replaces the value \"$old\" of line $was"
	eval "device_$1=\$value at_$1=\$number"
}

set_master() {	# set_master NAME VALUE
	local index=${1#MASTER}

	index=${index%_*}
	if ! is_number "$index" || [ ${#index} -gt 2 ] || [ "$index" -gt 31 ]; then
		bad "$1: the masters are MASTER0 to MASTER31"
		return
	fi
	case $1 in
	*_DEVICE) set_device "$index" "$2" ;;
	*)	set_device "${index}b" "$2" ;;
	esac
}

set_modules() {
	local m

	modules=
	case $1 in
	*,*)	bad "DEVICE_MODULES=\"$1\": separate names by blanks"
		return ;;
	esac
	for m in $1; do
		m=${m#ec_}
		has "$m" $native_drivers $other_drivers ||
			bad "DEVICE_MODULES: unknown driver '$m'; use generic, or one of $native_drivers for the native driver"
		modules="$modules $m"
	done
}

set_interfaces() {	# set_interfaces NAME VALUE
	local i

	for i in $2; do
		is_interface "$i" || bad "$1: '$i' is not the name of an interface; separate names by blanks"
		has "$i" $up || up="$up $i"
	done
	at_up=$number
}

set_segments() {
	case $1 in
	*[[:space:]]*|,*|*,|*,,*) bad "SIM_SEGMENT=\"$1\": names or paths separated by commas, no blanks" ;;
	esac
	segments=$1 at_segments=$number
}

set_flags() {
	local w

	for w in $1; do
		case $w in
		-*) ;;
		*) bad "MODPROBE_FLAGS: '$w' is not an option of modprobe; parameters belong into /etc/modprobe.d/ethercat.conf" ;;
		esac
	done
	modprobe_flags=$1
}

set_bridge() {
	at_bridge=$number bridge=$1
	case $1 in
	'')	return ;;
	*%*)	;;
	*)	! is_interface "$1" || return 0 ;;
	esac
	bad "EOE_BRIDGE=\"$1\" is no name of a bridge: 1 to 15 characters, no slash, no colon, no comma, no blank, no %"
}

# is_upto NUMBER MAX
is_upto() { is_number "$1" && [ ${#1} -le 3 ] && [ "$1" -le "$2" ]; }

# is_address TEXT: 192.168.5.1/24 or fd00::1/64; ip(8) knows it better
is_address() {
	local ip=${1%/*} bits=${1##*/} n=0 rest

	case $1 in
	*/*/*|/*|*[!0-9a-fA-F.:/]*) return 1 ;;
	*:*/*)	is_upto "$bits" 128 && [ "$bits" -gt 0 ]
		return ;;
	*/*)	is_upto "$bits" 32 && [ "$bits" -gt 0 ] || return ;;
	*)	return 1 ;;
	esac
	rest=$ip.
	while [ -n "$rest" ]; do
		is_upto "${rest%%.*}" 255 || return
		rest=${rest#*.} n=$((n + 1))
	done
	[ $n = 4 ]
}

set_bridge_address() {
	local a

	for a in $1; do
		is_address "$a" ||
			bad "EOE_BRIDGE_ADDRESS: '$a' is no address with a prefix length, as 192.168.5.1/24; separate addresses by blanks"
	done
	addresses=$1 at_addresses=$number
}

unknown_variable() {
	local upper

	upper=$(echo "$1" | tr a-z A-Z)
	case $upper in
	"$1") ;;
	MASTER*_DEVICE|MASTER*_BACKUP|DEVICE_MODULES|UPDOWN_INTERFACES|SIM_SEGMENT|MODPROBE_FLAGS|\
	EOE_BRIDGE|EOE_BRIDGE_ADDRESS)
		bad "unknown variable $1; write $upper"
		return ;;
	esac
	warn "unknown variable $1 has no effect; see 'man ethercatctl'"
}

set_variable() {	# set_variable NAME VALUE
	case $1 in
	MASTER*_DEVICE|MASTER*_BACKUP) set_master "$1" "$2" ;;
	DEVICE_MODULES) set_modules "$2" ;;
	UPDOWN_INTERFACES|LINK_DEVICES) set_interfaces "$1" "$2" ;;
	MODPROBE_FLAGS) set_flags "$2" ;;
	SIM_SEGMENT) set_segments "$2" ;;
	EOE_BRIDGE) set_bridge "$2" ;;
	EOE_BRIDGE_ADDRESS) set_bridge_address "$2" ;;
	EOE_INTERFACES|EOE_AUTOCREATE|PCAP_SIZE_MB|REBIND_NICS)
		[ -z "$2" ] || warn "$1 has no effect in this version" ;;
	*)	unknown_variable "$1" ;;
	esac
}

# marks that word processors and web pages have instead of " and '
typographic=$(printf '\342\200%b ' '\0230' '\0231' '\0232' '\0234' '\0235' '\0236')
typographic="$typographic $(printf '\302%b ' '\0253' '\0273' '\0264')"
no_break=$(printf '\302\240')

# is_typed TEXT: without such marks
is_typed() {
	local mark

	for mark in $typographic; do
		case $1 in
		*"$mark"*)
			bad "'$1' has typographic quotes; write \" at both ends"
			return 1 ;;
		esac
	done
	case $1 in
	*"$no_break"*)
		bad "'$1' has a no-break space; write a blank"
		return 1 ;;
	esac
}

trim() {
	text=${text#"${text%%[![:space:]]*}"}
	text=${text%"${text##*[![:space:]]}"}
}

# value TEXT: sets value; what follows it can only be a comment
parse_value() {
	text=$1
	case $text in
	\"*\"*) text=${text#\"} value=${text%%\"*} text=${text#*\"} ;;
	\'*\'*)	text=${text#\'} value=${text%%\'*} text=${text#*\'} ;;
	[\"\']*)
		is_typed "$text" && bad "the closing quote is missing; a value ends in its line"
		return 1 ;;
	*)	value=${text%%[[:space:]]*} text=${text#"$value"} ;;
	esac
	is_typed "$value" && is_typed "${text%%#*}" || return
	trim
	case $text in
	''|'#'*) ;;
	*)	bad "'$text' follows the value; put values with blanks into quotes"
		return 1 ;;
	esac
	case $value in
	*[\$\`\\\;\&\|\<\>\(\)\"\']*)
		bad "'$value': this file is not run as a shell script; write the value itself"
		return 1 ;;
	esac
}

parse_line() {
	local name

	text=$1
	trim
	case $text in
	''|'#'*) return ;;
	*=*) ;;
	*)	bad "'$text' is no line NAME=\"value\""
		return ;;
	esac
	name=${text%%=*}
	case $name in
	'export '*)
		bad "'$name': this file is not run as a shell script; write ${name#export }=..."
		return ;;
	''|[0-9]*|*[!A-Za-z0-9_]*)
		is_typed "$name" &&
			bad "'$name' is no name of a variable; write NAME=\"value\" without blanks beside ="
		return ;;
	esac
	parse_value "${text#*=}" && set_variable "$name" "$value"
}

# each_device COMMAND...: of the masters, with its ID and name
each_device() {
	local i=0 id d

	while [ $i -lt "$masters" ]; do
		for id in $i ${i}b; do
			eval "d=\${device_$id:-}"
			[ -z "$d" ] || "$@" $id "$d" || return
		done
		i=$((i + 1))
	done
}

# differs ID DEVICE OTHER-ID OTHER: says so if it is not, and ends the loop
differs() {
	[ "$1" != "$3" ] || return
	[ "$2" != "$4" ] || {
		eval "number=\$at_$1"
		case $1$3 in
		*b*)	bad "$(variable "$1")=\"$2\" is also $(variable "$3"); each end of a ring needs its own" ;;
		*)	bad "MASTER$1_DEVICE=\"$2\" is the device of MASTER$3; each master needs its own" ;;
		esac
	}
}

# check_device ID DEVICE
check_device() {
	local main

	each_device differs "$1" "$2"
	case $1 in *b) ;; *) return 0 ;; esac
	eval "main=\$device_${1%b} number=\$at_$1"
	if is_any "$2" || is_any "$main"; then
		bad "$(variable "$1"): with a backup device both ends of the ring need the name or address of their device, not ff:ff:ff:ff:ff:ff"
	fi
}

# the masters are those before the first gap; each device has one end of one bus
check_masters() {
	local i=0

	masters=0
	while [ $i -lt 32 ]; do
		eval "value=\${device_$i:-} number=\${at_$i:-0}"
		if [ -n "$value" ] && [ $i -gt $masters ]; then
			warn "MASTER${i}_DEVICE has no effect, since MASTER${masters}_DEVICE is empty"
		elif [ -n "$value" ]; then
			masters=$((masters + 1))
		fi
		eval "value=\${device_${i}b:-} number=\${at_${i}b:-0}"
		[ -z "$value" ] || [ $i -lt $masters ] ||
			bad "MASTER${i}_BACKUP=\"$value\": there is no master $i; set MASTER${masters}_DEVICE, the main device, first"
		i=$((i + 1))
	done
	each_device check_device
}

# need_segment ID DEVICE: sim2 needs three
need_segment() {
	local n=${2#sim}

	n=${n%b}
	if is_sim "$2" && [ "$n" -ge $need ]; then
		need=$((n + 1))
		eval "number=\$at_$1"
	fi
}

# without SIM_SEGMENT each is the bench
check_segments() {
	local i need=0 text

	each_device need_segment
	sims=$need
	[ "$need" -gt 0 ] || return 0
	[ "$need" -le 8 ] || bad "sim$((need - 1)): the simulator has sim0 to sim7"
	text=$segments i=0
	if [ -n "$text" ]; then
		while [ -n "$text" ]; do
			i=$((i + 1))
			case $text in *,*) text=${text#*,} ;; *) text= ;; esac
		done
		[ $i -ge "$need" ] ||
			bad "sim$((need - 1)) needs $need segments, SIM_SEGMENT names $i"
	else
		while [ $i -lt "$need" ]; do
			segments=${segments:+$segments,}bench
			i=$((i + 1))
		done
	fi
}

# no_bridge ID DEVICE
no_bridge() {
	[ "$2" != "$bridge" ] ||
		bad "EOE_BRIDGE=\"$bridge\" is the device of MASTER${1%b}; the fieldbus is no port of a network, write another name"
}

# the bridge is none of the masters' devices, and has the addresses
check_bridge() {
	number=$at_addresses
	[ -n "$bridge" ] || [ -z "$addresses" ] ||
		bad "EOE_BRIDGE_ADDRESS=\"$addresses\" needs EOE_BRIDGE, the name of the bridge"
	number=$at_bridge
	[ -z "$bridge" ] || each_device no_bridge
}

# parse FILE: exit code 6 if it cannot be read, 1 after messages with its lines
parse() {
	local line mark

	mark=$(printf '\357\273\277')
	conf=$1 number=0 wrong=0 modules= up= at_up=0 modprobe_flags= segments= at_segments=0 sims=0
	bridge= at_bridge=0 addresses= at_addresses=0
	if [ ! -f "$conf" ] || [ ! -r "$conf" ]; then
		if [ -e "$conf" ]; then
			err "cannot read the configuration $conf: no file that you may read"
		else
			err "cannot read the configuration $conf: it does not exist"
		fi
		exit 6
	fi
	while IFS= read -r line || [ -n "$line" ]; do
		number=$((number + 1))
		# editors of other systems begin a file with this mark
		[ $number != 1 ] || line=${line#"$mark"}
		parse_line "$line"
	done <"$conf"
	check_masters
	check_segments
	check_bridge
	[ $wrong = 0 ] || exit 1
}

# as parse, for what needs a master
read_masters() {
	parse "$conf"
	[ "$masters" -gt 0 ] ||
		die "$conf names no master: set MASTER0_DEVICE to a MAC address, an interface or sim0; 'ethercat devices' lists the cards"
}
