// SPDX-License-Identifier: GPL-2.0-only
/*
 * SoE server of a simulated slave: the same IDNs for each of its drives, with
 * all their elements, in fragments where a message is too small; procedure
 * commands, notifications, emergencies.
 */
#include "app.h"

#define HOMING		148	/* the command that takes time */
#define HOMING_NS	50000000
#define FAILS		0x80AB	/* the one that fails */
#define RESET		99	/* the one that ends an error */

/**
 * ec_app_soe_restart() - nothing is in progress: power-on, INIT to PREOP
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_restart(struct ec_app *app)
{
	app->soe.len = 0;
	app->soe.at = 0;
	app->soe.writing = false;
	app->soe.n_unasked = 0;
	app->soe.due = EC_ESC_NEVER;
	for (u8 d = 0; d < EC_SOE_DRIVES; d++)
		app->soe.home[d] = EC_ESC_NEVER;
}

/* Queue a message without a request; too many are dropped. */
static void unasked_add(struct ec_app *app, const struct ec_app_soe_message *m)
{
	if (app->soe.n_unasked < EC_APP_SOE_UNASKED)
		app->soe.unasked[app->soe.n_unasked++] = *m;
}

/**
 * ec_app_soe_due() - when a procedure command ends
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns, EC_ESC_NEVER: none runs.
 */
u64 ec_app_soe_due(const struct ec_app *app)
{
	return app->soe.due;
}

/**
 * ec_app_soe_poll() - time has passed: a command that has ended is notified
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_poll(struct ec_app *app, u64 now)
{
	app->soe.due = EC_ESC_NEVER;
	for (u8 d = 0; d < app->soe.drives; d++) {
		if (app->soe.home[d] == EC_ESC_NEVER)
			continue;
		if (now < app->soe.home[d]) {
			app->soe.due = min(app->soe.due, app->soe.home[d]);
			continue;
		}
		app->soe.home[d] = EC_ESC_NEVER;
		unasked_add(app, &(struct ec_app_soe_message){
			.hdr = { .opcode = EC_SOE_NOTIFICATION, .drive = d,
				 .elements = EC_SOE_STATE, .idn = HOMING },
			.size = 2, .data = { EC_SOE_COMMAND_SET | EC_SOE_COMMAND_ENABLE },
		});
	}
}

/**
 * ec_app_soe_error() - a drive has an error
 * @app: slave
 * @drive: of it; nothing happens where there is no such drive
 * @error: class 1 diagnostic, 0: it has none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_error(struct ec_app *app, u8 drive, u16 error)
{
	if (drive >= app->soe.drives)
		return;
	put_unaligned_le16(error, ec_app_idn_value(app, drive, ec_app_idn(EC_SOE_IDN_ERROR)));
	put_unaligned_le32(error ? EC_APP_SOE_NUMBER | error : 0,
			   ec_app_idn_value(app, drive, ec_app_idn(EC_SOE_IDN_ERROR_NUMBER)));
	ec_app_idn_set_text(app, drive, ec_app_idn(EC_SOE_IDN_ERROR_TEXT),
			    error ? "simulated error" : EC_APP_SOE_NO_ERROR);
}

static bool is_command(const struct ec_app_idn *i)
{
	return i->attribute & EC_SOE_ATTR_COMMAND;
}

/* data state of a command: what was written, and what has become of it */
static u16 command_state(const struct ec_app *app, u8 drive, const struct ec_app_idn *i)
{
	u16 state = get_unaligned_le16(ec_app_idn_value(app, drive, i)) & 3;

	if (state != (EC_SOE_COMMAND_SET | EC_SOE_COMMAND_ENABLE))
		return state ? EC_SOE_COMMAND_SET | EC_SOE_COMMAND_BUSY : 0;
	if (i->idn == FAILS)
		state |= EC_SOE_COMMAND_BUSY | EC_SOE_COMMAND_ERROR;
	if (i->idn == HOMING && app->soe.home[drive] != EC_ESC_NEVER)
		state |= EC_SOE_COMMAND_BUSY;
	return state;
}

static void command_begin(struct ec_app *app, u8 drive, const struct ec_app_idn *i)
{
	u16 value = get_unaligned_le16(ec_app_idn_value(app, drive, i));

	if (i->idn == RESET && value == (EC_SOE_COMMAND_SET | EC_SOE_COMMAND_ENABLE))
		ec_app_soe_error(app, drive, 0);
	if (i->idn != HOMING)
		return;
	app->soe.home[drive] = value == 3 ? app->mbox.now + HOMING_NS : EC_ESC_NEVER;
	ec_app_soe_poll(app, app->mbox.now);
}

/* the elements asked for, in ascending order; an error code, 0: none */
static u16 read_elements(const struct ec_app *app, const struct ec_soe_hdr *h,
			 const struct ec_app_idn *i, struct ec_wbuf *w)
{
	if (h->elements & EC_SOE_STATE && !is_command(i))
		return EC_SOE_ERR_NO_STATE;
	if (h->elements & EC_SOE_STATE)
		ec_wbuf_le16(w, command_state(app, h->drive, i));
	if (h->elements & EC_SOE_NAME)
		ec_app_idn_put_text(w, i->name);
	if (h->elements & EC_SOE_ATTRIBUTE)
		ec_wbuf_le32(w, i->attribute);
	if (h->elements & EC_SOE_UNIT)
		ec_app_idn_put_text(w, i->unit ? i->unit : "");
	if (h->elements & EC_SOE_MIN && !i->max)
		return EC_SOE_ERR_NO_MIN;
	if (h->elements & EC_SOE_MIN)
		ec_app_idn_put_number(w, i, i->min);
	if (h->elements & EC_SOE_MAX && !i->max)
		return EC_SOE_ERR_NO_MAX;
	if (h->elements & EC_SOE_MAX)
		ec_app_idn_put_number(w, i, i->max);
	if (h->elements & EC_SOE_VALUE)
		ec_app_idn_put_value(w, app, h->drive, i);
	if (h->elements & EC_SOE_DEFAULT && !i->max)
		return EC_SOE_ERR_NO_DEFAULT;
	if (h->elements & EC_SOE_DEFAULT)
		ec_app_idn_put_number(w, i, i->value);
	return 0;
}

static bool is_protected(const struct ec_app *app, const struct ec_app_idn *i)
{
	u32 bit = app->state == EC_AL_OP ? EC_SOE_ATTR_RO_OP :
		  app->state == EC_AL_SAFEOP ? EC_SOE_ATTR_RO_SAFEOP : EC_SOE_ATTR_RO_PREOP;

	return i->attribute & bit;
}

/* the length in a list must be what is there */
static u16 check_list(const struct ec_app_idn *i, const u8 *data, size_t len)
{
	if (len < EC_SOE_LIST_HDR || get_unaligned_le16(data) > len - EC_SOE_LIST_HDR)
		return EC_SOE_ERR_SHORT;
	if (get_unaligned_le16(data) < len - EC_SOE_LIST_HDR || len > ec_app_idn_room(i))
		return EC_SOE_ERR_LONG;
	return 0;
}

static u16 check_number(const struct ec_app_idn *i, const u8 *data, size_t len)
{
	u8 b[8] = { 0 };

	if (len != ec_app_idn_bytes(i))
		return len < ec_app_idn_bytes(i) ? EC_SOE_ERR_SHORT : EC_SOE_ERR_LONG;
	memcpy(b, data, len);
	if (!i->max)
		return 0;
	return get_unaligned_le64(b) < i->min ? EC_SOE_ERR_BELOW :
	       get_unaligned_le64(b) > i->max ? EC_SOE_ERR_ABOVE : 0;
}

static u16 write_value(struct ec_app *app, const struct ec_soe_hdr *h, const struct ec_app_idn *i,
		       const u8 *data, size_t len)
{
	u8 *p = ec_app_idn_value(app, h->drive, i);
	u16 error;

	switch (h->elements) {
	case EC_SOE_VALUE:
		break;
	case EC_SOE_NAME:
		return EC_SOE_ERR_NAME_RO;
	case EC_SOE_ATTRIBUTE:
		return EC_SOE_ERR_ATTRIBUTE_RO;
	case EC_SOE_UNIT:
		return EC_SOE_ERR_UNIT_RO;
	case EC_SOE_MIN:
		return EC_SOE_ERR_MIN_RO;
	case EC_SOE_MAX:
		return EC_SOE_ERR_MAX_RO;
	case EC_SOE_DEFAULT:
		return EC_SOE_ERR_DEFAULT_RO;
	default:
		return EC_SOE_ERR_GENERAL;
	}
	if ((i->attribute & EC_SOE_ATTR_RO) == EC_SOE_ATTR_RO)
		return EC_SOE_ERR_READ_ONLY;
	if (is_protected(app, i))
		return EC_SOE_ERR_PROTECTED;
	error = ec_app_idn_is_list(i) ? check_list(i, data, len) : check_number(i, data, len);
	if (error)
		return error;
	memcpy(p, data, len);
	if (ec_app_idn_is_list(i))
		put_unaligned_le16(i->room, p + 2);
	if (is_command(i))
		command_begin(app, h->drive, i);
	app->soe.writes++;
	return 0;
}

/* a whole request; the answer goes to the buffer */
static u16 execute(struct ec_app *app, const struct ec_soe_hdr *h, const u8 *data, size_t len)
{
	const struct ec_app_idn *i = ec_app_idn(h->idn);
	struct ec_wbuf w = ec_wbuf(app->soe.buf, EC_APP_SOE_BUF);
	u16 error;

	if (h->drive >= app->soe.drives)
		return EC_SOE_ERR_DRIVE;
	if (!i)
		return EC_SOE_ERR_NO_IDN;
	if (!h->elements)
		return EC_SOE_ERR_NO_ELEMENT;
	if (h->opcode == EC_SOE_WRITE_REQ)
		return write_value(app, h, i, data, len);
	error = read_elements(app, h, i, &w);
	app->soe.len = (u16)(w.p - app->soe.buf);
	return error ? error : w.bad ? EC_SOE_ERR_GENERAL : 0;
}

/*
 * Take one fragment of a write. 0: more follow; EC_MORE: it was the last one; -EIO: it does not
 * fit to the one before, with the code in @error.
 */
static int take_fragment(struct ec_app *app, const struct ec_soe_hdr *h, const u8 *data, size_t len,
			 u16 *error)
{
	struct ec_app_soe *s = &app->soe;
	u16 left = h->incomplete ? h->idn : 0;
	bool was = s->writing;

	*error = 0;
	s->writing = h->incomplete;
	if (!was)
		s->len = 0;
	if (h->drive >= s->drives)
		*error = EC_SOE_ERR_DRIVE;
	else if (was && (s->left != left + 1 || s->hdr.drive != h->drive ||
			 s->hdr.elements != h->elements))
		*error = EC_SOE_ERR_GENERAL;
	else if (len > EC_APP_SOE_BUF - (size_t)s->len)
		*error = EC_SOE_ERR_LONG;
	if (*error) {
		s->writing = false;
		s->len = 0;
		return -EIO;
	}
	s->hdr = *h;
	s->left = left;
	memcpy(s->buf + s->len, data, len);
	s->len = (u16)(s->len + len);
	return h->incomplete ? 0 : EC_MORE;
}

/**
 * ec_app_soe_next() - next fragment of an answer
 * @app: slave
 * @tx: room for it
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx; 0: there is none; -EMSGSIZE: no room.
 */
int ec_app_soe_next(struct ec_app *app, u8 *tx, size_t cap)
{
	struct ec_app_soe *s = &app->soe;
	size_t room = cap > EC_SOE_HDR ? cap - EC_SOE_HDR : 0, n = s->len - s->at;
	struct ec_soe_hdr h = s->hdr;
	struct ec_wbuf w = ec_wbuf(tx, cap);

	if (!n || !room) {
		s->len = 0;
		s->at = 0;
		return n ? -EMSGSIZE : 0;
	}
	h.incomplete = n > room;
	if (h.incomplete) {
		h.idn = (u16)((n - 1) / room);
		n = room;
	}
	ec_soe_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, s->buf + s->at, n);
	s->at = (u16)(s->at + n);
	if (s->at == s->len) {
		s->len = 0;
		s->at = 0;
	}
	return (int)(w.p - tx);
}

/**
 * ec_app_soe() - answer an SoE message
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @tx: room for the answer
 * @cap: bytes at @tx
 *
 * More fragments of an answer come from ec_app_soe_next().
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx, 0: the request is not complete; -EMSGSIZE: the message is too short, or
 * no room for an answer; -EINVAL: it is no request.
 */
int ec_app_soe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap)
{
	struct ec_app_soe *s = &app->soe;
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_wbuf w = ec_wbuf(tx, cap);
	struct ec_soe_hdr h;
	u16 error;
	int ret;

	if (ec_soe_hdr_decode(&r, &h) || cap < EC_SOE_HDR + 2)
		return -EMSGSIZE;
	if (h.opcode != EC_SOE_READ_REQ && h.opcode != EC_SOE_WRITE_REQ)
		return -EINVAL;
	if (h.opcode == EC_SOE_WRITE_REQ) {
		ret = take_fragment(app, &h, r.p, ec_rbuf_left(&r), &error);
		if (!ret)
			return 0;
		if (ret == EC_MORE)
			error = execute(app, &h, s->buf, s->len);
		s->len = 0;
	} else {
		s->writing = false;
		s->len = 0;
		error = h.incomplete ? EC_SOE_ERR_GENERAL : execute(app, &h, NULL, 0);
	}
	s->at = 0;
	h.opcode++;
	s->hdr = h;
	if (!error && s->len)
		return ec_app_soe_next(app, tx, cap);
	s->len = 0;
	h.error = error;
	h.incomplete = false;
	ec_soe_hdr_encode(&w, &h);
	if (error)
		ec_wbuf_le16(&w, error);
	return (int)(w.p - tx);
}

/**
 * ec_app_soe_unasked() - the oldest message without a request
 * @app: slave that has one
 * @tx: room for it
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx, -EMSGSIZE when it does not fit.
 */
int ec_app_soe_unasked(struct ec_app *app, u8 *tx, size_t cap)
{
	struct ec_app_soe *s = &app->soe;
	struct ec_app_soe_message m = s->unasked[0];
	struct ec_wbuf w = ec_wbuf(tx, cap);

	memmove(&s->unasked[0], &s->unasked[1], sizeof(s->unasked) - sizeof(s->unasked[0]));
	s->n_unasked--;
	ec_soe_hdr_encode(&w, &m.hdr);
	ec_wbuf_bytes(&w, m.data, m.size);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/**
 * ec_app_soe_send() - send a notification or an emergency
 * @app: slave
 * @m: message; dropped where there is no such drive
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_send(struct ec_app *app, const struct ec_app_soe_message *m, u64 now)
{
	if (m->hdr.drive >= app->soe.drives)
		return;
	unasked_add(app, m);
	ec_app_mbox_poll(app, now);
}
