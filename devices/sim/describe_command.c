// SPDX-License-Identifier: GPL-2.0-only
/* Faults for a segment that runs, written as in its description. */
#include "describe_int.h"

static int read_line(struct ec_desc *d, const char *text, size_t len)
{
	const char *p = text, *end = text + len;
	int ret = ec_desc_split(d, &p, end);

	if (ret)
		return ret;
	if (p < end)
		return ec_desc_fail(d, "expected one fault on one line", NULL, "");
	if (!d->n)
		return ec_desc_fail(d, "no fault given; expected for example: cut NAME.1", NULL, "");
	if (ec_desc_is(&d->w[0], "fault"))
		ec_desc_next(d);
	ret = ec_desc_fault(d);
	return ret ? ret : ec_desc_end(d);
}

/**
 * ec_sim_command() - read a fault for a segment that runs
 * @sim: segment; only what never changes is looked at, so it needs no lock
 * @ops: where memory comes from
 * @text: "[fault] [at=TIME] WHAT" of describe.h; need not be terminated
 * @len: bytes at @text
 * @f: the fault, for ec_sim_add_fault()
 * @err: what is wrong, if anything
 *
 * Context: Process. May sleep.
 * Return: 0, -EINVAL: the text is wrong, or -ENOMEM.
 */
int ec_sim_command(struct ec_sim *sim, const struct ec_sim_ops *ops, const char *text,
		   size_t len, struct ec_sim_fault *f, struct ec_sim_error *err)
{
	struct ec_desc *d = ops->alloc(sizeof(*d));
	u32 n = ec_sim_count(sim);
	int ret = -ENOMEM;

	memset(err, 0, sizeof(*err));
	if (!d) {
		memcpy(err->text, "out of memory", 14);
		return -ENOMEM;
	}
	d->err = err;
	d->sim = sim;
	d->command = f;
	d->node = ops->alloc(n * sizeof(*d->node));
	if (d->node) {
		for (u32 i = 0; i < n; i++)
			d->node[i].app = ec_app_of(ec_sim_at(sim, i));
		d->n_nodes = n;
		ret = read_line(d, text, len);
	} else {
		memcpy(err->text, "out of memory", 14);
	}
	ops->free(d->node);
	ops->free(d);
	return ret;
}
