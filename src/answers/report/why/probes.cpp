// SPDX-License-Identifier: Apache-2.0
#include "report/why/probes.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "base/pool.h"

namespace frontmost::why_detail {

using namespace zbuffer_detail;
using accounting_detail::MaskPlane;
using accounting_detail::ObjectMask;

namespace {

constexpr std::uint64_t kProbesOfObject = 4;

/// Adds samples of a mask, at even steps from the first marked one to the last.
void choose_marked(const ObjectMask& mask, std::uint32_t object, std::vector<SampleProbe>& probes) {
  const PixelRect& rect = mask.touched();
  constexpr int kWordBits = accounting_detail::kWordPixels;
  const auto visit_words = [&](const auto& visit) {
    for (const MaskPlane& plane : mask.planes())
      for (int y = rect.y0; y <= rect.y1; ++y)
        for (int word = rect.x0 / kWordBits; word <= rect.x1 / kWordBits; ++word)
          if (const std::uint64_t bits = plane.row(y)[word]) visit(plane, y, word * kWordBits, bits);
  };
  std::uint64_t total = 0;
  visit_words([&](const MaskPlane&, int, int, std::uint64_t bits) { total += std::uint64_t(std::popcount(bits)); });
  const std::uint64_t count = std::min(total, kProbesOfObject);
  std::uint64_t passed = 0, chosen = 0;
  visit_words([&](const MaskPlane& plane, int y, int x, std::uint64_t bits) {
    for (; chosen < count; ++chosen) {
      const std::uint64_t rank = total * (2 * chosen + 1) / (2 * count);
      if (rank >= passed + std::uint64_t(std::popcount(bits))) break;
      std::uint64_t rest = bits;
      for (std::uint64_t i = passed; i < rank; ++i) rest &= rest - 1;
      probes.push_back({object, x + std::countr_zero(rest), y, int(plane.number)});
    }
    passed += std::uint64_t(std::popcount(bits));
  });
}

/// The probes, by squares of pixels.
class ProbeGrid {
 public:
  ProbeGrid(const std::vector<SampleProbe>& probes, const View& view)
      : across_(std::size_t(view.width) / kSide + 1),
        begin_(across_ * (std::size_t(view.height) / kSide + 1) + 1, 0),
        numbers_(probes.size()) {
    for (const SampleProbe& probe : probes) ++begin_[square_of(probe) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t i = 0; i < probes.size(); ++i) numbers_[next[square_of(probes[i])]++] = i;
  }

  /// Calls visit(number) for the probes in all squares that a rectangle touches.
  template <class Visit>
  void visit(const PixelRect& rect, const Visit& visit) const {
    for (std::size_t row = std::size_t(rect.y0) / kSide; row <= std::size_t(rect.y1) / kSide; ++row) {
      const std::uint32_t last = begin_[row * across_ + std::size_t(rect.x1) / kSide + 1];
      for (std::uint32_t i = begin_[row * across_ + std::size_t(rect.x0) / kSide]; i < last; ++i) visit(numbers_[i]);
    }
  }

 private:
  static constexpr std::size_t kSide = 8;

  [[nodiscard]] std::size_t square_of(const SampleProbe& probe) const {
    return std::size_t(probe.y) / kSide * across_ + std::size_t(probe.x) / kSide;
  }

  std::size_t across_;
  std::vector<std::uint32_t> begin_, numbers_;
};

/// A triangle at a probe.
struct ProbeHit {
  std::uint32_t probe, object;
  float key;
  PrimitiveId id;

  [[nodiscard]] bool is_before(const ProbeHit& other) const {
    return key != other.key ? key > other.key : id < other.id;
  }
};

/// Tests one range of triangles after another at the probes. For one thread.
class ProbeCaster {
 public:
  ProbeCaster(const PlacedScene& scene, const ObjectCanvas& canvas, const std::vector<SampleProbe>& probes,
              const ProbeGrid& grid, Isa isa)
      : scene_(scene),
        canvas_(canvas),
        target_(canvas.transform, canvas.view, scene.sides.get(), isa),
        probes_(probes),
        grid_(grid) {}

  void cast(const MeshRange& range, std::vector<ProbeHit>& hits) {
    const WorldTriangles triangles = world_triangles(scene_, range, target_.isa, scratch_);
    snap_vertices(target_, triangles.positions, scratch_.vertices);
    scratch_.apart.clear();
    batch_.clear();
    place_triangles(target_, triangles, scratch_.vertices, batch_, scratch_.apart);
    for (std::size_t i = 0; i < batch_.count; ++i) cast(range.instance, batch_.record(i), hits);
    records_.clear();
    for (const std::uint32_t i : scratch_.apart)
      append_polygon(target_, polygon_of(target_, triangles, scratch_.vertices, i), triangles.first_id + i, records_);
    for (const TriangleRecord& record : records_) cast(range.instance, record, hits);
  }

 private:
  void cast(std::uint32_t object, const TriangleRecord& record, std::vector<ProbeHit>& hits) const {
    const View& view = canvas_.view;
    grid_.visit(pixel_rect(record, view.width, view.height), [&](std::uint32_t number) {
      const SampleProbe& probe = probes_[number];
      const glm::ivec2 offset = sample_offsets(view.samples)[std::size_t(probe.sample)];
      visit_covered(record, {probe.x, probe.y, probe.x, probe.y}, offset, [&](int, int) {
        const int x = probe.x * kSubPixels + offset.x, y = probe.y * kSubPixels + offset.y;
        if (is_hole(record.id, x, y)) return;
        hits.push_back({number, object, TriangleKeys(record).at(x, y), record.id});
      });
    });
  }

  [[nodiscard]] bool is_hole(PrimitiveId id, int x, int y) const {
    return scene_.cutouts && scene_.cutouts->has(id) && ScreenCutout((*scene_.cutouts)[id], canvas_.rays).is_hole(x, y);
  }

  const PlacedScene& scene_;
  const ObjectCanvas& canvas_;
  PlaceTarget target_;
  const std::vector<SampleProbe>& probes_;
  const ProbeGrid& grid_;
  PlaceScratch scratch_;
  TriangleBatch batch_;
  std::vector<TriangleRecord> records_;
};

}  // namespace

std::vector<SampleProbe> choose_probes(const PlacedScene& scene, const ObjectCanvas& canvas,
                                       std::span<const std::uint32_t> objects, const Execution& execution) {
  constexpr std::size_t kObjectsAtOnce = 64;
  const std::vector<std::size_t> first = accounting_detail::first_ranges(scene);
  std::vector<std::vector<SampleProbe>> parts((objects.size() + kObjectsAtOnce - 1) / kObjectsAtOnce);
  Pool<ObjectMask> masks;
  parallel_for(execution, objects.size(), kObjectsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto mask = masks.borrow([&] { return std::make_unique<ObjectMask>(scene, canvas, execution.isa); });
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t range = first[objects[i]];
      mask->draw(std::span(scene.ranges).subspan(range, first[objects[i] + 1] - range));
      if (!mask->touched().is_empty()) choose_marked(*mask, objects[i], parts[begin / kObjectsAtOnce]);
    }
  });
  std::vector<SampleProbe> probes;
  for (const std::vector<SampleProbe>& part : parts) probes.insert(probes.end(), part.begin(), part.end());
  return probes;
}

std::vector<std::vector<std::uint32_t>> find_before(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                    const std::vector<SampleProbe>& probes,
                                                    const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16;
  const ProbeGrid grid(probes, canvas.view);
  std::vector<std::vector<ProbeHit>> parts((scene.ranges.size() + kRangesAtOnce - 1) / kRangesAtOnce);
  Pool<ProbeCaster> casters;
  parallel_for(execution, scene.ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto caster =
        casters.borrow([&] { return std::make_unique<ProbeCaster>(scene, canvas, probes, grid, execution.isa); });
    for (std::size_t i = begin; i < end; ++i) caster->cast(scene.ranges[i], parts[begin / kRangesAtOnce]);
  });
  constexpr ProbeHit kNothing{0, no_index, -1, no_primitive};
  std::vector<ProbeHit> own(probes.size(), kNothing);
  for (const std::vector<ProbeHit>& part : parts)
    for (const ProbeHit& hit : part)
      if (hit.object == probes[hit.probe].object && hit.is_before(own[hit.probe])) own[hit.probe] = hit;
  std::vector<std::vector<std::uint32_t>> before(probes.size());
  for (const std::vector<ProbeHit>& part : parts)  // in the order of objects, so the lists ascend
    for (const ProbeHit& hit : part) {
      std::vector<std::uint32_t>& objects = before[hit.probe];
      if (hit.object != probes[hit.probe].object && hit.is_before(own[hit.probe]) &&
          (objects.empty() || objects.back() != hit.object))
        objects.push_back(hit.object);
    }
  return before;
}

}  // namespace frontmost::why_detail
