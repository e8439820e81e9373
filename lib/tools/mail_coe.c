// SPDX-License-Identifier: LGPL-2.1-or-later
/* CoE messages in words: SDOs, object dictionary, emergencies. */
#include "../../master/wire/coe.h"
#include "../../master/wire/emergency.h"
#include "../../master/wire/sdo_msg.h"
#include "../../master/wire/sdoinfo.h"
#include "mail_text.h"

static void abort_code(struct ect_mail *m, u32 code)
{
	m->flags |= ECT_MAIL_FAILED;
	MAIL_RESULT(m, "abort code 0x%08x: %s", code, ec_coe_abort_text(code));
}

/* index and subindex of the first message of a transfer */
static void object(struct ect_mail *m, struct mail_in *in, u8 cmd)
{
	u16 index = ec_rbuf_le16(&in->r);
	u8 sub = ec_rbuf_u8(&in->r);

	MAIL_OBJECT(m, "0x%04x:%02x%s", index, sub, cmd & CMD_BIT4 ? " complete" : "");
}

/* data of a download request, or of an upload response */
static void first_data(struct ect_mail *m, struct mail_in *in, u8 cmd)
{
	size_t n = cmd & CMD_SIZE ? 4 - (cmd >> 2 & 3) : 4;

	if (!(cmd & CMD_EXPEDITED)) {
		u32 size = ec_rbuf_le32(&in->r);

		MAIL_RESULT(m, "%u byte(s)", size);
		return;
	}
	mail_bytes(m, ec_rbuf_take(&in->r, n), n);
}

static void segment_data(struct ect_mail *m, const struct mail_in *in, u8 cmd)
{
	size_t field = in->len < EC_SDO_SEG_HDR ? 0 : in->len - EC_SDO_SEG_HDR;

	MAIL_RESULT(m, "%zu byte(s)%s", ec_sdo_segment_len(cmd, field),
		    cmd & SEG_LAST ? ", last" : "");
}

static void sdo_request(struct ect_mail *m, struct mail_in *in, u8 cmd)
{
	static const char *const names[] = {
		[REQ_DOWN_SEG] = "SDO download segment request", [REQ_DOWN] = "SDO download request",
		[REQ_UP] = "SDO upload request", [REQ_UP_SEG] = "SDO upload segment request",
		[REQ_ABORT] = "SDO abort",
	};
	u8 what = cmd >> CMD_SHIFT;

	mail_name(m, names, ARRAY_SIZE(names), what);
	if (what == REQ_DOWN_SEG) {
		segment_data(m, in, cmd);
	} else if (what == REQ_DOWN || what == REQ_UP) {
		object(m, in, cmd);
		if (what == REQ_DOWN)
			first_data(m, in, cmd);
	} else if (what == REQ_ABORT) {
		object(m, in, 0);
		abort_code(m, ec_rbuf_le32(&in->r));
		return;
	}
	m->flags |= ECT_MAIL_REQUEST;
}

static void sdo_response(struct ect_mail *m, struct mail_in *in, u8 cmd)
{
	static const char *const names[] = {
		[RESP_UP_SEG] = "SDO upload segment response",
		[RESP_DOWN_SEG] = "SDO download segment response",
		[RESP_UP] = "SDO upload response", [RESP_DOWN] = "SDO download response",
		[REQ_ABORT] = "SDO abort",
	};
	u8 what = cmd >> CMD_SHIFT;

	mail_name(m, names, ARRAY_SIZE(names), what);
	m->flags |= ECT_MAIL_REPLY;
	if (what == RESP_UP_SEG) {
		segment_data(m, in, cmd);
	} else if (what == RESP_UP || what == RESP_DOWN) {
		object(m, in, cmd);
		if (what == RESP_UP)
			first_data(m, in, cmd);
	} else if (what == REQ_ABORT) {
		object(m, in, 0);
		abort_code(m, ec_rbuf_le32(&in->r));
	}
}

static void sdo(struct ect_mail *m, struct mail_in *in, u8 service)
{
	u8 cmd = ec_rbuf_u8(&in->r);

	/* an abort of the master is a request without answer */
	if (service == EC_COE_SDO_REQ)
		sdo_request(m, in, cmd);
	else
		sdo_response(m, in, cmd);
}

static void sdo_info(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[EC_SDOINFO_LIST_REQ] = "object list request",
		[EC_SDOINFO_LIST_RESP] = "object list response",
		[EC_SDOINFO_OBJECT_REQ] = "object description request",
		[EC_SDOINFO_OBJECT_RESP] = "object description response",
		[EC_SDOINFO_ENTRY_REQ] = "entry description request",
		[EC_SDOINFO_ENTRY_RESP] = "entry description response",
		[EC_SDOINFO_ERROR] = "SDO information error",
	};
	u8 opcode = ec_rbuf_u8(&in->r) & EC_SDOINFO_OPCODE_MASK;
	u16 left, value;

	ec_rbuf_u8(&in->r);
	left = ec_rbuf_le16(&in->r);
	mail_name(m, names, ARRAY_SIZE(names), opcode);
	m->flags |= m->flags & ECT_MAIL_TO_SLAVE ? ECT_MAIL_REQUEST : ECT_MAIL_REPLY;
	switch (opcode) {
	case EC_SDOINFO_LIST_REQ:
	case EC_SDOINFO_LIST_RESP:
		value = ec_rbuf_le16(&in->r);
		MAIL_OBJECT(m, "list %u", value);
		break;
	case EC_SDOINFO_OBJECT_REQ:
	case EC_SDOINFO_OBJECT_RESP:
		value = ec_rbuf_le16(&in->r);
		MAIL_OBJECT(m, "0x%04x", value);
		break;
	case EC_SDOINFO_ENTRY_REQ:
	case EC_SDOINFO_ENTRY_RESP:
		value = ec_rbuf_le16(&in->r);
		MAIL_OBJECT(m, "0x%04x:%02x", value, ec_rbuf_u8(&in->r));
		break;
	case EC_SDOINFO_ERROR:
		abort_code(m, ec_rbuf_le32(&in->r));
		return;
	}
	if (left)
		MAIL_RESULT(m, "%u fragment(s) follow", left);
}

static void coe_emergency(struct ect_mail *m, struct mail_in *in)
{
	u16 code = ec_rbuf_le16(&in->r);
	u8 reg = ec_rbuf_u8(&in->r);
	const u8 *data = ec_rbuf_take(&in->r, 5);

	MAIL_SERVICE(m, "emergency");
	MAIL_OBJECT(m, "0x%04x", code);
	if (code)
		m->flags |= ECT_MAIL_FAILED;
	MAIL_RESULT(m, "%s, error register 0x%02x, ", ec_emergency_text(code, 0), reg);
	mail_bytes(m, data, 5);
}

/* a message behind the mailbox header */
void mail_coe(struct ect_mail *m, struct mail_in *in)
{
	static const char *const names[] = {
		[EC_COE_TXPDO] = "TxPDO", [EC_COE_RXPDO] = "RxPDO",
		[EC_COE_TXPDO_REMOTE] = "TxPDO remote request",
		[EC_COE_RXPDO_REMOTE] = "RxPDO remote request",
	};
	struct ec_coe_hdr h;

	if (ec_coe_hdr_decode(&in->r, &h))
		return;
	switch (h.service) {
	case EC_COE_EMERGENCY:
		coe_emergency(m, in);
		break;
	case EC_COE_SDO_REQ:
	case EC_COE_SDO_RESP:
		sdo(m, in, h.service);
		break;
	case EC_COE_SDO_INFO:
		sdo_info(m, in);
		break;
	default:
		mail_name(m, names, ARRAY_SIZE(names), h.service);
		MAIL_OBJECT(m, "number %u", h.number);
	}
}
