#!/bin/sh
# Leave a background child behind that holds stdout open, and exit at once.
sh -c 'while :; do sleep 1; done' "$1" &
echo done
