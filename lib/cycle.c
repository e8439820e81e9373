// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * The kernel runs the cycle. The domains' data are memory of our own, so that
 * they stand still; whole domains are copied from and to the buffers that are
 * exchanged with the kernel (struct ec_exchange).
 */
#include <string.h>
#include <sys/mman.h>

#include "ecrt/ecrt_int.h"

#define DIR_INPUT	2	/* struct ec_ioc_domain_fmmu.dir */
#define INDEX_MASK	3U

/* the numbers of the states are the kernel's */
_Static_assert((int)EC_CYCLE_WAITING == EC_CYCLE_STATE_WAITING, "state");
_Static_assert(EC_CYCLE_DETACH == EC_CYCLE_FLAG_DETACH, "flags");
_Static_assert(EC_CYCLE_WAIT_OUTPUTS == EC_CYCLE_FLAG_WAIT, "flags");
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
			return ec_fail(NULL, -EINVAL, "set a cycle of 0 ns");
		bind = config->flags & EC_CYCLE_BIND_CPU;
		if (bind ? config->cpu < 0 : config->cpu > 0)
			return ec_fail(NULL, -EINVAL, "set a cycle on CPU %d %s EC_CYCLE_BIND_CPU",
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

int ecrt_master_end_detached(ec_master_t *master)
{
	return ec_do(master, EC_IOC_END_DETACHED, NULL, "end the detached session");
}

int ecrt_domain_set_division(ec_domain_t *domain, unsigned int division,
			     unsigned int phase)
{
	struct ec_ioc_division arg = { .division = division, .phase = phase };

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	return ec_do(domain->master, EC_IOC_DIVISION, &arg, "set the division of domain %u",
				   domain->index);
}

/* Bit in a domain; domains are far smaller than 2^28 bytes. */
static int bit_of(unsigned int offset, unsigned int bit, __u32 *result)
{
	if (offset >= UINT32_MAX / 16 || bit >= UINT32_MAX / 16)
		return -EINVAL;
	*result = 8 * offset + bit;
	return 0;
}

int ecrt_domain_copy(ec_domain_t *to, unsigned int to_offset, unsigned int to_bit,
		     const ec_domain_t *from, unsigned int from_offset,
		     unsigned int from_bit, unsigned int bits)
{
	struct ec_ioc_copy arg = { .bits = bits };

	if (!to || !from || to->master != from->master)
		return -EINVAL;
	arg.to_domain = to->index;
	arg.from_domain = from->index;
	if (bit_of(to_offset, to_bit, &arg.to_bit) ||
	    bit_of(from_offset, from_bit, &arg.from_bit))
		return ec_fail(NULL, -EINVAL, "copy to byte %u from byte %u", to_offset,
			       from_offset);
	return ec_do(to->master, EC_IOC_COPY, &arg, "copy %u bits from domain %u to domain %u",
				   bits, from->index, to->index);
}

/* memory -------------------------------------------------------------------*/

static struct ec_exchange_buffer *buffer(const struct ec_master *m, unsigned int n)
{
	return (void *)((__u8 *)m->exchange + EC_EXCHANGE_FIRST +
			(size_t)n * m->stride);
}

/* Where a domain lies in a buffer. */
static __u8 *place(const struct ec_domain *d, unsigned int n)
{
	return (__u8 *)(buffer(d->master, n) + 1) + d->offset;
}

int ec_cycle_map(struct ec_master *m, const struct ec_ioc_activate *arg)
{
	size_t least = sizeof(struct ec_exchange_buffer);

	m->exchange_size = arg->exchange_size;
	m->exchange = ec_master_map(m, NULL, arg->exchange_size, PROT_READ | PROT_WRITE,
				    EC_MMAP_EXCHANGE);
	if (!m->exchange)
		return -errno;
	m->stride = m->exchange->stride;
	if (m->stride < least || EC_EXCHANGE_FIRST + 2ULL * EC_EXCHANGE_BUFFERS *
	    m->stride > m->exchange_size)
		return -EPROTO;
	m->out_back = m->exchange->app_output;
	m->out_last = m->out_back;
	m->in_front = m->exchange->app_input;
	m->in_taken = false;
	if (m->out_back >= EC_EXCHANGE_BUFFERS || m->in_front >= EC_EXCHANGE_BUFFERS)
		return -EPROTO;
	m->cycle = ec_status_read64(m->status, &m->status->kernel.cycle);
	if (m->image)	/* the application has it already */
		return arg->image_size == m->image_size ? 0 : -EPROTO;
	m->image_size = arg->image_size;
	if (!m->image_size)
		return 0;
	m->image = mmap(NULL, m->image_size, PROT_READ | PROT_WRITE,
			MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
	if (m->image != MAP_FAILED)
		return 0;
	m->image = NULL;
	return -errno;
}

void ec_cycle_unmap(struct ec_master *m)
{
	if (m->exchange)
		munmap(m->exchange, m->exchange_size);
	m->exchange = NULL;
}

static int get_fmmu(const struct ec_domain *d, __u32 i, struct ec_input *in)
{
	struct ec_ioc_domain_fmmu arg = { .index = d->index, .fmmu = i };
	int ret = ec_command(d->master, EC_IOC_DOMAIN_FMMU, &arg);

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

/* What of a domain is input: the rest of its data is the application's. */
int ec_cycle_find_inputs(struct ec_domain *d)
{
	struct ec_ioc_domain info = { .index = d->index };
	struct ec_input side = { .count = 1 }, in;
	int ret = ec_command(d->master, EC_IOC_DOMAIN, &info);
	__u32 i;

	if (ret)
		return ret;
	if (d->offset + d->size > d->master->stride - sizeof(struct ec_exchange_buffer))
		return -EPROTO;
	/* of a cycle that runs already: outputs and inputs as they are */
	if (d->size)
		memcpy(d->data, place(d, d->master->out_back), d->size);
	d->n_inputs = 0;
	d->inputs = calloc(info.fmmu_count + 1UL, sizeof(*d->inputs));
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

/* Exchanges a buffer we are done with for the one named by a word. */
static unsigned int swap_buffer(__u32 *word, __u32 mine)
{
	__u32 n = __atomic_exchange_n(word, mine, __ATOMIC_ACQ_REL) & INDEX_MASK;

	return n < EC_EXCHANGE_BUFFERS ? n : 0;
}

/* Why nothing comes back any more, or for now; 0: it does. */
static int halted(const struct ec_master *m)
{
	if (ec_status_read(m->status->kernel.state) == EC_CYCLE_STATE_STOPPED)
		return -ECANCELED;
	return ec_status_read(m->status->no_device) ? -ENODEV : 0;
}

/* No more cycles: also who looks at working counters only shall see it. */
static void nothing_back(struct ec_master *m)
{
	struct ec_domain *d;

	for (d = m->domains; d; d = d->next) {
		d->snap.working_counter = 0;
		d->snap.wc_state = 0;
	}
	m->received = 0;
}

/* The newest inputs; without new ones there is nothing to process. */
int ec_cycle_receive(struct ec_master *m)
{
	__u32 *word = &m->exchange->inputs;
	int ret = halted(m);

	if (ret == -ECANCELED) {
		nothing_back(m);
		return ret;
	}
	if (!(__atomic_load_n(word, __ATOMIC_RELAXED) & EC_EXCHANGE_NEW))
		return ret;
	m->in_front = swap_buffer(word, m->in_front);
	m->in_taken = true;
	m->received = ~0ULL;
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

void ec_cycle_process(struct ec_domain *d)
{
	unsigned int n = EC_EXCHANGE_BUFFERS + d->master->in_front, i;
	const __u8 *from = place(d, n);

	for (i = 0; i < d->n_inputs; i++)
		copy_inputs(d->data, from, &d->inputs[i]);
	d->snap = buffer(d->master, n)->domains[d->index];
}

void ec_cycle_queue(struct ec_domain *d)
{
	if (d->size)
		memcpy(place(d, d->master->out_back), d->data, d->size);
}

/*
 * Domains that are not queued keep the outputs of before. They are still in the
 * buffer that was given last: it comes back only for the one given now.
 */
int ec_cycle_send(struct ec_master *m)
{
	int ret = halted(m);
	struct ec_domain *d;

	if (!m->next.queued)
		return ret;
	for (d = m->domains; d; d = d->next)
		if (!(m->next.queued >> d->index & 1) && d->size && m->out_last != m->out_back)
			memcpy(place(d, m->out_back), place(d, m->out_last), d->size);
	m->out_last = m->out_back;
	m->out_back = swap_buffer(&m->exchange->outputs, m->out_back | EC_EXCHANGE_NEW);
	m->next.queued = 0;
	return ret;
}

/* waiting ------------------------------------------------------------------*/

static bool runs(const struct ec_master *m)
{
	return m && m->active && m->exchange;
}

int ecrt_master_wait_cycle(ec_master_t *master, uint32_t timeout_us)
{
	struct ec_ioc_wait arg = { .timeout_us = timeout_us };
	__u64 n;
	int ret;

	if (!runs(master))
		return ec_inactive(master);
	arg.cycle = master->cycle;
	ret = ec_command(master, EC_IOC_WAIT, &arg);
	if (ret)
		return ret;
	n = arg.cycle - master->cycle;
	master->cycle = arg.cycle;
	return n > INT32_MAX ? INT32_MAX : (int)n;
}

uint64_t ecrt_master_cycle_count(const ec_master_t *master)
{
	return runs(master) ? ec_status_read64(master->status, &master->status->kernel.cycle) : 0;
}

int ecrt_master_cycle_inputs(const ec_master_t *master, uint64_t *cycle, uint64_t *time_ns)
{
	const struct ec_exchange_buffer *b;

	if (!runs(master))
		return ec_inactive(master);
	if (!master->in_taken)
		return -ENODATA;
	b = buffer(master, EC_EXCHANGE_BUFFERS + master->in_front);
	if (cycle)
		*cycle = b->cycle;
	if (time_ns)
		*time_ns = b->time_ns;
	return 0;
}

int ecrt_master_cycle_fd(const ec_master_t *master)
{
	return runs(master) ? master->fd : ec_inactive(master);
}

/* Where a bucket begins, ns; as described at EC_CYCLE_BUCKETS. */
static __u64 bucket_from(unsigned int n)
{
	return n < 8 ? n : (8ULL + n % 8) << (n / 8 - 1);
}

/* Number of bits of a time: the bin it belongs to. */
static unsigned int bin(__u64 ns)
{
	unsigned int n = ns ? 64 - (unsigned int)__builtin_clzll(ns) : 0;

	return n < EC_CYCLE_BINS ? n : EC_CYCLE_BINS - 1;
}

static void read_late(const struct ec_status *status, ec_cycle_state_t *state)
{
	const __u64 *late = status->kernel.late;
	uint64_t count = 0, above = 0, n;
	unsigned int i;

	for (i = 0; i < EC_CYCLE_BUCKETS; i++) {
		n = ec_status_read64(status, &late[i]);
		state->late[bin(bucket_from(i))] += n;
		count += n;
	}
	/* down from the last one, until more than 0.1 % are above */
	for (i = EC_CYCLE_BUCKETS; i && above <= count / 1000; i--)
		above += ec_status_read64(status, &late[i - 1]);
	state->late_p999 = count ? (uint32_t)(bucket_from(i + 1) - 1) : 0;
	if (state->late_p999 > state->late_max)
		state->late_p999 = state->late_max;
}

int ecrt_master_cycle_state(const ec_master_t *master, ec_cycle_state_t *state)
{
	const struct ec_status_cycle *st;
	uint64_t count, n;

	if (!master || !master->active)
		return ec_inactive(master);
	if (!state)
		return -EINVAL;
	memset(state, 0, sizeof(*state));
	st = &master->status->kernel;
	count = ec_status_read64(master->status, &st->late_count);
	state->run = (ec_cycle_run_t)ec_status_read(st->state);
	state->cycles = ec_status_read64(master->status, &st->cycle);
	state->overruns = ec_status_read64(master->status, &st->overruns);
	state->missed = ec_status_read64(master->status, &st->missed);
	state->late_min = ec_status_read(st->late_min);
	state->late_max = ec_status_read(st->late_max);
	n = ec_status_read64(master->status, &st->late_sum);
	state->late_mean = count ? (uint32_t)(n / count) : 0;
	count = ec_status_read64(master->status, &st->work_count);
	state->work_last = ec_status_read(st->work_ns);
	state->work_max = ec_status_read(st->work_max);
	n = ec_status_read64(master->status, &st->work_sum);
	state->work_mean = count ? (uint32_t)(n / count) : 0;
	read_late(master->status, state);
	state->lock = (ec_cycle_lock_t)ec_status_read(st->lock);
	state->lock_losses = ec_status_read(st->lock_losses);
	state->phase_error = ec_status_read(st->phase_error);
	state->rate_ppb = ec_status_read(st->rate_ppb);
	state->takeovers = ec_status_read(st->takeovers);
	return 0;
}
