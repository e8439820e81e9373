// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "../master/wire/al.h"
#include "al_request.h"

#define POLL_MS		10

/* why a slave is not in the requested state: ": text" parts, "" when it is */
void al_reason(const struct ect_slave *s, char *buf, size_t size)
{
	char code[8];
	int n = 0;

	*buf = 0;
	snprintf(code, sizeof(code), "0x%04x", s->al_code);
	if (s->al_code && (!s->error || !strstr(s->why, code)))
		n = snprintf(buf, size, "AL status code %s: %s", code, ec_al_code_text(s->al_code));
	if (s->error && s->why[0] && (size_t)n < size)
		snprintf(buf + n, size - (size_t)n, "%s%s", n ? ": " : "", s->why);
}

int al_request(struct dev *d, const struct ect_slave *s, u8 state, u32 timeout_ms)
{
	int err = ect_state_request(d->h, s->device, state, timeout_ms);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot request %s", d->master,
			      s->position, ec_al_state_name(state)) : 0;
}

static int failed(const struct dev *d, const struct ect_slave *s, u8 wanted, const char *what)
{
	char state[16], why[400];

	al_state_text(s->al_status, state, sizeof(state));
	al_reason(s, why, sizeof(why));
	return fail("Master%u slave %u: %s %s, it is in %s%s%s", d->master, s->position, what,
		    ec_al_state_name(wanted), state, *why ? ": " : "", why);
}

/*
 * The master clears its error flag when it takes the request. The slave's own
 * error bit counts once it is new or its code differs from before.
 */
int al_wait(struct dev *d, const struct ect_slave *before, u8 wanted, double end)
{
	struct ect_slave s = *before;
	double start = now_s();

	for (;;) {
		if (dev_slave(d, &s))
			return 1;
		if ((s.al_status & (EC_AL_STATE_MASK | EC_AL_ERROR)) == wanted)
			return 0;
		if (s.error == ECT_SLAVE_CONFIG_FAILED)
			return failed(d, &s, wanted, "cannot reach");
		if (s.al_status & EC_AL_ERROR &&
		    (!(before->al_status & EC_AL_ERROR) || s.al_code != before->al_code ||
		     now_s() - start > 1))
			return failed(d, &s, wanted, "refused");
		if (now_s() >= end)
			return failed(d, &s, wanted, "has not reached");
		sleep_ms(POLL_MS);
	}
}
