// SPDX-License-Identifier: GPL-2.0-only
#include "http.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "dev.h"

#define REQUEST_MAX	8192
#define PATIENCE_S	5.0	/* for the whole request */

static bool is_whole(const char *request)
{
	return strstr(request, "\r\n\r\n") || strstr(request, "\n\n");
}

/* the head of a request; false: the client does not end it */
static bool receive(char *request, size_t size)
{
	double end = now_s() + PATIENCE_S;
	size_t n = 0;

	*request = 0;
	while (!is_whole(request)) {
		struct pollfd p = { .fd = STDIN_FILENO, .events = POLLIN };
		double left = end - now_s();
		ssize_t got;

		if (n + 1 == size || left <= 0 || poll(&p, 1, (int)(left * 1000) + 1) <= 0)
			return false;
		got = read(STDIN_FILENO, request + n, size - 1 - n);
		if (got <= 0)
			return false;
		n += (size_t)got;
		request[n] = 0;
		/* an end in the middle would hide what follows from the search */
		if (strlen(request) != n)
			return false;
	}
	return true;
}

/**
 * http_reply() - reply to a request
 * @status: such as "200 OK"
 * @type: of the content
 * @content: text
 * @head: its head only
 */
void http_reply(const char *status, const char *type, const char *content, bool head)
{
	printf("HTTP/1.1 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\nConnection: close\r\n\r\n%s",
	       status, type, strlen(content), head ? "" : content);
}

static enum http_wish refuse(const char *status, const char *why)
{
	http_reply(status, "text/plain; charset=utf-8", why, false);
	return HTTP_NOTHING;
}

/**
 * http_request() - read the request on stdin
 * @path: of the only page
 *
 * Any other request gets its reply here.
 *
 * Return: what is to be sent.
 */
enum http_wish http_request(const char *path)
{
	char request[REQUEST_MAX], method[8], asked[64], version[16];

	if (!receive(request, sizeof(request)))
		return refuse("400 Bad Request", "no request of HTTP\n");
	if (sscanf(request, "%7[A-Z] %63[^ \r\n] %15[^ \r\n]", method, asked, version) != 3 ||
	    strncmp(version, "HTTP/1.", 7))
		return refuse("400 Bad Request", "no request of HTTP/1\n");
	if (strcmp(method, "GET") && strcmp(method, "HEAD"))
		return refuse("405 Method Not Allowed", "only GET and HEAD\n");
	/* parameters change nothing */
	asked[strcspn(asked, "?")] = 0;
	if (strcmp(asked, path))
		return refuse("404 Not Found", "only /metrics is here\n");
	return method[0] == 'G' ? HTTP_PAGE : HTTP_HEAD;
}
