// SPDX-License-Identifier: Apache-2.0
// Display lists: calls, with their arguments, that can be made again.
//
//   bytes of a list:   | function | arguments | function | arguments | ...
//
// A call is a lambda that takes the context. Its captures are stored in place where they can be copied as bytes; a call
// that holds memory, such as the texels of glTexImage, is kept beside the bytes.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace frontmost::gl_detail {

class Context;

class CallList {
 public:
  template <class Call>
  void append(const Call& call) {
    if constexpr (std::is_trivially_copyable_v<Call> && std::is_trivially_destructible_v<Call>) {
      static_assert(alignof(Call) <= sizeof(Step));
      const std::size_t begin = bytes_.size();
      const Step step = [](Context& context, const std::byte* arguments) {
        (*std::launder(reinterpret_cast<const Call*>(arguments)))(context);
        return arguments + padded(sizeof(Call));
      };
      bytes_.resize(begin + sizeof step + padded(sizeof(Call)));
      std::memcpy(&bytes_[begin], &step, sizeof step);
      std::memcpy(&bytes_[begin + sizeof step], static_cast<const void*>(&call), sizeof call);
    } else {
      const std::function<void(Context&)>* const kept =
          kept_.emplace_back(std::make_unique<std::function<void(Context&)>>(call)).get();
      append([kept](Context& context) { (*kept)(context); });
    }
  }

  void run(Context& context) const {
    const std::byte* at = bytes_.data();
    const std::byte* const end = at + bytes_.size();
    while (at != end) {
      Step step;
      std::memcpy(&step, at, sizeof step);
      at = step(context, at + sizeof step);
    }
  }

 private:
  /// Makes the call whose captures are at `arguments`. \returns the end of the captures.
  using Step = const std::byte* (*)(Context&, const std::byte* arguments);
  static constexpr std::size_t padded(std::size_t bytes) {
    return (bytes + sizeof(Step) - 1) / sizeof(Step) * sizeof(Step);
  }

  std::vector<std::byte> bytes_;
  std::vector<std::unique_ptr<std::function<void(Context&)>>> kept_;
};

}  // namespace frontmost::gl_detail
