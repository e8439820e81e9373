// SPDX-License-Identifier: GPL-2.0-only
/* Why a transfer through a mailbox failed, for refusals and reasons alike. */
#include <linux/err.h>
#include <linux/kernel.h>
#include "../wire/mbox.h"
#include "mbox_text.h"

static const struct {
	int err;
	const char *text;
} fail_texts[] = {
	{ -ECOMM, "mailbox error reply, unknown code; see the kernel log" },
	{ -EAGAIN, "not in PREOP or above, so the mailbox is off; request PREOP first" },
	{ -ETIMEDOUT, "no reply in time" },
	{ -ENOTRECOVERABLE, "outcome unknown: a frame was lost, and the slave does not repeat messages; read the value before it is written again" },
	{ -EIO, "no answer at the station address (working counter 0)" },
	{ -EBADMSG, "invalid reply (length or content of the mailbox message)" },
	{ -EPROTO, "invalid reply (length or content of the mailbox message)" },
	{ -EMSGSIZE, "the mailbox is too small for the message, or larger than a datagram" },
	{ -ECANCELED, "disconnected during the transfer" },
	{ -EINTR, "the transfer was interrupted by a signal" },
	{ -ENOMEM, "no memory for the transfer" },
	{ -ENODEV, "the main device is missing or has no link; check the cable" },
	{ -ENETDOWN, "the main device is missing or has no link; check the cable" },
	{ -EBUSY, "the main device has no free transmit buffer" },
};

/**
 * ec_mbox_fail_text() - one line for a failed transfer
 * @ret: -errno of the transfer
 * @protocol: of the mailbox, "CoE" for example
 * @buf: result
 * @size: of @buf
 *
 * The caller reports abort and error codes of the protocol; a mailbox error reply has its text.
 *
 * Context: Any.
 * Return: @buf.
 */
const char *ec_mbox_fail_text(int ret, const char *protocol, char *buf, size_t size)
{
	u16 detail = ec_mbox_errno_detail(ret);
	unsigned int i;

	if (detail) {
		scnprintf(buf, size, "mailbox error reply 0x%04x (%s)", detail,
			  ec_mbox_error_text(detail));
		return buf;
	}
	if (ret == -EPROTONOSUPPORT)
		scnprintf(buf, size, "no %s mailbox", protocol);
	else
		scnprintf(buf, size, "transfer failed (%pe)", ERR_PTR(ret));
	for (i = 0; i < ARRAY_SIZE(fail_texts); i++)
		if (fail_texts[i].err == ret)
			scnprintf(buf, size, "%s", fail_texts[i].text);
	return buf;
}
