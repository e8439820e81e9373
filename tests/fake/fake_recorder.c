// SPDX-License-Identifier: GPL-2.0-only
/*
 * Fake master: records of process data of the bus that runs (fake_run.c), a millisecond apart. The
 * position counts from -2, output 1 of slave 1 changes every 5 records. FAKE_RECORDS: how many
 * there are before the session ends (20); FAKE_RECORD_GAP: three are missing before this one;
 * FAKE_RECORD_REFUSED: too many programs record; FAKE_RECORD_DROPPED: the last ones were dropped
 * for newer recordings.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fake.h"

#define IMAGE	9
#define BEGIN	5000000000ULL

static __u8 mask[2 * ((IMAGE + 7) / 8) + 2];
static unsigned int half, record_size, at;
static bool recording;

static unsigned int number(const char *name, unsigned int other)
{
	const char *v = getenv(name);

	return v ? (unsigned int)strtoul(v, NULL, 0) : other;
}

static bool wanted(unsigned int bit)
{
	return mask[bit / 8] >> bit % 8 & 1;
}

int fake_recorder(unsigned long request, void *arg)
{
	struct ec_ioc_recorder *i = arg;
	unsigned int bytes = sizeof(struct ec_record);

	if (request != EC_IOC_RECORDER)
		return FAKE_OTHER;
	if (getenv("FAKE_RECORD_REFUSED"))
		return fake_fail(EUSERS, "at most 16 programs record at a time");
	if (i->flags || i->size > sizeof(mask))
		return fake_fail(ERANGE, "the process data end before the last byte");
	memcpy(mask, (void *)(uintptr_t)i->data, i->size);
	half = i->size / 2;
	for (unsigned int k = 0; k < 16 * half; k++)
		bytes += wanted(k);
	record_size = (bytes + 7) / 8 * 8;
	recording = true;
	at = 0;
	i->record_size = record_size;
	i->kept = 5000;
	i->next = 7;
	return 0;
}

static void fill(__u8 *to)
{
	__u8 image[2 * 8 * sizeof(mask)] = { 0 };
	__u32 position = at - 2;

	image[0] = at / 5 % 2;
	image[1] = 0x0f;
	memcpy(image + 3, &position, sizeof(position));
	memset(to, 0, record_size - sizeof(struct ec_record));
	for (unsigned int k = 0; k < 16 * half; k++)
		if (wanted(k))
			*to++ = image[k % (8 * half)];
}

/* four at a time; false: the file is no reader of records */
bool fake_recorder_read(void *buf, unsigned long size, long *bytes)
{
	unsigned int n, gap = number("FAKE_RECORD_GAP", ~0u);
	__u8 *to = buf;

	if (!recording)
		return false;
	if (at >= number("FAKE_RECORDS", 20)) {
		errno = getenv("FAKE_RECORD_DROPPED") ? ENOBUFS : ENODATA;
		*bytes = -1;
		return true;
	}
	for (n = 0; n < 4 && at < number("FAKE_RECORDS", 20) && size >= record_size; n++) {
		struct ec_record r = {
			.size = record_size, .missed = at == gap ? 3 : 0,
		};

		at += (unsigned int)r.missed;
		r.number = 7 + at;
		r.time_ns = BEGIN + 1000000ULL * at;
		r.app_time_ns = 1000000ULL * at;
		r.cycle = 100 + at;
		r.sent = 1;
		r.complete = at != 2;
		memcpy(to, &r, sizeof(r));
		fill(to + sizeof(r));
		to += record_size;
		size -= record_size;
		at++;
	}
	*bytes = (long)(n * record_size);
	return true;
}
