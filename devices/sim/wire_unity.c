// SPDX-License-Identifier: GPL-2.0-only
/* ec_sim.ko carries its own wire codecs: nothing is exported between modules. */
#include "../../master/wire/al.c"
#include "../../master/wire/coe.c"
#include "../../master/wire/eoe.c"
#include "../../master/wire/fmmu.c"
#include "../../master/wire/foe.c"
#include "../../master/wire/frame.c"
#include "../../master/wire/mbox.c"
#include "../../master/wire/sdo.c"
#include "../../master/wire/sdoinfo.c"
#include "../../master/wire/sii.c"
#include "../../master/wire/soe.c"
#include "../../master/wire/voe.c"
