/* SPDX-License-Identifier: GPL-2.0-only */
/* The table of commands, and how a command is executed by it. */
#ifndef EC_CALL_H
#define EC_CALL_H

#include "ioctl.h"

#define F_WRITE	1	/* needs a descriptor opened for writing */

/* bytes of an argument that must be zero */
struct ec_reserved {
	u16 offset;
	u16 size;
};

/* What ec_call_run() finds and locks before the handler of a command runs. */
enum ec_ioc_class {
	EC_CLASS_MASTER,	/* nothing */
	EC_CLASS_SLAVE,		/* a slave by its address */
	EC_CLASS_SHOW_SLAVE,	/* the same, in a show section */
	EC_CLASS_SESSION,	/* session of the file; with session lock */
	EC_CLASS_IDLE,		/* the same while it is not active */
	EC_CLASS_CONFIG,	/* the same, and a slave configuration */
	EC_CLASS_DOMAIN,	/* the same, and a domain */
	EC_CLASS_SHOW_CONFIG,	/* own or running session, in a show section: a configuration */
	EC_CLASS_SHOW_DOMAIN,	/* or a domain */
	EC_CLASS_SHOW,		/* or the session alone */
};

/* a buffer that an argument names: where its address and its bytes are, and how many at most */
struct ec_ioc_buffer {
	u16 address;
	u16 size;
	u32 most;
	bool in;
	bool out;
};

/** struct ec_ioctl - one command */
struct ec_ioctl {
	/** @cmd: number; its size is what this module knows */
	unsigned int cmd;
	/** @fn: handler */
	int (*fn)(struct ec_call *call);
	/** @flags: F_* */
	unsigned int flags;
	/** @known: flags of the argument that are known */
	u32 known;
	/**
	 * @min: size of the argument in the oldest interface, a shorter one is refused; 0: the full
	 * size
	 */
	unsigned int min;
	/** @class: what ec_call_run() finds and locks */
	enum ec_ioc_class class;
	/** @at: offset in the argument: address or index of that object */
	u16 at;
	/** @buffer: its @most is 0 without a buffer */
	struct ec_ioc_buffer buffer;
	/** @reserved: fields that must be zero; size 0 ends them */
	struct ec_reserved reserved[2];
};

void ec_call_forget_reason(struct ec_file *f);
int ec_call_run(struct ec_file *f, const struct ec_ioctl *op, void *arg, bool user);

#endif
