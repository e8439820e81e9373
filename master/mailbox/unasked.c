// SPDX-License-Identifier: GPL-2.0-only
/* Messages that a slave sends without a request: emergencies, notifications of drives, VoE. */
#include <linux/slab.h>
#include "../base/report.h"
#include "../wire/coe.h"
#include "../wire/emergency.h"
#include "../wire/soe.h"
#include "desk.h"
#include "emerg.h"
#include "late.h"
#include "unasked.h"

/* a message that waits for its reader */
struct kept {
	struct list_head list;
	u16 len;
	u8 data[];
};

static bool emergency(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_coe_emergency e;
	u32 profile = READ_ONCE(mb->profile);

	if (h->type != EC_MBOX_COE || ec_coe_emergency_decode(rx, h->len, &e))
		return false;
	ec_report_more(mb->base, EC_EVENT_EMERGENCY, *mb->position, NULL, e.code, e.reg,
		       get_unaligned_le32(e.data), e.data[4], profile);
	ec_emerg_push(mb, rx + EC_COE_HDR);
	return true;
}

/* A notification or an emergency of a drive; the event has its first eight bytes. */
static bool soe_unasked(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_rbuf r = ec_rbuf(rx, h->len);
	u8 data[8] = { 0 };
	struct ec_soe_hdr s;
	size_t n;

	if (h->type != EC_MBOX_SOE || !ec_soe_is_unasked(rx, h->len) || ec_soe_hdr_decode(&r, &s))
		return false;
	n = ec_rbuf_left(&r);
	memcpy(data, r.p, min(n, sizeof(data)));
	ec_report_more(mb->base, s.opcode == EC_SOE_EMERGENCY ? EC_EVENT_SOE_EMERGENCY :
		       EC_EVENT_SOE_NOTIFICATION, *mb->position, NULL, s.drive, s.idn, s.elements,
		       (u32)n, get_unaligned_le32(data), get_unaligned_le32(data + 4));
	return true;
}

static void unasked_flush(struct ec_mbox *mb, unsigned int left)
{
	lockdep_assert_held(&mb->desk.unasked_lock);
	while (mb->desk.n_kept > left) {
		struct kept *k = list_first_entry(&mb->desk.kept, struct kept, list);

		list_del(&k->list);
		mb->desk.n_kept--;
		kfree(k);
	}
}

/* Keep a VoE message for its reader; of too many the oldest are dropped. */
static void unasked_keep(struct ec_mbox *mb, const u8 *rx, u16 len)
{
	struct kept *k;

	if (!READ_ONCE(mb->desk.keep_voe))
		return;
	k = kmalloc(struct_size(k, data, len), GFP_KERNEL);
	if (!k)
		return;
	k->len = len;
	memcpy(k->data, rx, len);
	spin_lock(&mb->desk.unasked_lock);
	if (mb->desk.keep_voe && mb->desk.n_kept == EC_MBOX_KEPT)
		ec_mbox_warn(mb, "VoE buffer full, %u message(s) not read; the oldest is dropped\n",
			      EC_MBOX_KEPT);
	unasked_flush(mb, EC_MBOX_KEPT - 1);
	list_add_tail(&k->list, &mb->desk.kept);
	mb->desk.n_kept++;
	if (!mb->desk.keep_voe)
		unasked_flush(mb, 0);
	spin_unlock(&mb->desk.unasked_lock);
}

/**
 * ec_mbox_keep_voe() - keep or drop VoE messages
 * @mb: mailbox of the slave
 * @on: keep those that arrive while another caller uses the mailbox; false: drop
 *	them, and those that are kept
 *
 * Context: Process.
 */
void ec_mbox_keep_voe(struct ec_mbox *mb, bool on)
{
	spin_lock(&mb->desk.unasked_lock);
	WRITE_ONCE(mb->desk.keep_voe, on);
	if (!on)
		unasked_flush(mb, 0);
	spin_unlock(&mb->desk.unasked_lock);
}

/**
 * ec_mbox_take_kept() - take the oldest kept VoE message
 * @mb: mailbox of the slave
 * @rx: result: message behind the mailbox header
 *
 * Context: Process.
 * Return: its bytes; -ENOMSG: there is none.
 */
int ec_mbox_take_kept(struct ec_mbox *mb, u8 *rx)
{
	struct kept *k;
	int len;

	spin_lock(&mb->desk.unasked_lock);
	k = list_first_entry_or_null(&mb->desk.kept, struct kept, list);
	if (k) {
		list_del(&k->list);
		mb->desk.n_kept--;
	}
	spin_unlock(&mb->desk.unasked_lock);
	if (!k)
		return -ENOMSG;
	len = k->len;
	memcpy(rx, k->data, len);
	kfree(k);
	return len;
}

/**
 * ec_mbox_flush_kept() - drop the kept VoE messages
 * @mb: mailbox of the slave
 *
 * Context: Process.
 */
void ec_mbox_flush_kept(struct ec_mbox *mb)
{
	spin_lock(&mb->desk.unasked_lock);
	unasked_flush(mb, 0);
	spin_unlock(&mb->desk.unasked_lock);
}

/**
 * ec_mbox_error_reply() - the errno of a mailbox error reply, which is logged
 * @mb: mailbox of the slave
 * @rx: message behind the header
 * @len: bytes of it
 *
 * Context: Process.
 * Return: -errno.
 */
int ec_mbox_error_reply(struct ec_mbox *mb, const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	u16 detail;

	if (ec_mbox_error_decode(&r, &detail))
		return -EBADMSG;
	ec_mbox_warn(mb, "mailbox error reply 0x%04x (%s)\n", detail, ec_mbox_error_text(detail));
	return ec_mbox_error_errno(detail);
}

/* Pass a message to its protocol; a message that no protocol wants is a late reply. */
static void unasked_take(struct ec_mbox *mb)
{
	const u8 *rx = mb->box.rx + EC_MBOX_HDR;
	struct ec_mbox_hdr h;

	if (ec_box_message(&mb->box, &h))
		return;
	if (h.type == EC_MBOX_VOE)
		unasked_keep(mb, rx, h.len);
	else if (!emergency(mb, &h, rx) && !soe_unasked(mb, &h, rx))
		ec_mbox_took_late(mb, h.type);
}

/**
 * ec_mbox_unasked() - take what the slave has sent without a request
 * @work: of the mailbox
 *
 * Context: Process.
 */
void ec_mbox_unasked(struct work_struct *work)
{
	struct ec_mbox *mb = container_of(work, struct ec_mbox, desk.unasked);
	unsigned long flags;
	bool taken, unable;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	unable = mb->desk.unable;
	mb->desk.unable = false;
	taken = !mb->desk.handed_over || ec_desk_has_reader(mb);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	if (unable)
		ec_mbox_warn(mb, "does not repeat mailbox messages, although its EEPROM has that flag; what a lost frame loses is lost\n");
	/* the transport holds a message with @handed_over */
	if (!taken) {
		unasked_take(mb);
		/* a reader may have entered meanwhile */
		wake_up_all(&mb->stop->wake);
	}
	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (mb->desk.handed_over) {
		mb->desk.handed_over = false;
		ec_box_drop(&mb->box);
		ec_box_go(&mb->box);
	}
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}
