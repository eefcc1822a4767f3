// SPDX-License-Identifier: Apache-2.0
// Fragments for those who give them colours: the order and the coverage are this room's, the colours are not.
//
//    first   list_primitives(): which triangles have to be prepared for shading
//    then    look() or paint(): lists, tile by tile; paint() takes a colour for each fragment and gives pixels back
//
// Tiles are gathered anew in every pass: keeping them would take as much memory as there are fragments, of which a
// pixel may have any number.
#pragma once

#include <functional>

#include "abuffer/prepared_frame.h"

namespace frontmost::abuffer_detail {

/// The lists of one rectangle of pixels.
struct PixelLists {
  std::vector<std::uint32_t> begin;  ///< by pixel of the rectangle, row by row; and the end of the last
  std::vector<Fragment> fragments;
  std::vector<std::uint32_t> numbers;  ///< of each fragment in Arrived
  const GatherScratch* scratch = nullptr;

  /// The key of fragment i at a place in 1/256 pixel from the rectangle's corner, exactly as it is compared. Only until
  /// the callback that was given the lists returns.
  [[nodiscard]] float key_at(std::size_t i, std::int32_t x, std::int32_t y) const {
    return scratch->triangles.key_at(scratch->arrived.triangle[numbers[i]], x, y);
  }
};

/// The colours of fragments, by their numbers in Arrived.
struct FragmentColors {
  std::vector<glm::vec4> straight;  ///< linear, with straight alpha
  /// Alphas by channel, of which that of `straight` is the mean: what is tinted hides more in one than in another.
  /// Negative: the same in all. Empty: so are all.
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
  std::vector<glm::vec3> alphas;  ///< by channel; empty: the same in all
};

/// One view, gone through as often as wanted, in 10 to 20 megabytes a thread however many layers there are. Callbacks
/// are called for one rectangle of pixels after another, in any order, by several threads at once.
class FragmentPass {
 public:
  FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution);
  FragmentPass(const FragmentPass&) = delete;  // the rule of copies refers to its opacities
  FragmentPass& operator=(const FragmentPass&) = delete;

  [[nodiscard]] float opacity() const { return opacity_; }
  /// Positions of the masks' bits in 1/256 pixel.
  [[nodiscard]] std::vector<glm::ivec2> samples() const { return frame_.pattern().positions(); }

  /// Nothing is seen through it, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return opacities_.is_opaque(id); }

  using LeaveOut = PreparedFrame::LeaveOut;
  /// The primitives in one part of the picture after another: all that are seen, some hidden ones, some several times.
  /// Quicker than looking at their fragments.
  using Note = std::function<void(std::span<const PrimitiveId> primitives)>;
  void list_primitives(const Note& note, const LeaveOut& leave_out, const Execution& execution) const;

  /// Takes the lists without what lies wholly behind opaque fragments that cover the whole pixel.
  using Look = std::function<void(const Rectangle& pixels, PixelLists lists)>;
  void look(const Look& look, const Execution& execution) const;

  /// Sets the colours of number lists.numbers[i] for every fragment i. The rest is 0: what is hidden, and what adds
  /// less than 1e-12 of itself to its pixel because of what is before it.
  using Paint = std::function<void(const Rectangle& pixels, const PixelLists& lists, FragmentColors& colors)>;
  /// Takes the finished pixels of the rectangle; null where nothing is seen.
  using Receive = std::function<void(const Rectangle& pixels, const PaintedPixels* painted)>;
  /// Lays the colours over each other, every alpha multiplied by the options' opacity.
  void paint(const Paint& paint, const Receive& receive, const LeaveOut& leave_out, const Execution& execution) const;

 private:
  /// Leaves out what lies wholly behind opaque fragments that cover the whole pixel; and what lies wholly behind
  /// fragments that cover it and together let no more pass than `negligible`.
  [[nodiscard]] PixelLists lists_of(const Rectangle& pixels, const GatherScratch& fragments, float negligible) const;

  float opacity_;
  PreparedFrame frame_;
  Opacities opacities_;
  CopyRule copies_;
};

}  // namespace frontmost::abuffer_detail
