// SPDX-License-Identifier: LGPL-2.1-or-later
/* Network devices of slaves with EoE. */
#include "internal.h"
#include "text.h"

#define COPY(field) (to->field = from->field)

static void convert(struct ect_eoe *to, const struct ec_ioc_eoe *from)
{
	COPY(index);
	COPY(device);
	COPY(position);
	to->connected = !!(from->state & EC_EOE_CONNECTED);
	to->up = !!(from->state & EC_EOE_UP);
	to->running = !!(from->state & EC_EOE_RUNNING);
	memcpy(to->address, from->address, sizeof(to->address));
	COPY(waiting);
	COPY(room);
	COPY(rx_rate);
	COPY(tx_rate);
	COPY(rx_frames);
	COPY(rx_bytes);
	COPY(rx_errors);
	COPY(rx_missed);
	COPY(rx_dropped);
	COPY(tx_frames);
	COPY(tx_bytes);
	COPY(tx_lost);
	COPY(tx_dropped);
	memcpy(to->name, from->name, sizeof(from->name));
	to->name[sizeof(from->name)] = 0;
	string_clean(to->name, sizeof(to->name));
}

int ect_eoe_read(struct ect_handle *h, unsigned int index, struct ect_eoe *e)
{
	struct ec_ioc_eoe i = { .index = index };
	struct ect_eoe own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_EOE, &i);

	if (ret)
		return ret;
	convert(&own, &i);
	return ect_give(h, e, &own, sizeof(own));
}

int ect_eoe_wish(struct ect_handle *h, uint64_t device, unsigned int wish)
{
	struct ec_ioc_eoe_wish i = { .wish = wish, .slave = ect_address(device) };

	return ect_command(h, EC_IOC_EOE_WISH, &i);
}
