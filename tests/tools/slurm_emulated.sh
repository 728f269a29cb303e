# Slurm on this machine alone: a controller and four emulated nodes n1 .. n4, with a munge of their own, all in one
# folder. Sourced; the caller calls slurm_start FOLDER and, however it ends, slurm_stop.

# Says why Slurm cannot run here; silent where it can.
slurm_missing() {
  local program
  [ "$(id -u)" -eq 0 ] || { echo "the emulated nodes need root"; return; }
  for program in munged slurmctld slurmd sbatch scontrol squeue sinfo; do
    command -v $program >/dev/null 2>&1 || { echo "$program is missing: tools/setup --all installs it"; return; }
  done
}

# Four ports that nobody listens on, and one more for the controller.
slurm_free_port() { # FIRST COUNT
  local port=$1
  while (: </dev/tcp/127.0.0.1/"$port") 2>/dev/null; do ((port += 10)); done
  echo "$port"
}

slurm_conf() { # FOLDER
  local base
  base=$(slurm_free_port $((20000 + $$ % 20000)))
  cat <<CONF
ClusterName=emulated
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# The hold of a requeued task is the life of its credential: two minutes unless said otherwise.
AuthInfo=socket=$1/munge.socket,cred_expire=15
CredType=cred/munge
SlurmctldPort=$base
SlurmctldPidFile=$1/slurmctld.pid
SlurmdPidFile=$1/slurmd-%n.pid
SlurmctldLogFile=$1/slurmctld.log
SlurmdLogFile=$1/slurmd-%n.log
StateSaveLocation=$1/state
SlurmdSpoolDir=$1/spool/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmdTimeout=10
JobRequeue=1
SlurmdParameters=config_overrides
NodeName=n[1-4] NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=[$((base + 1))-$((base + 4))] CPUs=1 RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=n[1-4] Default=YES MaxTime=INFINITE State=UP
CONF
}

slurm_start() { # FOLDER
  local node
  chmod 755 "$1"
  mkdir -p "$1/state" "$1/spool/n1" "$1/spool/n2" "$1/spool/n3" "$1/spool/n4"
  (umask 077 && head -c 128 /dev/urandom >"$1/munge.key")
  munged --force --socket="$1/munge.socket" --key-file="$1/munge.key" --log-file="$1/munged.log" \
    --pid-file="$1/munged.pid" --seed-file="$1/munged.seed" >"$1/munged.out" 2>&1 || { cat "$1/munged.out"; return 1; }
  slurm_conf "$1" >"$1/slurm.conf"
  export SLURM_CONF=$1/slurm.conf
  slurmctld -f "$SLURM_CONF" || return 1
  for node in n1 n2 n3 n4; do slurmd -N $node -f "$SLURM_CONF" || return 1; done
  for _ in $(seq 120); do
    [ "$(sinfo -h -o %T -N 2>/dev/null | grep -c idle)" -eq 4 ] && return 0
    sleep 0.5
  done
  echo "the four nodes did not come up"
  return 1
}

# Everything that has the folder's name in its command line or its pid file there: never by a program's name alone.
slurm_stop() { # FOLDER
  local file
  [ -d "$1" ] || return 0
  [ -n "${SLURM_CONF:-}" ] && scancel --full --user=root >/dev/null 2>&1
  sleep 0.5
  for file in "$1"/slurmd-*.pid "$1"/slurmctld.pid "$1"/munged.pid; do
    [ -s "$file" ] && kill "$(cat "$file")" 2>/dev/null
  done
  sleep 1
  for file in "$1"/slurmd-*.pid "$1"/slurmctld.pid "$1"/munged.pid; do
    [ -s "$file" ] && kill -9 "$(cat "$file")" 2>/dev/null
  done
  return 0
}

# Power failure of one node: its slurmd, every step's shepherd and all they started, with signal 9. A task whose shepherd
# lives on would be reported as failed and not be requeued: the shepherds go first.
slurm_kill_node() { # FOLDER NODE
  local daemon shepherd
  daemon=$(cat "$1/slurmd-$2.pid")
  for shepherd in $(slurm_shepherds "$1" "$2"); do
    kill -9 $shepherd $(slurm_descendants $shepherd) 2>/dev/null
  done
  kill -9 "$daemon"
}

slurm_descendants() { # PID
  local child
  for child in $(pgrep -P "$1"); do echo "$child"; slurm_descendants "$child"; done
}

# The shepherds (slurmstepd) whose spool folder is this node's.
slurm_shepherds() { # FOLDER NODE
  local pid
  for pid in $(pgrep slurmstepd); do
    ls -l "/proc/$pid/fd" "/proc/$pid/cwd" 2>/dev/null | grep -q "$1/.*$2" && echo "$pid"
  done
}
