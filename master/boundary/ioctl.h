/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Commands of an application or a tool. The table in ioctl.c says who may give one, what it
 * looks up and locks and which buffer it has; a handler does the rest. A process gives
 * commands by ioctl(), an application in the kernel by ec_command().
 */
#ifndef EC_IOCTL_H
#define EC_IOCTL_H

#include "cdev.h"

struct ec_config;
struct ec_domain;
struct ec_session;
struct ec_slave;

/**
 * struct ec_call - one command while it is carried out
 * @file: open file that gave it
 * @master: of @file
 * @arg: argument, struct ec_ioc_*, in kernel memory; its @data member is not for handlers
 * @data: buffer of the command, in kernel memory; NULL when it has none, no bytes, or too many
 * @size: bytes at @data
 * @session: what the table says: the session of @file, or the one that is shown
 * @config: slave configuration of @session
 * @domain: domain of @session
 * @slave: with a reference for the time of the command
 * @showing: in a show section
 */
struct ec_call {
	struct ec_file *file;
	struct ec_master *master;
	void *arg;
	void *data;
	u32 size;
	struct ec_session *session;
	struct ec_config *config;
	struct ec_domain *domain;
	struct ec_slave *slave;
	bool showing;
};

int ec_ioc(struct ec_file *f, unsigned int cmd, void *arg);
int ec_refuse(struct ec_call *call, int err, const char *fmt, ...) __printf(3, 4);
int ec_ioc_limit(struct ec_call *call, int ret);
int ec_ioc_get_slave(struct ec_call *call, u16 position);
int ec_ioc_lock_session(struct ec_call *call);
int ec_ioc_pause(struct ec_call *call);

/* ioctl_info.c: no bus traffic */
int ec_ioc_version(struct ec_call *call);
int ec_ioc_reason(struct ec_call *call);
int ec_ioc_master(struct ec_call *call);
int ec_ioc_slave(struct ec_call *call);
int ec_ioc_sm(struct ec_call *call);
int ec_ioc_pdo(struct ec_call *call);
int ec_ioc_pdo_entry(struct ec_call *call);
int ec_ioc_sii(struct ec_call *call);
int ec_ioc_cycle_stats(struct ec_call *call);
int ec_ioc_cycle_reset(struct ec_call *call);

/* ioctl_bus.c: traffic */
int ec_ioc_reg_read(struct ec_call *call);
int ec_ioc_reg_write(struct ec_call *call);
int ec_ioc_state(struct ec_call *call);
int ec_ioc_rescan(struct ec_call *call);
int ec_ioc_debug(struct ec_call *call);
int ec_ioc_reset(struct ec_call *call);
int ec_ioc_end_detached(struct ec_call *call);

/* ioctl_mbox.c: values in slaves, at once and while a slave is configured */
int ec_ioc_mbox_failed(struct ec_call *call, int ret, u16 position, const char *protocol,
		       const char *what);
int ec_ioc_sdo_upload(struct ec_call *call);
int ec_ioc_sdo_download(struct ec_call *call);
int ec_ioc_sc_sdo(struct ec_call *call);
int ec_ioc_soe_read(struct ec_call *call);
int ec_ioc_soe_write(struct ec_call *call);
int ec_ioc_sc_idn(struct ec_call *call);

/* ioctl_config.c: what an application has configured */
int ec_ioc_config(struct ec_call *call);
int ec_ioc_config_sm(struct ec_call *call);
int ec_ioc_config_pdo(struct ec_call *call);
int ec_ioc_config_entry(struct ec_call *call);
int ec_ioc_config_sdo(struct ec_call *call);
int ec_ioc_config_idn(struct ec_call *call);
int ec_ioc_config_flag(struct ec_call *call);
int ec_ioc_domain(struct ec_call *call);
int ec_ioc_domain_fmmu(struct ec_call *call);
int ec_ioc_domain_data(struct ec_call *call);

/* ioctl_app.c: the application that reserved the master */
int ec_ioc_reserve(struct ec_call *call);
int ec_ioc_release(struct ec_call *call);
int ec_ioc_create_domain(struct ec_call *call);
int ec_ioc_slave_config(struct ec_call *call);
int ec_ioc_sc_sync(struct ec_call *call);
int ec_ioc_sc_watchdog(struct ec_call *call);
int ec_ioc_sc_pdo(struct ec_call *call);
int ec_ioc_reg_entry(struct ec_call *call);
int ec_ioc_sc_dc(struct ec_call *call);
int ec_ioc_sc_flag(struct ec_call *call);
int ec_ioc_sc_timeout(struct ec_call *call);
int ec_ioc_activate(struct ec_call *call);
int ec_ioc_deactivate(struct ec_call *call);
int ec_ioc_domain_offset(struct ec_call *call);
int ec_ioc_interval(struct ec_call *call);
int ec_ioc_app_time(struct ec_call *call);
int ec_ioc_ref_clock(struct ec_call *call);
int ec_ioc_cycle(struct ec_call *call);
int ec_ioc_wait(struct ec_call *call);
int ec_ioc_division(struct ec_call *call);
int ec_ioc_copy(struct ec_call *call);
int ec_ioc_receive(struct ec_file *f);
int ec_ioc_send(struct ec_file *f, const struct ec_ioc_send *arg);

/* ioctl_layout.c: how process data are sent */
int ec_ioc_sc_overlap(struct ec_call *call);
int ec_ioc_domain_age(struct ec_call *call);
int ec_ioc_domain_options(struct ec_call *call);
int ec_ioc_late(struct ec_call *call);

/* ioctl_request.c: requests and emergencies */
int ec_ioc_sc_request(struct ec_call *call);
int ec_ioc_sc_emerg(struct ec_call *call);

/* ioctl_ip.c: IP parameters of slaves with EoE */
int ec_ioc_ip_set(struct ec_call *call);
int ec_ioc_ip_get(struct ec_call *call);
int ec_ioc_sc_ip(struct ec_call *call);
int ec_ioc_config_ip(struct ec_call *call);

/* ioctl_state.c: states of an application's slaves */
int ec_ioc_config_why(struct ec_call *call);
int ec_ioc_slaves_down(struct ec_call *call);

#endif
