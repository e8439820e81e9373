/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Which writes of an application are not written again to a slave that returns, and why. */
#ifndef EC_WIRE_REPLAY_H
#define EC_WIRE_REPLAY_H

#include "env.h"

/* why a recorded write is not replayed; numbers of the interface */
enum ec_replay_why {
	EC_REPLAY_WHY_NONE,	/* it is */
	EC_REPLAY_WHY_OFF,	/* the application has switched it off */
	EC_REPLAY_WHY_STORE,	/* the object stores or restores parameters */
	EC_REPLAY_WHY_COMMAND,	/* device commands, diagnosis */
	EC_REPLAY_WHY_CONTROL,	/* control word */
	EC_REPLAY_WHY_TARGET,	/* target value */
	EC_REPLAY_WHY_OUTPUT,	/* mapped to outputs */
	EC_REPLAY_WHY_REGISTER,	/* of the master */
	EC_REPLAY_WHY_STARTUP,	/* a startup command has written it later */
	EC_REPLAY_WHY_OWN,	/* the application has written it itself to the held slave */
	EC_REPLAY_WHY_LIMIT,	/* the value was not kept */
	EC_REPLAY_WHYS
};

enum ec_replay_why ec_replay_sdo_why(u16 index);
enum ec_replay_why ec_replay_idn_why(u16 idn);
enum ec_replay_why ec_replay_register_why(u16 address, u32 size);
const char *ec_replay_why_text(u8 why);

#endif
