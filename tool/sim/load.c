// SPDX-License-Identifier: GPL-2.0-only
/* Segments: built-in or from a file, with the EEPROM images they name. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "load.h"

#define TEXT_MAX	(1 << 20)

static void *zalloc(size_t bytes)
{
	return calloc(1, bytes);
}

const struct ec_sim_ops load_ops = { .alloc = zalloc, .free = free };

/* At most @cap bytes of a file; -errno. */
static long slurp(const char *path, void *buf, size_t cap)
{
	FILE *f = fopen(path, "rb");
	long n;

	if (!f)
		return -errno;
	errno = 0;
	n = (long)fread(buf, 1, cap, f);
	if (ferror(f))
		n = errno ? -errno : -EIO;
	else if (n == (long)cap && fgetc(f) != EOF)
		n = -EFBIG;
	fclose(f);
	return n;
}

/* @ctx: path of the description; images are looked for beside it */
static int load_image(void *ctx, const char *name, u8 *buf, size_t cap)
{
	const char *path = ctx, *slash = strrchr(path, '/');
	char full[4096];

	if (*name == '/' || !slash)
		return (int)slurp(name, buf, cap);
	if ((size_t)snprintf(full, sizeof(full), "%.*s/%s", (int)(slash - path), path, name) >=
	    sizeof(full))
		return -ENAMETOOLONG;
	return (int)slurp(full, buf, cap);
}

/* The text, in a buffer with space for one more statement. */
static char *text_of(const char *name, size_t *len)
{
	const char *builtin = ec_sim_builtin(name);
	char *text = malloc(TEXT_MAX + 64);
	long n;

	if (!text) {
		fprintf(stderr, "ethercat-sim: out of memory\n");
		return NULL;
	}
	if (builtin) {
		*len = strlen(builtin);
		memcpy(text, builtin, *len);
		return text;
	}
	n = slurp(name, text, TEXT_MAX);
	if (n < 0) {
		fprintf(stderr, "ethercat-sim: '%s' is neither a built-in segment (see --list) nor a readable file: %s\n",
			name, n == -EFBIG ? "larger than 1 MiB" : strerror((int)-n));
		free(text);
		return NULL;
	}
	*len = (size_t)n;
	return text;
}

/**
 * load_segment() - build a segment; reports errors on stderr
 * @name: built-in segment or path of a description
 * @seed: 0..EC_SIM_SEED_MAX in place of the segment's own, -1: its own
 *
 * Return: segment, for ec_sim_free(), or NULL.
 */
struct ec_sim *load_segment(const char *name, long long seed)
{
	struct ec_sim_loader loader = { .load = load_image, .ctx = (void *)name };
	struct ec_sim_error err;
	struct ec_sim *sim;
	size_t len;
	char *text = text_of(name, &len);

	if (!text)
		return NULL;
	/* at the end: the last seed counts, and lines keep their numbers */
	if (seed >= 0)
		len += (size_t)sprintf(text + len, "\nsegment seed=%lld\n", seed);
	if (ec_sim_describe(&sim, &load_ops, text, len, &loader, &err)) {
		if (err.line)
			fprintf(stderr, "%s:%u: %s\n", name, err.line, err.text);
		else
			fprintf(stderr, "%s: %s\n", name, err.text);
		sim = NULL;
	}
	free(text);
	return sim;
}

/**
 * load_list() - print the built-in segments
 *
 * Return: exit status.
 */
int load_list(void)
{
	const char *name;
	u32 i;

	for (i = 0; (name = ec_sim_builtin_at(i)); i++) {
		struct ec_sim *sim = load_segment(name, -1);

		if (!sim)
			return 1;
		printf("%-12s %u slave(s)\n", name, ec_sim_count(sim));
		ec_sim_free(sim);
	}
	return 0;
}
