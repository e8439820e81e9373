// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/*
 * The kernel runs the cycle. The data of the domains are memory of the application, so that
 * their address stays; whole domains are copied from and to the buffers that are
 * exchanged with the thread of the cycle (struct ec_exchange).
 */
#include "ecrt_int.h"

#define DIR_INPUT	2	/* struct ec_ioc_domain_fmmu.dir */
#define INDEX_MASK	3U

/* the numbers of the states are the kernel's */
_Static_assert((int)EC_CYCLE_WAITING == EC_CYCLE_STATE_WAITING, "state");
_Static_assert(EC_CYCLE_DETACH == EC_CYCLE_FLAG_DETACH, "flags");
_Static_assert(EC_CYCLE_WAIT_OUTPUTS == EC_CYCLE_FLAG_WAIT, "flags");
_Static_assert(EC_CYCLE_INTERRUPT == EC_CYCLE_FLAG_INTERRUPT, "flags");
_Static_assert(!(EC_CYCLE_BIND_CPU & EC_CYCLE_FLAG_ALL), "flags");	/* the library's own */
_Static_assert((int)EC_CYCLE_STOP == EC_STALL_STOP, "stall");
_Static_assert(EC_CYCLE_SYNC_REFERENCE == EC_SEND_FLAG_SYNC_REF, "clock flags");
_Static_assert(EC_CYCLE_SYNC_SLAVES == EC_SEND_FLAG_SYNC_SLAVES, "clock flags");
_Static_assert(EC_CYCLE_REFERENCE_TIME == EC_SEND_FLAG_REF_TIME, "clock flags");
_Static_assert(EC_CYCLE_SYNC_MONITOR == EC_SEND_FLAG_MONITOR, "clock flags");

_Static_assert(EC_CYCLE_FOLLOW_REFERENCE == EC_CYCLE_DC_FOLLOW, "clock flags");
_Static_assert((int)EC_CYCLE_HOLDING == EC_CYCLE_LOCK_HOLD, "lock");

int ecrt_master_set_cycle(ec_master_t *master, const ec_cycle_config_t *config)
{
	struct ec_ioc_cycle arg = { .cpu = -1 };
	bool bind;

	if (!master)
		return -EINVAL;
	if (config) {
		if (!config->period_ns)
			return ec_fail(master, -EINVAL, "set a cycle of 0 ns");
		bind = config->flags & EC_CYCLE_BIND_CPU;
		if (bind ? config->cpu < 0 : config->cpu > 0)
			return ec_fail(master, -EINVAL, "set a cycle on CPU %d %s EC_CYCLE_BIND_CPU",
				       config->cpu, bind ? "with" : "without");
		arg.period_ns = config->period_ns;
		arg.phase_ns = config->phase_ns;
		arg.cpu = bind ? config->cpu : -1;
		arg.priority = config->priority;
		arg.stall = (__u32)config->stall;
		arg.stall_cycles = config->stall_cycles;
		arg.dc = config->dc;
		arg.flags = config->flags & ~EC_CYCLE_BIND_CPU;
	}
	return ec_do(master, EC_IOC_CYCLE, &arg, "let the kernel run the cycle");
}
EXPORT_SYMBOL_GPL(ecrt_master_set_cycle);

int ecrt_master_end_detached(ec_master_t *master)
{
	return ec_do(master, EC_IOC_END_DETACHED, NULL, "end the detached session");
}
EXPORT_SYMBOL_GPL(ecrt_master_end_detached);

int ecrt_domain_set_division(ec_domain_t *domain, unsigned int division,
			     unsigned int phase)
{
	struct ec_ioc_division arg = { .division = division, .phase = phase };

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	return ec_do(ec_domain_master(domain), EC_IOC_DIVISION, &arg,
		     "set the division of domain %u", domain->index);
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_division);

/* Bit in a domain; domains are far smaller than 2^28 bytes. */
static int bit_of(unsigned int offset, unsigned int bit, __u32 *result)
{
	if (offset >= EC_U32_MAX / 16 || bit >= EC_U32_MAX / 16)
		return -EINVAL;
	*result = 8 * offset + bit;
	return 0;
}

int ecrt_domain_copy(ec_domain_t *to, unsigned int to_offset, unsigned int to_bit,
		     const ec_domain_t *from, unsigned int from_offset,
		     unsigned int from_bit, unsigned int bits)
{
	struct ec_ioc_copy arg = { .bits = bits };

	if (!to || !from || ec_domain_master(to) != ec_domain_master(from))
		return -EINVAL;
	arg.to_domain = to->index;
	arg.from_domain = from->index;
	if (bit_of(to_offset, to_bit, &arg.to_bit) ||
	    bit_of(from_offset, from_bit, &arg.from_bit))
		return ec_fail(ec_domain_master(to), -EINVAL, "copy to byte %u from byte %u",
			       to_offset, from_offset);
	return ec_do(ec_domain_master(to), EC_IOC_COPY, &arg,
		     "copy %u bits from domain %u to domain %u", bits, from->index, to->index);
}
EXPORT_SYMBOL_GPL(ecrt_domain_copy);

/* exchange -----------------------------------------------------------------*/

static struct ec_exchange_buffer *buffer(const struct ec_app_cycle *a, unsigned int n)
{
	return (void *)((__u8 *)a->exchange + EC_EXCHANGE_FIRST + (size_t)n * a->stride);
}

/* Where a domain lies in a buffer. */
static __u8 *place(const struct ec_app_cycle *a, const struct ec_domain *d, unsigned int n)
{
	return (__u8 *)(buffer(a, n) + 1) + d->offset;
}

/**
 * ec_exchange_begin() - the cycle that the kernel runs has begun
 * @a: cycle of the application
 * @x: memory of the exchange
 * @size: its bytes
 * @st: status page
 *
 * Return: 0; -EPROTO the kernel has another layout of @x.
 */
int ec_exchange_begin(struct ec_app_cycle *a, struct ec_exchange *x, size_t size,
		      const struct ec_status *st)
{
	a->exchange = x;
	a->stride = ec_status_read(x->stride);
	if (a->stride < sizeof(struct ec_exchange_buffer) ||
	    EC_EXCHANGE_FIRST + 2ULL * EC_EXCHANGE_BUFFERS * a->stride > size)
		return -EPROTO;
	a->out_back = ec_status_read(x->app_output);
	a->out_last = a->out_back;
	a->unseen = 0;
	a->in_front = ec_status_read(x->app_input);
	a->in_taken = false;
	a->seen = ec_status_read64(st, &st->kernel.cycle);
	return a->out_back < EC_EXCHANGE_BUFFERS && a->in_front < EC_EXCHANGE_BUFFERS ? 0 : -EPROTO;
}

static int get_fmmu(const struct ec_domain *d, __u32 i, struct ec_input *in)
{
	struct ec_ioc_domain_fmmu arg = { .index = d->index, .fmmu = i };
	int ret = ec_command(ec_domain_master(d), EC_IOC_DOMAIN_FMMU, &arg);

	if (ret)
		return ret;
	if (arg.offset > d->size || arg.size > d->size - arg.offset)
		return -EPROTO;
	*in = (struct ec_input){ .offset = arg.offset, .count = 1,
				 .size = arg.dir == DIR_INPUT ? arg.size : 0 };
	return 0;
}

/* Slaves of a kind in a row have their inputs at equal distances: one loop copies all. */
static void add_input(struct ec_domain *d, const struct ec_input *in)
{
	struct ec_input *last = d->n_inputs ? &d->inputs[d->n_inputs - 1] : NULL;
	unsigned int distance = last ? in->offset - last->offset : 0;

	if (!in->size)
		return;
	if (last && last->size == in->size && in->offset > last->offset &&
	    (last->count == 1 || distance == last->count * last->stride)) {
		if (last->count++ == 1)
			last->stride = distance;
		return;
	}
	d->inputs[d->n_inputs++] = *in;
}

/**
 * ec_exchange_add() - add a domain to the exchange
 * @d: domain; its data get the values of the running cycle
 *
 * Finds its inputs; the application writes the rest of its data.
 *
 * Return: 0; -EPROTO it does not fit a buffer; -ENOMEM.
 */
int ec_exchange_add(struct ec_domain *d)
{
	const struct ec_app_cycle *a = ec_app_cycle(ec_domain_master(d));
	struct ec_ioc_domain info = { .index = d->index };
	struct ec_input side = { .count = 1 }, in;
	int ret = ec_command(ec_domain_master(d), EC_IOC_DOMAIN, &info);
	__u32 i;

	if (ret)
		return ret;
	if (d->offset + d->size > a->stride - sizeof(struct ec_exchange_buffer))
		return -EPROTO;
	/* the present outputs and inputs of a cycle that runs already */
	if (d->size)
		memcpy(d->data, place(a, d, a->out_back), d->size);
	d->n_inputs = 0;
	d->inputs = ec_zalloc((info.fmmu_count + 1UL) * sizeof(*d->inputs));
	if (!d->inputs)
		return -ENOMEM;
	for (i = 0; i < info.fmmu_count; i++) {
		ret = get_fmmu(d, i, &in);
		if (ret)
			return ret;
		if (in.size && side.offset + side.size == in.offset) {
			side.size += in.size;
			continue;
		}
		add_input(d, &side);
		side = in;
	}
	add_input(d, &side);
	return 0;
}

/* cycle --------------------------------------------------------------------*/

/* Exchange a used buffer for the one that a word names. */
static unsigned int swap_buffer(__u32 *word, __u32 mine)
{
	__u32 n = ec_exchange_word(word, mine) & INDEX_MASK;

	return n < EC_EXCHANGE_BUFFERS ? n : 0;
}

/* Pass the outputs; their domains are given again if no cycle has taken the ones before. */
static unsigned int pass_buffer(struct ec_app_cycle *a)
{
	__u32 word = ec_exchange_word(&a->exchange->outputs, a->out_back | EC_EXCHANGE_NEW);
	unsigned int n = (word & INDEX_MASK) < EC_EXCHANGE_BUFFERS ? word & INDEX_MASK : 0;

	a->unseen = word & EC_EXCHANGE_NEW ? buffer(a, n)->fed : 0;
	return n;
}

/* Why no more inputs arrive, or none for now; 0: they do. */
static int halted(const struct ec_status *st)
{
	if (ec_status_read(st->kernel.state) == EC_CYCLE_STATE_STOPPED)
		return -ECANCELED;
	return ec_status_read(st->no_device) ? -ENODEV : 0;
}

/* The end of the cycle, also for callers that check nothing but working counters. */
static void nothing_back(ec_master_t *m)
{
	struct ec_domain *d;

	ec_for_each_app_domain(m, d) {
		d->snap.working_counter = 0;
		d->snap.wc_state = 0;
	}
	ec_app_cycle(m)->received = 0;
}

/**
 * ec_exchange_receive() - take the newest inputs
 * @m: active master whose cycle the kernel runs
 * @st: its status page
 *
 * Without new ones there is nothing to process.
 *
 * Return: as ecrt_master_receive().
 */
int ec_exchange_receive(ec_master_t *m, const struct ec_status *st)
{
	struct ec_app_cycle *a = ec_app_cycle(m);
	int ret = halted(st);

	if (ret == -ECANCELED) {
		nothing_back(m);
		return ret;
	}
	if (!(ec_status_read(a->exchange->inputs) & EC_EXCHANGE_NEW))
		return ret;
	a->in_front = swap_buffer(&a->exchange->inputs, a->in_front);
	a->in_taken = true;
	a->received = ~0ULL;
	return ret;
}

/*
 * Values of one size, the first and the last @part bytes of each; they may overlap.
 * With a constant @part that is four moves, less than a call of memcpy().
 */
static inline void copy_parts(__u8 *to, const __u8 *from, const struct ec_input *in,
			      size_t part)
{
	const size_t at_last = in->size - part, stride = in->stride;
	unsigned int left = in->count;
	__u8 first[16], last[16];

	for (; left; left--, to += stride, from += stride) {
		memcpy(first, from, part);
		memcpy(last, from + at_last, part);
		memcpy(to, first, part);
		memcpy(to + at_last, last, part);
	}
}

static void copy_inputs(__u8 *to, const __u8 *from, const struct ec_input *in)
{
	unsigned int i;

	to += in->offset;
	from += in->offset;
	if (in->size >= 16 && in->size <= 32)
		copy_parts(to, from, in, 16);
	else if (in->size >= 8 && in->size <= 16)
		copy_parts(to, from, in, 8);
	else if (in->size >= 4 && in->size <= 8)
		copy_parts(to, from, in, 4);
	else
		for (i = 0; i < in->count; i++, to += in->stride, from += in->stride)
			memcpy(to, from, in->size);
}

/* ecrt_domain_process() for a cycle that the kernel runs */
void ec_exchange_process(struct ec_domain *d)
{
	const struct ec_app_cycle *a = ec_app_cycle(ec_domain_master(d));
	unsigned int n = EC_EXCHANGE_BUFFERS + a->in_front, i;
	const __u8 *from = place(a, d, n);

	for (i = 0; i < d->n_inputs; i++)
		copy_inputs(d->data, from, &d->inputs[i]);
	d->snap = buffer(a, n)->domains[d->index];
}

/* ecrt_domain_queue() for a cycle that the kernel runs */
void ec_exchange_queue(struct ec_domain *d)
{
	const struct ec_app_cycle *a = ec_app_cycle(ec_domain_master(d));

	if (d->size)
		memcpy(place(a, d, a->out_back), d->data, d->size);
}

/**
 * ec_exchange_send() - pass the outputs of the queued domains
 * @m: active master whose cycle the kernel runs
 * @st: its status page
 *
 * Domains that are not queued keep their previous outputs. These are still in the
 * buffer that was passed last, since the kernel returns it only for the next one.
 *
 * Return: as ecrt_master_send().
 */
int ec_exchange_send(ec_master_t *m, const struct ec_status *st)
{
	struct ec_app_cycle *a = ec_app_cycle(m);
	int ret = halted(st);
	struct ec_domain *d;

	if (!a->next.queued)
		return ret;
	ec_for_each_app_domain(m, d)
		if (!(a->next.queued >> d->index & 1) && d->size && a->out_last != a->out_back)
			memcpy(place(a, d, a->out_back), place(a, d, a->out_last), d->size);
	buffer(a, a->out_back)->fed = a->next.queued | a->unseen;
	a->out_last = a->out_back;
	a->out_back = pass_buffer(a);
	a->next.queued = 0;
	return ret;
}

/* waiting and state --------------------------------------------------------*/

int ecrt_master_wait_cycle(ec_master_t *master, uint32_t timeout_us)
{
	struct ec_ioc_wait arg = { .timeout_us = timeout_us };
	struct ec_app_cycle *a;
	__u64 seen, n;
	int ret;

	if (!ec_run_by_kernel(master))
		return ec_inactive(master);
	a = ec_app_cycle(master);
	seen = ec_read64(&a->seen);
	arg.cycle = seen;
	ret = ec_command(master, EC_IOC_WAIT, &arg);
	if (ret)
		return ret;
	n = arg.cycle - seen;
	/* another thread may have got a later one meanwhile */
	if (arg.cycle > ec_read64(&a->seen))
		ec_write64(&a->seen, arg.cycle);
	return n > INT_MAX ? INT_MAX : (int)n;
}
EXPORT_SYMBOL_GPL(ecrt_master_wait_cycle);

uint64_t ecrt_master_cycle_count(const ec_master_t *master)
{
	const struct ec_status *st = ec_active_status(master);

	return st && ec_run_by_kernel(master) ? ec_status_read64(st, &st->kernel.cycle) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_cycle_count);

int ecrt_master_cycle_inputs(const ec_master_t *master, uint64_t *cycle, uint64_t *time_ns)
{
	const struct ec_exchange_buffer *b;
	const struct ec_app_cycle *a;

	if (!ec_run_by_kernel(master))
		return ec_inactive(master);
	a = ec_app_cycle(master);
	if (!a->in_taken)
		return -ENODATA;
	b = buffer(a, EC_EXCHANGE_BUFFERS + a->in_front);
	if (cycle)
		*cycle = b->cycle;
	if (time_ns)
		*time_ns = b->time_ns;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_cycle_inputs);

/* Where a bucket begins, ns; as described at EC_CYCLE_BUCKETS. */
static __u64 bucket_from(unsigned int n)
{
	return n < 8 ? n : (8ULL + n % 8) << (n / 8 - 1);
}

/* The bin of a bucket: number of bits of its times. */
static unsigned int bin(unsigned int n)
{
	if (n >= 8)
		n = n / 8 + 3;
	else if (n >= 2)
		n = n < 4 ? 2 : 3;
	return n < EC_CYCLE_BINS ? n : EC_CYCLE_BINS - 1;
}

static __u32 mean(__u64 sum, __u64 count)
{
	return count ? (__u32)ec_div64(sum, count) : 0;
}

static void read_late(const struct ec_status *status, ec_cycle_state_t *state)
{
	const __u64 *late = status->kernel.late;
	__u64 count = 0, above = 0, most, n;
	unsigned int i;

	for (i = 0; i < EC_CYCLE_BUCKETS; i++) {
		n = ec_status_read64(status, &late[i]);
		state->late[bin(i)] += n;
		count += n;
	}
	/* down from the last one, until more than 0.1 % are above */
	most = ec_div64(count, 1000);
	for (i = EC_CYCLE_BUCKETS; i && above <= most; i--)
		above += ec_status_read64(status, &late[i - 1]);
	state->late_p999 = count ? (__u32)(bucket_from(i + 1) - 1) : 0;
	if (state->late_p999 > state->late_max)
		state->late_p999 = state->late_max;
}

int ecrt_master_cycle_state(const ec_master_t *master, ec_cycle_state_t *state)
{
	const struct ec_status *page = ec_active_status(master);
	const struct ec_status_cycle *st;

	if (!page)
		return ec_inactive(master);
	if (!state)
		return -EINVAL;
	memset(state, 0, sizeof(*state));
	st = &page->kernel;
	state->run = (ec_cycle_run_t)ec_status_read(st->state);
	state->cycles = ec_status_read64(page, &st->cycle);
	state->overruns = ec_status_read64(page, &st->overruns);
	state->missed = ec_status_read64(page, &st->missed);
	state->late_min = ec_status_read(st->late_min);
	state->late_max = ec_status_read(st->late_max);
	state->late_mean = mean(ec_status_read64(page, &st->late_sum),
				ec_status_read64(page, &st->late_count));
	state->work_last = ec_status_read(st->work_ns);
	state->work_max = ec_status_read(st->work_max);
	state->work_mean = mean(ec_status_read64(page, &st->work_sum),
				ec_status_read64(page, &st->work_count));
	read_late(page, state);
	state->lock = (ec_cycle_lock_t)ec_status_read(st->lock);
	state->lock_losses = ec_status_read(st->lock_losses);
	state->phase_error = ec_status_read(st->phase_error);
	state->rate_ppb = ec_status_read(st->rate_ppb);
	state->takeovers = ec_status_read(st->takeovers);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_cycle_state);
