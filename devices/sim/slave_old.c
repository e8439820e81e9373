// SPDX-License-Identifier: GPL-2.0-only
/*
 * A slave that another master left behind: its SyncManagers, FMMUs and state are
 * as if it had been configured by that one.
 */
#include "app.h"

static void put_sm(struct ec_app *app, int n, u16 start, u16 len, u8 control, u64 now)
{
	const struct ec_sm sm = {
		.start = start, .len = len, .control = control, .activate = EC_SM_ACT_ENABLE,
	};
	static const u8 off;
	u8 page[EC_SM_PAGE];

	ec_sm_encode(&sm, page);
	/* the status is the controller's; a SyncManager must be off to be changed */
	ec_esc_old_write(app->esc, (u16)(EC_REG_SM(n) + EC_SM_OFS_ACTIVATE), &off, 1, now);
	ec_esc_old_write(app->esc, (u16)EC_REG_SM(n), page, EC_SM_PAGE - 1, now);
}

static void mailboxes(struct ec_app *app, const struct ec_app_mbox_area *a, u64 now)
{
	if (!a->rx_len)
		return;
	put_sm(app, 0, a->rx, a->rx_len, 0x26, now);
	put_sm(app, 1, a->tx, a->tx_len, 0x22, now);
}

/* without their watchdog: what was left in OP some time ago would have left it */
static void process_data(struct ec_app *app, u64 now)
{
	const struct ec_app_model *m = app->model;

	for (int dir = 0; dir < EC_APP_DIRS; dir++) {
		for (int k = 0; k < m->n_areas[dir]; k++) {
			const struct ec_app_sm *sm = &m->dev.sms[m->area[dir][k]];

			if (app->area_bytes[dir][k])
				put_sm(app, m->area[dir][k], sm->start, app->area_bytes[dir][k],
				       (u8)(sm->control & ~EC_SM_WATCHDOG), now);
		}
	}
}

/* outputs from @logical on, inputs behind them */
static void fmmus(struct ec_app *app, u32 logical, u64 now)
{
	const struct ec_app_model *m = app->model;
	struct ec_fmmu f = { .logical = logical, .lbit_stop = 7, .enable = true };
	u8 page[EC_FMMU_PAGE];
	int n = 0;

	for (int dir = 0; dir < EC_APP_DIRS; dir++) {
		f.type = dir == EC_APP_OUT ? EC_FMMU_WRITE : EC_FMMU_READ;
		for (int k = 0; k < m->n_areas[dir]; k++) {
			f.len = app->area_bytes[dir][k];
			if (!f.len || n == app->esc->cfg.fmmus)
				continue;
			f.phys = m->dev.sms[m->area[dir][k]].start;
			ec_fmmu_encode(&f, page);
			ec_esc_old_write(app->esc, (u16)EC_REG_FMMU(n++), page, EC_FMMU_PAGE, now);
			f.logical += f.len;
		}
	}
}

/**
 * ec_app_old() - be as another master left it
 * @app: slave
 * @f: fault of type EC_SIM_FAULT_OLD
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_old(struct ec_app *app, const struct ec_sim_fault *f, u64 now)
{
	const struct ec_app_dev *d = &app->model->dev;
	u8 state = (u8)f->arg2;

	if (f->value & EC_SIM_OLD_LOGICAL)
		fmmus(app, f->arg, now);
	if (!(f->value & EC_SIM_OLD_STATE))
		return;
	if (state == EC_AL_BOOT)
		mailboxes(app, &d->boot, now);
	else if (state != EC_AL_INIT)
		mailboxes(app, &d->std, now);
	if (state == EC_AL_SAFEOP || state == EC_AL_OP)
		process_data(app, now);
	if (app->model->emulation)
		ec_esc_set_al_status(app->esc, state, 0, now);
	else
		ec_app_al_old(app, state, now);
}
