// SPDX-License-Identifier: Apache-2.0
#include "python/held.h"

namespace frontmost::python {
namespace {

constexpr std::size_t most_spare = 4;  ///< limit of spare buffers, and of spare planes

}  // namespace

std::shared_ptr<const Visible> HeldSurfaces::draw(const View& view, const Execution& execution) {
  ZBuffer buffer;
  {
    const std::scoped_lock lock(spare_->mutex);
    if (!spare_->buffers.empty()) {
      buffer = std::move(spare_->buffers.back());
      spare_->buffers.pop_back();
    }
    if (!spare_->planes.empty()) {
      buffer.give_back(std::move(spare_->planes.back()));
      spare_->planes.pop_back();
    }
  }
  {
    const std::shared_lock lock(scene->reading);
    buffer.draw(surfaces, view, execution);
  }
  std::shared_ptr<const Visible> visible = share(buffer.take());
  const std::scoped_lock lock(spare_->mutex);
  if (spare_->buffers.size() < most_spare) spare_->buffers.push_back(std::move(buffer));
  return visible;
}

std::shared_ptr<const Visible> HeldSurfaces::share(Visible&& visible) const {
  const auto give_back = [spare = std::weak_ptr(spare_)](Visible* planes) {
    const std::unique_ptr<Visible> owned(planes);
    const std::shared_ptr<Spare> to = spare.lock();
    if (!to) return;
    const std::scoped_lock lock(to->mutex);
    if (to->planes.size() < most_spare) to->planes.push_back(std::move(*owned));
  };
  return {new Visible(std::move(visible)), give_back};
}

void HeldVisible::check_current() const {
  if (moves != of->moves)
    throw Error(ErrorCode::bad_argument, "visible", "objects were moved since; look at the surfaces again");
}

void HeldVisible::check_same(const HeldSurfaces& surfaces, const char* argument) const {
  if (of.get() != &surfaces) throw Error(ErrorCode::bad_argument, std::string(argument), "is of other surfaces");
  check_current();
}

HeldVisible held_visible(const std::shared_ptr<HeldSurfaces>& of, std::shared_ptr<const Visible> visible) {
  return {of, std::move(visible), of->moves};
}

glm::dmat4 placed_by(const glm::dmat4& pose, const Scene& scene, const Mesh& mesh) {
  glm::dmat4 placed = pose;
  placed[3] = pose * glm::dvec4(mesh.origin, 1) - glm::dvec4(scene.origin, 0);
  return placed;
}

glm::dmat4 pose_of_instance(const Scene& scene, const Instance& instance) {
  glm::dmat4 pose = instance.world_from_mesh;
  pose[3] = pose * glm::dvec4(-scene.meshes[instance.mesh].origin, 1) + glm::dvec4(scene.origin, 0);
  return pose;
}

std::uint32_t object_of(const Scene& scene, const py::handle& given) {
  const std::size_t count = scene.instances.size();
  if (py::isinstance<py::str>(given)) {
    const std::string name = py::cast<std::string>(given);
    std::uint32_t found = no_index;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (scene.instances[i].name != name) continue;
      if (found != no_index) throw py::value_error("object: several are called '" + name + "'; give a number");
      found = i;
    }
    if (found == no_index) throw py::value_error("object: none is called '" + name + "'");
    return found;
  }
  if (!PyIndex_Check(given.ptr())) throw py::type_error("object: must be a number or a name");
  const Py_ssize_t number = PyNumber_AsSsize_t(given.ptr(), nullptr);
  if (number < 0 || std::size_t(number) >= count)
    throw py::value_error("object: there is no object " + std::to_string(number) + " of " + std::to_string(count));
  return std::uint32_t(number);
}

}  // namespace frontmost::python
