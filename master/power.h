/* SPDX-License-Identifier: GPL-2.0-only */
/* What the masters do when the computer reboots, sleeps and resumes. */
#ifndef EC_POWER_H
#define EC_POWER_H

int ec_power_init(void);
void ec_power_exit(void);

/* what the notifiers call */
void ec_power_down(const char *what);
int ec_power_sleep(void);
void ec_power_resume(void);

#endif
