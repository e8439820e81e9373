// SPDX-License-Identifier: GPL-2.0-only
/* Words, numbers, times and names of a segment description. */
#include "describe_int.h"

static void append(struct ec_sim_error *err, size_t *at, const char *s,
		   size_t n)
{
	for (size_t i = 0; i < n && *at < sizeof(err->text) - 1; i++) {
		char c = s[i];

		err->text[(*at)++] = c >= ' ' && c <= '~' ? c : '?';
	}
	err->text[*at] = '\0';
}

/**
 * ec_desc_fail() - report an error at the present line
 * @d: description
 * @before: text before the word
 * @w: word, NULL: none
 * @after: text behind it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: -EINVAL.
 */
int ec_desc_fail(struct ec_desc *d, const char *before,
		 const struct ec_desc_word *w, const char *after)
{
	size_t at = 0;

	d->err->line = d->line;
	append(d->err, &at, before, strlen(before));
	if (w)
		append(d->err, &at, w->s, min_t(size_t, w->n, 48));
	append(d->err, &at, after, strlen(after));
	return -EINVAL;
}

static bool is_blank(char c)
{
	return c == ' ' || c == '\t' || c == '\r';
}

/**
 * ec_desc_split() - split the next line into words
 * @d: description; its line number is moved on
 * @p: text, moved behind the line
 * @end: end of the text
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_split(struct ec_desc *d, const char **p, const char *end)
{
	const char *s = *p, *stop = s;

	while (stop < end && *stop != '\n')
		stop++;
	*p = stop < end ? stop + 1 : stop;
	d->line++;
	d->n = 0;
	for (;;) {
		const char *from;

		while (s < stop && is_blank(*s))
			s++;
		if (s == stop || *s == '#')
			return 0;
		from = s;
		while (s < stop && !is_blank(*s) && *s != '#')
			s++;
		if (d->n == EC_DESC_WORDS)
			return ec_desc_fail(d, "too many words; use several statements",
					    NULL, "");
		d->w[d->n++] = (struct ec_desc_word){
			.s = from, .n = (size_t)(s - from),
		};
	}
}

/**
 * ec_desc_is() - is a word this text
 * @w: word, may be NULL
 * @text: text
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_desc_is(const struct ec_desc_word *w, const char *text)
{
	return w && strlen(text) == w->n && !memcmp(w->s, text, w->n);
}

/**
 * ec_desc_next() - next word that is no option
 * @d: description
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the word, marked as used; NULL: none is left.
 */
struct ec_desc_word *ec_desc_next(struct ec_desc *d)
{
	for (u32 i = 0; i < d->n; i++) {
		if (d->w[i].used || memchr(d->w[i].s, '=', d->w[i].n))
			continue;
		d->w[i].used = true;
		return &d->w[i];
	}
	return NULL;
}

/**
 * ec_desc_value() - value of an option
 * @d: description
 * @key: its name
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the value; @s is NULL where the option is not given.
 */
struct ec_desc_word ec_desc_value(struct ec_desc *d, const char *key)
{
	struct ec_desc_word v = { NULL, 0, false };
	size_t len = strlen(key);

	for (u32 i = 0; i < d->n; i++) {
		struct ec_desc_word *w = &d->w[i];

		if (w->used || w->n <= len || w->s[len] != '=' ||
		    memcmp(w->s, key, len))
			continue;
		w->used = true;
		v.s = w->s + len + 1;
		v.n = w->n - len - 1;
		break;
	}
	return v;
}

/**
 * ec_desc_end() - all words must have been used by now
 * @d: description
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_end(struct ec_desc *d)
{
	for (u32 i = 0; i < d->n; i++)
		if (!d->w[i].used)
			return ec_desc_fail(d, "'", &d->w[i],
				"' is unknown here or given twice; remove it");
	return 0;
}

struct unit {
	const char *name;
	u64 factor;
};

static const struct unit times[] = {
	{ "ns", 1 }, { "us", 1000 }, { "ms", 1000000 }, { "s", 1000000000 },
	{ "min", 60000000000ull }, { "", 1 }, { NULL, 0 },
};

static const struct unit rates[] = {	/* ppb */
	{ "ppb", 1 }, { "ppm", 1000 }, { "%", 10000000 }, { NULL, 0 },
};

static int digit(char c, u32 base)
{
	int v = c >= '0' && c <= '9' ? c - '0' :
		c >= 'a' && c <= 'f' ? c - 'a' + 10 :
		c >= 'A' && c <= 'F' ? c - 'A' + 10 : 99;

	return v < (int)base ? v : -1;
}

/* digits at *@i; false: none, or too large for 62 bits */
static bool digits(const struct ec_desc_word *w, size_t *i, u32 base, u64 *v)
{
	size_t from = *i;

	*v = 0;
	while (*i < w->n && digit(w->s[*i], base) >= 0) {
		if (*v > (1ULL << 57))
			return false;
		*v = *v * base + (u64)digit(w->s[*i], base);
		(*i)++;
	}
	return *i > from;
}

/* number with unit; a plain 0 needs none */
static bool scaled(const struct ec_desc_word *w, const struct unit *units,
		   s64 *v)
{
	u64 whole, frac = 0, scale = 1;
	bool minus = w->n && w->s[0] == '-';
	size_t i = minus, from;

	if (!digits(w, &i, 10, &whole))
		return false;
	if (i < w->n && w->s[i] == '.') {
		from = ++i;
		if (!digits(w, &i, 10, &frac) || i - from > 9)
			return false;
		for (; from < i; from++)
			scale *= 10;
	}
	if (i == w->n && !whole && !frac) {
		*v = 0;
		return true;
	}
	for (; units->name; units++) {
		u64 r;

		if (strlen(units->name) != w->n - i ||
		    memcmp(units->name, w->s + i, w->n - i))
			continue;
		if (whole > div64_u64(1ULL << 61, units->factor))
			return false;
		/* the product fits: fraction below 10^9, factor below 2^36 */
		r = whole * units->factor +
		    (scale > 1 ? div64_u64(div64_u64(units->factor * 1000,
						     scale) * frac, 1000) : 0);
		*v = minus ? -(s64)r : (s64)r;
		return true;
	}
	return false;
}

/**
 * ec_desc_parse_number() - number of a word
 * @d: description
 * @w: word: decimal, or hexadecimal with 0x
 * @min: smallest value allowed
 * @max: largest
 * @v: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_parse_number(struct ec_desc *d, const struct ec_desc_word *w,
			 s64 min, s64 max, s64 *v)
{
	bool minus = w->n && w->s[0] == '-';
	size_t i = minus;
	u32 base = 10;
	u64 u;

	if (w->n > i + 2 && w->s[i] == '0' && (w->s[i + 1] | 32) == 'x') {
		base = 16;
		i += 2;
	}
	if (!digits(w, &i, base, &u) || i != w->n)
		return ec_desc_fail(d, "'", w, "' is not a number: expected 12 or 0x0c");
	*v = minus ? -(s64)u : (s64)u;
	if (*v < min || *v > max)
		return ec_desc_fail(d, "'", w, "' is out of range");
	return 0;
}

/**
 * ec_desc_number() - option with a number
 * @d: description
 * @key: its name
 * @min: smallest value allowed
 * @max: largest
 * @v: result, unchanged where the option is not given
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_number(struct ec_desc *d, const char *key, s64 min, s64 max, s64 *v)
{
	struct ec_desc_word w = ec_desc_value(d, key);

	return w.s ? ec_desc_parse_number(d, &w, min, max, v) : 0;
}

/**
 * ec_desc_time() - option with a time
 * @d: description
 * @key: its name
 * @max: largest value allowed, ns
 * @v: result in ns, unchanged where the option is not given
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_time(struct ec_desc *d, const char *key, u64 max, u64 *v)
{
	struct ec_desc_word w = ec_desc_value(d, key);
	s64 ns;

	if (!w.s)
		return 0;
	if (!scaled(&w, times, &ns) || ns < 0)
		return ec_desc_fail(d, "'", &w, "' is not a time: expected 600ns, 10us, 1.5ms or 2s");
	if ((u64)ns > max)
		return ec_desc_fail(d, "'", &w, "' is too long here");
	*v = (u64)ns;
	return 0;
}

/**
 * ec_desc_jump() - option with a time forward or, with a minus, back
 * @d: description
 * @key: its name
 * @max: largest magnitude allowed, ns
 * @v: result in ns, unchanged where the option is not given
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_jump(struct ec_desc *d, const char *key, u64 max, s64 *v)
{
	struct ec_desc_word w = ec_desc_value(d, key);

	if (!w.s)
		return 0;
	if (!scaled(&w, times, v))
		return ec_desc_fail(d, "'", &w, "' is not a time: expected 600ns, -10us, 1.5ms or 2s");
	if (*v > (s64)max || *v < -(s64)max)
		return ec_desc_fail(d, "'", &w, "' is too long here");
	return 0;
}

/**
 * ec_desc_yes() - option that is yes or no
 * @d: description
 * @key: its name
 * @v: result, unchanged where the option is not given
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_yes(struct ec_desc *d, const char *key, bool *v)
{
	struct ec_desc_word w = ec_desc_value(d, key);

	if (!w.s)
		return 0;
	*v = ec_desc_is(&w, "yes");
	if (*v || ec_desc_is(&w, "no"))
		return 0;
	w.s -= strlen(key) + 1;
	w.n += strlen(key) + 1;
	return ec_desc_fail(d, "invalid '", &w, "': expected yes or no");
}

/**
 * ec_desc_rate() - option with a rate
 * @d: description
 * @key: its name
 * @max_ppb: largest magnitude allowed
 * @ppb: result, unchanged where the option is not given
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_rate(struct ec_desc *d, const char *key, s64 max_ppb, s64 *ppb)
{
	struct ec_desc_word w = ec_desc_value(d, key);

	if (!w.s)
		return 0;
	if (!scaled(&w, rates, ppb))
		return ec_desc_fail(d, "'", &w, "' is not a rate: expected 25ppm or 300ppb");
	if (*ppb > max_ppb || *ppb < -max_ppb)
		return ec_desc_fail(d, "'", &w, max_ppb == 1000000 ? "' is too much: limit 1000ppm" :
								    "' is too much: limit 1000000ppm");
	return 0;
}

/**
 * ec_desc_place() - split NAME.NUMBER
 * @d: description
 * @w: word, NULL: missing
 * @name: what stands before the last dot
 * @number: and behind it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_place(struct ec_desc *d, const struct ec_desc_word *w,
		  struct ec_desc_word *name, s64 *number)
{
	struct ec_desc_word n;
	size_t dot;

	if (!w)
		return ec_desc_fail(d, "missing channel or port: expected the name of a slave, a dot and a number, as out.1",
				    NULL, "");
	for (dot = w->n; dot && w->s[dot - 1] != '.'; dot--)
		;
	if (dot < 2)
		return ec_desc_fail(d, "'", w, "' has no number: expected for example out.1");
	*name = (struct ec_desc_word){ .s = w->s, .n = dot - 1 };
	n = (struct ec_desc_word){ .s = w->s + dot, .n = w->n - dot };
	return ec_desc_parse_number(d, &n, 0, 65535, number);
}

/* Names of the segment, as many as fit into a report: a running one has no lines to look at. */
static int unknown_in_segment(struct ec_desc *d, const struct ec_desc_word *w)
{
	char names[64];
	size_t at = 0;
	u32 i;

	for (i = 0; i < d->n_nodes; i++) {
		const char *name = d->node[i].app->name;
		size_t n = strlen(name);

		/* ", " and "..." */
		if (at + n + 6 > sizeof(names))
			break;
		if (i) {
			memcpy(names + at, ", ", 2);
			at += 2;
		}
		memcpy(names + at, name, n);
		at += n;
	}
	memcpy(names + at, i < d->n_nodes ? "..." : "", i < d->n_nodes ? 4 : 1);
	ec_desc_fail(d, "unknown slave '", w, "'; the segment has ");
	at = strlen(d->err->text);
	append(d->err, &at, names, strlen(names));
	return -EINVAL;
}

/**
 * ec_desc_slave() - slave of a name
 * @d: description
 * @w: word, NULL: missing
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its number, or -EINVAL.
 */
int ec_desc_slave(struct ec_desc *d, const struct ec_desc_word *w)
{
	if (!w)
		return ec_desc_fail(d, "missing name of a slave", NULL, "");
	for (u32 i = d->n_nodes; i--; )
		if (ec_desc_is(w, d->node[i].app->name))
			return (int)i;
	if (d->command)
		return unknown_in_segment(d, w);
	return ec_desc_fail(d, "unknown slave '", w, "'; a line 'slave NAME ...' above has to define it");
}
