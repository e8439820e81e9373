/* SPDX-License-Identifier: GPL-2.0-only */
/* Begin and end of the posts of a master. */
#ifndef EC_POSTS_H
#define EC_POSTS_H

struct ec_carry;
struct ec_carry_ops;
struct ec_links;

int ec_carry_init(struct ec_carry *c, struct ec_links *l, const struct ec_carry_ops *ops);
void ec_carry_exit(struct ec_carry *c);

#endif
