/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * All texts of ect_why(), one row for each: cause for programs, level, names of the numbers,
 * remedy, what was found. A remedy with a place is a row of WHY_REMEDIES().
 */
#ifndef EC_LIB_TOOLS_WHY_TEXTS_H
#define EC_LIB_TOOLS_WHY_TEXTS_H

#define WHY_SCAN_REMEDY	"repeat the command when the scan is complete"
#define WHY_PORT_ERRORS	"%u invalid frame(s), %u receive error(s), link lost %u time(s)"
/* this version writes no EEPROM */
#define WHY_EEPROM_REMEDY \
	"repair the EEPROM with the tool of the manufacturer, or replace the slave; its content: 'ethercat sii_read -v'"

#define WHY_CABLE_REMEDY \
	"check the cable or contact behind this port, and the power of the next slave"

#define WHY_TEXTS(X) \
	/* the whole bus */ \
	X(NO_DEVICE, "no_device", FAULT, "", \
	  "load the driver of the network card and ec_generic, or bind its native driver: 'ethercat device bind'; or select another card: 'ethercat devices', 'ethercat device use'", \
	  "no network device: master %u waits for %s") \
	X(NO_SIM, "no_device", FAULT, "", \
	  "load the simulated segment: 'modprobe ec_sim segment=bench'; for a network card give ec_master its address, see 'ethercat devices'", \
	  "no network device: master %u waits for %s") \
	X(LINK_DOWN, "link_down", FAULT, "", \
	  "check the cable from this port to the input of the first slave, and the power of this slave", \
	  "no link at the main device %s") \
	X(NO_SLAVES, "no_slaves", FAULT, "", \
	  "check that the cable leads to the input (port 0) of an EtherCAT slave, without a switch in between", \
	  "link up at the main device %s, but no slave replies") \
	X(SCAN, "scan", WARNING, "slaves_read slaves", WHY_SCAN_REMEDY, \
	  "bus scan in progress: %u of %u slaves read") \
	X(RING_OPEN, "ring_open", WARNING, "", \
	  "check the cable there, and the power of both slaves; all slaves run on, but those between this break and a second one would stop", \
	  "ring open between %s and %s") \
	X(RING_END, "ring_open", WARNING, "", \
	  "check the cable of the device there; all slaves run on, but a break of the ring would stop some", \
	  "ring open between %s and %s") \
	X(RING_TURNED, "ring_turned", FAULT, "", \
	  "exchange the cables of this slave, so that its port 0 leads towards the main device; with a branch in the ring connect that to an earlier port than the ring (order of ports: 3, 1, 2), with one end; until then no application is activated, as the order of the slaves changes when the ring opens", \
	  "%s is connected the wrong way round in the ring, or beside a branch at a wrong port") \
	X(RING_EXCHANGED, "ring_exchanged", WARNING, "", \
	  "exchange the cables of the two devices, or the names MASTER<n>_DEVICE and MASTER<n>_BACKUP", \
	  "devices of the ring exchanged: %s, configured as backup device, is at port 0 of the first slave, and is used as main device") \
	/* the cycle */ \
	X(NO_CYCLE, "no_cycle", FAULT, "", \
	  "let the application call ecrt_master_receive() and ecrt_master_send() in each cycle, or let the kernel run the cycle: ecrt_master_set_cycle()", \
	  "the application is active but sends no cyclic frames") \
	X(CYCLE_TOO_SHORT, "cycle_too_short", FAULT, "wire_us cycle_us", \
	  "lengthen the cycle, or give domains of slow data a division", \
	  "the frames of a cycle need %u us on the wire, the cycle is %u us") \
	X(OUTPUT_STOP, "output_stall", FAULT, "", \
	  "find out why the application gave no outputs, then restart it", \
	  "output stall: the application gave no outputs, and the kernel has stopped the cycle (EC_CYCLE_STOP)") \
	X(OUTPUT_ZERO, "output_stall", FAULT, "", \
	  "find out why the application gives no outputs: does it still run, does it wait for something?", \
	  "output stall: the application gives no outputs; the kernel sends zeros (EC_CYCLE_ZERO)") \
	X(OUTPUT_HOLD, "output_stall", FAULT, "", \
	  "find out why the application gives no outputs: does it still run, does it wait for something?", \
	  "output stall: the application gives no outputs; the kernel holds the last ones (EC_CYCLE_HOLD)") \
	/* sync units */ \
	X(UNIT_DOWN, "unit_failed", FAULT, "faults", \
	  "repair the cause: 'ethercat log' names it; then let the application give authority: ecrt_master_unit_authority(), or restart it", \
	  "unit %s has failed: by its policy its outputs are zero and its slaves in SAFEOP") \
	X(UNIT_STOPPED, "unit_failed", FAULT, "faults", \
	  "repair the cause: 'ethercat log' names it; then let the application give authority to this unit: ecrt_master_unit_authority(), or restart it", \
	  "unit %s has failed: by its policy all outputs are zero, and all slaves in SAFEOP") \
	X(UNIT_LEASE, "unit_lease", FAULT, "lease_cycles", \
	  "find out why the application that gives these outputs does not: does it still run, does it wait for something?", \
	  "unit %s: no new outputs within its lease of %u cycle(s); its outputs are %s") \
	X(UNIT_NO_AUTHORITY, "no_authority", WARNING, "", \
	  "let the application give authority: ecrt_master_unit_authority(); 'ethercat log' says if it was taken", \
	  "unit %s has no authority: its outputs are %s") \
	X(OVERRUNS, "overruns", WARNING, "skipped cycles", \
	  "check the settings for real time: 'ethercat rtcheck'; see 'ethercat cycle -v'", \
	  "%llu of %llu cycles skipped: the cycle owner was late by a period or more") \
	X(NOT_QUEUED, "not_queued", FAULT, "cycles", \
	  "let the application call ecrt_domain_queue() for this domain in each cycle, before ecrt_master_send()", \
	  "domain %u: the application has not queued it in %u cycles, so its process data are not exchanged") \
	X(LATE_FRAMES, "late_frames", WARNING, "frames", \
	  "check the CPU of the cycle and the interrupt of the network card: 'ethercat rtcheck', 'ethercat cycle -v'", \
	  "%llu %s in %u ms returned after the next cycle had begun: working counters are incomplete then, and no slave or cable is at fault") \
	X(LOST_FRAMES, "lost_frames", WARNING, "frames_per_s", \
	  "repair the cables whose ports count errors, see there", \
	  "%s loses %u %s per second (average over 10 s)") \
	/* configurations without slave */ \
	X(CABLE, "cable", FAULT, "", WHY_CABLE_REMEDY, \
	  "no slave behind port %u of %s, link %s; lost: %s") \
	X(CABLE_OF, "cable", FAULT, "slaves", WHY_CABLE_REMEDY, \
	  "behind port %u of %s: %u %s disconnected, since %s, the first: slave %u (%s); link %s") \
	X(CABLE_LOST, "cable", FAULT, "", \
	  "check cables and power up to the first lost slave", "%s") \
	X(LOST_AGAIN, "scan", UNDER_WAY, "slaves_read slaves", WHY_SCAN_REMEDY, \
	  "slaves reply again, %u of %u are read; the scan shows whether those behind port %u of %s reply as well; lost before: %s") \
	X(ABSENT, "absent", WARNING, "slaves", \
	  WHY_CABLE_REMEDY "; if they were removed on purpose: 'ethercat rescan'", \
	  "behind port %u of %s: %u %s disconnected, since %s, the first: slave %u (%s); link %s") \
	X(PORT_KEPT, "port_closed", WARNING, "", "", \
	  "port %u of %s stays closed despite its link: %s%s") \
	X(MISSING, "missing", FAULT, "missing", \
	  "check power and cable of the missing slaves, or correct the configuration", \
	  "%u %s missing from position %u on: the bus has %zu, %s %s") \
	X(MISSING_ONE, "missing", FAULT, "", \
	  "check power and cable of the missing slave, or correct the configuration", "%s") \
	X(WRONG_PLACE, "wrong_place", FAULT, "", \
	  "connect the slaves in the configured order, or correct the position in the application", \
	  "the device configured at %u:%u is at position %u: %s") \
	X(DIFFERENT, "different", FAULT, "", \
	  "connect the configured device, or configure this one in the application", \
	  "another device than configured at %u:%u: %s") \
	X(NO_ALIAS, "no_alias", FAULT, "alias", \
	  "use the ring position, or set the alias with the tool of the manufacturer (this version writes no EEPROM)", \
	  "no slave has alias %u") \
	X(NO_ALIAS_BUT, "no_alias", FAULT, "alias", \
	  "use the ring position, or set the alias with the tool of the manufacturer (this version writes no EEPROM)", \
	  "no slave has alias %u; %s is such a device, alias %u") \
	X(ATTACHING, "attaching", UNDER_WAY, "", "repeat the command", "%s") \
	X(TAKEN, "taken", FAULT, "", "connect the missing slave or restart the application", "%s") \
	X(RING_PLACE, "ring_place", FAULT, "", \
	  "close the ring, or restore the power of the slave that is missing at its break", "%s") \
	X(GROUP_ABSENT, "group_absent", FAULT, "", \
	  "connect the group, or configure it as optional", "%s") \
	X(GROUP_WRONG, "group_not_started", FAULT, "", \
	  "connect what the application expects of this group, or change its configuration", "%s") \
	/* slaves; "%s" is a text of the kernel */ \
	X(REQUESTED, "not_requested", FAULT, "", "", "%s") \
	X(UNDER_WAY, "under_way", UNDER_WAY, "", \
	  "repeat the command; nothing has failed so far", "%s") \
	X(SILENT, "no_reply", FAULT, "", \
	  "power-cycle the slave; replace it if it stays silent", "%s") \
	X(REGISTERS, "no_reply", FAULT, "", \
	  "check the cables of the slave; power-cycle or replace it", "%s") \
	X(EEPROM, "eeprom", FAULT, "", WHY_EEPROM_REMEDY, "%s") \
	X(EEPROM_PART, "eeprom_reading", WARNING, "", "wait until the EEPROM has been read", "%s") \
	X(EEPROM_FLAW, "eeprom", WARNING, "", WHY_EEPROM_REMEDY, "%s") \
	X(IDN, "idn", FAULT, "", \
	  "correct the startup IDN in the application: 'ethercat soe_read'", "%s") \
	X(REGISTER, "register", FAULT, "", "correct the startup register in the application", "%s") \
	X(IP, "ip", FAULT, "", \
	  "correct the IP parameters in the application, or remove them", "%s") \
	X(LAYOUT, "layout", FAULT, "", \
	  "change domains and PDOs of the application as the text says", "%s") \
	X(SYNC, "sync", FAULT, "", \
	  "correct the SYNC signals in the application: ecrt_slave_config_dc(); compare with the ESI", \
	  "%s") \
	X(SLOW, "al_timeout", FAULT, "", \
	  "check that the application of the slave runs: LEDs, 'ethercat diag'; or allow more time: ecrt_slave_config_state_timeout(), state_timeout_ms of ec_master", \
	  "%s") \
	X(FRAMES, "frames", FAULT, "", "look for the cable with errors: 'ethercat crc'", "%s") \
	X(MEMORY, "memory", FAULT, "", \
	  "free memory of this computer; the master tries again", "%s") \
	X(NOT_IN_OP, "not_in_op", FAULT, "", "see 'ethercat config -v' and the kernel log", "%s") \
	X(SDO, "sdo", FAULT, "", "", "%s") \
	X(MAILBOX, "mailbox", FAULT, "", \
	  "power-cycle the slave: its mailbox does not reply as the protocol demands; if that stays, compare its mailbox and protocols ('ethercat slaves -v') with the manual", \
	  "%s") \
	X(MAILBOX_FLAW, "mailbox", WARNING, "", \
	  "nothing while the slave works; if it refuses PREOP or SAFEOP with 0x0016, or SDOs fail, compare its mailbox ('ethercat slaves -v') with the manual", \
	  "%s") \
	X(PDO, "pdo", FAULT, "", \
	  "configure the PDOs that the slave has ('ethercat cstruct' writes them), or set flag AcceptOtherPdos, but only if its manual says that these are the same objects at the same offsets", \
	  "%s; %s") \
	X(AL_REFUSED, "al_refused", FAULT, "", "", "%s") \
	X(AL_ERROR, "al_error", FAULT, "", "", "%s") \
	X(WATCHDOG, "watchdog", FAULT, "", "", "%s") \
	X(DIRECTION, "al_refused", FAULT, "", \
	  "correct the direction of this SyncManager in the application; 'ethercat cstruct' writes what the slave has", \
	  "%s; SM%d is configured for %s, the slave has it for %s") \
	X(BOOT, "boot", FAULT, "", "", \
	  "state BOOT is requested, as for a firmware update; AL state %s") \
	X(ALIAS_TWICE, "alias_twice", WARNING, "", \
	  "set another alias with the tool of the manufacturer (this version writes no EEPROM), or use ring positions", \
	  "%s") \
	X(REVISION, "revision", WARNING, "", \
	  "connect a slave of that revision, or correct flag ExpectedRevision", "%s") \
	X(PROCESS_DATA_COE, "process_data", WARNING, "", \
	  "compare 'ethercat pdos --coe' with the configuration: 'ethercat config -v'", "%s") \
	X(PROCESS_DATA, "process_data", WARNING, "", \
	  "compare 'ethercat pdos' with the configuration: 'ethercat config -v'; 'ethercat cstruct' writes the names of the slave", \
	  "%s") \
	X(EMERGENCY, "emergency", WARNING, "error_register", "", \
	  "the last CoE emergency stands, since %s: code 0x%04x (%s), error register 0x%02x") \
	X(DRIVE_ERROR, "drive_error", WARNING, "drive class_1_diagnostic", "", \
	  "drive %u is in error: class 1 diagnostic (S-0-0011) 0x%04x (%s)%s%s") \
	/* working counters */ \
	X(WC_FMMU, "working_counter", FAULT, "working_counter expected", \
	  "take the slave to INIT and back, which switches its FMMUs off: 'ethercat states INIT', then PREOP; look for what has written to it", \
	  "domain %u: working counter %u, expected %u: %s answers too, by an FMMU for these process data that the application has not given it") \
	X(WC_HIGH, "working_counter", FAULT, "working_counter expected", \
	  "power-cycle the slaves of the domain ('ethercat domains -v') one after the other: one of them counts wrongly; look for frames that return twice: 'ethercat master'", \
	  "domain %u: working counter %u, expected %u: more slaves answer than the domain has") \
	X(WC_HIGH_BLIND, "working_counter", FAULT, "working_counter expected", \
	  "repeat the command as a user with access to registers: it finds a slave with leftover FMMUs", \
	  "domain %u: working counter %u, expected %u: more slaves answer than the domain has") \
	X(WC_LOW, "working_counter", FAULT, "working_counter expected", \
	  "compare the slaves of the domain: 'ethercat domains -v'; power-cycle the one whose data do not change", \
	  "domain %u: working counter %u, expected %u%s, although all its slaves are in OP") \
	/* clocks and ports */ \
	X(NO_CLOCK, "no_clock", WARNING, "", \
	  "remove ecrt_slave_config_dc() for this slave, or connect one with a clock", \
	  "SYNC signals configured, but the slave has no distributed clock") \
	X(CLOCK_NOT_SET, "clock_not_set", WARNING, "", \
	  "let the application give its time: ecrt_master_application_time(); see 'ethercat master'", \
	  "the clock is not synchronized, SYNC signals have no common time") \
	X(CLOCK_OFF, "clock_off", WARNING, "difference_ns limit_ns", \
	  "queue drift compensation in each cycle: ecrt_master_sync_slave_clocks(); if the application does, give it an even cycle: 'ethercat cycle'", \
	  "the clock differs by %d ns from the reference clock, limit %d ns") \
	X(SYNC_CYCLE, "sync_cycle", WARNING, "sync0_ns cycle_us", \
	  "set the SYNC0 time of ecrt_slave_config_dc() to the cycle time, a whole part or a multiple of it; see 'ethercat cycle'", \
	  "SYNC0 time %u ns and cycle of %u us: neither divides the other, so outputs and SYNC0 drift through each other") \
	X(CYCLE_LOCK, "cycle_lock", WARNING, "", \
	  "find out why the reference clock does not reply", \
	  "kernel cycle in holdover: the reference clock does not reply") \
	X(LINK_ERRORS, "link_errors", WARNING, "invalid_frames receiver_errors lost_links", \
	  "check this cable and its plugs; then 'ethercat crc reset' and look again", \
	  "between port %u of %s and %s: " WHY_PORT_ERRORS) \
	X(OPEN_ERRORS, "link_errors", WARNING, "invalid_frames receiver_errors lost_links", \
	  "find out what was connected there, then 'ethercat crc reset' and look again", \
	  "at port %u of %s, where nothing is connected now: " WHY_PORT_ERRORS)

/* remedies that depend on more than the row, or have a place */
#define WHY_REMEDIES(X) \
	X(LATE_CPU, "check the CPU of the cycle first, which sent up to %u us late: 'ethercat rtcheck', 'ethercat cycle -v'; then the interrupt of the network card %s") \
	X(LATE_CARD, "check the network card %s: delay of its interrupts (ethtool -C, rx-usecs 0), priority and CPU of its interrupt thread: 'ethercat rtcheck'; the sends were in time, at most %u us late") \
	X(LOST_CARD, "no port of a slave counts an error, so check the network card %s, its driver and the plug there: 'ethtool -S', 'ethercat rtcheck'") \
	X(LOST_ANY, "see whether the ports of slaves count errors: 'ethercat crc'; if not, check the network card %s and its driver: 'ethercat rtcheck'") \
	X(ALIAS_MEANT, "correct the alias in the application to %u, if %s is meant") \
	X(EMERGENCY, "see this code in the manual of the slave, remove its cause, and reset the error in the slave; all its messages: 'ethercat emergencies -p %u'") \
	X(DRIVE_ERROR, "see this error in the manual of the drive, remove its cause, then reset it: 'ethercat soe_command -p%u %u S-0-0099'; the axis is without power until then, and may move afterwards") \
	X(REQUESTED, "the tool or an error has requested this state: 'ethercat states OP -p %d', or restart the application") \
	X(BOOT, "wait for the end of the firmware update, then 'ethercat states PREOP -p %u'") \
	X(AGAIN, "%s; the master tries again by itself, at once with 'ethercat states %s -p %d'") \
	X(PLAIN, "%s")

#endif
