// SPDX-License-Identifier: Apache-2.0
// Why an object is seen, or is not: one reason, its numbers, what to change, and all of it as a sentence.
//
//                       far -+---------------------+-         Every triangle is somewhere, and is counted once:
//             left            \   beyond far      /           at the first reason of the list that holds for all of
//       .-.                    \                 /            it. An object has the last reason that any of its
//       '-' outside             \    in view    /             triangles has: it was kept from being seen there.
//                                \    .-.      /              What is in view may still be turned away, transparent,
//                        near -   +---'-'-----+   -           between the samples, or hidden.
//                                  \ nearer  /
//                                   \       /
//             - - - - - - - - - - - - eye  - - - - - - - -
//                      behind the eye
//
// Samples have the last word: an object that one of them sees is seen, whatever doubles make of its triangles.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "frontmost/accounting.h"

namespace frontmost {

/// In the order in which reasons are asked for.
enum class SightReason : std::uint8_t {
  empty,             ///< no triangle with finite corners has an area
  behind_eye,        ///< in perspective: everything else lies behind the eye, or beside it
  nearer_than_near,  ///< before the near plane
  beyond_far,        ///< behind the far plane
  outside,           ///< between near and far, but beside the picture
  faces_away,        ///< in the picture, but View::culling leaves those sides out
  transparent,       ///< its opacity is 0, or every sample of it is a hole
  no_sample,         ///< in the picture, but it covers no sample
  hidden,            ///< other objects are before it at every sample that it covers
  seen,
};
/// \returns "empty", "behind_eye", ...
[[nodiscard]] std::string_view name(SightReason reason);

/// How many triangles of an object are where; each is counted once, at the first that holds for all of it.
struct TrianglePlaces {
  std::uint64_t empty = 0;  ///< a corner is not finite, or its area is 0
  std::uint64_t behind_eye = 0, nearer_than_near = 0, beyond_far = 0;
  // What of it lies between near and far is outside on one side of the picture, or past one of its corners.
  std::uint64_t left = 0, right = 0, above = 0, below = 0, past_corner = 0;
  std::uint64_t faces_away = 0;
  std::uint64_t in_view = 0;  ///< in part, at least

  [[nodiscard]] std::uint64_t outside() const { return left + right + above + below + past_corner; }
  [[nodiscard]] std::uint64_t total() const {
    return empty + behind_eye + nearer_than_near + beyond_far + outside() + faces_away + in_view;
  }
  friend bool operator==(const TrianglePlaces&, const TrianglePlaces&) = default;
};

/// What to change.
enum class RemedyKind : std::uint8_t {
  none,
  set_near,         ///< to Remedy::value
  set_far,          ///< likewise
  turn,             ///< the camera: about its up axis, then up about what is then its right axis
  move,             ///< the camera, in parallel projection: along its right and up axes
  show_both_sides,  ///< View::culling
  make_opaque,      ///< the object's materials: alpha mode and transmission
  enlarge,          ///< the picture, to Remedy::value times the pixels each way
  take_away,        ///< the objects of Remedy::objects, all of them
};
/// \returns "none", "set_near", ...
[[nodiscard]] std::string_view name(RemedyKind kind);

/// Numbers are round ones, those of the sentence. What was in the way of the object is so no longer when it is done;
/// what comes later in the list of reasons may be then, and has its own remedy.
struct Remedy {
  RemedyKind kind = RemedyKind::none;
  double value = 0;
  /// Of `turn` in radians, of `move` in scene units: to the right and upwards where positive.
  double right = 0, up = 0;
  /// By number. Of all that are before the object in one place, so that it is seen there without them: the place where
  /// they are fewest, among four that are spread over the object.
  std::vector<std::uint32_t> objects;
};

/// Who hides a part of an object.
struct HiderShare {
  std::uint32_t object = no_index;
  double share = 0;  ///< of what of the hidden object is in frame; more than 0
};

/// Of one object in one view.
struct Explanation {
  std::uint32_t object = no_index;  ///< an instance
  SightReason reason = SightReason::empty;
  TrianglePlaces triangles;
  /// Where no sample is covered: the area in the picture of what would be seen of it alone, in square pixels, exact as
  /// visible_faces() is; 0 of what is seen edge on.
  double pixels = 0;
  bool is_all_holes = false;  ///< where it is transparent: by the holes of its materials, not by its opacity
  double visible_share = 0, hidden_share = 0, cut_share = 0;  ///< as ObjectAccount has them
  std::vector<HiderShare> hiders;                             ///< front-most, the greatest share first
  Remedy remedy;
};

/// Explains every object, by number. `visible` is what zbuffer() gave for these surfaces, `accounts` what account()
/// gave for it. The same for all numbers of threads and instruction sets. O(triangles), one to seven times the time of
/// account(), and that of visible_faces() for each object that covers no sample. \throws Error as account() does, and
/// bad_argument for accounts of other objects.
[[nodiscard]] std::vector<Explanation> explain_all(const Surfaces& surfaces, const Visible& visible,
                                                   const Accounting& accounts, const Execution& execution = {});
/// Explains one object. The time of zbuffer() and account(). \throws Error as validate(view) does, and bad_argument for
/// an object that does not exist.
[[nodiscard]] Explanation explain(const Surfaces& surfaces, const View& view, std::uint32_t object,
                                  const Execution& execution = {});

/// The view, changed as a remedy says; as it is for remedies that change the scene. \throws Error as validate(view)
/// does for a picture that becomes too large.
[[nodiscard]] View remedied(const View& view, const Remedy& remedy);

/// How texts call the objects of a scene: "bolt"; "bolt #13" where several have that name; "object 13" where it has
/// none. What does not print is written as printable_text() does.
class ObjectNames {
 public:
  /// Keeps a reference. Texts make these names by themselves from a scene; whoever writes many keeps them. O(objects).
  ObjectNames(const Scene& scene);
  [[nodiscard]] std::string operator[](std::uint32_t object) const;

 private:
  const Scene* scene_;
  std::vector<bool> is_shared_;  ///< by object: another has its name
};

/// What the object is: "hidden by wall 63 % and lamp 37 %". Shares are rounded to whole percents.
[[nodiscard]] std::string reason_text(const Explanation& explanation, const ObjectNames& names);
/// What to do: "take wall and lamp away"; nothing where there is no remedy.
[[nodiscard]] std::string remedy_text(const Explanation& explanation, const ObjectNames& names);
/// Both: "crate is hidden by wall 63 % and lamp 37 %: take wall and lamp away."
[[nodiscard]] std::string sentence(const Explanation& explanation, const ObjectNames& names);

}  // namespace frontmost
