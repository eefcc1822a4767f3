// SPDX-License-Identifier: Apache-2.0
// Options that select the outputs and their look.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

void add_file(Settings& settings, OutputKind kind, std::string_view path) {
  if (path.empty()) throw UsageError("the file name is empty");
  settings.output.files.push_back({kind, std::string(path)});
}

void add_ids(Settings& settings, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw UsageError("'" + std::string(text) + "' is not KIND=FILE with KIND primitive, object or material");
  }
  constexpr OutputKind kinds[] = {OutputKind::primitive_ids, OutputKind::object_ids, OutputKind::material_ids};
  const int kind = parse_choice(text.substr(0, equals), "primitive|object|material");
  add_file(settings, kinds[kind], text.substr(equals + 1));
}

constexpr unsigned written = for_render | may_repeat;

constexpr Option output_options[] = {
    {"output", 'o', "FILE",
     "Write the picture, as .png, .jpg, .webp, .exr, .pfm or .npy, or as polygons: .svg or .pdf. - is standard output. "
     "{model} and {view} in file names stand for the names of model and view.",
     Group::output, written, [](Settings& s, const Given& g) { add_file(s, OutputKind::picture, g.text); }},
    {"depth", 0, "FILE", "Write depths: distances along the viewing axis, in scene units.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::depth, g.text); }},
    {"ray-distance", 0, "FILE", "Write distances from the eye, in scene units.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::ray_distance, g.text); }},
    {"window-depth", 0, "FILE", "Write the depth buffer's values, 0 to 1, as glReadPixels returns them.", Group::output,
     written,
     [](Settings& s, const Given& g) {
       s.view.depth.is_used = true;
       add_file(s, OutputKind::window_depth, g.text);
     }},
    {"ids", 0, "KIND=FILE",
     "Write the number of the visible primitive, object or material: primitive=FILE, object=FILE or material=FILE.",
     Group::output, written, [](Settings& s, const Given& g) { add_ids(s, g.text); }},
    {"normals", 0, "FILE", "Write world-space normals.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::normals, g.text); }},
    {"deep", 0, "FILE",
     "Write a deep OpenEXR file: colour, depth and ids of every layer, including those seen through translucent "
     "surfaces.",
     Group::output, written, [](Settings& s, const Given& g) { add_file(s, OutputKind::deep, g.text); }},
    {"layers", 0, "K",
     "Write the K nearest layers, 1 to 1024. {layer} in a file name stands for the number of the layer, from 0.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.layers = g.integer({1, 1024});
     }},
    {"visible-only", 0, "yes|no",
     "Leave hidden polygons out of .svg and .pdf, and cut partly hidden ones; yes by default.", Group::output,
     for_render, [](Settings& s, const Given& g) { s.output.visible_only = g.choice<int>() == 0; }},
    {"color-tolerance", 0, "STEPS",
     "In .svg and .pdf, divide a polygon if its colour varies by more than STEPS of 255; 6 by default; 255 divides "
     "none.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.color_tolerance = g.number({0, 255});
     }},
    {"merge-neighbours", 0, "",
     "Join adjacent polygons of one colour into one path in .svg and .pdf, if nothing is painted over them.",
     Group::output, for_render, [](Settings& s, const Given&) { s.output.merges_neighbours = true; }},
    {"most-polygons", 0, "N", "Refuse to write .svg and .pdf files with more than N polygons; 2000000 by default.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.most_polygons = std::size_t(g.integer({1, 1000000000}));
     }},
    {"format", 0, "png|exr|pfm|npy|jpg|webp", "Format of output files without a known suffix, such as -.",
     Group::output, for_render, [](Settings& s, const Given& g) { s.output.format = g.choice<ImageFormat>(); }},
    {"bits", 0, "8|16", "Bits per channel of PNG pictures; 8 by default.", Group::output, for_render,
     [](Settings& s, const Given& g) { s.output.bits = g.choice<int>() == 0 ? 8 : 16; }},
    {"quality", 0, "Q", "Quality of .jpg and .webp, 1 to 100; 90 by default.", Group::output,
     for_render | for_precision,
     [](Settings& s, const Given& g) {
       s.output.quality = g.integer({1, 100});
     }},
    {"depth-scale", 0, "FACTOR",
     "Multiply distances by this factor, and round, for depths in PNG; by default the visible range fills 16 bits.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.depth_scale = g.number({1e-12, 1e12});
     }},
    {"background-depth", 0, "DISTANCE", "Depth of pixels in which nothing is visible; inf by default.", Group::output,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.background_depth =
           g.text == "inf" ? std::numeric_limits<float>::infinity() : float(g.number({-3e38, 3e38}));
     }},
    {"hash", 0, "", "Print a content hash of the visible surfaces, and of each output except .svg and .pdf.",
     Group::output, for_render, [](Settings& s, const Given&) { s.output.hash = true; }},
    {"reference", 0, "FILE", "Compare the picture with this file; the exit status is 3 if they differ.", Group::output,
     for_render, [](Settings& s, const Given& g) { s.output.reference = g.file_name(); }},
    {"reference-threshold", 0, "T",
     "Largest difference that --reference accepts, 0 to 1 of a channel's range; 0 by default.", Group::output,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.reference_threshold = g.number({0, 1});
     }},
    {"reference-difference", 0, "FILE",
     "File for the picture of differences; by default beside the picture, with the suffix .difference.png.",
     Group::output, for_render, [](Settings& s, const Given& g) { s.output.reference_difference = g.file_name(); }},

    {"shading", 0, "lit|flat|normals|depth|ids|uv", "Values that the picture shows; lit by default.", Group::look,
     for_render, [](Settings& s, const Given& g) { s.output.shading = g.choice<Shading>(); }},
    {"edges", 0, "",
     "Draw the visible edges over the picture, as frontmost lines finds them: silhouettes, boundaries, creases, "
     "borders and intersections. Translucent surfaces hide edges, too.",
     Group::look, for_render, [](Settings& s, const Given&) { s.output.edges = true; }},
    {"edge-width", 0, "PIXELS",
     "Width of --edges, 0.1 to 100; by default 1/900 of the picture's shorter side, at least 1.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.edge_width = g.number({0.1, 100});
     }},
    {"background", 0, "COLOR",
     "Background: #rrggbb, r,g,b from 0 to 1, a common colour name, or transparent; white by default.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.background_given = true;
       s.output.background = std::nullopt;
       if (g.text != "transparent") s.output.background = parse_color(g.text);
     }},
    {"lights", 0, "key|file|both|none",
     "Direct lights: a key light that moves with the camera, the model's own lights, both, or none; key by default.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.lights = g.choice<Lights>(); }},
    {"shadows", 0, "off|map|rays", "Shadows: none, soft ones by maps, or sharp ones by rays; map by default.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.shadows = g.choice<Shadows>(); }},
    {"no-shadows", 0, "", "Short for --shadows off.", Group::look, for_render,
     [](Settings& s, const Given&) { s.output.shadows = Shadows::off; }},
    {"ambient-occlusion", 0, "STRENGTH",
     "Weaken the environment's light in corners and near contacts, 0 to 1; 1 removes all light that visible surfaces "
     "occlude; 0, none, by default.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       s.output.ambient_occlusion = g.number({0, 1});
     }},
    {"occlusion-radius", 0, "DISTANCE",
     "Reach of --ambient-occlusion: surfaces farther away occlude nothing; by default a tenth of the diagonal of the "
     "objects that --frame subject fits.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       const double radius = g.number();
       if (!(radius > 0)) throw UsageError("must be above 0");
       s.output.occlusion_radius = radius;
     }},
    {"opacity", 0, "O",
     "Multiply every opacity by this, 0 to 1, so that all surfaces become translucent; 1 by default.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.opacity = float(g.number({0, 1}));
     }},
    {"blend", 0, "linear|srgb",
     "Blend translucent surfaces and samples in linear light, the default, or in sRGB, as viewers of SVG and PDF do, "
     "so that pictures look like .svg and .pdf files. Those files are blended by their viewers.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.blend = g.choice<Blend>(); }},
    {"environment", 0, "FILE",
     "Environment light: an equirectangular .hdr or .exr file, studio, sky or none; studio by default.", Group::look,
     for_render, [](Settings& s, const Given& g) { s.output.light.environment = g.file_name(); }},
    {"environment-angle", 0, "DEGREES",
     "Turn the environment about the model's up axis, counter-clockwise seen from above.", Group::look, for_render,
     [](Settings& s, const Given& g) {
       s.output.light.options.environment_angle = g.number({-360000, 360000}) * radians_per_degree;
     }},
    {"show-environment", 0, "", "Show the environment in place of the background.", Group::look, for_render,
     [](Settings& s, const Given&) { s.output.light.options.shows_environment = true; }},
    {"exposure", 0, "STOPS", "Multiply light by 2^STOPS before tone mapping, -32 to 32; 0 by default.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.light.options.exposure = g.number({-32, 32});
     }},
    {"tone-mapping", 0, "none|aces|khronos",
     "Mapping of light that is brighter than white. none, the default: clamp each channel. aces: filmic. khronos: keep "
     "base colours, fade brighter ones to white.",
     Group::look, for_render,
     [](Settings& s, const Given& g) { s.output.light.options.tone_mapping = g.choice<ToneMapping>(); }},
    {"light-direction", 0, "X,Y,Z",
     "Direction towards the key light, in world space, or an axis such as +z; by default the camera's upper left.",
     Group::look, for_render,
     [](Settings& s, const Given& g) { s.output.light.options.direction = parse_direction(g.text); }},
    {"light-intensity", 0, "FACTOR",
     "Multiply the key light by this; 0 turns it off. 1 by default, 0 if --environment is a file.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.light.options.intensity = g.number({0, 1e6});
     }},
};

}  // namespace

std::span<const Option> output_option_table() { return output_options; }

}  // namespace frontmost::cli
