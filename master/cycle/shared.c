// SPDX-License-Identifier: GPL-2.0-only
/*
 * Memory for applications. It belongs to their memory cgroup, and all applications of a
 * master have EC_MAX_SESSION_BYTES together (struct ec_budget). A mapping may exist longer
 * than the session that made it.
 */
#include <linux/slab.h>
#include <linux/vmalloc.h>
#include "shared.h"

static void shared_release(struct kref *kref)
{
	struct ec_shared *sh = container_of(kref, struct ec_shared, kref);

	vfree(sh->image);
	vfree(sh->exchange);
	vfree(sh->status);
	vfree(sh->requests);
	atomic_long_sub(sh->bytes, sh->mapped);
	kfree(sh);
}

void ec_shared_get(struct ec_shared *sh)
{
	kref_get(&sh->kref);
}

void ec_shared_put(struct ec_shared *sh)
{
	kref_put(&sh->kref, shared_release);
}

/**
 * ec_shared_alloc() - memory to be mapped
 * @sh: it is counted there
 * @size: bytes, multiple of the page size
 *
 * Context: Process. May sleep.
 * Return: zeroed memory for vfree(), or NULL.
 */
void *ec_shared_alloc(struct ec_shared *sh, size_t size)
{
	/* vmalloc_user() would not charge the caller's cgroup */
	void *p = __vmalloc(size, GFP_KERNEL_ACCOUNT | __GFP_ZERO | __GFP_NOWARN);

	if (p) {
		sh->bytes += size;
		atomic_long_add(size, sh->mapped);
	}
	return p;
}

/**
 * ec_shared_map() - map such memory into a process
 * @vma: where, not larger than the memory
 * @memory: of ec_shared_alloc()
 *
 * Context: mmap(). May sleep.
 * Return: 0 or -errno.
 */
int ec_shared_map(struct vm_area_struct *vma, void *memory)
{
	unsigned long at;
	int ret = 0;

	for (at = vma->vm_start; at < vma->vm_end && !ret; at += PAGE_SIZE)
		ret = vm_insert_page(vma, at, vmalloc_to_page(memory + (at - vma->vm_start)));
	return ret;
}

/**
 * ec_shared_create() - memory of an activation
 * @mapped: bytes of all memory of applications of the master
 * @image_size: bytes of all domains
 * @request_size: bytes of all requests, 0: none
 *
 * Context: Process. May sleep.
 * Return: shared memory with one reference; NULL: no memory.
 */
struct ec_shared *ec_shared_create(atomic_long_t *mapped, size_t image_size,
				   size_t request_size)
{
	struct ec_shared *sh = kzalloc(sizeof(*sh), GFP_KERNEL_ACCOUNT);

	if (!sh)
		return NULL;
	kref_init(&sh->kref);
	sh->mapped = mapped;
	sh->image_size = PAGE_ALIGN(image_size);
	sh->image = image_size ? ec_shared_alloc(sh, sh->image_size) : NULL;
	sh->status = ec_shared_alloc(sh, EC_STATUS_BYTES);
	sh->request_size = PAGE_ALIGN(request_size);
	sh->requests = request_size ? ec_shared_alloc(sh, sh->request_size) : NULL;
	if ((image_size && !sh->image) || (request_size && !sh->requests) || !sh->status) {
		ec_shared_put(sh);
		return NULL;
	}
	sh->status->magic = EC_STATUS_MAGIC;
	sh->status->size = sizeof(*sh->status);
	return sh;
}
