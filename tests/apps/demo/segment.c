// SPDX-License-Identifier: LGPL-2.1-or-later
/* Which slaves there are, and where their values lie in the domain. */
#include "demo.h"

#include <stdio.h>

#define BECKHOFF	0x00000002
#define EL1004		0x03ec3052
#define EL1859		0x07433052
#define EL2004		0x07d43052
#define EL3062		0x0bf63052
#define EL4002		0x0fa23052
#define EL7201		0x1c213052

static int add_bits(struct point *points, unsigned int *count,
		    const struct layout *l, ec_direction_t dir,
		    ec_slave_config_t *sc, ec_domain_t *domain)
{
	const struct entry *e;
	unsigned int n;
	int ret;

	for (n = 0; *count < BITS_MAX && (e = layout_nth(l, dir, 1, n)); n++) {
		ret = point_register(&points[*count], sc, domain, e);
		if (ret)
			return ret;
		(*count)++;
	}
	return 0;
}

/* The 16 bit entries are the channels, in compact and in long PDOs. */
static int add_analog(struct point *p, const struct layout *l,
		      ec_direction_t dir, unsigned int channel,
		      ec_slave_config_t *sc, ec_domain_t *domain)
{
	const struct entry *e = layout_nth(l, dir, 16, channel);

	return e && !p->bits ? point_register(p, sc, domain, e) : 0;
}

static int add_axis(struct demo *d, const struct layout *l,
		    ec_slave_config_t *sc, ec_domain_t *domain)
{
	int ret;

	if (d->n_axes == AXES_MAX)
		return 0;
	ret = axis_register(&d->axes[d->n_axes], l, sc, domain);
	if (!ret)
		d->n_axes++;
	else if (ret > 0)
		fprintf(stderr, "demo: slave %u: no axis: control word, status word, position or target is not mapped\n",
			l->position);
	return ret < 0 ? ret : 0;
}

/* Everything is exchanged: a slave whose outputs nobody sends refuses OP. */
static int add_all(const struct layout *l, ec_slave_config_t *sc,
		   ec_domain_t *domain)
{
	struct point unused;
	unsigned int i;
	int ret = 0;

	for (i = 0; i < l->count && !ret; i++)
		ret = point_register(&unused, sc, domain, &l->entries[i]);
	return ret;
}

static int add_slave(struct demo *d, ec_master_t *m, ec_domain_t *domain,
		     uint16_t position)
{
	static struct layout l;
	ec_slave_config_t *sc;
	ec_slave_info_t info;
	int ret = 0;

	if (ecrt_master_get_slave(m, position, &info))
		return -1;
	/* those without process data, too: the whole segment shall reach OP */
	sc = ecrt_master_slave_config(m, 0, position, info.vendor_id,
				      info.product_code);
	if (!sc)
		return -1;
	d->sc[d->slaves++] = sc;
	if (layout_read(m, &info, &l) || add_all(&l, sc, domain))
		return -1;
	if (info.vendor_id != BECKHOFF)
		return 0;
	switch (info.product_code) {
	case EL1859:
	case EL1004:
	case EL2004:
		ret = add_bits(d->di, &d->n_di, &l, EC_DIR_INPUT, sc, domain);
		if (!ret)
			ret = add_bits(d->dout, &d->n_do, &l, EC_DIR_OUTPUT, sc,
				       domain);
		break;
	case EL3062:
		ret = add_analog(&d->ai, &l, EC_DIR_INPUT, 0, sc, domain);
		if (!ret)
			ret = add_analog(&d->ai_back, &l, EC_DIR_INPUT, 1, sc,
					 domain);
		break;
	case EL4002:
		d->ao_slave = d->ao.bits ? d->ao_slave : position;
		ret = add_analog(&d->ao, &l, EC_DIR_OUTPUT, 0, sc, domain);
		break;
	case EL7201:
		ret = add_axis(d, &l, sc, domain);
		break;
	}
	return ret;
}

/* Configures every slave; negative: not possible, and stderr says why. */
int segment_configure(struct demo *d, ec_master_t *m, ec_domain_t *domain)
{
	ec_master_info_t info;
	unsigned int i;

	if (ecrt_master(m, &info))
		return -1;
	if (!info.slave_count || info.slave_count > SLAVES_MAX) {
		fprintf(stderr, "demo: %u slaves; 1..%u are needed\n",
			info.slave_count, SLAVES_MAX);
		return -1;
	}
	for (i = 0; i < info.slave_count; i++)
		if (add_slave(d, m, domain, (uint16_t)i))
			return -1;
	return ecrt_master_set_send_interval(m, d->period_us);
}
