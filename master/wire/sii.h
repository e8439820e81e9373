/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * Slave information interface: the content of a slave's EEPROM
 * (ETG.1000.6 clause 5.4, ETG.2010). Decoders work on a whole image in memory
 * and believe nothing in it; the builder writes an image into a caller buffer.
 */
#ifndef EC_WIRE_SII_H
#define EC_WIRE_SII_H

#include "buf.h"

#define EC_SII_FIXED_SIZE	128	/* bytes before the first category */
#define EC_SII_HEAD		32	/* the first of them: checksum, identity, serial number */
#define EC_SII_MAX_SIZE		(512 * 1024)	/* what is beyond is not read */
#define EC_SII_MAX_CATS		256
#define EC_SII_CAT_HDR		4

/* word addresses of the fixed area */
#define EC_SII_W_PDI_CONTROL	0x00
#define EC_SII_W_ALIAS		0x04
#define EC_SII_W_CHECKSUM	0x07
#define EC_SII_W_VENDOR		0x08
#define EC_SII_W_PRODUCT	0x0A
#define EC_SII_W_REVISION	0x0C
#define EC_SII_W_SERIAL		0x0E
#define EC_SII_W_BOOT_MBOX	0x14
#define EC_SII_W_STD_MBOX	0x18
#define EC_SII_W_PROTOCOLS	0x1C
#define EC_SII_W_SIZE		0x3E
#define EC_SII_W_VERSION	0x3F
#define EC_SII_W_CATEGORIES	0x40

#define EC_SII_PDI_EMULATION	BIT(8)	/* of word 0: no software answers */

/* word 0x1C */
#define EC_SII_PROTO_AOE	BIT(0)
#define EC_SII_PROTO_EOE	BIT(1)
#define EC_SII_PROTO_COE	BIT(2)
#define EC_SII_PROTO_FOE	BIT(3)
#define EC_SII_PROTO_SOE	BIT(4)
#define EC_SII_PROTO_VOE	BIT(5)

/* category types */
#define EC_SII_CAT_NOP		0
#define EC_SII_CAT_STRINGS	10
#define EC_SII_CAT_DATA_TYPES	20
#define EC_SII_CAT_GENERAL	30
#define EC_SII_CAT_FMMU		40
#define EC_SII_CAT_SM		41
#define EC_SII_CAT_FMMU_EXT	42
#define EC_SII_CAT_SYNC_UNIT	43
#define EC_SII_CAT_TXPDO	50	/* inputs to the master */
#define EC_SII_CAT_RXPDO	51	/* outputs from the master */
#define EC_SII_CAT_DC		60
#define EC_SII_CAT_END		0xFFFF

/* general category, CoE details */
#define EC_SII_COE_SDO		BIT(0)
#define EC_SII_COE_SDO_INFO	BIT(1)
#define EC_SII_COE_PDO_ASSIGN	BIT(2)
#define EC_SII_COE_PDO_CONFIG	BIT(3)
#define EC_SII_COE_PDO_UPLOAD	BIT(4)
#define EC_SII_COE_COMPLETE	BIT(5)

/* general category, flags */
#define EC_SII_FLAG_SAFEOP	BIT(0)
#define EC_SII_FLAG_NO_LRW	BIT(1)
#define EC_SII_FLAG_MBOX_DLL	BIT(2)	/* repeat mechanism */
#define EC_SII_FLAG_ID_AL	BIT(3)	/* identification by 0x0134 */
#define EC_SII_FLAG_ID_MEM	BIT(4)	/* identification at id_address */

/* FMMU category */
#define EC_SII_FMMU_UNUSED	0x00
#define EC_SII_FMMU_OUTPUTS	0x01
#define EC_SII_FMMU_INPUTS	0x02
#define EC_SII_FMMU_SM_STATUS	0x03

/* SyncManager category, enable byte and type */
#define EC_SII_SM_ENABLE	BIT(0)
#define EC_SII_SM_FIXED		BIT(1)
#define EC_SII_SM_VIRTUAL	BIT(2)
#define EC_SII_SM_OP_ONLY	BIT(3)
#define EC_SII_SM_UNUSED	0
#define EC_SII_SM_MBOX_OUT	1
#define EC_SII_SM_MBOX_IN	2
#define EC_SII_SM_OUTPUTS	3
#define EC_SII_SM_INPUTS	4

#define EC_SII_PDO_NO_SM	0xFF

/* bytes of a general category, and of each entry of the others */
#define EC_SII_GENERAL_BYTES	32
#define EC_SII_PDO_BYTES	8
#define EC_SII_SM_BYTES		8
#define EC_SII_DC_BYTES		24

/**
 * struct ec_sii_mbox - mailbox areas, seen from the slave
 * @rx_offset: physical address of the mailbox the master writes (SM0)
 * @rx_size: bytes, 0: none
 * @tx_offset: physical address of the mailbox the master reads (SM1)
 * @tx_size: bytes, 0: none
 */
struct ec_sii_mbox {
	u16 rx_offset;
	u16 rx_size;
	u16 tx_offset;
	u16 tx_size;
};

/**
 * struct ec_sii_info - the fixed area, words 0x00 to 0x3F
 * @pdi_control: word 0; bit 8: device emulation
 * @pdi_config: word 1
 * @sync_impulse: word 2, unit 10 ns
 * @pdi_config2: word 3
 * @alias: configured station alias
 * @reserved: words 5 and 6, covered by the checksum
 * @checksum: as stored
 * @checksum_calc: as computed; builders ignore both and write the right one
 * @checksum_ok: they are equal
 * @vendor: vendor id
 * @product: product code
 * @revision: revision number
 * @serial: serial number, 0: none
 * @boot: mailboxes in BOOT
 * @std: mailboxes in PREOP and above
 * @protocols: EC_SII_PROTO_*
 * @size_kbit: EEPROM size in KiBit as the image says; a hint, often wrong
 * @version: 1
 */
struct ec_sii_info {
	u16 pdi_control;
	u16 pdi_config;
	u16 sync_impulse;
	u16 pdi_config2;
	u16 alias;
	u16 reserved[2];
	u8 checksum;
	u8 checksum_calc;
	bool checksum_ok;
	u32 vendor;
	u32 product;
	u32 revision;
	u32 serial;
	struct ec_sii_mbox boot;
	struct ec_sii_mbox std;
	u16 protocols;
	u32 size_kbit;
	u16 version;
};

/**
 * struct ec_sii_cat - one category
 * @type: EC_SII_CAT_* or a vendor's own
 * @words: size of the data
 * @offset: byte offset of the category header in the image
 * @data: data, in the image
 * @bytes: 2 * @words
 */
struct ec_sii_cat {
	u16 type;
	u16 words;
	size_t offset;
	const u8 *data;
	size_t bytes;
};

/**
 * struct ec_sii_iter - walk over the categories of an image
 * @img: image
 * @len: bytes at @img
 * @pos: byte offset of the next category header
 * @count: categories so far
 * @blank: empty NOP categories in a row
 * @end: 1 while walking, then what every further call returns
 */
struct ec_sii_iter {
	const u8 *img;
	size_t len;
	size_t pos;
	unsigned int count;
	unsigned int blank;
	int end;
};

/**
 * struct ec_sii_general - category 30
 * @group: string index of the group type
 * @image: string index of the image name
 * @order: string index of the order number
 * @name: string index of the device name
 * @coe: EC_SII_COE_*
 * @foe: bit 0: FoE enabled
 * @eoe: bit 0: EoE enabled
 * @soe_channels: SoE channels
 * @ds402_channels: DS402 channels
 * @sysman_class: reserved
 * @flags: EC_SII_FLAG_*
 * @current_ma: current drawn from E-bus, negative: fed into it
 * @group_name: string index of the group name
 * @ports: physical port types, 4 bits per port (1 MII, 3 E-bus, 4 fast hot connect)
 * @id_address: address of the ID selector, with EC_SII_FLAG_ID_MEM
 */
struct ec_sii_general {
	u8 group;
	u8 image;
	u8 order;
	u8 name;
	u8 coe;
	u8 foe;
	u8 eoe;
	u8 soe_channels;
	u8 ds402_channels;
	u8 sysman_class;
	u8 flags;
	s16 current_ma;
	u8 group_name;
	u16 ports;
	u16 id_address;
};

/**
 * struct ec_sii_sm - one SyncManager of category 41
 * @start: physical start address
 * @len: default length, 0: from the assigned PDOs
 * @control: control byte for register 0x0804 + 8 * n
 * @status: no meaning
 * @enable: EC_SII_SM_ENABLE...
 * @type: EC_SII_SM_MBOX_OUT...
 */
struct ec_sii_sm {
	u16 start;
	u16 len;
	u8 control;
	u8 status;
	u8 enable;
	u8 type;
};

/**
 * struct ec_sii_pdo - one PDO of category 50 or 51
 * @index: 0x1600... or 0x1A00...
 * @entries: number of entries
 * @sm: default SyncManager, EC_SII_PDO_NO_SM: not assigned
 * @sync: synchronization
 * @name: string index
 * @flags: 0 in most images
 * @entry_data: encoded entries in the image, 8 bytes each; builders ignore it
 */
struct ec_sii_pdo {
	u16 index;
	u8 entries;
	u8 sm;
	u8 sync;
	u8 name;
	u16 flags;
	const u8 *entry_data;
};

/**
 * struct ec_sii_pdo_entry - one entry of a PDO
 * @index: object index, 0: gap
 * @sub: subindex
 * @name: string index
 * @type: CoE data type
 * @bits: length
 * @flags: 0
 */
struct ec_sii_pdo_entry {
	u16 index;
	u8 sub;
	u8 name;
	u8 type;
	u8 bits;
	u16 flags;
};

/**
 * struct ec_sii_pdo_iter - walk over the PDOs of one direction
 * @cats: category walk
 * @type: EC_SII_CAT_TXPDO or EC_SII_CAT_RXPDO
 * @r: rest of the present category
 * @bad: error met inside a category
 */
struct ec_sii_pdo_iter {
	struct ec_sii_iter cats;
	u16 type;
	struct ec_rbuf r;
	int bad;
};

/**
 * struct ec_sii_dc - one operation mode of category 60
 * @cycle0_ns: SYNC0 cycle time, 0: cycle of the master
 * @shift0_ns: SYNC0 shift time
 * @shift1_ns: SYNC1 shift time
 * @factor1: SYNC1 cycle factor
 * @assign: AssignActivate for registers 0x0980, 0x0981
 * @factor0: SYNC0 cycle factor: n > 0: n master cycles, n < 0: cycle / |n|
 * @name: string index of the mode name
 * @desc: string index of the description
 */
struct ec_sii_dc {
	u32 cycle0_ns;
	u32 shift0_ns;
	u32 shift1_ns;
	s16 factor1;
	u16 assign;
	s16 factor0;
	u8 name;
	u8 desc;
};

u8 ec_sii_crc(const u8 *words0_6);
int ec_sii_decode_info(const u8 *img, size_t len, struct ec_sii_info *info);

void ec_sii_iter_init(struct ec_sii_iter *it, const u8 *img, size_t len);
int ec_sii_iter_next(struct ec_sii_iter *it, struct ec_sii_cat *cat);

int ec_sii_needed(const u8 *img, size_t have);
size_t ec_sii_used(const u8 *img, size_t have);

/**
 * enum ec_sii_flaw_kind - what is wrong with an image
 * @EC_SII_FLAW_NONE: nothing
 * @EC_SII_FLAW_BLANK: the fixed area is all ones or all zeros
 * @EC_SII_FLAW_LARGE: a category ends beyond the EEPROM
 * @EC_SII_FLAW_NO_END: there is no end marker
 * @EC_SII_FLAW_BEYOND: the categories end beyond the declared size
 * @EC_SII_FLAW_ENTRY: an entry is longer than its category
 */
enum ec_sii_flaw_kind {
	EC_SII_FLAW_NONE,
	EC_SII_FLAW_BLANK,
	EC_SII_FLAW_LARGE,
	EC_SII_FLAW_NO_END,
	EC_SII_FLAW_BEYOND,
	EC_SII_FLAW_ENTRY,
};

/**
 * struct ec_sii_flaw - a flaw of an image
 * @kind: what it is
 * @type: category, or what a blank image is filled with
 * @offset: of the header of the category, bytes
 * @bytes: data of the category, of a large one
 * @end: where the last category that can be used ends
 * @declared: size by word 0x3E, bytes, at most EC_SII_MAX_SIZE
 */
struct ec_sii_flaw {
	enum ec_sii_flaw_kind kind;
	u16 type;
	size_t offset;
	size_t bytes;
	size_t end;
	size_t declared;
};

enum ec_sii_flaw_kind ec_sii_check(const u8 *img, size_t len, struct ec_sii_flaw *f);

/**
 * enum ec_sii_mbox_doubt - what an image contradicts itself in about the mailbox
 * @EC_SII_MBOX_SURE: nothing
 * @EC_SII_MBOX_NO_PROTOCOL: there is one, and word 0x1C names no protocol
 * @EC_SII_MBOX_NO_WORDS: only category 41 has one
 * @EC_SII_MBOX_DIFFERS: that of category 41 is another one than that of the words
 * @EC_SII_MBOX_NONE: word 0x1C names protocols, and there is none
 */
enum ec_sii_mbox_doubt {
	EC_SII_MBOX_SURE,
	EC_SII_MBOX_NO_PROTOCOL,
	EC_SII_MBOX_NO_WORDS,
	EC_SII_MBOX_DIFFERS,
	EC_SII_MBOX_NONE,
};

bool ec_sii_mbox_of_sms(const struct ec_sii_sm *sm, unsigned int n, struct ec_sii_mbox *m);
enum ec_sii_mbox_doubt ec_sii_settle_mbox(struct ec_sii_info *info, const struct ec_sii_sm *sm,
					  unsigned int n);

int ec_sii_text(char *buf, size_t cap, const u8 *s, size_t len);
int ec_sii_string(const u8 *img, size_t len, u8 index, char *buf, size_t cap);
int ec_sii_decode_general(const u8 *img, size_t len, struct ec_sii_general *g);
int ec_sii_decode_sms(const u8 *img, size_t len, struct ec_sii_sm *sm, unsigned int max);
int ec_sii_decode_dcs(const u8 *img, size_t len, struct ec_sii_dc *dc, unsigned int max);

void ec_sii_pdo_iter_init(struct ec_sii_pdo_iter *it, const u8 *img, size_t len, u16 cat_type);
int ec_sii_pdo_iter_next(struct ec_sii_pdo_iter *it, struct ec_sii_pdo *pdo);
int ec_sii_pdo_entry(const struct ec_sii_pdo *pdo, unsigned int i, struct ec_sii_pdo_entry *e);

#endif
