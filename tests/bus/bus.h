/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * A master and a simulated segment in virtual time: the code of the modules as
 * it is, joined by the virtual device "bus0". Time passes only while everybody
 * sleeps, so a wait of a second costs nothing and a run is always the same.
 */
#ifndef EC_BUS_H
#define EC_BUS_H

#include <linux/delay.h>
#include <linux/ktime.h>
#include "ec_kunit.h"
#include "devices/sim/describe.h"
#include "devices/sim/sim_link.h"
#include "devices/sim/sim_wire.h"
#include "master/boundary/cdev.h"
#include "master/boundary/master.h"
#include "master/monitor.h"
#include "master/session/reserve.h"
#include "master/session/session.h"

/**
 * struct bus - what a case works with
 * @test: the case
 * @m: master 0
 * @sim: segment
 * @link: virtual device in between; NULL: not offered yet
 * @slow: a slow device instead of @link, see slow.h
 * @app: open file of the application
 * @t0: when the device was offered (ktime, ns)
 * @crowd: works that keep all workers of slaves busy, or NULL
 */
struct bus {
	struct kunit *test;
	struct ec_master *m;
	struct ec_sim *sim;
	struct ec_sim_link *link;
	struct slow *slow;
	struct ec_file app;
	u64 t0;
	struct bus_crowd *crowd;
};

struct bus *bus_new(struct kunit *test, const char *text);
struct bus *bus_new_exchanged(struct kunit *test, const char *text);
struct bus *bus_new_line(struct kunit *test, const char *text);
void bus_plug(struct bus *b);
void bus_plug_second(struct bus *b);
struct bus *bus_up(struct kunit *test, const char *text, u32 slaves);
void bus_down(struct bus *b);
void bus_exit(struct kunit *test);

u64 bus_wait(struct bus *b, u32 slaves, u8 state, u32 limit_ms);
u64 bus_wait_al(struct bus *b, u32 position, u16 al_status, u32 limit_ms);
bool bus_settled(struct bus *b);
void bus_plug_scanned(struct bus *b, u32 slaves, u32 limit_ms);
void bus_idle(struct bus *b);
void bus_crowd(struct bus *b);
void bus_crowd_leaves(struct bus *b);

struct ec_slave *bus_slave(struct bus *b, u32 position);

/* Ring position of the neighbor at a port, EC_UAPI_NONE16: there is none. */
static inline u16 bus_next(const struct ec_slave *s, u32 port)
{
	return s->graph.at[port] ? s->graph.at[port]->position : EC_UAPI_NONE16;
}
struct ec_esc *bus_esc(struct bus *b, u32 index);
struct ec_app *bus_app(struct bus *b, const char *name);
u32 bus_log_lines(const char *words);
void bus_fault(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u32 arg,
	       u32 arg2);
void bus_fault_later(struct bus *b, enum ec_sim_fault_type type, int slave, int port,
		     u32 after_ns);
void bus_command(struct bus *b, const char *text);
void bus_expect_graph(struct bus *b, const char *after);
void bus_fill_eeprom(struct bus *b, u32 index, size_t bytes);
void bus_strip_names(struct bus *b, u32 index);
void bus_request(struct bus *b, u32 position, u8 state);

void bus_judge(struct kunit *test, u64 value, u64 goal, u64 limit, const char *text);

#include "access.h"

/* A figure of this run; bench scripts look for these lines. */
#define bus_figure(fmt, ...)	pr_info("# figure: " fmt "\n", ##__VA_ARGS__)

/* One that has a limit, a row of the table "make bench" prints. */
#define bus_row(value, limit, fmt, ...) \
	pr_info("# row: %llu %llu " fmt "\n", (u64)(value), (u64)(limit), ##__VA_ARGS__)

#endif
