// SPDX-License-Identifier: GPL-2.0-only
/*
 * CiA 402 drive: state machine of control and status word, cyclic synchronous
 * position (8) and velocity (9), profile position (1, without its ramps). The
 * load follows as a critically damped system of second order, in fixed point.
 */
#include "app.h"

#define STEP_NS		244141u	/* 2^-12 s */
#define STEP_SHIFT	12
#define STEPS_MAX	4096u	/* one second; longer pauses are cut to it */
#define FRAC		12	/* bits behind the point of position and speed */
#define OMEGA		188	/* rad/s: 30 Hz */
#define FOLLOW_NEVER	0xFFFFFFFFu

enum drive_state {
	SWITCH_ON_DISABLED,
	READY,
	SWITCHED_ON,
	ENABLED,
	QUICK_STOP,
	FAULT,
};

static const u16 status_of[] = {
	[SWITCH_ON_DISABLED] = 0x0040,
	[READY] = 0x0021,
	[SWITCHED_ON] = 0x0023,
	[ENABLED] = 0x0027,
	[QUICK_STOP] = 0x0007,
	[FAULT] = 0x0008,
};

enum drive_obj {
	CONTROL, STATUS, MODE, MODE_SHOWN, TARGET_POS, TARGET_VEL, POS, VEL,
	FOLLOW, FOLLOW_WINDOW, TORQUE, OBJS
};

/* CiA 402 numbers, then those of the EL72xx */
static const struct {
	u16 index;
	u8 sub;
} numbers[2][OBJS] = {
	{
		[CONTROL] = { 0x6040, 0 },
		[STATUS] = { 0x6041, 0 },
		[MODE] = { 0x6060, 0 },
		[MODE_SHOWN] = { 0x6061, 0 },
		[TARGET_POS] = { 0x607A, 0 },
		[TARGET_VEL] = { 0x60FF, 0 },
		[POS] = { 0x6064, 0 },
		[VEL] = { 0x606C, 0 },
		[FOLLOW] = { 0x60F4, 0 },
		[FOLLOW_WINDOW] = { 0x6065, 0 },
		[TORQUE] = { 0x6077, 0 },
	}, {
		[CONTROL] = { 0x7010, 0x01 },
		[STATUS] = { 0x6010, 0x01 },
		[MODE] = { 0x7010, 0x03 },
		[MODE_SHOWN] = { 0x6010, 0x03 },
		[TARGET_POS] = { 0x7010, 0x05 },
		[TARGET_VEL] = { 0x7010, 0x06 },
		[POS] = { 0x6000, 0x11 },
		[VEL] = { 0x6010, 0x07 },
		[FOLLOW] = { 0x6010, 0x09 },
		[FOLLOW_WINDOW] = { 0x8010, 0x50 },
		[TORQUE] = { 0x6010, 0x08 },
	},
};

/* their bytes; with another size an object is taken as missing */
static const u8 bytes[OBJS] = {
	[CONTROL] = 2, [STATUS] = 2, [MODE] = 1, [MODE_SHOWN] = 1,
	[TARGET_POS] = 4, [TARGET_VEL] = 4, [POS] = 4, [VEL] = 4,
	[FOLLOW] = 4, [FOLLOW_WINDOW] = 4, [TORQUE] = 2,
};

/**
 * struct drive - private memory of the profile
 * @p: values of its objects; of those that are missing @zero or @sink
 * @has_pos: there is a target position
 * @has_window: there is a following error window
 * @echo: there are filler entries
 * @zero: value of what is read and missing
 * @sink: where a value goes that is missing
 * @state: CiA 402 state
 * @control: last control word
 * @pos: position, counts << FRAC
 * @vel: velocity, counts/s << FRAC
 * @setpoint: target taken over in mode 1
 * @at_ns: motion is computed up to here
 */
struct drive {
	u8 *p[OBJS];
	bool has_pos;
	bool has_window;
	bool echo;
	u8 zero[4];
	u8 sink[4];
	enum drive_state state;
	u16 control;
	s64 pos;
	s64 vel;
	s32 setpoint;
	u64 at_ns;
};

/* is the object written by the drive */
static bool is_input(int obj)
{
	return obj == STATUS || obj == MODE_SHOWN || obj == POS || obj == VEL ||
	       obj == FOLLOW || obj == TORQUE;
}

static void drive_init(struct ec_app *app)
{
	struct drive *d = app->profile;
	int set = !ec_app_od_entry(app->model, 0x6040, 0);

	memset(d, 0, sizeof(*d));
	for (int i = 0; i < OBJS; i++) {
		const struct ec_app_entry *e =
			ec_app_od_entry(app->model, numbers[set][i].index,
					numbers[set][i].sub);

		d->p[i] = e && e->bits == 8 * bytes[i] ? app->data + e->off :
			  is_input(i) ? d->sink : d->zero;
	}
	d->has_pos = d->p[TARGET_POS] != d->zero;
	d->has_window = d->p[FOLLOW_WINDOW] != d->zero;
	d->echo = ec_app_od_object(app->model, 0x2100) &&
		  ec_app_od_object(app->model, 0x2200);
	d->at_ns = app->esc->late.ran_ns;
}

static void fault(struct ec_app *app, struct drive *d, u16 code, u64 now)
{
	static const u8 data[5];

	d->state = FAULT;
	ec_app_emergency(app, code, 0x21, data, now);
}

static enum drive_state next_state(const struct drive *d, u16 c)
{
	bool reset = c & 0x80 && !(d->control & 0x80);

	if (d->state == FAULT)
		return reset ? SWITCH_ON_DISABLED : FAULT;
	/* the quick stop option code 0x605A is 2: standstill ends it */
	if (d->state == QUICK_STOP && !d->vel)
		return SWITCH_ON_DISABLED;
	if (!(c & 0x02))
		return SWITCH_ON_DISABLED;	/* disable voltage */
	if (!(c & 0x04))			/* quick stop */
		return d->state >= ENABLED ? QUICK_STOP : SWITCH_ON_DISABLED;
	switch (d->state) {
	case SWITCH_ON_DISABLED:
		return (c & 0x07) == 0x06 ? READY : d->state;
	case READY:
		return c & 0x01 ? SWITCHED_ON : d->state;
	case SWITCHED_ON:
		if (!(c & 0x01))
			return READY;
		return c & 0x08 ? ENABLED : d->state;
	case ENABLED:
		if (!(c & 0x01))
			return READY;
		return c & 0x08 ? d->state : SWITCHED_ON;
	default:
		return c & 0x08 && c & 0x01 ? ENABLED : d->state;
	}
}

/* one step towards position @target, which may be reached across the wrap */
static void step_position(struct drive *d, s32 target)
{
	s64 err, acc;

	err = (s64)(s32)((u32)target - (u32)(d->pos >> FRAC)) * (1 << FRAC) -
	      (d->pos & ((1 << FRAC) - 1));
	acc = OMEGA * OMEGA * err - 2 * OMEGA * d->vel;
	d->vel += acc / (1 << STEP_SHIFT);
	d->pos += d->vel / (1 << STEP_SHIFT);
}

static void step_velocity(struct drive *d, s32 target)
{
	s64 acc = OMEGA * ((s64)target * (1 << FRAC) - d->vel);

	d->vel += acc / (1 << STEP_SHIFT);
	d->pos += d->vel / (1 << STEP_SHIFT);
}

static void move(struct drive *d, u8 mode, u64 now)
{
	s32 pos = d->setpoint, vel = 0;
	u64 steps;

	if (mode == 8)
		pos = (s32)get_unaligned_le32(d->p[TARGET_POS]);
	if (mode == 9)
		vel = (s32)get_unaligned_le32(d->p[TARGET_VEL]);
	steps = div64_u64(now - d->at_ns, STEP_NS);
	d->at_ns += steps * STEP_NS;
	if (steps > STEPS_MAX)
		steps = STEPS_MAX;
	/* at rest without power there is nothing to compute */
	if (d->state != ENABLED && !d->vel)
		steps = 0;
	while (steps--) {
		if (d->state == ENABLED && (mode == 8 || mode == 1))
			step_position(d, pos);
		else
			step_velocity(d, d->state == ENABLED ? vel : 0);
	}
	/* less than a count a second is standstill */
	if (d->state != ENABLED && d->vel > -(1 << FRAC) && d->vel < 1 << FRAC)
		d->vel = 0;
}

/* filler entries of generic drives: inputs show what the outputs were */
static void echo(struct ec_app *app)
{
	const struct ec_app_model *m = app->model;

	for (u16 n = 0; n < 16; n++) {
		const struct ec_app_object *o = ec_app_od_object(m, 0x2100 + n);
		const struct ec_app_object *i = ec_app_od_object(m, 0x2200 + n);

		if (!o || !i)
			return;
		for (u32 k = 1; k < o->count && k < i->count; k++)
			ec_app_od_set(app, &m->entries[i->first + k],
				      ec_app_od_get(app,
						    &m->entries[o->first + k]));
	}
}

static void drive_run(struct ec_app *app, u64 now)
{
	struct drive *d = app->profile;
	u16 control = get_unaligned_le16(d->p[CONTROL]);
	u8 mode = *d->p[MODE];
	enum drive_state from = d->state;
	s32 pos, follow = 0;
	u16 status;
	u32 limit;

	/* an EL72xx with a target velocity only starts as one with CSV */
	if (!mode)
		mode = d->has_pos ? 8 : 9;
	d->state = next_state(d, control);
	if (d->state == ENABLED && from != ENABLED)
		d->setpoint = (s32)(d->pos >> FRAC);
	if (mode == 1 && control & 0x10 && !(d->control & 0x10))
		d->setpoint = (s32)get_unaligned_le32(d->p[TARGET_POS]);
	d->control = control;
	move(d, mode, now);

	pos = (s32)((d->pos + (1 << (FRAC - 1))) >> FRAC);
	if (mode == 8 && d->state == ENABLED)
		follow = (s32)(get_unaligned_le32(d->p[TARGET_POS]) -
			       (u32)pos);
	limit = d->has_window ? get_unaligned_le32(d->p[FOLLOW_WINDOW]) : FOLLOW_NEVER;
	if (limit != FOLLOW_NEVER && d->state == ENABLED &&
	    (u32)(follow < 0 ? -(s64)follow : follow) > limit)
		fault(app, d, 0x8611, now);

	status = status_of[d->state];
	if (d->state != SWITCH_ON_DISABLED && d->state != FAULT)
		status |= 0x0010;	/* voltage */
	if (d->state == ENABLED && mode != 1)
		status |= 0x1000;	/* follows the set point */
	if (d->state == ENABLED && mode == 1) {
		if (control & 0x10)
			status |= 0x1000;
		if (pos == d->setpoint)
			status |= 0x0400;
	}
	if (ec_app_state(app) == EC_AL_OP)
		status |= 0x0200;	/* remote */
	put_unaligned_le16(status, d->p[STATUS]);
	*d->p[MODE_SHOWN] = mode;
	put_unaligned_le32((u32)pos, d->p[POS]);
	put_unaligned_le32((u32)(d->vel >> FRAC), d->p[VEL]);
	put_unaligned_le32((u32)follow, d->p[FOLLOW]);
	if (d->echo)
		echo(app);
}

const struct ec_app_profile ec_app_profile_drive = {
	.size = sizeof(struct drive),
	.init = drive_init,
	.run = drive_run,
};
