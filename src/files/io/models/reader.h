// SPDX-License-Identifier: Apache-2.0
// The readers, one a format. Each turns bytes into a scene that frontmost::validate() accepts, keeps order and number
// of the file's triangles (degenerate ones too), and keeps the file's units. load() validates, and adds the scene's
// name and up axis. Bad bytes cause an Error "name: place: reason". Tolerable faults go to Scene::warnings as "place:
// reason"; load() prepends the file's name.
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
/// The next two readers also set SceneSource::metres_per_unit.
[[nodiscard]] Scene read_gltf(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_3mf(Bytes bytes, const ModelSource& source);
/// Reads a scene file (io/scenes), which names models. Sets SceneSource::metres_per_unit and the up axis.
[[nodiscard]] Scene read_scene_file(Bytes bytes, const ModelSource& source);

/// Loads the model that a scene file names, a built-in scene or a file beside it, as load() does.
/// \throws Error as load() does, and unsupported if the model is a scene file itself.
[[nodiscard]] Scene load_named(const std::string& reference, const ModelSource& scene_file);

/// The warning about a model without triangles, whole or streamed.
inline constexpr const char* no_triangles_warning = "the file holds no triangles";

/// The format of a file's suffix; empty if no reader has it.
[[nodiscard]] std::optional<ModelFormat> format_of_suffix(const std::string& path);
/// The up axis of files in a format, unless the user says otherwise. Precondition: no scene file, which may state it.
[[nodiscard]] Axis default_up(ModelFormat format);
/// The format that the contents look like; empty if no reader has it.
[[nodiscard]] std::optional<ModelFormat> format_of_content(Bytes bytes);

// Formats that are not read, and programs that convert them.

/// Advice for a file in a format that is known but not read, with the command line that converts it. The suffix of
/// `path` decides; empty for other suffixes.
[[nodiscard]] std::optional<std::string> conversion_by_suffix(const std::string& path);
/// Advice by the first bytes, for input without a suffix such as standard input.
[[nodiscard]] std::optional<std::string> conversion_by_content(Bytes bytes);
/// Advice for the glTF file `path`, by extensions that it requires or uses. Empty if no program is known for any of
/// them.
[[nodiscard]] std::optional<std::string> conversion_of_extensions(const std::vector<std::string>& names,
                                                                  const std::string& path);

}  // namespace frontmost
