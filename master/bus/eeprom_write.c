// SPDX-License-Identifier: GPL-2.0-only
/*
 * Writing the EEPROM of a slave: what the EEPROM has is read, the image is checked against it, and
 * each word that differs is written and read back; words 0 to 7, whose checksum decides whether
 * the slave starts its application, at last. If a write ends early, the next one begins with what
 * the EEPROM has by then.
 *
 * A thread of its own writes: when the caller is killed, it ends behind a word, and gives the
 * EEPROM back to the slave's side.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../carry/xfer.h"
#include "al.h"
#include "eeprom_access.h"
#include "eeprom_begun.h"
#include "eeprom_check.h"
#include "eeprom_write.h"
#include "slave.h"

#define HEAD_WORDS	8	/* the checksum of the words before is in the last one */
#define LOCK_NS		(10ULL * NSEC_PER_SEC)	/* for a worker of the slave */
#define RENEW_MS	3000	/* for the scan that reads it again */
#define PROGRESS_MS	50
#define CHUNK_WORDS	64	/* read until the next check whether another thread waits */

/**
 * struct writing - a write while it is in progress
 * @work: runs it
 * @ended: it has ended
 * @job: of the caller
 * @a: EEPROM
 * @now: what the EEPROM has
 * @image: what it is to have
 * @bytes: of each
 * @wrote: a word may have been written
 */
struct writing {
	struct work_struct work;
	struct completion ended;
	struct ec_eeprom_job *job;
	struct ec_eeprom_access a;
	u8 *now;
	u8 *image;
	size_t bytes;
	bool wrote;
};

#define writing_fail(w, err, fmt, ...) ({ \
	scnprintf((w)->job->why, sizeof((w)->job->why), fmt, ##__VA_ARGS__); \
	(err); \
})

/* Another thread brings the slave to a state; it may take long, and the caller may end. */
static int writing_lock(struct writing *w)
{
	struct ec_slave *s = w->job->slave;
	u64 until = ktime_get_ns() + LOCK_NS;

	while (!mutex_trylock(&s->lock)) {
		if (READ_ONCE(w->job->abandon))
			return -EINTR;
		if (ec_stop_all(&s->stop))
			return -ECANCELED;
		if (ktime_get_ns() > until)
			return writing_fail(w, -EBUSY,
					    "the master is bringing the slave to another state; try again later");
		usleep_range(1000, 2000);
	}
	return 0;
}

static bool runs(const struct ec_slave *s)
{
	return READ_ONCE(s->al.status) & EC_AL_BEYOND_PREOP;
}

static int check_state(struct writing *w)
{
	struct ec_slave *s = w->job->slave;
	int ret = ec_al_read(s);

	lockdep_assert_held(&s->lock);
	if (ret == -EIO)
		return -ENOLINK;
	if (ret || w->job->flags & EC_EEPROM_FORCE)
		return ret;
	if (runs(s))
		return writing_fail(w, -EBUSY,
				    "the slave is in %s; request PREOP first, or --force",
				    ec_al_state_name(READ_ONCE(s->al.status)));
	if (s->bus->ops && s->bus->ops->attached && s->bus->ops->attached(s))
		return writing_fail(w, -EBUSY,
				    "an application has configured the slave; stop it first, or --force");
	return 0;
}

static int writing_begin(struct writing *w)
{
	int ret = writing_lock(w);

	if (ret)
		return ret;
	w->a.slave = w->job->slave;
	ret = check_state(w) ?: ec_eeprom_take(&w->a, w->job->flags & EC_EEPROM_FORCE);
	if (!ret)
		return 0;
	ec_eeprom_give_back(&w->a);
	mutex_unlock(&w->job->slave->lock);
	return ret;
}

static void writing_end(struct writing *w)
{
	ec_eeprom_give_back(&w->a);
	mutex_unlock(&w->job->slave->lock);
}

/*
 * Has it to end, or to let another thread have the slave, which attaches it to an application?
 * After an error the slave is not locked any more.
 */
static int writing_pause(struct writing *w, bool *locked)
{
	struct ec_stop *stop = &w->job->slave->stop;
	int ret;

	if (READ_ONCE(w->job->abandon))
		return -EINTR;
	if (ec_stop_all(stop))
		return -ECANCELED;
	if (!READ_ONCE(stop->interrupt))
		return 0;
	writing_end(w);
	*locked = false;
	usleep_range(1000, 2000);
	ret = writing_begin(w);
	*locked = !ret;
	return ret;
}

/* Read all that the image has. */
static int read_all(struct writing *w, u8 *to, size_t from, bool *locked)
{
	size_t n;
	int ret;

	for (; from < w->bytes; from += n) {
		n = min_t(size_t, w->bytes - from, 2 * CHUNK_WORDS);
		w->job->word = from / 2;
		ret = writing_pause(w, locked) ?: ec_eeprom_read(&w->a, from / 2, to + from, n);
		if (ret)
			return ret;
	}
	return 0;
}

static bool word_differs(const struct writing *w, u32 word)
{
	return memcmp(w->now + 2 * word, w->image + 2 * word, 2);
}

static int write_words(struct writing *w, u32 word, u32 end, bool *locked)
{
	struct ec_eeprom_job *j = w->job;
	int ret;

	for (; word < end; word++) {
		if (!word_differs(w, word))
			continue;
		j->word = word;
		ret = writing_pause(w, locked);
		if (ret)
			return ret;
		w->wrote = true;
		ret = ec_eeprom_write_word(&w->a, word, w->image + 2 * word);
		if (ret)
			return ret;
		j->written++;
		WRITE_ONCE(j->done, j->done + 1);
	}
	return 0;
}

/* Words that were right before may be others by now: a small chip takes addresses for others. */
static int verify(struct writing *w, bool *locked)
{
	u8 *got = kvmalloc(w->bytes, GFP_KERNEL);
	u32 word;
	int ret = got ? read_all(w, got, 0, locked) : -ENOMEM;

	for (word = 0; !ret && word < w->bytes / 2; word++) {
		if (!memcmp(got + 2 * word, w->image + 2 * word, 2))
			continue;
		w->job->word = word;
		ret = writing_fail(w, -EIO,
				   "word 0x%04x is 0x%04x after all were written, not 0x%04x; the EEPROM may be smaller than the image",
				   word, get_unaligned_le16(got + 2 * word),
				   get_unaligned_le16(w->image + 2 * word));
	}
	kvfree(got);
	return ret;
}

static int make_alias(struct writing *w)
{
	u8 crc = ec_sii_crc(w->now);

	if (w->now[2 * EC_SII_W_CHECKSUM] != crc && !ec_eeprom_was_begun(w->job->slave, w->now) &&
	    !(w->job->flags & EC_EEPROM_REPAIR))
		return writing_fail(w, -EBADMSG,
				    "checksum of the EEPROM 0x%02x, expected 0x%02x: a write was interrupted; write an image, or --repair-checksum",
				    w->now[2 * EC_SII_W_CHECKSUM], crc);
	memcpy(w->image, w->now, w->bytes);
	put_unaligned_le16(w->job->alias, w->image + 2 * EC_SII_W_ALIAS);
	put_unaligned_le16(ec_sii_crc(w->image), w->image + 2 * EC_SII_W_CHECKSUM);
	return 0;
}

static int eeprom_prepare(struct writing *w, bool *locked)
{
	struct ec_eeprom_job *j = w->job;
	struct ec_eeprom_images e = {
		.now = w->now, .image = w->image, .bytes = w->bytes,
		.capacity = ec_eeprom_capacity(&w->a),
	};
	u32 word;
	int ret;

	if (w->bytes > e.capacity)
		return ec_eeprom_check_pair(&e, true, true, j->why, sizeof(j->why));
	ret = read_all(w, w->now, 0, locked);
	if (!ret)
		ret = !j->image ? make_alias(w) :
		      ec_eeprom_check_pair(&e, j->flags & EC_EEPROM_FORCE,
					   j->flags & EC_EEPROM_UNSAFE, j->why, sizeof(j->why));
	for (word = 0; !ret && word < w->bytes / 2; word++)
		j->differ += word_differs(w, word);
	WRITE_ONCE(j->done, w->bytes / 2 - j->differ);
	return ret;
}

/* The slave takes what is new; a running one keeps what it has until it restarts. */
static int take_effect(struct writing *w)
{
	struct ec_slave *s = w->job->slave;
	bool head = memcmp(w->now, w->image, 2 * HEAD_WORDS);
	u8 alias[2];
	int ret;

	if (!runs(s) && (head || w->a.control & EC_EEP_ERR_CHECKSUM)) {
		ret = ec_eeprom_reload(&w->a, &w->job->register_alias);
		if (ret == -EBADMSG && !(w->job->flags & EC_EEPROM_UNSAFE))
			return writing_fail(w, -EIO,
					    "all words are written, but the slave finds their checksum wrong");
		/* a controller without the command takes it at power-on */
		if (ret != -EIO && ret != -ETIME && ret != -EBADMSG)
			return ret;
	}
	ret = ec_xfer_fprd(s->bus->links, s->station, EC_REG_ALIAS, alias, 2);
	if (!ret) {
		w->job->register_alias = get_unaligned_le16(alias);
		WRITE_ONCE(s->register_alias, w->job->register_alias);
	}
	return 0;
}

static int write_all(struct writing *w, bool *locked)
{
	u32 words = w->bytes / 2;
	int ret = eeprom_prepare(w, locked);

	if (ret || w->job->flags & EC_EEPROM_DRY_RUN)
		return ret;
	if (!w->job->image)
		ec_eeprom_note_begun(w->job->slave->bus, w->image, true);
	ret = write_words(w, HEAD_WORDS, words, locked) ?: write_words(w, 0, HEAD_WORDS, locked);
	if (!ret && !w->job->image)
		ec_eeprom_note_begun(w->job->slave->bus, w->image, false);
	if (!ret && w->wrote)
		ret = verify(w, locked);
	return ret ?: take_effect(w);
}

/* The master's copy is another one: a scan reads the slave again, once it does not run. */
static bool is_outdated(const struct writing *w)
{
	const struct ec_slave *s = w->job->slave;

	return !s->eeprom.data || memcmp(s->eeprom.data, w->image,
					 min(s->eeprom.bytes, w->bytes));
}

static void eeprom_renew(struct writing *w)
{
	struct ec_slave *s = w->job->slave;
	struct ec_bus *bus = s->bus;

	WRITE_ONCE(s->work.renew, true);
	if (runs(s))
		return;
	WRITE_ONCE(bus->renew, true);
	if (bus->ops && bus->ops->wake)
		bus->ops->wake(bus);
	if (!READ_ONCE(bus->held))
		wait_event_timeout(s->stop.wake, ec_stop_all(&s->stop),
				   msecs_to_jiffies(RENEW_MS));
	w->job->renewed = READ_ONCE(s->stop.gone);
}

static void set_flaw(struct ec_slave *s, const char *text)
{
	raw_spin_lock(&s->note.lock);
	strscpy(s->note.sii_flaw, text, sizeof(s->note.sii_flaw));
	raw_spin_unlock(&s->note.lock);
	ec_slave_changed(s);
}

/* Why it has ended early. */
static void explain(struct writing *w, int ret)
{
	u32 word = w->job->word;

	if (w->job->why[0])
		return;
	switch (ret) {
	case -EINTR:
		writing_fail(w, ret, "interrupted at word 0x%04x", word);
		break;
	case -EBUSY:
		writing_fail(w, ret,
			     "the slave's side keeps the EEPROM (register 0x0501) at word 0x%04x; try again, or --force",
			     word);
		break;
	case -ETIME:
		writing_fail(w, ret, "the EEPROM stays busy at word 0x%04x", word);
		break;
	case -EIO:
		writing_fail(w, ret,
			     "word 0x%04x: no acknowledge, or it keeps another value; is the EEPROM protected?",
			     word);
		break;
	case -EXDEV:
		writing_fail(w, ret, "several slaves reply at its station address; rescan");
		break;
	case -ECANCELED:
		writing_fail(w, ret, "the slave was disconnected at word 0x%04x", word);
		break;
	case -ENOLINK:
	case -ETIMEDOUT:
	case -ENETDOWN:
	case -ENODEV:
		writing_fail(w, ret, "no reply at word 0x%04x; check the cables", word);
		break;
	default:
		writing_fail(w, ret, "ended at word 0x%04x (%pe)", word, ERR_PTR(ret));
	}
}

static void report_failed(struct writing *w)
{
	struct ec_eeprom_job *j = w->job;
	char text[EC_UAPI_WARNING];
	size_t n = strlen(j->why);

	if (!w->wrote)
		return;
	scnprintf(j->why + n, sizeof(j->why) - n, "; %u of %u words written, write it again",
		  j->written, j->differ);
	scnprintf(text, sizeof(text),
		  "EEPROM write ended at word 0x%04x, %u of %u words written; write it again",
		  j->word, j->written, j->differ);
	set_flaw(j->slave, text);
	ec_slave_warn(j->slave, "%s\n", text);
}

static void report_done(struct writing *w)
{
	struct ec_eeprom_job *j = w->job;

	if (w->wrote)
		ec_slave_info(j->slave, "EEPROM written and read back: %u words changed\n",
			      j->written);
	set_flaw(j->slave, "");
	if (is_outdated(w))
		eeprom_renew(w);
}

static void run_writing(struct work_struct *work)
{
	struct writing *w = container_of(work, struct writing, work);
	struct ec_eeprom_job *j = w->job;
	bool locked = false;
	int ret;

	j->words = w->bytes / 2;
	ret = writing_begin(w);
	if (!ret) {
		locked = true;
		ret = write_all(w, &locked);
	}
	if (locked)
		writing_end(w);
	j->ret = ret;
	if (ret) {
		explain(w, ret);
		report_failed(w);
	} else if (!(j->flags & EC_EEPROM_DRY_RUN)) {
		report_done(w);
	}
	complete(&w->ended);
}

static void follow(struct writing *w, void (*progress)(void *ctx, u32 done, u32 words), void *ctx)
{
	long left;

	INIT_WORK_ONSTACK(&w->work, run_writing);
	init_completion(&w->ended);
	queue_work(system_unbound_wq, &w->work);
	for (;;) {
		left = wait_for_completion_killable_timeout(&w->ended,
							    msecs_to_jiffies(PROGRESS_MS));
		if (left > 0)
			break;
		if (left < 0) {
			WRITE_ONCE(w->job->abandon, true);
			wait_for_completion(&w->ended);
			break;
		}
		if (progress)
			progress(ctx, READ_ONCE(w->job->done), READ_ONCE(w->job->words));
	}
	flush_work(&w->work);
	destroy_work_on_stack(&w->work);
}

/**
 * ec_eeprom_write() - write the EEPROM of a slave, or its alias alone
 * @job: what; also has the results
 * @progress: called now and then while it is written, may be NULL
 * @ctx: of @progress
 *
 * The words that differ are written and read back, words 0 to 7 after all others. What is written
 * takes effect at once where the slave can reload it. Then a scan reads the slave again; it is
 * another struct ec_slave afterwards, with the same device number.
 *
 * Context: Process. Waits for bus traffic, some 10 ms for each word that differs.
 * Return: @job->ret: 0; -EINVAL, -EBADMSG, -EPERM, -EFBIG: refused, see eeprom_check.h; -EBUSY: the
 * slave runs, is configured, or keeps its EEPROM; -EINTR: the caller was killed; -ENOMEM; -EIO,
 * -ETIME, -ENOLINK, -ECANCELED or as ec_xfer(): failed. @job->why says it in words.
 */
int ec_eeprom_write(struct ec_eeprom_job *job, void (*progress)(void *ctx, u32 done, u32 words),
		    void *ctx)
{
	struct ec_bus *bus = job->slave->bus;
	struct writing w = {
		.job = job, .bytes = job->image ? job->bytes : EC_BEGUN_BYTES,
	};

	if (job->image) {
		job->ret = ec_eeprom_check_image(job->image, job->bytes,
						 job->flags & EC_EEPROM_UNSAFE, job->why,
						 sizeof(job->why));
		if (job->ret)
			return job->ret;
	}
	w.now = kvzalloc(2 * w.bytes, GFP_KERNEL);
	if (!w.now)
		return job->ret = -ENOMEM;
	w.image = w.now + w.bytes;
	if (job->image)
		memcpy(w.image, job->image, w.bytes);
	atomic_inc(&bus->writes);
	follow(&w, progress, ctx);
	atomic_dec(&bus->writes);
	kvfree(w.now);
	return job->ret;
}
