/* SPDX-License-Identifier: GPL-2.0-only */
/* Frames on their way through a segment, in the kernel's time. */
#ifndef EC_SIM_WIRE_H
#define EC_SIM_WIRE_H

#include <linux/hrtimer.h>
#include <linux/list.h>
#include <linux/spinlock.h>
#include "sim.h"

struct ec_app;
struct ec_sim_flying;

/**
 * struct ec_sim_wire - a segment with frames in it
 * @sim: segment
 * @start_ns: kernel time (ktime) when the segment's time is 0
 * @deliver: gets each Ethernet frame that comes back at a master port, in
 *	softirq or from ec_sim_wire_poll(); no lock is held
 * @lock: protects everything below and @sim
 * @timer: delivers unless @polled
 * @flying: frames that come back, by arrival
 * @under_way: frames of which it is not known yet
 * @free: unused frames
 * @frames: all of them
 * @wire_free_ns: when the last frame sent has left the master, by port
 * @polled: a caller polls, no timer is needed
 * @running: frames are taken
 */
struct ec_sim_wire {
	struct ec_sim *sim;
	u64 start_ns;
	void (*deliver)(struct ec_sim_wire *w, int port, const u8 *eth, size_t len);
	raw_spinlock_t lock;
	struct hrtimer timer;
	struct list_head flying;
	struct list_head under_way;
	struct list_head free;
	struct ec_sim_flying *frames;
	u64 wire_free_ns[EC_SIM_PORTS];
	bool polled;
	bool running;
};

extern const struct ec_sim_ops ec_sim_kernel_ops;

int ec_sim_wire_init(struct ec_sim_wire *w, struct ec_sim *sim, u64 start_ns,
		     void (*deliver)(struct ec_sim_wire *w, int port, const u8 *eth, size_t len));
void ec_sim_wire_exit(struct ec_sim_wire *w);
void ec_sim_wire_run(struct ec_sim_wire *w, bool on);
void ec_sim_wire_set_polled(struct ec_sim_wire *w, bool on);
void ec_sim_wire_poll(struct ec_sim_wire *w);
int ec_sim_wire_send(struct ec_sim_wire *w, int port, const u8 *eth, size_t len);
void ec_sim_wire_show(struct ec_sim_wire *w, u32 index, char *buf, size_t size);
int ec_sim_wire_fault(struct ec_sim_wire *w, const struct ec_sim_fault *f);
void ec_sim_wire_card(struct ec_sim_wire *w, int port, bool on);
bool ec_sim_wire_up(struct ec_sim_wire *w, int port);
bool ec_sim_wire_takes(struct ec_sim_wire *w, const struct ec_app *app);
bool ec_sim_wire_enter(struct ec_sim_wire *w, struct ec_app *app, const u8 *frame, u16 len);
u16 ec_sim_wire_leave(struct ec_sim_wire *w, struct ec_app *app, u8 *frame);

#endif
