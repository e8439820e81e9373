// SPDX-License-Identifier: GPL-2.0-only
/* IDNs of a simulated SERCOS drive: what they are, and their values in memory. */
#include "app.h"

#define RO_RUNNING	(EC_SOE_ATTR_RO_SAFEOP | EC_SOE_ATTR_RO_OP)
#define COMMAND		(EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_COMMAND)
#define LIST		(EC_SOE_ATTR_LIST2 | EC_SOE_ATTR_RO)

static const struct ec_app_idn idns[] = {
	{ 1, EC_SOE_ATTR_LEN2 | RO_RUNNING, "NC cycle time (TNcyc)", "us", 2000, 0, 0, 0, NULL },
	{ 2, EC_SOE_ATTR_LEN2 | RO_RUNNING, "Communication cycle time (tScyc)", "us",
	  2000, 0, 0, 0, NULL },
	{ 11, EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_RO, "Class 1 diagnostic (C1D)", NULL, 0, 0, 0, 0,
	  NULL },
	{ 15, EC_SOE_ATTR_LEN2 | RO_RUNNING, "Telegram type", NULL, 7, 0, 7, 0, NULL },
	{ 16, EC_SOE_ATTR_LIST2 | RO_RUNNING, "Configuration list of AT", NULL,
	  0, 0, 0, 2 * EC_APP_SOE_MAP, NULL },
	{ 17, LIST, "IDN list of all operation data", NULL, 0, 0, 0, 0, NULL },
	{ 24, EC_SOE_ATTR_LIST2 | RO_RUNNING, "Configuration list of MDT", NULL,
	  0, 0, 0, 2 * EC_APP_SOE_MAP, NULL },
	{ 25, LIST, "IDN list of all procedure commands", NULL, 0, 0, 0, 0, NULL },
	{ 30, EC_SOE_ATTR_LIST1 | EC_SOE_ATTR_RO, "Manufacturer version", NULL,
	  0, 0, 0, 16, "SIM 1.0" },
	{ 32, EC_SOE_ATTR_LEN2 | RO_RUNNING, "Primary operation mode", NULL, 0, 0, 0, 0, NULL },
	{ 36, EC_SOE_ATTR_LEN4, "Velocity command value", "inc/s", 0, 0, 0, 0, NULL },
	{ 40, EC_SOE_ATTR_LEN4 | EC_SOE_ATTR_RO, "Velocity feedback value 1", "inc/s",
	  0, 0, 0, 0, NULL },
	{ 47, EC_SOE_ATTR_LEN4, "Position command value", "inc", 0, 0, 0, 0, NULL },
	{ 51, EC_SOE_ATTR_LEN4 | EC_SOE_ATTR_RO, "Position feedback 1 value", "inc",
	  0, 0, 0, 0, NULL },
	{ 91, EC_SOE_ATTR_LEN4, "Bipolar velocity limit value", "rpm", 3000, 10, 6000, 0, NULL },
	{ 95, EC_SOE_ATTR_LIST1 | EC_SOE_ATTR_RO, "Diagnostic message", NULL,
	  0, 0, 0, 32, EC_APP_SOE_NO_ERROR },
	{ 99, COMMAND, "Reset class 1 diagnostic", NULL, 0, 0, 0, 0, NULL },
	{ 134, EC_SOE_ATTR_LEN2, "Master control word", NULL, 0, 0, 0, 0, NULL },
	{ 135, EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_RO, "Drive status word", NULL, 0, 0, 0, 0, NULL },
	{ 148, COMMAND, "Drive-controlled homing procedure command", NULL, 0, 0, 0, 0, NULL },
	{ 187, LIST, "IDN list of configurable data in the AT", NULL, 0, 0, 0, 0, NULL },
	{ 188, LIST, "IDN list of configurable data in the MDT", NULL, 0, 0, 0, 0, NULL },
	{ 390, EC_SOE_ATTR_LEN4 | EC_SOE_ATTR_RO, "Diagnostic number", NULL, 0, 0, 0, 0, NULL },
	{ 0x8096, EC_SOE_ATTR_LEN2, "Test word", NULL, 0x1234, 0, 0, 0, NULL },
	{ 0x80A0, EC_SOE_ATTR_LIST1, "Test text", NULL, 0, 0, 0, 200, "hello" },
	{ 0x80A1, EC_SOE_ATTR_LEN8, "Test quad word", NULL,
	  0x1122334455667788, 0, 0, 0, NULL },
	{ 0x80A3, EC_SOE_ATTR_LIST4, "Test list", NULL, 0, 0, 0, EC_APP_SOE_LIST, NULL },
	{ 0x80AA, EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_RO_PREOP, "Not writable in PREOP", NULL,
	  5, 0, 0, 0, NULL },
	{ 0x80AB, COMMAND, "Command that fails", NULL, 0, 0, 0, 0, NULL },
};

/* what may be in a telegram, besides the control and the status word */
static const u16 inputs[] = { 40, 51 };
static const u16 outputs[] = { 36, 47 };

/**
 * ec_app_idn() - find an IDN
 * @idn: number
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what it is, NULL: there is none.
 */
const struct ec_app_idn *ec_app_idn(u16 idn)
{
	for (u32 i = 0; i < ARRAY_SIZE(idns); i++)
		if (idns[i].idn == idn)
			return &idns[i];
	return NULL;
}

/**
 * ec_app_idn_bytes() - bytes of a value that is no list
 * @i: IDN
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes.
 */
u16 ec_app_idn_bytes(const struct ec_app_idn *i)
{
	return (u16)(1u << (i->attribute >> 16 & 3));
}

/**
 * ec_app_idn_is_list() - is the value a list?
 * @i: IDN
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_app_idn_is_list(const struct ec_app_idn *i)
{
	return i->attribute & EC_SOE_ATTR_LIST;
}

/**
 * ec_app_idn_room() - largest value
 * @i: IDN
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes.
 */
u16 ec_app_idn_room(const struct ec_app_idn *i)
{
	return ec_app_idn_is_list(i) ? (u16)(EC_SOE_LIST_HDR + i->room) : ec_app_idn_bytes(i);
}

static size_t drive_bytes(void)
{
	size_t n = 0;

	for (u32 i = 0; i < ARRAY_SIZE(idns); i++)
		n += ec_app_idn_room(&idns[i]);
	return n;
}

/**
 * ec_app_soe_bytes() - memory the values of a slave need, and a buffer for fragments
 * @drives: of the slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes.
 */
size_t ec_app_soe_bytes(u8 drives)
{
	return drives ? drives * drive_bytes() + EC_APP_SOE_BUF : 0;
}

/**
 * ec_app_idn_value() - where the value of an IDN is
 * @app: slave
 * @drive: one that it has
 * @which: IDN
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: place.
 */
u8 *ec_app_idn_value(const struct ec_app *app, u8 drive, const struct ec_app_idn *which)
{
	u8 *p = app->soe.values + drive * drive_bytes();

	for (const struct ec_app_idn *i = idns; i < which; i++)
		p += ec_app_idn_room(i);
	return p;
}

static void put_list(struct ec_wbuf *w, const void *data, u16 len, u16 most)
{
	ec_wbuf_le16(w, len);
	ec_wbuf_le16(w, most);
	ec_wbuf_bytes(w, data, len);
}

/**
 * ec_app_idn_put_text() - write a text as drives send it
 * @w: cursor
 * @text: it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_idn_put_text(struct ec_wbuf *w, const char *text)
{
	put_list(w, text, (u16)strlen(text), (u16)strlen(text));
}

/**
 * ec_app_idn_put_number() - write a number of the size of a value
 * @w: cursor
 * @i: IDN that is no list
 * @v: number
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_idn_put_number(struct ec_wbuf *w, const struct ec_app_idn *i, u64 v)
{
	u8 b[8];

	put_unaligned_le64(v, b);
	ec_wbuf_bytes(w, b, ec_app_idn_bytes(i));
}

/**
 * ec_app_idn_set_text() - change a value that is a text
 * @app: slave
 * @drive: one that it has
 * @i: IDN whose value is a text
 * @text: at most as long as it allows
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_idn_set_text(const struct ec_app *app, u8 drive, const struct ec_app_idn *i,
			 const char *text)
{
	struct ec_wbuf w = ec_wbuf(ec_app_idn_value(app, drive, i), ec_app_idn_room(i));

	put_list(&w, text, (u16)strlen(text), i->room);
}

/**
 * ec_app_soe_reset() - values as at power-on
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_reset(struct ec_app *app)
{
	for (u8 d = 0; d < app->soe.drives; d++) {
		for (u32 k = 0; k < ARRAY_SIZE(idns); k++) {
			const struct ec_app_idn *i = &idns[k];
			struct ec_wbuf w = ec_wbuf(ec_app_idn_value(app, d, i),
						   ec_app_idn_room(i));

			if (ec_app_idn_is_list(i))
				ec_app_idn_set_text(app, d, i, i->text ? i->text : "");
			else
				ec_app_idn_put_number(&w, i, i->value);
		}
	}
	app->soe.buf = app->soe.values + app->soe.drives * drive_bytes();
	app->soe.writes = 0;
	ec_app_soe_restart(app);
}

/* one of the lists that the drive makes of its IDNs; bytes of it, without @w only those */
static u16 made_list(struct ec_wbuf *w, u16 list)
{
	const u16 *some = list == 187 ? inputs : outputs;
	u16 n = 0;

	if (list == 187 || list == 188) {
		for (u32 k = 0; k < ARRAY_SIZE(inputs); k++, n = (u16)(n + 2))
			if (w)
				ec_wbuf_le16(w, some[k]);
		return n;
	}
	for (u32 k = 0; k < ARRAY_SIZE(idns); k++) {
		if (list == 25 && !(idns[k].attribute & EC_SOE_ATTR_COMMAND))
			continue;
		if (w)
			ec_wbuf_le16(w, idns[k].idn);
		n = (u16)(n + 2);
	}
	return n;
}

/**
 * ec_app_idn_put_value() - write the value of an IDN
 * @w: cursor
 * @app: slave
 * @drive: one that it has
 * @i: IDN
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_idn_put_value(struct ec_wbuf *w, const struct ec_app *app, u8 drive,
			  const struct ec_app_idn *i)
{
	const u8 *p = ec_app_idn_value(app, drive, i);
	u16 len;

	if (ec_app_idn_is_list(i) && !i->room) {
		len = made_list(NULL, i->idn);
		ec_wbuf_le16(w, len);
		ec_wbuf_le16(w, len);
		made_list(w, i->idn);
	} else if (ec_app_idn_is_list(i)) {
		ec_wbuf_bytes(w, p, (size_t)EC_SOE_LIST_HDR + get_unaligned_le16(p));
	} else {
		ec_wbuf_bytes(w, p, ec_app_idn_bytes(i));
	}
}

/**
 * ec_app_idn_is_mappable() - may an IDN be in a telegram?
 * @dir: outputs (MDT) or inputs (AT)
 * @idn: number
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it may.
 */
bool ec_app_idn_is_mappable(enum ec_app_dir dir, u16 idn)
{
	const u16 *list = dir == EC_APP_OUT ? outputs : inputs;

	return list[0] == idn || list[1] == idn;
}
