// SPDX-License-Identifier: LGPL-2.1-or-later
/* The library from open to release, against fake.c. */

#include "../fake/app_side.h"
#include "session.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

int failures;

ec_master_t *start(void)
{
	memset(&fake, 0, sizeof(fake));
	fake.image_size = 8192;
	return ecrt_request_master(0);
}

static void null_arguments(void)
{
	ec_domain_t *d = NULL;
	ec_slave_config_t *sc = NULL;
	ec_master_t *m = NULL;
	struct in_addr addr = { 0 };
	uint32_t code = 5;
	size_t size;
	uint8_t byte;

	CHECK(!ecrt_master_create_domain(m));
	CHECK(!ecrt_master_slave_config(m, 0, 0, 0, 0));
	CHECK(ecrt_master_reserve(m) == -EINVAL);
	CHECK(ecrt_master(m, NULL) == -EINVAL);
	CHECK(ecrt_master_scan_progress(m, NULL) == -EINVAL);
	CHECK(ecrt_master_get_slave(m, 0, NULL) == -EINVAL);
	CHECK(ecrt_master_get_sync_manager(m, 0, 0, NULL) == -EINVAL);
	CHECK(ecrt_master_get_pdo(m, 0, 0, 0, NULL) == -EINVAL);
	CHECK(ecrt_master_get_pdo_entry(m, 0, 0, 0, 0, NULL) == -EINVAL);
	CHECK(ecrt_master_sdo_download(m, 0, 0, 0, &byte, 1, &code) == -EINVAL);
	CHECK(!code);
	CHECK(ecrt_master_sdo_download_complete(m, 0, 0, &byte, 1, NULL) ==
	      -EINVAL);
	CHECK(ecrt_master_sdo_upload(m, 0, 0, 0, &byte, 1, &size, NULL) ==
	      -EINVAL);
	CHECK(ecrt_master_activate(m) == -EINVAL);
	CHECK(ecrt_master_deactivate(m) == -EINVAL);
	CHECK(ecrt_master_set_send_interval(m, 1) == -EINVAL);
	CHECK(ecrt_master_send(m) == -EINVAL);
	CHECK(ecrt_master_receive(m) == -EINVAL);
	CHECK(ecrt_master_state(m, NULL) == -EINVAL);
	CHECK(ecrt_master_link_state(m, 0, NULL) == -EINVAL);
	CHECK(ecrt_master_application_time(m, 0) == -EINVAL);
	CHECK(ecrt_master_reset(m) == -EINVAL);
	CHECK(ecrt_slave_config_sync_manager(sc, 0, EC_DIR_INPUT,
					     EC_WD_DEFAULT) == -EINVAL);
	CHECK(ecrt_slave_config_watchdog(sc, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_pdo_assign_add(sc, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_pdo_assign_clear(sc, 0) == -EINVAL);
	CHECK(ecrt_slave_config_pdo_mapping_add(sc, 0, 0, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_pdo_mapping_clear(sc, 0) == -EINVAL);
	CHECK(ecrt_slave_config_pdos(sc, EC_END, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0, 0, d, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_reg_pdo_entry_pos(sc, 0, 0, 0, d, NULL) ==
	      -EINVAL);
	CHECK(ecrt_slave_config_sdo(sc, 0, 0, NULL, 0) == -EINVAL);
	CHECK(ecrt_slave_config_sdo8(sc, 0, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_sdo16(sc, 0, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_sdo32(sc, 0, 0, 0) == -EINVAL);
	CHECK(ecrt_slave_config_complete_sdo(sc, 0, NULL, 0) == -EINVAL);
	CHECK(ecrt_slave_config_state(sc, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_flag(sc, "a", 0) == -EINVAL);
	CHECK(ecrt_slave_config_state_timeout(sc, EC_AL_STATE_INIT,
					      EC_AL_STATE_OP, 1) == -EINVAL);
	CHECK(ecrt_slave_config_sdo_timeout(sc, 1) == -EINVAL);
	CHECK(ecrt_slave_config_replay(sc, EC_REPLAY_ALL) == -EINVAL);
	CHECK(ecrt_slave_config_replay_sdo(sc, 0x607a, 0) == -EINVAL);
	CHECK(ecrt_slave_config_replay_idn(sc, 0, 36) == -EINVAL);
	CHECK(ecrt_slave_config_held(sc) == -EINVAL);
	CHECK(ecrt_slave_config_resume(sc, 1) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_mac_address(sc, &byte) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_ip_address(sc, addr) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_subnet_mask(sc, addr) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_default_gateway(sc, addr) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_dns_address(sc, addr) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_hostname(sc, "a") == -EINVAL);
	CHECK(ecrt_domain_reg_pdo_entry_list(d, NULL) == -EINVAL);
	CHECK(ecrt_domain_size(d) == (size_t)-EINVAL);
	CHECK(!ecrt_domain_data(d));
	CHECK(ecrt_domain_process(d) == -EINVAL);
	CHECK(ecrt_domain_queue(d) == -EINVAL);
	CHECK(ecrt_domain_state(d, NULL) == -EINVAL);
	ecrt_release_master(m);
}

static void opening(void)
{
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	CHECK(!ecrt_open_master(7) && errno == ENOENT);
	fake.refuse = EC_IOC_RESERVE;
	fake.err = EBUSY;
	fake.reason = "owned by somebody\nsecond line";
	CHECK(!ecrt_request_master(0));
	CHECK(errno == EBUSY && fake.opens == 1 && fake.closes == 1);
	fake.refuse = EC_IOC_VERSION;
	fake.err = ENOTTY;
	CHECK(!ecrt_open_master(0) && fake.closes == 2);
	/* a later module that does not serve this library any more, and says so */
	fake.err = EPROTO;
	fake.reason = "rebuild the program";
	CHECK(!ecrt_open_master(0) && errno == EPROTO && fake.closes == 3);

	memset(&fake, 0, sizeof(fake));
	m = ecrt_open_master(0);
	CHECK(m && fake.last == EC_IOC_VERSION);
	CHECK(((struct ec_ioc_version *)fake.arg)->abi == EC_UAPI_VERSION);
	/* the commands of a cycle are given once by ioctl(), for policies that examine it */
	CHECK(!fake.received && !fake.admitted);
	CHECK(!ecrt_master_reserve(m) && fake.received && fake.admitted);
	CHECK(ecrt_master_deactivate(m) == -EINVAL);
	CHECK(ecrt_master_send(m) == -EINVAL);
	ecrt_release_master(m);
	CHECK(fake.closes == 1);
}

static void information(void)
{
	ec_master_t *m = start();
	ec_master_info_t info;
	ec_master_scan_progress_t progress;
	ec_master_state_t state;
	ec_master_link_state_t link;
	ec_slave_info_t slave;
	ec_sync_info_t sync;
	ec_pdo_info_t pdo;

	CHECK(!ecrt_master(m, &info) && info.slave_count == 3 &&
	      info.link_up && info.app_time == 12345);
	CHECK(!ecrt_master_scan_progress(m, &progress) &&
	      progress.slave_count == 5 && progress.scan_index == 2);
	CHECK(!ecrt_master_state(m, &state) && state.slaves_responding == 3 &&
	      state.al_states == 2 && state.link_up);
	CHECK(!ecrt_master_link_state(m, 0, &link) &&
	      link.slaves_responding == 3 && link.link_up);
	CHECK(ecrt_master_link_state(m, 1, &link) == -EINVAL);
	CHECK(!ecrt_master_get_slave(m, 1, &slave));
	CHECK(slave.position == 1 && slave.vendor_id == 2 &&
	      slave.al_state == 0x14 && slave.error_flag == 1 &&
	      slave.alias == 9 && slave.current_on_ebus == -2000);
	CHECK(strlen(slave.name) == 63);
	CHECK(slave.ports[1].desc == EC_PORT_MII &&
	      slave.ports[1].next_slave == 7);
	CHECK(!ecrt_master_get_sync_manager(m, 1, 2, &sync));
	CHECK(sync.index == 2 && sync.dir == EC_DIR_OUTPUT &&
	      sync.n_pdos == 2 && !sync.pdos &&
	      sync.watchdog_mode == EC_WD_ENABLE);
	CHECK(ecrt_master_get_sync_manager(m, 1, 16, &sync) == -ENOENT);
	CHECK(ecrt_master_get_pdo(m, 1, 16, 0, &pdo) == -ENOENT);
	fake.refuse = EC_IOC_SLAVE;
	fake.err = ENOENT;
	CHECK(ecrt_master_get_slave(m, 9, &slave) == -EINVAL);
	/* it was disconnected before its name was read, and another one has its position */
	fake.refuse = EC_IOC_SLAVE_NAMES;
	fake.err = ENODEV;
	CHECK(ecrt_master_get_slave(m, 1, &slave) == -ENODEV);
	ecrt_release_master(m);
}

static void objects(void)
{
	ec_master_t *m = start();
	uint8_t buf[8];
	size_t size = 99;
	uint32_t code = 1;

	CHECK(!ecrt_master_sdo_upload(m, 1, 0x1018, 1, buf, sizeof(buf), &size,
				      &code));
	CHECK(size == 4 && EC_READ_U32(buf) == 2 && !code);
	fake.refuse = EC_IOC_SDO_UPLOAD;
	fake.err = EIO;
	size = 99;
	CHECK(ecrt_master_sdo_upload(m, 1, 0x1018, 1, buf, sizeof(buf), &size,
				     &code) == -EIO);
	CHECK(size == 99 && code == 0x06020000);
	fake.err = ENOBUFS;
	CHECK(ecrt_master_sdo_upload(m, 1, 0x1018, 1, buf, sizeof(buf), &size,
				     &code) == -ENOBUFS && !code);
	CHECK(ecrt_master_sdo_download(m, 1, 0x1018, 1, buf, 0, &code) ==
	      -EINVAL);
	CHECK(!ecrt_master_sdo_download_complete(m, 1, 0x1c12, buf, 4, &code));
	CHECK(((struct ec_ioc_sdo *)fake.arg)->flags == EC_SDO_FLAG_COMPLETE);
	ecrt_release_master(m);
}

static void configuration(void)
{
	static const ec_pdo_entry_info_t entries[] = { { 0x7000, 1, 8 },
						       { 0, 0, 8 } };
	static const ec_pdo_info_t pdos[] = { { 0x1600, 2, entries },
					      { 0x1601, 0, NULL } };
	static const ec_sync_info_t syncs[] = {
		{ 2, EC_DIR_OUTPUT, 2, pdos, EC_WD_ENABLE },
		{ 3, EC_DIR_INPUT, 0, NULL, EC_WD_DEFAULT },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
		{ 4, EC_DIR_INPUT, 0, NULL, EC_WD_DEFAULT },
	};
	static const ec_sync_info_t bad[] = {
		{ 16, EC_DIR_OUTPUT, 0, NULL, EC_WD_DEFAULT },
	};
	static const unsigned int ops[] = {
		EC_SC_PDO_ASSIGN_CLEAR << 24 | 2 << 16,
		EC_SC_PDO_ASSIGN_ADD << 24 | 2 << 16 | 0x1600,
		EC_SC_PDO_MAP_CLEAR << 24 | 0x1600,
		EC_SC_PDO_MAP_ADD << 24 | 0x7000,
		EC_SC_PDO_MAP_ADD << 24 | 0,
		EC_SC_PDO_ASSIGN_ADD << 24 | 2 << 16 | 0x1601,
		EC_SC_PDO_ASSIGN_CLEAR << 24 | 3 << 16,
	};
	struct ec_ioc_sc_sdo *sdo = (void *)fake.arg;
	unsigned int bit = 9, off = 0, off2 = 0, bit2 = 0;
	const ec_pdo_entry_reg_t list[] = {
		{ 0, 1, 2, 3, 0x7000, 1, &off, NULL },
		{ 0, 2, 2, 3, 0x6010, 1, &off2, &bit2 },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const ec_pdo_entry_reg_t no_place[] = {
		{ 0, 1, 2, 3, 0x7000, 1, NULL, NULL },
	};
	ec_slave_config_state_t state;
	ec_slave_config_t *sc;
	ec_master_t *m = start();
	ec_domain_t *d;
	char key[65];

	d = ecrt_master_create_domain(m);
	sc = ecrt_master_slave_config(m, 0, 1, 2, 3);
	CHECK(d && sc && ecrt_master_slave_config(m, 0, 1, 2, 3) == sc);

	CHECK(!ecrt_slave_config_pdos(sc, EC_END, NULL));
	CHECK(!ecrt_slave_config_pdos(sc, EC_END, syncs));
	CHECK(fake.n_pdo_ops == 7 && !memcmp(fake.pdo_ops, ops, sizeof(ops)));
	CHECK(!ecrt_slave_config_pdos(sc, 0, syncs));
	CHECK(ecrt_slave_config_pdos(sc, 1, bad) == -ENOENT);
	CHECK(ecrt_slave_config_sync_manager(sc, 2, EC_DIR_INVALID,
					     EC_WD_DEFAULT) == -EINVAL);
	CHECK(ecrt_slave_config_pdo_assign_add(sc, 16, 1) == -EINVAL);

	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x7000, 1, d, NULL) == 3);
	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x6010, 1, d, NULL) ==
	      -EFAULT);
	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x6010, 1, d, &bit) == 8 &&
	      bit == 5);
	CHECK(ecrt_slave_config_reg_pdo_entry_pos(sc, 16, 0, 0, d, &bit) ==
	      -EINVAL);
	CHECK(ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 0, d, &bit) == 8 &&
	      !bit);
	CHECK(!ecrt_domain_reg_pdo_entry_list(d, list) && off == 3 &&
	      off2 == 8 && bit2 == 5);
	CHECK(ecrt_domain_reg_pdo_entry_list(d, no_place) == -EINVAL);
	fake.refuse = EC_IOC_REG_ENTRY;
	fake.err = ENOENT;
	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x6000, 1, d, NULL) ==
	      -ENOENT);
	fake.refuse = EC_IOC_SLAVE_CONFIG;
	CHECK(ecrt_domain_reg_pdo_entry_list(d, list) == -ENOENT);
	fake.refuse = 0;

	CHECK(!ecrt_slave_config_sdo32(sc, 0x8000, 1, 0x12345678));
	CHECK(fake.last == EC_IOC_SC_SDO && sdo->size == 4 && sdo->config == 1);
	CHECK(!ecrt_slave_config_sdo16(sc, 0x8000, 1, 0x1234) && sdo->size == 2);
	CHECK(!ecrt_slave_config_sdo8(sc, 0x8000, 1, 0x12) && sdo->size == 1);
	CHECK(!ecrt_slave_config_complete_sdo(sc, 0x8000, (uint8_t *)"abc", 3) &&
	      sdo->flags == EC_SDO_FLAG_COMPLETE);
	CHECK(ecrt_slave_config_sdo(sc, 0x8000, 1, NULL, 1) == -EINVAL);

	memset(key, 'k', 64);
	key[64] = '\0';
	CHECK(ecrt_slave_config_flag(sc, key, 1) == -EINVAL);
	key[63] = '\0';
	CHECK(!ecrt_slave_config_flag(sc, key, -1));
	CHECK(!strcmp(((struct ec_ioc_sc_flag *)fake.arg)->key, key));
	CHECK(ecrt_slave_config_flag(sc, "", 1) == -EINVAL);
	CHECK(!ecrt_slave_config_state_timeout(sc, EC_AL_STATE_INIT,
					       EC_AL_STATE_PREOP, 10));
	CHECK(ecrt_slave_config_state_timeout(sc, EC_AL_STATE_INIT,
					      (ec_al_state_t)3, 1) == -EINVAL);
	CHECK(!ecrt_slave_config_sdo_timeout(sc, 20000));
	CHECK(((struct ec_ioc_sc_timeout *)fake.arg)->flags == EC_SC_TIMEOUT_REPLY &&
	      ((struct ec_ioc_sc_timeout *)fake.arg)->timeout_ms == 20000);
	CHECK(!ecrt_slave_config_state(sc, &state) && state.online &&
	      !state.operational && state.al_state == 2);
	CHECK(!ecrt_master_set_send_interval(m, 1000));
	CHECK(ecrt_master_set_send_interval(m, 0) == -EINVAL);
	CHECK(!ecrt_master_set_send_interval(m, SIZE_MAX));
	ecrt_release_master(m);
}

static void foreign_domain(void)
{
	ec_master_t *a = start(), *b = ecrt_request_master(0);
	ec_slave_config_t *sc = ecrt_master_slave_config(a, 0, 1, 2, 3);
	ec_domain_t *d = ecrt_master_create_domain(b);

	CHECK(ecrt_slave_config_reg_pdo_entry(sc, 0x7000, 1, d, NULL) ==
	      -EINVAL);
	ecrt_release_master(a);
	ecrt_release_master(b);
}

static void cycle(void)
{
	ec_master_t *m = start();
	ec_domain_t *d0 = ecrt_master_create_domain(m);
	ec_domain_t *d1 = ecrt_master_create_domain(m);
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 2, 3);
	ec_slave_config_state_t sstate;
	ec_domain_state_t state;
	ec_master_state_t mstate;
	ec_master_link_state_t link;
	unsigned int calls;

	CHECK(!ecrt_domain_data(d0) && ecrt_domain_size(d0) == 11);
	CHECK(ecrt_domain_queue(d0) == -EINVAL);
	CHECK(!ecrt_master_activate(m));
	CHECK(!ecrt_master_activate(m));
	CHECK(ecrt_domain_data(d0) == fake.image);
	CHECK(ecrt_domain_data(d1) == fake.image + 16);
	CHECK(ecrt_domain_size(d1) == 16);

	/* only d1 goes out */
	calls = fake.calls;
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d0) &&
	      !ecrt_domain_process(d1) && !ecrt_domain_queue(d1) &&
	      !ecrt_master_send(m));
	CHECK(fake.calls == calls + 2 && fake.sent == 2);
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d1));	/* not back yet */
	CHECK(!ecrt_domain_state(d1, &state) && !state.working_counter);
	fake.status->domains[1].working_counter = 3;
	fake.status->domains[1].wc_state = EC_WC_COMPLETE;
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d0) &&
	      !ecrt_domain_process(d1));
	CHECK(!ecrt_domain_state(d0, &state) && !state.working_counter);
	CHECK(!ecrt_domain_state(d1, &state) && state.working_counter == 3 &&
	      state.wc_state == EC_WC_COMPLETE);

	/* a snapshot: it changes with process only */
	fake.status->domains[1].working_counter = 9;
	CHECK(!ecrt_domain_state(d1, &state) && state.working_counter == 3);
	CHECK(!ecrt_master_send(m) && fake.sent == 0);

	fake.status->slaves_responding = 6;
	fake.status->al_states = 8;
	fake.status->link_up = 1;
	fake.status->configs[5] = EC_STATUS_SC_ONLINE | EC_STATUS_SC_OP | 8;
	calls = fake.calls;
	CHECK(!ecrt_master_state(m, &mstate) && mstate.slaves_responding == 6 &&
	      mstate.al_states == 8 && mstate.link_up);
	CHECK(!ecrt_slave_config_state(sc, &sstate) && sstate.online &&
	      sstate.operational && sstate.al_state == 8);
	fake.status->links[1].slaves_responding = 4;
	fake.status->links[1].al_states = 2;
	fake.status->link_count = 2;
	CHECK(!ecrt_master_link_state(m, 1, &link) && link.slaves_responding == 4 &&
	      link.al_states == 2 && !link.link_up);
	CHECK(fake.calls == calls);
	CHECK(!ecrt_master_application_time(m, ~0ULL));

	fake.refuse = EC_IOC_SEND;
	fake.err = ENETDOWN;
	CHECK(ecrt_master_send(m) == -ENETDOWN);

	CHECK(!ecrt_master_deactivate(m) && fake.last == EC_IOC_DEACTIVATE);
	CHECK(ecrt_master_deactivate(m) == -EINVAL);
	fake.domains = 0;
	d0 = ecrt_master_create_domain(m);	/* and once more */
	CHECK(d0 && !ecrt_master_activate(m) && ecrt_domain_data(d0));
	ecrt_release_master(m);
}

static int exchange(ec_master_t *m)
{
	int ret = ecrt_master_receive(m);

	return ret ? ret : ecrt_master_send(m);
}

/* The short way into the kernel; ioctl() where it is not open, or cannot carry what is sent. */
static void advice(void)
{
	struct ec_ioc_send send;
	ec_master_t *m = start();
	ec_domain_t *d = ecrt_master_create_domain(m);
	unsigned int before;

	fake.advised = 0;
	CHECK(!ecrt_master_activate(m) && !ecrt_domain_queue(d));
	fake.status->dc_ref = 1;
	CHECK(!ecrt_master_application_time(m, 0x8000000000000005ULL));
	CHECK(!ecrt_master_sync_reference_clock(m));
	CHECK(!exchange(m) && fake.advised == 2);
	memcpy(&send, fake.arg, sizeof(send));
	CHECK(send.flags == (EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF) && send.queued == 1);
	CHECK(send.app_time == 0x8000000000000005ULL && send.sync_time == send.app_time);

	/* two times do not fit */
	CHECK(!ecrt_master_sync_reference_clock_to(m, 7) && !exchange(m) && fake.advised == 3);
	memcpy(&send, fake.arg, sizeof(send));
	CHECK(send.sync_time == 7 && send.app_time == 0x8000000000000005ULL);

	/* the command says why */
	fake.refuse = EC_IOC_RECEIVE;
	fake.err = EPERM;
	before = fake.calls;
	CHECK(ecrt_master_receive(m) == -EPERM && fake.calls == before + 2);
	fake.refuse = 0;

	/* a filter: each call tries */
	fake.no_advice = EPERM;
	before = fake.advised;
	CHECK(!exchange(m) && !exchange(m) && fake.advised == before + 4);
	/* a module without it: one */
	fake.no_advice = EINVAL;
	CHECK(!exchange(m) && !exchange(m) && fake.advised == before + 5);
	fake.no_advice = 0;
	CHECK(!exchange(m) && fake.advised == before + 5);
	ecrt_release_master(m);
}

/* How process data are sent: what is asked for reaches the kernel. */
static void layout(void)
{
	const struct ec_ioc_domain_options *o = (const void *)fake.arg;
	const struct ec_ioc_domain_age *a = (const void *)fake.arg;
	const struct ec_ioc_sc_overlap *v = (const void *)fake.arg;
	ec_domain_age_t age;
	ec_master_t *m = start();
	ec_domain_t *d;
	ec_slave_config_t *sc;

	ecrt_master_create_domain(m);
	d = ecrt_master_create_domain(m);
	sc = ecrt_master_slave_config(m, 0, 5, 2, 3);
	CHECK(ecrt_domain_set_options(NULL, 0) == -EINVAL);
	CHECK(ecrt_slave_config_overlapping_pdos(NULL, 1) == -EINVAL);
	CHECK(!ecrt_domain_set_options(d, EC_DOMAIN_OVERLAP | EC_DOMAIN_OWN_FRAME));
	CHECK(fake.last == EC_IOC_DOMAIN_OPTIONS && o->domain == 1 && o->options == 5);
	CHECK(!ecrt_slave_config_overlapping_pdos(sc, 2));
	CHECK(fake.last == EC_IOC_SC_OVERLAP && v->config == 5 && v->overlap == 1);
	CHECK(!ecrt_slave_config_overlapping_pdos(sc, 0) && !v->overlap);
	CHECK(ecrt_master_set_late_cycles(NULL, 1) == -EINVAL);
	CHECK(!ecrt_master_set_late_cycles(m, 7) && fake.last == EC_IOC_LATE &&
	      ((const struct ec_ioc_late *)fake.arg)->per_s == 7);
	CHECK(ecrt_domain_age(NULL, &age) == -EINVAL && ecrt_domain_age(d, NULL) == -EINVAL);
	CHECK(!ecrt_domain_age(d, &age) && age.limit == 2 && !age.stale);
	CHECK(ecrt_domain_set_max_age(NULL, 1) == -EINVAL);
	CHECK(!ecrt_domain_set_max_age(d, 9) && fake.last == EC_IOC_DOMAIN_AGE &&
	      a->domain == 1 && a->max_age == 9);
	CHECK(!ecrt_domain_age(d, &age) && age.limit == 9);
	fake.refuse = EC_IOC_DOMAIN_AGE;
	fake.err = EBUSY;
	CHECK(ecrt_domain_set_max_age(d, 3) == -EBUSY);
	CHECK(!ecrt_domain_age(d, &age) && age.limit == 9);
	fake.refuse = EC_IOC_DOMAIN_OPTIONS;
	fake.err = EOPNOTSUPP;
	CHECK(ecrt_domain_set_options(d, 8) == -EOPNOTSUPP);
	fake.refuse = EC_IOC_LATE;
	CHECK(ecrt_master_set_late_cycles(m, 0) == -EOPNOTSUPP);
	fake.refuse = EC_IOC_SC_OVERLAP;
	fake.err = EBUSY;
	CHECK(ecrt_slave_config_overlapping_pdos(sc, 1) == -EBUSY);
	ecrt_release_master(m);
}

/* What a slave gets that returns. */
static void replay(void)
{
	const struct ec_ioc_sc_replay *r = (const void *)fake.arg;
	const struct ec_ioc_hold *h = (const void *)fake.arg;
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 2, 3);

	CHECK(!ecrt_slave_config_replay(sc, EC_REPLAY_NONE) && fake.last == EC_IOC_SC_REPLAY);
	CHECK(r->config == 5 && r->mode == 1 && !r->flags);
	CHECK(!ecrt_slave_config_replay_sdo(sc, 0x607a, 3) && r->flags == EC_SC_REPLAY_SDO);
	CHECK(r->config == 5 && r->object == 0x607a && r->subindex == 3);
	CHECK(!ecrt_slave_config_replay_idn(sc, 7, 36) && r->flags == EC_SC_REPLAY_IDN);
	CHECK(r->config == 5 && r->object == 36 && r->subindex == 7);
	CHECK(ecrt_slave_config_replay_idn(sc, 8, 36) == -EINVAL);
	CHECK(!ecrt_slave_config_held(sc) && fake.last == EC_IOC_HOLD);
	CHECK(h->config == 5 && !h->flags);
	CHECK(!ecrt_slave_config_resume(sc, 9) && h->flags == EC_HOLD_FLAG_RESUME);
	CHECK(h->config == 5 && h->hold == 9);
	CHECK(ecrt_slave_config_resume(sc, 0) == -EINVAL);
	fake.refuse = EC_IOC_HOLD;
	fake.err = ESTALE;
	CHECK(ecrt_slave_config_resume(sc, 9) == -ESTALE);
	ecrt_release_master(m);
}

static void empty_image(void)
{
	ec_master_t *m = start();
	ec_domain_t *d = ecrt_master_create_domain(m);

	fake.image_size = 0;
	CHECK(!ecrt_master_activate(m) && !ecrt_domain_data(d));
	CHECK(!ecrt_domain_size(d) && !ecrt_domain_queue(d) &&
	      !ecrt_master_send(m) && !ecrt_master_receive(m));
	ecrt_release_master(m);
}

static void failed_activation(void)
{
	ec_master_t *m = start();
	ec_domain_t *d = ecrt_master_create_domain(m);

	fake.refuse = EC_IOC_DOMAIN_OFFSET;
	fake.err = EINVAL;
	CHECK(ecrt_master_activate(m) == -EINVAL);
	CHECK(fake.last == EC_IOC_DEACTIVATE && !ecrt_domain_data(d));
	CHECK(ecrt_master_deactivate(m) == -EINVAL);
	ecrt_release_master(m);
}

int main(void)
{
	CHECK(ecrt_version_magic() == 262);
	null_arguments();
	opening();
	information();
	objects();
	configuration();
	eoe();
	events();
	extensions();
	rules();
	foreign_domain();
	cycle();
	advice();
	layout();
	replay();
	empty_image();
	failed_activation();
	requests();
	idns_and_vendor_messages();
	files();
	dictionary();
	failures += kernel_cycle();
	return failures != 0;
}
