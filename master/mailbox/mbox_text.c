// SPDX-License-Identifier: GPL-2.0-only
/* Why a transfer through a mailbox failed, for refusals and reasons alike. */
#include <linux/err.h>
#include <linux/kernel.h>
#include "mailbox.h"
#include "../wire/mbox.h"

/**
 * ec_mbox_fail_text() - one line for a failed transfer
 * @ret: -errno of the transfer
 * @protocol: of the mailbox, "CoE" for example
 * @buf: room for the text
 * @size: of @buf
 *
 * Abort and error codes of the protocol are the caller's; a mailbox error reply has its text.
 *
 * Context: Any.
 * Return: @buf.
 */
const char *ec_mbox_fail_text(int ret, const char *protocol, char *buf, size_t size)
{
	u16 detail = ec_mbox_errno_detail(ret);

	if (detail) {
		scnprintf(buf, size, "mailbox error reply 0x%04x (%s)", detail,
			  ec_mbox_error_text(detail));
		return buf;
	}
	switch (ret) {
	case -ECOMM:
		scnprintf(buf, size, "mailbox error reply, unknown code; see the kernel log");
		break;
	case -EPROTONOSUPPORT:
		scnprintf(buf, size, "no %s mailbox", protocol);
		break;
	case -EAGAIN:
		scnprintf(buf, size,
			  "not in PREOP or above, so the mailbox is off; request PREOP first");
		break;
	case -ETIMEDOUT:
		scnprintf(buf, size, "no reply in time");
		break;
	case -EIO:
		scnprintf(buf, size, "no answer at the station address (working counter 0)");
		break;
	case -EBADMSG:
	case -EPROTO:
		scnprintf(buf, size, "invalid reply (length or content of the mailbox message)");
		break;
	case -EMSGSIZE:
		scnprintf(buf, size,
			  "the mailbox is too small for the message, or larger than a datagram");
		break;
	case -ECANCELED:
		scnprintf(buf, size, "disconnected during the transfer");
		break;
	case -EINTR:
		scnprintf(buf, size, "the transfer was interrupted by a signal");
		break;
	case -ENOMEM:
		scnprintf(buf, size, "no memory for the transfer");
		break;
	case -ENODEV:
	case -ENETDOWN:
		scnprintf(buf, size, "the main device is missing or has no link; check the cable");
		break;
	case -EBUSY:
		scnprintf(buf, size, "the main device has no free transmit buffer");
		break;
	default:
		scnprintf(buf, size, "transfer failed (%pe)", ERR_PTR(ret));
	}
	return buf;
}
