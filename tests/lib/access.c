/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The data access macros, in C and in C++. */
#include "ecrt.h"

#include <stdio.h>
#include <string.h>

static int failures;

#define CHECK(c) \
	do { \
		if (!(c)) { \
			printf("%s:%d: %s\n", __FILE__, __LINE__, #c); \
			failures++; \
		} \
	} while (0)

static uint8_t mem[32];

static void clear(void)
{
	memset(mem, 0, sizeof(mem));
}

static void integers(void)
{
	static const uint8_t le[8] = { 0xf8, 0x07, 0x16, 0x25,
				       0x34, 0x43, 0x52, 0xe1 };
	unsigned int i;

	/* all alignments */
	for (i = 0; i < 8; i++) {
		const void *p = mem + i;

		clear();
		memcpy(mem + i, le, 8);
		CHECK(EC_READ_U8(p) == 0xf8);
		CHECK(EC_READ_S8(p) == -8);
		CHECK(EC_READ_U16(p) == 0x07f8);
		CHECK(EC_READ_S16(p) == 0x07f8);
		CHECK(EC_READ_U32(p) == 0x251607f8);
		CHECK(EC_READ_S32(p) == 0x251607f8);
		CHECK(EC_READ_U64(p) == 0xe1524334251607f8ULL);
		CHECK(EC_READ_S64(p) == (int64_t)0xe1524334251607f8ULL);

		clear();
		EC_WRITE_U64(mem + i, 0xe1524334251607f8ULL);
		CHECK(!memcmp(mem + i, le, 8) && !mem[i + 8]);
		clear();
		EC_WRITE_U32(mem + i, 0x251607f8);
		CHECK(!memcmp(mem + i, le, 4) && !mem[i + 4]);
		clear();
		EC_WRITE_U16(mem + i, 0x07f8);
		CHECK(!memcmp(mem + i, le, 2) && !mem[i + 2]);
		clear();
		EC_WRITE_U8(mem + i, 0xf8);
		CHECK(mem[i] == 0xf8 && !mem[i + 1]);
		EC_WRITE_S8(mem + i, -1);
		CHECK(EC_READ_S8(mem + i) == -1);
		EC_WRITE_S16(mem + i, -2);
		CHECK(EC_READ_S16(mem + i) == -2);
		EC_WRITE_S32(mem + i, -3);
		CHECK(EC_READ_S32(mem + i) == -3);
		EC_WRITE_S64(mem + i, -4);
		CHECK(EC_READ_S64(mem + i) == -4);
	}
}

static void bits(void)
{
	unsigned int i;

	clear();
	for (i = 0; i < 8; i++) {
		mem[1] = 0x00;
		EC_WRITE_BIT(mem + 1, i, 1);
		CHECK(mem[1] == 1u << i && !mem[0] && !mem[2]);
		CHECK(EC_READ_BIT(mem + 1, i) == 1);
		mem[1] = 0xff;
		EC_WRITE_BIT(&mem[1], i, 0);
		CHECK(mem[1] == (0xff & ~(1u << i)));
		CHECK(EC_READ_BIT(mem + 1, i) == 0);
	}
	mem[1] = 0;
	EC_WRITE_BIT(mem + 1, 3, 0x100);	/* any value but 0 sets */
	CHECK(mem[1] == 8);
	CHECK(sizeof(EC_READ_BIT(mem, 0)) == sizeof(int));
}

/* arguments count once; a statement fits between if and else */
static void evaluation(void)
{
	uint8_t *p = mem;
	int v = 7;

	clear();
	(void)EC_READ_U16(p++);
	CHECK(p == mem + 1);
	EC_WRITE_U32(p++, v++);
	CHECK(p == mem + 2 && v == 8);
	EC_WRITE_BIT(p++, v++ - 8, 1);
	CHECK(p == mem + 3 && v == 9 && EC_READ_U8(mem + 2) == 1);
	if (v)
		EC_WRITE_U8(p, 1);
	else
		EC_WRITE_BIT(p, 0, 0);
	CHECK(mem[3] == 1);
}

/* the object has another type: optimisation must not lose a store */
static void aliasing(void)
{
	uint32_t words[2] = { 0, 0 };
	float f = 1.0f;

	EC_WRITE_U16(words, 0x1234);
	CHECK(EC_READ_U32(words) == 0x1234);
	EC_WRITE_U32(&f, 0);
	CHECK(f == 0.0f);
}

static void reals(void)
{
	static const uint8_t one[] = { 0, 0, 0x80, 0x3f };
	static const uint8_t two[] = { 0, 0, 0, 0, 0, 0, 0, 0x40 };

	clear();
	EC_WRITE_REAL(mem + 1, 1.0f);
	CHECK(!memcmp(mem + 1, one, 4) && !mem[5]);
	CHECK(EC_READ_REAL(mem + 1) == 1.0f);
	clear();
	EC_WRITE_LREAL(mem + 3, 2.0);
	CHECK(!memcmp(mem + 3, two, 8) && !mem[11]);
	CHECK(EC_READ_LREAL(mem + 3) == 2.0);
}

static void constants(void)
{
	struct timeval tv = { 946684801, 5 };
	ec_sync_info_t syncs[] = {
		{ 2, EC_DIR_OUTPUT, 0, NULL, EC_WD_ENABLE },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};

	CHECK(EC_TIMEVAL2NANO(tv) == 1000005000ULL);
	CHECK(syncs[1].index == (uint8_t)EC_END);
	CHECK(ECRT_VERSION_MAGIC == 262);
	CHECK(EC_DIR_OUTPUT == 1 && EC_DIR_INPUT == 2 && EC_DIR_COUNT == 3);
	CHECK(EC_WC_COMPLETE == 2 && EC_WD_DISABLE == 2 &&
	      EC_REQUEST_ERROR == 3 && EC_PORT_MII == 3);
	CHECK(EC_AL_STATE_INIT == 1 && EC_AL_STATE_PREOP == 2 &&
	      EC_AL_STATE_SAFEOP == 4 && EC_AL_STATE_OP == 8);
	CHECK(le16_to_cpu(cpu_to_le16(0x1234)) == 0x1234);
	CHECK(le32_to_cpu(cpu_to_le32(0x12345678)) == 0x12345678);
	CHECK(le64_to_cpu(cpu_to_le64(5)) == 5);
	mem[0] = 0x34;
	mem[1] = 0x12;
	CHECK(le16_to_cpup(mem) == 0x1234);
}

/* binary compatible with what is linked against 1.5.2 and 1.6 (64 bit) */
static void sizes(void)
{
	if (sizeof(void *) != 8)
		return;
	CHECK(sizeof(ec_master_state_t) == 8);
	CHECK(sizeof(ec_master_link_state_t) == 8);
	CHECK(sizeof(ec_slave_config_state_t) == 4);
	CHECK(sizeof(ec_master_info_t) == 16);
	CHECK(sizeof(ec_master_scan_progress_t) == 8);
	CHECK(sizeof(ec_slave_port_link_t) == 3);
	CHECK(sizeof(ec_slave_info_t) == 176);
	CHECK(sizeof(ec_domain_state_t) == 12);
	CHECK(sizeof(ec_pdo_entry_info_t) == 4);
	CHECK(sizeof(ec_pdo_info_t) == 16);
	CHECK(sizeof(ec_sync_info_t) == 32);
	CHECK(sizeof(ec_pdo_entry_reg_t) == 32);
}

int main(void)
{
	integers();
	bits();
	evaluation();
	aliasing();
	reals();
	constants();
	sizes();
	return failures != 0;
}
