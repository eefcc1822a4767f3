// SPDX-License-Identifier: Apache-2.0
// The numbers that decide where a ray meets a patch: one set for single rays and for packets, whose answers are equal.
#pragma once

namespace frontmost::raycast_detail {

inline constexpr double kContracting = 0.5;  ///< at most; steps then halve the distance to the root at least
inline constexpr int kMostSteps = 64;
inline constexpr double kThere = 0x1p-52;     ///< in parameters: nearer to a root steps do not come
inline constexpr double kSingular = 1e-6;     ///< of the product of its columns, a determinant that counts as none
inline constexpr double kNearEnough = 0.125;  ///< of the pad
/// A little farther than a ray reaches, so that whatever ties with its end is found in any order.
inline constexpr double kPastTheEnd = 1 + 0x1p-50;

// Parts of kFinestPart of the patch and kFinestPartOfReach of the distance are as good as points; CurvedIndex states
// it.
inline constexpr double kFinestPart = 0x1p-30, kFinestPartOfReach = 0x1p-44;
inline constexpr double kFinest = 0x1p-1000;  ///< denormal parts would round to themselves when halved, and never end
inline constexpr double kPad = 0x1p-4;  ///< of that: how far from the ray a hull counts as holding it; many roundings

}  // namespace frontmost::raycast_detail
