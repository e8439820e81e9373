// SPDX-License-Identifier: LGPL-2.1-or-later
/* Working counters that are wrong although all slaves are in OP: which slave does it? */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../../master/wire/al.h"
#include "../../master/wire/regs.h"
#include "why.h"

#define LOOKS		3	/* reads of a working counter before it counts as incomplete */
#define LOOK_MS		20
#define UNSENT		100	/* sends without a domain; before, its first one may come later */
#define FMMU_TYPE	11	/* byte of the page: 1 reads, 2 writes */
#define FMMU_ENABLE	12

static bool is_of(const struct ect_explained *c, const struct ect_fmmu *f)
{
	if (f->config)
		return c->config.index + 1 == f->config;
	return c->config.alias == f->alias && c->config.position == f->position;
}

/* NULL: that of an optional group which is not connected */
static struct ect_explained *config_of(const struct why *w, const struct ect_fmmu *f)
{
	for (size_t i = 0; i < w->configs->n; i++)
		if (is_of(why_config(w, i), f))
			return why_config(w, i);
	return NULL;
}

/* A slave that is not in OP has its own cause, and the working counter follows from it. */
static bool all_in_op(struct why *w, const struct ect_domain *dom)
{
	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ect_fmmu f = { .struct_size = sizeof(f) };
		const struct ect_explained *c;

		if (ect_domain_fmmu(w->h, dom->index, i, &f))
			return false;
		c = config_of(w, &f);
		if (c && !why_in_op(c))
			return false;
	}
	return true;
}

/* is each of some reads incomplete? One lost frame is no fault of a slave */
static bool incomplete(struct why *w, u32 index, struct ect_domain *dom)
{
	const struct timespec pause = { 0, LOOK_MS * 1000000L };

	for (int i = 0; i < LOOKS; i++) {
		dom->struct_size = sizeof(*dom);
		/* an older module does not know the state */
		if (ect_domain_read(w->h, index, dom) ||
		    (dom->working_counter == dom->expected &&
		     dom->wc_state != ECT_WC_INCOMPLETE))
			return false;
		if (i + 1 < LOOKS)
			nanosleep(&pause, NULL);
	}
	return true;
}

/* Is the area of an FMMU one that the application has given to this slave? */
static bool is_given(struct why *w, const struct ect_domain *dom, unsigned int slave,
		     const u8 *page, bool *meets)
{
	u32 at = get_unaligned_le32(page), len = get_unaligned_le16(page + 4);

	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ect_fmmu f = { .struct_size = sizeof(f) };
		const struct ect_explained *c;

		if (ect_domain_fmmu(w->h, dom->index, i, &f))
			return true;
		*meets |= at < f.logical + f.size && f.logical < at + len;
		c = config_of(w, &f);
		/* inputs of one slave and outputs of another may have the same address */
		if (c && c->config.slave_position == (int)slave && f.logical == at &&
		    page[FMMU_TYPE] == (f.dir == ECT_DIR_OUTPUT ? 2 : 1))
			return true;
	}
	return false;
}

/* Does a slave process a domain by an FMMU that no configuration has given it? */
static bool takes_part(struct why *w, struct ect_handle *h, const struct ect_domain *dom,
		       unsigned int slave)
{
	u8 pages[EC_MAX_FMMU * EC_FMMU_PAGE];

	if (ect_reg_read(h, why_slave(w, slave)->device, EC_REG_FMMU(0), pages, sizeof(pages)))
		return false;
	for (unsigned int i = 0; i < EC_MAX_FMMU; i++) {
		const u8 *page = pages + i * EC_FMMU_PAGE;
		bool meets = false;

		if (page[FMMU_ENABLE] & 1 && !is_given(w, dom, slave, page, &meets) && meets)
			return true;
	}
	return false;
}

static void counters(struct ect_finding *f, const struct ect_domain *dom)
{
	f->domain = (int)dom->index;
	f->evidence_count = 2;
	f->evidence[0] = dom->working_counter;
	f->evidence[1] = dom->expected;
}

/* More slaves have answered than the domain has. */
static void too_high(struct why *w, const struct ect_domain *dom)
{
	struct ect_handle *h = ect_new();
	struct ect_finding *f;
	int found = ECT_NONE;
	char name[96];
	bool open;

	open = h && !ect_open_path(h, w->h->path, ECT_OPEN_WRITE);
	for (size_t i = 0; open && i < w->bus->n && found == ECT_NONE; i++)
		if (takes_part(w, h, dom, (unsigned int)i))
			found = (int)i;
	ect_free(h);
	if (found != ECT_NONE)
		f = why_add(w, WC_FMMU, dom->index, dom->working_counter, dom->expected,
			    why_slave_name(w, (unsigned int)found, name, sizeof(name)));
	else if (open)
		f = why_add(w, WC_HIGH, dom->index, dom->working_counter, dom->expected);
	else
		f = why_add(w, WC_HIGH_BLIND, dom->index, dom->working_counter, dom->expected);
	counters(f, dom);
	f->slave = found;
}

/* Does the cause follow from a domain without frames: slaves wait, or their watchdog expires? */
static bool follows(const struct ect_cause *cause)
{
	return cause->kind == ECT_CAUSE_UNDER_WAY ||
	       (cause->kind == ECT_CAUSE_REFUSED && cause->state == EC_AL_OP) ||
	       (cause->kind == ECT_CAUSE_AL_ERROR && cause->code == EC_AL_CODE_SM_WATCHDOG);
}

static void explain_domain(struct why *w, const struct ect_domain *dom)
{
	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ect_fmmu f = { .struct_size = sizeof(f) };

		if (ect_domain_fmmu(w->h, dom->index, i, &f))
			return;
		for (size_t k = 0; k < w->configs->n; k++) {
			struct ect_explained *c = why_config(w, k);

			if (is_of(c, &f) && !why_in_op(c) && follows(&c->cause))
				why_explain(w, c);
		}
	}
}

/**
 * why_unsent() - domains that the application does not queue in its cycle
 * @w: what is known; the application runs the cycle
 */
void why_unsent(struct why *w)
{
	if (w->m.no_cycle)
		return;
	for (u32 i = 0; i < w->m.domain_count; i++) {
		struct ect_domain dom = { .struct_size = sizeof(dom) };
		struct ect_finding *f;

		/* an older module does not count them */
		if (ect_domain_read(w->h, i, &dom) || !dom.fmmu_count || dom.unsent < UNSENT)
			continue;
		f = why_add(w, NOT_QUEUED, i, dom.unsent);
		f->domain = (int)i;
		f->evidence_count = 1;
		f->evidence[0] = dom.unsent;
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
		struct ect_domain dom;

		if (!incomplete(w, i, &dom) || dom.unsent >= UNSENT ||
		    (w->late && dom.working_counter <= dom.expected))
			continue;
		if (dom.working_counter > dom.expected) {
			too_high(w, &dom);
			continue;
		}
		if (!all_in_op(w, &dom))
			continue;
		counters(why_add(w, WC_LOW, i, dom.working_counter, dom.expected,
				 dom.working_counter == dom.expected ?
				 " in sum, but not of each datagram" : ""), &dom);
	}
}
