// SPDX-License-Identifier: GPL-2.0-only
/* One simulated slave: an application attached to a slave controller. */
#include "app.h"

/**
 * ec_app_state() - AL state of a slave
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: enum ec_al_state.
 */
u8 ec_app_state(const struct ec_app *app)
{
	if (app->model->emulation)
		return app->esc->mem[EC_REG_AL_STATUS] & EC_AL_STATE_MASK;
	return app->state;
}

/* emulated slaves have no software which could hear of a state change */
static void power_on(struct ec_esc *esc, u64 now)
{
	struct ec_app *app = esc->app;
	const struct ec_app_model *m = app->model;

	memcpy(app->data, m->defaults, m->data_len);
	ec_app_od_set(app, ec_app_od_entry(m, 0x1018, 4), app->serial);
	memset(&app->ip.now, 0, sizeof(app->ip.now));
	app->next_event = app->events;
	while (app->next_event && app->next_event->at_ns < now)
		app->next_event = app->next_event->next;
	esc->late.ran_ns = now;
	app->eep_due = EC_ESC_NEVER;
	app->id_due = EC_ESC_NEVER;
	ec_app_diag_reset(app, now);
	ec_app_soe_reset(app);
	ec_app_pdo_build(app);
	ec_app_mbox_reset(app);
	if (m->dev.profile && m->dev.profile->init)
		m->dev.profile->init(app);
	if (!m->emulation)
		ec_app_al_reset(app, now);
	ec_app_rewake(app, now);
}

/* stays silent on request of the script; the poll looks again */
static bool mute(struct ec_app *app, u64 now)
{
	if (!app->esc->fault.app_mute)
		return false;
	ec_esc_wake_at(app->esc, now + 1000000);
	return true;
}

static void al_control(struct ec_esc *esc, u64 now)
{
	struct ec_app *app = esc->app;

	if (mute(app, now))
		return;
	ec_app_al_control(app, now);
	ec_app_rewake(app, now);
}

static void eeprom(struct ec_esc *esc, u64 now)
{
	struct ec_app *app = esc->app;

	ec_app_memory_command(app, now);
	ec_app_rewake(app, now);
}

static void sm_written(struct ec_esc *esc, int sm, u64 now)
{
	struct ec_app *app = esc->app;
	const struct ec_app_model *m = app->model;

	if (ec_app_area(m, EC_APP_OUT, sm) >= 0) {
		bool waits = app->al_waits;

		ec_app_outputs(app, sm, now);
		if (waits)
			ec_app_al_outputs(app, now);
		if (ec_app_state(app) == EC_AL_OP)
			ec_app_inputs(app, now);
		if (!waits) {
			ec_app_may_wait(app);
			return;		/* no other time to wake up */
		}
	} else if (!sm && m->dev.std.rx_len && !m->emulation) {
		if (mute(app, now))
			return;
		ec_app_mbox_written(app, now);
	} else {
		return;
	}
	ec_app_rewake(app, now);
}

static void sm_read(struct ec_esc *esc, int sm, u64 now)
{
	struct ec_app *app = esc->app;
	const struct ec_app_model *m = app->model;

	if (ec_app_area(m, EC_APP_IN, sm) >= 0) {
		/* with outputs in OP their writing sets the pace */
		if (!app->bytes[EC_APP_OUT] || ec_app_state(app) != EC_AL_OP ||
		    now - esc->late.ran_ns > 2000000)
			ec_app_inputs(app, now);
		ec_app_may_wait(app);
	} else if (sm == 1 && m->dev.std.tx_len && !m->emulation) {
		ec_app_mbox_read(app, now);
		ec_app_rewake(app, now);
	}
}

/* in OP, else it would not have been made to wait */
static void sm_taken(struct ec_esc *esc, const u8 *data)
{
	ec_app_outputs_use(esc->app, data);
}

static void sm_activate(struct ec_esc *esc, int sm, u64 now)
{
	struct ec_app *app = esc->app;
	const struct ec_app_model *m = app->model;

	if (ec_app_area(m, EC_APP_IN, sm) >= 0) {
		if (m->emulation && esc->sm[sm].active)
			ec_app_inputs(app, now);
		return;
	}
	if (sm > 1 || !m->dev.std.rx_len || m->emulation)
		return;
	if (app->state != EC_AL_INIT && !esc->sm[sm].active)
		ec_app_al_fail(app, EC_AL_INIT, app->state == EC_AL_BOOT ?
			       EC_AL_CODE_MBOX_BOOT : EC_AL_CODE_MBOX_PREOP, now);
	else if (sm == 1 && !mute(app, now))
		ec_app_mbox_activate(app, now);
	ec_app_rewake(app, now);
}

static void fault(struct ec_esc *esc, const struct ec_sim_fault *f, u64 now)
{
	struct ec_app *app = esc->app;
	static const u8 data[5];
	struct ec_app_source src = { .kind = EC_APP_SRC_CONST, .offset = (s64)f->value };

	switch (f->type) {
	case EC_SIM_FAULT_INPUT:
		if (f->arg >= app->model->n_chan[EC_APP_IN])
			break;
		ec_app_set_source(app, (u16)f->arg, &src);
		ec_app_inputs(app, now);
		break;
	case EC_SIM_FAULT_AL_ERROR:
		if (!app->model->emulation)
			ec_app_al_fail(app, app->state, (u16)f->arg, now);
		break;
	case EC_SIM_FAULT_OLD:
		ec_app_old(app, f, now);
		break;
	case EC_SIM_FAULT_EOE:
		ec_app_eoe_fault(app, now);
		break;
	case EC_SIM_FAULT_DRIVE:
		ec_app_soe_error(app, (u8)f->arg2, (u16)f->arg);
		break;
	case EC_SIM_FAULT_EMERGENCY:
		ec_app_emergency(app, (u16)f->arg, (u8)f->arg2, data, now);
		break;
	default:
		break;
	}
	ec_app_rewake(app, now);
}

static void watchdog(struct ec_esc *esc, u64 now)
{
	struct ec_app *app = esc->app;

	if (!ec_app_bug(app, EC_SIM_BUG_WD_OUTPUTS))
		ec_app_outputs_clear(app);
	if (!app->model->emulation && app->state == EC_AL_OP)
		ec_app_al_fail(app, EC_AL_SAFEOP, EC_AL_CODE_SM_WATCHDOG, now);
	ec_app_inputs(app, now);
	ec_app_rewake(app, now);
}

static void poll(struct ec_esc *esc, u64 now)
{
	struct ec_app *app = esc->app;

	while (app->next_event && app->next_event->at_ns <= now) {
		const u8 *e = app->next_event->emcy;

		if (app->next_event->type == EC_MBOX_VOE)
			ec_app_voe_send(app, &app->next_event->voe, now);
		else if (app->next_event->type == EC_MBOX_SOE)
			ec_app_soe_send(app, &app->next_event->soe, now);
		else
			ec_app_emergency(app, get_unaligned_le16(e), e[2], e + 3, now);
		app->next_event = app->next_event->next;
	}
	if (!mute(app, now) && !app->model->emulation) {
		if (now >= ec_app_soe_due(app))
			ec_app_soe_poll(app, now);
		if (esc->al_unread)
			ec_app_al_control(app, now);
		ec_app_al_poll(app, now);
		ec_app_eoe_poll(app, now);
		ec_app_mbox_poll(app, now);
		ec_app_memory_poll(app, now);
	}
	ec_app_rewake(app, now);
}

/**
 * ec_app_rewake() - set the next time the application wants to be called
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_rewake(struct ec_app *app, u64 now)
{
	u64 at = EC_ESC_NEVER;

	if (app->al_to)
		at = app->al_waits ? app->al_deadline : app->al_due;
	at = min(at, ec_app_mbox_due(app));
	at = min(at, ec_app_eoe_due(app));
	at = min(at, ec_app_soe_due(app));
	at = min(at, app->eep_due);
	at = min(at, app->id_due);
	if (app->next_event)
		at = min(at, app->next_event->at_ns);
	if (app->esc->fault.app_mute)
		at = max(at, now + 1000000);
	if (at != EC_ESC_NEVER)
		ec_esc_wake_at(app->esc, at);
}

static void app_free(struct ec_app *app)
{
	struct ec_sim *sim = app->model->sim;
	struct ec_app_event *e, *next;

	for (e = app->events; e; e = next) {
		next = e->next;
		ec_sim_release(sim, e);
	}
	ec_app_model_put(app->model);
	ec_sim_release(sim, app);
}

static void esc_free(struct ec_esc *esc)
{
	app_free(esc->app);
	esc->app = NULL;
}

static const struct ec_esc_app_ops app_ops = {
	.al_control = al_control,
	.eeprom = eeprom,
	.sm_written = sm_written,
	.sm_read = sm_read,
	.sm_taken = sm_taken,
	.sm_activate = sm_activate,
	.fault = fault,
	.watchdog = watchdog,
	.poll = poll,
	.power_on = power_on,
	.free = esc_free,
};

/**
 * ec_app_of() - application of a slave controller
 * @esc: controller
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the application, NULL if it has none of ours.
 */
struct ec_app *ec_app_of(const struct ec_esc *esc)
{
	return esc->app_ops == &app_ops ? esc->app : NULL;
}

/**
 * ec_app_add_event() - let a slave send a message by itself
 * @app: slave
 * @event: what and when; copied
 *
 * Context: Process. May sleep.
 * Return: 0, or -ENOMEM.
 */
int ec_app_add_event(struct ec_app *app, const struct ec_app_event *event)
{
	struct ec_app_event *e, **p = &app->events;

	e = ec_sim_alloc(app->model->sim, sizeof(*e));
	if (!e)
		return -ENOMEM;
	*e = *event;
	while (*p && (*p)->at_ns <= e->at_ns)
		p = &(*p)->next;
	e->next = *p;
	*p = e;
	app->next_event = app->events;
	ec_app_rewake(app, 0);
	return 0;
}

static size_t align8(size_t n)
{
	return (n + 7) & ~(size_t)7;
}

/* One block of memory for everything a slave has of its own. */
static struct ec_app *app_alloc(struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;
	u16 mbox = max(max(d->std.rx_len, d->std.tx_len),
		       max(d->boot.rx_len, d->boot.tx_len));
	u16 info = (u16)max_t(u32, 2 + 2 * m->n_objects, 300);
	u16 image = max(m->max_bytes[EC_APP_OUT], m->max_bytes[EC_APP_IN]);
	size_t size, at[12];
	struct ec_app *app;
	u8 *p;

	if (!mbox)
		info = 0;
	at[0] = align8(sizeof(*app));
	at[1] = at[0] + sizeof(struct ec_app_copy) * m->map_cap[EC_APP_OUT];
	at[2] = align8(at[1] + sizeof(struct ec_app_copy) * m->map_cap[EC_APP_IN]);
	at[3] = at[2] + sizeof(struct ec_app_source) * m->n_chan[EC_APP_IN];
	at[4] = at[3] + align8(d->profile ? d->profile->size : 0);
	at[5] = at[4] + m->data_len;
	at[6] = at[5] + image + m->max_bytes[EC_APP_IN];
	at[7] = at[6] + 3 * (size_t)mbox;
	at[8] = at[7] + info;
	at[9] = at[8] + (mbox ? EC_APP_SDO_BUF + 1024 : 0);
	at[10] = at[9] + ec_app_soe_bytes(m->params.soe);
	at[11] = align8(at[10] + ec_app_foe_bytes(m));
	size = at[11] + ec_app_eoe_bytes(m);

	app = ec_sim_alloc(m->sim, size);
	if (!app)
		return NULL;
	p = (u8 *)app;
	app->map[EC_APP_OUT] = (void *)(p + at[0]);
	app->map[EC_APP_IN] = (void *)(p + at[1]);
	app->src = (void *)(p + at[2]);
	app->profile = p + at[3];
	app->data = p + at[4];
	app->image = p + at[5];
	app->inputs = app->image + image;
	app->mbox.cap = mbox;
	app->mbox.rx = p + at[6];
	app->mbox.out = app->mbox.rx + mbox;
	app->mbox.last = app->mbox.out + mbox;
	app->mbox.info_buf = p + at[7];
	app->mbox.info_cap = info;
	app->sdo_buf = p + at[8];
	app->soe.values = p + at[9];
	app->soe.drives = m->params.soe;
	app->foe.flash = p + at[10];
	app->foe.cap = ec_app_foe_bytes(m);
	app->eoe = m->params.eoe ? (void *)(p + at[11]) : NULL;
	app->model = m;
	m->refs++;
	return app;
}

/* What a slave needs in RAM: mailboxes and three buffers per direction. */
static u8 ram_kib(const struct ec_app_model *m)
{
	u32 end = EC_REG_RAM + 4096;

	for (u32 i = 0; i < m->dev.n_sms; i++) {
		const struct ec_app_sm *sm = &m->dev.sms[i];
		u32 len = sm->len;

		if (ec_app_area(m, EC_APP_OUT, (int)i) >= 0)
			len = 3u * m->max_bytes[EC_APP_OUT];
		else if (ec_app_area(m, EC_APP_IN, (int)i) >= 0)
			len = 3u * m->max_bytes[EC_APP_IN];
		end = max(end, sm->start + len);
	}
	end = max(end, (u32)m->dev.boot.rx + m->dev.boot.rx_len);
	end = max(end, (u32)m->dev.boot.tx + m->dev.boot.tx_len);
	return (u8)min_t(u32, (end - EC_REG_RAM + 1023) / 1024, 60);
}

/**
 * ec_app_add() - add a slave to a segment
 * @sim: segment
 * @model: what it is
 * @cfg: what it differs in from its model
 *
 * Context: Process. May sleep.
 * Return: the application, NULL without memory or when the segment is full.
 */
struct ec_app *ec_app_add(struct ec_sim *sim, struct ec_app_model *model,
			  const struct ec_app_config *cfg)
{
	const struct ec_app_dev *d = &model->dev;
	struct ec_esc_config ec;
	struct ec_esc *esc;
	struct ec_app *app;
	u8 *image;

	app = app_alloc(model);
	if (!app)
		return NULL;
	memcpy(app->name, cfg->name,
	       min(strlen(cfg->name), sizeof(app->name) - 1));
	app->serial = cfg->serial ? cfg->serial :
		get_unaligned_le32(model->eeprom + 2 * EC_SII_W_SERIAL);
	app->transition_ns = cfg->transition_ns;
	memcpy(app->step_ns, cfg->step_ns, sizeof(app->step_ns));
	app->no_ack = cfg->no_ack;
	app->own_eeprom = cfg->own_eeprom;
	app->response_ns = cfg->response_ns;
	app->op_timeout_ns = cfg->op_timeout_ns;
	app->id_ns = cfg->id_ns;
	app->ip.refuse = cfg->no_ip;
	app->ip.packed = cfg->ip_packed;
	app->ip.mute = cfg->ip_mute;
	ec_app_eoe_init(app);
	app->foe.busy = cfg->foe_busy;
	app->foe.page_ns = cfg->foe_page_ns;
	app->foe.boot = cfg->foe_boot;
	app->foe.header_len = (u8)min_t(size_t, cfg->foe_header_len, EC_APP_FOE_HEADER);
	if (app->foe.header_len)
		memcpy(app->foe.header, cfg->foe_header, app->foe.header_len);

	image = ec_sim_alloc(sim, model->eeprom_len);
	if (!image) {
		app_free(app);
		return NULL;
	}
	memcpy(image, model->eeprom, model->eeprom_len);
	if (cfg->alias) {
		put_unaligned_le16(cfg->alias, image + 2 * EC_SII_W_ALIAS);
		image[2 * EC_SII_W_CHECKSUM] = ec_sii_crc(image);
	}
	if (cfg->serial)
		put_unaligned_le32(cfg->serial, image + 2 * EC_SII_W_SERIAL);

	ec_esc_config_init(&ec);
	ec.type = d->esc_type;
	ec.fmmus = d->fmmus;
	ec.sms = max_t(u8, d->n_sms, d->esc_type == EC_APP_ESC_ET1200 ? 4 : 8);
	ec.ram_kib = ram_kib(model);
	memcpy(ec.ports, d->ports, sizeof(ec.ports));
	ec.features = d->features | EC_FEAT_FCS_SEPARATE | (cfg->no_lrw ? EC_FEAT_NO_LRW : 0);
	ec.dc_delay_only = cfg->clock_bits ? cfg->clock_bits == EC_APP_CLOCK_DELAY :
					     d->dc_delay_only;
	if (cfg->clock_bits && !ec.dc_delay_only) {
		ec.features &= (u16)~(EC_FEAT_DC | EC_FEAT_DC64 | EC_FEAT_DC_ENHANCED);
		if (cfg->clock_bits != EC_APP_NO_CLOCK)
			ec.features |= EC_FEAT_DC | EC_FEAT_DC_ENHANCED;
		if (cfg->clock_bits == 64)
			ec.features |= EC_FEAT_DC64;
	}
	ec.loops_fixed = cfg->loops_fixed;
	ec.no_frmw = cfg->no_frmw;
	ec.link_ns = cfg->link_ns;
	ec.eeprom = image;
	ec.eeprom_len = model->eeprom_len;
	ec.eeprom_size = model->eeprom_len;
	ec.eeprom_emulated = cfg->eeprom_emulated;
	if (cfg->process_ns)
		ec.process_ns = cfg->process_ns;
	ec.drift_ppb = cfg->drift_ppb;
	ec.clock_start = cfg->clock_start;
	esc = ec_sim_add(sim, &ec);
	ec_sim_release(sim, image);
	if (!esc) {
		app_free(app);
		return NULL;
	}
	app->esc = esc;
	esc->app = app;
	esc->app_ops = &app_ops;
	power_on(esc, ec_sim_now(sim));
	return app;
}
