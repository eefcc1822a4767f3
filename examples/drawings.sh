#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The drawings of docs/drawings.md: a technical sheet, a plotter drawing, a figure for a paper and, where frontmost-import is
# installed, the sheet of a CAD file, and its picture with edges for docs/command-line.md.
#
#     PATH=$PATH:build/release examples/drawings.sh [FOLDER]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-.}"
python3 "$here/bracket.py" > bracket.obj
frontmost lines bracket.obj --up +z --views front,top,left,iso --hidden dashed --page a4-portrait \
  --title 'Angle bracket' --number FM-0014 --author 'E. Example' --date 2026-03-01 -o sheet.svg -o sheet.dxf
frontmost lines bracket.obj --up +z --view iso --camera-orthographic --plot --hidden dashed --hatch 1.5 --page 160,130 --margin 5 -o plot.svg -o plot.pdf
frontmost lines builtin:gallery --style figure --hatch 1.2 --page 160,100 --margin 3 -o figure.svg -o figure.pdf
if [ -x "$(dirname "$(command -v frontmost)")/frontmost-import" ]; then
  frontmost lines "$here/cad/fixture.step" --views front,top,right,iso --dimensions all --page a3 \
    --title 'Drilling fixture' --number FM-0015 --author 'E. Example' --date 2026-03-01 -o fixture.svg -o fixture.pdf
  frontmost render "$here/cad/fixture.step" --edges --resolution 640,360 -o edges.png
fi
