// SPDX-License-Identifier: GPL-2.0-only
/* Process data of a simulated slave: assignment, mapping, copying. */
#include "app.h"

static bool is_assign(u16 index)
{
	return index >= 0x1C12 && index <= 0x1C1F;
}

static bool is_pdo(u16 index, enum ec_app_dir dir)
{
	return dir == EC_APP_OUT ? index >= 0x1600 && index <= 0x17FF :
				   index >= 0x1A00 && index <= 0x1BFF;
}

/**
 * ec_app_pdo_is_config() - is an object a PDO assignment or mapping
 * @index: object
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_app_pdo_is_config(u16 index)
{
	return is_assign(index) || is_pdo(index, EC_APP_OUT) ||
	       is_pdo(index, EC_APP_IN);
}

static const struct ec_app_object *assignment(const struct ec_app_model *m, enum ec_app_dir dir,
					      int k)
{
	return ec_app_od_object(m, (u16)(0x1C10 + m->area[dir][k]));
}

static enum ec_app_dir dir_of(const struct ec_app_model *m, u16 index)
{
	if (is_assign(index))
		return ec_app_area(m, EC_APP_OUT, index - 0x1C10) >= 0 ? EC_APP_OUT : EC_APP_IN;
	return is_pdo(index, EC_APP_OUT) ? EC_APP_OUT : EC_APP_IN;
}

/* the list in object @index: its n-th value (from 1), 0 behind the end */
static u32 list_at(const struct ec_app *app, const struct ec_app_object *o,
		   u32 n)
{
	const struct ec_app_entry *e;

	if (!o || n > o->max_sub || n >= o->count)
		return 0;
	e = &app->model->entries[o->first];
	return (u32)ec_app_od_get(app, e + n);
}

static u32 list_len(const struct ec_app *app, const struct ec_app_object *o)
{
	if (!o)
		return 0;
	return (u32)ec_app_od_get(app, &app->model->entries[o->first]);
}

static u32 pdo_bits(const struct ec_app *app, u16 pdo)
{
	const struct ec_app_object *o = ec_app_od_object(app->model, pdo);
	u32 bits = 0, n = list_len(app, o);

	for (u32 i = 1; i <= n; i++)
		bits += list_at(app, o, i) & 0xFF;
	return bits;
}

/* may @pdo be assigned: it exists, or the slave itself had such an entry at power-on */
static bool assignable(const struct ec_app_model *m, enum ec_app_dir dir, u16 pdo)
{
	return ec_app_listed(&m->params.quirks.assign[dir], pdo) ||
	       (is_pdo(pdo, dir) && ec_app_od_object(m, pdo));
}

/* a value about to be written to an assignment */
static u32 check_assign(const struct ec_app *app, const struct ec_app_entry *e,
			u64 value)
{
	const struct ec_app_model *m = app->model;
	const struct ec_app_object *o = ec_app_od_object(m, e->index);
	enum ec_app_dir dir = dir_of(m, e->index);
	u32 bits = 0;

	if (e->sub) {
		if (list_len(app, o))
			return EC_ABORT_SUB0_FIRST;
		if (!value)
			return 0;
		return assignable(m, dir, (u16)value) ? 0 : EC_ABORT_RANGE;
	}
	if (value > o->max_sub)
		return EC_ABORT_TOO_HIGH;
	for (u32 i = 1; i <= value; i++) {
		u16 pdo = (u16)list_at(app, o, i);

		if (!pdo && !assignable(m, dir, 0))
			return EC_ABORT_RANGE;
		for (u32 k = 1; k < i; k++)
			if (list_at(app, o, k) == pdo)
				return EC_ABORT_PARAMETER;
		bits += pdo_bits(app, pdo);
	}
	return bits > m->max_bytes[dir] * 8u ? EC_ABORT_PDO_LENGTH : 0;
}

static bool assigned(const struct ec_app *app, enum ec_app_dir dir, u16 pdo)
{
	for (int k = 0; k < app->model->n_areas[dir]; k++) {
		const struct ec_app_object *o = assignment(app->model, dir, k);
		u32 n = list_len(app, o);

		for (u32 i = 1; i <= n; i++)
			if (list_at(app, o, i) == pdo)
				return true;
	}
	return false;
}

/* a value about to be written to a mapping */
static u32 check_mapping(const struct ec_app *app, const struct ec_app_entry *e,
			 u64 value)
{
	const struct ec_app_model *m = app->model;
	const struct ec_app_object *o = ec_app_od_object(m, e->index);
	enum ec_app_dir dir = dir_of(m, e->index);
	const struct ec_app_entry *var;
	u32 bits = 0;

	if (m->dev.mapping != EC_APP_MAP_LENIENT &&
	    assigned(app, dir, e->index))
		return EC_ABORT_STATE;
	if (!e->sub) {
		if (value > o->max_sub)
			return EC_ABORT_TOO_HIGH;
		for (u32 i = 1; i <= value; i++)
			bits += list_at(app, o, i) & 0xFF;
		return bits > m->max_bytes[dir] * 8u ? EC_ABORT_PDO_LENGTH : 0;
	}
	if (list_len(app, o))
		return EC_ABORT_SUB0_FIRST;
	if (!(value >> 16))
		return 0;	/* gap */
	var = ec_app_od_entry(m, (u16)(value >> 16), (u8)(value >> 8));
	if (!var || !(var->access & (dir == EC_APP_OUT ? EC_OD_RXPDO :
							 EC_OD_TXPDO)))
		return EC_ABORT_NOT_MAPPABLE;
	return var->bits == (value & 0xFF) ? 0 : EC_ABORT_LENGTH;
}

/**
 * ec_app_pdo_check_write() - may a value be written as process data layout
 * @app: slave
 * @e: entry; of other objects than assignment and mapping: always
 * @value: new value
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or an abort code.
 */
u32 ec_app_pdo_check_write(const struct ec_app *app,
			   const struct ec_app_entry *e, u64 value)
{
	if (is_assign(e->index))
		return check_assign(app, e, value);
	if (ec_app_pdo_is_config(e->index))
		return check_mapping(app, e, value);
	return 0;
}

/* @first: of this SyncManager */
static void map_add(struct ec_app *app, enum ec_app_dir dir, u32 first,
		    const struct ec_app_entry *e, u32 pos)
{
	u32 n = app->n_map[dir];
	struct ec_app_copy *c = app->map[dir] + n;

	/* whole bytes behind each other in both places are one run */
	if (n > first && !((c[-1].pos | c[-1].bits | e->bits) & 7) &&
	    c[-1].pos + c[-1].bits == pos &&
	    c[-1].off + c[-1].bits / 8 == e->off) {
		c[-1].bits += e->bits;
		return;
	}
	*c = (struct ec_app_copy){ .off = e->off, .pos = pos, .bits = e->bits };
	app->n_map[dir]++;
}

/* the @k-th SyncManager of a direction */
static bool build_area(struct ec_app *app, enum ec_app_dir dir, int k)
{
	const struct ec_app_model *m = app->model;
	const struct ec_app_object *assign = assignment(m, dir, k);
	u32 pos = 0, n = list_len(app, assign), first = app->n_map[dir];

	for (u32 i = 1; i <= n; i++) {
		u16 index = (u16)list_at(app, assign, i);
		const struct ec_app_object *pdo = ec_app_od_object(m, index);
		u32 entries = list_len(app, pdo);

		for (u32 j = 1; j <= entries; j++) {
			u32 v = list_at(app, pdo, j);
			const struct ec_app_entry *e;

			if (pos + (v & 0xFF) > m->max_bytes[dir] * 8u)
				return false;
			e = ec_app_od_entry(m, (u16)(v >> 16), (u8)(v >> 8));
			if (v >> 16 && e && app->n_map[dir] < m->map_cap[dir])
				map_add(app, dir, first, e, pos);
			pos += v & 0xFF;
		}
	}
	app->area_bytes[dir][k] = (u16)((pos + 7) / 8);
	return true;
}

static bool build(struct ec_app *app, enum ec_app_dir dir)
{
	bool ok = true;

	app->n_map[dir] = 0;
	app->bytes[dir] = 0;
	memset(app->area_bytes[dir], 0, sizeof(app->area_bytes[dir]));
	for (int k = 0; k < app->model->n_areas[dir]; k++) {
		ok = ok && build_area(app, dir, k);
		app->map_end[dir][k] = app->n_map[dir];
		app->bytes[dir] = (u16)(app->bytes[dir] + app->area_bytes[dir][k]);
	}
	if (!ok)
		app->bytes[dir] = 0;
	return ok;
}

/**
 * ec_app_pdo_build() - take the present assignment and mapping into use
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or the AL status code that says what does not fit.
 */
u16 ec_app_pdo_build(struct ec_app *app)
{
	const struct ec_app_profile *p = app->model->dev.profile;
	bool out, in;

	if (p && p->map)
		return p->map(app);
	if (app->n_map[EC_APP_OUT] + app->n_map[EC_APP_IN] &&
	    ec_app_bug(app, EC_SIM_BUG_PDO_FIXED))
		return 0;
	out = build(app, EC_APP_OUT);
	in = build(app, EC_APP_IN);
	if (!out)
		return 0x0025;	/* invalid output mapping */
	return in ? 0 : 0x0024;
}

static inline int sm_start(const struct ec_app *app, enum ec_app_dir dir, int k)
{
	const struct ec_esc_sm *sm = &app->esc->sm[app->model->area[dir][k]];

	return !app->bytes[dir] || !app->area_bytes[dir][k] || !sm->active ? -1 : sm->page.start;
}

/* the first run of the @k-th SyncManager */
static inline u32 map_begin(const struct ec_app *app, enum ec_app_dir dir, int k)
{
	return k ? app->map_end[dir][k - 1] : 0;
}

/* as ec_bits_copy(), without a call for the common sizes */
static void copy_run(u8 *dst, u32 dst_bit, const u8 *src, u32 src_bit, u32 bits)
{
	dst += dst_bit / 8;
	src += src_bit / 8;
	dst_bit &= 7;
	src_bit &= 7;
	if (bits == 1)
		*dst = (u8)((*dst & ~(1u << dst_bit)) | (*src >> src_bit & 1u) << dst_bit);
	else if (dst_bit | src_bit | (bits & 7) || bits > 64)
		ec_bits_copy(dst, dst_bit, src, src_bit, bits);
	else
		for (; bits; bits -= 8)
			*dst++ = *src++;
}

static inline void outputs_use(struct ec_app *app, int k, const u8 *image)
{
	for (u32 i = map_begin(app, EC_APP_OUT, k); i < app->map_end[EC_APP_OUT][k]; i++) {
		const struct ec_app_copy *c = &app->map[EC_APP_OUT][i];

		copy_run(app->data + c->off, 0, image, c->pos, c->bits);
	}
}

/**
 * ec_app_outputs_use() - outputs take effect, of a slave with one SyncManager for them
 * @app: slave
 * @image: their process image
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_outputs_use(struct ec_app *app, const u8 *image)
{
	outputs_use(app, 0, image);
}

/* the @k-th output SyncManager */
static inline void outputs(struct ec_app *app, int k, u64 now)
{
	int start = sm_start(app, EC_APP_OUT, k);
	u16 bytes = app->area_bytes[EC_APP_OUT][k];
	const u8 *src;

	if (start < 0)
		return;
	src = ec_esc_pdi_take(app->esc, app->model->area[EC_APP_OUT][k], bytes, now);
	if (!src) {
		if (ec_esc_pdi_read(app->esc, (u16)start, app->image, bytes, now) < 0)
			return;
		src = app->image;
	}
	app->outputs_seen |= (u16)BIT(k);
	if (ec_app_state(app) != EC_AL_OP &&
	    !ec_app_bug(app, EC_SIM_BUG_OUTPUTS_EARLY))
		return;
	outputs_use(app, k, src);
}

/**
 * ec_app_outputs() - the master wrote an output SyncManager
 * @app: slave
 * @sm: which, -1: all are looked at
 * @now: time, ns
 *
 * Outside OP the buffer is fetched, its content is not used.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_outputs(struct ec_app *app, int sm, u64 now)
{
	for (int k = 0; k < app->model->n_areas[EC_APP_OUT]; k++)
		if (sm < 0 || app->model->area[EC_APP_OUT][k] == sm)
			outputs(app, k, now);
}

/**
 * ec_app_outputs_complete() - did outputs come in all SyncManagers since SAFEOP?
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether they did; true where there are none.
 */
bool ec_app_outputs_complete(const struct ec_app *app)
{
	for (int k = 0; k < app->model->n_areas[EC_APP_OUT]; k++)
		if (app->area_bytes[EC_APP_OUT][k] && !(app->outputs_seen & BIT(k)))
			return false;
	return true;
}

/**
 * ec_app_outputs_clear() - outputs go to their safe state: all 0
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_outputs_clear(struct ec_app *app)
{
	for (u32 i = 0; i < app->n_map[EC_APP_OUT]; i++) {
		const struct ec_app_copy *c = &app->map[EC_APP_OUT][i];

		memset(app->data + c->off, 0, (c->bits + 7) / 8);
	}
}

/*
 * Digital terminals map their outputs to registers (0x0F00), where no buffer
 * changes hands: what is there is what is at the terminals.
 */
static void outputs_direct(struct ec_app *app)
{
	const struct ec_app_model *m = app->model;

	for (int k = 0; k < m->n_areas[EC_APP_OUT]; k++) {
		u32 start = m->dev.sms[m->area[EC_APP_OUT][k]].start;
		u32 i = map_begin(app, EC_APP_OUT, k);

		for (; start < EC_REG_RAM && i < app->map_end[EC_APP_OUT][k]; i++) {
			const struct ec_app_copy *c = &app->map[EC_APP_OUT][i];

			if (start * 8 + c->pos + c->bits <= EC_REG_RAM * 8)
				ec_bits_copy(app->data + c->off, 0, app->esc->mem,
					     start * 8 + c->pos, c->bits);
		}
	}
}

/**
 * ec_app_channel() - value of a channel
 * @app: slave
 * @dir: outputs or inputs
 * @chan: channel from 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the value, 0 where there is no such channel and for outputs which
 * are off.
 */
s64 ec_app_channel(struct ec_app *app, enum ec_app_dir dir, u16 chan)
{
	const struct ec_app_model *m = app->model;

	if (chan >= m->n_chan[dir])
		return 0;
	ec_esc_settle(app->esc);
	if (dir == EC_APP_OUT &&
	    (!app->esc->powered || ec_app_state(app) != EC_AL_OP))
		return 0;
	if (dir == EC_APP_OUT)
		outputs_direct(app);
	return ec_app_od_get_signed(app, m->chan[dir][chan]);
}

/**
 * ec_app_run() - compute the inputs of a slave
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_run(struct ec_app *app, u64 now)
{
	const struct ec_app_model *m = app->model;

	for (u32 i = 0; app->n_src && i < m->n_chan[EC_APP_IN]; i++)
		if (app->src[i].kind != EC_APP_SRC_NONE)
			ec_app_od_set(app, m->chan[EC_APP_IN][i],
				      (u64)ec_app_source_value(&app->src[i], now));
	if (m->dev.profile && m->dev.profile->run)
		m->dev.profile->run(app, now);
	app->esc->late.ran_ns = now;
}

/* process image of the @k-th input SyncManager */
static inline void build_inputs(const struct ec_app *app, int k, u8 *dst)
{
	memset(dst, 0, app->area_bytes[EC_APP_IN][k]);
	for (u32 i = map_begin(app, EC_APP_IN, k); i < app->map_end[EC_APP_IN][k]; i++) {
		const struct ec_app_copy *c = &app->map[EC_APP_IN][i];

		copy_run(dst, c->pos, app->data + c->off, 0, c->bits);
	}
}

/* hands them over */
static inline void give_inputs(struct ec_app *app, int k, u64 now)
{
	int start = sm_start(app, EC_APP_IN, k);
	u16 bytes = app->area_bytes[EC_APP_IN][k];
	u8 *dst;

	if (start < 0)
		return;
	dst = ec_esc_pdi_give(app->esc, app->model->area[EC_APP_IN][k], bytes, now);
	build_inputs(app, k, dst ? dst : app->image);
	if (!dst)
		ec_esc_pdi_write(app->esc, (u16)start, app->image, bytes, now);
}

/**
 * ec_app_inputs() - compute the inputs and hand them to the SyncManagers
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_inputs(struct ec_app *app, u64 now)
{
	ec_app_run(app, now);
	for (int k = 0; k < app->model->n_areas[EC_APP_IN]; k++)
		give_inputs(app, k, now);
}

/* the SyncManager of a direction that has at most one */
static int only(const struct ec_app_model *m, enum ec_app_dir dir)
{
	return m->n_areas[dir] ? m->area[dir][0] : -1;
}

/**
 * ec_app_may_wait() - process data were handled; must the next be reported at once?
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_may_wait(struct ec_app *app)
{
	const struct ec_app_model *m = app->model;

	if (m->n_areas[EC_APP_OUT] > 1 || m->n_areas[EC_APP_IN] > 1)
		return;
	if (m->dev.profile || app->n_src || app->is_source || app->al_to ||
	    ec_app_state(app) != EC_AL_OP)
		return;
	if (ec_esc_pdi_may_wait(app->esc, only(m, EC_APP_OUT), app->bytes[EC_APP_OUT],
				only(m, EC_APP_IN), app->bytes[EC_APP_IN], app->inputs) &&
	    m->n_areas[EC_APP_IN])
		build_inputs(app, 0, app->inputs);
}

/**
 * ec_app_set_source() - where the value of an input comes from
 * @app: slave
 * @chan: input channel, from 0
 * @src: source; copied
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_set_source(struct ec_app *app, u16 chan, const struct ec_app_source *src)
{
	ec_esc_settle(app->esc);
	app->n_src = (u16)(app->n_src + (src->kind != EC_APP_SRC_NONE) -
			   (app->src[chan].kind != EC_APP_SRC_NONE));
	app->src[chan] = *src;
	if (src->kind == EC_APP_SRC_LINK) {
		ec_esc_settle(src->from->esc);
		src->from->is_source = true;
	}
}
