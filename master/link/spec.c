// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/kernel.h>
#include <linux/string.h>
#include "spec.h"
#include "../kernel/compat.h"

/* The address of a PCI function, name of a native device: 0000:01:00.0. */
static bool is_pci(const char *spec)
{
	unsigned int domain, bus, slot, function;
	int len = 0;

	return sscanf(spec, "%4x:%2x:%2x.%1x%n", &domain, &bus, &slot, &function, &len) == 4 &&
	       len == 12 && !spec[len];
}

/* A name that can be an interface's: the kernel's rules for them. */
static bool is_name(const char *spec)
{
	size_t len = strlen(spec);

	return len && len < IFNAMSIZ && strcmp(spec, ".") && strcmp(spec, "..") &&
	       !spec[strcspn(spec, "/: \t\n")];
}

/* An address that a device can have, or the broadcast address. */
static bool is_address(const char *spec)
{
	u8 mac[ETH_ALEN] __aligned(2);

	return strlen(spec) == 3 * ETH_ALEN - 1 && mac_pton(spec, mac) &&
	       (is_valid_ether_addr(mac) || is_broadcast_ether_addr(mac));
}

/**
 * ec_spec_is_valid() - can there be a device of that name?
 * @spec: name
 *
 * Context: Any.
 * Return: whether it is a MAC address, a PCI address or a possible name of an interface.
 */
bool ec_spec_is_valid(const char *spec)
{
	return is_name(spec) || is_address(spec) || is_pci(spec);
}

/**
 * ec_spec_is_any() - does the name mean any device?
 * @spec: name
 *
 * Context: Any.
 * Return: whether it is the broadcast address.
 */
bool ec_spec_is_any(const char *spec)
{
	u8 mac[ETH_ALEN] __aligned(2);

	return mac_pton(spec, mac) && is_broadcast_ether_addr(mac);
}

/**
 * ec_spec_same() - do two names always mean the same device?
 * @a: name
 * @b: another one
 *
 * The broadcast address means any device, so it may be given again.
 *
 * Context: Any.
 * Return: whether they do.
 */
bool ec_spec_same(const char *a, const char *b)
{
	u8 x[ETH_ALEN] __aligned(2), y[ETH_ALEN] __aligned(2);

	if (mac_pton(a, x) && mac_pton(b, y))
		return ether_addr_equal(x, y) && !is_broadcast_ether_addr(x);
	return is_pci(a) ? !strcasecmp(a, b) : !strcmp(a, b);
}

/**
 * ec_spec_matches() - does a name mean this device?
 * @spec: name, NULL or "": none
 * @name: the device's
 * @mac: its address
 *
 * Context: Any.
 * Return: whether it does.
 */
bool ec_spec_matches(const char *spec, const char *name, const u8 *mac)
{
	u8 want[ETH_ALEN] __aligned(2);

	if (!spec || !*spec)
		return false;
	if (mac_pton(spec, want))
		return is_broadcast_ether_addr(want) || ether_addr_equal(want, mac);
	/* PCI addresses in any case; interfaces have their own name */
	return strchr(spec, ':') ? !strcasecmp(spec, name) : !strcmp(spec, name);
}
