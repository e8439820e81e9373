// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "al.h"
#include "text.h"

static const char * const states[EC_AL_STATE_MASK + 1] = {
	[EC_AL_INIT] = "INIT",
	[EC_AL_PREOP] = "PREOP",
	[EC_AL_BOOT] = "BOOT",
	[EC_AL_SAFEOP] = "SAFEOP",
	[EC_AL_OP] = "OP",
};

/**
 * ec_al_state_name() - name of a state
 * @state: AL status or AL control value; only the low four bits count
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: "INIT", "PREOP", "BOOT", "SAFEOP", "OP" or "???".
 */
const char *ec_al_state_name(u8 state)
{
	return states[state & EC_AL_STATE_MASK] ?: "???";
}

/**
 * ec_al_state_valid() - is this a state?
 * @state: without error and identification bits
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true for the five states.
 */
bool ec_al_state_valid(u8 state)
{
	return state < ARRAY_SIZE(states) && states[state];
}

/**
 * ec_al_timeout_ms() - how long a transition may take by default
 * @from: present state
 * @to: requested state
 *
 * Values of an ESI or ENI file have priority.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: milliseconds.
 */
u32 ec_al_timeout_ms(u8 from, u8 to)
{
	switch (to) {
	case EC_AL_INIT:
		return from == EC_AL_BOOT ? 10000 : 5000;
	case EC_AL_BOOT:
		return 3000;
	case EC_AL_PREOP:
		return from == EC_AL_SAFEOP || from == EC_AL_OP ? 5000 : 3000;
	case EC_AL_SAFEOP:
		return from == EC_AL_OP ? 200 : 10000;
	default:
		return 10000;
	}
}

static const struct ec_text codes[] = {
	{ 0x0000, "no error" },
	{ 0x0001, "unspecified error" },
	{ 0x0002, "out of memory" },
	{ 0x0003, "device setup is invalid" },
	{ 0x0004, "revision of the process data mapping does not match" },
	{ 0x0006, "EEPROM content does not match the firmware" },
	{ 0x0007, "firmware update failed, the old firmware still runs" },
	{ 0x000E, "license error" },
	{ 0x0011, "requested state cannot be reached from the present one" },
	{ 0x0012, "requested state does not exist" },
	{ 0x0013, "bootstrap state is not supported" },
	{ 0x0014, "no valid firmware" },
	{ 0x0015, "mailbox configuration invalid for BOOT" },
	{ 0x0016, "mailbox configuration invalid for PREOP" },
	{ 0x0017, "SyncManager configuration invalid" },
	{ 0x0018, "no valid inputs available" },
	{ 0x0019, "no valid outputs received" },
	{ 0x001A, "synchronization error" },
	{ 0x001B, "SyncManager watchdog expired: no outputs came in time" },
	{ 0x001C, "SyncManager types invalid" },
	{ 0x001D, "output configuration invalid" },
	{ 0x001E, "input configuration invalid" },
	{ 0x001F, "watchdog configuration invalid" },
	{ 0x0020, "slave needs a power cycle" },
	{ 0x0021, "slave needs to go to INIT first" },
	{ 0x0022, "slave needs to go to PREOP first" },
	{ 0x0023, "slave needs to go to SAFEOP first" },
	{ 0x0024, "input mapping invalid" },
	{ 0x0025, "output mapping invalid" },
	{ 0x0026, "settings contradict each other" },
	{ 0x0027, "free run mode is not supported" },
	{ 0x0028, "synchronized mode is not supported" },
	{ 0x0029, "free run mode needs three buffers" },
	{ 0x002A, "background watchdog expired" },
	{ 0x002B, "neither inputs nor outputs are valid" },
	{ 0x002C, "fatal synchronization error: SYNC signal lost" },
	{ 0x002D, "no SYNC signal received" },
	{ 0x002E, "cycle time too small" },
	{ 0x0030, "DC SYNC configuration invalid" },
	{ 0x0031, "DC latch configuration invalid" },
	{ 0x0032, "PLL error: not locked to the SYNC signal" },
	{ 0x0033, "DC synchronization error of the inputs or outputs" },
	{ 0x0034, "DC synchronization timeout" },
	{ 0x0035, "DC cycle time invalid" },
	{ 0x0036, "SYNC0 cycle time invalid" },
	{ 0x0037, "SYNC1 cycle time invalid" },
	{ 0x0041, "mailbox error in AoE" },
	{ 0x0042, "mailbox error in EoE" },
	{ 0x0043, "mailbox error in CoE" },
	{ 0x0044, "mailbox error in FoE" },
	{ 0x0045, "mailbox error in SoE" },
	{ 0x004F, "mailbox error in VoE" },
	{ 0x0050, "EEPROM not accessible: the master owns it" },
	{ 0x0051, "EEPROM error" },
	{ 0x0052, "external hardware is not ready" },
	{ 0x0060, "slave restarted by itself" },
	{ 0x0061, "device identification value updated" },
	{ 0x0070, "detected modules differ from the configured ones" },
	{ 0x0080, "supply voltage too low" },
	{ 0x0081, "supply voltage too high" },
	{ 0x0082, "temperature too low" },
	{ 0x0083, "temperature too high" },
	{ 0x00F0, "application controller available" },
};

/**
 * ec_al_code_text() - meaning of an AL status code
 * @code: register 0x0134
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, never NULL.
 */
const char *ec_al_code_text(u16 code)
{
	const char *text = ec_text_find(codes, ARRAY_SIZE(codes), code);

	if (text)
		return text;
	return code & 0x8000 ? "vendor specific AL status code" : "unknown AL status code";
}
