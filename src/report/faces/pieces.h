// SPDX-License-Identifier: Apache-2.0
// What is seen in a small box of the picture, by cutting the box until every piece shows one face.
//
//    .---------.        .----.----.       .--.-.----.
//    |         |  --->  |    |  0 |  -->  |  |1|0|  |     the box, cut by the sides of face 0, and by those of face 1
//    |_________|        |____|____|       |__|_|_|__|     where that is nearer: every place is in one piece
#pragma once

#include <span>
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
  explicit PieceCutter(const FacesOfView& faces) : faces_(faces) {}

  /// Appends what is seen in `box` of `list`, which has all faces that may be seen there, in the order of their nearest
  /// keys, the nearest first.
  void cut(const CellBox& box, std::span<const FaceInBox> list, std::span<const GatheredFace> gathered,
           std::vector<SeenPart>& seen);
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
  void finish(Piece& piece, std::vector<SeenPart>& seen);
  [[nodiscard]] bool lies_behind(const Candidate& face, const Candidate& front, const ConvexPiece& polygon) const;
  template <class Make>
  bool put_aside(std::uint32_t front, std::uint32_t next, const Make& make);
  [[nodiscard]] bool cut_to(const Candidate& face, Piece& piece);
  void choose_nearer(std::uint32_t number, Piece& piece);
  [[nodiscard]] bool is_preferred(const Candidate& face, const Candidate& front, const LineDistances& nearer) const;
  void emit(const ConvexPiece& polygon, const Candidate& face, std::vector<SeenPart>& seen);

  const FacesOfView& faces_;
  std::vector<Candidate> candidates_;
  std::vector<Reach> reaches_;  ///< by candidate
  std::vector<Piece> pieces_;   ///< still to be looked at
};

}  // namespace frontmost::faces_detail
