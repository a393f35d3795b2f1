#!/usr/bin/env bash
# Installs the Debian 12 packages that Firn builds and tests with; docs/dependencies.md says why each is here.
# Does nothing, and needs no privileges, when all of them are present.
#
#   tools/install_dependencies.sh            what `make build` and `make test` need
#   tools/install_dependencies.sh clients    and what `make test-clients` needs besides: 0.3 GB of downloads, 1.7 GB of disk
#   tools/install_dependencies.sh fuzz    and what `make fuzz` needs besides
set -euo pipefail

packages=(
  build-essential cmake ninja-build pkg-config git
  libhwy-dev libtbb-dev libfmt-dev libtomlplusplus-dev libmuparser-dev libcli11-dev nlohmann-json3-dev
  libhdf5-dev libxxhash-dev libembree-dev libopenvdb-dev libboost-dev libassimp-dev libpng-dev zlib1g-dev libstb-dev fonts-dejavu-core ffmpeg
  libimgui-dev libglfw3-dev libepoxy-dev libgl1-mesa-dri libx11-dev xvfb
  libgtest-dev python3 python3-h5py
)

for group in "$@"; do
  case "$group" in
    clients) packages+=(paraview python3-paraview blender python3-meshio python3-openvdb python3-numpy python3-venv) ;;
    fuzz) packages+=(clang-14 libclang-rt-14-dev) ;;
    *) echo "firn: no group of packages is called $group; there are clients and fuzz" >&2; exit 2 ;;
  esac
done

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
"${as_root[@]}" apt-get -o Acquire::Retries=3 update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 install -y -qq --no-install-recommends "${missing[@]}"
