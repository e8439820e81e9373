// SPDX-License-Identifier: GPL-2.0-only
/*
 * Plain fuzz driver: mutates the seeds with a xorshift generator, the same
 * way in every run. Sanitizers judge.
 *
 *   prog [INPUTS [SEED]]	mutate
 *   prog FILE...		run saved inputs, e.g. a crash
 *
 * On a crash the input is written to crash-<prog>.bin.
 */
#include "fuzz.h"
#include <signal.h>
#include <string.h>
#include <unistd.h>

#define MAX_LEN 8192

void __sanitizer_set_death_callback(void (*callback)(void));

static const uint8_t *current;
static size_t current_len;
static const char *name;
static uint64_t rng;

static void save(void)
{
	char path[256];
	FILE *f;

	if (!current)
		return;
	snprintf(path, sizeof(path), "crash-%s.bin", name);
	f = fopen(path, "wb");
	if (f) {
		fwrite(current, 1, current_len, f);
		fclose(f);
		fprintf(stderr, "input saved in %s (%zu bytes)\n", path, current_len);
	}
	current = NULL;
}

static void on_abort(int sig)
{
	save();
	signal(sig, SIG_DFL);
	raise(sig);
}

static uint32_t rnd(uint32_t below)
{
	rng ^= rng << 13;
	rng ^= rng >> 7;
	rng ^= rng << 17;
	return below ? (uint32_t)(rng >> 32) % below : 0;
}

static void run(const uint8_t *data, size_t len)
{
	/* exactly as large as needed: one byte too far is an ASan report */
	uint8_t *copy = malloc(len ? len : 1);

	if (!copy)
		exit(2);
	memcpy(copy, data, len);
	current = data;
	current_len = len;
	LLVMFuzzerTestOneInput(copy, len);
	current = NULL;
	free(copy);
}

static size_t mutate(uint8_t *p, size_t len, const struct fuzz_seed *other)
{
	static const uint16_t odd[] = { 0, 1, 2, 3, 7, 8, 0x7F, 0x80, 0xFF, 0x100, 0x7FF,
					0x7FFF, 0x8000, 0xFFFE, 0xFFFF };
	unsigned int n = 1 + rnd(rnd(4) ? 4 : 24);
	size_t at, k;

	while (n--) {
		at = len ? rnd((uint32_t)len) : 0;
		switch (rnd(9)) {
		case 0:
			if (len)
				p[at] ^= (uint8_t)(1 << rnd(8));
			break;
		case 1:
			if (len)
				p[at] = (uint8_t)rnd(256);
			break;
		case 2:
			if (len > 1) {
				at &= ~(size_t)1;
				if (at + 2 > len)
					break;
				put_unaligned_le16(odd[rnd(ARRAY_SIZE(odd))], p + at);
			}
			break;
		case 3:
			if (len)
				p[at] = (uint8_t)(p[at] + rnd(9) - 4);
			break;
		case 4:		/* cut */
			if (!rnd(4))
				len = at;
			break;
		case 5:		/* grow */
			k = 1 + rnd(64);
			if (len + k <= MAX_LEN) {
				memset(p + len, rnd(2) ? (int)rnd(256) : 0, k);
				len += k;
			}
			break;
		case 6:		/* drop some bytes */
			k = 1 + rnd(8);
			if (at + k < len) {
				memmove(p + at, p + at + k, len - at - k);
				len -= k;
			}
			break;
		case 7:		/* double some bytes */
			k = 1 + rnd(32);
			if (at + k <= len && len + k <= MAX_LEN) {
				memmove(p + at + k, p + at, len - at);
				len += k;
			}
			break;
		case 8:		/* a piece of another seed */
			if (!other->len)
				break;
			k = 1 + rnd((uint32_t)other->len);
			if (k <= other->len && at + k <= MAX_LEN) {
				memcpy(p + at, (const uint8_t *)other->data + other->len - k, k);
				if (at + k > len)
					len = at + k;
			}
			break;
		}
	}
	return len;
}

static void run_file(const char *path)
{
	static uint8_t buf[1 << 20];
	FILE *f = fopen(path, "rb");
	size_t len;

	if (!f) {
		perror(path);
		exit(2);
	}
	len = fread(buf, 1, sizeof(buf), f);
	fclose(f);
	run(buf, len);
	printf("%s: ok\n", path);
}

int main(int argc, char **argv)
{
	static uint8_t cur[MAX_LEN];
	size_t seeds = 0, len = 0;
	unsigned long count, inputs = 100000;
	char *end;
	int i;

	name = strrchr(argv[0], '/') ? strrchr(argv[0], '/') + 1 : argv[0];
	signal(SIGABRT, on_abort);
	__sanitizer_set_death_callback(save);

	if (argc > 1) {
		inputs = strtoul(argv[1], &end, 0);
		if (*end) {
			for (i = 1; i < argc; i++)
				run_file(argv[i]);
			return 0;
		}
	}
	rng = argc > 2 ? strtoull(argv[2], NULL, 0) : 1;
	rng = (rng ? rng : 1) * 0x9E3779B97F4A7C15ull;

	while (fuzz_seeds[seeds].data)
		seeds++;
	for (i = 0; i < (int)seeds; i++)
		run(fuzz_seeds[i].data, fuzz_seeds[i].len);

	for (count = 0; count < inputs; count++) {
		if (!rnd(8) || !count) {
			const struct fuzz_seed *s = &fuzz_seeds[rnd((uint32_t)seeds)];

			len = min(s->len, (size_t)MAX_LEN);
			memcpy(cur, s->data, len);
		}
		len = mutate(cur, len, &fuzz_seeds[rnd((uint32_t)seeds)]);
		run(cur, len);
	}
	printf("%s: %lu inputs, no fault\n", name, count);
	return 0;
}
