// SPDX-License-Identifier: GPL-2.0-only
/*
 * A small TCP for a simulated slave: port 7 echoes, port 80 answers HTTP. Segments that come out of
 * order are sent again by the peer; what is not acknowledged, by the slave.
 */
#include "eoe.h"

#define PORT_ECHO	7
#define PORT_HTTP	80
#define TCP_HDR		20
#define HEADERS		(EC_APP_ETH_HDR + 20 + TCP_HDR)
#define MSS		1460
#define MSS_DEFAULT	536
#define RETRY_NS	200000000ull	/* the first time, then twice as much */
#define TRIES		8
#define IDLE_NS		10000000000ull	/* then another peer may have the connection */

#define FIN	0x01
#define SYN	0x02
#define RST	0x04
#define ACK	0x10

/* a segment, decoded */
struct seg {
	const u8 *frame;
	const u8 *ip;
	u16 from;
	u16 to;
	u32 seq;
	u32 ack;
	u8 flags;
	u16 window;
	const u8 *options;
	u16 n_options;
	const u8 *data;
	u16 len;
};

static bool decode(struct seg *s, const u8 *frame, const u8 *ip, u16 len)
{
	const u8 *p = ip + (ip[0] & 0x0f) * 4;
	u8 pseudo[12] = { 0 };
	u32 sum = 0;
	u16 hdr;

	if (len < TCP_HDR)
		return false;
	hdr = (u16)((p[12] >> 4) * 4);
	memcpy(pseudo, ip + 12, 8);
	pseudo[9] = 6;
	ec_app_put_be16(pseudo + 10, len);
	sum = (u16)~ec_app_ip_sum(pseudo, sizeof(pseudo), 0);
	if (hdr < TCP_HDR || hdr > len || ec_app_ip_sum(p, len, sum))
		return false;
	*s = (struct seg){
		.frame = frame, .ip = ip, .from = ec_app_get_be16(p), .to = ec_app_get_be16(p + 2),
		.seq = ec_app_get_be32(p + 4), .ack = ec_app_get_be32(p + 8), .flags = p[13],
		.window = ec_app_get_be16(p + 14), .options = p + TCP_HDR,
		.n_options = (u16)(hdr - TCP_HDR), .data = p + hdr, .len = (u16)(len - hdr),
	};
	return true;
}

/* Segment size that the peer takes. */
static u16 mss_of(const struct seg *s)
{
	const u8 *p = s->options, *end = p + s->n_options;

	while (p < end && *p) {
		if (*p == 1) {
			p++;
			continue;
		}
		if (end - p < 2 || p[1] < 2 || p[1] > end - p)
			break;
		if (*p == 2 && p[1] == 4)
			return (u16)min(max(ec_app_get_be16(p + 2), 64), MSS);
		p += p[1];
	}
	return MSS_DEFAULT;
}

/* One segment; false: there is no place for it. */
static bool put(struct ec_app *app, struct ec_app_tcp *c, u8 flags, u32 seq, const u8 *data,
		u16 len, u64 due)
{
	struct ec_app_eoe_frame *f = ec_app_eoe_place(app);
	u16 hdr = TCP_HDR + (flags & SYN ? 4 : 0);
	u8 *ip, *p, pseudo[12] = { 0 };

	if (!f)
		return false;
	c->told = (u16)(EC_APP_EOE_BUF - (c->port == PORT_ECHO ? c->len : 0));
	ip = ec_app_eoe_eth(app, f, c->mac, EC_APP_ETH_IP);
	ec_app_eoe_ip(app, ip, c->ip, 6, (u16)(hdr + len));
	p = ip + 20;
	memset(p, 0, hdr);
	ec_app_put_be16(p, c->port);
	ec_app_put_be16(p + 2, c->peer_port);
	ec_app_put_be32(p + 4, seq);
	if (flags & ACK)
		ec_app_put_be32(p + 8, c->rcv);
	p[12] = (u8)(hdr / 4 << 4);
	p[13] = flags;
	ec_app_put_be16(p + 14, c->told);
	if (flags & SYN) {
		p[20] = 2;
		p[21] = 4;
		ec_app_put_be16(p + 22, MSS);
	}
	if (len)
		memcpy(p + hdr, data, len);
	memcpy(pseudo, ip + 12, 8);
	pseudo[9] = 6;
	ec_app_put_be16(pseudo + 10, (u16)(hdr + len));
	ec_app_put_be16(p + 16, ec_app_ip_sum(p, (size_t)hdr + len,
					      (u16)~ec_app_ip_sum(pseudo, sizeof(pseudo), 0)));
	ec_app_eoe_send(app, f, (u16)(EC_APP_ETH_HDR + 20 + hdr + len), due);
	return true;
}

/* The answer to a segment of no connection. */
static void reset(struct ec_app *app, const struct seg *s, u64 due)
{
	struct ec_app_tcp c = {
		.port = s->to, .peer_port = s->from,
		.rcv = s->seq + s->len + !!(s->flags & SYN) + !!(s->flags & FIN),
	};

	if (s->flags & RST)
		return;
	memcpy(c.mac, s->frame + 6, 6);
	memcpy(c.ip, s->ip + 12, 4);
	if (s->flags & ACK)
		put(app, &c, RST, s->ack, NULL, 0, due);
	else
		put(app, &c, RST | ACK, 0, NULL, 0, due);
}

static bool outstanding(const struct ec_app_tcp *c)
{
	return c->state == EC_APP_TCP_SYN || c->len || (c->fin && !c->fin_acked);
}

static void arm(struct ec_app_tcp *c, u64 now)
{
	c->retry_ns = outstanding(c) ? now + (RETRY_NS << min_t(u8, c->tries, 5)) : EC_ESC_NEVER;
}

/* All that the peer takes, and the end; true: a segment has gone. */
static bool output(struct ec_app *app, struct ec_app_tcp *c, u64 due)
{
	bool gone = false;

	while (c->sent < c->len && c->sent < c->window) {
		u16 n = min(min((u16)(c->len - c->sent), (u16)(c->window - c->sent)), c->mss);

		if (!put(app, c, ACK, c->una + c->sent, c->buf + c->sent, n, due))
			return gone;
		c->sent = (u16)(c->sent + n);
		gone = true;
	}
	if (c->fin && !c->fin_sent && c->sent == c->len &&
	    put(app, c, FIN | ACK, c->una + c->sent, NULL, 0, due)) {
		c->fin_sent = true;
		gone = true;
	}
	return gone;
}

static struct ec_app_tcp *find(struct ec_app_eoe *e, const struct seg *s)
{
	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++) {
		struct ec_app_tcp *c = &e->conns[i];

		if (c->state != EC_APP_TCP_FREE && c->port == s->to && c->peer_port == s->from &&
		    !memcmp(c->ip, s->ip + 12, 4))
			return c;
	}
	return NULL;
}

/* A place for a connection: a free one, else the one that was idle for the longest time. */
static struct ec_app_tcp *place(struct ec_app_eoe *e, u64 now)
{
	struct ec_app_tcp *old = &e->conns[0];

	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++) {
		if (e->conns[i].state == EC_APP_TCP_FREE)
			return &e->conns[i];
		if (e->conns[i].used_ns < old->used_ns)
			old = &e->conns[i];
	}
	return now - old->used_ns >= IDLE_NS ? old : NULL;
}

static void open(struct ec_app *app, const struct seg *s, u64 now, u64 due)
{
	struct ec_app_eoe *e = app->eoe;
	struct ec_app_tcp *c = place(e, now);

	if ((s->flags & (SYN | ACK | RST)) != SYN || !c ||
	    (s->to != PORT_ECHO && s->to != PORT_HTTP)) {
		reset(app, s, due);
		return;
	}
	memset(c, 0, sizeof(*c));
	e->isn += 64000;
	c->state = EC_APP_TCP_SYN;
	c->buf = e->bufs[c - e->conns];
	memcpy(c->mac, s->frame + 6, 6);
	memcpy(c->ip, s->ip + 12, 4);
	c->port = s->to;
	c->peer_port = s->from;
	c->una = e->isn + 1;
	c->rcv = s->seq + 1;
	c->mss = mss_of(s);
	c->window = s->window;
	c->used_ns = now;
	put(app, c, SYN | ACK, e->isn, NULL, 0, due);
	arm(c, now);
}

/* The peer has so many bytes more, and perhaps the end. */
static void acknowledged(struct ec_app_tcp *c, const struct seg *s)
{
	u32 n = s->ack - c->una;

	if (n > (u32)c->len + (c->fin && !c->fin_acked))
		return;		/* old, or of what was never sent */
	c->window = s->window;
	if (!n)
		return;
	c->tries = 0;
	if (n > c->len) {
		c->fin_acked = true;
		n = c->len;
		c->una++;
	}
	memmove(c->buf, c->buf + n, c->len - n);
	c->una += n;
	c->len = (u16)(c->len - n);
	c->sent = (u16)(c->sent > n ? c->sent - n : 0);
}

/* Data of the peer, in order; those that do not fit come again. */
static void take(struct ec_app *app, struct ec_app_tcp *c, const struct seg *s)
{
	u16 n = s->len;

	if (s->seq != c->rcv || c->peer_fin)
		return;
	if (c->port == PORT_ECHO) {
		n = min(n, (u16)(EC_APP_EOE_BUF - c->len));
		memcpy(c->buf + c->len, s->data, n);
		c->len = (u16)(c->len + n);
	} else {
		ec_app_http(app, c, s->data, n);
	}
	c->rcv += n;
	if (n == s->len && s->flags & FIN) {
		c->rcv++;
		c->peer_fin = true;
		c->fin = true;
	}
}

/**
 * ec_app_tcp() - a segment has come
 * @app: slave
 * @frame: Ethernet header
 * @ip: IP header
 * @len: bytes behind it
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_tcp(struct ec_app *app, const u8 *frame, const u8 *ip, u16 len, u64 now)
{
	u64 due = now + app->response_ns;
	struct ec_app_tcp *c;
	struct seg s;
	bool ask;

	if (!decode(&s, frame, ip, len))
		return;
	c = find(app->eoe, &s);
	if (!c) {
		open(app, &s, now, due);
		return;
	}
	c->used_ns = now;
	if (s.flags & RST) {
		if (s.seq == c->rcv)
			c->state = EC_APP_TCP_FREE;
		return;
	}
	if (s.flags & SYN) {	/* again, or an old one: what the peer should send */
		put(app, c, c->state == EC_APP_TCP_SYN ? SYN | ACK : ACK,
		    c->state == EC_APP_TCP_SYN ? c->una - 1 : c->una + c->sent, NULL, 0, due);
		return;
	}
	if (!(s.flags & ACK))
		return;
	if (c->state == EC_APP_TCP_SYN) {
		if (s.ack != c->una)
			return;
		c->state = EC_APP_TCP_OPEN;
		c->tries = 0;
	}
	/* with another number than expected it may be a probe of the window */
	ask = s.len || s.flags & FIN || s.seq != c->rcv;
	acknowledged(c, &s);
	take(app, c, &s);
	if (!output(app, c, due) &&
	    (ask || (c->told < c->mss && EC_APP_EOE_BUF - c->len >= c->mss)))
		put(app, c, ACK, c->una + c->sent + (c->fin_sent && !c->fin_acked), NULL, 0, due);
	arm(c, now);
	if (c->fin_acked && c->peer_fin)
		c->state = EC_APP_TCP_FREE;
}

/* The peer does not acknowledge: from the begin, or a byte of what it does not take. */
static void again(struct ec_app *app, struct ec_app_tcp *c, u64 now)
{
	if (++c->tries > TRIES) {
		c->state = EC_APP_TCP_FREE;
		return;
	}
	c->sent = 0;
	c->fin_sent = c->fin_acked;
	if (c->state == EC_APP_TCP_SYN)
		put(app, c, SYN | ACK, c->una - 1, NULL, 0, now);
	else if (!output(app, c, now) && c->len)
		put(app, c, ACK, c->una, c->buf, 1, now);
	arm(c, now);
}

/**
 * ec_app_tcp_poll() - time has passed
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_tcp_poll(struct ec_app *app, u64 now)
{
	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++) {
		struct ec_app_tcp *c = &app->eoe->conns[i];

		if (c->state != EC_APP_TCP_FREE && c->retry_ns <= now)
			again(app, c, now);
	}
}

/**
 * ec_app_tcp_due() - when something is sent again
 * @e: Ethernet of the slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns, EC_ESC_NEVER: all is acknowledged.
 */
u64 ec_app_tcp_due(const struct ec_app_eoe *e)
{
	u64 at = EC_ESC_NEVER;

	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++)
		if (e->conns[i].state != EC_APP_TCP_FREE)
			at = min(at, e->conns[i].retry_ns);
	return at;
}
