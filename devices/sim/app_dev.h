/* SPDX-License-Identifier: GPL-2.0-only */
/* Tables of devices, and what a model made of one may differ in. */
#ifndef EC_SIM_APP_DEV_H
#define EC_SIM_APP_DEV_H

#include "../../master/wire/sdoinfo.h"
#include "sim.h"

#define EC_APP_NAME		24	/* name of a slave, with the zero */
#define EC_APP_SDO_BUF		2048	/* largest object, complete access too */
#define EC_APP_EMCY		8	/* emergencies waiting */
#define EC_APP_VOE		4	/* VoE messages waiting */
#define EC_APP_SOE_MAP		8	/* IDNs of a telegram of an axis, besides the word */
#define EC_APP_SOE_LIST		2000	/* bytes of the largest list of a drive */
#define EC_APP_SOE_NO_ERROR	"no error"
#define EC_APP_SOE_NUMBER	0xF0000000u	/* diagnostic number: and the class 1 diagnostic */
#define EC_APP_SOE_BUF		2100	/* largest SoE request or answer, all elements */
#define EC_APP_SOE_UNASKED	4	/* SoE messages without a request, waiting */
#define EC_APP_SOE_DATA		32	/* bytes of one of them */
#define EC_APP_DIAG_MAX		64	/* messages in 0x10F3 */
#define EC_APP_DIAG_BYTES	33	/* of a message there */
#define EC_APP_FOE_KIB		64	/* largest file of a slave without foe= */
#define EC_APP_FOE_NAME		32	/* name of the file */
#define EC_APP_FOE_HEADER	16	/* bytes of a file that are checked, at most */
#define EC_APP_ESC_ET1100	0x11
#define EC_APP_ESC_ET1200	0x12
#define EC_APP_RW		(EC_OD_READ | EC_OD_WRITE)
#define EC_APP_GENERIC_MBOX	256	/* mailbox of a "drive" without mbox= */
#define EC_APP_LIST		16	/* numbers of an option that is a list */
#define EC_APP_SMS		16	/* SyncManagers of a slave */
#define EC_APP_SMS_MAX		7	/* of them for one direction, of a generic device */
#define EC_APP_MAP_CAP		32	/* entries of a mapping object one may write */

/* objects of a modular slave (ETG.5001.1) */
#define EC_APP_MODULAR		0xF000	/* distance of indexes, number of slots */
#define EC_APP_MODULES_SET	0xF030	/* idents by slot that the master expects */
#define EC_APP_MODULES_FOUND	0xF050	/* idents by slot that are there */

struct ec_app;

enum ec_app_dir { EC_APP_OUT, EC_APP_IN, EC_APP_DIRS };

/**
 * enum ec_app_mapping - what the master may change about the process data
 * @EC_APP_MAP_DEFAULT: as the device table says
 * @EC_APP_MAP_FIXED: nothing
 * @EC_APP_MAP_ASSIGN: which PDOs are assigned
 * @EC_APP_MAP_FULL: also what the PDOs consist of, but not of those assigned
 * @EC_APP_MAP_LENIENT: also of those assigned, as many slaves allow it
 */
enum ec_app_mapping {
	EC_APP_MAP_DEFAULT,
	EC_APP_MAP_FIXED,
	EC_APP_MAP_ASSIGN,
	EC_APP_MAP_FULL,
	EC_APP_MAP_LENIENT,
};

/**
 * struct ec_app_var - an object or entry of a device table
 * @index: object
 * @sub: subindex; sub 0 of a record is made by itself
 * @bits: size
 * @type: CoE data type
 * @access: EC_OD_READ_PREOP...
 * @value: at power-on
 * @name: of the entry (of the object where it has only sub 0)
 * @object: of the object, in its first entry; NULL: @name
 */
struct ec_app_var {
	u16 index;
	u8 sub;
	u16 bits;
	u16 type;
	u16 access;
	u32 value;
	const char *name;
	const char *object;
};

/**
 * struct ec_app_pdo_entry - one entry of a PDO
 * @index: object, 0 is a gap
 * @sub: subindex
 * @bits: size
 * @type: CoE data type
 * @chan: it is channel number @chan (from 1) of its direction; 0: no channel
 * @name: of the entry
 * @object: of the object
 */
struct ec_app_pdo_entry {
	u16 index;
	u8 sub;
	u8 bits;
	u16 type;
	u8 chan;
	const char *name;
	const char *object;
};

/**
 * struct ec_app_pdo - one PDO of a device
 * @index: 0x1600.. (outputs), 0x1a00.. (inputs)
 * @sm: SyncManager it is assigned to at power-on, 0xff: none
 * @count: entries
 * @entries: the entries
 * @name: of the PDO
 */
struct ec_app_pdo {
	u16 index;
	u8 sm;
	u16 count;
	const struct ec_app_pdo_entry *entries;
	const char *name;
};

/* SyncManager as in SII category 41 */
struct ec_app_sm {
	u16 start;
	u16 len;
	u8 control;
	u8 enable;
	u8 type;	/* 1, 2 mailbox out, in; 3, 4 outputs, inputs */
};

/* DC operation mode as in SII category 60 */
struct ec_app_dc_mode {
	const char *name;
	u16 assign_activate;
};

/* mailbox areas, word 0x14-0x1b of the SII */
struct ec_app_mbox_area {
	u16 rx;
	u16 rx_len;
	u16 tx;
	u16 tx_len;
};

/**
 * struct ec_app_profile - what a device does between outputs and inputs
 * @size: bytes of private memory per slave
 * @map_cap: entries that @map makes per direction at most
 * @map: lay out the process data, NULL: by PDOs; 0, or the AL status code
 * @init: power was switched on, entries are at their defaults
 * @run: outputs are in the dictionary, compute the inputs for time @now
 */
struct ec_app_profile {
	size_t size;
	u16 map_cap;
	u16 (*map)(struct ec_app *app);
	void (*init)(struct ec_app *app);
	void (*run)(struct ec_app *app, u64 now);
};

extern const struct ec_app_profile ec_app_profile_drive;
extern const struct ec_app_profile ec_app_profile_sercos;

/**
 * struct ec_app_dev - table of a device
 * @name: as written in a segment description, and the order number
 * @title: device name of the SII
 * @group: group of the SII
 * @vendor: identity
 * @product: identity
 * @revision: identity
 * @pdi_control: SII word 0, bit 8: device emulation
 * @pdi_config: SII word 1
 * @boot: bootstrap mailbox, all 0: BOOT not supported
 * @std: standard mailbox, all 0: none
 * @protocols: SII word 0x1c
 * @coe: CoE details of the SII
 * @flags: flags of the SII general category
 * @current_ma: E-bus current, negative feeds
 * @ports: enum ec_port_type per port
 * @esc_type: register 0x0000
 * @features: register 0x0008
 * @dc_delay_only: receive times, but no clock that can be set
 * @fmmus: number of FMMUs
 * @fmmu_use: SII category 40
 * @n_fmmu_use: bytes in it
 * @sms: SyncManagers in use
 * @n_sms: how many
 * @max_bytes: largest process image of a SyncManager per direction, 0: the default one
 * @mapping: what the master may change
 * @pdos: all PDOs
 * @n_pdos: how many
 * @vars: further objects
 * @n_vars: how many
 * @dc: DC modes
 * @n_dc: how many
 * @device_type: object 0x1000
 * @profile: behaviour, NULL: none
 */
struct ec_app_dev {
	const char *name;
	const char *title;
	const char *group;
	u32 vendor;
	u32 product;
	u32 revision;
	u16 pdi_control;
	u16 pdi_config;
	struct ec_app_mbox_area boot;
	struct ec_app_mbox_area std;
	u16 protocols;
	u8 coe;
	u8 flags;
	s16 current_ma;
	u8 ports[EC_MAX_PORT];
	u8 esc_type;
	u16 features;
	bool dc_delay_only;
	u8 fmmus;
	u8 fmmu_use[4];
	u8 n_fmmu_use;
	struct ec_app_sm sms[EC_APP_SMS];
	u8 n_sms;
	u16 max_bytes[EC_APP_DIRS];
	enum ec_app_mapping mapping;
	const struct ec_app_pdo *pdos;
	u16 n_pdos;
	const struct ec_app_var *vars;
	u16 n_vars;
	const struct ec_app_dc_mode *dc;
	u8 n_dc;
	u32 device_type;
	const struct ec_app_profile *profile;
};

/**
 * struct ec_app_entry - entry of an object dictionary
 * @index: object it belongs to
 * @sub: subindex
 * @type: CoE data type
 * @bits: size
 * @access: EC_OD_READ_PREOP...
 * @off: where its value lies in the data of a slave, byte aligned
 * @name: text, NULL: made from the subindex
 */
struct ec_app_entry {
	u16 index;
	u8 sub;
	u16 type;
	u16 bits;
	u16 access;
	u32 off;
	const char *name;
};

/**
 * struct ec_app_object - object of a dictionary
 * @index: number
 * @code: enum ec_od_code
 * @max_sub: largest subindex
 * @type: CoE data type
 * @first: its first entry
 * @count: its entries
 * @name: text
 */
struct ec_app_object {
	u16 index;
	u8 code;
	u8 max_sub;
	u16 type;
	u32 first;
	u16 count;
	const char *name;
};

/**
 * struct ec_app_od_values - optional fields of the description of an entry
 * @v: value info
 * @min: place of the minimum
 * @max: place of the maximum
 */
struct ec_app_od_values {
	struct ec_od_values v;
	u8 min[4];
	u8 max[4];
};

/* numbers of an option; not @given: the device's own */
struct ec_app_list {
	bool given;
	u8 n;
	u16 v[EC_APP_LIST];
};

static inline bool ec_app_listed(const struct ec_app_list *l, u16 v)
{
	for (u32 i = 0; i < l->n; i++)
		if (l->v[i] == v)
			return true;
	return false;
}

/**
 * struct ec_app_quirks - what is unusual in a model
 * @any: something is
 * @no_mbox_words: words 0x18 to 0x1B of its EEPROM are 0, category 41 has the mailbox
 * @no_protocols: word 0x1C of its EEPROM is 0
 * @dc_modes: AssignActivate of its operation modes; no other activation is accepted
 * @fixed: assignments and mappings that cannot be written
 * @n_modules: slots of a modular slave, 0: it is none
 * @modules: idents of the modules in them, 0: empty
 * @sms: generic devices: SyncManagers of a direction, 0: one
 * @assign: PDOs that the first of them has at power-on; may be 0, or PDOs which it has not
 */
struct ec_app_quirks {
	bool any;
	bool no_mbox_words;
	bool no_protocols;
	u8 n_modules;
	u32 modules[EC_APP_LIST];
	u8 sms[EC_APP_DIRS];
	struct ec_app_list dc_modes;
	struct ec_app_list fixed;
	struct ec_app_list assign[EC_APP_DIRS];
};

/* what takes Ethernet frames: nothing, the slave's own IP, an Ethernet port of the slave */
enum ec_app_eoe_kind { EC_APP_EOE_NONE, EC_APP_EOE_HOST, EC_APP_EOE_SWITCH };

/**
 * struct ec_app_params - what a model may differ in from its device table
 * @vendor: identity, 0: as the table
 * @product: identity, 0: as the table
 * @revision: identity, 0: as the table; generic devices: by their layout
 * @out: generic devices: output size (drive: bytes, io: bits)
 * @in: generic devices: input size
 * @mbox: generic devices: mailbox size, 0: the default
 * @mapping: what the master may change
 * @cpu: generic io: with AL software instead of device emulation
 * @id: value of the identification request, 0: not supported
 * @soe: SoE with so many drives, 0: no SoE
 * @voe: VoE with this type in the answers, 0: no VoE
 * @foe: KiB of a file, 0: EC_APP_FOE_KIB where the table or the image has FoE
 * @eoe: what is behind its EoE, enum ec_app_eoe_kind
 * @strict: the SyncManagers of the mailbox must have the usual control bytes, no other
 * @diag: messages in the diagnosis history, 0: there is no 0x10F3
 * @no_repeat: neither repeats its messages nor sees that one of the master is repeated
 * @quirks: what is unusual in it
 */
struct ec_app_params {
	u32 vendor;
	u32 product;
	u32 revision;
	u32 out;
	u32 in;
	u16 mbox;
	enum ec_app_mapping mapping;
	bool cpu;
	u16 id;
	u8 soe;
	u16 voe;
	u16 foe;
	u8 eoe;
	u8 diag;
	bool no_repeat;
	bool strict;
	struct ec_app_quirks quirks;
};

/* steps towards OP, each with its own time */
enum ec_app_step {
	EC_APP_STEP_PREOP,
	EC_APP_STEP_BOOT,
	EC_APP_STEP_SAFEOP,
	EC_APP_STEP_OP,
	EC_APP_STEPS
};

#endif
