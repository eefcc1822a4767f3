// SPDX-License-Identifier: Apache-2.0
// The strip at risk: two cuts of the common area of both faces.
#include "report/fights/risk.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace frontmost {
namespace {

constexpr double kMostAsked = 4096, kLeastAsked = 64, kAskedOfAll = 1 << 28;

std::array<glm::dvec2, 3> corners_of(const ScreenFace& face) {
  return {face.corner(0), face.corner(1), face.corner(2)};
}

/// Not negative where `nearer` is not surely shown: constant + relative * nearer - (nearer - other).
AffineOverScreen is_not_shown(const KeyOverScreen& nearer, const KeyOverScreen& other, const KeyStep& step,
                              double slack) {
  const double share = step.relative - 1;
  return {step.constant + slack + share * nearer.k + other.k,
          {share * nearer.gx + other.gx, share * nearer.gy + other.gy}};
}

}  // namespace

RiskFinder::RiskFinder(const View& view, const DepthSetup& setup)
    : size_(view.width, view.height),
      step_(setup),
      farthest_key_(setup.orthographic ? 0 : setup.clip.near / setup.clip.far) {}

void RiskFinder::cut_by_frame() {
  for (int axis = 0; axis < 2; ++axis) {
    glm::dvec2 along(0);
    along[axis] = 1;
    area_.cut({0, along});
    area_.cut({size_[axis], -along});
  }
}

const ConvexArea& RiskFinder::of_pair(const ScreenFace& a, const ScreenFace& b) {
  const KeyOverScreen first = a.keys(), second = b.keys();
  const double slack = double(a.slack) + double(b.slack);
  area_.assign(corners_of(a));
  area_.cut(is_not_shown(first, second, step_, slack));
  if (!area_.is_empty()) area_.cut(is_not_shown(second, first, step_, slack));
  for (int k = 0; k < 3 && !area_.is_empty(); ++k) area_.cut(inside_of_side(b.corner(k), b.corner(k == 2 ? 0 : k + 1)));
  if (!area_.is_empty()) cut_by_frame();
  return area_;
}

const ConvexArea& RiskFinder::of_clear_value(const ScreenFace& face) {
  area_.assign({});
  if (!may_be_clear_value(face)) return area_;
  const KeyOverScreen keys = face.keys();
  area_.assign(corners_of(face));
  cut_by_frame();
  area_.cut({farthest_key_ + 0.5 * step_.constant + double(face.slack) - keys.k, {-keys.gx, -keys.gy}});
  return area_;
}

RiskKeys::RiskKeys(const ScreenFace& a, const ScreenFace& b, const KeyStep& step)
    : first(a.keys()),
      second(b.keys()),
      reach(double(a.slack) + double(b.slack) + step.at(std::max(a.record.nearest(), b.record.nearest()))) {}

VisibleShares::VisibleShares(const Visible& visible, std::size_t areas)
    : visible_(visible), asked_(std::clamp(kAskedOfAll / double(areas), kLeastAsked, kMostAsked)) {}

double VisibleShares::of(const ConvexArea& area, const RiskKeys& keys) {
  const View& view = visible_.view;
  const auto is_seen = [&](std::size_t sample, const glm::dvec2& point) {
    return keys.nearest_at(point) + keys.reach >= double(visible_.keys[sample]);
  };
  std::uint64_t all = 0, seen = 0;
  const auto look = [&](int step) {
    all = seen = 0;
    visit_samples(area.corners(), view, step, [&](std::size_t i, int x, int y, const glm::dvec2& offset) {
      ++all;
      seen += is_seen(i, glm::dvec2(x, y) + offset);
    });
    looks_ += all;
  };
  // Some samples suffice for the share. To tell whether anything is seen, all samples are needed.
  const int step = int(std::sqrt(area.area() * view.samples / asked_));
  if (step > 1) look(step);
  if (seen == 0) look(1);
  if (all > 0) return double(seen) / double(all);
  const glm::dvec2 centre = area.centre();
  const glm::ivec2 last(view.width - 1, view.height - 1);
  const glm::ivec2 pixel = glm::clamp(glm::ivec2(centre), glm::ivec2(0), last);
  const std::size_t number = std::size_t(pixel.y) * std::size_t(view.width) + std::size_t(pixel.x);
  for (std::size_t s = 0; s < std::size_t(view.samples); ++s) seen += is_seen(s * view.pixel_count() + number, centre);
  return double(seen) / double(view.samples);
}

}  // namespace frontmost
