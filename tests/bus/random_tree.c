// SPDX-License-Identifier: GPL-2.0-only
/* A tree of slaves at random, and an application with a cycle of 1 ms for it. */
#include "random.h"
#include "master/boundary/ioctl.h"

#define ALIAS	1000u	/* of the first slave */
#define DOMAINS	60u	/* at most; of a tree with fewer slaves each has its own */
#define TEXT	65536u

u32 random_below(struct random_run *r, u32 n)
{
	r->rng = r->rng * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)((r->rng >> 32) * n >> 32);
}

/* kinds of slaves, and their ports that others may be connected to */
static const struct kind {
	const char *words;
	u32 ports;
	bool mailbox;
	bool io;
} kinds[] = {
	{ "EK1100", 2, false, false },
	{ "EK1122", 3, false, false },
	{ "drive in=1 out=1 mbox=64 foe=16", 1, true, false },
	{ "drive in=8 out=8 mbox=128 foe=16", 1, true, false },
	{ "drive in=1 out=1", 1, false, false },
	{ "drive in=8 out=8", 1, false, false },
	{ "drive in=8 out=8", 1, false, false },
	{ "io in=8 out=8", 1, false, true },
	{ "io in=8 out=8", 1, false, true },
};

static const char foreign[] =
	"branch none\nslave x0 drive in=8 out=8\nslave x1 drive in=8 out=8\n"
	"branch none\nslave x2 drive in=8 out=8\nbranch none\nslave x3 EK1100\n";

struct port {
	u16 slave;
	u8 port;
};

static size_t describe_slave(struct random_run *r, char *text, u32 i, const struct kind *k)
{
	size_t len = 0;
	u32 n;

	len += scnprintf(text + len, TEXT, "slave s%u %s alias=%u cable=%u drift=%dppb clock=%ums\n",
			 i, k->words, ALIAS + i, random_below(r, 500),
			 (int)random_below(r, 200001) - 100000, random_below(r, 100000));
	for (n = 1; k->io && n <= 8; n++)
		len += scnprintf(text + len, TEXT, "connect s%u.%u -> s%u.%u\n", i, n, i, n);
	r->s[i].mailbox = k->mailbox;
	return len;
}

/**
 * random_tree() - describe a tree of 5 to 200 slaves
 * @r: run, with its seed; gets the number of slaves and how events come
 * @test: case
 *
 * Each slave is connected to any free port of those before. Slaves that are not connected follow.
 *
 * Return: text for bus_new().
 */
char *random_tree(struct random_run *r, struct kunit *test)
{
	char *text = kunit_kzalloc(test, TEXT, GFP_KERNEL);
	struct port *open = kunit_kzalloc(test, 3 * RANDOM_SLAVES * sizeof(*open), GFP_KERNEL);
	u32 i, p, at, n_open = 0;
	size_t len;

	KUNIT_ASSERT_NOT_NULL(test, text);
	KUNIT_ASSERT_NOT_NULL(test, open);
	r->rng = r->seed * 2 + 1;
	for (i = 0; i < 8; i++)
		random_below(r, 2);
	r->n = 5 + random_below(r, 196);
	r->clocks = random_below(r, 2);
	r->hosts = !random_below(r, 4);
	r->early = random_below(r, 3);
	len = scnprintf(text, TEXT, "segment seed=%llu response=100us transition=1ms%s%s\n",
			r->seed + 1, r->hosts ? " link=200ms" : "",
			r->n <= 40 && random_below(r, 2) ? " under_way=random" : "");
	for (i = 0; i < r->n; i++) {
		const struct kind *k = &kinds[random_below(r, ARRAY_SIZE(kinds))];

		if (i) {
			/* one of two at the port that was added last: there are long lines */
			at = random_below(r, 2) ? random_below(r, n_open) : n_open - 1;
			len += scnprintf(text + len, TEXT - len, "branch s%u %u\n",
					 open[at].slave, open[at].port);
			open[at] = open[--n_open];
		}
		len += describe_slave(r, text + len, i, k);
		for (p = 1; p <= k->ports; p++)
			open[n_open++] = (struct port){ i, p };
	}
	scnprintf(text + len, TEXT - len, "%s", foreign);
	return text;
}

static u32 index_of(struct bus *b, const struct ec_esc *esc)
{
	u32 i;

	for (i = 0; bus_esc(b, i) != esc; i++)
		;
	return i;
}

/* byte of the process data of a drive or an io that comes back */
static u32 echo_at(const struct ec_slave *s, u32 sm)
{
	return ec_pdo_list_bytes(&s->pdos.sm[sm]) == 8 ? 6 : 0;
}

static void map_slave(struct random_run *r, u32 position, u32 domains)
{
	u32 i = index_of(r->b, r->b->sim->route[0].step[position].esc), sm, offset;
	const struct ec_slave *s = bus_slave(r->b, position);
	struct ec_ioc_slave_config sc = {
		.alias = ALIAS + i, .vendor_id = s->info.vendor, .product_code = s->info.product,
	};
	struct random_slave *x = &r->s[i];

	KUNIT_ASSERT_EQ_MSG(r->b->test, ec_ioc(&r->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0, "%s",
			    r->b->app.reason);
	x->configured = true;
	x->domain = i % domains;
	for (sm = 0; sm < s->n_sms; sm++) {
		if (!ec_pdo_list_bytes(&s->pdos.sm[sm]))
			continue;
		offset = cyc_map(r->c, sc.index, sm, x->domain) + echo_at(s, sm);
		if (!x->data)
			x->out = offset;
		else
			x->in = offset;
		x->data = true;
	}
	if (r->clocks && x->data && ec_slave_features(s) & EC_FEAT_DC) {
		struct ec_ioc_sc_dc dc = {
			.config = sc.index, .assign_activate = 0x0300, .cycle0 = 1000000,
		};

		KUNIT_ASSERT_EQ(r->b->test, ec_ioc(&r->b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

/**
 * random_application() - all slaves by their aliases, active
 * @r: run; all slaves are there
 */
void random_application(struct random_run *r)
{
	u32 i, domains = min(r->n, DOMAINS);

	r->c = cyc_new(r->b, 1000);
	for (i = 0; i < domains; i++)
		cyc_domain(r->c);
	for (i = 0; i < r->n; i++)
		map_slave(r, i, domains);
	r->c->ctx = r;
	r->c->each = random_look;
	r->last_ns = ktime_get_ns();
	r->rescan_ns = r->last_ns + 5 * NSEC_PER_SEC;
	r->disturbed = r->b->sim->disturbed;
	cyc_activate(r->c);
}
