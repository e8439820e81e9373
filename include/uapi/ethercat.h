/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Interface between /dev/EtherCAT<n> and its users.
 *
 * Rules: fixed-width types only; pointers are passed as __u64; no padding by the compiler, so that
 * structures are the same for programs of 32 and 64 bits. Every structure starts with a flags word,
 * whose unknown bits are refused (-EOPNOTSUPP). It may grow at its end: the kernel takes the size
 * from the command number, zero-fills fields that an older program does not have, and refuses
 * (-E2BIG) an unknown tail that is not zero. Reserved fields are zero, otherwise -EOPNOTSUPP. A
 * structure shorter than its first version is refused (-EINVAL). Numbers are never reused. No
 * structure contains an array of structures: a command of its own has their index, or a buffer.
 *
 * After a failure EC_IOC_REASON on the same open file returns a line with cause and remedy.
 */
#ifndef EC_UAPI_ETHERCAT_H
#define EC_UAPI_ETHERCAT_H

#include <linux/ioctl.h>
#include <linux/types.h>
#include "ethercat_address.h"
#include "ethercat_app.h"
#include "ethercat_cause.h"
#include "ethercat_common.h"
#include "ethercat_config.h"
#include "ethercat_eoe.h"
#include "ethercat_event.h"
#include "ethercat_group.h"
#include "ethercat_info.h"
#include "ethercat_mail.h"
#include "ethercat_map.h"
#include "ethercat_mbox.h"
#include "ethercat_record.h"
#include "ethercat_unit.h"

/*
 * From EC_UAPI_FIRST on no number and no member changes: such programs run on each later module.
 * EC_IOC_VERSION refuses older ones (-EPROTO).
 */
#define EC_UAPI_VERSION		3
#define EC_UAPI_FIRST		3

#define EC_IOC_TYPE		0xec
#define EC_IOC_R(nr, t)		_IOR(EC_IOC_TYPE, nr, t)
#define EC_IOC_W(nr, t)		_IOW(EC_IOC_TYPE, nr, t)
#define EC_IOC_RW(nr, t)	_IOWR(EC_IOC_TYPE, nr, t)
#define EC_IOC_N(nr)		_IO(EC_IOC_TYPE, nr)

/* any open file, no bus traffic */
#define EC_IOC_VERSION		EC_IOC_RW(0x00, struct ec_ioc_version)
#define EC_IOC_REASON		EC_IOC_R(0x01, struct ec_ioc_reason)
#define EC_IOC_MASTER		EC_IOC_R(0x02, struct ec_ioc_master)
#define EC_IOC_SLAVE		EC_IOC_RW(0x03, struct ec_ioc_slave)
#define EC_IOC_SM		EC_IOC_RW(0x04, struct ec_ioc_sm)
#define EC_IOC_PDO		EC_IOC_RW(0x05, struct ec_ioc_pdo)
#define EC_IOC_PDO_ENTRY	EC_IOC_RW(0x06, struct ec_ioc_pdo_entry)
#define EC_IOC_SII		EC_IOC_RW(0x07, struct ec_ioc_sii)
#define EC_IOC_CONFIG		EC_IOC_RW(0x08, struct ec_ioc_config)
#define EC_IOC_CONFIG_SM	EC_IOC_RW(0x09, struct ec_ioc_config_sm)
#define EC_IOC_CONFIG_PDO	EC_IOC_RW(0x0a, struct ec_ioc_config_pdo)
#define EC_IOC_CONFIG_ENTRY	EC_IOC_RW(0x0b, struct ec_ioc_config_entry)
#define EC_IOC_CONFIG_SDO	EC_IOC_RW(0x0c, struct ec_ioc_config_sdo)
#define EC_IOC_DOMAIN		EC_IOC_RW(0x0d, struct ec_ioc_domain)
#define EC_IOC_DOMAIN_FMMU	EC_IOC_RW(0x0e, struct ec_ioc_domain_fmmu)
#define EC_IOC_DOMAIN_DATA	EC_IOC_RW(0x0f, struct ec_ioc_domain_data)
#define EC_IOC_CONFIG_IDN	EC_IOC_RW(0x12, struct ec_ioc_config_idn)
#define EC_IOC_CONFIG_FLAG	EC_IOC_RW(0x10, struct ec_ioc_config_flag)
#define EC_IOC_CYCLE_STATS	EC_IOC_RW(0x11, struct ec_ioc_cycle_stats)
#define EC_IOC_ABSENT		EC_IOC_RW(0x13, struct ec_ioc_absent)
#define EC_IOC_CONFIG_WRITE	EC_IOC_RW(0x14, struct ec_ioc_config_write)
#define EC_IOC_EOE		EC_IOC_RW(0x35, struct ec_ioc_eoe)
#define EC_IOC_CONFIG_COMMAND	EC_IOC_RW(0x17, struct ec_ioc_config_command)
#define EC_IOC_CONFIG_IP	EC_IOC_RW(0x18, struct ec_ioc_sc_ip)
#define EC_IOC_CONFIG_WHY	EC_IOC_RW(0x19, struct ec_ioc_config_why)
#define EC_IOC_EMERGENCIES	EC_IOC_RW(0x1a, struct ec_ioc_emergencies)
#define EC_IOC_EVENTS		EC_IOC_RW(0x1b, struct ec_ioc_events)
#define EC_IOC_DEVICE		EC_IOC_RW(0x1c, struct ec_ioc_device)
#define EC_IOC_PORT		EC_IOC_RW(0x1d, struct ec_ioc_port)
#define EC_IOC_SLAVE_NAMES	EC_IOC_RW(0x1e, struct ec_ioc_slave_names)
#define EC_IOC_SLAVE_WHY	EC_IOC_RW(0x1f, struct ec_ioc_slave_why)
#define EC_IOC_NAMES		EC_IOC_RW(0x3c, struct ec_ioc_names)
#define EC_IOC_UNIT_INFO	EC_IOC_RW(0x15, struct ec_ioc_unit_info)
#define EC_IOC_MAIL		EC_IOC_RW(0x16, struct ec_ioc_mail)
#define EC_IOC_RECORDER		EC_IOC_RW(0x3e, struct ec_ioc_recorder)

/* opened for writing: traffic or change */
#define EC_IOC_SDO_UPLOAD	EC_IOC_RW(0x20, struct ec_ioc_sdo)
#define EC_IOC_SDO_DOWNLOAD	EC_IOC_RW(0x21, struct ec_ioc_sdo)
#define EC_IOC_REG_READ		EC_IOC_RW(0x22, struct ec_ioc_reg)
#define EC_IOC_REG_WRITE	EC_IOC_RW(0x23, struct ec_ioc_reg)
#define EC_IOC_REG_RDWR		EC_IOC_RW(0x32, struct ec_ioc_reg)	/* data: in, out */
#define EC_IOC_DATAGRAM	EC_IOC_RW(0x38, struct ec_ioc_datagram)	/* data: in, out */
#define EC_IOC_STATE		EC_IOC_W(0x24, struct ec_ioc_state)
#define EC_IOC_RESCAN		EC_IOC_N(0x25)
#define EC_IOC_LET_IN		EC_IOC_W(0x33, struct ec_ioc_let_in)
#define EC_IOC_DEBUG		EC_IOC_W(0x26, struct ec_ioc_debug)
#define EC_IOC_RESET		EC_IOC_N(0x27)
#define EC_IOC_CYCLE_RESET	EC_IOC_N(0x28)
#define EC_IOC_SDO_INFO		EC_IOC_RW(0x2f, struct ec_ioc_sdo_info)
#define EC_IOC_EOE_WISH		EC_IOC_W(0x34, struct ec_ioc_eoe_wish)
#define EC_IOC_IP_SET		EC_IOC_RW(0x30, struct ec_ioc_ip)
#define EC_IOC_IP_GET		EC_IOC_RW(0x31, struct ec_ioc_ip)
#define EC_IOC_SOE_READ		EC_IOC_RW(0x29, struct ec_ioc_soe)
#define EC_IOC_SOE_WRITE	EC_IOC_RW(0x2a, struct ec_ioc_soe)
#define EC_IOC_END_DETACHED	EC_IOC_N(0x2b)
#define EC_IOC_DEVICE_USE	EC_IOC_W(0x2c, struct ec_ioc_device_use)
#define EC_IOC_OUTPUT		EC_IOC_W(0x39, struct ec_ioc_output)
#define EC_IOC_FOE_READ		EC_IOC_RW(0x2d, struct ec_ioc_foe)
#define EC_IOC_SII_WRITE	EC_IOC_RW(0x3a, struct ec_ioc_sii_write)
#define EC_IOC_ALIAS		EC_IOC_RW(0x3b, struct ec_ioc_alias)
#define EC_IOC_FOE_WRITE	EC_IOC_RW(0x2e, struct ec_ioc_foe)

/* reserved by this open file: the application */
#define EC_IOC_RESERVE		EC_IOC_N(0x40)
#define EC_IOC_RELEASE		EC_IOC_N(0x41)
#define EC_IOC_CREATE_DOMAIN	EC_IOC_RW(0x42, struct ec_ioc_create_domain)
#define EC_IOC_SLAVE_CONFIG	EC_IOC_RW(0x43, struct ec_ioc_slave_config)
#define EC_IOC_SC_SYNC		EC_IOC_W(0x44, struct ec_ioc_sc_sync)
#define EC_IOC_SC_WATCHDOG	EC_IOC_W(0x45, struct ec_ioc_sc_watchdog)
#define EC_IOC_SC_PDO		EC_IOC_W(0x46, struct ec_ioc_sc_pdo)
#define EC_IOC_SC_SDO		EC_IOC_W(0x47, struct ec_ioc_sc_sdo)
#define EC_IOC_REG_ENTRY	EC_IOC_RW(0x48, struct ec_ioc_reg_entry)
#define EC_IOC_SC_DC		EC_IOC_W(0x49, struct ec_ioc_sc_dc)
#define EC_IOC_SC_FLAG		EC_IOC_W(0x4a, struct ec_ioc_sc_flag)
#define EC_IOC_SC_TIMEOUT	EC_IOC_W(0x4b, struct ec_ioc_sc_timeout)
#define EC_IOC_ACTIVATE		EC_IOC_RW(0x4c, struct ec_ioc_activate)
#define EC_IOC_DEACTIVATE	EC_IOC_N(0x4d)
#define EC_IOC_DOMAIN_OFFSET	EC_IOC_RW(0x4e, struct ec_ioc_domain_offset)
#define EC_IOC_INTERVAL		EC_IOC_W(0x4f, struct ec_ioc_interval)
#define EC_IOC_APP_TIME		EC_IOC_W(0x50, struct ec_ioc_app_time)
#define EC_IOC_RECEIVE		EC_IOC_N(0x51)
#define EC_IOC_SEND		EC_IOC_W(0x52, struct ec_ioc_send)
#define EC_IOC_REF_CLOCK	EC_IOC_W(0x53, struct ec_ioc_ref_clock)
#define EC_IOC_SC_REQUEST	EC_IOC_RW(0x54, struct ec_ioc_sc_request)
#define EC_IOC_SC_EMERG		EC_IOC_W(0x55, struct ec_ioc_sc_emerg)
#define EC_IOC_SLAVES_DOWN	EC_IOC_N(0x71)
#define EC_IOC_SC_IP		EC_IOC_W(0x70, struct ec_ioc_sc_ip)
#define EC_IOC_SC_IDN		EC_IOC_W(0x56, struct ec_ioc_sc_idn)
#define EC_IOC_SC_REPLAY	EC_IOC_W(0x57, struct ec_ioc_sc_replay)
#define EC_IOC_HOLD		EC_IOC_RW(0x58, struct ec_ioc_hold)
#define EC_IOC_DATAGRAM_REQUEST	EC_IOC_RW(0x59, struct ec_ioc_datagram_request)
#define EC_IOC_SC_COMMAND	EC_IOC_W(0x5a, struct ec_ioc_sc_command)
#define EC_IOC_CYCLE		EC_IOC_W(0x60, struct ec_ioc_cycle)
#define EC_IOC_WAIT		EC_IOC_RW(0x61, struct ec_ioc_wait)
#define EC_IOC_DIVISION		EC_IOC_W(0x62, struct ec_ioc_division)
#define EC_IOC_COPY		EC_IOC_W(0x63, struct ec_ioc_copy)
#define EC_IOC_DETACH		EC_IOC_W(0x72, struct ec_ioc_detach)
#define EC_IOC_SET_NAMES	EC_IOC_W(0x73, struct ec_ioc_names)
#define EC_IOC_GROUP		EC_IOC_RW(0x68, struct ec_ioc_group)
#define EC_IOC_GROUP_CONFIG	EC_IOC_RW(0x69, struct ec_ioc_group_config)
#define EC_IOC_CONFIG_GROUP	EC_IOC_RW(0x6a, struct ec_ioc_config_group)
#define EC_IOC_UNIT		EC_IOC_RW(0x6b, struct ec_ioc_unit)
#define EC_IOC_DOMAIN_UNIT	EC_IOC_W(0x6c, struct ec_ioc_domain_unit)
#define EC_IOC_UNIT_AUTHORITY	EC_IOC_W(0x6d, struct ec_ioc_unit_authority)
#define EC_IOC_UNIT_HOLD	EC_IOC_RW(0x6e, struct ec_ioc_unit_hold)
#define EC_IOC_UNIT_WRITE	EC_IOC_RW(0x6f, struct ec_ioc_unit_data)
#define EC_IOC_UNIT_READ	EC_IOC_RW(0x77, struct ec_ioc_unit_data)
#define EC_IOC_SC_OVERLAP	EC_IOC_W(0x78, struct ec_ioc_sc_overlap)
#define EC_IOC_LATE		EC_IOC_W(0x7a, struct ec_ioc_late)
#define EC_IOC_DOMAIN_AGE	EC_IOC_W(0x7b, struct ec_ioc_domain_age)
#define EC_IOC_DOMAIN_OPTIONS	EC_IOC_W(0x79, struct ec_ioc_domain_options)

#endif
