// SPDX-License-Identifier: Apache-2.0
// Compares the view with that of WebGL: the data that WebGL needs to draw, and the reasons for differing pixels.
//
//   corners of triangles, a matrix --> WebGL --> ids of triangles --> a reason for each that is not the library's
#include <cmath>
#include <cstring>
#include <optional>

#include "web/camera.h"
#include "web/workbench.h"

namespace frontmost::web {
namespace {

enum class WhyOther : std::uint8_t { edge, depth, other };
constexpr const char* kWhyNames[] = {"edge", "depth", "other"};

/// The value of a 24-bit depth buffer for a planar depth, before rounding.
double window_steps(const Projection& p, double depth) {
  constexpr double greatest = 16777215;
  const ClipDistances& clip = p.clip;
  if (p.orthographic) return (depth - clip.near) / (clip.far - clip.near) * greatest;
  return (1 - clip.near / depth) / (1 - clip.near / clip.far) * greatest;
}

/// A triangle's position relative to the centre of a pixel.
struct AtPixel {
  bool is_covered = false;
  double border = 0;  ///< pixels from the centre to the nearest line through two of its corners
  double depth = 0;   ///< planar depth of the triangle's plane at the centre
  double slope = 0;   ///< change in steps of a 24-bit depth buffer from one pixel to the next
};

/// Corners as (pixel x * w, pixel y * w, w). The screen line through two of them needs no division, and holds behind
/// the eye as well (Olano and Greer, Triangle Scan Conversion using 2D Homogeneous Coordinates, 1997).
class HomogeneousTriangle {
 public:
  HomogeneousTriangle(const View& view, const std::array<glm::vec3, 3>& corners) {
    const Projection& p = view.projection;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 away = glm::dvec3(corners[i]) - view.eye();
      eye_[i] = {glm::dot(away, view.right()), glm::dot(away, view.up()), glm::dot(away, view.forward())};
      const double w = p.orthographic ? 1 : eye_[i].z;
      screen_[i] = {(eye_[i].x - p.left * w) / (p.right - p.left) * view.width,
                    (p.top * w - eye_[i].y) / (p.top - p.bottom) * view.height, w};
    }
    normal_ = glm::cross(eye_[1] - eye_[0], eye_[2] - eye_[0]);
  }

  [[nodiscard]] AtPixel at(const View& view, int x, int y) const {
    const glm::dvec3 centre(x + 0.5, y + 0.5, 1);
    AtPixel result;
    result.border = std::numeric_limits<double>::infinity();
    int positive = 0, negative = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 line = glm::cross(screen_[i], screen_[(i + 1) % 3]);
      const double side = glm::dot(line, centre);
      (side > 0 ? positive : negative) += side != 0;
      result.border = std::min(result.border, std::abs(side) / std::max(std::hypot(line.x, line.y), 1e-300));
    }
    result.depth = depth_at(view, centre.x, centre.y);
    result.is_covered = (positive == 0 || negative == 0) && result.depth > 0;
    const double steps = window_steps(view.projection, result.depth);
    result.slope = std::abs(window_steps(view.projection, depth_at(view, centre.x + 1, centre.y)) - steps) +
                   std::abs(window_steps(view.projection, depth_at(view, centre.x, centre.y + 1)) - steps);
    return result;
  }

 private:
  /// The depth of the triangle's plane at a position in pixels.
  [[nodiscard]] double depth_at(const View& view, double x, double y) const {
    const Projection& p = view.projection;
    const double right = p.left + (p.right - p.left) * x / view.width;
    const double up = p.top - (p.top - p.bottom) * y / view.height;
    const glm::dvec3 along = p.orthographic ? glm::dvec3(0, 0, 1) : glm::dvec3(right, up, 1);
    const glm::dvec3 from = p.orthographic ? glm::dvec3(right, up, 0) : glm::dvec3(0);
    return glm::dot(normal_, eye_[0] - from) / glm::dot(normal_, along);
  }

  std::array<glm::dvec3, 3> eye_{}, screen_{};
  glm::dvec3 normal_{0};
};

struct PixelDifference {
  WhyOther why = WhyOther::other;
  double border = 0;  ///< pixels
  double steps = 0;   ///< steps of a 24-bit depth buffer
};

class PixelReasons {
 public:
  PixelReasons(const Surfaces& surfaces, const View& view, int subpixel_bits)
      : surfaces_(surfaces), view_(view), rounding_(1.0 / double(1 << std::clamp(subpixel_bits, 1, 16))) {}

  /// The reason why the library draws `ours` and WebGL draws `theirs` at a pixel; either may be none.
  [[nodiscard]] PixelDifference explain(PrimitiveId ours, PrimitiveId theirs, int x, int y) const {
    const std::optional<AtPixel> a = at(ours, x, y), b = at(theirs, x, y);
    PixelDifference result;
    result.border = std::min(a ? a->border : 1e9, b ? b->border : 1e9);
    // Each of three corners moves by half a unit on either axis, and arithmetic of 24 bits moves them about as far
    // again.
    if ((b && !b->is_covered) || result.border <= 2 * rounding_) {
      result.why = b && !b->is_covered && b->border > 2 * rounding_ ? WhyOther::other : WhyOther::edge;
      if (b && !b->is_covered) result.border = b->border;
      return result;
    }
    if (!a || !b) return result;
    result.steps = std::abs(window_steps(view_.projection, a->depth) - window_steps(view_.projection, b->depth));
    // The limit covers two roundings of depths, errors of float interpolation, and the slope times the shift of the
    // corners.
    const double most_steps = 8 + rounding_ * (a->slope + b->slope);
    if (result.steps <= most_steps) result.why = WhyOther::depth;
    return result;
  }

 private:
  [[nodiscard]] std::optional<AtPixel> at(PrimitiveId id, int x, int y) const {
    if (id == no_primitive) return std::nullopt;
    return HomogeneousTriangle(view_, surfaces_.corners(id)).at(view_, x, y);
  }

  const Surfaces& surfaces_;
  const View& view_;
  double rounding_;
};

std::uint32_t rgba_of(const Surfaces& surfaces, PrimitiveId id) {
  const PrimitiveSource source = surfaces.source(id);
  const Scene& scene = surfaces.scene();
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  const glm::vec4 color = material == no_index ? glm::vec4(0.8f) : scene.materials[material].base_color;
  std::uint32_t rgba = 0xFF000000u;
  for (int c = 0; c < 3; ++c)
    rgba |= std::uint32_t(255 * std::sqrt(std::clamp(color[c], 0.0f, 1.0f)) + 0.5f) << (8 * c);
  return rgba;
}

}  // namespace

PlainJson Workbench::triangles(const PlainJson&) {
  (void)seen();
  constexpr std::uint32_t most = 2'000'000;
  const Surfaces& surfaces = model().surfaces;
  const std::uint32_t count = surfaces.primitive_count();
  if (count > most) throw Error(ErrorCode::limit_exceeded, "more than 2 million triangles are not given to WebGL");
  corners_.clear();
  corners_.reserve(std::size_t(count) * 9);
  colors_.clear();
  colors_.reserve(std::size_t(count) * 3);
  for (PrimitiveId id = 0; id < count; ++id) {
    const std::uint32_t color = rgba_of(surfaces, id);
    for (const glm::vec3& corner : surfaces.corners(id)) {
      corners_.insert(corners_.end(), {corner.x, corner.y, corner.z});
      colors_.push_back(color);
    }
  }
  const glm::dmat4 matrix = clip_from_eye(view_.projection, opengl_depth) * glm::inverse(view_.world_from_eye);
  return {{"corners", place_of(corners_.data(), corners_.size())},
          {"colors", place_of(colors_.data(), colors_.size())},
          {"matrix", to_json(matrix)},
          {"width", view_.width},
          {"height", view_.height},
          {"view", view_number_}};
}

PlainJson Workbench::compare(std::span<const std::byte> bytes, const PlainJson& question) {
  const Visible& visible = seen();
  if (question.at("view") != view_number_)
    throw Error(ErrorCode::bad_argument, "compare", "another view was drawn meanwhile");
  const std::size_t pixels = visible.primitives.size();
  if (bytes.size() != 4 * pixels)
    throw Error(ErrorCode::bad_argument, "compare", "not four bytes for each pixel of the last view");
  const Surfaces& surfaces = model().surfaces;
  const PixelReasons reasons(surfaces, visible.view, question.value("subpixel_bits", 4));
  std::array<std::size_t, std::size(kWhyNames)> counts{};
  differences_.clear();
  for (std::size_t i = 0; i < pixels; ++i) {
    std::uint32_t number = 0;  // 0: no triangle
    std::memcpy(&number, bytes.data() + 4 * i, 4);
    const PrimitiveId theirs = number == 0 ? no_primitive : number - 1;
    if (theirs == visible.primitives[i]) continue;
    if (theirs != no_primitive && theirs >= surfaces.primitive_count())
      throw Error(ErrorCode::bad_argument, "compare", "there is no such triangle");
    const int x = int(i) % visible.view.width, y = int(i) / visible.view.width;
    const PixelDifference found = reasons.explain(visible.primitives[i], theirs, x, y);
    ++counts[std::size_t(found.why)];
    for (const double value : {double(x), double(y), double(found.why), found.border, found.steps,
                               visible.primitives[i] == no_primitive ? -1 : double(visible.primitives[i]),
                               theirs == no_primitive ? -1 : double(theirs)})
      differences_.push_back(float(value));
  }
  PlainJson answer = {{"differences", place_of(differences_.data(), differences_.size())}};
  for (std::size_t i = 0; i < counts.size(); ++i) answer["counts"][kWhyNames[i]] = counts[i];
  return answer;
}

}  // namespace frontmost::web
