// SPDX-License-Identifier: Apache-2.0
// File names are checked as far as possible before anything is drawn, because a run of an hour must not end in "no such
// folder". Suffixes give the format; --format serves names without a suffix. Two kinds in one file become channels of
// an OpenEXR file.
#include "cli/outputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kind_names[] = {"picture", "deep",          "depth",      "ray_distance", "window_depth",
                                           "normals", "primitive_ids", "object_ids", "material_ids"};
constexpr std::string_view format_names[] = {"png", "exr", "pfm", "npy", "jpg", "webp"};
constexpr std::string_view given_formats = "png, exr, pfm, npy, jpg or webp";

/// Returns the suffix in lower case without its dot. "jpeg" becomes "jpg".
std::string suffix_of(const std::string& path) {
  std::string suffix = fs::path(path).extension().string();
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  suffix.erase(0, 1);
  return suffix == "jpeg" ? "jpg" : suffix;
}

bool is_id(OutputKind kind) { return kind >= OutputKind::primitive_ids; }

void check_format(OutputKind kind, ImageFormat format, const std::string& path) {
  if (is_id(kind) && format == ImageFormat::pfm) {
    throw UsageError(fmt::format("{}: PFM cannot hold ids; use .exr, .npy or .png", path));
  }
  if (kind == OutputKind::deep && format != ImageFormat::exr)
    throw UsageError(fmt::format("{}: a deep file must be .exr", path));
  if (kind != OutputKind::picture && holds_pictures_alone(format))
    throw UsageError(fmt::format("{}: JPEG and WebP hold only colour pictures; use .exr, .npy or .png", path));
}

ImageFormat format_of(const OutputSettings& settings, const std::string& path) {
  if (const std::optional<ImageFormat> format = format_by_suffix(path)) return *format;
  if (settings.format) return *settings.format;
  if (path == "-") throw UsageError(fmt::format("standard output needs --format {}", given_formats));
  throw UsageError(
      fmt::format("{}: the suffix names no format; use .png, .exr, .pfm, .npy, .jpg or .webp, or --format", path));
}

void add(std::vector<FileToWrite>& files, const FileToWrite& added) {
  const std::string& path = added.path;
  const OutputKind kind = added.kinds.front();
  const auto same =
      std::find_if(files.begin(), files.end(), [&](const FileToWrite& file) { return file.path == path; });
  if (same == files.end()) {
    files.push_back(added);
    return;
  }
  const auto is_deep = [](OutputKind k) { return k == OutputKind::deep; };
  const bool shareable = added.format == ImageFormat::exr && path != "-" && added.layer == same->layer &&
                         !is_deep(kind) && !is_deep(same->kinds.front());
  if (!shareable || std::find(same->kinds.begin(), same->kinds.end(), kind) != same->kinds.end()) {
    throw UsageError(fmt::format(
        "{}: two outputs have this name; only an .exr file that is not deep can hold several outputs", path));
  }
  same->kinds.push_back(kind);
}

/// Returns a canonical path, which is equal for all spellings of a path.
std::string canonical(const std::string& path) {
  std::error_code ignored;
  const fs::path result = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  return result.empty() ? path : result.string();
}

/// Whether the request makes a file for each layer. fill_template() refuses {layer} in other names.
bool is_of_layers(const OutputRequest& request) {
  if (request.path.find("{layer}") == std::string::npos) return false;
  if (request.kind == OutputKind::deep || request.kind == OutputKind::window_depth)
    throw UsageError(
        fmt::format("{}: this output is one file for all layers; leave {{layer}} out of its name", request.path));
  return true;
}

void check_writable(const std::string& path) {
  const auto refuse = [&](std::string_view why) {
    throw Error(ErrorCode::file_unwritable, path, "", std::string(why));
  };
  std::error_code ignored, error;
  const fs::file_status status = fs::status(path, error);
  if (error == std::errc::filename_too_long) refuse("the name is too long");
  if (fs::is_directory(status)) refuse("is a folder");
  if (fs::exists(status)) {
    if (access(path.c_str(), W_OK) != 0) refuse("is not writable");
    // A device or a pipe is written directly. A file is replaced, which its folder must permit.
    if (!fs::is_regular_file(status)) return;
  }
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::exists(folder, ignored)) refuse(fmt::format("the folder {} does not exist", folder.string()));
  if (!fs::is_directory(folder, ignored)) refuse(fmt::format("{} is not a folder", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse(fmt::format("the folder {} is not writable", folder.string()));
}

}  // namespace

std::optional<ImageFormat> format_by_suffix(const std::string& path) {
  const auto found = std::find(std::begin(format_names), std::end(format_names), suffix_of(path));
  if (found == std::end(format_names)) return std::nullopt;
  return ImageFormat(found - std::begin(format_names));
}

bool holds_pictures_alone(ImageFormat format) { return format == ImageFormat::jpeg || format == ImageFormat::webp; }

std::string_view kind_name(OutputKind kind) { return kind_names[int(kind)]; }

std::string model_name(const std::string& model) {
  if (model == "-") return "stdin";
  if (model.substr(0, 8) == "builtin:") return model.substr(8);
  const std::string stem = fs::path(model).stem().string();
  return stem.empty() ? "model" : stem;
}

std::string fill_template(std::string_view text, const std::string& model, const std::string& view,
                          std::optional<int> layer) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c != '{' && c != '}') {
      result += c;
    } else if (i + 1 < text.size() && text[i + 1] == c) {
      result += c;
      ++i;
    } else {
      const std::size_t end = c == '{' ? text.find('}', i) : std::string_view::npos;
      const std::string_view word = end == std::string_view::npos ? "" : text.substr(i + 1, end - i - 1);
      if (word == "layer" && layer) {
        result += std::to_string(*layer);
      } else if (word == "model" || word == "view") {
        result += word == "model" ? model : view;
      } else {
        throw UsageError(
            fmt::format("{}: unknown placeholder; use {{model}}, {{view}}, or {{layer}} with --layers; {{{{ and }}}} "
                        "stand for braces",
                        text));
      }
      i = end;
    }
  }
  return result;
}

void check_given_format(const std::vector<std::string>& paths, int given, std::string_view formats) {
  const std::vector<std::string_view> names = split(formats, '|');
  const auto number = [&](const std::string& path) {
    const std::string suffix = suffix_of(path);
    return int(std::find(names.begin(), names.end(), suffix) - names.begin());
  };
  const auto is_silent = [&](const std::string& path) { return number(path) == int(names.size()); };
  if (std::any_of(paths.begin(), paths.end(), is_silent)) return;
  for (const std::string& path : paths)
    if (number(path) != given)
      throw UsageError(path + ": --format differs from the suffix; --format is for names without a known suffix");
}

std::vector<FileToWrite> plan_outputs(const OutputSettings& settings, const std::string& model,
                                      const std::string& view) {
  std::vector<FileToWrite> files;
  bool any_layers = false;
  for (const OutputRequest& request : settings.files) {
    const auto plan = [&](std::optional<int> layer) {
      const std::string path = request.path == "-" ? "-" : fill_template(request.path, model, view, layer);
      const ImageFormat format = format_of(settings, path);
      check_format(request.kind, format, path);
      if (format == ImageFormat::jpeg && !settings.background)
        throw UsageError(fmt::format("{}: JPEG holds no alpha; use .png or .webp, or another --background", path));
      add(files, {path, format, {request.kind}, layer});
    };
    if (!settings.layers || !is_of_layers(request)) {
      plan(std::nullopt);
      continue;
    }
    any_layers = true;
    for (int layer = 0; layer < *settings.layers; ++layer) plan(layer);
  }
  if (settings.layers && !any_layers) throw UsageError("--layers: no output has {layer} in its name");
  return files;
}

void check_outputs(const std::vector<std::string>& paths, const InputFiles& inputs) {
  inputs.refuse_outputs(paths);
  std::set<std::string> taken;
  for (const std::string& path : paths) {
    if (!taken.insert(path == "-" ? path : canonical(path)).second) {
      throw UsageError(
          path == "-"
              ? "standard output is given twice"
              : fmt::format(
                    "{}: would be written twice; give every output a name of its own ({{view}} stands for the view's)",
                    path));
    }
    if (path != "-") check_writable(path);
  }
}

void check_references(const std::vector<std::string>& references, const std::vector<std::string>& outputs) {
  if (references.empty()) return;
  constexpr const char* is_both = "is both the reference and an output";
  std::set<std::string> written;
  for (const std::string& output : outputs)
    if (output != "-") written.insert(canonical(output));
  InputFiles files;
  for (const std::string& reference : references) {
    files.add(reference, is_both);
    if (written.count(canonical(reference))) throw UsageError(fmt::format("{}: {}", reference, is_both));
  }
  files.refuse_outputs(outputs);
}

std::string difference_path(const OutputSettings& settings, const std::vector<FileToWrite>& files) {
  if (settings.reference_difference) return *settings.reference_difference;
  for (const FileToWrite& file : files) {
    if (file.path == "-" || file.kinds.front() != OutputKind::picture) continue;
    return fs::path(file.path).replace_extension(".difference.png").string();
  }
  return fs::path(*settings.reference).stem().string() + ".difference.png";
}

}  // namespace frontmost::cli
