/* SPDX-License-Identifier: GPL-2.0-only */
/* A request of HTTP on stdin and its reply on stdout, as systemd starts a program for it. */
#ifndef EC_TOOL_HTTP_H
#define EC_TOOL_HTTP_H

#include <stdbool.h>

/**
 * enum http_wish - what a client has asked for
 * @HTTP_PAGE: the page
 * @HTTP_HEAD: its head
 * @HTTP_NOTHING: nothing more: it has got its reply, or there is none
 */
enum http_wish { HTTP_PAGE, HTTP_HEAD, HTTP_NOTHING };

enum http_wish http_request(const char *path);
void http_reply(const char *status, const char *type, const char *content, bool head);

#endif
