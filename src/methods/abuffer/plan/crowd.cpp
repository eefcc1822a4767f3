// SPDX-License-Identifier: Apache-2.0
// Only copies of large triangles cost much time, so only triangles of at least 16 pixels are compared. Their places on
// the screen are hashed, whichever vertex comes first, and equal hashes are sorted by id. The places themselves are
// then compared.
//
//    same place     id 3 (opaque)   id 8   id 9         3 hides 8 and 9 everywhere: they are left out
//    same place     id 4 (clear)    id 5   id 6 ...     all count, or as many as there are layers
//
// The areas of the remaining triangles add up to the number of fragments. A frame with too many is refused before it is
// gathered.
#include "abuffer/plan/crowd.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "frontmost/abuffer.h"
#include "view/triangle_keys.h"

namespace frontmost::abuffer_detail {
namespace {

/// Pixels. Copies of smaller triangles are drawn in the time that it takes to find them.
constexpr double kLeastArea = 16;

using PixelPolygon = std::vector<glm::dvec2>;

/// The part of a convex polygon where sign * p[axis] <= bound.
PixelPolygon cut_off(const PixelPolygon& polygon, int axis, double sign, double bound) {
  PixelPolygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
    const double da = bound - sign * a[axis], db = bound - sign * b[axis];
    if (da >= 0) part.push_back(a);
    if ((da < 0) != (db < 0)) part.push_back(a + (b - a) * (da / (da - db)));
  }
  return part;
}

/// Area of the part within the picture, in pixels.
double area_in_picture(const ScreenTriangle& t, const View& view) {
  const double width = view.width * kSubPixels, height = view.height * kSubPixels;
  const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
  constexpr double unit = 2.0 * kSubPixels * kSubPixels;
  if (x_min >= 0 && y_min >= 0 && x_max <= width && y_max <= height) return double(doubled_area(t)) / unit;
  PixelPolygon p;
  for (int k = 0; k < 3; ++k) p.push_back({t.x[k], t.y[k]});
  p = cut_off(cut_off(cut_off(cut_off(p, 0, -1, 0), 0, 1, width), 1, -1, 0), 1, 1, height);
  double doubled = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2& a = p[i];
    const glm::dvec2& b = p[(i + 1) % p.size()];
    doubled += a.x * b.y - a.y * b.x;
  }
  return std::abs(doubled) / unit;
}

/// A triangle's place, whichever of its vertices comes first.
using CornerPlaces = std::array<std::uint32_t, 9>;

CornerPlaces place_of(const ScreenTriangle& t) {
  const auto corner = [&](int k) { return std::make_tuple(t.x[k], t.y[k], t.key[k]); };
  int first = 0;
  for (int k = 1; k < 3; ++k)
    if (corner(k) < corner(first)) first = k;
  CornerPlaces place;
  for (int i = 0; i < 3; ++i) {
    const int k = (first + i) % 3;
    place[std::size_t(3 * i)] = std::uint32_t(t.x[k]);
    place[std::size_t(3 * i + 1)] = std::uint32_t(t.y[k]);
    std::memcpy(&place[std::size_t(3 * i + 2)], &t.key[k], sizeof t.key[k]);
  }
  return place;
}

std::uint64_t hash_of(const CornerPlaces& place) {
  // The hash of Fowler, Noll and Vo, by words.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::uint32_t word : place) hash = (hash ^ word) * 0x100000001b3;
  return hash;
}

/// A triangle of the frame that may have copies.
struct Candidate {
  std::uint64_t hash;
  PrimitiveId id;
  TriangleNumber number;
};

class CopyFinder {
 public:
  CopyFinder(const FragmentPlan& plan, const CopyRule& rule) : plan_(plan), rule_(rule) {}

  /// Finds the copies that nobody sees. Afterwards area() is the area of all others.
  std::vector<TriangleNumber> find() {
    std::vector<Candidate> candidates;
    plan_.for_each([&](const ScreenTriangle& t, const TriangleNumber& number) {
      const double area = area_in_picture(t, plan_.view());
      area_ += area;
      if (area >= kLeastArea) candidates.push_back({hash_of(place_of(t)), t.id, number});
    });
    // Equal places are sorted by id: the lowest hide the others.
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.hash != b.hash ? a.hash < b.hash : a.id < b.id; });
    for (std::size_t begin = 0, end; begin < candidates.size(); begin = end) {
      for (end = begin + 1; end < candidates.size() && candidates[end].hash == candidates[begin].hash;) ++end;
      if (end - begin > 1) look_at(std::span(candidates).subspan(begin, end - begin));
    }
    return std::move(hidden_);
  }
  [[nodiscard]] double area() const { return area_; }

 private:
  /// Finds hidden copies in a group of the same hash, ids ascending.
  void look_at(std::span<const Candidate> group) {
    const CornerPlaces place = place_of(plan_.triangle(group.front().number));
    std::size_t kept = 0;
    bool is_hidden = false;
    for (const Candidate& c : group) {
      const ScreenTriangle t = plan_.triangle(c.number);
      if (place_of(t) != place) continue;  // the hash is the same by chance
      if (is_hidden || kept >= rule_.most) {
        hidden_.push_back(c.number);
        area_ -= area_in_picture(t, plan_.view());
        continue;
      }
      if (plan_.may_have_holes(c.id)) continue;  // other triangles are seen through the holes
      ++kept;
      is_hidden = rule_.is_opaque && rule_.is_opaque(c.id);
    }
  }

  const FragmentPlan& plan_;
  const CopyRule& rule_;
  std::vector<TriangleNumber> hidden_;
  double area_ = 0;
};

}  // namespace

const FragmentPlan& CrowdedFrame::thinned() {
  const std::lock_guard lock(mutex_);
  // Waiting threads get the first one's result or error.
  if (error_) std::rethrow_exception(error_);
  if (thinned_) return *thinned_;
  try {
    make();
  } catch (...) {
    error_ = std::current_exception();
    throw;
  }
  return *thinned_;
}

std::uint64_t most_gathered_fragments(const View& view, std::uint64_t triangles) {
  constexpr std::uint64_t most_of_few = std::uint64_t(1) << 28, most_per_triangle = 1 << 10, most_per_pixel = 64;
  return std::max(std::min(most_fragments, most_of_few + most_per_triangle * triangles),
                  most_per_pixel * view.pixel_count());
}

void CrowdedFrame::make() {
  CopyFinder finder(plan_, rule_);
  const std::vector<TriangleNumber> hidden = finder.find();
  const View& view = plan_.view();
  std::uint64_t triangles = 0;
  for (const Cluster& cluster : plan_.set().clusters) triangles += cluster.triangle_count;
  const std::uint64_t most = most_gathered_fragments(view, triangles);
  if (finder.area() > double(most))
    throw Error(ErrorCode::limit_exceeded, "abuffer",
                "about " + std::to_string(std::uint64_t(finder.area())) + " fragments, and the most of " +
                    std::to_string(triangles) + " triangles in a picture of " + std::to_string(view.width) + " x " +
                    std::to_string(view.height) + " pixels are " + std::to_string(most));
  thinned_ = hidden.empty() ? &plan_ : &made_.emplace(plan_.without(hidden));
}

}  // namespace frontmost::abuffer_detail
