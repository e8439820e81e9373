// SPDX-License-Identifier: GPL-2.0-only
/* Packet socket which gets the EtherCAT frames of one interface. */
#include <arpa/inet.h>
#include <errno.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if_arp.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "port.h"

#define ETHERTYPE	0x88a4

/* SOL_PACKET is not in every C library */
#ifndef SOL_PACKET
#define SOL_PACKET	263
#endif

static int request(const struct port *p, unsigned long what, struct ifreq *r)
{
	memset(r, 0, sizeof(*r));
	snprintf(r->ifr_name, sizeof(r->ifr_name), "%s", p->name);
	return ioctl(p->fd, what, r);
}

/* Is it there, Ethernet, up? */
static int check_kind(struct port *p)
{
	struct ifreq r;

	if (request(p, SIOCGIFINDEX, &r)) {
		fprintf(stderr, "ethercat-sim: there is no interface '%s' ('ip link' lists them)\n",
			p->name);
		return -1;
	}
	p->index = r.ifr_ifindex;
	if (request(p, SIOCGIFHWADDR, &r) || r.ifr_hwaddr.sa_family != ARPHRD_ETHER) {
		fprintf(stderr, "ethercat-sim: %s is no Ethernet interface\n", p->name);
		return -1;
	}
	if (request(p, SIOCGIFFLAGS, &r) || !(r.ifr_flags & IFF_UP)) {
		fprintf(stderr, "ethercat-sim: %s is down; do 'ip link set %s up' first\n",
			p->name, p->name);
		return -1;
	}
	return 0;
}

/*
 * Two programs at one interface would both answer each frame. Names of this kind
 * belong to a network namespace, as interfaces do, and end with the program.
 */
static int claim(struct port *p)
{
	struct sockaddr_un a = { .sun_family = AF_UNIX };
	int n = snprintf(a.sun_path + 1, sizeof(a.sun_path) - 1, "ethercat-sim/%d", p->index);

	p->claim = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	if (p->claim >= 0 &&
	    !bind(p->claim, (struct sockaddr *)&a,
		  (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)n)))
		return 0;
	if (errno == EADDRINUSE)
		fprintf(stderr, "ethercat-sim: another ethercat-sim is at %s; stop it first\n",
			p->name);
	else
		fprintf(stderr, "ethercat-sim: cannot claim %s: %s\n", p->name, strerror(errno));
	return -1;
}

/* Only what comes from the wire, whoever it is addressed to. */
static int attach(struct port *p)
{
	struct sockaddr_ll at = {
		.sll_family = AF_PACKET, .sll_protocol = htons(ETHERTYPE), .sll_ifindex = p->index,
	};
	struct packet_mreq promisc = { .mr_ifindex = p->index, .mr_type = PACKET_MR_PROMISC };
	int on = 1, space = 4 << 20;

	if (setsockopt(p->fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof(on)) ||
	    setsockopt(p->fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &promisc, sizeof(promisc)) ||
	    bind(p->fd, (struct sockaddr *)&at, sizeof(at))) {
		fprintf(stderr, "ethercat-sim: %s: %s\n", p->name, strerror(errno));
		return -1;
	}
	/* a larger buffer is nice to have */
	setsockopt(p->fd, SOL_SOCKET, SO_RCVBUF, &space, sizeof(space));
	return 0;
}

/**
 * port_open() - begin to listen; says what is wrong on stderr
 * @p: port
 * @name: of the interface
 *
 * Return: 0 or -1.
 */
int port_open(struct port *p, const char *name)
{
	p->fd = -1;
	p->claim = -1;
	if (strlen(name) >= sizeof(p->name)) {
		fprintf(stderr, "ethercat-sim: there is no interface '%s': a name has at most %zu characters\n",
			name, sizeof(p->name) - 1);
		return -1;
	}
	strcpy(p->name, name);
	p->fd = socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
	if (p->fd < 0) {
		fprintf(stderr, "ethercat-sim: no packet socket: %s%s\n", strerror(errno),
			errno == EPERM ? "; run as root or with CAP_NET_RAW" : "");
		return -1;
	}
	return check_kind(p) || claim(p) || attach(p) ? -1 : 0;
}

/**
 * port_close() - stop listening
 * @p: port
 */
void port_close(struct port *p)
{
	if (p->fd >= 0)
		close(p->fd);
	if (p->claim >= 0)
		close(p->claim);
	p->fd = -1;
	p->claim = -1;
}

/**
 * port_check() - look after the interface; tells on stderr what has changed
 * @p: port
 *
 * A socket whose interface was down receives again once it is up.
 */
void port_check(struct port *p)
{
	struct ifreq r = { .ifr_ifindex = p->index };
	bool down;

	if (ioctl(p->fd, SIOCGIFNAME, &r)) {
		fprintf(stderr, "ethercat-sim: interface %s is gone\n", p->name);
		p->gone = true;
		return;
	}
	if (strcmp(p->name, r.ifr_name)) {
		fprintf(stderr, "ethercat-sim: interface %s is called %s now\n", p->name, r.ifr_name);
		strcpy(p->name, r.ifr_name);
	}
	down = ioctl(p->fd, SIOCGIFFLAGS, &r) || !(r.ifr_flags & IFF_UP);
	if (down != p->down)
		fprintf(stderr, "ethercat-sim: interface %s is %s\n", p->name,
			down ? "down, waiting" : "up again");
	p->down = down;
}

/**
 * port_receive() - next frame
 * @p: port
 * @buf: gets it, Ethernet header first
 * @cap: bytes at @buf
 *
 * Return: bytes of the frame, more than @cap: too long; 0: none there.
 */
int port_receive(struct port *p, void *buf, size_t cap)
{
	ssize_t n = recv(p->fd, buf, cap, MSG_TRUNC);

	if (n < 0 && errno != EAGAIN && errno != EINTR)
		port_check(p);
	return n < 0 ? 0 : (int)n;
}

/**
 * port_send() - send a frame
 * @p: port
 * @buf: the frame, Ethernet header first
 * @len: its bytes
 *
 * Return: 0, or -1: it could not be sent.
 */
int port_send(struct port *p, const void *buf, size_t len)
{
	return send(p->fd, buf, len, 0) == (ssize_t)len ? 0 : -1;
}
