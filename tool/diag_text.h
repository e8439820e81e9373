/* SPDX-License-Identifier: GPL-2.0-only */
/* A diagnosis message as text. */
#ifndef EC_TOOL_DIAG_TEXT_H
#define EC_TOOL_DIAG_TEXT_H

#include "../master/wire/diag.h"
#include "esi_texts.h"

const char *diag_severity(u16 flags);
char *diag_param_text(const struct ec_diag_param *p, const struct esi_texts *texts);
char *diag_substitute(const char *text, struct ec_diag_msg m, const struct esi_texts *texts);
void diag_time_text(u64 ns, char *to, size_t size);

#endif
