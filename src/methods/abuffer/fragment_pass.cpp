// SPDX-License-Identifier: Apache-2.0
// Traverses the tiles of one frame several times: first to find what is seen, then to paint it. A tile that holds too
// many fragments is first thinned: invisible copies are left out. It is then halved along both axes until its parts
// have room; a part of one pixel always has room.
//
//    same place     id 3 (opaque)   id 8   id 9         3 hides 8 and 9 everywhere: they are left out
//    same place     id 4 (clear)    id 5   id 6 ...     all count, or as many as there are layers
//
// A frame is refused before it is gathered, if the areas of the remaining triangles add up to too many fragments.

#include "abuffer/fragment_pass.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <tuple>

#include "abuffer/composite/composite_kernel.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "view/triangle_keys.h"

namespace frontmost::abuffer_detail {

std::uint64_t most_gathered_fragments(const View& view, std::uint64_t triangles) {
  constexpr std::uint64_t most_of_few = std::uint64_t(1) << 28, most_per_triangle = 1 << 10, most_per_pixel = 64;
  return std::max(std::min(most_fragments, most_of_few + most_per_triangle * triangles),
                  most_per_pixel * view.pixel_count());
}

namespace {

/// In pixels. Smaller triangles are drawn as quickly as their copies are found, so their copies are not looked for.
constexpr double kLeastArea = 16;

using PixelPolygon = std::vector<glm::dvec2>;

/// Returns the part of a convex polygon where sign * p[axis] <= bound.
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

/// Returns the area of the triangle within the picture, in pixels.
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

/// Positions and keys of a triangle's vertices, in an order that does not depend on which vertex comes first.
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
    place[std::size_t(3 * i + 2)] = bits_as<std::uint32_t>(t.key[k]);
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

  /// Finds the copies that nobody sees. Afterwards area() is the total area of all other triangles.
  std::vector<TriangleNumber> find() {
    std::vector<Candidate> candidates;
    plan_.for_each([&](const ScreenTriangle& t, const TriangleNumber& number) {
      const double area = area_in_picture(t, plan_.view());
      area_ += area;
      if (area >= kLeastArea) candidates.push_back({hash_of(place_of(t)), t.id, number});
    });
    // Triangles at one place become neighbours, in the order of ids, because lower ids hide higher ones.
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
  /// Finds hidden copies in a group of triangles with the same hash, ids ascending.
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

/// A frame with a tile that holds too many fragments.
class CrowdedFrame {
 public:
  CrowdedFrame(const FragmentPlan& plan, const CopyRule& rule) : plan_(plan), rule_(rule) {}

  /// Returns the plan without invisible copies, or the original plan if there are none. It is made at the first call,
  /// so frames without crowded tiles pay nothing. May be called by several threads at once. O(n log n) for n triangles
  /// of the frame. \throws Error limit_exceeded for more fragments than most_gathered_fragments().
  const FragmentPlan& thinned() {
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

 private:
  void make() {
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

  const FragmentPlan& plan_;
  const CopyRule& rule_;
  std::mutex mutex_;
  const FragmentPlan* thinned_ = nullptr;
  std::optional<FragmentPlan> made_;
  std::exception_ptr error_;
};

/// Returns the view. \throws Error if the view or an option is out of range.
const View& valid(const View& view, const AbufferOptions& options) {
  validate(view);
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "abuffer: opacity", "must be 0 to 1");
  return view;
}

/// Returns the share of light that passes below the surface, before any tint.
float limited_transmission(const Material& m) {
  if (m.unlit || !(m.transmission.factor > 0)) return 0;
  return std::min(m.transmission.factor, 1.0f) * (m.metallic > 0 ? 1 - std::min(m.metallic, 1.0f) : 1.0f);
}

/// Visits the tiles of a frame on one thread.
class TileVisitor {
 public:
  TileVisitor(GatherScratch& scratch, const PreparedFrame::Visit& visit) : scratch_(scratch), visit_(visit) {}

  /// \returns false if the rectangle has too many fragments at once; then nothing is visited.
  [[nodiscard]] bool visit_whole(const GatherInput& frame, const GatherJob& job) {
    const Gathered gathered = gather_tile(frame, job, scratch_);
    if (gathered == Gathered::too_much) return false;
    visit_(job.pixels, gathered == Gathered::something ? &scratch_ : nullptr);
    return true;
  }

  /// Visits the rectangle, or its parts.
  void visit_in_parts(const GatherInput& frame, const GatherJob& job) {
    if (visit_whole(frame, job)) return;
    // Parts consist of whole groups of 4 x 4 pixels, as long as the rectangle is larger than a group.
    const Rectangle& r = job.pixels;
    const auto half = [](int size) { return size > 4 ? (size / 2 + 3) / 4 * 4 : (size + 1) / 2; };
    const int w = half(r.width), h = half(r.height);
    for (int y = 0; y < r.height; y += h)
      for (int x = 0; x < r.width; x += w)
        visit_in_parts(frame, {{r.x + x, r.y + y, std::min(w, r.width - x), std::min(h, r.height - y)}, job.tile});
  }

 private:
  GatherScratch& scratch_;
  const PreparedFrame::Visit& visit_;
};

/// A share of light that is far below the rounding of a sum of floats.
constexpr float kNegligible = 0x1p-40f;

/// Extracts the fragments that may be seen from sorted lists, without the fragments that are hidden in the whole pixel.
/// Colours are not known yet, so the opacities of materials alone decide what hides. A texture may still cut holes, so
/// a blended material hides nothing. Clear fragments hide together, once only a negligible share of light passes
/// through all of them.
class Lister {
 public:
  Lister(const SamplePattern& pattern, const GatherScratch& scratch, const Opacities& opacities, float negligible)
      : pattern_(pattern), s_(scratch), opacities_(opacities), negligible_(negligible) {
    lists_.scratch = &scratch;
    lists_.fragments.reserve(scratch.arrived.count);
    lists_.numbers.reserve(scratch.arrived.count);
    lists_.begin.push_back(0);
  }
  [[nodiscard]] PixelLists take() { return std::move(lists_); }

  void add_pixel(int x, int y) {
    const std::uint32_t pixel = pixel_number(std::uint32_t(x), std::uint32_t(y));
    const std::size_t group = pixel / kGroup, length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel % kGroup;
    const float hidden = hidden_behind(words, length);
    float passes = 1;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      // Masks were not empty when they were appended, but may have lost all samples to holes since.
      if (s_.nearest_of(number) < hidden || s_.arrived.mask(number) == 0) continue;
      add(number);
      // At a single sample no part of a pixel is left: the first opaque fragment hides the rest.
      if (pattern_.count == 1 && hides_rest(id_of(number), passes)) break;
    }
    lists_.begin.push_back(std::uint32_t(lists_.fragments.size()));
  }

 private:
  /// Adds a fragment that covers the pixel. Returns whether nothing, or next to nothing, is seen behind it. `passes` is
  /// the share of light that passes all fragments so far.
  [[nodiscard]] bool hides_rest(PrimitiveId id, float& passes) const {
    passes *= 1 - opacities_.least(id);
    return opacities_.is_opaque(id) || passes < negligible_;
  }
  [[nodiscard]] PrimitiveId id_of(std::uint32_t number) const { return s_.triangles.id[s_.arrived.triangle[number]]; }

  /// Returns the key behind which nothing is seen anywhere in the pixel.
  [[nodiscard]] float hidden_behind(const std::uint64_t* words, std::size_t length) const {
    // -1 hides nothing: keys of fragments are at least 0.
    float key = -1, passes = 1, farthest = std::numeric_limits<float>::infinity();
    if (pattern_.count == 1) return key;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (s_.arrived.mask(number) != pattern_.full()) continue;
      // Clear fragments hide only together, so they hide only fragments that are behind all of them.
      farthest = std::min(farthest, s_.farthest_of(number));
      if (hides_rest(id_of(number), passes))
        key = std::max(key, opacities_.is_opaque(id_of(number)) ? s_.farthest_of(number) : farthest);
    }
    return key;
  }

  void add(std::uint32_t number) {
    const std::size_t t = s_.arrived.triangle[number];
    Fragment f;
    f.mask = s_.arrived.mask(number);
    f.primitive = s_.triangles.id[t];
    f.key = s_.arrived.key_of(number);
    f.key_dx = s_.triangles.gx[t] * kSubPixels;
    f.key_dy = s_.triangles.gy[t] * kSubPixels;
    f.opacity = opacities_.of(f.primitive);
    lists_.fragments.push_back(f);
    lists_.numbers.push_back(number);
  }

  const SamplePattern& pattern_;
  const GatherScratch& s_;
  const Opacities& opacities_;
  const float negligible_;
  PixelLists lists_;
};

/// Returns the colours for compositing one channel, with the alphas of this channel.
std::vector<glm::vec4> channel_of(const FragmentColors& colors, int channel) {
  std::vector<glm::vec4> table = colors.straight;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float alpha = colors.alphas[i][channel];
    if (alpha < 0) continue;
    // The fragment's contribution stays the same. A fragment with alpha 0 hides nothing and adds nothing.
    table[i][channel] *= alpha > 0 ? table[i].a / alpha : 0.0f;
    table[i].a = alpha;
  }
  return table;
}

/// Composites tinted fragments as three pictures of one channel each.
PaintedPixels composite(const CompositeInput& input, const Rectangle& pixels, const GatherScratch& fragments,
                        const FragmentColors& colors) {
  if (colors.alphas.empty()) return {composite_tile(input, pixels, fragments, colors.straight), {}};
  PaintedPixels painted;
  painted.colors.resize(std::size_t(pixels.width) * std::size_t(pixels.height));
  painted.alphas.resize(painted.colors.size());
  for (int c = 0; c < 3; ++c) {
    const std::vector<glm::vec4> channel = composite_tile(input, pixels, fragments, channel_of(colors, c));
    for (std::size_t i = 0; i < channel.size(); ++i) {
      painted.colors[i][c] = channel[i][c];
      painted.alphas[i][c] = channel[i].a;
    }
  }
  for (std::size_t i = 0; i < painted.colors.size(); ++i) {
    const glm::vec3& a = painted.alphas[i];
    painted.colors[i].a = a == glm::vec3(a.x) ? a.x : (a.x + a.y + a.z) / 3;
  }
  return painted;
}

}  // namespace

Opacities::Opacities(const Surfaces& surfaces, float opacity, const Execution& execution) : all_(opacity) {
  const IeeeScope ieee;
  const Scene& scene = surfaces.scene();
  std::vector<float> by_material;
  bool differ = false;
  for (const Material& m : scene.materials) {
    float value = opacity;
    if (m.alpha == Material::Alpha::blend) value *= m.base_color.a > 0 ? std::min(m.base_color.a, 1.0f) : 0.0f;
    if (m.is_see_through()) value *= 1 - limited_transmission(m);
    // Even blended materials of opacity 1 may be seen through where their texture says so.
    by_material.push_back(m.is_see_through() ? -value : value);
    differ = differ || by_material.back() != opacity;
  }
  if (!differ) return;
  // Most scenes have one opacity for all primitives and return above. Otherwise every fragment would read a number of
  // its primitive.
  values_.assign(surfaces.primitive_count(), opacity);
  parallel_for(execution, scene.instances.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      const PrimitiveId first = surfaces.first_primitive(std::uint32_t(i));
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t material = mesh.material_of(t);
        if (material < by_material.size()) values_[first + t] = by_material[material];
      }
    }
  });
}

PreparedFrame::PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                             const Execution& execution)
    : pattern_(sample_pattern(valid(view, options), options.grid)), plan_(surfaces, view, execution) {}

void PreparedFrame::visit_tiles(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                                const Execution& execution) const {
  const IeeeScope ieee;
  std::atomic<std::size_t> done{0};
  const std::size_t tiles = plan_.tile_count();
  CrowdedFrame crowded(plan_, copies);
  Pool<GatherScratch> scratches;
  parallel_for(execution, tiles, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      const GatherJob job{plan_.tile(tile), tile};
      if (leave_out && leave_out(job.pixels)) continue;
      const auto scratch = scratches.borrow([] { return std::make_unique<GatherScratch>(); });
      TileVisitor visitor(*scratch, visit);
      if (visitor.visit_whole({plan_, pattern_, execution.isa}, job)) continue;
      visitor.visit_in_parts({crowded.thinned(), pattern_, execution.isa}, job);
    }
    report_progress(execution, "visible", double(done += end - begin) / double(tiles));
  });
}

void PreparedFrame::visit_lists(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                                const Execution& execution) const {
  const GatherInput input{plan_, pattern_, execution.isa};
  const auto sort_and_visit = [&](const Rectangle& pixels, GatherScratch* fragments) {
    if (fragments) {
      sort_lists(execution.isa, *fragments);
      cut_fragments(input, pixels, *fragments);
    }
    visit(pixels, fragments);
  };
  visit_tiles(copies, sort_and_visit, leave_out, execution);
}

FragmentPass::FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                           const Execution& execution)
    : opacity_(options.opacity),
      frame_(surfaces, view, options, execution),
      opacities_(surfaces, options.opacity, execution),
      copies_(copy_rule(opacities_)) {}

PixelLists FragmentPass::lists_of(const Rectangle& pixels, const GatherScratch& fragments, float negligible) const {
  Lister lister(frame_.pattern(), fragments, opacities_, negligible);
  for (int y = 0; y < pixels.height; ++y)
    for (int x = 0; x < pixels.width; ++x) lister.add_pixel(x, y);
  return lister.take();
}

void FragmentPass::list_primitives(const Note& note, const LeaveOut& leave_out, const Execution& execution) const {
  const auto visit = [&](const Rectangle& /*pixels*/, const GatherScratch* fragments) {
    if (fragments) note({fragments->triangles.id.data(), fragments->triangles.count});
  };
  frame_.visit_tiles(copies_, visit, leave_out, execution);
}

void FragmentPass::look(const Look& look, const Execution& execution) const {
  const auto visit = [&](const Rectangle& pixels, const GatherScratch* fragments) {
    if (fragments) look(pixels, lists_of(pixels, *fragments, 0));
  };
  frame_.visit_lists(copies_, visit, nullptr, execution);
}

void FragmentPass::paint(const Paint& paint, const Receive& receive, const LeaveOut& leave_out,
                         const Execution& execution) const {
  const CompositeInput input{frame_.pattern(), opacity_, execution.isa};
  const auto visit = [&](const Rectangle& pixels, const GatherScratch* fragments) {
    if (!fragments) return receive(pixels, nullptr);
    // Colours are indexed by the fragments' numbers in Arrived, as the compositor reads them. Fragments that the lists
    // leave out have no effect.
    FragmentColors colors{std::vector<glm::vec4>(fragments->arrived.count, glm::vec4(0)), {}};
    paint(pixels, lists_of(pixels, *fragments, kNegligible), colors);
    const PaintedPixels painted = composite(input, pixels, *fragments, colors);
    receive(pixels, &painted);
  };
  frame_.visit_lists(copies_, visit, leave_out, execution);
}

}  // namespace frontmost::abuffer_detail
