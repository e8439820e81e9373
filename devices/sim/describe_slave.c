// SPDX-License-Identifier: GPL-2.0-only
/* Options of the slave statement. */
#include "describe_int.h"

/**
 * ec_desc_params() - options of a slave statement which belong to its model
 * @d: description
 * @p: result
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_params(struct ec_desc *d, struct ec_app_params *p)
{
	s64 vendor = 0, product = 0, revision = 0, out = -1, in = -1, mbox = 0;
	struct ec_desc_word w;
	s64 id = 0, soe = 0, voe = 0, foe = 0, diag = 0;
	bool repeat = true;
	int ret;

	ret = ec_desc_number(d, "vendor", 0, 0xFFFFFFFFll, &vendor);
	if (!ret)
		ret = ec_desc_number(d, "product", 0, 0xFFFFFFFFll, &product);
	if (!ret)
		ret = ec_desc_number(d, "revision", 0, 0xFFFFFFFFll, &revision);
	if (!ret)
		ret = ec_desc_number(d, "out", 0, 32768, &out);
	if (!ret)
		ret = ec_desc_number(d, "in", 0, 32768, &in);
	if (!ret)
		ret = ec_desc_number(d, "mbox", 32, 1486, &mbox);
	if (!ret)
		ret = ec_desc_number(d, "id", 0, 0xFFFF, &id);
	if (!ret)
		ret = ec_desc_number(d, "soe", 0, EC_SOE_DRIVES, &soe);
	if (!ret)
		ret = ec_desc_number(d, "voe", 0, 0xFFFF, &voe);
	if (!ret)
		ret = ec_desc_number(d, "foe", 0, 16384, &foe);
	if (!ret)
		ret = ec_desc_number(d, "diag", 0, EC_APP_DIAG_MAX, &diag);
	if (ret)
		return ret;
	p->vendor = (u32)vendor;
	p->product = (u32)product;
	p->revision = (u32)revision;
	p->out = out < 0 ? 8 : (u32)out;
	p->in = in < 0 ? 8 : (u32)in;
	p->mbox = (u16)mbox;
	p->id = (u16)id;
	p->soe = (u8)soe;
	p->voe = (u16)voe;
	p->foe = (u16)foe;
	p->diag = (u8)diag;

	w = ec_desc_value(d, "mapping");
	if (ec_desc_is(&w, "fixed"))
		p->mapping = EC_APP_MAP_FIXED;
	else if (ec_desc_is(&w, "assign"))
		p->mapping = EC_APP_MAP_ASSIGN;
	else if (ec_desc_is(&w, "rewritable"))
		p->mapping = EC_APP_MAP_FULL;
	else if (ec_desc_is(&w, "lenient"))
		p->mapping = EC_APP_MAP_LENIENT;
	else if (w.s)
		return ec_desc_fail(d, "invalid mapping '", &w,
				    "': expected fixed, assign, rewritable or lenient");
	ret = ec_desc_yes(d, "cpu", &p->cpu);
	if (!ret)
		ret = ec_desc_yes(d, "strict", &p->strict);
	if (!ret)
		ret = ec_desc_eoe(d, p);
	if (!ret)
		ret = ec_desc_yes(d, "repeat", &repeat);
	if (!ret)
		ret = ec_desc_quirks(d, &p->quirks);
	if (ret)
		return ret;
	p->no_repeat = !repeat;
	w = ec_desc_value(d, "motor");
	if (w.s && !ec_desc_is(&w, "AM8121"))
		return ec_desc_fail(d, "unknown motor '", &w,
				    "': expected AM8121");
	return 0;
}

/**
 * ec_desc_config() - options of a slave statement which belong to this slave alone
 * @d: description
 * @c: result
 * @cable: to the slave before
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_config(struct ec_desc *d, struct ec_app_config *c, struct ec_desc_cable *cable)
{
	u64 delay = 0, clock = 0;
	s64 alias = 0, serial = 0, drift = 0;
	struct ec_desc_word w;
	int ret;

	c->response_ns = d->response_ns;
	c->transition_ns = d->transition_ns;
	c->op_timeout_ns = d->op_timeout_ns;
	/* no two slaves are switched on at the same instant */
	clock = (u64)ec_sim_random(d->sim) << 4;
	ret = ec_desc_number(d, "alias", 0, 65535, &alias);
	if (!ret)
		ret = ec_desc_number(d, "serial", 0, 0xFFFFFFFFll, &serial);
	if (!ret)
		ret = ec_desc_time(d, "delay", 1000000, &delay);
	if (!ret)
		ret = ec_desc_rate(d, "drift", 1000000, &drift);
	if (!ret)
		ret = ec_desc_time(d, "clock", ~0ULL >> 2, &clock);
	if (!ret)
		ret = ec_desc_time(d, "response", EC_DESC_TIME_MAX, &c->response_ns);
	if (!ret)
		ret = ec_desc_time(d, "transition", EC_DESC_TIME_MAX, &c->transition_ns);
	if (!ret)
		ret = ec_desc_time(d, "op_timeout", EC_DESC_TIME_MAX, &c->op_timeout_ns);
	if (!ret)
		ret = ec_desc_time(d, "id_delay", EC_DESC_TIME_MAX, &c->id_ns);
	if (!ret)
		ret = ec_desc_time(d, "cable", 1000000, &cable->ns);
	if (!ret)
		ret = ec_desc_yes(d, "swap", &cable->swapped);
	if (!ret)
		ret = ec_desc_foe(d, c);
	if (!ret)
		ret = ec_desc_steps(d, c);
	if (!ret)
		ret = ec_desc_own_ports(d, c);
	if (ret)
		return ret;
	w = ec_desc_value(d, "eeprom");
	c->eeprom_emulated = ec_desc_is(&w, "emulated");
	if (w.s && !c->eeprom_emulated && !ec_desc_is(&w, "chip"))
		return ec_desc_fail(d, "invalid eeprom '", &w, "': expected chip or emulated");
	w = ec_desc_value(d, "ip");
	c->no_ip = ec_desc_is(&w, "no");
	c->ip_packed = ec_desc_is(&w, "packed");
	c->ip_mute = ec_desc_is(&w, "write");
	if (w.s && !c->no_ip && !c->ip_packed && !c->ip_mute && !ec_desc_is(&w, "yes"))
		return ec_desc_fail(d, "invalid ip '", &w,
				    "': expected yes, no, packed or write");
	w = ec_desc_value(d, "dc");
	c->clock_bits = ec_desc_is(&w, "64") ? 64 : ec_desc_is(&w, "32") ? 32 :
			ec_desc_is(&w, "delay") ? EC_APP_CLOCK_DELAY :
			ec_desc_is(&w, "none") ? EC_APP_NO_CLOCK : 0;
	if (w.s && !c->clock_bits)
		return ec_desc_fail(d, "invalid dc '", &w, "': expected 64, 32, delay or none");
	c->alias = (u16)alias;
	c->serial = (u32)serial;
	c->process_ns = (u32)delay;
	c->drift_ppb = (s32)drift;
	c->clock_start = clock;
	return 0;
}
