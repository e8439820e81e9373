// SPDX-License-Identifier: LGPL-2.1-or-later
/* Floating point in process data: IEEE 754, little-endian, unaligned. */

#include <string.h>

#include "internal.h"

float ecrt_read_real(const void *data)
{
	uint32_t raw = EC_READ_U32(data);
	float value;

	memcpy(&value, &raw, sizeof(value));
	return value;
}

double ecrt_read_lreal(const void *data)
{
	uint64_t raw = EC_READ_U64(data);
	double value;

	memcpy(&value, &raw, sizeof(value));
	return value;
}

void ecrt_write_real(void *data, float value)
{
	uint32_t raw;

	memcpy(&raw, &value, sizeof(raw));
	EC_WRITE_U32(data, raw);
}

void ecrt_write_lreal(void *data, double value)
{
	uint64_t raw;

	memcpy(&raw, &value, sizeof(raw));
	EC_WRITE_U64(data, raw);
}
