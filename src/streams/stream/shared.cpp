// SPDX-License-Identifier: Apache-2.0
// Lists are gathered and joined on rank 0, and sent to all ranks. Planes are merged by one maximum of integers.
#include "stream/shared.h"

#include <algorithm>

#include "base/parallel.h"
#include "view/packed.h"

namespace frontmost::streaming {
namespace {

Ranks::Message message_of(const PassFacts& facts) {
  MessageWriter writer;
  writer.put_list(facts.triangle_counts);
  writer.put(facts.bounds);
  writer.put(std::uint64_t(facts.warnings.size()));
  for (const FileWarning& warning : facts.warnings) {
    writer.put(warning.file);
    writer.put_text(warning.text);
  }
  return writer.take();
}

PassFacts facts_of(const Ranks::Message& message) {
  MessageReader reader(message);
  PassFacts facts;
  facts.triangle_counts = reader.get_list<std::uint64_t>();
  facts.bounds = reader.get<Box>();
  for (auto left = reader.get<std::uint64_t>(); left > 0; --left) {
    const auto file = reader.get<std::uint32_t>();
    facts.warnings.push_back({file, reader.get_text()});
  }
  return facts;
}

/// Calls visit(list) for each list of kept triangles that a message holds. Vertex numbers are left out, because they
/// follow from the order of the triangles.
template <class AnyKept, class Visit>
void for_each_list(AnyKept& kept, const Visit& visit) {
  visit(kept.triangles);
  visit(kept.mesh.positions);
  visit(kept.mesh.normals.values);
  visit(kept.mesh.texcoords.values);
  visit(kept.mesh.colors.values);
  visit(kept.mesh.material_ids);
}

std::size_t size_of(const Kept& kept) {
  std::size_t bytes = 64;  // for the place, and the lengths of the lists
  for_each_list(kept, [&](const auto& list) { bytes += list.size() * sizeof(list[0]); });
  return bytes;
}

void put(const Kept& kept, MessageWriter& writer) {
  writer.put(kept.place.first);
  writer.put(kept.place.object);
  for_each_list(kept, [&](const auto& list) { writer.put_list(list); });
}

Kept get_kept(MessageReader& reader) {
  Kept kept;
  kept.place.first = reader.get<PrimitiveId>();
  kept.place.object = reader.get<std::uint32_t>();
  for_each_list(kept, [&]<class T>(std::vector<T>& list) { list = reader.get_list<T>(); });
  // Each triangle has three vertices of its own, in order.
  kept.mesh.triangles.reserve(kept.triangles.size());
  for (std::uint32_t t = 0; t < kept.triangles.size(); ++t)
    kept.mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  return kept;
}

}  // namespace

PassFacts share(Ranks& ranks, const PassFacts& mine) {
  const std::vector<Ranks::Message> messages = ranks.gather(message_of(mine));
  PassFacts all = mine;
  for (std::size_t rank = 1; rank < messages.size(); ++rank) {
    const PassFacts facts = facts_of(messages[rank]);
    for (std::size_t i = 0; i < std::min(all.triangle_counts.size(), facts.triangle_counts.size()); ++i)
      all.triangle_counts[i] = std::max(all.triangle_counts[i], facts.triangle_counts[i]);
    all.warnings.insert(all.warnings.end(), facts.warnings.begin(), facts.warnings.end());
    all.bounds.include(facts.bounds);
  }
  std::stable_sort(all.warnings.begin(), all.warnings.end(),
                   [](const FileWarning& a, const FileWarning& b) { return a.file < b.file; });
  return facts_of(ranks.broadcast(message_of(all)));
}

std::vector<glm::vec3> share(Ranks& ranks, const std::vector<glm::vec3>& mine) {
  MessageWriter writer, whole;
  writer.put_list(mine);
  std::vector<glm::vec3> all;
  for (const Ranks::Message& message : ranks.gather(writer.take())) {
    const std::vector<glm::vec3> part = MessageReader(message).get_list<glm::vec3>();
    all.insert(all.end(), part.begin(), part.end());
  }
  whole.put_list(all);
  return MessageReader(ranks.broadcast(whole.take())).get_list<glm::vec3>();
}

void share(Ranks& ranks, Visible& visible, const Execution& execution) {
  // Planes are merged in runs, because a whole plane at once would take as much memory again, and would not be faster.
  constexpr std::size_t run = 1u << 20, samples_at_once = 1u << 16;
  PrimitiveId* const ids = visible.primitives.data();
  float* const keys = visible.keys.data();
  const std::size_t count = visible.keys.size();
  std::vector<std::uint64_t> packed(std::min(run, count));
  for (std::size_t first = 0; first < count; first += run) {
    const std::span<std::uint64_t> numbers(packed.data(), std::min(run, count - first));
    parallel_for(execution, numbers.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) numbers[i] = packed_sample(ids[first + i], keys[first + i]);
    });
    ranks.keep_greatest(numbers);
    parallel_for(execution, numbers.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) unpack_sample(numbers[i], ids[first + i], keys[first + i]);
    });
  }
}

KeptPieces gather(Ranks& ranks, KeptPieces mine) {
  MessageWriter writer;
  std::vector<Kept> all;
  if (ranks.number() == 0) {
    for (auto& [number, kept] : mine) all.push_back(std::move(kept));
  } else {
    std::size_t bytes = 0;
    for (const auto& [number, kept] : mine) bytes += size_of(kept);
    writer.reserve(bytes);
    for (const auto& [number, kept] : mine) put(kept, writer);
  }
  mine.clear();  // keeping both would take twice the memory
  for (Ranks::Message& message : ranks.gather(writer.take())) {
    MessageReader reader(message);
    while (!reader.is_at_end()) all.push_back(get_kept(reader));
    Ranks::Message().swap(message);
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.place.first < b.place.first; });
  KeptPieces pieces;
  for (std::size_t number = 0; number < all.size(); ++number) {
    all[number].place.number = number;
    pieces.emplace_hint(pieces.end(), number, std::move(all[number]));
  }
  return pieces;
}

IdShift::IdShift(const std::vector<PrimitiveId>& from, const std::vector<std::uint64_t>& counts,
                 const std::vector<PrimitiveId>& to) {
  for (std::size_t i = 0; i < from.size(); ++i)
    if (counts[i] > 0) files_.push_back({from[i], to[i] - from[i]});
}

PrimitiveId IdShift::operator()(PrimitiveId id) const {
  const auto after = std::upper_bound(files_.begin(), files_.end(), id,
                                      [](PrimitiveId wanted, const File& file) { return wanted < file.from; });
  return id + std::prev(after)->shift;
}

void IdShift::apply(std::span<PrimitiveId> ids, const Execution& execution) const {
  constexpr std::size_t samples_at_once = 1u << 16;
  if (std::all_of(files_.begin(), files_.end(), [](const File& file) { return file.shift == 0; })) return;
  parallel_for(execution, ids.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (ids[i] != no_primitive) ids[i] = (*this)(ids[i]);
  });
}

}  // namespace frontmost::streaming
