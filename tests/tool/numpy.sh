#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-only
#
# Debian's numpy opens recordings of the fake bus: names, types and values are those of the CSV file
# of the same recording. The packages are unpacked, not installed. The last line is "N passed, N
# failed".

set -u
export LC_ALL=C.UTF-8 FAKE_BUS=run
cd "$(dirname "$0")" || exit 1
cache=${EC_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/ethercat}/numpy
tmp=$(mktemp -d "${TMPDIR:-/tmp}/ec-numpy.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0

die() { echo "$*"; echo "$passed passed, $((failed + 1)) failed"; exit 1; }

fetch() {
	rm -rf "$cache.new"
	mkdir -p "$cache.new" && cd "$cache.new" &&
		apt-get -qq download python3-numpy libblas3 liblapack3 libgfortran5 \
			>/dev/null 2>&1 &&
		for f in *.deb; do dpkg -x "$f" . && rm "$f" || return; done &&
		rm -rf "$cache" && mv "$cache.new" "$cache"
}

numpy() {
	local lib

	lib=$(echo "$cache"/usr/lib/*-linux-gnu)
	LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack \
		PYTHONPATH=$cache/usr/lib/python3/dist-packages python3 "$@"
}

cat >"$tmp/compare.py" <<'END'
import csv, sys
import numpy
name, *types = sys.argv[1:]
lines = [l for l in open(name + '.csv', encoding='utf-8') if not l.startswith('#')]
head, *rows = csv.reader(lines)
for how in None, 'r':
    a = numpy.load(name + '.npy', mmap_mode=how)
    want = ['<f8', '<u8', '<u8', '<u8', '|u1'] + types
    assert [a.dtype[i].str for i in range(len(a.dtype))] == want, a.dtype
    fields = [a.dtype.fields[n] for n in a.dtype.names]
    titles = [f[2] if len(f) > 2 else n for n, f in zip(a.dtype.names, fields)]
    assert titles[1:] == head[1:], (titles, head)
    assert a.dtype.names[0] == head[0], head
    assert len(a) == len(rows) > 0, (len(a), len(rows))
    for column, n in enumerate(a.dtype.names):
        texts = [r[column] for r in rows]
        if a.dtype[n].kind == 'f':
            # the text has 9 digits, of a float of 32 bits 7
            numpy.testing.assert_allclose(a[n], [float(t) for t in texts],
                                          1e-6 if a.dtype[n].itemsize == 4 else 1e-8)
        else:
            assert [int(v) for v in a[n]] == [int(t) for t in texts], (n, a[n], texts)
print(*types, len(rows), 'rows')
END

# t NAME TYPE-OF-THE-FILE SCALING DTYPE...
t() {
	cat >"$tmp/names" <<-END
	ethercat: 1
	masters:
	  - slaves:
	      - {name: lamps, vendor: 2, product: 0x07d83052}
	      - name: axis
	        vendor: 2
	        product: 0x1c213052
	        pdos:
	          - index: 0x1600
	            sm: 2
	            entries: [{object: "0x7010:01", bits: 16, name: power, type: uint16}]
	          - index: 0x1a00
	            sm: 3
	            entries: [{object: "0x6000:11", bits: 32, name: position, type: $2$3}]
	END
	if (for form in csv npy; do
		FAKE_NAMES=$tmp/names build/fake/ethercat record -f '*' -o "$tmp/a.$form" || exit
	done
	numpy "$tmp/compare.py" "$tmp/a" '|b1' '|b1' '<u2' "${@:4}") >"$tmp/out" 2>&1; then
		echo "ok $1"
		passed=$((passed + 1))
	else
		echo "not ok $1"
		sed 's/^/# /' "$tmp/out"
		failed=$((failed + 1))
	fi
}

numpy -c 'import numpy' 2>/dev/null || (fetch) || die "cannot fetch Debian's numpy"
numpy -c 'import numpy; print("# numpy", numpy.__version__)' || die "this numpy does not start"
make -s tools || die "the tool does not build"
t "numbers with a sign, without, and single bits" int32 "" '<i4'
t "numbers of 32 bits without a sign" uint32 "" '<u4'
t "a real number" real32 "" '<f4'
t "a scaled number" int32 ", scale: 0.1, offset: 1" '<f8'
t "a unit in UTF-8 with quotes" uint32 ', unit: "°", scale: 0.25' '<f8'
echo "$passed passed, $failed failed"
[ $failed = 0 ]
