// SPDX-License-Identifier: GPL-2.0-only
/* Everything about one slave: the block of 'slaves -v' and the JSON object. */
#include "slave_info.h"

#include <stdio.h>

#include "../master/wire/al.h"
#include "../master/wire/sii.h"
#include "out.h"

static const char *yes(bool v)
{
	return v ? "yes" : "no";
}

bool slave_has_dc(const struct ect_slave *s)
{
	return s->dc_supported || s->dc_delay_only;
}

const char *port_type_text(unsigned int type)
{
	static const char *const text[] = { "N/A", "N/C", "EBUS", "MII" };

	return text[type & 3];
}

static void identity(const struct ect_slave *s)
{
	out_text("Identity:\n");
	out_u("vendor_id", s->vendor_id, "  Vendor Id:       0x%08x\n", s->vendor_id);
	out_u("product_code", s->product_code, "  Product code:    0x%08x\n", s->product_code);
	out_u("revision_number", s->revision_number, "  Revision number: 0x%08x\n",
	      s->revision_number);
	out_u("serial_number", s->serial_number, "  Serial number:   0x%08x\n", s->serial_number);
}

static void data_link(const struct ect_slave *s)
{
	static const char *const key[] = { "none", "32 bit", "64 bit", "delay measurement only" };
	static const char *const text[] = { "no", "yes, 32 bit", "yes, 64 bit",
					    "yes, delay measurement only" };
	unsigned int dc = s->dc_delay_only ? 3 : min(s->dc_supported, 2);

	out_text("DL information:\n");
	out_bool("fmmu_bit_operation", s->fmmu_bit, "  FMMU bit operation: %s\n",
		 yes(s->fmmu_bit));
	out_str("dc", key[dc], "  Distributed clocks: %s\n", text[dc]);
	if (dc)
		out_u("dc_delay_ns", s->transmission_delay,
		      "  DC system time transmission delay: %u ns\n", s->transmission_delay);
	if (dc && dc < 3) {
		bool off = s->dc_diff > ECT_DC_WINDOW || s->dc_diff < -ECT_DC_WINDOW;
		unsigned int state = s->dc_odd ? 3 : !s->dc_set ? 0 : off ? 2 : 1;
		static const char *const word[] = { "not_set", "in_step", "off",
						    "delay_uncertain" };
		static const char *const line[] = { "", "synchronized", "outside window (1000 ns)",
			"delay unreliable, receive times contradict the topology" };

		out_str("dc_state", word[state], NULL);
		if (state)
			out_text("  DC state: %s\n", line[state]);
	}
	if (s->dc_set) {
		out_i("dc_offset_ns", (s64)s->dc_offset, "  DC system time offset: %lld ns\n",
		      (long long)s->dc_offset);
		out_i("dc_difference_ns", s->dc_diff,
		      "  DC difference to the reference clock: %d ns\n", s->dc_diff);
	}
}

/* usually port 0; what a closed one has latched is old */
static const struct ect_port *first_open(const struct ect_slave *s)
{
	unsigned int i;

	for (i = 0; i < ECT_PORTS - 1 && s->ports[i].loop_closed; i++)
		;
	return &s->ports[i];
}

static void port(const struct ect_slave *s, unsigned int i)
{
	const struct ect_port *p = &s->ports[i];
	s32 diff = (s32)(p->receive_time - first_open(s)->receive_time);
	bool open = !p->loop_closed;

	out_object(NULL);
	out_str("type", port_type_text(p->type), "%4u  %-4s", i, port_type_text(p->type));
	out_bool("link_up", p->link_up, "  %-4s", p->link_up ? "up" : "down");
	out_bool("loop_closed", p->loop_closed, "  %-6s", open ? "open" : "closed");
	out_bool("signal", p->signal, "  %-6s", yes(p->signal));
	if (p->next_slave != ECT_NONE16)
		out_u("next_slave", p->next_slave, "  %9u", p->next_slave);
	else
		out_null("next_slave", "  %9s", "-");
	if (slave_has_dc(s) && open) {
		out_u("receive_time_ns", p->receive_time, "  %11u", p->receive_time);
		out_i("receive_time_diff_ns", diff, "  %10d", diff);
		out_u("delay_to_next_dc_ns", p->delay_to_next_dc, "  %10u", p->delay_to_next_dc);
	} else if (slave_has_dc(s)) {
		out_text("  %11s  %10s  %10s", "-", "-", "-");
	}
	out_text("\n");
	out_end();
}

static void ports(const struct ect_slave *s)
{
	out_text("Port  Type  Link  Loop    Signal  NextSlave%s\n",
		 slave_has_dc(s) ? "  RxTime [ns]  Diff [ns]   NextDc [ns]" : "");
	out_array("ports");
	for (unsigned int i = 0; i < ECT_PORTS; i++)
		port(s, i);
	out_end();
}

static void mailboxes(const struct ect_slave *s)
{
	static const char *const name[] = { "AoE", "EoE", "CoE", "FoE", "SoE", "VoE" };
	const char *sep = "";

	if (!s->mbox_protocols && !s->std_rx_size)
		return;
	out_object("mailboxes");
	out_text("Mailboxes:\n");
	out_text("  Bootstrap RX: 0x%04x/%u, TX: 0x%04x/%u\n", s->boot_rx_offset, s->boot_rx_size,
		 s->boot_tx_offset, s->boot_tx_size);
	out_text("  Standard  RX: 0x%04x/%u, TX: 0x%04x/%u\n", s->std_rx_offset, s->std_rx_size,
		 s->std_tx_offset, s->std_tx_size);
	out_u("bootstrap_rx_offset", s->boot_rx_offset, NULL);
	out_u("bootstrap_rx_size", s->boot_rx_size, NULL);
	out_u("bootstrap_tx_offset", s->boot_tx_offset, NULL);
	out_u("bootstrap_tx_size", s->boot_tx_size, NULL);
	out_u("standard_rx_offset", s->std_rx_offset, NULL);
	out_u("standard_rx_size", s->std_rx_size, NULL);
	out_u("standard_tx_offset", s->std_tx_offset, NULL);
	out_u("standard_tx_size", s->std_tx_size, NULL);
	out_array("protocols");
	out_text("  Supported protocols: ");
	for (unsigned int i = 0; i < ARRAY_SIZE(name); i++) {
		if (!(s->mbox_protocols & BIT(i)))
			continue;
		out_str("", name[i], "%s%s", sep, name[i]);
		sep = ", ";
	}
	out_text("\n");
	out_end();
	out_end();
}

static void coe_details(unsigned int bits)
{
	static const struct {
		const char *key, *text;
	} d[] = {
		{ "sdo", "Enable SDO" },
		{ "sdo_info", "Enable SDO Info" },
		{ "pdo_assign", "Enable PDO Assign" },
		{ "pdo_configuration", "Enable PDO Configuration" },
		{ "upload_at_startup", "Enable Upload at startup" },
		{ "sdo_complete_access", "Enable SDO complete access" },
	};

	out_object("coe_details");
	out_text("  CoE details:\n");
	for (unsigned int i = 0; i < ARRAY_SIZE(d); i++)
		out_bool(d[i].key, bits & BIT(i), "    %s: %s\n", d[i].text, yes(bits & BIT(i)));
	out_end();
}

static void general(const struct ect_slave *s)
{
	bool safeop = s->general_flags & EC_SII_FLAG_SAFEOP;
	bool no_lrw = s->general_flags & EC_SII_FLAG_NO_LRW;

	if (!s->has_general)
		return;
	out_object("general");
	out_text("General:\n");
	out_str("group", s->group, "  Group: %s\n", s->group);
	out_str("image", s->image, "  Image name: %s\n", s->image);
	out_str("order_number", s->order, "  Order number: %s\n", s->order);
	out_str("device_name", s->name, "  Device name: %s\n", s->name);
	if (s->mbox_protocols & EC_SII_PROTO_COE)
		coe_details(s->coe_details);
	out_object("flags");
	out_text("  Flags:\n");
	out_bool("safeop", safeop, "    Enable SafeOp: %s\n", yes(safeop));
	out_bool("no_lrw", no_lrw, "    Enable notLRW: %s\n", yes(no_lrw));
	out_end();
	out_i("current_ma", s->current_ma, "  Current consumption: %d mA\n", s->current_ma);
	out_end();
}

/* lines that the historic output does not have, after all of its lines */
static void diagnosis(const struct ect_slave *s)
{
	out_text("Diagnosis:\n");
	out_u("station_address", s->station, "  Station address: 0x%04x\n", s->station);
	out_u("own_alias", s->alias, NULL);
	out_u("identification", s->identification, NULL);
	if (s->identification)
		out_text("  Identification: %u\n", s->identification);
	out_u("al_status", s->al_status, "  AL status: 0x%04x\n", s->al_status);
	out_u("al_status_code", s->al_code, "  AL status code: 0x%04x (%s)\n", s->al_code,
	      ec_al_code_text(s->al_code));
	out_str("al_status_text", ec_al_code_text(s->al_code), NULL);
	out_str("requested_state", ec_al_state_name(s->al_requested), "  Requested state: %s\n",
		ec_al_state_name(s->al_requested));
	out_u("dl_status", s->dl_status, "  DL status: 0x%04x\n", s->dl_status);
	out_u("sync_managers", s->sm_count, "  SyncManagers: %u", s->sm_count);
	out_u("fmmus", s->fmmu_count, ", FMMUs: %u\n", s->fmmu_count);
	out_u("sii_words", s->sii_words, "  SII size: %u words\n", s->sii_words);
	if (s->why[0])
		out_text("  Cause: %s\n", s->why);
	out_str("cause", s->why, NULL);
	if (s->warning[0])
		out_text("  Warning: %s\n", s->warning);
	out_str("warning", s->warning, NULL);
}

char slave_flag(const struct ect_slave *s)
{
	return s->error ? 'E' : s->differs ? '!' : '+';
}

/* The text of config -v. */
static void reason(struct dev *d, const struct ect_slave *s)
{
	char text[ECT_TEXT] = "";

	if (s->config)
		dev_config_why(d, s->config - 1, text, sizeof(text));
	out_bool("differs", s->differs, NULL);
	if (text[0])
		out_str("not_in_op", text, "  Not in OP: %s\n", text);
	else
		out_null("not_in_op", NULL);
}

static bool is_lost(const struct ect_slave *s)
{
	return s->cause.kind == ECT_CAUSE_SILENT;
}

/* a slave that was lost has no AL state */
void slave_state_text(const struct ect_slave *s, char *buf, size_t size)
{
	if (is_lost(s))
		snprintf(buf, size, "LOST");
	else
		al_state_text(s->al_status, buf, size);
}

void slave_info(struct dev *d, const struct ect_slave *s)
{
	char state[16], name[ECT_STRING];

	slave_state_text(s, state, sizeof(state));
	slave_name(s, name, sizeof(name));
	out_object(NULL);
	out_u("position", s->position, "=== Master %u, Slave %u ===\n", d->master, s->position);
	out_u("device_number", s->device, NULL);
	out_u("alias", s->alias_group, NULL);
	out_u("relative_position", slave_alias_pos(s), NULL);
	out_str("name", name, NULL);
	if (s->alias)
		out_text("Alias: %u\n", s->alias);
	out_str("device", s->device_index ? "backup" : "main", "Device: %s\n",
		s->device_index ? "Backup" : "Main");
	out_str("state", is_lost(s) ? state : ec_al_state_name((u8)s->al_status), "State: %s\n",
		state);
	out_bool("al_error", s->al_status & EC_AL_ERROR, NULL);
	out_bool("flag_error", s->error, "Flag: %c\n", slave_flag(s));
	identity(s);
	data_link(s);
	ports(s);
	mailboxes(s);
	general(s);
	diagnosis(s);
	reason(d, s);
	out_text("\n");
	out_end();
}
