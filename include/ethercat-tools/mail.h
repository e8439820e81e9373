/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: mailbox messages of the master and its slaves, as they pass. */
#ifndef ETHERCAT_TOOLS_MAIL_H
#define ETHERCAT_TOOLS_MAIL_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_MAIL_DATA		144

/* flags */
#define ECT_MAIL_TO_SLAVE	1U	/* else from the slave */
#define ECT_MAIL_UNSURE		2U	/* its frame was lost: the slave has the message, or not */
#define ECT_MAIL_MALFORMED	4U	/* its header, or what is behind it, is wrong */
#define ECT_MAIL_FAILED		8U	/* it reports that something has failed */
#define ECT_MAIL_REQUEST	16U	/* a message of the same protocol answers it */
#define ECT_MAIL_REPLY		32U	/* to the last request of its protocol, an error: of any */

struct ect_mail {
	uint32_t struct_size;
	uint32_t flags;		/* ECT_MAIL_* */
	uint64_t number;	/* since the module was loaded */
	uint64_t missed;	/* messages before it that this reader was too slow for */
	uint64_t time_ns;	/* since the start of the computer, CLOCK_MONOTONIC */
	uint64_t wall_ns;	/* since 1970 */
	uint32_t position;	/* ring position of the slave, ECT_NONE32: it is absent by now */
	uint32_t station;	/* its station address */
	uint32_t size;		/* bytes of the message with its mailbox header */
	uint32_t kept;		/* of these in @data */
	uint8_t data[ECT_MAIL_DATA];	/* its beginning, as on the bus */
	uint8_t type;		/* of the protocol */
	uint8_t counter;	/* of the mailbox, 0: the message has none */
	uint8_t reserved[6];
	char protocol[16];	/* CoE, FoE, ..., or a number */
	char service[64];	/* what the message does */
	char object[128];	/* with what: object, file, IDN; "": with nothing of that kind */
	char result[ECT_TEXT];	/* content in short, or what failed; "": nothing to report */
};

/**
 * ect_mail_begin() - begin to read mailbox messages
 * @h: master, not yet used for ect_events_begin(); each open handle is a reader of its own
 *
 * The messages from now on. The process needs CAP_NET_RAW, since messages may contain passwords.
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno; -EPERM without the capability.
 */
int ect_mail_begin(struct ect_handle *h);

/**
 * ect_mail_read() - the next messages
 * @h: master, after ect_mail_begin()
 * @list: result, elements are struct ect_mail
 *
 * Waits for a message if there is none; poll() on ect_fd() says when there is one.
 *
 * Context: The thread of the handle; a signal does not end the wait.
 * Return: 0 or a negative errno.
 */
int ect_mail_read(struct ect_handle *h, struct ect_list **list);

#ifdef __cplusplus
}
#endif

#endif
