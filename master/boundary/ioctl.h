/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Commands of an application or a tool. ec_call_run() finds and locks the object that a row of
 * commands.h names and copies its buffer; the handler does the rest. A process executes commands
 * by ioctl(), an application in the kernel by ec_command().
 */
#ifndef EC_IOCTL_H
#define EC_IOCTL_H

#include "cdev.h"

struct ec_config;
struct ec_dg;
struct ec_domain;
struct ec_session;
struct ec_slave;
struct ec_startup;

/** struct ec_call - one command while it is carried out */
struct ec_call {
	/** @file: open file of the caller */
	struct ec_file *file;
	/** @master: of @file */
	struct ec_master *master;
	/**
	 * @arg: argument, struct ec_ioc_*, in kernel memory; its @data member is not for handlers
	 */
	void *arg;
	/**
	 * @data: buffer of the command, in kernel memory; NULL when it has none, no bytes, or too
	 * many
	 */
	void *data;
	/** @size: bytes at @data */
	u32 size;
	/** @session: what the table says: the session of @file, or the one that is shown */
	struct ec_session *session;
	/** @config: slave configuration of @session */
	struct ec_config *config;
	/** @domain: domain of @session */
	struct ec_domain *domain;
	/** @slave: with a reference for the time of the command */
	struct ec_slave *slave;
	/** @showing: in a show section */
	bool showing;
	/** @user: addresses in @arg are of the process */
	bool user;
};

int ec_ioc(struct ec_file *f, unsigned int cmd, void *arg);
int ec_refuse(struct ec_call *call, int err, const char *fmt, ...) __printf(3, 4);
int ec_ioc_limit(struct ec_call *call, int ret);
int ec_ioc_get_slave(struct ec_call *call, const struct ec_ioc_address *address);
int ec_ioc_lock_session(struct ec_call *call);
int ec_ioc_copy_out(struct ec_call *call, const void *from, u32 size);
int ec_ioc_wait_pdos(struct ec_call *call, struct ec_slave *slave);
int ec_ioc_pause(struct ec_call *call);
void ec_ioc_record(struct ec_call *call, const struct ec_startup *what);
int ec_ioc_refuse_reserved(struct ec_call *call);
const char *ec_ioc_runs_bus(u16 address, u32 bytes);
int ec_ioc_may_write(struct ec_call *call, const struct ec_dg *dg);

int ec_ioc_receive(struct ec_file *f);
int ec_ioc_send(struct ec_file *f, const struct ec_ioc_send *what);
void ec_ioctl_admit(struct ec_file *f, unsigned int which);
long ec_ioctl_send(struct ec_file *f, unsigned int cmd, unsigned long arg);
int ec_ioc_mbox_failed(struct ec_call *call, int ret, const char *protocol, const char *what);

#define CMD(cmd, handler, ...) int handler(struct ec_call *call);
#include "commands.h"
#undef CMD

#endif
