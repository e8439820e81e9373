// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * The application's side of the fake kernel: system calls of libethercat (ld --wrap), what it
 * asked, and what an activated master maps. What a master knows of its bus is that of
 * fake_dev.c; the tests of libethercat give some of it other values.
 */

#include "../../lib/tools/sys.h"
#include "app_side.h"
#include "fake.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

#define PAGE	4096U
#define STATUS_SIZE ((sizeof(struct ec_status) + PAGE - 1) / PAGE * PAGE)

struct fake fake;

static int bus_fd;	/* in fake_dev.c */

int __wrap_open(const char *path, int flags, ...);
int __wrap_close(int fd);
static void preset(const struct ec_ioc_activate *a)
{
	size_t n = a->preset_size;

	fake.preset_size = a->preset_size;
	memset(fake.preset, 0, sizeof(fake.preset));
	if (n > sizeof(fake.preset))
		n = sizeof(fake.preset);
	if (n)
		memcpy(fake.preset, (void *)(uintptr_t)a->preset, n);
}

int __wrap_ioctl(int fd, unsigned long cmd, ...);
int __wrap_posix_fadvise(int fd, off_t offset, off_t len, int advice);
void *__wrap_mmap(void *at, size_t size, int prot, int flags, int fd,
		  off_t offset);
int __real_open(const char *path, int flags, ...);
int __real_close(int fd);
void *__real_mmap(void *at, size_t size, int prot, int flags, int fd,
		  off_t offset);

int __wrap_open(const char *path, int flags, ...)
{
	if (strcmp(path, "/dev/EtherCAT0")) {
		errno = ENOENT;
		return -1;
	}
	/* a reader of events needs no more than that */
	if (flags != (O_RDWR | O_CLOEXEC) && flags != (O_RDONLY | O_CLOEXEC))
		abort();
	fake.writable = flags & O_RDWR;
	fake.opens++;
	setenv("FAKE_BUS", "idle", 0);
	bus_fd = ect_sys_open(path, O_RDWR);
	return FAKE_FD;
}

int __wrap_close(int fd)
{
	if (fd != FAKE_FD)
		return __real_close(fd);
	fake.closes++;
	return 0;
}

/* 8 requests, 8 configurations, data at 2048 */
static void lay_out(unsigned char *p)
{
	struct ec_request_area *area = (void *)p;
	struct ec_emerg_ring *ring;
	unsigned int i;

	area->magic = EC_REQUEST_MAGIC;
	area->request_count = 8;
	area->requests = sizeof(*area);
	area->ring_count = 8;
	area->rings = area->requests + 8 * sizeof(struct ec_request_record);
	for (i = 0; i < 8; i++) {
		fake_request(p, i)->data = 2048 + 64 * i;
		ring = (struct ec_emerg_ring *)(p + area->rings) + i;
		ring->count = 2;
		ring->data = 3072 + 16 * i;
	}
	if (fake.large)
		fake_request(p, 0)->data = PAGE + EC_FOE_NAME;
	/* the application before has started the first one */
	fake_request(p, 0)->start = fake.running;
	fake.area = p;
}

void *__wrap_mmap(void *at, size_t size, int prot, int flags, int fd,
		  off_t offset)
{
	void *p;

	if (fd != FAKE_FD)
		return __real_mmap(at, size, prot, flags, fd, offset);
	p = __real_mmap(at, size, PROT_READ | PROT_WRITE, MAP_SHARED |
			MAP_ANONYMOUS | (flags & MAP_FIXED), -1, 0);
	if ((unsigned long long)offset == EC_MMAP_STATUS) {
		fake.status = p;
		fake.status->magic = EC_STATUS_MAGIC;
		fake.status->kernel.cycle = fake.cycle;
		fake.status->kernel.takeovers = fake.running != 0;
	} else if ((unsigned long long)offset == EC_MMAP_REQUESTS) {
		lay_out(p);
	} else if ((unsigned long long)offset == EC_MMAP_EXCHANGE) {
		fake.exchange = p;
		fake.exchange->outputs = 2;
		fake.exchange->inputs = 2;
		fake.exchange->stride = fake.stride;
		fake.exchange->app_input = 1;
		if (fake.running) {
			fake.exchange->app_output = 2;
			fake.exchange->outputs = 0;
			memset((unsigned char *)p + EC_EXCHANGE_FIRST +
			       2 * fake.stride + sizeof(struct ec_exchange_buffer),
			       fake.running, 32);
		}
	} else {
		fake.image = p;
		if (size >= sizeof(fake.preset))	/* what activation gave */
			memcpy(p, fake.preset, sizeof(fake.preset));
	}
	return p;
}

static void answer_sdo(struct ec_ioc_sdo *sdo)
{
	if (sdo->index == 0x1018) {
		memcpy((void *)(uintptr_t)sdo->data, "\2\0\0\0", 4);
		sdo->size = 4;
	}
}

static void answer_info(struct ec_ioc_sdo_info *i)
{
	static const char *const answers[] = {
		[EC_SDO_INFO_LIST] = "\0\x10\x18\x10",
		[EC_SDO_INFO_OBJECT] = "\x18\x10\x23\0\4\x09" "Identity",
		/* a unit precedes the name */
		[EC_SDO_INFO_ENTRY] = "\x18\x10\1\x08\7\0\x20\0\7\0\x11\x22" "Vendor",
	};
	static const unsigned int sizes[] = {
		[EC_SDO_INFO_LIST] = 4, [EC_SDO_INFO_OBJECT] = 14, [EC_SDO_INFO_ENTRY] = 18,
	};

	memcpy((void *)(uintptr_t)i->data, answers[i->what], sizes[i->what]);
	i->size = fake.answer ? fake.answer : sizes[i->what];
}

static int reg_entry(struct ec_ioc_reg_entry *r)
{
	r->offset = r->entry_index == 0x7000 ? 3 : 8;
	r->bit = r->entry_index == 0x6010 ? 5 : 0;
	if (!r->bit || !(r->flags & EC_REG_ENTRY_ALIGNED))
		return 0;
	errno = EFAULT;
	return -1;
}

static void slave(struct ec_ioc_slave *s)
{
	s->al_status = 0x14;
	s->alias = 9;
	s->current_ma = -2000;
	s->error = EC_SLAVE_CONFIG_FAILED;
	s->dc_supported = (__u8)fake.dc_bits;
	s->dc_delay_only = 0;
	s->transmission_delay = 145;
	s->dc_offset = 5;
	s->dc_diff = fake.dc_diff;
	s->dc_set = 1;
	s->dc_odd = (__u16)fake.dc_odd;
}

static void port(struct ec_ioc_port *p)
{
	/* the library asks for that of the device which EC_IOC_SLAVE has found */
	if (p->slave.kind != EC_ADDRESS_DEVICE)
		abort();
	p->type = p->port == 1 ? 3 : 0;
	p->next_slave = p->port == 1 ? 7 : 0;
}

static void master(struct ec_ioc_master *m)
{
	m->scan_index = 2;
	m->scan_slaves = 5;
	m->al_states = 2;
	m->app_time = 12345;
}

static void pdo_op(struct ec_ioc_sc_pdo *p)
{
	if (fake.n_pdo_ops < 64)
		fake.pdo_ops[fake.n_pdo_ops++] = (unsigned int)p->op << 24 |
			(unsigned int)p->sm << 16 |
			(p->op == EC_SC_PDO_MAP_ADD ? p->entry_index : p->pdo);
}

/* what the master knows, with the values that the tests expect */
static int ask_bus(unsigned long cmd, void *arg)
{
	int ret = ect_sys_ioctl(bus_fd, cmd, arg);

	if (ret)
		return ret;
	switch (cmd) {
	case EC_IOC_MASTER:
		master(arg);
		break;
	case EC_IOC_SLAVE:
		slave(arg);
		break;
	case EC_IOC_DEVICE:
		((struct ec_ioc_device *)arg)->al_states = 2;
		break;
	case EC_IOC_SLAVE_NAMES:
		memset(((struct ec_ioc_slave_names *)arg)->name, 'n', EC_UAPI_STRING);
		break;
	case EC_IOC_PORT:
		port(arg);
		break;
	}
	return 0;
}

int __wrap_ioctl(int fd, unsigned long cmd, ...)
{
	va_list ap;
	void *arg;

	va_start(ap, cmd);
	arg = va_arg(ap, void *);
	va_end(ap);
	if (fd != FAKE_FD)
		abort();
	if (cmd == EC_IOC_REASON) {
		struct ec_ioc_reason *r = arg;

		snprintf(r->text, sizeof(r->text), "%s",
			 fake.reason ? fake.reason : "");
		return 0;
	}
	fake.calls++;
	fake.last = (unsigned int)cmd;
	fake.received |= cmd == EC_IOC_RECEIVE;
	fake.admitted |= cmd == EC_IOC_SEND;
	if (_IOC_SIZE(cmd))
		memcpy(fake.arg, arg, _IOC_SIZE(cmd));
	if (fake.refuse == cmd) {
		if (cmd == EC_IOC_SDO_UPLOAD || cmd == EC_IOC_SDO_DOWNLOAD)
			((struct ec_ioc_sdo *)arg)->abort_code = 0x06020000;
		if (cmd == EC_IOC_SOE_READ || cmd == EC_IOC_SOE_WRITE)
			((struct ec_ioc_soe *)arg)->error_code = 0x1001;
		if (cmd == EC_IOC_SDO_INFO)
			((struct ec_ioc_sdo_info *)arg)->abort_code = 0x06020000;
		if (cmd == EC_IOC_FOE_READ || cmd == EC_IOC_FOE_WRITE)
			((struct ec_ioc_foe *)arg)->error_code = 0x8001;
		errno = fake.err;
		return -1;
	}
	switch (cmd) {
	case EC_IOC_VERSION:
	case EC_IOC_MASTER:
	case EC_IOC_SLAVE:
	case EC_IOC_DEVICE:
	case EC_IOC_SLAVE_NAMES:
	case EC_IOC_PORT:
	case EC_IOC_PDO:
	case EC_IOC_PDO_ENTRY:
		return ask_bus(cmd, arg);
	case EC_IOC_SM:		/* each slave has them all */
		((struct ec_ioc_sm *)arg)->control = 0x64;
		((struct ec_ioc_sm *)arg)->pdo_count = 2;
		break;
	case EC_IOC_CREATE_DOMAIN:
		((struct ec_ioc_create_domain *)arg)->index = fake.domains++;
		break;
	case EC_IOC_SLAVE_CONFIG:	/* position is the index */
		((struct ec_ioc_slave_config *)arg)->index =
			((struct ec_ioc_slave_config *)arg)->position;
		break;
	case EC_IOC_CONFIG:
		((struct ec_ioc_config *)arg)->slave_position = 1;
		((struct ec_ioc_config *)arg)->device = FAKE_DEVICE + 1;
		((struct ec_ioc_config *)arg)->al_status = 2;
		((struct ec_ioc_config *)arg)->state = EC_STATUS_SC_ONLINE | 2;
		break;
	case EC_IOC_DOMAIN:
		((struct ec_ioc_domain *)arg)->size = 11;
		((struct ec_ioc_domain *)arg)->fmmu_count = fake.exchange ? 2 : 0;
		break;
	case EC_IOC_DOMAIN_FMMU:	/* 8 bytes out, 8 in */
		((struct ec_ioc_domain_fmmu *)arg)->offset =
			8 * ((struct ec_ioc_domain_fmmu *)arg)->fmmu;
		((struct ec_ioc_domain_fmmu *)arg)->size = 8;
		((struct ec_ioc_domain_fmmu *)arg)->dir =
			(__u8)(1 + ((struct ec_ioc_domain_fmmu *)arg)->fmmu);
		break;
	case EC_IOC_SC_COMMAND:
		memcpy(fake.values, (void *)(uintptr_t)((struct ec_ioc_sc_command *)arg)->data,
		       ((struct ec_ioc_sc_command *)arg)->size);
		break;
	case EC_IOC_SC_PDO:
		pdo_op(arg);
		break;
	case EC_IOC_SC_REQUEST:
		((struct ec_ioc_sc_request *)arg)->index = fake.requests++;
		break;
	case EC_IOC_DATAGRAM_REQUEST:
		((struct ec_ioc_datagram_request *)arg)->index = fake.requests++;
		break;
	case EC_IOC_REG_ENTRY:
		return reg_entry(arg);
	case EC_IOC_SDO_UPLOAD:
		answer_sdo(arg);
		break;
	case EC_IOC_SII: {
		struct ec_ioc_sii *i = arg;

		/* 32 bytes, in pieces of 10 */
		i->size = i->size < 10 ? i->size : 10;
		if (i->offset + i->size > 32)
			i->size = i->offset < 32 ? 32 - i->offset : 0;
		for (__u32 k = 0; k < i->size; k++)
			((__u8 *)(uintptr_t)i->data)[k] = (__u8)(i->offset + k);
		break;
	}
	case EC_IOC_SII_WRITE:
		memcpy(fake.values, (void *)(uintptr_t)((struct ec_ioc_sii_write *)arg)->data,
		       ((struct ec_ioc_sii_write *)arg)->size);
		((struct ec_ioc_sii_write *)arg)->differ = 3;
		((struct ec_ioc_sii_write *)arg)->written = 2;
		((struct ec_ioc_sii_write *)arg)->register_alias = 7;
		((struct ec_ioc_sii_write *)arg)->renewed = 1;
		break;
	case EC_IOC_ALIAS:
		((struct ec_ioc_alias *)arg)->register_alias = 5;
		break;
	case EC_IOC_SDO_INFO:
		if (((struct ec_ioc_sdo_info *)arg)->what != EC_SDO_INFO_FORGET)
			answer_info(arg);
		break;
	case EC_IOC_CONFIG_WHY:
		strcpy(((struct ec_ioc_config_why *)arg)->text,
		       "OP refused\nand more");
		break;
	case EC_IOC_SOE_READ:
		memcpy((void *)(uintptr_t)((struct ec_ioc_soe *)arg)->data, "\x34\x12", 2);
		((struct ec_ioc_soe *)arg)->size = 2;
		break;
	case EC_IOC_FOE_READ:
		memcpy((void *)(uintptr_t)((struct ec_ioc_foe *)arg)->data, "file", 4);
		((struct ec_ioc_foe *)arg)->size = 4;
		break;
	case EC_IOC_ACTIVATE:
		preset(arg);
		((struct ec_ioc_activate *)arg)->image_size = fake.image_size;
		((struct ec_ioc_activate *)arg)->status_size = STATUS_SIZE;
		((struct ec_ioc_activate *)arg)->request_size = PAGE + fake.large;
		((struct ec_ioc_activate *)arg)->exchange_size = fake.exchange_size;
		((struct ec_ioc_activate *)arg)->taken_over = fake.running != 0;
		break;
	case EC_IOC_DOMAIN_OFFSET:
		((struct ec_ioc_domain_offset *)arg)->offset =
			((struct ec_ioc_domain_offset *)arg)->domain * 16;
		((struct ec_ioc_domain_offset *)arg)->size =
			fake.image_size ? 16 : 0;
		if (!fake.image_size)
			((struct ec_ioc_domain_offset *)arg)->offset = 0;
		break;
	case EC_IOC_WAIT:
		((struct ec_ioc_wait *)arg)->cycle = fake.cycle;
		break;
	case EC_IOC_SEND:
		fake.sent = ((struct ec_ioc_send *)arg)->queued;
		fake.send_flags = ((struct ec_ioc_send *)arg)->flags;
		if (fake.beside)
			fake.beside();
		fake.beside = NULL;
		break;
	}
	return 0;
}

int __wrap_posix_fadvise(int fd, off_t offset, off_t len, int advice)
{
	struct ec_ioc_send send = {
		.flags = advice & EC_SEND_FLAG_ALL, .queued = (__u64)len,
		.app_time = (__u64)offset, .sync_time = (__u64)offset,
	};

	fake.advised++;
	if (!fake.received || !fake.admitted)
		return EINVAL;	/* not let through by ioctl() before */
	if (fake.no_advice)
		return fake.no_advice;
	if (advice == EC_ADVICE_RECEIVE)
		return __wrap_ioctl(fd, EC_IOC_RECEIVE) ? errno : 0;
	if ((advice & ~EC_SEND_FLAG_ALL) != EC_ADVICE_SEND)
		abort();
	return __wrap_ioctl(fd, EC_IOC_SEND, &send) ? errno : 0;
}
