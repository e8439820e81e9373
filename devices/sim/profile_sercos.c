// SPDX-License-Identifier: GPL-2.0-only
/*
 * A SERCOS drive without CoE: two lists of each axis are its process data. An
 * axis with its control word set moves with its velocity command.
 */
#include "app.h"

#define CONTROL		134
#define STATUS		135
#define TELEGRAM	15	/* type; 7: the lists */
#define LIST_IN		16
#define LIST_OUT	24
#define MODE		32
#define MODE_VELOCITY	2

#define ON		0xe000	/* control word: on, enabled, moving */
#define READY		0x4000	/* status word */
#define RUNS		0xc000
#define FAILED		0x2000
#define NS_PER_S	1000000000

/* @last_ns: time of the positions; @part: of an increment, of each axis, in 1e-9 */
struct sercos {
	u64 last_ns;
	s64 part[EC_SOE_DRIVES];
};

static u8 *value(const struct ec_app *app, u8 axis, u16 idn)
{
	return ec_app_idn_value(app, axis, ec_app_idn(idn));
}

static void map_value(struct ec_app *app, enum ec_app_dir dir, u8 axis, const struct ec_app_idn *i)
{
	u32 bits = 8u * ec_app_idn_bytes(i);

	app->map[dir][app->n_map[dir]++] = (struct ec_app_copy){
		.off = (u32)(ec_app_idn_value(app, axis, i) - app->data),
		.pos = 8u * app->bytes[dir], .bits = bits,
	};
	app->bytes[dir] = (u16)(app->bytes[dir] + bits / 8);
}

/* word first, then the IDNs of the list; false: one that cannot be there, or too many */
static bool map_axis(struct ec_app *app, enum ec_app_dir dir, u8 axis)
{
	const u8 *list = value(app, axis, dir == EC_APP_OUT ? LIST_OUT : LIST_IN);
	u16 n = get_unaligned_le16(list) / 2;

	map_value(app, dir, axis, ec_app_idn(dir == EC_APP_OUT ? CONTROL : STATUS));
	if (get_unaligned_le16(value(app, axis, TELEGRAM)) != 7)
		n = 0;
	for (u16 k = 0; k < n; k++) {
		u16 idn = get_unaligned_le16(list + EC_SOE_LIST_HDR + 2 * k);

		if (!ec_app_idn_is_mappable(dir, idn) ||
		    app->bytes[dir] + 4 > app->model->max_bytes[dir])
			return false;
		map_value(app, dir, axis, ec_app_idn(idn));
	}
	return true;
}

static bool map_dir(struct ec_app *app, enum ec_app_dir dir)
{
	bool ok = true;

	app->n_map[dir] = 0;
	app->bytes[dir] = 0;
	for (u8 axis = 0; axis < app->soe.drives && ok; axis++)
		ok = map_axis(app, dir, axis);
	if (!ok)
		app->bytes[dir] = 0;
	app->area_bytes[dir][0] = app->bytes[dir];
	app->map_end[dir][0] = app->n_map[dir];
	return ok;
}

static u16 sercos_map(struct ec_app *app)
{
	bool out = map_dir(app, EC_APP_OUT), in = map_dir(app, EC_APP_IN);

	if (!out)
		return 0x0025;	/* invalid output mapping */
	return in ? 0 : 0x0024;
}

static void move(struct ec_app *app, struct sercos *s, u8 axis, u64 ns)
{
	u8 *position = value(app, axis, 51);
	bool failed = get_unaligned_le16(value(app, axis, EC_SOE_IDN_ERROR));
	bool on = (get_unaligned_le16(value(app, axis, CONTROL)) & ON) == ON &&
		  ec_app_state(app) == EC_AL_OP && !failed;
	s32 velocity = 0;
	s64 whole;

	if (on && get_unaligned_le16(value(app, axis, MODE)) == MODE_VELOCITY)
		velocity = (s32)get_unaligned_le32(value(app, axis, 36));
	s->part[axis] += velocity * (s64)min_t(u64, ns, NS_PER_S);
	whole = div_s64(s->part[axis], NS_PER_S);
	s->part[axis] -= whole * NS_PER_S;
	put_unaligned_le32(get_unaligned_le32(position) + (u32)whole, position);
	put_unaligned_le32((u32)velocity, value(app, axis, 40));
	put_unaligned_le16(failed ? FAILED : on ? RUNS : READY, value(app, axis, STATUS));
}

static void sercos_run(struct ec_app *app, u64 now)
{
	struct sercos *s = app->profile;

	for (u8 axis = 0; axis < app->soe.drives; axis++)
		move(app, s, axis, now - s->last_ns);
	s->last_ns = now;
}

static void sercos_init(struct ec_app *app)
{
	memset(app->profile, 0, sizeof(struct sercos));
}

const struct ec_app_profile ec_app_profile_sercos = {
	.size = sizeof(struct sercos),
	.map_cap = EC_SOE_DRIVES * (1 + EC_APP_SOE_MAP),
	.map = sercos_map,
	.init = sercos_init,
	.run = sercos_run,
};
