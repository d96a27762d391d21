#!/usr/bin/env bash
# slurm_cluster.sh DIR [NODES [CPUS]]: a Slurm of one machine for tests: munged, slurmctld and a slurmd for each of NODES (1)
# with CPUS (4), all state in DIR, then the line "ready". Ends all of it, jobs included, when its standard input is closed. Needs
# root, but neither systemd nor cgroups. Prints "cannot: why" where it cannot start. Several nodes are called node1, node2, ..;
# DIR/slurmd-node1.pid is the process of one, which may be killed; it is down SLURMD_TIMEOUT (300) seconds later. Jobs of the partition `urgent`
# preempt those of `all`, which are queued again.
set -u
PATH=$PATH:/usr/sbin:/sbin
dir=$1
nodes=${2:-1} cpus=${3:-4}
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
are_open() { for ((i = 0; i <= nodes; ++i)); do is_open $(($1 + i)) && return; done; return 1; }
port=$((21000 + $$ % 8000 * 2))
while are_open "$port"; do port=$((port + nodes + 1)); done
host=$(hostname -s)
names=$host
[ "$nodes" -gt 1 ] && names=$(for ((i = 1; i <= nodes; ++i)); do echo "node$i"; done)
cat >"$dir/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
SlurmctldPort=$port
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd-%n.pid
SlurmctldLogFile=$dir/log/slurmctld
SlurmdLogFile=$dir/log/slurmd-%n
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdTimeout=${SLURMD_TIMEOUT:-300}
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1,bf_hetjob_immediate
KillWait=2
MpiDefault=none
ReturnToService=2
$(at=$port; for name in $names; do
  at=$((at + 1))
  echo "NodeName=$name NodeHostname=$host NodeAddr=127.0.0.1 Port=$at CPUs=$cpus State=UNKNOWN"
done)
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP PriorityTier=1
PartitionName=urgent Nodes=ALL MaxTime=INFINITE State=UP PriorityTier=2
CONF
export SLURM_CONF=$dir/slurm.conf

stop() {
  scancel --user=root 2>/dev/null
  for _ in {1..50}; do [ -z "$(squeue --noheader 2>/dev/null)" ] && break; sleep 0.1; done
  for file in "$dir"/slurmd-*.pid "$dir"/slurmctld.pid "$dir"/munge/pid; do
    [ -s "$file" ] && kill "$(cat "$file")" 2>/dev/null
  done
}
trap stop EXIT
munged --force --key-file="$dir/munge/key" --socket="$dir/munge.socket" \
  --pid-file="$dir/munge/pid" --log-file="$dir/munge/log" --seed-file="$dir/munge/seed" </dev/null \
  >"$dir/log/munged.start" 2>&1 || cannot "munged: $(tail -n 1 "$dir/log/munged.start")"
slurmctld -f "$SLURM_CONF" </dev/null >"$dir/log/slurmctld.start" 2>&1 ||
  cannot "slurmctld: $(tail -n 1 "$dir/log/slurmctld.start")"
for name in $names; do
  mkdir -p "$dir/spool/$name"
  slurmd -f "$SLURM_CONF" -N "$name" </dev/null >"$dir/log/slurmd.start" 2>&1 ||
    cannot "slurmd: $(tail -n 1 "$dir/log/slurmd.start")"
done
for _ in {1..900}; do
  state=$(sinfo --noheader --format=%T 2>/dev/null | sort -u)
  [ "$state" = idle ] && break
  sleep 0.1
done
[ "$state" = idle ] || cannot "its nodes are" ${state:-unknown}
echo ready
cat >/dev/null
