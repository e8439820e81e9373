// SPDX-License-Identifier: GPL-2.0-only
#include "diag_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "dict.h"
#include "io.h"

#define DC_EPOCH	946684800	/* 2000-01-01 in seconds since 1970 */
#define DC_PLAUSIBLE	(10ull * 365 * 24 * 3600)	/* earlier: the clock of the slave */

const char *diag_severity(u16 flags)
{
	switch (flags & 0xf) {
	case EC_DIAG_INFO:
		return "info";
	case EC_DIAG_WARNING:
		return "warning";
	case EC_DIAG_ERROR:
		return "error";
	default:
		return "unknown";
	}
}

/* DC time as date, the time of a clock that was never set in seconds */
void diag_time_text(u64 ns, char *to, size_t size)
{
	u64 s = ns / 1000000000;
	time_t t = (time_t)s + DC_EPOCH;
	char day[32];
	struct tm tm;

	if (s > DC_PLAUSIBLE && gmtime_r(&t, &tm) &&
	    strftime(day, sizeof(day), "%Y-%m-%d %H:%M:%S", &tm))
		snprintf(to, size, "%s.%03u UTC", day, (unsigned int)(ns / 1000000 % 1000));
	else
		snprintf(to, size, "%llu.%06u s", (unsigned long long)s,
			 (unsigned int)(ns / 1000 % 1000000));
}

static u16 type_of(const struct ec_diag_param *p)
{
	switch (p->kind) {
	case EC_DIAG_VALUE:
		return p->type;
	case EC_DIAG_ASCII:
		return EC_TYPE_STRING;
	case EC_DIAG_TEXT_ID:
		return EC_TYPE_UINT16;
	default:
		return EC_TYPE_RAW;
	}
}

/**
 * diag_param_text() - a parameter as text
 * @p: parameter
 * @texts: of the device description
 *
 * Return: text, to be freed; NULL without memory.
 */
char *diag_param_text(const struct ec_diag_param *p, const struct esi_texts *texts)
{
	const char *known = NULL;
	u8 *copy;
	char *to;

	if (p->kind == EC_DIAG_TEXT_ID)
		known = esi_text(texts, (u16)value_unsigned(p->data, p->size));
	if (known)
		return strdup(known);
	copy = malloc(p->size + 1);
	if (!copy)
		return NULL;
	memcpy(copy, p->data, p->size);
	to = dict_value_text(type_of(p), copy, p->size);
	free(copy);
	return to;
}

/* as printf() would, but of the parameter's own type and size */
static void convert(FILE *f, char how, const struct ec_diag_param *p,
		    const struct esi_texts *texts)
{
	const struct ec_type *t = ec_type_by_code(type_of(p));
	bool number = t && p->kind == EC_DIAG_VALUE && value_bytes(t) == p->size;
	char *text;

	if (number && t->kind == EC_KIND_FLOAT) {
		fprintf(f, "%g", value_real(p->data, p->size));
	} else if (number && (how == 'x' || how == 'X')) {
		fprintf(f, how == 'x' ? "%llx" : "%llX",
			(unsigned long long)value_unsigned(p->data, p->size));
	} else if (number && t->kind == EC_KIND_INT) {
		fprintf(f, "%lld", (long long)value_signed(t, p->data, p->size));
	} else if (number) {
		fprintf(f, "%llu", (unsigned long long)value_unsigned(p->data, p->size));
	} else {
		text = diag_param_text(p, texts);
		if (text && p->kind == EC_DIAG_ASCII && strlen(text) > 1)	/* no quotes */
			fprintf(f, "%.*s", (int)strlen(text) - 2, text + 1);
		else
			fputs(text ? text : "?", f);
		free(text);
	}
}

/**
 * diag_substitute() - put the parameters of a message into its text
 * @text: of the device description, with %d, %x, %s... for one parameter after the other
 * @m: message; a place without a valid parameter does not change
 * @texts: of the device description
 *
 * The text comes from a file: it is never the format of a printf().
 *
 * Return: text, to be freed; NULL without memory.
 */
char *diag_substitute(const char *text, struct ec_diag_msg m, const struct esi_texts *texts)
{
	struct ec_diag_param p;
	char *to = NULL;
	size_t size, n;
	FILE *f = open_memstream(&to, &size);

	if (!f)
		return NULL;
	for (; *text; text += n) {
		n = 1;
		if (*text == '%') {
			n += strspn(text + 1, "-+ #0123456789.hlqjzt");
			if (text[n] == '%' && n == 1) {
				fputc('%', f);
				n = 2;
				continue;
			}
			if (text[n] && strchr("diouxXcsfFeEgGp", text[n]) &&
			    ec_diag_param_decode(&m, &p) == 1) {
				convert(f, text[n], &p, texts);
				n++;
				continue;
			}
		}
		fwrite(text, 1, n, f);
	}
	return fclose(f) ? NULL : to;
}
