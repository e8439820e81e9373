/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The way of the tests into the master of a bus: one function for each thing. A case names what
 * it looks at, and only this file where it is. bus.h includes it.
 */
#ifndef EC_BUS_ACCESS_H
#define EC_BUS_ACCESS_H

#include <linux/sched.h>
#include "master/boundary/api.h"
#include "master/boundary/master.h"
#include "master/bus/slave.h"

/* layers */

static inline struct ec_base *bus_base(const struct bus *b)
{
	return b->m->base;
}

/* the slaves and the scans that find them */
static inline struct ec_bus *bus_table(const struct bus *b)
{
	return &b->m->bus;
}

static inline struct ec_dc *bus_dc(const struct bus *b)
{
	return &b->m->dc;
}

static inline struct ec_cycles *bus_cycles(const struct bus *b)
{
	return &b->m->cycles;
}

static inline struct ec_record_readers *bus_record_readers(const struct bus *b)
{
	return &b->m->record_readers;
}

static inline struct ec_sessions *bus_sessions(const struct bus *b)
{
	return &b->m->sessions;
}

static inline struct ec_api *bus_api(const struct bus *b)
{
	return b->m->api;
}

static inline struct ec_show *bus_show(const struct bus *b)
{
	return &bus_base(b)->show;
}

static inline struct ec_event_ring *bus_events(const struct bus *b)
{
	return &bus_base(b)->events.ring;
}

static inline struct ec_slave_devices *bus_slave_devices(const struct bus *b)
{
	return &b->m->slave_devices;
}

/* the network devices of slaves with EoE */
static inline struct ec_eoe *bus_eoe(const struct bus *b)
{
	return &b->m->eoe;
}

/* open files that read events */
static inline u32 bus_readers(const struct bus *b)
{
	return READ_ONCE(b->m->readers.readers.count);
}

/* how often the monitor has gone to sleep */
static inline unsigned long bus_monitor_slept(const struct bus *b)
{
	return READ_ONCE(b->m->monitor->nvcsw);
}

/* sessions: what an application has configured */

static inline struct mutex *bus_mutex(const struct bus *b)
{
	return &bus_sessions(b)->lock;
}

static inline void bus_lock(const struct bus *b)
{
	ec_sessions_lock(bus_sessions(b));
}

static inline void bus_unlock(const struct bus *b)
{
	ec_sessions_unlock(bus_sessions(b));
}

/* NULL: the master is free */
static inline struct ec_session *bus_session(const struct bus *b)
{
	return bus_sessions(b)->session;
}

/* what would take over the session, or NULL */
static inline struct ec_session *bus_candidate(const struct bus *b)
{
	return bus_sessions(b)->candidate;
}

/* the application releases the master */
static inline void bus_end(struct bus *b)
{
	ec_session_end(bus_sessions(b), &b->app);
}

static inline struct ec_wanted *bus_wanted(const struct bus *b)
{
	return &bus_session(b)->wanted;
}

static inline struct ec_config *bus_config(const struct bus *b, u32 i)
{
	return bus_wanted(b)->configs[i];
}

static inline struct ec_config *bus_candidate_config(const struct bus *b, u32 i)
{
	return bus_candidate(b)->wanted.configs[i];
}

static inline struct ec_domain *bus_domain(const struct bus *b, u32 i)
{
	return bus_wanted(b)->domains[i];
}

/* bytes of all sessions and of what is mapped */
static inline long bus_memory(const struct bus *b)
{
	return atomic_long_read(&bus_sessions(b)->memory);
}

static inline void bus_add_memory(const struct bus *b, long bytes)
{
	atomic_long_add(bytes, &bus_sessions(b)->memory);
}

/* the cycle of the session */

static inline struct ec_cycle *bus_cycle(const struct bus *b)
{
	return &bus_session(b)->cycle;
}

static inline struct ec_shared *bus_shared(const struct bus *b)
{
	return bus_cycle(b)->shared;
}

static inline struct ec_status *bus_status(const struct bus *b)
{
	return bus_shared(b)->status;
}

static inline struct ec_status_cycle *bus_kernel_status(const struct bus *b)
{
	return &bus_status(b)->kernel;
}

static inline struct ec_status_domain *bus_domain_status(const struct bus *b, u32 domain)
{
	return &bus_status(b)->domains[domain];
}

static inline struct ec_cyc_dgram *bus_dgrams(const struct bus *b)
{
	return bus_cycle(b)->layout.dgrams;
}

static inline unsigned int bus_n_dgrams(const struct bus *b)
{
	return bus_cycle(b)->layout.n_dgrams;
}

/* frames of the cycle on their way */
static inline unsigned int bus_n_flight(const struct bus *b)
{
	return bus_cycle(b)->n_flight;
}

/* so far */
static inline u64 bus_sends(const struct bus *b)
{
	return bus_cycle(b)->sends;
}

/* frames of the last send, of a cycle with all domains, and of one with all clock datagrams, too */
static inline const struct ec_cyc_wire *bus_last_wire(const struct bus *b)
{
	return &bus_cycle(b)->last;
}

static inline const struct ec_cyc_wire *bus_plain_wire(const struct bus *b)
{
	return &bus_cycle(b)->layout.plain;
}

static inline const struct ec_cyc_wire *bus_clocked_wire(const struct bus *b)
{
	return &bus_cycle(b)->layout.clocked;
}

static inline struct ec_schedule *bus_schedule(const struct bus *b)
{
	return &bus_cycle(b)->late.schedule;
}

/* the image of the application from which it sends, or NULL */
static inline const u8 *bus_direct(const struct bus *b)
{
	return bus_cycle(b)->direct;
}

/* the time for the reference clock is wrong: it is not sent */
static inline bool bus_dc_hold(const struct bus *b)
{
	return bus_cycle(b)->clock.hold;
}

static inline bool bus_room_logged(const struct bus *b)
{
	return bus_cycle(b)->watch.wire_logged;
}

static inline u32 bus_cycle_late_per_s(const struct bus *b)
{
	return bus_cycle(b)->setup.late_per_s;
}

/* number of the newest send of which the domain has data */
static inline u32 bus_domain_send(const struct bus *b, u32 i)
{
	return bus_cycle(b)->domains[i].send;
}

/* slaves */

/* without a check, see bus_slave() */
static inline struct ec_slave *bus_slave_at(const struct bus *b, u32 position)
{
	return bus_table(b)->slaves[position];
}

static inline struct ec_mbox *bus_mbox(struct bus *b, u32 position)
{
	return &bus_slave(b, position)->mbox;
}

static inline unsigned int bus_n_slaves(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->n_slaves);
}

/* that replied to the last broadcast */
static inline u32 bus_responding(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->responding);
}

static inline u32 bus_al_states(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->al_states);
}

static inline struct ec_workers *bus_workers(const struct bus *b)
{
	return &bus_table(b)->workers;
}

static inline void bus_rescan(const struct bus *b)
{
	ec_bus_rescan(bus_table(b));
}

/* a scan is requested that has not begun */
static inline bool bus_rescan_due(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->rescan);
}

static inline bool bus_scan_busy(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->scan_busy);
}

/* scans so far */
static inline u32 bus_scans(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->scan_count);
}

/* frames of the last scan */
static inline u64 bus_scan_frames(const struct bus *b)
{
	return READ_ONCE(bus_table(b)->scan_frames);
}

/* distributed clocks */

static inline int bus_dc_state(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->state);
}

static inline int bus_dc_mode(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->mode);
}

static inline struct ec_slave *bus_dc_ref(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->ref);
}

static inline u16 bus_dc_ref_station(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->ref_station);
}

static inline u64 bus_dc_phase(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->phase);
}

static inline bool bus_dc_has_phase(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->has_phase);
}

static inline struct ec_dc_app *bus_dc_app(const struct bus *b)
{
	return &bus_dc(b)->app;
}

static inline u64 bus_app_time(const struct bus *b)
{
	return READ_ONCE(bus_dc(b)->app_time);
}

#include "access_link.h"

#endif
