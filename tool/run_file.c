// SPDX-License-Identifier: GPL-2.0-only
/* Run the bus without an application, as a bus file says. */
#include "run.h"

#ifdef EC_TOOL_NO_BUS
int run_file(const struct tool *t, const char *path)
{
	(void)t;
	(void)path;
	return fail("this 'ethercat' was built without libyaml: install libyaml-dev and build it again");
}
#else
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../include/ethercat-bus/load.h"
#include "bus_machine.h"
#include "out.h"

/**
 * struct job - a bus that runs by a file
 * @t: options
 * @d: the master, for what no application does
 * @path: of the file
 * @bus: what it says
 * @want: master of @bus
 * @machine: what is connected
 * @found: master of @machine
 * @n: differences that matter
 * @load: argument of ecrt_master_load_bus()
 */
struct job {
	const struct tool *t;
	struct dev *d;
	const char *path;
	struct ecb_bus *bus;
	const struct ecb_master *want;
	struct ecb_bus *machine;
	const struct ecb_master *found;
	size_t n;
	struct ecb_load load;
};

/* A file moves the machine: its owner alone may write it. */
static int check_owner(const char *path, const struct stat *st)
{
	if (!S_ISREG(st->st_mode))
		return fail("%s is not a regular file", path);
	if (st->st_mode & 022)
		return fail("%s: others may write it (mode %04o), so it is not used; 'chmod go-w %s'",
			    path, st->st_mode & 07777, path);
	if (st->st_uid && st->st_uid != geteuid())
		return fail("%s belongs to user %u, so it is not used; copy it, or 'chown' it",
			    path, st->st_uid);
	return 0;
}

static bool same_file(const struct stat *a, const struct stat *b)
{
	return a->st_size == b->st_size && a->st_mtim.tv_sec == b->st_mtim.tv_sec &&
		a->st_mtim.tv_nsec == b->st_mtim.tv_nsec && a->st_mode == b->st_mode &&
		a->st_uid == b->st_uid;
}

static int read_open(const char *path, int fd, struct ecb_bus **bus)
{
	struct stat before, after;
	struct ecb_error e;

	if (fstat(fd, &before))
		return fail("%s: %s", path, strerror(errno));
	if (check_owner(path, &before))
		return 1;
	if (ecb_file_read_fd(bus, fd, path, &e))
		return fail("%s", e.text);
	if (!fstat(fd, &after) && same_file(&before, &after))
		return 0;
	return fail("%s has changed while it was read; repeat the command", path);
}

static int read_file(struct job *j)
{
	/* a pipe without writer must not stop the command */
	int fd = open(j->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK), ret;

	if (fd < 0)
		return fail("%s: %s", j->path, strerror(errno));
	ret = read_open(j->path, fd, &j->bus);
	close(fd);
	return ret;
}

static const struct ecb_master *master_of(const struct ecb_bus *bus, unsigned int index)
{
	for (size_t i = 0; i < bus->master_count; i++)
		if (bus->masters[i]->index == index)
			return bus->masters[i];
	return NULL;
}

static const struct ecb_slave *slave_of(const struct job *j, const char *name)
{
	for (size_t i = 0; i < j->want->slave_count; i++)
		if (!strcmp(j->want->slaves[i]->name, name))
			return j->want->slaves[i];
	return NULL;
}

/* Groups come and go; what the file does not have is left alone. */
static void difference(void *ctx, const struct ecb_difference *x)
{
	struct bus_names names = { .found = "machine" };
	struct job *j = ctx;
	const struct ecb_slave *s = slave_of(j, x->slave);

	names.expected = j->path;
	if (x->kind == ECB_EXTRA) {
		out_object(NULL);
		out_str("kind", "extra", NULL);
		out_str("slave", x->slave, "  %s: omitted, not in %s", x->slave, j->path);
		out_str("found", x->found, " (%s)\n", x->found);
		out_end();
		return;
	}
	if (s && s->group)
		return;
	j->n++;
	bus_show_difference(&names, x);
}

static int compare(struct job *j)
{
	struct ecb_master *a = (struct ecb_master *)j->want, *b = (struct ecb_master *)j->found;
	const struct ecb_bus expected = { .masters = &a, .master_count = 1 };
	const struct ecb_bus machine = { .masters = &b, .master_count = 1 };
	long n;

	out_array("differences");
	n = ecb_compare(&expected, &machine, ECB_COMPARE_MACHINE | ECB_COMPARE_SLAVES, difference,
			j);
	out_end();
	if (n < 0)
		return fail("out of memory");
	if (!j->n || j->t->force)
		return 0;
	return fail("Master%u: %zu difference(s) from %s, so the bus does not run; --force runs the others",
		    j->d->master, j->n, j->path);
}

/* no application renews a lease or gives authority; a policy would replace set outputs */
static int check_units(const struct job *j)
{
	for (size_t i = 0; i < j->want->sync_unit_count; i++) {
		const struct ecb_unit *u = j->want->sync_units[i];

		if (u->policy != ECB_POLICY_CONTINUE || u->lease || u->needs_authority ||
		    u->offered)
			return fail("%s:%u: sync unit '%s' has a policy, a lease or authority, which need an application; use 'policy: continue' alone for 'ethercat run'",
				    j->path, u->line, u->name);
	}
	return 0;
}

/* the master of -m; without, that of the file if it has one alone */
static int open_master(struct job *j)
{
	if (j->t->masters.given || j->bus->master_count != 1)
		return dev_open_single(j->d, j->t, true);
	if (!dev_open(j->d, j->bus->masters[0]->index, true))
		return 0;
	note("%s is for master %u; -m chooses another one", j->path, j->bus->masters[0]->index);
	return 1;
}

static int prepare(struct job *j)
{
	struct bus_wish wish = { .file = j->bus, .pdos = true };
	struct ecb_error e;

	j->want = master_of(j->bus, j->d->master);
	if (!j->want)
		return fail("%s has no master %u; choose one of the file with -m", j->path,
			    j->d->master);
	if (bus_of_master(j->t, j->d, &wish, &j->machine))
		return 1;
	j->found = master_of(j->machine, j->d->master);
	if (!j->found)
		return fail("Master%u: cannot read its slaves", j->d->master);
	if (compare(j) || check_units(j))
		return 1;
	j->load = (struct ecb_load){
		.struct_size = sizeof(j->load), .bus = j->bus, .file = j->path, .found = j->found,
		.index = j->d->master,
		.flags = ECB_LOAD_CHECK | (j->t->force ? ECB_LOAD_PARTIAL : 0),
	};
	if (ecrt_master_load_bus(NULL, &j->load, &e))
		return fail("%s", e.text);
	j->load.flags &= ~ECB_LOAD_CHECK;
	return 0;
}

static u32 period_of(const struct job *j)
{
	return j->t->period_us ? 1000 * j->t->period_us :
		j->want->cycle ? (u32)j->want->cycle : RUN_PERIOD_NS;
}

static void show_plan(const struct job *j)
{
	out_text("Master%u: the slaves of %s would go to OP, outputs zero, cycle %g ms:\n",
		 j->d->master, j->path, period_of(j) / 1e6);
	out_array("slaves");
	for (size_t i = 0; i < j->want->slave_count; i++) {
		const struct ecb_slave *s = j->want->slaves[i];

		out_object(NULL);
		out_str("name", s->name, "  %s", s->name);
		if (s->type)
			out_str("type", s->type, "  %s", s->type);
		if (s->group)
			out_str("group", s->group, ", when group %s is connected", s->group);
		out_text("\n");
		out_end();
	}
	out_end();
}

static int set_cycle(const struct job *j, ec_master_t *m)
{
	struct ecb_loaded l = { .struct_size = sizeof(l) };
	ec_cycle_config_t c = { .period_ns = period_of(j), .cpu = -1 };
	int err = ecrt_master_loaded(m, &l);

	/* the frame passes the clocks a quarter of the period after SYNC0 */
	if (!err && l.clocks) {
		c.dc = EC_CYCLE_SYNC_SLAVES | EC_CYCLE_FOLLOW_REFERENCE;
		c.phase_ns = c.period_ns / 4;
	}
	return err ? err : ecrt_master_set_cycle(m, &c);
}

static bool same_slave(const struct ecb_slave *a, const struct ecb_slave *b)
{
	return a->vendor == b->vendor && a->product == b->product && a->serial == b->serial &&
		a->alias == b->alias && a->identification == b->identification;
}

/* What was read before the master was reserved must still be so: places depend on it. */
static int check_again(const struct job *j)
{
	struct bus_wish wish = { .serials = true };
	const struct ecb_master *now;
	struct ecb_bus *bus;
	size_t i = 0;

	if (bus_of_master(j->t, j->d, &wish, &bus))
		return 1;
	now = master_of(bus, j->d->master);
	while (now && i < now->slave_count && i < j->found->slave_count &&
	       same_slave(now->slaves[i], j->found->slaves[i]))
		i++;
	if (now && i == now->slave_count && i == j->found->slave_count)
		now = NULL;
	else if (!now)
		now = j->found;
	ecb_bus_free(bus);
	return now ? fail("Master%u: its slaves have changed meanwhile; repeat the command",
			  j->d->master) : 0;
}

static int start(const struct job *j, ec_master_t *m)
{
	struct ecb_loaded l = { .struct_size = sizeof(l) };
	struct ecb_error e;
	size_t n;
	int err;

	if (check_again(j))
		return 1;
	if (ecrt_master_load_bus(m, &j->load, &e))
		return fail("%s", e.text);
	err = ecrt_master_loaded(m, &l);
	if (!err && !l.slaves)
		return fail("Master%u: none of the slaves of %s is connected", j->d->master,
			    j->path);
	if (!err)
		err = set_cycle(j, m);
	if (!err)
		err = ecrt_master_activate(m);
	if (err)
		return fail("Master%u: cannot start the cycle (%s)", j->d->master, strerror(-err));
	if (run_wait_op(j->d, j->t, l.slaves, &n))
		return 1;
	run_show(j->d, n);
	return 0;
}

/* The last step: when the master is released before it, the session ends. */
static int leave(const struct job *j, ec_master_t *m)
{
	int err = run_finish_output();

	if (err)
		return err;
	err = ecrt_master_leave(m);
	return err ? fail("Master%u: cannot leave the cycle to the master (%s); the bus does not run",
			  j->d->master, strerror(-err)) : 0;
}

static int run_it(const struct job *j)
{
	ec_master_t *m = ecrt_request_master(j->d->master);
	int ret = m ? start(j, m) : fail("Master%u: cannot run the bus (%s)", j->d->master,
					 strerror(errno));

	out_end();
	if (!ret)
		ret = leave(j, m);
	ecrt_release_master(m);
	return ret;
}

static int run_open(struct job *j)
{
	int ret;

	out_object(NULL);
	out_u("master", j->d->master, NULL);
	out_bool("dry_run", j->t->dry_run, NULL);
	out_str("file", j->path, NULL);
	ret = prepare(j);
	if (!ret && j->t->dry_run)
		show_plan(j);
	if (ret || j->t->dry_run)
		out_end();
	else
		ret = run_it(j);
	ecb_bus_free(j->machine);
	return ret;
}

int run_file(const struct tool *t, const char *path)
{
	struct dev d;
	struct job j = { .t = t, .d = &d, .path = path };
	int ret;

	if (read_file(&j))
		return 1;
	ret = open_master(&j);
	if (!ret) {
		ret = run_open(&j);
		dev_close(&d);
	}
	ecb_bus_free(j.bus);
	return ret;
}
#endif
