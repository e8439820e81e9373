/* SPDX-License-Identifier: GPL-2.0-only */
/* A slave in the form of its device description (ESI). */
#ifndef EC_TOOL_ESI_XML_H
#define EC_TOOL_ESI_XML_H

#include <stdio.h>
#include <string.h>

#include "layout.h"

void esi_xml(FILE *f, const struct ect_slave *s, const struct layout *l, const u8 *img,
	     size_t size);

#endif
