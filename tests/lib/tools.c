// SPDX-License-Identifier: LGPL-2.1-or-later
/* libethercat-tools against the fake kernel: what the output of the tool does not show. */
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../include/ethercat-tools.h"

static int failures;

#define CHECK(condition) do {							\
	if (!(condition)) {							\
		fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);	\
		failures++;							\
	}									\
} while (0)

static struct ect_handle *opened(unsigned int flags)
{
	struct ect_handle *h = ect_new();

	CHECK(h && !ect_open(h, 0, flags));
	return h;
}

static void bus(const char *name)
{
	setenv("FAKE_BUS", name, 1);
}

static void handles(void)
{
	struct ect_master m = { .struct_size = sizeof(m) };
	struct ect_handle *h = ect_new();

	ect_free(NULL);
	CHECK(ect_fd(h) == -1 && !ect_version(h) && !*ect_path(h) && !*ect_reason(h));
	CHECK(ect_master_read(h, &m) == -EBADF && strstr(ect_reason(h), "ect_open()"));
	CHECK(ect_open(h, 7, 0) == -ENOENT && strstr(ect_reason(h), "start the masters"));
	CHECK(ect_open(h, 0, 2) == -EINVAL && strstr(ect_reason(h), "unknown flags 0x2"));
	CHECK(!ect_open(h, 0, 0) && ect_open(h, 0, 0) == -EBUSY);
	CHECK(ect_version(h)->interface == ect_interface() && ect_version(h)->masters == 1);
	CHECK(!strcmp(ect_path(h), "/dev/EtherCAT0"));
	/* a handle for reading changes nothing, and the master says why */
	CHECK(ect_rescan(h) == -EPERM && strstr(ect_reason(h), "open for reading only"));
	ect_close(h);
	ect_close(h);
	CHECK(ect_fd(h) == -1 && !ect_open(h, 0, ECT_OPEN_WRITE) && !ect_rescan(h));
	ect_free(h);
	bus("foreign");
	h = ect_new();
	CHECK(ect_open(h, 0, 0) == -EPROTO && strstr(ect_reason(h), "not a device of this"));
	ect_free(h);
}

/* programs of an older and of a newer header */
static void sizes(void)
{
	struct ect_handle *h = opened(0);
	struct {
		struct ect_master m;
		unsigned char more[64];
	} newer;
	struct {
		uint32_t struct_size;
		uint32_t index;
		unsigned char guard[8];
	} older = { .struct_size = 8, .index = 99, .guard = "guarded" };
	struct ect_master unset = { .struct_size = 0 };

	memset(&newer, 0xff, sizeof(newer));
	newer.m.struct_size = sizeof(newer);
	CHECK(!ect_master_read(h, &newer.m) && newer.m.slave_count == 3);
	CHECK(newer.m.struct_size == sizeof(newer));
	for (size_t i = 0; i < sizeof(newer.more); i++)
		CHECK(!newer.more[i]);
	CHECK(!ect_master_read(h, (struct ect_master *)(void *)&older) && !older.index);
	CHECK(!strcmp((char *)older.guard, "guarded") && older.struct_size == 8);
	CHECK(ect_master_read(h, &unset) == -EINVAL && strstr(ect_reason(h), "struct_size is 0"));
	ect_free(h);
}

static void lists(void)
{
	struct ect_handle *h = opened(0);
	const struct ect_slave *s;
	struct ect_list *list;

	CHECK(!ect_list_count(NULL) && !ect_list_get(NULL, 0));
	ect_list_free(NULL);
	CHECK(!ect_slaves_read(h, &list) && ect_list_count(list) == 3);
	s = ect_list_get(list, 2);
	CHECK(s->struct_size >= sizeof(*s) && s->position == 2 && !strcmp(s->order, "EL7201"));
	CHECK(!ect_list_get(list, 3));
	ect_free(h);
	/* it does not need the handle */
	CHECK(!strcmp(((const struct ect_slave *)ect_list_get(list, 0))->order, "EK1100"));
	ect_list_free(list);
}

/* What was resolved once is that device, or nothing. */
static void devices(void)
{
	struct ect_handle *h = opened(ECT_OPEN_WRITE);
	struct ect_slave s = { .struct_size = sizeof(s) }, again = s;
	uint16_t wkc = 0;
	uint8_t data[4];

	CHECK(!ect_slave_at(h, 2, &s) && s.device && s.device != s.position);
	CHECK(!ect_slave_read(h, s.device, &again) && again.position == 2);
	CHECK(ect_slave_at(h, 3, &again) == -EINVAL && strstr(ect_reason(h), "no such slave"));
	CHECK(ect_slave_at(h, 65536, &again) == -EINVAL && strstr(ect_reason(h), "65535"));
	CHECK(!ect_reg_read(h, s.device, 0x130, data, 2) && data[0] == 0x12);
	CHECK(ect_reg_read(h, s.device, 0xfffe, data, 4) == -EINVAL);
	CHECK(!ect_datagram(h, 7, 0x130u << 16, data, 2, &wkc) && wkc == 3 && data[1] == 0x41);
	CHECK(ect_datagram(h, 7, 0, data, 0, &wkc) == -EINVAL && wkc == 3);
	CHECK(ect_datagram(h, 7, 0, data, (size_t)1 << 32, &wkc) == -EINVAL);
	bus("moved");
	CHECK(ect_reg_read(h, s.device, 0x130, data, 2) == -ENODEV);
	CHECK(strstr(ect_reason(h), "EL7201"));
	CHECK(ect_sdo_upload(h, s.device, 0x1018, 1, 0, 0, data, 4) == -ENODEV);
	CHECK(!ect_error_code(h));
	ect_free(h);
}

static void codes(void)
{
	struct ect_handle *h = opened(ECT_OPEN_WRITE);
	struct ect_slave s = { .struct_size = sizeof(s) };
	uint8_t data[64];

	CHECK(!ect_slave_at(h, 2, &s));
	CHECK(ect_sdo_upload(h, s.device, 0x1018, 1, 0, 0, data, sizeof(data)) == 4);
	CHECK(ect_sdo_upload(h, s.device, 0x5000, 0, 0, 0, data, sizeof(data)) == -EIO);
	CHECK(ect_error_code(h) == 0x06020000);
	/* that of an earlier failure is not left */
	CHECK(ect_slave_at(h, 9, &s) == -EINVAL && !ect_error_code(h));
	CHECK(ect_foe_read(h, s.device, "", 0, data, sizeof(data), NULL) == -EINVAL);
	ect_free(h);
}

static const struct ect_finding *only(const struct ect_why *w, const char *cause)
{
	const struct ect_finding *f, *found = NULL;

	for (size_t i = 0; (f = ect_list_get(ect_why_findings(w), i)); i++)
		if (!strcmp(f->cause, cause))
			found = f;
	return found;
}

static void why(void)
{
	struct ect_handle *h = opened(0);
	const struct ect_explained *e;
	const struct ect_finding *f;
	const struct ect_slave *s;
	struct ect_why *w;
	char name[32];

	bus("app");
	setenv("FAKE_WHY", "cable", 1);
	CHECK(!ect_why(h, &w));
	f = only(w, "cable");
	CHECK(f && f->level == ECT_FAULT && f->slave == 1 && f->port == 1 && *f->remedy);
	s = f ? ect_list_get(ect_why_slaves(w), (size_t)f->slave) : NULL;
	CHECK(s && f->device == s->device);
	/* the configuration that it explains */
	e = ect_list_get(ect_why_configs(w), 1);
	CHECK(e && e->finding && ect_list_get(ect_why_findings(w), e->finding - 1) == f);
	CHECK(ect_why_checked(w)->configs == 2 && !ect_why_checked(w)->unreachable);
	ect_why_free(w);

	setenv("FAKE_WHY", "too_high", 1);
	CHECK(!ect_why(h, &w));
	f = only(w, "working_counter");
	CHECK(f && f->evidence_count == 2 && f->evidence[0] > f->evidence[1]);
	CHECK(f && !ect_evidence(f, 0, name, sizeof(name)) && !strcmp(name, "working_counter"));
	CHECK(f && !ect_evidence(f, 1, name, sizeof(name)) && !strcmp(name, "expected"));
	CHECK(f && ect_evidence(f, 2, name, sizeof(name)) == -ENOENT);
	ect_why_free(w);
	ect_why_free(NULL);

	setenv("FAKE_WHY", "link_down", 1);
	CHECK(!ect_why(h, &w) && ect_why_checked(w)->unreachable && only(w, "link_down"));
	ect_why_free(w);
	unsetenv("FAKE_WHY");
	ect_free(h);
}

/* each with a handle of its own */
static void *reader(void *arg)
{
	struct ect_handle *h = opened(0);
	size_t *slaves = arg;

	for (int i = 0; i < 20; i++) {
		struct ect_list *list = NULL, *nodes = NULL;

		if (ect_slaves_read(h, &list) || ect_topology(list, &nodes, NULL))
			break;
		*slaves += ect_list_count(nodes);
		ect_list_free(nodes);
		ect_list_free(list);
	}
	ect_free(h);
	return NULL;
}

static void threads(void)
{
	pthread_t thread[4];
	size_t slaves[4] = { 0 };

	for (int i = 0; i < 4; i++)
		CHECK(!pthread_create(&thread[i], NULL, reader, &slaves[i]));
	for (int i = 0; i < 4; i++) {
		pthread_join(thread[i], NULL);
		CHECK(slaves[i] == 60);
	}
}

int main(void)
{
	static void (*const cases[])(void) = {
		handles, sizes, lists, devices, codes, why, threads,
	};

	for (size_t i = 0; i < sizeof(cases) / sizeof(*cases); i++) {
		bus("idle");
		cases[i]();
	}
	if (failures)
		fprintf(stderr, "%d failures\n", failures);
	return failures != 0;
}
