#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Building and installing: plain kbuild with sparse, userspace with -Werror, install and uninstall,
# a program built against what was installed.
# The last line is "N passed, N failed".

set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/vm/places.sh
kernel=${EC_KERNEL:-6.1-rt}
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-build.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
root=$tmp/root
. tests/t.sh

tests/install-deps.sh doc cmake >&2 || exit 1
tests/vm/kernels.sh fetch "$kernel" >&2 || exit 1
KDIR=$(tests/vm/kernels.sh kdir "$kernel")
release=$(tests/vm/kernels.sh release "$kernel")
modules=$PWD/build/system-$kernel/modules
prefix=/opt/ethercat
top() { locked "$kernel" make -s KDIR="$KDIR" MODDIR="$modules" DESTDIR="$root" PREFIX=$prefix "$@"; }

# --- kernel ----------------------------------------------------------------------
# the way kernel people do it, with sparse, where the other levels look for the modules; all
# warnings are on in tests/check-kernels.sh
plain_kbuild() {
	make -s sync MODDIR="$modules" &&
	make -j2 -C "$KDIR" M="$modules" CONFIG_DEBUG_INFO_BTF_MODULES= CONFIG_DEBUG_INFO= \
		C=2 CF=-D__CHECK_ENDIAN__ modules >"$tmp/kbuild.log" 2>&1 || {
		tail -n 30 "$tmp/kbuild.log"
		return 1
	}
	[ "$(find "$modules" -name '*.ko' | wc -l)" = 4 ]
}

# sparse also talks about the kernel's headers
no_warning() { ! grep -E "^$modules/.*(warning|error):|^(WARNING|ERROR):" "$tmp/kbuild.log"; }

sparse_ran() { [ "$(grep -c '^  CHECK ' "$tmp/kbuild.log")" -ge 20 ]; }

needs_master() { [ "$(modinfo -F depends "$modules/$1")" = ec_master ]; }

# else the check above could not fail
sparse_notices() {
	mkdir -p "$tmp/bad"
	echo "obj-m += bad.o" >"$tmp/bad/Kbuild"
	cat >"$tmp/bad/bad.c" <<-'END'
	#include <linux/module.h>
	u16 bad(__le16 x);
	u16 bad(__le16 x) { return x; }
	MODULE_LICENSE("GPL");
	END
	make -C "$KDIR" M="$tmp/bad" CONFIG_DEBUG_INFO_BTF_MODULES= CONFIG_DEBUG_INFO= \
		C=2 CF=-D__CHECK_ENDIAN__ modules 2>&1 |
		grep -E "^$tmp/bad/bad.c:3:.*warning: incorrect type"
}

t "make -C KDIR M=... builds all modules" locked "$kernel" plain_kbuild
t "sparse has nothing to say about our files" no_warning
t "sparse has looked at them" sparse_ran
t "every line that a module logs while it runs is rate-limited" tests/build/log_check.py master devices
t "no 64-bit value is shared by READ_ONCE() and WRITE_ONCE()" tests/build/once64_check.py master
t "a word of mapped memory is read once" tests/build/mapped_check.py lib/ecrt/*.c \
	master/session/request*.c master/mailbox/emerg.c master/cycle/cycle_run.c

# else the check above could not fail
mapped_noticed() {
	printf 'n = rec->got < room ? rec->got : room;\n' >"$tmp/mapped.c"
	tests/build/mapped_check.py "$tmp/mapped.c" | grep "mapped.c:1: rec->got is read"
}

t "a word that is read twice is noticed" mapped_noticed

locks() { tests/build/locks_check.py "$1" Documentation/locking.rst "${@:2}"; }

# lock_notices KIND SOURCE FINDING: else its check could not fail
lock_notices() {
	local out

	printf '%b\n' "$2" >"$tmp/$1.c"
	out=$(locks "$1" "$tmp/$1.c") && return 1
	grep -F "$3" <<<"$out"
}

t "Documentation/locking.rst has every lock and no other" locks locks master devices
t "a lock without description is noticed" lock_notices locks \
	'struct x {\n\tspinlock_t lock;\n};' 'lock x.lock is not in'
t "a function asserts the lock that its comment says is held" locks held master devices
t "a comment without assertion is noticed" lock_notices held \
	'/* Process, lock held. */\nvoid f(void)\n{\n\tg();\n}' 'f(): the comment says'
# else the check above could not fail
words_noticed() {
	printf 'int x;\n"the clock is odd"\n' >"$tmp/words.c"
	tests/build/texts.py "$tmp/words.c" | grep "words.c:2: 'odd'; write: inconsistent"
}

# in a comment alone: strings are of the first pass, code is of none
comment_noticed() {
	printf '/*\n * The clock\n * is odd.\n */\nint odd; /* see no-such.md */\n' >"$tmp/comment.c"
	out=$(tests/build/texts.py "$tmp/comment.c") && return 1
	grep -x "$tmp/comment.c:3: 'odd'; write: inconsistent.*" <<<"$out" &&
		grep -x "$tmp: 1 hits in comments, limit 0" <<<"$out" &&
		grep -x "$tmp/comment.c:5: no file no-such.md; write: a clause of .*" <<<"$out"
}

name_noticed() {
	printf '``ec_access_room()``, ``ec_no_such()``\n' >"$tmp/page.rst"
	out=$(tests/build/texts.py "$tmp/page.rst") && return 1
	[ "$out" = "$tmp/page.rst:1: no source has ec_no_such" ]
}

t "texts for users and comments have the terms of the glossary" tests/build/texts.py
t "another term is noticed" words_noticed
t "another term in a comment and a page that does not exist are noticed" comment_noticed
t "a function of a page that no source has is noticed" name_noticed

# the archive of the kernel's sources, as level uml; the headers lack the script
checkpatch() {
	local tar=${EC_LINUX_TAR:-} cache

	cache=${EC_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/ethercat}
	CHECKPATCH=$(find "$cache"/src/linux-*/scripts -name checkpatch.pl -print -quit 2>/dev/null)
	[ -z "$CHECKPATCH" ] || return 0
	[ -n "$tar" ] || tar=$(tests/vm/kernels.sh source 6.1) || return
	tar xf "$tar" -C "$tmp" --strip-components=1 --wildcards '*/scripts/checkpatch.pl' \
		'*/scripts/spelling.txt' '*/scripts/const_structs.checkpatch' &&
		CHECKPATCH=$tmp/scripts/checkpatch.pl
}
checkpatch
export KDIR CHECKPATCH

# rule_notices RULE TEXT FINDING: else its check could not fail
rule_notices() {
	local f="$tmp/$1.c" out

	printf '%b\n' "$2" >"$f"
	out=$(tests/build/style.py "$1" "$f") && return 1
	grep -F "$3" <<<"$out"
}

t "each file names its license" tests/build/style.py spdx
t "a file without a license is noticed" rule_notices spdx '/* text */' 'no SPDX'
t "a license without its text is noticed" \
	rule_notices spdx '// SPDX-License-Identifier: MIT' 'no text of MIT'
t "no line is longer than 100 columns" tests/build/style.py lines
t "a line of 101 columns is noticed" rule_notices lines "$(printf '%101s' x)" '101 columns'
t "kernel-doc reports nothing" tests/build/style.py kernel-doc
t "kernel-doc notices a parameter without text" rule_notices kernel-doc \
	'/**\n * f() - sum\n * @a: one\n */\nint f(int a, int b)\n{\n\treturn a + b;\n}' "'b' not described"
t "test names have an area, a condition and no article" tests/build/style.py names
t "a test name with an article is noticed" \
	rule_notices names '\tKUNIT_CASE(frame_is_the_last),' "'the' in"
t "functions of master/ are named after their file or structure" tests/build/style.py globals
t "a function with the name of another file is noticed" \
	rule_notices globals 'int ec_other_begin(void)\n{\n\treturn 0;\n}' 'not named after it'
t "no static function of master/ has the name of another" tests/build/style.py statics
t "a static function with the name of another is noticed" rule_notices statics \
	'static int f(void)\n{\n}\nstatic int f(int a)\n{\n}' 'f() is also in'
t "members are described where they are declared" tests/build/style.py members
t "members that are described above their structure are noticed" rule_notices members \
	'/**\n * struct a - sum\n * @b: one\n */\nstruct a {\n\tint b;\n};' 'struct a are described'
t "cases reach into the master by one file" tests/build/style.py reach
t "a case that reaches into the master is noticed" \
	rule_notices reach 'static int f(struct bus *b) { return b->m->index; }' 'not by access.h'
t "checkpatch reports nothing" tests/build/style.py checkpatch
t "checkpatch notices a space before a bracket" \
	rule_notices checkpatch '// SPDX-License-Identifier: GPL-2.0-only\nint a [3];' BRACKET_SPACE
t "sparse notices a wrong byte order" sparse_notices

# listed PAGE-TREE [FAILED]: would check-debug run thin, which has a result of that tree?
listed() {
	printf '%s\n' '======= =' x '======= =' "kasan thin 2026-01-01 $1 1 ${2:-0} 1" >"$tmp/page"
	EC_PAGE=$tmp/page EC_PRODUCT=COPYING tests/check-debug.sh --list kasan:thin |
		grep -x kasan:thin
}
tree=$(git -c safe.directory='*' rev-parse --short=7 HEAD)
t "check-debug repeats no result of this tree" eval '! listed "$tree"'
t "a result of changed files does not count" listed "$tree+"
t "a result with a failure does not count" listed "$tree" 1
unknown_refused() { tests/check-debug.sh --list nosuch 2>&1 >/dev/null | grep "no test 'nosuch'"; }
t "check-debug refuses a name that is no test" unknown_refused
t "ec_sim and ec_generic load after ec_master" eval \
	'needs_master devices/sim/ec_sim.ko && needs_master devices/ec_generic.ko'

# what an application in the kernel finds, all of it for GPL modules
exports_ecrt() {
	diff <(grep -o 'ecrt_[a-z0-9_]*(' tests/lib/prototypes_kernel.txt | tr -d '(' | sort) \
	     <(awk '$2 ~ /^ecrt_/ && $3 ~ /ec_master$/ && $4 == "EXPORT_SYMBOL_GPL" { print $2 }' \
		"$modules/Module.symvers" | sort)
}

t "ec_master exports ecrt.h" exports_ecrt

# --- userspace -------------------------------------------------------------------
flags="-O2 -Wall -Wextra -Werror"
t "library without a warning" make -s -C lib O="$tmp/lib" CFLAGS="$flags" all
t "library of the tools without a warning" make -s -C lib/tools O="$tmp/libtools" CFLAGS="$flags" all
t "library of bus files without a warning" make -s -C lib/bus O="$tmp/libbus" LIB="$tmp/lib" \
	CFLAGS="$flags" all
t "tool without a warning" make -s -C tool O="$tmp/tool" CFLAGS="$flags"
t "simulator without a warning" make -s -C tool/sim O="$tmp/sim" CFLAGS="$flags"
t "demo without a warning" make -s -C tests/apps O="$tmp/apps" LIB="$tmp/lib" CFLAGS="$flags" all

# --- install ---------------------------------------------------------------------
# a page for each command and each other name of one
pages() {
	"$tmp/tool/ethercat" help --json | python3 -c '
import json, sys
for c in json.load(sys.stdin)["commands"]:
    for name in [c["name"]] + c["also"]:
        print(f".{sys.argv[1]}/share/man/man8/ethercat-{name}.8")' "$prefix"
}

expected() {
	pages
	cat <<-END
	./lib/modules/$release/updates/ethercat/Module.symvers
	./lib/modules/$release/updates/ethercat/devices/ec_generic.ko
	./lib/modules/$release/updates/ethercat/devices/intel/ec_intel.ko
	./lib/modules/$release/updates/ethercat/devices/sim/ec_sim.ko
	./lib/modules/$release/updates/ethercat/master/ec_master.ko
	.$prefix/bin/ethercat
	.$prefix/bin/ethercat-sim
	./usr/local/lib/modprobe.d/ethercat.conf
	./usr/local/lib/systemd/system/ethercat.service
	./usr/local/lib/systemd/system/ethercat-metrics.socket
	./usr/local/lib/systemd/system/ethercat-metrics@.service
	./usr/local/lib/systemd/system/ethercat-run@.service
	.$prefix/sbin/ethercatctl
	.$prefix/share/ethercat/await.sh
	.$prefix/share/ethercat/busrun.sh
	.$prefix/share/ethercat/conf.sh
	.$prefix/share/ethercat/devices.sh
	.$prefix/share/ethercat/trusted.sh
	.$prefix/share/man/man8/ethercat-sim.8
	.$prefix/share/man/man8/ethercatctl.8
	./etc/ethercat.conf
	.$prefix/include/ecrt.h
	.$prefix/lib/libethercat.a
	.$prefix/lib/libethercat.so
	.$prefix/lib/libethercat.so.1
	.$prefix/lib/libethercat.so.1.2.0
	.$prefix/lib/cmake/ethercat/ethercat-config-version.cmake
	.$prefix/lib/cmake/ethercat/ethercat-config.cmake
	.$prefix/lib/pkgconfig/libethercat.pc
	.$prefix/lib/libethercat-tools.a
	.$prefix/lib/libethercat-tools.so
	.$prefix/lib/libethercat-tools.so.1
	.$prefix/lib/libethercat-tools.so.1.0.0
	.$prefix/lib/pkgconfig/libethercat-tools.pc
	.$prefix/include/ethercat-tools.h
	$(cd include && printf ".$prefix/include/%s\n" ethercat-tools/*.h)
	.$prefix/lib/libethercat-bus.a
	.$prefix/lib/libethercat-bus.so
	.$prefix/lib/libethercat-bus.so.1
	.$prefix/lib/libethercat-bus.so.1.0.0
	.$prefix/lib/pkgconfig/libethercat-bus.pc
	.$prefix/include/ethercat-bus.h
	$(cd include && printf ".$prefix/include/%s\n" ethercat-bus/*.h)
	./usr/local/lib/udev/rules.d/60-ethercat.rules
	.$prefix/share/bash-completion/completions/ethercat
	.$prefix/share/man/man8/ethercat.8
	END
}

installed() { (cd "$root" && find . ! -type d | LC_ALL=C sort); }

# kbuild may compress or sign the modules, so only their names count
t "make install DESTDIR= PREFIX=" top install
t "it installs these files and no other" diff <(expected | LC_ALL=C sort) <(installed)
t "the tool that was installed runs" "$root$prefix/bin/ethercat" help
t "the simulator that was installed runs" "$root$prefix/bin/ethercat-sim" --help
# options TEXT-FILE: each once
options() { grep -oE -- '(^|[ ,])--?[a-z][a-z-]*' "$1" | tr -d ' ,' | sort -u; }

sim_page() {
	"$root$prefix/bin/ethercat-sim" --help >"$tmp/sim.help" &&
	sed 's/\\f.//g' tool/sim/ethercat-sim.8 >"$tmp/sim.page" &&
		diff <(options "$tmp/sim.help") <(options "$tmp/sim.page")
}
t "the manual page of the simulator has its options and no other" sim_page
t "the completion is a bash script" bash -n "$root$prefix/share/bash-completion/completions/ethercat"

cat >"$tmp/app.c" <<'END'
#include <ecrt.h>
#include <stdio.h>

int main(void)
{
	printf("%u\n", ecrt_version_magic());
	return ecrt_version_magic() != ECRT_VERSION_MAGIC;
}
END

cat >"$tmp/app-tools.c" <<'END'
#include <ethercat-tools.h>

int main(void)
{
	struct ect_handle *h = ect_new();
	int wrong = !h || ect_fd(h) != -1;

	ect_free(h);
	return wrong;
}
END

# app_runs COMPILER STANDARD LANGUAGE [LIBRARY]
app_runs() {
	local lib=${4:-libethercat} app=$tmp/app${4:+-tools}.c
	local pc="env PKG_CONFIG_LIBDIR=$root$prefix/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root pkg-config"
	local cflags libs

	cflags=$($pc --cflags "$lib") && libs=$($pc --libs "$lib") || return 1
	# shellcheck disable=SC2086
	$1 -std=$2 -Wall -Wextra -pedantic -Werror $cflags -x $3 -o "$tmp/app" "$app" -x none $libs &&
		LD_LIBRARY_PATH=$root$prefix/lib "$tmp/app"
}

t "an application in C99 with pkg-config" app_runs gcc c99 c
t "an application in C++11 with pkg-config" app_runs g++ c++11 c++
t "a program with libethercat-tools in C99" app_runs gcc c99 c libethercat-tools
t "a program with libethercat-tools in C++11" app_runs g++ c++11 c++ libethercat-tools
t "examples and snippets of the documentation compile as C99 and C++20" tests/build/snippets.py

# snippet_noticed TEXT FINDING: else the check above could not fail
snippet_noticed() {
	printf 'Title\n=====\n\n::\n\n%b' "$1" >"$tmp/page.rst"
	! tests/build/snippets.py "$tmp/page.rst" >"$tmp/snippets.log" &&
		grep "$2" "$tmp/snippets.log"
}
t "a snippet that is not C++20 is noticed" snippet_noticed \
	'    ec_cycle_config_t cycle = {\n        .cpu = 1,\n        .period_ns = 1,\n    };\n' \
	"page.rst: ec_cycle_config_t cycle = {: no C++20"
t "a snippet that is marked as something else is noticed" snippet_noticed \
	'    ecrt_master_receive(master);\n    ecrt_domain_process(domain);\n' "looks like C"

# find_package() in a project of its own; without cmake what the files say
cmake_app() {
	local dir=$root$prefix/lib/cmake/ethercat

	grep -q '@' "$dir"/*.cmake && return 1
	[ "$(realpath "$dir/$(sed -n 's|.*{CMAKE_CURRENT_LIST_DIR}/\(.*include\)".*|\1|p' \
		"$dir/ethercat-config.cmake")")" = "$(realpath "$root$prefix/include")" ] || return 1
	command -v cmake >/dev/null || return 0
	mkdir -p "$tmp/cmake" && cp "$tmp/app.c" "$tmp/cmake" || return 1
	cat >"$tmp/cmake/CMakeLists.txt" <<-'END'
	cmake_minimum_required(VERSION 3.10)
	project(app C)
	find_package(ethercat 1.5 REQUIRED)
	add_executable(app app.c)
	target_link_libraries(app EtherLab::ethercat)
	END
	cmake -S "$tmp/cmake" -B "$tmp/cmake/build" -DCMAKE_PREFIX_PATH="$root$prefix" &&
		cmake --build "$tmp/cmake/build" && "$tmp/cmake/build/app" || return 1
	# one that needs more than we have
	sed -i 's/ethercat 1.5/ethercat 99/' "$tmp/cmake/CMakeLists.txt"
	! cmake -S "$tmp/cmake" -B "$tmp/cmake/later" -DCMAKE_PREFIX_PATH="$root$prefix"
}
t "an application with cmake" cmake_app

# copied somewhere else, as a user would do
examples_build() {
	cp -r examples "$tmp/examples" && rm -rf "$tmp/examples/build" &&
		PKG_CONFIG_LIBDIR=$root$prefix/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root \
		make -s -C "$tmp/examples" CFLAGS="-O2 -Werror" all &&
		[ -x "$tmp/examples/build/mirror" ]
}
t "the examples with pkg-config, outside of the tree" examples_build

examples_cmake() {
	command -v cmake >/dev/null || { echo "no cmake"; return 1; }
	cmake -S "$tmp/examples" -B "$tmp/examples/cmake" -DCMAKE_PREFIX_PATH="$root$prefix" \
		-DCMAKE_C_FLAGS=-Werror && cmake --build "$tmp/examples/cmake" &&
		diff <(cd examples && ls ./*.c | sed 's/\.c$//') \
			<(cd "$tmp/examples/cmake" && find . -maxdepth 1 -type f -perm -100 | sort)
}
t "the examples with cmake, outside of the tree" examples_cmake

# what Documentation/kernel-api.rst says, with what was installed
mini_builds() {	# mini_builds [VARIABLE=VALUE...]
	make -s -C "$KDIR" M="$tmp/mini" CONFIG_DEBUG_INFO_BTF_MODULES= \
		CONFIG_DEBUG_INFO= W=1 ECRT="$root$prefix/include" "$@" \
		KBUILD_EXTRA_SYMBOLS="$root/lib/modules/$release/updates/ethercat/Module.symvers" \
		modules >"$tmp/mini.log" 2>&1 || { cat "$tmp/mini.log"; return 1; }
	! grep -E 'warning:|WARNING:' "$tmp/mini.log"
}

# with a bus from a file, then in the module
kernel_app_builds() {
	cp -r examples/mini "$tmp/mini" && mini_builds &&
		[ "$(modinfo -F depends "$tmp/mini/ec_mini.ko")" = ec_master ] &&
		nm "$tmp/mini/ec_named.ko" | grep -q request_firmware &&
		echo "0x45, 0x43" >"$tmp/bus.inc" && mini_builds BUS="$tmp/bus.inc" &&
		! nm "$tmp/mini/ec_named.ko" | grep -q request_firmware
}

t "a kernel application against what was installed" kernel_app_builds

kernel_snippets() {
	mkdir -p "$tmp/snippets" && tests/build/snippets.py --kernel "$tmp/snippets" &&
	make -s -C "$KDIR" M="$tmp/snippets" CONFIG_DEBUG_INFO_BTF_MODULES= \
		CONFIG_DEBUG_INFO= KCFLAGS="-Werror -Wno-unused-function" \
		ECRT="$root$prefix/include" \
		KBUILD_EXTRA_SYMBOLS="$root/lib/modules/$release/updates/ethercat/Module.symvers" \
		modules
}
t "the kernel snippets of the documentation compile" kernel_snippets

# a module that wants the structures of another master, with the sources as DKMS has them
structures_refused() {
	mkdir -p "$tmp/foreign" && echo "obj-m += foreign.o" >"$tmp/foreign/Kbuild" &&
		echo '#include "master/slave_config.h"' >"$tmp/foreign/foreign.c" || return 1
	! make -s -C "$KDIR" M="$tmp/foreign" CONFIG_DEBUG_INFO_BTF_MODULES= \
		KCFLAGS="-I$modules" modules >"$tmp/foreign.log" 2>&1 &&
		grep -F 'this is not the IgH EtherCAT Master' "$tmp/foreign.log" &&
		grep -o 'ecrt_[a-z_]*(' "$tmp/foreign.log" | sort -u >"$tmp/instead" &&
		[ -s "$tmp/instead" ] &&
		! grep -vxFf <(grep -o 'ecrt_[a-z0-9_]*(' tests/lib/prototypes_kernel.txt) \
			"$tmp/instead"
}
t "a module that includes master/slave_config.h reads what to use instead" structures_refused

# but for folders that every system has
nothing_left() {
	[ -z "$(installed)" ] || { installed; return 1; }
	[ -z "$(cd "$root" && find . -type d |
		grep -vE "^\.(/lib(/modules(/$release)?)?|/opt|/usr(/local(/lib)?)?)?$" |
		grep -vE "^\.$prefix(/bin|/lib|/include|/share(/man(/man8)?)?)?$" | tee /dev/stderr)" ]
}

# as 'ethercat device bind --boot' writes it, and another one, which is not ours
rules=$root/etc/udev/rules.d
mkdir -p "$rules"
echo "# Written by 'ethercat device bind --boot'; it is removed by unbind" \
	>"$rules/59-ethercat-0000:01:00.0.rules"
echo "# by hand" >"$rules/59-ethercat-by-hand.rules"
t "make uninstall" top uninstall
own_rules_removed() { [ "$(ls "$rules")" = 59-ethercat-by-hand.rules ] && rm -r "$root/etc"; }
t "it removes rules of 'ethercat device bind --boot', and no other" own_rules_removed
t "it leaves no file" nothing_left

# the linker's cache has the library only after ldconfig, which is in /sbin and may be missing
lib_make() { make -s -C lib O="$tmp/lib" CFLAGS="$flags" prefix="$tmp/here" "$@"; }
ldconfig_runs() {	# HOW OFTEN MAKE-ARGUMENTS
	mkdir -p "$tmp/fake" &&
		printf '#!/bin/sh\necho >>"%s"\n' "$tmp/ldconfig.log" >"$tmp/fake/ldconfig" &&
		printf '#!/bin/sh\n' >"$tmp/fake/systemctl" && chmod +x "$tmp"/fake/* &&
		: >"$tmp/ldconfig.log" &&
		PATH=$tmp/fake:$PATH lib_make "${@:2}" && [ "$(wc -l <"$tmp/ldconfig.log")" = "$1" ]
}
t "installing the library refreshes the linker's cache" ldconfig_runs 1 install
t "removing it does as well" ldconfig_runs 1 uninstall
t "with DESTDIR= the cache remains" ldconfig_runs 0 install DESTDIR="$tmp/there"
t "a system without ldconfig has no cache" lib_make LDCONFIG=no-such-ldconfig install
t "without root the installation goes on" lib_make LDCONFIG=false install

# the commands of Documentation/coming-from-igh.rst, in a folder instead of /
old_removed() {
	local d old=$tmp/old

	for d in usr/local usr/local/etherlab opt/etherlab; do
		mkdir -p "$old/$d"/{bin,sbin,include,lib/pkgconfig} &&
			touch "$old/$d"/bin/{ethercat,other} "$old/$d/sbin/ethercatctl" \
				"$old/$d"/include/{ecrt.h,other.h} \
				"$old/$d"/lib/{pkgconfig/libethercat.pc,libethercat.{a,so,so.1}} ||
			return 1
	done
	mkdir -p "$old"/etc/{init.d,udev/rules.d,systemd/system/ethercat.service.d} &&
	touch "$old"/etc/udev/rules.d/99-{EtherCAT,ethercat}.rules "$old/etc/init.d/ethercat" \
		"$old"/etc/systemd/system/ethercat.service{,.d/x.conf} &&
	tests/build/commands.py --block Documentation/coming-from-igh.rst \
		'for d in /usr/local /usr/local/etherlab /opt/etherlab; do' >"$tmp/old.sh" &&
		sed -i "s| /| $old/|g" "$tmp/old.sh" && : >"$tmp/ldconfig.log" &&
		PATH=$tmp/fake:$PATH bash -e "$tmp/old.sh" && [ -s "$tmp/ldconfig.log" ] &&
		[ "$(find "$old" -type f -printf '%f ' | xargs -n 1 | sort -u | xargs)" = "other other.h" ]
}
t "the old master's files are removed as documented" old_removed

# --- documentation ---------------------------------------------------------------
t "make doc builds HTML without a warning, and without kernel headers" \
	make -s KDIR="$tmp/nowhere" DOCDIR="$tmp/doc" doc
t "it has the reference of ecrt.h" grep -q c.ecrt_master_activate "$tmp/doc/html/api.html"

# its comments are read as the kernel's script reads them
api_reads() {
	Documentation/sphinx/api.py include/ecrt.h | grep . >"$tmp/api" &&
		Documentation/sphinx/api.py include/ecrt.h "$KDIR/scripts/kernel-doc" |
			grep . | diff "$tmp/api" -
}
t "it has the text that kernel-doc of the kernel makes" api_reads

# codes_notice FILE SED FINDING: a change of a table or of the remedies is an error of "make doc"
codes_notice() {
	local out

	mkdir -p "$tmp/codes" &&
		cp --parents master/wire/*.[ch] lib/tools/why_codes.c \
			Documentation/sphinx/{codes.py,remedies.txt} "$tmp/codes" &&
		sed -i "$2" "$tmp/codes/$1" || return 1
	out=$("$tmp/codes/Documentation/sphinx/codes.py" "$tmp/codes" 2>&1) && return 1
	grep -F "$3" <<<"$out"
}
t "an AL status code without remedy is noticed" codes_notice master/wire/al.c \
	's/{ 0x00F0, /{ 0x00EE, "new" },\n&/' 'no remedy of al 0x00ee (new)'
t "a remedy without code is noticed" codes_notice Documentation/sphinx/remedies.txt \
	'$aabort 0x12345678 none' "'abort 0x12345678' matches no code"
t "a table that is not found is noticed" codes_notice master/wire/mbox.c \
	's/^} errors\[\]/} renamed[]/' "no table 'errors' in master/wire/mbox*.c"

# else the check above could not fail
doc_notices() {
	mkdir -p "$tmp/docs/Documentation" "$tmp/docs/include" &&
		cp -r Documentation/sphinx Documentation/pictures "$tmp/docs/Documentation" &&
		cp --parents master/wire/*.[ch] lib/tools/why_codes.c "$tmp/docs" &&
		cp Makefile "$tmp/docs" && cp include/ecrt.h "$tmp/docs/include" || return 1
	printf 'Title\n=====\n\n:doc:`nowhere`\n\n.. toctree::\n   :glob:\n\n   *\n' \
		>"$tmp/docs/Documentation/index.rst"
	! make -s -C "$tmp/docs" KDIR="$KDIR" doc >"$tmp/doc.log" 2>&1 &&
		grep "index.rst:4: WARNING: unknown document: 'nowhere'" "$tmp/doc.log"
}
t "a reference to a page that does not exist is noticed" doc_notices
t "no block or table scrolls sideways at 1200 px" tests/build/width.py "$tmp/doc/html"
# else the check above could not fail
wide_noticed() {
	mkdir -p "$tmp/wide/_static" &&
		cp Documentation/sphinx/static/pages.css "$tmp/wide/_static" &&
		printf '<link href="_static/pages.css"><pre>%100s</pre>%s<pre>%100s</pre>' \
			x '<ul><li>' y >"$tmp/wide/a.html" || return 1
	! tests/build/width.py "$tmp/wide" >"$tmp/wide/out" && cat "$tmp/wide/out" &&
		[ "$(grep -c '^a.html: ' "$tmp/wide/out")" = 1 ] && grep 'y$' "$tmp/wide/out"
}
t "a block that scrolls sideways is noticed" wide_noticed

# no_headers TARGET: one line that says what to do, before anything else
no_headers() {
	! make -s KDIR="$tmp/nowhere" DESTDIR="$root" "$1" >"$tmp/err" 2>&1 &&
		head -n 1 "$tmp/err" | grep -q '^no kernel headers at .*/nowhere: install linux-headers-' &&
		! grep -q 'No such file' "$tmp/err"
}

t "make without kernel headers says what to install" no_headers all
t "make install without kernel headers says what to install" no_headers install
t "make uninstall needs no kernel headers" make -s KDIR="$tmp/nowhere" DESTDIR="$root" PREFIX=$prefix uninstall
t "every command of the documentation is run by a test" tests/build/commands.py
t "simulator.rst has the slaves of each built-in segment" tests/build/segments.py
# else the check above could not fail
segment_noticed() {
	sed 's/``dio`` /``dao`` /' Documentation/simulator.rst >"$tmp/simulator.rst" &&
		! tests/build/segments.py "$tmp/simulator.rst" >"$tmp/segments" &&
		grep 'no row bench 1 dio EL1859' "$tmp/segments" &&
		grep 'no slave bench 1 dao EL1859' "$tmp/segments"
}
t "a slave with another name is noticed" segment_noticed
# screen_is --screen|--like OUTPUT: is it accepted as that of a page?
screen_is() {
	printf '%b' '::\n\n    $ x\n    a 1\n    ...\n    b ... 2\n\nEnd\n' >"$tmp/page.rst"
	printf '%b' "$2" | tests/build/commands.py "$1" "$tmp/page.rst" '$ x'
}
t "another output than that of a page is noticed" eval \
	'screen_is --screen "a 1\nc\nb c 2\n" && ! screen_is --screen "a 2\nb c 2\n" &&
	screen_is --like "a  2\nb c 3\n" && ! screen_is --like "c 1\nb c 2\n"'

echo "$passed passed, $failed failed"
[ $failed = 0 ]
