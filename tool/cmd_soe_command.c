// SPDX-License-Identifier: GPL-2.0-only
/* Procedure commands of servo drives: start, progress, end, cancel. */
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "../master/wire/soe.h"
#include "out.h"
#include "idn.h"
#include "sdo.h"

#define POLL_US		50000
#define START		(EC_SOE_COMMAND_SET | EC_SOE_COMMAND_ENABLE)
#define NOT_OVER	0x10000	/* no data state */

struct command {
	const struct tool *t;
	struct dev *d;
	struct ect_slave s;
	struct soe_addr a;
};

static volatile sig_atomic_t interrupted;

static void interrupt(int signal)
{
	(void)signal;
	interrupted = 1;
}

static double now(void)
{
	struct timespec ts;

	clock_gettime(CLOCK_MONOTONIC, &ts);
	return (double)ts.tv_sec + (double)ts.tv_nsec / 1e9;
}

static int put(struct command *c, u16 value)
{
	u8 data[2];
	int err;

	put_unaligned_le16(value, data);
	c->a.element = ECT_SOE_VALUE;
	err = soe_put(c->t, c->d, &c->s, &c->a, data, sizeof(data));
	return err ? soe_failed(c->d, err, &c->s, &c->a, value ? "start" : "cancel") : 0;
}

static int get_state(struct command *c, u32 *state)
{
	static u8 data[SOE_MAX];
	long n;

	c->a.element = ECT_SOE_STATE;
	n = soe_get(c->t, c->d, &c->s, &c->a, data);
	if (n < 0)
		return soe_failed(c->d, (int)n, &c->s, &c->a, "read");
	if (n != 2)
		return fail("invalid data state of %s: %ld bytes, expected 2", c->a.text, n);
	*state = get_unaligned_le16(data);
	return 0;
}

/* What is written to another IDN would change its value. */
static int check_is_command(struct command *c)
{
	static u8 data[SOE_MAX];
	long n;

	c->a.element = ECT_SOE_ATTRIBUTE;
	n = soe_get(c->t, c->d, &c->s, &c->a, data);
	if (n < 0)
		return soe_failed(c->d, (int)n, &c->s, &c->a, "read");
	if (n != 4 || !(get_unaligned_le32(data) & EC_SOE_ATTR_COMMAND))
		return fail("Master%u slave %u: %s of drive %u is no procedure command; S-0-0025 lists them",
			    c->d->master, c->s.position, c->a.text, c->a.drive);
	return 0;
}

static bool is_over(u32 state)
{
	return !(state & EC_SOE_COMMAND_BUSY) || state & EC_SOE_COMMAND_ERROR;
}

/* Until the command is over; progress goes to stderr, since it is no result. */
static int await(struct command *c, double begin, u32 *state)
{
	u32 shown = NOT_OVER;

	for (;;) {
		double took = now() - begin;

		if (get_state(c, state))
			return 1;
		if (*state != shown && c->t->verbosity > 0)
			note("%7.3f s  0x%04x  %s", took, *state, ec_soe_command_text((u16)*state));
		shown = *state;
		if (is_over(*state))
			return 0;
		if (interrupted)
			return fail("Master%u slave %u: %s of drive %u cancelled after %.1f s",
				    c->d->master, c->s.position, c->a.text, c->a.drive, took);
		if (c->t->wait_s > 0 && took > c->t->wait_s)
			return fail("Master%u slave %u: %s of drive %u not executed within %.1f s, cancelled",
				    c->d->master, c->s.position, c->a.text, c->a.drive,
				    c->t->wait_s);
		usleep(POLL_US);
	}
}

static void result(const struct command *c, u32 state)
{
	out_u("master", c->d->master, NULL);
	out_u("position", c->s.position, NULL);
	out_u("drive", c->a.drive, NULL);
	out_u("idn", c->a.idn, NULL);
	out_str("name", c->a.text, "%s", c->a.text);
	out_u("state", state, "  0x%04x", state);
	out_str("text", ec_soe_command_text((u16)state), "  %s\n",
		ec_soe_command_text((u16)state));
}

/* Start it, wait, and take the request back in any case: else the drive keeps it. */
static int execute(struct command *c)
{
	struct sigaction act = { .sa_handler = interrupt };
	double begin = now();
	u32 state = 0;
	int ret;

	sigaction(SIGINT, &act, NULL);
	sigaction(SIGTERM, &act, NULL);
	if (put(c, START))
		return 1;
	ret = await(c, begin, &state);
	if (put(c, 0) || ret)
		return 1;
	if (state & EC_SOE_COMMAND_ERROR)
		return fail("Master%u slave %u: %s of drive %u failed, data state 0x%04x",
			    c->d->master, c->s.position, c->a.text, c->a.drive, state);
	result(c, state);
	return 0;
}

static int action(struct command *c, const char *name)
{
	u32 state;

	if (check_is_command(c))
		return 1;
	if (!strcmp(name, "run"))
		return execute(c);
	if (!strcmp(name, "start") && put(c, START))
		return 1;
	if (!strcmp(name, "cancel") && put(c, 0))
		return 1;
	if (get_state(c, &state))
		return 1;
	result(c, state);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	static const char * const names[] = { "run", "start", "cancel", "state" };
	const char *what = "run";
	struct command c = { .t = t };
	struct dev d;
	int ret;

	for (u32 i = 0; i < ARRAY_SIZE(names); i++) {
		if (argc > 1 && !strcmp(argv[argc - 1], names[i])) {
			what = names[i];
			argc--;
			break;
		}
	}
	if (argc > 2)
		return usage_error("invalid action '%s': expected run, start, cancel or state",
				   argv[2]);
	if (sdo_timeout_check(t) ||
	    soe_addr_parse(&c.a, argc > 1 ? argv[0] : NULL, argv[argc - 1]) ||
	    dev_open_single(&d, t, true))
		return 1;
	c.d = &d;
	ret = dev_select_single(&d, t, &c.s) || action(&c, what);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_soe_command = {
	.name = "soe_command",
	.run = run,
	.args = "[DRIVE] IDN [ACTION]",
	.opts = "mapIvw",
	.summary = "Execute a procedure command of a servo drive (SoE)",
	.help = "DRIVE := { 0 to 7 }, default 0\n"
		"IDN := { S-SET-NUMBER | P-SET-NUMBER | 0 to 0xffff }     S-0-99, S-0-148\n"
		"ACTION := { run | start | cancel | state }, default run\n"
		"run sets and enables the command, reads its data state until it is executed or has\n"
		"failed, and takes the request back. A drive may move meanwhile: an interrupt (Ctrl+C),\n"
		"or --wait that is over, cancels the command. --verbose shows each change of the data\n"
		"state on stderr. start does not wait, cancel takes the request back, state only shows the\n"
		"data state. --timeout is the limit of each reply.\n",
	.json = "master, position, drive, idn, name, state, text",
	.flags = CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 3,
};
