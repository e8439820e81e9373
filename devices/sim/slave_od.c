// SPDX-License-Identifier: GPL-2.0-only
/* Object dictionary of a simulated slave: values and what SDOs do to them. */
#include "app.h"

/**
 * ec_app_od_object() - find an object
 * @m: dictionary
 * @index: its number
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the object, or NULL.
 */
const struct ec_app_object *ec_app_od_object(const struct ec_app_model *m,
					     u16 index)
{
	u32 lo = 0, hi = m->n_objects;

	while (lo < hi) {
		u32 mid = (lo + hi) / 2;

		if (m->objects[mid].index < index)
			lo = mid + 1;
		else
			hi = mid;
	}
	return lo < m->n_objects && m->objects[lo].index == index ?
		&m->objects[lo] : NULL;
}

static const struct ec_app_entry *entry_of(const struct ec_app_model *m,
					   const struct ec_app_object *o,
					   u8 sub)
{
	for (u32 i = 0; i < o->count; i++)
		if (m->entries[o->first + i].sub == sub)
			return &m->entries[o->first + i];
	return NULL;
}

/**
 * ec_app_od_entry() - find an entry
 * @m: dictionary
 * @index: its object
 * @sub: its subindex
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the entry, or NULL.
 */
const struct ec_app_entry *ec_app_od_entry(const struct ec_app_model *m,
					   u16 index, u8 sub)
{
	const struct ec_app_object *o = ec_app_od_object(m, index);

	return o ? entry_of(m, o, sub) : NULL;
}

/**
 * ec_app_od_get() - value of an entry
 * @app: slave
 * @e: entry; NULL gives 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the lower 64 bits of the value.
 */
u64 ec_app_od_get(const struct ec_app *app, const struct ec_app_entry *e)
{
	u64 v = 0;

	if (!e)
		return 0;
	for (u32 i = 0; i < 8 && i * 8 < e->bits; i++)
		v |= (u64)app->data[e->off + i] << (8 * i);
	return e->bits < 64 ? v & ((1ULL << e->bits) - 1) : v;
}

/**
 * ec_app_od_get_signed() - value of an entry as its data type says
 * @app: slave
 * @e: entry; NULL gives 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the value, with its sign where the type has one.
 */
s64 ec_app_od_get_signed(const struct ec_app *app, const struct ec_app_entry *e)
{
	u64 v = ec_app_od_get(app, e);

	if (!e || !e->bits || e->bits >= 64)
		return (s64)v;
	switch (e->type) {
	case EC_TYPE_INT8:
	case EC_TYPE_INT16:
	case EC_TYPE_INT32:
		if (v >> (e->bits - 1) & 1)
			v |= ~0ULL << e->bits;
		break;
	default:
		break;
	}
	return (s64)v;
}

/**
 * ec_app_od_set() - change the value of an entry, as the slave itself does
 * @app: slave
 * @e: entry; nothing happens with NULL
 * @value: new value, cut to the size of the entry
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_od_set(struct ec_app *app, const struct ec_app_entry *e, u64 value)
{
	if (!e)
		return;
	if (e->bits < 64)
		value &= (1ULL << e->bits) - 1;
	for (u32 i = 0; i * 8 < e->bits; i++)
		app->data[e->off + i] = i < 8 ? (u8)(value >> (8 * i)) : 0;
}

/* access bits of the present state; INIT and BOOT have no SDOs */
static u16 state_bits(const struct ec_app *app, u16 preop_bit)
{
	switch (ec_app_state(app)) {
	case EC_AL_PREOP:
		return preop_bit;
	case EC_AL_SAFEOP:
		return (u16)(preop_bit << 1);
	case EC_AL_OP:
		return (u16)(preop_bit << 2);
	default:
		return 0;
	}
}

static u32 may_read(const struct ec_app *app, const struct ec_app_entry *e)
{
	if (!(e->access & EC_OD_READ))
		return EC_ABORT_WRITE_ONLY;
	return e->access & state_bits(app, EC_OD_READ_PREOP) ? 0 : EC_ABORT_STATE;
}

static u32 may_write(const struct ec_app *app, const struct ec_app_entry *e)
{
	if (!(e->access & EC_OD_WRITE))
		return EC_ABORT_READ_ONLY;
	return e->access & state_bits(app, EC_OD_WRITE_PREOP) ? 0 : EC_ABORT_STATE;
}

static bool is_text(const struct ec_app_entry *e)
{
	return e->type == EC_TYPE_STRING || e->type == EC_TYPE_OCTET_STRING ||
	       e->type == EC_TYPE_UNICODE_STRING;
}

/* How many entries an object has at present: sub 0 of lists changes. */
static u8 object_count(const struct ec_app *app, const struct ec_app_object *o)
{
	const struct ec_app_entry *e = &app->model->entries[o->first];

	if (o->code == EC_OD_VAR || !ec_app_pdo_is_config(o->index))
		return o->max_sub;
	return (u8)ec_app_od_get(app, e);
}

static u32 read_complete(struct ec_app *app, const struct ec_app_object *o,
			 u8 sub, u8 *buf, size_t cap, size_t *len)
{
	const struct ec_app_model *m = app->model;
	u8 count = object_count(app, o);
	size_t pos = 0;
	u32 ret;

	if (o->code == EC_OD_VAR || sub > 1)
		return EC_ABORT_ACCESS;
	memset(buf, 0, cap);
	for (u32 i = 0; i < o->count; i++) {
		const struct ec_app_entry *e = &m->entries[o->first + i];

		if (e->sub < sub || e->sub > count)
			continue;
		ret = may_read(app, e);
		if (ret)
			return ret;
		/* whole bytes start at a byte; sub 0 takes two of them */
		if (e->bits >= 8)
			pos = (pos + 7) & ~(size_t)7;
		if (pos + max_t(size_t, e->bits, e->sub ? 0 : 16) > cap * 8)
			return EC_ABORT_TOO_LONG_MBOX;
		ec_bits_copy(buf, (u32)pos, app->data + e->off, 0, e->bits);
		pos += e->sub ? e->bits : 16;
	}
	*len = (pos + 7) / 8;
	return 0;
}

/**
 * ec_app_od_read() - upload, the read operation of the SDO server
 * @app: slave
 * @index: object
 * @sub: subindex
 * @complete: complete access
 * @buf: where the data go
 * @cap: bytes at @buf
 * @len: bytes written
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or an abort code.
 */
u32 ec_app_od_read(struct ec_app *app, u16 index, u8 sub, bool complete,
		   u8 *buf, size_t cap, size_t *len)
{
	const struct ec_app_object *o = ec_app_od_object(app->model, index);
	const struct ec_app_entry *e;
	u32 ret;

	if (!o)
		return EC_ABORT_NO_OBJECT;
	if (complete)
		return read_complete(app, o, sub, buf, cap, len);
	e = entry_of(app->model, o, sub);
	if (!e)
		return EC_ABORT_NO_SUB;
	ret = may_read(app, e);
	if (ret)
		return ret;
	*len = (e->bits + 7) / 8;
	if (*len > cap)
		return EC_ABORT_TOO_LONG_MBOX;
	memcpy(buf, app->data + e->off, *len);
	return 0;
}

static u32 write_entry(struct ec_app *app, const struct ec_app_entry *e,
		       const u8 *buf, size_t len)
{
	size_t want = (e->bits + 7) / 8;
	u64 v = 0;
	u32 ret;

	ret = may_write(app, e);
	if (ret)
		return ret;
	if (len > want)
		return EC_ABORT_TOO_LONG;
	if (len < want && !is_text(e))
		return EC_ABORT_TOO_SHORT;
	if (e->bits <= 64 && !is_text(e)) {
		for (size_t i = 0; i < len; i++)
			v |= (u64)buf[i] << (8 * i);
		if (e->bits & 7 && v >> e->bits)
			return EC_ABORT_TOO_HIGH;
		ret = ec_app_pdo_check_write(app, e, v);
		if (ret)
			return ret;
	}
	memset(app->data + e->off, 0, want);
	if (len)
		memcpy(app->data + e->off, buf, len);
	return 0;
}

/*
 * Lists of the process data in one go: all checks on the new content, the old
 * one comes back if any of them fails.
 */
static u32 write_list(struct ec_app *app, const struct ec_app_object *o,
		      const u8 *buf, size_t len)
{
	const struct ec_app_entry *e = &app->model->entries[o->first];
	size_t step = o->count > 1 ? e[1].bits / 8u : 1, n;
	const struct ec_app_entry *last = &e[o->count - 1];
	u32 from = e->off, bytes = last->off + last->bits / 8u - e->off;
	u8 *old = app->sdo_buf + EC_APP_SDO_BUF;	/* second half */
	u32 ret;

	if (len < 2 || (len - 2) % step)
		return EC_ABORT_LENGTH;
	n = (len - 2) / step;
	if (buf[0] > o->max_sub)
		return EC_ABORT_TOO_HIGH;
	if (n < buf[0])
		return EC_ABORT_TOO_SHORT;
	if (n > o->max_sub)
		return EC_ABORT_TOO_LONG;
	ret = may_write(app, e);
	if (ret)
		return ret;
	memcpy(old, app->data + from, bytes);
	ec_app_od_set(app, e, 0);
	for (u32 i = 0; i < buf[0] && !ret; i++)
		ret = write_entry(app, &e[i + 1], buf + 2 + i * step, step);
	if (!ret)
		ret = write_entry(app, e, buf, 1);
	if (ret)
		memcpy(app->data + from, old, bytes);
	return ret;
}

static u32 write_complete(struct ec_app *app, const struct ec_app_object *o,
			  u8 sub, const u8 *buf, size_t len)
{
	const struct ec_app_model *m = app->model;
	size_t pos = 0;
	u32 ret;

	if (o->code == EC_OD_VAR || sub > 1)
		return EC_ABORT_ACCESS;
	if (ec_app_pdo_is_config(o->index))
		return sub ? EC_ABORT_ACCESS : write_list(app, o, buf, len);
	for (int pass = 0; pass < 2; pass++, pos = 0) {
		for (u32 i = 0; i < o->count; i++) {
			const struct ec_app_entry *e = &m->entries[o->first + i];

			if (e->sub < sub)
				continue;
			if (e->bits >= 8)
				pos = (pos + 7) & ~(size_t)7;
			if (pos >= len * 8)
				break;		/* a shorter record is legal */
			if (pos + e->bits > len * 8)
				return EC_ABORT_TOO_SHORT;
			ret = e->sub ? may_write(app, e) : 0;
			if (ret && !pass)
				return ret;
			if (pass && e->sub) {
				memset(app->data + e->off, 0,
				       (e->bits + 7) / 8);
				ec_bits_copy(app->data + e->off, 0, buf,
					     (u32)pos, e->bits);
			}
			pos += e->sub ? e->bits : 16;
		}
		if (len > (pos + 7) / 8)
			return EC_ABORT_TOO_LONG;
	}
	return 0;
}

/**
 * ec_app_od_write() - download, the write operation of the SDO server
 * @app: slave
 * @index: object
 * @sub: subindex
 * @complete: complete access
 * @buf: data
 * @len: bytes at @buf
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or an abort code.
 */
u32 ec_app_od_write(struct ec_app *app, u16 index, u8 sub, bool complete,
		    const u8 *buf, size_t len)
{
	const struct ec_app_object *o = ec_app_od_object(app->model, index);
	const struct ec_app_entry *e;

	if (!o)
		return EC_ABORT_NO_OBJECT;
	if (complete)
		return write_complete(app, o, sub, buf, len);
	e = entry_of(app->model, o, sub);
	if (!e)
		return EC_ABORT_NO_SUB;
	return write_entry(app, e, buf, len);
}

/**
 * ec_app_od_in_list() - is an object in one of the lists of SDO information
 * @m: dictionary
 * @o: object
 * @list: EC_SDOINFO_ALL...
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_app_od_in_list(const struct ec_app_model *m,
		       const struct ec_app_object *o, u16 list)
{
	u16 access = 0;

	for (u32 i = 0; i < o->count; i++)
		access |= m->entries[o->first + i].access;
	switch (list) {
	case EC_SDOINFO_ALL:
		return true;
	case EC_SDOINFO_RXPDO:
		return access & EC_OD_RXPDO;
	case EC_SDOINFO_TXPDO:
		return access & EC_OD_TXPDO;
	case EC_SDOINFO_BACKUP:
		return access & EC_OD_BACKUP;
	case EC_SDOINFO_SETTINGS:
		return access & EC_OD_SETTINGS;
	default:
		return false;
	}
}

/**
 * ec_app_od_name() - text of an entry
 * @m: dictionary
 * @e: entry
 * @buf: room for a text made from the subindex
 * @name: where the text is, not terminated
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of the text.
 */
size_t ec_app_od_name(const struct ec_app_model *m,
		      const struct ec_app_entry *e, char buf[24],
		      const char **name)
{
	const struct ec_app_object *o;

	*name = e->name;
	if (!e->name && !e->sub) {
		o = ec_app_od_object(m, e->index);
		if (o && o->code == EC_OD_VAR)
			*name = o->name;
	}
	if (*name)
		return strlen(*name);
	memcpy(buf, "SubIndex 000", 12);
	buf[9] = (char)('0' + e->sub / 100);
	buf[10] = (char)('0' + e->sub / 10 % 10);
	buf[11] = (char)('0' + e->sub % 10);
	*name = buf;
	return 12;
}
