// SPDX-License-Identifier: GPL-2.0-only
/*
 * The devices the model knows by name. Identities are those of the real
 * devices as far as known, objects and PDOs follow their pattern; what a
 * device does beyond that is not modelled.
 */
#include "app_int.h"

#define VENDOR_BECKHOFF	0x00000002u
#define VENDOR_WAGO	0x00000021u
#define VENDOR_SIM	0x0000EC51u	/* generic slaves */

#define EBUS_IN_OUT	{ EC_PORT_TYPE_EBUS, EC_PORT_TYPE_EBUS }
#define MII_IN_OUT	{ EC_PORT_TYPE_MII, EC_PORT_TYPE_MII }

#define IO_WITHOUT_CPU	0x0104u	/* digital I/O, device emulation */
#define COUPLER		0x0D00u	/* no PDI, device emulation */
#define CPU		0x0005u	/* SPI */
#define CPU_DC		0x0C05u	/* with SYNC and LATCH units */

#define COE_READ	(EC_SII_COE_SDO | EC_SII_COE_SDO_INFO)
#define COE_ALL		(COE_READ | EC_SII_COE_COMPLETE)

#define FEAT_DC		(EC_FEAT_DC | EC_FEAT_DC_ENHANCED)
#define FEAT_DC64	(FEAT_DC | EC_FEAT_DC64)

/* digital channel @n (0..7), objects from @base */
#define DIGITAL(base, n, text)						\
	{ (u16)((base) + 0x10 * (n)), 1, 1, EC_TYPE_BOOL, (n) + 1,	\
	  text, "Channel" }
#define DIGITAL4(base, text)						\
	DIGITAL(base, 0, text), DIGITAL(base, 1, text),			\
	DIGITAL(base, 2, text), DIGITAL(base, 3, text)
#define DIGITAL8(base, text)						\
	DIGITAL4(base, text), DIGITAL(base, 4, text),			\
	DIGITAL(base, 5, text), DIGITAL(base, 6, text),			\
	DIGITAL(base, 7, text)

/* its PDO, the n-th from @base, in SyncManager @sm */
#define ONE(base, sm, entries, n, text)					\
	{ (u16)((base) + (n)), sm, 1, &(entries)[n], text }
#define ONE4(base, sm, entries)						\
	ONE(base, sm, entries, 0, "Channel 1"),				\
	ONE(base, sm, entries, 1, "Channel 2"),				\
	ONE(base, sm, entries, 2, "Channel 3"),				\
	ONE(base, sm, entries, 3, "Channel 4")
#define ONE8(base, sm, entries)						\
	ONE4(base, sm, entries),					\
	ONE(base, sm, entries, 4, "Channel 5"),				\
	ONE(base, sm, entries, 5, "Channel 6"),				\
	ONE(base, sm, entries, 6, "Channel 7"),				\
	ONE(base, sm, entries, 7, "Channel 8")

static const struct ec_app_pdo_entry out8[] = { DIGITAL8(0x7000, "Output") };
static const struct ec_app_pdo_entry in8[] = { DIGITAL8(0x6000, "Input") };
static const struct ec_app_pdo_entry out8b[] = { DIGITAL8(0x7080, "Output") };

static const struct ec_app_pdo out4_pdos[] = { ONE4(0x1600, 0, out8) };
static const struct ec_app_pdo out8_pdos[] = { ONE8(0x1600, 0, out8) };
static const struct ec_app_pdo in4_pdos[] = { ONE4(0x1A00, 0, in8) };
static const struct ec_app_pdo in8_pdos[] = { ONE8(0x1A00, 0, in8) };
static const struct ec_app_pdo el1859_pdos[] = {
	ONE8(0x1608, 0, out8b),
	ONE8(0x1A00, 1, in8),
};

/* analog input with its status word, channel @n (0..) */
#define ANALOG_IN(n)							\
	{ 0x6000 + 0x10 * (n), 0x01, 1, EC_TYPE_BOOL, 0,		\
	  "Underrange", "AI Inputs" },					\
	{ 0x6000 + 0x10 * (n), 0x02, 1, EC_TYPE_BOOL, 0,		\
	  "Overrange", NULL },						\
	{ 0x6000 + 0x10 * (n), 0x03, 2, 0x0031, 0, "Limit 1", NULL },	\
	{ 0x6000 + 0x10 * (n), 0x05, 2, 0x0031, 0, "Limit 2", NULL },	\
	{ 0x6000 + 0x10 * (n), 0x07, 1, EC_TYPE_BOOL, 0,		\
	  "Error", NULL },						\
	{ 0, 0, 7, 0, 0, NULL, NULL },					\
	{ 0x6000 + 0x10 * (n), 0x0F, 1, EC_TYPE_BOOL, 0,		\
	  "TxPDO State", NULL },					\
	{ 0x6000 + 0x10 * (n), 0x10, 1, EC_TYPE_BOOL, 0,		\
	  "TxPDO Toggle", NULL },					\
	{ 0x6000 + 0x10 * (n), 0x11, 16, EC_TYPE_INT16, (n) + 1,	\
	  "Value", NULL }

static const struct ec_app_pdo_entry ai1[] = { ANALOG_IN(0) };
static const struct ec_app_pdo_entry ai2[] = { ANALOG_IN(1) };

static const struct ec_app_pdo el3062_pdos[] = {
	{ 0x1A00, 3, ARRAY_SIZE(ai1), ai1, "AI Standard Channel 1" },
	{ 0x1A01, 0xFF, 1, &ai1[8], "AI Compact Channel 1" },
	{ 0x1A02, 3, ARRAY_SIZE(ai2), ai2, "AI Standard Channel 2" },
	{ 0x1A03, 0xFF, 1, &ai2[8], "AI Compact Channel 2" },
};

static const struct ec_app_pdo_entry ao[] = {
	{ 0x7000, 0x01, 16, EC_TYPE_INT16, 1, "Analog output", "AO Outputs" },
	{ 0x7010, 0x01, 16, EC_TYPE_INT16, 2, "Analog output", "AO Outputs" },
};

static const struct ec_app_pdo el4002_pdos[] = {
	{ 0x1600, 2, 1, &ao[0], "AO Outputs Channel 1" },
	{ 0x1601, 2, 1, &ao[1], "AO Outputs Channel 2" },
};

static const struct ec_app_var el4002_vars[] = {
	{ 0x8000, 0x02, 8, EC_TYPE_UINT8, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Presentation", "AO Settings" },
	{ 0x8000, 0x13, 16, EC_TYPE_INT16, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Default output", NULL },
	{ 0x8010, 0x02, 8, EC_TYPE_UINT8, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Presentation", "AO Settings" },
	{ 0x8010, 0x13, 16, EC_TYPE_INT16, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Default output", NULL },
};

static const struct ec_app_var el3062_vars[] = {
	{ 0x8000, 0x06, 1, EC_TYPE_BOOL, EC_APP_RW | EC_OD_SETTINGS, 1,
	  "Enable filter", "AI Settings" },
	{ 0x8000, 0x15, 16, EC_TYPE_UINT16, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Filter settings", NULL },
	{ 0x8010, 0x06, 1, EC_TYPE_BOOL, EC_APP_RW | EC_OD_SETTINGS, 1,
	  "Enable filter", "AI Settings" },
	{ 0x8010, 0x15, 16, EC_TYPE_UINT16, EC_APP_RW | EC_OD_SETTINGS, 0,
	  "Filter settings", NULL },
};

/* servo terminal with an AM8121 at its output */
static const struct ec_app_pdo_entry el7201_out[] = {
	{ 0x7010, 0x01, 16, EC_TYPE_UINT16, 1, "Controlword", "DRV Outputs" },
	{ 0x7010, 0x06, 32, EC_TYPE_INT32, 2, "Target velocity", NULL },
	{ 0x7010, 0x05, 32, EC_TYPE_INT32, 3, "Target position", NULL },
	{ 0x7010, 0x09, 16, EC_TYPE_INT16, 4, "Target torque", NULL },
	{ 0x7010, 0x03, 8, EC_TYPE_UINT8, 5, "Modes of operation", NULL },
	{ 0, 0, 8, 0, 0, NULL, NULL },
};

static const struct ec_app_pdo_entry el7201_in[] = {
	{ 0x6000, 0x11, 32, EC_TYPE_UINT32, 1, "Position", "FB Inputs" },
	{ 0x6010, 0x01, 16, EC_TYPE_UINT16, 2, "Statusword", "DRV Inputs" },
	{ 0x6010, 0x07, 32, EC_TYPE_INT32, 3, "Velocity actual value", NULL },
	{ 0x6010, 0x08, 16, EC_TYPE_INT16, 4, "Torque actual value", NULL },
	{ 0x6010, 0x09, 32, EC_TYPE_INT32, 5, "Following error actual value",
	  NULL },
	{ 0x6010, 0x03, 8, EC_TYPE_UINT8, 6, "Modes of operation display",
	  NULL },
	{ 0, 0, 8, 0, 0, NULL, NULL },
};

static const struct ec_app_pdo el7201_pdos[] = {
	{ 0x1600, 2, 1, &el7201_out[0], "DRV Controlword" },
	{ 0x1601, 2, 1, &el7201_out[1], "DRV Target velocity" },
	{ 0x1602, 0xFF, 1, &el7201_out[3], "DRV Target torque" },
	{ 0x1605, 0xFF, 2, &el7201_out[4], "DRV Modes of operation" },
	{ 0x1606, 0xFF, 1, &el7201_out[2], "DRV Target position" },
	{ 0x1A00, 3, 1, &el7201_in[0], "FB Position" },
	{ 0x1A01, 3, 1, &el7201_in[1], "DRV Statusword" },
	{ 0x1A02, 0xFF, 1, &el7201_in[2], "DRV Velocity actual value" },
	{ 0x1A03, 0xFF, 1, &el7201_in[3], "DRV Torque actual value" },
	{ 0x1A06, 0xFF, 1, &el7201_in[4], "DRV Following error actual value" },
	{ 0x1A0E, 0xFF, 2, &el7201_in[5], "DRV Modes of operation display" },
};

static const struct ec_app_var el7201_vars[] = {
	{ 0x7010, 0x03, 8, EC_TYPE_UINT8, EC_APP_RW | EC_OD_RXPDO, 9,
	  "Modes of operation", "DRV Outputs" },
	{ 0x8010, 0x13, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 68,
	  "Velocity loop proportional gain", "DRV Amplifier Settings" },
	{ 0x8010, 0x17, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 10,
	  "Position loop proportional gain", NULL },
	{ 0x8010, 0x50, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS,
	  0xFFFFFFFF, "Following error window", NULL },
	{ 0x8011, 0x11, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 18100,
	  "Max current", "DRV Motor Settings" },
	{ 0x8011, 0x12, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 4000,
	  "Rated current", NULL },
	{ 0x8011, 0x13, 8, EC_TYPE_UINT8, EC_APP_RW | EC_OD_SETTINGS, 3,
	  "Motor pole pairs", NULL },
	{ 0x8011, 0x16, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 130,
	  "Torque constant", NULL },
	{ 0x8011, 0x18, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 29,
	  "Rotor moment of inertia", NULL },
	{ 0x8011, 0x1B, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 8000,
	  "Motor speed limitation", NULL },
};

/* coupler with four channels each */
static const struct ec_app_pdo_entry wago_do[] = {
	{ 0x7000, 1, 1, EC_TYPE_BOOL, 1, "Digital output 1", "Digital outputs" },
	{ 0x7000, 2, 1, EC_TYPE_BOOL, 2, "Digital output 2", NULL },
	{ 0x7000, 3, 1, EC_TYPE_BOOL, 3, "Digital output 3", NULL },
	{ 0x7000, 4, 1, EC_TYPE_BOOL, 4, "Digital output 4", NULL },
	{ 0, 0, 4, 0, 0, NULL, NULL },
};

static const struct ec_app_pdo_entry wago_ao[] = {
	{ 0x7010, 1, 16, EC_TYPE_INT16, 5, "Analog output 1", "Analog outputs" },
	{ 0x7010, 2, 16, EC_TYPE_INT16, 6, "Analog output 2", NULL },
	{ 0x7010, 3, 16, EC_TYPE_INT16, 7, "Analog output 3", NULL },
	{ 0x7010, 4, 16, EC_TYPE_INT16, 8, "Analog output 4", NULL },
};

static const struct ec_app_pdo_entry wago_di[] = {
	{ 0x6000, 1, 1, EC_TYPE_BOOL, 1, "Digital input 1", "Digital inputs" },
	{ 0x6000, 2, 1, EC_TYPE_BOOL, 2, "Digital input 2", NULL },
	{ 0x6000, 3, 1, EC_TYPE_BOOL, 3, "Digital input 3", NULL },
	{ 0x6000, 4, 1, EC_TYPE_BOOL, 4, "Digital input 4", NULL },
	{ 0, 0, 4, 0, 0, NULL, NULL },
};

static const struct ec_app_pdo_entry wago_ai[] = {
	{ 0x6010, 1, 16, EC_TYPE_INT16, 5, "Analog input 1", "Analog inputs" },
	{ 0x6010, 2, 16, EC_TYPE_INT16, 6, "Analog input 2", NULL },
	{ 0x6010, 3, 16, EC_TYPE_INT16, 7, "Analog input 3", NULL },
	{ 0x6010, 4, 16, EC_TYPE_INT16, 8, "Analog input 4", NULL },
};

static const struct ec_app_pdo wago_pdos[] = {
	{ 0x1600, 2, ARRAY_SIZE(wago_ao), wago_ao, "Analog outputs" },
	{ 0x1601, 2, ARRAY_SIZE(wago_do), wago_do, "Digital outputs" },
	{ 0x1A00, 3, ARRAY_SIZE(wago_ai), wago_ai, "Analog inputs" },
	{ 0x1A01, 3, ARRAY_SIZE(wago_di), wago_di, "Digital inputs" },
};

static const struct ec_app_var drive_vars[] = {
	{ 0x2000, 0, 1000 * 8, EC_TYPE_OCTET_STRING, EC_APP_RW, 0,
	  "Scratch memory", NULL },
	{ 0x2001, 1, 1, EC_TYPE_BOOL, EC_APP_RW, 0, "Boolean", "All types" },
	{ 0x2001, 2, 8, EC_TYPE_INT8, EC_APP_RW, 0, "Integer 8", NULL },
	{ 0x2001, 3, 16, EC_TYPE_INT16, EC_APP_RW, 0, "Integer 16", NULL },
	{ 0x2001, 4, 32, EC_TYPE_INT32, EC_APP_RW, 0, "Integer 32", NULL },
	{ 0x2001, 5, 64, EC_TYPE_INT64, EC_APP_RW, 0, "Integer 64", NULL },
	{ 0x2001, 6, 8, EC_TYPE_UINT8, EC_APP_RW, 0, "Unsigned 8", NULL },
	{ 0x2001, 7, 16, EC_TYPE_UINT16, EC_APP_RW, 0, "Unsigned 16", NULL },
	{ 0x2001, 8, 32, EC_TYPE_UINT32, EC_APP_RW, 0, "Unsigned 32", NULL },
	{ 0x2001, 9, 64, EC_TYPE_UINT64, EC_APP_RW, 0, "Unsigned 64", NULL },
	{ 0x2001, 10, 32, EC_TYPE_FLOAT, EC_APP_RW, 0, "Real 32", NULL },
	{ 0x2001, 11, 64, EC_TYPE_DOUBLE, EC_APP_RW, 0, "Real 64", NULL },
	{ 0x2001, 12, 16 * 8, EC_TYPE_STRING, EC_APP_RW, 0, "String", NULL },
	{ 0x2002, 0, 32, EC_TYPE_UINT32, EC_OD_WRITE, 0, "Write only", NULL },
	{ 0x2003, 0, 32, EC_TYPE_UINT32, EC_OD_READ | EC_OD_WRITE_PREOP, 0,
	  "Writable in PREOP", NULL },
	{ 0x6040, 0, 16, EC_TYPE_UINT16, EC_APP_RW | EC_OD_RXPDO, 0,
	  "Controlword", NULL },
	{ 0x6041, 0, 16, EC_TYPE_UINT16, EC_OD_READ | EC_OD_TXPDO, 0,
	  "Statusword", NULL },
	{ 0x6060, 0, 8, EC_TYPE_INT8, EC_APP_RW | EC_OD_RXPDO, 8,
	  "Modes of operation", NULL },
	{ 0x6061, 0, 8, EC_TYPE_INT8, EC_OD_READ | EC_OD_TXPDO, 8,
	  "Modes of operation display", NULL },
	{ 0x6064, 0, 32, EC_TYPE_INT32, EC_OD_READ | EC_OD_TXPDO, 0,
	  "Position actual value", NULL },
	{ 0x6065, 0, 32, EC_TYPE_UINT32, EC_APP_RW | EC_OD_SETTINGS, 0xFFFFFFFF,
	  "Following error window", NULL },
	{ 0x606C, 0, 32, EC_TYPE_INT32, EC_OD_READ | EC_OD_TXPDO, 0,
	  "Velocity actual value", NULL },
	{ 0x6071, 0, 16, EC_TYPE_INT16, EC_APP_RW | EC_OD_RXPDO, 0,
	  "Target torque", NULL },
	{ 0x6077, 0, 16, EC_TYPE_INT16, EC_OD_READ | EC_OD_TXPDO, 0,
	  "Torque actual value", NULL },
	{ 0x607A, 0, 32, EC_TYPE_INT32, EC_APP_RW | EC_OD_RXPDO, 0,
	  "Target position", NULL },
	{ 0x60F4, 0, 32, EC_TYPE_INT32, EC_OD_READ | EC_OD_TXPDO, 0,
	  "Following error actual value", NULL },
	{ 0x60FF, 0, 32, EC_TYPE_INT32, EC_APP_RW | EC_OD_RXPDO, 0,
	  "Target velocity", NULL },
	{ 0x6502, 0, 32, EC_TYPE_UINT32, EC_OD_READ, 0x00000181,
	  "Supported drive modes", NULL },
};

static const struct ec_app_dc_mode dc_modes[] = {
	{ "DC Synchron", 0x0300 },
	{ "SM Synchron", 0x0000 },
};

#define DC_MODES	.dc = dc_modes, .n_dc = ARRAY_SIZE(dc_modes)
#define PDOS(p)		.pdos = p, .n_pdos = ARRAY_SIZE(p)
#define VARS(v)		.vars = v, .n_vars = ARRAY_SIZE(v)

/* mailboxes of the small CoE terminals, and their SyncManagers */
#define SMALL_MBOX	.std = { 0x1000, 128, 0x1080, 128 },		\
			.boot = { 0x1000, 244, 0x10F4, 244 }
#define SMALL_SMS(out, in)						\
	.sms = {							\
		{ 0x1000, 128, 0x26, 1, EC_SII_SM_MBOX_OUT },		\
		{ 0x1080, 128, 0x22, 1, EC_SII_SM_MBOX_IN },		\
		{ 0x1100, out, 0x24, (out) ? 1 : 0, EC_SII_SM_OUTPUTS },\
		{ 0x1180, in, 0x20, (in) ? 1 : 0, EC_SII_SM_INPUTS },	\
	},								\
	.n_sms = 4

#define DIGITAL_DEV(order, text, grp, code, ma)				\
	.name = order, .title = text, .group = grp,			\
	.vendor = VENDOR_BECKHOFF, .product = code,			\
	.revision = 0x00100000, .pdi_control = IO_WITHOUT_CPU,		\
	.current_ma = ma, .ports = EBUS_IN_OUT,				\
	.esc_type = EC_APP_ESC_ET1200, .features = FEAT_DC, .fmmus = 3,	\
	.mapping = EC_APP_MAP_FIXED

#define DIGITAL_OUT_SM	{ 0x0F00, 1, 0x44, 9, EC_SII_SM_OUTPUTS }
#define DIGITAL_IN_SM	{ 0x1000, 1, 0x00, 1, EC_SII_SM_INPUTS }

static const struct ec_app_dev devices[] = {
	{
		.name = "EK1100", .title = "EK1100 Coupler",
		.group = "System couplers",
		.vendor = VENDOR_BECKHOFF, .product = 0x044C2C52,
		.revision = 0x00120000,
		.pdi_control = COUPLER, .current_ma = -2000,
		.ports = { EC_PORT_TYPE_MII, EC_PORT_TYPE_EBUS,
			   EC_PORT_TYPE_MII },
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
	}, {
		.name = "EK1110", .title = "EK1110 Extension",
		.group = "System couplers",
		.vendor = VENDOR_BECKHOFF, .product = 0x04562C52,
		.revision = 0x00100000,
		.pdi_control = COUPLER, .current_ma = 130,
		.ports = { EC_PORT_TYPE_EBUS, EC_PORT_TYPE_MII },
		.esc_type = EC_APP_ESC_ET1200, .features = FEAT_DC64,
		.fmmus = 3,
	}, {
		.name = "EK1122", .title = "EK1122 2-port junction",
		.group = "System couplers",
		.vendor = VENDOR_BECKHOFF, .product = 0x04622C52,
		.revision = 0x00100000,
		.pdi_control = COUPLER, .current_ma = 220,
		.ports = { EC_PORT_TYPE_EBUS, EC_PORT_TYPE_EBUS, EC_PORT_TYPE_MII,
			   EC_PORT_TYPE_MII },
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
	}, {
		DIGITAL_DEV("EL1004", "EL1004 4-ch input", "Digital inputs",
			    0x03EC3052, 90), .dc_delay_only = true,
		.fmmu_use = { EC_SII_FMMU_INPUTS }, .n_fmmu_use = 1,
		.sms = { DIGITAL_IN_SM }, .n_sms = 1, PDOS(in4_pdos),
	}, {
		DIGITAL_DEV("EL1008", "EL1008 8-ch input", "Digital inputs",
			    0x03F03052, 90),
		.fmmu_use = { EC_SII_FMMU_INPUTS }, .n_fmmu_use = 1,
		.sms = { DIGITAL_IN_SM }, .n_sms = 1, PDOS(in8_pdos),
	}, {
		DIGITAL_DEV("EL1859", "EL1859 8-ch input, 8-ch output",
			    "Digital combi", 0x07433052, 130),
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS },
		.n_fmmu_use = 2,
		.sms = { DIGITAL_OUT_SM, DIGITAL_IN_SM }, .n_sms = 2,
		PDOS(el1859_pdos),
	}, {
		DIGITAL_DEV("EL2004", "EL2004 4-ch output", "Digital outputs",
			    0x07D43052, 100),
		.fmmu_use = { EC_SII_FMMU_OUTPUTS }, .n_fmmu_use = 1,
		.sms = { DIGITAL_OUT_SM }, .n_sms = 1, PDOS(out4_pdos),
	}, {
		DIGITAL_DEV("EL2008", "EL2008 8-ch output", "Digital outputs",
			    0x07D83052, 110),
		.fmmu_use = { EC_SII_FMMU_OUTPUTS }, .n_fmmu_use = 1,
		.sms = { DIGITAL_OUT_SM }, .n_sms = 1, PDOS(out8_pdos),
	}, {
		.name = "EL3062", .title = "EL3062 2-ch analog input 0-10 V",
		.group = "Analog inputs",
		.vendor = VENDOR_BECKHOFF, .product = 0x0BF63052,
		.revision = 0x00140000, .pdi_control = CPU, .current_ma = 130,
		SMALL_MBOX, .protocols = EC_SII_PROTO_COE, .coe = COE_ALL,
		.ports = EBUS_IN_OUT, .esc_type = EC_APP_ESC_ET1200,
		.features = FEAT_DC64, .fmmus = 3,
		.fmmu_use = { EC_SII_FMMU_INPUTS, EC_SII_FMMU_SM_STATUS },
		.n_fmmu_use = 2, SMALL_SMS(0, 8),
		.mapping = EC_APP_MAP_ASSIGN, PDOS(el3062_pdos),
		VARS(el3062_vars), .device_type = 0x012C1389,
	}, {
		.name = "EL4002", .title = "EL4002 2-ch analog output 0-10 V",
		.group = "Analog outputs",
		.vendor = VENDOR_BECKHOFF, .product = 0x0FA23052,
		.revision = 0x00140000, .pdi_control = CPU, .current_ma = 140,
		SMALL_MBOX, .protocols = EC_SII_PROTO_COE, .coe = COE_ALL,
		.ports = EBUS_IN_OUT, .esc_type = EC_APP_ESC_ET1200,
		.features = FEAT_DC64, .fmmus = 3,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_SM_STATUS },
		.n_fmmu_use = 2, SMALL_SMS(4, 0),
		.mapping = EC_APP_MAP_ASSIGN, PDOS(el4002_pdos),
		VARS(el4002_vars), .device_type = 0x01901389, DC_MODES,
	}, {
		.name = "EL6614", .title = "EL6614 4-port Ethernet switch",
		.group = "Communication terminals",
		.vendor = VENDOR_BECKHOFF, .product = 0x19D63052,
		.revision = 0x00100000, .pdi_control = CPU, .current_ma = 450,
		.std = { 0x1000, 1024, 0x1400, 1024 },
		.protocols = EC_SII_PROTO_EOE | EC_SII_PROTO_COE,
		.coe = COE_ALL, .ports = EBUS_IN_OUT,
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
		.sms = {
			{ 0x1000, 1024, 0x26, 1, EC_SII_SM_MBOX_OUT },
			{ 0x1400, 1024, 0x22, 1, EC_SII_SM_MBOX_IN },
		},
		.n_sms = 2, .device_type = 0x02581389,
	}, {
		.name = "EL7201", .title = "EL7201 servo terminal",
		.group = "Terminals",
		.vendor = VENDOR_BECKHOFF, .product = 0x1C213052,
		.revision = 0x00110000, .pdi_control = CPU_DC,
		.current_ma = 190,
		.std = { 0x1000, 256, 0x1100, 256 },
		.boot = { 0x1000, 512, 0x1200, 512 },
		.protocols = EC_SII_PROTO_COE | EC_SII_PROTO_FOE,
		.coe = COE_ALL, .ports = EBUS_IN_OUT,
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS,
			      EC_SII_FMMU_SM_STATUS },
		.n_fmmu_use = 3,
		.sms = {
			{ 0x1000, 256, 0x26, 1, EC_SII_SM_MBOX_OUT },
			{ 0x1100, 256, 0x22, 1, EC_SII_SM_MBOX_IN },
			{ 0x1200, 6, 0x24, 1, EC_SII_SM_OUTPUTS },
			{ 0x1300, 6, 0x20, 1, EC_SII_SM_INPUTS },
		},
		.n_sms = 4, .mapping = EC_APP_MAP_ASSIGN, PDOS(el7201_pdos),
		VARS(el7201_vars), .device_type = 0x02E21389, DC_MODES,
		.profile = &ec_app_profile_drive,
	}, {
		.name = "750-354", .title = "750-354 EtherCAT coupler",
		.group = "Fieldbus couplers",
		.vendor = VENDOR_WAGO, .product = 0x07500354,
		.revision = 0x00000002, .pdi_control = CPU,
		.std = { 0x1000, 256, 0x1100, 256 },
		.protocols = EC_SII_PROTO_COE, .coe = COE_ALL,
		.ports = MII_IN_OUT, .esc_type = EC_APP_ESC_ET1100,
		.features = FEAT_DC64, .fmmus = 8,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS },
		.n_fmmu_use = 2,
		.sms = {
			{ 0x1000, 256, 0x26, 1, EC_SII_SM_MBOX_OUT },
			{ 0x1100, 256, 0x22, 1, EC_SII_SM_MBOX_IN },
			{ 0x1200, 9, 0x64, 1, EC_SII_SM_OUTPUTS },
			{ 0x1800, 9, 0x20, 1, EC_SII_SM_INPUTS },
		},
		.n_sms = 4, .mapping = EC_APP_MAP_FIXED, PDOS(wago_pdos),
		.device_type = 0x00001389,
	}, {
		.name = "drive", .title = "Simulated drive", .group = "Drives",
		.vendor = VENDOR_SIM, .product = 0x00000402, .revision = 1,
		.pdi_control = CPU_DC,
		.protocols = EC_SII_PROTO_COE, .coe = COE_ALL,
		.flags = EC_SII_FLAG_MBOX_DLL, .ports = MII_IN_OUT,
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS,
			      EC_SII_FMMU_SM_STATUS },
		.n_fmmu_use = 3, .mapping = EC_APP_MAP_LENIENT,
		VARS(drive_vars), .device_type = 0x00020192, DC_MODES,
		.profile = &ec_app_profile_drive,
	}, {
		.name = "sercos", .title = "Simulated SERCOS drive", .group = "Drives",
		.vendor = VENDOR_SIM, .product = 0x00005E2C, .revision = 1,
		.pdi_control = CPU_DC, .std = { 0x1000, 128, 0x1080, 128 },
		.protocols = EC_SII_PROTO_SOE, .flags = EC_SII_FLAG_MBOX_DLL,
		.ports = MII_IN_OUT, .esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS,
			      EC_SII_FMMU_SM_STATUS },
		.n_fmmu_use = 3,
		.sms = {
			{ 0x1000, 128, 0x26, 1, EC_SII_SM_MBOX_OUT },
			{ 0x1080, 128, 0x22, 1, EC_SII_SM_MBOX_IN },
			{ 0x1200, 0, 0x64, 0, EC_SII_SM_OUTPUTS },
			{ 0x1800, 0, 0x20, 0, EC_SII_SM_INPUTS },
		},
		.n_sms = 4, .max_bytes = { 272, 272 }, .mapping = EC_APP_MAP_FIXED, DC_MODES,
		.profile = &ec_app_profile_sercos,
	}, {
		.name = "io", .title = "Simulated inputs and outputs",
		.group = "Inputs and outputs",
		.vendor = VENDOR_SIM, .product = 0x00000104, .revision = 1,
		.pdi_control = IO_WITHOUT_CPU, .ports = MII_IN_OUT,
		.esc_type = EC_APP_ESC_ET1100, .features = FEAT_DC64,
		.fmmus = 8,
		.fmmu_use = { EC_SII_FMMU_OUTPUTS, EC_SII_FMMU_INPUTS },
		.n_fmmu_use = 2, .mapping = EC_APP_MAP_FIXED,
	},
};

/**
 * ec_app_catalogue_at() - the @n-th device of the catalogue
 * @n: from 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its table, NULL behind the last.
 */
const struct ec_app_dev *ec_app_catalogue_at(u32 n)
{
	return n < ARRAY_SIZE(devices) ? &devices[n] : NULL;
}

/**
 * ec_app_catalogue() - find a device by its name
 * @name: name, not terminated
 * @len: bytes of it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its table, NULL: not known.
 */
const struct ec_app_dev *ec_app_catalogue(const char *name, size_t len)
{
	for (u32 i = 0; i < ARRAY_SIZE(devices); i++)
		if (strlen(devices[i].name) == len &&
		    !memcmp(devices[i].name, name, len))
			return &devices[i];
	return NULL;
}

/**
 * ec_app_dev_is_generic() - has a device sizes of its own choice
 * @dev: table
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true for "drive" and "io".
 */
bool ec_app_dev_is_generic(const struct ec_app_dev *dev)
{
	return dev->vendor == VENDOR_SIM && dev->profile != &ec_app_profile_sercos;
}
