/* SPDX-License-Identifier: GPL-2.0-only */
/* What the files of the model share among themselves. */
#ifndef EC_SIM_ESC_INT_H
#define EC_SIM_ESC_INT_H

#include "sim.h"

#define EC_SIM_MAX_FAULTS	1024
#define EC_DC_FIRST		0x0900	/* registers of the clock */
#define EC_DC_SIZE		0x0100
#define EC_SIM_SCRATCH		2048	/* >= the longest datagram */
#define EC_SIM_LEN_CIRCULATING	0x40	/* in the high byte of the length word */
#define EC_SIM_HOST_FRAMES	16	/* on their way, or not fetched yet */
#define EC_SIM_HITS		16	/* logical datagrams of a cycle, power of two */

/* one passage of a frame through a processing unit */
struct ec_sim_step {
	struct ec_esc *esc;
	u32 pu_ns;			/* since the master sent the first bit */
	u32 recv_ns[EC_MAX_PORT];
	u8 recv_mask;
};

/**
 * struct ec_sim_route - way of a frame, computed when the topology changes
 * @step: processing units in order
 * @steps: how many
 * @delay_ns: from master port to master port without the frame's own length
 * @span_ns: until it comes out or is lost
 * @out_port: where it comes out, -1: lost
 * @circ: step whose port 0 is closed for want of a link, -1: none
 * @repeats: a slave is passed twice; no shortcuts
 * @opens: slave whose auto-closed port hears the frame, -1: none
 * @opens_port: that port
 */
struct ec_sim_route {
	struct ec_sim_step *step;
	u32 steps;
	u64 delay_ns;
	u64 span_ns;
	int out_port;
	int circ;
	bool repeats;
	int opens;
	u8 opens_port;
};

/* logical bytes that an FMMU maps; the key is the first of them and the slave */
struct ec_sim_span {
	u64 key;
	u32 last;
};

/**
 * struct ec_sim_hits - what a logical datagram concerns
 * @change: of the segment, for which it holds; 0: none
 * @first: first logical byte
 * @len: bytes
 * @steps: length of the way
 * @mport: master port at which the way begins
 * @n: steps concerned
 * @step: these, in order
 */
struct ec_sim_hits {
	u64 change;
	u32 first;
	u32 len;
	u32 steps;
	int mport;
	u32 n;
	u16 *step;
};

/* a frame of a host */
struct ec_sim_host_frame {
	struct ec_sim_flight fl;	/* first */
	enum { EC_SIM_HOST_FREE, EC_SIM_HOST_IN_FLIGHT, EC_SIM_HOST_ARRIVED } state;
	u8 eth[60];
};

struct ec_sim_pending_fault {
	struct ec_sim_fault f;
	u32 seen;			/* frames since it became active, or passes of its cable */
	int next;
};

struct ec_sim {
	struct ec_sim_ops ops;
	u64 seed;
	u64 rng;
	u64 now;
	u64 frames;			/* sent so far */
	u64 frame;			/* number of the one being processed */
	enum ec_sim_bug bug;
	bool slow;
	u32 max;
	u32 count;
	struct ec_esc **esc;
	struct ec_esc_port mport[EC_SIM_PORTS];
	bool mport_off[EC_SIM_PORTS];	/* the card there is off: no link */
	bool dirty;			/* routes to be recomputed */
	struct ec_sim_route route[EC_SIM_PORTS];
	u32 *heap;			/* slaves by time of their next event */
	u64 wd_next;			/* no process data watchdog expires earlier */
	u32 wd_slave;			/* whose it is, if it is that exactly */
	u32 irqs;			/* slaves with esc->irq */
	bool passing;			/* a frame is being processed */
	enum ec_sim_under_way under_way;
	struct ec_sim_flight *flights;	/* frames on their way, by the time of their next step */
	u64 port_events;		/* links lost and loops closed */
	u64 port_next;			/* no port changes by itself earlier */
	u64 disturbed;			/* frames on their way when a link changed */
	bool damages;			/* there is a cable that damages frames */
	struct ec_sim_host_frame host[EC_SIM_HOST_FRAMES];
	u32 host_arrived;		/* to be fetched */
	u32 hosts;			/* plugged in so far */
	int pend_head;
	int pend_tail;

	/* station addresses and aliases: node 2 * slave + (0 or 1) */
	u32 buckets;			/* power of two */
	s32 *bucket;
	s32 *node_next;
	s32 *node_prev;			/* -2: not hashed */
	u16 *node_addr;

	/* FMMUs that map something, sorted */
	struct ec_sim_span *span;
	u32 spans;
	u32 span_room;
	u32 span_want;			/* FMMUs of all slaves */
	u32 span_longest;		/* at least the length of any span */
	u32 *mark;			/* a bit for each step, 0 between look-ups */
	u64 change;			/* counts changes of spans and ways */
	struct ec_sim_hits hits[EC_SIM_HITS];
	u16 *hit_steps;
	u32 hit;			/* the last one used */

	struct ec_sim_pending_fault *fault;
	int fault_free;
	int fault_due;			/* sorted by time */
	int fault_frame;		/* active faults of frames */
	int fault_wait;			/* faults that wait for a frame */

	u8 scratch[EC_SIM_SCRATCH];	/* incoming data of read-write commands */
	u8 scratch2[EC_SIM_SCRATCH];	/* data on their way to be merged */
};

/* what each frame needs; ec_sim_fly() does the rest for those on their way */
static inline void ec_sim_flight_init(struct ec_sim_flight *fl, u8 *eth, u8 *frame, size_t len,
				      size_t eth_len)
{
	fl->done = false;
	fl->res = (struct ec_sim_result){ .out_port = -1 };
	fl->eth = eth;
	fl->ip = 0;
	fl->frame = frame;
	fl->len = len;
	fl->eth_len = eth_len;
	fl->lose_back = false;
	fl->extra_ns = 0;
	fl->faults = -1;
}

static inline bool ec_range_hit(u32 a, u32 len, u32 reg, u32 n)
{
	return a < reg + n && a + len > reg;
}

static inline bool ec_esc_bug(const struct ec_esc *esc, enum ec_sim_bug bug)
{
	return esc->sim->bug == bug;
}

static inline u16 ec_esc_get16(const struct ec_esc *esc, u16 reg)
{
	return get_unaligned_le16(esc->mem + reg);
}

/* a clock that can be set, not receive times alone */
static inline bool ec_esc_has_clock(const struct ec_esc *esc)
{
	return esc->cfg.features & EC_FEAT_DC && !esc->cfg.dc_delay_only;
}

/* time of the next thing a slave does by itself, but for its process data watchdog */
static inline u64 ec_esc_next(const struct ec_esc *esc)
{
	u64 t = min(esc->app_wake_ns, esc->wd_pdi_due);

	t = min(t, esc->loop_restore);
	t = min(t, esc->link_wake);
	return min(t, esc->dc.sync_wake);
}

/* a bit for each port whose loop is open */
static inline u8 ec_esc_open_ports(const struct ec_esc *esc)
{
	u8 v = 0;

	for (int p = 0; p < EC_MAX_PORT; p++)
		v |= (u8)(esc->port[p].open << p);
	return v;
}

static inline u32 ec_esc_loop_mode(const struct ec_esc *esc, int p)
{
	return esc->mem[EC_REG_DL_LOOPS] >> 2 * p & 3;
}

/* port @p closed itself, has a link again, and opens with the next frame it receives */
static inline bool ec_esc_port_waits(const struct ec_esc *esc, int p)
{
	return esc->port[p].auto_closed && esc->port[p].link &&
	       ec_esc_loop_mode(esc, p) == EC_LOOP_AUTO_CLOSE;
}

/* what the slave adds to the IRQ field of each datagram */
static inline u16 ec_esc_irq(const struct ec_esc *esc)
{
	return esc->ecat_event & (ec_esc_bug(esc, EC_SIM_BUG_IRQ_NO_MASK) ?
				  0xffff : ec_esc_get16(esc, EC_REG_ECAT_MASK));
}

/* esc.c */
bool ec_esc_config_valid(const struct ec_esc_config *c);
void ec_esc_power_on(struct ec_esc *esc, u64 now);
void ec_esc_event(struct ec_esc *esc, u16 set, u16 clear);
void ec_esc_refresh(struct ec_esc *esc, u16 ado, u32 len, u64 now);
u16 ec_esc_dl_status(const struct ec_esc *esc);
bool ec_esc_phys_read(struct ec_esc *esc, u16 ado, void *buf, size_t len,
		      const struct ec_frame_ctx *ctx);
bool ec_esc_phys_write(struct ec_esc *esc, u16 ado, const void *buf,
		       size_t len, const struct ec_frame_ctx *ctx);
bool ec_esc_addressed(const struct ec_esc *esc, const struct ec_dgram *d);
void ec_esc_run(struct ec_esc *esc, u64 now);
void ec_esc_deliver(struct ec_esc *esc);

/* esc_regs.c */
bool ec_esc_reg_exists(const struct ec_esc *esc, u32 ado, u32 len);
bool ec_esc_reg_plain(const struct ec_esc *esc, u32 a);
void ec_esc_regs_fixed(struct ec_esc *esc);

/* esc_protect.c */
bool ec_esc_ram_locked(const struct ec_esc *esc);
u32 ec_esc_protect(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len);

/* esc_sm.c */
void ec_esc_sm_reset(struct ec_esc *esc);
void ec_esc_sm_config(struct ec_esc *esc, u16 ado, size_t len,
		      const u8 *old_activate, const struct ec_frame_ctx *ctx);
int ec_esc_sm_find(const struct ec_esc *esc, u32 ado, size_t len);
void ec_esc_sm_refresh(struct ec_esc *esc);
u8 *ec_esc_sm_begin(struct ec_esc *esc, u32 ado, size_t len, bool pdi,
		    bool write, int *smp);
void ec_esc_sm_end(struct ec_esc *esc, int sm, u32 ado, size_t len, bool pdi,
		   const struct ec_frame_ctx *ctx);

/* esc_fmmu.c */
void ec_esc_fmmu_config(struct ec_esc *esc);
bool ec_esc_fmmu_hit(const struct ec_esc *esc, u32 logical, u16 len);
int ec_esc_fmmu_access(struct ec_esc *esc, struct ec_dgram *d,
		       const struct ec_frame_ctx *ctx);

/* esc_eeprom.c */
void ec_esc_eeprom_load(struct ec_esc *esc, bool power_on);
void ec_esc_eeprom_power_off(struct ec_esc *esc, u64 now);
void ec_esc_eeprom_refresh(struct ec_esc *esc, u64 now);
void ec_esc_eeprom_write(struct ec_esc *esc, u16 ado, const u8 *buf,
			 size_t len, const struct ec_frame_ctx *ctx);
bool ec_esc_eeprom_asks(const struct ec_esc *esc);
void ec_esc_eeprom_answer(struct ec_esc *esc, u8 control);

/* esc_quick.c; a logical datagram, which does not wrap at 4 GiB */
struct ec_quick {
	u8 *data;
	u32 first;
	u32 len;
	u8 cmd;
	u8 count;		/* of a write, in the working counter */
	u64 frame;		/* its number */
	u32 wire_ns;		/* from its first to its last bit */
};

void ec_esc_quick_update(struct ec_esc *esc);
bool ec_esc_quick_data(struct ec_esc *esc, const struct ec_quick *k, u64 now, u16 *wkc);

/* the registers, their protection or what is wrong with the slave changed */
static inline void ec_esc_quick_forget(struct ec_esc *esc)
{
	esc->quick.known = false;
}

/* esc_wd.c */
bool ec_esc_wd_ok(const struct ec_esc *esc);
u64 ec_esc_wd_ns(const struct ec_esc *esc);
void ec_esc_wd_trigger(struct ec_esc *esc, u64 now);

/* @ns: ec_esc_wd_ns() */
static inline void ec_esc_wd_start(struct ec_esc *esc, u64 now, u64 ns)
{
	esc->wd_due = ns ? now + ns : EC_ESC_NEVER;
	if (esc->wd_due < esc->sim->wd_next)
		esc->sim->wd_next = esc->wd_due;
}

void ec_esc_wd_config(struct ec_esc *esc, u64 now);
void ec_esc_wd_expire(struct ec_esc *esc, u64 now);
void ec_esc_wd_pdi_trigger(struct ec_esc *esc, u64 now);
void ec_esc_wd_pdi_expire(struct ec_esc *esc);

/* esc_dc.c */
void ec_esc_dc_reset(struct ec_esc *esc, u64 now);
void ec_esc_dc_refresh(struct ec_esc *esc, u64 now);
void ec_esc_dc_read(struct ec_esc *esc, u16 ado, size_t len, bool pdi);
void ec_esc_dc_time(struct ec_esc *esc, const u8 *buf, bool wide, u64 now);
void ec_esc_dc_write(struct ec_esc *esc, u16 ado, const u8 *buf, size_t len,
		     const struct ec_frame_ctx *ctx);
void ec_esc_dc_pdi_write(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len,
			 u64 now);
void ec_esc_dc_sync_ack(struct ec_esc *esc, u16 ado, u32 len, u64 now);
void ec_esc_dc_sync(struct ec_esc *esc, u64 now);
void ec_esc_dc_schedule(struct ec_esc *esc, u64 now);

/* esc_mii.c */
void ec_esc_mii_reset(struct ec_esc *esc);
void ec_esc_mii_refresh(struct ec_esc *esc);
void ec_esc_mii_write(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len);

/* segment.c */
u64 ec_sim_hash(u64 x);
void ec_sim_key(struct ec_esc *esc, u64 t);

/* a slave's next event may have come nearer */
static inline void ec_sim_touch(struct ec_esc *esc)
{
	u64 t = ec_esc_next(esc);

	if (t < esc->key)
		ec_sim_key(esc, t);
}

/* a port changes by itself at @t */
static inline void ec_sim_port_due(struct ec_sim *sim, u64 t)
{
	sim->port_next = min(sim->port_next, t);
}

void ec_sim_rehash(struct ec_esc *esc);

/* segment_route.c */
void ec_sim_routes(struct ec_sim *sim);
void ec_sim_ports(struct ec_esc *esc, u64 now);
void ec_sim_loops(struct ec_esc *esc, bool written, u64 now);
void ec_sim_power(struct ec_esc *esc, bool on, u64 now);

/* esc_old.c */
void ec_esc_old(struct ec_esc *esc, const struct ec_sim_fault *f, u64 now);

/* segment_cable.c */
void ec_sim_cut(struct ec_sim *sim, int slave, int port, bool cut, u64 now);
void ec_sim_plug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now);
void ec_sim_unplug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now);
void ec_sim_plug_host(struct ec_sim *sim, int slave, int port, u64 now);
void ec_sim_swap(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now);

/* segment_host.c */
bool ec_sim_host(struct ec_sim *sim, struct ec_sim_fault *f, u64 now);
void ec_sim_host_done(struct ec_sim *sim, struct ec_sim_flight *fl);

/* segment_spans.c */
int ec_sim_spans_room(struct ec_sim *sim, u32 n);
void ec_sim_span_add(const struct ec_esc *esc, const struct ec_fmmu *f);
void ec_sim_span_del(const struct ec_esc *esc, const struct ec_fmmu *f);
const struct ec_sim_hits *ec_sim_spans_hit(struct ec_sim *sim, int mport, u32 steps, u32 first,
					   u32 len);
int ec_sim_spans_init(struct ec_sim *sim);
void ec_sim_spans_exit(struct ec_sim *sim);

int ec_sim_next_port(const struct ec_sim *sim, int port);

/* segment_frame.c */
void ec_sim_start(struct ec_sim *sim, struct ec_sim_flight *fl, int port, u64 now_ns);
void ec_esc_pend(struct ec_esc *esc, u64 at_ns);
void ec_sim_deliver(struct ec_sim *sim);
bool ec_sim_datagrams(struct ec_frame_iter *it, u8 *frame, size_t len);

/* segment_eth.c */
void ec_sim_eth_mark(const struct ec_sim *sim, struct ec_sim_flight *fl);

/* segment_flight.c */
bool ec_sim_must_fly(struct ec_sim *sim, u64 until);
void ec_sim_fly(struct ec_sim *sim, struct ec_sim_flight *fl);
void ec_sim_fly_from_host(struct ec_sim *sim, struct ec_sim_flight *fl, int slave, int port);
void ec_sim_step(struct ec_sim *sim);
void ec_sim_arrive(struct ec_sim *sim, struct ec_sim_flight *fl, int out_port, u64 delay_ns);
void ec_sim_lose(struct ec_sim *sim, struct ec_sim_flight *fl);
void ec_sim_link_changed(struct ec_esc *esc, int port, u64 now);
void ec_sim_finish(struct ec_sim *sim, struct ec_sim_flight *fl);

/* fault.c */
int ec_sim_faults_init(struct ec_sim *sim);
u64 ec_sim_faults_next(const struct ec_sim *sim);
void ec_sim_faults_run(struct ec_sim *sim, u64 now);
void ec_sim_fault_queue(struct ec_sim *sim, int i);
void ec_sim_fault_free(struct ec_sim *sim, int i);

/* fault_frame.c */
bool ec_sim_fault_of_frame(enum ec_sim_fault_type type);
void ec_sim_fault_watch(struct ec_sim *sim, int i);
void ec_sim_faults_frame(struct ec_sim *sim, struct ec_sim_flight *fl, bool *lose_out);
void ec_sim_faults_mangle(struct ec_sim *sim, u8 *frame, size_t len);
void ec_sim_faults_wait(struct ec_sim *sim, struct ec_sim_flight *fl);
void ec_sim_faults_pass(struct ec_sim *sim, struct ec_sim_flight *fl, u64 t);
void ec_sim_faults_end(struct ec_sim *sim, struct ec_sim_flight *fl);

#endif
