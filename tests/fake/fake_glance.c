// SPDX-License-Identifier: GPL-2.0-only
/*
 * Topologies, clocks and error counters for the fake master. FAKE_BUS:
 *   tree (slave 2 hangs at port 2 of slave 0), loop (ports that contradict each other), dc (the
 *   application uses the clocks; slave 2 has SYNC0 and is outside the window), noisy (errors
 *   between slaves 1 and 2), noisy2 (at three places), upstream (only forwarded errors), full (a
 *   counter at its limit), cleared (counters fall)
 */
#include "fake.h"

/* slave 1 hangs at port 1 of slave 0, slave 2 at its port 2 with a port closed by a command */
static void tree(struct fake_slave *s)
{
	if (s->position == 0) {
		s->ports[2] = (struct fake_port){ 3, 1, 0, 1, 1600, 2, 345 };
	} else if (s->position == 1) {
		s->ports[1] = (struct fake_port){ 2, 0, 0, 0, 0, EC_UAPI_NONE16, 0 };
	} else {
		s->ports[0] = (struct fake_port){ 3, 1, 0, 1, 5000, 0, 345 };
		s->ports[1] = (struct fake_port){ 2, 1, 1, 0, 0, EC_UAPI_NONE16, 0 };
	}
}

/* each is behind each other, and behind slaves that are not there */
static void loop(struct fake_slave *s)
{
	for (unsigned int p = 0; p < EC_UAPI_PORTS; p++)
		s->ports[p] = (struct fake_port){ 3, 1, 0, 1, 0,
			(__u16)(p < 3 ? p : 4711), 0 };
}

/* the clocks of slaves 0 and 2 */
static void clocks(struct fake_slave *s)
{
	if (s->position == 1)
		return;
	s->dc_set = 1;
	s->dc_offset = s->position ? (__u64)-815000000123456789LL : 17;
	s->dc_diff = s->position ? -1200 : 3;
	s->config = s->position;
}

void fake_glance_slave(struct fake_slave *s)
{
	if (fake_bus("tree"))
		tree(s);
	if (fake_bus("loop"))
		loop(s);
	if (fake_bus("dc"))
		clocks(s);
}

/*
 * From the second read of a slave's counters on: noise between slaves 1 and 2, which slave 0 sees
 * as forwarded, or another change.
 */
static __u8 second_reading(__u16 position, __u32 address)
{
	static const struct {
		const char *bus;
		__u16 position;
		__u16 address;
		__u8 value;
	} v[] = {
		{ "noisy", 2, 0x0300, 4 }, { "noisy", 2, 0x0301, 9 }, { "noisy", 1, 0x0302, 1 },
		{ "noisy", 0, 0x0309, 2 }, { "noisy", 2, 0x0310, 1 }, { "noisy2", 2, 0x0300, 4 },
		{ "noisy2", 0, 0x0300, 1 }, { "noisy2", 2, 0x0303, 2 },
		{ "upstream", 0, 0x0309, 7 }, { "upstream", 1, 0x0308, 7 },
	};

	for (size_t i = 0; i < LEN(v); i++)
		if (fake_bus(v[i].bus) && v[i].position == position && v[i].address == address)
			return v[i].value;
	return 0;
}

/* slave 2: a difference of -12 ns, AssignActivate and SYNC0 of 1 ms */
static __u8 clock_register(__u32 address)
{
	static const __u8 activation[] = { 0, 3, 0, 0, 1 }, cycle[] = { 0x40, 0x42, 0x0f };

	if (address == 0x092c)
		return 12;
	if (address >= 0x0980 && address < 0x0980 + LEN(activation))
		return activation[address - 0x0980];
	return address >= 0x09a0 && address < 0x09a0 + LEN(cycle) ? cycle[address - 0x09a0] : 0;
}

/* Change what fake_dev.c has put into the @to of a read. */
void fake_glance_registers(const struct ec_ioc_reg *x, __u8 *to)
{
	static unsigned int readings[3];
	bool again = x->address == 0x0300 && x->slave.position < LEN(readings) &&
		     readings[x->slave.position]++;

	for (__u32 i = 0; i < x->size; i++) {
		__u32 a = x->address + i;

		if (fake_bus("dc") && x->slave.position == 2)
			to[i] = clock_register(a);
		if (fake_bus("full") && x->slave.position == 1 && a == 0x0300)
			to[i] = 255;
		if (again)
			to[i] += second_reading(x->slave.position, a);
		if (again && fake_bus("cleared"))
			to[i] = 0;
	}
}
