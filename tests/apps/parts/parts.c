// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Two parts of a machine, of which one fails or is taken away: for the demonstrations. Each part
 * has a lamp (EL2008) whose output is wired to an input (EL1008), and switches it all the time. A
 * picture at the end shows 100 ms of each part in a column.
 *
 * usage: parts units|groups SECONDS
 *   units    each part is a sync unit; outputs of one that has failed are zero
 *   groups   the second part is a hot connect group with the alias 7
 *
 * The line "running" is printed when all slaves are in OP.
 */
#include <ecrt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PERIOD_NS	2000000U
#define COLUMN		50	/* cycles: 100 ms */
#define COLUMNS_MAX	200
#define OP_TIMEOUT_S	60
#define MEMBERS		3
#define BLINK		100	/* cycles of a lamp, on or off */
#define ALIAS		7

#define VENDOR		2

static const uint32_t products[MEMBERS] = { 0x044c2c52, 0x07d83052, 0x03f03052 };

/**
 * struct part - a part of the machine
 * @name: in the picture
 * @position: of its coupler in the ring
 * @domain: its process data
 * @sc: coupler, lamp, sensor
 * @out: byte of the lamp in the domain
 * @in: byte of the sensor
 * @good: cycles of this column in which its working counter was complete
 * @lit: cycles in which its sensor has seen the lamp
 * @picture: a letter for each column
 */
struct part {
	const char *name;
	uint16_t position;
	ec_domain_t *domain;
	ec_slave_config_t *sc[MEMBERS];
	int out, in;
	unsigned int good, lit;
	char picture[COLUMNS_MAX + 1];
};

static struct part parts[] = { { .name = "left" }, { .name = "right", .position = 3 } };
static ec_master_t *master;
static int groups;

#define PARTS	(sizeof(parts) / sizeof(*parts))

static ec_slave_config_t *member(const struct part *p, int group, unsigned int i)
{
	if (group >= 0)
		return ecrt_master_group_config(master, (unsigned int)group, i, VENDOR,
						products[i]);
	return ecrt_master_slave_config(master, 0, (uint16_t)(p->position + i), VENDOR,
					products[i]);
}

static int configure_part(struct part *p, int group)
{
	const ec_unit_config_t unit = { .name = p->name, .policy = EC_UNIT_ZERO, .limit = 3 };
	int number;

	p->domain = ecrt_master_create_domain(master);
	if (!p->domain)
		return -1;
	for (unsigned int i = 0; i < MEMBERS; i++) {
		p->sc[i] = member(p, group, i);
		if (!p->sc[i])
			return -1;
	}
	p->out = ecrt_slave_config_reg_pdo_entry(p->sc[1], 0x7000, 1, p->domain, NULL);
	p->in = ecrt_slave_config_reg_pdo_entry(p->sc[2], 0x6000, 1, p->domain, NULL);
	if (p->out < 0 || p->in < 0)
		return -1;
	if (groups)
		return 0;
	number = ecrt_master_unit(master, &unit);
	return number < 0 ? number : ecrt_domain_set_unit(p->domain, number);
}

static int configure(void)
{
	const ec_cycle_config_t cycle = { .period_ns = PERIOD_NS, .cpu = -1 };
	const ec_group_info_t info = { .name = "right", .by = EC_GROUP_ALIAS, .value = ALIAS };
	int group = -1;

	if (groups) {
		group = ecrt_master_group(master, &info);
		if (group < 0 || configure_part(&parts[1], group))
			return -1;
	}
	if (configure_part(&parts[0], -1) || (!groups && configure_part(&parts[1], -1)))
		return -1;
	return ecrt_master_set_cycle(master, &cycle);
}

static int in_op(const struct part *p)
{
	for (unsigned int i = 0; i < MEMBERS; i++) {
		ec_slave_config_state_t state;

		if (ecrt_slave_config_state(p->sc[i], &state) || !state.operational)
			return 0;
	}
	return 1;
}

static int cycle(unsigned int count)
{
	int n = ecrt_master_wait_cycle(master, 1000000);

	if (n < 0) {
		fprintf(stderr, "parts: the cycle ended: %s\n", strerror(-n));
		return n;
	}
	ecrt_master_receive(master);
	for (size_t i = 0; i < PARTS; i++) {
		struct part *p = &parts[i];
		uint8_t *data = ecrt_domain_data(p->domain);
		ec_domain_state_t state;

		ecrt_domain_process(p->domain);
		ecrt_domain_state(p->domain, &state);
		p->good += state.wc_state == EC_WC_COMPLETE && state.working_counter > 0;
		p->lit += data[p->in] & 1;
		EC_WRITE_U8(data + p->out, count / BLINK % 2);
		ecrt_domain_queue(p->domain);
	}
	ecrt_master_send(master);
	return 0;
}

/* '#': the lamp was on, '-': off, ' ': no process data, '~': some */
static void column(unsigned int at)
{
	for (size_t i = 0; i < PARTS; i++) {
		struct part *p = &parts[i];

		p->picture[at] = !p->good || !in_op(p) ? ' ' : p->good < COLUMN ? '~' :
				 p->lit > COLUMN / 2 ? '#' : '-';
		p->good = 0;
		p->lit = 0;
	}
}

static void picture(unsigned int columns)
{
	printf("%8s", "");
	for (unsigned int i = 0; i < columns; i += 10)
		printf("|%u s%*s", i / 10, i < 100 ? 6 : 5, "");
	printf("\n");
	for (size_t i = 0; i < PARTS; i++)
		printf("%-8s%s|\n", parts[i].name, parts[i].picture);
	printf("#: lamp on  -: lamp off  ~: some cycles without  blank: no process data\n");
}

static int start(void)
{
	time_t end = time(NULL) + OP_TIMEOUT_S;

	while (!in_op(&parts[0]) || !in_op(&parts[1])) {
		if (cycle(0))
			return -1;
		if (time(NULL) > end) {
			fprintf(stderr, "parts: not all slaves are in OP: run 'ethercat why'\n");
			return -1;
		}
	}
	printf("running\n");
	fflush(stdout);
	parts[0].good = parts[1].good = 0;
	return 0;
}

static int run(unsigned int columns)
{
	if (start())
		return 1;
	for (unsigned int i = 0; i < columns * COLUMN; i++) {
		if (cycle(i))
			return 1;
		if (i % COLUMN == COLUMN - 1)
			column(i / COLUMN);
	}
	picture(columns);
	return 0;
}

int main(int argc, char **argv)
{
	int seconds = argc == 3 ? atoi(argv[2]) : 0, ret;

	groups = argc == 3 && !strcmp(argv[1], "groups");
	if (seconds < 1 || seconds > COLUMNS_MAX / 10 ||
	    (!groups && strcmp(argv[1], "units"))) {
		fprintf(stderr, "usage: parts units|groups SECONDS\n");
		return 2;
	}
	master = ecrt_request_master(0);
	if (!master || configure() || ecrt_master_activate(master)) {
		fprintf(stderr, "parts: cannot configure the master, see dmesg\n");
		return 1;
	}
	ret = run((unsigned int)seconds * 10);
	ecrt_release_master(master);
	return ret;
}
