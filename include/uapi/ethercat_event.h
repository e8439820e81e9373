/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Events of a master: what has happened on the bus and with its applications.
 *
 * EC_IOC_EVENTS makes an open file a reader of events, also one opened for reading only. From
 * then on read() returns whole records, poll() reports new ones. Each reader has a position of
 * its own, and takes nothing from others. The ring keeps EC_EVENTS_KEPT records: a reader that
 * was slower gets one EC_EVENT_MISSED with the exact number of lost records.
 *
 * Numbers of events are never reused, arguments of an event are only added: those that are
 * not described are 0.
 */
#ifndef EC_UAPI_ETHERCAT_EVENT_H
#define EC_UAPI_ETHERCAT_EVENT_H

#include <linux/types.h>
#include "ethercat_cause.h"

#define EC_EVENT_ARGS		8
#define EC_EVENTS_KEPT		2047
#define EC_EVENT_NO_SLAVE	0xffff
#define EC_EVENT_NONE		0xffffffff	/* an argument: no slave */

/* @kind; arguments in their order */
#define EC_EVENT_MISSED		0x00	/* records lost: lower 32 bits, upper 32 bits */

#define EC_EVENT_DEVICE_ON	0x01	/* device attached: 0 main, 1 backup */
#define EC_EVENT_DEVICE_OFF	0x02	/* device detached: likewise */
#define EC_EVENT_LINK_UP	0x03	/* likewise */
#define EC_EVENT_LINK_DOWN	0x04	/* likewise */

#define EC_EVENT_RESPONDING	0x10	/* slaves that reply, before */
#define EC_EVENT_SCAN_START	0x11	/* slaves */
#define EC_EVENT_SCAN_END	0x12	/* slaves, us, frames, 1: the list has changed */
/*
 * slave upstream or EC_EVENT_NONE: the main device, its port, alias, vendor, product, ms ago;
 * slaves of the ring that were lost there, this one and those after it
 */
#define EC_EVENT_SLAVE_LOST	0x13
#define EC_EVENT_ALL_LOST	0x14	/* slaves, ms ago */
#define EC_EVENT_SLAVE_FOUND	0x15	/* as EC_EVENT_SLAVE_LOST, without ms */
#define EC_EVENT_SLAVE_SILENT	0x16	/* no reply, frames pass */
#define EC_EVENT_SLAVE_REPLIES	0x17	/* again */
/* in OP again: ms since they were last seen; slaves: this one and those after it */
#define EC_EVENT_SLAVE_BACK	0x18
#define EC_EVENT_NO_ANSWER	0x19	/* no reply at a station address: polls; a scan follows */
/*
 * a port with a link stays closed: port, EC_PORT_*; with EC_PORT_LOSSES their number, in s, longest
 * wait in s; of the device behind it: vendor, product, slaves
 */
#define EC_EVENT_PORT_KEPT	0x1a

/*
 * a cable damages frames: port of the slave, invalid frames there, errors of its receiver, in s;
 * slave at the other end or EC_EVENT_NONE, its port; 1: the other end is the main device
 */
#define EC_EVENT_LINE_ERRORS	0x1b

/*
 * the ring of both devices is open: slave before the break or EC_EVENT_NONE: the main device, its
 * port or EC_EVENT_NONE: not known; slave behind it or EC_EVENT_NONE: the backup device
 */
#define EC_EVENT_RING_OPEN	0x1c
#define EC_EVENT_RING_CLOSED	0x1d	/* slaves */
/* the devices of the ring are exchanged: 1: the one at the backup name is the main device */
#define EC_EVENT_RING_EXCHANGED	0x1e
#define EC_EVENT_RING_TURNED	0x1f	/* port 0 leads to the backup device */

/*
 * as requested: AL state, before, slaves: this one and those after it, the lowest AL state in
 * between if it is lower than both
 */
#define EC_EVENT_AL_STATE	0x20
#define EC_EVENT_AL_LEFT	0x21	/* without request: AL state, before */
#define EC_EVENT_AL_ERROR	0x22	/* AL state, AL status code */
/* code, error register, data 0..3, data 4, profile: 402 drive, 0 not known */
#define EC_EVENT_EMERGENCY	0x23
/*
 * EC_SLAVE_*_FAILED, AL status code; of struct ec_cause: kind, code, object, subindex, SyncManager,
 * AL state
 */
#define EC_EVENT_SLAVE_FAILED	0x24
/* flaw of an EEPROM that is used anyway: 0 checksum, found, expected; otherwise its kind */
#define EC_EVENT_EEPROM		0x25
#define EC_EVENT_NO_CLOCK	0x26	/* SYNC signals configured, but no clock */
#define EC_EVENT_REVISION	0x27	/* expected, found */
/* of a SERCOS drive (SoE): drive, IDN, elements, bytes of data, bytes 0..3, bytes 4..7 */
#define EC_EVENT_SOE_NOTIFICATION 0x28
#define EC_EVENT_SOE_EMERGENCY	0x29	/* the same */

/*
 * domain, working counter, before, expected; changes before this one that have no record; 1: the
 * application takes the slaves to PREOP; 1: not that of each datagram is complete; 1: nor was it
 * before. It is also a change when only that changes.
 */
#define EC_EVENT_WKC		0x30
#define EC_EVENT_OVERRUN	0x31	/* cycles skipped since the last record */
#define EC_EVENT_FRAMES_LOST	0x32	/* frames lost since the last record */
#define EC_EVENT_FRAMES_LATE	0x33	/* frames late since the last record */
/* ms without a cyclic frame; cycle timeouts since the last record */
#define EC_EVENT_TIMEOUT	0x34
#define EC_EVENT_RESUMED	0x35	/* ms */
#define EC_EVENT_STALE		0x36	/* domain, age in sends, limit */
/* ns of the cyclic frames, of a cycle, free for acyclic frames, that one needs at least */
#define EC_EVENT_WIRE_TIME	0x37
/* EC_STALL_*, cycles of the kernel without new outputs; stalls before without record */
#define EC_EVENT_STALL		0x38
#define EC_EVENT_OUTPUTS	0x39	/* there are new ones: cycles without */
/*
 * a sync unit: index, its state (the low 16 bits, as struct ec_ioc_unit_info.state), why it has
 * changed: 0 working counter, 1 lease, 2 command, 3 another unit has stopped all; first domain that
 * is not complete or EC_EVENT_NONE, its working counter, the expected one; changes before this one
 * that have no record; state of the last record
 */
#define EC_EVENT_UNIT		0x3a

/*
 * slave, or EC_EVENT_NONE: clocks run free; 1: the reference clock before was lost; 1: the slave
 * substitutes until the configured one returns
 */
#define EC_EVENT_REF_CLOCK	0x40
#define EC_EVENT_DC_SET		0x41	/* synchronized: us, slave with the reference clock */
#define EC_EVENT_DC_FAILED	0x42	/* errno, 1: is tried again */
/* clocks outside, clocks, worst slave, its difference in ns */
#define EC_EVENT_DC_WINDOW	0x43
/* EC_CYCLE_LOCK_*, phase error in ns, rate in ppb; both signed; 1: it was locked before */
#define EC_EVENT_LOCK		0x44

/*
 * processes by their number in the initial PID namespace; of an application in the kernel the
 * process that called it, insmod for one
 */
#define EC_EVENT_RESERVED	0x50	/* process */
#define EC_EVENT_ACTIVATED	0x51	/* process, domains, bytes, datagrams of a cycle */
#define EC_EVENT_DEACTIVATED	0x52	/* process */
#define EC_EVENT_RELEASED	0x53	/* process */
#define EC_EVENT_DETACHED	0x54	/* process that exited or released the master */
#define EC_EVENT_TAKEN_OVER	0x55	/* process */
#define EC_EVENT_DEBUG		0x56	/* debug level */

/*
 * On activation a configuration has no slave: alias, position, EC_CAUSE_*, vendor, product;
 * vendor, product of the slave at its position
 */
#define EC_EVENT_CONFIG		0x60
#define EC_EVENT_CONFIGS	0x61	/* more of them without record */
/*
 * a hot connect group of the active application: index, EC_CAUSE_*: EC_CAUSE_NONE it is connected,
 * 1 mandatory, members; slave: its head, or the one that keeps it from use
 */
#define EC_EVENT_GROUP		0x62

/**
 * struct ec_event - one event
 * @number: of the event since the module was loaded, from 0; of EC_EVENT_MISSED: of the first
 *	one that was lost
 * @time_ns: CLOCK_MONOTONIC; of EC_EVENT_MISSED when that was found
 * @wall_ns: CLOCK_REALTIME, at that time
 * @kind: EC_EVENT_*
 * @slave: ring position, EC_EVENT_NO_SLAVE: not of one slave
 * @reserved: 0
 * @arg: see there
 */
struct ec_event {
	__u64 number;
	__u64 time_ns;
	__u64 wall_ns;
	__u32 kind;
	__u16 slave;
	__u16 reserved;
	__u32 arg[EC_EVENT_ARGS];
};

#define EC_EVENTS_FLAG_NEW	1	/* begin with the next event, not with the oldest kept */

struct ec_ioc_events {
	__u32 flags;		/* EC_EVENTS_FLAG_* */
	__u32 size;		/* in: bytes of struct ec_event */
	__u64 first;		/* out: number of the first event that read() returns */
	__u64 next;		/* out: number of the event that comes next */
};

#endif
