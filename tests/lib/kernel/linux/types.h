/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What ecrt.h takes from the kernel, for a compile check without one. */
#ifndef TEST_LINUX_TYPES_H
#define TEST_LINUX_TYPES_H

#define NULL ((void *)0)
#define __force

typedef unsigned char uint8_t;
typedef unsigned short uint16_t;
typedef unsigned int uint32_t;
typedef unsigned long long uint64_t;
typedef signed char int8_t;
typedef short int16_t;
typedef int int32_t;
typedef long long int64_t;
typedef __SIZE_TYPE__ size_t;
typedef uint16_t __le16;
typedef uint32_t __le32;
typedef uint64_t __le64;

#endif
