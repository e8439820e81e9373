/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Error codes of CoE emergencies. */
#ifndef EC_EMERGENCY_H
#define EC_EMERGENCY_H

#include "env.h"

#define EC_PROFILE_DRIVE	402	/* CiA 402, as in object 0x1000 */

const char *ec_emergency_text(u16 code, u32 profile);

#endif
