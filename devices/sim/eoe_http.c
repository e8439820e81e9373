// SPDX-License-Identifier: GPL-2.0-only
/* HTTP/1.0 of a simulated slave: one page. */
#include "eoe.h"

static void add(struct ec_app_tcp *c, const char *text)
{
	size_t n = min(strlen(text), (size_t)(EC_APP_EOE_BUF - c->len));

	memcpy(c->buf + c->len, text, n);
	c->len = (u16)(c->len + n);
}

static const char *state_name(u8 state)
{
	return state == EC_AL_OP ? "OP" : state == EC_AL_SAFEOP ? "SAFEOP" : "PREOP";
}

static void page(struct ec_app *app, struct ec_app_tcp *c)
{
	add(c, "HTTP/1.0 200 OK\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n"
	       "<!DOCTYPE html>\n<html><head><title>");
	add(c, app->name);
	add(c, "</title></head>\n<body><h1>");
	add(c, app->name);
	add(c, "</h1>\n<p>Simulated EtherCAT slave (");
	add(c, app->model->table ? app->model->dev.name : "EEPROM image");
	add(c, "), state ");
	add(c, state_name(app->state));
	add(c, ".</p></body></html>\n");
}

static void answer(struct ec_app *app, struct ec_app_tcp *c)
{
	if (c->line_len == sizeof(c->line) && !memcmp(c->line, "GET / ", sizeof(c->line)))
		page(app, c);
	else if (c->line_len >= 4 && !memcmp(c->line, "GET ", 4))
		add(c, "HTTP/1.0 404 Not Found\r\nConnection: close\r\n\r\n");
	else
		add(c, "HTTP/1.0 501 Not Implemented\r\nConnection: close\r\n\r\n");
	c->answered = true;
	c->fin = true;
}

/**
 * ec_app_http() - a part of a request
 * @app: slave
 * @c: connection; gets the answer when the request is complete
 * @data: bytes of the part
 * @len: how many
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_http(struct ec_app *app, struct ec_app_tcp *c, const u8 *data, u16 len)
{
	for (u16 i = 0; i < len && !c->answered; i++) {
		if (c->line_len < sizeof(c->line))
			c->line[c->line_len++] = (char)data[i];
		if (data[i] == '\n')
			c->lines++;
		else if (data[i] != '\r')
			c->lines = 0;
		if (c->lines == 2)
			answer(app, c);
	}
}
