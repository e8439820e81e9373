// SPDX-License-Identifier: LGPL-2.1-or-later
/* Who prints when it fails, and who must not; call times. */
#include "session.h"

#include <errno.h>
#include <string.h>

static ec_master_t *m;
static ec_domain_t *d;
static ec_slave_config_t *sc;
static ec_master_t *other;
static ec_slave_config_t *foreign;
static uint8_t buf[8];

/* lines that a call prints to stderr, and what it returns */
static unsigned int lines;
static long result;

static void begin(FILE **saved, char **text, size_t *size)
{
	*saved = stderr;
	stderr = open_memstream(text, size);
	if (!stderr)
		stderr = *saved;
}

static void end(FILE *saved, char **text)
{
	const char *p;

	fclose(stderr);
	stderr = saved;
	fputs(*text, stderr);
	for (lines = 0, p = *text; (p = strchr(p, '\n')); p++)
		lines++;
	free(*text);
}

#define EXPECT(n, ret, call) \
	do { \
		FILE *saved_; \
		char *text_; \
		size_t size_; \
		begin(&saved_, &text_, &size_); \
		result = (long)(call); \
		end(saved_, &text_); \
		if (lines != (n) || result != (ret)) { \
			printf("%s:%d: %s: %u lines, %ld\n", __FILE__, __LINE__, \
			       #call, lines, result); \
			failures++; \
		} \
	} while (0)

/* The kernel refuses this command from now on. */
static void refuse(unsigned int cmd, int err)
{
	fake.refuse = cmd;
	fake.err = err;
}

static void silent_ones(void)
{
	ec_master_state_t ms;
	ec_slave_config_state_t ss;
	ec_domain_state_t ds;
	uint32_t t;

	EXPECT(0, -EINVAL, ecrt_master_deactivate(m));
	EXPECT(0, -EINVAL, ecrt_master_set_send_interval(m, 0));
	refuse(EC_IOC_INTERVAL, EPERM);
	EXPECT(0, -EPERM, ecrt_master_set_send_interval(m, 1000));
	EXPECT(0, -EINVAL, ecrt_master_send(m));
	EXPECT(0, -EINVAL, ecrt_master_receive(m));
	refuse(EC_IOC_MASTER, EIO);
	EXPECT(0, -EIO, ecrt_master_state(m, &ms));
	refuse(EC_IOC_APP_TIME, EPERM);
	EXPECT(0, -EPERM, ecrt_master_application_time(m, 1));
	EXPECT(0, -EINVAL, ecrt_master_sync_reference_clock(m));
	EXPECT(0, -EINVAL, ecrt_master_sync_reference_clock_to(m, 1));
	EXPECT(0, -EINVAL, ecrt_master_sync_slave_clocks(m));
	EXPECT(0, -EINVAL, ecrt_master_sync_monitor_queue(m));
	EXPECT(0, 0xffffffff, ecrt_master_sync_monitor_process(m));
	EXPECT(0, -EINVAL, ecrt_master_reference_clock_time(m, &t));
	refuse(EC_IOC_RESET, EPERM);
	EXPECT(0, -EPERM, ecrt_master_reset(m));
	refuse(EC_IOC_SC_DC, EBUSY);
	EXPECT(0, -EBUSY, ecrt_slave_config_dc(sc, 1, 1, 1, 1, 1));
	refuse(EC_IOC_CONFIG, ENOENT);
	EXPECT(0, -ENOENT, ecrt_slave_config_state(sc, &ss));
	EXPECT(0, -EINVAL, ecrt_domain_process(d));
	EXPECT(0, -EINVAL, ecrt_domain_queue(d));
	EXPECT(0, 0, ecrt_domain_state(d, &ds));
	EXPECT(0, -ENOENT, ecrt_slave_config_emerg_pop(sc, buf));
}

static void master_prints(void)
{
	ec_master_info_t info;
	ec_master_scan_progress_t progress;
	ec_master_link_state_t link;
	ec_slave_info_t slave;
	ec_sync_info_t sync;
	ec_pdo_info_t pdo;
	ec_pdo_entry_info_t entry;
	size_t size;

	refuse(EC_IOC_MASTER, EIO);
	EXPECT(1, -EIO, ecrt_master(m, &info));
	EXPECT(1, -EIO, ecrt_master_scan_progress(m, &progress));
	refuse(EC_IOC_DEVICE, EIO);
	EXPECT(1, -EIO, ecrt_master_link_state(m, 0, &link));
	fake.refuse = 0;
	EXPECT(1, -EINVAL, ecrt_master_link_state(m, 1, &link));
	refuse(EC_IOC_SLAVE, ENOENT);
	EXPECT(1, -EINVAL, ecrt_master_get_slave(m, 9, &slave));
	EXPECT(1, -ENOENT, ecrt_master_get_sync_manager(m, 0, 16, &sync));
	EXPECT(1, -ENOENT, ecrt_master_get_pdo(m, 0, 16, 0, &pdo));
	EXPECT(1, -ENOENT, ecrt_master_get_pdo_entry(m, 0, 16, 0, 0, &entry));
	refuse(EC_IOC_SM, ENOENT);
	EXPECT(1, -EINVAL, ecrt_master_get_sync_manager(m, 0, 5, &sync));
	EXPECT(1, -EINVAL, ecrt_master_sdo_download(m, 0, 1, 1, NULL, 1, NULL));
	EXPECT(1, -EINVAL, ecrt_master_sdo_download_complete(m, 0, 1, buf, 0, NULL));
	EXPECT(1, -EINVAL, ecrt_master_sdo_upload(m, 0, 1, 1, NULL, 1, &size, NULL));
	EXPECT(1, -EINVAL, ecrt_master_sdo_upload_complete(m, 0, 1, buf, 1, NULL, NULL));
	EXPECT(1, -EINVAL, ecrt_master_select_reference_clock(m, foreign));
	refuse(EC_IOC_REF_CLOCK, ENOENT);
	EXPECT(1, -ENOENT, ecrt_master_select_reference_clock(m, NULL));
	refuse(EC_IOC_CREATE_DOMAIN, ENOMEM);
	EXPECT(1, 0, ecrt_master_create_domain(m) != NULL);
	refuse(EC_IOC_SLAVE_CONFIG, ENOENT);
	EXPECT(1, 0, ecrt_master_slave_config(m, 0, 1, 2, 3) != NULL);
	refuse(EC_IOC_ACTIVATE, ENOMEM);
	EXPECT(1, -ENOMEM, ecrt_master_activate(m));
	refuse(EC_IOC_DOMAIN, ENOENT);
	EXPECT(1, -ENOENT, (long)ecrt_domain_size(d));
}

/* what belongs before activation is refused after it, with one line */
static void config_prints(int err)
{
	static const ec_sync_info_t syncs[] = {
		{ 2, EC_DIR_OUTPUT, 0, NULL, EC_WD_ENABLE },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};
	unsigned int off;
	const ec_pdo_entry_reg_t list[] = {
		{ 0, 1, 2, 3, 0x7000, 1, &off, NULL },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	struct in_addr addr = { 0 };

	refuse(EC_IOC_SC_SYNC, -err);
	EXPECT(1, err, ecrt_slave_config_sync_manager(sc, 2, EC_DIR_OUTPUT, EC_WD_DEFAULT));
	EXPECT(1, err, ecrt_slave_config_pdos(sc, EC_END, syncs));
	refuse(EC_IOC_SC_WATCHDOG, -err);
	EXPECT(1, err, ecrt_slave_config_watchdog(sc, 1, 1));
	refuse(EC_IOC_SC_PDO, -err);
	EXPECT(1, err, ecrt_slave_config_pdo_assign_add(sc, 2, 1));
	EXPECT(1, err, ecrt_slave_config_pdo_assign_clear(sc, 2));
	EXPECT(1, err, ecrt_slave_config_pdo_mapping_add(sc, 1, 2, 3, 4));
	EXPECT(1, err, ecrt_slave_config_pdo_mapping_clear(sc, 1));
	refuse(EC_IOC_REG_ENTRY, -err);
	EXPECT(1, err, ecrt_slave_config_reg_pdo_entry(sc, 1, 1, d, NULL));
	EXPECT(1, err, ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 0, d, NULL));
	EXPECT(1, err, ecrt_domain_reg_pdo_entry_list(d, list));
	refuse(EC_IOC_SC_SDO, -err);
	EXPECT(1, err, ecrt_slave_config_sdo8(sc, 1, 1, 1));
	EXPECT(1, err, ecrt_slave_config_complete_sdo(sc, 1, buf, 1));
	refuse(EC_IOC_SC_EMERG, -err);
	EXPECT(1, err, ecrt_slave_config_emerg_size(sc, 1));
	refuse(EC_IOC_SC_REQUEST, -err);
	EXPECT(1, 0, ecrt_slave_config_create_sdo_request(sc, 1, 1, 1) != NULL);
	EXPECT(1, 0, ecrt_slave_config_create_reg_request(sc, 1) != NULL);
	refuse(EC_IOC_DATAGRAM_REQUEST, -err);
	EXPECT(1, 0, ecrt_master_create_datagram_request(m, 1) != NULL);
	refuse(EC_IOC_SC_FLAG, -err);
	EXPECT(1, err, ecrt_slave_config_flag(sc, "a", 1));
	refuse(EC_IOC_SC_TIMEOUT, -err);
	EXPECT(1, err, ecrt_slave_config_state_timeout(sc, EC_AL_STATE_INIT,
						       EC_AL_STATE_OP, 1));
	refuse(EC_IOC_SC_IP, -err);
	EXPECT(1, err, ecrt_slave_config_eoe_ip_address(sc, addr));
	fake.refuse = 0;
}

static void wrong_arguments(void)
{
	EXPECT(1, -EINVAL, ecrt_slave_config_reg_pdo_entry(sc, 1, 1, NULL, NULL));
	EXPECT(1, -EINVAL, ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 0, NULL, NULL));
	EXPECT(1, -EINVAL, ecrt_slave_config_flag(sc, NULL, 1));
	EXPECT(1, -EINVAL, ecrt_slave_config_eoe_mac_address(sc, NULL));
	EXPECT(1, -EINVAL, ecrt_slave_config_eoe_hostname(sc, NULL));
	EXPECT(1, -EINVAL, ecrt_slave_config_sdo(sc, 1, 1, NULL, 1));
	EXPECT(0, 0, ecrt_slave_config_pdos(sc, 3, NULL));
}

/* lcec deactivates every master, activated or not, and releases it then */
static void ends(void)
{
	EXPECT(0, -EINVAL, ecrt_master_deactivate(m));
	EXPECT(0, 11, (long)ecrt_domain_size(d));	/* nothing was freed */
	CHECK(!ecrt_master_application_time(m, 77));
	CHECK(!ecrt_master_activate(m));
	fake.status->dc_ref = 1;
	CHECK(!ecrt_master_sync_reference_clock(m) && !ecrt_master_send(m));
	CHECK(((struct ec_ioc_send *)fake.arg)->sync_time == 77);
	EXPECT(1, 0, ecrt_master_activate(m));
	CHECK(!ecrt_master_deactivate(m));
	EXPECT(0, -EINVAL, ecrt_master_deactivate(m));
	/* its time is forgotten */
	CHECK(!ecrt_master_activate(m));
	fake.status->dc_ref = 1;
	CHECK(!ecrt_master_sync_reference_clock(m) && !ecrt_master_send(m));
	CHECK(!((struct ec_ioc_send *)fake.arg)->sync_time);
	ecrt_release_master(m);
}

void rules(void)
{
	other = ecrt_request_master(0);
	foreign = ecrt_master_slave_config(other, 0, 1, 2, 3);
	m = start();
	d = ecrt_master_create_domain(m);
	sc = ecrt_master_slave_config(m, 0, 1, 2, 3);
	silent_ones();
	fake.refuse = 0;
	master_prints();
	config_prints(-EBUSY);
	config_prints(-EPERM);
	wrong_arguments();
	ends();
	ecrt_release_master(other);
}
