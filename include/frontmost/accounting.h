// SPDX-License-Identifier: Apache-2.0
// Accounting of objects: how much of each object is seen, how much of it lies beyond the frame, and who hides the rest.
//
//    canvas  +- - - - - - - - - - - +
//              +-------------+              alone      every sample that the object covers when nothing else is there
//            | |frame   #####|%%%%  |       in frame   those of them within the picture: # and =
//              |   wall=#####|%%%           visible    those that see it: #
//            | |       ======|%%%%  |       hidden     in frame, and not visible: =, by the wall
//              +-------------+              cut        beyond the frame: %
//            + - - - - - - - - - - - +
//
// An object is an instance of the scene. Samples are counted, exactly and without any tolerance: what an object covers
// alone is what zbuffer() would show of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"
#include "frontmost/visible.h"

namespace frontmost {

/// Pixels [x, x + width) x [y, y + height) from the picture's top left; beyond the picture x and y may be negative.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;

  [[nodiscard]] bool is_empty() const { return width == 0; }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Samples, and the least box around their pixels; empty where there are none.
struct SampleSet {
  std::uint64_t count = 0;
  PixelBox box;

  friend bool operator==(const SampleSet&, const SampleSet&) = default;
};

/// One instance in one view. The three shares add up to 1 where the object covers any sample; else all are 0.
struct ObjectAccount {
  SampleSet alone;     ///< on the canvas
  SampleSet in_frame;  ///< of those, within the picture
  SampleSet visible;   ///< of those, where nothing hides it
  /// Planar distance of the nearest visible sample, as depths_of() gives it; +inf where none is visible.
  float distance = std::numeric_limits<float>::infinity();
  /// The mean place of the visible samples on the screen, in pixels from the top left corner; 0 where none is visible.
  glm::dvec2 centroid{0};
  /// It reaches nearer than the near plane, and what is there counts nowhere.
  bool is_cut_by_near = false;

  [[nodiscard]] double visible_share() const { return share(visible.count); }
  [[nodiscard]] double hidden_share() const { return share(in_frame.count - visible.count); }
  [[nodiscard]] double cut_share() const { return share(alone.count - in_frame.count); }

 private:
  [[nodiscard]] double share(std::uint64_t count) const {
    return alone.count == 0 ? 0 : double(count) / double(alone.count);
  }
};

/// Samples of one object that another one hides.
struct HiddenSamples {
  std::uint32_t object = no_index;  ///< the hidden one, an instance
  std::uint32_t hider = no_index;
  std::uint64_t count = 0;  ///< at least 1

  friend bool operator==(const HiddenSamples&, const HiddenSamples&) = default;
};

struct AccountingOptions {
  /// The canvas on which objects are counted alone, as a multiple of the picture's width and height, 1 to 16; the
  /// picture lies in its middle. 1 is the picture itself, so that no object counts as cut. Three, as BOP has it, is
  /// wide enough for whatever is half in the picture and no larger than it. Rounded down to whole pixels on each side,
  /// and never more than 16384 pixels wide or high.
  double canvas = 3;
  /// Also all other pairs: hidden_by_any and hidden_only_by. Some ten times the time, and 20 MiB and more.
  bool all_hiders = false;
};

struct Accounting {
  PixelBox canvas;                     ///< on which objects were counted alone
  std::vector<ObjectAccount> objects;  ///< by instance
  std::uint64_t background = 0;        ///< samples that see nothing; with all that are visible, those of the picture
  /// Samples in frame by the object that is seen there in its place, ordered by object, then by hider. Those of one
  /// object add up to what of it is hidden.
  std::vector<HiddenSamples> hidden_by_front;
  /// In the same order, samples in frame at which the hider covers the object from before, whatever else does. Empty
  /// unless AccountingOptions::all_hiders is set, as is the next one.
  std::vector<HiddenSamples> hidden_by_any;
  /// Samples at which nothing but the hider covers the object: what appears of it when the hider is taken away.
  std::vector<HiddenSamples> hidden_only_by;
};

/// Accounts for every object in a view. `visible` is what zbuffer() or a ZBuffer gave for these surfaces: with answers
/// of other methods, which do not snap, sums hold only nearly. The same for all numbers of threads and instruction
/// sets. O(triangles + rows of pixels that each object touches + samples); beside the result about 8 bytes a run of
/// samples that see the same object, and a bit for each sample of the canvas and thread.
/// \throws Error bad_argument as validate(view) does, for a canvas out of range, and for a `visible` of other surfaces.
[[nodiscard]] Accounting account(const Surfaces& surfaces, const Visible& visible,
                                 const AccountingOptions& options = {}, const Execution& execution = {});

/// Which objects hide which, put in order: what hides something comes before it, wherever that can be.
struct HidingOrder {
  /// By object: 0 where nothing hides it, else one more than the greatest of those that hide it; those of a cycle have
  /// one rank.
  std::vector<std::uint32_t> ranks;
  /// Objects of which each hides the next and the last the first, all that hang together so in one list, ascending;
  /// lists by their first object. Objects without a list have an order among them.
  std::vector<std::vector<std::uint32_t>> cycles;
};

/// The order of `object_count` objects by their pairs, such as Accounting::hidden_by_front. O(objects + pairs * log).
/// Source: R. Tarjan. Depth-First Search and Linear Graph Algorithms. 1972.
/// \throws Error bad_argument where a pair is not of two different objects below `object_count`.
[[nodiscard]] HidingOrder find_hiding_order(std::size_t object_count, std::span<const HiddenSamples> pairs);

// Masks of objects, as pixels, run lengths and polygons.

enum class MaskPixel : std::uint8_t { outside, hidden, visible };

/// What one object covers of a picture, by the first sample of each pixel.
struct PixelMask {
  PixelBox box;              ///< the least one around what is not outside
  Buffer<MaskPixel> pixels;  ///< of the box, rows from the top

  /// Of a pixel of the picture.
  [[nodiscard]] MaskPixel at(int x, int y) const {
    x -= box.x, y -= box.y;
    if (x < 0 || y < 0 || x >= box.width || y >= box.height) return MaskPixel::outside;
    return pixels[std::size_t(y) * std::size_t(box.width) + std::size_t(x)];
  }
};

/// Which pixels of a mask are meant: those that are visible, or these and those that are hidden.
enum class MaskPart : std::uint8_t { visible, whole };

/// COCO's compressed run lengths of a mask in a picture of `size`: columns from the left, each from the top, runs of 0
/// and 1 in turn, as its mask API writes them. O(pixels of the box).
/// Source: T.-Y. Lin et al. Microsoft COCO: Common Objects in Context. 2014.
[[nodiscard]] std::string coco_runs(const PixelMask& mask, MaskPart part, const glm::ivec2& size);
/// Polygons along the sides of pixels, x and y in turn, in pixels from the picture's top left. They do not overlap,
/// have no holes, and fill the mask exactly, also by the rule of COCO's mask API. O(pixels of the box).
[[nodiscard]] std::vector<std::vector<int>> coco_polygons(const PixelMask& mask, MaskPart part);

/// The masks of one object after another. Borrows what it is made of; not for several threads at once.
class PixelMasks {
 public:
  /// `visible` is what zbuffer() or a ZBuffer gave for these surfaces. O(samples); a bit for each sample of the
  /// picture. \throws Error bad_argument as account() does.
  PixelMasks(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});
  ~PixelMasks();
  PixelMasks(const PixelMasks&) = delete;
  PixelMasks& operator=(const PixelMasks&) = delete;

  /// With one sample a pixel it has as many pixels visible and hidden as account() counts. O(triangles of the object +
  /// pixels of its box). Precondition: an instance of the scene.
  [[nodiscard]] PixelMask of(std::uint32_t object);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace frontmost
