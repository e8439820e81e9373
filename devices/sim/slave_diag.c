// SPDX-License-Identifier: GPL-2.0-only
/*
 * Diagnosis history of a simulated slave, object 0x10F3 (ETG.1020), in the mode that overwrites the
 * oldest message. All messages have one size; those without parameters end in zeros.
 */
#include "app.h"

#define TEXT_POWER_ON	0x0001
#define TEXT_AL		0x0010	/* AL status code, state, name of the slave */
#define TEXT_EMERGENCY	0x0020	/* error code, error register, name of the slave */

#define NAME_BYTES	8
#define LOCAL_TIME	0x0010	/* flag: the time is not that of distributed clocks */

static const struct ec_app_entry *sub(const struct ec_app *app, u8 s)
{
	return ec_app_od_entry(app->model, EC_DIAG_INDEX, s);
}

/* a slave without CoE has none, whatever its description says */
static bool has(const struct ec_app *app)
{
	return app->model->params.diag && sub(app, EC_DIAG_SUB_MAX);
}

static u8 last_sub(const struct ec_app *app)
{
	return (u8)(EC_DIAG_FIRST_SUB - 1 + app->model->params.diag);
}

static void put_name(struct ec_wbuf *w, const char *name)
{
	char field[NAME_BYTES] = { 0 };

	memcpy(field, name, min(strlen(name), sizeof(field)));
	ec_wbuf_le16(w, EC_DIAG_ASCII << 12 | NAME_BYTES);
	ec_wbuf_bytes(w, field, sizeof(field));
}

static void show_new(struct ec_app *app)
{
	u64 newest = ec_app_od_get(app, sub(app, EC_DIAG_SUB_NEWEST));

	ec_app_od_set(app, sub(app, 4),
		      newest != ec_app_od_get(app, sub(app, EC_DIAG_SUB_ACK)));
}

static void add(struct ec_app *app, u16 severity, u16 text, u16 code, u8 more, u64 now)
{
	const struct ec_app_entry *newest = sub(app, EC_DIAG_SUB_NEWEST);
	u8 at = (u8)ec_app_od_get(app, newest);
	bool params = text != TEXT_POWER_ON;
	struct ec_wbuf w;

	at = at < EC_DIAG_FIRST_SUB || at >= last_sub(app) ? EC_DIAG_FIRST_SUB : at + 1;
	w = ec_wbuf(app->data + sub(app, at)->off, EC_APP_DIAG_BYTES);
	memset(w.p, 0, EC_APP_DIAG_BYTES);
	ec_wbuf_le32(&w, text == TEXT_EMERGENCY ? (u32)code << 16 | 0xE800 : 0xE000u | text);
	ec_wbuf_le16(&w, (u16)(severity | LOCAL_TIME | (params ? 3 << 8 : 0)));
	ec_wbuf_le16(&w, text);
	ec_wbuf_le32(&w, (u32)now);
	ec_wbuf_le32(&w, (u32)(now >> 32));
	if (params) {
		ec_wbuf_le16(&w, EC_TYPE_UINT16);
		ec_wbuf_le16(&w, code);
		ec_wbuf_le16(&w, EC_TYPE_UINT8);
		ec_wbuf_u8(&w, more);
		put_name(&w, app->name);
	}
	ec_app_od_set(app, newest, at);
	show_new(app);
}

/**
 * ec_app_diag_reset() - begin a history at power-on
 * @app: slave
 * @now: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_diag_reset(struct ec_app *app, u64 now)
{
	if (has(app))
		add(app, EC_DIAG_INFO, TEXT_POWER_ON, 0, 0, now);
}

/**
 * ec_app_diag_al() - add a message about an error of the AL state
 * @app: slave
 * @code: AL status code
 * @now: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_diag_al(struct ec_app *app, u16 code, u64 now)
{
	if (has(app))
		add(app, EC_DIAG_ERROR, TEXT_AL, code, app->state, now);
}

/**
 * ec_app_diag_emergency() - add a message about an emergency
 * @app: slave
 * @code: its error code
 * @reg: its error register
 * @now: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_diag_emergency(struct ec_app *app, u16 code, u8 reg, u64 now)
{
	if (has(app))
		add(app, EC_DIAG_WARNING, TEXT_EMERGENCY, code, reg, now);
}

/**
 * ec_app_diag_write() - take a write of the newest acknowledged message
 * @app: slave with a history
 * @data: value
 * @len: bytes at @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or an abort code.
 */
u32 ec_app_diag_write(struct ec_app *app, const u8 *data, size_t len)
{
	u8 newest = (u8)ec_app_od_get(app, sub(app, EC_DIAG_SUB_NEWEST));

	if (len != 1)
		return len ? EC_ABORT_TOO_LONG : EC_ABORT_TOO_SHORT;
	if (data[0] && data[0] < EC_DIAG_FIRST_SUB)
		return EC_ABORT_TOO_LOW;
	if (data[0] > last_sub(app) || (data[0] && !newest))
		return EC_ABORT_TOO_HIGH;
	for (u8 s = EC_DIAG_FIRST_SUB; !data[0] && s <= last_sub(app); s++)
		memset(app->data + sub(app, s)->off, 0, EC_APP_DIAG_BYTES);
	if (!data[0])
		ec_app_od_set(app, sub(app, EC_DIAG_SUB_NEWEST), 0);
	ec_app_od_set(app, sub(app, EC_DIAG_SUB_ACK), data[0]);
	show_new(app);
	return 0;
}
