# Shared by the scripts of this folder, and sourced by them: where the repository is, how a step is announced,
# timed and blamed, and which Debian packages the project needs.
# shellcheck shell=bash

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
started_in="$PWD" command_line=("$0" "$@")  # of the script that sources this

# Debian 12 names.  The versions there are the ones the project is tested with.
# shellcheck disable=SC2034
intaglio_packages=(
    # compilers and build
    g++ clang libclang-rt-14-dev cmake ninja-build make pkg-config ccache mold git ca-certificates
    # names and lines in the reports of the sanitizers
    llvm-14
    # validators and translators
    glslang-dev glslang-tools spirv-tools spirv-headers libspirv-cross-c-shared-dev spirv-cross
    libmojoshader-dev
    # running on the CPU: loader, validation layer, lavapipe
    libvulkan-dev vulkan-validationlayers mesa-vulkan-drivers
    # libraries
    libfmt-dev nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libspng-dev libpng-dev zlib1g-dev libpugixml-dev
    libxxhash-dev
    libgtest-dev libgmock-dev
    # plots of the report
    libjs-chart.js
)
# What only the tests use: a browser for the report's live part, 122 MB to fetch and 409 MB installed; a shell to
# complete words in, a reader of the manual page, and a judge of JSON schemas.
# shellcheck disable=SC2034
intaglio_test_packages=(chromium chromium-driver python3-selenium zsh mandoc python3-jsonschema)

say() { printf '\n== %s\n' "$*"; }
note() { printf '   %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; }

# A word or a path as one would type it.
quoted() { local text; printf -v text '%q ' "$@"; printf '%s' "${text% }"; }

# step "what it is" command...: announces, runs, says how long it took.  A failing step names itself and the
# command that repeats it, and ends the script with the command's exit code.  The command may be a function of the
# script: it runs in a subshell and ends at its first failing line.
step() {
    local title="$1" began=$SECONDS code
    shift
    say "$title"
    local folder="$root" rerun=("$@")
    if declare -F "$1" >/dev/null; then
        folder="$started_in" rerun=("${command_line[@]}")
    else
        note "$(quoted "$@")"
    fi
    # Not `"$@" || code=$?`: on the left of || bash ignores set -e, also inside functions.
    set +e
    (set -e; "$@")
    code=$?
    set -e
    if [ "$code" -ne 0 ]; then
        fail "step '$title' failed after $((SECONDS - began)) s with exit code $code; run it again with:"
        printf '  cd %s && %s\n' "$(quoted "$folder")" "$(quoted "${rerun[@]}")" >&2
        exit "$code"
    fi
    note "done in $((SECONDS - began)) s"
}

missing_packages() {
    local package state
    for package in "$@"; do
        state="$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)"
        [ "$state" = installed ] || printf '%s\n' "$package"
    done
}

# Installs what is missing of the named packages; touches neither apt nor the network when nothing is.
install_packages() {
    local -a missing as_root=()
    say "Debian packages"
    if ! command -v dpkg-query >/dev/null; then
        fail "this is no Debian system (dpkg-query is missing); install by hand what these packages hold:"
        printf '  %s\n' "$*" >&2
        exit 2
    fi
    mapfile -t missing < <(missing_packages "$@")
    if [ "${#missing[@]}" -eq 0 ]; then
        note "all $# are installed"
        return
    fi
    note "missing ${#missing[@]} of $#: ${missing[*]}"
    local apt_log="$root/build/apt.log"
    mkdir -p "$root/build"
    if [ "$(id -u)" -ne 0 ]; then
        as_root=(sudo)
        # With a terminal sudo may ask for the password; without one a question would hang.
        [ -t 0 ] || as_root+=(-n)
        if ! command -v sudo >/dev/null || ! "${as_root[@]}" true; then
            fail "packages are missing, and this user is not root and cannot use sudo; as root, run:"
            printf '  apt-get update && apt-get install -y --no-install-recommends %s\n' "${missing[*]}" >&2
            exit 2
        fi
    fi
    local -a install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q
        -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 install -y --no-install-recommends "${missing[@]}")
    local began=$SECONDS
    # The package lists may be absent (a bare image) or older than the archive; only then are they fetched.
    note "$(quoted "${install[@]}")"
    if ! "${install[@]}" </dev/null >"$apt_log" 2>&1; then
        note "not with the package lists at hand; fetching fresh ones"
        if ! "${as_root[@]}" apt-get -q update </dev/null >>"$apt_log" 2>&1 ||
            ! "${install[@]}" </dev/null >>"$apt_log" 2>&1; then
            fail "apt-get failed; the end of what it said ($apt_log):"
            tail -n 15 "$apt_log" >&2
            exit 2
        fi
    fi
    note "installed in $((SECONDS - began)) s"
}
