/* SPDX-License-Identifier: GPL-2.0-only */
/* What the command files share: options, the command table, errors. */
#ifndef EC_TOOL_H
#define EC_TOOL_H

#include <stdbool.h>
#include <stddef.h>

#include "../master/wire/env.h"
#include "select.h"

#ifndef EC_TOOL_VERSION
#define EC_TOOL_VERSION		"0.1.0"
#endif

#define EC_TOOL_COMMANDS	80	/* at most */

/* bits of struct cmd.flags */
#define CMD_ONE_MASTER		1	/* -m must leave exactly one */
#define CMD_HISTORIC		2	/* abbreviations resolve to it first */
#define CMD_NEGATIVE		4	/* "-1" may be an argument */
#define CMD_LINES		8	/* in JSON a line for each object */
#define CMD_COMPARES		16	/* 1 means a difference, so errors are 2 */

/**
 * struct tool - the command line, parsed
 * @masters: -m
 * @aliases: -a
 * @positions: -p
 * @domains: -d
 * @type: -t, NULL when not given
 * @output_file: -o
 * @skin: -s
 * @emergency: -e
 * @force: -f
 * @reset: -r
 * @retry: --retry: ports that wait are tried at once
 * @let_in: argument of --let-in, 0: not given
 * @json: -j
 * @verbosity: -1 after -q, 1 after -v
 * @boot: --boot
 * @backup: --backup
 * @wait: --wait was given
 * @wait_s: its argument in seconds, negative: none
 * @timeout_ms: argument of --timeout, 0: not given
 * @save: --save, NULL when not given
 * @compare: --compare, NULL when not given
 * @compare_slave: --compare-slave, negative when not given
 * @element: --element, NULL when not given
 * @acknowledge: --acknowledge
 * @coe: --coe
 * @texts: --texts, NULL when not given
 * @tree: --tree
 * @watch_s: argument of --watch in seconds, 0: not given
 * @http: --http
 * @follow: --follow
 * @unsafe: --allow-unreachable
 * @repair: --repair-checksum
 * @dry_run: --dry-run
 * @file: --file, NULL when not given
 * @decode: --decode
 * @whole: --whole
 * @include: --include, NULL when not given
 * @period_us: argument of --period, 0: not given
 * @hold: --hold
 * @lease_ms: argument of --lease, 0: not given
 * @names: --names
 * @when: --when, NULL when not given
 * @before_s: argument of --before in seconds, 0: not given
 * @after_s: argument of --after in seconds, negative: not given
 * @time_s: argument of --time in seconds, 0: not given
 * @count: argument of --count, 0: not given
 */
struct tool {
	struct list masters;
	struct list aliases;
	struct list positions;
	struct list domains;
	const char *type;
	const char *output_file;
	const char *skin;
	bool emergency;
	bool force;
	bool reset;
	bool retry;
	u32 let_in;
	bool json;
	int verbosity;
	bool boot;
	bool backup;
	bool wait;
	double wait_s;
	u32 timeout_ms;
	const char *save;
	const char *compare;
	int compare_slave;
	const char *element;
	bool acknowledge;
	bool coe;
	const char *texts;
	bool tree;
	double watch_s;
	bool http;
	bool follow;
	bool unsafe;
	bool repair;
	bool dry_run;
	const char *file;
	bool decode;
	bool whole;
	const char *include;
	u32 period_us;
	bool hold;
	u32 lease_ms;
	bool names;
	const char *when;
	double before_s;
	double after_s;
	double time_s;
	u64 count;
};

/**
 * struct cmd - one command
 * @name: as typed
 * @run: does it; returns the exit code
 * @args: synopsis of the arguments
 * @opts: letters of the options it uses, except for -h and -j; options without a short form have
 *	letters of options.c
 * @summary: one line
 * @help: paragraphs, may be NULL
 * @json: keys of the JSON output
 * @flags: CMD_*
 * @min_args: fewest arguments
 * @max_args: most arguments
 * @alias_of: not NULL: another name of that command
 */
struct cmd {
	const char *name;
	int (*run)(struct tool *t, int argc, char **argv);
	const char *args;
	const char *opts;
	const char *summary;
	const char *help;
	const char *json;
	unsigned int flags;
	int min_args;
	int max_args;
	const char *alias_of;
};

extern const struct cmd *const cmds[];		/* ends with NULL */

/* options.c */
struct opt {
	char letter;
	const char *name;
	const char *arg;
	const char *text;
};

extern const struct opt opts[];			/* ends with letter 0 */

bool opt_is_short(const struct opt *o);

int options_parse(struct tool *t, int argc, char **argv, char **args, int *nargs, bool *help,
		  char *seen, size_t seen_size);

/* names.c */
const struct cmd *cmd_exact(const char *name);
int cmd_lookup(const char *text, const struct cmd **found);
int cmd_unknown(const char *text);
const char *opt_nearest(const char *word);
int cmd_ambiguous(const char *text, const struct cmd **found, int n);

/* help.c */
void help_all(bool to_stderr);
void help_cmd(const struct cmd *c);
void help_json(const struct cmd *c);
void help_roff(void);
void help_roff_cmd(const struct cmd *c);

/* error.c: both print to stderr, as JSON after --json, and return 1 */
int usage_error(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
int fail(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
/* @err: errno or 0; @reason: text of the kernel or NULL; @abort: SDO abort code or 0 */
int fail_full(int err, const char *reason, u32 abort, const char *fmt, ...)
	__attribute__((format(printf, 4, 5)));
int fail_cause(int err, const char *reason, const char *cause, const char *fmt, ...)
	__attribute__((format(printf, 4, 5)));
void note(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
void error_context(const char *cmd, bool json);

#endif
