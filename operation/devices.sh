# SPDX-License-Identifier: GPL-2.0-only
# For ethercatctl: the cards and interfaces of this computer, and which of them a master gets.

# interfaces_of DEVICE: names, by name or MAC address; hardware before what is built on it
interfaces_of() {
	local d mac hardware= other=

	if [ -e "/sys/class/net/$1" ]; then
		echo "$1"
		return
	fi
	for d in $(ls /sys/class/net); do
		read -r mac 2>/dev/null <"/sys/class/net/$d/address" || continue
		[ "$mac" = "$1" ] || continue
		if [ -e "/sys/class/net/$d/device" ]; then
			hardware="$hardware $d"
		else
			other="$other $d"
		fi
	done
	echo ${hardware:-$other}
}

interface() {	# interface DEVICE: the name
	set -- $(interfaces_of "$1")
	[ $# -gt 0 ] && echo "$1"
}

# Cards that only ec_intel may have, whether it is loaded or not: they show no MAC address.
reserved() { (set +f; grep -lx ec_intel /sys/bus/pci/devices/${1:-*}/driver_override 2>/dev/null) }
has_reserved() { [ -n "$(reserved "$@")" ]; }

# take_reserved ID DEVICE: what is left for others
take_reserved() {
	if is_pci "$2"; then
		! has_reserved "$2"
	else
		! is_mac "$2" || interface "$2" >/dev/null
	fi || left=$((left - 1))
}

# Has each MAC address that no interface shows a reserved card that may be it?
enough_reserved() {
	local left

	left=$(reserved | wc -l)
	each_device take_reserved
	[ "$left" -ge 0 ]
}

# is_listed INTERFACE: DEVICE_MODULES names its driver
is_listed() {
	local driver

	driver=$(driver_of "$1")
	[ -n "$driver" ] && { has "$driver" $modules ||
		{ has intel $modules && has "$driver" $native_drivers; }; }
}

# not_named INTERFACE ID DEVICE
not_named() {
	local mac

	read -r mac <"/sys/class/net/$1/address"
	[ "$3" != "$1" ] && [ "$3" != "$mac" ]
}

# is_free INTERFACE: hardware that is not in use
is_free() {
	[ -e "/sys/class/net/$1/device" ] && [ ! -e "/sys/class/net/$1/master" ] &&
		[ ! -e "/sys/class/net/$1/phy80211" ] && each_device not_named "$1" &&
		[ -z "$(ip -o addr show dev "$1" scope global 2>/dev/null)" ]
}

# free_cards: what ff:ff:ff:ff:ff:ff may mean; those of UPDOWN_INTERFACES, else of a driver that
# DEVICE_MODULES names, if there are such
free_cards() {
	local d up_= listed= any=

	for d in $(ls /sys/class/net); do
		is_free "$d" || continue
		if is_listed "$d"; then
			listed="$listed $d"
		elif [ -z "$modules" ] || has generic $modules; then
			any="$any $d"
		else
			continue
		fi
		! has "$d" $up || up_="$up_ $d"
	done
	echo ${up_:-${listed:-$any}}
}

present() {
	is_sim "$1" || [ -e "/sys/bus/pci/devices/$1" ] ||
		interface "$1" >/dev/null || { is_mac "$1" && enough_reserved; } ||
		{ is_any "$1" && { has_reserved || [ -n "$(free_cards)" ]; }; }
}

# each_master COMMAND...: with its number and device
each_master() {
	local i=0 d

	while [ $i -lt "$masters" ]; do
		eval "d=\$device_$i"
		"$@" $i "$d" || return
		i=$((i + 1))
	done
}

# A card is the same whenever it comes: the master waits for it. A name may be another one's.
wait_present() {	# wait_present ID DEVICE
	local what="no such device"

	until present "$2"; do
		# what is missing then is said when it is chosen
		! is_any "$2" || [ $patience != 0 ] || return 0
		if [ $patience = 0 ]; then
			eval "number=\$at_$1"
			if is_mac "$2"; then
				! has_reserved || what="no interface has this address, and ec_intel has too few cards"
				warn "$(variable "$1")=\"$2\": $what after 10 s; the master waits for it, 'ethercat devices' lists the cards"
				return
			fi
			bad "$(variable "$1")=\"$2\": no such device after 10 s; $(instead "$2")"
			return 1
		fi
		patience=$((patience - 1))
		sleep 0.5
	done
}

driver_of() { basename "$(readlink "/sys/class/net/$1/device/driver" 2>/dev/null)" 2>/dev/null; }
# has_native INTERFACE: DEVICE_MODULES names the driver that this card has
has_native() {
	local driver

	driver=$(driver_of "$1")
	[ -n "$driver" ] && has "$driver" $native_drivers &&
		{ has "$driver" $modules || has intel $modules; }
}

# managed INTERFACE: what configures it as a network
managed() {
	local index

	read -r index <"/sys/class/net/$1/ifindex"
	if grep -qs '^ADMIN_STATE=configur' "/run/systemd/netif/links/$index"; then
		echo systemd-networkd
	elif command -v nmcli >/dev/null; then
		case $(timeout 5 nmcli -g GENERAL.STATE device show "$1" 2>/dev/null) in
		''|10\ *) ;;
		*) echo NetworkManager ;;
		esac
	fi
}

# unusable INTERFACE DEVICE: why it can never be the device of a master. A bridge can have the
# address of its port: the master then uses the bridge.
unusable() {
	local type mtu list="; 'ethercat devices' lists the cards"

	read -r type 2>/dev/null <"/sys/class/net/$1/type" || type=1
	if [ "$type" = 772 ]; then
		echo "the loopback interface has no cable$list"
	elif [ "$type" != 1 ]; then
		echo "$1 is not an Ethernet interface$list"
	elif [ -e "/sys/class/net/$1/phy80211" ]; then
		echo "$1 is a wireless interface, slaves need a cable$list"
	elif [ "$1" = "$2" ] && { [ -e "/sys/class/net/$1/brport" ] ||
			[ -e "/sys/class/net/$1/bonding_slave" ]; }; then
		echo "$1 is a port of $(basename "$(readlink "/sys/class/net/$1/master")"); release it with 'ip link set $1 nomaster'"
	elif ! has_native "$1" && read -r mtu 2>/dev/null <"/sys/class/net/$1/mtu" &&
		[ "$mtu" -lt 1500 ]; then
		echo "$1 has MTU $mtu, frames need 1500; run 'ip link set $1 mtu 1500'"
	else
		return 1
	fi
}

# usable ID DEVICE: unless it is an interface that can never be the device of a master
usable() {
	local name why

	is_sim "$2" || ! name=$(interface "$2") || ! why=$(unusable "$name" "$2") || {
		eval "number=\$at_$1"
		bad "$(variable "$1")=\"$2\": $why"
	}
}

# known ID DEVICE: reports a device that is not there
known() {
	local what="$(variable "$1")=\"$2\""

	eval "number=\$at_$1"
	! present "$2" && [ -z "$(recall "$2")" ] || return 0
	if is_mac "$2"; then
		warn "$what: no interface has this address yet; the master waits for it"
	elif is_any "$2"; then
		bad "$what: no card is free; 'ethercat devices' lists the cards"
	elif is_pci "$2"; then
		bad "$what: no card at this PCI address; 'ethercat devices' lists the cards"
	else
		bad "$what: no such interface; $(instead "$2")"
	fi
}

# instead NAME: what to write for a name that no interface has
instead() {
	local other

	if other=$(echo "$1" | tr A-Z a-z) && interface "$other" >/dev/null; then
		echo "write $other"
	elif other=$(altname_of "$1"); then
		echo "write $other, which has this name as another one"
	else
		echo "'ethercat devices' lists the cards"
	fi
}

# altname_of NAME: the interface that has this name as another one
altname_of() {
	local other

	other=$(ip -o link show dev "$1" 2>/dev/null) || return
	other=${other#*: } other=${other%%[:@]*}
	[ -n "$other" ] && [ "$other" != "$1" ] && echo "$other"
}

known_segment() {	# known_segment NAME
	local out

	case $1 in
	/*)	if [ ! -f "$1" ] || [ ! -r "$1" ]; then
			bad "SIM_SEGMENT: no file $1 that can be read"
		elif command -v ethercat-sim >/dev/null; then
			out=$(ethercat-sim --check "$1" 2>&1) || bad "SIM_SEGMENT: $out"
		fi ;;
	*)	has "$1" thin three bench eoe line100 line1000 ||
			bad "SIM_SEGMENT: no segment '$1'; there are thin, three, bench, eoe, line100, line1000, and paths, which begin with /" ;;
	esac
}

# known_ring ID DEVICE: a segment with a second end, if this is one
known_ring() {
	local n=${2#sim} segment

	is_sim "$2" && [ "$n" != "${n%b}" ] || return 0
	segment=$(echo "$segments," | cut -d, -f$((${n%b} + 1)))
	if [ -f "$segment" ] && grep -q '^[^#]*master\.1' "$segment"; then return; fi
	eval "number=\$at_$1"
	bad "$(variable "$1")=\"$2\": the segment $segment is no ring; its description needs a line as 'wire d8.1 -> master.1'"
}

# check_machine [all]: whether this computer has what the configuration names. start waits for
# devices; 'all' reports those that are absent as well.
check_machine() {
	local i

	each_device usable
	[ -z "${1:-}" ] || each_device known
	number=$at_up
	for i in $up; do
		[ -z "${1:-}" ] || [ -e "/sys/class/net/$i" ] ||
			warn "UPDOWN_INTERFACES: no interface $i; 'ip link' lists the interfaces"
	done
	number=$at_bridge
	[ -z "$bridge" ] || [ ! -e "/sys/class/net/$bridge" ] ||
		[ -e "/sys/class/net/$bridge/bridge" ] ||
		bad "EOE_BRIDGE=\"$bridge\": this interface is no bridge; write another name"
	number=$at_segments
	[ "$sims" = 0 ] || for i in $(echo "$segments" | tr , ' '); do known_segment "$i"; done
	each_device known_ring
	[ "$wrong" = 0 ]
}

# check_interface ID DEVICE NAME
check_interface() {
	local all manager

	all=$(interfaces_of "$2")
	eval "number=\$at_$1"
	[ "$all" = "$3" ] ||
		warn "$(variable "$1")=\"$2\": the address of several interfaces ($all), the master uses one of them; write the name instead"
	has "$3" $cards $generic && {
		bad "$(variable "$1")=\"$2\" is $3, which another master has; each master needs its own"
		return 1
	}
	[ -z "$(ip -o addr show dev "$3" scope global 2>/dev/null)" ] ||
		err "warning: $3 has an IP address; no other program can use it while the master does"
	manager=$(managed "$3")
	[ -z "$manager" ] ||
		err "warning: $manager configures $3; exclude it there, see \"Network configuration\" in install.rst"
}

# recall DEVICE: its line in $state
recall() {
	[ -f $state ] && awk -v device="$1" '$2 == device || $3 == device { print; exit }' $state
}

# loaded_device ID: what ec_master was loaded with
loaded_device() {
	local all list=main

	[ "$1" = "${1%b}" ] || list=backup
	read -r all 2>/dev/null </sys/module/ec_master/parameters/${list}_devices || return
	echo "$all," | cut -d, -f$((${1%b} + 1))
}

# choose_any ID: sets device, to the only card that it may be. A wrong one could be the network
# of this computer.
choose_any() {
	local found what="$(variable "$1")=\"ff:ff:ff:ff:ff:ff\""

	eval "number=\$at_$1"
	device=$(loaded_device "$1")
	[ -z "$device" ] || is_sim "$device" || return 0
	# one that is reserved for a master comes before one that may be the network
	found=
	has_reserved || found=$(free_cards)
	case $found in
	*' '*)	bad "$what may be each of: $found; write the MAC address of the card with the slaves"
		return 1 ;;
	?*)	read -r device <"/sys/class/net/$found/address" ;;
	*)	device=ff:ff:ff:ff:ff:ff
		has_reserved || {
			bad "$what: no card is free (with one of the drivers $(echo ${modules:-generic}), without an IP address, no port of a bridge); 'ethercat devices' lists the cards"
			return 1
		} ;;
	esac
}

# end ID: as 'ethercat master' names it
end() { if [ "$1" = "${1%b}" ]; then echo Main; else echo Backup; fi; }

# attached ID: the master has its card already, an application may be in OP
attached() {
	loaded ec_master && ethercat master -m "${1%b}" 2>/dev/null |
		grep -q "^ *$(end "$1"): .*(attached)"
}

# choose ID DEVICE: adds to main or backup what ec_master gets, and to cards, generic or either (the
# driver is chosen already or not known yet) what drives it
choose() {
	local name card pci mac device=$2

	! is_any "$2" || choose_any "$1" || return
	card=$(recall "$device") pci=${card%% *} mac=$device
	[ -z "$card" ] || mac=${card##* }
	if ! is_sim "$device" && name=$(interface "$device"); then
		check_interface "$1" "$device" "$name" || return
		if [ "$pci" = - ]; then
			either="$either $name"
		elif has_native "$name" && attached "$1"; then
			either="$either $name"
			device=$(loaded_device "$1")
			[ "$(interface "$device")" != "$name" ] || mac=$device
		elif has_native "$name"; then
			read -r mac <"/sys/class/net/$name/address"
			cards="$cards $name"
		else
			generic="$generic $name"
			chosen="$chosen- $name $mac\n"
		fi
	elif is_pci "$pci"; then
		native=1
	elif is_pci "$device" && ! has_reserved "$device"; then
		err "$2 does not have the driver ec_intel; run 'ethercat device bind $2 --boot', or name the card by its MAC address"
		return 1
	elif is_pci "$device"; then
		native=1
	elif is_mac "$device" && has_reserved; then
		native=1 either="$either $device"
	elif is_any "$device" && has_reserved; then
		native=1
	elif ! is_sim "$device"; then
		generic="$generic $device"
	fi
	case $1 in
	0)	main=$mac asked=$2 ;;
	*b)	backup=$backup$mac asked_backup=$asked_backup$2 ;;
	*)	main=$main,$mac asked=$asked,$2 backup=$backup, asked_backup=$asked_backup, ;;
	esac
}
