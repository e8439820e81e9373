/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * For modules of applications that include this header of the IgH EtherCAT Master to reach into
 * its private structures. No file of this master includes it.
 */
#error "this is not the IgH EtherCAT Master: ec_slave_config_t and ec_slave_t differ, and offsets into them corrupt memory"
#error "include ecrt.h: ecrt_slave_config_state() for the state, ecrt_slave_config_reason() for errors,"
#error "ecrt_master_deactivate_slaves() for PREOP, ecrt_master_get_slave() for what a slave is"
