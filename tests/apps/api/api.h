/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Every function of ecrt.h against the simulated segment, through the device.
 * Calls are written CALL(function)(...): what was called is written down, and
 * tests/system/api.bats compares that with what the library exports.
 */
#ifndef EC_API_H
#define EC_API_H

#include <ecrt.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define CALL(f) (api_called(#f), f)

/* checks; a failed one is reported with its place, the case goes on */
#define YES(c) api_yes((c), __FILE__, __LINE__, #c)
#define IS(have, want) \
	api_is((long long)(have), (long long)(want), __FILE__, __LINE__, #have, #want)
/* ... the case does not go on */
#define NEED(c) \
	do { \
		if (!YES(c)) \
			return; \
	} while (0)

/* a call that fails says so in one line on stderr, or does not print at all */
#define SAYS(have, want) \
	do { \
		api_lines(); \
		IS(have, want); \
		api_printed(1, __FILE__, __LINE__, #have); \
	} while (0)
#define SILENT(have, want) \
	do { \
		api_lines(); \
		IS(have, want); \
		api_printed(0, __FILE__, __LINE__, #have); \
	} while (0)

struct api_counts {
	unsigned int failures;
};

struct api_counts api_counts(void);
void api_called(const char *name);
bool api_yes(bool ok, const char *file, int line, const char *what);
bool api_is(long long have, long long want, const char *file, int line, const char *a,
	    const char *b);
unsigned int api_lines(void);
void api_printed(unsigned int want, const char *file, int line, const char *what);

/* a file of cases */
struct api_case {
	const char *name;
	void (*run)(void);
};

struct api_group {
	const char *name;
	const struct api_case *cases;	/* ends with a NULL name */
};

extern const struct api_case open_cases[], info_cases[], config_cases[], pdo_cases[],
	cycle_cases[], dc_cases[], request_cases[], kcycle_cases[], null_cases[], access_cases[],
	after_cases[], layout_cases[], extension_cases[], lcec_cases[], ros2_cases[], beside_cases[],
	soe_cases[], foe_cases[], dict_cases[],
	syscall_cases[];

/* the segment, see tests/system/api.bats */
enum { COUPLER, OUT, IN, MOTOR, SERVO, SWITCH, SLAVES };

#define BECKHOFF	0x00000002u
#define EL1008		0x03f03052u
#define EL2008		0x07d83052u
#define EL6614		0x19d63052u
#define EL7201		0x1c213052u
#define NOWHERE		77	/* a ring position where nobody is */

/*
 * An application with one domain: EL2008 and EL1008, whose channels 1 and 2 are wired,
 * and a drive that is mapped anew. Offsets are of the domain.
 */
struct bench {
	ec_master_t *m;
	ec_domain_t *d;
	ec_slave_config_t *out, *in, *motor;
	unsigned int out_byte, out_bit, in_byte, in_bit;
	int control, status;	/* objects 0x6040, 0x6041 of the drive */
	uint8_t *data;
	unsigned long cycles;
	void (*each)(struct bench *b);	/* between process and queue */
};

bool bench_request(struct bench *b);
bool bench_configure(struct bench *b);
bool bench_activate(struct bench *b);
bool bench_up(struct bench *b);
void bench_down(struct bench *b);
void bench_cycle(struct bench *b, unsigned int n);
bool bench_op(struct bench *b);
void bench_sleep(void);

#endif
