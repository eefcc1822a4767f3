#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the README's pictures anew: readme_pictures.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../docs/images"
"$program" render builtin:gallery --resolution 720,392 --samples 8 --background transparent -o gallery.png
for shading in lit depth ids normals; do
  "$program" render builtin:spheres --resolution 280,170 --shading "$shading" --background transparent -o "$shading.png"
done
