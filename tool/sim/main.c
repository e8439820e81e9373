// SPDX-License-Identifier: GPL-2.0-only
/* ethercat-sim: a simulated segment at a network interface. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "control.h"
#include "load.h"
#include "port.h"
#include "run.h"

static const char usage[] =
"Usage: ethercat-sim [OPTIONS] INTERFACE [INTERFACE2]\n"
"\n"
"Simulates a segment of slaves: processes the EtherCAT frames received at INTERFACE\n"
"(veth, tap, NIC) and sends them back. INTERFACE2 is the other end of a ring, for the\n"
"second port of a master.\n"
"\n"
"  -s, --segment NAME   built-in segment or file with a description (default: bench)\n"
"      --port SLAVE=IF  the Ethernet port of a slave with eoe=switch is the interface IF,\n"
"                       which exists, or else a tap that is created\n"
"      --control PATH   socket that accepts faults while the simulator runs\n"
"      --tell PATH FAULT...  send a fault to the ethercat-sim with this socket\n"
"      --seed N         replaces the seed of the segment\n"
"      --bug NAME       a deliberate error of the model, to test other programs\n"
"  -v, --verbose        counters every second\n"
"  -l, --list           the built-in segments\n"
"      --list-bugs      the deliberate errors\n"
"  -c, --check NAME     only check a description; errors as 'FILE:LINE: TEXT'\n"
"  -h, --help\n"
"      --version\n"
"\n"
"Needs root or CAP_NET_RAW. The interface must be up and must have no other user.\n"
"Model time is real time: replies are as punctual as the timers of this machine.\n"
"Exits on SIGINT or SIGTERM (status 0) or when an interface disappears (1).\n"
"devices/sim/describe.h describes the syntax of a segment.\n";

struct options {
	const char *segment;
	const char *check;
	const char *control;
	const char *tell;
	const char *port[UPLINKS];
	int n_ports;
	long long seed;
	enum ec_sim_bug bug;
	bool verbose;
	bool list;
	bool list_bugs;
};

static int parse_seed(const char *text, long long *seed)
{
	char *end;

	errno = 0;
	*seed = strtoll(text, &end, 0);
	if (!errno && end != text && !*end && *seed >= 0 && *seed <= EC_SIM_SEED_MAX)
		return 0;
	fprintf(stderr, "ethercat-sim: invalid --seed '%s': expected 0 to %lld\n",
		text, EC_SIM_SEED_MAX);
	return -1;
}

static int parse_bug(const char *text, enum ec_sim_bug *bug)
{
	for (int i = 1; i < EC_SIM_BUGS; i++) {
		if (!strcmp(ec_sim_bug_name(i), text)) {
			*bug = i;
			return 0;
		}
	}
	fprintf(stderr, "ethercat-sim: unknown bug '%s' (see --list-bugs)\n", text);
	return -1;
}

/* 0: continue, 1: done, -1: invalid */
static int parse(int argc, char **argv, struct options *o)
{
	static const struct option longs[] = {
		{ "segment", required_argument, NULL, 's' },
		{ "seed", required_argument, NULL, 'S' },
		{ "bug", required_argument, NULL, 'B' },
		{ "port", required_argument, NULL, 'P' },
		{ "control", required_argument, NULL, 'C' },
		{ "tell", required_argument, NULL, 'T' },
		{ "verbose", no_argument, NULL, 'v' },
		{ "list", no_argument, NULL, 'l' },
		{ "list-bugs", no_argument, NULL, 'L' },
		{ "check", required_argument, NULL, 'c' },
		{ "help", no_argument, NULL, 'h' },
		{ "version", no_argument, NULL, 'V' },
		{ }
	};
	int c;

	while ((c = getopt_long(argc, argv, "s:vlc:h", longs, NULL)) != -1) {
		switch (c) {
		case 's':
			o->segment = optarg;
			break;
		case 'c':
			o->check = optarg;
			break;
		case 'P':
			if (o->n_ports == UPLINKS) {
				fprintf(stderr, "ethercat-sim: more than %d times --port\n",
					UPLINKS);
				return -1;
			}
			o->port[o->n_ports++] = optarg;
			break;
		case 'C':
			o->control = optarg;
			break;
		case 'T':
			o->tell = optarg;
			break;
		case 'v':
			o->verbose = true;
			break;
		case 'l':
			o->list = true;
			break;
		case 'L':
			o->list_bugs = true;
			break;
		case 'S':
			if (parse_seed(optarg, &o->seed))
				return -1;
			break;
		case 'B':
			if (parse_bug(optarg, &o->bug))
				return -1;
			break;
		case 'h':
			fputs(usage, stdout);
			return 1;
		case 'V':
			puts("ethercat-sim " EC_SIM_VERSION);
			return 1;
		default:
			return -1;
		}
	}
	return 0;
}

static int check(const struct options *o)
{
	struct ec_sim *sim = load_segment(o->check, o->seed);

	if (!sim)
		return 1;
	printf("%s: ok, %u slave(s)\n", o->check, ec_sim_count(sim));
	ec_sim_free(sim);
	return 0;
}

static int list_bugs(void)
{
	for (int i = 1; i < EC_SIM_BUGS; i++)
		puts(ec_sim_bug_name(i));
	return 0;
}

/* the words of a fault, as the shell has split them */
static int tell(const struct options *o, char **words, int n)
{
	char text[512] = "";
	size_t len = 0;

	for (int i = 0; i < n; i++) {
		len += (size_t)snprintf(text + len, sizeof(text) - len, "%s%s", i ? " " : "",
					words[i]);
		if (len >= sizeof(text)) {
			fprintf(stderr, "ethercat-sim: invalid fault: more than %zu characters\n",
				sizeof(text) - 1);
			return 2;
		}
	}
	return control_tell(o->tell, text);
}

static int serve(const struct options *o, char **names, int n)
{
	struct port ports[EC_SIM_PORTS] = { { .fd = -1, .claim = -1 }, { .fd = -1, .claim = -1 } };
	struct ec_sim *sim = load_segment(o->segment, o->seed);
	struct uplink uplinks[UPLINKS];
	int i, n_up = 0, ret = 1, control = -1;

	if (!sim)
		return 1;
	ec_sim_set_bug(sim, o->bug);
	for (i = 0; i < n; i++)
		if (port_open(&ports[i], names[i], false))
			goto out;
	while (n_up < o->n_ports) {
		n_up++;
		if (uplink_open(&uplinks[n_up - 1], sim, o->port[n_up - 1]))
			goto out;
	}
	if (o->control) {
		control = control_open(o->control);
		if (control < 0)
			goto out;
	}
	printf("segment %s, %u slave(s), at %s%s%s\n", o->segment, ec_sim_count(sim), names[0],
	       n > 1 ? " and " : "", n > 1 ? names[1] : "");
	fflush(stdout);
	ret = run_segment(sim, ports, n, uplinks, n_up, control, o->verbose);
out:
	control_close(control, o->control);
	for (i = 0; i < n; i++)
		port_close(&ports[i]);
	for (i = 0; i < n_up; i++)
		uplink_close(&uplinks[i]);
	ec_sim_free(sim);
	return ret;
}

int main(int argc, char **argv)
{
	struct options o = { .segment = "bench", .seed = -1 };
	int ret = parse(argc, argv, &o), n = argc - optind;

	if (ret > 0)
		return 0;
	if (ret < 0) {
		fputs("Try 'ethercat-sim --help'.\n", stderr);
		return 2;
	}
	if (o.tell)
		return tell(&o, argv + optind, n);
	if (o.list || o.list_bugs || o.check) {
		if (n) {
			fprintf(stderr, "ethercat-sim: '%s': no interface is used here\n",
				argv[optind]);
			return 2;
		}
		return o.list ? load_list() : o.list_bugs ? list_bugs() : check(&o);
	}
	if (n < 1 || n > EC_SIM_PORTS) {
		fprintf(stderr, "ethercat-sim: %s\nTry 'ethercat-sim --help'.\n",
			n ? "more than two interfaces" : "missing argument: INTERFACE");
		return 2;
	}
	if (n == 2 && !strcmp(argv[optind], argv[optind + 1])) {
		fprintf(stderr, "ethercat-sim: %s is named twice\n", argv[optind]);
		return 2;
	}
	return serve(&o, argv + optind, n);
}
