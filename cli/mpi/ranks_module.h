// SPDX-License-Identifier: Apache-2.0
// The program joins MPI's ranks by a function in a separate module, which is loaded only for --mpi. If the program were
// linked with MPI, each start would take 9 ms longer, and each machine would need an MPI.
#pragma once

#include <frontmost/streams.h>

namespace frontmost::cli {

/// The module's file, beside the program or in the folder of its modules.
inline constexpr const char* mpi_module = "frontmost_mpi.so";
/// The name of the module's function, of type JoinRanks.
inline constexpr const char* join_function = "frontmost_join_ranks";
/// The type of a function that starts MPI. Destroying the returned object leaves the ranks and ends MPI. Errors of MPI
/// end all ranks, with MPI's message. The function is to be called once.
using JoinRanks = Ranks* (*)();

}  // namespace frontmost::cli
