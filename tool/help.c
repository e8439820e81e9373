// SPDX-License-Identifier: GPL-2.0-only
/* Help and the man page, both made from the tables of commands and options. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "data_types.h"
#include "out.h"
#include "tool.h"

static void print_opt(FILE *f, const struct opt *o)
{
	char text[64];

	if (!opt_is_short(o))
		snprintf(text, sizeof(text), "    --%s%s%s", o->name, o->arg ? " " : "",
			 o->arg ? o->arg : "");
	else
		snprintf(text, sizeof(text), "-%c, --%s%s%s", o->letter, o->name,
			 o->arg ? " " : "", o->arg ? o->arg : "");
	fprintf(f, "  %-26s %s\n", text, o->text);
}

static bool uses(const struct cmd *c, const struct opt *o)
{
	return strchr("jh", o->letter) || strchr(c->opts, o->letter);
}

/* overview; on stderr when no command was typed */
void help_all(bool to_stderr)
{
	FILE *f = to_stderr ? stderr : stdout;

	fputs("Usage: ethercat COMMAND [OPTIONS] [ARGUMENTS]\n\nCommands:\n", f);
	for (const struct cmd *const *c = cmds; *c; c++)
		if ((*c)->run)
			fprintf(f, "  %-12s %s\n", (*c)->name, (*c)->summary);
	fputs("\nOptions (each command lists those it uses):\n", f);
	for (const struct opt *o = opts; o->letter; o++)
		print_opt(f, o);
	fputs("\nLIST := { N | N-M | N- | -M | - } [,LIST]     decimal\n"
	      "Other numbers are decimal, 0x... hexadecimal or 0... octal.\n"
	      "Commands may be abbreviated. 'ethercat help COMMAND' describes one.\n", f);
}

/* one command */
void help_cmd(const struct cmd *c)
{
	bool any = false;

	printf("Usage: ethercat %s [OPTIONS]%s%s\n\n%s.\n", c->name, *c->args ? " " : "", c->args,
	       c->summary);
	for (const struct cmd *const *a = cmds; *a; a++) {
		if (!(*a)->alias_of || strcmp((*a)->alias_of, c->name))
			continue;
		printf("%s%s", any ? ", " : "Also: ", (*a)->name);
		any = true;
	}
	if (any)
		putchar('\n');
	if (c->help)
		printf("\n%s", c->help);
	puts("\nOptions:");
	for (const struct opt *o = opts; o->letter; o++)
		if (uses(c, o))
			print_opt(stdout, o);
	if (c->flags & CMD_ONE_MASTER)
		puts("\nWorks on one master; with several, -m selects it.");
	if (c->json)
		printf("\nJSON: %s\n", c->json);
}

static void json_opts(const struct cmd *c)
{
	out_array("options");
	for (const struct opt *o = opts; o->letter; o++) {
		char letter[2] = { o->letter };

		if (c && !uses(c, o))
			continue;
		out_object(NULL);
		out_str("long", o->name, NULL);
		if (opt_is_short(o))
			out_str("short", letter, NULL);
		if (o->arg)
			out_str("argument", o->arg, NULL);
		out_str("text", o->text, NULL);
		out_end();
	}
	out_end();
}

static void json_cmd(const struct cmd *c)
{
	out_object(NULL);
	out_str("name", c->name, NULL);
	out_array("also");
	for (const struct cmd *const *a = cmds; *a; a++)
		if ((*a)->alias_of && !strcmp((*a)->alias_of, c->name))
			out_str("", (*a)->name, NULL);
	out_end();
	out_str("arguments", c->args, NULL);
	out_str("summary", c->summary, NULL);
	out_str("text", c->help ? c->help : "", NULL);
	out_bool("one_master", c->flags & CMD_ONE_MASTER, NULL);
	out_str("json", c->json ? c->json : "", NULL);
	json_opts(c);
	out_end();
}

/* @c, or all commands and options when it is NULL */
void help_json(const struct cmd *c)
{
	out_array("commands");
	for (const struct cmd *const *i = cmds; *i; i++)
		if ((*i)->run && (!c || *i == c))
			json_cmd(*i);
	out_end();
	if (!c)
		json_opts(NULL);
}

static void roff(const char *s)
{
	if (*s == '.' || *s == '\'')
		fputs("\\&", stdout);
	for (; *s; s++) {
		if (*s == '\\')
			fputs("\\e", stdout);
		else if (*s == '-')
			fputs("\\-", stdout);
		else
			putchar(*s);
		if (*s == '\n' && (s[1] == '.' || s[1] == '\''))
			fputs("\\&", stdout);
	}
}

static void roff_opt(const struct opt *o)
{
	puts(".TP");
	if (!opt_is_short(o))
		printf(".B \\-\\-%s", o->name);
	else
		printf(".BR \\-%c \", \" \\-\\-", o->letter);
	if (opt_is_short(o))
		roff(o->name);
	if (o->arg)
		printf(" \" %s\"", o->arg);
	putchar('\n');
	roff(o->text);
	putchar('\n');
}

static void roff_cmd(const struct cmd *c)
{
	fputs(".SS ethercat ", stdout);
	roff(c->name);
	fputs(" [OPTIONS] ", stdout);
	roff(c->args);
	putchar('\n');
	roff(c->summary);
	puts(".");
	for (const struct cmd *const *a = cmds; *a; a++)
		if ((*a)->alias_of && !strcmp((*a)->alias_of, c->name))
			printf("Also called\n.BR %s .\n", (*a)->name);
	if (c->help) {
		puts(".PP\n.nf");
		roff(c->help);
		puts(".fi");
	}
	fputs(".PP\nOptions:", stdout);
	for (const struct opt *o = opts; o->letter; o++)
		if (uses(c, o))
			printf(" \\-\\-%s", o->letter == 'o' ? "output\\-file" : o->name);
	putchar('\n');
	if (c->json) {
		puts(".PP\nJSON:");
		roff(c->json);
		putchar('\n');
	}
}

static bool is_name_of(const struct cmd *a, const struct cmd *c)
{
	return a == c || (a->alias_of && !strcmp(a->alias_of, c->name));
}

static void roff_names(const struct cmd *c)
{
	puts(".SH NAME");
	for (const struct cmd *const *a = cmds; *a; a++) {
		if (!is_name_of(*a, c) || *a == c)
			continue;
		printf("ethercat\\-");
		roff((*a)->name);
		printf(", ");
	}
	printf("ethercat\\-");
	roff(c->name);
	printf(" \\- ");
	roff(c->summary);
	putchar('\n');
}

/* the man page of a command, which has the names of it all */
void help_roff_cmd(const struct cmd *c)
{
	puts(".\\\" SPDX-License-Identifier: GPL-2.0-only\n"
	     ".\\\" Made by 'make -C tool man' from the tables of the tool.");
	printf(".TH ETHERCAT\\-");
	for (const char *p = c->name; *p; p++)
		putchar(toupper((unsigned char)*p));
	puts(" 8 \"\" \"ethercat " EC_TOOL_VERSION "\"");
	roff_names(c);
	puts(".SH SYNOPSIS");
	for (const struct cmd *const *a = cmds; *a; a++) {
		if (!is_name_of(*a, c))
			continue;
		fputs(".B ethercat ", stdout);
		roff((*a)->name);
		printf("\n[OPTIONS] ");
		roff(c->args);
		puts("\n.br");
	}
	puts(".SH DESCRIPTION");
	roff(c->summary);
	puts(".");
	if (c->flags & CMD_ONE_MASTER)
		puts("Works on one master; with several,\n.B \\-m\nselects it.");
	if (c->help) {
		puts(".PP\n.nf");
		roff(c->help);
		puts(".fi");
	}
	puts(".SH OPTIONS");
	for (const struct opt *o = opts; o->letter; o++)
		if (uses(c, o))
			roff_opt(o);
	if (c->json) {
		puts(".SH JSON");
		roff(c->json);
		putchar('\n');
	}
	puts(".SH SEE ALSO\n.BR ethercat (8)\n"
	     "has the rules for numbers, lists, selection of slaves and exit status.");
}

/* the man page */
void help_roff(void)
{
	puts(".\\\" SPDX-License-Identifier: GPL-2.0-only\n"
	     ".\\\" Made by 'make -C tool man' from the tables of the tool.\n"
	     ".TH ETHERCAT 8 \"\" \"ethercat " EC_TOOL_VERSION "\"\n"
	     ".SH NAME\nethercat \\- inspect and control EtherCAT masters and their slaves\n"
	     ".SH SYNOPSIS\n.B ethercat\n.I COMMAND\n[OPTIONS] [ARGUMENTS]\n"
	     ".SH DESCRIPTION\n"
	     "Accesses the masters of this host through\n.IR /dev/EtherCAT0 ,\n"
	     ".I /dev/EtherCAT1\nand so on.\n"
	     "Options may be placed before or after the command and between its arguments.\n"
	     "Commands may be abbreviated if the abbreviation is unambiguous.\n"
	     "Commands that only show the state of the master need read access. Commands that cause\n"
	     "bus traffic or change something need write access.\n"
	     ".PP\nNumbers are decimal, 0x... hexadecimal or 0... octal; in lists decimal.\n"
	     "A list is one or more of N, N\\-M, N\\-, \\-M and \\-, separated by commas.\n"
	     ".SH OPTIONS");
	for (const struct opt *o = opts; o->letter; o++)
		roff_opt(o);
	puts(".SH SELECTION\n"
	     "Without options a command takes all slaves.\n.B \\-p\n"
	     "selects ring positions.\n.B \\-a\n"
	     "selects the slave with an alias and the slaves downstream up to the next slave with an\n"
	     "alias; with both,\n.B \\-p\nis relative to the slave with the alias.\n"
	     "Commands for a single slave refuse any other number of slaves.\n"
	     ".SH COMMANDS");
	for (const struct cmd *const *c = cmds; *c; c++)
		if ((*c)->run)
			roff_cmd(*c);
	puts(".SH DATA TYPES");
	for (unsigned int i = 0; i < ec_types_count; i++)
		printf("%s%s", i ? ", " : "", ec_types[i].name);
	puts(".\n.PP\nInteger types are printed as 0x and all hex digits, a blank, and decimal.\n"
	     ".SH JSON\nOne object on stdout. Keys are only ever added; units are part of the key.\n"
	     "Errors are one object on stderr: {\"error\": {\"command\", \"kind\" (usage or\n"
	     "runtime), \"message\", \"errno\", \"errno_text\", \"reason\", \"abort_code\",\n"
	     "\"abort_text\"}}.\n"
	     ".SH EXIT STATUS\n0: success; 1: failure; 2: --compare has found differences.\n"
	     ".SH FILES\n.I /dev/EtherCAT*\n.br\n"
	     ".I /etc/udev/rules.d/59\\-ethercat\\-*.rules\n.SH SEE ALSO");
	for (const struct cmd *const *c = cmds; *c; c++) {
		if (!(*c)->run)
			continue;
		printf(".BR ethercat\\-");
		roff((*c)->name);
		puts(" (8),");
	}
	puts(".BR dot (1)");
}
