/* SPDX-License-Identifier: GPL-2.0-only */
/* Every limit of the master, with the reason for its value. */
#ifndef EC_LIMITS_H
#define EC_LIMITS_H

#define EC_MAX_MASTERS		8	/* minors of the character device */
#define EC_MAX_LINKS		2	/* main and backup */
#define EC_MAX_SLAVES		65535	/* 16-bit addressing */
#define EC_SLAVE_BYTES		16384	/* memory of a slave with its EEPROM; an estimate */
#define EC_SLAVES_RAM		16	/* one part of so many is for slaves */
#define EC_MIN_SLAVES		256	/* that a scan takes on however little memory there is */
#define EC_MAX_DOMAINS		64	/* bits of the queue mask, EC_STATUS_DOMAINS */
#define EC_MAX_GROUPS		128	/* hot connect groups of one session */
#define EC_MAX_UNIT_LIMIT	1000000	/* receives until a unit has failed */
#define EC_MAX_DIVISION		1000	/* cycles from one exchange of a domain to the next */
#define EC_MAX_COPIES		1024	/* of one session, done in each cycle */
#define EC_MAX_CONFIGS		4096	/* EC_STATUS_CONFIGS */
#define EC_MAX_IMAGE		(256 * 1024)	/* bytes of process data per session */
#define EC_MAX_CYCLE_DGRAMS	512	/* datagrams of one cycle */
#define EC_MAX_CYCLE_FRAMES	64	/* frames of a cycle; those of two may be in flight */
#define EC_MAX_SM_BYTES		0xf000	/* of one SyncManager: what an ESC has from 0x1000 on */
#define EC_MAX_SC_PDOS		1024	/* PDOs one configuration may hold */
#define EC_MAX_SC_SDOS		1024	/* startup SDOs of one configuration */
#define EC_MAX_SC_IDNS		1024	/* startup IDNs of one configuration */
#define EC_MAX_SC_COMMANDS	1024	/* commands for transitions of one configuration */
#define EC_MAX_SC_REGS		16	/* startup registers of one configuration */
#define EC_MAX_SC_FLAGS		64	/* named numbers of one configuration */
#define EC_MAX_SC_WRITES	512	/* values of the application kept for one configuration, */
#define EC_MAX_SC_WRITE_BYTES	(64 * 1024)	/* and their bytes; wire/replay.c has the text */
#define EC_MAX_SC_LISTED	1024	/* its writes, those whose value was not kept included */
#define EC_MAX_SC_REPLAYS	64	/* objects that are to be replayed in any case */
#define EC_MAX_SESSION_BYTES	(64 * 1024 * 1024)	/* of a master's sessions and what is mapped */
#define EC_MAX_REQUESTS		4096	/* of one session */
#define EC_MAX_REQUEST_BYTES	(16 * 1024 * 1024)	/* of one session, emergencies included */
#define EC_MAX_EMERG		1024	/* emergencies kept per configuration */
#define EC_MAX_SDO_SIZE		(64 * 1024)	/* bytes; field tools use 64 KiB */
#define EC_MAX_DICT_BYTES	(64 * 1024)	/* kept answers of a slave */
#define EC_MAX_SDO_MS		60000u	/* others wait for the mailbox meanwhile */
#define EC_MAX_AL_MS	600000u	/* of a transition: some slaves load a program meanwhile */
#define EC_MAX_SOE_SIZE		(64 * 1024)	/* bytes; the length of a list has 16 bits */
#define EC_MAX_FOE_SIZE		(15 * 1024 * 1024)	/* file of a request */
#define EC_MAX_VOE_SIZE		1474	/* bytes; one message in one datagram */
#define EC_MAX_REG_SIZE		1024	/* bytes per register access */
#define EC_MAX_DATAGRAM_SIZE	1486	/* bytes: the only datagram of a frame */
#define EC_MAX_SII_BYTES	(512 * 1024)	/* larger EEPROMs are cut */
#define EC_MAX_SII_TOTAL	(64 * 1024 * 1024)	/* EEPROMs of all slaves of a master */

#define EC_MAX_INTERVAL_US	1000000	/* longer ones are measured; waits are a multiple */
#define EC_INTERVAL_US		1000	/* cycle time until the application configures it */
#define EC_LATE_PER_S		100	/* cycles that acyclic frames may delay, by default */
#define EC_SLOTS		256	/* datagram index has 8 bits */
#define EC_XFER_WINDOW		64	/* frames one ec_xfer() has in flight: 2 ms of wire */
#define EC_LINK_ACYCLIC		64	/* acyclic frames of a link in flight, of all callers */
#define EC_LINK_QUEUED		192	/* the same beside a cycle */
#define EC_POSTS_MAX	8	/* posts that share a frame: each of their callers is woken */
#define EC_CLOCK_WINDOW	120	/* the same of ec_xfer_clock(): what 60 ms carry */
#define EC_CLOCK_DATAGRAMS	74	/* in a frame of it, at most */
#define EC_QUARANTINE_NS	(20 * NSEC_PER_MSEC)

#endif
