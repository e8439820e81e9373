/* SPDX-License-Identifier: GPL-2.0-only */
/* Segments whose ports change while they run, and what the ports show. */
#ifndef SIM_CABLE_KUNIT_H
#define SIM_CABLE_KUNIT_H

#include "sim_app_kunit.h"
#include "../../devices/sim/esc_int.h"

#define DL_EVENT	EC_ECAT_EVENT_DL

static inline void command(struct kunit *test, struct bed *b, const char *text)
{
	struct ec_sim_error err;
	struct ec_sim_fault f;

	KUNIT_ASSERT_EQ_MSG(test, ec_sim_command(b->sim, &bed_ops, text, strlen(text), &f, &err),
			    0, "%s: %s", text, err.text);
	ec_sim_advance(b->sim, b->now);
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	ec_sim_advance(b->sim, b->now);
}

static inline int count(struct bed *b, int port)
{
	u8 v[2] = {};

	return bed_tx_port(b, port, EC_CMD_BRD, 0, 0, v, 2);
}

/* logical @first on, @len bytes; returns the working counter */
static inline int logical(struct bed *b, u8 cmd, u32 first, u8 *data, u16 len)
{
	return bed_tx(b, cmd, (u16)first, (u16)(first >> 16), data, len);
}

/* registers of a slave, reached or not */
static inline u32 dl(struct bed *b, u32 slave)
{
	return ec_esc_dl_status(ec_sim_slave(b->sim, slave));
}

/* one byte for each port */
static inline u32 lost(struct bed *b, u32 slave)
{
	return get_unaligned_le32(ec_sim_slave(b->sim, slave)->mem + EC_REG_ERR_LOST(0));
}

static inline void forget_dl_event(struct bed *b, u32 slave)
{
	ec_esc_event(ec_sim_slave(b->sim, slave), 0, DL_EVENT);
}

static inline bool dl_event(struct bed *b, u32 slave)
{
	return ec_sim_slave(b->sim, slave)->ecat_event & DL_EVENT;
}

#endif
