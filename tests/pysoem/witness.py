# SPDX-License-Identifier: GPL-2.0-only
"""pysoem, a master that shares nothing with this project, on the segment
"bench". EC_SIM: the program that simulates it, with options."""

import os
import shlex
import struct
import subprocess
import sys
import time
import unittest

import pysoem

import bench

SIM = shlex.split(os.environ["EC_SIM"])
MASTER, SEGMENT = "veth0", "veth1"  # joined by a wire
MS = 1000  # SOEM counts in us


class Bus(unittest.TestCase):
    """Master and segment with all slaves in PREOP, new ones for each test."""

    def setUp(self):
        self.sim = subprocess.Popen(SIM + [SEGMENT], stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        self.assertIn("22 slave(s)", self.sim.stdout.readline())
        self.m = pysoem.Master()
        self.m.open(MASTER)
        self.addCleanup(self.close)
        self.assertEqual(self.m.config_init(), len(bench.SLAVES))
        self.s = self.m.slaves

    def end(self):
        self.sim.terminate()
        said = self.sim.communicate(timeout=10)[0]
        self.assertEqual(self.sim.returncode, 0, said)
        self.assertIn(" 0 lost in the segment, 0 dropped", said)

    def close(self):
        self.m.state = pysoem.INIT_STATE
        self.m.write_state()
        self.m.close()

    def cycle(self, n=1):
        """n cycles; the working counter of the last."""
        for _ in range(n):
            self.m.send_processdata()
            wkc = self.m.receive_processdata(20 * MS)
        return wkc

    def answered_cycle(self):
        """A cycle whose frame came back in time: a busy machine may take longer."""
        for _ in range(20):
            wkc = self.cycle()
            if wkc != -1:  # no frame; any other value was counted by slaves
                return wkc
        return -1

    def to_op(self):
        self.m.config_map()
        self.assertEqual(self.m.state_check(pysoem.SAFEOP_STATE, 2000 * MS), pysoem.SAFEOP_STATE)
        self.cycle()
        self.m.state = pysoem.OP_STATE
        self.m.write_state()
        end = time.monotonic() + 5
        while time.monotonic() < end:
            self.cycle(5)
            if self.m.state_check(pysoem.OP_STATE, MS) == pysoem.OP_STATE:
                return
        self.m.read_state()
        self.fail("not in OP: %s" % [(s.name, s.state, s.al_status) for s in self.s])

    def until(self, what, seconds=3):
        """Cycles until what() holds."""
        end = time.monotonic() + seconds
        while not what():
            if time.monotonic() > end:
                return False
            self.cycle()
        return True

    def reads(self, what, timeout):
        """Reads the states, without process data, until what() holds."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            time.sleep(0.4)
            self.m.read_state()
            if what():
                return True
        return False

    def sdo_fails(self, call, code):
        with self.assertRaises(pysoem.SdoError) as caught:
            call()
        self.assertEqual(caught.exception.abort_code, code)


class Scan(Bus):
    def test_identity_of_every_slave(self):
        self.assertEqual([(s.name, (s.man, s.id)) for s in self.s],
                         [(n, i) for n, i, _, _ in bench.SLAVES])

    def test_registers(self):
        for pos, s in enumerate(self.s):
            kind, _, _, fmmus, sms, ram = struct.unpack("<BBHBBB", s._fprd(0x0000, 7))
            self.assertTrue(kind and fmmus and sms and ram, pos)
            alias = struct.unpack("<H", s._fprd(0x0012, 2))[0]
            self.assertEqual(alias, bench.ALIAS.get(pos, 0), pos)
            # physical link at port 0, and at port 1 of all but the ends of a branch
            dl = struct.unpack("<H", s._fprd(0x0110, 2))[0]
            self.assertTrue(dl & 0x10, pos)
            self.assertEqual(bool(dl & 0x20), pos not in (14, 21), pos)
            self.assertEqual(bool(dl & 0x40), pos == bench.COUPLER, pos)

    def test_station_addresses(self):
        seen = {struct.unpack("<H", s._fprd(0x0010, 2))[0] for s in self.s}
        self.assertEqual(len(seen), len(bench.SLAVES))


class Eeprom(Bus):
    def read(self, slave, word, words):
        data = b""
        while len(data) < 2 * words:
            data += slave.eeprom_read(word + len(data) // 2)[:4]
        return data[:2 * words]

    def test_identity_and_checksum(self):
        for pos in (bench.DIO, bench.AXIS1, bench.WAGO_IO, bench.DRIVE1):
            head = self.read(self.s[pos], 0, 14)
            self.assertEqual(bench.crc8(head[:14]), head[14], pos)
            self.assertEqual(struct.unpack_from("<II", head, 16), bench.SLAVES[pos][1], pos)
            self.assertEqual(struct.unpack_from("<H", head, 8)[0], bench.ALIAS.get(pos, 0), pos)

    def test_write(self):
        """An alias and its checksum, word by word: nothing else changes, and it is kept."""
        slave = self.s[bench.DRIVE1]
        before = self.read(slave, 0, 64)
        after = bytearray(before)
        struct.pack_into("<H", after, 8, 4711)
        after[14] = bench.crc8(after[:14])
        for word in (4, 7):
            slave.eeprom_write(word, bytes(after[2 * word:2 * word + 2]))
        self.assertEqual(self.read(slave, 0, 64), bytes(after))
        self.assertEqual(self.m.config_init(), len(bench.SLAVES))
        self.assertEqual(self.read(self.m.slaves[bench.DRIVE1], 0, 64), bytes(after))

    def test_categories(self):
        for pos in (bench.DO1, bench.AXIS2):
            s, word, found = self.s[pos], 0x40, {}
            while True:
                kind, size = struct.unpack("<HH", self.read(s, word, 2))
                if kind == 0xffff:
                    break
                self.assertLess(word + size, 2048, "no end of the categories")
                found[kind] = self.read(s, word + 2, size)
                word += 2 + size
            self.assertIn(bench.SLAVES[pos][0].encode(), found[10])  # strings
            self.assertEqual(len(found[41]) % 8, 0)  # sync managers
            self.assertTrue(found[41])


class Coe(Bus):
    def test_identity_object(self):
        for pos in (bench.AI, bench.AXIS1, bench.WAGO_IO, bench.DRIVE1):
            s, (name, ident, _, _) = self.s[pos], bench.SLAVES[pos]
            self.assertEqual(s.sdo_read(0x1008, 0).rstrip(b"\0").decode(), name)
            self.assertEqual(tuple(struct.unpack("<I", s.sdo_read(0x1018, i))[0] for i in (1, 2)),
                             ident)

    def test_sizes_of_values(self):
        s = self.s[bench.DRIVE1]
        for sub, value in ((2, b"\x81"), (3, b"\x34\x92"), (4, b"\x78\x56\x34\x92"),
                           (5, bytes(range(0xf0, 0xf8))), (10, struct.pack("<f", 1.5)),
                           (11, struct.pack("<d", -2.25)), (12, b"sixteen letters!")):
            s.sdo_write(0x2001, sub, value)
            self.assertEqual(s.sdo_read(0x2001, sub), value)

    def test_segmented_transfer(self):
        s, data = self.s[bench.DRIVE2], bytes(i * 7 & 0xff for i in range(1000))
        s.sdo_write(0x2000, 0, data)
        self.assertEqual(s.sdo_read(0x2000, 0, len(data)), data)

    def test_abort_codes(self):
        s = self.s[bench.DRIVE1]
        self.sdo_fails(lambda: s.sdo_read(0x5555, 0), 0x06020000)
        self.sdo_fails(lambda: s.sdo_read(0x1018, 9), 0x06090011)
        self.sdo_fails(lambda: s.sdo_read(0x2002, 0), 0x06010001)
        self.sdo_fails(lambda: s.sdo_write(0x1000, 0, b"\0\0\0\0"), 0x06010002)

    def test_complete_access(self):
        s = self.s[bench.AXIS1]
        whole = s.sdo_read(0x1018, 0, ca=True)
        self.assertEqual(whole[0], 4)
        self.assertEqual(struct.unpack_from("<II", whole, 2), bench.SLAVES[bench.AXIS1][1])
        # an empty list is a list all the same
        self.assertEqual(self.s[bench.AI].sdo_read(0x1C12, 0, ca=True)[0], 0)

    def test_object_dictionary(self):
        od = {o.index: o for o in self.s[bench.AXIS1].od}
        self.assertIn(0x1018, od)
        self.assertEqual(od[0x1000].name, b"Device type")
        self.assertEqual(od[0x1000].data_type, pysoem.ECT_UNSIGNED32)
        self.assertEqual(od[0x1000].bit_length, 32)
        self.assertEqual(od[0x1018].entries[2].name, b"Product code")
        self.assertEqual(od[0x1018].entries[2].bit_length, 32)


class Foe(Bus):
    def test_files(self):
        s = self.s[bench.AXIS1]
        for size in (1, 243, 244, 245, 488, 5000):  # a packet holds 244
            data = bytes((i * 5 + size) & 0xff for i in range(size))
            s.foe_write("fw.bin", 0, data, timeout=1000 * MS)
            self.assertEqual(s.foe_read("fw.bin", 0, 8192, timeout=1000 * MS), data)

    def test_absent_file(self):
        s = self.s[bench.AXIS1]
        s.foe_write("fw.bin", 0, b"content", timeout=1000 * MS)
        # pysoem does not say why
        self.assertEqual(s.foe_read("none", 0, 100, timeout=1000 * MS), b"")
        self.assertEqual(s.foe_read("fw.bin", 0, 100, timeout=1000 * MS), b"content")


class States(Bus):
    def test_forbidden_transition(self):
        s = self.s[bench.DRIVE1]
        s.state = pysoem.OP_STATE
        s.write_state()
        s.state_check(pysoem.OP_STATE, 100 * MS)
        self.m.read_state()
        self.assertEqual((s.state, s.al_status), (pysoem.PREOP_STATE | pysoem.STATE_ERROR, 0x0011))
        s.state = pysoem.PREOP_STATE | pysoem.STATE_ACK
        s.write_state()
        self.assertEqual(s.state_check(pysoem.PREOP_STATE, 500 * MS), pysoem.PREOP_STATE)

    def test_wrong_sync_manager(self):
        self.m.config_map()
        s = self.s[bench.DRIVE1]
        self.assertEqual(s.state_check(pysoem.SAFEOP_STATE, 1000 * MS), pysoem.SAFEOP_STATE)
        s.state = pysoem.PREOP_STATE
        s.write_state()
        self.assertEqual(s.state_check(pysoem.PREOP_STATE, 1000 * MS), pysoem.PREOP_STATE)
        s._fpwr(0x0816, b"\0")  # it takes no length while it is enabled
        s._fpwr(0x0812, struct.pack("<H", 23))  # 22 bytes are mapped
        s._fpwr(0x0816, b"\1")
        s.state = pysoem.SAFEOP_STATE
        s.write_state()
        s.state_check(pysoem.SAFEOP_STATE, 200 * MS)
        self.m.read_state()
        self.assertEqual((s.state, s.al_status), (pysoem.PREOP_STATE | pysoem.STATE_ERROR, 0x001D))

    def test_watchdog(self):
        self.to_op()
        s = self.s[bench.DRIVE1]
        # the usual limit is 100 ms
        self.assertTrue(self.reads(lambda: s.state & pysoem.STATE_ERROR, timeout=120), s.state)
        self.assertEqual((s.state, s.al_status), (pysoem.SAFEOP_STATE | pysoem.STATE_ERROR, 0x001B))
        # nobody watches slaves without outputs
        self.assertEqual(self.s[bench.DI1].state, pysoem.OP_STATE)

    def test_write_protected_in_op(self):
        self.to_op()
        s = self.s[bench.DRIVE1]
        self.sdo_fails(lambda: s.sdo_write(0x2003, 0, b"\1\0\0\0"), 0x08000022)


class ProcessData(Bus):
    def test_sizes_and_working_counter(self):
        self.to_op()
        self.assertEqual([(len(s.output), len(s.input)) for s in self.s],
                         [(o, i) for _, _, o, i in bench.SLAVES])
        # SOEM expects less: it leaves out those whose bits do not fill a byte
        counts = [self.answered_cycle() for _ in range(1000)]
        self.assertEqual(set(counts), {bench.WKC})

    def test_working_counter_without_fmmu(self):
        self.to_op()
        s = self.s[bench.DRIVE1]
        s._fpwr(0x060C, b"\0")  # outputs
        self.assertEqual(self.cycle(), bench.WKC - 2)
        s._fpwr(0x061C, b"\0")  # inputs
        self.assertEqual(self.cycle(), bench.WKC - 3)

    def test_digital_outputs_come_back(self):
        self.to_op()
        for out, bit, to, at in bench.DIGITAL_WIRES:
            for value in (1, 0, 1, 0):
                self.s[out].output = bytes([value << bit])
                self.assertTrue(self.until(lambda: self.s[to].input[0] >> at & 1 == value),
                                (out, bit, value))

    def test_analog_outputs_come_back(self):
        self.to_op()
        for value in (1, -1, 0x1234, 32767, -32768, 0):
            data = struct.pack("<h", value)
            self.s[bench.AO].output = data + b"\0\0"
            self.s[bench.AO2].output = data + b"\0\0"
            self.s[bench.WAGO_IO].output = data + bytes(6) + bytes([value & 1])
            # channel: status word, value
            self.assertTrue(self.until(lambda: self.s[bench.AI].input[6:8] == data), value)
            self.assertTrue(self.until(lambda: self.s[bench.AI2].input[2:4] == data), value)
            self.assertTrue(self.until(lambda: self.s[bench.WAGO_IO].input[0:2] == data), value)
            self.assertTrue(self.until(lambda: self.s[bench.WAGO_IO].input[8] & 1 == value & 1))
        self.assertEqual(struct.unpack_from("<h", self.s[bench.WAGO_IO].input, 2)[0], 1234)

    def test_sine(self):
        self.to_op()
        seen, end = [], time.monotonic() + 1.1
        while time.monotonic() < end:
            self.cycle()
            seen.append(struct.unpack_from("<h", self.s[bench.AI].input, 2)[0])
            time.sleep(0.001)
        self.assertAlmostEqual(max(seen), 16384 + 15000, delta=300)
        self.assertAlmostEqual(min(seen), 16384 - 15000, delta=300)

    def test_servo_axis(self):
        self.to_op()
        s = self.s[bench.AXIS1]

        def status(control, velocity=0):
            s.output = struct.pack("<Hi", control, velocity)
            return struct.unpack_from("<H", s.input, 4)[0] & 0x6f

        self.assertTrue(self.until(lambda: status(0x06) == 0x21), "ready to switch on")
        self.assertTrue(self.until(lambda: status(0x07) == 0x23), "switched on")
        self.assertTrue(self.until(lambda: status(0x0f) == 0x27), "operation enabled")
        at = struct.unpack_from("<I", s.input, 0)[0]
        self.until(lambda: status(0x0f, 1 << 24) != 0x27, 0.3)
        moved = struct.unpack_from("<I", s.input, 0)[0] - at
        self.assertGreater(moved, 0)
        self.assertTrue(self.until(lambda: status(0x00) != 0x27), "disabled")

    def test_changed_mapping(self):
        s = self.s[bench.DRIVE1]
        entry = struct.unpack("<I", s.sdo_read(0x1600, 1))[0]
        self.assertGreater(entry & 0xff, 0)

        def first_entry_only(_pos):
            s.sdo_write(0x1C12, 0, b"\0")
            s.sdo_write(0x1600, 0, b"\0")
            s.sdo_write(0x1600, 1, struct.pack("<I", entry))
            s.sdo_write(0x1600, 0, b"\1")
            s.sdo_write(0x1C12, 1, struct.pack("<H", 0x1600))
            s.sdo_write(0x1C12, 0, b"\1")

        s.config_func = first_entry_only
        self.to_op()
        self.assertEqual((len(s.output), len(s.input)), ((entry & 0xff) // 8, 22))
        self.assertEqual(self.cycle(10), bench.WKC)


class Clocks(Bus):
    def test_delays_and_time(self):
        self.m.config_map()
        self.assertTrue(self.m.config_dc())
        delays = [struct.unpack("<I", self.s[p]._fprd(0x0928, 4))[0]
                  for p in (bench.AXIS1, bench.AXIS2)]
        self.assertLess(delays[0], delays[1])
        self.assertLess(delays[1], 100000)
        self.cycle()
        a = self.m.dc_time
        time.sleep(0.05)
        self.cycle()
        self.assertAlmostEqual((self.m.dc_time - a) / 1e6, 50, delta=40)


class Result(unittest.TextTestResult):
    def addSuccess(self, test):
        super().addSuccess(test)
        print("ok", test.id())

    def addFailure(self, test, err):
        super().addFailure(test, err)
        print("not ok", test.id(), flush=True)

    def addError(self, test, err):
        super().addError(test, err)
        print("not ok", test.id(), flush=True)


if __name__ == "__main__":
    tests = unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])
    r = unittest.TextTestRunner(stream=sys.stdout, resultclass=Result, verbosity=0).run(tests)
    bad = len(r.failures) + len(r.errors)
    print("%d passed, %d failed" % (r.testsRun - bad, bad))
    sys.exit(bad > 0)
