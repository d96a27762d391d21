#!/usr/bin/env bash
# slurm_cluster.sh DIR: a Slurm of one machine for tests: munged, slurmctld and slurmd with all state in
# DIR, then the line "ready". Ends all of it, jobs included, when its standard input is closed. Needs
# root, but neither systemd nor cgroups. Prints "cannot: why" where it cannot start.
set -u
PATH=$PATH:/usr/sbin:/sbin
dir=$1
cannot() { echo "cannot: $*"; exit 0; }
[ "$(id -u)" = 0 ] || cannot "Slurm's daemons start only as root"
for program in munged slurmctld slurmd; do
  command -v "$program" >/dev/null || cannot "$program is not installed"
done
mkdir -p "$dir"/{munge,state,spool,log}
chmod 755 "$dir"
chmod 700 "$dir/munge"
head -c 1024 /dev/urandom >"$dir/munge/key"
chmod 400 "$dir/munge/key"

is_open() { (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }
port=$((21000 + $$ % 8000 * 2))
while is_open "$port" || is_open $((port + 1)); do port=$((port + 2)); done
host=$(hostname -s)
cat >"$dir/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/log/slurmctld
SlurmdLogFile=$dir/log/slurmd
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
KillWait=2
MpiDefault=none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$dir/slurm.conf

stop() {
  scancel --user=root 2>/dev/null
  for _ in {1..50}; do [ -z "$(squeue --noheader 2>/dev/null)" ] && break; sleep 0.1; done
  for file in slurmd.pid slurmctld.pid munge/pid; do
    [ -s "$dir/$file" ] && kill "$(cat "$dir/$file")" 2>/dev/null
  done
}
trap stop EXIT
munged --force --key-file="$dir/munge/key" --socket="$dir/munge.socket" \
  --pid-file="$dir/munge/pid" --log-file="$dir/munge/log" --seed-file="$dir/munge/seed" </dev/null \
  >"$dir/log/munged.start" 2>&1 || cannot "munged: $(tail -n 1 "$dir/log/munged.start")"
slurmctld -f "$SLURM_CONF" </dev/null >"$dir/log/slurmctld.start" 2>&1 ||
  cannot "slurmctld: $(tail -n 1 "$dir/log/slurmctld.start")"
slurmd -f "$SLURM_CONF" </dev/null >"$dir/log/slurmd.start" 2>&1 ||
  cannot "slurmd: $(tail -n 1 "$dir/log/slurmd.start")"
for _ in {1..100}; do
  state=$(sinfo --noheader --format=%T 2>/dev/null)
  [ "$state" = idle ] && break
  sleep 0.1
done
[ "$state" = idle ] || cannot "its node is ${state:-unknown}"
echo ready
cat >/dev/null
