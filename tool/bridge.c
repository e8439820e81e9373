// SPDX-License-Identifier: GPL-2.0-only
/* A bridge of Linux, made by ip(8). */
#include <errno.h>
#include <net/if.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>

#include "bridge.h"
#include "tool.h"

extern char **environ;

/* ip(8) itself prints why it fails. */
static int ip(const char *const argv[])
{
	int status, err;
	pid_t pid;

	err = posix_spawnp(&pid, "ip", NULL, NULL, (char *const *)argv, environ);
	if (err)
		return fail("cannot run ip (package iproute2): %s", strerror(err));
	while (waitpid(pid, &status, 0) < 0)
		if (errno != EINTR)
			return fail("cannot wait for ip: %s", strerror(errno));
	if (!WIFEXITED(status) || WEXITSTATUS(status))
		return fail("'ip link' has failed, see above; network devices are changed by root only (CAP_NET_ADMIN)");
	return 0;
}

int bridge_make(const char *name)
{
	const char *const add[] = { "ip", "link", "add", "name", name, "type", "bridge", NULL };
	const char *const up[] = { "ip", "link", "set", "dev", name, "up", NULL };

	if (!*name || *name == '-' || strlen(name) >= IFNAMSIZ || strpbrk(name, "/ "))
		return fail("'%s' is no name of a network device: 1 to %d characters, no slash, no space",
			    name, IFNAMSIZ - 1);
	if (!if_nametoindex(name) && ip(add))
		return 1;
	return ip(up);
}

int bridge_add(const char *name, const char *port)
{
	const char *const set[] = { "ip", "link", "set", "dev", port, "master", name, "up", NULL };

	return ip(set);
}
