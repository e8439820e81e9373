/* SPDX-License-Identifier: GPL-2.0-only */
/* One master: the structures of all layers below one device node. */
#ifndef EC_MASTER_H
#define EC_MASTER_H

#include "../base/base.h"
#include "../bus/bus.h"
#include "../clock/dc_state.h"
#include "../cycle/cycle.h"
#include "../link/links.h"
#include "../carry/carry.h"
#include "../carry/rider.h"
#include "../session/session.h"
#include "../eoe/netdevs.h"
#include "event_readers.h"
#include "mail_readers.h"
#include "record_readers.h"
#include "slave_devices.h"

struct ec_api;
struct task_struct;

/** struct ec_master - everything below one /dev/EtherCAT<n> */
struct ec_master {
	/** @base: one; an array, so that all layers write "->base->" */
	struct ec_base base[1];
	/** @links: devices, frames and bus access */
	struct ec_links links;
	/** @carry: acyclic datagrams */
	struct ec_carry carry;
	/** @riders: datagrams in frames of the cycle */
	struct ec_riders riders;
	/** @bus: slaves */
	struct ec_bus bus;
	/** @dc: distributed clocks */
	struct ec_dc dc;
	/** @cycles: cycles of applications */
	struct ec_cycles cycles;
	/** @sessions: applications */
	struct ec_sessions sessions;
	/** @readers: open files that read events */
	struct ec_event_readers readers;
	/** @mail_readers: open files that read mailbox messages */
	struct ec_mail_readers mail_readers;
	/** @record_readers: open files that read records of process data */
	struct ec_record_readers record_readers;
	/** @slave_devices: slaves for the rest of Linux */
	struct ec_slave_devices slave_devices;
	/** @eoe: network devices of slaves */
	struct ec_eoe eoe;
	/** @api: for applications in the kernel, immutable */
	struct ec_api *api;
	/** @monitor: thread that watches the bus; only monitor.c uses it and @rider */
	struct task_struct *monitor;
	/** @pause: @monitor must send nothing until this is cleared; written by power.c */
	bool pause;
	/** @paused: @monitor sends nothing; written by monitor.c */
	bool paused;
	/** @rider: datagram of @monitor in frames of the cycle */
	struct ec_rider rider;
};

/* the master that a session has reserved, or is about to take over */
static inline struct ec_master *ec_master_of(const struct ec_session *s)
{
	return container_of(s->sessions, struct ec_master, sessions);
}

#endif
