// SPDX-License-Identifier: GPL-2.0-only
/* Beyond ecrt: memory before activation, an orderly end, reasons, clocks. */
#include "api.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

static void preset(void)
{
	unsigned int bit;
	struct bench b;
	uint8_t *data;

	NEED(bench_request(&b));
	SAYS(CALL(ecrt_master_setup_domain_memory)(b.m), -EINVAL);
	NEED(bench_configure(&b));
	YES(!CALL(ecrt_domain_data)(b.d));
	SILENT(CALL(ecrt_master_setup_domain_memory)(b.m), 0);
	SAYS(CALL(ecrt_master_setup_domain_memory)(b.m), -EBUSY);
	data = CALL(ecrt_domain_data)(b.d);
	NEED(data);
	IS(data[b.out_byte], 0);
	EC_WRITE_BIT(data + b.out_byte, b.out_bit, 1);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry)(b.out, 0x7010, 1, b.d, &bit), -EBUSY);
	errno = 0;
	YES(!CALL(ecrt_master_create_domain)(b.m));
	IS(errno, EBUSY);
	NEED(bench_activate(&b));
	YES(b.data == data);
	IS(EC_READ_BIT(data + b.out_byte, b.out_bit), 1);
	NEED(bench_op(&b));
	bench_cycle(&b, 5);
	IS(EC_READ_BIT(data + b.in_byte, b.in_bit), 1);
	SAYS(CALL(ecrt_master_setup_domain_memory)(b.m), -EBUSY);
	bench_down(&b);
}

static void orderly(void)
{
	ec_slave_config_state_t s = { 0 };
	struct bench b;
	int i;

	NEED(bench_request(&b) && bench_configure(&b));
	CALL(ecrt_master_deactivate_slaves)(b.m);
	NEED(bench_activate(&b) && bench_op(&b));
	CALL(ecrt_master_deactivate_slaves)(b.m);
	for (i = 0; i < 20000 && s.al_state != EC_AL_STATE_PREOP; i++) {
		bench_cycle(&b, 1);
		IS(CALL(ecrt_slave_config_state)(b.motor, &s), 0);
	}
	IS(s.al_state, EC_AL_STATE_PREOP);
	bench_cycle(&b, 500);
	IS(CALL(ecrt_slave_config_state)(b.motor, &s), 0);
	IS(s.al_state, EC_AL_STATE_PREOP);
	IS(s.operational, 0);
	IS(CALL(ecrt_master_deactivate)(b.m), 0);
	bench_down(&b);
}

static void complete(void)
{
	ec_master_t *m = CALL(ecrt_open_master)(0);
	uint32_t abort = 99;
	uint8_t data[64];
	size_t size = 0;

	NEED(m);
	/* identity: 4 entries of 32 bit behind the number of entries in 16 */
	IS(CALL(ecrt_master_sdo_upload_complete)(m, MOTOR, 0x1018, data, sizeof(data), &size, &abort),
	   0);
	IS(abort, 0);
	IS(size, 18);
	IS(data[0], 4);
	IS(EC_READ_U32(data + 14), 77);
	SAYS(CALL(ecrt_master_sdo_upload_complete)(m, MOTOR, 0x1018, data, 17, &size, &abort),
	     -ENOBUFS);
	SAYS(CALL(ecrt_master_sdo_upload_complete)(m, MOTOR, 0x3fff, data, 64, &size, &abort), -EIO);
	IS(abort, 0x06020000);
	SAYS(CALL(ecrt_master_sdo_upload_complete)(m, NOWHERE, 0x1018, data, 64, &size, &abort),
	     -EINVAL);
	IS(size, 18);
	CALL(ecrt_release_master)(m);
}

/* What is written is what is there: nothing differs. */
static void eeprom(void)
{
	ec_master_t *m = CALL(ecrt_open_master)(0);
	ec_eeprom_written_t w = { .differ = 9 };
	uint8_t image[4096];
	size_t size = 0;

	NEED(m);
	IS(CALL(ecrt_master_read_eeprom)(m, MOTOR, 0, image, sizeof(image), &size), 0);
	YES(size > 128);
	IS(CALL(ecrt_master_write_eeprom)(m, MOTOR, 0, image, size & ~(size_t)1,
					  EC_EEPROM_WRITE_DRY_RUN, &w), 0);
	IS(w.differ, 0);
	image[16] ^= 1;
	IS(CALL(ecrt_master_write_eeprom)(m, MOTOR, 8, image + 16, 2,
					  EC_EEPROM_WRITE_FORCE | EC_EEPROM_WRITE_DRY_RUN, &w), 0);
	IS(w.differ, 1);
	IS(w.written, 0);
	/* another vendor, without force */
	SAYS(CALL(ecrt_master_write_eeprom)(m, MOTOR, 8, image + 16, 2, 0, &w), -EPERM);
	IS(CALL(ecrt_master_write_alias)(m, MOTOR, EC_READ_U16(image + 8), 0, &w), 0);
	SAYS(CALL(ecrt_master_write_alias)(m, NOWHERE, 1, 0, &w), -EINVAL);
	SAYS(ecrt_master_write_eeprom(m, NOWHERE, 0, image, 128, 0, &w), -EINVAL);
	SAYS(ecrt_master_read_eeprom(m, NOWHERE, 0, image, sizeof(image), &size), -EINVAL);
	CALL(ecrt_release_master)(m);
}

static void reasons(void)
{
	ec_slave_config_t *nobody, *other;
	char text[256], small[5];
	struct bench b;
	int len;

	NEED(bench_request(&b) && bench_configure(&b));
	nobody = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL2008);
	other = CALL(ecrt_master_slave_config)(b.m, 0, SERVO, BECKHOFF, EL2008);
	NEED(nobody && other);
	IS(CALL(ecrt_slave_config_watchdog)(b.motor, 0, 0), 0);
	IS(CALL(ecrt_master_reason)(b.m, text, sizeof(text)), 0);
	IS(text[0], 0);
	YES(CALL(ecrt_slave_config_reg_pdo_entry)(b.motor, 0x5555, 0, b.d, NULL) < 0);
	len = CALL(ecrt_master_reason)(b.m, text, sizeof(text));
	YES(len > 0 && len == (int)strlen(text) && strstr(text, "0x5555"));
	IS(CALL(ecrt_master_reason)(b.m, NULL, 1), -EINVAL);
	NEED(bench_activate(&b) && bench_op(&b));
	IS(CALL(ecrt_slave_config_reason)(b.motor, text, sizeof(text)), 0);
	len = CALL(ecrt_slave_config_reason)(nobody, text, sizeof(text));
	YES(len > 0 && len == (int)strlen(text));
	/* too small: cut, and the whole length told */
	IS(CALL(ecrt_slave_config_reason)(nobody, small, sizeof(small)), len);
	IS(strlen(small), 4);
	YES(CALL(ecrt_slave_config_reason)(other, text, sizeof(text)) > 0);
	IS(CALL(ecrt_slave_config_reason)(other, NULL, 1), -EINVAL);
	bench_down(&b);
}

/* One slave, two configurations: both say so, one when it is registered. */
static void twins(void)
{
	ec_slave_config_t *twin;
	unsigned int bit;
	char text[256];
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	twin = CALL(ecrt_master_slave_config)(b.m, 1001, 0, BECKHOFF, EL2008);
	NEED(twin && twin != b.out);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry)(twin, 0x7000, 1, b.d, &bit), -ENOENT);
	YES(CALL(ecrt_master_reason)(b.m, text, sizeof(text)) > 0);
	YES(strstr(text, "another configuration, 0:1") != NULL);
	NEED(bench_activate(&b) && bench_op(&b));
	YES(CALL(ecrt_slave_config_reason)(twin, text, sizeof(text)) > 0);
	YES(strstr(text, "another configuration, 0:1") != NULL);
	bench_down(&b);
}

static void ask_time(struct bench *b)
{
	CALL(ecrt_master_application_time)(b->m, 0x500000000ULL + b->cycles * 1000000);
	CALL(ecrt_master_sync_slave_clocks)(b->m);
	CALL(ecrt_master_64bit_reference_clock_time_queue)(b->m);
}

static void clocks(void)
{
	ec_slave_config_dc_state_t s;
	ec_slave_config_t *nobody;
	uint64_t time = 0, last;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	nobody = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL2008);
	IS(CALL(ecrt_master_application_time)(b.m, 0x500000000ULL), 0);
	IS(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, 0, 0, 0), 0);
	SILENT(CALL(ecrt_master_64bit_reference_clock_time)(b.m, &time), -EINVAL);
	NEED(bench_activate(&b));
	SILENT(CALL(ecrt_master_64bit_reference_clock_time)(b.m, &time), -EIO);
	b.each = ask_time;
	NEED(bench_op(&b));
	bench_cycle(&b, 2000);
	SILENT(CALL(ecrt_master_64bit_reference_clock_time)(b.m, &time), 0);
	IS(time >> 32, 5);
	last = time;
	bench_cycle(&b, 100);
	SILENT(CALL(ecrt_master_64bit_reference_clock_time)(b.m, &time), 0);
	YES(time - last > 90000000 && time - last < 110000000);
	IS(CALL(ecrt_master_64bit_reference_clock_time)(b.m, NULL), -EINVAL);
	IS(CALL(ecrt_slave_config_dc_state)(b.motor, &s), 0);
	YES(s.bits == 64 && s.set && s.in_window && !s.reference);
	YES(s.delay_ns > 0 && s.delay_ns < 100000);
	IS(CALL(ecrt_slave_config_dc_state)(nobody, &s), -ENODEV);
	IS(CALL(ecrt_slave_config_dc_state)(b.motor, NULL), -EINVAL);
	bench_down(&b);
}

/*
 * A reader of new events only. The bus goes on with what the application before left to it, so
 * some of them may come at any moment; one that began with the old ones would never be silent.
 */
static int open_silent(void)
{
	struct pollfd p = { .events = POLLIN };

	for (int i = 0; i < 100; i++) {
		p.fd = CALL(ecrt_open_events)(0, 1);
		if (p.fd < 0 || poll(&p, 1, 0) == 0)
			return p.fd;
		close(p.fd);
		usleep(50000);
	}
	return -1;
}

/* What this application does is in the events, for a reader that only reads. */
static void events(void)
{
	int fd = open_silent(), all = CALL(ecrt_open_events)(0, 0);
	struct pollfd p = { .fd = fd, .events = POLLIN };
	bool reserved = false, activated = false, released = false;
	ec_event_t e[64];
	struct bench b;
	char text[200];
	ssize_t n;

	NEED(fd >= 0 && all >= 0);
	SAYS(CALL(ecrt_open_events)(99, 0), -ENOENT);
	NEED(bench_request(&b) && bench_configure(&b) && bench_activate(&b));
	bench_down(&b);
	IS(poll(&p, 1, 1000), 1);
	IS(p.revents, POLLIN);
	errno = 0;
	IS(read(fd, e, sizeof(e[0]) - 1), -1);
	IS(errno, EINVAL);
	IS(fcntl(fd, F_SETFL, O_NONBLOCK), 0);
	while ((n = read(fd, e, sizeof(e))) > 0) {
		IS(n % (ssize_t)sizeof(e[0]), 0);
		for (size_t i = 0; i < (size_t)n / sizeof(e[0]); i++) {
			const char *name = CALL(ecrt_event_name)(e[i].kind);

			reserved |= !strcmp(name, "reserved") && e[i].arg[0] == (uint32_t)getpid();
			activated |= reserved && !strcmp(name, "activated");
			released |= activated && !strcmp(name, "released");
			YES(CALL(ecrt_event_text)(&e[i], text, sizeof(text)) > 0);
		}
	}
	IS(errno, EAGAIN);
	YES(released);
	/* the other reader has not lost the events of before */
	IS(read(all, e, sizeof(e[0])), (long long)sizeof(e[0]));
	IS(e[0].number, 0);
	IS(CALL(ecrt_event_text)(NULL, text, sizeof(text)), -EINVAL);
	close(fd);
	close(all);
}

const struct api_case extension_cases[] = {
	{ "memory before activation", preset },
	{ "an orderly end", orderly },
	{ "whole objects are read", complete },
	{ "the EEPROM is read and written", eeprom },
	{ "reasons", reasons },
	{ "two configurations of one slave", twins },
	{ "the whole time, the state of a clock", clocks },
	{ "events of an application", events },
	{ NULL, NULL },
};
