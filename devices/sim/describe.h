/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Segments from a text. One statement a line, "#" begins a comment; names are
 * defined before they are used. Times are written 250ns, 10us, 1.5ms, 2s; a
 * bare number is in ns.
 *
 *	segment [seed=N] [response=TIME] [transition=TIME] [op_timeout=TIME] [link=TIME]
 *		[under_way=back|lost|random] (frames that come back to a closed loop)
 *	slave NAME DEVICE|file=IMAGE [OPTION...]
 *	repeat N slave NAME DEVICE [OPTION...]	NAME1, NAME2...; the alias counts up
 *		alias=N serial=N id=N vendor=N product=N revision=N
 *		delay=TIME drift=Nppm|Nppb clock=TIME dc=64|32|none cable=TIME
 *		response=TIME transition=TIME op_timeout=TIME
 *		mapping=fixed|assign|rewritable|lenient
 *		in=N out=N mbox=N (drive: bytes)  in=N out=N cpu=yes|no (io: bits)
 *		soe=N (SoE with N drives)  voe=TYPE (VoE, type of the answers)
 *		foe=KIB (FoE, largest file)  foe_busy=N (BUSY answers after 4 KiB of a write)
 *		foe_page=TIME (BUSY so long)  foe_header=TEXT (files begin so)
 *		foe_boot=yes|no (writes in BOOT only)
 *		repeat=yes|no (mailbox messages)  strict=yes|no (mailbox SyncManagers)
 *		mbox_words=no mbox_protocols=no (what its EEPROM says of the mailbox)
 *		assign_out=N,N...|none assign_in=N,N...|none (0x1C1x at power-on)
 *		sm_out=N sm_in=N (SyncManagers of a drive or io)
 *		fixed=N,N... (PDOs and assignments)  dc_modes=N,N... (AssignActivate)
 *		transition_preop|boot|safeop|op=TIME (steps towards OP)
 *		ack=no (AL errors)  own_eeprom=yes  lrw=no  frmw=no  swap=yes (cables)
 *		id_delay=TIME (from the request of the identification to the answer)
 *		loops=fixed (0x0101 does not keep what is written)
 *		link=TIME (from cable and power to a link)
 *	branch NAME PORT		the next slave hangs there
 *	branch none			the next slave hangs nowhere, until it is plugged
 *	wire NAME.PORT -> NAME.PORT [cable=TIME]	"master.0", "master.1" too
 *	connect NAME.CHANNEL -> NAME.CHANNEL	an output to an input
 *	const NAME.CHANNEL value=N
 *	ramp NAME.CHANNEL amplitude=N period=TIME [offset=N]
 *	sine NAME.CHANNEL amplitude=N period=TIME [offset=N]
 *	fault [at=TIME] WHAT [frame=N [register=N] [when=out|back] [after=TIME]],
 *		with the n-th frame from then on, where WHAT is one of
 *		plug NAME.PORT NAME.PORT [cable=TIME]  unplug NAME.PORT
 *		swap NAME NAME (slaves)  swap NAME.PORT NAME.PORT (branches)
 *		host NAME.PORT [every=TIME] [frames=broadcast|ethercat] (a PC or a switch,
 *			and its frames)
 *		bounce NAME.PORT pattern=01001 [step=TIME] [times=N] (contact)
 *		old NAME [station=N] [loops=N] [state=STATE] [logical=N] (registers)
 *		cut|heal NAME.PORT  off|on NAME  dead|alive NAME
 *		deaf|hear NAME (broadcasts)  mute|unmute NAME (application)
 *		refuse NAME STATE code=N  allow NAME
 *		busy|idle NAME (EEPROM)  noack NAME count=N (EEPROM)
 *		wkc NAME add=N  errors NAME.PORT add=N
 *		damage NAME.PORT rate=Nppm (frames that come there by the cable)
 *		mailbox NAME good|length|short|counter|type|babble|stale|fragments (its messages)
 *		mailbox NAME error|abort|deny code=N (likewise)
 *		mailbox NAME delay by=TIME (likewise)
 *		mailbox NAME busy|garbage|duplicate|lost|almost (likewise)
 *		mailbox ... after=N (N more messages are right)
 *		latch NAME 0|1 [edge=rising|falling|pulse] (an input of its clock)
 *		jump NAME by=TIME (its clock; by=-TIME: back)
 *		error NAME code=N (AL status code; out of OP)
 *		eeprom NAME word=N value=N  input NAME.CHANNEL value=N
 *		emergency NAME code=N [register=N]
 *		voe NAME [vendor=N] [type=N] [size=N] (a VoE message)
 *		lose|mangle|duplicate|delay frame=N|rate=Nppm [port=0|1]
 *			[copies=N] [by=TIME] [register=N] [when=out|back]
 *
 * Slaves hang in a line, port 0 at port 1 of the slave before.
 */
#ifndef EC_SIM_DESCRIBE_H
#define EC_SIM_DESCRIBE_H

#include "app.h"

/**
 * struct ec_sim_loader - where EEPROM images come from
 * @load: put image @name into @buf, return its bytes or -errno
 * @ctx: first argument
 */
struct ec_sim_loader {
	int (*load)(void *ctx, const char *name, u8 *buf, size_t cap);
	void *ctx;
};

/**
 * struct ec_sim_error - what is wrong with a description
 * @line: where, from 1; 0: all of it
 * @text: why, and what to do
 */
struct ec_sim_error {
	unsigned int line;
	char text[160];
};

int ec_sim_describe(struct ec_sim **out, const struct ec_sim_ops *ops,
		    const char *text, size_t len,
		    const struct ec_sim_loader *loader,
		    struct ec_sim_error *err);
int ec_sim_command(struct ec_sim *sim, const struct ec_sim_ops *ops, const char *text,
		   size_t len, struct ec_sim_fault *f, struct ec_sim_error *err);
void ec_sim_show(const struct ec_sim *sim, u32 index, char *buf, size_t size);
struct ec_app *ec_sim_find(struct ec_sim *sim, const char *name);
const char *ec_sim_builtin(const char *name);
const char *ec_sim_builtin_at(u32 n);

#endif
