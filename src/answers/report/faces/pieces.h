// SPDX-License-Identifier: Apache-2.0
// Visible faces in a small box of the picture: the box is cut until every piece shows one face.
//
//    .---------.        .----.----.       .--.-.----.
//    |         |  --->  |    |  0 |  -->  |  |1|0|  |     The box is cut by the sides of face 0, then by those of
//    |_________|        |____|____|       |__|_|_|__|     face 1 where it is nearer. Pieces do not overlap.
#pragma once

#include <functional>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "report/exact_depth.h"
#include "report/faces/polygon.h"

namespace frontmost::faces_detail {

/// A face that meets one of the largest cells. The gathered faces of a cell lie side by side in memory.
struct GatheredFace {
  ScreenPoint corners[3];
  Range x, y;  ///< extent of the whole face, also outside the cell
  std::uint32_t face;
  std::uint8_t ending;
};

/// A face over a box of the picture. The keys of the face within the box lie between `farthest` and `nearest`.
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

/// The faces of a view and the rule for their areas.
struct FacesOfView {
  const Surfaces& surfaces;
  const ViewedFaces& screen;
  AreaRule rule;
};

/// The key of a face's plane, an affine function over the screen.
struct AffineKey {
  double x, y, key, along_x, along_y;

  AffineKey(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) : x(a.x), y(a.y), key(a.key) {
    const double scale = 1 / turn_of(a, b, c), to_b = b.key - a.key, to_c = c.key - a.key;
    along_x = (to_b * (c.y - a.y) - to_c * (b.y - a.y)) * scale;
    along_y = (to_c * (b.x - a.x) - to_b * (c.x - a.x)) * scale;
  }
  [[nodiscard]] double at(const glm::dvec2& p) const { return key + ((p.x - x) * along_x + (p.y - y) * along_y); }
};

/// Finds the visible parts in one box after another, and reuses its memory.
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
           std::vector<SeenPart>& seen) {
    candidates_.clear();
    reaches_.clear();
    for (const FaceInBox& face : list) {
      const GatheredFace& found = gathered[face.number];
      candidates_.push_back(candidate(found.face, found.corners, face.farthest));
      candidates_.back().plane_number = std::uint32_t(reaches_.size());
      reaches_.push_back({found.x, found.y, face.nearest});
    }
    if (candidates_.size() > kManyToCut) order_by_planes(box);
    pieces_.emplace_back(box);
    while (!pieces_.empty()) {
      Piece piece = pieces_.back();
      pieces_.pop_back();
      finish(piece, seen);
    }
  }

  /// Finds the nearest face that covers all of `box`. Moves the faces that lie behind it in the box, and those in its
  /// plane with a greater id, to the end of `list`. \returns the number of faces before them.
  [[nodiscard]] std::size_t leave_out_covered(const CellBox& box, std::span<FaceInBox> list,
                                              std::span<const GatheredFace> gathered) {
    const ConvexPiece corners(box);
    const glm::dvec2 middle(0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom));
    const auto plane_of = [&](std::uint32_t number) {
      const ScreenPoint* const p = gathered[number].corners;
      return AffineKey(p[0], p[1], p[2]);
    };
    const auto id_of = [&](std::uint32_t number) { return faces_.screen.faces[gathered[number].face].id; };
    std::uint32_t cover = no_index;
    double nearest = -std::numeric_limits<double>::infinity();
    for (const FaceInBox& face : list) {
      if (!face.is_all) continue;
      const double key = plane_of(face.number).at(middle), narrow = kAlike * std::abs(key);
      if (cover != no_index && !(key > nearest + narrow) &&
          !(key >= nearest - narrow && id_of(face.number) < id_of(cover)))
        continue;
      nearest = key;
      cover = face.number;
    }
    count(kStepsOfCut * list.size());
    if (cover == no_index) return list.size();
    const AffineKey front = plane_of(cover);
    const PrimitiveId id = id_of(cover);
    const auto cover_corners = faces_.surfaces.corners(id);
    const auto is_hidden = [&](const FaceInBox& face) {
      if (face.number == cover) return false;
      const AffineKey plane = plane_of(face.number);
      bool is_behind = true, is_alike = id_of(face.number) > id;
      for (const glm::dvec2& p : corners) {
        const double key = front.at(p), before = plane.at(p) - key, narrow = kAlike * std::abs(key);
        is_behind = is_behind && before < -narrow;
        is_alike = is_alike && std::abs(before) <= narrow;
      }
      if (is_alike) count(kStepsOfPlane);
      return is_behind || (is_alike && lie_in_one_plane(cover_corners, faces_.surfaces.corners(id_of(face.number))));
    };
    const auto end = std::stable_partition(list.begin(), list.end(), [&](const FaceInBox& f) { return !is_hidden(f); });
    return std::size_t(end - list.begin());
  }

  /// Appends the part of a face within `box`. Precondition: all of that part is seen.
  void clip(const CellBox& box, std::uint32_t face, std::vector<SeenPart>& seen) {
    const ViewedFace& f = faces_.screen.faces[face];
    const auto& points = faces_.screen.points;
    const ScreenPoint corners[3] = {points[f.corners[0]], points[f.corners[1]], points[f.corners[2]]};
    const Candidate whole = candidate(face, corners, 0);
    Piece piece(box);
    if (cut_to(whole, piece)) emit(piece.polygon, whole, seen);
    pieces_.clear();
  }

 private:
  /// Keys that differ by at most this share may be equal; doubles are exact to about 2^-45.
  static constexpr double kAlike = 1.0 / (1ll << 36);
  /// More faces than this are reordered before they are cut. Finding the order takes time, and pays if most faces
  /// overlap.
  static constexpr std::size_t kManyToCut = 128;

  /// Costs in steps of about ten nanoseconds: of examining a face for a piece; of cutting by a face or comparing two
  /// faces; of testing by exact signs whether a face lies in a plane; and of keeping a visible part.
  static constexpr std::uint64_t kStepsOfLook = 1, kStepsOfCut = 8, kStepsOfPlane = 32, kStepsOfPart = 64;

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

  static CellBox box_of(const ConvexPiece& polygon) {
    const glm::dvec2& first = *polygon.begin();
    CellBox box{first.x, first.y, first.x, first.y};
    for (const glm::dvec2& p : polygon)
      box = {std::min(box.left, p.x), std::min(box.top, p.y), std::max(box.right, p.x), std::max(box.bottom, p.y)};
    return box;
  }

  static CutLine side_of(const ScreenPoint& from, const ScreenPoint& to, double inwards) {
    const double x = to.x - from.x, y = to.y - from.y, scale = inwards / std::sqrt(x * x + y * y);
    const double a = -y * scale, b = x * scale;
    return {a, b, -(a * from.x + b * from.y)};
  }

  static Candidate candidate(std::uint32_t face, const ScreenPoint* corners, double farthest) {
    const ScreenPoint &a = corners[0], &b = corners[1], &c = corners[2];
    const double inwards = turn_of(a, b, c) > 0 ? 1 : -1;
    const Range key = range_of(a.key, b.key, c.key);
    return {face,
            farthest,
            {side_of(a, b, inwards), side_of(b, c, inwards), side_of(c, a, inwards)},
            AffineKey(a, b, c),
            key.low,
            key.high,
            range_of(a.x, b.x, c.x),
            range_of(a.y, b.y, c.y),
            no_index};
  }

  /// Measures all keys relative to the plane of the first face, and reorders the faces. In a box of slanted surfaces,
  /// the keys of one surface differ much more from end to end than those of close surfaces from each other. Faces in
  /// one plane are ordered by id, so that each hides those after it.
  void order_by_planes(const CellBox& box) {
    count(kStepsOfPlane * candidates_.size());
    const AffineKey first = candidates_.front().plane;
    const ConvexPiece corners(box);
    struct Ordered {
      double nearest;
      std::uint32_t number, plane;
      PrimitiveId id;
    };
    std::vector<Ordered> order;
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
      double nearest = -std::numeric_limits<double>::infinity(), farthest = -nearest;
      for (const glm::dvec2& p : corners) {
        const double key = candidates_[i].plane.at(p), origin = first.at(p);
        const double narrow = kAlike * std::max(std::abs(key), std::abs(origin));
        nearest = std::max(nearest, key - origin + narrow);
        farthest = std::min(farthest, key - origin - narrow);
      }
      candidates_[i].farthest = farthest;
      order.push_back({nearest, i, 0, faces_.screen.faces[candidates_[i].face].id});
    }
    std::sort(order.begin(), order.end(), [](const Ordered& a, const Ordered& b) {
      return a.nearest != b.nearest ? a.nearest > b.nearest : a.number < b.number;
    });
    plane_ends_.clear();
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      if (i == 0 || !lie_in_one_plane(faces_.surfaces.corners(order[i - 1].id), faces_.surfaces.corners(order[i].id)))
        plane_ends_.push_back(i);
      else
        order[i].nearest = order[i - 1].nearest;
      order[i].plane = std::uint32_t(plane_ends_.size() - 1);
      plane_ends_.back() = i + 1;
    }
    std::sort(order.begin(), order.end(), [](const Ordered& a, const Ordered& b) {
      return a.plane != b.plane ? a.plane < b.plane : a.id != b.id ? a.id < b.id : a.number < b.number;
    });
    const std::vector<Candidate> candidates = std::exchange(candidates_, {});
    const std::vector<Reach> reaches = std::exchange(reaches_, {});
    for (const Ordered& face : order) {
      candidates_.push_back(candidates[face.number]);
      candidates_.back().plane_number = face.plane;
      reaches_.push_back(reaches[face.number]);
      reaches_.back().nearest = face.nearest;
    }
  }

  /// Examines the remaining faces for a piece. Parts of the piece outside of a face are put aside for later.
  void finish(Piece& piece, std::vector<SeenPart>& seen) {
    double farthest = -std::numeric_limits<double>::infinity();  // key of the front face
    if (piece.front != no_index) farthest = candidates_[piece.front].farthest;
    for (; piece.next < candidates_.size(); ++piece.next) {
      const Reach& reach = reaches_[piece.next];
      count(kStepsOfLook);
      if (reach.nearest < farthest) break;  // all later faces are behind as well
      if (piece.front != no_index && candidates_[piece.front].plane_number == candidates_[piece.next].plane_number) {
        piece.next = plane_ends_[candidates_[piece.next].plane_number] - 1;  // the others in its plane have greater ids
        continue;
      }
      const CellBox& around = piece.around;
      if (reach.x.high <= around.left || reach.x.low >= around.right || reach.y.high <= around.top ||
          reach.y.low >= around.bottom)
        continue;
      const Candidate& face = candidates_[piece.next];
      if (piece.front != no_index && lies_behind(face, candidates_[piece.front], piece.polygon)) continue;
      count(kStepsOfCut);
      if (piece.polygon.is_full())
        put_aside(piece.front, piece.next, [&](ConvexPiece& half) { half = piece.polygon.halve(); });
      if (!cut_to(face, piece)) continue;
      choose_nearer(piece.next, piece);
      farthest = candidates_[piece.front].farthest;
    }
    if (piece.front == no_index) return;
    emit(piece.polygon, candidates_[piece.front], seen);
  }

  bool lies_behind(const Candidate& face, const Candidate& front, const ConvexPiece& polygon) const {
    for (const glm::dvec2& p : polygon) {
      const double key = front.plane.at(p);
      if (!(face.plane.at(p) < key - kAlike * std::abs(key))) return false;
    }
    return true;
  }

  /// Puts the polygon that make(polygon) makes aside for later, unless the polygon is narrow. \returns whether it is
  /// kept.
  template <class Make>
  bool put_aside(std::uint32_t front, std::uint32_t next, const Make& make) {
    Piece& piece = pieces_.emplace_back(front, next);
    make(piece.polygon);
    const bool is_kept = !is_narrow(piece.polygon);
    if (is_kept)
      piece.around = box_of(piece.polygon);
    else
      pieces_.pop_back();
    return is_kept;
  }

  /// Reduces a piece to the part inside a face; the rest is put aside. \returns false if nothing lies inside; the piece
  /// is then unchanged.
  bool cut_to(const Candidate& face, Piece& piece) {
    std::array<LineDistances, 3> distances;
    bool is_within = true;
    for (std::size_t k = 0; k < 3; ++k) {
      distances[k].measure(piece.polygon, face.sides[k]);
      if (distances[k].side == LineSide::right || distances[k].side == LineSide::neither) return false;
      is_within = is_within && distances[k].side == LineSide::left;
    }
    if (is_within) return true;
    const std::size_t before = pieces_.size();
    ConvexPiece parts[2];
    const ConvexPiece* rest = &piece.polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      if (distances[k].side == LineSide::left) continue;
      if (rest != &piece.polygon) distances[k].measure(*rest, face.sides[k]);
      if (distances[k].side == LineSide::left) continue;
      if (distances[k].side != LineSide::both) {
        pieces_.erase(pieces_.begin() + std::ptrdiff_t(before), pieces_.end());
        return false;
      }
      ConvexPiece& within = parts[rest == parts ? 1 : 0];
      put_aside(piece.front, piece.next + 1,
                [&](ConvexPiece& beside) { cut_polygon(*rest, distances[k], within, beside); });
      rest = &within;
    }
    if (is_narrow(*rest)) {
      pieces_.erase(pieces_.begin() + std::ptrdiff_t(before), pieces_.end());
      return false;
    }
    piece.polygon = *rest;
    piece.around = box_of(*rest);
    return true;
  }

  /// Compares a face that covers the whole piece with the front face. If each is nearer in a part of the piece, the
  /// piece keeps the part where the new face is nearer, and the other part is put aside.
  void choose_nearer(std::uint32_t number, Piece& piece) {
    if (piece.front == no_index) {
      piece.front = number;
      return;
    }
    const AffineKey &plane = candidates_[number].plane, &front = candidates_[piece.front].plane;
    const double along_x = plane.along_x - front.along_x, along_y = plane.along_y - front.along_y;
    // The difference of both keys is proportional to the distance from the line where they are equal.
    const auto difference = [&](const glm::dvec2& p) { return plane.at(p) - front.at(p); };
    LineDistances nearer;
    nearer.measure(piece.polygon, difference, kNarrow * std::sqrt(along_x * along_x + along_y * along_y));
    double key = 0, most = 0;
    for (int i = 0; i < piece.polygon.size(); ++i) {
      key = std::max(key, std::abs(front.at(piece.polygon.begin()[i])));
      most = std::max(most, std::abs(nearer.at[std::size_t(i)]));
    }
    if (most <= kAlike * key) {
      if (is_preferred(candidates_[number], candidates_[piece.front], nearer)) piece.front = number;
      return;
    }
    if (nearer.side == LineSide::right || nearer.side == LineSide::neither) return;
    if (nearer.side == LineSide::both) {
      ConvexPiece before;
      const bool is_cut = put_aside(piece.front, piece.next + 1,
                                    [&](ConvexPiece& behind) { cut_polygon(piece.polygon, nearer, before, behind); });
      if (is_narrow(before)) {
        if (is_cut) pieces_.pop_back();
        return;
      }
      if (is_cut) {
        piece.polygon = before;
        piece.around = box_of(before);
      }
    }
    piece.front = number;
  }

  /// Decides between two faces that doubles cannot tell apart: the lower id if the faces lie in one plane, else the
  /// face that seems nearer.
  bool is_preferred(const Candidate& face, const Candidate& front, const LineDistances& nearer) {
    count(kStepsOfPlane);
    const PrimitiveId id = faces_.screen.faces[face.face].id, front_id = faces_.screen.faces[front.face].id;
    if (lie_in_one_plane(faces_.surfaces.corners(front_id), faces_.surfaces.corners(id))) return id < front_id;
    const double sum = std::accumulate(nearer.at.begin(), nearer.at.begin() + nearer.size, 0.0);
    return sum > 0 || (sum == 0 && id < front_id);
  }

  void emit(const ConvexPiece& polygon, const Candidate& face, std::vector<SeenPart>& seen) {
    count(kStepsOfPart);
    std::array<ScreenPoint, ConvexPiece::most_corners> corners;
    std::size_t count = 0;
    for (const glm::dvec2& p : polygon)
      corners[count++] = {p.x, p.y, std::clamp(face.plane.at(p), face.least, face.most)};
    const Areas areas = faces_.rule.areas_of(std::span(corners).first(count));
    if (areas.pixels > 0) seen.push_back({face.face, areas});
  }

  const FacesOfView& faces_;
  std::function<void(std::uint64_t)> tell_;
  std::uint64_t steps_ = 0;  ///< not yet reported
  std::vector<Candidate> candidates_;
  std::vector<Reach> reaches_;             ///< by candidate
  std::vector<std::uint32_t> plane_ends_;  ///< by plane number: end of its candidates
  std::vector<Piece> pieces_;              ///< still to be examined
};

}  // namespace frontmost::faces_detail
