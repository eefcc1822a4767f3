// SPDX-License-Identifier: Apache-2.0
// Renders one view and collects its report.
//
//   Job ──> plan_sights ──> Sights ──> finish_view ──> files, and a ViewResult
//           samples of       visibility   shades, and
//           each output                   makes the maps
//
// Visibility is found in several ways: render_view() by pinhole and triangles of the model, render_around() by rays of
// other cameras, render_streamed_view() for a model that is read piece by piece, and render_tessellated_view() by
// triangles made for the view. All end in finish_view(), or write their files alike.
#pragma once

#include <frontmost/lines.h>
#include <frontmost/pictures.h>
#include <frontmost/raycast.h>
#include <frontmost/scene.h>
#include <frontmost/streams.h>
#include <frontmost/view.h>
#include <frontmost/zbuffer.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/render/blank.h"
#include "cli/render/environments.h"
#include "cli/render/jobs.h"
#include "cli/view/sight.h"

namespace frontmost::cli {

/// Times in milliseconds.
struct Timings {
  std::vector<double> visible;         ///< one for each repetition (--repeat)
  std::optional<double> visible_maps;  ///< for the maps, if the picture has several samples
  std::optional<double> edges;         ///< to find the edges, with --edges
  double shade = 0, save = 0;
};

struct SeenObject {
  std::uint32_t instance = no_index;
  std::string name;
  std::uint64_t pixels = 0;
};

/// Contents of the view at pixel centres.
struct Seen {
  std::uint64_t hash = 0;
  std::uint64_t pixels = 0;
  std::vector<SeenObject> objects;  ///< objects with at least one pixel, in scene order
};

struct Result {
  std::string what;  ///< kind_name()
  std::string path;
  std::optional<std::uint64_t> hash;  ///< with --hash
};

struct ReferenceResult {
  std::string path, difference_path;  ///< difference_path is empty if the pictures do not differ
  double largest_difference = 0, mean_difference = 0;
  std::uint64_t differing_pixels = 0;
  bool passed = false;
};

struct ViewResult {
  std::string name;
  View view;
  glm::dvec3 target{0.0};
  CameraModel camera_model = CameraModel::pinhole;
  double fisheye_angle = 0;  ///< degrees, for the fisheye
  DepthSettings depth;
  std::optional<Seen> seen;  ///< with --json or --hash
  std::vector<Result> results;
  std::optional<ReferenceResult> reference;
  std::vector<std::string> warnings;
  Timings timings;
  std::optional<Image> picture;  ///< for the terminal
};

/// The z-buffer's planes, which views and repetitions reuse.
struct SharedBuffers {
  ZBuffer picture, maps;
};

/// Context that all views share.
struct RenderContext {
  const Surfaces& surfaces;
  Shader& shader;  ///< shader of the surfaces
  Environments& environments;
  const RunSettings& run;
  Execution execution;
  bool keep_picture = false;
  const RayIndex* index = nullptr;  ///< null unless the method, cameras or shadows need one
  bool by_rays = false;             ///< whether the method is raycast
  /// Surfaces whose bounds determine the camera, if not `surfaces`.
  const Surfaces* framed = nullptr;
  SharedBuffers* buffers = nullptr;   ///< null if a single picture is drawn
  LineDrawer* line_drawer = nullptr;  ///< draws lines of `surfaces`; null for streams, which have no edges

  [[nodiscard]] const Surfaces& framed_surfaces() const { return framed ? *framed : surfaces; }
};

/// Visibility for a view: of the picture, of the maps, or of both at once.
struct Sights {
  std::optional<SeenView> picture, maps;
  std::optional<VisiblePixels> pixels;  ///< replaces `picture` if only a picture in bytes is needed
  bool shared = false;                  ///< whether the maps use the visibility of the picture
  /// For streams: the number of each triangle in the stream, by id of the surfaces; and what the key light sees. Both
  /// are borrowed.
  const std::vector<PrimitiveId>* stream_ids = nullptr;
  const Visible* seen_by_light = nullptr;
  const BlankReason* blank_reason = nullptr;  ///< counted during the stream's passes; borrowed
  std::optional<Strokes> edges;               ///< with --edges: the visible edges

  /// Whether edges are drawn over the picture.
  [[nodiscard]] bool has_edges() const { return edges && !edges->strokes.empty(); }
  [[nodiscard]] const SeenView& for_maps() const { return shared ? *picture : *maps; }
  /// Returns the input of the shader. Precondition: there is a picture.
  [[nodiscard]] ShadeInput shade_input(const RayIndex* index) const {
    return pixels ? ShadeInput{.pixels = &*pixels, .seen_by_light = seen_by_light, .index = index}
                  : ShadeInput{.visible = &picture->visible, .seen_by_light = seen_by_light, .index = index};
  }
  /// Whether no sample of the picture, or of the maps, sees anything.
  [[nodiscard]] bool is_blank() const {
    if (pixels) return pixels->other_count == 0 && cli::is_blank(pixels->first);
    return cli::is_blank((picture ? *picture : *maps).visible);
  }
};

/// The parts of Sights that a job needs, and their samples.
struct SightPlan {
  std::optional<int> picture_samples;
  bool maps = false, shared = false;
};
/// Plans the visibility for a job. Only the size of `view` is used.
[[nodiscard]] SightPlan plan_sights(const Job& job, const RunSettings& run, bool keep_picture, const View& view);

/// Returns the views to determine visibility for: the picture's, then the maps', unless they are the same.
[[nodiscard]] std::vector<View> views_of(const View& view, const SightPlan& plan);

/// Shades, and writes all files of the job. Precondition: `result` holds the view.
void finish_view(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result);

/// Returns the number of samples of a picture: the user's choice, or 4, or fewer if the picture is too large.
[[nodiscard]] int picture_samples(const Job& job, const View& view);
/// Whether the job's picture has the light that moves with the camera.
[[nodiscard]] bool has_key_light(const Job& job);
/// Returns the shading options of the job's picture.
[[nodiscard]] ShadeOptions shade_options(const Job& job, const RenderContext& context);
/// Returns the map of a kind: one channel, or a few that belong together.
[[nodiscard]] Image map_of(OutputKind kind, const Job& job, const RenderContext& context, const Sights& sights);

/// Counts pixels, in total and by object, in a map of objects.
void count_objects(const Surfaces& surfaces, const Image& objects, Seen& seen);

/// Determines visibility, shades, and writes all files of the job.
[[nodiscard]] ViewResult render_view(const Job& job, const RenderContext& context);

/// Checks the outputs of a camera that is no pinhole. \throws UsageError for outputs that only a pinhole supports.
void check_outputs_around(const Job& job);

/// Does what render_view() does, for a job whose camera is no pinhole. Precondition: the context has an index.
[[nodiscard]] ViewResult render_around(const Job& job, const RenderContext& context);

/// Context of a streamed view, available before anything has been read.
struct StreamContext {
  Environments& environments;
  const RunSettings& run;
  Execution execution;
  bool keep_picture = false;
  Ranks* ranks = nullptr;  ///< ranks of the stream, which render together
};

/// Does what render_view() does, for a stream. Passes: one to find the camera, unless it is given; one for visibility;
/// and one for shadows and smooth normals, if the picture has them. With several ranks, the first one writes the files.
/// \throws Error unsupported if standard input would have to be read again.
[[nodiscard]] ViewResult render_streamed_view(const Job& job, Stream& stream, const StreamContext& context);

}  // namespace frontmost::cli
