// SPDX-License-Identifier: GPL-2.0-only
/* Names of the deliberate errors, and their switch. */
#include "esc_int.h"

static const char * const bug_names[EC_SIM_BUGS] = {
	[EC_SIM_BUG_NONE] = "none",
	[EC_SIM_BUG_LRW_WKC] = "lrw_wkc",
	[EC_SIM_BUG_BRD_NO_OR] = "brd_no_or",
	[EC_SIM_BUG_AP_NO_INC] = "ap_no_inc",
	[EC_SIM_BUG_SM_DIRECTION] = "sm_direction",
	[EC_SIM_BUG_MBOX_FULL] = "mbox_full",
	[EC_SIM_BUG_MBOX_EMPTY] = "mbox_empty",
	[EC_SIM_BUG_EEP_NEVER_BUSY] = "eep_never_busy",
	[EC_SIM_BUG_EEP_ADDRESS] = "eep_address",
	[EC_SIM_BUG_EEP_READ8] = "eep_read8",
	[EC_SIM_BUG_FMMU_SHIFT] = "fmmu_shift",
	[EC_SIM_BUG_FMMU_LENGTH] = "fmmu_length",
	[EC_SIM_BUG_LWR_INPUTS] = "lwr_inputs",
	[EC_SIM_BUG_WKC_PER_FMMU] = "wkc_per_fmmu",
	[EC_SIM_BUG_NO_ALIAS] = "no_alias",
	[EC_SIM_BUG_FRMW_WKC] = "frmw_wkc",
	[EC_SIM_BUG_LOOPS_INVERTED] = "loops_inverted",
	[EC_SIM_BUG_AL_NO_OR] = "al_no_or",
	[EC_SIM_BUG_CIRCULATING] = "circulating",
	[EC_SIM_BUG_NO_RECV_TIMES] = "no_recv_times",
	[EC_SIM_BUG_EVENT_STUCK] = "event_stuck",
	[EC_SIM_BUG_DC_JUMP] = "dc_jump",
	[EC_SIM_BUG_DIFF_TWOS] = "diff_twos",
	[EC_SIM_BUG_BRW_WKC] = "brw_wkc",
	[EC_SIM_BUG_READ_ONLY] = "read_only",
	[EC_SIM_BUG_IRQ_NO_MASK] = "irq_no_mask",
	[EC_SIM_BUG_SM_ONE_BUFFER] = "sm_one_buffer",
	[EC_SIM_BUG_SM_STATUS] = "sm_status",
	[EC_SIM_BUG_AL_OVERWRITE] = "al_overwrite",
	[EC_SIM_BUG_WD_DEAF] = "wd_deaf",
	[EC_SIM_BUG_ERRORS_KEPT] = "errors_kept",
	[EC_SIM_BUG_LOST_UNCOUNTED] = "lost_uncounted",
	[EC_SIM_BUG_EEP_WRITE_LOST] = "eep_write_lost",
	[EC_SIM_BUG_EEP_ENABLE] = "eep_enable",
	[EC_SIM_BUG_PORT_ORDER] = "port_order",
	[EC_SIM_BUG_CUT_OPEN] = "cut_open",
	[EC_SIM_BUG_NO_DELAY] = "no_delay",
	[EC_SIM_BUG_RECV_SAME] = "recv_same",
	[EC_SIM_BUG_OFFSET_SIGN] = "offset_sign",
	[EC_SIM_BUG_DC_DELAY] = "dc_delay",
	[EC_SIM_BUG_DC_DRIFT] = "dc_drift",
	[EC_SIM_BUG_SYNC_LATE] = "sync_late",
	[EC_SIM_BUG_AL_CODE] = "al_code",
	[EC_SIM_BUG_AL_SKIP] = "al_skip",
	[EC_SIM_BUG_AL_NO_ACK] = "al_no_ack",
	[EC_SIM_BUG_SM_UNCHECKED] = "sm_unchecked",
	[EC_SIM_BUG_WD_OUTPUTS] = "wd_outputs",
	[EC_SIM_BUG_OUTPUTS_EARLY] = "outputs_early",
	[EC_SIM_BUG_PDO_FIXED] = "pdo_fixed",
	[EC_SIM_BUG_MBOX_COUNTER] = "mbox_counter",
	[EC_SIM_BUG_MBOX_REPEAT] = "mbox_repeat",
	[EC_SIM_BUG_MBOX_TWICE] = "mbox_twice",
	[EC_SIM_BUG_SDO_TOGGLE] = "sdo_toggle",
	[EC_SIM_BUG_SDO_SIZE] = "sdo_size",
	[EC_SIM_BUG_SDO_ABORT] = "sdo_abort",
	[EC_SIM_BUG_INFO_LIST] = "info_list",
	[EC_SIM_BUG_PROTECT] = "protect",
	[EC_SIM_BUG_PROTECT_OPEN] = "protect_open",
	[EC_SIM_BUG_WD_PDI] = "wd_pdi",
	[EC_SIM_BUG_EEP_PDI_LATE] = "eep_pdi_late",
	[EC_SIM_BUG_EEP_PDI_HIDDEN] = "eep_pdi_hidden",
	[EC_SIM_BUG_SYNC_NO_ACK] = "sync_no_ack",
	[EC_SIM_BUG_UDP_CHECKSUM] = "udp_checksum",
	[EC_SIM_BUG_AUTO_CLOSE] = "auto_close",
	[EC_SIM_BUG_LOOPS_STAY] = "loops_stay",
	[EC_SIM_BUG_FORWARD] = "forward",
	[EC_SIM_BUG_DL_SILENT] = "dl_silent",
};

/**
 * ec_sim_bug_name() - name of a deliberate error
 * @bug: which
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the name, NULL for an unknown one.
 */
const char *ec_sim_bug_name(enum ec_sim_bug bug)
{
	return (u32)bug < EC_SIM_BUGS ? bug_names[bug] : NULL;
}

/**
 * ec_sim_set_bug() - let the model be wrong in one way
 * @sim: segment
 * @bug: which, EC_SIM_BUG_NONE: be right
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_set_bug(struct ec_sim *sim, enum ec_sim_bug bug)
{
	u32 i;

	for (i = 0; i < sim->count; i++) {
		ec_esc_settle(sim->esc[i]);
		ec_esc_quick_forget(sim->esc[i]);
	}
	sim->bug = bug;
	sim->dirty = true;	/* routes may be wrong, too */
}

/**
 * ec_sim_has_bug() - is the model wrong in this way
 * @sim: segment
 * @bug: which
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: as ec_sim_set_bug() chose.
 */
bool ec_sim_has_bug(const struct ec_sim *sim, enum ec_sim_bug bug)
{
	return sim->bug == bug;
}
