// SPDX-License-Identifier: Apache-2.0
// The instruction sets that this machine has and this build holds, found once.
//
// Highway's library could tell what the machine has, but loading it takes 2 ms of every start of a program. So this
// file asks the processor for the features that each of the three targets is compiled with. A machine that lacks one of
// the features runs the next narrower target.
#include "base/isa.h"

#include <array>
#include <vector>

#include "base/highway-inl.h"

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

namespace frontmost {
namespace {

struct IsaTarget {
  Isa isa;
  std::string_view name;
  std::int64_t bit;  // 0: the fallback that is always there
};

constexpr std::array<IsaTarget, 6> kTargets{{
    {Isa::scalar, "scalar", 0},
    {Isa::sse4, "sse4", HWY_SSE4},
    {Isa::avx2, "avx2", HWY_AVX2},
    {Isa::avx512, "avx512", HWY_AVX3},
    {Isa::neon, "neon", HWY_NEON},
    {Isa::wasm, "wasm", HWY_WASM},
}};

#if HWY_ARCH_X86
/// The features that HWY_TARGET_STR names for the three targets. Older compilers do not know f16c by name.
std::int64_t machine_targets() {
  __builtin_cpu_init();
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  const bool f16c = __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_F16C) != 0;
  const bool sse4 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
                    __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") &&
                    __builtin_cpu_supports("aes");
  const bool avx2 = sse4 && f16c && __builtin_cpu_supports("avx") && __builtin_cpu_supports("avx2") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  // Each target includes the one before it, as the compiler's own targets do: no machine lacks the narrower one.
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  return (sse4 ? HWY_SSE4 : 0) | (avx2 ? HWY_AVX2 : 0) | (avx512 ? HWY_AVX3 : 0);
}
#else
/// Other architectures have one target for all machines.
std::int64_t machine_targets() { return HWY_TARGETS; }
#endif

std::vector<Isa> find_available() {
  const std::int64_t usable = machine_targets() & HWY_TARGETS;
  std::vector<Isa> found;
  for (const IsaTarget& target : kTargets)
    if (target.bit == 0 || (usable & target.bit)) found.push_back(target.isa);
  return found;
}

}  // namespace

std::span<const Isa> available_isas() {
  // Never destroyed, because threads may draw while the process ends.
  static const auto& found = *new std::vector<Isa>(find_available());
  return found;
}

std::string_view name(Isa isa) {
  if (isa == Isa::best) isa = available_isas().back();
  for (const IsaTarget& target : kTargets)
    if (target.isa == isa) return target.name;
  return "unknown";
}

std::int64_t highway_targets(Isa isa) {
  // Nearly every call asks for `best`, so its bit is stored.
  static const std::int64_t of_best = kTargets[std::size_t(available_isas().back()) - 1].bit;
  if (isa == Isa::best) return of_best;
  for (const Isa available : available_isas())
    if (available == isa) return kTargets[std::size_t(isa) - 1].bit;
  throw Error(ErrorCode::unsupported, "isa", std::string(name(isa)) + " is not available on this machine");
}

}  // namespace frontmost
