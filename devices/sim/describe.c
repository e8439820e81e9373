// SPDX-License-Identifier: GPL-2.0-only
/* Builds a segment from its description. */
#include "describe_int.h"

#define IMAGE_MAX	(512 * 1024u)
#define PATH_SIZE	128	/* of an image, with the zero */
#define PATH_LIMIT	"127"
#define DEVICE_ALIASES	"WAGO750-354"

static int no_memory(struct ec_desc *d)
{
	ec_desc_fail(d, "out of memory", NULL, "");
	return -ENOMEM;
}

static int do_segment(struct ec_desc *d)
{
	int ret;
	s64 seed = 0;

	/* the seed itself was taken before anything was built */
	ret = ec_desc_number(d, "seed", 0, (s64)(1ULL << 62), &seed);
	if (!ret)
		ret = ec_desc_time(d, "response", EC_DESC_TIME_MAX, &d->response_ns);
	if (!ret)
		ret = ec_desc_time(d, "transition", EC_DESC_TIME_MAX, &d->transition_ns);
	if (!ret)
		ret = ec_desc_time(d, "op_timeout", EC_DESC_TIME_MAX, &d->op_timeout_ns);
	if (!ret)
		ret = ec_desc_time(d, "link", EC_DESC_LINK_MAX, &d->link_ns);
	return ret ? ret : ec_desc_under_way(d);
}

static bool name_ok(const struct ec_desc_word *w)
{
	if (!w->n || w->n >= EC_APP_NAME)
		return false;
	for (size_t i = 0; i < w->n; i++) {
		char c = w->s[i];

		if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
		      (c >= '0' && c <= '9') || c == '_' || c == '-'))
			return false;
	}
	return true;
}

static bool same(const struct ec_app_params *a, const struct ec_app_params *b)
{
	return a->vendor == b->vendor && a->product == b->product &&
	       a->revision == b->revision && a->out == b->out &&
	       a->in == b->in && a->mbox == b->mbox &&
	       a->mapping == b->mapping && a->cpu == b->cpu && a->id == b->id &&
	       a->soe == b->soe && a->voe == b->voe && a->foe == b->foe && a->diag == b->diag &&
	       a->eoe == b->eoe &&
	       a->no_repeat == b->no_repeat && a->strict == b->strict &&
	       !a->quirks.any && !b->quirks.any;
}

static int model_from_file(struct ec_desc *d, const struct ec_desc_word *file,
			   const struct ec_app_params *p,
			   struct ec_app_model **m)
{
	char name[PATH_SIZE];
	int len, ret;
	u8 *buf;

	if (!d->loader || !d->loader->load)
		return ec_desc_fail(d, "'", file,
			"': files cannot be read here; use a device of the catalogue");
	if (!file->n)
		return ec_desc_fail(d, "no path behind file=", NULL, "");
	if (file->n >= sizeof(name))
		return ec_desc_fail(d, "path '", file,
				    "...' too long, limit " PATH_LIMIT " characters");
	memcpy(name, file->s, file->n);
	name[file->n] = '\0';
	buf = ec_sim_alloc(d->sim, IMAGE_MAX);
	if (!buf)
		return no_memory(d);
	len = d->loader->load(d->loader->ctx, name, buf, IMAGE_MAX);
	if (len < 0) {
		ec_sim_release(d->sim, buf);
		ec_desc_fail(d, "cannot read '", file, "'; check the path");
		return len;
	}
	*m = len > (int)IMAGE_MAX ? NULL :
		ec_app_model_file(d->sim, buf, (size_t)len, p, &ret);
	ec_sim_release(d->sim, buf);
	if (*m)
		return 0;
	if (len <= (int)IMAGE_MAX && ret == -ENOMEM)
		return no_memory(d);
	return ec_desc_fail(d, "'", file,
			    "' is not an EEPROM image (128 bytes and categories)");
}

static int model_of(struct ec_desc *d, const struct ec_desc_word *device,
		    const struct ec_app_params *p, struct ec_app_model **m)
{
	const struct ec_app_dev *dev = ec_app_catalogue(device->s, device->n);
	int ret;

	if (!dev && ec_desc_is(device, DEVICE_ALIASES))
		dev = ec_app_catalogue("750-354", 7);
	if (!dev)
		return ec_desc_fail(d, "unknown device '", device,
			"': expected EK1100, EL1008, EL2008, EL3062, EL4002, EL7201, drive, sercos, io...");
	for (u32 i = 0; i < d->n_models; i++) {
		*m = d->model[i];
		if ((*m)->table == dev && same(&(*m)->params, p)) {
			(*m)->refs++;
			return 0;
		}
	}
	*m = ec_app_model_new(d->sim, dev, p, &ret);
	if (!*m && ret == -ENOMEM)
		return no_memory(d);
	if (!*m)
		return ec_desc_fail(d, "'", device,
			"': too much process data or mailbox; at most 1486 bytes each");
	d->model[d->n_models++] = *m;
	(*m)->refs++;
	return 0;
}

/* "d" and 12 make "d12" */
static int make_name(char *buf, const struct ec_desc_word *w, u32 number)
{
	char tail[11];
	size_t n = w->n, t = sizeof(tail);

	if (number)
		for (u32 v = number; v; v /= 10)
			tail[--t] = (char)('0' + v % 10);
	if (n + sizeof(tail) - t >= EC_APP_NAME)
		return -EINVAL;
	memcpy(buf, w->s, n);
	memcpy(buf + n, tail + t, sizeof(tail) - t);
	buf[n + sizeof(tail) - t] = '\0';
	return 0;
}

static int add_slave(struct ec_desc *d, const struct ec_desc_word *name,
		     u32 number, struct ec_app_model *m,
		     struct ec_app_config *c, const struct ec_desc_cable *cable)
{
	struct ec_desc_node *n = &d->node[d->n_nodes];
	char buf[EC_APP_NAME];

	if (make_name(buf, name, number))
		return ec_desc_fail(d, "the name '", name, "' is too long with its number");
	for (u32 i = 0; i < d->n_nodes; i++)
		if (!strcmp(d->node[i].app->name, buf))
			return ec_desc_fail(d, "a slave named '", name,
					    "' exists already; choose another name");
	c->name = buf;
	n->app = ec_app_add(d->sim, m, c);
	if (!n->app)
		return no_memory(d);
	n->line = d->line;
	n->parent = d->at;
	n->parent_port = d->at_port;
	n->child_port = cable->swapped;
	n->cable_ns = (u32)cable->ns;
	d->at = (int)d->n_nodes++;
	d->at_port = !cable->swapped;
	return 0;
}

static int do_slave(struct ec_desc *d, u32 count, bool numbered)
{
	struct ec_desc_word *name = ec_desc_next(d), *device, file;
	struct ec_app_params p = { .out = 0 };
	struct ec_app_config c = { .name = NULL };
	struct ec_app_model *m = NULL;
	struct ec_desc_cable cable = { .ns = 0 };
	int ret;

	if (!name || !name_ok(name))
		return ec_desc_fail(d, "a slave needs a name of letters, digits, _ and -, at most 23",
				    NULL, "");
	if (ec_desc_is(name, "master") || ec_desc_is(name, "none"))
		return ec_desc_fail(d, "'", name, "' cannot be the name of a slave");
	file = ec_desc_value(d, "file");
	device = file.s ? NULL : ec_desc_next(d);
	if (!file.s && !device)
		return ec_desc_fail(d, "slave '", name,
				    "' has neither device nor EEPROM image; add EL2008 or file=IMAGE");
	ret = ec_desc_params(d, &p);
	if (!ret)
		ret = ec_desc_config(d, &c, &cable);
	if (!ret)
		ret = ec_desc_end(d);
	if (ret)
		return ret;
	ret = file.s ? model_from_file(d, &file, &p, &m) :
		       model_of(d, device, &p, &m);
	if (!ret && c.eeprom_emulated && m->emulation)
		ret = ec_desc_fail(d, "'", name,
				   "' has no CPU to emulate an EEPROM; remove eeprom=");
	if (!ret && (p.soe || p.voe || p.foe || p.eoe) && (m->emulation || !m->dev.std.rx_len))
		ret = ec_desc_fail(d, "'", name, "' has no mailbox; remove soe=, voe=, foe= and eoe=");
	if (!ret)
		ret = ec_desc_quirks_fit(d, name, m, &c);
	if (!ret && (c.alias + count - 1 > 0xFFFF || c.serial > 0xFFFFFFFF - (count - 1)))
		ret = ec_desc_fail(d, "the last '", name,
				   "' has no alias or serial number left; begin with smaller ones");
	for (u32 i = 0; i < count && !ret; i++) {
		if (i)
			c.clock_start = (u64)ec_sim_random(d->sim) << 4;
		ret = add_slave(d, name, numbered ? i + 1 : 0, m, &c, &cable);
		if (c.alias)
			c.alias++;
		if (c.serial)
			c.serial++;
	}
	ec_app_model_put(m);
	return ret;
}

static int do_repeat(struct ec_desc *d)
{
	struct ec_desc_word *w = ec_desc_next(d);
	s64 n;
	int ret;

	if (!w)
		return ec_desc_fail(d, "invalid repeat: expected repeat 100 slave d drive",
				    NULL, "");
	ret = ec_desc_parse_number(d, w, 1, 65535, &n);
	if (ret)
		return ret;
	if (!ec_desc_is(ec_desc_next(d), "slave"))
		return ec_desc_fail(d, "only slaves can be repeated; expected repeat 100 slave d drive",
				    NULL, "");
	return do_slave(d, (u32)n, true);
}

static int do_branch(struct ec_desc *d)
{
	struct ec_desc_word *name = ec_desc_next(d), *port = ec_desc_next(d);
	int slave, ret;
	s64 n;

	if (ec_desc_is(name, "none") && !port) {
		d->at = EC_DESC_NOWHERE;
		d->at_port = 0;
		return 0;
	}
	slave = ec_desc_slave(d, name);
	if (slave < 0)
		return slave;
	if (!port)
		return ec_desc_fail(d, "branch '", name, "' needs a port, 0 to 3");
	ret = ec_desc_parse_number(d, port, 0, EC_MAX_PORT - 1, &n);
	if (ret)
		return ret;
	d->at = slave;
	d->at_port = (int)n;
	return 0;
}

static int do_wire(struct ec_desc *d)
{
	struct ec_desc_word *a = ec_desc_next(d), *to = ec_desc_next(d);
	struct ec_desc_word *b = ec_desc_next(d);
	struct ec_desc_wire w = { .line = d->line };
	struct ec_desc_node *n;
	u64 cable = 0;
	int ret;

	if (!b || !ec_desc_is(to, "->"))
		return ec_desc_fail(d, "invalid wire: expected wire coupler.1 -> out.0",
				    NULL, "");
	ret = ec_desc_end_of_wire(d, a, &w.a, &w.a_port);
	if (!ret)
		ret = ec_desc_end_of_wire(d, b, &w.b, &w.b_port);
	if (!ret)
		ret = ec_desc_time(d, "cable", 1000000, &cable);
	if (ret)
		return ret;
	w.cable_ns = (u32)cable;
	if (w.b < 0 || d->node[w.b].wired) {
		d->wire[d->n_wires++] = w;
		return 0;
	}
	n = &d->node[w.b];
	n->wired = true;
	n->place = (struct ec_desc_wire){
		d->line, n->parent, n->parent_port, w.b, n->child_port, n->cable_ns,
	};
	n->parent = w.a;
	n->parent_port = w.a_port;
	n->child_port = w.b_port;
	n->cable_ns = w.cable_ns;
	return 0;
}

/* a channel as written in connect, const, ramp, sine; from 0 */
static int channel(struct ec_desc *d, struct ec_desc_word *w,
		   enum ec_app_dir dir, struct ec_app **app, u16 *chan)
{
	struct ec_desc_word name;
	int ret, slave;
	s64 n;

	ret = ec_desc_place(d, w, &name, &n);
	if (ret)
		return ret;
	slave = ec_desc_slave(d, &name);
	if (slave < 0)
		return slave;
	*app = d->node[slave].app;
	if (!n || n > (*app)->model->n_chan[dir])
		return ec_desc_fail(d, "'", w, dir == EC_APP_OUT ?
			"' is no output channel; channels count from 1" :
			"' is no input channel; channels count from 1");
	*chan = (u16)(n - 1);
	if (dir == EC_APP_IN && (*app)->src[*chan].kind != EC_APP_SRC_NONE)
		return ec_desc_fail(d, "input '", w, "' already has a source; remove one of them");
	return 0;
}

static int do_connect(struct ec_desc *d)
{
	struct ec_desc_word *a = ec_desc_next(d), *to = ec_desc_next(d);
	struct ec_desc_word *b = ec_desc_next(d);
	struct ec_app_source src;
	struct ec_app *from, *app;
	u16 from_chan, chan;
	int ret;

	if (!b || !ec_desc_is(to, "->"))
		return ec_desc_fail(d, "invalid connect: expected connect ao.1 -> ai.1",
				    NULL, "");
	ret = channel(d, a, EC_APP_OUT, &from, &from_chan);
	if (!ret)
		ret = channel(d, b, EC_APP_IN, &app, &chan);
	if (ret)
		return ret;
	if (app->model->chan[EC_APP_IN][chan]->bits == 1 &&
	    from->model->chan[EC_APP_OUT][from_chan]->bits > 1)
		return ec_desc_fail(d, "analog output '", a,
				    "' cannot be connected to a digital input");
	src = (struct ec_app_source){
		.kind = EC_APP_SRC_LINK, .from = from, .from_chan = from_chan,
	};
	ec_app_set_source(app, chan, &src);
	return 0;
}

static int do_source(struct ec_desc *d, enum ec_app_source_kind kind)
{
	struct ec_app_source src = { .kind = kind };
	struct ec_app *app;
	u16 chan;
	int ret;

	ret = channel(d, ec_desc_next(d), EC_APP_IN, &app, &chan);
	if (ret)
		return ret;
	if (kind == EC_APP_SRC_CONST)
		ret = ec_desc_number(d, "value", -0x80000000ll, 0xFFFFFFFFll,
				     &src.offset);
	else
		ret = ec_desc_number(d, "offset", -0x80000000ll, 0xFFFFFFFFll,
				     &src.offset);
	if (!ret && kind != EC_APP_SRC_CONST)
		ret = ec_desc_number(d, "amplitude", -0x80000000ll,
				     0xFFFFFFFFll, &src.amplitude);
	if (!ret && kind != EC_APP_SRC_CONST)
		ret = ec_desc_time(d, "period", 24 * EC_DESC_TIME_MAX, &src.period_ns);
	if (ret)
		return ret;
	if (kind != EC_APP_SRC_CONST && (!src.period_ns || !src.amplitude))
		return ec_desc_fail(d, "invalid source: expected sine ai.1 amplitude=10000 period=1s",
				    NULL, "");
	ec_app_set_source(app, chan, &src);
	return 0;
}

static int unknown(struct ec_desc *d, const struct ec_desc_word *w)
{
	return ec_desc_fail(d, "unknown statement '", w,
			    "': expected segment, slave, repeat, branch, wire, connect, const, ramp, sine, fault");
}

static bool is_statement(const struct ec_desc_word *w)
{
	static const char *const words[] = {
		"segment", "slave", "repeat", "branch", "wire", "connect", "const", "ramp",
		"sine", "fault",
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(words); i++)
		if (ec_desc_is(w, words[i]))
			return true;
	return false;
}

static int statement(struct ec_desc *d)
{
	struct ec_desc_word *w = ec_desc_next(d);
	int ret;

	if (ec_desc_is(w, "segment"))
		ret = do_segment(d);
	else if (ec_desc_is(w, "slave"))
		ret = do_slave(d, 1, false);
	else if (ec_desc_is(w, "repeat"))
		ret = do_repeat(d);
	else if (ec_desc_is(w, "branch"))
		ret = do_branch(d);
	else if (ec_desc_is(w, "wire"))
		ret = do_wire(d);
	else if (ec_desc_is(w, "connect"))
		ret = do_connect(d);
	else if (ec_desc_is(w, "const"))
		ret = do_source(d, EC_APP_SRC_CONST);
	else if (ec_desc_is(w, "ramp"))
		ret = do_source(d, EC_APP_SRC_RAMP);
	else if (ec_desc_is(w, "sine"))
		ret = do_source(d, EC_APP_SRC_SINE);
	else if (ec_desc_is(w, "fault"))
		ret = ec_desc_fault(d);
	else
		return unknown(d, w ? w : &d->w[0]);
	return ret ? ret : ec_desc_end(d);
}

/* first pass: how much memory, and the seed; errors show in the second */
static int count(struct ec_desc *d, const char *p, const char *end)
{
	s64 n;

	while (p < end) {
		if (ec_desc_split(d, &p, end))
			return -EINVAL;
		if (!d->n)
			continue;
		/* a misspelled slave is none */
		if (!is_statement(&d->w[0]))
			return unknown(d, &d->w[0]);
		if (ec_desc_is(&d->w[0], "segment")) {
			n = 0;
			if (ec_desc_number(d, "seed", 0, (s64)(1ULL << 62), &n))
				return -EINVAL;
			d->seed = (u64)n;
		}
		d->max_wires += ec_desc_is(&d->w[0], "wire");
		n = ec_desc_is(&d->w[0], "slave");
		if (ec_desc_is(&d->w[0], "repeat") && d->n > 1 &&
		    ec_desc_parse_number(d, &d->w[1], 1, 65535, &n))
			return -EINVAL;
		d->max_nodes += (u32)n;
		if (d->max_nodes > 65535)
			return ec_desc_fail(d, "too many slaves; a segment has at most 65535",
					    NULL, "");
	}
	d->line = 0;
	return d->max_nodes ? 0 :
		ec_desc_fail(d, "no slave in the description; add for example: slave out EL2008",
			     NULL, "");
}

static struct ec_desc_word name_of(const struct ec_desc_node *n)
{
	return (struct ec_desc_word){ .s = n->app->name, .n = strlen(n->app->name) };
}

static int wire_all(struct ec_desc *d)
{
	struct ec_desc_word name;

	ec_desc_add_loops(d);
	for (u32 i = 0; i < d->n_nodes; i++) {
		const struct ec_desc_node *n = &d->node[i];

		if (n->parent == EC_DESC_NOWHERE)
			continue;
		if (!ec_sim_wire(d->sim, n->parent, n->parent_port, (int)i,
				 n->child_port, n->cable_ns))
			continue;
		d->line = n->line;
		name = name_of(n);
		return ec_desc_fail(d, "'", &name, "' cannot be connected: the port is in use or missing");
	}
	for (u32 i = 0; i < d->n_wires; i++) {
		const struct ec_desc_wire *w = &d->wire[i];
		bool back = w->b < 0;

		d->line = w->line;
		if (ec_sim_wire(d->sim, back ? w->b : w->a,
				back ? w->b_port : w->a_port,
				back ? w->a : w->b, back ? w->a_port : w->b_port,
				w->cable_ns))
			return ec_desc_fail(d, "cannot connect the wire: a port is in use or missing",
					    NULL, "");
	}
	return 0;
}

/* a frame passes each cable and each slave once a port: its times have 32 bits */
static int check_delay(struct ec_desc *d)
{
	u64 ns = 0;

	for (u32 i = 0; i < d->n_nodes; i++) {
		const struct ec_esc *esc = ec_sim_at(d->sim, i);

		for (int p = 0; p < EC_MAX_PORT; p++)
			if (esc->port[p].peer != -1)
				ns += 2ull * esc->port[p].cable_ns +
				      max(esc->cfg.process_ns, esc->cfg.forward_ns);
		d->line = d->node[i].line;
		if (ns > ~0u)
			return ec_desc_fail(d, "frames take more than 4.29 s from here on; shorten delay= and cable=",
					    NULL, "");
	}
	return 0;
}

/* slave @i hangs at something that is reached */
static void reach(struct ec_desc *d, int i, int *todo)
{
	if (i < 0 || d->node[i].reached)
		return;
	d->node[i].reached = true;
	d->node[i].todo = *todo;
	*todo = i;
}

/* every slave must be connected with a master, by whatever way, or with one that comes later */
static int find_islands(struct ec_desc *d)
{
	struct ec_desc_word name;
	int todo = -1, p;

	for (u32 i = 0; i < d->n_nodes; i++) {
		if (d->node[i].parent == EC_DESC_NOWHERE)
			reach(d, (int)i, &todo);
		for (p = 0; p < EC_MAX_PORT; p++)
			if (ec_sim_at(d->sim, i)->port[p].peer < -1)
				reach(d, (int)i, &todo);
	}
	while (todo >= 0) {
		const struct ec_esc *esc = ec_sim_at(d->sim, (u32)todo);

		todo = d->node[todo].todo;
		for (p = 0; p < EC_MAX_PORT; p++)
			reach(d, esc->port[p].peer, &todo);
	}
	for (u32 i = 0; i < d->n_nodes; i++) {
		if (d->node[i].reached)
			continue;
		name = name_of(&d->node[i]);
		d->line = d->node[i].line;
		return ec_desc_fail(d, "no path from a master to '", &name,
				    "'; connect its segment to master.0");
	}
	return 0;
}

static int build(struct ec_desc *d, const char *p, const char *end)
{
	int ret;

	while (p < end) {
		ret = ec_desc_split(d, &p, end);
		if (!ret && d->n)
			ret = statement(d);
		if (ret)
			return ret;
	}
	ret = wire_all(d);
	if (!ret)
		ret = check_delay(d);
	return ret ? ret : find_islands(d);
}

/**
 * ec_sim_describe() - build a segment from its description
 * @out: the segment
 * @ops: where its memory comes from
 * @text: description, see describe.h; need not be terminated
 * @len: bytes at @text
 * @loader: where EEPROM images come from; NULL: none can be read
 * @err: what is wrong, if anything
 *
 * Context: Process. May sleep.
 * Return: 0, -EINVAL: the text is wrong, -ENOMEM, or what the loader said;
 * @err has the details in all these cases.
 */
int ec_sim_describe(struct ec_sim **out, const struct ec_sim_ops *ops,
		    const char *text, size_t len,
		    const struct ec_sim_loader *loader,
		    struct ec_sim_error *err)
{
	struct ec_desc *d = ops->alloc(sizeof(*d));
	int ret = -ENOMEM;

	*out = NULL;
	memset(err, 0, sizeof(*err));
	if (!d) {
		memcpy(err->text, "out of memory", 14);
		return -ENOMEM;
	}
	d->ops = ops;
	d->loader = loader;
	d->err = err;
	d->at = EC_SIM_MASTER0;
	d->op_timeout_ns = EC_APP_OP_TIMEOUT;
	ret = count(d, text, text + len);
	if (ret)
		goto err_free;

	ret = -ENOMEM;
	d->node = ops->alloc(d->max_nodes * sizeof(*d->node));
	d->model = ops->alloc(d->max_nodes * sizeof(void *));
	d->wire = ops->alloc((d->max_wires + 1) * sizeof(*d->wire));
	if (d->node && d->model && d->wire)
		d->sim = ec_sim_new(ops, d->max_nodes, d->seed);
	if (d->sim)
		ret = build(d, text, text + len);
	else
		no_memory(d);
	for (u32 i = 0; i < d->n_models; i++)
		ec_app_model_put(d->model[i]);
	if (ret)
		ec_sim_free(d->sim);
	else
		*out = d->sim;
	ops->free(d->wire);
	ops->free(d->model);
	ops->free(d->node);
err_free:
	ops->free(d);
	return ret;
}

/**
 * ec_sim_find() - slave of a name
 * @sim: segment
 * @name: its name in the description
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its application, or NULL.
 */
struct ec_app *ec_sim_find(struct ec_sim *sim, const char *name)
{
	for (u32 i = 0; i < ec_sim_count(sim); i++) {
		struct ec_app *app = ec_app_of(ec_sim_slave(sim, i));

		if (app && !strcmp(app->name, name))
			return app;
	}
	return NULL;
}
