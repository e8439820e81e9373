/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Ethernet of a simulated slave behind EoE: frames to and from the master in fragments, and a small
 * IP host behind them. All memory is that of struct ec_app_eoe.
 */
#ifndef EC_SIM_EOE_H
#define EC_SIM_EOE_H

#include "app.h"

#define EC_APP_EOE_QUEUE	16	/* frames to the master */
#define EC_APP_EOE_CONNS	4	/* TCP connections */
#define EC_APP_EOE_BUF		2048	/* of each: bytes to send */

#define EC_APP_ETH_HDR		14
#define EC_APP_ETH_IP		0x0800
#define EC_APP_ETH_ARP		0x0806

/**
 * struct ec_app_eoe_frame - a frame to the master
 * @due: not before this time
 * @len: bytes of it
 * @at: bytes sent
 * @fragments: fragments sent
 * @number: of the frame
 * @begun: its first fragment has been sent
 * @fault: enum ec_sim_eoe_fault, for this frame
 * @data: the frame
 */
struct ec_app_eoe_frame {
	u64 due;
	u16 len;
	u16 at;
	u8 fragments;
	u8 number;
	bool begun;
	u8 fault;
	u8 data[EC_EOE_FRAME_MAX];
};

/**
 * struct ec_app_eoe_port - frames that leave a slave by its Ethernet port
 * @first: place of the oldest one
 * @n: how many
 * @len: bytes of each
 * @data: the frames
 */
struct ec_app_eoe_port {
	u8 first;
	u8 n;
	u16 len[EC_APP_EOE_QUEUE];
	u8 data[EC_APP_EOE_QUEUE][EC_EOE_FRAME_MAX];
};

enum ec_app_tcp_state { EC_APP_TCP_FREE, EC_APP_TCP_SYN, EC_APP_TCP_OPEN };

/**
 * struct ec_app_tcp - a TCP connection
 * @state: enum ec_app_tcp_state
 * @mac: of the peer
 * @ip: of the peer
 * @peer_port: of the peer
 * @port: of the slave
 * @una: sequence number of the first byte at @buf
 * @rcv: sequence number that the peer sends next
 * @mss: bytes of a segment to the peer
 * @window: bytes that the peer takes behind @una
 * @told: bytes that the peer was told to be free
 * @len: bytes at @buf
 * @sent: how many of these were sent
 * @fin: the connection ends behind them
 * @fin_sent: and the peer was told
 * @fin_acked: and knows it
 * @peer_fin: the peer has ended its direction
 * @answered: HTTP: the answer is at @buf
 * @tries: transmissions without acknowledge
 * @lines: HTTP: line ends one after the other
 * @line_len: bytes at @line
 * @line: HTTP: the first bytes of the request
 * @retry_ns: when the rest is sent again, EC_ESC_NEVER: all is acknowledged
 * @used_ns: when the peer was heard
 * @buf: bytes to send
 */
struct ec_app_tcp {
	u8 state;
	u8 mac[6];
	u8 ip[4];
	u16 peer_port;
	u16 port;
	u32 una;
	u32 rcv;
	u16 mss;
	u16 window;
	u16 told;
	u16 len;
	u16 sent;
	bool fin;
	bool fin_sent;
	bool fin_acked;
	bool peer_fin;
	bool answered;
	u8 tries;
	u8 lines;
	u8 line_len;
	char line[6];
	u64 retry_ns;
	u64 used_ns;
	u8 *buf;
};

/**
 * struct ec_app_eoe - Ethernet of a slave
 * @mac: its own address, unless the master sets one
 * @peer: source of the last frame from the master
 * @heard: there was one
 * @turn: a fragment was the last message sent
 * @in: frame on its way from the master
 * @order: frames to the master, by their place in @frames
 * @n: how many
 * @used: places in use, bits
 * @alternate: of two frames on their way at once: send of the second one
 * @number: of the next frame
 * @begun: frames begun since the fault, for those that it does not concern
 * @asked: the same of frames from the master
 * @isn: begin of the next connection
 * @received: whole frames from the master
 * @bad: fragments that were refused
 * @sent: whole frames to the master
 * @dropped: frames for which there was no place
 * @in_data: bytes of @in
 * @frames: frames to the master
 * @conns: TCP connections
 * @bufs: bytes that they send
 * @port: frames that leave by the Ethernet port, NULL: it has none
 */
struct ec_app_eoe {
	u8 mac[6];
	u8 peer[6];
	bool heard;
	bool turn;
	struct ec_eoe_part in;
	u8 order[EC_APP_EOE_QUEUE];
	u8 n;
	u16 used;
	bool alternate;
	u8 number;
	u32 begun;
	u32 asked;
	u32 isn;
	u32 received;
	u32 bad;
	u32 sent;
	u32 dropped;
	u8 in_data[EC_EOE_FRAME_MAX];
	struct ec_app_eoe_frame frames[EC_APP_EOE_QUEUE];
	struct ec_app_tcp conns[EC_APP_EOE_CONNS];
	u8 bufs[EC_APP_EOE_CONNS][EC_APP_EOE_BUF];
	struct ec_app_eoe_port *port;
};

static inline u16 ec_app_get_be16(const u8 *p)
{
	return (u16)(p[0] << 8 | p[1]);
}

static inline u32 ec_app_get_be32(const u8 *p)
{
	return (u32)ec_app_get_be16(p) << 16 | ec_app_get_be16(p + 2);
}

static inline void ec_app_put_be16(u8 *p, u16 v)
{
	p[0] = (u8)(v >> 8);
	p[1] = (u8)(v & 0xff);
}

static inline void ec_app_put_be32(u8 *p, u32 v)
{
	ec_app_put_be16(p, (u16)(v >> 16));
	ec_app_put_be16(p + 2, (u16)v);
}

/* eoe_queue.c */
struct ec_app_eoe_frame *ec_app_eoe_place(struct ec_app *app);
void ec_app_eoe_send(struct ec_app *app, struct ec_app_eoe_frame *f, u16 len, u64 due);
const u8 *ec_app_eoe_mac(const struct ec_app *app);

/* eoe_port.c */
void ec_app_eoe_out(struct ec_app *app, const u8 *frame, u16 len);

/* eoe_host.c */
u8 *ec_app_eoe_eth(struct ec_app *app, struct ec_app_eoe_frame *f, const u8 *to, u16 type);
u16 ec_app_ip_sum(const u8 *p, size_t len, u32 sum);
void ec_app_eoe_ip(struct ec_app *app, u8 *ip, const u8 *to, u8 proto, u16 len);
void ec_app_eoe_announce(struct ec_app *app, u16 len, u64 due);
void ec_app_eoe_host(struct ec_app *app, const u8 *frame, u16 len, u64 now);

/* eoe_tcp.c */
void ec_app_tcp(struct ec_app *app, const u8 *frame, const u8 *ip, u16 len, u64 now);
void ec_app_tcp_poll(struct ec_app *app, u64 now);
u64 ec_app_tcp_due(const struct ec_app_eoe *e);
void ec_app_http(struct ec_app *app, struct ec_app_tcp *c, const u8 *data, u16 len);

/* eoe_fault.c */
void ec_app_eoe_fill(struct ec_app *app, u64 now);
bool ec_app_eoe_refuses(struct ec_app *app, const struct ec_eoe_fragment *part);
bool ec_app_eoe_spoil(struct ec_app *app, struct ec_app_eoe_frame *f,
		      struct ec_eoe_fragment *part);
bool ec_app_eoe_endless(struct ec_app *app, struct ec_app_eoe_frame *f,
			struct ec_eoe_fragment *part);

#endif
