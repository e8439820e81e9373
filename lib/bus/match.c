// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "match.h"
#include "table.h"

/* a pair in the order; 4096 of them, the most that WORK_MAX allows, fit into 16 bits */
#define WEIGHT_IDENTITY	4
#define WEIGHT_PLACE	6
#define WEIGHT_SIGN	12
#define WORK_MAX	(16u << 20)	/* pairs that are compared; beyond it only in order */

static int side_init(struct side *s, const struct ecb_master *m)
{
	struct table names;
	struct seat *seat;

	s->slaves = m->slaves;
	s->count = m->slave_count;
	s->peer = malloc((s->count + 1) * sizeof(*s->peer));
	s->parent = malloc((s->count + 1) * sizeof(*s->parent));
	if (!s->peer || !s->parent || table_init(&names, s->count + 1))
		return -ENOMEM;
	for (size_t i = 0; i < s->count; i++) {
		s->peer[i] = s->parent[i] = NO_SLAVE;
		seat = table_find(&names, s->slaves[i]->name);
		seat->key = s->slaves[i]->name;
		seat->value = i;
	}
	/* a parent may stand behind */
	for (size_t i = 0; i < s->count; i++) {
		seat = s->slaves[i]->parent ? table_find(&names, s->slaves[i]->parent) : NULL;
		if (seat && seat->key)
			s->parent[i] = seat->value;
		s->placed |= s->parent[i] != NO_SLAVE;
	}
	table_free(&names);
	return 0;
}

void match_free(struct match *m)
{
	free(m->a.peer);
	free(m->a.parent);
	free(m->b.peer);
	free(m->b.parent);
}

static void join(struct match *m, size_t a, size_t b)
{
	m->a.peer[a] = b;
	m->b.peer[b] = a;
}

static bool same_sign(const struct ecb_slave *a, const struct ecb_slave *b, unsigned int step)
{
	switch (step) {
	case 0:
		return a->alias && a->alias == b->alias;
	case 1:
		return a->identification && a->identification == b->identification;
	case 2:
		return a->serial && a->serial == b->serial && same_identity(a, b);
	default:
		return !strcmp(a->name, b->name) && same_identity(a, b);
	}
}

/* slaves with a sign of their own, wherever they are */
static void by_signs(struct match *m, bool by_name)
{
	for (unsigned int step = 0; step < (by_name ? 4 : 3); step++)
		for (size_t i = 0; i < m->a.count; i++) {
			const struct ecb_slave *a = m->a.slaves[i];
			size_t k = 0;

			if (m->a.peer[i] != NO_SLAVE || !same_sign(a, a, step))
				continue;
			/* most often it is in its place */
			if (i < m->b.count && m->b.peer[i] == NO_SLAVE &&
			    same_sign(a, m->b.slaves[i], step))
				k = i;
			while (k < m->b.count && (m->b.peer[k] != NO_SLAVE ||
						  !same_sign(a, m->b.slaves[k], step)))
				k++;
			if (k < m->b.count)
				join(m, i, k);
		}
}

/* those without peer */
static size_t left(const struct side *s, size_t *to)
{
	size_t n = 0;

	for (size_t i = 0; i < s->count; i++)
		if (s->peer[i] == NO_SLAVE)
			to[n++] = i;
	return n;
}

/* whether two slaves stand at the same port of what is, or could be, the same slave */
static bool same_place(const struct match *m, size_t a, size_t b)
{
	size_t pa = m->a.parent[a], pb = m->b.parent[b];

	if (!m->a.placed || !m->b.placed)
		return true;
	if (pa == NO_SLAVE || pb == NO_SLAVE)
		return pa == pb;
	if (m->a.slaves[a]->port != m->b.slaves[b]->port)
		return false;
	if (m->a.peer[pa] != NO_SLAVE || m->b.peer[pb] != NO_SLAVE)
		return m->a.peer[pa] == pb;
	return same_identity(m->a.slaves[pa], m->b.slaves[pb]);
}

/* what a pair counts in the order: 0 is no pair; those by signs hold the others between them */
static unsigned int weight(const struct match *m, size_t a, size_t b)
{
	if (m->a.peer[a] != NO_SLAVE || m->b.peer[b] != NO_SLAVE)
		return m->a.peer[a] == b ? WEIGHT_SIGN : 0;
	if (!same_identity(m->a.slaves[a], m->b.slaves[b]))
		return 0;
	return same_place(m, a, b) ? WEIGHT_PLACE : WEIGHT_IDENTITY;
}

/* too many for a table: the next one of the same identity */
static void greedy(struct match *m, size_t a, size_t n, size_t b, size_t k)
{
	size_t from = b;

	for (size_t i = a; i < a + n; i++)
		for (size_t j = from; j < b + k && j < from + 256; j++)
			if (weight(m, i, j)) {
				join(m, i, j);
				from = j + 1;
				break;
			}
}

/* the common sequence of the greatest weight */
static int in_order(struct match *m)
{
	size_t a = 0, b = 0, n = m->a.count, k = m->b.count;
	uint16_t *sum, *row;

	for (; n && k && weight(m, a, b) >= WEIGHT_PLACE; n--, k--)
		join(m, a++, b++);
	for (; n && k && weight(m, a + n - 1, b + k - 1) >= WEIGHT_PLACE; n--, k--)
		join(m, a + n - 1, b + k - 1);
	if (n && k > WORK_MAX / n) {
		greedy(m, a, n, b, k);
		return 0;
	}
	sum = calloc((n + 1) * (k + 1), sizeof(*sum));
	if (!sum)
		return -ENOMEM;
	for (size_t i = n; i--;) {
		row = sum + i * (k + 1);
		for (size_t j = k; j--;) {
			unsigned int w = weight(m, a + i, b + j);

			row[j] = row[j + 1] > row[k + 1 + j] ? row[j + 1] : row[k + 1 + j];
			if (w && w + row[k + 1 + j + 1] > row[j])
				row[j] = (uint16_t)(w + row[k + 1 + j + 1]);
		}
	}
	for (size_t i = 0, j = 0; i < n && j < k;) {
		unsigned int w = weight(m, a + i, b + j);

		row = sum + i * (k + 1);
		if (w && row[j] == w + row[k + 1 + j + 1])
			join(m, a + i++, b + j++);
		else if (row[j + 1] > row[k + 1 + j])
			j++;
		else
			i++;
	}
	free(sum);
	return 0;
}

size_t match_parent(const struct side *s, size_t i, unsigned int *port)
{
	size_t p = i, steps = 0;

	do {
		*port = s->slaves[p]->port;
		p = s->parent[p];
	} while (p != NO_SLAVE && s->peer[p] == NO_SLAVE && steps++ < s->count);
	return p;
}

/* another device at the port of one that is missing; without ports in the next place */
static void by_place(struct match *m)
{
	for (size_t i = 0; i < m->a.count; i++) {
		size_t k = i ? m->a.peer[i - 1] + 1 : 0, pa, pb;
		unsigned int port_a, port_b;

		if (m->a.peer[i] != NO_SLAVE || (i && m->a.peer[i - 1] == NO_SLAVE) ||
		    k >= m->b.count || m->b.peer[k] != NO_SLAVE)
			continue;
		pa = match_parent(&m->a, i, &port_a);
		pb = match_parent(&m->b, k, &port_b);
		if (port_a == ECB_NONE8 ||
		    (pa != NO_SLAVE && m->a.peer[pa] == pb && port_a == port_b))
			join(m, i, k);
	}
}

int match_slaves(struct match *m, const struct ecb_master *a, const struct ecb_master *b,
		 bool by_name)
{
	size_t *rest, n, k, work = 0;
	int ret;

	memset(m, 0, sizeof(*m));
	if (side_init(&m->a, a) || side_init(&m->b, b))
		return -ENOMEM;
	rest = malloc((m->a.count + m->b.count + 1) * sizeof(*rest));
	if (!rest)
		return -ENOMEM;
	by_signs(m, by_name);
	ret = in_order(m);
	/* the same device elsewhere */
	n = left(&m->a, rest);
	k = left(&m->b, rest + n);
	for (size_t i = 0; i < n; i++)
		for (size_t j = 0; j < k && work < WORK_MAX; j++, work++)
			if (m->b.peer[rest[n + j]] == NO_SLAVE &&
			    same_identity(m->a.slaves[rest[i]], m->b.slaves[rest[n + j]])) {
				join(m, rest[i], rest[n + j]);
				break;
			}
	by_place(m);
	free(rest);
	return ret;
}
