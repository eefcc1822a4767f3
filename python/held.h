// SPDX-License-Identifier: Apache-2.0
// What Python's objects hold, so that nothing that is borrowed goes before those that borrow it.
//
//   Scene     shares a frontmost::Scene; changed only while nobody else has it, else as a copy of its own
//   Surfaces  shares that scene, and lends ZBuffers and planes of pixels
//   Visible   shares the surfaces, and the planes with the arrays that show them
#pragma once

#include <frontmost/pictures.h>
#include <frontmost/raycast.h>
#include <frontmost/scene.h>
#include <frontmost/view.h>
#include <frontmost/zbuffer.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

namespace frontmost::python {

namespace py = pybind11;

/// A scene that several share.
struct KeptScene : Scene {
  explicit KeptScene(Scene given = {}) : Scene(std::move(given)) {}

  /// Held by whoever reads where objects are, and alone by whoever moves one; never waited for with the interpreter's
  /// lock.
  mutable std::shared_mutex reading;
  std::atomic<int> surfaces_count = 0;  ///< how many Surfaces show it
};

/// Python's Scene. What was made of it keeps the scene that it was made of.
struct HeldScene {
  HeldScene() : HeldScene(Scene()) {}
  explicit HeldScene(Scene&& given) : scene(std::make_shared<KeptScene>(std::move(given))) {}
  explicit HeldScene(std::shared_ptr<KeptScene> given) : scene(std::move(given)) {}

  /// The scene to be changed: a copy where others hold it. With the interpreter's lock.
  [[nodiscard]] Scene& writable() {
    if (scene.use_count() > 1) scene = std::make_shared<KeptScene>(Scene(*scene));
    return *scene;
  }

  std::shared_ptr<KeptScene> scene;
};

/// Python's Surfaces.
class HeldSurfaces {
 public:
  HeldSurfaces(std::shared_ptr<KeptScene> of, const Execution& execution)
      : scene(std::move(of)), surfaces(*scene, execution), spare_(std::make_shared<Spare>()) {
    scene->surfaces_count += 1;
  }
  ~HeldSurfaces() { scene->surfaces_count -= 1; }
  HeldSurfaces(const HeldSurfaces&) = delete;
  HeldSurfaces& operator=(const HeldSurfaces&) = delete;

  /// What zbuffer() gives, by a ZBuffer that was used before where there is one, into planes that nobody shows any
  /// more.
  [[nodiscard]] std::shared_ptr<const Visible> draw(const View& view, const Execution& execution);
  /// Planes that are given back when the last of those that share them is gone.
  [[nodiscard]] std::shared_ptr<const Visible> share(Visible&& visible) const;

  const std::shared_ptr<KeptScene> scene;
  Surfaces surfaces;
  /// Keeps what pictures of these surfaces have in common; for whoever holds `shading`.
  mutable std::unique_ptr<Shader> shader;
  mutable std::mutex shading;
  /// How often something was moved: what was visible before is so no more.
  std::uint64_t moves = 0;

 private:
  struct Spare {
    std::mutex mutex;
    std::vector<ZBuffer> buffers;
    std::vector<Visible> planes;
  };
  std::shared_ptr<Spare> spare_;
};

/// Python's Visible.
struct HeldVisible {
  std::shared_ptr<HeldSurfaces> of;
  std::shared_ptr<const Visible> visible;
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves when it was found
  py::object depth = py::none();

  /// \throws Error bad_argument where an object was moved since.
  void check_current() const;
  /// \throws Error bad_argument, naming `argument`, where this one is of other surfaces, or of the same before a move.
  void check_same(const HeldSurfaces& surfaces, const char* argument) const;
};

/// A Visible of Python's, of planes that were just found.
[[nodiscard]] HeldVisible held_visible(const std::shared_ptr<HeldSurfaces>& of, std::shared_ptr<const Visible> visible);

/// What places a mesh in a scene by a pose of its points as they were given, before Mesh::origin was taken off them, in
/// the coordinates of the file; and back.
[[nodiscard]] glm::dmat4 placed_by(const glm::dmat4& pose, const Scene& scene, const Mesh& mesh);
[[nodiscard]] glm::dmat4 pose_of_instance(const Scene& scene, const Instance& instance);

/// The number of an object that an argument names: its number, or its name where that is the only one so called.
/// \throws py::value_error, py::type_error
[[nodiscard]] std::uint32_t object_of(const Scene& scene, const py::handle& given);

}  // namespace frontmost::python
