/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Tracepoints, in /sys/kernel/tracing/events/ethercat. One that is off costs an instruction that
 * does nothing, if its arguments are not kept for it: so the hot ones have a function of their own.
 * Each event has the number of the master.
 */
#undef TRACE_SYSTEM
#define TRACE_SYSTEM ethercat

#if !defined(EC_TRACE_H) || defined(TRACE_HEADER_MULTI_READ)
#define EC_TRACE_H

#include <linux/tracepoint.h>

/* A frame: @link 0 main, 1 backup; @index names its slot, @seq is 0 without frame_numbers. */
DECLARE_EVENT_CLASS(ec_frame,
	TP_PROTO(u32 master, u8 link, u8 index, u32 seq, u32 bytes),
	TP_ARGS(master, link, index, seq, bytes),
	TP_STRUCT__entry(
		__field(u32, master)
		__field(u32, seq)
		__field(u32, bytes)
		__field(u8, link)
		__field(u8, index)
	),
	TP_fast_assign(
		__entry->master = master;
		__entry->seq = seq;
		__entry->bytes = bytes;
		__entry->link = link;
		__entry->index = index;
	),
	TP_printk("master=%u link=%u index=%u seq=%u bytes=%u", __entry->master, __entry->link,
		  __entry->index, __entry->seq, __entry->bytes)
);

/* The device has taken the frame. */
DEFINE_EVENT(ec_frame, ec_frame_sent,
	TP_PROTO(u32 master, u8 link, u8 index, u32 seq, u32 bytes),
	TP_ARGS(master, link, index, seq, bytes));

/* No reply in time, or none on this link. */
DEFINE_EVENT(ec_frame, ec_frame_lost,
	TP_PROTO(u32 master, u8 link, u8 index, u32 seq, u32 bytes),
	TP_ARGS(master, link, index, seq, bytes));

/* An EtherCAT frame was received; @match 0 reply, 1 late, 2 unmatched (enum ec_match). */
TRACE_EVENT(ec_frame_received,
	TP_PROTO(u32 master, u8 link, u8 index, u32 seq, u32 bytes, u8 match),
	TP_ARGS(master, link, index, seq, bytes, match),
	TP_STRUCT__entry(
		__field(u32, master)
		__field(u32, seq)
		__field(u32, bytes)
		__field(u8, link)
		__field(u8, index)
		__field(u8, match)
	),
	TP_fast_assign(
		__entry->master = master;
		__entry->seq = seq;
		__entry->bytes = bytes;
		__entry->link = link;
		__entry->index = index;
		__entry->match = match;
	),
	TP_printk("master=%u link=%u index=%u seq=%u bytes=%u match=%s", __entry->master,
		  __entry->link, __entry->index, __entry->seq, __entry->bytes,
		  __print_symbolic(__entry->match, { 0, "reply" }, { 1, "late" },
				   { 2, "unmatched" }))
);

/* The AL status of a slave is another one, or the slave is new; @status as register 0x0130. */
TRACE_EVENT(ec_al_state,
	TP_PROTO(u32 master, u16 station, u16 position, u16 before, u16 status, u16 code),
	TP_ARGS(master, station, position, before, status, code),
	TP_STRUCT__entry(
		__field(u32, master)
		__field(u16, station)
		__field(u16, position)
		__field(u16, before)
		__field(u16, status)
		__field(u16, code)
	),
	TP_fast_assign(
		__entry->master = master;
		__entry->station = station;
		__entry->position = position;
		__entry->before = before;
		__entry->status = status;
		__entry->code = code;
	),
	TP_printk("master=%u station=0x%04x position=%u before=0x%02x status=0x%02x (%s%s) code=0x%04x",
		  __entry->master, __entry->station, __entry->position, __entry->before,
		  __entry->status,
		  __print_symbolic(__entry->status & 0xf, { 1, "INIT" }, { 2, "PREOP" },
				   { 3, "BOOT" }, { 4, "SAFEOP" }, { 8, "OP" }),
		  __entry->status & 0x10 ? " with error" : "", __entry->code)
);

/* A mailbox message is in the slave, or was read from it; @bytes behind the mailbox header. */
TRACE_EVENT(ec_mailbox,
	TP_PROTO(u32 master, u16 station, bool to_slave, u8 type, u8 counter, u16 bytes),
	TP_ARGS(master, station, to_slave, type, counter, bytes),
	TP_STRUCT__entry(
		__field(u32, master)
		__field(u16, station)
		__field(u16, bytes)
		__field(bool, to_slave)
		__field(u8, type)
		__field(u8, counter)
	),
	TP_fast_assign(
		__entry->master = master;
		__entry->station = station;
		__entry->bytes = bytes;
		__entry->to_slave = to_slave;
		__entry->type = type;
		__entry->counter = counter;
	),
	TP_printk("master=%u station=0x%04x %s type=%u (%s) counter=%u bytes=%u", __entry->master,
		  __entry->station, __entry->to_slave ? "to_slave" : "from_slave", __entry->type,
		  __print_symbolic(__entry->type, { 0, "error" }, { 1, "AoE" }, { 2, "EoE" },
				   { 3, "CoE" }, { 4, "FoE" }, { 5, "SoE" }, { 15, "VoE" }),
		  __entry->counter, __entry->bytes)
);

/*
 * A cycle was sent: @number since activation, @domains mask of those in it, @wire_ns time of its
 * frames on the wire, @in_flight frames of cycles without a reply, those just sent included.
 */
TRACE_EVENT(ec_cycle,
	TP_PROTO(u32 master, u64 number, u64 domains, u32 frames, u32 wire_ns, u32 in_flight),
	TP_ARGS(master, number, domains, frames, wire_ns, in_flight),
	TP_STRUCT__entry(
		__field(u64, number)
		__field(u64, domains)
		__field(u32, master)
		__field(u32, frames)
		__field(u32, wire_ns)
		__field(u32, in_flight)
	),
	TP_fast_assign(
		__entry->number = number;
		__entry->domains = domains;
		__entry->master = master;
		__entry->frames = frames;
		__entry->wire_ns = wire_ns;
		__entry->in_flight = in_flight;
	),
	TP_printk("master=%u number=%llu domains=0x%llx frames=%u wire_ns=%u in_flight=%u",
		  __entry->master, __entry->number, __entry->domains, __entry->frames,
		  __entry->wire_ns, __entry->in_flight)
);

#endif

#undef TRACE_INCLUDE_PATH
#define TRACE_INCLUDE_PATH master/kernel
#undef TRACE_INCLUDE_FILE
#define TRACE_INCLUDE_FILE trace
#include <trace/define_trace.h>
