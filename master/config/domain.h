/* SPDX-License-Identifier: GPL-2.0-only */
/* A domain: process data exchanged and judged together. */
#ifndef EC_DOMAIN_H
#define EC_DOMAIN_H

#include <linux/types.h>
#include "ethercat.h"

struct ec_config;
struct ec_config_fmmu;
struct ec_input;
struct ec_wanted;

/* reference to an FMMU of a configuration, in order of registration */
struct ec_domain_fmmu {
	struct ec_config *config;
	struct ec_config_fmmu *fmmu;
};

/* process data of one direction, side by side in the image of all domains, bytes */
struct ec_domain_area {
	u32 offset;
	u32 len;
};

/**
 * struct ec_domain - one domain, under lock of the configuration until activation
 * @wanted: owner
 * @index: number in the session
 * @size: bytes registered
 * @offset: of its data in the image, and its logical base address; set by activation
 * @fmmus: what it consists of
 * @n_fmmus: entries in @fmmus
 * @expected: working counter when all slaves process the datagrams
 * @options: EC_DOMAIN_OPT_*
 * @n_dgrams: datagrams, set by activation
 * @dgram_bytes: their bytes, header and working counter included
 * @memory: of a kernel application, for its data; NULL: they lie in the image
 * @data: for a kernel application, as are the next three: its data, NULL: not yet
 * @inputs: what of @data is input, when the kernel runs the cycle
 * @n_inputs: entries in @inputs
 * @snap: result as of its last ecrt_domain_process()
 * @max_age: sends after which received data are stale, 0: never
 * @division: kernel cycles from one exchange of it to the next
 * @phase: the first of these cycles, from 0 on
 */
struct ec_domain {
	struct ec_wanted *wanted;
	u32 index;
	u32 size;
	u32 offset;
	struct ec_domain_fmmu *fmmus;
	unsigned int n_fmmus;
	u32 expected;
	u32 options;
	u32 n_dgrams;
	u32 dgram_bytes;
	u8 *memory;
	u8 *data;
	struct ec_input *inputs;
	unsigned int n_inputs;
	struct ec_status_domain snap;
	u32 max_age;
	u32 division;
	u32 phase;
};

struct ec_domain *ec_domain_create(struct ec_wanted *w);
void ec_domain_free(struct ec_domain *d);
int ec_domain_add(struct ec_domain *d, struct ec_config *c, unsigned int fmmu);
unsigned int ec_domain_areas(const struct ec_domain *d, u8 dir, struct ec_domain_area *list,
			     unsigned int n);

#endif
