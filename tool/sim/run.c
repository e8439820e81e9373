// SPDX-License-Identifier: GPL-2.0-only
/*
 * Real time is model time, from 0 at the start. A frame enters the segment
 * when it is read from the interface, and leaves after the time the modelled
 * wire takes, or as soon after that as this computer can.
 */
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <time.h>

#include "../../master/wire/frame.h"
#include "control.h"
#include "run.h"

#define FRAMES	1024		/* in flight at once */
#define BURST	64		/* frames read before others are sent */
#define LOOK_NS	100000000ull	/* longest sleep */
#define UPLINK_NS	1000000ull	/* the same with Ethernet ports */
#define SECOND	1000000000ull

/* a frame that returns to the master */
struct flying {
	struct flying *next;
	struct ec_sim_flight flight;
	u64 due_ns;
	int port;
	size_t len;
	u8 data[EC_SIM_ETH_MAX];
};

/**
 * struct run - a running segment
 * @sim: the segment
 * @ports: interfaces, of master port 0 and 1
 * @n_ports: how many
 * @uplinks: Ethernet ports of slaves
 * @n_uplinks: how many
 * @control: socket of control_open(), -1: none
 * @flying: by time of arrival
 * @under_way: frames of which it is not known yet whether and when they return
 * @free: unused frames
 * @wire_free_ns: when the last frame has left the master, by port
 * @start_ns: time of the clock at model time 0
 * @rx: frames received
 * @tx: frames sent back
 * @lost: frames the segment lost
 * @dropped: frames too long, too many or not sent
 */
struct run {
	struct ec_sim *sim;
	struct port *ports;
	int n_ports;
	struct uplink *uplinks;
	int n_uplinks;
	int control;
	struct flying *flying;
	struct flying *under_way;
	struct flying *free;
	u64 wire_free_ns[EC_SIM_PORTS];
	u64 start_ns;
	u64 rx;
	u64 tx;
	u64 lost;
	u64 dropped;
};

static volatile sig_atomic_t stop;

static void on_signal(int sig)
{
	stop = sig;
}

static u64 now_ns(const struct run *r)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (u64)t.tv_sec * SECOND + (u64)t.tv_nsec - r->start_ns;
}

static struct flying *take(struct run *r)
{
	struct flying *f = r->free;

	if (f)
		r->free = f->next;
	return f;
}

static void give(struct run *r, struct flying *f)
{
	f->next = r->free;
	r->free = f;
}

static void insert(struct run *r, struct flying *f)
{
	struct flying **p = &r->flying;

	while (*p && (*p)->due_ns <= f->due_ns)
		p = &(*p)->next;
	f->next = *p;
	*p = f;
}

/* Copies of a frame follow one another on the wire. */
static void copies(struct run *r, const struct flying *f, unsigned int n)
{
	for (unsigned int i = 1; i < n; i++) {
		struct flying *g = take(r);

		if (!g) {
			r->dropped++;
			return;
		}
		memcpy(g->data, f->data, f->len);
		g->len = f->len;
		g->port = f->port;
		g->due_ns = f->due_ns + i * ec_frame_wire_ns(f->len);
		insert(r, g);
	}
}

/* The segment knows what becomes of a frame. */
static void decided(struct run *r, struct flying *f)
{
	const struct ec_sim_result *res = &f->flight.res;

	if (res->delay_ns < 0 || !res->copies || res->out_port >= r->n_ports) {
		r->lost++;
		give(r, f);
		return;
	}
	f->port = res->out_port;
	f->due_ns = f->flight.due_ns;
	insert(r, f);
	copies(r, f, res->copies);
}

/* Frames of which it was not known yet. */
static void collect(struct run *r)
{
	struct flying **at = &r->under_way;

	while (*at) {
		struct flying *f = *at;

		if (f->flight.done) {
			*at = f->next;
			decided(r, f);
		} else {
			at = &f->next;
		}
	}
}

/* Frames that no master has sent. */
static void foreign(struct run *r)
{
	struct ec_sim_foreign o;

	while (ec_sim_foreign(r->sim, &o)) {
		struct flying *f = o.port < r->n_ports ? take(r) : NULL;

		if (!f)
			continue;
		f->port = o.port;
		f->due_ns = o.due_ns;
		f->len = sizeof(o.eth);
		memcpy(f->data, o.eth, sizeof(o.eth));
		insert(r, f);
	}
}

static void advance(struct run *r)
{
	ec_sim_advance(r->sim, now_ns(r));
	collect(r);
	foreign(r);
}

/* One frame through the segment. */
static void launch(struct run *r, int port, struct flying *f)
{
	u64 start = max(now_ns(r), r->wire_free_ns[port]);

	r->wire_free_ns[port] = start + ec_frame_wire_ns(f->len);
	ec_sim_send(r->sim, &f->flight, port, f->data, f->len, start);
	f->next = r->under_way;
	r->under_way = f;
	collect(r);		/* mostly this one */
	foreign(r);
}

static void receive(struct run *r, int port)
{
	for (int i = 0; i < BURST; i++) {
		struct flying *f = take(r);
		int n;

		if (!f)		/* the rest waits in the socket */
			return;
		n = port_receive(&r->ports[port], f->data, sizeof(f->data));
		if (n <= 0) {
			give(r, f);
			return;
		}
		r->rx++;
		if (n > (int)sizeof(f->data)) {
			r->dropped++;
			give(r, f);
			continue;
		}
		f->len = (size_t)n;
		launch(r, port, f);
	}
}

static void deliver(struct run *r)
{
	if (r->under_way)
		advance(r);
	while (r->flying && r->flying->due_ns <= now_ns(r)) {
		struct flying *f = r->flying;

		r->flying = f->next;
		if (port_send(&r->ports[f->port], f->data, f->len))
			r->dropped++;
		else
			r->tx++;
		give(r, f);
	}
}

static void show(const struct run *r)
{
	printf("%llu frames in, %llu out, %llu lost in the segment, %llu dropped\n",
	       (unsigned long long)r->rx, (unsigned long long)r->tx,
	       (unsigned long long)r->lost, (unsigned long long)r->dropped);
	fflush(stdout);
}

/* Frames that leave slaves by their Ethernet ports. */
static void leave(struct run *r)
{
	if (r->n_uplinks)
		advance(r);
	for (int i = 0; i < r->n_uplinks; i++)
		uplink_out(&r->uplinks[i]);
}

/* Sleep until a frame arrives or is due. */
static void rest(struct run *r, const sigset_t *mask)
{
	struct pollfd fds[EC_SIM_PORTS + 1 + UPLINKS], *up;
	u64 now = now_ns(r), left = r->n_uplinks ? UPLINK_NS : LOOK_NS;
	u64 next = ec_sim_next_step(r->sim);
	struct timespec t;
	int i;

	if (r->flying)
		next = min(next, r->flying->due_ns);
	if (next != EC_ESC_NEVER)
		left = next > now ? min(next - now, left) : 0;
	for (i = 0; i < r->n_ports; i++)
		fds[i] = (struct pollfd){ .fd = r->ports[i].fd, .events = r->free ? POLLIN : 0 };
	fds[i] = (struct pollfd){ .fd = r->control, .events = POLLIN };
	up = &fds[i + 1];
	for (int k = 0; k < r->n_uplinks; k++)
		up[k] = (struct pollfd){
			.fd = r->uplinks[k].port.fd,
			.events = ec_app_eoe_takes(r->uplinks[k].app) ? POLLIN : 0,
		};
	t = (struct timespec){ .tv_nsec = (long)left };
	if (ppoll(fds, (nfds_t)(r->n_ports + 1 + r->n_uplinks), &t, mask) < 0)
		return;
	for (i = 0; i < r->n_ports; i++)
		if (fds[i].revents)
			receive(r, i);
	if (fds[i].revents) {
		advance(r);	/* a fault begins now */
		control_receive(r->control, r->sim);
	}
	for (int k = 0; k < r->n_uplinks; k++)
		if (up[k].revents || uplink_waits(&r->uplinks[k]))
			uplink_in(&r->uplinks[k], now_ns(r));
}

/* Periodic: advance the time of a quiet segment, check the interfaces. */
static bool look(struct run *r)
{
	advance(r);
	for (int i = 0; i < r->n_ports; i++) {
		port_check(&r->ports[i]);
		if (r->ports[i].gone)
			return false;
	}
	return true;
}

static void loop(struct run *r, const sigset_t *mask, bool verbose)
{
	u64 looked = 0, shown = 0;

	while (!stop) {
		u64 now = now_ns(r);

		deliver(r);
		leave(r);
		if (now - looked >= LOOK_NS) {
			looked = now;
			if (!look(r))
				return;
		}
		if (verbose && now - shown >= SECOND) {
			shown = now;
			show(r);
		}
		rest(r, mask);
	}
}

/* Signals arrive in ppoll() only, so none is missed. */
static void catch_signals(sigset_t *old)
{
	struct sigaction act = { .sa_handler = on_signal };
	sigset_t block;

	sigemptyset(&block);
	sigaddset(&block, SIGINT);
	sigaddset(&block, SIGTERM);
	sigaddset(&block, SIGHUP);
	sigprocmask(SIG_BLOCK, &block, old);
	sigaction(SIGINT, &act, NULL);
	sigaction(SIGTERM, &act, NULL);
	sigaction(SIGHUP, &act, NULL);
}

/**
 * run_segment() - answer frames until a signal comes
 * @sim: segment
 * @ports: interfaces, of master port 0 and 1
 * @n_ports: how many
 * @uplinks: Ethernet ports of slaves
 * @n_uplinks: how many
 * @control: socket of control_open(), -1: none
 * @verbose: counters every second
 *
 * Return: exit status: 0 after a signal, 1 when an interface was removed.
 */
int run_segment(struct ec_sim *sim, struct port *ports, int n_ports, struct uplink *uplinks,
		int n_uplinks, int control, bool verbose)
{
	struct run r = {
		.sim = sim, .ports = ports, .n_ports = n_ports, .uplinks = uplinks,
		.n_uplinks = n_uplinks, .control = control,
	};
	struct flying *frames = calloc(FRAMES, sizeof(*frames));
	sigset_t mask;

	if (!frames) {
		fprintf(stderr, "ethercat-sim: out of memory\n");
		return 1;
	}
	for (int i = 0; i < FRAMES; i++)
		give(&r, &frames[i]);
	catch_signals(&mask);
	prctl(PR_SET_TIMERSLACK, 1ul);
	r.start_ns = now_ns(&r);
	loop(&r, &mask, verbose);
	show(&r);
	free(frames);
	return !stop;
}
