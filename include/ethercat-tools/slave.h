/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: slaves, their layout and their registers. */
#ifndef ETHERCAT_TOOLS_SLAVE_H
#define ETHERCAT_TOOLS_SLAVE_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_PORTS	4
#define ECT_DC_WINDOW	1000	/* ns that a clock may differ from the reference clock */

/* struct ect_slave.error */
#define ECT_SLAVE_OK		0
#define ECT_SLAVE_SCAN_FAILED	1
#define ECT_SLAVE_CONFIG_FAILED	2

/* kinds of struct ect_cause; members that a kind does not name are 0 */
#define ECT_CAUSE_NONE		0	/* none, or only in words */
/* the slave of a configuration is absent */
#define ECT_CAUSE_NO_DEVICE	1	/* the master has no network device */
#define ECT_CAUSE_LINK_DOWN	2	/* at the main device */
#define ECT_CAUSE_LOST		3	/* disconnected while active: behind @port of @position */
#define ECT_CAUSE_NO_ALIAS	4	/* no slave has the alias */
#define ECT_CAUSE_NO_SLAVE	5	/* the ring ends before @position */
#define ECT_CAUSE_DIFFERENT	6	/* the slave at @position has another identity */
#define ECT_CAUSE_TAKEN		7	/* the one at @position is that of configuration @code */
#define ECT_CAUSE_UNATTACHED	8	/* the one at @position matches and is not attached yet */
#define ECT_CAUSE_NO_GROUP	9	/* its hot connect group is not connected */
#define ECT_CAUSE_GROUP		10	/* the slave at @position keeps its group from use */
#define ECT_CAUSE_RING		11	/* the ring is open: which slave is at @position? */
/* the slave is connected, and the cause is not in the slave */
#define ECT_CAUSE_INACTIVE	16	/* the application has not activated the master */
#define ECT_CAUSE_REQUESTED	17	/* @state is requested, not OP */
#define ECT_CAUSE_NO_CYCLE	18	/* the application sends no cyclic frames */
#define ECT_CAUSE_UNDER_WAY	19	/* to OP; nothing has failed so far */
/* the slave itself */
#define ECT_CAUSE_SILENT	32	/* no reply, frames pass */
#define ECT_CAUSE_REGISTERS	33	/* no reply to a register, or address not accepted */
#define ECT_CAUSE_EEPROM	34	/* not readable or invalid; @state: then refused */
#define ECT_CAUSE_EEPROM_PART	35	/* large, still being read */
#define ECT_CAUSE_SDO		36	/* startup SDO @object:@subindex, abort @code or 0 */
#define ECT_CAUSE_IDN		37	/* startup IDN @object, drive @subindex, SoE error @code */
#define ECT_CAUSE_REGISTER	38	/* startup register @object */
#define ECT_CAUSE_IP		39	/* IP parameters, EoE result @code */
#define ECT_CAUSE_PDO		40	/* process data of @sm; PDO or list @object, abort @code */
#define ECT_CAUSE_LAYOUT	41	/* it cannot serve the layout of the process data */
#define ECT_CAUSE_SYNC		42	/* SYNC signals */
#define ECT_CAUSE_REFUSED	43	/* @state refused, AL status code @code */
#define ECT_CAUSE_SLOW		44	/* @state not reached in time */
#define ECT_CAUSE_FRAMES	45	/* frames lost before @state */
#define ECT_CAUSE_AL_ERROR	46	/* @state with error, AL status code @code */
#define ECT_CAUSE_MEMORY	47	/* this computer ran out of memory before @state */
#define ECT_CAUSE_MAILBOX	48	/* a warning: sizes and protocols are inconsistent */
#define ECT_CAUSE_ALIAS_TWICE	49	/* a warning: the slave at @position has the same alias */

/* why a slave is not in its requested state, for programs; of a fixed size */
struct ect_cause {
	uint32_t kind;		/* ECT_CAUSE_* */
	uint32_t code;
	uint16_t object;
	uint16_t position;	/* ring position; ECT_NONE16: none, or lost as well */
	uint8_t subindex;
	uint8_t sm;
	uint8_t state;		/* 1 INIT, 2 PREOP, 3 BOOT, 4 SAFEOP, 8 OP */
	uint8_t port;
	uint32_t reserved[4];
};

/* a port of a slave; of a fixed size */
struct ect_port {
	uint8_t type;		/* 0 none, 1 not configured, 2 EBUS, 3 MII */
	uint8_t link_up;
	uint8_t loop_closed;
	uint8_t signal;
	uint32_t receive_time;	/* ns */
	uint32_t delay_to_next_dc;	/* ns */
	uint16_t next_slave;	/* ring position behind the port, ECT_NONE16: none */
	uint16_t errors_known;	/* of the next four, from the first on; 0: not read */
	/* as the master has read them last, those that it has cleared included; no traffic */
	uint32_t invalid;	/* frames that were damaged on the way to this port */
	uint32_t receiver;	/* errors of the receiver, also between frames */
	uint32_t forwarded;	/* frames that an upstream slave has found damaged */
	uint32_t lost_link;	/* up to 255 */
};

struct ect_slave {
	uint32_t struct_size;
	uint16_t position;	/* in the ring, now */
	uint16_t station;	/* station address */
	uint64_t device;	/* number of the device: never that of another one */
	uint16_t alias;
	uint16_t alias_pos;	/* slaves behind the one with the alias */
	uint16_t alias_group;	/* alias of this slave or of one upstream, 0: none */
	uint16_t al_status;	/* register 0x0130 */
	uint16_t al_code;	/* register 0x0134 */
	uint8_t al_requested;
	uint8_t error;		/* ECT_SLAVE_* */
	uint32_t vendor_id;
	uint32_t product_code;
	uint32_t revision_number;
	uint32_t serial_number;
	uint16_t boot_rx_offset;
	uint16_t boot_rx_size;
	uint16_t boot_tx_offset;
	uint16_t boot_tx_size;
	uint16_t std_rx_offset;
	uint16_t std_rx_size;
	uint16_t std_tx_offset;
	uint16_t std_tx_size;
	uint16_t mbox_protocols;	/* bits 0 AoE, 1 EoE, 2 CoE, 3 FoE, 4 SoE, 5 VoE */
	uint8_t has_general;	/* the EEPROM has general data: the next four, and the names */
	uint8_t coe_details;	/* as in the EEPROM */
	uint8_t general_flags;
	uint8_t foe_details;
	int16_t current_ma;
	uint8_t fmmu_bit;	/* FMMUs map single bits */
	uint8_t dc_supported;	/* 0 no clock, 1: 32 bit, 2: 64 bit */
	uint8_t dc_delay_only;
	uint8_t sm_count;
	uint8_t fmmu_count;
	uint8_t device_index;	/* 0: reached by the main device, 1: by the backup device */
	uint16_t dl_status;	/* register 0x0110 */
	uint16_t features;	/* register 0x0008 */
	uint32_t transmission_delay;	/* ns, from the reference clock */
	uint32_t sii_words;	/* of its EEPROM image */
	uint64_t dc_offset;	/* register 0x0920, ns */
	int32_t dc_diff;	/* to the reference clock at the last read, ns */
	uint16_t dc_set;	/* the clock is synchronized, for an active application */
	uint16_t dc_odd;	/* delay unreliable: receive times contradict the topology */
	uint32_t config;	/* index of the configuration of an application + 1; 0: none */
	uint32_t differs;	/* another device than this configuration has */
	struct ect_cause cause;	/* of @error; without one that of @warning */
	struct ect_port ports[ECT_PORTS];
	char group[ECT_STRING];
	char image[ECT_STRING];
	char order[ECT_STRING];	/* order number */
	char name[ECT_STRING];
	char why[ECT_TEXT];	/* @cause in words, or "" */
	char warning[ECT_TEXT];
	uint8_t port_kept[ECT_PORTS];	/* ECT_PORT_*: why a port is closed despite its link */
	uint8_t port_wait_s[ECT_PORTS];	/* ECT_PORT_LOSSES: it opens after such a time of link */
	uint16_t identification;	/* explicit device identification, 0: none */
	uint16_t missing_before;	/* slaves of a ring that are missing before it */
	uint16_t reserved[2];
};

/* struct ect_slave.port_kept */
#define ECT_PORT_NOT_KEPT	0
#define ECT_PORT_NO_REPLY	1	/* no slave replies behind it */
#define ECT_PORT_LOOPS		2	/* a slave without loop control, others behind it */
#define ECT_PORT_LOSSES		3	/* it has lost its link too often */
/* a device that is not let in; from ECT_PORT_OTHER on: ect_behind_read() */
#define ECT_PORT_OTHER		4	/* no head of a hot connect group of this port */
#define ECT_PORT_SIGN		5	/* one with another alias or identification */
#define ECT_PORT_SERIAL		6	/* one with another serial number */
#define ECT_PORT_SECOND		7	/* a slave of the bus has its alias or identification */
#define ECT_PORT_REVERSED	8	/* not connected by port 0 */
#define ECT_PORT_BOOT		9	/* in BOOT */
#define ECT_PORT_UNREADABLE	10	/* its EEPROM or identification cannot be read */
#define ECT_PORT_UNKNOWN	11	/* neither known nor expected anywhere */

/** struct ect_behind - the device behind a port that stays closed; what was not read is 0 */
struct ect_behind {
	uint32_t struct_size;
	uint32_t kept;		/* ECT_PORT_*; below ECT_PORT_OTHER: there is none */
	uint32_t vendor_id;
	uint32_t product_code;
	uint32_t revision_number;
	uint32_t serial_number;
	uint32_t slaves;	/* with those behind it */
	uint16_t alias;
	uint16_t identification;	/* explicit device identification, if it was asked for */
	char name[ECT_STRING];	/* order number or name in its EEPROM */
};

/**
 * ect_behind_read() - the device behind a port that stays closed
 * @h: master
 * @device: number of the slave whose port it is
 * @port: port
 * @b: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_behind_read(struct ect_handle *h, uint64_t device, unsigned int port,
		    struct ect_behind *b);

/**
 * ect_let_in() - let the device behind a closed port in
 * @h: master, open for writing
 * @device: number of the slave whose port it is
 * @port: port
 * @b: device, as read: another one is not let in
 *
 * The device is connected some cycles later. This holds for it at this port, also when it is
 * disconnected meanwhile, until the session ends.
 *
 * Context: The thread of the handle.
 * Return: 0; -ENOENT: no device is kept behind the port; -ESTALE: it is another one; or another
 * negative errno.
 */
int ect_let_in(struct ect_handle *h, uint64_t device, unsigned int port,
	       const struct ect_behind *b);

/** struct ect_absent - slaves that were disconnected and have not returned, behind one port */
struct ect_absent {
	uint32_t struct_size;
	uint32_t slaves;	/* how many */
	uint64_t device;	/* number of the slave whose port it is, 0: the main device */
	uint64_t since_ns;	/* they were last seen so long ago */
	uint16_t first;		/* ring position that the first of them had */
	uint16_t last;
	uint8_t port;
	char name[ECT_STRING];	/* of the first one */
};

/**
 * ect_absent_read() - slaves that were disconnected and have not returned
 * @h: master
 * @list: result, elements are struct ect_absent, one for each port
 *
 * A bus scan that a user requests forgets them.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_absent_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_slaves_read() - all slaves of a master
 * @h: master
 * @list: result, elements are struct ect_slave in the order of the ring
 *
 * When a bus scan changes the list meanwhile, it is read again.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_slaves_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_slave_at() - the slave at a ring position
 * @h: master
 * @position: from 0
 * @s: result, with its @struct_size
 *
 * The ring may change between two calls: a program resolves a position that a user has given once,
 * and uses @device of the result from then on.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -EINVAL without such a slave, or another negative errno.
 */
int ect_slave_at(struct ect_handle *h, unsigned int position, struct ect_slave *s);

/**
 * ect_slave_read() - a slave by the number of its device
 * @h: master
 * @device: number of the slave
 * @s: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENODEV if the device is disconnected, also when another slave has its position, or
 * another negative errno.
 */
int ect_slave_read(struct ect_handle *h, uint64_t device, struct ect_slave *s);

/**
 * ect_state_request() - request an AL state for a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @state: 1 INIT, 2 PREOP, 3 BOOT, 4 SAFEOP, 8 OP
 * @timeout_ms: of each transition on the way to it, 0: the usual ones
 *
 * Returns at once: @al_status, @error and @why of struct ect_slave show what becomes of it.
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_state_request(struct ect_handle *h, uint64_t device, unsigned int state,
		      uint32_t timeout_ms);

/**
 * ect_sii_read() - the EEPROM image that the master has of a slave
 * @h: master
 * @device: number of the slave
 * @offset: of the first byte
 * @data: for @size bytes
 * @size: bytes; twice @sii_words of struct ect_slave is the whole image
 *
 * Context: The thread of the handle; no traffic.
 * Return: bytes that were read, fewer at the end of the image; or a negative errno.
 */
long ect_sii_read(struct ect_handle *h, uint64_t device, uint32_t offset, void *data, size_t size);

/* a SyncManager of a slave */
struct ect_sm {
	uint32_t struct_size;
	uint8_t sm;		/* index */
	uint8_t control;	/* control byte; bit 2: the master writes */
	uint8_t enable;
	uint8_t type;
	uint16_t start;		/* physical address */
	uint16_t default_size;
	uint16_t pdo_count;
	uint16_t reserved;
};

/* a PDO of a SyncManager */
struct ect_pdo {
	uint32_t struct_size;
	uint16_t index;
	uint16_t entry_count;
	char name[ECT_STRING];
};

/* an entry of a PDO; index 0: a gap */
struct ect_pdo_entry {
	uint32_t struct_size;
	uint16_t index;
	uint8_t subindex;
	uint8_t bits;
	char name[ECT_STRING];
};

/**
 * ect_sm_read() - a SyncManager of a slave
 * @h: master
 * @device: number of the slave
 * @sm: index, below @sm_count of struct ect_slave
 * @to: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_sm_read(struct ect_handle *h, uint64_t device, unsigned int sm, struct ect_sm *to);

/**
 * ect_pdo_read() - a PDO of a SyncManager, as the EEPROM has it
 * @h: master
 * @device: number of the slave
 * @sm: index of the SyncManager
 * @pdo: below @pdo_count of struct ect_sm
 * @to: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_pdo_read(struct ect_handle *h, uint64_t device, unsigned int sm, unsigned int pdo,
		 struct ect_pdo *to);

/**
 * ect_pdo_entry_read() - an entry of a PDO, as the EEPROM has it
 * @h: master
 * @device: number of the slave
 * @sm: index of the SyncManager
 * @pdo: below @pdo_count of struct ect_sm
 * @entry: below @entry_count of struct ect_pdo
 * @to: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_pdo_entry_read(struct ect_handle *h, uint64_t device, unsigned int sm, unsigned int pdo,
		       unsigned int entry, struct ect_pdo_entry *to);

/* error counters of a port, each up to 255; of a fixed size */
struct ect_port_errors {
	uint8_t invalid;	/* frames that were damaged on the way to this port */
	uint8_t receiver;	/* errors of the receiver, also between frames */
	uint8_t forwarded;	/* frames that an upstream slave has found damaged */
	uint8_t lost_link;
	uint32_t reserved;
};

/* registers 0x0300 to 0x0313 */
struct ect_errors {
	uint32_t struct_size;
	uint8_t unit;		/* errors of the processing unit */
	uint8_t pdi;		/* errors of the interface to the slave's controller */
	uint16_t reserved;
	struct ect_port_errors ports[ECT_PORTS];
};

/**
 * ect_errors_read() - the error counters of a slave's ports
 * @h: master, open for writing
 * @device: number of the slave
 * @e: result, with its @struct_size
 *
 * A read without reply is repeated, since error counters are of use where frames are lost.
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: As ect_reg_read().
 */
int ect_errors_read(struct ect_handle *h, uint64_t device, struct ect_errors *e);

#define ECT_REG_MAX	1024u	/* bytes of registers in one datagram */

/**
 * ect_reg_read() - read registers of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @address: of the first register
 * @data: for @size bytes
 * @size: bytes; more than %ECT_REG_MAX are read in several datagrams
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: 0, -ETIMEDOUT if the slave does not reply, -EINVAL beyond the last register, or another
 * negative errno.
 */
int ect_reg_read(struct ect_handle *h, uint64_t device, uint16_t address, void *data, size_t size);

/**
 * ect_reg_write() - write registers of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @address: of the first register
 * @data: @size bytes
 * @size: bytes; more than %ECT_REG_MAX are written in several datagrams
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: As ect_reg_read().
 */
int ect_reg_write(struct ect_handle *h, uint64_t device, uint16_t address, const void *data,
		  size_t size);

/**
 * ect_reg_exchange() - write registers of a slave and get what they contained
 * @h: master, open for writing
 * @device: number of the slave
 * @address: of the first register
 * @data: @size bytes to write; afterwards what they contained before
 * @size: bytes, at most %ECT_REG_MAX: one datagram reads and writes
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: As ect_reg_read().
 */
int ect_reg_exchange(struct ect_handle *h, uint64_t device, uint16_t address, void *data,
		     size_t size);

/**
 * ect_reg_write_emergency() - write registers of a slave that the master does not know
 * @h: master, open for writing
 * @position: of the slave in the ring, also if the bus has not been scanned
 * @address: of the first register
 * @data: @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: As ect_reg_read().
 */
int ect_reg_write_emergency(struct ect_handle *h, uint16_t position, uint16_t address,
			    const void *data, size_t size);

#define ECT_DATAGRAM_MAX	1486u	/* bytes of a datagram */

/**
 * ect_datagram() - send one datagram of any command
 * @h: master, open for writing
 * @command: number in ETG.1000.4, 0 (NOP) to 14 (FRMW)
 * @address: logical address; otherwise register times 65536, plus the station address or the
 *	negative ring position
 * @data: @size bytes to send; afterwards as they returned
 * @size: bytes, 1 to %ECT_DATAGRAM_MAX
 * @working_counter: result
 *
 * It is sent once, also if it is lost. While an application runs the bus, a write to all slaves, to
 * a logical address or to registers that run the bus needs CAP_SYS_ADMIN.
 *
 * Context: The thread of the handle; waits for the bus.
 * Return: 0 when it has returned, -ETIMEDOUT if it was lost, -EPERM, -EINVAL, or another negative
 * errno.
 */
int ect_datagram(struct ect_handle *h, uint8_t command, uint32_t address, void *data, size_t size,
		 uint16_t *working_counter);

#ifdef __cplusplus
}
#endif

#endif
