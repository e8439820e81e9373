// SPDX-License-Identifier: GPL-2.0-only
/* Runs the wire codecs over real bytes: data_check DIR */
#include "check.h"
#include <glob.h>
#include <stdlib.h>

static unsigned int passed, failed;

static u8 *slurp(const char *path, size_t *len)
{
	FILE *f = fopen(path, "rb");
	u8 *data = NULL;
	long size;

	if (!f)
		return NULL;
	if (!fseek(f, 0, SEEK_END) && (size = ftell(f)) > 0) {
		rewind(f);
		*len = (size_t)size;
		data = malloc(*len);
		if (data && fread(data, 1, *len, f) != *len) {
			free(data);
			data = NULL;
		}
	}
	fclose(f);
	return data;
}

static void all(const char *dir, const char *pattern,
		int (*check)(const char *path, const u8 *data, size_t len, char *note, size_t cap))
{
	char path[4096], note[256];
	glob_t g;
	size_t i;

	snprintf(path, sizeof(path), "%s/%s", dir, pattern);
	if (glob(path, 0, NULL, &g)) {
		printf("%s: FAIL: nothing there\n", path);
		failed++;
		return;
	}
	for (i = 0; i < g.gl_pathc; i++) {
		size_t len = 0;
		u8 *data = slurp(g.gl_pathv[i], &len);
		int faults;

		note[0] = 0;
		if (!data) {
			printf("%s: FAIL: cannot be read\n", g.gl_pathv[i]);
			failed++;
			continue;
		}
		faults = check(g.gl_pathv[i], data, len, note, sizeof(note));
		if (faults)
			printf("%s: FAIL: %d faults; %s\n", g.gl_pathv[i], faults, note);
		else
			printf("%s: ok: %s\n", g.gl_pathv[i], note);
		faults ? failed++ : passed++;
		free(data);
	}
	globfree(&g);
}

int main(int argc, char **argv)
{
	if (argc < 2) {
		printf("no data given (DATA=folder with eeprom/ and captures/)\n");
		printf("0 passed, 0 failed\n");
		return 0;
	}
	all(argv[1], "eeprom/*.bin", check_eeprom);
	all(argv[1], "damaged/*.bin", check_damaged);
	all(argv[1], "captures/*.pcapng", check_capture);
	all(argv[1], "captures/twincat-run-ek1100-el1004.pcapng", check_replay);
	all(argv[1], "captures/soem-sdinfo-ek1100-el1004.pcapng", check_replay);
	printf("%u passed, %u failed\n", passed, failed);
	return failed ? 1 : 0;
}
