// SPDX-License-Identifier: LGPL-2.1-or-later
/* What this master has beyond the field's header. */
#include "session.h"

#include <errno.h>
#include <string.h>

static void nobody(void)
{
	ec_slave_config_dc_state_t state;
	char text[8];
	uint64_t t;
	size_t size;

	CHECK(ecrt_master_setup_domain_memory(NULL) == -EINVAL);
	ecrt_master_deactivate_slaves(NULL);
	CHECK(ecrt_master_rt_slave_requests(NULL, 1) == -EINVAL);
	ecrt_master_exec_slave_requests(NULL);
	CHECK(ecrt_master_sdo_upload_complete(NULL, 0, 0, NULL, 0, &size, NULL) ==
	      -EINVAL);
	ecrt_master_64bit_reference_clock_time_queue(NULL);
	CHECK(ecrt_master_64bit_reference_clock_time(NULL, &t) == -EINVAL);
	CHECK(ecrt_master_reason(NULL, text, sizeof(text)) == -EINVAL);
	CHECK(ecrt_slave_config_reason(NULL, text, sizeof(text)) == -EINVAL);
	CHECK(ecrt_slave_config_dc_state(NULL, &state) == -EINVAL);
}

/* The pointer stays, and what was written there goes with the activation. */
static void memory(void)
{
	ec_master_t *m = start();
	ec_domain_t *d0 = ecrt_master_create_domain(m);
	ec_domain_t *d1 = ecrt_master_create_domain(m);
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 1, 2, 3);
	uint8_t *p0, *p1;

	CHECK(!ecrt_domain_data(d0));
	CHECK(!ecrt_master_setup_domain_memory(m));
	CHECK(ecrt_master_setup_domain_memory(m) == -EBUSY);
	p0 = ecrt_domain_data(d0);
	p1 = ecrt_domain_data(d1);
	CHECK(p0 && p1 == p0 + 16 && !p0[0] && !p1[15]);
	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x7000, 1, d0, NULL) == -EBUSY);
	CHECK(!ecrt_master_create_domain(m) && errno == EBUSY);
	p0[3] = 0x11;
	p1[5] = 0x22;
	fake.image_size = 4096;
	CHECK(!ecrt_master_activate(m));
	CHECK(fake.preset_size == 32 && fake.preset[3] == 0x11 && fake.preset[21] == 0x22);
	CHECK(ecrt_domain_data(d0) == p0 && ecrt_domain_data(d1) == p1);
	CHECK(fake.image == p0 && p0[3] == 0x11 && p1[5] == 0x22);
	CHECK(ecrt_master_setup_domain_memory(m) == -EBUSY);
	CHECK(!ecrt_master_deactivate(m));

	/* the next round begins without */
	fake.domains = 0;
	d0 = ecrt_master_create_domain(m);
	CHECK(d0 && !ecrt_domain_data(d0) && !ecrt_master_activate(m));
	CHECK(!fake.preset_size && ecrt_domain_data(d0));
	ecrt_release_master(m);
}

static void memory_fails(void)
{
	ec_master_t *m = start();
	ec_domain_t *d;

	CHECK(ecrt_master_setup_domain_memory(m) == -EINVAL);	/* no domain */
	d = ecrt_master_create_domain(m);
	fake.refuse = EC_IOC_DOMAIN_OFFSET;
	fake.err = EPERM;
	CHECK(ecrt_master_setup_domain_memory(m) == -EPERM && !ecrt_domain_data(d));
	fake.refuse = 0;
	CHECK(!ecrt_master_setup_domain_memory(m) && ecrt_domain_data(d));
	/* the kernel refuses: the memory is still there */
	fake.refuse = EC_IOC_ACTIVATE;
	fake.err = ENOMEM;
	CHECK(ecrt_master_activate(m) == -ENOMEM && ecrt_domain_data(d));
	/* an image of another size than there is room for */
	fake.refuse = 0;
	fake.image_size = 8192;
	CHECK(ecrt_master_activate(m) == -EPROTO && fake.last == EC_IOC_DEACTIVATE);
	CHECK(!ecrt_domain_data(d));
	ecrt_release_master(m);

	/* no process data at all */
	m = start();
	fake.image_size = 0;
	d = ecrt_master_create_domain(m);
	CHECK(!ecrt_master_setup_domain_memory(m) && !ecrt_domain_data(d));
	CHECK(!ecrt_master_activate(m) && !fake.preset_size);
	ecrt_release_master(m);
}

/* No system call but that of the send. */
static void whole_time(void)
{
	ec_master_t *m = start();
	unsigned int calls;
	uint64_t t = 0;

	ecrt_master_create_domain(m);
	ecrt_master_64bit_reference_clock_time_queue(m);	/* not active */
	CHECK(!ecrt_master_activate(m));
	CHECK(ecrt_master_64bit_reference_clock_time(m, &t) == -ENXIO);
	ecrt_master_64bit_reference_clock_time_queue(m);
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	fake.status->dc_ref = 1;
	CHECK(ecrt_master_64bit_reference_clock_time(m, &t) == -EIO);
	calls = fake.calls;
	ecrt_master_64bit_reference_clock_time_queue(m);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REF_TIME);
	fake.status->dc_time64 = 0x0123456789abcdefULL;
	fake.status->dc_time64_valid = 1;
	CHECK(!ecrt_master_64bit_reference_clock_time(m, &t) &&
	      t == 0x0123456789abcdefULL);
	CHECK(ecrt_master_64bit_reference_clock_time(m, NULL) == -EINVAL);
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	CHECK(fake.calls == calls + 2);
	ecrt_release_master(m);
}

static void reasons(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 2, 3);
	char text[256] = "x";

	CHECK(!ecrt_master_reason(m, text, sizeof(text)) && !*text);
	fake.reason = "what was wrong\nmore";
	CHECK(ecrt_master_reason(m, text, sizeof(text)) == 14 &&
	      !strcmp(text, "what was wrong"));
	CHECK(ecrt_master_reason(m, text, 5) == 14 && !strcmp(text, "what"));
	CHECK(ecrt_master_reason(m, NULL, 0) == 14);
	CHECK(ecrt_master_reason(m, NULL, 1) == -EINVAL);

	CHECK(ecrt_slave_config_reason(sc, text, sizeof(text)) == 10 &&
	      !strcmp(text, "OP refused"));
	CHECK(((struct ec_ioc_config_why *)fake.arg)->index == 5);
	fake.refuse = EC_IOC_CONFIG_WHY;
	fake.err = ENOENT;
	CHECK(ecrt_slave_config_reason(sc, text, sizeof(text)) == -ENOENT);
	ecrt_release_master(m);
}

static void clock_state(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 2, 3);
	ec_slave_config_dc_state_t s;

	CHECK(!ecrt_slave_config_dc_state(sc, &s) && !s.bits && !s.delay_ns);
	fake.dc_bits = 2;
	fake.dc_diff = -1000;
	CHECK(!ecrt_slave_config_dc_state(sc, &s) && s.bits == 64 && s.set &&
	      s.in_window && !s.reference && s.delay_ns == 145 &&
	      s.offset_ns == 5 && s.difference_ns == -1000);
	fake.dc_odd = 1;
	CHECK(!ecrt_slave_config_dc_state(sc, &s) && s.set && !s.in_window);
	fake.dc_odd = 0;
	fake.dc_bits = 1;
	fake.dc_diff = 1001;
	CHECK(!ecrt_slave_config_dc_state(sc, &s) && s.bits == 32 && !s.in_window);
	CHECK(ecrt_slave_config_dc_state(sc, NULL) == -EINVAL);
	fake.refuse = EC_IOC_SLAVE;
	fake.err = ENOENT;
	CHECK(ecrt_slave_config_dc_state(sc, &s) == -ENOENT);
	ecrt_release_master(m);
}

static void the_rest(void)
{
	ec_master_t *m = start();
	uint8_t buf[8];
	size_t size = 0;
	uint32_t code = 1;

	CHECK(!ecrt_master_sdo_upload_complete(m, 1, 0x1018, buf, sizeof(buf),
					       &size, &code));
	CHECK(size == 4 && !code && fake.last == EC_IOC_SDO_UPLOAD);
	CHECK(((struct ec_ioc_sdo *)fake.arg)->flags == EC_SDO_FLAG_COMPLETE);
	CHECK(!((struct ec_ioc_sdo *)fake.arg)->subindex);

	ecrt_master_deactivate_slaves(m);
	CHECK(fake.last != EC_IOC_SLAVES_DOWN);		/* not active */
	CHECK(!ecrt_master_activate(m));
	ecrt_master_deactivate_slaves(m);
	CHECK(fake.last == EC_IOC_SLAVES_DOWN);
	CHECK(!ecrt_master_send(m) && !ecrt_master_receive(m));
	ecrt_release_master(m);
}

static void read_eeprom(ec_master_t *m)
{
	uint8_t buf[64];
	size_t size = 99;

	CHECK(!ecrt_master_read_eeprom(m, 3, 0, buf, sizeof(buf), &size));
	CHECK(size == 32 && buf[0] == 0 && buf[31] == 31);
	CHECK(((struct ec_ioc_sii *)fake.arg)->slave.position == 3);
	CHECK(!ecrt_master_read_eeprom(m, 3, 4, buf, 12, &size));
	CHECK(size == 12 && buf[0] == 8 && buf[11] == 19);
	CHECK(ecrt_master_read_eeprom(m, 3, 4, NULL, 12, &size) == -EINVAL);
	CHECK(ecrt_master_read_eeprom(m, 3, 4, buf, 12, NULL) == -EINVAL);
	CHECK(ecrt_master_read_eeprom(NULL, 3, 4, buf, 12, &size) == -EINVAL);
}

/* A whole image as it is; words of it with the rest of the image that the master has. */
static void write_eeprom(ec_master_t *m)
{
	const struct ec_ioc_sii_write *arg = (void *)fake.arg;
	const uint8_t data[16] = { 0xaa, 0xbb, 0xcc, 0xdd };
	ec_eeprom_written_t w;

	CHECK(!ecrt_master_write_eeprom(m, 2, 0, data, 16, EC_EEPROM_WRITE_DRY_RUN, &w));
	CHECK(arg->size == 16 && arg->flags == EC_SII_FLAG_DRY_RUN && fake.values[14] == 0);
	CHECK(w.differ == 3 && w.written == 2 && w.register_alias == 7 && w.renewed == 1);
	CHECK(!ecrt_master_write_eeprom(m, 2, 4, data, 4, EC_EEPROM_WRITE_FORCE, NULL));
	CHECK(arg->size == 32 && arg->flags == EC_SII_FLAG_FORCE && arg->slave.position == 2);
	CHECK(fake.values[7] == 7 && fake.values[8] == 0xaa && fake.values[11] == 0xdd);
	CHECK(fake.values[12] == 12 && fake.values[14] == 14 && fake.values[31] == 31);
	CHECK(!ecrt_master_write_eeprom(m, 2, 0, data, 16, EC_EEPROM_WRITE_CHECKSUM |
					EC_EEPROM_WRITE_UNREACHABLE, &w));
	CHECK(arg->flags == EC_SII_FLAG_UNSAFE && fake.values[14] == 0x74 && !fake.values[15]);
	CHECK(!ecrt_master_write_eeprom(m, 2, 15, data, 4, 0, NULL) && arg->size == 34);
	CHECK(ecrt_master_write_eeprom(m, 2, 17, data, 4, 0, &w) == -EINVAL);
	CHECK(ecrt_master_write_eeprom(m, 2, 0, data, 3, 0, &w) == -EINVAL);
	CHECK(ecrt_master_write_eeprom(m, 2, 0, data, 0, 0, &w) == -EINVAL);
	CHECK(ecrt_master_write_eeprom(m, 2, 0, NULL, 4, 0, &w) == -EINVAL);
	CHECK(ecrt_master_write_eeprom(m, 2, 0xffff, data, 4, 0, &w) == -EINVAL);
	CHECK(ecrt_master_write_eeprom(NULL, 2, 0, data, 4, 0, &w) == -EINVAL);
	CHECK(!w.differ && !w.written && !w.renewed);
}

static void eeprom(void)
{
	ec_master_t *m = start();
	ec_eeprom_written_t w = { 0 };

	read_eeprom(m);
	write_eeprom(m);
	CHECK(!ecrt_master_write_alias(m, 1, 4711, EC_EEPROM_WRITE_CHECKSUM, &w));
	CHECK(((struct ec_ioc_alias *)fake.arg)->alias == 4711 && w.register_alias == 5);
	CHECK(((struct ec_ioc_alias *)fake.arg)->flags == EC_SII_FLAG_REPAIR);
	CHECK(ecrt_master_write_alias(NULL, 1, 4711, 0, &w) == -EINVAL);
	fake.refuse = EC_IOC_ALIAS;
	fake.err = EBUSY;
	CHECK(ecrt_master_write_alias(m, 1, 4711, 0, &w) == -EBUSY && !w.register_alias);
	fake.refuse = EC_IOC_SII;
	CHECK(ecrt_master_write_eeprom(m, 2, 4, (const uint8_t *)"ab", 2, 0, &w) == -EBUSY);
	ecrt_release_master(m);
}

void extensions(void)
{
	nobody();
	memory();
	memory_fails();
	whole_time();
	reasons();
	clock_state();
	the_rest();
	eeprom();
}
