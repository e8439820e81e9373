// SPDX-License-Identifier: LGPL-2.1-or-later
/* The library's side of a cycle the kernel runs; a thread is the kernel. */

#include "../fake/app_side.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define ENOUGH	2000U	/* images each way */
#define LIMIT_S	300	/* where one CPU is free they take turns of milliseconds */
#define STRIDE	(sizeof(struct ec_exchange_buffer) + 64)
#define IMAGE	32	/* two domains of 8 bytes out, 8 in */

static int failures;

#define CHECK(c) \
	do { \
		if (!(c)) { \
			printf("%s:%d: %s\n", __FILE__, __LINE__, #c); \
			failures++; \
		} \
	} while (0)

static unsigned char *image(unsigned int n)
{
	return (unsigned char *)fake.exchange + EC_EXCHANGE_FIRST + n * STRIDE +
	       sizeof(struct ec_exchange_buffer);
}

static unsigned int swap_word(__u32 *word, __u32 mine)
{
	return __atomic_exchange_n(word, mine, __ATOMIC_ACQ_REL) & 3;
}

/* Eight equal bytes, or -1. */
static int equal8(const unsigned char *p)
{
	for (unsigned int i = 1; i < 8; i++)
		if (p[i] != p[0])
			return -1;
	return p[0];
}

struct kernel {
	volatile int stop;
	unsigned long taken;
	unsigned long torn;
};

static unsigned long taken(const struct kernel *k)
{
	return __atomic_load_n(&k->taken, __ATOMIC_RELAXED);
}

/* Takes outputs, gives inputs, as fast as it can. */
static void *kernel(void *arg)
{
	struct kernel *k = arg;
	unsigned int front = 1, back = 0;
	__u64 cycle = 0;

	while (!k->stop) {
		struct ec_exchange_buffer *b;

		if (__atomic_load_n(&fake.exchange->outputs, __ATOMIC_RELAXED) & EC_EXCHANGE_NEW) {
			front = swap_word(&fake.exchange->outputs, front);
			__atomic_fetch_add(&k->taken, 1, __ATOMIC_RELAXED);
			k->torn += equal8(image(front)) < 0 || equal8(image(front) + 16) < 0;
		}
		cycle++;
		memset(image(3 + back), (int)(cycle & 0xff), IMAGE);
		b = (void *)(image(3 + back) - sizeof(*b));
		b->cycle = cycle;
		b->domains[0].working_counter = (__u32)cycle;
		b->domains[0].wc_state = 2;
		back = swap_word(&fake.exchange->inputs, back | EC_EXCHANGE_NEW);
	}
	return NULL;
}

static ec_master_t *start(ec_domain_t **d, unsigned char running)
{
	ec_cycle_config_t config = {
		.period_ns = 1000000, .flags = EC_CYCLE_DETACH,
	};
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	fake.running = running;
	fake.cycle = running;
	fake.image_size = 4096;
	fake.exchange_size = 4096 * 2;
	fake.stride = STRIDE;
	m = ecrt_request_master(0);
	d[0] = ecrt_master_create_domain(m);
	d[1] = ecrt_master_create_domain(m);
	CHECK(ecrt_master_set_cycle(m, &config) == 0);
	CHECK(fake.last == EC_IOC_CYCLE);
	CHECK(((struct ec_ioc_cycle *)(void *)fake.arg)->flags == EC_CYCLE_FLAG_DETACH);
	CHECK(ecrt_master_cycle_fd(m) == -EINVAL);
	CHECK(ecrt_master_wait_cycle(m, 0) == -EINVAL);
	CHECK(ecrt_master_activate(m) == 0);
	return m;
}

/* What one round does, step by step. */
static void steps(void)
{
	ec_domain_state_t st;
	ec_cycle_state_t cs;
	ec_domain_t *d[2];
	ec_master_t *m = start(d, 0);
	unsigned char *data[2] = { ecrt_domain_data(d[0]), ecrt_domain_data(d[1]) };
	unsigned int n;

	CHECK(data[0] && data[1] == data[0] + 16);
	/* nothing given without a queued domain */
	CHECK(!ecrt_master_send(m) && fake.exchange->outputs == 2);
	memset(data[0], 7, 8);
	memset(data[1], 8, 8);
	CHECK(!ecrt_domain_queue(d[0]) && !ecrt_domain_queue(d[1]));
	CHECK(!ecrt_master_send(m) && fake.exchange->outputs == EC_EXCHANGE_NEW);
	n = swap_word(&fake.exchange->outputs, 1);
	CHECK(n == 0 && equal8(image(n)) == 7 && equal8(image(n) + 16) == 8);
	/* a domain that is not queued keeps what was given last */
	memset(data[0], 9, 8);
	memset(data[1], 10, 8);
	CHECK(!ecrt_domain_queue(d[0]) && !ecrt_master_send(m));
	n = swap_word(&fake.exchange->outputs, n);
	CHECK(n == 2 && equal8(image(n)) == 9 && equal8(image(n) + 16) == 8);
	/* only inputs are copied, and only of new buffers */
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d[0]) && !data[0][8]);
	memset(image(3), 0x55, IMAGE);
	((struct ec_exchange_buffer *)(void *)(image(3) - sizeof(struct ec_exchange_buffer)))
		->domains[0].working_counter = 3;
	fake.exchange->inputs = 0 | EC_EXCHANGE_NEW;
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d[0]));
	CHECK(equal8(data[0]) == 9 && equal8(data[0] + 8) == 0x55 && !data[1][8]);
	CHECK(!ecrt_domain_state(d[0], &st) && st.working_counter == 3);
	fake.status->kernel.cycle = 12;
	fake.status->kernel.late_sum = 30;
	fake.status->kernel.late_count = 10;
	fake.status->kernel.lock = EC_CYCLE_LOCK_HOLD;
	fake.status->kernel.phase_error = -7;
	fake.status->kernel.rate_ppb = -100000;
	fake.status->kernel.lock_losses = 2;
	fake.status->kernel.late_max = 1 << 20;
	fake.status->kernel.work_sum = 5000;
	fake.status->kernel.work_count = 2;
	fake.status->kernel.work_max = 3000;
	fake.status->kernel.late[5] = 7000;
	fake.status->kernel.late[8 + 7] = 2000;	/* 15 ns */
	fake.status->kernel.late[16] = 991;	/* 16 and 17 ns */
	fake.status->kernel.late[239] = 9;	/* more than 4 s */
	CHECK(ecrt_master_cycle_count(m) == 12 && ecrt_master_cycle_fd(m) == FAKE_FD);
	CHECK(!ecrt_master_cycle_state(m, &cs) && cs.cycles == 12 && cs.late_mean == 3 &&
	      cs.late[3] == 7000 && cs.late[4] == 2000 && cs.late[5] == 991 &&
	      cs.late[31] == 9 && cs.late_p999 == 17 && cs.work_mean == 2500 && cs.work_max == 3000);
	CHECK(cs.lock == EC_CYCLE_HOLDING && cs.phase_error == -7 && cs.rate_ppb == -100000 &&
	      cs.lock_losses == 2);
	fake.cycle = 5;
	CHECK(ecrt_master_wait_cycle(m, 0) == 5);
	fake.cycle = 6;
	CHECK(ecrt_master_wait_cycle(m, 0) == 1);
	/* a word that is none names a buffer that is one */
	fake.exchange->inputs = 0xffffffff;
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d[0]));
	ecrt_release_master(m);
}

/* Inputs of cycle @n in buffer @buffer, published; all domains complete. */
static void publish(unsigned int buffer, __u64 n)
{
	struct ec_exchange_buffer *b =
		(void *)(image(3 + buffer) - sizeof(struct ec_exchange_buffer));

	b->cycle = n;
	b->time_ns = n * 1000000;
	b->domains[0].working_counter = b->domains[1].working_counter = 3;
	b->domains[0].wc_state = b->domains[1].wc_state = 2;
	fake.exchange->inputs = buffer | EC_EXCHANGE_NEW;
}

/* Inputs know their cycle, those that were taken. */
static void numbers(void)
{
	uint64_t cycle = 0, time_ns = 0;
	ec_domain_t *d[2];
	ec_master_t *m = start(d, 66);
	unsigned int calls = fake.calls;

	/* what lies in the buffer of one who takes over is another's */
	CHECK(ecrt_master_cycle_inputs(m, &cycle, &time_ns) == -ENODATA);
	CHECK(!ecrt_master_receive(m) && ecrt_master_cycle_inputs(m, &cycle, NULL) == -ENODATA);
	publish(0, 70);
	CHECK(ecrt_master_cycle_inputs(m, &cycle, &time_ns) == -ENODATA);
	CHECK(!ecrt_master_receive(m) && !ecrt_master_cycle_inputs(m, &cycle, &time_ns));
	CHECK(cycle == 70 && time_ns == 70000000);
	publish(2, 73);
	CHECK(!ecrt_master_cycle_inputs(m, &cycle, NULL) && cycle == 70);
	CHECK(!ecrt_master_receive(m) && !ecrt_master_cycle_inputs(m, NULL, &time_ns));
	CHECK(time_ns == 73000000);
	CHECK(!ecrt_master_receive(m) && !ecrt_master_cycle_inputs(m, &cycle, NULL) && cycle == 73);
	CHECK(fake.calls == calls);
	ecrt_master_deactivate(m);
	CHECK(ecrt_master_cycle_inputs(m, &cycle, NULL) == -EINVAL);
	ecrt_release_master(m);
}

/* The kernel has stopped the cycle, or has no device: all calls of a cycle tell it. */
static void halts(void)
{
	ec_domain_state_t st;
	ec_domain_t *d[2];
	ec_master_t *m = start(d, 0);
	unsigned int calls = fake.calls;

	publish(0, 1);
	CHECK(!ecrt_master_receive(m) && !ecrt_domain_process(d[0]) && !ecrt_domain_process(d[1]));
	CHECK(!ecrt_domain_state(d[1], &st) && st.wc_state == EC_WC_COMPLETE);
	fake.status->no_device = 1;
	CHECK(ecrt_master_receive(m) == -ENODEV);
	/* outputs are given all the same: it may come back */
	CHECK(!ecrt_domain_queue(d[0]) && ecrt_master_send(m) == -ENODEV);
	CHECK(fake.exchange->outputs & EC_EXCHANGE_NEW);
	fake.status->no_device = 0;
	CHECK(!ecrt_master_receive(m) && !ecrt_master_send(m));
	CHECK(!ecrt_domain_state(d[0], &st) && st.wc_state == EC_WC_COMPLETE);
	publish(2, 2);
	fake.status->kernel.state = EC_CYCLE_STATE_STOPPED;
	CHECK(ecrt_master_receive(m) == -ECANCELED);
	for (unsigned int i = 0; i < 2; i++) {
		CHECK(!ecrt_domain_process(d[i]) && !ecrt_domain_state(d[i], &st));
		CHECK(st.working_counter == 0 && st.wc_state == EC_WC_ZERO);
		CHECK(!ecrt_domain_queue(d[i]));
	}
	CHECK(ecrt_master_send(m) == -ECANCELED && ecrt_master_send(m) == -ECANCELED);
	CHECK(fake.calls == calls);
	ecrt_release_master(m);
}

/* An application that takes over finds everything as the other has left it. */
static void takeover(void)
{
	ec_domain_t *d[2];
	ec_master_t *m = start(d, 66);
	unsigned char *data[2] = { ecrt_domain_data(d[0]), ecrt_domain_data(d[1]) };
	ec_cycle_state_t cs;
	unsigned int n;

	CHECK(equal8(data[0]) == 66 && equal8(data[0] + 8) == 66 && equal8(data[1]) == 66);
	CHECK(!ecrt_master_cycle_state(m, &cs) && cs.takeovers == 1);
	/* cycles before are not its own */
	fake.cycle = 68;
	CHECK(ecrt_master_wait_cycle(m, 0) == 2);
	/* what it does not queue stays */
	memset(data[0], 7, 8);
	CHECK(!ecrt_domain_queue(d[0]) && !ecrt_master_send(m));
	n = swap_word(&fake.exchange->outputs, 1);
	CHECK(n == 2 && equal8(image(n)) == 7 && equal8(image(n) + 16) == 66);
	fake.refuse = EC_IOC_END_DETACHED;
	fake.err = EBUSY;
	CHECK(ecrt_master_end_detached(m) == -EBUSY);
	fake.refuse = 0;
	CHECK(ecrt_master_end_detached(m) == 0 && fake.last == EC_IOC_END_DETACHED);
	ecrt_release_master(m);
}

/* A takeover that fails half-way does not end what it has found. */
static void takeover_fails(void)
{
	ec_cycle_config_t config = { .period_ns = 1000000 };
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	fake.running = 1;
	fake.exchange_size = 4096;
	fake.stride = 1;	/* cannot be */
	m = ecrt_request_master(0);
	CHECK(!ecrt_master_set_cycle(m, &config));
	CHECK(ecrt_master_activate(m) == -EPROTO && fake.last == EC_IOC_ACTIVATE);
	fake.running = 0;
	CHECK(ecrt_master_activate(m) == -EPROTO && fake.last == EC_IOC_DEACTIVATE);
	ecrt_release_master(m);
}

/* One CPU only when it is said twice: zeros in a structure choose none. */
static void cpus(void)
{
	const struct ec_ioc_cycle *arg = (void *)fake.arg;
	ec_cycle_config_t config = { .period_ns = 1000000, .flags = EC_CYCLE_DETACH };
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	m = ecrt_request_master(0);
	CHECK(!ecrt_master_set_cycle(m, &config) && arg->cpu == -1);
	config.cpu = -1;
	CHECK(!ecrt_master_set_cycle(m, &config) && arg->cpu == -1);
	config.cpu = 3;
	CHECK(ecrt_master_set_cycle(m, &config) == -EINVAL);
	config.flags |= EC_CYCLE_BIND_CPU;
	CHECK(!ecrt_master_set_cycle(m, &config) && arg->cpu == 3);
	CHECK(arg->flags == EC_CYCLE_FLAG_DETACH);
	config.cpu = 0;
	CHECK(!ecrt_master_set_cycle(m, &config) && arg->cpu == 0);
	config.cpu = -1;
	CHECK(ecrt_master_set_cycle(m, &config) == -EINVAL);
	CHECK(!ecrt_master_set_cycle(m, NULL) && arg->cpu == -1);
	ecrt_release_master(m);
}

/* Commands before activation carry what they were told. */
static void divisions_and_copies(void)
{
	const struct ec_ioc_division *div = (void *)fake.arg;
	const struct ec_ioc_copy *copy = (void *)fake.arg;
	ec_domain_t *d[2];
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	m = ecrt_request_master(0);
	d[0] = ecrt_master_create_domain(m);
	d[1] = ecrt_master_create_domain(m);
	CHECK(!ecrt_domain_set_division(d[1], 10, 3) && fake.last == EC_IOC_DIVISION);
	CHECK(div->domain == 1 && div->division == 10 && div->phase == 3);
	CHECK(!ecrt_domain_copy(d[1], 5, 3, d[0], 7, 1, 12) && fake.last == EC_IOC_COPY);
	CHECK(copy->to_domain == 1 && copy->to_bit == 43 && copy->from_domain == 0 &&
	      copy->from_bit == 57 && copy->bits == 12);
	CHECK(ecrt_domain_copy(d[1], ~0U, 0, d[0], 0, 0, 1) == -EINVAL);
	fake.refuse = EC_IOC_COPY;
	fake.err = EEXIST;
	CHECK(ecrt_domain_copy(d[1], 0, 0, d[0], 0, 0, 1) == -EEXIST);
	CHECK(ecrt_domain_copy(NULL, 0, 0, d[0], 0, 0, 1) == -EINVAL);
	CHECK(ecrt_domain_set_division(NULL, 1, 0) == -EINVAL);
	ecrt_release_master(m);
}

/* Requests are counted where the kernel looks; one that runs is waited for. */
static void requests(void)
{
	ec_cycle_config_t config = { .period_ns = 1000000 };
	struct ec_request_area *area;
	struct ec_request_record *rec;
	ec_sdo_request_t *r[2];
	ec_slave_config_t *sc;
	unsigned int calls;
	ec_master_t *m;

	memset(&fake, 0, sizeof(fake));
	fake.running = 3;
	fake.exchange_size = 4096 * 2;
	fake.stride = STRIDE;
	m = ecrt_request_master(0);
	sc = ecrt_master_slave_config(m, 0, 0, 1, 2);
	r[0] = ecrt_slave_config_create_sdo_request(sc, 0x8000, 1, 4);
	r[1] = ecrt_slave_config_create_sdo_request(sc, 0x8000, 2, 4);
	CHECK(!ecrt_master_set_cycle(m, &config) && !ecrt_master_activate(m));
	calls = fake.calls;
	area = (void *)fake.area;
	rec = fake_request(fake.area, 0);
	CHECK(ecrt_sdo_request_state(r[0]) == EC_REQUEST_BUSY);
	CHECK(ecrt_sdo_request_read(r[0]) == -EBUSY && area->starts == 0);
	rec->done = 3;
	CHECK(ecrt_sdo_request_state(r[0]) == EC_REQUEST_SUCCESS);
	CHECK(!ecrt_sdo_request_read(r[0]) && rec->start == 4 && area->starts == 1);
	CHECK(!ecrt_sdo_request_read(r[1]) && area->starts == 2);
	CHECK(fake.calls == calls);
	ecrt_release_master(m);
}

/* Both sides at once: nothing torn, nothing older than before, no system call. */
static void together(void)
{
	ec_domain_t *d[2];
	ec_master_t *m = start(d, 0);
	unsigned char *data[2] = { ecrt_domain_data(d[0]), ecrt_domain_data(d[1]) };
	unsigned long torn = 0, backwards = 0, fresh = 0;
	unsigned int calls = fake.calls, last = 0;
	time_t end = time(NULL) + LIMIT_S;
	struct kernel k = { 0 };
	ec_domain_state_t st;
	pthread_t thread;

	if (pthread_create(&thread, NULL, kernel, &k))
		abort();
	for (unsigned int i = 0; (fresh < ENOUGH || taken(&k) < ENOUGH) && time(NULL) < end; i++) {
		ecrt_master_receive(m);
		ecrt_domain_process(d[0]);
		ecrt_domain_process(d[1]);
		ecrt_domain_state(d[0], &st);
		torn += equal8(data[0] + 8) < 0 || equal8(data[1] + 8) != data[0][8] ||
			(st.working_counter & 0xff) != data[0][8];
		backwards += st.working_counter < last;
		fresh += st.working_counter != last;
		last = st.working_counter;
		memset(data[0], (int)i, 8);
		memset(data[1], (int)i + 1, 8);
		ecrt_domain_queue(d[0]);
		if (i % 2)
			ecrt_domain_queue(d[1]);
		ecrt_master_send(m);
	}
	k.stop = 1;
	pthread_join(thread, NULL);
	CHECK(!torn && !backwards && !k.torn);
	CHECK(fresh >= ENOUGH && k.taken >= ENOUGH);
	CHECK(fake.calls == calls);
	ecrt_release_master(m);
}

int kernel_cycle(void)
{
	CHECK(ecrt_master_set_cycle(NULL, NULL) == -EINVAL);
	CHECK(ecrt_master_wait_cycle(NULL, 0) == -EINVAL);
	CHECK(ecrt_master_cycle_fd(NULL) == -EINVAL);
	CHECK(ecrt_master_cycle_count(NULL) == 0);
	CHECK(ecrt_master_cycle_state(NULL, NULL) == -EINVAL);
	CHECK(ecrt_master_cycle_inputs(NULL, NULL, NULL) == -EINVAL);
	CHECK(ecrt_master_end_detached(NULL) == -EINVAL);
	cpus();
	steps();
	numbers();
	halts();
	takeover();
	takeover_fails();
	requests();
	divisions_and_copies();
	together();
	return failures;
}
