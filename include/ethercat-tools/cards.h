/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: network cards of this computer; no master is needed. */
#ifndef ETHERCAT_TOOLS_CARDS_H
#define ETHERCAT_TOOLS_CARDS_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* an Ethernet interface with hardware of its own, or a controller without interface */
struct ect_card {
	uint32_t struct_size;
	uint32_t vendor;	/* of the PCI function */
	uint32_t device;	/* likewise */
	uint32_t speed;		/* Mbit/s, 0: not known */
	uint8_t link_known;
	uint8_t link_up;
	uint8_t of_master;	/* @by is a master; else the system */
	uint8_t kept;		/* only the native driver may have it, which is not loaded */
	uint8_t tested;		/* tests run the chip with the native driver, in QEMU */
	uint8_t reserved[3];
	char name[32];		/* interface, or "" */
	char pci[32];		/* address of the PCI function, or "" */
	char mac[18];		/* or "": not known */
	char driver[32];	/* or "" */
	char chip[16];		/* in the list of the native driver, or "" */
	char why_not[80];	/* why there is no native driver; "": there is one */
	char by[48];		/* its user, or "" */
};

/**
 * ect_cards_read() - the network cards of this computer
 * @h: handle, with or without master
 * @list: result, elements are struct ect_card by their place
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_cards_read(struct ect_handle *h, struct ect_list **list);

/* settings of a network card that matter to a cycle */
struct ect_card_settings {
	uint32_t struct_size;
	/* 0, or why the settings are not known: -EOPNOTSUPP if the driver does not have them */
	int32_t coalesce_error;	/* of @rx_usecs and @adaptive_rx */
	int32_t eee_error;	/* of @eee */
	int32_t pause_error;	/* of @pause_rx and @pause_tx */
	uint32_t rx_usecs;	/* delay of the receive interrupt */
	uint8_t adaptive_rx;	/* the driver changes it by load */
	uint8_t eee;		/* Energy-Efficient Ethernet is on */
	uint8_t pause_rx;	/* pause frames stop the sender */
	uint8_t pause_tx;
};

/**
 * ect_card_settings() - settings of a network card
 * @h: handle, with or without master
 * @interface: name of the network interface
 * @s: result, with its @struct_size
 *
 * Context: The thread of the handle.
 * Return: 0, also if some of them are not known; or a negative errno.
 */
int ect_card_settings(struct ect_handle *h, const char *interface, struct ect_card_settings *s);

#ifdef __cplusplus
}
#endif

#endif
