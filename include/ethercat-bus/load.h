/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * libethercat-bus: an application that is configured by a bus file, and uses its values by name.
 * In addition to ethercat-bus.h, since it needs ecrt.h and libethercat.
 */
#ifndef ETHERCAT_BUS_LOAD_H
#define ETHERCAT_BUS_LOAD_H

#include "../ecrt.h"
#include "bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/* struct ecb_load.flags: slaves that are missing or exchanged are skipped; others may differ */
#define ECB_LOAD_PARTIAL	1U
/* ... nothing is configured; needs @found, and no master */
#define ECB_LOAD_CHECK		2U

/** struct ecb_load - what ecrt_master_load_bus() applies; zeros but for @struct_size and @bus */
struct ecb_load {
	uint32_t struct_size;
	uint32_t flags;		/* ECB_LOAD_* */
	const struct ecb_bus *bus;	/* not needed any more after the call */
	const char *file;	/* name of its file for messages, or NULL */
	/*
	 * slaves of the machine in the order of the ring, with identifications and PDOs; NULL: as
	 * ecrt.h gives them, without identifications
	 */
	const struct ecb_master *found;
	uint32_t index;		/* of the master in the bus; with one master in the bus any */
	uint32_t reserved;
};

/**
 * ecrt_master_load() - configure a master by a bus file
 * @master: a reserved master, not active, without configurations and domains
 * @path: file with one master, or "-" for stdin
 * @error: result of a failure: place in the file, what is wrong, what to do
 *
 * Finds the slaves by alias, serial number, and identity in the order of the bus, and compares
 * them with the file; configurations, PDOs, startup commands, time limits, clocks, sync units, hot
 * connect groups and the interval of the cycle become those of the file. The PDOs of each sync
 * unit are in a domain of its own, those without sync unit in another one. Slaves that the file
 * does not have are left alone. Then the application activates the master, with
 * ecrt_master_set_cycle() before if the kernel runs the cycle.
 *
 * What the file says and ecrt.h cannot do is refused. Nearly all refusals come before anything is
 * configured, but after each failure call ecrt_release_master().
 *
 * Context: Process. May sleep.
 * Return: 0; -EINVAL the file is not valid; -ENODEV the slaves are not those of the file; -EBUSY
 * the master is active; or another negative errno.
 */
int ecrt_master_load(ec_master_t *master, const char *path, struct ecb_error *error);

/**
 * ecrt_master_load_bus() - configure a master by a bus that was read before
 * @master: as in ecrt_master_load(); NULL with %ECB_LOAD_CHECK
 * @load: the bus, and how
 * @error: as in ecrt_master_load()
 *
 * Context: Process. May sleep. The thread of the bus.
 * Return: As ecrt_master_load().
 */
int ecrt_master_load_bus(ec_master_t *master, const struct ecb_load *load,
			 struct ecb_error *error);

/**
 * ecb_compile() - write what an application in the kernel configures its master by
 * @load: the bus; no flags, @found NULL
 * @image: result; free() it
 * @size: its bytes
 * @error: result of a failure: place in the file, what is wrong, what to do
 *
 * ecrt_master_load_compiled() of the kernel makes the calls of ecrt.h that ecrt_master_load_bus()
 * makes. No machine is asked: slaves without alias have the ring position that the order of the
 * file gives, without members of groups. The same bus becomes the same bytes.
 *
 * Context: Any. The thread of the bus.
 * Return: 0; -EINVAL; -ENOMEM.
 */
int ecb_compile(const struct ecb_load *load, uint8_t **image, size_t *size,
		struct ecb_error *error);

/** struct ecb_loaded - what was loaded */
struct ecb_loaded {
	uint32_t struct_size;
	uint32_t slaves;	/* configurations */
	uint32_t values;
	uint32_t clocks;	/* slaves with SYNC signals */
	int64_t cycle;		/* ns, 0: not given */
};

/**
 * ecrt_master_loaded() - what was loaded
 * @master: master after ecrt_master_load()
 * @loaded: result, with its struct_size
 *
 * Context: Process.
 * Return: 0; -ENOENT nothing is loaded; -EINVAL @loaded is NULL or without struct_size.
 */
int ecrt_master_loaded(const ec_master_t *master, struct ecb_loaded *loaded);

/** struct ecb_value - a value in the process data: raw number * @scale + @offset, in @unit */
struct ecb_value {
	uint32_t struct_size;
	uint32_t byte;		/* in the data of @domain */
	ec_domain_t *domain;
	ec_slave_config_t *slave;
	uint32_t object;	/* index << 8 | subindex */
	uint8_t bit;		/* 0 to 7, in @byte */
	uint8_t bits;		/* size */
	uint8_t type;		/* enum ecb_type */
	uint8_t output;		/* 1: the master writes it */
	double scale;
	double offset;
	const char *unit;	/* "": none; valid as long as @domain */
};

/**
 * ecrt_master_value() - find a value by its name
 * @master: master after ecrt_master_load()
 * @name: name as "axis1.position"
 * @value: result, with its struct_size
 *
 * Values that the file does not name are called by their object, as "io1.x6000_01".
 *
 * Context: Process. A search in a sorted list: look up before the cycle.
 * Return: 0; -ENOENT no such value, or nothing is loaded; -EINVAL an argument is NULL, or @value
 * without struct_size.
 */
int ecrt_master_value(const ec_master_t *master, const char *name, struct ecb_value *value);

/**
 * ecb_value_read() - get a value, scaled
 * @value: of ecrt_master_value()
 * @data: ecrt_domain_data() of its domain
 *
 * Integers of more than 53 bits are rounded.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the value in its unit; NaN: it has more than 64 bits.
 */
double ecb_value_read(const struct ecb_value *value, const uint8_t *data);

/**
 * ecb_value_write() - set an output, scaled
 * @value: of ecrt_master_value()
 * @data: ecrt_domain_data() of its domain
 * @number: in its unit; integers get the nearest raw number
 *
 * Context: As that of writing to the domain. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -ERANGE it does not fit into the type, and nothing is written; -EINVAL an input, more
 * than 64 bits, or no number.
 */
int ecb_value_write(const struct ecb_value *value, uint8_t *data, double number);

#ifdef __cplusplus
}
#endif

#endif
