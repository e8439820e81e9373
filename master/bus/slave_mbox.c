// SPDX-License-Identifier: GPL-2.0-only
/* Has a slave a mailbox? Its EEPROM has three places for the answer. */
#include "slave.h"
#include "slave_mbox.h"

/**
 * ec_slave_mbox_text() - in what the EEPROM contradicts itself about the mailbox
 * @s: slave
 * @buf: result, empty: in nothing
 * @size: of @buf
 *
 * Context: Any.
 */
void ec_slave_mbox_text(const struct ec_slave *s, char *buf, size_t size)
{
	const struct ec_sii_mbox *m = &s->info.std;
	struct ec_sii_mbox sms = { 0 };

	ec_sii_mbox_of_sms(s->sms, s->n_sms, &sms);
	buf[0] = '\0';
	switch (s->mbox_doubt) {
	case EC_SII_MBOX_NO_PROTOCOL:
		scnprintf(buf, size,
			  "mailbox of %u and %u bytes, but protocols 0x0000 (SII word 0x1c); set up, and not used",
			  m->rx_size, m->tx_size);
		break;
	case EC_SII_MBOX_NO_WORDS:
		scnprintf(buf, size,
			  "mailbox of 0 and 0 bytes in SII words 0x18 to 0x1b, of %u and %u bytes in category 41; this one is used",
			  m->rx_size, m->tx_size);
		break;
	case EC_SII_MBOX_DIFFERS:
		scnprintf(buf, size,
			  "mailbox 0x%04x/%u and 0x%04x/%u in SII words 0x18 to 0x1b, 0x%04x/%u and 0x%04x/%u in category 41; that of the words is used",
			  m->rx_offset, m->rx_size, m->tx_offset, m->tx_size, sms.rx_offset,
			  sms.rx_size, sms.tx_offset, sms.tx_size);
		break;
	case EC_SII_MBOX_NONE:
		scnprintf(buf, size,
			  "mailbox protocols 0x%04x (SII word 0x1c), but a mailbox of 0 bytes in SII words 0x18 to 0x1b and category 41; none is used",
			  s->info.protocols);
		break;
	}
}

/**
 * ec_slave_settle_mbox() - decide which mailbox a slave has, for all of its states but BOOT
 * @s: slave whose EEPROM has just been read
 *
 * Context: Process. May sleep.
 */
void ec_slave_settle_mbox(struct ec_slave *s)
{
	char text[EC_UAPI_WARNING];

	s->mbox_doubt = ec_sii_settle_mbox(&s->info, s->sms, s->n_sms);
	ec_slave_mbox_text(s, text, sizeof(text));
	if (text[0])
		ec_slave_warn(s, "%s\n", text);
}
