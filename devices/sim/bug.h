/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Deliberate errors of the model. Tests that stay green with one of them
 * would not notice that slaves behave otherwise than the model:
 * "make check-witness" demands that each is caught.
 */
#ifndef EC_SIM_BUG_H
#define EC_SIM_BUG_H

#include "../../master/wire/env.h"

enum ec_sim_bug {
	EC_SIM_BUG_NONE,
	EC_SIM_BUG_LRW_WKC,		/* write part of LRW counts 1 */
	EC_SIM_BUG_BRD_NO_OR,		/* BRD overwrites */
	EC_SIM_BUG_AP_NO_INC,		/* position not incremented */
	EC_SIM_BUG_SM_DIRECTION,	/* direction check skipped */
	EC_SIM_BUG_MBOX_FULL,		/* full mailbox takes another write */
	EC_SIM_BUG_MBOX_EMPTY,		/* read of an empty mailbox counts */
	EC_SIM_BUG_EEP_NEVER_BUSY,	/* data late but busy not shown */
	EC_SIM_BUG_EEP_ADDRESS,		/* always reads address 0 */
	EC_SIM_BUG_EEP_READ8,		/* 8-byte flag inverted */
	EC_SIM_BUG_FMMU_SHIFT,		/* bit position off by one */
	EC_SIM_BUG_FMMU_LENGTH,		/* one byte too short */
	EC_SIM_BUG_LWR_INPUTS,		/* LWR also writes read FMMUs */
	EC_SIM_BUG_WKC_PER_FMMU,	/* counts each FMMU */
	EC_SIM_BUG_NO_ALIAS,		/* alias never matches */
	EC_SIM_BUG_FRMW_WKC,		/* writers of FRMW and ARMW don't count */
	EC_SIM_BUG_LOOPS_INVERTED,	/* loop bits of DL status */
	EC_SIM_BUG_AL_NO_OR,		/* BRD of AL status keeps the last */
	EC_SIM_BUG_CIRCULATING,		/* circulating bit ignored */
	EC_SIM_BUG_NO_RECV_TIMES,	/* write to 0x0900 latches nothing */
	EC_SIM_BUG_EVENT_STUCK,		/* ECAT events never cleared */
	EC_SIM_BUG_DC_JUMP,		/* write to 0x0910 sets the time */
	EC_SIM_BUG_DIFF_TWOS,		/* 0x092C as two's complement */
	EC_SIM_BUG_BRW_WKC,		/* write part of BRW, FPRW, APRW counts 1 */
	EC_SIM_BUG_READ_ONLY,		/* the master can write any register */
	EC_SIM_BUG_IRQ_NO_MASK,		/* events show without their mask */
	EC_SIM_BUG_SM_ONE_BUFFER,	/* 3-buffer mode without buffers */
	EC_SIM_BUG_SM_STATUS,		/* full mailbox not shown in its page */
	EC_SIM_BUG_AL_OVERWRITE,	/* AL control written before it was read */
	EC_SIM_BUG_WD_DEAF,		/* watchdog starts again instead of expiring */
	EC_SIM_BUG_ERRORS_KEPT,		/* error counters cannot be cleared */
	EC_SIM_BUG_LOST_UNCOUNTED,	/* lost links not counted */
	EC_SIM_BUG_EEP_WRITE_LOST,	/* EEPROM write without effect */
	EC_SIM_BUG_EEP_ENABLE,		/* EEPROM write without its enable bit */
	EC_SIM_BUG_PORT_ORDER,		/* frames leave in the order 0, 1, 2, 3 */
	EC_SIM_BUG_CUT_OPEN,		/* port stays open when its link is lost */
	EC_SIM_BUG_NO_DELAY,		/* slaves forward without delay */
	EC_SIM_BUG_RECV_SAME,		/* all ports latch the time of port 0 */
	EC_SIM_BUG_OFFSET_SIGN,		/* system time offset is subtracted */
	EC_SIM_BUG_DC_DELAY,		/* transmission delay not used */
	EC_SIM_BUG_DC_DRIFT,		/* rate of the clock is not corrected */
	EC_SIM_BUG_SYNC_LATE,		/* first SYNC0 one cycle late */
	EC_SIM_BUG_AL_CODE,		/* AL status code stays 0 */
	EC_SIM_BUG_AL_SKIP,		/* every change of state is legal */
	EC_SIM_BUG_AL_NO_ACK,		/* errors need no acknowledge */
	EC_SIM_BUG_SM_UNCHECKED,	/* SAFEOP whatever the SyncManagers are */
	EC_SIM_BUG_WD_OUTPUTS,		/* outputs stay when the watchdog expires */
	EC_SIM_BUG_OUTPUTS_EARLY,	/* outputs act before OP */
	EC_SIM_BUG_PDO_FIXED,		/* process data stay as in the EEPROM */
	EC_SIM_BUG_MBOX_COUNTER,	/* counter of replies does not count */
	EC_SIM_BUG_MBOX_REPEAT,		/* repeat request ignored */
	EC_SIM_BUG_MBOX_TWICE,		/* request with the old counter taken again */
	EC_SIM_BUG_SDO_TOGGLE,		/* toggle bit of segments inverted */
	EC_SIM_BUG_SDO_SIZE,		/* announced size one too large */
	EC_SIM_BUG_SDO_ABORT,		/* all aborts are "general error" */
	EC_SIM_BUG_INFO_LIST,		/* object lists lack their last one */
	EC_SIM_BUG_PROTECT,		/* write protection does nothing */
	EC_SIM_BUG_PROTECT_OPEN,	/* once opened, it stays open */
	EC_SIM_BUG_WD_PDI,		/* PDI watchdog never expires */
	EC_SIM_BUG_EEP_PDI_LATE,	/* emulated EEPROM: data not waited for */
	EC_SIM_BUG_EEP_PDI_HIDDEN,	/* emulated EEPROM: 0x0502 bit 5 not set */
	EC_SIM_BUG_SYNC_NO_ACK,		/* SYNC not held until acknowledged */
	EC_SIM_BUG_UDP_CHECKSUM,	/* checksum kept in a frame that changed */
	EC_SIM_BUG_AUTO_CLOSE,		/* auto close opens with the link */
	EC_SIM_BUG_LOOPS_STAY,		/* temporary loop settings stay */
	EC_SIM_BUG_FORWARD,		/* 0x0100 bit 0 ignored: all frames pass */
	EC_SIM_BUG_DL_SILENT,		/* links and loops change without DL event */
	EC_SIM_BUGS
};

struct ec_sim;

bool ec_sim_has_bug(const struct ec_sim *sim, enum ec_sim_bug bug);
const char *ec_sim_bug_name(enum ec_sim_bug bug);

#endif
