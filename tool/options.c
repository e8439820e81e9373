// SPDX-License-Identifier: GPL-2.0-only
/* getopt_long() does the parsing; digits are options so that "-1" can be a value. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tool.h"

const struct opt opts[] = {
	{ 'm', "master", "LIST", "master indices, decimal; default all" },
	{ 'a', "alias", "LIST", "alias addresses, decimal; default any" },
	{ 'p', "position", "LIST", "ring positions, positions relative to --alias, or ALIAS:LIST; default any" },
	{ 'd', "domain", "LIST", "domain indices; default all" },
	{ 't', "type", "NAME", "data type of the value, see 'ethercat help types'" },
	{ 'o', "output-file", "FILE", "file to write to; foe_write: file name on the slave" },
	{ 's', "skin", "NAME", "form of the output: default, etherlab" },
	{ 'e', "emergency", NULL, "address by ring position, without the scan result" },
	{ 'f', "force", NULL, "override a safety check" },
	{ 'r', "reset", NULL, "clear after reading" },
	{ 'q', "quiet", NULL, "less output" },
	{ 'v', "verbose", NULL, "more output" },
	{ 'b', "boot", NULL, "for each start of the computer" },
	{ 'u', "backup", NULL, "the backup device, at the other end of a ring" },
	{ 'w', "wait", "[SECONDS]", "wait for the end, at most SECONDS" },
	{ 'I', "timeout", "SECONDS", "time limit of the slave, 0.001 to 600" },
	{ 'S', "save", "FILE", "write the result to a file" },
	{ 'C', "compare", "FILE", "compare with a file of --save; - for stdin" },
	{ 'L', "compare-slave", "POSITION", "compare with another slave" },
	{ 'M', "element", "NAME", "of an IDN: state, name, attribute, unit, minimum, maximum, value, default" },
	{ 'A', "acknowledge", NULL, "acknowledge the newest message" },
	{ 'O', "coe", NULL, "read from the slave over CoE, now" },
	{ 'T', "texts", "FILE", "device description (ESI) with the texts of messages; - for stdin" },
	{ 'W', "watch", "SECONDS", "repeat after SECONDS, 0.1 to 86400, and show what has grown" },
	{ 'R', "retry", NULL, "try at once what waits" },
	{ 'N', "let-in", "PORT", "let the device behind a closed port in" },
	{ 'E', "tree", NULL, "tree of text" },
	{ 'U', "allow-unreachable", NULL, "write an EEPROM also if the slave may be unreachable then" },
	{ 'K', "repair-checksum", NULL, "correct the checksum of an EEPROM" },
	{ 'D', "dry-run", NULL, "check only, change nothing" },
	{ 'G', "include", "NAMES", "drives and safety devices that run as well, apart by commas" },
	{ 'P', "period", "MICROSECONDS", "of the cycle, 100 to 1000000" },
	{ 'H', "hold", NULL, "until it is set again" },
	{ 'l', "lease", "SECONDS", "time until the output becomes zero, 0.01 to 86400" },
	{ 'g', "names", NULL, "values by name instead of bytes" },
	{ 'i', "file", "FILE", "EEPROM image instead of a slave, or bus file with names of values; - for stdin" },
	{ 'x', "decode", NULL, "what the bytes mean" },
	{ 'Z', "whole", NULL, "all that is known" },
	{ 'k', "http", NULL, "reply to a request of HTTP on stdin" },
	{ 'F', "follow", NULL, "also what comes later, until the command is ended" },
	{ 'X', "when", "CONDITION", "begin when it is true" },
	{ 'B', "before", "SECONDS", "also what was before that, 0 to 600" },
	{ 'Y', "after", "SECONDS", "end so long after that, 0 to 86400000" },
	{ 'V', "time", "SECONDS", "end after that time, 0.001 to 86400000" },
	{ 'n', "count", "NUMBER", "end after so many records" },
	{ 'j', "json", NULL, "JSON on stdout, errors as JSON on stderr" },
	{ 'h', "help", NULL, "this text" },
	{ 0 },
};

static const struct option longs[] = {
	{ "master", required_argument, NULL, 'm' },
	{ "alias", required_argument, NULL, 'a' },
	{ "position", required_argument, NULL, 'p' },
	{ "domain", required_argument, NULL, 'd' },
	{ "type", required_argument, NULL, 't' },
	{ "output-file", required_argument, NULL, 'o' },
	{ "skin", required_argument, NULL, 's' },
	{ "emergency", no_argument, NULL, 'e' },
	{ "force", no_argument, NULL, 'f' },
	{ "reset", no_argument, NULL, 'r' },
	{ "quiet", no_argument, NULL, 'q' },
	{ "verbose", no_argument, NULL, 'v' },
	{ "boot", no_argument, NULL, 'b' },
	{ "backup", no_argument, NULL, 'u' },
	{ "wait", optional_argument, NULL, 'w' },
	{ "timeout", required_argument, NULL, 'I' },
	{ "save", required_argument, NULL, 'S' },
	{ "compare", required_argument, NULL, 'C' },
	{ "compare-slave", required_argument, NULL, 'L' },
	{ "element", required_argument, NULL, 'M' },
	{ "acknowledge", no_argument, NULL, 'A' },
	{ "coe", no_argument, NULL, 'O' },
	{ "texts", required_argument, NULL, 'T' },
	{ "watch", required_argument, NULL, 'W' },
	{ "retry", no_argument, NULL, 'R' },
	{ "let-in", required_argument, NULL, 'N' },
	{ "tree", no_argument, NULL, 'E' },
	{ "allow-unreachable", no_argument, NULL, 'U' },
	{ "repair-checksum", no_argument, NULL, 'K' },
	{ "dry-run", no_argument, NULL, 'D' },
	{ "include", required_argument, NULL, 'G' },
	{ "period", required_argument, NULL, 'P' },
	{ "hold", no_argument, NULL, 'H' },
	{ "lease", required_argument, NULL, 'l' },
	{ "names", no_argument, NULL, 'g' },
	{ "file", required_argument, NULL, 'i' },
	{ "decode", no_argument, NULL, 'x' },
	{ "whole", no_argument, NULL, 'Z' },
	{ "http", no_argument, NULL, 'k' },
	{ "follow", no_argument, NULL, 'F' },
	{ "when", required_argument, NULL, 'X' },
	{ "before", required_argument, NULL, 'B' },
	{ "after", required_argument, NULL, 'Y' },
	{ "time", required_argument, NULL, 'V' },
	{ "count", required_argument, NULL, 'n' },
	{ "json", no_argument, NULL, 'j' },
	{ "help", no_argument, NULL, 'h' },
	{ 0 },
};

static const char shorts[] = "-:m:a:p:d:t:o:s:efrqvjh0::1::2::3::4::5::6::7::8::9::.::";

/* else the letter is only for the tables */
bool opt_is_short(const struct opt *o)
{
	return strchr(shorts, o->letter);
}

static int parse_list(struct list *l, char letter, const char *text)
{
	const char *why;

	if (!list_parse(l, text, &why))
		return 0;
	for (const struct opt *o = opts; o->letter; o++)
		if (o->letter == letter)
			return usage_error("invalid list '%s' for --%s: %s", text, o->name, why);
	return 1;
}

static int parse_positions(struct tool *t, const char *text)
{
	const char *why;

	if (!position_parse(&t->aliases, &t->positions, text, &why))
		return 0;
	return usage_error("invalid list '%s' for --position: %s", text, why);
}

static bool seconds(const char *text, double *s)
{
	char *end;

	if (!text || !*text || text[strspn(text, "0123456789.")])
		return false;
	*s = strtod(text, &end);
	return !*end;
}

static int position(const char *text, int *to)
{
	size_t n = strspn(text, "0123456789");

	if (!n || n > 5 || text[n] || atoi(text) > 0xffff)
		return usage_error("invalid position '%s': expected 0 to 65535", text);
	*to = atoi(text);
	return 0;
}

static int watch(const char *text, double *s)
{
	if (!seconds(text, s) || *s < 0.1 || *s > 86400)
		return usage_error("invalid time '%s' for --watch: expected 0.1 to 86400 seconds",
				   text);
	return 0;
}

static int timeout(const char *text, u32 *ms)
{
	double s;

	if (!seconds(text, &s) || s < 0.001 || s > 600)
		return usage_error("invalid time '%s' for --timeout: expected 0.001 to 600 seconds",
				   text);
	*ms = (u32)(s * 1000 + 0.5);
	return 0;
}

static int period(const char *text, u32 *us)
{
	size_t n = strspn(text, "0123456789");

	if (!n || n > 7 || text[n] || atoi(text) < 100 || atoi(text) > 1000000)
		return usage_error("invalid time '%s' for --period: expected 100 to 1000000 microseconds",
				   text);
	*us = (u32)atoi(text);
	return 0;
}

static int lease(const char *text, u32 *ms)
{
	double s;

	if (!seconds(text, &s) || s < 0.01 || s > 86400)
		return usage_error("invalid time '%s' for --lease: expected 0.01 to 86400 seconds",
				   text);
	*ms = (u32)(s * 1000 + 0.5);
	return 0;
}

/* a time of a recording */
static int duration(const char *text, const char *name, double least, double most, double *s)
{
	if (!seconds(text, s) || *s < least || *s > most)
		return usage_error("invalid time '%s' for --%s: expected %g to %.0f seconds", text,
				   name, least, most);
	return 0;
}

static int count(const char *text, u64 *n)
{
	size_t digits = strspn(text, "0123456789");

	if (!digits || digits > 18 || text[digits] || !strtoull(text, NULL, 10))
		return usage_error("invalid number '%s' for --count: expected 1 or more", text);
	*n = strtoull(text, NULL, 10);
	return 0;
}

static int port(const char *text, u32 *value)
{
	if (text[0] < '1' || text[0] >= '0' + ECT_PORTS || text[1])
		return usage_error("invalid port '%s' for --let-in: expected 1 to %u", text,
				   ECT_PORTS - 1);
	*value = (u32)(text[0] - '0');
	return 0;
}

static int unknown_long(const char *word)
{
	const char *nearest;
	char name[32];

	snprintf(name, sizeof(name), "%.*s", (int)strcspn(word + 2, "="), word + 2);
	for (const struct opt *o = opts; o->letter; o++)
		if (!strncmp(o->name, name, strlen(name)))
			return usage_error("ambiguous option '--%s'", name);
	nearest = opt_nearest(name);
	if (!nearest)
		return usage_error("unknown option '--%s'", name);
	return usage_error("unknown option '--%s'; did you mean '--%s'?", name, nearest);
}

static int bad_option(char **argv, int c)
{
	const char *word = argv[optind - 1];

	if (c == ':' && !strncmp(word, "--", 2))
		return usage_error("option '%s' needs an argument", word);
	if (c == ':')
		return usage_error("option '-%c' needs an argument", optopt);
	if (!optopt)
		return unknown_long(word);
	if (!strncmp(word, "--", 2) && strchr(word, '='))
		return usage_error("option '%s' takes no argument", word);
	return usage_error("unknown option '-%c'", optopt);
}

/* a word that begins with "-" and a digit or a point is a value, not an option */
static bool negative(const char *word)
{
	return word[0] == '-' && ((word[1] >= '0' && word[1] <= '9') ||
				  (word[1] == '.' && word[2] >= '0' && word[2] <= '9'));
}

static int one_option(struct tool *t, int c, char **argv, int argc)
{
	switch (c) {
	case 'm':
		return parse_list(&t->masters, 'm', optarg);
	case 'a':
		return parse_list(&t->aliases, 'a', optarg);
	case 'p':
		return parse_positions(t, optarg);
	case 'd':
		return parse_list(&t->domains, 'd', optarg);
	case 't':
		t->type = optarg;
		return 0;
	case 'o':
		t->output_file = optarg;
		return 0;
	case 's':
		t->skin = optarg;
		return 0;
	case 'e':
		t->emergency = true;
		return 0;
	case 'f':
		t->force = true;
		return 0;
	case 'r':
		t->reset = true;
		return 0;
	case 'q':
		t->verbosity = -1;
		return 0;
	case 'v':
		t->verbosity = 1;
		return 0;
	case 'b':
		t->boot = true;
		return 0;
	case 'u':
		t->backup = true;
		return 0;
	case 'S':
		t->save = optarg;
		return 0;
	case 'C':
		t->compare = optarg;
		return 0;
	case 'L':
		return position(optarg, &t->compare_slave);
	case 'M':
		t->element = optarg;
		return 0;
	case 'A':
		t->acknowledge = true;
		return 0;
	case 'O':
		t->coe = true;
		return 0;
	case 'T':
		t->texts = optarg;
		return 0;
	case 'W':
		return watch(optarg, &t->watch_s);
	case 'I':
		return timeout(optarg, &t->timeout_ms);
	case 'E':
		t->tree = true;
		return 0;
	case 'F':
		t->follow = true;
		return 0;
	case 'k':
		t->http = true;
		return 0;
	case 'U':
		t->unsafe = true;
		return 0;
	case 'K':
		t->repair = true;
		return 0;
	case 'D':
		t->dry_run = true;
		return 0;
	case 'i':
		t->file = optarg;
		return 0;
	case 'x':
		t->decode = true;
		return 0;
	case 'Z':
		t->whole = true;
		return 0;
	case 'G':
		t->include = optarg;
		return 0;
	case 'P':
		return period(optarg, &t->period_us);
	case 'H':
		t->hold = true;
		return 0;
	case 'l':
		return lease(optarg, &t->lease_ms);
	case 'g':
		t->names = true;
		return 0;
	case 'X':
		t->when = optarg;
		return 0;
	case 'B':
		return duration(optarg, "before", 0, 600, &t->before_s);
	case 'Y':
		return duration(optarg, "after", 0, 86400000, &t->after_s);
	case 'V':
		return duration(optarg, "time", 0.001, 86400000, &t->time_s);
	case 'n':
		return count(optarg, &t->count);
	case 'R':
		t->retry = true;
		return 0;
	case 'N':
		return port(optarg, &t->let_in);
	case 'j':
		t->json = true;
		return 0;
	case 'w':
		t->wait = true;
		if (!optarg && optind < argc && seconds(argv[optind], &t->wait_s))
			optind++;
		else if (optarg && !seconds(optarg, &t->wait_s))
			return usage_error("invalid time '%s' for --wait: expected seconds",
					   optarg);
		return 0;
	default:
		return bad_option(argv, c);
	}
}

/* the command that these words are for, so that an error in an option names it */
static const char *meant_command(int argc, char **argv)
{
	const struct cmd *found[EC_TOOL_COMMANDS];

	for (int i = 1; i < argc; i++)
		if (cmd_exact(argv[i]))
			return argv[i];
	if (argc > 1 && *argv[1] != '-' && cmd_lookup(argv[1], found) == 1)
		return found[0]->name;
	return "";
}

/**
 * options_parse() - take options and arguments apart
 * @t: options
 * @argc: of main()
 * @argv: of main()
 * @args: arguments, an array of @argc; the first is the command
 * @nargs: how many
 * @help: -h was given
 * @seen: letters of the options given
 * @seen_size: size of @seen
 *
 * Options may stand anywhere; "--" ends them.
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int options_parse(struct tool *t, int argc, char **argv, char **args, int *nargs, bool *help,
		  char *seen, size_t seen_size)
{
	const char *command = meant_command(argc, argv);
	size_t n = 0;
	int c, ret;

	*t = (struct tool){ .wait_s = -1, .compare_slave = -1, .after_s = -1 };
	*nargs = 0;
	*help = false;
	opterr = 0;
	error_context(command, false);
	/* errors of the command line itself are JSON as well */
	for (int i = 1; i < argc && strcmp(argv[i], "--"); i++)
		if (!strcmp(argv[i], "--json") || !strcmp(argv[i], "-j"))
			error_context(command, true);
	while ((c = getopt_long(argc, argv, shorts, longs, NULL)) != -1) {
		if (c == 1 ||
		    ((c == '.' || (c >= '0' && c <= '9')) && negative(argv[optind - 1]))) {
			args[(*nargs)++] = c == 1 ? optarg : argv[optind - 1];
			continue;
		}
		if (c == '.' || (c >= '0' && c <= '9'))
			return usage_error("unknown option '%s'", argv[optind - 1]);
		if (c == 'h') {
			*help = true;
			continue;
		}
		ret = one_option(t, c, argv, argc);
		if (ret)
			return ret;
		if (n + 1 < seen_size)
			seen[n++] = (char)c;
	}
	seen[n] = 0;
	while (optind < argc)
		args[(*nargs)++] = argv[optind++];
	return 0;
}
