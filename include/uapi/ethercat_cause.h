/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Causes of faults of slaves and configurations, for programs. */
#ifndef EC_UAPI_ETHERCAT_CAUSE_H
#define EC_UAPI_ETHERCAT_CAUSE_H

#include <linux/types.h>

/*
 * Why a slave is not in its requested state, struct ec_cause.kind: what a program can use of
 * the reason in words. Fields that a kind does not name are 0.
 */
#define EC_CAUSE_NONE		0	/* none, or only in words */
/* the slave of a configuration is absent */
#define EC_CAUSE_NO_DEVICE	1	/* the master has no network device */
#define EC_CAUSE_LINK_DOWN	2	/* at the main device */
#define EC_CAUSE_LOST		3	/* disconnected while active: behind @port of @position */
#define EC_CAUSE_NO_ALIAS	4	/* no slave has the alias */
#define EC_CAUSE_NO_SLAVE	5	/* the ring ends before @position */
#define EC_CAUSE_DIFFERENT	6	/* the slave at @position has another identity */
#define EC_CAUSE_TAKEN		7	/* the one at @position is that of configuration @code */
#define EC_CAUSE_UNATTACHED	8	/* the one at @position matches and is not attached yet */
#define EC_CAUSE_NO_GROUP	9	/* its hot connect group is not connected */
#define EC_CAUSE_GROUP		10	/* the slave at @position keeps its group from use */
#define EC_CAUSE_RING		11	/* the ring is open: which slave is at @position? */
/* it is connected, and the cause is not its own */
#define EC_CAUSE_INACTIVE	16	/* the application has not activated the master */
#define EC_CAUSE_REQUESTED	17	/* @state is requested, not OP */
#define EC_CAUSE_NO_CYCLE	18	/* the application sends no cyclic frames */
#define EC_CAUSE_UNDER_WAY	19	/* to OP; nothing has failed so far */
/* the slave itself */
#define EC_CAUSE_SILENT		32	/* no reply, frames pass */
#define EC_CAUSE_REGISTERS	33	/* no reply to a register, or address not accepted */
#define EC_CAUSE_EEPROM		34	/* not readable or invalid; @state: then refused */
#define EC_CAUSE_EEPROM_PART	35	/* large, still being read */
#define EC_CAUSE_SDO		36	/* startup SDO @object:@subindex, abort @code or 0 */
#define EC_CAUSE_IDN		37	/* startup IDN @object, drive @subindex, SoE error @code */
#define EC_CAUSE_REGISTER	38	/* startup register @object */
#define EC_CAUSE_IP		39	/* IP parameters, EoE result @code */
#define EC_CAUSE_PDO		40	/* process data of @sm; PDO or list @object, abort @code */
#define EC_CAUSE_LAYOUT		41	/* it cannot serve the layout of the process data */
#define EC_CAUSE_SYNC		42	/* SYNC signals */
#define EC_CAUSE_REFUSED	43	/* @state refused, AL status code @code */
#define EC_CAUSE_SLOW		44	/* @state not reached in time */
#define EC_CAUSE_FRAMES		45	/* frames lost before @state */
#define EC_CAUSE_AL_ERROR	46	/* @state with error, AL status code @code */
#define EC_CAUSE_MEMORY		47	/* this computer ran out of memory before @state */
#define EC_CAUSE_MAILBOX	48	/* a warning: sizes and protocols are inconsistent */
#define EC_CAUSE_ALIAS_TWICE	49	/* a warning: the slave at @position has the same alias */

struct ec_cause {
	__u32 kind;		/* EC_CAUSE_* */
	__u32 code;
	__u16 object;
	__u16 position;		/* ring position; EC_UAPI_NONE16: none, or lost as well */
	__u8 subindex;
	__u8 sm;
	__u8 state;		/* 1, 2, 3, 4, 8 */
	__u8 port;
};

#endif
