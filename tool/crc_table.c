// SPDX-License-Identifier: GPL-2.0-only
#include "crc_table.h"

#include <stdio.h>
#include <string.h>

#include "out.h"

static void cell(const struct ect_slave *s, const struct ect_errors *e, unsigned int i)
{
	const struct ect_port *p = &s->ports[i];
	char next[8] = "   ";

	out_object(NULL);
	out_bool("loop_closed", p->loop_closed, NULL);
	out_u("crc_errors", err_rx(e, i), NULL);
	out_u("phy_errors", err_phy(e, i), NULL);
	out_u("forwarded_errors", err_fwd(e, i), NULL);
	out_u("lost_links", err_lost(e, i), NULL);
	if (p->next_slave == ECT_NONE16)
		out_null("next_slave", NULL);
	else
		out_u("next_slave", p->next_slave, NULL);
	out_end();
	if (p->next_slave + 1u == s->position)
		strcpy(next, "  \u2191");
	else if (p->next_slave == s->position + 1u)
		strcpy(next, "  \u2193");
	else if (p->next_slave != ECT_NONE16)
		snprintf(next, sizeof(next), "%3u", p->next_slave);
	if (p->loop_closed)
		out_text("%15s|", "");
	else
		out_text("%3u %3u %3u %s|", err_rx(e, i), err_phy(e, i), err_fwd(e, i),
			 next);
}

static void details(const struct ect_errors *e)
{
	out_text("    lost links: %u %u %u %u, processing unit errors: %u, PDI errors: %u\n",
		 err_lost(e, 0), err_lost(e, 1), err_lost(e, 2), err_lost(e, 3),
		 e->unit, e->pdi);
}

void crc_table_head(void)
{
	out_text("   |Port 0         |Port 1         |Port 2         |Port 3         |\n");
	out_text("   |CRC PHY FWD NXT|CRC PHY FWD NXT|CRC PHY FWD NXT|CRC PHY FWD NXT|\n");
}

/**
 * crc_table_row() - print the counters of a slave
 * @t: command line
 * @s: slave
 * @e: its counters
 */
void crc_table_row(const struct tool *t, const struct ect_slave *s, const struct ect_errors *e)
{
	char name[ECT_STRING];

	slave_name(s, name, sizeof(name));
	out_object(NULL);
	out_u("position", s->position, "%3u|", s->position);
	out_str("name", name, NULL);
	out_array("ports");
	for (unsigned int i = 0; i < ECT_PORTS; i++)
		cell(s, e, i);
	out_end();
	out_text("%.11s\n", name);
	out_u("processing_unit_errors", e->unit, NULL);
	out_u("pdi_errors", e->pdi, NULL);
	if (t->verbosity > 0)
		details(e);
	out_end();
}
