// SPDX-License-Identifier: GPL-2.0-only
/*
 * An Ethernet port of a slave (eoe=switch) is a tap with a name of its own, or a packet socket at
 * an interface that exists, for example one end of a veth pair.
 */
#include <errno.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "uplink.h"

#define BURST	16

static struct ec_app *find(struct ec_sim *sim, const char *name, size_t len)
{
	for (u32 i = 0; i < ec_sim_count(sim); i++) {
		struct ec_app *app = ec_app_of(ec_sim_at(sim, i));

		if (strlen(app->name) == len && !memcmp(app->name, name, len))
			return app;
	}
	return NULL;
}

static int open_tap(struct uplink *u, const char *name)
{
	struct ifreq r = { .ifr_flags = IFF_TAP | IFF_NO_PI };

	u->port.fd = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
	if (u->port.fd < 0) {
		fprintf(stderr, "ethercat-sim: cannot open /dev/net/tun: %s\n", strerror(errno));
		return -1;
	}
	snprintf(r.ifr_name, sizeof(r.ifr_name), "%s", name);
	if (ioctl(u->port.fd, TUNSETIFF, &r)) {
		fprintf(stderr, "ethercat-sim: cannot create the tap %s: %s\n", name,
			strerror(errno));
		return -1;
	}
	return 0;
}

static int open_interface(struct uplink *u, const char *name)
{
	u->offload = calloc(1, sizeof(*u->offload));
	if (!u->offload) {
		fprintf(stderr, "ethercat-sim: no memory\n");
		return -1;
	}
	return port_open(&u->port, name, true);
}

/**
 * uplink_open() - connect an Ethernet port of a slave; reports errors on stderr
 * @u: the port
 * @sim: segment
 * @text: SLAVE=INTERFACE
 *
 * Return: 0 or -1.
 */
int uplink_open(struct uplink *u, struct ec_sim *sim, const char *text)
{
	const char *name = strchr(text, '=');

	*u = (struct uplink){ .port = { .fd = -1, .claim = -1 } };
	if (!name || !name[1] || strlen(name + 1) >= IF_NAMESIZE) {
		fprintf(stderr, "ethercat-sim: invalid --port '%s': expected SLAVE=INTERFACE\n",
			text);
		return -1;
	}
	u->app = find(sim, text, (size_t)(name - text));
	if (!u->app || !ec_app_eoe_has_port(u->app)) {
		fprintf(stderr, "ethercat-sim: --port %s: no slave of this name with eoe=switch\n",
			text);
		return -1;
	}
	return if_nametoindex(name + 1) ? open_interface(u, name + 1) : open_tap(u, name + 1);
}

/**
 * uplink_close() - disconnect the port; a tap disappears
 * @u: the port
 */
void uplink_close(struct uplink *u)
{
	port_close(&u->port);
	free(u->offload);
	u->offload = NULL;
}

/**
 * uplink_out() - send the frames that leave the slave
 * @u: the port
 */
void uplink_out(struct uplink *u)
{
	u8 frame[EC_EOE_FRAME_MAX];
	u16 len;

	while ((len = ec_app_eoe_leave(u->app, frame)))
		if (u->offload ? port_send(&u->port, frame, len) :
				 write(u->port.fd, frame, len) != len)
			u->dropped++;
}

/* The next frame as it would be on the wire. */
static int receive(struct uplink *u, u8 *frame, size_t cap)
{
	struct offload *o = u->offload;
	size_t n;
	int got;

	if (!o)
		return (int)read(u->port.fd, frame, cap);
	for (;;) {
		n = offload_next(o, frame, cap);
		if (n)
			return (int)n;
		got = port_receive(&u->port, o->frame, sizeof(o->frame));
		if (got <= 0)
			return got;
		if (!offload_begin(o, (size_t)got, &u->port.offload))
			u->dropped++;
	}
}

/**
 * uplink_waits() - does a frame wait that the interface does not show
 * @u: the port
 *
 * Return: whether segments of one wait here.
 */
bool uplink_waits(const struct uplink *u)
{
	return u->offload && u->offload->len;
}

/**
 * uplink_in() - frames that come to the slave; the rest waits in the interface
 * @u: the port
 * @now: time, ns
 */
void uplink_in(struct uplink *u, u64 now)
{
	u8 frame[EC_EOE_FRAME_MAX];

	for (int i = 0; i < BURST && ec_app_eoe_takes(u->app); i++) {
		int n = receive(u, frame, sizeof(frame));

		if (n <= 0)
			return;
		if (n > (int)sizeof(frame))
			u->dropped++;
		else
			ec_app_eoe_enter(u->app, frame, (u16)n, now);
	}
}
