#!/usr/bin/env bash
# Installs the Debian 12 packages that Firn builds and tests with; docs/dependencies.md says why each is here.
# Does nothing, and needs no privileges, when all of them are present.
set -euo pipefail

packages=(
  build-essential cmake ninja-build pkg-config git
  libhwy-dev libtbb-dev libfmt-dev libtomlplusplus-dev libmuparser-dev libcli11-dev nlohmann-json3-dev
  libhdf5-dev libxxhash-dev libembree-dev libopenvdb-dev libpng-dev zlib1g-dev libstb-dev fonts-dejavu-core ffmpeg
  libimgui-dev libglfw3-dev libepoxy-dev libgl1-mesa-dri libx11-dev xvfb
  libgtest-dev python3 python3-h5py
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
  echo "firn: missing packages: ${missing[*]}; install them with your system's package manager" >&2
  exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "firn: run as root or with sudo: apt-get install ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "firn: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
