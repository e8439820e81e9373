// SPDX-License-Identifier: GPL-2.0-only
/*
 * What one frame costs the simulator. Each case brings a segment to OP and
 * sends the frames of its cycle again and again; the cost of a frame is printed
 * in ticks of the time stamp counter: under QEMU's -icount these are instructions.
 * least_ns is the time of the cheapest cycle: others hold what else the host does.
 *
 * usage: sim-bench [CASE [CYCLES]]
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <x86intrin.h>

#include "describe.h"
#include "wire/al.h"

#define GAP_NS		20000u
#define CYCLE_NS	1000000u
#define LOGICAL		0x10000u

/**
 * struct bench - one case
 * @name: as printed
 * @text: its segment; all slaves are alike
 * @mbox: size of the mailboxes, 0: none
 * @out: bytes of outputs
 * @in: bytes of inputs
 * @out_at: place of the output SyncManager
 * @in_at: place of the input SyncManager
 * @overlapped: inputs and outputs share their logical addresses
 * @clocks: a drift compensation and a poll of the AL states in each cycle
 * @only: process data of the first slave alone, 0: of all
 */
struct bench {
	const char *name;
	const char *text;
	u16 mbox;
	u16 out;
	u16 in;
	u16 out_at;
	u16 in_at;
	bool overlapped;
	bool clocks;
	u32 only;
};

static const struct bench cases[] = {
	{ "io1000", "repeat 1000 slave d io out=8 in=0\n", 0, 1, 0, 0x1000, 0, true, false, 0 },
	{ "io1000-both", "repeat 1000 slave d io out=8 in=8\n", 0, 1, 1, 0x1000, 0x1004, true,
	  false, 0 },
	{ "io1000-clocks", "repeat 1000 slave d io out=8 in=8\n", 0, 1, 1, 0x1000, 0x1004, true,
	  true, 0 },
	{ "io1000-one", "repeat 1000 slave d io out=8 in=8\n", 0, 1, 1, 0x1000, 0x1004, true,
	  false, 1 },
	{ "drives100", "repeat 100 slave d drive out=8 in=8 drift=10ppm\n", 256, 8, 8, 0x1200,
	  0x1218, false, true, 0 },
	{ "drives100-overlapped", "repeat 100 slave d drive out=8 in=8 drift=10ppm\n", 256, 8, 8,
	  0x1200, 0x1218, true, true, 0 },
};

static struct ec_sim *sim;
static u64 now;
static u8 frame[EC_ETH_MAX];

static void *zalloc(size_t bytes)
{
	return calloc(1, bytes);
}

static const struct ec_sim_ops ops = { .alloc = zalloc, .free = free };

static void die(const char *why)
{
	fprintf(stderr, "sim-bench: %s\n", why);
	exit(1);
}

/* one datagram in a frame of its own; returns the working counter */
static int dgram(u8 cmd, u16 adp, u16 ado, void *data, u16 len)
{
	struct ec_frame_buf f;
	u8 *p;
	size_t n;

	ec_frame_begin(&f, frame, sizeof(frame));
	p = ec_frame_add(&f, cmd, 1, adp, ado, len);
	memcpy(p, data, len);
	n = ec_frame_end(&f);
	if (ec_sim_frame(sim, 0, frame, n, now) < 0)
		die("a frame was lost");
	now += GAP_NS;
	memcpy(data, p, len);
	return get_unaligned_le16(p + len);
}

static void write_sm(u16 station, int n, u16 start, u16 len, u8 control)
{
	struct ec_sm sm = { .start = start, .len = len, .control = control, .activate = 1 };
	u8 page[EC_SM_PAGE];

	if (!len)
		return;
	ec_sm_encode(&sm, page);
	if (dgram(EC_CMD_FPWR, station, (u16)EC_REG_SM(n), page, sizeof(page)) != 1)
		die("a SyncManager was not written");
}

static void write_fmmu(u16 station, int n, u32 logical, u16 len, u16 phys, u8 type)
{
	struct ec_fmmu f = {
		.logical = logical, .len = len, .lbit_stop = 7, .phys = phys, .type = type,
		.enable = true,
	};
	u8 page[EC_FMMU_PAGE];

	if (!len)
		return;
	ec_fmmu_encode(&f, page);
	if (dgram(EC_CMD_FPWR, station, (u16)EC_REG_FMMU(n), page, sizeof(page)) != 1)
		die("an FMMU was not written");
}

static void cycle(const struct bench *b, bool check);

/* requests a state of all slaves and waits for it */
static void reach(const struct bench *b, u8 state)
{
	u32 n = ec_sim_count(sim);
	u8 v[2] = { state, 0 };

	if (dgram(EC_CMD_BWR, 0, EC_REG_AL_CONTROL, v, 2) != (int)n)
		die("AL control was not written");
	for (int tries = 0; tries < 1000; tries++) {
		if (state == EC_AL_OP)
			cycle(b, false);
		now += CYCLE_NS;
		memset(v, 0, 2);
		dgram(EC_CMD_BRD, 0, EC_REG_AL_STATUS, v, 2);
		if (v[0] == state)
			return;
	}
	die("a state was not reached");
}

static void bring_up(const struct bench *b)
{
	u32 n = ec_sim_count(sim), out = LOGICAL, in = LOGICAL;
	u8 v[4];

	if (!b->overlapped)
		in += n * b->out;
	for (u32 i = 0; i < n; i++) {
		int sm = b->mbox ? 2 : 0;
		u16 station = (u16)(1001 + i);

		put_unaligned_le16(station, v);
		if (dgram(EC_CMD_APWR, (u16)-i, EC_REG_STATION, v, 2) != 1)
			die("a station address was not written");
		write_sm(station, 0, 0x1000, b->mbox, 0x26);
		write_sm(station, 1, (u16)(0x1000 + b->mbox), b->mbox, 0x22);
		write_sm(station, sm, b->out_at, b->out, 0x64);
		write_sm(station, sm + 1, b->in_at, b->in, 0x20);
		write_fmmu(station, 0, out, b->out, b->out_at, EC_FMMU_WRITE);
		write_fmmu(station, 1, in, b->in, b->in_at, EC_FMMU_READ);
		out += b->out;
		in += b->in;
	}
	reach(b, EC_AL_PREOP);
	reach(b, EC_AL_SAFEOP);
	reach(b, EC_AL_OP);
}

static u64 ticks, ns;
static u32 frames;

static u64 clock_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (u64)t.tv_sec * 1000000000u + (u64)t.tv_nsec;
}

/* a frame that is ready; the time of the model alone counts */
static void send_frame(struct ec_frame_buf *f)
{
	size_t n = ec_frame_end(f);
	u64 at = clock_ns(), t = __rdtsc();

	if (ec_sim_frame(sim, 0, frame, n, now) < 0)
		die("a frame was lost");
	ticks += __rdtsc() - t;
	ns += clock_ns() - at;
	frames++;
}

static void process_data(u8 cmd, u32 at, u32 len, u32 want, bool clocks, bool check)
{
	struct ec_frame_buf f;
	u8 *p;

	if (!len)
		return;
	ec_frame_begin(&f, frame, sizeof(frame));
	p = ec_frame_add(&f, cmd, 1, (u16)at, (u16)(at >> 16), (u16)len);
	memset(p, 0, len);
	if (clocks) {
		memset(ec_frame_add(&f, EC_CMD_FRMW, 1, 1001, EC_REG_DC_SYSTIME, 8), 0, 8);
		memset(ec_frame_add(&f, EC_CMD_BRD, 1, 0, EC_REG_AL_STATUS, 2), 0, 2);
	}
	send_frame(&f);
	if (check && get_unaligned_le16(p + len) != want)
		die("a working counter is wrong");
}

/* at most 1400 bytes of process data a frame */
static void cycle(const struct bench *b, bool check)
{
	u32 n = check && b->only ? b->only : ec_sim_count(sim);
	bool one = b->overlapped;

	if (one)
		process_data(EC_CMD_LRW, LOGICAL, n * max(b->out, b->in),
			     (b->out ? 2 * n : 0) + (b->in ? n : 0), b->clocks, check);
	else {
		process_data(EC_CMD_LWR, LOGICAL, n * b->out, n, false, check);
		process_data(EC_CMD_LRD, LOGICAL + n * b->out, n * b->in, n, false, check);
		if (b->clocks) {
			struct ec_frame_buf f;

			ec_frame_begin(&f, frame, sizeof(frame));
			memset(ec_frame_add(&f, EC_CMD_FRMW, 1, 1001, EC_REG_DC_SYSTIME, 8), 0, 8);
			memset(ec_frame_add(&f, EC_CMD_BRD, 1, 0, EC_REG_AL_STATUS, 2), 0, 2);
			send_frame(&f);
		}
	}
}

static void run(const struct bench *b, u32 cycles)
{
	struct ec_sim_error err;
	u64 least = ~0ull;

	if (ec_sim_describe(&sim, &ops, b->text, strlen(b->text), NULL, &err))
		die(err.text);
	now = CYCLE_NS;
	bring_up(b);
	for (u32 i = 0; i < cycles + 10; i++) {
		if (i == 10)
			ticks = frames = 0;
		now += CYCLE_NS;
		ns = 0;
		cycle(b, true);
		least = min(least, ns);
	}
	printf("%s slaves=%u ticks_per_frame=%llu least_ns=%llu ticks_per_cycle=%llu\n", b->name,
	       ec_sim_count(sim), (unsigned long long)(ticks / frames), (unsigned long long)least,
	       (unsigned long long)(ticks / cycles));
	ec_sim_free(sim);
}

int main(int argc, char **argv)
{
	u32 cycles = argc > 2 ? (u32)strtoul(argv[2], NULL, 0) : 200;
	bool found = false;

	if (!cycles)
		die("at least one cycle");
	for (size_t i = 0; i < ARRAY_SIZE(cases); i++) {
		if (argc > 1 && strcmp(argv[1], cases[i].name) && strcmp(argv[1], "all"))
			continue;
		run(&cases[i], cycles);
		found = true;
	}
	if (!found)
		die("no such case");
	return 0;
}
