/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * libethercat-bus: a bus that is described in a file: reading and writing such files, comparing a
 * file with another one or with what is on the bus, and names of slaves and values.
 *
 * Functions return 0 or a negative errno. None of them prints, exits, or changes a signal.
 */
#ifndef ETHERCAT_BUS_H
#define ETHERCAT_BUS_H

#include "ethercat-bus/bus.h"
#include "ethercat-bus/compare.h"
#include "ethercat-bus/file.h"
#include "ethercat-bus/names.h"

#endif
