/* SPDX-License-Identifier: GPL-2.0-only */
/* What the files of the segment parser share among themselves. */
#ifndef EC_SIM_DESCRIBE_INT_H
#define EC_SIM_DESCRIBE_INT_H

#include "describe.h"

#define EC_DESC_WORDS	32
#define EC_DESC_NOWHERE	(-3)	/* the parent of a slave that is plugged later */
#define EC_DESC_LINK_MAX	4000000000u	/* ns */
#define EC_DESC_TIME_MAX	(3600ull * 1000000000ull)

/* a word of a statement, in the text, not terminated */
struct ec_desc_word {
	const char *s;
	size_t n;
	bool used;
};

/* a wire between slaves that both hang elsewhere already, or back to a master */
struct ec_desc_wire {
	unsigned int line;
	int a, a_port;
	int b, b_port;
	u32 cable_ns;
};

/* how a slave hangs in the segment */
struct ec_desc_node {
	struct ec_app *app;
	unsigned int line;
	int parent;
	int parent_port;
	int child_port;
	u32 cable_ns;
	bool wired;	/* by a wire statement */
	struct ec_desc_wire place;	/* the cable that it would have without that */
	u32 walk;	/* in which it was passed, see ec_desc_add_loops() */
	bool reached;	/* from a master */
	int todo;	/* next one whose neighbours are looked at, -1: none */
};

/* the cable of a slave to the one before */
struct ec_desc_cable {
	u64 ns;
	bool swapped;	/* in port 1, the next slave is at port 0 */
};

/**
 * struct ec_desc - a description being read
 * @ops: memory
 * @loader: EEPROM images, may be NULL
 * @err: what went wrong
 * @line: line being read
 * @w: its words
 * @n: how many
 * @sim: segment being built
 * @seed: from the segment statement
 * @response_ns: default of the slaves
 * @transition_ns: default of the slaves
 * @op_timeout_ns: default of the slaves
 * @link_ns: default of the slaves
 * @node: slaves so far
 * @n_nodes: how many
 * @max_nodes: slaves in the text
 * @wire: further wires
 * @n_wires: how many
 * @max_wires: wire statements in the text
 * @model: kinds of slaves so far
 * @n_models: how many
 * @command: a fault to be read into this, for a segment that runs; NULL
 * @at: slave at which the next one hangs, -1: master, EC_DESC_NOWHERE
 * @at_port: its port
 */
struct ec_desc {
	const struct ec_sim_ops *ops;
	const struct ec_sim_loader *loader;
	struct ec_sim_error *err;
	unsigned int line;
	struct ec_desc_word w[EC_DESC_WORDS];
	u32 n;
	struct ec_sim *sim;
	u64 seed;
	u64 response_ns;
	u64 transition_ns;
	u64 op_timeout_ns;
	u64 link_ns;
	struct ec_desc_node *node;
	u32 n_nodes;
	u32 max_nodes;
	struct ec_desc_wire *wire;
	u32 n_wires;
	u32 max_wires;
	struct ec_app_model **model;
	u32 n_models;
	struct ec_sim_fault *command;
	int at;
	int at_port;
};

/* describe_words.c: reading words; all say what is wrong and return -EINVAL */
int ec_desc_split(struct ec_desc *d, const char **p, const char *end);
int ec_desc_fail(struct ec_desc *d, const char *before,
		 const struct ec_desc_word *w, const char *after);
bool ec_desc_is(const struct ec_desc_word *w, const char *text);
struct ec_desc_word *ec_desc_next(struct ec_desc *d);
struct ec_desc_word ec_desc_value(struct ec_desc *d, const char *key);
int ec_desc_end(struct ec_desc *d);
int ec_desc_number(struct ec_desc *d, const char *key, s64 min, s64 max,
		   s64 *v);
int ec_desc_time(struct ec_desc *d, const char *key, u64 max, u64 *v);
int ec_desc_rate(struct ec_desc *d, const char *key, s64 max_ppb, s64 *ppb);
int ec_desc_jump(struct ec_desc *d, const char *key, u64 max, s64 *v);
int ec_desc_yes(struct ec_desc *d, const char *key, bool *v);
int ec_desc_parse_number(struct ec_desc *d, const struct ec_desc_word *w,
			 s64 min, s64 max, s64 *v);
int ec_desc_place(struct ec_desc *d, const struct ec_desc_word *w,
		  struct ec_desc_word *name, s64 *number);
int ec_desc_slave(struct ec_desc *d, const struct ec_desc_word *w);

/* describe_cable.c */
int ec_desc_end_of_wire(struct ec_desc *d, const struct ec_desc_word *w, int *slave, int *port);
int ec_desc_port(struct ec_desc *d, struct ec_sim_fault *f);
int ec_desc_under_way(struct ec_desc *d);
int ec_desc_own_ports(struct ec_desc *d, struct ec_app_config *c);
void ec_desc_add_loops(struct ec_desc *d);

/* describe_slave.c */
int ec_desc_params(struct ec_desc *d, struct ec_app_params *p);
int ec_desc_config(struct ec_desc *d, struct ec_app_config *c, struct ec_desc_cable *cable);

/* describe_quirk.c */
int ec_desc_quirks(struct ec_desc *d, struct ec_app_quirks *q);
int ec_desc_steps(struct ec_desc *d, struct ec_app_config *c);
int ec_desc_quirks_fit(struct ec_desc *d, const struct ec_desc_word *name,
		       const struct ec_app_model *m, const struct ec_app_config *c);

/* describe_foe.c */
int ec_desc_foe(struct ec_desc *d, struct ec_app_config *c);

/* describe_eoe.c */
int ec_desc_eoe(struct ec_desc *d, struct ec_app_params *p);
int ec_desc_eoe_fault(struct ec_desc *d, struct ec_sim_fault *f);

/* describe_wait.c */
int ec_desc_when(struct ec_desc *d, enum ec_sim_when *when);
int ec_desc_register(struct ec_desc *d, struct ec_sim_fault *f);
int ec_desc_wait(struct ec_desc *d, struct ec_sim_fault *f);

/* describe_fault.c */
int ec_desc_fault(struct ec_desc *d);

#endif
