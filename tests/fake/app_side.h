/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A kernel that remembers what libethercat asked of it. */
#ifndef TEST_APP_SIDE_H
#define TEST_APP_SIDE_H

#include "../../include/ecrt.h"
#include "../../include/uapi/ethercat.h"

#define FAKE_FD	1000

/*
 * @calls: system calls so far, @last: the last one but EC_IOC_REASON
 * @refuse, @err: this command fails with that errno
 * @arg: copy of the argument of @last
 */
struct fake {
	unsigned int calls;
	unsigned int opens;
	unsigned int closes;
	int writable;		/* the last open */
	unsigned int last;
	unsigned int refuse;
	int err;
	const char *reason;
	unsigned char arg[4096];
	unsigned int image_size;
	unsigned int domains;
	unsigned int configs;
	unsigned long long sent;
	unsigned int pdo_ops[64];
	unsigned int n_pdo_ops;
	unsigned char *image;
	struct ec_status *status;
	unsigned char *area;
	unsigned int requests;
	unsigned int send_flags;
	unsigned int exchange_size;
	unsigned int stride;
	struct ec_exchange *exchange;
	unsigned long long cycle;
	unsigned char preset[64];
	unsigned int preset_size;
	unsigned int dc_bits;
	int dc_diff;
	unsigned int dc_odd;
	unsigned int advised;	/* of @calls, by posix_fadvise() */
	int no_advice;		/* errno that it returns */
	int received;		/* by ioctl() */
	int admitted;		/* likewise a send */
	__u8 values[64];	/* of the last command for a transition */
	void (*beside)(void);	/* what another thread does during a send, once */
	unsigned int answer;	/* bytes of SDO information; 0: all */
	unsigned int large;	/* bytes of memory for the first request, behind the others */
	unsigned char running;	/* activation takes over; the image is of this */
};

extern struct fake fake;

static inline struct ec_request_record *fake_request(unsigned char *area,
						     unsigned int i)
{
	return (struct ec_request_record *)(area +
					    sizeof(struct ec_request_area)) + i;
}

int kernel_cycle(void);	/* returns the number of failures */

#endif
