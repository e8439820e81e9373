// SPDX-License-Identifier: GPL-2.0-only
/*
 * The ring of recorded cycles, as that of mailbox messages (master/mailbox/mail_tap.h), with one
 * writer, the cycle owner: it takes no lock, allocates nothing and wakes no reader. Its work is the
 * same for any number of readers. Readers copy what they want without a lock and see by @head
 * whether the place may have been written meanwhile.
 */
#include <linux/math64.h>
#include <linux/minmax.h>
#include <linux/overflow.h>
#include <linux/vmalloc.h>
#include "../base/once64.h"
#include "../config/domain.h"
#include "recorder.h"
#include "unit_state.h"

#define PLACES_MAX	65536	/* a minute at 1 kHz */

static u32 first_image(const struct ec_recorder_form *f)
{
	return sizeof(struct ec_recorder_place) + f->domains * sizeof(struct ec_status_domain);
}

static u32 place_bytes(const struct ec_recorder_form *f)
{
	return first_image(f) + (f->outputs ? 2 : 1) * f->image;
}

/* Outputs are not in the image while they are sent from elsewhere. */
static void form_outputs(const struct ec_cycle *c, struct ec_recorder_form *f)
{
	u32 from = f->image, to = 0, i;

	if (c->units) {
		f->outputs = f->image;
		return;
	}
	if (!c->thread)
		return;
	ec_for_each_domain(d, c->wanted)
		for (i = 0; i < d->n_fmmus; i++) {
			const struct ec_config_fmmu *fm = d->fmmus[i].fmmu;

			if (fm->dir != EC_CFG_DIR_OUTPUT)
				continue;
			from = min(from, d->offset + fm->offset);
			to = max(to, d->offset + fm->offset + fm->size);
		}
	if (from < to) {
		f->outputs_at = from;
		f->outputs = to - from;
	}
}

/**
 * ec_recorder_form() - what is recorded of a cycle
 * @c: active cycle
 * @f: result
 *
 * Context: Process, after ec_show_begin().
 */
void ec_recorder_form(const struct ec_cycle *c, struct ec_recorder_form *f)
{
	const struct ec_recorder_part *last = NULL;

	ec_wanted_assert_stays(c->wanted);
	*f = (struct ec_recorder_form){ .domains = c->wanted->n_domains };
	ec_for_each_domain(d, c->wanted) {
		f->image = d->offset + ALIGN(d->size, 8);
		if (!last || c->domains[last->domain].image != c->domains[d->index].image) {
			last = &f->part[f->parts];
			f->part[f->parts++] = (struct ec_recorder_part){
				.domain = d->index, .offset = d->offset,
			};
		}
		f->part[f->parts - 1].len = d->offset + d->size - last->offset;
	}
	form_outputs(c, f);
}

/**
 * ec_recorder_new() - allocate a ring
 * @f: what it has to contain
 * @next: number of the first record
 *
 * All the memory of a ring, %EC_RECORD_RING at most, is that of the process which reads first.
 *
 * Context: Process. May sleep.
 * Return: the ring, to be freed with kvfree_rcu(); NULL: no memory.
 */
struct ec_recorder *ec_recorder_new(const struct ec_recorder_form *f, u64 next)
{
	struct ec_recorder *r;
	u32 places = min_t(u32, (EC_RECORD_RING - sizeof(*r)) / place_bytes(f), PLACES_MAX);

	r = __vmalloc(struct_size(r, ring, (size_t)places * place_bytes(f)),
		      GFP_KERNEL_ACCOUNT | __GFP_ZERO);
	if (!r)
		return NULL;
	r->form = *f;
	r->stride = place_bytes(f);
	r->places = places;
	r->at = r->ring;
	r->end = r->ring + (size_t)places * r->stride;
	r->first = next;
	atomic64_set(&r->head, next);
	return r;
}

/**
 * ec_recorder_begin() - record a cycle from now on
 * @c: active cycle
 * @r: ring that is not used yet
 *
 * Context: Process, after ec_show_begin().
 * Return: false: the cycle is not the one for which the ring was made.
 */
bool ec_recorder_begin(struct ec_cycle *c, struct ec_recorder *r)
{
	struct ec_recorder_form f;

	ec_recorder_form(c, &f);
	if (memcmp(&f, &r->form, sizeof(f)))
		return false;
	rcu_assign_pointer(c->cycles->recorder, r);
	return true;
}

/**
 * ec_recorder_leave() - the last reader has ended
 * @cycles: of the master
 * @r: its ring; kvfree_rcu() may follow
 *
 * Context: Process, once for a ring.
 */
void ec_recorder_leave(struct ec_cycles *cycles, struct ec_recorder *r)
{
	cmpxchg((__force struct ec_recorder **)&cycles->recorder, r, NULL);
}

/**
 * ec_recorder_end() - the session ends; readers get what is left
 * @c: cycle of the session; it does not run any more
 *
 * Context: Process, lock of the configuration held.
 */
void ec_recorder_end(struct ec_cycle *c)
{
	struct ec_recorder *r;

	lockdep_assert_held(c->wanted->lock);
	rcu_read_lock();
	r = xchg((__force struct ec_recorder **)&c->cycles->recorder, NULL);
	if (r)
		/* pairs with ec_recorder_get(): all records before this */
		smp_store_release(&r->ended, true);
	rcu_read_unlock();
}

/* Of a domain, from where it is sent now */
static const u8 *source_of(const struct ec_cycle *c, unsigned int domain)
{
	if (c->units && c->units->replaced >> domain & 1)
		return c->units->image;
	return c->direct ?: c->domains[domain].image;
}

/* The outputs of units come from several images. */
static noinline void put_units(const struct ec_cycle *c, u8 *to)
{
	ec_for_each_domain(d, c->wanted)
		memcpy(to + d->offset, source_of(c, d->index) + d->offset, d->size);
}

/* One image, or the second one with the outputs. */
static void put_images(const struct ec_cycle *c, const struct ec_recorder *r,
		       struct ec_recorder_place *p)
{
	const struct ec_recorder_form *f = &r->form;
	u8 *image = (u8 *)p + first_image(f);
	const struct ec_recorder_part *part;

	for (part = f->part; part != f->part + f->parts; part++)
		memcpy(image + part->offset, c->domains[part->domain].image + part->offset,
		       part->len);
	p->apart = f->outputs && (c->units || c->direct);
	if (!p->apart)
		return;
	image += f->image;
	if (c->units)
		put_units(c, image);
	else
		memcpy(image + f->outputs_at, c->direct + f->outputs_at, f->outputs);
}

static void recorder_store(struct ec_recorder *r, const struct ec_cycle *c, u64 sent, u64 now)
{
	struct ec_recorder_place *p = (struct ec_recorder_place *)r->at;

	/* @head, of the last record, before the data */
	smp_wmb();
	p->time_ns = now;
	p->app_time_ns = ec_read64(&c->dc->app_time);
	p->cycle = c->sends;
	p->sent = sent;
	memcpy(p + 1, c->shared->status->domains,
	       r->form.domains * sizeof(struct ec_status_domain));
	put_images(c, r, p);
	r->at += r->stride;
	if (r->at == r->end)
		r->at = r->ring;
	/* the data before @head */
	smp_wmb();
	atomic64_set(&r->head, atomic64_read(&r->head) + 1);
}

/**
 * ec_recorder_put() - a cycle was sent
 * @c: active cycle
 * @sent: its domains, bit n: domain n
 * @now: CLOCK_MONOTONIC
 *
 * Call it only if ec_recorder_wanted(). The oldest record is overwritten.
 *
 * Context: The cycle owner. RT-safe: one or two copies of the image, no lock, no sleep, no
 * allocation.
 */
void ec_recorder_put(const struct ec_cycle *c, u64 sent, u64 now)
{
	struct ec_recorder *r;

	rcu_read_lock();
	r = rcu_dereference(c->cycles->recorder);
	if (r)
		recorder_store(r, c, sent, now);
	rcu_read_unlock();
}

static u64 recorder_oldest(const struct ec_recorder *r)
{
	u64 head = ec_recorder_head(r);

	return head - r->first > ec_recorder_kept(r) ? head - ec_recorder_kept(r) : r->first;
}

static void load_states(const struct ec_recorder *r, const struct ec_recorder_place *p,
			struct ec_record *to)
{
	const struct ec_status_domain *st = (const struct ec_status_domain *)(p + 1);
	u32 i;

	to->complete = 0;
	to->zero = 0;
	for (i = 0; i < r->form.domains; i++) {
		if (st[i].wc_state == EC_STATUS_WC_COMPLETE)
			to->complete |= BIT_ULL(i);
		if (st[i].wc_state == EC_STATUS_WC_ZERO)
			to->zero |= BIT_ULL(i);
	}
}

/* From a place that may be written meanwhile nothing outside of it is read. Return: the end. */
static u8 *load_place(const struct ec_recorder *r, const struct ec_recorder_place *p,
		      const struct ec_recorder_run *runs, u32 n, struct ec_record *to)
{
	const u8 *image = (const u8 *)p + first_image(&r->form);
	const u8 *outputs = image + (p->apart && r->form.outputs ? r->form.image : 0);
	u8 *end = (u8 *)(to + 1);
	u32 i;

	to->time_ns = p->time_ns;
	to->app_time_ns = p->app_time_ns;
	to->cycle = p->cycle;
	to->sent = p->sent;
	load_states(r, p, to);
	for (i = 0; i < n; i++) {
		memcpy(end, (runs[i].output ? outputs : image) + runs[i].offset, runs[i].len);
		end += runs[i].len;
	}
	return end;
}

/* Copy record @at; false: its place may be that of a newer one. */
static bool recorder_load(const struct ec_recorder *r, u64 at, const struct ec_recorder_run *runs,
			  u32 n, struct ec_record *to)
{
	const struct ec_recorder_place *p;
	u32 place;

	div_u64_rem(at - r->first, r->places, &place);
	p = (const struct ec_recorder_place *)(r->ring + (size_t)place * r->stride);
	/* @head before the data */
	smp_rmb();
	/* what the cycle has changed meanwhile is read again */
	data_race(load_place(r, p, runs, n, to));
	/* the data before @head */
	smp_rmb();
	return at >= recorder_oldest(r);
}

/**
 * ec_recorder_get() - the next record of a reader
 * @r: ring
 * @at: number of the record to read; then that of the next one
 * @runs: what the reader wants, within the image
 * @n: how many
 * @to: result, with all wanted bytes behind it; its @size is left
 *
 * Context: Any. It never waits for the cycle.
 * Return: false: there is no record yet.
 */
bool ec_recorder_get(const struct ec_recorder *r, u64 *at, const struct ec_recorder_run *runs,
		     u32 n, struct ec_record *to)
{
	u64 oldest;

	if (*at >= ec_recorder_head(r))
		return false;
	to->missed = 0;
	do {
		oldest = recorder_oldest(r);
		if (*at < oldest) {
			to->missed += oldest - *at;
			*at = oldest;
		}
	} while (!recorder_load(r, *at, runs, n, to));
	to->number = *at;
	++*at;
	return true;
}
