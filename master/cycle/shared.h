/* SPDX-License-Identifier: GPL-2.0-only */
/* Memory that an application and the master share. */
#ifndef EC_SHARED_H
#define EC_SHARED_H

#include <linux/atomic.h>
#include <linux/kref.h>
#include <linux/mm.h>
#include "ethercat.h"

/**
 * struct ec_shared - memory mapped by the application; after the session it stays
 * while a mapping exists
 */
struct ec_shared {
	/** @kref: session and mappings */
	struct kref kref;
	/** @image: process image of all domains */
	u8 *image;
	/** @image_size: bytes, multiple of the page size */
	size_t image_size;
	/**
	 * @exchange: struct ec_exchange and its buffers; NULL: the application runs the cycle and
	 * maps the image
	 */
	void *exchange;
	/** @exchange_size: bytes, multiple of the page size */
	size_t exchange_size;
	/** @status: status pages */
	struct ec_status *status;
	/** @requests: struct ec_request_area and what it names, or NULL */
	u8 *requests;
	/** @request_size: bytes, multiple of the page size */
	size_t request_size;
	/** @bytes: of all this memory */
	size_t bytes;
	/** @mapped: of the master, where @bytes are counted */
	atomic_long_t *mapped;
};

#define EC_STATUS_BYTES	PAGE_ALIGN(sizeof(struct ec_status))

struct ec_shared *ec_shared_create(atomic_long_t *mapped, size_t image_size,
				   size_t request_size);
void *ec_shared_alloc(struct ec_shared *sh, size_t size);
int ec_shared_map(struct vm_area_struct *vma, void *memory);
void ec_shared_get(struct ec_shared *sh);
void ec_shared_put(struct ec_shared *sh);

#endif
