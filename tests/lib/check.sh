#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# Checks of ecrt.h and libethercat that need no kernel. The last line of
# output is "N passed, N failed".

set -u
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../.." && pwd)
o=${O:-$here/build}
mkdir -p "$o" && o=$(cd "$o" && pwd) || exit 1
cd "$here" || exit 1

: "${CC:=gcc}" "${CXX:=g++}" "${MAKE:=make}"
warn="-Wall -Wextra -Wpedantic -Werror"
san="-fsanitize=address,undefined -fno-sanitize-recover=all -g -O1"
. "$top/tests/t.sh"

# with each macro used, and with all numbers and sizes looked at
header_compiles() {	# header_compiles COMPILER STANDARD LANGUAGE
	$1 -std=$2 -x $3 $warn -I"$top/include" -fsyntax-only access.c &&
	$1 -std=$2 -x $3 $warn -I"$top/include" -fsyntax-only types.c
}

names() {	# names of the functions a list of prototypes declares
	grep -o 'ecrt_[a-z0-9_]*(' "$1" | tr -d '(' | sort
}

# what the preprocessor leaves of the header, one prototype a line
declared() {	# declared OPTION...
	echo '#include "ecrt.h"' | $CC -E -P -I"$top/include" "$@" - |
		tr '\n' ' ' | grep -o 'ecrt_[a-z0-9_]*(\([^(){}]\|([^(){}]*)\)*) *;' |
		grep '[a-z_] \|(void)' >"$o/declared"
	names "$o/declared"
}

# a second declaration that differs in any type is an error to the compiler
prototypes_equal() {	# prototypes_equal COMPILER LANGUAGE
	{
		echo '#include "ecrt.h"'
		[ "$2" = c ] || echo 'extern "C" {'
		cat prototypes.txt
		[ "$2" = c ] || echo '}'
	} >"$o/prototypes.$2"
	$1 -x $2 $warn -I"$top/include" -fsyntax-only "$o/prototypes.$2"
}

header_declares_list() { diff <(names prototypes.txt) <(declared); }

# "name node" for each symbol
map_symbols() {
	awk '/^LIBETHERCAT/ { node = $1 } /^\t\tecrt_/ {
		sub(/;/, ""); print $1, node }' "$top/lib/libethercat.map" | sort
}

exported() {
	readelf -W --dyn-syms "$o/lib/libethercat.so.1.2.0" |
		awk '$7 != "UND" && $4 != "NOTYPE" && $8 ~ /@@/ && $8 !~ /^LIBETHERCAT/ {
			sub(/@@/, " ", $8); print $8 }' | sort
}

# tests/apps/api calls every function in the VM; a missing one shows here already
api_calls() {
	diff <(names prototypes.txt) \
		<(grep -oh 'CALL(ecrt_[a-z0-9_]*)' ../apps/api/*.c | tr -d '()' | sed 's/CALL//' |
		  sort -u) || { echo "add CALL(function)(...) to a case in tests/apps/api"; return 1; }
}

# "name node" in the package
package_symbols() {
	sed -n 's/^ \(ecrt_[a-z0-9_]*\)@\(LIBETHERCAT_[A-Z0-9_.]*\) .*/\1 \2/p' \
		"${1:-$top/debian/libethercat1.symbols}" | sort
}

# no release adds to the symbol version of one before it
one_release_each() {
	sed -n 's/^ ecrt_[a-z0-9_]*@\(LIBETHERCAT_[A-Z0-9_.]*\) \(.*\)/\1 \2/p' \
		"${1:-$top/debian/libethercat1.symbols}" | sort -u |
		awk 'seen[$1]++ { print $1 " has symbols of " $2 " as well"; bad = 1 }
		     END { exit bad || !NR }'
}

late_symbol_is_noticed() {
	sed 's/^ \(ecrt_domain_age@LIBETHERCAT_EC_1\) .*/ \1 0.2.0/' \
		"$top/debian/libethercat1.symbols" >"$o/late.symbols"
	! one_release_each "$o/late.symbols"
}

gensymbols() {	# gensymbols PACKAGE LIBRARY
	local tree=$o/package

	rm -rf "$tree"
	mkdir -p "$tree/DEBIAN"
	(cd "$top" && dpkg-gensymbols -p$1 -v0.1.0 -P"$tree" -c4 -Idebian/$1.symbols -e"$o/$2")
}

soname() {
	readelf -d "$o/lib/libethercat.so.1.2.0" |
		grep -q 'SONAME.*\[libethercat\.so\.1\]'
}

# libc only, and no more of it than the loader itself
needs_libc_only() {
	! readelf -d "$o/lib/libethercat.so.1.2.0" | grep NEEDED |
		grep -v 'libc\.so\|ld-linux'
}

build_lib() { $MAKE -s -C "$top/lib" O="$o/lib" CFLAGS="-O2 -Werror" all; }

installs() {
	local d=$o/root
	rm -rf "$d"
	$MAKE -s -C "$top/lib" O="$o/lib" prefix=/usr DESTDIR="$d" install &&
	echo '#include <ecrt.h>
		int main(void) { return ecrt_version_magic() != ECRT_VERSION_MAGIC; }' \
		>"$o/user.c" &&
	$CC -o "$o/user" "$o/user.c" -I"$d/usr/include" -L"$d/usr/lib" \
		-lethercat &&
	LD_LIBRARY_PATH=$d/usr/lib "$o/user" &&
	grep -q '^prefix=/usr$' "$d/usr/lib/pkgconfig/libethercat.pc" &&
	$MAKE -s -C "$top/lib" O="$o/lib" prefix=/usr DESTDIR="$d" uninstall &&
	[ -z "$(find "$d" ! -type d)" ]
}

access_works() {	# access_works COMPILER LANGUAGE
	$1 -x $2 $warn $san -I"$top/include" -c -o "$o/access.o" access.c &&
	$CC $san -D_GNU_SOURCE -c -o "$o/real.o" "$top/lib/real.c" &&
	$1 $san -o "$o/access" "$o/access.o" "$o/real.o" && "$o/access"
}

# each macro is exactly one instruction that touches memory, at any -O
one_access() {
	$CC -O2 -I"$top/include" -x c -S -o - - <<-'END' | tee "$o/one.s" |
		#include "ecrt.h"
		unsigned f(void *p) { return EC_READ_U32((char *)p + 1); }
		void g(void *p) { EC_WRITE_U32((char *)p + 1, 5); EC_WRITE_U32((char *)p + 1, 6); }
		void h(void *p) { (void)EC_READ_U16(p); }
	END
	grep -c '(%rdi)' | grep -qx 4
}

kernel_words() {	# the part of the header that the kernel sees
	kernel_cc -fsyntax-only -x c - <<-'END'
		#include "ecrt.h"
		uint16_t f(const void *p) { return EC_READ_U16(p); }
		#ifdef EC_READ_REAL
		#error floating point in the kernel
		#endif
	END
}

# the same three questions for applications in the kernel
kernel_cc() { $CC -std=gnu11 $warn -D__KERNEL__ -nostdinc -Ikernel -I"$top/include" "$@"; }

kernel_prototypes_equal() {
	{ echo '#include "ecrt.h"'; cat prototypes_kernel.txt; } >"$o/prototypes_kernel.c"
	kernel_cc -fsyntax-only "$o/prototypes_kernel.c"
}

kernel_declares_list() {
	diff <(names prototypes_kernel.txt) <(declared -D__KERNEL__ -nostdinc -Ikernel)
}

# --- what the IgH EtherCAT Master and its patches have ---
kernel_exports() {	# a macro exports what several kinds of requests have
	grep -rhoP '^EXPORT_SYMBOL(_GPL)?\(\Kecrt_[a-z0-9_]*' "$top/master"
	for f in "$top"/lib/ecrt/*.c; do
		sed 's/^EXPORT_SYMBOL_GPL(/EXPORTED(/' "$f" |
			$CC -E -P -fms-extensions -D_GNU_SOURCE -I"$top/lib/ecrt" -x c -
	done | grep -oP 'EXPORTED\(\Kecrt_[a-z0-9_]*'
}

igh() {	# igh.py with the functions of both sides
	comm -12 <(declared) <(map_symbols | cut -d' ' -f1) >"$o/igh.user"
	kernel_exports | sort |
		comm -12 - <(declared -D__KERNEL__ -nostdinc -Ikernel) >"$o/igh.kernel"
	./igh.py "$1" "$o/igh.user" "$o/igh.kernel"
}

library_works() {
	$CC -std=gnu11 -fms-extensions $warn -Wno-pedantic $san -D_GNU_SOURCE \
		-Wl,--wrap=open,--wrap=ioctl,--wrap=mmap,--wrap=close,--wrap=posix_fadvise \
		-pthread -o "$o/session" session.c request.c soe.c foe.c dict.c eoe.c \
		events.c extension.c rules.c kernel_cycle.c ../fake/*.c \
		"$top"/lib/*.c "$top"/lib/ecrt/*.c \
		"$top"/master/wire/{al,coe,emergency,event{,_text},port_text,replay,sii}.c &&
	"$o/session" 2>"$o/session.err" || { cat "$o/session.err"; return 1; }
}

says_why() {	# needs library_works
	grep -qx 'Failed to reserve master 0: Device or resource busy: owned by somebody' \
		"$o/session.err" &&
	grep -q "^Failed to open /dev/EtherCAT7: No such file or directory: start the masters: " \
		"$o/session.err" &&
	grep -q "^Failed to register 0x6000:01 of slave 0:1: No such file or directory" \
		"$o/session.err"
}

cyclic_is_silent() { ! grep 'Failed to \(send\|receive\|process\|queue\)' "$o/session.err"; }

# --- libethercat-tools, libethercat-bus: LIBRARY is tools or bus ---
# libethercat-bus has functions of applications as well, in load.h
declare -A begins=([tools]=ect [bus]='ec[br]t*')

map_of() {	# map_of LIBRARY
	sed -n "s/^\t\t\(${begins[$1]}_[a-z0-9_]*\);/\1/p" "$top/lib/$1/libethercat-$1.map" | sort
}

other_headers() {	# other_headers LIBRARY
	echo "#include <ethercat-$1.h>"
	[ "$1" = tools ] || echo '#include <ethercat-bus/load.h>'
}

other_declares() {	# other_declares LIBRARY
	other_headers "$1" | $CC -E -P -D__ECRT_H__ -I"$top/include" - | tr '\n' ' ' |
		grep -o "${begins[$1]}_[a-z0-9_]*([^(){};]*) *;" | grep -o '^[a-z0-9_]*' | sort
}

other_exports() {	# other_exports LIBRARY
	readelf -W --dyn-syms "$o/$1/libethercat-$1.so.1" |
		awk -v begin="^${begins[$1]}_" -v version="@@LIBETHERCAT_${1^^}_1\$" '
			$7 != "UND" && sub(version, "", $8) && $8 ~ begin { print $8 }' | sort
}

# each has its text as the header's other functions
described() {	# described LIBRARY
	diff <(map_of "$1") <(sed -n "s/^ \* \(${begins[$1]}_[a-z0-9_]*\)() - .*/\1/p" \
		"$top/include/ethercat-$1"/*.h | sort)
}

packaged() {	# packaged LIBRARY
	diff <(map_of "$1") <(sed -n \
		"s/^ \(${begins[$1]}_[a-z0-9_]*\)@LIBETHERCAT_${1^^}_1 .*/\1/p" \
		"$top/debian/libethercat-${1}1.symbols")
}

has_soname() {	# has_soname LIBRARY
	readelf -d "$o/$1/libethercat-$1.so.1" | grep -q "SONAME.*\[libethercat-$1\.so\.1\]"
}

needs_only() {	# needs_only LIBRARY PATTERN
	! readelf -d "$o/$1/libethercat-$1.so.1" | grep NEEDED | grep -v "$2"
}

other_header_compiles() {	# other_header_compiles LIBRARY COMPILER STANDARD LANGUAGE
	other_headers "$1" | $2 -std=$3 -x $4 $warn -I"$top/include" -fsyntax-only -
}

# what the tests of the tool do not show: handles, sizes, failures, threads
tools_work() {	# tools_work SANITIZERS
	$CC -std=gnu11 -fms-extensions -Wall -Wextra -Werror $1 -D_GNU_SOURCE -pthread \
		-o "$o/tools-test" tools.c ../fake/fake_*.c \
		$(ls "$top"/lib/tools/*.c | grep -v /sys.c) -I"$top/include" \
		"$top"/lib/bus/{names,table}.c \
		"$top"/master/wire/{al,coe,dc,emergency,eoe{,_frame},event{,_text},foe,mbox}.c \
		"$top"/master/wire/{port_text,replay,sdo,sdoinfo,sii,soe,voe}.c &&
		setarch -R "$o/tools-test"
}

bus_names() {
	$CC -std=gnu11 $warn $san -I"$top/include" -o "$o/bus-names" bus_names.c \
		"$top"/lib/bus/{names,table}.c && "$o/bus-names"
}

bus_file() {
	$CC -std=gnu11 -Wall -Wextra -Werror $san -D_GNU_SOURCE -I"$top/include" -o "$o/bus-file" \
		bus_file.c "$top"/lib/bus/*.c "$top/lib/tools/text.c" -lyaml &&
		"$o/bus-file" "$here"/../busfile/*.yaml
}

# with a recorder in the place of libethercat
bus_load() {
	$CC -std=gnu11 -Wall -Wextra -Werror $san -D_GNU_SOURCE -I"$top/include" -o "$o/bus-load" bus_load.c \
		"$top"/lib/{data,real}.c "$top"/lib/bus/*.c "$top"/lib/bus/load/*.c \
		"$top/lib/tools/text.c" "$top/master/wire/compiled.c" -lyaml -lm && "$o/bus-load"
}

bus_compile() {
	$CC -std=gnu11 -Wall -Wextra -Werror $san -D_GNU_SOURCE -I"$top/include" \
		-o "$o/bus-compile" bus_compile.c \
		"$top"/lib/bus/*.c "$top"/lib/bus/load/*.c "$top/lib/tools/text.c" \
		"$top/master/wire/compiled.c" "$o/lib/libethercat.a" -lyaml -lm && "$o/bus-compile"
}

demo_builds() {
	$MAKE -s -C ../apps O="$o/apps" LIB="$o/lib" CFLAGS="-O2 -Werror" all &&
	"$o/apps/demo" --help >/dev/null
}

examples_build() {	# examples_build STANDARD
	rm -rf "$o/examples"
	$MAKE -s -C "$top/examples" STD=$1 O="$o/examples" LIB="$o/lib" CFLAGS="-O2 -Werror" all
}

for std in c99 c11 gnu11 c17; do
	t "ecrt.h compiles as $std" header_compiles $CC $std c
done
for std in c++11 c++14 c++17 c++20; do
	t "ecrt.h compiles as $std" header_compiles $CXX $std c++
done
t "ecrt.h compiles with the kernel's words only" kernel_words
t "ecrt.h has the prototypes of the list, C" prototypes_equal $CC c
t "ecrt.h has the prototypes of the list, C++" prototypes_equal $CXX c++
t "ecrt.h declares the list and nothing else" header_declares_list
t "ecrt.h has the prototypes of the list, kernel" kernel_prototypes_equal
t "ecrt.h declares the list and nothing else, kernel" kernel_declares_list
t "the functions of IgH are there, or have a reason" igh functions
t "a function without both is noticed" igh selftest
t "the list of them has what the books have" ./igh.py list
[ -d "$top/../shared/reference" ] ||
	echo "# ../shared/reference is not here: igh.txt was not compared with the books"
t "data access in C" access_works $CC c
t "data access in C++" access_works $CXX c++
[ "$(uname -m)" != x86_64 ] || t "data access is one access" one_access
t "library builds" build_lib
t "map has the names of the list" \
	diff <(names prototypes.txt) <(map_symbols | cut -d' ' -f1)
t "each function has a case in tests/apps/api" api_calls
t "library exports the map" diff <(map_symbols) <(exported)
t "the package has the symbols of the map" diff <(map_symbols) <(package_symbols)
t "a symbol version is of one release" one_release_each
t "a symbol that is added to an older version is noticed" late_symbol_is_noticed
! command -v dpkg-gensymbols >/dev/null || t "dpkg-gensymbols agrees" \
	gensymbols libethercat1 lib/libethercat.so.1.2.0
t "soname" soname
t "library needs libc only" needs_libc_only
t "install, use, uninstall" installs
t "library against a fake kernel" library_works
t "failures of configuration are explained" says_why
t "cyclic calls are silent" cyclic_is_silent
t "libethercat-tools builds" $MAKE -s -C "$top/lib/tools" O="$o/tools" CFLAGS="-O2 -Werror" all
t "ethercat-tools.h declares what the map has" diff <(map_of tools) <(other_declares tools)
t "each of these functions is described" described tools
t "libethercat-tools exports them and nothing else" diff <(map_of tools) <(other_exports tools)
t "its package has them" packaged tools
! command -v dpkg-gensymbols >/dev/null || t "dpkg-gensymbols agrees with libethercat-tools" \
	gensymbols libethercat-tools1 tools/libethercat-tools.so.1.0.0
t "soname of libethercat-tools" has_soname tools
t "libethercat-tools needs libc only" needs_only tools 'libc\.so\|ld-linux'
t "libethercat-tools against the fake kernel" tools_work "$san"
t "libethercat-tools in several threads" tools_work "-fsanitize=thread -g -O1"
for std in c99 c17; do
	t "ethercat-tools.h compiles as $std" other_header_compiles tools $CC $std c
done
for std in c++11 c++20; do
	t "ethercat-tools.h compiles as $std" other_header_compiles tools $CXX $std c++
done
t "libethercat-bus builds" $MAKE -s -C "$top/lib/bus" O="$o/bus" LIB="$o/lib" \
	CFLAGS="-O2 -Werror" all
t "ethercat-bus.h declares what the map has" diff <(map_of bus) <(other_declares bus)
t "each function of libethercat-bus is described" described bus
t "libethercat-bus exports them and nothing else" diff <(map_of bus) <(other_exports bus)
t "the package of libethercat-bus has them" packaged bus
! command -v dpkg-gensymbols >/dev/null || t "dpkg-gensymbols agrees with libethercat-bus" \
	gensymbols libethercat-bus1 bus/libethercat-bus.so.1.0.0
t "soname of libethercat-bus" has_soname bus
t "libethercat-bus needs libc, libyaml and libethercat only" needs_only bus \
	'libc\.so\|libm\.so\|ld-linux\|libyaml-0\.so\.2\|libethercat\.so\.1'
t "names of slaves and values" bus_names
t "bus files" bus_file
t "bus files become configurations, by ecrt.h" bus_load
t "bus files are compiled for the kernel" bus_compile
for std in c99 c17; do
	t "ethercat-bus.h compiles as $std" other_header_compiles bus $CC $std c
done
for std in c++11 c++20; do
	t "ethercat-bus.h compiles as $std" other_header_compiles bus $CXX $std c++
done
t "demo builds" demo_builds
for std in c99 c11; do
	t "examples build as $std" examples_build $std
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
