// SPDX-License-Identifier: GPL-2.0-only
#include "present.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/al.h"
#include "../master/wire/sii.h"
#include "sdo.h"

#define MODULES		0xf050	/* detected modules, slot by slot */
#define REG_SYNC	0x0980	/* up to 0x09a7: assignment, activation, start, periods */
#define REG_SYNC_SIZE	0x28

bool present_has_coe(const struct ect_slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE;
}

int present_number(struct ect_handle *h, const struct ect_slave *s, u16 index, u8 sub, u32 *v)
{
	u8 data[4] = { 0 };
	long n = ect_sdo_upload(h, s->device, index, sub, 0, 0, data, sizeof(data));

	*v = get_unaligned_le32(data);
	return n < 0 ? (int)n : 0;
}

int present_count(struct ect_handle *h, const struct ect_slave *s, u16 index, unsigned int *n)
{
	u32 v;
	int err = present_number(h, s, index, 0, &v);

	*n = err ? 0 : v;
	return err || v <= UINT8_MAX ? err : -ERANGE;
}

/* what failed at @index; the slave is not asked for more of that */
static int failed(struct ect_handle *h, struct present *l, int err, u16 index, u8 sub)
{
	u32 abort = ect_error_code(h);
	const char *reason = ect_reason(h);
	char code[32] = "";

	if (err == -ERANGE)
		reason = "more than 255 entries";
	else if (abort)
		snprintf(code, sizeof(code), "abort 0x%08x", abort);
	else if (!*reason)
		reason = strerror(-err);
	snprintf(l->why, sizeof(l->why), "0x%04x:%02x: %s", index, sub, *code ? code : reason);
	return err;
}

static bool is_absent(struct ect_handle *h, int err)
{
	u32 abort = err ? ect_error_code(h) : 0;

	return abort == SDO_NO_OBJECT || abort == SDO_NO_SUBINDEX;
}

/* an older dictionary has no names; a slave that does not answer is no slave to ask again */
static int read_name(struct ect_handle *h, const struct present *l, struct present_entry *to)
{
	struct ect_entry e = { .struct_size = sizeof(e) };
	u16 index = (u16)(to->map >> 16);
	int err;

	if (!index || !(l->wish & PRESENT_NAMES) || !(l->s->coe_details & EC_SII_COE_SDO_INFO))
		return 0;
	err = ect_entry_read(h, l->s->device, index, (u8)(to->map >> 8), 0, 0, &e);
	if (err == -ETIMEDOUT || err == -ENODEV)
		return err;
	if (!err && e.bits == (to->map & UINT8_MAX))
		to->type = e.type;
	if (!err)
		snprintf(to->name, sizeof(to->name), "%s", e.name);
	return 0;
}

static int read_pdo_name(struct ect_handle *h, const struct present *l, struct present_pdo *p)
{
	struct ect_object o = { .struct_size = sizeof(o) };
	int err;

	if (!(l->wish & PRESENT_NAMES) || !(l->s->coe_details & EC_SII_COE_SDO_INFO))
		return 0;
	err = ect_object_read(h, l->s->device, p->index, 0, &o);
	if (!err)
		snprintf(p->name, sizeof(p->name), "%s", o.name);
	return err == -ETIMEDOUT || err == -ENODEV ? err : 0;
}

static int read_mapping(struct ect_handle *h, struct present *l, struct present_pdo *p)
{
	unsigned int n;
	int err = present_count(h, l->s, p->index, &n);

	/* assigned, and the slave does not have it */
	if (is_absent(h, err))
		return 0;
	if (err)
		return failed(h, l, err, p->index, 0);
	p->entries = calloc(n + 1, sizeof(*p->entries));
	if (!p->entries)
		return -ENOMEM;
	for (unsigned int i = 0; i < n; i++) {
		err = present_number(h, l->s, p->index, (u8)(i + 1), &p->entries[i].map);
		if (!err)
			err = read_name(h, l, &p->entries[i]);
		if (err)
			return failed(h, l, err, p->index, (u8)(i + 1));
		p->n++;
	}
	err = read_pdo_name(h, l, p);
	return err ? failed(h, l, err, p->index, 0) : 0;
}

static int read_assignment(struct ect_handle *h, struct present *l, u8 sm)
{
	u16 object = (u16)(PRESENT_SM_ASSIGN + sm);
	unsigned int n;
	int err = present_count(h, l->s, object, &n);
	struct present_pdo *grown;
	u32 v;

	if (is_absent(h, err))
		return 0;
	if (err)
		return failed(h, l, err, object, 0);
	l->sms |= 1u << sm;
	grown = realloc(l->pdos, (l->n + n + 1) * sizeof(*grown));
	if (!grown)
		return -ENOMEM;
	l->pdos = grown;
	for (unsigned int i = 0; i < n; i++) {
		err = present_number(h, l->s, object, (u8)(i + 1), &v);
		if (err)
			return failed(h, l, err, object, (u8)(i + 1));
		/* an entry of 0 is not in use */
		if (!(u16)v)
			continue;
		l->pdos[l->n] = (struct present_pdo){ .index = (u16)v, .sm = sm };
		err = read_mapping(h, l, &l->pdos[l->n++]);
		if (err)
			return err;
	}
	return 0;
}

static int read_pdos(struct ect_handle *h, struct present *l)
{
	int err = 0;

	for (u8 sm = PRESENT_FIRST_SM; sm < l->s->sm_count && sm < 16 && !err; sm++)
		err = read_assignment(h, l, sm);
	return err;
}

/* slots that are empty have 0; a slave that is not modular has no such object */
static int read_modules(struct ect_handle *h, struct present *l)
{
	unsigned int n;
	int err = present_count(h, l->s, MODULES, &n);

	if (is_absent(h, err))
		return 0;
	if (err)
		return failed(h, l, err, MODULES, 0);
	for (unsigned int slot = 1; slot <= n && !err; slot++) {
		err = present_number(h, l->s, MODULES, (u8)slot, &l->idents[slot]);
		/* some slaves have no subindex of an empty slot */
		if (is_absent(h, err))
			err = 0;
		if (err)
			failed(h, l, err, MODULES, (u8)slot);
	}
	l->slots = n;
	return err;
}

static int read_values(struct ect_handle *h, struct present *l)
{
	u8 *buf = malloc(ECT_SDO_MAX);
	int err = buf ? 0 : -ENOMEM;

	for (size_t i = 0; i < l->value_count && !err; i++) {
		struct present_value *v = &l->values[i];
		long n = ect_sdo_upload(h, l->s->device, (u16)(v->object >> 8), (u8)v->object,
					v->complete ? ECT_SDO_COMPLETE : 0, 0, buf, ECT_SDO_MAX);

		/* refused: write-only, or not in this state */
		if (n == -EIO && ect_error_code(h))
			continue;
		if (n < 0) {
			err = failed(h, l, (int)n, (u16)(v->object >> 8), (u8)v->object);
			break;
		}
		v->data = calloc(1, (size_t)n + 1);
		if (!v->data) {
			err = -ENOMEM;
			break;
		}
		memcpy(v->data, buf, (size_t)n);
		v->size = (size_t)n;
	}
	free(buf);
	return err;
}

static int read_clock(struct ect_handle *h, struct present *l)
{
	u8 data[REG_SYNC_SIZE];
	int err;

	if (!l->s->dc_supported || l->s->dc_delay_only)
		return 0;
	err = ect_reg_read(h, l->s->device, REG_SYNC, data, sizeof(data));
	if (err) {
		snprintf(l->why, sizeof(l->why), "register 0x%04x: %s", REG_SYNC, ect_reason(h));
		return err;
	}
	/* activation without SYNC0 and SYNC1 is none */
	if (data[1] & 1 && data[1] & 6) {
		l->assign_activate = get_unaligned_le16(data);
		l->sync[0] = get_unaligned_le32(data + 0x20);
		l->sync[1] = get_unaligned_le32(data + 0x24);
	}
	return 0;
}

static const struct {
	unsigned int wish;
	bool coe;
	int (*read)(struct ect_handle *h, struct present *l);
} parts[] = {
	{ PRESENT_CLOCK, false, read_clock },
	{ PRESENT_MODULES, true, read_modules },
	{ PRESENT_PDOS, true, read_pdos },
	{ PRESENT_VALUES, true, read_values },
};

static bool has_mailbox(const struct ect_slave *s)
{
	unsigned int state = s->al_status & 0x0f;

	return state == EC_AL_PREOP || state == EC_AL_SAFEOP || state == EC_AL_OP;
}

/**
 * present_read() - read what is wished of a slave
 * @h: master, open for writing
 * @l: @s, @wish and the objects of @values are set; to be freed with present_free()
 *
 * What a slave without CoE does not have is known. After a part that it refuses the others follow;
 * a slave that does not answer is asked no more, so that it costs one time limit.
 */
void present_read(struct ect_handle *h, struct present *l)
{
	for (unsigned int i = 0; i < ARRAY_SIZE(parts); i++) {
		int err = 0;

		if (!(l->wish & parts[i].wish))
			continue;
		if (parts[i].coe && present_has_coe(l->s) && !has_mailbox(l->s)) {
			snprintf(l->why, sizeof(l->why), "no mailbox in this AL state");
			continue;
		}
		if (!parts[i].coe || present_has_coe(l->s))
			err = parts[i].read(h, l);
		if (!err)
			l->known |= parts[i].wish;
		else if (!*l->why)
			snprintf(l->why, sizeof(l->why), "%s", strerror(-err));
		if (err == -ETIMEDOUT || err == -ENODEV)
			break;
	}
}

void present_free(struct present *l)
{
	for (size_t i = 0; i < l->n; i++)
		free(l->pdos[i].entries);
	for (size_t i = 0; i < l->value_count; i++)
		free(l->values[i].data);
	free(l->pdos);
	free(l->values);
}
