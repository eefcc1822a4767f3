// SPDX-License-Identifier: Apache-2.0
#include "harness/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "view/screen_transform.h"

namespace frontmost::bench {
namespace {

// Rounding error of a depth, relative to the terms of its sum: four roundings of 2^-24.
constexpr double kRounding = 0x1p-22;

/// Position that one of the two programs gives a vertex, in 1/256 pixel from the top left corner of the picture.
struct Place {
  std::int64_t x = 0, y = 0;
  bool is_cut = false;  ///< outside the region that the program draws without clipping

  bool operator==(const Place&) const = default;
};

Place our_place(const ScreenTransform& t, const glm::vec3& position) {
  const HomogeneousVertex v = transform(t, position);
  if (!is_plain(t, v)) return {0, 0, true};
  const ScreenVertex s = snap(t, v);
  return {s.x + t.centre_x, s.y + t.centre_y};
}

/// Computes vertex positions by the steps of Mesa 22.3: src/gallium/auxiliary/draw/draw_llvm.c, generate_clipmask() and
/// generate_viewport(), then src/gallium/drivers/llvmpipe/lp_setup_tri.c, calc_fixed_position(). Mesa's fmuladd is
/// fused if the processor has FMA.
class TheirPlaces {
 public:
  explicit TheirPlaces(const View& view)
      : half_width_(0.5f * float(view.width)), half_height_(0.5f * float(view.height)) {
#if defined(__x86_64__)
    fuses_ = __builtin_cpu_supports("fma") != 0;
#endif
  }

  [[nodiscard]] Place operator()(const glm::vec4& clip) const {
    const auto is_inside = [&](float v) { return v <= clip.w && -v <= clip.w; };
    if (!is_inside(clip.x) || !is_inside(clip.y) || !is_inside(clip.z)) return {0, 0, true};
    const glm::vec3 w = window(clip);
    return {fixed(w.x), fixed(w.y)};
  }

  /// Pixels from the top left corner, and depth.
  [[nodiscard]] glm::vec3 window(const glm::vec4& clip) const {
    const float inverse = 1.0f / clip.w;
    return {scaled(clip.x * inverse, half_width_), scaled(clip.y * inverse, half_height_),
            scaled(clip.z * inverse, 0.5f)};
  }

 private:
  [[nodiscard]] float scaled(float ndc, float half) const {
    return fuses_ ? std::fma(ndc, half, half) : ndc * half + half;
  }
  /// Rounds from the first pixel's centre, as llvmpipe does, and then adds the half pixel again.
  [[nodiscard]] static std::int64_t fixed(float window) {
    return std::int64_t(std::nearbyint((window - 0.5f) * float(kSubPixels))) + kSubPixels / 2;
  }

  float half_width_, half_height_;
  bool fuses_ = false;
};

using Corners = std::array<Place, 3>;

bool is_cut(const Corners& c) { return c[0].is_cut || c[1].is_cut || c[2].is_cut; }

/// Twice the area of (a, b, p), positive where a, b, p turn clockwise on the screen (y down).
std::int64_t edge(const Place& a, const Place& b, const Place& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// The exact rule: a point is covered if it is inside, or on a left or a top edge.
bool covers(Corners c, const Place& p) {
  const std::int64_t area = edge(c[0], c[1], c[2]);
  if (area == 0) return false;
  if (area < 0) std::swap(c[1], c[2]);
  for (int k = 0; k < 3; ++k) {
    const Place &a = c[std::size_t(k)], &b = c[std::size_t((k + 1) % 3)];
    const std::int64_t e = edge(a, b, p);
    const bool is_left_or_top = b.y < a.y || (b.y == a.y && b.x > a.x);
    if (e < 0 || (e == 0 && !is_left_or_top)) return false;
  }
  return true;
}

/// Depth at a pixel with its rounding error in floats. The plane is evaluated from the corner of the picture, so steep
/// planes lose digits.
struct Depth {
  double value, error;
};

/// Vertices in pixels on the screen, each with its depth.
using DepthCorners = std::array<glm::dvec3, 3>;

Depth depth_at(const DepthCorners& c, const Place& pixel) {
  const glm::dvec3 u = c[1] - c[0], v = c[2] - c[0];
  const double area = u.x * v.y - u.y * v.x;
  const double slope_x = (u.z * v.y - u.y * v.z) / area, slope_y = (u.x * v.z - u.z * v.x) / area;
  const double x = double(pixel.x) / kSubPixels, y = double(pixel.y) / kSubPixels;
  return {c[0].z + slope_x * (x - c[0].x) + slope_y * (y - c[0].y),
          kRounding * (1 + std::abs(slope_x * x) + std::abs(slope_y * y))};
}

/// True unless `nearer` is plainly behind `other`.
bool can_hide(const Depth& nearer, const Depth& other) {
  return !(nearer.value - other.value > nearer.error + other.error);
}

class Judge {
 public:
  Judge(const Scene& scene, const Visible& visible, const std::vector<glm::vec4>& clip)
      : mesh_(scene.meshes.at(0)), clip_(clip), transform_(visible.view), theirs_(visible.view) {}

  [[nodiscard]] std::size_t moved_vertices() const {
    std::size_t moved = 0;
    for (std::size_t i = 0; i < clip_.size(); ++i) {
      const Place ours = our_place(transform_, mesh_.positions[i]), theirs = theirs_(clip_[i]);
      moved += !ours.is_cut && !theirs.is_cut && ours != theirs;
    }
    return moved;
  }

  /// Counts one pixel, where we see `a` and they see `b`, under the reason for the difference.
  void judge(const Place& pixel, PrimitiveId a, PrimitiveId b, CoverageReport& report) const {
    const Seen by_us = look(a, pixel), by_them = look(b, pixel);
    if (by_us.is_cut || by_them.is_cut) {
      ++report.clipped;
      return;
    }
    const bool is_drawn_rightly = (a == no_primitive || by_us.in_ours) && (b == no_primitive || by_them.in_theirs);
    if (is_drawn_rightly && ((a != no_primitive && !by_us.in_theirs) || (b != no_primitive && !by_them.in_ours))) {
      ++report.moved;
    } else if (is_drawn_rightly && a != no_primitive && b != no_primitive &&
               can_hide(our_depth(a, pixel), our_depth(b, pixel)) &&
               can_hide(their_depth(b, pixel), their_depth(a, pixel))) {
      ++report.depth;
    } else {
      ++report.disagreed;  // one program drew a triangle that the rule excludes, or left out one that it requires
    }
  }

 private:
  struct Seen {
    bool in_ours = false, in_theirs = false;  ///< whether each program's triangle covers the pixel, by the exact rule
    bool is_cut = false;
  };

  [[nodiscard]] Corners our_corners(PrimitiveId id) const {
    Corners corners;
    for (int k = 0; k < 3; ++k)
      corners[std::size_t(k)] = our_place(transform_, mesh_.positions[mesh_.triangles[id][k]]);
    return corners;
  }
  [[nodiscard]] Corners their_corners(PrimitiveId id) const {
    Corners corners;
    for (int k = 0; k < 3; ++k) corners[std::size_t(k)] = theirs_(clip_[mesh_.triangles[id][k]]);
    return corners;
  }
  [[nodiscard]] Seen look(PrimitiveId id, const Place& pixel) const {
    if (id == no_primitive) return {};
    const Corners ours = our_corners(id), theirs = their_corners(id);
    if (is_cut(ours) || is_cut(theirs)) return {false, false, true};
    return {covers(ours, pixel), covers(theirs, pixel), false};
  }
  /// The plane goes through the snapped vertices.
  [[nodiscard]] Depth our_depth(PrimitiveId id, const Place& pixel) const {
    DepthCorners corners;
    for (int k = 0; k < 3; ++k) {
      const ScreenVertex v = snap(transform_, transform(transform_, mesh_.positions[mesh_.triangles[id][k]]));
      const double x = v.x + transform_.centre_x, y = v.y + transform_.centre_y;
      corners[std::size_t(k)] = {x / kSubPixels, y / kSubPixels, 1 - double(v.key)};
    }
    return depth_at(corners, pixel);
  }
  /// llvmpipe's plane goes through the vertices before snapping.
  [[nodiscard]] Depth their_depth(PrimitiveId id, const Place& pixel) const {
    DepthCorners corners;
    for (int k = 0; k < 3; ++k) corners[std::size_t(k)] = theirs_.window(clip_[mesh_.triangles[id][k]]);
    return depth_at(corners, pixel);
  }

  const Mesh& mesh_;
  const std::vector<glm::vec4>& clip_;
  ScreenTransform transform_;
  TheirPlaces theirs_;
};

}  // namespace

CoverageReport compare_coverage(const Scene& scene, const Visible& visible, RasterPeer& peer) {
  const std::vector<glm::vec4> clip = peer.clip_positions();
  const Judge judge(scene, visible, clip);
  CoverageReport report;
  report.vertices = clip.size();
  report.moved_vertices = judge.moved_vertices();
  peer.draw();
  const PeerImage theirs = peer.read();
  for (int y = 0; y < visible.view.height; ++y)
    for (int x = 0; x < visible.view.width; ++x) {
      const PrimitiveId a = visible.primitives[visible.index(x, y)], b = theirs.primitives[visible.index(x, y)];
      report.covered += a != no_primitive && b != no_primitive;
      if (a == b) continue;
      ++(b == no_primitive ? report.only_ours : a == no_primitive ? report.only_theirs : report.other_ids);
      judge.judge({x * kSubPixels + kSubPixels / 2, y * kSubPixels + kSubPixels / 2}, a, b, report);
    }
  return report;
}

}  // namespace frontmost::bench
