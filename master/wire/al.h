/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Application layer states, transitions and status codes (ETG.1000.6 clause 5.3, 6.4). */
#ifndef EC_WIRE_AL_H
#define EC_WIRE_AL_H

#include "regs.h"

enum ec_al_state {
	EC_AL_INIT = 1,
	EC_AL_PREOP = 2,
	EC_AL_BOOT = 3,
	EC_AL_SAFEOP = 4,
	EC_AL_OP = 8,
};

/* AL status codes the master itself looks at; texts exist for all */
#define EC_AL_CODE_NONE			0x0000
#define EC_AL_CODE_UNSPECIFIED		0x0001
#define EC_AL_CODE_INVALID_CHANGE	0x0011
#define EC_AL_CODE_UNKNOWN_STATE	0x0012
#define EC_AL_CODE_NO_BOOT		0x0013
#define EC_AL_CODE_MBOX_BOOT		0x0015
#define EC_AL_CODE_MBOX_PREOP		0x0016
#define EC_AL_CODE_SM_CONFIG		0x0017
#define EC_AL_CODE_NO_INPUTS		0x0018
#define EC_AL_CODE_NO_OUTPUTS		0x0019
#define EC_AL_CODE_SYNC_ERROR		0x001A
#define EC_AL_CODE_SM_WATCHDOG		0x001B
#define EC_AL_CODE_OUTPUT_CONFIG	0x001D
#define EC_AL_CODE_INPUT_CONFIG		0x001E
#define EC_AL_CODE_WD_CONFIG		0x001F
#define EC_AL_CODE_NO_SYNC		0x002D
#define EC_AL_CODE_DC_CONFIG		0x0030
#define EC_AL_CODE_PLL			0x0032
#define EC_AL_CODE_DC_TIMEOUT		0x0034

const char *ec_al_state_name(u8 state);
bool ec_al_state_valid(u8 state);
bool ec_al_legal(u8 from, u8 to);
u8 ec_al_next(u8 from, u8 to);
u32 ec_al_timeout_ms(u8 from, u8 to);
const char *ec_al_code_text(u16 code);

#endif
