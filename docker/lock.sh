#!/bin/sh
# Write the hashed dependency locks anew from pyproject.toml: `make lock`.
#   requirements.lock           everything for development and the embedded backend
#   requirements-training.lock  the same versions plus what retraining models needs
#   docker/locks/SERVICE.txt    what the image of one service installs, same versions
set -eu
cd "$(dirname "$0")/.."
services="perception primitive-recovery reasoning grasp-proposal matching execution gateway"
compile() {
    output=$1; shift
    CUSTOM_COMPILE_COMMAND="make lock" .venv/bin/pip-compile --quiet --generate-hashes \
        --allow-unsafe --strip-extras --no-emit-index-url --no-emit-find-links \
        --no-emit-trusted-host --output-file="$output" "$@" pyproject.toml
}
extras=$(for each in $services cli experiments annotate dev; do printf ' --extra %s' "$each"; done)
compile requirements.lock $extras
compile requirements-training.lock $extras --extra train --constraint requirements.lock
for each in $services; do
    compile "docker/locks/$each.txt" --extra "$each" --constraint requirements.lock
done
