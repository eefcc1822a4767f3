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
     "The picture: .png, .jpg, .webp, .exr, .pfm or .npy, or its polygons: .svg or .pdf; - is standard output. {model} "
     "and {view} stand for names.",
     Group::output, written, [](Settings& s, const Given& g) { add_file(s, OutputKind::picture, g.text); }},
    {"depth", 0, "FILE", "Distance along the viewing axis, in scene units.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::depth, g.text); }},
    {"ray-distance", 0, "FILE", "Distance from the eye, in scene units.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::ray_distance, g.text); }},
    {"window-depth", 0, "FILE", "The depth buffer's values from 0 to 1, as glReadPixels gives them.", Group::output,
     written,
     [](Settings& s, const Given& g) {
       s.view.depth.is_used = true;
       add_file(s, OutputKind::window_depth, g.text);
     }},
    {"ids", 0, "KIND=FILE", "Which primitive, object or material is seen: primitive=FILE, object=FILE, material=FILE.",
     Group::output, written, [](Settings& s, const Given& g) { add_ids(s, g.text); }},
    {"normals", 0, "FILE", "World-space normals.", Group::output, written,
     [](Settings& s, const Given& g) { add_file(s, OutputKind::normals, g.text); }},
    {"deep", 0, "FILE", "All that is seen through, as a deep OpenEXR file: colour, depth and ids of every layer.",
     Group::output, written, [](Settings& s, const Given& g) { add_file(s, OutputKind::deep, g.text); }},
    {"layers", 0, "K", "Write the K nearest layers, 1 to 1024: a file of each where its name holds {layer}, from 0.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.layers = g.integer({1, 1024});
     }},
    {"visible-only", 0, "yes|no",
     "Leave out of .svg and .pdf what is hidden, and cut what is hidden in part; yes by default.", Group::output,
     for_render, [](Settings& s, const Given& g) { s.output.visible_only = g.choice<int>() == 0; }},
    {"color-tolerance", 0, "STEPS",
     "Cut polygons of .svg and .pdf whose colour varies by more than so many of 255 steps; 6 by default, 255: never.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.color_tolerance = g.number({0, 255});
     }},
    {"merge-neighbours", 0, "",
     "Make neighbours of one colour one path in .svg and .pdf, where nothing lies above them.", Group::output,
     for_render, [](Settings& s, const Given&) { s.output.merges_neighbours = true; }},
    {"most-polygons", 0, "N", "Refuse .svg and .pdf files of more polygons; 2000000 by default.", Group::output,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.most_polygons = std::size_t(g.integer({1, 1000000000}));
     }},
    {"format", 0, "png|exr|pfm|npy|jpg|webp", "Format of files whose names do not say, such as -.", Group::output,
     for_render, [](Settings& s, const Given& g) { s.output.format = g.choice<ImageFormat>(); }},
    {"bits", 0, "8|16", "Bits a channel of PNG pictures; 8 by default.", Group::output, for_render,
     [](Settings& s, const Given& g) { s.output.bits = g.choice<int>() == 0 ? 8 : 16; }},
    {"quality", 0, "Q", "How near .jpg and .webp come to the picture, 1 to 100; 90 by default.", Group::output,
     for_render | for_precision,
     [](Settings& s, const Given& g) {
       s.output.quality = g.integer({1, 100});
     }},
    {"depth-scale", 0, "FACTOR", "PNG depth is distance times this, rounded; by default the range seen fills 16 bits.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.depth_scale = g.number({1e-12, 1e12});
     }},
    {"background-depth", 0, "DISTANCE", "Depth where nothing is seen; inf by default.", Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.background_depth =
           g.text == "inf" ? std::numeric_limits<float>::infinity() : float(g.number({-3e38, 3e38}));
     }},
    {"hash", 0, "", "Print a content hash of what is visible and of each result but .svg and .pdf.", Group::output,
     for_render, [](Settings& s, const Given&) { s.output.hash = true; }},
    {"reference", 0, "FILE", "Compare the picture with this one; exit status 3 if it differs.", Group::output,
     for_render, [](Settings& s, const Given& g) { s.output.reference = g.file_name(); }},
    {"reference-threshold", 0, "T", "Largest difference that passes, 0 to 1 of a channel's range; 0 by default.",
     Group::output, for_render,
     [](Settings& s, const Given& g) {
       s.output.reference_threshold = g.number({0, 1});
     }},
    {"reference-difference", 0, "FILE", "Where the difference goes; by default beside the picture, .difference.png.",
     Group::output, for_render, [](Settings& s, const Given& g) { s.output.reference_difference = g.file_name(); }},

    {"shading", 0, "lit|flat|normals|depth|ids|uv", "What the picture shows; lit by default.", Group::look, for_render,
     [](Settings& s, const Given& g) { s.output.shading = g.choice<Shading>(); }},
    {"background", 0, "COLOR", "#rrggbb, r,g,b from 0 to 1, a plain colour name, or transparent; white by default.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       s.output.background_given = true;
       s.output.background = std::nullopt;
       if (g.text != "transparent") s.output.background = parse_color(g.text);
     }},
    {"lights", 0, "key|file|both|none",
     "Which lights shine: one that moves with the camera, those of the model, both, or none; key by default.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.lights = g.choice<Lights>(); }},
    {"shadows", 0, "off|map|rays", "Shadows: none, soft ones by maps, or sharp ones by rays; map by default.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.shadows = g.choice<Shadows>(); }},
    {"no-shadows", 0, "", "As --shadows off.", Group::look, for_render,
     [](Settings& s, const Given&) { s.output.shadows = Shadows::off; }},
    {"ambient-occlusion", 0, "STRENGTH",
     "Darken corners, and what stands on something: 0, the default, to 1, as much as what the picture shows hides.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       s.output.ambient_occlusion = g.number({0, 1});
     }},
    {"occlusion-radius", 0, "DISTANCE",
     "What is farther away hides nothing with --ambient-occlusion; by default a tenth of the diagonal of what "
     "--frame subject fits.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       const double radius = g.number();
       if (!(radius > 0)) throw UsageError("must be above 0");
       s.output.occlusion_radius = radius;
     }},
    {"opacity", 0, "O", "See through everything: multiplies every opacity, 0 to 1; 1 by default.", Group::look,
     for_render,
     [](Settings& s, const Given& g) {
       s.output.opacity = float(g.number({0, 1}));
     }},
    {"blend", 0, "linear|srgb",
     "Blend what is half transparent, and samples, as light, the default, or as viewers blend the shapes of SVG "
     "and PDF, which are then looked at alike. Figures are blended by their viewers.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.blend = g.choice<Blend>(); }},
    {"environment", 0, "FILE",
     "Light from all around: an equirectangular .hdr or .exr file, studio, sky or none; studio by default.",
     Group::look, for_render, [](Settings& s, const Given& g) { s.output.light.environment = g.file_name(); }},
    {"environment-angle", 0, "DEGREES", "Turn the environment about the model's up, counter-clockwise from above.",
     Group::look, for_render,
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
     "How light brighter than white is shown: cut off, filmic, or faded with base colours kept; none by default.",
     Group::look, for_render,
     [](Settings& s, const Given& g) { s.output.light.options.tone_mapping = g.choice<ToneMapping>(); }},
    {"light-direction", 0, "X,Y,Z",
     "Towards the key light, in the world, or an axis such as +z; upper left by default.", Group::look, for_render,
     [](Settings& s, const Given& g) { s.output.light.options.direction = parse_direction(g.text); }},
    {"light-intensity", 0, "FACTOR", "Of the key light, 0 for none; 1 by default, 0 beside an environment's file.",
     Group::look, for_render,
     [](Settings& s, const Given& g) {
       s.output.light.options.intensity = g.number({0, 1e6});
     }},
};

}  // namespace

std::span<const Option> output_option_table() { return output_options; }

}  // namespace frontmost::cli
