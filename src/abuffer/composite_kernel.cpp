// SPDX-License-Identifier: Apache-2.0
// Compositing sorted lists, nearest first: what shows through is multiplied down, so nothing is ever re-read.
//
// T. Porter, T. Duff. Compositing Digital Images. 1984 (over); L. Carpenter. The A-buffer. 1984.
//
// The sixteen pixels of a group are composited at once. Those in which fragments change places are then taken again one
// by one.

#include "abuffer/composite_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/composite_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After Highway: a block of its own.
#include "abuffer/conflicts-inl.h"
#include "abuffer/fragment_sink-inl.h"
#include "abuffer/group_composite-inl.h"
#include "abuffer/pixel_composite-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class TileCompositor {
 public:
  TileCompositor(const FrameInput& frame, const TileJob& job, TileScratch& scratch, const FragmentColors& colors,
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
  HWY_INLINE void ForGroups(const Visit& visit) const {
    const Rectangle& r = job_.pixels;
    for (int y = 0; y < r.height; y += 4)
      for (int x = 0; x < r.width; x += 4) {
        GroupColors colors;
        visit(std::size_t((y / 4) * kBlocksAcross + x / 4), colors);
        WriteGroup(x, y, colors);
      }
  }

  /// Colours beside each other that the whole picture's table has far apart.
  void FetchLocalColors() {
    const std::size_t count = scratch_.triangles.count;
    if (scratch_.colors.size() < count) scratch_.colors = Buffer<glm::vec4>(scratch_.triangles.id.size());
    for (std::size_t t = 0; t < count; ++t) scratch_.colors[t] = colors_.table[scratch_.triangles.id[t]];
  }

  void RunFlat() const {
    ForGroups([&](std::size_t group, GroupColors& colors) { CompositeFlat(group, colors); });
  }

  HWY_INLINE void CompositeFlat(std::size_t group, GroupColors& colors) const {
    const DI d;
    const DU du;
    const DF df;
    const std::size_t length = scratch_.length(group);
    const auto* table = reinterpret_cast<const float*>(colors_.table);
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
      VF left = hn::Set(df, 1.0f), red = hn::Zero(df), green = red, blue = red;
      for (std::size_t s = 0; s < length; ++s) {
        const VU low = HalvesOf(scratch_.slot(group, s) + lane).low;
        const auto valid = hn::Ne(low, hn::Zero(du));
        const VI index = hn::ShiftLeft<2>(hn::BitCast(d, hn::IfThenElseZero(valid, hn::Not(low))));
        const VF alpha = hn::Mul(hn::GatherIndex(df, table + 3, index), hn::Set(df, colors_.opacity));
        const VF shows = hn::IfThenElseZero(hn::RebindMask(df, valid), alpha);
        const VF weight = hn::Mul(left, shows);
        red = hn::Add(red, hn::Mul(weight, hn::GatherIndex(df, table, index)));
        green = hn::Add(green, hn::Mul(weight, hn::GatherIndex(df, table + 1, index)));
        blue = hn::Add(blue, hn::Mul(weight, hn::GatherIndex(df, table + 2, index)));
        left = hn::Mul(left, hn::Sub(hn::Set(df, 1.0f), shows));
      }
      hn::Store(red, df, colors.channel[0] + lane);
      hn::Store(green, df, colors.channel[1] + lane);
      hn::Store(blue, df, colors.channel[2] + lane);
      hn::Store(hn::Sub(hn::Set(df, 1.0f), left), df, colors.channel[3] + lane);
    }
  }

  HWY_INLINE void WriteGroup(int x, int y, const GroupColors& colors) const {
    const Rectangle& r = job_.pixels;
    const int width = HWY_MIN(4, r.width - x), height = HWY_MIN(4, r.height - y);
    float* const planes[4] = {out_.red, out_.green, out_.blue, out_.alpha};
    for (int k = 0; k < 4; ++k)
      for (int row = 0; row < height; ++row) {
        float* to =
            planes[k] + std::size_t(r.y + y + row - out_.y) * std::size_t(out_.width) + std::size_t(r.x + x - out_.x);
        const float* from = colors.channel[k] + 4 * row;
        if (width == 4)
          std::memcpy(to, from, 4 * sizeof(float));
        else
          std::copy_n(from, width, to);
      }
  }

  const FrameInput& frame_;
  const TileJob& job_;
  TileScratch& scratch_;
  const FragmentColors& colors_;
  const PicturePlanes& out_;
};

void CompositeTile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, const FragmentColors& colors,
                   const PicturePlanes& out) {
  TileCompositor compositor(frame, job, scratch, colors, out);
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

void composite_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, const FragmentColors& colors,
                    const PicturePlanes& out) {
  kernel_for(CompositeTileKernels, frame.isa)(frame, job, scratch, colors, out);
}

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
