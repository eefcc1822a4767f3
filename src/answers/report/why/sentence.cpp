// SPDX-License-Identifier: Apache-2.0
// Explanations in words. Rounding keeps numbers true: 100 % is written only if the share is the whole, and 0 % only if
// it is empty.

#include <cmath>
#include <unordered_map>

#include "base/decimal.h"
#include "frontmost/report.h"

namespace frontmost {
namespace {

constexpr std::string_view kReasonNames[] = {"empty",      "behind_eye",  "nearer_than_near", "beyond_far", "outside",
                                             "faces_away", "transparent", "no_sample",        "hidden",     "seen"};
constexpr std::string_view kRemedyNames[] = {"none",        "set_near", "set_far",  "turn", "move", "show_both_sides",
                                             "make_opaque", "enlarge",  "take_away"};
constexpr std::size_t kMostNamed = 3;  // objects in one text

std::string share_of_whole(double share) {
  const double percent = std::round(100 * share);
  if (percent < 1 && share > 0) return "under 1 %";
  if (percent >= 100 && share < 1) return "over 99 %";
  return general_text(percent, 3) + " %";
}

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 < parts.size() ? ", " : " and ") + parts[i];
  return text;
}

std::string other_objects(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " other object" : " other objects");
}

/// The hiders with their shares. `whole` is the whole to which shares refer, as a multiple of the samples in frame.
std::string hiders_text(const std::vector<HiderShare>& hiders, double whole, const ObjectNames& names) {
  std::vector<std::string> parts;
  double rest = 0;
  for (std::size_t i = 0; i < hiders.size(); ++i) {
    const HiderShare& hider = hiders[i];
    if (i < kMostNamed || hiders.size() == kMostNamed + 1)
      parts.push_back(names[hider.object] + ' ' + share_of_whole(hider.share / whole));
    else
      rest += hider.share;
  }
  if (rest > 0) parts.push_back(other_objects(hiders.size() - kMostNamed) + ' ' + share_of_whole(rest / whole));
  return listed(parts);
}

struct TrianglePlace {
  std::uint64_t count;
  const char* where;
};

/// The places of the triangles that are not in view, without empty ones.
std::vector<TrianglePlace> places_of(const TrianglePlaces& t) {
  std::vector<TrianglePlace> places;
  for (const TrianglePlace& place :
       {TrianglePlace{t.behind_eye, "behind the eye"}, TrianglePlace{t.nearer_than_near, "nearer than near"},
        TrianglePlace{t.beyond_far, "beyond far"}, TrianglePlace{t.left, "on the left"},
        TrianglePlace{t.right, "on the right"}, TrianglePlace{t.above, "above"}, TrianglePlace{t.below, "below"},
        TrianglePlace{t.past_corner, "past a corner"}})
    if (place.count > 0) places.push_back(place);
  return places;
}

/// The counts by place, out of all triangles that have an area, such as "; of its 12 triangles 4 behind the eye and 8
/// on the left". Leaves out the place `but`. Empty if no triangle is at another place.
std::string mixture_text(const TrianglePlaces& triangles, std::string_view but = "") {
  std::vector<std::string> parts;
  for (const TrianglePlace& place : places_of(triangles))
    if (place.where != but) parts.push_back(std::to_string(place.count) + ' ' + place.where);
  if (parts.empty()) return "";
  return "; of its " + std::to_string(triangles.total() - triangles.empty) + " triangles " + listed(parts);
}

std::string seen_text(const Explanation& why, const ObjectNames& names) {
  std::string text = "seen, " + (why.visible_share == 1 ? "all" : share_of_whole(why.visible_share)) + " of it";
  if (why.cut_share > 0) text += ", " + share_of_whole(why.cut_share) + " beyond the frame";
  if (!why.hiders.empty()) text += ", the rest hidden by " + hiders_text(why.hiders, 1 / (1 - why.cut_share), names);
  return text;
}

/// The directions of a turn, or those of a move in scene units.
std::string directions_text(const Remedy& remedy) {
  const auto part = [&](double amount, const char* positive, const char* negative) {
    const bool is_turn = remedy.kind == RemedyKind::turn;
    std::string size = general_text(std::abs(is_turn ? glm::degrees(amount) : amount), is_turn ? 4 : 6);
    if (is_turn) size += size == "1" ? " degree" : " degrees";
    return size + (amount > 0 ? positive : negative);
  };
  std::vector<std::string> parts;
  if (remedy.right != 0) parts.push_back(part(remedy.right, " to the right", " to the left"));
  if (remedy.up != 0) parts.push_back(part(remedy.up, " up", " down"));
  return listed(parts);
}

std::string taken_text(const std::vector<std::uint32_t>& objects, const ObjectNames& names) {
  std::vector<std::string> parts;
  for (const std::uint32_t object : objects)
    if (parts.size() < kMostNamed || objects.size() == kMostNamed + 1) parts.push_back(names[object]);
  if (parts.size() < objects.size()) parts.push_back(other_objects(objects.size() - parts.size()));
  return listed(parts);
}

}  // namespace

ObjectNames::ObjectNames(const Scene& scene) : scene_(&scene), is_shared_(scene.instances.size()) {
  std::unordered_map<std::string_view, std::uint32_t> first;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const auto [found, is_new] = first.try_emplace(scene.instances[i].name, i);
    if (!is_new) is_shared_[i] = is_shared_[found->second] = true;
  }
}

std::string ObjectNames::operator[](std::uint32_t object) const {
  const std::string& name = scene_->instances[object].name;
  if (name.empty()) return "object " + std::to_string(object);
  return printable_text(name) + (is_shared_[object] ? " #" + std::to_string(object) : "");
}

std::string_view name(SightReason reason) { return kReasonNames[std::size_t(reason)]; }
std::string_view name(RemedyKind kind) { return kRemedyNames[std::size_t(kind)]; }

std::string reason_text(const Explanation& why, const ObjectNames& names) {
  const TrianglePlaces& triangles = why.triangles;
  switch (why.reason) {
    case SightReason::empty:
      if (triangles.total() == 0) return "empty: it has no triangles";
      if (triangles.total() == 1) return "empty: its triangle has no area";
      return "empty: none of its " + std::to_string(triangles.total()) + " triangles has an area";
    case SightReason::behind_eye: return "behind the eye";
    case SightReason::nearer_than_near: return "nearer than near" + mixture_text(triangles, "nearer than near");
    case SightReason::beyond_far: return "beyond far" + mixture_text(triangles, "beyond far");
    case SightReason::outside:
      if (const std::vector<TrianglePlace> places = places_of(triangles); places.size() == 1)
        return std::string("outside: ") + places[0].where + " of the picture";
      return "outside of the picture" + mixture_text(triangles);
    case SightReason::faces_away: return "turned away, and culled" + mixture_text(triangles);
    case SightReason::transparent:
      return std::string("transparent: ") + (why.is_all_holes ? "every sample of it is a hole" : "its opacity is 0") +
             mixture_text(triangles);
    case SightReason::no_sample:
      if (why.pixels == 0) return "seen edge on, so that it has no area" + mixture_text(triangles);
      return "between the samples: its " + general_text(why.pixels, 3) + " square pixels contain no sample" +
             mixture_text(triangles);
    case SightReason::hidden: return "hidden by " + hiders_text(why.hiders, 1, names) + mixture_text(triangles);
    case SightReason::seen: return seen_text(why, names) + mixture_text(triangles);
  }
  return "";
}

std::string remedy_text(const Explanation& why, const ObjectNames& names) {
  const Remedy& remedy = why.remedy;
  switch (remedy.kind) {
    case RemedyKind::none: return "";
    case RemedyKind::set_near: return "set near to " + general_text(remedy.value, 6);
    case RemedyKind::set_far: return "set far to " + general_text(remedy.value, 6);
    case RemedyKind::turn: return "turn the camera " + directions_text(remedy);
    case RemedyKind::move: return "move the camera " + directions_text(remedy);
    case RemedyKind::show_both_sides: return "cull nothing";
    case RemedyKind::make_opaque: return "make its material opaque";
    case RemedyKind::enlarge: return "draw " + general_text(remedy.value, 6) + " times as many pixels each way";
    case RemedyKind::take_away: return "take " + taken_text(remedy.objects, names) + " away";
  }
  return "";
}

std::string sentence(const Explanation& why, const ObjectNames& names) {
  const std::string remedy = remedy_text(why, names);
  return names[why.object] + " is " + reason_text(why, names) + (remedy.empty() ? "" : ": " + remedy) + ".";
}

}  // namespace frontmost
