#!/bin/sh
# Install what the tests of pages in a browser need, and print the path of the browser:
#   tools/browser.sh PYTHON
# PYTHON gets the package playwright. The browser is Debian's Chromium where that is installed or can
# be (as root); elsewhere playwright's own, and then nothing is printed.
self=$(readlink -f -- "$0")
root=${self%/*/*}
find_browser() { command -v chromium || command -v chromium-browser || command -v google-chrome; }

{
    "$1" -m pip install --no-input --disable-pip-version-check -q -c "$root/constraints.txt" playwright ||
        exit 1
    if ! find_browser; then
        if [ "$(id -u)" = 0 ] && command -v apt-get; then
            apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq chromium
        fi
        find_browser || "$1" -m playwright install chromium || exit 1
    fi
} >&2
find_browser || true
