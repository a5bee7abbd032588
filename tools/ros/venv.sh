#!/bin/sh
# Make .ros-venv: ROS 2 as wheels, and the interfaces of tools/ros/interfaces, for the tests of the
# ROS links. It is never part of .venv: its packages change how Python starts. Prints the path of
# its Python; a second call with the same inputs is done at once.
self=$(readlink -f -- "$0")
root=${self%/tools/ros/venv.sh}
venv=$root/.ros-venv stamp=$root/.ros-venv/hrcplan-stamp here=$root/tools/ros
unset VIRTUAL_ENV PYTHONHOME PYTHONPATH LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE
say() { printf 'hrcplan: %s\n' "$*" >&2; }

python=${HRCPLAN_PYTHON:-python3}
version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])') || exit 1
inputs() {
    printf '%s %s\n' "$root" "$version"
    (cd "$here" && find . -type f ! -name '*.pyc' | sort | xargs sha256sum)
}
install() {
    say "installing ROS 2 into .ros-venv; this takes a minute"
    rm -rf "$venv" && "$python" -m venv "$venv" || return 1
    # The hashes are those of wheels for Python 3.11; other versions are pinned without them.
    wanted=$here/requirements.txt hashes=--require-hashes
    if [ "$version" != 3.11 ]; then
        wanted=$venv/requirements.txt hashes=
        sed 's/ --hash=.*//' "$here/requirements.txt" >"$wanted" || return 1
    fi
    # shellcheck disable=SC2086
    env -u PIP_TARGET -u PIP_PREFIX PIP_USER=0 "$venv/bin/python" -m pip install -qq \
        --no-input --disable-pip-version-check --no-deps $hashes -r "$wanted" || return 1
    for package in "$here"/interfaces/*/; do
        "$venv/bin/python" "$here/build_interfaces.py" "$package" || return 1
    done
    inputs >"$stamp"
}
(
    flock 9
    [ "$(inputs)" = "$(cat "$stamp" 2>/dev/null)" ] || install
) 9>"$root/.ros-venv.lock" >&2 </dev/null || { say 'ROS 2 cannot be installed'; exit 1; }
printf '%s\n' "$venv/bin/python"
