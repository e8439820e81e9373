// SPDX-License-Identifier: GPL-2.0-only
/* Packet socket which gets frames of one interface: EtherCAT direct, tagged or in UDP; or all. */
#include <arpa/inet.h>
#include <errno.h>
#include <linux/filter.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if_arp.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

#include "port.h"

#define ETHERTYPE	0x88a4
#define VLAN_TAG	4
#define MACS		12	/* bytes before the tag */

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

/* Does the interface exist, is it Ethernet, is it up? */
static int check_kind(struct port *p)
{
	struct ifreq r;

	if (request(p, SIOCGIFINDEX, &r)) {
		fprintf(stderr, "ethercat-sim: no interface '%s'; 'ip link' lists the interfaces\n",
			p->name);
		return -1;
	}
	p->index = r.ifr_ifindex;
	if (request(p, SIOCGIFHWADDR, &r) || r.ifr_hwaddr.sa_family != ARPHRD_ETHER) {
		fprintf(stderr, "ethercat-sim: %s is not an Ethernet interface\n", p->name);
		return -1;
	}
	if (request(p, SIOCGIFFLAGS, &r) || !(r.ifr_flags & IFF_UP)) {
		fprintf(stderr, "ethercat-sim: %s is down; run 'ip link set %s up' first\n",
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
		fprintf(stderr, "ethercat-sim: another ethercat-sim uses %s; stop it first\n",
			p->name);
	else
		fprintf(stderr, "ethercat-sim: cannot claim %s: %s\n", p->name, strerror(errno));
	return -1;
}

/*
 * Direct frames, and IPv4 with a header of five words and this UDP port. The kernel has
 * taken the tag out of the frame by then.
 */
static struct sock_filter ethercat[] = {
	BPF_STMT(BPF_LD | BPF_H | BPF_ABS, MACS),
	BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ETHERTYPE, 7, 0),
	BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ETH_P_IP, 0, 7),
	BPF_STMT(BPF_LD | BPF_B | BPF_ABS, ETH_HLEN),
	BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x45, 0, 5),
	BPF_STMT(BPF_LD | BPF_B | BPF_ABS, ETH_HLEN + 9),
	BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, IPPROTO_UDP, 0, 3),
	BPF_STMT(BPF_LD | BPF_H | BPF_ABS, ETH_HLEN + 22),
	BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ETHERTYPE, 0, 1),
	BPF_STMT(BPF_RET | BPF_K, 0x40000),
	BPF_STMT(BPF_RET | BPF_K, 0),
};

/* Receive frames from the wire only, with any destination address. */
static int attach(struct port *p, bool all)
{
	struct sockaddr_ll at = {
		.sll_family = AF_PACKET, .sll_protocol = htons(ETH_P_ALL), .sll_ifindex = p->index,
	};
	struct sock_fprog filter = {
		.len = sizeof(ethercat) / sizeof(ethercat[0]), .filter = ethercat,
	};
	struct packet_mreq promisc = { .mr_ifindex = p->index, .mr_type = PACKET_MR_PROMISC };
	int on = 1, space = 4 << 20;

	if ((!all && setsockopt(p->fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter))) ||
	    (all && setsockopt(p->fd, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof(on))) ||
	    setsockopt(p->fd, SOL_PACKET, PACKET_AUXDATA, &on, sizeof(on)) ||
	    setsockopt(p->fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof(on)) ||
	    setsockopt(p->fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &promisc, sizeof(promisc)) ||
	    bind(p->fd, (struct sockaddr *)&at, sizeof(at))) {
		fprintf(stderr, "ethercat-sim: %s: %s\n", p->name, strerror(errno));
		return -1;
	}
	p->all = all;
	/* a larger buffer is nice to have */
	setsockopt(p->fd, SOL_SOCKET, SO_RCVBUF, &space, sizeof(space));
	return 0;
}

/**
 * port_open() - begin to listen; reports errors on stderr
 * @p: port
 * @name: of the interface
 * @all: receive all frames, not only those of EtherCAT
 *
 * Return: 0 or -1.
 */
int port_open(struct port *p, const char *name, bool all)
{
	p->fd = -1;
	p->claim = -1;
	if (strlen(name) >= sizeof(p->name)) {
		fprintf(stderr, "ethercat-sim: invalid interface name '%s': limit %zu characters\n",
			name, sizeof(p->name) - 1);
		return -1;
	}
	strcpy(p->name, name);
	p->fd = socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
	if (p->fd < 0) {
		fprintf(stderr, "ethercat-sim: cannot create a packet socket: %s%s\n",
			strerror(errno), errno == EPERM ? "; run as root or with CAP_NET_RAW" : "");
		return -1;
	}
	return check_kind(p) || claim(p) || attach(p, all) ? -1 : 0;
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
 * port_check() - check the interface; reports changes on stderr
 * @p: port
 *
 * A socket whose interface was down receives again once it is up.
 */
void port_check(struct port *p)
{
	struct ifreq r = { .ifr_ifindex = p->index };
	bool down;

	if (ioctl(p->fd, SIOCGIFNAME, &r)) {
		fprintf(stderr, "ethercat-sim: interface %s has disappeared\n", p->name);
		p->gone = true;
		return;
	}
	if (strcmp(p->name, r.ifr_name)) {
		fprintf(stderr, "ethercat-sim: interface %s was renamed to %s\n", p->name,
			r.ifr_name);
		strcpy(p->name, r.ifr_name);
	}
	down = ioctl(p->fd, SIOCGIFFLAGS, &r) || !(r.ifr_flags & IFF_UP);
	if (down != p->down)
		fprintf(stderr, "ethercat-sim: interface %s is %s\n", p->name,
			down ? "down, waiting" : "up again");
	p->down = down;
}

/* the tag that the kernel took out of a frame; false: it had none */
static bool tag_of(struct msghdr *msg, uint8_t tag[VLAN_TAG])
{
	struct tpacket_auxdata aux;
	struct cmsghdr *c;

	for (c = CMSG_FIRSTHDR(msg); c; c = CMSG_NXTHDR(msg, c)) {
		if (c->cmsg_level != SOL_PACKET || c->cmsg_type != PACKET_AUXDATA)
			continue;
		memcpy(&aux, CMSG_DATA(c), sizeof(aux));
		if (!(aux.tp_status & TP_STATUS_VLAN_VALID))
			return false;
		if (!(aux.tp_status & TP_STATUS_VLAN_TPID_VALID))
			aux.tp_vlan_tpid = ETH_P_8021Q;
		tag[0] = (uint8_t)(aux.tp_vlan_tpid >> 8);
		tag[1] = (uint8_t)aux.tp_vlan_tpid;
		tag[2] = (uint8_t)(aux.tp_vlan_tci >> 8);
		tag[3] = (uint8_t)aux.tp_vlan_tci;
		return true;
	}
	return false;
}

/**
 * port_receive() - next frame
 * @p: port
 * @buf: gets the bytes on the wire, Ethernet header first
 * @cap: bytes at @buf
 *
 * With @p->all the sender may have left checksum and segmentation to its card: @p->offload.
 *
 * Return: bytes of the frame, more than @cap: too long; 0: no frame.
 */
int port_receive(struct port *p, void *buf, size_t cap)
{
	union {
		struct cmsghdr align;
		char buf[CMSG_SPACE(sizeof(struct tpacket_auxdata))];
	} control;
	struct iovec data[] = {
		{ .iov_base = &p->offload, .iov_len = sizeof(p->offload) },
		{ .iov_base = buf, .iov_len = cap },
	};
	struct msghdr msg = {
		.msg_iov = data + !p->all, .msg_iovlen = 1 + p->all,
		.msg_control = control.buf, .msg_controllen = sizeof(control.buf),
	};
	ssize_t n = recvmsg(p->fd, &msg, MSG_TRUNC);
	uint8_t tag[VLAN_TAG], *at = (uint8_t *)buf + MACS;

	if (n < 0 && errno != EAGAIN && errno != EINTR)
		port_check(p);
	if (n < 0)
		return 0;
	if (p->all)
		n -= (ssize_t)sizeof(p->offload);
	if (n < ETH_HLEN || !tag_of(&msg, tag))
		return (int)n;
	p->offload.csum_start = (uint16_t)(p->offload.csum_start + VLAN_TAG);
	if ((size_t)n + VLAN_TAG <= cap) {
		memmove(at + VLAN_TAG, at, (size_t)n - MACS);
		memcpy(at, tag, VLAN_TAG);
	}
	return (int)n + VLAN_TAG;
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
	struct virtio_net_hdr none = { 0 };
	struct iovec data[] = {
		{ .iov_base = &none, .iov_len = sizeof(none) },
		{ .iov_base = (void *)buf, .iov_len = len },
	};

	if (p->all)
		return writev(p->fd, data, 2) == (ssize_t)(sizeof(none) + len) ? 0 : -1;
	return send(p->fd, buf, len, 0) == (ssize_t)len ? 0 : -1;
}
