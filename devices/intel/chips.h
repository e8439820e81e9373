/* SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later */
/*
 * Intel network controllers by PCI device ID, for the driver and for 'ethercat devices':
 * EC_CHIP(device ID, name, class, the tests run it in QEMU), and EC_CHIP_ME for those whose PHY
 * is shared with the management engine. Copper variants only: fibre and backplane need a set-up
 * of the link that no test can run.
 */
EC_CHIP(0x100e, "82540EM", c8254x, true)
EC_CHIP(0x1015, "82540EM", c8254x, false)
EC_CHIP(0x1017, "82540EP", c8254x, false)
EC_CHIP(0x100f, "82545EM", c8254x, false)
EC_CHIP(0x1026, "82545GM", c8254x, false)
EC_CHIP(0x1010, "82546EB", c8254x, false)
EC_CHIP(0x1079, "82546GB", c8254x, false)
EC_CHIP(0x10d3, "82574L", c82574, true)
EC_CHIP(0x10f6, "82574LA", c82574, false)
EC_CHIP(0x150c, "82583V", c82574, false)
EC_CHIP(0x10c9, "82576", c82576, true)
EC_CHIP(0x150e, "82580", c82580, false)
EC_CHIP(0x1521, "I350", ci350, false)
EC_CHIP(0x1533, "I210", ci350, false)
EC_CHIP(0x157b, "I210", ci350, false)
EC_CHIP(0x1539, "I211", ci350, false)
EC_CHIP_ME(0x153a, "I217-LM")
EC_CHIP_ME(0x153b, "I217-V")
EC_CHIP_ME(0x155a, "I218-LM")
EC_CHIP_ME(0x1559, "I218-V")
EC_CHIP_ME(0x15a0, "I218-LM")
EC_CHIP_ME(0x15a1, "I218-V")
EC_CHIP_ME(0x15a2, "I218-LM")
EC_CHIP_ME(0x15a3, "I218-V")
EC_CHIP_ME(0x156f, "I219-LM")
EC_CHIP_ME(0x1570, "I219-V")
EC_CHIP_ME(0x15b7, "I219-LM")
EC_CHIP_ME(0x15b8, "I219-V")
