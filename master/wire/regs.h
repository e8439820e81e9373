/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* ESC register map and masks (ETG.1000.4 clause 6, ETG.1000.6 AL registers). */
#ifndef EC_WIRE_REGS_H
#define EC_WIRE_REGS_H

#include "env.h"

/* ESC information, 0x0000-0x0009 */
#define EC_REG_TYPE		0x0000
#define EC_REG_REVISION		0x0001
#define EC_REG_BUILD		0x0002
#define EC_REG_FMMUS		0x0004
#define EC_REG_SMS		0x0005
#define EC_REG_RAM_KIB		0x0006
#define EC_REG_PORTS		0x0007
#define EC_REG_FEATURES		0x0008
#define EC_INFO_SIZE		10

#define EC_FEAT_NO_BIT_FMMU	BIT(0)
#define EC_FEAT_NO_UNUSED	BIT(1)
#define EC_FEAT_DC		BIT(2)
#define EC_FEAT_DC64		BIT(3)
#define EC_FEAT_FCS_SEPARATE	BIT(7)
#define EC_FEAT_DC_ENHANCED	BIT(8)
#define EC_FEAT_NO_LRW		BIT(9)
#define EC_FEAT_NO_RW		BIT(10)
#define EC_FEAT_FIXED_FMMU_SM	BIT(11)

enum ec_port_type {		/* two bits per port in 0x0007 */
	EC_PORT_TYPE_NONE = 0,
	EC_PORT_TYPE_UNCONF = 1,
	EC_PORT_TYPE_EBUS = 2,
	EC_PORT_TYPE_MII = 3,
};

/* addresses and protection */
#define EC_REG_STATION		0x0010
#define EC_REG_ALIAS		0x0012
#define EC_REG_WRITE_ENABLE	0x0020
#define EC_REG_WRITE_PROTECT	0x0021
#define EC_REG_ESC_WRITE_ENABLE	0x0030
#define EC_REG_ESC_WRITE_PROTECT 0x0031
#define EC_REG_RESET		0x0040

/* data link layer */
#define EC_REG_DL_CONTROL	0x0100
#define EC_DL_TEMPORARY		BIT(1)	/* the rest of 0x0100 to 0x0103 is in force for a second */
#define EC_REG_DL_LOOPS		0x0101
#define EC_REG_DL_ALIAS		0x0103
#define EC_REG_DL_STATUS	0x0110
#define EC_DLS_PDI_OK		BIT(0)
#define EC_DLS_PDI_WD_OK	BIT(1)
#define EC_DLS_LINK(p)		BIT(4 + (p))
#define EC_DLS_LOOP(p)		BIT(8 + 2 * (p))	/* closed */
#define EC_DLS_COMM(p)		BIT(9 + 2 * (p))

enum ec_loop_control {		/* two bits per port in 0x0101 */
	EC_LOOP_AUTO = 0,
	EC_LOOP_AUTO_CLOSE = 1,
	EC_LOOP_OPEN = 2,
	EC_LOOP_CLOSED = 3,
};

/* application layer */
#define EC_REG_AL_CONTROL	0x0120
#define EC_REG_AL_STATUS	0x0130
#define EC_REG_AL_CODE		0x0134
#define EC_AL_STATE_MASK	0x000F
#define EC_AL_ERROR		0x0010	/* status: error; control: acknowledge */
#define EC_AL_ID		0x0020	/* identification loaded / requested */

#define EC_REG_PDI_CONTROL	0x0140
#define EC_REG_ESC_CONFIG	0x0141
#define EC_ESC_CONFIG_EMULATION	BIT(0)
#define EC_REG_PDI_CONFIG	0x0150

/* events */
#define EC_REG_ECAT_MASK	0x0200
#define EC_REG_AL_MASK		0x0204
#define EC_REG_ECAT_EVENT	0x0210
#define EC_REG_AL_EVENT		0x0220
#define EC_ECAT_EVENT_DC_LATCH	BIT(0)
#define EC_ECAT_EVENT_DL	BIT(2)
#define EC_ECAT_EVENT_AL	BIT(3)
#define EC_ECAT_EVENT_SM(n)	BIT(4 + (n))
#define EC_AL_EVENT_CONTROL	BIT(0)
#define EC_AL_EVENT_SM_ACT	BIT(4)
#define EC_AL_EVENT_WD		BIT(6)
#define EC_AL_EVENT_SM(n)	BIT(8 + (n))

/* error counters, 0x0300-0x0313 */
#define EC_REG_ERR_RX(p)	(0x0300 + 2 * (p))	/* invalid frame */
#define EC_REG_ERR_PHY(p)	(0x0301 + 2 * (p))
#define EC_REG_ERR_FWD(p)	(0x0308 + (p))
#define EC_REG_ERR_PU		0x030C
#define EC_REG_ERR_PDI		0x030D
#define EC_REG_ERR_LOST(p)	(0x0310 + (p))
#define EC_REG_ERRORS		0x0300
#define EC_ERRORS_SIZE		20

/* watchdogs */
#define EC_REG_WD_DIVIDER	0x0400
#define EC_REG_WD_PDI		0x0410
#define EC_REG_WD_SM		0x0420
#define EC_REG_WD_STATUS	0x0440
#define EC_REG_WD_SM_COUNT	0x0442
#define EC_REG_WD_PDI_COUNT	0x0443

/* SII EEPROM interface */
#define EC_REG_EEP_OWNER	0x0500
#define EC_REG_EEP_PDI		0x0501
#define EC_REG_EEP_CONTROL	0x0502
#define EC_REG_EEP_ADDRESS	0x0504
#define EC_REG_EEP_DATA		0x0508
#define EC_EEP_OWNER_PDI	BIT(0)
#define EC_EEP_OWNER_FORCE	BIT(1)
#define EC_EEP_WRITE_ENABLE	0x0001
#define EC_EEP_EMULATED		0x0020
#define EC_EEP_READ8		0x0040
#define EC_EEP_TWO_ADDR		0x0080
#define EC_EEP_CMD_READ		0x0100
#define EC_EEP_CMD_WRITE	0x0200
#define EC_EEP_CMD_RELOAD	0x0400
#define EC_EEP_CMD_MASK		0x0700
#define EC_EEP_ERR_CHECKSUM	0x0800
#define EC_EEP_ERR_LOADING	0x1000
#define EC_EEP_ERR_ACK		0x2000
#define EC_EEP_ERR_WRITE_EN	0x4000
#define EC_EEP_ERR_MASK		0x7800
#define EC_EEP_BUSY		0x8000

/* MII management */
#define EC_REG_MII_CONTROL	0x0510
#define EC_REG_MII_PHY		0x0512
#define EC_REG_MII_REG		0x0513
#define EC_REG_MII_DATA		0x0514
#define EC_REG_MII_ECAT		0x0516
#define EC_REG_MII_PDI		0x0517
#define EC_REG_MII_PORT(p)	(0x0518 + (p))

/* FMMU and SyncManager pages */
#define EC_REG_FMMU(n)		(0x0600 + 16 * (n))
#define EC_FMMU_PAGE		16
#define EC_FMMU_OFS_ENABLE	12
#define EC_MAX_FMMU		16
#define EC_REG_SM(n)		(0x0800 + 8 * (n))
#define EC_SM_PAGE		8
#define EC_MAX_SM		16
#define EC_SM_OFS_CONTROL	4
#define EC_SM_OFS_STATUS	5
#define EC_SM_OFS_ACTIVATE	6
#define EC_SM_OFS_PDI		7

#define EC_SM_MODE_MASK		0x03
#define EC_SM_MODE_BUFFERED	0x00
#define EC_SM_MODE_MAILBOX	0x02
#define EC_SM_DIR_MASK		0x0C
#define EC_SM_DIR_WRITE		0x04	/* master writes: outputs */
#define EC_SM_ECAT_IRQ		0x10
#define EC_SM_PDI_IRQ		0x20
#define EC_SM_WATCHDOG		0x40
#define EC_SM_ST_WRITE_EVENT	0x01
#define EC_SM_ST_READ_EVENT	0x02
#define EC_SM_ST_FULL		0x08
#define EC_SM_ST_BUFFER_MASK	0x30
#define EC_SM_ACT_ENABLE	0x01
#define EC_SM_ACT_REPEAT	0x02
#define EC_SM_ACT_DC_ECAT	0x40	/* time of buffer changes to 0x09F0 */
#define EC_SM_ACT_DC_PDI	0x80	/* to 0x09F8 and 0x09FC */
#define EC_SM_PDI_DISABLE	0x01
#define EC_SM_PDI_REPEAT_ACK	0x02

/* distributed clocks */
#define EC_REG_DC_RECV(p)	(0x0900 + 4 * (p))
#define EC_REG_DC_SYSTIME	0x0910
#define EC_REG_DC_RECV_PU	0x0918
#define EC_REG_DC_OFFSET	0x0920
#define EC_REG_DC_DELAY		0x0928
#define EC_REG_DC_DIFF		0x092C
#define EC_REG_DC_SPEED_START	0x0930
#define EC_REG_DC_SPEED_DIFF	0x0932
#define EC_REG_DC_FILTER_DIFF	0x0934
#define EC_REG_DC_FILTER_SPEED	0x0935
#define EC_REG_DC_CUC		0x0980
#define EC_REG_DC_ACTIVATION	0x0981
#define EC_REG_DC_PULSE		0x0982
#define EC_REG_DC_ACT_STATUS	0x0984
#define EC_REG_DC_SYNC0_STATUS	0x098E
#define EC_REG_DC_SYNC1_STATUS	0x098F
#define EC_REG_DC_START		0x0990
#define EC_REG_DC_NEXT_SYNC1	0x0998
#define EC_REG_DC_CYCLE0	0x09A0
#define EC_REG_DC_CYCLE1	0x09A4
#define EC_REG_DC_LATCH0_CTRL	0x09A8
#define EC_REG_DC_LATCH1_CTRL	0x09A9
#define EC_REG_DC_LATCH0_STATUS	0x09AE
#define EC_REG_DC_LATCH1_STATUS	0x09AF
#define EC_REG_DC_LATCH0_POS	0x09B0
#define EC_REG_DC_LATCH0_NEG	0x09B8
#define EC_REG_DC_LATCH1_POS	0x09C0
#define EC_REG_DC_LATCH1_NEG	0x09C8
#define EC_REG_DC_ECAT_EVENT	0x09F0
#define EC_REG_DC_PDI_START	0x09F8
#define EC_REG_DC_PDI_CHANGE	0x09FC
#define EC_DC_DIFF_AHEAD	BIT(31)

#define EC_REG_DIGITAL_OUT	0x0F00	/* of a digital I/O ESC, process data begin here */
#define EC_REG_USER_RAM		0x0F80
#define EC_REG_RAM		0x1000

#define EC_MAX_PORT		4

#endif
