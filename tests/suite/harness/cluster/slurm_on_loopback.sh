#!/bin/sh
# A SLURM of one node on this machine: munged, slurmctld and slurmd, on loopback only, without
# cgroups, accounting or systemd. Nothing outside FOLDER is touched, so it stands beside a real one.
#
#   slurm_on_loopback.sh FOLDER CONTROLLER_PORT NODE_PORT
#
# runs until its standard input is closed or it is told to end, and ends the three then. When
# FOLDER/ready is there, SLURM_CONF=FOLDER/slurm.conf sinfo, sbatch and squeue work. Debian's
# packages: munge slurm-wlm. Must be root: slurmd starts the jobs of any user.
set -eu
FOLDER=$1 CONTROLLER_PORT=$2 NODE_PORT=$3
PATH=$PATH:/usr/sbin
umask 022
mkdir -p "$FOLDER/state" "$FOLDER/spool" "$FOLDER/log"

# Who holds the key may speak to the daemons. munged wants nobody else to read or write around it.
mkdir -p -m 700 "$FOLDER/munge"
head -c 128 /dev/urandom > "$FOLDER/munge/key"
chmod 400 "$FOLDER/munge/key"

cat > "$FOLDER/slurm.conf" <<CONF
ClusterName=loopback
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$CONTROLLER_PORT
SlurmdPort=$NODE_PORT
# Bind to the addresses above and not to all interfaces.
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny,block_null_hash
AuthType=auth/munge
AuthInfo=socket=$FOLDER/munge/socket
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$FOLDER/state
SlurmdSpoolDir=$FOLDER/spool
SlurmctldPidFile=$FOLDER/slurmctld.pid
SlurmdPidFile=$FOLDER/slurmd.pid
SlurmctldLogFile=$FOLDER/log/slurmctld
SlurmdLogFile=$FOLDER/log/slurmd
# No cgroups: processes are told apart by their sessions.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdTimeout=60
KillWait=2
# More processors and memory than there are, so that several jobs fit on a small machine.
SlurmdParameters=config_overrides
NodeName=localhost NodeAddr=127.0.0.1 CPUs=16 RealMemory=100000 State=UNKNOWN
PartitionName=batch Nodes=localhost Default=YES MaxTime=INFINITE State=UP
CONF

PIDS=
end() {
    trap - EXIT INT TERM HUP
    for pid in $PIDS; do kill "$pid" 2>/dev/null || true; done
    for pid in $PIDS; do wait "$pid" 2>/dev/null || true; done
    rm -f "$FOLDER/ready"
}
trap end EXIT
trap 'exit 1' INT TERM HUP

munged --foreground --force --key-file="$FOLDER/munge/key" --socket="$FOLDER/munge/socket" \
    --pid-file="$FOLDER/munge/pid" --log-file="$FOLDER/log/munged" \
    --seed-file="$FOLDER/munge/seed" > "$FOLDER/log/munged.out" 2>&1 &
PIDS="$!"
until [ -S "$FOLDER/munge/socket" ]; do
    kill -0 "$!" || { cat "$FOLDER/log/munged.out" >&2; exit 1; }
    sleep 0.1
done
export SLURM_CONF="$FOLDER/slurm.conf"
slurmctld -D -c > "$FOLDER/log/slurmctld.out" 2>&1 &
PIDS="$! $PIDS"
slurmd -D -c -N localhost > "$FOLDER/log/slurmd.out" 2>&1 &
PIDS="$! $PIDS"
tries=0
until sinfo --noheader --format=%t 2>/dev/null | grep -q idle; do
    tries=$((tries + 1))
    [ $tries -lt 300 ] || { echo "the node is not idle after 300 looks" >&2; exit 1; }
    for pid in $PIDS; do
        kill -0 "$pid" 2>/dev/null || { cat "$FOLDER"/log/*.out >&2; exit 1; }
    done
    sleep 0.2
done
echo "$PIDS" > "$FOLDER/ready"
# Until whoever started this is gone, or has enough.
cat > /dev/null
