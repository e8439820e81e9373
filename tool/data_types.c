// SPDX-License-Identifier: GPL-2.0-only
#include "data_types.h"

/* by code */
const struct ec_type ec_types[] = {
	{ 0x0001, 1, EC_KIND_BOOL, "bool" },
	{ 0x0002, 8, EC_KIND_INT, "int8" },
	{ 0x0003, 16, EC_KIND_INT, "int16" },
	{ 0x0004, 32, EC_KIND_INT, "int32" },
	{ 0x0005, 8, EC_KIND_UINT, "uint8" },
	{ 0x0006, 16, EC_KIND_UINT, "uint16" },
	{ 0x0007, 32, EC_KIND_UINT, "uint32" },
	{ 0x0008, 32, EC_KIND_FLOAT, "float" },
	{ 0x0009, 0, EC_KIND_STRING, "string" },
	{ 0x000A, 0, EC_KIND_OCTETS, "octet_string" },
	{ 0x000B, 0, EC_KIND_UNICODE, "unicode_string" },
	{ 0x000C, 48, EC_KIND_RAW, "time_of_day" },
	{ 0x000D, 48, EC_KIND_RAW, "time_difference" },
	{ 0x000F, 0, EC_KIND_RAW, "domain" },
	{ 0x0010, 24, EC_KIND_INT, "int24" },
	{ 0x0011, 64, EC_KIND_FLOAT, "double" },
	{ 0x0012, 40, EC_KIND_INT, "int40" },
	{ 0x0013, 48, EC_KIND_INT, "int48" },
	{ 0x0014, 56, EC_KIND_INT, "int56" },
	{ 0x0015, 64, EC_KIND_INT, "int64" },
	{ 0x0016, 24, EC_KIND_UINT, "uint24" },
	{ 0x0018, 40, EC_KIND_UINT, "uint40" },
	{ 0x0019, 48, EC_KIND_UINT, "uint48" },
	{ 0x001A, 56, EC_KIND_UINT, "uint56" },
	{ 0x001B, 64, EC_KIND_UINT, "uint64" },
	{ 0x001D, 128, EC_KIND_RAW, "guid" },
	{ 0x001E, 8, EC_KIND_UINT, "byte" },
	{ 0x001F, 16, EC_KIND_UINT, "word" },
	{ 0x0020, 32, EC_KIND_UINT, "dword" },
	{ 0x0021, 0, EC_KIND_RAW, "pdo_mapping" },
	{ 0x0023, 0, EC_KIND_RAW, "identity" },
	{ 0x0025, 0, EC_KIND_RAW, "command_par" },
	{ 0x0027, 0, EC_KIND_RAW, "pdo_parameter" },
	{ 0x0029, 0, EC_KIND_RAW, "sync_par" },
	{ 0x002D, 8, EC_KIND_BITS, "bitarr8" },
	{ 0x002E, 16, EC_KIND_BITS, "bitarr16" },
	{ 0x002F, 32, EC_KIND_BITS, "bitarr32" },
	{ 0x0030, 1, EC_KIND_BITS, "bit1" },
	{ 0x0031, 2, EC_KIND_BITS, "bit2" },
	{ 0x0032, 3, EC_KIND_BITS, "bit3" },
	{ 0x0033, 4, EC_KIND_BITS, "bit4" },
	{ 0x0034, 5, EC_KIND_BITS, "bit5" },
	{ 0x0035, 6, EC_KIND_BITS, "bit6" },
	{ 0x0036, 7, EC_KIND_BITS, "bit7" },
	{ 0x0037, 8, EC_KIND_BITS, "bit8" },
	{ 0x0038, 9, EC_KIND_BITS, "bit9" },
	{ 0x0039, 10, EC_KIND_BITS, "bit10" },
	{ 0x003A, 11, EC_KIND_BITS, "bit11" },
	{ 0x003B, 12, EC_KIND_BITS, "bit12" },
	{ 0x003C, 13, EC_KIND_BITS, "bit13" },
	{ 0x003D, 14, EC_KIND_BITS, "bit14" },
	{ 0x003E, 15, EC_KIND_BITS, "bit15" },
	{ 0x003F, 16, EC_KIND_BITS, "bit16" },
	{ 0x0260, 0, EC_KIND_RAW, "array_of_int" },
	{ 0x0261, 0, EC_KIND_RAW, "array_of_sint" },
	{ 0x0262, 0, EC_KIND_RAW, "array_of_dint" },
	{ 0x0263, 0, EC_KIND_RAW, "array_of_udint" },
	{ 0xFFFB, 8, EC_KIND_SM, "sm8" },
	{ 0xFFFC, 16, EC_KIND_SM, "sm16" },
	{ 0xFFFD, 32, EC_KIND_SM, "sm32" },
	{ 0xFFFE, 64, EC_KIND_SM, "sm64" },
	{ 0xFFFF, 0, EC_KIND_RAW, "raw" },
};

const unsigned int ec_types_count = ARRAY_SIZE(ec_types);

static const struct {
	const char *name;
	u16 code;
} aliases[] = {
	{ "boolean", 0x0001 }, { "b", 0x0001 },
	{ "i8", 0x0002 }, { "i16", 0x0003 }, { "i24", 0x0010 }, { "i32", 0x0004 },
	{ "i40", 0x0012 }, { "i48", 0x0013 }, { "i56", 0x0014 }, { "i64", 0x0015 },
	{ "u8", 0x0005 }, { "u16", 0x0006 }, { "u24", 0x0016 }, { "u32", 0x0007 },
	{ "u40", 0x0018 }, { "u48", 0x0019 }, { "u56", 0x001A }, { "u64", 0x001B },
	{ "s8", 0x0002 }, { "s16", 0x0003 }, { "s32", 0x0004 }, { "s64", 0x0015 },
	{ "integer8", 0x0002 }, { "integer16", 0x0003 }, { "integer24", 0x0010 },
	{ "integer32", 0x0004 }, { "integer40", 0x0012 }, { "integer48", 0x0013 },
	{ "integer56", 0x0014 }, { "integer64", 0x0015 },
	{ "unsigned8", 0x0005 }, { "unsigned16", 0x0006 }, { "unsigned24", 0x0016 },
	{ "unsigned32", 0x0007 }, { "unsigned40", 0x0018 }, { "unsigned48", 0x0019 },
	{ "unsigned56", 0x001A }, { "unsigned64", 0x001B },
	{ "sint", 0x0002 }, { "int", 0x0003 }, { "dint", 0x0004 }, { "lint", 0x0015 },
	{ "usint", 0x0005 }, { "uint", 0x0006 }, { "udint", 0x0007 }, { "ulint", 0x001B },
	{ "real", 0x0008 }, { "real32", 0x0008 }, { "f32", 0x0008 },
	{ "lreal", 0x0011 }, { "real64", 0x0011 }, { "f64", 0x0011 },
	{ "visible_string", 0x0009 }, { "str", 0x0009 },
	{ "hex", 0xFFFF },
};

/**
 * ec_type_by_code() - data type by its code
 * @code: index in the object dictionary
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: data type, NULL if unknown or the device's own.
 */
const struct ec_type *ec_type_by_code(u16 code)
{
	size_t lo = 0, hi = ARRAY_SIZE(ec_types);

	while (lo < hi) {
		size_t mid = lo + (hi - lo) / 2;

		if (ec_types[mid].code == code)
			return &ec_types[mid];
		if (ec_types[mid].code < code)
			lo = mid + 1;
		else
			hi = mid;
	}
	return NULL;
}

/* @b is in lower case */
static bool same_name(const char *a, const char *b)
{
	for (; *a && *b; a++, b++) {
		char c = *a >= 'A' && *a <= 'Z' ? (char)(*a - 'A' + 'a') : *a;

		if (c != *b)
			return false;
	}
	return !*a && !*b;
}

/**
 * ec_type_by_name() - data type by its name
 * @name: as in ec_types[], or "u16", "f32", "udint"...; case does not matter
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: data type, NULL if unknown.
 */
const struct ec_type *ec_type_by_name(const char *name)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(ec_types); i++) {
		if (same_name(name, ec_types[i].name))
			return &ec_types[i];
	}
	for (i = 0; i < ARRAY_SIZE(aliases); i++) {
		if (same_name(name, aliases[i].name))
			return ec_type_by_code(aliases[i].code);
	}
	return NULL;
}
