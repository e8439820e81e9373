// SPDX-License-Identifier: GPL-2.0-only
/* A slave in the form of its device description (ESI, ETG.2000). */
#include "esi_xml.h"

#include "../master/wire/sii.h"
#include "layout.h"

#define DC_MODES	16

struct xml {
	FILE *f;
	const struct ect_slave *s;
	const u8 *img;
	size_t size;
};

static void escaped(FILE *f, const char *s)
{
	for (; *s; s++)
		switch (*s) {
		case '&':
			fputs("&amp;", f);
			break;
		case '<':
			fputs("&lt;", f);
			break;
		case '>':
			fputs("&gt;", f);
			break;
		case '"':
			fputs("&quot;", f);
			break;
		default:
			fputc(*s, f);
		}
}

static void element(FILE *f, const char *indent, const char *name, const char *text)
{
	fprintf(f, "%s<%s>", indent, name);
	escaped(f, text);
	fprintf(f, "</%s>\n", name);
}

/* the end of the section must not be in it */
static void cdata(FILE *f, const char *indent, const char *name, const char *text)
{
	fprintf(f, "%s<%s><![CDATA[", indent, name);
	for (; *text; text++) {
		if (!strncmp(text, "]]>", 3))
			fputs("]]]]><![CDATA[", f);
		if (!strncmp(text, "]]>", 3))
			text += 2;
		fputc(*text, f);
	}
	fprintf(f, "]]></%s>\n", name);
}

static void data_type(FILE *f, unsigned int bits)
{
	fputs("            <DataType>", f);
	if (bits == 1)
		fputs("BOOL", f);
	else if (bits % 8)
		fprintf(f, "BIT%u", bits);
	else if (bits == 8)
		fputs("USINT", f);
	else if (bits == 16)
		fputs("UINT", f);
	else if (bits == 24 || bits == 40 || bits == 48 || bits == 56)
		fprintf(f, "UINT%u", bits);
	else if (bits == 32)
		fputs("UDINT", f);
	else if (bits == 64)
		fputs("ULINT", f);
	else
		fprintf(f, "ARRAY [0..%u] OF BYTE", bits / 8 - 1);
	fputs("</DataType>\n", f);
}

static void entry(FILE *f, const struct ect_pdo_entry *e)
{
	fputs("          <Entry>\n", f);
	fprintf(f, "            <Index>#x%04x</Index>\n", e->index);
	if (e->index)
		fprintf(f, "            <SubIndex>%u</SubIndex>\n", e->subindex);
	fprintf(f, "            <BitLen>%u</BitLen>\n", e->bits);
	if (e->index) {
		element(f, "            ", "Name", e->name);
		data_type(f, e->bits);
	}
	fputs("          </Entry>\n", f);
}

static void pdo(FILE *f, const struct layout_sm *sm, const struct layout_pdo *p)
{
	const char *kind = layout_is_output(sm) ? "RxPdo" : "TxPdo";

	fprintf(f, "        <%s Sm=\"%u\" Fixed=\"1\" Mandatory=\"1\">\n", kind, sm->sm.sm);
	fprintf(f, "          <Index>#x%04x</Index>\n", p->pdo.index);
	element(f, "          ", "Name", p->pdo.name);
	for (unsigned int i = 0; i < p->pdo.entry_count; i++)
		entry(f, &p->entries[i]);
	fprintf(f, "        </%s>\n", kind);
}

/* RxPDOs before TxPDOs, as the schema has them */
static void pdos(FILE *f, const struct layout *l)
{
	for (int outputs = 1; outputs >= 0; outputs--)
		for (unsigned int i = 0; i < l->n; i++)
			for (unsigned int k = 0; k < l->sms[i].sm.pdo_count; k++)
				if (layout_is_output(&l->sms[i]) == outputs)
					pdo(f, &l->sms[i], &l->sms[i].pdos[k]);
}

static void sms(FILE *f, const struct layout *l)
{
	for (unsigned int i = 0; i < l->n; i++) {
		const struct ect_sm *sm = &l->sms[i].sm;
		static const char * const types[] = {
			"", "MBoxOut", "MBoxIn", "Outputs", "Inputs"
		};

		fprintf(f, "        <Sm Enable=\"%u\" StartAddress=\"#x%04x\" ControlByte=\"#x%02x\" DefaultSize=\"%u\">%s</Sm>\n",
			sm->enable & 1, sm->start, sm->control, sm->default_size,
			types[sm->type < ARRAY_SIZE(types) ? sm->type : 0]);
	}
}

static bool flag(unsigned int bits, unsigned int bit)
{
	return bits & bit;
}

static void mailbox(const struct xml *x)
{
	unsigned int p = x->s->mbox_protocols, coe = x->s->coe_details;

	if (!p)
		return;
	fprintf(x->f, "        <Mailbox DataLinkLayer=\"%u\">\n",
		flag(x->s->general_flags, EC_SII_FLAG_MBOX_DLL));
	if (p & EC_SII_PROTO_AOE)
		fputs("          <AoE/>\n", x->f);
	if (p & EC_SII_PROTO_EOE)
		fputs("          <EoE/>\n", x->f);
	if (p & EC_SII_PROTO_COE)
		fprintf(x->f, "          <CoE SdoInfo=\"%u\" PdoAssign=\"%u\" PdoConfig=\"%u\" PdoUpload=\"%u\" CompleteAccess=\"%u\"/>\n",
			flag(coe, EC_SII_COE_SDO_INFO), flag(coe, EC_SII_COE_PDO_ASSIGN),
			flag(coe, EC_SII_COE_PDO_CONFIG), flag(coe, EC_SII_COE_PDO_UPLOAD),
			flag(coe, EC_SII_COE_COMPLETE));
	if (p & EC_SII_PROTO_FOE)
		fputs("          <FoE/>\n", x->f);
	if (p & EC_SII_PROTO_SOE)
		fputs("          <SoE/>\n", x->f);
	if (p & EC_SII_PROTO_VOE)
		fputs("          <VoE/>\n", x->f);
	fputs("        </Mailbox>\n", x->f);
}

static void name_of(const struct xml *x, u8 index, char *buf, size_t size)
{
	if (!index || ec_sii_string(x->img, x->size, index, buf, size) < 0)
		buf[0] = '\0';
}

static void clocks(const struct xml *x)
{
	struct ec_sii_dc dc[DC_MODES];
	int n = ec_sii_decode_dcs(x->img, x->size, dc, DC_MODES);
	char text[128];

	if (n <= 0)
		return;
	fputs("        <Dc>\n", x->f);
	for (int i = 0; i < min(n, DC_MODES); i++) {
		fputs("          <OpMode>\n", x->f);
		name_of(x, dc[i].name, text, sizeof(text));
		element(x->f, "            ", "Name", text);
		name_of(x, dc[i].desc, text, sizeof(text));
		if (*text)
			element(x->f, "            ", "Desc", text);
		fprintf(x->f, "            <AssignActivate>#x%04x</AssignActivate>\n",
			dc[i].assign);
		fprintf(x->f, "            <CycleTimeSync0 Factor=\"%d\">%u</CycleTimeSync0>\n",
			dc[i].factor0, dc[i].cycle0_ns);
		fprintf(x->f, "            <ShiftTimeSync0>%u</ShiftTimeSync0>\n",
			dc[i].shift0_ns);
		fprintf(x->f, "            <CycleTimeSync1 Factor=\"%d\">0</CycleTimeSync1>\n",
			dc[i].factor1);
		fprintf(x->f, "            <ShiftTimeSync1>%u</ShiftTimeSync1>\n",
			dc[i].shift1_ns);
		fputs("          </OpMode>\n", x->f);
	}
	fputs("        </Dc>\n", x->f);
}

static void hex(FILE *f, const char *name, const u8 *data, size_t n)
{
	fprintf(f, "          <%s>", name);
	for (size_t i = 0; i < n; i++)
		fprintf(f, "%02x", data[i]);
	fprintf(f, "</%s>\n", name);
}

static void eeprom(const struct xml *x)
{
	if (x->size < EC_SII_FIXED_SIZE)
		return;
	fputs("        <Eeprom>\n", x->f);
	fprintf(x->f, "          <ByteSize>%u</ByteSize>\n",
		(get_unaligned_le16(x->img + 2 * EC_SII_W_SIZE) + 1u) * 128);
	hex(x->f, "ConfigData", x->img, 2 * EC_SII_W_CHECKSUM);
	hex(x->f, "BootStrap", x->img + 2 * EC_SII_W_BOOT_MBOX, 8);
	fputs("        </Eeprom>\n", x->f);
}

/**
 * esi_xml() - write the description of a slave
 * @f: where
 * @s: slave
 * @l: its SyncManagers and PDOs, as the master knows them
 * @img: its EEPROM
 * @size: bytes at @img
 */
void esi_xml(FILE *f, const struct ect_slave *s, const struct layout *l, const u8 *img, size_t size)
{
	const struct xml x = { .f = f, .s = s, .img = img, .size = size };

	fputs("  <EtherCATInfo>\n    <Vendor>\n", f);
	fprintf(f, "      <Id>%u</Id>\n    </Vendor>\n", s->vendor_id);
	fputs("    <Descriptions>\n    <Devices>\n      <Device>\n", f);
	fprintf(f, "        <Type ProductCode=\"#x%08x\" RevisionNo=\"#x%08x\">", s->product_code,
		s->revision_number);
	escaped(f, s->order);
	fputs("</Type>\n", f);
	cdata(f, "        ", "Name", s->name);
	if (s->group[0])
		element(f, "        ", "GroupType", s->group);
	sms(f, l);
	pdos(f, l);
	mailbox(&x);
	clocks(&x);
	eeprom(&x);
	fputs("      </Device>\n    </Devices>\n    </Descriptions>\n  </EtherCATInfo>\n", f);
}
