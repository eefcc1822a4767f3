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
     "standard input, or builtin:teapot, cubes, cycle, city, spheres or gallery. Several models are drawn in one "
     "picture, each at its own coordinates. Without any output the picture is shown on the terminal. Outputs with the "
     "same .exr name share one file.",
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
     "Draws outlines, creases, borders and intersections as vectors in millimetres, for journals, drawing sheets and "
     "pen plotters. Lines are cut exactly where they become hidden. SVG and PDF have the layers 5 stippling, 4 "
     "hatching, 1 hidden, 2 visible, 3 outline and 8 frame, with a group for every object. Each of several models has "
     "a numbered sheet of its own: a page of one PDF, or a file with {model} in its name.",
     "frontmost lines part.stl --view iso --camera-orthographic --hidden dashed -o part.svg\n"
     "frontmost lines part.stl --views front,top,left,iso --hidden dashed --page a3 -o sheet.pdf\n"
     "frontmost lines part.stl --views front,top,left --title Bracket --number B-17 --date 2026-03-01 -o sheet.pdf\n"
     "frontmost lines part.stl nut.stl --views front,top --frame -o sheets.pdf\n"
     "frontmost lines part.stl --view top --camera-orthographic --scale 1:1 -o part.dxf\n"
     "frontmost lines engine.glb --style figure -o figure.pdf\n"
     "frontmost lines city.glb --plot --page a3 -o plot.svg --json",
     run_lines},
    {"info", for_info, "MODEL", "Count the contents of a model and check them.",
     "Prints counts, bounds, objects, materials, cameras and lights, and defects: degenerate, duplicate and non-finite "
     "triangles, boundary and non-manifold edges, inconsistent winding.",
     "frontmost info engine.glb\n"
     "frontmost info engine.glb --json",
     run_info},
    {"camera", for_camera, "MODEL", "Print one camera in every convention.",
     "Prints the camera that the view options describe: position, focal point and up vector; 4x4 poses; intrinsics; "
     "projection matrices. The view options are those of render.",
     "frontmost camera part.stl --view front\n"
     "frontmost camera object.ply --intrinsics 615,615,320,240 --resolution 640,480 --json",
     run_camera},
    {"report", for_report, "MODEL", "Report how much of every object is seen, and which objects hide the rest.",
     "Counts for every object the samples that it covers alone, inside the frame, and visibly. Also reports the "
     "bounding boxes of these samples, the visible, hidden and cut-off shares, the nearest visible distance, and how "
     "much each other object hides. The counts are exact. The view options of render give the camera. Samples beyond "
     "the frame are counted on a larger canvas.",
     "frontmost report scene.glb\n"
     "frontmost report city.glb --resolution 640,480 --json\n"
     "frontmost report scene.glb -o report.html",
     run_report},
    {"explain", for_explain, "MODEL OBJECT", "Explain why an object is seen or not, and what to change.",
     "Prints one sentence: where the object is, or which objects hide it, and a change that would show it: other "
     "clipping planes, another direction, a larger picture, or objects to remove. OBJECT is the name of an object, or "
     "its number in frontmost report. The view options of render give the camera.",
     "frontmost explain scene.glb bolt\n"
     "frontmost explain scene.glb bolt --view top --resolution 640,480\n"
     "frontmost explain city.glb 17 --json",
     run_report},
    {"visible", for_visible, "MODEL", "List every face that is at least partly seen, with its visible area.",
     "Computes exact visible areas in square pixels, in scene units squared and as solid angles, however small the "
     "visible part is. The view options of render give the camera. For many views, from a batch file or from all "
     "around, lists the faces that any view shows, the number of views that show each, and the largest share of each "
     "that one view shows.",
     "frontmost visible part.stl -o faces.csv\n"
     "frontmost visible city.glb --resolution 640,480 --json\n"
     "frontmost visible assembly.glb --sphere 200 -o faces.npy\n"
     "frontmost visible scene.glb --views batch.json -o -",
     run_visible},
    {"batch-merge", for_batch_merge, "PART...",
     "Check that the shards of a batch are complete, and collect their files.",
     "PART is a folder in which frontmost render --batch --shard ran, or a manifest that it wrote. All views must be "
     "finished, and of the same model, batch file and options. Every file must match its entry in the manifest.",
     "frontmost batch-merge .\n"
     "frontmost batch-merge machine-1 machine-2 machine-3 -o all",
     run_batch_merge},
    {"precision", for_precision, "[MODEL]",
     "Report which gaps a depth buffer resolves, and where a model suffers z-fighting.",
     "For several distances, prints the smallest gap between surfaces that a depth buffer always resolves, with "
     "--format or with the common formats. With MODEL also reports z-fighting: the pixels at which the buffer shows a "
     "surface that is not the nearest, and the areas of faces where such pixels may appear if the view changes a "
     "little. With --format also names the objects, and suggests clipping planes, a format or a polygon offset that "
     "removes the wrong pixels; each suggestion is tested by drawing. The view options of render give the camera; "
     "clipping planes that are not given are fitted to the model.",
     "frontmost precision --near 0.1 --far 1000\n"
     "frontmost precision --near 0.01 --infinite --format D24 --gap 0.05,800 --plot gaps.svg\n"
     "frontmost precision city.glb --near 0.01 --format D16 --heat-map fights.png",
     run_precision},
    {"sight", for_sight, "MODEL", "Tell whether one point sees another.",
     "Decides exactly whether a surface lies between two points. Both sides of a surface block; a surface that "
     "contains one of the points does not. For a blocked line, prints the nearest object and triangle, the point and "
     "its distance.",
     "frontmost sight city.glb --from 0,2,0 --to 40,2,-15\n"
     "frontmost sight site.ply --pairs antennas.txt --json",
     run_sight},
    {"lidar", for_lidar, "MODEL", "Scan a model like a spinning laser scanner.",
     "Casts rings of rays, or a list of directions, from one point, and writes the points where they hit the model: "
     "with range, object, triangle, ring and step (.ply), or as a range image with a row for each ring (.exr, .npy).",
     "frontmost lidar city.glb --from 0,2,0 --rings 64 --elevations -24,2 --steps 2048 -o points.ply\n"
     "frontmost lidar site.ply --from 0,0,1 --directions pattern.txt -o points.ply --json",
     run_lidar},
    {"compare", for_compare, "MODEL", "Compare all visibility methods on one view.",
     "Runs every method on the same view, each in a process of its own. Reports time by stage, memory, and the pixels "
     "where the method differs from the z-buffer. Exact arithmetic finds the reason for each such pixel: an edge "
     "within 1/128 pixel, depths that floats do not tell apart, a translucent surface, or unexplained, which would be "
     "a bug. With -o also writes a page.",
     "frontmost compare engine.glb\n"
     "frontmost compare city.glb --explain --threads 1\n"
     "frontmost compare part.stl --view iso -o comparison",
     run_compare},
    {"gl", for_gl, "PROGRAM [ARG]...", "Run a program that uses OpenGL 1.x, without a display, and keep its picture.",
     "Starts PROGRAM, unchanged, with Frontmost's libraries in place of OpenGL, GLUT and OSMesa. The picture has the "
     "same bytes on every machine. One frame is drawn, or as many as --frames or --script say, on a simulated clock "
     "with "
     "60 frames a second. Arguments of PROGRAM that begin with a dash stand behind --. The exit status is that of "
     "PROGRAM.",
     "frontmost gl ./gears -o gears.png\n"
     "frontmost gl ./gears --size 640x480 --frames 30 -o gears.png\n"
     "frontmost gl ./viewer --script tour.txt -- -model bunny.ply",
     run_gl},
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
