// SPDX-License-Identifier: GPL-2.0-only
/*
 * Memory that an application causes in the kernel.
 *
 *   memory              configures startup SDOs of 64 KiB until one is refused, then says
 *                       how many there are, and why there is no more
 *   memory charge FILE  configures and activates much, and prints what FILE, memory.current
 *                       of its cgroup, says before, meanwhile and afterwards
 */
#include <ecrt.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define BYTES		65536
#define SDOS		256
#define CONFIGS		1000
#define REQUESTS	64
#define BACK_S		20	/* the kernel frees some of it later */

static const uint8_t value[BYTES];

static int until_refused(void)
{
	ec_master_t *m = ecrt_request_master(0);
	ec_slave_config_t *sc = NULL;
	unsigned int n = 0;
	int ret = 0;

	if (!m)
		return 2;
	for (uint16_t pos = 0; pos < 4 && !ret; pos++) {
		sc = ecrt_master_slave_config(m, 0, pos, 1, 2);
		if (!sc)
			return 2;
		/* one configuration has at most 1024 */
		for (unsigned int i = 0; i < 1000 && !ret; i++, n += !ret)
			ret = ecrt_slave_config_sdo(sc, 0x2000, (uint8_t)i, value, sizeof(value));
	}
	printf("%u values, then: %s\n", n, strerror(-ret));
	ecrt_release_master(m);
	return 0;
}

static int charged(const char *file)
{
	char text[32] = "";
	int fd = open(file, O_RDONLY | O_CLOEXEC);

	if (fd < 0 || read(fd, text, sizeof(text) - 1) <= 0) {
		perror(file);
		exit(2);
	}
	close(fd);
	return atoi(text);
}

/* Each CPU keeps what is charged for up to 64 pages, for the next one who needs some. */
#define KEPT	(2 * 64 * 4096)

/* Until no more than @limit bytes are charged, and what the CPUs keep. */
static int after_release(const char *file, int limit)
{
	static const struct timespec pause = { .tv_nsec = 100000000 };
	int n = BACK_S * 10, now;

	do {
		nanosleep(&pause, NULL);
		now = charged(file);
	} while (now > limit + KEPT && --n);
	return now;
}

static int sdos(ec_master_t *m)
{
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 1, 1, 2);
	int ret = !sc;

	for (unsigned int i = 0; i < SDOS && !ret; i++)
		ret = ecrt_slave_config_sdo(sc, 0x2000, (uint8_t)i, value, BYTES);
	return ret;
}

static int configs(ec_master_t *m)
{
	int ret = 0;

	for (unsigned int i = 0; i < CONFIGS && !ret; i++)
		ret = !ecrt_master_slave_config(m, 0, (uint16_t)(1000 + i), 1, 2);
	return ret;
}

static int requests(ec_master_t *m)
{
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 1, 1, 2);
	int ret = !sc || !ecrt_master_create_domain(m);

	for (unsigned int i = 0; i < REQUESTS && !ret; i++)
		ret = !ecrt_slave_config_create_sdo_request(sc, 0x2000, (uint8_t)i, BYTES);
	return ret ? ret : ecrt_master_activate(m);
}

static int charge(const char *file)
{
	static const struct {
		const char *name;
		int (*fn)(ec_master_t *m);
	} parts[] = { { "SDOs", sdos }, { "configurations", configs }, { "requests", requests } };

	/* what the first use costs the process itself is not meant */
	for (unsigned int first = 0; first < 2; first++)
		for (unsigned int i = 0; i < 3; i++) {
			int before = charged(file), with;
			ec_master_t *m = ecrt_request_master(0);

			if (!m || parts[i].fn(m)) {
				fprintf(stderr, "%s: refused\n", parts[i].name);
				return 2;
			}
			with = charged(file);
			ecrt_release_master(m);
			with -= before;
			if (first)
				printf("%s %d %d\n", parts[i].name, with,
				       after_release(file, before + with / 20) - before);
			else
				after_release(file, before + with / 20);
		}
	return 0;
}

int main(int argc, char **argv)
{
	if (argc == 3 && !strcmp(argv[1], "charge"))
		return charge(argv[2]);
	return until_refused();
}
