/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * libethercat-tools: what the command ethercat knows and does, for programs. The library shows
 * masters, slaves, configurations, cycles, events and network cards, finds out why slaves are not
 * in OP, and gives access to registers, mailboxes and AL states. An application that exchanges
 * process data uses ecrt.h.
 *
 * Rules for all functions:
 *
 * - They return 0 or a count, or a negative errno; ect_reason() then says why in words. None of
 *   them prints, exits, or changes a signal.
 * - A handle belongs to one thread at a time. Different handles may be used by different threads
 *   at the same time, also those of the same master; there is no other shared state.
 * - What ect_..._read() returns as a struct ect_list belongs to the caller: ect_list_free(). Its
 *   elements belong to the list. A text that a function returns belongs to the handle, and is
 *   valid up to the next call with this handle.
 * - Structures grow at their end only. Each begins with @struct_size: of one that the caller
 *   gives, its sizeof(), set by the caller (the function writes no more, and zeros what it does
 *   not know); of an element of a list, what the library knows of it.
 * - Texts are harmless to a terminal: what a slave calls itself has no control characters.
 */
#ifndef ETHERCAT_TOOLS_H
#define ETHERCAT_TOOLS_H

#include "ethercat-tools/app.h"
#include "ethercat-tools/cards.h"
#include "ethercat-tools/eeprom.h"
#include "ethercat-tools/eoe.h"
#include "ethercat-tools/events.h"
#include "ethercat-tools/handle.h"
#include "ethercat-tools/mail.h"
#include "ethercat-tools/mailbox.h"
#include "ethercat-tools/master.h"
#include "ethercat-tools/record.h"
#include "ethercat-tools/run.h"
#include "ethercat-tools/slave.h"
#include "ethercat-tools/topology.h"
#include "ethercat-tools/why.h"

#endif
