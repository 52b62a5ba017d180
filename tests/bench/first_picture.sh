#!/bin/sh
# How long a new user waits for the first picture: two commands, `git clone` and `make run`, in a
# folder of their own and with empty caches of packages.
#
#   tests/bench/first_picture.sh [REPOSITORY]       # this one, if none is named
#
# What apt installs is only timed where it is missing: on a machine that has it, say so with the
# figure, or run this in a fresh Debian (`docker run --rm -v "$PWD":/sparge:ro debian:12 sh -c
# 'apt-get update && apt-get install -y git make python3 && /sparge/tests/bench/first_picture.sh'`).
set -eu
repository=${1:-$(cd "$(dirname "$0")/../.." && pwd)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export UV_CACHE_DIR="$folder/uv" PIP_CACHE_DIR="$folder/pip" HOME="$folder"
git config --global --add safe.directory '*'

begin=$(date +%s)
git clone --quiet "$repository" "$folder/sparge"
cloned=$(date +%s)
make --no-print-directory -C "$folder/sparge" run
end=$(date +%s)

picture="$folder/sparge/out/grasp.png"
[ -s "$picture" ] || { echo "first_picture: there is no $picture" >&2; exit 1; }
echo
echo "first picture after $((end - begin)) s: git clone $((cloned - begin)) s, make run $((end - cloned)) s"
echo "$(nproc) processors, load $(cut -d' ' -f1 /proc/loadavg); .venv $(du -sm "$folder/sparge/.venv" | cut -f1) MB"
