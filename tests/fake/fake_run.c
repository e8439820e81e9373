// SPDX-License-Identifier: GPL-2.0-only
/*
 * Fake master: a bus that runs without an application. FAKE_BUS=run: it runs, with slaves 1 and 2,
 * or as the application of FAKE_OWNER. Otherwise a program may begin it. FAKE_STUCK: so many of
 * its slaves come to OP. FAKE_CHANGES: so many reads show another position. FAKE_GROWS: after so
 * many reads PDOs have more entries. FAKE_NAMES: file with the names of the application.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fake.h"

static unsigned int positions[FAKE_SLAVES] = { 1, 2 };
static unsigned int configs;
static bool reserved, active;

static bool runs(void)
{
	return fake_bus("run");
}

void fake_run_master(struct fake_master *m)
{
	if (runs()) {
		const char *owner = getenv("FAKE_OWNER");

		m->phase = EC_PHASE_OPERATION;
		m->active = 1;
		m->session = owner ? EC_SESSION_ACTIVE : EC_SESSION_DETACHED;
		m->left = !owner;
		strcpy(m->owner, owner ? owner : "");
		m->domain_count = 1;
		m->config_count = configs = 2;
		m->cycle_wire_ns = 13440;
	} else if (reserved) {
		m->config_count = configs;
	}
}

void fake_run_slave(struct fake_slave *s)
{
	for (unsigned int i = 0; i < configs && (runs() || reserved); i++)
		if (positions[i] == s->position)
			s->config = i + 1;
}

static int refuse(const char *why)
{
	return fake_fail(EBUSY, why);
}

static int reserve(void)
{
	if (runs())
		return refuse("master 0 runs without an application ('ethercat run'); end that with 'ethercat stop'");
	if (fake_bus("app"))
		return refuse("master 0 is reserved by process 7 (demo); stop that application first");
	reserved = true;
	fake_record("reserve\n");
	return 0;
}

static int add_config(struct ec_ioc_slave_config *x)
{
	x->index = configs;
	positions[configs++] = x->position;
	fake_record("config %u: 0x%08x 0x%08x\n", x->position, x->vendor_id, x->product_code);
	return 0;
}

static int config(struct ec_ioc_config *c)
{
	const char *stuck = getenv("FAKE_STUCK");
	struct fake_slave s;
	__u32 i = c->index;

	if (i >= configs || fake_slave_get((__u16)positions[i], &s))
		return fake_fail(ENOENT, "there is no such configuration");
	*c = (struct ec_ioc_config){
		.index = i, .position = s.position, .vendor_id = s.vendor_id,
		.product_code = s.product_code, .slave_position = s.position,
		.state = (active || runs()) && (!stuck || i < (unsigned int)atoi(stuck)) ?
			 EC_STATUS_SC_OP : 0,
	};
	return 0;
}

static int sm(struct ec_ioc_config_sm *x)
{
	struct ec_ioc_sm from = { .slave.position = (__u16)positions[x->index], .sm = x->sm };

	if (fake_slave_command(EC_IOC_SM, &from) || !from.pdo_count)
		return 0;
	x->dir = from.control & 4 ? 1 : 2;
	x->pdo_count = from.pdo_count;
	return 0;
}

static int pdo(struct ec_ioc_config_pdo *x)
{
	struct ec_ioc_pdo from = {
		.slave.position = (__u16)positions[x->index], .sm = x->sm,
		.pdo_pos = (__u16)x->pdo_pos,
	};
	int ret = fake_slave_command(EC_IOC_PDO, &from);
	static int reads;

	x->pdo_index = from.index;
	x->entry_count = from.entry_count;
	/* another session begins after so many reads */
	if (getenv("FAKE_GROWS") && reads++ >= atoi(getenv("FAKE_GROWS")))
		x->entry_count += 200;
	return ret;
}

static int entry(struct ec_ioc_config_entry *x)
{
	struct ec_ioc_pdo_entry from = {
		.slave.position = (__u16)positions[x->index], .sm = x->sm,
		.pdo_pos = (__u16)x->pdo_pos,
		.entry_pos = getenv("FAKE_GROWS") ? 0 : (__u16)x->entry_pos,
	};
	int ret = fake_slave_command(EC_IOC_PDO_ENTRY, &from);

	x->entry_index = from.index;
	x->subindex = from.subindex;
	x->bits = from.bits;
	return ret;
}

static int domain(struct ec_ioc_domain *d)
{
	*d = (struct ec_ioc_domain){
		.size = 9, .working_counter = 5, .expected = 5, .fmmu_count = 3,
		.wc_state = EC_STATUS_WC_COMPLETE, .datagram_count = 1, .datagram_bytes = 21,
	};
	return 0;
}

static unsigned int reads;	/* of the data */

/*
 * FAKE_ANOTHER: another session of the same size has begun after so many reads; with the names of
 * FAKE_OTHER_NAMES and the same places, if that is set
 */
static bool another(void)
{
	const char *after = getenv("FAKE_ANOTHER");

	return after && reads > (unsigned int)atoi(after);
}

static int fmmu(struct ec_ioc_domain_fmmu *x)
{
	static const struct ec_ioc_domain_fmmu fmmus[] = {
		{ .position = 1, .sm = 0, .dir = 1, .size = 1, .config = 1 },
		{ .position = 2, .sm = 2, .dir = 1, .size = 2, .offset = 1, .config = 2 },
		{ .position = 2, .sm = 3, .dir = 2, .size = 6, .offset = 3, .config = 2 },
	};
	__u32 i = x->fmmu;

	if (i >= LEN(fmmus))
		return fake_fail(ENOENT, "there is no such FMMU");
	*x = fmmus[i];
	if (another() && i && !getenv("FAKE_OTHER_NAMES"))
		x->offset = i == 1 ? 7 : 1;
	x->fmmu = i;
	return 0;
}

/* the position is the only value that changes */
static int data(struct ec_ioc_domain_data *x)
{
	__u8 image[9] = { 0x02, 0x0f, 0x00, 0xfe, 0xff, 0xff, 0xff, 0, 0 };
	const char *changes = getenv("FAKE_CHANGES");

	if (changes && reads > (unsigned int)atoi(changes))
		return fake_fail(ENOENT, "there is no session");
	image[3] = (__u8)(image[3] + (changes ? reads : 0));
	reads++;
	if (x->size > sizeof(image))
		x->size = sizeof(image);
	memcpy((void *)(uintptr_t)x->data, image, x->size);
	return 0;
}

static int output(const struct ec_ioc_output *x)
{
	if (!runs() || getenv("FAKE_OWNER"))
		return fake_fail(EPERM, "the outputs of master 0 are those of an application");
	fake_record("output %u: bit %u, %u bits, 0x%llx, device %llu, lease %u%s\n", x->domain,
		    x->bit, x->bits, x->value, x->device, x->lease_ms,
		    x->flags & EC_OUTPUT_FLAG_HOLD ? ", hold" : "");
	return 0;
}

static int cycle_stats(struct ec_ioc_cycle_stats *x)
{
	struct ec_status_cycle st = {
		.state = EC_CYCLE_STATE_RUNNING,
		/* cleared once, as by 'ethercat cycle --reset', and by another session */
		.late_count = another() ? 10 + reads : reads == 2 ? 5 : 1000 + reads,
	};

	x->kind = EC_CYCLE_BY_KERNEL;
	x->active = 1;
	x->interval_set = 1;
	x->interval_ns = 1000000;
	x->cpu = -1;
	x->priority = getenv("FAKE_OTHER_SCHED") ? 0 : 50;
	x->priority_wanted = 50;
	memcpy((void *)(uintptr_t)x->data, &st, sizeof(st));
	return 0;
}

/* FAKE_TYPE: what slave 2 says it is */
static int type(struct ec_ioc_sdo *x)
{
	static const struct {
		const char *type;
		__u16 index;
		__u8 sub;
		__u32 value;
	} all[] = {
		{ "402", 0x1000, 0, 0x00020192 },
		{ "modular", 0x1000, 0, 5001 }, { "modular", 0xf010, 0, 2 },
		{ "modular", 0xf010, 1, 5001 }, { "modular", 0xf010, 2, 402 },
		{ "safety", 0x1000, 0, 5001 }, { "safety", 0xf980, 1, 7 },
		{ "many", 0x1000, 0, 5001 }, { "many", 0xf010, 0, 65 },
		{ "io", 0x1000, 0, 5001 }, { "io", 0xf010, 0, 2 },
	};
	/* INDEX:SUBINDEX:CODE in hex, decimal and hex: the slave refuses that object */
	const char *code = getenv("FAKE_ABORT");
	unsigned int index, sub, abort_code;
	const char *type = getenv("FAKE_TYPE");

	if (type && !strcmp(type, "mute"))
		return fake_fail(ETIMEDOUT, "slave 2 has not answered");
	if (code && sscanf(code, "%x:%u:%x", &index, &sub, &abort_code) == 3 &&
	    x->index == index && x->subindex == sub) {
		x->abort_code = abort_code;
		return fake_fail(EIO, "SDO aborted");
	}
	for (size_t i = 0; type && i < LEN(all); i++) {
		if (strcmp(type, all[i].type) || x->index != all[i].index ||
		    x->subindex != all[i].sub)
			continue;
		x->size = sizeof(all[i].value);
		memcpy((void *)(uintptr_t)x->data, &all[i].value, sizeof(all[i].value));
		return 0;
	}
	return FAKE_OTHER;
}

static int begin(unsigned long request, void *arg)
{
	switch (request) {
	case EC_IOC_SDO_UPLOAD:
		return type(arg);
	case EC_IOC_RESERVE:
		return reserve();
	case EC_IOC_CREATE_DOMAIN:
		return 0;
	case EC_IOC_SLAVE_CONFIG:
		return add_config(arg);
	case EC_IOC_REG_ENTRY:
		fake_record("domain: config %u SM%u\n", ((struct ec_ioc_reg_entry *)arg)->config,
			    ((struct ec_ioc_reg_entry *)arg)->sm);
		return 0;
	case EC_IOC_CYCLE:
		fake_record("cycle %u ns, stall %u, flags %u\n",
			    ((struct ec_ioc_cycle *)arg)->period_ns,
			    ((struct ec_ioc_cycle *)arg)->stall_cycles,
			    ((struct ec_ioc_cycle *)arg)->flags);
		return 0;
	case EC_IOC_ACTIVATE:
		active = true;
		fake_record("activate\n");
		return 0;
	case EC_IOC_DETACH:
		if (getenv("FAKE_STAYS"))
			return fake_fail(ETIMEDOUT, "the cycle does not run");
		fake_record("detach\n");
		return 0;
	case EC_IOC_OUTPUT:
		return output(arg);
	default:
		return FAKE_OTHER;
	}
}

static int names(struct ec_ioc_names *x)
{
	const char *other = another() ? getenv("FAKE_OTHER_NAMES") : NULL;
	const char *path = other ? other : getenv("FAKE_NAMES");
	FILE *f = path ? fopen(path, "r") : NULL;
	__u32 room = x->size;

	x->size = 0;
	if (!f)
		return 0;
	if (room)
		x->size = (__u32)fread((void *)(uintptr_t)x->data, 1, room, f);
	while (fgetc(f) != EOF)
		x->size++;
	fclose(f);
	return 0;
}

int fake_run(unsigned long request, void *arg)
{
	int ret = begin(request, arg);

	if (ret != FAKE_OTHER || (!reserved && !runs()))
		return ret;
	switch (request) {
	case EC_IOC_CONFIG:
		return config(arg);
	case EC_IOC_CONFIG_SM:
		return sm(arg);
	case EC_IOC_CONFIG_PDO:
		return pdo(arg);
	case EC_IOC_CONFIG_ENTRY:
		return entry(arg);
	case EC_IOC_CONFIG_WHY:
		strcpy(((struct ec_ioc_config_why *)arg)->text, getenv("FAKE_STUCK") ?
		       "slave 2: SAFEOP refused" : "");
		return 0;
	case EC_IOC_CYCLE_STATS:
		return cycle_stats(arg);
	case EC_IOC_DOMAIN:
		return domain(arg);
	case EC_IOC_DOMAIN_FMMU:
		return fmmu(arg);
	case EC_IOC_DOMAIN_DATA:
		return data(arg);
	case EC_IOC_NAMES:
		return names(arg);
	default:
		return FAKE_OTHER;
	}
}
