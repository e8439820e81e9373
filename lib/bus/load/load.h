/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files that apply a bus share. */
#ifndef ECB_LOAD_INTERNAL_H
#define ECB_LOAD_INTERNAL_H

#include "../internal.h"
#include "../../../include/ethercat-bus/load.h"

/**
 * struct plan - a slave of the file
 * @s: it
 * @there: slave of the machine, NULL: absent
 * @position: of @there in the ring
 * @ring: @position without slaves of groups and those behind them
 * @group: number of its hot connect group in the file, or -1
 * @omitted: it gets no configuration
 * @pdos: what it gets, in the order of the file; PDOs without entries are those of @there
 * @n_pdos: how many
 * @sc: configuration
 * @config: its number
 */
struct plan {
	const struct ecb_slave *s;
	const struct ecb_slave *there;
	size_t position;
	size_t ring;
	long group;
	bool omitted;
	const struct ecb_pdo **pdos;
	size_t n_pdos;
	ec_slave_config_t *sc;
	size_t config;
};

/**
 * struct load - one call of ecrt_master_load_bus()
 * @m: master
 * @how: arguments
 * @file: name for messages
 * @e: result of a failure
 * @want: master of the file
 * @found: slaves of the machine
 * @read: memory of @found if it was read here, else NULL
 * @plans: for each slave of the file
 * @n_configs: configurations so far
 * @domains: for each sync unit, then the one without
 * @to: result
 */
struct load {
	ec_master_t *m;
	const struct ecb_load *how;
	const char *file;
	struct ecb_error *e;
	const struct ecb_master *want;
	const struct ecb_master *found;
	struct ecb_bus *read;
	struct plan *plans;
	size_t n_configs;
	ec_domain_t **domains;
	struct loaded *to;
};

#define BAD(l, line, ...)	ecb_report((l)->e, (l)->file, line, 0, __VA_ARGS__)

int load_no_memory(struct load *l);
/* a call of ecrt.h failed with @err; @what as "slave 'x': cannot configure its PDOs" */
int load_failed(struct load *l, uint32_t line, int err, const char *fmt, ...)
	__attribute__((format(printf, 4, 5)));

/* machine.c: the slaves as ecrt.h gives them */
int load_read_machine(struct load *l);
/* place.c: plans; changes nothing */
int load_place(struct load *l);
/* check.c: refuses what ecrt.h cannot do; changes nothing */
int load_check(struct load *l);
/* config.c: all of a configuration but its place */
int load_configure(struct load *l, struct plan *p);
ec_direction_t load_direction(const struct load *l, const struct plan *p, unsigned int sm);
/* time in ns, rounded up */
uint32_t load_ms(int64_t ns);

/* publish.c */
int load_publish_names(struct load *l);

/* value.c */
struct loaded *loaded_new(void);
void loaded_free(void *loaded);
void loaded_describe(struct loaded *to, uint32_t slaves, uint32_t clocks, int64_t cycle);
/* 0 or -ENOMEM */
int loaded_add(struct loaded *to, const char *slave, const struct ecb_entry *e,
	       const struct ecb_value *v);
int loaded_sort(struct loaded *to);

#endif
