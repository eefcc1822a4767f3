// SPDX-License-Identifier: Apache-2.0
// Gives fragments to callers that colour them: this folder computes order and coverage, the caller computes colours.
//
//    first   list_primitives(): the triangles that must be prepared for shading
//    then    look() or paint(): lists, tile by tile; paint() takes a colour for each fragment and returns pixels
//
// Every pass gathers tiles anew. Keeping them would take memory for all fragments, and a pixel may have any number of
// fragments.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "abuffer/gather/gather_kernel.h"
#include "frontmost/abuffer.h"

namespace frontmost::abuffer_detail {

/// Says how many copies to keep. Copies are triangles with the same vertices on the screen; at every sample they are in
/// the order of their ids.
struct CopyRule {
  /// Returns whether nothing is seen through the primitive anywhere, so that it hides its copies with higher ids. Empty
  /// if no primitive is opaque.
  std::function<bool(PrimitiveId)> is_opaque;
  std::size_t most = std::size_t(-1);  ///< never keep more copies than this, opaque or not
};

/// Returns how many fragments a pass may have at most, as `most_fragments` says.
[[nodiscard]] std::uint64_t most_gathered_fragments(const View& view, std::uint64_t triangles);

/// The opacity of each primitive: how much of the background its material hides, before any texture. A see-through
/// material may be opaque where its texture says so, but the fragments behind it are kept nevertheless.
class Opacities {
 public:
  Opacities(const Surfaces& surfaces, float opacity, const Execution& execution);

  [[nodiscard]] float of(PrimitiveId id) const { return values_.empty() ? all_ : std::abs(values_[id]); }
  /// Returns the least opacity that the primitive may have, whatever its texture says.
  [[nodiscard]] float least(PrimitiveId id) const { return std::max(values_.empty() ? all_ : values_[id], 0.0f); }
  /// Returns whether nothing is seen through the primitive, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return (values_.empty() ? all_ : values_[id]) >= 1.0f; }

 private:
  float all_;
  std::vector<float> values_;  // empty if all are all_; negated if the material is see-through, because its texture may
                               // let more through
};

/// Returns the rule that keeps coincident triangles up to the first opaque one. Refers to `opacities`.
[[nodiscard]] inline CopyRule copy_rule(const Opacities& opacities) {
  return {[&opacities](PrimitiveId id) { return opacities.is_opaque(id); }};
}

/// A view prepared for gathering and for visits tile by tile.
class PreparedFrame {
 public:
  /// \throws Error for a view or options out of range.
  PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution);

  [[nodiscard]] const SamplePattern& pattern() const { return pattern_; }

  /// Receives a rectangle of the picture and its fragments, or null if nothing is seen in it.
  using Visit = std::function<void(const Rectangle& pixels, GatherScratch* fragments)>;
  /// Returns whether to skip a tile. If the function is empty, no tile is skipped.
  using LeaveOut = std::function<bool(const Rectangle& tile)>;
  /// Calls `visit` for rectangles that make up the picture, in any order, from several threads at once. The rectangles
  /// are the tiles that are not left out. To bound memory, tiles with too many fragments are divided, and lose the
  /// copies that the rule `copies` does not keep. Fragments are in the order of arrival, and holes count as covered.
  void visit_tiles(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;
  /// visit_tiles() with fragments in sorted lists, without their holes.
  void visit_lists(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;

 private:
  SamplePattern pattern_;
  FragmentPlan plan_;
};

/// The fragment lists of one rectangle of pixels.
struct PixelLists {
  std::vector<std::uint32_t> begin;  ///< by pixel of the rectangle, row by row; then the end of the last list
  std::vector<Fragment> fragments;
  std::vector<std::uint32_t> numbers;  ///< number of each fragment in Arrived
  const GatherScratch* scratch = nullptr;

  /// Returns the key of fragment i at a position in 1/256 pixel from the rectangle's corner, exactly as depths are
  /// compared. Valid only until the callback that received the lists returns.
  [[nodiscard]] float key_at(std::size_t i, std::int32_t x, std::int32_t y) const {
    return scratch->triangles.key_at(scratch->arrived.triangle[numbers[i]], x, y);
  }
};

/// The colours of fragments, by their numbers in Arrived.
struct FragmentColors {
  std::vector<glm::vec4> straight;  ///< linear, with straight alpha
  /// Alphas of each channel for tinted fragments, which hide more in one channel than in another. Their mean is the
  /// alpha of `straight`. Negative if the fragment is not tinted; empty if no fragment is tinted.
  std::vector<glm::vec3> alphas;

  void set(std::uint32_t number, const glm::vec3& color, float alpha, const glm::vec3& by_channel) {
    straight[number] = glm::vec4(color, alpha);
    if (by_channel == glm::vec3(alpha)) return;
    if (alphas.empty()) alphas.assign(straight.size(), glm::vec3(-1));
    alphas[number] = by_channel;
  }
  void copy(std::uint32_t from, std::uint32_t to) {
    straight[to] = straight[from];
    if (!alphas.empty()) alphas[to] = alphas[from];
  }
};

/// The pixels of a rectangle, row by row.
struct PaintedPixels {
  std::vector<glm::vec4> colors;  ///< premultiplied; alpha is the mean over the channels
  std::vector<glm::vec3> alphas;  ///< by channel; empty: the same in all channels
};

/// One view, which may be traversed any number of times, in 10 to 20 megabytes a thread for any number of layers.
/// Callbacks are called for one rectangle of pixels after another, in any order, by several threads at once.
class FragmentPass {
 public:
  FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution);
  FragmentPass(const FragmentPass&) = delete;  // the rule of copies refers to opacities_
  FragmentPass& operator=(const FragmentPass&) = delete;

  [[nodiscard]] float opacity() const { return opacity_; }
  /// Positions of the masks' bits in 1/256 pixel.
  [[nodiscard]] std::vector<glm::ivec2> samples() const { return frame_.pattern().positions(); }

  /// Returns whether nothing is seen through the primitive, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return opacities_.is_opaque(id); }

  using LeaveOut = PreparedFrame::LeaveOut;
  /// Receives the primitives of one part of the picture after another: all visible ones, some hidden ones, and some
  /// several times. This is quicker than looking at their fragments.
  using Note = std::function<void(std::span<const PrimitiveId> primitives)>;
  void list_primitives(const Note& note, const LeaveOut& leave_out, const Execution& execution) const;

  /// Receives the lists of a rectangle, without the fragments that lie wholly behind an opaque fragment that covers the
  /// pixel.
  using Look = std::function<void(const Rectangle& pixels, PixelLists lists)>;
  void look(const Look& look, const Execution& execution) const;

  /// Sets the colour with the number lists.numbers[i] for every fragment i. Other colours stay 0: those of hidden
  /// fragments, and those of fragments that add less than 1e-12 of their colour because of the fragments in front of
  /// them.
  using Paint = std::function<void(const Rectangle& pixels, const PixelLists& lists, FragmentColors& colors)>;
  /// Receives the finished pixels of a rectangle, or null if nothing is seen in it.
  using Receive = std::function<void(const Rectangle& pixels, const PaintedPixels* painted)>;
  /// Composites the colours; every alpha is multiplied by the options' opacity.
  void paint(const Paint& paint, const Receive& receive, const LeaveOut& leave_out, const Execution& execution) const;

 private:
  /// Returns the lists without the fragments that lie wholly behind an opaque fragment that covers the whole pixel, or
  /// behind fragments that cover it and together let no more light pass than the share `negligible`.
  [[nodiscard]] PixelLists lists_of(const Rectangle& pixels, const GatherScratch& fragments, float negligible) const;

  float opacity_;
  PreparedFrame frame_;
  Opacities opacities_;
  CopyRule copies_;
};

}  // namespace frontmost::abuffer_detail
