/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Commands of an application or a tool. A process calls them through the table in
 * ioctl.c, which says who may; an application in the kernel through api_*.c.
 */
#ifndef EC_IOCTL_H
#define EC_IOCTL_H

#include "cdev.h"

struct ec_slave;

struct ec_slave *ec_ioc_get_slave(struct ec_file *f, u16 position, int *ret);
int ec_ioc_limit(struct ec_file *f, int ret);
int ec_ioc_fetch(u64 from, u32 size, u8 **data);
int ec_ioc_hand_over(u64 to, void *data, u32 size, int ret);

/* ioctl_info.c: no bus traffic */
int ec_ioc_version(struct ec_file *f, void *arg);
int ec_ioc_reason(struct ec_file *f, void *arg);
int ec_ioc_master(struct ec_file *f, void *arg);
int ec_ioc_slave(struct ec_file *f, void *arg);
int ec_ioc_sm(struct ec_file *f, void *arg);
int ec_ioc_pdo(struct ec_file *f, void *arg);
int ec_ioc_pdo_entry(struct ec_file *f, void *arg);
int ec_ioc_sii(struct ec_file *f, void *arg);
int ec_ioc_cycle_stats(struct ec_file *f, void *arg);
int ec_ioc_cycle_reset(struct ec_file *f, void *arg);

/* ioctl_bus.c: traffic */
int ec_ioc_reg_read(struct ec_file *f, void *arg);
int ec_ioc_reg_write(struct ec_file *f, void *arg);
int ec_ioc_state(struct ec_file *f, void *arg);
int ec_ioc_rescan(struct ec_file *f, void *arg);
int ec_ioc_debug(struct ec_file *f, void *arg);
int ec_ioc_reset(struct ec_file *f, void *arg);
int ec_ioc_end_detached(struct ec_file *f, void *arg);

/* ioctl_mbox.c: values in slaves, at once and while a slave is configured */
int ec_ioc_mbox_failed(struct ec_file *f, int ret, u16 position, const char *protocol,
		       const char *what);
int ec_ioc_upload(struct ec_file *f, struct ec_ioc_sdo *i, u8 **data);
int ec_ioc_download(struct ec_file *f, void *arg, const u8 *data);
int ec_ioc_store_sdo(struct ec_file *f, void *arg, const u8 *data);
int ec_ioc_read_idn(struct ec_file *f, struct ec_ioc_soe *i, u8 **data);
int ec_ioc_write_idn(struct ec_file *f, void *arg, const u8 *data);
int ec_ioc_store_idn(struct ec_file *f, void *arg, const u8 *data);
int ec_ioc_sdo_upload(struct ec_file *f, void *arg);
int ec_ioc_sdo_download(struct ec_file *f, void *arg);
int ec_ioc_sc_sdo(struct ec_file *f, void *arg);
int ec_ioc_soe_read(struct ec_file *f, void *arg);
int ec_ioc_soe_write(struct ec_file *f, void *arg);
int ec_ioc_sc_idn(struct ec_file *f, void *arg);

/* ioctl_config.c: what an application has configured */
struct ec_config *ec_ioc_show_config(struct ec_file *f, u32 index, int *ret);
int ec_ioc_config(struct ec_file *f, void *arg);
int ec_ioc_config_sm(struct ec_file *f, void *arg);
int ec_ioc_config_pdo(struct ec_file *f, void *arg);
int ec_ioc_config_entry(struct ec_file *f, void *arg);
int ec_ioc_config_sdo(struct ec_file *f, void *arg);
int ec_ioc_config_idn(struct ec_file *f, void *arg);
int ec_ioc_config_flag(struct ec_file *f, void *arg);
int ec_ioc_domain(struct ec_file *f, void *arg);
int ec_ioc_domain_fmmu(struct ec_file *f, void *arg);
int ec_ioc_domain_data(struct ec_file *f, void *arg);

/* ioctl_app.c: the application that reserved the master */
int ec_ioc_reserve(struct ec_file *f, void *arg);
int ec_ioc_release(struct ec_file *f, void *arg);
int ec_ioc_create_domain(struct ec_file *f, void *arg);
int ec_ioc_slave_config(struct ec_file *f, void *arg);
int ec_ioc_sc_sync(struct ec_file *f, void *arg);
int ec_ioc_sc_watchdog(struct ec_file *f, void *arg);
int ec_ioc_sc_pdo(struct ec_file *f, void *arg);
int ec_ioc_reg_entry(struct ec_file *f, void *arg);
int ec_ioc_sc_dc(struct ec_file *f, void *arg);
int ec_ioc_sc_flag(struct ec_file *f, void *arg);
int ec_ioc_sc_timeout(struct ec_file *f, void *arg);
int ec_ioc_activate(struct ec_file *f, void *arg);
int ec_ioc_deactivate(struct ec_file *f, void *arg);
int ec_ioc_domain_offset(struct ec_file *f, void *arg);
int ec_ioc_interval(struct ec_file *f, void *arg);
int ec_ioc_app_time(struct ec_file *f, void *arg);
int ec_ioc_ref_clock(struct ec_file *f, void *arg);
int ec_ioc_cycle(struct ec_file *f, void *arg);
int ec_ioc_wait(struct ec_file *f, void *arg);
int ec_ioc_division(struct ec_file *f, void *arg);
int ec_ioc_copy(struct ec_file *f, void *arg);
int ec_ioc_receive(struct ec_file *f);
int ec_ioc_send(struct ec_file *f, const struct ec_ioc_send *arg);
struct ec_session *ec_ioc_lock_idle(struct ec_file *f, int *ret);
struct ec_config *ec_ioc_lock_config(struct ec_file *f, u32 index, int *ret);

/* ioctl_layout.c: how process data are sent */
int ec_ioc_sc_overlap(struct ec_file *f, void *arg);
int ec_ioc_domain_age(struct ec_file *f, void *arg);
int ec_ioc_domain_options(struct ec_file *f, void *arg);
int ec_ioc_late(struct ec_file *f, void *arg);

/* ioctl_request.c: requests and emergencies */
int ec_ioc_sc_request(struct ec_file *f, void *arg);
int ec_ioc_sc_emerg(struct ec_file *f, void *arg);

/* ioctl_ip.c: IP parameters of slaves with EoE */
int ec_ioc_ip_set(struct ec_file *f, void *arg);
int ec_ioc_ip_get(struct ec_file *f, void *arg);
int ec_ioc_sc_ip(struct ec_file *f, void *arg);
int ec_ioc_config_ip(struct ec_file *f, void *arg);

/* ioctl_state.c: states of an application's slaves */
int ec_ioc_config_why(struct ec_file *f, void *arg);
int ec_ioc_slaves_down(struct ec_file *f, void *arg);

#endif
