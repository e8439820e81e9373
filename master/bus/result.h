/* SPDX-License-Identifier: GPL-2.0-only */
/* How a step of a slave's worker has ended, and whether the slave's error shows why. */
#ifndef EC_RESULT_H
#define EC_RESULT_H

#include "slave.h"

/**
 * struct ec_result - result of a step
 * @err: 0 or -errno
 * @reported: ec_slave_fail() has noted the cause; otherwise the caller reports @err
 */
struct ec_result {
	int err;
	bool reported;
};

#define EC_RESULT(err_)	((struct ec_result){ .err = (err_) })

/* Note why a slave cannot be configured. Evaluates to the result with @err_. */
#define ec_result_fail(s, err_, cause, ...) \
	({ ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, cause, __VA_ARGS__); \
	   (struct ec_result){ .err = (err_), .reported = true }; })

#endif
