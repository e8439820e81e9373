// SPDX-License-Identifier: GPL-2.0-only
/* A second process beside an application: one that cycles, stops, or is gone. */
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <fcntl.h>
#include <unistd.h>

#include <uapi/ethercat.h>

#include "api.h"

static pid_t app;

/* An application in OP; the other end of the pipe says so. */
static void start_app(void)
{
	struct bench b;
	char c = 0;
	int fd[2];

	NEED(!pipe(fd));
	fflush(NULL);
	app = fork();
	if (!app) {
		if (!bench_up(&b))
			_exit(1);
		if (write(fd[1], &c, 1) != 1)
			_exit(1);
		for (;;)
			bench_cycle(&b, 1);
	}
	close(fd[1]);
	IS(read(fd[0], &c, 1), 1);
	close(fd[0]);
}

static void end_app(int how)
{
	int status;

	kill(app, how);
	waitpid(app, &status, 0);
	app = 0;
}

static void talk(unsigned int states)
{
	const uint8_t value[4] = { 1, 2, 3, 4 };
	ec_master_t *m = ecrt_open_master(0);
	ec_master_state_t s;
	ec_slave_info_t info;
	uint32_t abort;
	uint8_t back[4];
	size_t size = 0;

	NEED(m);
	IS(ecrt_master_state(m, &s), 0);
	IS(s.slaves_responding, SLAVES);
	YES(!states || (s.al_states & states) == states);
	IS(ecrt_master_get_slave(m, MOTOR, &info), 0);
	YES(info.al_state != 0);
	IS(ecrt_master_sdo_download(m, MOTOR, 0x2001, 8, value, 4, &abort), 0);
	IS(ecrt_master_sdo_upload(m, MOTOR, 0x2001, 8, back, 4, &size, &abort), 0);
	YES(size == 4 && !memcmp(back, value, 4));
	IS(ecrt_master_reserve(m), app ? -EBUSY : 0);
	ecrt_release_master(m);
}

static void cycling(void)
{
	start_app();
	NEED(app);
	for (int i = 0; i < 5; i++)
		talk(EC_AL_STATE_OP);
	end_app(SIGTERM);
}

/* It holds the master, and does not cycle: others are served. */
static void stopped(void)
{
	start_app();
	NEED(app);
	kill(app, SIGSTOP);
	talk(0);
	kill(app, SIGCONT);
	usleep(200000);
	talk(0);
	end_app(SIGKILL);
}

/* Killed in OP: the next application finds slaves that answer at once. */
static void killed(void)
{
	start_app();
	NEED(app);
	end_app(SIGKILL);
	talk(0);
	start_app();
	NEED(app);
	end_app(SIGKILL);
	start_app();
	end_app(SIGTERM);
	talk(0);
}

/* Without the library: the file is closed, then the memory is given back. */
static void close_first(void)
{
	struct ec_ioc_slave_config sc = { .position = OUT, .vendor_id = BECKHOFF,
					  .product_code = EL2008 };
	struct ec_ioc_reg_entry e = { .entry_index = 0x7000, .subindex = 1 };
	struct ec_ioc_create_domain d = { 0 };
	struct ec_ioc_activate a = { 0 };
	struct ec_ioc_send send = { .queued = 1 };
	int fd = open("/dev/EtherCAT0", O_RDWR | O_CLOEXEC);
	uint8_t *image;

	NEED(fd >= 0);
	IS(ioctl(fd, EC_IOC_RESERVE), 0);
	IS(ioctl(fd, EC_IOC_CREATE_DOMAIN, &d), 0);
	IS(ioctl(fd, EC_IOC_SLAVE_CONFIG, &sc), 0);
	IS(ioctl(fd, EC_IOC_REG_ENTRY, &e), 0);
	IS(ioctl(fd, EC_IOC_ACTIVATE, &a), 0);
	image = mmap(NULL, a.image_size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, EC_MMAP_IMAGE);
	NEED(image != MAP_FAILED);
	for (int i = 0; i < 200; i++) {
		bench_sleep();
		image[0] = (uint8_t)i;
		IS(ioctl(fd, EC_IOC_RECEIVE), 0);
		IS(ioctl(fd, EC_IOC_SEND, &send), 0);
	}
	close(fd);
	image[0] = 0x55;
	IS(image[0], 0x55);
	munmap(image, a.image_size);
	talk(0);
}

const struct api_case beside_cases[] = {
	{ "9.1 beside an application that cycles", cycling },
	{ "9.11 beside one that has stopped", stopped },
	{ "9.2, 9.11 after one was killed", killed },
	{ "9.11 the file is closed before the memory", close_first },
	{ NULL, NULL },
};
