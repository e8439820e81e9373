/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Interface of an EtherCAT application, in userspace (libethercat) and in the kernel.
 *
 *   master = ecrt_request_master(0);
 *   domain = ecrt_master_create_domain(master);
 *   sc = ecrt_master_slave_config(master, 0, 1, vendor, product);
 *   offset = ecrt_slave_config_reg_pdo_entry(sc, 0x6000, 1, domain, &bit);
 *   ecrt_master_activate(master);
 *   data = ecrt_domain_data(domain);
 *   each cycle:
 *	ecrt_master_receive(master);
 *	ecrt_domain_process(domain);
 *	... EC_READ_*(data + offset), EC_WRITE_*(data + offset, value) ...
 *	ecrt_domain_queue(domain);
 *	ecrt_master_send(master);
 *   ecrt_release_master(master);
 *
 * Conventions. Integer functions return 0 or the documented value on success, and a
 * negative errno on failure. Functions that return a pointer return NULL on failure. A
 * NULL handle gives -EINVAL or NULL. When a configuration call fails, the userspace
 * library prints one line with the reason on stderr; the calls of the cycle never print.
 * EtherCAT data are little-endian; SDO data are not converted.
 *
 * In userspace a function that needs the reservation returns -EPERM on a master that is
 * only opened. Configuration calls return -EBUSY while the master is active.
 *
 * "Context:" is one of
 *   Any. RT-safe: bounded, no sleep, no allocation.
 *   One caller at a time. RT-safe. The application must not make two calls with this
 *	context for the same request, handler or slave at the same time.
 *   The cycle owner. RT-safe: the one thread that calls ecrt_master_receive() and
 *	ecrt_master_send().
 *   Process. May sleep.
 *   Process. Waits for bus traffic.
 */
#ifndef __ECRT_H__
#define __ECRT_H__

#ifdef __KERNEL__
#include <asm/byteorder.h>
#include <linux/types.h>
#include <linux/time.h>
#include <linux/in.h>
#else
#include <stdlib.h>
#include <stdint.h>
#include <sys/time.h>
#include <netinet/in.h>
#endif

/* version of this interface ------------------------------------------------*/

#define ECRT_VER_MAJOR		1
#define ECRT_VER_MINOR		6
#define ECRT_VERSION(a, b)	(((a) << 8) + (b))
#define ECRT_VERSION_MAGIC	ECRT_VERSION(ECRT_VER_MAJOR, ECRT_VER_MINOR)

#define EC_HAVE_REDUNDANCY
/* ecrt_master_select_reference_clock() */
#define EC_HAVE_SELECT_REF_CLOCK
/* ecrt_master_reference_clock_time() */
#define EC_HAVE_REF_CLOCK_TIME
/* ecrt_slave_config_reg_pdo_entry_pos() */
#define EC_HAVE_REG_BY_POS
/* ecrt_master_sync_reference_clock_to() */
#define EC_HAVE_SYNC_TO
/* ecrt_slave_config_emerg_*() */
#define EC_HAVE_EMERGENCY
/* ecrt_slave_config_create_reg_request() and its requests */
#define EC_HAVE_REG_ACCESS
/* ecrt_slave_config_flag() */
#define EC_HAVE_FLAGS
/* its flag IgnoresFRMW */
#define EC_HAVE_FLAG_IGNORES_FRMW
/* ec_soe_request_t and its functions */
#define EC_HAVE_SOE_REQUESTS
/* ecrt_master_scan_progress() */
#define EC_HAVE_SCAN_PROGRESS
/* ecrt_slave_config_eoe_*() */
#define EC_HAVE_SET_IP
/* ecrt_slave_config_state_timeout() */
#define EC_HAVE_STATE_TIMEOUT

/* extensions of this master ------------------------------------------------*/

/* ecrt_master_set_cycle(): the kernel runs the cycle */
#define EC_HAVE_KERNEL_CYCLE
#ifndef __KERNEL__
/* ecrt_master_setup_domain_memory(); in userspace */
#define EC_HAVE_DOMAIN_MEMORY
#endif
/* ecrt_master_deactivate_slaves() */
#define EC_HAVE_DEACTIVATE_SLAVES
/* ecrt_master_rt_slave_requests(), ecrt_master_exec_slave_requests() */
#define EC_HAVE_RT_SLAVE_REQUESTS
/* ecrt_master_eoe_addif() and its neighbors: network devices of slaves with EoE */
#define EC_HAVE_EOE_INTERFACES
/* requests for whole objects */
#define EC_HAVE_SDO_REQUEST_COMPLETE
/* ecrt_reg_request_readwrite() */
#define EC_HAVE_REG_READWRITE
/* ecrt_master_sdo_upload_complete() */
#define EC_HAVE_SDO_UPLOAD_COMPLETE
/* ecrt_master_64bit_reference_clock_time() */
#define EC_HAVE_REF_CLOCK_TIME_64
/* ecrt_master_reason(), ecrt_slave_config_reason() */
#define EC_HAVE_REASON
/* ecrt_slave_config_dc_state() */
#define EC_HAVE_DC_STATE
/* ecrt_slave_config_overlapping_pdos(), of the patches to the IgH EtherCAT Master */
#define EC_HAVE_OVERLAPPING_PDOS
/* ecrt_master_set_late_cycles(): acyclic frames beside a full wire */
#define EC_HAVE_LATE_CYCLES
/* ecrt_domain_set_options(): how a domain is sent */
#define EC_HAVE_DOMAIN_OPTIONS
/* ecrt_domain_age(), ecrt_domain_set_max_age(): age of process data */
#define EC_HAVE_DOMAIN_AGE
/* ecrt_sdo_request_cancel(), ecrt_soe_request_cancel() */
#define EC_HAVE_REQUEST_CANCEL
/* ecrt_master_sdo_info_*(), ec_sdo_info_request_t: object dictionary of slaves */
#define EC_HAVE_SDO_INFO
/* ecrt_master_foe_read(), ecrt_master_foe_write(): files of slaves */
#define EC_HAVE_FOE
/* ecrt_slave_config_create_foe_request() and its requests */
#define EC_HAVE_FOE_REQUESTS
/* ecrt_slave_config_sdo_timeout(): limit of replies to SDOs */
#define EC_HAVE_SDO_TIMEOUT
/* ecrt_master_group(), ecrt_master_group_config(): hot connect groups */
#define EC_HAVE_GROUPS
/* ecrt_slave_config_replay() and the next ones: what a slave gets that returns */
#define EC_HAVE_REPLAY
/* ecrt_master_create_datagram_request() and its requests: any EtherCAT command */
#define EC_HAVE_DATAGRAM_REQUESTS
/* ecrt_slave_config_command(): commands for every transition */
#define EC_HAVE_TRANSITION_COMMANDS
/* ecrt_master_unit() and the next ones: units of domains that fail alone */
#define EC_HAVE_UNITS
/* ecrt_master_read_eeprom(), ecrt_master_write_eeprom(), ecrt_master_write_alias() */
#define EC_HAVE_EEPROM
#ifdef __KERNEL__
/* ecrt_master_load_compiled(), ecrt_master_value(): a compiled bus file; in the kernel */
#define EC_HAVE_COMPILED_BUS
#endif
#ifndef __KERNEL__
/* ecrt_open_events(): what has happened on the bus; in userspace */
#define EC_HAVE_EVENTS
/* ecrt_master_leave(): the master keeps the cycle; in userspace */
#define EC_HAVE_LEAVE
/* ecrt_master_set_names(): names of values for tools; in userspace */
#define EC_HAVE_NAMES
/* ecrt_master_set_data(), ecrt_master_data(): for libraries above this one; in userspace */
#define EC_HAVE_MASTER_DATA
#endif

#ifndef EC_PUBLIC_API
#if defined(ethercat_EXPORTS) && !defined(__KERNEL__)
#define EC_PUBLIC_API __attribute__((visibility("default")))
#else
#define EC_PUBLIC_API
#endif
#endif

/* ends a list of SyncManagers */
#define EC_END			(~0U)
/* SyncManagers of one slave */
#define EC_MAX_SYNC_MANAGERS	16
/* bytes of a name, its terminator included */
#define EC_MAX_STRING_LENGTH	64
/* ports of one slave */
#define EC_MAX_PORTS		4
/* bytes of a CoE emergency: code, error register, data (ETG.1000.6 5.6.4) */
#define EC_COE_EMERGENCY_MSG_SIZE 8

/* a struct timeval as nanoseconds since 2000-01-01, the epoch of EtherCAT */
#define EC_TIMEVAL2NANO(TV) \
	(((TV).tv_sec - 946684800ULL) * 1000000000ULL + (TV).tv_usec * 1000ULL)

/* types ----------------------------------------------------------------------*/

struct ec_master;
typedef struct ec_master ec_master_t;

struct ec_slave_config;
typedef struct ec_slave_config ec_slave_config_t;

struct ec_domain;
typedef struct ec_domain ec_domain_t;

struct ec_sdo_request;
typedef struct ec_sdo_request ec_sdo_request_t;

struct ec_soe_request;
typedef struct ec_soe_request ec_soe_request_t;

struct ec_sdo_info_request;
typedef struct ec_sdo_info_request ec_sdo_info_request_t;

struct ec_foe_request;
typedef struct ec_foe_request ec_foe_request_t;

struct ec_voe_handler;
typedef struct ec_voe_handler ec_voe_handler_t;

struct ec_reg_request;
typedef struct ec_reg_request ec_reg_request_t;

struct ec_datagram_request;
typedef struct ec_datagram_request ec_datagram_request_t;

/* commands of EtherCAT (ETG.1000.4) */
typedef enum {
	EC_DATAGRAM_NOP,
	EC_DATAGRAM_APRD,
	EC_DATAGRAM_APWR,
	EC_DATAGRAM_APRW,
	EC_DATAGRAM_FPRD,
	EC_DATAGRAM_FPWR,
	EC_DATAGRAM_FPRW,
	EC_DATAGRAM_BRD,
	EC_DATAGRAM_BWR,
	EC_DATAGRAM_BRW,
	EC_DATAGRAM_LRD,
	EC_DATAGRAM_LWR,
	EC_DATAGRAM_LRW,
	EC_DATAGRAM_ARMW,
	EC_DATAGRAM_FRMW
} ec_datagram_command_t;

/* address of a datagram: a register of one slave, by station address or ring position, or of all */
#define EC_DATAGRAM_STATION(STATION, REG) ((uint32_t)(REG) << 16 | ((STATION) & 0xffffU))
#define EC_DATAGRAM_POSITION(POSITION, REG) EC_DATAGRAM_STATION(-(uint32_t)(POSITION), REG)
#define EC_DATAGRAM_ALL(REG) EC_DATAGRAM_STATION(0U, REG)

/* state of the whole bus */
typedef struct {
	unsigned int slaves_responding;	/* to broadcasts, on all links */
	unsigned int al_states : 4;	/* OR of ec_al_state_t; 8: all in OP */
	unsigned int link_up : 1;	/* at least one link is up */
} ec_master_state_t;

/* state of the slaves that one link reaches */
typedef struct {
	unsigned int slaves_responding;
	unsigned int al_states : 4;
	unsigned int link_up : 1;
} ec_master_link_state_t;

/* state of one slave configuration */
typedef struct {
	unsigned int online : 1;	/* a matching slave is attached */
	unsigned int operational : 1;	/* in OP with this configuration */
	unsigned int al_state : 4;	/* ec_al_state_t, 3 BOOT, 0 unknown */
} ec_slave_config_state_t;

typedef struct {
	unsigned int slave_count;
	unsigned int link_up : 1;	/* of the main link */
	uint8_t scan_busy;
	uint64_t app_time;		/* last application time, ns */
} ec_master_info_t;

/* a scan runs while scan_index < slave_count */
typedef struct {
	unsigned int slave_count;
	unsigned int scan_index;
} ec_master_scan_progress_t;

/* ESC configuration of a port, register 0x0007 */
typedef enum {
	EC_PORT_NOT_IMPLEMENTED,
	EC_PORT_NOT_CONFIGURED,
	EC_PORT_EBUS,
	EC_PORT_MII
} ec_slave_port_desc_t;

/* DL status of a port, register 0x0110 */
typedef struct {
	uint8_t link_up;
	uint8_t loop_closed;
	uint8_t signal_detected;
} ec_slave_port_link_t;

typedef struct {
	uint16_t position;		/* in the ring, from 0 */
	uint32_t vendor_id;
	uint32_t product_code;
	uint32_t revision_number;
	uint32_t serial_number;
	uint16_t alias;			/* 0: none */
	int16_t current_on_ebus;	/* mA taken, negative: supplied */
	struct {
		ec_slave_port_desc_t desc;
		ec_slave_port_link_t link;
		uint32_t receive_time;	/* ns, register 0x0900 + 4 * port */
		uint16_t next_slave;	/* ring position, 0xffff: none */
		uint32_t delay_to_next_dc; /* ns */
	} ports[EC_MAX_PORTS];
	uint8_t al_state;		/* low byte of register 0x0130 */
	uint8_t error_flag;		/* the master could not configure it */
	uint8_t sync_count;
	uint16_t sdo_count;		/* always 0; use ecrt_master_sdo_info_list() */
	char name[EC_MAX_STRING_LENGTH];
} ec_slave_info_t;

/* working counter compared with the expected one */
typedef enum {
	EC_WC_ZERO = 0,			/* no slave responded */
	EC_WC_INCOMPLETE,		/* some slaves did */
	EC_WC_COMPLETE			/* all slaves did */
} ec_wc_state_t;

typedef struct {
	unsigned int working_counter;
	ec_wc_state_t wc_state;
	unsigned int redundancy_active;	/* data came over the backup link */
} ec_domain_state_t;

/* from the view of the master */
typedef enum {
	EC_DIR_INVALID,
	EC_DIR_OUTPUT,			/* written by the master */
	EC_DIR_INPUT,			/* read by the master */
	EC_DIR_COUNT
} ec_direction_t;

/* watchdog trigger, bit 6 of a SyncManager's control byte */
typedef enum {
	EC_WD_DEFAULT,			/* as in the SII of the slave */
	EC_WD_ENABLE,
	EC_WD_DISABLE
} ec_watchdog_mode_t;

typedef struct {
	uint16_t index;			/* 0: a gap of bit_length bits */
	uint8_t subindex;
	uint8_t bit_length;
} ec_pdo_entry_info_t;

typedef struct {
	uint16_t index;
	unsigned int n_entries;		/* 0: the default mapping */
	ec_pdo_entry_info_t const *entries;
} ec_pdo_info_t;

typedef struct {
	uint8_t index;			/* 0xff ends a list */
	ec_direction_t dir;
	unsigned int n_pdos;
	ec_pdo_info_t const *pdos;
	ec_watchdog_mode_t watchdog_mode;
} ec_sync_info_t;

/* one line of a registration list; the line with index 0 ends it */
typedef struct {
	uint16_t alias;
	uint16_t position;
	uint32_t vendor_id;
	uint32_t product_code;
	uint16_t index;
	uint8_t subindex;
	unsigned int *offset;		/* out: byte in the domain */
	unsigned int *bit_position;	/* out: 0..7; NULL: must be 0 */
} ec_pdo_entry_reg_t;

typedef enum {
	EC_REQUEST_UNUSED,
	EC_REQUEST_BUSY,
	EC_REQUEST_SUCCESS,
	EC_REQUEST_ERROR
} ec_request_state_t;

/* one bit each, so that the states of many slaves can be ORed */
typedef enum {
	EC_AL_STATE_INIT = 1,
	EC_AL_STATE_PREOP = 2,
	EC_AL_STATE_SAFEOP = 4,
	EC_AL_STATE_OP = 8
} ec_al_state_t;

/* functions ------------------------------------------------------------------*/

#ifdef __cplusplus
extern "C" {
#endif

/**
 * ecrt_version_magic() - get the version of the running library or module
 *
 * Compare it with %ECRT_VERSION_MAGIC, the version of this header.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: %ECRT_VERSION_MAGIC of the library or, in the kernel, the module.
 */
EC_PUBLIC_API unsigned int ecrt_version_magic(void);

/**
 * ecrt_request_master() - open a master and reserve it
 * @master_index: index, from 0
 *
 * ecrt_open_master() and ecrt_master_reserve() in one call: waits for a scan that is in progress
 * or due, holds the list of slaves until activation, and requests PREOP of all slaves.
 *
 * Context: Process. Waits for bus traffic.
 * Return: the master, or NULL: no such master (%-ENOENT), no access
 * (%-EACCES), reserved by another application (%-EBUSY), without its device (%-ENODEV),
 * interrupted (%-EINTR).
 */
EC_PUBLIC_API ec_master_t *ecrt_request_master(unsigned int master_index);

#ifndef __KERNEL__
/**
 * ecrt_open_master() - open a master without reserving it
 * @master_index: index from 0 of /dev/EtherCAT<index>
 *
 * Any number of processes may open a master. An opened master is sufficient for the calls
 * that read the state of the bus, for SDO access and ecrt_master_reset(). Userspace only:
 * a module requests the master it works with.
 *
 * Context: Process. May sleep.
 * Return: the master, or NULL: no such master (%-ENOENT), no access
 * (%-EACCES), module interface version not supported (%-EPROTO).
 */
EC_PUBLIC_API ec_master_t *ecrt_open_master(unsigned int master_index);
#endif

/**
 * ecrt_release_master() - release a master
 * @master: from ecrt_request_master() or ecrt_open_master(), or NULL
 *
 * Deactivates an active master; slaves go to PREOP. A cycle of the kernel with
 * %EC_CYCLE_DETACH continues. All handles and pointers of @master become invalid.
 *
 * Context: Process. May sleep.
 */
EC_PUBLIC_API void ecrt_release_master(ec_master_t *master);

#ifndef __KERNEL__
/**
 * ecrt_master_reserve() - reserve an opened master for this application
 * @master: from ecrt_open_master()
 *
 * Waits for a scan that is in progress or due, at most 30 s. From then on the list of slaves is
 * held until activation or release: no scan changes it, so a ring position means the same device
 * all the time. Meanwhile a slave that does not reply at its station address is lost, and calls
 * for it fail with %-EIO; a new slave is not in the list. Requests PREOP of all slaves and waits
 * for it, at most 10 s; a slave that has failed to reach PREOP before is not changed. While a
 * detached session exists (%EC_CYCLE_DETACH), the call changes no slave, and the list is not held
 * before that session has ended. Userspace only, as is ecrt_open_master().
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-EBUSY reserved by another application, %-ENODEV the master has no device, %-EPERM
 * not opened for writing, %-EINTR, %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_reserve(ec_master_t *master);
#endif

/**
 * ecrt_master_create_domain() - create an empty process data domain
 * @master: a reserved master, not active
 *
 * Each domain has its own datagrams and working counter. The process image contains the
 * domains in the order of creation. ecrt_master_deactivate() and ecrt_release_master() free
 * them.
 *
 * Context: Process. May sleep.
 * Return: the domain, or NULL: no memory, not reserved, active, too many.
 */
EC_PUBLIC_API ec_domain_t *ecrt_master_create_domain(ec_master_t *master);

#ifdef EC_HAVE_GROUPS
typedef enum {
	EC_GROUP_ALIAS = 1,	/* station alias (register 0x0012) of its first slave */
	EC_GROUP_ID = 2,	/* explicit device identification, for example switches */
	EC_GROUP_PORT = 3,	/* the port where its first slave is connected */
} ec_group_by_t;

/*
 * ec_group_info_t.flags: without the group the bus is not complete; its port is opened at once, not
 * after 100 ms of link and longer times after losses: a contact that bounces there costs frames
 */
#define EC_GROUP_MANDATORY	1
#define EC_GROUP_FAST		2

/**
 * struct ec_group_info_t - a hot connect group: slaves that come and go together
 * @name: for messages: a letter, then letters, digits, '_', '-' and '.', at most 63
 * @by: what its first slave, the head, is known by
 * @value: alias or identification, not 0; with %EC_GROUP_PORT 0
 * @port: port of @at where the head has to be: 1 to 3; 0 without @at
 * @at: configuration of that slave; NULL: it may be connected anywhere
 * @flags: %EC_GROUP_MANDATORY; with @at %EC_GROUP_FAST
 */
typedef struct {
	const char *name;
	ec_group_by_t by;
	uint16_t value;
	uint8_t port;
	ec_slave_config_t *at;
	uint32_t flags;
} ec_group_info_t;

/**
 * ecrt_master_group() - create or find a hot connect group
 * @master: a reserved master
 * @info: the group
 *
 * Extension (%EC_HAVE_GROUPS). Slaves of groups do not count for the ring positions of
 * ecrt_master_slave_config(): create groups, with their members, before the configurations that
 * are known by ring position, except the ones at whose ports they are. A group may be absent at
 * any time: the expected working counters count its slaves once they are in OP or have failed,
 * and those of a mandatory group always. When all its members are on the bus they are configured
 * and brought to OP; when one is missing or another device, none is, and
 * ecrt_slave_config_reason() says why.
 *
 * Context: Process. May sleep.
 * Return: number of the group; %-EINVAL the description is not valid; %-EEXIST another group has
 * the same name, alias, identification or port; %-ENOSPC there are 128; %-EBUSY @master is active;
 * %-EPERM not reserved; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_master_group(ec_master_t *master, const ec_group_info_t *info);

/**
 * ecrt_master_group_config() - create or find the configuration of a member of a group
 * @master: a reserved master
 * @group: number of the group
 * @member: 0: the head; then one by one in the order of the ring
 * @vendor_id: expected in the SII of the slave
 * @product_code: expected in the SII of the slave
 *
 * Extension (%EC_HAVE_GROUPS). The flag "ExpectedSerial" (ecrt_slave_config_flag()) is a serial
 * number that the slave has to have. With a domain of its own for a group its working counter is
 * that of the group alone.
 *
 * Context: Process. May sleep.
 * Return: the configuration, also while @master is active; NULL: no memory, no such group, the
 * member before it has no configuration, active, or it exists with another identity.
 */
EC_PUBLIC_API ec_slave_config_t *ecrt_master_group_config(ec_master_t *master,
		unsigned int group, uint16_t member, uint32_t vendor_id,
		uint32_t product_code);
#endif

/**
 * ecrt_master_slave_config() - create or find the configuration of a slave
 * @master: a reserved master
 * @alias: 0, or the station alias (register 0x0012) of the slave where counting starts
 * @position: with @alias 0 the ring position, otherwise the number of slaves downstream
 * @vendor_id: expected in the SII of the slave
 * @product_code: expected in the SII of the slave
 *
 * The slave may be absent: when it connects, the master attaches it to the configuration,
 * configures it and requests OP. A slave with another identity is never attached. The
 * configuration starts with the PDO assignment and mapping of a connected slave. After
 * activation a connected slave remains attached, also when a slave upstream is disconnected
 * and the position changes. After a loss of the whole link or of power, the master identifies
 * slaves of equal type by their position again; an alias is unambiguous in this case.
 *
 * Context: Process. May sleep.
 * Return: the configuration, the same one for the same @alias and @position, also while
 * @master is active; NULL: no memory, not reserved, active and no such configuration
 * (%-EBUSY), or it exists with another identity (%-ENOENT).
 */
EC_PUBLIC_API ec_slave_config_t *ecrt_master_slave_config(ec_master_t *master,
		uint16_t alias, uint16_t position, uint32_t vendor_id,
		uint32_t product_code);

/**
 * ecrt_master() - get information about a master
 * @master: an opened master
 * @master_info: out
 *
 * Causes no bus traffic.
 *
 * Context: Process. May sleep. In the kernel: any; RT-safe: bounded, no sleep,
 * no allocation. In the cycle of a process call ecrt_master_state() instead.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master(ec_master_t *master,
		ec_master_info_t *master_info);

/**
 * ecrt_master_scan_progress() - get the progress of a scan
 * @master: an opened master
 * @progress: out: number of slaves that respond, and how many of them the scan has read.
 *	Without a scan both are the number of known slaves.
 *
 * Context: Process. May sleep. In the kernel: any; RT-safe: bounded, no sleep,
 * no allocation.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_scan_progress(ec_master_t *master,
		ec_master_scan_progress_t *progress);

/**
 * ecrt_master_get_slave() - get information about a slave
 * @master: an opened master
 * @slave_position: in the ring, counted over all links
 * @slave_info: out; the name is always terminated
 *
 * Causes no bus traffic.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL no such slave, in the kernel %-ENOENT;
 * %-EINTR; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_get_slave(ec_master_t *master,
		uint16_t slave_position, ec_slave_info_t *slave_info);

/**
 * ecrt_master_get_sync_manager() - get a SyncManager as its slave describes it
 * @master: an opened master
 * @slave_position: in the ring
 * @sync_index: 0..15
 * @sync: out; @sync->pdos is NULL, @sync->watchdog_mode never DEFAULT
 *
 * From the SII or, if the master has read them, from the objects 0x1c00 and 0x1c10 ff.; not
 * the configuration of the application. Userspace only.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT @sync_index too large; %-EINVAL no such slave or
 * SyncManager, or an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_get_sync_manager(ec_master_t *master,
		uint16_t slave_position, uint8_t sync_index,
		ec_sync_info_t *sync);

/**
 * ecrt_master_get_pdo() - get a PDO that is assigned to a SyncManager by default
 * @master: an opened master
 * @slave_position: in the ring
 * @sync_index: 0..15
 * @pos: from 0, in the order of the assignment
 * @pdo: out; @pdo->entries is NULL
 *
 * Userspace only.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT @sync_index too large; %-EINVAL no such slave,
 * SyncManager or PDO, or an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_get_pdo(ec_master_t *master,
		uint16_t slave_position, uint8_t sync_index, uint16_t pos,
		ec_pdo_info_t *pdo);

/**
 * ecrt_master_get_pdo_entry() - get an entry that is mapped to a PDO by default
 * @master: an opened master
 * @slave_position: in the ring
 * @sync_index: 0..15
 * @pdo_pos: position of the PDO in the SyncManager
 * @entry_pos: from 0, in the order of the mapping
 * @entry: out; index 0 is a gap
 *
 * Userspace only.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT @sync_index too large; %-EINVAL no such slave,
 * SyncManager, PDO or entry, or an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_get_pdo_entry(ec_master_t *master,
		uint16_t slave_position, uint8_t sync_index, uint16_t pdo_pos,
		uint16_t entry_pos, ec_pdo_entry_info_t *entry);

/**
 * ecrt_master_sdo_download() - write an object of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring; aliases have no effect
 * @index: of the object
 * @subindex: of the object
 * @data: little-endian
 * @data_size: bytes, 1 to 65536
 * @abort_code: out, may be NULL: CoE abort code (ETG.1000.6 table 41), 0 if
 *              the slave gave none
 *
 * CoE download, expedited or segmented (ETG.1000.6 5.6.2).
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-EIO refused or failed, see @abort_code; %-EINVAL no such slave
 * or bad arguments; %-EPROTONOSUPPORT slave without CoE; %-ETIMEDOUT no
 * reply; %-ENOTRECOVERABLE a frame was lost and the slave does not repeat its
 * messages, so it is not known whether it has written the value: it is not
 * written again by itself; %-EAGAIN slave in INIT, where its mailbox is off; %-EPROTO,
 * %-EBADMSG an invalid reply; %-EMSGSIZE a mailbox that is too small or larger
 * than a datagram; %-ECANCELED the slave was disconnected (while it is being
 * configured the call waits); %-ENODEV the master has no device, %-ENETDOWN no
 * link; %-EINTR; %-ENOMEM; for a mailbox error reply of the slave %-EBADE (code
 * 1), %-EPFNOSUPPORT (2), %-ECHRNG (3), %-EBADRQC (4), %-EBADR (5), %-ENODATA
 * (6), %-EXFULL (7), %-EDOM (8), %-EALREADY (9) or %-ECOMM (any other code).
 */
EC_PUBLIC_API int ecrt_master_sdo_download(ec_master_t *master,
		uint16_t slave_position, uint16_t index, uint8_t subindex,
		const uint8_t *data, size_t data_size, uint32_t *abort_code);

/**
 * ecrt_master_sdo_download_complete() - write a whole object of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @index: of the object
 * @data: little-endian, begins with subindex 0 in a 16 bit slot
 * @data_size: bytes, 1 to 65536
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * CoE Complete Access from subindex 0 on.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_sdo_download_complete(ec_master_t *master,
		uint16_t slave_position, uint16_t index, const uint8_t *data,
		size_t data_size, uint32_t *abort_code);

/**
 * ecrt_master_sdo_upload() - read an object of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @index: of the object
 * @subindex: of the object
 * @target: out: the value
 * @target_size: buffer size, bytes
 * @result_size: out: bytes that were read; on failure untouched in userspace, 0 in
 *	the kernel
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-ENOBUFS larger than @target_size or than 65536 bytes, nothing is
 * copied; else as ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_sdo_upload(ec_master_t *master,
		uint16_t slave_position, uint16_t index, uint8_t subindex,
		uint8_t *target, size_t target_size, size_t *result_size,
		uint32_t *abort_code);

/**
 * ecrt_master_write_idn() - write an IDN of a servo drive
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring; aliases have no effect
 * @drive_no: drive of the slave, 0 to 7
 * @idn: bit 15: P, else S; bits 12-14 parameter set; bits 0-11 number
 * @data: little-endian; a list begins with its length and largest length, 16
 *	bit each
 * @data_size: bytes, at least 1, at most 65536
 * @error_code: out, may be NULL: SoE error code, 0 if the slave gave none
 *
 * SoE write of the value (ETG.1000.6 5.7).
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-EIO refused, see @error_code; %-EINVAL no such slave or drive,
 * or bad arguments; %-EPROTONOSUPPORT slave without SoE; %-EMSGSIZE the
 * mailbox has no space for data; %-ETIMEDOUT no reply; %-EAGAIN slave in INIT; %-EBADMSG an invalid
 * reply; %-ECANCELED the slave was disconnected (while it is being configured the
 * call waits); %-ENODEV the master has no device, %-ENETDOWN no link; %-EINTR;
 * %-ENOMEM; %-ENOTRECOVERABLE and a mailbox error reply as in
 * ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_write_idn(ec_master_t *master,
		uint16_t slave_position, uint8_t drive_no, uint16_t idn,
		const uint8_t *data, size_t data_size, uint16_t *error_code);

/**
 * ecrt_master_read_idn() - read an IDN of a servo drive
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @drive_no: drive of the slave, 0 to 7
 * @idn: as in ecrt_master_write_idn()
 * @target: out: the value
 * @target_size: buffer size, bytes
 * @result_size: out: bytes that were read; on failure untouched in userspace, 0 in
 *	the kernel
 * @error_code: as in ecrt_master_write_idn()
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-ENOBUFS larger than @target_size or than 65536 bytes, nothing is
 * copied; else as ecrt_master_write_idn(), without %-ENOTRECOVERABLE.
 */
EC_PUBLIC_API int ecrt_master_read_idn(ec_master_t *master,
		uint16_t slave_position, uint8_t drive_no, uint16_t idn,
		uint8_t *target, size_t target_size, size_t *result_size,
		uint16_t *error_code);

/* @flags of ecrt_master_write_eeprom() and ecrt_master_write_alias() */
typedef enum {
	EC_EEPROM_WRITE_FORCE = 1,	/* while the slave runs; the image of another device */
	EC_EEPROM_WRITE_UNREACHABLE = 2, /* an image that may make the slave unreachable */
	EC_EEPROM_WRITE_CHECKSUM = 4,	/* write the right checksum in any case */
	EC_EEPROM_WRITE_DRY_RUN = 8	/* check and compare, write nothing */
} ec_eeprom_write_flags_t;

typedef struct {
	uint32_t differ;		/* words that differed */
	uint32_t written;		/* words written and read back */
	uint16_t register_alias;	/* register 0x0012 of the slave */
	uint8_t renewed;		/* the master has read the slave again */
} ec_eeprom_written_t;

/**
 * ecrt_master_read_eeprom() - read the EEPROM of a slave
 * @master: an open master; need not be reserved
 * @slave_position: in the ring
 * @word: first word
 * @target: out: the words, little-endian
 * @target_size: buffer size, bytes
 * @result_size: out: bytes read, fewer where the image ends
 *
 * Extension (%EC_HAVE_EEPROM). The image is that of the last bus scan; no traffic.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL no such slave or bad arguments; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_master_read_eeprom(ec_master_t *master,
		uint16_t slave_position, uint16_t word, uint8_t *target,
		size_t target_size, size_t *result_size);

/**
 * ecrt_master_write_eeprom() - write the EEPROM of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @word: first word; 0 for a whole image
 * @data: words, little-endian
 * @size: bytes, even
 * @flags: of ec_eeprom_write_flags_t
 * @written: out, may be NULL: what was done
 *
 * Extension (%EC_HAVE_EEPROM), as "ethercat sii_write". The image is checked first; only words
 * that differ are written, words 0 to 7 after all others, and all are read back. When a call is
 * interrupted, the same call continues. With @word other than 0 the words before and behind are
 * those of the last bus scan. Then the master reads the slave again, unless it is in SAFEOP or OP.
 *
 * Context: Process. Waits for bus traffic; a word takes some milliseconds.
 * Return: 0; %-EINVAL no such slave, or bad arguments; %-EBADMSG refused without
 * %EC_EEPROM_WRITE_UNREACHABLE; %-EPERM the image of another device without
 * %EC_EEPROM_WRITE_FORCE, or @master not opened for writing; %-EFBIG larger than the EEPROM;
 * %-EBUSY the slave runs, has a configuration, or is being configured; %-EIO not all words were
 * written; %-EINTR, %-ECANCELED, %-ENODEV, %-ENETDOWN, %-ENOMEM. The reason is reported.
 */
EC_PUBLIC_API int ecrt_master_write_eeprom(ec_master_t *master,
		uint16_t slave_position, uint16_t word, const uint8_t *data,
		size_t size, uint32_t flags, ec_eeprom_written_t *written);

/**
 * ecrt_master_write_alias() - write the alias of a slave into its EEPROM
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @alias: 0: none
 * @flags: %EC_EEPROM_WRITE_FORCE, %EC_EEPROM_WRITE_CHECKSUM if the checksum may be wrong before
 * @written: out, may be NULL: @register_alias and @renewed
 *
 * Extension (%EC_HAVE_EEPROM), as "ethercat alias": words 4 and 7. The master uses the alias at
 * once; many slaves set their register at power-on only.
 *
 * Context: Process. Waits for bus traffic.
 * Return: As ecrt_master_write_eeprom().
 */
EC_PUBLIC_API int ecrt_master_write_alias(ec_master_t *master,
		uint16_t slave_position, uint16_t alias, uint32_t flags,
		ec_eeprom_written_t *written);

/**
 * ecrt_master_activate() - lay out the process image and start cyclic operation
 * @master: a reserved master
 *
 * Lays out the frames of the cycle and the process image, which starts with zeros, and
 * returns at once. The master configures the slaves and requests OP while the application
 * runs its cycle. The list of slaves is no longer held: a scan that is due runs now. In userspace
 * the image is mapped with all its pages, so the cycle causes no
 * page fault; an image of 0 bytes is valid. After a failure call ecrt_release_master(); after
 * %-EEXIST the application may also call ecrt_master_end_detached() and then this function
 * again. If a detached cycle of the kernel runs (%EC_CYCLE_DETACH), the application takes it
 * over.
 *
 * Context: Process. May sleep.
 * Return: 0, also when the master is active already (with a message on stderr, in the kernel
 * in the log); %-EBUSY process data were changed after they were registered (see
 * ecrt_slave_config_reg_pdo_entry()); %-EPERM not reserved; %-ENOMEM;
 * %-EOVERFLOW too much process data; %-ENOSPC acyclic frames do not fit and may delay no
 * cycle (ecrt_master_set_late_cycles()); %-EEXIST a detached cycle of another
 * configuration runs; %-EOPNOTSUPP a domain has a division, and the application
 * runs the cycle; %-ENODEV the CPU chosen for the cycle is offline; %-ETIMEDOUT the
 * cycle to take over does not respond; %-EPROTO in userspace: the library does not support
 * the layout of the mapped memory; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_activate(ec_master_t *master);

/**
 * ecrt_master_deactivate() - stop cyclic operation and free the configuration
 * @master: an active master
 *
 * Frees all domains and slave configurations. All handles and pointers obtained since the
 * reservation become invalid, except @master, which remains reserved and may be configured
 * again. Slaves go to PREOP. From now on the list of slaves is held as by
 * ecrt_master_reserve(), until the next activation or release. A scan that is in progress or due
 * runs first: the call waits for it at most 30 s, or until a signal, then holds the list unchanged.
 *
 * Context: Process. May sleep, at most 30 s.
 * Return: 0; %-EINVAL not active, nothing was freed.
 */
EC_PUBLIC_API int ecrt_master_deactivate(ec_master_t *master);

/**
 * ecrt_master_set_send_interval() - configure the cycle time
 * @master: a reserved master, not active
 * @send_interval: microseconds between two calls of ecrt_master_send()
 *
 * Optional; without it, or with more than 1 s, the interval is measured and limited to
 * 1 s. It limits the acyclic frames that are sent beside the process data.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL 0; %-EBUSY active; %-EPERM not reserved.
 */
EC_PUBLIC_API int ecrt_master_set_send_interval(ec_master_t *master,
		size_t send_interval);

/**
 * ecrt_master_send() - send the queued domains and acyclic frames
 * @master: an active master
 *
 * Call once per cycle, as the last call. Sends queued domains, then acyclic frames
 * that fit. Reads the outputs of the process image. One system call in userspace.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL not active; %-ENODEV the device is detached; %-ECANCELED the
 * kernel ran the cycle and has stopped it (%EC_CYCLE_STOP). In the kernel
 * also %-EAGAIN: after a cycle timeout bus access changes to cyclic, try again in the next
 * cycle; %-EBUSY: another call uses the links; %-EWOULDBLOCK: the device needs a caller that
 * may be preempted.
 */
EC_PUBLIC_API int ecrt_master_send(ec_master_t *master);

#ifdef __KERNEL__
/**
 * ecrt_master_load_compiled() - configure a master by a compiled bus file
 * @master: a requested master, not active, without configurations and domains
 * @image: what 'ethercat bus compile' has written, for example from request_firmware();
 *	not needed any more after the call
 * @size: bytes
 *
 * Extension (%EC_HAVE_COMPILED_BUS). Makes the calls of this interface that ecrt_master_load() of
 * libethercat-bus makes in a process: configurations, PDOs, startup commands, time limits, clocks,
 * sync units, hot connect groups, domains and the interval of the cycle. Slaves without alias are
 * those at the ring positions of the file; the master checks the identity of each. Then register
 * values by ecrt_master_value(), and activate the master, with ecrt_master_set_cycle() before if
 * the kernel runs the cycle.
 *
 * The whole of @image is checked before the first call; if it is not valid nothing is configured,
 * and the log has the byte and the reason. When a call fails, as the log says, a part is
 * configured: release the master. Kernel only.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EBADMSG not a compiled bus, cut off or changed; %-EPROTONOSUPPORT of another
 * version; %-EFBIG; %-EINVAL not valid, or an argument is NULL; %-EBUSY active, or loaded already;
 * %-EPERM not requested; %-ENOMEM; or as the call that failed.
 */
EC_PUBLIC_API int ecrt_master_load_compiled(ec_master_t *master, const void *image, size_t size);

/**
 * struct ec_loaded_t - what ecrt_master_load_compiled() has loaded
 * @cycle_ns: cycle of the file, for ecrt_master_set_cycle(); 0: none
 * @slaves: configurations
 * @clocks: of them with SYNC signals
 * @values: values
 */
typedef struct {
	uint64_t cycle_ns;
	unsigned int slaves;
	unsigned int clocks;
	unsigned int values;
} ec_loaded_t;

/**
 * ecrt_master_loaded() - get what was loaded
 * @master: master after ecrt_master_load_compiled()
 * @loaded: result
 *
 * Extension (%EC_HAVE_COMPILED_BUS). Kernel only; libethercat-bus has a function of this name for
 * processes.
 *
 * Context: Process.
 * Return: 0; %-ENOENT nothing is loaded; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_loaded(const ec_master_t *master, ec_loaded_t *loaded);

/**
 * struct ec_value_t - a value in the process data: its unit has raw * scale_num / scale_den +
 *	offset_num / offset_den
 * @domain: it is in the data of this domain
 * @slave: its slave
 * @byte: first byte in the data
 * @bit: first bit in @byte, 0 to 7
 * @bits: size
 * @type: 0 unsigned, 1 bool, 2 to 5 signed of 8 to 64 bits, 6 to 9 unsigned of 8 to 64 bits,
 *	10 and 11 floating point of 32 and 64 bits
 * @output: 1: the application writes it
 * @object: index << 8 | subindex
 * @scale_num: not 0
 * @scale_den: not 0
 * @offset_num: any
 * @offset_den: not 0
 * @unit: UTF-8, "": none; valid as long as @domain
 */
typedef struct {
	ec_domain_t *domain;
	ec_slave_config_t *slave;
	uint32_t byte;
	uint8_t bit;
	uint8_t bits;
	uint8_t type;
	uint8_t output;
	uint32_t object;
	int64_t scale_num;
	uint64_t scale_den;
	int64_t offset_num;
	uint64_t offset_den;
	const char *unit;
} ec_value_t;

/**
 * ecrt_master_value() - find a value by its name
 * @master: master after ecrt_master_load_compiled()
 * @name: name as "axis1.position"
 * @value: result
 *
 * Extension (%EC_HAVE_COMPILED_BUS). The names are those of the bus file; values that it does not
 * name are called by their object, as "io1.x6000_01". Results are valid until
 * ecrt_master_deactivate() or ecrt_release_master(). Kernel only; libethercat-bus has a function
 * of this name for processes.
 *
 * Context: Process. A search in a sorted list: look up before the cycle.
 * Return: 0; %-ENOENT no such value, or nothing is loaded; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_value(const ec_master_t *master, const char *name,
		ec_value_t *value);

/**
 * ecrt_master_callbacks() - set the hooks that exchange acyclic frames between two cycles
 * @master: a requested master, not active
 * @send_cb: called when acyclic frames wait; takes the application's lock, if it is free,
 *	and calls ecrt_master_send_ext()
 * @receive_cb: called when replies are expected; likewise calls ecrt_master_receive()
 * @cb_data: argument of both
 *
 * Without hooks acyclic frames go out with the cycle, and each exchange takes a
 * cycle. With both hooks a thread of the master calls them between two cycles, which
 * is faster beside a slow cycle. A hook may return without action. One thread calls the
 * hooks; they may sleep. After ecrt_master_deactivate() or ecrt_release_master() has returned,
 * no hook is called; the caller of these functions must not hold the lock that a hook takes.
 * ecrt_request_master() removes hooks. Kernel only.
 *
 * Context: Process. May sleep.
 */
EC_PUBLIC_API void ecrt_master_callbacks(ec_master_t *master,
		void (*send_cb)(void *), void (*receive_cb)(void *),
		void *cb_data);

/**
 * ecrt_master_send_ext() - send acyclic frames between two cycles
 * @master: an active master
 *
 * For the send hook of ecrt_master_callbacks(). Sends no process data, and
 * nothing at all when the next cycle is near. Kernel only.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; %-EAGAIN another call uses the links, or bus access changes to cyclic after a
 * cycle timeout; otherwise as ecrt_master_send().
 */
EC_PUBLIC_API int ecrt_master_send_ext(ec_master_t *master);
#endif

/**
 * ecrt_master_receive() - receive frames and update the inputs
 * @master: an active master
 *
 * Call once per cycle, as the first call. Polls the network devices and copies inputs to the
 * process image; no other call changes input bytes. Never waits. Inputs of a lost frame keep
 * their values. One system call in userspace.
 *
 * Context: The cycle owner. RT-safe.
 * Return: as ecrt_master_send().
 */
EC_PUBLIC_API int ecrt_master_receive(ec_master_t *master);

/**
 * ecrt_master_state() - get the state of the whole bus
 * @master: an opened master
 * @state: out
 *
 * From the last broadcast that the master received (registers 0x0130, 0x0000), some cycles
 * old. No bus traffic; no system call while active.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation. In
 * userspace before activation: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_state(const ec_master_t *master,
		ec_master_state_t *state);

/**
 * ecrt_master_link_state() - get the state of the slaves that one link reaches
 * @master: an opened master
 * @dev_idx: 0 main, 1 backup
 * @state: out
 *
 * As ecrt_master_state(); no system call while active.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation. In
 * userspace before activation: Process. May sleep.
 * Return: 0; %-EINVAL no such link, or an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_link_state(const ec_master_t *master,
		unsigned int dev_idx, ec_master_link_state_t *state);

/**
 * ecrt_master_application_time() - set the application time
 * @master: a reserved master
 * @app_time: ns, by convention since 2000-01-01; may wrap and jump
 *
 * Call once per cycle, always at the same point. Synchronization begins with the first cycle;
 * synchronized clocks do not follow jumps of this time.
 *
 * Context: The cycle owner. RT-safe. In userspace before
 * activation: Process. May sleep.
 * Return: 0; %-EPERM not reserved; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_application_time(ec_master_t *master,
		uint64_t app_time);

/**
 * ecrt_master_select_reference_clock() - select the reference clock
 * @master: a reserved master
 * @sc: slave whose clock is the reference; NULL: the first suitable slave
 *
 * If this slave has no clock or is absent at activation, there is no reference clock. When it
 * is lost later, or is absent while a ring is open, another slave substitutes until it returns.
 * A reference clock that is not configured goes to OP with the other slaves, unless it has
 * outputs.
 *
 * Context: Process. May sleep. Before activation.
 * Return: 0; %-EPERM not reserved; %-EBUSY active; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_select_reference_clock(ec_master_t *master,
		ec_slave_config_t *sc);

/**
 * ecrt_master_sync_reference_clock() - queue a write of the application time to the reference clock
 * @master: an active master
 *
 * The next send writes the low 32 bits of the application time to the reference clock (register
 * 0x0910): that of the send, by the mean of the last 512 application times, less their jumps
 * since the clocks were synchronized. While a time is inconsistent with the earlier ones, and
 * until all clocks are near each other after activation, none is written.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-ENXIO no reference clock; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_master_sync_reference_clock(ec_master_t *master);

/**
 * ecrt_master_sync_reference_clock_to() - queue a write of @sync_time to the reference clock
 * @master: an active master
 * @sync_time: ns; must not jump
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-ENXIO no reference clock; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_master_sync_reference_clock_to(ec_master_t *master,
		uint64_t sync_time);

/**
 * ecrt_master_sync_slave_clocks() - queue the drift compensation datagram
 * @master: an active master
 *
 * The next send distributes the time of the reference clock to all slaves downstream (FRMW of
 * register 0x0910). Call once per cycle. Until the master has synchronized the clocks after
 * activation, the send has no such datagram.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-ENXIO no reference clock; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_master_sync_slave_clocks(ec_master_t *master);

/**
 * ecrt_master_reference_clock_time() - get the system time of the reference clock
 * @master: an active master
 * @time: out: low 32 bits of its system time, ns
 *
 * From the frame of the last ecrt_master_sync_slave_clocks(); valid between
 * ecrt_master_receive() and the next ecrt_master_sync_slave_clocks(). Prints nothing.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; %-ENXIO no reference clock; %-EIO no reply to that
 * frame, or none was sent; %-EINVAL not active, or @time is NULL.
 */
EC_PUBLIC_API int ecrt_master_reference_clock_time(const ec_master_t *master,
		uint32_t *time);

/**
 * ecrt_master_sync_monitor_queue() - queue a read of the DC differences
 * @master: an active master
 *
 * The next send reads register 0x092C of all slaves.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_master_sync_monitor_queue(ec_master_t *master);

/**
 * ecrt_master_sync_monitor_process() - get the result of the last read of the DC differences
 * @master: an active master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bitwise OR of the absolute DC differences of all slaves, ns; not below the largest
 * difference. 0xffffffff: no reply.
 */
EC_PUBLIC_API uint32_t ecrt_master_sync_monitor_process(
		const ec_master_t *master);

#ifdef EC_HAVE_KERNEL_CYCLE

/* reaction to an output stall: no new outputs for @stall_cycles */
typedef enum {
	EC_CYCLE_HOLD = 0,	/* send the last outputs */
	EC_CYCLE_ZERO = 1,	/* send zeros until there are new outputs */
	/*
	 * stops the cycle; slaves leave OP when their watchdogs expire.
	 * ecrt_master_receive() and ecrt_master_send() return -ECANCELED, domains have
	 * working counter 0
	 */
	EC_CYCLE_STOP = 2,
} ec_cycle_stall_t;

typedef enum {
	EC_CYCLE_NONE = 0,	/* the application runs the cycle */
	EC_CYCLE_RUNNING = 1,
	EC_CYCLE_STALLED = 2,	/* output stall: EC_CYCLE_HOLD or EC_CYCLE_ZERO applies */
	EC_CYCLE_STOPPED = 3,	/* by EC_CYCLE_STOP, until deactivation */
	EC_CYCLE_WAITING = 4,	/* EC_CYCLE_WAIT_OUTPUTS: nothing sent yet */
} ec_cycle_run_t;

/* ec_cycle_config_t.flags */
#define EC_CYCLE_DETACH		1U	/* continues when the application exits */
#define EC_CYCLE_WAIT_OUTPUTS	2U	/* the first frame waits for outputs */
#define EC_CYCLE_BIND_CPU	4U	/* the thread runs on @cpu only */
#define EC_CYCLE_INTERRUPT	8U	/* in the interrupt of its timer, where possible */

/* ec_cycle_config_t.dc: clock datagrams of every cycle */
#define EC_CYCLE_SYNC_REFERENCE	2U	/* write its time to the reference clock */
#define EC_CYCLE_SYNC_SLAVES	4U	/* drift compensation of all slaves */
#define EC_CYCLE_SYNC_MONITOR	8U	/* read the DC differences */
#define EC_CYCLE_REFERENCE_TIME	32U	/* read all 64 bits of the reference clock */
/*
 * The cycle is phase-locked to the reference clock: the kernel adjusts period and phase of the
 * timer, by at most 1/100 of the period per cycle, so that the frame passes that clock
 * @phase_ns after a SYNC0 without shift. Needs EC_CYCLE_SYNC_SLAVES, excludes
 * EC_CYCLE_SYNC_REFERENCE.
 */
#define EC_CYCLE_FOLLOW_REFERENCE	256U

/**
 * struct ec_cycle_config_t - how the kernel runs the cycle
 * @period_ns: 10000..1000000000 ns
 * @phase_ns: cycles begin at multiples of the period of CLOCK_MONOTONIC, plus
 *	this; less than the period. With EC_CYCLE_FOLLOW_REFERENCE it counts
 *	from the grid of the SYNC signals.
 * @cpu: CPU of the thread, with %EC_CYCLE_BIND_CPU. Without that flag the thread runs on any
 *	CPU, and @cpu must be 0 or -1. While the CPU is offline, the thread runs on any
 *	other.
 * @priority: of the thread, SCHED_FIFO, 1..98; 0: 50. The caller of
 *	ecrt_master_set_cycle() needs CAP_SYS_NICE; otherwise its RLIMIT_RTPRIO limits the
 *	priority, and with limit 0 the thread runs SCHED_OTHER. The kernel log and 'ethercat
 *	cycle' report a limited priority. After a takeover (%EC_CYCLE_DETACH) the limit of
 *	the new application applies.
 * @stall: reaction to an output stall
 * @stall_cycles: an output stall is this number of cycles in a row without new outputs; 0:
 *	there is no output stall. The count begins with the first outputs.
 * @dc: EC_CYCLE_SYNC_* and EC_CYCLE_FOLLOW_REFERENCE
 * @flags: %EC_CYCLE_DETACH: when the application exits, or releases the master
 *	without ecrt_master_deactivate(), the cycle continues: @stall determines the
 *	outputs (%EC_CYCLE_STOP is refused), slaves stay in OP. An application takes the
 *	running cycle over when it requests the master, makes the same configuration in the
 *	same order, and activates the master. Outputs, inputs and slaves do not change. See
 *	also ecrt_master_end_detached().
 *	%EC_CYCLE_WAIT_OUTPUTS: the kernel counts cycles and the application can wait for
 *	them, but no frame is sent until the first ecrt_master_send() with a queued domain.
 *	Without this flag the first cycle sends a frame, with zeros as outputs.
 *	%EC_CYCLE_INTERRUPT: the cycle runs in the interrupt of its timer. No thread has to
 *	wake up for it and none delays it, at any priority; the cycle delays all
 *	threads of that CPU. It needs a native device, and CAP_SYS_NICE or RLIMIT_RTPRIO 99.
 *	Otherwise, and for 1000 cycles after the interrupt left too little time to those
 *	threads, the thread of the cycle runs it. 'ethercat cycle' reports the place and the
 *	reason, the kernel log reasons that can be mended.
 *
 * C++20 accepts designated initializers in this order only.
 */
typedef struct {
	uint32_t period_ns;
	uint32_t phase_ns;
	int32_t cpu;
	uint32_t priority;
	ec_cycle_stall_t stall;
	uint32_t stall_cycles;
	uint32_t dc;
	uint32_t flags;
} ec_cycle_config_t;

#define EC_CYCLE_BINS		32

typedef enum {
	EC_CYCLE_UNLOCKED = 0,	/* not configured, or no reference clock yet */
	EC_CYCLE_SEEKING = 1,
	EC_CYCLE_LOCKED = 2,	/* phase-locked to the reference clock */
	EC_CYCLE_HOLDING = 3,	/* holdover: reference clock silent, last rate kept */
} ec_cycle_lock_t;

/**
 * struct ec_cycle_state_t - cycle statistics since activation, or since
 *	'ethercat cycle --reset'
 * @run: current state
 * @cycles: cycles of the kernel so far, since activation
 * @overruns: skipped cycles: a period or more passed without a send
 * @missed: cycles of the kernel without new outputs, after the first ones
 * @late_min: smallest send deviation, ns
 * @late_mean: mean send deviation, ns
 * @late_max: largest send deviation, ns
 * @late_p999: limit that 99.9 % of the send deviations did not exceed, ns; up to 1/8 too large
 * @work_last: execution time of the last cycle of the kernel, ns
 * @work_mean: mean execution time, ns
 * @work_max: largest execution time, ns
 * @late: sends by send deviation: [0] 0 ns, [n] 2^(n-1) to 2^n - 1 ns, the last
 *	element includes all larger values
 * @lock: to the reference clock, with EC_CYCLE_FOLLOW_REFERENCE
 * @lock_losses: number of losses of the lock
 * @phase_error: phase error of the cycle by the reference clock, ns; positive: late
 * @rate_ppb: rate of the reference clock against CLOCK_MONOTONIC, 1e-9; positive: faster
 * @takeovers: number of applications that have taken over the cycle
 *
 * The schedule of a cycle run by the kernel is its timer. For a cycle run by the application
 * it is a grid of the configured interval (ecrt_master_set_send_interval()), otherwise of the
 * measured one. The grid adapts slowly to the sends, and a send may be early or late.
 */
typedef struct {
	ec_cycle_run_t run;
	uint64_t cycles;
	uint64_t overruns;
	uint64_t missed;
	uint32_t late_min;
	uint32_t late_mean;
	uint32_t late_max;
	uint32_t late_p999;
	uint32_t work_last;
	uint32_t work_mean;
	uint32_t work_max;
	uint64_t late[EC_CYCLE_BINS];
	ec_cycle_lock_t lock;
	uint32_t lock_losses;
	int32_t phase_error;
	int32_t rate_ppb;
	uint32_t takeovers;
} ec_cycle_state_t;

/**
 * ecrt_master_set_cycle() - let the kernel run the cycle
 * @master: a reserved master, not active
 * @config: parameters of the cycle; NULL: the application runs the cycle
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). From activation to deactivation a real-time
 * thread of the kernel receives and sends all domains. ecrt_master_receive() then takes the
 * newest inputs of all domains, and ecrt_master_send() passes the outputs of the queued
 * domains to the next cycle. Both copy memory, without a system call. An image is
 * complete and from one cycle. The thread sets the application time and queues clock
 * datagrams: ecrt_master_application_time() and the calls that queue clock datagrams have no
 * effect::
 *
 *   ecrt_master_set_cycle(master, &config);
 *   ecrt_master_activate(master);
 *   each cycle:
 *	ecrt_master_wait_cycle(master, 0);
 *	ecrt_master_receive(master);
 *	ecrt_domain_process(domain);
 *	... read inputs, write outputs ...
 *	ecrt_domain_queue(domain);
 *	ecrt_master_send(master);
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an invalid value; %-EOPNOTSUPP an unknown flag; %-EBUSY active; %-EPERM
 * not reserved.
 */
EC_PUBLIC_API int ecrt_master_set_cycle(ec_master_t *master,
		const ec_cycle_config_t *config);

/**
 * ecrt_master_wait_cycle() - wait for the next cycle of the kernel
 * @master: an active master whose cycle the kernel runs
 * @timeout_us: limit, 0: none
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). Returns at once when a cycle has passed since
 * the last call. One system call in userspace. To wait for other files as well, poll
 * ecrt_master_cycle_fd(). To spin, call ecrt_master_receive() until it fails or
 * ecrt_master_cycle_count() has increased.
 *
 * Context: The cycle owner, in a process or thread. Sleeps until the next cycle.
 * Return: number of cycles since the last call, 1 when none was missed; %-ETIMEDOUT; %-EINTR
 * a signal, or in the kernel kthread_stop() of the calling thread; %-ECANCELED the cycle has
 * stopped; %-EBUSY 16 threads already wait; %-EINVAL not active, or the application runs the
 * cycle.
 */
EC_PUBLIC_API int ecrt_master_wait_cycle(ec_master_t *master,
		uint32_t timeout_us);

/**
 * ecrt_master_cycle_count() - get the number of cycles the kernel has run
 * @master: an active master whose cycle the kernel runs
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). No system call. When the count has increased,
 * ecrt_master_receive() can take the inputs of that cycle. After %EC_CYCLE_STOP the count
 * no longer increases, and ecrt_master_receive() returns %-ECANCELED.
 *
 * Context: Any, but no interrupt of a 32-bit kernel. RT-safe: bounded, no sleep, no
 * allocation.
 * Return: cycles since activation; 0 when not active.
 */
EC_PUBLIC_API uint64_t ecrt_master_cycle_count(const ec_master_t *master);

/**
 * ecrt_master_cycle_inputs() - get number and time of the cycle that received the inputs
 * @master: an active master whose cycle the kernel runs
 * @cycle: out: its number, as ecrt_master_cycle_count() counts; may be NULL
 * @time_ns: out: its schedule, ns of CLOCK_MONOTONIC; may be NULL
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). Of the inputs that the last successful
 * ecrt_master_receive() has taken. The frames of these inputs were sent one cycle before.
 * No system call.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-ENODATA no inputs were taken yet; %-EINVAL not active, or the application
 * runs the cycle.
 */
EC_PUBLIC_API int ecrt_master_cycle_inputs(const ec_master_t *master,
		uint64_t *cycle, uint64_t *time_ns);

#ifndef __KERNEL__
/**
 * ecrt_master_cycle_fd() - get a file descriptor for poll() or epoll
 * @master: an active master whose cycle the kernel runs
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). POLLIN: there are inputs that
 * ecrt_master_receive() has not taken yet; POLLHUP: the cycle has stopped; POLLERR: not
 * active any more, or more than 16 poll() and epoll entries wait on the file. The
 * file belongs to the library: do not close or read it. In userspace only: a module has no
 * file.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: file descriptor; %-EINVAL not active, or the application runs the
 * cycle.
 */
EC_PUBLIC_API int ecrt_master_cycle_fd(const ec_master_t *master);

/**
 * ecrt_master_leave() - leave the running cycle to the master, as "ethercat run" does
 * @master: an active master whose cycle the kernel runs, with @stall_cycles 0
 *
 * Extension (%EC_HAVE_LEAVE). The cycle continues without any process until "ethercat stop" or
 * ecrt_master_end_detached(). Outputs become zero; "ethercat set" sets them. No application can
 * take the cycle over. Sync units with a lease, authority or a policy are refused.
 *
 * On success @master is as after ecrt_open_master(): handles and pointers obtained since the
 * reservation are invalid. After a failure call ecrt_release_master(), which ends the session.
 * In userspace only.
 *
 * Context: Process. Sleeps until the next cycle has begun. No other thread uses @master.
 * Return: 0; %-EINVAL not active, the application runs the cycle, an output stall, or such a sync
 * unit; %-EBUSY another process has memory of the session mapped; %-ETIMEDOUT the cycle does not
 * run; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_master_leave(ec_master_t *master);

/**
 * ecrt_master_set_names() - say what tools call the values of this application
 * @master: a reserved master
 * @text: a bus file with one master, whose slaves are in the order of the configurations
 * @size: bytes, at most 4 MiB; 0: no names
 *
 * Extension (%EC_HAVE_NAMES). "ethercat data --names", "watch" and "set" use the names, types,
 * units and scaling of the text, as long as the configuration exists. The master does not read it.
 * ecrt_master_load() of libethercat-bus calls this function. In userspace only.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EPERM not reserved; %-E2BIG too long; %-EDQUOT, %-ENOMEM; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_set_names(ec_master_t *master, const char *text, size_t size);

/**
 * ecrt_master_set_data() - keep data of another library as long as its handles are valid
 * @master: an opened master
 * @data: data of the caller; NULL: none any more
 * @release: frees @data; it also is the key of the data
 *
 * Extension (%EC_HAVE_MASTER_DATA). Calls @release with the earlier data of the same key; with the
 * last ones when the handles of configurations and domains become invalid: by
 * ecrt_master_deactivate(), ecrt_master_leave() and ecrt_release_master(). In userspace only.
 *
 * Context: Process. One thread at a time.
 * Return: 0; %-EINVAL @master or @release is NULL; %-ENOMEM, and @release is not called.
 */
EC_PUBLIC_API int ecrt_master_set_data(ec_master_t *master, void *data,
		void (*release)(void *data));

/**
 * ecrt_master_data() - get the data of ecrt_master_set_data()
 * @master: an opened master
 * @release: key
 *
 * Extension (%EC_HAVE_MASTER_DATA). In userspace only.
 *
 * Context: Any; not beside ecrt_master_set_data(). RT-safe: bounded, no sleep, no allocation.
 * Return: the data; NULL: none.
 */
EC_PUBLIC_API void *ecrt_master_data(const ec_master_t *master, void (*release)(void *data));
#endif

/**
 * ecrt_master_cycle_state() - get cycle statistics
 * @master: an active master
 * @state: out
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). No system call.
 *
 * Context: Any, but no interrupt of a 32-bit kernel. RT-safe: bounded, no sleep, no
 * allocation.
 * Return: 0; %-EINVAL not active, or an argument is NULL.
 */
EC_PUBLIC_API int ecrt_master_cycle_state(const ec_master_t *master,
		ec_cycle_state_t *state);

/**
 * ecrt_domain_set_division() - exchange a domain in every n-th cycle only
 * @domain: domain of a master that is not active
 * @division: cycles from one exchange to the next, 1..1000
 * @phase: cycle of the first exchange, 0..@division - 1; cycles count from activation,
 *	skipped cycles included
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE), for a cycle run by the kernel. Between two exchanges
 * the state and inputs of the domain do not change. When the cycle of an exchange is skipped,
 * the next cycle sends the domain. The watchdogs of its slaves must be longer than @division
 * cycles.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an invalid value; %-EBUSY active.
 */
EC_PUBLIC_API int ecrt_domain_set_division(ec_domain_t *domain,
		unsigned int division, unsigned int phase);

/**
 * ecrt_domain_copy() - copy process data from an input to an output in each cycle
 * @to: domain with the output
 * @to_offset: byte in @to, as ecrt_slave_config_reg_pdo_entry() returned it
 * @to_bit: bit in that byte
 * @from: domain with the input, of the same master; may be @to
 * @from_offset: byte in @from
 * @from_bit: bit in that byte
 * @bits: number of bits
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). Configured once, before activation. The kernel copies
 * between receive and send of each cycle: the frame of this cycle sends the inputs that this
 * cycle has received. Copies continue after the application has exited. Values that the
 * application writes to these outputs have no effect. While the working counter of @from is
 * not complete, the last value is sent; 0 before it was complete for the first time. When the
 * application runs the cycle, its process data contain the value after ecrt_master_send().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL the bits are not input, or not output, of one slave, or the
 * domains are of two masters; %-EEXIST another copy writes to some of these bits;
 * %-EBUSY active; %-ENOSPC more than 1024; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_domain_copy(ec_domain_t *to, unsigned int to_offset,
		unsigned int to_bit, const ec_domain_t *from,
		unsigned int from_offset, unsigned int from_bit,
		unsigned int bits);

/**
 * ecrt_master_end_detached() - end a detached session
 * @master: a master opened for writing; need not be reserved
 *
 * Extension (%EC_HAVE_KERNEL_CYCLE). Its slaves go to PREOP. When ecrt_master_activate() has
 * returned %-EEXIST because the configurations differ, the application may activate after
 * this call. 'ethercat release' does the same.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT nothing is active; %-EBUSY the application that activated
 * the master still runs; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_end_detached(ec_master_t *master);

#endif

/**
 * ecrt_master_reset() - bring the slaves to OP again
 * @master: a master opened for writing; need not be reserved
 *
 * Configures each slave of an active application again that has not reached OP, or for which
 * a tool has requested another state; none after ecrt_master_deactivate_slaves(). Retries
 * other slaves that could not be configured. Does not wait for the slaves; a worker does it
 * soon afterwards, so that an old error may still be shown when the call returns.
 *
 * Context: Any; may be called from the cycle. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_reset(ec_master_t *master);

#ifdef EC_HAVE_DOMAIN_MEMORY
/**
 * ecrt_master_setup_domain_memory() - make the process data available before activation
 * @master: a reserved master, not active, all entries registered
 *
 * Extension (%EC_HAVE_DOMAIN_MEMORY). From now on ecrt_domain_data() is valid. The address
 * does not change until deactivation or release, or until an activation fails. The first
 * cycle sends the values written before ecrt_master_activate(), otherwise zeros. Further
 * domains and entries are refused until deactivation. Userspace only: a module has
 * ecrt_domain_external_memory().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EBUSY active, or called before; %-EINVAL there is no domain;
 * %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_master_setup_domain_memory(ec_master_t *master);
#endif

#ifdef EC_HAVE_DEACTIVATE_SLAVES
/**
 * ecrt_master_deactivate_slaves() - take the slaves to PREOP while the cycle runs
 * @master: an active master
 *
 * Extension (%EC_HAVE_DEACTIVATE_SLAVES). Avoids errors of the slaves at the end of an
 * application: the configured slaves leave OP while process data and SYNC signals still run,
 * so that no watchdog expires and no synchronization is lost. In PREOP the master switches
 * the SYNC signals off (register 0x0980). Continue the cycle until ecrt_slave_config_state()
 * or ecrt_master_state() shows PREOP, then call ecrt_master_deactivate(). Until then the
 * slaves remain in PREOP. No effect on a master that is not active.
 *
 * One system call in userspace; does not wait for the bus.
 *
 * Context: Process. May sleep.
 */
EC_PUBLIC_API void ecrt_master_deactivate_slaves(ec_master_t *master);
#endif

#ifdef EC_HAVE_RT_SLAVE_REQUESTS
/**
 * ecrt_master_rt_slave_requests() - say where the requests of slaves are processed
 * @master: an opened master
 * @rt_slave_requests: 1: the application calls ecrt_master_exec_slave_requests(); 0: it does not
 *
 * Extension (%EC_HAVE_RT_SLAVE_REQUESTS), of the patches to the IgH EtherCAT Master. There a
 * thread of the master processes requests (SDO, SoE, FoE, registers), unless the application does
 * it in its cycle. In this master the setting changes nothing. A message to a slave advances where
 * ecrt_master_receive() is called, its frames leave with ecrt_master_send(), and a worker of each
 * slave prepares the next message. No cycle waits for a worker, and no lock is held over a
 * transfer.
 *
 * Context: Any. RT-safe: no system call.
 * Return: 0; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_rt_slave_requests(ec_master_t *master,
						unsigned int rt_slave_requests);

/**
 * ecrt_master_exec_slave_requests() - process the requests of slaves
 * @master: an opened master
 *
 * Extension (%EC_HAVE_RT_SLAVE_REQUESTS). No effect: requests advance without it, as
 * ecrt_master_rt_slave_requests() describes. For applications that call it in each cycle.
 *
 * Context: Any. RT-safe: no system call.
 */
EC_PUBLIC_API void ecrt_master_exec_slave_requests(ec_master_t *master);
#endif

#ifdef EC_HAVE_EOE_INTERFACES
/**
 * ecrt_master_eoe_addif() - make the network device of a slave with EoE
 * @master: a master opened for writing; need not be reserved
 * @alias: of the slave, 0: @posn is its ring position
 * @posn: position behind the first slave with @alias
 *
 * Extension (%EC_HAVE_EOE_INTERFACES), as "ethercat eoe_addif". It is made shortly after the
 * return, and down. Slaves with EoE have one anyway, unless ec_master was loaded with eoe=0.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @master is NULL; %-ENOENT no such slave; %-EPROTONOSUPPORT the slave has no
 * EoE; %-EPERM without CAP_NET_ADMIN, or @master not opened for writing. The reason is reported.
 */
EC_PUBLIC_API int ecrt_master_eoe_addif(ec_master_t *master, uint16_t alias,
					uint16_t posn);

/**
 * ecrt_master_eoe_delif() - remove the network device of a slave with EoE
 * @master: a master opened for writing; need not be reserved
 * @alias: as ecrt_master_eoe_addif()
 * @posn: as ecrt_master_eoe_addif()
 *
 * Extension (%EC_HAVE_EOE_INTERFACES), as "ethercat eoe_delif". It is removed shortly after the
 * return, also one that is up, and not made again until ecrt_master_eoe_addif().
 *
 * Context: Process. May sleep.
 * Return: As ecrt_master_eoe_addif().
 */
EC_PUBLIC_API int ecrt_master_eoe_delif(ec_master_t *master, uint16_t alias,
					uint16_t posn);

/**
 * ecrt_master_eoe_is_open() - is a network device of a slave with EoE up?
 * @master: an opened master
 *
 * Extension (%EC_HAVE_EOE_INTERFACES).
 *
 * Context: Process. May sleep.
 * Return: 1: one is; 0: none is; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_eoe_is_open(ec_master_t *master);

/**
 * ecrt_master_eoe_process() - carry Ethernet frames
 * @master: an opened master
 *
 * Extension (%EC_HAVE_EOE_INTERFACES). No effect: the mailboxes carry frames without it, beside the
 * cycle and in between. For applications that call it.
 *
 * Context: Any. RT-safe: no system call.
 * Return: 0: there is nothing to be sent, and nothing to be polled for; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_eoe_process(ec_master_t *master);
#endif

#ifdef EC_HAVE_SDO_UPLOAD_COMPLETE
/**
 * ecrt_master_sdo_upload_complete() - read a whole object (Complete Access)
 * @master: a master opened for writing
 * @slave_position: in the ring
 * @index: of the object
 * @target: out: subindex 0 as 16 bits, then the others, packed
 * @target_size: bytes at @target
 * @result_size: out: bytes read; as in ecrt_master_sdo_upload()
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * Extension (%EC_HAVE_SDO_UPLOAD_COMPLETE).
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ecrt_master_sdo_upload().
 */
EC_PUBLIC_API int ecrt_master_sdo_upload_complete(ec_master_t *master,
		uint16_t slave_position, uint16_t index, uint8_t *target,
		size_t target_size, size_t *result_size, uint32_t *abort_code);
#endif

#ifdef EC_HAVE_SDO_INFO
/**
 * struct ec_sdo_object_info_t - description of an object (ETG.1000.6 5.6.3)
 * @index: object
 * @data_type: of a variable; CoE data type, for example 7: UDINT
 * @max_subindex: highest subindex
 * @object_code: 7 variable, 8 array, 9 record
 * @name: with terminator, cut after 63 bytes; character set of the slave
 */
typedef struct {
	uint16_t index;
	uint16_t data_type;
	uint8_t max_subindex;
	uint8_t object_code;
	char name[EC_MAX_STRING_LENGTH];
} ec_sdo_object_info_t;

/**
 * struct ec_sdo_entry_info_t - description of an entry of an object (ETG.1000.6 5.6.3)
 * @index: object
 * @subindex: entry
 * @data_type: CoE data type
 * @bit_length: of the value
 * @access: bits 0 to 2: may be read in PREOP, SAFEOP, OP; bits 3 to 5: may be written in these;
 *	bit 6: may be mapped to an output, bit 7: to an input
 * @name: with terminator, cut after 63 bytes; character set of the slave
 */
typedef struct {
	uint16_t index;
	uint8_t subindex;
	uint16_t data_type;
	uint16_t bit_length;
	uint16_t access;
	char name[EC_MAX_STRING_LENGTH];
} ec_sdo_entry_info_t;

/**
 * ecrt_master_sdo_info_list() - read a list of the objects of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring; aliases have no effect
 * @list_type: 1 all objects, 2 those for outputs, 3 for inputs, 4 for device replacement, 5 for
 *	startup; 0: the number of objects in each of these five lists
 * @target: out: indexes in the byte order of the machine
 * @target_count: how many fit there
 * @result_count: out: how many there are; on failure untouched in userspace, 0 in the kernel
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * Extension (%EC_HAVE_SDO_INFO). SDO information service of CoE (ETG.1000.6 5.6.3).
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-ENOBUFS more than @target_count or than 32768, nothing is copied; otherwise as
 * ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_sdo_info_list(ec_master_t *master,
		uint16_t slave_position, uint8_t list_type, uint16_t *target,
		size_t target_count, size_t *result_count, uint32_t *abort_code);

/**
 * ecrt_master_sdo_info_object() - read the description of an object of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @index: object
 * @info: out; on failure untouched
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-ENOBUFS a description of more than 4096 bytes; otherwise as
 * ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_sdo_info_object(ec_master_t *master,
		uint16_t slave_position, uint16_t index,
		ec_sdo_object_info_t *info, uint32_t *abort_code);

/**
 * ecrt_master_sdo_info_entry() - read the description of an entry of an object
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @index: object
 * @subindex: entry; a gap between the subindexes gives %-EIO
 * @info: out; on failure untouched
 * @abort_code: as in ecrt_master_sdo_download()
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ecrt_master_sdo_info_object().
 */
EC_PUBLIC_API int ecrt_master_sdo_info_entry(ec_master_t *master,
		uint16_t slave_position, uint16_t index, uint8_t subindex,
		ec_sdo_entry_info_t *info, uint32_t *abort_code);

/**
 * ecrt_master_sdo_info_forget() - read the object dictionary of a slave again from now on
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 *
 * Extension (%EC_HAVE_SDO_INFO). The master keeps answers about the dictionary, up to 64 KiB per
 * slave, until the slave goes through INIT or BOOT; a second reading needs no bus traffic. Call
 * this function after a change of the dictionary in another state, for example by an SDO download
 * that configures modules.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL no such slave, or @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_sdo_info_forget(ec_master_t *master,
		uint16_t slave_position);
#endif

#ifdef EC_HAVE_FOE
/* bytes of the name of a file on a slave, at most */
#define EC_FOE_FILE_NAME_SIZE	64

/**
 * ecrt_master_foe_read() - read a file of a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring; aliases have no effect
 * @file_name: name on the slave, 1 to 64 printable characters
 * @password: 0: none
 * @target: out: content; on failure it may have a part of the file
 * @target_size: buffer size, bytes
 * @result_size: out: bytes of the file; on failure untouched in userspace, 0 in
 *	the kernel
 * @error_code: out, may be NULL: FoE error code (ETG.1000.6 5.8), 0 if the slave gave none
 * @timeout: ms, for each message, at most 60000; 0: 10 s
 *
 * Extension (%EC_HAVE_FOE). File access over EtherCAT (ETG.1000.6 5.8). Other protocols use
 * the mailbox between the messages. A slave in BOOT is accessed by its bootstrap mailbox. A
 * transfer that ends early is also ended at the slave.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; %-EIO refused by the slave, see @error_code; %-EINVAL no such slave or bad
 * arguments; %-ENOBUFS larger than @target_size; %-EBUSY another file of this slave is being
 * transferred; %-EPROTONOSUPPORT slave without FoE; %-ETIMEDOUT no reply, or 60 s busy without
 * progress; %-EAGAIN slave in INIT; %-EBADMSG an invalid reply; %-EMSGSIZE a mailbox that is too
 * small; %-ECANCELED the slave was disconnected; %-ENODEV the master has no device, %-ENETDOWN no
 * link; %-EINTR; %-ENOMEM; a mailbox error reply as in ecrt_master_sdo_download().
 */
EC_PUBLIC_API int ecrt_master_foe_read(ec_master_t *master,
		uint16_t slave_position, const char *file_name,
		uint32_t password, uint8_t *target, size_t target_size,
		size_t *result_size, uint32_t *error_code, uint32_t timeout);

/**
 * ecrt_master_foe_write() - write a file to a slave
 * @master: a master opened for writing; need not be reserved
 * @slave_position: in the ring
 * @file_name: as in ecrt_master_foe_read()
 * @password: 0: none
 * @data: content; may be NULL when @data_size is 0
 * @data_size: bytes
 * @error_code: as in ecrt_master_foe_read()
 * @timeout: as in ecrt_master_foe_read(); the first message may erase a flash memory
 *
 * Extension (%EC_HAVE_FOE). What a slave has of a file whose transfer failed depends on the
 * slave.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ecrt_master_foe_read(); %-ENOTRECOVERABLE a frame was lost and the slave does not
 * repeat its messages, so it is not known how much it has written.
 */
EC_PUBLIC_API int ecrt_master_foe_write(ec_master_t *master,
		uint16_t slave_position, const char *file_name,
		uint32_t password, const uint8_t *data, size_t data_size,
		uint32_t *error_code, uint32_t timeout);
#endif

#ifdef EC_HAVE_EVENTS
#define EC_EVENT_ARGUMENTS	8

/**
 * struct ec_event_t - one event
 * @number: of the event since the module was loaded, from 0
 * @time_ns: CLOCK_MONOTONIC
 * @wall_ns: CLOCK_REALTIME, ns since 1970, at that time
 * @kind: see ecrt_event_name()
 * @slave: ring position, 0xffff: not of one slave
 * @reserved: 0
 * @arg: values in the order of 'ethercat log --json'; 0xffffffff instead of a ring position:
 *	no slave. Of the event "missed": lower and upper 32 bits of the number of lost events
 */
typedef struct {
	uint64_t number;
	uint64_t time_ns;
	uint64_t wall_ns;
	uint32_t kind;
	uint16_t slave;
	uint16_t reserved;
	uint32_t arg[EC_EVENT_ARGUMENTS];
} ec_event_t;

/**
 * ecrt_open_events() - open a file to read events from
 * @master_index: index from 0 of /dev/EtherCAT<index>
 * @only_new: nonzero: begin with the next event; 0: with the oldest that is kept
 *
 * Extension (%EC_HAVE_EVENTS). Needs read access only. read() returns whole ec_event_t and
 * waits for one, unless the file has O_NONBLOCK (then EAGAIN); a buffer smaller than an event is
 * EINVAL. poll() returns POLLIN when there is one, within 20 ms of the event. Each file has a
 * position of its own: readers take nothing from others, and never delay the cycle. The master
 * keeps the last 2047 events; a reader that is slower gets an event "missed" with the exact
 * number of events it has lost. Close the file with close().
 *
 * Context: Process. May sleep.
 * Return: file descriptor; %-ENOENT no such master, %-EACCES no access, %-ENOTTY the module has no
 * events.
 */
EC_PUBLIC_API int ecrt_open_events(unsigned int master_index, int only_new);

/**
 * ecrt_event_name() - get the name of an event
 * @kind: of ec_event_t
 *
 * Extension (%EC_HAVE_EVENTS). For example "slave_lost", as in 'ethercat log --json'.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: one word; "unknown": a newer module has this event.
 */
EC_PUBLIC_API const char *ecrt_event_name(uint32_t kind);

/**
 * ecrt_event_text() - write one line about an event
 * @event: as read
 * @buf: result, without line end
 * @size: bytes of @buf; 200 are enough
 *
 * Extension (%EC_HAVE_EVENTS).
 *
 * Context: Process.
 * Return: length of the text, cut to @size - 1; %-EINVAL an argument is NULL or @size is 0.
 */
EC_PUBLIC_API int ecrt_event_text(const ec_event_t *event, char *buf, size_t size);
#endif

#ifdef EC_HAVE_REF_CLOCK_TIME_64
/**
 * ecrt_master_64bit_reference_clock_time_queue() - queue a read of the system time, 64 bits
 * @master: an active master
 *
 * Extension (%EC_HAVE_REF_CLOCK_TIME_64). The next send reads the system time of the
 * reference clock (registers 0x0910 to 0x0917). No system call of its own. Nothing
 * is sent without reference clock, or until the master has synchronized the clocks after
 * activation. When the kernel runs the cycle, %EC_CYCLE_REFERENCE_TIME does the same
 * in every cycle.
 *
 * Context: The cycle owner. RT-safe.
 */
EC_PUBLIC_API void ecrt_master_64bit_reference_clock_time_queue(
		ec_master_t *master);

/**
 * ecrt_master_64bit_reference_clock_time() - get the system time of the reference clock, 64 bits
 * @master: an active master
 * @time: out: its system time, ns; of a clock of 32 bits the upper half is that
 *        of the application time
 *
 * Extension (%EC_HAVE_REF_CLOCK_TIME_64). As of the last read that
 * ecrt_master_64bit_reference_clock_time_queue() queued and ecrt_master_receive()
 * received. Reads mapped memory, prints nothing.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; %-ENXIO no reference clock; %-EIO no reply to that
 * frame, or none was sent; %-EINVAL not active, or @time is NULL.
 */
EC_PUBLIC_API int ecrt_master_64bit_reference_clock_time(ec_master_t *master,
		uint64_t *time);
#endif

#ifdef EC_HAVE_REASON
/**
 * ecrt_master_reason() - get the reason why the last call failed
 * @master: an opened master
 * @buf: out: one line of text, with terminator
 * @size: of @buf; 256 bytes are always enough
 *
 * Extension (%EC_HAVE_REASON). The configuration calls print this text on stderr after the
 * error. It states the cause and the remedy of any call that failed in the kernel. Empty when
 * the kernel gave no reason, and after a successful call.
 *
 * Context: Process. May sleep.
 * Return: length of the text, also when @buf is too small; %-EINVAL @master is NULL.
 */
EC_PUBLIC_API int ecrt_master_reason(const ec_master_t *master, char *buf,
		size_t size);

/**
 * ecrt_slave_config_reason() - get the reason why a slave is not in OP
 * @sc: slave configuration
 * @buf: out: one line of text, with terminator
 * @size: of @buf; 256 bytes are always enough
 *
 * Extension (%EC_HAVE_REASON). The cause, for example: no slave at that position,
 * another device, a refused SDO or state with the slave's code, or the event the
 * slave waits for. Empty when the slave is in OP. No bus traffic.
 *
 * Context: Process. May sleep.
 * Return: length of the text, also when @buf is too small; %-EINVAL @sc is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_reason(const ec_slave_config_t *sc,
		char *buf, size_t size);
#endif

#ifdef EC_HAVE_DC_STATE
/**
 * struct ec_slave_config_dc_state_t - distributed clock of a slave
 * @bits: of its clock: 64 or 32; 0: no clock, all other fields are 0
 * @reference: it is the reference clock
 * @set: synchronized since activation
 * @in_window: within 1 us of the reference at the last read, and
 *	@delay_ns is reliable (otherwise the kernel log names the inconsistency)
 * @delay_ns: propagation delay from the reference clock (register 0x0928)
 * @offset_ns: of its system time (register 0x0920)
 * @difference_ns: to the reference at the last read, positive: ahead (register 0x092C)
 */
typedef struct {
	unsigned int bits;
	unsigned int reference : 1;
	unsigned int set : 1;
	unsigned int in_window : 1;
	uint32_t delay_ns;
	uint64_t offset_ns;
	int32_t difference_ns;
} ec_slave_config_dc_state_t;

/**
 * ecrt_slave_config_dc_state() - get the state of the clock of a slave
 * @sc: slave configuration
 * @state: out
 *
 * Extension (%EC_HAVE_DC_STATE). No bus traffic. Makes system calls: do not use it in the
 * cycle. There ecrt_master_sync_monitor_process() returns the differences of all slaves
 * together.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENODEV no slave is attached; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_dc_state(const ec_slave_config_t *sc,
		ec_slave_config_dc_state_t *state);
#endif

/*
 * Slave configuration: the master applies it on activation, after power loss and after a
 * reconnection of the slave. After ecrt_master_activate() the configuration calls return
 * -EBUSY.
 */

/**
 * ecrt_slave_config_sync_manager() - configure direction and watchdog of a SyncManager
 * @sc: slave configuration
 * @sync_index: 0..15
 * @direction: %EC_DIR_OUTPUT or %EC_DIR_INPUT
 * @watchdog_mode: of the trigger bit
 *
 * Sets bits 2, 3 and 6 of the control byte (register 0x0804 + 8 * index). No effect on the
 * SyncManagers of a mailbox.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT @sync_index too large; %-EINVAL @direction or
 * @watchdog_mode.
 */
EC_PUBLIC_API int ecrt_slave_config_sync_manager(ec_slave_config_t *sc,
		uint8_t sync_index, ec_direction_t direction,
		ec_watchdog_mode_t watchdog_mode);

/**
 * ecrt_slave_config_watchdog() - configure the time of the process data watchdog
 * @sc: slave configuration
 * @watchdog_divider: value of register 0x0400, units of 40 ns; 0: unchanged
 * @watchdog_intervals: value of register 0x0420, units of the divided clock; 0: unchanged
 *
 * Context: Process. May sleep.
 * Return: 0; negative errno.
 */
EC_PUBLIC_API int ecrt_slave_config_watchdog(ec_slave_config_t *sc,
		uint16_t watchdog_divider, uint16_t watchdog_intervals);

/**
 * ecrt_slave_config_pdo_assign_add() - append a PDO to a SyncManager
 * @sc: slave configuration
 * @sync_index: 0..15
 * @index: of the PDO
 *
 * If the attached slave has this PDO, its mapping is the initial one. The master writes the
 * assignment to object 0x1c10 + @sync_index if the slave allows it.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @sync_index too large; %-ENOSPC more than 1024 of the slave;
 * %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_pdo_assign_add(ec_slave_config_t *sc,
		uint8_t sync_index, uint16_t index);

/**
 * ecrt_slave_config_pdo_assign_clear() - empty the assignment
 * @sc: slave configuration
 * @sync_index: 0..15
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @sync_index too large.
 */
EC_PUBLIC_API int ecrt_slave_config_pdo_assign_clear(ec_slave_config_t *sc,
		uint8_t sync_index);

/**
 * ecrt_slave_config_pdo_mapping_add() - append an entry to a PDO
 * @sc: slave configuration
 * @pdo_index: a PDO that is assigned to a SyncManager
 * @entry_index: object, 0 for a gap
 * @entry_subindex: of the object
 * @entry_bit_length: bits
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT the PDO is not assigned; %-ENOSPC more than 255 entries in
 * it; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_pdo_mapping_add(ec_slave_config_t *sc,
		uint16_t pdo_index, uint16_t entry_index,
		uint8_t entry_subindex, uint8_t entry_bit_length);

/**
 * ecrt_slave_config_pdo_mapping_clear() - empty the mapping of a PDO
 * @sc: slave configuration
 * @pdo_index: PDO; no error if it is not assigned
 *
 * Context: Process. May sleep.
 * Return: 0; negative errno.
 */
EC_PUBLIC_API int ecrt_slave_config_pdo_mapping_clear(ec_slave_config_t *sc,
		uint16_t pdo_index);

/**
 * ecrt_slave_config_pdos() - configure SyncManagers, PDO assignment and mapping in one call
 * @sc: slave configuration
 * @n_syncs: elements of @syncs; %EC_END: up to its end mark
 * @syncs: ends before @n_syncs with an element whose index is 0xff; may be
 *         NULL: nothing is done
 *
 * For each element in order: calls ecrt_slave_config_sync_manager(), empties the assignment,
 * assigns each listed PDO and replaces its mapping by the listed entries. A PDO without
 * entries keeps its default mapping. Stops at the first failure; earlier changes remain. The
 * arrays are copied.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT an index of 16..254; else as the calls above.
 */
EC_PUBLIC_API int ecrt_slave_config_pdos(ec_slave_config_t *sc,
		unsigned int n_syncs, const ec_sync_info_t syncs[]);

/**
 * ecrt_slave_config_reg_pdo_entry() - put an entry into a domain
 * @sc: slave configuration
 * @entry_index: object
 * @entry_subindex: of the object
 * @domain: of the same master
 * @bit_position: out: 0..7; NULL: the entry must be byte-aligned
 *
 * Adds the whole SyncManager of the entry to @domain, once, with one FMMU (register
 * 0x0600 ff.). If the object is mapped more than once, selects the first entry in the order
 * of SyncManager, PDO and mapping. Offsets are final: configure directions, PDOs and mapping
 * first. A failure does not change the domain.
 *
 * Context: Process. May sleep.
 * Return: byte offset in the domain, 0 or more; %-ENOENT not mapped;
 * %-EFAULT not byte-aligned and @bit_position is NULL; %-EOVERFLOW
 * no FMMU left; %-EBUSY active, or the bytes or the direction of the SyncManager were
 * changed after its first entry was registered; %-EINVAL.
 */
EC_PUBLIC_API int ecrt_slave_config_reg_pdo_entry(ec_slave_config_t *sc,
		uint16_t entry_index, uint8_t entry_subindex,
		ec_domain_t *domain, unsigned int *bit_position);

/**
 * ecrt_slave_config_reg_pdo_entry_pos() - put an entry into a domain, by its position
 * @sc: slave configuration
 * @sync_index: 0..15
 * @pdo_pos: of the PDO in the SyncManager, from 0
 * @entry_pos: of the entry in the PDO, from 0
 * @domain: of the same master
 * @bit_position: as in ecrt_slave_config_reg_pdo_entry()
 *
 * For mappings that contain an object more than once.
 *
 * Context: Process. May sleep.
 * Return: as ecrt_slave_config_reg_pdo_entry(); %-EINVAL @sync_index too
 * large.
 */
EC_PUBLIC_API int ecrt_slave_config_reg_pdo_entry_pos(ec_slave_config_t *sc,
		uint8_t sync_index, unsigned int pdo_pos,
		unsigned int entry_pos, ec_domain_t *domain,
		unsigned int *bit_position);

/**
 * ecrt_slave_config_dc() - configure the SYNC signals of a slave
 * @sc: slave configuration
 * @assign_activate: register 0x0980, from the ESI of the slave; 0: no SYNC signals
 * @sync0_cycle: period of SYNC0, ns
 * @sync0_shift: shift of SYNC0 against the grid of the application time, ns
 * @sync1_cycle: register 0x09A4, ns
 * @sync1_shift: no effect
 *
 * Context: Process. May sleep. Before activation. Prints nothing.
 * Return: 0; %-EPERM not reserved; %-EBUSY active; %-EINVAL @sc is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_dc(ec_slave_config_t *sc,
		uint16_t assign_activate, uint32_t sync0_cycle,
		int32_t sync0_shift, uint32_t sync1_cycle,
		int32_t sync1_shift);

/**
 * ecrt_slave_config_sdo() - write an object each time the slave is configured
 * @sc: slave configuration
 * @index: of the object
 * @subindex: of the object
 * @data: little-endian; copied
 * @size: bytes, 1 to 65536
 *
 * Written in PREOP, in the order of the calls, before PDOs that the application configures. A
 * SyncManager without such PDOs has those that startup SDOs to 0x1c1x, 0x16xx and 0x1axx make:
 * call this before entries of that SyncManager are registered. After these SDOs, and after one
 * to 0xf030, the master reads its PDOs again; if the layout does not fit any more, the slave
 * stays in PREOP, and the reason names the SDO.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL no data, or too much; %-ENOSPC more than 1024; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_sdo(ec_slave_config_t *sc, uint16_t index,
		uint8_t subindex, const uint8_t *data, size_t size);

/**
 * ecrt_slave_config_sdo8() - write one byte each time the slave is configured
 * @sc: slave configuration
 * @sdo_index: of the object
 * @sdo_subindex: of the object
 * @value: to be written
 *
 * Context: Process. May sleep.
 * Return: as ecrt_slave_config_sdo().
 */
EC_PUBLIC_API int ecrt_slave_config_sdo8(ec_slave_config_t *sc,
		uint16_t sdo_index, uint8_t sdo_subindex, uint8_t value);

/**
 * ecrt_slave_config_sdo16() - write two bytes each time the slave is configured
 * @sc: slave configuration
 * @sdo_index: of the object
 * @sdo_subindex: of the object
 * @value: to be written, of the host's byte order
 *
 * Context: Process. May sleep.
 * Return: as ecrt_slave_config_sdo().
 */
EC_PUBLIC_API int ecrt_slave_config_sdo16(ec_slave_config_t *sc,
		uint16_t sdo_index, uint8_t sdo_subindex, uint16_t value);

/**
 * ecrt_slave_config_sdo32() - write four bytes each time the slave is configured
 * @sc: slave configuration
 * @sdo_index: of the object
 * @sdo_subindex: of the object
 * @value: to be written, of the host's byte order
 *
 * Context: Process. May sleep.
 * Return: as ecrt_slave_config_sdo().
 */
EC_PUBLIC_API int ecrt_slave_config_sdo32(ec_slave_config_t *sc,
		uint16_t sdo_index, uint8_t sdo_subindex, uint32_t value);

/**
 * ecrt_slave_config_complete_sdo() - write a whole object each time the slave is configured
 * @sc: slave configuration
 * @index: of the object
 * @data: little-endian, begins with subindex 0 in a 16 bit slot; copied
 * @size: bytes, 1 to 65536
 *
 * Written by CoE Complete Access.
 *
 * Context: Process. May sleep.
 * Return: as ecrt_slave_config_sdo().
 */
EC_PUBLIC_API int ecrt_slave_config_complete_sdo(ec_slave_config_t *sc,
		uint16_t index, const uint8_t *data, size_t size);

/**
 * ecrt_slave_config_idn() - write an IDN each time the slave is configured
 * @sc: slave configuration
 * @drive_no: drive of the slave, 0 to 7
 * @idn: as in ecrt_master_write_idn()
 * @state: state in which the master writes: %EC_AL_STATE_PREOP (after the SDOs) or
 *	%EC_AL_STATE_SAFEOP
 * @data: little-endian, copied
 * @size: bytes, 1 to 65536
 *
 * Written in the order of the calls. A slave that refuses an IDN stays in @state.
 *
 * Context: Process. May sleep. Before activation.
 * Return: 0; %-EINVAL; %-ENOSPC more than 1024; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_idn(ec_slave_config_t *sc,
		uint8_t drive_no, uint16_t idn, ec_al_state_t state,
		const uint8_t *data, size_t size);

/* step from one AL state to another */
typedef enum {
	EC_STEP_IP = 0x12,	/* INIT to PREOP */
	EC_STEP_PS = 0x24,	/* PREOP to SAFEOP */
	EC_STEP_SO = 0x48,	/* SAFEOP to OP */
	EC_STEP_OS = 0x84,
	EC_STEP_OP = 0x82,	/* OP to PREOP */
	EC_STEP_OI = 0x81,
	EC_STEP_SP = 0x42,
	EC_STEP_SI = 0x41,
	EC_STEP_PI = 0x21,
	EC_STEP_IB = 0x13,	/* INIT to BOOT */
	EC_STEP_BI = 0x31
} ec_step_t;

typedef enum {
	EC_COMMAND_SDO,
	EC_COMMAND_REG,
	EC_COMMAND_IDN
} ec_command_kind_t;

/* what a slave gets before a step, or what must be read then */
typedef struct {
	ec_command_kind_t kind;
	uint16_t index;		/* object, register or IDN */
	uint8_t subindex;	/* or drive */
	uint8_t complete;	/* not 0: SDO of the whole object */
	size_t size;		/* of each value, bytes */
	const uint8_t *data;	/* value to write, little-endian; NULL: nothing is written */
	const uint8_t *expect;	/* value to read afterwards; NULL: nothing is read */
	const uint8_t *mask;	/* bits of it that are compared; NULL: all */
	uint32_t timeout_ms;	/* until it must be read, at most 60000; 0: one attempt */
} ec_command_t;

/**
 * ecrt_slave_config_command() - add a command to a step of a slave
 * @sc: slave configuration
 * @step: before the master requests its AL state
 * @command: what is written, what must be read, or both; copied
 *
 * Extension (%EC_HAVE_TRANSITION_COMMANDS), for what an ENI file calls InitCmd. The commands of a
 * step are executed in the order of the calls, those of PS and SO after the startup SDOs and IDNs,
 * each time that the slave makes the step. A command that fails on the way up stops the slave in
 * the state before, and the reason names it; on the way down it is reported and the slave goes
 * down. There is no mailbox in INIT and BOOT: IP, IB and BI allow registers only.
 *
 * A step down over several states, as OP, has its own commands. Without them the master makes the
 * steps between neighbors that have commands, as OS and SP, one after the other. So it does when
 * the application deactivates or releases the master or exits: the slaves go to PREOP with their
 * commands, for which all of them have 2 s after the end of the process data. Then they go there
 * without the rest. ecrt_master_deactivate_slaves() runs the commands while process data continue.
 *
 * What the master writes itself is refused: station address, DL and AL control, event mask, FMMUs,
 * SyncManagers, clocks and SYNC signals, and objects of PDOs, for which ecrt_slave_config_sdo()
 * exists.
 *
 * Context: Process. May sleep. Before activation.
 * Return: 0; %-EINVAL; %-ENOSPC more than 1024; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_command(ec_slave_config_t *sc,
		ec_step_t step, const ec_command_t *command);

/**
 * ecrt_slave_config_emerg_size() - set the number of emergencies to keep
 * @sc: slave configuration
 * @elements: messages, at most 1024; initially 0: all are dropped and counted
 *
 * If @elements is not 0, the master polls the mailbox of the slave about every 10 ms for CoE
 * emergencies (ETG.1000.6 clause 5.6.4).
 *
 * Context: Process. May sleep. Before activation.
 * Return: 0; %-ENOMEM; %-EPERM not reserved; %-EBUSY active; %-EINVAL @sc is
 * NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_emerg_size(ec_slave_config_t *sc,
		size_t elements);

/**
 * ecrt_slave_config_emerg_pop() - take the oldest emergency
 * @sc: slave configuration
 * @target: out: %EC_COE_EMERGENCY_MSG_SIZE bytes: error code (little-endian),
 *	error register, 5 bytes of data
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-ENOENT none, or not active; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_emerg_pop(ec_slave_config_t *sc,
		uint8_t *target);

/**
 * ecrt_slave_config_emerg_clear() - discard all emergencies and clear their counter
 * @sc: slave configuration
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @sc is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_emerg_clear(ec_slave_config_t *sc);

/**
 * ecrt_slave_config_emerg_overruns() - get the number of emergencies dropped because
 *	the buffer was full
 * @sc: slave configuration
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: number since activation or the last clear; %-EINVAL @sc is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_emerg_overruns(
		const ec_slave_config_t *sc);

/**
 * ecrt_slave_config_create_sdo_request() - create a request that reads and writes an object
 * @sc: slave configuration
 * @index: object
 * @subindex: subindex
 * @size: buffer size, bytes, at most 65536; set to 0
 *
 * It is freed with @sc.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_sdo_request_t *ecrt_slave_config_create_sdo_request(
		ec_slave_config_t *sc, uint16_t index, uint8_t subindex,
		size_t size);

/**
 * ecrt_slave_config_create_sdo_request_complete() - create a request for a whole object
 * @sc: slave configuration
 * @index: object
 * @size: buffer size, bytes, at most 65536; set to 0
 *
 * Extension (%EC_HAVE_SDO_REQUEST_COMPLETE). CoE Complete Access from subindex 0 on.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_sdo_request_t *
ecrt_slave_config_create_sdo_request_complete(ec_slave_config_t *sc,
		uint16_t index, size_t size);

/**
 * ecrt_slave_config_create_soe_request() - create a request that reads and writes an IDN
 * @sc: slave configuration
 * @drive_no: drive of the slave, 0 to 7
 * @idn: as in ecrt_master_write_idn()
 * @size: buffer size, bytes, at most 65536; set to 0
 *
 * It is freed with @sc.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_soe_request_t *ecrt_slave_config_create_soe_request(
		ec_slave_config_t *sc, uint8_t drive_no, uint16_t idn,
		size_t size);

/**
 * ecrt_slave_config_create_sdo_info_request() - create a request for the object dictionary
 * @sc: slave configuration
 * @size: buffer size, bytes, at most 65536: 2 for each object of a list; 64 hold most
 *	descriptions
 *
 * Extension (%EC_HAVE_SDO_INFO). It is freed with @sc.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_sdo_info_request_t *
ecrt_slave_config_create_sdo_info_request(ec_slave_config_t *sc, size_t size);

/**
 * ecrt_slave_config_create_foe_request() - create a request that reads and writes files
 * @sc: slave configuration
 * @size: buffer size, bytes, at most 15 MiB; set to 0. All requests of an application have
 *	16 MiB together
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). It is freed with @sc. Select a file with
 * ecrt_foe_request_file() before the first transfer. The files of a slave are transferred one
 * after the other; other requests of the slave do not wait for them.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_foe_request_t *ecrt_slave_config_create_foe_request(
		ec_slave_config_t *sc, size_t size);

/**
 * ecrt_slave_config_create_voe_handler() - create a handler of vendor specific messages
 * @sc: slave configuration
 * @size: buffer size without the VoE header, bytes, at most 1474; set to 0
 *
 * It is freed with @sc. A slave may have several; handlers that read share
 * the received messages.
 *
 * Context: Process. May sleep. Before activation.
 * Return: handler; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_voe_handler_t *ecrt_slave_config_create_voe_handler(
		ec_slave_config_t *sc, size_t size);

/**
 * ecrt_slave_config_create_reg_request() - create a request that accesses registers
 * @sc: slave configuration
 * @size: buffer size, bytes, at most 1024; set to 0
 *
 * It is freed with @sc.
 *
 * Context: Process. May sleep. Before activation.
 * Return: request; NULL on failure, with errno set.
 */
EC_PUBLIC_API ec_reg_request_t *ecrt_slave_config_create_reg_request(
		ec_slave_config_t *sc, size_t size);

/**
 * ecrt_slave_config_state() - get the state of a configured slave
 * @sc: slave configuration
 * @state: out; all 0 while no slave is attached
 *
 * Some cycles old; for each cycle call ecrt_domain_state(). No bus traffic; no system call
 * while active.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Before activation: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_state(const ec_slave_config_t *sc,
		ec_slave_config_state_t *state);

/**
 * ecrt_slave_config_flag() - set a named number
 * @sc: slave configuration
 * @key: name, 1..63 characters
 * @value: replaces an earlier one
 *
 * "WaitBeforeSAFEOPms": time from the configuration of the slave to the request of SAFEOP,
 * ms, at most 60000. "AssignToPdi": no effect, the slave has access to its EEPROM from PREOP
 * on in any case. "AcceptOtherPdos": if not 0, the master requests OP although the slave has
 * refused its PDO mapping or assignment and has other objects in the place of the registered
 * entries; otherwise the slave stays in PREOP. "ExpectedRevision": if the slave has another
 * revision number, the log reports it at activation, "ethercat slaves" marks the slave, and
 * "ethercat slaves -v" shows both numbers; the slave is used nevertheless. "IgnoresFRMW": if not
 * 0, the slave does not process FRMW (%EC_HAVE_FLAG_IGNORES_FRMW): the clocks of all slaves get
 * the time of the reference clock by ARMW instead, at its ring position. While that position is
 * not certain, as after a change at a port until the next bus scan, or with slaves before it at
 * whose ports others may join by themselves, the time is only read, and the clocks drift. It is
 * always certain for the first slave. Other names have no effect; "ethercat config -v" shows them.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @key is NULL, empty or too long; %-ENOSPC more than 64 of the
 * slave; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_slave_config_flag(ec_slave_config_t *sc,
		const char *key, int32_t value);

/**
 * ecrt_slave_config_eoe_mac_address() - configure the MAC address of the slave
 * @sc: slave configuration
 * @mac_address: 6 bytes
 *
 * This function and the five below configure one EoE "set IP parameter" request (ETG.1000.6
 * clause 5.7). The master sends it each time it configures the slave, in PREOP after the
 * SDOs; values that are not configured are marked as not included. Between configured values
 * it repeats those of the slave, since slaves read gaps in different ways; a slave without a
 * MAC address gets one. A slave that refuses the request, or has no EoE, stays in PREOP;
 * "ethercat slaves -v" and the kernel log show the reason.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_mac_address(ec_slave_config_t *sc,
		const unsigned char *mac_address);

/**
 * ecrt_slave_config_eoe_ip_address() - configure the IP address of the slave
 * @sc: slave configuration
 * @ip_address: IPv4, network byte order
 *
 * Sent as described at ecrt_slave_config_eoe_mac_address().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_ip_address(
		ec_slave_config_t *sc, struct in_addr ip_address);

/**
 * ecrt_slave_config_eoe_subnet_mask() - configure the subnet mask of the slave
 * @sc: slave configuration
 * @subnet_mask: IPv4, network byte order
 *
 * Sent as described at ecrt_slave_config_eoe_mac_address().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_subnet_mask(
		ec_slave_config_t *sc, struct in_addr subnet_mask);

/**
 * ecrt_slave_config_eoe_default_gateway() - configure the default gateway of the slave
 * @sc: slave configuration
 * @gateway_address: IPv4, network byte order
 *
 * Sent as described at ecrt_slave_config_eoe_mac_address().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_default_gateway(
		ec_slave_config_t *sc, struct in_addr gateway_address);

/**
 * ecrt_slave_config_eoe_dns_address() - configure the DNS server of the slave
 * @sc: slave configuration
 * @dns_address: IPv4, network byte order
 *
 * Sent as described at ecrt_slave_config_eoe_mac_address().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_dns_address(
		ec_slave_config_t *sc, struct in_addr dns_address);

/**
 * ecrt_slave_config_eoe_hostname() - configure the host name of the slave
 * @sc: slave configuration
 * @name: at most 31 characters; longer names are cut
 *
 * Sent as described at ecrt_slave_config_eoe_mac_address().
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_slave_config_eoe_hostname(
		ec_slave_config_t *sc, const char *name);

/**
 * ecrt_slave_config_state_timeout() - configure the timeout of a change of AL state
 * @sc: slave configuration
 * @from_state: INIT, PREOP, SAFEOP or OP
 * @to_state: INIT, PREOP, SAFEOP or OP
 * @timeout_ms: milliseconds; 0: default
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL a state is none of these.
 */
EC_PUBLIC_API int ecrt_slave_config_state_timeout(ec_slave_config_t *sc,
		ec_al_state_t from_state, ec_al_state_t to_state,
		unsigned int timeout_ms);

#ifdef EC_HAVE_SDO_TIMEOUT
/**
 * ecrt_slave_config_sdo_timeout() - configure the timeout of replies to SDOs and IDNs
 * @sc: slave configuration
 * @timeout_ms: milliseconds for each message, at most 60000; 0: default, 5 s
 *
 * Extension (%EC_HAVE_SDO_TIMEOUT). Valid for startup commands, requests, and calls and commands
 * that set no timeout of their own, as long as the slave has this configuration. After this time
 * a startup command waits 30 s more if the slave has accepted it. Other transfers end; the next
 * one of this protocol waits for the late reply, at most 30 s and not longer than its own timeout.
 * An SDO transfer as a whole has 60 s more, and 4 s for each KiB.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @sc is NULL or the time too long; %-EBUSY after ecrt_master_activate().
 */
EC_PUBLIC_API int ecrt_slave_config_sdo_timeout(ec_slave_config_t *sc,
		unsigned int timeout_ms);
#endif

#ifdef EC_HAVE_REPLAY
/**
 * enum ec_replay_t - which writes of the application a slave gets again
 * @EC_REPLAY_DEFAULT: all but objects that store or restore parameters (0x1010, 0x1011), device
 *	commands and diagnosis (0x10F2 to 0x10FF), control words (0x6040, IDN S-0-0134), target
 *	values (0x6071, 0x607A, 0x60C1, 0x60FF; IDN S-0-0036, S-0-0047, S-0-0080), the same of
 *	further axes (+ 0x800 each), what is mapped to outputs, and registers of the master
 * @EC_REPLAY_NONE: none but those that are named
 * @EC_REPLAY_ALL: all but registers of the master
 */
typedef enum {
	EC_REPLAY_DEFAULT,
	EC_REPLAY_NONE,
	EC_REPLAY_ALL
} ec_replay_t;

/**
 * ecrt_slave_config_replay() - choose which writes are replayed
 * @sc: slave configuration
 * @what: initially %EC_REPLAY_DEFAULT
 *
 * Extension (%EC_HAVE_REPLAY). The master records what the application writes to the slave by SDO,
 * IDN or register, with calls or requests, from the reservation of the master to the first OP of
 * the slave: the last value of each object, in the order of the last writes. A slave that was in
 * OP and has been in INIT since then gets these values again, in PREOP, after its startup
 * commands. Writes of other programs are not recorded, nor those to a slave that never gets a
 * configuration. "ethercat config -v" shows the record, and why a write is not replayed.
 *
 * At most 512 values with 64 KiB are kept; beyond that the oldest ones are not replayed.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @sc is NULL or @what none of these; %-EBUSY after ecrt_master_activate().
 */
EC_PUBLIC_API int ecrt_slave_config_replay(ec_slave_config_t *sc, ec_replay_t what);

/**
 * ecrt_slave_config_replay_sdo() - replay a write of an SDO in any case
 * @sc: slave configuration
 * @index: object
 * @subindex: subindex; 0 for Complete Access
 *
 * Extension (%EC_HAVE_REPLAY). Also with %EC_REPLAY_NONE.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL @sc is NULL; %-ENOSPC more than 64 objects; %-EBUSY after
 * ecrt_master_activate().
 */
EC_PUBLIC_API int ecrt_slave_config_replay_sdo(ec_slave_config_t *sc, uint16_t index,
		uint8_t subindex);

/**
 * ecrt_slave_config_replay_idn() - replay a write of an IDN in any case
 * @sc: slave configuration
 * @drive_no: 0 to 7
 * @idn: IDN
 *
 * Extension (%EC_HAVE_REPLAY). As ecrt_slave_config_replay_sdo().
 *
 * Context: Process. May sleep.
 * Return: As ecrt_slave_config_replay_sdo(); %-EINVAL another @drive_no.
 */
EC_PUBLIC_API int ecrt_slave_config_replay_idn(ec_slave_config_t *sc, uint8_t drive_no,
		uint16_t idn);

/**
 * ecrt_slave_config_held() - does a slave that has returned wait for the application?
 * @sc: slave configuration
 *
 * Extension (%EC_HAVE_REPLAY). With the flag "ReinitHold" (ecrt_slave_config_flag()) other than 0,
 * which the LinuxCNC fork of the IgH EtherCAT Master has as well, a slave that was in OP and
 * returns waits in PREOP without a time limit. The application writes to it, then calls
 * ecrt_slave_config_resume(). What it has written meanwhile is recorded, but not replayed to this
 * slave once more; the other recorded writes are replayed.
 *
 * Context: Process. May sleep.
 * Return: 0: no; a positive number: yes, another one after each return; %-EINVAL, %-EPERM.
 */
EC_PUBLIC_API int ecrt_slave_config_held(ec_slave_config_t *sc);

/**
 * ecrt_slave_config_resume() - let the master configure a slave that waits
 * @sc: slave configuration
 * @hold: result of ecrt_slave_config_held() before the application has written to the slave
 *
 * Extension (%EC_HAVE_REPLAY).
 *
 * Context: Process. May sleep.
 * Return: 0; %-ESTALE the slave does not wait, or was lost and has returned again; %-EINVAL,
 * %-EPERM.
 */
EC_PUBLIC_API int ecrt_slave_config_resume(ec_slave_config_t *sc, int hold);
#endif

#ifdef EC_HAVE_LATE_CYCLES
/**
 * ecrt_master_set_late_cycles() - limit the cycles that acyclic frames delay
 * @master: master
 * @per_second: delayed cycles per second, 0 to 100000; initially 100
 *
 * Extension (%EC_HAVE_LATE_CYCLES). For the next activation. Acyclic frames (mailboxes,
 * registers, AL states) share the wire with the process data: the master sends one if it fits
 * into nine tenths of the interval. A frame that is too long for any cycle delays a cycle, at
 * most @per_second times per second. Mailbox messages are split so that they fit. With 0 no
 * cycle is delayed: frames that do not fit time out, and activation fails when the shortest
 * frame (6.72 us) does not fit. An application that takes over a cycle of the kernel sets its
 * own limit.
 * "ethercat master -v" shows wire time, free wire time, and delayed cycles.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL, %-EPERM, %-EBUSY.
 */
EC_PUBLIC_API int ecrt_master_set_late_cycles(ec_master_t *master, uint32_t per_second);
#endif

#ifdef EC_HAVE_OVERLAPPING_PDOS
/**
 * ecrt_slave_config_overlapping_pdos() - let inputs and outputs share logical addresses
 * @sc: slave configuration
 * @allow_overlapping_pdos: 1: inputs of the slave may have logical addresses of its
 *	outputs; 0 (initial): inputs have addresses of their own
 *
 * Extension (%EC_HAVE_OVERLAPPING_PDOS). For the next activation. Shortens the LRW datagram:
 * a slave with 8 bytes each way needs 8 bytes instead of 16. The layout of the domain does
 * not change: inputs and outputs have separate bytes there. Disadvantage: when one slave does
 * not process the datagram, the inputs of all overlapping slaves of the datagram keep their
 * values. See %EC_DOMAIN_OVERLAP for inputs at addresses of other slaves' outputs.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL, %-EPERM, %-EBUSY.
 */
EC_PUBLIC_API int ecrt_slave_config_overlapping_pdos(ec_slave_config_t *sc,
		uint8_t allow_overlapping_pdos);
#endif

#ifdef EC_HAVE_DOMAIN_OPTIONS
/**
 * enum ec_domain_option_t - options of a domain; to be ORed
 * @EC_DOMAIN_OVERLAP: inputs may have logical addresses of outputs, of the same slave and of
 *	slaves upstream; gives the shortest datagrams. When one slave does not process a
 *	datagram, all inputs of the datagram keep their values. The inputs of a slave with an
 *	alias that is absent at activation share addresses with its own outputs only. A slave
 *	whose ring position has changed since activation is not started.
 * @EC_DOMAIN_SEPARATE: LRD and LWR instead of LRW, as for slaves that lack LRW.
 *	A missing slave never holds the inputs of others.
 * @EC_DOMAIN_OWN_FRAME: its datagrams share no frame with other domains, so a lost
 *	frame concerns one domain. The frame may contain clock datagrams.
 */
typedef enum {
	EC_DOMAIN_OVERLAP = 1,
	EC_DOMAIN_SEPARATE = 2,
	EC_DOMAIN_OWN_FRAME = 4
} ec_domain_option_t;

/**
 * ecrt_domain_set_options() - configure how a domain is sent
 * @domain: domain
 * @options: ec_domain_option_t, ORed; 0 (initial): none
 *
 * Extension (%EC_HAVE_DOMAIN_OPTIONS). For the next activation. A domain always has its own
 * datagrams and working counter (sync unit). Size, data and offsets do not depend on the
 * options.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL overlap and separate combined; %-EOPNOTSUPP an unknown
 * option; %-EPERM, %-EBUSY.
 */
EC_PUBLIC_API int ecrt_domain_set_options(ec_domain_t *domain, uint32_t options);
#endif

#ifdef EC_HAVE_DOMAIN_AGE
/**
 * struct ec_domain_age_t - how old the process data of a domain are
 * @age: sends of this domain since the send of the newest received frame; 0: the data are
 *	those of the last send. At most 128.
 * @limit: see ecrt_domain_set_max_age()
 * @stale: @age is above @limit
 */
typedef struct {
	unsigned int age;
	unsigned int limit;
	uint8_t stale;
} ec_domain_age_t;

/**
 * ecrt_domain_age() - get the age of the data of the last ecrt_domain_process()
 * @domain: domain
 * @age: out
 *
 * Extension (%EC_HAVE_DOMAIN_AGE). A frame that returns some cycles late has a complete
 * working counter and old inputs, which ecrt_domain_state() cannot show. The age counts sends
 * of the domain, not cycles. No system call.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_domain_age(const ec_domain_t *domain, ec_domain_age_t *age);

/**
 * ecrt_domain_set_max_age() - set the age above which process data are stale
 * @domain: domain
 * @sends: sends of this domain, initially 2; 0: no limit
 *
 * Extension (%EC_HAVE_DOMAIN_AGE). For the next activation. The kernel log reports a
 * domain once per activation when it receives stale data. Stale data update the inputs and
 * the working counter nevertheless.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EPERM, %-EBUSY.
 */
EC_PUBLIC_API int ecrt_domain_set_max_age(ec_domain_t *domain, unsigned int sends);
#endif

#ifdef EC_HAVE_UNITS

/* what is done when the working counters of a unit are incomplete */
typedef enum {
	EC_UNIT_CONTINUE = 0,	/* nothing; the application reads the states of its domains */
	EC_UNIT_ZERO = 1,	/* its outputs are zero until they are complete again */
	EC_UNIT_HOLD = 2,	/* its outputs keep their last values until then */
	EC_UNIT_SAFEOP = 3,	/* its outputs are zero and its slaves go to SAFEOP, for good */
	EC_UNIT_STOP = 4,	/* the same for all slaves of the application */
} ec_unit_policy_t;

/* ec_unit_config_t.flags */
#define EC_UNIT_AUTHORITY	1U	/* begins without authority; a failure takes it */
#define EC_UNIT_LEASE_HOLD	2U	/* after the lease outputs are held, not zero */
#define EC_UNIT_OFFERED		4U	/* another application may hold it */

/**
 * struct ec_unit_config_t - a sync unit
 * @name: for messages and files: a letter, then letters, digits, '_', '-' and '.', at most 63
 * @policy: what is done when it fails
 * @limit: it fails after so many receives in a row with an incomplete working counter of one of its
 *	domains, and is complete again after as many that are; 1..1000000, 0: 3
 * @lease_cycles: for a cycle run by the kernel: cycles after which its outputs are zero unless all
 *	its domains with outputs were queued and sent; 0: no lease. Begins with the first outputs.
 * @repeats: its frames are sent so many times in a cycle, and the best working counter counts; 1 to
 *	3, 0: 1. All its slaves need the flag "FrameRepeatSupport" (ecrt_slave_config_flag()), as
 *	their vendor says it in the ESI file.
 * @flags: %EC_UNIT_AUTHORITY: its outputs are zero until ecrt_master_unit_authority() gives
 *	authority. A failure other than with %EC_UNIT_CONTINUE takes it, as does the end of the
 *	lease. %EC_UNIT_LEASE_HOLD. %EC_UNIT_OFFERED, with %EC_UNIT_AUTHORITY: see
 *	ecrt_master_unit_hold().
 */
typedef struct {
	const char *name;
	ec_unit_policy_t policy;
	uint32_t limit;
	uint32_t lease_cycles;
	uint32_t repeats;
	uint32_t flags;
} ec_unit_config_t;

typedef enum {
	EC_UNIT_STARTING = 0,	/* not yet complete since activation */
	EC_UNIT_COMPLETE = 1,
	EC_UNIT_FAILED = 2,
} ec_unit_run_t;

typedef enum {
	EC_UNIT_SENDS_APPLICATION = 0,	/* the outputs of the application */
	EC_UNIT_SENDS_ZEROS = 1,
	EC_UNIT_SENDS_HELD_VALUES = 2,
} ec_unit_outputs_t;

/**
 * struct ec_unit_state_t - state of a unit
 * @run: are its working counters complete?
 * @outputs: what is sent for it
 * @authority: it has authority
 * @lease_ended: the lease has ended and was not renewed
 * @down: its policy has taken its slaves to SAFEOP
 * @held: another application gives its outputs
 * @faults: how often it has failed or its lease has ended; 65535: at least that
 */
typedef struct {
	ec_unit_run_t run;
	ec_unit_outputs_t outputs;
	unsigned int authority : 1;
	unsigned int lease_ended : 1;
	unsigned int down : 1;
	unsigned int held : 1;
	unsigned int faults;
} ec_unit_state_t;

/**
 * ecrt_master_unit() - create or find a sync unit
 * @master: a reserved master, not active
 * @config: the unit
 *
 * Extension (%EC_HAVE_UNITS). A unit is a domain or several that are judged together: when one of
 * its working counters stays incomplete, the policy is carried out, in the same cycle and on
 * outputs of this unit alone (but for %EC_UNIT_STOP). Domains without unit are not judged. Inputs
 * are received in any case. Domains in a unit never share a datagram with others; they may share a
 * frame unless @repeats is 2 or more.
 *
 * Context: Process. May sleep.
 * Return: number of the unit; %-EINVAL the description is not valid; %-EEXIST another unit has the
 * name; %-ENOSPC there are 64; %-EBUSY @master is active; %-EPERM not reserved; %-ENOMEM.
 */
EC_PUBLIC_API int ecrt_master_unit(ec_master_t *master, const ec_unit_config_t *config);

/**
 * ecrt_domain_set_unit() - put a domain into a unit
 * @domain: domain of a master that is not active
 * @unit: number of the unit; -1: into none (initial)
 *
 * Extension (%EC_HAVE_UNITS). A slave may have process data in several units, unless one of them
 * has the policy %EC_UNIT_SAFEOP: activation fails then.
 *
 * Context: Process. May sleep.
 * Return: 0; %-EINVAL; %-ENOENT no such unit; %-EBUSY active.
 */
EC_PUBLIC_API int ecrt_domain_set_unit(ec_domain_t *domain, int unit);

/**
 * ecrt_master_unit_authority() - give authority to a unit, or take it
 * @master: an active master; to take it any master that is open for writing
 * @unit: number of the unit
 * @give: 0: take it: the outputs of the next send are zero
 *
 * Extension (%EC_HAVE_UNITS). A unit gets authority only when its working counters are complete;
 * then the next send has its outputs. After a failure with %EC_UNIT_SAFEOP or %EC_UNIT_STOP the
 * first call requests OP for the slaves again: call until it returns 0.
 *
 * Context: Process. May sleep; not for the cycle.
 * Return: 0; %-EINPROGRESS the working counters are not complete, try again; %-EINVAL not active;
 * %-ENOENT no such unit; %-EPERM @master did not reserve it, and does not hold the unit; %-EBUSY
 * another application holds it.
 */
EC_PUBLIC_API int ecrt_master_unit_authority(ec_master_t *master, unsigned int unit, int give);

/**
 * ecrt_master_unit_state() - get the state of a unit
 * @master: an active master
 * @unit: number of the unit
 * @state: out
 *
 * Extension (%EC_HAVE_UNITS). Of the last receive of the cycle. No system call.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; %-EINVAL not active, no such unit, or @state is NULL.
 */
EC_PUBLIC_API int ecrt_master_unit_state(const ec_master_t *master, unsigned int unit,
		ec_unit_state_t *state);

/**
 * ecrt_master_unit_hold() - give the outputs of a unit of another application from now on
 * @master: a master that was opened for writing, and not reserved
 * @name: of a unit with %EC_UNIT_OFFERED, in the application that has activated the master
 * @size: out: bytes of the domains of the unit; may be NULL
 *
 * Extension (%EC_HAVE_UNITS). The outputs that the other application writes there are not sent.
 * They are zero until the holder gives authority by ecrt_master_unit_authority(), which it alone
 * may do. It holds the unit until it releases @master or exits, for any reason; the unit loses its
 * authority then. Its lease counts from one ecrt_master_unit_write() to the next.
 *
 * Context: Process. May sleep.
 * Return: number of the unit; %-ENOENT no such unit; %-EACCES it is not offered; %-EBUSY another
 * one holds it, or its application has given it authority; %-EINVAL the master is not active;
 * %-EPERM @master has activated it.
 */
EC_PUBLIC_API int ecrt_master_unit_hold(ec_master_t *master, const char *name, size_t *size);

/**
 * ecrt_master_unit_write() - give the outputs of a unit
 * @master: holder of the unit
 * @unit: number of the unit
 * @data: the data of its domains, one behind the other in the order of their creation; inputs
 *	among them have no effect
 * @size: bytes of @data, as ecrt_master_unit_hold() returned them
 * @state: out, may be NULL
 *
 * Extension (%EC_HAVE_UNITS). The next cycle sends them, all of them or none. One system call.
 *
 * Context: Process. May sleep, while the other application is deactivated for one.
 * Return: 0; %-EPERM @master does not hold the unit; %-EINVAL another size, or not active any more.
 */
EC_PUBLIC_API int ecrt_master_unit_write(ec_master_t *master, unsigned int unit,
		const uint8_t *data, size_t size, ec_unit_state_t *state);

/**
 * ecrt_master_unit_read() - get the data of a unit
 * @master: holder of the unit
 * @unit: number of the unit
 * @data: out: the data of its domains, with the outputs that are sent
 * @size: bytes of @data, as ecrt_master_unit_hold() returned them
 * @state: out, may be NULL
 *
 * Extension (%EC_HAVE_UNITS). Values of different slaves may be of two cycles. One system call.
 *
 * Context: Process. May sleep, while the other application is deactivated for one.
 * Return: as ecrt_master_unit_write().
 */
EC_PUBLIC_API int ecrt_master_unit_read(ec_master_t *master, unsigned int unit,
		uint8_t *data, size_t size, ec_unit_state_t *state);
#endif

/**
 * ecrt_domain_reg_pdo_entry_list() - put many entries into a domain
 * @domain: domain
 * @pdo_entry_regs: ends with an element whose index is 0; not kept
 *
 * For each element calls ecrt_master_slave_config() and ecrt_slave_config_reg_pdo_entry().
 * Stops at the first failure; earlier registrations remain.
 *
 * Context: Process. May sleep.
 * Return: 0; %-ENOENT no slave configuration, or entry not mapped; else as
 * ecrt_slave_config_reg_pdo_entry().
 */
EC_PUBLIC_API int ecrt_domain_reg_pdo_entry_list(ec_domain_t *domain,
		const ec_pdo_entry_reg_t *pdo_entry_regs);

/**
 * ecrt_domain_size() - get the size of a domain
 * @domain: domain
 *
 * Final as soon as all entries are registered.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation. In
 * userspace before activation: Process. May sleep.
 * Return: bytes; a negative errno as size_t on failure.
 */
EC_PUBLIC_API size_t ecrt_domain_size(const ec_domain_t *domain);

#ifdef __KERNEL__
/**
 * ecrt_domain_external_memory() - set the memory of the process data of a domain
 * @domain: domain whose entries are registered; not active
 * @memory: ecrt_domain_size() bytes, valid until deactivation; their content is sent
 *	unchanged. NULL: memory of the master
 *
 * Kernel only.
 *
 * Context: Process. May sleep.
 */
EC_PUBLIC_API void ecrt_domain_external_memory(ec_domain_t *domain,
		uint8_t *memory);
#endif

/**
 * ecrt_domain_data() - get the process data of a domain
 * @domain: domain
 *
 * The offsets of entries refer to this address. It does not change while the master is
 * active. Outputs keep the last written value.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the data; NULL before activation (except for external memory), or if the image has
 * 0 bytes.
 */
EC_PUBLIC_API uint8_t *ecrt_domain_data(const ec_domain_t *domain);

/**
 * ecrt_domain_process() - evaluate the replies to a domain
 * @domain: of an active master
 *
 * Call between ecrt_master_receive() and ecrt_domain_queue(). Updates the result of
 * ecrt_domain_state() if the domain was sent or a reply was received; a reply that only a
 * second receive has found also counts. No system call.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_domain_process(ec_domain_t *domain);

/**
 * ecrt_domain_queue() - exchange a domain with the next ecrt_master_send()
 * @domain: of an active master
 *
 * A domain that is not queued is not sent in that cycle. No system call.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL not active.
 */
EC_PUBLIC_API int ecrt_domain_queue(ec_domain_t *domain);

/**
 * ecrt_domain_state() - get the result of the last ecrt_domain_process()
 * @domain: domain
 * @state: out
 *
 * No system call.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; %-EINVAL an argument is NULL.
 */
EC_PUBLIC_API int ecrt_domain_state(const ec_domain_t *domain,
		ec_domain_state_t *state);

#ifndef __KERNEL__
/**
 * ecrt_read_real() - read a little-endian IEEE 754 single
 * @data: 4 bytes, need not be aligned
 *
 * Userspace only.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its value.
 */
EC_PUBLIC_API float ecrt_read_real(const void *data);

/**
 * ecrt_read_lreal() - read a little-endian IEEE 754 double
 * @data: 8 bytes, need not be aligned
 *
 * Userspace only.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its value.
 */
EC_PUBLIC_API double ecrt_read_lreal(const void *data);

/**
 * ecrt_write_real() - write a little-endian IEEE 754 single
 * @data: 4 bytes, need not be aligned
 * @value: what to write
 *
 * Userspace only.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
EC_PUBLIC_API void ecrt_write_real(void *data, float value);

/**
 * ecrt_write_lreal() - write a little-endian IEEE 754 double
 * @data: 8 bytes, need not be aligned
 * @value: what to write
 *
 * Userspace only.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
EC_PUBLIC_API void ecrt_write_lreal(void *data, double value);
#endif

/* requests ------------------------------------------------------------------*/

/**
 * ecrt_sdo_request_index() - select another object
 * @req: request that is not BUSY
 * @index: object
 * @subindex: subindex
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_index(ec_sdo_request_t *req,
		uint16_t index, uint8_t subindex);

/**
 * ecrt_sdo_request_index_complete() - select another whole object
 * @req: request that is not BUSY
 * @index: object
 *
 * Extension (%EC_HAVE_SDO_REQUEST_COMPLETE). From now on CoE Complete Access, until
 * ecrt_sdo_request_index().
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_index_complete(ec_sdo_request_t *req,
		uint16_t index);

/**
 * ecrt_sdo_request_timeout() - limit the time from start to transfer
 * @req: request
 * @timeout: ms from ecrt_master_send() to the begin of the transfer; after this time the
 *	state is ERROR. 0 (initial): unlimited
 *
 * A request waits while the slave is absent, in INIT, or busy with another request or with a
 * transfer of another program. The transfer has a timeout of 5 s per message, or
 * that of ecrt_slave_config_sdo_timeout().
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_timeout(ec_sdo_request_t *req,
		uint32_t timeout);

/**
 * ecrt_sdo_request_data() - get the buffer of a request
 * @req: request
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_sdo_request_data(const ec_sdo_request_t *req);

/**
 * ecrt_sdo_request_data_size() - get the size of the data in the buffer
 * @req: request
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: the size of creation, or, after a successful read, the number of bytes read.
 * A write sends this number of bytes.
 */
EC_PUBLIC_API size_t ecrt_sdo_request_data_size(const ec_sdo_request_t *req);

/**
 * ecrt_sdo_request_state() - get the state of a request
 * @req: request
 *
 * Data and size of a read are valid when this has returned SUCCESS.
 * An object that is larger than the buffer gives ERROR.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
#ifdef __KERNEL__
EC_PUBLIC_API ec_request_state_t ecrt_sdo_request_state(
		const ec_sdo_request_t *req);
#else
EC_PUBLIC_API ec_request_state_t ecrt_sdo_request_state(ec_sdo_request_t *req);
#endif

/**
 * ecrt_sdo_request_write() - start a download of the buffer
 * @req: request that is not BUSY, of an active master
 *
 * The buffer is copied; the next ecrt_master_send() starts the transfer.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL the size is 0, not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_write(ec_sdo_request_t *req);

/**
 * ecrt_sdo_request_write_with_size() - start a download of @size bytes of the buffer
 * @req: request that is not BUSY, of an active master
 * @size: bytes, from then on ecrt_sdo_request_data_size()
 *
 * Extension (%EC_HAVE_SDO_REQUEST_COMPLETE).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-ENOBUFS larger than the buffer; %-EINVAL @size is 0,
 * not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_write_with_size(ec_sdo_request_t *req,
		size_t size);

/**
 * ecrt_sdo_request_read() - start an upload
 * @req: request that is not BUSY, of an active master
 *
 * The next ecrt_master_send() starts the transfer.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_read(ec_sdo_request_t *req);

/**
 * ecrt_sdo_request_cancel() - end a request early
 * @req: request of an active master
 *
 * Extension (%EC_HAVE_REQUEST_CANCEL). The next ecrt_master_send() notifies the master, which
 * ends the wait or the transfer, also at the slave. The state stays BUSY until then, and becomes
 * ERROR, or SUCCESS if the transfer was complete before. No effect when @req is not BUSY. It is
 * not known whether the slave has written the value of a cancelled download.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_request_cancel(ec_sdo_request_t *req);

/**
 * ecrt_soe_request_idn() - select another IDN
 * @req: request that is not BUSY
 * @drive_no: drive of the slave, 0 to 7
 * @idn: as in ecrt_master_write_idn()
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL no such drive, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_soe_request_idn(ec_soe_request_t *req,
		uint8_t drive_no, uint16_t idn);

/**
 * ecrt_soe_request_timeout() - limit the time from start to transfer
 * @req: request
 * @timeout: as in ecrt_sdo_request_timeout()
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_soe_request_timeout(ec_soe_request_t *req,
		uint32_t timeout);

/**
 * ecrt_soe_request_data() - get the buffer of a request
 * @req: request
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_soe_request_data(const ec_soe_request_t *req);

/**
 * ecrt_soe_request_data_size() - get the size of the data in the buffer
 * @req: request
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: the size of creation, or, after a successful read, the number of bytes read.
 * A write sends this number of bytes.
 */
EC_PUBLIC_API size_t ecrt_soe_request_data_size(const ec_soe_request_t *req);

/**
 * ecrt_soe_request_state() - get the state of a request
 * @req: request
 *
 * Data and size of a read are valid when this has returned SUCCESS.
 * A value that is larger than the buffer gives ERROR.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
#ifdef __KERNEL__
EC_PUBLIC_API ec_request_state_t ecrt_soe_request_state(
		const ec_soe_request_t *req);
#else
EC_PUBLIC_API ec_request_state_t ecrt_soe_request_state(ec_soe_request_t *req);
#endif

/**
 * ecrt_soe_request_write() - start writing the buffer to the IDN
 * @req: request that is not BUSY, of an active master
 *
 * The buffer is copied; the next ecrt_master_send() starts the transfer.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL the size is 0, not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_soe_request_write(ec_soe_request_t *req);

/**
 * ecrt_soe_request_read() - start reading the IDN
 * @req: request that is not BUSY, of an active master
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_soe_request_read(ec_soe_request_t *req);

/**
 * ecrt_soe_request_cancel() - end a request early
 * @req: request of an active master
 *
 * Extension (%EC_HAVE_REQUEST_CANCEL). As ecrt_sdo_request_cancel().
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_soe_request_cancel(ec_soe_request_t *req);

#ifdef EC_HAVE_SDO_INFO
/**
 * ecrt_sdo_info_request_list() - start reading a list of objects
 * @req: request that is not BUSY, of an active master
 * @list_type: as in ecrt_master_sdo_info_list()
 *
 * Extension (%EC_HAVE_SDO_INFO). After SUCCESS the buffer has the indexes, 16 bits each,
 * little-endian.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL unknown list, not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_info_request_list(ec_sdo_info_request_t *req,
		uint8_t list_type);

/**
 * ecrt_sdo_info_request_object() - start reading the description of an object
 * @req: request that is not BUSY, of an active master
 * @index: object
 *
 * Extension (%EC_HAVE_SDO_INFO). ecrt_sdo_info_request_get_object() returns it.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_info_request_object(ec_sdo_info_request_t *req,
		uint16_t index);

/**
 * ecrt_sdo_info_request_entry() - start reading the description of an entry
 * @req: request that is not BUSY, of an active master
 * @index: object
 * @subindex: entry
 *
 * Extension (%EC_HAVE_SDO_INFO). ecrt_sdo_info_request_get_entry() returns it.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: as ecrt_sdo_info_request_object().
 */
EC_PUBLIC_API int ecrt_sdo_info_request_entry(ec_sdo_info_request_t *req,
		uint16_t index, uint8_t subindex);

/**
 * ecrt_sdo_info_request_timeout() - limit the time from start to transfer
 * @req: request
 * @timeout: as in ecrt_sdo_request_timeout()
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_info_request_timeout(ec_sdo_info_request_t *req,
		uint32_t timeout);

/**
 * ecrt_sdo_info_request_cancel() - end a request early
 * @req: request of an active master
 *
 * Extension (%EC_HAVE_SDO_INFO). As ecrt_sdo_request_cancel().
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_sdo_info_request_cancel(ec_sdo_info_request_t *req);

/**
 * ecrt_sdo_info_request_data() - get the buffer of a request
 * @req: request
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_sdo_info_request_data(
		const ec_sdo_info_request_t *req);

/**
 * ecrt_sdo_info_request_data_size() - get the size of the answer in the buffer
 * @req: request
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: the size of creation, or, after SUCCESS, the bytes of the answer.
 */
EC_PUBLIC_API size_t ecrt_sdo_info_request_data_size(
		const ec_sdo_info_request_t *req);

/**
 * ecrt_sdo_info_request_state() - get the state of a request
 * @req: request
 *
 * Extension (%EC_HAVE_SDO_INFO). An answer that is larger than the buffer gives ERROR.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
EC_PUBLIC_API ec_request_state_t ecrt_sdo_info_request_state(
		const ec_sdo_info_request_t *req);

/**
 * ecrt_sdo_info_request_get_object() - get the description of an object that was read
 * @req: request whose state is SUCCESS after ecrt_sdo_info_request_object()
 * @info: out
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBADMSG the answer is too short; %-EINVAL @req has no such description.
 */
EC_PUBLIC_API int ecrt_sdo_info_request_get_object(
		const ec_sdo_info_request_t *req, ec_sdo_object_info_t *info);

/**
 * ecrt_sdo_info_request_get_entry() - get the description of an entry that was read
 * @req: request whose state is SUCCESS after ecrt_sdo_info_request_entry()
 * @info: out
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: as ecrt_sdo_info_request_get_object().
 */
EC_PUBLIC_API int ecrt_sdo_info_request_get_entry(
		const ec_sdo_info_request_t *req, ec_sdo_entry_info_t *info);

/**
 * ecrt_sdo_info_request_abort_code() - get the abort code of the slave
 * @req: request
 *
 * Extension (%EC_HAVE_SDO_INFO).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: abort code (ETG.1000.6 table 41) when the state is ERROR; 0: the slave gave none.
 */
EC_PUBLIC_API uint32_t ecrt_sdo_info_request_abort_code(
		const ec_sdo_info_request_t *req);
#endif

#ifdef EC_HAVE_FOE_REQUESTS
/**
 * ecrt_foe_request_file() - select the file on the slave
 * @req: request that is not BUSY
 * @file_name: 1 to 64 printable characters; copied
 * @password: 0: none
 *
 * Extension (%EC_HAVE_FOE_REQUESTS).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL an invalid name, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_foe_request_file(ec_foe_request_t *req,
		const char *file_name, uint32_t password);

/**
 * ecrt_foe_request_timeout() - limit the time from start to transfer
 * @req: request
 * @timeout: as in ecrt_sdo_request_timeout()
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). The transfer has a timeout of 10 s per message, and of
 * 60 s while the slave is busy without progress. ecrt_foe_request_cancel() ends it earlier.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @req is NULL.
 */
EC_PUBLIC_API int ecrt_foe_request_timeout(ec_foe_request_t *req,
		uint32_t timeout);

/**
 * ecrt_foe_request_data() - get the buffer of a request
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). Do not change it while the request is BUSY.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_foe_request_data(const ec_foe_request_t *req);

/**
 * ecrt_foe_request_data_size() - get the size of the data in the buffer
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: the size of creation, of the last write, or of the file after a successful read.
 */
EC_PUBLIC_API size_t ecrt_foe_request_data_size(const ec_foe_request_t *req);

/**
 * ecrt_foe_request_state() - get the state of a request; call once per cycle while BUSY
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). Each call copies at most 16 KiB between the buffer and the
 * memory that is shared with the kernel, so that large files do not delay the cycle: a write
 * of more starts after its last part, a read is complete when all of it is in the buffer.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
EC_PUBLIC_API ec_request_state_t ecrt_foe_request_state(
		const ec_foe_request_t *req);

/**
 * ecrt_foe_request_progress() - get the bytes that were transferred so far
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS).
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: bytes since the last start.
 */
EC_PUBLIC_API size_t ecrt_foe_request_progress(const ec_foe_request_t *req);

/**
 * ecrt_foe_request_result() - get the cause of an ERROR
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0 unless the state is ERROR; otherwise as ecrt_master_foe_read() and
 * ecrt_master_foe_write(), and %-ECANCELED after ecrt_foe_request_cancel() or a disconnection.
 */
EC_PUBLIC_API int ecrt_foe_request_result(const ec_foe_request_t *req);

/**
 * ecrt_foe_request_error_code() - get the FoE error code of the slave
 * @req: request
 *
 * Extension (%EC_HAVE_FOE_REQUESTS).
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: error code (ETG.1000.6 5.8) after %-EIO; 0: the slave gave none.
 */
EC_PUBLIC_API uint32_t ecrt_foe_request_error_code(const ec_foe_request_t *req);

/**
 * ecrt_foe_request_write() - start writing the buffer to the file
 * @req: request that is not BUSY, of an active master
 * @size: bytes, from then on ecrt_foe_request_data_size()
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). Call ecrt_foe_request_state() in each cycle from now on.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-ENOBUFS larger than the buffer; %-EINVAL no file selected, not
 * active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_foe_request_write(ec_foe_request_t *req, size_t size);

/**
 * ecrt_foe_request_read() - start reading the file
 * @req: request that is not BUSY, of an active master
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). A file that is larger than the buffer gives ERROR with
 * %-ENOBUFS.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL no file selected, not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_foe_request_read(ec_foe_request_t *req);

/**
 * ecrt_foe_request_cancel() - end a request early
 * @req: request of an active master
 *
 * Extension (%EC_HAVE_FOE_REQUESTS). As ecrt_sdo_request_cancel(). What the slave has of a file
 * whose write was cancelled depends on the slave.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL not active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_foe_request_cancel(ec_foe_request_t *req);
#endif

/**
 * ecrt_voe_handler_send_header() - set the header of the messages to send
 * @voe: handler
 * @vendor_id: vendor id
 * @vendor_type: vendor specific type
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @voe is NULL.
 */
EC_PUBLIC_API int ecrt_voe_handler_send_header(ec_voe_handler_t *voe,
		uint32_t vendor_id, uint16_t vendor_type);

/**
 * ecrt_voe_handler_received_header() - get the header of the last received message
 * @voe: handler
 * @vendor_id: out, may be NULL: vendor id
 * @vendor_type: out, may be NULL: type
 *
 * Valid after ecrt_voe_handler_execute() has returned SUCCESS for a read; 0 before.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EINVAL @voe is NULL.
 */
EC_PUBLIC_API int ecrt_voe_handler_received_header(
		const ec_voe_handler_t *voe, uint32_t *vendor_id,
		uint16_t *vendor_type);

/**
 * ecrt_voe_handler_data() - get the buffer of a handler
 * @voe: handler
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: address of the data after the VoE header, which does not change; NULL when @voe is
 * NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_voe_handler_data(const ec_voe_handler_t *voe);

/**
 * ecrt_voe_handler_data_size() - get the size of the data in the buffer
 * @voe: handler
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: the size of creation, later of the last write or successful read.
 */
EC_PUBLIC_API size_t ecrt_voe_handler_data_size(const ec_voe_handler_t *voe);

/**
 * ecrt_voe_handler_write() - start sending a message
 * @voe: handler that is not BUSY, of an active master
 * @size: bytes of the buffer
 *
 * The buffer is copied; the next ecrt_master_send() starts the transfer. Then
 * ecrt_voe_handler_execute() returns its state; it takes 500 ms at most.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-ENOBUFS larger than the buffer; %-EINVAL not active, or
 * @voe is NULL.
 */
EC_PUBLIC_API int ecrt_voe_handler_write(ec_voe_handler_t *voe, size_t size);

/**
 * ecrt_voe_handler_read() - start waiting for a message
 * @voe: handler that is not BUSY, of an active master
 *
 * The master polls the mailbox for a message; after 500 ms without one the state is ERROR.
 * A message that arrives while another exchange uses the mailbox is not lost.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-EINVAL not active, or @voe is NULL.
 */
EC_PUBLIC_API int ecrt_voe_handler_read(ec_voe_handler_t *voe);

/**
 * ecrt_voe_handler_read_nosync() - start reading a message without polling the mailbox
 * @voe: handler that is not BUSY, of an active master
 *
 * Accesses the mailbox once, without reading its status before. If it has no message, the
 * state is ERROR.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: as ecrt_voe_handler_read().
 */
EC_PUBLIC_API int ecrt_voe_handler_read_nosync(ec_voe_handler_t *voe);

/**
 * ecrt_voe_handler_execute() - get the state of the operation; call once per cycle
 * @voe: handler
 *
 * An absent slave, or one without VoE, gives ERROR, as does a message
 * that is larger than the buffer.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
EC_PUBLIC_API ec_request_state_t ecrt_voe_handler_execute(
		ec_voe_handler_t *voe);

/**
 * ecrt_reg_request_data() - get the buffer of a request
 * @req: request
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_reg_request_data(const ec_reg_request_t *req);

/**
 * ecrt_reg_request_state() - get the state of a request
 * @req: request
 *
 * The data of a read are valid when this has returned SUCCESS. A
 * slave that could not be configured gives ERROR. While the slave is absent, the request
 * stays BUSY.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
EC_PUBLIC_API ec_request_state_t ecrt_reg_request_state(
		const ec_reg_request_t *req);

/**
 * ecrt_reg_request_write() - start writing the buffer to registers
 * @req: request that is not BUSY, of an active master
 * @address: register
 * @size: bytes
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-ENOBUFS larger than the buffer; %-EINVAL @size is 0, not active,
 * or @req is NULL.
 */
EC_PUBLIC_API int ecrt_reg_request_write(ec_reg_request_t *req,
		uint16_t address, size_t size);

/**
 * ecrt_reg_request_read() - start reading registers
 * @req: request that is not BUSY, of an active master
 * @address: register
 * @size: bytes
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: as ecrt_reg_request_write().
 */
EC_PUBLIC_API int ecrt_reg_request_read(ec_reg_request_t *req,
		uint16_t address, size_t size);

/**
 * ecrt_reg_request_readwrite() - start writing registers and reading their old content
 * @req: request that is not BUSY, of an active master
 * @address: register
 * @size: bytes
 *
 * Extension (%EC_HAVE_REG_READWRITE). One datagram (FPRW); clears a counter without
 * losing a count. The old content is in the buffer after SUCCESS.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: as ecrt_reg_request_write().
 */
EC_PUBLIC_API int ecrt_reg_request_readwrite(ec_reg_request_t *req,
		uint16_t address, size_t size);

/**
 * ecrt_master_create_datagram_request() - create a request that sends datagrams
 * @master: a reserved master, not active
 * @size: buffer size, 1 to 1486 bytes
 *
 * Extension (%EC_HAVE_DATAGRAM_REQUESTS). For EtherCAT commands that no other function has. Each
 * request has one datagram at a time; several requests are sent side by side.
 * ecrt_master_deactivate() and ecrt_release_master() free it.
 *
 * Context: Process. May sleep.
 * Return: the request, or NULL: invalid size, no memory, not reserved, active, too many.
 */
EC_PUBLIC_API ec_datagram_request_t *ecrt_master_create_datagram_request(
		ec_master_t *master, size_t size);

/**
 * ecrt_datagram_request_data() - get the buffer of a request
 * @req: request
 *
 * Extension (%EC_HAVE_DATAGRAM_REQUESTS).
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: the address, which does not change; NULL when @req is NULL.
 */
EC_PUBLIC_API uint8_t *ecrt_datagram_request_data(const ec_datagram_request_t *req);

/**
 * ecrt_datagram_request_send() - start sending the buffer as a datagram
 * @req: request that is not BUSY, of an active master
 * @command: EC_DATAGRAM_*
 * @address: logical address for LRD, LWR, LRW; otherwise as by EC_DATAGRAM_STATION(),
 *	EC_DATAGRAM_POSITION() or EC_DATAGRAM_ALL()
 * @size: bytes
 *
 * Extension (%EC_HAVE_DATAGRAM_REQUESTS). The datagram is sent once, beside the cycle. The master
 * does not check what the datagram changes: a write to process data, to registers that
 * the master sets, or to the clocks can stop the slaves.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: 0; %-EBUSY; %-ENOBUFS larger than the buffer; %-EINVAL unknown command, @size is 0, not
 * active, or @req is NULL.
 */
EC_PUBLIC_API int ecrt_datagram_request_send(ec_datagram_request_t *req,
		ec_datagram_command_t command, uint32_t address, size_t size);

/**
 * ecrt_datagram_request_state() - get the state of a request
 * @req: request
 *
 * Extension (%EC_HAVE_DATAGRAM_REQUESTS). SUCCESS: the datagram has returned, with any working
 * counter, and its data are in the buffer. ERROR: it was lost, or there is no link.
 *
 * Context: One caller at a time. RT-safe, no system call.
 * Return: %EC_REQUEST_UNUSED before the first start; BUSY, SUCCESS or ERROR.
 */
EC_PUBLIC_API ec_request_state_t ecrt_datagram_request_state(
		const ec_datagram_request_t *req);

/**
 * ecrt_datagram_request_working_counter() - get the working counter of a request
 * @req: request of which ecrt_datagram_request_state() has returned SUCCESS
 *
 * Extension (%EC_HAVE_DATAGRAM_REQUESTS). With two links it is the sum of both.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation, no system call.
 * Return: working counter; 0 in other states, or @req is NULL.
 */
EC_PUBLIC_API uint16_t ecrt_datagram_request_working_counter(
		const ec_datagram_request_t *req);

#ifdef __cplusplus
}
#endif

/* access to process data -----------------------------------------------------*/

#ifndef __KERNEL__

#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

#define ec_swap16_(x)		((uint16_t)(x))
#define ec_swap32_(x)		((uint32_t)(x))
#define ec_swap64_(x)		((uint64_t)(x))

#else

#define ec_swap16_(x)		__builtin_bswap16((uint16_t)(x))
#define ec_swap32_(x)		__builtin_bswap32((uint32_t)(x))
#define ec_swap64_(x)		__builtin_bswap64((uint64_t)(x))

#ifndef swap16
#define swap16(x)		ec_swap16_(x)
#endif
#ifndef swap32
#define swap32(x)		ec_swap32_(x)
#endif
#ifndef swap64
#define swap64(x)		ec_swap64_(x)
#endif

#endif

#ifndef le16_to_cpu
#define le16_to_cpu(x)		ec_swap16_(x)
#endif
#ifndef le32_to_cpu
#define le32_to_cpu(x)		ec_swap32_(x)
#endif
#ifndef le64_to_cpu
#define le64_to_cpu(x)		ec_swap64_(x)
#endif
#ifndef cpu_to_le16
#define cpu_to_le16(x)		ec_swap16_(x)
#endif
#ifndef cpu_to_le32
#define cpu_to_le32(x)		ec_swap32_(x)
#endif
#ifndef cpu_to_le64
#define cpu_to_le64(x)		ec_swap64_(x)
#endif
#ifndef le16_to_cpup
#define le16_to_cpup(p)		ec_load16_(p)
#endif
#ifndef le32_to_cpup
#define le32_to_cpup(p)		ec_load32_(p)
#endif
#ifndef le64_to_cpup
#define le64_to_cpup(p)		ec_load64_(p)
#endif

#else /* __KERNEL__ */

#define ec_swap16_(x)		le16_to_cpu((__force __le16)(x))
#define ec_swap32_(x)		le32_to_cpu((__force __le32)(x))
#define ec_swap64_(x)		le64_to_cpu((__force __le64)(x))

#endif

/*
 * Process data is unaligned, of any type, and shared with the kernel: packed
 * against the first, may_alias against the second, volatile so that each
 * macro is one access that is neither repeated nor omitted.
 */
struct ec_mem16_ {
	uint16_t v;
} __attribute__((__packed__, __may_alias__));

struct ec_mem32_ {
	uint32_t v;
} __attribute__((__packed__, __may_alias__));

struct ec_mem64_ {
	uint64_t v;
} __attribute__((__packed__, __may_alias__));

static inline uint8_t ec_load8_(const volatile void *p)
{
	return *(const volatile uint8_t *)p;
}

static inline uint16_t ec_load16_(const volatile void *p)
{
	return ec_swap16_(((const volatile struct ec_mem16_ *)p)->v);
}

static inline uint32_t ec_load32_(const volatile void *p)
{
	return ec_swap32_(((const volatile struct ec_mem32_ *)p)->v);
}

static inline uint64_t ec_load64_(const volatile void *p)
{
	return ec_swap64_(((const volatile struct ec_mem64_ *)p)->v);
}

static inline void ec_store8_(volatile void *p, uint8_t v)
{
	*(volatile uint8_t *)p = v;
}

static inline void ec_store16_(volatile void *p, uint16_t v)
{
	((volatile struct ec_mem16_ *)p)->v = ec_swap16_(v);
}

static inline void ec_store32_(volatile void *p, uint32_t v)
{
	((volatile struct ec_mem32_ *)p)->v = ec_swap32_(v);
}

static inline void ec_store64_(volatile void *p, uint64_t v)
{
	((volatile struct ec_mem64_ *)p)->v = ec_swap64_(v);
}

/* 0 or 1: bit POS, 0..7, of the byte at DATA */
#define EC_READ_BIT(DATA, POS)	((EC_READ_U8(DATA) >> (POS)) & 0x01)

/* reads, changes and writes the byte at DATA; not atomic */
#define EC_WRITE_BIT(DATA, POS, VAL) \
	do { \
		if (VAL) \
			ec_set_bit_((volatile void *)(DATA), (POS)); \
		else \
			ec_clear_bit_((volatile void *)(DATA), (POS)); \
	} while (0)

static inline void ec_set_bit_(volatile void *p, unsigned int pos)
{
	ec_store8_(p, (uint8_t)(ec_load8_(p) | (1U << pos)));
}

static inline void ec_clear_bit_(volatile void *p, unsigned int pos)
{
	ec_store8_(p, (uint8_t)(ec_load8_(p) & ~(1U << pos)));
}

#define EC_READ_U8(DATA)	ec_load8_((const volatile void *)(DATA))
#define EC_READ_S8(DATA)	((int8_t)EC_READ_U8(DATA))
#define EC_READ_U16(DATA)	ec_load16_((const volatile void *)(DATA))
#define EC_READ_S16(DATA)	((int16_t)EC_READ_U16(DATA))
#define EC_READ_U32(DATA)	ec_load32_((const volatile void *)(DATA))
#define EC_READ_S32(DATA)	((int32_t)EC_READ_U32(DATA))
#define EC_READ_U64(DATA)	ec_load64_((const volatile void *)(DATA))
#define EC_READ_S64(DATA)	((int64_t)EC_READ_U64(DATA))

#define EC_WRITE_U8(DATA, VAL) \
	do { \
		ec_store8_((volatile void *)(DATA), (uint8_t)(VAL)); \
	} while (0)
#define EC_WRITE_S8(DATA, VAL)	EC_WRITE_U8(DATA, VAL)

#define EC_WRITE_U16(DATA, VAL) \
	do { \
		ec_store16_((volatile void *)(DATA), (uint16_t)(VAL)); \
	} while (0)
#define EC_WRITE_S16(DATA, VAL)	EC_WRITE_U16(DATA, VAL)

#define EC_WRITE_U32(DATA, VAL) \
	do { \
		ec_store32_((volatile void *)(DATA), (uint32_t)(VAL)); \
	} while (0)
#define EC_WRITE_S32(DATA, VAL)	EC_WRITE_U32(DATA, VAL)

#define EC_WRITE_U64(DATA, VAL) \
	do { \
		ec_store64_((volatile void *)(DATA), (uint64_t)(VAL)); \
	} while (0)
#define EC_WRITE_S64(DATA, VAL)	EC_WRITE_U64(DATA, VAL)

#ifndef __KERNEL__

#define EC_READ_REAL(DATA)	ecrt_read_real((const void *)(DATA))
#define EC_READ_LREAL(DATA)	ecrt_read_lreal((const void *)(DATA))

#define EC_WRITE_REAL(DATA, VAL) \
	do { \
		ecrt_write_real((void *)(DATA), (VAL)); \
	} while (0)

#define EC_WRITE_LREAL(DATA, VAL) \
	do { \
		ecrt_write_lreal((void *)(DATA), (VAL)); \
	} while (0)

#endif

#endif
