// SPDX-License-Identifier: GPL-2.0-only
/*
 * A CPU that stands in for the EEPROM: it has the contents in a memory of its
 * own and answers the commands of the master through the PDI.
 */
#include "app.h"

/**
 * ec_app_memory_command() - the master gave a command
 * @app: slave
 * @now: time, ns
 *
 * The answer takes as long as that of an EEPROM.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_memory_command(struct ec_app *app, u64 now)
{
	const struct ec_esc *esc = app->esc;

	app->eep_due = now + (esc->eep.cmd == EC_EEP_CMD_WRITE ?
			      esc->cfg.eeprom_write_ns :
			      esc->cfg.eeprom_busy_ns);
}

static void read_words(struct ec_app *app, size_t at, size_t n, u64 now)
{
	const struct ec_esc_eeprom *e = &app->esc->eep;
	u8 buf[8];
	size_t i;

	for (i = 0; i < n; i++)
		buf[i] = at + i < e->len ? e->data[at + i] : 0xff;
	ec_esc_pdi_write(app->esc, EC_REG_EEP_DATA, buf, n, now);
}

static u16 write_word(struct ec_app *app, size_t at, u64 now)
{
	struct ec_esc_eeprom *e = &app->esc->eep;
	u8 buf[2];

	if (at + 2 > e->len ||
	    ec_esc_pdi_read(app->esc, EC_REG_EEP_DATA, buf, 2, now))
		return EC_EEP_ERR_ACK;
	memcpy(e->data + at, buf, 2);
	return 0;
}

/**
 * ec_app_memory_poll() - answer the command when its time has come
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_memory_poll(struct ec_app *app, u64 now)
{
	u16 control, error = 0;
	u8 v[6];
	size_t at;

	if (app->eep_due > now)
		return;
	if (app->esc->fault.eeprom_busy) {
		app->eep_due = now + 1000000;
		return;
	}
	app->eep_due = EC_ESC_NEVER;
	ec_esc_pdi_read(app->esc, EC_REG_EEP_CONTROL, v, sizeof(v), now);
	control = get_unaligned_le16(v);
	at = 2 * (size_t)(get_unaligned_le32(v + 2) & 0x3ffff);
	switch (control & EC_EEP_CMD_MASK) {
	case EC_EEP_CMD_READ:
		read_words(app, at, control & EC_EEP_READ8 ? 8 : 4, now);
		break;
	case EC_EEP_CMD_WRITE:
		error = write_word(app, at, now);
		break;
	default:		/* reload: the configuration is built in */
		break;
	}
	put_unaligned_le16((control & EC_EEP_CMD_MASK) | error, v);
	ec_esc_pdi_write(app->esc, EC_REG_EEP_CONTROL, v, 2, now);
}
