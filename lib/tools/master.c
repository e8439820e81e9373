// SPDX-License-Identifier: LGPL-2.1-or-later
/* A master, its network devices, its cycle. */
#include <stdio.h>

#include "internal.h"
#include "text.h"

#define COPY(member)	(to->member = from->member)

_Static_assert(ECT_BUCKETS == EC_CYCLE_BUCKETS, "both are one histogram");

static void convert_master(struct ect_master *to, struct ec_ioc_master *from)
{
	string_clean(from->owner, sizeof(from->owner));
	COPY(index);
	COPY(phase);
	COPY(active);
	COPY(scan_busy);
	COPY(al_states);
	COPY(slave_count);
	COPY(slaves_responding);
	COPY(scan_index);
	COPY(scan_slaves);
	COPY(config_count);
	COPY(domain_count);
	to->device_count = min(from->device_count, (u32)EC_UAPI_DEVICES);
	COPY(debug_level);
	COPY(ref_clock);
	COPY(app_time);
	COPY(dc_ref_time);
	COPY(scan_frames);
	COPY(scan_us);
	COPY(scan_count);
	COPY(session);
	COPY(cycle_lock);
	COPY(lock_losses);
	COPY(phase_error);
	COPY(rate_ppb);
	COPY(cycle_interval_us);
	COPY(cycle_datagrams);
	COPY(cycle_frames);
	COPY(cycle_wire_ns);
	COPY(sent_frames);
	COPY(sent_wire_ns);
	COPY(acyclic_slack_ns);
	COPY(acyclic_need_ns);
	COPY(late_per_s);
	COPY(late_cycles);
	COPY(not_captured);
	COPY(acyclic_max);
	COPY(sii_limit);
	COPY(no_cycle);
	COPY(sii_bytes);
	COPY(held);
	COPY(links_up);
	COPY(left);
	COPY(ring);
	COPY(ring_slave);
	COPY(ring_port);
	COPY(ring_next);
	COPY(ring_exchanged);
	COPY(ring_turned);
	memcpy(to->owner, from->owner, sizeof(to->owner));
}

int ect_get_master(struct ect_handle *h, struct ect_master *to)
{
	struct ec_ioc_master m = { 0 };
	int ret = ect_command(h, EC_IOC_MASTER, &m);

	*to = (struct ect_master){ .struct_size = sizeof(*to) };
	if (!ret)
		convert_master(to, &m);
	return ret;
}

int ect_master_read(struct ect_handle *h, struct ect_master *m)
{
	struct ect_master own;
	int ret = ect_get_master(h, &own);

	return ret ? ret : ect_give(h, m, &own, sizeof(own));
}

static void convert_device(struct ect_device *to, struct ec_ioc_device *from)
{
	string_clean(from->name, sizeof(from->name));
	memcpy(to->address, from->address, sizeof(to->address));
	to->attached = from->state == EC_DEVICE_ATTACHED;
	COPY(link_up);
	COPY(slaves);
	COPY(speed);
	COPY(tx_frames);
	COPY(tx_bytes);
	COPY(rx_frames);
	COPY(rx_bytes);
	COPY(tx_errors);
	COPY(lost);
	COPY(late);
	COPY(unmatched);
	COPY(foreign);
	memcpy(to->tx_frame_rate, from->tx_frame_rate, sizeof(to->tx_frame_rate));
	memcpy(to->rx_frame_rate, from->rx_frame_rate, sizeof(to->rx_frame_rate));
	memcpy(to->tx_byte_rate, from->tx_byte_rate, sizeof(to->tx_byte_rate));
	memcpy(to->rx_byte_rate, from->rx_byte_rate, sizeof(to->rx_byte_rate));
	memcpy(to->loss_rate, from->loss_rate, sizeof(to->loss_rate));
	COPY(al_states);
	memcpy(to->name, from->name, sizeof(to->name));
}

static int read_devices(struct ect_handle *h, struct ect_list *l)
{
	struct ect_master m;
	int ret = ect_get_master(h, &m);

	for (u32 i = 0; i < m.device_count && !ret; i++) {
		struct ec_ioc_device from = { .index = i };
		struct ect_device *to = ect_list_add(l);

		if (!to)
			return ect_no_memory(h);
		ret = ect_command(h, EC_IOC_DEVICE, &from);
		to->index = i;
		convert_device(to, &from);
	}
	return ret;
}

int ect_devices_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *l = ect_list_new(sizeof(struct ect_device));
	int ret;

	if (!l)
		return ect_no_memory(h);
	ret = read_devices(h, l);
	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}

int ect_rescan(struct ect_handle *h)
{
	return ect_command(h, EC_IOC_RESCAN, NULL);
}

int ect_debug(struct ect_handle *h, unsigned int level)
{
	struct ec_ioc_debug arg = { .level = level };

	return ect_command(h, EC_IOC_DEBUG, &arg);
}

int ect_end_detached(struct ect_handle *h)
{
	return ect_command(h, EC_IOC_END_DETACHED, NULL);
}

int ect_device_use(struct ect_handle *h, const char *name)
{
	struct ec_ioc_device_use arg = { 0 };

	snprintf(arg.name, sizeof(arg.name), "%s", name);
	return ect_command(h, EC_IOC_DEVICE_USE, &arg);
}

int ect_backup_use(struct ect_handle *h, const char *name)
{
	struct ec_ioc_device_use arg = { .flags = EC_DEVICE_FLAG_BACKUP };

	snprintf(arg.name, sizeof(arg.name), "%s", name ? name : "");
	return ect_command(h, EC_IOC_DEVICE_USE, &arg);
}

int ect_cycle_reset(struct ect_handle *h)
{
	return ect_command(h, EC_IOC_CYCLE_RESET, NULL);
}

static void convert_cycle(struct ect_cycle *to, const struct ec_ioc_cycle_stats *from)
{
	COPY(kind);
	COPY(active);
	COPY(interval_set);
	COPY(interval_ns);
	COPY(cpu);
	COPY(cpu_losses);
	COPY(priority);
	COPY(priority_wanted);
	COPY(place);
	COPY(stall);
}

static void convert_stats(struct ect_cycle *to, const struct ec_status_cycle *from)
{
	COPY(state);
	COPY(overruns);
	COPY(missed);
	COPY(late_sum);
	COPY(late_count);
	COPY(late_min);
	COPY(late_max);
	COPY(work_sum);
	COPY(work_count);
	COPY(work_max);
	COPY(work_ns);
	COPY(takeovers);
	to->histogram = ECT_BUCKETS;
	memcpy(to->late, from->late, sizeof(to->late));
}

int ect_get_cycle(struct ect_handle *h, struct ect_cycle *to)
{
	struct ec_status_cycle st = { 0 };
	struct ec_ioc_cycle_stats i = { .size = sizeof(st), .data = (uintptr_t)&st };
	int ret = ect_command(h, EC_IOC_CYCLE_STATS, &i);

	*to = (struct ect_cycle){ .struct_size = sizeof(*to) };
	if (ret)
		return ret;
	convert_cycle(to, &i);
	convert_stats(to, &st);
	return 0;
}

int ect_cycle_read(struct ect_handle *h, struct ect_cycle *c)
{
	struct ect_cycle own;
	int ret = ect_get_cycle(h, &own);

	return ret ? ret : ect_give(h, c, &own, sizeof(own));
}

/* as described at EC_CYCLE_BUCKETS */
uint64_t ect_bucket_ns(unsigned int bucket)
{
	return bucket < 8 ? bucket : (8ULL + bucket % 8) << (bucket / 8 - 1);
}

uint64_t ect_cycle_quantile(const struct ect_cycle *c, unsigned int permille)
{
	u64 above = 0, sends = 0, most;
	unsigned int i;

	for (i = 0; i < ECT_BUCKETS; i++)
		sends += c->late[i];
	if (!sends)
		return 0;
	most = sends * (1000 - permille) / 1000;
	while (i && above <= most)
		above += c->late[--i];
	return min(ect_bucket_ns(i + 1) - 1, (u64)c->late_max);
}
