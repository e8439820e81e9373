/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The application side of simulated slaves: AL state machine, mailbox, object
 * dictionary, process data, device profiles. A device is described by constant
 * tables (struct ec_app_dev), a model is built from them once (EEPROM image,
 * object dictionary) and shared by all slaves of that kind, an application is
 * what one slave has of its own. Memory is taken while the segment is built,
 * never afterwards.
 */
#ifndef EC_SIM_APP_H
#define EC_SIM_APP_H

#include "../../master/wire/al.h"
#include "../../master/wire/diag.h"
#include "../../master/wire/eoe_frame.h"
#include "../../master/wire/foe.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"
#include "app_dev.h"
#include "codes.h"
#include "mbox_encode.h"
#include "sdo_server.h"
#include "sdoinfo_server.h"
#include "sii_build.h"
#include "sim.h"

/**
 * struct ec_app_model - a kind of slave, built once and shared
 * @sim: segment whose memory it uses
 * @refs: users
 * @dev: table it was made from (a copy, with the parameters applied)
 * @params: the parameters, to find it again
 * @table: the catalogue's table, to find it again; NULL: from a file
 * @blocks: chain of all its memory
 * @entries: dictionary entries by index and subindex
 * @n_entries: how many
 * @objects: dictionary objects
 * @n_objects: how many
 * @defaults: data of a slave at power-on
 * @data_len: bytes in it
 * @chan: entries which are channels, by number - 1
 * @n_chan: how many per direction
 * @map_cap: largest number of mapped entries per direction
 * @max_bytes: largest process image of a SyncManager per direction
 * @n_areas: SyncManagers of process data per direction
 * @area: their numbers
 * @emulation: device emulation: no AL software
 * @eeprom: image without alias and serial number
 * @eeprom_len: bytes in it
 */
struct ec_app_model {
	struct ec_sim *sim;
	u32 refs;
	struct ec_app_dev dev;
	struct ec_app_params params;
	const struct ec_app_dev *table;
	struct ec_app_block *blocks;
	struct ec_app_entry *entries;
	u32 n_entries;
	struct ec_app_object *objects;
	u32 n_objects;
	u8 *defaults;
	u32 data_len;
	const struct ec_app_entry **chan[EC_APP_DIRS];
	u16 n_chan[EC_APP_DIRS];
	u32 map_cap[EC_APP_DIRS];
	u16 max_bytes[EC_APP_DIRS];
	u8 n_areas[EC_APP_DIRS];
	u8 area[EC_APP_DIRS][EC_APP_SMS];
	bool emulation;
	u8 *eeprom;
	size_t eeprom_len;
};

/**
 * ec_app_area() - which process data does a SyncManager have
 * @m: model
 * @dir: outputs or inputs
 * @sm: SyncManager
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its number among those of the direction, -1: it is none of them.
 */
static inline int ec_app_area(const struct ec_app_model *m, enum ec_app_dir dir, int sm)
{
	for (int k = 0; k < m->n_areas[dir]; k++)
		if (m->area[dir][k] == sm)
			return k;
	return -1;
}

/* where the value of an input channel comes from */
enum ec_app_source_kind {
	EC_APP_SRC_NONE,
	EC_APP_SRC_CONST,
	EC_APP_SRC_RAMP,
	EC_APP_SRC_SINE,
	EC_APP_SRC_LINK,
};

/**
 * struct ec_app_source - source of an input channel
 * @kind: what it is
 * @offset: value of a constant, middle of sine and ramp
 * @amplitude: of a sine; a ramp runs from @offset to @offset + @amplitude
 * @period_ns: of sine and ramp
 * @from: slave the value is taken from
 * @from_chan: its output channel, from 0
 */
struct ec_app_source {
	enum ec_app_source_kind kind;
	s64 offset;
	s64 amplitude;
	u64 period_ns;
	struct ec_app *from;
	u16 from_chan;
};

/**
 * struct ec_app_copy - a run of bits between process image and dictionary
 * @off: byte in the data of the slave
 * @pos: bit in the image of the SyncManager
 * @bits: how many
 */
struct ec_app_copy {
	u32 off;
	u32 pos;
	u32 bits;
};

/**
 * struct ec_app_voe - an unrequested VoE message
 * @hdr: its header
 * @size: bytes of the vendor
 */
struct ec_app_voe {
	struct ec_voe_hdr hdr;
	u16 size;
};

/**
 * struct ec_app_idn - an IDN of a drive
 * @idn: number
 * @attribute: EC_SOE_ATTR_*
 * @name: text
 * @unit: text, NULL: none
 * @value: of a number, at power-on
 * @min: of a number
 * @max: of a number; 0: no limits and no default value
 * @room: bytes of a list; 0: the drive makes it
 * @text: in the list at power-on
 */
struct ec_app_idn {
	u16 idn;
	u32 attribute;
	const char *name;
	const char *unit;
	u64 value;
	u64 min;
	u64 max;
	u16 room;
	const char *text;
};

/**
 * struct ec_app_soe_message - an SoE message without a request
 * @hdr: its header
 * @size: bytes in it
 * @data: behind the header
 */
struct ec_app_soe_message {
	struct ec_soe_hdr hdr;
	u16 size;
	u8 data[EC_APP_SOE_DATA];
};

/**
 * struct ec_app_soe - SoE server of a slave
 * @drives: how many
 * @values: of all IDNs, drive after drive
 * @writes: values written since power-on
 * @buf: a request or an answer, EC_APP_SOE_BUF bytes
 * @hdr: its header
 * @len: bytes in it
 * @at: of an answer: bytes sent
 * @writing: it is a request that is not complete
 * @left: fragments of it to come
 * @home: when the homing of each drive ends, EC_ESC_NEVER: it does not run
 * @due: the first of these
 * @unasked: messages to send
 * @n_unasked: how many
 */
struct ec_app_soe {
	u8 drives;
	u8 *values;
	u32 writes;
	u8 *buf;
	struct ec_soe_hdr hdr;
	u16 len;
	u16 at;
	bool writing;
	u16 left;
	u64 home[EC_SOE_DRIVES];
	u64 due;
	struct ec_app_soe_message unasked[EC_APP_SOE_UNASKED];
	u8 n_unasked;
};

/**
 * struct ec_app_foe - FoE server of a slave: it keeps one file
 * @flash: the file
 * @cap: bytes at @flash
 * @size: bytes of the file
 * @valid: there is one; a write makes it invalid until its end
 * @name: of the file
 * @name_len: bytes of it
 * @opcode: of the transfer: EC_FOE_RRQ, EC_FOE_WRQ, 0: none
 * @packet: number of the last DATA
 * @at: read: where its data are; write: bytes so far
 * @n: read: its bytes
 * @busy: BUSY answers after each page of flash
 * @left: of these, for the present page
 * @page_ns: time to write a page
 * @ready: when the present page is written
 * @header: a file that is written must begin with it
 * @header_len: bytes of it
 * @boot: files are written in BOOT only
 * @password: of the last request
 * @writes: files written since power-on
 */
struct ec_app_foe {
	u8 *flash;
	u32 cap;
	u32 size;
	bool valid;
	char name[EC_APP_FOE_NAME];
	u8 name_len;
	u8 opcode;
	u32 packet;
	u32 at;
	u16 n;
	u8 busy;
	u8 left;
	u64 page_ns;
	u64 ready;
	char header[EC_APP_FOE_HEADER];
	u8 header_len;
	bool boot;
	u32 password;
	u32 writes;
};

/**
 * struct ec_app_mbox - mailbox of a slave
 * @srv: SDO server
 * @cap: bytes of each of the buffers
 * @rx: message from the master
 * @out: message that lies in SM1 or goes there next
 * @last: message the master read before, for a repeat request
 * @out_len: bytes in @out, 0: none
 * @last_len: bytes in @last
 * @out_due: when @out is ready
 * @out_in_sm: @out lies in SM1
 * @out_wrong: a scripted fault concerns @out
 * @out_again: @out has been sent before
 * @now: when the message in @rx was taken
 * @rx_waits: SM0 is full and not fetched, @out is occupied
 * @rx_counter: counter of the last message accepted, 0: none yet
 * @tx_counter: counter of the last message sent
 * @toggle: the last repeat request that was seen
 * @writes: SDO downloads executed
 * @emcy: emergencies to send, 8 bytes each
 * @n_emcy: how many
 * @voe: VoE messages to send
 * @n_voe: how many
 * @info: SDO information on its way out
 * @info_buf: its body
 * @info_cap: bytes there
 */
struct ec_app_mbox {
	struct ec_sdo_srv srv;
	u16 cap;
	u8 *rx;
	u8 *out;
	u8 *last;
	u16 out_len;
	u16 last_len;
	u64 out_due;
	bool out_in_sm;
	bool out_wrong;
	bool out_again;
	u64 now;
	bool rx_waits;
	u8 rx_counter;
	u8 tx_counter;
	u32 writes;
	bool toggle;
	u8 emcy[EC_APP_EMCY][8];
	u8 n_emcy;
	struct ec_app_voe voe[EC_APP_VOE];
	u8 n_voe;
	struct ec_sdoinfo_resp info;
	u8 *info_buf;
	u16 info_cap;
};

/**
 * struct ec_app_ip - IP parameters of a slave that speaks EoE
 * @now: what it was given since power-on
 * @sets: how often
 * @refuse: it does not support IP
 * @packed: absent fields have no place, in requests and in its answers
 * @mute: it does not answer requests to get them
 */
struct ec_app_ip {
	struct ec_eoe_ip now;
	u32 sets;
	bool refuse;
	bool packed;
	bool mute;
};

/**
 * struct ec_app_event - a message the script asks for
 * @next: later one
 * @at_ns: when
 * @type: enum ec_mbox_type: CoE: @emcy, VoE: @voe, SoE: @soe
 * @emcy: emergency: error code, error register, five bytes
 * @voe: VoE message
 * @soe: SoE message
 */
struct ec_app_event {
	struct ec_app_event *next;
	u64 at_ns;
	u8 type;
	u8 emcy[8];
	struct ec_app_voe voe;
	struct ec_app_soe_message soe;
};

/**
 * struct ec_app - application of one slave
 * @esc: its controller
 * @model: what it is
 * @name: its name
 * @serial: number in object 0x1018
 * @transition_ns: time a state change takes
 * @step_ns: and a step towards OP
 * @no_ack: only INIT clears its error indication
 * @own_eeprom: no PREOP unless the EEPROM is assigned to it
 * @response_ns: time from mailbox request to response
 * @op_timeout_ns: how long it waits for outputs and SYNC signals on the way to OP
 * @id_ns: time from the request of its identification to the answer
 * @data: values of the dictionary
 * @sdo_buf: for the SDO server
 * @state: AL state
 * @error: error indication
 * @code: AL status code
 * @identify: the identification is requested
 * @id_due: when it is shown, EC_ESC_NEVER: it is, or nothing is requested
 * @al_to: state on the way, 0: none
 * @al_due: when it is reached
 * @al_deadline: when the wait for outputs ends
 * @al_waits: waits for outputs
 * @outputs_seen: SyncManagers (bits, by area) whose outputs came since SAFEOP
 * @map: runs of mapped entries
 * @n_map: how many
 * @map_end: how many up to the end of each area
 * @bytes: size of the process image
 * @area_bytes: the same of each area
 * @image: scratch for it
 * @inputs: the inputs of an application that never changes them
 * @src: sources of the input channels
 * @n_src: how many channels have one
 * @is_source: an output of it is wired to an input
 * @events: script
 * @next_event: next of it
 * @profile: private memory of the profile
 * @eep_due: when it answers for the emulated EEPROM
 * @mbox: mailbox
 * @soe: SoE server
 * @foe: FoE server
 * @ip: IP parameters
 * @eoe: Ethernet frames, NULL: it takes none
 */
struct ec_app {
	struct ec_esc *esc;
	struct ec_app_model *model;
	char name[EC_APP_NAME];
	u32 serial;
	u64 transition_ns;
	u64 step_ns[EC_APP_STEPS];
	bool no_ack;
	bool own_eeprom;
	u64 response_ns;
	u64 op_timeout_ns;
	u64 id_ns;
	u8 *data;
	u8 *sdo_buf;
	u8 state;
	bool error;
	u16 code;
	bool identify;
	u64 id_due;
	u8 al_to;
	u64 al_due;
	u64 al_deadline;
	bool al_waits;
	u16 outputs_seen;
	struct ec_app_copy *map[EC_APP_DIRS];
	u32 n_map[EC_APP_DIRS];
	u32 map_end[EC_APP_DIRS][EC_APP_SMS];
	u16 bytes[EC_APP_DIRS];
	u16 area_bytes[EC_APP_DIRS][EC_APP_SMS];
	u8 *image;
	u8 *inputs;
	struct ec_app_source *src;
	u16 n_src;
	bool is_source;
	struct ec_app_event *events;
	struct ec_app_event *next_event;
	void *profile;
	u64 eep_due;
	struct ec_app_mbox mbox;
	struct ec_app_soe soe;
	struct ec_app_foe foe;
	struct ec_app_ip ip;
	struct ec_app_eoe *eoe;
};

/**
 * struct ec_app_config - what one slave differs in from its model
 * @name: its name
 * @alias: station alias
 * @serial: serial number
 * @transition_ns: time a state change takes
 * @step_ns: and a step towards OP
 * @no_ack: only INIT clears its error indication
 * @own_eeprom: no PREOP unless the EEPROM is assigned to it
 * @no_lrw: its controller does not process LRW
 * @no_frmw: its controller does not process FRMW
 * @loops_fixed: its controller does not keep what is written to 0x0101
 * @link_ns: time from cable and power to a link
 * @response_ns: time from mailbox request to response
 * @op_timeout_ns: time limit from SAFEOP to OP
 * @id_ns: time from the request of its identification to the answer
 * @process_ns: delay through the controller, 0: default
 * @drift_ppb: error of its clock
 * @clock_start: its clock at power-on
 * @eeprom_emulated: its CPU stands in for the EEPROM
 * @no_ip: its EoE does not support IP
 * @ip_packed: absent IP parameters have no place in messages
 * @ip_mute: it does not answer requests to get IP parameters
 * @foe_busy: BUSY answers of its FoE after each page of flash
 * @foe_page_ns: its FoE is busy for so long after each page of flash
 * @foe_header: file content its FoE accepts begins with it, not terminated
 * @foe_header_len: bytes of it
 * @foe_boot: its FoE accepts files in BOOT only
 * @clock_bits: of its clock, 64, 32, EC_APP_CLOCK_DELAY (receive times only) or
 *	EC_APP_NO_CLOCK; 0: as the model
 */
struct ec_app_config {
	const char *name;
	u16 alias;
	u32 serial;
	u64 transition_ns;
	u64 step_ns[EC_APP_STEPS];
	bool no_ack;
	bool own_eeprom;
	bool no_lrw;
	bool no_frmw;
	bool loops_fixed;
	u32 link_ns;
	u64 response_ns;
	u64 op_timeout_ns;
	u64 id_ns;
	u32 process_ns;
	s32 drift_ppb;
	u64 clock_start;
	bool eeprom_emulated;
	bool no_ip;
	bool ip_packed;
	bool ip_mute;
	u8 foe_busy;
	u64 foe_page_ns;
	const char *foe_header;
	u8 foe_header_len;
	bool foe_boot;
	u8 clock_bits;
};

#define EC_APP_NO_CLOCK	1
#define EC_APP_CLOCK_DELAY	2
#define EC_APP_OP_TIMEOUT	9000000000ULL	/* as the common slave stack has it */

/* slave_app.c */
struct ec_app *ec_app_add(struct ec_sim *sim, struct ec_app_model *model,
			  const struct ec_app_config *cfg);
struct ec_app *ec_app_of(const struct ec_esc *esc);
u8 ec_app_state(const struct ec_app *app);
void ec_app_rewake(struct ec_app *app, u64 now);
int ec_app_add_event(struct ec_app *app, const struct ec_app_event *event);

/* slave_model.c */
struct ec_app_model *ec_app_model_new(struct ec_sim *sim,
				      const struct ec_app_dev *dev,
				      const struct ec_app_params *params,
				      int *err);
struct ec_app_model *ec_app_model_file(struct ec_sim *sim, const u8 *eeprom,
				       size_t len,
				       const struct ec_app_params *params,
				       int *err);
void ec_app_model_put(struct ec_app_model *model);
void *ec_app_model_alloc(struct ec_app_model *model, size_t bytes);

/* slave_old.c */
void ec_app_old(struct ec_app *app, const struct ec_sim_fault *f, u64 now);

/* slave_al.c */
void ec_app_al_reset(struct ec_app *app, u64 now);
bool ec_app_al_legal(u8 from, u8 to);
void ec_app_al_control(struct ec_app *app, u64 now);
void ec_app_al_poll(struct ec_app *app, u64 now);
void ec_app_al_old(struct ec_app *app, u8 state, u64 now);
void ec_app_al_fail(struct ec_app *app, u8 state, u16 code, u64 now);
void ec_app_al_outputs(struct ec_app *app, u64 now);

/* slave_memory.c */
void ec_app_memory_command(struct ec_app *app, u64 now);
void ec_app_memory_poll(struct ec_app *app, u64 now);

/* slave_mbox.c */
void ec_app_mbox_reset(struct ec_app *app);
void ec_app_mbox_written(struct ec_app *app, u64 now);
void ec_app_mbox_read(struct ec_app *app, u64 now);
void ec_app_mbox_activate(struct ec_app *app, u64 now);
void ec_app_mbox_poll(struct ec_app *app, u64 now);
u64 ec_app_mbox_due(const struct ec_app *app);
void ec_app_emergency(struct ec_app *app, u16 code, u8 reg, const u8 data[5],
		      u64 now);
void ec_app_voe_send(struct ec_app *app, const struct ec_app_voe *voe, u64 now);

static inline bool ec_app_bug(const struct ec_app *app, enum ec_sim_bug bug)
{
	return ec_sim_has_bug(app->esc->sim, bug);
}

/* mbox_fault.c */
u64 ec_app_mbox_late(const struct ec_app *app);
bool ec_app_mbox_spoil(struct ec_app *app, u16 len);
void ec_app_mbox_sent(struct ec_app *app);

/* soe_idn.c */
const struct ec_app_idn *ec_app_idn(u16 idn);
u16 ec_app_idn_bytes(const struct ec_app_idn *i);
bool ec_app_idn_is_list(const struct ec_app_idn *i);
u16 ec_app_idn_room(const struct ec_app_idn *i);
u8 *ec_app_idn_value(const struct ec_app *app, u8 drive, const struct ec_app_idn *which);
void ec_app_idn_put_text(struct ec_wbuf *w, const char *text);
void ec_app_idn_set_text(const struct ec_app *app, u8 drive, const struct ec_app_idn *i,
			 const char *text);
void ec_app_idn_put_number(struct ec_wbuf *w, const struct ec_app_idn *i, u64 v);
void ec_app_idn_put_value(struct ec_wbuf *w, const struct ec_app *app, u8 drive,
			  const struct ec_app_idn *i);
bool ec_app_idn_is_mappable(enum ec_app_dir dir, u16 idn);
size_t ec_app_soe_bytes(u8 drives);
void ec_app_soe_reset(struct ec_app *app);

/* slave_soe.c, slave_voe.c */
void ec_app_soe_restart(struct ec_app *app);
u64 ec_app_soe_due(const struct ec_app *app);
void ec_app_soe_poll(struct ec_app *app, u64 now);
int ec_app_soe_next(struct ec_app *app, u8 *tx, size_t cap);
int ec_app_soe_unasked(struct ec_app *app, u8 *tx, size_t cap);
void ec_app_soe_error(struct ec_app *app, u8 drive, u16 error);
void ec_app_soe_send(struct ec_app *app, const struct ec_app_soe_message *m, u64 now);
int ec_app_soe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap);
int ec_app_voe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap);
int ec_app_voe_unasked(const struct ec_app_voe *m, u8 *tx, size_t cap);

/* slave_foe.c */
u32 ec_app_foe_bytes(const struct ec_app_model *m);
void ec_app_foe_reset(struct ec_app *app);
int ec_app_foe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap);

/* slave_eoe.c */
int ec_app_eoe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap);

/* eoe_queue.c, eoe_fault.c */
size_t ec_app_eoe_bytes(const struct ec_app_model *m);
void ec_app_eoe_init(struct ec_app *app);
void ec_app_eoe_reset(struct ec_app *app);
int ec_app_eoe_fragment(struct ec_app *app, const u8 *rx, size_t len);
bool ec_app_eoe_waits(const struct ec_app *app);
bool ec_app_eoe_turn(struct ec_app *app, bool request);
int ec_app_eoe_next(struct ec_app *app, u8 *tx, size_t cap, u64 now);
void ec_app_eoe_poll(struct ec_app *app, u64 now);
u64 ec_app_eoe_due(const struct ec_app *app);
void ec_app_eoe_fault(struct ec_app *app, u64 now);
bool ec_app_eoe_runs(const struct ec_app *app);

/* eoe_port.c */
bool ec_app_eoe_has_port(const struct ec_app *app);
u16 ec_app_eoe_leave(struct ec_app *app, u8 *frame);
bool ec_app_eoe_takes(const struct ec_app *app);
void ec_app_eoe_enter(struct ec_app *app, const u8 *frame, u16 len, u64 now);

/* slave_od.c */
const struct ec_app_object *ec_app_od_object(const struct ec_app_model *m, u16 index);
const struct ec_app_entry *ec_app_od_entry(const struct ec_app_model *m, u16 index,
				      u8 sub);
u64 ec_app_od_get(const struct ec_app *app, const struct ec_app_entry *e);
s64 ec_app_od_get_signed(const struct ec_app *app, const struct ec_app_entry *e);
void ec_app_od_set(struct ec_app *app, const struct ec_app_entry *e, u64 value);
u32 ec_app_od_read(struct ec_app *app, u16 index, u8 sub, bool complete, u8 *buf,
	       size_t cap, size_t *len);
u32 ec_app_od_write(struct ec_app *app, u16 index, u8 sub, bool complete,
		const u8 *buf, size_t len);
bool ec_app_od_in_list(const struct ec_app_model *m,
		       const struct ec_app_object *o, u16 list);
size_t ec_app_od_name(const struct ec_app_model *m,
		      const struct ec_app_entry *e, char buf[24],
		      const char **name);

/* slave_od_values.c */
void ec_app_od_values(const struct ec_app_model *m, const struct ec_app_entry *e, u8 info,
		      struct ec_app_od_values *v);

/* slave_diag.c */
void ec_app_diag_reset(struct ec_app *app, u64 now);
void ec_app_diag_al(struct ec_app *app, u16 code, u64 now);
void ec_app_diag_emergency(struct ec_app *app, u16 code, u8 reg, u64 now);
u32 ec_app_diag_write(struct ec_app *app, const u8 *data, size_t len);

/* slave_pdo.c */
bool ec_app_outputs_complete(const struct ec_app *app);
u16 ec_app_pdo_build(struct ec_app *app);
u32 ec_app_pdo_check_write(const struct ec_app *app,
			   const struct ec_app_entry *e, u64 value);
void ec_app_set_source(struct ec_app *app, u16 chan, const struct ec_app_source *src);
void ec_app_outputs_use(struct ec_app *app, const u8 *image);
void ec_app_may_wait(struct ec_app *app);
bool ec_app_pdo_is_config(u16 index);
void ec_app_outputs(struct ec_app *app, int sm, u64 now);
void ec_app_outputs_clear(struct ec_app *app);
void ec_app_inputs(struct ec_app *app, u64 now);
void ec_app_run(struct ec_app *app, u64 now);
s64 ec_app_channel(struct ec_app *app, enum ec_app_dir dir, u16 chan);

/* catalogue.c */
const struct ec_app_dev *ec_app_catalogue(const char *name, size_t len);
const struct ec_app_dev *ec_app_catalogue_at(u32 n);

/* profile_io.c */
s64 ec_app_source_value(const struct ec_app_source *src, u64 now);

#endif
