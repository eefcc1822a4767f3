// SPDX-License-Identifier: Apache-2.0
// The table of commands: name, options, and the texts for help and manual page.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

int run_completion(const Settings& settings) {
  print(completion_script(settings.model));
  return 0;
}

int run_man(const Settings&) {
  print(man_page());
  return 0;
}

constexpr Command table[] = {
    {"render", for_render, "MODEL...", "Render pictures and maps of a model.",
     "MODEL is an STL, PLY, OBJ, OFF, glTF, GLB or 3MF file, a scene file in JSON that places such models, - for "
     "standard input, or builtin:teapot, cubes, cycle, city, spheres or gallery. Several are drawn together, as they "
     "lie. Without any output the picture is shown on the "
     "terminal. Outputs with the same .exr name "
     "share one file.",
     "frontmost render engine.glb -o engine.png\n"
     "frontmost render part.stl --view iso --camera-orthographic -o '{model}_{view}.png'\n"
     "frontmost render scene.glb --depth depth.exr --ids object=objects.exr --normals normals.npy\n"
     "frontmost render object.ply --intrinsics 615,615,320,240 --resolution 640,480 --pose pose.txt \\\n"
     "    --pose-convention opencv-world-to-camera --depth depth.png --depth-scale 1000\n"
     "frontmost render part.stl -o new.png --reference old.png --reference-threshold 0.01\n"
     "frontmost render city.glb --json --repeat 20 --samples 1\n"
     "curl -s https://example.com/part.stl | frontmost render - -o - --format png > part.png",
     run_render},
    {"lines", for_lines, "MODEL...", "Draw the edges of a model on paper, hidden lines removed.",
     "Outlines, creases, borders and intersections, cut exactly where they go out of sight, in millimetres, as vectors "
     "for journals, drawing sheets and pen plotters. The layers of SVG and PDF are 5 stippling, 4 hatching, 1 hidden, "
     "2 visible, 3 outline and 8 frame, with a group for every object. Several models have a sheet each, numbered: "
     "the pages of one PDF, or files with {model} in their names.",
     "frontmost lines part.stl --view iso --camera-orthographic --hidden dashed -o part.svg\n"
     "frontmost lines part.stl --views front,top,left,iso --hidden dashed --page a3 -o sheet.pdf\n"
     "frontmost lines part.stl --views front,top,left --title Bracket --number B-17 --date 2026-03-01 -o sheet.pdf\n"
     "frontmost lines part.stl nut.stl --views front,top --frame -o sheets.pdf\n"
     "frontmost lines part.stl --view top --camera-orthographic --scale 1:1 -o part.dxf\n"
     "frontmost lines engine.glb --style figure -o figure.pdf\n"
     "frontmost lines city.glb --plot --page a3 -o plot.svg --json",
     run_lines},
    {"info", for_info, "MODEL", "Count and check what is in a model.",
     "Counts, bounds, objects, materials, cameras and lights, and what is odd: degenerate, duplicate and non-finite "
     "triangles, boundary and non-manifold edges, inconsistent winding.",
     "frontmost info engine.glb\n"
     "frontmost info engine.glb --json",
     run_info},
    {"camera", for_camera, "MODEL", "Print one camera in every convention.",
     "Takes the view options of render, and prints the camera that they make: position, focal point and up; 4x4 poses; "
     "intrinsics; projection matrices.",
     "frontmost camera part.stl --view front\n"
     "frontmost camera object.ply --intrinsics 615,615,320,240 --resolution 640,480 --json",
     run_camera},
    {"report", for_report, "MODEL", "Account for every object: how much is seen, and who hides the rest.",
     "For every object the samples that it covers alone, in frame and visibly, boxes of all three, the shares that are "
     "visible, hidden and beyond the frame, the nearest visible distance, and which objects hide how much of it; "
     "exact, through the camera that the view options of render make. What lies beyond the frame is counted on a "
     "canvas around it.",
     "frontmost report scene.glb\n"
     "frontmost report city.glb --resolution 640,480 --json\n"
     "frontmost report scene.glb -o report.html",
     run_report},
    {"explain", for_explain, "MODEL OBJECT", "Say why an object is seen or not, and what to change.",
     "One sentence: where the object is, or what hides it, and what would show it: other planes, another direction, a "
     "larger picture, or objects to take away. OBJECT is the name of an object, or its number in frontmost report. "
     "Through the camera that the view options of render make.",
     "frontmost explain scene.glb bolt\n"
     "frontmost explain scene.glb bolt --view top --resolution 640,480\n"
     "frontmost explain city.glb 17 --json",
     run_report},
    {"visible", for_visible, "MODEL", "List every face of which any part is seen, with its visible area.",
     "Exact areas in pixels, in scene units and as solid angles, however small the part that is seen, through the "
     "camera "
     "that the view options of render make. Of many views, those of a batch file or from all around: which faces are "
     "ever "
     "seen, in how many views, and the largest share of each that one view shows.",
     "frontmost visible part.stl -o faces.csv\n"
     "frontmost visible city.glb --resolution 640,480 --json\n"
     "frontmost visible assembly.glb --sphere 200 -o faces.npy\n"
     "frontmost visible scene.glb --views batch.json -o -",
     run_visible},
    {"batch-merge", for_batch_merge, "PART...",
     "Check that the shards of a batch are complete, and gather their files.",
     "PART is a folder in which frontmost render --batch --shard ran, or a manifest that it wrote. All views must be "
     "finished, of the same model, batch file and options, and every file must be what its manifest says.",
     "frontmost batch-merge .\n"
     "frontmost batch-merge machine-1 machine-2 machine-3 -o all",
     run_batch_merge},
    {"precision", for_precision, "[MODEL]", "What a depth buffer can tell apart, at which distance.",
     "The smallest gap that a depth buffer always resolves, against distance; without --format for the formats in use. "
     "With MODEL also where such a buffer may show a surface that is not the nearest (z-fighting): the pixels at which "
     "it does, against the exact answer, and the areas of faces in which another picture would; with --format also "
     "between which objects, and which planes, format or polygon offset end it, found by drawing. The camera is what "
     "the "
     "view options of render make; planes that are not given are fitted.",
     "frontmost precision --near 0.1 --far 1000\n"
     "frontmost precision --near 0.01 --infinite --format D24 --gap 0.05,800 --plot gaps.svg\n"
     "frontmost precision city.glb --near 0.01 --format D16 --heat-map fights.png",
     run_precision},
    {"sight", for_sight, "MODEL", "Say whether one point sees another.",
     "Whether a surface lies between two points, of either side and exactly: what lies at one of the points does not "
     "block. Blocked lines come with the nearest object, triangle, point and distance.",
     "frontmost sight city.glb --from 0,2,0 --to 40,2,-15\n"
     "frontmost sight site.ply --pairs antennas.txt --json",
     run_sight},
    {"lidar", for_lidar, "MODEL", "Scan a model as a spinning laser does.",
     "Casts rings of rays, or any list of directions, from one point, and writes where they meet the model: as points "
     "with range, object, triangle, ring and step (.ply), or as a range image with a row for each ring (.exr, .npy).",
     "frontmost lidar city.glb --from 0,2,0 --rings 64 --elevations -24,2 --steps 2048 -o points.ply\n"
     "frontmost lidar site.ply --from 0,0,1 --directions pattern.txt -o points.ply --json",
     run_lidar},
    {"compare", for_compare, "MODEL", "Lay all visibility methods side by side.",
     "Every method answers for the same view, in a process of its own: time by stage, memory, and the pixels where it "
     "differs from the z-buffer, each put to exact arithmetic: an edge within 1/128 pixel, depths closer than can be "
     "told, a translucent surface, or unexplained, which would be a mistake. With -o also a page to look at.",
     "frontmost compare engine.glb\n"
     "frontmost compare city.glb --explain --threads 1\n"
     "frontmost compare part.stl --view iso -o comparison",
     run_compare},
    {"completion", 0, "bash|zsh|fish", "Print a shell completion script.", "",
     "frontmost completion bash > ~/.local/share/bash-completion/completions/frontmost\n"
     "frontmost completion zsh > ~/.zfunc/_frontmost\n"
     "frontmost completion fish > ~/.config/fish/completions/frontmost.fish",
     run_completion},
    {"man", 0, "", "Print the manual page.", "", "frontmost man | man -l -", run_man},
};

}  // namespace

std::span<const Command> commands() { return table; }

const Command* find_command(std::string_view name) {
  for (const Command& command : table) {
    if (command.name == name) return &command;
  }
  return nullptr;
}

}  // namespace frontmost::cli
