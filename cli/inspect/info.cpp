// SPDX-License-Identifier: Apache-2.0
// frontmost info: the contents of a model, as text and as JSON, and its probable unit of length.
#include <fmt/format.h>
#include <frontmost/lines.h>
#include <frontmost/report.h>
#include <frontmost/scene.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/json.h"
#include "cli/values.h"
#include "cli/view/camera_report.h"

namespace frontmost::cli {
namespace {

/// The length of the model's unit.
struct ModelUnit {
  double metres;
  bool is_guess;
};

/// The number of cylinders that find_rounds() finds, holes included.
struct CylinderCount {
  std::size_t all = 0, holes = 0;
};
constexpr std::uint64_t most_for_cylinders = 200'000;  // triangles, which take a fifth of a second

constexpr std::size_t lines_shown = 20;  // most lines for objects, materials, cameras or lights; JSON has all
constexpr std::string_view axis_names[] = {"+x", "+y", "+z", "-x", "-y", "-z"};
constexpr std::string_view alpha_names[] = {"opaque", "mask", "blend"};
constexpr std::string_view light_names[] = {"sun", "point", "spot"};

struct NamedCount {
  std::string_view key, words;
  std::uint64_t Oddities::*count;
};
constexpr NamedCount oddities[] = {
    {"non_finite_triangles", "triangles with vertices that are not finite", &Oddities::non_finite_triangles},
    {"degenerate_triangles", "degenerate triangles", &Oddities::degenerate_triangles},
    {"duplicate_triangles", "duplicate triangles", &Oddities::duplicate_triangles},
    {"boundary_edges", "boundary edges", &Oddities::boundary_edges},
    {"non_manifold_edges", "non-manifold edges", &Oddities::non_manifold_edges},
    {"inconsistent_edges", "edges with inconsistent winding", &Oddities::inconsistent_edges}};

struct NamedLength {
  std::string_view name;
  double metres;
};
/// Units that files name.
constexpr NamedLength units[] = {{"micron", 1e-6}, {"millimetre", 1e-3}, {"centimetre", 1e-2},
                                 {"inch", 0.0254}, {"foot", 0.3048},     {"metre", 1}};

std::string_view name_of(const ModelUnit& unit) {
  for (const NamedLength& named : units)
    if (std::abs(named.metres - unit.metres) <= 1e-9 * unit.metres) return named.name;
  return "";
}

Json odd_json(const Oddities& odd) {
  Json json;
  for (const NamedCount& one : oddities) json[std::string(one.key)] = odd.*one.count;
  return json;
}

/// Returns the corners of a box, or null for a model without a finite point.
Json box_json(const Box& box, const glm::dvec3& origin) {
  if (box.is_empty()) return nullptr;
  return {{"low", to_json(in_file(box.low, origin))}, {"high", to_json(in_file(box.high, origin))}};
}

glm::dvec3 size_of(const Box& box) { return glm::dvec3(box.high) - glm::dvec3(box.low); }

Json size_json(const Box& box) { return box.is_empty() ? Json(nullptr) : to_json(size_of(box)); }

Json unit_json(const std::optional<ModelUnit>& unit) {
  if (!unit) return nullptr;
  return {{"name", name_of(*unit)}, {"metres", unit->metres}, {"guess", unit->is_guess}};
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

Json object_json(const ObjectReport& object, const glm::dvec3& origin) {
  return {{"name", object.name},
          {"mesh", object.mesh},
          {"triangles", object.triangles},
          {"bounds", box_json(object.bounds, origin)},
          {"size", size_json(object.bounds)},
          {"area", object.area},
          {"volume", object.volume ? Json(*object.volume) : Json(nullptr)}};
}

Json material_json(const MaterialReport& material) {
  return {{"name", material.name},
          {"triangles", material.triangles},
          {"textures", material.textures},
          {"alpha", alpha_names[int(material.alpha)]},
          {"double_sided", material.double_sided}};
}

Json camera_json(const CameraReport& camera, const glm::dvec3& origin) {
  Json json = {{"name", camera.name},
               {"position", to_json(in_file(camera.position, origin))},
               {"direction", to_json(camera.direction)},
               {"up", to_json(camera.up)},
               {"projection", camera.orthographic ? "orthographic" : "perspective"}};
  if (camera.orthographic) json["height"] = camera.vertical;
  if (!camera.orthographic) json["view_angle_degrees"] = camera.vertical * degrees_per_radian;
  return json;
}

Json light_json(const LightReport& light, const glm::dvec3& origin) {
  Json json = {
      {"name", light.name}, {"kind", light_names[int(light.kind)]}, {"color", to_json(glm::dvec3(light.color))}};
  json[light.kind == Light::Kind::sun ? "lux" : "candela"] = light.intensity;
  if (light.kind != Light::Kind::sun) json["position"] = to_json(in_file(light.position, origin));
  if (light.kind != Light::Kind::point) json["direction"] = to_json(light.direction);
  if (light.range) json["range"] = *light.range;
  if (light.kind != Light::Kind::spot) return json;
  json["inner_cone_degrees"] = light.inner_cone * degrees_per_radian;
  json["outer_cone_degrees"] = light.outer_cone * degrees_per_radian;
  return json;
}

/// Converts each element of a list. An empty list stays a list.
template <class T, class Turn>
Json list(const std::vector<T>& elements, const Turn& turn) {
  Json result = Json::array();
  for (const T& element : elements) result.push_back(turn(element));
  return result;
}

/// Returns a heading, a line for each of the first elements, and the number of the others.
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

std::string camera_line(const CameraReport& camera, const glm::dvec3& origin) {
  const std::string width = camera.orthographic ? fmt::format("orthographic, {:.6g} high", camera.vertical)
                                                : fmt::format("{:.4g} degrees", camera.vertical * degrees_per_radian);
  return fmt::format("{:24} {}, at {}", printable_name(camera.name), width, place_text(camera.position, origin));
}

std::string light_line(const LightReport& light, const glm::dvec3& origin) {
  const bool is_sun = light.kind == Light::Kind::sun;
  std::string text = fmt::format("{:24} {}, {:.4g} {}", printable_name(light.name), light_names[int(light.kind)],
                                 light.intensity, is_sun ? "lux" : "candela");
  if (light.kind == Light::Kind::spot)
    text += fmt::format(", cone {:.4g} degrees", 2 * light.outer_cone * degrees_per_radian);
  if (!is_sun) text += ", at " + place_text(light.position, origin);
  return text;
}

/// Returns a line about positions that floats may round too coarsely, or about the origin that prevents this.
std::string rounding_line(const SceneReport& report) {
  constexpr double coarse = 1e-6;  // part of the diagonal: a thousandth of a pixel in a picture of the whole model
  constexpr double wide = 1e-3;    // in the model's unit: coordinates beyond 16384 are rounded by as much
  const bool is_away = report.origin != glm::dvec3(0);
  const double worth_telling = std::min(wide, coarse * double(report.bounds.diagonal()));
  if (!is_away && report.rounding <= worth_telling) return {};
  const std::string about = is_away ? ", kept about " + place_text(glm::dvec3(0), report.origin) : "";
  return fmt::format("  rounding   {:.2g} at most{}\n", report.rounding, about);
}

/// Returns the meshes with the highest counts of an oddity, in descending order.
std::string odd_meshes(const SceneReport& report, std::uint64_t Oddities::*count) {
  constexpr std::size_t meshes_shown = 5;
  std::vector<std::size_t> odd;
  for (std::size_t m = 0; m < report.meshes.size(); ++m)
    if (report.meshes[m].odd.*count > 0) odd.push_back(m);
  const auto has_more = [&](std::size_t a, std::size_t b) {
    return report.meshes[a].odd.*count > report.meshes[b].odd.*count;
  };
  std::stable_sort(odd.begin(), odd.end(), has_more);
  std::string text;
  for (std::size_t i = 0; i < odd.size() && i < meshes_shown; ++i) {
    const MeshReport& mesh = report.meshes[odd[i]];
    const std::string name = mesh.name.empty() ? fmt::format("mesh {}", odd[i]) : printable_name(mesh.name);
    text += fmt::format("{:>16}  in {}\n", mesh.odd.*count, name);
  }
  if (odd.size() > meshes_shown)
    text += fmt::format("                  and in {} more; --json lists them\n", odd.size() - meshes_shown);
  return text;
}

std::string odd_lines(const SceneReport& report) {
  std::string text;
  for (const NamedCount& one : oddities) {
    if (report.odd.*one.count == 0) continue;
    text += fmt::format("  {:>12}  {}\n", report.odd.*one.count, one.words);
    // A single mesh has all of them.
    if (report.meshes.size() > 1) text += odd_meshes(report, one.count);
  }
  return text.empty() ? "\nnothing odd\n" : "\nodd\n" + text;
}

std::string unit_line(const std::optional<ModelUnit>& unit, const Box& bounds) {
  if (!unit) return "";
  const glm::dvec3 metres = size_of(bounds) * unit->metres;
  const double greatest = std::max({metres.x, metres.y, metres.z});
  const NamedLength shown = greatest < 0.001 ? NamedLength{"um", 1e-6}
                            : greatest < 2   ? NamedLength{"mm", 1e-3}
                                             : NamedLength{"m", 1};
  const glm::dvec3 size = metres / shown.metres;
  const std::string_view name = name_of(*unit);
  return fmt::format("  unit       {}{}: {:.4g} x {:.4g} x {:.4g} {}\n",
                     name.empty() ? fmt::format("{:.6g} m", unit->metres) : std::string(name),
                     unit->is_guess ? ", a guess" : "", size.x, size.y, size.z, shown.name);
}

/// Returns the file's own unit, or else the likely unit for the model's size. Returns nothing if several units are
/// likely.
std::optional<ModelUnit> unit_of_model(const SceneReport& report, std::optional<double> metres_per_unit) {
  if (report.bounds.is_empty()) return std::nullopt;
  if (metres_per_unit) return ModelUnit{*metres_per_unit, false};
  const std::vector<double> likely = likely_units(report.bounds);
  return likely.size() == 1 ? std::optional(ModelUnit{likely.front(), true}) : std::nullopt;
}

/// Counts the cylinders. Returns nothing for models with too many triangles.
std::optional<CylinderCount> count_cylinders(const Scene& scene, const Execution& execution) {
  if (triangle_count(scene) > most_for_cylinders) return std::nullopt;
  constexpr double whole_turn = 2 * glm::pi<double>() - 0.01;
  CylinderCount count;
  for (const Round& round : find_rounds(Surfaces(scene, execution), execution).rounds) {
    if (round.kind != RoundKind::cylinder) continue;
    ++count.all;
    count.holes += round.is_hollow && round.turn > whole_turn;
  }
  return count;
}

std::string cylinder_line(const std::optional<CylinderCount>& count) {
  if (!count) return fmt::format("  cylinders  not counted in more than {} triangles\n", grouped(most_for_cylinders));
  if (count->all == 0) return "";
  return fmt::format("  cylinders  {}, {} of them holes\n", count->all, count->holes);
}

Json info_json(const SceneReport& report, const std::optional<ModelUnit>& unit,
               const std::optional<CylinderCount>& cylinders) {
  Json json = {{"name", report.name},
               {"up", axis_names[int(report.up)]},
               {"triangles", report.triangles},
               {"stored_triangles", report.stored_triangles},
               {"vertices", report.vertices},
               {"textures", report.texture_count},
               {"bounds", box_json(report.bounds, report.origin)},
               {"size", size_json(report.bounds)},
               {"area", report.area},
               {"volume", report.volume ? Json(*report.volume) : Json(nullptr)},
               {"unit", unit_json(unit)},
               {"cylinders", cylinders ? Json(cylinders->all) : Json(nullptr)},
               {"holes", cylinders ? Json(cylinders->holes) : Json(nullptr)},
               {"origin", to_json(report.origin)},
               {"rounding", report.rounding}};
  json["odd"] = odd_json(report.odd);
  json["meshes"] = list(report.meshes, mesh_json);
  json["objects"] =
      list(report.objects, [&](const ObjectReport& object) { return object_json(object, report.origin); });
  json["materials"] = list(report.materials, material_json);
  json["cameras"] =
      list(report.cameras, [&](const CameraReport& camera) { return camera_json(camera, report.origin); });
  json["lights"] = list(report.lights, [&](const LightReport& light) { return light_json(light, report.origin); });
  json["warnings"] = report.warnings;
  return json;
}

std::string info_text(const SceneReport& report, const std::optional<ModelUnit>& unit,
                      const std::optional<CylinderCount>& cylinders) {
  std::string text = fmt::format("{}\n  triangles  {}", printable_name(report.name), report.triangles);
  if (report.stored_triangles != report.triangles) text += fmt::format(" ({} stored)", report.stored_triangles);
  text += fmt::format("\n  vertices   {}\n  textures   {}\n  up         {}\n", report.vertices, report.texture_count,
                      axis_names[int(report.up)]);
  if (report.bounds.is_empty()) {
    text += "  bounds     none\n";
  } else {
    text += fmt::format("  bounds     {} to {}\n", place_text(report.bounds.low, report.origin),
                        place_text(report.bounds.high, report.origin));
    const glm::dvec3 size = size_of(report.bounds);
    text += fmt::format("  size       {:.6g} x {:.6g} x {:.6g}\n", size.x, size.y, size.z);
    text += fmt::format("  area       {:.6g}", report.area);
    if (report.volume) text += fmt::format(", volume {:.6g} of the closed meshes", *report.volume);
    text += "\n" + unit_line(unit, report.bounds);
    text += rounding_line(report);
  }
  const std::size_t closed = std::size_t(
      std::count_if(report.meshes.begin(), report.meshes.end(), [](const MeshReport& mesh) { return mesh.closed; }));
  text += fmt::format("  meshes     {}, {} closed\n", report.meshes.size(), closed) + cylinder_line(cylinders);
  text += section("objects", report.objects, [](const ObjectReport& object) {
    return fmt::format("{:24} {} triangles", printable_name(object.name), object.triangles);
  });
  text += section("materials", report.materials, [](const MaterialReport& material) {
    return fmt::format("{:24} {} triangles, {} textures{}{}", printable_name(material.name), material.triangles,
                       material.textures, material.alpha == Material::Alpha::opaque ? "" : ", ",
                       material.alpha == Material::Alpha::opaque ? "" : alpha_names[int(material.alpha)]);
  });
  text += section("cameras", report.cameras,
                  [&](const CameraReport& camera) { return camera_line(camera, report.origin); });
  text += section("lights", report.lights, [&](const LightReport& light) { return light_line(light, report.origin); });
  return text + odd_lines(report);
}

}  // namespace

int run_info(const Settings& settings) {
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const SceneReport report = inspect(scene, execution);
  const std::optional<CylinderCount> cylinders = count_cylinders(scene, execution);
  // Built-in scenes have no size in the real world.
  const bool is_file = scene.source.format.has_value();
  const auto unit = is_file ? unit_of_model(report, scene.source.metres_per_unit) : std::nullopt;
  progress.clear();
  print(settings.run.json ? dump(info_json(report, unit, cylinders)) : info_text(report, unit, cylinders));
  return exit_done;
}

}  // namespace frontmost::cli
