// SPDX-License-Identifier: Apache-2.0
// State of Python's objects. Shared ownership keeps borrowed objects alive.
//
//   Scene     shares a frontmost::Scene; changed in place only if nobody else has it, else copied first
//   Surfaces  shares that scene, and lends ZBuffers and planes of pixels
//   Visible   shares the surfaces, and shares its planes with the arrays that show them
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

/// A scene with several owners.
struct KeptScene : Scene {
  explicit KeptScene(Scene given = {}) : Scene(std::move(given)) {}

  /// Shared lock to read the objects' poses, exclusive lock to move an object. Never waited for while holding the
  /// interpreter's lock.
  mutable std::shared_mutex reading;
  std::atomic<int> surfaces_count = 0;  ///< number of Surfaces of this scene
};

/// Python's Scene. Objects made of it keep the scene that they were made of.
struct HeldScene {
  HeldScene() : HeldScene(Scene()) {}
  explicit HeldScene(Scene&& given) : scene(std::make_shared<KeptScene>(std::move(given))) {}
  explicit HeldScene(std::shared_ptr<KeptScene> given) : scene(std::move(given)) {}

  /// The scene for changes: a copy if others hold it. Precondition: the interpreter's lock is held.
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

  /// Calls zbuffer() with a spare ZBuffer and spare planes, if there are any.
  [[nodiscard]] std::shared_ptr<const Visible> draw(const View& view, const Execution& execution);
  /// Shares planes. The planes become spare when their last owner is gone.
  [[nodiscard]] std::shared_ptr<const Visible> share(Visible&& visible) const;

  const std::shared_ptr<KeptScene> scene;
  Surfaces surfaces;
  /// Keeps data that pictures of these surfaces have in common. Use requires `shading`.
  mutable std::unique_ptr<Shader> shader;
  mutable std::mutex shading;
  /// The number of moves. Earlier answers are invalid after a move.
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
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves at the time of the search
  py::object depth = py::none();

  /// \throws Error bad_argument if an object was moved since.
  void check_current() const;
  /// \throws Error bad_argument, naming `argument`, if this belongs to other surfaces, or is older than a move.
  void check_same(const HeldSurfaces& surfaces, const char* argument) const;
};

/// Python's Visible with new planes.
[[nodiscard]] HeldVisible held_visible(const std::shared_ptr<HeldSurfaces>& of, std::shared_ptr<const Visible> visible);

/// placed_by() converts a pose of the mesh's points as given, before Mesh::origin was subtracted, in the file's
/// coordinates, to the pose in the scene. pose_of_instance() converts back.
[[nodiscard]] glm::dmat4 placed_by(const glm::dmat4& pose, const Scene& scene, const Mesh& mesh);
[[nodiscard]] glm::dmat4 pose_of_instance(const Scene& scene, const Instance& instance);

/// The number of the object that an argument names: by number, or by a name that occurs only once.
/// \throws py::value_error, py::type_error
[[nodiscard]] std::uint32_t object_of(const Scene& scene, const py::handle& given);

}  // namespace frontmost::python
