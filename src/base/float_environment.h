// SPDX-License-Identifier: Apache-2.0
// Rounding mode and flush-to-zero change the last bits of everything. This sets the IEEE defaults for a scope.
#pragma once

#include <cfenv>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace frontmost {

class IeeeScope {
 public:
#if defined(__SSE2__)
  IeeeScope() : saved_(_mm_getcsr()) { _mm_setcsr(kDefault); }
  ~IeeeScope() { _mm_setcsr(saved_); }

 private:
  static constexpr unsigned kDefault = 0x1F80;  // all exceptions masked, round to nearest, no FTZ, no DAZ
  unsigned saved_;
#else
  IeeeScope() : saved_(std::fegetround()) { std::fesetround(FE_TONEAREST); }
  ~IeeeScope() { std::fesetround(saved_); }

 private:
  int saved_;
#endif

 public:
  IeeeScope(const IeeeScope&) = delete;
  IeeeScope& operator=(const IeeeScope&) = delete;
};

}  // namespace frontmost
