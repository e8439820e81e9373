// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "coe.h"
#include "text.h"

/**
 * ec_coe_hdr_decode() - read a CoE header
 * @r: cursor behind the mailbox header
 * @h: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is not complete.
 */
int ec_coe_hdr_decode(struct ec_rbuf *r, struct ec_coe_hdr *h)
{
	u16 v = ec_rbuf_le16(r);

	h->number = v & 0x01FF;
	h->service = (u8)(v >> 12);
	return r->bad ? -EMSGSIZE : 0;
}

/**
 * ec_coe_hdr_encode() - write a CoE header, of PDO number 0
 * @w: cursor
 * @service: enum ec_coe_service
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_coe_hdr_encode(struct ec_wbuf *w, u8 service)
{
	ec_wbuf_le16(w, (u16)(service << 12));
}

/**
 * ec_coe_emergency_decode() - read an emergency
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @e: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOMSG when the message is something else, -EMSGSIZE when it is
 * too short.
 */
int ec_coe_emergency_decode(const u8 *rx, size_t len, struct ec_coe_emergency *e)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_coe_hdr h;
	const u8 *data;

	if (ec_coe_hdr_decode(&r, &h))
		return -EMSGSIZE;
	if (h.service != EC_COE_EMERGENCY)
		return -ENOMSG;
	e->code = ec_rbuf_le16(&r);
	e->reg = ec_rbuf_u8(&r);
	data = ec_rbuf_take(&r, sizeof(e->data));
	if (!data)
		return -EMSGSIZE;
	memcpy(e->data, data, sizeof(e->data));
	return 0;
}

static const struct ec_text aborts[] = {
	{ 0x05030000, "toggle bit did not change" },
	{ 0x05040000, "SDO transfer timed out" },
	{ 0x05040001, "SDO command is unknown" },
	{ 0x05040002, "block size is invalid" },
	{ 0x05040003, "block sequence number is invalid" },
	{ 0x05040004, "block checksum is wrong" },
	{ 0x05040005, "out of memory" },
	{ 0x06010000, "this kind of access is not supported for the object" },
	{ 0x06010001, "object can only be written" },
	{ 0x06010002, "object can only be read" },
	{ 0x06010003, "subindex cannot be written while subindex 0 is not 0" },
	{ 0x06010004, "complete access is not possible for objects of variable length" },
	{ 0x06010005, "object is larger than the mailbox" },
	{ 0x06010006, "object is mapped into an RxPDO and cannot be written" },
	{ 0x06020000, "object does not exist" },
	{ 0x06040041, "object cannot be mapped into a PDO" },
	{ 0x06040042, "mapped objects exceed the length of the PDO" },
	{ 0x06040043, "parameters are not compatible" },
	{ 0x06040047, "incompatibility inside the device" },
	{ 0x06060000, "access failed because of a hardware error" },
	{ 0x06070010, "data type or length does not match" },
	{ 0x06070012, "data is too long" },
	{ 0x06070013, "data is too short" },
	{ 0x06090011, "subindex does not exist" },
	{ 0x06090030, "value is out of range" },
	{ 0x06090031, "value is too high" },
	{ 0x06090032, "value is too low" },
	{ 0x06090033, "detected modules differ from the configured ones" },
	{ 0x06090036, "maximum is smaller than minimum" },
	{ 0x060A0023, "resource is not available" },
	{ 0x08000000, "general error" },
	{ 0x08000020, "data cannot be transferred or stored" },
	{ 0x08000021, "data cannot be transferred or stored: the device is under local control" },
	{ 0x08000022, "data cannot be transferred or stored in the present device state" },
	{ 0x08000023, "there is no object dictionary" },
	{ 0x08000024, "no data available" },
};

/**
 * ec_coe_abort_text() - meaning of an SDO abort code
 * @code: abort code
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, NULL if unknown.
 */
const char *ec_coe_abort_text(u32 code)
{
	return ec_text_find(aborts, ARRAY_SIZE(aborts), code);
}
