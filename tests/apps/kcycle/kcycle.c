// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Example: the kernel runs the cycle. All slaves with the PDOs they have, one
 * domain; inputs are read and outputs written once a cycle. This program needs
 * no real-time priority: the bus keeps its time without it.
 *
 * usage: kcycle [OPTION=NUMBER...]
 *   cycles=10000   to run after all slaves are in OP
 *   period=1000    of the cycle, us
 *   cpu=-1         for the thread of the kernel, -1: any
 *   priority=0     of the thread, 1 to 98, 0: 50
 *   stall=0        without outputs: 0 hold, 1 zero, 2 stop
 *   stall_cycles=0 after that many cycles
 *   dc=0           1: keep the clocks of the slaves in step; 2: and follow them
 *   spin=0         how to wait: 0 one system call, 1 spin, 2 poll(), 3 epoll
 *   pause=0        ms without outputs, in the middle
 *   flags=0        1: the cycle survives this program, 2: it waits for outputs,
 *                  8: it runs in an interrupt
 *   value=0        number in the first 32 bits of every slave's outputs; with 0
 *                  they stay as they are
 *   loop=0         1: the first and last 32 bits of the image of every slave's
 *                  outputs are wired to its inputs: check that no image is torn
 *   master=0       which one
 *   options=0      of the domain, ec_domain_option_t
 *   unit=0         1: the domain is the sync unit "axis", offered to others; 2: and has authority
 *                  once all slaves are in OP
 *   hold=0         1: no cycle of its own: hold the unit "axis" of another program, and write value
 *                  to its outputs
 */
#include <ecrt.h>
#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <time.h>

#define SLAVES_MAX	128
#define OP_TIMEOUT_S	60
#define UNIT		"axis"

static long opt_cycles = 10000, opt_period = 1000, opt_cpu = -1, opt_priority, opt_stall,
	    opt_stall_cycles, opt_dc, opt_spin, opt_pause, opt_flags, opt_value, opt_loop,
	    opt_master, opt_options, opt_unit, opt_hold;

static const struct {
	const char *name;
	long *value;
} options[] = {
	{ "cycles", &opt_cycles }, { "period", &opt_period }, { "cpu", &opt_cpu },
	{ "priority", &opt_priority }, { "stall", &opt_stall },
	{ "stall_cycles", &opt_stall_cycles }, { "dc", &opt_dc }, { "spin", &opt_spin },
	{ "pause", &opt_pause }, { "flags", &opt_flags },
	{ "value", &opt_value }, { "loop", &opt_loop },
	{ "master", &opt_master }, { "options", &opt_options },
	{ "unit", &opt_unit }, { "hold", &opt_hold },
};

/* one slave; @out, @in: offset of its first SyncManager of that direction, or -1 */
struct slave {
	ec_slave_config_t *sc;
	int out, in;
	size_t out_bytes, in_bytes;
};

static ec_master_t *master;
static ec_domain_t *domain;
static struct slave slaves[SLAVES_MAX];
static unsigned int n_slaves;

/* what is counted while it runs */
static unsigned long done, wc_errors, skipped, compared, torn;

static int parse(int argc, char **argv)
{
	for (int i = 1; i < argc; i++) {
		size_t k, n = sizeof(options) / sizeof(options[0]);
		char *value = strchr(argv[i], '='), *end;

		for (k = 0; value && k < n; k++)
			if (strlen(options[k].name) == (size_t)(value - argv[i]) &&
			    !strncmp(argv[i], options[k].name, (size_t)(value - argv[i])))
				break;
		if (!value || k == n) {
			fprintf(stderr, "unknown option %s; see the head of kcycle.c\n", argv[i]);
			return -1;
		}
		*options[k].value = strtol(value + 1, &end, 0);
		if (*end || end == value + 1) {
			fprintf(stderr, "%s: no number\n", argv[i]);
			return -1;
		}
	}
	return 0;
}

/* configuration ------------------------------------------------------------*/

static size_t sync_bytes(uint16_t pos, uint8_t sm, unsigned int n_pdos)
{
	size_t bits = 0;

	for (uint16_t p = 0; p < n_pdos; p++) {
		ec_pdo_info_t pdo;
		ec_pdo_entry_info_t entry;

		if (ecrt_master_get_pdo(master, pos, sm, p, &pdo))
			return 0;
		for (uint16_t e = 0; e < pdo.n_entries; e++) {
			if (ecrt_master_get_pdo_entry(master, pos, sm, p, e, &entry))
				return 0;
			bits += entry.bit_length;
		}
	}
	return (bits + 7) / 8;
}

/* A slave with all its process data, as it is. */
static int add_slave(uint16_t pos)
{
	struct slave *s = &slaves[pos];
	ec_slave_info_t info;
	ec_sync_info_t sync;
	unsigned int bit;
	int offset;

	s->out = s->in = -1;
	if (ecrt_master_get_slave(master, pos, &info))
		return -1;
	s->sc = ecrt_master_slave_config(master, 0, pos, info.vendor_id, info.product_code);
	if (!s->sc)
		return -1;
	for (uint8_t i = 0; i < info.sync_count; i++) {
		if (ecrt_master_get_sync_manager(master, pos, i, &sync))
			return -1;
		if (!sync.n_pdos)
			continue;
		offset = ecrt_slave_config_reg_pdo_entry_pos(s->sc, i, 0, 0, domain, &bit);
		if (offset < 0)
			return -1;
		if (sync.dir == EC_DIR_OUTPUT && s->out < 0) {
			s->out = offset;
			s->out_bytes = sync_bytes(pos, i, sync.n_pdos);
		} else if (sync.dir == EC_DIR_INPUT && s->in < 0) {
			s->in = offset;
			s->in_bytes = sync_bytes(pos, i, sync.n_pdos);
		}
	}
	return 0;
}

/* All process data are those of one unit. */
static int put_into_unit(void)
{
	ec_unit_config_t config = {
		.name = UNIT,
		.policy = EC_UNIT_ZERO,
		.flags = EC_UNIT_AUTHORITY | EC_UNIT_OFFERED,
	};
	int unit = ecrt_master_unit(master, &config);

	return unit < 0 ? unit : ecrt_domain_set_unit(domain, unit);
}

static int configure(void)
{
	ec_cycle_config_t cycle = {
		.period_ns = (uint32_t)opt_period * 1000,
		.cpu = (int32_t)opt_cpu,
		.priority = (uint32_t)opt_priority,
		.stall = (ec_cycle_stall_t)opt_stall,
		.stall_cycles = (uint32_t)opt_stall_cycles,
		.dc = !opt_dc ? 0 : EC_CYCLE_SYNC_SLAVES | EC_CYCLE_SYNC_MONITOR |
				    (opt_dc == 2 ? EC_CYCLE_FOLLOW_REFERENCE : 0),
		.flags = (uint32_t)opt_flags | (opt_cpu >= 0 ? EC_CYCLE_BIND_CPU : 0),
	};
	ec_master_info_t info;

	if (opt_period < 1 || opt_period > 1000000) {
		fprintf(stderr, "a period of %ld us; use 1 to 1000000\n", opt_period);
		return -1;
	}
	domain = ecrt_master_create_domain(master);
	if (!domain || ecrt_domain_set_options(domain, (uint32_t)opt_options) ||
	    (opt_unit && put_into_unit()) || ecrt_master(master, &info))
		return -1;
	if (!info.slave_count || info.slave_count > SLAVES_MAX) {
		fprintf(stderr, "%u slaves; 1 to %u are possible\n", info.slave_count, SLAVES_MAX);
		return -1;
	}
	n_slaves = info.slave_count;
	for (unsigned int i = 0; i < n_slaves; i++)
		if (add_slave((uint16_t)i))
			return -1;
	/* this is all that a cycle of the kernel needs */
	return ecrt_master_set_cycle(master, &cycle);
}

/* cycle --------------------------------------------------------------------*/

static int wait_epoll(void)
{
	static int fd = -1;
	struct epoll_event e = { .events = EPOLLIN };

	if (fd < 0) {
		fd = epoll_create1(EPOLL_CLOEXEC);
		if (fd < 0 || epoll_ctl(fd, EPOLL_CTL_ADD, ecrt_master_cycle_fd(master), &e))
			return -1;
	}
	return epoll_wait(fd, &e, 1, -1) != 1 || e.events & (EPOLLHUP | EPOLLERR);
}

/* Until the next cycle; returns how many there were, or a negative errno. */
static int wait_cycle(void)
{
	static uint64_t last;
	uint64_t now;
	int n;

	if (!opt_spin)
		return ecrt_master_wait_cycle(master, 0);
	if (opt_spin == 3 && wait_epoll())
		return -ECANCELED;
	if (opt_spin == 2) {
		struct pollfd p = { .fd = ecrt_master_cycle_fd(master), .events = POLLIN };

		if (poll(&p, 1, -1) < 0)
			return -errno;
		if (p.revents & (POLLHUP | POLLERR))
			return -ECANCELED;
	}
	while ((now = ecrt_master_cycle_count(master)) == last) {
		n = ecrt_master_receive(master);
		/* without a device cycles go on */
		if (n && n != -ENODEV)
			return n;
	}
	n = (int)(now - last);
	last = now;
	return n;
}

/*
 * The same number at both ends of all outputs; all ends of the inputs agree? They may only differ
 * when a frame of this cycle or of the one before is missing, which wrote these inputs: not @whole.
 */
static void loop_check(uint8_t *data, uint32_t number, bool whole)
{
	static uint32_t seen;
	bool first = true;
	uint32_t v[2];

	for (unsigned int i = 0; i < n_slaves; i++) {
		struct slave *s = &slaves[i];

		if (s->out >= 0 && s->out_bytes >= 4) {
			EC_WRITE_U32(data + s->out, number);
			EC_WRITE_U32(data + s->out + s->out_bytes - 4, number);
		}
		if (s->in < 0 || s->in_bytes < 4)
			continue;
		v[0] = EC_READ_U32(data + s->in);
		v[1] = EC_READ_U32(data + s->in + s->in_bytes - 4);
		if (first)
			seen = v[0];
		first = false;
		compared += whole;
		torn += whole && (v[0] != seen || v[1] != seen);
	}
}

static void write_value(uint8_t *data)
{
	for (unsigned int i = 0; i < n_slaves; i++)
		if (slaves[i].out >= 0 && slaves[i].out_bytes >= 4)
			EC_WRITE_U32(data + slaves[i].out, (uint32_t)opt_value);
}

static int one_cycle(uint8_t *data, bool count)
{
	static uint32_t number;
	static bool before;
	ec_domain_state_t state;
	bool complete;
	int n = wait_cycle();

	if (n < 0)
		return n;
	ecrt_master_receive(master);
	ecrt_domain_process(domain);
	ecrt_domain_state(domain, &state);
	complete = state.wc_state == EC_WC_COMPLETE;
	if (opt_loop)
		loop_check(data, ++number, complete && before && n == 1);
	else if (opt_value)
		write_value(data);
	ecrt_domain_queue(domain);
	ecrt_master_send(master);
	if (count) {
		done++;
		skipped += (unsigned long)n - 1;
		wc_errors += !complete;
	}
	before = complete;
	return 0;
}

static bool all_operational(void)
{
	ec_slave_config_state_t s;

	for (unsigned int i = 0; i < n_slaves; i++)
		if (ecrt_slave_config_state(slaves[i].sc, &s) || !s.operational)
			return false;
	return true;
}

/* What is there before the first cycle: zeros, or another program's image. */
static void found(const uint8_t *data)
{
	ec_cycle_state_t s;

	if (ecrt_master_cycle_state(master, &s) || slaves[0].out < 0 || slaves[0].in < 0)
		return;
	printf("takeovers: %" PRIu32 ", output: %" PRIu32 ", input: %" PRIu32 ", %s in OP\n",
	       s.takeovers, EC_READ_U32(data + slaves[0].out), EC_READ_U32(data + slaves[0].in),
	       all_operational() ? "all" : "not all");
}

static int run(uint8_t *data)
{
	time_t end = time(NULL) + OP_TIMEOUT_S;
	int ret;

	found(data);
	while (!all_operational()) {
		if (time(NULL) > end) {
			fprintf(stderr, "not all slaves in OP after %u s\n", OP_TIMEOUT_S);
			return -ETIMEDOUT;
		}
		ret = one_cycle(data, false);
		if (ret)
			return ret;
	}
	/* values from before OP are still on their way */
	for (int i = 0; i < 10; i++)
		one_cycle(data, false);
	if (opt_unit == 2) {
		ret = ecrt_master_unit_authority(master, 0, 1);
		if (ret)
			return ret;
	}
	printf("%u slaves in OP\n", n_slaves);
	compared = 0;
	torn = 0;
	while (done < (unsigned long)opt_cycles) {
		ret = one_cycle(data, true);
		if (ret)
			return ret;
		if (opt_pause && done == (unsigned long)opt_cycles / 2) {
			struct timespec t = { opt_pause / 1000, opt_pause % 1000 * 1000000 };

			nanosleep(&t, NULL);
		}
	}
	return 0;
}

static void report(void)
{
	static const char *const names[] = { "none", "running", "stalled", "stopped",
					     "waiting" };
	ec_cycle_state_t s;

	if (ecrt_master_cycle_state(master, &s))
		return;
	printf("cycles: %lu, working counter errors: %lu, skipped: %lu, torn: %lu of %lu\n", done,
	       wc_errors, skipped, torn, compared);
	printf("kernel: %s, cycles: %" PRIu64 ", overruns: %" PRIu64 ", missed: %" PRIu64 "\n",
	       names[s.run], s.cycles, s.overruns, s.missed);
	printf("send after schedule: min %" PRIu32 " mean %" PRIu32 " 99.9 %% %" PRIu32
	       " max %" PRIu32 " ns\n", s.late_min, s.late_mean, s.late_p999, s.late_max);
	if (opt_dc == 2)
		printf("reference clock: %s, phase error %" PRId32 " ns, rate %+" PRId32
		       " ppb, lost %" PRIu32 " time(s)\n", s.lock == EC_CYCLE_LOCKED ? "locked" :
		       "not locked", s.phase_error, s.rate_ppb, s.lock_losses);
	for (unsigned int i = 0; i < EC_CYCLE_BINS; i++)
		if (s.late[i])
			printf("  < %10" PRIu64 " ns: %" PRIu64 "\n", (uint64_t)1 << i, s.late[i]);
}

/* A second program: gives the outputs of the unit, each millisecond. */
static int hold(void)
{
	const struct timespec ms = { .tv_nsec = 1000000 };
	uint8_t *data = NULL;
	size_t size = 0;
	int unit, ret = -ENOMEM;

	master = ecrt_open_master((unsigned int)opt_master);
	if (!master)
		return 1;
	unit = ecrt_master_unit_hold(master, UNIT, &size);
	if (unit >= 0)
		data = calloc(size / 4 + 1, 4);
	for (size_t i = 0; data && i + 4 <= size; i += 4)
		EC_WRITE_U32(data + i, (uint32_t)opt_value);
	/* the cycle has to take the holder first */
	ret = data ? -EINPROGRESS : ret;
	for (int i = 0; ret == -EINPROGRESS && i < 5000; i++) {
		ret = ecrt_master_unit_authority(master, (unsigned int)unit, 1);
		nanosleep(&ms, NULL);
	}
	for (long i = 0; !ret && i < opt_cycles; i++) {
		ret = ecrt_master_unit_write(master, (unsigned int)unit, data, size, NULL);
		nanosleep(&ms, NULL);
	}
	fprintf(stderr, "unit " UNIT ": %s\n", strerror(unit < 0 ? -unit : -ret));
	free(data);
	ecrt_release_master(master);
	return unit < 0 || ret ? 1 : 0;
}

int main(int argc, char **argv)
{
	int ret = -1;

	if (parse(argc, argv))
		return 2;
	setvbuf(stdout, NULL, _IOLBF, 0);
	if (opt_hold)
		return hold();
	master = ecrt_request_master((unsigned int)opt_master);
	if (!master)
		return 1;
	if (!configure() && !ecrt_master_activate(master)) {
		ret = run(ecrt_domain_data(domain));
		if (ret)
			fprintf(stderr, "the cycle ended: %s\n", strerror(-ret));
		report();
	}
	ecrt_release_master(master);
	return ret ? 1 : 0;
}
