// SPDX-License-Identifier: GPL-2.0-only
#include "sii_decode.h"

#include "../lib/tools/text.h"
#include "../master/wire/sii.h"
#include "out.h"

#define SMS_MAX		16
#define DC_MODES	16

static void sii_text(const u8 *img, size_t size, u8 index, char *buf, size_t room)
{
	if (!index || ec_sii_string(img, size, index, buf, room) < 0)
		buf[0] = '\0';
	string_clean(buf, room);
}

static void mailboxes(const char *key, const char *title, const struct ec_sii_mbox *m)
{
	out_object(key);
	out_u("rx_offset", m->rx_offset, "%s mailbox: master to slave 0x%04x", title, m->rx_offset);
	out_u("rx_size", m->rx_size, ", %u bytes", m->rx_size);
	out_u("tx_offset", m->tx_offset, ", slave to master 0x%04x", m->tx_offset);
	out_u("tx_size", m->tx_size, ", %u bytes\n", m->tx_size);
	out_end();
}

static void protocols(unsigned int bits)
{
	static const char * const names[] = { "AoE", "EoE", "CoE", "FoE", "SoE", "VoE" };

	out_u("protocols", bits, "Protocols:");
	for (size_t i = 0; i < ARRAY_SIZE(names); i++)
		if (bits & 1u << i)
			out_text(" %s", names[i]);
	out_text("%s\n", bits ? "" : " none");
}

static void fixed_area(const u8 *img, size_t size)
{
	struct ec_sii_info i;

	if (ec_sii_decode_info(img, size, &i)) {
		out_text("Fixed area: incomplete, %zu of %u bytes\n", size, EC_SII_FIXED_SIZE);
		return;
	}
	out_u("vendor_id", i.vendor, "Vendor Id:       0x%08x\n", i.vendor);
	out_u("product_code", i.product, "Product code:    0x%08x\n", i.product);
	out_u("revision_number", i.revision, "Revision number: 0x%08x\n", i.revision);
	out_u("serial_number", i.serial, "Serial number:   0x%08x\n", i.serial);
	out_u("alias", i.alias, "Alias:           %u\n", i.alias);
	out_bool("checksum_ok", i.checksum_ok, NULL);
	out_u("checksum", i.checksum, "Checksum:        0x%02x", i.checksum);
	if (i.checksum_ok)
		out_text(", right\n");
	else
		out_text(", wrong, expected 0x%02x\n", i.checksum_calc);
	out_u("pdi_control", i.pdi_control, "PDI control:     0x%04x", i.pdi_control);
	out_u("pdi_config", i.pdi_config, ", configuration 0x%04x", i.pdi_config);
	out_u("pdi_config_2", i.pdi_config2, " 0x%04x\n", i.pdi_config2);
	out_u("sync_impulse_ns", 10u * i.sync_impulse, "SYNC impulse:    %u ns\n",
	      10u * i.sync_impulse);
	mailboxes("mailbox", "Standard", &i.std);
	mailboxes("bootstrap_mailbox", "Bootstrap", &i.boot);
	protocols(i.protocols);
	out_u("declared_bytes", 128u * i.size_kbit, "EEPROM size:     %u bytes",
	      128u * i.size_kbit);
	out_text(", image %zu\n", size);
}

static void general(const u8 *img, size_t size)
{
	struct ec_sii_general g;
	char text[256];

	if (ec_sii_decode_general(img, size, &g))
		return;
	sii_text(img, size, g.group, text, sizeof(text));
	out_str("group", text, *text ? "Group:           %s\n" : NULL, text);
	sii_text(img, size, g.order, text, sizeof(text));
	out_str("order_number", text, *text ? "Order number:    %s\n" : NULL, text);
	sii_text(img, size, g.name, text, sizeof(text));
	out_str("name", text, *text ? "Name:            %s\n" : NULL, text);
	out_u("coe_details", g.coe, "CoE details:     0x%02x\n", g.coe);
	out_u("general_flags", g.flags, "Flags:           0x%02x\n", g.flags);
	out_i("current_ma", g.current_ma, "E-bus current:   %d mA\n", g.current_ma);
	out_u("port_types", g.ports, "Port types:      0x%04x\n", g.ports);
}

static void sync_managers(const u8 *img, size_t size)
{
	static const char * const types[] = {
		"unused", "mailbox out", "mailbox in", "outputs", "inputs"
	};
	struct ec_sii_sm sm[SMS_MAX];
	int n = ec_sii_decode_sms(img, size, sm, SMS_MAX);

	out_array("sync_managers");
	for (int i = 0; i < min(n, SMS_MAX); i++) {
		const char *type = sm[i].type < ARRAY_SIZE(types) ? types[sm[i].type] : "unknown";

		out_object(NULL);
		out_u("index", (u64)i, "SM%d:", i);
		out_u("start", sm[i].start, " 0x%04x", sm[i].start);
		out_u("size_bytes", sm[i].len, ", %u bytes", sm[i].len);
		out_u("control", sm[i].control, ", control 0x%02x", sm[i].control);
		out_u("enable", sm[i].enable, ", enable 0x%02x", sm[i].enable);
		out_str("type", type, ", %s\n", type);
		out_end();
	}
	out_end();
}

static void pdos_of(const u8 *img, size_t size, u16 type)
{
	const char *kind = type == EC_SII_CAT_RXPDO ? "RxPDO" : "TxPDO";
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo p;
	char text[256];

	ec_sii_pdo_iter_init(&it, img, size, type);
	while (ec_sii_pdo_iter_next(&it, &p) > 0) {
		sii_text(img, size, p.name, text, sizeof(text));
		out_object(NULL);
		out_str("kind", kind, "%s", kind);
		out_u("index", p.index, " 0x%04x", p.index);
		out_str("name", text, " \"%s\"", text);
		out_u("sync_manager", p.sm, p.sm == EC_SII_PDO_NO_SM ? NULL : ", SM%u", p.sm);
		out_text("\n");
		out_array("entries");
		for (unsigned int i = 0; i < p.entries; i++) {
			struct ec_sii_pdo_entry e;

			if (ec_sii_pdo_entry(&p, i, &e))
				break;
			sii_text(img, size, e.name, text, sizeof(text));
			out_object(NULL);
			out_u("index", e.index, "  0x%04x", e.index);
			out_u("subindex", e.sub, ":%02x", e.sub);
			out_u("size_bits", e.bits, ", %u bit", e.bits);
			out_u("type", e.type, ", type 0x%02x", e.type);
			out_str("name", text, ", \"%s\"\n", text);
			out_end();
		}
		out_end();
		out_end();
	}
}

static void clock_modes(const u8 *img, size_t size)
{
	struct ec_sii_dc dc[DC_MODES];
	int n = ec_sii_decode_dcs(img, size, dc, DC_MODES);
	char text[256];

	out_array("dc_modes");
	for (int i = 0; i < min(n, DC_MODES); i++) {
		sii_text(img, size, dc[i].name, text, sizeof(text));
		out_object(NULL);
		out_str("name", text, "DC mode \"%s\":", text);
		out_u("assign_activate", dc[i].assign, " AssignActivate 0x%04x", dc[i].assign);
		out_u("sync0_cycle_ns", dc[i].cycle0_ns, ", SYNC0 cycle %u ns", dc[i].cycle0_ns);
		out_i("sync0_factor", dc[i].factor0, ", factor %d", dc[i].factor0);
		out_u("sync0_shift_ns", dc[i].shift0_ns, ", shift %u ns", dc[i].shift0_ns);
		out_i("sync1_factor", dc[i].factor1, ", SYNC1 factor %d", dc[i].factor1);
		out_u("sync1_shift_ns", dc[i].shift1_ns, ", shift %u ns\n", dc[i].shift1_ns);
		out_end();
	}
	out_end();
}

/**
 * sii_decode() - print what an EEPROM image says
 * @img: image
 * @size: bytes at @img
 */
void sii_decode(const u8 *img, size_t size)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	int ret;

	fixed_area(img, size);
	general(img, size);
	sync_managers(img, size);
	out_array("pdos");
	pdos_of(img, size, EC_SII_CAT_RXPDO);
	pdos_of(img, size, EC_SII_CAT_TXPDO);
	out_end();
	clock_modes(img, size);
	ec_sii_iter_init(&it, img, size);
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1)
		;
	out_bool("complete", !ret, NULL);
	if (ret)
		out_text("The list of categories is damaged at byte 0x%zx\n", it.pos);
}
