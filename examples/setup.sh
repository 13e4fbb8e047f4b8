#!/usr/bin/env bash
# Installs the Debian packages that Lumenline needs, where they are missing.
# Usage: bash examples/setup.sh build [test] [browser]
set -euo pipefail
packages_build=(
    g++ cmake ninja-build git ca-certificates
    libcgal-dev libgmp-dev libmpfr-dev libboost-dev libeigen3-dev
    libtbb-dev libopenmesh-dev libhdf5-dev libssl-dev
    libyaml-cpp-dev libcli11-dev libfmt-dev
    libpugixml-dev zlib1g-dev libpng-dev nlohmann-json3-dev libcpp-httplib-dev)
packages_test=(libgtest-dev libbenchmark-dev python3-scipy python3-h5py python3-pandas python3-matplotlib
    slurm-wlm munge)
# For the tests in a browser; where Node.js and npm are installed in another way, these are used.
packages_browser=()
command -v node >/dev/null || packages_browser+=(nodejs)
command -v npm >/dev/null || packages_browser+=(npm)
command -v chromium >/dev/null || packages_browser+=(chromium)

wanted=()
for group in "$@"; do
    case "$group" in
        build) wanted+=("${packages_build[@]}") ;;
        test) wanted+=("${packages_test[@]}") ;;
        browser) wanted+=("${packages_browser[@]}") ;;
        *) echo "setup.sh: unknown group '$group'; known: build, test, browser" >&2; exit 2 ;;
    esac
done
missing=()
for package in "${wanted[@]}"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "setup.sh: this is no Debian system; please install: ${missing[*]}" >&2
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup.sh: neither root nor sudo; please have installed: ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "Installing Debian packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
