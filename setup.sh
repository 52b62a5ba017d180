#!/bin/sh
# Set this checkout up: system libraries, then .venv from the hashed lock. Run by `make setup`.
# `./setup.sh dev` adds what tests, style, documentation and a browser to test with need.
# Does nothing when everything is already there.
set -eu
cd "$(dirname "$0")"

want=${1:-run}
case $want in run | dev) ;; *) printf 'usage: setup.sh [dev]\n' >&2; exit 2 ;; esac

say() { printf 'setup: %s\n' "$*"; }
fail() { printf 'setup: %s\n' "$*" >&2; exit 1; }

find_python() {
    for name in python3.11 python3.12 python3; do
        if command -v "$name" >/dev/null 2>&1 &&
            "$name" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 13))'; then
            command -v "$name"
            return
        fi
    done
}

has_library() { ldconfig -p 2>/dev/null | grep -q "$1" || /sbin/ldconfig -p 2>/dev/null | grep -q "$1"; }

# What the libraries need from the system, by what is really missing.
missing=""
python=$(find_python)
[ -n "$python" ] || missing="$missing python3"
if [ -z "$python" ] || ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    missing="$missing python3-venv"
fi
command -v swipl >/dev/null 2>&1 || missing="$missing swi-prolog-nox"
has_library libusb-1.0.so.0 || missing="$missing libusb-1.0-0"
has_library libGL.so.1 || missing="$missing libgl1"
has_library libEGL.so.1 || missing="$missing libegl1"
has_library libgomp.so.1 || missing="$missing libgomp1"
if [ "$want" = dev ]; then
    command -v chromium >/dev/null 2>&1 || missing="$missing chromium"
fi

if [ -n "$missing" ]; then
    install="apt-get install -y --no-install-recommends$missing"
    command -v apt-get >/dev/null 2>&1 ||
        fail "these Debian packages are missing, and this system has no apt-get:$missing"
    if [ "$(id -u)" = 0 ]; then sudo=""
    elif sudo -n true 2>/dev/null; then sudo="sudo"
    else fail "system packages are missing and I may not install them. Please run
    sudo $install
and try again."
    fi
    say "installing$missing"
    log=$(mktemp)
    $sudo apt-get update -qq >"$log" 2>&1 || true
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive $sudo $install -qq >>"$log" 2>&1 ||
        { cat "$log" >&2; fail "apt-get failed; see above"; }
    rm -f "$log"
    python=$(find_python)
    [ -n "$python" ] || fail "SPaRGE needs Python 3.11 or 3.12; found none"
fi

# The virtual environment: made anew when the interpreter or its place changed, brought to the
# lock when that did. What `dev` installed serves `run` as well.
uv() {
    # uv doesn't read pip's settings; an index of one's own is the one that matters.
    index=$(.venv/bin/python -m pip config get global.index-url 2>/dev/null || true)
    UV_DEFAULT_INDEX="${UV_DEFAULT_INDEX:-${index:-https://pypi.org/simple}}" \
        .venv/bin/uv pip --quiet --no-progress "$@" --python .venv/bin/python
}
stamp=.venv/.installed
base="$("$python" -V) in $PWD"
state() { echo "$base: $1 $(cat requirements*.lock pyproject.toml | cksum)"; }
found=$(cat "$stamp" 2>/dev/null || true)
if [ "$found" != "$(state "$want")" ] && [ "$found" != "$(state dev)" ]; then
    lock=requirements.lock
    [ "$want" = run ] || lock=requirements-dev.lock
    say "installing $lock into .venv ($("$python" -V))"
    case $found in "$base: "*) ;; *) rm -rf .venv && "$python" -m venv .venv ;; esac
    .venv/bin/python -m pip install --quiet --disable-pip-version-check \
        --no-deps --require-hashes -r requirements-setup.lock
    uv sync --require-hashes "$lock"
    uv install --no-deps --no-build-isolation --editable .
    state "$want" >"$stamp"
    say "done"
fi
