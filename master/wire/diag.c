// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "diag.h"

/**
 * ec_diag_msg_decode() - read the head of a diagnosis message
 * @data: value of a message of 0x10F3
 * @len: bytes at @data
 * @m: result, for ec_diag_param_decode()
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOMSG for an empty message (no bytes or only zeros), -EMSGSIZE when it is too
 * short.
 */
int ec_diag_msg_decode(const u8 *data, size_t len, struct ec_diag_msg *m)
{
	size_t zeros = 0;

	while (zeros < len && !data[zeros])
		zeros++;
	*m = (struct ec_diag_msg){ .rest = ec_rbuf(data, len) };
	if (zeros == len)
		return -ENOMSG;
	m->code = ec_rbuf_le32(&m->rest);
	m->flags = ec_rbuf_le16(&m->rest);
	m->text_id = ec_rbuf_le16(&m->rest);
	m->time_ns = ec_rbuf_le32(&m->rest);
	m->time_ns |= (u64)ec_rbuf_le32(&m->rest) << 32;
	m->params = (u8)(m->flags >> 8);
	return m->rest.bad ? -EMSGSIZE : 0;
}

/* Bytes of a value of a basic data type (ETG.1000.6 table 64), 0: of none or of no fixed size. */
static size_t type_size(u16 type)
{
	switch (type) {
	case 0x0001: case 0x0002: case 0x0005:	/* BOOL, INT8, UINT8 */
	case 0x001E:				/* BYTE */
		return 1;
	case 0x0003: case 0x0006: case 0x001F:	/* INT16, UINT16, WORD */
		return 2;
	case 0x0010: case 0x0016:		/* INT24, UINT24 */
		return 3;
	case 0x0004: case 0x0007: case 0x0008:	/* INT32, UINT32, REAL32 */
	case 0x0020:				/* DWORD */
		return 4;
	case 0x0012: case 0x0018:		/* INT40, UINT40 */
		return 5;
	case 0x0013: case 0x0019:		/* INT48, UINT48 */
		return 6;
	case 0x0014: case 0x001A:		/* INT56, UINT56 */
		return 7;
	case 0x0011: case 0x0015: case 0x001B:	/* REAL64, INT64, UINT64 */
		return 8;
	default:
		return type >= 0x0030 && type <= 0x0037 ? 1 : 0;	/* BIT1 to BIT8 */
	}
}

/**
 * ec_diag_param_decode() - read the next parameter of a diagnosis message
 * @m: message
 * @p: result; its data are those of the message
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 1 with a parameter, 0 behind the last, -EBADMSG when it is cut off or its size is
 * unknown: so are all parameters behind it.
 */
int ec_diag_param_decode(struct ec_diag_msg *m, struct ec_diag_param *p)
{
	u16 flags;

	*p = (struct ec_diag_param){ 0 };
	if (!m->params)
		return 0;
	m->params--;
	flags = ec_rbuf_le16(&m->rest);
	p->kind = (u8)(flags >> 12);
	p->size = flags & 0x0FFF;
	switch (p->kind) {
	case EC_DIAG_VALUE:
		p->type = flags & 0x0FFF;
		p->size = type_size(p->type);
		break;
	case EC_DIAG_BYTES:
	case EC_DIAG_ASCII:
	case EC_DIAG_UNICODE:
		break;
	case EC_DIAG_TEXT_ID:
		p->size = 2;
		break;
	default:
		p->size = 0;
		break;
	}
	if (p->kind > EC_DIAG_TEXT_ID || (p->kind == EC_DIAG_VALUE && !p->size))
		m->rest.bad = true;
	else
		p->data = ec_rbuf_take(&m->rest, p->size);
	if (!m->rest.bad)
		return 1;
	m->params = 0;
	*p = (struct ec_diag_param){ 0 };
	return -EBADMSG;
}
