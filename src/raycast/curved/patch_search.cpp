// SPDX-License-Identifier: Apache-2.0
// The nearest point in which a ray meets a patch.
//
// In a frame whose third axis is the ray, the ray meets the patch where the first two coordinates are zero: two
// bicubics in two unknowns. A net whose hull does not hold zero has no root. Preconditioned by the inverse of the mean
// Jacobian the two become nearly u - u0 and v - v0; where a bound on the derivatives says that what is left contracts,
// there is one root at most, and stepping towards it either comes to it or shows that there is none. All other nets are
// halved, the nearer half first, down to a size that is the bound of what is promised: outlines, where the root is
// double, end there.
#include <algorithm>
#include <cmath>

#include "raycast/curved/placed_curves.h"
#include "scene/bezier_patch.h"

namespace frontmost::raycast_detail {
namespace {

/// A search that comes to this many answers with the nearest point found so far. Of 2.8 million searches on the teapot
/// and on random nets none took more than 85.
constexpr int kMostNets = 1 << 10;
constexpr int kMostCulled = 8;  ///< the same of points without a root of their own that are not looked at

PatchParameter parameter(double value) { return {value, 1 - value}; }

std::array<double, 4> bernstein(double t) {
  const double a = 1 - t;
  return {a * a * a, 3 * a * a * t, 3 * a * t * t, t * t * t};
}

glm::dvec3 value_of(const ControlNet& net, const glm::dvec2& at) {
  const std::array<double, 4> u = bernstein(at.x), v = bernstein(at.y);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3* row = &net[4 * i];
    sum += (row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + row[3] * v[3]) * u[i];
  }
  return sum;
}

/// A net in the ray's frame, and its place in the piece.
struct NetPart {
  ControlNet net;
  glm::dvec2 low{0}, size{1};
};

/// The system multiplied by the inverse of its mean Jacobian.
struct Preconditioned {
  glm::dmat2 inverse;
  std::array<glm::dvec2, 16> net;
  double reach = 0;  ///< what a displacement by 1 moves the solution at most
};

bool precondition(const ControlNet& net, Preconditioned& out) {
  glm::dvec2 u(0), v(0);
  for (std::size_t k = 0; k < 4; ++k) {
    u += glm::dvec2(net[12 + k] - net[k]) * 0.25;
    v += glm::dvec2(net[4 * k + 3] - net[4 * k]) * 0.25;
  }
  const double determinant = u.x * v.y - u.y * v.x;
  const double product = glm::length(u) * glm::length(v);
  if (!(std::abs(determinant) > product * kSingular)) return false;
  out.inverse = glm::dmat2(v.y, -u.y, -v.x, u.x) / determinant;  // columns
  for (std::size_t i = 0; i < 16; ++i) out.net[i] = out.inverse * glm::dvec2(net[i]);
  const glm::dmat2& m = out.inverse;
  out.reach = std::max(std::abs(m[0].x) + std::abs(m[1].x), std::abs(m[0].y) + std::abs(m[1].y));
  return true;
}

/// A bound on how far the Jacobian departs from the identity, in the maximum norm, anywhere on the net.
double departure(const std::array<glm::dvec2, 16>& net) {
  glm::dvec2 most_u(0), most_v(0);
  for (std::size_t line = 0; line < 4; ++line)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t u = 4 * k + line, v = 4 * line + k;
      most_u = glm::max(most_u, glm::abs((net[u + 4] - net[u]) * 3.0 - glm::dvec2(1, 0)));
      most_v = glm::max(most_v, glm::abs((net[v + 1] - net[v]) * 3.0 - glm::dvec2(0, 1)));
    }
  return std::max(most_u.x + most_v.x, most_u.y + most_v.y);
}

class PatchSearch {
 public:
  PatchSearch(const PatchPiece& piece, const DoubleRay& ray)
      : piece_(piece), ray_(ray), frame_(ray), nearest_(frame_.farthest) {}

  std::optional<RayMeeting> run() {
    NetPart whole;
    whole.net = in_frame();
    double reach = 0;
    for (const glm::dvec3& p : whole.net)
      for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(p[k]));
    finest_ = std::max(piece_.scale * kFinestPart + reach * kFinestPartOfReach, kFinest);
    pad_ = finest_ * kPad;
    search(whole);
    return found_;
  }

 private:
  [[nodiscard]] ControlNet in_frame() const {
    ControlNet net;
    for (std::size_t i = 0; i < net.size(); ++i) {
      const glm::dvec3 p = piece_.patch.points[i] - ray_.origin;
      net[i] = {glm::dot(frame_.across_x, p), glm::dot(frame_.across_y, p), glm::dot(frame_.along, p)};
    }
    return net;
  }

  [[nodiscard]] bool is_clear(const DoubleBox& hull) const {
    return hull.low.x > pad_ || hull.high.x < -pad_ || hull.low.y > pad_ || hull.high.y < -pad_ ||
           hull.low.z > nearest_ || hull.high.z < frame_.nearest;
  }

  void search(const NetPart& part) {
    const DoubleBox hull = bounds_of(part.net);
    if (is_clear(hull) || ++nets_ > kMostNets || culled_ > kMostCulled) return;
    if (hull.largest_side() <= finest_) {
      accept(part.low + part.size * 0.5, (hull.low.z + hull.high.z) * 0.5);
      culled_ += found_ ? 0 : 1;
      return;
    }
    if (!settle(part)) search_halves(part);
  }

  void search_halves(const NetPart& part) {
    const bool along_u = longest(part.net, true) >= longest(part.net, false);
    const int axis = along_u ? 0 : 1;
    const NetHalves halves = halve(part.net, along_u);
    NetPart a{halves.first, part.low, part.size};
    a.size[axis] *= 0.5;
    NetPart b{halves.second, a.low, a.size};
    b.low[axis] += b.size[axis];
    const bool a_first = bounds_of(a.net).low.z <= bounds_of(b.net).low.z;
    search(a_first ? a : b);
    search(a_first ? b : a);
  }

  /// The greatest step between neighbours: near a pole one parameter moves nothing, and halving it would not help.
  static double longest(const ControlNet& net, bool along_u) {
    const std::size_t step = along_u ? 4 : 1, across = along_u ? 1 : 4;
    double most = 0;
    for (std::size_t line = 0; line < 4; ++line)
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 d = glm::abs(net[line * across + (k + 1) * step] - net[line * across + k * step]);
        most = std::max({most, d.x, d.y, d.z});
      }
    return most;
  }

  /// True when there is nothing more to find on this part.
  bool settle(const NetPart& part) {
    Preconditioned system;
    if (!precondition(part.net, system)) return false;
    const double tolerance = pad_ * system.reach;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec2& p : system.net) low = glm::min(low, p), high = glm::max(high, p);
    if (low.x > tolerance || low.y > tolerance || high.x < -tolerance || high.y < -tolerance) return true;
    const double rate = departure(system.net);
    if (!(rate <= kContracting)) return false;
    step_to_root(part, system, rate, tolerance);
    return true;
  }

  /// From the middle towards the one root: each step leaves at most `rate` of the distance to it, and moving back onto
  /// the net, where the root must be, never adds to that. A residual that is too large for this shows that there is
  /// none.
  void step_to_root(const NetPart& part, const Preconditioned& system, double rate, double tolerance) {
    glm::dvec2 at(0.5);
    double distance = 0.5;
    for (int step = 0; step < kMostSteps; ++step) {
      const glm::dvec3 value = value_of(part.net, at);
      const glm::dvec2 off = system.inverse * glm::dvec2(value);
      const double size = std::max(std::abs(off.x), std::abs(off.y));
      if (size > (1 + rate) * distance + tolerance) return;
      const double beside = std::max(std::abs(value.x), std::abs(value.y));
      if (beside <= pad_ * kNearEnough || distance < kThere) {
        if (beside <= pad_) accept(part.low + part.size * at, value.z);
        return;
      }
      at = glm::clamp(at - off, glm::dvec2(0), glm::dvec2(1));
      distance *= rate;
    }
  }

  /// At the parameters in the piece and the distance along the ray.
  void accept(const glm::dvec2& at, double distance) {
    if (!(distance >= frame_.nearest && distance <= nearest_)) return;
    const std::optional<RayMeeting> met = meeting_at(piece_, ray_, at, distance);
    if (!met) return;
    nearest_ = distance - finest_;
    found_ = met;
  }

  const PatchPiece& piece_;
  const DoubleRay& ray_;
  RayFrame frame_;
  /// Along the ray, in world units. Once something is found, what is not nearer by the bound is not looked for: a
  /// surface that is pulled together to a curve is at the same place for whole curves of parameters.
  double nearest_;
  double finest_ = 0;  ///< parts of this size are as good as points
  double pad_ = 0;     ///< how far from the ray a hull counts as holding it: many roundings
  int nets_ = 0, culled_ = 0;
  std::optional<RayMeeting> found_;
};

/// A patch that has no sides anywhere faces the ray.
glm::dvec3 normal_at(const PatchPiece& piece, const glm::dvec2& at, const DoubleRay& ray) {
  const glm::dvec3 n = evaluate(piece.patch, parameter(at.x), parameter(at.y)).normal;
  return n == glm::dvec3(0) ? -glm::normalize(ray.direction) : n * piece.outward;
}

}  // namespace

std::optional<RayMeeting> meeting_at(const PatchPiece& piece, const DoubleRay& ray, const glm::dvec2& at,
                                     double distance) {
  const glm::dvec3 normal = normal_at(piece, at, ray);
  if (!ray.keeps(normal, piece.is_double_sided)) return std::nullopt;
  const double t = std::max(distance / glm::length(ray.direction), ray.from);
  return RayMeeting{t, piece.low + piece.size * at, normal};
}

std::optional<RayMeeting> meet(const PatchPiece& piece, const DoubleRay& ray) { return PatchSearch(piece, ray).run(); }

}  // namespace frontmost::raycast_detail
