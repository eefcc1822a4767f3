// SPDX-License-Identifier: Apache-2.0
// Options of the model and of the camera.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr unsigned for_views =
    for_render | for_camera | for_precision | for_compare | for_lines | for_report | for_visible | for_explain;
constexpr int max_side = 16384;

Axis axis_of(const glm::dvec3& direction) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::minus_x, Axis::minus_y, Axis::minus_z}) {
    if (frontmost::direction(axis) == direction) return axis;
  }
  throw UsageError("up is one of +x, +y, +z, -x, -y, -z");
}

void set_pose(ViewSettings& view, const Given& given) {
  const std::string name = given.file_name();
  view.pose = parse_matrix(name);
  view.pose_file.reset();
  if (!view.pose) view.pose_file = name;
}

glm::ivec2 resolution_from(std::string_view text) {
  // "1920x1080" is the form that most people type first.
  std::string spelled(text);
  if (const std::size_t x = spelled.find('x'); x != std::string::npos && spelled.find(',') == std::string::npos) {
    spelled[x] = ',';
  }
  const std::vector<double> sides = parse_numbers(spelled, 2);
  for (const double side : sides) {
    if (!(side >= 1 && side <= max_side && side == double(int(side)))) {
      throw UsageError("'" + std::string(text) + "': width and height are whole numbers from 1 to 16384");
    }
  }
  return {int(sides[0]), int(sides[1])};
}

constexpr Option view_options[] = {
    {"up", 0, "AXIS", "The model's up axis: +x, +y, +z, -x, -y or -z; by default that of the file format.",
     Group::model, for_every_model, [](Settings& s, const Given& g) { s.load.up = axis_of(parse_direction(g.text)); }},
    {"input-format", 0, "stl|ply|obj|off|gltf|3mf|scene|step|iges|brep|foreign",
     "Format of the model; by default found from the file name, or from the first bytes.", Group::model,
     for_every_model, [](Settings& s, const Given& g) { s.load.format = g.choice<ModelFormat>(); }},
    {"allow-outside", 0, "FOLDER",
     "Folder outside the scene file's own folder from which the scene file may load models. May be given several "
     "times.",
     Group::model, for_every_model | may_repeat,
     [](Settings& s, const Given& g) { s.load.allow_outside.push_back(g.file_name()); }},

    {"mesh-tolerance", 0, "MM",
     "STEP, IGES, BREP: greatest distance of triangles from the surface, in millimetres; by default 0.05 % of the "
     "model's diagonal, or 0.02 mm on the paper of lines --scale A:B.",
     Group::model, for_every_model,
     [](Settings& s, const Given& g) {
       s.load.import.tolerance = g.number({1e-6, 1e6});
     }},
    {"mesh-angle", 0, "DEGREES",
     "STEP, IGES, BREP: greatest angle between the normals of neighbouring triangles, 0.1 to 90; 12 by default.",
     Group::model, for_every_model,
     [](Settings& s, const Given& g) {
       s.load.import.angle = glm::radians(g.number({0.1, 90}));
     }},
    {"import-seconds", 0, "SECONDS",
     "STEP and other formats that frontmost-import reads: greatest time for reading; 600 by default.", Group::model,
     for_every_model,
     [](Settings& s, const Given& g) {
       s.load.import.seconds = g.number({0.1, 1e6});
     }},
    {"import-gigabytes", 0, "N", "The same formats: greatest memory for reading; 8 by default.", Group::model,
     for_every_model,
     [](Settings& s, const Given& g) {
       s.load.import.bytes = std::uint64_t(g.number({0.1, 4096}) * 0x1p30);
     }},
    {"no-cache", 0, "",
     "STEP, IGES, BREP: neither keep a copy of the file and its triangles in $XDG_CACHE_HOME/frontmost/import (else "
     "~/.cache/frontmost/import) nor take them from there; by default a file that was read before is "
     "quick to read.",
     Group::model, for_every_model, [](Settings& s, const Given&) { s.load.import.cache = false; }},

    {"view", 0, "front|back|left|right|top|bottom|iso",
     "Look at the model from this side, far enough away to see all that --frame selects.", Group::camera, for_views,
     [](Settings& s, const Given& g) { s.view.named = g.choice<NamedView>(); }},
    {"frame", 0, "subject|all",
     "What is fitted into the picture. subject, the default: the objects with most of the model's detail, without "
     "those that reach at least eight times as far, such as a ground plane under a village. all: every object.",
     Group::camera, for_views & ~for_lines,
     [](Settings& s, const Given& g) { s.view.framed = g.choice<FramedObjects>(); }},
    {"camera-position", 0, "X,Y,Z", "Position of the eye.", Group::camera, for_views,
     [](Settings& s, const Given& g) { s.view.position = parse_vector(g.text); }},
    {"camera-focal-point", 0, "X,Y,Z", "Point that the eye looks at; by default the middle of the framed objects.",
     Group::camera, for_views, [](Settings& s, const Given& g) { s.view.focal_point = parse_vector(g.text); }},
    {"camera-direction", 0, "X,Y,Z", "Direction in which the eye looks; also an axis, such as -z.", Group::camera,
     for_views, [](Settings& s, const Given& g) { s.view.direction = parse_direction(g.text); }},
    {"camera-view-up", 0, "X,Y,Z", "Direction that is up in the picture; also an axis, such as +z.", Group::camera,
     for_views, [](Settings& s, const Given& g) { s.view.view_up = parse_direction(g.text); }},
    {"camera-view-angle", 0, "DEGREES",
     "Vertical field of view, 0.001 to 179. By default the smaller side of the picture has 30 degrees.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.view_angle = g.number({0.001, 179});
     }},
    {"camera-zoom-factor", 0, "FACTOR",
     "Divide the view angle by this factor; with --camera-orthographic, the height of the view.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.zoom = g.number({1e-3, 1e6});
     }},
    {"camera-azimuth-angle", 0, "DEGREES", "Then turn the eye to the right about the focal point.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.azimuth = g.number({-36000, 36000});
     }},
    {"camera-elevation-angle", 0, "DEGREES", "Then turn the eye upwards about the focal point.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.elevation = g.number({-36000, 36000});
     }},
    {"camera-orthographic", 0, "", "Use parallel projection.", Group::camera, for_views,
     [](Settings& s, const Given&) { s.view.orthographic = true; }},
    {"camera-index", 0, "N", "Use the model's own camera of this number, counted from 0.", Group::camera, for_views,
     [](Settings& s, const Given& g) {
       s.view.camera_index = g.integer({0, 1e6});
     }},

    {"camera-model", 0, "pinhole|panorama|fisheye",
     "Projection. pinhole: perspective or parallel, the default. panorama: all around, equirectangular. fisheye: "
     "distance from the middle proportional to the angle from the axis. All support textures, glass, shadows and "
     "samples.",
     Group::camera, for_render, [](Settings& s, const Given& g) { s.view.camera_model = g.choice<CameraModel>(); }},
    {"fov", 0, "DEGREES", "Full field of view of a fisheye, 0.001 to 360; 180 by default.", Group::camera, for_render,
     [](Settings& s, const Given& g) {
       s.view.fisheye_angle = g.number({0.001, 360});
     }},

    {"intrinsics", 0, "FX,FY,CX,CY", "Focal lengths and principal point of a pinhole camera, in pixels.", Group::vision,
     for_views,
     [](Settings& s, const Given& g) {
       const std::vector<double> k = parse_numbers(g.text, 4);
       if (!(k[0] > 0 && k[1] > 0)) throw UsageError("focal lengths must be above 0");
       s.view.intrinsics = {k[0], k[1], k[2], k[3]};
     }},
    {"pixel-center", 0, "half|integer",
     "Coordinates of the first pixel's centre in --intrinsics: 0.5,0.5 (half, as in OpenGL) or 0,0 (integer, as in "
     "OpenCV, the default).",
     Group::vision, for_views, [](Settings& s, const Given& g) { s.view.pixel_rule = g.choice<PixelRule>(); }},
    {"pose", 0, "FILE", "Camera pose: 16 numbers row by row, or a file that holds them. Needs --pose-convention.",
     Group::vision, for_views, [](Settings& s, const Given& g) { set_pose(s.view, g); }},
    {"pose-convention", 0,
     "opengl-camera-to-world|opengl-world-to-camera|opencv-camera-to-world|opencv-world-to-camera|"
     "robot-camera-to-world|robot-world-to-camera",
     "Direction of the --pose matrix, and the camera's axes: opengl looks along -z with y up, opencv along +z with y "
     "down, robot along +x with z up.",
     Group::vision, for_views,
     [](Settings& s, const Given& g) { s.view.pose_convention = g.choice<PoseConvention>(); }},

    {"resolution", 0, "W,H", "Width and height in pixels, 1 to 16384 each; 1920,1080 by default.", Group::grid,
     for_views, [](Settings& s, const Given& g) { s.view.resolution = resolution_from(g.text); }},
    {"samples", 0, "1|2|4|8|16|64",
     "Samples per pixel of the picture; 4 by default, fewer above 8192 x 8192 pixels. 64 needs --method abuffer; "
     "--camera-model takes up to 16. Maps have one sample, at pixel centres. compare: samples of every method, 1 by "
     "default, 16 at most.",
     Group::grid, for_render | for_compare,
     [](Settings& s, const Given& g) {
       constexpr int counts[] = {1, 2, 4, 8, 16, 64};
       s.view.samples = counts[g.choice<int>()];
     }},
    {"near", 0, "DISTANCE", "Distance of the near plane; fitted to the model by default.", Group::grid, for_views,
     [](Settings& s, const Given& g) { s.view.near = g.number(); }},
    {"far", 0, "DISTANCE", "Distance of the far plane, or inf; fitted to the model by default.", Group::grid, for_views,
     [](Settings& s, const Given& g) {
       s.view.far = g.text == "inf" ? std::numeric_limits<double>::infinity() : g.number();
     }},
    {"cull", 0, "none|back|front|both|material",
     "Leave out triangles of which the eye sees this side. material: backs, unless the material is double-sided.",
     Group::grid, for_render | for_camera | for_precision | for_compare | for_report | for_visible | for_explain,
     [](Settings& s, const Given& g) { s.view.culling = g.choice<Culling>(); }},
    {"tessellation-error", 0, "PIXELS",
     "Cut spheres and patches into triangles that are within so many pixels of the surface. Without this option, lines "
     "cuts as finely as the paper shows, and other commands draw the model's own triangles.",
     Group::grid, for_render | for_compare | for_lines | for_report | for_explain,
     [](Settings& s, const Given& g) {
       s.view.tessellation_error = g.number({1e-3, 1e3});
     }},
};

}  // namespace

std::span<const Option> view_option_table() { return view_options; }

}  // namespace frontmost::cli
