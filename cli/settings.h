// SPDX-License-Identifier: Apache-2.0
// What the user asked for, as said: filled from flags or from a batch file, resolved later.
//
// Nothing here is checked against anything else, or against a model. A value that was not given is none, so that code
// which resolves it later can tell "not said" from the default, and a view of a batch can take what the command line
// said.
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

/// A depth buffer beside the exact default.
struct DepthSettings {
  bool is_used = false;
  DepthFormat format = DepthFormat::d24;
  std::optional<DepthFunc> func;
  bool mask = true, reversed = false;
  std::optional<double> clear;
  glm::dvec2 range{0, 1};
  PolygonOffset offset;
};

/// What the pixels' rays look like; all but pinholes are cast.
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
  std::optional<double> fisheye_angle;              ///< full, degrees
  std::optional<std::array<double, 4>> intrinsics;  ///< fx, fy, cx, cy
  PixelRule pixel_rule = PixelRule::centre_at_integer;
  std::optional<glm::dmat4> pose;
  std::optional<std::string> pose_file;  ///< where it comes from; `pose` is set by read_pose_file()
  std::optional<PoseConvention> pose_convention;
  std::optional<FramedObjects> framed;  ///< which are fitted into the picture; the subject, where it is not given
  std::optional<double> near, far;
  std::optional<glm::ivec2> resolution;
  Culling culling = Culling::none;
  std::optional<int> samples;                ///< 1 to 16, or 64 of the A-buffer
  std::optional<double> tessellation_error;  ///< pixels
  DepthSettings depth;
};

/// One file to write.
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
  /// All but the environment, which is made when the picture is drawn.
  LightOptions options;
};

/// What to write and how it looks.
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
  bool visible_only = true;             ///< of figures
  std::size_t most_polygons = 2000000;  ///< likewise
  double color_tolerance = 6;           ///< likewise, in steps of 8 bits
  bool merges_neighbours = false;       ///< likewise
  std::optional<int> layers;            ///< how many of the nearest go to files with {layer} in their names
};

/// How visibility is found.
enum class Method : std::uint8_t { zbuffer, raycast, abuffer };

/// Every `count`-th view, the first of them number - 1.
struct Shard {
  int number = 1, count = 1;

  [[nodiscard]] bool contains(std::size_t view) const { return view % std::size_t(count) == std::size_t(number - 1); }
};

/// How to run.
struct RunSettings {
  std::optional<Method> method;  ///< none: the z-buffer, and the A-buffer for pictures that need it
  int threads = 0;
  Isa isa = Isa::best;
  int repeat = 1;
  std::optional<double> timeout;
  bool json = false, quiet = false, stream = false;
  bool mpi = false;  ///< streams together with other ranks
  std::optional<std::string> batch;
  std::optional<Shard> shard;  ///< of the batch
};

/// What frontmost precision is to work out.
struct PrecisionSettings {
  std::optional<DepthFormat> format;  ///< none: those in use
  bool infinite = false;
  std::optional<glm::dvec2> wanted;  ///< a gap, and the distance at which it is to be resolved
  std::optional<std::string> plot, heat_map;
};

/// What frontmost compare does.
struct CompareSettings {
  std::optional<int> runs;  ///< none: default_runs, and one of a method that takes longer than longest_repeated
  static constexpr int default_runs = 5;
  static constexpr double longest_repeated = 2000;  ///< milliseconds

  [[nodiscard]] int most_runs() const { return runs.value_or(default_runs); }
  bool explain = false;
  std::optional<std::string> folder;  ///< of the page and its pictures
};

/// What frontmost sight looks along.
struct SightSettings {
  std::optional<glm::dvec3> from, to;
  std::optional<std::string> pairs;
};

/// What frontmost lidar scans with.
struct LidarSettings {
  std::optional<glm::dvec3> from, forward;
  std::optional<int> rings, steps;
  std::optional<glm::dvec2> elevations;       ///< lowest and highest, degrees
  std::vector<double> ring_elevations;        ///< degrees; empty: rings are spread
  std::optional<glm::dvec2> azimuths, range;  ///< degrees; least and greatest
  std::optional<std::string> directions;
  bool robot_axes = false;
  std::vector<std::string> outputs;
};

/// What frontmost lines draws, and on what.
struct DrawingSettings {
  /// What a title block says (ISO 7200); none: not given.
  struct TitleTexts {
    std::optional<std::string> title, number, author, date, owner;
  };

  SheetOptions sheet;  ///< all that the library is told as it was said
  std::optional<ProjectionMethod> projection;
  std::optional<double> hatch_angle;  ///< radians
  std::optional<glm::dvec3> light;    ///< towards it: to the right, upwards and to the viewer
  std::optional<bool> casts_shadows;
  bool frame = false;
  TitleTexts texts;
  int number = 1, count = 1;  ///< of the sheet, where several models are given
  std::optional<PageFormat> format;
  std::vector<std::string> outputs;
  std::vector<std::string> books;  ///< of `outputs`, the files that hold the sheets of several models as pages

  [[nodiscard]] bool is_sheet() const { return !sheet.views.empty() || !sheet.sections.empty(); }
  /// A title block needs a frame.
  [[nodiscard]] bool has_frame() const {
    return frame || texts.title || texts.number || texts.author || texts.date || texts.owner;
  }
};

/// What frontmost report counts, and where it goes.
struct ReportSettings {
  double canvas = 3;                ///< as AccountingOptions::canvas
  bool all_hiders = false;          ///< likewise
  std::optional<std::string> page;  ///< HTML
  std::optional<std::string> coco;  ///< JSON
  bool coco_polygons = false;
  std::optional<std::string> masks;       ///< a folder
  std::optional<std::string> categories;  ///< a file that says which object has which
  std::optional<std::string> bop;         ///< a folder
  std::optional<BopVisible> bop_visible;
  std::vector<std::string> leave_out;  ///< names of objects or categories that these three leave out
  std::optional<std::string> why;      ///< the name or number of the objects of which alone something is said
  std::optional<std::string> views;    ///< a batch file
};

/// What frontmost visible looks from, and where its lists go.
struct VisibleSettings {
  std::optional<std::string> views;        ///< a batch file
  std::optional<int> sphere;               ///< how many views from all around
  std::vector<std::string> outputs, kept;  ///< lists and coloured models; models of what is seen alone
};

struct Settings {
  std::string model;
  std::vector<std::string>
      more_models;  ///< of `render`: drawn together with the first; of `lines`: sheets of their own
  LoadOptions load;
  ViewSettings view;
  PrecisionSettings precision;
  SightSettings sight;
  LidarSettings lidar;
  CompareSettings compare;
  DrawingSettings drawing;
  ReportSettings report;
  VisibleSettings visible;
  OutputSettings output;
  RunSettings run;
  std::optional<std::string> merge_folder;  ///< of `batch-merge`
  std::uint64_t said = 0;                   ///< a hash of all options that may change a result, as they were given
};

}  // namespace frontmost::cli
