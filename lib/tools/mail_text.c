// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Mailbox messages in words. A slave may have sent anything: cursors with a sticky error read it,
 * and what is a text of the slave is made safe for a terminal.
 */
#include <stdarg.h>
#include <stdio.h>

#include "../../master/wire/eoe.h"
#include "../../master/wire/foe.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"
#include "mail_text.h"
#include "text.h"

void mail_add(char *to, size_t size, const char *fmt, ...)
{
	size_t at = strlen(to);
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(to + at, size - at, fmt, ap);
	va_end(ap);
}

/* the service by its number in a table, which may have gaps */
void mail_name(struct ect_mail *m, const char *const *names, size_t n, unsigned int number)
{
	if (number < n && names[number])
		MAIL_SERVICE(m, "%s", names[number]);
	else
		MAIL_SERVICE(m, "unknown service %u", number);
}

/* @p may be NULL: the message is too short */
void mail_bytes(struct ect_mail *m, const u8 *p, size_t n)
{
	MAIL_RESULT(m, "%zu byte(s)%s", n, p && n ? ":" : "");
	for (size_t i = 0; p && i < n; i++)
		MAIL_RESULT(m, " %02x", p[i]);
}

/* a text of the slave up to the end of the message */
static void mail_string(char *to, size_t size, struct ec_rbuf *r)
{
	size_t n = ec_rbuf_left(r);

	if (!r->bad)
		mail_add(to, size, " '%.*s'", (int)strnlen((const char *)r->p, n),
			 (const char *)r->p);
	string_clean(to, size);
}

static void mail_error(struct ect_mail *m, struct mail_in *in)
{
	u16 detail;

	MAIL_SERVICE(m, "reply");
	m->flags |= ECT_MAIL_FAILED | ECT_MAIL_REPLY;
	if (ec_mbox_error_decode(&in->r, &detail)) {
		m->flags |= ECT_MAIL_MALFORMED;
		return;
	}
	MAIL_RESULT(m, "0x%04x: %s", detail, ec_mbox_error_text(detail));
}

/* only the header; see the ADS over EtherCAT profile, ETG.1020 */
static void mail_aoe(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[1] = "read device information", [2] = "read", [3] = "write", [4] = "read state",
		[5] = "write control", [6] = "add notification", [7] = "delete notification",
		[8] = "notification", [9] = "read and write",
	};
	u16 target, source, command, state;
	u32 size, error, invoke;

	ec_rbuf_take(&in->r, 6);
	target = ec_rbuf_le16(&in->r);
	ec_rbuf_take(&in->r, 6);
	source = ec_rbuf_le16(&in->r);
	command = ec_rbuf_le16(&in->r);
	state = ec_rbuf_le16(&in->r);
	size = ec_rbuf_le32(&in->r);
	error = ec_rbuf_le32(&in->r);
	invoke = ec_rbuf_le32(&in->r);
	mail_name(m, names, ARRAY_SIZE(names), command);
	MAIL_SERVICE(m, "%s", state & 1 ? " response" : " request");
	m->flags |= state & 1 ? ECT_MAIL_REPLY : ECT_MAIL_REQUEST;
	MAIL_OBJECT(m, "port %u from port %u, invoke %u", target, source, invoke);
	MAIL_RESULT(m, "%u byte(s)", size);
	if (!error)
		return;
	m->flags |= ECT_MAIL_FAILED;
	MAIL_RESULT(m, ", error 0x%08x", error);
}

static void eoe_fragment(struct ect_mail *m, const struct mail_in *in, u16 head, u16 number)
{
	size_t size = in->len < EC_EOE_HDR ? 0 : in->len - EC_EOE_HDR;

	MAIL_OBJECT(m, "frame %u fragment %u", number >> 12, number & 0x3f);
	MAIL_RESULT(m, "%zu byte(s)%s", size, head & 0x0100 ? ", last" : "");
}

static void mail_eoe(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[EC_EOE_FRAGMENT] = "fragment", [EC_EOE_TIME_RESP] = "time stamp response",
		[EC_EOE_SET_IP_REQ] = "set IP parameters request",
		[EC_EOE_SET_IP_RESP] = "set IP parameters response",
		[EC_EOE_SET_FILTER_REQ] = "set filter request",
		[EC_EOE_SET_FILTER_RESP] = "set filter response",
		[EC_EOE_GET_IP_REQ] = "get IP parameters request",
		[EC_EOE_GET_IP_RESP] = "get IP parameters response",
	};
	u16 head = ec_rbuf_le16(&in->r), second = ec_rbuf_le16(&in->r);
	u8 type = head & 0xf;

	mail_name(m, names, ARRAY_SIZE(names), type);
	switch (type) {
	case EC_EOE_FRAGMENT:
		eoe_fragment(m, in, head, second);
		break;
	case EC_EOE_SET_IP_REQ:
	case EC_EOE_SET_FILTER_REQ:
	case EC_EOE_GET_IP_REQ:
		m->flags |= ECT_MAIL_REQUEST;
		break;
	case EC_EOE_SET_IP_RESP:
	case EC_EOE_SET_FILTER_RESP:
	case EC_EOE_GET_IP_RESP:
		m->flags |= ECT_MAIL_REPLY;
		if (!second)
			break;
		m->flags |= ECT_MAIL_FAILED;
		MAIL_RESULT(m, "0x%04x: %s", second, ec_eoe_result_text(second));
		break;
	}
}

static void foe_error(struct ect_mail *m, struct mail_in *in, u32 code)
{
	m->flags |= ECT_MAIL_FAILED;
	MAIL_RESULT(m, "0x%08x: %s", code, ec_foe_error_text(code));
	if (ec_rbuf_left(&in->r))
		mail_string(m->result, sizeof(m->result), &in->r);
}

static void mail_foe(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[EC_FOE_RRQ] = "read request", [EC_FOE_WRQ] = "write request", [EC_FOE_DATA] = "data",
		[EC_FOE_ACK] = "acknowledge", [EC_FOE_ERR] = "error", [EC_FOE_BUSY] = "busy",
	};
	struct ec_foe_hdr h;

	if (ec_foe_hdr_decode(&in->r, &h))
		return;
	mail_name(m, names, ARRAY_SIZE(names), h.opcode);
	m->flags |= m->flags & ECT_MAIL_TO_SLAVE ? ECT_MAIL_REQUEST : ECT_MAIL_REPLY;
	switch (h.opcode) {
	case EC_FOE_RRQ:
	case EC_FOE_WRQ:
		mail_string(m->object, sizeof(m->object), &in->r);
		memmove(m->object, m->object + 1, strlen(m->object));
		if (h.number)
			MAIL_RESULT(m, "with a password");
		break;
	case EC_FOE_DATA:
		MAIL_OBJECT(m, "packet %u", h.number);
		MAIL_RESULT(m, "%zu byte(s)", in->len < EC_FOE_HDR ? 0 : in->len - EC_FOE_HDR);
		break;
	case EC_FOE_ACK:
		MAIL_OBJECT(m, "packet %u", h.number);
		break;
	case EC_FOE_ERR:
		foe_error(m, in, h.number);
		break;
	case EC_FOE_BUSY:
		MAIL_RESULT(m, "%u of %u done", h.number & 0xffff, h.number >> 16);
		break;
	}
}

static void soe_elements(struct ect_mail *m, u8 elements)
{
	static const char *const names[] = {
		"state", "name", "attribute", "unit", "minimum", "maximum", "value", "default",
	};

	for (unsigned int i = 0; i < ARRAY_SIZE(names); i++)
		if (elements >> i & 1)
			MAIL_OBJECT(m, " %s", names[i]);
}

static void mail_soe(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[EC_SOE_READ_REQ] = "read request", [EC_SOE_READ_RESP] = "read response",
		[EC_SOE_WRITE_REQ] = "write request", [EC_SOE_WRITE_RESP] = "write response",
		[EC_SOE_NOTIFICATION] = "notification", [EC_SOE_EMERGENCY] = "emergency",
	};
	size_t size = in->len < EC_SOE_HDR ? 0 : in->len - EC_SOE_HDR;
	struct ec_soe_hdr h;

	if (ec_soe_hdr_decode(&in->r, &h))
		return;
	mail_name(m, names, ARRAY_SIZE(names), h.opcode);
	if (h.opcode == EC_SOE_READ_REQ || h.opcode == EC_SOE_WRITE_REQ)
		m->flags |= ECT_MAIL_REQUEST;
	else if (h.opcode == EC_SOE_READ_RESP || h.opcode == EC_SOE_WRITE_RESP)
		m->flags |= ECT_MAIL_REPLY;
	MAIL_OBJECT(m, "drive %u", h.drive);
	if (!h.incomplete)
		MAIL_OBJECT(m, " %c-%u-%04u", h.idn & 0x8000 ? 'P' : 'S', h.idn >> 12 & 7,
			    h.idn & 0xfff);
	soe_elements(m, h.elements);
	if (h.error) {
		u16 code = ec_rbuf_le16(&in->r);

		m->flags |= ECT_MAIL_FAILED;
		MAIL_RESULT(m, "0x%04x: %s", code, ec_soe_error_text(code));
	} else if (size) {
		MAIL_RESULT(m, "%zu byte(s)", size);
	}
	if (h.incomplete)
		MAIL_RESULT(m, ", %u fragment(s) follow", h.idn);
}

static void mail_voe(struct ect_mail *m, struct mail_in *in)
{
	struct ec_voe_hdr h;

	if (ec_voe_hdr_decode(&in->r, &h))
		return;
	MAIL_SERVICE(m, "message");
	MAIL_OBJECT(m, "vendor 0x%08x type 0x%04x", h.vendor, h.type);
	MAIL_RESULT(m, "%zu byte(s)", in->len - EC_VOE_HDR);
}

static const struct {
	const char *name;
	void (*decode)(struct ect_mail *m, struct mail_in *in);
} protocols[] = {
	[EC_MBOX_ERR] = { "error", mail_error }, [EC_MBOX_AOE] = { "AoE", mail_aoe },
	[EC_MBOX_EOE] = { "EoE", mail_eoe }, [EC_MBOX_COE] = { "CoE", mail_coe },
	[EC_MBOX_FOE] = { "FoE", mail_foe }, [EC_MBOX_SOE] = { "SoE", mail_soe },
	[EC_MBOX_VOE] = { "VoE", mail_voe },
};

/* The cursor is behind the header, and the header fits to the message. */
static void content(struct ect_mail *m, struct ec_rbuf r, size_t len)
{
	struct mail_in in = { .r = r, .len = len };

	if (m->type >= ARRAY_SIZE(protocols) || !protocols[m->type].decode) {
		snprintf(m->protocol, sizeof(m->protocol), "type 0x%x", m->type);
		MAIL_SERVICE(m, "message");
		MAIL_RESULT(m, "%zu byte(s)", len);
		return;
	}
	snprintf(m->protocol, sizeof(m->protocol), "%s", protocols[m->type].name);
	protocols[m->type].decode(m, &in);
	/* a cursor also ends where the copy of a longer message ends */
	if (!*m->service || (in.r.bad && m->kept == m->size)) {
		m->flags |= ECT_MAIL_MALFORMED;
		m->object[0] = 0;
		m->result[0] = 0;
		MAIL_SERVICE(m, "%smessage too short", *m->service ? ", " : "");
		MAIL_RESULT(m, "%zu byte(s)", len);
	}
}

void mail_decode(struct ect_mail *m)
{
	size_t kept = min_t(size_t, m->kept, sizeof(m->data));
	struct ec_rbuf r = ec_rbuf(m->data, kept);
	struct ec_mbox_hdr h;
	int ret = ec_mbox_hdr_decode(&r, &h);

	m->protocol[0] = 0;
	m->service[0] = 0;
	m->object[0] = 0;
	m->result[0] = 0;
	m->type = ret == -EMSGSIZE ? 0 : h.type;
	m->counter = ret == -EMSGSIZE ? 0 : h.counter;
	if (ret == -EMSGSIZE || m->flags & ECT_MAIL_MALFORMED ||
	    m->size < h.len + (size_t)EC_MBOX_HDR) {
		m->flags |= ECT_MAIL_MALFORMED;
		snprintf(m->protocol, sizeof(m->protocol), "none");
		MAIL_SERVICE(m, "malformed mailbox header");
		mail_bytes(m, m->data, min_t(size_t, kept, EC_MBOX_HDR));
		return;
	}
	/* behind the message is nothing, and of a long one only the beginning is here */
	r.end = r.p + min_t(size_t, ec_rbuf_left(&r), h.len);
	content(m, r, h.len);
}
