// SPDX-License-Identifier: Apache-2.0
// The answer of frontmost-import, written frame by frame. Libraries print what they like to standard output, so the
// answer has a descriptor of its own.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "io/models/import_frames.h"

namespace frontmost::import {

/// A model cannot be read; what() is the reason.
struct Unreadable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How finely curved surfaces are divided.
struct Tessellation {
  double tolerance = 0;  ///< in millimetres, the greatest distance from the surface; 0: 0.05 % of the model's diagonal
  double angle = 0.2;    ///< in radians, the greatest angle between the normals of neighbouring facets
  bool in_parallel = true;
};

class Answer {
 public:
  explicit Answer(int descriptor) : descriptor_(descriptor) {}
  void progress(double done);
  void warning(std::string_view text) { write_text(import_frames::Kind::warning, text); }
  void error(std::string_view text) { write_text(import_frames::Kind::error, text); }
  /// `metres` for one unit; 0: unknown.
  void space(double metres, std::string_view up);
  /// Names this program and its libraries. Only for an answer that depends on nothing but these and the model's bytes.
  void files();
  void model(std::string_view glb) { write(import_frames::Kind::model, glb); }

 private:
  void write_text(import_frames::Kind kind, std::string_view text) {
    write(kind, text.substr(0, import_frames::longest_text));
  }
  void write(import_frames::Kind kind, std::string_view payload);

  int descriptor_;
  double told_ = -1;
};

/// Reads a STEP, IGES or BREP file by OpenCASCADE. `path` is read from its beginning.
/// \throws Unreadable; whatever OpenCASCADE throws.
void read_shapes(const std::string& path, std::string_view format, const Tessellation& tessellation, Answer& answer);

/// Reads a file of another format by assimp. `suffix`: of the file's name, without its point. \throws Unreadable.
void read_polygons(std::string_view bytes, const std::string& suffix, Answer& answer);

/// Suffixes that assimp reads, as "*.3ds;*.dae;...".
[[nodiscard]] std::string polygon_suffixes();

}  // namespace frontmost::import
