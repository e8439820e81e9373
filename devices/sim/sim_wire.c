// SPDX-License-Identifier: GPL-2.0-only
/* A segment in the kernel's time: frames come back when the model says. */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include <linux/vmalloc.h>
#include "app.h"
#include "describe.h"
#include "master/kernel/compat.h"
#include "sim_wire.h"

#define FRAMES	320	/* on their way at once; a master has 256 slots */

/* a frame on its way */
struct ec_sim_flying {
	struct list_head list;
	struct ec_sim_flight flight;
	u64 due_ns;
	int port;
	size_t len;
	u8 eth[EC_SIM_ETH_MAX];
};

static void *sim_alloc(size_t bytes)
{
	return kvzalloc(bytes, GFP_KERNEL);
}

static void sim_free(void *p)
{
	kvfree(p);
}

const struct ec_sim_ops ec_sim_kernel_ops = { .alloc = sim_alloc, .free = sim_free };

/* the model's time */
static u64 now_ns(const struct ec_sim_wire *w)
{
	return ktime_get_ns() - w->start_ns;
}

/* Sorted by arrival; nearly always the new one is the last. */
static void insert(struct ec_sim_wire *w, struct ec_sim_flying *f)
{
	struct ec_sim_flying *p;

	lockdep_assert_held(&w->lock);
	list_for_each_entry_reverse(p, &w->flying, list)
		if (p->due_ns <= f->due_ns) {
			list_add(&f->list, &p->list);
			return;
		}
	list_add(&f->list, &w->flying);
}

static struct ec_sim_flying *unused(struct ec_sim_wire *w)
{
	struct ec_sim_flying *f = list_first_entry_or_null(&w->free, struct ec_sim_flying, list);

	lockdep_assert_held(&w->lock);
	if (f)
		list_del(&f->list);
	return f;
}

static void arm(struct ec_sim_wire *w)
{
	struct ec_sim_flying *f = list_first_entry_or_null(&w->flying, struct ec_sim_flying, list);
	u64 next = ec_sim_next_step(w->sim);

	lockdep_assert_held(&w->lock);
	if (f)
		next = min(next, f->due_ns);
	if (next != EC_ESC_NEVER && !w->polled && w->running)
		hrtimer_start(&w->timer, ns_to_ktime(w->start_ns + next), HRTIMER_MODE_ABS_SOFT);
}

static struct ec_sim_flying *due(struct ec_sim_wire *w, u64 now)
{
	struct ec_sim_flying *f = list_first_entry_or_null(&w->flying, struct ec_sim_flying, list);

	lockdep_assert_held(&w->lock);
	if (!f || f->due_ns > now)
		return NULL;
	list_del(&f->list);
	return f;
}

/* Copies of a frame follow one another. */
static void copies(struct ec_sim_wire *w, const struct ec_sim_flying *f, unsigned int n)
{
	unsigned int i;

	for (i = 1; i < n; i++) {
		struct ec_sim_flying *g = unused(w);

		if (!g)
			return;
		g->due_ns = f->due_ns + i * ec_frame_wire_ns(f->len);
		g->port = f->port;
		g->len = f->len;
		memcpy(g->eth, f->eth, f->len);
		insert(w, g);
	}
}

/* The segment knows what becomes of a frame. */
static void decided(struct ec_sim_wire *w, struct ec_sim_flying *f)
{
	const struct ec_sim_result *res = &f->flight.res;

	lockdep_assert_held(&w->lock);
	if (res->delay_ns < 0 || !res->copies) {
		list_add(&f->list, &w->free);
		return;
	}
	f->port = res->out_port;
	f->due_ns = f->flight.due_ns;
	insert(w, f);
	copies(w, f, res->copies);
}

/* Frames that no master has sent. */
static void foreign(struct ec_sim_wire *w)
{
	struct ec_sim_foreign o;
	struct ec_sim_flying *f;

	lockdep_assert_held(&w->lock);
	while (ec_sim_foreign(w->sim, &o)) {
		f = w->running ? unused(w) : NULL;
		if (!f)
			continue;
		f->port = o.port;
		f->due_ns = o.due_ns;
		f->len = sizeof(o.eth);
		memcpy(f->eth, o.eth, sizeof(o.eth));
		insert(w, f);
	}
}

/* Frames of which it was not known yet. */
static void collect(struct ec_sim_wire *w)
{
	struct ec_sim_flying *f, *next;

	list_for_each_entry_safe(f, next, &w->under_way, list) {
		if (!f->flight.done)
			continue;
		list_del(&f->list);
		decided(w, f);
	}
	foreign(w);
}

/* The time of the segment is the kernel's. */
static void advance(struct ec_sim_wire *w)
{
	lockdep_assert_held(&w->lock);
	ec_sim_advance(w->sim, now_ns(w));
	collect(w);
}

/**
 * ec_sim_wire_poll() - deliver what has arrived by now
 * @w: wire
 *
 * Context: Any.
 */
void ec_sim_wire_poll(struct ec_sim_wire *w)
{
	struct ec_sim_flying *f;
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	if (!list_empty(&w->under_way))
		advance(w);
	while ((f = due(w, now_ns(w)))) {
		raw_spin_unlock_irqrestore(&w->lock, flags);
		w->deliver(w, f->port, f->eth, f->len);
		raw_spin_lock_irqsave(&w->lock, flags);
		list_add(&f->list, &w->free);
	}
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
}

static enum hrtimer_restart timeout(struct hrtimer *timer)
{
	ec_sim_wire_poll(container_of(timer, struct ec_sim_wire, timer));
	return HRTIMER_NORESTART;
}

/**
 * ec_sim_wire_run() - take frames from now on, or stop
 * @w: wire
 * @on: true: take; false: forget all, nothing is delivered after return
 *
 * Context: Process. May sleep.
 */
void ec_sim_wire_run(struct ec_sim_wire *w, bool on)
{
	struct ec_sim_flying *f;
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	w->running = on;
	if (!on) {
		list_for_each_entry(f, &w->under_way, list)
			ec_sim_recall(w->sim, &f->flight);
		list_splice_init(&w->under_way, &w->free);
		list_splice_init(&w->flying, &w->free);
	}
	raw_spin_unlock_irqrestore(&w->lock, flags);
	if (!on)
		hrtimer_cancel(&w->timer);
}

/**
 * ec_sim_wire_set_polled() - who delivers
 * @w: wire
 * @on: true: the caller of ec_sim_wire_poll(), false: a timer
 *
 * Context: Any.
 */
void ec_sim_wire_set_polled(struct ec_sim_wire *w, bool on)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	w->polled = on;
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
}

static void launch(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	struct ec_sim_flying *f = unused(w);
	u64 start;

	lockdep_assert_held(&w->lock);
	if (!f)
		return;
	start = max(now_ns(w), w->wire_free_ns[port]);
	w->wire_free_ns[port] = start + ec_frame_wire_ns(len);
	f->len = len;
	memcpy(f->eth, eth, len);
	ec_sim_send(w->sim, &f->flight, port, f->eth, len, start);
	list_add_tail(&f->list, &w->under_way);
	collect(w);		/* mostly this one */
}

/**
 * ec_sim_wire_send() - a frame enters the segment
 * @w: wire
 * @port: master port, 0 or 1
 * @eth: Ethernet frame; copied
 * @len: its bytes, at most EC_SIM_ETH_MAX
 *
 * Context: Any.
 * Return: 0, or -ENETDOWN: not running, or no cable at the port.
 */
int ec_sim_wire_send(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	unsigned long flags;
	int ret = 0;

	raw_spin_lock_irqsave(&w->lock, flags);
	if (!w->running || !ec_sim_link(w->sim, port))
		ret = -ENETDOWN;
	else
		launch(w, port, eth, len);
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return ret;
}

/**
 * ec_sim_wire_fault() - something goes wrong in the segment
 * @w: wire
 * @f: what
 *
 * Context: Any.
 * Return: 0, or as ec_sim_add_fault().
 */
int ec_sim_wire_fault(struct ec_sim_wire *w, const struct ec_sim_fault *f)
{
	unsigned long flags;
	int ret;

	raw_spin_lock_irqsave(&w->lock, flags);
	advance(w);		/* it begins now, not with the last frame */
	ret = ec_sim_add_fault(w->sim, f);
	advance(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return ret;
}

/**
 * ec_sim_wire_show() - describe a slave in one line, as it is now
 * @w: wire
 * @index: slave, below ec_sim_count()
 * @buf: out: see ec_sim_show()
 * @size: of @buf, above 0
 *
 * Context: Any.
 */
void ec_sim_wire_show(struct ec_sim_wire *w, u32 index, char *buf, size_t size)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	/* faults whose time has come */
	advance(w);
	ec_sim_show(w->sim, index, buf, size);
	raw_spin_unlock_irqrestore(&w->lock, flags);
}

/**
 * ec_sim_wire_card() - the network card at a master port is switched on or off
 * @w: wire
 * @port: master port, 0 or 1
 * @on: as for ec_sim_card()
 *
 * Context: Any.
 */
void ec_sim_wire_card(struct ec_sim_wire *w, int port, bool on)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	advance(w);
	ec_sim_card(w->sim, port, on, now_ns(w));
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
}

/**
 * ec_sim_wire_up() - is there a cable at a master port now
 * @w: wire
 * @port: master port, 0 or 1
 *
 * Context: Any.
 * Return: whether there is.
 */
bool ec_sim_wire_up(struct ec_sim_wire *w, int port)
{
	unsigned long flags;
	bool up;

	raw_spin_lock_irqsave(&w->lock, flags);
	advance(w);
	up = ec_sim_link(w->sim, port);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return up;
}

/**
 * ec_sim_wire_takes() - is there a place for a frame that comes to an Ethernet port
 * @w: wire
 * @app: slave of the segment with a port
 *
 * Context: Any.
 * Return: false: too many wait for the mailbox.
 */
bool ec_sim_wire_takes(struct ec_sim_wire *w, const struct ec_app *app)
{
	unsigned long flags;
	bool takes;

	raw_spin_lock_irqsave(&w->lock, flags);
	takes = ec_app_eoe_takes(app);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return takes;
}

/**
 * ec_sim_wire_enter() - a frame comes to the Ethernet port of a slave
 * @w: wire
 * @app: slave of the segment with a port
 * @frame: the frame
 * @len: bytes of it
 *
 * Context: Any.
 * Return: false: there is no place for it now.
 */
bool ec_sim_wire_enter(struct ec_sim_wire *w, struct ec_app *app, const u8 *frame, u16 len)
{
	unsigned long flags;
	bool takes;

	raw_spin_lock_irqsave(&w->lock, flags);
	advance(w);
	takes = ec_app_eoe_takes(app);
	if (takes)
		ec_app_eoe_enter(app, frame, len, now_ns(w));
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return takes;
}

/**
 * ec_sim_wire_leave() - the next frame that leaves a slave by its Ethernet port
 * @w: wire
 * @app: slave of the segment with a port
 * @frame: room for EC_EOE_FRAME_MAX bytes
 *
 * Context: Any.
 * Return: bytes of it, 0: there is none.
 */
u16 ec_sim_wire_leave(struct ec_sim_wire *w, struct ec_app *app, u8 *frame)
{
	unsigned long flags;
	u16 len;

	raw_spin_lock_irqsave(&w->lock, flags);
	advance(w);
	len = ec_app_eoe_leave(app, frame);
	arm(w);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return len;
}

/**
 * ec_sim_wire_init() - put a segment into the kernel's time
 * @w: wire
 * @sim: segment; stays the caller's
 * @start_ns: kernel time (ktime) when the segment's time is 0
 * @deliver: see struct ec_sim_wire
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_sim_wire_init(struct ec_sim_wire *w, struct ec_sim *sim, u64 start_ns,
		     void (*deliver)(struct ec_sim_wire *w, int port, const u8 *eth, size_t len))
{
	unsigned int i;

	w->frames = vzalloc(array_size(FRAMES, sizeof(*w->frames)));
	if (!w->frames)
		return -ENOMEM;
	w->sim = sim;
	w->start_ns = start_ns;
	w->deliver = deliver;
	raw_spin_lock_init(&w->lock);
	hrtimer_setup(&w->timer, timeout, CLOCK_MONOTONIC, HRTIMER_MODE_ABS_SOFT);
	INIT_LIST_HEAD(&w->flying);
	INIT_LIST_HEAD(&w->under_way);
	INIT_LIST_HEAD(&w->free);
	for (i = 0; i < FRAMES; i++)
		list_add(&w->frames[i].list, &w->free);
	return 0;
}

/**
 * ec_sim_wire_exit() - the wire is not used any more
 * @w: wire without senders
 *
 * Context: Process. May sleep.
 */
void ec_sim_wire_exit(struct ec_sim_wire *w)
{
	ec_sim_wire_run(w, false);
	vfree(w->frames);
	w->frames = NULL;
}
