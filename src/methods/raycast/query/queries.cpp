// SPDX-License-Identifier: Apache-2.0
// Public queries of single rays and segments, one by one or in batches.
//
// A batch is divided into parts of 256 queries, each answered by one thread in one kernel call. A single query is a
// part of one, so it gets the same answer.

#include "raycast/query/queries.h"

#include <algorithm>

#include "base/parallel.h"

namespace frontmost {
namespace {

using namespace raycast_detail;

/// Queries and answers of a part, 20 KiB, lie on the stack and in the first-level cache.
constexpr std::size_t kQueriesPerPart = 256;

Query query_of(const Ray& ray) { return {ray.origin, ray.origin, ray.direction, false}; }

/// The rounded direction may overflow if the ends are as far apart as floats reach; it then leaves nothing out.
Query query_of(const Segment& segment) { return {segment.from, segment.to, segment.to - segment.from, true}; }

RayHit first_of(const RayTree& tree, const Query& query, Want want) {
  RayHit hit;
  walk_batch(tree, {&query, 1}, want, {&hit, 1}, Isa::best);
  return hit;
}

void check_sizes(std::size_t queries, std::size_t answers) {
  if (queries != answers)
    throw Error(ErrorCode::bad_argument, "answers",
                "there are " + std::to_string(answers) + " places for " + std::to_string(queries) + " queries");
}

/// Calls take(begin, hits) for the answers to consecutive questions. Answers are stored by number, so they do not
/// depend on threads.
template <class Question, class Take>
void ask(const RayIndex& index, std::span<const Question> questions, Want want, const Execution& execution,
         const Take& take) {
  parallel_for(execution, questions.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    std::array<Query, kQueriesPerPart> queries;
    std::array<RayHit, kQueriesPerPart> hits;
    const std::size_t count = end - begin;
    for (std::size_t i = 0; i < count; ++i) queries[i] = query_of(questions[begin + i]);
    walk_batch(ray_tree(index), {queries.data(), count}, want, {hits.data(), count}, execution.isa);
    take(begin, std::span<const RayHit>(hits.data(), count));
  });
}

template <class Question>
void ask_closest(const RayIndex& index, std::span<const Question> questions, std::span<RayHit> answers,
                 const Execution& execution) {
  check_sizes(questions.size(), answers.size());
  ask(index, questions, Want::closest, execution, [&](std::size_t begin, std::span<const RayHit> hits) {
    std::copy(hits.begin(), hits.end(), answers.begin() + std::ptrdiff_t(begin));
  });
}

}  // namespace

RayHit closest_hit(const RayIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  return first_of(ray_tree(index), query_of(ray), Want::closest);
}

RayHit closest_hit(const RayIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  return first_of(ray_tree(index), query_of(segment), Want::closest);
}

std::vector<RayHit> all_hits(const RayIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  const Query query = query_of(ray);
  if (!is_valid(query)) return hits;
  walk(ray_tree(index), query, Want::all, hits, Isa::best);
  if (ray_tree(index).copies) walk(*ray_tree(index).copies, query, Want::all, hits, Isa::best);
  std::sort(hits.begin(), hits.end(),
            [](const RayHit& a, const RayHit& b) { return a.t != b.t ? a.t < b.t : a.primitive < b.primitive; });
  return hits;
}

bool is_clear(const RayIndex& index, const Segment& segment) {
  const IeeeScope ieee;
  return first_of(ray_tree(index), query_of(segment), Want::any).primitive == no_primitive;
}

void closest_hits(const RayIndex& index, std::span<const Ray> rays, std::span<RayHit> answers,
                  const Execution& execution) {
  ask_closest(index, rays, answers, execution);
}

void closest_hits(const RayIndex& index, std::span<const Segment> segments, std::span<RayHit> answers,
                  const Execution& execution) {
  ask_closest(index, segments, answers, execution);
}

void are_clear(const RayIndex& index, std::span<const Segment> segments, std::span<std::uint8_t> answers,
               const Execution& execution) {
  check_sizes(segments.size(), answers.size());
  ask(index, segments, Want::any, execution, [&](std::size_t begin, std::span<const RayHit> hits) {
    for (std::size_t i = 0; i < hits.size(); ++i) answers[begin + i] = hits[i].primitive == no_primitive;
  });
}

void are_lit(const RayIndex& index, std::span<const TrianglePoint> points, const glm::vec3& to_light,
             std::span<std::uint8_t> answers, const Execution& execution) {
  check_sizes(points.size(), answers.size());
  parallel_for(execution, points.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    find_lit(ray_tree(index), points.subspan(begin, end - begin), {to_light}, answers.subspan(begin, end - begin),
             execution.isa);
  });
}

}  // namespace frontmost
