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
    {"up", 0, "AXIS", "Which way is up in the model: +x, +y, +z, -x, -y or -z; the file format's by default.",
     Group::model, for_every_model, [](Settings& s, const Given& g) { s.load.up = axis_of(parse_direction(g.text)); }},
    {"input-format", 0, "stl|ply|obj|off|gltf|3mf|scene",
     "Format of the model; by default from its name, or its first bytes.", Group::model, for_every_model,
     [](Settings& s, const Given& g) { s.load.format = g.choice<ModelFormat>(); }},
    {"allow-outside", 0, "FOLDER",
     "Folder in which a scene file may name models by paths that leave its own folder; may be given several times.",
     Group::model, for_every_model | may_repeat,
     [](Settings& s, const Given& g) { s.load.allow_outside.push_back(g.file_name()); }},

    {"view", 0, "front|back|left|right|top|bottom|iso", "Look from there, far enough away to see the model.",
     Group::camera, for_views, [](Settings& s, const Given& g) { s.view.named = g.choice<NamedView>(); }},
    {"frame", 0, "subject|all",
     "What is fitted into the picture: by default the objects that hold most of the model's detail, without those "
     "that reach eight times as far and farther, such as a plane under a village; or all of it.",
     Group::camera, for_views & ~for_lines,
     [](Settings& s, const Given& g) { s.view.framed = g.choice<FramedObjects>(); }},
    {"camera-position", 0, "X,Y,Z", "Where the eye is.", Group::camera, for_views,
     [](Settings& s, const Given& g) { s.view.position = parse_vector(g.text); }},
    {"camera-focal-point", 0, "X,Y,Z", "What the eye looks at; by default the middle of what is framed.", Group::camera,
     for_views, [](Settings& s, const Given& g) { s.view.focal_point = parse_vector(g.text); }},
    {"camera-direction", 0, "X,Y,Z", "Which way the eye looks; also an axis, such as -z.", Group::camera, for_views,
     [](Settings& s, const Given& g) { s.view.direction = parse_direction(g.text); }},
    {"camera-view-up", 0, "X,Y,Z", "Which way is up in the picture; also an axis.", Group::camera, for_views,
     [](Settings& s, const Given& g) { s.view.view_up = parse_direction(g.text); }},
    {"camera-view-angle", 0, "DEGREES", "Vertical field of view, 0.001 to 179; 30 for the smaller side by default.",
     Group::camera, for_views,
     [](Settings& s, const Given& g) {
       s.view.view_angle = g.number({0.001, 179});
     }},
    {"camera-zoom-factor", 0, "FACTOR", "Divide the view angle (or the height, if orthographic) by this.",
     Group::camera, for_views,
     [](Settings& s, const Given& g) {
       s.view.zoom = g.number({1e-3, 1e6});
     }},
    {"camera-azimuth-angle", 0, "DEGREES", "Then turn the eye to the right about what it looks at.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.azimuth = g.number({-36000, 36000});
     }},
    {"camera-elevation-angle", 0, "DEGREES", "Then turn the eye upwards about what it looks at.", Group::camera,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.elevation = g.number({-36000, 36000});
     }},
    {"camera-orthographic", 0, "", "Parallel projection.", Group::camera, for_views,
     [](Settings& s, const Given&) { s.view.orthographic = true; }},
    {"camera-index", 0, "N", "Look through the model's own camera of this number, from 0.", Group::camera, for_views,
     [](Settings& s, const Given& g) {
       s.view.camera_index = g.integer({0, 1e6});
     }},

    {"camera-model", 0, "pinhole|panorama|fisheye",
     "How pixels look: through a pinhole, all around (equirectangular), or by equal angles from the axis; each with "
     "textures, glass, shadows and samples.",
     Group::camera, for_render, [](Settings& s, const Given& g) { s.view.camera_model = g.choice<CameraModel>(); }},
    {"fov", 0, "DEGREES", "Full field of view of a fisheye, 0.001 to 360; 180 by default.", Group::camera, for_render,
     [](Settings& s, const Given& g) {
       s.view.fisheye_angle = g.number({0.001, 360});
     }},

    {"intrinsics", 0, "FX,FY,CX,CY", "Pinhole camera matrix, in pixels.", Group::vision, for_views,
     [](Settings& s, const Given& g) {
       const std::vector<double> k = parse_numbers(g.text, 4);
       if (!(k[0] > 0 && k[1] > 0)) throw UsageError("focal lengths must be above 0");
       s.view.intrinsics = {k[0], k[1], k[2], k[3]};
     }},
    {"pixel-center", 0, "half|integer",
     "Where cx,cy put the centre of the first pixel: 0.5,0.5 (OpenGL) or 0,0 (OpenCV, the default).", Group::vision,
     for_views, [](Settings& s, const Given& g) { s.view.pixel_rule = g.choice<PixelRule>(); }},
    {"pose", 0, "FILE", "Camera pose: 16 numbers row by row, or a file that holds them. Needs --pose-convention.",
     Group::vision, for_views, [](Settings& s, const Given& g) { set_pose(s.view, g); }},
    {"pose-convention", 0,
     "opengl-camera-to-world|opengl-world-to-camera|opencv-camera-to-world|opencv-world-to-camera|"
     "robot-camera-to-world|robot-world-to-camera",
     "What the pose maps, and its axes: opengl looks down -z with y up, opencv down +z with y down, robot down +x with "
     "z up.",
     Group::vision, for_views,
     [](Settings& s, const Given& g) { s.view.pose_convention = g.choice<PoseConvention>(); }},

    {"resolution", 0, "W,H", "Pixels, 1 to 16384 each; 1920,1080 by default.", Group::grid, for_views,
     [](Settings& s, const Given& g) { s.view.resolution = resolution_from(g.text); }},
    {"samples", 0, "1|2|4|8|16|64",
     "Samples per pixel of the picture; 4 by default, fewer above 8192 x 8192; 64 with --method abuffer, up to 16 "
     "with --camera-model. Maps have one, at pixel centres. compare: of every method, 1 by default, 16 at most.",
     Group::grid, for_render | for_compare,
     [](Settings& s, const Given& g) {
       constexpr int counts[] = {1, 2, 4, 8, 16, 64};
       s.view.samples = counts[g.choice<int>()];
     }},
    {"near", 0, "DISTANCE", "Nearest distance that is drawn; fitted to the model by default.", Group::grid, for_views,
     [](Settings& s, const Given& g) { s.view.near = g.number(); }},
    {"far", 0, "DISTANCE", "Farthest distance that is drawn, or inf; fitted to the model by default.", Group::grid,
     for_views,
     [](Settings& s, const Given& g) {
       s.view.far = g.text == "inf" ? std::numeric_limits<double>::infinity() : g.number();
     }},
    {"cull", 0, "none|back|front|both|material",
     "Leave out triangles that face this way; material: backs, where the material is not double-sided.", Group::grid,
     for_render | for_camera | for_precision | for_compare | for_report | for_visible | for_explain,
     [](Settings& s, const Given& g) { s.view.culling = g.choice<Culling>(); }},
    {"tessellation-error", 0, "PIXELS",
     "Cut spheres and patches into triangles within that many pixels of the surface. Without it lines cuts as finely "
     "as its paper shows, and others draw the triangles of the model.",
     Group::grid, for_render | for_compare | for_lines | for_report | for_explain,
     [](Settings& s, const Given& g) {
       s.view.tessellation_error = g.number({1e-3, 1e3});
     }},
};

}  // namespace

std::span<const Option> view_option_table() { return view_options; }

}  // namespace frontmost::cli
