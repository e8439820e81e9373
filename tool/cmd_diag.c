// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/sii.h"
#include "diag_text.h"
#include "dict.h"
#include "out.h"
#include "sdo.h"

#define ROOM		4096	/* bytes of a message; ETG.1020 has less */
#define MAX_MESSAGES	250	/* subindexes from 6 to 255 */

/* the history of one slave */
struct history {
	const struct esi_texts *texts;
	struct dev *d;
	const struct ect_slave *s;
	unsigned int max;
	unsigned int newest;
	unsigned int ack;
	unsigned int flags;
	unsigned int n;		/* messages */
	u8 subs[MAX_MESSAGES];	/* where they are, the newest first */
	u8 buf[ROOM + 1];
};

struct seen {
	struct esi_texts texts;
	bool any;
};

static int read_sub(struct history *h, u8 sub, size_t *size, u32 *abort)
{
	long n = ect_sdo_upload(h->d->h, h->s->device, EC_DIAG_INDEX, sub, 0, 0, h->buf, ROOM);

	*size = n < 0 ? 0 : (size_t)n;
	*abort = n < 0 ? ect_error_code(h->d->h) : 0;
	return n < 0 ? (int)n : 0;
}

static int failed(struct history *h, int err, u32 abort, u8 sub)
{
	if (abort)
		return fail_full(-err, NULL, abort, "Master%u slave %u: SDO upload 0x%04x:%02x",
				 h->d->master, h->s->position, EC_DIAG_INDEX, sub);
	return dev_fail(h->d, err, "Master%u slave %u: SDO upload 0x%04x:%02x", h->d->master,
			h->s->position, EC_DIAG_INDEX, sub);
}

/* a number; @optional: 0 where the slave has none */
static int read_number(struct history *h, u8 sub, bool optional, unsigned int *v)
{
	size_t size;
	u32 abort;
	int err = read_sub(h, sub, &size, &abort);

	*v = 0;
	if (err && abort && optional)
		return 0;
	if (err)
		return failed(h, err, abort, sub);
	*v = (unsigned int)value_unsigned(h->buf, min(size, (size_t)2));
	return 0;
}

/* 0, 1 after an error, 2: the slave has no history */
static int read_head(struct history *h)
{
	size_t size;
	u32 abort;
	int err = read_sub(h, EC_DIAG_SUB_MAX, &size, &abort);

	if (err && (abort == SDO_NO_OBJECT || abort == SDO_NO_SUBINDEX))
		return 2;
	if (err)
		return failed(h, err, abort, EC_DIAG_SUB_MAX);
	h->max = size ? h->buf[0] : 0;
	if (read_number(h, EC_DIAG_SUB_NEWEST, false, &h->newest) ||
	    read_number(h, EC_DIAG_SUB_ACK, true, &h->ack) ||
	    read_number(h, EC_DIAG_SUB_FLAGS, true, &h->flags))
		return 1;
	h->max = min(h->max, (unsigned int)MAX_MESSAGES);
	if (h->newest && (h->newest < EC_DIAG_FIRST_SUB ||
			  h->newest >= EC_DIAG_FIRST_SUB + h->max))
		return fail("Master%u slave %u: newest diagnosis message 0x%04x:%02x is inconsistent with a history of %u message(s)",
			    h->d->master, h->s->position, EC_DIAG_INDEX, h->newest, h->max);
	return 0;
}

/* From the newest back to an empty one; the messages are a ring. */
static int find_messages(struct history *h)
{
	unsigned int sub = h->newest;

	while (h->newest && h->n < h->max) {
		struct ec_diag_msg m;
		size_t size;
		u32 abort;
		int err = read_sub(h, (u8)sub, &size, &abort);

		if (err && abort != SDO_NO_SUBINDEX)
			return failed(h, err, abort, (u8)sub);
		if (err || ec_diag_msg_decode(h->buf, size, &m) == -ENOMSG)
			break;
		h->subs[h->n++] = (u8)sub;
		sub = sub > EC_DIAG_FIRST_SUB ? sub - 1 : EC_DIAG_FIRST_SUB + h->max - 1;
	}
	return 0;
}

/* not acknowledged */
static bool is_new(const struct history *h, unsigned int k)
{
	for (unsigned int i = 0; i <= k; i++)
		if (h->subs[i] == h->ack)
			return false;
	return true;
}

static void params(const struct history *h, struct ec_diag_msg m, bool text)
{
	struct ec_diag_param p;
	int ret;

	out_array("parameters");
	while ((ret = ec_diag_param_decode(&m, &p)) == 1) {
		char *v = diag_param_text(&p, h->texts), type[32] = "text";

		if (p.kind == EC_DIAG_VALUE)
			dict_type_text(p.type, type, sizeof(type));
		else if (p.kind == EC_DIAG_BYTES)
			snprintf(type, sizeof(type), "bytes");
		out_object(NULL);
		out_str("type", type, NULL);
		if (text)
			out_text(", %s", v ? v : "?");
		out_str("value", v ? v : "", NULL);
		out_hex(out_is_json() ? "data_hex" : NULL, out_is_json() ? p.data : NULL,
			out_is_json() ? p.size : 0, "");
		out_end();
		free(v);
	}
	out_end();
	if (ret < 0)
		out_bool("invalid_parameters", true, " (more parameters are invalid)");
}

static void message(struct history *h, unsigned int k, size_t size)
{
	const char *known;
	struct ec_diag_msg m;
	char when[48], *text;

	out_object(NULL);
	out_u("subindex", h->subs[k], "%4u  0x%04x:%02x", h->s->position, EC_DIAG_INDEX,
	      h->subs[k]);
	out_bool("new", is_new(h, k), is_new(h, k) ? " *  " : "    ");
	if (ec_diag_msg_decode(h->buf, size, &m)) {
		out_bool("invalid", true, "invalid message of %zu byte(s), expected at least %u\n",
			 size, EC_DIAG_HDR);
		out_end();
		return;
	}
	diag_time_text(m.time_ns, when, sizeof(when));
	known = esi_text(h->texts, m.text_id);
	text = known ? diag_substitute(known, m, h->texts) : NULL;
	out_u("time_ns", m.time_ns, "%s  ", when);
	out_str("severity", diag_severity(m.flags), "%-7s  ", diag_severity(m.flags));
	out_u("code", m.code, "0x%08x  ", m.code);
	out_u("flags", m.flags, NULL);
	out_u("text_id", m.text_id, NULL);
	if (text)
		out_str("text", text, "%s", text);
	else
		out_text("text 0x%04x", m.text_id);
	params(h, m, !text);
	out_text("\n");
	out_end();
	free(text);
}

static int messages(struct history *h)
{
	/* the oldest first, as in a log */
	for (unsigned int k = h->n; k--;) {
		size_t size;
		u32 abort;
		int err = read_sub(h, h->subs[k], &size, &abort);

		if (err)
			return failed(h, err, abort, h->subs[k]);
		message(h, k, size);
	}
	return 0;
}

/* --acknowledge, --reset: what was shown */
static int finish(const struct tool *t, struct history *h)
{
	const struct sdo_addr a = {
		.index = EC_DIAG_INDEX, .sub = EC_DIAG_SUB_ACK, .text = "0x10f3:03",
	};
	u8 value = t->reset ? 0 : (u8)h->newest;

	if (!h->newest || !(t->reset || t->acknowledge))
		return 0;
	return sdo_download(h->d, h->s, &a, 0, &value, 1);
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ect_slave *s, bool several)
{
	struct seen *seen = w->ctx;
	struct history *h = calloc(1, sizeof(*h));
	int ret;

	(void)several;
	if (!h)
		return fail("out of memory");
	h->texts = &seen->texts;
	h->d = d;
	h->s = s;
	ret = read_head(h);
	if (ret == 2) {
		free(h);
		return 0;
	}
	seen->any = true;
	if (!ret) {
		out_object(NULL);
		out_u("position", s->position, NULL);
		out_u("max_messages", h->max, NULL);
		out_u("newest", h->newest, NULL);
		out_u("acknowledged", h->ack, NULL);
		out_u("flags", h->flags, NULL);
		if (h->flags & 0x20)
			out_text("%4u  older messages were overwritten or discarded\n",
				 s->position);
		if (!h->newest)
			out_text("%4u  no messages\n", s->position);
		out_array("messages");
		ret = find_messages(h) || messages(h);
		out_end();
		out_end();
	}
	if (!ret)
		ret = finish(t, h);
	free(h);
	return ret;
}

static bool has_coe(const struct ect_slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE;
}

static int end(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected)
{
	struct seen *seen = w->ctx;
	bool any = seen->any;

	(void)taken;
	seen->any = false;	/* of the next master */
	if (any || !selected)
		return 0;
	return fail("Master%u: no selected slave has a diagnosis history (object 0x10f3)",
		    d->master);
}

static int run(struct tool *t, int argc, char **argv)
{
	struct seen seen = { .any = false };
	const struct slave_walk w = {
		.write = true, .title = true, .takes = has_coe, .slave = slave, .end = end,
		.ctx = &seen,
	};
	int ret;

	(void)argc, (void)argv;
	if (t->reset && t->acknowledge)
		return usage_error("--acknowledge and --reset exclude each other");
	if (t->texts && esi_texts_load(t->texts, &seen.texts))
		return 1;
	ret = dev_each_slave(t, &w);
	esi_texts_free(&seen.texts);
	return ret;
}

const struct cmd cmd_diag = {
	.name = "diag",
	.run = run,
	.args = "",
	.opts = "maprAT",
	.summary = "Show the diagnosis history of slaves",
	.help = "Reads object 0x10f3 over CoE, the oldest message first. Columns: position, object, * if\n"
		"the message is not acknowledged, time, severity, diagnosis code, text. The time is DC time\n"
		"or seconds of the slave's own clock. Without --texts it is the number of the text, then\n"
		"its parameters; with --texts the text of the device description (ESI file, XML) with the\n"
		"parameters in it. --acknowledge acknowledges the newest message, --reset clears all, each\n"
		"after they were shown. Slaves without the object are skipped.\n"
		"  ethercat diag -p4 --texts vendor.xml\n"
		"  ethercat diag --acknowledge\n",
	.json = "masters[]: master, slaves[]: position, max_messages, newest, acknowledged, flags,\n"
		"messages[]: subindex, new, time_ns, severity (info, warning, error, unknown), code,\n"
		"flags, text_id, text, parameters[]: type, value, data_hex; invalid_parameters, or\n"
		"invalid",
};
