/* SPDX-License-Identifier: GPL-2.0-only */
/* IP parameters of slaves with EoE: words of the command line, output. */
#ifndef EC_TOOL_IP_H
#define EC_TOOL_IP_H

#include "tool.h"

/* one pair; 0, or 1 after printing what is wrong */
int ip_parse(struct ect_ip *p, const char *key, const char *value);
/* one line each, behind @indent; @all: also those not set, as null (JSON only) */
void ip_out(struct ect_ip *p, const char *indent, bool all);

#endif
