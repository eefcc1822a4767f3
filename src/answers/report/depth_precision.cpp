// SPDX-License-Identifier: Apache-2.0
// With depth z = (1/n - 1/d) / (1/n - 1/f), or 1 - z when reversed, a step s of z is a step s * (1/n - 1/f) of 1/d.
//
// N. Reed. Depth Precision Visualized. 2015. E. Lengyel. Foundations of Game Engine Development 2. 2019, 7.2.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "frontmost/precision.h"

namespace frontmost {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check(const DepthSetup& setup, double distance) {
  Projection p;
  p.orthographic = setup.orthographic;
  p.clip = setup.clip;
  if (setup.orthographic)
    (void)make_orthographic(-1, 1, -1, 1, p.clip);
  else
    (void)make_frustum(-1, 1, -1, 1, p.clip);
  if (!(distance >= setup.clip.near && distance <= setup.clip.far) || !std::isfinite(distance))
    throw Error(ErrorCode::bad_argument, "distance", "must lie between near and far");
}

/// The divisor of z: 1 for an infinite far plane.
double span(const ClipDistances& clip) { return 1 - clip.near / clip.far; }

double depth_of(const DepthSetup& setup, double distance) {
  const auto& [near, far] = setup.clip;
  if (setup.orthographic) return (setup.reversed ? far - distance : distance - near) / (far - near);
  const double z = setup.reversed ? near / distance - near / far : 1 - near / distance;
  return std::max(z / span(setup.clip), 0.0);
}

/// Spacing of floats above `depth`.
double float_spacing(double depth) {
  constexpr int kLeast = -149;
  return std::ldexp(1.0, depth > 0 ? std::max(std::ilogb(depth) - 23, kLeast) : kLeast);
}

/// Spacing of floats below `depth`: half as much if `depth` is a power of two.
double spacing_below(double depth) { return float_spacing(depth * (1 - 1e-12)); }

/// The difference from which two keys (see Visible in view.h) round to different floats. Depths are made from keys, so
/// the finer values of a float buffer next to zero gain nothing.
double key_step(double key) { return spacing_below(key); }

/// A difference of z with which two depths never share a value; the first depth is `depth`, the second is farther away.
double full_step(const DepthSetup& setup, double depth) {
  if (setup.format != DepthFormat::f32) return 1 / double((std::uint32_t(1) << integer_bits(setup.format)) - 1);
  if (setup.reversed) return spacing_below(depth);
  // Rounding separates depths one spacing apart; the wider spacing, farther away, counts. No depth exceeds 1.
  return spacing_below(std::min(depth + float_spacing(depth), 1.0));
}

/// The gap for a step of 1/d at a distance.
double gap_of(double distance, double step) {
  const double left = 1 - distance * step;
  return left > 0 ? distance * distance * step / left : kInfinity;
}

/// The default reach of vertices: twice the distance of the surface, enough for pictures of up to 120 degrees; in
/// parallel projection, twice the distance of the planes.
double reach_of(const DepthSetup& setup, double distance) {
  constexpr double kTimes = 2;
  return kTimes * (setup.orthographic ? std::max(std::abs(setup.clip.near), std::abs(setup.clip.far)) : distance);
}

/// The error of a distance before it is stored. These numbers are rounded once each: a vertex's differences to the eye,
/// its row of the transform, their products, the three sums, and its world position. At the rim of the guard band the
/// triangle is cut, which rounds twice. Making the key takes a reciprocal and a product; in parallel projection, the
/// difference to the far plane and a product.
double rounding(const DepthSetup& setup, double distance, double reach) {
  constexpr double kUnit = 0x1p-24;
  return kUnit * (9 * reach + 2 * (setup.orthographic ? setup.clip.far - distance : distance));
}

double bits_of(double depth) {
  const auto rounded = float(depth);
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  return bits;
}

/// Bisects for the near plane, for floats that are not reversed. Bisection works because the gap only shrinks as the
/// near plane moves away from the eye.
std::optional<double> bisected_near(DepthSetup setup, double distance, double gap) {
  double low = std::log(distance) - 70, high = std::log(distance);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    setup.clip.near = std::min(std::exp(middle), distance);
    (resolvable_gap(setup, distance) <= gap ? high : low) = middle;
  }
  setup.clip.near = std::min(std::exp(high), distance);
  return resolvable_gap(setup, distance) <= gap ? std::optional(setup.clip.near) : std::nullopt;
}

}  // namespace

double resolvable_gap(const DepthSetup& setup, double distance) {
  check(setup, distance);
  const auto& [near, far] = setup.clip;
  const bool is_float = setup.format == DepthFormat::f32;
  const double step = full_step(setup, depth_of(setup, distance));
  if (setup.orthographic)
    return std::max(step, is_float ? key_step((far - distance) / (far - near)) : 0.0) * (far - near);
  return gap_of(distance, std::max(step * span(setup.clip), is_float ? key_step(near / distance) : 0.0) / near);
}

double rounding_gap(const DepthSetup& setup, double distance, std::optional<double> reach) {
  check(setup, distance);
  return 2 * rounding(setup, distance, reach.value_or(reach_of(setup, distance)));
}

double certain_gap(const DepthSetup& setup, double distance, std::optional<double> reach) {
  check(setup, distance);
  // In the worst case the nearer surface is moved away by its rounding, and the farther one towards the eye by its own.
  const auto of = [&](double at) { return rounding(setup, at, reach.value_or(reach_of(setup, at))); };
  const double stored = resolvable_gap(setup, std::min(distance + of(distance), setup.clip.far));
  const double gap = stored + 2 * of(distance);
  if (setup.orthographic || !std::isfinite(gap)) return gap;
  // The rounding of the farther surface grows with its distance.
  return gap / (1 - (of(distance + 1) - of(distance)));
}

double share_of_values(const DepthSetup& setup, double distance) {
  check(setup, distance);
  const double depth = depth_of(setup, distance);
  if (setup.format != DepthFormat::f32) return setup.reversed ? 1 - depth : depth;
  const double share = bits_of(depth) / bits_of(1);
  return setup.reversed ? 1 - share : share;
}

std::optional<double> near_for_gap(const DepthSetup& setup, double distance, double gap) {
  check(setup, distance);
  if (!(gap > 0)) throw Error(ErrorCode::bad_argument, "gap", "must be greater than 0");
  const double far = setup.clip.far;
  const bool is_float = setup.format == DepthFormat::f32;
  if (setup.orthographic) {
    if (is_float) return std::nullopt;
    const double near = far - gap / full_step(setup, 0);
    return near <= distance ? std::optional(near) : std::nullopt;
  }
  // The largest permitted step of 1/d. An infinite gap permits a step to infinity.
  const double step = std::isfinite(gap) ? gap / (distance * (distance + gap)) : 1 / distance;
  if (is_float && setup.reversed) {
    const bool always = std::ldexp(1 / distance - 1 / far, -23) <= step;
    return always ? std::optional(0.0) : std::nullopt;
  }
  if (is_float) return bisected_near(setup, distance, gap);
  const double near = 1 / (step / full_step(setup, 0) + 1 / far);
  return near <= distance ? std::optional(near) : std::nullopt;
}

std::vector<double> round_distances(const ClipDistances& clip) {
  const double far = std::isfinite(clip.far) ? clip.far : clip.near * 1e6;
  std::vector<double> distances{clip.near};
  // Orthographic near planes may lie at the eye or behind it.
  const double first = clip.near > 0 ? clip.near : (far - clip.near) * 1e-6;
  for (int exponent = int(std::floor(std::log10(first))); exponent <= 308 && distances.size() < 200; ++exponent) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      // Rounded only once, so that 0.2 is the usual double 0.2.
      const double distance = exponent < 0 ? digit / std::pow(10.0, -exponent) : digit * std::pow(10.0, exponent);
      if (distance > first * 1.0001 && distance < far * 0.9999) distances.push_back(distance);
    }
  }
  distances.push_back(far);
  return distances;
}

}  // namespace frontmost
