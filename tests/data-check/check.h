/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_DATA_CHECK_H
#define EC_DATA_CHECK_H

#include "../../master/wire/env.h"
#include <stdio.h>

/*
 * They print what they find wrong, each line with the file's name in front,
 * and fill @note for the line of a good file. Return the number of faults.
 */
int check_eeprom(const char *path, const u8 *data, size_t len, char *note, size_t cap);
int check_damaged(const char *path, const u8 *data, size_t len, char *note, size_t cap);
int check_capture(const char *path, const u8 *data, size_t len, char *note, size_t cap);
int check_replay(const char *path, const u8 *data, size_t len, char *note, size_t cap);

#endif
