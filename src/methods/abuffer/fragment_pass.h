// SPDX-License-Identifier: Apache-2.0
// Fragments for callers that colour them: this folder computes their order and coverage, the caller their colours.
//
//    first   list_primitives(): the triangles that must be prepared for shading
//    then    look() or paint(): lists, tile by tile; paint() takes a colour for each fragment and returns pixels
//
// Every pass gathers tiles anew: keeping them would take as much memory as there are fragments, and a pixel may have
// any number of fragments.
#pragma once

#include <functional>

#include "abuffer/prepared_frame.h"

namespace frontmost::abuffer_detail {

/// The fragment lists of one rectangle of pixels.
struct PixelLists {
  std::vector<std::uint32_t> begin;  ///< by pixel of the rectangle, row by row; then the end of the last list
  std::vector<Fragment> fragments;
  std::vector<std::uint32_t> numbers;  ///< of each fragment in Arrived
  const GatherScratch* scratch = nullptr;

  /// The key of fragment i at a place in 1/256 pixel from the rectangle's corner, exactly as compared. Valid only until
  /// the callback that was given the lists returns.
  [[nodiscard]] float key_at(std::size_t i, std::int32_t x, std::int32_t y) const {
    return scratch->triangles.key_at(scratch->arrived.triangle[numbers[i]], x, y);
  }
};

/// The colours of fragments, by their numbers in Arrived.
struct FragmentColors {
  std::vector<glm::vec4> straight;  ///< linear, with straight alpha
  /// Alphas by channel, whose mean is the alpha of `straight`: a tinted fragment hides more in one channel than in
  /// another. Negative: the same in all channels. Empty: the same for all fragments.
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

  /// Whether nothing is seen through the primitive, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return opacities_.is_opaque(id); }

  using LeaveOut = PreparedFrame::LeaveOut;
  /// The primitives in one part of the picture after another: all visible ones, some hidden ones, some several times.
  /// Quicker than looking at their fragments.
  using Note = std::function<void(std::span<const PrimitiveId> primitives)>;
  void list_primitives(const Note& note, const LeaveOut& leave_out, const Execution& execution) const;

  /// Takes the lists without fragments that lie wholly behind opaque fragments covering the whole pixel.
  using Look = std::function<void(const Rectangle& pixels, PixelLists lists)>;
  void look(const Look& look, const Execution& execution) const;

  /// Sets the colour of number lists.numbers[i] for every fragment i. All other colours are 0: hidden fragments, and
  /// fragments that add less than 1e-12 of themselves to their pixel because of fragments before them.
  using Paint = std::function<void(const Rectangle& pixels, const PixelLists& lists, FragmentColors& colors)>;
  /// Takes the finished pixels of the rectangle; null if nothing is seen.
  using Receive = std::function<void(const Rectangle& pixels, const PaintedPixels* painted)>;
  /// Composites the colours; every alpha is multiplied by the options' opacity.
  void paint(const Paint& paint, const Receive& receive, const LeaveOut& leave_out, const Execution& execution) const;

 private:
  /// Leaves out fragments wholly behind opaque fragments that cover the whole pixel, or behind fragments that cover it
  /// and together let no more pass than `negligible`.
  [[nodiscard]] PixelLists lists_of(const Rectangle& pixels, const GatherScratch& fragments, float negligible) const;

  float opacity_;
  PreparedFrame frame_;
  Opacities opacities_;
  CopyRule copies_;
};

}  // namespace frontmost::abuffer_detail
