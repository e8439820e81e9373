// SPDX-License-Identifier: GPL-2.0-only
/*
 * The EEPROM of one slave, word by word through registers 0x0500 to 0x050F (ETG.1000.4 clause
 * 6.4). Each step is tried again after a lost frame: what a lost frame has done is not known, so
 * a word that was written is read back, and only a word that differs is written again.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include "../carry/xfer.h"
#include "eeprom_access.h"
#include "slave.h"

#define REGS		14	/* registers 0x0502 to 0x050F */
#define TRIES		6	/* of a word */
#define POLL_US		200
#define CONTACT_NS	(500 * NSEC_PER_MSEC)	/* without a reply, then the slave is lost */
#define BUSY_NS		(200 * NSEC_PER_MSEC)	/* of an access */
#define EMULATED_NS	NSEC_PER_SEC		/* of one that the CPU of the slave serves */
#define PDI_NS		(100 * NSEC_PER_MSEC)	/* for the slave's side to end its access */
#define WRITE_US	5000	/* of a chip that does not show that it is busy */
#define SMALL_BYTES	2048	/* of a chip with one byte of address */

/* One datagram, again until the slave has executed it. */
static int eeprom_xfer(const struct ec_eeprom_access *a, u8 cmd, u16 ado, void *data, u16 len)
{
	struct ec_slave *s = a->slave;
	u64 until = ktime_get_ns() + CONTACT_NS;
	int ret;

	lockdep_assert_held(&s->lock);
	for (;;) {
		ret = ec_xfer_one(s->bus->links, cmd, s->station, ado, data, len);
		if (ret == 1)
			return 0;
		/* another working counter: no slave has the address, or several have it */
		if (ret >= 0)
			ret = ret ? -EXDEV : -ENOLINK;
		if (ret != -ENOLINK && ret != -ETIMEDOUT)
			return ret;
		if (ec_stop_all(&s->stop))
			return -ECANCELED;
		if (ktime_get_ns() > until)
			return ret;
		usleep_range(POLL_US, 2 * POLL_US);
	}
}

static int eeprom_set(const struct ec_eeprom_access *a, u16 ado, u16 value, u16 len)
{
	u8 b[2];

	put_unaligned_le16(value, b);
	return eeprom_xfer(a, EC_CMD_FPWR, ado, b, len);
}

/* Read registers from 0x0502 on, until no command is in progress. */
static int wait_idle(struct ec_eeprom_access *a, u8 *reg)
{
	u64 until = ktime_get_ns() + (a->control & EC_EEP_EMULATED ? EMULATED_NS : BUSY_NS);
	int ret;

	for (;;) {
		ret = eeprom_xfer(a, EC_CMD_FPRD, EC_REG_EEP_CONTROL, reg, REGS);
		if (ret)
			return ret;
		a->control = get_unaligned_le16(reg);
		if (!(a->control & (EC_EEP_BUSY | EC_EEP_CMD_MASK)))
			return 0;
		if (ktime_get_ns() > until)
			return -ETIME;
		usleep_range(POLL_US, 2 * POLL_US);
	}
}

/* An error of the access before stays until a command clears it. */
static int clear_error(struct ec_eeprom_access *a)
{
	if (!(a->control & (EC_EEP_ERR_ACK | EC_EEP_ERR_WRITE_EN)))
		return 0;
	return eeprom_set(a, EC_REG_EEP_CONTROL, 0, 2);
}

/* Does the slave's side have it? Wait until its access has ended. */
static int wait_pdi(struct ec_eeprom_access *a, u8 *owner)
{
	u64 until = ktime_get_ns() + PDI_NS;
	int ret;

	for (;;) {
		ret = eeprom_xfer(a, EC_CMD_FPRD, EC_REG_EEP_OWNER, owner, 2);
		if (ret || !(owner[0] & EC_EEP_OWNER_PDI || owner[1] & 1))
			return ret;
		if (ktime_get_ns() > until)
			return -EBUSY;
		usleep_range(POLL_US, 2 * POLL_US);
	}
}

static int take_from_pdi(struct ec_eeprom_access *a, bool force)
{
	u8 owner[2];
	int ret = eeprom_set(a, EC_REG_EEP_OWNER, 0, 1);

	ret = ret ?: wait_pdi(a, owner);
	if (ret != -EBUSY || !force)
		return ret;
	return eeprom_set(a, EC_REG_EEP_OWNER, EC_EEP_OWNER_FORCE, 1) ?:
	       eeprom_set(a, EC_REG_EEP_OWNER, 0, 1) ?: wait_pdi(a, owner);
}

/**
 * ec_eeprom_take() - take the EEPROM from the slave's side (registers 0x0500 and 0x0501)
 * @a: access; @slave is set
 * @force: end an access of the slave's side that is in progress
 *
 * Context: Process, the lock of the slave held. Waits for bus traffic.
 * Return: 0; -EBUSY when the slave's side keeps it; -ETIME when it stays busy; -ENOLINK when the
 * slave does not reply, -EXDEV when several do; -ECANCELED; or as ec_xfer().
 */
int ec_eeprom_take(struct ec_eeprom_access *a, bool force)
{
	u8 reg[REGS], owner[2];
	int ret;

	lockdep_assert_held(&a->slave->lock);
	ret = eeprom_xfer(a, EC_CMD_FPRD, EC_REG_EEP_OWNER, owner, 2);
	if (ret)
		return ret;
	if (!a->taken)
		a->owner = owner[0] & EC_EEP_OWNER_PDI;
	a->taken = true;
	ret = take_from_pdi(a, force);
	return ret ?: wait_idle(a, reg) ?: clear_error(a);
}

/**
 * ec_eeprom_give_back() - the EEPROM is the slave's side's again if it was
 * @a: access
 *
 * Context: Process, the lock of the slave held. Waits for bus traffic.
 * Return: 0, or as ec_eeprom_take().
 */
int ec_eeprom_give_back(struct ec_eeprom_access *a)
{
	bool taken = a->taken;

	lockdep_assert_held(&a->slave->lock);
	a->taken = false;
	return taken && a->owner ? eeprom_set(a, EC_REG_EEP_OWNER, a->owner, 1) : 0;
}

/**
 * ec_eeprom_capacity() - how many bytes the chip can have
 * @a: access; taken
 *
 * A chip with one byte of address takes what is beyond for its first bytes.
 *
 * Context: Any.
 * Return: bytes.
 */
size_t ec_eeprom_capacity(const struct ec_eeprom_access *a)
{
	return a->control & (EC_EEP_TWO_ADDR | EC_EEP_EMULATED) ? EC_SII_MAX_SIZE : SMALL_BYTES;
}

/* Before another try: the slave's side, or another master, may have taken it. */
static int write_again(struct ec_eeprom_access *a)
{
	if (ec_stop_all(&a->slave->stop))
		return -ECANCELED;
	return ec_eeprom_take(a, false);
}

/* Read at @word. Return: bytes at @reg + 6. */
static int read_at(struct ec_eeprom_access *a, u32 word, u8 *reg)
{
	unsigned int try;
	u8 cmd[6];
	int ret;

	for (try = 0; try < TRIES; try++) {
		put_unaligned_le16(EC_EEP_CMD_READ, cmd);
		put_unaligned_le32(word, cmd + 2);
		ret = eeprom_xfer(a, EC_CMD_FPWR, EC_REG_EEP_CONTROL, cmd, sizeof(cmd));
		ret = ret ?: wait_idle(a, reg);
		if (ret)
			return ret;
		if (!(a->control & EC_EEP_ERR_ACK) && get_unaligned_le16(reg + 2) == (u16)word)
			return a->control & EC_EEP_READ8 ? 8 : 4;
		usleep_range(POLL_US, 2 * POLL_US);
		ret = write_again(a);
		if (ret)
			return ret;
	}
	return -EIO;
}

/**
 * ec_eeprom_read() - read from the EEPROM
 * @a: access; taken
 * @word: word address
 * @data: result
 * @size: bytes, even; the caller has checked that they are within the EEPROM
 *
 * Context: Process, the lock of the slave held. Waits for bus traffic.
 * Return: 0; -EIO when the chip does not acknowledge; or as ec_eeprom_take().
 */
int ec_eeprom_read(struct ec_eeprom_access *a, u32 word, u8 *data, size_t size)
{
	size_t done = 0, n;
	u8 reg[REGS];
	int ret;

	lockdep_assert_held(&a->slave->lock);
	while (done < size) {
		ret = read_at(a, word + done / 2, reg);
		if (ret < 0)
			return ret;
		n = min_t(size_t, ret, size - done);
		memcpy(data + done, reg + 6, n);
		done += n;
	}
	return 0;
}

/* The command, once: when its frame is lost, what is read back shows whether it was executed. */
static int command_write(struct ec_eeprom_access *a, u32 word, const u8 *value)
{
	u8 cmd[8], reg[REGS];
	struct ec_dg dg = EC_FPWR(a->slave->station, EC_REG_EEP_CONTROL, sizeof(cmd), cmd);
	int ret;

	put_unaligned_le16(EC_EEP_CMD_WRITE | EC_EEP_WRITE_ENABLE, cmd);
	put_unaligned_le32(word, cmd + 2);
	memcpy(cmd + 6, value, 2);
	dg.repeat = false;
	ret = ec_xfer(a->slave->bus->links, &dg, 1);
	if (ret && ret != -ETIMEDOUT)
		return ret;
	return wait_idle(a, reg) ?: clear_error(a);
}

/* Is it there? A chip that never shows busy may still be writing. */
static int is_written(struct ec_eeprom_access *a, u32 word, const u8 *value)
{
	u8 got[2];
	int ret = ec_eeprom_read(a, word, got, 2);

	if (ret || !memcmp(got, value, 2))
		return ret ?: 1;
	usleep_range(WRITE_US, WRITE_US + 100);
	ret = ec_eeprom_read(a, word, got, 2);
	return ret ?: !memcmp(got, value, 2);
}

/**
 * ec_eeprom_write_word() - write a word and read it back
 * @a: access; taken
 * @word: word address
 * @value: two bytes
 *
 * Context: Process, the lock of the slave held. Waits for bus traffic.
 * Return: 0; -EIO when the word keeps another value; or as ec_eeprom_take().
 */
int ec_eeprom_write_word(struct ec_eeprom_access *a, u32 word, const u8 *value)
{
	unsigned int try;
	int ret;

	lockdep_assert_held(&a->slave->lock);
	for (try = 0; try < TRIES; try++) {
		ret = command_write(a, word, value);
		if (ret)
			return ret;
		ret = is_written(a, word, value);
		if (ret)
			return min(ret, 0);
		ret = write_again(a);
		if (ret)
			return ret;
	}
	return -EIO;
}

/**
 * ec_eeprom_reload() - let the slave take words 0 to 6 from its EEPROM
 * @a: access; taken
 * @alias: result: register 0x0012 after it; some controllers set it at power-on only
 *
 * Context: Process, the lock of the slave held. Waits for bus traffic.
 * Return: 0; -EBADMSG when the slave finds the checksum wrong; -EIO when it does not execute the
 * command; or as ec_eeprom_take().
 */
int ec_eeprom_reload(struct ec_eeprom_access *a, u16 *alias)
{
	u8 reg[REGS], b[2];
	int ret = eeprom_set(a, EC_REG_EEP_CONTROL, EC_EEP_CMD_RELOAD, 2) ?: wait_idle(a, reg);

	lockdep_assert_held(&a->slave->lock);
	if (ret)
		return ret;
	if (a->control & EC_EEP_ERR_CHECKSUM)
		return -EBADMSG;
	if (a->control & EC_EEP_ERR_ACK)
		return clear_error(a) ?: -EIO;
	ret = eeprom_xfer(a, EC_CMD_FPRD, EC_REG_ALIAS, b, 2);
	*alias = get_unaligned_le16(b);
	return ret;
}
