// SPDX-License-Identifier: GPL-2.0-only
/* The fault statement of segment descriptions. */
#include "describe_int.h"

#define NEVER_MAX	(~0ULL >> 2)

/* what a verb works on, and the fault it makes */
enum object { SLAVE, PORT, CHANNEL, FRAME };

static const struct verb {
	const char *name;
	enum object object;
	enum ec_sim_fault_type type;
	u32 arg;
} verbs[] = {
	{ "cut", PORT, EC_SIM_FAULT_CUT, 0 },
	{ "heal", PORT, EC_SIM_FAULT_HEAL, 0 },
	{ "bounce", PORT, EC_SIM_FAULT_BOUNCE, 0 },
	{ "host", PORT, EC_SIM_FAULT_HOST, 0 },
	{ "plug", PORT, EC_SIM_FAULT_PLUG, 0 },
	{ "unplug", PORT, EC_SIM_FAULT_UNPLUG, 0 },
	{ "swap", PORT, EC_SIM_FAULT_SWAP, 0 },
	{ "off", SLAVE, EC_SIM_FAULT_POWER_OFF, 0 },
	{ "on", SLAVE, EC_SIM_FAULT_POWER_ON, 0 },
	{ "dead", SLAVE, EC_SIM_FAULT_DEAD, 1 },
	{ "alive", SLAVE, EC_SIM_FAULT_DEAD, 0 },
	{ "deaf", SLAVE, EC_SIM_FAULT_MISS_BROADCAST, 1 },
	{ "hear", SLAVE, EC_SIM_FAULT_MISS_BROADCAST, 0 },
	{ "mute", SLAVE, EC_SIM_FAULT_MUTE, 1 },
	{ "unmute", SLAVE, EC_SIM_FAULT_MUTE, 0 },
	{ "refuse", SLAVE, EC_SIM_FAULT_REFUSE_AL, 0 },
	{ "allow", SLAVE, EC_SIM_FAULT_REFUSE_AL, 0 },
	{ "busy", SLAVE, EC_SIM_FAULT_EEPROM_BUSY, 1 },
	{ "idle", SLAVE, EC_SIM_FAULT_EEPROM_BUSY, 0 },
	{ "noack", SLAVE, EC_SIM_FAULT_EEPROM_NOACK, 0 },
	{ "wkc", SLAVE, EC_SIM_FAULT_WKC, 0 },
	{ "errors", PORT, EC_SIM_FAULT_ERRORS, 0 },
	{ "damage", PORT, EC_SIM_FAULT_DAMAGE, 0 },
	{ "mailbox", SLAVE, EC_SIM_FAULT_MAILBOX, 0 },
	{ "eoe", SLAVE, EC_SIM_FAULT_EOE, 0 },
	{ "latch", SLAVE, EC_SIM_FAULT_LATCH, 0 },
	{ "jump", SLAVE, EC_SIM_FAULT_JUMP, 0 },
	{ "old", SLAVE, EC_SIM_FAULT_OLD, 0 },
	{ "error", SLAVE, EC_SIM_FAULT_AL_ERROR, 0 },
	{ "drive", SLAVE, EC_SIM_FAULT_DRIVE, 0 },
	{ "eeprom", SLAVE, EC_SIM_FAULT_EEPROM, 0 },
	{ "input", CHANNEL, EC_SIM_FAULT_INPUT, 0 },
	{ "lose", FRAME, EC_SIM_FAULT_LOSE, 0 },
	{ "duplicate", FRAME, EC_SIM_FAULT_DUPLICATE, 0 },
	{ "delay", FRAME, EC_SIM_FAULT_DELAY, 0 },
	{ "mangle", FRAME, EC_SIM_FAULT_MANGLE, 0 },
};

static const struct {
	const char *name;
	u8 state;
} states[] = {
	{ "INIT", EC_AL_INIT }, { "PREOP", EC_AL_PREOP },
	{ "BOOT", EC_AL_BOOT }, { "SAFEOP", EC_AL_SAFEOP }, { "OP", EC_AL_OP },
};

/* its bits of AL status, 0: none of them */
static u8 state_of(const struct ec_desc_word *w)
{
	for (u32 i = 0; i < ARRAY_SIZE(states); i++)
		if (ec_desc_is(w, states[i].name))
			return states[i].state;
	return 0;
}

static int refuse(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word *w = ec_desc_next(d);
	s64 code = EC_AL_CODE_UNSPECIFIED;

	f->arg = state_of(w);
	if (!f->arg)
		return ec_desc_fail(d, "invalid refuse: expected fault refuse NAME SAFEOP code=0x1d",
				    NULL, "");
	if (ec_desc_number(d, "code", 1, 0xFFFF, &code))
		return -EINVAL;
	f->arg2 = (u32)code;
	return 0;
}

/* which registers another master left behind */
static int old(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 station = -1, loops = -1, logical = -1;
	struct ec_desc_word state;

	if (ec_desc_number(d, "station", 0, 0xFFFF, &station) ||
	    ec_desc_number(d, "loops", 0, 0xFF, &loops) ||
	    ec_desc_number(d, "logical", 0, 0xFFFFFFFF, &logical))
		return -EINVAL;
	state = ec_desc_value(d, "state");
	f->arg2 = state_of(&state);
	if (state.s && !f->arg2)
		return ec_desc_fail(d, "invalid state '", &state,
				    "': expected INIT, PREOP, BOOT, SAFEOP or OP");
	if (station < 0 && loops < 0 && logical < 0 && !state.s)
		return ec_desc_fail(d, "nothing is old: expected station=N, loops=N, state=STATE or logical=N",
				    NULL, "");
	if (station >= 0)
		f->value |= (u64)station | EC_SIM_OLD_STATION;
	if (loops >= 0)
		f->value |= (u64)loops << EC_SIM_OLD_LOOPS_SHIFT | EC_SIM_OLD_LOOPS;
	if (state.s)
		f->value |= EC_SIM_OLD_STATE;
	if (logical >= 0) {
		f->value |= EC_SIM_OLD_LOGICAL;
		f->arg = (u32)logical;
	}
	return 0;
}

/* the number that a kind of mailbox fault has */
static int mailbox_number(struct ec_desc *d, struct ec_sim_fault *f)
{
	bool word = f->arg == EC_SIM_MAILBOX_ERROR;
	u64 by = 10000000;
	s64 code = 1;
	int ret = 0;

	switch (f->arg) {
	case EC_SIM_MAILBOX_ERROR:
	case EC_SIM_MAILBOX_ABORT:
	case EC_SIM_MAILBOX_DENY:
	case EC_SIM_MAILBOX_SOE:
		ret = ec_desc_number(d, "code", 0, word ? 0xFFFF : 0xFFFFFFFF, &code);
		f->arg2 = (u32)code;
		break;
	case EC_SIM_MAILBOX_DELAY:
		ret = ec_desc_time(d, "by", 4000000000u, &by);
		f->arg2 = (u32)by;
		break;
	}
	return ret;
}

static int mailbox(struct ec_desc *d, struct ec_sim_fault *f)
{
	static const char * const kinds[EC_SIM_MAILBOX_FAULTS] = {
		"good", "length", "short", "counter", "type", "babble", "stale", "fragments",
		"error", "abort", "delay", "busy", "deny", "garbage", "duplicate", "lost",
		"almost", "soe",
	};
	struct ec_desc_word *w = ec_desc_next(d);
	s64 after = 0;

	for (u32 i = 0; i < ARRAY_SIZE(kinds); i++) {
		if (!ec_desc_is(w, kinds[i]))
			continue;
		f->arg = i;
		if (mailbox_number(d, f) || ec_desc_number(d, "after", 0, 0xFFFFFFFF, &after))
			return -EINVAL;
		f->value = (u64)after;
		return 0;
	}
	return ec_desc_fail(d, "invalid mailbox fault: expected good, length, short, counter, type, babble, garbage, almost, duplicate, lost, delay by=TIME, deny code=N...",
			    NULL, "");
}

static int latch(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word *w = ec_desc_next(d), edge;

	if (!ec_desc_is(w, "0") && !ec_desc_is(w, "1"))
		return ec_desc_fail(d, "invalid latch: expected fault latch NAME 0|1 [edge=rising|falling|pulse]",
				    NULL, "");
	f->arg = ec_desc_is(w, "1");
	edge = ec_desc_value(d, "edge");
	f->arg2 = !edge.s || ec_desc_is(&edge, "rising") ? EC_SIM_EDGE_RISING :
		  ec_desc_is(&edge, "falling") ? EC_SIM_EDGE_FALLING :
		  ec_desc_is(&edge, "pulse") ? EC_SIM_EDGE_RISING | EC_SIM_EDGE_FALLING : 0;
	if (!f->arg2)
		return ec_desc_fail(d, "invalid edge '", &edge, "': expected rising, falling or pulse");
	return 0;
}

/* where a frame is lost; on the way back, unless something else is said */
static int way(struct ec_desc *d, struct ec_sim_fault *f)
{
	enum ec_sim_when when = EC_SIM_WHEN_BACK;

	if (ec_desc_when(d, &when))
		return -EINVAL;
	f->value = when == EC_SIM_WHEN_BACK;
	return 0;
}

static int frame(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 n = 0, ppb = -1, port = -1, copies = 1;
	u64 by = 10000;
	int ret;

	ret = ec_desc_number(d, "frame", 1, 0x7FFFFFFF, &n);
	if (!ret)
		ret = ec_desc_register(d, f);
	if (!ret)
		ret = ec_desc_rate(d, "rate", 1000000000, &ppb);
	if (!ret)
		ret = ec_desc_number(d, "port", 0, EC_SIM_PORTS - 1, &port);
	if (!ret && f->type == EC_SIM_FAULT_DUPLICATE)
		ret = ec_desc_number(d, "copies", 1, 16, &copies);
	if (!ret && f->type == EC_SIM_FAULT_DELAY)
		ret = ec_desc_time(d, "by", 1000000000, &by);
	if (ret)
		return ret;
	if (!n == (ppb < 0))
		return ec_desc_fail(d, "no frames selected: expected frame=100 for the 100th frame, or rate=10ppm",
				    NULL, "");
	f->port = (int)port;
	f->arg = (u32)n;
	f->arg2 = n ? 0 : (u32)div64_u64((u64)ppb + 999, 1000);
	f->value = f->type == EC_SIM_FAULT_DELAY ? by : (u64)copies;
	return f->type == EC_SIM_FAULT_LOSE ? way(d, f) : 0;
}

static int option(struct ec_desc *d, struct ec_sim_fault *f, const char *key,
		  s64 min, s64 max)
{
	s64 v = max + 1;

	if (ec_desc_number(d, key, min, max, &v))
		return -EINVAL;
	if (v == max + 1)
		return ec_desc_fail(d, "missing number: ",
			&(struct ec_desc_word){ .s = key, .n = strlen(key) },
			"=N");
	f->arg = (u32)v;
	return 0;
}

static int add_event(struct ec_desc *d, int slave, const struct ec_app_event *e)
{
	if (!ec_app_add_event(d->node[slave].app, e))
		return 0;
	ec_desc_fail(d, "out of memory", NULL, "");
	return -ENOMEM;
}

static int emergency(struct ec_desc *d, u64 at)
{
	int slave = ec_desc_slave(d, ec_desc_next(d));
	struct ec_app_event e = { .at_ns = at, .type = EC_MBOX_COE };
	s64 code = 0x1000, reg = 1;

	if (slave < 0)
		return slave;
	if (ec_desc_number(d, "code", 0, 0xFFFF, &code) ||
	    ec_desc_number(d, "register", 0, 0xFF, &reg))
		return -EINVAL;
	if (d->command) {
		*d->command = (struct ec_sim_fault){
			.at_ns = at, .type = EC_SIM_FAULT_EMERGENCY, .slave = slave,
			.arg = (u32)code, .arg2 = (u32)reg,
		};
		return 0;
	}
	put_unaligned_le16((u16)code, e.emcy);
	e.emcy[2] = (u8)reg;
	return add_event(d, slave, &e);
}

static int voe(struct ec_desc *d, u64 at)
{
	int slave = ec_desc_slave(d, ec_desc_next(d));
	struct ec_app_event e = { .at_ns = at, .type = EC_MBOX_VOE };
	s64 vendor = 0, type = 0, size = 0;

	if (slave < 0)
		return slave;
	if (d->command)
		return ec_desc_fail(d, "VoE messages are accepted in a description only", NULL, "");
	if (!d->node[slave].app->model->params.voe)
		return ec_desc_fail(d, "the slave has no VoE; add voe=TYPE to it", NULL, "");
	if (ec_desc_number(d, "vendor", 0, 0xFFFFFFFFll, &vendor) ||
	    ec_desc_number(d, "type", 0, 0xFFFF, &type) ||
	    ec_desc_number(d, "size", 0, 1474, &size))
		return -EINVAL;
	e.voe = (struct ec_app_voe){
		.hdr = { .vendor = (u32)vendor, .type = (u16)type }, .size = (u16)size,
	};
	return add_event(d, slave, &e);
}

/* a notification, or with opcode=6 an emergency */
static int soe(struct ec_desc *d, u64 at)
{
	int slave = ec_desc_slave(d, ec_desc_next(d));
	struct ec_app_event e = { .at_ns = at, .type = EC_MBOX_SOE };
	s64 opcode = EC_SOE_NOTIFICATION, drive = 0, idn = 0, elements = 0, size = 0;

	if (slave < 0)
		return slave;
	if (d->command)
		return ec_desc_fail(d, "SoE messages are accepted in a description only", NULL, "");
	if (ec_desc_number(d, "opcode", EC_SOE_NOTIFICATION, EC_SOE_EMERGENCY, &opcode) ||
	    ec_desc_number(d, "drive", 0, EC_SOE_DRIVES - 1, &drive) ||
	    ec_desc_number(d, "idn", 0, 0xFFFF, &idn) ||
	    ec_desc_number(d, "elements", 0, 0xFF, &elements) ||
	    ec_desc_number(d, "size", 0, EC_APP_SOE_DATA, &size))
		return -EINVAL;
	if (drive >= d->node[slave].app->soe.drives)
		return ec_desc_fail(d, "the slave has no such drive; add soe=N to it", NULL, "");
	e.soe = (struct ec_app_soe_message){
		.hdr = { .opcode = (u8)opcode, .drive = (u8)drive, .elements = (u8)elements,
			 .idn = (u16)idn },
		.size = (u16)size,
	};
	for (u16 i = 0; i < size; i++)
		e.soe.data[i] = (u8)(i + 1);
	return add_event(d, slave, &e);
}

static int target(struct ec_desc *d, const struct verb *v,
		  struct ec_sim_fault *f)
{
	struct ec_desc_word *w, name;
	s64 n;

	if (v->object == PORT)
		return ec_desc_port(d, f);
	w = ec_desc_next(d);
	if (v->object == SLAVE) {
		f->slave = ec_desc_slave(d, w);
		return f->slave < 0 ? f->slave : 0;
	}
	if (ec_desc_place(d, w, &name, &n))
		return -EINVAL;
	f->slave = ec_desc_slave(d, &name);
	if (f->slave < 0)
		return f->slave;
	if (!n || n > d->node[f->slave].app->model->n_chan[EC_APP_IN])
		return ec_desc_fail(d, "'", w, "' is no input channel; channels count from 1");
	f->arg = (u32)n - 1;
	return 0;
}

/* a value of an input, or a word of an EEPROM */
static int value(struct ec_desc *d, struct ec_sim_fault *f)
{
	bool input = f->type == EC_SIM_FAULT_INPUT;
	s64 min = input ? -0x80000000ll : 0, max = input ? 0xFFFFFFFFll : 0xFFFF, v = max + 1;

	if (!input && option(d, f, "word", 0, 0x3FFFF))
		return -EINVAL;
	if (ec_desc_number(d, "value", min, max, &v))
		return -EINVAL;
	if (v > max)
		return ec_desc_fail(d, "missing number: value=N", NULL, "");
	if (!input && (u64)f->arg * 2 + 2 > ec_sim_at(d->sim, (u32)f->slave)->eep.len)
		return ec_desc_fail(d, "the EEPROM ends before this word", NULL, "");
	f->arg2 = input ? 0 : (u32)v;
	f->value = (u64)v;
	return 0;
}

/* by what a clock jumps */
static int jump(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 by = 0;

	if (ec_desc_jump(d, "by", NEVER_MAX >> 1, &by))
		return -EINVAL;
	if (!by)
		return ec_desc_fail(d, "missing time: expected fault jump NAME by=-1ms", NULL, "");
	if (!(ec_sim_at(d->sim, (u32)f->slave)->cfg.features & EC_FEAT_DC))
		return ec_desc_fail(d, "the slave has no clock", NULL, "");
	f->value = (u64)by;
	return 0;
}

/* how many frames a cable damages */
static int damage(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 ppb = -1;

	if (ec_desc_rate(d, "rate", 1000000000, &ppb))
		return -EINVAL;
	if (ppb < 0)
		return ec_desc_fail(d, "missing rate: expected fault damage NAME.PORT rate=10ppm",
				    NULL, "");
	f->arg = (u32)div64_u64((u64)ppb + 999, 1000);
	return 0;
}

/* the error of a drive */
static int drive(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 n = 0;

	if (ec_desc_number(d, "drive", 0, EC_SOE_DRIVES - 1, &n) ||
	    option(d, f, "error", 0, 0xFFFF))
		return -EINVAL;
	if (n >= d->node[f->slave].app->soe.drives)
		return ec_desc_fail(d, "the slave has no such drive; add soe=N to it", NULL, "");
	f->arg2 = (u32)n;
	return 0;
}

/* what a verb wants to know beside its target */
static int details(struct ec_desc *d, const struct verb *v, struct ec_sim_fault *f)
{
	if (!strcmp(v->name, "refuse"))
		return refuse(d, f);
	switch (v->type) {
	case EC_SIM_FAULT_MAILBOX:
		return mailbox(d, f);
	case EC_SIM_FAULT_EOE:
		return ec_desc_eoe_fault(d, f);
	case EC_SIM_FAULT_OLD:
		return old(d, f);
	case EC_SIM_FAULT_LATCH:
		return latch(d, f);
	case EC_SIM_FAULT_JUMP:
		return jump(d, f);
	case EC_SIM_FAULT_EEPROM_NOACK:
		return option(d, f, "count", 0, 0xFFFFFFFFll);
	case EC_SIM_FAULT_WKC:
		return option(d, f, "add", -32768, 32767);
	case EC_SIM_FAULT_DAMAGE:
		return damage(d, f);
	case EC_SIM_FAULT_ERRORS:
		return option(d, f, "add", 0, 255);
	case EC_SIM_FAULT_AL_ERROR:
		return option(d, f, "code", 1, 0xFFFF);
	case EC_SIM_FAULT_DRIVE:
		return drive(d, f);
	case EC_SIM_FAULT_EEPROM:
	case EC_SIM_FAULT_INPUT:
		return value(d, f);
	default:
		return 0;
	}
}

/**
 * ec_desc_fault() - the fault statement, its first word is used
 * @d: description
 *
 * Context: Process. May sleep.
 * Return: 0, -EINVAL, or -ENOMEM.
 */
int ec_desc_fault(struct ec_desc *d)
{
	struct ec_desc_word *w = ec_desc_next(d);
	struct ec_sim_fault f = { .at_ns = 0 };
	const struct verb *v = NULL;
	int ret;

	ret = ec_desc_time(d, "at", NEVER_MAX, &f.at_ns);
	if (ret)
		return ret;
	if (ec_desc_is(w, "emergency"))
		return emergency(d, f.at_ns);
	if (ec_desc_is(w, "voe"))
		return voe(d, f.at_ns);
	if (ec_desc_is(w, "soe"))
		return soe(d, f.at_ns);
	for (u32 i = 0; i < ARRAY_SIZE(verbs); i++)
		if (ec_desc_is(w, verbs[i].name))
			v = &verbs[i];
	if (!v)
		return ec_desc_fail(d, "unknown fault '", w ? w : &d->w[0],
			"': expected cut, heal, off, on, lose, refuse, mute... (see simulator.rst)");
	f.type = v->type;
	f.arg = v->arg;
	ret = v->object == FRAME ? frame(d, &f) : target(d, v, &f);
	if (!ret)
		ret = details(d, v, &f);
	if (!ret && v->object != FRAME)
		ret = ec_desc_wait(d, &f);
	if (ret)
		return ret;
	if (d->command) {
		*d->command = f;
		return 0;
	}
	if (!ec_sim_add_fault(d->sim, &f))
		return 0;
	return ec_desc_fail(d, "cannot add the fault: too many faults, or the fault is invalid here",
			    NULL, "");
}
