/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * 64-bit values that one thread writes and others read without a lock. READ_ONCE() and
 * WRITE_ONCE() take two accesses on a 32-bit kernel, and half of each of two values is
 * a time that is 4 seconds off.
 */
#ifndef EC_ONCE64_H
#define EC_ONCE64_H

#include <linux/atomic.h>
#include <linux/compiler.h>
#include <linux/irqflags.h>
#include <linux/processor.h>
#include <linux/string.h>
#include <linux/types.h>
#include "ethercat_map.h"

/**
 * ec_read64() - read a value that another thread may write
 * @v: an aligned_u64 that is written by ec_write64() only
 *
 * Context: Any. RT-safe.
 * Return: one of the values that were written.
 */
static inline u64 ec_read64(const u64 *v)
{
	if (BITS_PER_LONG == 64)
		return READ_ONCE(*v);
	return atomic64_read((const atomic64_t *)v);
}

/**
 * ec_write64() - write a value that another thread may read
 * @v: an aligned_u64 that is read by ec_read64()
 * @to: value
 *
 * Context: Any. RT-safe.
 */
static inline void ec_write64(u64 *v, u64 to)
{
	if (BITS_PER_LONG == 64)
		WRITE_ONCE(*v, to);
	else
		atomic64_set((atomic64_t *)v, to);
}

/**
 * ec_status_begin() - write 64-bit values of the status page from now on
 * @st: status page of an active session
 *
 * Readers that read such a value in two parts try again until ec_status_end(). On this CPU
 * such a reader would wait forever: interrupts are off, so that neither an interrupt nor a
 * thread of a higher priority reads meanwhile.
 *
 * Context: The cycle owner. RT-safe.
 * Return: for ec_status_end().
 */
static __always_inline unsigned long ec_status_begin(struct ec_status *st)
{
	unsigned long flags;

	local_irq_save(flags);
	WRITE_ONCE(st->sequence, st->sequence + 1);
	/* the uneven number before the data, as in ec_status_copy() */
	smp_wmb();
	return flags;
}

/**
 * ec_status_end() - the values are written
 * @st: as for ec_status_begin()
 * @flags: from there
 *
 * Context: As ec_status_begin().
 */
static __always_inline void ec_status_end(struct ec_status *st, unsigned long flags)
{
	/* the data before the even number, as in ec_status_copy() */
	smp_wmb();
	WRITE_ONCE(st->sequence, st->sequence + 1);
	local_irq_restore(flags);
}

/**
 * ec_status_add() - add to a 64-bit value of the status page
 * @st: status page of an active session
 * @v: value in it
 * @n: how much
 *
 * Context: As ec_status_begin().
 */
static inline void ec_status_add(struct ec_status *st, __u64 *v, u64 n)
{
	unsigned long flags = ec_status_begin(st);

	WRITE_ONCE(*v, *v + n);
	ec_status_end(st, flags);
}

/**
 * ec_status_copy() - read from the status page
 * @st: status page of an active session
 * @to: gets values of one moment
 * @from: values in the page
 * @size: their bytes
 *
 * Context: Any. RT-safe: waits for a few stores at most.
 */
static inline void ec_status_copy(const struct ec_status *st, void *to, const void *from,
				  size_t size)
{
	u32 sequence;

	do {
		/* the number before the data, and after them: see ec_status_begin() */
		while ((sequence = smp_load_acquire(&st->sequence)) & 1)
			cpu_relax();
		/* what a writer has changed meanwhile is read again */
		data_race(memcpy(to, from, size));
		/* as above */
		smp_rmb();
	} while (READ_ONCE(st->sequence) != sequence);
}

#endif
