// SPDX-License-Identifier: GPL-2.0-only
/* Commands that show the state of the master; they cause no bus traffic. */
#include <linux/etherdevice.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "../wire/port_text.h"
#include "api.h"
#include "cdev.h"
#include "../config/config.h"
#include "../link/device.h"
#include "../config/domain.h"
#include "ioctl.h"
#include "master.h"
#include "../base/once64.h"
#include "../cycle/cycle_stats.h"
#include "../session/session.h"
#include "../bus/absent.h"
#include "../bus/border.h"
#include "../bus/find.h"
#include "../bus/graph.h"
#include "../bus/line_errors.h"
#include "../bus/ports.h"
#include "../bus/slave.h"
#include "../bus/ring_break.h"
#include "../bus/ring_ends.h"
#include "../bus/ring_place.h"
#include "../config/why.h"

#ifndef EC_RELEASE
#define EC_RELEASE "0.1.0"
#endif

int ec_ioc_version(struct ec_call *call)
{
	struct ec_ioc_version *v = call->arg;

	if (v->abi < EC_UAPI_FIRST)
		return ec_refuse(call, -EPROTO,
				 "the program was built for interface version %u, this module has version %u: rebuild the program",
				 v->abi, EC_UAPI_VERSION);
	v->abi = EC_UAPI_VERSION;
	v->features = EC_FEATURE_APP_CYCLE | EC_FEATURE_COE | EC_FEATURE_KERNEL_CYCLE |
		      EC_FEATURE_SOE | EC_FEATURE_VOE | EC_FEATURE_FOE |
		      EC_FEATURE_EVENTS;
	v->master_count = ec_cdev_count();
	v->ecrt = 0x0106;
	strscpy(v->release, EC_RELEASE, sizeof(v->release));
	return 0;
}

int ec_ioc_reason(struct ec_call *call)
{
	struct ec_ioc_reason *r = call->arg;

	raw_spin_lock(&call->file->lock);
	strscpy(r->text, call->file->reason, sizeof(r->text));
	raw_spin_unlock(&call->file->lock);
	r->len = strlen(r->text);
	return 0;
}

/* The monitor updates them once a second. */
static void copy_rates(u32 *to, const u32 *rate)
{
	unsigned int i;

	for (i = 0; i < EC_UAPI_RATES; i++)
		to[i] = READ_ONCE(rate[i]);
}

int ec_ioc_device(struct ec_call *call)
{
	const struct ec_links *links = &call->master->links;
	struct ec_ioc_device *d = call->arg;
	const struct ec_link *link;
	struct ecdev *dev;

	if (d->index >= ec_links_n(links))
		return ec_refuse(call, -ENOENT, "master %u has %u network device(s), no %u",
				 call->master->base->index, ec_links_n(links), d->index);
	link = ec_links_at(&call->master->links, d->index);

	ec_links_name(link->links, link->side, d->name, sizeof(d->name));
	rcu_read_lock();
	dev = READ_ONCE(link->dev);
	d->state = dev ? EC_DEVICE_ATTACHED : EC_DEVICE_WAITING;
	if (dev) {
		ether_addr_copy(d->address, dev->mac);
		raw_spin_lock(&link->links->main_lock);
		strscpy(d->name, dev->name, sizeof(d->name));
		raw_spin_unlock(&link->links->main_lock);
		if (dev->ops->speed)
			d->speed = dev->ops->speed(dev->priv);
	}
	rcu_read_unlock();
	d->link_up = READ_ONCE(link->up);
	if (!d->link_up)
		d->speed = 0;
	d->slaves = READ_ONCE(link->slaves);
	d->al_states = READ_ONCE(link->al_states);
	d->tx_frames = atomic64_read(&link->stats.tx_frames);
	d->tx_bytes = atomic64_read(&link->stats.tx_bytes);
	d->rx_frames = atomic64_read(&link->stats.rx_frames);
	d->rx_bytes = atomic64_read(&link->stats.rx_bytes);
	d->tx_errors = atomic64_read(&link->stats.tx_errors);
	d->lost = atomic64_read(&link->stats.lost);
	d->late = atomic64_read(&link->stats.late);
	d->unmatched = atomic64_read(&link->stats.unmatched);
	d->foreign = atomic64_read(&link->stats.foreign);
	copy_rates(d->tx_frame_rate, link->rates.rate[0]);
	copy_rates(d->rx_frame_rate, link->rates.rate[1]);
	copy_rates(d->tx_byte_rate, link->rates.rate[2]);
	copy_rates(d->rx_byte_rate, link->rates.rate[3]);
	copy_rates(d->loss_rate, link->rates.rate[4]);
	return 0;
}

static void cycle_info(const struct ec_cycle *c, struct ec_ioc_master *i)
{
	const struct ec_cyc_wire *w = ec_dc_begun(c->dc) ? &c->layout.clocked : &c->layout.plain;

	i->cycle_interval_us = READ_ONCE(c->links->access.interval_us);
	i->cycle_datagrams = c->layout.n_dgrams;
	i->cycle_frames = w->frames;
	i->cycle_wire_ns = w->ns;
	i->sent_frames = READ_ONCE(c->last.frames);
	i->sent_wire_ns = READ_ONCE(c->last.ns);
	i->acyclic_slack_ns = ec_access_slack_ns(c->links);
	i->acyclic_need_ns = ec_layout_need_ns();
	i->late_per_s = READ_ONCE(c->carry->share.late_per_s);
	i->late_cycles = READ_ONCE(c->carry->share.late_cycles);
}

/* The part of a session in the state of the master. */
static void session_info(struct ec_call *call, const struct ec_session *s, struct ec_ioc_master *i)
{
	const struct ec_status *st;

	/* for an application in the kernel it is the process that loaded it: no useful name */
	if (s->cycle.owner == &call->master->api->file)
		strscpy(i->owner, "an application in the kernel", sizeof(i->owner));
	else
		ec_session_process(s, i->owner, sizeof(i->owner));
	i->active = s->wanted.active;
	i->session = !s->cycle.owner ? EC_SESSION_DETACHED :
		     s->wanted.active ? EC_SESSION_ACTIVE : EC_SESSION_RESERVED;
	i->left = !!s->detached;
	i->config_count = s->wanted.n_configs;
	i->domain_count = s->wanted.n_domains;
	if (!s->wanted.active)
		return;
	i->no_cycle = !ec_access_runs(&s->cycle.links->access);
	cycle_info(&s->cycle, i);
	st = s->cycle.shared->status;
	ec_status_copy(st, &i->dc_ref_time, &st->dc_time, sizeof(i->dc_ref_time));
	i->cycle_lock = READ_ONCE(st->kernel.lock);
	i->lock_losses = READ_ONCE(st->kernel.lock_losses);
	i->phase_error = READ_ONCE(st->kernel.phase_error);
	i->rate_ppb = READ_ONCE(st->kernel.rate_ppb);
}

int ec_ioc_master(struct ec_call *call)
{
	struct ec_master *m = call->master;
	struct ec_ioc_master *i = call->arg;
	const struct ec_slave *turned;
	unsigned int l;
	int ret;

	i->index = m->base->index;
	i->slave_count = READ_ONCE(m->bus.n_slaves);
	i->slaves_responding = READ_ONCE(m->bus.responding);
	i->al_states = READ_ONCE(m->bus.al_states);
	i->scan_busy = ec_bus_scan_busy(&m->bus);
	i->held = READ_ONCE(m->bus.held);
	ec_bus_scan_progress(&m->bus, &i->scan_index, &i->scan_slaves);
	i->scan_count = READ_ONCE(m->bus.scan_count);
	i->debug_level = READ_ONCE(m->base->debug);
	i->app_time = ec_read64(&m->dc.app_time);
	i->scan_us = READ_ONCE(m->bus.scan_us);
	i->scan_frames = ec_read64(&m->bus.scan_frames);
	i->acyclic_max = ec_share_max;
	i->sii_bytes = atomic_long_read(&m->bus.sii_bytes);
	i->sii_limit = EC_MAX_SII_TOTAL;
	ret = ec_show_begin(&m->base->show);
	if (ret)
		return ret;
	/* another slave may have the position of a disconnected one */
	i->ref_clock = m->dc.ref && !READ_ONCE(m->dc.ref->stop.gone) &&
		       READ_ONCE(m->dc.ref_station) ? m->dc.ref->position : -1;
	if (m->sessions.session)
		session_info(call, m->sessions.session, i);
	ec_ring_break_show(&m->bus, &i->ring, &i->ring_slave, &i->ring_port, &i->ring_next);
	turned = ec_ring_ends_turned(&m->bus);
	i->ring_turned = turned ? turned->position + 1 : 0;
	i->ring_exchanged = READ_ONCE(m->links.exchanged);
	ec_show_end(&m->base->show);
	i->phase = !ec_links_attached(&m->links) ? EC_PHASE_WAITING :
		   i->active ? EC_PHASE_OPERATION : EC_PHASE_IDLE;
	for (l = 0; l < ec_links_n(&m->links); l++) {
		i->links_up |= READ_ONCE(ec_links_at(&m->links, l)->up) << l;
		i->not_captured += atomic64_read(&ec_links_at(&m->links, l)->stats.not_captured);
	}
	i->device_count = l;
	return 0;
}

/* Delay to the neighbor at a port, if both have a clock. */
static u32 way(const struct ec_slave *s, unsigned int p)
{
	const struct ec_slave *next = s->graph.at[p];

	if (!next || !(ec_slave_features(s) & ec_slave_features(next) & EC_FEAT_DC))
		return 0;
	return p == s->graph.upstream ? ec_clock_of(s)->prev_delay : ec_clock_of(next)->prev_delay;
}

int ec_ioc_port(struct ec_call *call)
{
	const struct ec_slave *s = call->slave;
	struct ec_ioc_port *i = call->arg;
	unsigned int p = i->port;
	struct ec_behind is;

	if (p >= EC_UAPI_PORTS)
		return ec_refuse(call, -EINVAL, "a slave has ports 0 to %u, no port %u",
				 EC_UAPI_PORTS - 1, p);
	i->type = ec_slave_port_type(s, p);
	i->link_up = !!(s->dl_status & EC_DLS_LINK(p));
	i->loop_closed = !!(s->dl_status & EC_DLS_LOOP(p));
	i->signal = !!(s->dl_status & EC_DLS_COMM(p));
	i->receive_time = s->recv[p];
	i->next_slave = s->graph.at[p] ? s->graph.at[p]->position : EC_UAPI_NONE16;
	i->delay_to_next_dc = way(s, p);
	i->kept = ec_ports_kept(s, p, &i->wait_s);
	ec_line_errors_cleared(s, p, i->cleared);
	i->errors_known = ec_line_errors_seen(s, p, i->errors, &i->errors_age_ms);
	if (ec_port_text(i->kept)->device && ec_border_get(s->bus, s->device, p, &is)) {
		i->vendor_id = is.vendor;
		i->product_code = is.product;
		i->revision_number = is.revision;
		i->serial_number = is.serial;
		i->slaves = is.slaves;
		i->alias = is.alias;
		i->identification = is.identification;
		strscpy(i->name, is.name, sizeof(i->name));
	}
	return 0;
}

int ec_ioc_absent(struct ec_call *call)
{
	struct ec_master *m = call->master;
	struct ec_ioc_absent *i = call->arg;
	struct ec_absent a;
	int ret = ec_show_begin(&m->base->show);

	if (ret)
		return ret;
	ec_absent_get(&m->bus, i->index, &a);
	ec_show_end(&m->base->show);
	i->device = a.up;
	i->since_ns = a.n ? ktime_get_ns() - a.seen_ns : 0;
	i->slaves = a.n;
	i->first = a.first;
	i->last = a.last;
	i->port = a.port;
	strscpy(i->name, a.label, sizeof(i->name));
	return 0;
}

/* The nearest slave at or before this one that has an alias. */
static int slave_alias(struct ec_call *call, struct ec_ioc_slave *i)
{
	u32 steps = 0;
	int ret;

	while (ec_find_group(call->slave, &steps, &i->alias_group, &i->alias_pos) == -EAGAIN) {
		ret = ec_ioc_pause(call);
		if (ret)
			return ret;
	}
	return 0;
}

int ec_ioc_slave_names(struct ec_call *call)
{
	const struct ec_slave *s = call->slave;
	struct ec_ioc_slave_names *i = call->arg;

	strscpy(i->group, s->group, sizeof(i->group));
	strscpy(i->image, s->image, sizeof(i->image));
	strscpy(i->order, s->order, sizeof(i->order));
	strscpy(i->name, s->name, sizeof(i->name));
	return 0;
}

/* The configuration that has the slave, or that expects another one in its place; or NULL. */
static int slave_config(struct ec_call *call, const struct ec_config **config)
{
	const struct ec_session *session = call->master->sessions.session;
	unsigned int from = 0;
	int ret;

	*config = NULL;
	while (session) {
		*config = ec_config_at(&session->wanted, call->slave, &from);
		if (*config || from >= session->wanted.n_configs)
			break;
		ret = ec_ioc_pause(call);
		if (ret)
			return ret;
	}
	return 0;
}

int ec_ioc_slave_why(struct ec_call *call)
{
	struct ec_ioc_slave_why *i = call->arg;
	struct ec_slave *s = call->slave;
	const struct ec_config *c;
	int ret = slave_config(call, &c);

	if (ret)
		return ret;
	ec_slave_why(s, i->why, sizeof(i->why));
	ec_slave_cause(s, &i->cause);
	ec_slave_warning(s, i->warning, sizeof(i->warning));
	/* a slave with another revision is used nevertheless, so there is no other text */
	if (c && ec_config_differs(c, s) && !i->warning[0])
		ec_config_revision_text(c, s, i->warning, sizeof(i->warning));
	return 0;
}

static int slave_attached(struct ec_call *call, struct ec_ioc_slave *i)
{
	const struct ec_config *c;
	int ret = slave_config(call, &c);

	i->config = c ? c->index + 1 : 0;
	i->differs = c && ec_config_differs(c, call->slave);
	return ret;
}

int ec_ioc_slave(struct ec_call *call)
{
	struct ec_ioc_slave *i = call->arg;
	struct ec_slave *s = call->slave;
	const struct ec_clock *c = ec_clock_of(s);
	u16 feat = ec_slave_features(s);

	i->device = s->device;
	i->position = s->position;
	i->missing_before = ec_ring_places_of(s->bus, s->position) - s->position;
	i->device_index = s->bus->links->ring.state == EC_RING_OPEN && ec_graph_is_reversed(s);
	i->station = s->station;
	i->alias = s->alias;
	i->al_status = READ_ONCE(s->al.status);
	i->al_code = READ_ONCE(s->al.code);
	i->al_requested = READ_ONCE(s->al.requested);
	i->error = READ_ONCE(s->note.error);
	i->vendor_id = s->info.vendor;
	i->product_code = s->info.product;
	i->revision_number = s->info.revision;
	i->serial_number = s->info.serial;
	i->boot_rx_offset = s->info.boot.rx_offset;
	i->boot_rx_size = s->info.boot.rx_size;
	i->boot_tx_offset = s->info.boot.tx_offset;
	i->boot_tx_size = s->info.boot.tx_size;
	i->std_rx_offset = s->info.std.rx_offset;
	i->std_rx_size = s->info.std.rx_size;
	i->std_tx_offset = s->info.std.tx_offset;
	i->std_tx_size = s->info.std.tx_size;
	i->mbox_protocols = s->info.protocols;
	i->fmmu_bit = !(feat & EC_FEAT_NO_BIT_FMMU);
	i->dc_supported = !(feat & EC_FEAT_DC) ? 0 : feat & EC_FEAT_DC64 ? 2 : 1;
	i->dc_delay_only = READ_ONCE(s->delay_only);
	i->transmission_delay = c->delay;
	i->dc_offset = c->offset;
	i->dc_diff = READ_ONCE(c->diff);
	i->dc_set = ec_clock_is_set(s);
	i->dc_odd = i->dc_supported &&
		    (READ_ONCE(c->delay_unreliable) || READ_ONCE(s->graph.inconsistent));
	i->features = feat;
	i->identification = READ_ONCE(s->identification);
	i->sm_count = s->n_sms;
	i->fmmu_count = s->regs[EC_REG_FMMUS];
	i->dl_status = s->dl_status;
	i->sii_words = s->eeprom.bytes / 2;
	i->has_general = s->has_general;
	i->coe_details = s->general.coe;
	i->general_flags = s->general.flags;
	i->foe_details = s->general.foe;
	i->current_ma = s->general.current_ma;
	return slave_alias(call, i) ?: slave_attached(call, i);
}

int ec_ioc_sm(struct ec_call *call)
{
	struct ec_ioc_sm *i = call->arg;
	struct ec_slave *s = call->slave;

	if (i->sm >= s->n_sms)
		return ec_refuse(call, -EINVAL, "slave %u has %u SyncManagers, not %u",
				 s->position, s->n_sms, i->sm + 1);
	i->start = s->sms[i->sm].start;
	i->default_size = s->sms[i->sm].len;
	i->control = s->sms[i->sm].control;
	i->enable = s->sms[i->sm].enable;
	i->type = s->sms[i->sm].type;
	i->pdo_count = READ_ONCE(s->pdos.sm[i->sm].n);
	return 0;
}

/*
 * Copies a PDO and, with @entry_pos, the entry there; without, @e names the PDO. @name is from
 * the EEPROM, or else from the object dictionary.
 */
static int get_pdo(struct ec_call *call, u8 sm, u16 pos, const u16 *entry_pos, struct ec_pdo *p,
		   struct ec_pdo_entry *e, char *name)
{
	const struct ec_slave *s = call->slave;
	int ret = ec_show_begin(&call->master->base->show);

	if (ret)
		return ret;
	if (sm >= s->n_sms || pos >= s->pdos.sm[sm].n) {
		ret = ec_refuse(call, -EINVAL, "slave %u has no PDO %u at SM%u", s->position, pos,
				sm);
		goto out;
	}
	*p = s->pdos.sm[sm].pdos[pos];
	if (entry_pos && *entry_pos >= p->n_entries) {
		ret = ec_refuse(call, -EINVAL, "PDO 0x%04x has %u entries, not %u", p->index,
				p->n_entries, *entry_pos + 1);
		goto out;
	}
	*e = entry_pos ? p->entries[*entry_pos] :
			 (struct ec_pdo_entry){ .index = p->index, .name = p->name };
	strscpy(name, e->name ? "" : ec_names_find(s, e->index, entry_pos ? e->sub :
								EC_NAME_OBJECT), EC_UAPI_STRING);
out:
	ec_show_end(&call->master->base->show);
	/* outside of the section, as an EEPROM may have many strings */
	if (!ret && e->name &&
	    ec_sii_string(s->eeprom.data, s->eeprom.bytes, e->name, name, EC_UAPI_STRING) < 0)
		name[0] = '\0';
	return ret;
}

int ec_ioc_pdo(struct ec_call *call)
{
	struct ec_ioc_pdo *i = call->arg;
	struct ec_pdo_entry e;
	struct ec_pdo p;
	int ret = get_pdo(call, i->sm, i->pdo_pos, NULL, &p, &e, i->name);

	if (ret)
		return ret;
	i->index = p.index;
	i->entry_count = p.n_entries;
	return 0;
}

int ec_ioc_pdo_entry(struct ec_call *call)
{
	struct ec_ioc_pdo_entry *i = call->arg;
	struct ec_pdo_entry e;
	struct ec_pdo p;
	int ret = get_pdo(call, i->sm, i->pdo_pos, &i->entry_pos, &p, &e, i->name);

	if (ret)
		return ret;
	i->index = e.index;
	i->subindex = e.sub;
	i->bits = e.bits;
	return 0;
}

int ec_ioc_sii(struct ec_call *call)
{
	struct ec_ioc_sii *i = call->arg;
	struct ec_slave *s = call->slave;

	i->size = i->offset < s->eeprom.bytes ? min(call->size, s->eeprom.bytes - i->offset) : 0;
	memcpy(call->data, s->eeprom.data + i->offset, i->size);
	return 0;
}

int ec_ioc_cycle_stats(struct ec_call *call)
{
	struct ec_ioc_cycle_stats *i = call->arg;
	struct ec_status_cycle *st = kzalloc(sizeof(*st), GFP_KERNEL_ACCOUNT);
	int ret;

	if (!st)
		return -ENOMEM;
	ret = ec_show_begin(&call->master->base->show);
	if (!ret) {
		ec_cycle_stats_get(&call->master->cycles, i, st);
		ec_show_end(&call->master->base->show);
	}
	i->size = call->size;
	memcpy(call->data, st, call->size);
	kfree(st);
	return ret;
}

int ec_ioc_cycle_reset(struct ec_call *call)
{
	ec_sessions_lock(&call->master->sessions);
	ec_cycle_stats_reset(&call->master->cycles);
	ec_sessions_unlock(&call->master->sessions);
	return 0;
}
