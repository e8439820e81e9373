// SPDX-License-Identifier: GPL-2.0-only
/* Scripted faults. */
#include "../../master/wire/al.h"
#include "esc_int.h"

static const char * const fault_names[EC_SIM_FAULT_TYPES] = {
	[EC_SIM_FAULT_CUT] = "cut",
	[EC_SIM_FAULT_HEAL] = "heal",
	[EC_SIM_FAULT_POWER_OFF] = "power_off",
	[EC_SIM_FAULT_POWER_ON] = "power_on",
	[EC_SIM_FAULT_LOSE] = "lose",
	[EC_SIM_FAULT_DUPLICATE] = "duplicate",
	[EC_SIM_FAULT_DELAY] = "delay",
	[EC_SIM_FAULT_MANGLE] = "mangle",
	[EC_SIM_FAULT_REFUSE_AL] = "refuse_al",
	[EC_SIM_FAULT_EEPROM_BUSY] = "eeprom_busy",
	[EC_SIM_FAULT_EEPROM_NOACK] = "eeprom_noack",
	[EC_SIM_FAULT_MISS_BROADCAST] = "miss_broadcast",
	[EC_SIM_FAULT_DEAD] = "dead",
	[EC_SIM_FAULT_WKC] = "wkc",
	[EC_SIM_FAULT_MUTE] = "mute",
	[EC_SIM_FAULT_ERRORS] = "errors",
	[EC_SIM_FAULT_MAILBOX] = "mailbox",
	[EC_SIM_FAULT_LATCH] = "latch",
	[EC_SIM_FAULT_AL_ERROR] = "al_error",
	[EC_SIM_FAULT_EEPROM] = "eeprom",
	[EC_SIM_FAULT_INPUT] = "input",
	[EC_SIM_FAULT_EMERGENCY] = "emergency",
	[EC_SIM_FAULT_JUMP] = "jump",
	[EC_SIM_FAULT_PLUG] = "plug",
	[EC_SIM_FAULT_UNPLUG] = "unplug",
	[EC_SIM_FAULT_SWAP] = "swap",
	[EC_SIM_FAULT_OLD] = "old",
	[EC_SIM_FAULT_BOUNCE] = "bounce",
	[EC_SIM_FAULT_HOST] = "host",
	[EC_SIM_FAULT_DAMAGE] = "damage",
	[EC_SIM_FAULT_EOE] = "eoe",
	[EC_SIM_FAULT_DRIVE] = "drive",
};

/**
 * ec_sim_fault_name() - name of a fault
 * @type: which
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the name, NULL for an unknown type.
 */
const char *ec_sim_fault_name(enum ec_sim_fault_type type)
{
	return (u32)type < EC_SIM_FAULT_TYPES ? fault_names[type] : NULL;
}

int ec_sim_faults_init(struct ec_sim *sim)
{
	int i;

	sim->fault = sim->ops.alloc(EC_SIM_MAX_FAULTS * sizeof(*sim->fault));
	if (!sim->fault)
		return -ENOMEM;
	for (i = 0; i < EC_SIM_MAX_FAULTS; i++)
		sim->fault[i].next = i + 1 < EC_SIM_MAX_FAULTS ? i + 1 : -1;
	sim->fault_free = 0;
	sim->fault_due = -1;
	sim->fault_frame = -1;
	sim->fault_wait = -1;
	return 0;
}

/* two different ports, or slaves */
static bool can_swap(const struct ec_sim *sim, const struct ec_sim_fault *f)
{
	int slave = (int)f->arg, port = (int)f->arg2;

	if (f->port == EC_SIM_ALL_PORTS)
		return f->slave != slave && f->slave >= 0 && f->slave < (int)sim->count &&
		       slave >= 0 && slave < (int)sim->count;
	return ec_sim_has_port(sim, f->slave, f->port) && ec_sim_has_port(sim, slave, port) &&
	       (f->slave != slave || (slave >= 0 && f->port != port));
}

/* not both of them at the master */
static bool can_plug(const struct ec_sim *sim, const struct ec_sim_fault *f)
{
	return f->port != EC_SIM_ALL_PORTS && can_swap(sim, f) &&
	       (f->slave >= 0 || (int)f->arg >= 0);
}

static bool is_valid(const struct ec_sim *sim, const struct ec_sim_fault *f)
{
	bool cable = f->type == EC_SIM_FAULT_CUT || f->type == EC_SIM_FAULT_HEAL ||
		     f->type == EC_SIM_FAULT_UNPLUG || f->type == EC_SIM_FAULT_BOUNCE;

	if ((u32)f->type >= EC_SIM_FAULT_TYPES || (u32)f->when > EC_SIM_WHEN_BACK)
		return false;
	if (f->type == EC_SIM_FAULT_PLUG)
		return can_plug(sim, f);
	if (f->type == EC_SIM_FAULT_SWAP)
		return can_swap(sim, f);
	if (ec_sim_fault_of_frame(f->type))
		return f->port >= -1 && f->port < EC_SIM_PORTS && !f->frame;
	if (f->type == EC_SIM_FAULT_BOUNCE &&
	    (!f->arg || !(f->arg2 % EC_SIM_BOUNCE_BITS) || f->arg2 < EC_SIM_BOUNCE_BITS ||
	     f->arg2 / EC_SIM_BOUNCE_BITS > EC_SIM_BOUNCE_MAX))
		return false;
	if (cable && (f->slave == EC_SIM_MASTER0 || f->slave == EC_SIM_MASTER1))
		return true;
	if (f->slave < 0 || f->slave >= (int)sim->count)
		return false;
	if (f->type == EC_SIM_FAULT_HOST)
		return ec_sim_has_port(sim, f->slave, f->port) && !f->arg2 &&
		       f->arg <= EC_SIM_HOST_ETHERCAT &&
		       (!f->value || f->value >= EC_SIM_HOST_MIN_NS) &&
		       (!f->value || !f->arg || f->value >= EC_SIM_HOST_ETHERCAT_NS);
	if (f->type == EC_SIM_FAULT_DAMAGE)
		return ec_sim_has_port(sim, f->slave, f->port) && f->arg <= 1000000;
	if (f->type == EC_SIM_FAULT_LATCH && (f->arg > 1 || !f->arg2 || f->arg2 > 3))
		return false;
	if (f->type == EC_SIM_FAULT_OLD && f->value & EC_SIM_OLD_STATE &&
	    !ec_al_state_valid((u8)f->arg2))
		return false;
	if (f->type == EC_SIM_FAULT_MAILBOX && f->arg >= EC_SIM_MAILBOX_FAULTS)
		return false;
	if (f->type == EC_SIM_FAULT_EOE && f->arg >= EC_SIM_EOE_FAULTS)
		return false;
	return !(cable || f->type == EC_SIM_FAULT_ERRORS) ||
	       (f->port >= 0 && f->port < EC_MAX_PORT);
}

void ec_sim_fault_free(struct ec_sim *sim, int i)
{
	sim->fault[i].next = sim->fault_free;
	sim->fault_free = i;
}

/* into the list of those that wait, behind those of the same time */
void ec_sim_fault_queue(struct ec_sim *sim, int i)
{
	int *at = &sim->fault_due;

	while (*at >= 0 && sim->fault[*at].f.at_ns <= sim->fault[i].f.at_ns)
		at = &sim->fault[*at].next;
	sim->fault[i].next = *at;
	*at = i;
}

/**
 * ec_sim_add_fault() - script a fault
 * @sim: segment
 * @fault: what, where, when; copied
 *
 * Faults of the same time happen in the order they were added.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EINVAL for an unknown type, slave or port, -ENOSPC when 1024
 * are waiting or active.
 */
int ec_sim_add_fault(struct ec_sim *sim, const struct ec_sim_fault *fault)
{
	int i = sim->fault_free;

	if (!is_valid(sim, fault))
		return -EINVAL;
	if (i < 0)
		return -ENOSPC;
	sim->fault_free = sim->fault[i].next;
	sim->fault[i].f = *fault;
	sim->fault[i].seen = 0;
	ec_sim_fault_queue(sim, i);
	return 0;
}

static void forget(struct ec_sim *sim, int *list)
{
	while (*list >= 0) {
		int i = *list;

		*list = sim->fault[i].next;
		ec_sim_fault_free(sim, i);
	}
}

/**
 * ec_sim_clear_faults() - forget what is scripted, end what misbehaves
 * @sim: segment
 *
 * Cut cables stay cut, slaves without power stay so.
 *
 * Context: Any. RT-safe: bounded by the slaves, no sleep, no allocation.
 */
void ec_sim_clear_faults(struct ec_sim *sim)
{
	int *list[] = { &sim->fault_due, &sim->fault_frame, &sim->fault_wait };
	struct ec_sim_flight *fl;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(list); i++)
		forget(sim, list[i]);
	for (fl = sim->flights; fl; fl = fl->next)
		forget(sim, &fl->faults);
	for (i = 0; i < sim->count; i++) {
		ec_esc_settle(sim->esc[i]);
		memset(&sim->esc[i]->fault, 0, sizeof(sim->esc[i]->fault));
		ec_esc_quick_forget(sim->esc[i]);
	}
	sim->damages = false;
}

u64 ec_sim_faults_next(const struct ec_sim *sim)
{
	return sim->fault_due < 0 ? EC_ESC_NEVER :
				    sim->fault[sim->fault_due].f.at_ns;
}

static void damage(struct ec_sim *sim, const struct ec_sim_fault *f)
{
	sim->esc[f->slave]->fault.damage_ppm[f->port] = f->arg;
	sim->damages = false;
	for (u32 i = 0; i < sim->count; i++)
		for (int p = 0; p < EC_MAX_PORT; p++)
			sim->damages |= sim->esc[i]->fault.damage_ppm[p];
}

static void tell_app(struct ec_esc *esc, const struct ec_sim_fault *f, u64 now)
{
	if (esc->app_ops && esc->app_ops->fault && esc->powered && esc->eep.loaded)
		esc->app_ops->fault(esc, f, now);
}

static void strike(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	struct ec_esc *esc = f->slave >= 0 ? sim->esc[f->slave] : NULL;
	u8 *count;

	if (esc) {
		ec_esc_settle(esc);
		ec_esc_quick_forget(esc);
	}
	switch (f->type) {
	case EC_SIM_FAULT_CUT:
	case EC_SIM_FAULT_HEAL:
		ec_sim_cut(sim, f->slave, f->port,
			   f->type == EC_SIM_FAULT_CUT, now);
		break;
	case EC_SIM_FAULT_BOUNCE:
		ec_sim_cut(sim, f->slave, f->port, !(f->value & 1), now);
		break;
	case EC_SIM_FAULT_PLUG:
		ec_sim_plug(sim, f, now);
		break;
	case EC_SIM_FAULT_UNPLUG:
		ec_sim_unplug(sim, f, now);
		break;
	case EC_SIM_FAULT_SWAP:
		ec_sim_swap(sim, f, now);
		break;
	case EC_SIM_FAULT_POWER_OFF:
	case EC_SIM_FAULT_POWER_ON:
		ec_sim_power(esc, f->type == EC_SIM_FAULT_POWER_ON, now);
		break;
	case EC_SIM_FAULT_REFUSE_AL:
		esc->fault.al_refuse = (u8)f->arg;
		esc->fault.al_code = (u16)f->arg2;
		break;
	case EC_SIM_FAULT_EEPROM_BUSY:
		esc->fault.eeprom_busy = f->arg;
		break;
	case EC_SIM_FAULT_EEPROM_NOACK:
		esc->fault.eeprom_noack = f->arg;
		break;
	case EC_SIM_FAULT_MISS_BROADCAST:
		esc->fault.miss_broadcast = f->arg;
		break;
	case EC_SIM_FAULT_DEAD:
		esc->fault.dead = f->arg;
		break;
	case EC_SIM_FAULT_WKC:
		esc->fault.wkc_add = (s16)f->arg;
		break;
	case EC_SIM_FAULT_MUTE:
		esc->fault.app_mute = f->arg;
		ec_esc_wd_pdi_trigger(esc, now);
		break;
	case EC_SIM_FAULT_MAILBOX:
		esc->fault.mailbox = (u8)f->arg;
		esc->fault.mailbox_code = f->arg2;
		esc->fault.mailbox_after = (u32)f->value;
		break;
	case EC_SIM_FAULT_LATCH:
		if (f->arg2 & EC_SIM_EDGE_RISING)
			ec_esc_latch(esc, (int)f->arg, true, now);
		if (f->arg2 & EC_SIM_EDGE_FALLING)
			ec_esc_latch(esc, (int)f->arg, false, now);
		break;
	case EC_SIM_FAULT_JUMP:
		ec_esc_dc_jump(esc, (s64)f->value, now);
		break;
	case EC_SIM_FAULT_DAMAGE:
		damage(sim, f);
		break;
	case EC_SIM_FAULT_ERRORS:
		count = esc->mem + EC_REG_ERR_RX(f->port);
		*count = (u8)min_t(u64, 0xff, (u64)*count + f->arg);
		break;
	case EC_SIM_FAULT_EEPROM:
		if ((u64)f->arg * 2 + 2 <= esc->eep.len)
			put_unaligned_le16((u16)f->arg2, esc->eep.data + f->arg * 2);
		break;
	case EC_SIM_FAULT_OLD:
		if (esc->powered)
			ec_esc_old(esc, f, now);
		fallthrough;
	case EC_SIM_FAULT_AL_ERROR:
	case EC_SIM_FAULT_INPUT:
	case EC_SIM_FAULT_EMERGENCY:
	case EC_SIM_FAULT_DRIVE:
		tell_app(esc, f, now);
		break;
	case EC_SIM_FAULT_EOE:
		esc->fault.eoe = (u8)f->arg;
		esc->fault.eoe_every = f->arg2;
		tell_app(esc, f, now);
		break;
	default:
		break;
	}
}

/* the next bit of a contact that bounces; false: that was the last */
static bool bounce_on(struct ec_sim_fault *f, u64 now)
{
	u32 bits = f->arg2 % EC_SIM_BOUNCE_BITS;

	if (f->type != EC_SIM_FAULT_BOUNCE || f->arg2 < 2 * EC_SIM_BOUNCE_BITS)
		return false;
	f->arg2 -= EC_SIM_BOUNCE_BITS;
	f->value = f->value >> 1 | (f->value & 1) << (bits - 1);
	f->at_ns = now + f->arg;
	return true;
}

/* the first of the waiting faults is due */
void ec_sim_faults_run(struct ec_sim *sim, u64 now)
{
	int i = sim->fault_due;
	struct ec_sim_fault *f = &sim->fault[i].f;

	sim->fault_due = sim->fault[i].next;
	if (f->frame || ec_sim_fault_of_frame(f->type)) {
		ec_sim_fault_watch(sim, i);
		return;
	}
	strike(sim, f, now);
	if (f->type == EC_SIM_FAULT_HOST ? ec_sim_host(sim, f, now) : bounce_on(f, now))
		ec_sim_fault_queue(sim, i);
	else
		ec_sim_fault_free(sim, i);
}
