// SPDX-License-Identifier: LGPL-2.1-or-later
/* Opening, reserving and releasing a master. */

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "ecrt/ecrt_int.h"

/* The module knows which programs it can serve; one before version 3 does not know this request. */
static int check_version(struct ec_master *m, const char *path)
{
	struct ec_ioc_version version = { .abi = EC_UAPI_VERSION };
	int ret = ec_command(m, EC_IOC_VERSION, &version);

	if (ret == -EPROTO)
		return ec_complain(m, NULL, ret, true, "use %s", path);
	if (!ret && version.abi >= EC_UAPI_FIRST)
		return 0;
	return ec_fail(NULL, -EPROTO,
		       "use %s: not a device file of this master, or the module is older than interface version %u: update the module",
		       path, EC_UAPI_FIRST);
}

ec_master_t *ecrt_open_master(unsigned int master_index)
{
	struct ec_master *m;
	char path[40];
	int err;

	m = calloc(1, sizeof(*m));
	if (!m) {
		ec_fail(NULL, -ENOMEM, "open master %u", master_index);
		return NULL;
	}
	m->index = master_index;
	snprintf(path, sizeof(path), "/dev/EtherCAT%u", master_index);
	m->fd = open(path, O_RDWR | O_CLOEXEC);
	if (m->fd < 0) {
		err = ec_cannot_open(path);
		goto err_free;
	}
	err = check_version(m, path);
	if (err)
		goto err_close;
	return m;

err_close:
	close(m->fd);
err_free:
	free(m);
	errno = -err;
	return NULL;
}

int ecrt_master_reserve(ec_master_t *master)
{
	struct ec_ioc_send send = { 0 };
	int ret;

	if (!master)
		return -EINVAL;
	ret = ec_do(master, EC_IOC_RESERVE, NULL, "reserve master %u", master->index);
	if (ret)
		return ret;
	master->reserved = true;
	/*
	 * The module admits both to the shorter entry once ioctl() has let them through. They do
	 * nothing before activation; one that is refused here is refused with its cause there.
	 */
	ec_command(master, EC_IOC_RECEIVE, NULL);
	ec_command(master, EC_IOC_SEND, &send);
	return 0;
}

ec_master_t *ecrt_request_master(unsigned int master_index)
{
	struct ec_master *m = ecrt_open_master(master_index);
	int err;

	if (!m)
		return NULL;
	err = ecrt_master_reserve(m);
	if (!err)
		return m;
	ecrt_release_master(m);
	errno = -err;
	return NULL;
}

/* The kernel ends the session when the file is closed. */
void ecrt_release_master(ec_master_t *master)
{
	if (!master)
		return;
	ec_master_unmap(master);
	close(master->fd);
	ec_master_free_session(master);
	free(master);
}
