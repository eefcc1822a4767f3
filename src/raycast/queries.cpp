// SPDX-License-Identifier: Apache-2.0
// What users ask of single rays and segments, one by one or in batches.

#include <algorithm>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "raycast/light_kernel.h"
#include "raycast/query_kernel.h"

namespace frontmost {
namespace {

using namespace raycast_detail;

constexpr std::size_t kQueriesPerPart = 256;

Query query_of(const Ray& ray) { return {ray.origin, ray.origin, ray.direction, false}; }

/// The rounded direction may overflow where the ends are as far apart as floats reach; it then leaves nothing out.
Query query_of(const Segment& segment) { return {segment.from, segment.to, segment.to - segment.from, true}; }

RayHit first_of(const RayTree& tree, const Query& query, Want want, std::vector<RayHit>& hits, Isa isa) {
  hits.clear();
  if (is_valid(query)) walk(tree, query, want, hits, isa);
  return hits.empty() ? RayHit{} : hits[0];
}

void check_sizes(std::size_t queries, std::size_t answers) {
  if (queries != answers)
    throw Error(ErrorCode::bad_argument, "answers: there are " + std::to_string(answers) + " places for " +
                                             std::to_string(queries) + " queries");
}

/// Calls answer(i, hits) for every query, with room for hits that is used again.
template <class Answer>
void for_each_query(std::size_t count, const Execution& execution, const Answer& answer) {
  parallel_for(execution, count, kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    std::vector<RayHit> hits;
    for (std::size_t i = begin; i < end; ++i) answer(i, hits);
  });
}

}  // namespace

RayHit closest_hit(const RayIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  return first_of(index.tree(), query_of(ray), Want::closest, hits, Isa::best);
}

RayHit closest_hit(const RayIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  return first_of(index.tree(), query_of(segment), Want::closest, hits, Isa::best);
}

std::vector<RayHit> all_hits(const RayIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  const Query query = query_of(ray);
  if (is_valid(query)) walk(index.tree(), query, Want::all, hits, Isa::best);
  std::sort(hits.begin(), hits.end(),
            [](const RayHit& a, const RayHit& b) { return a.t != b.t ? a.t < b.t : a.primitive < b.primitive; });
  return hits;
}

bool is_clear(const RayIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  return first_of(index.tree(), query_of(segment), Want::any, hits, Isa::best).primitive == no_primitive;
}

void closest_hits(const RayIndex& index, std::span<const Ray> rays, std::span<RayHit> answers,
                  const Execution& execution) {
  check_sizes(rays.size(), answers.size());
  for_each_query(rays.size(), execution, [&](std::size_t i, std::vector<RayHit>& hits) {
    answers[i] = first_of(index.tree(), query_of(rays[i]), Want::closest, hits, execution.isa);
  });
}

void closest_hits(const RayIndex& index, std::span<const Segment> segments, std::span<RayHit> answers,
                  const Execution& execution) {
  check_sizes(segments.size(), answers.size());
  for_each_query(segments.size(), execution, [&](std::size_t i, std::vector<RayHit>& hits) {
    answers[i] = first_of(index.tree(), query_of(segments[i]), Want::closest, hits, execution.isa);
  });
}

void are_clear(const RayIndex& index, std::span<const Segment> segments, std::span<std::uint8_t> answers,
               const Execution& execution) {
  check_sizes(segments.size(), answers.size());
  for_each_query(segments.size(), execution, [&](std::size_t i, std::vector<RayHit>& hits) {
    answers[i] =
        first_of(index.tree(), query_of(segments[i]), Want::any, hits, execution.isa).primitive == no_primitive;
  });
}

void are_lit(const RayIndex& index, std::span<const TrianglePoint> points, const glm::vec3& to_light,
             std::span<std::uint8_t> answers, const Execution& execution) {
  check_sizes(points.size(), answers.size());
  parallel_for(execution, points.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    find_lit(index.tree(), points.subspan(begin, end - begin), to_light, answers.subspan(begin, end - begin),
             execution.isa);
  });
}

}  // namespace frontmost
