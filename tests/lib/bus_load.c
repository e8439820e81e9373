// SPDX-License-Identifier: LGPL-2.1-or-later
/* Bus files become calls of ecrt.h, which are recorded here; values by name, and scaled. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../include/ethercat-bus.h"
#include "../../include/ethercat-bus/load.h"
#include "../../lib/internal.h"

static int bad;
static char calls[65536];
static struct ec_master master;
static struct ec_slave_config configs[32];
static struct ec_domain domains[8];
static unsigned int n_configs, n_domains, n_units;
static const char *fails;	/* the call that does */

#define CHECK(c) do {						\
		if (!(c)) {					\
			printf("%s:%d: %s\n", __FILE__, __LINE__, #c);	\
			bad++;					\
		}						\
	} while (0)

static int say(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
static int say(const char *fmt, ...)
{
	static size_t line;	/* where the present one begins */
	size_t n = strlen(calls);
	va_list ap;

	if (!n || calls[n - 1] == '\n')
		line = n;
	va_start(ap, fmt);
	vsnprintf(calls + n, sizeof(calls) - n, fmt, ap);
	va_end(ap);
	errno = EPERM;
	return fails && strstr(calls + line, fails) ? -EPERM : 0;
}

/* --- the machine ---------------------------------------------------------------- */

struct entry {
	uint16_t index;
	uint8_t subindex, bits;
};

struct pdo {
	uint16_t index;
	uint8_t sm;
	unsigned int n;
	struct entry entries[3];
};

static const struct machine_slave {
	uint32_t vendor, product, revision, serial;
	uint16_t alias, at, port;
	const char *name;
	unsigned int n;
	struct pdo pdos[3];
} machine[] = {
	{ 2, 0x10, 1, 0, 0, 0xffff, 0, "coupler", 0, { { 0 } } },
	{ 2, 0x20, 1, 0, 5, 0, 1, "lamps", 2, {
		{ 0x1600, 0, 1, { { 0x7000, 1, 1 } } }, { 0x1601, 0, 1, { { 0x7010, 1, 1 } } } } },
	{ 2, 0x30, 3, 77, 0, 1, 1, "drive", 2, {
		{ 0x1600, 2, 1, { { 0x7010, 1, 16 } } },
		{ 0x1a00, 3, 3, { { 0x6010, 1, 16 }, { 0, 0, 16 }, { 0x6000, 0x11, 32 } } } } },
	{ 2, 0x40, 1, 0, 0, 2, 1, "inputs", 1, { { 0x1a00, 0, 1, { { 0x6000, 1, 1 } } } } },
};

#define SLAVES	(sizeof(machine) / sizeof(machine[0]))

int ecrt_master(ec_master_t *m, ec_master_info_t *info)
{
	(void)m;
	*info = (ec_master_info_t){ .slave_count = SLAVES };
	return 0;
}

/* of a ring: whether it is one, and slaves before its break; SLAVES: it is closed */
static bool is_ring;
static unsigned int front = SLAVES;

int ecrt_master_link_state(const ec_master_t *m, unsigned int device,
			   ec_master_link_state_t *state)
{
	if (!m || device > is_ring)
		return -EINVAL;
	*state = (ec_master_link_state_t){
		.slaves_responding = device ? SLAVES - front : front, .link_up = 1,
	};
	return 0;
}

int ecrt_master_get_slave(ec_master_t *m, uint16_t position, ec_slave_info_t *info)
{
	const struct machine_slave *s = &machine[position];

	if (!m)
		return -EINVAL;
	*info = (ec_slave_info_t){
		.position = position, .vendor_id = s->vendor, .product_code = s->product,
		.revision_number = s->revision, .serial_number = s->serial, .alias = s->alias,
		.sync_count = 4,
	};
	strcpy(info->name, s->name);
	for (unsigned int i = 0; i < 4; i++)
		info->ports[i].next_slave = 0xffff;
	for (unsigned int i = 0; i < SLAVES; i++)
		if (machine[i].at == position)
			info->ports[machine[i].port].next_slave = (uint16_t)i;
	return 0;
}

static const struct pdo *pdo_at(uint16_t position, uint8_t sm, uint16_t pos)
{
	for (unsigned int i = 0; i < machine[position].n; i++)
		if (machine[position].pdos[i].sm == sm && !pos--)
			return &machine[position].pdos[i];
	return NULL;
}

int ecrt_master_get_sync_manager(ec_master_t *m, uint16_t position, uint8_t sm, ec_sync_info_t *s)
{
	(void)m;
	*s = (ec_sync_info_t){ .index = sm, .dir = EC_DIR_OUTPUT };
	while (pdo_at(position, sm, (uint16_t)s->n_pdos))
		s->n_pdos++;
	return 0;
}

int ecrt_master_get_pdo(ec_master_t *m, uint16_t position, uint8_t sm, uint16_t pos,
			ec_pdo_info_t *p)
{
	const struct pdo *from = pdo_at(position, sm, pos);

	(void)m;
	*p = (ec_pdo_info_t){ .index = from->index, .n_entries = from->n };
	return 0;
}

int ecrt_master_get_pdo_entry(ec_master_t *m, uint16_t position, uint8_t sm, uint16_t pos,
			      uint16_t entry, ec_pdo_entry_info_t *e)
{
	const struct entry *from = &pdo_at(position, sm, pos)->entries[entry];

	(void)m;
	*e = (ec_pdo_entry_info_t){ from->index, from->subindex, from->bits };
	return 0;
}

/* --- what is configured ---------------------------------------------------------- */

static ec_slave_config_t *new_config(void)
{
	configs[n_configs].index = n_configs;
	return &configs[n_configs++];
}

ec_slave_config_t *ecrt_master_slave_config(ec_master_t *m, uint16_t alias, uint16_t position,
					    uint32_t vendor, uint32_t product)
{
	(void)m;
	if (say("config%u = %u:%u 0x%x:0x%x\n", n_configs, alias, position, vendor, product))
		return NULL;
	return new_config();
}

int ecrt_master_group(ec_master_t *m, const ec_group_info_t *g)
{
	(void)m;
	return say("group %s by %d value %u port %u at %d flags %u\n", g->name, (int)g->by,
		   g->value, g->port, g->at ? (int)g->at->index : -1, g->flags);
}

ec_slave_config_t *ecrt_master_group_config(ec_master_t *m, unsigned int group, uint16_t member,
					    uint32_t vendor, uint32_t product)
{
	(void)m;
	say("config%u = group %u member %u 0x%x:0x%x\n", n_configs, group, member, vendor,
	    product);
	return new_config();
}

ec_domain_t *ecrt_master_create_domain(ec_master_t *m)
{
	(void)m;
	say("domain%u\n", n_domains);
	domains[n_domains].index = n_domains;
	return &domains[n_domains++];
}

int ecrt_master_unit(ec_master_t *m, const ec_unit_config_t *c)
{
	int ret = say("unit %s policy %d limit %u lease %u repeats %u flags %u\n", c->name,
		      (int)c->policy, c->limit, c->lease_cycles, c->repeats, c->flags);

	(void)m;
	return ret ? ret : (int)n_units++;
}

int ecrt_domain_set_unit(ec_domain_t *d, int unit)
{
	return say("domain%u in unit %d\n", d->index, unit);
}

static int bytes(const uint8_t *data, size_t size)
{
	for (size_t i = 0; i < size; i++)
		say(" %02x", data[i]);
	return say("\n");
}

int ecrt_slave_config_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t sub, const uint8_t *data,
			  size_t size)
{
	say("config%u sdo 0x%04x:%02x", sc->index, index, sub);
	return bytes(data, size);
}

int ecrt_slave_config_sdo32(ec_slave_config_t *sc, uint16_t index, uint8_t sub, uint32_t value)
{
	return say("config%u sdo 0x%04x:%02x = 0x%x\n", sc->index, index, sub, value);
}

int ecrt_slave_config_complete_sdo(ec_slave_config_t *sc, uint16_t index, const uint8_t *data,
				   size_t size)
{
	say("config%u complete 0x%04x", sc->index, index);
	return bytes(data, size);
}

int ecrt_slave_config_idn(ec_slave_config_t *sc, uint8_t drive, uint16_t idn, ec_al_state_t state,
			  const uint8_t *data, size_t size)
{
	say("config%u idn %u 0x%04x in %d", sc->index, drive, idn, (int)state);
	return bytes(data, size);
}

int ecrt_slave_config_command(ec_slave_config_t *sc, ec_step_t step, const ec_command_t *c)
{
	say("config%u step 0x%x kind %d 0x%04x:%u", sc->index, (unsigned int)step, (int)c->kind,
	    c->index, c->subindex);
	if (c->expect)
		say(" expects");
	return bytes(c->expect ? c->expect : c->data, c->size);
}

int ecrt_slave_config_flag(ec_slave_config_t *sc, const char *key, int32_t value)
{
	return say("config%u flag %s %d\n", sc->index, key, value);
}

int ecrt_slave_config_state_timeout(ec_slave_config_t *sc, ec_al_state_t from, ec_al_state_t to,
				    unsigned int ms)
{
	return say("config%u timeout %d %d %u ms\n", sc->index, (int)from, (int)to, ms);
}

int ecrt_slave_config_sdo_timeout(ec_slave_config_t *sc, unsigned int ms)
{
	return say("config%u mailbox %u ms\n", sc->index, ms);
}

int ecrt_slave_config_dc(ec_slave_config_t *sc, uint16_t assign, uint32_t sync0, int32_t shift,
			 uint32_t sync1, int32_t shift1)
{
	return say("config%u dc 0x%04x %u %d %u %d\n", sc->index, assign, sync0, shift, sync1,
		   shift1);
}

int ecrt_slave_config_pdos(ec_slave_config_t *sc, unsigned int n, const ec_sync_info_t *s)
{
	say("config%u pdos", sc->index);
	for (unsigned int i = 0; i < n; i++) {
		say(" SM%u dir %d", s[i].index, (int)s[i].dir);
		for (unsigned int k = 0; k < s[i].n_pdos; k++) {
			say(" 0x%04x", s[i].pdos[k].index);
			for (unsigned int j = 0; j < s[i].pdos[k].n_entries; j++)
				say(" %04x:%02x/%u", s[i].pdos[k].entries[j].index,
				    s[i].pdos[k].entries[j].subindex,
				    s[i].pdos[k].entries[j].bit_length);
		}
	}
	return say("\n");
}

/* each SyncManager begins at byte 10 * SM of its domain */
int ecrt_slave_config_reg_pdo_entry_pos(ec_slave_config_t *sc, uint8_t sm, unsigned int pdo,
					unsigned int entry, ec_domain_t *d, unsigned int *bit)
{
	int ret = say("domain%u: config%u SM%u %u.%u\n", d->index, sc->index, sm, pdo, entry);

	*bit = 0;
	return ret ? ret : 10 * sm;
}

int ecrt_master_select_reference_clock(ec_master_t *m, ec_slave_config_t *sc)
{
	(void)m;
	return say("reference clock: config%u\n", sc->index);
}

int ecrt_master_set_send_interval(ec_master_t *m, size_t us)
{
	(void)m;
	return say("interval %zu\n", us);
}

static char *names;

int ecrt_master_set_names(ec_master_t *m, const char *text, size_t size)
{
	(void)m;
	free(names);
	names = strndup(text, size);
	return 0;
}

int ecrt_master_reason(const ec_master_t *m, char *buf, size_t size)
{
	(void)m;
	snprintf(buf, size, "because");
	return 0;
}

/* --- files ------------------------------------------------------------------------ */

void ec_master_free_data(struct ec_master *m);

static void clear(void)
{
	calls[0] = 0;
	n_configs = n_domains = n_units = 0;
	ec_master_free_data(&master);
}

static int load(const char *text, unsigned int flags, struct ecb_error *e)
{
	struct ecb_load how = { .struct_size = sizeof(how), .flags = flags, .file = "t" };
	struct ecb_bus *bus;
	int ret = ecb_file_parse(&bus, "t", text, strlen(text), e);

	clear();
	if (ret)
		return ret;
	how.bus = bus;
	ret = ecrt_master_load_bus(&master, &how, e);
	ecb_bus_free(bus);
	return ret;
}

#define HEAD	"ethercat: 1\nmasters:\n- slaves:\n"
#define COUPLER	"  - {name: k, vendor: 2, product: 0x10}\n"
#define LAMPS	"  - {name: lamps, vendor: 2, product: 0x20, alias: 5}\n"
#define DRIVE	"  - {name: axis, vendor: 2, product: 0x30"
#define INPUTS	"  - {name: in, vendor: 2, product: 0x40}\n"
#define AT_PORT	"  groups: [{name: g, parent: lamps, port: 1}]\n"
#define PART	HEAD COUPLER LAMPS DRIVE

/* what is refused, before anything is configured */
static const struct {
	const char *text;
	int err;
	const char *error;
} refused[] = {
	{ PART ", revision: 4}\n" INPUTS, -ENODEV,
	  "t:6: slave 'axis' revision differs: expected 0x00000004, found 0x00000003; if" },
	{ PART ", serial: 78}\n" INPUTS, -ENODEV,
	  "t:6: slave 'axis' serial differs: expected 78, found 77; install the expected device" },
	{ HEAD COUPLER LAMPS "  - {name: axis, vendor: 2, product: 0x31}\n" INPUTS, -ENODEV,
	  "t:6: slave 'axis' exchanged: expected vendor 0x00000002, product 0x00000031, found drive, vendor" },
	{ PART "}\n" INPUTS "  - {name: more, vendor: 2, product: 0x40}\n", -ENODEV,
	  "t:8: slave 'more' missing: vendor 0x00000002, product 0x00000040; connect it" },
	/* the drive is at the port of the group, as its slave or as another one */
	{ HEAD COUPLER LAMPS DRIVE ", group: g}\n" INPUTS AT_PORT, -EINVAL,
	  "t:7: slave 'in' is connected behind a hot connect group" },
	{ HEAD COUPLER LAMPS "  - {name: tool, vendor: 2, product: 0x99, group: g}\n" INPUTS
	  AT_PORT, -EINVAL, "t:7: slave 'in' is connected behind a hot connect group" },
	{ PART "}\n  - {name: in, vendor: 2, product: 0x40, group: g}\n"
	  "  groups: [{name: g, identification: 7}]\n", -EINVAL,
	  "t:8: hot connect group 'g': an application does not see identifications, and slave 'axis'" },
	{ PART ", parent: k, port: 2}\n" INPUTS, -ENODEV, "t:6: slave 'axis' moved: expected port 2" },
	{ HEAD "  - {vendor: 9, product: 9}\n  - {vendor: 9, product: 8}\n", -ENODEV,
	  "(1 more differences; 'ethercat bus check' shows all)" },
	{ PART ", identification: 3}\n", -EINVAL, "does not see the identification of slaves" },
	{ PART ", startup: [{at: preop, sdo: 0x8000:01, type: bool, value: 1}]}\n", -EINVAL,
	  "t:6: startup command of 'axis' at preop: there is no mailbox before PREOP" },
	{ PART ", startup: [{at: safeop, sdo: 0x8000:01, complete: true, data: 01}]}\n", -EINVAL,
	  "complete access begins at subindex 0; expected 0x8000:00" },
	{ PART ", startup: [{at: safeop, register: 0x900, data: 01}, {at: safeop, sdo: 0x8000:01, data: 01}]}\n",
	  -EINVAL, "at safeop the master writes SDOs before registers; move it before them" },
	{ PART ", pdos: [{index: 0x1700, sm: 2}, {index: 0x1600, sm: 2}]}\n", -EINVAL, "has no entries here" },
	{ HEAD COUPLER "  - {vendor: 2, product: 0x41, group: g, pdos: [{index: 0x2000, sm: 1, entries: [{bits: 8}]}]}\n"
	  "  groups: [{name: g, alias: 9}]\n", -EINVAL, "SM1 is not known as one of inputs" },
	{ HEAD "  - {vendor: 2, product: 0x40, group: g, identification: 3}\n  groups: [{name: g, alias: 9}]\n",
	  -EINVAL, "is known by the group; remove its alias and identification" },
	{ "ethercat: 1\nmasters:\n- main_device: eth0\n", -EINVAL, "does not choose the devices" },
	{ "ethercat: 1\nmasters:\n- sync_units: [{name: u}]\n", -EINVAL, "t:3: sync unit 'u' has no slaves" },
	{ "ethercat: 1\nmasters:\n- groups: [{name: g, alias: 1}]\n", -EINVAL, "'g' has no slaves" },
	{ "ethercat: 1\nmasters:\n- sync_units: [{name: u, lease: 5 ms}]\n  slaves:\n"
	  "  - {vendor: 2, product: 0x10, sync_unit: u}\n", -EINVAL, "give the 'cycle' of the master" },
	{ "ethercat: 1\nmasters: []\n", -EINVAL, "no master 0 in the file" },
	{ HEAD "  - {vender: 2}\n", -EINVAL, "did you mean 'vendor'" },
};

static void refusals(void)
{
	struct ecb_error e;

	for (size_t i = 0; i < sizeof(refused) / sizeof(refused[0]); i++) {
		int ret = load(refused[i].text, 0, &e);

		if (ret == refused[i].err && strstr(e.text, refused[i].error) && !calls[0])
			continue;
		printf("%zu: %d '%s', expected %d '%s'; calls '%s'\n", i, ret, e.text,
		       refused[i].err, refused[i].error, calls);
		bad++;
	}
}

static void loads(const char *text, unsigned int flags, const char *expected)
{
	struct ecb_error e;
	int ret = load(text, flags, &e);

	if (!ret && !strcmp(calls, expected))
		return;
	printf("%d '%s'\n%s---\n%s", ret, e.text, calls, expected);
	bad++;
}

#define AXIS_PDOS \
	", pdos: [{index: 0x1600, sm: 2, entries: [{object: 0x7010:01, bits: 16, name: control}]}," \
	"{index: 0x1a00, sm: 3, entries: [{bits: 16}," \
	"{object: 0x6000:11, bits: 32, name: position, type: int32, unit: mm, scale: 0.001, offset: -10}]}]"

static void whole(void)
{
	loads("ethercat: 1\nmasters:\n- cycle: 2 ms\n  reference_clock: axis\n"
	      "  sync_units: [{name: u, policy: safeop, limit: 2, lease: 5 ms, repeats: 2, lease_end: hold, needs_authority: true}]\n"
	      "  slaves:\n" COUPLER LAMPS DRIVE ", revision: 3, sync_unit: u" AXIS_PDOS
	      ", timeouts: {preop_safeop: 1500 us, mailbox: 1 s}"
	      ", clock: {assign_activate: 0x300, sync0: 2 ms, sync0_shift: -1 us}"
	      ", startup: [{at: preop, register: 0x900, data: 01 02},"
	      "{at: safeop, sdo: 0x8000:02, type: int16, value: -2},"
	      "{at: safeop, sdo: 0x8000:00, complete: true, data: 01},"
	      "{at: safeop, idn: S-0-0032, type: uint8, value: 7},"
	      "{at: op, sdo: 0x8000:03, type: uint8, value: 8}]}\n" INPUTS, 0,
	      "domain0\n"
	      "unit u policy 3 limit 2 lease 3 repeats 2 flags 3\n"
	      "domain0 in unit 0\n"
	      "domain1\n"
	      "config0 = 0:0 0x2:0x10\n"
	      "config1 = 5:0 0x2:0x20\n"
	      "config2 = 0:2 0x2:0x30\n"
	      "config3 = 0:3 0x2:0x40\n"
	      "config2 flag ExpectedRevision 3\n"
	      "config2 step 0x12 kind 1 0x0900:0 01 02\n"
	      "config2 sdo 0x8000:02 fe ff\n"
	      "config2 complete 0x8000 01\n"
	      "config2 idn 0 0x0020 in 2 07\n"
	      "config2 step 0x48 kind 0 0x8000:3 08\n"
	      "config2 timeout 2 4 2 ms\n"
	      "config2 mailbox 1000 ms\n"
	      "config2 dc 0x0300 2000000 -1000 0 0\n"
	      "config2 pdos SM2 dir 1 0x1600 7010:01/16 SM3 dir 2 0x1a00 0000:00/16 6000:11/32\n"
	      "domain1: config1 SM0 0.0\n"
	      "config2 flag FrameRepeatSupport 1\n"
	      "domain0: config2 SM2 0.0\n"
	      "domain0: config2 SM3 0.0\n"
	      "domain1: config3 SM0 0.0\n"
	      "reference clock: config2\n"
	      "interval 2000\n");
}

/* for tools: the slaves of groups are before the others, as their configurations */
static void published(void)
{
	struct ecb_bus *bus;
	struct ecb_error e;

	CHECK(!ecb_file_parse(&bus, "names", names, strlen(names), &e));
	if (!bus) {
		printf("%s\n%s", e.text, names);
		return;
	}
	CHECK(bus->masters[0]->slave_count == 4);
	CHECK(!strcmp(bus->masters[0]->slaves[1]->name, "axis"));
	CHECK(!strcmp(bus->masters[0]->slaves[3]->name, "k"));
	CHECK(!strcmp(bus->masters[0]->slaves[1]->pdos[1]->entries[2]->name, "x6000_11"));
	ecb_bus_free(bus);
}

/* ring positions count no members; the slave at whose port a group is comes first */
static void groups(void)
{
	loads("ethercat: 1\nmasters:\n- groups: [{name: g, parent: lamps, port: 1, mandatory: true, fast: true}]\n"
	      "  slaves:\n" COUPLER LAMPS DRIVE ", serial: 5, group: g}\n"
	      "  - {name: in, vendor: 2, product: 0x40, group: g}\n", 0,
	      "domain0\n"
	      "config0 = 5:0 0x2:0x20\n"
	      "group g by 3 value 0 port 1 at 0 flags 3\n"
	      "config1 = group 0 member 0 0x2:0x30\n"
	      "config2 = group 0 member 1 0x2:0x40\n"
	      "config3 = 0:0 0x2:0x10\n"
	      "config1 flag ExpectedSerial 5\n"
	      "domain0: config0 SM0 0.0\n"
	      "domain0: config1 SM2 0.0\n"
	      "domain0: config1 SM3 0.0\n"
	      "domain0: config2 SM0 0.0\n");
}

/* slot by slot, each time that the slave is configured; an empty slot is expected as such */
static void modules(void)
{
	loads(PART ", modules: [{slot: 1, ident: 0x11}, {slot: 3, ident: 0x33}], write_modules: true,"
	      "startup: [{at: safeop, sdo: 0x8000:01, type: bool, value: 1}]}\n" INPUTS, 0,
	      "domain0\n"
	      "config0 = 0:0 0x2:0x10\n"
	      "config1 = 5:0 0x2:0x20\n"
	      "config2 = 0:2 0x2:0x30\n"
	      "config3 = 0:3 0x2:0x40\n"
	      "config2 sdo 0xf030:01 = 0x11\n"
	      "config2 sdo 0xf030:02 = 0x0\n"
	      "config2 sdo 0xf030:03 = 0x33\n"
	      "config2 step 0x24 kind 0 0xf050:1 expects 11 00 00 00\n"
	      "config2 step 0x24 kind 0 0xf050:2 expects 00 00 00 00\n"
	      "config2 step 0x24 kind 0 0xf050:3 expects 33 00 00 00\n"
	      "config2 sdo 0x8000:01 01\n"
	      "domain0: config1 SM0 0.0\n"
	      "domain0: config2 SM2 0.0\n"
	      "domain0: config2 SM3 0.0\n"
	      "domain0: config3 SM0 0.0\n");
}

static void partial(void)
{
	loads(PART "}\n  - {name: more, vendor: 2, product: 0x99}\n", ECB_LOAD_PARTIAL,
	      "domain0\n"
	      "config0 = 0:0 0x2:0x10\n"
	      "config1 = 5:0 0x2:0x20\n"
	      "config2 = 0:2 0x2:0x30\n"
	      "domain0: config1 SM0 0.0\n"
	      "domain0: config2 SM2 0.0\n"
	      "domain0: config2 SM3 0.0\n");
	/* a SyncManager that the file does not have is emptied */
	loads(PART ", pdos: [{index: 0x1a00, sm: 3}]}\n" INPUTS, 0,
	      "domain0\n"
	      "config0 = 0:0 0x2:0x10\n"
	      "config1 = 5:0 0x2:0x20\n"
	      "config2 = 0:2 0x2:0x30\n"
	      "config3 = 0:3 0x2:0x40\n"
	      "config2 pdos SM3 dir 2 0x1a00 SM2 dir 1\n"
	      "domain0: config1 SM0 0.0\n"
	      "domain0: config2 SM3 0.0\n"
	      "domain0: config3 SM0 0.0\n");
}

/* Behind the break of a ring only an alias is certain, if slaves of the file are missing. */
static void ring_with_missing(void)
{
	static const char less[] = PART "}\n  - {name: more, vendor: 2, product: 0x99}\n";
	static const char part[] =
		"domain0\n"
		"config0 = 0:0 0x2:0x10\n"
		"config1 = 5:0 0x2:0x20\n"
		"config2 = 0:2 0x2:0x30\n"
		"domain0: config1 SM0 0.0\n"
		"domain0: config2 SM2 0.0\n"
		"domain0: config2 SM3 0.0\n";
	static const char uncertain[] =
		"t:6: slave 'axis' is behind the break of a ring from which slaves are missing";
	struct ecb_error e;

	is_ring = true;
	loads(less, ECB_LOAD_PARTIAL, part);
	/* the last slaves are those that are missing */
	front = 3;
	loads(less, ECB_LOAD_PARTIAL, part);
	/* from the lamps on, which have an alias, and only the drive */
	for (front = 0; front < 3; front++) {
		const char *first = front ? uncertain : "t:4: slave 'k' is behind the break";

		CHECK(load(less, ECB_LOAD_PARTIAL, &e) == -EINVAL && !calls[0]);
		if (!strstr(e.text, first)) {
			printf("%u: %s\n", front, e.text);
			bad++;
		}
		/* all are there */
		CHECK(!load(PART "}\n" INPUTS, 0, &e));
		CHECK(!load(PART "}\n" INPUTS, ECB_LOAD_PARTIAL, &e));
	}
	is_ring = false;
	front = SLAVES;
}

static void values(void)
{
	struct ecb_value v = { .struct_size = sizeof(v) }, old = { .struct_size = 8 };
	struct ecb_loaded l = { .struct_size = sizeof(l) };
	uint8_t data[64] = { 0 };
	struct ecb_error e;

	CHECK(ecrt_master_value(&master, "axis.control", NULL) == -EINVAL);
	CHECK(!load(PART AXIS_PDOS "}\n" INPUTS, 0, &e));
	CHECK(!ecrt_master_loaded(&master, &l));
	CHECK(l.slaves == 4 && l.values == 5 && !l.clocks && !l.cycle);
	CHECK(ecrt_master_value(&master, "axis.nothing", &v) == -ENOENT);
	CHECK(!ecrt_master_value(&master, "axis.position", &old));
	CHECK(old.byte == 32 && old.struct_size == 8);
	old.struct_size = 4;
	CHECK(ecrt_master_value(&master, "axis.position", &old) == -EINVAL);
	CHECK(!ecrt_master_value(&master, "axis.position", &v));
	CHECK(v.byte == 32 && !v.bit && v.bits == 32 && !v.output && v.domain == &domains[0]);
	CHECK(v.slave == &configs[2] && v.object == 0x600011 && v.type == ECB_TYPE_INT32);
	CHECK(!strcmp(v.unit, "mm"));
	EC_WRITE_S32(data + 32, -2000);
	CHECK(ecb_value_read(&v, data) == -12);
	CHECK(ecb_value_write(&v, data, 1) == -EINVAL);
	v.output = 1;
	CHECK(!ecb_value_write(&v, data, -9.9996) && EC_READ_S32(data + 32) == 0);
	CHECK(!ecb_value_write(&v, data, -11) && EC_READ_S32(data + 32) == -1000);
	CHECK(ecb_value_write(&v, data, 2147483648.0) == -ERANGE);
	CHECK(ecb_value_write(&v, data, NAN) == -EINVAL && EC_READ_S32(data + 32) == -1000);

	/* unsigned, not scaled, with a bit offset */
	CHECK(!ecrt_master_value(&master, "lamps.x7010_01", &v));
	CHECK(!v.byte && v.bit == 1 && v.bits == 1 && v.output && !*v.unit);
	CHECK(!ecb_value_write(&v, data, 1) && data[0] == 2 && ecb_value_read(&v, data) == 1);
	CHECK(ecb_value_write(&v, data, 2) == -ERANGE && ecb_value_write(&v, data, -1) == -ERANGE);
	v = (struct ecb_value){ .byte = 8, .bit = 3, .bits = 64, .output = 1, .scale = 1,
				.type = ECB_TYPE_INT64 };
	CHECK(!ecb_value_write(&v, data, -5) && ecb_value_read(&v, data) == -5);
	CHECK(ecb_value_write(&v, data, 9223372036854775808.0) == -ERANGE);
	v.type = ECB_TYPE_UINT64;
	CHECK(!ecb_value_write(&v, data, 9223372036854775808.0));
	CHECK(ecb_value_read(&v, data) == 9223372036854775808.0);
	CHECK(ecb_value_write(&v, data, INFINITY) == -ERANGE);
	v.type = ECB_TYPE_REAL64;
	CHECK(!ecb_value_write(&v, data, 0.1) && ecb_value_read(&v, data) == 0.1);
	v.type = ECB_TYPE_REAL32;
	v.bits = 32;
	CHECK(!ecb_value_write(&v, data, 0.5) && ecb_value_read(&v, data) == 0.5);
	CHECK(ecb_value_write(&v, data, 1e39) == -ERANGE && ecb_value_read(&v, data) == 0.5);
	v.scale = 0;
	CHECK(ecb_value_write(&v, data, 0) == -EINVAL);
	v.bits = 65;
	CHECK(isnan(ecb_value_read(&v, data)));

	CHECK(load("ethercat: 1\nmasters: [{slaves: [{vendor: 2, product: 0x10}]}]\n", 0, &e) == 0);
	CHECK(ecrt_master_value(&master, "axis.position", &v) == -ENOENT);
	ec_master_free_data(&master);
	CHECK(ecrt_master_loaded(&master, &l) == -ENOENT);
}

/* a call of ecrt.h that fails is named with its line and its reason */
static void failures(void)
{
	static const char *const rows[][2] = {
		{ "config2 =", "t:6: slave 'axis': cannot configure it (Operation not permitted): because" },
		{ "pdos", "t:6: slave 'axis': cannot configure its PDOs (" },
		{ "SM3 0.0", "t:6: slave 'axis': cannot register PDO 0x1a00 (" },
	};
	struct ecb_value v = { .struct_size = sizeof(v) };
	struct ecb_error e;

	for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
		fails = rows[i][0];
		CHECK(load(PART AXIS_PDOS "}\n" INPUTS, 0, &e) == -EPERM);
		if (strncmp(e.text, rows[i][1], strlen(rows[i][1])))
			bad += printf("%s\n", e.text) > 0;
		CHECK(ecrt_master_value(&master, "axis.control", &v) == -ENOENT);
	}
	fails = NULL;
}

int main(void)
{
	refusals();
	whole();
	modules();
	groups();
	published();
	partial();
	ring_with_missing();
	values();
	failures();
	ec_master_free_data(&master);
	free(names);
	return bad != 0;
}
