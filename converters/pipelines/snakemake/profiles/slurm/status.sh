#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# State of a job as Snakemake asks for it: running, success or failed.
answer=$(scontrol show job "$1" --oneliner 2>&1)
state=$(printf '%s' "$answer" | sed -n 's/.* JobState=\([A-Z_]*\) .*/\1/p')
case "$answer" in
  *"Invalid job id"*)
    # Slurm forgets jobs after some minutes, its accounts do not
    state=$(sacct --jobs "$1" --noheader --parsable2 --format=State 2>/dev/null | head -n 1)
    [ -n "$state" ] || state=FORGOTTEN
    ;;
esac
case "$state" in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | RESIZING | PREEMPTED | "") echo running ;;
  *) echo failed ;;
esac
