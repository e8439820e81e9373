// SPDX-License-Identifier: GPL-2.0-only
#include "cyc.h"
#include "oom.h"
#include "oom_case.h"
#include "master/boundary/ioctl.h"

const char oom_line[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave small drive mbox=64\nslave large drive mbox=512 soe=1 voe=0x4321 foe=16\n"
	"slave digital EL2008\nslave switch EL6614\n";

unsigned long oom_place;

static atomic_t left;	/* allocations until one fails, 0: none does */
static atomic_t then;	/* and from that one until the next that fails */
static bool lasting;	/* all after it fail */

/* Asked before each allocation of the master. */
bool oom_fails(void)
{
	if (READ_ONCE(lasting) && READ_ONCE(oom_place))
		return true;
	if (atomic_dec_if_positive(&left))
		return false;
	WRITE_ONCE(oom_place, _RET_IP_);
	atomic_set(&left, atomic_xchg(&then, 0));
	return true;
}

static void begin(u32 n, u32 m, bool lasts)
{
	WRITE_ONCE(oom_place, 0);
	WRITE_ONCE(lasting, lasts);
	atomic_set(&then, m);
	atomic_set(&left, n);
}

/* The @n-th allocation from now on fails. */
void oom_fail(u32 n)
{
	begin(n, 0, false);
}

/* The @n-th allocation fails, and the @m-th after it. */
void oom_fail_two(u32 n, u32 m)
{
	begin(n, m, false);
}

/* From the @n-th on all fail, until oom_has_failed(). */
void oom_fail_from(u32 n)
{
	begin(n, 0, true);
}

/* No allocation fails any more. Returns whether one has. */
bool oom_has_failed(void)
{
	atomic_set(&left, 0);
	atomic_set(&then, 0);
	WRITE_ONCE(lasting, false);
	return oom_place;
}

/* .exit of these suites */
void oom_exit(struct kunit *test)
{
	oom_has_failed();
	bus_exit(test);
}

static bool is_whole(struct bus *b)
{
	u32 i;

	if (bus_n_slaves(b) != OOM_SLAVES || !bus_settled(b))
		return false;
	for (i = 0; i < OOM_SLAVES; i++) {
		const struct ec_slave *s = bus_slave_at(b, i);

		if (s->al.status != EC_AL_PREOP || s->note.error || s->pdos.unread ||
		    ec_slave_pdos_pending(s) || s->note.warning[0])
			return false;
	}
	return true;
}

bool oom_becomes_whole(struct bus *b)
{
	u32 ms;

	for (ms = 0; ms < 20000 && !is_whole(b); ms++)
		usleep_range(1000, 1001);
	return ms < 20000;
}

/* an application, each step of which may fail */
int oom_configure(struct bus *b, struct cyc *c, bool kernel)
{
	struct ec_ioc_cycle by_kernel = { .period_ns = NSEC_PER_MSEC, .cpu = -1 };
	struct ec_ioc_sc_request request = {
		.config = OOM_DRIVE, .kind = EC_REQUEST_SDO, .size = 100,
	};
	struct ec_ioc_create_domain d = { 0 };
	struct ec_ioc_activate a = { 0 };
	u32 i, value = 1, sm;
	int ret = ec_ioc(&b->app, EC_IOC_RESERVE, NULL);

	if (!ret)
		ret = ec_ioc(&b->app, EC_IOC_CREATE_DOMAIN, &d);
	c->queued = BIT_ULL(0);
	for (i = 0; i < OOM_SLAVES && !ret; i++) {
		const struct ec_slave *s = bus_slave(b, i);
		struct ec_ioc_slave_config sc = {
			.position = i, .vendor_id = s->info.vendor,
			.product_code = s->info.product,
		};

		ret = ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc);
		for (sm = 0; sm < s->n_sms && !ret; sm++) {
			struct ec_ioc_reg_entry r = {
				.flags = EC_REG_ENTRY_BY_POS, .config = i, .sm = sm,
			};

			if (ec_pdo_list_bytes(&s->pdos.sm[sm]))
				ret = ec_ioc(&b->app, EC_IOC_REG_ENTRY, &r);
		}
	}
	if (!ret) {
		struct ec_ioc_sc_sdo sdo = {
			.config = OOM_DRIVE, .index = 0x2001, .subindex = 8, .size = sizeof(value),
			.data = (uintptr_t)&value,
		};

		ret = ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo);
	}
	if (!ret)
		ret = ec_ioc(&b->app, EC_IOC_SC_REQUEST, &request);
	if (!ret && kernel)
		ret = ec_ioc(&b->app, EC_IOC_CYCLE, &by_kernel);
	return ret ?: ec_ioc(&b->app, EC_IOC_ACTIVATE, &a);
}
