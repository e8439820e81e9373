// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "mbox.h"

/**
 * ec_mbox_hdr_decode() - read a mailbox header
 * @r: cursor at the header, ends where the mailbox ends
 * @h: result; the cursor then stands on @h->len bytes of content
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when the header is not complete, -EBADMSG when its
 * length is larger than the rest of the mailbox.
 */
int ec_mbox_hdr_decode(struct ec_rbuf *r, struct ec_mbox_hdr *h)
{
	u8 b;

	h->len = ec_rbuf_le16(r);
	h->address = ec_rbuf_le16(r);
	b = ec_rbuf_u8(r);
	h->channel = b & 0x3F;
	h->prio = b >> 6;
	b = ec_rbuf_u8(r);
	h->type = b & 0x0F;
	h->counter = b >> 4 & 0x07;
	if (r->bad)
		return -EMSGSIZE;
	return h->len <= ec_rbuf_left(r) ? 0 : -EBADMSG;
}

/**
 * ec_mbox_hdr_encode() - write a mailbox header
 * @w: cursor
 * @h: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_hdr_encode(struct ec_wbuf *w, const struct ec_mbox_hdr *h)
{
	ec_wbuf_le16(w, h->len);
	ec_wbuf_le16(w, h->address);
	ec_wbuf_u8(w, (u8)((h->channel & 0x3F) | h->prio << 6));
	ec_wbuf_u8(w, (u8)((h->type & 0x0F) | (h->counter & 0x07) << 4));
}

/**
 * ec_mbox_next_counter() - counter of the next message
 * @counter: of the last one, 0 for none yet
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 1 to 7; 0 is skipped because it switches the check off.
 */
u8 ec_mbox_next_counter(u8 counter)
{
	return counter >= 7 ? 1 : counter + 1;
}

/**
 * ec_mbox_error_decode() - read an error reply
 * @r: cursor behind the mailbox header
 * @detail: result, enum ec_mbox_error
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short, -EBADMSG when it is no mailbox
 * command error.
 */
int ec_mbox_error_decode(struct ec_rbuf *r, u16 *detail)
{
	u16 type = ec_rbuf_le16(r);

	*detail = ec_rbuf_le16(r);
	if (r->bad)
		return -EMSGSIZE;
	return type == 1 ? 0 : -EBADMSG;
}

/*
 * Each code has an errno of its own, which no other cause in a transfer has, so that the errno
 * alone leads back to the text (ec_mbox_errno_detail()).
 */
static const struct {
	u16 detail;
	int err;
	const char *text;
} errors[] = {
	{ EC_MBOX_ERR_SYNTAX, -EBADE, "the mailbox header is wrong" },
	{ EC_MBOX_ERR_PROTOCOL, -EPFNOSUPPORT, "the mailbox protocol is not supported" },
	{ EC_MBOX_ERR_CHANNEL, -ECHRNG, "the channel in the mailbox header is wrong" },
	{ EC_MBOX_ERR_SERVICE, -EBADRQC, "the service of the mailbox protocol is not supported" },
	{ EC_MBOX_ERR_HEADER, -EBADR, "the header of the mailbox protocol is wrong" },
	{ EC_MBOX_ERR_TOO_SHORT, -ENODATA, "the mailbox message is too short" },
	{ EC_MBOX_ERR_NO_MEMORY, -EXFULL, "the slave has no memory left for the mailbox message" },
	{ EC_MBOX_ERR_SIZE, -EDOM, "the sizes in the mailbox message contradict each other" },
	{ EC_MBOX_ERR_IN_WORK, -EALREADY, "the slave still works on an earlier request" },
};

/**
 * ec_mbox_error_text() - meaning of an error reply
 * @detail: its detail word
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, never NULL.
 */
const char *ec_mbox_error_text(u16 detail)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(errors); i++)
		if (errors[i].detail == detail)
			return errors[i].text;
	return "unknown mailbox error";
}

/**
 * ec_mbox_error_errno() - error reply as errno
 * @detail: its detail word
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: -errno that stands for this code only; -ECOMM for an unknown code.
 */
int ec_mbox_error_errno(u16 detail)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(errors); i++)
		if (errors[i].detail == detail)
			return errors[i].err;
	return -ECOMM;
}

/**
 * ec_mbox_errno_detail() - the error reply behind an errno
 * @err: from ec_mbox_error_errno(), or anything else
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: detail word, 0 when @err stands for none or for an unknown one.
 */
u16 ec_mbox_errno_detail(int err)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(errors); i++)
		if (errors[i].err == err)
			return errors[i].detail;
	return 0;
}
