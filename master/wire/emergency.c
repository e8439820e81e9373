// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/*
 * What the code of a CoE emergency is about: CiA 301 defines groups of codes for all devices,
 * CiA 402 codes of drives within these groups. A drive that has none of the second for a code
 * means the group.
 */
#include "emergency.h"

/* @mask: of the code; 0x00ff in none of them: one code */
struct emergency {
	u16 mask;
	u16 code;
	const char *text;
};

/* CiA 301 table 26, ETG.1000.6 table 50; what is finer comes first */
static const struct emergency emergencies[] = {
	{ 0xffff, 0x8110, "message lost, buffer overrun" },
	{ 0xffff, 0x8130, "heartbeat missing" },
	{ 0xffff, 0x8210, "PDO too short, not processed" },
	{ 0xffff, 0x8220, "PDO too long" },
	{ 0xffff, 0x8250, "PDO timeout" },
	{ 0xff00, 0x0000, "no error any more" },
	{ 0xff00, 0x2100, "current, input side" },
	{ 0xff00, 0x2200, "current inside the device" },
	{ 0xff00, 0x2300, "current, output side" },
	{ 0xff00, 0x3100, "mains voltage" },
	{ 0xff00, 0x3200, "voltage inside the device" },
	{ 0xff00, 0x3300, "output voltage" },
	{ 0xff00, 0x4100, "ambient temperature" },
	{ 0xff00, 0x4200, "device temperature" },
	{ 0xff00, 0x6100, "internal software" },
	{ 0xff00, 0x6200, "user software" },
	{ 0xff00, 0x6300, "data set" },
	{ 0xff00, 0x8100, "communication" },
	{ 0xff00, 0x8200, "protocol error" },
	{ 0xff00, 0xa000, "AL state change" },
	{ 0xff00, 0xff00, "device specific" },
	{ 0xf000, 0x1000, "generic error" },
	{ 0xf000, 0x2000, "current" },
	{ 0xf000, 0x3000, "voltage" },
	{ 0xf000, 0x4000, "temperature" },
	{ 0xf000, 0x5000, "device hardware" },
	{ 0xf000, 0x6000, "device software" },
	{ 0xf000, 0x7000, "additional modules" },
	{ 0xf000, 0x8000, "monitoring" },
	{ 0xf000, 0x9000, "external error" },
	{ 0xf000, 0xf000, "additional functions" },
};

/* CiA 402 (IEC 61800-7-201), error codes of object 0x603f; what is finer comes first */
static const struct emergency drive_emergencies[] = {
	{ 0xffff, 0x2110, "short circuit or earth leakage, input side" },
	{ 0xffff, 0x2120, "earth leakage, input side" },
	{ 0xffff, 0x2130, "short circuit, input side" },
	{ 0xfff0, 0x2210, "overcurrent inside the drive" },
	{ 0xffff, 0x2220, "continuous overcurrent inside the drive" },
	{ 0xffff, 0x2230, "short circuit or earth leakage inside the drive" },
	{ 0xffff, 0x2240, "earth leakage inside the drive" },
	{ 0xffff, 0x2250, "short circuit inside the drive" },
	{ 0xfff0, 0x2310, "continuous overcurrent, motor side" },
	{ 0xffff, 0x2320, "short circuit or earth leakage, motor side" },
	{ 0xffff, 0x2330, "earth leakage, motor side" },
	{ 0xffff, 0x2340, "short circuit, motor side" },
	{ 0xfff0, 0x3110, "mains overvoltage" },
	{ 0xfff0, 0x3120, "mains undervoltage" },
	{ 0xfff0, 0x3130, "mains phase failure" },
	{ 0xfff0, 0x3140, "mains frequency" },
	{ 0xfff0, 0x3210, "DC link overvoltage" },
	{ 0xfff0, 0x3220, "DC link undervoltage" },
	{ 0xffff, 0x3230, "load error" },
	{ 0xfff0, 0x3310, "output overvoltage" },
	{ 0xffff, 0x3320, "armature circuit" },
	{ 0xffff, 0x3330, "field circuit" },
	{ 0xffff, 0x4110, "ambient temperature too high" },
	{ 0xffff, 0x4120, "ambient temperature too low" },
	{ 0xffff, 0x4210, "temperature of the drive too high" },
	{ 0xffff, 0x4220, "temperature of the drive too low" },
	{ 0xffff, 0x4310, "temperature of the motor too high" },
	{ 0xffff, 0x4320, "temperature of the motor too low" },
	{ 0xfff0, 0x4410, "temperature of the supply too high" },
	{ 0xfff0, 0x5110, "supply of the electronics" },
	{ 0xfff0, 0x5120, "supply of the DC link" },
	{ 0xffff, 0x5210, "measuring circuit" },
	{ 0xffff, 0x5220, "computing circuit" },
	{ 0xfff0, 0x5400, "power section" },
	{ 0xfff0, 0x5410, "output stages" },
	{ 0xfff0, 0x5420, "brake chopper" },
	{ 0xfff0, 0x5440, "contacts" },
	{ 0xfff0, 0x5450, "fuses" },
	{ 0xff00, 0x5500, "memory" },
	{ 0xfff0, 0x6010, "watchdog, software reset" },
	{ 0xfff0, 0x6310, "parameters lost" },
	{ 0xfff0, 0x6320, "parameter error" },
	{ 0xfff0, 0x7110, "brake chopper" },
	{ 0xffff, 0x7121, "motor blocked" },
	{ 0xffff, 0x7122, "motor or commutation error" },
	{ 0xffff, 0x7123, "motor tilted" },
	{ 0xfff0, 0x7120, "motor" },
	{ 0xff00, 0x7200, "measuring circuit" },
	{ 0xffff, 0x7301, "tachometer fault" },
	{ 0xffff, 0x7302, "tachometer with wrong polarity" },
	{ 0xffff, 0x7303, "fault of resolver 1" },
	{ 0xffff, 0x7304, "fault of resolver 2" },
	{ 0xffff, 0x7305, "fault of encoder 1" },
	{ 0xffff, 0x7306, "fault of encoder 2" },
	{ 0xffff, 0x7310, "speed sensor" },
	{ 0xffff, 0x7320, "position sensor" },
	{ 0xff00, 0x7300, "sensor" },
	{ 0xff00, 0x7400, "computing circuit" },
	{ 0xff00, 0x7500, "communication" },
	{ 0xff00, 0x7600, "data storage" },
	{ 0xffff, 0x8311, "torque too high" },
	{ 0xffff, 0x8312, "hard to start" },
	{ 0xffff, 0x8313, "torque at standstill" },
	{ 0xffff, 0x8321, "torque too low" },
	{ 0xffff, 0x8331, "torque fault" },
	{ 0xff00, 0x8300, "torque control" },
	{ 0xff00, 0x8400, "speed controller" },
	{ 0xff00, 0x8500, "position controller" },
	{ 0xffff, 0x8611, "following error" },
	{ 0xffff, 0x8612, "reference or position limit" },
	{ 0xff00, 0x8600, "positioning controller" },
	{ 0xff00, 0x8700, "synchronization controller" },
	{ 0xff00, 0x8800, "winding controller" },
	{ 0xff00, 0x8900, "monitoring of process data" },
	{ 0xff00, 0x8a00, "control deviation" },
	{ 0xffff, 0xf001, "deceleration" },
	{ 0xffff, 0xf002, "speed below synchronous speed" },
	{ 0xffff, 0xf003, "stroke operation" },
	{ 0xffff, 0xf004, "control" },
};

static const char *find_text(const struct emergency *e, size_t n, u16 code)
{
	size_t i;

	for (i = 0; i < n; i++)
		if ((code & e[i].mask) == e[i].code)
			return e[i].text;
	return NULL;
}

/**
 * ec_emergency_text() - what the code of an emergency is about
 * @code: error code
 * @profile: device profile of the slave, 402: a drive; 0: not known
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text of the code or of its group, never NULL.
 */
const char *ec_emergency_text(u16 code, u32 profile)
{
	const char *text = NULL;

	if (profile == EC_PROFILE_DRIVE)
		text = find_text(drive_emergencies, ARRAY_SIZE(drive_emergencies), code);
	return text ?: find_text(emergencies, ARRAY_SIZE(emergencies), code) ?: "unknown group";
}
