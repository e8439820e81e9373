// SPDX-License-Identifier: GPL-2.0-only
/*
 * Mailbox of a simulated slave. At most one message is in SM1 or on its way
 * there; while it is, the next request stays in SM0, as in a slave with one
 * buffer.
 */
#include "app.h"

static u32 od_read(void *ctx, u16 index, u8 sub, bool complete, u8 *buf,
		   size_t cap, size_t *len)
{
	return ec_app_od_read(ctx, index, sub, complete, buf, cap, len);
}

static u32 od_write(void *ctx, u16 index, u8 sub, bool complete,
		    const u8 *data, size_t len)
{
	struct ec_app *app = ctx;

	app->mbox.writes++;
	if (index == EC_DIAG_INDEX && sub == EC_DIAG_SUB_ACK && !complete &&
	    app->model->params.diag)
		return ec_app_diag_write(app, data, len);
	return ec_app_od_write(ctx, index, sub, complete, data, len);
}

static const struct ec_sdo_srv_ops od_ops = {
	.read = od_read,
	.write = od_write,
};

/**
 * ec_app_mbox_reset() - start afresh: power-on, INIT to PREOP or BOOT
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_reset(struct ec_app *app)
{
	struct ec_app_mbox *m = &app->mbox;

	m->out_len = 0;
	m->last_len = 0;
	m->out_in_sm = false;
	m->rx_waits = false;
	m->toggle = false;
	m->rx_counter = 0;
	m->tx_counter = 0;
	m->n_emcy = 0;
	m->n_voe = 0;
	ec_app_foe_reset(app);
	ec_app_eoe_reset(app);
	ec_app_soe_restart(app);
	memset(&m->info, 0, sizeof(m->info));
	m->info.done = true;
	if (m->cap)
		ec_sdo_srv_init(&m->srv, &od_ops, app, app->sdo_buf,
				EC_APP_SDO_BUF);
}

/* bytes a message to the master may have, header included */
static u16 tx_size(const struct ec_app *app)
{
	/* the master may write anything into the page of a SyncManager */
	return max_t(u16, min(app->mbox.cap, app->esc->sm[1].page.len), EC_MBOX_HDR);
}

/* A message of @len bytes lies behind the header place of the out buffer. */
static void out_set(struct ec_app *app, u8 type, size_t len, u64 due)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_wbuf w = ec_wbuf(m->out, m->cap);
	struct ec_mbox_hdr h = { .len = (u16)len, .type = type };

	if (!m->tx_counter || !ec_app_bug(app, EC_SIM_BUG_MBOX_COUNTER))
		m->tx_counter = ec_mbox_next_counter(m->tx_counter);
	h.counter = m->tx_counter;
	ec_mbox_hdr_encode(&w, &h);
	m->out_len = (u16)(EC_MBOX_HDR + len);
	m->out_due = due + ec_app_mbox_late(app);
	m->out_in_sm = false;
}

static void out_error(struct ec_app *app, u16 detail, u64 due)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_wbuf w = ec_wbuf(m->out + EC_MBOX_HDR, EC_MBOX_ERR_BODY);

	ec_mbox_error_encode(&w, detail);
	out_set(app, EC_MBOX_ERR, EC_MBOX_ERR_BODY, due);
}

static void info_begin(struct ec_app *app, u8 opcode, size_t size)
{
	ec_sdoinfo_resp_init(&app->mbox.info, opcode, app->mbox.info_buf, size);
}

static u32 info_list(struct ec_app *app, u16 list)
{
	const struct ec_app_model *m = app->model;
	struct ec_wbuf w = ec_wbuf(app->mbox.info_buf, app->mbox.info_cap);

	if (list > EC_SDOINFO_SETTINGS)
		return EC_ABORT_RANGE;
	ec_wbuf_le16(&w, list);
	for (u16 l = 1; !list && l <= EC_SDOINFO_SETTINGS; l++) {
		u16 n = 0;

		for (u32 i = 0; i < m->n_objects; i++)
			n += ec_app_od_in_list(m, &m->objects[i], l);
		ec_wbuf_le16(&w, n);
	}
	for (u32 i = 0; list && i < m->n_objects; i++)
		if (ec_app_od_in_list(m, &m->objects[i], list))
			ec_wbuf_le16(&w, m->objects[i].index);
	if (w.bad)
		return EC_ABORT_MEMORY;
	if (list && ec_app_bug(app, EC_SIM_BUG_INFO_LIST))
		w.p -= 2;
	info_begin(app, EC_SDOINFO_LIST_RESP,
		   (size_t)(w.p - app->mbox.info_buf));
	return 0;
}

static u32 info_object(struct ec_app *app, u16 index)
{
	const struct ec_app_object *o = ec_app_od_object(app->model, index);
	struct ec_od_object d;
	int len;

	if (!o)
		return EC_ABORT_NO_OBJECT;
	d = (struct ec_od_object){
		.index = index,
		.type = o->type,
		.max_sub = o->max_sub,
		.code = o->code,
		.name = o->name,
		.name_len = strlen(o->name),
	};
	len = ec_od_object_encode(app->mbox.info_buf, app->mbox.info_cap, &d);
	if (len < 0)
		return EC_ABORT_MEMORY;
	info_begin(app, EC_SDOINFO_OBJECT_RESP, (size_t)len);
	return 0;
}

static u32 info_entry(struct ec_app *app, u16 index, u8 sub, u8 info)
{
	const struct ec_app_object *o = ec_app_od_object(app->model, index);
	const struct ec_app_entry *e = ec_app_od_entry(app->model, index, sub);
	struct ec_od_entry d;
	struct ec_app_od_values v;
	char buf[24];
	int len;

	if (!e)
		return o ? EC_ABORT_NO_SUB : EC_ABORT_NO_OBJECT;
	d = (struct ec_od_entry){
		.index = index,
		.sub = sub,
		.type = e->type,
		.bits = e->bits,
		.access = e->access,
	};
	d.name_len = ec_app_od_name(app->model, e, buf, &d.name);
	ec_app_od_values(app->model, e, info, &v);
	len = ec_od_entry_encode(app->mbox.info_buf, app->mbox.info_cap, &d, &v.v);
	if (len < 0)
		return EC_ABORT_MEMORY;
	info_begin(app, EC_SDOINFO_ENTRY_RESP, (size_t)len);
	return 0;
}

/* next fragment of SDO information into the out buffer */
static void info_next(struct ec_app *app, u64 due)
{
	struct ec_app_mbox *m = &app->mbox;
	int len = ec_sdoinfo_resp_next(&m->info, m->out + EC_MBOX_HDR,
				       tx_size(app) - (size_t)EC_MBOX_HDR);

	if (len > 0)
		out_set(app, EC_MBOX_COE, (size_t)len, due);
	else
		m->info.done = true;
}

static void info_request(struct ec_app *app, const u8 *rx, size_t len, u64 due)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_sdoinfo_req req;
	u32 abort = EC_ABORT_COMMAND;
	int ret;

	m->info.done = true;
	if (ec_sdoinfo_req_decode(rx, len, &req)) {
		out_error(app, EC_MBOX_ERR_SERVICE, due);
		return;
	}
	if (!(app->model->dev.coe & EC_SII_COE_SDO_INFO))
		abort = EC_ABORT_ACCESS;
	else if (req.opcode == EC_SDOINFO_LIST_REQ)
		abort = info_list(app, req.index);
	else if (req.opcode == EC_SDOINFO_OBJECT_REQ)
		abort = info_object(app, req.index);
	else if (req.opcode == EC_SDOINFO_ENTRY_REQ)
		abort = info_entry(app, req.index, req.sub, req.info);
	if (!abort) {
		info_next(app, due);
		return;
	}
	ret = ec_sdoinfo_error_encode(m->out + EC_MBOX_HDR,
				      m->cap - (size_t)EC_MBOX_HDR, abort);
	if (ret > 0)
		out_set(app, EC_MBOX_COE, (size_t)ret, due);
}

/* what a wrong server would answer: @tx is a good SDO response */
static void sdo_bugs(const struct ec_app *app, u8 *tx)
{
	u8 cmd = tx[EC_COE_HDR];

	if (cmd == 0x80 && ec_app_bug(app, EC_SIM_BUG_SDO_ABORT))
		put_unaligned_le32(EC_ABORT_GENERAL, tx + EC_COE_HDR + 4);
	/* initiate upload, size given, not expedited */
	if ((cmd & 0xe3) == 0x41 && ec_app_bug(app, EC_SIM_BUG_SDO_SIZE))
		tx[EC_COE_HDR + 4]++;
	/* segments of both directions */
	if (cmd >> 5 < 2 && ec_app_bug(app, EC_SIM_BUG_SDO_TOGGLE))
		tx[EC_COE_HDR] ^= 0x10;
}

static void coe(struct ec_app *app, const u8 *rx, size_t len, u64 now, u64 due)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_coe_hdr h;
	int ret;

	if (ec_coe_hdr_decode(&r, &h)) {
		out_error(app, EC_MBOX_ERR_TOO_SHORT, due);
		return;
	}
	ec_app_run(app, now);	/* what an upload finds is of this moment */
	switch (h.service) {
	case EC_COE_SDO_REQ:
		ret = ec_sdo_srv_handle(&m->srv, rx, len, m->out + EC_MBOX_HDR,
					tx_size(app) - (size_t)EC_MBOX_HDR);
		if (ret > 0) {
			sdo_bugs(app, m->out + EC_MBOX_HDR);
			out_set(app, EC_MBOX_COE, (size_t)ret, due);
		} else if (ret < 0) {
			out_error(app, EC_MBOX_ERR_TOO_SHORT, due);
		}
		return;
	case EC_COE_SDO_INFO:
		info_request(app, rx, len, due);
		return;
	default:
		out_error(app, EC_MBOX_ERR_SERVICE, due);
	}
}

/* a protocol with a server in a file of its own */
typedef int server_fn(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap);

static void serve(struct ec_app *app, u8 type, server_fn *server, const u8 *rx, size_t len,
		  u64 due)
{
	int ret = server(app, rx, len, app->mbox.out + EC_MBOX_HDR,
			 tx_size(app) - (size_t)EC_MBOX_HDR);

	if (ret > 0)
		out_set(app, type, (size_t)ret, due);
	else if (ret == -EINVAL)
		out_error(app, EC_MBOX_ERR_SERVICE, due);
	else if (ret < 0)
		out_error(app, EC_MBOX_ERR_TOO_SHORT, due);
}

static bool speaks(const struct ec_app *app, u8 type)
{
	u16 p = app->model->dev.protocols;

	if (app->state == EC_AL_BOOT)
		p &= (u16)EC_SII_PROTO_FOE;
	switch (type) {
	case EC_MBOX_COE:
		return p & EC_SII_PROTO_COE;
	case EC_MBOX_EOE:
		return p & EC_SII_PROTO_EOE;
	case EC_MBOX_FOE:
		return p & EC_SII_PROTO_FOE;
	case EC_MBOX_SOE:
		return p & EC_SII_PROTO_SOE && app->soe.drives;
	case EC_MBOX_VOE:
		return p & EC_SII_PROTO_VOE && app->model->params.voe;
	default:
		return false;	/* listed in the EEPROM or not: not modelled */
	}
}

static void dispatch(struct ec_app *app, u16 size, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_rbuf r = ec_rbuf(m->rx, size);
	u64 due = now + app->response_ns;
	struct ec_mbox_hdr h;

	if (ec_mbox_hdr_decode(&r, &h)) {
		out_error(app, EC_MBOX_ERR_SIZE, due);
		return;
	}
	if (h.counter && h.counter == m->rx_counter && !app->model->params.no_repeat &&
	    !ec_app_bug(app, EC_SIM_BUG_MBOX_TWICE))
		return;		/* sent twice, taken once */
	m->rx_counter = h.counter;
	m->now = now;
	if (h.type != EC_MBOX_EOE || ec_eoe_type_decode(r.p, h.len) != EC_EOE_FRAGMENT)
		app->esc->own.mbox_ns += app->response_ns;
	if (h.channel)
		out_error(app, EC_MBOX_ERR_CHANNEL, due);
	else if (!speaks(app, h.type))
		out_error(app, EC_MBOX_ERR_PROTOCOL, due);
	else if (h.type == EC_MBOX_EOE)
		serve(app, EC_MBOX_EOE, ec_app_eoe, r.p, h.len, due);
	else if (h.type == EC_MBOX_FOE)
		serve(app, EC_MBOX_FOE, ec_app_foe, r.p, h.len, due);
	else if (h.type == EC_MBOX_SOE)
		serve(app, EC_MBOX_SOE, ec_app_soe, r.p, h.len, due);
	else if (h.type == EC_MBOX_VOE)
		serve(app, EC_MBOX_VOE, ec_app_voe, r.p, h.len, due);
	else
		coe(app, r.p, h.len, now, due);
}

/* the oldest emergency into the out buffer */
static void next_emergency(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_coe_emergency e = {
		.code = get_unaligned_le16(m->emcy[0]),
		.reg = m->emcy[0][2],
	};
	int len;

	memcpy(e.data, m->emcy[0] + 3, 5);
	memmove(m->emcy[0], m->emcy[1], sizeof(m->emcy) - sizeof(m->emcy[0]));
	m->n_emcy--;
	len = ec_coe_emergency_encode(m->out + EC_MBOX_HDR, m->cap - (size_t)EC_MBOX_HDR, &e);
	if (len > 0)
		out_set(app, EC_MBOX_COE, (size_t)len, now);
}

/* the oldest unrequested VoE message */
static void next_voe(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	int len = ec_app_voe_unasked(&m->voe[0], m->out + EC_MBOX_HDR,
				     tx_size(app) - (size_t)EC_MBOX_HDR);

	memmove(&m->voe[0], &m->voe[1], sizeof(m->voe) - sizeof(m->voe[0]));
	m->n_voe--;
	if (len > 0)
		out_set(app, EC_MBOX_VOE, (size_t)len, now);
}

/* the master's message, which lies in SM0 */
static bool next_request(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	const struct ec_sm *p = &app->esc->sm[0].page;
	u16 len = min(p->len, m->cap);

	m->rx_waits = false;
	if (ec_esc_pdi_read(app->esc, p->start, m->rx, len, now) < 0)
		return false;
	dispatch(app, len, now);
	return true;
}

/* a fragment of an Ethernet frame, in turn with requests that wait */
static bool next_fragment(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	bool turn = ec_app_eoe_turn(app, m->rx_waits);
	int len = turn ? ec_app_eoe_next(app, m->out + EC_MBOX_HDR,
					 tx_size(app) - (size_t)EC_MBOX_HDR, now) : 0;

	if (len > 0)
		out_set(app, EC_MBOX_EOE, (size_t)len, now);
	return len > 0;
}

/* an unrequested SoE message, or else the next fragment of an answer */
static void next_soe(struct ec_app *app, u64 now)
{
	u8 *tx = app->mbox.out + EC_MBOX_HDR;
	size_t cap = tx_size(app) - (size_t)EC_MBOX_HDR;
	int len = app->soe.n_unasked ? ec_app_soe_unasked(app, tx, cap) :
				       ec_app_soe_next(app, tx, cap);

	if (len > 0)
		out_set(app, EC_MBOX_SOE, (size_t)len, now);
}

/* moves what can be moved, until nothing does */
static void step(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_esc *esc = app->esc;

	for (;;) {
		if (m->rx_waits && ec_app_eoe_waits(app)) {
			if (!next_request(app, now))
				return;
			continue;
		}
		if (m->out_len && m->out_in_sm)
			return;
		if (m->out_len) {
			u16 len = esc->sm[1].page.len;

			if (now < m->out_due || !ec_esc_sm_writable(esc, 1))
				return;
			/* the last byte hands the buffer over */
			len = min(len, m->cap);
			/* the master may have made the mailbox smaller meanwhile */
			if (len >= m->out_len)
				memset(m->out + m->out_len, 0, (size_t)len - m->out_len);
			if (len < m->out_len || !ec_app_mbox_spoil(app, len)) {
				m->out_len = 0;
				continue;
			}
			m->out_in_sm = true;
			if (ec_esc_pdi_write(esc, esc->sm[1].page.start, m->out,
					     len, now) < 0)
				m->out_len = 0;
			return;
		}
		if (m->n_emcy) {
			next_emergency(app, now);
		} else if (m->n_voe) {
			next_voe(app, now);
		} else if (app->soe.n_unasked || app->soe.at) {
			next_soe(app, now);
		} else if (!m->info.done) {
			info_next(app, now);
		} else if (next_fragment(app, now)) {
			continue;
		} else if (m->rx_waits) {
			if (!next_request(app, now))
				return;
		} else if (esc->fault.mailbox == EC_SIM_MAILBOX_STALE) {
			out_set(app, EC_MBOX_COE, EC_SDOINFO_HDR + 2, now);
		} else {
			return;
		}
	}
}

static bool works(const struct ec_app *app)
{
	return app->mbox.cap && app->state != EC_AL_INIT;
}

/**
 * ec_app_mbox_written() - the master wrote the mailbox
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_written(struct ec_app *app, u64 now)
{
	if (!works(app))
		return;
	app->mbox.rx_waits = true;
	step(app, now);
}

/**
 * ec_app_mbox_read() - the master read the mailbox
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_read(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;

	if (!works(app))
		return;
	if (m->out_len && m->out_in_sm) {
		memcpy(m->last, m->out, m->out_len);
		m->last_len = m->out_len;
		m->out_in_sm = false;
		m->out_due = now;
		ec_app_mbox_sent(app);
	}
	step(app, now);
}

/**
 * ec_app_mbox_activate() - the activate byte of SM1 was written
 * @app: slave
 * @now: time, ns
 *
 * With the repeat request toggled, the message read last goes into the
 * mailbox again, before one that lies there unread.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_activate(struct ec_app *app, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;
	struct ec_esc *esc = app->esc;
	struct ec_sm *p = &esc->sm[1].page;
	u16 len = min(p->len, m->cap);
	bool request = p->activate & EC_SM_ACT_REPEAT;

	if (!works(app) || !(app->model->dev.flags & EC_SII_FLAG_MBOX_DLL) ||
	    ec_app_bug(app, EC_SIM_BUG_MBOX_REPEAT))
		return;
	if (request == m->toggle)
		return;
	m->toggle = request;
	if (m->last_len && len >= m->last_len) {
		if (m->out_in_sm) {
			/* taken back, it follows later */
			ec_esc_sm_pdi_disable(esc, 1, true);
			ec_esc_sm_pdi_disable(esc, 1, false);
			m->out_in_sm = false;
			m->out_due = now;
		}
		memset(m->last + m->last_len, 0, (size_t)len - m->last_len);
		ec_esc_pdi_write(esc, p->start, m->last, len, now);
	}
	p->pdi &= (u8)~EC_SM_PDI_REPEAT_ACK;
	if (request)
		p->pdi |= EC_SM_PDI_REPEAT_ACK;
	esc->mem[EC_REG_SM(1) + EC_SM_OFS_PDI] = p->pdi;
}

/**
 * ec_app_mbox_poll() - time has passed
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_poll(struct ec_app *app, u64 now)
{
	if (!works(app))
		return;
	/* while the application was mute no request was noted */
	if (ec_esc_sm_readable(app->esc, 0))
		app->mbox.rx_waits = true;
	step(app, now);
}

/**
 * ec_app_mbox_due() - when the mailbox wants to be polled
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns, EC_ESC_NEVER: not at all.
 */
u64 ec_app_mbox_due(const struct ec_app *app)
{
	const struct ec_app_mbox *m = &app->mbox;

	if (!works(app) || app->model->emulation || !m->out_len ||
	    m->out_in_sm || !ec_esc_sm_writable(app->esc, 1))
		return EC_ESC_NEVER;
	return m->out_due;
}

/**
 * ec_app_emergency() - send a CoE emergency
 * @app: slave
 * @code: error code
 * @reg: error register
 * @data: manufacturer's own
 * @now: time, ns
 *
 * Dropped when there is no CoE, or too many wait.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_emergency(struct ec_app *app, u16 code, u8 reg, const u8 data[5],
		      u64 now)
{
	struct ec_app_mbox *m = &app->mbox;

	ec_app_od_set(app, ec_app_od_entry(app->model, 0x1001, 0), reg);
	ec_app_diag_emergency(app, code, reg, now);
	if (!works(app) || m->n_emcy == EC_APP_EMCY ||
	    !(app->model->dev.protocols & EC_SII_PROTO_COE))
		return;
	put_unaligned_le16(code, m->emcy[m->n_emcy]);
	m->emcy[m->n_emcy][2] = reg;
	memcpy(m->emcy[m->n_emcy] + 3, data, 5);
	m->n_emcy++;
	step(app, now);
}

/**
 * ec_app_voe_send() - send an unrequested VoE message
 * @app: slave
 * @voe: what
 * @now: time, ns
 *
 * Dropped when there is no VoE, or too many wait.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_voe_send(struct ec_app *app, const struct ec_app_voe *voe, u64 now)
{
	struct ec_app_mbox *m = &app->mbox;

	if (!works(app) || m->n_voe == EC_APP_VOE || !speaks(app, EC_MBOX_VOE))
		return;
	m->voe[m->n_voe++] = *voe;
	step(app, now);
}
