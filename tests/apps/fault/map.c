// SPDX-License-Identifier: GPL-2.0-only
/* The memory an activation shares with the application. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "fault.h"

static int map_errno(int fd, size_t size, int prot, int flags, off_t offset)
{
	void *p = mmap(NULL, size, prot, flags, fd, offset);

	if (p == MAP_FAILED)
		return errno;
	munmap(p, size);
	return 0;
}

static void refused_maps(int fd, int other, const struct ec_ioc_activate *a)
{
	static const off_t wrong[] = { 0x1000, 0x3ffff000, 0x40001000, 0x80000000, 0x7ffffffff000 };
	const int rw = PROT_READ | PROT_WRITE;

	expect_errno(map_errno(other, 4096, rw, MAP_SHARED, EC_MMAP_IMAGE), EPERM,
		     "image by somebody else");
	expect_errno(map_errno(fd, 4096, rw, MAP_PRIVATE, EC_MMAP_IMAGE), EINVAL, "private image");
	expect_errno(map_errno(fd, 4096, rw | PROT_EXEC, MAP_SHARED, EC_MMAP_IMAGE), EPERM,
		     "code in the image");
	expect_errno(map_errno(fd, a->image_size + 4096, rw, MAP_SHARED, EC_MMAP_IMAGE), EINVAL,
		     "more than the image");
	expect_errno(map_errno(fd, a->status_size + 4096, PROT_READ, MAP_SHARED, EC_MMAP_STATUS),
		     EINVAL, "more than the status");
	expect_errno(map_errno(fd, 4096, rw, MAP_SHARED, EC_MMAP_STATUS), EPERM,
		     "status to write to");
	for (unsigned int i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++)
		expect_errno(map_errno(fd, 4096, PROT_READ, MAP_SHARED, wrong[i]), EINVAL,
			     "offset 0x%lx", (unsigned long)wrong[i]);
}

void check_mmap(void)
{
	int fd = open_master(O_RDWR), other = open_master(O_RDWR), ro = open_master(O_RDONLY);
	struct ec_ioc_activate a = { 0 };
	volatile struct ec_status *st;
	volatile unsigned char *image;

	expect_errno(map_errno(fd, 4096, PROT_READ, MAP_SHARED, EC_MMAP_STATUS), EPERM,
		     "status of nobody");
	session(fd);
	expect_errno(map_errno(fd, 4096, PROT_READ, MAP_SHARED, EC_MMAP_STATUS), EPERM,
		     "status before activation");
	expect_errno(call(fd, EC_IOC_ACTIVATE, &a), 0, "activate");
	refused_maps(fd, other, &a);
	expect_errno(map_errno(ro, 4096, PROT_READ, MAP_SHARED, EC_MMAP_IMAGE), EPERM,
		     "image by a reader");
	image = mmap(NULL, a.image_size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, EC_MMAP_IMAGE);
	st = mmap(NULL, a.status_size, PROT_READ, MAP_SHARED, fd, EC_MMAP_STATUS);
	expect(image != MAP_FAILED && st != MAP_FAILED, "mmap of image and status");
	if (image == MAP_FAILED || st == MAP_FAILED)
		return;
	expect(st->magic == EC_STATUS_MAGIC, "magic 0x%08x", st->magic);
	expect(mprotect((void *)st, a.status_size, PROT_READ | PROT_WRITE) < 0 && errno == EACCES,
	       "status made writable");
	expect(mprotect((void *)image, a.image_size, PROT_READ | PROT_EXEC) < 0 && errno == EACCES,
	       "image made executable");
	expect(mremap((void *)image, a.image_size, a.image_size + 4096, MREMAP_MAYMOVE) ==
	       MAP_FAILED, "image made larger");
	image[0] = 0x55;
	expect_errno(call(fd, EC_IOC_RELEASE, NULL), 0, "release");
	close(fd);
	/* what is mapped stays memory of this process, the next session has its own */
	session(other);
	expect_errno(call(other, EC_IOC_ACTIVATE, &a), 0, "activate again");
	expect(image[0] == 0x55 && st->magic == EC_STATUS_MAGIC, "mapping lost its content");
	image[0] = 0xaa;
	munmap((void *)image, a.image_size);
	munmap((void *)st, a.status_size);
	close(ro);
	close(other);
}
