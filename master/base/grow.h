/* SPDX-License-Identifier: GPL-2.0-only */
/* Arrays that grow by one entry at a time. */
#ifndef EC_GROW_H
#define EC_GROW_H

#include <linux/log2.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include <linux/string.h>

/**
 * ec_grow() - enlarge an array for one more entry if it is full
 * @array: array that only this function has allocated, or NULL
 * @n: entries in it
 * @size: bytes of an entry
 *
 * The array doubles. It need not be contiguous in physical memory, so it grows on a
 * fragmented machine as well. Free it with kvfree().
 *
 * Context: Process. May sleep.
 * Return: the array, large enough for entry @n; NULL without memory, then @array is
 * unchanged.
 */
static inline void *ec_grow(void *array, size_t n, size_t size)
{
	void *larger;

	/* full with 0, 1, 2, 4... entries */
	if (n && !is_power_of_2(n))
		return array;
	larger = kvmalloc_array(n ? 2 * n : 1, size, GFP_KERNEL_ACCOUNT);
	if (!larger)
		return NULL;
	if (n)
		memcpy(larger, array, n * size);
	kvfree(array);
	return larger;
}

#endif
