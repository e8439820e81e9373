/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Sync units: domains that fail together, alone; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_UNIT_H
#define EC_UAPI_ETHERCAT_UNIT_H

#include <linux/types.h>
#include "ethercat_common.h"

#define EC_UNIT_NONE		EC_UAPI_NONE32	/* a domain in no unit */
#define EC_UNIT_REPEATS		3	/* frames of a unit in a cycle, at most */

/* what is done when the working counters of a unit are incomplete */
#define EC_UNIT_POLICY_CONTINUE	0
#define EC_UNIT_POLICY_ZERO	1	/* its outputs are zero until they are complete */
#define EC_UNIT_POLICY_HOLD	2	/* its outputs keep their values until then */
#define EC_UNIT_POLICY_SAFEOP	3	/* its outputs are zero, its slaves go to SAFEOP */
#define EC_UNIT_POLICY_STOP	4	/* likewise those of all slaves of the application */

#define EC_UNIT_FLAG_AUTHORITY	1	/* begins without authority; a failure takes it */
#define EC_UNIT_FLAG_LEASE_HOLD	2	/* after the lease outputs are held, not zero */
#define EC_UNIT_FLAG_OFFERED	4	/* another application may hold it; with authority */

struct ec_ioc_unit {
	__u32 flags;		/* in: EC_UNIT_FLAG_* */
	__u32 index;		/* out */
	__u32 policy;		/* in: EC_UNIT_POLICY_* */
	__u32 limit;		/* in: incomplete receives in a row; 0: 3 */
	__u32 lease_cycles;	/* in: cycles of the kernel without new outputs; 0: no lease */
	__u32 repeats;		/* in: frames with the same data in a cycle; 0, 1: one */
	__u32 reserved;
	__u32 reserved2;
	char name[EC_UAPI_STRING];	/* in: letter, then letters, digits, '_', '-', '.' */
};

struct ec_ioc_domain_unit {
	__u32 flags;
	__u32 domain;		/* in */
	__u32 unit;		/* in: index, or EC_UNIT_NONE */
	__u32 reserved;
};

struct ec_ioc_unit_authority {
	__u32 flags;
	__u32 unit;		/* in: index */
	__u32 authority;	/* in: 1 gives it, 0 takes it */
	__u32 reserved;
};

/* another application gives the outputs of a unit that is offered, until it closes its file */
#define EC_UNIT_HOLD_END	1	/* or ends to hold this one */

struct ec_ioc_unit_hold {
	__u32 flags;		/* in: EC_UNIT_HOLD_END */
	__u32 index;		/* out */
	__u32 size;		/* out: bytes of its domains */
	__u32 reserved;
	char name[EC_UAPI_STRING];	/* in */
};

/* the data of its domains, one behind the other; input bytes of outputs are ignored */
struct ec_ioc_unit_data {
	__u32 flags;
	__u32 unit;		/* in: index */
	__u32 size;		/* in: of @data: what EC_IOC_UNIT_HOLD has returned */
	__u32 state;		/* out */
	__u64 data;		/* in: user pointer */
};

/*
 * State of a unit: bits 0-3 EC_UNIT_RUN_*, bits 4-7 EC_UNIT_SENDS_*, then flags. Bits 16-31: how
 * often it has failed or its lease has ended, 65535: at least that.
 */
#define EC_UNIT_RUN_STARTING	0	/* not yet complete since activation */
#define EC_UNIT_RUN_COMPLETE	1
#define EC_UNIT_RUN_FAILED	2
#define EC_UNIT_SENDS_VALUES	0	/* those of the application */
#define EC_UNIT_SENDS_ZERO	1
#define EC_UNIT_SENDS_HELD	2
#define EC_UNIT_HAS_AUTHORITY	0x100
#define EC_UNIT_LEASE_ENDED	0x200
#define EC_UNIT_DOWN		0x400	/* its slaves were taken to SAFEOP by the policy */
#define EC_UNIT_HAS_HOLDER	0x800	/* another application gives its outputs */

struct ec_ioc_unit_info {
	__u32 flags;		/* as created */
	__u32 index;		/* in */
	__u32 policy;
	__u32 limit;
	__u32 lease_cycles;
	__u32 repeats;
	__u32 state;
	__u32 active;		/* @state is valid */
	__u64 domains;		/* bit n: domain n */
	char name[EC_UAPI_STRING];
};

#endif
