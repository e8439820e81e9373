// SPDX-License-Identifier: LGPL-2.1-or-later
/* A reserved master: session, activation, cycle. */

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "ecrt/ecrt_int.h"

/* session ------------------------------------------------------------------*/

void ec_master_free_session(struct ec_master *m)
{
	struct ec_slave_config *sc;
	struct ec_domain *d;

	ec_master_free_data(m);
	ec_app_requests_free(m);
	while ((d = m->domains)) {
		m->domains = d->next;
		free(d->inputs);
		free(d);
	}
	while ((sc = m->configs)) {
		m->configs = sc->next;
		free(sc);
	}
}

ec_domain_t *ecrt_master_create_domain(ec_master_t *master)
{
	struct ec_ioc_create_domain arg = { 0 };
	struct ec_domain *d, **end;
	int ret;

	if (!master)
		return ec_no_handle(-EINVAL);
	if (ec_memory_frozen(master, "create a domain"))
		return NULL;
	d = calloc(1, sizeof(*d));
	if (!d) {
		ec_fail(NULL, -ENOMEM, "create a domain");
		return NULL;
	}
	ret = ec_do(master, EC_IOC_CREATE_DOMAIN, &arg, "create a domain");
	if (ret)
		goto err_free;
	if (arg.index >= EC_STATUS_DOMAINS) {
		ec_fail(NULL, -ENOSPC, "create domain %u of at most %u",
			arg.index, EC_STATUS_DOMAINS);
		goto err_free;
	}
	d->master = master;
	d->index = arg.index;
	d->max_age = EC_DOMAIN_MAX_AGE;
	for (end = &master->domains; *end; end = &(*end)->next)
		;
	*end = d;
	return d;

err_free:
	free(d);
	return NULL;
}

static struct ec_slave_config *config_find(struct ec_master *m,
					   unsigned int index)
{
	struct ec_slave_config *sc;

	for (sc = m->configs; sc; sc = sc->next)
		if (sc->index == index)
			return sc;
	return NULL;
}

/* The handle of configuration @index: a new one is named as in @what. */
static struct ec_slave_config *config_handle(struct ec_master *m, unsigned int index,
					     struct ec_slave_config what)
{
	struct ec_slave_config *sc = config_find(m, index);

	if (sc)
		return sc;
	sc = calloc(1, sizeof(*sc));
	if (!sc) {
		ec_fail(NULL, -ENOMEM, "configure a slave");
		return NULL;
	}
	*sc = what;
	sc->master = m;
	sc->index = index;
	sc->next = m->configs;
	m->configs = sc;
	return sc;
}

ec_slave_config_t *ecrt_master_slave_config(ec_master_t *master,
					    uint16_t alias, uint16_t position,
					    uint32_t vendor_id,
					    uint32_t product_code)
{
	struct ec_ioc_slave_config arg = {
		.alias = alias,
		.position = position,
		.vendor_id = vendor_id,
		.product_code = product_code,
	};

	if (!master)
		return ec_no_handle(-EINVAL);
	if (ec_do(master, EC_IOC_SLAVE_CONFIG, &arg, "configure slave %u:%u as 0x%08x/0x%08x",
		  alias, position, vendor_id, product_code))
		return NULL;
	return config_handle(master, arg.index, (struct ec_slave_config){
		.alias = alias, .position = position,
	});
}

ec_slave_config_t *ecrt_master_group_config(ec_master_t *master, unsigned int group,
					    uint16_t member, uint32_t vendor_id,
					    uint32_t product_code)
{
	struct ec_ioc_group_config arg = {
		.group = group, .member = member, .vendor_id = vendor_id,
		.product_code = product_code,
	};

	if (!master)
		return ec_no_handle(-EINVAL);
	if (ec_do(master, EC_IOC_GROUP_CONFIG, &arg,
		  "configure member %u of group %u as 0x%08x/0x%08x", member, group, vendor_id,
		  product_code))
		return NULL;
	return config_handle(master, arg.index, (struct ec_slave_config){
		.position = member, .group = group + 1,
	});
}

/* activation ---------------------------------------------------------------*/

/*
 * Maps @size bytes, at an address or anywhere, and touches each page, so that the cycle
 * need not.
 */
void *ec_master_map(struct ec_master *m, void *at, size_t size, int prot, __u64 offset)
{
	size_t page = (size_t)sysconf(_SC_PAGESIZE), i;
	int flags = MAP_SHARED | MAP_POPULATE | (at ? MAP_FIXED : 0);
	__u8 *p;

	at = mmap(at, size, prot, flags, m->fd, (off_t)offset);
	if (at == MAP_FAILED)
		return NULL;
	/* at once: a cycle of the kernel may already write there */
	for (p = at, i = 0; i < size; i += page) {
		if (prot & PROT_WRITE)
			__atomic_fetch_or(&p[i], 0, __ATOMIC_RELAXED);
		else
			(void)*(volatile __u8 *)&p[i];
	}
	return at;
}

void ec_master_unmap(struct ec_master *m)
{
	ec_memory_unmap_exchange(m);
	if (m->image)
		munmap(m->image, m->image_size);
	if (m->status)
		munmap((void *)m->status, m->status_size);
	if (m->area)
		munmap(m->area, m->area_size);
	m->image = NULL;
	m->status = NULL;
	m->area = NULL;
	m->area_base = NULL;
	m->active = false;
	m->frozen = false;
	ec_app_requests_place(m);
}

static int map_requests(struct ec_master *m, size_t size)
{
	if (!size)
		return 0;
	m->area_size = size;
	m->area = ec_master_map(m, NULL, size, PROT_READ | PROT_WRITE, EC_MMAP_REQUESTS);
	if (!m->area)
		return -errno;
	m->area_base = (__u8 *)m->area;
	return m->area->magic == EC_REQUEST_MAGIC ? ec_app_requests_place(m) :
						    -EPROTO;
}

static int map_all(struct ec_master *m, const struct ec_ioc_activate *arg)
{
	int ret;

	if (arg->status_size < offsetof(struct ec_status, units))
		return -EPROTO;
	m->status_size = arg->status_size;
	m->status = ec_master_map(m, NULL, arg->status_size, PROT_READ, EC_MMAP_STATUS);
	if (!m->status)
		return -errno;
	if (m->status->magic != EC_STATUS_MAGIC)
		return -EPROTO;
	ret = map_requests(m, arg->request_size);
	if (ret)
		return ret;
	if (arg->exchange_size)
		return ec_memory_map_exchange(m, arg);
	return arg->image_size ? ec_memory_map_image(m, arg->image_size) : 0;
}

static int place_domain(struct ec_master *m, struct ec_domain *d)
{
	struct ec_ioc_domain_offset arg = { .domain = d->index };
	int ret = ec_command(m, EC_IOC_DOMAIN_OFFSET, &arg);

	if (ret)
		return ret;
	if (arg.offset > m->image_size || arg.size > m->image_size - arg.offset)
		return -EPROTO;
	/* the application has the pointer already */
	if (d->data && (arg.offset != d->offset || arg.size != d->size))
		return -EPROTO;
	d->offset = arg.offset;
	d->size = arg.size;
	d->data = m->image ? m->image + arg.offset : NULL;
	return m->cycle.exchange ? ec_exchange_add(d) : 0;
}

int ecrt_master_activate(ec_master_t *master)
{
	struct ec_ioc_activate arg = { 0 };
	struct ec_domain *d;
	int ret;

	if (!master)
		return -EINVAL;
	if (master->active) {
		fprintf(stderr, "Master %u is active already\n", master->index);
		return 0;
	}
	if (master->frozen && master->preset_size) {
		arg.preset = (uintptr_t)master->image;
		arg.preset_size = (__u32)master->preset_size;
	}
	ret = ec_do(master, EC_IOC_ACTIVATE, &arg, "activate master %u", master->index);
	if (ret)
		return ret;
	ret = map_all(master, &arg);
	if (ret) {
		ec_fail(NULL, ret, "map process data of master %u (%u bytes)",
			master->index, arg.image_size);
		goto err_deactivate;
	}
	for (d = master->domains; d; d = d->next) {
		ret = place_domain(master, d);
		if (!ret)
			continue;
		ec_fail(NULL, ret, "place domain %u in the process data",
			d->index);
		goto err_deactivate;
	}
	master->cycle.next.queued = 0;
	master->cycle.next.flags = 0;
	master->cycle.started = 0;
	master->cycle.received = 0;
	master->active = true;
	return 0;

err_deactivate:
	for (d = master->domains; d; d = d->next)
		d->data = NULL;
	ec_master_unmap(master);
	/* a detached session of another application continues */
	if (!arg.taken_over)
		ec_command(master, EC_IOC_DEACTIVATE, NULL);
	return ret;
}

int ecrt_master_deactivate(ec_master_t *master)
{
	int ret;

	if (!master || !master->active)
		return ec_inactive(master);
	ret = ec_command(master, EC_IOC_DEACTIVATE, NULL);
	if (ret)
		return ret;
	ec_master_unmap(master);
	ec_master_free_session(master);
	master->cycle.next.app_time = 0;	/* the next session has its own */
	return 0;
}

int ecrt_master_leave(ec_master_t *master)
{
	struct ec_ioc_detach arg = { 0 };
	int ret;

	if (!master || !master->active)
		return ec_inactive(master);
	/* the kernel refuses to take it while memory is mapped, by which a process could write */
	ec_master_unmap(master);
	ret = ec_do(master, EC_IOC_DETACH, &arg, "leave the cycle of master %u", master->index);
	if (ret)
		return ret;
	master->reserved = false;
	ec_master_free_session(master);
	master->cycle.next.app_time = 0;
	return 0;
}

int ecrt_master_set_names(ec_master_t *master, const char *text, size_t size)
{
	struct ec_ioc_names arg = { .size = (__u32)size, .data = (uintptr_t)text };

	if (!master || (size && !text))
		return -EINVAL;
	if (size > EC_UAPI_NAMES_MAX)
		return ec_fail(NULL, -E2BIG, "set %zu bytes of names, limit %u", size,
			       EC_UAPI_NAMES_MAX);
	return ec_do(master, EC_IOC_SET_NAMES, &arg, "set names of master %u", master->index);
}

/* cycle --------------------------------------------------------------------*/

/*
 * The result of a command of the cycle by the shorter entry: 0, its error, or 1: execute it by
 * ioctl(), which shows the cause when the module or a filter of system calls refuses the advice.
 */
static inline int advised(struct ec_master *m, int err)
{
	if (!err)
		return 0;
	m->no_advice = err == EINVAL;
	return err == ENODEV || err == ENOENT ? -err : 1;
}

static int send_next(struct ec_master *m)
{
	struct ec_ioc_send *next = &m->cycle.next;
	int ret = 1;

	if (__atomic_load_n(&m->cycle.started, __ATOMIC_RELAXED) &&
	    __atomic_exchange_n(&m->cycle.started, 0, __ATOMIC_ACQUIRE))
		next->flags |= EC_SEND_FLAG_REQUESTS;
	/* two different times need the ioctl() */
	if (!m->no_advice && (!(next->flags & EC_SEND_FLAG_SYNC_REF) ||
			      next->sync_time == next->app_time))
		ret = advised(m, posix_fadvise(m->fd, (off_t)next->app_time, (off_t)next->queued,
					       EC_ADVICE_SEND | (int)next->flags));
	return ret > 0 ? ec_command(m, EC_IOC_SEND, next) : ret;
}

int ecrt_master_send(ec_master_t *master)
{
	struct ec_app_cycle *a;
	int ret;

	if (!master || !master->active)
		return ec_inactive(master);
	a = &master->cycle;
	if (a->exchange)
		return ec_exchange_send(master, master->status);
	ret = send_next(master);
	a->next.queued = 0;
	a->next.flags = 0;
	return ret;
}

int ecrt_master_receive(ec_master_t *master)
{
	int ret = 1;

	if (!master || !master->active)
		return ec_inactive(master);
	if (master->cycle.exchange)
		return ec_exchange_receive(master, master->status);
	if (!master->no_advice)
		ret = advised(master, posix_fadvise(master->fd, 0, 0, EC_ADVICE_RECEIVE));
	return ret > 0 ? ec_command(master, EC_IOC_RECEIVE, NULL) : ret;
}

int ecrt_master_application_time(ec_master_t *master, uint64_t app_time)
{
	struct ec_ioc_app_time arg = { .app_time = app_time };

	if (!master)
		return -EINVAL;
	master->cycle.next.app_time = app_time;
	if (!master->active)
		return ec_command(master, EC_IOC_APP_TIME, &arg);
	/* the next send passes it: no system call of its own */
	master->cycle.next.flags |= EC_SEND_FLAG_APP_TIME;
	return 0;
}

int ecrt_master_cycle_fd(const ec_master_t *master)
{
	return master && master->active && master->cycle.exchange ? master->fd :
								    ec_inactive(master);
}

int ecrt_master_reset(ec_master_t *master)
{
	return master ? ec_command(master, EC_IOC_RESET, NULL) : -EINVAL;
}
