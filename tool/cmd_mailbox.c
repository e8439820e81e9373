// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "dev.h"
#include "out.h"
#include "sys.h"

#define TYPES	16	/* of protocols */

/* the last request of each protocol to a slave */
struct pending {
	u32 station;
	u64 time_ns[TYPES];	/* 0: none */
	u64 last_ns;	/* of any protocol */
};

/* slaves that are followed; @v is by station address and grows with what is seen */
struct followed {
	bool all;
	struct slaves chosen;
	struct pending *v;
	size_t n;
};

static bool is_followed(const struct followed *f, u32 station)
{
	for (size_t i = 0; i < f->chosen.n; i++)
		if (f->chosen.v[i].station == station)
			return true;
	return f->all;
}

static struct pending *pending_of(struct followed *f, u32 station)
{
	struct pending *more;

	for (size_t i = 0; i < f->n; i++)
		if (f->v[i].station == station)
			return &f->v[i];
	more = realloc(f->v, (f->n + 1) * sizeof(*more));
	if (!more)
		return NULL;
	f->v = more;
	f->v[f->n] = (struct pending){ .station = station };
	return &f->v[f->n++];
}

/* ns from the request of a reply, 0: it has none that was seen */
static u64 since_request(struct followed *f, const struct ect_mail *m)
{
	struct pending *p = pending_of(f, m->station);
	u64 *asked, ns;

	if (!p)
		return 0;
	asked = &p->time_ns[m->type % TYPES];
	if (m->flags & ECT_MAIL_REQUEST) {
		*asked = m->time_ns;
		p->last_ns = m->time_ns;
	}
	if (!(m->flags & ECT_MAIL_REPLY) || m->flags & ECT_MAIL_TO_SLAVE)
		return 0;
	/* an error reply has a type of its own: it answers the last request */
	if (!m->type)
		asked = &p->last_ns;
	ns = *asked && m->time_ns > *asked ? m->time_ns - *asked : 0;
	*asked = 0;
	return ns;
}

static void mail_line(const struct dev *d, const struct ect_mail *m, u64 since)
{
	bool to = m->flags & ECT_MAIL_TO_SLAVE;
	const time_t s = (time_t)(m->wall_ns / 1000000000);
	char when[32] = "?";
	struct tm tm;

	if (gmtime_r(&s, &tm))
		strftime(when, sizeof(when), "%Y-%m-%d %H:%M:%S", &tm);
	if (m->missed)
		out_text("%llu message(s) missed: the reader was too slow\n",
			 (unsigned long long)m->missed);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_u("number", m->number, NULL);
	out_u("missed", m->missed, NULL);
	out_text("%s.%06u UTC", when, (unsigned int)(m->wall_ns / 1000 % 1000000));
	out_u("time_ns", m->wall_ns, NULL);
	out_u("monotonic_ns", m->time_ns, NULL);
	if (m->position == ECT_NONE32)
		out_null("slave", "    -");
	else
		out_u("slave", m->position, "  %3u", m->position);
	out_u("station", m->station, NULL);
	out_str("direction", to ? "to_slave" : "from_slave", "  %-4s", to ? "to" : "from");
	out_str("protocol", m->protocol, "  %-5s", m->protocol);
	out_u("counter", m->counter, NULL);
	out_u("size_bytes", m->size, NULL);
	out_str("service", m->service, "  %s", m->service);
	out_str("object", m->object, "%s%s", *m->object ? " " : "", m->object);
	out_str("result", m->result, "%s%s", *m->result ? ": " : "", m->result);
	out_bool("failed", m->flags & ECT_MAIL_FAILED, NULL);
	out_bool("malformed", m->flags & ECT_MAIL_MALFORMED, NULL);
	out_bool("frame_lost", m->flags & ECT_MAIL_UNSURE, NULL);
	if (m->flags & ECT_MAIL_UNSURE)
		out_text(" (frame lost, the slave may have it)");
	if (since)
		out_u("since_request_ns", since, ", after %llu.%03llu ms",
		      (unsigned long long)(since / 1000000),
		      (unsigned long long)(since / 1000 % 1000));
	out_text("\n");
	out_end();
}

/* Wait for a message; false: stdout was closed, which no write shows while nothing happens. */
static bool wait_mail(const struct dev *d)
{
	struct pollfd p[] = { { .fd = ect_fd(d->h), .events = POLLIN }, { .fd = STDOUT_FILENO } };
	int n;

	do
		n = sys_poll(p, 2);
	while (n < 0 && errno == EINTR);
	return n < 0 || !(p[1].revents & POLLERR);
}

static int follow(struct dev *d, struct followed *f)
{
	u64 missed = 0;

	while (wait_mail(d)) {
		struct ect_list *list;
		size_t n;
		int err = ect_mail_read(d->h, &list);

		if (err)
			return dev_fail(d, err, "Master%u: cannot read mailbox messages",
					d->master);
		n = ect_list_count(list);
		for (size_t i = 0; i < n; i++) {
			struct ect_mail m = *(const struct ect_mail *)ect_list_get(list, i);
			u64 since = since_request(f, &m);

			/* a gap counts where the next line is */
			missed += m.missed;
			if (!is_followed(f, m.station))
				continue;
			m.missed = missed;
			missed = 0;
			mail_line(d, &m, since);
		}
		ect_list_free(list);
		/* the end of the command reports why stdout takes no more */
		if (!n || fflush(stdout))
			return 0;
	}
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct followed f = { .all = list_all(&t->aliases) && list_all(&t->positions) };
	struct dev d;
	int ret, err;

	(void)argc, (void)argv;
	if (!t->follow)
		return usage_error("the command shows messages from now on: give --follow");
	ret = dev_open_single(&d, t, false);
	if (ret)
		return ret;
	if (!f.all)
		ret = dev_select(&d, t, &f.chosen, NULL);
	err = ret ? 0 : ect_mail_begin(d.h);
	if (err)
		ret = dev_fail(&d, err, "Master%u: cannot read mailbox messages", d.master);
	if (!ret && (f.all || f.chosen.n))
		ret = follow(&d, &f);
	slaves_free(&f.chosen);
	free(f.v);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_mailbox = {
	.name = "mailbox",
	.run = run,
	.args = "",
	.opts = "mapF",
	.summary = "Show the mailbox messages of slaves as they pass",
	.help = "With --follow: one line for each message that the master writes to a slave or reads from\n"
		"it, until the command is ended. Columns: time, ring position, direction, protocol,\n"
		"service, object (CoE: index and subindex; FoE: file or packet; SoE: drive, IDN, elements;\n"
		"EoE: frame and fragment; VoE: vendor and type), result: size, first data, or what failed.\n"
		"Behind a reply is the time since its request. Passwords and further data are not shown.\n"
		"The command needs CAP_NET_RAW, as tcpdump. The master keeps the last 1023 messages; a\n"
		"reader that is too slow gets the number of messages missed. Without a reader nothing is\n"
		"kept. --position selects slaves when the command starts; it follows them by station address.\n"
		"  ethercat mailbox --follow -p2\n",
	.json = "each line is an object: master, number, missed (messages before it), time_ns (since\n"
		"1970), monotonic_ns, slave, station, direction (to_slave, from_slave), protocol (CoE,\n"
		"FoE, SoE, EoE, VoE, AoE, error, none or type 0x..), counter, size_bytes, service, object,\n"
		"result, failed, malformed, frame_lost, since_request_ns (replies)",
	.flags = CMD_ONE_MASTER,
};
