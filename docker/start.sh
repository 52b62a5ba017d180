#!/bin/sh
# The images' entry point: the root file system may be read-only, and numba writes to its cache.
# exec: the server itself gets SIGTERM and ends in good order.
set -eu
if [ -n "$(ls -A "$KERNELS")" ] && cp -R "$KERNELS" /tmp/kernels 2>/dev/null; then
    export NUMBA_CACHE_DIR=/tmp/kernels
fi
exec "$@"
