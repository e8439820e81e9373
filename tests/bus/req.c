// SPDX-License-Identifier: GPL-2.0-only
#include "master/boundary/ioctl.h"
#include "req.h"

/**
 * req_add() - prepare a request
 * @c: application, not active
 * @config: configuration
 * @kind: EC_REQUEST_*
 * @size: room for data
 *
 * Return: its number.
 */
u32 req_add(struct cyc *c, u32 config, u32 kind, u32 size)
{
	struct ec_ioc_sc_request r = { .config = config, .kind = kind, .size = size };

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &r), 0, "%s",
			    c->b->app.reason);
	return r.index;
}

struct ec_request_area *req_area(struct cyc *c)
{
	return (void *)bus_shared(c->b)->requests;
}

struct ec_request_record *req_rec(struct cyc *c, u32 i)
{
	return (struct ec_request_record *)((u8 *)req_area(c) + req_area(c)->requests) + i;
}

u8 *req_data(struct cyc *c, u32 i)
{
	return (u8 *)req_area(c) + req_rec(c, i)->data;
}

/**
 * req_begin() - start a request, one cycle
 * @c: application
 * @i: number
 * @index: object, register, IDN or type
 * @sub: subindex or drive
 * @op: EC_REQUEST_OP_*
 * @size: bytes
 */
void req_begin(struct cyc *c, u32 i, u16 index, u8 sub, u8 op, u32 size)
{
	struct ec_request_record *r = req_rec(c, i);

	r->index = index;
	r->subindex = sub;
	r->op = op;
	r->size = size;
	smp_store_release(&r->start, r->start + 1);
	c->flags |= EC_SEND_FLAG_REQUESTS;
	cyc_run(c, 1);
	c->flags &= ~EC_SEND_FLAG_REQUESTS;
}

bool req_over(struct cyc *c, u32 i)
{
	return smp_load_acquire(&req_rec(c, i)->done) == req_rec(c, i)->start;
}

/**
 * req_end() - cycles until a request has ended
 * @c: application
 * @i: number
 * @limit_ms: bus time
 *
 * Return: its result; 1: it has not.
 */
int req_end(struct cyc *c, u32 i, u32 limit_ms)
{
	u64 until = ktime_get_ns() + (u64)limit_ms * NSEC_PER_MSEC;

	while (!req_over(c, i) && ktime_get_ns() < until)
		cyc_run(c, 1);
	return req_over(c, i) ? req_rec(c, i)->result : 1;
}

/* start and wait, 5 s */
int req_do(struct cyc *c, u32 i, u16 index, u8 sub, u8 op, u32 size)
{
	req_begin(c, i, index, sub, op, size);
	return req_end(c, i, 5000);
}
