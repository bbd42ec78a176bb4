#!/usr/bin/env bash
# Installs FreeCAD 1.0 or later for articad on Debian and Ubuntu, as root and unattended. `articad install freecad` runs it.
#
#   (no argument)   from the distribution if its FreeCAD is new enough, otherwise in a Debian 13 tree
#   --next          in addition, a tree of Debian's unstable suite with the next FreeCAD, for tests/freecad: 3 GB
#   --remove        removes the trees
#
# The tree is $XDG_DATA_HOME/articad/freecad (by default ~/.local/share/articad/freecad): 2.3 GB, about 3 minutes; nothing outside it changes.
# Run it again after an interruption: fetched packages are kept, and a finished tree is not changed. Packages come from
# ARTICAD_DEBIAN_MIRROR, else from the mirror that apt uses, else from debootstrap's default.
set -euo pipefail

readonly packages=freecad-python3,freecad-common,ca-certificates need_mb=5000
[[ ${XDG_DATA_HOME:-} == /* ]] || XDG_DATA_HOME=$HOME/.local/share # a relative one is ignored, as XDG requires
readonly data=$XDG_DATA_HOME/articad
suite=trixie target=$data/freecad
[[ ${1:-} != --next ]] || { suite=sid target=$data/freecad-next; shift; next=yes; }
readonly suite target next=${next:-} partial=$target.partial fetched=$target.packages log=$data/install-freecad.log

progress() { # of debootstrap: a line for every 50 packages of each stage
  awk '/^I: (Retrieving|Unpacking|Configuring) / { if (++n[$2] % 50 == 0) { print "install-freecad: " $2 ": " n[$2] " packages"; fflush() } }' >&2
}
say() { printf 'install-freecad: %s\n' "$*" >&2; }
die() { say "$*"; exit 3; }

if [[ ${1:-} == --remove ]]; then
  for tree in "$target" "$data/freecad-next"; do
    if mount | grep -q -F " on $tree"; then die "something is mounted inside $tree; unmount it first."; fi
    rm -rf --one-file-system "$tree" "$tree.partial" "$tree.packages"
    say "removed $tree"
  done
  exit 0
fi
for place in "$data" "$target" "$partial" "$fetched" "$log"; do # whoever made them would choose what root overwrites
  [[ ! -L $place || $place == "$data" || $place == "$target" ]] || die "$place is a link; remove it."
  [[ ! -e $place || -O $place || $(stat -c %u "$place") == $(stat -c %u "$HOME") ]] || die "$place belongs to another user; remove it."
done
[[ $# -eq 0 ]] || { say "unknown argument $1; known are --next and --remove"; exit 2; }

version_of() { # of a freecadcmd, as "1.0"
  "$@" --version 2>/dev/null | sed -n 's/^FreeCAD,* *\(Version: *\)\{0,1\}\([0-9]*\.[0-9]*\).*/\2/p' | head -n 1
}
new_enough() { [[ -n $1 ]] && printf '1.0\n%s\n' "$1" | sort -V -C; }

# A tree needs namespaces of its own to start: without them, 2 GB would be fetched for nothing.
confined() { bwrap --ro-bind / / --proc /proc --dev /dev --unshare-all --unshare-user --uid 65534 --gid 65534 true 2>&1; }

if [[ -x $target/usr/bin/env && -L $target/usr/bin/freecadcmd && ! -d $target/debootstrap ]]; then
  refused=$(confined) || die "$target is there, but it cannot start: bubblewrap is refused here (${refused:-no reason given})."
  say "already there: $target"
  exit 0
fi
if [[ -z $next ]] && command -v freecadcmd >/dev/null && new_enough "$(version_of freecadcmd)"; then
  say "already there: $(command -v freecadcmd), $(version_of freecadcmd)"
  exit 0
fi
command -v apt-get >/dev/null || die "this is neither Debian nor Ubuntu: install FreeCAD 1.0 or later and set ARTICAD_FREECAD to its freecadcmd."
((EUID == 0)) || die "run this as root, or install FreeCAD 1.0 or later yourself and set ARTICAD_FREECAD."

export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
apt-get update -qq
offered=$(apt-cache policy freecad-python3 | sed -n 's/^ *Candidate: *\([0-9]*:\)\{0,1\}\([0-9]*\.[0-9]*\).*/\2/p')
if [[ -z $next ]] && new_enough "$offered"; then
  say "this distribution has FreeCAD $offered: about 2 GB, 2 minutes"
  apt-get install -qq -y --no-install-recommends freecad-python3 freecad-common bubblewrap >/dev/null
  exit 0
fi

if [[ -n $next ]]; then
  say "a tree of Debian's unstable suite goes to $target: 3 GB, about 4 minutes"
else
  say "this distribution has FreeCAD ${offered:-none}; a Debian 13 tree goes to $target: 2.3 GB, about 3 minutes"
fi
mkdir -p "$data" "$fetched"
free_mb=$(df -Pm "$data" | awk 'NR == 2 { print $4 }')
((free_mb >= need_mb)) || die "only $free_mb MB free in $data; $need_mb MB are needed."
tools=()
command -v debootstrap >/dev/null || tools+=(debootstrap)
command -v bwrap >/dev/null || tools+=(bubblewrap)
[[ -f /usr/share/keyrings/debian-archive-keyring.gpg ]] || tools+=(debian-archive-keyring)
((${#tools[@]} == 0)) || apt-get install -qq -y --no-install-recommends "${tools[@]}" >/dev/null
refused=$(confined) || die "bubblewrap is refused here (${refused:-no reason given}), so a tree cannot start. \
Allow user namespaces, or install FreeCAD 1.0 or later otherwise and set ARTICAD_FREECAD."

mirror=${ARTICAD_DEBIAN_MIRROR:-$(apt-get indextargets --format '$(ORIGIN)|$(COMPONENT)|$(SUITE)|$(REPO_URI)' |
  awk -F'|' '$1 == "Debian" && $2 == "main" && $3 !~ /security|updates|backports/ { print $4; exit }')}
rm -rf --one-file-system "$partial" # what a broken run unpacked; its packages are kept
debootstrap --variant=minbase --include="$packages" --cache-dir="$fetched" \
  --keyring=/usr/share/keyrings/debian-archive-keyring.gpg "$suite" "$partial" ${mirror:+"$mirror"} 2>&1 |
  tee "$log" | progress ||
  { tail -n 20 "$log" >&2; die "debootstrap failed; run this again to go on. Its output: $log"; }
rm -rf "$partial"/var/cache/apt/archives/*.deb "$partial"/var/lib/apt/lists/*
mv -T "$partial" "$target"
rm -rf "$fetched" "$log"
say "done: $target ($(du -sm "$target" | cut -f 1) MB). articad install freecad --remove removes it."
