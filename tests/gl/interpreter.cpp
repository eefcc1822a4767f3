// SPDX-License-Identifier: Apache-2.0
#include "gl/interpreter.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>

namespace frontmost::test::gl {
namespace {

// ---- Ranges. The library's floats have 24 bits.

constexpr double kMostDepth = 0xFFFFFF;
constexpr double kTiny = 1e-6;        // error of a dozen roundings of floats up to 1
constexpr double kRoom = 2048 * 256;  // the library cuts off what is farther from the frame, in 1/256 pixel
constexpr std::size_t kColors = 4;
using Colors = std::array<Range, kColors>;
enum class Answer { no, maybe, yes };
Range operator+(Range a, Range b) { return {a.low + b.low, a.high + b.high}; }
Range operator-(Range a, Range b) { return {a.low - b.high, a.high - b.low}; }
Range nothing() { return {1e300, -1e300}; }
Range hull(Range a, Range b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
Range least(Range a, Range b) { return {std::min(a.low, b.low), std::min(a.high, b.high)}; }
Range greatest(Range a, Range b) { return {std::max(a.low, b.low), std::max(a.high, b.high)}; }
Range operator*(Range a, double b) { return b < 0 ? Range(a.high * b, a.low * b) : Range(a.low * b, a.high * b); }
Range operator*(Range a, Range b) { return hull(a * b.low, a * b.high); }
Range wider(Range a, double by) { return {a.low - by, a.high + by}; }
Range limited(Range a, Range to) { return greatest(least(a, to.high), to.low); }
Range unit(Range a) { return limited(a, {0, 1}); }
Range mixed(Range a, Range b, Range by) { return a * (Range(1) - by) + b * by; }
/// Whole numbers up to `most` that a value may be rounded to.
Range stored(Range a, double error, double most) {
  return limited({std::nearbyint(a.low - error), std::nearbyint(a.high + error)}, {0, most});
}
Range byte(Range color) { return stored(color * 255, 1e-3, 255); }
Answer is_positive(double value, double error) { return Answer((value >= -error) + (value > error)); }
/// A function such as GL_LESS: the lowest bits of the name say whether less, equal and greater pass.
Answer compared(GLenum func, Range a, Range b) {
  const unsigned possible = (a.low < b.high) | (a.low <= b.high && b.low <= a.high) << 1 | (a.high > b.low) << 2;
  return Answer(((possible & func) != 0) + ((possible & ~func) == 0));
}

/// The number of a texel along one axis, or -1 for the border's color.
int wrapped(int i, int size, GLenum mode, bool is_linear) {
  const int in_two = (i % (2 * size) + 2 * size) % (2 * size);
  if (mode == GL_REPEAT) return in_two % size;
  if (mode == GL_MIRRORED_REPEAT) return std::min(in_two, 2 * size - 1 - in_two);
  if (mode == GL_CLAMP_TO_BORDER || (mode == GL_CLAMP && is_linear)) return i >= 0 && i < size ? i : -1;
  return std::clamp(i, 0, size - 1);
}

Colors sampled_level(const TextureUnit& s, std::size_t number, bool is_linear, Range u, Range v) {
  const Level& level = s.image->levels[number];
  const GLenum format = s.image->format;
  const auto texel = [&](int i, int j, std::size_t k) {
    const int x = wrapped(i, level.width, s.wrap_s, is_linear);
    const int y = s.image->is_1d ? 0 : wrapped(j, level.height, s.wrap_t, is_linear);
    if (format == GL_INTENSITY || (k < 3 && format != GL_RGB && format != GL_RGBA)) k = 0;
    return x < 0 || y < 0 ? double(s.border_color[k]) : level.texels[std::size_t(y * level.width + x)][k] / 255.0;
  };
  u = (s.wrap_s == GL_CLAMP ? unit(u) : u) * double(level.width) - (is_linear ? 0.5 : 0);
  v = (s.wrap_t == GL_CLAMP ? unit(v) : v) * double(level.height) - (is_linear ? 0.5 : 0);
  if (s.image->is_1d) v = 0;
  const double doubt = u.high - u.low + v.high - v.low;
  if (!(doubt < 4)) return {Range(0, 1), Range(0, 1), Range(0, 1), Range(0, 1)};
  // One or some texels, or the mean of four in the middle of the ranges, which fixed-point numbers make.
  const double x = is_linear ? (u.low + u.high) / 2 : u.low, y = is_linear ? (v.low + v.high) / 2 : v.low;
  const int i0 = int(std::floor(x)), j0 = int(std::floor(y));
  Colors c{nothing(), nothing(), nothing(), nothing()}, mean;
  for (int j = j0; j <= (is_linear ? j0 + 1 : v.high); ++j)
    for (int i = i0; i <= (is_linear ? i0 + 1 : u.high); ++i)
      for (std::size_t k = 0; k < kColors; ++k) {
        const double value = texel(i, j, k);
        c[k] = hull(c[k], value);
        mean[k] = mean[k] + value * std::abs(1 - std::abs(i - x)) * std::abs(1 - std::abs(j - y));
      }
  for (std::size_t k = 0; k < kColors && is_linear; ++k) c[k] = unit(wider(mean[k], doubt + 2.0 / 255));
  return c;
}

/// `change` is the square of the change from pixel to pixel, in texels of the first level.
Colors sampled(const TextureUnit& s, Range u, Range v, Range change) {
  Colors c{nothing(), nothing(), nothing(), nothing()};
  const auto add = [&](const Colors& by) {
    for (std::size_t k = 0; k < kColors; ++k) c[k] = hull(c[k], by[k]);
  };
  const GLenum min = s.min_filter;
  const bool has_levels = min != GL_NEAREST && min != GL_LINEAR, is_linear_mag = s.mag_filter == GL_LINEAR;
  const bool is_linear_min = min == GL_LINEAR || min == GL_LINEAR_MIPMAP_NEAREST || min == GL_LINEAR_MIPMAP_LINEAR;
  const bool is_nearest_level = min == GL_NEAREST_MIPMAP_NEAREST || min == GL_LINEAR_MIPMAP_NEAREST;
  const auto log = [](double square) { return std::log2(std::max(square, 1e-30)) / 2; };
  const Range lod = wider({log(change.low), log(change.high)}, 1e-4);
  const double limit = has_levels && is_linear_mag && !is_linear_min ? 0.5 : 0;
  if (lod.low <= limit) add(sampled_level(s, 0, is_linear_mag, u, v));
  if (lod.high <= limit) return c;
  const double last = has_levels ? double(s.image->levels.size() - 1) : 0;
  const Range level = limited(greatest(lod, lod.low <= limit ? Range(limit) : lod), {0, last});
  const auto at = [&](double number) { return sampled_level(s, std::size_t(number), is_linear_min, u, v); };
  if (is_nearest_level) {
    for (double n = std::max(std::ceil(level.low + 0.5) - 1, 0.0); n <= std::min(std::ceil(level.high + 0.5) - 1, last);
         ++n)
      add(at(n));
    return c;
  }
  for (double n = std::floor(level.low); n <= level.high; ++n) {
    const Colors low = at(n), high = at(std::min(n + 1, last));
    const Range by = unit(level - n);
    for (std::size_t k = 0; k < kColors; ++k) c[k] = hull(c[k], unit(wider(mixed(low[k], high[k], by), 1e-3)));
  }
  return c;
}

/// Combiners: OpenGL 1.5, table 3.24.
void apply_combiner(const TextureUnit& s, Colors& c, const Colors& primary, Colors t) {
  // Components that the texture lacks.
  if (s.image->format == GL_RGB || s.image->format == GL_LUMINANCE) t[3] = 1;
  if (s.image->format == GL_ALPHA) t[0] = t[1] = t[2] = 0;
  const Colors previous = c, constant{s.env_color[0], s.env_color[1], s.env_color[2], s.env_color[3]};
  const auto argument = [&](std::size_t part, std::size_t i, std::size_t k) {
    const GLenum source = s.combiner.sources[part][i], operand = s.combiner.operands[part][i];
    const Colors& from = source == GL_TEXTURE         ? t
                         : source == GL_CONSTANT      ? constant
                         : source == GL_PRIMARY_COLOR ? primary
                                                      : previous;
    const Range value = from[operand == GL_SRC_COLOR || operand == GL_ONE_MINUS_SRC_COLOR ? k : 3];
    return operand == GL_SRC_COLOR || operand == GL_SRC_ALPHA ? value : Range(1) - value;
  };
  const GLenum rgb = s.combiner.mode[0];
  for (std::size_t k = 0; k < kColors; ++k) {
    const bool is_dot = rgb == GL_DOT3_RGBA || (rgb == GL_DOT3_RGB && k < 3);
    const std::size_t part = k == 3 && !is_dot ? 1 : 0;
    const auto arg = [&](std::size_t i) { return argument(part, i, k); };
    Range value = arg(0);
    switch (s.combiner.mode[part]) {
      case GL_REPLACE: break;
      case GL_MODULATE: value = value * arg(1); break;
      case GL_ADD: value = value + arg(1); break;
      case GL_ADD_SIGNED: value = value + arg(1) - 0.5; break;
      case GL_SUBTRACT: value = value - arg(1); break;
      case GL_INTERPOLATE: value = value * arg(2) + arg(1) * (Range(1) - arg(2)); break;
      default:
        value = 0;
        for (std::size_t j = 0; j < 3; ++j) value = value + (argument(0, 0, j) - 0.5) * (argument(0, 1, j) - 0.5) * 4.0;
    }
    c[k] = unit(wider(value, kTiny) * double(s.combiner.scales[part]));
  }
}

/// Tables 3.22 and 3.23 of the specification of OpenGL 1.5.
void apply_texture(const TextureUnit& s, Colors& c, const Colors& primary, const Colors& t) {
  if (s.env_mode == GL_COMBINE) return apply_combiner(s, c, primary, t);
  const GLenum format = s.image->format;
  const bool has_color = format != GL_ALPHA, has_alpha = format != GL_LUMINANCE && format != GL_RGB;
  const bool is_rgb = format == GL_RGB || format == GL_RGBA;  // GL_DECAL is undefined for others, and does nothing
  for (std::size_t k = 0; k < kColors; ++k) {
    if (k < 3 ? !has_color : !has_alpha) continue;
    const bool is_color = k < 3 || format == GL_INTENSITY;
    switch (s.env_mode) {
      case GL_REPLACE: c[k] = t[k]; break;
      case GL_DECAL: c[k] = k == 3 || !is_rgb ? c[k] : has_alpha ? mixed(c[k], t[k], t[3]) : t[k]; break;
      case GL_BLEND: c[k] = is_color ? mixed(c[k], double(s.env_color[k]), t[k]) : c[k] * t[k]; break;
      case GL_ADD: c[k] = is_color ? c[k] + t[k] : c[k] * t[k]; break;
      default: c[k] = c[k] * t[k]; break;
    }
    c[k] = unit(wider(c[k], kTiny));
  }
}

void apply_fog(const State& s, Colors& c, Range distance) {
  const double end = double(s.fog_end), error = 2e-7 * (std::abs(end) + distance.high);
  const Range f = wider(Range(end) - distance, error) * (1 / (end - double(s.fog_start)));
  for (std::size_t k = 0; k < 3; ++k) c[k] = wider(mixed(double(s.fog_color[k]), c[k], unit(wider(f, kTiny))), kTiny);
}

// clang-format off
int stencil_after(const State& s, std::size_t outcome, int old) {
  const GLenum op = s.stencil_ops[outcome];
  if (!s.stencil_test || op == GL_KEEP || old < 0) return old;
  const int writes = int(s.stencil_writes & 255);
  int to = ~old;  // GL_INVERT
  switch (op) {
    case GL_ZERO: to = 0; break;                      case GL_REPLACE: to = std::clamp(s.stencil_ref, 0, 255); break;
    case GL_INCR: to = std::min(old + 1, 255); break; case GL_DECR: to = std::max(old - 1, 0); break;
    case GL_INCR_WRAP: to = old + 1; break;           case GL_DECR_WRAP: to = old - 1; break;
  }
  return (old & ~writes) | (to & writes);
}

Range factor(const State& s, GLenum name, std::size_t k, const Colors& from, const Colors& kept) {
  const Range one(1), constant = double(s.blend_color[k]), constant_alpha = double(s.blend_color[3]);
  switch (name) {
    case GL_ZERO: return 0;
    case GL_SRC_COLOR: return from[k];             case GL_ONE_MINUS_SRC_COLOR: return one - from[k];
    case GL_DST_COLOR: return kept[k];             case GL_ONE_MINUS_DST_COLOR: return one - kept[k];
    case GL_SRC_ALPHA: return from[3];             case GL_ONE_MINUS_SRC_ALPHA: return one - from[3];
    case GL_DST_ALPHA: return kept[3];             case GL_ONE_MINUS_DST_ALPHA: return one - kept[3];
    case GL_CONSTANT_COLOR: return constant;       case GL_ONE_MINUS_CONSTANT_COLOR: return one - constant;
    case GL_CONSTANT_ALPHA: return constant_alpha; case GL_ONE_MINUS_CONSTANT_ALPHA: return one - constant_alpha;
    case GL_SRC_ALPHA_SATURATE: return k == 3 ? one : least(from[3], one - kept[3]);
    default: return one;
  }
}
// clang-format on

Range blended(const State& s, std::size_t k, const Colors& from, const Colors& kept) {
  const GLenum equation = s.equations[k / 3];
  if (equation == GL_MIN) return least(from[k], kept[k]);
  if (equation == GL_MAX) return greatest(from[k], kept[k]);
  const Range a = from[k] * factor(s, s.factors[k / 3 * 2], k, from, kept);
  const Range b = kept[k] * factor(s, s.factors[k / 3 * 2 + 1], k, from, kept);
  return equation == GL_FUNC_ADD ? a + b : equation == GL_FUNC_SUBTRACT ? a - b : b - a;
}

/// The lowest bits of the name say for which pairs of bits the result is 1.
Range by_logic(GLenum op, Range from, Range kept) {
  if (op == GL_COPY) return from;
  if (op == GL_NOOP) return kept;
  if (from.low != from.high || kept.low != kept.high) return {0, 255};
  const unsigned s = unsigned(from.low), t = unsigned(kept.low);
  return (op & 1 ? s & t : 0) | (op & 2 ? s & ~t : 0) | (op & 4 ? ~s & t & 255 : 0) | (op & 8 ? ~s & ~t & 255 : 0);
}

Pixel either(const Pixel& a, const Pixel& b) {
  Pixel p{{}, hull(a.depth, b.depth), a.source == b.source ? a.source : 0, a.stencil == b.stencil ? a.stencil : -1};
  for (std::size_t k = 0; k < kColors; ++k) p.color[k] = hull(a.color[k], b.color[k]);
  return p;
}

// ---- Vertices and primitives.

// Values of a vertex: window x and y in 1/256 pixel and window depth, all times w, and w; distances from the near, the
// far and the user's clip planes, positive on the side that is seen; color; s, t, q of each unit; distance from the
// eye; 1.
enum Value { kX, kY, kZ, kW, kNear, kFar, kUser, kColor = kUser + 2, kS = kColor + 4, kT, kQ };
constexpr std::size_t kFog = kS + 3 * kUnits, kOne = kFog + 1, kValues = kOne + 1;

struct Corner {
  std::array<double, kValues> v;
  bool is_whole;   ///< no plane cuts off the vertex or is near it; x and y are whole numbers
  bool is_inside;  ///< whole, and in the viewport
  double x, y;     ///< window place
  float z;         ///< window depth
};

struct Fragment {
  Answer covered;
  std::array<Range, kValues> values;
  Range depth;
  std::size_t source;
  /// Of each unit's texture coordinates from pixel to pixel: the square of the greater length, in texels.
  std::array<Range, kUnits> changes{};
};

using Linear = glm::dvec3;  ///< a linear function over the window
double at(const Linear& f, double x, double y) { return f.x * x + f.y * y + f.z; }
/// The greatest change from pixel to pixel, in any direction.
double change(const Linear& f) { return std::sqrt(f.x * f.x + f.y * f.y) * 256; }
/// The stored depth where nothing is interpolated.
Range depth_of(float z, double offset = 0) { return stored(double(z * 16777215.0f + float(offset)), 0, kMostDepth); }

struct Side {
  Linear inside_by;  ///< positive inside
  bool is_inside;    ///< whether the side itself is
};

/// A triangle or a line between sides. A pixel is the sum of the vertices' homogeneous places (x w, y w, w), each times
/// a weight. Weights are linear in the window and positive inside the primitive, and their sum is 1/w. So nothing is
/// cut: the planes only refuse pixels.
template <std::size_t n>
struct Primitive {
  const std::array<Corner, n>& c;
  bool is_whole, has_one_depth = true;
  std::array<Linear, n> places{};        ///< whole numbers, without w, if is_whole
  std::vector<Side> sides = {};          ///< of which the first n are weights of corners, times `area`
  double area = 0;                       ///< positive
  std::array<Linear, kValues> linear{};  ///< values divided by w
  std::array<Range, kValues> limits{};   ///< of values
  double least_w = 1e300;                ///< that is seen
  double most = 0;                       ///< greatest w and distance from a plane
  double band = 0;                       ///< pixels by which rounding may move vertices that a plane makes
  double slope = 0;                      ///< greatest change of a weight from pixel to pixel, out of 1
  double offset = 0;                     ///< steps of depth
  double depth_sum = 0;                 ///< greatest sum of depth's changes across and along the window, where is_whole
  std::array<Range, kUnits> changes{};  ///< as in Fragment
  std::size_t source = 0;

  explicit Primitive(const std::array<Corner, n>& corners)
      : c(corners), is_whole(std::all_of(c.begin(), c.end(), [](const Corner& v) { return v.is_whole; })) {
    for (std::size_t i = 0; i < n; ++i)
      places[i] = is_whole ? Linear(c[i].x, c[i].y, 1) : Linear(c[i].v[kX], c[i].v[kY], c[i].v[kW]);
  }

  /// Finds everything else. Precondition: places, sides and area are there.
  void set_up(const State& s, Interpreter& to) {
    double farthest = 0, most_inverse = 0;
    std::vector<std::array<double, kColor>> key(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto &v = c[i].v, &next = c[(i + 1) % n].v;
      const Linear weight = sides[i].inside_by / (area * (is_whole ? v[kW] : 1));
      for (std::size_t k = 0; k < kValues; ++k) {
        const bool is_flat = s.shade_model == GL_FLAT && k >= kColor && k < kS;  // the last corner's color
        const double value = is_flat ? c[n - 1].v[k] : k == kZ && is_whole ? double(c[i].z) * v[kW] : v[k];
        limits[k] = i == 0 ? value : hull(limits[k], value);
        linear[k] += weight * value;
      }
      has_one_depth = has_one_depth && is_whole && c[i].z == c[0].z;
      const double at_near = v[kW] + (next[kW] - v[kW]) * v[kNear] / (v[kNear] - next[kNear]);
      if (v[kNear] >= 0) least_w = std::min(least_w, v[kW]);
      if ((v[kNear] < 0) != (next[kNear] < 0)) least_w = std::min(least_w, at_near);
      slope = is_whole ? std::max(slope, change(weight) * v[kW]) : 256;
      farthest = std::max(farthest, std::abs(v[kX]) + std::abs(v[kY]) + std::abs(v[kW]) * 65536);
      for (std::size_t k = kW; k < kColor; ++k) most = std::max(most, std::abs(v[k]));
      std::copy_n(v.begin(), kColor, key[i].begin());
      if (is_whole) key[i] = {c[i].x, c[i].y, double(c[i].z)};
    }
    for (const double x : {-kRoom, to.width * 256 + kRoom})
      for (const double y : {-kRoom, to.height * 256 + kRoom})
        most_inverse = std::max(most_inverse, at(linear[kOne], x, y));
    if (!is_whole && most_inverse > 0) least_w = std::max(least_w, 1 / most_inverse);
    if (!is_whole) band = (1.5 + farthest / least_w * 0x1p-22) / 256;
    // A depth is the sum of a corner's depth and two changes, in floats, each with rounding errors. Where the changes
    // are greater than four depths, KeyPlane counts as steep, and doubles are summed.
    for (std::size_t i = 0; i < n && is_whole; ++i)
      for (std::size_t j = 0; j < i; ++j)
        depth_sum = std::max(depth_sum,
                             std::abs(linear[kZ].x * (c[i].x - c[j].x)) + std::abs(linear[kZ].y * (c[i].y - c[j].y)));
    const double steepest = has_one_depth ? 0 : std::max(std::abs(linear[kZ].x), std::abs(linear[kZ].y)) * 256;
    for (std::size_t unit = 0; unit < kUnits; ++unit)
      if (s.units[unit].is_on && n == 3) changes[unit] = changes_of(*s.units[unit].image, 3 * unit);
    const auto [factor, units] = s.polygon_offset;
    if (s.offset && n == 3) offset = steepest * kMostDepth * double(factor) + double(units);
    // A depth depends on nothing but the vertices, for triangles in any order, and on what cuts them.
    if (is_whole && n == 3) std::sort(key.begin(), key.end());
    key.push_back({offset});
    source = to.sources.try_emplace(key, to.sources.size() + 1).first->second;
  }

  /// The change is known only where texture coordinates are linear in the window. `from` is what precedes the unit's.
  [[nodiscard]] Range changes_of(const Image& image, std::size_t from) const {
    const auto is_one = [&](std::size_t k) { return limits[k].low == limits[k].high; };
    if (!is_whole || !is_one(kW) || !is_one(kQ + from)) return {0, 1e30};
    const double scale = 256 * limits[kW].low / limits[kQ + from].low;
    double across = 0, up = 0, error = 0;
    for (const std::size_t k : {kS + from, kT + from}) {
      const double size = k == kS + from ? image.levels[0].width : image.is_1d ? 0 : image.levels[0].height;
      across += std::pow(linear[k].x * scale * size, 2), up += std::pow(linear[k].y * scale * size, 2);
      error += 1e-6 * (1 + slope) * std::max(std::abs(limits[k].low), std::abs(limits[k].high)) * size;
    }
    const double length = std::sqrt(std::max(across, up));
    return {std::pow(std::max(length * (1 - 1e-5) - error, 0.0), 2), std::pow(length * (1 + 1e-5) + error, 2)};
  }

  [[nodiscard]] Fragment at_place(double x, double y) const {
    Fragment f{Answer::yes, {}, {}, source};
    const auto refuse = [&](const Linear& inside_by, double error, bool is_inside) {
      const double value = at(inside_by, x, y);
      Answer answer = is_positive(value, error);
      if (is_whole && value == 0) answer = is_inside ? Answer::yes : Answer::no;
      f.covered = std::min(f.covered, answer);
      return f.covered == Answer::no;
    };
    for (const Side& side : sides)
      if (refuse(side.inside_by, change(side.inside_by) * band, side.is_inside)) return f;
    const double error = most * std::abs(at(linear[kOne], x, y)) * kTiny;
    for (std::size_t k = kNear; k < kColor && !is_whole; ++k)
      if (refuse(linear[k], change(linear[k]) * band + error, true)) return f;
    // Linear functions and their quotients are greatest and least in the corners of the band.
    const auto around = [&](const auto& function) {
      Range range = function(x, y);
      for (const double px : {x - band * 256, x + band * 256})
        for (const double py : {y - band * 256, y + band * 256}) range = hull(range, function(px, py));
      return range;
    };
    const double inverse = around([&](double px, double py) { return at(linear[kOne], px, py); }).low;
    const double of_spread = inverse > 0 ? std::min(1.0, 4e-6 * (1 + slope) / (least_w * inverse)) : 1;
    for (std::size_t k = kColor; k < kOne; ++k) {
      const auto [low, high] = f.values[k] = limits[k];
      if (low == high || inverse <= 0) continue;
      const Range v = around([&](double px, double py) { return at(linear[k], px, py) / at(linear[kOne], px, py); });
      f.values[k] = wider(limited(v, limits[k]), (high - low) * of_spread + (std::abs(low) + std::abs(high)) * 2e-7);
    }
    const Range z = unit(around([&](double px, double py) { return at(linear[kZ], px, py); }));
    const double depth_error =
        is_whole ? 3 + 4 * std::min(depth_sum, 4.0) : 12 + most / least_w * 4 + std::abs(offset) * 0.1;
    f.changes = changes;
    f.depth = has_one_depth ? depth_of(c[0].z, offset) : stored(z * kMostDepth + offset, depth_error, kMostDepth);
    return f;
  }
};

/// What one call draws.
struct Drawing {
  Interpreter& to;
  const State& s;
  std::optional<std::int64_t> stipple_count = 0;  ///< nothing, if not known

  /// Visits the pixels that may be drawn, at most `more` pixels from the corners.
  template <std::size_t n, class Use>
  void each_pixel(const std::array<Corner, n>& corners, double more, bool by_viewport, const Use& use) const {
    double x0 = 0, y0 = 0, x1 = to.width - 1, y1 = to.height - 1;
    const auto limit = [&](double left, double low, double right, double top) {
      x0 = std::max(x0, left), y0 = std::max(y0, low), x1 = std::min(x1, right), y1 = std::min(y1, top);
    };
    const auto limit_by = [&](const auto& r) { limit(r[0], r[1], r[0] + r[2] - 1, r[1] + r[3] - 1); };
    if (s.scissor_test) limit_by(s.scissor);
    if (by_viewport) limit_by(s.viewport);
    Range x = nothing(), y = x;
    bool is_behind = n == 0;
    for (const Corner& c : corners) x = hull(x, c.x / 256), y = hull(y, c.y / 256), is_behind |= c.v[kW] <= 0;
    if (!is_behind) limit(x.low - more - 1, y.low - more - 1, x.high + more + 1, y.high + more + 1);
    for (int j = int(y0); j <= y1; ++j)
      for (int i = int(x0); i <= x1; ++i) use(i, j, to.pixels[std::size_t(j * to.width + i)]);
  }

  [[nodiscard]] Corner transformed(const Vertex& vertex) const {
    const glm::dmat4 projection = glm::make_mat4(s.projection.data()), modelview = glm::make_mat4(s.modelview.data());
    // Floats in this order, as the library states: places are rounded from them.
    const auto times = [&](const glm::mat4& m, int i) {
      const auto& [x, y, z, w] = vertex.position;
      return ((m[0][i] * x + m[1][i] * y) + m[2][i] * z) + m[3][i] * w;
    };
    glm::vec4 clip, eye;
    for (int i = 0; i < 4; ++i) clip[i] = times(glm::mat4(projection * modelview), i), eye[i] = times(modelview, i);
    const double z = double(clip.z), w = double(clip.w);
    const auto& [left, low, width, height] = s.viewport;
    Corner c{};
    const auto placed = [&](int axis, double first, double size) {
      c.v[std::size_t(axis)] = double(clip[axis]) * (size / 2) + w * (first + size / 2);
      return clip[axis] * (1 / clip.w) * float(size / 2) + float(first + size / 2);
    };
    c.x = std::nearbyint(placed(kX, left * 256.0, width * 256.0));
    c.y = std::nearbyint(placed(kY, low * 256.0, height * 256.0));
    c.z = std::clamp(placed(kZ, s.depth_range[0], s.depth_range[1] - s.depth_range[0]), 0.0f, 1.0f);
    c.v[kW] = w, c.v[kNear] = z + w, c.v[kFar] = w - z, c.v[kOne] = 1, c.v[kFog] = std::abs(double(eye.z));
    c.is_whole = z + w >= 0 && w - z >= 0 && w > 0 && std::abs(c.x) < kRoom && std::abs(c.y) < kRoom;
    for (std::size_t plane = 0; plane < 2; ++plane) {
      const auto& p = s.clip_planes[plane];
      const double sum = glm::dot(glm::dvec4(p[0], p[1], p[2], p[3]), glm::dvec4(eye));
      c.v[kUser + plane] = (plane == 0 ? s.clip_plane0 : s.clip_plane1) ? sum : 1;
      c.is_whole = c.is_whole && c.v[kUser + plane] > kTiny * 10;
    }
    c.is_inside = c.is_whole && Range(left, left + width).holds(c.x / 256) && Range(low, low + height).holds(c.y / 256);
    std::copy_n(vertex.color.begin(), 4, c.v.begin() + kColor);
    for (std::size_t unit = 0, k = kS; unit < kUnits; ++unit)
      for (const std::size_t part : {0, 1, 3}) c.v[k++] = double(vertex.texcoords[unit][part]);
    return c;
  }

  /// Draws a part of a polygon. Its `edges` to the next corner are those of the polygon, in the order of drawing. The
  /// stipple begins anew unless the part before was outlined. \returns whether this one is.
  bool draw_triangle(const std::array<Corner, 3>& c, std::initializer_list<std::size_t> edges, bool goes_on) {
    Primitive<3> p(c);
    p.area = glm::dot(p.places[0], glm::cross(p.places[1], p.places[2]));
    const bool is_front = (p.area >= 0) == (s.front == GL_CCW), are_filled = s.polygon_modes == State().polygon_modes;
    const bool is_culled = s.cull_face && (s.culled == GL_FRONT_AND_BACK || (s.culled == GL_FRONT) == is_front);
    if (is_culled || (p.area == 0 && (are_filled || s.cull_face))) return false;
    const GLenum mode = s.polygon_modes[is_front ? 0 : 1];
    if (mode != GL_FILL && !p.is_whole) {  // planes make edges
      Pixel any{{}, {0, kMostDepth}, 0, -1};
      any.color.fill({0, 255});
      each_pixel(std::array<Corner, 0>(), 0, false, [&](int, int, Pixel& pixel) { pixel = any; });
      return false;
    }
    if (mode == GL_FILL) {
      if (p.area != 0) fill_triangle(p, c);
      return false;
    }
    if (!goes_on) stipple_count = 0;
    for (const std::size_t k : edges) {
      std::array<Corner, 2> ends{c[k], c[(k + 1) % 3]};
      for (Corner& end : ends)
        if (s.shade_model == GL_FLAT) std::copy_n(c[2].v.begin() + kColor, kColors, end.v.begin() + kColor);
      if (mode == GL_LINE)
        draw_line(ends);
      else
        draw_point(ends[0]);
    }
    return true;
  }

  void fill_triangle(Primitive<3>& p, const std::array<Corner, 3>& c) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Linear side = glm::cross(p.places[(k + 1) % 3], p.places[(k + 2) % 3]) * (p.area < 0 ? -1.0 : 1.0);
      p.sides.push_back({side, side.x > 0 || (side.x == 0 && side.y > 0)});  // left and bottom sides are inside
    }
    p.area = std::abs(p.area);
    p.set_up(s, to);
    each_pixel(c, p.band, true,
               [&](int x, int y, Pixel& pixel) { draw_fragment(pixel, p.at_place(x * 256.0 + 128, y * 256.0 + 128)); });
  }

  /// Pixels side by side across the axis along which the line is longer, whose centres are from the first end to before
  /// the second one. A line between two pixels takes the lower one.
  void draw_line(const std::array<Corner, 2>& c) {
    Primitive<2> p(c);
    const Linear &a = p.places[0], &b = p.places[1];
    Linear along = glm::cross(a, b);  // zero along the line
    const int main = std::abs(along.y) >= std::abs(along.x) ? kX : kY, other = kY - main;
    const double turn = along[other] < 0 ? -1 : 1, length = std::abs(along[other]), run = b[main] * a.z - a[main] * b.z;
    if (!c[0].is_inside || !c[1].is_inside) stipple_count.reset();
    if (length == 0 || run == 0) return;
    p.area = std::abs(run);
    along *= turn;
    Linear to_b(0, 0, b[main]), from_a(0, 0, -a[main]);
    to_b[main] = -b.z, from_a[main] = a.z;
    const double sign = run < 0 ? -1 : 1, width = std::max(std::floor(double(s.line_width) + 0.5), 1.0);
    const Linear half(0, 0, width * 128 * length);
    p.sides = {{to_b * sign, false}, {from_a * sign, true}, {half + along, true}, {half - along, false}};
    p.set_up(s, to);
    // Where a cut line is nearly diagonal, the other axis may be the longer one.
    if (!p.is_whole && std::abs(std::abs(along.x) - std::abs(along.y)) < length * 0.02) p.band = width + 2;
    // The first pixel has its centre at or after the start, as has the first one after the line.
    const auto first_after = [&](double place) { return std::int64_t(sign * std::ceil(sign * (place - 128) / 256)); };
    const std::int64_t first = first_after(a[main] / a.z), end = first_after(b[main] / b.z);
    each_pixel(c, width + 2, true, [&](int x, int y, Pixel& pixel) {
      Fragment f = p.at_place(x * 256.0 + 128, y * 256.0 + 128);
      if (s.stipple && !stipple_count) f.covered = std::min(f.covered, Answer::maybe);
      const std::int64_t number = stipple_count.value_or(0) + std::abs((main == kX ? x : y) - first);
      const bool is_left_out = (s.stipple_pattern >> (number / s.stipple_factor % 16) & 1) == 0;
      if (!s.stipple || !stipple_count || !is_left_out) draw_fragment(pixel, f);
    });
    if (stipple_count) *stipple_count += std::abs(end - first);
  }

  /// A square. An odd one is centred on the pixel of the vertex, an even one on the nearest corner of pixels.
  void draw_point(const Corner& c) const {
    if (!c.is_inside) return;
    const double size = std::max(std::floor(double(s.point_size) + 0.5), 1.0), half = std::floor(size / 2);
    const double shift = size == 2 * half ? 128 : 0;
    const double left = std::floor((c.x + shift) / 256) - half, low = std::floor((c.y + shift) / 256) - half;
    Fragment f{Answer::yes, {}, depth_of(c.z), 0};
    std::copy(c.v.begin(), c.v.end(), f.values.begin());
    each_pixel(std::array{c}, size, false, [&](int x, int y, Pixel& pixel) {
      if (x >= left && x < left + size && y >= low && y < low + size) draw_fragment(pixel, f);
    });
  }

  void draw_fragment(Pixel& p, const Fragment& f) const {
    const auto& v = f.values;
    Colors c{v[kColor], v[kColor + 1], v[kColor + 2], v[kColor + 3]}, kept;
    const Colors primary = c;
    for (std::size_t unit = 0; unit < kUnits; ++unit) {
      const TextureUnit& by = s.units[unit];
      const Range q = v[kQ + 3 * unit], inverse = q.low > 0 ? Range(1 / q.high, 1 / q.low) : Range(-1e9, 1e9);
      const auto over_q = [&](Range r) {
        return q.low == 1 && q.high == 1 ? r : wider(r * inverse, 1e-6 * (1 + std::abs(r.low)));
      };
      if (!by.is_on) continue;
      const Range u = over_q(v[kS + 3 * unit]), t = over_q(v[kT + 3 * unit]);
      apply_texture(by, c, primary, sampled(by, u, t, f.changes[unit]));
    }
    if (s.fog) apply_fog(s, c, v[kFog]);
    Answer seen = f.covered, right = Answer::yes, in_front = Answer::yes;
    if (s.alpha_test) seen = std::min(seen, compared(s.alpha_func, byte(c[3]), byte(double(s.alpha_ref))));
    const int mask = int(s.stencil_mask & 255), ref = std::clamp(s.stencil_ref, 0, 255) & mask;
    if (s.stencil_test) right = p.stencil < 0 ? Answer::maybe : compared(s.stencil_func, ref, p.stencil & mask);
    const bool is_same = f.source != 0 && f.source == p.source;
    if (s.depth_test) in_front = is_same ? compared(s.depth_func, 0, 0) : compared(s.depth_func, f.depth, p.depth);
    Pixel passed = p;
    if (s.depth_test && s.depth_mask) passed.depth = f.depth, passed.source = f.source;
    for (std::size_t k = 0; k < kColors; ++k) kept[k] = p.color[k] * (1.0 / 255), c[k] = unit(c[k]);
    for (std::size_t k = 0; k < kColors; ++k) {
      const Range color = byte(s.blend && !s.logic ? blended(s, k, c, kept) : c[k]);
      if (s.color_mask[k]) passed.color[k] = s.logic ? by_logic(s.logic_op, color, p.color[k]) : color;
    }
    // Every outcome that is possible, from the first operation that refuses the fragment to none.
    std::optional<Pixel> result;
    const auto add = [&](Pixel outcome, int stencil) {
      outcome.stencil = stencil;
      result = result ? either(*result, outcome) : outcome;
    };
    if (seen != Answer::yes) add(p, p.stencil);
    if (seen != Answer::no && right != Answer::yes) add(p, stencil_after(s, 0, p.stencil));
    const Answer tested = std::min(seen, right);
    if (tested != Answer::no && in_front != Answer::yes) add(p, stencil_after(s, 1, p.stencil));
    if (tested != Answer::no && in_front != Answer::no) add(passed, stencil_after(s, 2, p.stencil));
    p = *result;
  }
};

}  // namespace

void Interpreter::draw(const State& s, GLenum mode, const std::vector<Vertex>& vertices) {
  std::vector<Corner> v;
  Drawing drawing{*this, s};
  for (const Vertex& vertex : vertices) v.push_back(drawing.transformed(vertex));
  bool goes_on = false;
  const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c, std::initializer_list<std::size_t> edges) {
    goes_on = drawing.draw_triangle({v[a], v[b], v[c]}, edges, goes_on);
  };
  const auto line = [&](std::size_t a, std::size_t b) { drawing.draw_line({v[a], v[b]}); };
  constexpr std::size_t kSteps[] = {1, 2, 1, 1, 3, 1, 1, 4, 2, 1}, kSizes[] = {1, 2, 2, 2, 3, 3, 3, 4, 4, 3};
  for (std::size_t i = 0; i + kSizes[mode] <= v.size(); i += kSteps[mode]) {
    goes_on = goes_on && mode == GL_POLYGON;
    switch (mode) {
      case GL_POINTS: drawing.draw_point(v[i]); break;
      case GL_LINES: drawing.stipple_count = 0, line(i, i + 1); break;
      case GL_LINE_LOOP:
      case GL_LINE_STRIP: line(i, i + 1); break;
      case GL_TRIANGLES: triangle(i, i + 1, i + 2, {0, 1, 2}); break;
      case GL_TRIANGLE_STRIP: triangle(i + i % 2, i + 1 - i % 2, i + 2, {0, 1, 2}); break;
      case GL_TRIANGLE_FAN: triangle(0, i + 1, i + 2, {0, 1, 2}); break;
      case GL_QUADS: triangle(i, i + 1, i + 3, {2, 0}), triangle(i + 1, i + 2, i + 3, {0, 1}); break;
      case GL_QUAD_STRIP: triangle(i, i + 1, i + 3, {0, 1}), triangle(i + 2, i, i + 3, {2, 0}); break;
      default: {  // GL_POLYGON
        const bool is_first = i == 0, is_last = i + 3 == v.size();
        if (is_first)
          is_last ? triangle(1, 2, 0, {2, 0, 1}) : triangle(1, 2, 0, {2, 0});
        else
          is_last ? triangle(i + 1, i + 2, 0, {0, 1}) : triangle(i + 1, i + 2, 0, {0});
      }
    }
  }
  if (mode == GL_LINE_LOOP && v.size() >= 2) line(v.size() - 1, 0);
}

void Interpreter::clear(const State& s, GLbitfield planes) {
  const int writes = int(s.stencil_writes & 255);
  Drawing{*this, s}.each_pixel(std::array<Corner, 0>(), 0, false, [&](int, int, Pixel& p) {
    for (std::size_t k = 0; k < 4 && (planes & GL_COLOR_BUFFER_BIT) != 0; ++k)
      if (s.color_mask[k]) p.color[k] = byte(double(s.clear_color[k]));
    if ((planes & GL_DEPTH_BUFFER_BIT) != 0 && s.depth_mask)
      p.depth = std::nearbyint(s.clear_depth * kMostDepth), p.source = 0;
    const bool is_known = p.stencil >= 0 || writes == 255;
    if ((planes & GL_STENCIL_BUFFER_BIT) != 0 && is_known)
      p.stencil = (p.stencil & ~writes & 255) | (s.clear_stencil & writes);
  });
}

}  // namespace frontmost::test::gl
