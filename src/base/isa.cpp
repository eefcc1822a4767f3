// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"

#include <array>
#include <vector>

#include "hwy/highway.h"

namespace frontmost {
namespace {

struct IsaTarget {
  Isa isa;
  std::string_view name;
  std::int64_t bit;  // 0: the fallback that is always there
};

constexpr std::array<IsaTarget, 4> kTargets{{
    {Isa::scalar, "scalar", 0},
    {Isa::sse4, "sse4", HWY_SSE4},
    {Isa::avx2, "avx2", HWY_AVX2},
    {Isa::avx512, "avx512", HWY_AVX3},
}};

std::vector<Isa> find_available() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  std::vector<Isa> found;
  for (const IsaTarget& target : kTargets)
    if (target.bit == 0 || (usable & target.bit)) found.push_back(target.isa);
  return found;
}

}  // namespace

std::span<const Isa> available_isas() {
  static const std::vector<Isa> found = find_available();
  return found;
}

std::string_view name(Isa isa) {
  if (isa == Isa::best) isa = available_isas().back();
  for (const IsaTarget& target : kTargets)
    if (target.isa == isa) return target.name;
  return "unknown";
}

std::int64_t highway_targets(Isa isa) {
  if (isa == Isa::best) isa = available_isas().back();
  for (const Isa available : available_isas())
    if (available == isa) return kTargets[std::size_t(isa) - 1].bit;
  throw Error(ErrorCode::unsupported, std::string("isa: ") + std::string(name(isa)) + " is not available on this machine");
}

}  // namespace frontmost
