// SPDX-License-Identifier: GPL-2.0-only
/* Differences of the kinds of requests: which starts are valid, and the transfer. */
#include <linux/ktime.h>
#include "../mailbox/coe.h"
#include "../mailbox/foe.h"
#include "request_int.h"
#include "request_layout.h"
#include "request_run.h"
#include "../bus/slave.h"
#include "../mailbox/soe.h"
#include "../mailbox/voe.h"
#include "../wire/sdoinfo.h"
#include "../wire/voe.h"
#include "../carry/xfer.h"

/* operations of a kind, bit n: EC_REQUEST_OP_ n */
static const u8 ops[] = {
	[EC_REQUEST_SDO] = BIT(EC_REQUEST_OP_READ) | BIT(EC_REQUEST_OP_WRITE),
	[EC_REQUEST_REG] = BIT(EC_REQUEST_OP_READ) | BIT(EC_REQUEST_OP_WRITE) |
			   BIT(EC_REQUEST_OP_READWRITE),
	[EC_REQUEST_SOE] = BIT(EC_REQUEST_OP_READ) | BIT(EC_REQUEST_OP_WRITE),
	[EC_REQUEST_VOE] = BIT(EC_REQUEST_OP_READ) | BIT(EC_REQUEST_OP_WRITE) |
			   BIT(EC_REQUEST_OP_READ_NOW),
	[EC_REQUEST_FOE] = BIT(EC_REQUEST_OP_READ) | BIT(EC_REQUEST_OP_WRITE),
	[EC_REQUEST_SDO_INFO] = BIT(EC_REQUEST_OP_READ),
	[EC_REQUEST_DATAGRAM] = BIT(EC_REQUEST_OP_READWRITE),
};

/* The meaning of the flags depends on the kind. */
static int accept_flags(struct ec_request *r, u32 flags)
{
	switch (r->kind) {
	case EC_REQUEST_SDO:
		r->complete = flags & EC_SDO_FLAG_COMPLETE;
		return flags & ~EC_SDO_FLAG_COMPLETE ? -EOPNOTSUPP : 0;
	case EC_REQUEST_SDO_INFO:
		if (flags != EC_SDO_INFO_LIST && flags != EC_SDO_INFO_OBJECT &&
		    flags != EC_SDO_INFO_ENTRY)
			return -EINVAL;
		r->what = flags;
		return 0;
	default:
		return flags ? -EOPNOTSUPP : 0;
	}
}

/**
 * ec_request_accept() - check a start of the application
 * @r: request with all fields of the record but these, and the name of a file in @buf
 * @flags: of the record
 * @size: of the record; @r->size is set
 *
 * Context: Process.
 * Return: 0, -EINVAL, -EOPNOTSUPP for unknown flags.
 */
int ec_request_accept(struct ec_request *r, u32 flags, u32 size)
{
	int ret;

	if (r->op > EC_REQUEST_OP_READ_NOW || !(ops[r->kind] & BIT(r->op)))
		return -EINVAL;
	ret = accept_flags(r, flags);
	if (ret)
		return ret;
	if (r->kind == EC_REQUEST_VOE)	/* the whole operation has a limit */
		r->timeout_ms = EC_VOE_TIMEOUT_MS;
	if (r->kind != EC_REQUEST_REG && !ec_request_writes(r))
		size = r->cap;
	else if (size > r->cap ||
		 (!size && r->kind != EC_REQUEST_VOE && r->kind != EC_REQUEST_FOE))
		return -EINVAL;
	if (r->kind == EC_REQUEST_DATAGRAM && r->sub > EC_CMD_FRMW)
		return -EINVAL;
	if (ec_request_is_file(r) && !ec_foe_name_len((char *)r->buf, EC_FOE_NAME))
		return -EINVAL;
	r->size = size;
	return 0;
}

/* The old content may be lost with a frame, so it is not sent twice. */
static int readwrite(const struct ec_request *r, struct ec_slave *s)
{
	struct ec_dg dg = EC_DG(EC_CMD_FPRW, s->station, r->index, r->size, r->buf);
	int ret;

	dg.repeat = false;
	ret = ec_xfer(s->bus->links, &dg, 1);
	/* reading counts one, writing two */
	return ret ? ret : dg.wkc == 3 ? 0 : -EIO;
}

static void run_reg(struct ec_request *r, struct ec_slave *s)
{
	r->res.got = ec_request_reads(r) ? r->size : 0;
	/* also of a slave whose configuration failed: its registers have the cause */
	if (r->op == EC_REQUEST_OP_READWRITE)
		r->res.err = readwrite(r, s);
	else if (r->op == EC_REQUEST_OP_WRITE)
		r->res.err = ec_xfer_fpwr(s->bus->links, s->station, r->index, r->buf, r->size);
	else
		r->res.err = ec_xfer_fprd(s->bus->links, s->station, r->index, r->buf, r->size);
}

/* Sent once, unchanged: only the application knows what it does. */
static void run_datagram(struct ec_request *r, struct ec_links *l)
{
	struct ec_dg dg = EC_DG(r->sub, r->vendor & 0xffff, r->vendor >> 16, r->size, r->buf);

	dg.repeat = false;
	r->res.err = ec_xfer(l, &dg, 1);
	r->res.got = r->size;
	r->res.type = dg.wkc;
}

static void run_sdo(struct ec_request *r, struct ec_slave *s, const struct ec_mbox_limit *l)
{
	if (ec_request_writes(r))
		r->res.err = ec_coe_download(&s->mbox, r->index, r->sub, r->complete, r->buf,
					     r->size, &r->res.code, l);
	else
		r->res.err = ec_coe_upload(&s->mbox, r->index, r->sub, r->complete, r->buf,
					   r->size, &r->res.got, &r->res.code, l);
}

static void run_info(struct ec_request *r, struct ec_slave *s, const struct ec_mbox_limit *l)
{
	struct ec_sdoinfo info;

	ec_sdoinfo_init(&info, r->what, r->index, r->sub, r->buf, r->size);
	r->res.err = ec_dict_info(s, &info, l);
	r->res.got = info.size;
	r->res.code = info.abort;
}

static void run_soe(struct ec_request *r, struct ec_slave *s, const struct ec_mbox_limit *l)
{
	u16 error;

	if (ec_request_writes(r))
		r->res.err = ec_soe_write(&s->mbox, r->sub, r->index, r->buf, r->size, &error, l);
	else
		r->res.err = ec_soe_read(&s->mbox, r->sub, r->index, r->buf, r->size, &r->res.got,
					 &error, l);
	r->res.code = error;
}

static void run_voe(struct ec_request *r, struct ec_slave *s, struct ec_mbox_limit *l)
{
	u64 ms = div_u64(ktime_get_ns() - r->since_ns, NSEC_PER_MSEC);
	struct ec_voe_hdr h = { .vendor = r->vendor, .type = r->index };

	l->timeout_ms = ms < EC_VOE_TIMEOUT_MS ? EC_VOE_TIMEOUT_MS - ms : 1;
	if (ec_request_writes(r))
		r->res.err = ec_voe_write(&s->mbox, &h, r->buf, r->size, l);
	else
		r->res.err = ec_voe_read(&s->mbox, r->op == EC_REQUEST_OP_READ_NOW, &h, r->buf,
					 r->size, &r->res.got, l);
	r->res.vendor = h.vendor;
	r->res.type = h.type;
}

/* the memory of the application; its content is not checked */
static int file_out(void *ctx, u64 at, u8 *buf, size_t n)
{
	const struct ec_request *r = ctx;

	memcpy(buf, r->data + at, n);
	return 0;
}

static int file_in(void *ctx, u64 at, u8 *buf, size_t n)
{
	const struct ec_request *r = ctx;

	memcpy(r->data + at, buf, n);
	return 0;
}

static void file_progress(void *ctx, u64 done)
{
	const struct ec_request *r = ctx;

	/* the data before their number */
	smp_store_release(&r->rec->progress, (u32)done);
}

static void run_foe(struct ec_request *r, struct ec_slave *s, const struct ec_mbox_limit *l)
{
	struct ec_foe f = {
		.write = ec_request_writes(r), .password = r->vendor, .name = (char *)r->buf,
		.name_len = ec_foe_name_len((char *)r->buf, EC_FOE_NAME),
	};
	struct ec_foe_file file = {
		.size = r->size, .copy = f.write ? file_out : file_in, .progress = file_progress,
		.ctx = r,
	};
	int ret = ec_foe_transfer(&s->mbox, &f, &file, l);

	r->res.err = ret == -EREMOTEIO ? -EIO : ret == -EINPROGRESS ? -EBUSY : ret;
	r->res.got = ret || f.write ? 0 : f.size;
	r->res.code = f.error;
}

/**
 * ec_request_run() - execute a request
 * @r: request that ec_request_accept() has accepted; @res is set
 * @s: its slave; NULL for a datagram
 * @l: way to the slaves
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_request_run(struct ec_request *r, struct ec_slave *s, struct ec_links *l)
{
	struct ec_mbox_limit limit = { .begin_ns = ec_request_begin_ns(r), .cancel = &r->stop };

	r->res = (struct ec_request_result){ .err = -EINVAL };
	switch (r->kind) {
	case EC_REQUEST_SDO:
		run_sdo(r, s, &limit);
		break;
	case EC_REQUEST_REG:
		run_reg(r, s);
		break;
	case EC_REQUEST_SOE:
		run_soe(r, s, &limit);
		break;
	case EC_REQUEST_VOE:
		run_voe(r, s, &limit);
		break;
	case EC_REQUEST_FOE:
		run_foe(r, s, &limit);
		break;
	case EC_REQUEST_SDO_INFO:
		run_info(r, s, &limit);
		break;
	case EC_REQUEST_DATAGRAM:
		run_datagram(r, l);
		break;
	}
}
