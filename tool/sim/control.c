// SPDX-License-Identifier: GPL-2.0-only
/*
 * Faults while a segment runs. A datagram is one fault, the answer is empty or
 * reports what is wrong. Only root may write to the socket's file, and send faults.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "control.h"
#include "load.h"

#define TEXT_MAX	512
#define BURST		16

static int address(struct sockaddr_un *a, const char *path)
{
	memset(a, 0, sizeof(*a));
	a->sun_family = AF_UNIX;
	if (strlen(path) < sizeof(a->sun_path)) {
		strcpy(a->sun_path, path);
		return 0;
	}
	fprintf(stderr, "ethercat-sim: %s: path of the socket too long, limit %zu characters\n",
		path, sizeof(a->sun_path) - 1);
	return -1;
}

/* Remove a socket that has no listener any more. */
static void remove_stale(const struct sockaddr_un *a)
{
	struct stat st;
	int fd;

	if (lstat(a->sun_path, &st) || !S_ISSOCK(st.st_mode))
		return;
	fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	if (fd >= 0 && connect(fd, (const struct sockaddr *)a, sizeof(*a)) &&
	    errno == ECONNREFUSED)
		unlink(a->sun_path);
	if (fd >= 0)
		close(fd);
}

/**
 * control_open() - create the socket; reports errors on stderr
 * @path: of its file, which only its owner may use
 *
 * Return: descriptor or -1.
 */
int control_open(const char *path)
{
	struct sockaddr_un a;
	mode_t mask;
	int fd, ret;

	if (address(&a, path))
		return -1;
	remove_stale(&a);
	fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
	mask = umask(0177);
	ret = fd < 0 ? -1 : bind(fd, (struct sockaddr *)&a, sizeof(a));
	umask(mask);
	if (!ret)
		return fd;
	fprintf(stderr, "ethercat-sim: cannot create socket %s: %s\n", path, strerror(errno));
	if (fd >= 0)
		close(fd);
	return -1;
}

/**
 * control_receive() - apply the faults that were received
 * @fd: of control_open()
 * @sim: segment
 */
void control_receive(int fd, struct ec_sim *sim)
{
	char text[TEXT_MAX];

	for (int i = 0; i < BURST; i++) {
		struct sockaddr_un from;
		socklen_t from_len = sizeof(from);
		struct ec_sim_error err = { 0 };
		struct ec_sim_fault f;
		ssize_t n = recvfrom(fd, text, sizeof(text), MSG_TRUNC,
				     (struct sockaddr *)&from, &from_len);

		if (n < 0)
			return;
		if (n > (ssize_t)sizeof(text))
			snprintf(err.text, sizeof(err.text), "longer than %d characters", TEXT_MAX);
		else if (!ec_sim_command(sim, &load_ops, text, (size_t)n, &f, &err) &&
			 ec_sim_add_fault(sim, &f))
			snprintf(err.text, sizeof(err.text),
				 "the segment takes no more faults, or not this one");
		sendto(fd, err.text, strlen(err.text), MSG_DONTWAIT,
		       (struct sockaddr *)&from, from_len);
	}
}

/**
 * control_close() - remove the socket
 * @fd: of control_open(), or -1
 * @path: its path
 */
void control_close(int fd, const char *path)
{
	if (fd < 0)
		return;
	close(fd);
	unlink(path);
}

/**
 * control_tell() - send a fault to a running ethercat-sim; reports errors on stderr
 * @path: its socket
 * @text: fault
 *
 * Return: exit status.
 */
int control_tell(const char *path, const char *text)
{
	struct sockaddr_un a, own = { .sun_family = AF_UNIX };
	struct timeval limit = { .tv_sec = 5 };
	char answer[256];
	int fd, ret = 1;
	ssize_t n;

	if (address(&a, path))
		return 1;
	fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	/* a name of its own, for the answer */
	if (fd < 0 || bind(fd, (struct sockaddr *)&own, sizeof(own.sun_family)) ||
	    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit)) ||
	    connect(fd, (struct sockaddr *)&a, sizeof(a)) ||
	    send(fd, text, strlen(text), 0) < 0) {
		fprintf(stderr, "ethercat-sim: cannot reach %s: %s\n", path, strerror(errno));
	} else {
		n = recv(fd, answer, sizeof(answer), 0);
		if (n < 0)
			fprintf(stderr, "ethercat-sim: no reply from %s: %s\n", path,
				strerror(errno));
		else if (n)
			fprintf(stderr, "ethercat-sim: %.*s\n", (int)n, answer);
		ret = n != 0;
	}
	if (fd >= 0)
		close(fd);
	return ret;
}
