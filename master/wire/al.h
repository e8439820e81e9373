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

/* bits of these two states, and of no other */
#define EC_AL_BEYOND_PREOP		(EC_AL_SAFEOP | EC_AL_OP)

/* AL status codes that the master evaluates; texts exist for all */
#define EC_AL_CODE_NO_OUTPUTS		0x0019
#define EC_AL_CODE_SM_WATCHDOG		0x001B

const char *ec_al_state_name(u8 state);
bool ec_al_state_valid(u8 state);
u32 ec_al_timeout_ms(u8 from, u8 to);
const char *ec_al_code_text(u16 code);

#endif
