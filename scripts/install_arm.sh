#!/bin/sh
# Debian's compiler, C library and emulator for Cortex-M, which the tests and figures of learn/embedded run on.
# Does nothing where they are installed; asks for root's rights by sudo where it is not root.
set -eu

if [ "$#" -gt 0 ]; then
    cat <<'END'
usage: sudo sh scripts/install_arm.sh

Installs Debian's compiler, C library and emulator for Cortex-M (gcc-arm-none-eabi, libnewlib-arm-none-eabi,
qemu-system-arm), which the tests and figures of exported classifiers need. It does nothing if they are installed.
END
    case "$1" in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi

packages="gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm"

missing=""
for package in $packages; do
    if ! dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed'; then
        missing="$missing $package"
    fi
done
if [ -z "$missing" ]; then
    echo "installed already: $packages"
    exit 0
fi

as_root=""
[ "$(id -u)" -eq 0 ] || as_root="sudo"
echo "installing from Debian:$missing"
$as_root apt-get update --quiet
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends $missing
arm-none-eabi-gcc --version | head -n 1
qemu-system-arm --version | head -n 1
