// SPDX-License-Identifier: Apache-2.0
// The readers, one a format. Each turns bytes into a scene that frontmost::validate() accepts, keeps the order and
// number of the file's triangles (degenerate ones too), and leaves units alone; load() adds the scene's name and up
// axis and validates. Bad bytes end in Error "name: place: reason"; what can be passed over is told in
// Scene::warnings as "place: reason", before which load() puts the file's name.
#pragma once

#include <optional>
#include <string>

#include "frontmost/files.h"
#include "io/models/model_source.h"

namespace frontmost {

[[nodiscard]] Scene read_stl(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_ply(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_obj(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_off(Bytes bytes, const ModelSource& source);
/// This and the next tell SceneSource::metres_per_unit.
[[nodiscard]] Scene read_gltf(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_3mf(Bytes bytes, const ModelSource& source);
/// A scene file (io/scenes), which names models; it tells SceneSource::metres_per_unit and which way is up.
[[nodiscard]] Scene read_scene_file(Bytes bytes, const ModelSource& source);

/// The model that a scene file names, a built-in scene or a file beside it, as load() gives it.
/// \throws Error as load() does, and unsupported for what is a scene file itself.
[[nodiscard]] Scene load_named(const std::string& reference, const ModelSource& scene_file);

/// What is said of a model that is read, whole or streamed, and holds nothing.
inline constexpr const char* no_triangles_warning = "the file holds no triangles";

/// The format that a file's suffix stands for. None: not one of ours.
[[nodiscard]] std::optional<ModelFormat> format_of_suffix(const std::string& path);
/// Which way is up in files of a format, unless something else is said. Not asked of scene files, which may say it.
[[nodiscard]] Axis default_up(ModelFormat format);
/// The format that the contents look like. None: none of ours.
[[nodiscard]] std::optional<ModelFormat> format_of_content(Bytes bytes);

// Formats that are not read, and which programs make models of them that are.

/// What to say of a file in a format that is known but not read, with the command line that converts it: by the suffix
/// of `path`. None: not one of those.
[[nodiscard]] std::optional<std::string> conversion_by_suffix(const std::string& path);
/// The same by the first bytes, for what has no suffix, such as standard input.
[[nodiscard]] std::optional<std::string> conversion_by_content(Bytes bytes);
/// The same of the glTF file `path`, for extensions that it requires or uses. None: no program is known for any of
/// them.
[[nodiscard]] std::optional<std::string> conversion_of_extensions(const std::vector<std::string>& names,
                                                                  const std::string& path);

}  // namespace frontmost
