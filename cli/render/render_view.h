// SPDX-License-Identifier: Apache-2.0
// Rendering one view, and what there is to say about it afterwards.
//
//   Job ──> plan_sights ──> Sights ──> finish_view ──> files, and a ViewResult
//           what to look     what is     shades, and
//           for, how finely  visible     makes the maps
//
// There are several ways to find what is visible: render_view() looks at the model's triangles through a pinhole,
// render_around() through cameras that are none, by rays; render_streamed_view() at a model that is read piece by
// piece; render_tessellated_view() at triangles that are made for the view. All end in finish_view(), or write their
// files as it does.
#pragma once

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

/// Milliseconds.
struct Timings {
  std::vector<double> visible;         ///< one for each of --repeat
  std::optional<double> visible_maps;  ///< of the maps' single sample, where the picture has more
  double shade = 0, save = 0;
};

struct SeenObject {
  std::uint32_t instance = no_index;
  std::string name;
  std::uint64_t pixels = 0;
};

/// What is seen at the pixel centres.
struct Seen {
  std::uint64_t hash = 0;
  std::uint64_t pixels = 0;
  std::vector<SeenObject> objects;  ///< in scene order, those with a pixel at least
};

struct Result {
  std::string what;  ///< as kind_name()
  std::string path;
  std::optional<std::uint64_t> hash;  ///< where --hash asks
};

struct ReferenceResult {
  std::string path, difference_path;  ///< the latter empty when they do not differ
  double largest_difference = 0, mean_difference = 0;
  std::uint64_t differing_pixels = 0;
  bool passed = false;
};

struct ViewResult {
  std::string name;
  View view;
  glm::dvec3 target{0.0};
  CameraModel camera_model = CameraModel::pinhole;
  double fisheye_angle = 0;  ///< degrees; of that model
  DepthSettings depth;
  std::optional<Seen> seen;  ///< where --json or --hash ask
  std::vector<Result> results;
  std::optional<ReferenceResult> reference;
  std::vector<std::string> warnings;
  Timings timings;
  std::optional<Image> picture;  ///< kept for the terminal
};

/// The z-buffer's planes, which views and repeats use one after the other.
struct SharedBuffers {
  ZBuffer picture, maps;
};

/// What all views share.
struct RenderContext {
  const Surfaces& surfaces;
  Shader& shader;  ///< of the surfaces
  Environments& environments;
  const RunSettings& run;
  Execution execution;
  bool keep_picture = false;
  const RayIndex* index = nullptr;  ///< where the method, the cameras or the shadows need one
  bool by_rays = false;             ///< the method is raycast
  /// Whose bounds the camera goes by, where it is not these surfaces'.
  const Surfaces* framed = nullptr;
  SharedBuffers* buffers = nullptr;  ///< null where a single picture is drawn

  [[nodiscard]] const Surfaces& framed_surfaces() const { return framed ? *framed : surfaces; }
};

/// The visibility that a view needs: of the picture, of the maps, or of both at once.
struct Sights {
  std::optional<SeenView> picture, maps;
  std::optional<VisiblePixels> pixels;  ///< in place of `picture`, where nothing but a picture in bytes is made of it
  bool shared = false;                  ///< the maps are those of the picture
  /// Of a stream: the numbers of the triangles, by id of the surfaces, and what throws shadows. Both borrowed.
  const std::vector<PrimitiveId>* stream_ids = nullptr;
  const Visible* seen_by_light = nullptr;
  const BlankReason* blank_reason = nullptr;  ///< counted while the stream was read; borrowed

  [[nodiscard]] const SeenView& for_maps() const { return shared ? *picture : *maps; }
  /// Precondition: there is a picture.
  [[nodiscard]] ShadeInput shade_input(const RayIndex* index) const {
    return pixels ? ShadeInput{.pixels = &*pixels, .seen_by_light = seen_by_light, .index = index}
                  : ShadeInput{.visible = &picture->visible, .seen_by_light = seen_by_light, .index = index};
  }
  /// Nothing is seen at any sample of the picture, or of the maps.
  [[nodiscard]] bool is_blank() const {
    if (pixels) return pixels->other_count == 0 && cli::is_blank(pixels->first);
    return cli::is_blank((picture ? *picture : *maps).visible);
  }
};

/// Which of them a job needs, and with how many samples.
struct SightPlan {
  std::optional<int> picture_samples;
  bool maps = false, shared = false;
};
/// Of `view` only the size counts.
[[nodiscard]] SightPlan plan_sights(const Job& job, const RunSettings& run, bool keep_picture, const View& view);

/// The views that are to be looked at: the picture's first, and the maps' where they are not the same.
[[nodiscard]] std::vector<View> views_of(const View& view, const SightPlan& plan);

/// What comes after looking: shades, and writes every file of the job. `result` holds the view.
void finish_view(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result);

/// Samples of a picture: without an answer of the user's 4, or as many as the largest pictures can have.
[[nodiscard]] int picture_samples(const Job& job, const View& view);
/// Whether a picture of the job has the light that moves with the camera.
[[nodiscard]] bool has_key_light(const Job& job);
/// What a picture of the job looks like.
[[nodiscard]] ShadeOptions shade_options(const Job& job, const RenderContext& context);
/// One channel, or a few that belong together.
[[nodiscard]] Image map_of(OutputKind kind, const Job& job, const RenderContext& context, const Sights& sights);

/// Fills in the pixels, of all and of each object, from a map of objects.
void count_objects(const Surfaces& surfaces, const Image& objects, Seen& seen);

/// Finds what is visible, shades, and writes every file of the job.
[[nodiscard]] ViewResult render_view(const Job& job, const RenderContext& context);

/// \throws UsageError for outputs that only a pinhole has.
void check_outputs_around(const Job& job);

/// As render_view(), for a job whose camera is no pinhole. Precondition: the context has an index.
[[nodiscard]] ViewResult render_around(const Job& job, const RenderContext& context);

/// How a stream is rendered: the part of a RenderContext that there is before anything has been read.
struct StreamContext {
  Environments& environments;
  const RunSettings& run;
  Execution execution;
  bool keep_picture = false;
  Ranks* ranks = nullptr;  ///< of the stream; all of them render together
};

/// As render_view(): a pass to find the camera, unless it was told; one to find what is visible; and one for shadows
/// and smooth normals, where the picture has them. Of several ranks the first one writes the files.
/// \throws Error unsupported where standard input would have to be read again
[[nodiscard]] ViewResult render_streamed_view(const Job& job, Stream& stream, const StreamContext& context);

}  // namespace frontmost::cli
