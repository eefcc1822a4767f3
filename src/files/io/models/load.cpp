// SPDX-License-Identifier: Apache-2.0
// load(): gets the bytes, recognizes the format, calls its reader and checks the result.
//
//   path --> bytes (mapped, or all of a pipe) --> format --> reader --> validate() --> an origin, warnings with names
//            "builtin:" has none                  by name,
//                                                 else by content
//
// Work that is the same for all formats is done here, so that readers only parse bytes.
#include "base/parallel.h"
#include "io/models/reader.h"

namespace frontmost {
namespace {

/// A remark about the points of a scene without triangles.
std::string points_told(const Scene& scene) {
  std::size_t points = 0;
  for (const Mesh& mesh : scene.meshes) points += mesh.positions.size();
  return points == 0 ? "" : "; its " + std::to_string(points) + " points have no surface that hides anything";
}

constexpr std::string_view builtin_prefix = "builtin:";

Scene read(ModelFormat format, Bytes bytes, const ModelSource& source) {
  switch (format) {
    case ModelFormat::stl: return read_stl(bytes, source);
    case ModelFormat::ply: return read_ply(bytes, source);
    case ModelFormat::obj: return read_obj(bytes, source);
    case ModelFormat::off: return read_off(bytes, source);
    case ModelFormat::gltf: return read_gltf(bytes, source);
    case ModelFormat::threemf: return read_3mf(bytes, source);
    case ModelFormat::scene: return read_scene_file(bytes, source);
  }
  throw Error(ErrorCode::bad_argument, source.name(), "", "not a model format");
}

[[noreturn]] void refuse(const ModelSource& source, const std::string& why) {
  throw Error(ErrorCode::unsupported, source.name(), "", why);
}

Scene read_any(Bytes bytes, ModelSource& source, std::optional<ModelFormat> format, const LoadOptions& options) {
  if (bytes.empty()) throw Error(ErrorCode::file_malformed, source.name(), "", "the file is empty");
  if (!format) format = format_of_content(bytes);
  if (!format)
    refuse(source, conversion_by_content(bytes).value_or(
                       "not a model that Frontmost can read (STL, PLY, OBJ, OFF, glTF, GLB, 3MF, a scene file)"));
  if (*format == ModelFormat::scene) source.allow_outside(options.allow_outside);
  report_progress(source.execution(), "load", 0);
  Scene scene = read(*format, bytes, source);
  scene.source.format = format;
  scene.name = source.stem();
  scene.up = options.up.value_or(*format == ModelFormat::scene ? scene.up : default_up(*format));
  try {
    validate(scene);
  } catch (const Error& error) {
    // validate() knows only the scene's short name.
    throw error.within(source.name());
  }
  // Readers of text may have chosen an origin already.
  if (scene.origin == glm::dvec3(0)) set_origin(scene, fitting_origin(scene));
  if (triangle_count(scene) == 0) scene.warnings.push_back(no_triangles_warning + points_told(scene));
  for (std::string& warning : scene.warnings) warning = source.with_name(warning);
  report_progress(source.execution(), "load", 1);
  return scene;
}

}  // namespace

Scene load_named(const std::string& reference, const ModelSource& scene_file) {
  if (reference.starts_with(builtin_prefix)) return builtin(std::string_view(reference).substr(builtin_prefix.size()));
  const std::filesystem::path path = scene_file.path_of(reference);
  const InputFile file = scene_file.open(reference, max_file_bytes);
  const auto opened = std::make_shared<OpenedFiles>(path);
  ModelSource source(printable(reference), scene_file.execution(), file, path, opened);
  source.decode_images_by(scene_file.image_decoder());
  if (const auto conversion = conversion_by_suffix(reference)) refuse(source, *conversion);
  auto format = format_of_suffix(reference);
  if (!format) format = format_of_content(file.bytes());
  if (format == ModelFormat::scene) refuse(source, "is a scene file itself; scene files place models alone");
  Scene scene = read_any(file.bytes(), source, format, {});
  scene.source.files = opened->paths();
  return scene;
}

Scene load(const std::string& path, const LoadOptions& options, const Execution& execution) {
  if (path.starts_with(builtin_prefix)) {
    Scene scene = builtin(std::string_view(path).substr(builtin_prefix.size()));
    if (options.up) scene.up = *options.up;
    return scene;
  }
  if (path == "-") {
    const InputFile file = InputFile::standard_input("standard input");
    ModelSource source("standard input", execution);
    source.decode_images_by(options.image_decoder);
    Scene scene = read_any(file.bytes(), source, options.format, options);
    scene.name = "stdin";
    return scene;
  }
  const InputFile file = InputFile::open(path, path);
  const auto opened = std::make_shared<OpenedFiles>(path);
  ModelSource source(path, execution, file, path, opened);
  source.decode_images_by(options.image_decoder);
  if (const auto conversion = options.format ? std::nullopt : conversion_by_suffix(path)) refuse(source, *conversion);
  const auto format = options.format ? options.format : format_of_suffix(path);
  Scene scene = read_any(file.bytes(), source, format, options);
  for (std::filesystem::path& used : scene.source.files) opened->add(std::move(used));  // of a scene file's models
  scene.source.files = opened->paths();
  return scene;
}

Scene load(std::span<const std::byte> bytes, const std::string& name, const LoadOptions& options,
           const Execution& execution) {
  ModelSource source(name, execution);
  source.decode_images_by(options.image_decoder);
  return read_any(bytes, source, options.format, options);
}

}  // namespace frontmost
