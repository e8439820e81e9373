// SPDX-License-Identifier: GPL-2.0-only
/* Fragments between a simulated slave's Ethernet and the master, and the frames that wait there. */
#include "eoe.h"

#define TIME_APPENDED	0x02	/* in the second byte of the header */

/**
 * ec_app_eoe_bytes() - memory that a slave needs for its Ethernet
 * @m: model
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, 0 without Ethernet.
 */
size_t ec_app_eoe_bytes(const struct ec_app_model *m)
{
	switch (m->params.eoe) {
	case EC_APP_EOE_HOST:
		return sizeof(struct ec_app_eoe);
	case EC_APP_EOE_SWITCH:
		return sizeof(struct ec_app_eoe) + sizeof(struct ec_app_eoe_port);
	default:
		return 0;
	}
}

/**
 * ec_app_eoe_init() - give a new slave its address, or its Ethernet port
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_init(struct ec_app *app)
{
	u8 *mac;

	if (!app->eoe)
		return;
	mac = app->eoe->mac;
	mac[0] = 0x02;		/* locally administered, unicast */
	mac[1] = 0xec;
	put_unaligned_le32(ec_sim_random(app->model->sim), mac + 2);
	if (app->model->params.eoe == EC_APP_EOE_SWITCH)
		app->eoe->port = (void *)(app->eoe + 1);
}

/**
 * ec_app_eoe_reset() - the mailbox starts afresh: what is on its way is lost
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_reset(struct ec_app *app)
{
	struct ec_app_eoe *e = app->eoe;

	if (!e)
		return;
	e->heard = false;
	e->turn = false;
	e->alternate = false;
	e->n = 0;
	e->used = 0;
	e->number = 0;
	if (e->port)
		e->port->n = 0;
	memset(&e->in, 0, sizeof(e->in));
	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++)
		e->conns[i].state = EC_APP_TCP_FREE;
}

/**
 * ec_app_eoe_mac() - address of a slave
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the one the master has set, else its own.
 */
const u8 *ec_app_eoe_mac(const struct ec_app *app)
{
	return app->ip.now.which & EC_EOE_MAC ? app->ip.now.mac : app->eoe->mac;
}

/**
 * ec_app_eoe_runs() - do frames pass
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true from PREOP on, in a slave with Ethernet.
 */
bool ec_app_eoe_runs(const struct ec_app *app)
{
	return app->eoe && (app->state == EC_AL_PREOP || app->state == EC_AL_SAFEOP ||
			    app->state == EC_AL_OP);
}

/**
 * ec_app_eoe_place() - memory for a frame to the master
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the frame, which is not sent without ec_app_eoe_send(); NULL: too
 * many wait.
 */
struct ec_app_eoe_frame *ec_app_eoe_place(struct ec_app *app)
{
	struct ec_app_eoe *e = app->eoe;

	for (u32 i = 0; i < EC_APP_EOE_QUEUE; i++)
		if (!(e->used & BIT(i)))
			return &e->frames[i];
	e->dropped++;
	return NULL;
}

/**
 * ec_app_eoe_send() - append a frame to those that wait
 * @app: slave
 * @f: frame of ec_app_eoe_place()
 * @len: bytes of it
 * @due: when it is ready
 *
 * A short frame is padded.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_send(struct ec_app *app, struct ec_app_eoe_frame *f, u16 len, u64 due)
{
	u8 fault = app->esc->fault.eoe;
	struct ec_app_eoe *e = app->eoe;
	u8 i = (u8)(f - e->frames);

	if (len < EC_EOE_FRAME_MIN && fault != EC_SIM_EOE_SHORT) {
		memset(f->data + len, 0, EC_EOE_FRAME_MIN - len);
		len = EC_EOE_FRAME_MIN;
	}
	if (fault == EC_SIM_EOE_SPOOF && e->heard)
		memcpy(f->data + 6, e->peer, 6);
	f->len = len;
	f->due = due;
	f->at = 0;
	f->fragments = 0;
	f->begun = false;
	e->used |= (u16)BIT(i);
	e->order[e->n++] = i;
}

static void remove(struct ec_app_eoe *e, u32 at)
{
	e->used &= (u16)~BIT(e->order[at]);
	e->n--;
	memmove(e->order + at, e->order + at + 1, e->n - at);
}

/**
 * ec_app_eoe_fragment() - a fragment from the master
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EINVAL: it is refused, by a fault.
 */
int ec_app_eoe_fragment(struct ec_app *app, const u8 *rx, size_t len)
{
	struct ec_app_eoe *e = app->eoe;
	struct ec_eoe_fragment f;
	int ret;

	if (!ec_app_eoe_runs(app))
		return 0;
	ret = ec_eoe_fragment_decode(rx, len, &f);
	if (!ret && ec_app_eoe_refuses(app, &f))
		return -EINVAL;
	if (!ret)
		ret = ec_eoe_part_add(&e->in, e->in_data, sizeof(e->in_data), &f);
	if (ret < 0)
		e->bad++;
	if (ret < EC_APP_ETH_HDR)
		return 0;
	e->received++;
	app->esc->own.mbox_ns += app->response_ns;
	e->heard = true;
	memcpy(e->peer, e->in_data + 6, 6);
	if (e->port)
		ec_app_eoe_out(app, e->in_data, (u16)ret);
	else
		ec_app_eoe_host(app, e->in_data, (u16)ret, app->mbox.now);
	return 0;
}

/**
 * ec_app_eoe_waits() - is a fragment of a frame in the mailbox
 * @app: slave
 *
 * It has no reply, so that it can be taken while a message to the master waits. One that may be
 * refused has to wait.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: there is one, with a valid header.
 */
bool ec_app_eoe_waits(const struct ec_app *app)
{
	const struct ec_sm *p = &app->esc->sm[0].page;
	const u8 *h = app->esc->mem + p->start;

	return ec_app_eoe_runs(app) && app->esc->fault.eoe != EC_SIM_EOE_REFUSE &&
	       ec_esc_sm_readable(app->esc, 0) &&
	       (p->control & EC_SM_MODE_MASK) == EC_SM_MODE_MAILBOX &&
	       min(p->len, app->mbox.cap) >= EC_MBOX_HDR + EC_EOE_HDR &&
	       get_unaligned_le16(h) >= EC_EOE_HDR &&
	       get_unaligned_le16(h) <= min(p->len, app->mbox.cap) - EC_MBOX_HDR &&
	       !(h[4] & 0x3f) && (h[5] & 0x0f) == EC_MBOX_EOE &&
	       (h[6] & 0x0f) == EC_EOE_FRAGMENT;
}

/**
 * ec_app_eoe_turn() - is it the turn of a fragment, or of a request
 * @app: slave
 * @request: a request waits
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: a fragment may be sent.
 */
bool ec_app_eoe_turn(struct ec_app *app, bool request)
{
	struct ec_app_eoe *e = app->eoe;

	if (e)
		e->turn = !request || !e->turn;
	return e && e->turn;
}

/* The frame that the next fragment is of: the first one, or the second one in between. */
static u32 choose(struct ec_app_eoe *e, u64 now)
{
	if (e->frames[e->order[0]].fault != EC_SIM_EOE_INTERLEAVE ||
	    !e->frames[e->order[0]].begun || e->n < 2 || e->frames[e->order[1]].due > now)
		return 0;
	e->alternate = !e->alternate;
	return e->alternate;
}

static void begin(struct ec_app *app, struct ec_app_eoe_frame *f)
{
	struct ec_app_eoe *e = app->eoe;
	const struct ec_esc_fault *fault = &app->esc->fault;
	bool hit = fault->eoe && !(++e->begun % max(fault->eoe_every, 1u));

	f->begun = true;
	f->number = e->number++ & 0x0f;
	f->fault = hit ? fault->eoe : (u8)EC_SIM_EOE_GOOD;
}

/* Bytes at @tx, 0: this fragment is not sent. */
static int write_part(struct ec_app *app, u32 at, u8 *tx, size_t cap)
{
	struct ec_app_eoe *e = app->eoe;
	struct ec_app_eoe_frame *f = &e->frames[e->order[at]];
	struct ec_eoe_fragment part = { .frame = f->number };
	bool stamp = f->fault == EC_SIM_EOE_STAMP;
	u16 room = (u16)(cap + EC_MBOX_HDR - (stamp ? 4u : 0u));
	bool whole, goes = true;
	int ret;

	if (!ec_app_eoe_endless(app, f, &part)) {
		if (!ec_eoe_fragment_cut(&part, f->data, f->len, f->at, f->fragments, room)) {
			remove(e, at);
			e->dropped++;
			return 0;
		}
		goes = ec_app_eoe_spoil(app, f, &part);
	}
	f->at = (u16)(f->at + part.len);
	f->fragments++;
	whole = f->at >= f->len && f->fault != EC_SIM_EOE_ENDLESS;
	ret = goes ? ec_eoe_fragment_encode(tx, cap, &part) : 0;
	if (stamp && part.last && ret > 0) {
		tx[1] |= TIME_APPENDED;
		put_unaligned_le32((u32)app->mbox.now, tx + ret);
		ret += 4;
	}
	if (whole) {
		remove(e, at);
		e->sent++;
	}
	return max(ret, 0);
}

/*
 * May a fragment be sent? Not while messages are lost: those of a frame without end would be lost
 * one after the other without end, all at one time.
 */
static bool sends(const struct ec_app *app)
{
	const struct ec_esc_fault *f = &app->esc->fault;

	return ec_app_eoe_runs(app) && (f->mailbox != EC_SIM_MAILBOX_LOST || f->mailbox_after);
}

/**
 * ec_app_eoe_next() - the next fragment to the master
 * @app: slave
 * @tx: room for it, behind the mailbox header
 * @cap: bytes at @tx
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded by the frames that wait, no sleep, no allocation.
 * Return: bytes at @tx, 0: none is ready.
 */
int ec_app_eoe_next(struct ec_app *app, u8 *tx, size_t cap, u64 now)
{
	struct ec_app_eoe *e = app->eoe;

	if (!sends(app))
		return 0;
	ec_app_eoe_fill(app, now);
	while (e->n && e->frames[e->order[0]].due <= now) {
		u32 at = choose(e, now);
		struct ec_app_eoe_frame *f = &e->frames[e->order[at]];
		int ret;

		if (!f->begun)
			begin(app, f);
		ret = write_part(app, at, tx, cap);
		if (ret > 0)
			return ret;
	}
	return 0;
}

/**
 * ec_app_eoe_poll() - time has passed
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_poll(struct ec_app *app, u64 now)
{
	if (ec_app_eoe_runs(app))
		ec_app_tcp_poll(app, now);
}

/**
 * ec_app_eoe_due() - when the Ethernet of a slave wants to be polled
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns, EC_ESC_NEVER: not at all.
 */
u64 ec_app_eoe_due(const struct ec_app *app)
{
	const struct ec_app_eoe *e = app->eoe;
	u64 at = EC_ESC_NEVER;

	if (!ec_app_eoe_runs(app))
		return at;
	/* a message that is on its way has its own time, and the next one follows it */
	if (e->n && sends(app) && !app->mbox.out_len && ec_esc_sm_writable(app->esc, 1))
		at = e->frames[e->order[0]].due;
	return min(at, ec_app_tcp_due(e));
}
