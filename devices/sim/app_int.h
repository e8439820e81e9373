/* SPDX-License-Identifier: GPL-2.0-only */
/* What the files that build models share among themselves. */
#ifndef EC_SIM_APP_INT_H
#define EC_SIM_APP_INT_H

#include "app.h"

/* slave_eeprom.c */
int ec_app_model_eeprom(struct ec_app_model *m);
int ec_app_model_modes(struct ec_app_model *m);
void ec_app_model_hide(struct ec_app_model *m);
int ec_app_model_parse(struct ec_app_model *m, const u8 *eeprom, size_t len);

/* catalogue.c, profile_generic.c */
bool ec_app_dev_is_generic(const struct ec_app_dev *dev);
int ec_app_dev_generic(struct ec_app_model *m);

#endif
