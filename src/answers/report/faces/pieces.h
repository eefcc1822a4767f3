// SPDX-License-Identifier: Apache-2.0
// Visible faces in a small box of the picture: the box is cut until every piece shows one face.
//
//    .---------.        .----.----.       .--.-.----.
//    |         |  --->  |    |  0 |  -->  |  |1|0|  |     The box is cut by the sides of face 0, then by those of
//    |_________|        |____|____|       |__|_|_|__|     face 1 where it is nearer. Pieces do not overlap.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "report/faces/polygon.h"

namespace frontmost::faces_detail {

/// A face of one of the largest cells. Such faces lie side by side in memory.
struct GatheredFace {
  ScreenPoint corners[3];
  Range x, y;  ///< of the whole face, also outside the cell
  std::uint32_t face;
  std::uint8_t ending;
};

/// A face over a box of the picture. All its keys there lie between the farthest and the nearest one.
struct FaceInBox {
  double nearest, farthest;
  std::uint32_t number;  ///< index of a gathered face
  bool is_ending;        ///< a surface ends at a side of the face within the box
  bool is_all;           ///< the face covers the whole box
};

/// The areas of a visible part of a face.
struct SeenPart {
  std::uint32_t face;
  Areas areas;
};

/// The faces of a view and the rules for their areas.
struct FacesOfView {
  const Surfaces& surfaces;
  const ViewedFaces& screen;
  AreaRule rule;
  std::uint64_t most_steps;  ///< limit of steps, each about ten nanoseconds
};

/// The key of a face's plane, an affine function over the screen.
struct AffineKey {
  double x, y, key, along_x, along_y;

  AffineKey(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c);
  [[nodiscard]] double at(const glm::dvec2& p) const { return key + ((p.x - x) * along_x + (p.y - y) * along_y); }
};

/// Cuts one box after another and keeps its memory.
class PieceCutter {
 public:
  /// Calls `tell(steps)` after many steps of about ten nanoseconds each.
  PieceCutter(const FacesOfView& faces, std::function<void(std::uint64_t)> tell)
      : faces_(faces), tell_(std::move(tell)) {}

  void count(std::uint64_t steps) {
    constexpr std::uint64_t kTold = 1 << 16;
    if ((steps_ += steps) >= kTold) tell_(std::exchange(steps_, 0));
  }
  /// Reports the remaining steps.
  void tell_rest() { tell_(std::exchange(steps_, 0)); }

  /// Appends the visible parts in `box`. `list` has all faces that may be seen there, ordered by their nearest keys,
  /// the nearest first.
  void cut(const CellBox& box, std::span<const FaceInBox> list, std::span<const GatheredFace> gathered,
           std::vector<SeenPart>& seen);
  /// Finds the nearest face that covers all of `box`. Moves faces that lie behind it there, or in its plane with a
  /// greater id, to the end of `list`. \returns how many are left.
  [[nodiscard]] std::size_t leave_out_covered(const CellBox& box, std::span<FaceInBox> list,
                                              std::span<const GatheredFace> gathered);
  /// Appends the part of a face within `box`. Precondition: all of that part is seen.
  void clip(const CellBox& box, std::uint32_t face, std::vector<SeenPart>& seen);

 private:
  struct Candidate {
    std::uint32_t face;
    double farthest;
    std::array<CutLine, 3> sides;  ///< positive inside the face
    AffineKey plane;
    double least, most;  ///< keys of its corners
    Range x, y;
    std::uint32_t plane_number;  ///< equal for candidates that are known to lie in one plane
  };
  /// The bounds of a candidate, checked first.
  struct Reach {
    Range x, y;
    double nearest;
  };
  /// A piece of the box. `front` is the nearest of the faces examined so far; faces from `next` on are still to be
  /// examined.
  struct Piece {
    Piece(std::uint32_t in_front, std::uint32_t next_face) : front(in_front), next(next_face) {}
    explicit Piece(const CellBox& box) : polygon(box), around(box), front(no_index), next(0) {}

    ConvexPiece polygon;
    CellBox around;  ///< bounding box of the polygon
    std::uint32_t front, next;
  };

  [[nodiscard]] static Candidate candidate(std::uint32_t face, const ScreenPoint* corners, double farthest);
  void order_by_planes(const CellBox& box);
  void finish(Piece& piece, std::vector<SeenPart>& seen);
  [[nodiscard]] bool lies_behind(const Candidate& face, const Candidate& front, const ConvexPiece& polygon) const;
  template <class Make>
  bool put_aside(std::uint32_t front, std::uint32_t next, const Make& make);
  [[nodiscard]] bool cut_to(const Candidate& face, Piece& piece);
  void choose_nearer(std::uint32_t number, Piece& piece);
  [[nodiscard]] bool is_preferred(const Candidate& face, const Candidate& front, const LineDistances& nearer);
  void emit(const ConvexPiece& polygon, const Candidate& face, std::vector<SeenPart>& seen);

  const FacesOfView& faces_;
  std::function<void(std::uint64_t)> tell_;
  std::uint64_t steps_ = 0;  ///< not yet reported
  std::vector<Candidate> candidates_;
  std::vector<Reach> reaches_;             ///< by candidate
  std::vector<std::uint32_t> plane_ends_;  ///< by plane number: end of its candidates
  std::vector<Piece> pieces_;              ///< still to be examined
};

}  // namespace frontmost::faces_detail
