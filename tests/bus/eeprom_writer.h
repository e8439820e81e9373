/* SPDX-License-Identifier: GPL-2.0-only */
/* Writes of EEPROMs, also in a thread of their own. */
#ifndef EC_EEPROM_WRITER_H
#define EC_EEPROM_WRITER_H

#include <linux/kthread.h>
#include <linux/sched/signal.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/wire/sii.h"

#define SEGMENT	"slave a EK1100\nslave b EL7201\nslave c EL2008\n"
#define DRIVE	1	/* slave b */
#define PLAIN	2	/* slave c */
#define EXTRA	32	/* words of the category that an image gets */

/* a write in a thread of its own */
struct writer {
	struct bus *b;
	u32 position;
	u32 flags;
	const u8 *image;	/* NULL: the alias */
	u32 size;
	u16 alias;
	struct ec_file file;
	struct task_struct *task;
	struct completion done;
	struct ec_ioc_sii_write i;
	u16 register_alias;
	int ret;
};

static inline int write_eeprom(struct writer *w)
{
	struct ec_ioc_alias a = {
		.flags = w->flags, .slave.position = w->position, .alias = w->alias,
	};

	w->i = (struct ec_ioc_sii_write){
		.flags = w->flags, .slave.position = w->position, .size = w->size,
		.data = (uintptr_t)w->image,
	};
	w->ret = w->image ? ec_ioc(&w->file, EC_IOC_SII_WRITE, &w->i) :
			    ec_ioc(&w->file, EC_IOC_ALIAS, &a);
	w->register_alias = w->image ? w->i.register_alias : a.register_alias;
	return w->ret;
}

static inline struct writer *writer_new(struct bus *b, u32 position)
{
	struct writer *w = kunit_kzalloc(b->test, sizeof(*w), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, w);
	w->b = b;
	w->position = position;
	ec_file_init(&w->file, b->m, true);
	return w;
}

static inline int writer_thread(void *arg)
{
	struct writer *w = arg;

	allow_signal(SIGKILL);
	write_eeprom(w);
	complete(&w->done);
	return 0;
}

static inline void writer_start(struct writer *w)
{
	init_completion(&w->done);
	w->task = kthread_run(writer_thread, w, "writer");
	KUNIT_ASSERT_FALSE(w->b->test, IS_ERR(w->task));
}

static inline int set_alias(struct bus *b, u32 position, u16 alias, u32 flags)
{
	struct ec_ioc_alias a = { .flags = flags, .slave.position = position, .alias = alias };

	return ec_ioc(&b->app, EC_IOC_ALIAS, &a);
}

static inline u16 eep_word(struct bus *b, u32 index, u32 word)
{
	return get_unaligned_le16(bus_esc(b, index)->eep.data + 2 * word);
}

static inline bool has_alias(struct bus *b, u32 index, u16 alias)
{
	const u8 *data = bus_esc(b, index)->eep.data;

	return eep_word(b, index, EC_SII_W_ALIAS) == alias &&
	       data[2 * EC_SII_W_CHECKSUM] == ec_sii_crc(data);
}

static inline void fix_checksum(u8 *image)
{
	put_unaligned_le16(ec_sii_crc(image), image + 2 * EC_SII_W_CHECKSUM);
}

/* A copy of the EEPROM with an alias, a serial number and a category of their own. */
static inline u8 *image_of(struct bus *b, u32 index, u32 number, u32 *size)
{
	const struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	size_t used = ec_sii_used(e->data, e->len);
	u8 *image = kunit_kzalloc(b->test, used + 4 + 2 * EXTRA, GFP_KERNEL);
	u8 *p = image + used - 2;
	u32 k;

	KUNIT_ASSERT_NOT_NULL(b->test, image);
	memcpy(image, e->data, used);
	put_unaligned_le16(number, image + 2 * EC_SII_W_ALIAS);
	put_unaligned_le32(number, image + 2 * EC_SII_W_SERIAL);
	put_unaligned_le16(0x0900, p);
	put_unaligned_le16(EXTRA, p + 2);
	for (k = 0; k < EXTRA; k++)
		put_unaligned_le16(number * 0x9e37 + k, p + 4 + 2 * k);
	put_unaligned_le16(EC_SII_CAT_END, p + 4 + 2 * EXTRA);
	fix_checksum(image);
	*size = used + 4 + 2 * EXTRA;
	return image;
}

static inline bool eep_is(struct bus *b, u32 index, const u8 *image, u32 size)
{
	return !memcmp(bus_esc(b, index)->eep.data, image, size);
}

static inline void expect_reason(struct bus *b, const struct ec_file *f, const char *words)
{
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(f->reason, words), "reason: %s", f->reason);
}

static inline struct bus *eeprom_ready(struct kunit *test)
{
	struct bus *b = bus_up(test, SEGMENT, 3);

	bus_idle(b);
	return b;
}

#endif
