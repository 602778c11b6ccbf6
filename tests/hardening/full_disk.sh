#!/bin/sh
# A real disk that fills up (a tmpfs; needs root): full_disk.sh CAMPAIGN.yaml
# Ingests onto ever larger disks. Each time: the exit code, what is said, and whether the store is whole.
set -u
here=$(cd "$(dirname "$0")" && pwd)
campaign=$1
disk=$(mktemp -d)
said=$(mktemp)
trap 'umount "$disk" 2>/dev/null; rmdir "$disk"; rm -f "$said"' EXIT
for size in ${SIZES:-1500k 3m 6m 12m 24m 200m}; do
    mount -t tmpfs -o size="$size" none "$disk" || exit 1
    thermodata --store "$disk/store" ingest "$campaign" >/dev/null 2>"$said"
    code=$?
    echo "disk $size: exit code $code $(head -3 "$said" | tr '\n' ' ')"
    if [ -e "$disk/store/catalog.duckdb" ]; then
        python - "$here" "$disk/store" <<'PYTHON'
import sys
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import whole

counts = whole.check(Path(sys.argv[2]))
print(f"    whole: {counts['sample']} samples, left over: {whole.left_over(Path(sys.argv[2])) or 'nothing'}")
PYTHON
        mount -o remount,size=1g "$disk"
        thermodata --store "$disk/store" ingest "$campaign" >/dev/null 2>&1
        echo "    with room: exit code $?"
    fi
    umount "$disk"
done
