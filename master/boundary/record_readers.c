// SPDX-License-Identifier: GPL-2.0-only
/*
 * Readers of records. The first one of a session allocates the ring of its cycle, the end of the
 * last one frees it. A work wakes them every 20 ms while there is one.
 *
 * Each user with permission to read the device file may record. So memory and work are limited:
 * a master has one ring of %EC_RECORD_RING bytes for all readers of a session, the cycle copies its
 * image once for all of them, and there are at most %EC_RECORDERS readers, %EC_RECORDERS_READ_ONLY
 * without the right to write. Rings of ended sessions stay until their readers end; with
 * %RINGS_MAX of them the oldest one is freed for the next, and its readers get an error. All of
 * this is memory of the process that caused it (GFP_KERNEL_ACCOUNT).
 */
#include <linux/jiffies.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "../base/once64.h"
#include "../cycle/recorder.h"
#include "ioctl.h"
#include "master.h"

#define WAKE_MS		20
#define RINGS_MAX	3

/** struct ec_record_reader - one open file */
struct ec_record_reader {
	/** @reader: as those of other kinds; the first member, with which it is freed */
	struct ec_reader reader;
	/** @kind: of this reader, whose records have a size of their own */
	struct ec_reader_kind kind;
	/** @read_only: it is one of these */
	bool read_only;
	/** @cut: its ring was freed before it had read all */
	bool cut;
	/** @n: entries in @runs */
	u32 n;
	/** @runs: what it wants */
	struct ec_recorder_run *runs;
	/** @record: the one that is copied, under the lock of the reader */
	struct ec_record *record;
};

static struct ec_master *record_master(const struct ec_record_readers *rs)
{
	return container_of(rs, struct ec_master, record_readers);
}

static struct ec_record_reader *record_reader(struct ec_reader *r)
{
	return container_of(r, struct ec_record_reader, reader);
}

static void wake_record_readers(struct work_struct *work)
{
	struct ec_record_readers *rs = container_of(work, struct ec_record_readers, work.work);

	mutex_lock(&rs->readers.lock);
	if (rs->readers.count) {
		ec_readers_wake(&rs->readers);
		queue_delayed_work(system_unbound_wq, &rs->work, msecs_to_jiffies(WAKE_MS));
	}
	mutex_unlock(&rs->readers.lock);
}

/**
 * ec_record_readers_init() - prepare the list of readers, which is empty
 * @m: master
 *
 * Context: Any.
 */
void ec_record_readers_init(struct ec_master *m)
{
	ec_readers_init(&m->record_readers.readers);
	INIT_DELAYED_WORK(&m->record_readers.work, wake_record_readers);
}

/**
 * ec_record_readers_exit() - wake no reader from now on
 * @m: master; no file of it is open
 *
 * Context: Process. May sleep.
 */
void ec_record_readers_exit(struct ec_master *m)
{
	cancel_delayed_work_sync(&m->record_readers.work);
}

/* The ring of a reader, in an RCU read section; NULL: it was freed. */
static const struct ec_recorder *ring_of(const struct ec_reader *r)
{
	/* pairs with drop_oldest() */
	return smp_load_acquire(&r->source);
}

/* The end of the session is behind the last record. */
static u64 record_head(const struct ec_reader *r)
{
	const struct ec_recorder *ring;
	u64 head = ~0ULL;

	rcu_read_lock();
	ring = ring_of(r);
	/* pairs with ec_recorder_end() */
	if (ring && !smp_load_acquire(&ring->ended))
		head = ec_recorder_head(ring);
	rcu_read_unlock();
	return head;
}

/* 1, 0: there is none so far; negative: there is none any more */
static int record_get(struct ec_record_reader *x, u64 *at)
{
	const struct ec_recorder *ring = ring_of(&x->reader);
	bool ended;

	if (!ring)
		return x->cut ? -ENOBUFS : -ENODATA;
	/* pairs with ec_recorder_end(): no record is added after this */
	ended = smp_load_acquire(&ring->ended);
	if (ec_recorder_get(ring, at, x->runs, x->n, x->record))
		return 1;
	return ended ? -ENODATA : 0;
}

static int record_copy(struct ec_reader *r, u64 *at, void __user *to)
{
	struct ec_record_reader *x = record_reader(r);
	int ret;

	rcu_read_lock();
	ret = record_get(x, at);
	rcu_read_unlock();
	if (ret <= 0)
		return ret;
	return copy_to_user(to, x->record, x->record->size) ? -EFAULT : 1;
}

/* Numbers are not reused; the cycle may still add one without a reader. */
static void number_after(struct ec_record_readers *rs, const struct ec_recorder *ring)
{
	lockdep_assert_held(&rs->readers.lock);
	rs->next = max(rs->next, ec_recorder_head(ring) + 1);
}

/* The ring goes with its last reader. */
static void ring_put(struct ec_record_readers *rs, struct ec_recorder *ring)
{
	lockdep_assert_held(&rs->readers.lock);
	if (--ring->users)
		return;
	ec_recorder_leave(&record_master(rs)->cycles, ring);
	if (rs->ring == ring)
		rs->ring = NULL;
	rs->rings--;
	number_after(rs, ring);
	kvfree_rcu(ring, rcu);
}

static struct ec_recorder *oldest_ended(const struct ec_record_readers *rs)
{
	struct ec_recorder *ring, *oldest = NULL;
	const struct ec_reader *r;

	lockdep_assert_held(&rs->readers.lock);
	list_for_each_entry(r, &rs->readers.list, list) {
		ring = (struct ec_recorder *)r->source;
		if (ring && READ_ONCE(ring->ended) && (!oldest || ring->first < oldest->first))
			oldest = ring;
	}
	return oldest;
}

/* Readers of ended sessions that do not read, as stopped ones, keep no other one from recording. */
static void drop_oldest(struct ec_record_readers *rs)
{
	struct ec_recorder *oldest = oldest_ended(rs);
	struct ec_reader *r;

	lockdep_assert_held(&rs->readers.lock);
	list_for_each_entry(r, &rs->readers.list, list) {
		if (!oldest || r->source != oldest)
			continue;
		record_reader(r)->cut = ec_read64(&r->at) < ec_recorder_head(oldest);
		/* pairs with ring_of() */
		smp_store_release(&r->source, NULL);
		ring_put(rs, oldest);
	}
}

static void record_reader_clear(struct ec_record_reader *x)
{
	kvfree(x->runs);
	kvfree(x->record);
}

static void record_free(struct ec_reader *r)
{
	struct ec_record_readers *rs = container_of(r->readers, struct ec_record_readers, readers);
	struct ec_record_reader *x = record_reader(r);

	rs->read_only -= x->read_only;
	if (r->source)
		ring_put(rs, (struct ec_recorder *)r->source);
	record_reader_clear(x);
}

/* A stretch of set bits from *@bit on; its length, 0: there is none. */
static u32 next_run(const u8 *mask, u32 bits, u32 *bit)
{
	u32 end;

	while (*bit < bits && !(mask[*bit / 8] >> *bit % 8 & 1))
		++*bit;
	for (end = *bit; end < bits && mask[end / 8] >> end % 8 & 1;)
		end++;
	return end - *bit;
}

/* Count the stretches of both masks, or note them; *@bytes: of all. */
static u32 find_runs(const struct ec_call *call, struct ec_recorder_run *runs, u32 *bytes)
{
	u32 half = call->size / 2, n = 0, bit, len, output;

	*bytes = 0;
	for (output = 0; output < 2; output++)
		for (bit = 0; (len = next_run((u8 *)call->data + output * half, 8 * half, &bit));
		     bit += len) {
			if (runs)
				runs[n] = (struct ec_recorder_run){
					.offset = bit, .len = len, .output = output,
				};
			n++;
			*bytes += len;
		}
	return n;
}

/* A reader that is in no list. */
static struct ec_record_reader *record_reader_new(struct ec_call *call)
{
	struct ec_record_reader *x = kzalloc(sizeof(*x), GFP_KERNEL_ACCOUNT);
	u32 bytes, size;

	BUILD_BUG_ON(offsetof(struct ec_record_reader, reader));
	if (!x)
		return NULL;
	x->n = find_runs(call, NULL, &bytes);
	size = ALIGN(sizeof(*x->record) + bytes, 8);
	x->runs = kvcalloc(x->n + 1, sizeof(*x->runs), GFP_KERNEL_ACCOUNT);
	x->record = kvzalloc(size, GFP_KERNEL_ACCOUNT);
	if (!x->runs || !x->record) {
		record_reader_clear(x);
		kfree(x);
		return NULL;
	}
	find_runs(call, x->runs, &bytes);
	x->record->size = size;
	x->read_only = !call->file->writable;
	x->kind = (struct ec_reader_kind){
		.size = size, .head = record_head, .copy = record_copy, .free = record_free,
	};
	ec_reader_init(&x->reader, &x->kind, NULL);
	return x;
}

/* The active cycle, in a show section that has begun; NULL: it has ended again. */
static struct ec_cycle *show_cycle(struct ec_master *m, int *ret)
{
	*ret = ec_show_begin(&m->base->show);
	if (*ret)
		return NULL;
	if (m->sessions.session && m->sessions.session->wanted.active)
		return &m->sessions.session->cycle;
	ec_show_end(&m->base->show);
	*ret = -ENOENT;
	return NULL;
}

/* A ring for the active session. */
static int ring_new(struct ec_record_readers *rs, const struct ec_recorder_form *f)
{
	struct ec_master *m = record_master(rs);
	struct ec_recorder *r;
	struct ec_cycle *c;
	int ret;

	if (rs->rings >= RINGS_MAX)
		drop_oldest(rs);
	if (rs->ring)
		number_after(rs, rs->ring);
	r = ec_recorder_new(f, rs->next);
	if (!r)
		return -ENOMEM;
	c = show_cycle(m, &ret);
	if (c) {
		/* else another session has begun */
		ret = ec_recorder_begin(c, r) ? 0 : -ERANGE;
		ec_show_end(&m->base->show);
	}
	if (ret) {
		kvfree(r);
		return ret;
	}
	rs->rings++;
	rs->ring = r;
	return 0;
}

/* The ring of the active session for one more reader. */
static int ring_get(struct ec_record_readers *rs, struct ec_recorder **ring)
{
	struct ec_master *m = record_master(rs);
	struct ec_recorder_form f;
	struct ec_cycle *c;
	bool there;
	int ret;

	lockdep_assert_held(&rs->readers.lock);
	c = show_cycle(m, &ret);
	if (!c)
		return ret;
	ec_recorder_form(c, &f);
	/* the session does not end in this section */
	there = rs->ring && !READ_ONCE(rs->ring->ended);
	ec_show_end(&m->base->show);
	ret = there ? 0 : ring_new(rs, &f);
	if (ret)
		return ret;
	*ring = rs->ring;
	rs->ring->users++;
	return 0;
}

static bool is_allowed(const struct ec_record_readers *rs, const struct ec_record_reader *x)
{
	lockdep_assert_held(&rs->readers.lock);
	return rs->readers.count < EC_RECORDERS &&
	       (!x->read_only || rs->read_only < EC_RECORDERS_READ_ONLY);
}

/* The file becomes the reader. */
static int record_readers_add(struct ec_file *f, struct ec_record_reader *x, u32 image)
{
	struct ec_record_readers *rs = &f->master->record_readers;
	struct ec_recorder *ring;
	int ret;

	lockdep_assert_held(&rs->readers.lock);
	if (!is_allowed(rs, x))
		return -EUSERS;
	ret = ring_get(rs, &ring);
	if (ret)
		return ret;
	x->kind.kept = ec_recorder_kept(ring);
	x->reader.source = ring;
	x->reader.at = ec_recorder_head(ring);
	ret = image > ring->form.image ? -ERANGE : ec_reader_enter(&x->reader, &rs->readers, f);
	if (ret) {
		ring_put(rs, ring);
		return ret;
	}
	rs->read_only += x->read_only;
	queue_delayed_work(system_unbound_wq, &rs->work, msecs_to_jiffies(WAKE_MS));
	return 0;
}

/* Bytes of the image up to the last one that is wanted. */
static u32 image_wanted(const struct ec_record_reader *x)
{
	u32 i, most = 0;

	for (i = 0; i < x->n; i++)
		most = max(most, x->runs[i].offset + x->runs[i].len);
	return most;
}

static int recorder_failed(struct ec_call *call, int ret)
{
	switch (ret) {
	case -EBUSY:
		return ec_refuse(call, ret,
				 "this open file reads something already; open the device file again");
	case -ENOENT:
		return ec_refuse(call, ret,
				 "no application and no 'ethercat run' exchanges process data");
	case -ERANGE:
		return ec_refuse(call, ret,
				 "the process data end before the last byte that is wanted; another session may have begun: repeat the command");
	case -EUSERS:
		return ec_refuse(call, ret,
				 "at most %u programs record at a time, and %u without write permission; end one of them",
				 EC_RECORDERS, EC_RECORDERS_READ_ONLY);
	default:
		return ret;
	}
}

/* Command: the file becomes a reader of records. */
int ec_ioc_recorder(struct ec_call *call)
{
	struct ec_record_readers *rs = &call->master->record_readers;
	struct ec_ioc_recorder *arg = call->arg;
	struct ec_record_reader *x;
	u32 bytes;
	int ret;

	if (call->size && !call->data)
		return ec_refuse(call, -E2BIG, "masks of %u bytes, limit %u", call->size,
				 EC_MAX_IMAGE / 4);
	if (find_runs(call, NULL, &bytes) > EC_RECORD_AREAS)
		return ec_refuse(call, -E2BIG,
				 "more than %u stretches of bytes are wanted; record whole domains",
				 EC_RECORD_AREAS);
	x = record_reader_new(call);
	if (!x)
		return -ENOMEM;
	mutex_lock(&rs->readers.lock);
	ret = record_readers_add(call->file, x, image_wanted(x));
	if (!ret) {
		arg->next = x->reader.at;
		arg->record_size = x->kind.size;
		arg->kept = x->kind.kept;
	}
	mutex_unlock(&rs->readers.lock);
	if (!ret)
		return 0;
	record_reader_clear(x);
	kfree(x);
	return recorder_failed(call, ret);
}
