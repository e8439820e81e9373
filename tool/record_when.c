// SPDX-License-Identifier: GPL-2.0-only
/*
 * Conditions as in C, but & ^ | bind tighter than == and <: "status & 8 == 8" is what it looks
 * like. A condition becomes a list of steps for a stack.
 */
#include "record_when.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tool.h"
#include "value.h"

#define STEPS		256
#define DEPTH		64	/* of parentheses, and of the stack */
#define NAME_MAX_BYTES	256

enum op {
	PUSH, LOAD, NEGATE, INVERT, NOT,
	ADD, SUB, AND, XOR, OR, EQ, NE, LT, LE, GT, GE, LAND, LOR,
};

/* a whole number from -2^63 to 2^64 - 1, or a real one */
struct num {
	bool real;
	bool negative;		/* a whole one: @bits are of two's complement */
	u64 bits;
	double d;
};

struct step {
	enum op op;
	struct num num;
	struct when_name name;
};

struct when {
	unsigned int n;
	struct step steps[STEPS];
};

struct parser {
	const char *text;
	const char *at;
	unsigned int depth;
	when_find *find;
	void *ctx;
	struct when *w;
};

static const struct {
	const char *text;
	enum op op;
	int level;		/* how tight it binds */
} binary[] = {
	/* longer ones first */
	{ "||", LOR, 1 }, { "&&", LAND, 2 }, { "==", EQ, 3 }, { "!=", NE, 3 }, { "<=", LE, 3 },
	{ ">=", GE, 3 }, { "<", LT, 3 }, { ">", GT, 3 }, { "|", OR, 4 }, { "^", XOR, 5 },
	{ "&", AND, 6 }, { "+", ADD, 7 }, { "-", SUB, 7 },
};

static int wrong(const struct parser *p, const char *at, const char *what)
{
	return usage_error("--when, column %zu: %s in '%s'", (size_t)(at - p->text) + 1, what,
			   p->text);
}

static int add_step(struct parser *p, const struct step *s)
{
	if (p->w->n == STEPS)
		return wrong(p, p->at, "too long a condition");
	p->w->steps[p->w->n++] = *s;
	return 0;
}

static int add_op(struct parser *p, enum op op)
{
	return add_step(p, &(struct step){ .op = op });
}

static void skip(struct parser *p)
{
	while (isspace((unsigned char)*p->at))
		p->at++;
}

/* A word that is a number; false: it is none. */
static bool number(const char *word, struct num *to)
{
	char *end;

	*to = (struct num){ 0 };
	errno = 0;
	to->bits = strtoull(word, &end, 0);
	if (!*end && !errno)
		return true;
	if (strspn(word, "0123456789.eE+-") != strlen(word))
		return false;
	errno = 0;
	to->real = true;
	to->d = strtod(word, &end);
	return !*end && !errno;
}

/* Is the sign at @p->at that of an exponent, behind the @n characters of @name? */
static bool is_exponent(const struct parser *p, const char *name, size_t n)
{
	return (*p->at == '+' || *p->at == '-') && isdigit((unsigned char)p->at[1]) && n > 1 &&
	       tolower((unsigned char)name[n - 1]) == 'e' &&
	       strspn(name, "0123456789.") == n - 1;
}

static int word(struct parser *p)
{
	struct step s = { .op = PUSH };
	const char *from = p->at;
	char name[NAME_MAX_BYTES] = "";
	size_t n = 0;

	while (isalnum((unsigned char)*p->at) || *p->at == '_' || *p->at == '.' ||
	       is_exponent(p, name, n)) {
		if (n + 1 == sizeof(name))
			return wrong(p, from, "too long a name");
		name[n++] = *p->at++;
	}
	name[n] = 0;
	if (!n)
		return wrong(p, from, *from ? "expected a name or a number" : "it ends too early");
	if (!number(name, &s.num)) {
		s.op = LOAD;
		if (p->find(p->ctx, name, &s.name))
			return 1;
	}
	return add_step(p, &s);
}

static int expression(struct parser *p, int level);

static int operand(struct parser *p)
{
	static const struct {
		char c;
		enum op op;
	} unary[] = { { '-', NEGATE }, { '~', INVERT }, { '!', NOT } };
	int ret;

	skip(p);
	if (p->depth == DEPTH)
		return wrong(p, p->at, "too deep a condition");
	for (unsigned int i = 0; i < ARRAY_SIZE(unary); i++)
		if (*p->at == unary[i].c) {
			p->at++;
			p->depth++;
			ret = operand(p) || add_op(p, unary[i].op);
			p->depth--;
			return ret;
		}
	if (*p->at != '(')
		return word(p);
	p->at++;
	p->depth++;
	ret = expression(p, 1);
	p->depth--;
	if (ret)
		return ret;
	if (*p->at != ')')
		return wrong(p, p->at, "expected ')'");
	p->at++;
	return 0;
}

/* An operator of at least this level; -1: there is none. */
static int operator_at(const struct parser *p, int level)
{
	for (unsigned int i = 0; i < ARRAY_SIZE(binary); i++) {
		if (strncmp(p->at, binary[i].text, strlen(binary[i].text)))
			continue;
		return binary[i].level >= level ? (int)i : -1;
	}
	return -1;
}

static int expression(struct parser *p, int level)
{
	int ret = operand(p);

	while (!ret) {
		int i;

		skip(p);
		i = operator_at(p, level);
		if (i < 0)
			return 0;
		p->at += strlen(binary[i].text);
		p->depth++;
		ret = expression(p, binary[i].level + 1) || add_op(p, binary[i].op);
		p->depth--;
	}
	return ret;
}

int when_parse(const char *text, when_find *find, void *ctx, struct when **result)
{
	struct parser p = { .text = text, .at = text, .find = find, .ctx = ctx };
	int ret;

	p.w = calloc(1, sizeof(*p.w));
	if (!p.w)
		return fail("out of memory");
	ret = expression(&p, 1);
	if (!ret && *p.at)
		ret = wrong(&p, p.at, "expected an operator");
	if (ret)
		when_free(p.w);
	else
		*result = p.w;
	return ret;
}

static struct num whole(u64 bits, bool negative)
{
	return (struct num){ .bits = bits, .negative = negative };
}

static double as_double(const struct num *n)
{
	return n->real ? n->d : n->negative ? (double)(s64)n->bits : (double)n->bits;
}

static struct num load(const struct when_name *name, u64 bits)
{
	u8 data[8];
	s64 v;

	for (unsigned int i = 0; i < 8; i++)
		data[i] = (u8)(bits >> 8 * i);
	if (name->type.kind == EC_KIND_FLOAT)
		return (struct num){
			.real = true, .d = value_real(data, name->type.bits / 8u),
		};
	if (name->type.kind != EC_KIND_INT)
		return whole(bits, false);
	v = value_signed(&name->type, data, (name->type.bits + 7u) / 8);
	return whole((u64)v, v < 0);
}

static int compare(const struct num *a, const struct num *b)
{
	if (a->real || b->real) {
		double x = as_double(a), y = as_double(b);

		/* not a number is equal to nothing, and neither less nor greater */
		return x < y ? -1 : x > y ? 1 : x == y ? 0 : 2;
	}
	if (a->negative != b->negative)
		return a->negative ? -1 : 1;
	return a->bits < b->bits ? -1 : a->bits > b->bits;
}

/* The bits of an operation on bits: of negative numbers it may be one. */
static struct num of_bits(u64 bits, bool negative)
{
	return whole(bits, negative && (s64)bits < 0);
}

static bool is_below_zero(const struct num *n)
{
	return n->real ? n->d < 0 : n->negative;
}

static bool is_true(const struct num *n)
{
	return n->real ? n->d != 0 : n->bits != 0;
}

/* Bits of a real number are those of its whole part. */
static u64 as_bits(const struct num *n)
{
	if (!n->real)
		return n->bits;
	return n->d >= 0 && n->d < 18446744073709551615.0 ? (u64)n->d :
	       n->d > -9223372036854775808.0 && n->d < 0 ? (u64)(s64)n->d : 0;
}

static struct num sum(const struct num *a, const struct num *b, bool minus)
{
	u64 x = a->bits, y = b->bits, v = minus ? x - y : x + y;

	if (a->real || b->real)
		return (struct num){
			.real = true,
			.d = minus ? as_double(a) - as_double(b) : as_double(a) + as_double(b),
		};
	if (minus)
		return whole(v, compare(a, b) < 0);
	return whole(v, (a->negative || b->negative) && (s64)v < 0);
}

static struct num two(enum op op, const struct num *a, const struct num *b)
{
	int c = compare(a, b);

	switch (op) {
	case ADD:
		return sum(a, b, false);
	case SUB:
		return sum(a, b, true);
	case AND:
		return of_bits(as_bits(a) & as_bits(b), is_below_zero(a) && is_below_zero(b));
	case XOR:
		return of_bits(as_bits(a) ^ as_bits(b), is_below_zero(a) != is_below_zero(b));
	case OR:
		return of_bits(as_bits(a) | as_bits(b), is_below_zero(a) || is_below_zero(b));
	case EQ:
		return whole(c == 0, false);
	case NE:
		return whole(c != 0, false);
	case LT:
		return whole(c == -1, false);
	case LE:
		return whole(c == -1 || c == 0, false);
	case GT:
		return whole(c == 1, false);
	case GE:
		return whole(c == 1 || c == 0, false);
	case LAND:
		return whole(is_true(a) && is_true(b), false);
	default:
		return whole(is_true(a) || is_true(b), false);
	}
}

static struct num one(enum op op, const struct num *a)
{
	const struct num zero = { 0 };

	switch (op) {
	case NEGATE:
		return sum(&zero, a, true);
	case INVERT:
		return of_bits(~as_bits(a), !is_below_zero(a));
	default:
		return whole(!is_true(a), false);
	}
}

bool when_true(const struct when *w, const u64 *bits)
{
	struct num stack[STEPS];
	unsigned int n = 0;

	for (unsigned int i = 0; i < w->n; i++) {
		const struct step *s = &w->steps[i];

		if (s->op == PUSH) {
			stack[n++] = s->num;
		} else if (s->op == LOAD) {
			stack[n++] = load(&s->name, bits[s->name.index]);
		} else if (s->op < ADD) {
			stack[n - 1] = one(s->op, &stack[n - 1]);
		} else {
			n--;
			stack[n - 1] = two(s->op, &stack[n - 1], &stack[n]);
		}
	}
	return is_true(&stack[0]);
}

void when_free(struct when *w)
{
	free(w);
}
