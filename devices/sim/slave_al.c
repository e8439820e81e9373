// SPDX-License-Identifier: GPL-2.0-only
/* AL state machine of a slave with software (ETG.1000.6 clause 6.4). */
#include "app.h"

#define DC_MIN_CYCLE_NS		62500u
#define WD_MIN_NS		100000u	/* a shorter watchdog is refused */

static void show(struct ec_app *app, u64 now)
{
	u16 status = app->state, code = app->error ? app->code : 0;

	if (ec_app_bug(app, EC_SIM_BUG_AL_CODE))
		code = 0;
	if (app->error) {
		status |= EC_AL_ERROR;
	} else if (app->identify && app->id_due == EC_ESC_NEVER && app->model->params.id) {
		status |= EC_AL_ID;
		code = app->model->params.id;
	}
	ec_esc_set_al_status(app->esc, status, code, now);
}

/**
 * ec_app_al_reset() - power-on
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_reset(struct ec_app *app, u64 now)
{
	app->state = EC_AL_INIT;
	app->error = false;
	app->code = 0;
	app->identify = false;
	app->al_to = 0;
	app->al_waits = false;
	app->outputs_seen = 0;
	show(app, now);
}

/* 0x1C32:02 and 0x1C33:02 say the cycle that SYNC0 gives */
static void cycle_time(struct ec_app *app)
{
	u32 cycle = get_unaligned_le32(app->esc->mem + EC_REG_DC_CYCLE0);

	if (!(app->esc->mem[EC_REG_DC_ACTIVATION] & 1) || !cycle)
		return;
	for (int dir = 0; dir < EC_APP_DIRS; dir++)
		for (int k = 0; k < app->model->n_areas[dir]; k++)
			ec_app_od_set(app, ec_app_od_entry(app->model,
					(u16)(0x1C30 + app->model->area[dir][k]), 2), cycle);
}

/* what has to happen whenever @app->state gets a new value */
static void enter(struct ec_app *app, u8 state, u64 now)
{
	u8 from = app->state;

	if (state == EC_AL_SAFEOP && from == EC_AL_PREOP)
		cycle_time(app);

	app->state = state;
	if (from == EC_AL_OP && state != EC_AL_OP)
		ec_app_outputs_clear(app);
	if (from == EC_AL_INIT)
		ec_app_mbox_reset(app);
	if (state == EC_AL_SAFEOP && from == EC_AL_PREOP) {
		app->outputs_seen = 0;
		ec_app_inputs(app, now);
	} else if (state == EC_AL_OP) {
		/* the last outputs of SAFEOP were kept in their buffer */
		ec_app_outputs(app, -1, now);
		ec_app_inputs(app, now);
	}
}

/**
 * ec_app_al_fail() - show an error
 * @app: slave
 * @state: state it stays in or falls back to
 * @code: AL status code
 * @now: time, ns
 *
 * A slave never stays in OP with the error indication.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_fail(struct ec_app *app, u8 state, u16 code, u64 now)
{
	if (state == EC_AL_OP)
		state = EC_AL_SAFEOP;
	app->al_to = 0;
	app->al_waits = false;
	if (state != app->state)
		enter(app, state, now);
	app->error = true;
	app->code = code;
	ec_app_diag_al(app, code, now);
	show(app, now);
}

/**
 * ec_app_al_old() - the state in which another master left the slave
 * @app: slave
 * @state: that state; its SyncManagers are set
 * @now: time, ns
 *
 * It is reached step by step, at once and without checks.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_old(struct ec_app *app, u8 state, u64 now)
{
	static const u8 way[] = { EC_AL_PREOP, EC_AL_SAFEOP, EC_AL_OP };

	app->al_to = 0;
	app->al_waits = false;
	app->error = false;
	app->code = 0;
	if (app->state != EC_AL_INIT)
		enter(app, EC_AL_INIT, now);
	for (u32 i = 0; i < ARRAY_SIZE(way) && state != EC_AL_BOOT && way[i] <= state; i++)
		enter(app, way[i], now);
	if (app->state != state)
		enter(app, state, now);
	show(app, now);
}

static u16 sii_word(const struct ec_app *app, u32 word)
{
	const struct ec_esc_eeprom *e = &app->esc->eep;

	return 2 * word + 2 <= e->len ? get_unaligned_le16(e->data + 2 * word) : 0;
}

static bool mbox_sm_ok(const struct ec_app *app, int n, u16 start, u16 len)
{
	const struct ec_esc_sm *sm = &app->esc->sm[n];
	u8 control = EC_SM_MODE_MAILBOX | (n ? 0 : EC_SM_DIR_WRITE);

	if (app->model->params.strict && sm->page.control != (n ? 0x22 : 0x26))
		return false;
	return sm->active && sm->page.start == start && sm->page.len == len &&
	       (sm->page.control & (EC_SM_MODE_MASK | EC_SM_DIR_MASK)) == control;
}

/* SM0 and SM1 against the mailbox areas at @word of the EEPROM; where there are none, @own */
static bool mboxes_ok(const struct ec_app *app, u32 word, const struct ec_app_mbox_area *own)
{
	if (!sii_word(app, word + 1) && !sii_word(app, word + 3))
		return mbox_sm_ok(app, 0, own->rx, own->rx_len) &&
		       mbox_sm_ok(app, 1, own->tx, own->tx_len);
	return mbox_sm_ok(app, 0, sii_word(app, word), sii_word(app, word + 1)) &&
	       mbox_sm_ok(app, 1, sii_word(app, word + 2), sii_word(app, word + 3));
}

/* a SyncManager of a direction against the mapped process data */
static u16 check_area(const struct ec_app *app, enum ec_app_dir dir, int k)
{
	u16 bad = dir == EC_APP_OUT ? EC_AL_CODE_OUTPUT_CONFIG :
				      EC_AL_CODE_INPUT_CONFIG;
	int n = app->model->area[dir][k];
	const struct ec_sm *p;
	u16 bytes = app->area_bytes[dir][k];

	p = &app->esc->sm[n].page;
	if (!bytes)
		return p->activate & EC_SM_ACT_ENABLE && p->len ? bad : 0;
	if (!app->esc->sm[n].active) {
		if (app->model->dev.sms[n].enable & EC_SII_SM_OP_ONLY)
			return 0;	/* comes later */
		return bad;
	}
	if (p->len != bytes)
		return bad;
	/* elsewhere than the EEPROM says only if the layout is free */
	if (p->start != app->model->dev.sms[n].start &&
	    app->model->dev.mapping < EC_APP_MAP_FULL)
		return bad;
	for (int i = 0; i < app->esc->cfg.sms; i++) {
		const struct ec_esc_sm *o = &app->esc->sm[i];
		u32 olen = o->page.len;

		if (i == n || !o->active)
			continue;
		if ((o->page.control & EC_SM_MODE_MASK) != EC_SM_MODE_MAILBOX)
			olen *= 3;
		if (p->start < o->page.start + olen &&
		    o->page.start < p->start + 3u * p->len)
			return bad;
	}
	if ((p->control & EC_SM_MODE_MASK) != EC_SM_MODE_BUFFERED ||
	    (p->control & EC_SM_DIR_MASK) !=
	    (dir == EC_APP_OUT ? EC_SM_DIR_WRITE : 0))
		return EC_AL_CODE_SM_CONFIG;
	return 0;
}

static u16 check_pd_sms(const struct ec_app *app, enum ec_app_dir dir)
{
	u16 code = 0;

	if (ec_app_bug(app, EC_SIM_BUG_SM_UNCHECKED))
		return 0;
	for (int k = 0; k < app->model->n_areas[dir] && !code; k++)
		code = check_area(app, dir, k);
	return code;
}

static u16 reg16(const struct ec_app *app, u16 reg)
{
	return get_unaligned_le16(app->esc->mem + reg);
}

static u16 check_watchdog(const struct ec_app *app)
{
	bool on = false;
	u64 ns;

	for (int k = 0; k < app->model->n_areas[EC_APP_OUT]; k++)
		on |= app->esc->sm[app->model->area[EC_APP_OUT][k]].page.control & EC_SM_WATCHDOG;
	if (!on)
		return 0;
	ns = (reg16(app, EC_REG_WD_DIVIDER) + 2ull) * 40 *
	     reg16(app, EC_REG_WD_SM);
	return ns && ns < WD_MIN_NS ? EC_AL_CODE_WD_CONFIG : 0;
}

/* 0x0981 @act starts the SYNC signals of one of @modes; 0 in the list: none */
static bool is_mode(const struct ec_app_list *modes, u8 act)
{
	u8 sync = act & 1 ? act & 7 : 0;

	for (u32 i = 0; i < modes->n; i++)
		if ((modes->v[i] >> 8 & 7) == sync)
			return true;
	return false;
}

static u16 check_dc(const struct ec_app *app)
{
	const struct ec_app_list *modes = &app->model->params.quirks.dc_modes;
	u8 act = app->esc->mem[EC_REG_DC_ACTIVATION];
	u32 cycle = get_unaligned_le32(app->esc->mem + EC_REG_DC_CYCLE0);

	if (modes->given)
		return is_mode(modes, act) ? 0 : EC_AL_CODE_DC_CONFIG;
	if (!(act & 1))
		return 0;
	if (!app->model->dev.n_dc || !(act & 2))
		return EC_AL_CODE_DC_CONFIG;
	return cycle && cycle < DC_MIN_CYCLE_NS ? 0x0035 : 0;
}

/* What SAFEOP still waits for on the way to OP: outputs, SYNC signals; 0: nothing. */
static u16 missing(const struct ec_app *app, u64 now)
{
	if (app->bytes[EC_APP_OUT] && !ec_app_outputs_complete(app))
		return EC_AL_CODE_NO_OUTPUTS;
	if (app->esc->mem[EC_REG_DC_ACTIVATION] & 1 && !ec_esc_dc_sync_ran(app->esc, now))
		return EC_AL_CODE_NO_SYNC;
	return 0;
}

/* a list that the master has not written expects nothing */
static u16 check_modules(struct ec_app *app)
{
	const struct ec_app_quirks *q = &app->model->params.quirks;
	bool given = false, same = true;

	for (u8 i = 1; i <= q->n_modules; i++) {
		u64 v = ec_app_od_get(app, ec_app_od_entry(app->model, EC_APP_MODULES_SET, i));

		given |= v;
		same &= v == q->modules[i - 1];
	}
	return given && !same ? EC_AL_CODE_MODULES : 0;
}

static u16 check(struct ec_app *app, u8 to)
{
	const struct ec_app_dev *d = &app->model->dev;
	const struct ec_esc_fault *f = &app->esc->fault;
	u16 code;

	if (f->al_refuse == to)
		return f->al_code;
	if (to < app->state && to != EC_AL_PREOP)
		return 0;
	switch (to) {
	case EC_AL_PREOP:
		if (app->state != EC_AL_INIT)
			return 0;
		if (app->own_eeprom && !(app->esc->mem[EC_REG_EEP_OWNER] & 1))
			return EC_AL_CODE_NO_EEPROM;
		return d->std.rx_len && !mboxes_ok(app, EC_SII_W_STD_MBOX, &d->std) ?
		       EC_AL_CODE_MBOX_PREOP : 0;
	case EC_AL_BOOT:
		if (!d->boot.rx_len)
			return EC_AL_CODE_NO_BOOT;
		return mboxes_ok(app, EC_SII_W_BOOT_MBOX, &d->boot) ? 0 :
							    EC_AL_CODE_MBOX_BOOT;
	case EC_AL_SAFEOP:
		code = check_modules(app);
		if (!code)
			code = ec_app_pdo_build(app);
		if (!code)
			code = check_pd_sms(app, EC_APP_OUT);
		if (!code)
			code = check_pd_sms(app, EC_APP_IN);
		if (!code)
			code = check_watchdog(app);
		return code ? code : check_dc(app);
	case EC_AL_OP:
		return check_watchdog(app);
	default:
		return 0;
	}
}

/* the transition time is over, or what was waited for may have come */
static void finish(struct ec_app *app, u64 now)
{
	u8 to = app->al_to;
	u16 code = check(app, to);

	if (code) {
		ec_app_al_fail(app, app->state, code, now);
		return;
	}
	if (to == EC_AL_OP && app->state == EC_AL_SAFEOP)
		code = missing(app, now);
	if (code) {
		if (!app->al_waits) {
			app->al_waits = true;
			app->al_deadline = now + app->op_timeout_ns;
			return;
		}
		if (now < app->al_deadline)
			return;
		ec_app_al_fail(app, EC_AL_SAFEOP, code, now);
		return;
	}
	app->al_to = 0;
	app->al_waits = false;
	enter(app, to, now);
	show(app, now);
}

/**
 * ec_app_al_outputs() - outputs came while the way to OP waited for them
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_outputs(struct ec_app *app, u64 now)
{
	if (app->al_to && app->al_waits)
		finish(app, now);
}

/**
 * ec_app_al_poll() - time has passed
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_poll(struct ec_app *app, u64 now)
{
	if (app->al_to && now >= (app->al_waits ? app->al_deadline : app->al_due))
		finish(app, now);
	if (now >= app->id_due) {
		app->id_due = EC_ESC_NEVER;
		show(app, now);
	}
}

/**
 * ec_app_al_legal() - does a slave in one state have to follow a request for another?
 * @from: present state
 * @to: state to request
 *
 * Staying is legal.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it has to.
 */
bool ec_app_al_legal(u8 from, u8 to)
{
	if (!ec_al_state_valid(from) || !ec_al_state_valid(to))
		return false;
	if (from == to || to == EC_AL_INIT)
		return true;
	switch (from) {
	case EC_AL_INIT:
		return to == EC_AL_PREOP || to == EC_AL_BOOT;
	case EC_AL_PREOP:
		return to == EC_AL_SAFEOP;
	case EC_AL_SAFEOP:
		return to == EC_AL_PREOP || to == EC_AL_OP;
	case EC_AL_OP:
		return to == EC_AL_PREOP || to == EC_AL_SAFEOP;
	default:
		return false;
	}
}

/* time that the change to @to takes */
static u64 step_ns(const struct ec_app *app, u8 to)
{
	if (to < app->state)
		return app->transition_ns;
	switch (to) {
	case EC_AL_PREOP:
		return app->step_ns[EC_APP_STEP_PREOP];
	case EC_AL_BOOT:
		return app->step_ns[EC_APP_STEP_BOOT];
	case EC_AL_SAFEOP:
		return app->step_ns[EC_APP_STEP_SAFEOP];
	default:
		return app->step_ns[EC_APP_STEP_OP];
	}
}

/* is an error indication gone by @control */
static bool clears_error(const struct ec_app *app, u16 control)
{
	if ((control & EC_AL_STATE_MASK) == EC_AL_INIT || ec_app_bug(app, EC_SIM_BUG_AL_NO_ACK))
		return true;
	return control & EC_AL_ERROR && !app->no_ack;
}

/**
 * ec_app_al_control() - the master wrote AL control
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_al_control(struct ec_app *app, u64 now)
{
	u8 raw[2], to;
	u16 control;

	if (ec_esc_pdi_read(app->esc, EC_REG_AL_CONTROL, raw, 2, now) < 0)
		return;
	control = get_unaligned_le16(raw);
	to = control & EC_AL_STATE_MASK;
	if (!(control & EC_AL_ID))
		app->id_due = EC_ESC_NEVER;
	else if (!app->identify && app->id_ns)
		app->id_due = now + app->id_ns;
	app->identify = control & EC_AL_ID;

	/* an error not acknowledged: nothing but INIT is heard */
	if (app->error) {
		if (!clears_error(app, control))
			return;
		app->error = false;
		app->code = 0;
	}
	if (!ec_al_state_valid(to)) {
		ec_app_al_fail(app, app->state, EC_AL_CODE_UNKNOWN_STATE, now);
		return;
	}
	if (to == app->state) {
		app->al_to = 0;
		app->al_waits = false;
		show(app, now);
		return;
	}
	if (!ec_app_al_legal(app->state, to) &&
	    !ec_app_bug(app, EC_SIM_BUG_AL_SKIP)) {
		ec_app_al_fail(app, app->state, EC_AL_CODE_INVALID_CHANGE, now);
		return;
	}
	app->al_to = to;
	app->al_waits = false;
	app->al_due = now + step_ns(app, to);
	app->esc->own.al_ns += step_ns(app, to);
	show(app, now);	/* the acknowledge shows at once */
	if (app->al_due == now)
		finish(app, now);
}
