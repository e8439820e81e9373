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
#define UNKNOWN		(NO_SLAVE - 1)

static int side_init(struct side *s, const struct ecb_master *m)
{
	struct table names;
	struct seat *seat;

	s->slaves = m->slaves;
	s->count = m->slave_count;
	s->peer = malloc((s->count + 1) * sizeof(*s->peer));
	s->parent = malloc((s->count + 1) * sizeof(*s->parent));
	s->path = malloc((s->count + 1) * sizeof(*s->path));
	s->up = malloc((s->count + 1) * sizeof(*s->up));
	s->up_port = calloc(s->count + 1, sizeof(*s->up_port));
	if (!s->peer || !s->parent || !s->path || !s->up || !s->up_port ||
	    table_init(&names, s->count + 1))
		return -ENOMEM;
	for (size_t i = 0; i < s->count; i++) {
		s->peer[i] = s->parent[i] = NO_SLAVE;
		s->up[i] = UNKNOWN;
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

static void side_free(struct side *s)
{
	free(s->peer);
	free(s->parent);
	free(s->path);
	free(s->up);
	free(s->up_port);
}

void match_free(struct match *m)
{
	side_free(&m->a);
	side_free(&m->b);
}

static void join(struct match *m, size_t a, size_t b)
{
	m->a.peer[a] = b;
	m->b.peer[b] = a;
}

/* signs of slaves, the surest first */
enum sign { ALIAS, IDENTIFICATION, SERIAL, NAME, SIGNS };

static bool has_sign(const struct ecb_slave *s, enum sign sign)
{
	return sign == ALIAS ? s->alias : sign == IDENTIFICATION ? s->identification :
		sign == SERIAL ? s->serial : true;
}

static int order(uint32_t a, uint32_t b)
{
	return a < b ? -1 : a > b;
}

static int by_sign(const struct ecb_slave *a, const struct ecb_slave *b, enum sign sign)
{
	int ret = 0;

	if (sign == ALIAS)
		return order(a->alias, b->alias);
	if (sign == IDENTIFICATION)
		return order(a->identification, b->identification);
	if (sign == SERIAL)
		ret = order(a->serial, b->serial);
	else
		ret = strcmp(a->name, b->name);
	if (!ret)
		ret = order(a->vendor, b->vendor);
	return ret ? ret : order(a->product, b->product);
}

/* a slave to be found by its sign; @next of the first one of equals: where those left begin */
struct signed_slave {
	const struct ecb_slave *slave;
	size_t at;
	size_t next;
	enum sign sign;
};

static int compare_signs(const void *a, const void *b)
{
	const struct signed_slave *x = a, *y = b;
	int ret = by_sign(x->slave, y->slave, x->sign);

	return ret ? ret : (x->at > y->at) - (x->at < y->at);
}

/* the first one of @n sorted ones that has the sign of @s, otherwise where it would be */
static size_t first_of(const struct signed_slave *v, size_t n, const struct ecb_slave *s,
		       enum sign sign)
{
	size_t low = 0, high = n;

	while (low < high) {
		size_t mid = low + (high - low) / 2;

		if (by_sign(v[mid].slave, s, sign) < 0)
			low = mid + 1;
		else
			high = mid;
	}
	return low;
}

/* the first one without peer that has the sign of @s, or NO_SLAVE */
static size_t next_of(const struct match *m, struct signed_slave *v, size_t n,
		      const struct ecb_slave *s, enum sign sign)
{
	size_t first = first_of(v, n, s, sign), at;

	if (first == n || by_sign(v[first].slave, s, sign))
		return NO_SLAVE;
	at = v[first].next > first ? v[first].next : first;
	while (at < n && !by_sign(v[at].slave, s, sign) && m->b.peer[v[at].at] != NO_SLAVE)
		at++;
	v[first].next = at;
	return at < n && !by_sign(v[at].slave, s, sign) ? v[at].at : NO_SLAVE;
}

static void by_one_sign(struct match *m, struct signed_slave *v, enum sign sign)
{
	size_t n = 0;

	for (size_t i = 0; i < m->b.count; i++)
		if (has_sign(m->b.slaves[i], sign))
			v[n++] = (struct signed_slave){ m->b.slaves[i], i, 0, sign };
	qsort(v, n, sizeof(*v), compare_signs);
	for (size_t i = 0; i < m->a.count; i++) {
		const struct ecb_slave *a = m->a.slaves[i];
		size_t k;

		if (m->a.peer[i] != NO_SLAVE || !has_sign(a, sign))
			continue;
		/* most often it is in its place */
		if (i < m->b.count && m->b.peer[i] == NO_SLAVE &&
		    !by_sign(a, m->b.slaves[i], sign))
			k = i;
		else
			k = next_of(m, v, n, a, sign);
		if (k != NO_SLAVE)
			join(m, i, k);
	}
}

/* slaves with a sign of their own, wherever they are */
static int by_signs(struct match *m, bool by_name)
{
	struct signed_slave *v = calloc(m->b.count + 1, sizeof(*v));

	if (!v)
		return -ENOMEM;
	for (unsigned int sign = ALIAS; sign < (by_name ? SIGNS : NAME); sign++)
		by_one_sign(m, v, sign);
	free(v);
	return 0;
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
	*port = s->up_port[i];
	return s->up[i];
}

/* the nearest slave upstream that has a peer; @work: steps that are left for all */
static size_t upstream(const struct side *s, size_t i, unsigned int *port, size_t *work)
{
	size_t p = i;

	do {
		*port = s->slaves[p]->port;
		p = s->parent[p];
		*work -= *work > 0;
	} while (p != NO_SLAVE && s->peer[p] == NO_SLAVE && *work);
	return p;
}

/* for match_parent(): a slave without peer passes on what is upstream of it */
static void find_parents(struct side *s)
{
	size_t *path = s->path, n, p;

	for (size_t i = 0; i < s->count; i++) {
		for (n = 0, p = i; s->up[p] == UNKNOWN; p = s->parent[p]) {
			path[n++] = p;
			s->up[p] = s->parent[p];
			s->up_port[p] = s->slaves[p]->port;
			if (s->parent[p] == NO_SLAVE || s->peer[s->parent[p]] != NO_SLAVE)
				break;
		}
		while (n--) {
			p = s->parent[path[n]];
			if (p == NO_SLAVE || s->peer[p] != NO_SLAVE)
				continue;
			s->up_port[path[n]] = s->up_port[p];
			s->up[path[n]] = s->up[p];
		}
	}
}

/* another device at the port of one that is missing; without ports in the next place */
static void by_place(struct match *m)
{
	size_t work = WORK_MAX;

	for (size_t i = 0; i < m->a.count && work; i++) {
		size_t k = i ? m->a.peer[i - 1] + 1 : 0, pa, pb;
		unsigned int port_a, port_b;

		if (m->a.peer[i] != NO_SLAVE || (i && m->a.peer[i - 1] == NO_SLAVE) ||
		    k >= m->b.count || m->b.peer[k] != NO_SLAVE)
			continue;
		pa = upstream(&m->a, i, &port_a, &work);
		pb = upstream(&m->b, k, &port_b, &work);
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
	ret = by_signs(m, by_name);
	if (!ret)
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
	find_parents(&m->a);
	find_parents(&m->b);
	free(rest);
	return ret;
}
