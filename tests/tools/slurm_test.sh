#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# cases/mixer/slurm/mixer.sbatch on a Slurm of one node, made in a temporary folder and taken down again, at small size:
# a whole run; a run put back into the queue that goes on from its restart; bad input. Opt-in, needs root:
#   tests/tools/slurm_test.sh [BIN]      BIN: folder of our liggghts, default build/bin
# Packages: scripts/install-packages slurm campaign
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=$(cd "${1:-build/bin}" 2>/dev/null && pwd) || { echo "slurm_test: no folder ${1:-build/bin}" >&2; exit 2; }
for program in munged slurmctld slurmd sbatch; do
  PATH=$PATH:/usr/sbin command -v $program >/dev/null || { echo "slurm_test: no $program; scripts/install-packages slurm" >&2; exit 2; }
done
[ "$(id -u)" -eq 0 ] || { echo "slurm_test: a Slurm of our own needs root" >&2; exit 2; }
export PATH=$bin:$PATH:/usr/sbin OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# a munged starts only where nobody else may write
work=$(mktemp -d /run/vielto-slurm-XXXXXX)
pids=()
cleanup() {
  status=$?
  [ $status -eq 0 ] || tail -n 15 "$work"/*.log "$work"/mixer/*.log >&2 2>/dev/null || true
  scancel --user=root 2>/dev/null || true
  for ((i = ${#pids[@]} - 1; i >= 0; i--)); do kill "${pids[i]}" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT

mkdir -p "$work"/{munge,state,spool}
chmod 700 "$work/munge"
chmod 711 "$work"
dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 status=none
chmod 400 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munged.log" --seed-file="$work/munge/seed" >/dev/null 2>&1 &
pids+=($!)
host=$(hostname -s)
port=$((20000 + RANDOM % 10000))
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/linear
SchedulerParameters=sched_interval=1
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE
CONF
export SLURM_CONF=$work/slurm.conf
for _ in $(seq 50); do [ -S "$work/munge/socket" ] && break; sleep 0.2; done
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" >"$work/slurmd.log" 2>&1 &
pids+=($!)
for _ in $(seq 100); do sinfo -h -o %t 2>/dev/null | grep -q idle && break; sleep 0.5; done
sinfo -h -o %t | grep -q idle || { echo "slurm_test: the node did not come up" >&2; exit 1; }
echo "Slurm of one node is up"

# the case's own files, so that the source folder stays clean; its paths lead to materials/
mkdir -p "$work/mixer/a"
cp -r cases/{law.par,card.par,law.in,drag.in,engine.in,filling.in} "$work"
cp -r cases/mixer/{in.mixer,bed.in,mixer.par,slurm} "$work/mixer"
cd "$work/mixer"
small=(-var materials "$OLDPWD/materials" -var slicePaddles 4 -var fill 0.03 -var grainDiameter 0.014 -var youngsModulus 5e5
  -var wall_youngsModulus 5e5 -var settleTime 0.25 -var rowsPerTurn 360)
submit() { sbatch --parsable --ntasks=2 --time=60 slurm/mixer.sbatch "$@"; }
finish() { # JOB SECONDS: wait until it has left the queue
  for _ in $(seq "$2"); do
    state=$(scontrol show job "$1" -o | sed 's/.*JobState=\([A-Z_]*\).*/\1/')
    case $state in COMPLETED | FAILED | CANCELLED | TIMEOUT | NODE_FAIL) return 0 ;; esac
    sleep 1
  done
  echo "slurm_test: job $1 is still $state after $2 s" >&2
  exit 1
}
rows() { grep -vc '^[#s]' "$1/torque.csv"; }
expect() { [ "$2" = "$3" ] || { echo "slurm_test: $1 is '$2' instead of '$3'" >&2; exit 1; }; }

job=$(submit results/whole "${small[@]}" -var turns 0.05)
finish "$job" 900
expect "state of the whole run" "$state" COMPLETED
expect "rows of the whole run" "$(rows results/whole)" 18
echo "a whole run: done"

job=$(submit results/twice "${small[@]}" -var turns 0.2)
for _ in $(seq 900); do ls results/twice.partial/restart/*.restart >/dev/null 2>&1 && break; sleep 1; done
scontrol requeue "$job"
sleep 2
scontrol update JobId="$job" StartTime=now 2>/dev/null || true
finish "$job" 900
expect "state of the run put back" "$state" COMPLETED
expect "rows of the run put back" "$(rows results/twice)" 72
expect "starts of it" "$(grep -c 'on 2 ranks' mixer-"$job".log)" 2
expect "resumed starts of it" "$(grep -c 'resume yes' mixer-"$job".log)" 1
echo "a run put back into the queue: goes on"

job=$(submit results/whole "${small[@]}")
finish "$job" 120
expect "state of a run that is complete" "$state" COMPLETED
job=$(submit results/bad -var speed -1 "${small[@]}")
finish "$job" 120
expect "state of a run with bad input" "$state" FAILED
grep -q 'speed is -1' mixer-"$job".log || { echo "slurm_test: the log does not say what is wrong" >&2; exit 1; }
job=$(submit)
finish "$job" 60
expect "state of a job without a run folder" "$state" FAILED
grep -q 'no run folder' mixer-"$job".log
echo "bad input: refused"

# a campaign through the profile: two jobs, one of which fails
cat >"$work/study.csv" <<'CSV'
run,rig,speed,fill,grainDiameter,youngsModulus,wall_youngsModulus,maxOverlap,settleTime,turns
whole,mixer,1.5,0.05,0.016,2e5,2e5,0.2,0.2,3
bad,mixer,-1,0.05,0.016,2e5,2e5,0.2,0.2,3
CSV
cd "$OLDPWD"
if scripts/campaign "$work/study.csv" --out "$work/study" --bin "$bin" --slurm --every 5 >"$work/campaign.log" 2>&1; then
  echo "slurm_test: a campaign with a failing run ends well" >&2
  exit 1
fi
[ -d "$work/study/runs/whole" ] || { cat "$work/study/snakemake.log" >&2; exit 1; }
[ -f "$work/study/observations.csv" ] && { echo "slurm_test: a table without one of its runs" >&2; exit 1; }
scripts/table select "$work/study.csv" --without run=bad --out "$work/study.csv"
scripts/campaign "$work/study.csv" --out "$work/study" --bin "$bin" --slurm --every 5 >"$work/campaign.log" 2>&1 || { cat "$work/study/snakemake.log" >&2; exit 1; }
grep -q ^whole, "$work/study/observations.csv"
echo "a campaign: jobs, a failing one, the table"
