// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "esi_xml.h"
#include "out.h"
#include "sii_image.h"

static int one(struct dev *d, const struct ect_slave *s)
{
	size_t size = 0, n = 0;
	char *text = NULL;
	u8 *img = NULL;
	struct layout l;
	FILE *f;

	if (sii_load(d, s, &img, &size))
		return 1;
	if (layout_read(d, s, &l)) {
		free(img);
		return 1;
	}
	f = open_memstream(&text, &n);
	if (f) {
		esi_xml(f, s, &l, img, size);
		fclose(f);
		out_object(NULL);
		out_u("position", s->position, NULL);
		out_str("xml", text, "%s", text);
		out_end();
	}
	layout_free(&l);
	free(img);
	free(text);
	return f ? 0 : fail("out of memory");
}

static int run(struct tool *t, int argc, char **argv)
{
	struct slaves sel;
	struct dev d;
	int ret;

	(void)argc, (void)argv;
	if (dev_open_single(&d, t, false))
		return 1;
	ret = dev_select(&d, t, &sel, NULL);
	if (!ret && !sel.n)
		ret = list_all(&t->aliases) && list_all(&t->positions) ? dev_none_present(&d) :
									  dev_nothing_selected();
	if (!ret) {
		out_u("master", d.master, NULL);
		out_array("slaves");
		out_text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
		out_text(sel.n > 1 ? "<EtherCATInfoList>\n" : "");
		for (size_t i = 0; i < sel.n && !ret; i++)
			ret = one(&d, &sel.v[i]);
		out_text(sel.n > 1 ? "</EtherCATInfoList>\n" : "");
		out_end();
		slaves_free(&sel);
	}
	dev_close(&d);
	return ret;
}

const struct cmd cmd_xml = {
	.name = "xml",
	.run = run,
	.args = "",
	.opts = "map",
	.summary = "Print a description of slaves in the form of ESI",
	.help = "From the EEPROM, and PDOs as the master knows them, also those read over CoE. Data types\n"
		"are those of the length: the EEPROM has none, or the master does not keep them. Several\n"
		"slaves are in an EtherCATInfoList.\n",
	.json = "master, slaves[] (position, xml)",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
};
