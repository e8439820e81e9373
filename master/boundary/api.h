/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Applications in the kernel: include/ecrt.h as exported functions. They give
 * the same commands as a process does through ioctl(), so that there is one place
 * that checks and one that says why not; only the cycle has a way of its own, which
 * never sleeps.
 */
#ifndef EC_API_H
#define EC_API_H

#include <linux/list.h>
#include <linux/module.h>
#include <linux/workqueue.h>
#include "../include/ecrt.h"
#include "cdev.h"
#include "../config/config.h"
#include "../cycle/domain.h"
#include "ioctl.h"
#include "../master.h"
#include "../session/session.h"

struct task_struct;

/**
 * struct ec_api - the application in the kernel that may have reserved a master
 * @file: stands for the open file of a process
 * @reserved: it has reserved the master, and holds this module
 * @active: its session while that is active
 * @next: what the next send shall do; the cyclic caller's
 * @app_time: last one told, ns
 * @sent: domains sent since the last receive; the cyclic caller's
 * @received: domains received and not processed; likewise
 * @requests: list of struct ec_api_request
 * @work: what a cyclic call must leave to somebody who may sleep
 * @atomic: a call came where its device needs a thread
 * @told: the log says so
 * @reset: slaves that failed shall be tried again
 * @send_cb: sends between two cycles, or NULL; see ecrt_master_callbacks()
 * @receive_cb: receives there, or NULL
 * @cb_data: for both
 * @between: thread that calls them while active
 * @between_wq: wakes it
 */
struct ec_api {
	struct ec_file file;
	bool reserved;
	struct ec_session *active;
	struct ec_ioc_send next;
	u64 app_time;
	u64 sent;
	u64 received;
	struct list_head requests;
	struct work_struct work;
	bool atomic;
	bool told;
	bool reset;
	void (*send_cb)(void *cb_data);
	void (*receive_cb)(void *cb_data);
	void *cb_data;
	struct task_struct *between;
	wait_queue_head_t between_wq;
};

/* The handle of a slave configuration is the configuration. */
static inline struct ec_config *ec_api_config(const ec_slave_config_t *sc)
{
	return (struct ec_config *)sc;
}

static inline struct ec_master *ec_api_master(const ec_slave_config_t *sc)
{
	return ec_api_config(sc)->session->master;
}

/* api.c */
int ec_api_create(struct ec_master *m);
void ec_api_destroy(struct ec_master *m);
int ec_command(const struct ec_master *m, unsigned int cmd, void *arg);
void ec_api_begin(struct ec_master *m);
int ec_api_fail(struct ec_master *m, int err, const char *fmt, ...) __printf(3, 4);
int ec_api_fail_sc(const ec_slave_config_t *sc, int err, const char *fmt, ...) __printf(3, 4);

/* api_cycle.c */
void ec_api_work(struct work_struct *work);

/* api_between.c */
int ec_api_between_start(struct ec_master *m);
void ec_api_between_stop(struct ec_master *m);
bool ec_api_is_between(const struct ec_api *api);
void ec_api_left(struct ec_master *m);

/* api_request.c */
void ec_api_requests_place(struct ec_master *m);
void ec_api_requests_free(struct ec_master *m);

#endif
