#!/bin/sh
# Write the hashed dependency locks anew from pyproject.toml: `make lock`.
#   requirements-setup.lock     what setup.sh installs first: uv, and what builds this package
#   requirements.lock           the embedded backend and every command of the README
#   requirements-dev.lock       the same versions plus what tests, style and docs need
#   requirements-training.lock  the same again plus what retraining models needs
#   docker/locks/SERVICE.txt    what the image of one service installs, same versions
set -eu
cd "$(dirname "$0")/.."
services="perception primitive-recovery reasoning grasp-proposal matching execution gateway grpc"
compile() {
    output=$1; shift
    .venv/bin/uv pip compile --quiet --generate-hashes --universal --python-version 3.11 \
        --custom-compile-command "make lock" --output-file="$output" "$@"
}
extras() { for each in "$@"; do printf ' --extra %s' "$each"; done; }
run=$(extras setup $services tracing cli annotate view mcp experiments)
dev=$(extras docs dev)
compile requirements.lock $run pyproject.toml
printf 'editables\nhatchling\nuv\n' | compile requirements-setup.lock --constraint requirements.lock -
compile requirements-dev.lock $run $dev --constraint requirements.lock pyproject.toml
compile requirements-training.lock $run $dev --extra train --constraint requirements-dev.lock \
    pyproject.toml
for each in $services; do
    compile "docker/locks/$each.txt" --extra "$each" --extra tracing \
        --constraint requirements.lock pyproject.toml
done
