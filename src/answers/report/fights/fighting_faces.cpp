// SPDX-License-Identifier: Apache-2.0
// From faces on the screen to areas at risk, of pairs of faces and of pairs of objects.
//
//   screen_faces -> find_face_pairs -> RiskFinder -> areas by faces -> unions by objects
#include <algorithm>
#include <map>
#include <tuple>

#include "base/exact_vector.h"
#include "base/parallel.h"
#include "base/work_limit.h"
#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "report/fights/face_pairs.h"
#include "report/fights/risk.h"

namespace frontmost {
namespace {

/// Whether all vertices of both triangles lie in one plane.
bool are_in_one_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  const glm::dvec3 origin(a[0]);
  return std::all_of(b.begin(), b.end(), [&](const glm::vec3& corner) {
    return sign_of_determinant({glm::dvec3(a[1]), origin}, {glm::dvec3(a[2]), origin}, {glm::dvec3(corner), origin}) ==
           0;
  });
}

bool share_corner(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](const glm::vec3& corner) { return std::find(b.begin(), b.end(), corner) != b.end(); });
}

FightKind kind_of(const Surfaces& surfaces, PrimitiveId first, PrimitiveId second) {
  const auto a = surfaces.corners(first), b = surfaces.corners(second);
  if (are_in_one_plane(a, b)) return FightKind::one_plane;
  return share_corner(a, b) ? FightKind::fold : FightKind::close;
}

/// Areas in the order in which they were found.
struct FoundAreas {
  std::vector<FightingFaces> faces;
  std::vector<glm::dvec2> corners;
};

/// The input of the search for areas.
struct FightSearch {
  const Surfaces& surfaces;
  const Visible& visible;
  const DepthSetup& setup;
  const std::vector<ScreenFace>& faces;
  const KeyStep step{setup};

  /// Appends the area of two faces; with the same face twice, the area of the clear value.
  void find(RiskFinder& finder, VisibleShares& shares, const FacePair& pair, FoundAreas& found) const {
    const ScreenFace &a = faces[pair.first], &b = faces[pair.second];
    const bool is_alone = pair.first == pair.second;
    const ConvexArea& area = is_alone ? finder.of_clear_value(a) : finder.of_pair(a, b);
    if (area.is_empty()) return;
    const RiskKeys keys(a, b, step);
    const double share = shares.of(area, keys);
    if (share == 0) return;
    FightingFaces fight;
    fight.first = a.record.id;
    if (!is_alone) fight.second = b.record.id;
    fight.kind = is_alone ? FightKind::clear : kind_of(surfaces, fight.first, fight.second);
    fight.area = area.area();
    fight.visible_area = fight.area * share;
    double nearest = 0;
    for (const glm::dvec2& corner : area.corners()) nearest = std::max(nearest, keys.nearest_at(corner));
    fight.distance = std::clamp<double>(depth_of_key(visible.view, float(nearest)), setup.clip.near, setup.clip.far);
    fight.corner_begin = std::uint32_t(found.corners.size());
    fight.corner_count = std::uint32_t(area.corners().size());
    found.corners.insert(found.corners.end(), area.corners().begin(), area.corners().end());
    found.faces.push_back(fight);
  }
};

FoundAreas find_areas(const FightSearch& search, const std::vector<FacePair>& pairs, const Execution& execution) {
  constexpr std::size_t kGrain = 4096, kMostAreas = std::size_t(1) << 22, kPairsAtOnce = 16;
  constexpr std::uint64_t kMostLooks = std::uint64_t(1) << 30, kMostLooksOfSample = 64;
  WorkLimit work(execution, kMostLooks + kMostLooksOfSample * search.visible.view.sample_count(), "fighting faces");
  std::vector<FoundAreas> parts((pairs.size() + kGrain - 1) / kGrain);
  parallel_for(execution, pairs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    RiskFinder finder(search.visible.view, search.setup);
    VisibleShares shares(search.visible, pairs.size());
    for (std::size_t i = begin; i < end; ++i) {
      search.find(finder, shares, pairs[i], parts[begin / kGrain]);
      if (i % kPairsAtOnce == 0 || i + 1 == end)
        work.add(shares.take_looks(), [&] {
          return too_many_faces(search.faces, search.visible.view, "pairs of faces lie over each other");
        });
    }
  });
  FoundAreas all;
  for (const FoundAreas& part : parts) {
    const auto shift = std::uint32_t(all.corners.size());
    all.corners.insert(all.corners.end(), part.corners.begin(), part.corners.end());
    for (FightingFaces fight : part.faces) {
      fight.corner_begin += shift;
      all.faces.push_back(fight);
    }
    if (all.faces.size() > kMostAreas)
      throw Error(ErrorCode::limit_exceeded, "fighting faces", "more than 4194304 areas are at risk");
  }
  return all;
}

std::vector<FightingObjects> join_by_objects(const FightAreas& fights, const Surfaces& surfaces) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, FightKind>;
  std::map<Key, std::vector<std::uint32_t>> members;
  for (std::size_t i = 0; i < fights.faces.size(); ++i) {
    const FightingFaces& fight = fights.faces[i];
    const auto instance = [&](PrimitiveId id) { return id == no_primitive ? no_index : surfaces.source(id).instance; };
    members[{instance(fight.first), instance(fight.second), fight.kind}].push_back(std::uint32_t(i));
  }
  std::vector<FightingObjects> objects;
  for (const auto& [key, numbers] : members) {
    FightingObjects pair;
    std::tie(pair.first, pair.second, pair.kind) = key;
    pair.areas = numbers.size();
    UnionShare united;
    pair.distance = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : numbers) {
      const FightingFaces& fight = fights.faces[i];
      united.add(fights.polygon(fight));
      pair.area += fight.area;
      pair.visible_area += fight.visible_area;
      pair.distance = std::min(pair.distance, fight.distance);
    }
    const double share = united.find();
    pair.area *= share;
    pair.visible_area *= share;
    pair.gap = resolvable_gap(fights.setup, pair.distance);
    objects.push_back(pair);
  }
  std::stable_sort(objects.begin(), objects.end(), [](const FightingObjects& a, const FightingObjects& b) {
    const bool a_folds = a.kind == FightKind::fold, b_folds = b.kind == FightKind::fold;
    return a_folds != b_folds ? b_folds : a.visible_area > b.visible_area;
  });
  return objects;
}

}  // namespace

FightAreas find_fighting_faces(const Surfaces& surfaces, const View& view, DepthFormat format, bool reversed,
                               const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  FightAreas fights;
  fights.view = view;
  fights.setup = {view.projection.clip, format, reversed, view.projection.orthographic};
  const Visible visible = zbuffer(surfaces, view, execution);
  const std::vector<ScreenFace> faces =
      screen_faces(surfaces, view, KeyStep(fights.setup), FarthestSeen(visible), execution);
  std::vector<FacePair> pairs = find_face_pairs(faces, view, execution);
  const auto of_two = std::ptrdiff_t(pairs.size());
  const RiskFinder finder(view, fights.setup);
  for (std::uint32_t i = 0; i < faces.size(); ++i)
    if (finder.may_be_clear_value(faces[i])) pairs.push_back({i, i});
  std::inplace_merge(pairs.begin(), pairs.begin() + of_two, pairs.end());
  FoundAreas found = find_areas({surfaces, visible, fights.setup, faces}, pairs, execution);
  fights.faces = std::move(found.faces);
  fights.corners = std::move(found.corners);
  fights.objects = join_by_objects(fights, surfaces);
  return fights;
}

}  // namespace frontmost
