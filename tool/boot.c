// SPDX-License-Identifier: GPL-2.0-only
/*
 * A udev rule per card. It needs neither this tool nor a filesystem besides that of /lib/modules,
 * since it has to work before others are mounted.
 */
#include "boot.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../lib/tools/attr.h"
#include "sys.h"
#include "tool.h"

/* before 80-drivers.rules, which loads the driver of the system */
#define PREFIX	"59-ethercat-"
#define SUFFIX	".rules"
#define MARK	"# Written by 'ethercat device bind --boot'"

#define ADDRESS	32	/* size of struct nic.pci */

static void rules_dir(char *buf, size_t size)
{
	attr_path(buf, size, "%s/udev/rules.d", sys_etc());
}

static void rule_path(char *buf, size_t size, const char *pci)
{
	char dir[256];

	rules_dir(dir, sizeof(dir));
	attr_path(buf, size, "%s/" PREFIX "%s" SUFFIX, dir, pci);
}

static void match(char *buf, size_t size, const struct nic *n)
{
	attr_path(buf, size, "ATTR{vendor}==\"0x%04x\", ATTR{device}==\"0x%04x\"", n->vendor,
		  n->device);
}

/**
 * boot_state() - what is in the file of the address of a card
 * @n: card; without vendor and device it is never %BOOT_SET
 */
enum boot boot_state(const struct nic *n)
{
	char path[320], text[2048], ids[80];
	ssize_t size;
	int fd;

	if (!*n->pci)
		return BOOT_NONE;
	rule_path(path, sizeof(path), n->pci);
	/* a link is a file of the user, and an open of a pipe must not wait */
	fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
	if (fd < 0)
		return errno == ENOENT || errno == ENOTDIR ? BOOT_NONE : BOOT_FOREIGN;
	size = read(fd, text, sizeof(text) - 1);
	close(fd);
	text[size > 0 ? size : 0] = '\0';
	if (strncmp(text, MARK, strlen(MARK)))
		return BOOT_FOREIGN;
	match(ids, sizeof(ids), n);
	return strstr(text, ids) ? BOOT_SET : BOOT_OTHER;
}

/**
 * boot_check() - can the rule of a card be written or removed?
 * @pci: address
 */
int boot_check(const char *pci)
{
	char dir[256], path[320];
	struct nic n = { 0 };

	attr_path(path, sizeof(path), "%s/udev", sys_etc());
	if (access(path, F_OK))
		return fail("%s is missing: binding a card at boot needs udev", path);
	rules_dir(dir, sizeof(dir));
	attr_path(n.pci, sizeof(n.pci), "%s", pci);
	rule_path(path, sizeof(path), pci);
	if (boot_state(&n) == BOOT_FOREIGN)
		return fail("%s was not written by this tool; move it away first", path);
	if ((mkdir(dir, 0755) && errno != EEXIST) || access(dir, W_OK))
		return fail_full(errno, NULL, 0, "cannot write to %s", dir);
	return 0;
}

/*
 * The driver of the system may have the card already, from the initramfs or with another card
 * of its kind; ec_intel may be loaded already, else it finds the card while it registers.
 */
static void print_rule(FILE *f, const struct nic *n)
{
	char ids[80];

	match(ids, sizeof(ids), n);
	fprintf(f, MARK ".\n"
		"# When the computer starts, the network card %s (%04x:%04x %s) gets the driver\n"
		"# " NIC_NATIVE ". To take this back: ethercat device unbind %s --boot\n",
		n->pci, n->vendor, n->device, n->chip, n->pci);
	fprintf(f, "ACTION==\"add\", SUBSYSTEM==\"pci\", KERNEL==\"%s\", %s, DRIVER!=\"" NIC_NATIVE
		"\", GOTO=\"bind\"\n"
		"GOTO=\"end\"\n", n->pci, ids);
	fprintf(f, "LABEL=\"bind\"\n"
		"ATTR{driver_override}=\"" NIC_NATIVE "\", RUN{builtin}+=\"kmod load " NIC_NATIVE
		"\"\n"
		"DRIVER==\"?*\", ATTR{driver/unbind}=\"%s\"\n"
		"TEST==\"/sys/bus/pci/drivers/" NIC_NATIVE "\", ATTR{subsystem/drivers_probe}=\"%s\"\n"
		"LABEL=\"end\"\n", n->pci, n->pci);
}

/* a rename is kept over a power failure only after this */
static int sync_dir(const char *dir)
{
	int fd = open(dir, O_RDONLY | O_DIRECTORY | O_CLOEXEC), err = 0;

	if (fd < 0)
		return errno;
	/* not every filesystem can */
	if (fsync(fd) && errno != EINVAL)
		err = errno;
	close(fd);
	return err;
}

/* closes @fd; 0 or errno */
static int fill(int fd, const struct nic *n)
{
	FILE *f = fdopen(fd, "w");
	int err = 0;

	if (!f) {
		err = errno;
		close(fd);
		return err;
	}
	print_rule(f, n);
	if (fflush(f) || fchmod(fd, 0644) || fsync(fd))
		err = errno;
	if (fclose(f) && !err)
		err = errno;
	return err;
}

/**
 * boot_write() - write or replace the rule of a card
 * @n: card, after boot_check()
 */
int boot_write(const struct nic *n)
{
	char dir[256], path[320], new[320];
	int fd, err;

	rules_dir(dir, sizeof(dir));
	rule_path(path, sizeof(path), n->pci);
	/* udev reads names that end in .rules only */
	attr_path(new, sizeof(new), "%s/.ethercat-XXXXXX", dir);
	fd = mkstemp(new);
	err = fd < 0 ? errno : fill(fd, n);
	if (!err && rename(new, path))
		err = errno;
	if (err && fd >= 0)
		unlink(new);
	if (!err)
		err = sync_dir(dir);
	return err ? fail_full(err, NULL, 0, "cannot write %s", path) : 0;
}

/**
 * boot_remove() - remove the rule of a card
 * @pci: address, after boot_check()
 */
int boot_remove(const char *pci)
{
	char dir[256], path[320];
	int err = 0;

	rules_dir(dir, sizeof(dir));
	rule_path(path, sizeof(path), pci);
	if (unlink(path))
		err = errno;
	else
		err = sync_dir(dir);
	return err ? fail_full(err, NULL, 0, "cannot remove %s", path) : 0;
}

/* the address in the name of a rule; false: another file */
static bool address_of(const char *file, char *pci)
{
	size_t head = strlen(PREFIX), tail = strlen(SUFFIX), n = strlen(file);

	if (n <= head + tail || n - head - tail >= ADDRESS || strncmp(file, PREFIX, head) ||
	    strcmp(file + n - tail, SUFFIX))
		return false;
	attr_path(pci, n - head - tail + 1, "%s", file + head);
	return true;
}

static bool is_present(const struct nics *all, const char *pci)
{
	for (size_t i = 0; i < all->n; i++)
		if (!strcmp(all->v[i].pci, pci))
			return all->v[i].boot == BOOT_SET;
	return false;
}

void boot_note_absent(const struct nics *all)
{
	struct dirent **files;
	struct nic n = { 0 };
	char dir[256];
	int count;

	rules_dir(dir, sizeof(dir));
	count = scandir(dir, &files, NULL, alphasort);
	for (int i = 0; i < count; i++) {
		if (address_of(files[i]->d_name, n.pci) && boot_state(&n) == BOOT_OTHER &&
		    !is_present(all, n.pci))
			note("the card that is bound at boot is absent at %s; to forget it: 'ethercat device unbind %s --boot'",
			     n.pci, n.pci);
		free(files[i]);
	}
	if (count >= 0)
		free(files);
}
