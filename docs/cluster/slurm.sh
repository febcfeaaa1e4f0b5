#!/usr/bin/env bash
# A job in shards on a Slurm cluster whose machines share a file system: one task of an array renders one shard, a job after it merges them.
#
#   shards=$(sbatch --parsable --array=0-15 --cpus-per-task=8 slurm.sh JOB.toml OUT --frames 0..20)
#   sbatch --dependency=afterok:$shards slurm.sh JOB.toml OUT
#
# What stands after OUT goes to `etendue render`. OUT/.shards holds the shards until they are merged; a task that is requeued or repeated renders its shard
# anew. ETENDUE is the program [default: etendue].
#SBATCH --job-name=etendue
#SBATCH --requeue
set -euo pipefail

refuse() {
    echo "error: $1" >&2
    exit 2
}

[ $# -ge 2 ] || refuse "expected JOB.toml OUT, and then options of etendue render"
job=$1 out=$2
shift 2
[ -f "$job" ] || refuse "$job: there is no such job file"
case $out in -*) refuse "expected an output folder after the job, not '$out'" ;; esac
for option; do
    case $option in
    -o | -o* | --output* | --shard | --shard=* | --film | --film=* | --overwrite | --resume | --progressive | --time | --time=* | --threads | --threads=*)
        refuse "$option: this script decides it; leave it out" ;;
    esac
done
program=${ETENDUE:-etendue}
command -v "$program" >/dev/null || refuse "$program: there is no such program; name it by ETENDUE"

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    count=${SLURM_ARRAY_TASK_COUNT:?}
    [ "${SLURM_ARRAY_TASK_MIN:?}" = 0 ] && [ "${SLURM_ARRAY_TASK_MAX:?}" = $((count - 1)) ] || refuse "the array is not 0 to N - 1; give --array=0-N"
    exec "$program" render "$job" -o "$out/.shards/$SLURM_ARRAY_TASK_ID" --overwrite --shard "$SLURM_ARRAY_TASK_ID/$count" \
        --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
fi
[ $# = 0 ] || refuse "$1: the shards know their options; give the merge none"
[ -d "$out/.shards" ] || refuse "$out/.shards: there are no shards; submit the array first (--array=0-N)"
"$program" merge "$out"/.shards/* -o "$out" --overwrite
rm -r "$out/.shards"
