// SPDX-License-Identifier: LGPL-2.1-or-later
/* Objects, files, IP parameters and emergencies of slaves. */
#include "../../master/wire/emergency.h"
#include "internal.h"
#include "text.h"

#include <stdio.h>

static u32 room(size_t size)
{
	return (u32)min(size, (size_t)0xffffffff);
}

long ect_sdo_upload(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		    unsigned int flags, uint32_t timeout_ms, void *data, size_t size)
{
	struct ec_ioc_sdo s = {
		.flags = flags & ECT_SDO_COMPLETE ? EC_SDO_FLAG_COMPLETE : 0,
		.slave = ect_address(device), .index = index, .subindex = subindex,
		.size = room(size), .timeout_ms = timeout_ms, .data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_SDO_UPLOAD, &s);

	return ret ? ect_coded(h, ret, s.abort_code) : (long)min((size_t)s.size, size);
}

int ect_sdo_download(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		     unsigned int flags, uint32_t timeout_ms, const void *data, size_t size)
{
	struct ec_ioc_sdo s = {
		.flags = flags & ECT_SDO_COMPLETE ? EC_SDO_FLAG_COMPLETE : 0,
		.slave = ect_address(device), .index = index, .subindex = subindex,
		.size = room(size), .timeout_ms = timeout_ms, .data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_SDO_DOWNLOAD, &s);

	return ect_coded(h, ret, s.abort_code);
}

long ect_soe_read_element(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
			  unsigned int element, uint32_t timeout_ms, void *data, size_t size)
{
	struct ec_ioc_soe s = {
		.flags = element, .slave = ect_address(device), .idn = idn, .drive = (u8)drive,
		.size = room(size), .timeout_ms = timeout_ms, .data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_SOE_READ, &s);

	return ret ? ect_coded(h, ret, s.error_code) : (long)min((size_t)s.size, size);
}

int ect_soe_write_element(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
			  unsigned int element, uint32_t timeout_ms, const void *data, size_t size)
{
	struct ec_ioc_soe s = {
		.flags = element, .slave = ect_address(device), .idn = idn, .drive = (u8)drive,
		.size = room(size), .timeout_ms = timeout_ms, .data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_SOE_WRITE, &s);

	return ect_coded(h, ret, s.error_code);
}

/* Without a bit for the value, so that an older module accepts it. */
long ect_soe_read(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
		  uint32_t timeout_ms, void *data, size_t size)
{
	return ect_soe_read_element(h, device, drive, idn, 0, timeout_ms, data, size);
}

int ect_soe_write(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
		  uint32_t timeout_ms, const void *data, size_t size)
{
	return ect_soe_write_element(h, device, drive, idn, 0, timeout_ms, data, size);
}

static int foe(struct ect_handle *h, unsigned long command, struct ec_ioc_foe *f, const char *name)
{
	size_t len = strlen(name);
	int ret;

	if (!len || len > ECT_FOE_NAME)
		return ect_fail(h, -EINVAL, "invalid file name: expected 1 to %u characters",
				ECT_FOE_NAME);
	memcpy(f->name, name, len);
	ret = ect_command(h, command, f);
	return ect_coded(h, ret, f->error_code);
}

long ect_foe_read(struct ect_handle *h, uint64_t device, const char *name, uint32_t password,
		  void *data, size_t size, uint64_t *done)
{
	struct ec_ioc_foe f = {
		.slave = ect_address(device), .password = password, .size = room(size),
		.data = (uintptr_t)data, .done = (uintptr_t)done,
	};
	int ret = foe(h, EC_IOC_FOE_READ, &f, name);

	return ret ? ret : (long)min((size_t)f.size, size);
}

int ect_foe_write(struct ect_handle *h, uint64_t device, const char *name, uint32_t password,
		  const void *data, size_t size, uint64_t *done)
{
	struct ec_ioc_foe f = {
		.slave = ect_address(device), .password = password, .size = room(size),
		.data = (uintptr_t)data, .done = (uintptr_t)done,
	};

	return foe(h, EC_IOC_FOE_WRITE, &f, name);
}

void ect_convert_ip(struct ect_ip *to, const struct ec_ip_params *from)
{
	*to = (struct ect_ip){ .struct_size = sizeof(*to), .which = from->which };
	memcpy(to->mac, from->mac, sizeof(to->mac));
	memcpy(to->ip, from->ip, sizeof(to->ip));
	memcpy(to->mask, from->mask, sizeof(to->mask));
	memcpy(to->gateway, from->gateway, sizeof(to->gateway));
	memcpy(to->dns, from->dns, sizeof(to->dns));
	memcpy(to->name, from->name, sizeof(to->name));
	string_clean(to->name, sizeof(to->name));
}

int ect_ip_get(struct ect_handle *h, uint64_t device, struct ect_ip *ip)
{
	struct ec_ioc_ip i = { .slave = ect_address(device) };
	struct ect_ip own;
	int ret = ect_command(h, EC_IOC_IP_GET, &i);

	if (ret)
		return ect_coded(h, ret, i.result);
	ect_convert_ip(&own, &i.params);
	return ect_give(h, ip, &own, sizeof(own));
}

int ect_ip_set(struct ect_handle *h, uint64_t device, const struct ect_ip *ip)
{
	struct ec_ioc_ip i = { .slave = ect_address(device) };
	struct ec_ip_params *to = &i.params;
	int ret;

	if (ip->struct_size < sizeof(*ip))
		return ect_fail(h, -EINVAL, "struct_size is %u, expected %zu", ip->struct_size,
				sizeof(*ip));
	to->which = ip->which;
	memcpy(to->mac, ip->mac, sizeof(to->mac));
	memcpy(to->ip, ip->ip, sizeof(to->ip));
	memcpy(to->mask, ip->mask, sizeof(to->mask));
	memcpy(to->gateway, ip->gateway, sizeof(to->gateway));
	memcpy(to->dns, ip->dns, sizeof(to->dns));
	memcpy(to->name, ip->name, sizeof(to->name));
	ret = ect_command(h, EC_IOC_IP_SET, &i);
	return ect_coded(h, ret, i.result);
}

int ect_emergencies_read(struct ect_handle *h, uint64_t device, uint32_t *total,
			 struct ect_list **list)
{
	struct ec_emergency all[EC_EMERGENCIES];
	struct ec_ioc_emergencies i = {
		.slave = ect_address(device), .size = sizeof(all), .data = (uintptr_t)all,
	};
	int ret = ect_command(h, EC_IOC_EMERGENCIES, &i);
	struct ect_list *l;

	if (ret)
		return ret;
	l = ect_list_new(sizeof(struct ect_emergency));
	if (!l)
		return ect_no_memory(h);
	for (unsigned int k = 0; k < i.size / sizeof(*all) && k < EC_EMERGENCIES; k++) {
		const struct ec_emergency *from = &all[k];
		struct ect_emergency *to = ect_list_add(l);

		if (!to) {
			ect_list_free(l);
			return ect_no_memory(h);
		}
		to->time_ns = from->time_ns;
		to->code = from->code;
		to->error_register = from->error_register;
		memcpy(to->data, from->data, sizeof(to->data));
		snprintf(to->text, sizeof(to->text), "%s",
			 ec_emergency_text(from->code, i.profile));
	}
	if (total)
		*total = i.total;
	*list = l;
	return 0;
}
