// SPDX-License-Identifier: GPL-2.0-only
/*
 * The EEPROM says how to read the identification of a device: in a word of its memory, or by a
 * request in AL control (ETG.1020 clause 8). All new slaves are asked together.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../carry/xfer.h"
#include "identify.h"
#include "slave.h"

/*
 * One with identification 0 does not answer the request. A scan waits no longer for a slow one; its
 * request stands, and ec_slave_set_al() takes the reply.
 */
#define WAIT_NS		(50 * NSEC_PER_MSEC)
#define POLLS		10	/* at least */
#define POLL_US		500
#define REPLY		(EC_REG_AL_CODE + 2 - EC_REG_AL_STATUS)

/* a device that is asked */
struct asked {
	struct ec_slave *slave;
	bool by_al;		/* with AL control, else from its memory */
	bool replied;
	u8 control[2];
	u8 reply[REPLY];
};

struct identify {
	struct ec_links *links;
	struct asked *list;
	struct ec_dg *dg;
	unsigned int n;
};

static bool is_asked(const struct ec_slave *s)
{
	return READ_ONCE(s->identify) == EC_IDENTIFY_DUE && s->eeprom.data && s->has_general &&
	       !READ_ONCE(s->note.error) &&
	       s->general.flags & (EC_SII_FLAG_ID_AL | EC_SII_FLAG_ID_MEM);
}

/* In PREOP, as the request names the state, and a slave with an error does not answer it. */
static bool asks_by_al(const struct ec_slave *s)
{
	return s->general.flags & EC_SII_FLAG_ID_AL && READ_ONCE(s->al.status) == EC_AL_PREOP;
}

/* Registers are no memory: the read of some changes them. */
static bool has_word(const struct ec_slave *s)
{
	return s->general.flags & EC_SII_FLAG_ID_MEM && s->general.id_address >= EC_REG_DIGITAL_OUT;
}

static void identify_add(struct identify *id, struct ec_slave *s)
{
	struct asked *a = &id->list[id->n];

	a->by_al = asks_by_al(s);
	if (!a->by_al && !has_word(s))
		return;
	a->slave = s;
	WRITE_ONCE(s->identify, EC_IDENTIFY_DONE);
	id->n++;
}

/* AL control of those that have to be asked, or have replied; @bits: EC_AL_ID, or 0 to end it. */
static void identify_request(struct identify *id, u16 bits)
{
	unsigned int i, n = 0;

	for (i = 0; i < id->n; i++) {
		struct asked *a = &id->list[i];

		put_unaligned_le16(EC_AL_PREOP | bits, a->control);
		if (a->by_al && (bits || a->replied))
			id->dg[n++] = EC_FPWR(a->slave->station, EC_REG_AL_CONTROL, 2, a->control);
	}
	if (n)
		ec_xfer(id->links, id->dg, n);
}

static void identify_take(struct asked *a, const struct ec_dg *dg)
{
	u8 *value = a->by_al ? a->reply + EC_REG_AL_CODE - EC_REG_AL_STATUS : a->reply;

	a->replied = !dg->err && dg->wkc == 1 &&
		     (!a->by_al || get_unaligned_le16(a->reply) == (EC_AL_PREOP | EC_AL_ID));
	if (a->replied)
		WRITE_ONCE(a->slave->identification, get_unaligned_le16(value));
}

/* Read once from those that have not answered so far. Returns how many these are. */
static unsigned int read_replies(struct identify *id)
{
	unsigned int i, n = 0, left = 0;

	for (i = 0; i < id->n; i++) {
		struct asked *a = &id->list[i];

		if (a->replied)
			continue;
		id->dg[n++] = a->by_al ?
			EC_FPRD(a->slave->station, EC_REG_AL_STATUS, REPLY, a->reply) :
			EC_FPRD(a->slave->station, a->slave->general.id_address, 2, a->reply);
	}
	ec_xfer(id->links, id->dg, n);
	n = 0;
	for (i = 0; i < id->n; i++) {
		struct asked *a = &id->list[i];

		if (a->replied)
			continue;
		identify_take(a, &id->dg[n++]);
		left += a->by_al && !a->replied;
	}
	return left;
}

/**
 * ec_identify() - request the identification of a slave that the scan did not ask, or end that
 * @s: slave, @lock held
 *
 * Its reply is taken when its AL status is read next.
 *
 * Context: The slave's worker. Waits for bus traffic.
 */
void ec_identify(struct ec_slave *s)
{
	bool ends = READ_ONCE(s->identify) == EC_IDENTIFY_SEEN;
	u8 control[2];

	lockdep_assert_held(&s->lock);
	put_unaligned_le16(ends ? EC_AL_PREOP : EC_AL_PREOP | EC_AL_ID, control);
	if (!ends)
		WRITE_ONCE(s->identify, EC_IDENTIFY_STANDS);
	if (ec_xfer_fpwr(s->bus->links, s->station, EC_REG_AL_CONTROL, control, 2))
		WRITE_ONCE(s->identify, ends ? EC_IDENTIFY_SEEN : EC_IDENTIFY_CUT);
	else if (ends)
		WRITE_ONCE(s->identify, EC_IDENTIFY_DONE);
}

/**
 * ec_identify_is_due() - is a request to be made or to be ended?
 * @s: slave
 *
 * Context: Any.
 * Return: whether it is, in its present state.
 */
bool ec_identify_is_due(const struct ec_slave *s)
{
	u8 is = READ_ONCE(s->identify);

	return is != EC_IDENTIFY_DONE && is != EC_IDENTIFY_STANDS &&
	       (is != EC_IDENTIFY_DUE || is_asked(s)) && !READ_ONCE(s->note.error) &&
	       READ_ONCE(s->al.requested) == EC_AL_PREOP && asks_by_al(s);
}

/**
 * ec_identify_all() - read the explicit device identification of new slaves
 * @bus: bus
 * @slaves: slaves, whose AL control no other thread writes
 * @n: how many
 *
 * Of those whose EEPROM says that they have one: general category, flags bit 3 (AL control,
 * registers 0x0120 and 0x0134) or bit 4 (a word of their memory).
 *
 * Context: The monitor thread. Waits for bus traffic, and at most 50 ms or 10 polls for replies.
 */
void ec_identify_all(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n)
{
	struct identify id = { .links = bus->links };
	unsigned int i, asked = 0;
	u64 until;

	for (i = 0; i < n; i++)
		asked += is_asked(slaves[i]);
	if (!asked)
		return;
	id.list = kvcalloc(asked, sizeof(*id.list), GFP_KERNEL);
	id.dg = kvcalloc(asked, sizeof(*id.dg), GFP_KERNEL);
	if (id.list && id.dg) {
		for (i = 0; i < n; i++)
			if (is_asked(slaves[i]))
				identify_add(&id, slaves[i]);
		identify_request(&id, EC_AL_ID);
		until = ktime_get_ns() + WAIT_NS;
		for (i = 0; id.n && read_replies(&id) &&
		     (i < POLLS || ktime_get_ns() < until) && !READ_ONCE(bus->base->stopping); i++)
			usleep_range(POLL_US, 2 * POLL_US);
		identify_request(&id, 0);
		for (i = 0; i < id.n; i++)
			if (id.list[i].by_al && !id.list[i].replied)
				WRITE_ONCE(id.list[i].slave->identify, EC_IDENTIFY_STANDS);
	}
	kvfree(id.list);
	kvfree(id.dg);
}
