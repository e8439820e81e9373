// SPDX-License-Identifier: GPL-2.0-only
/*
 * With LD_PRELOAD: a program runs the shell command $BEFORE_REQUEST before it requests a master, so
 * that 'ethercat run FILE' finds another bus than it has compared with its file.
 */
#include <dlfcn.h>
#include <stdlib.h>

struct ec_master;
struct ec_master *ecrt_request_master(unsigned int index);

struct ec_master *ecrt_request_master(unsigned int index)
{
	struct ec_master *(*request)(unsigned int index);

	*(void **)&request = dlsym(RTLD_NEXT, "ecrt_request_master");
	unsetenv("LD_PRELOAD");
	if (system(getenv("BEFORE_REQUEST")))
		return NULL;
	return request(index);
}
