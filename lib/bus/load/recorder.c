// SPDX-License-Identifier: LGPL-2.1-or-later
/* A master that only writes down what it is configured with. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "recorder.h"

static uint8_t *extend(struct record *r, size_t size)
{
	size_t room = r->room ? r->room : 4096;
	uint8_t *more;

	while (room - r->size < size)
		room *= 2;
	if (!r->failed && room != r->room) {
		more = realloc(r->data, room);
		r->failed = !more;
		if (more) {
			r->data = more;
			r->room = room;
		}
	}
	if (r->failed)
		return NULL;
	r->size += size;
	return r->data + r->size - size;
}

void record_bytes(struct record *r, const void *data, size_t size)
{
	uint8_t *p = extend(r, size);

	if (p && size)
		memcpy(p, data, size);
}

void record_u8(struct record *r, uint8_t v)
{
	record_bytes(r, &v, sizeof(v));
}

void record_u16(struct record *r, uint16_t v)
{
	uint8_t le[2];

	put_unaligned_le16(v, le);
	record_bytes(r, le, sizeof(le));
}

void record_u32(struct record *r, uint32_t v)
{
	uint8_t le[4];

	put_unaligned_le32(v, le);
	record_bytes(r, le, sizeof(le));
}

void record_u64(struct record *r, uint64_t v)
{
	uint8_t le[8];

	put_unaligned_le64(v, le);
	record_bytes(r, le, sizeof(le));
}

void record_text(struct record *r, const char *text)
{
	size_t size = strlen(text) + 1;

	record_u16(r, (uint16_t)size);
	record_bytes(r, text, size);
}

void record_begin(struct record *r, uint16_t op)
{
	record_u16(r, op);
	record_u16(r, 0);
	record_u32(r, 0);
	r->body = r->size;
	r->n++;
}

int record_end(struct record *r)
{
	if (!r->failed)
		put_unaligned_le32((uint32_t)(r->size - r->body), r->data + r->body - 4);
	record_bytes(r, "\0\0\0", -r->size & 3);
	return r->failed ? -ENOMEM : 0;
}

void record_start(struct record *r)
{
	record_bytes(r, EC_COMPILED_MAGIC, sizeof(EC_COMPILED_MAGIC));
	record_u16(r, EC_COMPILED_VERSION);
	record_u16(r, 0);
	record_u32(r, 0);
	record_u32(r, 0);
	record_u32(r, 0);
}

int record_finish(struct record *r)
{
	size_t at = EC_COMPILED_CRC_AT;

	if (r->failed)
		return -ENOMEM;
	if (r->size > EC_COMPILED_MAX)
		return -EFBIG;
	put_unaligned_le32((uint32_t)r->size, r->data + at - 4);
	put_unaligned_le32(r->n, r->data + at + 4);
	put_unaligned_le32(ec_compiled_crc(r->data + at + 4, r->size - at - 4), r->data + at);
	return 0;
}

void record_free(struct record *r)
{
	while (r->handles) {
		struct record_handle *h = r->handles;

		r->handles = h->next;
		free(h);
	}
	free(r->data);
}

/* --- handles ------------------------------------------------------------------ */

static struct record *record_of(const void *handle)
{
	return ((const struct record_handle *)handle)->to;
}

uint32_t record_number(const void *handle)
{
	return ((const struct record_handle *)handle)->number;
}

static void *make_handle(struct record *r, uint32_t *n)
{
	struct record_handle *h = malloc(sizeof(*h));

	if (!h || r->failed) {
		free(h);
		r->failed = true;
		errno = ENOMEM;
		return NULL;
	}
	*h = (struct record_handle){ .next = r->handles, .to = r, .number = (*n)++ };
	r->handles = h;
	return h;
}

/* begin a record about a slave */
static struct record *about(ec_slave_config_t *sc, uint16_t op)
{
	struct record *r = record_of(sc);

	record_begin(r, op);
	record_u32(r, record_number(sc));
	return r;
}

/* --- the calls ----------------------------------------------------------------- */

static ec_domain_t *rec_create_domain(ec_master_t *m)
{
	struct record *r = (struct record *)m;

	record_begin(r, EC_COMPILED_DOMAIN);
	record_end(r);
	return make_handle(r, &r->n_domains);
}

static int rec_unit(ec_master_t *m, const ec_unit_config_t *c)
{
	struct record *r = (struct record *)m;
	int ret;

	record_begin(r, EC_COMPILED_UNIT);
	record_text(r, c->name);
	record_u32(r, (uint32_t)c->policy);
	record_u32(r, c->limit);
	record_u32(r, c->lease_cycles);
	record_u32(r, c->repeats);
	record_u32(r, c->flags);
	ret = record_end(r);
	return ret ? ret : (int)r->n_units++;
}

static int rec_set_unit(ec_domain_t *d, int number)
{
	struct record *r = record_of(d);

	record_begin(r, EC_COMPILED_DOMAIN_UNIT);
	record_u32(r, record_number(d));
	record_u32(r, (uint32_t)number);
	return record_end(r);
}

static ec_slave_config_t *rec_slave(ec_master_t *m, uint16_t alias, uint16_t position,
				uint32_t vendor, uint32_t product)
{
	struct record *r = (struct record *)m;

	record_begin(r, EC_COMPILED_SLAVE);
	record_u16(r, alias);
	record_u16(r, position);
	record_u32(r, vendor);
	record_u32(r, product);
	record_end(r);
	return make_handle(r, &r->n_slaves);
}

static int rec_group(ec_master_t *m, const ec_group_info_t *g)
{
	struct record *r = (struct record *)m;
	int ret;

	record_begin(r, EC_COMPILED_GROUP);
	record_text(r, g->name);
	record_u8(r, (uint8_t)g->by);
	record_u8(r, g->port);
	record_u16(r, g->value);
	record_u32(r, g->at ? record_number(g->at) : EC_COMPILED_NONE);
	record_u32(r, g->flags);
	ret = record_end(r);
	return ret ? ret : (int)r->n_groups++;
}

static ec_slave_config_t *rec_member(ec_master_t *m, unsigned int number, uint16_t position,
				 uint32_t vendor, uint32_t product)
{
	struct record *r = (struct record *)m;

	record_begin(r, EC_COMPILED_MEMBER);
	record_u32(r, number);
	record_u16(r, position);
	record_u16(r, 0);
	record_u32(r, vendor);
	record_u32(r, product);
	record_end(r);
	return make_handle(r, &r->n_slaves);
}

static int rec_flag(ec_slave_config_t *sc, const char *key, int32_t value)
{
	struct record *r = about(sc, EC_COMPILED_FLAG);

	record_text(r, key);
	record_u32(r, (uint32_t)value);
	return record_end(r);
}

static int rec_any_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, bool complete,
		   const uint8_t *data, size_t size)
{
	struct record *r = about(sc, EC_COMPILED_SDO);

	record_u16(r, index);
	record_u8(r, subindex);
	record_u8(r, complete);
	record_bytes(r, data, size);
	return record_end(r);
}

static int rec_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, const uint8_t *data,
	       size_t size)
{
	return rec_any_sdo(sc, index, subindex, false, data, size);
}

static int rec_complete_sdo(ec_slave_config_t *sc, uint16_t index, const uint8_t *data, size_t size)
{
	return rec_any_sdo(sc, index, 0, true, data, size);
}

static int rec_sdo32(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, uint32_t value)
{
	uint8_t le[4];

	put_unaligned_le32(value, le);
	return rec_any_sdo(sc, index, subindex, false, le, sizeof(le));
}

static int rec_idn(ec_slave_config_t *sc, uint8_t drive, uint16_t number, ec_al_state_t state,
	       const uint8_t *data, size_t size)
{
	struct record *r = about(sc, EC_COMPILED_IDN);

	record_u16(r, number);
	record_u8(r, drive);
	record_u8(r, (uint8_t)state);
	record_bytes(r, data, size);
	return record_end(r);
}

static int rec_command(ec_slave_config_t *sc, ec_step_t step, const ec_command_t *c)
{
	struct record *r = about(sc, EC_COMPILED_COMMAND);

	record_u8(r, (uint8_t)step);
	record_u8(r, (uint8_t)c->kind);
	record_u16(r, c->index);
	record_u8(r, c->subindex);
	record_u8(r, c->complete);
	record_u8(r, c->expect ? 2 : 1);
	record_u8(r, 0);
	record_bytes(r, c->expect ? c->expect : c->data, c->size);
	return record_end(r);
}

static int rec_state_timeout(ec_slave_config_t *sc, ec_al_state_t from, ec_al_state_t to,
			 unsigned int ms)
{
	struct record *r = about(sc, EC_COMPILED_TIMEOUT);

	record_u8(r, (uint8_t)from);
	record_u8(r, (uint8_t)to);
	record_u16(r, 0);
	record_u32(r, ms);
	return record_end(r);
}

static int rec_sdo_timeout(ec_slave_config_t *sc, unsigned int ms)
{
	struct record *r = about(sc, EC_COMPILED_REPLY);

	record_u32(r, ms);
	return record_end(r);
}

/* a bus file has no shift of SYNC1 */
static int rec_dc(ec_slave_config_t *sc, uint16_t assign, uint32_t sync0, int32_t shift0,
	      uint32_t sync1, int32_t shift1)
{
	struct record *r = about(sc, EC_COMPILED_DC);

	(void)shift1;
	record_u16(r, assign);
	record_u16(r, 0);
	record_u32(r, sync0);
	record_u32(r, (uint32_t)shift0);
	record_u32(r, sync1);
	return record_end(r);
}

static void rec_pdo(struct record *r, const ec_pdo_info_t *p)
{
	record_u16(r, p->index);
	record_u16(r, (uint16_t)p->n_entries);
	for (unsigned int i = 0; i < p->n_entries; i++) {
		record_u16(r, p->entries[i].index);
		record_u8(r, p->entries[i].subindex);
		record_u8(r, p->entries[i].bit_length);
	}
}

static int rec_pdos(ec_slave_config_t *sc, unsigned int n, const ec_sync_info_t syncs[])
{
	struct record *r = about(sc, EC_COMPILED_PDOS);

	for (unsigned int i = 0; i < n; i++) {
		const ec_sync_info_t *s = &syncs[i];

		record_u8(r, s->index);
		record_u8(r, (uint8_t)s->dir);
		record_u16(r, (uint16_t)s->n_pdos);
		for (unsigned int k = 0; k < s->n_pdos; k++)
			rec_pdo(r, &s->pdos[k]);
	}
	return record_end(r);
}

/* @entry is the first one; offsets of values count from it on */
static int rec_reg(ec_slave_config_t *sc, uint8_t sm, unsigned int pos, unsigned int entry,
	       ec_domain_t *d, unsigned int *bit)
{
	struct record *r = about(sc, EC_COMPILED_PLACE);
	int ret;

	(void)entry;
	record_u32(r, record_number(d));
	record_u8(r, sm);
	record_u8(r, 0);
	record_u16(r, (uint16_t)pos);
	ret = record_end(r);
	r->n_places++;
	*bit = 0;
	return ret;
}

static int rec_rest(ec_slave_config_t *sc, ec_domain_t *d)
{
	struct record *r = about(sc, EC_COMPILED_REST);

	record_u32(r, record_number(d));
	return record_end(r);
}

static int rec_reference_clock(ec_master_t *m, ec_slave_config_t *sc)
{
	(void)m;
	return record_end(about(sc, EC_COMPILED_CLOCK));
}

/* compile.c writes the cycle in ns */
static int rec_interval(ec_master_t *m, size_t us)
{
	(void)m;
	(void)us;
	return 0;
}

static int rec_names(ec_master_t *m, const char *text, size_t size)
{
	struct record *r = (struct record *)m;

	record_begin(r, EC_COMPILED_NAMES);
	record_bytes(r, text, size);
	return record_end(r);
}

const struct load_calls load_record = {
	.create_domain = rec_create_domain,
	.unit = rec_unit,
	.set_unit = rec_set_unit,
	.slave = rec_slave,
	.group = rec_group,
	.member = rec_member,
	.flag = rec_flag,
	.sdo = rec_sdo,
	.complete_sdo = rec_complete_sdo,
	.sdo32 = rec_sdo32,
	.idn = rec_idn,
	.command = rec_command,
	.state_timeout = rec_state_timeout,
	.sdo_timeout = rec_sdo_timeout,
	.dc = rec_dc,
	.pdos = rec_pdos,
	.reg = rec_reg,
	.rest = rec_rest,
	.reference_clock = rec_reference_clock,
	.interval = rec_interval,
	.names = rec_names,
};
