// SPDX-License-Identifier: LGPL-2.1-or-later
/* Opening a master, its commands, and why the last one failed. */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "internal.h"
#include "sys.h"
#include "text.h"

struct ect_handle *ect_new(void)
{
	struct ect_handle *h = calloc(1, sizeof(*h));

	if (h)
		h->fd = -1;
	return h;
}

void ect_free(struct ect_handle *h)
{
	if (!h)
		return;
	ect_close(h);
	free(h);
}

void ect_close(struct ect_handle *h)
{
	if (h->fd >= 0)
		ect_sys_close(h->fd);
	h->fd = -1;
}

int ect_fd(const struct ect_handle *h)
{
	return h->fd;
}

const char *ect_path(const struct ect_handle *h)
{
	return h->path;
}

const struct ect_version *ect_version(const struct ect_handle *h)
{
	return h->fd >= 0 ? &h->version : NULL;
}

unsigned int ect_interface(void)
{
	return EC_UAPI_VERSION;
}

int ect_fail(struct ect_handle *h, int err, const char *fmt, ...)
{
	va_list ap;

	h->err = -err;
	h->code = 0;
	h->unasked = false;
	va_start(ap, fmt);
	vsnprintf(h->reason, sizeof(h->reason), fmt, ap);
	va_end(ap);
	return err;
}

int ect_no_memory(struct ect_handle *h)
{
	return ect_fail(h, -ENOMEM, "%s", "");
}

int ect_coded(struct ect_handle *h, int err, u32 code)
{
	h->code = err ? code : 0;
	return err;
}

int ect_command(struct ect_handle *h, unsigned long command, void *arg)
{
	int ret;

	if (h->fd < 0)
		return ect_fail(h, -EBADF, "the handle has no master: ect_open()");
	do
		ret = ect_sys_ioctl(h->fd, command, arg);
	while (ret < 0 && errno == EINTR);
	return ret < 0 ? ect_failed(h) : 0;
}

int ect_failed(struct ect_handle *h)
{
	h->err = errno;
	h->code = 0;
	h->unasked = true;	/* most callers do not ask */
	return -h->err;
}

const char *ect_reason(struct ect_handle *h)
{
	struct ec_ioc_reason reason = { 0 };

	if (!h->unasked)
		return h->reason;
	h->unasked = false;
	if (ect_sys_ioctl(h->fd, EC_IOC_REASON, &reason))
		reason.text[0] = '\0';
	string_clean(reason.text, sizeof(reason.text));
	snprintf(h->reason, sizeof(h->reason), "%s", reason.text);
	if (h->err == ENOTTY && !h->reason[0] && h->version.interface != EC_UAPI_VERSION)
		snprintf(h->reason, sizeof(h->reason),
			 "the module has interface version %u, this tool %u", h->version.interface,
			 EC_UAPI_VERSION);
	return h->reason;
}

uint32_t ect_error_code(const struct ect_handle *h)
{
	return h->code;
}

int ect_give(struct ect_handle *h, void *to, void *from, size_t size)
{
	u32 room;

	memcpy(&room, to, sizeof(room));
	if (room <= sizeof(room))
		return ect_fail(h, -EINVAL, "struct_size is %u: set it to the sizeof() of the structure",
				room);
	memcpy(from, &room, sizeof(room));
	memset(to, 0, room);
	memcpy(to, from, min((size_t)room, size));
	return 0;
}

static int read_version(struct ect_handle *h)
{
	struct ec_ioc_version v = { .abi = EC_UAPI_VERSION };
	int ret = ect_command(h, EC_IOC_VERSION, &v);

	if (ret == -ENOTTY || ret == -EINVAL || (!ret && v.abi < EC_UAPI_FIRST))
		return ect_fail(h, -EPROTO,
				"not a device of this EtherCAT master (interface version %u)",
				EC_UAPI_VERSION);
	if (ret)
		return ret;
	string_clean(v.release, sizeof(v.release));
	h->version = (struct ect_version){
		.struct_size = sizeof(h->version), .interface = v.abi, .features = v.features,
		.masters = v.master_count, .ecrt = v.ecrt,
	};
	memcpy(h->version.release, v.release, sizeof(v.release));
	return 0;
}

static const char *open_hint(int err)
{
	if ((err == ENOENT || err == ENXIO) && !access("/sys/module/ec_master", F_OK))
		return "ec_master is loaded without this master: 'ethercatctl restart', or 'rmmod ec_master' and load it with main_devices=...";
	if (err == ENOENT || err == ENXIO || err == ENODEV)
		return "start the masters: 'ethercatctl start', or 'modprobe ec_master main_devices=...' with the address of the card";
	if (err == EACCES || err == EPERM)
		return "members of the group that owns the file may use it (see ls -l)";
	return "";
}

int ect_open_path(struct ect_handle *h, const char *path, unsigned int flags)
{
	int ret;

	if (h->fd >= 0)
		return ect_fail(h, -EBUSY, "the handle has %s open already", h->path);
	if (flags & ~ECT_OPEN_WRITE)
		return ect_fail(h, -EINVAL, "unknown flags 0x%x", flags & ~ECT_OPEN_WRITE);
	snprintf(h->path, sizeof(h->path), "%s", path);
	h->fd = ect_sys_open(h->path, flags & ECT_OPEN_WRITE ? O_RDWR : O_RDONLY);
	if (h->fd < 0) {
		ret = -errno;
		return ect_fail(h, ret, "%s", open_hint(-ret));
	}
	ret = read_version(h);
	if (!ret)
		return 0;
	ect_reason(h);	/* as long as there is a file */
	ect_close(h);
	return ret;
}

int ect_open(struct ect_handle *h, unsigned int master, unsigned int flags)
{
	char path[40];

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", master);
	return ect_open_path(h, path, flags);
}
