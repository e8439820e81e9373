// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * A CiA 402 drive: to "operation enabled", then a slow cosine of the target
 * position or, where only that is mapped, its derivative as target velocity.
 */
#include "demo.h"

#include <math.h>

#define AMPLITUDE	100000.0	/* counts, from end to end */
#define FOLLOWS		0.9		/* correlation */

#define MODE_CSP	8
#define MODE_CSV	9

/* The same role has a CiA 402 number, or one of Beckhoff's own profile. */
struct role {
	ec_direction_t dir;
	uint16_t index[2];
	uint8_t subindex[2];
	unsigned int bits;
};

static const struct role control = { EC_DIR_OUTPUT, { 0x6040, 0x7010 }, { 0, 1 }, 16 };
static const struct role status = { EC_DIR_INPUT, { 0x6041, 0x6010 }, { 0, 1 }, 16 };
static const struct role mode = { EC_DIR_OUTPUT, { 0x6060, 0x7010 }, { 0, 3 }, 8 };
static const struct role target_pos = { EC_DIR_OUTPUT, { 0x607a, 0x7010 }, { 0, 5 }, 32 };
static const struct role target_vel = { EC_DIR_OUTPUT, { 0x60ff, 0x7010 }, { 0, 6 }, 32 };
static const struct role actual = { EC_DIR_INPUT, { 0x6064, 0x6000 }, { 0, 0x11 }, 32 };

static int reg(struct point *p, const struct role *r, const struct layout *l,
	       ec_slave_config_t *sc, ec_domain_t *domain)
{
	const struct entry *e;
	int i;

	for (i = 0; i < 2; i++) {
		e = layout_find(l, r->dir, r->index[i], r->subindex[i]);
		if (e && e->info.bit_length == r->bits)
			return point_register(p, sc, domain, e);
	}
	return 0;	/* not mapped: p->bits stays 0 */
}

/* 0: it is an axis; 1: it lacks what makes one; negative: errno */
int axis_register(struct axis *a, const struct layout *l, ec_slave_config_t *sc,
		  ec_domain_t *domain)
{
	int ret = reg(&a->control, &control, l, sc, domain);

	a->position = l->position;
	if (!ret)
		ret = reg(&a->status, &status, l, sc, domain);
	if (!ret)
		ret = reg(&a->mode, &mode, l, sc, domain);
	if (!ret)
		ret = reg(&a->target_pos, &target_pos, l, sc, domain);
	if (!ret)
		ret = reg(&a->target_vel, &target_vel, l, sc, domain);
	if (!ret)
		ret = reg(&a->actual, &actual, l, sc, domain);
	if (ret)
		return ret;
	return !(a->control.bits && a->status.bits && a->actual.bits &&
		 (a->target_pos.bits || a->target_vel.bits));
}

/* Control word that leads from the state in @word towards operation. */
static uint16_t next_control(struct axis *a, uint16_t word)
{
	bool fault = (word & 0x4f) == 0x08;

	/* the reset is an edge */
	a->reset = fault && !a->reset;
	if (fault)
		return a->reset ? 0x80 : 0x00;
	if ((word & 0x4f) == 0x40)	/* switch on disabled */
		return 0x06;
	switch (word & 0x6f) {
	case 0x21:			/* ready to switch on */
		return 0x07;
	case 0x23:			/* switched on */
	case 0x27:			/* operation enabled */
		return 0x0f;
	default:			/* not ready, quick stop */
		return 0x00;
	}
}

static void correlate(struct correlation *c, double x, double y)
{
	c->n += 1;
	c->x += x;
	c->y += y;
	c->xx += x * x;
	c->yy += y * y;
	c->xy += x * y;
}

/* Position @t_s after the start, relative to it: at rest at t_s = 0. */
static double course(double t_s, double turn_s)
{
	return AMPLITUDE / 2 * (1 - cos(2 * M_PI * t_s / turn_s));
}

static void write_target(const struct axis *a, uint8_t *data, int32_t at,
			 double t_s, double turn_s)
{
	double w = 2 * M_PI / turn_s;
	double vel = a->moving ? AMPLITUDE / 2 * w * sin(w * t_s) : 0;
	int32_t pos = a->moving ? (int32_t)((uint32_t)a->origin +
		(uint32_t)lrint(course(t_s, turn_s))) : at;

	if (a->mode.bits)
		EC_WRITE_S8(data + a->mode.byte, a->target_pos.bits ? MODE_CSP
								    : MODE_CSV);
	if (a->target_pos.bits)
		EC_WRITE_S32(data + a->target_pos.byte, pos);
	else
		EC_WRITE_S32(data + a->target_vel.byte, (int32_t)lrint(vel));
}

/*
 * One cycle. @on: the axis shall be enabled; @t_s: time since the motion
 * began, negative: it has not; @turn_s: time for once forth and back.
 */
void axis_cycle(struct axis *a, uint8_t *data, bool on, double t_s,
		double dt_s, double turn_s)
{
	uint16_t word = EC_READ_U16(data + a->status.byte);
	int32_t at = EC_READ_S32(data + a->actual.byte);

	a->enabled = (word & 0x6f) == 0x27;
	if (t_s < 0 || !a->enabled) {
		a->moving = false;
	} else if (!a->moving) {
		a->moving = true;
		a->origin = at;
	}
	if (a->moving) {
		a->last = (int32_t)((uint32_t)at - (uint32_t)a->origin);
		a->min = a->last < a->min ? a->last : a->min;
		a->max = a->last > a->max ? a->last : a->max;
		a->expected = course(t_s - dt_s, turn_s);
		correlate(&a->c, a->expected, a->last);
	}
	if ((word & 0x4f) == 0x08)
		a->faults++;
	write_target(a, data, at, t_s, turn_s);
	EC_WRITE_U16(data + a->control.byte, on ? next_control(a, word) : 0x06);
}

double axis_correlation(const struct axis *a)
{
	const struct correlation *c = &a->c;
	double vx, vy;

	if (c->n < 2)
		return 0;
	vx = c->xx - c->x * c->x / c->n;
	vy = c->yy - c->y * c->y / c->n;
	if (vx <= 0 || vy <= 0)
		return 0;
	return (c->xy - c->x * c->y / c->n) / sqrt(vx * vy);
}

/* By shape, not by size: the unit of a target velocity depends on the drive. */
bool axis_followed(const struct axis *a)
{
	return a->max > a->min && axis_correlation(a) >= FOLLOWS;
}
