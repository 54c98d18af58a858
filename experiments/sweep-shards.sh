#!/bin/sh
# Spreads a sweep over processes, and joins the parts:
#
#   experiments/sweep-shards.sh FILE DIR N
#
# - Alone it runs all N shards at once on this machine (with GNU parallel, where that is installed) and merges them
#   into DIR. N processes of one thread each.
# - As a task of a Slurm array (SLURM_ARRAY_TASK_ID is set, 1 to N) it runs that one shard; afterwards:
#   pxpl5 merge DIR/shard-* --out DIR
#
# Interrupted, it may be started again: finished points are kept. PXPL5 names the command, if it is not in the path.
set -eu

if [ $# -ne 3 ]; then
    echo "usage: $0 FILE DIR N" >&2
    exit 2
fi
file=$1 dir=$2 shards=$3
pxpl5=${PXPL5:-pxpl5}

shard() {
    "$pxpl5" sweep "$file" --out "$dir/shard-$1" --shard "$1/$shards" --threads "${2:-1}" --resume --quiet
}

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    shard "$SLURM_ARRAY_TASK_ID" "${SLURM_CPUS_PER_TASK:-1}"
    exit
fi

if command -v parallel >/dev/null 2>&1; then
    seq "$shards" | parallel "$pxpl5" sweep "$file" --out "$dir/shard-{}" --shard "{}/$shards" --threads 1 --resume --quiet
else
    pids=
    for i in $(seq "$shards"); do
        shard "$i" &
        pids="$pids $!"
    done
    for pid in $pids; do
        wait "$pid"
    done
fi
"$pxpl5" merge "$dir"/shard-* --out "$dir" --quiet
