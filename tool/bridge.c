// SPDX-License-Identifier: GPL-2.0-only
/* A bridge of Linux, by the calls of bridge(8) that need no library. */
#include <errno.h>
#include <net/if.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/sockios.h>

#include "bridge.h"
#include "tool.h"

static int set_up(int fd, const char *name)
{
	struct ifreq r = { 0 };

	strncpy(r.ifr_name, name, IFNAMSIZ - 1);
	if (ioctl(fd, SIOCGIFFLAGS, &r))
		return -errno;
	r.ifr_flags |= IFF_UP;
	return ioctl(fd, SIOCSIFFLAGS, &r) ? -errno : 0;
}

static int open_socket(void)
{
	int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);

	if (fd < 0)
		fail("no socket for network devices: %s", strerror(errno));
	return fd;
}

static int ended(int fd, const char *what, const char *name, int err)
{
	close(fd);
	if (err == -EPERM)
		return fail("cannot %s %s: only root may do it (CAP_NET_ADMIN)", what, name);
	if (err == -ENOPKG)
		return fail("cannot %s %s: this kernel has no bridges (module bridge)", what, name);
	return err ? fail("cannot %s %s: %s", what, name, strerror(-err)) : 0;
}

int bridge_make(const char *name)
{
	int fd, err = 0;

	if (!*name || strlen(name) >= IFNAMSIZ || strchr(name, '/') || strchr(name, ' '))
		return fail("'%s' is no name of a network device: 1 to %d characters, no slash, no space",
			    name, IFNAMSIZ - 1);
	fd = open_socket();
	if (fd < 0)
		return 1;
	if (ioctl(fd, SIOCBRADDBR, name) && errno != EEXIST)
		err = -errno;
	return ended(fd, "make bridge", name, err ? err : set_up(fd, name));
}

int bridge_add(const char *name, const char *port)
{
	struct ifreq r = { 0 };
	int fd = open_socket(), err = 0;

	if (fd < 0)
		return 1;
	strncpy(r.ifr_name, name, IFNAMSIZ - 1);
	r.ifr_ifindex = (int)if_nametoindex(port);
	/* it is a port already */
	if (!r.ifr_ifindex)
		err = -ENODEV;
	else if (ioctl(fd, SIOCBRADDIF, &r) && errno != EBUSY)
		err = -errno;
	return ended(fd, "join to the bridge", port, err ? err : set_up(fd, port));
}
