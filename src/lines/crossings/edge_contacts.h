// SPDX-License-Identifier: Apache-2.0
// Where surfaces pass through each other exactly along an edge.
#pragma once

#include "lines/crossings/crossings.h"

namespace frontmost::lines_detail {

/// An edge, the lower vertex first, that lies in the plane of a triangle of which it is no edge.
struct EdgeContact {
  std::uint32_t from, to, triangle;
};

/// Appends the segments of those edges that the triangle reaches and whose own two triangles lie on different sides of
/// it; and where two edges lie along each other, of those whose triangles follow each other in turn around them. Edges
/// that are drawn give none, so that every line is there once. Ends are exact where they are vertices.
/// O(triangles + contacts log contacts), or nothing without contacts.
void add_contacts(const WeldedMesh& mesh, const Features& features, std::vector<EdgeContact> contacts,
                  std::vector<Crossing>& crossings);

}  // namespace frontmost::lines_detail
