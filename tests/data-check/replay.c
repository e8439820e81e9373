// SPDX-License-Identifier: GPL-2.0-only
/*
 * A captured conversation of another master with real slaves, replayed into
 * the model: what it sent goes to simulated slaves of the same kind, and the
 * addresses and working counters that come back must be those of the bus.
 */
#include "check.h"
#include "../../devices/sim/describe.h"
#include "../../master/wire/frame.h"
#include <stdlib.h>
#include <string.h>

static const char segment[] = "slave coupler EK1100\nslave in EL1004\n";

static struct ec_sim *sim;
static unsigned long sent, compared, different;
static u8 waiting[2048];
static size_t waiting_len;
static u64 now;

static void *alloc(size_t bytes)
{
	return calloc(1, bytes);
}

static const struct ec_sim_ops ops = { alloc, free };

static void station(u16 adp, u16 address)
{
	u8 f[64], *p;
	struct ec_frame_buf b;

	ec_frame_begin(&b, f, sizeof(f));
	p = ec_frame_add(&b, EC_CMD_APWR, 0, adp, EC_REG_STATION, 2);
	put_unaligned_le16(address, p);
	ec_sim_frame(sim, 0, f, ec_frame_end(&b), now += 1000000);
}

static void differ(const struct ec_dgram *real, const struct ec_dgram *ours)
{
	different++;
	printf("  command %u adp %04x ado %04x len %u: %u at adp %04x on the bus, %u at %04x in the model\n",
	       real->cmd, real->adp, real->ado, real->len, ec_dgram_wkc(real),
	       real->adp, ec_dgram_wkc(ours), ours->adp);
}

/* @p came back from the bus; what was sent before it is in @waiting */
static void came_back(u8 *p, size_t len)
{
	struct ec_frame_iter a, b;
	struct ec_dgram real, ours;

	if (!waiting_len || ec_sim_frame(sim, 0, waiting, waiting_len, now += 100000) < 0 ||
	    ec_frame_iter_init(&a, p, len) || ec_frame_iter_init(&b, waiting, waiting_len))
		return;
	waiting_len = 0;
	while (ec_frame_iter_next(&a, &real) == 1 && ec_frame_iter_next(&b, &ours) == 1) {
		if (real.cmd != ours.cmd || real.idx != ours.idx || real.len != ours.len)
			return;		/* the answer to another frame */
		compared++;
		if (real.adp != ours.adp || ec_dgram_wkc(&real) != ec_dgram_wkc(&ours))
			differ(&real, &ours);
	}
}

static void packet(u8 *p, size_t len)
{
	if (len < 16 || p[12] != 0x88 || p[13] != 0xA4)
		return;
	if (p[6] & 2) {
		came_back(p + 14, len - 14);
	} else if (len - 14 <= sizeof(waiting)) {
		waiting_len = len - 14;
		memcpy(waiting, p + 14, waiting_len);
		sent++;
	}
}

int check_replay(const char *path, const u8 *data, size_t len, char *note, size_t cap)
{
	struct ec_sim_error err;
	size_t at, size;

	(void)path;
	sent = compared = different = 0;
	now = 0;
	waiting_len = 0;
	if (ec_sim_describe(&sim, &ops, segment, sizeof(segment) - 1, NULL, &err)) {
		snprintf(note, cap, "line %u: %s", err.line, err.text);
		return 1;
	}
	station(0, 1001);
	station((u16)-1, 1002);
	for (at = 0; len - at >= 32; at += size) {
		size = get_unaligned_le32(data + at + 4);
		if (size < 12 || size > len - at)
			break;
		if (get_unaligned_le32(data + at) == 6 &&	/* enhanced packet block */
		    size >= 32 && get_unaligned_le32(data + at + 20) <= size - 32)
			packet((u8 *)data + at + 28, get_unaligned_le32(data + at + 20));
	}
	ec_sim_free(sim);
	snprintf(note, cap, "replayed into the model: %lu frames, %lu datagrams compared, %lu differ",
		 sent, compared, different);
	return different || !compared;
}
