/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Sizes and values that several structures of the interface use. */
#ifndef EC_UAPI_ETHERCAT_COMMON_H
#define EC_UAPI_ETHERCAT_COMMON_H

#define EC_UAPI_STRING		64
#define EC_UAPI_REASON		256
#define EC_UAPI_WARNING		192
#define EC_UAPI_PORTS		4
#define EC_UAPI_RATES		3	/* averages over 1, 10, 60 s */
#define EC_UAPI_DC_WINDOW_NS	1000	/* sync window of a clock */
#define EC_UAPI_NONE16		0xffff
#define EC_UAPI_NONE32		0xffffffff

#endif
