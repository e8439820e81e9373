// SPDX-License-Identifier: LGPL-2.1-or-later
/* A bus file becomes the form that ecrt_master_load_compiled() of the kernel executes. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recorder.h"

_Static_assert(ECB_TYPE_REAL64 == 11, "compiled.c has the number of types");

#define EXACT		9007199254740992.0	/* 2^53: larger integers may be rounded */
#define DIGITS		18			/* of the divisor */
#define BITS		62

static uint64_t common(uint64_t a, uint64_t b)
{
	while (b) {
		uint64_t rest = a % b;

		a = b;
		b = rest;
	}
	return a;
}

/* The kernel has no floating point: @number as written in decimal, else as it is stored. */
static bool to_rational(double number, struct ec_compiled_number *to)
{
	double num = number;
	uint64_t den = 1, by;
	int bits = 0;

	for (int i = 0; i < DIGITS && nearbyint(num) / (double)den != number; i++) {
		den *= 10;
		num = nearbyint(number * (double)den);
	}
	if (fabs(num) > EXACT || num / (double)den != number) {
		for (den = 1, num = number; bits < BITS && num != nearbyint(num); bits++)
			num *= 2;
		den <<= bits;
	}
	if (num != nearbyint(num) || fabs(num) >= 1e18)
		return false;
	by = common(den, (uint64_t)fabs(num));
	*to = (struct ec_compiled_number){ (int64_t)num / (int64_t)by, den / by };
	return true;
}

static int write_value(struct load *l, struct record *r, const struct named *n)
{
	struct ec_compiled_number scale, offset;

	if (!to_rational(n->v.scale, &scale) || !to_rational(n->v.offset, &offset))
		return BAD(l, 0,
			   "value '%s': scale %g or offset %g is no quotient of 64-bit integers, which the kernel needs",
			   n->name, n->v.scale, n->v.offset);
	record_begin(r, EC_COMPILED_VALUE);
	record_text(r, n->name);
	record_text(r, n->unit);
	record_u32(r, (uint32_t)n->reg);
	record_u32(r, 8 * n->v.byte + n->v.bit);
	record_u32(r, n->v.object);
	record_u8(r, n->v.bits);
	record_u8(r, n->v.type);
	record_u8(r, n->v.output);
	record_u8(r, 0);
	record_u64(r, (uint64_t)scale.num);
	record_u64(r, scale.den);
	record_u64(r, (uint64_t)offset.num);
	record_u64(r, offset.den);
	return record_end(r) ? load_no_memory(l) : 0;
}

static int write_values(struct load *l, struct record *r)
{
	int ret = 0;

	if (l->to->what.cycle) {
		record_begin(r, EC_COMPILED_CYCLE);
		record_u64(r, (uint64_t)l->to->what.cycle);
		record_end(r);
	}
	for (size_t i = 0; i < l->to->n && !ret; i++)
		ret = write_value(l, r, &l->to->values[i]);
	return ret;
}

/* what the kernel would refuse */
static int check_image(struct load *l, const struct record *r)
{
	struct ec_compiled c;

	if (!ec_compiled_check(&c, r->data, r->size))
		return 0;
	return BAD(l, 0, "the kernel cannot have this bus: byte %zu: %s", c.at, c.why);
}

static int compile(struct load *l, struct record *r)
{
	int ret = load_place_offline(l);

	if (!ret)
		ret = load_check(l);
	if (ret)
		return ret;
	record_start(r);
	ret = load_apply(l);
	if (!ret)
		ret = write_values(l, r);
	if (ret)
		return ret;
	ret = record_finish(r);
	if (ret == -EFBIG)
		return BAD(l, 0, "the compiled bus has %zu bytes, limit %u", r->size,
			   EC_COMPILED_MAX);
	return ret ? load_no_memory(l) : check_image(l, r);
}

ECB_API int ecb_compile(const struct ecb_load *load, uint8_t **image, size_t *size,
			struct ecb_error *error)
{
	struct record r = { 0 };
	struct ecb_load how = { 0 };
	struct load l = { .m = (ec_master_t *)&r, .calls = &load_record, .offline = true,
			  .how = &how, .e = error };
	int ret;

	if (!error || !image || !size || !load ||
	    load->struct_size < offsetof(struct ecb_load, found))
		return -EINVAL;
	memset(error, 0, sizeof(*error));
	memcpy(&how, load, load->struct_size < sizeof(how) ? load->struct_size : sizeof(how));
	l.file = how.file ? how.file : "bus";
	if (!how.bus || how.flags || how.found)
		return BAD(&l, 0, "needs a bus, no flags and no slaves of a machine");
	ret = load_begin(&l);
	if (!ret) {
		/* positions are those of the file, groups by identification included */
		how.found = l.want;
		ret = compile(&l, &r);
	}
	load_end(&l);
	if (!ret) {
		*image = r.data;
		*size = r.size;
		r.data = NULL;
	}
	record_free(&r);
	return ret;
}
