// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdlib.h>

#include "../master/wire/sii.h"
#include "dev.h"
#include "io.h"
#include "out.h"
#include "sii_decode.h"
#include "sii_image.h"

static const char *category_name(unsigned int type)
{
	switch (type) {
	case EC_SII_CAT_STRINGS:
		return "STRINGS";
	case EC_SII_CAT_DATA_TYPES:
		return "DataTypes";
	case EC_SII_CAT_GENERAL:
		return "General";
	case EC_SII_CAT_FMMU:
		return "FMMU";
	case EC_SII_CAT_SM:
		return "SyncM";
	case EC_SII_CAT_TXPDO:
		return "TXPDO";
	case EC_SII_CAT_RXPDO:
		return "RXPDO";
	case EC_SII_CAT_DC:
		return "DC";
	default:
		return "unknown";
	}
}

static void categories(const u8 *img, size_t size)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	out_array("categories");
	ec_sii_iter_init(&it, img, size);
	while (ec_sii_iter_next(&it, &cat) == 1) {
		out_object(NULL);
		out_u("type", cat.type, "SII Category 0x%04x", cat.type);
		out_str("name", category_name(cat.type), " (%s)", category_name(cat.type));
		out_u("size_words", cat.words, ", %u words\n", cat.words);
		out_hex("data_hex", cat.data, cat.bytes, "  ");
		out_end();
	}
	out_end();
	out_bool("complete", !it.end, NULL);
	if (it.end)
		note("warning: the category list is damaged at byte 0x%zx", it.pos);
}

static void decoded(const u8 *img, size_t size)
{
	struct ec_sii_info i;

	if (ec_sii_decode_info(img, size, &i))
		return;
	out_bool("checksum_ok", i.checksum_ok, NULL);
	out_u("alias", i.alias, NULL);
	out_u("vendor_id", i.vendor, NULL);
	out_u("product_code", i.product, NULL);
	out_u("revision_number", i.revision, NULL);
	out_u("serial_number", i.serial, NULL);
	if (!i.checksum_ok)
		note("warning: checksum 0x%02x, expected 0x%02x", i.checksum,
		     i.checksum_calc);
}

static void show(const struct tool *t, const u8 *img, size_t size)
{
	if (t->decode || (t->file && t->verbosity <= 0)) {
		sii_decode(img, size);
		return;
	}
	if (t->verbosity <= 0) {
		out_binary("data_hex", img, size);
		return;
	}
	out_text("SII Area:\n");
	out_hex("fixed_area_hex", img, min(size, (size_t)EC_SII_FIXED_SIZE), "  ");
	decoded(img, size);
	if (size > EC_SII_FIXED_SIZE)
		categories(img, size);
}

static int saved(const struct tool *t)
{
	size_t size;
	u8 *img;

	if (t->positions.given || t->aliases.given)
		return usage_error("--file needs no slave: leave out --position and --alias");
	if (io_read(t->file, &img, &size))
		return 1;
	out_u("size_bytes", size, NULL);
	show(t, img, size);
	free(img);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct ect_slave s;
	struct dev d;
	size_t size;
	u8 *img = NULL;
	int ret;

	(void)argc, (void)argv;
	if (t->file)
		return saved(t);
	if (t->verbosity <= 0 && !t->decode &&
	    out_binary_allowed("use --verbose, --json, or a file: ethercat sii_read -p0 > FILE"))
		return 1;
	if (dev_open_single(&d, t, false))
		return 1;
	ret = dev_select_single(&d, t, &s) || sii_load(&d, &s, &img, &size);
	if (!ret && !size) {
		ret = fail("Master%u slave %u: the SII has not been read%s%s", d.master, s.position,
			   s.why[0] ? ": " : "", s.why);
		free(img);
	} else if (!ret) {
		out_u("master", d.master, NULL);
		out_u("position", s.position, NULL);
		out_u("size_bytes", size, NULL);
		show(t, img, size);
		free(img);
	}
	dev_close(&d);
	return ret;
}

const struct cmd cmd_sii_read = {
	.name = "sii_read",
	.run = run,
	.args = "",
	.opts = "mapvix",
	.summary = "Write the EEPROM image of a slave to stdout",
	.help = "Binary, as read by the last bus scan, not to a terminal:\n"
		"ethercat sii_read -p2 > backup.bin\n"
		"--verbose prints hex bytes for each category, --decode what they mean. With --file it is\n"
		"the image of a file that is decoded, without a master.\n",
	.json = "master, position, size_bytes, data_hex; with --verbose instead of data_hex:\n"
		"fixed_area_hex, checksum_ok, alias, vendor_id, product_code, revision_number,\n"
		"serial_number, categories[] (type, name, size_words, data_hex), complete;\n"
		"with --decode or --file: vendor_id, product_code, revision_number, serial_number, alias,\n"
		"checksum_ok, checksum, pdi_control, pdi_config, pdi_config_2, sync_impulse_ns, mailbox and\n"
		"bootstrap_mailbox (rx_offset, rx_size, tx_offset, tx_size), protocols, declared_bytes, group,\n"
		"order_number, name, coe_details, general_flags, current_ma, port_types, sync_managers[]\n"
		"(index, start, size_bytes, control, enable, type), pdos[] (kind, index, name, sync_manager,\n"
		"entries[]: index, subindex, size_bits, type, name), dc_modes[] (name, assign_activate,\n"
		"sync0_cycle_ns, sync0_factor, sync0_shift_ns, sync1_factor, sync1_shift_ns), complete",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
};
