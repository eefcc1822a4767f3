// SPDX-License-Identifier: Apache-2.0
// Compositing sorted lists, nearest first: what shows through is multiplied down, so nothing is ever re-read.
//
// T. Porter, T. Duff. Compositing Digital Images. 1984 (over); L. Carpenter. The A-buffer. 1984.
//
// The sixteen pixels of a group are composited at once. Those in which fragments change places are then taken again one
// by one.

#include "abuffer/composite/composite_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/composite/composite_kernel.cpp"
#include "base/isa.h"
#include "hwy/cache_control.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After Highway: a block of its own.
#include "abuffer/composite/conflicts-inl.h"
#include "abuffer/composite/group_composite-inl.h"
#include "abuffer/composite/pixel_composite-inl.h"
#include "abuffer/gather/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class TileCompositor {
 public:
  TileCompositor(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch, const FragmentColors& colors,
                 const PicturePlanes& out)
      : frame_(frame), job_(job), scratch_(scratch), colors_(colors), out_(out) {}

  template <int kSamples>
  void Run() {
    if (frame_.is_flat) return RunFlat();
    if (!colors_.by_fragment) FetchLocalColors();
    const glm::vec4* table = colors_.by_fragment ? colors_.table : scratch_.colors.data();
    GroupReader<(kSamples > 32)> reader(scratch_, frame_.pattern.full(), colors_.by_fragment);
    GroupCompositor<kSamples> groups(scratch_.fragments, table, colors_.opacity);
    ForGroups([&](std::size_t group, GroupColors& colors) {
      const std::uint64_t in_conflict = reader.Read(group);
      groups.Composite(scratch_.length(group), colors);
      // At a single sample the order is that of the lists.
      if constexpr (kSamples > 1) {
        PixelCompositor<kSamples> pixels(frame_, scratch_, table, colors_.opacity);
        ForEachBit(in_conflict, [&](std::size_t pixel) {
          const glm::vec4 c = pixels.Composite(group, pixel);
          for (int k = 0; k < 4; ++k) colors.channel[k][pixel] = c[k];
        });
      }
    });
  }

 private:
  /// Visits a job's groups: visit(group, colours to be filled).
  template <class Visit>
  HWY_INLINE void ForGroups(const Visit& visit) {
    const Rectangle& r = job_.pixels;
    for (int y = 0; y < r.height; y += 4) {
      for (int x = 0; x < r.width; x += 4) {
        GroupColors colors;
        visit(std::size_t((y / 4) * kBlocksAcross + x / 4), colors);
        for (int k = 0; k < 4; ++k)
          for (int row = 0; row < 4; ++row)
            std::memcpy(strip_[k][row] + x, colors.channel[k] + 4 * row, 4 * sizeof(float));
      }
      WriteStrip(y);
    }
    // Streamed stores are weakly ordered: another thread may read the planes next.
    hwy::FlushStream();
  }

  /// Colours beside each other that the whole picture's table has far apart.
  void FetchLocalColors() {
    const std::size_t count = scratch_.triangles.count;
    if (scratch_.colors.size() < count) scratch_.colors = Buffer<glm::vec4>(scratch_.triangles.id.size());
    for (std::size_t t = 0; t < count; ++t) scratch_.colors[t] = colors_.table[scratch_.triangles.id[t]];
  }

  void RunFlat() {
    ForGroups([&](std::size_t group, GroupColors& colors) { CompositeFlat(group, colors); });
  }

  HWY_INLINE void CompositeFlat(std::size_t group, GroupColors& colors) const {
    const DU du;
    const DF df;
    const std::size_t length = scratch_.length(group);
    const auto* table = reinterpret_cast<const float*>(colors_.table);
    NumberColors(group);
    const std::uint32_t* numbers = scratch_.fragments.paint.data();
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(df)) {
      VF left = hn::Set(df, 1.0f), red = hn::Zero(df), green = red, blue = red;
      for (std::size_t s = 0; s < length; ++s) {
        const auto valid = hn::Ne(HalvesOf(scratch_.slot(group, s) + lane).low, hn::Zero(du));
        const LaneColors color = ColorsOf(table, numbers + s * kGroup + lane);
        const VF alpha = hn::Mul(color.alpha, hn::Set(df, colors_.opacity));
        const VF shows = hn::IfThenElseZero(hn::RebindMask(df, valid), alpha);
        const VF weight = hn::Mul(left, shows);
        red = hn::Add(red, hn::Mul(weight, color.red));
        green = hn::Add(green, hn::Mul(weight, color.green));
        blue = hn::Add(blue, hn::Mul(weight, color.blue));
        left = hn::Mul(left, hn::Sub(hn::Set(df, 1.0f), shows));
      }
      hn::Store(red, df, colors.channel[0] + lane);
      hn::Store(green, df, colors.channel[1] + lane);
      hn::Store(blue, df, colors.channel[2] + lane);
      hn::Store(hn::Sub(hn::Set(df, 1.0f), left), df, colors.channel[3] + lane);
    }
  }

  /// The primitives of a group's slots, 0 where there is none. Written out beforehand: where they are read right away,
  /// g++ takes them out of the vector lane by lane.
  HWY_INLINE void NumberColors(std::size_t group) const {
    const DU d;
    const std::size_t length = scratch_.length(group);
    scratch_.fragments.reserve(length);
    std::uint32_t* numbers = scratch_.fragments.paint.data();
    const std::uint64_t* words = scratch_.slot(group, 0);
    for (std::size_t i = 0; i < length * kGroup; i += hn::Lanes(d)) {
      const VU low = HalvesOf(words + i).low;
      hn::Store(hn::IfThenElseZero(hn::Ne(low, hn::Zero(d)), hn::Not(low)), d, numbers + i);
    }
  }

  /// Whole rows: groups alone would write a quarter of a cache line at a time, each into memory that is not at hand.
  HWY_INLINE void WriteStrip(int y) const {
    const Rectangle& r = job_.pixels;
    float* const planes[4] = {out_.red, out_.green, out_.blue, out_.alpha};
    for (int k = 0; k < 4; ++k)
      for (int row = 0; row < HWY_MIN(4, r.height - y); ++row) {
        const std::size_t at =
            std::size_t(r.y + y + row - out_.y) * std::size_t(out_.width) + std::size_t(r.x - out_.x);
        WriteRow(strip_[k][row], planes[k] + at);
      }
  }

  HWY_INLINE void WriteRow(const float* from, float* to) const {
    const DF d;
    const auto width = std::size_t(job_.pixels.width);
    if (!out_.streams || width % hn::Lanes(d) != 0 || reinterpret_cast<std::uintptr_t>(to) % 64 != 0) {
      std::memcpy(to, from, width * sizeof(float));
      return;
    }
    for (std::size_t x = 0; x < width; x += hn::Lanes(d)) hn::Stream(hn::Load(d, from + x), d, to + x);
  }

  const GatherInput& frame_;
  const GatherJob& job_;
  GatherScratch& scratch_;
  const FragmentColors& colors_;
  const PicturePlanes& out_;
  HWY_ALIGN_MAX float strip_[4][4][kTileSize];  // four rows of each plane
};

void CompositeTile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch, const FragmentColors& colors,
                   const PicturePlanes& out) {
  TileCompositor compositor(frame, job, scratch, colors, out);
  // By count when compiled, so that loops over sub-samples are written out and what shows through has registers.
  switch (frame.pattern.count) {
    case 1: return compositor.Run<1>();
    case 2: return compositor.Run<2>();
    case 4: return compositor.Run<4>();
    case 8: return compositor.Run<8>();
    case 16: return compositor.Run<16>();
    default: return compositor.Run<64>();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::abuffer_detail {

FRONTMOST_KERNELS(CompositeTile);

void composite_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch,
                    const FragmentColors& colors, const PicturePlanes& out) {
  kernel_for(CompositeTileKernels, frame.isa)(frame, job, scratch, colors, out);
}

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
