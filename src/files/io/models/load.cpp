// SPDX-License-Identifier: Apache-2.0
// load(): gets the bytes, recognizes the format, calls its reader and checks the result. The suffix decides the format
// if there is one. Standard input and memory have no name, so their first bytes decide: first by magic words, then by
// typical contents.
//
//   path --> bytes (mapped, or all of a pipe) --> format --> reader --> validate() --> an origin, warnings with names
//            "builtin:" has none                  by name,
//                                                 else by content
//
// Work that is the same for all formats is done here, so that readers only parse bytes. Streams are opened likewise; a
// pipe cannot be read again, so the bytes that tell its format are passed on to the reader.
#include <algorithm>
#include <array>
#include <cstring>

#include "base/parallel.h"
#include "io/models/model_stream.h"
#include "io/models/reader.h"

namespace frontmost {
namespace {

/// Returns the first bytes as text, without leading white space and comment lines.
std::string_view first_statement(Bytes bytes) {
  constexpr std::size_t window = 1 << 16;
  std::string_view text = text_of(bytes.first(std::min(bytes.size(), window)));
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (!text.starts_with('#')) return text;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || std::strchr(" \t\r\n", text[word.size()]) != nullptr);
}

bool looks_like_off(std::string_view text) {
  // The first word is [ST][C][N][4][n]OFF, its prefixes in any order. The first count may follow without a blank.
  text.remove_prefix(std::min(text.find_first_not_of("STCN4n"), text.size()));
  constexpr std::string_view followers = " \t\r\n#0123456789";
  return text.starts_with("OFF") && (text.size() == 3 || followers.find(text[3]) != std::string_view::npos);
}

bool looks_like_obj(std::string_view text) {
  constexpr std::array statements{"v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "p", "usemtl", "mtllib"};
  return std::any_of(statements.begin(), statements.end(),
                     [&](std::string_view word) { return starts_with_word(text, word); });
}

/// A remark about the points of a scene without triangles.
std::string points_told(const Scene& scene) {
  std::size_t points = 0;
  for (const Mesh& mesh : scene.meshes) points += mesh.positions.size();
  return points == 0 ? "" : "; its " + std::to_string(points) + " points are not drawn, because a point has no surface";
}

constexpr std::string_view builtin_prefix = "builtin:";

/// Advice for a file that neither this library nor frontmost-import reads, by its suffix.
std::optional<std::string> advice_by_suffix(const std::string& path) {
  return imported_by_suffix(path) ? std::nullopt : conversion_by_suffix(path);
}

Scene read(ModelFormat format, Bytes bytes, const ModelSource& source) {
  switch (format) {
    case ModelFormat::stl: return read_stl(bytes, source);
    case ModelFormat::ply: return read_ply(bytes, source);
    case ModelFormat::obj: return read_obj(bytes, source);
    case ModelFormat::off: return read_off(bytes, source);
    case ModelFormat::gltf: return read_gltf(bytes, source);
    case ModelFormat::threemf: return read_3mf(bytes, source);
    case ModelFormat::scene: return read_scene_file(bytes, source);
    case ModelFormat::step:
    case ModelFormat::iges:
    case ModelFormat::brep:
    case ModelFormat::foreign: return read_imported(format, bytes, source);
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
  source.set_import_options(options.import);
  Scene scene = read(*format, bytes, source);
  scene.source.format = format;
  scene.name = source.stem();
  const bool states_up = *format == ModelFormat::scene || is_imported(*format);
  scene.up = options.up.value_or(states_up ? scene.up : default_up(*format));
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

[[noreturn]] void refuse_stream(const ModelSource& source, const std::string& what) {
  throw Error(ErrorCode::unsupported, source.name(), "", what + " cannot be streamed; binary STL and PLY can");
}

std::unique_ptr<ModelStream> open_stream(ModelFormat format, StreamStart start, const ModelSource& source) {
  switch (format) {
    case ModelFormat::stl:
      if (known_stl_encoding(start.start, start.greatest_size(), source) == StlEncoding::ascii)
        refuse_stream(source, "text STL");
      return open_stl_stream(std::move(start), source);
    case ModelFormat::ply: return open_ply_stream(std::move(start), source);
    case ModelFormat::obj: refuse_stream(source, "OBJ");
    case ModelFormat::off: refuse_stream(source, "OFF");
    case ModelFormat::gltf: refuse_stream(source, "glTF");
    case ModelFormat::threemf: refuse_stream(source, "3MF");
    case ModelFormat::scene: refuse_stream(source, "a scene file");
    case ModelFormat::step:
    case ModelFormat::iges:
    case ModelFormat::brep:
    case ModelFormat::foreign: refuse_stream(source, "a model for frontmost-import");
  }
  throw Error(ErrorCode::bad_argument, source.name(), "", "not a model format");
}

}  // namespace

std::optional<ModelFormat> format_of_suffix(const std::string& path) {
  const std::string suffix = lower_suffix(path);
  if (suffix == ".stl") return ModelFormat::stl;
  if (suffix == ".ply") return ModelFormat::ply;
  if (suffix == ".obj") return ModelFormat::obj;
  if (suffix == ".off") return ModelFormat::off;
  if (suffix == ".gltf" || suffix == ".glb") return ModelFormat::gltf;
  if (suffix == ".3mf") return ModelFormat::threemf;
  return imported_by_suffix(path);
}

Axis default_up(ModelFormat format) {
  return format == ModelFormat::stl || format == ModelFormat::threemf ? Axis::z : Axis::y;
}

std::optional<ModelFormat> format_of_content(Bytes bytes) {
  const std::string_view text = first_statement(bytes);
  if (text.starts_with("glTF")) return ModelFormat::gltf;
  if (text.starts_with('{'))  // writers that sort keys put "asset" far back, so all text is searched
    return text_of(bytes).find("\"asset\"") != std::string_view::npos ? ModelFormat::gltf : ModelFormat::scene;
  if (text.starts_with("PK\x03\x04")) return ModelFormat::threemf;
  if (starts_with_word(text, "ply")) return ModelFormat::ply;
  if (looks_like_off(text)) return ModelFormat::off;
  if (stl_encoding(bytes, bytes.size()) != StlEncoding::neither) return ModelFormat::stl;
  if (const auto imported = imported_by_content(bytes)) return imported;
  if (looks_like_obj(text)) return ModelFormat::obj;
  return std::nullopt;
}

Scene load_named(const std::string& reference, const ModelSource& scene_file) {
  if (reference.starts_with(builtin_prefix)) return builtin(std::string_view(reference).substr(builtin_prefix.size()));
  const std::filesystem::path path = scene_file.path_of(reference);
  const InputFile file = scene_file.open(reference, max_file_bytes);
  const auto opened = std::make_shared<OpenedFiles>(path);
  ModelSource source(printable(reference), scene_file.execution(), file, path, opened, scene_file.image_decoder());
  if (const auto advice = advice_by_suffix(reference)) refuse(source, *advice);
  auto format = format_of_suffix(reference);
  if (!format) format = format_of_content(file.bytes());
  if (format == ModelFormat::scene) refuse(source, "is a scene file; a scene file can place only models");
  LoadOptions options;
  options.import = scene_file.import_options();
  Scene scene = read_any(file.bytes(), source, format, options);
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
    const InputFile file = InputFile::open_input(path);
    ModelSource source(input_name(path), execution, options.image_decoder);
    Scene scene = read_any(file.bytes(), source, options.format, options);
    scene.name = "stdin";
    return scene;
  }
  const InputFile file = InputFile::open(path, path);
  const auto opened = std::make_shared<OpenedFiles>(path);
  ModelSource source(path, execution, file, path, opened, options.image_decoder);
  if (const auto advice = options.format ? std::nullopt : advice_by_suffix(path)) refuse(source, *advice);
  const auto format = options.format ? options.format : format_of_suffix(path);
  Scene scene = read_any(file.bytes(), source, format, options);
  for (std::filesystem::path& used : scene.source.files) opened->add(std::move(used));  // of a scene file's models
  scene.source.files = opened->paths();
  return scene;
}

Scene load(std::span<const std::byte> bytes, const std::string& name, const LoadOptions& options,
           const Execution& execution) {
  ModelSource source(name, execution, options.image_decoder);
  return read_any(bytes, source, options.format, options);
}

/// Clears the values but keeps the memory, because the same few pieces are filled repeatedly.
void StreamPiece::clear() {
  const auto clear = [](auto& attribute) {
    attribute.values.clear();
    attribute.triangles.clear();
  };
  mesh.positions.clear();
  mesh.triangles.clear();
  mesh.material_ids.clear();
  mesh.face_ids.clear();
  clear(mesh.normals);
  clear(mesh.texcoords);
  clear(mesh.colors);
  used = 0;
  row_count = 0;
  triangle_count = 0;
}

std::optional<std::uint64_t> StreamStart::size() const {
  return has_ended ? std::uint64_t(start.size()) : bytes->size();
}

void StreamStart::extend(std::size_t size) {
  if (size <= start.size()) return;
  const std::size_t before = start.size();
  start.resize(size);
  start.resize(before + bytes->read(start.data() + before, size - before));
  has_ended = start.size() < size;
}

std::unique_ptr<ModelStream> open_model_stream(const std::string& path, const LoadOptions& options,
                                               const Execution& execution) {
  const std::string name = input_name(path);
  if (path.starts_with(builtin_prefix)) refuse_stream(ModelSource(name, execution), "a built-in scene");
  const auto opened = std::make_shared<OpenedFiles>(path);
  StreamStart start{std::make_unique<ByteStream>(path, name), {}, path, opened};
  constexpr std::size_t enough_to_know = 1024;
  start.extend(enough_to_know);
  const ModelSource source(name, execution);
  if (start.start.empty()) throw Error(ErrorCode::file_malformed, name, "", "the file is empty");
  if (const auto conversion = options.format ? std::nullopt : conversion_by_suffix(path))
    throw Error(ErrorCode::unsupported, name, "", *conversion);
  auto format = options.format ? options.format : path == "-" ? std::nullopt : format_of_suffix(path);
  if (!format) format = format_of_content(start.start);
  // A prefix of a binary STL file holds no whole number of triangles, so format_of_content() does not recognize it.
  if (!format && stl_encoding(start.start, start.greatest_size()) == StlEncoding::binary) format = ModelFormat::stl;
  if (!format)
    throw Error(ErrorCode::unsupported, name, "",
                conversion_by_content(start.start).value_or("not a model that can be streamed (binary STL or PLY)"));
  std::unique_ptr<ModelStream> stream = open_stream(*format, std::move(start), source);
  stream->introduce(path == "-" ? "stdin" : source.stem(), options.up.value_or(default_up(*format)),
                    {format, std::nullopt, opened->paths(), {}});
  return stream;
}

}  // namespace frontmost
