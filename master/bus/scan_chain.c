// SPDX-License-Identifier: GPL-2.0-only
/*
 * Reading EEPROMs beside a cycle. A thread that waits for each reply would need two cycles for an
 * exchange, and two exchanges for an access. So the context that receives the result of an access
 * asks for the next one, in the same cyclic send, and each frame that reads a result starts the
 * access after it: one cycle for an access. The thread follows, and ends the chain.
 *
 * A frame whose reply is lost has started the next access already. The address that is read with
 * the data shows it, and the access is started again.
 */
#include <linux/completion.h>
#include <linux/jiffies.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../carry/post.h"
#include "../link/links.h"
#include "ports_lost.h"
#include "scan_sii_int.h"

#define BUSY_NS		(20 * NSEC_PER_MSEC)	/* of one access */
#define BUSY_LOOKS	4	/* and so many reads of its result */
#define AGAIN		5	/* starts of one access */
#define DIRECT_NS	(100 * NSEC_PER_USEC)	/* between frames if the cycle has ended */
#define LOOK_MS		20

enum chain_state {
	CHAIN_RESTS,
	CHAIN_RUNS,
	CHAIN_FAILED,
};

/*
 * The accesses to one EEPROM. The context that receives has what is not said to be the thread's
 * while @state is CHAIN_RUNS, else the thread has all.
 */
struct chain {
	struct ec_post post;
	struct ec_dg dg[2];	/* the result of an access, the command of the next one */
	struct reader *reader;
	struct completion *news;
	u8 reg[14];		/* 0x0502-0x050F */
	u8 cmd[6];
	u8 check[8];		/* data that are compared with an image */
	u8 *to;			/* memory of the first byte */
	u32 first;		/* its word */
	u32 got;		/* bytes so far, which the thread reads */
	u32 limit;		/* no access begins behind so many; also the thread's */
	u32 want;		/* the thread is woken at so many; the thread's */
	u64 since_ns;		/* when the access was started */
	u8 step;		/* bytes of an access */
	u8 looks;		/* reads of its result */
	u8 starts;		/* of it, beyond the first one */
	bool again;		/* the frame starts it: what it reads says nothing */
	u8 state;		/* enum chain_state, which the thread reads */
};

static void chain_send(struct chain *c)
{
	u16 station = c->reader->slave->station;
	u32 ahead = c->again ? 0 : c->step;
	u64 due_ns = ec_access_is_cyclic(&c->post.links->access) ? 0 :
		     ktime_get_ns() + DIRECT_NS;

	ec_scan_command(c->cmd, c->first + (c->got + ahead) / 2);
	c->dg[0] = EC_FPRD(station, EC_REG_EEP_CONTROL, sizeof(c->reg), c->reg);
	c->dg[1] = EC_FPWR(station, EC_REG_EEP_CONTROL, sizeof(c->cmd), c->cmd);
	c->post.n = c->again || c->got + ahead < READ_ONCE(c->limit) ? 2 : 1;
	ec_post_send(&c->post, due_ns);
}

/* The access has not ended, or its result is lost. Return: whether another frame is worth it. */
static bool chain_wait(struct chain *c, bool busy)
{
	if (busy)
		return ++c->looks < BUSY_LOOKS || ktime_get_ns() - c->since_ns < BUSY_NS;
	c->again = true;
	return ++c->starts < AGAIN;
}

/* Take the reply. */
static enum chain_state chain_take(struct chain *c)
{
	bool again = c->again, more = c->post.n == 2;
	u16 ctl = get_unaligned_le16(c->reg);

	if (c->dg[0].err || c->dg[0].wkc != 1)
		return CHAIN_FAILED;
	c->again = false;
	c->step = ctl & EC_EEP_READ8 ? 8 : 4;
	if (again) {
		c->since_ns = ktime_get_ns();
		c->looks = 0;
		return CHAIN_RUNS;
	}
	if (ec_scan_is_refused(c->reg))
		return CHAIN_FAILED;
	if (!ec_scan_has_word(c->reg, c->first + c->got / 2))
		return chain_wait(c, ctl & (EC_EEP_BUSY | EC_EEP_CMD_MASK)) ? CHAIN_RUNS :
									      CHAIN_FAILED;
	memcpy(c->to + c->got, c->reg + 6, c->step);
	c->since_ns = ktime_get_ns();
	c->looks = 0;
	c->starts = 0;
	/* the data before their number; pairs with chain_follow() */
	smp_store_release(&c->got, c->got + c->step);
	return more ? CHAIN_RUNS : CHAIN_RESTS;
}

/* The context that receives, on PREEMPT_RT a hard interrupt. */
static void chain_done(struct ec_post *post)
{
	struct chain *c = container_of(post, struct chain, post);
	enum chain_state state = chain_take(c);

	if (state == CHAIN_RUNS)
		chain_send(c);
	else	/* pairs with chain_follow() */
		smp_store_release(&c->state, state);
	/* @got before @want; pairs with chain_want() */
	smp_mb();
	if (state != CHAIN_RUNS || c->got >= READ_ONCE(c->want))
		complete(c->news);
}

/* From what the reader needs now up to where it has to decide again. */
static void chain_begin(struct chain *c)
{
	struct reader *r = c->reader;
	struct ec_slave *s = r->slave;

	c->first = ec_scan_image_word(r);
	c->got = 0;
	c->want = U32_MAX;
	if (r->kept) {
		c->to = c->check;
		c->limit = 1;
	} else {
		c->to = s->eeprom.part + s->eeprom.part_bytes;
		c->limit = ec_scan_image_room(r) - s->eeprom.part_bytes;
		c->want = r->need - s->eeprom.part_bytes;
	}
	c->again = true;
	c->starts = 0;
	c->state = CHAIN_RUNS;
	chain_send(c);
}

/* It has read what was needed: how much more is? It continues meanwhile: mostly there is more. */
static void chain_want(struct chain *c, u32 got)
{
	struct reader *r = c->reader;
	u32 before = 2 * c->first;

	if (r->kept)
		return;
	r->slave->eeprom.part_bytes = before + got;
	if (got < c->want)
		return;
	if (ec_scan_image_reads_on(r, before + got)) {
		WRITE_ONCE(c->want, r->need - before);
		/* pairs with chain_done(), which may have taken them just now */
		smp_mb();
		if (READ_ONCE(c->got) >= c->want)
			complete(c->news);
		return;
	}
	WRITE_ONCE(c->want, U32_MAX);
	WRITE_ONCE(c->limit, 0);
}

/* Return: whether it runs. */
static bool chain_follow(struct chain *c)
{
	/* pairs with chain_done() */
	u8 state = smp_load_acquire(&c->state);
	/* pairs with chain_take() */
	u32 got = smp_load_acquire(&c->got);
	struct reader *r = c->reader;

	/* no access is left over when the EEPROM goes to the PDI */
	if (r->done || r->alone) {
		WRITE_ONCE(c->limit, 0);
		return state == CHAIN_RUNS;
	}
	if (state == CHAIN_RUNS) {
		chain_want(c, got);
		return true;
	}
	if (got && r->kept)
		ec_scan_image_take(r, c->check, got);
	else if (got)
		ec_scan_image_reached(r, 2 * c->first + got);
	if (r->done)
		return false;
	if (state == CHAIN_FAILED) {
		r->alone = true;
		r->unheard = c->dg[0].err || c->dg[0].wkc != 1;
		memcpy(r->reg, c->reg, sizeof(r->reg));
		return false;
	}
	chain_begin(c);
	return true;
}

static bool chain_follow_all(struct job *j, struct chain *chains)
{
	bool runs = false;
	unsigned int i;

	for (i = 0; i < j->n; i++)
		runs |= chain_follow(&chains[i]);
	ec_scan_image_interrupt(j);
	ec_ports_look_for_lost(j->bus);
	return runs;
}

/**
 * ec_scan_chain_run() - read EEPROMs beside a cycle
 * @j: job; afterwards its readers are done, or alone: they need more time or another try
 *
 * Without memory nothing is read.
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_scan_chain_run(struct job *j)
{
	struct chain *chains = kvcalloc(j->n, sizeof(*chains), GFP_KERNEL);
	struct completion news;
	unsigned int i;

	if (!chains)
		return;
	init_completion(&news);
	for (i = 0; i < j->n; i++) {
		struct chain *c = &chains[i];

		c->reader = &j->rd[i];
		c->news = &news;
		c->step = 4;
		ec_post_init(&c->post, j->bus->links, chain_done);
		c->post.dg = c->dg;
		c->post.class = EC_POST_URGENT;
	}
	while (chain_follow_all(j, chains) && ec_scan_sii_goes_on(j))
		wait_for_completion_timeout(&news, msecs_to_jiffies(LOOK_MS));
	for (i = 0; i < j->n; i++)
		ec_post_cancel(&chains[i].post);
	kvfree(chains);
}
