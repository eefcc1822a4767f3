// SPDX-License-Identifier: Apache-2.0
// Draws the primitives of a batch into one tile, in the order of submission.
//
//    small triangles    packets are walked to masks of 8 x 8 pixels, then fragments are listed triangle by triangle
//    other triangles    row by row
//    lines, points      pixel by pixel
//    rectangles         row by row
//
// Every vector of fragments goes through FragmentStage. A vector of a list may hold two fragments of one pixel; the
// later one then waits for a pass of its own.

#include "fragments/painter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fragments/painter_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "fragments/fragments-inl.h"
#include "view/steep_keys-inl.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::zbuffer_detail;
using namespace frontmost::zbuffer_detail::HWY_NAMESPACE;

constexpr std::int32_t kCentre = kSubPixels / 2;

/// Stored depths of window depths from 0 to 1, moved by `offset` steps.
HWY_INLINE VI StoredDepth(VF z, VF offset) {
  const VF most = All(float(kMostDepth));
  const VF depth = hn::Add(hn::Mul(z, most), offset);
  return hn::NearestInt(hn::Min(hn::Max(depth, hn::Zero(DF())), most));
}

/// Divides weights by w. `inverse_w` belongs to the three vertices.
HWY_INLINE VertexWeights Divided(const VertexWeights& w, const VF (&inverse_w)[3], bool needs_change) {
  const VF p1 = hn::Mul(w.of[0], inverse_w[1]), p2 = hn::Mul(w.of[1], inverse_w[2]);
  const VF p0 = hn::Mul(hn::Sub(hn::Sub(All(1), w.of[0]), w.of[1]), inverse_w[0]);
  const VF scale = hn::Div(All(1), hn::Add(hn::Add(p0, p1), p2));
  VertexWeights to;
  to.of[0] = hn::Mul(p1, scale);
  to.of[1] = hn::Mul(p2, scale);
  if (!needs_change) return to;
  const auto change = [&](const VF(&by)[2], VF(&out)[2]) HWY_ATTR {
    const VF d1 = hn::Mul(by[0], inverse_w[1]), d2 = hn::Mul(by[1], inverse_w[2]);
    const VF d0 = hn::Mul(hn::Neg(hn::Add(by[0], by[1])), inverse_w[0]);
    const VF sum = hn::Add(hn::Add(d0, d1), d2);
    out[0] = hn::Mul(hn::Sub(d1, hn::Mul(to.of[0], sum)), scale);
    out[1] = hn::Mul(hn::Sub(d2, hn::Mul(to.of[1], sum)), scale);
  };
  change(w.x, to.x);
  change(w.y, to.y);
  return to;
}

/// A vector of fragments of any pixels and triangles.
struct ListSource {
  const Batch& batch;
  VI at;  ///< index of the pixel in the frame's planes
  VU id;  ///< running number of the primitive
  VI v[3], provoking;
  VI back;               ///< 1 where the triangle is seen from behind and has colors for that
  VertexWeights window;  ///< weights before their division by w
  bool is_flat;
  const float* coverage;  ///< of each lane, for smooth lines and points, or null
  VertexWeights weights{};
  MI live[1]{};
  VI depth[1]{};

  HWY_INLINE void Weigh(std::size_t, bool needs_change) {
    const float* const w = batch.inverse_w();
    const VF inverse_w[3] = {hn::GatherIndex(DF(), w, v[0]), hn::GatherIndex(DF(), w, v[1]),
                             hn::GatherIndex(DF(), w, v[2])};
    weights = Divided(window, inverse_w, needs_change);
  }
  static void Move(std::size_t, std::size_t) {}
  static const FragmentColor* Pixels() { return nullptr; }
  [[nodiscard]] HWY_INLINE VU Id(std::size_t) const { return id; }
  [[nodiscard]] HWY_INLINE VF Covered(std::size_t, VF alpha) const {
    return coverage ? hn::Mul(alpha, hn::Load(DF(), coverage)) : alpha;
  }
  [[nodiscard]] HWY_INLINE VU Load(std::size_t, const std::uint32_t* plane) const {
    return hn::GatherIndex(DU(), plane, at);
  }
  HWY_INLINE void Store(std::size_t, std::uint32_t* plane, VU words, MI lanes) const {
    const DI d;
    HWY_ALIGN_MAX std::uint32_t word[kMaxLanes];
    HWY_ALIGN_MAX std::int32_t to[kMaxLanes];
    hn::Store(words, DU(), word);
    hn::Store(at, d, to);
    ForEachBit(BitsOf(d, lanes), [&](std::size_t lane) { plane[to[lane]] = word[lane]; });
  }
  [[nodiscard]] HWY_INLINE auto ColorOfVertex(int k) const {
    return [this, k](std::size_t) HWY_ATTR {
      const DI d;
      const float* column = batch.output(kOutRed + k);
      const VI shift = hn::Mul(back, hn::Set(d, std::int32_t((kOutBack - kOutRed) * int(batch.output_stride()))));
      if (is_flat) return hn::GatherIndex(DF(), column, hn::Add(provoking, shift));
      return Between(column, hn::Add(v[0], shift), hn::Add(v[1], shift), hn::Add(v[2], shift));
    };
  }
  [[nodiscard]] HWY_INLINE auto Varying(int k) const {
    return [this, k](std::size_t) HWY_ATTR { return Between(batch.output(k), v[0], v[1], v[2]); };
  }
  HWY_INLINE void Changes(std::size_t, int k, VF& dx, VF& dy) const {
    const float* column = batch.output(k);
    const VF a = hn::GatherIndex(DF(), column, v[0]), b = hn::Sub(hn::GatherIndex(DF(), column, v[1]), a),
             c = hn::Sub(hn::GatherIndex(DF(), column, v[2]), a);
    dx = hn::Add(hn::Mul(weights.x[0], b), hn::Mul(weights.x[1], c));
    dy = hn::Add(hn::Mul(weights.y[0], b), hn::Mul(weights.y[1], c));
  }

 private:
  [[nodiscard]] HWY_INLINE VF Between(const float* column, VI i, VI j, VI l) const {
    const VF a = hn::GatherIndex(DF(), column, i), b = hn::GatherIndex(DF(), column, j),
             c = hn::GatherIndex(DF(), column, l);
    const VF sum = hn::Add(a, hn::Mul(weights.of[0], hn::Sub(b, a)));
    return hn::Add(sum, hn::Mul(weights.of[1], hn::Sub(c, a)));
  }
};

/// Vectors of fragments side by side in rows of one triangle, or of a rectangle of pixels.
struct RowSource {
  std::uint32_t id;
  float values[kVaryings][3];  ///< of vertex 0, and what vertices 1 and 2 differ by
  bool is_affine, has_pixels = false;
  VF inverse_w[3];     ///< of the vertices
  VertexWeights step;  ///< `x` and `y`
  // Weights start from doubles at every 16th pixel, so that they do not depend on the number of lanes.
  double at_column[kTileSize / 16][2], by_row[2];
  std::int32_t x[kBlock], y[kBlock];  ///< first pixels, in the tile
  std::size_t at[kBlock];             ///< their indices in the frame's planes
  MI live[kBlock];
  VI depth[kBlock];
  FragmentColor pixels[kBlock];  ///< in the place of the colors of vertices, if there are any
  VertexWeights weights[kBlock];

  HWY_INLINE void Weigh(std::size_t count, bool needs_change) {
    for (std::size_t v = 0; v < count; ++v) {
      const int anchor = x[v] & ~15;
      const VF steps = hn::ConvertTo(DF(), CountFrom(DI(), x[v] - anchor));
      VertexWeights w = step;
      for (int k = 0; k < 2; ++k)
        w.of[k] = hn::Add(All(float(at_column[anchor / 16][k] + by_row[k] * y[v])), hn::Mul(steps, w.x[k]));
      weights[v] = is_affine ? w : Divided(w, inverse_w, needs_change);
    }
  }
  HWY_INLINE void Move(std::size_t to, std::size_t from) {
    x[to] = x[from], y[to] = y[from], at[to] = at[from], live[to] = live[from], depth[to] = depth[from];
    if (has_pixels) pixels[to] = pixels[from];
  }
  [[nodiscard]] HWY_INLINE VU Load(std::size_t v, const std::uint32_t* plane) const {
    return hn::LoadU(DU(), plane + at[v]);
  }
  HWY_INLINE void Store(std::size_t v, std::uint32_t* plane, VU words, MI lanes) const {
    const DU d;
    hn::StoreU(hn::IfThenElse(hn::RebindMask(d, lanes), words, hn::LoadU(d, plane + at[v])), d, plane + at[v]);
  }
  [[nodiscard]] HWY_INLINE VU Id(std::size_t) const { return hn::Set(DU(), id); }
  [[nodiscard]] static HWY_INLINE VF Covered(std::size_t, VF alpha) { return alpha; }
  [[nodiscard]] HWY_INLINE auto Varying(int k) const {
    const VF a = All(values[k][0]), b = All(values[k][1]), c = All(values[k][2]);
    const bool is_constant = values[k][1] == 0 && values[k][2] == 0;
    return [w = weights, a, b, c, is_constant](std::size_t v) HWY_ATTR {
      return is_constant ? a : hn::Add(hn::Add(a, hn::Mul(w[v].of[0], b)), hn::Mul(w[v].of[1], c));
    };
  }
  [[nodiscard]] HWY_INLINE auto ColorOfVertex(int k) const { return Varying(kOutRed + k); }
  [[nodiscard]] const FragmentColor* Pixels() const { return has_pixels ? pixels : nullptr; }
  HWY_INLINE void Changes(std::size_t v, int k, VF& dx, VF& dy) const {
    const VF b = All(values[k][1]), c = All(values[k][2]);
    dx = hn::Add(hn::Mul(weights[v].x[0], b), hn::Mul(weights[v].x[1], c));
    dy = hn::Add(hn::Mul(weights[v].y[0], b), hn::Mul(weights[v].y[1], c));
  }
};

/// The pixels of a tile that a state may draw to, relative to the tile.
[[nodiscard]] inline PixelRect BoundsIn(const Tile& tile, DrawBounds b, const PixelProbe* probe) {
  if (probe) b = {HWY_MAX(b.x0, probe->x), HWY_MAX(b.y0, probe->y), HWY_MIN(b.x1, probe->x), HWY_MIN(b.y1, probe->y)};
  return {HWY_MAX(b.x0 - tile.x, 0), HWY_MAX(b.y0 - tile.y, 0), HWY_MIN(b.x1 - tile.x, tile.width - 1),
          HWY_MIN(b.y1 - tile.y, tile.height - 1)};
}

class BatchInTile {
 public:
  BatchInTile(const PaintTarget& target, const Tile& tile, const Batch& batch)
      : frame_(target.frame),
        tile_(tile),
        b_(batch),
        d_(*batch.state),
        stage_(target, *batch.state),
        bounds_(BoundsIn(tile, batch.state->viewport, target.probe)),
        probe_(target.probe) {
    const Capabilities& on = d_.state.capabilities;
    is_flat_ = d_.state.lighting.shade_model == GL_FLAT;
    has_offset_ = on.has(Capability::polygon_offset_fill) &&
                  (d_.state.polygon.offset_factor != 0 || d_.state.polygon.offset_units != 0);
    is_stippled_ = on.has(Capability::polygon_stipple);
  }

  [[nodiscard]] std::uint64_t Draw() {
    if (!b_.lines.empty()) lines_ = b_.line_lists.of(tile_.number);
    if (b_.kind == Batch::Kind::triangles && !bounds_.is_empty()) DrawTriangles();
    DrawLinesBefore(~std::uint32_t(0));
    return stage_.passed();
  }

 private:
  // Triangles with a pixel rectangle at most this wide and high are drawn in packets: 64 pixels, a bit each.
  static constexpr int kWalkLimit = 8;

  /// A triangle that is drawn row by row, with places relative to the tile.
  struct RowTriangle {
    TriangleRecord record;
    std::array<std::int32_t, 3> vertices;
  };

  /// Draws lines, which are edges of the triangles before one if one side of polygons is filled and the other is not.
  void DrawLinesBefore(std::uint32_t number) {
    for (; !lines_.empty() && b_.lines[lines_[0]].number < number; lines_ = lines_.subspan(1))
      DrawLine(b_.lines[lines_[0]]);
  }

  void DrawTriangles() {
    const BatchColumns& from = b_.placed.small().columns();
    const auto draw = [&](std::size_t count, const auto& fetch) HWY_ATTR { DrawPacket(count, fetch, from); };
    b_.placed.visit_tile(
        tile_,
        [&](std::span<const TileRun> runs) HWY_ATTR {
          for (const TileRun& run : runs) reader_.Read(run, draw);
        },
        [&](const SingleTriangle& single) HWY_ATTR {
          reader_.Finish(draw);
          DrawLinesBefore(single.record.id >> 1);
          RowTriangle triangle{single.record, b_.single_corners[std::size_t(&single - b_.placed.singles().data())]};
          for (int k = 0; k < 3; ++k) {
            triangle.record.x[k] -= tile_.x * kSubPixels;
            triangle.record.y[k] -= tile_.y * kSubPixels;
          }
          DrawRows(triangle);
        });
    reader_.Finish(draw);
  }

  template <class Fetch>
  HWY_INLINE void DrawPacket(std::size_t count, const Fetch& fetch, const BatchColumns& from) {
    const DI d;
    const VI left = hn::Set(d, tile_.x * kSubPixels), low = hn::Set(d, tile_.y * kSubPixels);
    for (int k = 0; k < 3; ++k) {
      packet_.x[k] = hn::Sub(fetch(d, from.x[k]), left);
      packet_.y[k] = hn::Sub(fetch(d, from.y[k]), low);
      key_[k] = hn::BitCast(DF(), fetch(d, from.key[k]));
      vertex_[k] = fetch(d, b_.small_corners[k].data());
    }
    id_ = hn::BitCast(d, fetch(DU(), from.id));
    count_ = count;
    DrawLoaded();
  }

  HWY_NOINLINE void DrawLoaded() {
    SetUpPacket(packet_, key_);
    Walk();
    std::size_t count = 0;
    for (std::uint64_t left = drawn_; left != 0; left &= left - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
      if (by_row_ >> lane & 1) {
        DrawList(count);
        count = 0;
        DrawRows(TriangleOf(lane));
        continue;
      }
      for (std::uint64_t mask = masks_[lane]; mask != 0; mask &= mask - 1)
        references_[count++] = std::uint32_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(mask) << 4 | lane);
    }
    DrawList(count);
  }

  /// Finds the pixels that each triangle covers: masks of eight by eight pixels, from the triangle's first pixel on.
  HWY_INLINE void Walk() {
    const DI d;
    const PixelRange columns = PixelsBetween(packet_.columns, kCentre, kCentre, bounds_.x0, bounds_.x1);
    const PixelRange rows = PixelsBetween(packet_.rows, kCentre, kCentre, bounds_.y0, bounds_.y1);
    const VI one = hn::Set(d, 1), limit = hn::Set(d, kWalkLimit);
    VI width = hn::Add(hn::Sub(columns.last, columns.first), one);
    VI height = hn::Add(hn::Sub(rows.last, rows.first), one);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(count_)));
    const MI any = hn::And(live, hn::Gt(hn::Min(width, height), hn::Zero(d)));
    const MI walked = hn::And(hn::AndNot(packet_.steep, any), hn::Not(hn::Gt(hn::Max(width, height), limit)));
    by_row_ = BitsOf(d, hn::AndNot(walked, any));
    width = hn::IfThenElseZero(walked, width);
    height = hn::IfThenElseZero(walked, height);
    const VI sx = hn::Add(hn::ShiftLeft<8>(columns.first), hn::Set(d, kCentre));
    const VI sy = hn::Add(hn::ShiftLeft<8>(rows.first), hn::Set(d, kCentre));
    const int most_x = hn::GetLane(hn::MaxOfLanes(d, width)), most_y = hn::GetLane(hn::MaxOfLanes(d, height));
    PacketEdges row = EdgesAt(packet_, sx, sy);
    VI mask[2] = {hn::Zero(d), hn::Zero(d)};  // four rows in each mask
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(height, hn::Set(d, y)), width);
      VI e0 = row.e[0], e1 = row.e[1], e2 = row.e[2], bit = hn::Set(d, 1 << (y % 4 * 8)), bits = mask[y / 4];
      for (int x = 0; x < most_x; ++x) {
        const MI inside = hn::Gt(row_width, hn::Set(d, x));
        const MI covered = hn::And(hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(d, -1)), inside);
        bits = hn::Or(bits, hn::IfThenElseZero(covered, bit));
        bit = hn::Add(bit, bit);
        e0 = hn::Sub(e0, packet_.dy[0]);
        e1 = hn::Sub(e1, packet_.dy[1]);
        e2 = hn::Sub(e2, packet_.dy[2]);
      }
      mask[y / 4] = bits;
      for (int k = 0; k < 3; ++k) row.e[k] = hn::Add(row.e[k], packet_.dx[k]);
    }
    HWY_ALIGN_MAX std::uint32_t halves[2][kMaxLanes];
    hn::Store(hn::BitCast(DU(), mask[0]), DU(), halves[0]);
    hn::Store(hn::BitCast(DU(), mask[1]), DU(), halves[1]);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) masks_[k] = std::uint64_t(halves[1][k]) << 32 | halves[0][k];
    drawn_ = by_row_ | BitsOf(d, hn::Ne(hn::Or(mask[0], mask[1]), hn::Zero(d)));
    first_x_ = columns.first;
    first_y_ = rows.first;
    for (int k = 0; k < 2; ++k) {  // edges 2 and 0, opposite to vertices 1 and 2
      const int e = k == 0 ? 2 : 0;
      edge_[k] =
          hn::Sub(hn::Mul(packet_.dx[e], hn::Sub(sy, packet_.y[e])), hn::Mul(packet_.dy[e], hn::Sub(sx, packet_.x[e])));
    }
    inverse_area_ = hn::Div(All(1), hn::ConvertTo(DF(), packet_.area));
    if (!has_offset_) return;
    for (std::size_t k = 0; k < count_; ++k)
      offset_[k] = (drawn_ >> k & 1) ? float(offset_of(d_.state.polygon, TriangleOf(k).record)) : 0;
  }

  /// Draws the listed fragments, each a pixel << 4 | lane.
  HWY_NOINLINE void DrawList(std::size_t count) {
    const DI d;
    const DF df;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      const MI is_live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(live)));
      const VI reference = hn::IfThenElse(is_live, hn::BitCast(d, hn::LoadU(DU(), references_ + i)),
                                          hn::Set(d, std::int32_t(references_[i])));
      const VI lane = hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1));
      const auto of_f = hn::IndicesFromVec(df, lane);
      const auto of_i = hn::IndicesFromVec(d, lane);
      const auto pick = [&](VI v) HWY_ATTR { return hn::TableLookupLanes(v, of_i); };
      const auto pick_f = [&](VF v) HWY_ATTR { return hn::TableLookupLanes(v, of_f); };
      const VI dx = hn::And(hn::ShiftRight<4>(reference), hn::Set(d, 7)), dy = hn::ShiftRight<7>(reference);
      const VI x = hn::Add(pick(first_x_), dx), y = hn::Add(pick(first_y_), dy);
      // The key plane's operations, as everywhere.
      const VI from_x = hn::Add(hn::ShiftLeft<8>(x), hn::Set(d, kCentre)),
               from_y = hn::Add(hn::ShiftLeft<8>(y), hn::Set(d, kCentre));
      VF z = hn::Add(pick_f(packet_.k0),
                     hn::Mul(hn::ConvertTo(df, hn::Sub(from_x, pick(packet_.x0))), pick_f(packet_.gx)));
      z = hn::Add(z, hn::Mul(hn::ConvertTo(df, hn::Sub(from_y, pick(packet_.y0))), pick_f(packet_.gy)));
      z = hn::Min(hn::Max(z, pick_f(packet_.k_min)), pick_f(packet_.k_max));
      const VI id = pick(id_), frame_x = hn::Add(x, hn::Set(d, tile_.x)), frame_y = hn::Add(y, hn::Set(d, tile_.y));
      ListSource source{b_,
                        hn::Add(hn::Mul(frame_y, hn::Set(d, std::int32_t(frame_.stride))), frame_x),
                        hn::BitCast(DU(), hn::Add(hn::ShiftRight<1>(id), hn::Set(d, std::int32_t(b_.first_id)))),
                        {pick(vertex_[0]), pick(vertex_[1]), pick(vertex_[2])},
                        hn::Zero(d),
                        BackOf(id),
                        {},
                        is_flat_,
                        nullptr};
      if (is_flat_) source.provoking = hn::GatherIndex(d, b_.provoking.data(), hn::ShiftRight<1>(id));
      VertexWeights& w = source.window;
      const VF inverse_area = pick_f(inverse_area_);
      for (int k = 0; k < 2; ++k) {
        const int e = k == 0 ? 2 : 0;
        const VI by_x = hn::ShiftLeft<8>(hn::Neg(pick(packet_.dy[e]))), by_y = hn::ShiftLeft<8>(pick(packet_.dx[e]));
        const VI value = hn::Add(hn::Add(pick(edge_[k]), hn::Mul(by_x, dx)), hn::Mul(by_y, dy));
        w.of[k] = hn::Mul(hn::ConvertTo(df, value), inverse_area);
        w.x[k] = hn::Mul(hn::ConvertTo(df, by_x), inverse_area);
        w.y[k] = hn::Mul(hn::ConvertTo(df, by_y), inverse_area);
      }
      const VF offset = has_offset_ ? hn::GatherIndex(df, offset_, lane) : hn::Zero(df);
      MI covered = is_live;
      if (is_stippled_) covered = hn::And(covered, Stippled(frame_x, frame_y));
      InOrder(source, covered, StoredDepth(z, offset));
    }
  }

  /// Processes the fragments of a list, one pass for each repetition of a pixel.
  HWY_NOINLINE void InOrder(ListSource& source, MI left, VI depth) {
    const DI d;
    HWY_ALIGN_MAX std::int32_t at[kMaxLanes];
    do {
      hn::Store(hn::IfThenElse(left, source.at, hn::Set(d, -1)), d, at);
      MI repeats = hn::Lt(hn::Zero(d), hn::Zero(d));  // lanes whose pixel one before them has
      for (std::size_t k = 0; k + 1 < hn::Lanes(d); ++k) {
        const MI later = hn::Gt(hn::Iota(d, 0), hn::Set(d, std::int32_t(k)));
        repeats = hn::Or(repeats, hn::And(later, hn::Eq(source.at, hn::Set(d, at[k]))));
      }
      source.live[0] = hn::AndNot(repeats, left);
      source.depth[0] = depth;
      stage_.Process(source, 1);
      left = hn::And(left, repeats);
    } while (!hn::AllFalse(d, left));
  }

  [[nodiscard]] HWY_INLINE VI BackOf(VI id) const {
    const DI d;
    return d_.is_two_sided ? hn::And(id, hn::Set(d, 1)) : hn::Zero(d);
  }

  [[nodiscard]] HWY_NOINLINE MI Stippled(VI x, VI y) const {
    const DI d;
    const auto* const rows = reinterpret_cast<const std::int32_t*>(d_.state.polygon_stipple.rows.data());
    const VI row = hn::GatherIndex(d, rows, hn::And(y, hn::Set(d, 31)));
    const VI column = hn::Sub(hn::Set(d, 31), hn::And(x, hn::Set(d, 31)));
    const VU bit = hn::And(hn::Shr(hn::BitCast(DU(), row), hn::BitCast(DU(), column)), hn::Set(DU(), 1));
    return hn::Ne(hn::BitCast(d, bit), hn::Zero(d));
  }

  [[nodiscard]] RowTriangle TriangleOf(std::size_t lane) const {
    HWY_ALIGN_MAX std::int32_t x[kMaxLanes], y[kMaxLanes], v[kMaxLanes], id[kMaxLanes];
    HWY_ALIGN_MAX float key[kMaxLanes];
    RowTriangle triangle;
    for (int k = 0; k < 3; ++k) {
      hn::Store(packet_.x[k], DI(), x);
      hn::Store(packet_.y[k], DI(), y);
      hn::Store(vertex_[k], DI(), v);
      hn::Store(key_[k], DF(), key);
      triangle.record.x[k] = x[lane];
      triangle.record.y[k] = y[lane];
      triangle.record.key[k] = key[lane];
      triangle.vertices[std::size_t(k)] = v[lane];
    }
    hn::Store(id_, DI(), id);
    triangle.record.id = std::uint32_t(id[lane]);
    return triangle;
  }

  /// The values of a triangle's vertices, as RowSource reads them.
  void LoadValues(const RowTriangle& t, float (*values)[3]) const {
    const auto load = [&](int to, int from, bool is_flat) {
      const float* const column = b_.output(from);
      if (is_flat) {
        values[to][0] = column[b_.provoking[t.record.id >> 1]];
        values[to][1] = values[to][2] = 0;
        return;
      }
      values[to][0] = column[t.vertices[0]];
      values[to][1] = column[t.vertices[1]] - values[to][0];
      values[to][2] = column[t.vertices[2]] - values[to][0];
    };
    const bool is_back = d_.is_two_sided && (t.record.id & 1) != 0;
    for (const int k : d_.varyings) {
      const bool is_color = k < kOutBack;
      load(k, is_color && is_back ? k + kOutBack - kOutRed : k, is_color && is_flat_);
    }
  }

  HWY_NOINLINE void DrawRows(const RowTriangle& t) {
    const DI d;
    const DF df;
    const TriangleRecord& r = t.record;
    const glm::ivec2 centre(kCentre);
    PixelRect rect = common_part(sampled_rect(r, centre, centre, tile_.width, tile_.height), bounds_);
    if (rect.is_empty()) return;
    RowSource source;
    source.id = b_.first_id + (r.id >> 1);
    LoadValues(t, source.values);
    const KeyPlane plane(r);
    const SteepKeys steep = plane.is_steep ? SteepKeys(r) : SteepKeys();
    const TriangleEdges edges(r, centre);
    const VF offset = All(has_offset_ ? float(offset_of(d_.state.polygon, r)) : 0.0f);
    const double scale = 1 / double(doubled_area(r));
    const float* const of = b_.inverse_w();
    source.is_affine = of[t.vertices[0]] == of[t.vertices[1]] && of[t.vertices[0]] == of[t.vertices[2]];
    for (int k = 0; k < 3; ++k) source.inverse_w[k] = All(of[t.vertices[std::size_t(k)]]);
    // Edges 2 and 0, opposite to vertices 1 and 2.
    for (int k = 0; k < 2; ++k) {
      const int a = k == 0 ? 2 : 0, b = k == 0 ? 0 : 1;
      const double by_column = -double(r.y[b] - r.y[a]) * kSubPixels * scale;
      source.by_row[k] = double(r.x[b] - r.x[a]) * kSubPixels * scale;
      const double from =
          (double(r.x[b] - r.x[a]) * (kCentre - r.y[a]) - double(r.y[b] - r.y[a]) * (kCentre - r.x[a])) * scale;
      for (int i = 0; i < kTileSize / 16; ++i) source.at_column[i][k] = from + by_column * (16 * i);
      source.step.x[k] = All(float(by_column));
      source.step.y[k] = All(float(source.by_row[k]));
    }
    const int lanes = int(hn::Lanes(d)), first = rect.x0 / lanes * lanes;
    const VI right = hn::Set(d, rect.x1), left = hn::Set(d, rect.x0);
    std::size_t count = 0;
    for (int y = rect.y0; y <= rect.y1; ++y) {
      VI e[3], step[3];
      for (int k = 0; k < 3; ++k) {
        const std::int32_t start = edges.first[k] + first * edges.step_x[k] + y * edges.step_y[k];
        e[k] = hn::Add(hn::Set(d, start), hn::Mul(hn::Iota(d, 0), hn::Set(d, edges.step_x[k])));
        step[k] = hn::Set(d, lanes * edges.step_x[k]);
      }
      const VF down = All(float(y * kSubPixels + kCentre - plane.y0) * plane.gy);
      for (int x = first; x <= rect.x1; x += lanes) {
        const VI column = CountFrom(d, x);
        MI covered = hn::Gt(hn::Or(hn::Or(e[0], e[1]), e[2]), hn::Set(d, -1));
        for (int k = 0; k < 3; ++k) e[k] = hn::Add(e[k], step[k]);
        covered = hn::And(covered, hn::And(hn::Not(hn::Gt(column, right)), hn::Not(hn::Lt(column, left))));
        if (is_stippled_)
          covered = hn::And(covered, Stippled(hn::Add(column, hn::Set(d, tile_.x)), hn::Set(d, tile_.y + y)));
        if (hn::AllFalse(d, covered)) continue;
        const VI sample = hn::Add(hn::ShiftLeft<8>(column), hn::Set(d, kCentre));
        VF z;
        if (plane.is_steep) {
          view_detail::HWY_NAMESPACE::SteepColumns columns;
          columns.Set(steep, sample);
          z = columns.At(steep, y * kSubPixels + kCentre);
        } else {
          const VF dx = hn::ConvertTo(df, hn::Sub(sample, hn::Set(d, plane.x0)));
          z = hn::Add(hn::Add(All(plane.k0), hn::Mul(dx, All(plane.gx))), down);
          z = hn::Min(hn::Max(z, All(plane.k_min)), All(plane.k_max));
        }
        source.x[count] = x;
        source.y[count] = y;
        source.at[count] = frame_.at(tile_.x + x, tile_.y + y);
        source.live[count] = covered;
        source.depth[count] = StoredDepth(z, offset);
        if (++count < kBlock) continue;
        stage_.Process(source, count);
        count = 0;
      }
    }
    if (count > 0) stage_.Process(source, count);
  }

  void DrawLine(const WindowLine& line) {
    PixelRect rect = common_part(line.rect, tile_.rect());
    if (probe_) rect = common_part(rect, {probe_->x, probe_->y, probe_->x, probe_->y});
    if (rect.is_empty()) return;
    is_smooth_ = d_.state.capabilities.has(line.is_point ? Capability::point_smooth : Capability::line_smooth);
    const glm::ivec2 a(b_.place(0)[line.vertex[0]], b_.place(1)[line.vertex[0]]);
    const glm::ivec2 b(b_.place(0)[line.vertex[1]], b_.place(1)[line.vertex[1]]);
    if (is_smooth_)
      DrawSmooth(line, rect, a, b);
    else if (line.is_point)
      DrawPoint(line, rect, a);
    else
      DrawPlain(line, rect, a, b);
    EndLine(line);
  }

  void DrawPoint(const WindowLine& line, const PixelRect& rect, const glm::ivec2& at) {
    const int size = HWY_MAX(int(d_.state.point.size + 0.5f), 1);
    // An odd size is centred on the pixel of the vertex, an even size on the nearest corner of pixels.
    const int shift = size % 2 == 1 ? 0 : 128;
    const int left = ((at.x + shift) >> 8) - size / 2, low = ((at.y + shift) >> 8) - size / 2;
    for (int y = HWY_MAX(low, rect.y0); y <= HWY_MIN(low + size - 1, rect.y1); ++y)
      for (int x = HWY_MAX(left, rect.x0); x <= HWY_MIN(left + size - 1, rect.x1); ++x) AddFragment(line, x, y, 0, 1);
  }

  /// Draws a line as pixels side by side: the main axis is the one along which it is longer.
  void DrawPlain(const WindowLine& line, const PixelRect& rect, const glm::ivec2& a, const glm::ivec2& b) {
    const int main = std::abs(b.x - a.x) >= std::abs(b.y - a.y) ? 0 : 1;
    const std::int64_t length = b[main] - a[main];
    if (length == 0) return;
    const auto [begin, end] = pixels_between(a[main], b[main]);
    const glm::ivec2 low(rect.x0, rect.y0), high(rect.x1, rect.y1);
    const int width = HWY_MAX(int(d_.state.line.width + 0.5f), 1);
    const double inverse = 1 / double(length);
    for (int i = HWY_MAX(begin, low[main]); i < HWY_MIN(end, high[main] + 1); ++i) {
      if (!IsDrawn(line, std::uint32_t(length > 0 ? i - begin : end - 1 - i))) continue;
      const double t = double(std::int64_t(i) * 256 + 128 - a[main]) * inverse;
      // The place across, times the length, in whole numbers: a line between two pixels goes to the lower one.
      const std::int64_t from = std::int64_t(i) * 256 + 128 - a[main], size = std::abs(length), step = 256 * size;
      const std::int64_t rise = (length < 0 ? -from : from) * (b[1 - main] - a[1 - main]);
      const std::int64_t below = (a[1 - main] - 128 * (width - 1)) * size + rise - 1;
      const int start = int((below < 0 ? below - step + 1 : below) / step);
      for (int k = HWY_MAX(start, low[1 - main]); k <= HWY_MIN(start + width - 1, high[1 - main]); ++k)
        AddFragment(line, main == 0 ? i : k, main == 0 ? k : i, t, 1);
    }
  }

  /// Draws a rectangle around a line, or a disc around a point, whose border takes one pixel to fade.
  void DrawSmooth(const WindowLine& line, const PixelRect& rect, const glm::ivec2& a, const glm::ivec2& b) {
    const glm::dvec2 along(b - a);
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    const double reach = double(line.is_point ? d_.state.point.size : d_.state.line.width) / 2;
    if (length == 0 && !line.is_point) return;
    const int main = std::abs(along.x) >= std::abs(along.y) ? 0 : 1;
    const glm::ivec2 low(rect.x0, rect.y0), high(rect.x1, rect.y1);
    const double slope = length > 0 ? along[1 - main] / along[main] : 0;
    // Pixels that are farther from the line along the other axis are not covered.
    const double farthest = line.is_point ? 256 * (reach + 1) : 256 * (reach + 1) * length / std::abs(along[main]);
    for (int i = low[main]; i <= high[main]; ++i) {
      const double centre = double(a[1 - main]) + slope * (i * 256.0 + 128 - a[main]);
      const int first = HWY_MAX(int(std::floor((centre - farthest) / 256)), low[1 - main]);
      const int last = HWY_MIN(int(std::floor((centre + farthest) / 256)), high[1 - main]);
      for (int k = first; k <= last; ++k) {
        const int x = main == 0 ? i : k, y = main == 0 ? k : i;
        const glm::dvec2 from(x * 256.0 + 128 - a.x, y * 256.0 + 128 - a.y);
        if (line.is_point) {
          AddFragment(line, x, y, 0, reach + 0.5 - std::sqrt(from.x * from.x + from.y * from.y) / 256);
          continue;
        }
        const double across = std::abs(from.x * along.y - from.y * along.x) / (length * 256);
        const double at = (from.x * along.x + from.y * along.y) / length;
        if (at > -128 && !IsDrawn(line, std::uint32_t(HWY_MAX(at, 0.0) / 256))) continue;
        const double ends = HWY_MIN(HWY_MIN(at, length - at) / 256 + 0.5, 1.0);
        AddFragment(line, x, y, at / length, HWY_MIN(reach + 0.5 - across, 1.0) * HWY_MAX(ends, 0.0));
      }
    }
  }

  /// Whether the stipple draws the n-th pixel of a line.
  [[nodiscard]] bool IsDrawn(const WindowLine& line, std::uint32_t n) const {
    const LineState& s = d_.state.line;
    return !d_.state.capabilities.has(Capability::line_stipple) ||
           (s.stipple >> ((line.stipple_start + n) / std::uint32_t(s.stipple_factor) % 16) & 1) != 0;
  }

  HWY_INLINE void AddFragment(const WindowLine& line, int x, int y, double t, double coverage) {
    if (coverage <= 0) return;
    line_x_[line_count_] = x;
    line_y_[line_count_] = y;
    line_t_[line_count_] = float(HWY_MIN(HWY_MAX(t, 0.0), 1.0));
    line_coverage_[line_count_] = float(HWY_MIN(coverage, 1.0));
    if (++line_count_ == hn::Lanes(DI())) EndLine(line);
  }

  /// Draws the fragments of a line that wait.
  HWY_NOINLINE void EndLine(const WindowLine& line) {
    if (line_count_ == 0) return;
    const DI d;
    const DF df;
    for (std::size_t k = line_count_; k < hn::Lanes(d); ++k)
      line_x_[k] = line_x_[0], line_y_[k] = line_y_[0], line_t_[k] = 0;
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(line_count_)));
    line_count_ = 0;
    const VI x = hn::Load(d, line_x_), y = hn::Load(d, line_y_);
    const std::int32_t a = line.vertex[0], b = line.vertex[1];
    const VF zero = hn::Zero(df);
    ListSource source{b_,
                      hn::Add(hn::Mul(y, hn::Set(d, std::int32_t(frame_.stride))), x),
                      hn::Set(DU(), b_.first_id + line.number),
                      {hn::Set(d, a), hn::Set(d, b), hn::Set(d, b)},
                      hn::Set(d, line.provoking),
                      hn::Set(d, d_.is_two_sided && line.is_back ? 1 : 0),
                      {{hn::Load(df, line_t_), zero}, {zero, zero}, {zero, zero}},
                      is_flat_,
                      is_smooth_ ? line_coverage_ : nullptr};
    const VF z = Mixed(All(b_.window_z()[a]), All(b_.window_z()[b]), source.window.of[0]);
    InOrder(source, live, StoredDepth(z, All(float(line.offset))));
  }

  Frame& frame_;
  const Tile& tile_;
  const Batch& b_;
  const DrawState& d_;
  FragmentStage stage_;
  PixelRect bounds_;
  const PixelProbe* probe_;
  bool is_flat_, has_offset_, is_stippled_, is_smooth_ = false;
  RunReader reader_;
  std::span<const std::uint32_t> lines_;  // that are not drawn yet
  // State of the packet.
  Packet packet_;
  VF key_[3], inverse_area_;
  VI vertex_[3], id_, first_x_, first_y_, edge_[2];
  std::size_t count_ = 0;
  std::uint64_t by_row_ = 0, drawn_ = 0;
  std::uint64_t masks_[kMaxLanes];
  HWY_ALIGN_MAX float offset_[kMaxLanes] = {};
  std::uint32_t references_[kMaxLanes * kWalkLimit * kWalkLimit + kMaxLanes];
  // Fragments of a line that wait.
  HWY_ALIGN_MAX std::int32_t line_x_[kMaxLanes], line_y_[kMaxLanes];
  HWY_ALIGN_MAX float line_t_[kMaxLanes], line_coverage_[kMaxLanes] = {};
  std::size_t line_count_ = 0;
};

void PaintBatch(const PaintTarget& target, const Tile& tile, const Batch& batch) {
  const std::uint64_t passed = BatchInTile(target, tile, batch).Draw();
  if (target.passed) *target.passed += passed;
}

void PaintRectangle(const PaintTarget& target, const Tile& tile, const DrawState& draw, const PixelRectangle& r,
                    std::uint32_t id) {
  using Kind = PixelRectangle::Kind;
  const DI d;
  const DU du;
  const PixelRect bounds = BoundsIn(tile, draw.scissor, target.probe);
  if (bounds.is_empty()) return;
  const RasterPosition& raster = draw.state.current.raster;
  FragmentStage stage(target, draw);
  RowSource source{};
  source.id = id;
  source.is_affine = true;
  source.has_pixels = r.kind == Kind::color;
  for (int k = 0; k < 4; ++k) source.values[kOutRed + k][0] = raster.color[k];
  for (int k = 0; k < 3; ++k) source.values[kOutRed2 + k][0] = raster.secondary[k];
  source.values[kOutFog][0] = raster.distance;
  for (int k = 0; k < 3 * kTextureUnits; ++k)
    source.values[kOutTexCoord + k][0] = raster.texcoords[std::size_t(k / 3)][k % 3 == 2 ? 3 : k % 3];
  const int lanes = int(hn::Lanes(d));
  // The pixel of the rectangle that a window pixel shows, or -1.
  const auto shown = [](int pixel, float origin, float zoom, int size) {
    const double at = (double(pixel) + 0.5 - double(origin)) / double(zoom);
    return at >= 0 && at < double(size) ? int(at) : -1;
  };
  std::int32_t columns[kTileSize];
  bool has_columns = false;
  for (int x = 0; x < kTileSize; ++x) {
    const bool is_inside = bounds.x0 <= x && x <= bounds.x1;
    columns[x] = is_inside ? shown(tile.x + x, r.x, r.zoom_x, r.width) : -1;
    has_columns |= columns[x] >= 0;
  }
  if (!has_columns) return;
  const std::uint32_t stencil_writes = draw.state.stencil.write_mask & 255;
  for (int y = bounds.y0; y <= bounds.y1; ++y) {
    const int row = shown(tile.y + y, r.y, r.zoom_y, r.height);
    if (row < 0) continue;
    const std::uint32_t* const values = r.values.data() + std::size_t(row) * std::size_t(r.width);
    for (int x = 0; x <= bounds.x1; x += lanes) {
      HWY_ALIGN_MAX std::uint32_t value[kMaxLanes] = {};
      HWY_ALIGN_MAX std::int32_t live[kMaxLanes] = {};
      for (int k = 0; k < lanes; ++k) {
        const int column = columns[x + k];
        if (column < 0) continue;
        value[k] = values[column];
        live[k] = r.kind == Kind::bitmap && value[k] == 0 ? 0 : -1;
      }
      const MI mask = hn::MaskFromVec(hn::Load(d, live));
      const VU words = hn::Load(du, value);
      source.at[0] = target.frame.at(tile.x + x, tile.y + y);
      source.live[0] = mask;
      if (r.kind == Kind::stencil) {
        std::uint32_t* const plane = target.frame.depth.data();
        const VU writes = hn::Set(du, stencil_writes);
        source.Store(0, plane, hn::Or(hn::AndNot(writes, source.Load(0, plane)), hn::And(writes, words)), mask);
        continue;
      }
      source.depth[0] =
          r.kind == Kind::depth ? hn::BitCast(d, words) : StoredDepth(All(raster.window.z), hn::Zero(DF()));
      if (source.has_pixels) source.pixels[0] = Unit(ColorOf(words));
      stage.Process(source, 1);
    }
  }
  if (target.passed) *target.passed += stage.passed();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::gl_detail {

FRONTMOST_KERNELS(PaintBatch);
FRONTMOST_KERNELS(PaintRectangle);

void paint_batch(const PaintTarget& target, const zbuffer_detail::Tile& tile, const Batch& batch, Isa isa) {
  kernel_for(PaintBatchKernels, isa)(target, tile, batch);
}

void paint_rectangle(const PaintTarget& target, const zbuffer_detail::Tile& tile, const DrawState& state,
                     const PixelRectangle& rectangle, std::uint32_t id, Isa isa) {
  kernel_for(PaintRectangleKernels, isa)(target, tile, state, rectangle, id);
}

}  // namespace frontmost::gl_detail
#endif  // HWY_ONCE
