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

/*
 * What configures a master: functions of ecrt.h, or what writes their arguments down. @rest
 * registers the PDOs of all SyncManagers that are not registered; NULL: the machine was asked.
 */
struct load_calls {
	ec_domain_t *(*create_domain)(ec_master_t *m);
	int (*unit)(ec_master_t *m, const ec_unit_config_t *c);
	int (*set_unit)(ec_domain_t *d, int unit);
	ec_slave_config_t *(*slave)(ec_master_t *m, uint16_t alias, uint16_t position,
				    uint32_t vendor, uint32_t product);
	int (*group)(ec_master_t *m, const ec_group_info_t *g);
	ec_slave_config_t *(*member)(ec_master_t *m, unsigned int group, uint16_t member,
				     uint32_t vendor, uint32_t product);
	int (*flag)(ec_slave_config_t *sc, const char *key, int32_t value);
	int (*sdo)(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, const uint8_t *data,
		   size_t size);
	int (*complete_sdo)(ec_slave_config_t *sc, uint16_t index, const uint8_t *data,
			    size_t size);
	int (*sdo32)(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, uint32_t value);
	int (*idn)(ec_slave_config_t *sc, uint8_t drive, uint16_t idn, ec_al_state_t state,
		   const uint8_t *data, size_t size);
	int (*command)(ec_slave_config_t *sc, ec_step_t step, const ec_command_t *c);
	int (*state_timeout)(ec_slave_config_t *sc, ec_al_state_t from, ec_al_state_t to,
			     unsigned int ms);
	int (*sdo_timeout)(ec_slave_config_t *sc, unsigned int ms);
	int (*dc)(ec_slave_config_t *sc, uint16_t assign, uint32_t sync0, int32_t shift0,
		  uint32_t sync1, int32_t shift1);
	int (*pdos)(ec_slave_config_t *sc, unsigned int n, const ec_sync_info_t syncs[]);
	int (*reg)(ec_slave_config_t *sc, uint8_t sm, unsigned int pdo, unsigned int entry,
		   ec_domain_t *d, unsigned int *bit);
	int (*rest)(ec_slave_config_t *sc, ec_domain_t *d);
	int (*reference_clock)(ec_master_t *m, ec_slave_config_t *sc);
	int (*interval)(ec_master_t *m, size_t us);
	int (*names)(ec_master_t *m, const char *text, size_t size);
};

/**
 * struct load - one call of ecrt_master_load_bus()
 * @m: master
 * @calls: what configures it
 * @offline: there is no machine, only the file; @m is of @calls
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
	const struct load_calls *calls;
	bool offline;
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
/* load.c: of @how, @m, @calls and @e; all but what is kept for ecrt_master_value() */
int load_begin(struct load *l);
int load_apply(struct load *l);
void load_end(struct load *l);
/* place.c: plans; changes nothing */
int load_place(struct load *l);
/* ... the slaves are those of the file, in its order */
int load_place_offline(struct load *l);
/* check.c: refuses what ecrt.h cannot do; changes nothing */
int load_check(struct load *l);
/* config.c: all of a configuration but its place */
int load_configure(struct load *l, struct plan *p);
ec_direction_t load_direction(const struct load *l, const struct plan *p, unsigned int sm);
/* time in ns, rounded up */
uint32_t load_ms(int64_t ns);

/* publish.c */
int load_publish_names(struct load *l);

/* a value, with the registration to which its byte belongs while that is recorded only */
struct named {
	char *name;
	char *unit;
	size_t reg;
	struct ecb_value v;
};

/**
 * struct loaded - what ecrt_master_data() keeps
 * @what: of ecrt_master_loaded()
 * @values: in the order of their names
 * @n: how many
 * @room: memory for so many
 * @regs: registrations so far
 */
struct loaded {
	struct ecb_loaded what;
	struct named *values;
	size_t n;
	size_t room;
	size_t regs;
};

/* value.c */
struct loaded *loaded_new(void);
void loaded_free(void *loaded);
void loaded_describe(struct loaded *to, uint32_t slaves, uint32_t clocks, int64_t cycle);
/* 0 or -ENOMEM */
int loaded_add(struct loaded *to, const char *slave, const struct ecb_entry *e,
	       const struct ecb_value *v);
int loaded_sort(struct loaded *to);

#endif
