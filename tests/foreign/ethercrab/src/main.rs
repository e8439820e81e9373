// SPDX-License-Identifier: GPL-2.0-only
//! ethercrab, a master that shares nothing with this project, on the segment
//! "bench": ethercrab-witness INTERFACE. One TAP line for each case.

use ethercrab::{
    MainDevice, MainDeviceConfig, ObjectDescriptionListQuery, PduStorage, SubDeviceGroup,
    SubDeviceState, Timeouts, error::Error, std::ethercat_now, subdevice_group,
};
use std::time::{Duration, Instant};

const MAX_SLAVES: usize = 32;
const MAX_PDI: usize = 512;
static STORAGE: PduStorage<16, { PduStorage::element_size(1100) }> = PduStorage::new();

// name, vendor, product, bytes of outputs and of inputs; from vendor lists and the
// description of the segment, not from the model
const fn ek(number: u32) -> u32 {
    number << 16 | 0x2c52
}
const fn el(number: u32) -> u32 {
    number << 16 | 0x3052
}
const SLAVES: [(&str, u32, u32, usize, usize); 22] = [
    ("EK1100", 2, ek(1100), 0, 0),
    ("EL1859", 2, el(1859), 1, 1),
    ("EL3062", 2, el(3062), 0, 8),
    ("EL4002", 2, el(4002), 4, 0),
    ("EL7201", 2, el(7201), 6, 6),
    ("EL7201", 2, el(7201), 6, 6),
    ("EL6614", 2, el(6614), 0, 0),
    ("EK1110", 2, ek(1110), 0, 0),
    ("EK1100", 2, ek(1100), 0, 0),
    ("EL1008", 2, el(1008), 0, 1),
    ("EL1004", 2, el(1004), 0, 1),
    ("EL2008", 2, el(2008), 1, 0),
    ("EL2004", 2, el(2004), 1, 0),
    ("EL3062", 2, el(3062), 0, 8),
    ("EL4002", 2, el(4002), 4, 0),
    ("750-354", 0x21, 0x07500354, 9, 9),
    ("drive", 0xec51, 0x402, 22, 22),
    ("drive", 0xec51, 0x402, 22, 22),
    ("io", 0xec51, 0x104, 8, 8),
    ("EK1100", 2, ek(1100), 0, 0),
    ("EL2008", 2, el(2008), 1, 0),
    ("EL1008", 2, el(1008), 0, 1),
];
const AXIS1: usize = 4;
const AXIS2: usize = 5;
const DI1: usize = 9;
const DO1: usize = 11;
const WAGO: usize = 15;
const DRIVE1: usize = 16;

struct Results {
    passed: u32,
    failed: u32,
}

impl Results {
    fn case(&mut self, name: &str, result: Result<(), String>) {
        match result {
            Ok(()) => {
                self.passed += 1;
                println!("ok ethercrab: {name}");
            }
            Err(why) => {
                self.failed += 1;
                println!("not ok ethercrab: {name}\n# {why}");
            }
        }
    }
}

fn same<T: PartialEq + std::fmt::Debug>(what: &str, found: T, expected: T) -> Result<(), String> {
    if found == expected {
        Ok(())
    } else {
        Err(format!("{what} is {found:?}, expected {expected:?}"))
    }
}

fn text(e: Error) -> String {
    format!("{e}")
}

type PreOp = SubDeviceGroup<MAX_SLAVES, MAX_PDI, ethercrab::DefaultLock, subdevice_group::PreOp>;

fn identities(group: &PreOp, m: &MainDevice<'_>) -> Result<(), String> {
    same("number of slaves", group.len(), SLAVES.len())?;
    for (i, (s, want)) in group.iter(m).zip(SLAVES).enumerate() {
        same(&format!("name of {i}"), s.name(), want.0)?;
        let id = s.identity();
        same(&format!("identity of {i}"), (id.vendor_id, id.product_id), (want.1, want.2))?;
        let alias = match i {
            0 => 1,
            8 => 2,
            11 => 1001,
            15 => 3,
            19 => 4,
            _ => 0,
        };
        same(&format!("alias of {i}"), s.alias_address(), alias)?;
    }
    Ok(())
}

fn delays(group: &PreOp, m: &MainDevice<'_>) -> Result<(), String> {
    let d: Vec<u32> = group.iter(m).map(|s| s.propagation_delay()).collect();
    if d[AXIS1] > 0 && d[AXIS1] < d[AXIS2] && d[AXIS2] < 100_000 {
        Ok(())
    } else {
        Err(format!("delays of the axes: {} ns, {} ns", d[AXIS1], d[AXIS2]))
    }
}

async fn sdos(group: &PreOp, m: &MainDevice<'_>) -> Result<(), String> {
    for i in [AXIS1, WAGO, DRIVE1] {
        let s = group.subdevice(m, i).map_err(text)?;
        let id: (u32, u32) = (
            s.sdo_read(0x1018, 1).await.map_err(text)?,
            s.sdo_read(0x1018, 2).await.map_err(text)?,
        );
        same(&format!("0x1018 of {i}"), id, (SLAVES[i].1, SLAVES[i].2))?;
    }
    let s = group.subdevice(m, DRIVE1).map_err(text)?;
    s.sdo_write(0x2001, 2, 0x81u8).await.map_err(text)?;
    s.sdo_write(0x2001, 3, 0x9234u16).await.map_err(text)?;
    s.sdo_write(0x2001, 4, 0x92345678u32).await.map_err(text)?;
    let back: (u8, u16, u32) = (
        s.sdo_read(0x2001, 2).await.map_err(text)?,
        s.sdo_read(0x2001, 3).await.map_err(text)?,
        s.sdo_read(0x2001, 4).await.map_err(text)?,
    );
    same("values written", back, (0x81, 0x9234, 0x92345678))
}

async fn refusals(group: &PreOp, m: &MainDevice<'_>) -> Result<(), String> {
    let s = group.subdevice(m, DRIVE1).map_err(text)?;
    for (index, sub, code) in [(0x5555, 0, "0x06020000"), (0x1018, 9, "0x06090011")] {
        match s.sdo_read::<u32>(index, sub).await {
            Ok(v) => return Err(format!("0x{index:04x}:{sub} answers {v}")),
            Err(e) => {
                let said = format!("{e:?} {e}");
                let abort = format!("{:#010x}", abort_code(&e).unwrap_or(0));
                if abort != code {
                    return Err(format!("0x{index:04x}:{sub} ends with {said}, expected {code}"));
                }
            }
        }
    }
    Ok(())
}

fn abort_code(e: &Error) -> Option<u32> {
    match e {
        Error::Mailbox(ethercrab::error::MailboxError::Aborted { code, .. }) => {
            Some(u32::from(*code))
        }
        _ => None,
    }
}

async fn dictionary(group: &PreOp, m: &MainDevice<'_>) -> Result<(), String> {
    let s = group.subdevice(m, AXIS1).map_err(text)?;
    let list = s
        .sdo_info_object_description_list(ObjectDescriptionListQuery::All)
        .await
        .map_err(text)?
        .ok_or("no list")?;
    for index in [0x1000, 0x1018, 0x1c12] {
        if !list.contains(&index) {
            return Err(format!("0x{index:04x} is not among {} objects", list.len()));
        }
    }
    Ok(())
}

/// To OP, sizes, working counters, outputs that come back, and back to INIT.
async fn operation(group: PreOp, m: &MainDevice<'_>, r: &mut Results) -> Result<(), String> {
    let group = group.into_safe_op(m).await.map_err(text)?;
    let group = group.request_into_op(m).await.map_err(text)?;
    let begin = Instant::now();
    loop {
        let t = group.tx_rx(m).await.map_err(text)?;
        if t.is_in_state(SubDeviceState::Op) {
            break;
        }
        if begin.elapsed() > Duration::from_secs(10) {
            return Err(format!("not in OP: {:?}", t.subdevice_states));
        }
        smol::Timer::after(Duration::from_millis(2)).await;
    }
    r.case("OP", Ok(()));
    let sizes: Vec<_> = group
        .iter(m)
        .map(|s| (s.io_raw().outputs().len(), s.io_raw().inputs().len()))
        .collect();
    r.case("sizes", same("sizes", sizes, SLAVES.iter().map(|s| (s.3, s.4)).collect()));

    // LRW: a slave counts 2 for its outputs and 1 for its inputs
    let wkc: u16 = SLAVES.iter().map(|s| 2 * (s.3 > 0) as u16 + (s.4 > 0) as u16).sum();
    let mut counters = Ok(());
    let mut wires = Ok(());
    for value in [1u8, 0, 3, 2, 0] {
        group.subdevice(m, DO1).map_err(text)?.outputs_raw_mut()[0] = value;
        for _ in 0..20 {
            let t = group.tx_rx(m).await.map_err(text)?;
            if counters.is_ok() {
                counters = same("working counter", t.working_counter, wkc);
            }
            smol::Timer::after(Duration::from_millis(1)).await;
        }
        let back = group.subdevice(m, DI1).map_err(text)?.inputs_raw()[0];
        if wires.is_ok() {
            wires = same("inputs", back & 3, value);
        }
    }
    r.case("working counters", counters);
    r.case("outputs come back as inputs", wires);
    let group = group.into_safe_op(m).await.map_err(text)?;
    let group = group.into_pre_op(m).await.map_err(text)?;
    group.into_init(m).await.map_err(text)?;
    Ok(())
}

fn main() {
    let interface = std::env::args().nth(1).expect("an interface");
    let mut r = Results { passed: 0, failed: 0 };
    smol::block_on(async {
        let (tx, rx, pdu_loop) = STORAGE.try_split().expect("split once");
        let m = MainDevice::new(
            pdu_loop,
            Timeouts {
                // a busy host stops both ends for longer than the defaults (EEPROM: 10 ms)
                pdu: Duration::from_millis(200),
                eeprom: Duration::from_secs(2),
                wait_loop_delay: Duration::from_millis(1),
                mailbox_echo: Duration::from_secs(2),
                mailbox_response: Duration::from_secs(2),
                state_transition: Duration::from_secs(10),
                ..Default::default()
            },
            MainDeviceConfig::default(),
        );
        smol::spawn(ethercrab::std::tx_rx_task(&interface, tx, rx).expect("interface")).detach();
        let group = match m.init_single_group::<MAX_SLAVES, MAX_PDI>(ethercat_now).await {
            Ok(g) => g,
            Err(e) => return r.case("scan to PREOP", Err(text(e))),
        };
        r.case("scan to PREOP: identities", identities(&group, &m));
        r.case("delays", delays(&group, &m));
        r.case("SDOs", sdos(&group, &m).await);
        r.case("refused SDOs", refusals(&group, &m).await);
        r.case("object dictionary", dictionary(&group, &m).await);
        let end = operation(group, &m, &mut r).await;
        r.case("OP and back to INIT", end);
    });
    println!("{} passed, {} failed", r.passed, r.failed);
    std::process::exit((r.failed != 0) as i32);
}
