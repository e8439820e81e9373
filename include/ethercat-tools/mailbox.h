/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: objects, files, IP parameters and emergencies of slaves. */
#ifndef ETHERCAT_TOOLS_MAILBOX_H
#define ETHERCAT_TOOLS_MAILBOX_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_SDO_MAX	65536u	/* bytes of the largest object or answer */
#define ECT_FOE_NAME	64	/* bytes of a file's name, without end */

#define ECT_SDO_COMPLETE	1u	/* flag: complete access */

/**
 * ect_sdo_upload() - read an object of a slave (CoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @index: of the object
 * @subindex: of the entry
 * @flags: 0 or %ECT_SDO_COMPLETE
 * @timeout_ms: of each reply, 0: default
 * @data: for @size bytes
 * @size: bytes, at most %ECT_SDO_MAX
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: bytes of the object, at most @size; or a negative errno. -EIO: the slave has refused
 * with an abort code, ect_error_code().
 */
long ect_sdo_upload(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		    unsigned int flags, uint32_t timeout_ms, void *data, size_t size);

/**
 * ect_sdo_download() - write an object of a slave (CoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @index: of the object
 * @subindex: of the entry
 * @flags: 0 or %ECT_SDO_COMPLETE
 * @timeout_ms: of each reply, 0: default
 * @data: @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_sdo_upload().
 */
int ect_sdo_download(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		     unsigned int flags, uint32_t timeout_ms, const void *data, size_t size);

/* an object as the slave describes it */
struct ect_object {
	uint32_t struct_size;
	uint16_t index;
	uint16_t type;		/* data type */
	uint8_t max_subindex;
	uint8_t code;		/* 7 variable, 8 array, 9 record */
	uint16_t reserved;
	char name[ECT_TEXT];
};

/* bits of struct ect_entry.access */
#define ECT_READ_PREOP		0x01u
#define ECT_READ_SAFEOP		0x02u
#define ECT_READ_OP		0x04u
#define ECT_WRITE_PREOP		0x08u
#define ECT_WRITE_SAFEOP	0x10u
#define ECT_WRITE_OP		0x20u
#define ECT_ACCESS_RXPDO	0x40u	/* may be mapped into a PDO that the slave receives */
#define ECT_ACCESS_TXPDO	0x80u

/* bits of struct ect_entry.values */
#define ECT_VALUE_UNIT		0x08u
#define ECT_VALUE_DEFAULT	0x10u
#define ECT_VALUE_MIN		0x20u
#define ECT_VALUE_MAX		0x40u
#define ECT_VALUE_ALL		0x78u

#define ECT_VALUE_BYTES		256

/* an entry of an object as the slave describes it */
struct ect_entry {
	uint32_t struct_size;
	uint16_t index;
	uint8_t subindex;
	uint8_t values;		/* ECT_VALUE_*: those of the following that the slave has sent */
	uint16_t type;		/* data type */
	uint16_t bits;
	uint16_t access;	/* ECT_READ_PREOP... */
	uint16_t value_size;	/* bytes of each of the last three values */
	uint32_t unit;		/* unit type */
	uint8_t unit_size;	/* bytes of it: slaves send 2 or 4 */
	uint8_t reserved[3];
	uint8_t initial[ECT_VALUE_BYTES];	/* default value */
	uint8_t minimum[ECT_VALUE_BYTES];
	uint8_t maximum[ECT_VALUE_BYTES];
	char name[ECT_TEXT];
};

/**
 * ect_objects_read() - the indexes of the object dictionary of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @timeout_ms: of each reply, 0: default
 * @list: result, elements are struct ect_object with @index alone
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_sdo_upload().
 */
int ect_objects_read(struct ect_handle *h, uint64_t device, uint32_t timeout_ms,
		     struct ect_list **list);

/**
 * ect_object_read() - the description of an object
 * @h: master, open for writing
 * @device: number of the slave
 * @index: of the object
 * @timeout_ms: of each reply, 0: default
 * @o: result, with its @struct_size
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, -EBADMSG if the answer is no description, or a negative errno as ect_sdo_upload().
 */
int ect_object_read(struct ect_handle *h, uint64_t device, uint16_t index, uint32_t timeout_ms,
		    struct ect_object *o);

/**
 * ect_entry_read() - the description of an entry
 * @h: master, open for writing
 * @device: number of the slave
 * @index: of the object
 * @subindex: of the entry
 * @values: ECT_VALUE_* to request; it is no failure if the slave omits some
 * @timeout_ms: of each reply, 0: default
 * @e: result, with its @struct_size
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: As ect_object_read().
 */
int ect_entry_read(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		   unsigned int values, uint32_t timeout_ms, struct ect_entry *e);

/**
 * ect_soe_read() - read an IDN of a servo drive (SoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @drive: 0 to 7
 * @idn: of the parameter
 * @timeout_ms: of each reply, 0: default
 * @data: for @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: bytes of the value; or a negative errno. -EIO: the slave has refused with an error
 * code, ect_error_code().
 */
long ect_soe_read(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
		  uint32_t timeout_ms, void *data, size_t size);

/**
 * ect_soe_write() - write an IDN of a servo drive (SoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @drive: 0 to 7
 * @idn: of the parameter
 * @timeout_ms: of each reply, 0: default
 * @data: @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_soe_read().
 */
int ect_soe_write(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
		  uint32_t timeout_ms, const void *data, size_t size);

/* @element of ect_soe_read_element(): of an IDN */
#define ECT_SOE_STATE		0x01	/* data state, 2 bytes */
#define ECT_SOE_NAME		0x02	/* text: length and largest length, 2 bytes each, first */
#define ECT_SOE_ATTRIBUTE	0x04	/* 4 bytes: length, protection, display */
#define ECT_SOE_UNIT		0x08	/* text */
#define ECT_SOE_MIN		0x10
#define ECT_SOE_MAX		0x20
#define ECT_SOE_VALUE		0x40
#define ECT_SOE_DEFAULT		0x80

/**
 * ect_soe_read_element() - read an element of an IDN of a servo drive (SoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @drive: 0 to 7
 * @idn: of the parameter
 * @element: ECT_SOE_*; several bits: their data follow one another in this order
 * @timeout_ms: of each reply, 0: default
 * @data: for @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: bytes of the element; or a negative errno as ect_soe_read().
 */
long ect_soe_read_element(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
			  unsigned int element, uint32_t timeout_ms, void *data, size_t size);

/**
 * ect_soe_write_element() - write an element of an IDN of a servo drive (SoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @drive: 0 to 7
 * @idn: of the parameter
 * @element: ECT_SOE_*, one bit
 * @timeout_ms: of each reply, 0: default
 * @data: @size bytes
 * @size: bytes
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_soe_read().
 */
int ect_soe_write_element(struct ect_handle *h, uint64_t device, unsigned int drive, uint16_t idn,
			  unsigned int element, uint32_t timeout_ms, const void *data,
			  size_t size);

/**
 * ect_foe_read() - read a file of a slave (FoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @name: of the file, at most %ECT_FOE_NAME bytes
 * @password: 0: none
 * @data: for @size bytes
 * @size: bytes
 * @done: NULL, or set to the bytes received so far, for another thread
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: bytes of the file; or a negative errno. -EIO: the slave has refused with an error code,
 * ect_error_code().
 */
long ect_foe_read(struct ect_handle *h, uint64_t device, const char *name, uint32_t password,
		  void *data, size_t size, uint64_t *done);

/**
 * ect_foe_write() - write a file of a slave (FoE)
 * @h: master, open for writing
 * @device: number of the slave
 * @name: of the file, at most %ECT_FOE_NAME bytes
 * @password: 0: none
 * @data: @size bytes
 * @size: bytes
 * @done: NULL, or set to the bytes sent so far, for another thread
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_foe_read().
 */
int ect_foe_write(struct ect_handle *h, uint64_t device, const char *name, uint32_t password,
		  const void *data, size_t size, uint64_t *done);

/* bits of struct ect_ip.which */
#define ECT_IP_MAC	0x01u
#define ECT_IP_ADDRESS	0x02u
#define ECT_IP_MASK	0x04u
#define ECT_IP_GATEWAY	0x08u
#define ECT_IP_DNS	0x10u
#define ECT_IP_HOSTNAME	0x20u

#define ECT_IP_NAME	32	/* bytes of a host name, with its end */

/* IP parameters of a slave with EoE; addresses in network order */
struct ect_ip {
	uint32_t struct_size;
	uint32_t which;		/* ECT_IP_*: the valid ones */
	uint8_t mac[6];
	uint8_t reserved[2];
	uint8_t ip[4];
	uint8_t mask[4];
	uint8_t gateway[4];
	uint8_t dns[4];
	char name[ECT_IP_NAME];
};

/**
 * ect_ip_get() - the IP parameters of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @ip: result, with its @struct_size
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0 or a negative errno. -EIO: the slave has refused, ect_error_code().
 */
int ect_ip_get(struct ect_handle *h, uint64_t device, struct ect_ip *ip);

/**
 * ect_ip_set() - set IP parameters of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @ip: parameters, with its @struct_size
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0, or a negative errno as ect_ip_get().
 */
int ect_ip_set(struct ect_handle *h, uint64_t device, const struct ect_ip *ip);

/* a CoE emergency; code 0x00..: the error is over */
struct ect_emergency {
	uint32_t struct_size;
	uint16_t code;
	uint8_t error_register;
	uint8_t data[5];	/* of the manufacturer */
	uint64_t time_ns;	/* when the master has fetched it, since 1970 */
	char text[ECT_STRING];	/* what the code says */
};

/**
 * ect_emergencies_read() - the last emergencies of a slave
 * @h: master
 * @device: number of the slave
 * @total: NULL, or set to how many the slave has sent since it was found
 * @list: result, elements are struct ect_emergency, the oldest first
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_emergencies_read(struct ect_handle *h, uint64_t device, uint32_t *total,
			 struct ect_list **list);

#ifdef __cplusplus
}
#endif

#endif
