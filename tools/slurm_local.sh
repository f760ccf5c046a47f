#!/usr/bin/env bash
# A Slurm cluster of one machine for as long as a command runs, by any user, without systemd: controller, nodes and
# authentication are children of this script, all of their files lie in one temporary folder.
#
#   tools/slurm_local.sh [-n NODES] -- COMMAND...      # packages slurm-wlm and munge; nodes have one core each
#
# The exit code is the command's; 77 when Slurm is not there.
set -euo pipefail

nodes=2
if [ "${1:-}" = -n ]; then
  nodes=$2
  shift 2
fi
[ "${1:-}" != -- ] || shift
[ $# -gt 0 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 2; }

PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd sbatch squeue sinfo; do
  command -v "$program" >/dev/null || { echo "slurm_local: no $program (packages slurm-wlm, munge)" >&2; exit 77; }
done

home=$(mktemp -d "${TMPDIR:-/tmp}/slurm-local-XXXXXX")
host=$(hostname -s)
user=$(id -un)
# munged refuses a folder that others may write to, slurmd one that it does not own.
chmod 755 "$home"
mkdir -p "$home"/run "$home"/state "$home"/spool "$home"/log

daemons=()
finish() {
  local code=$?
  trap - EXIT
  [ ${#daemons[@]} -eq 0 ] || kill "${daemons[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  if [ "$code" -ne 0 ] && [ "${ready:-no}" = no ]; then tail -n 20 "$home"/log/*.log >&2 || true; fi
  rm -rf "$home"
  exit "$code"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# A port of its own, so that two clusters do not meet: the first of a block that nobody listens on.
port=
for try in $(seq 20); do
  candidate=$((20000 + (RANDOM % 2000) * 10))
  if ! (exec 3<>"/dev/tcp/127.0.0.1/$candidate") 2>/dev/null; then port=$candidate; break; fi
done
[ -n "$port" ] || { echo "slurm_local: no free port after $try tries" >&2; exit 1; }

(umask 077 && head -c 1024 /dev/urandom >"$home/run/munge.key")
{
  cat <<CONF
ClusterName=local
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$home/run/munge.socket
SlurmctldPort=$port
StateSaveLocation=$home/state
SlurmdSpoolDir=$home/spool/%n
SlurmctldPidFile=$home/run/slurmctld.pid
SlurmdPidFile=$home/run/slurmd.%n.pid
SlurmctldLogFile=$home/log/slurmctld.log
SlurmdLogFile=$home/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=sched_min_interval=100000
SlurmdParameters=config_overrides
ReturnToService=2
CONF
  for i in $(seq "$nodes"); do
    echo "NodeName=n$i NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + i)) CPUs=1 RealMemory=1000 State=UNKNOWN"
    mkdir "$home/spool/n$i"
  done
  echo "PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP"
} >"$home/slurm.conf"
export SLURM_CONF=$home/slurm.conf

munged -F -f --key-file="$home/run/munge.key" --socket="$home/run/munge.socket" --pid-file="$home/run/munged.pid" \
  --log-file="$home/log/munged.log" --seed-file="$home/run/munged.seed" 2>"$home/log/munged.err.log" &
daemons+=($!)
for _ in $(seq 100); do
  [ ! -S "$home/run/munge.socket" ] || break
  sleep 0.05
done
slurmctld -D -c -f "$SLURM_CONF" >/dev/null 2>&1 &
daemons+=($!)
for i in $(seq "$nodes"); do
  slurmd -D -c -N "n$i" -f "$SLURM_CONF" >/dev/null 2>&1 &
  daemons+=($!)
done

idle() { timeout 5 sinfo --noheader --states=idle --format=%D 2>/dev/null || echo 0; }
for _ in $(seq 150); do
  [ "$(idle)" != "$nodes" ] || { ready=yes; break; }
  sleep 0.1
done
[ "${ready:-no}" = yes ] || { echo "slurm_local: the nodes did not come up" >&2; exit 1; }
"$@"
