// SPDX-License-Identifier: GPL-2.0-only
/* Bus files: read, or refused with a text. What is read is written and read again as the same. */
#include "fuzz.h"

#include <errno.h>
#include <string.h>

#include "ethercat-bus.h"

#define S "ethercat: 1\nmasters:\n- slaves:\n  - vendor: 2\n    product: 0x3\n"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("{\"ethercat\": 1, \"masters\": [{\"cycle\": \"250 us\", \"slaves\": [{\"vendor\": 2, "
	     "\"product\": 3, \"type\": \"EL\\u00fc\"}]}]}"),
	SEED("ethercat: 1\nmasters:\n- index: 1\n  main_device: eth0\n  cycle: 1 ms\n"
	     "  reference_clock: a\n  sync_units:\n  - {name: u, policy: safeop, lease: 1 s}\n"
	     "  groups:\n  - {name: g, alias: 4}\n  - {name: h, parent: a, port: 2, fast: true}\n"
	     "  slaves:\n  - {name: a, vendor: 2, product: 3}\n"
	     "  - {vendor: 2, product: 3, parent: a, port: 1, group: g, sync_unit: u, type: X}\n"),
	SEED(S "    revision_rule: at_least\n    revision: 5\n    serial: 7\n    alias: 9\n"
	     "    identification: 10\n    timeouts: {init_preop: 3 s, mailbox: 5 ms}\n"
	     "    clock: {assign_activate: 0x300, sync0: 1 ms, sync0_shift: -5 us}\n"),
	SEED(S "    pdos:\n    - index: 0x1a00\n      sm: 3\n      name: \"a\\tb\"\n      entries:\n"
	     "      - {object: 0x6000:01, bits: 16, type: int16, unit: mm, scale: 1e-3, offset: -1}\n"
	     "      - {bits: 8}\n      - {object: 0x6000:02, bits: 8, name: p.value}\n"),
	SEED(S "    modules:\n    - {slot: 1, ident: 0x119800, name: x}\n    - slot: 255\n"
	     "      ident: 4294967295\n    write_modules: true\n"),
	SEED(S "    startup:\n    - {at: safeop, sdo: 0x8000:01, type: uint8, value: 255}\n"
	     "    - {at: preop, register: 0x120, data: 00 ff}\n"
	     "    - {at: op, idn: P-7-4095, drive: 1, type: int64, value: -1}\n"
	     "    - {at: op, sdo: 0x8000:00, complete: true, data: \"01\"}\n"),
	SEED("&a [*a, !!int 5, |\n x\n, >-\n y\n]\n---\n... \n%YAML 1.1\n? x\n: y # c\n"),
	{ NULL, 0 }
};

static char *written(const struct ecb_bus *bus)
{
	char *text = NULL;
	size_t size;
	FILE *f = open_memstream(&text, &size);

	MUST(f && !ecb_file_write(bus, f) && !fclose(f));
	return text;
}

static void ignore(void *ctx, const struct ecb_difference *d)
{
	(void)ctx;
	MUST(d->slave && d->key && d->expected && d->found && d->remedy);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ecb_bus *bus, *again;
	char *text, *same;
	struct ecb_error e;
	int ret = ecb_file_parse(&bus, "t", data, len, &e);

	MUST(!ret == !!bus);
	if (ret) {
		MUST(ret == -EINVAL && !strncmp(e.text, "t:", 2) && !strchr(e.text, '\n') &&
		     !strchr(e.text, '\x1b'));
		return 0;
	}
	text = written(bus);
	MUST(!ecb_file_parse(&again, "t", text, strlen(text), &e));
	same = written(again);
	MUST(!strcmp(text, same));
	MUST(ecb_compare(bus, again, 0, ignore, NULL) == 0);
	free(text);
	free(same);
	ecb_bus_free(again);
	ecb_bus_free(bus);
	return 0;
}
