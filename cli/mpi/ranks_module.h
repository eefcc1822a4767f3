// SPDX-License-Identifier: Apache-2.0
// How the program joins MPI's ranks: by a function in a module of its own, which is loaded when --mpi asks for it.
// Linked with the program, MPI's libraries would cost every start of it 9 ms, and every machine that it is installed on
// an MPI.
#pragma once

#include <frontmost/streams.h>

namespace frontmost::cli {

/// The file, beside the program or in the folder of its modules.
inline constexpr const char* mpi_module = "frontmost_mpi.so";
/// Of type JoinRanks.
inline constexpr const char* join_function = "frontmost_join_ranks";
/// Begins MPI; the ranks are left, and MPI ended, when the object goes. What MPI cannot do ends all ranks, with its own
/// message. Call once.
using JoinRanks = Ranks* (*)();

}  // namespace frontmost::cli
