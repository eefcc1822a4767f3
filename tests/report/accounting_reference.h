// SPDX-License-Identifier: Apache-2.0
// Accounts of objects by brute force: zbuffer() draws every object alone, and samples are counted one by one.
#pragma once

#include <map>

#include "frontmost/report.h"
#include "frontmost/zbuffer.h"

namespace frontmost::test {

/// The picture of one instance with nothing else in the scene.
inline Visible draw_alone(const Scene& scene, std::uint32_t instance, const View& view) {
  Scene alone = scene;
  alone.instances = {scene.instances[instance]};
  return zbuffer(Surfaces(alone), view, {.threads = 1});
}

/// A view by the same camera, with a picture larger by `margin` pixels on each side.
inline View widened(const View& view, const glm::ivec2& margin) {
  View wide = view;
  const Projection& p = view.projection;
  const double across = (p.right - p.left) / view.width, down = (p.top - p.bottom) / view.height;
  wide.width += 2 * margin.x;
  wide.height += 2 * margin.y;
  wide.projection.left -= across * margin.x;
  wide.projection.right += across * margin.x;
  wide.projection.bottom -= down * margin.y;
  wide.projection.top += down * margin.y;
  return wide;
}

/// Counts samples one by one.
class SampleCounter {
 public:
  void add(int x, int y, const glm::ivec2& place) {
    ++set_.count;
    left_ = std::min(left_, x), right_ = std::max(right_, x);
    top_ = std::min(top_, y), bottom_ = std::max(bottom_, y);
    set_.box = {left_, top_, right_ - left_ + 1, bottom_ - top_ + 1};
    sum_ += glm::dvec2(x, y) + glm::dvec2(place) / 256.0;
  }
  [[nodiscard]] const SampleSet& set() const { return set_; }
  [[nodiscard]] glm::dvec2 centroid() const { return set_.count == 0 ? sum_ : sum_ / double(set_.count); }

 private:
  SampleSet set_;
  int left_ = 1 << 30, right_ = -1 << 30, top_ = 1 << 30, bottom_ = -1 << 30;
  glm::dvec2 sum_{0};
};

template <class Visit>
void for_each_sample(const View& view, const Visit& visit) {
  for (int s = 0; s < view.samples; ++s)
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) visit(x, y, s, sample_offsets(view.samples)[std::size_t(s)]);
}

/// The reference accounts, without is_cut_by_near. `margin`: margin of the canvas, in pixels.
inline Accounting reference_account(const Scene& scene, const Visible& visible, const glm::ivec2& margin) {
  const Surfaces surfaces(scene);
  const View& view = visible.view;
  Accounting result;
  result.canvas = {-margin.x, -margin.y, view.width + 2 * margin.x, view.height + 2 * margin.y};
  const Buffer<float> depths = depths_of(visible);
  for (const PrimitiveId id : visible.primitives) result.background += id == no_primitive;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    ObjectAccount& account = result.objects.emplace_back();
    const Visible wide = draw_alone(scene, i, widened(view, margin)), alone = draw_alone(scene, i, view);
    SampleCounter on_canvas, in_frame, seen;
    std::map<std::uint32_t, std::uint64_t> hiders;
    for_each_sample(wide.view, [&](int x, int y, int s, const glm::ivec2& place) {
      if (wide.primitives[wide.index(x, y, s)] != no_primitive) on_canvas.add(x - margin.x, y - margin.y, place);
    });
    for_each_sample(view, [&](int x, int y, int s, const glm::ivec2& place) {
      const std::size_t at = visible.index(x, y, s);
      if (alone.primitives[at] == no_primitive) return;
      in_frame.add(x, y, place);
      const std::uint32_t front = surfaces.source(visible.primitives[at]).instance;
      if (front != i) return void(++hiders[front]);
      seen.add(x, y, place);
      account.distance = std::min(account.distance, depths[at]);
    });
    account.alone = on_canvas.set(), account.in_frame = in_frame.set(), account.visible = seen.set();
    account.centroid = seen.centroid();
    for (const auto& [hider, count] : hiders) result.hidden_by_front.push_back({i, hider, count});
  }
  return result;
}

/// The entries of a map from (object, hider) to counts.
inline std::vector<HiddenSamples> pairs_of(
    const std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t>& counts) {
  std::vector<HiddenSamples> pairs;
  for (const auto& [pair, count] : counts) pairs.push_back({pair.first, pair.second, count});
  return pairs;
}

/// Draws every two objects alone and compares them.
inline std::vector<HiddenSamples> reference_hidden_by_any(const Scene& scene, const View& view) {
  std::vector<Visible> alone;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) alone.push_back(draw_alone(scene, i, view));
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> counts;
  for (std::uint32_t i = 0; i < alone.size(); ++i)
    for (std::uint32_t j = i + 1; j < alone.size(); ++j)
      for (std::size_t s = 0; s < view.sample_count(); ++s) {
        if (alone[i].primitives[s] == no_primitive || alone[j].primitives[s] == no_primitive) continue;
        const bool is_i_before = alone[i].keys[s] >= alone[j].keys[s];
        ++counts[is_i_before ? std::pair(j, i) : std::pair(i, j)];
      }
  return pairs_of(counts);
}

/// Leaves out every object once.
inline std::vector<HiddenSamples> reference_hidden_only_by(const Scene& scene, const Visible& visible) {
  const Surfaces all(scene);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> counts;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    Scene rest = scene;
    rest.instances.erase(rest.instances.begin() + i);
    const Surfaces surfaces(rest);
    const Visible without = zbuffer(surfaces, visible.view, {.threads = 1});
    for (std::size_t s = 0; s < visible.primitives.size(); ++s) {
      if (without.primitives[s] == no_primitive || all.source(visible.primitives[s]).instance != i) continue;
      const std::uint32_t number = surfaces.source(without.primitives[s]).instance;
      ++counts[{number < i ? number : number + 1, i}];
    }
  }
  return pairs_of(counts);
}

}  // namespace frontmost::test
