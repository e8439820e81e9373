// SPDX-License-Identifier: GPL-2.0-only
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"
#include "replay.h"

static const char line[] =
	"segment seed=33 response=500us transition=200us\n"
	"slave hub EK1100\nslave a drive mbox=512 serial=12 soe=2\n";

struct cyc *replay_reserve(struct kunit *test)
{
	struct bus *b = bus_up(test, line, 2);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	return c;
}

struct cyc *replay_configure(struct kunit *test)
{
	struct cyc *c = replay_reserve(test);

	cyc_map_all(c, DRIVE, 1, 0);
	return c;
}

int replay_put_of(struct bus *b, struct ec_file *f, u16 index, u8 sub, u64 value, u32 size)
{
	struct ec_ioc_sdo i = {
		.index = index, .subindex = sub, .slave.position = DRIVE, .size = size,
		.data = (uintptr_t)&value,
	};

	return ec_ioc(f, EC_IOC_SDO_DOWNLOAD, &i);
}

void replay_put(struct cyc *c, u16 index, u8 sub, u64 value, u32 size)
{
	struct bus *b = c->b;

	KUNIT_ASSERT_EQ_MSG(b->test, replay_put_of(b, &b->app, index, sub, value, size), 0, "%s",
			    b->app.reason);
}

/* what the slave has */
u64 replay_value(struct bus *b, u16 index, u8 sub, u32 size)
{
	struct ec_app *app = bus_app(b, "a");
	const struct ec_app_entry *e = ec_app_od_entry(app->model, index, sub);
	u64 v = 0;

	KUNIT_ASSERT_NOT_NULL(b->test, e);
	memcpy(&v, app->data + e->off, size);
	return v;
}

/* entry @n of the record; false: there is none */
bool replay_entry(struct cyc *c, u32 n, struct ec_ioc_config_write *i, u64 *v)
{
	int ret;

	*v = 0;
	*i = (struct ec_ioc_config_write){
		.write_pos = n, .size = sizeof(*v), .data = (uintptr_t)v,
	};
	ret = ec_ioc(&c->b->app, EC_IOC_CONFIG_WRITE, i);
	KUNIT_EXPECT_TRUE(c->b->test, !ret || ret == -ENOENT);
	return !ret;
}

u32 replay_entries(struct cyc *c)
{
	struct ec_ioc_config_write i;
	u32 n = 0;
	u64 v;

	while (replay_entry(c, n, &i, &v))
		n++;
	return n;
}

/* why the write of an object is not replayed; ~0: it is not recorded */
u32 replay_not(struct cyc *c, u16 index, u8 sub)
{
	struct ec_ioc_config_write i;
	u32 n;
	u64 v;

	for (n = 0; replay_entry(c, n, &i, &v); n++)
		if (i.kind == EC_WRITE_KIND_SDO && i.object == index && i.subindex == sub)
			return i.why;
	return ~0;
}

void replay_into_op(struct cyc *c)
{
	cyc_activate(c);
	KUNIT_ASSERT_NE(c->b->test, cyc_wait_op(c, 5000), ~0ull);
}

void replay_power_off(struct cyc *c)
{
	bus_fault(c->b, EC_SIM_FAULT_POWER_OFF, DRIVE, 0, 0, 0);
	cyc_run(c, 500);
	KUNIT_ASSERT_FALSE(c->b->test, cyc_all_op(c));
}

void replay_power_on(struct cyc *c)
{
	bus_fault(c->b, EC_SIM_FAULT_POWER_ON, DRIVE, 0, 0, 0);
}

void replay_why_text(struct cyc *c, char *text)
{
	struct ec_ioc_config_why w = { .index = 0 };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_CONFIG_WHY, &w), 0);
	strscpy(text, w.text, sizeof(w.text));
}
