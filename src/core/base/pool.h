// SPDX-License-Identifier: Apache-2.0
// Objects that are costly to make, lent to one thread at a time and kept for the next.
//
// Threads of a loop come and go, so nothing may be kept by thread. A chunk of work borrows the objects that it needs
// (scratch arrays, a set of tiles). There are never more objects than were lent at the same time. Results must not
// depend on which object a chunk gets.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace frontmost {

template <class T>
class Pool {
 public:
  /// Returns the object to the pool on destruction.
  class Lease {
   public:
    Lease(Pool& pool, std::unique_ptr<T> thing) : pool_(pool), thing_(std::move(thing)) {}
    ~Lease() { pool_.give_back(std::move(thing_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    [[nodiscard]] T& operator*() const { return *thing_; }
    [[nodiscard]] T* operator->() const { return thing_.get(); }

   private:
    Pool& pool_;
    std::unique_ptr<T> thing_;
  };

  /// Lends the object that was returned last, or, if none is free, the result of `make()`, a std::unique_ptr<T>.
  template <class Make>
  [[nodiscard]] Lease borrow(const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<T> thing = std::move(free_.back());
        free_.pop_back();
        return Lease(*this, std::move(thing));
      }
    }
    std::unique_ptr<T> thing = make();
    const std::lock_guard lock(mutex_);
    free_.reserve(++count_);  // so that returning an object never fails
    return Lease(*this, std::move(thing));
  }

 private:
  void give_back(std::unique_ptr<T> thing) noexcept {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(thing));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
  std::size_t count_ = 0;
};

}  // namespace frontmost
