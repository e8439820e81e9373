/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Model of one EtherCAT slave controller: registers, RAM, SyncManagers, FMMUs,
 * EEPROM interface, watchdogs, distributed clock. Pure: time comes in as an
 * argument, memory through the ops of the segment.
 *
 * Two faces: ec_esc_dgram() is what the wire does, ec_esc_pdi_read() and
 * ec_esc_pdi_write() are what the slave's own CPU does.
 */
#ifndef EC_SIM_ESC_H
#define EC_SIM_ESC_H

#include "../../master/wire/frame.h"
#include "../../master/wire/regs.h"
#include "esc_page.h"

struct ec_sim;
struct ec_sim_fault;
struct ec_esc;

#define EC_ESC_NEVER	(~0ULL)

/* AL event bits beyond those in regs.h */
#define EC_AL_EVENT_DC_LATCH	BIT(1)
#define EC_AL_EVENT_SYNC0	BIT(2)
#define EC_AL_EVENT_SYNC1	BIT(3)
#define EC_AL_EVENT_EEPROM	BIT(5)

/**
 * struct ec_esc_config - what a slave controller is built with
 * @type: register 0x0000
 * @revision: register 0x0001
 * @build: register 0x0002
 * @fmmus: number of FMMUs, 1..16
 * @sms: number of SyncManagers, 1..16
 * @ram_kib: process RAM, 1..60
 * @ports: enum ec_port_type of the four ports
 * @features: register 0x0008, EC_FEAT_*
 * @eeprom_8byte: reads 8 bytes per EEPROM access, else 4
 * @eeprom_emulated: the PDI answers EEPROM commands (0x0502 bit 5)
 * @alias_reload: the reload command sets 0x0012 as well
 * @eeprom_busy_ns: time of a read access of 8 bytes; 4 bytes take half
 * @eeprom_write_ns: time of a write access
 * @eeprom: initial content, copied; may be NULL (all 0xff)
 * @eeprom_len: bytes in @eeprom
 * @eeprom_size: bytes of the memory itself, at least @eeprom_len, even;
 *               0: as @eeprom_len
 * @process_ns: delay through the processing unit, port 0 to the next port
 * @forward_ns: delay between any other two ports of the way
 * @drift_ppb: rate error of the local clock, positive runs fast
 * @clock_start: local clock at power-on, ns
 * @dc_noise_ns: jitter of the receive times, 0 = exact
 * @refuse_unwritten: an input SM is not readable before the PDI wrote it once
 * @dc_delay_only: with EC_FEAT_DC: receive times, but no clock that can be set
 * @loops_fixed: 0x0101 does not keep what is written: it stays 0, auto
 * @no_frmw: FRMW is ignored, as a command that the controller does not know
 * @link_ns: time from cable and power at both ends to a link; the longer one of both ends
 *
 * ec_esc_config_init() gives a complete set; change what differs.
 * A 32-bit clock is one without EC_FEAT_DC64.
 */
struct ec_esc_config {
	u8 type;
	u8 revision;
	u16 build;
	u8 fmmus;
	u8 sms;
	u8 ram_kib;
	u8 ports[EC_MAX_PORT];
	u16 features;
	bool eeprom_8byte;
	bool eeprom_emulated;
	bool alias_reload;
	u32 eeprom_busy_ns;
	u32 eeprom_write_ns;
	const u8 *eeprom;
	size_t eeprom_len;
	size_t eeprom_size;
	u32 process_ns;
	u32 forward_ns;
	s32 drift_ppb;
	u64 clock_start;
	u32 dc_noise_ns;
	bool refuse_unwritten;
	bool dc_delay_only;
	bool loops_fixed;
	bool no_frmw;
	u32 link_ns;
};

/**
 * struct ec_esc_app_ops - the application behind a slave controller
 * @al_control: the master wrote 0x0120 (not with device emulation)
 * @eeprom: a command for the emulated EEPROM is pending: read 0x0502 and
 *          0x0504, put the data at 0x0508, write the command to 0x0502
 * @sm_written: the master completely wrote the buffer of an SM
 * @sm_read: the master completely read the buffer of an SM
 * @sm_activate: the master wrote the activate byte of an SM (enable or
 *               repeat request, read 0x0806 + 8 * sm to see which)
 * @sm_taken: outputs that were fetched from an SM in its name are @data; only
 *            after ec_esc_pdi_may_wait()
 * @fault: a scripted fault that only the application can act
 * @watchdog: the process data watchdog expired
 * @poll: called by ec_sim_advance() once @now reaches esc->app_wake_ns; the
 *        wake-up is cleared before the call, set it again as needed
 * @sync: SYNC0 (@which 0) or SYNC1 (1) pulse
 * @power_on: registers and RAM are at their reset values, start afresh; not
 *            called for the first power-on, which is before the application
 *            is attached
 * @free: the segment goes away, release esc->app
 *
 * All may be NULL. They run inside ec_sim_frame() or ec_sim_advance(), may
 * use the PDI functions and must not allocate. What a frame caused is reported
 * when the last bit of the frame has passed, so an application can never
 * answer within the frame that asked. Without a good EEPROM (checksum of
 * words 0-6) the PDI does not start and nothing but @power_on and @free is
 * called.
 */
struct ec_esc_app_ops {
	void (*al_control)(struct ec_esc *esc, u64 now);
	void (*eeprom)(struct ec_esc *esc, u64 now);
	void (*sm_written)(struct ec_esc *esc, int sm, u64 now);
	void (*sm_read)(struct ec_esc *esc, int sm, u64 now);
	void (*sm_activate)(struct ec_esc *esc, int sm, u64 now);
	void (*sm_taken)(struct ec_esc *esc, const u8 *data);
	void (*fault)(struct ec_esc *esc, const struct ec_sim_fault *f, u64 now);
	void (*watchdog)(struct ec_esc *esc, u64 now);
	void (*poll)(struct ec_esc *esc, u64 now);
	void (*sync)(struct ec_esc *esc, int which, u64 now);
	void (*power_on)(struct ec_esc *esc, u64 now);
	void (*free)(struct ec_esc *esc);
};

#define EC_ESC_PEER_HOST	(-100)	/* a PC or a switch: no EtherCAT */

/**
 * struct ec_esc_transit - the last frame that passed a cable in one direction
 * @number: its number
 * @until: when its last bit has arrived at the other end
 */
struct ec_esc_transit {
	u64 number;
	u64 until;
};

/**
 * struct ec_esc_port - one port and what hangs on it
 * @peer: index of the slave at the other end; -1 nothing, -2 - n master port n,
 *        EC_ESC_PEER_HOST
 * @peer_port: port of the peer
 * @cable_ns: delay of the cable
 * @cut: the cable is cut (kept on both ends)
 * @host: number of the host
 * @link: physical link as of now
 * @link_at: when it comes, EC_ESC_NEVER: there is no cable that could, or it is there
 * @linked_ns: when it came the last time
 * @open: loop open: frames leave here
 * @auto_closed: the link was lost since a write, a frame or mode "auto" opened the loop;
 *               mode "auto close" keeps it shut then
 * @lost_at: number of the event by which the link was lost the last time, 0: never was
 * @closed_at: and the loop closed
 * @sent: last frame that left here
 * @received: last frame that came here from a master
 */
struct ec_esc_port {
	int peer;
	u8 peer_port;
	u32 cable_ns;
	bool cut;
	u32 host;
	bool link;
	u64 link_at;
	u64 linked_ns;
	bool open;
	bool auto_closed;
	u64 lost_at;
	u64 closed_at;
	struct ec_esc_transit sent;
	struct ec_esc_transit received;
};

/**
 * struct ec_esc_sm - state of one SyncManager behind its register page
 * @page: decoded page
 * @active: enabled, length and start valid
 * @full: mailbox holds data
 * @ecat_lock: byte 0 was accessed by the master and the end is due
 * @pdi_lock: same for the PDI
 * @ecat_buf: buffer the master works on (3-buffer mode), 0..2
 * @pdi_buf: buffer the PDI works on
 * @free_buf: the third buffer
 * @last_buf: last completely written buffer, 3 = none yet
 * @fresh: the third buffer holds newer data than the reader's
 */
struct ec_esc_sm {
	struct ec_sm page;
	bool active;
	bool full;
	bool ecat_lock;
	bool pdi_lock;
	u8 ecat_buf;
	u8 pdi_buf;
	u8 free_buf;
	u8 last_buf;
	bool fresh;
};

/**
 * struct ec_esc_eeprom - EEPROM and its interface
 * @data: content
 * @len: bytes in @data
 * @busy_until: end of the running command, EC_ESC_NEVER: idle
 * @cmd: command that runs, EC_EEP_CMD_* or 0
 * @addr: its word address
 * @wdata: word to write
 * @control: error bits of 0x0502
 * @loaded: the configuration area is good
 * @alias_loaded: 0x0012 was set once
 */
struct ec_esc_eeprom {
	u8 *data;
	size_t len;
	u64 busy_until;
	u16 cmd;
	u32 addr;
	u16 wdata;
	u16 control;
	bool loaded;
	bool alias_loaded;
};

/**
 * struct ec_esc_dc - distributed clock
 * @base_ns: simulation time of the last change of rate
 * @base_local: local time then
 * @base_frac: fraction of it, in 1e-9 ns
 * @slew: phase correction still to be made since then, ns
 * @adj_ppb16: rate correction of the control loop, ppb << 16
 * @diff: filtered time difference, ns << 8
 * @last_diff: difference at the last comparison, ns
 * @last_cmp: local time of the last comparison
 * @have_cmp: the two are valid
 * @dev_ppb16: measured deviation of the period not yet corrected
 * @start: system time of the first SYNC0, of 64 bits even when that has 32
 * @running: SYNC unit is active
 * @implausible: start time was refused
 * @sync_wake: simulation time of the next pulse, EC_ESC_NEVER: none
 * @sync_next: its number, counting SYNC0 from 0
 * @sync_acked: pulses until the PDI last acknowledged SYNC0, SYNC1
 * @latch_status: registers 0x09AE and 0x09AF
 */
struct ec_esc_dc {
	u64 base_ns;
	u64 base_local;
	s32 base_frac;
	s64 slew;
	s64 adj_ppb16;
	s64 diff;
	s64 last_diff;
	u64 last_cmp;
	bool have_cmp;
	s64 dev_ppb16;
	u64 start;
	bool running;
	bool implausible;
	u64 sync_wake;
	u64 sync_next;
	u64 sync_acked[2];
	u8 latch_status[2];
};

/**
 * struct ec_esc_fault - scripted misbehaviour, set by ec_sim_add_fault()
 * @dead: forwards frames, does nothing with them
 * @miss_broadcast: does not see BRD, BWR, BRW
 * @eeprom_busy: 0x0502 stays busy
 * @eeprom_noack: this many accesses end with an acknowledge error, ~0: all
 * @wkc_add: added to every working counter it should increment
 * @al_refuse: AL state (low 4 bits) the application must refuse, 0 = none
 * @al_code: AL status code to refuse with
 * @app_mute: the application answers no mailbox and no AL request
 * @mailbox: enum ec_sim_mailbox_fault
 * @mailbox_code: its @arg2, see enum ec_sim_mailbox_fault
 * @mailbox_after: messages that are still right
 * @eoe: enum ec_sim_eoe_fault
 * @eoe_every: of so many frames it concerns one
 * @damage_ppm: of frames that come to this port, so many of a million are damaged by its cable
 */
struct ec_esc_fault {
	bool dead;
	bool miss_broadcast;
	bool eeprom_busy;
	u32 eeprom_noack;
	s16 wkc_add;
	u8 al_refuse;
	u16 al_code;
	bool app_mute;
	u8 mailbox;
	u32 mailbox_code;
	u32 mailbox_after;
	u8 eoe;
	u32 eoe_every;
	u32 damage_ppm[EC_MAX_PORT];
};

/**
 * struct ec_esc_own - time that a slave has taken for itself since it was added
 * @reads: accesses to its EEPROM
 * @eeprom_ns: time of these
 * @al_ns: time of its changes of state
 * @mbox_ns: time to its mailbox replies
 */
struct ec_esc_own {
	u32 reads;
	u64 eeprom_ns;
	u64 al_ns;
	u64 mbox_ns;
};

#define EC_ESC_NO_SM	0xff

/**
 * struct ec_esc_window - process data that one FMMU maps to one whole SyncManager
 * @logical: first logical byte
 * @len: bytes, 0: there is no such FMMU
 * @phys: start of the SyncManager
 * @sm: its number; EC_ESC_NO_SM: outputs in the registers at 0x0F00
 * @watchdog: a write starts the process data watchdog
 * @bit: bit of the SyncManager in masks
 * @event: and in 0x0210
 * @irq: events in 0x0220 that an access sets
 * @clear: and those that an access of the PDI clears
 * @s: the SyncManager
 * @mem: its first buffer, or the registers
 */
struct ec_esc_window {
	u32 logical;
	u16 len;
	u16 phys;
	u8 sm;
	bool watchdog;
	u16 bit;
	u16 event;
	u32 irq;
	u32 clear;
	struct ec_esc_sm *s;
	u8 *mem;
};

/**
 * struct ec_esc_quick - what spares a frame the long way through the registers
 * @known: the rest is up to date; ec_esc_quick_update() makes it so
 * @data: @in and @out may be accessed the short way
 * @time: so may the system time, 0x0910
 * @bcast: so may broadcast reads of plain registers
 * @in: window of the inputs
 * @out: window of the outputs
 * @others: there are other FMMUs
 * @other_first: lowest logical byte of all other FMMUs
 * @other_last: highest one
 * @wd_ns: time of the process data watchdog
 */
struct ec_esc_quick {
	bool known;
	bool data;
	bool time;
	bool bcast;
	struct ec_esc_window in;
	struct ec_esc_window out;
	bool others;
	u32 other_first;
	u32 other_last;
	u64 wd_ns;
};

/**
 * struct ec_esc_late - an application to which process data are reported late
 * @on: frames only note in ec_esc.pend what they did; ec_esc_settle() reports it
 * @out: the application has outputs
 * @in_len: bytes of its inputs, 0: none
 * @image: these inputs; they stay the same
 * @stale: outputs were fetched in its name, but it does not know them
 * @ran_ns: when the inputs were computed last
 * @frame: number of the frame that was noted
 *
 * For an application that does nothing but fetch its outputs and hand over
 * the same inputs again. When the next frame comes and no caller has looked, what
 * it would have done to the SyncManagers is made up for, and it is not called.
 */
struct ec_esc_late {
	bool on;
	bool out;
	bool stale;
	u16 in_len;
	const u8 *image;
	u64 ran_ns;
	u64 frame;
};

/**
 * struct ec_esc - one slave controller
 * @sim: segment it belongs to
 * @index: its number in the segment, in the order of ec_sim_add()
 * @cfg: as built
 * @powered: power is on
 * @mem: registers and RAM, EC_REG_RAM + ram_kib * 1024 bytes
 * @mem_len: bytes in @mem
 * @port: the ports
 * @sm: SyncManager state
 * @fmmu: decoded FMMU pages
 * @ecat_event: 0x0210
 * @al_event: 0x0220
 * @eep: EEPROM
 * @dc: clock
 * @fault: scripted misbehaviour
 * @own: its own time
 * @al_unread: AL control was written and not yet read by the PDI
 * @emulation: device emulation: AL status follows AL control
 * @wd_due: time at which the process data watchdog expires
 * @wd_pdi_due: time at which the PDI watchdog expires
 * @wd_pdi_expired: it has, and the PDI was not accessed since
 * @loop_restore: time at which temporary loop settings end
 * @loop_saved: loop settings to restore
 * @link_wake: when the next link comes
 * @loop_frame: last frame that changed loops by a write
 * @loop_before: ports that were open before it
 * @reset_step: letters of the reset sequence seen
 * @open_regs: last frame that opened the protected registers, 0: none
 * @open_all: last frame that opened the whole controller
 * @armw_reads: ARMW that have read from this slave
 * @app: private to the application side
 * @app_ops: its entry points, may be NULL
 * @app_wake_ns: next time @poll is wanted, EC_ESC_NEVER = not; set it with
 *               ec_esc_wake_at()
 * @quick: short ways
 * @late: reports to the application may be late
 * @sms_active: bit n: SM n is active
 * @fmmus_active: bit n: FMMU n is enabled and maps something
 * @log_first: lowest logical byte address mapped
 * @log_last: highest logical byte address mapped
 * @irq: an unmasked ECAT event is pending
 * @pend: what to report to the application when the frame has passed
 * @pend_ns: and at what time
 * @pend_next: next slave with something to report, -1 end, -2 not in the list
 * @key: lower bound of the time of the next event
 * @heap_pos: where the slave stands in the event heap
 * @route_pos: step number on the way from master port 0 and 1, -1 none
 * @route_recv_ns: arrival times while a route is computed
 * @route_mask: the ports they are valid for
 */
struct ec_esc {
	struct ec_sim *sim;
	int index;
	struct ec_esc_config cfg;
	bool powered;
	u8 *mem;
	size_t mem_len;
	struct ec_esc_port port[EC_MAX_PORT];
	struct ec_esc_sm sm[EC_MAX_SM];
	struct ec_fmmu fmmu[EC_MAX_FMMU];
	u16 ecat_event;
	u32 al_event;
	struct ec_esc_eeprom eep;
	struct ec_esc_dc dc;
	struct ec_esc_fault fault;
	struct ec_esc_own own;
	bool al_unread;
	bool emulation;
	u64 wd_due;
	u64 wd_pdi_due;
	bool wd_pdi_expired;
	u64 loop_restore;
	u64 link_wake;
	u8 loop_saved;
	u64 loop_frame;
	u8 loop_before;
	u8 reset_step;
	u64 open_regs;
	u64 open_all;
	u32 armw_reads;
	void *app;
	const struct ec_esc_app_ops *app_ops;
	u64 app_wake_ns;

	/* private to the model */
	struct ec_esc_quick quick;
	struct ec_esc_late late;
	u16 sms_active;
	u16 fmmus_active;
	u32 log_first;
	u32 log_last;
	bool irq;
	struct {
		bool al_control;
		bool eeprom;
		u16 sm_written;
		u16 sm_read;
		u16 sm_activate;
	} pend;
	u64 pend_ns;
	int pend_next;
	u64 key;
	u32 heap_pos;
	s32 route_pos[2];
	u32 route_recv_ns[EC_MAX_PORT];
	u8 route_mask;
};

/**
 * struct ec_frame_ctx - where and when a frame meets a slave
 * @now: first bit arrives at the processing unit, ns
 * @end: last bit has arrived; the application hears of it then
 * @recv: arrival time per port, for the latch of 0x0900
 * @recv_mask: ports at which the frame comes in
 */
struct ec_frame_ctx {
	u64 now;
	u64 end;
	u64 recv[EC_MAX_PORT];
	u8 recv_mask;
};

void ec_esc_config_init(struct ec_esc_config *cfg);
void ec_esc_dgram(struct ec_esc *esc, struct ec_dgram *d,
		  struct ec_frame_ctx *ctx);

/* the slave CPU's face */
int ec_esc_pdi_read(struct ec_esc *esc, u16 ado, void *buf, size_t len,
		    u64 now);
int ec_esc_pdi_write(struct ec_esc *esc, u16 ado, const void *buf, size_t len,
		     u64 now);
void ec_esc_set_al_status(struct ec_esc *esc, u16 status, u16 code, u64 now);
bool ec_esc_sm_readable(const struct ec_esc *esc, int sm);
bool ec_esc_sm_writable(const struct ec_esc *esc, int sm);
void ec_esc_sm_pdi_disable(struct ec_esc *esc, int sm, bool disable);
void ec_esc_old_write(struct ec_esc *esc, u16 ado, const void *buf, size_t len, u64 now);
void ec_esc_wake_at(struct ec_esc *esc, u64 at_ns);
const u8 *ec_esc_pdi_take(struct ec_esc *esc, int sm, u16 len, u64 now);
u8 *ec_esc_pdi_give(struct ec_esc *esc, int sm, u16 len, u64 now);
bool ec_esc_pdi_may_wait(struct ec_esc *esc, int out_sm, u16 out_len, int in_sm,
			 u16 in_len, const u8 *image);
void ec_esc_settle(struct ec_esc *esc);

/* looking inside, for tests and for the application side */
u64 ec_esc_local_time(const struct ec_esc *esc, u64 now);
u64 ec_esc_system_time(const struct ec_esc *esc, u64 now);
bool ec_esc_dc_sync_ran(const struct ec_esc *esc, u64 now);
void ec_esc_dc_jump(struct ec_esc *esc, s64 by, u64 now);
void ec_esc_latch(struct ec_esc *esc, int channel, bool rising, u64 now);
u8 ec_esc_eeprom_crc(const u8 *data);

#endif
