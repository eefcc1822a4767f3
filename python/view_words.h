// SPDX-License-Identifier: Apache-2.0
// Python's words for views.
#pragma once

#include <frontmost/view.h>

#include "python/words.h"

FRONTMOST_WORDS(frontmost::Culling, "culling",
                {{frontmost::Culling::none, "none"},
                 {frontmost::Culling::back, "back"},
                 {frontmost::Culling::front, "front"},
                 {frontmost::Culling::both, "both"},
                 {frontmost::Culling::material, "material"}});
FRONTMOST_WORDS(frontmost::PixelRule, "pixel_rule",
                {{frontmost::PixelRule::centre_at_half, "centre_at_half"},
                 {frontmost::PixelRule::centre_at_integer, "centre_at_integer"}});
FRONTMOST_WORDS(frontmost::PoseConvention, "convention",
                {{frontmost::PoseConvention::opengl_camera_to_world, "opengl_camera_to_world"},
                 {frontmost::PoseConvention::opengl_world_to_camera, "opengl_world_to_camera"},
                 {frontmost::PoseConvention::opencv_camera_to_world, "opencv_camera_to_world"},
                 {frontmost::PoseConvention::opencv_world_to_camera, "opencv_world_to_camera"},
                 {frontmost::PoseConvention::robot_camera_to_world, "robot_camera_to_world"},
                 {frontmost::PoseConvention::robot_world_to_camera, "robot_world_to_camera"}});
FRONTMOST_WORDS(frontmost::NamedView, "direction",
                {{frontmost::NamedView::front, "front"},
                 {frontmost::NamedView::back, "back"},
                 {frontmost::NamedView::left, "left"},
                 {frontmost::NamedView::right, "right"},
                 {frontmost::NamedView::top, "top"},
                 {frontmost::NamedView::bottom, "bottom"},
                 {frontmost::NamedView::iso, "iso"},
                 {frontmost::NamedView::three_quarter, "three_quarter"}});
FRONTMOST_WORDS(frontmost::FramedObjects, "objects",
                {{frontmost::FramedObjects::subject, "subject"}, {frontmost::FramedObjects::all, "all"}});

namespace frontmost::python {

/// The library's words for poses, and three short ones. "opencv": opencv_world_to_camera, OpenCV's calibrations.
/// "opengl": opengl_camera_to_world, OpenGL's cameras. "robot": robot_camera_to_world, transforms of ROS.
[[nodiscard]] PoseConvention pose_convention_of(const std::string& word);

}  // namespace frontmost::python
