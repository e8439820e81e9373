/* SPDX-License-Identifier: GPL-2.0-only */
/* Parts of trials; see trial.c. */
#ifndef EC_TRIAL_INT_H
#define EC_TRIAL_INT_H

#include "../carry/dg.h"
#include "border.h"
#include "gap.h"
#include "slave.h"

#define EC_TRIAL_WORK	9	/* datagrams of the work, at most */
#define EC_TRIAL_TRIES	3
/* datagrams of a trial: opened and closed twice, five checks */
#define EC_TRIAL_TRAIN	(EC_TRIAL_WORK + 9 + 2 * EC_GAP_FRAMES)

/**
 * struct ec_host - a slave at whose port something is tried
 * @station: its station address
 * @position: its ring position
 * @control: register 0x0100
 * @loops: register 0x0101 with all ports closed behind which nothing is known
 * @device: number of the slave; 0: a new one
 */
struct ec_host {
	u16 station;
	u16 position;
	u8 control;
	u8 loops;
	u64 device;
};

/**
 * struct ec_guest - a slave that was found there
 * @station: its station address
 * @first: that the first try gave it
 * @kept: address that it had, 0: none that it may have again
 * @entry: port by which frames come in
 * @mute: no frame to it has returned
 * @behind: slaves from it on
 * @info: registers from 0x0000 on
 * @station_was: station address that it had, and its alias
 * @dl: DL status
 * @control: registers 0x0100 and 0x0101
 * @al: AL status
 * @times: receive times of its ports
 */
struct ec_guest {
	u16 station;
	u16 first;
	u16 kept;
	u8 entry;
	bool mute;
	u32 behind;
	u8 info[EC_INFO_SIZE];
	u8 station_was[4];
	u8 dl[2];
	u8 control[2];
	u8 al[2];
	u8 times[16];
};

/**
 * struct ec_trials - trials at a port
 * @bus: bus
 * @host: slave with the port
 * @port: port
 * @position: of the first slave behind the port
 * @branch_ns: a frame is in the branches of the host that it passes before the port for so long
 * @next: slave of the list at that position now; NULL: there is none
 * @slave: slave of the list that @host is; NULL: it is a guest
 * @mute: no frame returned at the last look
 * @dl: DL status of the host at the end of the last trial
 * @count: slaves that reply then
 * @door: what is known of the port; NULL: it is that of a guest
 * @train: memory for the datagrams of a trial
 * @work: datagrams of the next trial, then of the last one
 * @n: how many
 * @was: that it reads the station address which it writes; NULL: it writes none
 * @is: result: a device that is not let in
 */
struct ec_trials {
	struct ec_bus *bus;
	struct ec_host host;
	u8 port;
	u16 position;
	u32 branch_ns;
	const struct ec_slave *next;
	struct ec_slave *slave;
	bool mute;
	u16 dl;
	u16 count;
	struct ec_door *door;
	struct ec_dg *train;
	struct ec_dg work[EC_TRIAL_WORK];
	unsigned int n;
	const u8 *was;
	struct ec_behind is;
};

/* trial.c */
void ec_trial_look_for_lost(struct ec_trials *t);

/* trial_run.c */
struct ec_dg *ec_trial_add(struct ec_trials *t, struct ec_dg dg);
int ec_trial_run(struct ec_trials *t, u16 station);

/* trial_judge.c */
bool ec_trial_in_boot(struct ec_trials *t, const struct ec_guest *g);
int ec_trial_judge(struct ec_trials *t, struct ec_guest *g);

#endif
