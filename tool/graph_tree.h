/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_GRAPH_TREE_H
#define EC_TOOL_GRAPH_TREE_H

#include "dev.h"
#include "errors.h"

int graph_tree(struct dev *d, const struct slaves *all, const struct ect_errors *const *errors);

#endif
