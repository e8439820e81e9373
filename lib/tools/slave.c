// SPDX-License-Identifier: LGPL-2.1-or-later
/* Slaves: what the master knows of them. */
#include "internal.h"
#include "text.h"

#define SCAN_RETRIES	3

#define COPY(member)	(to->member = from->member)

void ect_convert_cause(struct ect_cause *to, const struct ec_cause *from)
{
	COPY(kind);
	COPY(code);
	COPY(object);
	COPY(position);
	COPY(subindex);
	COPY(sm);
	COPY(state);
	COPY(port);
}

static void convert_port(struct ect_port *to, const struct ec_ioc_port *from)
{
	COPY(type);
	COPY(link_up);
	COPY(loop_closed);
	COPY(signal);
	COPY(receive_time);
	COPY(next_slave);
	COPY(delay_to_next_dc);
	to->errors_known = (u16)from->errors_known;
	to->invalid = from->errors[0];
	to->receiver = from->errors[1];
	to->forwarded = from->errors[2];
	to->lost_link = from->errors[3];
}

static void convert_mailbox(struct ect_slave *to, const struct ec_ioc_slave *from)
{
	COPY(boot_rx_offset);
	COPY(boot_rx_size);
	COPY(boot_tx_offset);
	COPY(boot_tx_size);
	COPY(std_rx_offset);
	COPY(std_rx_size);
	COPY(std_tx_offset);
	COPY(std_tx_size);
	COPY(mbox_protocols);
}

static void convert_slave(struct ect_slave *to, const struct ec_ioc_slave *from)
{
	COPY(position);
	COPY(missing_before);
	COPY(station);
	COPY(device);
	COPY(alias);
	COPY(alias_pos);
	COPY(alias_group);
	COPY(al_status);
	COPY(al_code);
	COPY(al_requested);
	COPY(error);
	COPY(vendor_id);
	COPY(product_code);
	COPY(revision_number);
	COPY(serial_number);
	convert_mailbox(to, from);
	COPY(has_general);
	COPY(coe_details);
	COPY(general_flags);
	COPY(foe_details);
	COPY(current_ma);
	COPY(fmmu_bit);
	COPY(dc_supported);
	COPY(dc_delay_only);
	COPY(sm_count);
	COPY(fmmu_count);
	COPY(device_index);
	COPY(dl_status);
	COPY(features);
	COPY(identification);
	COPY(transmission_delay);
	COPY(sii_words);
	COPY(dc_offset);
	COPY(dc_diff);
	COPY(dc_set);
	COPY(dc_odd);
	COPY(config);
	COPY(differs);
}

static int get_names(struct ect_handle *h, struct ect_slave *to)
{
	struct ec_ioc_slave_names from = { .slave = ect_address(to->device) };
	int ret = ect_command(h, EC_IOC_SLAVE_NAMES, &from);

	memcpy(to->group, from.group, sizeof(to->group));
	memcpy(to->image, from.image, sizeof(to->image));
	memcpy(to->order, from.order, sizeof(to->order));
	memcpy(to->name, from.name, sizeof(to->name));
	string_clean(to->group, sizeof(to->group));
	string_clean(to->image, sizeof(to->image));
	string_clean(to->order, sizeof(to->order));
	string_clean(to->name, sizeof(to->name));
	return ret;
}

static int get_why(struct ect_handle *h, struct ect_slave *to)
{
	struct ec_ioc_slave_why from = { .slave = ect_address(to->device) };
	int ret = ect_command(h, EC_IOC_SLAVE_WHY, &from);

	memcpy(to->why, from.why, sizeof(to->why));
	memcpy(to->warning, from.warning, sizeof(from.warning));
	string_clean(to->why, sizeof(to->why));
	string_clean(to->warning, sizeof(to->warning));
	ect_convert_cause(&to->cause, &from.cause);
	return ret;
}

static int get_ports(struct ect_handle *h, struct ect_slave *to)
{
	int ret = 0;

	for (u32 i = 0; i < ECT_PORTS && !ret; i++) {
		struct ec_ioc_port from = { .slave = ect_address(to->device), .port = i };

		ret = ect_command(h, EC_IOC_PORT, &from);
		convert_port(&to->ports[i], &from);
		to->port_kept[i] = (u8)from.kept;
		to->port_wait_s[i] = (u8)from.wait_s;
	}
	return ret;
}

/* by any address, from then on by the device; @to is zeros but for its struct_size */
static int get_slave(struct ect_handle *h, struct ec_ioc_address address, struct ect_slave *to)
{
	struct ec_ioc_slave s = { .slave = address };
	int ret = ect_command(h, EC_IOC_SLAVE, &s);

	if (ret)
		return ret;
	convert_slave(to, &s);
	ret = get_names(h, to);
	ret = ret ? ret : get_why(h, to);
	return ret ? ret : get_ports(h, to);
}

static int give_slave(struct ect_handle *h, struct ec_ioc_address address, struct ect_slave *s)
{
	struct ect_slave own = { .struct_size = sizeof(own) };
	int ret = get_slave(h, address, &own);

	return ret ? ret : ect_give(h, s, &own, sizeof(own));
}

int ect_slave_at(struct ect_handle *h, unsigned int position, struct ect_slave *s)
{
	if (position > 0xffff)
		return ect_fail(h, -EINVAL, "a ring position is at most 65535");
	return give_slave(h, ect_ring(position), s);
}

int ect_slave_read(struct ect_handle *h, uint64_t device, struct ect_slave *s)
{
	return give_slave(h, ect_address(device), s);
}

/* 0 or the failure of the slave that is element number n of the list then */
static int read_slaves(struct ect_handle *h, struct ect_list *l, u32 count)
{
	l->n = 0;
	while (l->n < count) {
		struct ect_slave *s = ect_list_add(l);
		int ret;

		if (!s)
			return ect_no_memory(h);
		ret = get_slave(h, ect_ring((unsigned int)l->n - 1), s);
		if (!ret)
			continue;
		l->n--;
		return ret;
	}
	return 0;
}

/*
 * The bus may change while it is read: when a scan took place meanwhile the
 * list is read again; it ends before a slave that is absent by then.
 */
static int read_list(struct ect_handle *h, struct ect_list *l)
{
	for (int i = 0;; i++) {
		struct ect_master before, after;
		struct ect_handle failure;
		int ret = ect_get_master(h, &before), err;

		if (ret)
			return ret;
		err = read_slaves(h, l, before.slave_count);
		if (err == -ENOMEM)
			return err;
		ect_reason(h);
		failure = *h;
		ret = ect_get_master(h, &after);
		if (ret)
			return ret;
		if (before.scan_count != after.scan_count && i < SCAN_RETRIES)
			continue;
		if (!err || before.scan_count != after.scan_count || after.scan_busy)
			return 0;
		*h = failure;
		return err;
	}
}

int ect_slaves_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *l = ect_list_new(sizeof(struct ect_slave));
	int ret;

	if (!l)
		return ect_no_memory(h);
	ret = read_list(h, l);
	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}

int ect_state_request(struct ect_handle *h, uint64_t device, unsigned int state,
		      uint32_t timeout_ms)
{
	struct ec_ioc_state req = {
		.slave = ect_address(device), .state = (u8)state, .timeout_ms = timeout_ms,
	};

	return ect_command(h, EC_IOC_STATE, &req);
}

long ect_sii_read(struct ect_handle *h, uint64_t device, uint32_t offset, void *data, size_t size)
{
	size_t done = 0;

	/* the kernel may return an image of any size in pieces */
	while (done < size) {
		struct ec_ioc_sii a = {
			.slave = ect_address(device), .offset = offset + (u32)done,
			.size = (u32)min(size - done, (size_t)0xffffffff),
			.data = (uintptr_t)data + done,
		};
		int ret = ect_command(h, EC_IOC_SII, &a);

		if (ret)
			return ret;
		if (!a.size)
			break;
		done += min((size_t)a.size, size - done);
	}
	return (long)done;
}

int ect_sm_read(struct ect_handle *h, uint64_t device, unsigned int sm, struct ect_sm *to)
{
	struct ec_ioc_sm s = { .slave = ect_address(device), .sm = (u8)sm };
	struct ect_sm own;
	int ret = ect_command(h, EC_IOC_SM, &s);

	own = (struct ect_sm){
		.sm = s.sm, .control = s.control, .enable = s.enable, .type = s.type,
		.start = s.start, .default_size = s.default_size, .pdo_count = s.pdo_count,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_pdo_read(struct ect_handle *h, uint64_t device, unsigned int sm, unsigned int pdo,
		 struct ect_pdo *to)
{
	struct ec_ioc_pdo p = {
		.slave = ect_address(device), .sm = (u8)sm, .pdo_pos = (u16)pdo,
	};
	struct ect_pdo own;
	int ret = ect_command(h, EC_IOC_PDO, &p);

	own = (struct ect_pdo){ .index = p.index, .entry_count = p.entry_count };
	memcpy(own.name, p.name, sizeof(own.name));
	string_clean(own.name, sizeof(own.name));
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_pdo_entry_read(struct ect_handle *h, uint64_t device, unsigned int sm, unsigned int pdo,
		       unsigned int entry, struct ect_pdo_entry *to)
{
	struct ec_ioc_pdo_entry e = {
		.slave = ect_address(device), .sm = (u8)sm, .pdo_pos = (u16)pdo,
		.entry_pos = (u16)entry,
	};
	struct ect_pdo_entry own;
	int ret = ect_command(h, EC_IOC_PDO_ENTRY, &e);

	own = (struct ect_pdo_entry){ .index = e.index, .subindex = e.subindex, .bits = e.bits };
	memcpy(own.name, e.name, sizeof(own.name));
	string_clean(own.name, sizeof(own.name));
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

static void convert_absent(struct ect_absent *to, const struct ec_ioc_absent *from)
{
	COPY(slaves);
	COPY(device);
	COPY(since_ns);
	COPY(first);
	COPY(last);
	COPY(port);
	memcpy(to->name, from->name, sizeof(to->name));
	string_clean(to->name, sizeof(to->name));
}

static int read_absent(struct ect_handle *h, struct ect_list *l)
{
	for (u32 i = 0;; i++) {
		struct ec_ioc_absent from = { .index = i };
		int ret = ect_command(h, EC_IOC_ABSENT, &from);
		struct ect_absent *to;

		/* a module that does not know the command lists none */
		if (ret || !from.slaves)
			return ret == -ENOTTY ? 0 : ret;
		to = ect_list_add(l);
		if (!to)
			return ect_no_memory(h);
		convert_absent(to, &from);
	}
}

int ect_absent_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *l = ect_list_new(sizeof(struct ect_absent));
	int ret = l ? read_absent(h, l) : ect_no_memory(h);

	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}

static void convert_behind(struct ect_behind *to, const struct ec_ioc_port *from)
{
	COPY(kept);
	COPY(vendor_id);
	COPY(product_code);
	COPY(revision_number);
	COPY(serial_number);
	COPY(slaves);
	COPY(alias);
	COPY(identification);
	memcpy(to->name, from->name, sizeof(to->name));
	string_clean(to->name, sizeof(to->name));
}

int ect_behind_read(struct ect_handle *h, uint64_t device, unsigned int port,
		    struct ect_behind *b)
{
	struct ec_ioc_port from = { .slave = ect_address(device), .port = port };
	struct ect_behind own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_PORT, &from);

	if (ret)
		return ret;
	convert_behind(&own, &from);
	return ect_give(h, b, &own, sizeof(own));
}

int ect_let_in(struct ect_handle *h, uint64_t device, unsigned int port,
	       const struct ect_behind *b)
{
	struct ec_ioc_let_in i = {
		.slave = ect_address(device), .port = port, .vendor_id = b->vendor_id,
		.product_code = b->product_code, .revision_number = b->revision_number,
		.serial_number = b->serial_number,
	};

	return ect_command(h, EC_IOC_LET_IN, &i);
}
