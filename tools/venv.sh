# Sourced by the launchers: `need_venv EXTRAS` returns once $root/.venv holds the project with
# these extras (with commas between). Everything said here goes to stderr, and nothing here touches the caller's folder.
# Before sourcing, the launcher sets $root to the checkout, symbolic links resolved.

venv=$root/.venv
stamp=$venv/hrcplan-stamp    # written last: the extras, then the hashes and places of the inputs
owner=$venv/hrcplan-checkout # written first: whose environment this is

# Another environment's settings must neither steer pip nor leak modules into ours.
# Without bytecode each call compiles hrcplan again: .3 s.
unset VIRTUAL_ENV PYTHONHOME PYTHONPATH PYTHONDONTWRITEBYTECODE

say() { printf 'hrcplan: %s\n' "$*" >&2; }

# The places are part of what is compared: a moved checkout has stale paths in its .venv.
inputs() { sha256sum "$root/pyproject.toml" "$root/constraints.txt"; }

# True when the last finished installation is of the present inputs and holds the extras $1.
# `test` contains all extras that hrcplan runs with.
stamp_fits() {
    installed='' first='' second=''
    [ -x "$venv/bin/python" ] && [ -r "$stamp" ] || return 1
    { IFS= read -r installed && IFS= read -r first && IFS= read -r second; } <"$stamp" || return 1
    case $installed in "$1" | test) ;; *) return 1 ;; esac
    [ "$(inputs)" = "$first
$second" ]
}

# Exit status 3: too old; 4: cannot make environments, and Debian's package for it is printed.
probe='import sys
if sys.version_info < (3, 11):
    sys.exit(3)
try:
    import ensurepip, venv
except ImportError:
    print("python%d.%d-venv" % sys.version_info[:2])
    sys.exit(4)'

# Set $python to the first interpreter that will do. The one called python3 comes first,
# because that is the one its user chose; then 3.11, on which the project is tested.
find_python() {
    if [ -n "${HRCPLAN_PYTHON-}" ]; then set -- "$HRCPLAN_PYTHON"; else
        set -- python3 python3.11 python3.12 python3.13 python3.14
    fi
    package=''
    for python in "$@"; do
        found=$("$python" -c "$probe" 2>/dev/null) && return 0
        [ $? -eq 4 ] && package=${package:-$found}
    done
    if [ -n "$package" ]; then
        say "this Python has no venv module. On Debian or Ubuntu: apt install $package"
    else
        say "needs Python 3.11 or newer; tried: $*"
        say "On Debian or Ubuntu: apt install python3 python3-venv"
        say "or name an interpreter: HRCPLAN_PYTHON=/path/to/python"
    fi
    return 1
}

# An environment of ours whose interpreter works is kept, anything else of ours is made anew.
make_venv() {
    if [ -e "$venv" ] && [ ! -e "$owner" ]; then
        say "$venv was not made by this launcher; please move it away"
        return 1
    fi
    [ "$(cat "$owner" 2>/dev/null)" = "$root" ] && "$venv/bin/python" -c 'import pip' 2>/dev/null &&
        return 0
    find_python || return 1
    rm -rf "$venv" && mkdir "$venv" && printf '%s\n' "$root" >"$owner" &&
        "$python" -m venv "$venv"
}

# Run pip ("$@"): all of its words with $verbose, else a line after 5, 10, 20, … packages, and its
# errors if it fails.
show_pip() {
    [ -z "${verbose-}" ] || { "$@"; return; }
    log=$venv/hrcplan-pip.log
    { "$@" 2>&1 || echo 'hrcplan: pip failed'; } | tee "$log" | count_packages
    tail -n 1 "$log" | grep -qx 'hrcplan: pip failed' || return 0
    say 'pip failed (--verbose shows all that it says):'
    grep -E '^ERROR|^    ' "$log" | tail -n 4 >&2
    return 1
}

count_packages() {
    count=0 next=5
    while IFS= read -r line; do
        case $line in
            Collecting* | Processing*.whl*)
                count=$((count + 1))
                [ "$count" -lt "$next" ] || { say "$count packages collected"; next=$((2 * next)); }
                ;;
            'Installing collected packages'*) say "installing $count packages" ;;
        esac
    done
}

install_project() {
    extra=$1
    # An outdated stamp still tells that the test extra is in; an update keeps it.
    [ "$installed" = test ] && extra=test
    say "installing into .venv with the extras '$extra', in about a minute"
    make_venv || return 1
    before=$(inputs) && rm -f "$stamp" || return 1
    show_pip env -u PIP_TARGET -u PIP_PREFIX PIP_USER=0 "$venv/bin/python" -m pip install \
        --no-input --disable-pip-version-check \
        -c "$root/constraints.txt" -e "$root[$extra]" || return 1
    # So that .venv/bin/hrcplan starts fast where Python may not write bytecode.
    [ ! -d "$root/hrcplan" ] || "$venv/bin/python" -m compileall -q "$root/hrcplan" || return 1
    printf '%s\n' "$extra" "$before" >"$stamp.new" && mv "$stamp.new" "$stamp" &&
        say 'installed; later calls start at once'
}

# The lock is the kernel's: it goes with its last holder, be that holder killed or finished,
# and a pip that outlives a killed launcher still holds it.
need_venv() {
    stamp_fits "$1" && return 0
    (
        flock -n 9 || { say 'waiting for another installation to finish' && flock 9; } || exit 1
        stamp_fits "$1" || install_project "$1"
    ) 9>"$root/.venv.lock" >&2 </dev/null && return 0
    say 'the installation failed; the next call tries again'
    exit 126 # "found, but cannot run": none of hrcplan's own exit codes
}
