#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the README and of docs/methods.md anew: readme_pictures.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../docs/images"
"$program" render builtin:gallery --resolution 720,392 --samples 8 --background transparent -o gallery.png
for shading in lit depth ids normals; do
  "$program" render builtin:spheres --resolution 280,170 --shading "$shading" --background transparent -o "$shading.png"
done
# The knob of the teapot's lid, by rays and by ever finer triangles.
knob=(render builtin:teapot --camera-position '1.6,4.2,3.2' --camera-focal-point '0,2.75,0' --camera-view-angle 22
  --resolution '240,180' --background transparent)
"$program" "${knob[@]}" --method raycast -o knob-rays.png
for error in 40 4 0.5; do
  "$program" "${knob[@]}" --tessellation-error "$error" -o "knob-$error.png"
done
