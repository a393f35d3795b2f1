#!/usr/bin/env bash
# Runs a program where there is AVX-512: in the emulator Bochs, as on an Intel Skylake-X, under a small Linux of its own.
#
#     tools/emulate_avx512.sh BOCHS PROGRAM [ARGUMENT...]
#
# BOCHS is the folder of Bochs, built from its source as docs/determinism.md says. Output and exit status are those of the
# program, which runs some fifty times slower than on the machine itself. Needs, from Debian: busybox-static cpio isolinux
# syslinux-common vgabios xorriso; it downloads a kernel and does not install it.
set -euo pipefail
if [ $# -lt 2 ]; then
  sed -n '2,8s/^# \?//p' "$0" >&2
  exit 2
fi
bochs=$(realpath "$1") program=$(realpath "$2")
shift 2
for file in "$bochs/bochs" "$bochs/bios/BIOS-bochs-latest" "$program" /bin/busybox /usr/lib/ISOLINUX/isolinux.bin \
  /usr/lib/syslinux/modules/bios/ldlinux.c32 /usr/share/vgabios/vgabios.bin; do
  [ -e "$file" ] || { echo "emulate_avx512: $file is not there; the head of this script names what is needed" >&2; exit 5; }
done

work=$(mktemp -d)
trap 'kill "${emulator:-}" 2>/dev/null || true; rm -rf "$work"' EXIT
root=$work/root disc=$work/disc serial=$work/serial
mkdir -p "$root"/{bin,proc,sys,dev,tmp,lib64,lib/x86_64-linux-gnu} "$disc"

package=$(apt-cache depends linux-image-cloud-amd64 | sed -n 's/.*Depends: \(linux-image-[0-9].*\)/\1/p' | head -n 1)
(cd "$work" && apt-get download -q "$package" > /dev/null && dpkg -x linux-image-*.deb kernel)
cp "$work"/kernel/boot/vmlinuz-* "$disc/vmlinuz"

cp /bin/busybox "$root/bin/"
ln -s busybox "$root/bin/sh"
strip -o "$root/program" "$program"
ldd "$program" | awk '/=>/ {print $3} /ld-linux/ {print $1}' | sort -u | while read -r library; do
  case $library in
    /lib64/*) cp -L "$library" "$root/lib64/" ;;
    /*) cp -L "$library" "$root/lib/x86_64-linux-gnu/" ;;
  esac
done
cat > "$root/init" <<'INIT'
#!/bin/sh
/bin/busybox --install -s /bin
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev; mount -t tmpfs tmp /tmp
export PATH=/bin HOME=/tmp
exec > /dev/ttyS0 2>&1 < /dev/null
cd /tmp
INIT
printf '/program' >> "$root/init"
[ $# -eq 0 ] || printf ' %q' "$@" >> "$root/init"
printf '\necho "emulated program ended with $?."\npoweroff -f\n' >> "$root/init"
chmod +x "$root/init"
mknod "$root/dev/console" c 5 1
(cd "$root" && find . | cpio -o -H newc --quiet) > "$disc/initrd"

cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 "$disc/"
cat > "$disc/isolinux.cfg" <<'CONFIG'
default l
prompt 0
label l
 kernel vmlinuz
 append initrd=initrd console=ttyS0,115200 mitigations=off nokaslr lpj=1000000 tsc=reliable quiet rdinit=/init
CONFIG
xorriso -as mkisofs -quiet -o "$work/disc.iso" -b isolinux.bin -c boot.cat -no-emul-boot -boot-load-size 4 \
  -boot-info-table "$disc" 2> /dev/null
cat > "$work/bochsrc" <<CONFIG
config_interface: textconfig
display_library: nogui
cpu: model=corei7_skylake_x, count=1, ips=50000000, reset_on_triple_fault=0
memory: guest=1536, host=1536
romimage: file=$bochs/bios/BIOS-bochs-latest
vgaromimage: file=/usr/share/vgabios/vgabios.bin
ata0: enabled=1, ioaddr1=0x1f0, ioaddr2=0x3f0, irq=14
ata0-master: type=cdrom, path=$work/disc.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=$serial
log: $work/log
panic: action=report
CONFIG
: > "$serial"
"$bochs/bochs" -q -f "$work/bochsrc" < /dev/null > /dev/null 2>&1 &
emulator=$!
until grep -aq 'emulated program ended with [0-9]*\.' "$serial" || ! kill -0 "$emulator" 2> /dev/null; do sleep 2; done
grep -av 'emulated program ended' "$serial" | tr -d '\r'
status=$(sed -n 's/.*emulated program ended with \([0-9]*\)\..*/\1/p' "$serial" | head -n 1)
[ -n "$status" ] || { echo "emulate_avx512: the emulator stopped before the program ended" >&2; exit 5; }
exit "$status"
