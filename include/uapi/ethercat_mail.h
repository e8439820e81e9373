/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Mailbox messages of a master and its slaves, as they pass.
 *
 * EC_IOC_MAIL makes an open file a reader of messages, also one opened for reading only; the caller
 * needs CAP_NET_RAW, as for a capture of frames, since messages may contain passwords. From then on
 * read() returns whole records, poll() reports new ones. Each reader has a position of its own,
 * and takes nothing from others. The master keeps EC_MAILS_KEPT records while there is a reader:
 * the record behind a gap has the exact number of those that the reader was too slow for.
 */
#ifndef EC_UAPI_ETHERCAT_MAIL_H
#define EC_UAPI_ETHERCAT_MAIL_H

#include <linux/types.h>

#define EC_MAILS_KEPT		1023
#define EC_MAIL_DATA		144
#define EC_MAIL_ABSENT		0xffff	/* no slave has the station address any more */

/* @flags */
#define EC_MAIL_TO_SLAVE	1	/* else from the slave */
#define EC_MAIL_UNSURE		2	/* its frame was lost: the slave has the message, or not */
#define EC_MAIL_MALFORMED	4	/* its mailbox header is wrong */

struct ec_mail {
	__u32 flags;		/* EC_MAIL_* */
	__u16 station;		/* station address of the slave */
	__u16 position;		/* its ring position when the record is read, or EC_MAIL_ABSENT */
	__u64 number;		/* never reused */
	__u64 missed;		/* messages before this one that this reader has missed */
	__u64 time_ns;		/* CLOCK_MONOTONIC */
	__u64 wall_ns;		/* since 1970 */
	__u16 size;		/* bytes of the message with its mailbox header */
	__u16 kept;		/* of these in @data */
	__u32 reserved;
	__u8 data[EC_MAIL_DATA];	/* its beginning */
};

struct ec_ioc_mail {
	__u32 flags;		/* none */
	__u32 size;		/* in: bytes of struct ec_mail */
	__u64 next;		/* out: number of the message that comes next */
};

#endif
