// SPDX-License-Identifier: Apache-2.0
// What is seen in a small box of the picture, by cutting the box until every piece shows one face.
//
//    .---------.        .----.----.       .--.-.----.
//    |         |  --->  |    |  0 |  -->  |  |1|0|  |     the box, cut by the sides of face 0, and by those of face 1
//    |_________|        |____|____|       |__|_|_|__|     where that is nearer: every place is in one piece
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "report/faces/polygon.h"

namespace frontmost::faces_detail {

/// A face of one of the largest cells; these lie beside each other.
struct GatheredFace {
  ScreenPoint corners[3];
  Range x, y;  ///< of all of the face, also outside of the cell
  std::uint32_t face;
  std::uint8_t ending;
};

/// A face over a box of the picture. Between its nearest and farthest key lie all that it has there.
struct FaceInBox {
  double nearest, farthest;
  std::uint32_t number;  ///< of a gathered face
  bool is_ending;        ///< a surface ends within the box, at one of the face's sides
  bool is_all;           ///< it covers all of the box
};

/// Areas of a part of a face that is seen.
struct SeenPart {
  std::uint32_t face;
  Areas areas;
};

/// What is needed to tell them.
struct FacesOfView {
  const Surfaces& surfaces;
  const ViewedFaces& screen;
  AreaRule rule;
  std::uint64_t most_steps;  ///< of about ten nanoseconds each, before the work is given up
};

/// The key of a face's plane, affine over the screen.
struct AffineKey {
  double x, y, key, along_x, along_y;

  AffineKey(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c);
  [[nodiscard]] double at(const glm::dvec2& p) const { return key + ((p.x - x) * along_x + (p.y - y) * along_y); }
};

/// Cuts boxes, one after the other; keeps its memory.
class PieceCutter {
 public:
  /// `tell(steps)` is called when many steps were taken, of about ten nanoseconds each.
  PieceCutter(const FacesOfView& faces, std::function<void(std::uint64_t)> tell)
      : faces_(faces), tell_(std::move(tell)) {}

  void count(std::uint64_t steps) {
    constexpr std::uint64_t kTold = 1 << 16;
    if ((steps_ += steps) >= kTold) tell_(std::exchange(steps_, 0));
  }
  /// Tells what was not told yet.
  void tell_rest() { tell_(std::exchange(steps_, 0)); }

  /// Appends what is seen in `box` of `list`, which has all faces that may be seen there, in the order of their nearest
  /// keys, the nearest first.
  void cut(const CellBox& box, std::span<const FaceInBox> list, std::span<const GatheredFace> gathered,
           std::vector<SeenPart>& seen);
  /// Looks for the nearest of the faces that cover all of `box`, and brings those that lie behind it there, or in its
  /// plane with a greater id, to the end of `list`. \returns how many are left.
  [[nodiscard]] std::size_t leave_out_covered(const CellBox& box, std::span<FaceInBox> list,
                                              std::span<const GatheredFace> gathered);
  /// Appends what of a face lies within `box`, all of it being seen there.
  void clip(const CellBox& box, std::uint32_t face, std::vector<SeenPart>& seen);

 private:
  struct Candidate {
    std::uint32_t face;
    double farthest;
    std::array<CutLine, 3> sides;  ///< positive within the face
    AffineKey plane;
    double least, most;  ///< keys of its corners
    Range x, y;
    std::uint32_t plane_number;  ///< the same for candidates that are known to lie in one plane
  };
  /// What is asked of a candidate first.
  struct Reach {
    Range x, y;
    double nearest;
  };
  /// What `front` covers of what was looked at so far; the faces from `next` on are still to be asked.
  struct Piece {
    Piece(std::uint32_t in_front, std::uint32_t next_face) : front(in_front), next(next_face) {}
    explicit Piece(const CellBox& box) : polygon(box), around(box), front(no_index), next(0) {}

    ConvexPiece polygon;
    CellBox around;  ///< it
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
  std::uint64_t steps_ = 0;  ///< that were not told yet
  std::vector<Candidate> candidates_;
  std::vector<Reach> reaches_;             ///< by candidate
  std::vector<std::uint32_t> plane_ends_;  ///< by number of plane: behind its last candidate
  std::vector<Piece> pieces_;              ///< still to be looked at
};

}  // namespace frontmost::faces_detail
