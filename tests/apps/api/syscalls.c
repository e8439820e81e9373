// SPDX-License-Identifier: GPL-2.0-only
/* System calls of a cycle that does all that can be done in one. */
#include <linux/ptrace.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "api.h"

/* <sys/ptrace.h> and <linux/ptrace.h> exclude each other */
extern long ptrace(int request, ...);

#define MARK		0x7ec0a000	/* argument of a harmless call */
#define CYCLES		200
#define DOMAINS		8

struct app {
	ec_master_t *m;
	ec_domain_t *d[DOMAINS];
	unsigned int domains;
	ec_slave_config_t *out, *in, *motor;
	ec_sdo_request_t *sdo;
	ec_reg_request_t *reg;
	unsigned long n, done;
	uint64_t last;
	enum { APPLICATION, WAIT, SPIN } how;
};

static void mark(bool begin) { syscall(SYS_getpgid, MARK + begin); }

/* clocks, states, emergencies and requests, each in every cycle */
static void everything(struct app *a)
{
	ec_slave_config_state_t ss;
	ec_master_state_t ms;
	ec_domain_state_t ds;
	uint8_t e[8];
	uint32_t t;

	ecrt_master_state(a->m, &ms);
	ecrt_slave_config_state(a->out, &ss);
	ecrt_slave_config_state(a->in, &ss);
	ecrt_slave_config_state(a->motor, &ss);
	for (unsigned int i = 0; i < a->domains; i++)
		ecrt_domain_state(a->d[i], &ds);
	while (!ecrt_slave_config_emerg_pop(a->motor, e))
		;
	if (ecrt_sdo_request_state(a->sdo) != EC_REQUEST_BUSY) {
		a->done += ecrt_sdo_request_state(a->sdo) == EC_REQUEST_SUCCESS;
		ecrt_sdo_request_read(a->sdo);
	}
	if (ecrt_reg_request_state(a->reg) != EC_REQUEST_BUSY) {
		a->done += ecrt_reg_request_state(a->reg) == EC_REQUEST_SUCCESS;
		ecrt_reg_request_read(a->reg, 0x0130, 2);
	}
	ecrt_master_reference_clock_time(a->m, &t);
	ecrt_master_sync_monitor_process(a->m);
	ecrt_master_application_time(a->m, a->n * 1000000ULL);
	ecrt_master_sync_reference_clock(a->m);
	ecrt_master_sync_slave_clocks(a->m);
	ecrt_master_sync_monitor_queue(a->m);
}

static void cycle(struct app *a, bool count)
{
	unsigned int i;

	if (a->how == APPLICATION)
		bench_sleep();
	if (count)
		mark(true);
	if (a->how == WAIT)
		ecrt_master_wait_cycle(a->m, 0);
	while (a->how == SPIN && ecrt_master_cycle_count(a->m) == a->last)
		;
	a->last = ecrt_master_cycle_count(a->m);
	ecrt_master_receive(a->m);
	for (i = 0; i < a->domains; i++)
		ecrt_domain_process(a->d[i]);
	everything(a);
	for (i = 0; i < a->domains; i++)
		ecrt_domain_queue(a->d[i]);
	ecrt_master_send(a->m);
	if (count)
		mark(false);
	a->n++;
}

static bool configure(struct app *a)
{
	const ec_cycle_config_t config = { .period_ns = 1000000,
					   .dc = EC_CYCLE_SYNC_SLAVES | EC_CYCLE_SYNC_MONITOR };
	ec_slave_info_t info;
	unsigned int bit;

	a->m = ecrt_request_master(0);
	for (unsigned int i = 0; a->m && i < a->domains; i++)
		a->d[i] = ecrt_master_create_domain(a->m);
	if (!a->m || ecrt_master_get_slave(a->m, MOTOR, &info))
		return false;
	a->out = ecrt_master_slave_config(a->m, 0, OUT, BECKHOFF, EL2008);
	a->in = ecrt_master_slave_config(a->m, 0, IN, BECKHOFF, EL1008);
	a->motor = ecrt_master_slave_config(a->m, 0, MOTOR, info.vendor_id, info.product_code);
	a->sdo = ecrt_slave_config_create_sdo_request(a->motor, 0x1018, 4, 4);
	a->reg = ecrt_slave_config_create_reg_request(a->motor, 2);
	/* the outputs of the drive in one domain, its inputs in each of the others */
	if (ecrt_slave_config_reg_pdo_entry(a->motor, 0x6040, 0, a->d[0], &bit) < 0 ||
	    ecrt_slave_config_reg_pdo_entry(a->out, 0x7000, 1, a->d[0], &bit) < 0 ||
	    ecrt_slave_config_reg_pdo_entry(a->in, 0x6000, 1, a->d[0], &bit) < 0)
		return false;
	for (unsigned int i = 1; i < a->domains; i++)
		if (ecrt_slave_config_reg_pdo_entry(a->motor, 0x6041, 0, a->d[i], &bit) < 0)
			return false;
	if (a->how != APPLICATION && ecrt_master_set_cycle(a->m, &config))
		return false;
	return a->sdo && a->reg && !ecrt_slave_config_emerg_size(a->motor, 4) &&
	       !ecrt_slave_config_dc(a->motor, 0x300, 1000000, 0, 0, 0) && !ecrt_master_activate(a->m);
}

/* The process that is watched; 0: all was in OP, and requests came to an end. */
static int child(struct app *a)
{
	ec_slave_config_state_t s = { 0 };

	if (!configure(a))
		return 1;
	for (int i = 0; i < 20000 && !s.operational; i++) {
		cycle(a, false);
		ecrt_slave_config_state(a->motor, &s);
	}
	for (int i = 0; i < CYCLES; i++)
		cycle(a, true);
	ecrt_release_master(a->m);
	return s.operational && a->done > 2 ? 0 : 2;
}

/* Most system calls between two marks, as a tracer sees them; -1: it failed. */
static int watch(struct app *a)
{
	struct ptrace_syscall_info info;
	int status, sig = 0, n = 0, max = -1;
	bool on = false;
	pid_t pid;

	fflush(NULL);
	pid = fork();
	if (!pid) {
		ptrace(PTRACE_TRACEME, 0, NULL, NULL);
		raise(SIGSTOP);
		_exit(child(a));
	}
	if (waitpid(pid, &status, 0) != pid || !WIFSTOPPED(status))
		return -1;
	ptrace(PTRACE_SETOPTIONS, pid, NULL, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
	while (!ptrace(PTRACE_SYSCALL, pid, NULL, (long)sig) && waitpid(pid, &status, 0) == pid &&
	       WIFSTOPPED(status)) {
		sig = WSTOPSIG(status);
		if (sig != (SIGTRAP | 0x80))
			continue;
		sig = 0;
		if (ptrace(PTRACE_GET_SYSCALL_INFO, pid, sizeof(info), &info) <= 0 ||
		    info.op != PTRACE_SYSCALL_INFO_ENTRY)
			continue;
		if (info.entry.nr == SYS_getpgid && info.entry.args[0] >> 1 == MARK >> 1) {
			on = info.entry.args[0] & 1;
			max = !on && n > max ? n : max;
			n = 0;
		} else {
			n += on;
		}
	}
	IS(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0);
	return max;
}

static void one_domain(void)
{
	struct app a = { .domains = 1, .how = APPLICATION };

	IS(watch(&a), 2);
}

static void eight_domains(void)
{
	struct app a = { .domains = DOMAINS, .how = APPLICATION };

	IS(watch(&a), 2);
}

static void wait_kernel(void)
{
	struct app a = { .domains = DOMAINS, .how = WAIT };

	IS(watch(&a), 1);
}

static void spin(void)
{
	struct app a = { .domains = DOMAINS, .how = SPIN };

	IS(watch(&a), 0);
}

const struct api_case syscall_cases[] = {
	{ "2 in a cycle of the application, 1 domain", one_domain },
	{ "2 in a cycle of the application, 8 domains", eight_domains },
	{ "1 in a cycle of the kernel that is waited for", wait_kernel },
	{ "0 in a cycle of the kernel that is spun for", spin },
	{ NULL, NULL },
};
