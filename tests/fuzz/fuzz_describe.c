// SPDX-License-Identifier: GPL-2.0-only
/* Descriptions of segments: built, or refused with a line and a reason. */
#include "fuzz_sim.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("segment seed=4 response=200us transition=1ms\n"
	     "slave c EK1100 drift=12ppm alias=7\nslave o EL2008\nslave i EL1008\n"
	     "branch c 2\nslave d drive in=22 out=22 mapping=rewritable id=11\n"
	     "connect o.1 -> i.1\n"),
	SEED("slave ai EL3062\nslave ao EL4002\nsine ai.1 amplitude=10 period=4ms offset=5\n"
	     "ramp ai.2 amplitude=3 period=1s\nconst ai.1 value=-5\n"),
	SEED("repeat 5 slave t io in=8 out=8 cpu=no alias=100\nwire t1.2 -> t5.1 cable=20\n"),
	SEED("repeat 5 slave t io\nwire t5.1 -> t1.2\nwire t4.2 -> t2.3\nwire t3.2 -> t2.0\n"),
	SEED("slave a EL7201 motor=AM8121\nslave b 750-354 serial=1 delay=2us clock=1s\n"
	     "wire b.1 -> master.1\n"),
	SEED("slave d drive\nfault at=1s lose frame=3\nfault mangle rate=100ppm port=1\n"
	     "fault at=2ms cut d.0\nfault refuse d SAFEOP code=0x1d\nfault noack d count=3\n"
	     "fault wkc d add=-1\nfault errors d.0 add=4\n"
	     "fault emergency d code=0x8130 register=1\nfault duplicate frame=2 copies=2\n"
	     "fault delay frame=1 by=3us\n"),
	SEED("slave x file=image.bin\n"),
	SEED("slave a drive mbox_words=no mbox_protocols=no assign_out=none assign_in=0,0x1A00 ack=no\n"
	     "slave b drive transition=1ms transition_safeop=5s transition_op=1min own_eeprom=yes\n"
	     "slave c drive lrw=no frmw=no swap=yes\nslave d io swap=yes\n"),
	SEED("slave a drive in=40 sm_in=3 sm_out=2 mapping=lenient\nslave b io sm_in=2 in=9\n"),
	SEED("slave a drive fixed=0x1600,0x1C13 dc_modes=0,0x0500\nfault at=1ms jump a by=-1.5s\n"
	     "fault at=2ms jump a by=9min\n"),
	SEED("segment under_way=random link=1us\nslave a EK1100 loops=fixed\nslave b EK1100 link=0\n"
	     "slave c drive\nwire c.1 -> master.1\nbranch none\nslave d EL2008\n"
	     "fault at=1ms plug a.2 d.0 cable=20us\nfault host b.2 every=100us frames=ethercat\n"
	     "fault bounce c.0 pattern=0011 step=300ns times=9\nfault at=3ms unplug a.2\n"),
	SEED("segment under_way=lost\nslave a EK1100\nslave b EL2008\nbranch a 2\nslave c EL2008\n"
	     "fault cut b.0 frame=1 when=out\nfault heal a.1 frame=2 register=0x130 when=back\n"
	     "fault swap b c frame=1 after=3us\nfault old c station=7 state=OP logical=4 loops=12\n"
	     "fault off b frame=3\nfault lose frame=1 when=out register=0x101\n"),
	{ NULL, 0 }
};

static int no_image(void *ctx, const char *name, u8 *buf, size_t cap)
{
	(void)ctx;
	MUST(cap && strlen(name) < 4096);
	buf[0] = 0;
	return -ENOENT;
}

static const struct ec_sim_loader loader = { no_image, NULL };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	/* broadcast read of the AL status */
	u8 frame[] = { 0x0E, 0x10, 7, 1, 0, 0, 0x30, 1, 2, 0, 0, 0, 0, 0, 0, 0 };
	bool starve = len % 5 == 4;
	struct ec_sim *sim;
	u32 i;

	sim = fuzz_describe((const char *)data, len, len & 1 ? &loader : NULL,
			    starve ? data[len / 2] % 32 : -1);
	if (!sim)
		return 0;
	MUST(ec_sim_count(sim) <= 65535);
	for (i = 0; i < 3; i++)
		ec_sim_frame(sim, (int)(i & 1), frame, sizeof(frame), 1000000 * i);
	ec_sim_advance(sim, 20000000);
	fuzz_release(sim);
	return 0;
}
