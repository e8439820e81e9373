// SPDX-License-Identifier: LGPL-2.1-or-later
/* The cycle: inputs to outputs, axes, and what is measured on the way. */
#include "demo.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <uapi/ethercat.h>

#define NS_PER_S	1000000000LL
#define STOP_CYCLES	100
#define DI_BACK		4	/* digital input wired to output 1 */

const unsigned int period_edges[PERIODS - 1] = {
	50, 80, 90, 95, 98, 99, 101, 102, 105, 110, 120, 150, 200, 400,
};

volatile sig_atomic_t stopped;

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * NS_PER_S + t.tv_nsec;
}

/* process data --------------------------------------------------------------*/

static bool bit_get(const struct point *p, const uint8_t *data)
{
	return EC_READ_BIT(data + p->byte, p->bit);
}

static void copy_bits(struct demo *d, uint8_t *data, bool measure, bool still)
{
	static bool in[BITS_MAX];
	static bool valid;
	unsigned int i;
	bool now;

	for (i = 0; i < d->n_do && i < d->n_di; i++) {
		/* what the last cycle wrote must still be there */
		if (measure && valid)
			d->do_mismatches += bit_get(&d->dout[i], data) != in[i];
		now = bit_get(&d->di[i], data);
		if (measure && valid)
			d->di_changes += now != in[i];
		in[i] = now;
		EC_WRITE_BIT(data + d->dout[i].byte, d->dout[i].bit, now);
	}
	valid = true;
	if (measure && d->wired)
		trace_add(&d->digital, in[0], bit_get(&d->di[DI_BACK], data), still);
}

static void copy_analog(struct demo *d, uint8_t *data, bool measure, bool still)
{
	static int16_t last;
	static bool valid;
	int16_t in, out;

	if (!d->ai.bits)
		return;
	in = EC_READ_S16(data + d->ai.byte);
	out = in;
	if (d->ao.bits) {
		out = EC_READ_S16(data + d->ao.byte);
		EC_WRITE_S16(data + d->ao.byte, in);
		d->rb.recent[d->rb.head % RECENT] = in;
		d->rb.head++;
	}
	if (measure) {
		if (d->ao.bits && valid)
			d->ao_mismatches += out != last;
		trace_add(&d->analog, in, d->wired ?
			  EC_READ_S16(data + d->ai_back.byte) : out, still);
	}
	last = in;
	valid = true;
}

enum phase { START, RUN, STOP };

/* @t_s: when this cycle should have begun, since the first measured one */
static void exchange(struct demo *d, ec_master_t *m, ec_domain_t *domain,
		     uint8_t *data, enum phase phase, double t_s)
{
	double dt = d->period_us / 1e6, run = d->cycles * dt;
	double turn = run / 2 > 1 ? run / 2 : 1;
	bool still = d->excuse && still_lately(now_ns());
	unsigned int i, errors = d->call_errors;
	ec_domain_state_t state;

	d->call_errors += !!ecrt_master_receive(m);
	d->call_errors += !!ecrt_domain_process(domain);
	ecrt_domain_state(domain, &state);
	if (phase == RUN && state.wc_state != EC_WC_COMPLETE) {
		d->wc_errors++;
		d->wc_still += still;
	}
	copy_bits(d, data, phase == RUN, still);
	copy_analog(d, data, phase == RUN, still);
	for (i = 0; i < d->n_axes; i++)
		axis_cycle(&d->axes[i], data,
			   phase != STOP && d->operational == d->slaves,
			   phase == RUN ? t_s : -1, dt, turn);
	if (phase == RUN)
		d->done++;
	d->call_errors += !!ecrt_domain_queue(domain);
	d->call_errors += !!ecrt_master_send(m);
	if (still)
		d->call_still += d->call_errors - errors;
}

/* time ----------------------------------------------------------------------*/

static void count_late(struct demo *d, double late_us)
{
	unsigned int i = 0;

	while (i < BUCKETS - 1 && late_us >= (double)(1u << i))
		i++;
	d->buckets[i]++;
	d->late_sum_us += late_us;
	if (late_us > d->late_max_us)
		d->late_max_us = late_us;
}

static void count_period(struct demo *d, double us)
{
	unsigned int i = 0;

	while (i < PERIODS - 1 && us * 100 >= (double)period_edges[i] * d->period_us)
		i++;
	d->periods[i]++;
	if (!d->period_max_us || us < d->period_min_us)
		d->period_min_us = us;
	if (us > d->period_max_us)
		d->period_max_us = us;
}

/*
 * Sleeps until the next cycle shall begin. Absolute: what one cycle is late is
 * not added to the next. Return: when it did begin.
 */
static long long next_cycle(struct demo *d, long long *at, bool measure)
{
	long long period = d->period_us * 1000LL, now, late;
	struct timespec t;

	*at += period;
	t.tv_sec = *at / NS_PER_S;
	t.tv_nsec = *at % NS_PER_S;
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) ==
	       EINTR && !stopped)
		;
	now = now_ns();
	late = now > *at ? now - *at : 0;
	if (measure) {
		count_late(d, (double)late / 1000);
		d->overruns += (unsigned int)(late / period);
	}
	*at += late / period * period;
	return now;
}

/* phases --------------------------------------------------------------------*/

static bool all_operational(struct demo *d)
{
	ec_slave_config_state_t state;
	unsigned int i;

	d->operational = 0;
	for (i = 0; i < d->slaves; i++)
		if (!ecrt_slave_config_state(d->sc[i], &state))
			d->operational += state.operational;
	return d->operational == d->slaves;
}

static bool all_enabled(const struct demo *d)
{
	unsigned int i;

	for (i = 0; i < d->n_axes; i++)
		if (!d->axes[i].enabled)
			return false;
	return true;
}

/* Frames the master has missed since it got its device. */
static bool frames_lost(const struct demo *d, unsigned long long *lost)
{
	struct ec_ioc_device device;
	unsigned int i;
	char path[40];
	int fd;

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", d->index);
	fd = open(path, O_RDONLY | O_CLOEXEC);
	if (fd < 0)
		return false;
	*lost = 0;
	for (i = 0; i < EC_UAPI_DEVICES; i++) {
		memset(&device, 0, sizeof(device));
		device.index = i;
		if (ioctl(fd, EC_IOC_DEVICE, &device))
			break;
		*lost += device.lost;
	}
	close(fd);
	return i;
}

/*
 * The phase after this cycle. What may page-fault or print is done between
 * phases only; asking for the states costs no system call.
 */
static enum phase next_phase(struct demo *d, enum phase phase, long long begin)
{
	static unsigned long long lost;
	unsigned long long now = 0;

	if (phase == START && all_operational(d) && all_enabled(d)) {
		d->startup_s = (double)(now_ns() - begin) / NS_PER_S;
		d->lost_known = frames_lost(d, &lost);
		return RUN;
	}
	if (phase == START && !stopped &&
	    now_ns() - begin <= d->wait_s * NS_PER_S)
		return START;
	if (phase == RUN && !stopped && d->done < d->cycles)
		return RUN;
	if (phase != STOP) {
		d->all_op = all_operational(d);
		d->axes_enabled = all_enabled(d);
		d->end_still = d->excuse && still_lately(now_ns());
	}
	if (phase == RUN) {
		d->lost_known &= frames_lost(d, &now);
		d->lost = now - lost;
	}
	return STOP;
}

/* Cycles until everything is in OP, then measures, then lets the axes rest. */
void cycle_run(struct demo *d, ec_master_t *m, ec_domain_t *domain,
	       uint8_t *data)
{
	long long begin = now_ns(), at = begin, first = 0, started, last = 0;
	enum phase phase = START, next;
	unsigned int stopping = 0;
	bool reading = false;
	pthread_t reader;

	while (stopping < STOP_CYCLES) {
		started = next_cycle(d, &at, phase == RUN);
		if (last)
			count_period(d, (double)(started - last) / 1000);
		first = d->done ? first : at;
		exchange(d, m, domain, data, phase,
			 (double)(at - first) / NS_PER_S);
		next = next_phase(d, phase, begin);
		/* a change of phase takes its time: not measured */
		last = phase == RUN && next == RUN ? started : 0;
		if (next == RUN && phase != RUN) {
			d->rb.run = d->ai.bits && d->ao.bits;
			reading = d->rb.run && readback_start(&d->rb, &reader);
			at = now_ns();
		} else if (next == STOP) {
			d->rb.run = false;
			stopping++;
		}
		phase = next;
	}
	if (reading)
		pthread_join(reader, NULL);
}
