/* SPDX-License-Identifier: GPL-2.0-only */
/* A drive behind a coupler, and an application that writes objects of it by itself. */
#ifndef EC_TEST_REPLAY_H
#define EC_TEST_REPLAY_H

#include "req.h"
#include "master/config/replay.h"
#include "master/wire/replay.h"

#define TYPES	0x2001	/* a record: 2, 6: a byte; 3, 7: 2 bytes; 4, 8: 4 bytes */
#define DRIVE	1	/* ring position; its configuration is 0 */

#define HAS(test, text, part)	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(text, part), "%s", text)

struct cyc *replay_reserve(struct kunit *test);
struct cyc *replay_configure(struct kunit *test);
int replay_put_of(struct bus *b, struct ec_file *f, u16 index, u8 sub, u64 value, u32 size);
void replay_put(struct cyc *c, u16 index, u8 sub, u64 value, u32 size);
u64 replay_value(struct bus *b, u16 index, u8 sub, u32 size);
bool replay_entry(struct cyc *c, u32 n, struct ec_ioc_config_write *i, u64 *v);
u32 replay_entries(struct cyc *c);
u32 replay_not(struct cyc *c, u16 index, u8 sub);
void replay_into_op(struct cyc *c);
void replay_power_off(struct cyc *c);
void replay_power_on(struct cyc *c);
void replay_why_text(struct cyc *c, char *text);

#endif
