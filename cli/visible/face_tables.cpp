// SPDX-License-Identifier: Apache-2.0
#include "cli/visible/face_tables.h"

#include <algorithm>

namespace frontmost::cli {
namespace {

/// Returns a column with the value of(row) of each row.
template <class Value, class Rows, class Of>
TableColumn column(const char* name, const Rows& rows, const Of& of) {
  std::vector<Value> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(of(row));
  return {name, std::move(values)};
}

void add_numbers(Table& table, const std::vector<VisibleFace>& faces) {
  table.columns.push_back(column<double>("pixels", faces, [](const VisibleFace& f) { return f.pixels; }));
  table.columns.push_back(column<double>("area", faces, [](const VisibleFace& f) { return f.area; }));
  table.columns.push_back(column<double>("solid_angle", faces, [](const VisibleFace& f) { return f.solid_angle; }));
}

void add_numbers(Table& table, const std::vector<SeenFace>& faces) {
  table.columns.push_back(column<std::uint32_t>("views", faces, [](const SeenFace& f) { return f.view_count; }));
  table.columns.push_back(column<std::uint32_t>("best_view", faces, [](const SeenFace& f) { return f.best_view; }));
  table.columns.push_back(column<double>("largest_share", faces, [](const SeenFace& f) { return f.largest_share; }));
  table.columns.push_back(column<double>("largest_pixels", faces, [](const SeenFace& f) { return f.largest_pixels; }));
}

template <class Face>
Table listed(const std::vector<Face>& faces, const Surfaces& surfaces) {
  std::vector<PrimitiveId> ids;
  for (const Face& face : faces) ids.push_back(face.id);
  Table table = origin_table_of(ids, surfaces);
  table.columns.insert(table.columns.begin(), TableColumn{"primitive", std::move(ids)});
  add_numbers(table, faces);
  return table;
}

/// Returns the visible share of the face's own area, 0 to 1.
double share_of(const SeenFace& face, const Surfaces&) { return face.largest_share; }
double share_of(const VisibleFace& face, const Surfaces& surfaces) {
  const auto corners = surfaces.corners(face.id);
  const glm::dvec3 a(corners[0]);
  const double doubled = glm::length(glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a));
  return std::min(2 * face.area / doubled, 1.0);
}

/// Returns a colour between five colours of the map "viridis" (N. Smith, S. van der Walt. 2015), which keeps its order
/// in grey.
glm::dvec3 color_of(double share) {
  constexpr double stops[5][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double at = share * 4;
  const int low = std::min(int(at), 3);
  const double rest = at - low;
  glm::dvec3 color;
  for (int k = 0; k < 3; ++k) color[k] = stops[low][k] + (stops[low + 1][k] - stops[low][k]) * rest;
  return color;
}

template <class Face>
Table colored(const std::vector<Face>& faces, const Surfaces& surfaces) {
  constexpr std::uint8_t grey = 128;
  const std::size_t count = surfaces.primitive_count();
  std::vector<PrimitiveId> ids(count);
  std::vector<Face> all(count);
  std::vector<std::uint8_t> colors[3];
  for (auto& channel : colors) channel.assign(count, grey);
  for (std::size_t i = 0; i < count; ++i) ids[i] = PrimitiveId(i);
  for (const Face& face : faces) {
    all[face.id] = face;
    const glm::dvec3 color = color_of(share_of(face, surfaces));
    for (int k = 0; k < 3; ++k) colors[k][face.id] = std::uint8_t(color[k] + 0.5);
  }
  Table table = origin_table_of(ids, surfaces);
  add_numbers(table, all);
  constexpr const char* names[] = {"red", "green", "blue"};
  for (int k = 0; k < 3; ++k) table.columns.push_back({names[k], std::move(colors[k])});
  return table;
}

}  // namespace

Table table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces) { return listed(faces, surfaces); }
Table table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces) { return listed(faces, surfaces); }
Table colored_table_of(const std::vector<VisibleFace>& faces, const Surfaces& surfaces) {
  return colored(faces, surfaces);
}
Table colored_table_of(const std::vector<SeenFace>& faces, const Surfaces& surfaces) {
  return colored(faces, surfaces);
}

Table origin_table_of(const std::vector<PrimitiveId>& ids, const Surfaces& surfaces) {
  return {{column<std::uint32_t>("object", ids, [&](PrimitiveId id) { return surfaces.source(id).instance; }),
           column<std::uint32_t>("triangle", ids, [&](PrimitiveId id) { return surfaces.source(id).triangle; })}};
}

}  // namespace frontmost::cli
