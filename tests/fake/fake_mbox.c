// SPDX-License-Identifier: GPL-2.0-only
/* Fake master: the mailboxes of its slaves. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fake.h"

static int abort_sdo(struct ec_ioc_sdo *x, __u32 code)
{
	x->abort_code = code;
	return fake_fail(EIO, "SDO aborted");
}

/*
 * Diagnosis history of FAKE_DIAG: good (a ring of 4 that has wrapped), empty, newest (a wrong
 * one), short (messages of any length), refuse (a message is gone)
 */
static const struct {
	__u8 sub, size;
	const char *data;
} diag[] = {
	{ 1, 1, "\4" }, { 2, 1, "\7" }, { 3, 1, "\x6" }, { 5, 2, "\x20\0" },
	/* the oldest: DC time, text 0x10 with UINT16, INT8, text, text 0x11 and UINT8[2] */
	{ 8, 40, "\0\xe8\x34\x12\2\5\x10\0\0\x80\xb5\x62\x15\x78\x83\x0b"
		 "\6\0\x42\1" "\2\0\xff" "\7\x20" "a\033[2Jbc" "\0\x40\x11\0"
		 "\2\x10\xab\xcd" },
	{ 9, 16, "\x01\xe0\0\0\0\0\0\0\0\xca\x9a\x3b\0\0\0\0" },
	/* unknown severity; a parameter of unknown size */
	{ 6, 20, "\x02\xe0\0\0\x07\2\x12\0\1\0\0\0\0\0\0\0\5\0\7\xff" },
	{ 7, 18, "\x03\xe0\0\0\1\xff\x13\0\1\0\0\0\0\0\0\0\x09\0" },
};

static int diag_upload(struct ec_ioc_sdo *x)
{
	const char *kind = getenv("FAKE_DIAG");
	__u32 most;
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (!kind || x->slave.position != 2 || fake_index)
		return abort_sdo(x, 0x06020000);
	for (size_t i = 0; i < LEN(diag); i++) {
		if (diag[i].sub != x->subindex)
			continue;
		memcpy(to, diag[i].data, diag[i].size);
		x->size = diag[i].size;
		if (!strcmp(kind, "empty") && x->subindex == 2)
			to[0] = 0;
		if (!strcmp(kind, "newest") && x->subindex == 2)
			to[0] = 0x0a;
		most = strncmp(kind, "short", 5) || x->subindex <= 5 ? 64 : (__u32)atoi(kind + 5);
		if (x->size > most)
			x->size = most;
		if (!strcmp(kind, "refuse") && x->subindex > 5)
			return abort_sdo(x, 0x08000020);
		return 0;
	}
	return abort_sdo(x, 0x06090011);
}

/* 0xF050 by FAKE_MODULES, idents of the slots apart by commas; "slow" does not answer */
static int modules_upload(struct ec_ioc_sdo *x)
{
	const char *list = getenv("FAKE_MODULES");
	__u32 v = 1;

	if (!list)
		return abort_sdo(x, 0x06020000);
	if (!strcmp(list, "slow"))
		return fake_fail(ETIMEDOUT, "slave 2 has not answered for 1000 ms");
	for (const char *c = list; *c; c++)
		v += *c == ',';
	for (__u8 i = 1; x->subindex && i < x->subindex && list; i++)
		list = strchr(list, ',') ? strchr(list, ',') + 1 : NULL;
	if (!list)
		return abort_sdo(x, 0x06090011);
	if (x->subindex)
		v = (__u32)strtoul(list, NULL, 0);
	x->size = x->subindex ? 4 : 1;
	memcpy((void *)(uintptr_t)x->data, &v, x->size);
	return 0;
}

static int upload(struct ec_ioc_sdo *x)
{
	static const struct {
		__u16 index;
		__u8 sub, size;
		const char *data;
	} dict[] = {
		{ 0x1008, 0, 8, "EL7201\0\0" },
		{ 0x1018, 1, 4, "\x02\0\0\0" },
		{ 0x1018, 2, 3, "\1\2\3" },
		{ 0x6041, 0, 2, "\x60\x80" },
		{ 0x6060, 0, 1, "\xff" },
		{ 0x2000, 0, 4, "\0\0\xc0\x3f" },
		{ 0x1c12, 0, 1, "\2" },
		{ 0x1c12, 1, 2, "\0\x16" },
		{ 0x1c12, 2, 2, "\2\x16" },
		{ 0x1600, 0, 1, "\1" },
		{ 0x1600, 1, 4, "\x10\1\x10\x70" },
		{ 0x1602, 0, 1, "\2" },
		{ 0x1602, 1, 4, "\x08\6\x10\x70" },
		{ 0x1602, 2, 4, "\x08\0\0\0" },
		{ 0x1c13, 0, 1, "\2" },
		{ 0x1c13, 2, 2, "\5\x1a" },
		{ 0x1a05, 0, 1, "\0" },
		{ 0x1c13, 1, 2, "\0\x1a" },
		{ 0x1a00, 0, 1, "\1" },
		{ 0x1a00, 1, 4, "\x20\x11\0\x60" },
		{ 0x2003, 0, 3, "a\nb" },
		{ 0x2003, 1, 2, "\xe4\xf6" },
		{ 0x2003, 2, 4, "text" },
		{ 0x2004, 0, 18, "E\0\xc4\0\xac\x20\x3d\xd8\0\xde\0\xd8\x1b\0L\0\0\0" },
		{ 0x2002, 0, 12, "a\033[2J\302\233b\n\0\0\0" },
	};
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (x->index == 0x10f3)
		return diag_upload(x);
	if (x->index == 0xf050)
		return modules_upload(x);
	if (getenv("FAKE_COUNT_OF") && x->index == strtoul(getenv("FAKE_COUNT_OF"), NULL, 0)) {
		memset(to, 0xff, 4);	/* more than a list can have */
		x->size = 4;
		return 0;
	}
	if (getenv("FAKE_FIRST_TX") && x->index == 0x1c13 && x->subindex == 1) {
		__u16 pdo = (__u16)strtoul(getenv("FAKE_FIRST_TX"), NULL, 0);

		memcpy(to, &pdo, sizeof(pdo));
		x->size = sizeof(pdo);
		return 0;
	}
	if (getenv("FAKE_SLOW"))
		usleep(300000);
	if (x->index == 0x3000) {
		if (x->size < 65536)
			return fake_fail(EOVERFLOW, "the object has 65536 bytes");
		memset(to, 'x', 65536);
		x->size = 65536;
		return 0;
	}
	if (x->index == 0x4000)
		return fake_fail(ETIMEDOUT, "slave 2 has not answered for 1000 ms");
	if (x->index == 0x4001)
		return fake_fail(EPROTONOSUPPORT, "SDO 0x4001:00 of slave 2: no CoE mailbox");
	if (x->flags & EC_SDO_FLAG_COMPLETE) {
		memcpy(to, "\4\0\2\0", 4);
		x->size = 4;
		return 0;
	}
	for (size_t i = 0; i < LEN(dict); i++)
		if (dict[i].index == x->index && dict[i].sub == x->subindex) {
			memcpy(to, dict[i].data, dict[i].size);
			x->size = dict[i].size;
			return 0;
		}
	return abort_sdo(x, x->index == 0x5001 ? 0x12345678 : 0x06020000);
}

/* answers of SDO information: description, or 0 for what is refused */
static const struct {
	__u16 index;
	__u8 sub, kind;		/* 0: entry, 1: object, 2: entry with value info */
	__u8 size;
	const char *data;
} infos[] = {
	/* index, type, highest subindex, object code, name */
	{ 0x1018, 0, 1, 14, "\x18\x10\x23\0\3\x09Identity" },
	{ 0x1018, 0, 0, 13, "\x18\x10\0\0\5\0\x08\0\7\0Num" },
	/* index, subindex, value info, type, bits, access, name */
	{ 0x1018, 1, 0, 16, "\x18\x10\1\0\7\0\x20\0\7\0Vendor" },
	{ 0x1018, 2, 0, 10, "\x18\x10\2\0\7\0\x20\0\0\0" },
	{ 0x6060, 0, 1, 16, "\x60\x60\2\0\0\7a\033[2J\302\233b\n" },
	/* with value info: unit of 4 bytes, default, minimum, maximum; a byte too many */
	{ 0x6060, 0, 2, 21, "\x60\x60\0\x78\2\0\x08\0\xff\0\3\xb5\0\0\x08\xff\x0aMode" },
	{ 0x1018, 1, 2, 19, "\x18\x10\1\x10\7\0\x20\0\7\0\2\0\0Vendor" },
	{ 0x7010, 6, 0, 20, "\x10\x70\6\0\2\0\x08\0\xff\0Drive mode" },
	{ 0x1602, 0, 1, 14, "\2\x16\x21\0\2\x09" "DRV Mode" },
	{ 0x6060, 0, 0, 14, "\x60\x60\0\0\2\0\x08\0\xff\0Mode" },
	{ 0x2002, 0, 1, 12, "\2\x20\x09\0\0\7Serial" },
	{ 0x2002, 0, 0, 16, "\2\x20\0\0\x09\0\x60\0\x3f\0Serial" },
	{ 0x1008, 0, 1, 10, "\x08\x10\x0a\0\0\7Name" },
	{ 0x1008, 0, 0, 14, "\x08\x10\0\0\x0a\0\x40\0\x3f\0Name" },
	/* an entry of a type that has no name, and a description cut off */
	{ 0x5001, 0, 1, 12, "\1\x50\xff\x7f\0\7Vendor" },
	{ 0x5001, 0, 0, 13, "\1\x50\0\0\xff\x7f\3\0\x3f\0Odd" },
	{ 0x5002, 0, 1, 3, "\2\x50\xff" },
};

static int sdo_info(struct ec_ioc_sdo_info *x)
{
	static const char list[] = "\x18\x10\x60\x60\2\x20\x08\x10\1\x50\2\x50\3\x50";
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (fake_bus("gone") && x->index == 0x6060)
		return fake_fail(ENODEV, "no slave at ring position 2");
	if (x->what == EC_SDO_INFO_LIST) {
		x->size = sizeof(list) - 1;
		memcpy(to, list, x->size);
		return 0;
	}
	for (size_t i = 0; i < LEN(infos); i++) {
		if (infos[i].index != x->index || infos[i].sub != x->subindex ||
		    infos[i].kind != (x->value_info ? 2 : x->what == EC_SDO_INFO_OBJECT))
			continue;
		memcpy(to, infos[i].data, infos[i].size);
		x->size = infos[i].size;
		return 0;
	}
	x->abort_code = 0x06090011;
	return fake_fail(EIO, "SDO information aborted");
}

static int emergencies(struct ec_ioc_emergencies *x)
{
	const struct ec_emergency e = {
		.time_ns = 1764000000012345678, .code = 0x8130, .error_register = 0x11,
		.data = { 1, 2, 3, 4, 0xff },
	};
	struct ec_emergency *to = (struct ec_emergency *)(uintptr_t)x->data;
	__u32 n;

	if (x->slave.position != 2) {
		x->size = 0;
		return 0;
	}
	x->total = fake_bus("two") ? 70000 : 2;
	n = fake_bus("two") ? EC_EMERGENCIES : 2;
	if (x->size < n * sizeof(e))
		return fake_fail(EFAULT, "the buffer is small");
	x->size = (__u32)(n * sizeof(e));
	for (__u32 i = 0; i < n; i++)
		to[i] = e;
	to[1].code = 0;
	return 0;
}

static int download(struct ec_ioc_sdo *x)
{
	char what[64];

	if (x->index == 0x1018)
		return abort_sdo(x, 0x06010002);
	snprintf(what, sizeof(what), "sdo %u 0x%04x:%02x%s ", x->slave.position, x->index,
		 x->subindex, x->flags ? " C" : "");
	fake_hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int soe_error(struct ec_ioc_soe *x, __u16 code)
{
	x->error_code = code;
	return fake_fail(EIO, "the slave refuses");
}

/*
 * S-0-0148 is executed after three polls, S-0-0149 fails, S-0-0150 never ends; the name of S-0-0030
 * is hostile, P-0-0150 has neither name nor attribute
 */
static int soe_element(struct ec_ioc_soe *x)
{
	static const struct {
		__u16 idn;
		__u8 element;
		__u8 size;
		const char *data;
	} elements[] = {
		{ 15, 2, 18, "\x0e\0\x0e\0Telegram type!" }, { 15, 4, 4, "\0\0\1\x60" },
		{ 15, 8, 4, "\0\0\0\0" }, { 15, 0x10, 2, "\0\0" }, { 15, 0x20, 2, "\7\0" },
		{ 15, 0x80, 2, "\7\0" },
		{ 30, 2, 12, "\x08\0\x08\0a\033[2Jb\n\x9b" }, { 30, 4, 4, "\1\0\x44\x72" },
		{ 30, 8, 6, "\xff\0\2\0us" },
		{ 148, 2, 10, "\6\0\6\0Homing" }, { 148, 4, 4, "\0\0\x09\0" },
		{ 148, 8, 5, "\1\0\1\0s" },
		{ 149, 4, 4, "\0\0\x09\0" }, { 150, 4, 4, "\0\0\x09\0" },
		{ 149, 1, 2, "\xf\0" }, { 150, 1, 2, "\7\0" }, { 151, 1, 3, "\7\0\0" },
	};
	static unsigned int polls;
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (x->idn == 148 && x->flags == 1) {
		memcpy(to, polls++ < 3 ? "\7\0" : "\3\0", 2);
		x->size = 2;
		return 0;
	}
	for (size_t i = 0; i < LEN(elements); i++) {
		if (elements[i].idn != x->idn || elements[i].element != x->flags)
			continue;
		memcpy(to, elements[i].data, elements[i].size);
		x->size = elements[i].size;
		return 0;
	}
	if (x->idn == 99)
		return fake_fail(ETIMEDOUT, "slave 2 did not answer in time");
	return soe_error(x, x->flags == 1 ? 0x7014 : 0x2001);
}

static int soe_read(struct ec_ioc_soe *x)
{
	static const struct {
		__u16 idn;
		__u8 size;
		const char *data;
	} idns[] = {
		{ 11, 2, "\0\0" },	/* no error, see fake_why.c */
		{ 15, 2, "\7\0" },
		{ 16, 6, "\xff\0\x20\0\x33\0" },	/* the length is wrong */
		{ 17, 12, "\x08\0\x08\0\x0f\0\x1e\0\x94\0\x96\x80" },
		{ 25, 4, "\0\0\x20\0" },
		{ 30, 11, "\7\0\x10\0SIM 1.0" },
		{ 95, 12, "\x08\0\x20\0no error" },
		{ 390, 4, "\0\0\0\0" },
		{ 0x8096, 2, "\x34\x12" },
	};

	if (x->drive > 1)
		return soe_error(x, 0x800a);
	if (x->flags)
		return soe_element(x);
	if (x->idn == 99)
		return fake_fail(ETIMEDOUT, "slave 2 did not answer in time");
	for (size_t i = 0; i < LEN(idns); i++)
		if (idns[i].idn == x->idn) {
			memcpy((void *)(uintptr_t)x->data, idns[i].data, idns[i].size);
			x->size = idns[i].size;
			return 0;
		}
	return soe_error(x, x->idn == 100 ? 0x7fff : 0x1001);
}

static int soe_write(struct ec_ioc_soe *x)
{
	char what[64];

	if (x->idn == 30)
		return soe_error(x, 0x7004);
	snprintf(what, sizeof(what), "soe %u %u 0x%04x ", x->slave.position, x->drive, x->idn);
	if (x->flags)
		sprintf(what + strlen(what), "element 0x%02x ", x->flags);
	fake_hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int foe_error(struct ec_ioc_foe *x, __u32 code)
{
	static const char *const own[] = { "own", "no room", "same", "disk full" };

	x->error_code = code;
	for (size_t i = 0; i < LEN(own); i += 2)
		if (!strcmp(x->name, own[i])) {
			char text[128];

			snprintf(text, sizeof(text),
				 "file '%s' of slave 2: error 0x%08x: x; text of the slave: %s",
				 own[i], code, own[i + 1]);
			return fake_fail(EIO, text);
		}
	return fake_fail(EIO, "file: error");
}

/* file "slow" takes 1.5 s, with progress after 0.5 s */
static int foe_read(struct ec_ioc_foe *x)
{
	static const char content[] = "\1\2binary\n";
	volatile __u64 *done = (volatile __u64 *)(uintptr_t)x->done;

	if (!strcmp(x->name, "none"))
		return foe_error(x, 0x8001);
	if (!strcmp(x->name, "boot"))
		return foe_error(x, 0x8009);
	if (!strcmp(x->name, "strange"))
		return foe_error(x, 0x9999);
	if (!strcmp(x->name, "mute"))
		return fake_fail(ETIMEDOUT, "slave 2 did not answer in time");
	if (!strcmp(x->name, "slow")) {
		usleep(500000);
		*done = 5;
		usleep(1000000);
	}
	x->size = x->password == 7 ? 0 : sizeof(content) - 1;
	memcpy((void *)(uintptr_t)x->data, content, x->size);
	*done = x->size;
	return 0;
}

static int foe_write(struct ec_ioc_foe *x)
{
	char what[128];

	if (!strcmp(x->name, "full") || !strcmp(x->name, "own") || !strcmp(x->name, "same"))
		return foe_error(x, 0x8003);
	snprintf(what, sizeof(what), "foe %u %.64s 0x%08x ", x->slave.position, x->name,
		 x->password);
	fake_hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

const struct ec_ip_params fake_net = {
	.which = EC_IP_MAC | EC_IP_ADDRESS | EC_IP_MASK | EC_IP_HOSTNAME,
	.mac = { 2, 0, 0, 0xec, 1, 7 }, .ip = { 192, 168, 0, 17 },
	.mask = { 255, 255, 255, 0 }, .name = "mixer",
};

/* slave 2 has EoE, slave 1 has none, slave 0 refuses */
static int ip(struct ec_ioc_ip *x, bool write)
{
	const struct ec_ip_params *p = &x->params;

	if (x->slave.position == 1)
		return fake_fail(EPROTONOSUPPORT, "slave 1 has no EoE mailbox");
	if (!x->slave.position) {
		x->result = 0x0201;
		return fake_fail(EIO, "slave 0: IP parameters refused: EoE result 0x0201 (the slave does not support IP)");
	}
	if (!write) {
		x->params = fake_net;
		if (fake_bus("evil"))
			memcpy(x->params.name, "\033[2J\302\233bbbbbbbbbbbbbbbbbbbbbbbbbb", 32);
		return 0;
	}
	fake_record("ip %u 0x%02x %.32s\n", x->slave.position, p->which, p->name);
	fake_hex("", p->mac, sizeof(p->mac));
	fake_hex("", p->ip, sizeof(p->ip));
	fake_hex("", p->mask, sizeof(p->mask));
	fake_hex("", p->gateway, sizeof(p->gateway));
	fake_hex("", p->dns, sizeof(p->dns));
	return 0;
}

/* to the file FAKE_CALLS: requests to a slave and their time limits */
static void note_call(unsigned long request, const void *arg)
{
	const char *path = getenv("FAKE_CALLS");
	FILE *f = path ? fopen(path, "a") : NULL;

	if (f && request == EC_IOC_SDO_INFO)
		fprintf(f, "info %u\n", ((const struct ec_ioc_sdo_info *)arg)->timeout_ms);
	else if (f && (request == EC_IOC_SDO_UPLOAD || request == EC_IOC_SDO_DOWNLOAD))
		fprintf(f, "%s %u\n", request == EC_IOC_SDO_UPLOAD ? "upload" : "download",
			((const struct ec_ioc_sdo *)arg)->timeout_ms);
	else if (f && (request == EC_IOC_SOE_READ || request == EC_IOC_SOE_WRITE))
		fprintf(f, "soe %u\n", ((const struct ec_ioc_soe *)arg)->timeout_ms);
	if (f)
		fclose(f);
}

/* network devices of slaves with EoE, with FAKE_EOE */
static int eoe(struct ec_ioc_eoe *x)
{
	static const struct ec_ioc_eoe all[] = {
		{ .index = 0, .device = 2, .name = "eoe0a1001", .position = 1,
		  .address = { 2, 0xec, 1, 2, 3, 4 },
		  .state = EC_EOE_CONNECTED | EC_EOE_UP | EC_EOE_RUNNING, .waiting = 3, .room = 64,
		  .rx_rate = 1200, .tx_rate = 70, .rx_frames = 20, .rx_bytes = 30000,
		  .rx_errors = 1, .tx_frames = 22, .tx_bytes = 2000, .tx_lost = 1 },
		{ .index = 1, .device = 3, .name = "eoe0n1f3c", .position = 2, .room = 64,
		  .state = EC_EOE_CONNECTED | EC_EOE_UP },
		{ .index = 2, .device = 9, .name = "eoe0s7", .position = 7, .room = 64,
		  .state = EC_EOE_UP },
		/* of another network namespace */
		{ .index = 3, .device = 10, .position = 8, .room = 64,
		  .state = EC_EOE_CONNECTED },
	};

	if (!getenv("FAKE_EOE") || x->index >= LEN(all))
		return fake_fail(ENOENT, "there is no such network device");
	*x = all[x->index];
	return 0;
}

int fake_mbox(unsigned long request, void *arg)
{
	note_call(request, arg);
	switch (request) {
	case EC_IOC_EOE:
		return eoe(arg);
	case EC_IOC_EOE_WISH:
		fake_record("eoe wish %u\n", ((struct ec_ioc_eoe_wish *)arg)->wish);
		return 0;
	case EC_IOC_IP_GET:
	case EC_IOC_IP_SET:
		return ip(arg, request == EC_IOC_IP_SET);
	case EC_IOC_SDO_UPLOAD:
		return upload(arg);
	case EC_IOC_SDO_DOWNLOAD:
		return download(arg);
	case EC_IOC_EMERGENCIES:
		return emergencies(arg);
	case EC_IOC_SDO_INFO:
		return sdo_info(arg);
	case EC_IOC_SOE_READ:
		return soe_read(arg);
	case EC_IOC_SOE_WRITE:
		return soe_write(arg);
	case EC_IOC_FOE_READ:
		return foe_read(arg);
	case EC_IOC_FOE_WRITE:
		return foe_write(arg);
	default:
		return FAKE_OTHER;
	}
}
