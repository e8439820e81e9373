/* SPDX-License-Identifier: GPL-2.0-only */
/* IDNs of servo drives on the command line. */
#ifndef EC_TOOL_IDN_H
#define EC_TOOL_IDN_H

#include "dev.h"
#include "io.h"

#define SOE_MAX		65536	/* bytes of an element */

struct soe_addr {
	u8 drive;
	u16 idn;
	u8 element;		/* ECT_SOE_* */
	char text[16];		/* "P-0-0150" */
};

void soe_addr_set(struct soe_addr *a, u8 drive, u16 idn);
bool soe_is_name(const char *idn);
int soe_addr_parse(struct soe_addr *a, const char *drive, const char *idn);
int soe_element_parse(struct soe_addr *a, const char *name);
bool soe_element_is_text(u8 element);
void soe_addr_out(const struct soe_addr *a);
int soe_failed(struct dev *d, int err, const struct ect_slave *s, const struct soe_addr *a,
	       const char *verb);
long soe_get(const struct tool *t, struct dev *d, const struct ect_slave *s,
	     const struct soe_addr *a, u8 *data);
int soe_put(const struct tool *t, struct dev *d, const struct ect_slave *s,
	    const struct soe_addr *a, const u8 *data, size_t size);
bool soe_list_is_valid(const u8 *data, size_t size);
void soe_length_text(u32 attribute, char buf[16]);
void soe_access_text(u32 attribute, char buf[8]);

#endif
