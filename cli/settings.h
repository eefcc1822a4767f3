// SPDX-License-Identifier: Apache-2.0
// The user's settings as given, by flags or by a batch file, to be resolved later.
//
// Values are not checked against each other or against a model. A value that was not given is empty. So later code can
// tell it from the default, and a view of a batch can inherit the command line's value.
#pragma once

#include <frontmost/base.h>
#include <frontmost/files.h>
#include <frontmost/image.h>
#include <frontmost/pictures.h>
#include <frontmost/report.h>
#include <frontmost/sheets.h>
#include <frontmost/view.h>
#include <frontmost/zbuffer.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace frontmost::cli {

/// State of a depth buffer that replaces the exact default.
struct DepthSettings {
  bool is_used = false;
  DepthFormat format = DepthFormat::d24;
  std::optional<DepthFunc> func;
  bool mask = true, reversed = false;
  std::optional<double> clear;
  glm::dvec2 range{0, 1};
  PolygonOffset offset;
};

/// The shape of the pixels' rays. All cameras but pinholes are ray cast.
enum class CameraModel : std::uint8_t { pinhole, panorama, fisheye };

/// The camera and the pixel grid.
struct ViewSettings {
  std::string name;  ///< {view} in file names; empty: derived from the flags
  std::optional<NamedView> named;
  std::optional<glm::dvec3> position, focal_point, view_up, direction;
  std::optional<double> view_angle;  ///< vertical, degrees
  double zoom = 1, azimuth = 0, elevation = 0;
  bool orthographic = false;
  std::optional<int> camera_index;
  CameraModel camera_model = CameraModel::pinhole;
  std::optional<double> fisheye_angle;              ///< full angle in degrees
  std::optional<std::array<double, 4>> intrinsics;  ///< fx, fy, cx, cy
  PixelRule pixel_rule = PixelRule::centre_at_integer;
  std::optional<glm::dmat4> pose;
  std::optional<std::string> pose_file;  ///< path of the pose's file; read_pose_file() sets `pose`
  std::optional<PoseConvention> pose_convention;
  std::optional<FramedObjects> framed;  ///< objects to fit into the picture; by default the subject
  std::optional<double> near, far;
  std::optional<glm::ivec2> resolution;
  Culling culling = Culling::none;
  std::optional<int> samples;                ///< 1 to 16, or 64 for the A-buffer
  std::optional<double> tessellation_error;  ///< pixels
  DepthSettings depth;
};

/// The contents of a file to write.
enum class OutputKind : std::uint8_t {
  picture,
  deep,
  depth,
  ray_distance,
  window_depth,
  normals,
  primitive_ids,
  object_ids,
  material_ids
};
struct OutputRequest {
  OutputKind kind;
  std::string path;  ///< "-" is standard output; may hold {model}, {view} and {layer}
};

/// The light of lit pictures.
struct LightSettings {
  std::optional<std::string> environment;  ///< a file, "studio", "sky" or "none"
  /// All options but the environment, which is made when the picture is drawn.
  LightOptions options;
};

/// Outputs and their look.
struct OutputSettings {
  std::vector<OutputRequest> files;
  std::optional<ImageFormat> format;
  int bits = 8, quality = 90;
  std::optional<double> depth_scale;
  float background_depth = std::numeric_limits<float>::infinity();
  std::optional<std::string> reference, reference_difference;
  double reference_threshold = 0;
  bool hash = false;
  Shading shading = Shading::lit;
  std::optional<glm::vec3> background = glm::vec3(1.0f);  ///< none: transparent
  bool background_given = false;
  std::optional<Lights> lights;  ///< none: the key light
  Shadows shadows = Shadows::map;
  float opacity = 1;
  double ambient_occlusion = 0;  ///< strength
  std::optional<double> occlusion_radius;
  Blend blend = Blend::linear;
  LightSettings light;
  bool visible_only = true;             ///< for figures
  std::size_t most_polygons = 2000000;  ///< for figures
  double color_tolerance = 6;           ///< for figures, in steps of 8 bits
  bool merges_neighbours = false;       ///< for figures
  bool edges = false;                   ///< whether pictures show the visible edges
  std::optional<double> edge_width;     ///< pixels; none: by the size of the picture
  std::optional<int> layers;            ///< number of nearest layers for files with {layer} in their names
};

/// The method that determines visibility.
enum class Method : std::uint8_t { zbuffer, raycast, abuffer };

/// A part of a batch: every `count`-th view, beginning with view number - 1.
struct Shard {
  int number = 1, count = 1;

  [[nodiscard]] bool contains(std::size_t view) const { return view % std::size_t(count) == std::size_t(number - 1); }
};

/// Options of the run.
struct RunSettings {
  std::optional<Method> method;  ///< empty: the z-buffer, or the A-buffer for pictures that need it
  int threads = 0;
  Isa isa = Isa::best;
  int repeat = 1;
  std::optional<double> timeout;
  bool json = false, quiet = false, stream = false;
  bool mpi = false;  ///< whether to stream together with other ranks
  std::optional<std::string> batch;
  std::optional<Shard> shard;  ///< part of the batch
};

/// Settings of frontmost precision.
struct PrecisionSettings {
  std::optional<DepthFormat> format;  ///< empty: common formats
  bool infinite = false;
  std::optional<glm::dvec2> wanted;  ///< a gap, and the distance at which it must be resolved
  std::optional<std::string> plot, heat_map;
};

/// Settings of frontmost compare.
struct CompareSettings {
  std::optional<int> runs;  ///< empty: default_runs, but 1 for a method slower than longest_repeated
  static constexpr int default_runs = 5;
  static constexpr double longest_repeated = 2000;  ///< milliseconds

  [[nodiscard]] int most_runs() const { return runs.value_or(default_runs); }
  bool explain = false;
  std::optional<std::string> folder;  ///< for the page and its pictures
};

/// Settings of frontmost sight.
struct SightSettings {
  std::optional<glm::dvec3> from, to;
  std::optional<std::string> pairs;
};

/// Settings of frontmost lidar.
struct LidarSettings {
  std::optional<glm::dvec3> from, forward;
  std::optional<int> rings, steps;
  std::optional<glm::dvec2> elevations;       ///< lowest and highest, degrees
  std::vector<double> ring_elevations;        ///< degrees; empty: evenly spread
  std::optional<glm::dvec2> azimuths, range;  ///< degrees; least and greatest
  std::optional<std::string> directions;
  bool robot_axes = false;
  std::vector<std::string> outputs;
};

/// Settings of frontmost lines.
struct DrawingSettings {
  /// Texts of a title block (ISO 7200); empty: not given.
  struct TitleTexts {
    std::optional<std::string> title, number, author, date, owner;
  };

  SheetOptions sheet;  ///< options that are passed to the library unchanged
  std::optional<ProjectionMethod> projection;
  std::optional<double> hatch_angle;  ///< radians
  std::optional<glm::dvec3> light;    ///< direction to the light: right, up, towards the viewer
  std::optional<bool> casts_shadows;
  bool frame = false;
  TitleTexts texts;
  int number = 1, count = 1;  ///< number of this sheet and number of all sheets, if there are several models
  std::optional<PageFormat> format;
  std::vector<std::string> outputs;
  std::vector<std::string> books;  ///< files with the sheets of several models as pages

  [[nodiscard]] bool is_sheet() const { return !sheet.views.empty() || !sheet.sections.empty(); }
  /// Whether there is a frame, which a title block needs, too.
  [[nodiscard]] bool has_frame() const {
    return frame || texts.title || texts.number || texts.author || texts.date || texts.owner;
  }
};

/// Settings of frontmost report.
struct ReportSettings {
  double canvas = 3;                ///< AccountingOptions::canvas
  bool all_hiders = false;          ///< AccountingOptions::all_hiders
  std::optional<std::string> page;  ///< HTML
  std::optional<std::string> coco;  ///< JSON
  bool coco_polygons = false;
  std::optional<std::string> masks;       ///< a folder
  std::optional<std::string> categories;  ///< a file that assigns categories to objects
  std::optional<std::string> bop;         ///< a folder
  std::optional<BopVisible> bop_visible;
  std::vector<std::string> leave_out;  ///< objects or categories that --coco, --masks and --bop omit
  std::optional<std::string> why;      ///< name or number of the objects to report; others are omitted
  std::optional<std::string> views;    ///< a batch file
};

/// Settings of frontmost visible.
struct VisibleSettings {
  std::optional<std::string> views;        ///< a batch file
  std::optional<int> sphere;               ///< number of views from all around
  std::vector<std::string> outputs, kept;  ///< lists and coloured models; models of visible faces
};

/// Settings of frontmost gl.
struct ProgramSettings {
  std::optional<std::string> output, script;
  std::optional<glm::ivec2> size, explained;
  std::optional<int> frames;
  bool verbose = false;
};

struct Settings {
  std::string model;                     ///< for `gl`, the program
  std::vector<std::string> more_models;  ///< `render` draws them with the first; `lines` gives each a sheet; for `gl`,
                                         ///< the program's arguments
  LoadOptions load;
  ViewSettings view;
  PrecisionSettings precision;
  SightSettings sight;
  LidarSettings lidar;
  CompareSettings compare;
  DrawingSettings drawing;
  ReportSettings report;
  VisibleSettings visible;
  ProgramSettings program;
  OutputSettings output;
  RunSettings run;
  std::optional<std::string> merge_folder;  ///< for `batch-merge`
  std::uint64_t said = 0;                   ///< hash of all given options that may change a result
};

}  // namespace frontmost::cli
