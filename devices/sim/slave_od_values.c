// SPDX-License-Identifier: GPL-2.0-only
/* Unit, default, minimum and maximum of entries, as SDO information describes them. */
#include "app.h"

/* of a drive: its own unit types, and limits of settings */
static const struct {
	u16 index;
	u8 sub;
	u8 info;
	u16 unit;
	s32 min;
	s32 max;
} known[] = {
	{ 0x6060, 0x00, EC_OD_INFO_MIN | EC_OD_INFO_MAX, 0, -1, 10 },
	{ 0x6065, 0x00, EC_OD_INFO_VALUES, 0x00B5, 0, 0x7FFFFFFF },
	{ 0x607A, 0x00, EC_OD_INFO_UNIT, 0x00B5, 0, 0 },
	{ 0x60FF, 0x00, EC_OD_INFO_VALUES, 0xB503, -2000000, 2000000 },
	{ 0x8010, 0x50, EC_OD_INFO_VALUES, 0x00B5, 0, 0x7FFFFFFF },
};

static void put(u8 to[4], s32 value)
{
	for (int i = 0; i < 4; i++)
		to[i] = (u8)((u32)value >> (8 * i));
}

/**
 * ec_app_od_values() - optional fields of the description of an entry
 * @m: dictionary
 * @e: entry
 * @info: fields that the master asks for
 * @v: result, with those of them that the entry has
 *
 * What can be written has a default, unless it lists process data.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_od_values(const struct ec_app_model *m, const struct ec_app_entry *e, u8 info,
		      struct ec_app_od_values *v)
{
	u8 has = e->access & EC_OD_WRITE && e->bits <= 64 && !ec_app_pdo_is_config(e->index) ?
		 EC_OD_INFO_DEFAULT : 0;

	memset(v, 0, sizeof(*v));
	for (u32 i = 0; i < ARRAY_SIZE(known); i++) {
		if (known[i].index != e->index || known[i].sub != e->sub || e->bits > 32)
			continue;
		has |= known[i].info & ~EC_OD_INFO_DEFAULT;
		v->v.unit = known[i].unit;
		put(v->min, known[i].min);
		put(v->max, known[i].max);
	}
	v->v.info = has & info;
	v->v.unit_size = 2;
	v->v.size = DIV_ROUND_UP((size_t)e->bits, 8);
	v->v.def = m->defaults + e->off;
	v->v.min = v->min;
	v->v.max = v->max;
}
