// SPDX-License-Identifier: GPL-2.0-only
/*
 * A client with the habits of a robot driver in C++: it goes on after a failed
 * request, configures clocks first, gives a time that wraps below zero and jumps
 * by decades, passes the end mark as one more SyncManager, writes whole bytes, and
 * leaves without a word.
 */
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <vector>

extern "C" {
#include "api.h"
extern const struct api_case ros2_cases[];
}

namespace {

constexpr uint32_t period = 1000000;

uint64_t nanoseconds(clockid_t clock)
{
	timespec t;

	clock_gettime(clock, &t);
	return static_cast<uint64_t>(t.tv_sec) * 1000000000 + static_cast<uint64_t>(t.tv_nsec);
}

/* since 2000, of a clock that counts from the start of the machine */
uint64_t before_zero()
{
	return nanoseconds(CLOCK_MONOTONIC) - 946684800ULL * 1000000000;
}

class Client {
public:
	explicit Client(unsigned int index) : master_(ecrt_request_master(index))
	{
		domain_ = ecrt_master_create_domain(master_);
	}

	void add_drive()
	{
		ec_slave_info_t info = {};

		ecrt_master_get_slave(master_, MOTOR, &info);
		drive_ = ecrt_master_slave_config(master_, 0, MOTOR, info.vendor_id,
						  info.product_code);
		vendor_ = info.vendor_id;
		product_ = info.product_code;
		ecrt_master_application_time(master_, before_zero());
		/* nearly a whole period of shift */
		shift_ = static_cast<int32_t>(period - nanoseconds(CLOCK_MONOTONIC) % period);
		ecrt_slave_config_dc(drive_, 0x300, period, shift_, 0, 0);
		clock_regs = ecrt_slave_config_create_reg_request(drive_, 0x88);
		pdos_result = ecrt_slave_config_pdos(drive_, static_cast<unsigned int>(syncs_.size()),
						     syncs_.data());
	}

	void add_outputs()
	{
		outputs_ = ecrt_master_slave_config(master_, 0, OUT, BECKHOFF, EL2008);
		inputs_ = ecrt_master_slave_config(master_, 0, IN, BECKHOFF, EL1008);
	}

	/* objects after the rest of the configuration */
	int download(uint16_t index, uint8_t subindex, uint32_t value)
	{
		uint8_t bytes[4];
		uint32_t abort = 0;

		EC_WRITE_U32(bytes, value);
		return ecrt_master_sdo_download(master_, MOTOR, index, subindex, bytes, 4, &abort);
	}

	int start()
	{
		std::vector<ec_pdo_entry_reg_t> regs;

		regs.push_back({ 0, MOTOR, vendor_, product_, 0x6040, 0, &control, &bit_[0] });
		regs.push_back({ 0, MOTOR, vendor_, product_, 0x6041, 0, &status, &bit_[1] });
		regs.push_back({ 0, OUT, BECKHOFF, EL2008, 0x7020, 1, &out, &bit_[2] });
		regs.push_back({ 0, IN, BECKHOFF, EL1008, 0x6010, 1, &in, &bit_[3] });
		regs.push_back({});
		list_result = ecrt_domain_reg_pdo_entry_list(domain_, regs.data());
		ecrt_master_application_time(master_, before_zero());
		const int ret = ecrt_master_activate(master_);
		data = ecrt_domain_data(domain_);
		return ret;
	}

	void cycle()
	{
		ecrt_master_receive(master_);
		ecrt_domain_process(domain_);
		ecrt_domain_state(domain_, &domain_state);
		if (counter_++ % 10 == 0) {
			ecrt_master_state(master_, &master_state);
			ecrt_slave_config_state(drive_, &drive_state);
		}
		ecrt_master_application_time(master_, nanoseconds(CLOCK_REALTIME));
		ecrt_master_sync_reference_clock(master_);
		ecrt_master_sync_slave_clocks(master_);
		ecrt_domain_queue(domain_);
		ecrt_master_send(master_);
	}

	bool to_op()
	{
		for (int i = 0; i < 20000 && !drive_state.operational; i++) {
			bench_sleep();
			cycle();
		}
		return drive_state.operational;
	}

	ec_master_t *master() const { return master_; }
	ec_slave_config_t *drive() const { return drive_; }

	uint8_t *data = nullptr;
	uint32_t control = 0, status = 0, out = 0, in = 0;
	ec_reg_request_t *clock_regs = nullptr;
	int pdos_result = -1, list_result = -1;
	ec_domain_state_t domain_state = {};
	ec_master_state_t master_state = {};
	ec_slave_config_state_t drive_state = {};

private:
	ec_pdo_entry_info_t rx_entries_[3] = { { 0x6040, 0, 16 }, { 0, 0, 8 }, { 0x60ff, 0, 32 } };
	ec_pdo_entry_info_t tx_entries_[3] = { { 0x6041, 0, 16 }, { 0, 0, 8 }, { 0x6064, 0, 32 } };
	ec_pdo_info_t rx_ = { 0x1600, 3, rx_entries_ };
	ec_pdo_info_t tx_ = { 0x1a00, 3, tx_entries_ };
	/* the end mark is counted */
	std::vector<ec_sync_info_t> syncs_ = {
		{ 0, EC_DIR_OUTPUT, 0, nullptr, EC_WD_DISABLE },
		{ 1, EC_DIR_INPUT, 0, nullptr, EC_WD_DISABLE },
		{ 2, EC_DIR_OUTPUT, 1, &rx_, EC_WD_ENABLE },
		{ 3, EC_DIR_INPUT, 1, &tx_, EC_WD_DISABLE },
		{ 0xff, EC_DIR_INVALID, 0, nullptr, EC_WD_DEFAULT },
	};
	ec_master_t *master_;
	ec_domain_t *domain_ = nullptr;
	ec_slave_config_t *drive_ = nullptr, *outputs_ = nullptr, *inputs_ = nullptr;
	uint32_t vendor_ = 0, product_ = 0, bit_[4] = {};
	int32_t shift_ = 0;
	unsigned long counter_ = 0;
};

/* There is no master 31: everything is called all the same. */
void no_master()
{
	Client c(31);

	YES(!c.master());
	c.add_drive();
	c.add_outputs();
	IS(c.pdos_result, -EINVAL);
	IS(c.download(0x2001, 8, 1), -EINVAL);
	IS(c.start(), -EINVAL);
	IS(c.list_result, -EINVAL);
	YES(!c.data);
	for (int i = 0; i < 20; i++)
		c.cycle();
	IS(c.drive_state.operational, 0);
}

/* All of it in a process that then ends, without deactivation or release. */
void whole_life()
{
	Client c(0);
	ec_slave_config_dc_state_t dc = {};

	NEED(c.master());
	c.add_drive();
	IS(c.pdos_result, 0);
	c.add_outputs();
	IS(c.download(0x2001, 8, 0xcafe), 0);
	IS(c.start(), 0);
	IS(c.list_result, 0);
	NEED(c.data);
	NEED(c.to_op());
	for (int i = 0; i < 500; i++) {
		bench_sleep();
		c.cycle();
	}
	IS(c.domain_state.wc_state, EC_WC_COMPLETE);
	IS(ecrt_slave_config_dc_state(c.drive(), &dc), 0);
	YES(dc.set);
	/* its next SYNC0 (0x0990) is at most a period after its time (0x0910) */
	IS(ecrt_reg_request_read(c.clock_regs, 0x0910, 0x88), 0);
	for (int i = 0; i < 2000 && ecrt_reg_request_state(c.clock_regs) == EC_REQUEST_BUSY; i++) {
		bench_sleep();
		c.cycle();
	}
	IS(ecrt_reg_request_state(c.clock_regs), EC_REQUEST_SUCCESS);
	const uint8_t *regs = ecrt_reg_request_data(c.clock_regs);
	IS(EC_READ_U8(regs + 0x71), 0x03);
	YES(EC_READ_U64(regs + 0x80) - EC_READ_U64(regs) <= period);
	/* a whole byte of the terminal is written, whatever bit was registered */
	c.data[c.out] = static_cast<uint8_t>(c.data[c.out] | 0x02);
	c.data[c.out] = static_cast<uint8_t>(c.data[c.out] & ~0x01);
	for (int i = 0; i < 5; i++) {
		bench_sleep();
		c.cycle();
	}
	IS(c.data[c.out], 0x02);
	IS(c.data[c.in] & 0x02, 0x02);
	EC_WRITE_U16(c.data + c.control, 0x0006);
	for (int i = 0; i < 20; i++) {
		bench_sleep();
		c.cycle();
	}
	IS(EC_READ_U16(c.data + c.status) & 0x6f, 0x21);
	/* and away: no deactivation, no release */
}

void in_a_process()
{
	struct api_counts before = api_counts();
	int status = -1;

	fflush(nullptr);
	const pid_t child = fork();
	if (!child) {
		whole_life();
		fflush(nullptr);
		_exit(api_counts().failures != before.failures);
	}
	waitpid(child, &status, 0);
	IS(status, 0);
	/* the next one finds the master free, and slaves that answer */
	ec_master_t *m = ecrt_request_master(0);
	uint8_t data[4];
	size_t size = 0;

	NEED(m);
	IS(ecrt_master_sdo_upload(m, MOTOR, 0x2001, 8, data, 4, &size, nullptr), 0);
	IS(EC_READ_U32(data), 0xcafe);
	ecrt_release_master(m);
}

} // namespace

const struct api_case ros2_cases[] = {
	{ "9.1 it goes on without a master", no_master },
	{ "9.2-9.11 a whole life, and no farewell", in_a_process },
	{ nullptr, nullptr },
};
