/* SPDX-License-Identifier: GPL-2.0-only */
/* Network cards that get the native driver when the computer starts: one udev rule each. */
#ifndef EC_TOOL_BOOT_H
#define EC_TOOL_BOOT_H

#include <stdbool.h>
#include <stddef.h>

#include "nic.h"

/**
 * enum boot - what is in the file of a PCI address
 * @BOOT_NONE: no file
 * @BOOT_FOREIGN: not written by this tool
 * @BOOT_OTHER: a rule of this tool for another card at this address
 * @BOOT_SET: the rule for this card
 */
enum boot {
	BOOT_NONE,
	BOOT_FOREIGN,
	BOOT_OTHER,
	BOOT_SET,
};

enum boot boot_state(const struct nic *n);
/* all of these: 0, or 1 after a message */
int boot_check(const char *pci);
int boot_write(const struct nic *n);
int boot_remove(const char *pci);
/* notes on rules for cards that are absent */
void boot_note_absent(const struct nics *all);

#endif
