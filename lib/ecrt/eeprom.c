// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* The EEPROM of a slave. */
#include "../../master/wire/sii.h"
#include "ecrt_int.h"

#define WORDS_MAX	0x10000	/* of an EEPROM */

/* Read the image that the master has, from @offset on. Return: bytes, or -errno. */
static int read_image(ec_master_t *master, uint16_t position, __u32 offset, __u8 *to, size_t size)
{
	size_t done = 0;

	/* the kernel may return an image of any size in pieces */
	while (done < size) {
		struct ec_ioc_sii i = {
			.slave.position = position, .offset = offset + (__u32)done,
			.size = (__u32)(size - done), .data = (uintptr_t)(to + done),
		};
		int ret = ec_do(master, EC_IOC_SII, &i, "read the EEPROM of slave %u", position);

		if (ret)
			return ret;
		if (!i.size || i.size > size - done)
			break;
		done += i.size;
	}
	return (int)done;
}

int ecrt_master_read_eeprom(ec_master_t *master, uint16_t slave_position, uint16_t word,
			    uint8_t *target, size_t target_size, size_t *result_size)
{
	int ret;

	if (result_size)
		ec_no_result(result_size);
	if (!master)
		return -EINVAL;
	if (!target || !result_size)
		return ec_fail(master, -EINVAL, "read the EEPROM of slave %u to nowhere",
			       slave_position);
	if (target_size > 2 * WORDS_MAX)
		target_size = 2 * WORDS_MAX;
	ret = read_image(master, slave_position, 2u * word, target, target_size);
	if (ret < 0)
		return ret;
	*result_size = (size_t)ret;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_read_eeprom);

static int write_image(ec_master_t *master, uint16_t position, __u8 *image, size_t size,
		       uint32_t flags, ec_eeprom_written_t *written)
{
	struct ec_ioc_sii_write i = {
		.flags = flags & ~(__u32)EC_EEPROM_WRITE_CHECKSUM, .slave.position = position,
		.size = (__u32)size, .data = (uintptr_t)image,
	};
	int ret;

	if (flags & EC_EEPROM_WRITE_CHECKSUM && size >= 2 * (EC_SII_W_CHECKSUM + 1)) {
		image[2 * EC_SII_W_CHECKSUM] = ec_sii_crc(image);
		image[2 * EC_SII_W_CHECKSUM + 1] = 0;
	}
	ret = ec_do(master, EC_IOC_SII_WRITE, &i, "write the EEPROM of slave %u", position);
	if (written && (!ret || ret == -EIO)) {
		written->differ = i.differ;
		written->written = i.written;
		written->register_alias = i.register_alias;
		written->renewed = i.renewed;
	}
	return ret;
}

int ecrt_master_write_eeprom(ec_master_t *master, uint16_t slave_position, uint16_t word,
			     const uint8_t *data, size_t size, uint32_t flags,
			     ec_eeprom_written_t *written)
{
	size_t from = 2u * (size_t)word;
	__u8 *image;
	int ret;

	if (written)
		memset(written, 0, sizeof(*written));
	if (!master)
		return -EINVAL;
	if (!data || !size || size % 2 || from + size > 2 * WORDS_MAX)
		return ec_fail(master, -EINVAL,
			       "write %zu bytes from word 0x%04x on to the EEPROM of slave %u",
			       size, word, slave_position);
	image = ec_zalloc(2 * WORDS_MAX);
	if (!image)
		return ec_fail(master, -ENOMEM, "write the EEPROM of slave %u", slave_position);
	/* what is not given stays; an image from word 0 on is written without the rest */
	ret = word ? read_image(master, slave_position, 0, image, 2 * WORDS_MAX) : 0;
	if (ret >= 0 && from > (size_t)ret)
		ret = ec_fail(master, -EINVAL,
			      "write word 0x%04x of the EEPROM of slave %u, of which 0x%04x are known",
			      word, slave_position, (unsigned int)ret / 2);
	if (ret >= 0) {
		memcpy(image + from, data, size);
		if (from + size > (size_t)ret)
			ret = (int)(from + size);
		ret = write_image(master, slave_position, image, (size_t)ret, flags, written);
	}
	ec_free(image);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_write_eeprom);

int ecrt_master_write_alias(ec_master_t *master, uint16_t slave_position, uint16_t alias,
			    uint32_t flags, ec_eeprom_written_t *written)
{
	struct ec_ioc_alias i = {
		.flags = flags, .slave.position = slave_position, .alias = alias,
	};
	int ret;

	if (written)
		memset(written, 0, sizeof(*written));
	if (!master)
		return -EINVAL;
	ret = ec_do(master, EC_IOC_ALIAS, &i, "write alias %u to slave %u", alias, slave_position);
	if (!ret && written) {
		written->register_alias = i.register_alias;
		written->renewed = i.renewed;
	}
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_write_alias);
