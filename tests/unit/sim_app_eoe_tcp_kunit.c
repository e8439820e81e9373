// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: TCP behind EoE, an echo and a page. */
#include "sim_app_eoe_host.h"

#define WEB	"slave web EL6614 eoe=host\n"
#define ECHO	7
#define HTTP	80

#define FIN	0x01
#define SYN	0x02
#define RST	0x04
#define ACK	0x10

/* the station's end of a connection */
struct conn {
	u16 port;
	u16 to;
	u32 seq;
	u32 ack;
	u16 window;
};

/* a segment of the slave */
struct seg {
	u16 from;
	u16 to;
	u32 seq;
	u32 ack;
	u8 flags;
	u16 window;
	const u8 *data;
	int len;
};

static bool put(struct host *h, struct conn *c, u8 flags, const void *data, u16 len)
{
	u8 p[600] = { 0 }, *tcp = p + 34, pseudo[12] = { 0 };

	ec_app_put_be16(tcp, c->port);
	ec_app_put_be16(tcp + 2, c->to);
	ec_app_put_be32(tcp + 4, c->seq);
	ec_app_put_be32(tcp + 8, c->ack);
	tcp[12] = 0x50;
	tcp[13] = flags;
	ec_app_put_be16(tcp + 14, c->window);
	if (len)
		memcpy(tcp + 20, data, len);
	memcpy(pseudo, host_ip, 4);
	memcpy(pseudo + 4, slave_ip, 4);
	pseudo[9] = 6;
	ec_app_put_be16(pseudo + 10, (u16)(20 + len));
	ec_app_put_be16(tcp + 16, ec_app_ip_sum(tcp, 20u + len,
						(u16)~ec_app_ip_sum(pseudo, 12, 0)));
	c->seq += len + (flags & SYN ? 1 : 0) + (flags & FIN ? 1 : 0);
	return host_send(h, p, host_ip_frame(h, p, 6, (u16)(20 + len)));
}

/* false: no segment in this time, or a wrong one */
static bool get(struct host *h, struct seg *s, u32 ms)
{
	const u8 *p;
	int len = host_recv(h, &p, ms), total;
	u8 pseudo[12] = { 0 };

	if (len < 54 || p[23] != 6)
		return false;
	total = ec_app_get_be16(p + 16);
	memcpy(pseudo, p + 26, 8);
	pseudo[9] = 6;
	ec_app_put_be16(pseudo + 10, (u16)(total - 20));
	*s = (struct seg){
		.from = ec_app_get_be16(p + 34), .to = ec_app_get_be16(p + 36),
		.seq = ec_app_get_be32(p + 38), .ack = ec_app_get_be32(p + 42), .flags = p[47],
		.window = ec_app_get_be16(p + 48), .data = p + 34 + (p[46] >> 4) * 4,
		.len = total - 20 - (p[46] >> 4) * 4,
	};
	return total + 14 <= len && !ec_app_ip_sum(p + 14, 20, 0) &&
	       !ec_app_ip_sum(p + 34, (size_t)total - 20, (u16)~ec_app_ip_sum(pseudo, 12, 0));
}

static struct conn connection(struct kunit *test, struct host *h, u16 port, u16 to)
{
	struct conn c = { .port = port, .to = to, .seq = 0xfffffff0, .window = 8000 };
	struct seg s;

	KUNIT_ASSERT_TRUE(test, put(h, &c, SYN, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.flags, SYN | ACK);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq);
	KUNIT_EXPECT_EQ(test, s.to, port);
	c.ack = s.seq + 1;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, NULL, 0));
	KUNIT_EXPECT_FALSE(test, get(h, &s, 2));
	return c;
}

static void sim_app_eoe_tcp_echoes(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	struct conn c = connection(test, h, 5000, ECHO);
	struct seg s;
	u8 data[500];

	for (u32 round = 0; round < 20; round++) {	/* past the wrap of the numbers */
		memset(data, (int)round, sizeof(data));
		KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, data, sizeof(data)));
		KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
		KUNIT_ASSERT_EQ(test, s.len, 500);
		KUNIT_EXPECT_EQ(test, s.seq, c.ack);
		KUNIT_EXPECT_EQ(test, s.ack, c.seq);
		KUNIT_EXPECT_MEMEQ(test, s.data, data, sizeof(data));
		c.ack += 500;
	}
	KUNIT_ASSERT_TRUE(test, put(h, &c, FIN | ACK, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.flags, FIN | ACK);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq);
	KUNIT_EXPECT_EQ(test, s.seq, c.ack);
	c.ack++;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, NULL, 0));
	KUNIT_EXPECT_EQ(test, h->app->eoe->conns[0].state, EC_APP_TCP_FREE);
	KUNIT_EXPECT_FALSE(test, get(h, &s, 500));	/* nothing is sent again */
}

/* what is not acknowledged comes again, then the connection ends */
static void sim_app_eoe_tcp_repeats(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	struct conn c = connection(test, h, 5000, ECHO);
	struct seg s;
	u32 n = 0;
	u64 from;

	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, "again", 5));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	from = h->b->now;
	KUNIT_ASSERT_TRUE(test, get(h, &s, 500));
	KUNIT_EXPECT_GT(test, h->b->now - from, 150000000ull);
	KUNIT_EXPECT_EQ(test, s.seq, c.ack);
	KUNIT_EXPECT_EQ(test, s.len, 5);
	while (n < 100 && get(h, &s, 10000))
		n++;
	KUNIT_EXPECT_EQ(test, n, 7u);
	KUNIT_EXPECT_EQ(test, h->app->eoe->conns[0].state, EC_APP_TCP_FREE);
}

/* the peer's segment comes twice, or with a gap */
static void sim_app_eoe_tcp_takes_data_once(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	struct conn c = connection(test, h, 5000, ECHO);
	struct seg s;

	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, "one", 3));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	c.ack += 3;
	c.seq -= 3;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, "one", 3));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.len, 0);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq);
	c.seq += 10;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, "two", 3));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.len, 0);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq - 13);
}

/* it does not send more than the peer's window, nor take more than its own */
static void sim_app_eoe_tcp_keeps_windows(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	struct conn c = connection(test, h, 5000, ECHO);
	u8 data[500] = { 0 };
	struct seg s;
	u32 n;

	c.window = 0;
	for (n = 0; n < 6; n++) {
		KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, data, sizeof(data)));
		KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
		KUNIT_EXPECT_EQ(test, s.len, 0);
	}
	KUNIT_EXPECT_EQ(test, s.window, 0);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq - 6 * 500 + EC_APP_EOE_BUF);
	KUNIT_ASSERT_TRUE(test, get(h, &s, 500));	/* does the window open? */
	KUNIT_EXPECT_EQ(test, s.len, 1);
	c.window = 300;
	c.seq = s.ack;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.len, 300);
	KUNIT_EXPECT_EQ(test, s.seq, c.ack);
	/* a probe of a station that waits for the window: one byte before what comes next */
	c.seq--;
	c.window = 0;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.len, 0);
	KUNIT_EXPECT_EQ(test, s.ack, c.seq + 1);
}

static void sim_app_eoe_tcp_refuses_with_reset(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	struct conn c = { .port = 6000, .to = 22, .seq = 77, .window = 100 };
	struct seg s;

	KUNIT_ASSERT_TRUE(test, put(h, &c, SYN, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.flags, RST | ACK);
	KUNIT_EXPECT_EQ(test, s.ack, 78u);
	c.to = ECHO;
	c.ack = 1234;
	KUNIT_ASSERT_TRUE(test, put(h, &c, ACK, "x", 1));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.flags, RST);
	KUNIT_EXPECT_EQ(test, s.seq, 1234u);
	for (u16 i = 0; i < EC_APP_EOE_CONNS; i++)
		connection(test, h, (u16)(7000 + i), ECHO);
	KUNIT_ASSERT_TRUE(test, put(h, &c, SYN, NULL, 0));
	KUNIT_ASSERT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_EQ(test, s.flags, RST | ACK);
	h->b->now += 11000000000ull;		/* idle ones give way */
	connection(test, h, 6001, ECHO);
}

/* all that the slave sends until it closes; bytes at @text */
static int fetch(struct kunit *test, struct host *h, u16 port, const char *request, char *text,
		 int cap)
{
	struct conn c = connection(test, h, port, HTTP);
	struct seg s;
	int n = 0;

	/* in two parts */
	KUNIT_EXPECT_TRUE(test, put(h, &c, ACK, request, 3));
	KUNIT_EXPECT_TRUE(test, get(h, &s, 5));
	KUNIT_EXPECT_TRUE(test, put(h, &c, ACK, request + 3, (u16)(strlen(request) - 3)));
	for (int i = 0; i < 100 && get(h, &s, 5); i++) {
		KUNIT_EXPECT_EQ(test, s.seq, c.ack);
		KUNIT_ASSERT_LT(test, n + s.len, cap);
		memcpy(text + n, s.data, (size_t)s.len);
		n += s.len;
		c.ack += (u32)s.len;
		if (!(s.flags & FIN))
			continue;
		c.ack++;
		KUNIT_EXPECT_TRUE(test, put(h, &c, FIN | ACK, NULL, 0));
		KUNIT_EXPECT_TRUE(test, get(h, &s, 5));
		KUNIT_EXPECT_EQ(test, s.ack, c.seq);
		break;
	}
	text[n] = '\0';
	KUNIT_EXPECT_EQ(test, h->app->eoe->conns[0].state, EC_APP_TCP_FREE);
	return n;
}

static void sim_app_eoe_tcp_serves_page(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	char text[1200];

	fetch(test, h, 5000, "GET / HTTP/1.1\r\nHost: 192.168.0.17\r\n\r\n", text, sizeof(text));
	KUNIT_EXPECT_EQ(test, strncmp(text, "HTTP/1.0 200 OK\r\n", 17), 0);
	KUNIT_EXPECT_NOT_NULL(test, strstr(text, "<h1>web</h1>"));
	KUNIT_EXPECT_NOT_NULL(test, strstr(text, "(EL6614), state PREOP."));
	KUNIT_EXPECT_NOT_NULL(test, strstr(text, "</html>\n"));
	fetch(test, h, 5001, "GET /x HTTP/1.0\r\n\r\n", text, sizeof(text));
	KUNIT_EXPECT_EQ(test, strncmp(text, "HTTP/1.0 404 ", 13), 0);
	fetch(test, h, 5002, "POST / HTTP/1.0\r\n\r\n", text, sizeof(text));
	KUNIT_EXPECT_EQ(test, strncmp(text, "HTTP/1.0 501 ", 13), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_eoe_tcp_echoes),
	KUNIT_CASE(sim_app_eoe_tcp_repeats),
	KUNIT_CASE(sim_app_eoe_tcp_takes_data_once),
	KUNIT_CASE(sim_app_eoe_tcp_keeps_windows),
	KUNIT_CASE(sim_app_eoe_tcp_refuses_with_reset),
	KUNIT_CASE(sim_app_eoe_tcp_serves_page),
	{ }
};

static struct kunit_suite suite = {
	.name = "sim_app_eoe_tcp",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
