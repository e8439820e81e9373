// SPDX-License-Identifier: GPL-2.0-only
/* What a master that is only opened tells, and its SDO transfers. */
#include "api.h"

static ec_master_t *m;

static void master_info(void)
{
	ec_master_scan_progress_t p;
	ec_master_link_state_t l;
	ec_master_info_t i;
	ec_master_state_t s;

	IS(CALL(ecrt_master)(m, &i), 0);
	IS(i.slave_count, SLAVES);
	IS(i.link_up, 1);
	IS(i.scan_busy, 0);
	IS(CALL(ecrt_master_scan_progress)(m, &p), 0);
	IS(p.slave_count, SLAVES);
	IS(p.scan_index, SLAVES);
	IS(CALL(ecrt_master_state)(m, &s), 0);
	IS(s.slaves_responding, SLAVES);
	IS(s.al_states, EC_AL_STATE_PREOP);
	IS(s.link_up, 1);
	IS(CALL(ecrt_master_link_state)(m, 0, &l), 0);
	IS(l.slaves_responding, SLAVES);
	IS(l.al_states, EC_AL_STATE_PREOP);
	IS(l.link_up, 1);
	SAYS(CALL(ecrt_master_link_state)(m, 1, &l), -EINVAL);
	SILENT(CALL(ecrt_master_reset)(m), 0);
}

static void slaves(void)
{
	ec_slave_info_t s;

	for (uint16_t i = 0; i < SLAVES; i++) {
		memset(&s, 0xff, sizeof(s));
		IS(CALL(ecrt_master_get_slave)(m, i, &s), 0);
		IS(s.position, i);
		IS(s.al_state, EC_AL_STATE_PREOP);
		IS(s.error_flag, 0);
		YES(memchr(s.name, 0, sizeof(s.name)) != NULL);
		IS(s.ports[0].link.link_up, 1);
		IS(s.ports[1].link.link_up, i + 1 < SLAVES);
		IS(s.ports[1].next_slave, i + 1 < SLAVES ? i + 1 : 0xffff);
	}
	IS(CALL(ecrt_master_get_slave)(m, OUT, &s), 0);
	IS(s.vendor_id, BECKHOFF);
	IS(s.product_code, EL2008);
	IS(s.alias, 1001);
	IS(s.current_on_ebus, 110);
	IS(s.sync_count, 1);
	YES(!strcmp(s.name, "EL2008 8-ch output"));
	IS(s.ports[0].desc, EC_PORT_EBUS);
	IS(CALL(ecrt_master_get_slave)(m, MOTOR, &s), 0);
	IS(s.serial_number, 77);
	IS(s.sync_count, 4);
	SAYS(CALL(ecrt_master_get_slave)(m, SLAVES, &s), -EINVAL);
	SAYS(CALL(ecrt_master_get_slave)(m, 0xffff, &s), -EINVAL);
}

static void process_data(void)
{
	ec_pdo_entry_info_t e;
	ec_sync_info_t s;
	ec_pdo_info_t p;

	memset(&s, 0xff, sizeof(s));
	IS(CALL(ecrt_master_get_sync_manager)(m, OUT, 0, &s), 0);
	IS(s.index, 0);
	IS(s.dir, EC_DIR_OUTPUT);
	IS(s.n_pdos, 8);
	YES(!s.pdos);
	IS(s.watchdog_mode, EC_WD_ENABLE);
	IS(CALL(ecrt_master_get_sync_manager)(m, IN, 0, &s), 0);
	IS(s.dir, EC_DIR_INPUT);
	IS(s.watchdog_mode, EC_WD_DISABLE);
	IS(CALL(ecrt_master_get_sync_manager)(m, OUT, EC_MAX_SYNC_MANAGERS, &s), -ENOENT);
	SAYS(CALL(ecrt_master_get_sync_manager)(m, OUT, 9, &s), -EINVAL);
	SAYS(CALL(ecrt_master_get_sync_manager)(m, NOWHERE, 0, &s), -EINVAL);

	memset(&p, 0xff, sizeof(p));
	IS(CALL(ecrt_master_get_pdo)(m, OUT, 0, 7, &p), 0);
	IS(p.index, 0x1607);
	IS(p.n_entries, 1);
	YES(!p.entries);
	IS(CALL(ecrt_master_get_pdo)(m, OUT, EC_MAX_SYNC_MANAGERS, 0, &p), -ENOENT);
	SAYS(CALL(ecrt_master_get_pdo)(m, OUT, 0, 8, &p), -EINVAL);
	SAYS(CALL(ecrt_master_get_pdo)(m, NOWHERE, 0, 0, &p), -EINVAL);

	IS(CALL(ecrt_master_get_pdo_entry)(m, OUT, 0, 7, 0, &e), 0);
	IS(e.index, 0x7070);
	IS(e.subindex, 1);
	IS(e.bit_length, 1);
	IS(CALL(ecrt_master_get_pdo_entry)(m, OUT, EC_MAX_SYNC_MANAGERS, 0, 0, &e), -ENOENT);
	SAYS(CALL(ecrt_master_get_pdo_entry)(m, OUT, 0, 7, 1, &e), -EINVAL);
	SAYS(CALL(ecrt_master_get_pdo_entry)(m, OUT, 0, 8, 0, &e), -EINVAL);
	SAYS(CALL(ecrt_master_get_pdo_entry)(m, NOWHERE, 0, 0, 0, &e), -EINVAL);
}

/* an entry without object: the drive has one after its mode */
static void gap(void)
{
	ec_pdo_entry_info_t e;
	unsigned int gaps = 0;
	ec_pdo_info_t p;

	NEED(!CALL(ecrt_master_get_pdo)(m, MOTOR, 2, 0, &p));
	for (uint16_t i = 0; i < p.n_entries; i++)
		if (!CALL(ecrt_master_get_pdo_entry)(m, MOTOR, 2, 0, i, &e) && !e.index)
			gaps += IS(e.bit_length, 8) && IS(e.subindex, 0);
	IS(gaps, 1);
}

static void downloads(void)
{
	const uint8_t value[4] = { 0xcd, 0xab, 0x34, 0x12 };
	uint32_t abort = 0xffffffff;
	uint8_t back[4] = { 0 };
	size_t size = 99;

	IS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x2001, 8, value, 4, &abort), 0);
	IS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x2001, 8, back, 4, &size, &abort), 0);
	IS(size, 4);
	IS(EC_READ_U32(back), 0x1234abcd);
	SAYS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x3fff, 0, value, 4, &abort), -EIO);
	IS(abort, 0x06020000);
	SAYS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x1018, 1, value, 4, &abort), -EIO);
	IS(abort, 0x06010002);
	IS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x2001, 8, NULL, 4, &abort), -EINVAL);
	IS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x2001, 8, value, 0, &abort), -EINVAL);
	SAYS(CALL(ecrt_master_sdo_download)(m, NOWHERE, 0x2001, 8, value, 4, &abort), -EINVAL);
	IS(abort, 0);
	SAYS(CALL(ecrt_master_sdo_download)(m, OUT, 0x2001, 8, value, 4, NULL), -EPROTONOSUPPORT);
}

static void uploads(void)
{
	static uint8_t big[1000], back[1000];
	uint32_t abort = 0;
	size_t size = 99;

	SAYS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 9, back, 4, &size, &abort), -EIO);
	IS(abort, 0x06090011);
	IS(size, 99);
	back[0] = 0x55;
	SAYS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, back, 3, &size, &abort), -ENOBUFS);
	IS(size, 99);
	IS(back[0], 0x55);
	IS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, back, 4, NULL, &abort), -EINVAL);
	SAYS(CALL(ecrt_master_sdo_upload)(m, NOWHERE, 0x1018, 1, back, 4, &size, &abort), -EINVAL);
	SAYS(CALL(ecrt_master_sdo_upload)(m, OUT, 0x1018, 1, back, 4, &size, &abort),
	     -EPROTONOSUPPORT);
	SAYS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, back, 0, &size, &abort), -ENOBUFS);
	SAYS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, NULL, 0, &size, &abort), -ENOBUFS);
	IS(size, 99);
	/* more room than any object needs; it is not touched */
	IS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, back, SIZE_MAX, &size, &abort), 0);
	IS(size, 4);
	/* in segments */
	for (unsigned int i = 0; i < sizeof(big); i++)
		big[i] = (uint8_t)(i * 7 + 1);
	IS(CALL(ecrt_master_sdo_download)(m, MOTOR, 0x2000, 0, big, sizeof(big), &abort), 0);
	IS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x2000, 0, back, sizeof(back), &size, &abort), 0);
	IS(size, sizeof(big));
	YES(!memcmp(big, back, sizeof(big)));
}

static void complete(void)
{
	/* subindices 0 (16 bit), 1 and 2 of the servo's PDO mapping cannot be written */
	const uint8_t map[6] = { 1, 0, 0x10, 0, 0x40, 0x60 };
	uint32_t abort = 0;
	uint8_t assign[6];

	EC_WRITE_U16(assign, 2);
	EC_WRITE_U16(assign + 2, 0x1600);
	EC_WRITE_U16(assign + 4, 0x1601);
	IS(CALL(ecrt_master_sdo_download_complete)(m, SERVO, 0x1c12, assign, 6, &abort), 0);
	SAYS(CALL(ecrt_master_sdo_download_complete)(m, SERVO, 0x1600, map, 6, &abort), -EIO);
	YES(abort != 0);
	IS(CALL(ecrt_master_sdo_download_complete)(m, SERVO, 0x1c12, assign, 0, &abort), -EINVAL);
	SAYS(CALL(ecrt_master_sdo_download_complete)(m, NOWHERE, 0x1c12, assign, 6, &abort), -EINVAL);
	SAYS(CALL(ecrt_master_sdo_download_complete)(m, OUT, 0x1c12, assign, 6, &abort),
	     -EPROTONOSUPPORT);
}

static void begin(void)
{
	m = CALL(ecrt_open_master)(0);
	YES(m != NULL);
}

static void end(void) { CALL(ecrt_release_master)(m); }

const struct api_case info_cases[] = {
	{ "open", begin },
	{ "master, links", master_info },
	{ "slaves", slaves },
	{ "SyncManagers, PDOs, entries", process_data },
	{ "gaps have index 0", gap },
	{ "SDO downloads", downloads },
	{ "SDO uploads", uploads },
	{ "SDO complete access", complete },
	{ "release", end },
	{ NULL, NULL },
};
