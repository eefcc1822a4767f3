#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the README and of the pages of docs again, except drawings: pictures.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../docs/images"
"$program" render builtin:gallery --resolution 720,392 --samples 8 --background transparent -o gallery.png
for shading in lit depth ids normals; do
  "$program" render builtin:spheres --resolution 280,170 --shading "$shading" --background transparent -o "$shading.png"
done
# The knob of the teapot's lid, with ever finer triangles.
knob=(render builtin:teapot --camera-position '1.6,4.2,3.2' --camera-focal-point '0,2.75,0' --camera-view-angle 22
  --resolution '240,180' --background transparent)
for error in 40 4 0.5; do
  "$program" "${knob[@]}" --tessellation-error "$error" -o "knob-$error.png"
done
for environment in studio sky none; do
  shown=()
  [ "$environment" != sky ] || shown=(--show-environment)
  "$program" render builtin:spheres --resolution 280,170 --background transparent \
    --environment "$environment" "${shown[@]}" -o "light-$environment.png"
done
for strength in 0 1; do
  "$program" render builtin:gallery --resolution 280,153 --shadows off --background transparent \
    --ambient-occlusion "$strength" -o "ambient-occlusion-$strength.png"
done
"$program" render builtin:gallery --resolution 280,153 --layers 3 -o 'layer-{layer}.png'
# A 16-bit depth buffer whose near plane is too near.
"$program" render builtin:gallery --resolution 360,196 --depth-format D16 --near 0.001 -o fighting.png
"$program" precision builtin:gallery --resolution 360,196 --format D16 --near 0.001 --heat-map fights.png
street=(render builtin:city --camera-position '8,3,25' --camera-direction +x)
"$program" "${street[@]}" --camera-model panorama --resolution 400,200 -o panorama.png
"$program" "${street[@]}" --camera-model fisheye --resolution 200,200 -o fisheye.png
# The visible parts of each face from the front, looked at from the right.
"$program" render builtin:gallery --resolution 420,260 --shading ids --background transparent -o gallery-objects.png
coloured=$(mktemp --suffix .ply)
"$program" visible builtin:gallery --resolution 640,360 -o "$coloured" -q > /dev/null
"$program" render "$coloured" --camera-azimuth-angle 100 --camera-elevation-angle 20 --shadows off \
  --resolution 400,225 -o visible-faces.png
rm "$coloured"
