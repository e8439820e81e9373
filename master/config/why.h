/* SPDX-License-Identifier: GPL-2.0-only */
/* Why a configured slave is not in OP. */
#ifndef EC_WHY_H
#define EC_WHY_H

#include <linux/types.h>

struct ec_cause;
struct ec_config;
struct ec_slave;
struct ec_wanted;

size_t ec_config_why(const struct ec_config *c, char *buf, size_t size, struct ec_cause *cause);
const struct ec_config *ec_config_at(const struct ec_wanted *w, const struct ec_slave *slave,
				     unsigned int *from);
bool ec_config_place(const struct ec_config *c, unsigned int *place);
int ec_config_index(const struct ec_config *c);
void ec_config_locate(struct ec_config *c);
bool ec_config_differs(const struct ec_config *c, const struct ec_slave *slave);
bool ec_config_revision_text(const struct ec_config *c, const struct ec_slave *slave, char *buf,
			     size_t size);
void ec_config_log_differences(const struct ec_wanted *w);
u8 ec_config_status(const struct ec_config *c);

#endif
