// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect/info_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/console.h"

namespace frontmost::cli {
namespace {

constexpr double degrees_per_radian = 57.29577951308232;
constexpr std::size_t lines_shown = 20;  // of objects, materials, cameras; JSON has all
constexpr std::string_view axis_names[] = {"+x", "+y", "+z", "-x", "-y", "-z"};
constexpr std::string_view alpha_names[] = {"opaque", "mask", "blend"};

struct NamedCount {
  std::string_view key, words;
  std::uint64_t Oddities::*count;
};
constexpr NamedCount oddities[] = {
    {"non_finite_triangles", "triangles with corners that are not finite", &Oddities::non_finite_triangles},
    {"degenerate_triangles", "degenerate triangles", &Oddities::degenerate_triangles},
    {"duplicate_triangles", "duplicate triangles", &Oddities::duplicate_triangles},
    {"boundary_edges", "boundary edges", &Oddities::boundary_edges},
    {"non_manifold_edges", "non-manifold edges", &Oddities::non_manifold_edges},
    {"inconsistent_edges", "edges with inconsistent winding", &Oddities::inconsistent_edges}};

Json odd_json(const Oddities& odd) {
  Json json;
  for (const NamedCount& one : oddities) json[std::string(one.key)] = odd.*one.count;
  return json;
}

/// Null for a model without a finite point.
Json box_json(const Box& box) {
  if (box.is_empty()) return nullptr;
  return {{"low", to_json(box.low)}, {"high", to_json(box.high)}};
}

Json mesh_json(const MeshReport& mesh) {
  Json json = {{"name", mesh.name},
               {"triangles", mesh.triangles},
               {"vertices", mesh.vertices},
               {"positions", mesh.positions},
               {"faces", mesh.faces},
               {"normals", mesh.has_normals},
               {"texcoords", mesh.has_texcoords},
               {"colors", mesh.has_colors}};
  json["materials"] = Json::array();
  for (const MaterialUse& use : mesh.materials) {
    json["materials"].push_back(
        {{"material", use.material == no_index ? Json(nullptr) : Json(use.material)}, {"triangles", use.triangles}});
  }
  json["odd"] = odd_json(mesh.odd);
  json["pieces"] = mesh.pieces;
  json["closed"] = mesh.closed;
  json["genus"] = mesh.genus ? Json(*mesh.genus) : Json(nullptr);
  return json;
}

Json object_json(const ObjectReport& object) {
  return {{"name", object.name},
          {"mesh", object.mesh},
          {"triangles", object.triangles},
          {"bounds", box_json(object.bounds)}};
}

Json material_json(const MaterialReport& material) {
  return {{"name", material.name},
          {"triangles", material.triangles},
          {"textures", material.textures},
          {"alpha", alpha_names[int(material.alpha)]},
          {"double_sided", material.double_sided}};
}

Json camera_json(const CameraReport& camera) {
  Json json = {{"name", camera.name},
               {"position", to_json(camera.position)},
               {"direction", to_json(camera.direction)},
               {"up", to_json(camera.up)},
               {"projection", camera.orthographic ? "orthographic" : "perspective"}};
  if (camera.orthographic) json["height"] = camera.vertical;
  if (!camera.orthographic) json["view_angle_degrees"] = camera.vertical * degrees_per_radian;
  return json;
}

/// Turns every element of a list; an empty list stays a list.
template <class T, class Turn>
Json list(const std::vector<T>& elements, const Turn& turn) {
  Json result = Json::array();
  for (const T& element : elements) result.push_back(turn(element));
  return result;
}

/// A heading and a line for each element; the first few, then how many more.
template <class T, class Line>
std::string section(std::string_view heading, const std::vector<T>& elements, const Line& line) {
  if (elements.empty()) return {};
  std::string text = fmt::format("\n{} ({})\n", heading, elements.size());
  for (std::size_t i = 0; i < elements.size() && i < lines_shown; ++i)
    text += fmt::format("  {:>4}  {}\n", i, line(elements[i]));
  if (elements.size() > lines_shown)
    text += fmt::format("        and {} more; --json lists them\n", elements.size() - lines_shown);
  return text;
}

std::string vector_text(const glm::dvec3& v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); }

std::string camera_line(const CameraReport& camera) {
  const std::string width = camera.orthographic ? fmt::format("orthographic, {:.6g} high", camera.vertical)
                                                : fmt::format("{:.4g} degrees", camera.vertical * degrees_per_radian);
  return fmt::format("{:24} {}, at {}", printable_name(camera.name), width, vector_text(camera.position));
}

std::string odd_lines(const SceneReport& report) {
  std::string text;
  for (const NamedCount& one : oddities) {
    if (report.odd.*one.count > 0) text += fmt::format("  {:>12}  {}\n", report.odd.*one.count, one.words);
  }
  return text.empty() ? "\nnothing odd\n" : "\nodd\n" + text;
}

}  // namespace

Json info_json(const SceneReport& report) {
  Json json = {{"name", report.name},
               {"up", axis_names[int(report.up)]},
               {"triangles", report.triangles},
               {"stored_triangles", report.stored_triangles},
               {"vertices", report.vertices},
               {"textures", report.texture_count},
               {"bounds", box_json(report.bounds)}};
  json["odd"] = odd_json(report.odd);
  json["meshes"] = list(report.meshes, mesh_json);
  json["objects"] = list(report.objects, object_json);
  json["materials"] = list(report.materials, material_json);
  json["cameras"] = list(report.cameras, camera_json);
  json["warnings"] = report.warnings;
  return json;
}

std::string info_text(const SceneReport& report) {
  std::string text = fmt::format("{}\n  triangles  {}", printable_name(report.name), report.triangles);
  if (report.stored_triangles != report.triangles) text += fmt::format(" ({} stored)", report.stored_triangles);
  text += fmt::format("\n  vertices   {}\n  textures   {}\n  up         {}\n", report.vertices, report.texture_count,
                      axis_names[int(report.up)]);
  if (report.bounds.is_empty()) {
    text += "  bounds     none\n";
  } else {
    text += fmt::format("  bounds     {} to {}\n", vector_text(report.bounds.low), vector_text(report.bounds.high));
  }
  const std::size_t closed = std::size_t(
      std::count_if(report.meshes.begin(), report.meshes.end(), [](const MeshReport& mesh) { return mesh.closed; }));
  text += fmt::format("  meshes     {}, {} closed\n", report.meshes.size(), closed);
  text += section("objects", report.objects, [](const ObjectReport& object) {
    return fmt::format("{:24} {} triangles", printable_name(object.name), object.triangles);
  });
  text += section("materials", report.materials, [](const MaterialReport& material) {
    return fmt::format("{:24} {} triangles, {} textures{}{}", printable_name(material.name), material.triangles,
                       material.textures, material.alpha == Material::Alpha::opaque ? "" : ", ",
                       material.alpha == Material::Alpha::opaque ? "" : alpha_names[int(material.alpha)]);
  });
  text += section("cameras", report.cameras, camera_line);
  return text + odd_lines(report);
}

}  // namespace frontmost::cli
