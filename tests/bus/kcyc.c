// SPDX-License-Identifier: GPL-2.0-only
#include "kcyc.h"

struct ec_shared *kcyc_shared(const struct kcyc *a)
{
	return bus_shared(a->c->b);
}

struct ec_status_cycle *kcyc_status(const struct kcyc *a)
{
	return &kcyc_shared(a)->status->kernel;
}

static struct ec_exchange_buffer *buffer(const struct kcyc *a, u32 n)
{
	struct ec_exchange *x = kcyc_shared(a)->exchange;

	return kcyc_shared(a)->exchange + EC_EXCHANGE_FIRST + n * x->stride;
}

/* Image in the output buffer the application may write. */
u8 *kcyc_outputs(const struct kcyc *a)
{
	return (u8 *)(buffer(a, a->back) + 1);
}

void kcyc_give(struct kcyc *a)
{
	struct ec_exchange *x = kcyc_shared(a)->exchange;

	a->back = xchg(&x->outputs, a->back | EC_EXCHANGE_NEW) & 3;
	KUNIT_ASSERT_LT(a->c->b->test, a->back, (u32)EC_EXCHANGE_BUFFERS);
}

/* Bit n: domain n; the others keep the outputs that the buffer has. */
void kcyc_give_domains(struct kcyc *a, u64 domains)
{
	buffer(a, a->back)->fed = domains;
	kcyc_give(a);
}

/* The newest inputs, or NULL when there are no new ones. */
struct ec_exchange_buffer *kcyc_take(struct kcyc *a)
{
	struct ec_exchange *x = kcyc_shared(a)->exchange;

	if (!(READ_ONCE(x->inputs) & EC_EXCHANGE_NEW))
		return NULL;
	a->front = xchg(&x->inputs, a->front) & 3;
	KUNIT_ASSERT_LT(a->c->b->test, a->front, (u32)EC_EXCHANGE_BUFFERS);
	return buffer(a, EC_EXCHANGE_BUFFERS + a->front);
}

int kcyc_wait(struct kcyc *a, u32 timeout_us)
{
	struct ec_ioc_wait w = { .cycle = a->seen, .timeout_us = timeout_us };
	int ret = ec_ioc(&a->c->b->app, EC_IOC_WAIT, &w);

	a->seen = w.cycle;
	return ret;
}

/* Two slaves whose inputs are their outputs of before. */
struct bus *kcyc_bus(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=31\nrepeat 2 slave s io in=6400 out=6400\n"
			       "connect s1.1 -> s1.1\nconnect s1.200 -> s1.200\n"
			       "connect s2.1 -> s2.1\nconnect s2.200 -> s2.200\n", 2);

	bus_idle(b);
	return b;
}

/* Both slaves in one domain; not active yet. */
struct kcyc *kcyc_configure(struct bus *b, struct ec_ioc_cycle cfg)
{
	struct kcyc *a = kunit_kzalloc(b->test, sizeof(*a), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, a);
	a->c = cyc_new(b, 1000);
	cyc_domain(a->c);
	cyc_map_all(a->c, 0, 2, 0);
	if (!cfg.period_ns)
		cfg.period_ns = KCYC_PERIOD_NS;
	cfg.cpu = -1;
	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0, "%s", b->app.reason);
	return a;
}

/* Return: as the command. */
int kcyc_activate(struct kcyc *a)
{
	struct bus *b = a->c->b;
	struct ec_ioc_activate act = { 0 };
	int ret = ec_ioc(&b->app, EC_IOC_ACTIVATE, &act);
	const struct ec_exchange *x;

	if (ret)
		return ret;
	x = kcyc_shared(a)->exchange;
	a->back = x->app_output;
	a->front = x->app_input;
	a->seen = kcyc_status(a)->cycle;
	a->taken_over = act.taken_over;
	return 0;
}

void kcyc_until_op(struct kcyc *a)
{
	u32 i;

	for (i = 0; i < 3000 && !cyc_all_op(a->c); i++)
		KUNIT_ASSERT_EQ(a->c->b->test, kcyc_wait(a, 0), 0);
	KUNIT_ASSERT_TRUE(a->c->b->test, cyc_all_op(a->c));
}

struct kcyc *kcyc_start(struct kunit *test, struct ec_ioc_cycle cfg)
{
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = kcyc_configure(b, cfg);

	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	kcyc_until_op(a);
	return a;
}

u32 kcyc_place(struct kcyc *a, u32 slave, u32 sm, u32 channel)
{
	return cyc_pd(a->c, slave, sm) - cyc_data(a->c, 0) + 4 * (channel - 1);
}

s64 kcyc_output(struct kcyc *a, const char *slave, u32 channel)
{
	return ec_app_channel(bus_app(a->c->b, slave), EC_APP_OUT, channel - 1);
}

/* The same number at the four far ends of the image. */
void kcyc_write(struct kcyc *a, u32 number)
{
	u8 *image = kcyc_outputs(a);
	u32 i;

	for (i = 0; i < 2; i++) {
		put_unaligned_le32(number, image + kcyc_place(a, i, 0, 1));
		put_unaligned_le32(number, image + kcyc_place(a, i, 0, KCYC_CHANNELS));
	}
}

void kcyc_wait_cycles(struct kcyc *a, u32 n)
{
	while (n--)
		KUNIT_ASSERT_EQ(a->c->b->test, kcyc_wait(a, 0), 0);
}
