// SPDX-License-Identifier: GPL-2.0-only
#include "ip.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>

#include "../lib/tools/text.h"
#include "out.h"

/* keywords of both versions of the tool of the IgH EtherCAT Master, and their meaning */
static const struct {
	const char *word;
	u32 which;
} words[] = {
	{ "mac_address", ECT_IP_MAC }, { "link", ECT_IP_MAC },
	{ "ip_address", ECT_IP_ADDRESS }, { "addr", ECT_IP_ADDRESS },
	{ "subnet_mask", ECT_IP_MASK }, { "mask", ECT_IP_MASK },
	{ "default_gateway", ECT_IP_GATEWAY }, { "default", ECT_IP_GATEWAY },
	{ "dns_address", ECT_IP_DNS }, { "dns_adress", ECT_IP_DNS }, { "dns", ECT_IP_DNS },
	{ "hostname", ECT_IP_HOSTNAME }, { "name", ECT_IP_HOSTNAME },
};

static int hex(char c)
{
	return isdigit((unsigned char)c) ? c - '0' :
	       isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/* 02:00:00:ec:01:07, 02-00-00-ec-01-07 or 020000ec0107 */
static int parse_mac(u8 mac[6], const char *text)
{
	char sep = text[0] && text[1] ? text[2] : 0;
	const char *p = text;
	u8 v[6];

	if (sep != ':' && sep != '-')
		sep = 0;
	for (int i = 0; i < 6; i++, p += 2) {
		if (i && sep && *p++ != sep)
			goto bad;
		if (hex(p[0]) < 0 || hex(p[1]) < 0)
			goto bad;
		v[i] = (u8)(hex(p[0]) << 4 | hex(p[1]));
	}
	if (*p)
		goto bad;
	if (v[0] & 1)
		return usage_error("invalid MAC address '%s': broadcast or multicast, bit 0 of the first byte must be 0",
				   text);
	if (!(v[0] | v[1] | v[2] | v[3] | v[4] | v[5]))
		return usage_error("invalid MAC address '%s': all bytes are 0", text);
	memcpy(mac, v, 6);
	return 0;
bad:
	return usage_error("invalid MAC address '%s': expected 6 bytes, as 02:00:00:ec:01:07",
			   text);
}

static int parse_host(u8 addr[4], const char *text)
{
	const struct addrinfo hints = { .ai_family = AF_INET, .ai_socktype = SOCK_STREAM };
	struct sockaddr_in in;
	struct addrinfo *ai;
	int ret;

	if (inet_pton(AF_INET, text, addr) == 1)
		return 0;
	if (!*text || !text[strspn(text, "0123456789.")])
		return usage_error("invalid address '%s': expected IPv4, as 192.168.0.1, or a host name",
				   text);
	ret = getaddrinfo(text, NULL, &hints, &ai);
	if (ret)
		return fail("cannot find the address of '%s': %s", text, gai_strerror(ret));
	memcpy(&in, ai->ai_addr, sizeof(in));
	memcpy(addr, &in.sin_addr, 4);
	freeaddrinfo(ai);
	return 0;
}

/* ones, then zeros */
static int parse_mask(u8 mask[4], const char *text)
{
	u32 zeros;

	if (parse_host(mask, text))
		return 1;
	memcpy(&zeros, mask, 4);
	zeros = ~ntohl(zeros);
	if (zeros & (zeros + 1))
		return usage_error("invalid subnet mask '%s': expected ones, then zeros, as 255.255.255.0",
				   text);
	return 0;
}

/* ADDRESS or ADDRESS/PREFIX, which also gives the mask */
static int parse_address(struct ect_ip *p, const char *text)
{
	const char *slash = strchr(text, '/');
	char host[256], *end;
	unsigned long bits;
	u32 mask;

	snprintf(host, sizeof(host), "%.*s", slash ? (int)(slash - text) : 255, text);
	if (parse_host(p->ip, host))
		return 1;
	if (!slash)
		return 0;
	bits = strtoul(slash + 1, &end, 10);
	if (!isdigit((unsigned char)slash[1]) || *end || bits > 32)
		return usage_error("invalid prefix '%s': expected 0 to 32", slash + 1);
	if (p->which & ECT_IP_MASK)
		return usage_error("'%s' and subnet_mask exclude each other", text);
	mask = bits ? htonl(~0u << (32 - bits)) : 0;
	memcpy(p->mask, &mask, 4);
	p->which |= ECT_IP_MASK;
	return 0;
}

static int parse_name(char *name, const char *text)
{
	if (!*text || strlen(text) >= ECT_IP_NAME)
		return usage_error("invalid host name '%s': expected 1 to %d bytes", text,
				   ECT_IP_NAME - 1);
	memset(name, 0, ECT_IP_NAME);
	memcpy(name, text, strlen(text));
	return 0;
}

int ip_parse(struct ect_ip *p, const char *key, const char *value)
{
	u32 which = 0;

	for (size_t i = 0; i < ARRAY_SIZE(words); i++)
		if (!strcasecmp(words[i].word, key))
			which = words[i].which;
	if (p->which & which)
		return usage_error("'%s': this parameter is given already", key);
	p->which |= which;
	switch (which) {
	case ECT_IP_MAC:
		return parse_mac(p->mac, value);
	case ECT_IP_ADDRESS:
		return parse_address(p, value);
	case ECT_IP_MASK:
		return parse_mask(p->mask, value);
	case ECT_IP_GATEWAY:
		return parse_host(p->gateway, value);
	case ECT_IP_DNS:
		return parse_host(p->dns, value);
	case ECT_IP_HOSTNAME:
		return parse_name(p->name, value);
	default:
		return usage_error("unknown keyword '%s': expected mac_address, ip_address, subnet_mask, default_gateway, dns_address or hostname",
				   key);
	}
}

static void line(bool set, bool all, const char *key, const char *value, const char *indent,
		 const char *label)
{
	if (set)
		out_str(key, value, "%s%s: %s\n", indent, label, value);
	else if (all)
		out_null(key, NULL);
}

static const char *dotted(const u8 a[4], char buf[16])
{
	return inet_ntop(AF_INET, a, buf, 16);
}

void ip_out(struct ect_ip *p, const char *indent, bool all)
{
	char mac[18], buf[16];
	const u8 *m = p->mac;

	snprintf(mac, sizeof(mac), "%02x:%02x:%02x:%02x:%02x:%02x", m[0], m[1], m[2], m[3], m[4],
		 m[5]);
	string_clean(p->name, sizeof(p->name));
	line(p->which & ECT_IP_MAC, all, "mac_address", mac, indent, "MAC address");
	line(p->which & ECT_IP_ADDRESS, all, "ip_address", dotted(p->ip, buf), indent, "IP address");
	line(p->which & ECT_IP_MASK, all, "subnet_mask", dotted(p->mask, buf), indent,
	     "Subnet mask");
	line(p->which & ECT_IP_GATEWAY, all, "default_gateway", dotted(p->gateway, buf), indent,
	     "Default gateway");
	line(p->which & ECT_IP_DNS, all, "dns_address", dotted(p->dns, buf), indent, "DNS address");
	line(p->which & ECT_IP_HOSTNAME, all, "hostname", p->name, indent, "Hostname");
}
