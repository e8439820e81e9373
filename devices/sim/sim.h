/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * A simulated EtherCAT segment: slave controllers, cables, faults. Pure: the
 * caller gives time, randomness (a seed) and memory. The same seed and the
 * same calls give the same run.
 */
#ifndef EC_SIM_SIM_H
#define EC_SIM_SIM_H

#include "bug.h"
#include "esc.h"

#define EC_SIM_MASTER0	(-1)	/* "parent" in ec_sim_wire() */
#define EC_SIM_MASTER1	(-2)
#define EC_SIM_PORTS	2
#define EC_SIM_ETH_MAX	(EC_ETH_MAX + 4)	/* with a VLAN tag */
#define EC_SIM_ETH_HEAD	48		/* shows whether it is EtherCAT */

/**
 * struct ec_sim_ops - where memory comes from
 * @alloc: zeroed memory, NULL when there is none; may sleep
 * @free: gives it back, NULL is allowed
 */
struct ec_sim_ops {
	void *(*alloc)(size_t bytes);
	void (*free)(void *p);
};

/**
 * enum ec_sim_fault_type - what goes wrong
 * @EC_SIM_FAULT_CUT: cable at @slave, @port is cut
 * @EC_SIM_FAULT_HEAL: and whole again
 * @EC_SIM_FAULT_POWER_OFF: @slave loses power
 * @EC_SIM_FAULT_POWER_ON: and gets it back
 * @EC_SIM_FAULT_LOSE: frame is lost before the first slave, with @value 1 on
 *                     the way back
 * @EC_SIM_FAULT_DUPLICATE: frame comes back @value times more (0 as 1)
 * @EC_SIM_FAULT_DELAY: frame comes back @value ns later
 * @EC_SIM_FAULT_MANGLE: some bytes of the frame are changed on the way back
 * @EC_SIM_FAULT_REFUSE_AL: @slave refuses AL state @arg with code @arg2;
 *                          @arg 0 ends it
 * @EC_SIM_FAULT_EEPROM_BUSY: EEPROM stays busy while @arg is 1
 * @EC_SIM_FAULT_EEPROM_NOACK: the next @arg accesses fail, ~0 all, 0 none
 * @EC_SIM_FAULT_MISS_BROADCAST: slave misses broadcasts while @arg is 1
 * @EC_SIM_FAULT_DEAD: slave forwards only while @arg is 1
 * @EC_SIM_FAULT_WKC: (s16)@arg is added to its working counters, 0 ends it
 * @EC_SIM_FAULT_MUTE: the application does not answer while @arg is 1
 * @EC_SIM_FAULT_ERRORS: @arg is added to the error counters of @port
 * @EC_SIM_FAULT_MAILBOX: messages from the mailbox are wrong, @arg is an
 *                        enum ec_sim_mailbox_fault; the next @value are right
 * @EC_SIM_FAULT_LATCH: no fault: an edge, EC_SIM_EDGE_* in @arg2, at latch input
 *                      @arg of its clock
 * @EC_SIM_FAULT_AL_ERROR: @slave leaves OP with AL status code @arg, or shows it
 * @EC_SIM_FAULT_EEPROM: word @arg of its EEPROM becomes @arg2
 * @EC_SIM_FAULT_INPUT: no fault: input channel @arg (from 0) becomes (s64)@value
 * @EC_SIM_FAULT_EMERGENCY: CoE emergency, error code @arg, error register @arg2
 * @EC_SIM_FAULT_JUMP: the clock of @slave jumps by (s64)@value ns
 * @EC_SIM_FAULT_PLUG: no fault: a cable of @value ns from @slave, @port to port @arg2 of
 *                     slave (int)@arg; a cable in one of these ports comes out before
 * @EC_SIM_FAULT_UNPLUG: the cable at @slave, @port is taken away
 * @EC_SIM_FAULT_SWAP: what hangs at @slave, @port and what hangs at port @arg2 of
 *                     slave (int)@arg are exchanged; @port EC_SIM_ALL_PORTS: the
 *                     two slaves change places
 * @EC_SIM_FAULT_OLD: @slave is as another master left it: @value EC_SIM_OLD_* and the
 *                    station address, AL state @arg2, FMMUs from logical @arg on
 * @EC_SIM_FAULT_BOUNCE: the contact at @slave, @port bounces: one bit of @value every @arg ns
 *                       (bit 0 first, 1: contact), @arg2 % EC_SIM_BOUNCE_BITS of them, and
 *                       again from the first; @arg2 / EC_SIM_BOUNCE_BITS altogether
 * @EC_SIM_FAULT_HOST: a PC or a switch comes to @slave, @port; a cable there comes out
 *                     before. It sends a frame, EC_SIM_HOST_* in @arg, every @value ns,
 *                     0: none. @arg2 is 0
 * @EC_SIM_FAULT_DAMAGE: frames that come to @slave, @port by its cable are damaged there: @arg of
 *                       a million, 0 ends it. The slave counts them as invalid, those after it as
 *                       forwarded errors; no slave executes them, and they do not come back
 * @EC_SIM_FAULT_EOE: Ethernet frames of the slave are wrong, @arg is an enum
 *                    ec_sim_eoe_fault; where it concerns single frames: each @arg2-th one
 * @EC_SIM_FAULT_DRIVE: drive @arg2 of @slave has the class 1 diagnostic @arg (S-0-0011), 0: no
 *                      error
 * @EC_SIM_FAULT_TYPES: number of types
 */
enum ec_sim_fault_type {
	EC_SIM_FAULT_CUT,
	EC_SIM_FAULT_HEAL,
	EC_SIM_FAULT_POWER_OFF,
	EC_SIM_FAULT_POWER_ON,
	EC_SIM_FAULT_LOSE,
	EC_SIM_FAULT_DUPLICATE,
	EC_SIM_FAULT_DELAY,
	EC_SIM_FAULT_MANGLE,
	EC_SIM_FAULT_REFUSE_AL,
	EC_SIM_FAULT_EEPROM_BUSY,
	EC_SIM_FAULT_EEPROM_NOACK,
	EC_SIM_FAULT_MISS_BROADCAST,
	EC_SIM_FAULT_DEAD,
	EC_SIM_FAULT_WKC,
	EC_SIM_FAULT_MUTE,
	EC_SIM_FAULT_ERRORS,
	EC_SIM_FAULT_MAILBOX,
	EC_SIM_FAULT_LATCH,
	EC_SIM_FAULT_AL_ERROR,
	EC_SIM_FAULT_EEPROM,
	EC_SIM_FAULT_INPUT,
	EC_SIM_FAULT_EMERGENCY,
	EC_SIM_FAULT_JUMP,
	EC_SIM_FAULT_PLUG,
	EC_SIM_FAULT_UNPLUG,
	EC_SIM_FAULT_SWAP,
	EC_SIM_FAULT_OLD,
	EC_SIM_FAULT_BOUNCE,
	EC_SIM_FAULT_HOST,
	EC_SIM_FAULT_DAMAGE,
	EC_SIM_FAULT_EOE,
	EC_SIM_FAULT_DRIVE,
	EC_SIM_FAULT_TYPES
};

#define EC_SIM_ALL_PORTS	(-1)	/* "port" of EC_SIM_FAULT_SWAP */

/* "value" of EC_SIM_FAULT_OLD: what is said; station in bits 0 to 15, 0x0101 above */
#define EC_SIM_OLD_LOOPS_SHIFT	16
#define EC_SIM_OLD_STATION	BIT(24)
#define EC_SIM_OLD_LOOPS	BIT(25)
#define EC_SIM_OLD_STATE	BIT(26)
#define EC_SIM_OLD_LOGICAL	BIT(27)

#define EC_SIM_BOUNCE_BITS	64	/* a pattern has fewer */
#define EC_SIM_BOUNCE_MAX	100000	/* bits altogether: they may all be due at one time */
#define EC_SIM_HOST_MIN_NS	6720	/* a minimum frame of a host, with preamble and gap */
#define EC_SIM_HOST_ETHERCAT_NS	100000	/* of one that slaves process: they cost time */

/* "arg" of EC_SIM_FAULT_HOST: what it sends */
#define EC_SIM_HOST_BROADCAST	0
#define EC_SIM_HOST_ETHERCAT	1	/* BRD of 0x0130, as a master that looks for slaves */

#define EC_SIM_EDGE_RISING	1	/* both: a pulse, too short to see */
#define EC_SIM_EDGE_FALLING	2

/**
 * enum ec_sim_soe_fault - what is wrong with SoE responses
 * @EC_SIM_SOE_ENDLESS: it is a fragment, and comes again and again, with the same count
 * @EC_SIM_SOE_COUNTDOWN: likewise, but the count goes down, from 65535
 * @EC_SIM_SOE_SKIP: fragments count down by two
 * @EC_SIM_SOE_DRIVE: another drive
 * @EC_SIM_SOE_IDN: another IDN, in messages that have it
 * @EC_SIM_SOE_ELEMENTS: other elements
 * @EC_SIM_SOE_ERROR: the error flag and code 0x700B instead of data
 * @EC_SIM_SOE_LIST: the length in a list is too large
 * @EC_SIM_SOE_EMPTY: fragments without data
 */
enum ec_sim_soe_fault {
	EC_SIM_SOE_ENDLESS = 1,
	EC_SIM_SOE_COUNTDOWN,
	EC_SIM_SOE_SKIP,
	EC_SIM_SOE_DRIVE,
	EC_SIM_SOE_IDN,
	EC_SIM_SOE_ELEMENTS,
	EC_SIM_SOE_ERROR,
	EC_SIM_SOE_LIST,
	EC_SIM_SOE_EMPTY,
};

/**
 * enum ec_sim_mailbox_fault - what is wrong with messages from a mailbox
 * @EC_SIM_MAILBOX_GOOD: nothing
 * @EC_SIM_MAILBOX_LENGTH: the header says more than the mailbox holds
 * @EC_SIM_MAILBOX_SHORT: the header says one byte
 * @EC_SIM_MAILBOX_COUNTER: each has the counter of the first
 * @EC_SIM_MAILBOX_TYPE: another protocol
 * @EC_SIM_MAILBOX_BABBLE: another protocol, again and again
 * @EC_SIM_MAILBOX_STALE: SDO information that answers no request, again and again
 * @EC_SIM_MAILBOX_FRAGMENTS: an SDO information reply never ends: empty fragments follow
 * @EC_SIM_MAILBOX_ERROR: each is a mailbox error reply with the code in @arg2
 * @EC_SIM_MAILBOX_ABORT: SDO requests that are aborted have the abort code @arg2
 * @EC_SIM_MAILBOX_DELAY: each is sent @arg2 ns later
 * @EC_SIM_MAILBOX_BUSY: FoE is busy without end; else a mailbox error reply: still at work
 * @EC_SIM_MAILBOX_DENY: CoE, FoE and SoE refuse each request with the error code @arg2
 * @EC_SIM_MAILBOX_GARBAGE: random bytes; in half of them the header is right
 * @EC_SIM_MAILBOX_DUPLICATE: each is sent twice, with the same counter
 * @EC_SIM_MAILBOX_LOST: requests are executed, replies are not sent
 * @EC_SIM_MAILBOX_ALMOST: in half of them one field is wrong
 * @EC_SIM_MAILBOX_SOE: SoE responses are wrong as @arg2 says, enum ec_sim_soe_fault
 * @EC_SIM_MAILBOX_FAULTS: number of faults
 */
enum ec_sim_mailbox_fault {
	EC_SIM_MAILBOX_GOOD,
	EC_SIM_MAILBOX_LENGTH,
	EC_SIM_MAILBOX_SHORT,
	EC_SIM_MAILBOX_COUNTER,
	EC_SIM_MAILBOX_TYPE,
	EC_SIM_MAILBOX_BABBLE,
	EC_SIM_MAILBOX_STALE,
	EC_SIM_MAILBOX_FRAGMENTS,
	EC_SIM_MAILBOX_ERROR,
	EC_SIM_MAILBOX_ABORT,
	EC_SIM_MAILBOX_DELAY,
	EC_SIM_MAILBOX_BUSY,
	EC_SIM_MAILBOX_DENY,
	EC_SIM_MAILBOX_GARBAGE,
	EC_SIM_MAILBOX_DUPLICATE,
	EC_SIM_MAILBOX_LOST,
	EC_SIM_MAILBOX_ALMOST,
	EC_SIM_MAILBOX_SOE,
	EC_SIM_MAILBOX_FAULTS
};

/**
 * enum ec_sim_eoe_fault - what is wrong with Ethernet frames of a slave
 * @EC_SIM_EOE_GOOD: nothing
 * @EC_SIM_EOE_INTERLEAVE: fragments of two frames alternate
 * @EC_SIM_EOE_STAMP: a time stamp behind the last fragment
 * @EC_SIM_EOE_SHORT: short frames without padding
 * @EC_SIM_EOE_LOST: the second fragment is not sent, or the only one
 * @EC_SIM_EOE_OFFSET: the offset of all fragments but the first is wrong
 * @EC_SIM_EOE_NUMBER: the number of the last fragment is wrong
 * @EC_SIM_EOE_ENDLESS: no fragment is the last
 * @EC_SIM_EOE_SIZE: the announced size is 0, 32 or 2016 bytes, in turn
 * @EC_SIM_EOE_FLOOD: broadcasts without end
 * @EC_SIM_EOE_SPOOF: the source is the address of the station that was heard last
 * @EC_SIM_EOE_ETHERCAT: EtherCAT frames
 * @EC_SIM_EOE_UDP: the same in UDP
 * @EC_SIM_EOE_REFUSE: the first fragment of a frame from the master gets an error reply
 * @EC_SIM_EOE_FAULTS: number of faults
 */
enum ec_sim_eoe_fault {
	EC_SIM_EOE_GOOD,
	EC_SIM_EOE_INTERLEAVE,
	EC_SIM_EOE_STAMP,
	EC_SIM_EOE_SHORT,
	EC_SIM_EOE_LOST,
	EC_SIM_EOE_OFFSET,
	EC_SIM_EOE_NUMBER,
	EC_SIM_EOE_ENDLESS,
	EC_SIM_EOE_SIZE,
	EC_SIM_EOE_FLOOD,
	EC_SIM_EOE_SPOOF,
	EC_SIM_EOE_ETHERCAT,
	EC_SIM_EOE_UDP,
	EC_SIM_EOE_REFUSE,
	EC_SIM_EOE_FAULTS
};

/**
 * enum ec_sim_when - when a fault that waits for a frame happens
 * @EC_SIM_WHEN_SENT: when the frame is sent
 * @EC_SIM_WHEN_OUT: when the frame is on the cable of the fault, on its way out
 * @EC_SIM_WHEN_BACK: when it is there on its way back
 */
enum ec_sim_when {
	EC_SIM_WHEN_SENT,
	EC_SIM_WHEN_OUT,
	EC_SIM_WHEN_BACK
};

/**
 * struct ec_sim_fault - one scripted fault
 * @at_ns: when it begins; 0 or past: with the next frame or advance
 * @type: what
 * @slave: which slave; for frame faults ignored. -1, -2: CUT, HEAL, BOUNCE,
 *         PLUG, UNPLUG and SWAP at the master's own port
 * @port: which port; for frame faults the master port, -1 = both
 * @arg: frame faults: the n-th frame from @at_ns on (1 = next), 0 = by chance
 * @arg2: frame faults by chance: probability in ppm, 0 ends the earlier one
 * @value: see the types
 * @frame: it waits for the n-th frame from @at_ns on (1 = next), 0: it does not; with a
 *         fault of frames see @arg
 * @by_register: only frames with a physical command that accesses @reg count
 * @reg: register
 * @when: on the way of this frame. The cable is the one at @slave, @port, or at port 0 of
 *        @slave; at the latest, it happens at the end of the frame
 * @after_ns: so much later
 */
struct ec_sim_fault {
	u64 at_ns;
	enum ec_sim_fault_type type;
	int slave;
	int port;
	u32 arg;
	u32 arg2;
	u64 value;
	u32 frame;
	bool by_register;
	u16 reg;
	enum ec_sim_when when;
	u64 after_ns;
};

/**
 * struct ec_sim_result - fate of one frame
 * @out_port: master port at which it came back
 * @delay_ns: first bit sent to last bit received, -ENOLINK: lost
 * @copies: how many of it arrive, 1 = as usual, 0 = lost
 * @mangled: its content was changed by a fault
 * @induced: a fault was at work on it
 * @processed: it passed the processing unit of a slave
 */
struct ec_sim_result {
	int out_port;
	s64 delay_ns;
	u8 copies;
	bool mangled;
	bool induced;
	bool processed;
};

/**
 * enum ec_sim_under_way - fate of a frame that comes back to a port whose loop was closed meanwhile
 * @EC_SIM_UNDER_WAY_BACK: the port lets it in
 * @EC_SIM_UNDER_WAY_LOST: it is destroyed there
 * @EC_SIM_UNDER_WAY_RANDOM: one of the two, by chance
 */
enum ec_sim_under_way {
	EC_SIM_UNDER_WAY_BACK,
	EC_SIM_UNDER_WAY_LOST,
	EC_SIM_UNDER_WAY_RANDOM
};

/**
 * struct ec_sim_flight - a frame in the segment
 * @done: it is back or lost: the next two are valid
 * @due_ns: when its last bit is back
 * @res: what became of it
 * @next: next one on its way
 * @eth: Ethernet frame, NULL: @frame is all there is
 * @ip: where the IP header is in @eth, 0: none
 * @frame: EtherCAT header and datagrams
 * @len: bytes there
 * @eth_len: bytes of the Ethernet frame, without FCS
 * @number: its number
 * @mport: master port that sent it
 * @lose_back: to be lost on the way back
 * @circulating: it has passed a slave without upstream link
 * @disturbed: a link changed while it was on its way
 * @damaged: its FCS is wrong since a cable
 * @hops: slaves entered so far
 * @wire_ns: from its first to its last bit
 * @start_ns: when the first bit was sent
 * @extra_ns: to be added to its delay
 * @at_ns: when its first bit reaches @to; the last bit at a master
 * @to: slave, or -2 - n for master port n
 * @to_port: port of the slave
 * @from: where it left, as @to
 * @from_port: port of the slave
 * @left_at: number of the last event of a port then
 * @started_at: and when it was sent
 * @faults: first of those that happen on its way, -1: none
 *
 * All but the first three is private to the model.
 */
struct ec_sim_flight {
	bool done;
	u64 due_ns;
	struct ec_sim_result res;

	struct ec_sim_flight *next;
	u8 *eth;
	size_t ip;
	u8 *frame;
	size_t len;
	size_t eth_len;
	u64 number;
	int mport;
	bool lose_back;
	bool circulating;
	bool disturbed;
	bool damaged;
	u32 hops;
	u32 wire_ns;
	u64 start_ns;
	u64 extra_ns;
	u64 at_ns;
	int to;
	u8 to_port;
	int from;
	u8 from_port;
	u64 left_at;
	u64 started_at;
	int faults;
};

/**
 * struct ec_sim_foreign - a frame of a host that has come to a master
 * @port: master port
 * @due_ns: when its last bit was there
 * @eth: the Ethernet frame, without FCS
 */
struct ec_sim_foreign {
	int port;
	u64 due_ns;
	u8 eth[60];
};

/* building */
struct ec_sim *ec_sim_new(const struct ec_sim_ops *ops, u32 max_slaves,
			  u64 seed);
void ec_sim_free(struct ec_sim *sim);
struct ec_esc *ec_sim_add(struct ec_sim *sim, const struct ec_esc_config *cfg);
int ec_sim_wire(struct ec_sim *sim, int parent, int parent_port, int child,
		int child_port, u32 cable_ns);
void *ec_sim_alloc(struct ec_sim *sim, size_t bytes);
void ec_sim_release(struct ec_sim *sim, void *p);

/* running */
s64 ec_sim_frame(struct ec_sim *sim, int port, u8 *frame, size_t len,
		 u64 now_ns);
s64 ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
		  u64 now_ns, int *out_port);
s64 ec_sim_frame_result(struct ec_sim *sim, int port, u8 *frame, size_t len,
			u64 now_ns, struct ec_sim_result *res);
s64 ec_sim_eth(struct ec_sim *sim, int port, u8 *eth, size_t len, u64 now_ns,
	       struct ec_sim_result *res);
bool ec_sim_eth_is_ethercat(const u8 *eth, size_t len);
void ec_sim_send(struct ec_sim *sim, struct ec_sim_flight *fl, int port, u8 *eth, size_t len,
		 u64 now_ns);
u64 ec_sim_next_step(const struct ec_sim *sim);
void ec_sim_recall(struct ec_sim *sim, struct ec_sim_flight *fl);
void ec_sim_set_under_way(struct ec_sim *sim, enum ec_sim_under_way how);
u64 ec_sim_disturbed(const struct ec_sim *sim);
bool ec_sim_foreign(struct ec_sim *sim, struct ec_sim_foreign *f);
void ec_sim_advance(struct ec_sim *sim, u64 now_ns);
u64 ec_sim_next_event(struct ec_sim *sim);
bool ec_sim_link(const struct ec_sim *sim, int port);
bool ec_sim_is_ring(const struct ec_sim *sim);
void ec_sim_card(struct ec_sim *sim, int port, bool on, u64 now);
bool ec_sim_has_port(const struct ec_sim *sim, int slave, int port);

/* looking */
u32 ec_sim_count(const struct ec_sim *sim);
struct ec_esc *ec_sim_slave(struct ec_sim *sim, u32 index);
struct ec_esc *ec_sim_at(const struct ec_sim *sim, u32 index);
u64 ec_sim_now(const struct ec_sim *sim);
u32 ec_sim_random(struct ec_sim *sim);

/* going wrong */
int ec_sim_add_fault(struct ec_sim *sim, const struct ec_sim_fault *fault);
void ec_sim_clear_faults(struct ec_sim *sim);
const char *ec_sim_fault_name(enum ec_sim_fault_type type);
void ec_sim_set_bug(struct ec_sim *sim, enum ec_sim_bug bug);
void ec_sim_set_slow(struct ec_sim *sim, bool slow);

#endif
