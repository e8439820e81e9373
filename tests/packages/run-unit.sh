# SPDX-License-Identifier: GPL-2.0-only
#
# In the guest of run.sh: ethercat-run@.service, as Documentation/run.rst has it, with two masters.
# sh -eux; the masters are as before at the end.

wait_until() {
	n=0
	until eval "$1"; do
		n=$((n + 1))
		[ $n -lt 100 ]
		sleep 1
	done
}
refused() { if "$@"; then exit 1; fi; }
# slaves MASTER STATE NUMBER
slaves() { [ "$(ethercat slaves -m "$1" | grep -cw "$2")" = "$3" ]; }
# said UNIT TEXT: in its journal, which has it some time after the end of the program
said() { wait_until "journalctl -u $1 | grep -F \"$2\""; }

ethercatctl stop
cp /etc/ethercat.conf /tmp/one-master
printf '%s\n' 'MASTER0_DEVICE=sim0' 'MASTER1_DEVICE=sim1' 'SIM_SEGMENT=bench,three' \
	>/etc/ethercat.conf
systemctl restart ethercat
wait_until "slaves 0 PREOP 22 && slaves 1 PREOP 3"
mkdir -p /etc/ethercat
ethercat bus save --whole -m 0 /etc/ethercat/line.yaml
ethercat bus save --whole -m 1 /etc/ethercat/cell.yaml

# what others may write moves nothing
chmod g+w /etc/ethercat/cell.yaml
refused systemctl start ethercat-run@cell
said ethercat-run@cell "others may write to /etc/ethercat/cell.yaml (mode 664)"
slaves 1 PREOP 3
chmod g-w /etc/ethercat/cell.yaml

systemctl enable --now ethercat-run@cell ethercat-run@line
systemctl status ethercat-run@line
slaves 0 OP 22
slaves 1 OP 3
# a user of its own without a right but the priority, and no process that is left
said ethercat-run@line "Master0 runs: 22 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50"
said ethercat-run@cell "Master1 runs: 3 slave(s) in OP, cycle 1 ms, SCHED_FIFO 50"
uid=$(journalctl -u ethercat-run@line -o json | grep "Master0 runs" |
	sed -n 's/.*"_UID":"\([0-9]*\)".*/\1/p')
[ "$uid" -ge 61184 ] && [ "$uid" -le 65519 ]
[ -z "$(find /proc -maxdepth 1 -user "$uid")" ]
timeout 2 ethercat watch -m 0 "el1008.*" | grep -m 1 "el1008.channel_1.input = "
[ "$(timeout 2 ethercat watch -m 1 | grep -c " = ")" -ge 1 ]
# each stop ends its bus, also when the file is another one by then
cp /etc/ethercat/cell.yaml /tmp/cell.yaml
sed -i 's/index: 1/index: 0/' /etc/ethercat/cell.yaml
systemctl stop ethercat-run@cell
wait_until "slaves 1 PREOP 3"
slaves 0 OP 22
cp /tmp/cell.yaml /etc/ethercat/cell.yaml
systemctl start ethercat-run@cell
slaves 1 OP 3
# without the limit it runs and says so; without the group it does not
mkdir -p /run/systemd/system/ethercat-run@cell.service.d
systemctl stop ethercat-run@cell
printf '%s\n' '[Service]' LimitRTPRIO=0 >/run/systemd/system/ethercat-run@cell.service.d/a.conf
systemctl daemon-reload
systemctl start ethercat-run@cell
said ethercat-run@cell "SCHED_OTHER: no right to real-time priority (RLIMIT_RTPRIO)"
systemctl stop ethercat-run@cell
printf '%s\n' '[Service]' SupplementaryGroups= \
	"ExecStartPre=" >/run/systemd/system/ethercat-run@cell.service.d/a.conf
systemctl daemon-reload
refused systemctl start ethercat-run@cell
said ethercat-run@cell "Permission denied"
rm -r /run/systemd/system/ethercat-run@cell.service.d
systemctl daemon-reload
systemctl stop ethercat-run@line
wait_until "slaves 0 PREOP 22"
systemctl start ethercat-run@line
# a stop of the masters stops it before
systemctl stop ethercat
refused systemctl is-active ethercat-run@line
[ ! -e /dev/EtherCAT0 ]
systemctl disable ethercat-run@cell ethercat-run@line
systemctl reset-failed
rm -r /etc/ethercat
cp /tmp/one-master /etc/ethercat.conf
systemctl start ethercat
wait_until "slaves 0 PREOP 22"
