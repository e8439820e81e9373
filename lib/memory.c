// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Process data before activation: memory of the library, at an address that stays.
 * Activation passes its content to the kernel as the initial image. Then the image
 * itself is mapped at this address; when the kernel runs the cycle, the memory is
 * kept.
 */
#include <sys/mman.h>
#include <unistd.h>

#include "ecrt/ecrt_int.h"

static size_t to_pages(size_t size)
{
	size_t page = (size_t)sysconf(_SC_PAGESIZE);

	return (size + page - 1) / page * page;
}

/* Get the places of the domains from the kernel; returns bytes of all, or -errno. */
static int measure(struct ec_master *m, size_t *total)
{
	struct ec_domain *d;
	int ret;

	*total = 0;
	for (d = m->domains; d; d = d->next) {
		struct ec_ioc_domain_offset arg = { .domain = d->index };

		ret = ec_do(m, EC_IOC_DOMAIN_OFFSET, &arg, "set up domain memory of master %u",
			    m->index);
		if (ret)
			return ret;
		d->offset = arg.offset;
		d->size = arg.size;
		/* each begins at a multiple of 8 */
		if (arg.offset + (size_t)arg.size > *total)
			*total = (arg.offset + (size_t)arg.size + 7) & ~(size_t)7;
	}
	return 0;
}

int ecrt_master_setup_domain_memory(ec_master_t *master)
{
	struct ec_domain *d;
	size_t total;
	int ret;

	if (!master)
		return -EINVAL;
	if (master->active || master->frozen)
		return ec_fail(NULL, -EBUSY, "set up domain memory of master %u again",
			       master->index);
	if (!master->domains)
		return ec_fail(NULL, -EINVAL, "set up domain memory of master %u: create domains first",
			       master->index);
	ret = measure(master, &total);
	if (ret)
		return ret;
	master->frozen = true;
	master->preset_size = total;
	if (!total)
		return 0;
	master->image_size = to_pages(total);
	master->image = mmap(NULL, master->image_size, PROT_READ | PROT_WRITE,
			     MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
	if (master->image == MAP_FAILED) {
		ret = -errno;
		master->image = NULL;
		master->frozen = false;
		return ec_fail(NULL, ret, "set up %zu bytes of domain memory", total);
	}
	for (d = master->domains; d; d = d->next)
		d->data = master->image + d->offset;
	return 0;
}

/* 0, or an error after reporting that nothing can be registered any more. */
int ec_memory_frozen(const struct ec_master *m, const char *what)
{
	return m->frozen ? ec_fail(NULL, -EBUSY, "%s after ecrt_master_setup_domain_memory()",
				   what) : 0;
}

/* Map the image, at the address that the application has already, if any. */
int ec_memory_map_image(struct ec_master *m, size_t size)
{
	void *at;

	if (m->image && size != m->image_size)
		return -EPROTO;
	at = ec_master_map(m, m->image, size, PROT_READ | PROT_WRITE, EC_MMAP_IMAGE);
	if (!at)
		return -errno;
	m->image = at;
	m->image_size = size;
	return 0;
}

/* The memory that is exchanged with a cycle of the kernel, and the place of the domains' data. */
int ec_memory_map_exchange(struct ec_master *m, const struct ec_ioc_activate *arg)
{
	struct ec_exchange *x = ec_master_map(m, NULL, arg->exchange_size, PROT_READ | PROT_WRITE,
					      EC_MMAP_EXCHANGE);
	int ret;

	m->exchange_size = arg->exchange_size;
	if (!x)
		return -errno;
	ret = ec_exchange_begin(&m->cycle, x, m->exchange_size, m->status);
	if (ret)
		return ret;
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

void ec_memory_unmap_exchange(struct ec_master *m)
{
	if (m->cycle.exchange)
		munmap(m->cycle.exchange, m->exchange_size);
	m->cycle.exchange = NULL;
}
