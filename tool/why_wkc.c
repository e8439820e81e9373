// SPDX-License-Identifier: GPL-2.0-only
/* Working counters that are wrong although all slaves are in OP: which slave does it? */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>

#include "../master/wire/al.h"
#include "../master/wire/regs.h"
#include "reg.h"
#include "sys.h"
#include "why.h"

#define LOOKS		3	/* at a working counter before it counts as incomplete */
#define LOOK_MS		20
#define UNSENT		100	/* sends without a domain; before, its first one may come later */
#define FMMU_TYPE	11	/* byte of the page: 1 reads, 2 writes */
#define FMMU_ENABLE	12
#define OUTPUT		1	/* direction of struct ec_ioc_domain_fmmu */

static const struct why_config *config_at(const struct why *w, u16 alias, u16 position)
{
	for (size_t i = 0; i < w->n_configs; i++)
		if (w->configs[i].c.alias == alias && w->configs[i].c.position == position)
			return &w->configs[i];
	return NULL;
}

/* A slave that is not in OP has its own cause, and the working counter follows from it. */
static bool all_in_op(struct why *w, const struct ec_ioc_domain *dom)
{
	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ec_ioc_domain_fmmu f = { .index = dom->index, .fmmu = i };
		const struct why_config *c;

		if (dev_ioctl(w->d, EC_IOC_DOMAIN_FMMU, &f))
			return false;
		c = config_at(w, f.alias, f.position);
		if (!c || !why_in_op(c))
			return false;
	}
	return true;
}

/* of some looks each is incomplete: one lost frame is no fault of a slave */
static bool incomplete(struct why *w, struct ec_ioc_domain *dom)
{
	for (int i = 0; i < LOOKS; i++) {
		*dom = (struct ec_ioc_domain){ .index = dom->index };
		/* an older module does not know the state */
		if (dev_ioctl(w->d, EC_IOC_DOMAIN, dom) ||
		    (dom->working_counter == dom->expected &&
		     dom->wc_state != EC_STATUS_WC_INCOMPLETE))
			return false;
		sleep_ms(i + 1 < LOOKS ? LOOK_MS : 0);
	}
	return true;
}

/* Is the area of an FMMU one that the application has given to this slave? */
static bool is_given(struct why *w, const struct ec_ioc_domain *dom, unsigned int slave,
		     const u8 *page, bool *meets)
{
	u32 at = get_unaligned_le32(page), len = get_unaligned_le16(page + 4);

	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ec_ioc_domain_fmmu f = { .index = dom->index, .fmmu = i };
		const struct why_config *c;

		if (dev_ioctl(w->d, EC_IOC_DOMAIN_FMMU, &f))
			return true;
		*meets |= at < f.logical + f.size && f.logical < at + len;
		c = config_at(w, f.alias, f.position);
		/* inputs of one slave and outputs of another may have the same address */
		if (c && c->c.slave_position == (int)slave && f.logical == at &&
		    page[FMMU_TYPE] == (f.dir == OUTPUT ? 2 : 1))
			return true;
	}
	return false;
}

/* Does a slave take part in a domain with an FMMU that no configuration has given it? */
static bool takes_part(struct why *w, struct dev *d, const struct ec_ioc_domain *dom,
		       unsigned int slave)
{
	u8 pages[EC_MAX_FMMU * EC_FMMU_PAGE];
	struct ec_ioc_reg r = {
		.slave = w->bus.v[slave].slave, .address = EC_REG_FMMU(0),
		.size = sizeof(pages), .data = (uintptr_t)pages,
	};

	if (dev_ioctl(d, EC_IOC_REG_READ, &r))
		return false;
	for (unsigned int i = 0; i < EC_MAX_FMMU; i++) {
		const u8 *page = pages + i * EC_FMMU_PAGE;
		bool meets = false;

		if (page[FMMU_ENABLE] & 1 && !is_given(w, dom, slave, page, &meets) && meets)
			return true;
	}
	return false;
}

/* More slaves have answered than the domain has. */
static void too_high(struct why *w, const struct ec_ioc_domain *dom)
{
	struct dev d = *w->d;
	struct why_finding *f;
	int found = WHY_NONE;
	char name[96];

	d.fd = sys_open(d.path, O_RDWR);
	for (size_t i = 0; d.fd >= 0 && i < w->bus.n && found == WHY_NONE; i++)
		if (takes_part(w, &d, dom, (unsigned int)i))
			found = (int)i;
	if (found != WHY_NONE)
		f = why_add(w, "working_counter",
			    "take the slave to INIT and back, which switches its FMMUs off: 'ethercat states INIT', then PREOP; look for what has written to it",
			    "domain %u: working counter %u, expected %u: %s answers too, by an FMMU for these process data that the application has not given it",
			    dom->index, dom->working_counter, dom->expected,
			    why_slave_name(w, (unsigned int)found, name, sizeof(name)));
	else
		f = why_add(w, "working_counter", d.fd >= 0 ?
			    "power-cycle the slaves of the domain ('ethercat domains -v') one after the other: one of them counts wrongly; look for frames that return twice: 'ethercat master'" :
			    "repeat the command as a user with access to registers: it finds a slave with leftover FMMUs",
			    "domain %u: working counter %u, expected %u: more slaves answer than the domain has",
			    dom->index, dom->working_counter, dom->expected);
	f->domain = (int)dom->index;
	f->slave = found;
	if (d.fd >= 0)
		dev_close(&d);
}

/* What the slaves of a domain do that gets no frames: they wait, or their watchdog expires. */
static bool follows(const struct ec_cause *cause)
{
	return cause->kind == EC_CAUSE_UNDER_WAY ||
	       (cause->kind == EC_CAUSE_REFUSED && cause->state == EC_AL_OP) ||
	       (cause->kind == EC_CAUSE_AL_ERROR && cause->code == EC_AL_CODE_SM_WATCHDOG);
}

static void explain_domain(struct why *w, const struct ec_ioc_domain *dom)
{
	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ec_ioc_domain_fmmu f = { .index = dom->index, .fmmu = i };

		if (dev_ioctl(w->d, EC_IOC_DOMAIN_FMMU, &f))
			return;
		for (size_t k = 0; k < w->n_configs; k++) {
			struct why_config *c = &w->configs[k];

			if (c->c.alias == f.alias && c->c.position == f.position &&
			    !why_in_op(c) && follows(&c->cause))
				why_explain(w, c);
		}
	}
}

/**
 * why_unsent() - domains that the application leaves out of its cycle
 * @w: what is known; the application runs the cycle
 */
void why_unsent(struct why *w)
{
	if (w->m.no_cycle)
		return;
	for (u32 i = 0; i < w->m.domain_count; i++) {
		struct ec_ioc_domain dom = { .index = i };

		/* an older module does not count them */
		if (dev_ioctl(w->d, EC_IOC_DOMAIN, &dom) || !dom.fmmu_count || dom.unsent < UNSENT)
			continue;
		why_add(w, "not_queued",
			"let the application call ecrt_domain_queue() for this domain in each cycle, before ecrt_master_send()",
			"domain %u: the application has not queued it in %u cycles, so its process data are not exchanged",
			i, dom.unsent)->domain = (int)i;
		explain_domain(w, &dom);
	}
}

/**
 * why_domains() - process data that are not exchanged although all slaves are in OP
 * @w: what is known
 */
void why_domains(struct why *w)
{
	if (!w->m.active || w->m.no_cycle)
		return;
	for (u32 i = 0; i < w->m.domain_count; i++) {
		struct ec_ioc_domain dom = { .index = i };

		if (!incomplete(w, &dom) || dom.unsent >= UNSENT ||
		    (w->late && dom.working_counter <= dom.expected))
			continue;
		if (dom.working_counter > dom.expected) {
			too_high(w, &dom);
			continue;
		}
		if (!all_in_op(w, &dom))
			continue;
		why_add(w, "working_counter",
			"compare the slaves of the domain: 'ethercat domains -v'; power-cycle the one whose data do not change",
			"domain %u: working counter %u, expected %u%s, although all its slaves are in OP",
			i, dom.working_counter, dom.expected,
			dom.working_counter == dom.expected ?
				" in sum, but not of each datagram" : "")->domain = (int)i;
	}
}
